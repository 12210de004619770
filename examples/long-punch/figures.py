"""Compare the middle section of long punches with the plane theory, and draw long-punch.png.

Reads the HDF5 files that examples/long-punch/run.sh writes to a directory: results and separations. The section is
the mean of the two rows beside y = 0. Load P', moment M' and shear Q' per length are summed over it, not taken from
the whole punch, whose ends carry more than their share; the plane solution gets these three, and E*, c and R.

Errors, all over the section:
  L2      sqrt(sum (numerical - reference)^2 / sum reference^2)
  grid    the reference is the closed plane solution at the cell centres: ends and grid
  ends    the reference is the plane problem on strips of the same width: the ends alone
  2a, 2b  number of cells in contact (that stick), minus exact width over width of a cell; contact and stick: minus the
          number of strips
  tilt    rot_y of the punch over the tilt of the strips, less 1
"""

import os
import sys
from pathlib import Path

import h5py
import numpy as np
from matplotlib.ticker import NullLocator

import petsam
from petsam.closed import Bodies, plane
from petsam.closed.punch import Punch
from petsam.plot.style import COLORS, frame, joined, logarithmic, note, plt, points, save, tint
from petsam.results import STICK

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402
from comparison import relative_l2  # noqa: E402

RATIOS = ("2.5", "5", "10", "20", "40")
VARIANTS = ("fine_r10", "sharp_r10", "nu0_r10")
STUDIES = ("upright", "inclined")
DRAWN = "10"
COLOUR_P, COLOUR_Q = COLORS[:2]


def read_shape(path):
    """The attributes of gap.py's dataset: half width and length of the flat base, radius of the edges, m."""
    if not os.path.exists(path):
        raise petsam.Missing(f"{path}: no such file")
    try:
        with h5py.File(path, "r") as file:
            return {name: float(value) for name, value in file["height"].attrs.items() if name != "units"}
    except (OSError, KeyError, ValueError) as error:
        raise petsam.Error(f"{path}: cannot be read: {error}") from error


class Section:
    """The middle section of one result, with the plane solutions for its loads per length (SI units)."""

    def __init__(self, directory, study, name):
        with petsam.open(os.path.join(directory, f"{study}_{name}.h5")) as results:
            self._read(petsam.Snapshot(results))
        shape = read_shape(os.path.join(directory, f"gap_{name}.h5"))
        self.punch = Punch(shape["flat_half_width"], shape["edge_radius"], self.bodies.e_star)
        self.half_length = shape["flat_half_length"]
        self.load, self.shear_load = (self.width * np.sum(z) for z in (self.p, self.q))
        self.moment = self.width * np.sum(self.x * self.p) if self.eccentric else 0.0
        self.contact = plane.contact_under_moment(self.punch, self.load, self.moment)
        self.stick_zone = plane.stick_zone(self.punch, self.contact, self.shear_load, self.friction)
        self.strips = plane.PlaneCells(self.punch, self.x).partial_slip(
            self.load, self.moment, self.shear_load, self.friction
        )

    def _read(self, step):
        self.bodies, self.friction = Bodies.of(step.parameters), step.results.friction(step.index)
        self.x, self.y, self.width = step.x, step.y, step.x[1] - step.x[0]
        if self.y.size % 2:
            raise petsam.Error(f"{step.results.path}: needs an even number of rows")
        middle = slice(self.y.size // 2 - 1, self.y.size // 2 + 1)
        self.p, self.q, self.q_y = (np.mean(step[name][middle], axis=0) for name in ("pressure", "shear_x", "shear_y"))
        self.stick = step["state"][middle.start] == STICK
        self.load_along = self.width * np.sum(step["pressure"], axis=1)
        self.tilt, self.eccentric = step["rot_y"], abs(step["load_my"]) > 1e-9

    @property
    def ratio(self):
        """L/c."""
        return self.half_length / self.punch.c

    def pressure(self, x):
        """The plane solution's p, Pa, at x (m)."""
        return plane.plane_pressure(x, self.punch, self.contact)

    def shear(self, x):
        """The plane solution's q, Pa, at x (m)."""
        return plane.plane_shear(x, self.punch, self.contact, self.stick_zone, self.friction)


# ---------------------------------------------------------------- numbers


def section_numbers(study, name, case):
    """Loads per length and errors of one section."""
    p, q, tilt, stick = case.strips
    return {
        "study": study,
        "case": name,
        "ratio": case.ratio,
        "load": case.load,
        "eccentricity": case.moment / case.load,
        "shear_ratio": case.shear_load / (case.friction * case.load),
        "pressure_l2": relative_l2(case.p, case.pressure(case.x)),
        "shear_l2": relative_l2(case.q, case.shear(case.x)),
        "half_width": case.contact.half_width,
        "contact_cells": np.sum(case.p > 0.0) - 2.0 * case.contact.half_width / case.width,
        "stick_half_width": case.stick_zone.half_width,
        "stick_cells": np.sum(case.stick) - 2.0 * case.stick_zone.half_width / case.width,
        "contact_strips": int(np.sum(case.p > 0.0) - np.sum(p > 0.0)),
        "stick_strips": int(np.sum(case.stick) - np.sum(stick)),
        "pressure_ends": relative_l2(case.p, p),
        "shear_ends": relative_l2(case.q, q),
        "tilt": case.tilt / tilt - 1.0 if case.eccentric else None,
        "shear_y": float(np.max(np.abs(case.q_y)) / np.max(case.q)),
        "cell": case.width,
        "cell_shape": (case.y[1] - case.y[0]) / case.width,
    }


# ---------------------------------------------------------------- drawing


def draw_section(axes, case, title):
    """p and q/mu of the section: points petsam, lines the plane solution; the stick zone shaded."""
    x = np.unique(
        np.concatenate(
            [
                np.linspace(-1.5e-3, 1.5e-3, 3001),
                *(edge + np.linspace(-1e-5, 1e-5, 41) for edge in (*case.contact.ends, *case.stick_zone.ends)),
            ]
        )
    )
    left, right = (1e3 * end for end in case.stick_zone.ends)
    axes.axvspan(left, right, facecolor="0.92", edgecolor="0.7", linewidth=0.8, label="stick, plane")
    stuck = case.x[case.stick]
    half = 0.5 * case.width
    axes.plot(
        1e3 * np.array([stuck[0] - half, stuck[-1] + half]),
        [-26.0, -26.0],
        color="0.35",
        linewidth=3.0,
        solid_capstyle="butt",
        label="stick, petsam",
    )
    # dense where the curves are steep: points equally spaced in the angle of the contact
    angle = np.linspace(0.02, np.pi - 0.02, 44)
    wanted = case.contact.middle - case.contact.half_width * np.cos(angle)
    keep = np.unique(np.argmin(np.abs(case.x[:, None] - wanted), axis=0))
    for colour, exact, values, label in (
        (COLOUR_P, case.pressure(x), case.p, "$p$"),
        (COLOUR_Q, case.shear(x) / case.friction, case.q / case.friction, r"$q_x/\mu$"),
    ):
        axes.plot(1e3 * x, 1e-6 * exact, color=colour, linewidth=1.2, label=label + ", plane")
        points(axes, 1e3 * case.x[keep], 1e-6 * values[keep], colour, label=label + ", petsam")
    axes.set_title(title, fontsize=10)
    axes.set(xlabel="$x$, mm", ylabel=r"$p$, $q_x/\mu$, MPa", xlim=(-1.5, 1.5))


def draw_errors(axes, numbers):
    """Errors over L/c, fine grid: against the strips (the ends alone) and the closed solution (ends and grid)."""

    def curve(study, key):
        chosen = {n["case"]: n for n in numbers if n["study"] == study}
        found = [chosen["fine_r" + ratio] for ratio in RATIOS]
        return [n["ratio"] for n in found], [n[key] for n in found]

    for key, colour, name in (("pressure", COLOUR_P, "$p$"), ("shear", COLOUR_Q, "$q_x$")):
        for study, marker in zip(STUDIES, "os"):
            for kind, line, label, style in (
                ("_ends", "-", "ends alone", {"markerfacecolor": colour, "linewidth": 1.2}),
                ("_l2", ":", "ends and grid", {}),
            ):
                label = f"{name} {study}, {label}"
                joined(axes, *curve(study, key + kind), colour, marker + line, markersize=4.5, label=label, **style)
    ratio = np.array([4.0, 40.0])
    axes.plot(ratio, 0.024 / ratio**2, color="0.5", linewidth=1.0, linestyle="--")
    axes.text(8.0, 0.00018, "slope $-2$", color="0.4", fontsize=8.5, ha="right")
    frame(axes, "Error of the middle section", "length over width of the base, $L/c$", "relative L2 error")
    logarithmic(axes, "xy")
    axes.set_xticks([float(r) for r in RATIOS], RATIOS)
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_ylim(1e-5, 0.6)
    axes.legend(ncol=2, loc="upper right", handlelength=2.2, columnspacing=1.2, labelspacing=0.3)


def draw_along(axes, cases):
    """P'(y)/P'(0) of the upright punches."""
    for index, case in enumerate(cases):
        style = {"color": tint(index, len(cases)), "linewidth": 1.3, "label": f"{case.ratio:g}"}
        axes.plot(case.y / case.half_length, case.load_along / case.load, **style)
    frame(axes, "Load per length along the upright punch", "$y/L$", "$P'(y)/P'(0)$", (0.0, 1.15), (0.0, None))
    axes.legend(title="$L/c$", loc="upper left")


# ---------------------------------------------------------------- program


class Comparison:
    """All sections of a directory."""

    def __init__(self, directory):
        names = [f"{grid}_r{ratio}" for grid in ("fine", "coarse") for ratio in RATIOS] + list(VARIANTS[1:])
        self.sections = {(study, name): Section(directory, study, name) for study in STUDIES for name in names}
        self.numbers = [section_numbers(study, name, case) for (study, name), case in self.sections.items()]

    def rows(self, study, names):
        """Rows of the tables."""
        for n in self.numbers:
            if n["study"] == study and n["case"] in names:
                yield {
                    **n,
                    "load_mm": 1e-3 * n["load"],
                    "a_mm": 1e3 * n["half_width"],
                    "b_mm": 1e3 * n["stick_half_width"],
                    "e_mm": 1e3 * n["eccentricity"],
                    "tilt": n["tilt"] or 0.0,
                    "cell_um": 1e6 * n["cell"],
                }

    def tables(self):
        """For both punches: against the closed solution on two grids, and against strips."""
        columns = (
            "L/c = ratio:g; cell, µm = cell_um:.3g; dy/dx = cell_shape:.3g; P', N/mm = load_mm:.1f; "
            "M'/P', mm = e_mm:.4f; Q'/(mu P') = shear_ratio:.4f; p, L2 = pressure_l2:.1e; q, L2 = shear_l2:.1e; "
            "a, mm = a_mm:.4f; 2a, cells = contact_cells:+.2f; stick b, mm = b_mm:.4f; "
            "2b, cells = stick_cells:+.2f"
        )
        ends = (
            "L/c = ratio:g; case = case; p, L2 = pressure_ends:.1e; q, L2 = shear_ends:.1e; "
            "contact = contact_strips:+d; stick = stick_strips:+d; tilt = tilt:+.1e; max q_y/q_x = shear_y:.0e"
        )
        for study in STUDIES:
            for grid in ("fine", "coarse"):
                yield (
                    f"{study}, against the closed plane solution, {grid} grid",
                    columns,
                    self.rows(study, [f"{grid}_r{ratio}" for ratio in RATIOS]),
                )
            yield (
                f"{study}, against strips of the same width: the ends alone",
                ends,
                self.rows(study, ["fine_r" + ratio for ratio in RATIOS] + list(VARIANTS)),
            )

    def draw(self, directory):
        """long-punch.png."""
        picture, axes = plt.subplots(2, 2, figsize=(10.4, 8.0), constrained_layout=True)
        for panel, study in zip(axes[0], STUDIES):
            case = self.sections[study, "fine_r" + DRAWN]
            draw_section(
                panel,
                case,
                f"{study.capitalize()}: $P'$ = {1e-3 * case.load:.0f} N/mm, "
                f"$M'/P'$ = {1e3 * case.moment / case.load + 0.0:.3g} mm, "
                f"$Q'/\\mu P'$ = {case.shear_load / (case.friction * case.load):.3f}",
            )
        top = max(panel.get_ylim()[1] for panel in axes[0])
        for panel in axes[0]:
            panel.set_ylim(-40.0, top)
        axes[0, 0].legend(loc="upper center")
        draw_errors(axes[1, 0], self.numbers)
        draw_along(axes[1, 1], [self.sections["upright", "fine_r" + ratio] for ratio in RATIOS])
        case = self.sections["upright", "fine_r" + DRAWN]
        note(
            picture,
            f"Sections at $y = 0$ for $L/c$ = {DRAWN}, "
            f"cells {1e6 * case.width:.2f} x {1e6 * (case.y[1] - case.y[0]):.0f} µm;  "
            f"$c$ = {1e3 * case.punch.c:g} mm, $R$ = {1e3 * case.punch.edge_radius:g} mm, "
            f"$E^*$ = {1e-9 * case.punch.e_star:.1f} GPa, $\\mu$ = {case.friction:g}",
        )
        save(picture, directory, "long-punch.png")


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "long-punch"))
