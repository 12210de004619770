"""Compare CalculiX and petsam with closed-form solutions and each other; draw comparison.png and half-space.png.

Reads the HDF5 files that examples/fe-comparison/run.sh writes to a directory. All comparisons are at equal force: Hertz
and Cattaneo-Mindlin for the force that came out of CalculiX.

  p, L2, q, L2  sqrt(sum A (numerical - exact)^2 / sum A exact^2) over all nodes or cells, A their area. Exact is for
                CalculiX, whose pressure is a nodal force over a node's area, the mean over that area; for petsam the
                value at the cell's centre
  CPRESS        the same for the nodal pressure in CalculiX's own result file, which is extrapolated
  peak          maximum pressure relative to Hertz's, minus 1
  radius        radius of contact less Hertz's, in elements under the contact, or in cells
"""

import glob
import os
import re
import sys
from pathlib import Path

import h5py
import numpy as np

import petsam
from petsam.closed import cattaneo_shear, cattaneo_stick_radius, hertz_pressure
from petsam.plot.style import COLORS, frame, joined, logarithmic, plt, points, save

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402
from comparison import relative_l2  # noqa: E402

LAWS = ("small", "large", "neo")
COLOUR_PETSAM, COLOUR_FE, COLOUR_NEO, COLOUR_LARGE = COLORS[:4]


# ---------------------------------------------------------------- reading


class Mesh:
    """A CalculiX result: attributes of the file as items, datasets as attributes."""

    def __init__(self, directory, name):
        path = os.path.join(directory, name + ".h5")
        if not os.path.isfile(path):
            raise petsam.Missing(f"{path}: no such file")
        try:
            with h5py.File(path, "r") as file:
                self.numbers = dict(file.attrs)
                for field in ("x", "y", "area", "pressure", "shear_x", "cpress", "hertz_pressure", "cattaneo"):
                    setattr(self, field, file[field][()])
        except (OSError, KeyError) as error:
            raise petsam.Error(f"{path}: cannot be read: {error}") from error
        self.r = np.hypot(self.x, self.y)

    def __getitem__(self, name):
        return self.numbers[name]

    def l2(self, field, exact):
        """Relative L2 error over the nodes."""
        weight = np.sqrt(self.area)
        return relative_l2(weight * getattr(self, field), weight * getattr(self, exact))

    def table_row(self):
        """The table's numbers."""
        hertz, size = self["hertz_radius"], self["element_size"]
        return {
            "n": int(self["n"]),
            "elements": int(self["elements"]),
            "nodes": int(self["nodes"]),
            "size": size / hertz,
            "cpu": self["cpu"],
            "wall": self["wall"],
            "memory": 1e-6 * self["memory"],
            "iterations": int(self["iterations"]),
            "pressure_l2": self.l2("pressure", "hertz_pressure"),
            "peak": np.max(self.pressure) / self["hertz_peak"] - 1.0,
            "cpress_l2": self.l2("cpress", "hertz_pressure"),
            "cpress_peak": np.max(self.cpress) / self["hertz_peak"] - 1.0,
            "radius": (self["contact_radius"] - hertz) / size,
            "radius_ratio": self["contact_radius"] / hertz,
            "load": self["load_n"],
            "approach": self["approach"] / self["hertz_approach"],
            "solver": self["solver"],
            "stiffness": self["stiffness"],
            "ratio": hertz / self["sphere_radius"],
        }


class Grid(petsam.Snapshot):
    """A petsam result, with Hertz's radius and peak pressure for the same load from the CalculiX result beside it."""

    def __init__(self, directory, name, mesh):
        super().__init__(petsam.open(os.path.join(directory, name + ".h5")))
        self.hertz_radius, self.hertz_peak = mesh["hertz_radius"], mesh["hertz_peak"]

    def table_row(self):
        """The table's numbers."""
        a, radius = self.hertz_radius, self.radius("contact_area")
        return {
            "cells": self.x.size,
            "size": self.dx / a,
            "cpu": self.parameters["cpu"],
            "wall": self.parameters["wall"],
            "memory": 1e-6 * self.parameters["memory"],
            "pressure_l2": relative_l2(self["pressure"], hertz_pressure(self.r, a, self.hertz_peak)),
            "peak": np.max(self["pressure"]) / self.hertz_peak - 1.0,
            "radius": (radius - a) / self.dx,
            "radius_ratio": radius / a,
        }


def found(directory, form):
    """Names of result files of a form, N in it a number, in the order of those."""
    names = [os.path.basename(path)[:-3] for path in glob.glob(os.path.join(directory, "*.h5"))]
    names = [name for name in names if re.fullmatch(form.replace("N", "[0-9.]+"), name)]
    if not names:
        raise petsam.Missing(f"{directory}: no {form}.h5")
    return sorted(names, key=lambda name: float(re.findall(r"[0-9.]+", name)[-1]))


# ---------------------------------------------------------------- numbers


def pick(row):
    """What both programs' rows share."""
    return {key: row[key] for key in ("cpu", "memory", "pressure_l2")}


def equal_error(meshes, grids):
    """For each mesh the coarsest of petsam's grids that is as accurate (the finest, if none is)."""
    rows = []
    for mesh in meshes:
        good = [grid for grid in grids if grid["pressure_l2"] <= mesh["pressure_l2"]]
        grid = min(good, key=lambda g: g["cells"]) if good else grids[-1]
        rows.append(
            {
                "elements": mesh["elements"],
                "mesh_l2": mesh["pressure_l2"],
                "mesh_cpu": mesh["cpu"],
                "mesh_memory": mesh["memory"],
                "cells": grid["cells"],
                "grid_l2": grid["pressure_l2"],
                "grid_cpu": grid["cpu"],
                "grid_memory": grid["memory"],
                "times": mesh["cpu"] / grid["cpu"],
            }
        )
    return rows


def ratio_row(cases):
    """Peak pressure and contact radius over Hertz's, each at its own force, of one contact."""
    row = {}
    for name, case in cases.items():
        numbers = case.table_row()
        row.update({name + "_peak": 1.0 + numbers["peak"], name + "_radius": numbers["radius_ratio"]})
        if name in LAWS:  # Hertz: force as approach^1.5
            row[name + "_ratio"] = numbers["ratio"]
            row[name + "_force"] = (case["hertz_approach"] / case["approach"]) ** 1.5
    row["petsam_ratio"] = row["small_ratio"]
    row["petsam_force"] = (cases["small"]["hertz_approach"] / cases["petsam"]["disp_z"]) ** 1.5
    return row


# ---------------------------------------------------------------- drawing


def draw_pressure(axes, mesh, grid):
    """p/p0 over r/a: Hertz, petsam's row nearest y = 0, the finest mesh's nodes."""
    r = np.concatenate([np.sin(0.5 * np.pi * np.linspace(0.0, 1.0, 400)), [1.3]])
    axes.plot(r, hertz_pressure(r, 1.0, 1.0), color="0.25", linewidth=1.2, label="Hertz")
    a, peak = mesh["hertz_radius"], mesh["hertz_peak"]
    points(axes, mesh.r / a, mesh.cpress / peak, "0.7", "x", markersize=4, zorder=1, label="CalculiX, CPRESS")
    points(
        axes,
        mesh.r / a,
        mesh.pressure / peak,
        COLOUR_FE,
        "s",
        markersize=3.2,
        zorder=2,
        label="CalculiX, {} elements".format(int(mesh["elements"])),
    )
    keep = np.flatnonzero(grid.x > 0.0)[:: max(1, grid.x.size // 64)]
    points(
        axes,
        grid.x[keep] / a,
        grid["pressure"][grid.row, keep] / peak,
        COLOUR_PETSAM,
        label=f"petsam, {grid.x.size} x {grid.x.size} cells",
    )
    frame(axes, "Pressure", "$r/a$", "$p/p_0$", (0.0, 1.3), (-0.03, 1.08))
    axes.legend(loc="lower left")


def draw_shear(axes, results):
    """q_x/(mu p0) along y = 0."""
    mesh, grid, unit = results.tangential, results.sheared, results.mu_p0
    a = mesh["hertz_radius"]
    x = np.linspace(-1.3, 1.3, 1301) * a
    axes.plot(x / a, results.cattaneo(np.abs(x)) / unit, color="0.25", linewidth=1.2, label="Cattaneo-Mindlin")
    keep = np.arange(grid.x.size // 128, grid.x.size, max(1, grid.x.size // 64))
    points(axes, grid.x[keep] / a, grid["shear_x"][grid.row, keep] / unit, COLOUR_PETSAM, label="petsam")
    line = np.abs(mesh.y) < 1e-9 * a
    points(
        axes, mesh.x[line] / a, mesh.shear_x[line] / unit, COLOUR_FE, "s", markersize=4.2, zorder=4, label="CalculiX"
    )
    title = rf"Shear at $T_x/(\mu N) = {results.level:.3f}$"
    frame(axes, title, "$x/a$", r"$q_x/(\mu p_0)$", (-1.3, 1.3), (-0.03, 1.0))
    axes.legend(loc="lower center")


def draw_cost(axes, numbers):
    """Error over CPU time of both sequences, memory written at the points."""
    for key, colour, marker, label in (
        ("meshes", COLOUR_FE, "s-", "CalculiX"),
        ("grids", COLOUR_PETSAM, "o-", "petsam"),
    ):
        rows = numbers[key]
        places = [(row["cpu"], row["pressure_l2"]) for row in rows]
        joined(axes, *zip(*places), colour, marker, linewidth=1.2, label=label)
        near = {"xytext": (5, 4), "textcoords": "offset points", "fontsize": 7.5, "color": colour}
        for row, place in zip(rows, places):
            axes.annotate(f"{row['memory']:.0f} MB", place, **near)
    frame(axes, "Cost of the pressure on one core", "CPU time, s", "relative L2 error of the pressure")
    logarithmic(axes, "xy")
    axes.margins(x=0.16, y=0.08)
    axes.legend(loc="upper right")


def draw_ratio(axes, rows, key, label):
    """A quantity over Hertz's for growing a/R; grey: within 3 per cent."""
    axes.axhspan(0.97, 1.03, color="0.93", zorder=0, linewidth=0.0, label="within 3 %")
    for name, style, colour, legend in (
        ("petsam", "o-", COLOUR_PETSAM, "petsam"),
        ("small", "s--", COLOUR_FE, "FE, small displacements"),
        ("large", "D-", COLOUR_LARGE, "FE, large, St. Venant-Kirchhoff"),
        ("neo", "^-", COLOUR_NEO, "FE, large, neo-Hooke"),
    ):
        x, y = ([row[f"{name}_{quantity}"] for row in rows] for quantity in ("ratio", key))
        joined(axes, x, y, colour, style, linewidth=1.2, label=legend)
    axes.set(
        xlabel="contact radius / radius of the sphere, $a/R$",
        ylabel="relative to Hertz",
        xlim=(0.0, 0.22),
        xticks=(0.0, 0.05, 0.1, 0.15, 0.2),
    )
    axes.set_title(label, fontsize=10)


# ---------------------------------------------------------------- program


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
        mesh = self.tangential = Mesh(directory, "tangential")
        self.sheared = Grid(directory, "petsam_tangential", mesh)
        self.mu_p0 = mesh["friction"] * mesh["hertz_peak"]
        self.level = mesh["load_tx"] / (mesh["friction"] * mesh["load_n"])
        self.stick = cattaneo_stick_radius(self.level, mesh["hertz_radius"])
        self.numbers = self._numbers()

    def cattaneo(self, r):
        """q_x, Pa, of Cattaneo and Mindlin at r (m)."""
        return cattaneo_shear(r, self.tangential["hertz_radius"], self.stick, self.mu_p0)

    def _numbers(self):
        """All tables."""
        meshes, grids = [case.table_row() for case in self.meshes], [case.table_row() for case in self.grids]
        middle = self.ratios[0]["small"].table_row()
        stiffness = sorted([case.table_row() for case in self.stiffness] + [middle], key=lambda row: row["stiffness"])
        for row in stiffness:
            row["factor"] = row["stiffness"] / middle["stiffness"]
        exact = self.cattaneo(self.sheared.r)
        return {
            "meshes": meshes,
            "direct": [case.table_row() for case in self.direct],
            "grids": grids,
            "equal_error": equal_error(meshes, grids),
            "stiffness": stiffness,
            "ratios": [ratio_row(cases) for cases in self.ratios],
            "tangential": [
                {
                    "program": "CalculiX",
                    "level": self.level,
                    "load": self.tangential["load_n"],
                    **pick(self.tangential.table_row()),
                    "shear_l2": self.tangential.l2("shear_x", "cattaneo"),
                    "shear_peak": np.max(self.tangential.shear_x) / np.max(self.tangential.cattaneo) - 1.0,
                },
                {
                    "program": "petsam",
                    "level": self.level,
                    "load": self.sheared["load_n"],
                    **pick(self.sheared.table_row()),
                    "shear_l2": relative_l2(self.sheared["shear_x"], exact),
                    "shear_peak": np.max(self.sheared["shear_x"]) / np.max(exact) - 1.0,
                },
            ],
        }

    def tables(self):
        """The tables."""
        numbers = self.numbers
        cost = "CPU, s = cpu:.1f; wall, s = wall:.1f; memory, MB = memory:.0f"
        errors = "p, L2 = pressure_l2:.2e; peak = peak:+.2%; radius = radius:+.2f"
        newton = f"iterations = iterations; {errors}; CPRESS, L2 = cpress_l2:.2e; CPRESS, peak = cpress_peak:+.2%"
        mesh = f"elements = elements; nodes = nodes; size/a = size:.3f; {cost}; {newton}"
        yield "a/R = {ratio:.4f}, N = {load:.2f} N".format(**numbers["meshes"][-1])
        yield "CalculiX, a quarter of one sphere, iterative solver", mesh, numbers["meshes"]
        yield "CalculiX, direct solver", mesh, numbers["direct"]
        yield (
            "petsam, both spheres whole",
            f"cells a side = cells; size/a = size:.4f; {cost}; {errors}",
            numbers["grids"],
        )
        yield (
            "At equal error",
            "elements = elements; p, L2 = mesh_l2:.1e; CPU, s = mesh_cpu:.1f; memory, MB = mesh_memory:.0f; "
            "petsam cells = cells; its p, L2 = grid_l2:.1e; its CPU, s = grid_cpu:.2f; its MB = grid_memory:.0f; "
            "times CPU = times:.0f",
            numbers["equal_error"],
        )
        yield (
            "CalculiX, contact stiffness",
            f"times default = factor:g; CPU, s = cpu:.1f; {newton}",
            numbers["stiffness"],
        )
        for quantity, key, true in (
            ("peak pressure over Hertz's at the same force", "peak", "true sphere = petsam_true_peak:.4f; "),
            ("contact radius over Hertz's at the same force", "radius", "true sphere = petsam_true_radius:.4f; "),
            ("force over Hertz's at the same approach", "force", ""),
        ):
            laws = f"FE, small = small_{key}:.4f; FE, St.V.-K. = large_{key}:.4f; FE, neo-H. = neo_{key}:.4f"
            columns = f"a/R = small_ratio:.4f; petsam = petsam_{key}:.4f; {true}{laws}"
            yield "Growing contact: " + quantity, columns, numbers["ratios"]
        yield (
            "With friction, both spheres: shear against Cattaneo-Mindlin",
            "program = program; N = load:.2f; T/(mu N) = level:.4f; CPU, s = cpu:.1f; memory, MB = memory:.0f; "
            "p, L2 = pressure_l2:.2e; q, L2 = shear_l2:.2e; peak q = shear_peak:+.2%",
            numbers["tangential"],
        )

    def draw(self, directory):
        """Both pictures."""
        picture, axes = plt.subplots(1, 3, figsize=(13.5, 4.2), constrained_layout=True)
        draw_pressure(axes[0], self.meshes[-1], self.grids[-1])
        draw_shear(axes[1], self)
        draw_cost(axes[2], self.numbers)
        save(picture, directory, "comparison.png")
        picture, axes = plt.subplots(1, 3, figsize=(12.0, 4.0), constrained_layout=True)
        draw_ratio(axes[0], self.numbers["ratios"], "peak", "Peak pressure at the same force")
        draw_ratio(axes[1], self.numbers["ratios"], "radius", "Contact radius at the same force")
        draw_ratio(axes[2], self.numbers["ratios"], "force", "Force at the same approach")
        axes[0].legend(loc="lower left", borderpad=0.0, labelspacing=0.3)
        axes[0].set_ylim(bottom=0.82)
        save(picture, directory, "half-space.png")


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "fe-comparison"))
