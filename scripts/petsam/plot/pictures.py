"""The pictures by name, each a matplotlib figure of files that are open: petsam.plot.loop(results, other, load="tx").

Results of petsam: maps, profiles, loop, energy, history, fretting_log, scar, life. Of petsam-stress: stress_maps,
sections, stress_profiles, fatigue. The table of petsam-study: study, regimes. Several files are compared.

Parameters that many of them have:

step, time, cycle   saved steps: load steps from 1 (-1: the last), times (s), or cycles; a value or a list of them
turns, period       what a cycle is: reversals of another number of the history, or (T, START) in s
at                  (x, y) of a point, m
xlim, ylim          part of the axes, (low, high), SI units
width               width of the picture, mm
log                 what is logarithmic: "x", "y", of maps "colors"; a word or a list of them
"""

import functools
import inspect

import numpy as np

from ..core.errors import Error
from ..results import cycles
from . import bodies, colours, crossings, fields, looks, loops, planes, series, tables, wear
from .style import STYLE, drawn

ORIGIN = (0.0, 0.0)
LOOK = ("xlim", "ylim", "width")  # parameters of all pictures
KEYWORD = inspect.Parameter.KEYWORD_ONLY


def listed(value):
    """A value, or several, as a list; none of None."""
    if value is None:
        return []
    return [value] if isinstance(value, str) or np.ndim(value) == 0 else list(value)


def picture(draw, program="petsam"):
    """Makes a public function of one that draws files of a program: the look of all pictures, parts of the axes, the
    width."""

    own, look = inspect.signature(draw), [inspect.Parameter(name, KEYWORD, default=None) for name in LOOK]

    @functools.wraps(draw)
    @drawn(STYLE)
    def adapted(*files, xlim=None, ylim=None, width=None, **options):
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


def found(one, turns=None, period=None):
    """The Cycles of a file, by turning points or a period."""
    return cycles.find(one, turns, period)


def of_cycle(one, number, turns=None, period=None):
    """Index into the fields of the end of a cycle: of a life the nearest saved one, else by its number."""
    if one.has_life:
        return one.of_cycle(number)
    cycle = found(one, turns, period).numbered(number)
    return one.of_step(int(one.solved[cycle.last]) + 1)


def snapshots(files, step=None, time=None, cycle=None, turns=None, period=None):
    """Pairs of a file and an index into its fields, for each step asked for; of the last step unless told."""
    asked = [(step, "of_step"), (time, "of_time")]
    for values, method in asked:
        if listed(values):
            return [(one, getattr(one, method)(value)) for one in files for value in listed(values)]
    if listed(cycle):
        return [(one, of_cycle(one, number, turns, period)) for one in files for number in listed(cycle)]
    return [(one, one.of_last()) for one in files]


def ranged(files, steps):
    """The files with the load steps (first, last) only; None leaves one of them, or both, open."""
    return [one.between(*steps) for one in files] if steps else list(files)


def axes_of(log):
    """The axes that are logarithmic."""
    return [name for name in listed(log) if name in ("x", "y")]


# ---------------------------------------------------------------- results of petsam


@picture
def maps(  # noqa: PLR0913  (as the options of the picture)
    *files, field=None, step=None, time=None, cycle=None, turns=None, period=None, whole_grid=False, limits=None,
    percentile=None, log=(),
):  # fmt: skip
    """Fields over the surface: of the names in field, or pressure, shear, slip and state.

    limits is the range of colours, (low, high), SI units; percentile ends them at this part of the cells.
    """
    choice = colours.Choice(limits, "colors" in listed(log), percentile)
    return fields.maps(snapshots(files, step, time, cycle, turns, period), whole_grid, listed(field) or None, choice)


@picture
def profiles(  # noqa: PLR0913
    *files, field=None, step=None, time=None, cycle=None, turns=None, period=None, at=None, whole_grid=False,
    limits=None, log=(),
):  # fmt: skip
    """Fields along x and y through the point `at` (the origin)."""
    steps = snapshots(files, step, time, cycle, turns, period)
    return crossings.profiles(steps, at or ORIGIN, whole_grid, listed(field) or None, limits, axes_of(log))


@picture
def loop(*files, load=None, cycle=None, range=None, turns=None, period=None):
    """A load ("tx", "ty", "mz", "n", "mx", "my") over its displacement, of all steps or of some cycles.

    range is (first, last) of the load steps, from 1.
    """
    if not listed(cycle):
        return loops.loop(ranged(files, range), load)
    for one in files:
        if one.has_life:
            raise Error(f"{one.path}: --loop: has wear cycles: draw their loops by --fretting-log --cycle")
    return loops.cycle_loops([found(one, turns, period) for one in files], load, listed(cycle))


@picture
def energy(*files, turns=None, period=None, log=()):
    """Dissipated energy of every cycle."""
    return loops.energy([found(one, turns, period) for one in files], axes_of(log))


@picture
def history(*files, scalar=None, against=None, range=None, log=(), option="--scalar"):
    """Numbers of the history over time, or over the number `against`; option is what asks for them, in messages."""
    return series.history(ranged(files, range), listed(scalar) or None, against, option, axes_of(log))


@picture
def fretting_log(*files, load=None, cycle=None, turns=None, period=None):
    """Loops of up to eight cycles, with their energy."""
    return wear.fretting_log(files, load, lambda one: found(one, turns, period), listed(cycle) or None)


@picture
def scar(  # noqa: PLR0913
    *files, step=None, time=None, cycle=None, turns=None, period=None, at=None, whole_grid=False, measured=None
):
    """Removed depth along x and y through the deepest point, or through `at`.

    measured is a pair of a body ("1", "2", or "" for the last one that wears) and the name of a CSV of heights.
    """
    given = any(map(listed, (step, time, cycle)))
    chosen = snapshots(files, step, time, cycle, turns, period) if given else wear.scar_steps_of(files)
    return wear.scar(chosen, at, whole_grid, measured)


@picture
def life(*files):
    """Volume, depth, energy, area and pressure over the computed cycles."""
    return wear.life(files)


# ---------------------------------------------------------------- stresses of petsam-stress


@of_stress
def stress_maps(*files, component=None, depth=None, step=None, time=None, limits=None):
    """Stresses over planes at the depths nearest to `depth` (m)."""
    return bodies.maps(snapshots(files, step, time), component, listed(depth) or None, limits)


@of_stress
def sections(*files, component=None, at=None, step=None, time=None, limits=None):
    """Von Mises and another stress over depth: component xx, yy, ..."""
    return bodies.sections(snapshots(files, step, time), component, at or ORIGIN, limits)


@of_stress
def stress_profiles(*files, component=None, at=None, step=None, time=None):
    """A stress on the surface along x and y."""
    return bodies.profiles(snapshots(files, step, time), component, at or ORIGIN)


@of_stress
def fatigue(*files, at=None):
    """Fatigue parameters, with the place of the maximum."""
    return bodies.fatigue(files, at or ORIGIN)


# ---------------------------------------------------------------- the table of petsam-study


@of_study
def study(*studies, scalar=None, against=None, by=None, where=(), log=()):
    """Columns over the input `against`, a curve for each value of the column `by`; where is a list of (name, value)."""
    return tables.study(studies, listed(scalar) or None, against, by, where, axes_of(log))


@of_study
def regimes(one, *, against, scalar=None, where=(), border=(), log=()):
    """A map of a result, or of the regimes, over two inputs; border is a list of (name, value) for lines."""
    return planes.planes(one, list(against), listed(scalar) or None, where, border, axes_of(log))
