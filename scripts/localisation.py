#!/usr/bin/env python3
"""Where prisms of `breccia test` break: share of the links broken after the peak that lie in one band, for
docs/validation-concrete.md;
and where pulled ones part, for docs/theory.md.

    scripts/localisation.py [--concrete C30] [--elements 2000] [--seeds 3] [--binary build/release/breccia] [--device cpu] [--jobs 1]
    [-o out/localisation]
    scripts/localisation.py --pulled [--only TEXT] [--record docs/results/grips.csv]

Prisms of c30 (cases/rc_slab, friction bounded), or of a concrete of the library, between smooth ends and between rough platens run with 20 frames. At the
frame where the stress has fallen to half of the peak: broken links, and those of them broken since the peak. The band is the
layer, a tenth of the height thick (20 mm), of the direction and place that hold most of the latter; a specimen that breaks
alike everywhere has as many of them there as it has links there, and somewhat more, since the band is the best of many: as many
links drawn at random say how much.

--pulled: prisms of C30 as the library had it before its links were damped (`keyed_specimens.LOCAL_C30`), as `breccia test --only tension` makes them, with other damping, rates, grips and packings (`PULLED`), until they have parted, and
its other specimens with other damping and rates (`DAMPED`). Lines of --record that are not made anew stay.
"""
import argparse
import concurrent.futures
import csv
import json
import math
import pathlib
import random
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
import frames  # noqa: E402
import keyed_specimens  # noqa: E402
import published_runs  # noqa: E402

KEYS = ["friction_cap=3e6", "broken_friction=0.6", "broken_rolling_limit=1"]
BAND = 0.02  # m


def run(binary, out, test, elements, seed, device, concrete):
    folder = out / f"{test}-{elements}-{seed}{concrete}"
    if (folder / "summary.json").exists():
        return folder
    made = out / f"specimens-{elements}{concrete}"
    if not list(made.glob(f"cases/{test}-{seed}-*.toml")):
        keys = [a for k in ([f"use={concrete}"] if concrete else KEYS) for a in ("--set", f"material.c30.{k}")]
        done = subprocess.run([binary, "test", ROOT / "cases/rc_slab", "--material", "c30", *keys, "--only", test, "--first-seed",
                               str(seed), "--seeds", "1", "--elements", str(elements), "--threads", "1", "--device", device, "-o", made],
                              stdout=subprocess.DEVNULL)
        if done.returncode not in (0, 9):  # 9: a strength beside its target
            raise SystemExit(f"{test} {seed} ended with {done.returncode}")
    text = next(made.glob(f"cases/{test}-{seed}-*.toml")).read_text()
    text = text.replace("frames = 0", "frames = 20", 1).replace("fields = false", "fields = true", 1)
    case = out / f"{folder.name}.toml"
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
    return looked_at(run(given.binary, given.out, test, given.elements, seed, given.device, given.concrete))


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
        name, *concrete = test.split()
        lines.append(f"| {', '.join([NAMES[name], *concrete])} | {elements:,} | {len(of['peak'])} | {text(of['peak'], 1)} | {text(of['early'])}; {text(of['late'])} | "
                     f"{text(of['band'])} | {text(of['links'])} | {text(of['ratio'], 2)} | {text(of['chance'], 2)} | {text(of['angle'])} |")
    return "\n".join(lines)


# ---------------------------------------------------------------- pulled prisms

LOCAL = "".join(f"{key} = {value}\n" for key, value in keyed_specimens.LOCAL_C30.items())
HALF, SECTION, SPEED = 0.1, 0.01, 0.02  # m, m2, m/s of each end
# The first is what `breccia test` does; layer: of a grip, in radii of equal elements; end: ms, at the full rate.
PLAIN = {"elements": 4000, "fabric": "faces", "damping": 0.3, "rate": 1, "layer": 2, "fix": "z", "pack": "0.6, 1.4", "periodic": "", "end": 8}
AS_TESTED = {"elements": 1200, "pack": "0.56, 1.443", "end": 2.5}  # C30 as it was calibrated, to a strain of 0.05 %
SHORT = {"end": 6}
PULLED = [({}, 6), (SHORT, range(7, 13)), ({"damping": 0.0}, 6), ({"damping": 0.05} | SHORT, 12), ({"rate": 0.25}, 6), ({"damping": 0.05, "rate": 0.5} | SHORT, 6), ({"layer": 6}, 6),
          ({"periodic": "z"}, 6), ({"damping": 0.05, "periodic": "z"} | SHORT, 6), ({"damping": 0.05, "fix": "all"} | SHORT, 6), ({"fabric": "packed"}, 6), ({"fabric": "packed", "damping": 0.05} | SHORT, 6),
          ({"fabric": "even"}, 4), ({"fabric": "even", "damping": 0.05} | SHORT, 6), *(({"elements": 1200, "damping": damping} | SHORT, 6) for damping in (0.3, 0.05, 0.0)),
          *((AS_TESTED | {"damping": damping, "rate": rate}, 4) for damping, rate in ((0.3, 1), (0.3, 0.25), (0.05, 1), (0.05, 0.25), (0.0, 1))), *((AS_TESTED | {"elements": 2400, "damping": d}, 4) for d in (0.3, 0.05))]
DAMPED = [("compression_prism", damping, rate, 1200, (1, 2, 3)) for damping in (0.3, 0.05) for rate in (1, 0.25)]
DAMPED += [(test, damping, 1, 1200, (1, 2, 3)) for test in ("brazilian", "tension_notched") for damping in (0.3, 0.05)]
DAMPED += [("compression_prism", 0.0, 1, n, (5, 6, 7)) for n in (600, 1200, 2400, 4800)] + [("tension", 0.0, 1, n, (5, 6, 7)) for n in (600, 1200, 2400)]  # with 0.3 it shows 38 MPa and 2.96 MPa
RECORD = ["setting", "seed", "commit", "device", "hash", "quantity", "value"]


def radius_of(of):
    """Of equal elements; of the mean one."""
    solid = float(of["pack"].split(",")[0])
    equal = (0.75 * 2 * HALF * SECTION * solid / math.pi / of["elements"]) ** (1 / 3)
    return equal, equal * 1.5 / 3.75 ** (1 / 3)


def pulled_case(of, seed):
    compactness, reach = of["pack"].split(", ")
    layer = HALF - of["layer"] * radius_of(of)[0]
    text = f"""breccia = 1
method = "dem3d"
seed = {seed}
local_damping = {of["damping"]}
[time]
end = {of["end"] * 1e-3 / of["rate"]!r}
[output]
frames = 0
history = {(16e-6 if of["end"] == 6 else 1e-6 * of["end"]) / of["rate"]!r}
fields = false
pictures = false
[energy]
stop = 0.1
[search]
margin = 0.5
[links]
range = {reach}
[material.c]
use = "C30"
{LOCAL}rate = "none"
fabric = "{of["fabric"]}"
[[body]]
name = "specimen"
material = "c"
size = [0.1, 0.1, {2 * HALF}]
[body.pack]
count = {of["elements"]}
size_ratio = 2.0
compactness = {compactness}
periodic = {json.dumps(list(of["periodic"]))}
"""
    for name, least, most, side in (("top", layer, 1.0, 1), ("bottom", -1.0, -layer, -1)):
        speed = side * SPEED * of["rate"]
        text += (f'[[support]]\nname = "{name}"\nmin = [-1.0, -1.0, {least!r}]\nmax = [1.0, 1.0, {most!r}]\nfix = {json.dumps(of["fix"].split())}\n'
                 f'velocity = [0.0, 0.0, {speed!r}]\nramp = {2.5e-4 / of["rate"]!r}\n[[probe]]\nname = "{name}"\non = "{name}"\nquantity = "force_z"\nreduce = "sum"\n')
    return text + (f'[[probe]]\nname = "middle"\nquantity = "stress_zz"\nmin = [-0.06, -0.06, {-0.2 * HALF}]\nmax = [0.06, 0.06, {0.2 * HALF}]\n')


def pull(of, seed, given):
    folder = given.out / ("pulled-" + "-".join(str(of[key]).replace(" ", "") for key in PLAIN) + f"-{seed}")
    if not (folder / "summary.json").exists():
        case = folder.parent / f"{folder.name}.toml"
        case.write_text(pulled_case(of, seed))
        subprocess.run([given.binary, "run", case, "-o", folder, "--threads", "1", "--device", given.device, "--force", "--no-progress"], check=True, stdout=subprocess.DEVNULL)
    summary = json.loads((folder / "summary.json").read_text())
    with open(folder / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))[1:]
    forces = [0.5 * (float(row["bottom"]) - float(row["top"])) for row in rows]
    peak = max(range(len(forces)), key=forces.__getitem__)
    with open(folder / "broken_links.csv", newline="") as file:
        depth = [HALF - abs(float(row["z"])) for row in list(csv.DictReader(file))[1:]]
    found = {"strength": forces[peak] / SECTION / 1e6, "middle": 1.44 * float(rows[peak]["middle"]) / 1e6}
    if depth:
        found |= {"depth": 1e3 * statistics.mean(depth), "ends": sum(d < 4 * radius_of(of)[1] for d in depth) / len(depth)}
    return lines({key: value for key, value in of.items() if value != PLAIN[key]}, seed, summary, found)


def lines(setting, seed, summary, found):
    about = (json.dumps(setting), seed, summary["breccia"]["commit"], summary["machine"]["device"], summary["state_hash"])
    return [dict(zip(RECORD, (*about, quantity, f"{value:.9g}"))) for quantity, value in found.items()]


def damp(test, damping, rate, elements, seed, given):
    """A specimen of `breccia test` with C30."""
    folder = given.out / f"damped-{test}-{damping}-{rate}-{elements}-{seed}"
    if not (folder / "summary.json").exists():
        made, case = given.out / f"made-{test}-{elements}-{seed}", given.out / "c30.toml"
        case.write_text('breccia = 1\nmethod = "dem3d"\n[time]\nend = 1e-3\n[links]\nrange = 1.443\n[material.c]\nuse = "C30"\n' + LOCAL +
                        '[[body]]\nname = "b"\nmaterial = "c"\nsize = [0.1, 0.1, 0.1]\npack = { count = 300, size_ratio = 2.0, compactness = 0.56 }\n')
        if not list(made.glob("cases/*.toml")):
            subprocess.run([given.binary, "test", case, "--material", "c", "--only", test, "--first-seed", str(seed), "--seeds", "1", "--elements", str(elements),
                            "--threads", "1", "-o", made], stdout=subprocess.DEVNULL)
        keys = [f"local_damping={damping}"]
        if rate != 1:  # 0.6/s and a ramp of a tenth of the time
            keys += [f"time.end={5e-3 / 0.6 / rate}", *(f"support.{name}.velocity=[0,0,{speed * rate}]" for name, speed in (("top", -0.06), ("bottom", 0.06))),
                     *(f"support.{name}.ramp={5e-4 / 0.6 / rate}" for name in ("top", "bottom"))]
        subprocess.run([given.binary, "run", next(made.glob("cases/*.toml")), "-o", folder, "--threads", "1", "--device", given.device, "--force", "--no-progress",
                        *(a for key in keys for a in ("--set", key))], check=True, stdout=subprocess.DEVNULL)
    with open(folder / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))[1:]
    forces = [0.5 * abs(float(row["force_bottom"]) - float(row["force_top"])) for row in rows]
    section = {"brazilian": math.pi * 0.15 * 0.05 / 2, "tension_notched": 0.05 * 0.1}.get(test, SECTION)
    found = {"strength": max(forces) / section / 1e6}
    if test == "tension_notched":
        found["fracture_energy"] = sum(float(rows[-1][name]) for name in ("fracture", "plastic", "friction")) / section
    return lines({"test": test, "damping": damping, "rate": rate} | ({"elements": elements} if elements != 1200 else {}), seed, json.loads((folder / "summary.json").read_text()), found)


# Lines of the table of places.
SHOWN = [("as `breccia test`: \"faces\", damping 0.3", {}), ("at a quarter of the rate", {"rate": 0.25}), ("damping 0.05", {"damping": 0.05}), ("damping 0.05, half the rate", {"damping": 0.05, "rate": 0.5}),
         ("no damping", {"damping": 0.0}), ("grips 6 R deep", {"layer": 6}), ("cut along z from a periodic packing", {"periodic": "z"}), ("the same, damping 0.05", {"damping": 0.05, "periodic": "z"}),
         ("grips hold all motion, damping 0.05", {"damping": 0.05, "fix": "all"}), ("\"packed\"", {"fabric": "packed"}), ("\"packed\", damping 0.05", {"fabric": "packed", "damping": 0.05}),
         ("\"even\"", {"fabric": "even"}), ("\"even\", damping 0.05", {"fabric": "even", "damping": 0.05}),
         *((f"1,200 elements, damping {damping}", {"elements": 1200, "damping": damping}) for damping in (0.3, 0.05, 0.0))]


def gathered(records):
    """{setting without what it has from PLAIN and without its end: {seed: {quantity: value}}}"""
    found = {}
    for one in records:
        setting = {key: value for key, value in json.loads(one["setting"]).items() if value != PLAIN.get(key)}
        if setting.get("end") != AS_TESTED["end"]:
            setting.pop("end", None)
        found.setdefault(json.dumps(setting, sort_keys=True), {}).setdefault(int(one["seed"]), {})[one["quantity"]] = float(one["value"])
    return found


def pulled_table(records, which):
    """@param which  "places", of prisms pulled until they part, or "damping", of all tests as `breccia test` makes them"""
    found = gathered(records)

    def of(setting, quantity):
        named = json.dumps({key: value for key, value in setting.items() if value != PLAIN.get(key)}, sort_keys=True)
        return [one[quantity] for one in found.get(named, {}).values() if quantity in one]

    if which == "places":
        out = ["| 4,000 elements, C30_local | crack, mm from the nearer grip | within 17 mm of it | f_t at the grips, MPa | in the middle | grips over middle |", "|---" * 6 + "|"]
        for words, setting in SHOWN:
            whole = PLAIN | setting
            depth, grips, middle = (of(setting, quantity) for quantity in ("depth", "strength", "middle"))
            depth = [d - 1e3 * whole["layer"] * radius_of(whole)[0] for d in depth]
            near = sum(d < 17 for d in depth)
            out.append(f"| {words} | {text(depth)} | {near} of {len(depth)} | {text(grips, 2)} | {text(middle, 2)} | {text([g / m for g, m in zip(grips, middle)], 3)} |")
        return "\n".join(out)
    tension = {(damping, rate): AS_TESTED | {"damping": damping, "rate": rate} for damping in (0.3, 0.05) for rate in (1, 0.25)}
    test = lambda name: {key: {"test": name, "damping": key[0], "rate": key[1]} for key in tension}  # noqa: E731
    rows = [("f_t, read at the grips, MPa", tension, "strength", 2), ("f_t, in the middle, MPa", tension, "middle", 2), ("f_c, MPa", test("compression_prism"), "strength", 1),
            ("disc of 2,400, 2P/(pi d t), MPa", test("brazilian"), "strength", 2), ("G_F, notched prism, J/m2", test("tension_notched"), "fracture_energy", 0)]
    out = ["| C30_local, 1,200 elements | damping 0.3 | a quarter of the rate | damping 0.05 | a quarter of the rate |", "|---" * 5 + "|"]
    for words, settings, quantity, digits in rows:
        values = [of(setting, quantity) for setting in settings.values()]
        out.append(f"| {words} | " + " | ".join(text(v, digits) if v else "" for v in values) + " |")
    return "\n".join(out)


def pulled(given):
    jobs = [(pull, PLAIN | setting, seed, given) for setting, seeds in PULLED for seed in (range(1, seeds + 1) if isinstance(seeds, int) else seeds)]
    jobs += [(damp, *setting, seed, given) for *setting, seeds in DAMPED for seed in seeds]
    jobs = [job for job in jobs if given.only in str(job[1:-1])]
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        records = [line for task in [pool.submit(*job) for job in jobs] for line in task.result()]
    if given.record:
        records = published_runs.merge_record(given.record, RECORD, records, RECORD[:2])
    print(pulled_table(records, "places"), pulled_table(records, "damping"), sep="\n\n")


def main():
    p = argparse.ArgumentParser()
    p.add_argument("--binary", type=pathlib.Path, default=ROOT / "build/release/breccia")
    p.add_argument("-o", "--out", type=pathlib.Path, default=ROOT / "out" / "localisation")
    p.add_argument("--concrete", default="", help="of the library, as C30")
    p.add_argument("--elements", type=int, default=2000)
    p.add_argument("--seeds", type=int, default=3)
    p.add_argument("--device", default="cpu")
    p.add_argument("--jobs", type=int, default=1)
    p.add_argument("--record", type=pathlib.Path, help="a file for the numbers of all specimens, as docs/results/localisation.csv; what it has of others stays")
    p.add_argument("--pulled", action="store_true")
    p.add_argument("--only", default="", help="of --pulled: settings that have this in their text")
    given = p.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    if given.pulled:
        return pulled(given)
    records = []
    for test in NAMES:
        with concurrent.futures.ProcessPoolExecutor(given.jobs) as pool:
            all_of = list(pool.map(of_packing, [(given, test, seed) for seed in range(1, given.seeds + 1)]))
        records += [{"test": " ".join(filter(None, (test, given.concrete))), "elements": given.elements, "seed": seed, "quantity": quantity, "value": f"{value:.9g}"}
                    for seed, found in enumerate(all_of, 1) for quantity, value in found.items()]
    print(markdown(records))
    if given.record:
        published_runs.merge_record(given.record, list(records[0]), records, ("test", "elements", "seed"))


if __name__ == "__main__":
    main()
