"""The coefficient of wear from the profile of a scar.

The depth of a scar depends on the product of coefficient and cycles only, where all else of the test is known and
the surfaces slide: one wear simulation with outputs over its cycles is the whole family of scars. What is found is the
member of the family, a shift along x, and height and tilt of the unworn surface.

Residuals of neighbouring points of a profile are not independent: with their correlation r, deviations are larger by
sqrt((1 + r)/(1 - r)).
"""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Optional

import numpy as np

from ..core.errors import Error, library
from .push import options_of

OUTPUTS = 19  # scars of the family
FEWEST = 4  # of them, where the scar reaches the edge of the grid
LEAST, MOST = 0.05, 1.6  # their cycles relative to those of the test
EDGE = 0.02  # of the depth: where a scar ends
SIDES = 3  # points beyond the scar, on each side, that hold the height of the unworn surface


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

    def at(self, product: float, x) -> np.ndarray:
        """Depth (m) at x (m), linear between the outputs over the logarithm of the product."""
        place = np.interp(np.log(product), np.log(self.product), np.arange(len(self.product)))
        k = min(int(place), len(self.product) - 2)
        part = place - k
        line = (1.0 - part) * self.depth[k] + part * self.depth[k + 1]
        return np.interp(x, self.x, line, left=0.0, right=0.0)


@dataclass(frozen=True)
class Scar:
    """The fit of a profile.

    Attributes
    ----------
    coefficient, coefficient_sd : float
        Archard's, of the body, 1/Pa.
    shift, offset, tilt : float
        m, m, 1.
    misfit : float
        Root mean square of the residuals, m.
    neighbours : float
        Correlation of neighbouring residuals.
    x, height, curve : ndarray
        The points, and the fit at them, m.
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


def family(shape, life: float, body: str = "2", options: Optional[Mapping] = None) -> Family:
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

    Returns
    -------
    Family

    Raises
    ------
    Error
        If the body does not wear, the contact is no row of cells, or petsam cannot simulate the wear.
    """
    from ..running import run

    given = {**{name: value or True for name, value in options_of(shape).items()}, **(options or {})}
    name = f"wear_coefficient{body}"
    if not float(given.get(name, 0.0)) > 0.0:
        raise Error(f"{shape}: -{name} is missing: a value from which the fit begins")
    if not str(given.get("elasticity", "")).startswith("plane"):
        raise Error(f"{shape}: profiles are of contacts in plane strain: -elasticity plane")
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
        raise Error(
            f"{shape}: the simulation ended after {len(depth)} of {OUTPUTS} outputs"
            + ("" if whole else ", at the edge of the grid: give a wider -grid_size")
        )
    return Family(x, np.array(depth), float(given[name]) * parts, life, body)


def _simulated(run, given):
    """Results of a wear simulation, and whether it has reached its end; else the scar has reached the grid's edge."""
    from ..contact import EdgeContact

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return run(given), True
        except EdgeContact as error:
            if error.results is None:
                raise
            return error.results, False


def _correlation(residuals, count):
    """Correlation of neighbours, without what a fit of so many parameters takes of it: of white noise it leaves
    -count/n, of correlated noise (measured on twins) 1.5 count/n of r more."""
    centred, part = residuals - residuals.mean(), count / len(residuals)
    raw = float(np.sum(centred[1:] * centred[:-1]) / max(np.sum(centred**2), 1e-300))
    return min(0.99, (raw + part) / (1.0 - 1.5 * part))


def fit_scar(one: Family, x, height, tilt: bool = True, level: bool = True) -> Scar:
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
        If the profile has no unworn surface on both sides of the scar, which depth and height of the surface need.
    """
    x, height = (np.asarray(values, dtype=float) for values in (x, height))
    optimize = library("scipy.optimize")
    scale = float(np.ptp(height))
    width = float(np.ptp(one.x))
    middle = float(np.mean(x))

    def curve(values):
        line = values[2] * scale if level else 0.0
        if count == 4:
            line = line + values[3] * scale / width * (x - middle)
        return line - one.at(np.exp(values[0]), x - values[1] * width)

    best, count = None, 2 + level + (level and tilt)
    for part in (0.3, 1.0):
        start = [np.log(part * one.product[-1] / MOST), 0.0, np.median(height) / scale, 0.0][:count]
        low = [np.log(one.product[0]), -0.5, -5.0, -5.0][: len(start)]
        high = [np.log(one.product[-1]), 0.5, 5.0, 5.0][: len(start)]
        start = np.clip(start, np.array(low) + 1e-6, np.array(high) - 1e-6)
        found = optimize.least_squares(lambda values: (curve(values) - height) / scale, start, bounds=(low, high))
        best = found if best is None or found.cost < best.cost else best
    residuals = height - curve(best.x)
    depth = one.at(np.exp(best.x[0]), x - best.x[1] * width)
    worn = np.flatnonzero(depth > EDGE * depth.max())
    if level and (worn.size < SIDES or worn[0] < SIDES or worn[-1] > len(x) - 1 - SIDES):
        raise Error(
            "the profile has no unworn surface on both sides of the scar: depth and height of it are one number"
        )
    neighbours = _correlation(residuals, count)
    variance = 2.0 * best.cost / max(1, len(x) - len(best.x))
    covariance = variance * np.linalg.pinv(best.jac.T @ best.jac)
    widened = np.sqrt((1.0 + max(neighbours, 0.0)) / (1.0 - min(neighbours, 0.99)))
    coefficient = float(np.exp(best.x[0])) / one.life
    return Scar(
        coefficient, coefficient * float(np.sqrt(covariance[0, 0])) * float(widened), float(best.x[1] * width),
        float(best.x[2] * scale) if level else 0.0, float(best.x[3] * scale / width) if count == 4 else 0.0,
        float(np.sqrt(np.mean(residuals**2))), neighbours, x, height, curve(best.x),
    )  # fmt: skip


@dataclass(frozen=True)
class Split:
    """How the wear is divided between the bodies, from the shape of one body's scar.

    Attributes
    ----------
    ratio, ratio_sd : float
        Coefficient of the other body over that of this one; the deviation is NaN where the shape does not hold it.
    ratios, misfits : ndarray
        Tried ratios, and the root mean square of the residuals of each, m.
    scar : Scar
        The fit at the best of them.
    """

    ratio: float
    ratio_sd: float
    ratios: np.ndarray
    misfits: np.ndarray
    scar: Scar


RATIOS = (0.02, 0.25, 0.5, 0.75, 1.0, 1.25)


def split(shape, life: float, x, height, body: str = "2", ratios=RATIOS) -> Split:
    """Fits a profile for several ratios of the bodies' coefficients: where surfaces move past each other, the width of
    the scar of one tells of the wear of the other.

    Parameters
    ----------
    shape, life, body
        See family().
    x, height : array_like
        (n,), m; a scar is negative.
    ratios : sequence of float
        Coefficient of the other body over that of this one; three or more, rising.

    Returns
    -------
    Split
    """
    own = float(options_of(shape)[f"wear_coefficient{body}"])
    other = "wear_coefficient" + ("1" if body == "2" else "2")
    found = [fit_scar(family(shape, life, body, {other: ratio * own}), x, height) for ratio in ratios]
    misfits = np.array([scar.misfit for scar in found])
    k = int(np.clip(np.argmin(misfits), 1, len(misfits) - 2))
    curve = np.polyfit(ratios[k - 1 : k + 2], misfits[k - 1 : k + 2] ** 2, 2)  # of the mean square
    scar = found[int(np.argmin(misfits))]
    best = float(np.clip(-curve[1] / (2.0 * curve[0]), ratios[0], ratios[-1])) if curve[0] > 0.0 else np.nan
    least = float(np.polyval(curve, best))
    points = len(scar.x) * (1.0 - min(scar.neighbours, 0.99)) / (1.0 + max(scar.neighbours, 0.0))
    points = max(1.0, points - 4.0)  # independent ones, less those that the fit takes
    deviation = float(np.sqrt(least / (points * curve[0]))) if curve[0] > 0.0 and least > 0.0 else np.nan
    return Split(best, deviation, np.array(ratios), misfits, scar)
