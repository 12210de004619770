#!/usr/bin/env python3
"""Draw the study example: stick radius and dissipated energy over T_x/(mu N), for several mu and nu.

Reads results.h5 of petsam-study in a directory, and through its links the history of each case; draws study.png and prints
the deviations from Cattaneo, Mindlin and Deresiewicz. All numbers are relative: the stick radius, sqrt(stick_area/pi), to
that of the contact; the energy of the closed cycle (from the first to the second peak) to mu N delta_0 or to its closed
form, delta_0 being the displacement of incipient sliding.
"""
import os
import sys

import h5py
import numpy as np

import analytic
import loop_analytic
from figures import STYLE, InputError, finish_numbers, main, plt, print_table, save

TINTS = ("#3b4cc0", "#c44e52", "#2a9d8f")
MARKS = ("o", "+", "x")
PEAK, SECOND_PEAK = 1, 3  # steps of the table's history


def _read(file):
    """A row a case: inputs, stick radius, energy, and the closed solution for the case's own parameters."""
    for name, inputs in zip(file["case"].asstr()[:], zip(*[file["inputs"][key][:] for key in ("ratio", "mu", "nu")])):
        case = file["cases"][name]
        history = {key: data[:] for key, data in case["history"].items()}
        if history["time"].size != SECOND_PEAK + 1 or np.any(history["status"] != 0):
            raise ValueError("case {} has not finished".format(name))
        bodies = [(case.attrs["body%d_young" % k], case.attrs["body%d_poisson" % k]) for k in (1, 2)]
        hertz = analytic.hertz(history["load_n"][-1], analytic.effective_radius(case.attrs["gap_radius1"],
                                                                             case.attrs["gap_radius2"]),
                               analytic.effective_modulus(*bodies[0], *bodies[1]))
        moduli = [analytic.shear_modulus(*body) for body in bodies]
        mu, limit = case.attrs["friction"], case.attrs["friction"] * history["load_n"][-1]
        gross = analytic.cattaneo_displacement(hertz.radius, 0.0, mu * hertz.pressure, analytic.tangential_compliance(
            moduli[0], bodies[0][1], moduli[1], bodies[1][1]))
        energy = history["dissipated_energy"][PEAK + 1:].sum()
        exact = loop_analytic.partial_loop_energy(history["load_tx"][-1], limit, gross)
        yield {"ratio": inputs[0], "mu": inputs[1], "nu": inputs[2],
               "radius": np.sqrt(history["stick_area"][-1] / history["contact_area"][-1]),
               "radius_exact": analytic.cattaneo_stick_radius(inputs[0], 1.0),
               "energy": energy / (limit * gross), "energy_exact": exact / (limit * gross),
               "deviation": energy / exact - 1.0}


def read(directory):
    """All rows, as arrays by name."""
    path = os.path.join(directory, "results.h5")
    try:
        with h5py.File(path, "r") as file:
            rows = list(_read(file))
    except (OSError, KeyError, ValueError) as error:
        raise InputError("{}: {}; run examples/study/run.sh first".format(path, error)) from error
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def spread(table):
    """For each nu: the largest deviations from the closed solution, and how much mu matters."""
    for nu in np.unique(table["nu"]):
        chosen = table["nu"] == nu
        energies = [table["energy"][chosen & (table["mu"] == mu)] for mu in np.unique(table["mu"])]
        yield {"nu": float(nu), "cases": int(chosen.sum()),
               "radius": float(np.max(np.abs(table["radius"] - table["radius_exact"])[chosen])),
               "energy": float(np.max(np.abs(table["deviation"][chosen]))),
               "mu": float(max(np.max(np.abs(one / energies[0] - 1.0)) for one in energies))}


def figure_study(directory, table):
    """Stick radius, energy, and the energy over its closed form."""
    figure, axes = plt.subplots(1, 3, figsize=(13.0, 4.2), constrained_layout=True)
    fine = np.linspace(0.0, 1.0, 400)
    axes[0].plot(fine, analytic.cattaneo_stick_radius(fine, 1.0), color="0.35", linewidth=1.2, label="Cattaneo-Mindlin")
    axes[1].plot(fine, loop_analytic.partial_loop_energy(fine, 1.0, 1.0), color="0.35", linewidth=1.2,
                 label="Mindlin-Deresiewicz")
    axes[2].axhline(0.0, color="0.35", linewidth=1.2)
    for nu, tint in zip(np.unique(table["nu"]), TINTS):
        for mu, mark in zip(np.unique(table["mu"]), MARKS):
            rows = (table["nu"] == nu) & (table["mu"] == mu)
            style = {"color": tint, "markersize": 5.5, "markerfacecolor": "none", "linestyle": "none",
                     "label": r"$\nu = {:g}$, $\mu = {:g}$".format(nu, mu)}
            for panel, name in zip(axes, ("radius", "energy", "deviation")):
                panel.plot(table["ratio"][rows], (100.0 if name == "deviation" else 1.0) * table[name][rows], mark, **style)
    for panel, title, text in zip(axes, ("Stick radius at the peak", "Energy of a cycle", "Energy over its closed form"),
                                  ("$c/a$", r"$W/(\mu N \delta_0)$", "difference, %")):
        panel.set(title=title, xlabel=r"$T_x/(\mu N)$", ylabel=text, xlim=(0.0, 1.0))
    axes[0].legend(loc="lower left")
    save(figure, directory, "study.png")


def run(options):
    """Read, print the numbers, draw."""
    table = read(options.directory)
    rows = list(spread(table))
    print_table("Against the closed solution (largest differences: c/a; W relative), and between friction coefficients", {
        "nu": ("nu", "{:g}"), "cases": ("cases", "{:d}"), "c/a": ("radius", "{:.1e}"), "W": ("energy", "{:.1e}"),
        "W between mu": ("mu", "{:.1e}")}, rows)
    figures = finish_numbers(options, {"nu": rows})
    with plt.rc_context(STYLE):
        figure_study(figures, table)


if __name__ == "__main__":
    sys.exit(main(run, __doc__, "study"))
