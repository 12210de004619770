"""The profile of a pad with the least parameter of Smith, Watson and Topper (SWT) under it, by gradients; plane strain.

build/venv/bin/python examples/gradient/swt.py [--free 40] [picture]

A pad is pressed on a flat of the same alloy, under a cyclic tangential force and bulk stress of the flat. Free are ten
curvatures of the profile, or as many as --free gives, at equidistant knots from the middle to the pad's end.
"""

import argparse

import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.optimize import minimize

import petsam

DEPTH = 50e-6  # m
HALF, RADIUS = 1e-3, 50e-3  # m: of the pad, and of the cylinder that it is at the start
CORNER, CORNER_RADIUS = 0.9e-3, 2e-3  # m: where its rounded ends begin, which stay
PAD = dict(
    elasticity="plane", body1="Ti-6Al-4V", body2="Ti-6Al-4V", gap_type="flat", grid_n=240, grid_size=2.4e-3,
    friction=0.5, slip_direction="end", allow_edge_contact=True, errors="none",
)  # fmt: skip
TURNS = np.array([0, 0.5, 1, 0.5, 0, -0.5, -1, -0.5, 0, 0.5, 1])
HISTORY = {
    "time": np.arange(len(TURNS)), "load_n": np.full(len(TURNS), 5e5), "load_tx": 1e5 * TURNS,  # s, N/m
    "bulk2_stress_xx": 80e6 * TURNS,  # Pa
}  # fmt: skip
CYCLE = slice(2, len(TURNS))  # its steps, from the first maximum to the next
NUMBERS = [(f"swt@{DEPTH}", CYCLE), "pressure_norm"]
MOST = 1.1  # norm of the pressure over that of the start


def main():
    reader = argparse.ArgumentParser()
    reader.add_argument("--free", type=int, default=10)
    reader.add_argument("picture", nargs="?")
    options = reader.parse_args()
    count, start = options.free, np.ones(options.free)
    numbers = function(count)
    first = numbers(start)[0]
    found = minimize(
        lambda parts: numbers(parts)[0][0] / first[0], start, jac=lambda parts: numbers(parts)[1][0] / first[0],
        constraints={
            "type": "ineq", "fun": lambda parts: MOST - numbers(parts)[0][1] / first[1],
            "jac": lambda parts: -numbers(parts)[1][1] / first[1],
        },
        bounds=[(0, None)] * count, method="SLSQP", options={"ftol": 1e-5},
    )  # fmt: skip
    best, norm = numbers(found.x)[0] / first
    runs, more = len(numbers.known), found.njev * count
    print(f"{count} curvatures: runs {runs}, with as many passes back for each number; by differences {more} more")
    finer = function(count, 4 * PAD["grid_n"])
    there = finer(found.x)[0][0] / finer(start)[0][0]
    print(
        f"SWT {first[0] / 1e6:.3f} -> {best * first[0] / 1e6:.3f} MPa ({100 * (best - 1):.1f} %, "
        f"on four times as many cells {100 * (there - 1):.1f} %), norm of the pressure {100 * (norm - 1):+.1f} %"
    )
    if options.picture:
        draw((start, found.x), options.picture)


def function(count, cells=PAD["grid_n"]):
    """Numbers (Pa) of a cycle, and their derivatives, by the curvatures; known runs are not repeated."""
    pad = {**PAD, "grid_n": cells}
    x = np.abs(petsam.Contact(**pad).x)
    units = [profile(x, one)[None] for one in np.eye(count)]
    evaluate = petsam.gradient.function(pad, HISTORY, NUMBERS, units, gap=corners(x)[None])

    def numbers(parts):
        key = parts.tobytes()
        if key not in numbers.known:
            numbers.known[key] = evaluate(parts)
        return numbers.known[key]

    numbers.known = {}
    return numbers


def profile(x, parts):
    """Heights (m) over |x| with these curvatures over that of the cylinder at the knots, linear between them."""
    fine = np.linspace(0, 1.2 * HALF, 2401)
    curvature = np.interp(fine, np.linspace(0, HALF, len(parts)), parts) / RADIUS
    slope = cumulative_trapezoid(curvature, fine, initial=0)
    return np.interp(x, fine, cumulative_trapezoid(slope, fine, initial=0))


def corners(x):
    """Heights (m) of the rounded ends."""
    return np.maximum(x - CORNER, 0) ** 2 / (2 * CORNER_RADIUS)


def draw(pads, name):
    """Draws the heights of pads, their pressures and the parameter at the depth."""
    figure, panels = plt.subplots(1, 3, figsize=(10, 3), layout="constrained")
    for parts, label, color in zip(pads, ("cylinder", "best"), ("#0072b2", "#d55e00")):
        with petsam.Contact(**PAD) as contact:
            x = np.abs(contact.x)
            heights = profile(x, parts) + corners(x)
            contact.gap = heights[None]
            contact.run({column: values[: CYCLE.start] for column, values in HISTORY.items()})
            contact.record()
            contact.run({column: values[CYCLE] for column, values in HISTORY.items()})
            swt = contact.fatigue("swt", depths=[DEPTH])["swt"].ravel()
            curves = 1e6 * heights, 1e-6 * contact.field("pressure")[0], 1e-6 * swt
            for panel, values in zip(panels, curves):
                panel.plot(1e3 * contact.x, values, color=color, label=label)
    for panel, text in zip(panels, ("gap, µm", "pressure, MPa", "SWT at 50 µm, MPa")):
        panel.set(xlabel="x, mm", ylabel=text)
    panels[0].legend(frameon=False)
    figure.savefig(name, dpi=80)


if __name__ == "__main__":
    main()
