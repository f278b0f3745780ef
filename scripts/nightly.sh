#!/bin/bash
# What takes longer than a gate may, in one table: attacks, sanitizers, compilers, MPICH, tests under
# load. HOURS=N (8) for the attacks, JOBS=N compiles and tests N at once; logs stand in build/nightly.
cd "$(dirname "$0")/.." || exit 1
export JOBS=${JOBS:-$(nproc)}
mkdir -p build/nightly
cmake --preset release > build/nightly/build.log 2>&1 && cmake --build build/release -j "$JOBS" >> build/nightly/build.log 2>&1 ||
  { echo "build/release does not build: build/nightly/build.log"; exit 1; }
wrong=0
part() {  # NAME COMMAND...
  local name=$1 begin=$SECONDS told=holds
  shift
  "$@" > "build/nightly/$name.log" 2>&1 || { told="fails, see build/nightly/$name.log"; wrong=1; }
  printf '%-24s %6s s  %s\n' "$name" $((SECONDS - begin)) "$told"
}
part address scripts/sanitize.sh address
part thread scripts/sanitize.sh thread
part compilers scripts/compilers.sh
part mpich scripts/mpich.sh
part under_load scripts/under_load.sh 20
part attacks python3 tests/attack/run.py --hours "${HOURS:-8}"
cat build/nightly/attacks.log
exit $wrong
