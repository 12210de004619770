"""Reading of a word: a number with its unit and range, several, a span, a name with its value, words by other readers.

`form` describes what an option expects, as "a length above 0, such as 1mm"; any other word raises WordError. Numbers
are good between their ends, `above` or `least` and `below` or `most`, or where `allowed` is true; `together` is whether
those of a word are. A `reader` takes a word and has its own form.
"""

import functools
import math
import operator
import re

import numpy as np

from . import units
from .errors import Error, short, there_are

SIDES = "one or two lengths above 0, such as 1e-3 (m) or 1mm: X[,Y]"
LARGEST_RATIO = 100.0  # of the two sides of a surface or a patch: beyond it, the comma was a decimal comma
MOST = 10000  # numbers of a span


class WordError(Error):
    """A word that is not what an option expects; `known` are units that it may have."""

    def __init__(self, text, form, known=""):
        super().__init__(f"{short(text) or repr('')}: expected {form}" + (f"; units are {known}" if known else ""))
        self.known = known


def _with_ends(reader):
    """Gives a reader of numbers the keywords of their ends, instead of `allowed`; numbers are finite then."""

    @functools.wraps(reader)
    def read(text, *given, above=None, least=None, below=None, most=None, **options):
        ends = ((above, operator.gt), (least, operator.ge), (below, operator.lt), (most, operator.le))
        tests = [(end, is_in) for end, is_in in ends if end is not None]
        if tests:
            options["allowed"] = lambda value: math.isfinite(value) and all(is_in(value, end) for end, is_in in tests)
        return reader(text, *given, **options)

    return read


@_with_ends
def number(text, form="a number", unit="1", allowed=None, bare=""):
    """A finite number, or one that `allowed` takes, in the unit of SI; the word may have another unit of the same
    quantity after it, and is in the unit `bare` without one."""
    found = re.fullmatch(rf"\s*({units.NUMBER}|[+-]?inf)\s*(\D.*?|)\s*", text)
    name = found and (found[2] or bare)
    scale = units.size(name, unit) if name else 1.0
    value = float(found[1]) * scale if found and scale else math.nan
    good = math.isfinite(value) if allowed is None else allowed(value)
    if not good:
        raise WordError(text, form, units.names(unit) if found and scale is None else "")
    return value


@_with_ends
def integer(text, form="a whole number", allowed=None):
    """A whole number."""
    if not re.fullmatch(r"[+-]?[0-9]{1,18}", text) or not (allowed is None or allowed(int(text))):
        raise WordError(text, form)
    return int(text)


@_with_ends
def numbers(text, form="numbers separated by commas", unit="1", allowed=None, count=None, together=None):
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
            raise error if len(words) == 1 else WordError(text, form, error.known) from error
    if together is not None and not together(found):
        raise WordError(text, form)
    return found


def _mixed(text, words, count):
    """True if some numbers have a unit and others have none, as 500,10um has: 0,5mm is 0.5 mm with a decimal comma,
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


@_with_ends
def integers(text, form="whole numbers separated by commas", allowed=None, count=None):
    """Whole numbers separated by commas."""
    words = text.split(",")
    if count is not None and len(words) not in np.atleast_1d(count):
        raise WordError(text, form)
    try:
        return [integer(word, form, allowed) for word in words]
    except WordError as error:
        raise WordError(text, form, error.known) from error


@_with_ends
def span(text, form, unit="1", allowed=None, geometric=False, count=None):
    """An array of FIRST:LAST:COUNT in equal or geometric steps, or of numbers separated by commas, as many as count."""
    words = text.split(":")
    if len(words) == 1:
        return np.array(numbers(text, form, unit, allowed, count))
    if len(words) != 3 or "," in text:
        raise WordError(text, form)
    first, last = (number(word, form, unit, allowed) for word in words[:2])
    steps = integer(words[2], form, least=2, most=MOST)
    if not geometric:
        return np.linspace(first, last, steps)
    return np.array([float(f"{value:.12g}") for value in np.geomspace(first, last, steps)])


@_with_ends
def bounds(text, form, allowed=None, together=None):
    """The whole numbers of FIRST:LAST; None for one that is left out."""
    words = [word.strip() for word in text.split(":")]
    try:
        found = tuple(integer(word, form, allowed) if word else None for word in words)
    except WordError as error:
        raise WordError(text, form, error.known) from error
    if len(found) != 2 or together is not None and not together(found):
        raise WordError(text, form)
    return found


@_with_ends
def named(text, form, unit="1", allowed=None, reader=None, known=None, bare=None):
    """Name and number of NAME=NUMBER, or what another reader makes of the word after a name that the pattern `known`
    fits; a word without a name gets the name `bare`."""
    name, equal, value = text.partition("=")
    if bare is not None and not equal:
        name, value = bare, text
    elif not name or not value or known is not None and not re.fullmatch(known, name):
        raise WordError(text, form)
    try:
        return name, reader(value) if reader else number(value, form, unit, allowed)
    except WordError as error:
        raise WordError(text, form, error.known) from error


def names(text, form="names separated by commas", known=None, what=""):
    """Names separated by commas, of those that are known; `what` they name, for a message with the nearest one."""
    words = text.split(",")
    others = [word for word in words if known is not None and word not in tuple(known)]
    if others and what and all(words):
        raise Error(f"{short(others[0])}: is no {what}{there_are(others[0], known)}")
    if others or not all(words):
        raise WordError(text, form)
    return words


def each(text, form, *readers, rest=()):
    """Words separated by commas, each by its reader; `rest` has the values of the last ones, which may be left out."""
    words = text.split(",")
    lacking = len(readers) - len(words)
    if not 0 <= lacking <= len(rest):
        raise WordError(text, form)
    try:
        return (*(reader(word) for reader, word in zip(readers, words)), *rest[len(rest) - lacking :])
    except WordError as error:
        raise WordError(text, form, error.known) from error


def sides(text):
    """One or two positive lengths, m: x and y."""
    found = numbers(text, SIDES, "m", above=0.0, count=(1, 2))
    x, y = found[0], found[-1]
    if max(x, y) > LARGEST_RATIO * min(x, y):
        raise Error(f"{short(text)}: is {x:g} m x {y:g} m: decimals have a point, not a comma")
    return x, y
