"""Creep forces of elliptic contacts from a table: CreepTable, with the file and the numbers of include/petsam/creep.h.

Axes of the table: log(a/b), and the scaled creepages (X, Y, Z) in spherical coordinates,

    X = C11 xi'/3, Y = C22 eta'/3, Z = hypot(C23/1.5, sqrt(b/a) C11/3) phi',
    v = R/(1 + R) with R = |(X, Y, Z)|, alpha = atan2(Y, X), beta = atan2(Z, hypot(X, Y)),

with xi' = G c^2 xi/(mu N), phi' = G c^3 phi/(mu N), c^2 = a b, and Kalker's coefficients C11, C22, C23. The table has
Fx/(mu N), Fy/(mu N), Mz/(mu N c), over v: at v = 0 linear theory, at v = 1 full sliding. Its nodes are equally spaced
in log(a/b) and in

    level = 3/4 v + 1/4 (arctan(10 v - 4) + arctan(4))/(arctan(6) + arctan(4)),
    turn = (alpha + atan2(Y (kx/ky)^(sin(beta)^2), X))/2, rise = (beta + atan2(Z, hypot(X/sqrt(kx), Y/sqrt(ky))))/2,

with kx = 1/hypot(1, 0.7 a/b), ky = a/b/hypot(1.37, 0.7 a/b): nearly X/Z and Y/Z where the pole of the rigid slip is at
the edge of the contact, on the axis b or a. The forces of slender ellipses change on both scales, that of the creepages
and that of the edge, and turn and rise resolve both; level is finer where the contact begins to slide fully.

The forces over v are those of linear theory times (1 - v)^2, and a rest. Between its nodes are cubic splines, whose
value takes four coefficients along each axis, and whose first two derivatives are continuous. Across the ends of turn
and rise they are continued by the symmetries; at the ends of a/b and v by the third derivative.

File, little-endian: the bytes PETSAMCF; version, byte order mark, four numbers of nodes, cells, 0 (8 uint32); first and
last log(a/b), Poisson's ratio, own error (median, 90 %, worst, over mu N) and the number of its cases (7 float64);
splines of log C11, C22, C23 (nodes of a/b, 3 values of Poisson's ratio, 3; float64); those of the linear theory, forces
by X, Y, Z (nodes of a/b, 3, 3; float64); steps of the rests (nodes of a/b, v, 3; float32), and the rests at the nodes
over the steps (nodes of a/b, v, turn, rise, 3; int16, and zeros up to a multiple of 4 bytes); a checksum of all before
(FNV-1a over words of 4 bytes, uint64).
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ...core.errors import Error, MissingFile

MAGIC, VERSION, MARK = b"PETSAMCF", 2, 0x01020304
HEADER, NUMBERS = np.dtype("<u4"), np.dtype("<f8")
LEAST = 4  # nodes along an axis
STEPS = 32767  # whole number of the greatest force
BEND, WIDTH, SHARE = 0.4, 0.1, 0.25  # of the levels: v where they are finest, how far, how much
SPAN = float(np.arctan((1.0 - BEND) / WIDTH) + np.arctan(BEND / WIDTH))
POLE = 1e-3  # cosine of beta below which the forces are linear in X and Y
ORIGIN = 1e-9  # R below which they are linear
ROUND = 5e-4  # half width of the rounded corner where |F| is cut to mu N
CHUNK = 4096  # cases at once


class Forces(NamedTuple):
    """Creep forces.

    Attributes
    ----------
    force : ndarray
        Fx and Fy, N, and Mz, N m, (..., 3).
    derivative : ndarray or None
        By xi, eta, phi and N, the half axes held, (..., 3, 4).
    """

    force: np.ndarray
    derivative: Optional[np.ndarray]


@dataclass(frozen=True)
class FallingFriction:
    """Friction that falls with the slip velocity, as by -friction_law falling, for CreepTable.forces().

    Parameters
    ----------
    static : float
        Coefficient of friction without slip.
    kinetic : float
        That at high speed.
    half_speed : float
        Speed at which half of the way is done, m/s.

    Raises
    ------
    Error
        If a number is out of range.
    """

    static: float
    kinetic: float
    half_speed: float

    def __post_init__(self) -> None:
        if not (0.0 < self.kinetic <= self.static < np.inf and 0.0 < self.half_speed < np.inf):
            raise Error(
                f"FallingFriction {self.static:g}, {self.kinetic:g}, {self.half_speed:g}: expected two coefficients of "
                "friction, the second one not above the first, and a speed in m/s"
            )

    def __call__(self, speed: np.ndarray) -> np.ndarray:
        """The coefficient of friction.

        Parameters
        ----------
        speed : ndarray
            Slip velocity, m/s.

        Returns
        -------
        ndarray
        """
        return self.kinetic + (self.static - self.kinetic) * np.exp2(-speed / self.half_speed)


def slip(a: np.ndarray, b: np.ndarray, xi: np.ndarray, eta: np.ndarray, phi: np.ndarray) -> np.ndarray:
    """The rigid slip over the rolled distance: the root of its mean square, weighted by Hertz's pressure.

    Parameters
    ----------
    a, b : ndarray
        Half axes along and across the rolling direction, m.
    xi, eta : ndarray
        Creepages.
    phi : ndarray
        Spin, 1/m.

    Returns
    -------
    ndarray
    """
    return np.sqrt(xi**2 + eta**2 + phi**2 * (a**2 + b**2) / 5.0)


def basis(place: np.ndarray, n: int, ghosts: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The four coefficients that a spline uses at a place, their weights, and those of the derivative.

    Parameters
    ----------
    place : ndarray
        From 0 to n - 1, (m,).
    n : int
        Nodes of the axis.
    ghosts : bool
        Whether the axis has a further coefficient at each end; else its third derivative is continued.

    Returns
    -------
    first : ndarray
        Index of the first coefficient, (m,).
    weights, slopes : ndarray
        (m, 4).
    """
    k = np.minimum(place.astype(int), n - 2)
    u = place - k
    w = np.stack([(1.0 - u) ** 3, 4.0 - 3.0 * u * u * (2.0 - u), 1.0 + 3.0 * u * (1.0 + u * (1.0 - u)), u**3], -1) / 6.0
    d = np.stack([-((1.0 - u) ** 2), u * (3.0 * u - 4.0), 1.0 + u * (2.0 - 3.0 * u), u * u], -1) / 2.0
    if ghosts:
        return k, w, d
    return np.clip(k - 1, 0, n - 4), _folded(w, k, n), _folded(d, k, n)


def _folded(w, k, n):
    """Weights with those of the missing coefficients at the ends moved to the others."""
    w0, w1, w2, w3 = w.T
    low = np.stack([w1 + 4.0 * w0, w2 - 6.0 * w0, w3 + 4.0 * w0, -w0], -1)
    high = np.stack([-w3, w0 + 4.0 * w3, w1 - 6.0 * w3, w2 + 4.0 * w3], -1)
    return np.where((k == 0)[:, None], low, np.where((k == n - 2)[:, None], high, w))


class Angles(NamedTuple):
    """Turn and rise of creepages.

    Attributes
    ----------
    value : ndarray
        turn, from -pi/2 to pi/2, and rise, from 0 to pi/2, (m, 2).
    slopes : ndarray
        Their derivative by X, Y, Z, (m, 2, 3).
    """

    value: np.ndarray
    slopes: np.ndarray


def edge(ratio: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """X/Z and Y/Z, nearly, where the pole of the rigid slip is at the edge of the contact.

    Parameters
    ----------
    ratio : ndarray
        a/b, (m,).

    Returns
    -------
    tuple of ndarray
        kx, on the axis b, and ky, on the axis a, (m,).
    """
    return 1.0 / np.hypot(1.0, 0.7 * ratio), ratio / np.hypot(1.37, 0.7 * ratio)


def angles(ratio: np.ndarray, vector: np.ndarray) -> Angles:
    """The angles in which nodes of the table are equally spaced.

    Parameters
    ----------
    ratio : ndarray
        a/b, (m,).
    vector : ndarray
        X and Z of 0 or more, and Y, (m, 3); X and Y are not both 0.

    Returns
    -------
    Angles
    """
    x, y, z = vector.T
    kx, ky = edge(ratio)
    h2, r2 = x * x + y * y, x * x + y * y + z * z
    h, g = np.sqrt(h2), np.sqrt(x * x / kx + y * y / ky)
    log = np.log(kx / ky)
    m = np.exp(log * z * z / r2)
    turn = 0.5 * (np.arctan2(y, x) + np.arctan2(m * y, x))
    rise = 0.5 * (np.arctan2(z, h) + np.arctan2(z, g))
    second = 0.5 * m / (x * x + m * m * y * y)
    first, third = 0.5 / h2 + second, second * x * y * log * 2.0 * z / (r2 * r2)
    low, high = 0.5 / (h * r2), 0.5 / (g * (z * z + g * g))
    slopes = [
        [-y * first - third * z * x, x * first - third * z * y, third * h2],
        [-z * x * (low + high / kx), -z * y * (low + high / ky), low * h2 + high * g * g],
    ]
    return Angles(np.stack([turn, rise], -1), np.moveaxis(np.array(slopes), -1, 0))


def level(v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The level of v, from 0 to 1, in which nodes are equally spaced, and its derivative.

    Parameters
    ----------
    v : ndarray
        R/(1 + R).

    Returns
    -------
    tuple of ndarray
    """
    t = (v - BEND) / WIDTH
    value = (1.0 - SHARE) * v + SHARE / SPAN * (np.arctan(t) + np.arctan(BEND / WIDTH))
    return value, 1.0 - SHARE + SHARE / (SPAN * WIDTH) / (1.0 + t * t)


def rounded(nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Forces at nodes as whole numbers of steps, so that the greatest of each a/b, v and force is STEPS.

    Parameters
    ----------
    nodes : ndarray
        (nodes of a/b, v, turn, rise, 3).

    Returns
    -------
    whole : ndarray
        Of the same form, int16.
    steps : ndarray
        (nodes of a/b, v, 3), float32.
    """
    steps = (np.abs(nodes).max(axis=(2, 3)) / (STEPS - 1)).astype(np.float32)
    by = np.where(steps > 0.0, steps, 1.0).astype(float)
    return np.rint(nodes / by[:, :, None, None]).astype(np.int16), steps


def spline(nodes: np.ndarray) -> np.ndarray:
    """The coefficients of the splines through values at nodes, with the symmetries of turn and rise.

    Parameters
    ----------
    nodes : ndarray
        (nodes of a/b, v, turn, rise, 3).

    Returns
    -------
    ndarray
        Of the same form.
    """
    found = solved(solved(nodes, 0), 1)
    even = np.stack([solved(found[..., k], 2, (s, s)) for k, s in enumerate((-1, 1, 1))], -1)
    turned = even[:, :, ::-1]
    out = np.zeros_like(even)
    for half, s in ((0.5 * (even + turned), 1), (0.5 * (even - turned), -1)):
        ends = ((s, -s), (-s, s), (-s, s))
        out += np.stack([solved(half[..., k], 3, ends[k]) for k in range(3)], -1)
    return out


def solved(values: np.ndarray, axis: int, signs: Optional[tuple[int, int]] = None) -> np.ndarray:
    """The coefficients of splines along an axis.

    Parameters
    ----------
    values : ndarray
        Values at the nodes.
    axis : int
        The axis.
    signs : tuple of int, optional
        Of the continuation beyond its ends; none: the third derivative is continued.

    Returns
    -------
    ndarray
        Of the form of values.
    """
    n = values.shape[axis]
    ghosts = np.zeros((n + 2, n))
    ghosts[1:-1] = np.eye(n)
    if signs:
        ghosts[0, 1], ghosts[-1, -2] = signs
    else:
        ghosts[0, :4], ghosts[-1, -4:] = (4, -6, 4, -1), (-1, 4, -6, 4)
    matrix = (ghosts[:-2] + 4.0 * ghosts[1:-1] + ghosts[2:]) / 6.0
    return np.moveaxis(np.tensordot(np.linalg.inv(matrix), values, (1, axis)), 0, axis)


def checksum(data: bytes) -> int:
    """The checksum of a file: FNV-1a with 64 bits, over words of 4 bytes.

    Parameters
    ----------
    data : bytes
        A multiple of 4 bytes.

    Returns
    -------
    int
    """
    found = 0xCBF29CE484222325
    for word in np.frombuffer(data, HEADER).tolist():
        found = ((found ^ word) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return found


@dataclass(frozen=True, eq=False)
class CreepTable:
    """A table of creep forces.

    Parameters
    ----------
    range : tuple of float
        First and last a/b.
    poisson : float
        Poisson's ratio of the bodies.
    scales : ndarray
        Splines of log C11, C22, C23 at Poisson's ratios 0, `poisson` and 0.5, (nodes of a/b, 3, 3).
    linear : ndarray
        Splines of the linear theory, forces by X, Y, Z, (nodes of a/b, 3, 3).
    nodes : ndarray
        Rests of the forces over v, over their steps, (nodes of a/b, v, turn, rise, 3), int16.
    steps : ndarray
        (nodes of a/b, v, 3), float32.
    cells : int
        Cells along an axis of the grids that it is made with.
    error : tuple of float
        Error of the forces of its nodes, over mu N (Mz: mu N c): median, 90 %, worst, and the number of cases.
    """

    range: tuple[float, float]
    poisson: float
    scales: np.ndarray
    linear: np.ndarray
    nodes: np.ndarray
    steps: np.ndarray
    cells: int = 0
    error: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_full", continued(spline(self.nodes * self.steps.astype(float)[:, :, None, None])))

    @classmethod
    def open(cls, path: Union[str, os.PathLike[str]]) -> CreepTable:
        """The table of a file.

        Parameters
        ----------
        path : path
            The file, made by `make creep-table`.

        Returns
        -------
        CreepTable

        Raises
        ------
        Error
            If the file is none, is damaged, or of another version.
        MissingFile
            If there is no such file.
        """
        try:
            with open(path, "rb") as file:
                data = file.read()
        except FileNotFoundError:
            raise MissingFile(os.fspath(path)) from None
        except OSError as error:
            raise Error(f"{path}: {error.strerror}") from None
        return cls(*_parsed(path, data))

    def write(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes the table to a file.

        Parameters
        ----------
        path : path
            The file.
        """
        n = self.nodes.shape[:4]
        head = np.array([VERSION, MARK, *n, self.cells, 0], HEADER)
        numbers = np.array([*np.log(self.range), self.poisson, *self.error], NUMBERS)
        data = MAGIC + head.tobytes() + numbers.tobytes() + self.scales.astype(NUMBERS).tobytes()
        data += self.linear.astype(NUMBERS).tobytes()
        data += self.steps.astype("<f4").tobytes() + self.nodes.astype("<i2").tobytes()
        data += bytes(-len(data) % 4)
        with open(path, "wb") as file:
            file.write(data + checksum(data).to_bytes(8, "little"))

    def kalker(self, ratio: np.ndarray, poisson: np.ndarray) -> np.ndarray:
        """Kalker's coefficients, by which creepages are scaled.

        Parameters
        ----------
        ratio : ndarray
            a/b, cut to the table's range, (m,).
        poisson : ndarray
            Poisson's ratio, (m,).

        Returns
        -------
        ndarray
            C11, C22, C23, (m, 3).
        """
        return self._kalker(self._place(ratio), poisson)

    def _place(self, ratio):
        low, high = np.log(self.range)
        n = len(self.scales)
        return np.clip((np.log(ratio) - low) * ((n - 1) / (high - low)), 0.0, n - 1.0)

    def _kalker(self, place, poisson):
        first, w, _ = basis(place, len(self.scales), False)
        logs = np.einsum("mi,mijk->mjk", w, self.scales[first[:, None] + np.arange(4)])
        p = self.poisson
        by = np.stack([(poisson - p) * (poisson - 0.5) / (0.5 * p), poisson * (poisson - 0.5) / (p * (p - 0.5)),
                       poisson * (poisson - p) / (0.5 * (0.5 - p))], -1)  # fmt: skip
        return np.exp(np.einsum("mj,mjk->mk", by, logs))

    def factors(self, ratio: np.ndarray, poisson: np.ndarray) -> np.ndarray:
        """X/xi', Y/eta', Z/phi'.

        Parameters
        ----------
        ratio : ndarray
            a/b, (m,).
        poisson : ndarray
            Poisson's ratio, (m,).

        Returns
        -------
        ndarray
            (m, 3).
        """
        c11, c22, c23 = self.kalker(ratio, poisson).T
        return np.stack(
            [c11 / 3.0, c22 / 3.0, np.hypot(c23 / 1.5, c11 / 3.0 / np.sqrt(np.clip(ratio, *self.range)))], -1
        )

    def forces(
        self,
        load: ArrayLike,
        half_axes: tuple[ArrayLike, ArrayLike],
        creepages: tuple[ArrayLike, ArrayLike, ArrayLike],
        friction: Union[ArrayLike, Callable[[np.ndarray], np.ndarray]],
        material: tuple[ArrayLike, ArrayLike] = (82e9, 0.28),
        speed: ArrayLike = 0.0,
        derivative: bool = False,
    ) -> Forces:
        """Creep forces of elliptic contacts; all arguments are numbers or arrays of one shape.

        Parameters
        ----------
        load : float or ndarray
            N, N; 0 or less: no forces.
        half_axes : tuple
            a along and b across the rolling direction, m; beyond the table's range of a/b its end is taken.
        creepages : tuple
            xi, eta and the spin phi, 1/m; a positive creepage gives a positive force.
        friction : float, ndarray or callable
            mu; a function of the slip velocity (m/s), such as FallingFriction.
        material : tuple
            G, Pa, and Poisson's ratio, equal in both bodies.
        speed : float or ndarray
            Rolling speed for a function of friction, m/s.
        derivative : bool
            Whether to return the derivative, at a fixed coefficient of friction.

        Returns
        -------
        Forces

        Raises
        ------
        Error
            If an argument is no number, or out of range.
        """
        given = np.broadcast_arrays(load, *half_axes, *creepages, *material, speed)
        shape = given[0].shape
        *flat, v = (np.asarray(one, float).ravel() for one in given)
        mu = friction(np.abs(v) * slip(*flat[1:6])).reshape(shape) if callable(friction) else friction
        cases = np.stack([*flat, np.broadcast_to(np.asarray(mu, float), shape).ravel()])
        _need_contacts(cases)
        force, slopes = np.zeros((v.size, 3)), np.zeros((v.size, 3, 4))
        loaded = np.flatnonzero((cases[0] > 0.0) & (cases[-1] > 0.0))
        for k in range(0, loaded.size, CHUNK):
            some = loaded[k : k + CHUNK]
            force[some], slopes[some] = self._forces(cases[:, some])
        return Forces(force.reshape(*shape, 3), slopes.reshape(*shape, 3, 4) if derivative else None)

    def _forces(self, cases):
        """Forces and derivatives of contacts that bear load."""
        n, a, b, *creepages, shear, poisson, mu = cases
        c = np.sqrt(a * b)
        traction = mu * n
        creepage = np.stack(creepages, -1)
        one = np.ones_like(c)
        unit = self.factors(a / b, poisson) * (shear * c * c / traction)[:, None] * np.stack([one, one, c], -1)
        found, slopes = self.scaled(a / b, unit * creepage)
        size = traction[:, None] * np.stack([one, one, c], -1)
        force, by = size * found, size[:, :, None] * slopes * unit[:, None, :]
        by_load = (force - np.einsum("mij,mj->mi", by, creepage)) / n[:, None]
        return force, np.concatenate([by, by_load[:, :, None]], -1)

    def scaled(self, ratio: np.ndarray, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The forces in the table's units.

        Parameters
        ----------
        ratio : ndarray
            a/b, (m,).
        vector : ndarray
            X, Y, Z, (m, 3).

        Returns
        -------
        forces : ndarray
            Fx/(mu N), Fy/(mu N), Mz/(mu N c), (m, 3).
        slopes : ndarray
            Their derivative by X, Y, Z, (m, 3, 3).
        """
        place, held = self._place(ratio), np.clip(ratio, *self.range)
        sx = np.where(vector[:, 0] < 0.0, -1.0, 1.0)
        sz = np.where(vector[:, 2] < 0.0, -1.0, 1.0)
        signs = np.stack([sx, sz, sz], -1)
        inside = signs * vector
        radius = np.sqrt(np.einsum("mi,mi->m", inside, inside))
        force, slopes = np.empty_like(inside), np.empty((len(inside), 3, 3))
        far = radius > ORIGIN
        force[far], slopes[far] = self._curved(place[far], held[far], inside[far], radius[far])
        if not far.all():
            slopes[~far] = self._linear(place[~far])
            force[~far] = np.einsum("mij,mj->mi", slopes[~far], inside[~far])
        force, slopes = _cut(force, slopes)
        return signs * force, signs[:, :, None] * slopes * signs[:, None, :]

    def _linear(self, place):
        """The derivative of the forces at the origin."""
        first, w, _ = basis(place, len(self.linear), False)
        return np.einsum("mi,mijk->mjk", w, self.linear[first[:, None] + np.arange(4)])

    def _curved(self, place, ratio, inside, radius):
        x, y, z = inside.T
        h = np.hypot(x, y)
        polar = h < POLE * radius
        px, py = x, y
        if polar.any():
            h, alpha = np.where(polar, POLE * radius, h), np.arctan2(y, x)
            px, py = np.where(polar, h * np.cos(alpha), x), np.where(polar, h * np.sin(alpha), y)
            radius = np.sqrt(px * px + py * py + z * z)
        v = radius / (1.0 + radius)
        vector = np.stack([px, py, z], -1)
        (at, finer), (both, by) = level(v), angles(ratio, vector)
        f, fv, *fab = self._splines(place, at, *both.T)
        along = (f + (v * finer)[:, None] * fv) / (radius * (1.0 + radius) ** 2)[:, None]
        slopes = along[:, :, None] * vector[:, None, :] + v[:, None, None] * np.einsum("amc,maj->mcj", fab, by)
        linear, left = self._linear(place), (1.0 - v)[:, None]
        ahead = np.einsum("mij,mj->mi", linear, vector)
        slopes += left[:, :, None] ** 3 * linear
        slopes -= (3.0 * left**4 / radius[:, None] * ahead)[:, :, None] * vector[:, None, :]
        force = v[:, None] * f + left**3 * ahead
        if polar.any():
            force = force + slopes[:, :, 0] * (x - px)[:, None] + slopes[:, :, 1] * (y - py)[:, None]
        return force, slopes

    def _splines(self, place, level, turn, rise):
        """Values, and derivatives by level, turn, rise, each (m, 3)."""
        n = self.nodes.shape
        steps = n[1] - 1.0, (n[2] - 1.0) / np.pi, (n[3] - 1.0) / (0.5 * np.pi)
        i, wi, _ = basis(place, n[0], False)
        j, wj, dj = basis(np.clip(level * steps[0], 0.0, n[1] - 1.0), n[1], False)
        k, wk, dk = basis(np.clip((turn + 0.5 * np.pi) * steps[1], 0.0, n[2] - 1.0), n[2], True)
        m, wm, dm = basis(np.clip(rise * steps[2], 0.0, n[3] - 1.0), n[3], True)
        four = np.arange(4)
        found = self._full[
            (i[:, None] + four)[:, :, None, None, None], (j[:, None] + four)[:, None, :, None, None],
            (k[:, None] + four)[:, None, None, :, None], (m[:, None] + four)[:, None, None, None, :],
        ]  # fmt: skip
        found = np.einsum("qi,qijkmc->qjkmc", wi, found)
        by, db = np.einsum("qm,qjkmc->qjkc", wm, found), np.einsum("qm,qjkmc->qjkc", dm, found)
        both, da = np.einsum("qk,qjkc->qjc", wk, by), np.einsum("qk,qjkc->qjc", dk, by)
        db = np.einsum("qj,qk,qjkc->qc", wj, wk, db)
        value, dv = np.einsum("qj,qjc->qc", wj, both), np.einsum("qj,qjc->qc", dj, both)
        return value, steps[0] * dv, steps[1] * np.einsum("qj,qjc->qc", wj, da), steps[2] * db


def continued(coefficients: np.ndarray) -> np.ndarray:
    """Coefficients with one more at each end of turn and rise, by the symmetries.

    Parameters
    ----------
    coefficients : ndarray
        (nodes of a/b, v, turn, rise, 3).

    Returns
    -------
    ndarray
        (nodes of a/b, v, turn + 2, rise + 2, 3).
    """
    across, below, above = np.array([-1, 1, 1]), np.array([1, -1, -1]), np.array([-1, 1, 1])
    c = coefficients
    c = np.concatenate([across * c[:, :, 1:2], c, across * c[:, :, -2:-1]], 2)
    turned = c[:, :, ::-1]  # turn -> -turn
    return np.concatenate([below * turned[..., 1:2, :], c, above * turned[..., -2:-1, :]], 3).astype(c.dtype)


def _cut(force, slopes):
    """|F| cut to mu N, with a rounded corner."""
    size = np.hypot(force[:, 0], force[:, 1])
    over = size - (1.0 - ROUND)
    if not (over > 0.0).any():
        return force, slopes
    t = np.where(over > 0.0, size, 1.0)
    rounded = np.where(over < 2.0 * ROUND, t - over**2 / (4.0 * ROUND), 1.0)
    slope = np.where(over < 2.0 * ROUND, 1.0 - over / (2.0 * ROUND), 0.0)
    factor = np.where(over > 0.0, rounded / t, 1.0)
    change = np.where(over > 0.0, (slope - factor) / t**2, 0.0)
    inner = np.einsum("mi,mij->mj", force[:, :2], slopes[:, :2])
    tangential = factor[:, None, None] * slopes[:, :2] + change[:, None, None] * force[:, :2, None] * inner[:, None, :]
    return (
        np.concatenate([factor[:, None] * force[:, :2], force[:, 2:]], 1),
        np.concatenate([tangential, slopes[:, 2:]], 1),
    )


def _need_contacts(cases):
    """Raises Error for arguments that no contact has."""
    _, a, b, *_, shear, poisson, mu = cases
    if not np.isfinite(cases).all():
        raise Error("creep forces: an argument is not finite: check load, half axes, creepages, friction and material")
    if not ((a > 0.0).all() and (b > 0.0).all() and (shear > 0.0).all()):
        raise Error("creep forces: half axes (m) and shear modulus (Pa) must be above 0")
    if not ((poisson >= 0.0).all() and (poisson <= 0.5).all() and (mu >= 0.0).all()):
        raise Error("creep forces: expected Poisson's ratios from 0 to 0.5 and coefficients of friction of 0 or more")


def _parsed(path, data):
    """Range, Poisson's ratio, scales, linear theory, rests, steps, cells and error of a file's bytes."""
    if data[:8] != MAGIC:
        raise Error(f"{path}: no table of creep forces: make one with make creep-table")
    if len(data) < 40:
        raise Error(f"{path}: the file is cut off: make it again with make creep-table")
    version, mark, *n, cells, _ = np.frombuffer(data, HEADER, 8, 8).tolist()
    if version != VERSION or mark != MARK:
        raise Error(f"{path}: a table of version {version}, expected {VERSION}: make it again with make creep-table")
    count = int(np.prod(n, dtype=object)) * 3
    sizes = 7 * 8, n[0] * 144, n[0] * n[1] * 12, (count + 1) // 2 * 4
    if min(n) < LEAST or len(data) != 48 + sum(sizes):
        raise Error(f"{path}: {len(data)} bytes, expected {48 + sum(sizes)}: the file is cut off: make it again")
    if int.from_bytes(data[-8:], "little") != checksum(data[:-8]):
        raise Error(f"{path}: the checksum differs: the file is damaged: make it again with make creep-table")
    numbers = np.frombuffer(data, NUMBERS, 7, 40).tolist()
    scales, linear = np.frombuffer(data, NUMBERS, n[0] * 18, 40 + sizes[0]).reshape(2, n[0], 3, 3)
    steps = np.frombuffer(data, "<f4", sizes[2] // 4, 40 + sum(sizes[:2])).reshape(n[0], n[1], 3)
    forces = np.frombuffer(data, "<i2", count, 40 + sum(sizes[:3])).reshape(*n, 3)
    ends = float(np.exp(numbers[0])), float(np.exp(numbers[1]))
    return ends, numbers[2], scales, linear, forces, steps, cells, tuple(numbers[3:])
