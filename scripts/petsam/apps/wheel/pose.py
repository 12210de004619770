"""Position and speeds of a wheelset on its track, and its rotation.

R = R_x(roll) R_z(yaw): first roll about x, then yaw about the turned z; pitch is about the axle. A point q of the
wheelset is at R q + (0, y, z - radius) in the track. A wheel that rolls forward has a negative pitch rate.
"""

import warnings
from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from ...core.brief import brief
from ...core.errors import Unusable
from .profile import ProfileWarning

YAW = (0.1, 0.6)  # rad: yaws above the first are doubtful, above the second refused
ROLL = 0.2  # rad
ASIDE = 0.2  # m: of the wheelset


@dataclass(frozen=True)
class Position:
    """Position and speeds of a wheelset.

    Parameters
    ----------
    y : float
        Lateral displacement, m, positive to the right.
    z : float, optional
        Vertical displacement, m, positive down, 0 at the nominal height; None: by the vertical force.
    roll, yaw : float
        Rotations about x and about the turned z, rad.
    speed : float
        Forward speed, m/s; 0 on rollers.
    pitch_rate : float, optional
        Rate of rotation about the axle, rad/s, negative forward; None: that of an Axle is found, and one wheel has the
        speed over its nominal radius, on rollers none.
    vy, vz : float
        Lateral and vertical velocity, m/s.
    roll_rate, yaw_rate : float
        rad/s.
    roller_rate : float
        Rate of rotation of the rollers, rad/s, positive where the wheel rolls towards +x.

    Raises
    ------
    Error
        If a number is not finite, an angle is no angle in rad, the displacement is no displacement in m, or the wheel
        rolls backwards.

    Notes
    -----
    A ProfileWarning is issued of a yaw that may be one in degrees.
    """

    y: float = 0.0
    z: Optional[float] = None
    roll: float = 0.0
    yaw: float = 0.0
    speed: float = 0.0
    pitch_rate: Optional[float] = None
    vy: float = 0.0
    vz: float = 0.0
    roll_rate: float = 0.0
    yaw_rate: float = 0.0
    roller_rate: float = 0.0

    def __post_init__(self) -> None:
        given = [value for value in vars(self).values() if value is not None]
        if not np.isfinite(np.array(given, dtype=float)).all():
            raise Unusable("Position: expected finite numbers")
        for name, most in (("roll", ROLL), ("yaw", YAW[1])):
            if abs(getattr(self, name)) > most:
                raise Unusable(f"{name} {getattr(self, name):g}: expected rad, up to {most:g}")
        if abs(self.yaw) > YAW[0]:
            degrees = np.degrees(self.yaw)
            warnings.warn(f"yaw {self.yaw:g} rad is {degrees:.3g} degrees", ProfileWarning, stacklevel=3)
        for name, value in (("y", self.y), ("z", self.z or 0.0)):
            if abs(value) > ASIDE:
                raise Unusable(f"{name} {value:g}: expected a displacement in m, up to {ASIDE:g}")
        if self.speed < 0.0 or self.roller_rate < 0.0:
            raise Unusable(
                "speed, roller_rate: below 0: only rolling towards +x is solved; turn the track by 180 degrees"
            )
        if (self.pitch_rate or 0.0) > 0.0:
            raise Unusable(f"pitch_rate {self.pitch_rate:g}: a wheel that rolls forward has a negative one")

    def mirrored(self) -> "Position":
        """The position as seen in a mirror in the plane y = 0.

        Returns
        -------
        Position
        """
        other = dict(y=-self.y, roll=-self.roll, yaw=-self.yaw, vy=-self.vy)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ProfileWarning)  # it was issued of this position
            return replace(self, **other, roll_rate=-self.roll_rate, yaw_rate=-self.yaw_rate)

    @property
    def rotation(self) -> np.ndarray:
        """R, (3, 3)."""
        cr, sr, cy, sy = np.cos(self.roll), np.sin(self.roll), np.cos(self.yaw), np.sin(self.yaw)
        roll = np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])
        yaw = np.array([[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]])
        return roll @ yaw

    def pitch(self, radius: float) -> float:
        """The pitch rate of a wheel of this nominal radius.

        Parameters
        ----------
        radius : float
            m.

        Returns
        -------
        float
            rad/s.
        """
        return -self.speed / radius if self.pitch_rate is None else self.pitch_rate


@brief
@dataclass(frozen=True, eq=False)
class Frame:
    """Place of the wheelset's axes in the track: rotation, (3, 3), and centre, (3,), m."""

    rotation: np.ndarray
    centre: np.ndarray

    def inward(self, points: np.ndarray) -> np.ndarray:
        """Points of the track in the wheelset's axes, (3, ...), m."""
        centre = self.centre.reshape(3, *[1] * (points.ndim - 1))
        return np.tensordot(self.rotation.T, points - centre, axes=1)
