"""Numbers of an interface per area, over the pressure: Interface, with its tables, elements and cards."""

from __future__ import annotations

import json
import os
from typing import Any, NamedTuple, Optional, Union

import numpy as np

from ...core.errors import Unusable
from ...core.tables import Column, Tabled
from . import decks, elements, windows
from .conductance import Conductors
from .numbers import columns_of
from .ways import ERRORS
from .windows import Loop

MEASURED = "k_n of loading is the stiffness that image correlation measures; k_n of unloading what ultrasound measures"
APART = 0.05  # relative difference from which k_t along x and y are printed both
UNKNOWN_HERE = f"{Tabled.unknown} for these numbers, whose grid is that of the surface: those of finer points show it"
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


class Interface(Tabled):
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
            return Column.noted(found, UNKNOWN_HERE)
        for name, text in (("friction", "coefficient of friction"), ("shear", "shear of the loop over its limit")):
            found.append(Column(name, "1", text, np.full_like(self.numbers["pressure"], getattr(self, name))))
        return Column.noted(found, UNKNOWN_HERE)

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
        about["errors"] = UNKNOWN_HERE
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
            A line on errors, a line of heads, one for each pressure, with a hardness one on both stiffnesses, and one
            on the loops.
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
        return [UNKNOWN_HERE, heads, *body, *([MEASURED] if further else []), *([self._note()] if self.note else [])]

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
