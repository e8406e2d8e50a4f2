# Most of a test's compile time goes into headers, which the tests of a kind share compiled, and into
# optimising what runs once.
# -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON shows an include that is missing.
set(core_test_headers <algorithm> <filesystem> <fstream> <sstream> <string> <vector>
  <gtest/gtest.h> <Eigen/Geometry> ${PROJECT_SOURCE_DIR}/include/edgevox/mapping/pipeline.hpp)
set(outer_test_headers ${core_test_headers} <pcl/io/pcd_io.h> <pcl/io/ply_io.h>
  <ros/node_handle.h> <rosbag/bag.h> <sensor_msgs/PointCloud2.h> <tf2_msgs/TFMessage.h>
  <yaml-cpp/yaml.h>)
include(CheckCXXSourceCompiles)
set(CMAKE_REQUIRED_LINK_OPTIONS -fuse-ld=gold)  # three times as fast; Debian 13 has none
check_cxx_source_compiles("int main() {}" EDGEVOX_HAS_GOLD)
unset(CMAKE_REQUIRED_LINK_OPTIONS)
function(edgevox_compile_test test_target kind)
  if(EDGEVOX_HAS_GOLD)
    target_link_options(${test_target} PRIVATE -fuse-ld=gold)
  endif()
  target_compile_options(${test_target} PRIVATE -O1
    -Wno-dangling-else)  # if (...) EXPECT_EQ(...)
  get_property(first GLOBAL PROPERTY edgevox_precompiled_${kind})
  if(first)
    target_precompile_headers(${test_target} REUSE_FROM ${first})
  else()
    target_precompile_headers(${test_target} PRIVATE ${${kind}_test_headers})
    set_property(GLOBAL PROPERTY edgevox_precompiled_${kind} ${test_target})
  endif()
endfunction()

# ---- Tests: every *_test.cpp below test/<folder> is one program, edgevox_<folder>_<file> ----
if(CATKIN_ENABLE_TESTING)
  file(GLOB support_sources CONFIGURE_DEPENDS test/support/*.cpp)
  add_library(${PROJECT_NAME}_test_support INTERFACE)
  if(support_sources)
    add_library(${PROJECT_NAME}_test_objects STATIC EXCLUDE_FROM_ALL ${support_sources})
    target_include_directories(${PROJECT_NAME}_test_objects PRIVATE test)
    target_link_libraries(${PROJECT_NAME}_test_objects PUBLIC ${PROJECT_NAME}_sim)
    target_link_libraries(${PROJECT_NAME}_test_support INTERFACE ${PROJECT_NAME}_test_objects)
  endif()
  target_include_directories(${PROJECT_NAME}_test_support INTERFACE test src)
  target_compile_definitions(${PROJECT_NAME}_test_support INTERFACE
    EDGEVOX_SOURCE_DIR="${CMAKE_CURRENT_SOURCE_DIR}"
    EDGEVOX_DEFAULT_DATA="${CMAKE_CURRENT_SOURCE_DIR}/../shared/data")
  # That of catkin comes first: Noetic's builds a gtest of its own, and two are one too many.
  set(gtest_main ${GTEST_MAIN_LIBRARIES})
  if(NOT gtest_main AND TARGET GTest::gtest_main)
    set(gtest_main GTest::gtest_main)
  endif()

  # What the tests of nodelets and tools share.
  file(GLOB outer_sources CONFIGURE_DEPENDS test/ros/*.cpp test/tools/*.cpp)
  list(FILTER outer_sources EXCLUDE REGEX "_test.cpp$")
  add_library(${PROJECT_NAME}_outer_test_objects STATIC EXCLUDE_FROM_ALL ${outer_sources})
  target_include_directories(${PROJECT_NAME}_outer_test_objects SYSTEM PRIVATE ${outer_include_dirs})
  target_link_libraries(${PROJECT_NAME}_outer_test_objects PUBLIC
    ${PROJECT_NAME}_test_support ${PROJECT_NAME}_sim ${PROJECT_NAME}_tools ${GTEST_LIBRARIES})

  set(test_folders core run sim tools)
  if(EDGEVOX_BUILD_EVALUATION)
    list(APPEND test_folders evaluation)
  endif()
  foreach(folder IN LISTS test_folders)
    file(GLOB_RECURSE test_sources CONFIGURE_DEPENDS test/${folder}/*_test.cpp)
    if(NOT EDGEVOX_BUILD_EVALUATION)
      list(FILTER test_sources EXCLUDE REGEX "/evaluate_test.cpp$")
    endif()
    foreach(test_source IN LISTS test_sources)
      get_filename_component(test_name ${test_source} NAME_WE)
      set(test_target ${PROJECT_NAME}_${folder}_${test_name})
      catkin_add_gtest(${test_target} ${test_source})
      target_link_libraries(${test_target}
        ${PROJECT_NAME}_test_support ${PROJECT_NAME}_sim OpenSSL::Crypto ${gtest_main})
      if(folder MATCHES "evaluation|run|tools")
        target_include_directories(${test_target} SYSTEM PRIVATE ${outer_include_dirs})
        target_link_libraries(${test_target} ${PROJECT_NAME}_tools)
        add_dependencies(${test_target} ${PROJECT_NAME}_map_bag)  # which some of them call
        edgevox_compile_test(${test_target} outer)
      else()
        edgevox_compile_test(${test_target} core)
      endif()
      if(folder STREQUAL "evaluation")
        target_link_libraries(${test_target} ${PROJECT_NAME}_evaluation)
      endif()
      if(folder MATCHES "evaluation|tools")
        target_link_libraries(${test_target} ${PROJECT_NAME}_outer_test_objects)
      endif()
    endforeach()
  endforeach()
  edgevox_compile_test(${PROJECT_NAME}_outer_test_objects outer)
  target_compile_definitions(${PROJECT_NAME}_core_examples_test PRIVATE
    EDGEVOX_BUILD_DIR="${CMAKE_CURRENT_BINARY_DIR}"
    EDGEVOX_CMAKE="${CMAKE_COMMAND}"
    EDGEVOX_COMPILER="${CMAKE_CXX_COMPILER}"
    EDGEVOX_COMPILER_LAUNCHER="${CMAKE_CXX_COMPILER_LAUNCHER}")
endif()

# ---- Tests of the nodelets: test/ros/<name>.test starts what test/ros/<name>_test.cpp looks at ----
if(CATKIN_ENABLE_TESTING)
  find_package(rostest REQUIRED)
  find_package(roslaunch REQUIRED)
  file(GLOB ros_tests CONFIGURE_DEPENDS test/ros/*.test)
  foreach(ros_test IN LISTS ros_tests)
    get_filename_component(test_name ${ros_test} NAME_WE)
    set(test_target ${PROJECT_NAME}_ros_${test_name}_test)
    add_rostest_gtest(${test_target} ${ros_test} test/ros/${test_name}_test.cpp)
    target_include_directories(${test_target} SYSTEM PRIVATE ${outer_include_dirs})
    target_link_libraries(${test_target}
      ${PROJECT_NAME}_outer_test_objects ${PROJECT_NAME}_live ${gtest_main})
    add_dependencies(${test_target} ${PROJECT_NAME}_nodelets)
    edgevox_compile_test(${test_target} outer)
  endforeach()
  roslaunch_add_file_check(launch USE_TEST_DEPENDENCIES IGNORE_UNSET_ARGS)

  # They mostly wait: one at a time, beside others. That which builds takes longest: it begins.
  get_property(all_tests DIRECTORY PROPERTY TESTS)
  set(ros_test_names ${all_tests})
  list(FILTER ros_test_names INCLUDE REGEX "rostest")
  set_tests_properties(${ros_test_names} PROPERTIES RESOURCE_LOCK ros)
  set(building_tests ${all_tests})
  list(FILTER building_tests INCLUDE REGEX "core_examples_test")
  set_tests_properties(${building_tests} PROPERTIES COST 1000)
endif()
