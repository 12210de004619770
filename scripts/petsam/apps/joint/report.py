"""The parts of a report of what petsam.joint has found: numbers with their errors and meanings, pictures, inputs."""

import numpy as np

from ...core.errors import counted
from ...core.tables import Column
from ...plot import page, sheets
from ...plot.style import STYLE, plt
from . import pictures as of_joints
from .backbones import Backbone
from .balance import Response
from .bands import NUMBERS, TEXTS, Band
from .properties import Interface
from .saved import Saved
from .wearing import Wear

DIGITS = {"frequency": 9}  # of numbers whose changes are small; 6 of others
ERRORS = ("_error", "_spread")  # ends of the names of errors, which stand beside their numbers
PART = "relative"  # the first word of the meaning of an error that is relative to its number
# titles, and the pictures with their captions
KINDS = {
    Backbone: (
        "Frequency and damping of a joint over its amplitude",
        {"Frequency and damping": of_joints.backbone, "Pressure and slip": of_joints.slip_zones},
    ),
    Band: ("Frequency and damping of a joint and its assembly", {"Frequency and damping": of_joints.band}),
    Response: ("Response of a joint to a force", {"Amplitude and phase": of_joints.response}),
    Wear: ("Frequency and damping of a joint that wears", {"Frequency and damping": of_joints.joint_wear}),
    Interface: ("Stiffness of a rough joint", {"Stiffness and real contact area": of_joints.interface}),
}
RESULTS = (*KINDS, Saved)


def title(found):
    """The title of the page."""
    return _kind(found)[0]


def parts(found, inputs, record):
    """Numbers, pictures and inputs, sections each."""
    return [_numbers(found), _pictures(found), *sheets.of_inputs({**_own_inputs(found), **inputs})]


def _kind(found):
    """Title and pictures; a table from a file has the title of its kind, and a picture of its columns."""
    if isinstance(found, Saved):
        return KINDS[found.kind][0], {"Columns of the table": of_joints.saved}
    return next(one for kind, one in KINDS.items() if isinstance(found, kind))


# ---------------------------------------------------------------- numbers


def _columns(found):
    """The columns of the page's table; of a band the numbers as given, with their ranges and deviations."""
    if not isinstance(found, Band):
        return found.table()
    rows, given = slice(found.count), {column.name: column for column in found.given.table()}
    columns = [given["amplitude"]._replace(values=found.given.amplitude[rows])]
    for name in NUMBERS:
        one, (low, high) = given[name], found.limits(name)
        columns.append(one._replace(values=one.values[rows], text=f"{one.text}, as given"))
        if found.scatter:
            columns.append(Column(f"{name}_spread", one.unit, "standard deviation", found.deviation(name)))
        columns += [
            Column(f"{name}_{word}", one.unit, f"{word} {one.text} of all assemblies", values)
            for word, values in (("lowest", low), ("highest", high))
        ]
    return columns


def _error_of(column, known):
    """The name of the number whose error a column has; None of another column."""
    names = (column.name.removesuffix(end) for end in ERRORS if column.name.endswith(end))
    return next((name for name in names if name in known), None)


def _cells(column, errors, limits):
    """A cell for each row: a text, a number with its error beside it, or the limit below which it is."""
    if not column.unit:
        return [page.text(value) for value in column.values]
    cells, size = [], page.largest(column.values)
    for k, value in enumerate(np.asarray(column.values, dtype=float)):
        if limits is not None and value < limits[k]:
            cells.append(page.Html(f"&lt; {page.quantity(float(limits[k]), column.unit, 2, size)}"))
            continue
        number = page.quantity(float(value), column.unit, DIGITS.get(column.name.split("_")[0], 6), size)
        sizes = [
            sheets.percent(float(one.values[k]))
            if one.text.startswith(PART)
            else page.quantity(float(one.values[k]), column.unit, 2, size)
            for one in errors
        ]
        cells.append(page.Html("".join([number, *(f" &plusmn; {size}" for size in sizes)])))
    return cells


def _numbers(found):
    """The table, what its columns mean, and what holds for all rows."""
    columns = _columns(found)
    known = {column.name: column for column in columns}
    owners = {column.name: _error_of(column, known) for column in columns}
    limits = known["unresolved"].values if "unresolved" in known else None
    numbers = [column for column in columns if not owners[column.name] and column.name != "unresolved"]
    same = [column for column in numbers[1:] if len(set(column.values)) == 1 < len(column.values)]
    shown = [column for column in numbers if column.name not in {one.name for one in same}]
    cells = [
        _cells(
            column,
            [known[name] for name, owner in owners.items() if owner == column.name],
            limits if column.name == "damping" else None,
        )
        for column in shown
    ]
    rows = [[page.Html(first), *(page.Number(one) for one in rest)] for first, *rest in zip(*cells)]
    table = page.table(counted(len(rows), "row"), [column.name for column in shown], rows)
    meanings = [(page.broken(column.name), column.text) for column in shown]
    meanings += [
        (page.broken(f"\N{PLUS-MINUS SIGN} of {owner}"), known[name].text) for name, owner in owners.items() if owner
    ]
    facts = _facts(found) + [
        (page.text(f"{one.text[0].upper()}{one.text[1:]}, of all rows"), page.quantity(float(one.values[0]), one.unit))
        for one in same
    ]
    lead = [page.terms(facts)] if facts else []
    return page.section("Numbers", *lead, table, page.terms(meanings))


def _facts(found):
    """Returns the facts that hold for all rows, (name, value) each."""
    if isinstance(found, Backbone):
        stuck = ", ".join(f"{one:.6g}" for one in found.stuck)
        facts = [("Mode", page.quantity(found.linear, "Hz", 9)), ("Modes while all that touches sticks", f"{stuck} Hz")]
        if np.isfinite(found.modes_change):
            facts.append(("Change without a quarter of the modes", f"{found.modes_change:.1e} of the frequency"))
        return facts
    if isinstance(found, Band):
        return [(name, TEXTS[name]) for name in found.backbones]
    return [("Note", found.note)] if isinstance(found, Interface) and found.note else []


# ---------------------------------------------------------------- pictures and inputs


def _pictures(found):
    shown = []
    for caption, draw in _kind(found)[1].items():
        with plt.rc_context(STYLE):
            drawn = draw(found)
        shown.append(page.figure(page.image(drawn, f"{caption}, by petsam.plot"), caption, wide=True))
    return page.section("Pictures", *shown, class_="page")


def _own_inputs(found):
    """{name: value} of the inputs that a result has itself."""
    if not isinstance(found, Interface):
        return {}
    known = {"friction": found.friction, "shear": found.shear}
    return {**found.bodies, **{name: value for name, value in known.items() if value is not None}}
