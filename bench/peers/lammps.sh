#!/usr/bin/env bash
# Breccia against LAMMPS and its bonds (package BPM, bpm/rotational) on the slab of cases/rc_slab: same
# elements, links and time step, alternating windows on one core.
#
#   bench/peers/lammps.sh LMP [arguments of compare.py after PEER]
#
# LMP is a program of LAMMPS, 4 May 2022 or later, with the packages BPM, MOLECULE and GRANULAR. Debian 12's
# is older and has no BPM.
set -euo pipefail
lmp=$(command -v "${1:?the program lmp of LAMMPS, with the package BPM}") || { echo "$1: no such program" >&2; exit 2; }
lmp=$(realpath "$lmp")
shift
cd "$(dirname "$0")/../.."

breccia=build/release/breccia
[ -x "$breccia" ] || { cmake --preset test && cmake --build --preset test --target breccia; }
python3 bench/peers/compare.py "$breccia" lammps --program "$lmp" --threads 1 "$@"
