#!/usr/bin/env python3
"""Formulas of hard missile impact on concrete slabs, all in SI units, for docs/validation-concrete.md.

CEA-EDF: V_p = 1.3 rho^(1/6) sqrt(f_c) (d e^2 / M)^(2/3), with bars times sqrt(r + 0.3), r in percent each way
on each face (Berriaud et al. 1978). Modified NDRC: G = 3.8e-5 N M / (d sqrt(f_c)) (V / d)^1.8, x/d = 2 sqrt(G)
for G <= 1, perforation e/d = 3.19 x/d - 0.718 (x/d)^2 for x/d <= 1.35, scabbing h/d = 7.91 x/d - 5.06 (x/d)^2 for
x/d <= 0.65.

Usage: scripts/impact_formulas.py [f_c in MPa]; without arguments for the slab of cases/rc_slab and a ball of 14.5 kg.
"""
import math
import sys


def cea_edf(d, e, mass, f_c, density, percent=None):
    bars = 1.0 if percent is None else math.sqrt(percent + 0.3)
    return 1.3 * density ** (1 / 6) * math.sqrt(f_c) * (d * e * e / mass) ** (2 / 3) * bars


def ndrc_depth(d, mass, f_c, speed, nose):
    """x/d, and G."""
    g = 3.8e-5 * nose * mass / (d * math.sqrt(f_c)) * (speed / d) ** 1.8
    return (2 * math.sqrt(g) if g <= 1 else g + 1), g


def perforated(x):
    """e/d"""
    return 3.19 * x - 0.718 * x * x if x <= 1.35 else 1.32 + 1.24 * x


def scabbed(x):
    """h/d"""
    return 7.91 * x - 5.06 * x * x if x <= 0.65 else 2.12 + 1.36 * x


def speed_for(thickness, d, mass, f_c, nose, curve):
    low, high = 0.1, 1000.0
    for _ in range(100):
        middle = 0.5 * (low + high)
        if curve(ndrc_depth(d, mass, f_c, middle, nose)[0]) * d < thickness:
            low = middle
        else:
            high = middle
    return low


def check():
    """Worked values: M = 50 kg, d = 0.2 m, V = 100 m/s, f_c = 40 MPa, flat nose."""
    x, g = ndrc_depth(0.2, 50, 40e6, 100, 0.72)
    assert abs(g - 0.07801) < 5e-5 and abs(x * 0.2 - 0.1117) < 1e-4, (g, x)
    assert abs(perforated(x) * 0.2 - 0.3116) < 1e-4 and abs(scabbed(x) * 0.2 - 0.5679) < 1e-4
    assert abs(cea_edf(0.2, 0.3, 50, 40e6, 2400) - 152.25) < 0.05


def main():
    check()
    f_c = 1e6 * float(sys.argv[1]) if len(sys.argv) > 1 else 32.3e6
    d, e, mass = 0.226, 0.1, 14.5
    percent = 100 * 7 * math.pi / 4 * 0.008**2 / (1.0 * e)
    print(f"f_c {f_c * 1e-6:.1f} MPa, bars {percent:.3f} % each way on each face")
    print(f"CEA-EDF, perforation: with bars {cea_edf(d, e, mass, f_c, 2400, percent):.1f} m/s; form without r "
          f"{cea_edf(d, e, mass, f_c, 2400):.1f} m/s; r = 0 {cea_edf(d, e, mass, f_c, 2400, 0.0):.1f} m/s")
    for nose, name in ((0.84, "blunt"), (1.0, "spherical")):
        print(f"modified NDRC, {name}: perforation {speed_for(e, d, mass, f_c, nose, perforated):.1f} m/s, scabbing "
              f"{speed_for(e, d, mass, f_c, nose, scabbed):.1f} m/s")


if __name__ == "__main__":
    main()
