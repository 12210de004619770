"""The curve Q = F(D) of contact and rig, and the closed loop that follows from it: see problem.py."""

from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from .push import Push


class Backbone:
    """The monotonic curve Q = F(D) of contact and rig, odd in D: coefficient of friction, compliance of the rig (m/N),
    scale, the factor of the contact's compliance, and bend, the relative increase of its part that slip adds."""

    def __init__(self, push: Push, friction: float, compliance: float, scale: float = 1.0, bend: float = 0.0) -> None:
        self.force = friction * push.force
        self.slips = friction * scale * (push.displacement - push.force / push.stiffness)
        self.displacement = friction * scale * push.displacement + bend * self.slips + compliance * self.force
        self.friction, self.compliance, self.scale = friction, compliance, scale

    @cached_property
    def slope(self) -> np.ndarray:
        """dQ/dD at the points of the table, N/m."""
        return np.gradient(self.force, self.displacement)

    def __call__(self, displacement):
        """Force (N) at a displacement (m) from the unloaded state."""
        return np.sign(displacement) * np.interp(np.abs(displacement), self.displacement, self.force)

    def slope_at(self, displacement):
        """dQ/dD there, N/m; 0 where it slides."""
        return np.interp(np.abs(displacement), self.displacement, self.slope, right=0.0)

    def derivatives(self, displacement: ArrayLike) -> dict[str, np.ndarray]:
        """Derivatives of the force by displacement, friction, compliance, scale, and bend, at displacements (m): those
        of the straight lines between the points of the table.

        With D = friction scale (f + bend (f - f' q)) + compliance Q, f' the slope at 0, and Q = friction q, at given D:
        dQ/dp = Q_p - dQ/dD D_p.
        """
        force, length = self(displacement), np.abs(displacement)
        before = np.clip(np.searchsorted(self.displacement, length) - 1, 0, len(self.force) - 2)
        slope = (np.diff(self.force) / np.diff(self.displacement))[before]
        slope = np.where(length < self.displacement[-1], slope, 0.0)
        return {
            "displacement": slope,
            "friction": (force - slope * displacement) / self.friction,
            "compliance": -slope * force,
            "scale": -slope * (displacement - self.compliance * force) / self.scale,
            "bend": -slope * np.sign(displacement) * np.interp(length, self.displacement, self.slips),
        }


def force_of(
    backbone: Backbone,
    displacement: np.ndarray,
    rising: np.ndarray,
    own: tuple[float, float, float] = (0.0, 1.0, -1.0),
    lean: float = 0.0,
    loss: float = 0.0,
) -> tuple[np.ndarray, np.ndarray]:
    """Force and its slope over the displacement of a closed loop, N and N/m; `own` are its offset of the force, largest
    and smallest displacement."""
    force = plain_force(backbone, displacement, rising, own, lean, loss)
    _, top, bottom = own
    return force, backbone.slope_at(np.where(rising, displacement - bottom, top - displacement) / 2.0) + lean


def plain_force(backbone, displacement, rising, own, lean, loss):
    """Force of a closed loop, N."""
    offset, top, bottom = own
    half, middle = 0.5 * (top - bottom), 0.5 * (top + bottom)
    most = backbone(half)
    way = np.where(rising, displacement - bottom, top - displacement) / 2.0
    sign = np.where(rising, 1.0, -1.0)
    force = offset - sign * most + 2.0 * sign * backbone(way) + lean * (displacement - middle)
    return force + sign * loss * most * _ellipse(displacement) if loss else force


def _ellipse(displacement):
    """Height of the ellipse of a loss, 1. It spans the given points: by top and bottom it would hold these, by its
    ends' infinite slopes."""
    ends = displacement.max(), displacement.min()
    phase = (displacement - 0.5 * sum(ends)) / max(0.5 * (ends[0] - ends[1]), 1e-300)
    return np.sqrt(np.clip(1.0 - phase**2, 0.0, None))


def derivatives(backbone, displacement, rising, own, lean, loss):
    """Derivatives of the force of a closed loop: {name: (n,)} by shared parameters, and (n, 3) by its own."""
    _, top, bottom = own
    way = np.where(rising, displacement - bottom, top - displacement) / 2.0
    sign, ellipse = np.where(rising, 1.0, -1.0), _ellipse(displacement)
    most, along = backbone.derivatives(0.5 * (top - bottom)), backbone.derivatives(way)
    lag = sign * (loss * ellipse - 1.0)  # by the force of the reversal
    shared = {name: lag * most[name] + 2.0 * sign * along[name] for name in ("friction", "compliance", "scale", "bend")}
    shared["lean"] = displacement - 0.5 * (top + bottom)
    shared["loss"] = sign * ellipse * backbone(0.5 * (top - bottom))
    by_half, by_way = 0.5 * lag * most["displacement"], along["displacement"]
    by_top = by_half - np.where(rising, 0.0, by_way) - 0.5 * lean
    by_bottom = -by_half - np.where(rising, by_way, 0.0) - 0.5 * lean
    return shared, np.array([np.ones(len(way)), by_top, by_bottom]).T
