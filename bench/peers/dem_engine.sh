#!/usr/bin/env bash
# Builds the slab of cases/rc_slab as a program of DEM-Engine: BUILD/dem_engine_slab. It needs a GPU to run.
#
#   bench/peers/dem_engine.sh SOURCE BUILD [JOBS] [ARCHITECTURE]
#
# SOURCE is a folder with DEM-Engine's source (tried: 2.1.0 of March 2026) and, at thirdparty/jitify/jitify.hpp, the one header of
# Jitify that it names as a submodule. It is copied to BUILD/source, and the copy is changed:
#   - dem_engine_slab.cpp is built in place of the demos
#   - it is compiled for one ARCHITECTURE alone (90: H100 and H200), to machine code
# The program compiles kernels when it starts: the folders kernel and DEM in BUILD, and CUDA's headers, must stay in their place.
set -euo pipefail
source=$(realpath "${1:?folder with the source of DEM-Engine}")
mkdir -p "${2:?folder to build in}"
build=$(realpath "$2")
jobs=${3:-2}
architecture=${4:-90}
slab=$(realpath "$(dirname "$0")")/dem_engine_slab.cpp
[ -f "$source/src/DEM/API.h" ] || { echo "$source: no source of DEM-Engine" >&2; exit 2; }
[ -f "$source/thirdparty/jitify/jitify.hpp" ] || { echo "$source/thirdparty/jitify/jitify.hpp is missing" >&2; exit 2; }
copy=$build/source
rm -rf "$copy"
cp -r "$source" "$copy"

# replace FILE PATTERN TEXT: stops where there is nothing to replace
replace() {
  grep -q "$2" "$copy/$1" || { echo "$1: there is no '$2'; another version of DEM-Engine?" >&2; exit 2; }
  sed -i "s|$2|$3|" "$copy/$1"
}
replace CMakeLists.txt 'add_subdirectory(src/demo)' "add_executable(dem_engine_slab $slab)\n\
target_link_libraries(dem_engine_slab simulator_multi_gpu)\n\
set_target_properties(dem_engine_slab PROPERTIES CXX_STANDARD 17 RUNTIME_OUTPUT_DIRECTORY \${CMAKE_BINARY_DIR})"
replace src/algorithms/CMakeLists.txt 'foreach(arch ${CUDASUP_ARCHITECTURES})' "foreach(arch $architecture)"
replace src/algorithms/CMakeLists.txt '${arch}-virtual' '${arch}-real'

export PATH=$PATH:/usr/local/cuda/bin
cmake -S "$copy" -B "$build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CUDA_ARCHITECTURES="$architecture" \
  -DCUDAToolkit_ROOT="$(dirname "$(dirname "$(command -v nvcc)")")"
cmake --build "$build" --parallel "$jobs" --target dem_engine_slab
ls -l "$build/dem_engine_slab"
