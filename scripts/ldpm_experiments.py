#!/usr/bin/env python3
"""Experiments on concrete of LDPM rebuilt for docs/validation-ldpm.md: platens, cycles, notched beams, confined compression.

    scripts/ldpm_experiments.py run [NAME...] [--sets B,II-3,II-4] [--seeds 3] [--jobs 2] [--binary build/release/breccia] [-o out/ldpm_experiments]
    scripts/ldpm_experiments.py record     numbers of all finished runs to docs/results/ldpm.csv
    scripts/ldpm_experiments.py plot FILE.png    curves over each other; needs python3-matplotlib

NAME: platens (prisms and cubes of 100 mm between ends of several frictions), cycles (a prism unloaded and loaded again), beams (notched, four
sizes), bands (prisms pulled and pressed: where they spend their energy), confined (prisms under side pressure, beside the curves of Attard and Setunge), biaxial (plates beside the curves of Kupfer and others;
`plot` then draws these and cycles). Grains are of 6 to 12 mm (platens: II-4 8 to 15 mm), else
10 to 12 mm. Runs that are done are kept.
"""
import argparse
import concurrent.futures
import csv
import json
import math
import pathlib
import random
import statistics
import struct
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import ldpm_benchmarks as bodies  # noqa: E402
from localisation import directions  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
SETS = {"B": bodies.B, "II-3": bodies.II_3, "II-4": bodies.II_4}
TURNS = ["z", "spin_x", "spin_y"]
# Curves of experiments, strain along z [1e-3] and stress along z [MPa], as chenhhu/NLDamPla_Constitutive_Relation (commit cf28831) has read them off.
KUPFER = {  # stress along x over that along z: Kupfer, Hilsdorf and Ruesch 1969
    0: ((0, 0.246, 0.492, 0.739, 0.985, 1.232, 1.491, 1.742, 1.998, 2.240, 2.492, 2.743, 2.994, 3.197, 3.388, 3.579, 3.817, 4.020, 4.187, 4.390, 4.640, 4.855, 5.093, 5.296, 5.475, 5.690, 5.905),
        (0, 7.93, 15.01, 19.99, 24.02, 27.50, 29.59, 31.52, 32.02, 31.67, 31.60, 31.09, 30.08, 29.09, 28.10, 27.00, 25.57, 24.25, 23.37, 22.16, 20.73, 19.74, 18.41, 17.31, 16.54, 15.55, 14.78)),
    0.52: ((0, 0.503, 0.745, 0.992, 1.339, 1.752, 1.990, 2.218, 2.490, 2.736, 3.000, 3.246, 3.517),
           (0, 15.13, 21.82, 26.80, 31.90, 35.20, 36.78, 37.98, 38.93, 39.31, 39.61, 39.01, 37.81)),
    1: ((0, 0.503, 0.746, 0.995, 1.244, 1.492, 1.736, 1.975, 2.249, 2.503, 2.741, 2.980, 3.234),
        (0, 17.14, 23.08, 27.04, 30.52, 33.04, 34.75, 36.04, 36.73, 37.05, 36.25, 35.07, 33.52)),
}
KARSAN = (  # Karsan and Jirsa 1969, envelope of a prism loaded again and again
    (0, 0.301, 0.368, 0.461, 0.549, 0.678, 0.871, 1.122, 1.365, 1.616, 1.863, 2.114, 2.374, 2.625, 2.864, 3.124, 3.362, 3.622, 3.873, 4.133, 4.367, 4.618, 4.870),
    (0, 9.68, 11.54, 13.82, 15.61, 18.10, 21.05, 23.93, 25.89, 27.05, 27.55, 27.55, 27.25, 26.55, 25.86, 24.76, 23.83, 22.61, 21.38, 20.09, 18.83, 17.54, 16.44))


def case(name, of, size, grains, seed, end, text, rows, frames=0):
    """A box from 0 to size [mm] of a set of parameters."""
    return f"""breccia = 1
method = "dem3d"
title = "{name}"
seed = {seed}
local_damping = 0.05
[time]
end = {end:.9g}
safety = 0.9
evaluate_every = 10
[search]
margin = 0.5
[output]
frames = {frames}
fields = {"true" if frames else "false"}
pictures = false
history = {rows:.9g}
{bodies.material(SETS[of], *grains)}
[[body]]
name = "body"
shape = "box"
material = "concrete"
center = [{", ".join(f"{5e-4 * x:.9g}" for x in size)}]
size = [{", ".join(f"{1e-3 * x:.9g}" for x in size)}]
{text}"""


def platens(of, seed):
    """Prisms and cubes between ends that do not turn and rub; to half of the peak after it."""
    grains = (8, 15) if of == "II-4" else (6, 12)
    for height in (200, 100):
        for friction in (0.0, 0.13, 0.577):
            speed = 0.5e-3 * height  # 0.5/s
            rub = f"friction = {friction}\n" if friction else ""
            text = (bodies.face("foot", 2, 0, TURNS, rub) + bodies.face("head", 2, height, TURNS, f"velocity = [0.0, 0.0, {-speed}]\nramp = 5e-4\n{rub}")
                    + bodies.probe("force", "head", "force_z", "sum") + bodies.probe("path", "head", "displacement_z")
                    + '[[stage]]\nname = "press"\ndrop = 0.5\ndrop_of = "force"\n')
            name = f"platens-{'prism' if height == 200 else 'cube'}-{friction:g}-{of}-{seed}"
            yield name, case(name, of, (100, 100, height), grains, seed, 0.012 * height * 1e-3 / speed, text, 2e-5, 1)


def cycles(of, seed):
    """A prism between smooth ends, unloaded to 2 MPa and loaded again four times."""
    speed = 0.6 * 0.12
    stages, left = "", 0.0
    for strain in (0.8e-3, 1.4e-3, 2.0e-3, 2.8e-3):
        for name, rule, sense in ((f"to_{1e3 * strain:g}", f'when = "path < {-0.12 * strain:.6g}"', -1), (f"back_from_{1e3 * strain:g}", 'when = "force < 7.2e3"', 1)):
            stages += f'[[stage]]\nname = "{name}"\n{rule}\n'
            stages += f'[[stage.support]]\nname = "head"\nvelocity = [0.0, 0.0, {(-1 if sense < 0 else 0.4) * speed:.6g}]\nramp = 2e-4\n' if left else ""
            left += 1
    stages += f'[[stage]]\nname = "end"\nwhen = "path < -4.2e-4"\n[[stage.support]]\nname = "head"\nvelocity = [0.0, 0.0, {-speed}]\nramp = 2e-4\n'
    text = (bodies.face("foot", 2, 0, TURNS) + bodies.face("head", 2, 120, TURNS, f"velocity = [0.0, 0.0, {-speed}]\nramp = 5e-4")
            + bodies.probe("force", "head", "force_z", "sum") + bodies.probe("path", "head", "displacement_z") + stages)
    name = f"cycles-{of}-{seed}"
    yield name, case(name, of, (60, 60, 120), (10, 12), seed, 0.04, text, 1e-5)


def beams(of, seed):
    """Notched beams of one thickness, span 2.5 D, notch D/4, bent to 1.5 times the opening of the peak and more."""
    if of == "II-4":
        return
    for depth in (30, 60, 120, 240):
        if depth == 240 and seed > 3:
            continue
        length, span = 2.7 * depth, 2.5 * depth
        middle, near = 0.5 * length, max(0.1 * depth, 7.0)

        def strip(name, at, low, more=""):
            low_z, high_z = (-1, 1e-6) if low else (1e-3 * depth - 1e-6, 1)
            return bodies.support(name, ["z"], (1e-3 * (at - near), -1, low_z), (1e-3 * (at + near), 1, high_z), more)
        speed = 0.04 if depth > 60 else 0.02
        text = (f'[[body.cut]]\nshape = "box"\ncenter = [{1e-3 * middle}, 0.03, 0.0]\nsize = [0.0, 1.0, {0.5e-3 * depth}]\n'
                + strip("left", middle - 0.5 * span, True) + strip("right", middle + 0.5 * span, True)
                + strip("load", middle, False, f"velocity = [0.0, 0.0, {-speed}]\nramp = 1e-3")
                + bodies.probe("force", "load", "force_z", "sum") + bodies.probe("path", "load", "displacement_z")
                + bodies.probe("left", "left", "force_z", "sum") + bodies.probe("right", "right", "force_z", "sum")
                + '[[stage]]\nname = "bend"\ndrop = 0.4\ndrop_of = "left"\n')
        name = f"beams-{depth}-{of}-{seed}"
        yield name, case(name, of, (length, 60, depth), (10, 12), seed, 1.2e-3 * (depth / 60) ** 0.5 / speed * 0.25, text, 2e-5)


def confined(of, seed):
    """Prisms under a constant pressure on their sides, those of `breccia test` with more points."""
    for pressure in (5, 10, 20, 40):
        speed = 0.12 * min(1.0, pressure / 20) * 1.5
        text, areas = "", (7.2e-3, 7.2e-3, 3.6e-3)
        for axis, length in enumerate((60, 60, 120)):
            servo = (f'servo = {{ axis = "{"xyz"[axis]}", pressure = [[0, 0], ["2 ms", {-0.9e6 * pressure}], ["3 ms", {-1e6 * pressure}]], '
                     f"area = {areas[axis]}, speed = 1.0, gain = 2.0 }}")
            text += bodies.face(f"low_{'xyz'[axis]}", axis, 0, ["xyz"[axis]]) + bodies.face("head" if axis == 2 else f"high_{'xyz'[axis]}", axis, length, ["xyz"[axis]], servo)
        text += (bodies.probe("force", "head", "force_z", "sum") + bodies.probe("path", "head", "displacement_z") + bodies.probe("side_force", "high_x", "force_x", "sum")
                 + bodies.probe("side_path", "high_x", "displacement_x")
                 + f'[[stage]]\nname = "confine"\nuntil = "4 ms"\n[[stage]]\nname = "shear"\ndrop = 0.3\ndrop_of = "force"\n[[stage.support]]\nname = "head"\nvelocity = [0.0, 0.0, {-speed}]\nramp = 1e-4\n')
        name = f"confined-{pressure}-{of}-{seed}"
        yield name, case(name, of, (60, 60, 120), (10, 12), seed, 4e-3 + 0.12 * (0.006 + 4e-4 * pressure) / speed, text, 2e-5)


def biaxial(of, seed):
    """Plates of Kupfer, Hilsdorf and Ruesch 1969 (200 x 50 x 200 mm) at three ratios of the side's stress to that along z: the side's is that of the experiment at the same strain."""
    if of != "II-4":
        return
    speed, ramp = 0.2, 2e-4
    for ratio, (strains, stresses) in KUPFER.items():
        reach = max(strains[-1] + 0.1, 4.5)  # beyond the peak
        along = [[0.0, 0.0]] + [[0.2e-3 * e / speed + 0.5 * ramp, 1e6 * ratio * s] for e, s in zip(strains[1:], stresses[1:])]
        _, text = bodies.plate("alike" if ratio == 1 else along if ratio else 0, 1e-3 * reach, speed)
        name = f"biaxial-{ratio:g}-{of}-{seed}"
        yield name, case(name, of, (200, 50, 200), (8, 15), seed, 0.2e-3 * reach / speed + 0.5 * ramp, text, 2e-5)


def bands(of, seed):
    """Prisms between smooth ends, pulled to a quarter of the peak after it, and pressed to half."""
    for load, speed, drop in (("tension", 0.02, 0.75), ("compression", -0.06, 0.5)):
        text = (bodies.face("foot", 2, 0, TURNS) + bodies.face("head", 2, 120, TURNS, f"velocity = [0.0, 0.0, {speed}]\nramp = 5e-4\n")
                + bodies.probe("force", "head", "force_z", "sum") + bodies.probe("path", "head", "displacement_z")
                + f'[[stage]]\nname = "load"\ndrop = {drop}\ndrop_of = "force"\n')
        name = f"bands-{load}-{of}-{seed}"
        yield name, case(name, of, (60, 60, 120), (8, 12) if of == "II-4" else (6, 12), seed, 0.012, text, 2e-5)


EXPERIMENTS = {"platens": platens, "bands": bands, "cycles": cycles, "beams": beams, "confined": confined, "biaxial": biaxial}


def history(folder):
    with open(folder / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))[1:]
    return {key: [float(row[key]) for row in rows] for key in rows[0] if key not in ("", "stage")}


def smoothed(values, count):
    """Mean over `count` neighbours."""
    half = count // 2
    return [statistics.fmean(values[max(0, k - half):k + half + 1]) for k in range(len(values))]


def band(folder, height, since):
    """Facets broken after the peak: how many more of them lie in the best layer of a tenth of the height than of all cracked ones, and so of as
    many drawn at random; slope of the layer [degrees]."""
    with open(folder / "broken_links.csv", newline="") as file:
        rows = [row for row in list(csv.DictReader(file))[1:]]
    places = [tuple(float(row[key]) for key in "xyz") for row in rows]
    late = [place for place, row in zip(places, rows) if float(row["time"]) > since]
    if len(late) < 50:
        return None
    random.seed(1)
    late = random.sample(late, min(len(late), 1500))
    everything = random.sample(places, min(len(places), 3000))

    def best(chosen):
        found = (0.0, 0.0)
        for n in directions(100):
            along = sorted(n[0] * p[0] + n[1] * p[1] + n[2] * p[2] for p in chosen)
            first = 0
            for last, value in enumerate(along):
                while value - along[first] > 0.1 * height:
                    first += 1
                if (share := (last - first + 1) / len(along)) > 0.05:
                    if share > found[0] * 0.7:
                        inside = sum(1 for p in everything if 0 <= n[0] * p[0] + n[1] * p[1] + n[2] * p[2] - along[first] <= 0.1 * height) / len(everything)
                        if share > found[0]:
                            found = (share, share / max(inside, 1e-3), math.degrees(math.acos(n[2])))
        return found
    share, ratio, slope = best(late)
    return {"late": len([1 for row in rows if float(row["time"]) > since]), "cracked": len(rows), "band": share, "ratio": ratio,
            "chance": best(random.sample(places, len(late)))[0], "slope": slope}


def spent(folder):
    """Middle of the edge [m], energy spent [J] and largest opening L e_max [m] of every facet at the end of a run, by its last checkpoint."""
    data = max((folder / "checkpoints").glob("*.br")).read_bytes()
    sections, at = {}, data.index(b"run.step") - 4
    while at < sections.get("run.step", (0, 0, len(data)))[2]:
        length = struct.unpack_from("<I", data, at)[0]
        sections[data[at + 4:at + 4 + length].decode()] = struct.unpack_from("<3Q", data, at + 4 + length)
        at += length + 44

    def of(name, code):
        items, size, offset = sections[name]
        return list(struct.iter_unpack(f"<{size // struct.calcsize(code)}{code}", data[offset:offset + items * size]))
    places, alpha = [p[:3] for p in of("elements.state", "d")], 0.25
    return [(tuple(0.5 * (x + y) for x, y in zip(places[a[0]], places[b[0]])), o[0] + c[0] + s[0], place[0] * math.sqrt(state[6] ** 2 + alpha * state[7]))
            for a, b, o, c, s, place, state in zip(*(of(f"ldpm.{name}", code) for name, code in (("a", "i"), ("b", "i"), ("opened", "d"), ("compacted", "d"), ("slid", "d"), ("place", "d"), ("state", "d"))))]


def fullest(facets, normals, thickness):
    """Largest share of weights in a layer: share, slope of the layer, whether a place lies in it."""
    whole, found = sum(weight for _, weight in facets), (0.0, 0.0, None)
    for n in normals:
        along = sorted((sum(p * q for p, q in zip(n, place)), weight) for place, weight in facets)
        first, inside = 0, 0.0
        for value, weight in along:
            inside += weight
            while value - along[first][0] > thickness:
                inside -= along[first][1]
                first += 1
            if inside > found[0] * whole:
                found = (inside / whole, math.degrees(math.acos(min(1.0, abs(n[2])))), (n, along[first][0]))
    return found


def concentration(folder, thickness, wide):
    """Share of the energy spent, and of the facets opened by more than `wide`, in the layer that has most of the energy: across the load and in any
    direction; with the energies dealt to the facets at random, that is by chance."""
    facets = spent(folder)
    energy = [(place, e) for place, e, _ in facets]
    opened = [place for place, _, w in facets if w > wide]
    dealt = [e for _, e in energy]
    random.Random(1).shuffle(dealt)
    chance = [(place, e) for (place, _), e in zip(energy, dealt)]
    result = {"energy": sum(dealt) * 1e3, "wide": len(opened), "facets": len(facets)}
    for name, normals in (("across", [(0.0, 0.0, 1.0)]), ("any", list(directions(40)))):
        share, slope, (n, low) = fullest(energy, normals, thickness)
        inside = sum(1 for place in opened if 0 <= sum(p * q for p, q in zip(n, place)) - low <= thickness)
        result.update({f"share_{name}": share, f"chance_{name}": fullest(chance, normals, thickness)[0], f"wide_{name}": inside / max(len(opened), 1), f"slope_{name}": slope})
    return result


def misfits(strain, stress, curve):
    """Mean difference from a published curve, over its points before and after its peak, in shares of the peak."""
    strains, stresses = curve
    peak = max(stresses)
    off = [(abs(found - there) / peak, e <= strains[stresses.index(peak)]) for e, there in zip(strains[1:], stresses[1:]) if (found := bodies.at(strain, stress, e)) is not None]
    return {(f"misfit_{part}", "-"): statistics.fmean(value for value, before in off if before == rising) for part, rising in (("rising", True), ("falling", False))}


def numbers_of(name, folder):
    """{quantity: value, unit} of a finished run, and its curve [strain in 1e-3 or mm, MPa]."""
    h, parts = history(folder), name.split("-")
    found, n = {}, len(h["time"])
    stress = None
    if parts[0] in ("platens", "bands", "cycles", "confined", "biaxial"):
        height, area = (0.1 if "cube" in name else 0.2, 1e-2) if parts[0] in ("platens", "biaxial") else (0.12, 3.6e-3)
        stress = smoothed([abs(f) / area * 1e-6 for f in h["force"]], 5)
        begin = next((k for k in range(n) if h["time"][k] >= 4e-3), 0) if parts[0] == "confined" else 0
        strain = [1e3 * (h["path"][begin] - x) / height for x in h["path"]]
        k = max(range(begin, n), key=stress.__getitem__)
        found = {("strength", "MPa"): stress[k], ("peak_strain", "1e-3"): strain[k], ("left", "-"): stress[-1] / stress[k], ("end_strain", "1e-3"): strain[-1]}
        if parts[0] == "biaxial":
            found["side", "MPa"] = smoothed([abs(f) / area * 1e-6 for f in h["side_force"]], 5)[k]
            found.update(misfits(strain, stress, KUPFER[float(parts[1])]))
        if parts[0] == "confined":
            found["side", "MPa"] = smoothed([abs(f) / 7.2e-3 * 1e-6 for f in h["side_force"]], 5)[k]
            strain, stress = strain[begin:], stress[begin:]
        if parts[0] == "bands":
            found.update({(key, "-"): value for key, value in concentration(folder, 0.012, 5e-5).items()})
        if parts[0] == "platens" and (found_band := band(folder, height, h["time"][k])):
            found.update({(key, "-"): value for key, value in found_band.items()})
        if parts[0] == "cycles":  # where it turns, and what is left
            highest = [max((t, e) for e, t in zip(strain, stress) if e <= x)[0] if x <= strain[k] else max(t for e, t in zip(strain, stress) if e >= x) for x in KARSAN[0] if x < max(strain)]
            found.update(misfits(KARSAN[0][:len(highest)], highest, KARSAN) if "II-4" in name else {})
            turns, sense, at = [], 1, 0
            for k in range(n):
                if sense > 0 and strain[k] > strain[at] or sense < 0 and strain[k] < strain[at]:
                    at = k
                elif abs(strain[k] - strain[at]) > 0.02:
                    turns.append(at)
                    sense, at = -sense, k
            for number, (top, low) in enumerate(zip(turns[::2], turns[1::2])):
                unit = (stress[top] - stress[low]) / (strain[top] - strain[low])
                found.update({(f"turn_{number}", "1e-3"): strain[top], (f"stress_{number}", "MPa"): stress[top],
                              (f"left_{number}", "1e-3"): strain[low] - stress[low] / unit, (f"secant_{number}", "GPa"): unit})
        x = strain
    else:
        depth = float(parts[1])
        load = smoothed([abs(a) + abs(b) for a, b in zip(h["left"], h["right"])], 9)
        k = max(range(n), key=load.__getitem__)
        ligament = 0.75 * depth
        found = {("strength", "MPa"): 1.5 * load[k] * 2.5 * depth / (60 * depth ** 2), ("path", "mm"): 1e3 * abs(h["path"][k]), ("left", "-"): load[-1] / load[k],
                 ("ligament", "MPa"): 1.5 * load[k] * 2.5 * depth / (60 * ligament ** 2)}
        x, stress = [1e3 * abs(p) for p in h["path"]], [1.5 * p * 2.5 * depth / (60 * depth ** 2) for p in load]
    by = max(1, len(x) // 120)
    return found, [[round(a, 4), round(s, 3)] for a, s in zip(x[::by], stress[::by])]


def all_of(names, sets, seeds):
    for seed in seeds:
        for experiment in names:
            for of in sets:
                for name, text in EXPERIMENTS[experiment](of, seed):
                    yield name, text


def run(binary, out, name, text, threads):
    folder, numbers = out / name, out / f"{name}.json"
    if numbers.exists():
        return name, "kept"
    (out / f"{name}.toml").write_text(text)
    with open(out / f"{name}.log", "w") as log:
        code = subprocess.run([binary, "run", out / f"{name}.toml", "-o", folder, "--threads", str(threads), "--force", "--no-progress", "-q"], stdout=log,
                              stderr=subprocess.STDOUT).returncode
    if code != 0:
        return name, f"exit code {code}"
    found, curve = numbers_of(name, folder)
    summary = json.loads((folder / "summary.json").read_text())
    numbers.write_text(json.dumps({"name": name, "numbers": [[q, u, v] for (q, u), v in found.items()], "curve": curve, "hash": summary["state_hash"],
                                   "steps": summary["steps"], "links": summary["model"]["links"], "seconds": summary["wall_s"]["total"],
                                   "energy": summary["energy"].get("error_relative")}))
    return name, f"{summary['wall_s']['total']:.0f} s"


def finished(out):
    """{(experiment and variant, set): runs of its seeds}"""
    found = {}
    for file in sorted(out.glob("*.json")):
        one = json.loads(file.read_text())
        *what, seed = one["name"].split("-")
        of = "-".join(what[-2:]) if what[-2] == "II" else what[-1]
        found.setdefault((" ".join(what[:-2] if what[-2] == "II" else what[:-1]), of), {})[int(seed)] = one
    return found


def record(out, target):
    """Puts the numbers of finished runs in place of earlier ones of the same experiments."""
    found = finished(out)
    with open(target, newline="") as file:
        lines = [row for row in csv.reader(file) if (row[1], row[0]) not in found]
    for (what, of), runs in found.items():
        lines += [[of, what, seed, quantity, unit, f"{value:.6g}"] for seed, one in sorted(runs.items()) for quantity, unit, value in one["numbers"]]
    with open(target, "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(lines)


def plot(out, picture):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    found = finished(out)
    if any(what.startswith("biaxial") for what, _ in found):
        return plot_plates(found, picture, plt)
    figure, axes = plt.subplots(2, 2, figsize=(11, 8))
    colors = {"B": "tab:blue", "II-3": "tab:red", "II-4": "tab:green"}
    panels = {"platens prism 0.577": (0, "prisms of 100 mm: smooth ends (thin) and platens, friction 0.577"), "platens prism 0": (0, ""), "cycles": (1, "unloaded and loaded again"),
              "confined": (2, "side pressure of 5, 10, 20, 40 MPa"), "beams": (3, "notched beams of 30 to 240 mm, nominal stress")}
    for (what, of), runs in sorted(found.items()):
        name = what if what.startswith("platens") else what.split(" ")[0]
        if name not in panels:
            continue
        panel, title = panels[name]
        a = axes.flat[panel]
        for seed, one in runs.items():
            x, y = zip(*one["curve"])
            first = seed == 1 and what in ("platens prism 0.577", "cycles", "confined 20", "beams 120")
            a.plot(x, y, color=colors[of], lw=0.5 if what.endswith(" 0") else 1.0, alpha=0.8, label=of if first else None)
        if title:
            a.set(xlabel="deflection, mm" if panel == 3 else "strain, 1e-3", ylabel="MPa")
            a.set_title(title, fontsize=9)
    for a in axes.flat:
        a.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(picture, dpi=80)


def plot_plates(found, picture, plt):
    """Plates beside the curves of Kupfer and others; prisms, unloaded and loaded again, beside that of Karsan and Jirsa."""
    figure, axes = plt.subplots(1, 2, figsize=(10, 4))
    colors = {"0": "tab:blue", "0.52": "tab:green", "1": "tab:red", "cycles": "tab:blue"}
    for (what, of), runs in sorted(found.items()):
        ratio = what.split(" ")[-1]
        if of != "II-4" or what != "cycles" and not what.startswith("biaxial"):
            continue
        for curve in (one["curve"] for one in runs.values()):
            axes[int(what == "cycles")].plot(*zip(*curve), color=colors[ratio], lw=0.8)
    for ratio, curve in KUPFER.items():
        axes[0].plot(*curve, "o", ms=4, color=colors[f"{ratio:g}"], label=f"side stress {ratio:g} of that along z")
    axes[1].plot(*KARSAN, "ko", ms=4, label="Karsan and Jirsa 1969")
    for a in axes:
        a.set(xlabel="strain, 1e-3", ylabel="stress, MPa", xlim=(0, 6), ylim=(0, 45))
        a.legend(fontsize=8, loc="lower right" if a is axes[0] else "upper right")
    figure.tight_layout()
    figure.savefig(picture, dpi=80)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("what", choices=["run", "record", "plot", "list"])
    p.add_argument("names", nargs="*")
    p.add_argument("--sets", default="B,II-3,II-4")
    p.add_argument("--seeds", type=int, default=3)
    p.add_argument("--jobs", type=int, default=2)
    p.add_argument("--threads", type=int, default=1)
    p.add_argument("--binary", type=pathlib.Path, default=ROOT / "build/release/breccia")
    p.add_argument("-o", "--out", type=pathlib.Path, default=ROOT / "out" / "ldpm_experiments")
    given = p.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    if given.what == "record":
        record(given.out, ROOT / "docs/results/ldpm.csv")
    if given.what == "plot":
        plot(given.out, given.names[0])
    if given.what in ("run", "list"):
        todo = list(all_of(given.names or list(EXPERIMENTS), given.sets.split(","), range(1, given.seeds + 1)))
        if given.what == "list":
            print("\n".join(name for name, _ in todo))
            return
        with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
            for name, said in pool.map(lambda one: run(given.binary, given.out, *one, given.threads), todo):
                print(name, said, flush=True)


if __name__ == "__main__":
    main()
