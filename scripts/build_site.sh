#!/usr/bin/env bash
# Builds the site of the documents in build/site/html, which needs no network, and checks every link of it.
# scripts/build_site.sh [PROGRAM [PYTHON_PACKAGE]]: those of build/release unless named.
# With BRECCIA_RESULTS=DIR the gallery and the table of checks are of the small cases in DIR, which are run if they are not there.
set -euo pipefail
cd "$(dirname "$0")/.."
program=${1:-build/release/breccia}
package=${2:-$(dirname "$program")/python}
stage=build/site/stage
katex=/usr/share/javascript/katex
for file in "$program" "$package/breccia/__init__.py" $katex/katex.js; do
  [ -e "$file" ] || { echo "$0: no $file (built by cmake --preset test; KaTeX: package libjs-katex)" >&2; exit 3; }
done
for tool in mkdocs doxygen; do
  command -v $tool > /dev/null || { echo "$0: no $tool (packages mkdocs-material and doxygen)" >&2; exit 3; }
done

rm -rf build/site
mkdir -p $stage/docs/reference $stage/katex
python3 scripts/stage_site.py $stage

"$program" keys --markdown > $stage/docs/reference/keys.md
python3 scripts/reference_commands.py "$program" > $stage/docs/reference/commands.md
PYTHONPATH=$package /usr/bin/python3 scripts/reference_python.py > $stage/docs/reference/python.md
python3 scripts/reference_cpp.py include/breccia/breccia.hpp > $stage/docs/reference/cpp.md
python3 scripts/reference_speed.py bench/results > $stage/docs/reference/speed.md
python3 scripts/build_gallery.py $stage/docs/gallery --program "$program" --results "${BRECCIA_RESULTS:-build/gallery}" ${BRECCIA_RESULTS:+--run}

cp $katex/katex.min.css $katex/katex.min.js $katex/contrib/auto-render.js $stage/katex/
mkdir $stage/katex/fonts && cp -L $katex/fonts/*.woff2 $stage/katex/fonts/
echo 'document.addEventListener("DOMContentLoaded", () => renderMathInElement(document.body, {delimiters: [
  {left: "\\(", right: "\\)", display: false}, {left: "\\[", right: "\\]", display: true}], throwOnError: true}));' > $stage/katex/start.js
echo '.equation { overflow-x: auto; overflow-y: hidden; } .md-typeset { overflow-wrap: break-word; } .md-nav__link { overflow-wrap: anywhere; } .md-typeset table:not([class]) th { min-width: 0; } .md-typeset table:not([class]) td, .md-typeset table:not([class]) th { padding: .4em .8em; } .md-typeset td:not(:first-child) code { word-break: normal; overflow-wrap: normal; } .md-typeset td:first-child code { white-space: nowrap; } @media (max-width: 600px) { .md-typeset td:first-child code { white-space: normal; } }' > $stage/site.css

/usr/bin/mkdocs build --strict --quiet
python3 scripts/check_links.py build/site/html
du -sh build/site/html
