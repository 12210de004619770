"""Profiles of MiniProf: .whl of wheels, .ban of rails, .mpt of both.

Two layouts: lines Name=value, of which ColumnDef names the columns of the points, or six free lines. Then each line has
the numbers of a point: X and Y, the place across the track and the height, and others, as the angle A, which are not
used. Lengths are in mm. Heights of wheels are down; those of rails are down or up.
"""

import os
import re

import numpy as np

from ...core import units
from ...core.errors import Error, Unusable, short
from ...core.files import text_of
from .columns import DIRECTIONS
from .profile import KINDS, Profile, Taken
from .words import split_numbers

ENDINGS = (".whl", ".ban", ".mpt")
FREE = 6  # lines
STATED = re.compile(r"\s*([A-Za-z][\w .]*?)\s*=(.*)")  # Name=value


def is_one(path: str) -> bool:
    """True if a file is one of MiniProf, by its ending or its line ColumnDef."""
    if os.path.splitext(path)[1].lower() in ENDINGS:
        return True
    return any(re.match(r"\s*ColumnDef\s*=", line, re.I) for line in text_of(path).split("\n"))


def read(path: str, kind: str, unit: str = "", z: str = "") -> Profile:
    """The profile of a kind, rail or wheel, in a file of MiniProf. Lengths are in mm by default. By default Y is down
    (z="down") of a wheel; of a rail in the direction in which its head is convex. Raises Error if the kind is not
    given, a line is no point, or points are missing; with file and line."""
    if kind not in KINDS:
        raise Unusable(f"{path}: a file of MiniProf does not state what it is: give kind='rail' or kind='wheel'")
    scale = units.size(unit or "mm")
    if scale is None:
        raise Unusable(f"{path}: {short(str(unit))} is no unit of length: give unit='mm' or another of {units.names()}")
    if z and z not in DIRECTIONS:
        raise Unusable(f"{path}: z={z!r}: expected down or up")
    points = _points(path)
    with np.errstate(all="ignore"):
        points = scale * points
    z = z or ("down" if kind == "wheel" or _convex(points) else "up")
    return Profile(points[:, 0], DIRECTIONS[z] * points[:, 1], kind, name=str(path), taken=Taken(z))


def _convex(points):
    """True if the ends of a rail's points have the greater heights: they are down."""
    y, z = points.T
    middle = abs(y - 0.5 * (y.min() + y.max())) < 0.25 * (y.max() - y.min())
    inside, outside = (z[middle], z[~middle]) if middle.any() and not middle.all() else (z, z)
    return bool(np.median(outside) >= np.median(inside))


def _points(path):
    """X and Y of the points, (n, 2)."""
    lines = text_of(path).split("\n")
    stated, first = _header(path, lines)
    count = None
    if stated.get("columndef"):
        number, text = stated["columndef"]
        columns = [one.strip().upper() for one in text.split(",")]
        if columns[:2] != ["X", "Y"]:
            raise Error(f"{path}:{number}: ColumnDef={short(text)}: expected X,Y, and others after them or none")
        count = len(columns)
    rows = []
    for number, line in enumerate(lines[first:], first + 1):
        if not line.strip():
            continue
        fields = split_numbers(line)
        if not _numbers(line):
            cure = "; decimals have a point" if "," in line else ""
            raise Error(f"{path}:{number}: {short(line.strip())}: expected the numbers of a point{cure}")
        count = count or len(fields)
        known = count if stated.get("columndef") or count in (2, 3, 5) else "2, 3 or 5"
        if len(fields) != known:
            raise Error(f"{path}:{number}: {len(fields)} numbers: expected {known}")
        rows.append([*map(float, fields[:2])])
    if not rows:
        raise Error(f"{path}: no points")
    _need_all(path, stated, len(rows))
    return np.array(rows)


def _header(path, lines):
    """Number and text of each line Name=value, by the name in small letters, and the index of the first line of points:
    after the lines Name=value, or after six free lines."""
    stated = {}
    for k, line in enumerate(lines):
        found = STATED.fullmatch(line)
        if found:
            stated[found[1].lower()] = k + 1, found[2].strip()
        elif line.strip() and (stated or k >= FREE):
            if not stated:
                _need_header(path, lines)
            return stated, k
    if stated:
        raise Error(f"{path}: no points")
    return stated, min(FREE, len(lines))


def _need_header(path, lines):
    """Raises Error where the free lines of the header are points."""
    if all(len(_numbers(line)) > 1 for line in lines[:FREE]):
        raise Error(
            f"{path}:1: {short(lines[0].strip())}: the numbers of a point, in the first {FREE} lines, which are the "
            "header: name a file without one as columns, .txt, or give it these lines"
        )


def _numbers(line):
    """The words of a line, if all are numbers; else none."""
    fields = split_numbers(line)
    return fields if all(re.fullmatch(units.NUMBER, one) for one in fields) else []


def _need_all(path, stated, count):
    """Raises Error where the header states another number of points."""
    number, text = stated.get("xypoints", (0, ""))
    if text and text != str(count):
        raise Error(
            f"{path}:{number}: XYPoints={short(text)}: the file has {count} points: is it cut off? Mend the line"
        )
