#!/usr/bin/env python3
"""Compare the dissimilar example's results (elastic sphere on a rigid flat, friction, growing load) with Spence.

Reads the HDF5 files that examples/dissimilar/run.sh writes to a directory, draws stick.png (stick radius against
friction, against the load, and against the number of steps) and fields.png (pressure, shear and slip over r/a), and
prints the numbers. The reference is loop_analytic.SpencePunch, a solution of the axisymmetric equations that shares
nothing with petsam; Goodman's closed relation is its approximation.

Stick ratio is sqrt(stick_area/contact_area), central pressure the mean of the four cells nearest the axis. Hertz's
pressure is that of the same load without friction; what is called "equal radius" is Hertz's for the computed radius.
"""
import os
import sys

import h5py
import numpy as np
from scipy.interpolate import PchipInterpolator

import analytic
import loop_analytic
from figures import STYLE, InputError, finish_numbers, main, plt, print_table, relative_l2, save

FRICTION = {"0": ("0.2", "0.2986", "0.4", "0.5", "0.65", "1"), "0.2": ("0.15", "0.2", "0.3", "0.4"),
            "0.3": ("0.1", "0.15", "0.2", "0.3")}
MAIN = "nu0_mu0.2986"
UNCOUPLED = "uncoupled"
STEPS = (1, 2, 5, 10, 20, 40)
TINTS = {"0": "#3b4cc0", "0.2": "#2a9d72", "0.3": "#c44e52"}


class Press:
    """One HDF5 file: the history and the last saved step, SI units; stick is c/a of every load step."""

    def __init__(self, directory, name):
        self.name, self.path = name, os.path.join(directory, name + ".h5")
        self._reference = None
        if not os.path.isfile(self.path):
            raise InputError("{}: no such file; run examples/dissimilar/run.sh first".format(self.path))
        try:
            with h5py.File(self.path, "r") as file:
                self._read(file)
        except (OSError, KeyError, ValueError, IndexError) as error:
            raise InputError("{}: cannot be read: {}".format(self.path, error)) from error

    def _read(self, file):
        def parameter(name):
            return float(np.ravel(file.attrs[name])[0])

        young, self.poisson = parameter("body1_young"), parameter("body1_poisson")
        self.friction = parameter("friction")
        self.beta = loop_analytic.dundurs_beta(analytic.shear_modulus(young, self.poisson), self.poisson, np.inf, 0.0)
        self.radius = analytic.effective_radius(parameter("gap_radius1"), parameter("gap_radius2"))
        self.e_star = young / (1.0 - self.poisson**2)
        history = file["history"]
        if np.any(history["status"][:] != 0):
            raise ValueError("a step did not converge")
        self.load, contact, stick = (history[name][:] for name in ("load_n", "contact_area", "stick_area"))
        self.stick, self.contact_radius = np.sqrt(stick / contact), np.sqrt(contact / np.pi)
        self.dissipated, self.passes = history["dissipated_energy"][:], history["coupling_iterations"][:]
        self.hertz = analytic.hertz(float(self.load[-1]), self.radius, self.e_star)
        self.x, self.y = file["x"][:], file["y"][:]
        self.pressure, self.shear_x, self.shear_y, self.slip_x, self.slip_y = (
            file[name][-1] for name in ("pressure", "shear_x", "shear_y", "slip_x", "slip_y"))
        self.r = np.hypot(self.x[None, :], self.y[:, None])
        nearest = np.argsort(self.r, axis=None)[:4]
        self.central = float(np.mean(self.pressure.ravel()[nearest]))

    def radial(self, name):
        """The outward part of shear or slip."""
        return (self.x[None, :] * getattr(self, name + "_x") + self.y[:, None] * getattr(self, name + "_y")) / self.r

    def reference(self):
        """The SpencePunch of this friction and beta."""
        if self._reference is None:
            self._reference = loop_analytic.spence_punch(self.friction, self.beta)
        return self._reference

    def expected_radius(self, punch):
        """Contact radius, m, of the reference at the same load."""
        return self.hertz.radius * punch.load_ratio**(-1.0 / 3.0)


# ---------------------------------------------------------------- numbers

def case_numbers(case):
    """Stick radius, contact radius and central pressure against the reference."""
    punch = case.reference()
    radius = case.expected_radius(punch)
    half = case.stick[case.stick.size // 2:]
    # Hertz's p0 for the reference's radius is proportional to that radius
    table = np.sin(0.5 * np.pi * np.linspace(1e-4, 1.0 - 1e-6, 800))
    p, q = (np.interp(case.r / radius, table, field) for field in punch.sphere(table))
    inside, unit = case.r < radius, case.hertz.pressure * radius / case.hertz.radius
    goodman = loop_analytic.goodman_ratio(case.friction / case.beta)
    return {
        "poisson": case.poisson, "beta": case.beta, "friction": case.friction, "steps": int(case.stick.size),
        "stick": float(case.stick[-1]), "spence": punch.c, "stick_error": float(case.stick[-1]) / punch.c - 1.0,
        "goodman": goodman, "spread": float(np.ptp(half)),
        "central": case.central / case.hertz.pressure,
        "central_spence": punch.pressure_ratio * punch.load_ratio**(-1.0 / 3.0),
        "central_same_radius": case.central / case.hertz.pressure * case.hertz.radius / float(case.contact_radius[-1]),
        "central_same_radius_spence": punch.pressure_ratio,
        "radius": float(case.contact_radius[-1]) / radius - 1.0,
        "pressure_l2": relative_l2(case.pressure, np.where(inside, p * unit, 0.0)),
        "shear_l2": relative_l2(abs(case.radial("shear")), np.where(inside, q * unit, 0.0)),
        "passes": int(case.passes.max()), "least": float(case.dissipated.min()),
    }


def study_numbers(case):
    """What depends on the number of steps."""
    return {"steps": int(case.stick.size), "stick": float(case.stick[-1]), "difference": None,
            "central": case.central / case.hertz.pressure, "energy": float(np.sum(case.dissipated)),
            "passes": int(np.sum(case.passes))}


def print_numbers(numbers):
    """Print the tables."""
    print_table("Stick radius over contact radius, and contact radius, against Spence; Goodman's approximation; "
                "range over the second half of the load steps", {
                    "nu": ("poisson", "{:g}"), "beta": ("beta", "{:.3f}"), "mu": ("friction", "{:g}"),
                    "c/a": ("stick", "{:.4f}"), "Spence": ("spence", "{:.4f}"),
                    "/ Spence - 1": ("stick_error", "{:+.1e}"),
                    "Goodman": ("goodman", "{:.4f}"), "range": ("spread", "{:.4f}"), "a - 1": ("radius", "{:+.1e}"),
                    "passes": ("passes", "{:d}")}, numbers["cases"])
    print_table("Central pressure over Hertz's at equal load and at equal contact radius; fields against Spence's", {
        "nu": ("poisson", "{:g}"), "mu": ("friction", "{:g}"), "equal load": ("central", "{:.4f}"),
        "Spence": ("central_spence", "{:.4f}"), "equal radius": ("central_same_radius", "{:.4f}"),
        "Spence ": ("central_same_radius_spence", "{:.4f}"), "p, L2": ("pressure_l2", "{:.1e}"),
        "q, L2": ("shear_l2", "{:.1e}"), "least W_k, J": ("least", "{:.1e}")}, numbers["cases"])
    print_table("Number of load steps, nu = 0, mu = 0.2986", {
        "steps": ("steps", "{:d}"), "c/a": ("stick", "{:.4f}"), "c/a - Spence": ("difference", "{:+.4f}"),
        "central": ("central", "{:.4f}"), "energy, J": ("energy", "{:.4e}"), "all passes": ("passes", "{:d}")},
        numbers["study"])
    stick = loop_analytic.SpencePunch(1.0, 0.5)
    print("\nreference without any slip, beta = 0.5: central pressure {:.4f}, at equal radius {:.4f}".format(
        stick.pressure_ratio * stick.load_ratio**(-1.0 / 3.0), stick.pressure_ratio))
    print("without coupling: central pressure {:.4f}, greatest shear {:g} Pa".format(
        numbers["uncoupled"]["central"], numbers["uncoupled"]["shear"]))


# ---------------------------------------------------------------- drawing

def panel_friction(axes, cases):
    """c/a against mu for the three beta, Spence's line and Goodman's."""
    ratios = np.concatenate([np.linspace(0.02, 0.9, 16), [0.94, 0.97, 0.985]])
    fine = np.linspace(ratios[0], ratios[-1], 300)
    for poisson, group in cases.items():
        beta, tint = group[0].beta, TINTS[poisson]
        line = PchipInterpolator(ratios, [loop_analytic.spence_friction(c, beta) for c in ratios])
        axes.plot(line(fine), fine, color=tint, linewidth=1.3, zorder=2)
        axes.plot(beta * loop_analytic.goodman_friction(fine), fine, "--", color=tint, linewidth=0.8, zorder=2)
        axes.plot([case.friction for case in group], [case.stick[-1] for case in group], "o", color=tint, markersize=5,
                  markerfacecolor="white", zorder=3, label=r"$\nu = {}$, $\beta = {:.3g}$".format(poisson, beta))
    axes.plot([], [], color="0.4", linewidth=1.3, label="Spence")
    axes.plot([], [], "--", color="0.4", linewidth=0.8, label="Goodman")
    axes.set(xlabel=r"$\mu$", ylabel="$c/a$", xlim=(0.0, 1.05), ylim=(0.0, 1.02), title="Stick radius against friction")
    axes.legend(loc="lower right")


def panel_load(axes, cases):
    """c/a of every load step."""
    for case, mark in zip(cases, ("o-", "s-", "^-")):
        tint = TINTS["{:g}".format(case.poisson)]
        axes.plot(case.load / case.load[-1], case.stick, mark, color=tint, markersize=3.4, markerfacecolor="white",
                  linewidth=0.8, label=r"$\beta = {:.3g}$, $\mu = {:g}$".format(case.beta, case.friction))
        axes.axhline(case.reference().c, color=tint, linewidth=0.8, linestyle=":")
    axes.set(xlabel="$N_k/N$", ylabel="$c/a$", ylim=(0.0, 1.0), title="The same at every load (dotted: Spence)")
    axes.legend(loc="lower right")


def panel_steps(axes, study, limit):
    """Error of c/a against the number of steps."""
    steps = np.array([case.stick.size for case in study], dtype=float)
    axes.loglog(steps, [limit - case.stick[-1] for case in study], "o-", color=TINTS["0"], linewidth=1.0, markersize=5,
                markerfacecolor="white", label="petsam")
    axes.loglog(steps, 0.08 / steps, ":", color="0.5", linewidth=1.0, label="slope -1")
    axes.set(xlabel="load steps", ylabel="Spence's $c/a$ - petsam's",
             title=r"Number of steps, $\mu = 0.2986$, $\nu = 0$")
    axes.set_xticks(steps, ["{:g}".format(s) for s in steps])
    axes.minorticks_off()
    axes.legend(loc="upper right")


def figure_stick(directory, cases, study):
    """The stick radius in three panels."""
    figure, axes = plt.subplots(1, 3, figsize=(14.0, 4.4), constrained_layout=True)
    panel_friction(axes[0], cases)
    shown = [case for case in cases["0"] if case.name in (MAIN, "nu0_mu0.5")]
    panel_load(axes[1], [*shown, cases["0.3"][1]])
    panel_steps(axes[2], study, next(case for case in shown if case.name == MAIN).reference().c)
    save(figure, directory, "stick.png")


def figure_fields(directory, case, uncoupled):
    """Pressure, shear and slip of one case over r/a, every cell of a sector, against the reference."""
    punch = case.reference()
    radius = case.expected_radius(punch)
    unit = case.hertz.pressure * radius / case.hertz.radius
    rho = np.sin(0.5 * np.pi * np.linspace(1e-3, 1.0 - 1e-6, 400))
    p, q = punch.sphere(rho)
    angle = np.arctan2(case.y[:, None], case.x[None, :])
    keep = (angle > 0.0) & (angle < 0.25 * np.pi) & (case.r < 1.15 * radius)
    keep &= np.random.default_rng(1).random(keep.shape) < 200.0 / np.count_nonzero(keep)
    figure, axes = plt.subplots(1, 3, figsize=(13.0, 4.2), constrained_layout=True)
    shear, slip = np.hypot(case.shear_x, case.shear_y)[keep], np.hypot(case.slip_x, case.slip_y)[keep]
    style = {"markersize": 3.4, "markerfacecolor": "white", "markeredgewidth": 0.8, "linestyle": "none", "marker": "o"}
    r = case.r[keep] / radius
    axes[0].plot(rho, p * unit / case.hertz.pressure, color="0.35", linewidth=1.2, label="Spence")
    axes[0].plot(r, case.pressure[keep] / case.hertz.pressure, color=TINTS["0"], label="petsam", **style)
    order = np.argsort(uncoupled.r[keep])
    axes[0].plot(uncoupled.r[keep][order] / radius, uncoupled.pressure[keep][order] / case.hertz.pressure, "--",
                 color=TINTS["0.3"], linewidth=1.0, label="petsam, -coupling none")
    axes[0].set(title="Pressure", ylabel=r"$p/p_0$")
    axes[1].plot(rho, q * unit / case.hertz.pressure, color="0.35", linewidth=1.2, label="Spence")
    axes[1].plot(rho, case.friction * p * unit / case.hertz.pressure, ":", color="0.35", linewidth=1.0,
                 label=r"$\mu p$")
    axes[1].plot(r, shear / case.hertz.pressure, color=TINTS["0"], label="petsam", **style)
    axes[1].set(title="Shear", ylabel=r"$|q|/p_0$")
    axes[2].plot(r, slip / case.hertz.approach, color=TINTS["0"], label="petsam", **style)
    axes[2].axvline(punch.c, color="0.35", linestyle=":", linewidth=1.0, label="Spence's $c/a$")
    axes[2].set(title="Tangential displacement since the start", ylabel=r"$|s|/\delta_H$")
    for panel in axes:
        panel.set(xlabel="$r/a$", xlim=(0.0, 1.15))
        panel.set_ylim(bottom=0.0)
        panel.legend(loc="upper left" if panel is axes[2] else "best")
    figure.suptitle("{} x {} cells, {} steps, $\\nu = {:g}$, $\\mu = {:g}$;  $p_0$, $\\delta_H$: Hertz at the same load"
                    .format(case.x.size, case.y.size, case.stick.size, case.poisson, case.friction),
                    fontsize=9, color="0.35")
    save(figure, directory, "fields.png")


# ---------------------------------------------------------------- program

def run(options):
    """Read, print the numbers, draw."""
    cases = {nu: [Press(options.directory, "nu{}_mu{}".format(nu, mu)) for mu in group]
             for nu, group in FRICTION.items()}
    uncoupled = Press(options.directory, UNCOUPLED)
    study = [Press(options.directory, "steps{}".format(k)) for k in STEPS]
    limit = study[0].reference().c
    numbers = {
        "cases": [case_numbers(case) for case in (case for group in cases.values() for case in group)],
        "study": [dict(study_numbers(case), difference=float(case.stick[-1]) - limit) for case in study],
        "uncoupled": {"central": uncoupled.central / uncoupled.hertz.pressure,
                      "shear": float(np.max(np.hypot(uncoupled.shear_x, uncoupled.shear_y)))},
    }
    print_numbers(numbers)
    figures = finish_numbers(options, numbers)
    with plt.rc_context(STYLE):
        figure_stick(figures, cases, study)
        figure_fields(figures, next(case for case in cases["0"] if case.name == MAIN), uncoupled)


if __name__ == "__main__":
    sys.exit(main(run, __doc__, "dissimilar"))
