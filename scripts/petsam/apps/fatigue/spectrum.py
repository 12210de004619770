"""Lives of a spectrum in one call: lives() takes files or stresses and constants, and returns Lives."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ...core.errors import Error, short
from ...core.tables import Column, Tabled
from ...results.stresses import FATIGUE, Stresses
from . import evaluation, materials, strength
from .stresses import Cycle

MOST = 5  # parameters on the line, unless quantities are named

File = Union[str, os.PathLike, Stresses, Cycle]
Names = Union[str, Sequence[str], None]


@dataclass
class Lives(Tabled):
    """Lives, safety factors and short cracks of the cycles of a spectrum.

    Attributes
    ----------
    cycles : list of stresses.Cycle
        The cycle of each file or contact.
    constants : dict
        {name: number} of the material, SI units.
    values : dict
        {criterion: lives (cycles) or safety factors at all points, (z, y, x), of each cycle}.
    least : dict
        {criterion: evaluation.Place of the least one, of each cycle}.
    bounds : dict
        {criterion: between which the least one of each cycle is by the error of the tractions, or None: unknown}.
    damage : dict
        {criterion: evaluation.Place of the largest damage of the spectrum}, of lives.
    cracks : list
        Of each cycle the least length (m) at which a short crack grows, that of its arrest, and whether it grows from
        the surface on; empty without that criterion.
    lines : list of tuple
        Label of each cycle, and evaluation.Line below the place.
    place : str
        What that place is, in words.
    """

    cycles: list
    constants: dict
    values: dict
    least: dict
    bounds: dict
    damage: dict
    cracks: list
    lines: list
    place: str

    def __repr__(self):
        criteria = f"{', '.join(self.values)} of " if self.values else ""
        return f"Lives({criteria}{', '.join(cycle.label for cycle in self.cycles)}; line below the {self.place})"

    def table(self) -> list[Column]:
        """The lines below one another: file, x, y, z, quantities, lives and factors.

        Returns
        -------
        list of tables.Column
            A row for each depth of each cycle.
        """
        return evaluation.columns(self.lines)


def lives(  # noqa: PLR0913  (as the options of petsam-fatigue)
    sources: Union[File, Iterable[File]],
    constants: Union[str, os.PathLike, Mapping[str, object], None] = None,
    *,
    counts: Optional[ArrayLike] = None,
    criteria: Names = None,
    plane: float = 0.0,
    below: Union[str, tuple[float, float], None] = None,
    quantities: Names = None,
    report: Optional[Callable[[int, int], object]] = None,
) -> Lives:
    """Lives, safety factors and short cracks of one cycle, or of a spectrum of several.

    Parameters
    ----------
    sources : path, petsam.Stresses or petsam.fatigue.stresses.Cycle, or list of them
        File of petsam-stress, or several: the blocks of a spectrum.
    constants : mapping or path, optional
        {name: value} of the material, in SI units or texts with their unit (sigma_f="1.76GPa"), or the name of a YAML
        file of them, or of a material with fatigue constants in petsam.materials. Young's modulus and Poisson's
        ratio are those of the files, if they are not given.
    counts : float or list of floats, optional
        Cycles of each source in the spectrum; None: 1 of each.
    criteria : str or list of str, optional
        Names of evaluation.CRITERIA; None: all for which there are constants and data.
    plane : float
        Angle of the plane's normal to x, degrees, of stresses on planes normal to the surface.
    below : pair of floats or str, optional
        (x, y) in m of the line along the depth, or the quantity whose maximum on the surface is above it; None: the
        first criterion or parameter.
    quantities : str or list of str, optional
        Names of quantities on the line, maxima of the cycle; None: the fatigue parameters.
    report : callable, optional
        Called with the number of parts of the work that are done, and of all: a criterion, or a line.

    Returns
    -------
    Lives

    Raises
    ------
    Error
        For constants that are missing or outside their range, and for files without the data.

    Examples
    --------
    The parameter of Smith, Watson and Topper of 1e5 cycles on the surface, which falls over the depth.

    >>> import numpy as np, petsam
    >>> steel = dict(young=210e9, poisson=0.3, sigma_f=1e9, b=-0.1, epsilon_f=0.3, c=-0.5)
    >>> z, swt = np.linspace(0.0, 1e-3, 5), 1e18 / 210e9 * 2e5**-0.2 + 0.3e9 * 2e5**-0.6
    >>> fields = dict(time=np.zeros(1), swt=(swt * np.exp(-z / 5e-4)).reshape(5, 1, 1))
    >>> cycle = petsam.fatigue.stresses.Cycle(dict(x=np.zeros(1), y=np.zeros(1), z=z, **fields))
    >>> found = petsam.fatigue.lives(cycle, steel, criteria="swt")
    >>> round(found.least["swt"][0].value), found.least["swt"][0].z
    (100000, 0.0)
    """
    cycles = _cycles(sources)
    criteria = [criteria] if isinstance(criteria, str) else criteria
    quantities = [quantities] if isinstance(quantities, str) else quantities
    known = _constants(constants)
    counts = [1.0] * len(cycles) if counts is None else [float(one) for one in np.atleast_1d(counts)]
    if len(counts) != len(cycles) or not all(0.0 < one < np.inf for one in counts):
        raise Error(f"counts: {len(cycles)} files need as many numbers above 0")
    names = list(criteria or evaluation.possible(cycles[0], known, plane))
    on_line = quantities or [name for name in [*FATIGUE][:MOST] if name in cycles[0]] or ["mises"]
    _judge(cycles, names, on_line, known, plane)
    row, column, place = _place(cycles[0], below, names)
    ended, values = _counter(report, len(names) - ("crack" in names) + len(cycles)), {}
    for name in (one for one in names if one != "crack"):
        values[name] = evaluation.lives(cycles, name, known, plane)
        ended()
    least = {
        name: [evaluation.least(cycle, one) for cycle, one in zip(cycles, found)] for name, found in values.items()
    }
    bounds = {name: [evaluation.bounds(cycle, name, known, plane) for cycle in cycles] for name in values}
    lines, cracks = [], []
    for k, cycle in enumerate(cycles):
        computed = {f"{_word(name)}_{name}": ("1", found[k]) for name, found in values.items()}
        line = evaluation.line(cycle, on_line, row, column, computed)
        if "crack" in names:
            found, *lengths = evaluation.crack(cycle, known, plane, row, column)
            line.columns.update(found)
            cracks.append(lengths)
        lines.append((cycle.label, line))
        ended()
    damage = _damage(cycles[0], values, counts)
    return Lives(cycles, known, values, least, bounds, damage, cracks, lines, place)


def _judge(cycles, names, quantities, constants, plane):
    """Error, before anything is computed, where cycles have other points, or lack quantities, or data or constants of
    a criterion."""
    if set(names) - {"crack"}:
        evaluation.need_same_points(cycles)
    for cycle in cycles:
        for name in quantities:
            cycle.need(name)
        for name in names:
            if name != "crack":
                evaluation.known(cycle, name, constants, plane)


def _counter(report, total):
    """A function to call after each of so many parts of the work."""
    done = itertools.count(1)
    return (lambda: report(next(done), total)) if report else (lambda: None)


def _cycles(sources):
    """The Cycles of one source, or of several."""
    if isinstance(sources, (str, os.PathLike, Stresses, Cycle)):
        sources = [sources]
    found = [_cycle(one) for one in sources] if isinstance(sources, Iterable) else []
    if not found:
        raise Error(f"sources {short(repr(sources))}: expected a file of petsam-stress, or several")
    return found


def _cycle(source):
    if isinstance(source, Cycle):
        return source
    if not isinstance(source, (str, os.PathLike, Stresses)):
        raise Error(f"source {short(repr(source))}: expected a file of petsam-stress")
    return Cycle(source if isinstance(source, Stresses) else Stresses(os.fspath(source)))


def _constants(given: Union[str, os.PathLike, Mapping[str, object], None]) -> dict[str, float]:
    """{name: number} of a file's name, or of {name: value}."""
    if given is None or isinstance(given, (str, os.PathLike)):
        return materials.named(os.fspath(given)) if given else {}
    return {name: materials.checked(name, value) for name, value in given.items()}


def _word(name):
    return "life" if name in evaluation.LIVES else "factor"


def _damage(first, values, counts):
    """Place of the largest damage by each life."""
    found = {name: evaluation.least(first, -strength.damage(values[name], counts)) for name in values
             if name in evaluation.LIVES}  # fmt: skip
    return {name: one._replace(value=abs(one.value)) for name, one in found.items()}


def _place(cycle: Cycle, below: Union[str, tuple[float, float], None], criteria: Sequence[str]) -> tuple[int, int, str]:
    """Row, column, and a description of the line's place."""
    if below is not None and not isinstance(below, str):
        return *cycle.nearest(*below), "point nearest to --at"
    name: Optional[str] = below or next((name for name in (*criteria, *FATIGUE, "mises") if name in cycle), None)
    if name is None:
        raise Error(
            f"{cycle.path}: has no fatigue parameter and no mises; name a place by --at, or a quantity by --hot"
        )
    return *cycle.hot_spot(name), f"largest {name} on the surface"
