"""The family of scars over the cycles of a test, by one wear simulation, and the same on a second grid.

Scars of wear simulations have errors by the cells, by the steps of a cycle and by cycle jumps. The second
family has half the cells, twice the steps and jumps of its own: what a fit finds with it differs by about these errors.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ...core.brief import brief
from ...core.errors import Error
from .push import options_of

OF_BODIES = ("wear_coefficient1", "wear_coefficient2")
OUTPUTS = 19  # scars of the family
FEWEST = 4  # of them, where the scar reaches the edge of the grid
LEAST, MOST = 0.05, 1.6  # their cycles relative to those of the test
SMALLEST = 8  # cells of the second grid at least


def _lagrange(places, at):
    """Weights of the values at some places in their polynomial."""
    weights = np.ones(len(places))
    for k, place in enumerate(places):
        rest = np.delete(places, k)
        weights[k] = np.prod((at - rest) / (place - rest))
    return weights


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
    start : float
        Coefficient of wear of the simulation, 1/Pa.
    whole : bool
        False where its scars end at the edge of the grid.
    second : Family, optional
        The same on a second grid.
    """

    x: np.ndarray
    depth: np.ndarray
    product: np.ndarray
    life: float
    body: str
    start: float
    whole: bool = True
    second: Optional[Family] = None

    def at(self, product: float, x: ArrayLike) -> np.ndarray:
        """Depth, cubic between four outputs over the logarithm of the product.

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
        places = np.log(self.product)
        first = int(np.clip(np.searchsorted(places, np.log(product)) - 2, 0, max(0, len(places) - 4)))
        four = slice(first, first + 4)
        line = _lagrange(places[four], np.log(product)) @ self.depth[four]
        return np.interp(x, self.x, line, left=0.0, right=0.0)


class AtEdge(Error):
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
    parts = np.unique(np.maximum(np.round(life * np.geomspace(LEAST, MOST, OUTPUTS)), 1.0))
    full = len(parts)
    given.update(wear_cycles=parts[-1], wear_output=parts[:-1].tolist(), output_every=10**6)
    given.pop("output", None)
    results, whole = _simulated(run, given)
    with results:
        depth = [results.field(f"wear_depth{body}", k).reshape(-1) for k in range(len(results.steps))]
        x = np.asarray(results.x)
    if not whole:  # the last one is that of the step at the edge
        depth = depth[:-1]
        parts = parts[: len(depth)]
    if len(depth) != len(parts) or len(parts) < min(full, FEWEST):
        ended = f"{shape}: the simulation ended after {len(depth)} of {full} outputs"
        raise Error(ended) if whole else AtEdge(f"{ended}, at the edge of the grid: give a wider -grid_size")
    own = float(given[name])
    return Family(x, np.array(depth), own * parts, life, body, own, whole)


def _simulated(run, given):
    """Results of a wear simulation, and whether it has reached its end; else the scar has reached the grid's edge."""
    from ...contact.errors import EdgeContact

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return run(given), True
        except EdgeContact as error:
            if error.results is None:
                raise AtEdge(f"{error}") from error
            return error.results, False


def with_second(one: Family, shape: Union[str, os.PathLike], options: Optional[Mapping] = None) -> Family:
    """A family with that of a second grid, half the cells and twice the steps; without one where that fails."""
    steps = {**options_of(shape), **(options or {})}.get("steps") or 1
    width = len(one.x) * float(one.x[1] - one.x[0])
    coarse = {"grid_n": f"{max(SMALLEST, len(one.x) // 2)},1", "grid_size": width, "steps": 2 * int(float(steps))}
    try:
        return replace(one, second=family(shape, one.life, one.body, {**(options or {}), **coarse}, one.start))
    except Error:
        return one
