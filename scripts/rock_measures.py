"""What runs of triangles show: numbers of the tables of scripts/rock_tables.py, by table, of the folder of a finished run."""

import csv
import json
import math
import statistics

from crack_networks import ends, network_from, networks


class Result:
    """The files of a finished run."""

    def __init__(self, folder):
        self.folder = folder
        self.summary = json.loads((folder / "summary.json").read_text())

    def value(self, path):
        found = self.summary
        for key in path.split("."):
            found = found[key]
        return float(found)

    def rows(self, name):
        """Rows of history.csv or cracks.csv as numbers; the second line holds units."""
        with open(self.folder / name, newline="") as file:
            rows = list(csv.DictReader(file))[1:]
        return [{key: float(value) for key, value in row.items() if key != "stage"} for row in rows]

    def cracks(self):
        """Broken joints with their ends at the start, by time."""
        return sorted(self.rows("cracks.csv"), key=lambda c: c["time"])

    def strongest(self, probe):
        ends = self.summary["probe"][probe]
        return max(abs(ends["min"]), abs(ends["max"]))


def tension(r, setting):
    width, strength, energy = 0.05, 3e6, 10.0
    return {
        "strength / f_t": r.strongest("force") / (strength * width),
        "fracture energy / (G_I A)": r.value("energy.fracture") / (energy * width),
        "of it in broken joints": sum(c["energy"] for c in r.cracks()) / r.value("energy.fracture"),
        "ledger error": r.value("energy.error_relative"),
    }


CRACK_ENERGY, CRACK_START = 6.0, -0.015  # of cases/crack_growth: G_I, and where its notch ends


def front_energy(r, start=CRACK_START):
    """Growth of the crack with the fracture energy at the moment, each time that its tip moves on; and its growth at last."""
    history, front, reached = r.rows("history.csv"), [], start
    for c in r.cracks():
        if (x := max(c["x0"], c["x1"])) > reached:
            reached = x
            front.append((x - start, next((row["fracture"] for row in history if row["time"] >= c["time"]), history[-1]["fracture"])))
    return front, reached - start


def slope(r, start=CRACK_START, window=(5e-3, 35e-3)):
    """Fracture energy over growth while the tip runs through a window ahead of the notch, least squares, J/m2."""
    front, growth = front_energy(r, start)
    inside = [(x, f) for x, f in front if window[0] < x < window[1]]
    return statistics.linear_regression(*zip(*inside)).slope if len(inside) > 2 else math.nan, growth


def crack(r, setting):
    """The slope of fracture energy over growth, least squares from 5 to 35 mm ahead of the notch, is the energy of the crack with the
    rock that softens beside it; the zone that softens ahead moves along and does not count."""
    energy, growth = slope(r)
    return {
        "fracture energy of growth / (G_I A)": energy / CRACK_ENERGY,
        "length of the path / growth": sum(math.dist(*ends(c)) for c in r.cracks()) / growth,
        "grown, mm": 1e3 * growth,
        "largest force, kN/m": 1e-3 * r.strongest("force"),
        "ledger error": r.value("energy.error_relative"),
    }


SHEAR_ENERGY, SHEAR_START = 100.0, -0.04  # of cases/crack_growth/shear.toml: G_II, and where its crack ends


def shear(r, setting):
    """A crack that slides, by the same slope. Where meshes are free it hardly grows, so that all of its growth counts."""
    energy, growth = slope(r, SHEAR_START, (0.0, 35e-3))
    return {
        "fracture energy of growth / (G_II A)": energy / SHEAR_ENERGY,
        "grown, mm": 1e3 * growth,
        "fracture energy, J/m": r.value("energy.fracture"),
        "of it in broken joints": sum(c["energy"] for c in r.cracks()) / r.value("energy.fracture"),
        "largest force, kN/m": 1e-3 * r.strongest("force"),
        "ledger error": r.value("energy.error_relative"),
    }


def energy(r, setting):
    """What a crack through a rock of the library takes, over what its joints ask for."""
    shown, growth = slope(r)
    return {
        "shown, J/m2": shown,
        "over G_I": shown / setting["G_I, J/m2"],
        "grown, mm": 1e3 * growth,
        "ledger error": r.value("energy.error_relative"),
    }


def disc(r, setting):
    strength, diameter, half = 5e6, 0.04, math.radians(10.0)
    load = r.strongest("force_top")
    unit = 2.0 * load / (math.pi * diameter) / strength
    history = r.rows("history.csv")
    peak = max(history, key=lambda row: row["force_top"])
    first = r.cracks()[:1]
    return {
        "2P/(pi D f_t)": unit,
        "over Hondros": unit * (math.sin(2.0 * half) / half - 1.0),
        "first break at abs(y)/R": abs(0.5 * (first[0]["y0"] + first[0]["y1"])) / 0.02 if first else math.nan,
        "kinetic / work at the peak": peak["kinetic"] / peak["work"],
        "jaws out of balance": abs(peak["force_top"] + peak["force_bottom"]) / peak["force_top"],
        "ledger error": r.value("energy.error_relative"),
    }


def kalthoff(r, setting):
    tip = (0.05, 0.025)
    crack = [c for c in network_from(r.cracks(), tip, 2.5e-3 + setting["edge"]) if c["y"] > 0.02]
    if not crack:
        return {"angle": math.nan}
    far, when = max(((e, c["time"]) for c in crack for e in ends(c)), key=lambda ec: math.dist(ec[0], tip))
    start = crack[0]["time"]
    early = max((e for c in crack for e in ends(c) if math.dist(e, tip) < 0.04), key=lambda e: math.dist(e, tip))
    return {
        "angle of the first 40 mm, degrees": math.degrees(math.atan2(early[1] - tip[1], early[0] - tip[0])),
        "of all, degrees": math.degrees(math.atan2(far[1] - tip[1], far[0] - tip[0])),
        "first break, us": 1e6 * start,
        "length, mm": 1e3 * math.dist(far, tip),
        "mean speed / c_R": math.dist(far, tip) / (when - start) / 2799.0,
        "ledger error": r.value("energy.error_relative"),
    }


def branching(r, setting):
    crack = network_from(r.cracks(), (0.0, 0.0), 2.0 * setting["edge"])
    if not crack:
        return {"first break, us": math.nan}
    front, reached = [], 0.0
    for c in crack:
        x = max(c["x0"], c["x1"])
        if x > reached:
            reached = x
            front.append((c["time"], x))
    window, fastest = 8e-6, 0.0
    for t0, x0 in front:
        later = [(t, x) for t, x in front if t - t0 >= window]
        if later:
            fastest = max(fastest, (later[0][1] - x0) / (later[0][0] - t0))
    # It has branched where a second crack runs at least 2.5 mm beside.
    wide = []
    for k in range(1, 50):
        inside = [c for c in crack if 1e-3 * (k - 1) <= c["x"] < 1e-3 * k]
        if inside and max(c["y"] for c in inside) - min(c["y"] for c in inside) > 2.5e-3:
            wide.append((k - 0.5, min(c["time"] for c in inside)))
    up = max((c["x1"] for c in crack if c["y"] > 2e-3), default=0.0)
    down = max((c["x1"] for c in crack if c["y"] < -2e-3), default=0.0)
    return {
        "first break, us": 1e6 * r.cracks()[0]["time"],
        "branches at x, mm": wide[0][0] if wide else math.nan,
        "and at, us": 1e6 * wide[0][1] if wide else math.nan,
        "fastest in 8 us / c_R": fastest / 2125.0,
        "upper branch to x, mm": 1e3 * up,
        "lower branch to x, mm": 1e3 * down,
        "ledger error": r.value("energy.error_relative"),
    }


def spall(r, setting):
    width = 0.012
    planes = []
    for n in networks(r.cracks()):
        ys = [e[1] for c in n for e in ends(c)]
        if max(ys) - min(ys) > 0.9 * width:
            planes.append((min(c["time"] for c in n), 300.0 - 1e3 * statistics.mean(c["x"] for c in n)))
    planes.sort()
    history = r.rows("history.csv")
    free = [row["end"] for row in history if row["time"] < 0.24e-3]
    return {
        "first plane from the end, mm": planes[0][1] if planes else math.nan,
        "at, us": 1e6 * planes[0][0] if planes else math.nan,
        "planes": float(len(planes)),
        "largest velocity of the end, m/s": max(free),
        "velocity of the last 45 mm, m/s": r.value("probe.cap.last"),
        "ledger error": r.value("energy.error_relative"),
    }


def triaxial(r, setting):
    bears = 20.0 * math.cos(math.pi / 6.0) / (1.0 - math.sin(math.pi / 6.0)) + 3.0 * setting["pressure"]
    history = r.rows("history.csv")
    peak = max(history, key=lambda row: row["force_top"])
    return {
        "sigma_1, MPa": r.strongest("force_top") / 0.03 / 1e6,
        "over Mohr-Coulomb": r.strongest("force_top") / 0.03 / 1e6 / bears,
        "kinetic / work at the peak": peak["kinetic"] / peak["work"],
        "ledger error": r.value("energy.error_relative"),
    }


def mohr_coulomb(cohesion, degrees, pressure=0.0):
    """Strength in compression under a pressure across."""
    sine, cosine = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    return (2.0 * cohesion * cosine + pressure * (1.0 + sine)) / (1.0 - sine)


def compression(r, setting):
    strength = r.strongest("force_top") / 0.03
    return {
        "sigma_1, MPa": strength / 1e6,
        "over Mohr-Coulomb": strength / mohr_coulomb(10e6, setting["phi, degrees"]),
        "ledger error": r.value("energy.error_relative"),
    }


def servos(r, setting):
    strength = r.strongest("axial") / 0.05
    return {
        "sigma_1, MPa": strength / 1e6,
        "over Mohr-Coulomb": strength / mohr_coulomb(15e6, 30, 10e6),
        "ledger error": r.value("energy.error_relative"),
    }


def granite(r, setting):
    history = r.rows("history.csv")
    peak = max(history, key=lambda row: row["force_top"])
    stress = 2.0 * r.strongest("force_top") / (math.pi * 0.08)
    return {
        "load, MN/m": r.strongest("force_top") / 1e6,
        "2P/(pi D), MPa": stress / 1e6,
        "over feldspar's f_t, 8 MPa": stress / 8e6,
        "at, us": 1e6 * peak["time"],
        "first break, us": 1e6 * r.cracks()[0]["time"] if r.cracks() else math.nan,
        "triangles": r.value("model.triangles"),
        "ledger error": r.value("energy.error_relative"),
    }


def dominoes(r, setting):
    """Speed from the times at which middles have moved by 1 mm, over the second half of the row."""
    history = r.rows("history.csv")
    count = sum(1 for key in history[0] if key.startswith("x") and key[1:].isdigit())
    moved = []
    for k in range(1, count + 1):
        start = history[0][f"x{k}"]
        moved.append(next((row["time"] for row in history if row[f"x{k}"] > start + 1e-3), math.nan))
    half, last = count // 2, count - 1
    speed = (last - half) * 0.025 / (moved[last] - moved[half])
    return {
        "speed, m/s": speed,
        "over sqrt(g h)": speed / math.sqrt(9.81 * 0.05),
        "ledger error": r.value("energy.error_relative"),
    }
