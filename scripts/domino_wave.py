#!/usr/bin/env python3
"""Speed of a wave of dominoes without friction between stones, from energy and momentum alone.

The model of van Leeuwen (2010, Am. J. Phys. 78, 721) at zero friction: feet do not slide, stones hit without rebound and
stay in touch, each leaning with its top corner on the back of the next,

    h sin(theta_i - theta_i+1) = p cos(theta_i+1) - d        h height, d thickness, p pitch

so that the angle of the front stone gives all others. Its energy is kept until it hits the next one; there the momentum along the only
motion that is left is kept. Prints the speed stone by stone.

    scripts/domino_wave.py [HEIGHT THICKNESS PITCH [STONES]]
"""

import math
import sys


def train(front, count, h, d, p):
    """Angles of the last `count` stones, the front one first, and their rates over the front's."""
    angles, rates = [front], [1.0]
    for _ in range(count - 1):
        ahead = angles[-1]
        angle = ahead + math.asin(min(1.0, (p * math.cos(ahead) - d) / h))
        rates.append(rates[-1] * (1.0 - p * math.sin(ahead) / (h * math.cos(angle - ahead))))
        angles.append(angle)
    return angles, rates


def speeds(h=0.05, d=0.01, p=0.025, stones=20, push=1.0, g=9.81, parts=400):
    """Pitch over the time from one hit to the next [m/s]; `push`: first angular velocity [1/s]."""
    inertia = (h * h + d * d) / 3.0  # over mass
    height = lambda angles: sum(0.5 * g * (h * math.cos(a) + d * math.sin(a)) for a in angles)
    meet = math.asin((p - d) / h)
    omega, found = push, []
    for count in range(1, stones + 1):
        angles, rates = train(0.0, count, h, d, p)
        total = 0.5 * inertia * omega**2 * sum(w * w for w in rates) + height(angles)
        time = 0.0
        for k in range(parts):
            angles, rates = train(meet * (k + 0.5) / parts, count, h, d, p)
            left = 2.0 * (total - height(angles)) / (inertia * sum(w * w for w in rates))
            if left <= 0.0:
                return found  # not pushed enough
            time += meet / parts / math.sqrt(left)
        found.append(p / time)
        angles, rates = train(meet, count, h, d, p)
        mass = sum(w * w for w in rates)
        omega = math.sqrt(2.0 * (total - height(angles)) / (inertia * mass)) * mass / (mass + 1.0)
    return found


if __name__ == "__main__":
    sizes = [float(a) for a in sys.argv[1:4]] or [0.05, 0.01, 0.025]
    count = int(sys.argv[4]) if len(sys.argv) > 4 else 20
    found = speeds(*sizes, stones=count, push=6.0)
    for k, v in enumerate(found, start=1):
        print(f"{k:3d} {v:.4f} m/s {v / math.sqrt(9.81 * sizes[0]):.4f} sqrt(g h)")
