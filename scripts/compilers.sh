#!/bin/bash
# Builds the program with each compiler and level of optimisation (a folder build/compilers/NAME
# each) and compares the hashes of small cases. Arguments choose: scripts/compilers.sh clang++:-O1
# JOBS=N compiles N files at once; MPI=mpich takes that MPI (apt install libmpich-dev), else none.
cd "$(dirname "$0")/.." || exit 1
mkdir -p build/compilers
cases=(rc_slab brazilian_disc three_point_bending)
want=(8c4e0e5fd2d4ea49 9bc90f8c703c3df1 6110514d3dff4112)
kinds=("$@")
[ ${#kinds[@]} -gt 0 ] || kinds=(g++:-O1 g++:-O2 g++:-O3 clang++:-O1 clang++:-O2 clang++:-O3)
wrong=0
for kind in "${kinds[@]}"; do
  compiler=${kind%%:*} level=${kind#*:}
  folder=build/compilers/$compiler$level${MPI:+-$MPI}
  mpi=(-DBR_MPI=OFF)
  [ -n "$MPI" ] && mpi=(-DBR_MPI=ON -DMPI_C_COMPILER="mpicc.$MPI" -DMPIEXEC_EXECUTABLE="$(command -v "mpiexec.$MPI")")
  { cmake -G Ninja -B "$folder" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
      -DCMAKE_CXX_FLAGS_RELEASE="$level -DNDEBUG" -DBR_TESTS=OFF -DBR_PYTHON=OFF "${mpi[@]}" &&
    cmake --build "$folder" --target breccia -j "${JOBS:-2}"; } > "$folder.log" 2>&1 ||
    { echo "$kind: does not build, see $folder.log"; wrong=1; continue; }
  for k in "${!cases[@]}"; do
    launch=()
    [ -n "$MPI" ] && launch=("mpiexec.$MPI" -n 3)
    "${launch[@]}" "$folder/breccia" run "cases/${cases[k]}/small.toml" -o "$folder/${cases[k]}" --force -q \
      --threads 1 --set output.frames=0 > "$folder/${cases[k]}.log" 2>&1
    hash=$(sed -n 's/.*"state_hash": "\(.*\)".*/\1/p' "$folder/${cases[k]}/summary.json")
    if [ "$hash" = "${want[k]}" ]; then echo "$kind ${MPI} ${cases[k]}: $hash"
    else echo "$kind ${MPI} ${cases[k]}: $hash instead of ${want[k]}"; wrong=1; fi
  done
done
exit $wrong
