# SPDX-License-Identifier: BSD-3-Clause
# The planners and policies of aquafarm_agents that need no libtorch.
set(agents_dir ${AQUAFARM_CHECKOUT}/aquafarm_agents/core)
find_package(nlohmann_json 3.2 REQUIRED)
option(AQUAFARM_GYM_BLAS "Play policies of PPO by BLAS, if it is installed; OFF: by Eigen" ON)

# A workspace that builds aquafarm_agents has compiled them, with BLAS.
if(NOT TARGET aquafarm_agents_plain)
  if(AQUAFARM_GYM_BLAS)
    find_library(AQUAFARM_BLAS blas)  # of libblas-dev; libblas.so.3 selects the real one
    find_path(AQUAFARM_BLAS_INCLUDE cblas.h)
  endif()
  if(NOT AQUAFARM_GYM_BLAS OR NOT AQUAFARM_BLAS)
    set(AQUAFARM_BLAS_INCLUDE "")
  endif()
  include(${agents_dir}/PlainLibrary.cmake)
  set_target_properties(aquafarm_agents_plain PROPERTIES EXCLUDE_FROM_ALL ON)
endif()
add_library(aquafarm_policies STATIC EXCLUDE_FROM_ALL $<TARGET_OBJECTS:aquafarm_agents_plain>)
set_target_properties(aquafarm_policies PROPERTIES LINKER_LANGUAGE CXX)
target_include_directories(aquafarm_policies PUBLIC ${agents_dir}/include ${agents_dir}/src)
target_link_libraries(aquafarm_policies PUBLIC aquafarm::core)
if(AQUAFARM_BLAS_INCLUDE)
  target_link_libraries(aquafarm_policies PRIVATE ${AQUAFARM_BLAS})
endif()
