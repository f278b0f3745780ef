#!/usr/bin/env bash
# Opens reports in a browser: no error, no request by network, no overflow on a phone, a view that follows the curves.
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
[ -n "$out" ] || { out=$(mktemp -d); trap 'rm -rf "$out"' EXIT; }
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
echo "reports open without an error, a request or an overflow"
