#!/usr/bin/env bash
# Sets grainlaw up on Debian 12 or Ubuntu: installs what is missing, builds, and runs the main job.
#   ./setup.sh          install, build, run the main job, say where the report is
#   ./setup.sh test     install, build, run the tests
# Needs root or sudo only while a package is missing. May be run again at any time.
set -euo pipefail
cd "$(dirname "$0")"

if [[ $# -gt 1 || ( $# -eq 1 && $1 != test ) ]]; then
  echo "setup: unknown argument '$*'; usage: ./setup.sh [test]" >&2
  exit 2
fi

packages=(g++ cmake ninja-build git ccache gnuplot-nox
  libeigen3-dev libsundials-dev libyaml-cpp-dev libcli11-dev libfmt-dev nlohmann-json3-dev catch2)

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
done
if ((${#missing[@]})); then
  echo "setup: installing ${missing[*]}"
  as_root=()
  if ((EUID != 0)) && command -v sudo >/dev/null; then
    as_root=(sudo)
  elif ((EUID != 0)); then
    echo "setup: run as root, or install them yourself: apt-get install ${missing[*]}" >&2
    exit 2
  fi
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
else
  echo "setup: every package is there"
fi

echo "setup: building into build/release"
cmake --preset release >/dev/null
cmake --build --preset release

if [[ ${1:-} == test ]]; then
  ctest --preset release
else
  echo "setup: running the main job"
  ./build/release/grainlaw element data/element/undrained_simple_shear.yaml data/element/annular_shear_cell.yaml \
    data/element/karlsruhe_undrained_triaxial.yaml
fi
