# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash disable=SC2154,SC2034
# Measures speed relative to references; sourced by ./aquafarm.

bench_executable() {
  local found
  found=$(find "$ws/core" "$ws/devel/lib" -name "$1" -type f -executable -print -quit 2>/dev/null)
  [[ -n $found ]] || die "the build made no $1"
  printf '%s\n' "$found"
}

# Relates the figures in file $2 to the reference $1 of tools/bench_reference.py, measured in the same
# run.
bench_reference() { bench_python bench_reference.py "$@"; }

# Runs a program of tools/ in a virtual environment with what must come from PyPI, made once.
bench_python() {
  local program=$1 venv=$ws/bench_venv
  shift
  # The last Stable-Baselines3 that Debian 12's python3-torch satisfies, and the Gymnasium it takes.
  local wanted="gymnasium==1.0.0 stable-baselines3==2.4.1 sb3-contrib==2.4.0 farama-notifications cloudpickle"
  if [[ $(cat "$venv/ready" 2>/dev/null) != "$wanted" ]]; then
    # shellcheck disable=SC2086
    { /usr/bin/python3 -m venv --clear --system-site-packages "$venv" &&
      "$venv/bin/pip" install -q --no-deps --timeout 20 $wanted &&
      echo "$wanted" >"$venv/ready"; } >"$ws/bench_venv.log" 2>&1 || {
      say "no ratio to a reference: PyPI is out of reach? ($ws/bench_venv.log)"
      return
    }
  fi
  OMP_NUM_THREADS=1 "$venv/bin/python" "$root/tools/$program" "$@"
}

bench_sim() {
  core aquafarm_sim
  "$(bench_executable bench_sim)" | tee "$ws/bench_sim.txt"
  bench_reference taxi "$ws/bench_sim.txt"
}

bench_import() {
  core aquafarm_sim
  "$(bench_executable bench_import)"
}

bench_ros() {
  ensure_built
  ros_environment
  "$(bench_executable ros_bench)"
}

bench_agents() {
  ensure_built
  ros_environment
  /usr/bin/python3 "$root/tools/bench_agents.py"
}

bench_recording() {
  ensure_built
  ros_environment
  /usr/bin/python3 "$root/tools/bench_recording.py"
}

bench_tabular() {
  core aquafarm_agents
  "$(bench_executable bench_tabular)" | tee "$ws/bench_tabular.txt"
  bench_reference numpy "$ws/bench_tabular.txt"
}

bench_planner() {
  core aquafarm_agents
  "$(bench_executable bench_planner)"
}

bench_dqn() {
  core aquafarm_agents
  "$(bench_executable bench_deep)" --benchmark_filter=^Dqn | tee "$ws/bench_dqn.txt"
  bench_reference sb3 "$ws/bench_dqn.txt"
}

bench_lstm() {
  core aquafarm_agents
  "$(bench_executable bench_deep)" --benchmark_filter=^LstmDqn | tee "$ws/bench_lstm.txt"
  bench_reference torch "$ws/bench_lstm.txt"
}

# The references play the same farm through aquafarm_gym.
bench_ppo() {
  core aquafarm_agents
  core aquafarm_gym
  "$(bench_executable bench_ppo)" | tee "$ws/bench_ppo.txt"
  PYTHONPATH=$ws/core/aquafarm_gym:$root/aquafarm_gym/python bench_python bench_ppo.py \
    "$ws/bench_ppo.txt"
}

# Compares trainings of two and four ranks with one rank, and with a model of the cost.
bench_ranks() {
  core aquafarm_agents
  /usr/bin/python3 "$root/tools/bench_ranks.py" "$(bench_executable aquafarm_train)"
}

bench_all() {
  local out=$ws/bench_all.txt
  { bench_sim; bench_import; bench_tabular; bench_planner; bench_dqn; bench_lstm; bench_ppo; bench_ranks; bench_ros; bench_agents; bench_recording; } |
    tee "$out"
  say "all figures, also in $out:"
  grep -E '^[a-z][a-z0-9_]* -?[0-9][0-9.e+-]* ' "$out"
}

bench() {
  case ${1:-all} in
    sim | import | ros | agents | recording | tabular | planner | dqn | lstm | ppo | ranks | all) setup; "bench_${1:-all}" ;;
    *) code=2 die "bench: got '$1', expected sim, import, ros, agents, recording, tabular, \
planner, dqn, lstm, ppo, ranks or nothing for all" ;;
  esac
}
