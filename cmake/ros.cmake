# Nodelets and tools, and what is installed of the package.
set(outer_include_dirs ${catkin_INCLUDE_DIRS} ${PCL_INCLUDE_DIRS} ${YAML_CPP_INCLUDE_DIR})

if(EDGEVOX_BUILD_SIMULATION)
  add_library(${PROJECT_NAME}_sim STATIC ${EDGEVOX_SIM_SOURCES})
  target_include_directories(${PROJECT_NAME}_sim PUBLIC src)
  target_link_libraries(${PROJECT_NAME}_sim PUBLIC ${PROJECT_NAME}_core)
endif()

add_library(${PROJECT_NAME}_run STATIC ${EDGEVOX_RUN_SOURCES})
set_target_properties(${PROJECT_NAME}_run PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_include_directories(${PROJECT_NAME}_run PUBLIC src)
target_include_directories(${PROJECT_NAME}_run SYSTEM PRIVATE ${PCL_INCLUDE_DIRS})
target_link_libraries(${PROJECT_NAME}_run PUBLIC
  ${PROJECT_NAME}_core pcl_common pcl_io OpenSSL::Crypto)

# Conversions need no master; what is live takes part in one.
add_library(${PROJECT_NAME}_conversions STATIC ${EDGEVOX_CONVERSION_SOURCES})
set_target_properties(${PROJECT_NAME}_conversions PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_include_directories(${PROJECT_NAME}_conversions PUBLIC src)
target_include_directories(${PROJECT_NAME}_conversions SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
target_link_libraries(${PROJECT_NAME}_conversions PUBLIC ${PROJECT_NAME}_core ${catkin_LIBRARIES})
set(ros_headers <functional> <map> <string> <Eigen/Geometry>
  <diagnostic_updater/diagnostic_updater.h> <nodelet/nodelet.h> <ros/node_handle.h>
  <sensor_msgs/PointCloud2.h>)
target_precompile_headers(${PROJECT_NAME}_conversions PRIVATE ${ros_headers})
add_dependencies(${PROJECT_NAME}_conversions
  ${${PROJECT_NAME}_EXPORTED_TARGETS} ${catkin_EXPORTED_TARGETS})

add_library(${PROJECT_NAME}_live STATIC ${EDGEVOX_LIVE_SOURCES})
set_target_properties(${PROJECT_NAME}_live PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_include_directories(${PROJECT_NAME}_live SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
target_link_libraries(${PROJECT_NAME}_live PUBLIC ${PROJECT_NAME}_conversions)
target_precompile_headers(${PROJECT_NAME}_live REUSE_FROM ${PROJECT_NAME}_conversions)

add_library(${PROJECT_NAME}_nodelets SHARED ${EDGEVOX_NODE_SOURCES})
target_include_directories(${PROJECT_NAME}_nodelets SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
target_link_libraries(${PROJECT_NAME}_nodelets PRIVATE ${PROJECT_NAME}_live ${PROJECT_NAME}_run)
target_link_options(${PROJECT_NAME}_nodelets PRIVATE -Wl,--no-undefined)
# Its definitions are others: it cannot use those of the conversions.
target_precompile_headers(${PROJECT_NAME}_nodelets PRIVATE ${ros_headers})
add_dependencies(${PROJECT_NAME}_nodelets ${${PROJECT_NAME}_EXPORTED_TARGETS})

add_library(${PROJECT_NAME}_tools STATIC ${EDGEVOX_TOOLS_SOURCES})
target_include_directories(${PROJECT_NAME}_tools SYSTEM PRIVATE
  ${outer_include_dirs} ${OCTOMAP_INCLUDE_DIRS})
target_link_libraries(${PROJECT_NAME}_tools PUBLIC
  ${PROJECT_NAME}_conversions ${PROJECT_NAME}_run ${YAML_CPP_LIBRARIES} ${OCTOMAP_LIBRARIES}
  Boost::program_options)
target_precompile_headers(${PROJECT_NAME}_tools PRIVATE
  <algorithm> <filesystem> <functional> <iostream> <string> <boost/program_options.hpp>
  <Eigen/Geometry> <pcl/point_cloud.h> <rosbag/bag.h> <sensor_msgs/PointCloud2.h>
  ${PROJECT_SOURCE_DIR}/include/edgevox/mapping/pipeline.hpp)

if(EDGEVOX_BUILD_EVALUATION)
  add_library(${PROJECT_NAME}_evaluation STATIC ${EDGEVOX_EVALUATION_SOURCES})
  target_include_directories(${PROJECT_NAME}_evaluation SYSTEM PRIVATE ${outer_include_dirs})
  target_link_libraries(${PROJECT_NAME}_evaluation PUBLIC
    ${PROJECT_NAME}_tools ${PROJECT_NAME}_sim pcl_keypoints pcl_octree pcl_registration
    edgevox::tbb)
  target_precompile_headers(${PROJECT_NAME}_evaluation REUSE_FROM ${PROJECT_NAME}_tools)
  set_source_files_properties(
    src/evaluation/paper_icp.cpp src/evaluation/pcl_registration.cpp src/evaluation/pcl_search.cpp
    PROPERTIES
    COMPILE_OPTIONS -Wno-array-bounds)  # in templates of PCL and Eigen, by gcc 12
endif()

# src/tools/<tool>.cpp holds main()
function(edgevox_add_tool tool)
  add_executable(${PROJECT_NAME}_${tool} src/tools/${tool}.cpp)
  set_target_properties(${PROJECT_NAME}_${tool} PROPERTIES OUTPUT_NAME ${tool})
  target_include_directories(${PROJECT_NAME}_${tool} SYSTEM PRIVATE ${outer_include_dirs})
  target_link_libraries(${PROJECT_NAME}_${tool} PRIVATE -Wl,--as-needed ${ARGN})
  install(TARGETS ${PROJECT_NAME}_${tool} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endfunction()
edgevox_add_tool(map ${PROJECT_NAME}_tools)
edgevox_add_tool(map_bag ${PROJECT_NAME}_tools)
if(EDGEVOX_BUILD_SIMULATION)
  edgevox_add_tool(simulate ${PROJECT_NAME}_tools ${PROJECT_NAME}_sim)
endif()
if(EDGEVOX_BUILD_EVALUATION)
  edgevox_add_tool(evaluate ${PROJECT_NAME}_evaluation)
endif()

install(TARGETS ${PROJECT_NAME}_core ${PROJECT_NAME}_nodelets
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION}
)
install(DIRECTORY include/${PROJECT_NAME}/ DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION})
file(GLOB share_folders LIST_DIRECTORIES true CONFIGURE_DEPENDS config launch rviz)
install(FILES nodelet_plugins.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
install(DIRECTORY ${share_folders} DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
# The other scripts work on the checkout and stay in it.
#catkin_lint: ignore uninstalled_script
install(PROGRAMS scripts/await_manager scripts/play_bag scripts/plot_edges scripts/plot_localize scripts/plot_map
  scripts/plot_maps scripts/plot_paper scripts/plot_run scripts/plot_trust
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
