#!/usr/bin/env python3
"""Compare the fretting-loop example's results with Mindlin and Deresiewicz.

Reads the HDF5 files that examples/fretting-loop/run.sh writes to a directory, draws loops.png (tangential force
against displacement), energy.png (dissipated energy a step, and its dependence on the number of steps) and slip.png
(slip at the end), and prints the deviations. The closed solutions get material, load and radius from the files.

"Cycle" is the one from the first to the second positive peak. All numbers are relative: displacements to the loop's
amplitude, forces to mu N, energies to the closed form or to the loop's area.
"""
import os
import sys

import h5py
import numpy as np

import analytic
import loop_analytic
from figures import STYLE, InputError, finish_numbers, main, plt, print_table, save

PARTIAL = ("partial_nu0", "partial_nu0.3")
GROSS = ("gross_nu0", "gross_nu0.3")
STUDY = {20: "steps20", 40: "steps40", 80: "steps80", 160: "steps160"}
HISTORY = ("time", "load_n", "load_tx", "disp_x", "dissipated_energy", "stick_area", "tangential_residual", "status")
TINTS = ("#3b4cc0", "#c44e52")


class Loop:
    """The history of one HDF5 file, with Hertz's contact and the gross-slip displacement of its parameters; SI."""

    def __init__(self, directory, name):
        self.name, self.path = name, os.path.join(directory, name + ".h5")
        if not os.path.isfile(self.path):
            raise InputError("{}: no such file; run examples/fretting-loop/run.sh first".format(self.path))
        try:
            with h5py.File(self.path, "r") as file:
                self._read(file)
        except (OSError, KeyError, ValueError, IndexError) as error:
            raise InputError("{}: cannot be read: {}".format(self.path, error)) from error
        self.force_controlled = name not in GROSS
        controlled = self.load if self.force_controlled else self.displacement
        peaks = np.flatnonzero(controlled >= controlled.max() * (1.0 - 1e-9))
        if peaks.size < 2:
            raise InputError("{}: no closed cycle".format(self.path))
        self.peaks, self.amplitude = peaks, float(controlled.max())

    def _read(self, file):
        def parameter(name):
            return float(np.ravel(file.attrs[name])[0])

        bodies = [(parameter("body%d_young" % k), parameter("body%d_poisson" % k)) for k in (1, 2)]
        self.poisson = bodies[0][1]
        history = {name: file["history/" + name][:] for name in HISTORY}
        if np.any(history["status"] != 0):
            raise ValueError("a step did not converge")
        self.load, self.displacement, self.dissipated = (
            history[name] for name in ("load_tx", "disp_x", "dissipated_energy"))
        self.time, self.residual = history["time"], float(history["tangential_residual"].max())
        load_n = float(history["load_n"][0])
        radius = analytic.effective_radius(parameter("gap_radius1"), parameter("gap_radius2"))
        self.hertz = analytic.hertz(load_n, radius, analytic.effective_modulus(*bodies[0], *bodies[1]))
        moduli = [analytic.shear_modulus(*body) for body in bodies]
        compliance = analytic.tangential_compliance(moduli[0], bodies[0][1], moduli[1], bodies[1][1])
        friction = parameter("friction")
        self.limit = friction * load_n
        self.gross = analytic.cattaneo_displacement(
            self.hertz.radius, 0.0, friction * self.hertz.pressure, compliance)
        self.x, self.y = file["x"][:], file["y"][:]
        self.pressure, self.slip_x, self.slip_y = (file[k][-1] for k in ("pressure", "slip_x", "slip_y"))

    @property
    def steps(self):
        """Load steps of the cycle."""
        return int(self.peaks[1] - self.peaks[0])

    @property
    def cycle(self):
        """The steps after the first peak, up to the second."""
        return slice(self.peaks[0] + 1, self.peaks[1] + 1)

    def exact(self, branch, given):
        """Closed solution for the controlled quantity given, on branch "first", "down" or "up"."""
        a, scales = self.amplitude, (self.limit, self.gross)
        if self.force_controlled:
            first, masing = loop_analytic.first_loading, loop_analytic.masing_displacement
            load, displacement = a, float(first(a, *scales))
        else:
            first, masing = loop_analytic.sliding_displacement_load, loop_analytic.sliding_masing_load
            load, displacement = float(first(a, *scales)), a
        if branch == "first":
            return first(given, *scales)
        sign = 1.0 if branch == "down" else -1.0
        return masing(given, sign * load, sign * displacement, *scales)

    def exact_energy(self):
        """Energy of a cycle, J."""
        energy = loop_analytic.partial_loop_energy if self.force_controlled else loop_analytic.sliding_loop_energy
        return float(energy(self.amplitude, self.limit, self.gross))

    def branches(self):
        """Name and steps of the first loading, unloading and reloading."""
        first, second = self.peaks[0], self.peaks[1]
        middle = (first + second) // 2
        return {"first": slice(0, first + 1), "down": slice(first, middle + 1), "up": slice(middle, second + 1)}

    def trapezoid(self):
        """Area of the cycle by the trapezoidal rule, J."""
        k = np.arange(self.peaks[0], self.peaks[1])
        mean = 0.5 * (self.load[k + 1] + self.load[k])
        return float(np.sum(mean * (self.displacement[k + 1] - self.displacement[k])))

    def backward(self):
        """Sum of T_k (d_k - d_(k-1)) over the cycle, J."""
        k = np.arange(self.peaks[0] + 1, self.peaks[1] + 1)
        return float(np.sum(self.load[k] * (self.displacement[k] - self.displacement[k - 1])))


# ---------------------------------------------------------------- numbers

def loop_numbers(loop):
    """Deviations of one loop from the closed solution."""
    result = {"case": loop.name, "poisson": loop.poisson, "steps": loop.steps, "residual": loop.residual}
    given, answer = (loop.load, loop.displacement) if loop.force_controlled else (loop.displacement, loop.load)
    for name, part in loop.branches().items():
        exact = loop.exact(name, given[part])
        scale = np.max(np.abs(loop.exact("first", loop.amplitude)))
        result[name] = float(np.max(np.abs(answer[part] - exact)) / scale)
    first, second = loop.peaks[:2]
    result["closure"] = float(abs(answer[second] - answer[first]) / np.max(np.abs(answer)))
    energy = float(np.sum(loop.dissipated[loop.cycle]))
    result.update({
        "energy": energy, "energy_exact": energy / loop.exact_energy() - 1.0,
        "energy_trapezoid": energy / loop.trapezoid() - 1.0,
        "backward_trapezoid": loop.backward() / loop.trapezoid() - 1.0,
        "least": float(np.min(loop.dissipated) / energy)})
    return result


def identity_error(loop):
    """How well area - dissipated = 1/2 sum (q_k - q_(k-1)).(s_k - s_(k-1)) dA holds, over their difference's size."""
    with h5py.File(loop.path, "r") as file:
        if file["time"].size != loop.time.size:
            raise InputError("{}: the fields of every step are needed".format(loop.path))
        area = (loop.x[1] - loop.x[0]) * (loop.y[1] - loop.y[0])
        total = 0.0
        for k in range(loop.peaks[0] + 1, loop.peaks[1] + 1):
            for name in ("x", "y"):
                q, s = file["shear_" + name], file["slip_" + name]
                total += 0.5 * area * float(np.sum((q[k] - q[k - 1]) * (s[k] - s[k - 1])))
    difference = loop.trapezoid() - float(np.sum(loop.dissipated[loop.cycle]))
    return {"difference": difference, "half_sum": total, "error": abs(difference - total) / loop.trapezoid()}


def print_numbers(numbers):
    """Print the tables."""
    print_table("Loops against Mindlin-Deresiewicz (largest deviation over the amplitude)", {
        "case": ("case", "{}"), "first": ("first", "{:.1e}"), "unloading": ("down", "{:.1e}"),
        "reloading": ("up", "{:.1e}"), "closure": ("closure", "{:.1e}")}, numbers["loops"])
    energies = {
        "steps": ("steps", "{:d}"), "energy, J": ("energy", "{:.5e}"), "/ exact - 1": ("energy_exact", "{:+.1e}"),
        "/ area - 1": ("energy_trapezoid", "{:+.1e}"), "T_k dd_k - 1": ("backward_trapezoid", "{:+.1e}"),
        "least step": ("least", "{:.1e}")}
    print_table("Dissipated energy of the cycle (area: trapezoidal rule; T_k dd_k: backward sum over that area; least: "
                "smallest step over the cycle)", {"case": ("case", "{}"), **energies}, numbers["loops"])
    print_table("Number of steps a cycle, T_x between +-0.8 mu N, nu = 0", energies, numbers["study"])
    identity = numbers["identity"]
    print("\narea - dissipated = {:.6e} J, 1/2 sum dq.ds dA = {:.6e} J, difference {:.0e} of the area".format(
        identity["difference"], identity["half_sum"], identity["error"]))


# ---------------------------------------------------------------- drawing

def panel_loop(axes, loop, tint, title):
    """T/(mu N) against d_x over the gross-slip displacement: both cycles as points, the closed solution as a line."""
    a = loop.amplitude
    # dense at the turning points, where the branches are steepest
    fine = a * np.cos(np.linspace(0.0, np.pi, 2001))
    for name, given in (("first", fine[fine >= 0.0]), ("down", fine), ("up", fine)):
        pair = (loop.exact(name, given), given) if loop.force_controlled else (given, loop.exact(name, given))
        axes.plot(pair[0] / loop.gross, pair[1] / loop.limit, color="0.35", linewidth=1.2, zorder=2,
                  linestyle="--" if name == "first" else "-",
                  label={"first": "Cattaneo-Mindlin", "down": "Masing"}.get(name))
    axes.plot(loop.displacement / loop.gross, loop.load / loop.limit, "o", color=tint, markersize=3.4,
              markerfacecolor="white", markeredgewidth=0.9, zorder=3, label="petsam, two cycles")
    axes.set(title=title, xlabel=r"$d_x/\delta_0$", ylabel=r"$T_x/(\mu N)$")
    axes.legend(loc="upper left", borderpad=0.2, handlelength=1.8)


def figure_loops(directory, partial, gross):
    """The four loops."""
    figure, axes = plt.subplots(2, 2, figsize=(10.4, 8.2), constrained_layout=True)
    for row, (loops, what) in enumerate(((partial, "partial slip, force control"),
                                         (gross, "gross slip, displacement control"))):
        for column, loop in enumerate(loops):
            panel_loop(axes[row, column], loop, TINTS[column], r"{}, $\nu = {:g}$".format(what, loop.poisson))
            limits = ((-0.82, 0.82), (-0.95, 1.25)) if row == 0 else ((-2.2, 2.2), (-1.15, 1.6))
            axes[row, column].set(xlim=limits[0], ylim=limits[1])
    figure.suptitle("{} x {} cells, {} steps a cycle;  $\\delta_0$: displacement of incipient sliding".format(
        partial[0].x.size, partial[0].y.size, partial[0].steps), fontsize=9, color="0.35")
    save(figure, directory, "loops.png")


def exact_partial_steps(loop):
    """Energy of each step from Mindlin-Deresiewicz: a branch dissipates twice what a first loading to half does."""
    def first(load):
        return 0.25 * loop_analytic.partial_loop_energy(load, loop.limit, loop.gross)

    total, turn, scale = np.zeros(loop.load.size), 0.0, 1.0
    for k in range(1, loop.load.size):
        before = scale * first(abs(loop.load[k - 1] - turn) / scale)
        total[k] = scale * first(abs(loop.load[k] - turn) / scale) - before
        if abs(abs(loop.load[k]) - loop.amplitude) < 1e-9 * loop.amplitude:
            turn, scale = loop.load[k], 2.0
    return total


def figure_energy(directory, partial, gross, study):
    """Energy a step for the two kinds of loop, and the energy's errors against the number of steps."""
    figure, axes = plt.subplots(1, 3, figsize=(13.0, 4.1), constrained_layout=True)
    unit = partial[0].limit * partial[0].gross
    axes[0].plot(partial[0].time[1:], exact_partial_steps(partial[0])[1:] / unit, color="0.35", linewidth=1.2,
                 label="Mindlin-Deresiewicz", zorder=2)
    for panel, loops, title in ((axes[0], partial, "partial slip"), (axes[1], gross, "gross slip")):
        for loop, tint, mark in zip(loops, TINTS, ("o", "+")):
            panel.plot(loop.time[1:], loop.dissipated[1:] / (loop.limit * loop.gross), mark, color=tint,
                       markersize=3.2 if mark == "o" else 5.0, markerfacecolor="white",
                       markeredgewidth=0.8, label=r"petsam, $\nu = {:g}$".format(loop.poisson), zorder=3)
        panel.set(title="Dissipated a step, " + title, xlabel="cycles", ylabel=r"$W_k/(\mu N \delta_0)$", xlim=(0, 2))
        panel.legend(loc="upper center" if panel is axes[0] else "upper left", ncol=1 if panel is axes[0] else 2,
                     borderpad=0.2)
    axes[0].set_ylim(top=1.35 * float(np.max(partial[0].dissipated)) / unit)
    axes[1].set_ylim(top=0.115 * 80.0 / partial[0].steps)
    steps = np.array([row["steps"] for row in study], dtype=float)
    for key, label, tint, mark in (("energy_trapezoid", "dissipated / area", TINTS[0], "o"),
                                   ("energy_exact", "dissipated / closed form", TINTS[1], "s"),
                                   ("backward_trapezoid", r"$\sum T_k \Delta d_k$ / area", "0.35", "^")):
        axes[2].loglog(steps, [abs(row[key]) for row in study], mark + "-", color=tint, linewidth=1.0, markersize=5,
                       markerfacecolor="white", label=label)
    reference = abs(study[0]["energy_trapezoid"]) * (steps[0] / steps)**2
    axes[2].loglog(steps, 0.5 * reference, ":", color="0.5", linewidth=1.0, label="slope -2")
    axes[2].set(title="Energy of the cycle", xlabel="steps a cycle", ylabel="abs(ratio - 1)")
    axes[2].set_xticks(steps, ["{:g}".format(s) for s in steps])
    axes[2].minorticks_off()
    axes[2].legend(loc="center left", bbox_to_anchor=(0.0, 0.24), borderpad=0.2)
    save(figure, directory, "energy.png")


def figure_slip(directory, loops):
    """s_x at the end of the second cycle over the gross-slip displacement, open cells blank."""
    figure, axes = plt.subplots(1, len(loops), figsize=(5.1 * len(loops), 4.5), constrained_layout=True, squeeze=False)
    inside = [loop.slip_x[loop.pressure > 0.0] / loop.gross for loop in loops]
    low, high = (float(bound(np.concatenate(inside))) for bound in (np.min, np.max))
    for panel, loop in zip(axes[0], loops):
        a = loop.hertz.radius
        slip = np.where(loop.pressure > 0.0, loop.slip_x / loop.gross, np.nan)
        extent = [v / a for v in (loop.x[0], loop.x[-1], loop.y[0], loop.y[-1])]
        image = panel.imshow(slip, origin="lower", extent=extent, cmap="viridis", vmin=min(0.0, low), vmax=high)
        for ratio, style in ((1.0, "-"), (np.cbrt(1.0 - loop.amplitude / loop.limit), "--")):
            panel.add_patch(plt.Circle((0, 0), ratio, fill=False, color="0.6", linestyle=style, linewidth=0.9))
        panel.set(title=r"$\nu = {:g}$".format(loop.poisson), xlabel="$x/a$", ylabel="$y/a$",
                  xlim=(-1.15, 1.15), ylim=(-1.15, 1.15))
        panel.grid(False)
        figure.colorbar(image, ax=panel, label=r"$s_x/\delta_0$", shrink=0.85)
    figure.suptitle("residual slip at $T_x = 0$ after two cycles of partial slip;  dashed: stick radius at the peaks",
                    fontsize=9, color="0.35")
    save(figure, directory, "slip.png")


# ---------------------------------------------------------------- program

def run(options):
    """Read, print the numbers, draw."""
    partial = [Loop(options.directory, name) for name in PARTIAL]
    gross = [Loop(options.directory, name) for name in GROSS]
    study = [Loop(options.directory, name) for name in STUDY.values()]
    numbers = {
        "loops": [loop_numbers(loop) for loop in partial + gross],
        "study": [loop_numbers(loop) for loop in study],
        "identity": identity_error(study[0]),
    }
    print_numbers(numbers)
    figures = finish_numbers(options, numbers)
    with plt.rc_context(STYLE):
        figure_loops(figures, partial, gross)
        figure_energy(figures, partial, gross, numbers["study"])
        figure_slip(figures, partial)


if __name__ == "__main__":
    sys.exit(main(run, __doc__, "fretting-loop"))
