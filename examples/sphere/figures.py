"""Compare the sphere example's results with Hertz, Cattaneo-Mindlin and Lubkin.

Reads the HDF5 files of all load levels that examples/sphere/run.sh wrote to a directory, takes the last saved step
of each, draws pressure.png, cattaneo.png, slip.png, torsion.png and overview.png (the four in one), and prints the
error norms. The closed-form solutions get their material, load and radius from the files and are evaluated at
the cell centres.

Error norms, all dimensionless:
  L2      sqrt(sum (numerical - exact)^2 / sum exact^2) over the cells
  others  numerical/exact - 1; the numerical stick radius is sqrt(stick_area/pi)
"""

import os
import sys
from pathlib import Path

import numpy as np

import petsam
from petsam.closed import Spheres
from petsam.core.errors import Missing
from petsam.plot.style import frame, note, plt, points, save, thinned, tint

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402
from comparison import relative_l2  # noqa: E402

LEVELS = (0.10, 0.30, 0.50, 0.70, 0.90, 0.95)  # of the scale of colours
TINT = tint(1, 6)  # of what has no load level
POINTS_ON_LINE = 40


class Case(petsam.Snapshot):
    """The last saved step of a file, with Hertz's contact and the scales of the closed solutions (SI units)."""

    def __init__(self, directory, name):
        super().__init__(petsam.open(os.path.join(directory, name + ".h5")))
        self.spheres = Spheres.of(self.parameters, self["load_n"])
        self.a, self.mu_p0 = self.spheres.hertz.radius, self.spheres.mu_p0
        self.angle = np.arctan2(self.y[:, None], self.x[None, :])
        self.poisson = self.spheres.bodies.poisson1


class Cattaneo(Case):
    """A case under T_x: level is T_x/(mu N), c the stick radius of Cattaneo and Mindlin, m."""

    def __init__(self, directory, name):
        super().__init__(directory, name)
        self.level = self["load_tx"] / self.spheres.limit
        if not 0.0 < self.level < 1.0:
            raise petsam.Error(f"{self.results.path}: T_x = {self.level:g} mu N is not partial slip")
        self.c = self.spheres.stick_radius(self["load_tx"])

    def exact_shear(self, r, _angle=0.0):
        """q_x, Pa, at r (m), for any angle."""
        return self.spheres.shear(r, self.c)

    def exact_slip(self, r, angle):
        """s_x, m, at r (m) and angle (rad); none outside the contact."""
        return np.where(r <= self.a, self.spheres.slip(r, angle, self.c), np.nan)


class Torsion(Case):
    """A case under M_z: level is M_z over the limit torque, c the stick radius of Lubkin, m."""

    def __init__(self, directory, name):
        super().__init__(directory, name)
        self.level = self["load_mz"] / self.spheres.torque_limit
        if not 0.0 < self.level < 1.0:
            raise petsam.Error(f"{self.results.path}: M_z = {self.level:g} of the limit torque is not partial slip")
        self.c = self.spheres.torsion_stick_radius(self["load_mz"])

    def exact_shear(self, r, _angle=0.0):
        """|q|, Pa, at r (m), for any angle."""
        return self.spheres.torsion_shear(r, self.c)


# ---------------------------------------------------------------- error norms


def hertz_errors(case):
    """Errors of the pressure field and of the approach."""
    return {
        "grid": [case.x.size, case.y.size],
        "pressure_l2": relative_l2(case["pressure"], case.spheres.pressure(case.r)),
        "approach": case["disp_z"] / case.spheres.hertz.approach - 1.0,
    }


def cattaneo_errors(case):
    """Errors of q_x, of s_x in the contact, of the stick radius and of the tangential displacement."""
    inside = case.r <= case.a
    q_y, q_x = (np.max(np.abs(case[name])) for name in ("shear_y", "shear_x"))
    return {
        "poisson": case.poisson,
        "load_ratio": case.level,
        "grid": [case.x.size, case.y.size],
        "shear_l2": relative_l2(case["shear_x"], case.exact_shear(case.r)),
        "slip_l2": relative_l2(case["slip_x"][inside], case.exact_slip(case.r, case.angle)[inside]),
        "stick_radius": case.radius("stick_area") / case.c - 1.0,
        "displacement": case["disp_x"] / case.spheres.displacement(case.c) - 1.0,
        "shear_y_over_shear_x": float(q_y / q_x),
    }


def torsion_errors(case):
    """Errors of |q|, of the stick radius and of the twist."""
    return {
        "poisson": case.poisson,
        "torque_ratio": case.level,
        "grid": [case.x.size, case.y.size],
        "shear_l2": relative_l2(case.shear, case.exact_shear(case.r)),
        "stick_radius": case.radius("stick_area") / case.c - 1.0,
        "twist": case["rot_z"] / case.spheres.twist(case.c) - 1.0,
    }


# ---------------------------------------------------------------- drawing


def colour(level):
    """Colour of a load level in (0, 1)."""
    return tint(np.interp(level, LEVELS, range(len(LEVELS))), len(LEVELS))


def points_of(case, field, low, high, margin=1.12):
    """x/a and values of every m-th cell of the row nearest y = 0, between low and high times margin."""
    x = case.x / case.a
    keep = thinned(np.flatnonzero((x >= low * margin) & (x <= high * margin)), POINTS_ON_LINE)
    return x[keep], field[case.row, keep]


def line_of(case, low, high):
    """x/a, r (m) and angle (rad) of a fine line along the row nearest y = 0, dense towards the contact's edge."""
    x = np.sin(0.5 * np.pi * np.linspace(low, high, 1201)) * case.a
    y = case.y[case.row]
    return x / case.a, np.hypot(x, y), np.arctan2(y, x)


def draw(axes, case, values, exact, unit, low=-1.0, margin=1.12):
    """A field over its unit, from x = low a to a (both times margin), as points on the line of exact(r, angle)."""
    color, label = colour(case.level), f"{case.level:.2g}"
    x, r, angle = line_of(case, low, 1.0)
    axes.plot(x, exact(r, angle) / unit, color=color, linewidth=1.3, zorder=2)
    points(axes, *points_of(case, values / unit, low, 1.0, margin), color, label=label)


def load_legend(axes, title, **where):
    """Legend of the load levels."""
    axes.legend(title=title, handletextpad=0.2, labelspacing=0.25, borderpad=0.2, **where)


def panel_pressure(axes, case):
    """p/p0 along y = 0 against Hertz."""
    p0, (x, r, _) = case.spheres.hertz.pressure, line_of(case, -1.0, 1.0)
    axes.plot(x, case.spheres.pressure(r) / p0, color=TINT, linewidth=1.3, zorder=2, label="Hertz")
    points(axes, *points_of(case, case["pressure"] / p0, -1.0, 1.0), TINT, label="petsam")
    axes.legend(loc="lower center")
    frame(axes, "Normal load: pressure", "$x/a$", "$p/p_0$", (-1.15, 1.15), (-0.03, 1.08))


def panel_cattaneo(axes, cases):
    """q_x/(mu p0) along y = 0 against Cattaneo-Mindlin."""
    for case in cases:
        draw(axes, case, case["shear_x"], case.exact_shear, unit=case.mu_p0)
    load_legend(axes, r"$T_x/(\mu N)$", loc="upper right", bbox_to_anchor=(1.0, 1.02))
    title = rf"Tangential force: shear, $\nu = {cases[0].poisson:g}$"
    frame(axes, title, "$x/a$", r"$q_x/(\mu p_0)$", (-1.15, 1.45), (-0.03, 1.08))


def panel_slip(axes, cases):
    """-s_x over the displacement at gross slip, along y = 0, against Cattaneo-Mindlin."""
    for case in cases:
        draw(axes, case, case["slip_x"], case.exact_slip, unit=-case.spheres.gross, margin=1.0)
    top = max(float(np.nanmax(line.get_ydata())) for line in axes.lines[::2])
    load_legend(axes, r"$T_x/(\mu N)$", loc="upper center", ncol=2, columnspacing=0.8)
    title = rf"Tangential force: slip, $\nu = {cases[0].poisson:g}$"
    frame(axes, title, "$x/a$", r"$-s_x/\delta_0$", (-1.08, 1.08), (-0.03 * top, 1.1 * top))


def panel_torsion(axes, cases):
    """|q|/(mu p0) along y = 0, x > 0, against Lubkin."""
    for case in cases:
        draw(axes, case, case.shear, case.exact_shear, unit=case.mu_p0, low=0.0, margin=1.05)
    load_legend(axes, r"$M_z/M_{lim}$", loc="upper right", bbox_to_anchor=(1.0, 1.02))
    frame(axes, "Torque: shear", "$x/a$", r"$|q|/(\mu p_0)$", (0.0, 1.25), (-0.03, 1.08))


def figure(directory, name, panels, text, share=False):
    """A picture of rows of (panel, cases); share: one y axis, whose label is the left panel's."""
    rows, columns = len(panels), len(panels[0])
    size = (6.4 if columns == 1 else 10.4, 4.2 if rows == 1 else 7.6)
    picture, axes = plt.subplots(rows, columns, figsize=size, sharey=share, constrained_layout=True, squeeze=False)
    for row, line in zip(axes, panels):
        for one, (panel, cases) in reversed(list(zip(row, line))):  # the left one last: its limits are for both
            panel(one, cases)
    if share:
        axes[0, 1].set_ylabel("")
    note(picture, text, 9 if rows == 1 else 10)
    save(picture, directory, name)


# ---------------------------------------------------------------- program


def levels(kind, directory, name):
    """The cases of all load levels in the directory, from the lowest."""
    files = list(Path(directory).glob(name + "*.h5"))
    if not files:
        raise Missing(f"{directory}: no {name}*.h5")
    return sorted((kind(directory, file.stem) for file in files), key=lambda case: case.level)


class Comparison:
    """All results of a directory."""

    def __init__(self, directory):
        self.hertz = Case(directory, "hertz")
        self.cattaneo = levels(Cattaneo, directory, "cattaneo_nu0.3_t")
        self.exact = levels(Cattaneo, directory, "cattaneo_nu0_t")
        self.torsion = levels(Torsion, directory, "torsion_m")
        self.numbers = {
            "hertz": hertz_errors(self.hertz),
            "cattaneo": [cattaneo_errors(case) for case in self.cattaneo + self.exact],
            "torsion": [torsion_errors(case) for case in self.torsion],
        }

    def tables(self):
        """The three tables of error norms."""
        yield "cells: {} x {}".format(*self.numbers["hertz"]["grid"])
        yield ("Pressure against Hertz", "p, L2 = pressure_l2:.2e; approach = approach:+.2e", [self.numbers["hertz"]])
        yield (
            "Tangential force against Cattaneo-Mindlin (exact for nu = 0, close for nu > 0)",
            (
                "nu = poisson:g; T/(mu N) = load_ratio:.3g; q_x, L2 = shear_l2:.2e; s_x, L2 = slip_l2:.2e; "
                "stick radius = stick_radius:+.2e; d_x = displacement:+.2e; max q_y/q_x = shear_y_over_shear_x:.2e"
            ),
            self.numbers["cattaneo"],
        )
        yield (
            "Torque against Lubkin",
            (
                "nu = poisson:g; M/M_lim = torque_ratio:.3g; |q|, L2 = shear_l2:.2e; "
                "stick radius = stick_radius:+.2e; twist r_z = twist:+.2e"
            ),
            self.numbers["torsion"],
        )

    def draw(self, directory):
        """The five pictures; nu = 0, where Cattaneo and Mindlin are exact, stands on the right."""
        text = f"points: petsam, {self.hertz.x.size} x {self.hertz.y.size} cells, along $y = 0$;  "
        gross = r";  $\delta_0$: tangential displacement at gross slip"
        normal, torsion = (panel_pressure, self.hertz), (panel_torsion, self.torsion)
        shear, slip = (panel_cattaneo, self.cattaneo), (panel_slip, self.cattaneo)
        figure(directory, "pressure.png", [[normal]], text + "line: Hertz")
        figure(
            directory, "cattaneo.png", [[shear, (panel_cattaneo, self.exact)]], text + "lines: Cattaneo-Mindlin", True
        )
        figure(
            directory, "slip.png", [[slip, (panel_slip, self.exact)]], text + "lines: Cattaneo-Mindlin" + gross, True
        )
        figure(directory, "torsion.png", [[torsion]], text + "lines: Lubkin")
        figure(
            directory,
            "overview.png",
            [[normal, shear], [slip, torsion]],
            text + "lines: Hertz, Cattaneo-Mindlin, Lubkin",
        )


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "sphere"))
