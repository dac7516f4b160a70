#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Trains the generalist (docs/generalist.md) and evaluates it on ranches that no training draws.
#   tools/train_generalist.sh RUN_FOLDER [STEPS]
# Run `source .ws/devel/setup.bash` first. An interrupted training resumes with the same command.
set -euo pipefail

run=${1:?usage: tools/train_generalist.sh RUN_FOLDER [STEPS]}
steps=${2:-36000000}
resume=()
[[ ! -e $run/run.json ]] || resume=(--resume)
export OPENBLAS_NUM_THREADS=1  # one thread is faster for these sizes

# symmetric, max_visits and repetition_penalty change how the policy plays, not its weights.
nice -n 5 rosrun aquafarm_agents aquafarm_train ranch_family -a ppo -s 1 -f 256 -n "$steps" \
  -d "$run" --evaluate 0 "${resume[@]}" \
  -o hidden_size=192 -o gamma=0.995 -o reward_scale=0.02 -o batch_size=1024 \
  -o learning_rate=linear:7e-4:0:1 -o teacher=linear:1:0:0.05 -x entropy:linear:0.005:0:1 \
  -o augment=true -o symmetric=true -o max_visits=3 -o repetition_penalty=0.3

# Plans of more than 400,000 states take minutes each; those ranches are left out and counted.
for scenario in paper procedural zhoushan_storms ranch_family; do
  nice -n 5 rosrun aquafarm_agents aquafarm_evaluate "$run" "$scenario" -e 1000 --optimum 400000 \
    -w "$run/$scenario" | tail -n 2
done
