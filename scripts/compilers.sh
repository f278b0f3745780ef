#!/bin/bash
# Builds the program with each compiler and level of optimisation (a folder build/compilers/NAME
# each) and compares the hashes of small cases of all methods with those of build/release.
# Arguments choose: scripts/compilers.sh clang++:-O1
# JOBS=N compiles N files and runs N cases at once. MPI=mpich takes that MPI (apt install libmpich-dev), else none.
# LIMIT=N begins no compiler after N seconds; the order is drawn then.
# PARTS=methods compiles the libraries that hold numbers and links them with the rest of build/release: half the time.
cd "$(dirname "$0")/.." || exit 1
. scripts/relink.sh
mkdir -p build/compilers
cases=(cases/{rc_slab,brazilian_disc,three_point_bending,colliding_cubes_3d,spall_bar_3d}/small.toml tests/attack/{dem,fdem,fdem3,bolted,bolted_3d,fluids,coupled}.toml)
methods=(exec core domain dem fdem fdem3 prepare)
kinds=("$@") there=()
[ ${#kinds[@]} -gt 0 ] || kinds=(g++:-O1 g++:-O2 g++:-O3 clang++:-O1 clang++:-O2 clang++:-O3)

for kind in "${kinds[@]}"; do
  command -v "${kind%%:*}" > /dev/null && there+=("$kind") || echo "$kind: there is no ${kind%%:*} on this machine"
done
kinds=("${there[@]}")
[ -n "$LIMIT" ] && mapfile -t kinds < <(shuf -e "${kinds[@]}")

hash_of() {  # PROGRAM CASE FOLDER: of a run to its end, or of 400 steps of the cases of attacks
  local steps=()
  [[ $2 == tests/* ]] && steps=(--steps 400)
  "${launch[@]}" "$1" run "$2" -o "$3" --force -q --threads 1 --set output.frames=0 --set output.pictures=false "${steps[@]}" > "$3.log" 2>&1
  sed -n 's/.*"state_hash": "\(.*\)".*/\1/p' "$3/summary.json" > "$3.hash"
}

begin() {  # PROGRAM FOLDER: runs of all cases, JOBS at once, that go on while the next compiler builds
  rm -rf "$2"
  mkdir -p "$2"
  for k in "${!cases[@]}"; do
    while [ "$(jobs -rp | wc -l)" -ge "${JOBS:-2}" ]; do wait -n; done
    hash_of "$1" "${cases[k]}" "$2/$k" &
  done
}

build() {  # COMPILER LEVEL FOLDER: leaves the program as FOLDER/breccia
  local mpi=(-DBR_MPI=OFF) targets=(breccia)
  [ -n "$MPI" ] && mpi=(-DBR_MPI=ON -DMPI_C_COMPILER="mpicc.$MPI" -DMPIEXEC_EXECUTABLE="$(command -v "mpiexec.$MPI")")
  if [ "$PARTS" = methods ]; then  # the others are of build/release: one MPI
    mpi=()
    targets=("${methods[@]/#/br_}")
  fi
  cmake -G Ninja -B "$3" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$1" -DCMAKE_CXX_FLAGS_RELEASE="$2 -DNDEBUG" \
    -DBR_TESTS=OFF -DBR_BENCH=OFF -DBR_PYTHON=OFF "${mpi[@]}" && cmake --build "$3" --target "${targets[@]}" -j "${JOBS:-2}" || return 1
  [ "$PARTS" = methods ] || return 0
  local words=()
  for name in "${methods[@]}"; do words+=("libbr_$name.a=$PWD/$3/libbr_$name.a"); done
  if [[ $1 == clang* ]]; then  # its OpenMP, where CMake found it
    local omp
    omp=$(sed -n 's/^OpenMP_omp_LIBRARY:FILEPATH=//p' "$3/CMakeCache.txt")
    words+=(" -o = $omp -Wl,-rpath,${omp%/*} -o ")
  fi
  relink breccia "$3/breccia" "${words[@]}"
}

launch=()
begin build/release/breccia build/compilers/wanted
[ -n "$MPI" ] && launch=("mpiexec.$MPI" -n 3)
wrong=0 built=()
for kind in "${kinds[@]}"; do
  [ -n "$LIMIT" ] && [ "$SECONDS" -gt "$LIMIT" ] && break
  folder=build/compilers/${kind%%:*}${kind#*:}${MPI:+-$MPI}
  build "${kind%%:*}" "${kind#*:}" "$folder" > "$folder.log" 2>&1 || { echo "$kind: does not build, see $folder.log"; wrong=1; continue; }
  begin "$folder/breccia" "$folder/runs"
  built+=("$kind")
done
wait
for kind in "${built[@]}"; do
  for k in "${!cases[@]}"; do
    same=same wanted=$(cat "build/compilers/wanted/$k.hash")
    hash=$(cat "build/compilers/${kind%%:*}${kind#*:}${MPI:+-$MPI}/runs/$k.hash")
    [ -n "$hash" ] && [ "$hash" = "$wanted" ] || { same="instead of $wanted"; wrong=1; }
    echo "$kind $MPI ${cases[k]}: $hash $same"
  done
done
echo "${#cases[@]} hashes compared for ${built[*]}"
exit $wrong
