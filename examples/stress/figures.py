"""Compare the stress example's results with Hertz and Hamilton, and draw them.

Reads the HDF5 files that examples/stress/run.sh writes to a directory, prints errors over p0, and draws axis.png,
surface.png, section.png, fatigue.png and overview.png (parts of all in one).
"""

import os
import sys
from pathlib import Path

import numpy as np

import petsam
from petsam.closed import HERTZ_MISES, HERTZ_MISES_DEPTH, Spheres, hertz_axis, hertz_surface, sliding_surface
from petsam.plot.bodies import MARK, numbered, untangle
from petsam.plot.style import CLOSED, DAMAGE, bar, cross, extent, field, frame, note, plt, points, save, thinned, tint

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402

FRICTIONS = ("0.1", "0.5")
STATES = ("partial", "sliding")
WORDS = {"partial": "partial slip", "sliding": "sliding"}
INSIDE = 0.9  # part of the contact radius on which surface stresses are compared
LINES = np.linspace(0.1, 1.0, 10)  # of von Mises over p0


class Case:
    """A file of stresses, with Hertz's contact of the run that it belongs to."""

    def __init__(self, directory, run, name):
        self.file = petsam.open(os.path.join(directory, name + ".h5"))
        results = petsam.open(os.path.join(directory, run + ".h5"))
        step = petsam.Snapshot(results)
        self.spheres = Spheres.of(step.parameters, step["load_n"])
        self.a, self.p0 = self.spheres.hertz.radius, self.spheres.hertz.pressure
        self.mu, self.poisson = results.friction(results.of_last()), self.file.parameters["poisson"]
        self.x, self.y, self.z = (axis / self.a for axis in (self.file.x, self.file.y, self.file.z))

    def over_p0(self, name, index=-1):
        """A quantity (z, y, x) over p0."""
        return self.file.field(name, index) / self.p0


# ---------------------------------------------------------------- numbers


def axis_numbers(case):
    """Errors of the stresses on the axis, in the column of cells on it."""
    column = int(np.argmin(np.abs(case.x)))
    exact = dict(zip(("xx", "zz"), hertz_axis(case.z, 1.0, 1.0, case.poisson)))
    errors = {k: np.max(np.abs(case.over_p0("stress_" + k)[:, 0, column] - v)) for k, v in exact.items()}
    return {"cells": case.x.size, "depths": f"{case.z[0]:.2f} to {case.z[-1]:.2f}", **errors}


def exact_surface(case, x, y, shear):
    """s_xx, s_yy, s_xy over p0 on the surface inside the contact; shear: q_x over p."""
    radial, around = hertz_surface(np.hypot(x, y), 1.0, 1.0, case.poisson)
    angle = np.arctan2(y, x)
    cos, sin = np.cos(angle), np.sin(angle)
    by_shear = sliding_surface(x, y, 1.0, shear, case.poisson)
    cartesian = (
        radial * cos**2 + around * sin**2, radial * sin**2 + around * cos**2, (radial - around) * cos * sin
    )  # fmt: skip
    return [one + other for one, other in zip(cartesian, by_shear)]


def sliding_numbers(case):
    """Largest errors of the surface stresses inside 0.9 a under full sliding."""
    x, y = np.meshgrid(case.x, case.y)
    inside = np.hypot(x, y) < INSIDE
    found = (case.over_p0("stress_" + k)[0] for k in ("xx", "yy", "xy"))
    errors = [np.max(np.abs(f - e)[inside]) for f, e in zip(found, exact_surface(case, x, y, case.mu))]
    return dict(zip(("mu", "xx", "yy", "xy"), (case.mu, *errors)))


def stick_numbers(case, normal):
    """What the shear adds to the surface stresses where all sticks: nothing, in Cattaneo and Mindlin's solution."""
    c = 0.6 * case.a  # of T = 0.784 mu N
    row = case.file.y.size // 2
    inside = np.abs(case.file.x) < 0.95 * c
    added = case.over_p0("stress_xx")[0, row] - normal.over_p0("stress_xx")[0, 0]
    return {"mu": case.mu, "added": float(np.max(np.abs(added[inside])))}


def mises_numbers(case, name):
    """Largest von Mises stress of a section and its place."""
    mises = case.over_p0("mises")
    z, _, x = np.unravel_index(np.argmax(mises), mises.shape)
    return {"case": name, "mises": mises[z, 0, x], "x": case.x[x], "z": case.z[z]}


def fatigue_numbers(case, where):
    """Largest Smith-Watson-Topper parameter and its place."""
    swt = case.file.field("swt")
    z, y, x = np.unravel_index(np.argmax(swt), swt.shape)
    return {"where": where, "swt": swt.max(), "x": case.x[x], "y": case.y[y], "z": case.z[z]}


# ---------------------------------------------------------------- drawing


def draw_axis(axes, case):
    """Stresses on the axis."""
    depth, column = np.linspace(1e-3, 2.0, 200), int(np.argmin(np.abs(case.x)))
    lines = dict(zip(("xx", "zz"), hertz_axis(depth, 1.0, 1.0, case.poisson)))
    for k, (name, line) in enumerate(lines.items()):
        axes.plot(depth, line, **CLOSED)
        found = case.over_p0("stress_" + name)[:, 0, column]
        points(axes, case.z, found, tint(k, 3), label=f"$\\sigma_{{{name}}}$")
    frame(axes, "Normal load: stress on the axis; lines: Hertz", "$z/a$", "$\\sigma/p_0$")
    axes.legend()


def draw_surface(axes, cases, mu):
    """s_xx along y = 0 under N alone, in partial slip and sliding."""
    for k, (name, case) in enumerate(cases.items()):
        row = case.file.y.size // 2
        values = case.over_p0("stress_xx")[0, row]
        axes.plot(case.x, values, color=tint(k, 3), linewidth=0.9)
        shown = thinned(np.flatnonzero(np.abs(case.x) < 1.3), 45)
        points(axes, case.x[shown], values[shown], tint(k, 3), label="normal load" if name == "N" else name)
        if name != WORDS["partial"]:
            x = np.linspace(-0.999, 0.999, 200)
            axes.plot(x, exact_surface(case, x, 0.0 * x, mu if name == WORDS["sliding"] else 0.0)[0], **CLOSED)
    frame(axes, f"Surface, $\\mu$ = {mu}; grey: Hertz, Hamilton", "$x/a$", "$\\sigma_{xx}/p_0$", (-1.3, 1.3))
    axes.legend()


def draw_section(axes, case, title):
    """Von Mises over a section."""
    axes.grid(False)
    mises = case.over_p0("mises")[:, 0]
    beyond = "max" if mises.max() > 1.0 else "neither"
    image = axes.contourf(case.x, case.z, mises, levels=np.linspace(0.0, 1.0, 41), extend=beyond, cmap="viridis")
    bar(axes, image, "$\\sigma_M/p_0$", ticks=np.linspace(0.0, 1.0, 6))
    lines = axes.contour(case.x, case.z, mises, levels=LINES, colors="0.15", linewidths=0.6)
    numbered(axes, lines, "%.1f")
    z, x = np.unravel_index(np.argmax(mises), mises.shape)
    cross(axes, case.x[x], case.z[z], MARK)
    frame(axes, f"{title}: maximum {mises[z, x]:.3f} $p_0$", "$x/a$", "$z/a$")
    axes.set_ylim(case.z[-1], case.z[0])


def draw_fatigue(axes, surface):
    """SWT over the surface, and its largest value."""
    values = surface.file.field("swt")[0] * 1e-6
    image = field(axes, values, extent(surface.x, surface.y), color_map=DAMAGE)
    bar(axes, image, "SWT, MPa")
    y, x = np.unravel_index(np.argmax(values), values.shape)
    cross(axes, surface.x[x], surface.y[y])
    circle = np.linspace(0.0, 2.0 * np.pi, 200)
    axes.plot(np.cos(circle), np.sin(circle), ":", color="black", linewidth=0.8)
    frame(axes, f"SWT of a cycle on the surface: maximum {values.max():.3f} MPa", "$x/a$", "$y/a$")


class Comparison:
    """All cases of the example."""

    def __init__(self, directory):
        self.axis = Case(directory, "normal", "normal_axis")
        self.normal = Case(directory, "normal", "normal_section")
        self.surfaces = {(s, mu): Case(directory, f"{s}_{mu}", f"{s}_{mu}_surface") for mu in FRICTIONS for s in STATES}
        self.sections = {(s, mu): Case(directory, f"{s}_{mu}", f"{s}_{mu}_section") for mu in FRICTIONS for s in STATES}
        self.cycle = {part: Case(directory, "cycle", "cycle_" + part) for part in ("surface", "section")}
        sections = {"N": self.normal}
        sections.update({f"{WORDS[s]}, mu {mu}": case for (s, mu), case in self.sections.items()})
        self.numbers = {
            "axis": axis_numbers(self.axis),
            "sliding": [sliding_numbers(self.surfaces["sliding", mu]) for mu in FRICTIONS],
            "stick": [stick_numbers(self.surfaces["partial", mu], self.normal) for mu in FRICTIONS],
            "mises": [mises_numbers(case, name) for name, case in sections.items()],
            "fatigue": [fatigue_numbers(self.cycle[part], part) for part in ("surface", "section")],
        }

    def tables(self):
        """What is printed."""
        n = self.numbers
        yield (
            "N on the axis, maximum errors over p0",
            "cells = cells:d; z/a = depths; s_rr = xx:.1e; s_zz = zz:.1e",
            [n["axis"]],
        )
        yield (
            "sliding, surface inside 0.9 a, maximum errors over p0 (Hamilton)",
            "mu = mu:g; s_xx = xx:.1e; s_yy = yy:.1e; s_xy = xy:.1e",
            n["sliding"],
        )
        yield (
            "partial slip, inside 0.95 of the stick radius: contribution of the shear to s_xx on y = 0, over p0",
            "mu = mu:g; maximum = added:.1e",
            n["stick"],
        )
        yield (
            f"maximum von Mises stress over p0 at y = 0 (Hertz: {HERTZ_MISES:.4f} at z = {HERTZ_MISES_DEPTH:.4f} a)",
            "case = case; stress = mises:.4f; x/a = x:.3f; z/a = z:.3f",
            n["mises"],
        )
        yield (
            "maximum SWT parameter of the cycle, Pa, and its place",
            "where = where; SWT = swt:.4g; x/a = x:.3f; y/a = y:.3f; z/a = z:.3f",
            n["fatigue"],
        )

    def _by_state(self, mu):
        return {"N": self.normal, **{WORDS[s]: self.surfaces[s, mu] for s in STATES}}

    def draw(self, directory):
        """The pictures."""
        figure, axes = plt.subplots(figsize=(6.0, 4.2), constrained_layout=True)
        draw_axis(axes, self.axis)
        save(figure, directory, "axis.png")
        figure, axes = plt.subplots(1, 2, figsize=(12.0, 4.4), constrained_layout=True)
        for panel, mu in zip(axes, FRICTIONS):
            draw_surface(panel, self._by_state(mu), float(mu))
        save(figure, directory, "surface.png")
        figure, axes = plt.subplots(2, 2, figsize=(12.0, 7.4), constrained_layout=True)
        for panel, ((state, mu), case) in zip(axes.flat, self.sections.items()):
            draw_section(panel, case, f"$\\mu$ = {mu}, {WORDS[state]}")
        note(figure, "von Mises stress over $p_0$")
        untangle(figure)
        save(figure, directory, "section.png")
        figure, axes = plt.subplots(figsize=(6.4, 5.0), constrained_layout=True)
        draw_fatigue(axes, self.cycle["surface"])
        save(figure, directory, "fatigue.png")
        figure, axes = plt.subplots(2, 2, figsize=(11.0, 7.6), constrained_layout=True)
        draw_axis(axes[0, 0], self.axis)
        draw_surface(axes[0, 1], self._by_state("0.5"), 0.5)
        draw_section(axes[1, 0], self.sections["sliding", "0.5"], "Von Mises stress, $\\mu$ = 0.5, sliding")
        draw_fatigue(axes[1, 1], self.cycle["surface"])
        untangle(figure)
        save(figure, directory, "overview.png")


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "stress"))
