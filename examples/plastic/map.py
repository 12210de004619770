"""Shakedown of a cylinder that rolls and slides over steel again and again: map.png, and the limits of the pressure.

    build/venv/bin/python examples/plastic/map.py [folder]

The steel does not harden. On one period each point is rolled over again and again. The limit is Melan's: residual
stress of a half-plane that is the same at each place along x has no shear, so the shear by the contact must stay
below that at yield, k (K. L. Johnson, Contact Mechanics (1985), section 9.2).
"""

import os
import sys
import warnings
from multiprocessing import Pool

import numpy as np

import petsam
from petsam.plot.style import COLORS, STYLE, frame, plt, save

SHEAR = 100e6  # k, Pa
HALF = 1e-3  # half width of the elastic contact, m
PERIOD = 10 * HALF
CELLS = 120  # of a period
TIMES = 5
POISSON = 0.3
YOUNG = 260e9  # so that strains are small
FRICTIONS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)
PARTS = (0.75, 0.93, 1.07, 1.25)  # pressures over the limit
SLIDING = 0.99  # T over friction times N
STEADY = 0.1  # work of the last time over that of the second: less of it falls to nothing


def stresses(friction):
    """xx, zz, xz below a line contact of half width 1 and pressure 1 that slides along x (E. McEwen, 1949)."""
    x, z = np.meshgrid(np.linspace(-2.5, 2.5, 2001), np.linspace(0.0, 2.0, 401))
    root, flat = np.sqrt((1 - x**2 + z**2) ** 2 + 4 * x**2 * z**2), 1 - x**2 + z**2
    m, n = np.sqrt(np.maximum(root + flat, 0) / 2), np.sign(x) * np.sqrt(np.maximum(root - flat, 0) / 2)
    with np.errstate(invalid="ignore", divide="ignore"):
        p = [
            -(m * (1 + (z**2 + n**2) / (m**2 + n**2)) - 2 * z),
            -m * (1 - (z**2 + n**2) / (m**2 + n**2)),
            -n * (m**2 - z**2) / (m**2 + n**2),
        ]
        q = [n * (2 - (z**2 - m**2) / (m**2 + n**2)) - 2 * x, p[2], p[0]]
    return [np.nan_to_num(a + friction * b) for a, b in zip(p, q)]


def limit(friction):
    """The shakedown limit of the pressure over k."""
    return 1 / np.max(np.abs(stresses(friction)[2]))


def first_yield(friction):
    """The pressure at which the body yields first, over k, by von Mises in plane strain."""
    xx, zz, xz = stresses(friction)
    yy = POISSON * (xx + zz)
    return 1 / np.sqrt(np.max(((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) / 6 + xz**2))


def works_of(case):
    """Plastic work (J/m) of each time under a friction and a pressure over k."""
    friction, pressure = case
    load = np.pi / 2 * HALF * pressure * SHEAR
    rows = 1 + TIMES * CELLS
    history = dict(load_n=np.full(rows, load), load_tx=np.full(rows, SLIDING * friction * load))
    history["roll"] = np.append(0.0, np.full(rows - 1, -PERIOD / CELLS))
    radius = YOUNG / (1 - POISSON**2) * HALF / 2 / (pressure * SHEAR)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        results = petsam.run(
            elasticity="plane_periodic", grid_n=CELLS, grid_size=PERIOD, body1_young="inf", body2_young=YOUNG,
            body2_poisson=POISSON, gap_type="sphere", gap_radius1=radius, gap_radius2="inf", friction=friction,
            body2_yield=np.sqrt(3) * SHEAR, yield_depth=2.5 * HALF, yield_layers=24, output_every=rows, history=history,
        )  # fmt: skip
    work = np.asarray(results.history["plastic_work"])[1:]
    return work.reshape(TIMES, CELLS).sum(axis=1)


def kind_of(work):
    """0 elastic, 1 shakes down, 2 yields every time."""
    if not work.any():
        return 0
    return 2 if work[-1] > STEADY * work[1] else 1


def draw(cases, kinds, folder):
    """The map: closed limits as lines, the runs as points."""
    names = ("elastic", "shakes down", "yields every time")
    fine = np.linspace(0.0, max(FRICTIONS) + 0.05, 56)
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
        axes.plot(fine, [limit(f) for f in fine], color=COLORS[0], label="Melan's limit")
        axes.plot(fine, [first_yield(f) for f in fine], "--", color="0.4", label="first yield")
        for kind, (name, marker, color) in enumerate(zip(names, "o^s", (COLORS[2], COLORS[0], COLORS[1]))):
            chosen = np.array([case for case, one in zip(cases, kinds) if one == kind]).reshape(-1, 2)
            axes.plot(*chosen.T, marker, color=color, label=f"petsam: {name}", markersize=5)
        frame(
            axes,
            "What the steel does from the second passage on",
            "friction $T/N$",
            "peak pressure over the yield stress in shear, $p_0/k$",
        )
        axes.set_ylim(0.0)
        axes.legend()
        save(figure, folder, "map.png")


def main():
    """Runs all cases, two at a time."""
    folder = sys.argv[1] if len(sys.argv) > 1 else "build/run"
    os.makedirs(folder, exist_ok=True)
    cases = [(friction, part * limit(friction)) for friction in FRICTIONS for part in PARTS]
    with Pool(2) as pool:
        works = pool.map(works_of, cases, chunksize=1)
    kinds = [kind_of(work) for work in works]
    print("friction  p_0/k: first yield, limit; work of the last time over the first's, at p_0 over the limit")
    for k, friction in enumerate(FRICTIONS):
        own = works[k * len(PARTS) : (k + 1) * len(PARTS)]
        shares = "  ".join(f"{part:g}: {w[-1] / w[0] if w[0] else 0:.2g}" for part, w in zip(PARTS, own))
        print(f"{friction:8g}  {first_yield(friction):.3f}, {limit(friction):.3f}; {shares}")
    draw(cases, kinds, folder)


if __name__ == "__main__":
    main()
