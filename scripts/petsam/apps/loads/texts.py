"""Tables in text files with a head: label, x, y, z, fx, fy, fz and time or increment, and what else is known."""

import numpy as np

from ...core import units
from ...core.errors import Error, short
from ...core.texttable import Table
from . import gathering

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


def read(path, given):
    """The Forces of a table."""
    table = Table(path, KNOWN, "node and time", "forces")
    table.need(["label"], "give the label of each node")
    state = next((name for name in ("time", "increment") if name in table.columns), None)
    if state is None:
        table.need(["time or increment"], "give one of them, 1 in all lines for a single state")
    split_up = all(name in table.columns for name in NORMAL)
    force = None if split_up else FORCE
    if force:
        table.need(force, "give the force on each node, or CNORMF1 to 3 and CSHEARF1 to 3")
    stated = {group: table.unit(group, names) for group, names in GROUPS.items()}
    sizes = {group: given.size(group, path, stated[group], f": line {table.head}") for group in GROUPS}
    scale = _size(table, state, "s", 1.0) if state == "time" else 1.0
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
            rows.more[name] = columns[name] * (_size(table, name, "Pa", own_stress) / own_stress)
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


def _size(table, name, quantity, own):
    """The unit of a column in that of SI: that of its head, or its own."""
    unit = table.units[name]
    size = own if unit is None else units.size(unit, quantity)
    if size is None:
        raise Error(f"{table.path}: line {table.head}: {name} in {short(unit)}: use {units.names(quantity)}")
    return size
