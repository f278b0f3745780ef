#!/usr/bin/env python3
"""Plot of confined concrete and of a bar's pull-out beside what is published, for docs/validation-concrete.md, from finished runs. Needs python3-matplotlib.

    breccia test cases/rc_slab --material c30 --set material.c30.friction_cap=3e6 --set material.c30.broken_friction=0.6 --set material.c30.broken_rolling_limit=1 \\
        --only compression_prism --only triaxial_5 --only triaxial_20 --only triaxial_50 -o out/confined
    scripts/reinforced_tests.py pull_out
    scripts/concrete_curves.py docs/published_confined.png
"""
import csv
import math
import pathlib
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import published_runs
import reinforced_tests

ROOT = pathlib.Path(__file__).resolve().parent.parent
CURVES = ROOT / "out" / "confined" / "curves"
PRESSURES = {0: ("compression_prism", "0.4"), 5: ("triaxial_5", "tab:blue"), 20: ("triaxial_20", "tab:orange"), 50: ("triaxial_50", "tab:red")}
STRAIN, YOUNG = 2.2e-3, 30e3  # at the peak of plain concrete (Model Code 2010, C30); MPa


def curves(test):
    for path in sorted(CURVES.glob(f"{test}-*.csv")):
        with open(path, newline="") as file:
            rows = list(csv.reader(file))[1:]
        yield [100 * float(e) for e, _ in rows], [1e-6 * float(s) for _, s in rows]


def mander_strength(p, f_c):
    return f_c * (2.254 * math.sqrt(1 + 7.94 * p / f_c) - 2 * p / f_c - 1.254)


def mander(strain, p, f_c):
    top = mander_strength(p, f_c)
    at = STRAIN * (1 + 5 * (top / f_c - 1))
    r = YOUNG / (YOUNG - top / at)
    return top * strain / at * r / (r - 1 + (strain / at) ** r)


def bond(slip):
    """Model Code 1990, confined, good bond: MPa over mm."""
    if slip <= 1:
        return 13.7 * slip**0.4
    return 13.7 if slip <= 3 else max(5.5, 13.7 - (slip - 3) / 5 * (13.7 - 5.5))


def main():
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(13, 3.8))
    f_c = statistics.mean(max(stress) for _, stress in curves("compression_prism"))
    for p, (test, color) in PRESSURES.items():
        for k, (strain, stress) in enumerate(curves(test)):
            left.plot(strain, stress, color=color, lw=0.9, label=None if k else f"{p} MPa")
            middle.plot([p], [max(stress)], "o", mfc="none", ms=5, color=color, label="here, a packing each" if p == 5 and not k else None)
        x = [0.02 * k for k in range(1, 201)]
        if p <= 20:  # made for ties of columns
            left.plot(x, [mander(e / 100, p, f_c) for e in x], "--", color=color, lw=1)
    left.plot([], [], "k--", lw=1, label="Mander 1988")
    left.set(xlabel="axial strain, %", ylabel="axial stress, MPa", xlim=(0, 4), ylim=(0, None))
    x = [0.5 * k for k in range(111)]
    middle.plot(x, [f_c + 4.1 * p for p in x], "k-", lw=1, label="Richart 1928, f_c + 4.1 p")
    middle.plot(x, [f_c * (1 + 3.7 * (p / f_c) ** 0.86) for p in x], "k:", lw=1, label="Newman, f_c (1 + 3.7 (p/f_c)^0.86)")
    middle.plot(x[:41], [mander_strength(p, f_c) for p in x[:41]], "k--", lw=1, label="Mander 1988")
    middle.set(xlabel="pressure on the sides, MPa", ylabel="strength, MPa", ylim=(0, None))
    surface = math.pi * 0.016 * 0.08
    for seed in range(1, 20):
        folder = reinforced_tests.OUT / f"pull_out-{seed}"
        if not (folder / "summary.json").exists():
            continue
        rows = reinforced_tests.rows(folder)
        right.plot([1e3 * abs(r["end"]) for r in rows], reinforced_tests.smooth([abs(r["pull"]) / surface * 1e-6 for r in rows], 5), lw=0.9, color="tab:blue",
                   label="here, a packing each" if seed == 1 else None)
    x = [0.02 * k for k in range(201)]
    right.plot(x, [bond(s) for s in x], "k--", lw=1, label="Model Code 1990, confined, good bond")
    right.axhline(14.5, color="k", lw=1, ls=":", label="Model Code 2010, 2.5 sqrt(f_cm)")
    right.set(xlabel="slip of the pulled end, mm", ylabel="bond stress, MPa", xlim=(0, 4), ylim=(0, None))
    published_runs.save_plot(figure, (left, middle, right), sys.argv[1], dpi=100, columns=1)
    print(f"f_c {f_c:.1f}; " + "; ".join(f"{p} MPa: {statistics.mean(max(s) for _, s in curves(test)):.1f}, Mander {mander_strength(p, f_c):.1f}, "
                                         f"at {statistics.mean(e[s.index(max(s))] for e, s in curves(test)):.2f} %, Mander {100 * STRAIN * (1 + 5 * (mander_strength(p, f_c) / f_c - 1)):.2f} %"
                                         for p, (test, _) in PRESSURES.items()))


if __name__ == "__main__":
    main()
