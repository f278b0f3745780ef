#!/usr/bin/env bash
# Breccia against YADE and its concrete model on the slab of cases/rc_slab: same elements, links and time
# step, alternating windows. Installs YADE from Debian if it is missing. Arguments: those of
# compare_with_yade.py after BRECCIA, e.g. -o result.json --threads 1.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh yade
breccia=build/release/breccia
[ -x "$breccia" ] || { cmake --preset test && cmake --build --preset test --target breccia; }
python3 bench/compare_with_yade.py "$breccia" "$@"
