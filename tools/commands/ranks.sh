# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash disable=SC2154,SC2034
# Trains in several processes of this machine, without ROS; sourced by ./aquafarm.

# rank_arguments NAME:=VALUE…: sets `run` to the run folder, `report` to the folder of the report
# and `words` to the arguments of aquafarm_train.
rank_arguments() {
  local argument name value option scenario=paper
  words=() run="" report=""
  for argument in "$@"; do
    argument=$(launch_argument "" "$argument") || exit $?
    name=${argument%%:=*} value=${argument#*:=}
    case $name in
      ranks) words+=(--ranks "$value") ;;
      scenario) scenario=$value ;;
      algorithm) words+=(--algorithm "$value") ;;
      episodes) words+=(--episodes "$value") ;;
      steps) words+=(--steps "$value") ;;
      farms) words+=(--farms "$value") ;;
      seed) words+=(--seed "$value") ;;
      credit) words+=(--credit "$value") ;;
      exploration) [[ $value == auto ]] || words+=(--exploration "$value") ;;
      options)
        [[ $value != none ]] || continue
        for option in $value; do words+=(--set "$option"); done ;;
      init) [[ $value == none ]] || words+=(--init "$value") ;;
      run_dir) run=$value words+=(--run-dir "$value") ;;
      resume) [[ ! $value =~ ^([Tt]rue|1)$ ]] || words+=(--resume) ;;
      report) report=$value ;;
      checkpoint_period_s) words+=(--checkpoint-period "$value") ;;
      evaluation_episodes) words+=(--evaluate "$value") ;;
      random_episodes) words+=(--random "$value") ;;
      *) code=2 die "$name: got '$value' with ranks, expected one of: scenario, algorithm, \
episodes, steps, farms, seed, credit, exploration, options, init, run_dir, resume, report, \
checkpoint_period_s, evaluation_episodes, random_episodes; ranks train without ROS" ;;
    esac
  done
  words=("$scenario" "${words[@]}")
}

# train_ranks NAME:=VALUE…: ./aquafarm train with ranks:=N.
train_ranks() {
  local argument arguments=("$@") words=() run report result=0
  while read -r argument; do
    say "taking $argument"
    arguments+=("$argument")
  done < <(default_arguments train "$@")
  [[ " ${arguments[*]}" == *" algorithm:="* ]] || arguments+=(algorithm:=ppo)
  check_arguments train "${arguments[@]}"
  rank_arguments "${arguments[@]}"
  ensure_built
  "$(bench_executable aquafarm_train)" "${words[@]}" || result=$?
  if [[ $result == 0 && $report != none ]]; then
    ros_environment
    rosrun aquafarm_bringup make_report "$report" || result=$?
  fi
  case $result in
    0) say "train ended well" ;;
    130) say "train was interrupted (exit code 130)" ;;
    *) say "train ended with exit code $result: see above" ;;
  esac
  return "$result"
}
