"""The load steps of results: numbers of the history, saved steps by number, time or cycle, the life. SI units."""

from copy import copy
from functools import cached_property
from typing import Any, Optional, TypeVar

import numpy as np

from ..core.errors import Error
from ..core.hdf5 import DAMAGED
from .datafile import Datafile, Named, NotSaved, _some

NO_EQUILIBRIUM = 11  # /history/status of a rejected step, which has no solution

Me = TypeVar("Me", bound="Steps")  # Results


class Steps(Datafile):
    """The load steps of Results."""

    steps: list[int]
    before: int
    wear: Named
    _whole: Any = None  # keeps the results that between() has taken a part of, whose file may be a temporary one
    first_row: int = 0
    _last_row: Optional[int] = None  # rows of the history that count: see between()

    @property
    def time(self) -> np.ndarray:
        """Times of all load steps, s: history["time"]; those of the saved fields are times."""
        return self.history["time"]

    @property
    def _complete(self):
        """Number of steps that are in all columns of the history: see solved."""
        return min((values.size for values in self.history.values()), default=0)

    @cached_property
    def solved(self) -> np.ndarray:
        """Rows of the history, from 0, whose steps have a solution.

        The row of a refused step holds the loads and displacements that were asked for, and NaN for what is unknown.
        The step that a killed run was writing may be there in some datasets only, and does not count either.
        """
        rows = np.flatnonzero(self.history["status"][: self._complete] != NO_EQUILIBRIUM)
        return rows[self.counts(rows)]

    def __reduce__(self):
        """The load steps of between(), too."""
        make, given = super().__reduce__()
        return (make, given) if self._whole is None else (_part_of, (make, given, self.first_row, self._last_row))

    def counts(self, rows: np.ndarray) -> np.ndarray:
        """True for rows that are among the load steps of between().

        Parameters
        ----------
        rows : ndarray of int
            Rows of the history, from 0.

        Returns
        -------
        ndarray of bool
            Of the shape of rows; all True unless between() has been asked for.
        """
        return (rows >= self.first_row) & (rows <= (np.inf if self._last_row is None else self._last_row))

    def between(self: Me, first: Optional[int] = None, last: Optional[int] = None) -> Me:
        """The same results as if their history had some of the load steps only.

        Parameters
        ----------
        first, last : int, optional
            Numbers of the first and last load step as of_step() has them; None: those of the history.

        Returns
        -------
        Results
            They share the open file with these ones.

        Raises
        ------
        NotSaved
            If there are no such steps, or none of them has a solution.
        """
        count = self.history["time"].size
        there = "there is 1 step" if count == 1 else f"there are {count} steps"
        if self.before:
            there = f"the file has the steps {self.before + 1} to {self.before + count}"
        rows = []
        for step, unless in ((first, 0), (last, count - 1)):
            row = unless if step is None else count + step if step < 0 else step - 1 - self.before
            if not 0 <= row < count:
                raise NotSaved(self.path, f"range {_ends(first, last)}", there)
            rows.append(row)
        if rows[0] > rows[1]:
            raise NotSaved(self.path, f"range {_ends(first, last)}", "the first step comes after the last one")
        part = copy(self)
        part.__dict__.pop("solved", None)
        part._whole = self
        part.first_row, part._last_row = rows
        if not part.solved.size:
            raise NotSaved(self.path, f"range {_ends(first, last)}", "no step of these has a solution")
        return part

    def series(self, name: str) -> np.ndarray:
        """A number of the history of the steps that have a solution: what sums and extremes are taken of.

        Parameters
        ----------
        name : str
            Its name in /history.

        Returns
        -------
        ndarray
            Values, (solved.size,), in SI units.

        Raises
        ------
        Error
            If there is no such number.
        """
        return self.history[name][self.solved]

    def need_solution(self) -> None:
        """Checks that a step has a solution.

        Raises
        ------
        Error
            If no step has one.
        """
        if not self.solved.size:
            raise Error(f"{self.path}: no step has a solution")

    def of_step(self, number: int) -> int:
        """The saved step of a load step.

        Parameters
        ----------
        number : int
            Of the load step: from 1, or from the end, -1 being the last.

        Returns
        -------
        int
            Index into the fields.

        Raises
        ------
        NotSaved
            If there is no such load step, or its fields were not saved.
        Error
            If no fields were saved.
        """
        count = self.history["time"].size
        last = self.before + count
        step = last + 1 + number if number < 0 else number
        self._need_fields()
        if self.before and not self.before < step <= last:
            raise NotSaved(self.path, f"step {number}", f"the file has the steps {self.before + 1} to {last}")
        if not 1 <= step <= count + self.before:
            raise NotSaved(self.path, f"step {number}", "there is 1 step" if count == 1 else f"there are {count} steps")
        if step in self.steps:
            return self.steps.index(step)
        reason = f"its fields were not saved, those of steps {_some(self.steps)} were"
        raise NotSaved(self.path, f"step {number}", reason)

    def row(self, index: int) -> int:
        """The row of the history of a saved step.

        Parameters
        ----------
        index : int
            Of the saved step.

        Returns
        -------
        int
            The row, from 0.
        """
        return self.steps[index] - 1 - self.before

    def of_time(self, time: float) -> int:
        """The saved step that is nearest to a time.

        Parameters
        ----------
        time : float
            Time, s, between the first and the last saved step.

        Returns
        -------
        int
            Index into the fields.

        Raises
        ------
        NotSaved
            If the time lies outside.
        """
        self._need_fields()
        return self.nearest(self.times, time)

    def of_cycle(self, cycle: float) -> int:
        """The end of the saved cycle of a life that is nearest to a cycle.

        Parameters
        ----------
        cycle : float
            Cycles since the beginning, between the first and the last saved cycle.

        Returns
        -------
        int
            Index into the fields.

        Raises
        ------
        NotSaved
            If it lies outside.
        Error
            If there is no life.
        """
        self._need_fields()
        return self.cycle_ends[self.nearest(self.cycles[self.cycle_ends], cycle, "cycle")]

    def of_last(self) -> int:
        """The last saved step.

        Returns
        -------
        int
            Index into the fields.

        Raises
        ------
        Error
            If no fields were saved.
        """
        self._need_fields()
        return len(self.steps) - 1

    def is_last(self, index: int) -> bool:
        """True if a saved step is the last one; never of a life, where its name gives the number of cycles passed.

        Parameters
        ----------
        index : int
            Of the saved step, from 0.

        Returns
        -------
        bool
        """
        return index == len(self.steps) - 1 and not self.has_life

    def _need_fields(self):
        if not self.steps:
            raise Error(f"{self.path}: no fields were saved")

    def title(self, index: int) -> str:
        """The name of a saved step: the label, and where there are several the step and its time, or cycle.

        Parameters
        ----------
        index : int
            Of the saved step.

        Returns
        -------
        str
        """
        return ", ".join(filter(None, (self.label, self.when(index))))

    def when(self, index: int) -> str:
        """The title without the label: nothing for a single step.

        Parameters
        ----------
        index : int
            Of the saved step.

        Returns
        -------
        str
        """
        if self.history["time"].size == 1:
            return ""
        if self.has_life:
            return f"step {self.steps[index]}, after {self.cycles[index]:.7g} cycles"
        return f"step {self.steps[index]}, t = {self.times[index]:.4g} s"

    def friction(self, index: int) -> float:
        """The coefficient of friction of a saved step.

        Parameters
        ----------
        index : int
            Of the saved step.

        Returns
        -------
        float
            NaN where it is a field (-friction_file).

        Raises
        ------
        Error
            If the file has no such number.
        """
        try:
            number = float(self.parameters["friction"]) if "friction" in self.parameters else np.nan
            scale = self.history["friction_scale"][self.row(index)] if "friction_scale" in self.history else 1.0
            return number * float(scale)
        except DAMAGED as error:
            raise self._error(error) from error

    # ------------------------------------------------------------ the life of a joint that wears

    @property
    def has_life(self) -> bool:
        """True if the history is a cycle that was repeated (-wear_cycles), and one has been computed."""
        return "cycle" in self.history and "cycle" in self.wear and self.wear["cycle"].size > 0

    def need_life(self) -> None:
        """Checks that there is a life.

        Raises
        ------
        Error
            If the history is no cycle that was repeated (-wear_cycles).
        """
        if not self.has_life:
            raise Error(f"{self.path}: has no life of many cycles (petsam -wear_cycles)")

    @cached_property
    def cycles(self) -> np.ndarray:
        """Cycles of the life before each saved step, (saved,)."""
        self.need_life()
        return self.history["cycle"][np.array(self.steps, dtype=int) - 1 - self.before]

    @cached_property
    def cycle_ends(self) -> list[int]:
        """Indices into the fields of the last saved step of each saved cycle of the life."""
        return [int(index) for index in np.flatnonzero(np.append(np.diff(self.cycles) != 0.0, True))]

    def of_computed_cycle(self, cycle: float) -> np.ndarray:
        """The steps of a computed cycle of the life.

        Parameters
        ----------
        cycle : float
            The number of cycles before it, as history["cycle"] has it.

        Returns
        -------
        ndarray of int
            Rows of the history, from 0.
        """
        return self.solved[self.series("cycle") == cycle]


def _part_of(make, given, first_row, last_row):
    """The results of a file with these rows of its history only."""
    whole = make(*given)
    return whole.between(whole.before + first_row + 1, whole.before + last_row + 1)


def _ends(first, last):
    return ":".join("" if step is None else f"{step}" for step in (first, last))
