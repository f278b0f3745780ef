#!/usr/bin/env python3
"""What single commands once did wrong: a model larger than the machine, `check` that passes what `run` refuses, lists of spheres
with odd first lines, energies beyond their ledger, full disks, devices and links in the place of files, messages that mislead.
Each command is run as it was found, and what must come of it is looked at. A build with its target `attack` is not needed."""

import os
import re
import resource
import signal
import subprocess
import sys
import threading
import time

import common
from common import Attack, arguments, breccia, resume, told

ROOT = os.path.join(common.HERE, "..", "..")
DEM = os.path.join(common.HERE, "dem.toml")
FDEM = os.path.join(common.HERE, "fdem.toml")
DISC = os.path.join(ROOT, "cases", "brazilian_disc", "small.toml")
SLAB = os.path.join(ROOT, "cases", "rc_slab", "small.toml")
WORDS = ("--threads", "1", "--no-progress", "--force")
SPHERES = """breccia = 1
method = "dem3d"
[time]
end = "1 us"
[material.c]
law = "concrete"
density = 2400.0
young = "30 GPa"
poisson = 0.2
tensile_strength = "2 MPa"
cohesion = "5 MPa"
softening = 10.0
[[body]]
name = "b"
material = "c"
shape = "file"
file = "{}"
volume = 0.01
"""


def limited(kind, value):
    return lambda: resource.setrlimit(kind, (value, value))


class Commands:
    def __init__(self):
        self.attack = Attack("commands of earlier defects", "runs")
        self.number = 0

    def path(self, *parts):
        return self.attack.path(*parts)

    def text(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def out(self):
        self.number += 1
        return self.path(f"out_{self.number}")

    def expect(self, command, done, codes, *parts, without=()):
        """The exit code is one of `codes`, the output holds the parts (regular expressions)."""
        self.attack.runs += 1
        code, said = done
        short = said[:300] + ("..." if len(said) > 300 else "")
        self.attack.expect(code in codes, f"{command}: ends with {code}, not {codes}: {short}")
        for part in parts:
            self.attack.expect(re.search(part, said) is not None, f"{command}: nothing like '{part}' is said: {short}")
        for part in without:
            self.attack.expect(re.search(part, said) is None, f"{command}: '{part}' is said: {short}")
        return said

    def run(self, case, *words, **how):
        folder = self.out()
        return breccia("run", case, "-o", folder, *WORDS, *words, **how), folder

    def both(self, name, case, codes, *parts, words=()):
        """`check` and `run` end alike."""
        self.expect(f"check, {name}", breccia("check", case, *words), codes, *parts)
        self.expect(f"run, {name}", self.run(case, *words, "--steps", "2")[0], codes, *parts)

    # Memory is planned, and set-up ends by a signal.
    def large_models(self):
        for count in ("2000000000", "1000000000"):
            words = ("--set", f"body.slab.pack.count={count}")
            self.both(f"{count} elements", SLAB, (5,), r"needs about [\d.]+ TB", r"[\d.]+ [MGT]B are available", words=words)
        done, _ = self.run(SLAB, "--set", "body.slab.pack.count=100000000", preexec_fn=limited(resource.RLIMIT_AS, 5 * 10**9))
        self.expect("10^8 elements in 5 GB", done, (5,), r"needs about [\d.]+ GB")
        for before in (0.3, 3.0):
            process = subprocess.Popen([common.PROGRAM, "run", SLAB, "-o", self.out(), *WORDS, "--set", "body.slab.pack.count=3000000"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(before)
            process.send_signal(signal.SIGTERM)
            begun = time.time()
            try:
                code = process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                code = "hang"
            self.expect(f"SIGTERM after {before} s of set-up", (code, f"took {time.time() - begun:.1f} s"), (-signal.SIGTERM, 143))

    # `check` refuses what `run` refuses.
    def check_as_run(self):
        with open(DISC) as file:
            disc = file.read()
        with open(FDEM) as file:
            plate = file.read()
        changed = {
            "a misspelt material of a body": re.sub(r'(?m)^material = "platen"', 'material = "platne"', disc),
            "no size": re.sub(r"(?m)^size = .*\n", "", plate, count=1),
            "mesh_size 0": re.sub(r"(?m)^mesh_size = .*", "mesh_size = 0.0", plate, count=1),
            "a mesh that is not there": re.sub(r"(?m)^size = .*\n", 'shape = "mesh"\nfile = "none.msh"\n', plate, count=1),
        }
        for name, text in changed.items():
            self.attack.expect(text not in (disc, plate), f"{name}: the case has nothing to change")
            self.both(name, self.text("changed.toml", text), (2, 3), r"line \d+")
        self.both("spheres that are not there", self.text("spheres.toml", SPHERES.format("none.csv")), (2, 3), r"line \d+", "none.csv")
        block = '[[body]]\nname = "{}"\nmaterial = "rock"\nsize = [0.02, 0.02]\nmesh_size = 0.005\nstructured = true\ncenter = [{}, 0.0]\n'
        head = plate[:plate.index("[[body]]")]
        self.both("bodies that overlap", self.text("overlap.toml", head + block.format("a", 0.0) + block.format("b", 0.012)), (2,), "overlap")
        self.both("bodies side by side", self.text("beside.toml", head + block.format("a", 0.0) + block.format("b", 0.03)), (0,))

    # Lists of spheres.
    def lists(self):
        rows = "0,0,0,0.1\n0.2,0,0,0.1\n"
        case = self.text("csv.toml", SPHERES.format("spheres.csv"))
        for name, text, codes, parts in (("names", "x,y,z,radius\n" + rows, (0,), (r"\b2\b",)), ("no names", rows, (0,), (r"\b2\b",)),
                                         ("a byte order mark", "\ufeff" + rows, (0,), (r"\b2\b",)),
                                         ("a letter in the first number", "0.0,0.0,0.0,0.1x\n" + rows, (2, 3), ("line 1",))):
            self.text("spheres.csv", text)
            self.expect(f"spheres, {name}", breccia("check", case), codes, *parts)
        secret = self.text("secret", "root:x:0:0:root,of,all,this\n")
        self.both("a foreign file as spheres", self.text("foreign.toml", SPHERES.format(secret)), (2, 3))
        for done in (breccia("check", self.path("foreign.toml")), self.run(self.path("foreign.toml"))[0]):
            self.expect("a foreign file is not shown", done, (2, 3), without=("root:x",))
        os.mkfifo(self.path("pipe"))
        self.both("a pipe as spheres", self.text("pipe.toml", SPHERES.format("pipe")), (3,), "pipe")

    # Energies and sizes beyond sense.
    def energies(self):
        for words in (("--set", "precision=mixed", "--set", "material.rock.joint.tension=1e300"), ("--set", "material.rock.joint.tension=1e300")):
            done, folder = self.run(FDEM, "--steps", "100", *words)
            if done[0] == 0:  # then within its ledger
                energy = told(folder, "energy") or {}
                self.attack.expect(all(abs(v) < 1e15 for v in energy.values() if isinstance(v, float)), f"run {' '.join(words)}: {energy}")
            self.expect(f"run {' '.join(words)}", done, (0, 2, 4))
        sphere = SPHERES.format("one.csv").replace('"1 us"', '"1 ms"') + '[[support]]\nname = "pull"\non = "b"\nfix = ["x"]\nvelocity = [1.0, 0.0, 0.0]\nramp = {}\n'
        self.text("one.csv", "0,0,0,0.1\n")
        for ramp in ("0.0", "1e-4"):
            done, folder = self.run(self.text("two.toml", sphere.format(ramp)))
            self.expect(f"a support that moves, ramp = {ramp}", done, (0,))
            self.attack.expect((told(folder, "energy") or {}).get("error_relative", 1.0) < 1e-3, f"ramp = {ramp}: energy {told(folder, 'energy')}")
        for words in ("material.c30.density=1e300", "material.c30.young=30 mPa", "material.c30.young=30", "material.c30.density=2.4"):
            self.both(words, DEM, (2,), words.split("=")[0].split(".")[-1], words=("--set", words))

    # Files that are no files, and full disks.
    def files(self):
        def small():
            resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
        for words in (("prepare", SLAB, "-o", self.path("p.br")), ("run", DEM, "-o", self.path("full"), *WORDS, "--steps", "30")):
            self.expect(f"{words[0]}, files of 4 kB", breccia(*words, preexec_fn=small), (3,), "cannot write|cannot be written")
        with open(self.path("keys"), "w") as file:
            code = subprocess.run([common.PROGRAM, "keys"], stdout=file, stderr=subprocess.DEVNULL, preexec_fn=small).returncode
        self.expect("keys, files of 4 kB", (code, ""), (3,))
        left = [name for name in os.listdir(self.path()) if ".tmp" in name]
        self.attack.expect(not left, f"temporary files stay: {left}")
        for words in (("run", DEM, "-o", self.path("said"), *WORDS, "--steps", "30"), ("check", DEM), ("keys",)):
            with open("/dev/full", "w") as file:
                code = subprocess.run([common.PROGRAM, *words], stdout=file, stderr=subprocess.DEVNULL).returncode
            self.expect(f"{words[0]} > /dev/full", (code, ""), (3,))
        os.mkfifo(self.path("target"))
        self.expect("prepare onto a pipe", breccia("prepare", DEM, "-o", self.path("target")), (3,), "cannot write")
        self.expect("bench onto a pipe", breccia("bench", DEM, "--steps", "5", "--json", self.path("target"), timeout=120), (2, 3))
        self.attack.expect(os.path.exists(self.path("target")) and not os.path.isfile(self.path("target")), "a pipe was replaced by a file")
        if os.geteuid() == 0:
            self.expect("prepare onto a device", breccia("prepare", DEM, "-o", "/dev/full"), (3,), "cannot write")
            self.attack.expect(not os.path.isfile("/dev/full"), "a device was replaced by a file")
        precious = self.text("precious", "precious\n")
        os.mkdir(self.path("shared"))
        for name in ("case.toml.tmp", "summary.json.tmp", "history.csv", "log.jsonl", "log.txt", "summary.json"):
            os.symlink(precious, self.path("shared", name))
        self.expect("run into planted links", breccia("run", DEM, "-o", self.path("shared"), *WORDS, "--steps", "30"), (0, 3))
        with open(precious) as file:
            self.attack.expect(file.read() == "precious\n", "a planted link was written through")
        self.history_lost()

    def history_lost(self):
        """history.csv goes while the run goes on: it does not end as if it were there."""
        folder = self.out()
        process = subprocess.Popen([common.PROGRAM, "run", DEM, "-o", folder, *WORDS, "--set", "time.end=20 ms", "--set", "checkpoint.wall=0.2 s"],
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        end = threading.Timer(60, process.kill)
        end.start()
        history = os.path.join(folder, "history.csv")
        while process.poll() is None and not os.path.exists(history):
            time.sleep(0.01)
        time.sleep(0.3)
        ran = process.poll() is None
        if os.path.exists(history):
            os.remove(history)
        said = process.communicate()[0]
        end.cancel()
        if ran:
            self.expect("history.csv is removed in mid-run", (process.returncode, said), (0, 3))
            self.attack.expect(process.returncode == 3 or os.path.exists(history) or "history" in said, "a run without its history says nothing")

    # Scripts, escapes and messages.
    def messages(self):
        script = self.text("evil.geo", f'SystemCall "touch {self.path("pwned")}";\nPoint(1) = {{0, 0, 0}};\n')
        with open(FDEM) as file:
            head = file.read()
        head = head[:head.index("[[body]]")]
        evil = self.text("evil.toml", head + f'[[body]]\nname = "b"\nmaterial = "rock"\nshape = "geo"\nfile = "{script}"\nmesh_size = 0.01\n')
        self.expect("check, a script of gmsh", breccia("check", evil), (0, 2), "needs --allow-scripts")
        self.expect("run, a script of gmsh", self.run(evil)[0], (2,), "--allow-scripts")
        self.attack.expect(not os.path.exists(self.path("pwned")), "a script ran without leave")
        self.expect("keys tells of scripts", breccia("keys"), (0,), "allow-scripts")
        escapes = self.text("esc.toml", 'breccia = 1\nmethod = "dem3d"\n"\\u001b[2J\\u202ekey" = 1\n')
        for done in (breccia("check", escapes), self.run(escapes)[0]):
            self.expect("escapes and marks of direction", done, (2,), without=("\x1b\\[2J", "\u202e"))
        self.both("a length as pressure", DEM, (2,), "pressure is wanted", words=("--set", "material.c30.young=8 mm"))
        self.both("a mass as time", DEM, (2,), "time is wanted", words=("--set", "time.end=5 kg"))
        many = self.text("many.toml", 'breccia = 1\nmethod = "dem3d"\n' + "[[body]]\n" * 200000)
        said = self.expect("200,000 empty bodies", breccia("check", many), (2,))
        self.attack.expect(len(said) < 20000, f"200,000 empty bodies are told of in {len(said)} bytes")
        for name, text, part in (("a missing bracket", "breccia = 1\n[time\nend = 1.0\n", "line 2"), ("a key twice", "breccia = 1\nseed = 1\nseed = 2\n", "line 3")):
            self.expect(name, breccia("check", self.text("syntax.toml", text)), (2,), part, without=(r"saw '\\n'", "floating-point"))
        with open(DEM) as file:
            text = file.read()
        nobody = self.text("nobody.toml", re.sub('on = "block"\nmax = .*', 'on = ""', text))
        self.expect("a support of a body without a name", breccia("check", nobody), (0,), "names no body")
        done, _ = self.run(DEM, "--set", "body.ball.velocity=[0.0, 0.0, -1e200]", "--steps", "5")
        self.expect("a velocity of 1e200", done, (2, 4), r"velocity|step \d+")
        for words in (("--set", "material.rock.joint.cohesion=5e-324"), ("--set", "material.rock.damping=1e308")):
            done, folder = self.run(FDEM, "--steps", "50", *words)
            self.expect(" ".join(words), done, (0, 2, 4), *((r"step \d+",) if done[0] == 4 else ()))
        for name in ("calibrate", "report"):
            self.expect(f"{name} --help", breccia(name, "--help"), (0,))
        done, folder = self.run(DEM, "--steps", "30")
        self.expect("a report", breccia("report", folder), (0,))
        self.attack.expect(os.path.exists(os.path.join(folder, "report.html")), "no report.html")
        self.expect("resume what has come to its end", resume(folder), (0, 2))


def main():
    arguments(__doc__, 0).parse_args()
    commands = Commands()
    for part in (commands.large_models, commands.check_as_run, commands.lists, commands.energies, commands.files, commands.messages):
        part()
    return commands.attack.end()


if __name__ == "__main__":
    sys.exit(main())
