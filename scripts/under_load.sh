#!/bin/bash
# All tests of a build N times beside a load, to find those that pass on a quiet machine alone:
#   scripts/under_load.sh [N] [BUILD] [CTEST WORDS...]    20, build/release
# Two endless loops a processor take their share of it; half as many tests as processors run at once.
# LIMIT=N ends after N seconds, WITHOUT=REGEX leaves tests out. Prints each test that failed with how often it did, and how many runs
# there were; ends with 1 if one failed.
cd "$(dirname "$0")/.." || exit 1
rounds=${1:-20} build=${2:-build/release}
shift $(($# < 2 ? $# : 2))
[ -n "$WITHOUT" ] && set -- "$@" -E "$WITHOUT"
cores=$(nproc)
loops=()
trap 'kill "${loops[@]}" 2> /dev/null' EXIT
for ((k = 0; k < 2 * cores; ++k)); do
  (while :; do :; done) &
  loops+=($!)
done
failed=$(mktemp) passed=0
stop=$((SECONDS + ${LIMIT:-1000000}))
for ((round = 1; round <= rounds && SECONDS < stop; ++round)); do
  limit=()
  [ -n "$LIMIT" ] && limit=(--schedule-random --stop-time "$(date -d "+$((stop - SECONDS)) seconds" +%T)")
  (cd "$build" && ctest -j $((cores > 1 ? cores / 2 : 1)) --timeout 1200 "${limit[@]}" "$@") > "$failed.round"
  # Those that LIMIT has cut are no failures.
  sed -n 's/^.*Test *#[0-9]*: \([^ ]*\) .*\*\*\*\(Failed\|Exception\|Not Run\|Timeout *1200\).*$/\1/p' "$failed.round" >> "$failed"
  passed=$((passed + $(grep -c ' Passed ' "$failed.round")))
  echo "round $round of $rounds: $(sort -u "$failed" | wc -l) tests have failed so far"
done
sort "$failed" | uniq -c | sort -rn
echo "$passed runs of tests passed, $(wc -l < "$failed") failed, of $rounds times $(cd "$build" && ctest -N "$@" | sed -n 's/^Total Tests: //p')"
[ ! -s "$failed" ]
