"""The pictures by name, each a matplotlib figure of files that are open: petsam.plot.loop(results, other, load="tx").

Results of petsam: maps, profiles, loop, energy, history, fretting_log, scar, life, gradient. Of petsam-stress:
stress_maps, sections, stress_profiles, fatigue. The table of petsam-study: study, regimes. Several files are compared.

Keywords that many of them have are explained in keywords.py: help() shows them with each picture.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Sequence
from typing import Optional, Union

from matplotlib.figure import Figure

from ..core.errors import Error
from ..core.keywords import unfolded
from ..results.file import Results
from ..results.stresses import Stresses
from ..results.studies import Study
from . import bodies, colours, crossings, fields, gradients, looks, loops, planes, series, tables, wear
from .keywords import COMMON, Cycles, Frames, Look, Names, Point, Saved, Span, StepRange, Times, Turns, Values, listed
from .style import drawn, need_kind

ORIGIN = (0.0, 0.0)


def picture(draw, program="petsam"):
    """Makes a public function of one that draws files of a program: with the look of all pictures, and the keywords
    that many have."""

    @functools.wraps(draw)
    @drawn()
    def adapted(*files, look, **options):
        need_kind(draw.__name__, files, "results of petsam.open()", lambda one: hasattr(one, "program"))
        if not files:
            raise Error(f"{draw.__name__}: expected results of petsam.open(), one or several")
        for one in files:
            if one.program != program:
                raise Error(f"{one.path}: is no file of {program} but of {one.program}, which another picture draws")
        figure = draw(*files, **options)
        looks.adapt(figure, look.xlim, look.ylim, look.width)
        return figure

    own = inspect.signature(draw)
    look = inspect.Parameter("look", inspect.Parameter.KEYWORD_ONLY, annotation=Look)
    adapted.__signature__ = own.replace(parameters=[*own.parameters.values(), look])
    return unfolded(adapted, COMMON)


of_stress = functools.partial(picture, program="petsam-stress")
of_study = functools.partial(picture, program="petsam-study")


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
def maps(
    *files: Results,
    field: Names = None,
    frames: Frames,
    whole_grid: bool = False,
    limits: Span = None,
    percentile: Optional[float] = None,
    log: Names = (),
) -> Figure:
    """Fields over the surface.

    Parameters
    ----------
    field : str or list of str, optional
        Names of fields or vectors; None: pressure, shear, slip and state.
    percentile : float, optional
        The range of the colours ends at the value that this part of the cells, %, does not exceed.
    log : str or list of str
        "colors" for logarithmic colours.

    Examples
    --------
    >>> import petsam
    >>> ball = dict(gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", body1="steel", body2="steel")
    >>> run = petsam.run(ball, grid_n=32, grid_size=2.4e-3, friction=0.2, load_n=500, load_tx=60)
    >>> figure = petsam.plot.maps(run, field=["pressure", "state"])
    >>> figure.savefig("ball.png")
    """
    choice = colours.Choice(limits, "colors" in listed(log), percentile)
    return fields.maps(frames.snapshots(files), whole_grid, listed(field) or None, choice)


@picture
def profiles(
    *files: Results,
    field: Names = None,
    frames: Frames,
    at: Point = None,
    whole_grid: bool = False,
    limits: Span = None,
    log: Names = (),
) -> Figure:
    """Fields along x and y through a point.

    Parameters
    ----------
    field : str or list of str, optional
        Names of fields or vectors; None: pressure, shear, slip and removed depths.
    limits : tuple, optional
        Range of the values of one field, (low, high), SI units.
    """
    steps = frames.snapshots(files)
    return crossings.profiles(steps, at or ORIGIN, whole_grid, listed(field) or None, limits, axes_of(log))


@picture
def loop(*files: Results, load: Optional[str] = None, range: StepRange = None, cycles: Cycles) -> Figure:
    """A load over its displacement, of all steps or of some cycles.

    Examples
    --------
    >>> import petsam
    >>> ball = dict(gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", body1="steel", body2="steel")
    >>> turns = dict(time=[0, 1, 2, 3], load_n=[500] * 4, load_tx=[0, 60, -60, 60])
    >>> run = petsam.run(ball, grid_n=32, grid_size=2.4e-3, friction=0.2, history=turns)
    >>> petsam.plot.loop(run).savefig("loop.png")
    """
    if not listed(cycles.cycle):
        return loops.loop(ranged(files, range), load)
    for one in files:
        if one.has_life:
            raise Error(f"{one.path}: --loop: has wear cycles: draw their loops by --fretting-log --cycle")
    return loops.cycle_loops([cycles.cycles(one) for one in files], load, listed(cycles.cycle))


@picture
def energy(*files: Results, turns: Turns, log: Names = ()) -> Figure:
    """Dissipated energy of every cycle."""
    return loops.energy([turns.cycles(one) for one in files], axes_of(log))


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
    scalar : str or list of str, optional
        Names of the numbers; None: those that vary.
    against : str, optional
        Number over which they are drawn; None: the time, or the cycles of a life.
    option : str
        What asks for the numbers, in messages.
    """
    return series.history(ranged(files, range), listed(scalar) or None, against, option, axes_of(log))


@picture
def fretting_log(*files: Results, load: Optional[str] = None, cycles: Cycles) -> Figure:
    """Loops of up to eight cycles, with their energy."""
    return wear.fretting_log(files, load, cycles.cycles, listed(cycles.cycle) or None)


@picture
def scar(
    *files: Results,
    frames: Frames,
    at: Point = None,
    whole_grid: bool = False,
    measured: Optional[tuple[str, str]] = None,
) -> Figure:
    """Removed depth along x and y through the deepest point, or through another one.

    Parameters
    ----------
    at : tuple, optional
        Point (x, y), m; None: the deepest one.
    measured : tuple, optional
        A body ("1", "2", or "" for the last one that wears) and the name of a CSV of heights.
    """
    chosen = frames.snapshots(files) if frames.is_given() else wear.scar_steps_of(files)
    return wear.scar(chosen, at, whole_grid, measured)


@picture
def life(*files: Results) -> Figure:
    """Volume, depth, energy, area and pressure over the computed cycles."""
    return wear.life(files)


@picture
def gradient(*files: Results, whole_grid: bool = False) -> Figure:
    """Where a micrometre counts: change of each number of -gradient by the gap and by friction on a patch.

    Parameters
    ----------
    whole_grid : bool
        Whether the whole grid is drawn, not only the cells that count and a margin.
    """
    return gradients.gradient(files, whole_grid)


# ---------------------------------------------------------------- stresses of petsam-stress


@of_stress
def stress_maps(
    *files: Stresses, component: Optional[str] = None, depth: Times = None, saved: Saved, limits: Span = None
) -> Figure:
    """Stresses over planes.

    Parameters
    ----------
    depth : float or list of float, optional
        Depths, m: the nearest planes.
    """
    return bodies.maps(saved.snapshots(files), component, listed(depth) or None, limits)


@of_stress
def sections(
    *files: Stresses, component: Optional[str] = None, at: Point = None, saved: Saved, limits: Span = None
) -> Figure:
    """Von Mises and another stress over depth."""
    return bodies.sections(saved.snapshots(files), component, at or ORIGIN, limits)


@of_stress
def stress_profiles(*files: Stresses, component: Optional[str] = None, at: Point = None, saved: Saved) -> Figure:
    """A stress on the surface along x and y."""
    return bodies.profiles(saved.snapshots(files), component, at or ORIGIN)


@of_stress
def fatigue(*files: Stresses, at: Point = None) -> Figure:
    """Fatigue parameters, with the place of the maximum."""
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
    border : list of tuple
        (name, value) of the lines that are drawn, SI units.
    log : str or list of str
        What is logarithmic: the axes "x", "y", the "colors" of numbers.

    Raises
    ------
    Error
        If the file is no table of petsam-study, or has no such column, or a value that a logarithmic scale cannot show.
    """
    against = against.split(",") if isinstance(against, str) else list(against)
    return planes.planes(one, against, listed(scalar) or None, where, border, scales_of(log))
