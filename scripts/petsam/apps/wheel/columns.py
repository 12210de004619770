"""Profiles in columns: y, z and a weight or none; `#`, `!` and `%` begin comments."""

import re
import warnings
from typing import Optional

import numpy as np

from ...core import units
from ...core.errors import Error, Unusable, short
from ...core.files import need_regular
from ...core.texttable import Form, Text
from .profile import KINDS, Profile, ProfileWarning, Taken
from .words import split_numbers

FORM = Form(comments=("#", "!", "%"), behind=True)
DIRECTIONS = {"down": 1.0, "up": -1.0}


def read(path: str, kind: str, unit: str, z: str) -> Profile:
    """The profile of a kind, rail or wheel, in a file of columns: y and z of a point in each line, and its weight or
    none, separated by blanks, commas or semicolons. The unit of y and z (mm, m, in, ...) and the direction of z (down
    or up) must be given; a ProfileWarning is issued of a third column that is not used, as weights are above 0."""
    need_regular(path)
    if kind not in KINDS:
        raise Unusable(f"{path}: a file of columns does not state what it is: give kind='rail' or kind='wheel'")
    scale = units.size(unit) if unit else None
    if scale is None:
        what = f"{short(str(unit))} is no unit of length" if unit else "columns have no unit of their own"
        raise Unusable(f"{path}: {what}: give unit='mm' or another of {units.names()}")
    if z not in DIRECTIONS:
        raise Unusable(f"{path}: columns do not state the direction of z: give z='down' or z='up'")
    table = _table(path)
    weights = weights_of(path, table)
    with np.errstate(over="ignore"):
        table = scale * table[:, :2]
    return Profile(table[:, 0], DIRECTIONS[z] * table[:, 1], kind, weights, name=str(path), taken=Taken(z))


def weights_of(path: str, table: np.ndarray) -> Optional[np.ndarray]:
    """The third column of a table (n, 2 or 3), (n,), if it has weights, all above 0; else None, with a warning that
    names the file."""
    if table.shape[1] < 3:
        return None
    if (table[:, 2] > 0.0).all():
        return table[:, 2]
    warnings.warn(
        f"{path}: the third column is not used: its values down to {table[:, 2].min():g} are no weights, which are "
        "above 0",
        ProfileWarning,
        stacklevel=5,
    )
    return None


def _table(path):
    """The numbers of a file, (n, 2 or 3)."""
    rows = []
    for number, line in Text(path, FORM).kept:
        fields, words = split_numbers(line), line.strip()
        if len(fields) not in (2, 3) or not all(re.fullmatch(units.NUMBER, one) for one in fields):
            cure = "; decimals have a point" if any("," in one for one in fields) else ""
            raise Error(f"{path}:{number}: {short(words)}: expected y and z, and a weight or none{cure}")
        if rows and len(rows[0]) != len(fields):
            raise Error(
                f"{path}:{number}: {short(words)}: {len(fields)} numbers, where earlier lines have {len(rows[0])}"
            )
        rows.append([*map(float, fields)])
    if not rows:
        raise Error(f"{path}: no points")
    return np.array(rows)
