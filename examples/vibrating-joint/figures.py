"""Draw the response of the vibrating joint, and check it.

Reads fresh.npz, worn.npz, life.h5 and scar.h5, which examples/vibrating-joint/run.sh writes to a directory, prints
tables, draws response.png and worn.png, and fails when a check does not hold:
  linear   at the smallest excitation the peak is at the resonance of the stuck joint, up to a little slip
  power    at each peak the power of the excitation is that of friction and the damper
  curves   the Jacobian by differences leads to the same curve as that by the tangent stiffness
"""

import os
import sys
from pathlib import Path

import numpy as np
from vibrate import CYCLES, FORCES, WEARING

import joint
import petsam
from petsam.core.errors import Missing
from petsam.plot.style import bar, extent, field, frame, logarithmic, plt, save, tint

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402

LINEAR, POWER, SAME = 0.02, 0.02, 1e-3
RING = (14.0, 28.0)  # y of the scar, mm


def read(path):
    """The curves in a file of vibrate.py."""
    if not os.path.exists(path):
        raise Missing(f"{path}: no such file")
    with np.load(path) as file:
        count = 1 + max(int(name.rpartition("_")[2]) for name in file)
        names = {name.rpartition("_")[0] for name in file}
        return [{name: file[f"{name}_{k}"] for name in names} for k in range(count)]


def powers(one):
    """Work of the excitation in a cycle at the peak, and what friction and the damper dissipate, J."""
    peak = int(np.argmax(one["amplitude"]))
    x, omega = one["coefficients"][peak].reshape(joint.COUNT, 2) @ joint.DRIVE, 2.0 * np.pi * one["frequency"][peak]
    damping = 2.0 * joint.DAMPING * joint.MASS * one["stuck"]
    harmonics = np.repeat(joint.HARMONICS, 2)
    return np.pi * one["force"] * x[1], one["energy"] + np.pi * damping * omega * np.sum(harmonics * x**2)


class Comparison:
    """All curves; the last two of fresh.npz are a part of one, by differences and by the tangent stiffness."""

    def __init__(self, directory):
        *self.fresh, self.differences, self.tangent = read(os.path.join(directory, "fresh.npz"))
        self.worn = [self.fresh[FORCES.index(WEARING)], *read(os.path.join(directory, "worn.npz"))]
        self.life, self.scar = (petsam.open(os.path.join(directory, name)) for name in ("life.h5", "scar.h5"))
        wear = self.life.wear
        self.numbers = {
            "drives": [self._row(one) for one in self.fresh],
            "worn": [
                dict(
                    self._row(one),
                    cycles=cycles,
                    volume=1e9 * float(np.interp(cycles, wear["cycle"], wear["volume1"])),
                    depth=1e6 * float(np.interp(cycles, wear["cycle"], wear["depth_max1"])),
                )
                for cycles, one in zip(CYCLES, self.worn)
            ],
            "steps": {name: int(one["trials"]) for name, one in self._jacobians()},
            "same": float(np.max(np.abs(self.differences["amplitude"] / self.tangent["amplitude"] - 1.0))),
        }

    def _jacobians(self):
        return ("differences", self.differences), ("tangent", self.tangent)

    @staticmethod
    def _row(one):
        peak = int(np.argmax(one["amplitude"]))
        drive, taken = powers(one)
        return {
            "force": float(one["force"]),
            "frequency": float(one["frequency"][peak]),
            "shift": float(2.0 * np.pi * one["frequency"][peak] / one["stuck"] - 1.0),
            "compliance": 1e9 * float(one["amplitude"][peak] / one["force"]),
            "reach": float(np.max(np.abs(one["loads"][:, 0])) / joint.LIMIT),
            "energy": float(one["energy"]),
            "power": float(taken / drive - 1.0),
        }

    def tables(self):
        """What is printed; fails when a check does not hold."""
        n = self.numbers
        columns = "excitation, N = force:.0f; peak, Hz = frequency:.1f; shift = shift:+.3f; nm/N = compliance:.2f"
        columns += "; T/mu N = reach:.3f; friction, J = energy:.4f"
        yield "peaks of the response curves", columns, n["drives"]
        yield (
            f"the same excitation, {WEARING:g} N, after cycles at its peak; volume and depth of each face",
            "cycles = cycles; V, mm3 = volume:.4f; depth, um = depth:.3f; " + columns.partition("; ")[2],
            n["worn"],
        )
        steps = n["steps"]
        fewer = steps["differences"] / steps["tangent"]
        yield (
            f"\ncontact steps: {steps['differences']} by differences, {steps['tangent']} with the Jacobian by "
            f"the tangent stiffness, {fewer:.1f} times fewer; the curves differ by {n['same']:.1e}"
        )
        first, power = n["drives"][0]["shift"], max(abs(row["power"]) for row in n["drives"] + n["worn"])
        yield f"check: shift at the least excitation {first:+.3f} (allowed {LINEAR:g}), power {power:.1e} ({POWER:g})"
        if not (abs(first) < LINEAR and power < POWER and n["same"] < SAME):
            raise petsam.Error("the vibration is wrong")

    def draw(self, directory):
        """Response, loops and slip of the fresh joint; response and scar of the worn one."""
        self._draw_fresh(directory)
        self._draw_worn(directory)

    def _draw_fresh(self, directory):
        figure, (left, middle, right) = plt.subplots(1, 3, figsize=(13.0, 4.0), constrained_layout=True)
        for k, one in enumerate(self.fresh):
            color = tint(k, len(self.fresh))
            label = f"{float(one['force']) / 1e3:g} kN"
            left.plot(one["frequency"], 1e9 * one["amplitude"] / one["force"], ".-", color=color, label=label)
            x, t = 1e6 * (one["motion"][:, 0] - one["loads"][:, 0] / one["stiffness"]), one["loads"][:, 0] / joint.LIMIT
            middle.plot(np.append(x, x[0]), np.append(t, t[0]), color=color)
        frame(left, "Response: amplitude relative to the force", "frequency, Hz", "amplitude/force, nm/N")
        logarithmic(left, "y")
        left.legend(title="excitation")
        frame(middle, "Loops of the joint at the peaks", "displacement by slip $d_x - T_x/k_c$, µm", "$T_x/(\\mu N)$")
        self._draw_slip(right, self.fresh[-1], f"{FORCES[-1] / 1e3:g} kN")
        save(figure, directory, "response.png")

    def _draw_slip(self, axis, one, label):
        r = self.life
        slip = 1e6 * one["slip"]
        image = field(axis, slip, extent(1e3 * r.x, 1e3 * r.y))
        axis.contour(1e3 * r.x, 1e3 * r.y, np.nan_to_num(slip), levels=[0.1], colors="w", linewidths=0.8)
        axis.text(0.0, 0.0, "stick", color="w", ha="center", va="center")
        frame(axis, f"Slip in a cycle at the peak, {label}", "$x$, mm", "$y$, mm", (-26.0, 26.0), (-26.0, 26.0))
        bar(axis, image, "range of $s_x$, µm")

    def _draw_worn(self, directory):
        figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 4.2), constrained_layout=True)
        for k, (cycles, one) in enumerate(zip(CYCLES, self.worn)):
            color, label = tint(k, len(CYCLES)), f"{cycles:,} cycles"
            left.plot(one["frequency"], 1e9 * one["amplitude"] / one["force"], ".-", color=color, label=label)
            if cycles:
                for file, look in (self.scar, {"linestyle": "-"}), (self.life, {"marker": "o", "linestyle": "none"}):
                    depth = file.field("wear_depth1", file.of_cycle(cycles))
                    column = np.argmax(depth.max(axis=0))  # of the deepest cell
                    y, depth = 1e3 * file.y, 1e6 * depth[:, column]
                    shown = (y > RING[0]) & (y < RING[1])
                    text = f"{cycles:,} cycles, {file.y.size}² cells"
                    right.plot(y[shown], depth[shown], color=color, markersize=4.0, label=text, **look)
        title = f"Response of the worn joint, excitation {WEARING / 1e3:g} kN"
        frame(left, title, "frequency, Hz", "amplitude/force, nm/N")
        left.legend(title="after")
        frame(right, "Scar of each face across the ring of slip", "$y$, mm  at $x$ = 0", "removed depth, µm", RING)
        right.legend(loc="upper left")
        save(figure, directory, "worn.png")


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "vibrating-joint"))
