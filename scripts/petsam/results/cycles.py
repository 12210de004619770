"""Cycles of a load history and the energy of each, from /history of a results file.

    import petsam
    from petsam import cycles
    with petsam.open("strokes.h5") as results:
        found = cycles.find(results)                        # by reversals of the displacement that does most work
        found = cycles.find(results, turns="load_tx")       # of another scalar
        found = cycles.find(results, period=(0.02, None))   # or by time, s
        print(found.energies)                               # J, one per cycle

By reversals a cycle goes from one of them to the next but one: from a maximum back to a maximum, or from a
minimum to a minimum, whichever comes first in the history; the loading before it belongs to no cycle. By a period
the cycles follow one another from a start. A cycle that the history does not finish is left out.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import Error, short, there_are
from .datafile import NotSaved

if TYPE_CHECKING:
    from .file import Results

# pairs of loads and conjugate displacements
PAIRS = {
    "tx": ("load_tx", "disp_x"), "ty": ("load_ty", "disp_y"), "mz": ("load_mz", "rot_z"),
    "n": ("load_n", "disp_z"), "mx": ("load_mx", "rot_x"), "my": ("load_my", "rot_y"),
}  # fmt: skip
TANGENTIAL = ("tx", "ty", "mz")  # pairs that dissipate
ENERGY = "dissipated_energy"  # by friction
VISCOUS = "viscous_energy"  # by bodies that relax
REVERSAL = 1e-4  # of the range of the values: a smaller change of direction is rounding, not a reversal
LEVEL = 1e-9  # of the range: values that differ by less are one plateau, whose end is the reversal
CLOSED = 1e-2  # of the range: largest distance between the end of a history and the beginning of its last cycle
SLACK = 1e-6  # of a period, as times are rounded


class Cycle(NamedTuple):
    """A cycle: rows, from 0, of the steps that have a solution.

    Its energy is that of the steps after the first until the last; -1 is the state before the first step.

    Attributes
    ----------
    number : int
        Of the cycle, from 1.
    first, last : int
        Rows where it begins and where it ends.
    """

    number: int
    first: int
    last: int

    @property
    def rows(self) -> slice:
        """Rows of its loop, including its beginning if that has been written."""
        return slice(max(0, self.first), self.last + 1)


def busiest(results: Results) -> Optional[str]:
    """The pair of load and displacement whose product varies most: tx, ty, mz or n; None if none varies."""

    def work(pair):
        load, way = (results.series(name) for name in PAIRS[pair])
        there = np.isfinite(load) & np.isfinite(way)  # a displacement without contact is unknown
        return float(np.ptp(load[there]) * np.ptp(way[there])) if there.any() else 0.0

    # tangential loads come before normal ones, which dissipate nothing
    best = max(TANGENTIAL, key=work)
    if work(best) > 1e-9 * work("n"):
        return best
    return "n" if work("n") > 0.0 else None


def turning_points(values: ArrayLike) -> list[int]:
    """Indices of the reversals of values, (n,); since these come from zero, the first one may be a reversal."""
    values = np.asarray(values, dtype=float)
    size = float(np.ptp(np.append(values, 0.0))) if values.size else 0.0
    turns, top, at, direction = [], 0.0, -1, 0
    for k, value in enumerate(values):
        if direction == 0:
            if abs(value - top) > REVERSAL * size:
                direction, top, at = np.sign(value - top), value, k
        elif direction * (value - top) >= -LEVEL * size:
            top, at = direction * max(direction * top, direction * value), k
        elif direction * (top - value) > REVERSAL * size:
            turns.append(at)
            direction, top, at = -direction, value, k
    return turns


def by_turns(values: np.ndarray) -> list[Cycle]:
    """Cycles from a turning point of the values, (n,), to the second next one."""
    turns = turning_points(values)
    found = [(one, other) for one, other in zip(turns[::2], turns[2::2])]
    rest = turns[2 * len(found) :]
    if len(rest) == 2:  # the history may end with the reversal that closes its last cycle
        missing = abs(values[-1] - values[rest[0]]) - CLOSED * np.ptp(values)
        beyond = (values[-1] - values[rest[0]]) * (values[rest[0]] - values[rest[1]]) > 0.0
        if missing <= 0.0 or beyond:
            found.append((rest[0], values.size - 1))
    return [Cycle(number, *rows) for number, rows in enumerate(found, 1)]


def by_period(times: np.ndarray, period: float, start: Optional[float] = None) -> list[Cycle]:
    """Cycles of a period, s, by the times of the steps, (n,), s; Error if it is shorter than the steps.

    Without a start they begin at 0, or at the first time if that is at least a period away.
    """
    if start is None:
        start = 0.0 if abs(times[0]) < period else float(times[0])  # steps before 0 belong to a first row at 0
    slack = SLACK * period
    count = np.floor((times[-1] - start + slack) / period)
    if count > times.size:
        raise Error(f"a period of {period:g} s is shorter than the steps, {np.median(np.diff(times)):.4g} s")
    ends = np.searchsorted(times, start + period * np.arange(max(0, int(count)) + 1) + slack, side="right") - 1
    return [Cycle(number, int(a), int(b)) for number, (a, b) in enumerate(zip(ends[:-1], ends[1:]), 1)]


def dissipated(results: Results, cycle: Cycle) -> tuple[float, float]:
    """The energies, J, that friction and the bodies dissipate in a cycle; that of the bodies is 0 if none relaxes."""
    steps = slice(cycle.first + 1, cycle.last + 1)
    friction = float(np.sum(results.series(ENERGY)[steps]))
    return friction, float(np.sum(results.series(VISCOUS)[steps])) if VISCOUS in results.history else 0.0


class Cycles:
    """The cycles of one file: a sequence of Cycle.

    Parameters
    ----------
    results : Results
        The results of a run.
    found : list of Cycle
        The cycles.
    manner : str
        How they were found.
    """

    def __init__(self, results: Results, found: list[Cycle], manner: str) -> None:
        self.results, self.found, self.manner = results, found, manner

    def __len__(self):
        return len(self.found)

    def __iter__(self):
        return iter(self.found)

    def __repr__(self):
        return f"Cycles({len(self)} of {self.results.path}, by {self.manner})"

    @cached_property
    def energies(self) -> np.ndarray:
        """Energy that friction dissipates in every cycle, (cycles,), J; J/m in plane strain."""
        return np.array([dissipated(self.results, one)[0] for one in self.found])

    @cached_property
    def viscous_energies(self) -> np.ndarray:
        """Energy that bodies that relax dissipate in every cycle, (cycles,), J; J/m in plane strain."""
        return np.array([dissipated(self.results, one)[1] for one in self.found])

    @cached_property
    def pair(self) -> Optional[str]:
        """The load and its displacement that do most work: see busiest()."""
        return busiest(self.results)

    def numbered(self, number: float) -> Cycle:
        """The cycle of a number.

        Parameters
        ----------
        number : int
            From 1, or from the end, -1 being the last.

        Returns
        -------
        Cycle

        Raises
        ------
        NotSaved
            If there is none.
        """
        count = len(self.found)
        at = count + 1 + number if number < 0 else number
        if at != int(at) or not 1 <= at <= count:
            there = f"there are cycles 1 to {count}" if count else "there is no whole cycle"
            raise NotSaved(self.results.path, f"cycle {number:g}", f"{there}, by {self.manner}")
        return self.found[int(at) - 1]


def find(
    results: Results, turns: Optional[str] = None, period: Optional[tuple[float, Optional[float]]] = None
) -> Cycles:
    """The cycles of results: of a period, or by reversals.

    Parameters
    ----------
    results : Results
        The results of a run.
    turns : str, optional
        The number of /history that reverses; None: the displacement of the pair that does most work, which changes also
        in gross slip, where its load does not.
    period : tuple, optional
        (period, start) in s; a start of None is 0, or the first time if that is at least a period away.

    Returns
    -------
    Cycles

    Raises
    ------
    Error
        If no step has a solution, there is no such number, or the period is shorter than the steps.
    """
    results.need_solution()
    if period is not None:
        start = "" if period[1] is None else f" from {period[1]:g} s"
        try:
            found = by_period(results.series("time"), *period)
        except Error as error:
            raise Error(f"{results.path}: --period: {error}") from error
        return Cycles(results, found, f"a period of {period[0]:g} s{start}")
    if turns is None:
        pair = busiest(results)
        turns = PAIRS[pair][1] if pair else "disp_x"
    if turns not in results.history:
        there = there_are(turns, sorted(results.history), "it has")
        raise Error(f"{results.path}: --turns {short(turns)}: has no such scalar{there}")
    return Cycles(results, by_turns(results.series(turns).astype(float)), f"reversals of {turns}")


__all__ = ["Cycle", "Cycles", "find"]


def __dir__():
    return __all__
