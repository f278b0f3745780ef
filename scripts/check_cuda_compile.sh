#!/usr/bin/env bash
# Compiles every file with kernels by nvcc, where it is installed: the kernels must stay device code.
# Set-up and material constants are host work and hold no kernels.
set -euo pipefail
cd "$(dirname "$0")/.."

nvcc=$(command -v nvcc || true)
if [ -z "$nvcc" ]; then
  echo "nvcc is not installed: kernels were not compiled for a GPU"
  exit 0
fi
files=$(ls src/core/*.cpp src/dem/*.cpp src/fdem/*.cpp | grep -v -E \
  'src/(dem/(materials|restitution|link_lanes|setup)|fdem/(materials|kernel_lanes|setup|check_case|regions|mesh_edges))\.cpp')
flags=(-x cu -std=c++20 -Isrc -arch=sm_90 -fmad=false -prec-div=true -prec-sqrt=true -ftz=false
  -diag-suppress 20012,20014,177 -Xcompiler -fopenmp -c -o /dev/null)
echo "$files" | xargs -P 2 -I{} sh -c 'echo "nvcc {}"; "$0" "$@" {}' "$nvcc" "${flags[@]}"
echo "kernels compile with nvcc"
