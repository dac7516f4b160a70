# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash disable=SC2154,SC2034
# Makes pictures and films of bags; sourced by ./aquafarm.

# maps_of_values ARGUMENT…: says for what is drawn by render which maps bag_policy must write.
maps_of_values() {
  local steps=() every=1 layers="" output="" option="" word
  for word in "$@"; do
    case $word in
      --*=*) option=${word%%=*} word=${word#*=} ;;
      -[!0-9]*) option=$word; continue ;;
    esac
    case $option in
      --step) steps+=("$word") ;;
      --every) every=$word ;;
      --layers) layers=$word ;;
      -o | --output) output=$word ;;
    esac
  done
  case ,$layers, in
    *,values,* | *,moves,*) ;;
    *) printf '%s\n' --values-every 0; return ;;
  esac
  case $output in
    *.mp4 | *.webm | *.gif) printf '%s\n' --values-every "$every" ;;
    *) printf '%s\n' --values-at "${steps[@]:-0}" ;;
  esac
}

# render ARGUMENT…: with --policy P the bag, which comes first then, is asked along before.
render() {
  local policy="" arguments=() folder result=0
  while [[ $# -gt 0 ]]; do
    case $1 in
      --policy) [[ $# -gt 1 ]] || code=2 die "--policy: got nothing, expected a run folder or checkpoint"
        policy=$2; shift 2 ;;
      --policy=*) policy=${1#*=}; shift ;;
      *) arguments+=("$1"); shift ;;
    esac
  done
  [[ -z $policy || -f ${arguments[0]:-} ]] ||
    code=2 die "render: got '${arguments[0]:-}', expected the bag first: render BAG -o FILE --policy P"
  ensure_built
  ros_environment
  if [[ -z $policy ]]; then exec "$ws/devel/lib/aquafarm_viz/render" "${arguments[@]}"; fi
  folder=$(mktemp -d)
  # shellcheck disable=SC2064
  trap "rm -rf '$folder'" EXIT
  local maps
  mapfile -t maps < <(maps_of_values "${arguments[@]:1}")
  "$ws/devel/lib/aquafarm_agents/bag_policy" "${arguments[0]}" "$policy" -o "$folder/asked.bag" "${maps[@]}" || exit $?
  "$ws/devel/lib/aquafarm_viz/render" "$folder/asked.bag" --asked "${arguments[0]}" "${arguments[@]:1}" || result=$?
  exit $result
}
