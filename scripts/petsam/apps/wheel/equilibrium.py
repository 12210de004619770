"""Forces on a wheelset, and the equilibrium under them with the solutions of both wheels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Optional

import numpy as np

from ...core import tables
from ...core.brief import brief
from ...core.errors import Unusable
from . import derailing
from .pose import Position
from .result import COLUMNS, Result

# columns of both wheels: name, attribute of Climb, unit, meaning
CLIMBS = (
    ("state", "state", "", "on rail, may climb, or derailed"),
    ("y_over_q", "ratio", "1", "lateral over vertical force of the wheel, positive outwards"),
    ("nadal", "limit", "1", "Nadal's limit of it at the flange's steepest place"),
)


@dataclass(frozen=True)
class Load:
    """Forces on a wheelset.

    Parameters
    ----------
    vertical : float
        Axle load with the wheelset's weight, N, downwards.
    offset : float
        y of its line from the wheelset's middle, m, positive to the right.
    lateral : float, optional
        Lateral force, N, positive to the right; None: the one that holds the wheelset in its position.
    height : float
        z of the lateral force's line below the axle, m, negative above it.
    right : float, optional
        Vertical force on the right rail, N, from a simulation of the vehicle: instead of the balance of moments.

    Raises
    ------
    Error
        If a number is none of this quantity.
    """

    vertical: float
    offset: float = 0.0
    lateral: Optional[float] = None
    height: float = 0.0
    right: Optional[float] = None

    def __post_init__(self) -> None:
        if not 0.0 < self.vertical < math.inf:
            raise Unusable(f"load {self.vertical:g}: expected an axle load above 0, N")
        if not math.isfinite(self.lateral or 0.0):
            raise Unusable(f"lateral {self.lateral:g}: expected a force, N")
        for name, most in (("offset", 2.0), ("height", 5.0)):
            value = getattr(self, name)
            if not abs(value) < most:
                raise Unusable(f"{name} {value:g}: expected a distance from the axle's middle, m, below {most:g}")
        if self.right is not None and not 0.0 < self.right < self.vertical:
            raise Unusable(f"right {self.right:g}: expected a vertical force above 0 and below the axle load, N")


@brief
@dataclass(frozen=True, eq=False)
class Equilibrium(tables.Tabled):
    """A wheelset in equilibrium on its rails.

    Attributes
    ----------
    position : Position
        With the roll, height, lateral displacement and pitch rate that were found.
    load : Load
        The forces.
    right, left : Result
        The solutions at both wheels, each in the track's axes.
    lateral : float
        Lateral force on the wheelset, N, positive to the right.
    force_error, moment_error : float
        What is left of the vertical forces over the axle load, and of the moments about x over the axle load times half
        the distance of the contacts.
    radii : tuple of float
        Rolling radii of the right and the left wheel, m: distances of their normal forces from the axle.
    passes : int
        Solutions of both wheels that it took, without drafts.
    climbs : tuple of derailing.Climb
        How near the right and the left wheel are to derailment.
    slopes : ndarray
        Derivative of what is left, the torque about the axle included, by the logarithms of the overlaps of both wheels
        and by the pitch rate, (3, 3), approximate: a neighbour's iteration begins with it.
    correction : ndarray
        By how much these three numbers differ from those of a draft, (3,): a neighbour's iteration begins with it, too.
    """

    position: Position
    load: Load
    right: Result
    left: Result
    lateral: float
    force_error: float
    moment_error: float
    radii: tuple[float, float]
    passes: int
    climbs: tuple[derailing.Climb, derailing.Climb]
    slopes: Optional[np.ndarray] = None
    correction: Optional[np.ndarray] = None

    @property
    def radius_difference(self) -> float:
        """Rolling radius of the right wheel less that of the left one, m."""
        return self.radii[0] - self.radii[1]

    @property
    def derailed(self) -> bool:
        """True where the contact of a wheel is beyond its flange's steepest place."""
        return any(one.state == derailing.STATES[2] for one in self.climbs)

    @property
    def wheels(self) -> tuple[Result, Result]:
        """The right and the left solution."""
        return self.right, self.left

    @property
    def torque(self) -> float:
        """Torque of the tangential forces on both wheels about the axle, N m: 0 of a wheelset that rolls freely."""
        return sum(found.torque for found in self.wheels)

    @property
    def t_gamma(self) -> float:
        """Frictional work of all patches per distance rolled, N."""
        return float(sum(patch.t_gamma for found in self.wheels for patch in found.patches))

    def table(self) -> list[tables.Column]:
        """The numbers of the patches, right wheel first, with forces on the rail in the track.

        Returns
        -------
        list of Column
            A row for each patch; see also to_csv() and to_dataframe().
        """
        rows = [(found, patch) for found in self.wheels for patch in found.patches]
        count = len(rows)
        common = (
            ("ws_y", "m", "lateral displacement", self.position.y), ("ws_z", "m", "height", self.position.z),
            ("ws_roll", "rad", "roll", self.position.roll), ("ws_yaw", "rad", "yaw", self.position.yaw),
            ("ws_load", "N", "axle load", self.load.vertical), ("ws_lateral", "N", "lateral force", self.lateral),
            ("radius_difference", "m", "rolling radius of the right wheel less the left", self.radius_difference),
            ("force_error", "1", "what is left of the vertical forces over the axle load", self.force_error),
            ("moment_error", "1", "what is left of the moments over the axle load times its arm", self.moment_error),
        )  # fmt: skip
        columns = [tables.Column(name, unit, text, [value] * count) for name, unit, text, value in common]
        columns.append(tables.Column("side", "", "right or left", [found.side for found, _ in rows]))
        near = {found.side: one for found, one in zip(self.wheels, self.climbs)}
        columns += [
            tables.Column(name, unit, text, [getattr(near[found.side], attribute) for found, _ in rows])
            for name, attribute, unit, text in CLIMBS
        ]
        columns += [
            tables.Column(name, unit, text, [getattr(patch, name) for _, patch in rows]) for name, unit, text in COLUMNS
        ]
        for k, axis in enumerate("xyz"):
            text = f"force on the rail in the track along {axis}"
            columns.append(tables.Column(f"track_f{axis}", "N", text, [float(patch.force[k]) for _, patch in rows]))
        return columns
