"""Compare the fretting-loop example's results with Mindlin and Deresiewicz.

Reads the HDF5 files that examples/fretting-loop/run.sh writes to a directory, draws loops.png (tangential force
against displacement), energy.png (dissipated energy a step, and its dependence on the number of steps) and slip.png
(slip at the end), and prints the deviations. The closed-form solutions get material, load and radius from the files.

"Cycle" is the one from the first to the second positive peak. All numbers are relative: displacements to the loop's
amplitude, forces to mu N, energies to the closed form or to the loop's area.
"""

import os
import sys
from pathlib import Path

import numpy as np

import petsam
from petsam.closed import Spheres, loop
from petsam.plot.style import CLOSED, COLORS, extent, field, frame, joined, log_ticks, note, plt, points, save

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402

PARTIAL = ("partial_nu0", "partial_nu0.3")
GROSS = ("gross_nu0", "gross_nu0.3")
STUDY = ("steps20", "steps40", "steps80", "steps160")


class Loop(petsam.Snapshot):
    """One result, with the closed solution for its parameters; SI units.

    load, displacement, dissipated: a value a load step; limit = mu N; gross: displacement of incipient sliding;
    peaks: steps of the positive peaks of what is controlled, amplitude: its value there.
    """

    def __init__(self, directory, name):
        super().__init__(petsam.open(os.path.join(directory, name + ".h5")))
        history = self.results.history
        if np.any(history["status"] != 0):
            raise petsam.Error(f"{self.results.path}: a step did not converge")
        self.name, self.time = name, history["time"]
        self.load, self.displacement = history["load_tx"], history["disp_x"]
        self.dissipated, self.residual = history["dissipated_energy"], float(history["tangential_residual"].max())
        self.spheres = Spheres.of(self.parameters, float(history["load_n"][0]))
        self.poisson, self.limit, self.gross = self.spheres.bodies.poisson1, self.spheres.limit, self.spheres.gross
        self.force_controlled = name not in GROSS
        controlled = self.load if self.force_controlled else self.displacement
        self.peaks = np.flatnonzero(controlled >= controlled.max() * (1.0 - 1e-9))
        if self.peaks.size < 2:
            raise petsam.Error(f"{self.results.path}: no closed cycle")
        self.amplitude = float(controlled.max())
        # the steps after the first peak, up to the second
        self.cycle = slice(self.peaks[0] + 1, self.peaks[1] + 1)

    @property
    def steps(self):
        """Load steps of the cycle."""
        return int(self.peaks[1] - self.peaks[0])

    def exact(self, branch, given):
        """Closed solution for the controlled quantity given, on branch "first", "down" or "up"."""
        a, scales = self.amplitude, (self.limit, self.gross)
        if self.force_controlled:
            first, masing = loop.first_loading, loop.masing_displacement
            load, displacement = a, float(first(a, *scales))
        else:
            first, masing = loop.sliding_displacement_load, loop.sliding_masing_load
            load, displacement = float(first(a, *scales)), a
        if branch == "first":
            return first(given, *scales)
        sign = 1.0 if branch == "down" else -1.0
        return masing(given, sign * load, sign * displacement, *scales)

    def exact_energy(self):
        """Energy of a cycle, J."""
        energy = loop.partial_loop_energy if self.force_controlled else loop.sliding_loop_energy
        return float(energy(self.amplitude, self.limit, self.gross))

    def branches(self):
        """Name and steps of the first loading, unloading and reloading."""
        first, second = self.peaks[:2]
        middle = (first + second) // 2
        return {"first": slice(0, first + 1), "down": slice(first, middle + 1), "up": slice(middle, second + 1)}

    def work(self, earlier):
        """Sum over the cycle of [(1 - earlier) T_k + earlier T_(k-1)] (d_k - d_(k-1)), J; 1/2: the trapezoidal rule."""
        k = np.arange(self.cycle.start, self.cycle.stop)
        load = (1.0 - earlier) * self.load[k] + earlier * self.load[k - 1]
        return float(np.sum(load * (self.displacement[k] - self.displacement[k - 1])))


# ---------------------------------------------------------------- numbers


def loop_numbers(case):
    """Deviations of one loop from the closed solution."""
    result = {"case": case.name, "poisson": case.poisson, "steps": case.steps, "residual": case.residual}
    given, answer = (case.load, case.displacement) if case.force_controlled else (case.displacement, case.load)
    scale = np.max(np.abs(case.exact("first", case.amplitude)))
    for name, part in case.branches().items():
        result[name] = float(np.max(np.abs(answer[part] - case.exact(name, given[part]))) / scale)
    first, second = case.peaks[:2]
    energy, area = float(np.sum(case.dissipated[case.cycle])), case.work(0.5)
    result.update(
        {
            "closure": float(abs(answer[second] - answer[first]) / np.max(np.abs(answer))),
            "energy": energy,
            "energy_exact": energy / case.exact_energy() - 1.0,
            "energy_trapezoid": energy / area - 1.0,
            "backward_trapezoid": case.work(0.0) / area - 1.0,
            "least": float(np.min(case.dissipated) / energy),
        }
    )
    return result


def identity_error(case):
    """How well area - dissipated = 1/2 sum (q_k - q_(k-1)).(s_k - s_(k-1)) dA holds, over their difference's size."""
    if len(case.results.steps) != case.time.size:
        raise petsam.Error(f"{case.results.path}: the fields of every step are needed")
    total = 0.0
    for k in range(case.cycle.start, case.cycle.stop):
        for name in ("x", "y"):
            change_q, change_s = (
                case.results.field(kind + name, k) - case.results.field(kind + name, k - 1)
                for kind in ("shear_", "slip_")
            )
            total += 0.5 * case.dx * case.dy * float(np.sum(change_q * change_s))
    difference = case.work(0.5) - float(np.sum(case.dissipated[case.cycle]))
    return {"difference": difference, "half_sum": total, "error": abs(difference - total) / case.work(0.5)}


def exact_partial_steps(case):
    """Energy of each step from Mindlin-Deresiewicz: a branch dissipates twice what a first loading to half does."""

    def first(load):
        return 0.25 * loop.partial_loop_energy(load, case.limit, case.gross)

    total, turn, scale = np.zeros(case.load.size), 0.0, 1.0
    for k in range(1, case.load.size):
        before = scale * first(abs(case.load[k - 1] - turn) / scale)
        total[k] = scale * first(abs(case.load[k] - turn) / scale) - before
        if abs(abs(case.load[k]) - case.amplitude) < 1e-9 * case.amplitude:
            turn, scale = case.load[k], 2.0
    return total


# ---------------------------------------------------------------- drawing


def panel_loop(axes, case, tint, title, limits):
    """T/(mu N) against d_x over the gross-slip displacement: both cycles as points, the closed solution as a line."""
    # dense at the turning points, where the branches are steepest
    fine = case.amplitude * np.cos(np.linspace(0.0, np.pi, 2001))
    for name, given in (("first", fine[fine >= 0.0]), ("down", fine), ("up", fine)):
        answer = case.exact(name, given)
        displacement, load = (answer, given) if case.force_controlled else (given, answer)
        axes.plot(
            displacement / case.gross,
            load / case.limit,
            zorder=2,
            linestyle="--" if name == "first" else "-",
            label={"first": "Cattaneo-Mindlin", "down": "Masing"}.get(name),
            **CLOSED,
        )
    points(
        axes,
        case.displacement / case.gross,
        case.load / case.limit,
        tint,
        markersize=3.4,
        markeredgewidth=0.9,
        label="petsam, two cycles",
    )
    frame(axes, title, r"$d_x/\delta_0$", r"$T_x/(\mu N)$", *limits)
    axes.legend(loc="upper left", borderpad=0.2, handlelength=1.8)


def figure_loops(directory, partial, gross):
    """The four loops."""
    figure, axes = plt.subplots(2, 2, figsize=(10.4, 8.2), constrained_layout=True)
    for row, cases, what, limits in (
        (axes[0], partial, "partial slip, force control", ((-0.82, 0.82), (-0.95, 1.25))),
        (axes[1], gross, "gross slip, displacement control", ((-2.2, 2.2), (-1.15, 1.6))),
    ):
        for panel, case, tint in zip(row, cases, COLORS):
            panel_loop(panel, case, tint, rf"{what}, $\nu = {case.poisson:g}$", limits)
    note(
        figure,
        f"{partial[0].x.size} x {partial[0].y.size} cells, {partial[0].steps} steps per cycle;  "
        "$\\delta_0$: displacement of incipient sliding",
    )
    save(figure, directory, "loops.png")


def panel_energy(axes, cases, title):
    """Energy of each step."""
    for case, tint, mark in zip(cases, COLORS, ("o", "+")):
        style = {"markersize": 3.2 if mark == "o" else 5.0, "markeredgewidth": 0.8}
        label, energy = rf"petsam, $\nu = {case.poisson:g}$", case.dissipated[1:] / (case.limit * case.gross)
        points(axes, case.time[1:], energy, tint, mark, label=label, **style)
    frame(axes, "Dissipated a step, " + title, "cycles", r"$W_k/(\mu N \delta_0)$", (0, 2))


def panel_steps(axes, study):
    """The energy's errors against the number of steps a cycle."""
    steps = np.array([row["steps"] for row in study], dtype=float)
    for key, label, tint, mark in (
        ("energy_trapezoid", "dissipated / area", COLORS[0], "o-"),
        ("energy_exact", "dissipated / closed form", COLORS[1], "s-"),
        ("backward_trapezoid", r"$\sum T_k \Delta d_k$ / area", "0.35", "^-"),
    ):
        joined(axes, steps, [abs(row[key]) for row in study], tint, mark, label=label)
    reference = abs(study[0]["energy_trapezoid"]) * (steps[0] / steps) ** 2
    axes.plot(steps, 0.5 * reference, ":", color="0.5", linewidth=1.0, label="slope -2")
    frame(axes, "Energy of the cycle", "steps per cycle", "abs(ratio - 1)")
    log_ticks(axes, steps)
    axes.legend(loc="center left", bbox_to_anchor=(0.0, 0.24), borderpad=0.2)


def figure_energy(directory, partial, gross, study):
    """Energy a step for the two kinds of loop, and the energy's errors against the number of steps."""
    figure, axes = plt.subplots(1, 3, figsize=(13.0, 4.1), constrained_layout=True)
    first, unit = partial[0], partial[0].limit * partial[0].gross
    axes[0].plot(first.time[1:], exact_partial_steps(first)[1:] / unit, label="Mindlin-Deresiewicz", zorder=2, **CLOSED)
    panel_energy(axes[0], partial, "partial slip")
    panel_energy(axes[1], gross, "gross slip")
    axes[0].legend(loc="upper center", borderpad=0.2)
    axes[1].legend(loc="upper left", ncol=2, borderpad=0.2)
    axes[0].set_ylim(top=1.35 * float(np.max(first.dissipated)) / unit)
    axes[1].set_ylim(top=0.115 * 80.0 / first.steps)
    panel_steps(axes[2], study)
    save(figure, directory, "energy.png")


def figure_slip(directory, cases):
    """s_x at the end of the second cycle over the gross-slip displacement, open cells blank."""
    figure, axes = plt.subplots(1, len(cases), figsize=(5.1 * len(cases), 4.5), constrained_layout=True, squeeze=False)
    maps = [np.where(case["pressure"] > 0.0, case["slip_x"] / case.gross, np.nan) for case in cases]
    low, high = min(0.0, *map(np.nanmin, maps)), max(map(np.nanmax, maps))
    for panel, case, slip in zip(axes[0], cases, maps):
        a = case.spheres.hertz.radius
        image = field(panel, slip, extent(case.x, case.y, a), low, high)
        for ratio, style in ((1.0, "-"), (case.spheres.stick_radius(case.amplitude) / a, "--")):
            panel.add_patch(plt.Circle((0, 0), ratio, fill=False, color="0.6", linestyle=style, linewidth=0.9))
        frame(panel, rf"$\nu = {case.poisson:g}$", "$x/a$", "$y/a$", (-1.15, 1.15), (-1.15, 1.15))
        figure.colorbar(image, ax=panel, label=r"$s_x/\delta_0$", shrink=0.85)
    note(figure, "residual slip at $T_x = 0$ after two cycles of partial slip;  dashed: stick radius at the peaks")
    save(figure, directory, "slip.png")


# ---------------------------------------------------------------- program


class Comparison:
    """All results of a directory."""

    def __init__(self, directory):
        self.partial, self.gross, study = (
            [Loop(directory, name) for name in names] for names in (PARTIAL, GROSS, STUDY)
        )
        self.numbers = {
            "loops": [loop_numbers(case) for case in self.partial + self.gross],
            "study": [loop_numbers(case) for case in study],
            "identity": identity_error(study[0]),
        }

    def tables(self):
        """Deviations, energies, their dependence on the number of steps."""
        yield (
            "Loops against Mindlin-Deresiewicz (maximum deviation over the amplitude)",
            "case = case; first = first:.1e; unloading = down:.1e; reloading = up:.1e; closure = closure:.1e",
            self.numbers["loops"],
        )
        energies = (
            "steps = steps:d; energy, J = energy:.5e; / exact - 1 = energy_exact:+.1e; "
            "/ area - 1 = energy_trapezoid:+.1e; T_k dd_k - 1 = backward_trapezoid:+.1e; least step = least:.1e"
        )
        yield (
            "Dissipated energy of the cycle (area: trapezoidal rule; T_k dd_k: backward sum over that area; least: "
            "smallest step over the cycle)",
            "case = case; " + energies,
            self.numbers["loops"],
        )
        yield "Number of steps per cycle, T_x between +-0.8 mu N, nu = 0", energies, self.numbers["study"]
        identity = self.numbers["identity"]
        yield (
            "\narea - dissipated = {difference:.6e} J, 1/2 sum dq.ds dA = {half_sum:.6e} J, "
            "difference {error:.0e} of the area".format(**identity)
        )

    def draw(self, directory):
        """The three pictures."""
        figure_loops(directory, self.partial, self.gross)
        figure_energy(directory, self.partial, self.gross, self.numbers["study"])
        figure_slip(directory, self.partial)


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "fretting-loop"))
