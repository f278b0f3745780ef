#!/usr/bin/env bash
# Installs a build into a scratch folder, builds the example against it, and runs what is there.
#
#   check_install.sh BUILD_FOLDER
set -euo pipefail
build=$(realpath "$1")
source=$(realpath "$(dirname "$0")/../..")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
root=$scratch/root
for component in core dev; do
  cmake --install "$build" --prefix "$root" --component $component > "$scratch/log" || { cat "$scratch/log"; exit 1; }
done
grep -q "three.js authors" "$root"/share/doc/breccia*/copyright || { echo "no licences of what the program holds"; exit 1; }
same() { [ "$1" = "$2" ] || { echo "$3: '$1' is not '$2'"; exit 1; }; }
lib=$(dirname "$(find "$root" -name 'libbreccia.so' | head -1)")
export LD_LIBRARY_PATH=$lib

# Nothing but the header's own functions leaves the library.
nm -DC --defined-only "$lib/libbreccia.so" | grep -v ' br::\| for br::' && { echo "libbreccia.so lets out more than include/breccia"; exit 1; }
for module in "$build"/python/breccia/_breccia.*.so; do
  [ ! -e "$module" ] || same "$(nm -D --defined-only "$module" | cut -d' ' -f3)" PyInit__breccia "what the Python module lets out"
done

# The example finds the package, and its steps have the bits of the installed program.
cmake -S "$source/examples/library" -B "$scratch/example" -DCMAKE_PREFIX_PATH="$root" -DCMAKE_BUILD_TYPE=Release > "$scratch/log" &&
  cmake --build "$scratch/example" >> "$scratch/log" || { cat "$scratch/log"; exit 1; }
case=$root/share/breccia/cases/rc_slab/small.toml
by_library=$("$scratch/example/fastest" "$case" 2e-5 | sed -n 's/^hash //p')
"$root/bin/breccia" run "$case" -o "$scratch/out" --until 2e-5 -q
by_program=$(sed -n 's/.*"state_hash": "\([0-9a-f]*\)".*/\1/p' "$scratch/out/summary.json")
same "$by_library" "$by_program" "hash of the example"

# An error keeps its text and its exit code.
code=0; "$scratch/example/fastest" "$scratch/none.toml" 1 2> "$scratch/said" || code=$?
same "$code" 3 "exit code for a case that is not there"
grep -q "none.toml" "$scratch/said"

# Shells take the completions, and offer commands and options.
offered=$(bash -c "source '$root/share/bash-completion/completions/breccia'
  COMP_WORDS=(breccia ru); COMP_CWORD=1; _breccia; echo \${COMPREPLY[*]}
  COMP_WORDS=(breccia run --thr); COMP_CWORD=2; _breccia; echo \${COMPREPLY[*]}
  COMP_WORDS=(breccia mesh in); COMP_CWORD=2; _breccia; echo \${COMPREPLY[*]}
  COMP_WORDS=(breccia mesh info --fr); COMP_CWORD=3; _breccia; echo \${COMPREPLY[*]}")
same "$offered" $'run\n--threads\ninfo\n--frame' "what bash offers"
if command -v zsh > /dev/null; then zsh -n "$root/share/zsh/vendor-completions/_breccia"; fi
if command -v fish > /dev/null; then
  offered=$(HOME=$scratch fish -c "source '$root/share/fish/vendor_completions.d/breccia.fish'; complete -C 'breccia run --thr'" | cut -f1)
  same "$offered" --threads "what fish offers"
  offered=$(HOME=$scratch fish -c "source '$root/share/fish/vendor_completions.d/breccia.fish'; complete -C 'breccia mesh in'; complete -C 'breccia mesh info --fr'" | cut -f1)
  same "$offered" $'info\n--frame' "what fish offers after mesh"
fi
if command -v man > /dev/null; then
  said=$(MANROFFSEQ='' man --warnings -E UTF-8 -l "$root/share/man/man1/breccia.1" 2>&1 > /dev/null)
  same "$said" "" "what man says of the page"
fi
grep -q '^.SS "breccia mesh info"' "$root/share/man/man1/breccia.1"
echo "installed, found, run"
