#!/usr/bin/env bash
# Installs packages of Debian 12 by name; quick when all is there.
#   scripts/setup.sh [PACKAGE...]            what Breccia is built and tested with, and further packages
#   scripts/setup.sh --program [PACKAGE...]  what the program alone is built and run with
set -euo pipefail

packages=(g++ cmake ninja-build git
  libfmt-dev zlib1g-dev libdeflate-dev libpng-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libxxhash-dev libqhull-dev libstb-dev
  libcpp-httplib-dev libhdf5-dev libnlopt-dev pkg-config libopenmpi-dev openmpi-bin gmsh)
if [ "${1:-}" = --program ]; then
  shift
else
  packages+=(libgtest-dev libbenchmark-dev python3-dev python3-numpy pybind11-dev python3-vtk9 python3-meshio python3-pandas python3-h5py)
fi
packages+=("$@")

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
[ "${#missing[@]}" -eq 0 ] && exit 0

as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)
echo "installing: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
