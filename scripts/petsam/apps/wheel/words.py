"""Words of a profile's file and of the options of petsam-wheel, beside those of core/words.py."""

import math
import re

from ...core.words import WordError, number


def split_numbers(line):
    """The words of a line of numbers alone, which several signs may separate: semicolons, blanks, or commas."""
    words = re.split(r"[;\s]\s*|,\s+", line.strip())
    return line.strip().split(",") if len(words) == 1 else [word for word in words if word]


def slope(text, form):
    """An angle, rad, or that of a slope of one number to another, 1:40."""
    rise, colon, run = text.removeprefix("-").partition(":")
    if not colon:
        return number(text, form, "rad")
    angle = math.atan(number(rise, form, above=0.0) / number(run, form, above=0.0))
    return -angle if text.startswith("-") else angle


def choice(text, form, known):
    """One word of those that are known."""
    if text not in known:
        raise WordError(text, form)
    return text


def pair(text, form, reader=str, whole=None):
    """The values of two words, LEFT,RIGHT, or twice that of one, as of a text with a comma that is `whole`."""
    words = [text] if whole is not None and whole(text) else [word.strip() for word in text.split(",")]
    if len(words) > 2 or not all(words):
        raise WordError(text, form)
    return reader(words[0]), reader(words[-1])
