#!/usr/bin/env python3
"""Writes tests/unit/influence_values.txt: influence integrals to 50 digits and more, rounded to 21.

    python3 scripts/maintain/influence_values.py > tests/unit/influence_values.txt

Needs mpmath. The values are Love's closed forms (Love 1929; Johnson 1985, ch. 3) at 80 digits, of
which the corner sum loses at most 20. A few are checked against numerical quadrature first, which
shares nothing with the closed forms; the script fails where the two differ.
"""

from mpmath import asinh, atan, cos, log, mp, mpf, nstr, quad, sin, sqrt

mp.dps = 80

KINDS = ["R", "XX", "YY", "XY", "X", "Y"]

KERNELS = [
    lambda x, y: 1 / sqrt(x * x + y * y),
    lambda x, y: x * x / sqrt(x * x + y * y) ** 3,
    lambda x, y: y * y / sqrt(x * x + y * y) ** 3,
    lambda x, y: x * y / sqrt(x * x + y * y) ** 3,
    lambda x, y: x / (x * x + y * y),
    lambda x, y: y / (x * x + y * y),
]

# d2/dxdy of these are the kernels, up to terms that the corner sum removes.
ANTIDERIVATIVES = [
    lambda x, y: x * asinh(y / abs(x)) + y * asinh(x / abs(y)),
    lambda x, y: y * asinh(x / abs(y)),
    lambda x, y: x * asinh(y / abs(x)),
    lambda x, y: -sqrt(x * x + y * y),
    lambda x, y: y / 2 * log(x * x + y * y) + x * atan(y / x),
    lambda x, y: x / 2 * log(x * x + y * y) + y * atan(x / y),
]

# Sides, m: aspects 1, 3 and 1/40, all exact in binary.
CELLS = [(1, 1), (3, 1), (1, 40)]

# Near, on and beside the axes, where the number of points changes, and the far corners of a grid
# of 16384 cells a side.
LAGS = [
    (0, 0), (1, 0), (0, 1), (1, 1), (0, 2), (7, 3), (2, 31), (31, 1), (32, 0), (33, 2),
    (-64, 5), (100, 1), (0, 100), (1000, 999), (2100, -2100), (12000, 3), (3, 12000),
    (5000, 7000), (16383, 0), (0, 16383), (-1, -16383), (16383, 16383),
]  # fmt: skip

CHECKED_LAGS = [(1, 1), (7, 3), (0, 100), (3, 12000)]


def edges(h, lag):
    """The two ends of a cell's side."""
    return (lag - mpf(1) / 2) * h, (lag + mpf(1) / 2) * h


def closed(kind, dx, dy, i, j):
    """The integral over a cell by the antiderivative at its four corners."""
    if (KINDS[kind] in ("XY", "X") and i == 0) or (KINDS[kind] in ("XY", "Y") and j == 0):
        return mpf(0)
    f = ANTIDERIVATIVES[kind]
    (x1, x2), (y1, y2) = edges(dx, i), edges(dy, j)
    return f(x2, y2) - f(x1, y2) - f(x2, y1) + f(x1, y1)


def numerical(kind, dx, dy, i, j):
    """The integral over a cell off the origin by quadrature, in pieces that suit slender cells."""
    (x1, x2), (y1, y2) = edges(dx, i), edges(dy, j)
    pieces = [max(1, min(8, h // 5)) for h in (dx, dy)]
    xs = [x1 + (x2 - x1) * k / pieces[0] for k in range(pieces[0] + 1)]
    ys = [y1 + (y2 - y1) * k / pieces[1] for k in range(pieces[1] + 1)]
    return quad(KERNELS[kind], xs, ys)


def numerical_origin(kind, dx, dy):
    """The integral of an even kernel over the cell at the origin, in polar coordinates."""
    a, b = mpf(dx) / 2, mpf(dy) / 2
    angular = [lambda t: 1, lambda t: cos(t) ** 2, lambda t: sin(t) ** 2][kind]
    corner = atan(b / a)
    right = quad(lambda t: angular(t) * a / cos(t), [0, corner / 2, corner])
    top = quad(lambda t: angular(t) * b / sin(t), [corner, (corner + mp.pi / 2) / 2, mp.pi / 2])
    return 4 * (right + top)


def check():
    """Compares closed forms and quadrature at a few lags, to 25 digits."""
    for dx, dy in CELLS:
        pairs = [(closed(k, dx, dy, 0, 0), k, numerical_origin(k, dx, dy), (0, 0)) for k in range(3)]
        for i, j in CHECKED_LAGS:
            for kind in range(len(KINDS)):
                value = closed(kind, dx, dy, i, j)
                if value != 0:
                    with mp.workdps(32):
                        pairs.append((value, kind, numerical(kind, dx, dy, i, j), (i, j)))
        for value, kind, other, lag in pairs:
            if abs(other / value - 1) > mpf(10) ** -25:
                raise SystemExit(f"{KINDS[kind]} of {dx} x {dy} at {lag}: {value} but {other}")


def main():
    check()
    print("/* Written by scripts/maintain/influence_values.py: do not edit. A row a lag, as in test_influence.c. */")
    for dx, dy in CELLS:
        for i, j in LAGS:
            values = [closed(kind, dx, dy, i, j) for kind in range(len(KINDS))]
            digits = [nstr(v, 21, min_fixed=0, max_fixed=0) if v else "0.0" for v in values]
            print(f"{{{dx}, {dy}, {i}, {j}, {{{', '.join(digits)}}}}},")


if __name__ == "__main__":
    main()
