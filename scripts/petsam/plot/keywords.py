"""Keywords that many pictures have, each explained once: which steps and cycles (Frames), and the look (Look)."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional, Union

import numpy as np

from ..core import words
from ..results import cycles

Names = Union[str, Sequence[str], None]
Steps = Union[int, Sequence[int], None]
Times = Union[float, str, Sequence[Union[float, str]], None]
Period = Optional[tuple[float, Optional[float]]]
Point = Optional[tuple[float, float]]
Span = Optional[tuple[float, float]]
StepRange = Optional[tuple[Optional[int], Optional[int]]]
Values = Sequence[tuple[str, object]]

# of all pictures, unless their own docstrings differ
COMMON = """
Parameters
----------
*files
    Files of the program, which are compared.
load : str, optional
    "tx", "ty", "mz", "n", "mx" or "my"; None: that which does most work.
component : str, optional
    "xx", "yy", ...: which stress, beside that of von Mises in maps and sections.
range : tuple, optional
    First and last load step, from 1; None leaves one of them open.
at : tuple, optional
    Point (x, y), m; None: the origin.
whole_grid : bool
    Whether the whole grid is drawn, not only the contact and a margin.
where : list of tuple
    (name, value): only cases with these values, SI units.
limits : tuple, optional
    Range of the colours, (low, high), SI units.
log : str or list of str
    Axes that are logarithmic: "x", "y".
xlim, ylim : tuple, optional
    Part of the axes, (low, high), SI units.
width : float, optional
    Width of the picture, mm.

Returns
-------
matplotlib.figure.Figure

Raises
------
Error
    If a file is of another program, or lacks such a step, cycle or quantity.
"""


def listed(value):
    """A value, or several, as a list; none of None."""
    if value is None:
        return []
    return [value] if isinstance(value, str) or np.ndim(value) == 0 else list(value)


def _number(text):
    return words.integer(text, "the number of a load step; -1 is the last")


def _second(text):
    return words.number(text, "a time, such as 1ms", "s")


@dataclass(frozen=True)
class Look:
    """The look of all pictures."""

    xlim: Span = None
    ylim: Span = None
    width: Optional[float] = None


LOOK = tuple(one.name for one in dataclasses.fields(Look))


@dataclass(frozen=True)
class Saved:
    """Saved steps.

    Parameters
    ----------
    step : int or list of int, optional
        Load steps, from 1, or from the end, -1 being the last. Without step, time and cycle: the last saved one.
    time : float or list of float, optional
        Times, s, or "1ms": the nearest saved steps.
    """

    step: Steps = None
    time: Times = None

    def is_given(self):
        """True if a step is asked for."""
        return bool(listed(self.step) or listed(self.time))

    def snapshots(self, files):
        """Pairs of a file and an index into its fields, for each step asked for; of the last step unless told."""
        for values, method, read in ((self.step, "of_step", _number), (self.time, "of_time", _second)):
            values = [read(value) if isinstance(value, str) else value for value in listed(values)]
            if values:
                return [(one, getattr(one, method)(value)) for one in files for value in values]
        return [(one, one.of_last()) for one in files]


@dataclass(frozen=True)
class Turns:
    """The definition of a cycle.

    Parameters
    ----------
    turns : str, optional
        Number of the history whose reversals separate cycles; None: the displacement that does most work.
    period : tuple, optional
        (T, START), s, of cycles by time; START may be None.
    """

    turns: Optional[str] = None
    period: Period = None

    def cycles(self, one):
        """The cycles of a file."""
        return cycles.find(one, self.turns, self.period)


@dataclass(frozen=True)
class Cycles(Turns):
    """Cycles.

    Parameters
    ----------
    cycle : int or list of int, optional
        Cycles, from 1, or from the end; of fields the saved step at their end.
    """

    cycle: Steps = None

    def end(self, one, number):
        """Index into the fields of a file at the end of a cycle: of a life the nearest saved one, else by number."""
        if one.has_life:
            return one.of_cycle(number)
        return one.of_step(int(one.solved[self.cycles(one).numbered(number).last]) + 1)


@dataclass(frozen=True)
class Frames(Cycles, Saved):
    """Saved steps, those at the end of cycles, too."""

    def is_given(self):
        return super().is_given() or bool(listed(self.cycle))

    def snapshots(self, files):
        if super().is_given() or not listed(self.cycle):
            return super().snapshots(files)
        return [(one, self.end(one, number)) for one in files for number in listed(self.cycle)]
