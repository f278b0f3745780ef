#!/usr/bin/env bash
# Makes web/report/bundle, the page's program and style, from web/report/src. Needs node and npm; whoever builds Breccia does not.
#
#   scripts/build_report.sh           builds
#   scripts/build_report.sh --check   builds aside and proves that the bundle in the repository is that, byte for byte
set -euo pipefail
cd "$(dirname "$0")/../web/report"

out=bundle
if [ "${1:-}" = --check ]; then
  out=$(mktemp -d)
  trap 'rm -rf "$out"' EXIT
fi
[ -x node_modules/.bin/esbuild ] && [ node_modules/.package-lock.json -nt package-lock.json ] ||
  npm ci --no-audit --no-fund --silent

node_modules/.bin/esbuild src/main.js --bundle --minify --format=iife --target=es2022 --charset=utf8 \
  --legal-comments=none --log-level=warning --outfile="$out/report.js"
mv "$out/report.js" "$out/program.js"
mv "$out/report.css" "$out/style.css"
# The licences that the libraries ask for go with every report.
node licences.mjs > "$out/notice.txt"
{ printf '/*\n'; cat "$out/notice.txt"; printf '*/\n'; cat "$out/program.js"; } > "$out/report.js"
mv "$out/style.css" "$out/report.css"
rm "$out/program.js"
mv "$out/notice.txt" "$out/THIRD_PARTY_NOTICES.txt"

if [ "$out" != bundle ]; then
  for file in report.js report.css THIRD_PARTY_NOTICES.txt; do
    cmp "$out/$file" "bundle/$file" || { echo "web/report/bundle/$file is not what web/report/src gives; run scripts/build_report.sh" >&2; exit 1; }
  done
  node test/marks.mjs
  echo "web/report/bundle is what web/report/src gives"
fi
