# SPDX-License-Identifier: BSD-3-Clause
# The planners and policies of aquafarm_agents that need no libtorch.
set(agents_dir ${CMAKE_CURRENT_SOURCE_DIR}/../../aquafarm_agents/core)
include(${agents_dir}/PlainSources.cmake)
find_package(nlohmann_json 3.2 REQUIRED)
find_library(AQUAFARM_BLAS blas)  # of libblas-dev; libblas.so.3 selects the real one
find_path(AQUAFARM_BLAS_INCLUDE cblas.h)

set(policy_sources ${AQUAFARM_PLAIN_SOURCES})
if(AQUAFARM_BLAS AND AQUAFARM_BLAS_INCLUDE)
  list(APPEND policy_sources ${AQUAFARM_PPO_POLICY_SOURCES})
else()
  message(STATUS "aquafarm_gym: no BLAS, so the package will not play policies of PPO (Debian: "
                 "libblas-dev)")
endif()
list(TRANSFORM policy_sources PREPEND ${agents_dir}/)
add_library(aquafarm_policies STATIC EXCLUDE_FROM_ALL ${policy_sources})
set_target_properties(aquafarm_policies PROPERTIES
  POSITION_INDEPENDENT_CODE ON CXX_EXTENSIONS OFF CXX_VISIBILITY_PRESET hidden)
target_include_directories(aquafarm_policies PUBLIC ${agents_dir}/include ${agents_dir}/src)
target_link_libraries(aquafarm_policies
  PUBLIC aquafarm::core PRIVATE nlohmann_json::nlohmann_json)
aquafarm_set_warnings(aquafarm_policies)
if(AQUAFARM_BLAS AND AQUAFARM_BLAS_INCLUDE)
  target_include_directories(aquafarm_policies SYSTEM PRIVATE ${AQUAFARM_BLAS_INCLUDE})
  target_link_libraries(aquafarm_policies PRIVATE ${AQUAFARM_BLAS})
  target_compile_definitions(aquafarm_policies PUBLIC AQUAFARM_WITH_BLAS)
endif()
