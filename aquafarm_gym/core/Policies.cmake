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

# A workspace that builds aquafarm_agents has compiled them. Elsewhere they are compiled under the same
# name, by which ccache knows them again.
if(TARGET aquafarm_agents_plain)
  set(uses_blas ON)
else()
  include(${agents_dir}/PlainSources.cmake)
  set(policy_sources ${AQUAFARM_PLAIN_SOURCES} ${AQUAFARM_PPO_POLICY_SOURCES})
  list(TRANSFORM policy_sources PREPEND ${agents_dir}/)
  if(NOT uses_blas)
    list(TRANSFORM AQUAFARM_PPO_POLICY_SOURCES PREPEND ${agents_dir}/)
    set_source_files_properties(${AQUAFARM_PPO_POLICY_SOURCES} PROPERTIES
      COMPILE_DEFINITIONS AQUAFARM_GEMM_BY_EIGEN)
  endif()
  add_library(aquafarm_agents_plain OBJECT EXCLUDE_FROM_ALL ${policy_sources})
  target_compile_features(aquafarm_agents_plain PUBLIC cxx_std_17)
  set_target_properties(aquafarm_agents_plain PROPERTIES
    POSITION_INDEPENDENT_CODE ON CXX_EXTENSIONS OFF)
  target_include_directories(aquafarm_agents_plain PRIVATE ${agents_dir}/include ${agents_dir}/src)
  target_link_libraries(aquafarm_agents_plain PRIVATE aquafarm::core nlohmann_json::nlohmann_json)
  if(uses_blas)
    target_include_directories(aquafarm_agents_plain SYSTEM PRIVATE ${AQUAFARM_BLAS_INCLUDE})
  endif()
  aquafarm_set_warnings(aquafarm_agents_plain)
  aquafarm_compile_by_folder(aquafarm_agents_plain)
endif()
add_library(aquafarm_policies STATIC EXCLUDE_FROM_ALL $<TARGET_OBJECTS:aquafarm_agents_plain>)
set_target_properties(aquafarm_policies PROPERTIES LINKER_LANGUAGE CXX)
target_include_directories(aquafarm_policies PUBLIC ${agents_dir}/include ${agents_dir}/src)
target_link_libraries(aquafarm_policies
  PUBLIC aquafarm::core PRIVATE nlohmann_json::nlohmann_json)
if(uses_blas)
  target_link_libraries(aquafarm_policies PRIVATE ${AQUAFARM_BLAS})
endif()
