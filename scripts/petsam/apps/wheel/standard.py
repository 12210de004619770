"""Profiles by the formulas of their standards: the wheel S1002 and the head of the rail UIC60 (60E1).

References: UIC 510-2, Trailing stock: wheels and wheelsets, appendix (S1002: two polynomials, arcs and lines of the
tread and the flange, in mm); UIC 861-3 and EN 13674-1 (60E1: arcs of radius 300, 80 and 13 mm and a line of 1:20).
"""

import numpy as np

from .profile import Profile

STEP = 0.1  # mm: of the points along y
# S1002: limits of the zones H to A along y, mm
LIMITS = (-70.0, -62.764705882, -49.662510381, -39.764473993, -38.426669071, -35.0, -26.0, 32.15796, 60.0)
# arcs of the zones H, G, F (convex) and D (concave): height and place of the centre, radius
ARCS = {"H": (9.519259302, -49.5, 20.5), "G": (16.0, -55.0, 12.0), "F": (8.834924130, -58.558326413, 20.0),
        "D": (16.446, -26.210665, 13.0)}  # fmt: skip
# lines of the zones E and A, polynomials of the zones C and B: coefficients in growing powers
LINES = {
    "E": (-93.576667419, -2.747477419),
    "C": (-4.320221063e3, -1.038384026e3, -1.065501873e2, -6.051367875, -2.054332446e-1, -4.169739389e-3,
          -4.687195829e-5, -2.252755540e-7),
    "B": (0.0, -3.358537058e-2, 1.565681624e-3, -2.810427944e-5, 5.844240864e-8, -1.562379023e-8, 5.309217349e-15,
          -5.957839843e-12, 2.646656573e-13),
    "A": (1.364323640, -0.066666667),
}  # fmt: skip
# UIC60: half widths, mm, at which the arcs of these radii end, and the slope of the line after them (dz/dy)
ENDS, RADII, SIDE, DEPTH = (10.228, 26.0265, 36.0), (300.0, 80.0, 13.0), 20.0, 40.0


def _s1002(y):
    """z of S1002 at y, mm."""
    z = np.empty_like(y)
    zones = np.clip(np.searchsorted(LIMITS, y, side="right") - 1, 0, 7)
    for k, name in enumerate("HGFEDCBA"):
        here = zones == k
        if name in LINES:
            z[here] = np.polynomial.polynomial.polyval(y[here], LINES[name])
        else:
            height, centre, radius = ARCS[name]
            rise = np.sqrt(np.maximum(radius**2 - (y[here] - centre) ** 2, 0.0))
            z[here] = height - rise if name == "D" else height + rise
    return z


def s1002() -> Profile:
    """The wheel profile S1002 of UIC 510-2, for wheels of 760 to 1000 mm.

    Returns
    -------
    Profile
        The flange's back is at y = -70 mm, the nominal radius at y = 0.
    """
    count = int(round((LIMITS[-1] - LIMITS[0]) / STEP))
    arc = np.linspace(0.5 * np.pi, 0.0, 200)[:-1]  # the back of the flange, which grows vertical, by its angle
    height, centre, radius = ARCS["H"]
    back = np.column_stack([centre - radius * np.sin(arc), height + radius * np.cos(arc)])
    back = back[back[:, 0] < LIMITS[1]]
    y = np.linspace(LIMITS[0], LIMITS[-1], count + 1)
    y = y[y > back[-1, 0] + 0.2 * STEP]
    points = np.vstack([back, np.column_stack([y, _s1002(y)])])
    return Profile(1e-3 * points[:, 0], 1e-3 * points[:, 1], "wheel", name="S1002")


def uic60() -> Profile:
    """The head of the rail UIC60 (60E1), upright: give the cant to Track.

    Returns
    -------
    Profile
        Its middle is y = 0, its top z = 0.
    """
    y, z = [], []
    centre, start = np.array([0.0, RADII[0]]), 0.0
    for k, (end, radius) in enumerate(zip(ENDS, RADII)):
        if k:  # the arcs touch each other: the centre lies on the last radius
            centre = centre + (RADII[k - 1] - radius) * np.array([np.sin(start), -np.cos(start)])
        last = 0.5 * np.pi - np.arctan(1.0 / SIDE) if k == 2 else np.arcsin((end - centre[0]) / radius)
        count = max(int(round(radius * (last - start) / STEP)), 1)
        angles = np.linspace(start, last, count + 1)[1:]
        y.append(centre[0] + radius * np.sin(angles))
        z.append(centre[1] - radius * np.cos(angles))
        start = last
    y, z = np.concatenate(y), np.concatenate(z)
    down = np.arange(z[-1] + STEP, DEPTH, STEP)
    y, z = np.append(y, y[-1] + (down - z[-1]) / SIDE), np.append(z, down)
    return Profile(
        1e-3 * np.concatenate([-y[::-1], [0.0], y]), 1e-3 * np.concatenate([z[::-1], [0.0], z]), "rail", name="UIC60"
    )
