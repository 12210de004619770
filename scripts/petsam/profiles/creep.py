"""Creep forces of elliptic contacts from a table: CreepTable, with the file and the numbers of include/petsam/creep.h.

Axes of the table: log(a/b), and the scaled creepages (X, Y, Z) in spherical coordinates,

    X = C11 xi'/3, Y = C22 eta'/3, Z = hypot(C23/1.5, sqrt(b/a) C11/3) phi',
    v = R/(1 + R) with R = |(X, Y, Z)|, alpha = atan2(Y, X), beta = atan2(Z, hypot(X, Y)),

with xi' = G c^2 xi/(mu N), phi' = G c^3 phi/(mu N), c^2 = a b, and Kalker's coefficients C11, C22, C23. The table has
Fx/(mu N), Fy/(mu N), Mz/(mu N c), over v: at v = 0 linear theory, at v = 1 full sliding. It holds the coefficients of
cubic splines, whose value takes four of them along each axis, and whose first two derivatives are continuous. Across
the ends of alpha and beta they are continued by the symmetries; at the ends of a/b and v by the third derivative.

File, little-endian: the bytes PETSAMCF; version, byte order mark, four numbers of nodes, cells, 0 (8 uint32); first and
last log(a/b), Poisson's ratio, own error (median, 90 %, worst, over mu N) and the number of its cases (7 float64);
splines of log C11, C22, C23 (nodes of a/b, 3 values of Poisson's ratio, 3; float64); those of the forces (nodes of a/b,
v, alpha, beta, 3; float32); a checksum of all before (FNV-1a over words of 4 bytes, uint64).
"""

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import Error, MissingFile

MAGIC, VERSION, MARK = b"PETSAMCF", 1, 0x01020304
HEADER, NUMBERS = np.dtype("<u4"), np.dtype("<f8")
LEAST = 4  # nodes along an axis
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
    coefficients : ndarray
        Splines of the forces over v, (nodes of a/b, v, alpha, beta, 3), float32.
    cells : int
        Cells along an axis of the grids that it is made with.
    error : tuple of float
        Error of the forces of its nodes, over mu N (Mz: mu N c): median, 90 %, worst, and the number of cases.
    """

    range: tuple[float, float]
    poisson: float
    scales: np.ndarray
    coefficients: np.ndarray
    cells: int = 0
    error: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_full", continued(self.coefficients))

    @classmethod
    def open(cls, path: Union[str, "os.PathLike[str]"]) -> "CreepTable":
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

    def write(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the table to a file.

        Parameters
        ----------
        path : path
            The file.
        """
        n = self.coefficients.shape[:4]
        head = np.array([VERSION, MARK, *n, self.cells, 0], HEADER)
        numbers = np.array([*np.log(self.range), self.poisson, *self.error], NUMBERS)
        data = MAGIC + head.tobytes() + numbers.tobytes() + self.scales.astype(NUMBERS).tobytes()
        data += self.coefficients.astype("<f4").tobytes()
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
        place = self._place(ratio)
        sx = np.where(vector[:, 0] < 0.0, -1.0, 1.0)
        sz = np.where(vector[:, 2] < 0.0, -1.0, 1.0)
        signs = np.stack([sx, sz, sz], -1)
        inside = signs * vector
        radius = np.sqrt(np.einsum("mi,mi->m", inside, inside))
        force, slopes = np.empty_like(inside), np.empty((len(inside), 3, 3))
        far = radius > ORIGIN
        force[far], slopes[far] = self._curved(place[far], inside[far], radius[far])
        if not far.all():
            slopes[~far] = self._linear(place[~far])
            force[~far] = np.einsum("mij,mj->mi", slopes[~far], inside[~far])
        force, slopes = _cut(force, slopes)
        return signs * force, signs[:, :, None] * slopes * signs[:, None, :]

    def _linear(self, place):
        """The derivative of the forces at the origin."""
        ends = np.array([[0.0, 0.0], [0.5 * np.pi, 0.0], [0.0, 0.5 * np.pi]])
        zero = np.zeros_like(place)
        return np.stack([self._splines(place, zero, zero + x, zero + y)[0] for x, y in ends], -1)

    def _curved(self, place, inside, radius):
        x, y, z = inside.T
        h = np.hypot(x, y)
        alpha = np.arctan2(y, x)
        polar = h < POLE * radius
        px, py = x, y
        if polar.any():
            h = np.where(polar, POLE * radius, h)
            px, py = np.where(polar, h * np.cos(alpha), x), np.where(polar, h * np.sin(alpha), y)
            radius = np.sqrt(px * px + py * py + z * z)
        v = radius / (1.0 + radius)
        f, fv, fa, fb = self._splines(place, v, alpha, np.arctan2(z, h))
        along = (f + v[:, None] * fv) / (radius * (1.0 + radius) ** 2)[:, None]
        zero = np.zeros_like(h)
        turn = np.stack([-py, px, zero], -1) / (h * h)[:, None]
        rise = np.stack([-z * px, -z * py, h * h], -1) / (h * radius**2)[:, None]
        slopes = along[:, :, None] * np.stack([px, py, z], -1)[:, None, :] + v[:, None, None] * (
            fa[:, :, None] * turn[:, None, :] + fb[:, :, None] * rise[:, None, :]
        )
        force = v[:, None] * f
        if polar.any():
            force = force + slopes[:, :, 0] * (x - px)[:, None] + slopes[:, :, 1] * (y - py)[:, None]
        return force, slopes

    def _splines(self, place, v, alpha, beta):
        """Values, and derivatives by v, alpha, beta, each (m, 3)."""
        n = self.coefficients.shape
        steps = n[1] - 1.0, (n[2] - 1.0) / np.pi, (n[3] - 1.0) / (0.5 * np.pi)
        i, wi, _ = basis(place, n[0], False)
        j, wj, dj = basis(np.clip(v * steps[0], 0.0, n[1] - 1.0), n[1], False)
        k, wk, dk = basis(np.clip((alpha + 0.5 * np.pi) * steps[1], 0.0, n[2] - 1.0), n[2], True)
        m, wm, dm = basis(np.clip(beta * steps[2], 0.0, n[3] - 1.0), n[3], True)
        four = np.arange(4)
        found = self._full[
            (i[:, None] + four)[:, :, None, None, None], (j[:, None] + four)[:, None, :, None, None],
            (k[:, None] + four)[:, None, None, :, None], (m[:, None] + four)[:, None, None, None, :],
        ].astype(float)  # fmt: skip
        found = np.einsum("qi,qijkmc->qjkmc", wi, found)
        by, db = np.einsum("qm,qjkmc->qjkc", wm, found), np.einsum("qm,qjkmc->qjkc", dm, found)
        both, da = np.einsum("qk,qjkc->qjc", wk, by), np.einsum("qk,qjkc->qjc", dk, by)
        db = np.einsum("qj,qk,qjkc->qc", wj, wk, db)
        value, dv = np.einsum("qj,qjc->qc", wj, both), np.einsum("qj,qjc->qc", dj, both)
        return value, steps[0] * dv, steps[1] * np.einsum("qj,qjc->qc", wj, da), steps[2] * db


def continued(coefficients: np.ndarray) -> np.ndarray:
    """Coefficients with one more at each end of alpha and beta, by the symmetries.

    Parameters
    ----------
    coefficients : ndarray
        (nodes of a/b, v, alpha, beta, 3).

    Returns
    -------
    ndarray
        (nodes of a/b, v, alpha + 2, beta + 2, 3).
    """
    across, below, above = np.array([-1, 1, 1]), np.array([1, -1, -1]), np.array([-1, 1, 1])
    c = coefficients
    c = np.concatenate([across * c[:, :, 1:2], c, across * c[:, :, -2:-1]], 2)
    turned = c[:, :, ::-1]  # alpha -> -alpha
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
    """Range, Poisson's ratio, scales, coefficients, cells and error of a file's bytes."""
    if data[:8] != MAGIC:
        raise Error(f"{path}: no table of creep forces: make one with make creep-table")
    if len(data) < 40:
        raise Error(f"{path}: the file is cut off: make it again with make creep-table")
    version, mark, *n, cells, _ = np.frombuffer(data, HEADER, 8, 8).tolist()
    if version != VERSION or mark != MARK:
        raise Error(f"{path}: a table of version {version}, expected {VERSION}: make it again with make creep-table")
    sizes = 7 * 8, n[0] * 72, int(np.prod(n, dtype=object)) * 12
    if min(n) < LEAST or len(data) != 48 + sum(sizes):
        raise Error(f"{path}: {len(data)} bytes, expected {48 + sum(sizes)}: the file is cut off: make it again")
    if int.from_bytes(data[-8:], "little") != checksum(data[:-8]):
        raise Error(f"{path}: the checksum differs: the file is damaged: make it again with make creep-table")
    numbers = np.frombuffer(data, NUMBERS, 7, 40).tolist()
    scales = np.frombuffer(data, NUMBERS, n[0] * 9, 40 + sizes[0]).reshape(n[0], 3, 3)
    forces = np.frombuffer(data, "<f4", sizes[2] // 4, 40 + sizes[0] + sizes[1]).reshape(*n, 3)
    return (float(np.exp(numbers[0])), float(np.exp(numbers[1]))), numbers[2], scales, forces, cells, tuple(numbers[3:])
