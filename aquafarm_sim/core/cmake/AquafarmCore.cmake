# SPDX-License-Identifier: BSD-3-Clause
# Shared by the ROS-free cores: warnings, the library, its tests, fuzz targets, and the check for ROS
# includes.

set(AQUAFARM_CORE_CMAKE_DIR ${CMAKE_CURRENT_LIST_DIR})

# Applies to all targets of the directory that includes this file.
option(AQUAFARM_FUZZ "Build for libFuzzer with sanitizers; needs clang" OFF)
if(AQUAFARM_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link,address,undefined -fno-omit-frame-pointer
                      -gline-tables-only)
  add_link_options(-fsanitize=address,undefined)
endif()

# aquafarm_compile_by_folder(TARGET [ALL | FOLDER…]): compiles the sources of a folder as one, which
# takes a third of the time (docs/decisions/compile_by_folder.md), and those of all FOLDERs, whose paths
# are relative to the current one, as one, too. ALL: all sources, for nodes, where the headers of ROS
# take most of the time of each folder. CMake 3.18 has groups.
option(AQUAFARM_UNITY "Compile the sources of each folder as one" ON)
function(aquafarm_compile_by_folder target)
  if(NOT AQUAFARM_UNITY OR CMAKE_VERSION VERSION_LESS 3.18)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "[.]cpp$")
  foreach(source IN LISTS sources)
    get_filename_component(folder ${source} DIRECTORY)
    # The same in every build that compiles the folder, so that ccache knows it again.
    string(REGEX REPLACE "^.*/src/" "src/" group "${folder}")
    string(MAKE_C_IDENTIFIER "${group}" group)
    if("ALL" IN_LIST ARGN OR folder IN_LIST ARGN)
      set(group together)
    elseif(NOT group)
      set(group here)
    endif()
    set_property(SOURCE ${source} PROPERTY UNITY_GROUP ${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # g++ warns of local types outside the file that it was given.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

function(aquafarm_set_warnings target)
  # Without contraction of a*b+c to a fused operation, results are bit-identical on every machine.
  # Functions of the library are never interposed, so calls inside it may be inlined.
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wconversion -Wshadow -ffp-contract=off -fno-semantic-interposition)
endfunction()

# Adds a shared library with C++17, all warnings and no undefined symbols, whose calls of its own
# functions are bound when it is linked, which makes them faster; a static library with
# AQUAFARM_STATIC_CORE, for a Python module that contains it, and for fuzz targets, which are faster
# if they contain only what they use. Sources of folders after TOGETHER are compiled as one.
function(aquafarm_add_core_library target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "TOGETHER")
  if(AQUAFARM_STATIC_CORE OR AQUAFARM_FUZZ)
    add_library(${target} STATIC ${arg_UNPARSED_ARGUMENTS})
  else()
    add_library(${target} SHARED ${arg_UNPARSED_ARGUMENTS})
  endif()
  target_compile_features(${target} PUBLIC cxx_std_17)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  target_link_options(${target} PRIVATE LINKER:--no-undefined LINKER:-Bsymbolic-functions)
  aquafarm_set_warnings(${target})
  aquafarm_compile_by_folder(${target} ${arg_TOGETHER})
endfunction()

# Fails the build of `target` when a file of this core includes ROS.
function(aquafarm_check_no_ros target)
  add_custom_target(${target}_no_ros ALL
    COMMAND ${CMAKE_COMMAND} -DCORE_DIR=${CMAKE_CURRENT_SOURCE_DIR}
            -P ${AQUAFARM_CORE_CMAKE_DIR}/CheckNoRos.cmake
    COMMENT "Checking that ${target} includes no ROS header")
  add_dependencies(${target} ${target}_no_ros)
endfunction()

# Compiles a program with few optimisations: that takes half the time, and the code that has to be
# fast is in libraries.
function(aquafarm_compile_fast target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# aquafarm_add_core_tests(PATHS LIBRARY… [TOGETHER FOLDER…]): adds test/<folder>/<name>.cpp as the ctest
# test <name>, for each path <folder>/<name>. The tests of a folder share the program <folder>_tests,
# which links the libraries; those of all FOLDERs share that of the first one. The result of each is
# where catkin expects it. Sets AQUAFARM_TEST_PROGRAMS to the programs.
function(aquafarm_add_core_tests paths)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "TOGETHER")
  list(TRANSFORM arg_TOGETHER PREPEND test/ OUTPUT_VARIABLE together)
  if(NOT TARGET aquafarm_tests_main)
    add_library(aquafarm_tests_main OBJECT
      ${AQUAFARM_CORE_CMAKE_DIR}/../test/support/main.cpp)
    target_link_libraries(aquafarm_tests_main PRIVATE GTest::gtest)
    aquafarm_set_warnings(aquafarm_tests_main)
    aquafarm_compile_fast(aquafarm_tests_main)
  endif()
  set(programs)
  foreach(path IN LISTS paths)
    get_filename_component(name ${path} NAME)
    get_filename_component(folder ${path} DIRECTORY)
    if(folder IN_LIST arg_TOGETHER)
      list(GET arg_TOGETHER 0 folder)
    endif()
    set(program ${folder}_tests)
    if(NOT TARGET ${program})
      add_executable(${program} $<TARGET_OBJECTS:aquafarm_tests_main>)
      list(APPEND programs ${program})
    endif()
    target_sources(${program} PRIVATE test/${path}.cpp)
    add_test(NAME ${name} COMMAND ${program} --file=${name}
             --gtest_output=xml:${CMAKE_BINARY_DIR}/test_results/${PROJECT_NAME}/${name}.xml)
    set_tests_properties(${name} PROPERTIES TIMEOUT 300)
  endforeach()
  foreach(program IN LISTS programs)
    target_include_directories(${program} PRIVATE test src)
    target_link_libraries(${program} PRIVATE ${arg_UNPARSED_ARGUMENTS} GTest::gtest)
    target_compile_definitions(${program} PRIVATE AQUAFARM_CORE_DIR="${CMAKE_CURRENT_SOURCE_DIR}")
    aquafarm_set_warnings(${program})
    aquafarm_compile_fast(${program})
    aquafarm_compile_by_folder(${program} ${together})
  endforeach()
  set(AQUAFARM_TEST_PROGRAMS ${programs} PARENT_SCOPE)
endfunction()

# Adds fuzz/fuzz_<name>.cpp, which links ARGN. With AQUAFARM_FUZZ it uses libFuzzer; without it,
# mutate.cpp, which is compiled once, mutates each sample in a fixed order.
function(aquafarm_add_fuzz_target name)
  add_executable(fuzz_${name} fuzz/fuzz_${name}.cpp)
  target_link_libraries(fuzz_${name} PRIVATE ${ARGN})
  if(AQUAFARM_FUZZ)
    target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
  else()
    if(NOT TARGET aquafarm_mutate)
      add_library(aquafarm_mutate OBJECT ${AQUAFARM_CORE_CMAKE_DIR}/../fuzz/mutate.cpp)
      target_link_libraries(aquafarm_mutate PRIVATE aquafarm::core)
      aquafarm_set_warnings(aquafarm_mutate)
    endif()
    target_sources(fuzz_${name} PRIVATE $<TARGET_OBJECTS:aquafarm_mutate>)
  endif()
  aquafarm_set_warnings(fuzz_${name})
endfunction()
