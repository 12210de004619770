#!/usr/bin/env python3
"""Compare the punch example's results with the exact pressure and with Jaeger's principle, and draw them.

Reads the HDF5 files that examples/punch/run.sh writes to a directory, takes the last saved step of each,
draws pressure.png, tangential.png and torsion.png (profiles along y = 0 and maps), and prints tables.

Dimensionless: pressure p 2R/(E* c), shear q 2R/(mu E* c), lengths over the flat radius c; R is the edge radius.
Error norms:
  L2      sqrt(sum (numerical - exact)^2 / sum exact^2) over the cells
  others  numerical/exact - 1; a radius is that of the disc with the same area

Jaeger's principle: for nu = 0 and a force T_x, the shear is mu (p - p*), p* the pressure at the same tilt under the
load N - T_x/mu; it sticks where p* > 0. It holds for petsam's discrete equations, too, so the two must agree to the
solvers' tolerance.
"""
import os
import sys

import h5py
import numpy as np

import analytic
from figures import STYLE, InputError, finish_numbers, main, plt, print_table, relative_l2, save

MOMENTS = ("0", "5e3", "1e4", "1.5e4", "2e4", "2.5e4", "3e4")
RATIOS = ("0.10", "0.30", "0.50", "0.70", "0.90", "0.95")
RATIOS_EXACT = ("0.30", "0.60", "0.90")
TORQUES = ("300", "600", "900", "1200", "1500", "1700")
MAP_MOMENTS, MAP_RATIOS, MAP_TORQUES = ("0", "1e4", "2e4", "3e4"), ("0.30", "0.70", "0.95"), ("600", "1200", "1700")

FIELDS = ("pressure", "shear_x", "shear_y", "state")
HISTORY = (
    "load_n", "load_tx", "load_my", "load_mz", "disp_z", "disp_x", "rot_y", "rot_z", "contact_area", "stick_area")
STICK = 1


# ---------------------------------------------------------------- reading

class Result:
    """The last saved step of one HDF5 file, with the punch's parameters (SI units).

    x, y (m) are the cell centres; pressure, shear_x, shear_y (Pa) and state have shape (ny, nx); history holds the
    scalars of the last load step by name.
    """

    def __init__(self, directory, name):
        self.path = os.path.join(directory, name + ".h5")
        if not os.path.isfile(self.path):
            raise InputError("{}: no such file; run examples/punch/run.sh first".format(self.path))
        try:
            with h5py.File(self.path, "r") as file:
                self._read(file)
        except (OSError, KeyError, ValueError, IndexError) as error:
            raise InputError("{}: cannot be read: {}".format(self.path, error)) from error
        self.pressure_unit = self.e_star * self.c / (2.0 * self.edge_radius)
        self.shear_unit = self.friction * self.pressure_unit
        self.row = int(np.argmin(np.abs(self.y)))

    def _read(self, file):
        def parameter(name):
            return float(np.ravel(file.attrs[name])[0])

        self.poisson, self.friction = parameter("body1_poisson"), parameter("friction")
        self.e_star = analytic.effective_modulus(
            parameter("body1_young"), self.poisson, parameter("body2_young"), parameter("body2_poisson"))
        self.c, self.edge_radius = parameter("gap_flat_radius"), parameter("gap_edge_radius")
        self.x, self.y = file["x"][:], file["y"][:]
        for name in FIELDS:
            field = file[name][-1]
            if field.shape != (self.y.size, self.x.size) or not np.all(np.isfinite(field)):
                raise ValueError("/{} is not a finite field of shape (ny, nx)".format(name))
            setattr(self, name, field)
        self.history = {name: float(file["history/" + name][-1]) for name in HISTORY}

    @property
    def moment(self):
        """M_y, N m, without the rounding of a moment that is zero."""
        return round(self.history["load_my"], 6) + 0.0

    @property
    def load_ratio(self):
        """T_x/(mu N)."""
        return self.history["load_tx"] / (self.friction * self.history["load_n"])

    @property
    def shear(self):
        """|q|, Pa."""
        return np.hypot(self.shear_x, self.shear_y)

    def radius(self, area):
        """Radius, m, of the disc with the area of this name."""
        return np.sqrt(self.history[area] / np.pi)

    def contact_ends(self, coordinate, axis):
        """Outermost edges, m, of the cells in contact along a coordinate."""
        touched = coordinate[np.any(self.pressure > 0.0, axis=axis)]
        half = 0.5 * (coordinate[1] - coordinate[0])
        return touched[0] - half, touched[-1] + half


class Exact:
    """The exact axisymmetric contact of a result under its normal load alone."""

    def __init__(self, case):
        self.shape = (case.c, case.edge_radius, case.e_star)
        self.radius = analytic.rounded_punch_radius(case.history["load_n"], *self.shape)
        self.approach = analytic.rounded_punch_approach(self.radius, case.c, case.edge_radius)
        self.torque = analytic.rounded_punch_torsion_limit(self.radius, *self.shape, case.friction)

    def pressure(self, r):
        """p, Pa, at r (m)."""
        return analytic.rounded_punch_pressure(r, self.radius, *self.shape)


# ---------------------------------------------------------------- numbers

def normal_numbers(case, gross, exact):
    """Errors under N alone, and that of the torque at gross slip."""
    field = np.array([exact.pressure(np.hypot(case.x, y)) for y in case.y])
    radius = case.radius("contact_area")
    return {
        "grid": [case.x.size, case.y.size], "pressure_l2": relative_l2(case.pressure, field),
        "radius_exact": exact.radius, "radius": radius, "radius_error": radius / exact.radius - 1.0,
        "approach_error": case.history["disp_z"] / exact.approach - 1.0,
        "torque_limit_exact": exact.torque, "torque_limit": gross.history["load_mz"],
        "torque_limit_error": gross.history["load_mz"] / exact.torque - 1.0,
    }


def tilt_numbers(case):
    """Extent of the contact, greatest pressure and tilt under M_y."""
    left, right = case.contact_ends(case.x, 0)
    return {
        "load_my": case.moment, "rot_y": case.history["rot_y"],
        "left": left / case.c, "right": right / case.c, "top": case.contact_ends(case.y, 1)[1] / case.c,
        "pressure": float(np.max(case.pressure)) / case.pressure_unit,
        "pressure_mpa": float(np.max(case.pressure)) * 1e-6,
        "area": case.history["contact_area"] / (np.pi * case.c**2),
    }


def tangential_numbers(case):
    """Displacement, greatest shear and share of stick under T_x."""
    return {
        "poisson": case.poisson, "load_ratio": case.load_ratio, "disp_x": case.history["disp_x"],
        "shear": float(np.max(case.shear)) / case.shear_unit,
        "stick": case.history["stick_area"] / case.history["contact_area"],
        "shear_y_over_shear_x": float(np.max(np.abs(case.shear_y)) / np.max(np.abs(case.shear_x))),
    }


def jaeger_shear(case, less):
    """mu (p - p*), Pa."""
    return case.friction * (case.pressure - less.pressure)


def jaeger_numbers(case, less):
    """Errors of q_x and d_x against Jaeger's principle, and the number of cells whose stick differs."""
    rigid = case.friction * (case.history["disp_z"] - less.history["disp_z"])
    return {
        "load_ratio": case.load_ratio, "shear_l2": relative_l2(case.shear_x, jaeger_shear(case, less)),
        "displacement": case.history["disp_x"] / rigid - 1.0, "stick_cells": int(np.sum(case.state == STICK)),
        "stick_cells_that_differ": int(np.sum((case.state == STICK) != (less.pressure > 0.0))),
    }


def torsion_numbers(case, exact):
    """Twist, greatest shear and stick radius under M_z."""
    return {
        "load_mz": case.history["load_mz"], "torque_ratio": case.history["load_mz"] / exact.torque,
        "rot_z": case.history["rot_z"], "shear": float(np.max(case.shear)) / case.shear_unit,
        "stick_radius": case.radius("stick_area") / exact.radius,
    }


def print_numbers(numbers):
    """Print the five tables."""
    normal = numbers["normal"]
    print("cells: {} x {}".format(*normal["grid"]))
    print_table("Normal load against the exact solution", {
        "p, L2": ("pressure_l2", "{:.2e}"), "a exact, mm": ("a_mm", "{:.4f}"),
        "a": ("radius_error", "{:+.2e}"), "approach": ("approach_error", "{:+.2e}"),
        "limit, N m": ("torque_limit_exact", "{:.3f}"), "limit of M_z": ("torque_limit_error", "{:+.2e}")},
        [{**normal, "a_mm": 1e3 * normal["radius_exact"]}])
    print_table("Tilting moment (lengths over c, area over pi c^2)", {
        "M_y, N m": ("load_my", "{:g}"), "tilt, rad": ("rot_y", "{:.4e}"), "x from": ("left", "{:+.3f}"),
        "x to": ("right", "{:+.3f}"), "y to": ("top", "{:.3f}"), "area": ("area", "{:.3f}"),
        "max p 2R/E*c": ("pressure", "{:.4f}"), "max p, MPa": ("pressure_mpa", "{:.0f}")}, numbers["tilt"])
    print_table("Tangential force with M_y = 5e3 N m", {
        "nu": ("poisson", "{:g}"), "T/(mu N)": ("load_ratio", "{:.3g}"), "d_x, m": ("disp_x", "{:.4e}"),
        "stick share": ("stick", "{:.4f}"), "max q 2R/...": ("shear", "{:.4f}"),
        "max q_y/q_x": ("shear_y_over_shear_x", "{:.1e}")}, numbers["tangential"])
    print_table("Tangential force against Jaeger's principle, nu = 0", {
        "T/(mu N)": ("load_ratio", "{:.3g}"), "q_x, L2": ("shear_l2", "{:.1e}"), "d_x": ("displacement", "{:+.1e}"),
        "stick cells": ("stick_cells", "{:d}"), "that differ": ("stick_cells_that_differ", "{:d}")}, numbers["jaeger"])
    print_table("Torque (last: gross slip)", {
        "M_z, N m": ("load_mz", "{:.3f}"), "M/M_lim": ("torque_ratio", "{:.5f}"), "twist, rad": ("rot_z", "{:.4e}"),
        "stick rad./a": ("stick_radius", "{:.4f}"), "max q 2R/...": ("shear", "{:.4f}")}, numbers["torsion"])


# ---------------------------------------------------------------- drawing

def tint(index, count):
    """Colour of the index-th of count load levels."""
    return plt.get_cmap("plasma")(0.88 * index / max(1, count - 1))


def layout(profiles, maps, lower_height):
    """A figure with profiles above and a row of maps below: figure, upper axes, lower axes; lower_height in inches."""
    figure = plt.figure(figsize=(10.4, 4.2 + lower_height), constrained_layout=True)
    figure.set_constrained_layout_pads(h_pad=0.1)
    rows = figure.add_gridspec(2, 1, height_ratios=(4.2, lower_height))
    upper, lower = rows[0].subgridspec(1, profiles), rows[1].subgridspec(1, maps)
    above = [figure.add_subplot(upper[k]) for k in range(profiles)]
    below = [figure.add_subplot(lower[k]) for k in range(maps)]
    for axes in below[1:]:
        axes.tick_params(labelleft=False)
    return figure, above, below


def profile(axes, case, values, **style):
    """values (a field) along the row nearest y = 0, over x/c."""
    axes.plot(case.x / case.c, values[case.row], **style)


def sparse(case, count=72):
    """Every m-th cell of the contact in the row nearest y = 0, symmetric about its middle."""
    keep = np.flatnonzero(case.pressure[case.row] > 0.0)
    step = max(1, keep.size // count) | 1
    rest = (keep.size - 1) % step
    return keep[(rest + step * (rest % 2)) // 2::step]


def draw_maps(panels, cases, field_of, titles, top, label, xlim):
    """Maps of field_of(case) with the outline of the contact (black) and of the stick zone (white)."""
    for axes, case, title in zip(panels, cases, titles):
        half_x, half_y = (0.5 * (z[1] - z[0]) for z in (case.x, case.y))
        extent = np.array([case.x[0] - half_x, case.x[-1] + half_x, case.y[0] - half_y, case.y[-1] + half_y]) / case.c
        field, contact = field_of(case), case.pressure > 0.0
        image = axes.imshow(np.where(contact, field, np.nan), origin="lower", extent=extent, vmin=0.0, vmax=top,
                            cmap="viridis", interpolation="nearest")
        x, y = case.x / case.c, case.y / case.c
        axes.contour(x, y, contact, [0.5], colors="black", linewidths=0.8)
        stick = case.state == STICK
        if np.any(case.shear > 0.0) and np.any(stick):
            axes.contour(x, y, stick, [0.5], colors="white", linewidths=1.2)
        axes.add_patch(plt.Circle((0.0, 0.0), 1.0, fill=False, color="0.5", linewidth=0.8, linestyle=":"))
        axes.set(title=title, xlabel="$x/c$", xlim=xlim, ylim=(-1.3, 1.3), aspect="equal")
        axes.grid(False)
    panels[0].set_ylabel("$y/c$")
    panels[0].figure.colorbar(image, ax=list(panels), label=label, shrink=0.95, aspect=16)


def legend(axes, title, **where):
    """Legend of the load levels."""
    axes.legend(title=title, handletextpad=0.5, labelspacing=0.3, borderpad=0.2, **where)


def note(case, unit, name, more):
    """The line above a figure."""
    return "{} x {} cells;  {} = {:.4g} MPa, $c$ = {:g} mm, $R$ = {:g} m;  {}".format(
        case.x.size, case.y.size, name, unit * 1e-6, 1e3 * case.c, case.edge_radius, more)


def figure_pressure(directory, tilts, exact):
    """p 2R/(E* c) for M_y from 0 to 3e4 N m."""
    figure, (axes,), panels = layout(1, len(MAP_MOMENTS), 2.3)
    first = tilts[0]
    unit, label = first.pressure_unit, r"$p\,2R/(E^*c)$"
    for edge in (-1.0, 1.0):
        axes.axvline(edge, color="0.6", linewidth=0.8, linestyle=":")
    axes.axvline(1.5, color="0.3", linewidth=0.9, linestyle="--")
    height = max(np.max(case.pressure) for case in tilts) / unit
    axes.text(1.52, 1.19 * height, "half width $1.5c$: too small\nfrom 1.9e4 N m on", va="top", fontsize=8.5)
    axes.text(-0.98, 1.19 * height, "edge of the flat base", va="top", fontsize=8.5, color="0.4")
    for index, case in enumerate(tilts):
        colour, name = tint(index, len(tilts)), "{:g}".format(case.moment)
        if index:
            profile(axes, case, case.pressure / unit, color=colour, linewidth=1.5, label=name)
        else:
            x = np.linspace(-1.05, 1.05, 2001) * exact.radius
            r, keep = np.hypot(x, case.y[case.row]), sparse(case)
            axes.plot(x / case.c, exact.pressure(r) / unit, color=colour, linewidth=1.2, label="0, exact")
            axes.plot(case.x[keep] / case.c, case.pressure[case.row, keep] / unit, "o", color=colour, markersize=3.6,
                      markerfacecolor="white", label="0, petsam", zorder=3)
    legend(axes, r"$M_y$, N m", loc="center left")
    axes.set(title="Tilting moment: pressure along $y = 0$", xlabel="$x/c$", ylabel=label,
             xlim=(first.x[0] / first.c, 2.25), ylim=(-0.02 * height, 1.2 * height))
    cases = [tilts[MOMENTS.index(moment)] for moment in MAP_MOMENTS]
    draw_maps(panels, cases, lambda case: case.pressure / unit,
              ["$M_y$ = {:g} N m".format(case.moment) for case in cases], height, label, (-1.3, 2.15))
    figure.suptitle(note(first, unit, "$E^*c/2R$", "dotted: flat base"), fontsize=9, color="0.35")
    save(figure, directory, "pressure.png")


def figure_tangential(directory, cases, exact_cases, less):
    """q_x 2R/(mu E* c) under T_x with M_y."""
    figure, above, panels = layout(2, len(MAP_RATIOS), 3.2)
    unit, label = cases[0].shear_unit, r"$q_x\,2R/(\mu E^*c)$"
    height = np.max(cases[0].pressure) / cases[0].pressure_unit
    for axes, group in zip(above, (cases, exact_cases)):
        profile(axes, group[0], group[0].friction * group[0].pressure / unit, color="0.6", linewidth=1.0,
                linestyle="--", label=r"$\mu p$")
        axes.set(xlabel="$x/c$", ylabel=label, xlim=(-1.3, 1.3), ylim=(-0.02 * height, 1.06 * height))
    for case in cases:
        colour = tint(np.interp(case.load_ratio, [float(t) for t in RATIOS], np.arange(len(RATIOS))), len(RATIOS))
        profile(above[0], case, case.shear_x / unit, color=colour, linewidth=1.5, label="{:g}".format(case.load_ratio))
    for case, other in zip(exact_cases, less):
        colour = tint(np.interp(case.load_ratio, [float(t) for t in RATIOS], np.arange(len(RATIOS))), len(RATIOS))
        profile(above[1], case, jaeger_shear(case, other) / unit, color=colour, linewidth=1.2)
        keep = sparse(case)
        above[1].plot(case.x[keep] / case.c, case.shear_x[case.row, keep] / unit, "o", color=colour, markersize=3.6,
                      markerfacecolor="white", label="{:g}".format(case.load_ratio), zorder=3)
    for axes in above:
        legend(axes, r"$T_x/(\mu N)$", loc="upper left")
    above[0].set_title(r"Shear along $y = 0$, $\nu = {:g}$".format(cases[0].poisson))
    above[1].set_title(r"$\nu = 0$: points $q_x$, lines $\mu(p - p^*)$ (Jaeger)")
    above[1].set_ylabel("")
    chosen = [cases[RATIOS.index(ratio)] for ratio in MAP_RATIOS]
    draw_maps(panels, chosen, lambda case: case.shear_x / unit,
              [r"$T_x = {:g}\,\mu N$".format(case.load_ratio) for case in chosen], height, label, (-1.3, 1.3))
    more = "$M_y$ = {:g} N m;  white: stick zone, dotted: flat base".format(cases[0].moment)
    figure.suptitle(note(cases[0], unit, r"$\mu E^*c/2R$", more), fontsize=9, color="0.35")
    save(figure, directory, "tangential.png")


def figure_torsion(directory, cases, gross, exact):
    """|q| 2R/(mu E* c) under M_z up to gross slip."""
    shown = [*(cases[TORQUES.index(torque)] for torque in MAP_TORQUES), gross]
    figure, (axes,), panels = layout(1, len(shown), 2.7)
    unit, label = gross.shear_unit, r"$|q|\,2R/(\mu E^*c)$"
    height = np.max(gross.shear) / unit
    x = np.linspace(-1.05, 1.05, 2001) * exact.radius
    axes.plot(x / gross.c, gross.friction * exact.pressure(np.hypot(x, gross.y[gross.row])) / unit, color="0.6",
              linewidth=1.2, label=r"$\mu p$, exact")
    for index, case in enumerate(cases):
        profile(axes, case, case.shear / unit, color=tint(index, len(cases)), linewidth=1.5,
                label="{:g}".format(case.history["load_mz"]))
    keep = sparse(gross)
    axes.plot(gross.x[keep] / gross.c, gross.shear[gross.row, keep] / unit, "o", color="0.25", markersize=3.6,
              markerfacecolor="white", label="{:.2f}, gross slip".format(gross.history["load_mz"]), zorder=3)
    legend(axes, "$M_z$, N m", loc="center right")
    axes.set(title="Torque: shear along $y = 0$", xlabel="$x/c$", ylabel=label, xlim=(-1.3, 1.9),
             ylim=(-0.02 * height, 1.06 * height))
    titles = ["$M_z$ = {:g} N m".format(case.history["load_mz"]) for case in shown[:-1]] + ["gross slip"]
    draw_maps(panels, shown, lambda case: case.shear / unit, titles, height, label, (-1.3, 1.3))
    figure.suptitle(note(gross, unit, r"$\mu E^*c/2R$", "white: stick zone, dotted: flat base"),
                    fontsize=9, color="0.35")
    save(figure, directory, "torsion.png")


# ---------------------------------------------------------------- program

def run(options):
    """Read, print the numbers, draw."""
    def load(form, levels):
        return [Result(options.directory, form.format(level)) for level in levels]

    normal, gross = Result(options.directory, "normal"), Result(options.directory, "torsion_gross")
    tilts, torsion = load("tilt_my{}", MOMENTS), load("torsion_mz{}", TORQUES)
    tangential = load("tangential_nu0.3_t{}", RATIOS)
    exact_cases, less = load("tangential_nu0_t{}", RATIOS_EXACT), load("less_t{}", RATIOS_EXACT)
    exact = Exact(normal)
    numbers = {
        "normal": normal_numbers(normal, gross, exact),
        "tilt": [tilt_numbers(case) for case in tilts],
        "tangential": [tangential_numbers(case) for case in tangential],
        "jaeger": [jaeger_numbers(case, other) for case, other in zip(exact_cases, less)],
        "torsion": [torsion_numbers(case, exact) for case in torsion + [gross]],
    }
    print_numbers(numbers)
    figures = finish_numbers(options, numbers)
    with plt.rc_context(STYLE):
        figure_pressure(figures, tilts, exact)
        figure_tangential(figures, tangential, exact_cases, less)
        figure_torsion(figures, torsion, gross, exact)


if __name__ == "__main__":
    sys.exit(main(run, __doc__, "punch"))
