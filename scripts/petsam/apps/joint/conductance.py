"""Thermal or electrical conductance of a rough interface per area, beside its stiffness: Conductors.

It is that of constriction into the spots, of films on them and of what fills the gap, in one problem
(petsam.conduction), without the mean wave: two finite element models whose surfaces are flat conduct in series with it.
It has its own solution, since the normal stiffness of dissimilar bodies contains their stuck shear. The cells in
contact are those from which k_n is taken, all of them, as at an unloading: yielded summits conduct, too.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ...core import materials
from ...core.brief import brief
from ...core.errors import Error, Unusable, short
from ..conduction import Body, of
from ..surface import read_values
from .arguments import array, real

Layers = Sequence[tuple[float, Union[float, str]]]
Film = Union[float, ArrayLike, str, os.PathLike]
COLUMNS = {
    "h_contact": ("W/(m2 K)", "conductance per area through the contact"),
    "h_gap": ("W/(m2 K)", "the same through what fills the gap"),
    "h": ("W/(m2 K)", "the sum of both, from one problem"),
    "resistance": ("m2 K/W", "resistance per area, 1/h"),
}
ELECTRICAL = {"W/(m2 K)": "S/m2", "m2 K/W": "Ohm m2"}
RTOL = 3e-4  # residual of the flux: the error of its sum, a quadratic form, is about the square, that of parts 3e-5
NAME = "film"  # of a field of a film in messages, and of its dataset in HDF5
FIRST, POWER = 0.1, 0.95  # of the lowest pressure, for which a row of a card is extrapolated; in proportion to p^POWER


def columns_of(electrical):
    """{name: (unit, text)} of the numbers of a thermal or an electrical conductance."""
    if not electrical:
        return COLUMNS
    return {name: (ELECTRICAL[unit], f"electrical {text}") for name, (unit, text) in COLUMNS.items()}


class Conductors(NamedTuple):
    """The conductors of an interface: bodies with layers, films, gas.

    Attributes
    ----------
    lam : pair of floats
        Conductivities of both bodies, W/(m K), or S/m.
    film : float or ndarray
        Resistance of a film on the spots, m2 K/W, or Ohm m2; (ny, nx) where it varies.
    gas : pair of floats or None
        Conductivity of what fills the gap, W/(m K), or S/m; length of the temperature jump, m.
    electrical : bool
        True: a current flows instead of heat.
    layers : pair
        Layers on each body, (thickness, conductivity) from the surface inwards, m and W/(m K), or S/m; None: not given.
    film_name : str
        The film's file, or its name in messages.
    """

    lam: tuple[float, float]
    film: Union[float, np.ndarray] = 0.0
    gas: Optional[tuple[float, float]] = None
    electrical: bool = False
    layers: tuple = (None, None)
    film_name: str = NAME

    def columns(self) -> dict[str, tuple[str, str]]:
        """Unit and meaning of each number, by its name.

        Returns
        -------
        dict
        """
        return columns_of(self.electrical)

    @property
    def has_film(self) -> bool:
        """True if a resistance of the film is above 0."""
        return bool(np.any(self.film))

    def fitted(self, shape: tuple[int, int]) -> Conductors:
        """The same; Error unless a film that varies has a value at each point of the surface.

        Parameters
        ----------
        shape : pair of ints
            Points of the surface, (ny, nx).

        Returns
        -------
        Conductors

        Raises
        ------
        Error
            For other points.
        """
        own = np.shape(self.film)
        if own and own != tuple(shape):
            raise (Unusable if self.film_name == NAME else Error)(
                f"{self.film_name}: has {own[1]} x {own[0]} points along x and y, the surface {shape[1]} x {shape[0]}: "
                "give the film at each point of the surface"
            )
        return self

    def mapped(self, change: Any) -> Conductors:
        """The conductors of a part of the surface.

        Parameters
        ----------
        change : callable
            Called with a film that varies, (ny, nx); returns that of the part.

        Returns
        -------
        Conductors
        """
        return self._replace(film=change(self.film)) if np.ndim(self.film) else self

    def measure(self, contact: Any) -> dict[str, float]:
        """The conductances of the committed step of a contact of one period.

        Parameters
        ----------
        contact : petsam.Contact
            The contact.

        Returns
        -------
        dict
        """
        film = self.film if self.has_film else None
        layers1, layers2 = self.layers
        found = of(contact, *self.lam, film=film, gas=self.gas, rtol=RTOL, layers1=layers1, layers2=layers2)
        return {"h_contact": found.contact, "h_gap": found.gap if self.gas else 0.0, "h": found.per_area}

    def words(self) -> str:
        """A description of the conductors for the comment of a card.

        Returns
        -------
        str
        """
        kind = "S/m" if self.electrical else "W/(m K)"
        parts = [f"bodies of {self.lam[0]:g} and {self.lam[1]:g} {kind}"]
        for body, layers in enumerate(self.layers, 1):
            parts += [f"{thickness:g} m of {lam:g} {kind} on body {body}" for thickness, lam in layers or ()]
        if self.has_film:
            between = f"{np.min(self.film):g} to {np.max(self.film):g}" if np.ndim(self.film) else f"{self.film:g}"
            parts.append(f"a film of {between} {'Ohm m2' if self.electrical else 'm2 K/W'}")
        if self.gas:
            parts.append(f"{self.gas[0]:g} {kind} in the gap, temperature jump {self.gas[1]:g} m")
        return ", ".join(parts)


@brief
@dataclass(frozen=True)
class Conducting:
    """The conductors in an interface, as users give them.

    Parameters
    ----------
    conductivity : pair of floats or str, optional
        Conductivities of both bodies, W/(m K), or S/m, or names of materials (petsam.materials): the conductance is
        computed, too, with the columns h_contact, h_gap, h and resistance.
    electrical : bool
        True: it is that of a current, S/m2, instead of heat, W/(m2 K): changes units alone.
    film : float, array_like or path, optional
        Resistance of a film on the spots, m2 K/W, or Ohm m2; at each point of the surface, (ny, nx), where it varies,
        or a file of that: a text, NumPy's .npy, or HDF5 with a dataset film.
    gas : pair of floats, optional
        Conductivity of what fills the gap, W/(m K), or S/m, and the length of the temperature jump, m: of air 0.026,
        0.37e-6; of liquids the length is 0.
    layers1, layers2 : sequence of (thickness, conductivity), optional
        Conducting layers on each body from the surface inwards, m and W/(m K), or S/m; independent of elastic ones.
    """

    conductivity: Optional[ArrayLike] = None
    electrical: bool = False
    film: Optional[Film] = None
    gas: Optional[ArrayLike] = None
    layers1: Optional[Layers] = None
    layers2: Optional[Layers] = None

    def conductors(self) -> Optional[Conductors]:
        """The Conductors, or None without a conductivity; Error for wrong values, and options without it."""
        layers, electrical, gas = (self.layers1, self.layers2), self.electrical, self.gas
        if self.conductivity is None:
            for field in fields(self):
                given = getattr(self, field.name)
                if given if field.name == "electrical" else given is not None:
                    raise Unusable(f"{field.name}: is for the conductance: give the conductivity of both bodies, too")
            return None
        lam = _conductivities(self.conductivity, electrical)
        checked = tuple(None if own is None else Body(one, own).checked().layers for one, own in zip(lam, layers))
        for one, own in enumerate(layers, 1):
            _not_of_a_current(f"layers{one}", [of for _, of in own or ()], electrical)
        if gas is not None:
            gas = _pair("gas", gas, "a conductivity above 0 and a length >= 0, m", lambda a, b: a > 0 and b >= 0)
        film, name = _film(self.film)
        return Conductors(lam, film, gas, bool(electrical), checked, name)


def _conductivities(given, electrical):
    """The conductivities of both bodies as numbers."""
    what = "two numbers above 0, or materials, those of both bodies"
    if np.iterable(given) and not isinstance(given, str):
        _not_of_a_current("conductivity", given, electrical)
        given = [materials.conductivity(one) if isinstance(one, str) else one for one in given]
    return _pair("conductivity", given, what, lambda a, b: a > 0 and b > 0)


def _not_of_a_current(name, values, electrical):
    """Ends with an error where a material is named and a current flows."""
    for named in values:
        if electrical and isinstance(named, str):
            raise Unusable(
                f"{name} {short(named)}: give the conductivity for a current as a number, S/m: "
                "materials have that for heat"
            )


def _film(film):
    """The resistance of a film, a number or a field, and its name in messages."""
    if film is None:
        return 0.0, NAME
    what = "a resistance >= 0, of the spots per area"
    if isinstance(film, (str, os.PathLike)):
        name = os.fspath(film)
        values = read_values(name, NAME)
    elif np.ndim(film) == 0:
        return real("film", film, what, lambda one: 0.0 <= one < np.inf), NAME
    else:
        name, values = NAME, array(NAME, film, what)
    wrong = int(np.count_nonzero(~((values >= 0.0) & (values < np.inf))))
    if values.ndim != 2 or wrong:
        raise (Unusable if name == NAME else Error)(
            f"{name}: {wrong} of {values.size} values are no resistance >= 0: expected one at each point"
        )
    return values, name


def _pair(name, values, what, good):
    """The values, two finite numbers of which good(a, b) holds."""
    found = np.atleast_1d(array(name, values, what))
    if found.shape != (2,) or not np.isfinite(found).all() or not good(*found):
        raise Unusable(f"{name} {values!r}: expected {what}")
    return float(found[0]), float(found[1])


def add_resistance(numbers: dict, spread: dict) -> None:
    """Adds the resistance, that of the mean conductance, to numbers and standard deviations, {name: (pressures,)},
    which it changes in place; without the conductance they stay."""
    if "h" in numbers:
        numbers["resistance"] = 1.0 / numbers["h"]
    if "h" in spread:
        spread["resistance"] = spread["h"] / numbers["h"] ** 2


def rows(numbers: dict) -> list[tuple[float, float]]:
    """Returns the (pressure, conductance) rows of a card, from the pressure 0 (Pa) on, from {name: (pressures,)}.

    Where the pressure is 0 the gap alone conducts, as at the lowest pressure; at a tenth of that the contact's part is
    extrapolated in proportion to p^0.95.
    """
    p, low, gap = numbers["pressure"], float(numbers["h_contact"][0]), float(numbers["h_gap"][0])
    first = [(0.0, gap), (FIRST * float(p[0]), gap + FIRST**POWER * low)]
    return [*first, *((float(a), float(b)) for a, b in zip(p, numbers["h"]))]
