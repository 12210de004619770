"""The profile of a pad with the least frictional work, by gradients; a map of where a micrometre counts.

build/venv/bin/python examples/gradient/pad.py [picture]
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import minimize

import petsam

HALF, POWERS = 1e-3, np.arange(2, 22, 2)  # m; of x over HALF, whose heights at HALF are the parameters
PAD = dict(
    body1="steel", body2="steel", gap_type="flat", grid_n=48, grid_size=2.4e-3, friction=0.4, slip_direction="end",
    allow_edge_contact=True, errors="none",
)  # fmt: skip
TURNS = np.array([0, 0.5, 1, 0.5, 0, -0.5, -1, -0.5, 0])
LOAD = 180  # N
LOOP = np.concatenate([np.linspace(0, 1, 9), np.linspace(1, -1, 17)[1:], np.linspace(-1, 1, 17)[1:]])  # drawn
FIRST, LAST = 8, 24  # its reversals
MOST = 1.1  # norm of the pressure over that of the start
KNOWN = {}  # numbers by parameters
START = np.append(5e-6, np.zeros(len(POWERS) - 1))  # m: a parabola


def shapes():
    """The gap by a unit of each parameter, and the crown along y that stays."""
    contact = petsam.Contact(**PAD)
    x, y = np.meshgrid(contact.x, contact.y)
    return np.array([(x / HALF) ** power for power in POWERS]), y**2 / 0.2


def solve(heights, turns=TURNS):
    """A pad with its steps recorded, and the displacement (m) in each of them."""
    contact = petsam.Contact(**PAD)
    contact.gap = np.tensordot(heights, UNITS, axes=1) + CROWN
    contact.record_gradient()
    history = {"time": np.arange(len(turns)), "load_n": np.full(len(turns), 1000.0), "load_tx": LOAD * turns}
    return contact, np.array([step.disp_x for step in contact.run(history)])


def numbers(parts):
    """Energy and norm of the pressure, each with its derivatives; known runs are not repeated."""
    key = parts.tobytes()
    if key not in KNOWN:
        contact, _ = solve(parts * START[0])
        both = [contact.gradient(name) for name in ("energy", "pressure_norm")]
        KNOWN[key] = [(one.value, np.tensordot(UNITS, one.gap, axes=2) * START[0]) for one in both]
    return KNOWN[key]


def main():
    start = START / START[0]
    (work, _), (norm, _) = numbers(start)
    found = minimize(
        lambda parts: numbers(parts)[0][0] / work, start, jac=lambda parts: numbers(parts)[0][1] / work,
        constraints={
            "type": "ineq", "fun": lambda parts: MOST - numbers(parts)[1][0] / norm,
            "jac": lambda parts: -numbers(parts)[1][1] / norm,
        },
        bounds=[(0.05, None), *[(0, None)] * (len(POWERS) - 1)], method="SLSQP", options={"ftol": 1e-5},
    )  # fmt: skip
    runs, more = len(KNOWN), found.njev * len(POWERS)
    print(f"runs {runs}, with as many passes back for each number; by differences {more} more")
    print(f"work of the loop {1e6 * work:.2f} -> {1e6 * work * found.fun:.2f} uJ ({100 * (found.fun - 1):.0f} %)")
    print(f"norm of the pressure {100 * (numbers(found.x)[1][0] / norm - 1):+.0f} %")
    print("heights at the pad's edge by powers 2 ... 20, um:", np.round(1e6 * START[0] * found.x, 1).tolist())
    if len(sys.argv) > 1:
        draw(found.x * START[0], sys.argv[1])


def draw(heights, name):
    """Draws where a micrometre counts, and both profiles with their pressures and loops."""
    pads = [("parabola", "#0072b2", START, solve(START)[0]), ("best", "#d55e00", heights, solve(heights)[0])]
    contact = pads[0][3]
    first, x = contact.gradient("energy"), 1e3 * contact.x
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(13, 3.6), layout="constrained")
    area = (PAD["grid_size"] / PAD["grid_n"]) ** 2
    percent = 100 * first.gap / first.value / area * 1e-6 * 1e-10  # of the work by 1 um on (10 um)^2
    limit = np.abs(percent).max()
    image = left.pcolormesh(x, 1e3 * contact.y, percent, cmap="RdBu_r", vmin=-limit, vmax=limit)
    figure.colorbar(image, ax=left, label="change of the work, %")
    left.set_title("1 µm removed on 10 µm × 10 µm", fontsize="medium")
    left.set_xlabel("x, mm")
    left.set_ylabel("y, mm")
    left.set_aspect("equal")
    for label, color, heights_of, pad in pads:
        line = pad.field("pressure")[len(pad.y) // 2]  # the same in all steps
        middle.plot(x, 1e-6 * line, color=color, label=label)
        displacement = solve(heights_of, LOOP)[1]
        elastic = LOOP * (displacement[FIRST] - displacement[LAST]) / 2 + (displacement[FIRST] + displacement[LAST]) / 2
        right.plot(1e9 * (displacement - elastic)[FIRST:], LOAD * LOOP[FIRST:], color=color)
        print(
            f"{label}: maximum pressure {1e-6 * line.max():.0f} MPa, at the edge {heights_of.sum() * 1e6:.2f} um open"
        )
    middle.set(xlabel="x, mm", ylabel="pressure at y = 0, MPa")
    middle.legend(frameon=False)
    right.set(xlabel="inelastic displacement, nm", ylabel="tangential force, N")
    figure.savefig(name, dpi=110)


UNITS, CROWN = shapes()

if __name__ == "__main__":
    if any(word.startswith("-") for word in sys.argv[1:]):
        sys.exit(__doc__.strip())
    main()
