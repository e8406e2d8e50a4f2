if(EDGEVOX_BUILD_BENCH)
  find_package(benchmark REQUIRED)
  find_package(PCL REQUIRED COMPONENTS common filters io keypoints octree registration)
  file(GLOB bench_sources CONFIGURE_DEPENDS bench/*.cpp)
  add_executable(${PROJECT_NAME}_bench ${bench_sources})
  target_include_directories(${PROJECT_NAME}_bench SYSTEM PRIVATE ${outer_include_dirs})
  target_compile_options(${PROJECT_NAME}_bench PRIVATE
    -Wno-array-bounds)  # in templates of PCL and Eigen, by gcc 12
  target_compile_definitions(${PROJECT_NAME}_bench PRIVATE
    EDGEVOX_DEFAULT_DATA="${CMAKE_CURRENT_SOURCE_DIR}/../shared/data")
  target_link_libraries(${PROJECT_NAME}_bench PRIVATE
    ${PROJECT_NAME}_evaluation pcl_filters pcl_registration benchmark::benchmark)
  install(TARGETS ${PROJECT_NAME}_bench RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endif()
