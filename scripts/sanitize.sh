#!/bin/bash
# The program and its tests under sanitizers, in parts that fit a job of CI each:
#   scripts/sanitize.sh address [PART/PARTS]   AddressSanitizer, leaks, and undefined behaviour
#   scripts/sanitize.sh thread  [PART/PARTS]   ThreadSanitizer; the program and its tests on threads
# PART/PARTS takes every PARTS-th test; without it all. JOBS=N builds and tests N at once (2 unless
# told), LIMIT=N begins no test after N seconds of tests and draws their order, CXX=clang++ takes that
# compiler, WITHOUT=REGEX leaves out tests of programs that the machine does not have. Ends with 1 if
# something was found; what was found stands in build/sanitize/KIND/findings.
cd "$(dirname "$0")/.." || exit 1
kind=${1:-address} part=${2:-1/1}
folder=build/sanitize/$kind
case $kind in
address) sanitizers=address,undefined more=-fno-sanitize-recover=undefined checked=ON ;;
# g++: loops on threads of scripts/tsan_threads.cpp. No assertions, which would double its time.
thread) sanitizers=thread more= checked=OFF ;;
*) echo "address or thread" >&2; exit 2 ;;
esac
mkdir -p "$folder"
# Python is a foreign program to the sanitizers, and MPI to that of threads: of the rank tests only
# those on simulated ranks run then. Its shadow needs addresses that do not change: setarch -R.
cmake -G Ninja -B "$folder" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1" \
  -DCMAKE_CXX_COMPILER="${CXX:-g++}" -DCMAKE_CXX_FLAGS="$more" -DBR_CHECKED=$checked -DBR_SANITIZE=$sanitizers \
  -DBR_PYTHON=OFF > "$folder.log" 2>&1 &&
  setarch -R cmake --build "$folder" -j "${JOBS:-2}" >> "$folder.log" 2>&1 || { tail "$folder.log"; exit 1; }
findings=$PWD/$folder/findings
rm -rf "$findings"; mkdir -p "$findings"
export ASAN_OPTIONS="log_path=$findings/asan:detect_stack_use_after_return=1:allocator_may_return_null=1:verify_asan_link_order=0:handle_sigill=1"
export LSAN_OPTIONS="suppressions=$PWD/scripts/lsan.supp:print_suppressions=0"
export UBSAN_OPTIONS="log_path=$findings/ubsan:print_stacktrace=1"
export TSAN_OPTIONS="log_path=$findings/tsan:die_after_fork=0"
export OMP_NUM_THREADS=2
# The program first: run, resume, prepared model, picture, all methods.
breccia=$folder/breccia
commands_of() {  # CASE
  local out=$folder/out_$1
  for words in "run tests/attack/$1.toml -o $out --force -q --threads 2 --steps 60" \
    "resume $out -q --threads 2 --steps 120" "prepare tests/attack/$1.toml -o $out.br" \
    "run $out.br -o $out --force -q --threads 2 --steps 40 --set audit.every=5" \
    "info $out.br" "check tests/attack/$1.toml" "render $out -o $out.png"; do
    # shellcheck disable=SC2086
    setarch -R "$breccia" $words > "$out.log" 2>&1 || { echo "$words: ends with $?"; tail -3 "$out.log"; touch "$findings/program"; }
  done
}
for name in dem fdem fdem3 bolted bolted_3d fluids coupled; do
  while [ "$(jobs -rp | wc -l)" -ge "${JOBS:-2}" ]; do wait -n; done
  commands_of $name &
done
wait
cd "$folder" || exit 1
without=${WITHOUT:-none}
[ "$kind" = thread ] && without="$without|ProgramOnRanks|FateOfRank"
limit=() cut='^$'
if [ -n "$LIMIT" ]; then # what it cuts stands there as timed out before its time
  limit=(--schedule-random --stop-time "$(date -d "+$LIMIT seconds" +%T)")
  cut='Timeout +[0-5]?[0-9]?[0-9][.]'
fi
setarch -R ctest -E "$without" -j "${JOBS:-2}" -I "${part%/*},,${part#*/}" --timeout 600 "${limit[@]}" > ctest.log 2>&1
grep '\*\*\*' ctest.log | grep -vE "$cut" && touch "$findings/tests"
ended=$(grep -c ' Passed ' ctest.log)
all=$(ctest -N -E "$without" -I "${part%/*},,${part#*/}" | sed -n 's/^Total Tests: //p')
tail -20 ctest.log
if [ -n "$(ls "$findings")" ]; then echo "found: $(ls "$findings" | tr '\n' ' ')"; exit 1; fi
echo "$kind $part: nothing found in the program and $ended of $all tests"
