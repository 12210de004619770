"""Curves over the depth below a place, and Kitagawa and Takahashi's diagram of a short crack."""

import numpy as np
from matplotlib.figure import Figure

from ...plot.style import colors, drawn, logarithmic, note, plt
from ...plot.units import label, number, plain, scale
from ...results.stresses import FATIGUE
from . import cracks
from .spectrum import Lives

KINDS = {"life": "life, cycles", "factor": "safety factor"}  # columns that share a panel
DASHES = ("-", "--", ":")


def _title(name):
    """A column's name in a picture."""
    name = name.removeprefix("life_").removeprefix("factor_")
    return FATIGUE.get(name, {"basquin": "Basquin"}.get(name, name.replace("_", " ")))


def _over_depth(panel, lines, names, length, unit):
    """One parameter of all lines over depth, or several lives or factors: a colour per line, a dash per name."""
    unit_of, kind = lines[0][1].columns[names[0]][0], names[0].split("_")[0]
    factor, prefixed = scale(unit_of, *(one.columns[names[0]][1] for _, one in lines))
    several = kind in KINDS and len(names) > 1  # one alone stands beside the axis
    for (who, one), tint in zip(lines, colors(len(lines))):
        for name, dash in zip(names, DASHES):
            values = factor * np.where(np.isinf(one.columns[name][1]), np.nan, one.columns[name][1])
            text = ", ".join([plain(who)] * (len(lines) > 1) + [_title(name)] * several)
            panel.plot(length * one.z, values, color=tint, linestyle=dash, label=text)
    what = KINDS[kind] if kind in KINDS else _title(names[0])
    if kind in KINDS and not several:
        what = f"{_title(names[0])}: {what}"
    panel.set(xlabel=label("depth $z$", unit), ylabel=label(what, prefixed))
    if kind == "life":
        logarithmic(panel, "y")
    if len(lines) > 1 or several:
        panel.legend()


def _intensity(panel, cracked, length, unit):
    """Range of K and its threshold over the length of the crack."""
    for (who, one), tint in zip(cracked, colors(len(cracked))):
        panel.plot(length * one.z, 1e-6 * one.columns["k_range"][1], color=tint, label=plain(who))
    panel.plot(length * one.z, 1e-6 * one.columns["k_threshold"][1], color="0.35", linestyle="--", label="threshold")
    panel.set(xlabel=label("length of the crack $a$", unit), ylabel="$\\Delta K$, MPa m$^{1/2}$")
    panel.legend()


def _kitagawa(panel, cracked, constants, length, unit):
    """Equivalent stress ranges over crack lengths with the fatigue limit, thresholds of long and of short cracks."""
    for (who, one), tint in zip(cracked, colors(len(cracked))):
        stress = cracks.stress_range(one.z[1:], one.columns["k_range"][1][1:])
        panel.plot(length * one.z[1:], 1e-6 * stress, color=tint, label=plain(who))
    dk_th, limit = constants["dk_th"], constants["stress_limit"]
    a0 = cracks.short_length(dk_th, limit)
    lengths = np.geomspace(min(one.z[1], a0 / 10.0), max(one.z[-1], 10.0 * a0), 200)
    short = cracks.stress_range(lengths, cracks.threshold(lengths, dk_th, limit))
    panel.plot(length * lengths, 1e-6 * short, color="0.35", linestyle="--", label="threshold (El Haddad)")
    long = cracks.stress_range(lengths, dk_th)
    some = long < 2.0 * limit
    panel.plot(length * lengths[some], 1e-6 * long[some], ":", color="0.5", linewidth=1.2, label="long cracks")
    panel.axhline(1e-6 * limit, color="0.5", linewidth=1.0, label="fatigue limit")
    logarithmic(panel, "xy")
    panel.set(xlabel=label("length of the crack $a$", unit), ylabel="equivalent $\\Delta\\sigma$, MPa")
    panel.legend()


@drawn(Lives)
def lives(found: Lives) -> Figure:
    """The lines over the depth, and two panels of a short crack.

    Parameters
    ----------
    found : lives.Lives
        The lives, of petsam.fatigue.lives().

    Returns
    -------
    matplotlib.figure.Figure
    """
    lines, constants = found.lines, found.constants
    first = lines[0][1]
    names = [name for name in first.columns if not name.startswith("k_")]
    panels = [[name] for name in names if name.split("_")[0] not in KINDS]
    panels += [same for kind in KINDS if (same := [name for name in names if name.startswith(kind + "_")])]
    cracked = [pair for pair in lines if "k_range" in pair[1].columns]
    count = len(panels) + 2 * bool(cracked)
    columns = min(3, count) if count != 4 else 2
    rows = -(-count // columns)
    length, unit = scale("m", float(first.z[-1]))
    size = (4.4 * columns, 3.4 * rows + 0.3)
    figure, axes = plt.subplots(rows, columns, figsize=size, squeeze=False, layout="constrained")
    for panel, same in zip(axes.flat, panels):
        _over_depth(panel, lines, same, length, unit)
    if cracked:
        _intensity(axes.flat[len(panels)], cracked, length, unit)
        _kitagawa(axes.flat[len(panels) + 1], cracked, constants, length, unit)
    for panel in axes.flat[count:]:
        panel.set_axis_off()
    across, its = scale("m", max(abs(first.x), abs(first.y)))
    note(figure, f"below $x$ = {number(across * first.x)} {its}, $y$ = {number(across * first.y)} {its}", 9.5)
    return figure
