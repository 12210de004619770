"""Pressure, radius and approach of a rigid sphere on coated flats, and partial slip of two coated bodies.

Reads the HDF5 files that examples/coating/run.sh writes to a directory, draws coating.png and prints the numbers,
beside the solutions of integral equations where they are known.
"""

import os
import sys
from pathlib import Path

import numpy as np

import petsam
from petsam.plot.style import COLORS, frame, joined, logarithmic, plt, points, save

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402

RATIOS = ("0.1", "0.5", "2", "10")
THICKNESSES = ("0.1", "0.3", "1", "3")  # of the tables
DRAWN = ("0.1", "0.17", "0.3", "0.45", "0.6", "0.8", "1", "1.7", "3")
SHAPES = (("0.1", "0.3"), ("0.5", "0.3"), ("2", "0.3"), ("10", "0.3"))  # whose pressures are drawn
TINTS = dict(zip(RATIOS, (COLORS[0], "#2a9d72", COLORS[1], "0.35")))
LOAD, RADIUS, MODULUS = 100.0, 0.1, 210e9 / 0.91  # N, m, Pa
MARKS = dict(zip(RATIOS, "os^D"))
A = (0.75 * LOAD * RADIUS / MODULUS) ** (1 / 3)
P0 = 1.5 * LOAD / (np.pi * A**2)
# contact radius, peak pressure and approach over those without coating (Poisson's ratio 0.3 throughout)
EXACT = {
    ("0.1", "0.1"): (1.270815613, 0.735112125, 1.202485789),
    ("0.1", "1"): (1.834126934, 0.331111124, 2.186382489),
    ("0.5", "0.3"): (1.110868897, 0.874492079, 1.080371403),
    ("0.5", "1"): (1.206607645, 0.704682272, 1.227128046),
    ("2", "0.3"): (0.908892359, 1.095008555, 0.947110271),
    ("2", "1"): (0.818477540, 1.475436899, 0.826869969),
    ("10", "0.3"): (0.710121732, 1.273788556, 0.859776394),
}


PULLS = {"none": "steel", "soft": "0.4E, 0.1 mm", "hard": "4E, 0.1 mm", "thin": "4E, 30 um", "graded": "2E...E, 0.3 mm"}
SMALL = {"fontsize": 8.5, "color": "0.35", "ha": "right", "va": "top"}
PULL_MARKS = dict(zip(PULLS, "os^Dv"))


class Pull:
    """The tension behind a sphere that slides almost in full."""

    def __init__(self, directory, name):
        stress = petsam.open(os.path.join(directory, f"pull_{name}-stress.h5"))
        self.x, self.z, self.principal = stress.x, stress.z, stress.field("principal_1")[:, 0, :]
        contact = Case(directory, f"pull_{name}")
        self.radius = contact.contact * A
        k = int(np.argmax(self.principal[0]))
        self.row = {
            "film": PULLS[name],
            "peak": contact.peak * P0 / 1e6,
            "tension": self.principal[0, k] / 1e6,
            "place": self.x[k] / self.radius,
        }


class Case(petsam.Snapshot):
    """The last step of a run, over the numbers without coating."""

    def __init__(self, directory, name):
        super().__init__(petsam.open(os.path.join(directory, name + ".h5")))
        history = self.results.history
        if np.any(history["status"] != 0):
            raise petsam.Error(f"{self.results.path}: a step did not converge")
        self.contact = self.radius("contact_area") / A
        nearest = np.argsort(self.r, axis=None)[:12]  # a parabola through the cells about the axis
        fit = np.polyfit(self.r.ravel()[nearest] ** 2, self["pressure"].ravel()[nearest], 1)
        self.central, self.peak = fit[1] / P0, float(np.max(self["pressure"])) / P0
        self.approach = float(history["disp_z"][-1]) * RADIUS / A**2
        self.slip = float(history["disp_x"][-1])
        self.stick = float(np.sqrt(history["stick_area"][-1] / history["contact_area"][-1]))


def numbers(ratio, thickness, case):
    """A row of the table; errors where a reference is at hand."""
    row = {
        "ratio": float(ratio),
        "thickness": float(thickness),
        "radius": case.contact,
        "central": case.central,
        "peak": case.peak,
        "approach": case.approach,
    }
    computed = (case.contact, case.central, case.approach)
    if (ratio, thickness) in EXACT:
        errors = [value / exact - 1 for value, exact in zip(computed, EXACT[ratio, thickness])]
        row.update(zip(("radius_error", "central_error", "approach_error"), errors))
    return row


class Comparison:
    """All results of a directory."""

    def __init__(self, directory):
        self.cases = {(e, h): Case(directory, f"e{e}_h{h}") for e in RATIOS for h in DRAWN}
        self.slides = {e: Case(directory, f"slide_e{e}") for e in ("0.1", "1", "10")}
        self.pulls = {name: Pull(directory, name) for name in PULLS}
        self.numbers = {
            "pulls": [pull.row for pull in self.pulls.values()],
            "cases": [numbers(e, h, self.cases[e, h]) for e in RATIOS for h in THICKNESSES],
            "slides": [
                {"ratio": float(e), "radius": case.contact, "peak": case.peak, "slip": case.slip, "stick": case.stick}
                for e, case in self.slides.items()
            ],
        }

    def tables(self):
        """The tables."""
        yield (
            "Rigid sphere: contact radius, central and peak pressure, approach, over those without coating",
            (
                "E1/E2 = ratio:g; h/a = thickness:g; radius = radius:.4f; central p = central:.4f; peak p = peak:.4f; "
                "approach = approach:.4f"
            ),
            self.numbers["cases"],
        )
        yield (
            "Errors against integral equations",
            (
                "E1/E2 = ratio:g; h/a = thickness:g; radius = radius_error:+.0e; central p = central_error:+.0e; "
                "approach = approach_error:+.0e"
            ),
            [row for row in self.numbers["cases"] if "radius_error" in row],
        )
        yield (
            "Two alike coated bodies, h/a = 0.5, T_x = 0.6 mu N",
            ("E1/E2 = ratio:g; radius = radius:.4f; peak p = peak:.4f; d_x, m = slip:.4e; stick radius = stick:.4f"),
            self.numbers["slides"],
        )

        yield (
            "Sliding towards +x, friction 0.3: peak tension at the surface",
            ("film = film; peak p, MPa = peak:.0f; tension, MPa = tension:.0f; at x/radius = place:.2f"),
            self.numbers["pulls"],
        )

    def draw(self, directory):
        """Pressure and radius over thickness, and the shapes of the pressure."""
        figure, axes = plt.subplots(1, 3, figsize=(13.0, 4.4), constrained_layout=True)
        over = [float(h) for h in DRAWN]
        for e in RATIOS:
            cases = [self.cases[e, h] for h in DRAWN]
            for panel, values, column in (
                (axes[0], [c.central for c in cases], 1),
                (axes[1], [c.contact for c in cases], 0),
            ):
                joined(panel, over, values, TINTS[e], MARKS[e] + "-", label=f"$E_1/E_2 = {e}$")
                exact = [(float(h), EXACT[e, h][column]) for h in THICKNESSES if (e, h) in EXACT]
                panel.plot(*zip(*exact), "x", color="black", markersize=7, zorder=3)
        axes[0].plot([], [], "x", color="black", label="integral equations")
        for e, h in SHAPES:
            case, row = self.cases[e, h], self.cases[e, h].y.size // 2
            touching = case["pressure"][row] > 0.0
            curve = np.where(touching, case["pressure"][row] / P0, np.nan)
            points(axes[2], case.x / A, curve, TINTS[e], MARKS[e] + "-", linewidth=1.0, label=f"$E_1/E_2 = {e}$")
        for panel in axes[:2]:
            logarithmic(panel, "x")
        thickness = "thickness of the film $h/a$"
        frame(axes[0], "Central pressure, relative to no film", thickness, "$p/p_0$")
        frame(axes[1], "Contact radius, relative to no film", thickness, "radius$/a$")
        frame(axes[2], "Pressure along $x$ in the cells, $h = 0.3\\,a$", "$x/a$", "$p/p_0$", (0.0, 1.6), (0.0, None))
        axes[0].legend()
        axes[2].legend()
        save(figure, directory, "coating.png")
        self._draw_pulls(directory)

    def _draw_pulls(self, directory):
        """The tension behind the sphere that slides, along the surface and below it, where lines mark interfaces."""
        figure, axes = plt.subplots(1, 2, figsize=(10.0, 4.2), constrained_layout=True)
        for (name, pull), color in zip(self.pulls.items(), COLORS):
            behind = int(np.argmax(pull.principal[0]))
            look = {"color": color, "marker": PULL_MARKS[name], "markersize": 4.0, "linewidth": 1.2}
            axes[0].plot(pull.x / pull.radius, pull.principal[0] / 1e6, **look, markevery=8)
            # an interface stands twice among the depths: the stress jumps there, the curve does not
            jumps = np.flatnonzero(np.diff(pull.z) <= 1e-9 * pull.z[-1]) + 1
            stress, depth = pull.principal[:, behind] / 1e6, 1e3 * pull.z
            below = (np.insert(values, jumps, np.nan) for values in (stress, depth))
            axes[1].plot(*below, **look, markevery=10, label=PULLS[name].replace("um", "µm"))
            for k in jumps if name != "graded" else ():  # in which the sublayers' faces are no film's
                points(axes[1], stress[k - 1 : k + 1], depth[k - 1 : k + 1], color, PULL_MARKS[name], markersize=5.0)
        for depth, who in ((0.03, "interface at 30 µm"), (0.1, "interfaces at 0.1 mm")):
            axes[1].axhline(depth, color="0.35", linewidth=0.8, linestyle="--")
            axes[1].annotate(who, (0.98, depth), (0, -3), axes[1].get_yaxis_transform(), "offset points", **SMALL)
        label = "maximum principal stress, MPa"
        frame(axes[0], "At the surface, sliding to the right", "$x$ / contact radius", label, (-1.35, 1.35))
        frame(axes[1], "Below the place of its maximum", label, "depth, mm", None, (0.3, 0.0))
        axes[1].legend(title="film: modulus, thickness", loc="lower right")
        save(figure, directory, "pull.png")


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "coating"))
