"""Wear of a wheel's profile by a spectrum of positions: the profile after a distance, by jumps, with an error estimate.

In each jump all positions of the spectrum are solved with the profile as it is; each point of the tread wears in each
revolution by the frictional work per area, summed along its way through the patches (energy), or by pressure times slip
(Archard). The depth of a jump is smoothed along the profile and taken off along its normal. The two wheels of
the wheelset wear alike, by the mean of both: the vehicle runs in both directions.

The error is the difference to the depth by half the jumps, as the depth of explicit jumps is of first order in them.
"""

from __future__ import annotations

import functools
import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Optional

import numpy as np
from scipy.interpolate import make_smoothing_spline

from ...contact.errors import NoEquilibrium
from ...core import tables
from ...core.brief import brief
from ...core.errors import Error, Unusable
from . import batch
from .equilibrium import Equilibrium
from .profile import Profile
from .section import path
from .spectrum import State

LAWS = ("energy", "archard")
CONE = 0.05  # rad: inclination of the tread
LINEAR = 3.0  # about G C11/E*: slope of the creep force of a round patch over E* a^2
POINT = 2e-4  # m: distance of the points of the worn profile
DEEPEST = 1e-4  # m that one jump may take off: deeper ones leave grooves that change the contact too much

MARGIN = 2.0  # of the estimate of the depth before anything is solved, which is 0.2 to 1 times the solved one
SAMPLE = 40  # positions of it, those of the greatest weights
LONGER = 4.0  # times as deep may the jumps be that only give the error


@dataclass(frozen=True)
class Law:
    """How a wheel wears: "energy", by volume per work of friction, or "archard", by volume per normal force and
    accumulated slip, with its coefficient (m3/J, or 1/Pa: the same unit). Waves of the worn depth of the length
    `wavelength` (m) are halved. Raises Error if a number or the name is none."""

    name: str = "energy"
    coefficient: float = 1e-14
    wavelength: float = 3e-3

    def __post_init__(self) -> None:
        if self.name not in LAWS:
            raise Unusable(f"law {self.name!r}: expected {' or '.join(LAWS)}")
        if not 0.0 < self.coefficient < 1e-6:
            raise Unusable(f"coefficient {self.coefficient:g}: expected m3/J or 1/Pa, such as 1e-14")
        if not 0.0 < self.wavelength < 0.05:
            raise Unusable(f"wavelength {self.wavelength:g}: expected m, such as 3e-3")


@brief
@dataclass(frozen=True, eq=False)
class Worn(tables.Tabled):
    """A wheel's profile after a distance.

    Attributes
    ----------
    new, worn : Profile
        The profiles before and after.
    depth : ndarray
        Worn depth along the normal at the new profile's points, (n,), m.
    error : ndarray
        Its estimated error, (n,), m; NaN without one.
    distance : float
        m.
    jumps : int
        Number of jumps.
    area : ndarray
        Worn area of the section over the distance, (jumps + 1,), m2.
    failures : list of str
        Positions without an equilibrium, which wear nothing.
    """

    new: Profile
    worn: Profile
    depth: np.ndarray
    error: np.ndarray
    distance: float
    jumps: int
    area: np.ndarray
    failures: list[str]

    @property
    def deepest(self) -> tuple[float, float]:
        """The maximum depth and its error, m."""
        k = int(np.argmax(self.depth))
        return float(self.depth[k]), float(self.error[k])

    def table(self) -> list[tables.Column]:
        """The profile before and after.

        Returns
        -------
        list of Column
            A row for each point.
        """
        rows = (
            ("y", "m", "new profile", self.new.y), ("z", "m", "new profile, down", self.new.z),
            ("worn_y", "m", "worn profile", self.worn.y), ("worn_z", "m", "worn profile, down", self.worn.z),
            ("depth", "m", "worn depth", self.depth), ("depth_error", "m", "its estimated error", self.error),
            ("depth_per_distance", "1", "worn depth per distance", self.depth / self.distance),
        )  # fmt: skip
        return [tables.Column(*row) for row in rows]


def rows_of(equilibrium: Equilibrium, law: str) -> list[tuple[np.ndarray, np.ndarray, float]]:
    """The wear load of each place of the profile in one revolution, by the name of a Law: of each patch y of the
    profile at its rows of cells (m), J/m2 or N/m there, and the wheel's circumference (m)."""
    found = []
    for result, radius in zip(equilibrium.wheels, equilibrium.radii):
        for patch in result.patches:
            found.append((patch.wheel_y, patch.worn[LAWS.index(law)], 2.0 * np.pi * radius))
    return found


def depth_rates(y: np.ndarray, rows: Sequence, coefficient: float) -> np.ndarray:
    """Worn depth per distance at places y (n,), m, of a profile, (n,), of the mean of both wheels, by the rows of
    rows_of() and a coefficient, m3/J or 1/Pa."""
    total = np.zeros_like(y)
    for places, work, around in rows:
        order = np.argsort(places)
        total += np.interp(y, places[order], work[order], left=0.0, right=0.0) / around
    return 0.5 * coefficient * total


def _dense(profile):
    """The profile with points at equal distances along it."""
    curve = path(profile)
    s = np.linspace(0.0, float(curve.x[-1]), int(np.ceil(float(curve.x[-1]) / POINT)) + 1)
    points = curve(s)
    return replace(profile, y=points[:, 0], z=points[:, 1], weights=None)


def _normals(profile):
    """Unit normals out of the wheel, (n, 2), and chord lengths, (n,), m."""
    s = profile.lengths
    tangent = np.column_stack([np.gradient(profile.y, s), np.gradient(profile.z, s)])
    tangent /= np.hypot(*tangent.T)[:, None]
    return np.column_stack([-tangent[:, 1], tangent[:, 0]]), s


def _smoothed(depth, s, wavelength):
    """Depths without short waves, none below 0."""
    found = make_smoothing_spline(s / wavelength, depth, w=np.gradient(s / wavelength), lam=1.0 / (2.0 * np.pi) ** 4)
    return np.maximum(found(s / wavelength), 0.0)


def shares(states: Sequence[State]) -> np.ndarray:
    """Shares of the distance, (n,), whose sum is 1, by the weights of a spectrum. Raises Unusable if a weight is below
    0 or not finite, or none is above 0; with the position, or its line."""
    weights = np.array([state.weight for state in states], dtype=float)
    for k, (weight, state) in enumerate(zip(weights, states), 1):
        if not 0.0 <= weight < np.inf:
            where = f"line {state.line}" if state.line else f"position {k}"
            raise Unusable(f"{where}: weight {weight:g}: expected a share of the distance, 0 or more")
    if not weights.sum() > 0.0:
        raise Unusable("column weight: all are 0, and nothing wears: give at least one above 0")
    return weights / weights.sum()


def estimate(vehicle: batch.Vehicle, states: Sequence[State], law: Law) -> float:
    """Worn depth per distance of the new profile, roughly, without a solution of a contact: of a round patch by Hertz
    under half the axle load, which creeps by yaw, half the rolling radius difference of rigid wheels over the mean
    radius, and the spin on a cone of 1:20: linear in it, and sliding beyond."""
    weights = shares(states)
    picked = np.argsort(-weights, kind="stable")[:SAMPLE]
    rate, radius = 0.0, vehicle.wheel.radius
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the vehicle: the solution issues them
        axle = vehicle.axle()
    with axle:
        for k in picked:
            position, force = states[k].position, 0.5 * states[k].load.vertical
            try:
                right, left = axle.rigid(position, share=1e-6).radii
            except Error:  # beside the rail: wears nothing
                continue
            half = (0.75 * force * radius / axle.settings.modulus) ** (1.0 / 3.0)
            creep = float(np.hypot((right - left) / (right + left), position.yaw)) + CONE / radius * half
            pull = min(LINEAR * axle.settings.modulus * half**2 * creep, _most_friction(vehicle) * force)
            rate += weights[k] * 0.5 * law.coefficient * pull * creep / (2.0 * half * 2.0 * np.pi * radius)
    return rate / float(weights[picked].sum())


def _most_friction(vehicle):
    """The coefficient of friction on the tread."""
    return float(vehicle.friction(0.0) if callable(vehicle.friction) else vehicle.friction)


def need_shallow(vehicle: batch.Vehicle, states: Sequence[State], distance: float, law: Law, jumps: int) -> None:
    """Raises Unusable, before anything is solved, if distance or jumps are none, or half the estimated depth of a jump
    is more than a jump may take off. See wear()."""
    if not 0.0 < distance < 1e10:
        raise Unusable(f"distance {distance:g}: expected m above 0, such as 1e8 (100,000 km)")
    if jumps < 2 or jumps % 2:
        raise Unusable(f"jumps {jumps}: expected an even number, 2 or more: half of them give the error")
    depth = estimate(vehicle, states, law) * distance
    if depth / jumps > MARGIN * DEEPEST:
        needed = 2 * math.ceil(0.5 * depth / DEEPEST)
        raise Unusable(
            f"jumps {jumps}: each takes off some {depth / jumps:.1g} m, where {DEEPEST:g} m can be followed: use at "
            f"least {needed}, or check the coefficient of wear ({law.coefficient:g} m3/J) and distance ({distance:g} m)"
        )


def wear(
    vehicle: batch.Vehicle,
    states: Sequence[State],
    distance: float,
    law: Law,
    jumps: int = 10,
    cores: int = 1,
    report: Optional[Callable[[int, int], object]] = None,
) -> Worn:
    """The wheel's profile after a distance.

    Parameters
    ----------
    vehicle : Vehicle
        Rails and wheels; of the left side those of the right one.
    states : sequence of State
        The spectrum; their weights are shares of the distance.
    distance : float
        m.
    law : Law
        How the wheel wears.
    jumps : int
        Even: half of them give the error.
    cores : int
        Processes.
    report : callable, optional
        Called with the numbers of jumps that are done, and of all.

    Returns
    -------
    Worn

    Raises
    ------
    Error
        If weights, distance or jumps are none, all positions fail, or a jump takes off too much.
    """
    weights = shares(states)
    if vehicle.left is not None:
        raise Unusable("wear: both wheels have one profile: leave the left one out")
    need_shallow(vehicle, states, distance, law, jumps)
    new, total = _dense(vehicle.wheel.profile), jumps + jumps // 2
    vehicle = replace(vehicle, wheel=replace(vehicle.wheel, profile=new))
    one = _Wear(vehicle, list(states), weights, law, cores)
    depth, area = one.run(distance, jumps, lambda k: report and report(k, total))
    half, _ = one.run(distance, jumps // 2, lambda k: report and report(jumps + k, total), LONGER * DEEPEST)
    return Worn(new, _off(new, depth), depth, np.abs(depth - half), distance, jumps, area, one.failures)


@brief
@dataclass(frozen=True)
class Rates(tables.Tabled):
    """The wear of a wheel's profile as it is: its points at equal distances, worn depth per distance at them, (n,), and
    the failures: positions without an equilibrium, which wear nothing."""

    failures: list[str]
    y: np.ndarray = tables.column("m", "of the profile")
    z: np.ndarray = tables.column("m", "down")
    depth_per_distance: np.ndarray = tables.column("1", "worn depth per distance")


def rates(vehicle: batch.Vehicle, states: Sequence[State], law: Law, cores: int = 1) -> Rates:
    """The Rates of the wheel's profile. See wear()."""
    weights = shares(states)
    new = _dense(vehicle.wheel.profile)
    one = _Wear(vehicle, list(states), weights, law, cores)
    depths = one.rates(new)
    return Rates(one.failures, new.y, new.z, depths)


def _off(profile, depth):
    """The profile with depths taken off along its normal."""
    normals, _ = _normals(profile)
    return replace(profile, y=profile.y - depth * normals[:, 0], z=profile.z - depth * normals[:, 1])


class _Wear:
    """Jumps over a distance."""

    def __init__(self, vehicle, states, shares, law, cores):
        self.vehicle, self.states, self.shares, self.law, self.cores = vehicle, states, shares, law, cores
        self.failures = []

    def run(self, distance, jumps, told, most=DEEPEST):
        """Depth at the points of the new profile, and worn area after each jump."""
        new = self.vehicle.wheel.profile
        depth, profile, areas = np.zeros(len(new.y)), new, [0.0]
        for k in range(1, jumps + 1):
            rates = _smoothed(self.rates(profile), new.lengths, self.law.wavelength)
            if rates.max() * distance / jumps > most:
                needed = 2 * int(np.ceil(rates.max() * distance / DEEPEST / 2.0))
                raise Unusable(
                    f"jumps {jumps}: jump {k} takes off {rates.max() * distance / jumps:.3g} m: use at least {needed}, "
                    "or check the coefficient of wear and the distance"
                )
            depth = depth + rates * distance / jumps
            profile = _off(new, depth)
            areas.append(float(np.sum(depth * np.gradient(new.lengths))))
            told(k)
        return depth, np.array(areas)

    def rates(self, profile):
        """Depth per distance at the points of a profile."""
        vehicle = replace(self.vehicle, wheel=replace(self.vehicle.wheel, profile=profile))
        found = batch.run(vehicle, self.states, self.cores, functools.partial(rows_of, law=self.law.name))
        if all(one.failure for one in found):
            text = f"no position of the spectrum has an equilibrium; of the first one: {found[0].failure}"
            raise NoEquilibrium(NoEquilibrium.code, text)
        self.failures += [f"position {k}: {one.failure}" for k, one in enumerate(found, 1) if one.failure]
        rates = np.zeros(len(profile.y))
        for one, share in zip(found, self.shares):
            if one.value:
                rates += share * depth_rates(profile.y, one.value, self.law.coefficient)
        return rates
