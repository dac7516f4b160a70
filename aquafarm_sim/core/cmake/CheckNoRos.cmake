# SPDX-License-Identifier: BSD-3-Clause
# usage: cmake -DCORE_DIR=… -P CheckNoRos.cmake
# Fails if a file of a core includes a ROS header.
file(GLOB_RECURSE files ${CORE_DIR}/include/*.h* ${CORE_DIR}/src/*.cpp ${CORE_DIR}/src/*.h
     ${CORE_DIR}/apps/*.cpp ${CORE_DIR}/bench/*.cpp ${CORE_DIR}/test/*.cpp)
set(ros_headers "^[ \t]*#[ \t]*include[ \t]*[<\"](ros|rosbag|tf2?|tf2_ros|catkin|roscpp|[a-z_]+_msgs|aquafarm_msgs|aquafarm_sim|aquafarm_agents)/")
foreach(file IN LISTS files)
  file(STRINGS ${file} bad REGEX "${ros_headers}")
  if(bad)
    message(FATAL_ERROR "${file}: a core includes no ROS header, got: ${bad}")
  endif()
endforeach()
