"""Formulas for beams of reinforced concrete, 1.0 x 0.1 x 0.15 m with two bars, span 0.9 m, for scripts/reinforced_tests.py. Strengths in MPa, diameters in m, loads in N."""
import math

SPAN, WIDTH, HEIGHT, DEPTH = 0.9, 0.1, 0.15, 0.125  # of the beams; depth of their bars  [m]
F_Y = 500.0  # [MPa]


def area(diameter):
    return 2 * math.pi / 4 * diameter**2


def flexure(diameter, strength):
    """Load at which the bars yield: A_s f_y z, stress block of 0.8 x with f_c; N."""
    force = area(diameter) * F_Y * 1e6
    x = force / (0.8 * WIDTH * strength * 1e6)
    return 4 * force * (DEPTH - 0.4 * x) / SPAN


def shear_eurocode(diameter, strength):
    """Eurocode 2, 6.2.2, with 0.18 and f_c instead of design values: the load, N."""
    k = min(2.0, 1 + math.sqrt(0.2 / DEPTH))
    rho = min(0.02, area(diameter) / (WIDTH * DEPTH))
    return 2 * 0.18 * k * (100 * rho * strength) ** (1 / 3) * 1e6 * WIDTH * DEPTH


def shear_niwa(strength):
    """Niwa, Yamada, Yokozawa and Okamura 1986: mean of tests with the effect of size, 0.2 f_c^(1/3) (100 rho)^(1/3) d^(-1/4)
    (0.75 + 1.4 d/a), d in m; the load, N."""
    rho = area(0.016) / (WIDTH * DEPTH)
    return 2e6 * 0.2 * (100 * rho * strength) ** (1 / 3) * DEPTH**-0.25 * (0.75 + 1.4 * DEPTH / (SPAN / 2)) * WIDTH * DEPTH


def shear_crack_theory(strength, young=30e3, aggregate=16.0):
    """Muttoni and Fernandez Ruiz 2008, mean: V = b d sqrt(f_c) / 3 / (1 + 120 eps d / (16 + d_g)), eps at 0.6 d below the top
    of the cracked section half of d from the load; the load, N."""
    rho = area(0.016) / (WIDTH * DEPTH)
    n = 200e3 / young
    x = DEPTH * rho * n * (math.sqrt(1 + 2 / (rho * n)) - 1)
    v = 1e4
    for _ in range(200):
        strain = v * (SPAN / 2 - DEPTH / 2) / (area(0.016) * 200e9 * (DEPTH - x / 3)) * (0.6 * DEPTH - x) / (DEPTH - x)
        v = 0.5 * (v + 1e6 * WIDTH * DEPTH * math.sqrt(strength) / 3 / (1 + 120 * strain * 1e3 * DEPTH / (16 + aggregate)))
    return 2 * v


def crushing(strength, last=3.5e-3, arm=SPAN / 2):
    """The load at which the concrete of the strong beam crushes (3.5e-3, block of 0.8 x with f_c) and its bars bear what they then
    do, up to f_y; N.
    @param arm  from a support to the bar of the load beside which it crushes  [m]"""
    low, high = 1e-3, DEPTH
    for _ in range(60):
        x = 0.5 * (low + high)
        bars = area(0.016) * 1e6 * min(F_Y, 200e3 * last * (DEPTH - x) / x)
        if 0.8 * x * WIDTH * strength * 1e6 > bars:
            high = x
        else:
            low = x
    return 2 * bars * (DEPTH - 0.4 * x) / arm


def shear_model_code(diameter, strength):
    """Model Code 2010, 7.3.3, level II with k_v = 0.4 / (1 + 1500 eps_x) 1300 / (1000 + k_dg z), aggregate of 16 mm; at mid
    depth eps_x = (M / z + V) / (2 E A_s) where V is sought, M = V (L / 2 - d)."""
    z = 0.9 * DEPTH
    v = 1e4
    for _ in range(200):
        strain = min(3e-3, (v * (SPAN / 2 - DEPTH) / z + v) / (2 * 200e9 * area(diameter)))
        k_v = 0.4 / (1 + 1500 * strain) * 1300 / (1000 + 1.0 * 1000 * z)
        v = 0.5 * (v + k_v * math.sqrt(strength) * 1e6 * WIDTH * z)
    return 2 * v
