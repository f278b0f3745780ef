#!/bin/bash
# The rank tests with MPICH, whatever MPI the machine has: Debian's packages are unpacked below
# build/mpich and nothing is installed. MPI is seen by src/domain alone, so the other objects are
# those of build/release, which must be built. Arguments go to the tests (--gtest_filter=...).
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/relink.sh
root=$PWD/build/mpich/root
if [ ! -x "$root/usr/bin/mpiexec.hydra" ]; then
  packages=(mpich libmpich12 libmpich-dev)
  for library in libslurm38 libucx0 libhwloc15 libgfortran5; do
    dpkg -s "$library" > /dev/null 2>&1 || packages+=("$library")
  done
  mkdir -p build/mpich/packages
  (cd build/mpich/packages && apt-get download "${packages[@]}")
  for package in build/mpich/packages/*.deb; do dpkg -x "$package" "$root"; done
fi
libraries=$root/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
# Its compiler command knows the folders of an installed package alone.
sed "s#/usr/\(include\|lib\)/x86_64-linux-gnu#$root&#g" "$root/usr/bin/mpicc.mpich" > "$root/mpicc"
chmod +x "$root/mpicc"
build=build/mpich/build
{ cmake -G Ninja -B "$build" -DCMAKE_BUILD_TYPE=Release -DBR_MPI=ON -DBR_PYTHON=OFF \
  -DMPI_C_COMPILER="$root/mpicc" \
  -DMPIEXEC_EXECUTABLE="$root/usr/bin/mpiexec.hydra" &&
  cmake --build "$build" --target br_domain br_test_paths br_no_memory; } > build/mpich/log 2>&1 ||
  { tail -20 build/mpich/log; exit 1; }
mpi=$(sed -n 's/^MPI_\(mpi\|mpi_cxx\)_LIBRARY:FILEPATH=//p' build/release/CMakeCache.txt | head -1)
for target in breccia:breccia breccia_test_mpi:tests/breccia_test_mpi; do
  relink "${target%:*}" "$build/${target#*:}" "libbr_domain.a=$PWD/$build/libbr_domain.a" "$mpi=-Wl,-rpath,$libraries $libraries/libmpich.so" \
    "tests/CMakeFiles/br_test_paths=$PWD/$build/tests/CMakeFiles/br_test_paths"
done
ldd $build/breccia | grep "$libraries/libmpich" > /dev/null || { echo "breccia is not linked with MPICH" >&2; exit 1; }
[ $# -gt 0 ] || set -- --gtest_filter="ProgramOnRanks.*"  # the others start no ranks, or ask what their end is
"$build/tests/breccia_test_mpi" "$@"
