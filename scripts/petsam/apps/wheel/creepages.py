"""Creepages of a patch: the velocities of rail and wheel at its reference point, in vectors, without small angles.

Each body's velocity is that of its own undeformed surface: of the rail or roller at the patch's origin, of the wheel at
the point below it by the approach. A body of revolution then rolls with its own radius, whatever the approach: the
elastic displacements that take part in the slip are those from its undeformed shape.
"""

from typing import NamedTuple, Union

import numpy as np

from ...core.errors import Error
from .patches import Place
from .pose import Frame, Position
from .rails import Roller, Track


class Creepages(NamedTuple):
    """Creepages of the rail relative to the wheel, along the patch's axes x and s, spin about its normal (1/m), and the
    rolling speed that they are relative to, m/s. `pitch` is the velocity of the wheel along both axes, m, and its rate
    about the normal, 1, of a unit pitch rate: products with the forces and the moment on the wheel are their torque
    about the axle."""

    x: float
    s: float
    spin: float
    speed: float
    pitch: tuple[float, float, float]


def creepages(
    rail: Union[Track, Roller], frame: Frame, pitch: float, position: Position, place: Place, approach: float
) -> Creepages:
    """The creepages of a patch, of a wheelset with its pitch rate (rad/s) and speeds, under an approach along the
    normal (m). Raises Error if nothing moves along the rail: creepages are relative to the rolling speed."""
    point = place.origin + approach * place.axes[2]
    arm = point - frame.centre
    rates = frame.rotation @ np.array([position.roll_rate, pitch, position.yaw_rate])
    wheel = np.array([position.speed, position.vy, position.vz]) + _cross(rates, arm)
    ground, ground_rates = rail.velocity(place.origin, position)
    axle = frame.rotation[:, 1]
    rolled = _cross(axle, arm)
    if np.isfinite(rail.roller_radius):
        speed = 0.5 * abs(ground[0] + wheel[0])
    else:
        turned = pitch * rolled[0]
        speed = 0.5 * (abs(wheel[0] - ground[0] - turned) + abs(turned))
    if not speed > 0.0:
        raise Error("speed 0 and pitch_rate 0: creepages are relative to the rolling speed: give speed above 0")
    x, s, _ = place.axes @ (ground - wheel) / speed
    spin = float((ground_rates - rates) @ place.axes[2] / speed)
    along, across, _ = map(float, place.axes @ rolled)
    return Creepages(float(x), float(s), spin, float(speed), (along, across, float(axle @ place.axes[2])))


def _cross(a, b):
    """The cross product of two vectors; numpy's takes its time for any shape."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
