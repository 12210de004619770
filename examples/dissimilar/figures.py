"""Compare the dissimilar example's results (elastic sphere on a rigid flat, friction, growing load) with Spence.

Reads the HDF5 files that examples/dissimilar/run.sh writes to a directory, draws stick.png (stick radius against
friction, against the load, and against the number of steps) and fields.png (pressure, shear and slip over r/a), and
prints the numbers. The reference is petsam.closed.spence.SpencePunch, a solution of the axisymmetric equations that
shares nothing with petsam; Goodman's closed relation is its approximation.

Stick ratio is sqrt(stick_area/contact_area), central pressure the mean of the four cells nearest the axis. Hertz's
pressure is that of the same load without friction; what is called "equal radius" is Hertz's for the computed radius.
"""

import os
import sys
from functools import cached_property
from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator

import petsam
from petsam.closed import Spheres, spence
from petsam.plot.style import CLOSED, COLORS, frame, joined, log_ticks, note, plt, points, save

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402
from comparison import relative_l2  # noqa: E402

FRICTION = {
    "0": ("0.2", "0.2986", "0.4", "0.5", "0.65", "1"),
    "0.2": ("0.15", "0.2", "0.3", "0.4"),
    "0.3": ("0.1", "0.15", "0.2", "0.3"),
}
MAIN = "nu0_mu0.2986"
UNCOUPLED = "uncoupled"
STEPS = (1, 2, 5, 10, 20, 40)
TINTS = {"0": COLORS[0], "0.2": "#2a9d72", "0.3": COLORS[1]}


class Press(petsam.Snapshot):
    """One result with Hertz's contact and Spence's reference for it, SI units; stick is c/a of every load step."""

    def __init__(self, directory, name):
        super().__init__(petsam.open(os.path.join(directory, name + ".h5")))
        history = self.results.history
        if np.any(history["status"] != 0):
            raise petsam.Error(f"{self.results.path}: a step did not converge")
        self.name, self.load, self.passes = name, history["load_n"], history["coupling_iterations"]
        self.dissipated = history["dissipated_energy"]
        self.stick = np.sqrt(history["stick_area"] / history["contact_area"])
        spheres = Spheres.of(self.parameters, float(self.load[-1]))
        self.hertz, self.friction, self.poisson = spheres.hertz, spheres.friction, spheres.bodies.poisson1
        self.beta = spheres.bodies.dundurs_beta
        nearest = np.argsort(self.r, axis=None)[:4]
        self.central = float(np.mean(self["pressure"].ravel()[nearest])) / self.hertz.pressure

    def radial(self, name):
        """The outward part of shear or slip."""
        return (self.x[None, :] * self[name + "_x"] + self.y[:, None] * self[name + "_y"]) / self.r

    @cached_property
    def reference(self):
        """The SpencePunch of this friction and beta."""
        return spence.spence_punch(self.friction, self.beta)

    @property
    def reference_radius(self):
        """Contact radius, m, of the reference at the same load."""
        return self.hertz.radius * self.reference.load_ratio ** (-1.0 / 3.0)

    @property
    def reference_unit(self):
        """Hertz's p0, Pa, for the reference's radius: proportional to that radius."""
        return self.hertz.pressure * self.reference_radius / self.hertz.radius


# ---------------------------------------------------------------- numbers


def case_numbers(case):
    """Stick radius, contact radius and central pressure against the reference."""
    punch, a, unit = case.reference, case.reference_radius, case.reference_unit
    radius = case.radius("contact_area")
    table = np.sin(0.5 * np.pi * np.linspace(1e-4, 1.0 - 1e-6, 800))
    p, q = (np.where(case.r < a, unit * np.interp(case.r / a, table, field), 0.0) for field in punch.sphere(table))
    return {
        "poisson": case.poisson,
        "beta": case.beta,
        "friction": case.friction,
        "steps": int(case.stick.size),
        "stick": float(case.stick[-1]),
        "spence": punch.c,
        "stick_error": float(case.stick[-1]) / punch.c - 1.0,
        "goodman": spence.goodman_ratio(case.friction / case.beta),
        "spread": float(np.ptp(case.stick[case.stick.size // 2 :])),
        "central": case.central,
        "central_spence": punch.pressure_ratio * punch.load_ratio ** (-1.0 / 3.0),
        "central_same_radius": case.central * case.hertz.radius / radius,
        "central_same_radius_spence": punch.pressure_ratio,
        "radius": radius / a - 1.0,
        "pressure_l2": relative_l2(case["pressure"], p),
        "shear_l2": relative_l2(abs(case.radial("shear")), q),
        "passes": int(case.passes.max()),
        "least": float(case.dissipated.min()),
    }


def study_numbers(case, limit):
    """What depends on the number of steps; limit: the reference's c/a."""
    return {
        "steps": int(case.stick.size),
        "stick": float(case.stick[-1]),
        "difference": float(case.stick[-1]) - limit,
        "central": case.central,
        "energy": float(np.sum(case.dissipated)),
        "passes": int(np.sum(case.passes)),
    }


# ---------------------------------------------------------------- drawing


def panel_friction(axes, cases):
    """c/a against mu for the three beta, Spence's line and Goodman's."""
    ratios = np.concatenate([np.linspace(0.02, 0.9, 16), [0.94, 0.97, 0.985]])
    fine = np.linspace(ratios[0], ratios[-1], 300)
    for poisson, group in cases.items():
        beta, tint = group[0].beta, TINTS[poisson]
        line = PchipInterpolator(ratios, [spence.spence_friction(c, beta) for c in ratios])
        axes.plot(line(fine), fine, color=tint, linewidth=1.3, zorder=2)
        axes.plot(beta * spence.goodman_friction(fine), fine, "--", color=tint, linewidth=0.8, zorder=2)
        computed = [case.friction for case in group], [case.stick[-1] for case in group]
        points(axes, *computed, tint, markersize=5, label=rf"$\nu = {poisson}$, $\beta = {beta:.3g}$")
    axes.plot([], [], color="0.4", linewidth=1.3, label="Spence")
    axes.plot([], [], "--", color="0.4", linewidth=0.8, label="Goodman")
    frame(axes, "Stick radius against friction (points: petsam)", r"$\mu$", "$c/a$", (0.0, 1.05), (0.0, 1.02))
    axes.legend(loc="lower right")


def panel_load(axes, cases):
    """c/a of every load step."""
    for case, mark in zip(cases, ("o-", "s-", "^-")):
        tint = TINTS[f"{case.poisson:g}"]
        label = rf"$\beta = {case.beta:.3g}$, $\mu = {case.friction:g}$"
        joined(axes, case.load / case.load[-1], case.stick, tint, mark, markersize=3.4, linewidth=0.8, label=label)
        axes.axhline(case.reference.c, color=tint, linewidth=0.8, linestyle=":")
    frame(axes, "The same at every load (dotted: Spence)", "$N_k/N$", "$c/a$", None, (0.0, 1.0))
    axes.legend(loc="lower right")


def panel_steps(axes, study, limit):
    """Error of c/a against the number of steps."""
    steps = np.array([case.stick.size for case in study], dtype=float)
    joined(axes, steps, [limit - case.stick[-1] for case in study], TINTS["0"], "o-", label="petsam")
    axes.plot(steps, 0.08 / steps, ":", color="0.5", linewidth=1.0, label="slope $-1$")
    frame(axes, r"Number of steps, $\mu = 0.2986$, $\nu = 0$", "load steps", "Spence's $c/a$ minus petsam's")
    log_ticks(axes, steps)
    axes.legend(loc="upper right")


def figure_stick(directory, cases, study):
    """The stick radius in three panels."""
    figure, axes = plt.subplots(1, 3, figsize=(14.0, 4.4), constrained_layout=True)
    panel_friction(axes[0], cases)
    shown = [case for case in cases["0"] if case.name in (MAIN, "nu0_mu0.5")]
    panel_load(axes[1], [*shown, cases["0.3"][1]])
    panel_steps(axes[2], study, next(case for case in shown if case.name == MAIN).reference.c)
    save(figure, directory, "stick.png")


def figure_fields(directory, case, uncoupled):
    """Pressure, shear and slip of one case over r/a, some cells of a sector, against the reference."""
    a, p0, tint = case.reference_radius, case.hertz.pressure, TINTS["0"]
    rho = np.sin(0.5 * np.pi * np.linspace(1e-3, 1.0 - 1e-6, 400))
    p, q = (field * case.reference_unit / p0 for field in case.reference.sphere(rho))
    angle = np.arctan2(case.y[:, None], case.x[None, :])
    keep = (angle > 0.0) & (angle < 0.25 * np.pi) & (case.r < 1.15 * a)
    keep &= np.random.default_rng(1).random(keep.shape) < 200.0 / np.count_nonzero(keep)
    style = {"markersize": 3.4, "markeredgewidth": 0.8, "zorder": 2, "label": "petsam"}
    figure, axes = plt.subplots(1, 3, figsize=(13.0, 4.2), constrained_layout=True)
    for panel, exact, values in zip(
        axes, (p, q, None), (case["pressure"] / p0, case.shear / p0, case.slip / case.hertz.approach)
    ):
        if exact is not None:
            panel.plot(rho, exact, label="Spence", **CLOSED)
        if panel is axes[1]:
            panel.plot(rho, case.friction * p, ":", color="0.35", linewidth=1.0, label=r"$\mu p$")
        points(panel, case.r[keep] / a, values[keep], tint, **style)
    order = np.argsort(uncoupled.r[keep])
    style = {"color": TINTS["0.3"], "linewidth": 1.0, "label": "petsam, -coupling none"}
    axes[0].plot(uncoupled.r[keep][order] / a, uncoupled["pressure"][keep][order] / p0, "--", **style)
    axes[2].axvline(case.reference.c, color="0.35", linestyle=":", linewidth=1.0, label="Spence's $c/a$")
    for panel, title, text in zip(
        axes,
        ("Pressure", "Shear", "Tangential displacement since the start"),
        (r"$p/p_0$", r"$|q|/p_0$", r"$|s|/\delta_H$"),
    ):
        frame(panel, title, "$r/a$", text, (0.0, 1.15), (0.0, None))
        panel.legend(loc="upper left" if panel is axes[2] else "best")
    note(
        figure,
        f"{case.x.size} x {case.y.size} cells, {case.stick.size} steps, $\\nu = {case.poisson:g}$, "
        f"$\\mu = {case.friction:g}$;  $p_0$, $\\delta_H$: Hertz at the same load",
    )
    save(figure, directory, "fields.png")


# ---------------------------------------------------------------- program


class Comparison:
    """All results of a directory."""

    def __init__(self, directory):
        self.cases = {nu: [Press(directory, f"nu{nu}_mu{mu}") for mu in group] for nu, group in FRICTION.items()}
        self.main = next(case for case in self.cases["0"] if case.name == MAIN)
        self.uncoupled = Press(directory, UNCOUPLED)
        self.study = [Press(directory, f"steps{k}") for k in STEPS]
        self.numbers = {
            "cases": [case_numbers(case) for group in self.cases.values() for case in group],
            "study": [study_numbers(case, self.study[0].reference.c) for case in self.study],
            "uncoupled": {"central": self.uncoupled.central, "shear": float(np.max(self.uncoupled.shear))},
        }

    def tables(self):
        """The tables."""
        yield (
            "Stick radius over contact radius, and contact radius, against Spence; Goodman's approximation; "
            "range over the second half of the load steps",
            (
                "nu = poisson:g; beta = beta:.3f; mu = friction:g; c/a = stick:.4f; Spence = spence:.4f; "
                "/ Spence - 1 = stick_error:+.1e; Goodman = goodman:.4f; range = spread:.4f; a - 1 = radius:+.1e; "
                "passes = passes:d"
            ),
            self.numbers["cases"],
        )
        yield (
            "Central pressure over Hertz's at equal load and at equal contact radius; fields against Spence's",
            (
                "nu = poisson:g; mu = friction:g; equal load = central:.4f; Spence = central_spence:.4f; "
                "equal radius = central_same_radius:.4f; Spence = central_same_radius_spence:.4f; "
                "p, L2 = pressure_l2:.1e; q, L2 = shear_l2:.1e; least W_k, J = least:.1e"
            ),
            self.numbers["cases"],
        )
        yield (
            "Number of load steps, nu = 0, mu = 0.2986",
            (
                "steps = steps:d; c/a = stick:.4f; c/a - Spence = difference:+.4f; central = central:.4f; "
                "energy, J = energy:.4e; all passes = passes:d"
            ),
            self.numbers["study"],
        )
        stick = spence.SpencePunch(1.0, 0.5)
        central = stick.pressure_ratio * stick.load_ratio ** (-1.0 / 3.0)
        yield (
            f"\nreference without any slip, beta = 0.5: central pressure {central:.4f}, "
            f"at equal radius {stick.pressure_ratio:.4f}"
        )
        yield "without coupling: central pressure {central:.4f}, maximum shear {shear:g} Pa".format(
            **self.numbers["uncoupled"]
        )

    def draw(self, directory):
        """Both pictures."""
        figure_stick(directory, self.cases, self.study)
        figure_fields(directory, self.main, self.uncoupled)


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "dissimilar"))
