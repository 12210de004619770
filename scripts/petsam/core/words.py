"""Reading of a word: a number with its unit and range, several, a span, a name with its value.

`form` describes what an option expects, as "a length above 0, such as 1mm"; any other word raises WordError.
"""

import math
import re

import numpy as np

from . import units
from .errors import Error, short

SIDES = "one or two lengths above 0, such as 1e-3 (m) or 1mm: X[,Y]"
LARGEST_RATIO = 100.0  # of the two sides of a surface or a patch: beyond it, the comma was a decimal comma
MOST = 10000  # numbers of a span


class WordError(Error):
    """A word that is not what an option expects."""

    def __init__(self, text, form):
        super().__init__(f"{short(text) or repr('')}: expected {form}")


def number(text, form="a number", unit="1", allowed=None):
    """A finite number, or one that `allowed` takes, in the unit of SI; the word may have another unit of the same
    quantity after it."""
    found = re.fullmatch(rf"\s*({units.NUMBER}|[+-]?inf)\s*(\D.*?|)\s*", text)
    scale = units.size(found[2], unit) if found and found[2] else 1.0
    value = float(found[1]) * scale if found and scale else math.nan
    good = math.isfinite(value) if allowed is None else allowed(value)
    if not good:
        known = units.names(unit) if found and scale is None else ""
        raise WordError(text, form + (f"; units are {known}" if known else ""))
    return value


def integer(text, form="a whole number", allowed=None):
    """A whole number."""
    if not re.fullmatch(r"[+-]?\d{1,18}", text) or not (allowed is None or allowed(int(text))):
        raise WordError(text, form)
    return int(text)


def numbers(text, form="numbers separated by commas", unit="1", allowed=None, count=None):
    """Numbers separated by commas, each with its unit or all without one, but 0 needs none; as many as count, a number
    or several."""
    words = text.split(",")
    if _mixed(text, words, count):
        raise WordError(text, f"{form}: give each number its unit, or none ({unit}); decimals have a point")
    if count is not None and len(words) not in np.atleast_1d(count):
        raise WordError(text, form)
    found = []
    for word in words:
        try:
            found.append(number(word, form, unit, allowed))
        except WordError as error:
            raise error if len(words) == 1 else WordError(text, form) from error
    return found


def _mixed(text, words, count):
    """Whether some numbers have a unit and others have none, as 500,10um has: 0,5mm is 0.5 mm with a decimal comma,
    unless two numbers are expected."""
    settled = isinstance(count, int) or not re.search(r"(?<![\d.])0,\d+(?![\d.])", text)
    counted = [word for word in words if not (settled and re.fullmatch(r"\s*[+-]?(0+\.?0*|\.0+)\s*", word))]
    return len({re.fullmatch(rf"\s*({units.NUMBER}|[+-]?inf)\s*", word) is None for word in counted}) > 1


class Measured(list):
    """Numbers in the unit of SI that their words have; unit is "" where they have none."""

    def __init__(self, values, unit=""):
        super().__init__(values)
        self.unit = unit

    def need(self, unit, what):
        """Raises Error unless the words have no unit, or this one of SI; `what` names the words and their use."""
        if self.unit not in ("", unit):
            known = f"a unit of these: {units.names(unit)}" if units.names(unit) else "numbers without a unit"
            raise Error(f"{what}: expected {known}")


def measured(text, form, count):
    """So many numbers of any quantity, as the options have them whose quantity another one names: Measured."""
    found = {units.quantity(re.sub(rf"\s*{units.NUMBER}\s*", "", word, count=1)) for word in text.split(",")}
    unit = (found - {""} or {""}).pop() if len(found - {""}) < 2 else None
    if unit is None:
        raise WordError(text, form)
    return Measured(numbers(text, form, unit or "1", count=count), unit)


def limits(text, form="LOW,HIGH, the lower one first"):
    """Two numbers of any quantity, the lower one first: Measured."""
    low, high = found = measured(text, form, 2)
    if not low < high:
        raise WordError(text, form)
    return found


def integers(text, form="whole numbers separated by commas", allowed=None, count=None):
    """Whole numbers separated by commas."""
    words = text.split(",")
    if count is not None and len(words) not in np.atleast_1d(count):
        raise WordError(text, form)
    try:
        return [integer(word, form, allowed) for word in words]
    except WordError as error:
        raise WordError(text, form) from error


def span(text, form, unit="1", allowed=None, geometric=False):
    """An array of FIRST:LAST:COUNT in equal or geometric steps, or of numbers separated by commas."""
    words = text.split(":")
    if len(words) == 1:
        return np.array(numbers(text, form, unit, allowed))
    if len(words) != 3 or "," in text:
        raise WordError(text, form)
    first, last = (number(word, form, unit, allowed) for word in words[:2])
    count = integer(words[2], form, lambda value: 2 <= value <= MOST)
    if not geometric:
        return np.linspace(first, last, count)
    return np.array([float(f"{value:.12g}") for value in np.geomspace(first, last, count)])


def named(text, form, unit="1", allowed=None):
    """Name and number of NAME=NUMBER."""
    name, equal, value = text.partition("=")
    if not name or not equal:
        raise WordError(text, form)
    try:
        return name, number(value, form, unit, allowed)
    except WordError as error:
        raise WordError(text, form) from error


def names(text, form="names separated by commas", known=None):
    """Names separated by commas, of those that are known."""
    words = text.split(",")
    if not all(words) or known is not None and not set(words) <= set(known):
        raise WordError(text, form)
    return words


def positive(value):
    """Whether a number is above 0 and finite."""
    return 0.0 < value < math.inf


def sides(text):
    """One or two positive lengths, m: x and y."""
    found = numbers(text, SIDES, "m", positive, count=(1, 2))
    x, y = found[0], found[-1]
    if max(x, y) > LARGEST_RATIO * min(x, y):
        raise Error(f"{short(text)}: is {x:g} m x {y:g} m: decimals have a point, not a comma")
    return x, y
