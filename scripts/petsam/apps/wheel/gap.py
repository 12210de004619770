"""The separation of the undeformed bodies along the normal of a patch, at the centres of its cells.

Each surface is where a level function is 0; Newton's iteration along the normal finds it for all cells at once. It has
the whole geometry: no curvatures, no parabola.
"""

from typing import Union

import numpy as np

from .patches import Place
from .pose import Frame
from .rails import Roller, Track
from .wheelset import Wheelset

PASSES = 12  # of Newton's iteration
LAST = 1e-9  # m: after a step up to it the next one is rounding, at curvatures up to 1e5/m
FLAT = 0.05  # of the derivative along the normal, at least
FAR = 1e-3  # m: the gap beyond the ends of the profiles, above that of all other cells


def separation(
    rail: Union[Track, Roller], wheel: Wheelset, frame: Frame, place: Place, x: np.ndarray, s: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """n of the rail less n of the wheel at places x (nx,) and s (ns,) of a patch, m, negative where they overlap, and y
    of the rail there, (ns, nx), m each; beyond the ends of the visible profiles the separation is large."""
    axes = place.axes
    along, across = np.meshgrid(x, s)
    points = place.origin[:, None, None] + axes[0][:, None, None] * along + axes[1][:, None, None] * across
    inner = frame.inward(points)
    normal = frame.rotation.T @ axes[2]
    # a rail is the same at all x: one column of cells has its ways
    on_rail = _way(rail, points[:, :, :1] if np.isinf(rail.roller_radius) else points, axes[2])
    on_wheel = _way(wheel, inner, normal)
    y = points[1] + on_rail * axes[2, 1]
    axle = inner[1] + on_wheel * normal[1]
    seen = _within(rail.section, y) & _within(wheel.section, axle)
    found = on_rail - on_wheel
    return np.where(seen, found, max(np.max(found[seen], initial=0.0), 0.0) + FAR), np.broadcast_to(y, found.shape)


def _within(section, y):
    return (y >= section.first) & (y <= section.last)


def _way(body, points, normal):
    """The way from points along the normal to the surface of a body."""
    way = np.zeros(points.shape[1:])
    direction = normal.reshape(3, 1, 1)
    for _ in range(PASSES):
        level, derivative = body.level(points + way * direction, normal)
        if np.abs(derivative).min() < FLAT:
            derivative = np.where(np.abs(derivative) < FLAT, np.copysign(FLAT, derivative), derivative)
        step = level / derivative
        way -= step
        if np.abs(step).max() < LAST:
            break
    return way
