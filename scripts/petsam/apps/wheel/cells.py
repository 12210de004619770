"""Errors by the cells: the numbers of an equilibrium beside those on cells twice as wide.

A single difference may be small by chance, as edges lie between cells in their own way in each contact. So the root
mean square over all patches of the position counts, each relative to its scale: forces to N, sizes to their own.
FACTORS were chosen by 34 random positions of two pairs of profiles on cells of 0.2 mm: against cells three times
narrower 90 to 100 % of the errors of a column are covered, and they are 2 to 5 times too large in the median. Of 10
other positions 89 % are covered on cells of 0.3 mm, 83 % on 0.6 mm; those of p_max and creep_x are up to 8 times too
large.
"""

import numpy as np

from ...core import tables

WIDER = 2.0  # cells of the second solution over those of the first one
EXACT = (  # columns that are given, count cells, or follow from the profiles alone
    "ws_y", "ws_yaw", "ws_load", "force_error", "moment_error", "nadal", "speed", "friction", "cells", "stick_cells",
)  # fmt: skip
FORCES = ("n", "fx", "fs", "t_gamma", "track_fx", "track_fy", "track_fz")
SCALES = {  # column, and its power, that the differences of others are relative to
    **dict.fromkeys(FORCES, ("n", 1.0)), "mn": ("n", 4.0 / 3.0), "stick_area": ("area", 1.0),
    **{name: (name, 1.0) for name in ("p_max", "area", "approach")},
}  # fmt: skip
FACTOR = 1.5  # error over the difference
FACTORS = {"p_max": 1.0, "area": 0.8, "radius_difference": 2.0, "creep_x": 2.0, "creep_s": 2.0}
ALONG, SHARE = (
    ("fx", "track_fx"),
    0.15,
)  # forces that the torque couples, and the part of all shear that counts at least
ASIDE = "a lateral force is given"
OTHERS = "cells twice as wide give other patches or no equilibrium"


def errors(found, wider):
    """The columns NAME_error of the table of an equilibrium, from that on cells twice as wide; NaN where that is None,
    or has other patches."""
    one, other = ({column.name: column.values for column in table or ()} for table in (found, wider))
    known = one["side"] == other.get("side")
    columns = []
    for column in found:
        if column.unit and column.name not in EXACT:
            values = _error(one, other, column.name) if known else np.full(len(column.values), np.nan)
            text = f"estimated error of {column.name} by the cells"
            columns.append(tables.Column(f"{column.name}_error", column.unit, text, values.tolist()))
    return columns


def _error(one, other, name):
    """The errors of a column, (rows,)."""
    if name == "ws_lateral":  # the sum of both wheels' forces
        return np.full(len(one[name]), FACTOR * np.linalg.norm(_apart(one, other, "track_fy")))
    scale = _scale(one, name)
    mean = _mean(_apart(one, other, name) / scale)
    if name in ALONG:
        mean = max(mean, SHARE * np.hypot(*(_mean(_apart(one, other, axis) / scale) for axis in ("fx", "fs"))))
    return FACTORS.get(name, FACTOR) * mean * scale


def _apart(one, other, name):
    return np.subtract(one[name], other[name])


def _mean(values):
    return float(np.sqrt(np.mean(values**2)))


def _scale(one, name):
    """The scale that the errors of a column are relative to, (rows,); 1 without one."""
    of, power = SCALES.get(name, (name, 0.0))
    return np.abs(np.array(one[of], dtype=float)) ** power


def are_known(columns):
    """True if columns of errors have numbers."""
    return bool(np.isfinite(columns[0].values).all())
