"""Derailment of a wheelset in equilibrium: contacts beyond the flange's steepest place, and Y/Q beside Nadal's limit.

A wheel whose contact has passed the steepest place of its flange, towards its tip, climbs on under any lateral force
that holds it there. Nadal's limit (tan d - mu)/(1 + mu tan d) is the ratio Y/Q of lateral and vertical force of a
wheel that slips down its rail on a face of the inclination d: above the one of the steepest place it may climb.
"""

import math
from dataclasses import dataclass
from typing import Optional

import numpy as np

from .result import Result
from .section import FLANGE, STEEP, STEP
from .wheelset import Wheelset

PLANE = 0.01  # rad below the steepest angle that still count as the steepest place
ABOVE = 2e-3  # m: the flange's face ends so near to the height of the tread
SCRATCH = 1e-3  # m along the face: scratches narrower than half of it do not count
STATES = ("on rail", "may climb", "derailed")


def nadal(angle: float, friction: float) -> float:
    """Nadal's limit of Y/Q by the contact's inclination, rad, positive; negative below the angle of friction."""
    slope = math.tan(angle)
    return (slope - friction) / (1.0 + friction * slope)


@dataclass(frozen=True)
class Flange:
    """The steepest place of a flange, on the side of the tread: y of the profile, m, of a plane face its end towards
    the tip, and its angle, rad."""

    y: float
    angle: float


def flange(wheel: Wheelset) -> Optional[Flange]:
    """The steepest place of a wheel's flange; None of a wheel without one."""
    y, z, slope = wheel.line
    tip = int(np.argmax(z))
    tread = float(np.median(z[tip:]))
    if z[tip] - tread < FLANGE:
        return None
    end = tip + int(np.argmax(z[tip:] < tread + ABOVE))
    places, angles = _face(y[tip:end], z[tip:end], slope[tip:end])
    if angles.max() < math.atan(STEEP):
        return None
    first = int(np.flatnonzero(angles >= angles.max() - PLANE)[0])
    return Flange(float(places[first]) - wheel.offset, float(angles.max()))


def _face(y, z, slope):
    """Places y and angles of a flange's face in equal steps along it, without scratches: medians over a short way."""
    way = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(y), np.diff(z)))])
    even = np.linspace(0.0, way[-1], int(np.ceil(way[-1] / STEP)) + 1)
    half = int(round(0.5 * SCRATCH / STEP))
    angles = np.pad(np.interp(even, way, np.arctan(-slope)), half, mode="edge")
    return np.interp(even, way, y), np.median(np.lib.stride_tricks.sliding_window_view(angles, 2 * half + 1), axis=1)


@dataclass(frozen=True)
class Climb:
    """How near a wheel is to derailment, right or left: Y/Q, the lateral (positive outwards) over the vertical force on
    the rail; Nadal's limit at the flange's steepest place, NaN without a flange; inclination of the contact nearest to
    the flange's tip, rad, positive on the flange, or of the flange's steepest place where this contact is not beyond
    it; one of STATES; and that contact's friction."""

    side: str
    ratio: float
    limit: float
    angle: float
    state: str
    friction: float

    @property
    def text(self) -> str:
        """A line about a wheel that may climb or is derailed; empty of one that stays on its rail."""
        if self.state == STATES[0]:
            return ""
        limit = nadal(self.angle, self.friction)
        if self.state == STATES[1]:
            why = f"Y/Q {self.ratio:.3f} is above Nadal's limit {limit:.3f} of the flange's {self.angle:.4f} rad"
        else:
            why = (
                f"its contact is beyond the flange's steepest place, towards the tip, at an angle of {self.angle:.4f} "
                f"rad: Y/Q {self.ratio:.3f}, Nadal's limit there {limit:.3f}"
            )
        return f"{self.side} wheel {self.state}: {why}"


def climb(result: Result, wheel: Wheelset) -> Climb:
    """How near a wheel (as a right one) is to derailment, by its solution in the track's axes."""
    sign = 1.0 if result.side == "right" else -1.0
    force, face = result.force, flange(wheel)
    ratio = float(sign * force[1] / force[2]) if force[2] > 0.0 else math.nan
    if face is None or not result.patches:
        return Climb(result.side, ratio, math.nan, math.nan, STATES[0], 0.0)
    patch = min(result.patches, key=_place)
    limit = nadal(face.angle, patch.friction)
    if _place(patch) < face.y:
        return Climb(result.side, ratio, limit, -sign * patch.angle, STATES[2], patch.friction)
    state = STATES[1] if ratio > limit else STATES[0]
    return Climb(result.side, ratio, limit, face.angle, state, patch.friction)


def _place(patch):
    """y of the wheel's profile at the centre of pressure of a patch, m."""
    return float(np.average(patch.wheel_y, weights=patch.pressure.sum(axis=1)))
