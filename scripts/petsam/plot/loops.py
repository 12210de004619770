"""Loops of a load over its displacement, and the energy of every cycle, of results.Results.

Cycles are those of petsam.cycles, given as one Cycles per file. The energy beside a loop is that of this load on this
displacement in one cycle; the dissipated energy of a cycle is that of all loads, by friction and by bodies that relax.
"""

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.ticker import MaxNLocator

from ..core.errors import Error
from ..results import sliding
from ..results.cycles import ENERGY, PAIRS, VISCOUS, busiest, by_turns
from ..results.sliding import area, cycle_energy, loop_energy
from . import noise, symbols
from .style import colors, curve, logarithmic, named, need_few, plt, tint
from .units import counted, label, largest, plain, scale

LOOPS = 8  # in a panel; more would be indistinguishable
DENSE = 1000  # points above which a loop is drawn in transparent pieces, darker where it passes often
PIECE = 20  # points of a piece
SEEN = 0.01  # difference of a loop's energy and its drawn area, relative, that a legend mentions
HEADROOM = 1.08  # the top of an axis of energies over the largest one


def loop_axes(results, pair=None):
    """The load and the displacement of a loop, and of each the factor and the unit that suit all files."""
    known = noise.scales(results)
    if pair and pair not in PAIRS:
        raise Error(f"--load {pair}: there are {', '.join(PAIRS)}")
    if pair and not all(noise.varies(results, name, known) for name in PAIRS[pair]):
        raise Error(f"{results[0].path}: --load {pair}: {' or '.join(PAIRS[pair])} does not vary")
    pair = pair or busiest(results[0])
    if pair is None:
        raise Error(f"{results[0].path}: no load varies, a loop needs several steps")
    return {name: scale(results[0].units[name], *(one.series(name) for one in results)) for name in PAIRS[pair]}


def _last_cycle(results, names):
    """Returns the energy of the last whole cycle of the displacement, and the area of its loop as it is drawn, J; None
    if there is none."""
    if results.has_life:
        steps = results.of_computed_cycle(results.wear["cycle"][-1])
        force, way = (results.history[name][steps] for name in names)
        energy = results.wear[ENERGY][-1]
        return loop_energy(results, names, lambda name: results.history[name][steps], energy), area(way, force)
    cycles = by_turns(results.series(names[1]).astype(float))
    if not cycles:
        return None
    force, way = (results.series(name)[cycles[-1].rows] for name in names)
    return cycle_energy(results, names, cycles[-1]), area(way, force)


def _is_drawn(energy, drawn):
    """True if the area of a loop as it is drawn, whose steps are joined by straight lines, shows its energy."""
    return abs(drawn - energy) <= SEEN * abs(energy)


def _energy_text(results, energies):
    """Returns the energy of the last cycle for a legend; the area, too, where few steps make it another one."""
    if energies is None:
        return None
    energy, drawn = energies
    factor, unit = scale(results.work_unit, energy)
    manner = "" if energy == drawn else " dissipated"
    text = f"{factor * energy:.4g} {unit}{manner} in the last cycle"
    return text if _is_drawn(energy, drawn) else f"{text}\n(lines between steps: area {factor * drawn:.4g} {unit})"


def _parts_text(results, of):
    """Returns the parts of a cycle's energy by friction and by bodies that relax, and its loss factor, for a line of a
    legend; nothing if no body relaxes."""
    if VISCOUS not in results.history:
        return ""
    factor, unit = scale(results.work_unit, of.energy)
    parts = f"friction {factor * of.friction:.3g} {unit}, bodies {factor * of.viscous:.3g} {unit}"
    return f"\n({parts}, loss factor {of.loss_factor:.3g})"


def _labels(axes, factors):
    force, way = factors
    axes.set(xlabel=label(symbols.scalar(way), factors[way][1]), ylabel=label(symbols.scalar(force), factors[force][1]))


def _line(axes, x, y, color, text):
    axes.plot(x, y, color=color, label=text, **curve(x.size))


def _cloud(axes, x, y, color, text):
    points = np.column_stack([x, y])
    pieces = [points[k : k + PIECE + 1] for k in range(0, x.size - 1, PIECE)]
    axes.add_collection(LineCollection(pieces, colors=color, linewidths=0.6, alpha=0.3))
    axes.plot([], [], color=color, label=text)


def loop(results, pair=None):
    """Draws a load over its displacement for every file, with the last cycle's energy; only solved steps."""
    for one in results:
        one.need_solution()
    factors = loop_axes(results, pair)
    force, way = factors
    figure, axes = plt.subplots(figsize=(6.4, 4.8), constrained_layout=True)
    for one, color in zip(results, colors(len(results))):
        x, y = (factors[name][0] * one.series(name) for name in (way, force))
        text = _energy_text(one, _last_cycle(one, tuple(factors)))
        whole = by_turns(one.series(way).astype(float)) if text and VISCOUS in one.history else []
        if whole:
            text += _parts_text(one, sliding.numbers(one, whole[-1], force.removeprefix("load_")))
        if named(results):
            text = ": ".join(filter(None, (plain(one.label), text)))
        (_line if x.size <= DENSE else _cloud)(axes, x, y, color, text)
        last = {"markersize": 6.0, "markerfacecolor": "white", "zorder": 3}
        axes.plot(x[-1], y[-1], "o", color=color, label="last step" if one is results[-1] else None, **last)
    _labels(axes, factors)
    axes.legend(loc="upper left")
    axes.margins(y=0.15)
    return figure


# ---------------------------------------------------------------- chosen cycles


def cycle_loops(found, pair=None, numbers=None):
    """Loops of the cycles of these numbers (from 1, or -1 for the last), a curve each, in one panel."""
    results = [one.results for one in found]
    chosen = [(one, one.numbered(number)) for one in found for number in numbers]
    need_few(len(chosen), "cycles and files")
    factors = loop_axes(results, pair)
    force, way = factors
    pair = force.removeprefix("load_")
    known = [sliding.numbers(one.results, cycle, pair) for one, cycle in chosen]
    joules, unit = scale(results[0].work_unit, *(of.energy for of in known))
    figure, axes = plt.subplots(figsize=(7.6, 4.8), constrained_layout=True)
    tints = [tint(k, len(chosen)) for k in range(len(chosen))] if len(found) == 1 else colors(len(chosen))
    for (one, cycle), of, color in zip(chosen, known, tints):
        x, y = (factors[name][0] * one.results.series(name)[cycle.rows] for name in (way, force))
        who = "" if len(found) == 1 else plain(one.results.label) + ", "
        text = f"{who}{cycle.number}: {joules * of.energy:.4g} {unit}, {of.energy_ratio:.3g}, {of.sliding_ratio:.3g}"
        text += _parts_text(one.results, of)
        axes.plot(x, y, color=color, label=text, **curve(x.size))
    _labels(axes, factors)
    outside = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.3}
    title = "cycle: energy of the loop,\nenergy ratio, sliding ratio"
    drawn = [area(*(one.results.series(name)[cycle.rows] for name in (way, force))) for one, cycle in chosen]
    apart = [abs(size / of.energy - 1.0) for size, of in zip(drawn, known) if not _is_drawn(of.energy, size)]
    if apart:
        title += f"\n(lines between steps: area differs by up to {100.0 * max(apart):.2g} %)"
    axes.legend(title=title, **outside)
    axes.set_title("cycles by " + plain(found[0].manner), fontsize=9.5, color="0.35")
    return figure


def spread(count):
    """Numbers of up to LOOPS of count cycles: the first, the last, and others evenly between."""
    return sorted({1 + round(k) for k in np.linspace(0, count - 1, min(count, LOOPS))})


# ---------------------------------------------------------------- energy


def _energies(one):
    """Returns numbers and energies (J) of a file's cycles; for a life, of the computed cycles."""
    if one.results.has_life:
        return one.results.wear["cycle"], one.results.wear[ENERGY]
    return np.array([float(cycle.number) for cycle in one]), one.energies + one.viscous_energies


def energy(found, logs=()):
    """Energy that friction and the bodies dissipate in every cycle, one line per file."""
    for one in found:
        if not one.results.has_life and not len(one):
            raise Error(f"{one.results.path}: --energy: has no whole cycle, by {one.manner}; see --turns and --period")
    data = [_energies(one) for one in found]
    many, words = counted(largest(numbers for numbers, _ in data))
    many, words = (many, words) if many < 1e-2 else (1.0, "cycle")
    joules, unit = scale(found[0].results.work_unit, *(energies for _, energies in data))
    figure, axes = plt.subplots(figsize=(6.4, 4.4), constrained_layout=True)
    for one, (numbers, energies), color in zip(found, data, colors(len(found))):
        computed = " computed" if one.results.has_life else ""
        who = plain(one.results.label) + ": " if named([one.results for one in found]) else ""
        text = f"{who}{numbers.size}{computed} cycle{'s' * (numbers.size != 1)}"
        if not one.results.has_life:
            factor, total = scale("J", float(np.sum(energies)))
            text += f", {factor * np.sum(energies):.4g} {total}"
        axes.plot(many * numbers, joules * energies, color=color, label=text, **curve(numbers.size))
    axes.set(xlabel=words, ylabel=label("dissipated energy of a cycle", unit))
    logarithmic(axes, logs)
    if many == 1.0 and "x" not in logs:
        axes.xaxis.set_major_locator(MaxNLocator(8, integer=True, min_n_ticks=1))
        if axes.dataLim.width == 0.0:
            axes.set_xlim(axes.dataLim.x0 - 0.5, axes.dataLim.x1 + 0.5)
    if "y" not in logs:
        top, low = joules * largest(energies for _, energies in data), joules * min(np.min(one) for _, one in data)
        axes.set_ylim(min(0.0, low), HEADROOM * top if top > 0.0 else None)
    manners = {one.manner for one in found if not one.results.has_life}
    if len(manners) == 1:
        axes.set_title("cycles by " + plain(manners.pop()), fontsize=9.5, color="0.35")
    figure.legend(loc="outside lower left")  # below the axes: the curve may be anywhere above zero
    return figure
