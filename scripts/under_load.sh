#!/bin/bash
# All tests of a build N times beside a load, to find those that pass on a quiet machine alone:
#   scripts/under_load.sh [N] [BUILD] [CTEST WORDS...]    20, build/release
# Two endless loops a processor take their share of it; half as many tests as processors run at once.
# Prints each test that failed with how often it did; ends with 1 if one did.
cd "$(dirname "$0")/.." || exit 1
rounds=${1:-20} build=${2:-build/release}
shift $(($# < 2 ? $# : 2))
cores=$(nproc)
loops=()
trap 'kill "${loops[@]}" 2> /dev/null' EXIT
for ((k = 0; k < 2 * cores; ++k)); do
  (while :; do :; done) &
  loops+=($!)
done
failed=$(mktemp)
for ((round = 1; round <= rounds; ++round)); do
  (cd "$build" && ctest -j $((cores > 1 ? cores / 2 : 1)) --timeout 1200 "$@") |
    sed -n 's/^[ \t]*[0-9]* - \([^ ]*\) (.*)$/\1/p' >> "$failed"
  echo "round $round of $rounds: $(sort -u "$failed" | wc -l) tests have failed so far"
done
sort "$failed" | uniq -c | sort -rn
[ ! -s "$failed" ]
