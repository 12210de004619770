#!/usr/bin/env python3
"""Tables and pictures of the examples of rolling, one of them a command.

    build/venv/bin/python examples/rolling/figures.py carter|transient|kalker|fatigue [--directory build/rolling]

Reads the results that the commands in README.md write to the directory, prints numbers beside those of the closed-form
solution, of CONTACT or of Kalker, and writes carter.png, transient.png, kalker.png or fatigue.png there.
"""

import argparse
import os
import sys
from pathlib import Path

import h5py
import numpy as np

import petsam
from petsam.core.line import fail
from petsam.plot.style import CLOSED, COLORS, STYLE, frame, plt, points, save

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
from comparison import print_table  # noqa: E402

# CONTACT, example catt_to_cart: creepage after so many time steps of one cell; and its first step, Cattaneo's shift
CONTACT = {1: 1.824e-3, 2: 1.882e-3, 6: 2.221e-3, 14: 3.403e-3, 15: 3.402e-3, 21: 3.088e-3, 56: 3.101e-3}
SHIFT = 0.01774
# J. J. Kalker, Three-Dimensional Elastic Bodies in Rolling Contact (1990), table E3: by a/b for nu = 0, 0.25, 0.5
RATIOS = (0.1, 0.2, 0.3, 0.5, 0.7, 1, 1 / 0.7, 2, 1 / 0.3, 5, 10)
KALKER = {
    "C11": (
        (2.51, 2.59, 2.68, 2.88, 3.09, 3.40, 3.82, 4.37, 5.57, 6.96, 10.7),
        (3.31, 3.37, 3.44, 3.62, 3.81, 4.12, 4.54, 5.10, 6.34, 7.78, 11.7),
        (4.85, 4.81, 4.80, 4.83, 4.97, 5.20, 5.58, 6.11, 7.34, 8.82, 12.9),
    ),
    "C22": (
        (2.51, 2.59, 2.68, 2.88, 3.09, 3.40, 3.82, 4.37, 5.57, 6.96, 10.7),
        (2.52, 2.63, 2.75, 3.01, 3.28, 3.67, 4.21, 4.90, 6.40, 8.14, 12.8),
        (2.53, 2.66, 2.81, 3.14, 3.48, 3.98, 4.67, 5.56, 7.51, 9.79, 16.0),
    ),
    "C23": (
        (0.334, 0.483, 0.607, 0.827, 1.03, 1.33, 1.76, 2.35, 3.79, 5.72, 12.2),
        (0.473, 0.603, 0.715, 0.929, 1.14, 1.47, 1.95, 2.62, 4.32, 6.63, 14.6),
        (0.731, 0.809, 0.889, 1.07, 1.29, 1.63, 2.18, 2.96, 5.01, 7.89, 18.0),
    ),
    "C33": (
        (6.42, 3.46, 2.49, 1.74, 1.43, 1.21, 1.05, 0.958, 0.868, 0.828, 0.795),
        (8.28, 4.27, 2.96, 1.93, 1.50, 1.19, 0.965, 0.819, 0.674, 0.601, 0.526),
        (11.7, 5.66, 3.72, 2.22, 1.60, 1.16, 0.852, 0.650, 0.446, 0.341, 0.228),
    ),
}
MARKS = ("o", "s", "D")
DEPTH = 0.0063036  # m, half width along x of the contact of wheel.opts


def opened(directory, name):
    return petsam.open(os.path.join(directory, name))


# ---- Carter


def carter(directory):
    """T_x and shear of long cylinders; xi0 = mu a/R is the creepage of full sliding."""
    grids = {name: opened(directory, f"carter{name}.h5") for name in (55, 440)}
    load, length, mu, radius, modulus = 35.78e3, 0.2, 0.3, 0.5, 82e9 / 0.72  # of carter.opts: N, m, 1, m, Pa
    a, force = np.sqrt(4.0 * load / length * radius / (np.pi * modulus)), mu * load
    last, peak = mu * a / radius, mu * 2.0 * load / length / (np.pi * a)
    rows = []
    for k, creep in enumerate(grids[55].history["creep_x"]):
        found = [grid.history["load_tx"][k] / force for grid in grids.values()]
        power = [30.0 * grids[55].history[name][k] for name in ("rolling_energy_cells", "rolling_energy")]
        closed = 1.0 - (1.0 - creep / last) ** 2
        rows.append(dict(creep=creep, n55=found[0], n440=found[1], closed=closed, cells=power[0], loads=power[1]))
    print_table(
        "T_x over mu N on 55 and 440 columns, Carter's; power (W) at 30 m/s by cells and by loads, 55 columns",
        "creepage = creep:.1e; 55 = n55:.4f; 440 = n440:.4f; Carter = closed:.4f; "
        "W cells = cells:.2f; W loads = loads:.2f",
        rows,
    )
    figure, axes = plt.subplots(1, 2, figsize=(10.0, 3.4), constrained_layout=True)
    fine = np.linspace(0.0, 1.0, 200)
    axes[0].plot(fine, 1.0 - (1.0 - fine) ** 2, label="Carter", **CLOSED)
    for (columns, grid), color, mark in zip(grids.items(), COLORS, MARKS):
        x, y = grid.history["creep_x"] / last, grid.history["load_tx"] / force
        points(axes[0], x, y, color, mark, label=f"{columns} columns", markersize=5)
    axes[0].legend(loc="lower right")
    frame(axes[0], "Tangential force", r"creepage $\xi/\xi_0$", r"$T_x/(\mu N)$", (0.0, 1.0), (0.0, 1.05))
    grid, x = grids[440], np.linspace(-1.0, 1.0, 1001)
    for index, color in zip((1, 2, 3, 4), COLORS):
        share = grid.history["creep_x"][index] / last
        stick = 1.0 - share  # half width, from the leading edge x = 1
        inner = np.sqrt(np.maximum(stick**2 - (x - share) ** 2, 0.0))
        axes[1].plot(x, np.sqrt(1.0 - x**2) - inner, **CLOSED)
        shear = grid.field("shear_x", index)[0] / peak
        some = slice(7, None, 14)
        points(axes[1], grid.x[some] / a, shear[some], color, label=rf"$\xi/\xi_0 = {share:.1f}$")
    axes[1].legend(loc="upper right")
    frame(axes[1], "Shear, 440 columns", "$x/a$, rolling to the right", r"$q_x/(\mu p_0)$", (-1.1, 1.1), (0.0, 1.0))
    save(figure, directory, "carter.png")


# ---- from Cattaneo's shift to steady rolling


def transient(directory):
    """The creepage of a constant force after time steps, and the shear along y = 0."""
    steps, steady = opened(directory, "transient.h5"), opened(directory, "transient_steady.h5")
    history = steps.history
    print(f"shift {history['disp_x'][0]:.5f}, CONTACT {SHIFT:.5f}; cells in stick {history['stick_cells'][0]:.0f}, 305")
    for k, expected in CONTACT.items():
        print(f"step {k:2d}: creepage {history['creep_x'][k]:.3e}, CONTACT {expected:.3e}")
    limit = steady.history["creep_x"][-1]
    fine = steady.history["creep_x_extrapolated"][-1]
    cells = history["stick_cells"][-1], steady.history["stick_cells"][-1]
    print(
        f"steady: {limit:.4e}, on fine grids {fine:.3e}; cells in stick {cells[0]:.0f} after the steps, {cells[1]:.0f}"
    )

    a = np.sqrt(history["contact_area"][0] / np.pi)
    figure, axes = plt.subplots(1, 2, figsize=(10.0, 3.4), constrained_layout=True)
    way = 0.25 * np.arange(history["creep_x"].size) / a
    axes[0].axhline(1e3 * limit, label="steady", linestyle="--", **CLOSED)
    axes[0].plot(way[1:], 1e3 * history["creep_x"][1:], ".-", color=COLORS[0], markersize=4, label="time steps")
    kept = list(CONTACT)
    points(axes[0], way[kept], 1e3 * np.array([*CONTACT.values()]), COLORS[1], "s", markersize=6, label="CONTACT",
           markerfacecolor="none")  # fmt: skip
    axes[0].legend(loc="lower right")
    frame(axes[0], "Creepage", "rolled distance / $a$", r"$\xi \cdot 10^3$", (0.0, None))
    axes[0].set_ylim(0.0)
    row = int(np.argmin(np.abs(steps.y)))
    bound = 0.4013 * steps.field("pressure", 0)[row]
    peak = bound.max()
    axes[1].plot(steps.x / a, bound / peak, label=r"$\mu p$", **CLOSED)
    for k, color in zip((0, 2, 6, 14, 56), COLORS):
        axes[1].plot(steps.x / a, steps.field("shear_x", k)[row] / peak, color=color, linewidth=1.3,
                     label=f"after {way[k]:.1f} $a$")  # fmt: skip
    points(axes[1], steady.x / a, steady.field("shear_x")[row] / peak, COLORS[5], label="steady", markersize=4)
    axes[1].legend(loc="upper center", ncols=3)
    frame(axes[1], "Shear at $y = 0$", "$x/a$, rolling to the right", r"$q_x/(\mu p_0)$", (-1.2, 1.2), (0.0, 1.35))
    save(figure, directory, "transient.png")


# ---- Kalker's coefficients


def coefficients(directory):
    """C11, C22, C23, C32, C33 by (ratio, nu), from loads extrapolated to fine grids; and the reciprocity by cells."""
    found, reciprocity = {}, 0.0
    with h5py.File(os.path.join(directory, "kalker", "results.h5"), "r") as file:
        names = file["case"].asstr()[:]
        inputs = [(float(r), float(nu)) for r, nu in zip(file["inputs/ratio"][:], file["inputs/nu"][:])]
        for name, key in zip(names, inputs):
            with petsam.open(os.path.join(directory, "kalker", name, "results.h5")) as results:
                c, unit = 1e-3, 82e9 * 1e-3**2 * 1e-5  # m; N, G a b times the creepage
                tx, ty, mz = (results.history[f"load_{axis}_extrapolated"] / unit for axis in ("tx", "ty", "mz"))
                found[key] = dict(C11=tx[0], C22=ty[1], C23=ty[2], C33=mz[2] / c)
                c23, c32 = results.history["load_ty"][2] / unit, -results.history["load_mz"][1] / unit / c
                reciprocity = max(reciprocity, abs(c23 / c32 - 1.0))
    return found, reciprocity


def kalker(directory):
    found, reciprocity = coefficients(directory)
    ratios = sorted({ratio for ratio, _ in found})
    poissons = sorted({nu for _, nu in found})
    rows, most = [], 0.0
    for i, ratio in enumerate(ratios):
        for j, nu in enumerate(poissons):
            one = {name: found[ratio, nu][name] for name in KALKER}
            most = max(most, *(abs(one[name] / KALKER[name][j][i] - 1.0) for name in KALKER))
            if nu == 0.25:
                rows.append(dict(ratio=f"{ratio:.3g}", **one, **{f"K{n[1:]}": KALKER[n][j][i] for n in KALKER}))
    columns = [f"{name} = {name}:.4g; Kalker = K{name[1:]}:.3g" for name in KALKER]
    print_table("nu = 0.25", "a/b = ratio; " + "; ".join(columns), rows)
    print(
        f"all {len(found)} cases: at most {100 * most:.1f} % from Kalker's table; C23/C32 - 1 within {reciprocity:.0e}"
    )

    figure, axes = plt.subplots(1, 4, figsize=(10.0, 3.2), constrained_layout=True)
    for axis, (name, table) in zip(axes, KALKER.items()):
        for j, (nu, color, mark) in enumerate(zip(poissons, COLORS, MARKS)):
            axis.plot(ratios, [found[ratio, nu][name] for ratio in ratios], color=color, linewidth=1.2)
            points(axis, RATIOS, table[j], color, mark, label=rf"$\nu = {nu:g}$", markersize=5)
        axis.set(xscale="log", yscale="log")
        axis.set_xticks([0.1, 0.3, 1, 3, 10], ["0.1", "0.3", "1", "3", "10"])
        low, high = axis.get_ylim()
        ticks = [t for t in (0.2, 0.3, 0.5, 1, 2, 3, 5, 10, 20) if low <= t <= high]
        axis.set_yticks(ticks, [f"{t:g}" for t in ticks])
        axis.minorticks_off()
        frame(axis, f"$C_{{{name[1:]}}}$", "$a/b$", "")
    axes[0].legend(loc="upper left", title="points: Kalker")
    save(figure, directory, "kalker.png")


# ---- fatigue of the points that pass


def fatigue(directory):
    """Dang Van, Crossland and SWT over the depth of the middle of the running band, by tractions."""
    loads = opened(directory, "tractions.h5").history["load_tx"] / (0.33 * 106.7e3)
    stresses = [opened(directory, f"passing{k + 1}.h5") for k in range(loads.size)]
    names = {"dang_van": "Dang Van", "crossland": "Crossland", "swt": "Smith, Watson, Topper"}
    figure, axes = plt.subplots(1, 3, figsize=(10.0, 3.6), sharey=True, constrained_layout=True)
    for axis, (name, title) in zip(axes, names.items()):
        for share, one, color in zip(loads, stresses, COLORS):
            along = one.field(name)[:, 0, 0] / 1e6
            k = int(np.argmax(along))
            print(f"{title}, T_x = {share:.2f} mu N: at most {along[k]:.4g} MPa at a depth of {1e3 * one.z[k]:.2f} mm; "
                  f"at the surface {along[0]:.4g} MPa")  # fmt: skip
            axis.plot(along, one.z / DEPTH, color=color, label=f"{share:.1f}")
        frame(axis, title, "MPa", "", (0.0, None))
    axes[0].set(ylabel="depth / $a$", ylim=(one.z[-1] / DEPTH, 0.0))
    axes[2].legend(loc="lower right", title=r"$T_x/(\mu N)$")
    save(figure, directory, "fatigue.png")


def main():
    examples = {one.__name__: one for one in (carter, transient, kalker, fatigue)}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("example", choices=examples)
    parser.add_argument("--directory", default="build/rolling")
    args = parser.parse_args()
    try:
        with plt.rc_context(STYLE):
            examples[args.example](args.directory)
    except (petsam.Error, OSError) as error:
        return fail(os.path.basename(sys.argv[0]), error, 1)
    return 0


if __name__ == "__main__":
    sys.exit(main())
