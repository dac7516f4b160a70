# SPDX-License-Identifier: BSD-3-Clause
# aquafarm_add_test(NAME SOURCE… LIBRARIES TARGET…): a gtest that runs under catkin's run_tests where
# catkin tests are enabled, and under ctest otherwise.
function(aquafarm_add_test name)
  cmake_parse_arguments(arg "" "" "LIBRARIES" ${ARGN})
  find_package(GTest REQUIRED)
  add_executable(${name} ${arg_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} GTest::gtest_main)
  if(COMMAND aquafarm_set_warnings)
    aquafarm_set_warnings(${name})
  endif()
  if(CATKIN_ENABLE_TESTING AND COMMAND catkin_run_tests_target)
    set(xml ${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME}/gtest-${name}.xml)
    if(TARGET tests)  # which builds it; `all` does not
      add_dependencies(tests ${name})
      set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    endif()
    catkin_run_tests_target(gtest ${name} gtest-${name}.xml
      COMMAND "$<TARGET_FILE:${name}> --gtest_output=xml:${xml}"
      DEPENDENCIES ${name})
  else()
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES TIMEOUT 300)
  endif()
endfunction()
