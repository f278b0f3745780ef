#!/bin/bash
# What takes longer than a gate may, in one table: attacks, sanitizers, compilers, MPICH, tests under
# load. HOURS=N (8) in all, of which each part has a share; what it has reached by then stands in its
# row, tests and compilers in an order drawn anew each night. Builds take their time beside that.
# JOBS=N compiles and tests N at once; from 32 on all parts but the last stand beside each other, with
# a fourth of them each. Logs stand in build/nightly. WITHOUT=REGEX leaves out tests of programs that
# the machine does not have (gmsh, VTK).
cd "$(dirname "$0")/.." || exit 1
export JOBS=${JOBS:-$(nproc)} WITHOUT
hours=${HOURS:-8}
mkdir -p build/nightly
[ -z "$WITHOUT" ] || echo "without $WITHOUT"
cmake --preset release -DBR_TESTS=ON -DBR_BENCH=ON > build/nightly/build.log 2>&1 && cmake --build build/release -j "$JOBS" >> build/nightly/build.log 2>&1 ||
  { echo "build/release does not build: build/nightly/build.log"; exit 1; }
rm -f build/nightly/wrong
part() {  # NAME SHARE COMMAND...
  local name=$1 begin=$SECONDS told=holds share=$2
  shift 2
  LIMIT=$(awk "BEGIN { print int($share * $hours * 3600) }") "$@" > "build/nightly/$name.log" 2>&1 || { told="FAILS, see build/nightly/$name.log"; touch build/nightly/wrong; }
  printf '%-12s %6s s  %s: %s\n' "$name" $((SECONDS - begin)) "$told" "$(tail -1 "build/nightly/$name.log")"
}
beside() {  # NAME SHARE COMMAND...
  if [ "$JOBS" -lt 32 ]; then part "$@"; return; fi
  local name=$1
  shift 2
  JOBS=$((JOBS / 4)) part "$name" 0.85 "$@" &
}
concrete() { BRECCIA=build/release/breccia LIBRARY_TESTS=all python3 tests/program/library_test.py 2>&1; }
attacks() { python3 tests/attack/run.py --jobs "$JOBS" --hours "$(awk "BEGIN { print $LIMIT / 3600 }")"; }
PARTS=methods beside compilers 0.1 scripts/compilers.sh
beside thread 0.25 scripts/sanitize.sh thread
beside address 0.15 scripts/sanitize.sh address
beside mpich 0.05 scripts/mpich.sh
beside attacks 0.3 attacks
beside concrete 0 concrete
wait
part under_load 0.15 scripts/under_load.sh 20
cat build/nightly/attacks.log
[ ! -e build/nightly/wrong ]
