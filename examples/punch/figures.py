"""Compare the punch example's results with the exact pressure and with Jaeger's principle, and draw them.

Reads the HDF5 files that examples/punch/run.sh writes to a directory, takes the last saved step of each,
draws pressure.png, tangential.png, torsion.png (profiles along y = 0 and maps) and stress.png, and prints tables.

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
from pathlib import Path

import numpy as np

import petsam
from petsam.closed import Bodies
from petsam.closed.punch import Punch, punch_approach, punch_pressure, punch_radius, punch_torsion_limit
from petsam.plot.style import extent, field, frame, note, plt, points, save, thinned, tint
from petsam.results import STICK

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402
from comparison import relative_l2  # noqa: E402

MOMENTS = ("0", "5e3", "1e4", "1.5e4", "2e4", "2.5e4", "3e4")
RATIOS = ("0.10", "0.30", "0.50", "0.70", "0.90", "0.95")
RATIOS_EXACT = ("0.30", "0.60", "0.90")
TORQUES = ("300", "600", "900", "1200", "1500", "1700")
RATIOS_STRESS = ("0.30", "0.70", "0.95")
MAP_MOMENTS, MAP_RATIOS, MAP_TORQUES = ("0", "1e4", "2e4", "3e4"), ("0.30", "0.70", "0.95"), ("600", "1200", "1700")
POINTS_ON_LINE = 72


class Case(petsam.Snapshot):
    """The last saved step of a file, with the punch's shape and the units of the pictures (SI units)."""

    def __init__(self, directory, name):
        super().__init__(petsam.open(os.path.join(directory, name + ".h5")))
        bodies, self.friction = Bodies.of(self.parameters), self.results.friction(self.index)
        self.punch = Punch(*(self.parameters[name] for name in ("gap_flat_radius", "gap_edge_radius")), bodies.e_star)
        self.c, self.poisson = self.punch.c, bodies.poisson1
        self.pressure_unit = bodies.e_star * self.c / (2.0 * self.punch.edge_radius)
        self.shear_unit = self.friction * self.pressure_unit
        self.moment = round(self["load_my"], 6) + 0.0  # without the rounding of one that is zero
        self.load_ratio = self["load_tx"] / (self.friction * self["load_n"])

    def contact_ends(self, coordinate, axis):
        """Outermost edges, m, of the cells in contact along a coordinate."""
        touched = coordinate[np.any(self["pressure"] > 0.0, axis=axis)]
        half = 0.5 * (coordinate[1] - coordinate[0])
        return touched[0] - half, touched[-1] + half


class Exact:
    """The exact axisymmetric contact of a case under its normal load alone."""

    def __init__(self, case):
        self.punch = case.punch
        self.radius = punch_radius(self.punch, case["load_n"])
        self.approach = punch_approach(self.punch, self.radius)
        self.torque = punch_torsion_limit(self.punch, self.radius, case.friction)

    def pressure(self, r):
        """p, Pa, at r (m)."""
        return punch_pressure(r, self.punch, self.radius)


# ---------------------------------------------------------------- numbers


def normal_numbers(case, gross, exact):
    """Errors under N alone, and that of the torque at gross slip."""
    field = np.array([exact.pressure(r) for r in case.r])
    radius = case.radius("contact_area")
    return {
        "grid": [case.x.size, case.y.size],
        "pressure_l2": relative_l2(case["pressure"], field),
        "radius_exact": exact.radius,
        "radius": radius,
        "radius_error": radius / exact.radius - 1.0,
        "approach_error": case["disp_z"] / exact.approach - 1.0,
        "torque_limit_exact": exact.torque,
        "torque_limit": gross["load_mz"],
        "torque_limit_error": gross["load_mz"] / exact.torque - 1.0,
    }


def tilt_numbers(case):
    """Extent of the contact, greatest pressure and tilt under M_y."""
    left, right = case.contact_ends(case.x, 0)
    return {
        "load_my": case.moment,
        "rot_y": case["rot_y"],
        "left": left / case.c,
        "right": right / case.c,
        "top": case.contact_ends(case.y, 1)[1] / case.c,
        "pressure": float(np.max(case["pressure"])) / case.pressure_unit,
        "pressure_mpa": float(np.max(case["pressure"])) * 1e-6,
        "area": case["contact_area"] / (np.pi * case.c**2),
    }


def tangential_numbers(case):
    """Displacement, greatest shear and share of stick under T_x."""
    return {
        "poisson": case.poisson,
        "load_ratio": case.load_ratio,
        "disp_x": case["disp_x"],
        "shear": float(np.max(case.shear)) / case.shear_unit,
        "stick": case["stick_area"] / case["contact_area"],
        "shear_y_over_shear_x": float(np.max(np.abs(case["shear_y"])) / np.max(np.abs(case["shear_x"]))),
    }


def jaeger_shear(case, less):
    """mu (p - p*), Pa."""
    return case.friction * (case["pressure"] - less["pressure"])


def jaeger_numbers(case, less):
    """Errors of q_x and d_x against Jaeger's principle, and the number of cells whose stick differs."""
    rigid = case.friction * (case["disp_z"] - less["disp_z"])
    return {
        "load_ratio": case.load_ratio,
        "shear_l2": relative_l2(case["shear_x"], jaeger_shear(case, less)),
        "displacement": case["disp_x"] / rigid - 1.0,
        "stick_cells": int(np.sum(case["state"] == STICK)),
        "stick_cells_that_differ": int(np.sum((case["state"] == STICK) != (less["pressure"] > 0.0))),
    }


def torsion_numbers(case, exact):
    """Twist, greatest shear and stick radius under M_z."""
    return {
        "load_mz": case["load_mz"],
        "torque_ratio": case["load_mz"] / exact.torque,
        "rot_z": case["rot_z"],
        "shear": float(np.max(case.shear)) / case.shear_unit,
        "stick_radius": case.radius("stick_area") / exact.radius,
    }


# ---------------------------------------------------------------- drawing


def ratio_tint(case):
    """Colour of a load ratio."""
    return tint(np.interp(case.load_ratio, [float(t) for t in RATIOS], range(len(RATIOS))), len(RATIOS))


def layout(profiles, maps, lower_height):
    """A figure with profiles above and a row of maps below: figure, upper axes, lower axes; lower_height in inches."""
    figure = plt.figure(figsize=(10.4, 4.2 + lower_height), constrained_layout=True)
    figure.set_constrained_layout_pads(h_pad=0.1)
    rows = figure.add_gridspec(2, 1, height_ratios=(4.2, lower_height))
    above, below = (
        [figure.add_subplot(part) for part in row.subgridspec(1, count)] for row, count in zip(rows, (profiles, maps))
    )
    for axes in below[1:]:
        axes.tick_params(labelleft=False)
    return figure, above, below


def profile(axes, case, values, **style):
    """values (a field) along the row nearest y = 0, over x/c."""
    axes.plot(case.x / case.c, values[case.row], **{"linewidth": 1.5, **style})


def profile_points(axes, case, values, color, label):
    """The same as points, in every m-th cell of the contact."""
    keep = thinned(np.flatnonzero(case["pressure"][case.row] > 0.0), POINTS_ON_LINE)
    points(axes, case.x[keep] / case.c, values[case.row, keep], color, label=label)


def draw_maps(panels, cases, field_of, titles, top, label, xlim):
    """Maps of field_of(case) with the outline of the contact (black) and of the stick zone (white)."""
    for axes, case, title in zip(panels, cases, titles):
        contact, stick = case["pressure"] > 0.0, case["state"] == STICK
        image = field(axes, np.where(contact, field_of(case), np.nan), extent(case.x, case.y, case.c), 0.0, top)
        x, y = case.x / case.c, case.y / case.c
        axes.contour(x, y, contact, [0.5], colors="black", linewidths=0.8)
        if np.any(case.shear > 0.0) and np.any(stick):
            axes.contour(x, y, stick, [0.5], colors="white", linewidths=1.2)
        axes.add_patch(plt.Circle((0.0, 0.0), 1.0, fill=False, color="0.5", linewidth=0.8, linestyle=":"))
        frame(axes, title, "$x/c$", "", xlim, (-1.3, 1.3))
    panels[0].set_ylabel("$y/c$")
    panels[0].figure.colorbar(image, ax=list(panels), label=label, shrink=0.95, aspect=16)


def legend(axes, title, **where):
    """Legend of the load levels."""
    axes.legend(title=title, handletextpad=0.5, labelspacing=0.3, borderpad=0.2, **where)


def finish(figure, directory, name, case, unit, more):
    """The line above a figure, unit being (its value, Pa, its formula); write it."""
    note(
        figure,
        f"{case.x.size} x {case.y.size} cells;  {unit[1]} = {unit[0] * 1e-6:.4g} MPa, "
        f"$c$ = {1e3 * case.c:g} mm, $R$ = {case.punch.edge_radius:g} m;  {more}",
    )
    save(figure, directory, name)


def figure_pressure(directory, tilts, exact):
    """p 2R/(E* c) for M_y from 0 to 3e4 N m."""
    figure, (axes,), panels = layout(1, len(MAP_MOMENTS), 2.3)
    first, label = tilts[0], r"$p\,2R/(E^*c)$"
    unit = first.pressure_unit
    for edge in (-1.0, 1.0):
        axes.axvline(edge, color="0.6", linewidth=0.8, linestyle=":")
    axes.axvline(1.5, color="0.3", linewidth=0.9, linestyle="--")
    height = max(np.max(case["pressure"]) for case in tilts) / unit
    axes.text(1.52, 1.19 * height, "half width $1.5c$: too small\nfrom 1.9e4 N m on", va="top", fontsize=8.5)
    axes.text(-0.98, 1.19 * height, "edge of the flat base", va="top", fontsize=8.5, color="0.4")
    x = np.linspace(-1.05, 1.05, 2001) * exact.radius
    axes.plot(
        x / first.c,
        exact.pressure(np.hypot(x, first.y[first.row])) / unit,
        color=tint(0, 1),
        linewidth=1.2,
        label="0, exact",
    )
    profile_points(axes, first, first["pressure"] / unit, tint(0, 1), "0, petsam")
    for index, case in enumerate(tilts[1:], 1):
        profile(axes, case, case["pressure"] / unit, color=tint(index, len(tilts)), label=f"{case.moment:g}")
    legend(axes, r"$M_y$, N m", loc="center left")
    title = "Tilting moment: pressure along $y = 0$"
    frame(axes, title, "$x/c$", label, (first.x[0] / first.c, 2.25), (-0.02 * height, 1.2 * height))
    cases = [tilts[MOMENTS.index(moment)] for moment in MAP_MOMENTS]
    draw_maps(
        panels,
        cases,
        lambda case: case["pressure"] / unit,
        [f"$M_y$ = {case.moment:g} N m" for case in cases],
        height,
        label,
        (-1.3, 2.15),
    )
    finish(figure, directory, "pressure.png", first, (unit, "$E^*c/2R$"), "dotted: flat base")


def figure_tangential(directory, cases, exact_cases, less):
    """q_x 2R/(mu E* c) under T_x with M_y."""
    figure, above, panels = layout(2, len(MAP_RATIOS), 3.2)
    unit, label = cases[0].shear_unit, r"$q_x\,2R/(\mu E^*c)$"
    height = np.max(cases[0]["pressure"]) / cases[0].pressure_unit
    for axes, (first, *_) in zip(above, (cases, exact_cases)):
        profile(
            axes,
            first,
            first.friction * first["pressure"] / unit,
            color="0.6",
            linewidth=1.0,
            linestyle="--",
            label=r"$\mu p$",
        )
        axes.set(xlabel="$x/c$", ylabel=label, xlim=(-1.3, 1.3), ylim=(-0.02 * height, 1.06 * height))
    for case in cases:
        profile(above[0], case, case["shear_x"] / unit, color=ratio_tint(case), label=f"{case.load_ratio:g}")
    for case, other in zip(exact_cases, less):
        profile(above[1], case, jaeger_shear(case, other) / unit, color=ratio_tint(case), linewidth=1.2)
        profile_points(above[1], case, case["shear_x"] / unit, ratio_tint(case), f"{case.load_ratio:g}")
    for axes in above:
        legend(axes, r"$T_x/(\mu N)$", loc="upper left")
    above[0].set_title(rf"Shear along $y = 0$, $\nu = {cases[0].poisson:g}$")
    above[1].set_title(r"$\nu = 0$: points $q_x$, lines $\mu(p - p^*)$ (Jaeger)")
    above[1].set_ylabel("")
    chosen = [cases[RATIOS.index(ratio)] for ratio in MAP_RATIOS]
    draw_maps(
        panels,
        chosen,
        lambda case: case["shear_x"] / unit,
        [rf"$T_x/(\mu N) = {case.load_ratio:g}$" for case in chosen],
        height,
        label,
        (-1.3, 1.3),
    )
    finish(
        figure,
        directory,
        "tangential.png",
        cases[0],
        (unit, r"$\mu E^*c/2R$"),
        f"$M_y$ = {cases[0].moment:g} N m;  white: stick zone, dotted: flat base",
    )


def figure_torsion(directory, cases, gross, exact):
    """|q| 2R/(mu E* c) under M_z up to gross slip."""
    shown = [*(cases[TORQUES.index(torque)] for torque in MAP_TORQUES), gross]
    figure, (axes,), panels = layout(1, len(shown), 2.7)
    unit, label = gross.shear_unit, r"$|q|\,2R/(\mu E^*c)$"
    height = np.max(gross.shear) / unit
    x = np.linspace(-1.05, 1.05, 2001) * exact.radius
    axes.plot(
        x / gross.c,
        gross.friction * exact.pressure(np.hypot(x, gross.y[gross.row])) / unit,
        color="0.6",
        linewidth=1.2,
        label=r"$\mu p$, exact",
    )
    for index, case in enumerate(cases):
        profile(axes, case, case.shear / unit, color=tint(index, len(cases)), label="{:g}".format(case["load_mz"]))
    profile_points(axes, gross, gross.shear / unit, "0.25", "{:.2f}, gross slip".format(gross["load_mz"]))
    legend(axes, "$M_z$, N m", loc="center right")
    limits = (-1.3, 1.9), (-0.02 * height, 1.06 * height)
    frame(axes, "Torque: shear along $y = 0$", "$x/c$", label, *limits)
    titles = ["$M_z$ = {:g} N m".format(case["load_mz"]) for case in shown[:-1]] + ["gross slip"]
    draw_maps(panels, shown, lambda case: case.shear / unit, titles, height, label, (-1.3, 1.3))
    finish(figure, directory, "torsion.png", gross, (unit, r"$\mu E^*c/2R$"), "white: stick zone, dotted: flat base")


def figure_stress(directory, cases, stresses):
    """Von Mises stress under T_x with M_y over depth, and s_xx along the surface, over p0 = E* c/2R."""
    figure, axes = plt.subplots(1, 2, figsize=(12.0, 4.2), constrained_layout=True)
    unit, c, last = cases[0].pressure_unit, cases[0].c, stresses[-1]
    mises = last.field("mises")[:, 0] / unit
    top = 1.02 * np.max(mises)
    panel = axes[0]
    panel.grid(False)
    image = panel.contourf(last.x / c, last.z / c, mises, levels=np.linspace(0.0, top, 41), cmap="viridis")
    lines = panel.contour(
        last.x / c, last.z / c, mises, levels=np.linspace(0.0, top, 11), colors="0.15", linewidths=0.5
    )
    panel.clabel(lines, fmt="%.2f", fontsize=7)
    figure.colorbar(image, ax=panel, label=r"$\sigma_M\,2R/(E^*c)$", format="%.3f")
    frame(panel, rf"von Mises, $T_x/(\mu N) = {cases[-1].load_ratio:g}$", "$x/c$", "$z/c$", (-1.3, 1.3), (1.2, 0.0))
    for case, one in zip(cases, stresses):
        values = one.field("stress_xx")[0, 0] / unit
        axes[1].plot(one.x / c, values, color=ratio_tint(case), linewidth=1.4, label=f"{case.load_ratio:g}")
    legend(axes[1], r"$T_x/(\mu N)$", loc="lower center")
    frame(axes[1], "stress along the surface, $y = 0$", "$x/c$", r"$\sigma_{xx}\,2R/(E^*c)$", (-1.3, 1.3))
    save(figure, directory, "stress.png")


# ---------------------------------------------------------------- program


class Comparison:
    """All results of a directory."""

    def __init__(self, directory):
        def load(form, levels):
            return [Case(directory, form.format(level)) for level in levels]

        normal, self.gross = Case(directory, "normal"), Case(directory, "torsion_gross")
        self.tilts, self.torsion = load("tilt_my{}", MOMENTS), load("torsion_mz{}", TORQUES)
        self.tangential = load("tangential_nu0.3_t{}", RATIOS)
        self.exact_cases, self.less = load("tangential_nu0_t{}", RATIOS_EXACT), load("less_t{}", RATIOS_EXACT)
        self.exact = Exact(normal)
        self.stresses = [petsam.open(os.path.join(directory, f"stress_t{ratio}.h5")) for ratio in RATIOS_STRESS]
        self.numbers = {
            "normal": normal_numbers(normal, self.gross, self.exact),
            "tilt": [tilt_numbers(case) for case in self.tilts],
            "tangential": [tangential_numbers(case) for case in self.tangential],
            "jaeger": [jaeger_numbers(case, other) for case, other in zip(self.exact_cases, self.less)],
            "torsion": [torsion_numbers(case, self.exact) for case in [*self.torsion, self.gross]],
        }

    def tables(self):
        """The five tables."""
        normal = self.numbers["normal"]
        yield "cells: {} x {}".format(*normal["grid"])
        yield (
            "Normal load against the exact solution",
            (
                "p, L2 = pressure_l2:.2e; a exact, mm = a_mm:.4f; a = radius_error:+.2e; "
                "approach = approach_error:+.2e; limit, N m = torque_limit_exact:.3f; "
                "limit of M_z = torque_limit_error:+.2e"
            ),
            [{**normal, "a_mm": 1e3 * normal["radius_exact"]}],
        )
        yield (
            "Tilting moment (lengths over c, area over pi c^2)",
            (
                "M_y, N m = load_my:g; tilt, rad = rot_y:.4e; x from = left:+.3f; x to = right:+.3f; y to = top:.3f; "
                "area = area:.3f; max p 2R/E*c = pressure:.4f; max p, MPa = pressure_mpa:.0f"
            ),
            self.numbers["tilt"],
        )
        yield (
            "Tangential force with M_y = 5e3 N m",
            (
                "nu = poisson:g; T/(mu N) = load_ratio:.3g; d_x, m = disp_x:.4e; stick share = stick:.4f; "
                "max q 2R/... = shear:.4f; max q_y/q_x = shear_y_over_shear_x:.1e"
            ),
            self.numbers["tangential"],
        )
        yield (
            "Tangential force against Jaeger's principle, nu = 0",
            (
                "T/(mu N) = load_ratio:.3g; q_x, L2 = shear_l2:.1e; d_x = displacement:+.1e; "
                "stick cells = stick_cells:d; that differ = stick_cells_that_differ:d"
            ),
            self.numbers["jaeger"],
        )
        yield (
            "Torque (last: gross slip)",
            (
                "M_z, N m = load_mz:.3f; M/M_lim = torque_ratio:.5f; twist, rad = rot_z:.4e; "
                "stick rad./a = stick_radius:.4f; max q 2R/... = shear:.4f"
            ),
            self.numbers["torsion"],
        )

    def draw(self, directory):
        """The four pictures."""
        figure_pressure(directory, self.tilts, self.exact)
        figure_tangential(directory, self.tangential, self.exact_cases, self.less)
        figure_torsion(directory, self.torsion, self.gross, self.exact)
        loaded = [self.tangential[RATIOS.index(ratio)] for ratio in RATIOS_STRESS]
        figure_stress(directory, loaded, self.stresses)


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "punch"))
