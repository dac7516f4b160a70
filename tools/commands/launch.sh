# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash disable=SC2154,SC2034
# Starts launch files on a free port and passes exit codes on; sourced by ./aquafarm.

is_port_open() { (exec 3<>"/dev/tcp/127.0.0.1/$1") 2>/dev/null; }

ros_environment() {
  local port=11311
  set +u
  # shellcheck disable=SC1091
  source "$ws/devel/setup.bash"
  set -u
  export ROS_HOME=${ROS_HOME:-$ws/ros}
  export ROS_LOG_DIR=${ROS_LOG_DIR:-$ROS_HOME/log}
  [[ -n ${ROS_HOSTNAME:-} ]] || export ROS_IP=${ROS_IP:-127.0.0.1}
  mkdir -p "$ROS_LOG_DIR"
  shares_master=1
  if [[ -z ${ROS_MASTER_URI:-} ]]; then
    shares_master=0
    while is_port_open $port; do
      port=$((11312 + RANDOM % 1000))
    done
    [[ $port == 11311 ]] ||
      say "port 11311 is taken, using $port; set ROS_MASTER_URI to share a running master"
    export ROS_MASTER_URI=http://127.0.0.1:$port
  else
    "$root/aquafarm_bringup/scripts/check_arguments" --master "$ROS_MASTER_URI" || exit 2
  fi
}

# Turns 'run_dir:=here' into an absolute path (nodes run in ROS_HOME).
launch_argument() {
  local file=$1 argument=$2 name=${2%%:=*} value=${2#*:=}
  [[ $argument == *:=* ]] || code=2 die "got '$argument', expected name:=value"
  case $name in
    run_dir | record_dir | report | bag | policy | init | scenario | output | human)
      if [[ $value == */* || $value == *.yaml ||
        $name =~ ^(run_dir|record_dir|report|bag|output|human)$ ]] &&
        [[ -n $value && $value != auto && $value != none ]]; then
        value=$(realpath -m "$value")
      fi ;;
  esac
  printf '%s:=%s\n' "$name" "$value"
}

# arguments_of_run RUN: what the run was trained with, as arguments of train.launch.
arguments_of_run() {
  if [[ -f $1/scenario.yaml ]]; then echo "scenario:=$(realpath "$1")/scenario.yaml"; fi
  [[ -f $1/run.json ]] || return 0
  /usr/bin/python3 - "$1/run.json" <<'PYTHON' || true  # then the run is refused by its checkpoint
import json
import sys

try:
    with open(sys.argv[1], encoding="utf-8") as file:
        run = json.load(file)
    # Exploration is an argument of its own, and an option of the learner in what is recorded.
    words = run["options"].split()
    start = "exploration="
    values = {name: run[name] for name in ("algorithm", "seed", "farms", "credit")}
    values["options"] = " ".join(word for word in words if not word.startswith(start))
    values["exploration"] = "".join(
        word[len(start):] for word in words if word.startswith(start))
    # A value with a line break, or with what roslaunch expands, could set any other argument.
    for name, value in values.items():
        if not str(value).isprintable() or "$(" in str(value) or "'" in str(value):
            raise ValueError(f"{name}: got {value!r}, expected one line without $( and quotes")
except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
    sys.exit(f"aquafarm: {sys.argv[1]}: damaged: {error!r}")
for name, value in values.items():
    if value != "":
        print(f"{name}:={value}")
PYTHON
}

# What a launch writes or reads when its arguments give no path: the user's folder, not ROS_HOME.
default_arguments() {
  local launch=$1 argument now folder policy="" newest run name resumes=0 is_other=0
  local -A given=()
  for argument in "${@:2}"; do given[${argument%%:=*}]=${argument#*:=}; done
  now=$(date +%Y%m%d-%H%M%S)
  # The newest run that has learnt something.
  newest=$({ find "$PWD/runs" -mindepth 3 -maxdepth 3 -name 'step_*.ckpt' -printf '%T@ %h\n' \
    2>/dev/null || true; } | sort -n | tail -n 1)
  newest=${newest#* }
  newest=${newest%/checkpoints}
  if [[ $launch == train || ${given[of]:-} == train ]]; then
    if [[ ${given[resume]:-false} =~ ^([Tt]rue|1)$ ]]; then resumes=1; fi
    run=${given[run_dir]:-$PWD/runs/$now}
    if [[ $resumes == 1 && -n $newest ]]; then
      run=${given[run_dir]:-$newest}
    fi
    [[ -n ${given[run_dir]:-} ]] || echo "run_dir:=$run"
    # A resumed run goes on as it began wherever its arguments say nothing else.
    if [[ $launch == train && $resumes == 1 ]]; then
      while read -r argument; do
        name=${argument%%:=*}
        if [[ -n ${given[$name]:-} ]]; then
          # Another algorithm is refused as such, not by the options of the run's own.
          [[ $name != algorithm || ${given[$name]} == "${argument#*:=}" ]] || is_other=1
          continue
        fi
        [[ $name != @(options|exploration) || $is_other == 0 ]] || continue
        [[ $name != exploration || ${given[options]:-} != *exploration=* ]] || continue
        echo "$argument"
      done < <(arguments_of_run "$run")
    fi
    [[ $launch != train || -n ${given[report]:-} || $run == auto ]] ||
      echo "report:=$(realpath -m "$run")"
  fi
  if [[ $launch == evaluate && -n ${given[record]:-} && -z ${given[record_dir]:-} ]]; then
    echo "record_dir:=$PWD/episodes"
  fi
  if [[ $launch == play && -z ${given[record_dir]:-} ]]; then echo "record_dir:=$PWD/played"; fi
  if [[ $launch == benchmark ]]; then
    [[ -n ${given[output]:-} ]] || echo "output:=$PWD/benchmark"
    [[ -n ${given[report]:-} ]] || echo "report:=$(realpath -m "${given[output]:-benchmark}")"
  fi
  if [[ $launch =~ ^(sim|replay)$ && -z ${given[headless]:-} && -z ${DISPLAY:-} ]]; then
    echo "headless:=true"  # there is no display
  fi
  if [[ $launch == record && -z ${given[bag]:-} ]]; then echo "bag:=$PWD/aquafarm_$now.bag"; fi
  policy=${given[policy]:-}
  if [[ $launch == evaluate && -z $policy ]]; then
    policy=${newest:-generalist}
    echo "policy:=$policy"
  fi
  # A policy plays on the ranch that it was trained on, which its run folder keeps.
  if [[ $launch != replay && $policy == */* && -z ${given[scenario]:-} ]]; then
    for folder in "$policy" "$(dirname "$policy")" "$(dirname "$(dirname "$policy")")"; do
      [[ -f $folder/scenario.yaml ]] || continue
      echo "scenario:=$(realpath "$folder")/scenario.yaml"
      break
    done
  fi
}

# What roslaunch would answer with a page of XML, or not at all.
check_arguments() {
  local argument value
  [[ $1 != replay || " ${*:2}" == *" bag:="* ]] ||
    code=2 die "replay: got no bag, expected bag:=FILE, such as one that ./aquafarm record wrote"
  for argument in "${@:2}"; do
    value=${argument#*:=}
    case $argument in
      of:=*) [[ $value =~ ^(sim|train|evaluate)$ ]] ||
        code=2 die "of: got '$value', expected sim, train or evaluate" ;;
      record:=*)
        [[ $value =~ ^([Tt]rue|[Ff]alse|0|1|all|every:[1-9][0-9]*|best|worst|failures)$ ]] ||
          code=2 die "record: got '$value', expected all, every:N, best, worst, failures or false" ;;
      resume:=* | viz:=* | rviz:=* | headless:=* | paused:=* | loop:=*)
        [[ $value =~ ^([Tt]rue|[Ff]alse|0|1)$ ]] ||
          code=2 die "${argument%%:=*}: got '$value', expected true or false" ;;
      bag:=*) [[ $1 != replay || -f $value ]] || code=2 die "bag: there is no file $value" ;;
      runs:=*.*[1-9]* | jobs:=*.*[1-9]* | ranks:=*.*[1-9]* | *episodes:=*.*[1-9]* | farms:=*.*[1-9]* | \
        seed:=*.*[1-9]* | start_episode:=*.*[1-9]* | start_step:=*.*[1-9]*)
        code=2 die "${argument%%:=*}: got '$value', expected a whole number" ;;
      runs:=* | jobs:=* | ranks:=* | *episodes:=* | *steps:=* | farms:=* | seed:=* | *_s:=* | *_hz:=* | \
        speed:=* | start_episode:=* | start_step:=*)
        [[ $value =~ ^-?[0-9.]+([eE][-+]?[0-9]+)?$ ]] ||
          code=2 die "${argument%%:=*}: got '$value', expected a number" ;;
    esac
  done
}

# On a master that was there before, a second ranch of the same name would end the first.
refuse_a_second_ranch() {
  local argument ns=aquafarm
  [[ $1 != replay && $1 != benchmark && $shares_master == 1 ]] || return 0
  for argument in "${@:2}"; do
    if [[ $argument == ns:=* ]]; then ns=${argument#ns:=}; fi
  done
  if timeout 10 rosnode list 2>/dev/null | grep -qxF "/$ns/sim"; then
    code=2 die "/$ns/sim already runs on $ROS_MASTER_URI; give ns:=another_name or another master"
  fi
}

# policy_of RANCH.yaml: the policy that plays it without a training: generalist for one ship,
# planner for several. A file that cannot be read is refused later.
policy_of() {
  /usr/bin/python3 - "$1" <<'PYTHON' 2>/dev/null || echo generalist
import sys

import yaml

with open(sys.argv[1], encoding="utf-8") as file:
    ranch = yaml.safe_load(file)
agents = (ranch.get("ships") or {}).get("count", 1)
agents += ((ranch.get("layout") or {}).get("devices") or {}).get("self_propelled", 0)
print("planner" if agents > 1 else "generalist")
PYTHON
}

# name_the_ranch NAME ARGUMENT…: prints its arguments, each followed by a zero byte. For evaluate and
# sim it prints RANCH.yaml as scenario:=RANCH.yaml, and adds the policy of policy_of unless one is given.
name_the_ranch() {
  local word ranch=""
  for word in "$@"; do
    if [[ $1 =~ ^(evaluate|sim)$ && $word == *.yaml && $word != *:=* && $word != -* ]]; then
      ranch=$word
      word=scenario:=$word
    fi
    printf '%s\0' "$word"
  done
  if [[ -n $ranch && " $*" != *" policy:="* ]]; then
    printf 'policy:=%s\0' "$(policy_of "$ranch")"
  fi
}

# launch NAME ARGUMENT…: roslaunch returns 0 even when a required node failed, so the nodes leave
# their exit code in a file; the first to end decides.
launch() {
  local file=$root/aquafarm_bringup/launch/$1.launch argument arguments=() options=() result=0
  local words=()
  mapfile -d '' words < <(name_the_ranch "$@")
  set -- "${words[@]}"
  local program=$root/aquafarm_bringup/scripts/quiet_roslaunch format='[${severity}] ${message}'
  for argument in "${@:2}"; do
    case $argument in
      verbose:=[Tt]rue | verbose:=1) program=roslaunch format=""; continue ;;
      verbose:=[Ff]alse | verbose:=0) continue ;;
      verbose:=*) code=2 die "verbose: got '${argument#*:=}', expected true or false" ;;
    esac
    if [[ $argument == -* ]]; then options+=("$argument"); continue; fi
    argument=$(launch_argument "$file" "$argument") || exit $?
    arguments+=("$argument")
  done
  /usr/bin/python3 "$root/aquafarm_bringup/scripts/check_arguments" "$file" "${arguments[@]}" \
    >/dev/null || exit 2
  while read -r argument; do
    say "taking $argument"
    arguments+=("$argument")
  done < <(default_arguments "$@")
  check_arguments "$1" "${arguments[@]}"
  ensure_built
  ros_environment
  refuse_a_second_ranch "$1" "${arguments[@]}"
  export AQUAFARM_LAUNCHER=$0  # for the next steps that nodes print
  local exit_file=$ws/exit.$$
  # roslaunch kills a node 15 s after Ctrl-C by default; a large checkpoint takes longer to write.
  options+=(--sigint-timeout=120)
  rm -f "$exit_file"
  # Whatever ends this script ends roslaunch too, which lets its nodes save; wait for that. (A
  # program in the background would have Ctrl-C ignored; a second signal does roslaunch no harm.)
  [[ -z $format ]] || export ROSCONSOLE_FORMAT=${ROSCONSOLE_FORMAT:-$format}
  [[ $program == roslaunch ]] ||
    say "starting $1; Ctrl-C ends it, verbose:=true shows roslaunch's own messages"
  env --default-signal=INT,QUIT "$program" "${options[@]}" aquafarm_bringup "$1.launch" \
    "${arguments[@]}" exit_file:="$exit_file" <&0 &
  local pid=$!
  trap 'kill -TERM $pid 2>/dev/null || true' INT TERM HUP
  while kill -0 $pid 2>/dev/null; do
    result=0
    wait $pid || result=$?
  done
  trap - INT TERM HUP
  local reason=""
  if [[ -s $exit_file ]]; then
    { read -r result; read -r reason || true; } <"$exit_file"
  elif [[ $result == 0 ]]; then  # a node that ends by itself leaves its exit code
    result=137 reason="its node was killed before it ended"
    [[ $1 != train ]] || reason+="; resume:=true continues from the last checkpoint"
  fi
  rm -f "$exit_file"
  case $result in
    0) say "$1 ended well" ;;
    130) say "$1 was interrupted (exit code 130)" ;;
    *) say "$1 ended with exit code $result: ${reason:-see above}" ;;
  esac
  return "$result"
}

launch_help() {
  printf 'usage: ./aquafarm %s [name:=value…]\n\n%s\n\n' "$1" "$2"
  if [[ -f $ws/built ]]; then
    ros_environment
    roslaunch --ros-args aquafarm_bringup "$1.launch"
    printf '  verbose (default "false"): true shows the messages of roslaunch itself.\n'
  else
    echo "./aquafarm build first; then this lists every argument with its meaning and default."
  fi
}
