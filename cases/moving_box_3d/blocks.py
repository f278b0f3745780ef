#!/usr/bin/env python3
"""Writes cubes of six tetrahedra each, side 1 m, 0.02 m apart, as an Abaqus file: blocks.py NX NY NZ FILE."""

import itertools
import pathlib
import sys

PITCH = 1.02
CORNERS = list(itertools.product((0, 1), repeat=3))
# Kuhn's division: a way from corner (0, 0, 0) to (1, 1, 1) along the axes, in each of their six orders.
WAYS = []
for order in itertools.permutations(range(3)):
    at, way = [0, 0, 0], [0]
    for axis in order:
        at[axis] = 1
        way.append(CORNERS.index(tuple(at)))
    even = order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    WAYS.append(way if even else [way[0], way[2], way[1], way[3]])


def main():
    counts, path = [int(n) for n in sys.argv[1:4]], pathlib.Path(sys.argv[4])
    nodes, elements = [], []
    for cube in itertools.product(*(range(n) for n in counts)):
        first = len(nodes) + 1
        for corner in CORNERS:
            place = [PITCH * (i - 0.5 * (n - 1)) + c - 0.5 for i, n, c in zip(cube, counts, corner)]
            nodes.append(", ".join(f"{x:.6g}" for x in place))
        elements += [", ".join(str(first + k) for k in way) for way in WAYS]
    with path.open("w") as file:
        file.write("*NODE\n")
        file.writelines(f"{n}, {text}\n" for n, text in enumerate(nodes, 1))
        file.write("*ELEMENT, TYPE=C3D4, ELSET=blocks\n")
        file.writelines(f"{n}, {text}\n" for n, text in enumerate(elements, 1))


main()
