"""Profiles of SIMPACK: .prr of rails, .prw of wheels.

`!` begins a comment. What spline.begin ... spline.end states of the points is done in this order: minimum distance,
shift, rotation, bounds (where min < max), mirroring, inversion of the order, units. Lengths are those of the file until
the units are applied.
"""

import re
import warnings
from dataclasses import dataclass, field

import numpy as np

from ...core import units
from ...core.errors import Error, short, there_are
from ...core.files import text_of
from .columns import weights_of
from .profile import KINDS, Profile, ProfileWarning

NUMBERS = {
    "point.dist.min": 0.0, "shift.y": 0.0, "shift.z": 0.0, "rotate": 0.0, "bound.y.min": 1.0, "bound.y.max": 0.0,
    "bound.z.min": 1.0, "bound.z.max": 0.0, "mirror.y": 0.0, "mirror.z": 0.0, "inversion": 0.0, "units.len.f": 1.0,
    "units.ang.f": 1.0, "approx.smooth": 0.0,
}  # fmt: skip
TEXTS = ("file", "file.mtime", "comment", "type", "version", "units.len", "units.ang")
MODES = ("mirror.y", "mirror.z", "inversion")


@dataclass
class _File:
    """The contents of a file: its kind, numbers by key, and points."""

    kind: str = ""
    given: dict[str, float] = field(default_factory=dict)
    points: list[list[float]] = field(default_factory=list)
    ended: bool = False


def read(path: str) -> Profile:
    """The profile in a file of SIMPACK. Raises Error, with file and line, if it has an unknown key, a wrong number, no
    points or no end; a ProfileWarning is issued of approx.smooth, which is not used."""
    found = _parsed(path)
    if found.given.get("approx.smooth"):
        warnings.warn(f"{path}: approx.smooth is not used: see Profile.smoothed()", ProfileWarning, stacklevel=3)
    return _profile(path, found)


def _parsed(path):
    """Kind, numbers and points of a file."""
    found, section = _File(), ""
    for number, line in enumerate(text_of(path).split("\n"), 1):
        words = _uncommented(line)
        if not words:
            continue
        where = f"{path}:{number}"
        if words in ("header.begin", "spline.begin", "point.begin"):
            section = words.partition(".")[0]
        elif words in ("header.end", "spline.end", "point.end"):
            found.ended |= words == "point.end"
            section = "spline" if words == "point.end" else ""
        elif section == "point":
            found.points.append(_point(where, words, found.points))
        elif section:
            _take(where, words, section, found)
        else:
            raise Error(f"{where}: {short(words)}: expected header.begin or spline.begin: is this a file of SIMPACK?")
    if not found.kind:
        raise Error(f"{path}: no type in header.begin ... header.end: give type = 0 (rail) or 1 (wheel)")
    if not found.points or not found.ended:
        lacks = "no points" if not found.points else "no point.end after the points: is the file cut off?"
        raise Error(f"{path}: {lacks}")
    return found


def _uncommented(line):
    """A line without its comment, which a quoted text may contain, and blanks around."""
    return re.match(r"(?:'[^']*'|[^!'])*", line)[0].strip()


def _point(where, words, before):
    """y, z and weight of a line of points."""
    fields = words.split()
    if len(fields) not in (2, 3) or not all(re.fullmatch(units.NUMBER, one) for one in fields):
        raise Error(f"{where}: {short(words)}: expected y and z, and a weight or none")
    values = [*map(float, fields)]
    if before and len(before[0]) != len(values):
        raise Error(f"{where}: {short(words)}: {len(values)} numbers, where earlier points have {len(before[0])}")
    return values


def _take(where, words, section, found):
    """Keeps what a line `key = value` states."""
    key, equal, value = (one.strip() for one in words.partition("="))
    if not equal or not value:
        raise Error(f"{where}: {short(words)}: expected key = value")
    if section == "header" and key == "type":
        if value not in ("0", "1"):
            raise Error(f"{where}: type {short(value)}: expected 0 (rail) or 1 (wheel)")
        found.kind = KINDS[int(value)]
        return
    if key in TEXTS:
        return
    if key not in NUMBERS:
        raise Error(f"{where}: {short(key)}: is no key of a profile{there_are(key, NUMBERS)}")
    if not re.fullmatch(units.NUMBER, value):
        raise Error(f"{where}: {key} = {short(value)}: expected a number")
    found.given[key] = float(value)
    if key in MODES and found.given[key] not in (0.0, 1.0):
        raise Error(f"{where}: {key} = {short(value)}: expected 0 or 1")
    if key.startswith("units") and not found.given[key] > 0.0:
        raise Error(f"{where}: {key} = {short(value)}: expected user units per m or rad, above 0")


def _profile(path, found):
    """The profile of what a file states, its keys applied in their order."""
    given = {**NUMBERS, **found.given}
    table = np.array(found.points)
    with np.errstate(all="ignore"):  # numbers that are too large are named by Profile
        return _moved(path, found.kind, table[_far_enough(table, given["point.dist.min"])], given)


def _moved(path, kind, table, given):
    """The profile of points after shift, rotation, bounds, mirroring, inversion and units."""
    y, z = table[:, 0] + given["shift.y"], table[:, 1] + given["shift.z"]
    angle = given["rotate"] / given["units.ang.f"]
    y, z = y * np.cos(angle) - z * np.sin(angle), y * np.sin(angle) + z * np.cos(angle)
    kept = _within(y, given["bound.y.min"], given["bound.y.max"]) & _within(
        z, given["bound.z.min"], given["bound.z.max"]
    )
    y, z, weights = y[kept], z[kept], weights_of(path, table[kept])
    y, z = (1.0 - 2.0 * given["mirror.y"]) * y, (1.0 - 2.0 * given["mirror.z"]) * z
    order = slice(None, None, -1 if given["inversion"] else 1)
    scale = 1.0 / given["units.len.f"]
    return Profile(
        scale * y[order], scale * z[order], kind, None if weights is None else weights[order], name=str(path)
    )


def _far_enough(table, least):
    """Indices of points that are at least so far from the one kept before."""
    kept = [0]
    for k in range(1, len(table)):
        if np.hypot(*(table[k, :2] - table[kept[-1], :2])) >= least:
            kept.append(k)
    return kept


def _within(values, low, high):
    """True where values are within bounds; bounds with low >= high do not count."""
    return np.ones(len(values), bool) if low >= high else (values >= low) & (values <= high)
