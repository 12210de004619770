"""The loads of a patch: resultants of nodal forces in its frame, with petsam's signs.

With the coordinates x, y, z of a frame, z into body 2 and y = z x x, and the force F of each node on body 2:

    N  = sum F_z    Mx = -sum (y F_z - z F_y)    My = sum (x F_z - z F_x)
    Tx = sum F_x    Ty =  sum F_y                Mz = sum (x F_y - y F_x)

Nodes of the plane z = 0 give the sums of examples/manual/LOADS.md. Forces on body 1 are those on body 2 reversed. The
centre of the contact is where N alone has Mx and My: x = My/N, y = -Mx/N.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ...core.errors import Error, Unusable, short
from ...core.files import need_replaceable
from ...core.frames import Frame
from ...core.tables import Column, Tabled
from ...results.cycles import turning_points
from . import automatic, doubts
from .forces import Forces

UNKNOWN_HERE = f"{Tabled.unknown} for these loads, which are sums of the given forces: those of a finer mesh show it"
LOADS = ("load_n", "load_tx", "load_ty", "load_mx", "load_my", "load_mz")
UNITS = ("N", "N", "N", "N m", "N m", "N m")
SYMBOLS = {"load_n": "N", "load_tx": "T_x", "load_ty": "T_y", "load_mx": "M_x", "load_my": "M_y", "load_mz": "M_z"}
TEXTS = (
    "normal force, positive where it presses", "tangential force along x", "tangential force along y",
    "moment about x", "moment about y", "moment about the normal",
)  # fmt: skip
SAME = 1e-6  # of the last time: times that are equal
ROUNDING = 1e-9  # of the largest force: smaller ones are rounding
BODIES = {"body1": -1.0, "body2": 1.0}


class Row(NamedTuple):
    """A load state, in SI units."""

    time: float
    load_n: float
    load_tx: float
    load_ty: float
    load_mx: float
    load_my: float
    load_mz: float


@dataclass
class History(Tabled):
    """The load history of a patch.

    Attributes
    ----------
    name, source : str
        The patch, and the file of its forces.
    on : str
        The body on which the file's forces act: "body1" or "body2".
    frame : compliance.frames.Frame
        Origin (m) and axes.
    z_by : str
        How z of the frame was found; empty where it was given.
    length : float
        The file's unit of length, m.
    times : ndarray
        (n,), s.
    loads : ndarray
        (n, 6): N, Tx, Ty, Mx, My, Mz; N and N m.
    x : ndarray
        Coordinates of the nodes in the frame at the first time, (m, 3), m.
    normal : ndarray
        Normal force of each node, (n, m), N.
    pressure : dict
        {"cpress", "cshear1", "cshear2": (n, m)}, Pa, where the file has them.
    notes : list of str
        Remarks.
    """

    name: str
    source: str
    on: str
    frame: Frame
    z_by: str
    length: float
    times: np.ndarray
    loads: np.ndarray
    x: np.ndarray
    normal: np.ndarray
    pressure: dict = field(default_factory=dict)
    notes: list = field(default_factory=list)

    def __repr__(self):
        return f"History({short(self.name)}: {len(self.times)} rows of {self.x.shape[0]} nodes)"

    @property
    def rows(self) -> list:
        """The rows: time and the six loads."""
        return [Row(float(time), *map(float, loads)) for time, loads in zip(self.times, self.loads)]

    @property
    def center(self) -> np.ndarray:
        """The contact's centre, (n, 2), m; NaN where N is not above 0."""
        n = np.where(self.loads[:, 0] > 0.0, self.loads[:, 0], np.nan)
        return np.stack([self.loads[:, 4] / n, -self.loads[:, 3] / n], axis=1)

    @property
    def friction(self) -> np.ndarray:
        """T/N of each row, (n,): the friction coefficient is larger, unless all slides; NaN where N is not above 0."""
        n = np.where(self.loads[:, 0] > 0.0, self.loads[:, 0], np.nan)
        return np.hypot(self.loads[:, 1], self.loads[:, 2]) / n

    @property
    def extent(self) -> np.ndarray:
        """Smallest and largest x and y of the nodes, (2, 2), m."""
        return np.array([self.x[:, :2].min(axis=0), self.x[:, :2].max(axis=0)])

    @property
    def frame_text(self) -> str:
        """The frame as --frame has it: ORIGIN:X:Z in the file's unit of length."""
        return automatic.written(self.frame, self.length)

    @property
    def rounding(self) -> np.ndarray:
        """Magnitudes of the loads, (6,), up to which they are rounding."""
        force, size = float(np.max(np.abs(self.loads[:, :3]))), float(np.max(np.ptp(self.extent, axis=0)))
        return ROUNDING * force * np.array([1.0, 1.0, 1.0, size, size, size])

    def turns(self) -> dict:
        """Indices of the rows where each load reverses.

        Returns
        -------
        dict
            {name: list}.
        """
        return {
            name: turning_points(values) if np.ptp(values) > small else []
            for name, values, small in zip(LOADS, self.loads.T, self.rounding)
        }

    def line(self, time: float) -> dict:
        """Nodes along y = 0 with the pressure of the analysis at a time.

        Parameters
        ----------
        time : float
            s.

        Returns
        -------
        dict
            {"x", "pressure", "shear": (k,)}, m and Pa; shear is the magnitude, as the directions of CSHEAR1 and CSHEAR2
            are those of the element faces.

        Raises
        ------
        petsam.Error
            If the file has no CPRESS, there is no row at this time, or no node near the line.
        """
        if "cpress" not in self.pressure:
            raise Error(f"{self.source}: has no CPRESS: report it with the forces, column cpress")
        row = int(np.argmin(np.abs(self.times - time)))
        if abs(self.times[row] - time) > SAME * np.max(np.abs(self.times)):
            raise Error(f"{self.source}: has no row at time {time:g} s: give results of this history")
        x, y = self.x[:, 0], self.x[:, 1]
        near = np.flatnonzero(np.abs(y) <= 0.5 * np.sqrt(np.prod(np.ptp(self.extent, axis=0)) / len(y)))
        if len(near) < 2:
            raise Error(f"{self.source}: has no nodes near y = 0 of the frame: move its origin")
        near = near[np.argsort(x[near], kind="stable")]
        shear = [self.pressure[one][row, near] for one in ("cshear1", "cshear2") if one in self.pressure]
        sizes = np.linalg.norm(shear, axis=0) if shear else np.full(len(near), np.nan)
        return {"x": x[near], "pressure": self.pressure["cpress"][row, near], "shear": sizes}

    def table(self) -> list:
        """The columns: time, the loads, the contact's centre, T/N and the number of nodes that pull.

        Returns
        -------
        list of Column
        """
        center = [[None if np.isnan(value) else float(value) for value in one] for one in self.center.T]
        friction = [None if np.isnan(value) else float(value) for value in self.friction]
        return [
            Column("time", "s", "time", self.times.tolist()),
            *(
                Column(name, unit, text, values.tolist())
                for name, unit, text, values in zip(LOADS, UNITS, TEXTS, self.loads.T)
            ),
            Column("center_x", "m", "centre of the contact", center[0]),
            Column("center_y", "m", "centre of the contact", center[1]),
            Column("friction", "1", "T/N", friction),
            Column("pulling", "1", "nodes that pull", np.sum(doubts.pulling(self.normal), axis=1).tolist()),
        ]

    def write(self, path: str | os.PathLike) -> None:
        """Writes the history for petsam's -history: time and the six loads, heads without units.

        Parameters
        ----------
        path : path
            The file, which is replaced.
        """
        need_replaceable(path)
        with open(path, "w", encoding="utf-8") as file:
            file.write(",".join(Row._fields) + "\n")
            file.writelines(",".join(map(repr, row)) + "\n" for row in self.rows)


def summed(x, force, couple=None):
    """Loads (n, 6) of forces (n, m, 3) at places (m, 3) or (n, m, 3), in a frame."""
    moment = np.cross(np.broadcast_to(x, force.shape), force)
    if couple is not None:
        moment = moment + couple
    f, m = force.sum(axis=1), moment.sum(axis=1)
    return np.stack([f[:, 2], f[:, 0], f[:, 1], -m[:, 0], -m[:, 1], m[:, 2]], axis=1) + 0.0  # no -0


def _need_frame(frame):
    """Raises Unusable unless a frame is "auto", or one to three points."""
    if isinstance(frame, str):
        good = frame == "auto"
    else:
        try:
            good = 1 <= len(frame) <= 3 and all(np.shape(one) == (3,) and np.all(np.isfinite(one)) for one in frame)
        except TypeError:
            good = False
    if not good:
        raise Unusable(f"--frame {short(str(frame))}: expected auto, or ORIGIN[:X[:Z]], each of them three numbers")


def history(
    forces: Forces,
    frame: str | Sequence = "auto",
    patch: str | Sequence | None = None,
    on: str = "body2",
    name: str | None = None,
) -> History:
    """The load history of a patch, with petsam's signs.

    Parameters
    ----------
    forces : Forces
        Of read().
    frame : str or tuple
        "auto", or origin, x and z (or the first ones of them) as petsam-compliance takes them, in the file's unit of
        length; z points into body 2.
    patch : str or tuple, optional
        A set of nodes, or a box; all nodes.
    on : str
        The body on which the forces act: "body1" or "body2".
    name : str, optional
        The name of the history; that of the patch.

    Returns
    -------
    History

    Raises
    ------
    petsam.Error
        If the patch has no nodes, or its forces press out of body 2.

    Examples
    --------
    >>> import numpy as np, petsam
    >>> x = np.array([[0.0, 0.0, 0.0], [1e-3, 0.0, 0.0], [0.0, 1e-3, 0.0], [1e-3, 1e-3, 0.0]])  # m
    >>> force = np.array([0.5, 1.0])[:, None, None] * np.tile([2.0, 0.0, 25.0], (1, 4, 1))  # N
    >>> forces = petsam.loads.Forces("table", np.array([0.0, 1.0]), np.arange(4), x, force)
    >>> found = petsam.loads.history(forces, frame=((5e-4, 5e-4, 0.0), (1, 0, 0), (0, 0, 1)))
    >>> [float(load) for load in found.loads[-1, :3]]
    [100.0, 8.0, 0.0]
    """
    if on not in BODIES:
        raise Unusable(f"--on {short(str(on))}: use {', '.join(BODIES)}")
    _need_frame(frame)
    nodes, sign = forces.nodes(patch), BODIES[on]
    if not np.max(np.abs(forces.force[:, nodes])) > ROUNDING * np.max(np.abs(forces.force)):
        raise Error(
            f"{forces.source}: all forces on {short(str(patch))} are 0, or rounding: name another set (RF of CalculiX "
            "is 0 at nodes without supports: use *CONTACT PRINT, CF)"
        )
    automatically = isinstance(frame, str)
    found, z_by = automatic.of(forces, nodes, sign) if automatically else automatic.given(forces, frame, nodes, sign)
    x = (forces.x[..., nodes, :] - found.origin) @ found.axes.T
    force = sign * forces.force[:, nodes] @ found.axes.T
    couple = None if forces.couple is None else sign * forces.couple[:, nodes] @ found.axes.T
    loads = summed(x, force, couple)
    n = loads[:, 0]
    if not np.max(n) > 0.0 or -np.min(n) > np.max(n):
        other = "body1" if on == "body2" else "body2"
        raise Unusable(
            f"--on {on}: the forces press out of body 2 (N from {np.min(n):.4g} to {np.max(n):.4g} N): give "
            f"--on {other} if they act on that body, or reverse z of --frame, which points into body 2"
        )
    start = x if x.ndim == 2 else x[0]
    title = name or (patch if isinstance(patch, str) else "all" if patch is None else "box")
    result = History(title, forces.source, on, found, z_by, forces.length, forces.times, loads, start, force[..., 2])
    result.pressure = {one: values[:, nodes] for one, values in forces.pressure.items()}
    result.notes = [*forces.notes, *doubts.of(result, force, x)]
    return result
