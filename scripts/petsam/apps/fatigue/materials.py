"""Constants of a material: name, unit, range; from a YAML file of names and values, and from the command line."""

import os
from collections.abc import Iterable, Mapping
from typing import NamedTuple, Union

import yaml

from ...core import materials as table
from ...core import words
from ...core.errors import Error, short, there_are
from ...core.files import need_regular

SMALL = 1 << 20  # bytes of a file of constants at most


class Constant(NamedTuple):
    """A constant of a material: its unit, "1" of a number without one; limits that it does not reach; its meaning."""

    unit: str
    low: float
    high: float
    meaning: str


ELASTIC = ("young", "poisson")
STRESS = ("Pa", 1e5, 1e12)
CONSTANTS = {
    "young": Constant("Pa", 1e6, 1e13, "Young's modulus (the file's)"),
    "poisson": Constant("1", -1.0, 0.5, "Poisson's ratio (the file's)"),
    "sigma_f": Constant(*STRESS, "fatigue strength coefficient"),
    "b": Constant("1", -1.0, 0.0, "fatigue strength exponent"),
    "epsilon_f": Constant("1", 1e-5, 10.0, "fatigue ductility coefficient"),
    "c": Constant("1", -2.0, 0.0, "fatigue ductility exponent"),
    "tau_f": Constant(*STRESS, "the same four in shear: strength coefficient"),
    "b0": Constant("1", -1.0, 0.0, "its exponent"),
    "gamma_f": Constant("1", 1e-5, 10.0, "ductility coefficient"),
    "c0": Constant("1", -2.0, 0.0, "its exponent"),
    "ultimate": Constant(*STRESS, "ultimate strength: Goodman's correction of the S-N life"),
    "findley_limit": Constant(*STRESS, "value of Findley's parameter at the fatigue limit"),
    "crossland_limit": Constant(*STRESS, "the same of Crossland's"),
    "dang_van_limit": Constant(*STRESS, "the same of Dang Van's"),
    "dk_th": Constant("Pa m^1/2", 1e4, 1e9, "threshold range of the stress intensity of long cracks"),
    "stress_limit": Constant(*STRESS, "fatigue limit as a stress range, at the stress ratio of dk_th"),
}


def checked(name: str, value: object) -> float:
    """The value in SI units of a constant, a number or a text of one, which may have its unit; Error if it is wrong."""
    if name not in CONSTANTS:
        raise Error(f"{short(name)} is no constant{there_are(name, CONSTANTS)}")
    one = CONSTANTS[name]
    unit = "" if one.unit == "1" else " " + one.unit
    form = "a number in SI units, or one with its unit" if unit else "a number without a unit"
    try:
        number = words.number(str(value), form, one.unit)
    except words.WordError as error:
        raise Error(f"{name} {error}") from None
    if not one.low < number < one.high:
        cure = "; give it in SI units, or with its unit" if unit else ""
        if one.unit == "1" and 0 < one.low < number / 100 < one.high:  # a strain in percent
            cure = f": give a ratio, {number / 100:g} for {number:g} percent"
        if one.low < -number < one.high:  # tables of materials also have exponents without their sign
            cure = f": give {-number:g}, with its sign"
        raise Error(f"{name} {number:g}{unit} is outside {one.low:g} to {one.high:g}{unit}{cure}")
    return number


def read(path: Union[str, os.PathLike]) -> dict[str, float]:
    """The constants of a YAML file of names and values.

    Parameters
    ----------
    path : str or path
        Name of the file.

    Returns
    -------
    dict
        {name: number in SI units}.

    Raises
    ------
    Error
        If the file cannot be read, is larger than 1 MiB, is no such file, or as checked() does.
    """
    if need_regular(path).st_size > SMALL:
        raise Error(f"{path}: is larger than {SMALL} bytes; give a file of names and values")
    try:
        with open(path, encoding="utf-8") as file:
            values = yaml.load(file, Loader=yaml.BaseLoader)  # texts: YAML takes 010 for 8
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise Error(f"{path}: is not YAML: {short(error)}") from error
    if not isinstance(values, dict):
        raise Error(f"{path}: expected lines such as sigma_f: 1.76GPa")
    try:
        return {str(name): checked(str(name), value) for name, value in values.items()}
    except Error as error:
        raise Error(f"{path}: {error}") from error


def named(text: str) -> dict[str, float]:
    """The fatigue constants, SI units, of a material in petsam's table, or the constants of a YAML file.

    Of a material the elasticity stays that of the stresses' body. Error if there are none, or as of read().
    """
    if os.path.exists(text) or text.endswith((".yaml", ".yml")):
        return read(text)
    one = table.find(text)
    found = {name: value for name, value in one.constants().items() if name in CONSTANTS and name not in ELASTIC}
    if not found:
        have = ", ".join(name for name, row in table.TABLE.items() if row.sigma_f is not None)
        raise Error(f"{one.name}: the table has no fatigue constants of it: give a file; it has those of {have}")
    return found


def need(constants: Mapping[str, float], names: Iterable[str], what: str) -> list[float]:
    """The values of the constants of these names; Error if one is missing, with `what` needs it."""
    lacking = [name for name in names if name not in constants]
    if lacking:
        texts = [f"{name} ({CONSTANTS[name].unit}, {CONSTANTS[name].meaning})" for name in lacking]
        raise Error(f"{what}: {', '.join(texts)}: missing; give it in --material or by --constant")
    return [constants[name] for name in names]


__all__ = ["read"]


def __dir__():
    return __all__
