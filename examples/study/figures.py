"""Draw the study example: stick radius and dissipated energy over T_x/(mu N), for several mu and nu.

Reads results.h5 of petsam-study in a directory, and the results of each case; draws study.png and prints the deviations
from Cattaneo, Mindlin and Deresiewicz. All numbers are relative: the stick radius, sqrt(stick_area/pi), to that of the
contact; the energy of the closed cycle (from the first to the second peak) to mu N delta_0 or to its closed form,
delta_0 being the displacement of incipient sliding.
"""

import os
import sys
from pathlib import Path

import h5py
import numpy as np

import petsam
from petsam.apps.study.runs import RESULTS
from petsam.closed import Spheres, cattaneo_stick_radius
from petsam.closed.loop import partial_loop_energy
from petsam.plot.style import CLOSED, COLORS, frame, plt, points, save

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402

MARKS = ("o", "+", "x")
PEAK, SECOND_PEAK = 1, 3  # steps of the table's history


def row(path, inputs):
    """A case's inputs, stick radius, energy, and the closed solution for its own parameters."""
    with petsam.open(path) as results:
        history = results.history
        if history["time"].size != SECOND_PEAK + 1 or np.any(history["status"] != 0):
            raise petsam.Error(f"{path}: the case has not finished")
        spheres = Spheres.of(results.parameters, history["load_n"][-1])
    unit = spheres.limit * spheres.gross
    energy = history["dissipated_energy"][PEAK + 1 :].sum()
    exact = partial_loop_energy(history["load_tx"][-1], spheres.limit, spheres.gross)
    return {
        **inputs,
        "radius": np.sqrt(history["stick_area"][-1] / history["contact_area"][-1]),
        "radius_exact": cattaneo_stick_radius(inputs["ratio"], 1.0),
        "energy": energy / unit,
        "energy_exact": exact / unit,
        "deviation": energy / exact - 1.0,
    }


def read(directory):
    """The rows of all cases, as arrays by name."""
    path = os.path.join(directory, "results.h5")
    if not os.path.exists(path):
        raise petsam.Missing(f"{path}: no such file")
    try:
        with h5py.File(path, "r") as file:
            names = file["case"].asstr()[:]
            inputs = {key: file["inputs"][key][:] for key in ("ratio", "mu", "nu")}
    except (OSError, KeyError) as error:
        raise petsam.Error(f"{path}: is not a table of petsam-study: {error}") from error
    rows = [
        row(os.path.join(directory, name, RESULTS), {key: values[k] for key, values in inputs.items()})
        for k, name in enumerate(names)
    ]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def spread(table):
    """For each nu: the largest deviations from the closed solution, and how much mu matters."""
    for nu in np.unique(table["nu"]):
        chosen = table["nu"] == nu
        energies = [table["energy"][chosen & (table["mu"] == mu)] for mu in np.unique(table["mu"])]
        yield {
            "nu": float(nu),
            "cases": int(chosen.sum()),
            "radius": float(np.max(np.abs(table["radius"] - table["radius_exact"])[chosen])),
            "energy": float(np.max(np.abs(table["deviation"][chosen]))),
            # below the solvers' tolerance it is rounding, which differs from machine to machine
            "mu": float(max(1e-7, *(np.max(np.abs(one / energies[0] - 1.0)) for one in energies))),
        }


class Comparison:
    """The table of a study's directory."""

    def __init__(self, directory):
        self.table = read(directory)
        self.numbers = {"nu": list(spread(self.table))}

    def tables(self):
        """The largest deviations."""
        yield (
            "Against the closed form (maximum differences: c/a; W relative), and between friction coefficients",
            "nu = nu:g; cases = cases:d; c/a = radius:.1e; W = energy:.1e; W between mu, at most = mu:.1e",
            self.numbers["nu"],
        )

    def draw(self, directory):
        """Stick radius, energy, and the energy over its closed form."""
        figure, axes = plt.subplots(1, 3, figsize=(13.0, 4.2), constrained_layout=True)
        fine = np.linspace(0.0, 1.0, 400)
        axes[0].plot(fine, cattaneo_stick_radius(fine, 1.0), label="Cattaneo-Mindlin", **CLOSED)
        axes[1].plot(fine, partial_loop_energy(fine, 1.0, 1.0), label="Mindlin-Deresiewicz", **CLOSED)
        axes[2].axhline(0.0, **CLOSED)
        style = {"markersize": 5.5, "markerfacecolor": "none", "zorder": 2}
        panels = (
            ("radius", "Stick radius at the peak", "$c/a$", 1.0),
            ("energy", "Energy of a cycle", r"$W/(\mu N \delta_0)$", 1.0),
            ("deviation", "Energy over its closed form", "difference, %", 100.0),
        )
        for panel, (name, title, text, factor) in zip(axes, panels):
            for nu, tint in zip(np.unique(self.table["nu"]), COLORS):
                for mu, mark in zip(np.unique(self.table["mu"]), MARKS):
                    rows = (self.table["nu"] == nu) & (self.table["mu"] == mu)
                    x, y = self.table["ratio"][rows], factor * self.table[name][rows]
                    points(panel, x, y, tint, mark, label=rf"$\nu = {nu:g}$, $\mu = {mu:g}$", **style)
            frame(panel, title, r"$T_x/(\mu N)$", text, (0.0, 1.0))
        axes[0].legend(loc="lower left")
        save(figure, directory, "study.png")


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "study"))
