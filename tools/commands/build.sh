# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash disable=SC2154,SC2034
# Builds the workspace and the ROS-free cores; sourced by ./aquafarm.

# is_made_from FOLDER SOURCES [LINE]: true if cmake has configured FOLDER for SOURCES and the cache
# in FOLDER has LINE. False after a checkout was copied or moved: the cache has absolute paths.
is_made_from() {
  grep -qsxF "CMAKE_HOME_DIRECTORY:INTERNAL=$2" "$1/CMakeCache.txt" &&
    { [[ $# == 2 ]] || grep -qsxF "$3" "$1/CMakeCache.txt"; }
}

is_of_this_tree() {
  [[ $(realpath -m "$ws/src/aquafarm") == "$root" ]] && is_made_from "$ws/build" "$ws/src" "$@"
}

# True if no source is newer than the last successful build. The time of a folder changes if a file
# in it is added or removed, so removed files count as well.
is_built() {
  is_of_this_tree "CMAKE_BUILD_TYPE:STRING=$build_type" &&
    [[ -f $ws/built && -z $(find "$root"/aquafarm_* -newer "$ws/built" ! -name '*.pyc' \
      ! -name __pycache__ -print -quit) ]]
}

# locked COMMAND …: runs the command while no other process builds in this workspace. Calls cannot
# be nested.
locked() {
  local lock result
  mkdir -p "$ws"
  exec {lock}<"$ws"
  if ! flock -n "$lock"; then
    say "another process is building in $ws; waiting at most 90 minutes"
    flock -w 5400 "$lock" ||
      die "$ws is still being built in by another process; 'lslocks' names it"
  fi
  "$@"
  result=$?
  exec {lock}<&-
  return $result
}

# The suite needs no messages in Lisp, whose generation takes long.
export ROS_LANG_DISABLE=${ROS_LANG_DISABLE-genlisp}

build_lines='^\[ *[0-9]+%\] (Building|Linking|Generating)|[Ee]rror|[Ww]arning|\*\*\*'

# The same sources are compiled in several kinds of workspace; ccache reuses the results of the first.
# CCACHE_BASEDIR is the folder of a build: ccache treats paths in it as relative.
use_ccache() {
  command -v ccache >/dev/null || return 0
  export CCACHE_DIR=${CCACHE_DIR:-$ws/ccache} CCACHE_MAXSIZE=${CCACHE_MAXSIZE:-2G}
  export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER-ccache}
}

# Refuses a workspace that has another folder in the place of this checkout.
check_place() {
  local place=$ws/src/aquafarm
  if [[ -e $place && ! -L $place && $(realpath "$place") != "$root" ]]; then
    code=2 die "$place: got a folder, expected this checkout, a link or nothing; set AQUAFARM_WS to \
another folder"
  fi
}

# Links this checkout into the workspace.
link_sources() {
  local place=$ws/src/aquafarm
  check_place
  mkdir -p "$ws/src"
  [[ -e $place && ! -L $place ]] || ln -sfn "$root" "$place"
}

# core() builds the tests and benches of the cores.
# shellcheck disable=SC2120
build_all() {
  setup
  use_ccache
  check_place
  if [[ -d $ws/build ]] && ! is_of_this_tree; then
    [[ -f $ws/built || -f $ws/building ]] ||
      code=2 die "$ws: got a build that ./aquafarm has not made, expected its own build or none; \
set AQUAFARM_WS to another folder, or build with catkin_make there"
    say "the workspace $ws was built from another checkout; rebuilding"
    rm -rf "$ws/build" "$ws/devel" "$ws/built"
  fi
  # catkin's first configuration stores the environment with only those folders that exist then.
  # run_tests uses this environment.
  mkdir -p "$ws/devel/lib/pkgconfig" "$ws/devel/lib/python3/dist-packages"
  link_sources
  local start log=$ws/build.log
  start=$(date +%s)
  touch "$ws/building"
  say "building in $ws ($build_type, $jobs jobs; log: $log)"
  env -u ROS_PACKAGE_PATH -u CMAKE_PREFIX_PATH CCACHE_BASEDIR="$ws/build" \
    catkin_make -C "$ws" --no-color -j"$jobs" -DCMAKE_BUILD_TYPE="$build_type" \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCATKIN_ENABLE_TESTING=ON -DBUILD_TESTING=OFF \
    -DAQUAFARM_BUILD_BENCH=OFF -DCMAKE_EXPORT_COMPILE_COMMANDS=ON "$unity" \
    "${warnings[@]}" "$@" 2>&1 |
    tee "$log" | { grep -E --line-buffered "$build_lines" || true; } || {
    { grep -A 8 -E '[Ee]rror' "$log" || tail -n 20 "$log"; } | head -n 60 >&2 || true
    die "the build failed; the whole log: $log"
  }
  mv "$ws/building" "$ws/built"
  say "built in $(($(date +%s) - start)) s"
}

build() { locked build_all "$@"; }

# shellcheck disable=SC2119
build_if_due() { is_built || build_all; }

ensure_built() {
  if is_built; then setup; else locked build_if_due; fi
}

# core NAME: builds a ROS-free core alone with plain cmake.
core() { locked build_core "$@"; }

# The sources have the path that catkin uses, so that ccache finds its results.
build_core() {
  local dir=$ws/core/$1 source=$ws/src/aquafarm/$1/core
  mkdir -p "$ws/core"
  link_sources
  use_ccache
  is_made_from "$dir" "$source" || rm -rf "$dir"
  say "building $1/core with plain cmake"
  if ! { cmake -S "$source" -B "$dir" -DCMAKE_BUILD_TYPE="$build_type" "$unity" "${warnings[@]}" &&
    CCACHE_BASEDIR="$ws/core" cmake --build "$dir" -j "$jobs"; } >"$dir.log" 2>&1; then
    tail -n 40 "$dir.log" >&2
    die "the plain cmake build of $1/core failed; log: $dir.log"
  fi
}

# build_tests LOG: builds the tests of the workspace.
build_tests() { CCACHE_BASEDIR="$ws/build" make -C "$ws/build" -k -j"$jobs" tests >"$1" 2>&1; }
