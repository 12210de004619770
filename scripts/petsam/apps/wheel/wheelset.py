"""Wheels in their places on the axle, and the functions that are 0 on their surfaces.

The wheel's radius is r(y) = radius + z(y), y along the axle from the wheelset's middle.
"""

import warnings
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Optional

import numpy as np

from ...core.brief import brief
from ...core.errors import Error, Unusable
from .checks import GAUGES, need, need_kind
from .profile import Profile, ProfileWarning
from .section import FLANGE, STEEPEST, STEP, Section, fine, path, visible

TIP = (0.0, 0.05)  # m from a flange's back to its tip
USUAL = (0.008, 0.025)  # m: the same of most flanges
BESIDE = 2e-3  # m from the flange's back in a profile to the one that is stated
TAPE = 0.07  # m from the flange's back to the tape circle
FAR = 0.01  # m: no tread, new or worn, is farther from the nominal radius there


def _need_back(profile, section, position):
    """Raises Unusable for a wheel whose flange is not beside the back that is stated."""
    low = int(np.argmax(section.z))
    tip = float(section.y[low])
    if section.z[low] - np.median(section.z) < FLANGE or TIP[0] < tip - position < TIP[1]:
        return
    cure = "give flange_position, y of the flange's back in the profile"
    for back, name in ((0.0, "0mm: y counts from the back"), (-0.07, "-70mm, as of S1002")):
        if USUAL[0] < tip - back < USUAL[1]:
            cure = f"give flange_position {name}"
    raise Unusable(
        f"flange_position {position:g}: {profile.name}: the flange's tip is at y = {1e3 * tip:.4g} mm of the profile, "
        f"{1e3 * (tip - position):.4g} mm beside this back, usually 8 to 25 mm: {cure}"
    )


def _doubt_back(profile, position):
    """Warns of a wheel whose profile goes round its flange to a back at another y than is stated."""
    curve = path(profile)
    s = fine(curve)
    k = int(np.argmin(curve(s)[:, 0]))
    along, down = curve(s[k], 1)
    back = float(curve(s[k])[0])
    if abs(down) > STEEPEST * abs(along) and abs(back - position) > BESIDE:
        warnings.warn(
            f"{profile.name}: the flange's back is at y = {1e3 * back:.4g} mm of the profile, and flange_position is "
            f"{1e3 * position:.4g} mm: give flange_position {1e3 * back:.4g}mm, unless the flange's back is elsewhere",
            ProfileWarning,
            stacklevel=4,
        )


def _doubt_height(profile, section, position):
    """Warns of a wheel whose tread is far from z = 0 of the profile, where its radius counts."""
    tape = position + TAPE
    z = float(section.height(np.array(tape)))
    if section.first <= tape <= section.last and abs(z) > FAR:
        warnings.warn(
            f"{profile.name}: its z is {1e3 * z:.4g} mm at the tape circle, y = {1e3 * tape:.4g} mm, and the radius "
            "counts at z = 0: give tape_line, y where the radius is the nominal one, or shift the profile's z to 0 "
            "there",
            ProfileWarning,
            stacklevel=4,
        )


@brief
@dataclass(frozen=True, eq=False)
class Wheelset:
    """A wheel of a wheelset; that of the right side, whose mirror image the left one is.

    Parameters
    ----------
    profile : Profile
        Of a wheel.
    radius : float
        Nominal radius, m, at z = 0 of the profile, or at the tape line.
    flange_back : float
        Distance of the backs of both flanges, m.
    flange_position : float
        y of the flange's back in the profile, m: -0.07 of S1002.
    tape_line : float, optional
        y of the tape line in the profile, m, where the radius is the nominal one.
    excess : float
        m by which the wheel is larger than this radius there, as the left one of a wheelset with two radii.

    Raises
    ------
    Error
        If a number is not of this quantity in this unit, the flange's tip is far from its back, or the profile cannot
        be seen from a rail: one with its flange on the field side, or pointing up.

    Notes
    -----
    A ProfileWarning is issued of a profile that goes round its flange to a back at another y, and, without a tape line,
    of one whose z is beyond 10 mm at the tape circle, 70 mm from the flange's back.
    """

    profile: Profile
    radius: float
    flange_back: float = 1.36
    flange_position: float = -0.07
    tape_line: Optional[float] = None
    excess: float = 0.0

    def __post_init__(self) -> None:
        need_kind(self.profile, "wheel", "Wheelset")
        need(self.radius, "radius", 0.01, 5.0, "expected the wheel's nominal radius, m, such as 0.46")
        need(self.flange_back, "flange_back", 0.0, GAUGES[1], "expected the distance of the flanges' backs, m, as 1.36")
        need(self.flange_position, "flange_position", -1.0, 1.0, "expected y of the flange's back in the profile, m")
        section = visible(self.profile)
        _need_back(self.profile, section, self.flange_position)
        _doubt_back(self.profile, self.flange_position)
        if self.tape_line is None:
            _doubt_height(self.profile, section, self.flange_position)
        elif not section.first <= self.tape_line <= section.last:
            raise Error(f"tape_line {self.tape_line:g}: the profile is from {section.first:g} to {section.last:g} m")
        if not 0.5 * self.radius < self.section.z.min() + self.radius:
            raise Error(f"radius {self.radius:g}: the profile is too deep for it: check the units of both")

    @cached_property
    def section(self) -> Section:
        """The visible part: z, 0 at the nominal radius, over y along the axle from the wheelset's middle."""
        section = visible(self.profile)
        down = 0.0 if self.tape_line is None else float(section.height(np.array(self.tape_line)))
        return section.moved(self.offset, self.excess - down)

    @cached_property
    def line(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """y, z and slope of points of the visible part in small steps, m and 1, (n,) each."""
        section = self.section
        y = np.linspace(section.first, section.last, int(np.ceil((section.last - section.first) / STEP)) + 1)
        return y, section.height(y), section.slope(y)

    def of_radius(self, radius: float) -> "Wheelset":
        """The same wheel with another nominal radius to count from: that of the other wheel of its wheelset.

        Parameters
        ----------
        radius : float
            m.

        Returns
        -------
        Wheelset
        """
        return (
            self if radius == self.radius else replace(self, radius=radius, excess=self.radius - radius + self.excess)
        )

    @property
    def offset(self) -> float:
        """y of the profile's origin along the axle, m."""
        return 0.5 * self.flange_back - self.flange_position

    def level(self, points: np.ndarray, direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """A function that is 0 on the surface and grows out of the body, and its derivative along a direction.

        Parameters
        ----------
        points : ndarray
            In the wheelset's axes, (3, ...), m.
        direction : ndarray
            Unit vector in the same axes, (3,).

        Returns
        -------
        level, derivative : ndarray
            m, and 1.
        """
        x, y, z = points
        distance = np.sqrt(x * x + z * z)
        toward = (x * direction[0] + z * direction[2]) / distance
        height, slope = self.section.height_and_slope(y)
        return distance - self.radius - height, toward - slope * direction[1]
