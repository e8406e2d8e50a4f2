# What is built. The library edgevox::core needs nothing of ROS.
if(NOT DEFINED EDGEVOX_ROS)
  #catkin_lint: skip
  find_package(catkin QUIET)
  if(NOT catkin_FOUND)
    message(STATUS "catkin was not found: the library edgevox::core is built without nodelets and "
      "tools. For these, source ROS's setup.bash and configure with -DEDGEVOX_ROS=ON.")
  endif()
endif()
#catkin_lint: ignore_once global_var_collision
option(EDGEVOX_ROS "Build the ROS package, not the library alone (needs catkin)" ${catkin_FOUND})
#catkin_lint: ignore_once global_var_collision
option(EDGEVOX_BUILD_EVALUATION "Build the tool evaluate" ${EDGEVOX_ROS})
#catkin_lint: ignore_once global_var_collision
option(EDGEVOX_BUILD_SIMULATION "Build the tool simulate" ${EDGEVOX_ROS})
#catkin_lint: ignore_once global_var_collision
option(EDGEVOX_BUILD_BENCH "Build the benchmarks (needs Google Benchmark)" OFF)

function(edgevox_require option needed why)
  if(${option} AND NOT ${needed})
    message(FATAL_ERROR "${option} needs ${needed}, which is OFF: ${why}.")
  endif()
endfunction()
edgevox_require(EDGEVOX_BUILD_EVALUATION EDGEVOX_ROS "evaluate reads bags")
edgevox_require(EDGEVOX_BUILD_EVALUATION EDGEVOX_BUILD_SIMULATION
  "evaluate measures in simulated worlds, too")
edgevox_require(EDGEVOX_BUILD_SIMULATION EDGEVOX_ROS "simulate writes bags")
edgevox_require(EDGEVOX_BUILD_BENCH EDGEVOX_BUILD_EVALUATION "the benchmarks use its recordings")
edgevox_require(CATKIN_ENABLE_TESTING EDGEVOX_ROS "the tests are those of a catkin package")
if(CATKIN_ENABLE_TESTING AND NOT EDGEVOX_BUILD_SIMULATION)
  message(STATUS "No tests: they use simulated scans and need EDGEVOX_BUILD_SIMULATION.")
endif()

message(STATUS "edgevox ${EDGEVOX_VERSION}: EDGEVOX_ROS=${EDGEVOX_ROS}, "
  "EDGEVOX_BUILD_EVALUATION=${EDGEVOX_BUILD_EVALUATION}, "
  "EDGEVOX_BUILD_SIMULATION=${EDGEVOX_BUILD_SIMULATION}")
