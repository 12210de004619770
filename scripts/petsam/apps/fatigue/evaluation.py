"""Lives, safety factors, damage and cracks of the cycles of a spectrum: what the command prints and draws."""

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple, Optional

import numpy as np

from ...core.errors import Error
from ...core.tables import Column
from . import cracks, strength
from .materials import need
from .stresses import Cycle, terms

# of each criterion its title and the constants that it needs; of factors the parameter's limit
LIVES = {
    "swt": ("Smith-Watson-Topper", ("young", "sigma_f", "b", "epsilon_f", "c")),
    "fatemi_socie": ("Fatemi-Socie", ("young", "poisson", "tau_f", "b0", "gamma_f", "c0")),
    "basquin": ("Basquin", ("sigma_f", "b")),
}
FACTORS = {name: (name.replace("_", " ").title(), (name + "_limit",)) for name in ("findley", "crossland", "dang_van")}
CRACK = {"crack": ("short crack", ("dk_th", "stress_limit"))}
CRITERIA = {**LIVES, **FACTORS, **CRACK}
POWERS = {"swt": 2}  # of the stress in a parameter; others are proportional to it
OF_STRESS = ("basquin", "crack")  # these need the stress on planes, not a parameter of the file


class Place(NamedTuple):
    """A value and its place.

    Attributes
    ----------
    value : float
        The value, in its unit.
    x, y, z : float
        Coordinates, m.
    """

    value: float
    x: float
    y: float
    z: float


class Line(NamedTuple):
    """Values over the depth below a point.

    Attributes
    ----------
    x, y : float
        The point, m.
    z : ndarray
        Depths, (z,), m.
    columns : dict
        {name: (unit, values)}, values (z,).
    """

    x: float
    y: float
    z: np.ndarray
    columns: dict


def possible(cycle: Cycle, constants: Mapping[str, float], angle: float = 0.0) -> list[str]:
    """Names of the criteria for which a cycle has the data, and for which it or `constants` have the constants."""
    known = {**cycle.constants, **constants}
    return [
        name
        for name, (_, names) in CRITERIA.items()
        if all(one in known for one in names) and has_data(cycle, name, angle)
    ]


def has_data(cycle: Cycle, name: str, angle: float = 0.0) -> bool:
    """True if a cycle has the data for a criterion; angle: of the normal of planes normal to the surface to x,
    degrees."""
    if name not in OF_STRESS:
        return name in cycle
    if name == "crack" and cycle.layered:
        return False
    return cycle.steps > 1 and all(one in cycle for one in terms(angle))


def known(cycle: Cycle, name: str, constants: Mapping[str, float], angle: float = 0.0) -> list[float]:
    """The constants of a criterion, in the order of CRITERIA; Error if these or the data of the cycle are missing."""
    if not has_data(cycle, name, angle):
        wanted = "several steps with -quantities stress" if name in OF_STRESS else f"-fatigue {name}"
        raise Error(f"{cycle.path}: {name}: the data are missing; give petsam-stress {wanted}")
    return need({**cycle.constants, **constants}, CRITERIA[name][1], f"{cycle.path}: {name}")


def _values(cycle, name, constants, angle, scale=1.0):
    """Lives (cycles) or safety factors at all points, (z, y, x), of stresses that are so many times as large."""
    found = known(cycle, name, constants, angle)
    if name == "basquin":
        return strength.basquin(*(scale * one for one in cycle.extremes(angle)), *found, constants.get("ultimate"))
    if name in LIVES:
        return getattr(strength, name)(scale ** POWERS.get(name, 1) * cycle.maximum(name), *found)
    return strength.factor(scale * cycle.maximum(name), *found)


def bounds(
    cycle: Cycle, name: str, constants: Mapping[str, float], angle: float = 0.0
) -> Optional[tuple[float, float]]:
    """The least lives, or safety factors, by stresses that are larger, and smaller, by the error of the tractions.

    None where that is unknown. Stresses are proportional to the tractions; the parameter of Fatemi and Socie is
    taken as proportional, too.
    """
    if not np.isfinite(cycle.error):
        return None
    scales = 1.0 + cycle.error, max(0.0, 1.0 - cycle.error)
    low, high = (float(np.nanmin(_values(cycle, name, constants, angle, scale))) for scale in scales)
    return low, high


def least(cycle: Cycle, values: np.ndarray) -> Place:
    """The least of values, and its place.

    Parameters
    ----------
    cycle : stresses.Cycle
        The cycle, for its points.
    values : ndarray
        Values at its points, (z, y, x).

    Returns
    -------
    Place

    Raises
    ------
    Error
        If no point has a value.
    """
    if not np.isfinite(values).any() and not np.isinf(values).any():
        raise Error(f"{cycle.path}: has no value at any point")
    k, j, i = np.unravel_index(np.nanargmin(values), values.shape)
    return Place(*(float(value) for value in (values[k, j, i], cycle.x[i], cycle.y[j], cycle.z[k])))


def need_same_points(cycles: Sequence[Cycle]) -> None:
    """Raises Error if one of the cycles has other points than the first."""
    first = cycles[0]
    for one in cycles[1:]:
        for mine, its in ((first.x, one.x), (first.y, one.y), (first.z, one.z)):
            if mine.shape != its.shape or not np.allclose(mine, its, rtol=1e-9, atol=1e-12):
                raise Error(
                    f"{one.path}: has other points than {first.path}; give all blocks the same depths and section"
                )


def lives(cycles: Sequence[Cycle], name: str, constants: Mapping[str, float], angle: float = 0.0) -> list[np.ndarray]:
    """Lives, or safety factors, of every cycle at all points.

    Parameters
    ----------
    cycles : list of stresses.Cycle
        The cycles, on the same points.
    name : str
        One of LIVES or FACTORS.
    constants : mapping
        {name: number} of the material, SI units.
    angle : float
        Angle of the normal of planes normal to the surface to x, degrees, for the stress of "basquin".

    Returns
    -------
    list of ndarray
        Lives (cycles) or safety factors of each cycle, (z, y, x).

    Raises
    ------
    Error
        If data or a constant are missing, or the cycles have other points.
    """
    need_same_points(cycles)
    return [_values(one, name, constants, angle) for one in cycles]


def crack(
    cycle: Cycle, constants: Mapping[str, float], angle: float, row: int, column: int
) -> tuple[dict, float, float, bool]:
    """A short crack of the lengths z below a point.

    Parameters
    ----------
    cycle : stresses.Cycle
        The cycle.
    constants : mapping
        {name: number} of the material: dk_th (Pa m^1/2) and stress_limit (Pa).
    angle : float
        Angle of the normal of the crack's plane to x, degrees.
    row, column : int
        Indices of the point along y and x.

    Returns
    -------
    tuple
        {name: (unit, values)} of k_max, k_range and k_threshold at each length, (z,); the least length (m) at which the
        crack grows, that of its arrest from there, and whether it grows from the surface on.

    Raises
    ------
    Error
        If a constant or data are missing, the body has layers, the stresses are means, or there are less than 3 depths.
    """
    limits = need(constants, CRACK["crack"][1], f"{cycle.path}: crack")
    if cycle.layered:
        raise Error(f"{cycle.path}: crack: the body has layers, and K is that of one material; omit it from --criteria")
    if cycle.averaged:
        raise Error(f"{cycle.path}: crack: has means over {cycle.averaged:g} m; omit -fatigue_length of petsam-stress")
    if cycle.z.size < 3:
        raise Error(f"{cycle.path}: crack: has {cycle.z.size} depths; give petsam-stress at least 3 from 0 on")
    if not has_data(cycle, "crack", angle):
        raise Error(f"{cycle.path}: crack: needs several steps and stresses; give petsam-stress -quantities stress")
    high, low = cracks.extremes(cycle.z, cycle.stress_line(angle, row, column), cycle.z)
    thresholds = cracks.threshold(cycle.z, *limits)
    curves = cycle.z[1:], (high - low)[1:], thresholds[1:]
    unit = "Pa m^1/2"
    columns = {"k_max": (unit, high), "k_range": (unit, high - low), "k_threshold": (unit, thresholds)}
    start = cracks.start(*curves)
    longer = curves[0] >= start
    stop = cracks.arrest(*(curve[longer] for curve in curves)) if np.isfinite(start) else 0.0
    return columns, start, stop, cracks.arrest(*curves) > 0.0


def line(
    cycle: Cycle, names: Iterable[str], row: int, column: int, computed: Mapping[str, tuple[str, np.ndarray]]
) -> Line:
    """The Line below a point.

    Parameters
    ----------
    cycle : stresses.Cycle
        The cycle.
    names : list of str
        Quantities of the cycle, of which the line has the largest values over the steps.
    row, column : int
        Indices of the point along y and x.
    computed : mapping
        {name: (unit, values)} of what has been computed at all points, (z, y, x).

    Returns
    -------
    Line

    Raises
    ------
    Error
        If the cycle has no such quantity.
    """
    columns = {name: (cycle.unit(name), cycle.line(name, row, column)) for name in names}
    columns.update({name: (unit, values[:, row, column]) for name, (unit, values) in computed.items()})
    return Line(float(cycle.x[column]), float(cycle.y[row]), cycle.z, columns)


def columns(lines: Sequence[tuple[str, Line]]) -> list[Column]:
    """Pairs of a label and a Line as a table, with a row for each depth of each line; all have the same columns."""
    found = [Column("file", "", "label of the file", [who for who, line in lines for _ in line.z])]
    for name in "xy":
        found.append(Column(name, "m", "place", [getattr(line, name) for _, line in lines for _ in line.z]))
    found.append(Column("z", "m", "depth", np.concatenate([line.z for _, line in lines])))
    for name, (unit, _) in lines[0][1].columns.items():
        values = np.concatenate([line.columns[name][1] for _, line in lines])
        found.append(Column(name, unit, name.replace("_", " "), values))
    return found


__all__ = ["Line", "Place", "crack", "least", "line", "lives"]


def __dir__():
    return __all__
