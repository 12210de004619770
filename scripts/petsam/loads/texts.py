"""Tables in text files with a head: label, x, y, z, fx, fy, fz and time or increment, and what else is known."""

import re

import numpy as np

from ..core import units
from ..core.errors import Error, short
from ..surface.tables import Text, split
from . import gathering

HEAD = re.compile(r"\s*(.*?)\s*(?:[\[(]\s*([^\])]*?)\s*[\])])?\s*")  # x [mm], fx (N)
NAMES = {
    "label": ("node", "node label", "node id", "id", "nodelabel"),
    "time": ("total time", "t"),
    "increment": ("inc", "frame", "state"),
    **{axis: (f"coord{k}", f"coor{k}", f"coord.coor{k}", f"coord-coor{k}") for k, axis in enumerate("xyz", 1)},
    **{f"f{axis}": (f"f{k}", f"rf{k}") for k, axis in enumerate("xyz", 1)},
    **{f"u{axis}": (f"u{k}", f"u.u{k}", f"u-u{k}") for k, axis in enumerate("xyz", 1)},
    **{f"cnormf{k}": (f"cnormf.cnormf{k}", f"cnormf-cnormf{k}") for k in (1, 2, 3)},
    **{f"cshearf{k}": (f"cshearf.cshearf{k}", f"cshearf-cshearf{k}") for k in (1, 2, 3)},
    "cpress": (), "cshear1": (), "cshear2": (),
}  # fmt: skip
KNOWN = {other: name for name, others in NAMES.items() for other in (name, *others)}
X, FORCE, MOVED = (("x", "y", "z"), ("fx", "fy", "fz"), ("ux", "uy", "uz"))
NORMAL, SHEAR = (tuple(f"{name}{k}" for k in (1, 2, 3)) for name in ("cnormf", "cshearf"))
GROUPS = {"length": (*X, *MOVED), "force": (*FORCE, *NORMAL, *SHEAR)}
STRESSES = ("cpress", "cshear1", "cshear2")
LARGEST = 2**53  # label of a node


class Table:
    """A text with a head: names of its columns with their units, and numbers.

    Parameters
    ----------
    path : path
        The file.
    known : mapping
        Names of columns, and what each is called here.
    row, kind : str
        What a line is for, and what lines are of, for messages.
    """

    def __init__(self, path, known=KNOWN, row="node and time", kind="forces"):
        self.path, self.kind, text = path, kind, Text(path)
        self.lines, self.decimal = text.kept, text.decimal
        if not self.lines:
            raise Error(f"{path}: is empty: give a head and a line per {row}")
        self.head, line = self.lines[0]
        self.columns, self.units, self.others = {}, {}, []
        words = split(line, self.decimal)[0]
        for k, word in enumerate(words):
            name, unit = HEAD.fullmatch(word).groups()
            other, name = name, known.get(" ".join(name.lower().split()))
            if name in self.columns:
                raise Error(f"{path}: line {self.head}: two columns are {name}: remove one")
            if name:
                self.columns[name], self.units[name] = k, unit or None
            else:
                self.others.append(other)
        self.count = len(words)

    def need(self, names, what):
        """Raises Error unless the columns are there."""
        lacking = [name for name in names if name not in self.columns]
        if lacking:
            raise Error(f"{self.path}: line {self.head}: has no column {', '.join(lacking)}: {what}")

    def unit(self, group):
        """The unit that the heads of these columns state; None where they state none."""
        found = {self.units[name] for name in GROUPS[group] if name in self.columns}
        if len(found) > 1:
            shown = ", ".join(sorted(short(one or "none") for one in found))
            raise Error(
                f"{self.path}: line {self.head}: its columns of {group} are in several units ({shown}): use one"
            )
        return found.pop() if found else None

    def rows(self):
        """The number of each line, and {name: (n,)} of the columns."""
        names, numbers, found = list(self.columns), [], []
        places = [self.columns[name] for name in names]
        for number, line in self.lines[1:]:
            words = split(line, self.decimal)[0]
            if len(words) != self.count:
                raise Error(
                    f"{self.path}: line {number} has {len(words)} words, line {self.head} has {self.count} heads"
                )
            found.append([self._number(number, names[k], words[place]) for k, place in enumerate(places)])
            numbers.append(number)
        if not found:
            raise Error(f"{self.path}: has a head, but no lines of {self.kind} below it")
        return numbers, dict(zip(names, np.array(found).T))

    def _number(self, line, name, word):
        try:
            value = float(word.replace(",", ".") if self.decimal == "comma" else word)
        except ValueError:
            value = np.nan
        if not np.isfinite(value) or "_" in word:
            shown = short(word) or "an empty word"
            raise Error(f"{self.path}: line {line}: {shown} in column {name} is no finite number: correct it")
        return value


def read(path, given):
    """The Forces of a table."""
    table = Table(path)
    table.need(["label"], "give the label of each node")
    state = next((name for name in ("time", "increment") if name in table.columns), None)
    if state is None:
        table.need(["time or increment"], "give one of them, 1 in all lines for a single state")
    split_up = all(name in table.columns for name in NORMAL)
    force = None if split_up else FORCE
    if force:
        table.need(force, "give the force on each node, or CNORMF1 to 3 and CSHEARF1 to 3")
    stated = {group: table.unit(group) for group in GROUPS}
    sizes = {group: given.size(group, path, stated[group], f": line {table.head}") for group in GROUPS}
    scale = _time_scale(table, state)
    lines, columns = table.rows()
    rows = gathering.Rows(path, _labels(path, lines, columns["label"]), scale * columns[state], lines)
    normal = _three(columns, NORMAL)
    rows.force = _three(columns, FORCE) if force else normal + _three(columns, SHEAR, 0.0)
    if split_up:
        rows.more["normal"] = normal
    if all(name in columns for name in MOVED):
        rows.more["displacement"] = _three(columns, MOVED)
    own_stress = sizes["force"] / sizes["length"] ** 2
    for name in STRESSES:
        if name in columns:
            rows.more[name] = columns[name] * (_stress(table, name, own_stress) / own_stress)
    own = all(name in columns for name in X)
    deck = None if own and given.deck is None else gathering.of_deck(given, path)
    if own:
        rows.more["x"] = _three(columns, X)
    found = rows.forces(given, None if own else deck.nodes, sizes["length"], sizes["force"])
    gathering.add_sets(found, deck)
    return found


def _three(columns, names, empty=None):
    """Columns (n, 3); zeros where there is none, if they may be missing."""
    if not all(name in columns for name in names):
        return empty
    return np.stack([columns[name] for name in names], axis=1)


def _labels(path, lines, values):
    """Labels as integers."""
    wrong = np.flatnonzero((values != np.round(values)) | (np.abs(values) >= LARGEST))
    if wrong.size:
        raise Error(f"{path}: line {lines[wrong[0]]}: {values[wrong[0]]:g} in column label is no label: use integers")
    return values.astype(np.int64)


def _stress(table, name, own):
    """Pascals of the unit of a column of stress: that of its head, or that of the forces and lengths."""
    unit = table.units[name]
    size = own if unit is None else units.size(unit, "Pa")
    if size is None:
        raise Error(f"{table.path}: line {table.head}: {name} in {short(unit)}: use {units.names('Pa')}")
    return size


def _time_scale(table, name):
    """Seconds of the unit of time."""
    unit = table.units[name]
    if unit is None or name == "increment":
        return 1.0
    size = units.size(unit, "s")
    if size is None:
        raise Error(f"{table.path}: line {table.head}: time in {short(unit)}: use {units.names('s')}")
    return size
