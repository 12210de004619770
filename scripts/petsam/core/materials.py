"""Materials by name: the table of petsam, whose names -body1, -body2 and the commands take.

import petsam
petsam.materials.find("ti6al4v").young       # Pa
petsam.materials.TABLE["steel"].source
"""

import re
from typing import NamedTuple, Optional, Union

from . import declared, words
from .errors import Error, short, there_are

CONSTANTS = declared.CONSTANTS  # {name: (unit, meaning)}


class Material(NamedTuple):
    """A material; constants in SI units, at room temperature, None where the source states none.

    Attributes
    ----------
    name : str
        Its name.
    aliases : tuple of str
        Other names.
    young, poisson : float
        Young's modulus (Pa) and Poisson's ratio.
    density, conductivity, specific_heat, expansion : float or None
        kg/m3, W/(m K), J/(kg K), 1/K.
    yield_stress : float or None
        Pa.
    sigma_f, b, epsilon_f, c : float or None
        Fatigue strength (Pa) and ductility coefficients, with their exponents.
    source : str
        Where the constants are from.
    """

    name: str
    aliases: tuple
    young: float
    poisson: float
    density: Optional[float]
    conductivity: Optional[float]
    specific_heat: Optional[float]
    expansion: Optional[float]
    yield_stress: Optional[float]  # yield is a word of Python
    sigma_f: Optional[float]
    b: Optional[float]
    epsilon_f: Optional[float]
    c: Optional[float]
    source: str

    def constants(self) -> dict[str, float]:
        """The constants that are known.

        Returns
        -------
        dict
            {name: number}, by the names of CONSTANTS, which has units and meanings.
        """
        values = zip(CONSTANTS, self[2 : 2 + len(CONSTANTS)])
        return {name: value for name, value in values if isinstance(value, (int, float))}


TABLE = {
    name: Material(name, tuple(aliases.split(", ")), *values, source)
    for name, (aliases, values, source) in declared.MATERIALS.items()
}


def plain(name: str) -> str:
    """A name as it is compared: without case, blanks, hyphens and underscores."""
    return re.sub(r"[ _-]", "", name).lower()


def has(name: str) -> bool:
    """True if there is a material of this name or other name."""
    return plain(str(name)) in _NAMES


def find(name: str) -> Material:
    """The material of a name.

    Parameters
    ----------
    name : str
        Name or other name; case, blanks, hyphens and underscores do not count.

    Returns
    -------
    Material

    Raises
    ------
    Error
        If there is none; the message has the nearest name, and all.
    """
    if not has(name):
        raise Error(f"{short(str(name))} is no material{_nearest(name)}")
    return TABLE[_NAMES[plain(str(name))]]


def _nearest(name):
    """The end of the message about an unknown name."""
    said = there_are(plain(str(name)), _NAMES).partition(" meant?")
    near = said[0].removeprefix(": is ").split(" or ")[0] if said[1] else ""
    names = ", ".join(TABLE)
    return f": is {_NAMES[near]} meant? There are {names}" if near else f"; there are {names}"


def elastic(text: str) -> tuple[float, float]:
    """Young's modulus (Pa) and Poisson's ratio of a material's name, or of the text E,NU, as 210GPa,0.3; inf: rigid.

    WordError if it is neither.
    """
    if has(text):
        return find(text)[2:4]
    young, comma, poisson = text.partition(",")
    form = f"{', '.join(TABLE)}, or Young's modulus (inf: rigid) and Poisson's ratio (above -1, up to 0.5): 210GPa,0.3"
    try:
        if not comma and text[:1].isalpha():
            find(text)
        return (
            words.number(young, form, "Pa", lambda value: value > 0.0),
            words.number(poisson, form, allowed=lambda value: -1.0 < value <= 0.5),
        )
    except words.WordError as error:
        raise words.WordError(text, form) from error


def _elastic_of(name):
    """Young's modulus and Poisson's ratio of a name, or of a text E,NU."""
    return elastic(name) if isinstance(name, str) and "," in name and not has(name) else find(name)[2:4]


def conductivity(value: Union[float, str]) -> float:
    """A thermal conductivity, W/(m K), given as a number or as the name of a material; Error if that is unknown."""
    if not isinstance(value, str):
        return float(value)
    found = find(value).conductivity
    if found is None:
        known = ", ".join(name for name, one in TABLE.items() if one.conductivity)
        raise Error(f"{short(value)}: its conductivity is not known: give it as a number; it is of {known}")
    return found


def resolved(options: dict) -> dict:
    """Options of petsam with body1 and body2, names of materials or texts E,NU, as the moduli: body1_young and so on.

    Moduli that are given go before the table.
    """
    found = dict(options)
    for body in ("body1", "body2"):
        if (name := found.pop(body, None)) is None:
            continue
        for constant, value in zip(("young", "poisson"), _elastic_of(name)):
            if found.get(f"{body}_{constant}") is None:
                found[f"{body}_{constant}"] = value
    return found


_NAMES = {plain(one): name for name, row in TABLE.items() for one in (name, *row.aliases)}


__all__ = ["Material", "find"]


def __dir__():
    return __all__
