#!/usr/bin/env bash
# Builds the command-line program of MUSEN, without its windows, for CUDA 13: BUILD/CMUSEN.
#
#   bench/peers/musen.sh SOURCE BUILD [JOBS] [ARCHITECTURE]
#
# SOURCE is a folder with MUSEN's source (tried: 1.74.2 of November 2025). It is copied to BUILD/source, and the copy is changed:
#   - CUDA 13 no longer tells two properties of a GPU: blocks have 512 threads, as MUSEN chooses on GPUs with fast double precision
#   - device code is C++17, as CUDA's own headers ask for, and they lie one folder deeper (cccl)
#   - it is compiled for one ARCHITECTURE alone (90: H100 and H200)
#   - Thrust's names hold the GPU architectures, which nvcc alone tells: files of other compilers are told them, too, or do not link
#   - of its models those of musen_slab.py alone are built, which halves the time
# Needs CUDA, protobuf and zlib (Debian: protobuf-compiler, libprotobuf-dev, zlib1g-dev).
set -euo pipefail
source=$(realpath "${1:?folder with the source of MUSEN}")
mkdir -p "${2:?folder to build in}"
build=$(realpath "$2")
jobs=${3:-2}
architecture=${4:-90}
[ -f "$source/CMusen/CMusen.cpp" ] || { echo "$source: no source of MUSEN" >&2; exit 2; }
command -v protoc > /dev/null || { echo "protoc is missing (Debian: protobuf-compiler)" >&2; exit 2; }
copy=$build/source
rm -rf "$copy"
cp -r "$source" "$copy"

# replace FILE PATTERN TEXT: stops where there is nothing to replace
replace() {
  grep -q "$2" "$copy/$1" || { echo "$1: there is no '$2'; another version of MUSEN?" >&2; exit 2; }
  sed -i "s|$2|$3|" "$copy/$1"
}
replace Modules/GeneralSources/BasicGPUFunctions.cuh 'prop.singleToDoublePrecisionPerfRatio > 4 ? 256 : 512' 512
replace Modules/ScriptInterface/ConsoleSimulator.cpp 'prop.memoryClockRate' 0
replace CMakeLists.txt 'SET(CMAKE_CUDA_STANDARD 14)' 'SET(CMAKE_CUDA_STANDARD 17)'
replace CMakeLists.txt '^  SET(CMAKE_CUDA_ARCHITECTURES .*' "  SET(CMAKE_CUDA_ARCHITECTURES $architecture)"
kept='Model(PPHertzMindlin|SBElastic)'
sed -i -E "/Constructor<C/{/<C$kept>/!d}" "$copy/Modules/GeneralSources/ModelManager.cpp"
find "$copy/Models" -name '*.cpp' -o -name '*.cu' | grep -vE "/$kept\.c" | xargs rm -f

export PATH=$PATH:/usr/local/cuda/bin
headers=$(dirname "$(dirname "$(command -v nvcc)")")/include/cccl
cmake -S "$copy" -B "$build" -DCMAKE_BUILD_TYPE=Release -DBUILD_GUI=OFF -DINSTALL_AUX_DATA=OFF -DCMAKE_POLICY_VERSION_MINIMUM=3.5 \
  -DCMAKE_CXX_FLAGS="-isystem $headers -D__CUDA_ARCH_LIST__=${architecture}0" -DCMAKE_EXE_LINKER_FLAGS='-static-libstdc++ -static-libgcc'
cmake --build "$build" --parallel "$jobs"
"$build/CMUSEN" -version
