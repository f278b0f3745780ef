#!/usr/bin/env python3
"""Splitting strength of an elastic disc with one cohesive crack on its loaded diameter, for docs/validation-concrete.md.

    scripts/disc_reference.py [--young 33.6e9] [--strength 2.9e6] [--energy 141] [--mesh 40] [DIAMETER:STRIP...]

Plane stress, a quarter of the disc by bilinear quadrilaterals, strips that are rigid or press evenly; the crack softens along one line or along
Petersson's two. The opening in the middle grows from zero; told is the first maximum of 2 P / (pi D t) over the strength, or that there is none: then
the load rises until the material crushes below the strips. Needs python3-scipy.
"""
import argparse

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as linear

POISSON, STIFF = 0.2, 1e3  # of the crack before it opens, over E / R


def stiffness(x, y, n, young):
    """Of all elements; x, y: corners in an (n + 1)^2 grid."""
    d = young / (1 - POISSON**2) * np.array([[1, POISSON, 0], [POISSON, 1, 0], [0, 0, (1 - POISSON) / 2]])
    rows, columns, values = [], [], []
    gauss = (-1 / np.sqrt(3), 1 / np.sqrt(3))
    for i in range(n):
        for j in range(n):
            nodes = [i * (n + 1) + j, (i + 1) * (n + 1) + j, (i + 1) * (n + 1) + j + 1, i * (n + 1) + j + 1]
            corners, k = np.c_[x[nodes], y[nodes]], np.zeros((8, 8))
            for a in gauss:
                for b in gauss:
                    shape = 0.25 * np.array([[b - 1, 1 - b, 1 + b, -1 - b], [a - 1, -1 - a, 1 + a, 1 - a]])
                    jacobian = shape @ corners
                    slope = np.linalg.solve(jacobian, shape)
                    strain = np.zeros((3, 8))
                    strain[0, ::2], strain[1, 1::2], strain[2, ::2], strain[2, 1::2] = slope[0], slope[1], slope[1], slope[0]
                    k += strain.T @ d @ strain * np.linalg.det(jacobian)
            place = np.array([[2 * q, 2 * q + 1] for q in nodes]).ravel()
            rows.append(np.repeat(place, 8)), columns.append(np.tile(place, 8)), values.append(k.ravel())
    size = 2 * (n + 1) ** 2
    return sparse.csc_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(size, size))


def condensed(radius, strip, n, young, rigid):
    """Stiffness of the nodes of the crack alone, what a load of 1 N/m puts on them, and the length each stands for."""
    a, b = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1), indexing="ij")
    x, y = (radius * a * np.sqrt(1 - b**2 / 2)).ravel(), (radius * b * np.sqrt(1 - a**2 / 2)).ravel()
    k, nodes = stiffness(x, y, n, young), len(x)
    below = np.flatnonzero((abs(np.hypot(x, y) - radius) < 1e-9) & (y > 0.5 * radius) & (x <= 0.5 * strip + 1e-12))
    load = np.zeros(2 * nodes + 1)
    if rigid:  # one more unknown, tied to the nodes below the strip
        tie = sparse.lil_matrix((2 * nodes + 1, 2 * nodes + 1))
        tie[: 2 * nodes, : 2 * nodes], load[-1] = k, -0.5
        for q in 2 * below + 1:
            tie[q, q] += 1e5 * young
            tie[-1, -1] += 1e5 * young
            tie[q, -1] -= 1e5 * young
            tie[-1, q] -= 1e5 * young
        k = tie.tocsc()
    else:
        below = below[np.argsort(x[below])]
        share = np.zeros(len(below))
        share[:-1] += np.diff(x[below]) / 2
        share[1:] += np.diff(x[below]) / 2
        load[2 * below + 1] = -0.5 * share / share.sum()
        load = load[:-1]
    crack = 2 * np.arange(n + 1)
    held = np.concatenate([crack, 2 * np.flatnonzero(y < 1e-12) + 1])
    free = np.setdiff1d(np.arange(k.shape[0]), held)
    solve, across = linear.splu(k[free][:, free]).solve, k[free][:, crack].toarray()
    length = np.zeros(n + 1)
    length[:-1] += np.diff(y[: n + 1]) / 2
    length[1:] += np.diff(y[: n + 1]) / 2
    return k[crack][:, crack].toarray() - across.T @ solve(across), -across.T @ solve(load[free]), length


def softening(kind, strength, energy, stiff):
    """[(opening, stress)] of the corners of the law."""
    rest = [(2.0, 0.0)] if kind == "one line" else [(0.8, 1 / 3), (3.6, 0.0)]
    return [(0.0, 0.0), (strength / stiff, strength)] + [(w * energy / strength, s * strength) for w, s in rest] + [(1.0, 0.0)]


def course(k, load, length, law, stiff, radius, last, steps=250):
    """Nominal stress over the opening in the middle."""
    openings, stresses = np.array(law).T
    slopes = np.diff(stresses) / np.diff(openings)
    u, force, n, found = np.zeros(len(length)), 0.0, len(length), []
    for middle in np.linspace(1e-9, last / 2, steps):
        for _ in range(100):
            opening = 2 * u
            part = np.clip(np.searchsorted(openings, opening) - 1, 0, len(slopes) - 1)
            pull = np.where(opening < 0, stiff * opening, stresses[part] + slopes[part] * (opening - openings[part]))
            tangent = np.zeros((n + 1, n + 1))
            tangent[:n, :n] = k + np.diag(2 * length * np.where(opening < 0, stiff, slopes[part]))
            tangent[:n, n], tangent[n, 0] = -load, 1
            step = np.linalg.solve(tangent, np.append(load * force - k @ u - length * pull, middle - u[0]))
            u, force = u + step[:n], force + step[n]
            if abs(step[:n]).max() < 1e-13:
                break
        found.append((2 * middle, force / (np.pi * radius)))  # 2 P / (pi D), the quarter has half of P
    return np.array(found)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("discs", nargs="*", default=["0.1:0.01", "0.1:0.005", "0.15:0.01", "0.15:0.015", "0.2:0.01", "0.3:0.01"])
    p.add_argument("--young", type=float, default=33.6e9)
    p.add_argument("--strength", type=float, default=2.9e6)
    p.add_argument("--energy", type=float, default=141.0)
    p.add_argument("--mesh", type=int, default=40)
    given = p.parse_args()
    print("| diameter, strip [mm] | " + " | ".join(f"{s}, {k}" for s in ("rigid", "even") for k in ("one line", "Petersson")) + " |\n|---|---|---|---|---|")
    for disc in given.discs:
        diameter, strip = map(float, disc.split(":"))
        stiff, cells = STIFF * given.young / (0.5 * diameter), []
        for rigid in (True, False):
            body = condensed(0.5 * diameter, strip, given.mesh, given.young, rigid)
            for kind in ("one line", "Petersson"):
                law = softening(kind, given.strength, given.energy, stiff)
                curve = course(*body, law, stiff, 0.5 * diameter, 4 * given.energy / given.strength)
                over = curve[:, 1] / given.strength
                first = next((i for i in range(1, len(over) - 1) if over[i - 1] < over[i] >= over[i + 1]), None)
                cells.append("rises" if first is None else f"{over[first]:.2f} at {1e6 * curve[first, 0]:.0f} um")
        print(f"| {1e3 * diameter:.0f}, {1e3 * strip:.0f} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
