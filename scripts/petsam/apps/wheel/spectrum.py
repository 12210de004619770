"""A table of positions of a wheelset, of a simulation of the vehicle: y, yaw, speeds and loads in each line."""

from dataclasses import dataclass
from typing import Optional

from ...core import units
from ...core.errors import Error, Unusable, short, there_are
from ...core.texttable import Table
from .equilibrium import Load
from .pose import Position

# quantity of each column, and its other names
COLUMNS = {
    "y": ("m", ("ty", "lateral displacement")), "roll": ("rad", ("phi",)), "yaw": ("rad", ("psi", "alpha")),
    "speed": ("m/s", ("v", "vx")), "vy": ("m/s", ()), "vz": ("m/s", ()), "roll_rate": ("rad/s", ()),
    "yaw_rate": ("rad/s", ()), "pitch_rate": ("rad/s", ("omega",)), "load": ("N", ("axle load", "axle_load")),
    "offset": ("m", ()), "lateral": ("N", ("lateral force",)), "height": ("m", ()),
    "load_right": ("N", ("q_right",)), "load_left": ("N", ("q_left",)), "weight": ("1", ("share", "distance")),
}  # fmt: skip
KNOWN = {other: name for name, (_, others) in COLUMNS.items() for other in (name, *others)}
MOTION = ("y", "roll", "yaw", "speed", "vy", "vz", "roll_rate", "yaw_rate", "pitch_rate")


@dataclass(frozen=True)
class State:
    """A position of a wheelset and its loads.

    Parameters
    ----------
    position : Position
        Position and speeds.
    load : Load
        The forces.
    weight : float
        Share of the distance.
    roll : float, optional
        The one that the table has, rad, for comparison with the one that is found.
    line : int
        Of the table; 0 of none.
    """

    position: Position
    load: Load
    weight: float = 1.0
    roll: Optional[float] = None
    line: int = 0


def read_positions(path: str, load: Optional[float] = None, speed: Optional[float] = None) -> tuple[list[State], list]:
    """The positions in a table.

    Parameters
    ----------
    path : path
        A text with a head of names with units, y [mm],yaw [mrad],speed [km/h],load [kN], and a line per position.
    load, speed : float, optional
        Axle load, N, and speed, m/s, of all lines where the table has no such columns.

    Returns
    -------
    states : list of State
        In the order of the lines.
    ignored : list of str
        Names of the columns that are not used.

    Raises
    ------
    Error
        If a column lacks, has no unit or one of another quantity, or a line is no position; with file and line.
    MissingFile
        If there is no such file.
    """
    table = Table(path, KNOWN, "position", "positions")
    _need_columns(table, load, speed)
    lines, columns = table.rows()
    columns = {name: _size(table, name) * values for name, values in columns.items()}
    rows = [dict(zip(columns, map(float, values))) for values in zip(*columns.values())]
    return [_state(path, line, row, load, speed) for line, row in zip(lines, rows)], table.others


def _need_columns(table, load, speed):
    """Raises an Error where a column lacks, or something is given twice."""
    path = table.path
    sides = [name for name in ("load_right", "load_left") if name in table.columns]
    if "lateral" not in table.columns:
        table.need(["y"], "give the lateral displacement, y [mm]")
    _refuse_twice(table, load, speed)
    if speed is None:
        table.need(["speed"], "give it, speed [km/h], or --speed")
    if len(sides) == 1:
        table.need(["load_right", "load_left"], "give both, or load [kN] of the axle")
    if not sides and load is None:
        table.need(["load"], "give the axle load, load [kN], or --load")
    for first in sides:
        for other in ("load", "offset", "height"):
            if other in table.columns:
                raise Error(
                    f"{path}: line {table.head}: columns {first} and {other}: give the loads of the wheels alone"
                )


def _refuse_twice(table, load, speed):
    """Raises an Error where a column and an argument, or two columns, give the same."""
    for name, given in (("load", load), ("load_right", load), ("speed", speed)):
        if given is not None and name in table.columns:
            raise Unusable(f"{table.path}: line {table.head}: has the column {name}: omit --{name.partition('_')[0]}")
    if "lateral" in table.columns and "y" in table.columns:
        raise Error(f"{table.path}: line {table.head}: columns y and lateral: give one of them")


def _size(table, name):
    """The unit of a column in that of SI."""
    quantity, unit = COLUMNS[name][0], table.units[name]
    where = f"{table.path}: line {table.head}: column {name}"
    if quantity == "1":
        return 1.0
    known = units.of(quantity)
    if unit is None:
        raise Error(f"{where}: has no unit: write {name} [{next(iter(known))}]; units are {', '.join(known)}")
    size = units.size(unit, quantity)
    if size is None:
        raise Error(f"{where}: {short(unit)}: is no unit of it{there_are(unit, known)}")
    return size


def _state(path, line, row, load, speed):
    """The state of a line."""
    try:
        motion = {name: row[name] for name in MOTION if name in row}
        motion.setdefault("speed", speed)
        if "load_right" in row:
            right, left = row["load_right"], row["load_left"]
            force = Load(right + left, right=right)
        else:
            given = {name: row[name] for name in ("offset", "lateral", "height") if name in row}
            force = Load(row.get("load", load), **given)
        weight = row.get("weight", 1.0)
        if not weight >= 0.0:
            raise Error(f"weight {weight:g}: expected 0 or more")
        return State(Position(**motion), force, weight, row.get("roll"), line)
    except Error as error:
        raise Error(f"{path}: line {line}: {error}") from error
