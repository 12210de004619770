"""The solution at a position: patches, their forces, and the forces on the rail in the track."""

from dataclasses import dataclass, field, replace

import numpy as np

from ...core import tables
from ...core.brief import brief

# columns of the table: attribute, unit, meaning
COLUMNS = (
    ("x", "m", "reference point, forward"),
    ("y", "m", "reference point, to the right"),
    ("z", "m", "reference point, down"),
    ("angle", "rad", "inclination of the patch"),
    ("creep_x", "1", "creepage along x"),
    ("creep_s", "1", "creepage along s"),
    ("creep_spin", "1/m", "spin creepage"),
    ("speed", "m/s", "rolling speed"),
    ("friction", "1", "coefficient of friction"),
    ("n", "N", "normal force"),
    ("fx", "N", "force on the rail along x"),
    ("fs", "N", "force on the rail along s"),
    ("mn", "N m", "moment on the rail about the normal"),
    ("approach", "m", "approach along the normal"),
    ("p_max", "Pa", "maximum pressure"),
    ("area", "m2", "area of contact"),
    ("stick_area", "m2", "area of stick"),
    ("cells", "1", "cells in contact"),
    ("stick_cells", "1", "cells in stick"),
    ("t_gamma", "N", "frictional work per distance rolled"),
)


class ConformalWarning(UserWarning):
    """The inclination of a contact varies so much that bodies are no half-spaces: results are approximate."""


class DerailWarning(UserWarning):
    """A wheel of an equilibrium is derailed, or may climb its rail by Nadal's limit."""


@brief
@dataclass(frozen=True, eq=False)
class Drafted:
    """The forces of a contact patch, by a draft of its solution: centre of pressure in the track, (3,), m; inclination,
    rad; normal force and forces on the rail along x and s, N; corners in the patch's x and s, (2,), m, of a right
    wheel, of a box around the contact and a cell more; torque (N m) of the tangential forces on the wheel about its
    axle."""

    centre: np.ndarray
    angle: float
    n: float
    fx: float
    fs: float
    low: np.ndarray
    high: np.ndarray
    torque: float

    @property
    def force(self) -> np.ndarray:
        """Force on the rail in the track, (3,), N."""
        return _in_track(self)

    def mirrored(self) -> "Drafted":
        """The patch as seen in a mirror in the plane y = 0."""
        return replace(self, centre=self.centre * np.array([1.0, -1.0, 1.0]), angle=-self.angle, fs=-self.fs)


def _in_track(patch):
    """Force of a patch on the rail in the track, N."""
    c, s = np.cos(patch.angle), np.sin(patch.angle)
    return np.array([patch.fx, patch.fs * c - patch.n * s, patch.fs * s + patch.n * c])


@brief
@dataclass(frozen=True, eq=False)
class Patch:
    """A contact patch. The forces act on the rail.

    Attributes
    ----------
    x, y, z : float
        Reference point on the rail in the track, m.
    angle : float
        d, rad: inclination of the patch, negative on a right rail's gauge side.
    creep_x, creep_s, creep_spin : float
        Creepages of the rail relative to the wheel, 1 and 1/m.
    speed : float
        The rolling speed that they are relative to, m/s.
    friction : float
        Coefficient of friction.
    n : float
        Normal force, N.
    fx, fs : float
        Forces along x and s, N.
    mn : float
        Moment about the normal through the reference point, N m.
    approach : float
        Approach of the bodies along the normal, m.
    p_max : float
        Maximum pressure, Pa.
    area, stick_area : float
        m2.
    cells, stick_cells : int
        Numbers of cells in contact and in stick.
    grid : tuple of int
        Numbers of cells along x and s.
    grid_x, grid_s : ndarray
        Centres of the cells in the patch, m; those of a left wheel have s of the other sign than in growing order.
    pressure : ndarray
        (ns, nx), Pa.
    t_gamma : float
        Frictional work per distance rolled, N: "T-gamma".
    power : ndarray
        Frictional power per area over the rolling speed, (ns, nx), Pa.
    slip : ndarray
        Slip velocity over the rolling speed, (ns, nx).
    wheel_y : ndarray
        y of the wheel's profile at each row of cells, (ns,), m; of a left wheel that of its right one, too.
    torque : float
        That of the tangential forces on the wheel about its axle, N m; positive against the sense of rolling forward.
    """

    x: float
    y: float
    z: float
    angle: float
    creep_x: float
    creep_s: float
    creep_spin: float
    speed: float
    friction: float
    n: float
    fx: float
    fs: float
    mn: float
    approach: float
    p_max: float
    area: float
    stick_area: float
    cells: int
    stick_cells: int
    grid: tuple[int, int]
    grid_x: np.ndarray = field(repr=False)
    grid_s: np.ndarray = field(repr=False)
    pressure: np.ndarray = field(repr=False)
    t_gamma: float
    power: np.ndarray = field(repr=False)
    slip: np.ndarray = field(repr=False)
    wheel_y: np.ndarray = field(repr=False)
    torque: float

    @property
    def centre(self) -> np.ndarray:
        """Centre of pressure in the track, (3,), m: a point of the line of the normal force."""
        total = self.pressure.sum()
        x = float(self.pressure.sum(axis=0) @ self.grid_x / total)
        s = float(self.pressure.sum(axis=1) @ self.grid_s / total)
        return np.array([self.x + x, self.y + s * np.cos(self.angle), self.z + s * np.sin(self.angle)])

    @property
    def worn(self) -> tuple[np.ndarray, np.ndarray]:
        """Work of friction per area (J/m2), and pressure times slipped way (N/m), of each row of cells in a passage."""
        step = abs(float(self.grid_x[1] - self.grid_x[0]))
        return self.power.sum(axis=1) * step, (self.pressure * self.slip).sum(axis=1) * step

    @property
    def force(self) -> np.ndarray:
        """Force on the rail in the track, (3,), N: x forward, y to the right, z down."""
        return _in_track(self)

    def mirrored(self) -> "Patch":
        """The patch as seen in a mirror in the plane y = 0.

        Returns
        -------
        Patch
        """
        names = ("y", "angle", "creep_s", "creep_spin", "fs", "mn", "grid_s")
        return replace(self, **{name: -getattr(self, name) for name in names})


@brief
@dataclass(frozen=True, eq=False)
class Result(tables.Tabled):
    """The solution at a position.

    Attributes
    ----------
    patches : tuple of Patch
        In growing y; none where the bodies do not touch.
    z : float
        Vertical displacement of the wheelset, m, positive down.
    touch : float
        The one at which the bodies just touch, m.
    passes : int
        Solutions that it took.
    side : str
        right or left.
    """

    patches: tuple[Patch, ...]
    z: float
    touch: float
    passes: int
    side: str = "right"

    @property
    def force(self) -> np.ndarray:
        """Force on the rail in the track, (3,), N: x forward, y to the right, z down."""
        return sum((patch.force for patch in self.patches), np.zeros(3))

    @property
    def torque(self) -> float:
        """Torque of the tangential forces on the wheel about its axle, N m."""
        return float(sum(patch.torque for patch in self.patches))

    @property
    def overlap(self) -> float:
        """Depth of the undeformed bodies in each other along z, m; negative where they do not touch."""
        return self.z - self.touch

    def table(self) -> list[tables.Column]:
        """The numbers of the patches.

        Returns
        -------
        list of Column
            A row for each patch; see also to_csv() and to_dataframe().
        """
        return [
            tables.Column(name, unit, text, [getattr(patch, name) for patch in self.patches])
            for name, unit, text in COLUMNS
        ]

    def mirrored(self) -> "Result":
        """The solution as seen in a mirror in the plane y = 0.

        Returns
        -------
        Result
        """
        side = "left" if self.side == "right" else "right"
        return replace(self, patches=tuple(patch.mirrored() for patch in self.patches[::-1]), side=side)
