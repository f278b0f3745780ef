#!/usr/bin/env bash
# Opens reports in a browser: no error, no request by network, no overflow on a phone, a view that follows the curves; then a run that
# `watch --serve` shows as it goes on, and the pages of build/site/html, if they are built.
# Needs node, npm and Debian's chromium; without them it says so and passes.
#
#   scripts/check_report.sh [PROGRAM [FOLDER]]    PROGRAM: default build/release/breccia; FOLDER keeps reports and screenshots
set -euo pipefail
cd "$(dirname "$0")/.."

program=$(realpath "${1:-build/release/breccia}")
for tool in node npm "${CHROMIUM:-/usr/bin/chromium}"; do
  command -v "$tool" > /dev/null || { echo "no $tool here: reports are not opened in a browser"; exit 0; }
done
out=${2:-}
[ -n "$out" ] || out=$(mktemp -d)
mkdir -p "$out"

scripts/build_report.sh --check
for case in rc_slab three_point_bending; do
  [ -e "$out/$case/summary.json" ] || "$program" run "cases/$case/small.toml" -o "$out/$case" --threads 1 -q
done
[ -e "$out/slow/summary.json" ] ||
  "$program" run cases/rc_slab/small.toml -o "$out/slow" --threads 1 -q --set "body.2.velocity=[0.0, 0.0, -5.0]"
printf 'time [ms];force [kN]\n0;0\n2;4,1\n4;10,5\n6;14,6\n6,3;13,0\n7;7,1\n' > "$out/beam.csv"

"$program" report "$out/rc_slab" -o "$out/space.html"
"$program" report "$out/three_point_bending" --data "$out/beam.csv" -o "$out/plane.html"
"$program" report "$out/rc_slab" "$out/slow" -o "$out/two.html"
(cd web/report && node test/open.mjs "$(realpath "$out")" "$(realpath "$out")"/{space,plane,two}.html)

# A run that goes on while the page is open.
live=$out/live
rm -rf "$live"
: > "$out/live.txt"
"$program" run cases/rc_slab/small.toml -o "$live" --threads 1 -q --set output.frames=30 --set output.pictures=false --until 1e-4
"$program" watch "$live" --serve > "$out/live.txt" &
server=$!
trap 'kill $server 2> /dev/null || true' EXIT # SIGINT is ignored in the background
until grep -q token= "$out/live.txt"; do sleep 0.1; done
(cd web/report && exec node test/live.mjs "$(grep -o 'http://.*token=[0-9a-f]*' "$out/live.txt")" "$(realpath "$out")/live.png" > "$(realpath "$out")/live.log") &
page=$!
until grep -q open "$out/live.log" 2> /dev/null || ! kill -0 $page 2> /dev/null; do sleep 0.5; done
"$program" resume "$live" --threads 1 -q --until 6e-4
wait $page
cat "$out/live.log"
kill $server
if [ -d build/site/html ]; then (cd web/report && node test/site.mjs ../../build/site/html "$(realpath "$out")"); fi
echo "reports open without an error, a request or an overflow"
