"""Scalars of /history over time, or over one another, of results.Results."""

import numpy as np

from ..core.errors import Error, Unusable, short, there_are
from ..results.cycles import ENERGY, PAIRS
from . import noise, symbols
from .style import BARS, MARKED, colors, logarithmic, named, need_few, outlined, plt, scattered
from .units import label, plain, scale

VOLUMES = ("wear_volume1", "wear_volume2")
TIME = "time"
CREEPS = ("creep_x", "creep_y", "creep_spin")
CURVES = ("load_tx", "load_ty", "load_mz", *CREEPS, "stick_area")  # of steady rolling
CONSTANT = ("load_n", "contact_area")  # shown if nothing varies
# rows and columns of the matrices of /history
LOADS, WAYS = zip(*(PAIRS[name] for name in ("n", "tx", "ty", "mx", "my", "mz")))


def entry(results, name):
    """Returns the matrix and the two names in a name such as stiffness.load_tx.disp_x; None for another name."""
    matrix, *pair = name.split(".")
    known = len(pair) == 2 and pair[0] in LOADS and pair[1] in WAYS and matrix in results.matrices
    return (matrix, *pair) if known else None


def unit_of(results, name):
    """Unit of a scalar, or of an entry of a matrix."""
    if not entry(results, name):
        return results.units[name]
    _, load, way = entry(results, name)
    return f"{results.units[load]}/{results.units[way]}"


def series(results, name):
    """Times and values of /history/name of the steps that have a solution; of the dissipated energy the sum.

    The status is that of all steps: it tells which of them have none.
    """
    if entry(results, name):
        matrix, load, way = entry(results, name)
        values = results.matrices[matrix][results.solved]
        return results.series(TIME), values[:, LOADS.index(load), WAYS.index(way)]
    if name == "status":
        status, time = results.history[name], results.history[TIME]
        rows = np.arange(min(status.size, time.size))
        rows = rows[results.counts(rows)]
        return time[rows], status[rows].astype(float)
    values = results.series(name).astype(float)
    return results.series(TIME), np.cumsum(values) if name == ENERGY else values


def errors(results, name):
    """Estimated errors of the values of series(), None without; of the dissipated energy the sum of those of the steps,
    which is more than the error of the sum."""
    if f"{name}_error" not in results.history or name == "status":
        return None
    values = results.series(f"{name}_error").astype(float)
    return np.cumsum(values) if name == ENERGY else values


def against(results, name, other):
    """Values of a scalar and of the other one that it is drawn over, of the same steps."""
    time, values = series(results, name)
    if other == TIME:
        return time, values
    beside = series(results, other)[1]
    if name == "status" or other == "status":
        rows = [
            results.first_row + np.arange(one.size) if who == "status" else results.solved
            for who, one in ((name, values), (other, beside))
        ]
        shared, mine, theirs = np.intersect1d(*rows, return_indices=True)
        values, beside = values[mine], beside[theirs]
    return beside, values


def usual(results):
    """Returns the default abscissa of a history: time, or in steady rolling the creepage that varies most."""
    if not all(one.is_steady for one in results):
        return TIME
    known = noise.scales(results)
    spans = {name: max(float(np.ptp(one.series(name))) for one in results) for name in CREEPS}
    spans = {name: span / known[results[0].units[name]] for name, span in spans.items() if span > 0.0}
    return max(spans, key=spans.get, default=TIME)


def _varying(results):
    """Returns the default names of a picture of the history: those that vary (see noise), each once."""
    known = noise.scales(results)
    shared = [name for name in VOLUMES if all(name in one.history for one in results)]
    # of a life the sum of the energy over the computed cycles says nothing
    energy = [] if any(one.has_life for one in results) else [ENERGY]
    names = [*(name for pair in PAIRS.values() for name in pair), "contact_area", "stick_area", *shared, *energy]
    names = CURVES if all(one.is_steady for one in results) else names
    names = [name for name in names if noise.varies(results, name, known)]
    all_stick = all(np.allclose(one.series("stick_area"), one.series("contact_area"), rtol=1e-9) for one in results)
    names = [name for name in names if name != "stick_area" or not all_stick]
    return names if set(names) - {ENERGY} else [*CONSTANT, *names]  # the sum of one step is no history


def need_scalars(results, names, option):
    """Raises Error if the history lacks one of the names that the option requests."""
    for name in names:
        if name in results.matrices:
            text = f"{option} {name}: is a matrix for every step; {name}.load_tx.disp_x is one of its entries"
            raise Error(f"{results.path}: {text}")
        if name not in results.history and not entry(results, name):
            entries = [f"{matrix}.LOAD.DISPLACEMENT" for matrix in results.matrices]
            there = there_are(name, [*sorted(results.history), *entries], "it has")
            raise Error(f"{results.path}: {option} {short(name)}: has no such dataset{there}")


def _why_not(results, name):
    """Returns why a scalar has no number in any step."""
    if name == "slip_max" and results.parameters.get("friction") == 0.0:
        return "without friction nothing opposes slip, and its maximum is not computed"
    return "this run does not compute it"


def need_numbers(results, names, option):
    """Raises Unusable if one of the names that the option requests is NaN in all steps of all results."""
    for name in names:
        if all(np.isnan(series(one, name)[1]).all() for one in results):
            others = [other for other in _varying(results) if other not in names]
            text = f"{option} {name}: is NaN in all steps: {_why_not(results[0], name)}; choose {', '.join(others)}"
            raise Unusable(f"{results[0].path}: {text}")


def _panel(panel, results, name, other, across):
    """Draws one scalar of all files; across is the factor of the other one."""
    lines = [against(one, name, other) for one in results]
    factor, unit = scale(unit_of(results[0], name), *(values for _, values in lines), powers=True)
    for one, (x, y), tint in zip(results, lines, colors(len(results))):
        error = errors(one, name)
        if error is not None and other != "status":
            panel.errorbar(across * x, factor * y, factor * np.nan_to_num(error), ecolor=tint, **BARS)
        x, y = outlined(across * x, factor * y)
        panel.plot(x, y, color=tint, label=plain(one.label), **scattered(x))
    panel.set(ylabel=label(symbols.scalar(name), unit))


def history(results, names=None, other=None, option="--names", logs=()):
    """Scalars of /history over time, or over another scalar (see usual()): one panel each, one line per file.

    Of steps without a solution the status alone. logs are the axes, x or y, that are logarithmic.
    """
    for one in results:
        one.need_solution()
        need_scalars(one, names or (), option)
        need_scalars(one, [other] if other else (), "--against")
    need_numbers(results, names or (), option)
    need_numbers(results, [other] if other else (), "--against")
    other = other or usual(results)
    names = names or [name for name in _varying(results) if name != other]
    need_few(len(names), "datasets")
    columns = min(3, len(names))
    rows = -(-len(names) // columns)
    size = (4.2 * columns, 2.6 * rows + 0.3) if len(names) > 1 else (6.4, 4.4)
    figure, axes = plt.subplots(rows, columns, figsize=size, squeeze=False, sharex=True, constrained_layout=True)
    across, unit = scale(unit_of(results[0], other), *(series(one, other)[1] for one in results), powers=True)
    for panel, name in zip(axes.flat, names):
        _panel(panel, results, name, other, across)
        logarithmic(panel, logs)
    for panel in axes.flat[len(names) :]:
        panel.set_axis_off()
    for panel in axes.flat[max(0, len(names) - columns) : len(names)]:
        panel.set_xlabel(label("time" if other == TIME else symbols.scalar(other), unit))
        panel.tick_params(labelbottom=True)
    if named(results):
        axes.flat[0].legend(loc="best", markerscale=1.0 if len(axes.flat[0].lines[0].get_xdata()) <= MARKED else 3.0)
    return figure
