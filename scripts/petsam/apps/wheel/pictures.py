"""Pictures of wheel and rail: sections with their patches, numbers over the lateral displacement, worn profiles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Optional

import numpy as np
from matplotlib.figure import Figure

from ...core.errors import Error
from ...plot.style import bar, colors, curve, drawn, field, plt
from .batch import Batch, Vehicle
from .conicity import Geometry, equivalent_conicity
from .equilibrium import Equilibrium
from .wearing import Worn

PANELS = 4  # patches of a picture at most
REACH = 0.045  # m beside the contact that a section shows
AMPLITUDES = np.linspace(0.5e-3, 8e-3, 31)  # of the equivalent conicity, m


@drawn()
def wheels(vehicle: Vehicle, found: Equilibrium) -> Figure:
    """Sections of both wheels on their rails with the patches, and pressure and slip of each patch.

    Parameters
    ----------
    vehicle : petsam.wheel.Vehicle
        Rails and wheels.
    found : petsam.wheel.Equilibrium
        The solution.

    Returns
    -------
    matplotlib.figure.Figure
    """
    patches = [(result.side, patch) for result in found.wheels[::-1] for patch in result.patches]
    strongest = sorted(patches, key=lambda one: -one[1].n)[:PANELS]
    shown = [one for one in patches if one in strongest]
    figure = plt.figure(figsize=(max(8.0, 2.9 * len(shown)), 6.6), layout="constrained")
    count = len(shown)
    cells = figure.add_gridspec(2, 2 * count)
    for k, (result, sign) in enumerate(zip(found.wheels[::-1], (-1.0, 1.0))):
        axes = figure.add_subplot(cells[0, k * count : (k + 1) * count])
        _section(axes, vehicle, found, result, sign)
    for k, (side, patch) in enumerate(shown):
        _patch(figure.add_subplot(cells[1, 2 * k : 2 * k + 2]), side, patch)
    return figure


def _section(axes, vehicle, found, result, sign):
    """Rail, wheel and patches of a side, mm; the wheel is turned by the roll."""
    sides = [(vehicle.rail, vehicle.wheel), vehicle.left or (vehicle.rail, vehicle.wheel)]
    rail, wheel = sides[0 if sign > 0.0 else 1]
    wheel = wheel.of_radius(vehicle.wheel.radius)
    section = rail.section
    axes.plot(1e3 * sign * section.y, 1e3 * section.z, color="0.35", label="rail")
    y, z = sign * wheel.section.y, wheel.section.z + wheel.radius
    c, s = np.cos(found.position.roll), np.sin(found.position.roll)
    down = found.position.z - wheel.radius
    axes.plot(1e3 * (c * y - s * z + found.position.y), 1e3 * (s * y + c * z + down), color=colors()[0], label="wheel")
    for k, patch in enumerate(result.patches):
        touching = patch.grid_s[patch.pressure.max(axis=1) > 0.0]
        ends = np.array([touching.min(), touching.max()])
        along, down = patch.y + ends * np.cos(patch.angle), patch.z + ends * np.sin(patch.angle)
        axes.plot(1e3 * along, 1e3 * down, color=colors()[1], linewidth=4.0, label="" if k else "patch")
    middle = 1e3 * sign * 0.5 * (section.first + section.last)
    axes.set(xlim=(middle - 1e3 * REACH, middle + 1e3 * REACH), ylim=(30.0, -15.0))
    vertical = result.force[2] / 1e3
    axes.set(title=f"{result.side} wheel, {vertical:.4g} kN", xlabel="$y$, mm", ylabel="$z$, mm", aspect="equal")
    axes.legend(loc="lower right" if sign > 0.0 else "lower left")


def _patch(axes, side, patch):
    """Pressure of a patch as colours, slip as contours."""
    rows = np.argsort(patch.grid_s)
    x, s = 1e3 * patch.grid_x, 1e3 * patch.grid_s[rows]
    pressure, slip = patch.pressure[rows], patch.slip[rows]
    half = 0.5 * (x[1] - x[0])
    values = np.ma.masked_where(pressure <= 0.0, pressure / 1e6)
    image = field(axes, values, (x[0] - half, x[-1] + half, s[0] - half, s[-1] + half))
    sliding = np.where(pressure > 0.0, 1e3 * slip, np.nan)
    if np.nanmax(sliding) > 1e-3:
        lines = axes.contour(x, s, sliding, 4, colors="white", linewidths=0.8)
        axes.clabel(lines, fontsize=7, fmt="%.2g")
    inside = pressure > 0.0
    across, along = s[inside.any(axis=1)], x[inside.any(axis=0)]
    axes.set(xlim=(along[0] - 1.0, along[-1] + 1.0), ylim=(across[0] - 1.0, across[-1] + 1.0))
    axes.set(title=f"{side}, $y$ = {1e3 * patch.y:.1f} mm, {patch.n / 1e3:.3g} kN", xlabel="$x$, mm", ylabel="$s$, mm")
    axes.set_aspect("equal")
    bar(axes, image, "pressure, MPa; slip in ‰" if np.nanmax(sliding) > 1e-3 else "pressure, MPa")


@drawn()
def over_y(shape: Geometry, batch: Optional[Batch] = None, amplitudes: Sequence[float] = AMPLITUDES) -> Figure:
    """Contact points, rolling radius difference and equivalent conicity (EN 15302), and T-gamma of a sweep.

    Parameters
    ----------
    shape : conicity.Geometry
        Of rigid wheels, of petsam.wheel.geometry().
    batch : batch.Batch, optional
        A sweep over the lateral displacement.
    amplitudes : sequence of float
        Of the equivalent conicity, m.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, panels = plt.subplots(2, 2, figsize=(9.0, 6.4), layout="constrained")
    (left, right), (low, last) = panels
    y = 1e3 * shape.y
    middle = 1e3 * 0.5 * float(shape.points[0].max() + shape.points[0].min())
    for values, sign, name, color in zip(shape.points, (1.0, -1.0), ("right", "left"), colors()):
        left.plot(y, 1e3 * sign * values - middle, color=color, label=f"{name} wheel")
    left.set(ylabel=f"contact, abs($y$) - {middle:.1f} mm, mm", title="contact points")
    left.legend()
    right.plot(y, 1e3 * shape.radius_difference, color=colors()[0])
    right.set(ylabel="right less left, mm", title="rolling radius difference")
    found = equivalent_conicity(shape.y, shape.radius_difference, amplitudes, shape.radius)
    low.plot(1e3 * np.asarray(amplitudes), found, color=colors()[0])
    low.set(xlabel="amplitude, mm", ylabel=r"tan $\gamma_e$", title="equivalent conicity, EN 15302", ylim=(0.0, None))
    if batch is None:
        last.plot(y, 1e3 * shape.roll, color=colors()[0])
        last.set(ylabel="mrad", title="roll")
    else:
        _work(last, batch)
    for axes in (left, right, last):
        axes.set_xlabel("lateral displacement, mm")
    return figure


def _work(axes, batch):
    """T-gamma of both wheels over the lateral displacement."""
    at = np.array([state.position.y for state in batch.states])
    order = np.argsort(at)
    for side, color in zip(("right", "left"), colors()):
        sums = []
        for one in batch.found:
            columns = {column.name: column.values for column in one.value or ()}
            own = [w for w, name in zip(columns.get("t_gamma", ()), columns.get("side", ())) if name == side]
            sums.append(sum(own) if columns else np.nan)
        axes.plot(1e3 * at[order], np.array(sums)[order], color=color, label=f"{side} wheel", **curve(len(at)))
    axes.set(ylabel="N", title=r"T$\gamma$: frictional work per distance")
    axes.legend()


@drawn(Worn)
def worn_profile(found: Worn) -> Figure:
    """The worn profile beside the new one, and the depth with its error.

    Parameters
    ----------
    found : petsam.wheel.Worn
        Of petsam.wheel.wear().

    Returns
    -------
    matplotlib.figure.Figure
    """
    if not found.depth.max() > 0.0:
        raise Error("worn_profile: nothing is worn")
    figure, (above, below) = plt.subplots(2, 1, figsize=(8.0, 5.8), sharex=True, layout="constrained")
    above.plot(1e3 * found.new.y, 1e3 * found.new.z, color="0.35", label="new")
    text = f"after {found.distance / 1e3:,.6g} km"
    above.plot(1e3 * found.worn.y, 1e3 * found.worn.z, color=colors()[1], label=text)
    above.invert_yaxis()
    above.set(ylabel="$z$, mm", aspect="equal", adjustable="datalim")
    above.legend()
    y, depth, error = 1e3 * found.new.y, 1e6 * found.depth, 1e6 * found.error
    below.fill_between(y, depth - error, depth + error, color=colors()[0], alpha=0.3, label="error by half the jumps")
    below.plot(y, depth, color=colors()[0], label="worn depth")
    below.set(xlabel="$y$ of the profile, mm", ylabel="depth, µm")
    below.legend()
    return figure
