"""The usual page of what an application has found, by its table(): its numbers, and the pictures that take it alone.

An application whose results need more has a module for it: `report` of its record.
"""

import inspect
import re
import typing

from ..core.tables import Tabled
from . import page, sheets
from .style import STYLE, plt

RESULTS = Tabled
SENTENCE = re.compile(r"[.:;](?:\s|$)")


def title(found):
    """The first words of its class's docstring, up to a full stop, colon or semicolon."""
    text = " ".join((type(found).__doc__ or type(found).__name__).split())
    return SENTENCE.split(text, maxsplit=1)[0]


def parts(found, inputs, record):
    """Numbers, pictures and inputs, sections each."""
    return [_numbers(found), *_pictures(found, record), *sheets.of_inputs(inputs)]


def _numbers(found):
    columns = [one._replace(values=list(one.values)) for one in found.table()]
    count = len(columns[0].values) if columns else 0
    rows = [[_cell(one, one.values[row]) for one in columns] for row in sheets.some(count)]
    meanings = [(page.broken(one.name), one.text) for one in columns if one.text]
    table = page.table(sheets.rest(count, "row"), [one.name for one in columns], rows)
    return page.section("Numbers", table, *([page.terms(meanings)] if meanings else []))


def _cell(column, value):
    if not column.unit:
        return page.text(value)
    return (float("nan") if value is None else float(value), column.unit)


def drawing(found, record):
    """Returns the pictures of an application that take one result of this class and need nothing else, by name."""
    pictures = {name: record.picture(name) for names in record.pictures.values() for name in names}
    return {name: one for name, one in pictures.items() if _takes(one, type(found))}


def _takes(picture, kind):
    """Returns whether a picture's first parameter is of a class, and no other one must be given."""
    first, *others = inspect.signature(picture).parameters.values()
    needed = [
        one for one in others if one.default is one.empty and one.kind in (one.POSITIONAL_OR_KEYWORD, one.KEYWORD_ONLY)
    ]
    hint = typing.get_type_hints(inspect.unwrap(picture)).get(first.name)
    return not needed and isinstance(hint, type) and issubclass(kind, hint)


def _pictures(found, record):
    shown = []
    for name, draw in drawing(found, record).items():
        about = inspect.getdoc(draw) or name
        caption = SENTENCE.split(" ".join(about.split()), maxsplit=1)[0]
        with plt.rc_context(STYLE):
            drawn = draw(found)
        shown.append(page.figure(page.image(drawn, f"{caption}, by petsam.plot.{name}"), caption, wide=True))
    return [page.section("Pictures", *shown, class_="page")] if shown else []
