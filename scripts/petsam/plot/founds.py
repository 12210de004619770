"""The page of what an application has found, by its table(): its numbers, its pictures, its inputs.

Errors stand beside their numbers: of columns `a` and `a_error`, or `a_spread`, and what is the same in all rows stands
above the table. Without more, the page has the pictures that take the result alone. An application whose results need
more has a module for it, `report` of its record, with contents(found): a dictionary, of which each may be left out,

    title     the page's title
    columns   tables.Column of the table
    facts     [(name, value)] of what holds for all rows; a value is a text, or a number, its unit and its digits
    pictures  {caption: function that draws the result}
    inputs    {name: value} of the result's own inputs
    limits    {name: name of the column below whose values that number is not resolved}
    digits    {name: digits of numbers whose changes are small} (6)
    whole     whether all rows are shown, however many there are
"""

import inspect
import re
import typing

from ..core.tables import Tabled
from . import page, sheets
from .style import STYLE, plt

RESULTS = Tabled
SENTENCE = re.compile(r"[.:;](?:\s|$)")
DIGITS = 6
ERRORS = ("_error", "_spread")  # ends of the names of errors
PART = "relative"  # the first word of the meaning of an error that is relative to its number


def contents(found, record):
    """The contents of the page: the usual ones, or those of the application's own module."""
    own = record.module(record.report).contents(found) if record.report else {}
    usual = {"title": _title, "columns": lambda one: one.table(), "pictures": lambda one: _captions(one, record)}
    return {**{name: usual[name](found) for name in usual.keys() - own.keys()}, **own}


def parts(found, shown, inputs):
    """Numbers, pictures and inputs, sections each, of these contents."""
    return [
        _numbers(**{name: shown[name] for name in ("columns", "facts", "limits", "digits", "whole") if name in shown}),
        *_pictures(found, shown["pictures"]),
        *sheets.of_inputs({**shown.get("inputs", {}), **inputs}),
    ]


def _title(found):
    """The first words of its class's docstring."""
    return _first(type(found).__doc__ or type(found).__name__)


def _first(text):
    """The words of a text up to a full stop, colon or semicolon."""
    return SENTENCE.split(" ".join(text.split()), maxsplit=1)[0]


# ---------------------------------------------------------------- numbers


def _numbers(columns, facts=(), limits=None, digits=None, whole=False):
    """The table, what its columns mean, and what holds for all rows."""
    columns = [one._replace(values=list(one.values)) for one in columns]
    known, limits, digits = {one.name: one for one in columns}, limits or {}, digits or {}
    owners = {one.name: _owner(one.name, known) for one in columns}
    apart = {name for name, owner in owners.items() if owner} | {*limits.values()}
    shown = [one for one in columns if one.name not in apart]
    same = [one for one in shown[1:] if len(set(one.values)) == 1 < len(one.values)]
    shown = [one for one in shown if one.name not in {other.name for other in same}]
    count = len(columns[0].values) if columns else 0
    some = range(count) if whole else sheets.some(count)
    cells = [
        _cells(
            one,
            [known[name] for name, owner in owners.items() if owner == one.name],
            known.get(limits.get(one.name)),
            digits.get(one.name, DIGITS),
            some,
        )
        for one in shown
    ]
    said = sheets.counted(count, "row") if whole else sheets.rest(count, "row")
    rows = [(page.Html(first), *rest) for first, *rest in zip(*cells)]  # the first column has the rows' heads
    table = page.table(said, [one.name for one in shown], rows)
    sign = "\N{PLUS-MINUS SIGN}"
    meanings = [(page.broken(one.name), one.text) for one in shown if one.text]
    meanings += [(page.broken(f"{sign} of {owner}"), known[name].text) for name, owner in owners.items() if owner]
    facts = [(name, value if isinstance(value, str) else page.quantity(*value)) for name, value in facts]
    facts += [(f"{_capital(one.text or one.name)}, of all rows", _cell(one, one.values[0])) for one in same]
    lead = [page.terms(facts)] if facts else []
    return page.section("Numbers", *lead, table, *([page.terms(meanings)] if meanings else []))


def _capital(text):
    return text[0].upper() + text[1:]


def _owner(name, known):
    """The name of the number whose error a column has; None of another column."""
    names = (name.removesuffix(end) for end in ERRORS if name.endswith(end))
    return next((one for one in names if one in known), None)


def _cell(column, value, digits=DIGITS, size=0.0):
    """A text, or a number with its unit."""
    return page.quantity(_float(value), column.unit, digits, size) if column.unit else page.text(value)


def _float(value):
    return float("nan") if value is None else float(value)


def _cells(column, errors, limit, digits, rows):
    """A cell for each row: a text, a number with its errors beside it, or the limit below which it is."""
    size = page.largest(map(_float, column.values)) if column.unit else 0.0
    cells = []
    for k in rows:
        if limit is not None and column.values[k] < limit.values[k]:
            cells.append(page.Number(f"&lt; {_cell(column, limit.values[k], 2, size)}"))
            continue
        sizes = (
            sheets.percent(one.values[k]) if one.text.startswith(PART) else _cell(column, one.values[k], 2, size)
            for one in errors
        )
        text = "".join([_cell(column, column.values[k], digits, size), *(f" &plusmn; {one}" for one in sizes)])
        cells.append(page.Number(text) if column.unit else page.Html(text))
    return cells


# ---------------------------------------------------------------- pictures


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


def _captions(found, record):
    """{caption: picture} of those that take the result alone: the first words of their docstrings."""
    return {_first(inspect.getdoc(one) or name): one for name, one in drawing(found, record).items()}


def _pictures(found, pictures):
    shown = []
    for caption, draw in pictures.items():
        with plt.rc_context(STYLE):
            drawn = draw(found)
        image = page.image(drawn, f"{caption}, by petsam.plot.{draw.__name__}")
        shown.append(page.figure(image, caption, wide=True))
    return [page.section("Pictures", *shown, class_="page")] if shown else []
