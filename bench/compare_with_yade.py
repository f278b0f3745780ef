"""Breccia and YADE on the same slab, in alternating windows on the same machine.

Usage: compare_with_yade.py BRECCIA [-o RESULT.json] [--threads 1,2] [--windows N]

A window is a number of whole steps of one program while the other ones wait. The ratio of two neighbouring
windows is what counts: the speed of a shared machine changes from minute to minute.
"""
import argparse
import datetime
import json
import os
import pathlib
import statistics
import subprocess
import tempfile

HERE = pathlib.Path(__file__).parent
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


def start_yade(folder, threads):
    pipe = folder / "answers"
    if not pipe.exists():
        os.mkfifo(pipe)
    with open(folder / f"yade{threads}.log", "w") as log:
        process = subprocess.Popen(["yade", "-n", "-x", f"-j{threads}", HERE / "yade_slab.py", folder],
                                   text=True, stdin=subprocess.PIPE, stdout=log, stderr=log)
    yade = Program(process, open(pipe), "yade", threads)
    yade.scene = yade.answer()
    return yade


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


def compare(programs, links):
    """All numbers of the comparison, printed as they are made."""
    result = {}
    for part in PARTS:
        here = result[part] = {}
        print(f"\n{part}{'':20}median    (least to most)")
        step = {(p.name, p.threads): nanoseconds(p, part, links, "seconds") for p in programs}
        for program in programs:
            key = f"{program.name}, {program.threads} threads"
            ns = step[program.name, program.threads]
            here[key] = {"ns_per_link_step": ns, "spread": spread(ns),
                         "processor_ns_per_link_step": nanoseconds(program, part, links, "processor_seconds")}
            print(f"  {key:26} {text(ns)} ns a link-step")
        for threads in sorted({p.threads for p in programs}):
            ratio = [y / b for y, b in zip(step["yade", threads], step["breccia", threads])]
            here[f"yade / breccia, {threads} threads"] = {"ratio": ratio, "spread": spread(ratio)}
            print(f"  {f'yade / breccia, {threads} threads':26} {text(ratio)}")
            processor = [y / b for y, b in zip(*(here[f"{n}, {threads} threads"]["processor_ns_per_link_step"]
                                                 for n in ("yade", "breccia")))]
            here[f"yade / breccia, {threads} threads"]["processor_ratio"] = processor
            print(f"  {'  by processor time':26} {text(processor)}")
        for name in ("breccia", "yade"):
            most = max(p.threads for p in programs)
            if most == 1 or (name, 1) not in step:
                continue
            ratio = [o / m for o, m in zip(step[name, 1], step[name, most])]
            here[f"{name}, 1 / {most} threads"] = {"ratio": ratio, "spread": spread(ratio)}
            print(f"  {f'{name}, 1 / {most} threads':26} {text(ratio)}")
    return result


def main():
    options = argparse.ArgumentParser()
    options.add_argument("breccia")
    options.add_argument("-o", "--output", default=str(HERE / "results" / "yade_slab.json"))
    options.add_argument("--threads", default="1,2")
    options.add_argument("--windows", type=int, default=7, choices=range(1, 8))
    given = options.parse_args()
    counts = [int(n) for n in given.threads.split(",")]

    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        programs = []
        for threads in counts:
            breccia = start_breccia(given.breccia, threads)
            scene = breccia.ask(f"export {folder}")
            (folder / "dt.txt").write_text(repr(scene["dt"]))
            programs += [breccia, start_yade(folder, threads)]
        links = scene["links"]
        yade = programs[1]
        print(f"breccia: {scene['elements']} elements, {links} links\n"
              f"yade {yade.scene['version']}: {yade.scene['elements']} elements, "
              f"{yade.scene['links']} cohesive interactions\ntime step of both: {scene['dt']:.3g} s")
        if abs(yade.scene["links"] - links) > 0.01 * links:
            raise SystemExit("the two have not equally many links")
        measure(programs, given.windows)
        result = {"date": datetime.date.today().isoformat(), "load": os.getloadavg(), "breccia": scene,
                  "yade": {**yade.scene, "memory": yade.windows[PARTS[1]][-1]["memory"],
                           "interactions_at_end": yade.windows[PARTS[1]][-1]["interactions"]}}
        result.update(compare(programs, links))
        for program in programs:
            program.end()
    output = pathlib.Path(given.output)
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(json.dumps(result, indent=2) + "\n")
    print(f"\nmemory of yade: {result['yade']['memory'] / scene['elements'] / 1e3:.1f} kB an element\n{output}")


if __name__ == "__main__":
    main()
