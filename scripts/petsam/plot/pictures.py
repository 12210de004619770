"""The pictures by name, each a matplotlib figure of files that are open: petsam.plot.loop(results, other, load="tx").

Results of petsam: maps, profiles, loop, energy, history, fretting_log, scar, life, gradient. Of petsam-stress:
stress_maps, sections, stress_profiles, fatigue. The table of petsam-study: study, regimes. Several files are compared.

Parameters that many of them have:

step, time, cycle   saved steps: load steps from 1 (-1: the last), times (s, or "1ms"), or cycles; one or a list
turns, period       what a cycle is: reversals of another number of the history, or (T, START) in s
at                  (x, y) of a point, m
xlim, ylim          part of the axes, (low, high), SI units
width               width of the picture, mm
log                 what is logarithmic: "x", "y", of maps "colors"; a word or a list of them
"""

import functools
import inspect
from collections.abc import Sequence
from typing import Optional, Union

import numpy as np
from matplotlib.figure import Figure

from ..core import words
from ..core.errors import Error
from ..results import cycles
from ..results.file import Results
from ..results.stresses import Stresses
from ..results.studies import Study
from . import bodies, colours, crossings, fields, gradients, looks, loops, planes, series, tables, wear
from .style import STYLE, drawn, need_kind

ORIGIN = (0.0, 0.0)

# what parameters may be, see above
Names = Union[str, Sequence[str], None]
Steps = Union[int, Sequence[int], None]
Times = Union[float, str, Sequence[Union[float, str]], None]
Period = Optional[tuple[float, Optional[float]]]
Point = Optional[tuple[float, float]]
Span = Optional[tuple[float, float]]
StepRange = Optional[tuple[Optional[int], Optional[int]]]
Values = Sequence[tuple[str, object]]

LOOK = {"xlim": Span, "ylim": Span, "width": Optional[float]}  # parameters of all pictures
KEYWORD = inspect.Parameter.KEYWORD_ONLY


def listed(value):
    """A value, or several, as a list; none of None."""
    if value is None:
        return []
    return [value] if isinstance(value, str) or np.ndim(value) == 0 else list(value)


def picture(draw, program="petsam"):
    """Makes a public function of one that draws files of a program: the look of all pictures, parts of the axes, the
    width."""

    own, look = (
        inspect.signature(draw),
        [inspect.Parameter(name, KEYWORD, default=None, annotation=kind) for name, kind in LOOK.items()],
    )

    @functools.wraps(draw)
    @drawn(STYLE)
    def adapted(*files, xlim=None, ylim=None, width=None, **options):
        need_kind(draw.__name__, files, "results of petsam.open()", lambda one: hasattr(one, "program"))
        if not files:
            raise Error(f"{draw.__name__}: expected results of petsam.open(), one or several")
        for one in files:
            if one.program != program:
                raise Error(f"{one.path}: is no file of {program} but of {one.program}, which another picture draws")
        figure = draw(*files, **options)
        looks.adapt(figure, xlim, ylim, width)
        return figure

    adapted.__signature__ = own.replace(parameters=[*own.parameters.values(), *look])
    return adapted


of_stress = functools.partial(picture, program="petsam-stress")
of_study = functools.partial(picture, program="petsam-study")

# ---------------------------------------------------------------- steps and cycles


def of_cycle(one, number, turns=None, period=None):
    """Index into the fields of the end of a cycle: of a life the nearest saved one, else by its number."""
    if one.has_life:
        return one.of_cycle(number)
    cycle = cycles.find(one, turns, period).numbered(number)
    return one.of_step(int(one.solved[cycle.last]) + 1)


def _number(text):
    return words.integer(text, "the number of a load step; -1 is the last")


def _second(text):
    return words.number(text, "a time, such as 1ms", "s")


def snapshots(files, step=None, time=None, cycle=None, turns=None, period=None):
    """Pairs of a file and an index into its fields, for each step asked for; of the last step unless told."""
    for values, method, read in ((step, "of_step", _number), (time, "of_time", _second)):
        values = [read(value) if isinstance(value, str) else value for value in listed(values)]
        if values:
            return [(one, getattr(one, method)(value)) for one in files for value in values]
    if listed(cycle):
        return [(one, of_cycle(one, number, turns, period)) for one in files for number in listed(cycle)]
    return [(one, one.of_last()) for one in files]


def ranged(files, steps):
    """The files with the load steps (first, last) only; None leaves one of them, or both, open."""
    return [one.between(*steps) for one in files] if steps else list(files)


def axes_of(log):
    """The axes that are logarithmic."""
    return [name for name in listed(log) if name in ("x", "y")]


def scales_of(log):
    """The axes that are logarithmic, and "colors"."""
    return [*axes_of(log), *(name for name in listed(log) if name == "colors")]


# ---------------------------------------------------------------- results of petsam


@picture
def maps(  # noqa: PLR0913  (as the options of the picture)
    *files: Results,
    field: Names = None,
    step: Steps = None,
    time: Times = None,
    cycle: Steps = None,
    turns: Optional[str] = None,
    period: Period = None,
    whole_grid: bool = False,
    limits: Span = None,
    percentile: Optional[float] = None,
    log: Names = (),
) -> Figure:
    """Fields over the surface.

    Parameters
    ----------
    *files : Results
        Files of petsam, which are compared.
    field : str or list of str, optional
        Names of fields or vectors; None: pressure, shear, slip and state.
    step : int or list of int, optional
        Load steps, from 1, or from the end, -1 being the last. Without step, time and cycle: the last saved one.
    time : float or list of float, optional
        Times, s: the nearest saved steps.
    cycle : int or list of int, optional
        Cycles, from 1, or from the end: the saved step at their end.
    turns : str, optional
        Number of the history whose reversals separate cycles; None: the displacement that does most work.
    period : tuple, optional
        (T, START), s, of cycles by time; START may be None.
    whole_grid : bool
        Whether the whole grid is drawn, not only the contact and a margin.
    limits : tuple, optional
        Range of the colours, (low, high), SI units.
    percentile : float, optional
        The range of the colours ends at the value that this part of the cells, %, does not exceed.
    log : str or list of str
        "colors" for logarithmic colours.
    xlim, ylim : tuple, optional
        Part of the axes, (low, high), SI units.
    width : float, optional
        Width of the picture, mm.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        If a file is of another program, or has no such step, cycle or quantity.
    """
    choice = colours.Choice(limits, "colors" in listed(log), percentile)
    return fields.maps(snapshots(files, step, time, cycle, turns, period), whole_grid, listed(field) or None, choice)


@picture
def profiles(  # noqa: PLR0913
    *files: Results,
    field: Names = None,
    step: Steps = None,
    time: Times = None,
    cycle: Steps = None,
    turns: Optional[str] = None,
    period: Period = None,
    at: Point = None,
    whole_grid: bool = False,
    limits: Span = None,
    log: Names = (),
) -> Figure:
    """Fields along x and y through a point.

    Parameters
    ----------
    *files : Results
        Files of petsam, which are compared.
    field : str or list of str, optional
        Names of fields or vectors; None: pressure, shear, slip and removed depths.
    step : int or list of int, optional
        Load steps, from 1, or from the end, -1 being the last. Without step, time and cycle: the last saved one.
    time : float or list of float, optional
        Times, s: the nearest saved steps.
    cycle : int or list of int, optional
        Cycles, from 1, or from the end: the saved step at their end.
    turns : str, optional
        Number of the history whose reversals separate cycles; None: the displacement that does most work.
    period : tuple, optional
        (T, START), s, of cycles by time; START may be None.
    at : tuple, optional
        Point (x, y), m; None: the origin.
    whole_grid : bool
        Whether the whole grid is drawn, not only the contact and a margin.
    limits : tuple, optional
        Range of the values of one field, (low, high), SI units.
    log : str or list of str
        Axes that are logarithmic: "x", "y".
    xlim, ylim : tuple, optional
        Part of the axes, (low, high), SI units.
    width : float, optional
        Width of the picture, mm.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        If a file is of another program, or has no such step, cycle or quantity.
    """
    steps = snapshots(files, step, time, cycle, turns, period)
    return crossings.profiles(steps, at or ORIGIN, whole_grid, listed(field) or None, limits, axes_of(log))


@picture
def loop(
    *files: Results,
    load: Optional[str] = None,
    cycle: Steps = None,
    range: StepRange = None,
    turns: Optional[str] = None,
    period: Period = None,
) -> Figure:
    """A load over its displacement, of all steps or of some cycles.

    Parameters
    ----------
    *files : Results
        Files of petsam, which are compared.
    load : str, optional
        "tx", "ty", "mz", "n", "mx" or "my"; None: that which does most work.
    cycle : int or list of int, optional
        Cycles, from 1, or from the end.
    range : tuple, optional
        First and last load step, from 1; None leaves one of them open.
    turns : str, optional
        Number of the history whose reversals separate cycles; None: the displacement that does most work.
    period : tuple, optional
        (T, START), s, of cycles by time; START may be None.
    xlim, ylim : tuple, optional
        Part of the axes, (low, high), SI units.
    width : float, optional
        Width of the picture, mm.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        If a file is of another program, or has no such step, cycle or quantity.
    """
    if not listed(cycle):
        return loops.loop(ranged(files, range), load)
    for one in files:
        if one.has_life:
            raise Error(f"{one.path}: --loop: has wear cycles: draw their loops by --fretting-log --cycle")
    return loops.cycle_loops([cycles.find(one, turns, period) for one in files], load, listed(cycle))


@picture
def energy(*files: Results, turns: Optional[str] = None, period: Period = None, log: Names = ()) -> Figure:
    """Dissipated energy of every cycle.

    Parameters
    ----------
    *files : Results
        Files of petsam, which are compared.
    turns : str, optional
        Number of the history whose reversals separate cycles; None: the displacement that does most work.
    period : tuple, optional
        (T, START), s, of cycles by time; START may be None.
    log : str or list of str
        Axes that are logarithmic: "x", "y".
    xlim, ylim : tuple, optional
        Part of the axes, (low, high), SI units.
    width : float, optional
        Width of the picture, mm.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        If a file is of another program, or has no such step, cycle or quantity.
    """
    return loops.energy([cycles.find(one, turns, period) for one in files], axes_of(log))


@picture
def history(
    *files: Results,
    scalar: Names = None,
    against: Optional[str] = None,
    range: StepRange = None,
    log: Names = (),
    option: str = "--scalar",
) -> Figure:
    """Numbers of the history over time, or over another number.

    Parameters
    ----------
    *files : Results
        Files of petsam, which are compared.
    scalar : str or list of str, optional
        Names of the numbers; None: those that vary.
    against : str, optional
        Number over which they are drawn; None: the time, or the cycles of a life.
    range : tuple, optional
        First and last load step, from 1; None leaves one of them open.
    log : str or list of str
        Axes that are logarithmic: "x", "y".
    option : str
        What asks for the numbers, in messages.
    xlim, ylim : tuple, optional
        Part of the axes, (low, high), SI units.
    width : float, optional
        Width of the picture, mm.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        If a file is of another program, or has no such step, cycle or quantity.
    """
    return series.history(ranged(files, range), listed(scalar) or None, against, option, axes_of(log))


@picture
def fretting_log(
    *files: Results, load: Optional[str] = None, cycle: Steps = None, turns: Optional[str] = None, period: Period = None
) -> Figure:
    """Loops of up to eight cycles, with their energy.

    Parameters
    ----------
    *files : Results
        Files of petsam, which are compared.
    load : str, optional
        "tx", "ty", "mz", "n", "mx" or "my"; None: that which does most work.
    cycle : int or list of int, optional
        Cycles, from 1, or from the end.
    turns : str, optional
        Number of the history whose reversals separate cycles; None: the displacement that does most work.
    period : tuple, optional
        (T, START), s, of cycles by time; START may be None.
    xlim, ylim : tuple, optional
        Part of the axes, (low, high), SI units.
    width : float, optional
        Width of the picture, mm.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        If a file is of another program, or has no such step, cycle or quantity.
    """
    return wear.fretting_log(files, load, lambda one: cycles.find(one, turns, period), listed(cycle) or None)


@picture
def scar(  # noqa: PLR0913
    *files: Results,
    step: Steps = None,
    time: Times = None,
    cycle: Steps = None,
    turns: Optional[str] = None,
    period: Period = None,
    at: Point = None,
    whole_grid: bool = False,
    measured: Optional[tuple[str, str]] = None,
) -> Figure:
    """Removed depth along x and y through the deepest point, or through another one.

    Parameters
    ----------
    *files : Results
        Files of petsam, which are compared.
    step : int or list of int, optional
        Load steps, from 1, or from the end, -1 being the last. Without step, time and cycle: the last saved one.
    time : float or list of float, optional
        Times, s: the nearest saved steps.
    cycle : int or list of int, optional
        Cycles, from 1, or from the end: the saved step at their end.
    turns : str, optional
        Number of the history whose reversals separate cycles; None: the displacement that does most work.
    period : tuple, optional
        (T, START), s, of cycles by time; START may be None.
    at : tuple, optional
        Point (x, y), m; None: the deepest one.
    whole_grid : bool
        Whether the whole grid is drawn, not only the contact and a margin.
    measured : tuple, optional
        A body ("1", "2", or "" for the last one that wears) and the name of a CSV of heights.
    xlim, ylim : tuple, optional
        Part of the axes, (low, high), SI units.
    width : float, optional
        Width of the picture, mm.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        If a file is of another program, or has no such step, cycle or quantity.
    """
    given = any(map(listed, (step, time, cycle)))
    chosen = snapshots(files, step, time, cycle, turns, period) if given else wear.scar_steps_of(files)
    return wear.scar(chosen, at, whole_grid, measured)


@picture
def life(*files: Results) -> Figure:
    """Volume, depth, energy, area and pressure over the computed cycles.

    Parameters
    ----------
    *files : Results
        Files of petsam, which are compared.
    xlim, ylim : tuple, optional
        Part of the axes, (low, high), SI units.
    width : float, optional
        Width of the picture, mm.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        If a file is of another program, or has no life.
    """
    return wear.life(files)


@picture
def gradient(*files: Results, whole_grid: bool = False) -> Figure:
    """Where a micrometre counts: change of each number of -gradient by the gap and by friction on a patch.

    Parameters
    ----------
    *files : Results
        Files of petsam, which are compared.
    whole_grid : bool
        Whether the whole grid is drawn, not only the cells that count and a margin.
    xlim, ylim : tuple, optional
        Part of the axes, (low, high), SI units.
    width : float, optional
        Width of the picture, mm.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        If a file is of another program, or has no gradient.
    """
    return gradients.gradient(files, whole_grid)


# ---------------------------------------------------------------- stresses of petsam-stress


@of_stress
def stress_maps(
    *files: Stresses,
    component: Optional[str] = None,
    depth: Times = None,
    step: Steps = None,
    time: Times = None,
    limits: Span = None,
) -> Figure:
    """Stresses over planes.

    Parameters
    ----------
    *files : Stresses
        Files of petsam-stress, which are compared.
    component : str, optional
        "xx", "yy", ...: the stress beside von Mises.
    depth : float or list of float, optional
        Depths, m: the nearest planes.
    step : int or list of int, optional
        Load steps, from 1, or from the end, -1 being the last. Without step, time and cycle: the last saved one.
    time : float or list of float, optional
        Times, s: the nearest saved steps.
    limits : tuple, optional
        Range of the colours, (low, high), Pa.
    xlim, ylim : tuple, optional
        Part of the axes, (low, high), SI units.
    width : float, optional
        Width of the picture, mm.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        If a file is of another program, or has no such step, cycle or quantity.
    """
    return bodies.maps(snapshots(files, step, time), component, listed(depth) or None, limits)


@of_stress
def sections(
    *files: Stresses,
    component: Optional[str] = None,
    at: Point = None,
    step: Steps = None,
    time: Times = None,
    limits: Span = None,
) -> Figure:
    """Von Mises and another stress over depth.

    Parameters
    ----------
    *files : Stresses
        Files of petsam-stress, which are compared.
    component : str, optional
        "xx", "yy", ...
    at : tuple, optional
        Point (x, y), m; None: the origin.
    step : int or list of int, optional
        Load steps, from 1, or from the end, -1 being the last. Without step, time and cycle: the last saved one.
    time : float or list of float, optional
        Times, s: the nearest saved steps.
    limits : tuple, optional
        Range of the colours, (low, high), Pa.
    xlim, ylim : tuple, optional
        Part of the axes, (low, high), SI units.
    width : float, optional
        Width of the picture, mm.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        If a file is of another program, or has no such step, cycle or quantity.
    """
    return bodies.sections(snapshots(files, step, time), component, at or ORIGIN, limits)


@of_stress
def stress_profiles(
    *files: Stresses, component: Optional[str] = None, at: Point = None, step: Steps = None, time: Times = None
) -> Figure:
    """A stress on the surface along x and y.

    Parameters
    ----------
    *files : Stresses
        Files of petsam-stress, which are compared.
    component : str, optional
        "xx", "yy", ...
    at : tuple, optional
        Point (x, y), m; None: the origin.
    step : int or list of int, optional
        Load steps, from 1, or from the end, -1 being the last. Without step, time and cycle: the last saved one.
    time : float or list of float, optional
        Times, s: the nearest saved steps.
    xlim, ylim : tuple, optional
        Part of the axes, (low, high), SI units.
    width : float, optional
        Width of the picture, mm.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        If a file is of another program, or has no such step, cycle or quantity.
    """
    return bodies.profiles(snapshots(files, step, time), component, at or ORIGIN)


@of_stress
def fatigue(*files: Stresses, at: Point = None) -> Figure:
    """Fatigue parameters, with the place of the maximum.

    Parameters
    ----------
    *files : Stresses
        Files of petsam-stress, which are compared.
    at : tuple, optional
        Point (x, y), m; None: the origin.
    xlim, ylim : tuple, optional
        Part of the axes, (low, high), SI units.
    width : float, optional
        Width of the picture, mm.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        If a file is of another program, or has no fatigue parameters.
    """
    return bodies.fatigue(files, at or ORIGIN)


# ---------------------------------------------------------------- the table of petsam-study


@of_study
def study(
    *studies: Study,
    scalar: Names = None,
    against: Optional[str] = None,
    by: Optional[str] = None,
    where: Values = (),
    log: Names = (),
) -> Figure:
    """Columns over an input, a curve for each value of another column.

    Parameters
    ----------
    *studies : Study
        Tables of petsam-study, which are compared.
    scalar : str or list of str, optional
        Names of the columns; None: the results that vary.
    against : str, optional
        The input; None: the one with the most values.
    by : str, optional
        The column whose values have a curve each.
    where : list of tuple
        (name, value): only cases with these values, SI units.
    log : str or list of str
        Axes that are logarithmic: "x", "y".
    xlim, ylim : tuple, optional
        Part of the axes, (low, high), SI units.
    width : float, optional
        Width of the picture, mm.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        If a file is no table of petsam-study, or has no such column.
    """
    return tables.study(studies, listed(scalar) or None, against, by, where, axes_of(log))


@of_study
def regimes(
    one: Study,
    *,
    against: Union[str, Sequence[str]],
    scalar: Names = None,
    where: Values = (),
    border: Values = (),
    log: Names = (),
) -> Figure:
    """A map of a result, or of the regimes, over two inputs.

    Parameters
    ----------
    one : Study
        A table of petsam-study.
    against : str or sequence of str
        The two inputs, of x and of y: ("load_tx", "friction"), or "load_tx,friction".
    scalar : str or list of str, optional
        The result; None: the regimes.
    where : list of tuple
        (name, value): only cases with these values, SI units.
    border : list of tuple
        (name, value) of the lines that are drawn, SI units.
    log : str or list of str
        What is logarithmic: the axes "x", "y", the "colors" of numbers.
    xlim, ylim : tuple, optional
        Part of the axes, (low, high), SI units.
    width : float, optional
        Width of the picture, mm.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    Error
        If the file is no table of petsam-study, or has no such column, or a value that a logarithmic scale cannot show.
    """
    against = against.split(",") if isinstance(against, str) else list(against)
    return planes.planes(one, against, listed(scalar) or None, where, border, scales_of(log))
