#!/usr/bin/env python3
"""Public bodies of LDPM as cases: ldpm_benchmarks.py make REPOSITORY NAME... --out DIR; then `breccia run DIR/NAME`; then read RESULT NAME --record

REPOSITORY is a git clone of tianjuxue/jax-ldpm with its history. The bodies are not part of Breccia: the collection names no licence. Grains of bodies
that have no diameters get those of Fuller's curve, the largest first, as their files list them.
"""
import argparse
import collections
import csv
import math
import pathlib
import subprocess
import sys

import ldpm_beam

ROOT = pathlib.Path(__file__).resolve().parent.parent
NEWEST = "d1f5a2f"
B = dict(density=2338, normal=60.273e9, tension=3.44e6, ratio=2.6, length=0.5, exponent=0.4, collapse=150e6, hardening=0.4, compaction=4, friction=0.4)
II_3 = dict(density=2400, normal=43.748e9, tension=4.03e6, ratio=2.7, length=0.12, exponent=0.2, collapse=150e6, hardening=0.4, compaction=2, friction=0.2)
II_4 = dict(density=2400, normal=46.26e9, tension=3.04e6, ratio=5.75, length=0.1, exponent=0.2, collapse=35e6, hardening=0.1, compaction=4, friction=0.05)
BODIES = {  # commit, path, smallest and largest grain [mm], parameters
    "prism": (NEWEST, "benchmarks/unconfined_compression/input/freecad/LDPMgeo000", 6, 12, B),
    "cantilever": (NEWEST, "benchmarks/free_vibration/input/freecad/LDPMgeo000", 6, 12, B),
    "cylinder": (NEWEST, "benchmarks/uniaxial_strain/input/freecad/LDPMgeo000", 6, 12, B),
    "cube": ("b13cca9", "applications/compression/input/freecad/100x100x100/LDPMgeo000", 4, 8, II_3),
    "plate": ("4dbc763", "applications/biaxial/input/freecad/200x50x200/LDPMgeo000", 4, 15, II_4),
    **{f"beam_{least}-{most}": (NEWEST, f"benchmarks/three_point_bending/input/freecad/LDPM_mesh_{least}-{most}/LDPMgeo000", least, most, B) for least, most in ((5, 16), (6, 12), (8, 16))},
}
SIZES = {"prism": (100, 100, 200), "cantilever": (100, 100, 200), "cylinder": (100, 100, 200), "cube": (100, 100, 100), "plate": (200, 50, 200)}


def stored(repository, commit, path):
    return subprocess.run(["git", "-C", repository, "show", f"{commit}:{path}"], capture_output=True, text=True, check=True).stdout


def read_mesh(text):
    """Points and cells of a legacy VTK file, points as words."""
    words = text.split()
    at = words.index("POINTS")
    count, numbers = int(words[at + 1]), words[at + 3:]
    points = [numbers[3 * k:3 * k + 3] for k in range(count)]
    at = words.index("CELLS")
    return points, [list(map(int, words[at + 4 + 5 * k:at + 8 + 5 * k])) for k in range(int(words[at + 1]))]


def diameters(count, cells, smallest, largest):
    """Those of Fuller's curve, the largest first; 0 on the surface."""
    faces = collections.Counter(tuple(sorted(cell[:k] + cell[k + 1:])) for cell in cells for k in range(4))
    surface = {corner for face, times in faces.items() if times == 1 for corner in face}
    grains, q = count - len(surface), 2.5
    rank, found = 0, []
    for k in range(count):
        found.append(0.0)
        if k not in surface:
            share = 1 - (rank + 0.5) / grains
            found[-1] = smallest * (1 - share * (1 - (smallest / largest) ** q)) ** (-1 / q)
            rank += 1
    return found


def write_rows(path, rows):
    path.write_text("\n".join(" ".join(f"{x:.12g}" if isinstance(x, float) else str(x) for x in row) for row in rows) + "\n")


def write_beam(repository, name, folder):
    """The block with its own facets where their corners are stored (8 to 16 mm), else by diameters, and the outer blocks."""
    commit, path, smallest, largest, _ = BODIES[name]
    points, cells = read_mesh(stored(repository, commit, f"{path}-para-mesh.000.vtk"))
    radius = [0.5 * (d or 1.1 * smallest) for d in diameters(len(points), cells, smallest, largest)]
    try:
        words = list(map(float, stored(repository, commit, f"{path}-data-facetsVertices.dat").split()))
        corners = list(zip(words[0::3], words[1::3], words[2::3]))
    except subprocess.CalledProcessError:  # not at hand
        corners = None
    files = ldpm_beam.beam([tuple(map(float, p)) for p in points], cells, radius, corners)
    for end, rows in zip(("nodes", "tets", "facetsVertices"), files):
        write_rows(folder / f"body-data-{end}.dat", rows)


def write_body(repository, name, folder):
    """The files of a body, those of the collection or of its mesh. @returns the end of the one to read"""
    if name.startswith("beam"):
        write_beam(repository, name, folder)
        return "facetsVertices"
    commit, path, smallest, largest, _ = BODIES[name]
    if commit != NEWEST:
        for end in ("particles", "tets"):
            (folder / f"body-data-{end}.dat").write_text(stored(repository, commit, f"{path}-data-{end}.dat"))
        return "tets"
    points, cells = read_mesh(stored(repository, commit, f"{path}-para-mesh.000.vtk"))
    write_rows(folder / "body-data-particles.dat", ((k, *p, f"{d:.9g}") for k, (p, d) in enumerate(zip(points, diameters(len(points), cells, smallest, largest)))))
    write_rows(folder / "body-data-tets.dat", cells)
    return "tets"


def material(of, smallest, largest):
    alpha = 0.25
    poisson = (1 - alpha) / (4 + alpha)
    return f"""[material.concrete]
law = "ldpm"
density = {of["density"]}.0
young = {of["normal"] * (1 - 2 * poisson)}
poisson = {poisson}
tensile_strength = {of["tension"]}
cohesion = {of["ratio"] * of["tension"]}
ldpm = {{ tensile_length = {of["length"]}, softening_exponent = {of["exponent"]}, collapse_strength = {of["collapse"]}, hardening = {of["hardening"]}, compaction_strain = {of["compaction"]}.0, friction = {of["friction"]} }}
mix = {{ smallest = "{smallest} mm", largest = "{largest} mm" }}
"""


def support(name, fix, low=(-1, -1, -1), high=(1, 1, 1), more=""):
    place = f"min = [{', '.join(f'{x:.9g}' for x in low)}]\nmax = [{', '.join(f'{x:.9g}' for x in high)}]"
    return f'[[support]]\nname = "{name}"\n{place}\nfix = [{", ".join(repr(x) for x in fix)}]\n{more}\n'.replace("'", '"')


def face(name, axis, at, fix, more=""):
    """The particles of a face: at = 0 or the length [mm]."""
    low, high = [-1, -1, -1], [1, 1, 1]
    (high if at == 0 else low)[axis] = 1e-6 if at == 0 else at * 1e-3 - 1e-6
    return support(name, fix, low, high, more)


def probe(name, on, quantity, reduce="mean"):
    return f'[[probe]]\nname = "{name}"\non = "{on}"\nquantity = "{quantity}"\nreduce = "{reduce}"\n'


def ends(height, speed, ramp, fix):
    """Two ends, the upper one moves down."""
    return (face("foot", 2, 0, fix) + face("head", 2, height, fix, f'velocity = [0.0, 0.0, {-speed}]\nramp = {ramp}')
            + probe("force", "head", "force_z", "sum") + probe("path", "head", "displacement_z"))


READ = ("time", "force", "path", "side_force", "side_path", "front_path", "back_path", "left_path", "right_path")
SMOOTH, HELD = ["z", "spin_x", "spin_y"], ["all"]


def plate(side, strain, speed):
    """A plate pressed along z, and along x by a pressure [Pa], pressures over time [[s, Pa], ...], or as fast as along z ("alike")."""
    text = ends(200, speed, 2e-4, ["z"]) + face("left", 0, 0, ["x"] if side else [])
    for axis, turns in ((2, ["spin_x", "spin_y"]), (0, ["spin_y", "spin_z"])):  # shared edges: alike, still
        if axis == 2 or side:
            text += face(f"turns_{'x-z'[axis]}_0", axis, 0, turns) + face(f"turns_{'x-z'[axis]}_1", axis, 200, turns)
    if side == "alike":
        text += face("right", 0, 200, ["x"], f"velocity = [{-speed}, 0.0, 0.0]\nramp = 2e-4")
    elif side:
        table = side if isinstance(side, list) else [[0, 0], [0.5e-3, side]]
        pressure = ", ".join(f"[{t:.6g}, {-p:.6g}]" for t, p in table)
        text += face("right", 0, 200, ["x"], f'servo = {{ axis = "x", pressure = [{pressure}], area = 0.01, speed = 1.0, gain = 2.0 }}')
    else:
        text += face("right", 0, 200, [])
    return 0.2 * strain / speed, text + probe("side_force", "right", "force_x", "sum") + probe("side_path", "right", "displacement_x")


def cantilever():
    """Clamped at the foot; a corner of the head is drawn aside and let go after 10 ms."""
    corner = support("corner", ["x"], (0.09999, 0.09999, 0.19999), (1, 1, 1), 'velocity = [[0, 0, 0, 0], ["2 ms", 5e-5, 0, 0], ["8 ms", 5e-5, 0, 0], ["10 ms", 0, 0, 0]]')
    text = face("foot", 2, 0, HELD) + corner + face("head", 2, 200, []) + support("front", [], (-1, -1, 0.19999), (1, 1e-6, 1)) + support("back", [], (-1, 0.1 - 1e-6, 0.19999), (1, 1, 1))
    text += '[[stage]]\nname = "draw"\nuntil = "10 ms"\n[[stage]]\nname = "swing"\n[[stage.support]]\nname = "corner"\nfix = []\n'
    return 0.1, text + probe("force", "corner", "force_x", "sum") + probe("path", "head", "displacement_x") + probe("front_path", "front", "displacement_x") + probe("back_path", "back", "displacement_x")


def bending(speed, way, notch):
    """The middle of the top goes down and does not turn, outer lower edges bear; way [m], width of the notch [mm]."""
    text = support("load", ["all"], (0.0375 - 1e-6, -1, 0.2 - 1e-6), (0.0625 + 1e-6, 1, 1), f"velocity = [0.0, 0.0, {-speed}]\nramp = 2e-3")
    for name, side in (("left", -1), ("right", 1)):
        end, mouth = 0.05 + side * (0.05 + 1e-3 * ldpm_beam.LENGTH), 0.05 + side * 0.5e-3 * notch
        text += support(f"foot_{name}", ["z"], (end - 1e-5, -1, -1), (end + 1e-5, 1, 1e-6))
        text += support(name, [], (mouth - 1e-6, -1, -1), (mouth + 1e-6, 1e-6, 1e-6)) + probe(f"{name}_path", name, "displacement_x")
    return way / speed + 1e-3, text + probe("force", "load", "force_z", "sum") + probe("path", "load", "displacement_z")


def wall_of_cylinder():
    return 'center = [0.0, 0.0, 0.0]\nradius = 0.0499\naround = "z"\noutside = true\n'


CASES = {
    "prism_smooth": ("prism", lambda: (0.045, ends(200, 0.02, 2e-3, SMOOTH))),
    "prism_held": ("prism", lambda: (0.045, ends(200, 0.02, 2e-3, HELD))),
    "cantilever": ("cantilever", cantilever),
    "uniaxial_strain": ("cylinder", lambda: (0.0505, ends(200, 0.2, 1e-3, SMOOTH) + '[[support]]\nname = "wall"\n' + wall_of_cylinder() + 'fix = ["x", "y"]\n')),
    "cube_smooth": ("cube", lambda: (6e-3, ends(100, 0.1, 5e-4, SMOOTH))),
    "cube_held": ("cube", lambda: (1e-2, ends(100, 0.1, 5e-4, HELD))),
    "plate_0": ("plate", lambda: plate(0, 4e-3, 0.2)),
    "plate_alike": ("plate", lambda: plate("alike", 4e-3, 0.2)),
    "plate_7": ("plate", lambda: plate(7e6, 4.5e-3, 0.2)),
    "plate_18": ("plate", lambda: plate(18e6, 5e-3, 0.2)),
    "beam_5-16": ("beam_5-16", lambda: bending(0.015, 0.75e-3, 4)),
    "beam_6-12": ("beam_6-12", lambda: bending(0.015, 0.75e-3, 5)),
    "beam_8-16": ("beam_8-16", lambda: bending(0.015, 1.5e-3, 4)),
    "beam_8-16_slow": ("beam_8-16", lambda: bending(0.005, 0.75e-3, 4)),
}


def make(repository, name, out):
    body, loading = CASES[name]
    folder = out / name
    folder.mkdir(parents=True, exist_ok=True)
    end_of_file = write_body(repository, body, folder)
    _, _, smallest, largest, parameters = BODIES[body]
    if body == "cantilever":  # elastic
        parameters = {**parameters, "tension": 1e12, "collapse": 1e12, "length": 100.0}
    end, text = loading()
    rows = 10e-6 if body == "cantilever" else end / 1000
    (folder / "case.toml").write_text(f"""breccia = 1
method = "dem3d"
title = "Public body of LDPM: {name}"
[time]
end = {end}
safety = 0.9
evaluate_every = 10
[output]
frames = 0
fields = false
pictures = false
report = false
history = {rows}
{material(parameters, smallest, largest)}
[[body]]
name = "body"
shape = "file"
material = "concrete"
file = "body-data-{end_of_file}.dat"
{text}""")


def history(folder):
    with open(folder / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))[1:]  # the first one has units
    return {key: [float(row[key]) for row in rows] for key in READ if key in rows[0]}


def at(x, y, where):
    """y where x first reaches a value, linear between rows."""
    for (x0, y0), (x1, y1) in zip(zip(x, y), zip(x[1:], y[1:])):
        if x0 < where <= x1:
            return y0 + (y1 - y0) * (where - x0) / (x1 - x0)
    return None


def upward_zeros(times, values):
    mean = sum(values) / len(values)
    pairs = zip(times, times[1:], values, values[1:])
    return [t + (u - t) * (a - mean) / (a - b) for t, u, a, b in pairs if a < mean <= b]


def swings(h):
    """Periods of the head's displacement and of its turn after 10 ms; amplitudes of the first and the last tenth."""
    first = next(k for k, t in enumerate(h["time"]) if t > 10.02e-3)
    times = h["time"][first:]
    bend = h["path"][first:]
    turn = [front - back for front, back in zip(h["front_path"][first:], h["back_path"][first:])]
    found = {}
    for name, values in (("bending", bend), ("torsion", turn)):
        zeros = upward_zeros(times, values)
        found[f"period_{name}", "ms"] = 1e3 * (zeros[-1] - zeros[0]) / (len(zeros) - 1)
    tenth = len(bend) // 10
    for name, part in (("first", bend[:tenth]), ("last", bend[-tenth:])):
        found[f"amplitude_{name}", "um"] = 1e6 * math.sqrt(2 * sum(x * x for x in part) / len(part))
    found["force", "N"] = abs(h["force"][first - 2])
    return found


def compressed(h, area, height, strains):
    stress = [abs(f) / area * 1e-6 for f in h["force"]]
    strain = [abs(x) / height * 1e3 for x in h["path"]]
    top = max(range(len(stress)), key=stress.__getitem__)
    found = {("peak", "MPa"): stress[top], ("peak_strain", "1e-3"): strain[top]}
    for where in strains:
        if (value := at(strain, stress, where)) is not None:
            found[f"stress_{where:g}", "MPa"] = value
    if "side_force" in h:
        found["side_stress", "MPa"] = abs(h["side_force"][top]) / area * 1e-6
    return found


def bent(h):
    opening = [1e3 * (right - left) for left, right in zip(h["left_path"], h["right_path"])]
    load, path = [abs(f) for f in h["force"]], [1e3 * abs(u) for u in h["path"]]
    top = max(range(len(load)), key=load.__getitem__)
    found = {("peak", "N"): load[top], ("displacement", "mm"): path[top], ("opening", "mm"): opening[top]}
    for where in (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.75):
        if (value := at(opening, load, where)) is not None:
            found[f"load_{where:g}", "N"] = value
    work = [0.0]
    for k in range(1, len(load)):
        work.append(work[-1] + 0.5 * (load[k] + load[k - 1]) * (path[k] - path[k - 1]))
    if (value := at(opening, work, 0.3)) is not None:
        found["work_0.3", "mJ"] = value
    return found


def numbers_of(name, folder):
    h, body = history(folder), CASES[name][0]
    if body.startswith("beam"):
        return bent(h)
    if body == "cantilever":
        return swings(h)
    x, y, z = (1e-3 * edge for edge in SIZES[body])
    area = math.pi * x * x / 4 if body == "cylinder" else x * y
    return compressed(h, area, z, (1.52, 3, 5.56, 7, 9.6, 19.7, 39.9, 50) if body == "cylinder" else (0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 6, 8))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    add = commands.add_parser("make", help="writes cases")
    add.add_argument("repository")
    add.add_argument("names", nargs="+", choices=CASES)
    add.add_argument("--out", type=pathlib.Path, required=True)
    add = commands.add_parser("read", help="prints the numbers of a run, or appends them to docs/results/ldpm.csv")
    add.add_argument("folder", type=pathlib.Path, help="result folder of the run")
    add.add_argument("name", choices=CASES)
    add.add_argument("--record", action="store_true")
    options = parser.parse_args()
    if options.command == "make":
        for name in options.names:
            make(options.repository, name, options.out)
        return
    rows = [[options.name, "public", "", quantity, unit, f"{value:.5g}"] for (quantity, unit), value in numbers_of(options.name, options.folder).items()]
    target = open(ROOT / "docs/results/ldpm.csv", "a", newline="") if options.record else sys.stdout
    csv.writer(target, lineterminator="\n").writerows(rows)


if __name__ == "__main__":
    main()
