"""Compare the Popov example's life with a one-dimensional model and its last shape with Popov's; draw both.

Reads life.h5, which examples/wear-popov/run.sh writes to a directory, prints the table, draws wear.png, and fails when
a number lies outside its tolerance. Lengths over a0 or d, loads over N0; tau = 4 k E* u0 n/a0 after n cycles.

Popov's limit (Sci. Rep. 4, 2014, 3749): outside the stick radius c = a0/2 the worn gap becomes

    f/d = (2/pi) [(rho^2/2) asin(gam/rho) - (gam/2) sqrt(rho^2 - gam^2) + acos(gam/rho)],  rho = r/a0, gam = c/a0

as far as it exceeds rho^2/2: what is removed is the difference.
"""

import os
import sys
from pathlib import Path

import numpy as np

import petsam
from petsam.closed import Spheres
from petsam.plot.style import CLOSED, frame, logarithmic, plt, points, save, thinned, tint

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402

GAMMA = 0.5
LIMIT_RADIUS, LIMIT_VOLUME, LIMIT_DEPTH, LIMIT_LOAD = 1.2297905755, 0.7592985781, 0.29654947, 0.6875
# tau: volume, maximum depth, load, contact radius by the method of dimensionality reduction, which is exact here
MODEL = {
    0.1: (0.01233, 0.00792, 0.99360, 1.0165), 1: (0.13092, 0.07102, 0.93843, 1.083),
    3: (0.40375, 0.18048, 0.8272, 1.157), 5: (0.6088, 0.25095, 0.7479, 1.197), 10: (0.7481, 0.29345, 0.6920, 1.226),
}  # fmt: skip
NAMES = ("volume", "depth", "load", "radius")
TOLERANCE = 0.02  # of the table's numbers, and of the limit; one of the shape, over d


def limit_depth(rho):
    """What is removed at last, over d."""
    outside = np.maximum(rho, GAMMA)
    ratio = GAMMA / outside
    worn = 0.5 * outside**2 * np.arcsin(ratio) - 0.5 * GAMMA * np.sqrt(outside**2 - GAMMA**2) + np.arccos(ratio)
    return np.maximum(2.0 / np.pi * worn - 0.5 * outside**2, 0.0) * (rho > GAMMA)


class Life:
    """A life in the model's units."""

    def __init__(self, path):
        self.results = petsam.open(path)
        p = self.results.parameters
        radius = 1.0 / (1.0 / p["gap_radius1"] + 1.0 / p["gap_radius2"])
        self.d = p["disp_z"]
        self.a0 = np.sqrt(radius * self.d)
        self.spheres = Spheres.of(p, 1.0)
        e_star = self.spheres.bodies.e_star
        self.n0 = 4.0 / 3.0 * e_star * self.a0 * self.d
        self.u0 = float(np.max(self.results.history["disp_x"]))
        self.per_cycle = 4.0 * p["wear_coefficient1"] * e_star * self.u0 / self.a0
        wear = self.results.file["wear"]
        self.wear = {name: wear[name][:] for name in wear}
        self.tau = self.wear["cycle"] * self.per_cycle
        # the last step of each computed cycle
        cycle = self.results.history["cycle"]
        ends = np.flatnonzero(np.append(np.diff(cycle) > 0.0, True))
        self.curves = {
            "volume": self.wear["volume1"] / (self.a0**2 * self.d),
            "depth": self.wear["depth_max1"] / self.d,
            "load": self.results.history["load_n"][ends] / self.n0,
            "radius": np.sqrt(self.wear["contact_area"] / np.pi) / self.a0,
        }
        self.saved = self.results.history["cycle"][np.array(self.results.steps) - 1] * self.per_cycle

    def at(self, tau):
        """Number of the computed cycle at tau."""
        return int(np.argmin(np.abs(self.tau - tau)))

    def profile(self, index):
        """rho and the depth over d, along the row nearest y = 0, of a saved step."""
        x, y = self.results.x, self.results.y
        row = int(np.argmin(np.abs(y)))
        return np.hypot(x, y[row]) / self.a0, x / self.a0, self.results.field("wear_depth1", index)[row] / self.d


class Comparison:
    """The life and its limit."""

    def __init__(self, directory):
        self.life = life = Life(os.path.join(directory, "life.h5"))
        rows = []
        for tau, model in MODEL.items():
            k = life.at(tau)
            row = {"tau": float(life.tau[k]), "cycle": int(life.wear["cycle"][k])}
            for name, exact in zip(NAMES, model):
                row[name] = float(life.curves[name][k])
                row[name + "_error"] = row[name] / exact - 1.0
            rows.append(row)
        rho = np.hypot(life.results.x[None, :], life.results.y[:, None]) / life.a0
        difference = np.abs(life.results.field("wear_depth1") / life.d - limit_depth(rho))
        worst = np.unravel_index(np.argmax(difference), difference.shape)
        limit = {
            "tau": float(life.tau[-1]),
            "cells": int(life.results.x.size),
            "volume": float(life.curves["volume"][-1] / LIMIT_VOLUME - 1.0),
            "depth": float(life.curves["depth"][-1] / LIMIT_DEPTH - 1.0),
            "load": float(life.curves["load"][-1] / LIMIT_LOAD - 1.0),
            "shape": float(difference[worst]),
            "where": float(rho[worst]),
            "beyond": float(np.max(difference[rho > GAMMA + 0.05])),
        }
        self.numbers = {"life": rows, "limit": limit, "computed": int(life.wear["computed"][-1])}

    def tables(self):
        """What is printed; fails when a number is wrong."""
        n = self.numbers
        columns = (
            "tau = tau:.4g; cycles = cycle; V/(a0^2 d) = volume:.5f; V - 1 = volume_error:+.1e; depth/d = depth:.5f"
        )
        columns += "; depth - 1 = depth_error:+.1e; N/N0 = load:.5f; N - 1 = load_error:+.1e; a/a0 = radius:.4f"
        columns += "; a - 1 = radius_error:+.1e"
        yield "wear over the cycles; ratios to the model minus 1", columns, n["life"]
        columns = "tau = tau:.4g; cells = cells; V - 1 = volume:+.1e; depth - 1 = depth:+.1e; N - 1 = load:+.1e"
        columns += "; shape = shape:.1e; at rho = where:.3f; rho>0.55 = beyond:.1e"
        yield "Popov's limit; shape: maximum difference of the removed depth, over d", columns, [n["limit"]]
        yield f"\n{n['computed']} cycles were computed of {self.life.wear['cycle'][-1]:.0f}"
        errors = [abs(row[name + "_error"]) for row in n["life"] for name in NAMES]
        errors += [abs(n["limit"][name]) for name in ("volume", "depth", "load", "beyond")]
        yield f"check: maximum error {max(errors):.1e}, {TOLERANCE:g} is allowed"
        if not max(errors) < TOLERANCE:
            raise petsam.Error(f"{self.life.results.path}: the wear is wrong")

    def draw(self, directory):
        """Profiles of the scar, and the life."""
        life = self.life
        figure, axes = plt.subplots(1, 2, figsize=(10.0, 3.9), constrained_layout=True)
        for k, tau in enumerate(life.saved):
            rho, x, depth = life.profile(k)
            keep = thinned(np.flatnonzero(x > 0.0), 60)
            last = k == len(life.saved) - 1
            axes[0].plot(x[x > 0], depth[x > 0], color=tint(k, len(life.saved)), linewidth=1.0)
            if last:
                points(axes[0], x[keep], depth[keep], tint(k, len(life.saved)))
            axes[0].plot([], [], color=tint(k, len(life.saved)), label=f"{tau:.3g}")
        fine = np.linspace(0.3, 1.3, 1001)
        axes[0].plot(fine, limit_depth(fine), label="Popov", zorder=4, **CLOSED)
        axes[0].legend(title=r"cycles, $\tau$")
        frame(axes[0], "Removed depth along $y = 0$", "$x/a_0$", "$w/d$", (0.3, 1.3))
        labels = ("volume$/(a_0^2 d)$", "maximum depth$/d$", "$N/N_0$", "$a/a_0$")
        for k, (name, label) in enumerate(zip(NAMES, labels)):
            color = tint(k, len(NAMES))
            axes[1].plot(life.tau[1:], life.curves[name][1:], "-", color=color, linewidth=1.0, label=label)
            points(axes[1], list(MODEL), [row[k] for row in MODEL.values()], color)
        logarithmic(axes[1], "x")
        axes[1].legend(loc="center left")
        frame(
            axes[1],
            "Over the cycles; points: one-dimensional model",
            r"scaled cycles $\tau$",
            "relative",
            (0.01, 20.0),
            (0.0, 1.3),
        )
        save(figure, directory, "wear.png")


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "wear-popov"))
