"""Many positions of a wheelset side by side, in processes; results do not depend on how many."""

from __future__ import annotations

import functools
import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Optional

import numpy as np

from ...contact.errors import NoEquilibrium
from ...core import processes, tables
from ...core.brief import brief
from ...core.errors import Error
from . import cells
from .axle import Axle
from .contacts import Settings
from .equilibrium import Equilibrium
from .positions import Friction
from .rails import Track
from .search import ROLLINGS
from .spectrum import State
from .wheelset import Wheelset

BESIDE = 3e-4  # m between positions of a fine sweep
CHUNK, PARTS = 20, 50  # positions that one process solves one after the other, at least, and parts, at most


@brief
@dataclass(frozen=True, eq=False)
class Vehicle:
    """The data that all positions share: rails, wheels, friction.

    Parameters
    ----------
    rail, wheel : Track, Wheelset
        Of the right side; the left side is its mirror image.
    friction : float or callable
        See Pair; a function must be one of a module.
    settings : Settings, optional
        Materials, cells and limits.
    left : tuple of Track and Wheelset, optional
        See Axle.
    rolling : str
        See Axle.
    """

    rail: Track
    wheel: Wheelset
    friction: Friction = 0.3
    settings: Optional[Settings] = None
    left: Optional[tuple[Track, Wheelset]] = None
    rolling: str = ROLLINGS[0]

    def axle(self) -> Axle:
        """The wheelset on its rails.

        Returns
        -------
        Axle
        """
        return Axle(self.rail, self.wheel, self.friction, self.settings, self.left, self.rolling)


@dataclass(frozen=True, eq=False)
class Found:
    """The result of a position: `value` is kept of its Equilibrium, None where there is none; `failure` is the error of
    a position without an equilibrium, empty otherwise; `notes` are its warnings; `unknown` is why its errors are not
    known, empty where they are."""

    value: Any
    failure: str = ""
    notes: tuple[str, ...] = ()
    unknown: str = ""


@brief
@dataclass(frozen=True, eq=False)
class Batch(tables.Tabled):
    """The numbers of many positions: the states, and for each a Found with the columns of its Equilibrium."""

    states: list[State]
    found: list[Found]

    @property
    def failures(self) -> list[tuple[int, str]]:
        """Number of each position without an equilibrium, from 1 on, and its error."""
        return [(k, self._named(k - 1)) for k, one in enumerate(self.found, 1) if one.failure]

    def _named(self, k):
        """The error of a position; with the two nearest ones that have an equilibrium, in a sweep over y."""
        here, failure = self.states[k], self.found[k].failure
        alike = [
            j for j, other in enumerate(self.states)
            if self.found[j].value and other.load == here.load and replace(other.position, y=here.position.y) ==
            here.position and here.load.lateral is None
        ]  # fmt: skip
        below = max((j for j in alike if self.states[j].position.y < here.position.y), key=self._y, default=None)
        above = min((j for j in alike if self.states[j].position.y > here.position.y), key=self._y, default=None)
        near = [self._shown(j) for j in (below, above) if j is not None]
        return failure + ("; nearest with an equilibrium: " + ", and ".join(near) if near else "")

    def _y(self, k):
        return self.states[k].position.y

    def _shown(self, k):
        """A position with an equilibrium, for a message."""
        numbers = {column.name: column.values[0] for column in self.found[k].value}
        lateral = f" (lateral force {numbers['ws_lateral']:.4g} N)" if "ws_lateral" in numbers else ""
        return f"position {k + 1}, y {self._y(k):.6g} m{lateral}"

    def table(self) -> list[tables.Column]:
        """A row for each patch, and one with empty cells for a position without an equilibrium."""
        solved = next((one.value for one in self.found if one.value), None)
        if solved is None:
            text = f"no position has an equilibrium; of the first one: {self.found[0].failure}"
            raise NoEquilibrium(NoEquilibrium.code, text)
        numbers: list[int] = []
        notes: list[str] = []
        rows: list[list] = [[] for _ in solved]
        named = dict(self.failures)
        for k, one in enumerate(self.found, 1):
            count = len(one.value[0].values) if one.value else 1
            numbers += [k] * count
            notes += ["; ".join(filter(None, (named.get(k), *one.notes, one.unknown)))] * count
            for row, column in zip(rows, one.value or [None] * len(solved)):
                row += list(column.values) if column else [None] * count
        first = tables.Column("position", "1", "number of the position", numbers)
        columns = [column._replace(values=row) for column, row in zip(solved, rows)]
        return [first, *columns, tables.Column("note", "", "error or warnings", notes)]

    def of(self, name: str) -> np.ndarray:
        """A number of all positions, (positions,), by its column, which must be equal in all rows of a position, as
        ws_roll: the value of the first patch that has it; NaN without an equilibrium."""
        picked = [[c.values[0] for c in one.value or () if c.name == name] for one in self.found]
        return np.array([one[0] if one else np.nan for one in picked], dtype=float)


def run(
    vehicle: Vehicle,
    states: Sequence[State],
    cores: int = 1,
    keep: Callable[[Equilibrium], Any] = Equilibrium.table,
    report: Optional[Callable[[int, int], object]] = None,
    errors: bool = False,
) -> list[Found]:
    """Finds the equilibrium of each position in several processes, and returns a list of Found in the order of the
    positions. `keep`, a function of a module, takes an Equilibrium and returns the value that is kept; `report` is
    called with the numbers of positions that are done, and of all. With `errors` that of keep is a table,
    which gets the columns of the errors by the cells."""
    vehicle.axle().close()  # fails and warns early, and once
    order = _path(states)
    size = max(CHUNK, -(-len(states) // PARTS))
    parts = [[states[k] for k in order[first : first + size]] for first in range(0, len(states), size)]
    ended = [0]

    def done(k):
        ended[0] += len(parts[k])
        if report is not None:
            report(ended[0], len(states))

    found = processes.run(
        [(functools.partial(_solved, vehicle, keep, errors), part) for part in parts], cores, _quiet, done
    )
    solved = dict(zip(order, (one for part in found for one in part)))
    return [solved[k] for k in range(len(states))]


def _path(states):
    """Numbers of all positions in an order in which neighbours are near: bands of lateral displacement or force, and
    in each the angle at which the wheelset runs, which grows and falls in turn."""
    aside = [one.position.y if one.load.lateral is None else one.load.lateral / one.load.vertical for one in states]
    along = sorted(range(len(states)), key=aside.__getitem__)
    width = math.isqrt(max(len(states) - 1, 0)) + 1
    band = {k: place // width for place, k in enumerate(along)}
    return sorted(along, key=lambda k: (band[k], (-1.0) ** band[k] * _angle(states[k].position)))


def _angle(position):
    """Angle between the wheelset's heading and its motion, rad; on rollers the yaw."""
    return position.yaw - (position.vy / position.speed if position.speed > 0.0 else 0.0)


def _quiet(*_):
    """Takes what jobs report, which is nothing."""


def _solved(vehicle, keep, errors, states, _told):
    """Found of each position of a part."""
    found, before = [], None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # run() has issued those of the vehicle
        made = vehicle.axle()
    with made as axle:
        for state in states:
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                try:
                    before = _near(axle, state, before)
                    failure = ""
                except Error as error:
                    before, failure = None, str(error)
            notes = tuple(dict.fromkeys(str(one.message) for one in caught if issubclass(one.category, UserWarning)))
            value, unknown = keep(before) if before else None, ""
            if errors and before:
                value, unknown = _with_errors(axle, state, before, value)
            found.append(Found(value, failure, notes, unknown))
    return found


def _with_errors(axle, state, found, table):
    """The table of an equilibrium with the columns of its errors, and why they are unknown, or an empty text."""
    aside = state.load.lateral is not None
    wider = None if aside else axle.wider(state.position, found)
    more = cells.errors(table, wider and wider.table())
    unknown = "" if cells.are_known(more) else f"{tables.Tabled.unknown}, as {cells.ASIDE if aside else cells.OTHERS}"
    return [*table, *more], unknown


def _near(axle, state, before):
    """The equilibrium from that of the position before, from rigid bodies where that leads to none, or at last from one
    halfway."""
    starts = [before, None] if before is not None else [None]
    for start in starts:
        try:
            return axle.solve(state.position, state.load, start)
        except Error as error:
            failure = error
    if before is None or state.load.lateral is not None or not _differ_little(before, state):
        raise failure
    here, there = before.position, state.position
    middle = replace(there, y=0.5 * (here.y + there.y), yaw=0.5 * (here.yaw + there.yaw))
    try:
        return axle.solve(there, state.load, axle.solve(middle, state.load, before))
    except Error:
        raise failure from None


def _differ_little(before, state):
    """True if a position is that of a sweep, beside the one before, under the same load."""
    apart = abs(before.position.y - state.position.y)
    return before.load == state.load and 0.0 < apart <= BESIDE and before.position.yaw == state.position.yaw


def solve_all(
    vehicle: Vehicle,
    states: Sequence[State],
    cores: int = 1,
    report: Optional[Callable[[int, int], object]] = None,
    errors: bool = False,
) -> Batch:
    """The numbers of many positions.

    Parameters
    ----------
    vehicle, states, cores, report
        See run().
    errors : bool
        True: the table has columns NAME_error, too: estimated errors by the cells, from each equilibrium on cells twice
        as wide; NaN where it has other patches, or a lateral force is given.

    Returns
    -------
    Batch
    """
    return Batch(list(states), run(vehicle, states, cores, report=report, errors=errors))
