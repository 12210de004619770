"""The coefficient of wear from the profile of a scar.

The depth of a scar depends on the product of coefficient and cycles only, where all else of the test is known and
the surfaces slide: one wear simulation with outputs over its cycles is the whole family of scars. What is found is the
member of the family, a shift along x, and height and tilt of the unworn surface. A profile that is deeper or shallower
than all of the family is none of its members: another simulation begins from the volume, since k = V/(P s) of load P
and path s, where the family has P s. The error of the cells, steps and jumps of the family is part of the
deviation: half of what a second, coarser family changes (families.py).

Residuals of neighbouring points of a profile are not independent: with their correlation r, deviations are larger by
sqrt((1 + r)/(1 - r)). Where they are correlated over most of the scar, its shape is not that of the family: of profiles
with roughness of 10 to 20 um in length 18 to 50 independent points were left, of those of another radius 5 to 11.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ...core.brief import brief
from ...core.errors import Error
from . import least
from .families import MOST, AtEdge, Family, family, with_second
from .loop import FLOOR, noise_of
from .push import options_of

EDGE = 0.02  # of the depth: where a scar ends
WIDENINGS = 6  # families at most, until one has the scar
FAR = 2.0  # the volume over that of the family from which on that has no scar like the profile
BEYOND = 1000.0  # the most that the start of the next one changes by, by the volume,
SMALLER = 30.0  # and where the grid is too narrow for a first scar
END = 0.01  # relative distance from the end of a range, within which a number is at it
INDEPENDENT = 3.0  # independent points for each parameter, below which residuals are correlated over the scar
MATTERS = 0.02  # misfit over depth, below which that does not matter
BY_GRID = 0.5  # of what a second grid changes: of four shapes the errors were 0.1 to 0.4 of it
HELD = 0.5  # deviation over the coefficient, above which that is not identifiable
FLAT = 1e-9  # height over the largest, below which a profile without noise is level
NONE = 3.0  # deviations of its volume, below which a profile without a coefficient has no scar
RISES = 5.0  # times the noise of its ends by which a profile lies above the line through them, if it is no scar
SIDES = 3  # points beyond the scar, on each side, that hold the height of the unworn surface


@brief
@dataclass(frozen=True)
class Scar:
    """The fit of a profile.

    Attributes
    ----------
    coefficient, coefficient_sd : float
        Archard's, of the body, 1/Pa; NaN where the profile does not hold it. The deviation has the noise of the profile
        and the error of the grid.
    shift, offset, tilt : float
        m, m, 1.
    misfit : float
        Root mean square of the residuals, m.
    neighbours : float
        Correlation of neighbouring residuals.
    x, height, curve : ndarray
        The points, and the fit at them, m.
    end : int
        1 of a profile that is deeper than all scars of the family, -1 of one that is shallower, else 0.
    doubt : str
        Why there is no coefficient, and what to do; empty if there is one.
    by_noise, by_grid : float
        Parts of the deviation, relative to the coefficient; by_grid is NaN where the family has no second grid.
    warning : str
        What makes the coefficient and its deviation doubtful; empty if nothing does.
    """

    coefficient: float
    coefficient_sd: float
    shift: float
    offset: float
    tilt: float
    misfit: float
    neighbours: float
    x: np.ndarray
    height: np.ndarray
    curve: np.ndarray
    end: int = 0
    doubt: str = ""
    by_noise: float = np.nan
    by_grid: float = np.nan
    warning: str = ""


@dataclass(frozen=True)
class _Best:
    """The best of a family's scars: scipy's result, its bounds and curve, and its residuals, m."""

    found: Any
    low: np.ndarray
    high: np.ndarray
    curve: np.ndarray
    depth: np.ndarray
    residuals: np.ndarray

    @property
    def end(self):
        """1 at the deepest scar, -1 at the shallowest, else 0."""
        return int(self.found.x[0] > self.high[0] - END) - int(self.found.x[0] < self.low[0] + END)

    @property
    def beside(self):
        """True if place, height or tilt are at the end of their range."""
        return bool(np.any((self.found.x > self.high - END)[1:] | (self.found.x < self.low + END)[1:]))


def _correlation(residuals, count):
    """Correlation of neighbours, without what a fit of so many parameters takes of it: of white noise it leaves
    -count/n, of correlated noise (measured on twins) 1.5 count/n of r more."""
    part = count / len(residuals)
    return min(0.99, (least.neighbours([residuals]) + part) / (1.0 - 1.5 * part))


def fit_scar(one: Family, x: ArrayLike, height: ArrayLike, tilt: bool = True, level: bool = True) -> Scar:
    """Fits a profile.

    Parameters
    ----------
    one : Family
    x, height : array_like
        (n,), m; a scar is negative.
    tilt, level : bool
        Whether the unworn surface may be inclined, and at any height; else the heights are those over it.

    Returns
    -------
    Scar

    Raises
    ------
    Error
        If the profile has no unworn surface on both sides of the scar, which depth and height of the surface need, or
        rises where the scar should be.
    """
    x, height = _sound(x, height, level)
    best = _best(one, x, height, tilt, level)
    worn = np.flatnonzero(best.depth > EDGE * best.depth.max())
    if not best.end and level and (worn.size < SIDES or worn[0] < SIDES or worn[-1] > len(x) - 1 - SIDES):
        raise Error(
            "the profile has no unworn surface on both sides of the scar: depth and height of it are one number"
        )
    scale, width, found = float(np.ptp(height)), float(np.ptp(one.x)), best.found.x
    neighbours = _correlation(best.residuals, len(found))
    noise = _by_noise(best, neighbours)
    second = _best(one.second, x, height, tilt, level) if one.second else None
    grid = BY_GRID * float(abs(found[0] - second.found.x[0])) if second else np.nan
    relative = float(np.hypot(noise, np.nan_to_num(grid)))
    doubt = _doubt(one, best, x, height, level, noise, grid)
    warning = "" if doubt else _warning(best, second, neighbours, FLOOR * scale)
    coefficient = float("nan") if doubt else float(np.exp(found[0])) / one.life
    return Scar(
        coefficient, coefficient * relative, float(found[1] * width), float(found[2] * scale) if level else 0.0,
        float(found[3] * scale / width) if len(found) == 4 else 0.0, float(np.sqrt(np.mean(best.residuals**2))),
        neighbours, x, height, best.curve, best.end, doubt, noise, grid, warning,
    )  # fmt: skip


def _best(one, x, height, tilt, level):
    """The best of the scars of a family for a profile."""
    scale, width, middle = float(np.ptp(height)), float(np.ptp(one.x)), float(np.mean(x))
    product, place = _begin(one, x, height, level)
    count = 2 + level + (level and tilt)

    def curve(values):
        line = values[2] * scale if level else 0.0
        if count == 4:
            line = line + values[3] * scale / width * (x - middle)
        return line - one.at(np.exp(values[0]), x - values[1] * width)

    low = np.array([np.log(one.product[0]), place / width - 0.5, -5.0, -5.0][:count])
    high = np.array([np.log(one.product[-1]), place / width + 0.5, 5.0, 5.0][:count])
    firsts = (0.3 * one.product[-1] / MOST, one.product[-1] / MOST, product)
    starts = ([np.log(first), place / width, np.median(height) / scale, 0.0][:count] for first in firsts)
    found = least.fit(
        lambda values: (curve(values) - height) / scale,
        (np.clip(start, low + 1e-6, high - 1e-6) for start in starts),
        bounds=(low, high),
    )
    depth, fitted = one.at(np.exp(found.x[0]), x - found.x[1] * width), curve(found.x)
    return _Best(found, low, high, fitted, depth, height - fitted)


def _by_noise(best, neighbours):
    """Deviation of the coefficient over it by the noise of the profile, of which fewer points than all are independent:
    by the correlation of neighbours, or by that of all points, whichever leaves fewer."""
    count = len(best.residuals)
    variance = 2.0 * best.found.cost / max(1, count - len(best.found.x))
    widened = (1.0 + max(neighbours, 0.0)) / (1.0 - min(neighbours, 0.99))
    return float(np.sqrt(variance * max(widened, count / _points(best.residuals))) * least.bands(best.found.jac).sd[0])


def _warning(best, second, neighbours, floor):
    """Warning of residuals that are neither white noise nor the error of the grid; else empty."""
    misfit = float(np.sqrt(np.mean(best.residuals**2)))
    by_grid = float(np.sqrt(np.mean((best.curve - second.curve) ** 2))) if second else 0.0
    correlated = least.correlated(neighbours, misfit / np.hypot(max(noise_of(best.residuals), floor), by_grid))
    return correlated and (
        f"{correlated}: the model does not describe the profile, which is {1e6 * misfit:.3g} um off, and not by white "
        "noise; the deviation has no error of the model: look at radii, load, stroke and --split, and leave out debris"
    )


def _line(x, height, level):
    """Heights of the line through the ends of a profile, and of how many points each end is."""
    outer = max(SIDES, len(x) // 10)
    ends = [(np.mean(values[:outer]), np.mean(values[-outer:])) for values in (x, height)]
    return np.interp(x, *ends) if level else np.zeros(len(x)), outer


def _sound(x, height, level):
    """A profile in the order of its x; raises Error where it is none, or rises where the scar should be."""
    x, height = (np.asarray(values, dtype=float) for values in (x, height))
    if x.ndim != 1 or x.shape != height.shape or len(x) <= 2 * SIDES or not np.isfinite([x, height]).all():
        raise Error(
            f"the profile: expected x and as many heights, finite numbers, of more than {2 * SIDES} points: leave out "
            "lost ones"
        )
    x, height = x[np.argsort(x)], height[np.argsort(x)]
    line, outer = _line(x, height, level)
    noise = np.sqrt(0.5 * np.mean(np.diff(height) ** 2) / outer)
    if np.ptp(height - line) <= FLAT * np.max(np.abs(height), initial=0.0):
        raise Error("it has no scar: all heights are the same: measure where the contact was, or after more cycles")
    if np.mean(height - line) > RISES * noise:
        raise Error(
            f"the profile rises between its ends, by up to {1e6 * np.max(height - line):.3g} um, and a scar is "
            "negative: are these depths? Reverse the sign of the heights"
        )
    return x, height


def _begin(one, x, height, level):
    """Coefficient times cycles by the volume of a profile below the line through its ends, and its shift by the middle
    of its lower half."""
    line, _ = _line(x, height, level)
    deep = one.depth[-1] - 0.5 * one.depth[-1].max()
    lower = np.clip(line - height - 0.5 * np.max(line - height), 0.0, None)
    place = np.average(x, weights=lower) if lower.any() else 0.0
    volume, most = np.trapezoid(line - height, x), np.trapezoid(one.depth[-1], one.x)
    product = max(volume / most, 1e-9) * one.product[-1]
    return float(product), float(place - np.average(one.x, weights=np.clip(deep, 0.0, None)))


def _points(residuals):
    """How many of the residuals are independent: all over the sum of the correlations up to the first that is none."""
    centred, count = residuals - residuals.mean(), len(residuals)
    correlation = np.correlate(centred, centred, "full")[count - 1 :] / max(float(np.sum(centred**2)), 1e-300)
    last = int(np.argmax(correlation <= 0.0)) or count
    return count / float(1.0 + 2.0 * np.sum(correlation[1:last]))


def _doubt(one, best, x, height, level, noise, grid):
    """Why the profile does not hold the coefficient, and what to do; empty if it does."""
    low, high = (one.product[k] / one.life for k in (0, -1))
    count, depth, end = len(best.found.x), float(best.depth.max()), best.end
    if (end < 0 or noise > HELD) and _flat(x, height, level):
        return (
            f"it has no scar: the volume below the line through its ends is that of noise of "
            f"{1e6 * noise_of(height):.2g} um: measure where the contact was, or after more cycles"
        )
    if end > 0 and not one.whole:
        return f"it is deeper than the deepest scar on the grid, of {high:.3g} 1/Pa: give a wider -grid_size"
    if end:
        return (
            f"it is {'deeper' if end > 0 else 'shallower'} than all scars from {low:.3g} to {high:.3g} 1/Pa: give a "
            f"{'larger' if end > 0 else 'smaller'} -wear_coefficient{one.body}, and look at units, heights and cycles"
        )
    if best.beside:
        return "its place, height or tilt is not found: give a profile with one scar, and its unworn surface level"
    points = _points(best.residuals)
    if points < INDEPENDENT * count and np.sqrt(np.mean(best.residuals**2)) > MATTERS * depth:
        return (
            f"its shape is not that of the contact's scar: residuals are correlated over most of it ({points:.2g} "
            f"independent points for {count} parameters): look at radii, load, stroke and the ratio of both "
            "coefficients (--split), and leave out debris"
        )
    if noise > HELD:
        return f"its noise leaves a deviation of {100 * noise:.2g} %: average several profiles"
    if grid > HELD:
        return f"the error of the grid is {100 * grid:.2g} %: give a larger -grid_n"
    return ""


def _flat(x, height, level):
    """True if the volume of a profile below the line through its ends is that of its noise."""
    line, outer = _line(x, height, level)
    deviation = noise_of(height) * np.ptp(x) * np.sqrt(1.0 / len(x) + (0.5 / outer if level else 0.0))
    return bool(np.trapezoid(line - height, x) < NONE * deviation)


def fit_profile(
    shape: Union[str, os.PathLike],
    life: float,
    x: ArrayLike,
    height: ArrayLike,
    body: str = "2",
    options: Optional[Mapping] = None,
    one: Optional[Family] = None,
) -> tuple[Scar, Family]:
    """Fits a profile by wear simulations whose scars are deep and shallow enough for it.

    Parameters
    ----------
    shape, life, body, options
        See family().
    x, height : array_like
        (n,), m; a scar is negative.
    one : Family, optional
        To begin with, of the same shape and options.

    Returns
    -------
    tuple
        The Scar, and the Family that it is of.

    Raises
    ------
    Error
        See family() and fit_scar().
    """
    start, (x, height) = None, _sound(x, height, True)
    small, large = 0.0, np.inf  # starts whose scars are too shallow, and too deep
    for left in range(WIDENINGS - 1, -1, -1):
        try:
            used = one or family(shape, life, body, options, start)
        except AtEdge:
            if not left:
                raise
            large = start or float(options_of(shape)[f"wear_coefficient{body}"])
            start = _between(small, large / SMALLER, large)
            continue
        product = _begin(used, x, height, True)[0]
        way = _way(used, x, height, product)
        if not left or not way or way > 0 and not used.whole:
            scar = fit_scar(used, x, height)
            way = 0 if _lost(used, x, height) else scar.end
            if not left or not way or way > 0 and not used.whole:
                break
        small, large = (used.start, large) if way > 0 else (small, used.start)
        part = product / life / used.start
        part = float(np.clip(part, *((2.0, BEYOND) if way > 0 else (1.0 / BEYOND, 0.25))))
        start, one = _between(small, part * used.start, large), None
    if used.second or scar.doubt:
        return scar, used
    used = with_second(used, shape, options)
    scar = fit_scar(used, x, height)
    if not used.second:
        unknown = "the deviation has no error of the grid, since half its cells have no solution: give a larger -grid_n"
        scar = replace(scar, warning="; ".join(one for one in (scar.warning, unknown) if one))
    return scar, used


def _between(small, start, large):
    """A start, or the middle of the two that it should be between."""
    return start if small < start < large else float(np.sqrt(small * large))


def _way(one, x, height, product):
    """Where the volume of a profile is: 1 far beyond the deepest scar, -1 far below the shallowest, else 0. Far from
    the profile all scars of a family are equally bad, and the best of them tells nothing."""
    if _lost(one, x, height):
        return 0
    return int(product > FAR * one.product[-1]) - int(product < one.product[0] / FAR)


def _lost(one, x, height):
    """True if a profile is no deeper than its noise, and the family has scars that are lost in it."""
    return bool(one.depth[0].max() < noise_of(height)) and _flat(x, height, True)


@brief
@dataclass(frozen=True)
class Split:
    """How the wear is divided between the bodies, from the shape of one body's scar.

    Attributes
    ----------
    ratio, ratio_sd : float
        Coefficient of the other body over that of this one; NaN where the shape does not hold it.
    ratios, misfits : ndarray
        Tried ratios, and the root mean square of the residuals of each, m.
    scar : Scar
        The fit at the best of them.
    doubt : str
        Why there is no ratio, and what to do; empty if there is one.
    """

    ratio: float
    ratio_sd: float
    ratios: np.ndarray
    misfits: np.ndarray
    scar: Scar
    doubt: str = ""


RATIOS = (0.02, 0.25, 0.5, 0.75, 1.0, 1.25)
MOST_RATIO, GROWS = 40.0, 1.6  # the largest ratio that is tried, and by what the next one is larger


def split(
    shape: Union[str, os.PathLike],
    life: float,
    x: ArrayLike,
    height: ArrayLike,
    body: str = "2",
    ratios: Sequence[float] = RATIOS,
) -> Split:
    """Fits a profile for several ratios of the bodies' coefficients: where surfaces move past each other, the width of
    the scar of one tells of the wear of the other.

    Parameters
    ----------
    shape, life, body
        See family().
    x, height : array_like
        (n,), m; a scar is negative.
    ratios : sequence of float
        Coefficient of the other body over that of this one; three or more, rising. Larger ones follow while the fit
        gets better.

    Returns
    -------
    Split
    """
    own = float(options_of(shape)[f"wear_coefficient{body}"])
    other = "wear_coefficient" + ("1" if body == "2" else "2")
    tried = list(ratios)
    found: list[Scar] = []
    second: list[float] = []  # misfits on the second grid
    while len(found) < len(tried):
        scar, one = fit_profile(shape, life, x, height, body, {other: tried[len(found)] * own})
        found.append(scar)
        if one.second:
            residuals = _best(one.second, scar.x, scar.height, True, True).residuals
            second.append(float(np.sqrt(np.mean(residuals**2))))
        misfits = np.array([scar.misfit for scar in found])
        if len(found) == len(tried) and misfits.argmin() == len(tried) - 1 and tried[-1] < MOST_RATIO:
            tried.append(GROWS * tried[-1])
    scar = found[int(np.argmin(misfits))]
    best, deviation = _lowest(tried, misfits, scar)
    if len(second) == len(found):
        deviation = float(np.hypot(deviation, BY_GRID * (best - _lowest(tried, np.array(second), scar)[0])))
    doubt = _doubt_of_ratio(best, deviation, tried, scar)
    if doubt:
        best = deviation = np.nan
    return Split(best, deviation, np.array(tried), misfits, scar, doubt)


def _lowest(tried, misfits, scar):
    """The ratio of least misfit by the parabola of the mean square about it, and its deviation by the noise; NaN where
    there is none."""
    k = int(np.clip(np.argmin(misfits), 1, len(misfits) - 2))
    curve = np.polyfit(tried[k - 1 : k + 2], misfits[k - 1 : k + 2] ** 2, 2)
    if not curve[0] > 0.0:
        return np.nan, np.nan
    best = float(-curve[1] / (2.0 * curve[0]))
    points = len(scar.x) * (1.0 - min(scar.neighbours, 0.99)) / (1.0 + max(scar.neighbours, 0.0))
    points = max(1.0, points - 4.0)  # independent ones, less those that the fit takes
    return best, float(np.sqrt(max(float(np.polyval(curve, best)), 0.0) / (points * curve[0])))


def _doubt_of_ratio(best, deviation, ratios, scar):
    """Why the shape of a scar does not hold the ratio; empty if it does."""
    if scar.doubt:
        return scar.doubt
    if best <= ratios[0]:
        most = max(best, 0.0) + 2.0 * deviation
        return f"the best one is the least that was tried: at most {most:.2g} (95 %): measure the other body's scar"
    if not best < ratios[-1]:
        return f"no minimum up to {ratios[-1]:.2g}: measure the other body's scar"
    if not deviation < best:
        return f"the shape does not hold it: at most {best + 2.0 * deviation:.2g} (95 %): measure the other body's scar"
    return ""
