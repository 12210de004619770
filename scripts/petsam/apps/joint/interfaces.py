"""Contact stiffness of an interface per area, from its surfaces: interface(), by of_interface() or of_windows().

The surfaces are taken as one period, so that the displacement of the bodies' mean planes is that of the interface
alone: a uniform pressure displaces nothing. So the stiffnesses are those of springs between two finite element models
whose surfaces are flat, and nothing of the bodies is counted twice. A window of a half-space would add the compliance
of the bodies below it, which depends on the window's size.
"""

from __future__ import annotations

import functools
import json
import os
import warnings
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ...contact.inprocess import AdviceWarning
from ...core.errors import Unusable
from ...core.keywords import unfolded
from ...core.shown import Shown
from ...core.tables import Column, Tabled
from ..conduction import need_conducting
from . import decks, elements, windows
from .arguments import array, moduli, positive
from .conductance import Conducting, Conductors, add_resistance
from .numbers import columns_of
from .surfaces import need_fitting, read_separation
from .ways import ERRORS, Report, Ways, computed, errors
from .windows import Loop, Window

NO_FIT = f"{'-':>10} {'-':>5} {'-':>8}"
MEASURED = "k_n of loading is the stiffness that image correlation measures; k_n of unloading what ultrasound measures"
CALLER = 6  # frames from _tell_warnings() to the code that calls a function of the public list
APART = 0.05  # relative difference from which k_t along x and y are printed both
COLUMNS = {
    "pressure": ("Pa", "nominal pressure"),
    "closure": ("m", "approach of the mean planes since the first touch"),
    "separation": ("m", "mean distance of the surfaces"),
    "k_n": ("Pa/m", "normal stiffness per area, d(pressure)/d(closure), elastic, of unloading"),
    "k_n_loading": ("Pa/m", "the same of further loading, while summits yield"),
    "k_n_secant": ("Pa/m", "pressure over closure"),
    "k_t_x": ("Pa/m", "tangential stiffness per area along x, of sticking contacts"),
    "k_t_y": ("Pa/m", "the same along y"),
    "area": ("1", "real contact area over the nominal one"),
    "loop_amplitude": ("m", "amplitude of the displacement in a loop of the shear"),
    "loop_energy": ("J/m2", "dissipated energy of that loop per area"),
    "loop_stiffness": ("Pa/m", "secant stiffness of that loop along x"),
    "iwan_chi": ("1", "exponent of the slider limits of an Iwan element"),
    "iwan_beta": ("1", "weight of its last slider"),
    "iwan_error": ("1", "largest relative error of its loops' energy"),
    "iwan_shear_error": ("1", "the same of their shear"),
}
FITTED = [name for name in COLUMNS if name.startswith("iwan")]


class Outcome(NamedTuple):
    """Numbers of an interface before its elements are fitted."""

    numbers: dict  # {name: (pressures,)}: means of windows
    spread: dict  # their standard deviations
    loading: np.ndarray  # displacements of the first loading, (pressures, parts), m
    errors: dict  # {name: (pressures,)}: relative errors of the formula, for ERRORS; empty for computed loops
    note: str  # how the loops were found, in words


class Interface(Tabled, Shown):
    """Numbers of an interface at nominal pressures, each an array: pressure, k_n, k_t_x, area ... (COLUMNS).

    Parameters
    ----------
    outcome : Outcome
        The numbers in the units of COLUMNS, their spread, errors, and the first loading; those of the Iwan element are
        added. Without a loop these are the normal ones alone.
    loop : Loop or None
        Coefficient of friction, shear over its limit, and steps of the loop.
    bodies : dict
        Options of the bodies, as given.
    conductors : Conductors, optional
        The conducting bodies, if the conductance is computed.

    Attributes
    ----------
    spread : dict
        {name: (pressures,)}: standard deviation among the windows; empty for one window.
    errors : dict
        {name: (pressures,)}: relative errors of loop_energy and loop_stiffness, where they are found by the formula:
        differences from the computed loop of one window; empty where all loops are computed.
    note : str
        How the loops were found, in words.
    friction, shear : float or None
        Coefficient of friction; amplitude of the mean shear in the loop over friction times pressure.
    parts : ndarray
        Shears of the first loading over friction times pressure, rising, (parts,).
    loading : ndarray
        Displacements at them, (pressures, parts), m, to which the Iwan element is fitted; of windows the mean,
        weighted by their k_t_x.
    """

    def __init__(
        self, outcome: Outcome, loop: Optional[Loop], bodies: dict[str, Any], conductors: Optional[Conductors] = None
    ) -> None:
        numbers, self.spread, self.loading, self.errors, self.note = outcome
        self.bodies, self.friction, self.shear, self.conductors = bodies, None, None, conductors
        self.parts, self.numbers = np.empty(0), numbers
        if loop:
            self.friction, self.shear, self.parts = loop.friction, loop.shear, loop.parts()
            unit = numbers["k_t_x"] / (loop.friction * numbers["pressure"])
            fits = [elements.fit_iwan(self.parts, row * one) for row, one in zip(self.loading, unit)]
            self.numbers = {**numbers, **dict(zip(FITTED, np.transpose(fits)))}
            self._compare(unit)
        self.__dict__.update(self.numbers)

    def _compare(self, unit):
        """Adds the computed loop to the errors of energy: dissimilar bodies do not follow Masing's rule."""
        of = self.numbers
        found = elements.iwan(of["iwan_chi"], of["iwan_beta"], of["loop_amplitude"] * unit)[1] * of["k_t_x"] / unit**2
        energy = np.where(of["loop_energy"] > 0, of["loop_energy"], found)
        of["iwan_error"] = np.maximum(of["iwan_error"], np.abs(found / energy - 1))

    def __repr__(self):
        p = self.numbers["pressure"]
        return f"Interface({len(p)} pressures from {p[0]:.4g} to {p[-1]:.4g} Pa: {', '.join(self.numbers)})"

    def table(self) -> list[Column]:
        """The columns, with a row for each pressure; NAME_spread are standard deviations of windows, NAME_error errors.

        The last columns are the coefficient of friction and the shear of the loop over friction times pressure.

        Returns
        -------
        list of tables.Column
        """
        known = {**COLUMNS, **(self.conductors.columns() if self.conductors else {})}
        found = columns_of({name: one for name, one in known.items() if name in self.numbers}, self.numbers)
        for name, values in self.spread.items():
            unit, text = known[name]
            found.append(Column(f"{name}_spread", unit, f"standard deviation: {text}", values))
        for name, values in self.errors.items():
            found.append(Column(f"{name}_error", "1", ERRORS[name], values))
        if self.friction is None:
            return found
        for name, text in (("friction", "coefficient of friction"), ("shear", "shear of the loop over its limit")):
            found.append(Column(name, "1", text, np.full_like(self.numbers["pressure"], getattr(self, name))))
        return found

    def elements(self, area: float = 1.0) -> list[dict[str, Any]]:
        """Elements for programs of harmonic balance, one for each pressure; see elements.of_codes().

        Parameters
        ----------
        area : float
            Area of an element, m2.

        Returns
        -------
        list of dict
            Of each pressure: the pressure (Pa), the elements by program and class, and the Iwan element's errors. The
            tangential stiffness is that along x, as the loop's.

        Raises
        ------
        Error
            Without friction.
        """
        self._need_friction("elements")
        rows = zip(*(self.numbers[name] for name in ("pressure", "k_n", "k_t_x", *FITTED)))
        return [
            {
                "pressure": float(p),
                **elements.of_codes(float(p), float(k_n), float(k_t), self.friction, float(chi), float(beta), area),
                "iwan_error": float(error),
                "iwan_shear_error": float(shear_error),
            }
            for p, k_n, k_t, chi, beta, error, shear_error in rows
        ]

    def _need_friction(self, what):
        if self.friction is None:
            raise Unusable(f"{what}: need k_t and loops: compute the interface without normal_only")

    def to_json(self, path: Union[str, os.PathLike], area: float = 1.0) -> None:
        """Writes elements() as JSON, in SI units, and what they are of; NaN as null.

        Parameters
        ----------
        path : str or path
            Name of the file, which is replaced.
        area : float
            Area of an element, m2.

        Raises
        ------
        OSError
            If the file cannot be written.
        """
        self._need_friction("to_json")
        about = {"units": "SI: N, m, Pa, N/m; displacements of body 2 against body 1", "area": area}
        about.update(friction=self.friction, shear=self.shear, bodies=self.bodies)
        text = json.dumps({**about, "elements": self.elements(area)}, indent=1, default=str).replace("NaN", "null")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text + "\n")

    def to_abaqus(self, path: Union[str, os.PathLike], name: str = "INTERFACE") -> None:
        """Writes the interaction for a deck of Abaqus in N, mm: pressure over overclosure, friction, and the
        conductance over the pressure, if it is computed, in mW/(mm2 K), or S/mm2.

        The allowable elastic slip of the penalty method is friction times pressure over the tangential stiffness. The
        deck has one for all pressures, the median, and in a comment the range.

        Parameters
        ----------
        path : str or path
            Name of the file, which is replaced.
        name : str
            Name of the interaction in the deck.

        Raises
        ------
        OSError
            If the file cannot be written.
        """
        if self.conductors is None:
            self._need_friction("to_abaqus")
        _write(path, decks.abaqus(self, name))

    def to_calculix(self, path: Union[str, os.PathLike], name: str = "INTERFACE") -> None:
        """Writes the interaction for a deck of CalculiX in N, mm, s, K: linear overclosure, friction, conductance.

        CalculiX finds the pressure of `*GAP CONDUCTANCE` by a linear overclosure alone, in pairs SURFACE TO
        SURFACE; its slope is the median of pressure over closure. It has no electrical contact: an electrical
        conductance, S/mm2, is written as one of heat, for a model whose temperatures are potentials, V.

        Parameters
        ----------
        path : str or path
            Name of the file, which is replaced.
        name : str
            Name of the interaction in the deck.

        Raises
        ------
        Error
            Without a conductance.
        OSError
            If the file cannot be written.
        """
        if self.conductors is None:
            raise Unusable("to_calculix: needs a conductance: compute the interface with conductivity")
        _write(path, decks.calculix(self, name))

    def lines(self) -> list[str]:
        """The table that petsam-joint prints: in MPa, N/mm3, %, mJ/m2, with the windows' deviations in %.

        Returns
        -------
        list of str
            A line of heads, one for each pressure, with a hardness one on both stiffnesses, and one on the loops.
        """
        columns = [("p/MPa", 8, "{:8.4g}", self.numbers["pressure"] / 1e6)]
        further = windows.LOADING in self.numbers
        columns.append(
            ("unloading: k_n/(N/mm3)" if further else "k_n/(N/mm3)", 12, "{:12.4g}", self.numbers["k_n"] / 1e9)
        )
        columns.append(self._deviation("k_n"))
        if further:
            columns.append(("loading: k_n/(N/mm3)", 12, "{:12.4g}", self.numbers[windows.LOADING] / 1e9))
        if self.conductors:
            columns += self._conductance_columns()
        columns += self._shared_columns() if self.friction is not None else self._normal_columns()
        rows = zip(*([form.format(value) for value in values] for _, _, form, values in columns))
        widths = [max(width, len(head) + 1) for head, width, _, _ in columns]
        heads = " ".join(head.rjust(width) for (head, *_), width in zip(columns, widths))
        body = [" ".join(cell.replace("nan", "  -").rjust(width) for cell, width in zip(row, widths)) for row in rows]
        return [heads, *body, *([MEASURED] if further else []), *([self._note()] if self.note else [])]

    def _deviation(self, name):
        """The column of a standard deviation of windows, %."""
        with np.errstate(invalid="ignore"):  # no energy, if nothing slips
            part = 100.0 * self.spread.get(name, np.full_like(self.numbers["pressure"], np.nan)) / self.numbers[name]
        return "+- %", 5, "{:5.0f}", part

    def _conductance_columns(self):
        """The conductance with its deviation, and the part of the gap where something fills it."""
        unit = self.conductors.columns()["h"][0]
        found = [(f"h/({unit})", 13, "{:13.4g}", self.h), self._deviation("h")]
        if self.conductors.gas:
            found.append((f"h_gap/({unit})", 13, "{:13.4g}", self.h_gap))
        return found

    def _normal_columns(self):
        return [
            ("area/%", 7, "{:7.2f}", 100.0 * self.area), self._deviation("area"),
            ("separation/um", 13, "{:13.4g}", 1e6 * self.separation), self._deviation("separation"),
        ]  # fmt: skip

    def _shared_columns(self):
        k_t = (self.k_t_x + self.k_t_y) / 2
        columns = [("k_t/(N/mm3)", 12, "{:12.4g}", k_t / 1e9)]
        if np.max(np.abs(self.k_t_x - self.k_t_y) / k_t) > APART:
            columns = [(f"k_t_{c}/(N/mm3)", 12, "{:12.4g}", self.numbers[f"k_t_{c}"] / 1e9) for c in "xy"]
        fit = np.isfinite(self.iwan_chi)
        blank = lambda values: np.where(fit, values, np.nan)  # noqa: E731
        return [
            *columns, ("k_t/k_n", 8, "{:8.4f}", k_t / self.k_n), ("area/%", 7, "{:7.2f}", 100.0 * self.area),
            ("loop/(mJ/m2)", 13, "{:13.3g}", 1e3 * self.loop_energy), self._deviation("loop_energy"),
            ("Iwan: chi", 10, "{:10.2f}", blank(self.iwan_chi)), ("beta", 5, "{:5.2f}", blank(self.iwan_beta)),
            ("error/%", 8, "{:8.0f}", blank(100.0 * self.iwan_error)),
        ]  # fmt: skip

    def _note(self):
        """How the loops were found, with the errors of the formula."""
        if not self.errors:
            return self.note
        said = " %, ".join(
            f"{text} {100 * np.nanmax(self.errors[name]):.1f}"
            for name, text in (("loop_energy", "energy"), ("loop_stiffness", "secant"))
        )
        return f"{self.note}: {said} %"


def _write(path, lines):
    """Writes lines to a file."""
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


def _tell_warnings(found):
    """Gives one warning for all those of solutions, (place, text, kind)."""
    said = []
    for place, text, kind in found:
        if issubclass(kind, AdviceWarning):
            said.append(f"{place}: {text.partition(': use ')[0]}")
        else:
            warnings.warn(text, kind, stacklevel=CALLER)
    if said:
        text = f"{len(said)} solutions have a warning, the first at {said[0]}; finer points of the surface resolve more"
        warnings.warn(text, AdviceWarning, stacklevel=CALLER)


def mirrored(separation: np.ndarray) -> np.ndarray:
    """The separation and its mirror images beside it: repeated, it has no steps at its borders.

    Parameters
    ----------
    separation : ndarray
        Separation, (ny, nx), m.

    Returns
    -------
    ndarray
        Separation, (2 ny, 2 nx), m.
    """
    return np.pad(separation, [(0, size) for size in separation.shape], mode="symmetric")


COMMON = """
Parameters
----------
separation : array_like
    Separation, (ny, nx), m, larger where the surfaces are farther apart.
spacing : float or pair of floats
    Distance of its points along x and y, m, or one for both.
pressures : array_like
    Nominal pressures, (pressures,), Pa, rising.
report : callable, optional
    Called with the number of the windows that are done, and of all.
conductors : Conductors, optional
    The conducting bodies: the conductance is computed, too.
**bodies
    Options of the two bodies, body1_young (Pa), body1_poisson, body2_young, ..., and of the solution.

Returns
-------
Interface

Raises
------
Error
    For wrong values, a surface that cannot be read, and a pressure that closes the interface.
ContactError
    Where petsam finds no solution.
"""
of_surfaces = functools.partial(unfolded, common=COMMON)


@of_surfaces
def of_interface(
    separation: ArrayLike, spacing: ArrayLike, pressures: ArrayLike, *, ways: Ways,
    conductors: Optional[Conductors] = None, **bodies: Any,
) -> Interface:  # fmt: skip
    """The Interface of a separation that repeats itself. Warnings of its solutions are gathered in one."""
    return _of_interface(separation, spacing, pressures, ways, conductors, bodies)


@of_surfaces
def of_windows(
    separation: ArrayLike, spacing: ArrayLike, pressures: ArrayLike, *, ways: Ways, report: Optional[Report] = None,
    conductors: Optional[Conductors] = None, **bodies: Any,
) -> Interface:  # fmt: skip
    """The Interface of a measured separation: means and standard deviations of five windows of it, half as wide.

    Four windows have the corners, one the middle. Each is mirrored, so that it repeats itself.

    Parameters
    ----------
    separation : array_like
        Separation, (ny, nx), m, of 4 x 4 points or more.

    Returns
    -------
    Interface
        The means; `spread` has the standard deviations.
    """
    return _of_windows(separation, spacing, pressures, ways, conductors, bodies, report)


@of_surfaces
def interface(
    surface: Any, pressures: ArrayLike, *, spacing: Optional[ArrayLike] = None, periodic: bool = False, ways: Ways,
    report: Optional[Report] = None, conducting: Conducting, **bodies: Any,
) -> Interface:  # fmt: skip
    """The Interface of a surface: a scan in a file, a map of petsam.surface, or an array.

    Parameters
    ----------
    surface : path, petsam.surface.Map, or array_like
        Heights or a separation in a file of petsam-surface or in a map; an array (ny, nx) is the separation, m.
    spacing : float or pair of floats, optional
        Distance of the points of an array along x and y, m; files and maps have their own.
    periodic : bool
        Whether the surface repeats itself; else five windows of it give means and standard deviations.
    **bodies
        Options of the bodies, body1="steel" (petsam.materials), or body1_young (Pa, or "210GPa"), body1_poisson,
        body2_young, ..., and of the solution.
    """
    conductors = conducting.conductors()
    if isinstance(surface, (str, os.PathLike)):
        surface, own, doubts = read_separation(os.fspath(surface))
        for text in doubts:
            warnings.warn(text, AdviceWarning, stacklevel=3)
    elif hasattr(surface, "quantity"):
        own = tuple(side / n for side, n in zip(surface.size, surface.n))
        surface = surface.values if surface.quantity == "separation" else -surface.values
    else:
        own = spacing
        if spacing is None:
            raise Unusable("spacing: give the distance of the points of an array, m")
    if spacing is not None and own is not spacing:
        raise Unusable("spacing: the surface has its own: leave it out")
    bodies = moduli(bodies)
    if periodic:
        return _of_interface(surface, own, pressures, ways, conductors, bodies)
    return _of_windows(surface, own, pressures, ways, conductors, bodies, report)


def _of_interface(separation, spacing, pressures, ways, conductors, bodies):
    """The Interface of a separation that repeats itself."""
    separation, ways = array("separation", separation), _checked(ways, conductors, bodies)
    cuts = [_Cut(separation, "", conductors and conductors.fitted(separation.shape))]
    return _of_cuts(cuts, spacing, pressures, ways, conductors, bodies)


def _of_windows(separation, spacing, pressures, ways, conductors, bodies, report):
    """The Interface of five windows of a separation."""
    separation = array("separation", separation)
    if separation.ndim != 2 or min(separation.shape) < 4:
        raise Unusable("separation: expected a field of 4 x 4 points or more")
    ny, nx = (size // 2 for size in separation.shape)
    y, x = separation.shape[0] - ny, separation.shape[1] - nx
    places = [(0, 0), (0, x), (y, 0), (y, x), (y // 2, x // 2)]
    ways = _checked(ways, conductors, bodies)
    if conductors:
        conductors.fitted(separation.shape)
    cuts = []
    for k, (j, i) in enumerate(places, 1):

        def window(field, j=j, i=i):
            return mirrored(field[j : j + ny, i : i + nx])

        name = f" in window {k} with its mirror images"
        cuts.append(_Cut(window(separation), name, conductors and conductors.mapped(window)))
    return _of_cuts(cuts, spacing, pressures, ways, conductors, bodies, report)


def _checked(ways, conductors, bodies):
    """Checked ways; Error where conductors do not go with the options of the bodies."""
    if conductors:
        need_conducting(bodies, *conductors.layers)
    return ways.checked()


class _Cut(NamedTuple):
    """A window's separation, its name in warnings, and what conducts there."""

    field: np.ndarray
    name: str
    conductors: Optional[Conductors]


def _of_cuts(cuts, spacing, pressures, ways, conductors, bodies, report=None):
    """The Interface of windows."""
    loop, reason = ways.loop(), ways.reason(bodies)
    pressures = np.atleast_1d(array("pressures", pressures))
    for field, *_ in cuts:
        if field.ndim != 2 or not np.isfinite(field).all():
            raise Unusable(
                "separation: expected a field (ny, nx) of finite numbers: fill missing points, .fill() of a map"
            )
    if pressures.ndim != 1 or not pressures.size or not (np.diff(pressures, prepend=0.0) > 0).all():
        raise Unusable("pressures: expected positive pressures that rise")
    step = positive("spacing", spacing, "lengths above 0")
    if step.size > 2:
        raise Unusable(f"spacing {spacing!r}: expected the distance of points along x and y, or one for both")
    step = np.broadcast_to(step, 2)
    for field, *_ in cuts:
        need_fitting(field, step, pressures, loop and loop.friction, bodies)
    given = tuple(map(float, pressures))
    parts = [Window(field, step, given, loop, bodies, name, not k, own) for k, (field, name, own) in enumerate(cuts)]
    found = computed(parts, ways, reason, report)
    _tell_warnings([one for each in found for one in each.warnings])
    several, each = found[: len(parts)], found[len(parts) :]
    numbers = {name: np.mean([one.numbers[name] for one in several], axis=0) for name in several[0].numbers}
    spread = {}
    if len(parts) > 1:
        for name in numbers:
            if name != "pressure":
                spread[name] = np.std([one.numbers[name] for one in several], axis=0, ddof=1)
    add_resistance(numbers, spread)
    loading = several[0].loading
    if loop and len(parts) > 1:
        # shears over their own stiffness: a mean of the displacements would be that of compliances, and seem to slip
        loading = np.mean([one.loading * one.numbers["k_t_x"][:, None] for one in several], axis=0)
        loading /= numbers["k_t_x"][:, None]
    wrong, note = errors(several[0], each, ways, reason, given)
    return Interface(Outcome(numbers, spread, loading, wrong, note), loop, bodies, conductors)
