"""The frictional work of a cycle of results, cell by cell, and the temperatures that it makes at a frequency.

import petsam
with petsam.open("strokes.h5") as results:
    work = petsam.heat.work(results)                    # of the last cycle
for frequency in (1, 10, 100):
    hot = work.temperatures(("steel", "Ti-6Al-4V"), frequency)
    print(frequency, hot.mean_maximum, hot.flash_maximum)
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Optional, Union

import numpy as np

from ...core.brief import brief
from ...core.errors import Error
from ...results import cycles
from ...results.fields import OPEN, SLIP
from .partition import Body, Temperatures, divided

if TYPE_CHECKING:
    from ...results.file import Results

EQUAL = 1e-6  # of a period: intervals whose lengths differ by less are equal
LEAST = 4  # steps of a cycle at least


@brief
@dataclass(frozen=True)
class Work:
    """The frictional work of a cycle.

    Attributes
    ----------
    work : ndarray
        Work in each of the equal intervals of the cycle, (intervals, ny, nx), J/m2; of the window of cells that are in
        contact at some time.
    touches : ndarray of bool
        Cells in contact in each interval, (intervals, ny, nx).
    x, y : ndarray
        Centres of the window's cells, m.
    cell : pair of floats
        Sides of a cell along x and y, m.
    period : float
        Period of the cycle in the results, s.
    """

    work: np.ndarray
    touches: np.ndarray
    x: np.ndarray
    y: np.ndarray
    cell: tuple[float, float]
    period: float

    @property
    def energy(self) -> float:
        """Frictional work of the cycle, J."""
        return float(self.work.sum()) * self.cell[0] * self.cell[1]

    def temperatures(
        self,
        bodies: tuple[Union[str, Body], Union[str, Body]],
        frequency: Optional[float] = None,
        resistance: float = 0.0,
    ) -> Temperatures:
        """The temperatures of the contact if the cycle is repeated for ever.

        Parameters
        ----------
        bodies : pair of str or Body
            Materials of bodies 1 and 2 by their names, or Body(conductivity, capacity, bulk).
        frequency : float, optional
            Cycles per second, Hz; None: that of the results' times.
        resistance : float
            Resistance of the contact to heat on its way to body 2, K m2/W.

        Returns
        -------
        Temperatures

        Raises
        ------
        Error
            See divided().

        Notes
        -----
        The mechanics does not depend on the frequency, as long as friction does not: one run serves all frequencies.
        Stresses by the heat, and the change of the gap by it, are left out.
        """
        period = self.period if frequency is None else 1 / frequency if frequency > 0 else np.nan
        if not period > 0:
            said = "the results' times do not rise" if frequency is None else f"frequency {frequency:g} Hz"
            raise Error(f"heat: {said}: expected a frequency above 0")
        one, other = (Body.named(body) if isinstance(body, str) else body for body in bodies)
        intervals = self.work.shape[0]
        return divided(self.work * intervals / period, self.touches, self.cell, period, (one, other), resistance)


def work(results: "Results", cycle: Union[int, cycles.Cycle] = -1, intervals: Optional[int] = None) -> Work:
    """The frictional work of a cycle, from the saved fields of its steps.

    Parameters
    ----------
    results : Results
        The results of a run, with the fields of all steps of the cycle (petsam -output_every 1, the default).
    cycle : int or Cycle
        Number of the cycle, by reversals, from 1, or from the end; or a cycle that petsam.cycles.find() has found in
        another manner, such as by its period.
    intervals : int, optional
        Number of equal intervals into which the work is divided; None: as many as the cycle has steps.

    Returns
    -------
    Work

    Raises
    ------
    Error
        If there is no such cycle, it has fewer than 4 steps, its fields are not all saved, nothing slips in it, or the
        bodies are not half-spaces at least for heat: in plane strain, periodic, layered or finite.

    Notes
    -----
    The work of a cell in a step is the mean of its bounds before and after the step times the length of its slip; those
    of a step are scaled so that their sum is its dissipated_energy, which also knows how cells begin to slide. Steps
    of unequal lengths are divided into equal intervals with constant power within each step.

    Examples
    --------
    >>> import petsam
    >>> ball = dict(gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", body1="steel", body2="steel")
    >>> loop = dict(time=[0, 1, 2, 3, 4, 5], load_n=[500] * 6, load_tx=[0, 60, 0, -60, 0, 60])
    >>> run = petsam.run(ball, grid_n=32, grid_size=2.4e-3, friction=0.2, history=loop, steps=2)
    >>> work = petsam.heat.work(run)
    >>> bool(abs(work.energy / run["dissipated_energy"][-8:].sum() - 1) < 1e-6)
    True
    """
    _need_bodies(results)
    found = cycle if isinstance(cycle, cycles.Cycle) else cycles.find(results).numbered(cycle)
    rows = np.arange(max(0, found.first), found.last + 1)
    if rows.size <= LEAST:
        raise Error(f"{results.path}: cycle {found.number} has {rows.size - 1} steps: heat needs at least {LEAST}")
    saved = [_saved(results, found, int(row)) for row in rows]
    window = _window(results, saved)
    steps = _StepWork(results, window)
    works, touches = zip(*(steps.of(before, now, row) for before, now, row in zip(saved, saved[1:], rows[1:])))
    if not np.any(works):
        raise Error(f"{results.path}: nothing slips in cycle {found.number}: there is no frictional heat")
    times = results.series("time")[rows].astype(float)
    count = intervals or rows.size - 1
    shares = _shares(times, count)
    return Work(
        np.tensordot(shares, np.array(works), 1), np.tensordot(shares > EQUAL, np.array(touches), 1).astype(bool),
        results.x[window[1]], results.y[window[0]], steps.cell, float(times[-1] - times[0]),
    )  # fmt: skip


def _need_bodies(results):
    kind = str(results.parameters.get("elasticity", "halfspace"))
    if kind.startswith("plane"):
        raise Error(f"{results.path}: in plane strain bodies that stand have no mean temperature")
    if kind == "periodic":
        raise Error(f"{results.path}: heat needs half-spaces: the mean temperature of one period has no limit")
    for name in results.parameters:
        if "_layer" in name or "_compliance" in name:
            raise Error(f"{results.path}: heat: {name}: the flux through layers and finite bodies is not computed")


def _saved(results, found, row):
    """The index of the saved step of a row."""
    step = int(results.solved[row])
    for k in range(results.times.size):
        if results.row(k) == step:
            return k
    raise Error(
        f"{results.path}: of cycle {found.number} the fields of step {step + 1} are not saved: heat needs those of all "
        "its steps (petsam -output_every 1)"
    )


def _window(results, saved):
    """The rows and columns of cells that are in contact in some step."""
    touched = np.zeros((results.y.size, results.x.size), dtype=bool)
    for k in saved:
        touched |= results.field("state", k) != OPEN
    if not touched.any():
        raise Error(f"{results.path}: there is no contact in the cycle")
    return tuple(slice(int(at[0]), int(at[-1]) + 1) for at in (np.flatnonzero(touched.any(axis=a)) for a in (1, 0)))


class _StepWork:
    """The work of steps on a window of a results file."""

    def __init__(self, results, window):
        self.results = results
        self.place = {"rows": window[0], "columns": window[1]}
        self.cell = tuple(float(axis[1] - axis[0]) for axis in (results.x, results.y))

    def _field(self, name, index):
        return self.results.field(name, index, **self.place)

    def of(self, before, now, row):
        """Work of a step (J/m2), and its cells in contact."""
        fields = [[self._field(name, k) for name in ("slip_x", "slip_y", "pressure")] for k in (before, now)]
        (x0, y0, p0), (x, y, p) = fields
        state = self._field("state", now)
        bound = np.hypot(self._field("shear_x", now), self._field("shear_y", now))
        slides = (state == SLIP) & (p > 0)
        ratio = np.divide(p0, p, out=np.zeros_like(p), where=slides)
        work = np.where(slides, 0.5 * (1 + ratio) * bound * np.hypot(x - x0, y - y0), 0.0)
        energy, total = float(self.results.series("dissipated_energy")[row]), work.sum() * self.cell[0] * self.cell[1]
        return work * (energy / total if total > 0 else 0.0), state != OPEN


def _shares(times, count):
    """The parts of steps in equal intervals: (count, steps)."""
    ends = np.linspace(times[0], times[-1], count + 1)
    low, high = np.maximum.outer(ends[:-1], times[:-1]), np.minimum.outer(ends[1:], times[1:])
    lengths = np.diff(times)
    if np.any(lengths <= 0):
        raise Error("heat: the times of the cycle's steps do not rise: give the rows of the history times")
    shares = np.maximum(high - low, 0.0) / lengths
    return np.where(shares > EQUAL, shares, 0.0)
