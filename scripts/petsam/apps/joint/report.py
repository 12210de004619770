"""The page of what petsam.joint has found, beyond its table: titles, facts of all rows, captions, own inputs."""

import numpy as np

from ...core.tables import Column
from . import pictures as of_joints
from .backbones import Backbone
from .balance import Response
from .bands import NUMBERS, TEXTS, Band
from .properties import Interface
from .saved import Saved
from .wearing import Wear

NOTE = "note"  # the column of a sentence about all numbers
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


def contents(found):
    """The contents for plot/founds.py; a table of a file has its kind's title, and a picture of its columns."""
    title, pictures = KINDS[found.kind if isinstance(found, Saved) else type(found)]
    if isinstance(found, Interface) and found.conductors is not None:
        pictures = {"Stiffness, real contact area and conductance": of_joints.interface}
    columns = _columns(found)
    return {
        "title": title,
        "columns": columns,
        "facts": _facts(found),
        "pictures": {"Columns of the table": of_joints.saved} if isinstance(found, Saved) else pictures,
        "inputs": _inputs(found),
        "limits": {"damping": "unresolved"} if "unresolved" in {one.name for one in columns} else {},
        "digits": {one.name: 9 for one in columns if one.name.startswith("frequency")},  # its changes are small
        "whole": True,
    }


def _columns(found):
    """The columns of the page's table; of a band the numbers as given, with their ranges and deviations."""
    if not isinstance(found, Band):
        return [one for one in found.table() if one.name != NOTE]
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


def _facts(found):
    """The facts that hold for all rows, (name, value) each."""
    return [*_own_facts(found), *(("Errors", one.values[0]) for one in found.table() if one.name == NOTE)]


def _own_facts(found):
    """The facts that this kind of result has of its own."""
    if isinstance(found, Backbone):
        stuck = ", ".join(f"{one:.6g}" for one in found.stuck)
        facts = [("Mode", (found.linear, "Hz", 9)), ("Modes while all that touches sticks", f"{stuck} Hz")]
        if np.isfinite(found.modes_change):
            facts.append(("Change without a quarter of the modes", f"{found.modes_change:.1e} of the frequency"))
        return facts
    if isinstance(found, Band):
        return [(name, TEXTS[name]) for name in found.backbones]
    return [("Note", found.note)] if isinstance(found, Interface) and found.note else []


def _inputs(found):
    """{name: value} of the inputs that a result has itself."""
    if not isinstance(found, Interface):
        return {}
    known = {"friction": found.friction, "shear": found.shear}
    return {**found.bodies, **{name: value for name, value in known.items() if value is not None}}
