#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Trains the generalist (docs/generalist.md) and evaluates it on ranches that no training draws.
#   tools/train_generalist.sh RUN_FOLDER [STEPS [STEPS_2 [STEPS_3]]]
# The first two trainings are in RUN_FOLDER.first and RUN_FOLDER.second. The second continues the
# first, and the third continues the second, both with a longer horizon (gamma).
# Run `source .ws/devel/setup.bash` first. An interrupted training resumes with the same command.
set -euo pipefail

run=${1:?usage: tools/train_generalist.sh RUN_FOLDER [STEPS [STEPS_2 [STEPS_3]]]}
steps=${2:-36000000}
steps_2=${3:-16000000}
steps_3=${4:-20000000}
export OPENBLAS_NUM_THREADS=1  # one thread is faster for these sizes

# train FOLDER SEED STEPS OPTION…
# symmetric, max_visits and repetition_penalty change how the policy plays, not its weights.
train() {
  local resume=()
  [[ ! -e $1/run.json ]] || resume=(--resume)
  nice -n 5 rosrun aquafarm_agents aquafarm_train ranch_family -a ppo -s "$2" -f 256 -n "$3" \
    -d "$1" --evaluate 0 "${resume[@]}" -o hidden_size=192 -o reward_scale=0.02 \
    -o augment=true -o symmetric=true -o max_visits=3 -o repetition_penalty=8 "${@:4}"
}

train "$run.first" 1 "$steps" -o gamma=0.995 -o batch_size=1024 \
  -o learning_rate=linear:7e-4:0:1 -o teacher=linear:1:0:0.05 -x entropy:linear:0.005:0:1
longer=(-o gamma=0.998 -o batch_size=2048 -o learning_rate=linear:3e-4:0:1
  -x entropy:linear:0.002:0:1)
train "$run.second" 11 "$steps_2" --init "$run.first" "${longer[@]}"
train "$run" 12 "$steps_3" --init "$run.second" "${longer[@]}"

# Plans of more than 400,000 states take minutes each; those ranches are left out and counted.
for scenario in paper procedural zhoushan_storms ranch_family; do
  nice -n 5 rosrun aquafarm_agents aquafarm_evaluate "$run" "$scenario" -e 1000 --optimum 400000 \
    -w "$run/$scenario" | tail -n 2
done
