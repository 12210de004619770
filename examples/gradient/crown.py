"""The profile of a roller with the least edge stress, aligned and tilted, by gradients; beside Lundberg's crown.

build/venv/bin/python examples/gradient/crown.py [picture]
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.optimize import minimize

import petsam

LOAD, MOMENT = 5e3, 2.0  # N, N m: the moment tilts the roller in the second case
HALF, RADIUS, DROP = 5e-3, 10e-3, 20e-6  # m: of the roller, and the drop of Lundberg's profile at its ends
MODULUS = 210e9 / (2 * (1 - 0.3**2))  # Pa: E* of steel on steel
LUNDBERG = LOAD / (2 * HALF) / (np.pi * MODULUS)  # m: his crown, load per length/(pi E*)
STRESSES = ("mises@50um", "mises@150um")  # at the edge, and where it is largest below a line contact
POWER = 40  # of the smooth maximum over them and the cases
ROLLER = dict(
    body1="steel", body2="steel", gap_type="flat", grid_n=(32, 256), grid_size=(1e-3, 11e-3), slip_direction="end",
    allow_edge_contact=True, errors="none",
)  # fmt: skip
COUNT = 12  # curvatures
KNOTS = 1 - np.linspace(1, 0, COUNT) ** 2  # of |y|/HALF, dense at the end


def main():
    start = np.ones(COUNT)
    crowns = [minimum([1.0], moments, sum_of=True) for moments in ([0.0], [0.0, MOMENT])]
    best = minimum(start, [0.0, MOMENT])
    print(
        f"Lundberg's crown {1e6 * LUNDBERG:.2f} um; the best of its shape, by the aligned case {crowns[0].x[0]:.2f}, "
        f"by both {crowns[1].x[0]:.2f} times that"
    )
    print(f"{COUNT} curvatures: runs {best.nfev}, with 4 passes back each; by differences {best.nfev * COUNT} more")
    profiles = {
        "a tenth of Lundberg's crown": 0.1 * start, "Lundberg": start, "best crown": crowns[1].x[0] * start,
        "best profile": best.x,
    }  # fmt: skip
    print("MPa, on twice as many rows: stress, aligned and tilted; maximum pressure, aligned and tilted")
    lines = {}
    for name, parts in profiles.items():
        stress = largest([0.0, MOMENT], rows=512)(parts)
        lines[name] = pressures(parts, rows=512)
        print(f"{name}: {stress[0]:.0f}, {stress[1]:.0f}; {lines[name][1].max():.0f}, {lines[name][2].max():.0f}")
    y, aligned, _ = lines["Lundberg"]
    line = np.sqrt(LOAD / (2 * HALF) * MODULUS / (np.pi * RADIUS)) / 1e6
    print(f"Lundberg's, aligned, in the middle {aligned[len(y) // 2]:.0f} MPa; a line contact {line:.0f} MPa")
    if len(sys.argv) > 1:
        draw({name: (profiles[name], lines[name]) for name in ("Lundberg", "best profile")}, sys.argv[1])


def minimum(start, moments, sum_of=False):
    """Of the smooth maximum of the stresses (GPa) in the cases of these moments."""
    evaluate = function(moments, sum_of=sum_of)

    def objective(parts):
        values, slopes = evaluate(parts)
        value = np.sum((1e-9 * values) ** POWER) ** (1 / POWER)
        return value, 1e-9 * (1e-9 * values / value) ** (POWER - 1) @ slopes

    bounds = [(0, None)] * len(start)
    return minimize(objective, start, jac=True, method="L-BFGS-B", bounds=bounds, options={"ftol": 1e-6})


def function(moments, rows=ROLLER["grid_n"][1], sum_of=False):
    """Stresses (Pa) of the cases and their derivatives by curvatures over Lundberg's, or by one for all of them."""
    options = {**ROLLER, "grid_n": (ROLLER["grid_n"][0], rows)}
    stay, parts = gaps(options)
    history = {"time": np.arange(len(moments)), "load_n": np.full(len(moments), LOAD), "load_mx": moments}
    numbers = [(name, slice(k, k + 1)) for k in range(len(moments)) for name in STRESSES]
    return petsam.gradient.function(options, history, numbers, [sum(parts)] if sum_of else list(parts), gap=stay)


def largest(moments, rows):
    """A function that returns the larger stress (MPa) of each case."""
    evaluate = function(moments, rows)
    return lambda parts: 1e-6 * evaluate(parts)[0].reshape(len(moments), -1).max(axis=1)


def gaps(options):
    """The gap (m) of a straight roller, which ends at HALF, and that of a unit of each curvature."""
    with petsam.Contact(**options) as contact:
        x, y = np.meshgrid(contact.x, contact.y)
    return x**2 / (2 * RADIUS) + np.where(np.abs(y) > HALF, 1e-3, 0), heights(np.eye(COUNT), np.abs(y))


def heights(several, y):
    """Of profiles (m) at |y| by their curvatures at the knots, over those of Lundberg's, linear between them."""
    fine = np.linspace(0, 1, 20001)
    part = -np.expm1(-DROP / LUNDBERG)
    curvature = 2 * LUNDBERG * part * (1 + part * fine**2) / (1 - part * fine**2) ** 2
    found = []
    for parts in several:
        slope = cumulative_trapezoid(curvature * np.interp(fine, KNOTS, parts), fine, initial=0)
        found.append(np.interp(y / HALF, fine, cumulative_trapezoid(slope, fine, initial=0)))
    return np.array(found)


def pressures(parts, rows):
    """y (m), and the maximum pressure (MPa) of each row, aligned and tilted."""
    options, lines = {**ROLLER, "grid_n": (ROLLER["grid_n"][0], rows)}, []
    stay, units = gaps(options)
    for moment in (0.0, MOMENT):
        with petsam.Contact(**options) as contact:
            contact.gap = stay + np.tensordot(parts, units, axes=1)
            contact.run({"time": [0], "load_n": [LOAD], "load_mx": [moment]})
            lines.append(1e-6 * contact.field("pressure").max(axis=1))
            y = np.array(contact.y)
    return y, *lines


def draw(found, name):
    """Draws profiles and pressures along the axis."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.4, 3.4), layout="constrained", width_ratios=[2, 3])
    for (label, (parts, (y, *lines))), color in zip(found.items(), ("#0072b2", "#d55e00")):
        half = np.linspace(0, HALF, 400)
        left.plot(1e3 * half, 1e6 * heights([parts], half)[0], color=color, label=label)
        for line, style, case in zip(lines, ("-", ":"), ("", ", tilted")):
            right.plot(1e3 * y, line, style, color=color, label=label + case)
    left.set(xlabel="y, mm", ylabel="drop, µm", ylim=(12, 0))
    right.set(xlabel="y, mm", ylabel="pressure at x = 0, MPa", ylim=(0, None))
    left.legend(frameon=False)
    right.legend(frameon=False, loc="lower center")
    figure.savefig(name, dpi=80)


if __name__ == "__main__":
    if any(word.startswith("-") for word in sys.argv[1:]):
        sys.exit(__doc__.strip())
    main()
