#!/usr/bin/env bash
# Breccia against YADE and its concrete model on the slab of cases/rc_slab: same elements, links and time
# step, alternating windows. Installs YADE from Debian if it is missing. Arguments: those of
# compare.py after PEER, e.g. -o result.json --threads 1.
set -euo pipefail
cd "$(dirname "$0")/../.."

scripts/setup.sh yade
breccia=build/release/breccia
[ -x "$breccia" ] || { cmake --preset test && cmake --build --preset test --target breccia; }
python3 bench/peers/compare.py "$breccia" yade "$@"
