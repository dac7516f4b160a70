# SPDX-License-Identifier: BSD-3-Clause
# The module aquafarm_core._pictures.
set(viz_dir ${AQUAFARM_CHECKOUT}/aquafarm_viz)
set(msgs_dir ${AQUAFARM_CHECKOUT}/aquafarm_msgs/msg)
set(plain_dir ${CMAKE_CURRENT_BINARY_DIR}/plain_messages)

# Python_EXECUTABLE (pip) and PYTHON_EXECUTABLE (catkin) are the interpreter of the module.
find_package(Python REQUIRED COMPONENTS Interpreter)
file(GLOB messages CONFIGURE_DEPENDS ${msgs_dir}/*.msg)
add_custom_command(
  OUTPUT ${plain_dir}/ros/time.h
  COMMAND ${Python_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/plain_messages.py
          ${msgs_dir} ${plain_dir}
  COMMAND ${CMAKE_COMMAND} -E touch ${plain_dir}/ros/time.h
  DEPENDS plain_messages.py ${messages}
  COMMENT "Writing the messages as plain structs")

# The drawing code needs messages alone, so it compiles with the plain ones.
include(${viz_dir}/DrawingSources.cmake)
list(TRANSFORM AQUAFARM_DRAWING_SOURCES PREPEND ${viz_dir}/)
add_library(aquafarm_drawing STATIC
  ${plain_dir}/ros/time.h
  ${AQUAFARM_SIM_DIR}/src/convert/conversions.cpp
  ${AQUAFARM_DRAWING_SOURCES})
set_source_files_properties(${viz_dir}/src/draw/disaster_rings.cpp PROPERTIES
  COMPILE_OPTIONS "-O3;-fno-math-errno;-fno-trapping-math")
set_target_properties(aquafarm_drawing PROPERTIES
  POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden)
target_compile_features(aquafarm_drawing PUBLIC cxx_std_17)
target_compile_options(aquafarm_drawing PRIVATE -Wall -Wextra -Wpedantic -Wshadow)
aquafarm_compile_by_folder(aquafarm_drawing)
# The plain messages come before /usr/include, where Debian has those of ROS. The path relative to
# the folder in which make compiles is the same in a workspace and in a wheel, so ccache compiles the
# drawing code once; other generators use the absolute one.
target_compile_options(aquafarm_drawing PUBLIC -Iplain_messages)
target_include_directories(aquafarm_drawing SYSTEM PUBLIC ${plain_dir} ${OpenCV_INCLUDE_DIRS})
target_include_directories(aquafarm_drawing PUBLIC
  ${viz_dir}/include ${AQUAFARM_SIM_DIR}/include PRIVATE ${viz_dir}/src)
target_link_libraries(aquafarm_drawing
  PUBLIC aquafarm::core opencv_core opencv_imgproc PRIVATE Freetype::Freetype yaml-cpp)

pybind11_add_module(aquafarm_pictures_python MODULE NO_EXTRAS src/arguments.cpp src/pictures.cpp)
set_target_properties(aquafarm_pictures_python PROPERTIES
  OUTPUT_NAME _pictures
  LIBRARY_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/aquafarm_core)
target_link_libraries(aquafarm_pictures_python PRIVATE aquafarm_drawing)
target_link_options(aquafarm_pictures_python PRIVATE LINKER:--exclude-libs,ALL)
aquafarm_set_warnings(aquafarm_pictures_python)
if(SKBUILD)
  install(TARGETS aquafarm_pictures_python LIBRARY DESTINATION aquafarm_core)
endif()
