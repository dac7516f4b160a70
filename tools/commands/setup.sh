# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash disable=SC2154,SC2034
# Installs what the suite needs; sourced by ./aquafarm.

# All packages that the suite needs from apt.
packages=(
  build-essential ccache cmake git ca-certificates
  catkin python3-catkin-pkg ros-core ros-core-dev ros-core-python-dev ros-message-generation
  libroscpp-dev librosbag-dev librostest-dev python3-rostest python3-rosbag python3-roslaunch
  rosbash libtf2-ros-dev libtf2-geometry-msgs-dev python3-tf2-ros libdiagnostic-updater-dev
  rviz librviz-dev libimage-transport-dev image-transport-tools libcv-bridge-dev python3-cv-bridge
  libopencv-dev libgif-dev libfreetype-dev python3-opencv python3-numpy python3-matplotlib python3-setuptools
  python3-scipy python3-skimage python3-contourpy python3-jinja2 python3-jsonschema
  python3-venv python3-torch python3-pandas python3-pytest python3-distributed pybind11-dev
  libtorch-dev libgloo-dev libopenblas0-pthread libblas-dev
  libeigen3-dev libyaml-cpp-dev libgtest-dev libbenchmark-dev librandom123-dev libcli11-dev
  nlohmann-json3-dev libgeographiclib-dev libstb-dev libnetcdf-dev libmuparser-dev
  libjs-dygraphs fonts-dejavu-core xvfb libgl1-mesa-dri iproute2
)

missing_packages() {
  comm -13 \
    <(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${packages[@]}" 2>/dev/null |
      sed -n 's/^installed //p' | sort -u) \
    <(printf '%s\n' "${packages[@]}" | sort -u)
}

setup() {
  local missing as_root=()
  command -v dpkg-query >/dev/null ||
    code=3 die "there is no dpkg (setup is made for Debian 12); install the equivalents of: ${packages[*]}"
  mapfile -t missing < <(missing_packages)
  [[ ${#missing[@]} -gt 0 ]] || return 0
  if [[ $(id -u) != 0 ]]; then
    if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [[ -t 0 ]]; }; then
      as_root=(sudo)
    else
      code=3 die "not root, so nothing was installed; as root run:
  apt-get install --no-install-recommends ${missing[*]}"
    fi
  fi
  command -v apt-get >/dev/null || code=3 die "there is no apt-get; install these packages by hand: ${missing[*]}"
  say "installing ${#missing[@]} packages with apt: ${missing[*]}"
  "${as_root[@]}" apt-get -q -o DPkg::Lock::Timeout=600 update ||
    say "apt-get update failed; continuing with the package lists of this machine"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y \
    -o DPkg::Lock::Timeout=600 install --no-install-recommends "${missing[@]}" ||
    code=3 die "apt-get install failed; install these packages by hand: ${missing[*]}"
  mapfile -t missing < <(missing_packages)
  [[ ${#missing[@]} == 0 ]] || code=3 die "still missing after apt-get install: ${missing[*]}"
}
