# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash disable=SC2154,SC2034
# Builds and runs every test; sourced by ./aquafarm.

# A stage that breaks counts as a failed test; cases that never ran would go unmissed otherwise.
broken() {
  printf '<testsuite tests="1" failures="1"><testcase classname="stage" name="%s"><failure/>%s\n' \
    "$1" '</testcase></testsuite>' >"$ws/results/stage-${1// /_}.xml"
  say "the stage '$1' broke off; the end of $2:" >&2
  tail -n 20 "$2" >&2
}

# stage WHAT: says what begins, and when.
stage() { say "$(printf '%2d:%02d' $(((SECONDS - began) / 60)) $(((SECONDS - began) % 60))) $1"; }

build_tests() { make -C "$ws/build" -k -j"$jobs" tests >"$1" 2>&1; }

run_tests() {
  local results=$ws/results failed=0
  local began=$SECONDS
  (packages=("${browser_packages[@]}"); setup) ||
    say "no browser could be installed: the tests of HTML pages are skipped"
  (packages=(clang-14); setup) ||
    say "no clang could be installed: the check of locks is skipped"
  stage "building the workspace"
  build
  stage "building the cores with plain cmake"
  core aquafarm_sim
  core aquafarm_agents
  rm -rf "$results" "$ws/build/test_results" "$ws"/core/*/test_results
  mkdir -p "$results"
  stage "testing the tools"
  AQUAFARM_CAMPAIGNS=$ws /usr/bin/python3 -m pytest -q -p no:cacheprovider \
    --junitxml="$results/tools.xml" \
    "$root"/tools/test/*_test.py >"$results/tools.log" 2>&1 || failed=1
  [[ -s $results/tools.xml ]] || broken "tools" "$results/tools.log"
  local name
  for name in aquafarm_sim aquafarm_agents; do
    stage "testing $name/core without ROS"
    ctest --test-dir "$ws/core/$name" -j "$jobs" --timeout 300 --output-on-failure -Q \
      --output-log "$results/$name.log" --output-junit "$results/ctest-$name.xml" || failed=1
    [[ -s $results/ctest-$name.xml ]] || broken "$name core" "$results/$name.log"
  done
  ros_environment
  stage "building the tests through ROS (log: $results/build_tests.log)"
  locked build_tests "$results/build_tests.log" ||
    broken "build of the tests through ROS" "$results/build_tests.log"
  stage "testing through ROS (log: $results/run_tests.log)"
  CTEST_OUTPUT_ON_FAILURE=1 ROS_TEST_RESULTS_DIR="$ws/build/test_results" \
    "$root/tools/run_ros_tests" "$ws/build" "$results/run_tests.log" --jobs "$test_jobs" ||
    broken "tests through ROS" "$results/run_tests.log"
  if [[ $fast == 0 ]]; then
    stage "building and running in the other kinds of workspace"
    "$root/tools/check_workspaces" "$ws/workspaces" "$results/workspaces.xml" || failed=1
  fi
  stage "adding up the results"
  /usr/bin/python3 "$root/tools/sum_results.py" "$results" "$ws"/core/*/test_results \
    "$ws/build/test_results" || failed=1
  return $failed
}
