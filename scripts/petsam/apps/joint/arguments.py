"""Checks of arguments: an Error names the argument, its value, and what is expected."""

import numpy as np

from ...core import arrays, materials, words
from ...core.errors import Unusable, short


def integer(name, value, least=1):
    """The value, an integer of `least` or more."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, np.integer)) or value < least:
        raise Unusable(f"{name} {short(repr(value))}: expected an integer >= {least}")
    return int(value)


def real(name, value, what, good):
    """The value, a real number for which good(value) is true; `what` says so in words."""
    try:
        number = float(value)
        if good(number):
            return number
    except (TypeError, ValueError):
        pass
    raise Unusable(f"{name} {short(repr(value))}: expected {what}")


def positive(name, values, what):
    """The values, one or more finite numbers above 0, as an array of one dimension."""
    found = array(name, values, what)
    found = np.atleast_1d(found)
    if not (found.ndim == 1 and found.size and np.all((found > 0.0) & np.isfinite(found))):
        raise Unusable(f"{name}: expected {what}")
    return found


def array(name, values, what="numbers"):
    """The values as an array of real numbers."""
    try:
        return arrays.real(values)
    except (TypeError, ValueError):
        raise Unusable(f"{name}: expected {what}, not {short(repr(values))}") from None


def moduli(bodies):
    """Options of bodies with the moduli of named materials, and Young's moduli of texts as numbers, Pa."""
    found = materials.resolved(bodies)
    for name in ("body1_young", "body2_young"):
        if isinstance(found.get(name), str):
            form = "Young's modulus, such as 210GPa"
            found[name] = words.number(found[name], form, "Pa", lambda young: young > 0.0)
    return found


def need_timeless(contact):
    """Error for a contact of bodies that relax: the steps of joints have no time."""
    if contact.relaxes:
        raise Unusable(
            "relax_moduli: joints are of bodies that do not relax, as their steps have no time: omit the option; for "
            "the loss factor of a loop give petsam.run a history with times, and its cycle to petsam.sliding.numbers"
        )


def modal(name, values, count):
    """The values, a finite number for each of so many modes."""
    found = array(name, values, f"a number for each of {count} modes")
    if found.shape != (count,):
        raise Unusable(f"{name}: has the shape {found.shape}: expected a number for each of {count} modes")
    if not np.all(np.isfinite(found)):
        raise Unusable(f"{name}: expected finite numbers")
    return found
