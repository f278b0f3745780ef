#!/usr/bin/env python3
"""Breccia and a peer on the same slab, in alternating windows on the same machine, or Breccia and MUSEN and DEM-Engine in one table.

Usage: compare.py BRECCIA yade|lammps [--program PEER] [-o RESULT.json] [--threads 1,2] [--windows N]
       compare.py BRECCIA table [--musen CMUSEN] [--musen-devices gpu,cpu] [--dem-engine PROGRAM] [--device cuda] [--threads N]
                          [--repeat N] [--limit SECONDS] [--copies N] [--slab FOLDER] [-o RESULT.json]

The table runs the programs one after the other (table.py); BRECCIA may be `none` where --slab gives what it exports. Otherwise a window is a number of whole steps of one program while the other ones wait. The ratio of two neighbouring
windows is what counts: the speed of a shared machine changes from minute to minute.
"""
import argparse
import datetime
import json
import os
import pathlib
import re
import statistics
import subprocess
import tempfile

import lammps_slab
import table

HERE = pathlib.Path(__file__).resolve().parent
RESULTS = HERE.parent / "results"
STEPS_BEFORE = 14  # a window: seven of them end before the rock meets the slab
STEPS_DURING = 40
IMPACT = 0.2e-3  # s
PARTS = ("before impact", "during impact")


class Program:
    """A running program that takes lines and answers with lines of JSON."""

    def __init__(self, process, answers, name, threads):
        self.process, self.answers, self.name, self.threads = process, answers, name, threads
        self.windows = {part: [] for part in PARTS}

    def ask(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return self.answer()

    def answer(self):
        line = self.answers.readline()
        if not line:
            raise SystemExit(f"{self.name} on {self.threads} threads ended, exit code {self.process.wait()}")
        return json.loads(line)

    def end(self):
        self.process.stdin.close()
        self.process.wait()


def start_breccia(program, threads):
    process = subprocess.Popen([program, "bench", "--paced", "--threads", str(threads)], text=True,
                               stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    return Program(process, process.stdout, "breccia", threads)


def start_yade(program, folder, threads):
    pipe = folder / "answers"
    if not pipe.exists():
        os.mkfifo(pipe)
    with open(folder / f"yade{threads}.log", "w") as log:
        process = subprocess.Popen([program or "yade", "-n", "-x", f"-j{threads}", HERE / "yade_slab.py", folder],
                                   text=True, stdin=subprocess.PIPE, stdout=log, stderr=log)
    yade = Program(process, open(pipe), "yade", threads)
    yade.scene = yade.answer()
    return yade


class Lammps(Program):
    """LAMMPS, which reads its input line by line and times each run itself."""

    def __init__(self, process, dt):
        super().__init__(process, lammps_slab.Answers(process), "lammps", 1)
        self.dt, self.steps = dt, 0

    def ask(self, line):
        verb, value = line.split()
        steps = int(value) if verb == "steps" else max(0, round(float(value) / self.dt) - self.steps)
        processor = self.processor_seconds()
        self.process.stdin.write(f'run {steps} pre no post no\nprint "DONE"\n')
        self.process.stdin.flush()
        said = self.answers.until("DONE")
        self.steps += steps
        interactions, fastest = self.answers.state(said)
        return {"seconds": float(re.search(r"Loop time of (\S+)", said)[1]), "processor_seconds": self.processor_seconds() - processor,
                "steps": steps, "time": self.steps * self.dt, "dt": self.dt, "interactions": interactions, "fastest": fastest,
                "memory": self.memory()}

    def processor_seconds(self):
        """User and system time of the process so far."""
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def memory(self):
        return 1024 * int(re.search(r"VmHWM:\s*(\d+)", pathlib.Path(f"/proc/{self.process.pid}/status").read_text())[1])


def start_lammps(program, folder, threads):
    if threads != 1:
        raise SystemExit("LAMMPS is compared on one core: --threads 1")
    elements, links, text = lammps_slab.write(folder)
    process = subprocess.Popen(["stdbuf", "-oL", program or "lmp", "-log", "none"], text=True, cwd=folder, stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    lammps = Lammps(process, float((folder / "dt.txt").read_text()))
    process.stdin.write(text)
    process.stdin.flush()
    said = lammps.answers.until("READY")
    version = re.search(r"LAMMPS \((.*?)\)", said)[1]
    lammps.scene = {"elements": elements, "links": lammps.answers.state(said)[0], "version": version}
    return lammps


START = {"yade": start_yade, "lammps": start_lammps}


def spread(values):
    return {"median": statistics.median(values), "min": min(values), "max": max(values)}


def text(values):
    s = spread(values)
    return f"{s['median']:9.2f}  ({s['min']:.2f} to {s['max']:.2f})"


def measure(programs, windows):
    for part, steps in zip(PARTS, (STEPS_BEFORE, STEPS_DURING)):
        if part == PARTS[1]:
            for program in programs:
                program.ask(f"until {IMPACT}")
        for _ in range(windows):
            for program in programs:  # A B A B
                program.windows[part].append(program.ask(f"steps {steps}"))


def nanoseconds(program, part, links, clock):
    return [1e9 * w[clock] / w["steps"] / links for w in program.windows[part]]


def compare(programs, peer, links):
    """All numbers of the comparison, printed as they are made."""
    result = {}
    for part in PARTS:
        here = result[part] = {}
        print(f"\n{part}{'':22}median    (least to most)")
        step = {(p.name, p.threads): nanoseconds(p, part, links, "seconds") for p in programs}
        for program in programs:
            key = f"{program.name}, {program.threads} threads"
            ns = step[program.name, program.threads]
            here[key] = {"ns_per_link_step": ns, "spread": spread(ns),
                         "processor_ns_per_link_step": nanoseconds(program, part, links, "processor_seconds")}
            print(f"  {key:28} {text(ns)} ns a link-step")
        for threads in sorted({p.threads for p in programs}):
            ratio = [y / b for y, b in zip(step[peer, threads], step["breccia", threads])]
            both = f"{peer} / breccia, {threads} threads"
            here[both] = {"ratio": ratio, "spread": spread(ratio)}
            print(f"  {both:28} {text(ratio)}")
            processor = [y / b for y, b in zip(*(here[f"{n}, {threads} threads"]["processor_ns_per_link_step"]
                                                 for n in (peer, "breccia")))]
            here[both]["processor_ratio"] = processor
            print(f"  {'  by processor time':28} {text(processor)}")
        for name in ("breccia", peer):
            most = max(p.threads for p in programs)
            if most == 1 or (name, 1) not in step:
                continue
            ratio = [o / m for o, m in zip(step[name, 1], step[name, most])]
            here[f"{name}, 1 / {most} threads"] = {"ratio": ratio, "spread": spread(ratio)}
            print(f"  {f'{name}, 1 / {most} threads':28} {text(ratio)}")
    return result


def export(breccia, folder):
    """The slab as elements.csv, links.csv and dt.txt. @returns what Breccia says of it"""
    scene = breccia.ask(f"export {folder}")
    (folder / "dt.txt").write_text(repr(scene["dt"]))
    return scene


def one_table(given):
    """Breccia, MUSEN and DEM-Engine in one table."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = given.slab or pathlib.Path(scratch)
        if not given.slab:
            breccia = start_breccia(given.breccia, 1)
            export(breccia, folder)
            breccia.end()
        rows = table.measure(given, folder, pathlib.Path(scratch))
    if given.output:
        result = {"date": datetime.date.today().isoformat(), "load": os.getloadavg(), "rows": rows}
        pathlib.Path(given.output).write_text(json.dumps(result, indent=2) + "\n")


def main():
    options = argparse.ArgumentParser()
    options.add_argument("breccia")
    options.add_argument("peer", choices=[*sorted(START), "table"])
    options.add_argument("--program", help="of the peer; default: its usual name")
    options.add_argument("-o", "--output", help="default: bench/results/PEER_slab.json, none for the table")
    options.add_argument("--threads", help="default: 1,2; of MUSEN on a CPU: 1")
    options.add_argument("--windows", type=int, default=7, choices=range(1, 8))
    of_table = options.add_argument_group("table")
    of_table.add_argument("--musen", help="CMUSEN, as musen.sh builds it")
    of_table.add_argument("--musen-devices", default="gpu", help="gpu, cpu, or both with a comma")
    of_table.add_argument("--dem-engine", help="dem_engine_slab, as dem_engine.sh builds it")
    of_table.add_argument("--device", default="cuda", help="of Breccia")
    of_table.add_argument("--repeat", type=int, default=3)
    of_table.add_argument("--limit", type=float, default=3600, help="no run begins after so many seconds")
    of_table.add_argument("--copies", type=int, default=1, help="slabs side by side")
    of_table.add_argument("--slab", type=pathlib.Path, help="folder with elements.csv, links.csv, dt.txt")
    given = options.parse_args()
    if given.peer == "table":
        given.threads = given.threads or "1"
        return one_table(given)
    counts = [int(n) for n in (given.threads or "1,2").split(",")]

    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        programs = []
        for threads in counts:
            breccia = start_breccia(given.breccia, threads)
            scene = export(breccia, folder)
            programs += [breccia, START[given.peer](given.program, folder, threads)]
        links = scene["links"]
        peer = programs[1]
        print(f"breccia: {scene['elements']} elements, {links} links\n"
              f"{given.peer} {peer.scene['version']}: {peer.scene['elements']} elements, "
              f"{peer.scene['links']} cohesive interactions\ntime step of both: {scene['dt']:.3g} s")
        if abs(peer.scene["links"] - links) > 0.01 * links:
            raise SystemExit("the two have not equally many links")
        measure(programs, given.windows)
        last = peer.windows[PARTS[1]][-1]
        result = {"date": datetime.date.today().isoformat(), "load": os.getloadavg(), "breccia": scene,
                  given.peer: {**peer.scene, "memory": last["memory"], "interactions_at_end": last["interactions"],
                               "fastest_at_end": last["fastest"]}}
        result.update(compare(programs, given.peer, links))
        for program in programs:
            program.end()
    output = pathlib.Path(given.output or RESULTS / f"{given.peer}_slab.json")
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(json.dumps(result, indent=2) + "\n")
    print(f"\n{given.peer} at the end: {last['interactions']} interactions, fastest {last['fastest']:.3g} m/s, "
          f"{last['memory'] / scene['elements'] / 1e3:.1f} kB an element\n{output}")


if __name__ == "__main__":
    main()
