"""The repr() of results, in a few lines: numbers as they are, of arrays the shape and the range."""

import dataclasses
import textwrap

import numpy as np

from .errors import counted, short

WIDTH = 110  # characters of a line
FEW = 4  # values that are shown; of more the count

_NUMBERS = (bool, int, float, complex, np.number, np.bool_)


def brief(kind):
    """Makes the repr() of a dataclass short: a decorator above @dataclass."""
    kind.__repr__ = _text
    return kind


def _text(one):
    parts = [f"{field.name}={shown(getattr(one, field.name))}" for field in dataclasses.fields(one)]
    text = f"{type(one).__name__}({', '.join(parts)})"
    return textwrap.fill(text, WIDTH, subsequent_indent="    ", break_long_words=False, break_on_hyphens=False)


def shown(value):
    """A value in a few words."""
    if isinstance(value, np.ndarray):
        return _array(value)
    if isinstance(value, _NUMBERS):
        return f"{value:.6g}" if isinstance(value, (float, np.floating)) else str(value)
    if isinstance(value, str):
        return short(repr(value))
    if isinstance(value, dict):
        names = ", ".join(str(name) for name in value)
        return "{" + (short(names) if names else "") + "}"
    if isinstance(value, (list, tuple)):
        inner = ", ".join(map(shown, value))
        open_, close = "[]" if isinstance(value, list) else "()"
        whole = open_ + inner + "," * (len(value) == 1 and open_ == "(") + close
        return whole if len(value) <= FEW and len(inner) < WIDTH else f"<{counted(len(value), 'value')}>"
    return f"{type(value).__name__}(...)" if dataclasses.is_dataclass(value) else short(repr(value))


def _array(values):
    """An array: its values if they are few, else its shape with the least and the largest one."""
    if values.size <= FEW and values.ndim == 1:
        return "[" + ", ".join(shown(one) for one in values) + "]"
    size = " x ".join(map(str, values.shape))
    found = values[np.isfinite(values)] if values.dtype.kind in "iuf" else values[:0]
    return f"<{size}: {found.min():.6g} to {found.max():.6g}>" if found.size else f"<{size} {values.dtype}>"
