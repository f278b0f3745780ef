#!/usr/bin/env python3
"""Least thickness of a semicircular arch of n rigid stones that do not slide, over its mean radius.

A line of thrust must stay inside at every joint (Heyman 1969). From the crown outwards it is given by the horizontal
thrust H and the height at which H acts: the bounds at the joints are linear in H and its moment, so that
for each H an interval of moments is left or not. Stones have straight sides.

    scripts/arch_thrust.py [STONES]
"""

import math
import sys


def area_and_lever(thickness, begin, end):
    """Area of a stone between two angles from the vertical and the x of its middle (R = 1)."""
    inner, outer = 1.0 - thickness / 2.0, 1.0 + thickness / 2.0
    corners = [(r * math.sin(a), r * math.cos(a))
               for r, a in ((inner, begin), (outer, begin), (outer, end), (inner, end))]
    twice = moment = 0.0
    for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1]):
        cross = x0 * y1 - x1 * y0
        twice += cross
        moment += (x0 + x1) * cross
    return abs(twice) / 2.0, moment / (3.0 * twice)


def stands(thickness, stones):
    inner, outer = 1.0 - thickness / 2.0, 1.0 + thickness / 2.0
    step = math.pi / stones
    odd = stones % 2
    angles = [0.0] + [step * (k + 0.5 * odd) for k in range(1 - odd, stones // 2 + 1)]
    bounds = [] if odd else [(inner, -1.0, 0.0), (-outer, 1.0, 0.0)]  # p H + q G <= r
    weight = moment = 0.0
    for begin, end in zip(angles, angles[1:]):
        area, lever = area_and_lever(thickness, begin, end)
        weight += area
        moment += area * lever
        # The thrust passes the joint at r = (G + moment) / (weight sin + H cos), inner <= r <= outer.
        sine, cosine = math.sin(end), math.cos(end)
        bounds.append((inner * cosine, -1.0, moment - inner * weight * sine))
        bounds.append((-outer * cosine, 1.0, outer * weight * sine - moment))
    for k in range(1, 4001):
        thrust = 1.2 * thickness * k / 4000.0
        low = max(p * thrust - r for p, q, r in bounds if q < 0.0)
        high = min(r - p * thrust for p, q, r in bounds if q > 0.0)
        if low <= high:
            return True
    return False


def least_thickness(stones):
    falls, holds = 0.03, 0.2
    for _ in range(30):
        middle = 0.5 * (falls + holds)
        falls, holds = (falls, middle) if stands(middle, stones) else (middle, holds)
    return holds


if __name__ == "__main__":
    for count in [int(a) for a in sys.argv[1:]] or [13, 201]:
        print(f"{count} stones: t/R = {least_thickness(count):.4f}")
