#!/usr/bin/env bash
# All that a GPU must show, in one command on a machine that has one: every shipped small case ends with the hash that the CPU
# gives, twice; compute-sanitizer finds nothing; fields through DLPack; the benchmarks.
# Usage: scripts/check_gpu.sh [BRECCIA] [MODELS]
#   BRECCIA  the program, default build/cuda/breccia
#   MODELS   a folder of prepared models (*.br, by 'breccia prepare') instead of cases/*/small.toml: needs no gmsh
set -euo pipefail
cd "$(dirname "$0")/.."

breccia=${1:-build/cuda/breccia}
if [ $# -ge 2 ]; then cases=("$2"/*.br); else cases=(cases/*/small.toml); fi
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

hash_of() {  # FOLDER ARGUMENTS: runs and prints the hash of the last state
  local folder=$out/$1
  shift
  "$breccia" run "$@" -o "$folder" --force --no-progress -q --set output.frames=0
  python3 -c 'import json, sys; print(json.load(open(sys.argv[1] + "/summary.json"))["state_hash"])' "$folder"
}

failed=0
for case in "${cases[@]}"; do
  cpu=$(hash_of cpu "$case")
  first=$(hash_of cuda "$case" --device cuda)
  again=$(hash_of cuda "$case" --device cuda)
  verdict=same
  [ "$cpu" = "$first" ] && [ "$cpu" = "$again" ] || { verdict=DIFFERENT; failed=1; }
  echo "$case: cpu $cpu, cuda $first and $again: $verdict"
  verdict=same  # energies, too, of which the hash knows nothing
  cmp -s "$out/cpu/history.csv" "$out/cuda/history.csv" || { verdict=DIFFERENT; failed=1; }
  echo "$case: history.csv of cpu and cuda: $verdict"
done

if command -v mpirun > /dev/null; then
  for case in "${cases[@]}"; do
    alone=$(hash_of cuda "$case" --device cuda --steps 600)
    ! grep -q '"coupling"' "$out/cuda/summary.json" || continue # spheres and tetrahedra: in one process
    mpirun --oversubscribe --allow-run-as-root -n 2 "$breccia" run "$case" --device cuda --steps 600 -o "$out/ranks" --force \
      --no-progress -q --set output.frames=0
    ranks=$(python3 -c 'import json, sys; print(json.load(open(sys.argv[1] + "/summary.json"))["state_hash"])' "$out/ranks")
    verdict=same
    [ "$alone" = "$ranks" ] || { verdict=DIFFERENT; failed=1; }
    echo "$case: one rank $alone, two ranks on the GPU $ranks: $verdict"
  done
fi

if command -v compute-sanitizer > /dev/null; then
  for tool in memcheck initcheck synccheck; do
    for case in "${cases[@]}"; do
      if compute-sanitizer --tool "$tool" --error-exitcode 1 "$breccia" run "$case" --device cuda --steps 150 \
        -o "$out/sanitized" --force --no-progress -q --set output.frames=0 > "$out/log" 2>&1; then
        echo "$tool $case: clean"
      else
        failed=1
        tail -n 20 "$out/log"
      fi
    done
  done
fi

if [ -e "$(dirname "$breccia")/python/breccia/__init__.py" ]; then # built with -DBR_PYTHON=ON
  PYTHONPATH=$(dirname "$breccia")/python LD_LIBRARY_PATH=$(dirname "$breccia") python3 scripts/check_dlpack.py "${cases[@]}" || failed=1
fi

"$breccia" bench slab slabs triangles --device cuda
exit "$failed"
