#!/usr/bin/env bash
# A stranger's path: installs the packages of build/package in a bare Debian 12 and goes from there to a case of one's own.
# As root, with the package debootstrap: packaging/check_clean_root.sh [FOLDER_OF_DEBS [ROOT]]. A ROOT that exists is taken as it is.
# BRECCIA_INSTEAD=FOLDER puts breccia-mpi or breccia-cuda of that folder in the place of breccia at the end; BRECCIA_WITH_COMPILER=1 builds the example.
set -euo pipefail
debs=${1:-build/package}
root=${2:-$(mktemp -d)/root}
tell() { printf '%5s s  %s\n' "$SECONDS" "$*"; }

[ -x "$root/usr/bin/apt-get" ] || debootstrap --variant=minbase bookworm "$root" > /dev/null
cp /etc/resolv.conf "$root/etc/"
mountpoint -q "$root/proc" || { mount -t proc proc "$root/proc" && trap 'umount "$root/proc"' EXIT; }
mkdir -p "$root/tmp/debs" && cp "$debs"/*.deb "$root/tmp/debs/"
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive sh -euc "mkdir -p /root/work; cd /root/work; $*"; }
SECONDS=0
tell "a bare Debian 12"
inside 'apt-get update -qq && apt-get install -y -qq --no-install-recommends /tmp/debs/*.deb > /tmp/apt.log 2>&1 || { tail -20 /tmp/apt.log; exit 1; }'
tell "installed: $(inside 'dpkg-query -W -f="\${Package} \${Version} \${Installed-Size} kB, " "*breccia*"; dpkg -l | grep -c ^ii') packages in all"
inside 'breccia --version; breccia doctor'
tell "doctor"
inside 'rm -rf out; breccia demo disc > demo.txt; tail -3 demo.txt; test -s out/demo/disc/report.html; ls -l out/demo/disc/report.html'
tell "demo and report"
inside 'rm -f beam.toml; breccia new beam; breccia check beam.toml > /dev/null; breccia run beam.toml --no-progress --until 1e-4 | tail -3; breccia report out/beam; breccia render out/beam -o beam.png'
tell "a case of one's own"
inside 'printf "import breccia as br\nsim = br.Simulation(\"beam.toml\", threads=1)\nsim.step(100)\nprint(sim.hash, sim.velocities.shape)\n" > own.py; python3 own.py; python3 /usr/share/doc/breccia/examples/bounce.py'
tell "Python"
inside 'for f in /usr/share/bash-completion/completions/breccia /usr/share/zsh/vendor-completions/_breccia /usr/share/fish/vendor_completions.d/breccia.fish; do test -s $f; done
  test -s /usr/include/breccia/breccia.hpp; test -s /usr/lib/cmake/breccia/breccia-config.cmake; test -s /usr/share/man/man1/breccia.1.gz -o -s /usr/share/man/man1/breccia.1'
inside 'for p in breccia python3-breccia libbreccia-dev breccia-doc; do grep -q "three.js authors" /usr/share/doc/$p/copyright; done'
tell "completions, manual page, header, CMake package, licences"
if [ "${BRECCIA_WITH_COMPILER:-}" ]; then
  inside 'apt-get install -y -qq --no-install-recommends g++ cmake make > /tmp/apt.log 2>&1; cmake -S /usr/share/doc/breccia/examples/library -B example > /dev/null; cmake --build example | tail -1'
  tell "the example of the library, built with find_package"
fi
if [ "${BRECCIA_INSTEAD:-}" ]; then
  cp "$BRECCIA_INSTEAD"/*.deb "$root/tmp/"
  inside 'rm -rf one two; breccia run beam.toml -o one --steps 100 -q --threads 1
    apt-get install -y -qq --no-install-recommends /tmp/breccia-*.deb > /tmp/apt.log 2>&1 || { tail -20 /tmp/apt.log; exit 1; }
    dpkg-query -W -f="\${Package} \${Installed-Size} kB\n" "breccia-*"; breccia --version; breccia doctor | grep -w "MPI\|GPU"
    breccia run beam.toml -o two --steps 100 -q --threads 1; grep -h state_hash one/summary.json two/summary.json | uniq | wc -l | grep -qx 1
    if breccia --version | grep -q CUDA; then code=0; breccia run beam.toml -o three --device cuda -q 2> said.txt || code=$?; cat said.txt
      [ $code -eq 0 ] || { [ $code -eq 5 ] && grep -q "this machine has no NVIDIA driver\|no CUDA-capable device" said.txt; }; fi
    if breccia doctor | grep -q "yes MPI"; then apt-get install -y -qq --no-install-recommends openmpi-bin > /tmp/apt.log 2>&1
      mpirun --allow-run-as-root --oversubscribe -n 2 breccia run beam.toml -o ranks --steps 100 -q --threads 1
      grep -h state_hash one/summary.json ranks/summary.json | uniq | wc -l | grep -qx 1; fi
    python3 -c "import breccia; print(breccia.Simulation(\"beam.toml\", threads=1).hash)"'
  tell "another program in its place: same hash, on two ranks as well; without a GPU it says so"
fi
inside 'apt-get purge -y -qq "breccia*" libbreccia-dev python3-breccia > /dev/null 2>&1; ! command -v breccia'
tell "taken away again"
