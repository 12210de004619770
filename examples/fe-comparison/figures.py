#!/usr/bin/env python3
"""Compare CalculiX and petsam with the closed solutions and with each other; draw comparison.png and half-space.png.

Reads the HDF5 files that examples/fe-comparison/run.sh writes to a directory. All comparisons are at equal force: Hertz
and Cattaneo-Mindlin for the force that came out of CalculiX.

  p, L2, q, L2  sqrt(sum A (numerical - exact)^2 / sum A exact^2) over all nodes or cells, A their area. Exact is the mean
                over a node's area for CalculiX, whose pressure is a nodal force over that area; the value at the
                cell's centre for petsam
  CPRESS        the same for the nodal pressure in CalculiX's own result file, which is extrapolated
  peak          greatest pressure over Hertz's, less 1
  radius        radius of contact less Hertz's, in elements under the contact, or in cells
"""
import glob
import os
import re
import sys

import h5py
import numpy as np

import analytic
from figures import STYLE, InputError, finish_numbers, main, plt, print_table, relative_l2, save

LAWS = ("small", "large", "neo")
COLOUR_FE, COLOUR_PETSAM, COLOUR_LARGE, COLOUR_NEO = "#c0392b", "#1f5fa8", "#e08e0b", "#6a8f3c"


# ---------------------------------------------------------------- reading

class Case:
    """One result file: attributes as items, datasets (the last step of petsam's) as attributes."""

    def __init__(self, directory, name, fields):
        path = os.path.join(directory, name + ".h5")
        if not os.path.isfile(path):
            raise InputError("{}: no such file; run examples/fe-comparison/run.sh first".format(path))
        try:
            with h5py.File(path, "r") as file:
                self.numbers = dict(file.attrs)
                for field in fields:
                    setattr(self, field, file[field][()])
                if "history" in file:
                    self.numbers.update({key: data[-1] for key, data in file["history"].items()})
        except (OSError, KeyError) as error:
            raise InputError("{}: cannot be read: {}".format(path, error)) from error

    def __getitem__(self, name):
        return self.numbers[name]


class Mesh(Case):
    """A CalculiX result."""

    def __init__(self, directory, name):
        super().__init__(directory, name, ("x", "y", "area", "pressure", "shear_x", "cpress", "hertz_pressure", "cattaneo"))
        self.r = np.hypot(self.x, self.y)

    def l2(self, field, exact):
        """Relative L2 error over the nodes."""
        weight = np.sqrt(self.area)
        return relative_l2(weight * getattr(self, field), weight * getattr(self, exact))

    def row(self):
        """The table's numbers."""
        hertz, size = self["hertz_radius"], self["element_size"]
        return {
            "n": int(self["n"]), "elements": int(self["elements"]), "nodes": int(self["nodes"]),
            "size": size / hertz, "cpu": self["cpu"], "wall": self["wall"], "memory": 1e-6 * self["memory"],
            "iterations": int(self["iterations"]), "pressure_l2": self.l2("pressure", "hertz_pressure"),
            "peak": np.max(self.pressure) / self["hertz_peak"] - 1.0, "cpress_l2": self.l2("cpress", "hertz_pressure"),
            "cpress_peak": np.max(self.cpress) / self["hertz_peak"] - 1.0,
            "radius": (self["contact_radius"] - hertz) / size, "radius_ratio": self["contact_radius"] / hertz,
            "load": self["load_n"], "approach": self["approach"] / self["hertz_approach"], "solver": self["solver"],
            "stiffness": self["stiffness"], "ratio": hertz / self["sphere_radius"]}


class Grid(Case):
    """A petsam result with the closed solutions for the same load, taken from the CalculiX result beside it."""

    def __init__(self, directory, name, mesh):
        super().__init__(directory, name, ("x", "y", "pressure", "shear_x"))
        self.pressure, self.shear_x = self.pressure[-1], self.shear_x[-1]
        self.r = np.hypot(self.x[None, :], self.y[:, None])
        self.radius, self.peak = mesh["hertz_radius"], mesh["hertz_peak"]
        self.middle = int(np.argmin(np.abs(self.y)))

    def row(self):
        """The table's numbers."""
        cell = self.x[1] - self.x[0]
        radius = np.sqrt(self["contact_area"] / np.pi)
        return {
            "cells": self.x.size, "size": cell / self.radius, "cpu": self["cpu"], "wall": self["wall"],
            "memory": 1e-6 * self["memory"],
            "pressure_l2": relative_l2(self.pressure, analytic.hertz_pressure(self.r, self.radius, self.peak)),
            "peak": np.max(self.pressure) / self.peak - 1.0, "radius": (radius - self.radius) / cell,
            "radius_ratio": radius / self.radius}


def found(directory, form):
    """Names of result files of a form, N in it a number, in the order of those."""
    names = [os.path.basename(path)[:-3] for path in glob.glob(os.path.join(directory, "*.h5"))]
    names = [name for name in names if re.fullmatch(form.replace("N", "[0-9.]+"), name)]
    if not names:
        raise InputError("{}: no {}.h5; run examples/fe-comparison/run.sh first".format(directory, form))
    return sorted(names, key=lambda name: float(re.findall(r"[0-9.]+", name)[-1]))


# ---------------------------------------------------------------- numbers

class Comparison:
    """All results of a directory."""

    def __init__(self, directory):
        self.meshes = [Mesh(directory, name) for name in found(directory, "mesh_N")]
        self.direct = [Mesh(directory, name) for name in found(directory, "mesh_N_direct")]
        self.grids = [Grid(directory, name, self.meshes[-1]) for name in found(directory, "petsam_grid_N")]
        self.stiffness = [Mesh(directory, name) for name in found(directory, "stiffness_N")]
        self.ratios = []
        for name in found(directory, "small_N"):
            case = {law: Mesh(directory, name.replace("small", law)) for law in LAWS}
            for grid in ("petsam", "petsam_true"):
                case[grid] = Grid(directory, grid + "_" + name, case["small"])
            self.ratios.append(case)
        self.tangential = Mesh(directory, "tangential")
        self.sheared = Grid(directory, "petsam_tangential", self.tangential)
        mu_p0 = self.tangential["friction"] * self.tangential["hertz_peak"]
        self.level = self.tangential["load_tx"] / (self.tangential["friction"] * self.tangential["load_n"])
        stick = analytic.cattaneo_stick_radius(self.level, self.tangential["hertz_radius"])
        self.mu_p0, self.stick = mu_p0, stick

    def cattaneo(self, r):
        """q_x, Pa, of Cattaneo and Mindlin at r (m)."""
        return analytic.cattaneo_shear(r, self.tangential["hertz_radius"], self.stick, self.mu_p0)

    def numbers(self):
        """All tables."""
        meshes, grids = [case.row() for case in self.meshes], [case.row() for case in self.grids]
        middle = self.ratios[0]["small"].row()
        stiffness = sorted([case.row() for case in self.stiffness] + [middle], key=lambda row: row["stiffness"])
        for row in stiffness:
            row["factor"] = row["stiffness"] / middle["stiffness"]
        sheared = relative_l2(self.sheared.shear_x, self.cattaneo(self.sheared.r))
        return {
            "meshes": meshes, "direct": [case.row() for case in self.direct], "grids": grids,
            "equal_error": equal_error(meshes, grids), "stiffness": stiffness,
            "ratios": [ratio_row(cases) for cases in self.ratios],
            "tangential": [
                {"program": "CalculiX", "level": self.level, "load": self.tangential["load_n"],
                 **pick(self.tangential.row()), "shear_l2": self.tangential.l2("shear_x", "cattaneo"),
                 "shear_peak": np.max(self.tangential.shear_x) / np.max(self.tangential.cattaneo) - 1.0},
                {"program": "petsam", "level": self.level, "load": self.sheared["load_n"], **pick(self.sheared.row()),
                 "shear_l2": sheared,
                 "shear_peak": np.max(self.sheared.shear_x) / np.max(self.cattaneo(self.sheared.r)) - 1.0}]}


def pick(row):
    """What both programs' rows share."""
    return {key: row[key] for key in ("cpu", "memory", "pressure_l2")}


def equal_error(meshes, grids):
    """For each mesh the coarsest of petsam's grids that is as accurate (the finest, if none is)."""
    rows = []
    for mesh in meshes:
        good = [grid for grid in grids if grid["pressure_l2"] <= mesh["pressure_l2"]]
        grid = min(good, key=lambda g: g["cells"]) if good else grids[-1]
        rows.append({
            "elements": mesh["elements"], "mesh_l2": mesh["pressure_l2"], "mesh_cpu": mesh["cpu"],
            "mesh_memory": mesh["memory"], "cells": grid["cells"], "grid_l2": grid["pressure_l2"], "grid_cpu": grid["cpu"],
            "grid_memory": grid["memory"], "times": mesh["cpu"] / grid["cpu"]})
    return rows


def ratio_row(cases):
    """Peak pressure and contact radius over Hertz's, each at its own force, of one contact."""
    row = {}
    for name, case in cases.items():
        numbers = case.row()
        row.update({name + "_peak": 1.0 + numbers["peak"], name + "_radius": numbers["radius_ratio"]})
        if name in LAWS:  # Hertz: force as approach^1.5
            row[name + "_ratio"] = numbers["ratio"]
            row[name + "_force"] = (case["hertz_approach"] / case["approach"])**1.5
    row["petsam_ratio"] = row["small_ratio"]
    row["petsam_force"] = (cases["small"]["hertz_approach"] / cases["petsam"]["disp_z"])**1.5
    return row


def print_numbers(numbers):
    """Print the tables."""
    cost = {"CPU, s": ("cpu", "{:.1f}"), "wall, s": ("wall", "{:.1f}"), "memory, MB": ("memory", "{:.0f}")}
    errors = {"p, L2": ("pressure_l2", "{:.2e}"), "peak": ("peak", "{:+.2%}"), "radius": ("radius", "{:+.2f}")}
    own = {"CPRESS, L2": ("cpress_l2", "{:.2e}"), "CPRESS, peak": ("cpress_peak", "{:+.2%}")}
    mesh = {"elements": ("elements", "{}"), "nodes": ("nodes", "{}"), "size/a": ("size", "{:.3f}")}
    newton = {"iterations": ("iterations", "{}")}
    print("a/R = {:.4f}, N = {:.2f} N".format(numbers["meshes"][-1]["ratio"], numbers["meshes"][-1]["load"]))
    print_table("CalculiX, a quarter of one sphere, iterative solver", {**mesh, **cost, **newton, **errors, **own},
                numbers["meshes"])
    print_table("CalculiX, direct solver", {**mesh, **cost, **newton, **errors, **own}, numbers["direct"])
    print_table("petsam, both spheres whole", {
        "cells a side": ("cells", "{}"), "size/a": ("size", "{:.4f}"), **cost, **errors}, numbers["grids"])
    print_table("At equal error", {
        "elements": ("elements", "{}"), "p, L2": ("mesh_l2", "{:.1e}"), "CPU, s": ("mesh_cpu", "{:.1f}"),
        "memory, MB": ("mesh_memory", "{:.0f}"), "petsam cells": ("cells", "{}"), "its p, L2": ("grid_l2", "{:.1e}"),
        "its CPU, s": ("grid_cpu", "{:.2f}"), "its MB": ("grid_memory", "{:.0f}"), "times CPU": ("times", "{:.0f}")},
        numbers["equal_error"])
    print_table("CalculiX, contact stiffness", {
        "times default": ("factor", "{:g}"), "CPU, s": ("cpu", "{:.1f}"), **newton, **errors, **own}, numbers["stiffness"])
    for quantity, key in (("peak pressure over Hertz's at the same force", "peak"),
                          ("contact radius over Hertz's at the same force", "radius"),
                          ("force over Hertz's at the same approach", "force")):
        columns = {"a/R": ("small_ratio", "{:.4f}"), "petsam": ("petsam_" + key, "{:.4f}")}
        if key != "force":
            columns["true sphere"] = ("petsam_true_" + key, "{:.4f}")
        columns.update({
            "FE, small": ("small_" + key, "{:.4f}"), "FE, St.V.-K.": ("large_" + key, "{:.4f}"),
            "FE, neo-H.": ("neo_" + key, "{:.4f}")})
        print_table("Growing contact: " + quantity, columns, numbers["ratios"])
    print_table("With friction, both spheres: shear against Cattaneo-Mindlin", {
        "program": ("program", "{}"), "N": ("load", "{:.2f}"), "T/(mu N)": ("level", "{:.4f}"), "CPU, s": ("cpu", "{:.1f}"),
        "memory, MB": ("memory", "{:.0f}"), "p, L2": ("pressure_l2", "{:.2e}"), "q, L2": ("shear_l2", "{:.2e}"),
        "peak q": ("shear_peak", "{:+.2%}")}, numbers["tangential"])


# ---------------------------------------------------------------- drawing

def draw_pressure(axes, mesh, grid):
    """p/p0 over r/a: Hertz, petsam's row nearest y = 0, the finest mesh's nodes."""
    r = np.concatenate([np.sin(0.5 * np.pi * np.linspace(0.0, 1.0, 400)), [1.3]])
    axes.plot(r, analytic.hertz_pressure(r, 1.0, 1.0), color="0.25", linewidth=1.2, label="Hertz")
    axes.plot(mesh.r / mesh["hertz_radius"], mesh.cpress / mesh["hertz_peak"], "x", color="0.7", markersize=4,
              label="CalculiX, CPRESS", zorder=1)
    axes.plot(mesh.r / mesh["hertz_radius"], mesh.pressure / mesh["hertz_peak"], "s", color=COLOUR_FE, markersize=3.2,
              markerfacecolor="white", label="CalculiX, {} elements".format(int(mesh["elements"])))
    keep = np.flatnonzero(grid.x > 0.0)[::max(1, grid.x.size // 64)]
    axes.plot(grid.x[keep] / grid.radius, grid.pressure[grid.middle, keep] / grid.peak, "o",
              color=COLOUR_PETSAM, markersize=3.6, markerfacecolor="white",
              label="petsam, {0} x {0} cells".format(grid.x.size), zorder=3)
    axes.set(title="Pressure", xlabel="$r/a$", ylabel="$p/p_0$", xlim=(0.0, 1.3), ylim=(-0.03, 1.08))
    axes.legend(loc="lower left")


def draw_shear(axes, comparison):
    """q_x/(mu p0) along y = 0."""
    mesh, grid = comparison.tangential, comparison.sheared
    a = mesh["hertz_radius"]
    x = np.linspace(-1.3, 1.3, 1301) * a
    axes.plot(x / a, comparison.cattaneo(np.abs(x)) / comparison.mu_p0, color="0.25", linewidth=1.2,
              label="Cattaneo-Mindlin")
    keep = np.arange(grid.x.size // 128, grid.x.size, max(1, grid.x.size // 64))
    axes.plot(grid.x[keep] / a, grid.shear_x[grid.middle, keep] / comparison.mu_p0, "o", color=COLOUR_PETSAM, markersize=3.6,
              markerfacecolor="white", label="petsam", zorder=3)
    line = np.abs(mesh.y) < 1e-9 * a
    axes.plot(mesh.x[line] / a, mesh.shear_x[line] / comparison.mu_p0, "s", color=COLOUR_FE, markersize=4.2,
              markerfacecolor="white", label="CalculiX", zorder=4)
    axes.set(title=r"Shear at $T_x = {:.3f}\,\mu N$".format(comparison.level), xlabel="$x/a$", ylabel=r"$q_x/(\mu p_0)$",
             xlim=(-1.3, 1.3), ylim=(-0.03, 1.0))
    axes.legend(loc="lower center")


def draw_cost(axes, numbers):
    """Error over CPU time of both sequences, memory written at the points."""
    for key, colour, marker, label in (("meshes", COLOUR_FE, "s", "CalculiX"), ("grids", COLOUR_PETSAM, "o", "petsam")):
        rows = numbers[key]
        axes.plot([row["cpu"] for row in rows], [row["pressure_l2"] for row in rows], marker + "-", color=colour,
                  markersize=5, linewidth=1.2, markerfacecolor="white", label=label)
        for row in rows:
            axes.annotate("{:.0f} MB".format(row["memory"]), (row["cpu"], row["pressure_l2"]), xytext=(5, 4),
                          textcoords="offset points", fontsize=7.5, color=colour)
    axes.set(title="Cost of the pressure on one core", xlabel="CPU time, s", ylabel="relative L2 error", xscale="log",
             yscale="log")
    axes.margins(x=0.16, y=0.08)
    axes.legend(loc="upper right")


def draw_ratio(axes, rows, key, label):
    """A quantity over Hertz's for growing a/R."""
    axes.axhspan(0.97, 1.03, color="0.93", zorder=0, linewidth=0.0)
    for name, style, colour, legend in (
            ("petsam", "o-", COLOUR_PETSAM, "petsam"),
            ("small", "s--", COLOUR_FE, "FE, small displacements"),
            ("large", "D-", COLOUR_LARGE, "FE, large, St. Venant-Kirchhoff"),
            ("neo", "^-", COLOUR_NEO, "FE, large, neo-Hooke")):
        axes.plot([row[name + "_ratio"] for row in rows], [row[name + "_" + key] for row in rows], style, color=colour,
                  markersize=5, linewidth=1.2, markerfacecolor="white", label=legend)
    axes.set(xlabel="$a/R$", xlim=(0.0, 0.22), xticks=(0.0, 0.05, 0.1, 0.15, 0.2))
    axes.set_title(label, fontsize=10)


def draw_all(directory, comparison, numbers):
    """Both pictures."""
    picture, axes = plt.subplots(1, 3, figsize=(13.5, 4.2), constrained_layout=True)
    draw_pressure(axes[0], comparison.meshes[-1], comparison.grids[-1])
    draw_shear(axes[1], comparison)
    draw_cost(axes[2], numbers)
    save(picture, directory, "comparison.png")
    picture, axes = plt.subplots(1, 3, figsize=(10.4, 3.5), constrained_layout=True)
    draw_ratio(axes[0], numbers["ratios"], "peak", "Peak pressure over Hertz's, same force")
    draw_ratio(axes[1], numbers["ratios"], "radius", "Contact radius over Hertz's, same force")
    draw_ratio(axes[2], numbers["ratios"], "force", "Force over Hertz's, same approach")
    axes[0].legend(loc="lower left", borderpad=0.0, labelspacing=0.3)
    axes[0].set_ylim(bottom=0.82)
    save(picture, directory, "half-space.png")


# ---------------------------------------------------------------- program

def run(options):
    """Read, print the numbers, draw."""
    comparison = Comparison(options.directory)
    numbers = comparison.numbers()
    print_numbers(numbers)
    figures = finish_numbers(options, numbers)
    with plt.rc_context(STYLE):
        draw_all(figures, comparison, numbers)


if __name__ == "__main__":
    sys.exit(main(run, __doc__, "fe-comparison"))
