#!/usr/bin/env python3
"""Three-point bending of cases/three_point_bending_3d by other means: a beam of elastic squares in plane stress with one cohesive
plane at midspan, at rest (no inertia), led by the opening of the plane's lower end. Prints deflection of the press and force.

    scripts/beam_reference.py [--notch MM] [--factor K] [--squares N] [--softening breccia|linear]

The plane has Breccia's law of opening (docs/theory-fdem.md, section 2) with 2 h f_t/p_f of elastic opening, or linear
softening with the same G_I. Nothing else cracks. Needs python3-numpy.
"""

import argparse

import numpy

SPAN, HEIGHT, WIDTH = 0.315, 0.04, 0.02
YOUNG, POISSON, TENSION, ENERGY = 26e9, 0.2, 3e6, 30.0
ELASTIC = 2.0 * (2.0 / 3.0 * 4.95e-3) * TENSION / (20.0 * YOUNG)  # 2 h f_t/p_f of cubes of 4.95 mm


def breccia(opening, factor):
    a, b, c = 0.63, 1.8, 6.0
    d = numpy.clip((opening - ELASTIC) * TENSION / (factor * ENERGY), 0.0, 1.0)
    kept = (1 - (a + b - 1) / (a + b) * numpy.exp(d * (a + c * b) / ((a + b) * (1 - a - b)))) * (a * (1 - d) + b * (1 - d) ** c)
    r = numpy.minimum(opening / ELASTIC, 1.0)
    return TENSION * numpy.where(opening < 0, 2 * r, (2 * r - r * r) * kept)


def linear(opening):
    ends = [0.0, ELASTIC, ELASTIC + 2 * ENERGY / TENSION]
    return numpy.where(opening < 0, TENSION * opening / ELASTIC, numpy.interp(opening, ends, [0.0, TENSION, 0.0]))


def half_beam(squares):
    """Stiffness that the half of the beam puts on its midspan: horizontal ways from below to the top, then the press' own way."""
    columns = round(SPAN / 2 / HEIGHT * squares)
    dx, dy = SPAN / 2 / columns, HEIGHT / squares
    law = YOUNG / (1 - POISSON**2) * numpy.array([[1, POISSON, 0], [POISSON, 1, 0], [0, 0, (1 - POISSON) / 2]])
    own, g = numpy.zeros((8, 8)), 1 / 3**0.5
    for x in (-g, g):
        for y in (-g, g):
            by_x = numpy.array([y - 1, 1 - y, 1 + y, -1 - y]) / (2 * dx)
            by_y = numpy.array([x - 1, -1 - x, 1 + x, 1 - x]) / (2 * dy)
            strain = numpy.zeros((3, 8))
            strain[0, 0::2] = strain[2, 1::2] = by_x
            strain[1, 1::2] = strain[2, 0::2] = by_y
            own += strain.T @ law @ strain * (dx * dy / 4 * WIDTH)
    node = lambda i, j: i * (squares + 1) + j
    size = 2 * (columns + 1) * (squares + 1)
    whole = numpy.zeros((size, size))
    for i in range(columns):
        for j in range(squares):
            at = [2 * n + c for n in (node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)) for c in (0, 1)]
            whole[numpy.ix_(at, at)] += own
    shown = [2 * node(0, j) for j in range(squares + 1)] + [2 * node(0, squares) + 1]
    inner = numpy.setdiff1d(numpy.arange(size), shown + [2 * node(columns, 0) + 1])
    side = whole[numpy.ix_(inner, shown)]
    return whole[numpy.ix_(shown, shown)] - side.T @ numpy.linalg.solve(whole[numpy.ix_(inner, inner)], side)


def bend(traction, squares=20, notch=0.0, widest=40e-6):
    """Rows of deflection and force."""
    stiffness = half_beam(squares)
    y = numpy.linspace(0.0, HEIGHT, squares + 1)
    area = numpy.full(squares + 1, HEIGHT / squares * WIDTH)
    area[[0, -1]] *= 0.5
    lead = int(round(notch / HEIGHT * squares))
    area[y < notch - 1e-9] = 0.0
    if notch > 0:
        area[lead] *= 0.5
    ways, force, rows = numpy.zeros(squares + 2), 0.0, []
    for wide in numpy.concatenate([numpy.linspace(ELASTIC / 40, ELASTIC, 20), ELASTIC + numpy.linspace(0, 1, 120)[1:] ** 2 * widest]):
        for turn in range(200):
            opening, small = 2 * ways[:-1], 1e-3 * ELASTIC
            slope = (traction(opening + small) - traction(opening - small)) / small * area
            left = stiffness @ ways
            left[:-1] += traction(opening) * area
            left[-1] += force / 2
            matrix = numpy.zeros((squares + 3, squares + 3))
            matrix[:-1, :-1] = stiffness + numpy.diag(numpy.append(slope, 0.0))
            matrix[-2, -1], matrix[-1, lead] = 0.5, 1.0
            missing = numpy.append(-left, wide / 2 - ways[lead])
            if abs(left).max() < 1e-9 * TENSION * HEIGHT * WIDTH and abs(missing[-1]) < 1e-12:
                break
            change = numpy.linalg.solve(matrix, missing)
            share = min(1.0, 2e-6 / max(abs(change[:-2]).max(), 1e-30)) * (1.0 if turn < 40 else 0.5)
            ways += share * change[:-1]
            force += share * change[-1]
        rows.append((-ways[-1], force))
    return numpy.array(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--notch", type=float, default=0.0, help="mm")
    parser.add_argument("--factor", type=float, default=2.588612779530447, help="of softening: 3 in the classical codes")
    parser.add_argument("--squares", type=int, default=20, help="over the height")
    parser.add_argument("--softening", choices=["breccia", "linear"], default="breccia")
    given = parser.parse_args()
    law = linear if given.softening == "linear" else lambda o: breccia(o, given.factor)
    rows = bend(law, given.squares, 1e-3 * given.notch)
    for way, force in rows[::8]:
        print(f"{1e6 * way:8.2f} um {force:8.2f} N")
    print(f"largest force {rows[:, 1].max():.1f} N at {1e6 * rows[rows[:, 1].argmax(), 0]:.1f} um; stiffness {rows[10, 1] / rows[10, 0] / 1e6:.3f} MN/m")


if __name__ == "__main__":
    main()
