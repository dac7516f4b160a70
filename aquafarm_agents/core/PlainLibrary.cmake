# SPDX-License-Identifier: BSD-3-Clause
# The objects aquafarm_agents_plain, which need no libtorch: planners, rescue plans, and policies
# that are already trained. The Python module of aquafarm_gym contains them, too. Where
# aquafarm_agents is not built, aquafarm_gym adds them under the same name, so that ccache finds
# earlier results.
# This file needs the target aquafarm::core, nlohmann_json and AquafarmCore.cmake. Without
# AQUAFARM_BLAS_INCLUDE the policies of PPO multiply matrices with Eigen.
set(plain_sources
  src/base/options.cpp
  src/base/schedule.cpp
  src/base/storage.cpp
  src/base/text.cpp
  src/environment/local_environment.cpp
  src/learning/agent_rng.cpp
  src/learning/checkpoint.cpp
  src/learning/exploration.cpp
  src/learning/random_policy.cpp
  src/learning/tabular.cpp
  src/networks/deep_options.cpp
  src/networks/farm_rows.cpp
  src/planning/fetch_by_value.cpp
  src/planning/optimum.cpp
  src/planning/plan.cpp
  src/planning/planner.cpp
  src/planning/planner_policy.cpp
  src/planning/planner_search.cpp
  src/planning/planner_solver.cpp
  src/planning/risk_source.cpp
  src/planning/team_bound.cpp
  src/planning/team_planner.cpp
  src/planning/water_distance.cpp
  src/rescue/case_fleet.cpp
  src/rescue/case_storm.cpp
  src/rescue/csv.cpp
  src/rescue/deadlines.cpp
  src/rescue/ensemble.cpp
  src/rescue/fleet_state.cpp
  src/rescue/follow_trips.cpp
  src/rescue/forecast_errors.cpp
  src/rescue/make_rescue_case.cpp
  src/rescue/plan_json.cpp
  src/rescue/plan_report.cpp
  src/rescue/plan_trials.cpp
  src/rescue/plan_values.cpp
  src/rescue/reacting_trial.cpp
  src/rescue/rescue_case.cpp
  src/rescue/rescue_order.cpp
  src/rescue/rescue_plan.cpp
  src/rescue/sea_routes.cpp
  src/rescue/storm_member.cpp
  src/rescue/trial_storm.cpp
  src/rescue/trip_model.cpp
  src/rescue/trip_search.cpp
  src/rescue/what_if.cpp)

# These sources need BLAS or Eigen, which gemm.cpp uses on processors without AVX2.
set(ppo_policy_sources
  src/networks/gemm.cpp
  src/networks/lstm_cell.cpp
  src/networks/repetition_penalty.cpp
  src/ppo/actor.cpp
  src/ppo/central_actor_critic.cpp
  src/ppo/feed_forward.cpp
  src/ppo/loop_guard.cpp
  src/ppo/lstm_actor_critic.cpp
  src/ppo/make_actor_critic.cpp
  src/ppo/ppo_loss.cpp
  src/ppo/ppo_options.cpp
  src/ppo/ppo_policy.cpp
  src/ppo/route_rule.cpp
  src/ppo/token_actor_critic.cpp
  src/ppo/token_layout.cpp
  src/ppo/token_symmetry.cpp
  src/training/token_policy.cpp)
list(TRANSFORM plain_sources PREPEND ${CMAKE_CURRENT_LIST_DIR}/)
list(TRANSFORM ppo_policy_sources PREPEND ${CMAKE_CURRENT_LIST_DIR}/)

add_library(aquafarm_agents_plain OBJECT ${plain_sources} ${ppo_policy_sources})
target_compile_features(aquafarm_agents_plain PUBLIC cxx_std_17)
set_target_properties(aquafarm_agents_plain PROPERTIES
  CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
target_include_directories(aquafarm_agents_plain
  PUBLIC ${CMAKE_CURRENT_LIST_DIR}/include PRIVATE ${CMAKE_CURRENT_LIST_DIR}/src)
target_link_libraries(aquafarm_agents_plain
  PUBLIC aquafarm::core PRIVATE nlohmann_json::nlohmann_json)
if(AQUAFARM_BLAS_INCLUDE)
  target_include_directories(aquafarm_agents_plain SYSTEM PRIVATE ${AQUAFARM_BLAS_INCLUDE})
else()
  set_source_files_properties(${ppo_policy_sources} PROPERTIES
    COMPILE_DEFINITIONS AQUAFARM_GEMM_BY_EIGEN)
endif()
aquafarm_set_warnings(aquafarm_agents_plain)
aquafarm_compile_by_folder(aquafarm_agents_plain)
