#!/usr/bin/env python3
"""Compare the sphere example's results with Hertz, Cattaneo-Mindlin and Lubkin.

Reads the HDF5 files that examples/sphere/run.sh writes to a directory, takes the last saved step of each,
draws pressure.png, cattaneo.png, slip.png, torsion.png and overview.png (the four in one), and prints the
error norms. The closed solutions get their material, load and radius from the files and are evaluated at
the cell centres.

Error norms, all dimensionless:
  L2      sqrt(sum (numerical - exact)^2 / sum exact^2) over the cells
  others  numerical/exact - 1; the numerical stick radius is sqrt(stick_area/pi)
"""
import os
import sys

import h5py
import numpy as np

import analytic
from figures import STYLE, InputError, finish_numbers, main, plt, print_table, relative_l2, save

LEVELS = ("0.10", "0.30", "0.50", "0.70", "0.90", "0.95")
LEVELS_EXACT = ("0.30", "0.60", "0.90")
HERTZ_FILE = "hertz.h5"
CATTANEO_FILES = tuple("cattaneo_nu0.3_t{}.h5".format(t) for t in LEVELS)
CATTANEO_EXACT_FILES = tuple("cattaneo_nu0_t{}.h5".format(t) for t in LEVELS_EXACT)
TORSION_FILES = tuple("torsion_m{}.h5".format(m) for m in LEVELS)

FIELDS = ("pressure", "shear_x", "shear_y", "slip_x")
HISTORY = ("load_n", "load_tx", "load_mz", "disp_z", "disp_x", "rot_z", "stick_area")
POINTS_ON_LINE = 40


# ---------------------------------------------------------------- reading

class Result:
    """The last saved step of one HDF5 file, with Hertz's contact for its parameters (SI units).

    x, y (m) are the cell centres; pressure, shear_x, shear_y (Pa) and slip_x (m) have shape (ny, nx);
    history holds the scalars of the last load step by name.
    """

    def __init__(self, path):
        self.path = path
        if not os.path.isfile(path):
            raise InputError("{}: no such file; run examples/sphere/run.sh first".format(path))
        try:
            with h5py.File(path, "r") as file:
                self._read(file)
        except (OSError, KeyError, ValueError, IndexError) as error:
            raise InputError("{}: cannot be read: {}".format(path, error)) from error
        self._derive()

    def _read(self, file):
        def parameter(name):
            return float(np.ravel(file.attrs[name])[0])

        bodies = [(parameter("body%d_young" % k), parameter("body%d_poisson" % k)) for k in (1, 2)]
        self.bodies, self.friction = bodies, parameter("friction")
        self.gap_radius = analytic.effective_radius(parameter("gap_radius1"), parameter("gap_radius2"))
        self.x, self.y = file["x"][:], file["y"][:]
        for name in FIELDS:
            field = file[name][-1]
            if field.shape != (self.y.size, self.x.size) or not np.all(np.isfinite(field)):
                raise ValueError("/{} is not a finite field of shape (ny, nx)".format(name))
            setattr(self, name, field)
        self.history = {name: float(file["history/" + name][-1]) for name in HISTORY}

    def _derive(self):
        (young1, poisson1), (young2, poisson2) = self.bodies
        self.hertz = analytic.hertz(
            self.history["load_n"], self.gap_radius, analytic.effective_modulus(young1, poisson1, young2, poisson2))
        moduli = [analytic.shear_modulus(*body) for body in self.bodies]
        self.compliance = analytic.tangential_compliance(moduli[0], poisson1, moduli[1], poisson2)
        self.anisotropy = sum(body[1] / (4.0 * g) for body, g in zip(self.bodies, moduli))
        self.torsion_compliance = sum(1.0 / g for g in moduli)
        self.mu_p0 = self.friction * self.hertz.pressure
        self.r = np.hypot(self.x[None, :], self.y[:, None])
        self.angle = np.arctan2(self.y[:, None], self.x[None, :])
        self.row = int(np.argmin(np.abs(self.y)))

    @property
    def poisson(self):
        """Poisson's ratio of body 1."""
        return self.bodies[0][1]

    @property
    def stick_radius(self):
        """Radius, m, of the disc with the area that sticks."""
        return np.sqrt(self.history["stick_area"] / np.pi)


class Cattaneo(Result):
    """A result under T_x, with the Cattaneo-Mindlin solution for the same load."""

    def __init__(self, path):
        super().__init__(path)
        self.level = self.history["load_tx"] / (self.friction * self.history["load_n"])
        if not 0.0 < self.level < 1.0:
            raise InputError("{}: T_x = {:g} mu N is not partial slip".format(path, self.level))
        self.c = analytic.cattaneo_stick_radius(self.level, self.hertz.radius)
        self.gross = analytic.cattaneo_displacement(self.hertz.radius, 0.0, self.mu_p0, self.compliance)

    def shear(self, r):
        """q_x, Pa, at r (m)."""
        return analytic.cattaneo_shear(r, self.hertz.radius, self.c, self.mu_p0)

    def slip(self, r, angle):
        """s_x, m, at r (m) and angle (rad)."""
        return analytic.cattaneo_slip(
            r, self.hertz.radius, self.c, self.mu_p0, self.compliance, self.anisotropy, angle)


class Torsion(Result):
    """A result under M_z, with Lubkin's solution for the same torque."""

    def __init__(self, path):
        super().__init__(path)
        limit = analytic.torsion_limit(self.history["load_n"], self.friction, self.hertz.radius)
        self.level = self.history["load_mz"] / limit
        if not 0.0 < self.level < 1.0:
            raise InputError("{}: M_z = {:g} of the limit torque is not partial slip".format(path, self.level))
        self.c = analytic.lubkin_stick_radius(self.level, self.hertz.radius)

    def shear(self, r):
        """|q|, Pa, at r (m)."""
        return analytic.lubkin_shear(r, self.hertz.radius, self.c, self.mu_p0)


# ---------------------------------------------------------------- error norms

def hertz_errors(case):
    """Errors of the pressure field and of the approach."""
    exact = analytic.hertz_pressure(case.r, case.hertz.radius, case.hertz.pressure)
    return {
        "grid": [case.x.size, case.y.size],
        "pressure_l2": relative_l2(case.pressure, exact),
        "approach": case.history["disp_z"] / case.hertz.approach - 1.0,
    }


def cattaneo_errors(case):
    """Errors of q_x, of s_x in the contact, of the stick radius and of the tangential displacement."""
    inside = case.r <= case.hertz.radius
    rigid = analytic.cattaneo_displacement(case.hertz.radius, case.c, case.mu_p0, case.compliance)
    q_y, q_x = np.max(np.abs(case.shear_y)), np.max(np.abs(case.shear_x))
    return {
        "poisson": case.poisson, "load_ratio": case.level, "grid": [case.x.size, case.y.size],
        "shear_l2": relative_l2(case.shear_x, case.shear(case.r)),
        "slip_l2": relative_l2(case.slip_x[inside], case.slip(case.r, case.angle)[inside]),
        "stick_radius": case.stick_radius / case.c - 1.0,
        "displacement": case.history["disp_x"] / rigid - 1.0,
        "shear_y_over_shear_x": float(q_y / q_x),
    }


def torsion_errors(case):
    """Errors of |q|, of the stick radius and of the twist."""
    twist = analytic.lubkin_twist(case.hertz.radius, case.c, case.mu_p0, case.torsion_compliance)
    return {
        "poisson": case.poisson, "torque_ratio": case.level, "grid": [case.x.size, case.y.size],
        "shear_l2": relative_l2(np.hypot(case.shear_x, case.shear_y), case.shear(case.r)),
        "stick_radius": case.stick_radius / case.c - 1.0,
        "twist": case.history["rot_z"] / twist - 1.0,
    }


def print_errors(errors):
    """Print the three tables of error norms."""
    print("cells: {} x {}".format(*errors["hertz"]["grid"]))
    print_table("Pressure against Hertz", {
        "p, L2": ("pressure_l2", "{:.2e}"), "approach": ("approach", "{:+.2e}")}, [errors["hertz"]])
    print_table("Tangential force against Cattaneo-Mindlin (exact for nu = 0, close for nu > 0)", {
        "nu": ("poisson", "{:g}"), "T/(mu N)": ("load_ratio", "{:.3g}"), "q_x, L2": ("shear_l2", "{:.2e}"),
        "s_x, L2": ("slip_l2", "{:.2e}"), "stick radius": ("stick_radius", "{:+.2e}"),
        "d_x": ("displacement", "{:+.2e}"), "max q_y/q_x": ("shear_y_over_shear_x", "{:.2e}")}, errors["cattaneo"])
    print_table("Torque against Lubkin", {
        "nu": ("poisson", "{:g}"), "M/M_lim": ("torque_ratio", "{:.3g}"), "|q|, L2": ("shear_l2", "{:.2e}"),
        "stick radius": ("stick_radius", "{:+.2e}"), "twist r_z": ("twist", "{:+.2e}")}, errors["torsion"])


# ---------------------------------------------------------------- drawing

def colour(level):
    """Colour of a load level in (0, 1): evenly spaced over LEVELS."""
    even = np.interp(level, [float(name) for name in LEVELS], np.linspace(0.0, 0.88, len(LEVELS)))
    return plt.get_cmap("plasma")(even)


def points_of(case, field, low, high, margin=1.12):
    """x/a and values of every m-th cell of the row nearest y = 0, between low and high times margin.

    m is odd, so that the choice can be symmetric whether the number of cells is odd or even.
    """
    x = case.x / case.hertz.radius
    keep = np.flatnonzero((x >= low * margin) & (x <= high * margin))
    step = (keep.size // POINTS_ON_LINE) | 1
    rest = (keep.size - 1) % step
    keep = keep[(rest + step * (rest % 2)) // 2::step]
    return x[keep], field[case.row, keep]


def line_of(case, low, high):
    """x/a, r (m) and angle (rad) of a fine line along the row nearest y = 0, dense towards the contact's edge."""
    x = np.sin(0.5 * np.pi * np.linspace(low, high, 1201)) * case.hertz.radius
    y = case.y[case.row]
    return x / case.hertz.radius, np.hypot(x, y), np.arctan2(y, x)


def draw(axes, points, line, level):
    """Numerical points on an analytical line, in the colour of the load level."""
    tint, label = colour(level), "{:.2g}".format(level)
    axes.plot(*line, color=tint, linewidth=1.3, zorder=2)
    axes.plot(*points, "o", color=tint, markersize=3.6, markerfacecolor="white", zorder=3, label=label)


def finish(axes, title, ylabel, xlim, ylim):
    """Titles, labels and limits of one panel."""
    axes.set(title=title, xlabel="$x/a$", ylabel=ylabel, xlim=xlim, ylim=ylim)


def load_legend(axes, title, **where):
    """Legend of the load levels."""
    axes.legend(title=title, handletextpad=0.2, labelspacing=0.25, borderpad=0.2, **where)


def panel_pressure(axes, case):
    """p/p0 along y = 0 against Hertz."""
    x, r, _ = line_of(case, -1.0, 1.0)
    p0 = case.hertz.pressure
    exact = analytic.hertz_pressure(r, case.hertz.radius, p0) / p0
    px, p = points_of(case, case.pressure, -1.0, 1.0)
    axes.plot(x, exact, color=colour(0.3), linewidth=1.3, label="Hertz")
    axes.plot(px, p / p0, "o", color=colour(0.3), markersize=3.6, markerfacecolor="white", label="petsam", zorder=3)
    axes.legend(loc="lower center")
    finish(axes, "Normal load: pressure", "$p/p_0$", (-1.15, 1.15), (-0.03, 1.08))


def panel_cattaneo(axes, cases, legend=True):
    """q_x/(mu p0) along y = 0 against Cattaneo-Mindlin."""
    for case in cases:
        x, r, _ = line_of(case, -1.0, 1.0)
        px, q = points_of(case, case.shear_x, -1.0, 1.0)
        draw(axes, (px, q / case.mu_p0), (x, case.shear(r) / case.mu_p0), case.level)
    if legend:
        load_legend(axes, r"$T_x/(\mu N)$", loc="upper right", bbox_to_anchor=(1.0, 1.02))
    finish(axes, r"Tangential force: shear, $\nu = {:g}$".format(cases[0].poisson), r"$q_x/(\mu p_0)$",
           (-1.15, 1.45 if legend else 1.15), (-0.03, 1.08))


def panel_slip(axes, cases, legend=True):
    """-s_x over the displacement at gross slip, along y = 0, against Cattaneo-Mindlin."""
    top = 0.0
    for case in cases:
        x, r, angle = line_of(case, -1.0, 1.0)
        exact = np.where(r < case.hertz.radius, -case.slip(r, angle) / case.gross, np.nan)
        px, slip = points_of(case, case.slip_x, -1.0, 1.0, margin=1.0)
        draw(axes, (px, -slip / case.gross), (x, exact), case.level)
        top = max(top, float(np.nanmax(exact)))
    if legend:
        load_legend(axes, r"$T_x/(\mu N)$", loc="upper center", ncol=2, columnspacing=0.8)
    finish(axes, r"Tangential force: slip, $\nu = {:g}$".format(cases[0].poisson),
           r"$-s_x/\delta_0$", (-1.08, 1.08), (-0.03 * top, 1.1 * top))


def panel_torsion(axes, cases):
    """|q|/(mu p0) along y = 0, x > 0, against Lubkin."""
    for case in cases:
        x, r, _ = line_of(case, 0.0, 1.0)
        px, q = points_of(case, np.hypot(case.shear_x, case.shear_y), 0.0, 1.0, margin=1.05)
        draw(axes, (px, q / case.mu_p0), (x, case.shear(r) / case.mu_p0), case.level)
    load_legend(axes, r"$M_z/M_{lim}$", loc="upper right", bbox_to_anchor=(1.0, 1.02))
    finish(axes, "Torque: shear", r"$|q|/(\mu p_0)$", (0.0, 1.25), (-0.03, 1.08))


def figure_single(directory, name, panel, argument, note):
    """A figure of one panel."""
    figure, axes = plt.subplots(figsize=(6.4, 4.2), constrained_layout=True)
    panel(axes, argument)
    figure.suptitle(note, fontsize=9, color="0.35")
    save(figure, directory, name)


def figure_pair(directory, name, panel, cases, exact_cases, note):
    """A figure of two panels: Table 1's nu on the left, nu = 0, where the solution is exact, on the right."""
    figure, axes = plt.subplots(1, 2, figsize=(10.4, 4.2), sharey=True, constrained_layout=True)
    panel(axes[1], exact_cases)
    panel(axes[0], cases)
    axes[1].set_ylabel("")
    figure.suptitle(note, fontsize=9, color="0.35")
    save(figure, directory, name)


def figure_overview(directory, hertz, cattaneo, torsion, note):
    """The four comparisons at Table 1's parameters in one picture."""
    figure, axes = plt.subplots(2, 2, figsize=(10.4, 7.6), constrained_layout=True)
    panel_pressure(axes[0, 0], hertz)
    panel_cattaneo(axes[0, 1], cattaneo)
    panel_slip(axes[1, 0], cattaneo)
    panel_torsion(axes[1, 1], torsion)
    figure.suptitle(note, fontsize=10, color="0.35")
    save(figure, directory, "overview.png")


def draw_all(directory, hertz, cattaneo, exact, torsion):
    """Draw the five pictures."""
    points = "points: petsam, {} x {} cells, along $y = 0$;  ".format(hertz.x.size, hertz.y.size)
    note = points + "lines: Cattaneo-Mindlin"
    with plt.rc_context(STYLE):
        figure_single(directory, "pressure.png", panel_pressure, hertz, points + "line: Hertz")
        figure_pair(directory, "cattaneo.png", panel_cattaneo, cattaneo, exact, note)
        figure_pair(directory, "slip.png", panel_slip, cattaneo, exact,
                    note + r";  $\delta_0$: tangential displacement at gross slip")
        figure_single(directory, "torsion.png", panel_torsion, torsion, points + "lines: Lubkin")
        figure_overview(directory, hertz, cattaneo, torsion, points + "lines: Hertz, Cattaneo-Mindlin, Lubkin")


# ---------------------------------------------------------------- program

def run(options):
    """Read, print the error norms, draw."""
    def load(kind, names):
        return [kind(os.path.join(options.directory, name)) for name in names]

    hertz = Result(os.path.join(options.directory, HERTZ_FILE))
    cattaneo, exact = load(Cattaneo, CATTANEO_FILES), load(Cattaneo, CATTANEO_EXACT_FILES)
    torsion = load(Torsion, TORSION_FILES)
    errors = {
        "hertz": hertz_errors(hertz),
        "cattaneo": [cattaneo_errors(case) for case in cattaneo + exact],
        "torsion": [torsion_errors(case) for case in torsion],
    }
    print_errors(errors)
    figures = finish_numbers(options, errors)
    draw_all(figures, hertz, cattaneo, exact, torsion)


if __name__ == "__main__":
    sys.exit(main(run, __doc__, "sphere"))
