# SPDX-License-Identifier: BSD-3-Clause
# cmake -DCORE_DIR=… -P CheckLearners.cmake: refuses #include lines of learners that reach the farm:
# all they may take from its library are plain types, chance and checks.
set(learners
  curiosity curiosity_module deep_options deep_policy dqn exploration flat_adam independent learner
  maddpg maddpg_networks maddpg_options maddpg_policy moment_sampler networks random_policy
  recurrent_dqn replay row_network schedule sequence_batch tabular value_optimizer)
set(farm_headers "^[ \t]*#[ \t]*include[ \t]*[<\"]aquafarm/[a-z_]+\\.h")
set(plain_headers "aquafarm/(check|grid|hash|rng|types)\\.h")
foreach(learner IN LISTS learners)
  file(GLOB files ${CORE_DIR}/src/${learner}.* ${CORE_DIR}/include/aquafarm/agents/${learner}.h)
  if(NOT files)
    message(FATAL_ERROR "${CMAKE_CURRENT_LIST_FILE}: no file of '${learner}', expected one of the learners' sources")
  endif()
  foreach(file IN LISTS files)
    file(STRINGS ${file} included REGEX "${farm_headers}")
    list(FILTER included EXCLUDE REGEX "${plain_headers}")
    if(included)
      message(FATAL_ERROR "${file}: a learner sees only an Environment, got: ${included}")
    endif()
  endforeach()
endforeach()
