#!/usr/bin/env bash
# Compiles every file with kernels by nvcc, where it is installed: the kernels must stay device code.
# For one architecture and down to PTX, which ptxas would take most of the time to assemble; no object is made. The preset `cuda` compiles for all.
set -euo pipefail
cd "$(dirname "$0")/.."

nvcc=$(command -v nvcc || true)
[ -n "$nvcc" ] || [ ! -x /usr/local/cuda/bin/nvcc ] || nvcc=/usr/local/cuda/bin/nvcc
if [ -z "$nvcc" ]; then
  echo "nvcc is not installed: kernels were not compiled for a GPU"
  exit 0
fi
quick= # nvcc since CUDA 12.9: device code with few optimisations
[[ "$("$nvcc" --help)" != *--Ofast-compile* ]] || quick="-Ofc max"
cmake -S . -B build/cuda_check -G Ninja -DCMAKE_BUILD_TYPE=Release -DBR_CUDA=ON -DBR_TESTS=OFF \
  -DCMAKE_CUDA_COMPILER="$nvcc" -DCMAKE_CUDA_ARCHITECTURES=90-virtual -DCMAKE_CUDA_FLAGS_RELEASE="-O0 -DNDEBUG $quick" > /dev/null
python3 scripts/check_cuda_compile.py build/cuda_check
# Host files of dem and fdem are compiled alike without CUDA; those of exec and core are not.
ninja -C build/cuda_check -t targets all | sed -n 's/^\(CMakeFiles.br_\(exec\|core\).*\): CXX_COMPILER__.*/\1/p' | xargs ninja -C build/cuda_check
echo "kernels compile with nvcc"
