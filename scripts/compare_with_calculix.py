#!/usr/bin/env python3
"""Tetrahedra beside CalculiX, a finite element program: a cantilever of 100 x 20 x 20 mm bent and sheared by its weight at rest, on
one mesh with linear tetrahedra (C3D4) in both; and the step that Breccia takes beside 2/omega of the stiffest mode.

    scripts/compare_with_calculix.py [--binary build/release/breccia] [--edges 10,7,5]

Needs ccx (Debian: calculix-ccx), gmsh, and python3 with numpy, scipy and meshio. Prints the table of docs/theory-fdem3.md, section 4.
"""
import argparse
import contextlib
import csv
import io
import json
import pathlib
import subprocess
import tempfile

import meshio
import numpy
import scipy.sparse
import scipy.sparse.linalg

YOUNG, POISSON, DENSITY, WEIGHT = 30e9, 0.25, 2500.0, 981.0  # Pa, -, kg/m3, m/s2: rotations of 3e-4
LENGTH, SIZE = 0.1, 0.02  # m
GEO = """SetFactory("OpenCASCADE");
Box(1) = {{0, {y}, {y}, {length}, {size}, {size}}};
Mesh.MeshSizeMin = {edge}; Mesh.MeshSizeMax = {edge};
Physical Volume("beam") = {{1}};
"""
CASE = """breccia = 1
method = "fdem3d"
title = "Cantilever under its weight"
gravity = [0.0, {g}, {g}]
local_damping = 0.8
[time]
end = "12 ms"
safety = 0.7
[output]
pictures = false
frames = 0
history = "0.1 ms"
[material.rock]
young = {young}
poisson = {poisson}
density = {density}
damping = 0.0
joints = "none"
[[body]]
name = "beam"
shape = "mesh"
file = "beam.msh"
material = "rock"
[[support]]
name = "root"
on = "beam"
max = ["1 um", 1.0, 1.0]
fix = ["x", "y", "z"]
"""
PROBE = """[[probe]]
name = "{name}"
on = "beam"
quantity = "displacement_{axis}"
reduce = "mean"
min = ["{low} mm", -1.0, -1.0]
max = [{high}, 1.0, 1.0]
"""
ENDS = {"middle": (0.05, 0.06), "tip": (0.0999, 1.0)}  # m: boxes of the probes along the beam


def stiffness(points, cells):
    """Of linear tetrahedra with masses lumped at their corners: K [N/m], M [kg], and two bounds of omega^2 [1/s2]: the stiffest tetrahedron
    by itself, and Gershgorin's of the whole."""
    lame, shear = YOUNG * POISSON / (1 + POISSON) / (1 - 2 * POISSON), YOUNG / 2 / (1 + POISSON)
    elastic = numpy.zeros((6, 6))
    elastic[:3, :3] = lame
    elastic += numpy.diag([2 * shear] * 3 + [shear] * 3)
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    volume = numpy.linalg.det(edges) / 6
    inverse = numpy.linalg.inv(edges)  # columns: gradients of corners 1 to 3
    gradient = numpy.concatenate([-inverse.sum(axis=2, keepdims=True), inverse], axis=2)
    strain = numpy.zeros((len(cells), 6, 12))
    for k in range(4):
        x, y, z = (gradient[:, axis, k] for axis in range(3))
        for axis, of in enumerate((x, y, z)):
            strain[:, axis, 3 * k + axis] = of
        for row, (a, b) in enumerate(((0, 1), (1, 2), (0, 2))):
            of = (x, y, z)
            strain[:, 3 + row, 3 * k + a] = of[b]
            strain[:, 3 + row, 3 * k + b] = of[a]
    each = numpy.einsum("eia,ij,ejb->eab", strain, elastic, strain) * abs(volume)[:, None, None]
    of = (3 * cells[:, :, None] + numpy.arange(3)).reshape(len(cells), 12)
    size = 3 * len(points)
    whole = scipy.sparse.coo_matrix((each.ravel(), (numpy.repeat(of, 12, axis=1).ravel(), numpy.tile(of, (1, 12)).ravel())), shape=(size, size)).tocsr()
    mass = numpy.bincount(cells.ravel(), numpy.repeat(DENSITY * abs(volume) / 4, 4), minlength=len(points))
    rows = abs(whole).sum(axis=1).A1 / numpy.repeat(mass, 3)
    alone = numpy.linalg.eigvalsh(each)[:, -1] / (DENSITY * abs(volume) / 4)
    return whole, numpy.repeat(mass, 3), alone.max(), rows.max()


def calculix(folder, points, cells):
    """Displacement of each node at rest  [m]"""
    root = numpy.flatnonzero(points[:, 0] < 1e-9) + 1
    g = WEIGHT / numpy.sqrt(2)
    with open(folder / "beam.inp", "w") as deck:
        deck.write("*NODE, NSET=ALL\n" + "".join(f"{i + 1}, {x:.12g}, {y:.12g}, {z:.12g}\n" for i, (x, y, z) in enumerate(points)))
        deck.write("*ELEMENT, TYPE=C3D4, ELSET=BEAM\n" + "".join(f"{i + 1}, {', '.join(str(n + 1) for n in c)}\n" for i, c in enumerate(cells)))
        deck.write("*NSET, NSET=ROOT\n" + "".join(f"{n},\n" for n in root))
        deck.write(f"*MATERIAL, NAME=ROCK\n*ELASTIC\n{YOUNG}, {POISSON}\n*DENSITY\n{DENSITY}\n*SOLID SECTION, ELSET=BEAM, MATERIAL=ROCK\n")
        deck.write("*BOUNDARY\nROOT, 1, 3\n*STEP\n*STATIC\n*DLOAD\n"
                   f"BEAM, GRAV, {WEIGHT}, 0., {g / WEIGHT:.16g}, {g / WEIGHT:.16g}\n*NODE PRINT, NSET=ALL\nU\n*END STEP\n")
    ran = subprocess.run(["ccx", "-i", "beam"], cwd=folder, capture_output=True, text=True)
    if ran.returncode != 0 or "*ERROR" in ran.stdout:
        raise SystemExit("ccx: " + ran.stdout[-800:])
    moved = numpy.zeros((len(points), 3))
    for line in (folder / "beam.dat").read_text().splitlines():
        words = line.split()
        if len(words) == 4 and words[0].isdigit():
            moved[int(words[0]) - 1] = [float(w) for w in words[1:]]
    return moved


def breccia(binary, folder):
    probes = "".join(PROBE.format(name=f"{name}_{axis}", axis=axis, low=1e3 * low, high=high) for name, (low, high) in ENDS.items() for axis in "xyz")
    (folder / "case.toml").write_text(CASE.format(g=WEIGHT / numpy.sqrt(2), young=YOUNG, poisson=POISSON, density=DENSITY) + probes)
    subprocess.run([binary, "run", "case.toml", "-o", "out", "--force", "-q", "--no-progress"], cwd=folder, check=True)
    rows = list(csv.DictReader(open(folder / "out/history.csv")))
    return {key: float(value) for key, value in rows[-1].items()}, json.loads((folder / "out/summary.json").read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--binary", default="build/release/breccia")
    parser.add_argument("--edges", default="10,7,5", help="of the meshes [mm]")
    options = parser.parse_args()
    binary = pathlib.Path(options.binary).resolve()
    print("| edge, mm | tetrahedra | tip across, um: Breccia, CalculiX | apart | middle apart | step over 0.7 (2/omega) | by elements alone, by rows of all |\n|---|---|---|---|---|---|---|")
    for edge in (float(e) for e in options.edges.split(",")):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "beam.geo").write_text(GEO.format(y=-SIZE / 2, length=LENGTH, size=SIZE, edge=edge * 1e-3))
            subprocess.run(["gmsh", "-3", "beam.geo", "-format", "msh41", "-o", "beam.msh"], cwd=folder, check=True, capture_output=True)
            with contextlib.redirect_stdout(io.StringIO()):  # it prints empty lines
                mesh = meshio.read(folder / "beam.msh")
            cells = mesh.cells_dict["tetra"]
            used, cells = numpy.unique(cells, return_inverse=True)
            points, cells = mesh.points[used], cells.reshape(-1, 4)
            moved = calculix(folder, points, cells)
            seen, summary = breccia(binary, folder)
            whole, mass, alone, rows = stiffness(points, cells)
            slow = scipy.sparse.diags(1.0 / numpy.sqrt(mass))
            scaled = slow @ whole @ slow
            largest = scipy.sparse.linalg.eigsh(scaled, k=1, which="LA", return_eigenvectors=False)[0]
            corners = points[cells.ravel()]
            step = summary["time"] / summary["steps"]

            def of_calculix(place, axis):  # as a probe has it: the mean of corners of tetrahedra
                low, high = ENDS[place]
                inside = (corners[:, 0] >= low) & (corners[:, 0] <= high)
                return moved[cells.ravel()[inside], "xyz".index(axis)].mean()

            def apart(place, axis):
                there = of_calculix(place, axis)
                return f"{100 * (seen[f'{place}_{axis}'] / there - 1):+.4f} %"

            print(f"| {edge:g} | {len(cells)} | {1e6 * seen['tip_y']:.4f}, {1e6 * of_calculix('tip', 'y'):.4f} | {apart('tip', 'y')} | {apart('middle', 'z')} | "
                  f"{step / (0.7 * 2 / numpy.sqrt(largest)):.2f} | {numpy.sqrt(largest / alone):.2f}, {numpy.sqrt(largest / rows):.2f} |", flush=True)


if __name__ == "__main__":
    main()
