"""Where the wheels of a position touch their rails, and how far these points are from the axle."""

from __future__ import annotations

import numpy as np


def place(case):
    """y of the point that touches, of a right wheel."""
    return float(case.search.y[int(np.argmin(case.search.gap))])


def distance(rotation, arm):
    """Distance of a point from the axle, m."""
    x, _, z = rotation.T @ arm
    return float(np.hypot(x, z))
