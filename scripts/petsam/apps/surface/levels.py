"""Mean, tilt and form taken off a map, by least squares of the heights; offsets of its rows or columns by medians."""

from dataclasses import replace

import numpy as np

from ...core.errors import Error
from ...core.units import shown

KINDS = ("none", "mean", "tilt", "second-order", "sphere", "cylinder", "rows", "columns")
TERMS = {
    "mean": ((0, 0),),
    "tilt": ((0, 0), (1, 0), (0, 1)),
    "second-order": ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)),
}  # powers of x and y
MOST = 1 << 18  # points that a sphere or a cylinder is fitted to: evenly chosen ones of a larger map


def _scaled(one):
    """Coordinates along x and y about the middle, over half the larger side; and that length (m)."""
    length = one.wide / 2
    return [(one.axis(d) - one.center[d]) / length for d in (0, 1)], length


def _polynomial(one, terms):
    """Coefficients of powers of the scaled coordinates, m.

    The normal equations are sums over rows and over columns, so that no matrix with a row a point is needed.
    """
    (u, v), _ = _scaled(one)
    base = np.mean(one.values)  # small numbers are rounded less
    highest = max(max(term) for term in terms)
    powers_u, powers_v = (np.array([axis**k for k in range(highest + 1)]) for axis in (u, v))
    sums_u, sums_v = (np.array([np.sum(axis**k) for k in range(2 * highest + 1)]) for axis in (u, v))
    moments = powers_v @ (one.values - base) @ powers_u.T
    gram = np.array([[sums_u[i + k] * sums_v[j + m] for k, m in terms] for i, j in terms])
    coefficients = np.linalg.lstsq(gram, np.array([moments[j, i] for i, j in terms]), rcond=1e-13)[0]
    coefficients[0] += base
    return coefficients


def _evaluated(one, terms, coefficients):
    (u, v), _ = _scaled(one)
    surface = np.zeros_like(one.values)
    for (i, j), c in zip(terms, coefficients):
        surface += c * np.outer(v**j, u**i)
    return surface


# ---------------------------------------------------------------- sphere and cylinder


def _normal(p, q):
    """Unit normal of the tangent plane of slopes p, q in the middle."""
    return np.array([-p, -q, 1.0]) / np.sqrt(1.0 + p * p + q * q)


def _root(a, b, c):
    """The root of a z^2 + b z + c, b < 0, that is -c/b for a small a."""
    return 2.0 * c / (-b + np.sqrt(np.maximum(b * b - 4.0 * a * c, 0.0)))


def sphere(parameters, x, y):
    """Heights of a sphere through (0, 0, z) with slopes p, q and the curvature c there; c > 0: a bowl."""
    z, p, q, c = parameters
    n = _normal(p, q)
    # c/2 |r|^2 = n r, for r from that point
    return z + _root(c / 2, -n[2], c / 2 * (x * x + y * y) - n[0] * x - n[1] * y)


def cylinder(parameters, x, y):
    """Heights of a cylinder likewise; its axis runs at the angle phi in the tangent plane, from about x to about y."""
    z, p, q, c, phi = parameters
    n = _normal(p, q)
    first = np.array([1.0, 0.0, p]) / np.sqrt(1.0 + p * p)
    axis = np.cos(phi) * first + np.sin(phi) * np.cross(n, first)
    # c/2 (|r|^2 - (axis r)^2) = n r
    s = axis[0] * x + axis[1] * y
    rest = c / 2 * (x * x + y * y - s * s) - n[0] * x - n[1] * y
    return z + _root(c / 2 * (1.0 - axis[2] ** 2), -n[2] - c * axis[2] * s, rest)


def _start(one, kind, length):
    """Parameters, over the length, from the polynomial of second order."""
    z, p, q, xx, xy, yy = _polynomial(one, TERMS["second-order"]) / length
    if kind == "sphere":
        return np.array([z, p, q, xx + yy])
    curvatures, directions = np.linalg.eigh([[2 * xx, xy], [xy, 2 * yy]])
    bent = int(np.argmax(np.abs(curvatures)))
    straight = directions[:, 1 - bent]
    return np.array([z, p, q, curvatures[bent], np.arctan2(straight[1], straight[0])])


def _fit(one, kind):
    """The fitted form (ny, nx), and its radius (m)."""
    from scipy.optimize import least_squares

    form = {"sphere": sphere, "cylinder": cylinder}[kind]
    (u, v), length = _scaled(one)
    stride = max(1, int(np.ceil(np.sqrt(one.values.size / MOST))))
    x, y = np.meshgrid(u[::stride], v[::stride])
    z = one.values[::stride, ::stride] / length
    scale = np.std(z) or 1.0
    start = _start(one, kind, length)
    if z.size < start.size:
        raise Error(f"{one.name}: --level {kind}: a map of {one.n[0]} x {one.n[1]} points is too small")
    found = least_squares(
        lambda parameters: ((form(parameters, x, y) - z) / scale).ravel(),
        start,
        x_scale=np.maximum(np.abs(start), scale),
        xtol=1e-15,
        ftol=1e-15,
        gtol=1e-15,
    )
    if not found.success or not np.all(np.isfinite(found.x)):
        raise Error(f"{one.name}: --level {kind}: no {kind} fits: {found.message}")
    x, y = np.meshgrid(u, v)
    curvature = found.x[3]
    return form(found.x, x, y) * length, length / abs(curvature) if curvature else np.inf


# ---------------------------------------------------------------- offsets of rows


def _offsets(values):
    """Offsets of the rows of a scanner, m, of mean 0 and without a tilt.

    Each row lies above the one before by the median of their differences, in which the surface hardly changes, and
    which a particle on a row does not move. The line through the sums is the surface's tilt, and stays.
    """
    if len(values) < 3:
        return np.zeros(len(values))
    sums = np.concatenate([[0.0], np.cumsum(np.median(np.diff(values, axis=0), axis=1))])
    numbers = np.arange(sums.size) - (sums.size - 1) / 2
    return sums - sums.mean() - numbers * (numbers @ sums) / (numbers @ numbers)


# ---------------------------------------------------------------- all


def _slopes(coefficients, length):
    return "slopes {:.3g} in x, {:.3g} in y".format(*(coefficients[1:3] / length))


def levelled(one, kind):
    """The map without mean, tilt or form, and the removed part in words ("" for nothing)."""
    if kind == "none":
        return one, ""
    if kind in TERMS:
        coefficients = _polynomial(one, TERMS[kind])
        surface, length = _evaluated(one, TERMS[kind], coefficients), _scaled(one)[1]
        removed = [f"mean {shown(coefficients[0])}"] if kind == "mean" else [_slopes(coefficients, length)]
        if kind == "second-order":
            xx, xy, yy = coefficients[3:] / length**2
            removed.append(f"curvatures {2 * xx:.4g} and {2 * yy:.4g} 1/m in x and y, twist {xy:.3g} 1/m")
        return replace(one, values=one.values - surface), f"{kind} removed: " + ", ".join(removed)
    if kind in ("rows", "columns"):
        offsets = _offsets(one.values if kind == "rows" else one.values.T)
        values = one.values - (offsets[:, None] if kind == "rows" else offsets)
        return replace(one, values=values), f"offsets of {kind} removed: {shown(float(np.std(offsets)))} rms"
    surface, radius = _fit(one, kind)
    return replace(one, values=one.values - surface), f"{kind} removed: radius {radius:.6g} m"


def tilt(one):
    """Slopes of the mean plane in x and y."""
    return tuple(_polynomial(one, TERMS["tilt"])[1:] / _scaled(one)[1])
