"""Compare the gross-slip example with Archard's volume and the known pressures, and draw them.

Reads slide.h5, which examples/wear-gross-slip/run.sh writes to a directory, prints two tables, draws wear.png, and
fails when a number lies outside its tolerance. a0, d0, p0: Hertz's contact radius, approach and pressure without wear;
tau = 4 k E* u n/a0 after n cycles.

All slides, so that the volume is k N 4 u n whatever the pressure. At long times the pressure is uniform, N/(pi a^2),
and the scar is the sphere's cap: V = pi a^4/(4 R), w(0) = a^2/(2 R).
"""

import os
import sys
from pathlib import Path

import numpy as np

import petsam
from petsam.closed import Spheres
from petsam.plot.style import CLOSED, frame, plt, points, save, thinned, tint

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402

MODEL = {"tau": 1.0, "radius": 1.305, "depth": 0.4891, "pressure": 0.5875}  # by a one-dimensional model
VOLUME_TOLERANCE, TOLERANCE, LONG_TOLERANCE = 1e-6, 0.01, 0.03


class Saved(petsam.Snapshot):
    """A saved cycle in units of Hertz's contact."""

    def __init__(self, results, index):
        super().__init__(results, index)
        p = self.parameters
        self.spheres = Spheres.of(p, p["load_n"])
        hertz, self.radius0 = self.spheres.hertz, 1.0 / (1.0 / p["gap_radius1"] + 1.0 / p["gap_radius2"])
        self.a, self.d, self.p0 = hertz.radius, hertz.approach, hertz.pressure
        e_star = self.spheres.bodies.e_star
        amplitude = float(np.max(results.history["disp_x"]))
        self.archard = 4.0 * p["wear_coefficient1"] * p["load_n"] * amplitude * self["cycle"]
        self.tau = 4.0 * p["wear_coefficient1"] * e_star * amplitude * self["cycle"] / self.a

    def at_centre(self, name):
        """Value at x = y = 0, where four cells meet or one lies: a parabola along the row through the nearest cells."""
        near = np.argsort(np.abs(self.x), kind="stable")[:6]
        fit = np.polyfit((self.x[near] / self.a) ** 2, self[name][self.row, near], 1)
        return float(fit[1])

    def numbers(self):
        """Volume, contact radius, depth and pressure in the middle."""
        volume = float(self["wear_volume1"])
        found = {
            "tau": self.tau, "cycle": int(self["cycle"]),
            "volume": volume, "volume_error": volume / self.archard - 1.0,
            "radius": float(self.radius("contact_area") / self.a),
            "depth": self.at_centre("wear_depth1") / self.d, "pressure": self.at_centre("pressure") / self.p0,
        }  # fmt: skip
        radius = (4.0 * self.radius0 * self.archard / np.pi) ** 0.25 / self.a
        found["long"] = {"radius": radius, "depth": 0.5 * radius**2, "pressure": 2.0 / 3.0 / radius**2}
        return found


class Comparison:
    """All saved cycles."""

    def __init__(self, directory):
        results = petsam.open(os.path.join(directory, "slide.h5"))
        self.path = results.path
        self.saved = [Saved(results, k) for k in range(len(results.steps))]
        rows = [case.numbers() for case in self.saved[1:]]  # the first is that without wear
        near = min(rows, key=lambda row: abs(row["tau"] - MODEL["tau"]))
        names = ("radius", "depth", "pressure")
        self.numbers = {
            "saved": rows,
            "model": {name: near[name] / MODEL[name] - 1.0 for name in names},
            "long": {name: rows[-1][name] / rows[-1]["long"][name] - 1.0 for name in names},
            "computed": int(results.file["wear"]["computed"][-1]),
        }

    def tables(self):
        """What is printed; fails when a number is wrong."""
        n = self.numbers
        columns = "tau = tau:.4g; cycles = cycle; V, m3 = volume:.6e; V/(kN4un) - 1 = volume_error:+.1e"
        columns += "; a/a0 = radius:.4f; w(0)/d0 = depth:.4f; p(0)/p0 = pressure:.4f"
        yield "saved cycles", columns, n["saved"]
        columns = "against = name; a - 1 = radius:+.1e; w(0) - 1 = depth:+.1e; p(0) - 1 = pressure:+.1e"
        rows = [{"name": "model, 1", **n["model"]}, {"name": "long times", **n["long"]}]
        yield "quotients by the model at tau = 1, and by the law of long times at the end, less 1", columns, rows
        yield f"\n{n['computed']} cycles were computed of {n['saved'][-1]['cycle']}"
        volume = max(abs(row["volume_error"]) for row in n["saved"])
        model, long = (max(abs(value) for value in n[name].values()) for name in ("model", "long"))
        yield (
            f"check: volume {volume:.1e} (allowed {VOLUME_TOLERANCE:g}), model {model:.1e} ({TOLERANCE:g}), "
            f"long times {long:.1e} ({LONG_TOLERANCE:g})"
        )
        if not (volume < VOLUME_TOLERANCE and model < TOLERANCE and long < LONG_TOLERANCE):
            raise petsam.Error(f"{self.path}: the wear is wrong")

    def draw(self, directory):
        """Pressure and scar along y = 0."""
        figure, axes = plt.subplots(1, 2, figsize=(10.0, 3.9), constrained_layout=True)
        count = len(self.saved)
        for k, case in enumerate(self.saved):
            half = case.x > 0.0
            x, color = case.x[half] / case.a, tint(k, count)
            for panel, name, unit in ((axes[0], "pressure", case.p0), (axes[1], "wear_depth1", case.d)):
                values = case[name][case.row, half] / unit
                panel.plot(x, values, color=color, linewidth=0.9)
                keep = thinned(np.flatnonzero(values > 0.0), 24) if values.any() else []
                points(panel, x[keep], values[keep], color, label=f"{case.tau:.3g}")
        last = self.saved[-1].numbers()["long"]
        axes[0].plot([0.0, last["radius"]], [last["pressure"]] * 2, "--", zorder=4, label="uniform", **CLOSED)
        fine = np.linspace(0.0, last["radius"], 200)
        axes[1].plot(fine, 0.5 * (last["radius"] ** 2 - fine**2), "--", zorder=4, label="cap", **CLOSED)
        for panel in axes:
            panel.legend(title=r"cycles, $\tau$")
        frame(axes[0], "Pressure along $y = 0$", "$x/a_0$", "$p/p_0$", (0.0, 2.9))
        frame(axes[1], "Removed depth along $y = 0$", "$x/a_0$", "$w/d_0$", (0.0, 2.9))
        save(figure, directory, "wear.png")


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "wear-gross-slip"))
