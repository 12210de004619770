"""The coefficient of wear from the profile of a scar.

The depth of a scar depends on the product of coefficient and cycles only, where all else of the test is known and
the surfaces slide: one wear simulation with outputs over its cycles is the whole family of scars. What is found is the
member of the family, a shift along x, and height and tilt of the unworn surface. A profile that is deeper or shallower
than all of the family is none of its members: another simulation begins from the volume, since k = V/(P s) of load P
and path s, where the family has P s.

Residuals of neighbouring points of a profile are not independent: with their correlation r, deviations are larger by
sqrt((1 + r)/(1 - r)). Where they are correlated over most of the scar, its shape is not that of the family: of profiles
with roughness of 10 to 20 um in length 18 to 50 independent points were left, of those of another radius 5 to 11.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ...core.brief import brief
from ...core.errors import Error
from . import least
from .push import options_of

OF_BODIES = ("wear_coefficient1", "wear_coefficient2")
OUTPUTS = 19  # scars of the family
FEWEST = 4  # of them, where the scar reaches the edge of the grid
LEAST, MOST = 0.05, 1.6  # their cycles relative to those of the test
EDGE = 0.02  # of the depth: where a scar ends
WIDENINGS = 6  # families at most, until one has the scar
BEYOND = 30.0  # the most that the start of the next one changes by
END = 0.01  # relative distance from the end of a range, within which a number is at it
INDEPENDENT = 3.0  # independent points for each parameter, below which residuals are correlated over the scar
MATTERS = 0.02  # misfit over depth, below which that does not matter
HELD = 0.5  # deviation over the coefficient, above which that is not identifiable
RISES = 5.0  # times the noise of its ends by which a profile lies above the line through them, if it is no scar
SIDES = 3  # points beyond the scar, on each side, that hold the height of the unworn surface


@brief
@dataclass(frozen=True)
class Family:
    """Scars of a body over the cycles.

    Parameters
    ----------
    x : ndarray
        (nx,), m.
    depth : ndarray
        (outputs, nx), m.
    product : ndarray
        (outputs,), coefficient times cycles, 1/Pa.
    life : float
        Cycles of the test.
    body : str
    """

    x: np.ndarray
    depth: np.ndarray
    product: np.ndarray
    life: float
    body: str

    def at(self, product: float, x: ArrayLike) -> np.ndarray:
        """Depth, linear between the outputs over the logarithm of the product.

        Parameters
        ----------
        product : float
            Coefficient of wear times cycles, 1/Pa.
        x : array_like
            (n,), m.

        Returns
        -------
        ndarray
            (n,), m.
        """
        place = np.interp(np.log(product), np.log(self.product), np.arange(len(self.product)))
        k = min(int(place), len(self.product) - 2)
        part = place - k
        line = (1.0 - part) * self.depth[k] + part * self.depth[k + 1]
        return np.interp(x, self.x, line, left=0.0, right=0.0)


@brief
@dataclass(frozen=True)
class Scar:
    """The fit of a profile.

    Attributes
    ----------
    coefficient, coefficient_sd : float
        Archard's, of the body, 1/Pa; NaN where the profile does not hold it.
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


class _AtEdge(Error):
    """A scar that reaches the edge of the grid too early."""


def family(
    shape: Union[str, os.PathLike],
    life: float,
    body: str = "2",
    options: Optional[Mapping] = None,
    start: Optional[float] = None,
) -> Family:
    """The scars of a body by one wear simulation.

    Parameters
    ----------
    shape : path
        Options of petsam with the load, friction, -history of a cycle and -wear_coefficient1 and -wear_coefficient2:
        their ratio is kept, and the body's own is the start.
    life : float
        Cycles of the test.
    body : str
        "1" or "2".
    options : mapping, optional
        Further options of petsam.
    start : float, optional
        Instead of the body's own coefficient, 1/Pa; the other one's changes alike.

    Returns
    -------
    Family

    Raises
    ------
    Error
        If the body does not wear, the contact is no row of cells, or petsam cannot simulate the wear.
    """
    from ...contact.running import run

    given = {**{name: value or True for name, value in options_of(shape).items()}, **(options or {})}
    name = f"wear_coefficient{body}"
    if not float(given.get(name, 0.0)) > 0.0:
        raise Error(f"{shape}: -{name} is missing: a value from which the fit begins")
    if not str(given.get("elasticity", "")).startswith("plane"):
        raise Error(f"{shape}: profiles are of contacts in plane strain: -elasticity plane")
    factor = start / float(given[name]) if start else 1.0
    given.update({one: factor * float(given[one]) for one in OF_BODIES if one in given})
    parts = np.unique(np.round(life * np.geomspace(LEAST, MOST, OUTPUTS)))
    given.update(wear_cycles=parts[-1], wear_output=parts[:-1].tolist(), output_every=10**6)
    given.pop("output", None)
    results, whole = _simulated(run, given)
    with results:
        depth = [results.field(f"wear_depth{body}", k).reshape(-1) for k in range(len(results.steps))]
        x = np.asarray(results.x)
    if not whole:  # the last one is that of the step at the edge
        depth = depth[:-1]
        parts = parts[: len(depth)]
    if len(depth) != len(parts) or len(parts) < FEWEST:
        ended = f"{shape}: the simulation ended after {len(depth)} of {OUTPUTS} outputs"
        raise Error(ended) if whole else _AtEdge(f"{ended}, at the edge of the grid: give a wider -grid_size")
    return Family(x, np.array(depth), float(given[name]) * parts, life, body)


def _simulated(run, given):
    """Results of a wear simulation, and whether it has reached its end; else the scar has reached the grid's edge."""
    from ...contact.errors import EdgeContact

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return run(given), True
        except EdgeContact as error:
            if error.results is None:
                raise _AtEdge(f"{error}") from error
            return error.results, False


def _correlation(residuals, count):
    """Correlation of neighbours, without what a fit of so many parameters takes of it: of white noise it leaves
    -count/n, of correlated noise (measured on twins) 1.5 count/n of r more."""
    centred, part = residuals - residuals.mean(), count / len(residuals)
    raw = float(np.sum(centred[1:] * centred[:-1]) / max(np.sum(centred**2), 1e-300))
    return min(0.99, (raw + part) / (1.0 - 1.5 * part))


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
    scale = float(np.ptp(height))
    width = float(np.ptp(one.x))
    middle = float(np.mean(x))
    product, place = _begin(one, x, height, level)

    def curve(values):
        line = values[2] * scale if level else 0.0
        if count == 4:
            line = line + values[3] * scale / width * (x - middle)
        return line - one.at(np.exp(values[0]), x - values[1] * width)

    count = 2 + level + (level and tilt)
    low = np.array([np.log(one.product[0]), place / width - 0.5, -5.0, -5.0][:count])
    high = np.array([np.log(one.product[-1]), place / width + 0.5, 5.0, 5.0][:count])
    firsts = (0.3 * one.product[-1] / MOST, one.product[-1] / MOST, product)
    starts = ([np.log(first), place / width, np.median(height) / scale, 0.0][:count] for first in firsts)
    best = least.fit(
        lambda values: (curve(values) - height) / scale,
        (np.clip(start, low + 1e-6, high - 1e-6) for start in starts),
        bounds=(low, high),
    )
    residuals = height - curve(best.x)
    depth = one.at(np.exp(best.x[0]), x - best.x[1] * width)
    end = int(best.x[0] > high[0] - END) - int(best.x[0] < low[0] + END)
    worn = np.flatnonzero(depth > EDGE * depth.max())
    if not end and level and (worn.size < SIDES or worn[0] < SIDES or worn[-1] > len(x) - 1 - SIDES):
        raise Error(
            "the profile has no unworn surface on both sides of the scar: depth and height of it are one number"
        )
    neighbours = _correlation(residuals, count)
    variance = 2.0 * best.cost / max(1, len(x) - len(best.x))
    widened = np.sqrt((1.0 + max(neighbours, 0.0)) / (1.0 - min(neighbours, 0.99)))
    relative = float(np.sqrt(variance) * least.bands(best.jac).sd[0] * widened)
    beside = np.any((best.x[1:] > high[1:] - END) | (best.x[1:] < low[1:] + END))
    doubt = _doubt(one, end, beside, residuals, count, float(depth.max()), relative)
    coefficient = float("nan") if doubt else float(np.exp(best.x[0])) / one.life
    return Scar(
        coefficient, coefficient * relative, float(best.x[1] * width),
        float(best.x[2] * scale) if level else 0.0, float(best.x[3] * scale / width) if count == 4 else 0.0,
        float(np.sqrt(np.mean(residuals**2))), neighbours, x, height, curve(best.x), end, doubt,
    )  # fmt: skip


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


def _doubt(one, end, beside, residuals, count, depth, relative):
    """Why the profile does not hold the coefficient, and what to do; empty if it does."""
    least, most = (one.product[k] / one.life for k in (0, -1))
    if end > 0 and len(one.product) < OUTPUTS:
        return f"it is deeper than the deepest scar on the grid, of {most:.3g} 1/Pa: give a wider -grid_size"
    if end:
        return (
            f"it is {'deeper' if end > 0 else 'shallower'} than all scars from {least:.3g} to {most:.3g} 1/Pa: give a "
            f"{'larger' if end > 0 else 'smaller'} -wear_coefficient{one.body}, and look at units, heights and cycles"
        )
    if beside:
        return "its place, height or tilt is not found: give a profile with one scar, and its unworn surface level"
    points = _points(residuals)
    if points < INDEPENDENT * count and np.sqrt(np.mean(residuals**2)) > MATTERS * depth:
        return (
            f"its shape is not that of the contact's scar: residuals are correlated over most of it ({points:.2g} "
            f"independent points for {count} parameters): look at radii, load, stroke and the ratio of both "
            "coefficients (--split), and leave out debris"
        )
    if relative > HELD:
        return f"its noise leaves a deviation of {100 * relative:.2g} %: average several profiles"
    return ""


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
    left = WIDENINGS
    while True:
        left -= 1
        try:
            used = one or family(shape, life, body, options, start)
        except _AtEdge:
            own = start or float(options_of(shape)[f"wear_coefficient{body}"])
            if not left:
                raise
            start = own / BEYOND
            continue
        scar = fit_scar(used, x, height)
        if not left or not scar.end or scar.end > 0 and len(used.product) < OUTPUTS:
            return scar, used
        own = used.product[0] / (LEAST * life)
        part = _begin(used, scar.x, scar.height, True)[0] / life / own
        start = own * float(np.clip(part, *((2.0, BEYOND) if scar.end > 0 else (1.0 / BEYOND, 0.25))))
        one = None


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
    while len(found) < len(tried):
        found.append(fit_profile(shape, life, x, height, body, {other: tried[len(found)] * own})[0])
        misfits = np.array([scar.misfit for scar in found])
        if len(found) == len(tried) and misfits.argmin() == len(tried) - 1 and tried[-1] < MOST_RATIO:
            tried.append(GROWS * tried[-1])
    k = int(np.clip(np.argmin(misfits), 1, len(misfits) - 2))
    curve = np.polyfit(tried[k - 1 : k + 2], misfits[k - 1 : k + 2] ** 2, 2)  # of the mean square
    scar = found[int(np.argmin(misfits))]
    best = float(-curve[1] / (2.0 * curve[0])) if curve[0] > 0.0 else np.nan
    least = float(np.polyval(curve, best))
    points = len(scar.x) * (1.0 - min(scar.neighbours, 0.99)) / (1.0 + max(scar.neighbours, 0.0))
    points = max(1.0, points - 4.0)  # independent ones, less those that the fit takes
    deviation = float(np.sqrt(max(least, 0.0) / (points * curve[0]))) if curve[0] > 0.0 else np.nan
    doubt = _doubt_of_ratio(best, deviation, tried, scar)
    if doubt:
        best = deviation = np.nan
    return Split(best, deviation, np.array(tried), misfits, scar, doubt)


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
