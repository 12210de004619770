"""Words of the options of petsam-joint, beside those of core/words.py."""

import contextlib
import os

from ...core.words import WordError


def file_name(text, form, endings):
    """The name of a file that exists, or of one with such an ending."""
    return text if os.path.exists(text) else ending(text, form, endings)


def ending(text, form, endings):
    """A name that ends in one of these."""
    if not text.lower().endswith(endings):
        raise WordError(text, form)
    return text


def either(text, form, *readers):
    """Returns the value of the first of several readers that takes a word."""
    for reader in readers:
        with contextlib.suppress(WordError):
            return reader(text)
    raise WordError(text, form)
