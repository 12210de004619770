#!/usr/bin/env python3
"""Writes tests/unit/stress_values.txt: stresses by a uniform traction on a rectangle to 40 digits, rounded to 21.

    python3 scripts/maintain/stress_values.py > tests/unit/stress_values.txt

Needs mpmath. The values are corner sums of antiderivatives at 60 digits, of which they lose at most 20. Some are
checked first against numerical quadrature of the stresses by point forces (Boussinesq, Cerruti) as Johnson 1985, ch. 3,
gives them; the script fails where the two differ.
"""

import random

from mpmath import asinh, atan2, log, mp, mpf, nstr, pi, quad, sqrt

mp.dps = 60

COMPONENTS = ["xx", "yy", "zz", "xy", "xz", "yz"]
CELLS = [(1, 1), (3, 1), (1, 40)]  # sides, m
POISSON = [0.3, 0.0, 0.5, -0.4]


def corner_p(x, y, z, nu):
    """2 pi times the antiderivatives of the stresses by p, in the order of COMPONENTS."""
    r = sqrt(x * x + y * y + z * z)
    a, xz, yz = atan2(x * y, z * r), x * x + z * z, y * y + z * z
    return [
        -2 * nu * a - (1 - 2 * nu) * atan2(x * y, xz + z * r) + z * x * y / (r * xz),
        -2 * nu * a - (1 - 2 * nu) * atan2(x * y, yz + z * r) + z * x * y / (r * yz),
        -a - z * x * y / r * (1 / xz + 1 / yz),
        -(1 - 2 * nu) * log(r + z) - z / r,
        z * z * y / (r * xz),
        z * z * x / (r * yz),
    ]


def corner_x(x, y, z, nu):
    """The same by q_x."""
    r = sqrt(x * x + y * y + z * z)
    xz, t = x * x + z * z, r + z
    lx, ly = asinh(x / sqrt(y * y + z * z)), asinh(y / sqrt(xz))
    return [
        2 * ly + 2 * nu * y / t + z * y / (r * t) - z * z * y / (r * xz),
        2 * nu * ly - 2 * nu * y / t - z * y / (r * t),
        z * z * y / (r * xz),
        lx - 2 * nu * x / t - z * x / (r * t),
        -atan2(x * y, z * r) + z * x * y / (r * xz),
        -z / r,
    ]


def point_p(x, y, z, nu):
    """2 pi times the stresses by a unit force along z (Boussinesq)."""
    r = sqrt(x * x + y * y + z * z)
    d2, m = x * x + y * y, 1 - 2 * nu
    return [
        m / d2 * ((1 - z / r) * (x * x - y * y) / d2 + z * y * y / r**3) - 3 * z * x * x / r**5,
        m / d2 * ((1 - z / r) * (y * y - x * x) / d2 + z * x * x / r**3) - 3 * z * y * y / r**5,
        -3 * z**3 / r**5,
        m / d2 * ((1 - z / r) * 2 * x * y / d2 - x * y * z / r**3) - 3 * x * y * z / r**5,
        -3 * x * z * z / r**5,
        -3 * y * z * z / r**5,
    ]


def point_x(x, y, z, nu):
    """The same by a unit force along x (Cerruti)."""
    r = sqrt(x * x + y * y + z * z)
    m, t = 1 - 2 * nu, r + z
    xx = x / r**3 - 3 * x / (r * t**2) + x**3 / (r**3 * t**2) + 2 * x**3 / (r**2 * t**3)
    yy = x / r**3 - x / (r * t**2) + x * y * y / (r**3 * t**2) + 2 * x * y * y / (r**2 * t**3)
    xy = -y / (r * t**2) + x * x * y / (r**3 * t**2) + 2 * x * x * y / (r**2 * t**3)
    return [
        -3 * x**3 / r**5 + m * xx,
        -3 * x * y * y / r**5 + m * yy,
        -3 * x * z * z / r**5,
        -3 * x * x * y / r**5 + m * xy,
        -3 * x * x * z / r**5,
        -3 * x * y * z / r**5,
    ]


SWAPPED = [1, 0, 2, 3, 5, 4]  # the components with x and y exchanged


def exchanged(function):
    """The stresses by q_y."""

    def by_y(x, y, z, nu):
        values = function(y, x, z, nu)
        return [values[k] for k in SWAPPED]

    return by_y


CORNERS = [corner_p, corner_x, exchanged(corner_x)]
FORCES = [point_p, point_x, exchanged(point_x)]


def edges(h, x):
    return x - h / mpf(2), x + h / mpf(2)


def closed(traction, sides, point, nu):
    """All components by one traction."""
    (x1, x2), (y1, y2), f = edges(sides[0], point[0]), edges(sides[1], point[1]), CORNERS[traction]
    corners = zip(*(f(x, y, point[2], nu) for x, y in ((x2, y2), (x1, y1), (x1, y2), (x2, y1))))
    return [(a + b - c - d) / (2 * pi) for a, b, c, d in corners]


def numerical(traction, component, sides, point, nu):
    (x1, x2), (y1, y2) = edges(sides[0], point[0]), edges(sides[1], point[1])
    return quad(lambda x, y: FORCES[traction](x, y, point[2], nu)[component], [x1, x2], [y1, y2]) / (2 * pi)


def check():
    """Closed forms against quadrature, to 15 digits."""
    for point in ((0.7, 1.3, 2.1), (-6.2, 3.1, 0.9), (40.5, -31.2, 12.0)):
        point = [mpf(x) for x in point]
        for traction in range(3):
            values = closed(traction, (1, 1), point, mpf("0.3"))
            for component, value in enumerate(values):
                with mp.workdps(20):
                    other = numerical(traction, component, (1, 1), point, mpf("0.3"))
                if abs(other - value) > mpf(10) ** -15 * max(abs(v) for v in values):
                    raise SystemExit(f"{COMPONENTS[component]} by {traction} at {point}: {value} but {other}")


def points():
    """Cells, Poisson's ratios and points: inside, near and far, at the surface and below it; exact in binary."""
    chance = random.Random(3)
    for k in range(120):
        sides = CELLS[k % len(CELLS)]
        distance = 2.0 ** chance.uniform(-3, 14)
        depth = 0.0 if k % 4 == 0 else 2.0 ** chance.uniform(-6, 14) if k % 4 == 1 else 2.0 ** chance.uniform(-3, 3)
        x, y = (distance * chance.uniform(-1, 1) for _ in range(2))
        yield sides, POISSON[k % 4 if k % 5 else 0], (x, y, depth)


def main():
    check()
    print("/* Written by scripts/maintain/stress_values.py: do not edit. A row a point, as in test_stress_cell.c. */")
    for sides, nu, point in points():
        values = [closed(t, sides, [mpf(x) for x in point], mpf(nu)) for t in range(3)]
        rows = (", ".join(nstr(values[t][c], 21, min_fixed=0, max_fixed=0) for t in range(3)) for c in range(6))
        place = ", ".join(repr(x) for x in point)
        print(f"{{{{{sides[0]}, {sides[1]}}}, {nu!r}, {{{place}}}, {{{', '.join(f'{{{r}}}' for r in rows)}}}}},")


if __name__ == "__main__":
    main()
