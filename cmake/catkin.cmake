# What a catkin package says of itself: dependencies, messages, exports, its devel space.
find_package(catkin REQUIRED COMPONENTS
  diagnostic_updater
  geometry_msgs
  message_generation
  nav_msgs
  nodelet
  pluginlib
  rosbag_storage
  roscpp
  roslib
  sensor_msgs
  std_msgs
  std_srvs
  tf2
  tf2_msgs
  visualization_msgs
)
find_package(Boost REQUIRED CONFIG COMPONENTS program_options)
find_package(octomap REQUIRED)
find_package(PCL REQUIRED COMPONENTS common io keypoints octree registration)
find_package(yaml-cpp REQUIRED)

add_message_files(FILES
  ScanReport.msg
  Setting.msg
  Voxel.msg
  VoxelScanStamped.msg
)
add_service_files(FILES LoadMap.srv SaveMap.srv)
generate_messages(DEPENDENCIES geometry_msgs std_msgs)

catkin_package(
  INCLUDE_DIRS include
  LIBRARIES ${PROJECT_NAME}_core
  CATKIN_DEPENDS geometry_msgs message_runtime std_msgs
  DEPENDS EIGEN3
)

# Built on its own into <checkout>/build: rosrun skips whatever lies below <package folder>/build, so
# the package folder is written in a way that does not match.
# A devel space elsewhere may list other packages as well and stays as it is.
string(FIND "${CATKIN_DEVEL_PREFIX}/" "${PROJECT_SOURCE_DIR}/" devel_below_checkout)
if(CMAKE_SOURCE_DIR STREQUAL PROJECT_SOURCE_DIR AND devel_below_checkout EQUAL 0)
  file(WRITE ${CATKIN_DEVEL_PREFIX}/.catkin "${PROJECT_SOURCE_DIR}/.")
endif()
