# SPDX-License-Identifier: BSD-3-Clause
# The planners and policies of aquafarm_agents that need no libtorch.
set(agents_dir ${AQUAFARM_CHECKOUT}/aquafarm_agents/core)
find_package(nlohmann_json 3.2 REQUIRED)
option(AQUAFARM_GYM_BLAS "Play policies of PPO by BLAS, if it is installed; OFF: by Eigen" ON)
find_library(AQUAFARM_BLAS blas)  # of libblas-dev; libblas.so.3 selects the real one
find_path(AQUAFARM_BLAS_INCLUDE cblas.h)
if(AQUAFARM_GYM_BLAS AND AQUAFARM_BLAS AND AQUAFARM_BLAS_INCLUDE)
  set(uses_blas ON)
else()
  set(uses_blas OFF)
endif()

if(TARGET aquafarm_agents_plain)
  # A workspace that builds aquafarm_agents has compiled them.
  add_library(aquafarm_policies STATIC EXCLUDE_FROM_ALL $<TARGET_OBJECTS:aquafarm_agents_plain>)
  set_target_properties(aquafarm_policies PROPERTIES LINKER_LANGUAGE CXX)
else()
  include(${agents_dir}/PlainSources.cmake)
  set(policy_sources ${AQUAFARM_PLAIN_SOURCES} ${AQUAFARM_PPO_POLICY_SOURCES})
  list(TRANSFORM policy_sources PREPEND ${agents_dir}/)
  if(NOT uses_blas)
    list(TRANSFORM AQUAFARM_PPO_POLICY_SOURCES PREPEND ${agents_dir}/)
    set_source_files_properties(${AQUAFARM_PPO_POLICY_SOURCES} PROPERTIES
      COMPILE_DEFINITIONS AQUAFARM_GEMM_BY_EIGEN)
  endif()
  add_library(aquafarm_policies STATIC EXCLUDE_FROM_ALL ${policy_sources})
  set_target_properties(aquafarm_policies PROPERTIES
    POSITION_INDEPENDENT_CODE ON CXX_EXTENSIONS OFF)
  aquafarm_set_warnings(aquafarm_policies)
  aquafarm_compile_by_folder(aquafarm_policies)
endif()
target_include_directories(aquafarm_policies PUBLIC ${agents_dir}/include ${agents_dir}/src)
target_link_libraries(aquafarm_policies
  PUBLIC aquafarm::core PRIVATE nlohmann_json::nlohmann_json)
if(uses_blas OR TARGET aquafarm_agents_plain)
  target_include_directories(aquafarm_policies SYSTEM PRIVATE ${AQUAFARM_BLAS_INCLUDE})
  target_link_libraries(aquafarm_policies PRIVATE ${AQUAFARM_BLAS})
endif()
