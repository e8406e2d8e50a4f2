# The library edgevox::core, which knows neither ROS nor PCL.
if(NOT EDGEVOX_ROS)
  #catkin_lint: ignore_once global_var_collision
  option(BUILD_SHARED_LIBS "Build edgevox::core as a shared library" ON)  # as catkin does
endif()

# Results must not depend on the instruction set: no contraction, no -march=native, no -ffast-math.
add_compile_options(-Wall -Wextra -ffp-contract=off)

add_library(${PROJECT_NAME}_core ${EDGEVOX_CORE_SOURCES})
add_library(${PROJECT_NAME}::core ALIAS ${PROJECT_NAME}_core)
target_compile_features(${PROJECT_NAME}_core PUBLIC cxx_std_17)
target_compile_options(${PROJECT_NAME}_core PRIVATE $<$<NOT:$<CONFIG:Debug>>:-O3>)
target_include_directories(${PROJECT_NAME}_core
  PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
  PRIVATE src)
target_link_libraries(${PROJECT_NAME}_core
  PUBLIC Eigen3::Eigen Threads::Threads
  PRIVATE OpenSSL::Crypto edgevox::tbb edgevox::zstd)
target_link_options(${PROJECT_NAME}_core PRIVATE -Wl,--no-undefined)
target_precompile_headers(${PROJECT_NAME}_core PRIVATE
  <algorithm> <cmath> <functional> <string> <vector> <Eigen/Eigenvalues> <Eigen/Geometry>)

include(CheckCXXCompilerFlag)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|i[3-6]86)$")
  check_cxx_compiler_flag(-mavx2 EDGEVOX_COMPILER_HAS_AVX2)
endif()
if(EDGEVOX_COMPILER_HAS_AVX2)
  set_source_files_properties(src/core/edges/edge_kernel_avx2.cpp PROPERTIES
    COMPILE_OPTIONS -mavx2
    SKIP_PRECOMPILE_HEADERS ON)
endif()
