#!/usr/bin/env python3
"""Does what Apptainer does with packaging/breccia.def, in roots that debootstrap makes: where Apptainer itself is not at hand.

    packaging/check_recipe.py FOLDER [--pristine ROOT]     as root, on Debian; FOLDER gets a root for each stage (8 GB)

Each stage begins as a bare Debian 12 (--pristine: a copy of that root); %files are copied as `cp -fLr` does, from here or from
the stage they name; %post runs by `/bin/sh -e`; then the last stage's %runscript runs `doctor`, a case and its report.
"""
import argparse
import atexit
import glob
import pathlib
import re
import shlex
import shutil
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
INSIDE = ["env", "-i", "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "HOME=/root", "DEBIAN_FRONTEND=noninteractive"]


def stages_of(text):
    """Of each stage its head and its sections: (title, lines); %files and its words first."""
    stages = []
    for part in re.split(r"^(?=Bootstrap:)", re.sub(r"^#.*\n", "", text, flags=re.M), flags=re.M):
        if not part.strip():
            continue
        head, *sections = re.split(r"^%", part, flags=re.M)
        keys = dict(re.findall(r"^(\w+): *(.+)$", head, flags=re.M))
        stages.append((keys, [(s.split("\n", 1)[0].split(), s.split("\n", 1)[1]) for s in sections]))
    return stages


def inside(root, script, *words, log=None):
    command = ["chroot", root, *INSIDE, "/bin/sh", "-e", "-c", script, "sh", *words]
    done = subprocess.run(command, stdout=log, stderr=subprocess.STDOUT if log else None)
    if done.returncode:
        raise SystemExit(f"{root}: exit code {done.returncode} of: {script.strip()[:200]}")


def copy(lines, source, root):
    for line in lines.splitlines():
        words = shlex.split(line)
        if not words:
            continue
        to = root / words[-1].lstrip("/")
        (to if words[-1].endswith("/") else to.parent).mkdir(parents=True, exist_ok=True)
        found = glob.glob(str(source / words[0].lstrip("/")))
        if not found:
            raise SystemExit(f"%files: no {words[0]} in {source}")
        subprocess.run(["cp", "-fLr", *found, to], check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--pristine", type=pathlib.Path)
    arguments = parser.parse_args()
    begin, roots, root, run = time.monotonic(), {}, None, None
    for keys, sections in stages_of((ROOT / "packaging/breccia.def").read_text()):
        assert keys["From"] == "debian:12", keys
        root = arguments.folder / keys["Stage"]
        arguments.folder.mkdir(parents=True, exist_ok=True)
        if arguments.pristine:
            subprocess.run(["cp", "-a", arguments.pristine, root], check=True)
        else:
            subprocess.run(["debootstrap", "--variant=minbase", "bookworm", root], check=True, stdout=subprocess.DEVNULL)
        shutil.copy("/etc/resolv.conf", root / "etc/")
        subprocess.run(["mount", "-t", "proc", "proc", root / "proc"], check=True)
        atexit.register(subprocess.run, ["umount", root / "proc"])
        roots[keys["Stage"]] = root
        for title, lines in sections:
            if title[0] == "files":
                copy(lines, roots[title[2]] if title[1:2] == ["from"] else ROOT, root)
            elif title[0] == "post":
                with open(arguments.folder / f"{keys['Stage']}.log", "w") as log:
                    inside(root, lines, log=log)
            elif title[0] == "runscript":
                run = lines
            else:
                raise SystemExit(f"%{title[0]} is not known here")
        print(f"{time.monotonic() - begin:5.0f} s  stage {keys['Stage']}", flush=True)
    case = "/usr/share/breccia/cases/spall_bar_3d/small.toml"
    for words in (["doctor"], ["run", case, "-o", "/tmp/out", "--threads", "1", "-q"], ["report", "/tmp/out"], ["render", "/tmp/out", "-o", "/tmp/film.mp4"]):
        inside(root, run, *words)
    for file in ("summary.json", "report.html"):
        assert (root / "tmp/out" / file).stat().st_size > 0, file
    print(f"{time.monotonic() - begin:5.0f} s  its runscript: doctor, a run, its report and film")


if __name__ == "__main__":
    main()
