"""The head of a report: bodies and their shape, friction, loads, and the units of the page."""

import math

import numpy as np

from . import noise, page, sheets

BODIES = ("body1", "body2")
KNOWN = (("young", "E", "Pa"), ("poisson", "\N{GREEK SMALL LETTER NU}", "1"))
PARTS = {"none": "", "halfspace": "half-spaces", "layered": "with layers"}  # of bodies
LOADS = ("load_n", "load_tx", "load_ty", "load_mx", "load_my", "load_mz", "creep_x", "creep_y", "creep_spin")
DISPLACEMENTS = ("disp_z", "disp_x", "disp_y", "rot_x", "rot_y", "rot_z")
UNITS = "SI with prefixes, as 1 µm = 1e-6 m"
PLANE = "; areas, loads and energies are per metre of depth"


def rows(results):
    """Terms of the head and what they are, of results of petsam."""
    options = dict(sheets.given(results))
    pairs = [
        ("Bodies", _bodies(results, options)),
        ("Gap", _gap(results)),
        ("Friction", _friction(results, options)),
        ("Loads", _loads(results, options)),
        ("Units", UNITS + (PLANE if results.is_plane else "")),
    ]
    return [(term, what) for term, what in pairs if what]


def listed(parts):
    """Pieces of HTML in one line."""
    return page.Html(", ".join(map(page.text, parts)))


def _bodies(results, options):
    """Both bodies, by their names and constants."""
    told = []
    for body in BODIES:
        numbers = [(symbol, results.parameters.get(f"{body}_{name}"), unit) for name, symbol, unit in KNOWN]
        numbers = [
            page.Html(f"{symbol} {page.quantity(float(value), unit, 10)}")
            for symbol, value, unit in numbers
            if np.ndim(value) == 0 and isinstance(value, np.number) and math.isfinite(value)
        ]
        told.append(listed([*filter(None, [options.get("-" + body)]), *numbers]))
    if told[0] == told[1]:
        told = [page.Html(f"both {told[0]}")] if told[0] else []
    else:
        told = [page.Html(f"{k}: {one}") for k, one in enumerate(told, 1) if one]
    kind = str(results.parameters.get("elasticity", "none"))
    return page.Html("; ".join([*told, *filter(None, [page.text(PARTS.get(kind, kind))])])) if told else ""


def _gap(results):
    """Type of the gap and its numbers, without files that are not given."""
    kind = str(results.parameters.get("gap_type", ""))
    parts = [
        page.Html(f"{page.text(name.removeprefix('gap_').replace('_', ' '))} {sheets.as_input(name, value, {})[1]}")
        for name, value in results.parameters.items()
        if name.startswith("gap_") and name != "gap_type" and not str(value) == "none"
    ]
    return listed([kind, *parts]) if kind else ""


def _friction(results, options):
    """The coefficient or its file, and the law if one is given."""
    value = results.parameters.get("friction_file", results.parameters.get("friction"))
    if value is None:
        return ""
    law = options.get("-friction_law")
    number = isinstance(value, np.number)
    if number and value == 0.0 and not law:
        return "none"
    return listed([page.quantity(float(value)) if number else value, *(["law " + law] if law else [])])


def _range(results, name, known):
    """A number of the history: one value, or its least and largest; empty if it is zero to rounding."""
    values = results.series(name).astype(float)
    values = values[np.isfinite(values)]
    size = page.largest(values)
    if size == 0.0 or size <= noise.NOISE * known.get(results.units[name], 0.0):
        return ""
    low, high, unit = float(np.min(values)), float(np.max(values)), results.units[name]
    if high - low <= noise.NOISE * size:
        return page.Html(f"{page.broken(name)} {page.quantity(float(values[-1]), unit, beside=size)}")
    ends = " to ".join(page.quantity(one, unit, beside=size) for one in (low, high))
    return page.Html(f"{page.broken(name)} {ends}")


def _loads(results, options):
    """Loads of all steps, displacements that are prescribed, and the file of the history."""
    prescribed = [name for name in DISPLACEMENTS if name in results.parameters]
    known = noise.scales([results])
    parts = [_range(results, name, known) for name in (*LOADS, *prescribed) if name in results.history]
    told = [one for one in parts if one]
    file = options.get("-load_history") or options.get("-history")
    return listed([*told, *([f"history {file}"] if file else [])])
