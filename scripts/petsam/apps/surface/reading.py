"""Maps from files: what a file and the options state of it together."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np

from ...core import units as unit_table
from ...core.errors import Error, Missing, short
from ...core.files import need_regular
from ...core.hdf5 import DAMAGED
from ...core.texttable import Form
from ...core.units import shown
from . import words
from .basics import SAME
from .doubts import WIDE, of_cells, of_size, of_stand_in
from .maps import Map, new_map, turned
from .readers import FORMATS, stated_of
from .readers.hdf import EVEN, of_hdf5
from .readers.instruments import LIBRARY
from .readers.stated import How, Source, Stated

__all__ = ["FORMATS", "read", "read_hdf5"]

Read = TypeVar("Read")
SMALLEST = 1e-7  # m: few instruments measure a surface that is smaller


@dataclass(frozen=True)
class Given:
    """The options given beside a file, as words or numbers; None, 0 or False where nothing is."""

    units: str | float | None = None  # of the values: "um", "0.1mm", or m
    size: object = None  # full width of all cells in x, y: m, or a text
    pixel: object = None  # instead: of one cell
    body: int | None = None  # whose heights the values are
    separation: bool = False  # the values are the separation of both bodies
    first_row: str | None = None  # position of the first row: "bottom" or "top"
    transpose: bool = False  # the first index is x
    mirror: str | None = None  # "x" or "y" is reversed, as for body 1 seen from its own side
    depths: bool = False  # values are positive into the body
    missing: float | str | None = None  # value or word of missing points
    format: str | None = None  # one of FORMATS; by default by name and contents
    decimal: str | None = None  # "point" or "comma" of a text
    skip_rows: int = 0  # lines of a text to leave out at its start
    skip_columns: int = 0  # columns likewise
    dataset: str | None = None  # of HDF5
    channel: str | None = None  # of an instrument's file
    alone: bool = True  # whether heights of an instrument are body 2's where nothing is said

    def in_metres(self) -> Given:
        """The same with lengths in m, and a missing value as number or word; Error for words that are neither."""
        if self.separation and self.body:
            raise Error("body and separation: give one of them")
        if self.body not in (None, 1, 2):
            raise Error(f"body = {self.body!r}: use 1 or 2")
        if self.format not in (None, *FORMATS):
            raise Error(f"format = {self.format!r}: use one of {', '.join(FORMATS)}")
        lengths = {"size": words.sides(self.size), "pixel": words.sides(self.pixel)}
        return replace(self, units=words.unit(self.units), missing=words.missing(self.missing), **lengths)

    @property
    def quantity(self):
        """A key of QUANTITIES, or None."""
        return "separation" if self.separation else self.body and f"height{self.body}"


def read_hdf5(path: str | os.PathLike, dataset: str | None = None, bare: bool = False) -> Stated:
    """Reads what an HDF5 file states of a map.

    Parameters
    ----------
    path : path
        The file.
    dataset : str, optional
        The dataset; where there is one map only, that one.
    bare : bool
        Axes without units are in m, as petsam takes lengths.

    Returns
    -------
    Stated
        Values, unit, quantity and size as they stand there.
    """
    return _guarded(path, lambda: of_hdf5(path, dataset, bare))


def read_values(path: str | os.PathLike, dataset: str) -> np.ndarray:
    """Reads a map of values that are no lengths.

    Parameters
    ----------
    path : path
        The file, of any format.
    dataset : str
        The dataset of an HDF5 file.

    Returns
    -------
    ndarray
        (rows, columns), the first row at the smallest y.
    """
    source = _guarded(path, lambda: Source(path, How(dataset=dataset, lengths=False)))
    stated, _ = _guarded(path, lambda: stated_of(source))
    values = np.array(stated.values, dtype=np.float64)
    return values[::-1] if stated.top else values


def _agreed(path, stated, given, option):
    """The value in the file or of the option; None without either, an Error if they contradict each other."""
    if stated is None or given is None:
        return given if stated is None else stated
    if not (stated == given if isinstance(stated, (str, bool)) else np.allclose(stated, given, rtol=SAME, atol=0.0)):
        raise Error(f"{path}: states {_told(stated)}, which contradicts {option}, {_told(given)}: leave the option out")
    return stated


def _told(value):
    """A statement in words: a quantity, a unit or a size."""
    if isinstance(value, str):
        return value
    return " x ".join(f"{side:.6g} m" for side in np.atleast_1d(value))


def _at(path, stated, name):
    """The path, with the line of a text in which a statement is."""
    return f"{path}: line {stated.lines[name]}" if name in stated.lines else path


def _need_sides(path, stated, given):
    """Error where a side of the given size contradicts that of the file."""
    for letter, side, one in zip("xy", stated.sides, given or (None, None)):
        if side and one and not np.isclose(side, one, rtol=SAME, atol=0.0):
            raise Error(
                f"{_at(path, stated, letter)}: is {shown(side)} along {letter}, which contradicts --size or --pixel, "
                f"{shown(one)}: leave the option out, or correct it"
            )


def _asked(spans, unit):
    """The option that gives a unit to lengths which a file states without one: that of the heights, um or m, whichever
    first makes a size that instruments measure."""
    table = unit_table.of("m")
    own = [name for name, size in table.items() if unit is not None and np.isclose(size, unit, rtol=1e-9, atol=0.0)]
    names = [name for name in (*own, "um", "m") if SMALLEST < max(spans) * table[name] < WIDE] or ["um"]
    return "--size " + ",".join(f"{span:.6g}{names[0]}" for span in spans)


def _need_spans(path, spans, given, unit):
    """Error where a given size is no multiple, by a unit, of the size that points x, y span in a unit they lack."""
    if not spans or not given:
        return
    ratios = [side / span for side, span in zip(given, spans)]
    if not any(np.allclose(ratios, one, rtol=EVEN, atol=0.0) for one in unit_table.of("m").values()):
        names = "points x, y, z" if len(spans) == 2 else "x"
        raise Error(
            f"{path}: its {names} span {' x '.join(f'{span:.6g}' for span in spans)}, which contradicts --size or "
            f"--pixel, {' x '.join(map(shown, given))}: give these numbers with their unit, as in {_asked(spans, unit)}"
        )


def _need(path, family, quantity, unit, size, spans):
    """An Error that names all that is given neither in the file nor by an option."""
    how_large = "how large the surface is (--size X[,Y] or --pixel DX[,DY])"
    if spans:
        how_large = (
            f"in which unit its x and y are (they span {' x '.join(f'{s:.6g}' for s in spans)}: {_asked(spans, unit)})"
        )
    lacking = [
        text
        for value, text in (
            (quantity, "whether it holds heights (--body 1 or --body 2) or a separation (--separation)"),
            (unit, "in which unit (--units um or another)"),
            (size, how_large),
        )
        if value is None
    ]
    if lacking:
        hint = "" if family != "table" else f"; a header may, for {LIBRARY}: --format surfacetopography"
        raise Error(f"{path}: does not say {'; nor '.join(lacking)}: give the options{hint}")


def _guarded(path: str | os.PathLike, read_it: Callable[[], Read]) -> Read:
    """Returns the value of read_it() for a file; errors of damaged files are raised as an Error."""
    try:
        if need_regular(path).st_size == 0:
            raise Error(f"{path}: is empty")
        return read_it()
    except Missing:
        raise
    except MemoryError as error:
        raise Error(f"{path}: is too large for the memory") from error
    except DAMAGED as error:
        raise Error(f"{path}: cannot be read: {getattr(error, 'strerror', None) or short(error)}") from error


def _need_free(path, stated, given):
    """Error where an option turns or changes the sign of what the file states."""
    for option, wanted, said in (
        ("transpose", given.transpose, stated.size or stated.spans or max(stated.sides, key=bool)),
        ("depths", given.depths, stated.quantity),
    ):
        if wanted and said is not None:
            what = "which direction is x" if option == "transpose" else "what its values are"
            raise Error(f"{path}: already states {what}: leave out --{option}")


def _top(path, stated, first_row):
    """Returns True if the first row has the largest y, and remarks to print."""
    if stated.top is None:
        turned_round = "" if first_row else "; --first-row top turns it round"
        place = "largest" if first_row == "top" else "smallest"
        return first_row == "top", [f"first row at the {place} y{turned_round}"]
    if first_row and (first_row == "top") != stated.top:
        is_at = "top" if stated.top else "bottom"
        raise Error(f"{path}: already states the direction of y, first row {is_at}: leave out --first-row")
    return stated.top, []


def _profile(path, stated, given):
    """The size along x of a profile as given, or None; Error for options about y."""
    for option, value in (("--first-row", given.first_row), ("--mirror y", given.mirror == "y")):
        if value:
            raise Error(f"{path}: is a profile, which has no y: leave out {option}")
    for option, value in (("--size", given.size), ("--pixel", given.pixel)):
        if value and value[0] != value[1]:
            raise Error(
                f"{path}: has 1 x {stated.values.size} points, a profile, which has a length along x only: give "
                f"{option} one length"
            )
    return given.size[:1] if given.size else given.pixel and (given.pixel[0] * stated.values.size,)


def _wanted(path, stated, values, given):
    """The size of the map as given, along x alone of a profile; None without one."""
    if len(values) == 1:
        return _profile(path, stated, given)
    return given.size or given.pixel and tuple(w * n for w, n in zip(given.pixel, values.shape[::-1]))


def _overruled(stated, values, unit, wanted):
    """The statements without a size that a warning would doubt, where another one is given."""
    sides = [side for side in (stated.size or stated.sides)[: len(wanted or ())] if side]
    if not sides or np.allclose(sides, wanted[: len(sides)], rtol=SAME, atol=0.0):
        return stated
    heights = values[np.isfinite(values)] * (unit or 0.0)
    if not of_size(float(np.ptp(heights)) if heights.size else 0.0, max(sides)):
        return stated
    said = f"size of the file, {' x '.join(map(shown, sides))}, overruled by --size or --pixel"
    return stated._replace(size=None, sides=(None, None), center=None, remarks=(*stated.remarks, said))


def _sized(path, stated, values, wanted, unit):
    """Size of the map, or None where neither the file nor an option states it."""
    flat = len(values) == 1
    _need_sides(path, stated, wanted)
    _need_spans(path, stated.spans, wanted, unit)
    said = stated.size
    if said is None and stated.spans and all(stated.sides[: len(stated.spans)]):
        said = stated.sides[: len(stated.spans)]  # of a header
        _need_spans(path, stated.spans, said, unit)
    if flat and said is None and stated.sides[0]:
        said = stated.sides[:1]
    size = _agreed(path, said[:1] if flat and said else said, wanted, "--size or --pixel")
    return (size[0], 1.0) if flat and size else size  # plane strain is per metre along y


def _rowed(path, stated):
    """The statements of a file of one column as those of one row, a profile."""
    if stated.values.size < 2:
        raise Error(f"{path}: has 1 x 1 points (rows x columns): a map has at least 2 x 2")
    flat = stated.values.shape[1] == 1 and stated.size is None and not any(stated.sides)
    return stated._replace(values=stated.values.T) if flat else stated


def _combined(path, stated, family, given):
    """The map of the statements and of what is given."""
    _need_free(path, stated, given)
    stated = _rowed(path, stated)
    values = np.asarray(stated.values, dtype=np.float64)  # before it is scaled: single precision would stay so
    values = values.T if given.transpose and len(values) > 1 else values
    quantity = _agreed(path, stated.quantity, given.quantity, "--body or --separation")
    alone = quantity is None and given.alone and family == "surfacetopography"
    quantity = "height2" if alone else quantity  # instruments measure heights; which body's the remark says
    unit = _agreed(_at(path, stated, "unit"), stated.unit, given.units, "--units")
    missing = _missing(path, stated, given)
    if missing is not None:
        values = np.where(values == missing, np.nan, values)
    wanted = _wanted(path, stated, values, given)
    stated = _overruled(stated, values, unit, wanted)
    size = _sized(path, stated, values, wanted, unit)
    _need(path, family, quantity, unit, size, stated.spans)
    one = new_map(values * (-unit if given.depths else unit), size, quantity, path, stated.center or (0.0, 0.0))
    top, remarks = (False, []) if one.is_profile else _top(path, stated, given.first_row)
    if one.is_profile:
        remarks = [f"profile (1, {one.n[0]}), for plane strain"]
    if alone:
        remarks.append("taken for heights of body 2; --body 1 or --separation takes them for another")
    if quantity == "height1" and stated.quantity is None and not given.mirror:
        remarks.append(
            "x and y are petsam's, as seen from above; seen from its own side, body 1 is mirrored: --mirror x or y"
        )
    more = [*of_stand_in(values), *(of_cells(one) if given.size and stated.size is None else [])]
    doubts = (*stated.doubts, *more)
    return replace(turned(one, top, given.mirror or ""), remarks=(*stated.remarks, *remarks), doubts=doubts)


def _missing(path, stated, given):
    """The number of missing points that the file states, or that is given; Error where they differ."""
    number = None if isinstance(given.missing, str) else given.missing
    if None not in (stated.missing, number) and stated.missing != number:
        raise Error(
            f"{path}: states that missing points are {stated.missing:g}, which contradicts --missing {number:g}: "
            "leave the option out"
        )
    return number if stated.missing is None else stated.missing


def _stated(path: str, given: Given) -> tuple[Stated, str]:
    """The statements of a file, and the family of its format."""
    word = given.missing if isinstance(given.missing, str) else None
    form = Form(given.decimal, given.skip_rows, given.skip_columns, (word.lower(),) if word else ())
    source = Source(path, How(form, words.unit(given.units), given.dataset, given.channel, given.format == "table"))
    stated, family = stated_of(source, given.format)
    if word and family != "table":
        raise Error(f"{path}: --missing {short(word)}: is a word, which only texts have: give a number")
    return stated, family


def read(
    path: str | os.PathLike,
    units: str | float | None = None,
    size: str | float | tuple | None = None,
    pixel: str | float | tuple | None = None,
    body: int | None = None,
    **more: Any,
) -> Map:
    """Reads a map of heights, or a profile, from a file of any kind.

    All but the path is needed only where the file does not state it, and must agree with the file where it does.

    Parameters
    ----------
    path : str or path
        NumPy's .npy, text, HDF5, or a file of an instrument.
    units : str or float
        Unit of the values, as "um" or "0.1mm", or its size in m.
    size, pixel : float, str or pair
        Full width of all cells in x, y, or of one cell: m, or a text such as "1mm".
    body : 1 or 2
        The values are heights of this body, peaks positive.
    **more
        The other fields of Given, as options of petsam-surface: separation, first_row, transpose, mirror, depths,
        missing, format, decimal, skip_rows, skip_columns, dataset, channel.

    Returns
    -------
    Map
        Its values (ny, nx) in m, first row at the smallest y; a profile has the shape (1, nx).

    Raises
    ------
    petsam.Error
        For a file that cannot be read, lacks something, or contradicts what is given; with the cure.

    Examples
    --------
    >>> import numpy as np, petsam
    >>> np.save("rough.npy", np.random.default_rng(1).normal(size=(64, 64)))
    >>> found = petsam.surface.read("rough.npy", units="um", size="1mm", body=2)
    >>> found.level("tilt").n
    (64, 64)
    """
    path = os.fspath(path)
    given = Given(units, size, pixel, body, **more).in_metres()
    stated, family = _guarded(path, lambda: _stated(path, given))
    return _combined(path, stated, family, given)
