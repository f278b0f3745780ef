#!/usr/bin/env python3
"""Where prisms of `breccia test` break: share of the links broken after the peak that lie in one band, for
docs/validation-concrete.md.

    scripts/localisation.py [--elements 2000] [--seeds 3] [--binary build/release/breccia] [--device cpu] [--jobs 1]
    [-o out/localisation]

Prisms of c30 (cases/rc_slab, friction bounded) between smooth ends and between rough platens run with 20 frames. At the
frame where the stress has fallen to half of the peak: broken links, and those of them broken since the peak. The band is the
layer, a tenth of the height thick (20 mm), of the direction and place that hold most of the latter; a specimen that breaks
alike everywhere has as many of them there as it has links there, and somewhat more, since the band is the best of many: as many
links drawn at random say how much.
"""
import argparse
import concurrent.futures
import csv
import math
import pathlib
import random
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
import frames  # noqa: E402

KEYS = ["friction_cap=3e6", "broken_friction=0.6", "broken_rolling_limit=1"]
BAND = 0.02  # m


def run(binary, out, test, elements, seed, device):
    folder = out / f"{test}-{elements}-{seed}"
    if (folder / "summary.json").exists():
        return folder
    made = out / f"specimens-{elements}"
    if not list(made.glob(f"cases/{test}-{seed}-*.toml")):
        keys = [a for k in KEYS for a in ("--set", f"material.c30.{k}")]
        subprocess.run([binary, "test", ROOT / "cases/rc_slab", "--material", "c30", *keys, "--only", test, "--first-seed",
                        str(seed), "--seeds", "1", "--elements", str(elements), "--threads", "1", "--device", device, "-o", made], check=True,
                       stdout=subprocess.DEVNULL)
    text = next(made.glob(f"cases/{test}-{seed}-*.toml")).read_text()
    text = text.replace("frames = 0", "frames = 20", 1).replace("fields = false", "fields = true", 1)
    case = out / f"{test}-{elements}-{seed}.toml"
    case.write_text(text)
    subprocess.run([binary, "run", case, "-o", folder, "--threads", "1", "--device", device, "--force", "--no-progress"], check=True,
                   stdout=subprocess.DEVNULL)
    return folder


def stresses(folder):
    with open(folder / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))[1:]
    return [float(r["time"]) for r in rows], [abs(float(r["force_top"]) - float(r["force_bottom"])) / 0.02e6 for r in rows]


def directions(count=150):
    """Spread over the half sphere."""
    for k in range(count):
        z = (k + 0.5) / count
        angle = math.pi * (1 + math.sqrt(5)) * k
        r = math.sqrt(1 - z * z)
        yield r * math.cos(angle), r * math.sin(angle), z


def band(chosen, everything):
    """Most of the chosen places in one layer, their share, the share of all places there, its angle to the horizontal."""
    best = (0.0, 0.0, 0.0)
    for n in directions():
        along = sorted(n[0] * p[0] + n[1] * p[1] + n[2] * p[2] for p in chosen)
        first = 0
        for last, value in enumerate(along):
            while value - along[first] > BAND:
                first += 1
            share = (last - first + 1) / len(along)
            if share > best[0]:
                inside = sum(1 for p in everything if 0 <= n[0] * p[0] + n[1] * p[1] + n[2] * p[2] - along[first] <= BAND)
                best = (share, inside / len(everything), math.degrees(math.acos(n[2])))
    return best


def looked_at(folder):
    time, stress = stresses(folder)
    peak = max(range(len(stress)), key=stress.__getitem__)
    half = next((k for k in range(peak, len(stress)) if stress[k] < 0.5 * stress[peak]), len(stress) - 1)
    files = sorted((folder / "fields").glob("links_*.vtu"))
    shown = [frames.read(f) for f in files]
    at = lambda t: min(range(len(shown)), key=lambda k: abs(shown[k]["TIME"][0] - t))  # noqa: E731
    before, after = shown[at(time[peak])], shown[at(time[half])]
    places, ends = shown[0]["points"], shown[0]["connectivity"]
    ids = frames.first(folder)["id"]
    middle = {}
    for k in range(len(shown[0]["state"])):
        a, b = int(ends[2 * k]), int(ends[2 * k + 1])
        middle[tuple(sorted((ids[a], ids[b])))] = tuple(0.5 * (places[a][c] + places[b][c]) for c in range(3))

    def broken(frame, number):
        name = frames.read(str(files[number]).replace("links_", "elements_"))["id"]
        e = frame["connectivity"]
        return {tuple(sorted((name[int(e[2 * k])], name[int(e[2 * k + 1])]))) for k, s in enumerate(frame["state"]) if s >= 2}

    early, late = broken(before, at(time[peak])), broken(after, at(time[half]))
    new = [middle[pair] for pair in late - early if pair in middle]
    share, usual, angle = band(new, list(middle.values()))
    chance, there, _ = band(random.Random(1).sample(list(middle.values()), len(new)), list(middle.values()))
    return {"peak": stress[peak], "early": 100 * len(early) / len(middle), "late": 100 * len(late) / len(middle),
            "band": 100 * share, "links": 100 * usual, "ratio": share / usual, "chance": chance / there, "angle": angle}


def of_packing(what):
    given, test, seed = what
    return looked_at(run(given.binary, given.out, test, given.elements, seed, given.device))


def text(values, digits=0):
    return f"{statistics.mean(values):.{digits}f} +- {statistics.stdev(values) if len(values) > 1 else 0.0:.{digits}f}"


NAMES = {"compression_prism": "smooth ends", "platens_prism": "rough platens"}


def markdown(records):
    found = {}
    for one in records:
        found.setdefault((one["test"], int(one["elements"])), {}).setdefault(one["quantity"], []).append(float(one["value"]))
    lines = ["| prism | elements | n | strength, MPa | links broken at the peak; at half of it, % | of those broken in between, in the band, % | "
             "of all links, there, % | ratio | ratio of as many links drawn at random | band's slope, degrees |", "|---|---|---|---|---|---|---|---|---|---|"]
    for (test, elements), of in sorted(found.items(), key=lambda item: (item[0][1], item[0][0])):
        lines.append(f"| {NAMES[test]} | {elements:,} | {len(of['peak'])} | {text(of['peak'], 1)} | {text(of['early'])}; {text(of['late'])} | "
                     f"{text(of['band'])} | {text(of['links'])} | {text(of['ratio'], 2)} | {text(of['chance'], 2)} | {text(of['angle'])} |")
    return "\n".join(lines)


def main():
    p = argparse.ArgumentParser()
    p.add_argument("--binary", type=pathlib.Path, default=ROOT / "build/release/breccia")
    p.add_argument("-o", "--out", type=pathlib.Path, default=ROOT / "out" / "localisation")
    p.add_argument("--elements", type=int, default=2000)
    p.add_argument("--seeds", type=int, default=3)
    p.add_argument("--device", default="cpu")
    p.add_argument("--jobs", type=int, default=1)
    p.add_argument("--record", type=pathlib.Path, help="a file for the numbers of all specimens, as docs/results/localisation.csv")
    given = p.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    records = []
    for test in NAMES:
        with concurrent.futures.ProcessPoolExecutor(given.jobs) as pool:
            all_of = list(pool.map(of_packing, [(given, test, seed) for seed in range(1, given.seeds + 1)]))
        records += [{"test": test, "elements": given.elements, "seed": seed, "quantity": quantity, "value": f"{value:.9g}"}
                    for seed, found in enumerate(all_of, 1) for quantity, value in found.items()]
    print(markdown(records))
    if given.record:
        with open(given.record, "w", newline="") as file:
            writer = csv.DictWriter(file, list(records[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(records)


if __name__ == "__main__":
    main()
