"""Lives of the flank of a dovetail by SWT: numbers of the results that flank.sh writes, and flank.png."""

import os
import sys
from pathlib import Path

import numpy as np

import petsam
from petsam.apps.fatigue.strength import swt
from petsam.plot.style import COLORS, frame, logarithmic, plt, save

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402

CASES = ("elastic", "yields", "peened")
STEEL = dict(sigma_f=1.2e9, b=-0.09, epsilon_f=0.6, c=-0.6)  # strain-life curve of the steel, assumed
YOUNG = 210e9
CYCLE = 16  # load steps from the full load to the full load
DEPTH = 30e-6  # m
LEAST = 1e-5  # of the plastic work of the first loading; less is left by the tolerance


class Comparison:
    """The flank of elastic bodies, of steel that yields, and of peened steel that yields."""

    def __init__(self, directory):
        self.runs = {name: petsam.open(os.path.join(directory, f"{name}.h5")) for name in CASES}
        self.fatigue = {name: petsam.open(os.path.join(directory, f"{name}-swt.h5")) for name in CASES}
        self.numbers = {"cases": [self.case(name) for name in CASES]}

    def values(self, name):
        """SWT over depth and x, Pa."""
        return np.asarray(self.fatigue[name].field("swt"))[:, 0, :]

    def case(self, name):
        values, depths = self.values(name), self.fatigue[name].z
        below = values[np.argmin(np.abs(depths - DEPTH))]
        work = self.runs[name].history.get("plastic_work")
        return {
            "case": name,
            "swt_mpa": 1e-6 * float(values[0].max()),
            "life": float(swt(values[0].max(), YOUNG, **STEEL)),
            "swt_below_mpa": 1e-6 * float(below.max()),
            "work": [] if work is None else [float(w) for w in self.cycles(np.asarray(work))],
        }

    @staticmethod
    def cycles(work):
        """Plastic work of the first loading, and of each cycle after it."""
        return work.reshape(-1, CYCLE).sum(axis=1)

    def tables(self):
        yield "maximum of SWT on the surface, life by it, maximum 30 um below:"
        for one in self.numbers["cases"]:
            yield (
                f"{one['case']}: {one['swt_mpa']:.2f} MPa, {float(format(one['life'], '.2g')):,.0f} cycles; "
                f"{one['swt_below_mpa']:.2f} MPa"
            )
        for one in self.numbers["cases"][1:]:
            joined = " ".join(f"{w:.1g}" for w in one["work"] if w > LEAST * one["work"][0])
            yield f"{one['case']}: plastic work of the first loading and of each cycle {joined} J/m"

    def draw(self, directory):
        figure, axes = plt.subplots(1, 2, figsize=(10.0, 3.8), layout="constrained")
        for name, color in zip(CASES, COLORS):
            file, values = self.fatigue[name], self.values(name)
            axes[0].plot(1e3 * np.asarray(file.x), 1e-6 * values[0], color=color, label=name)
            place = int(np.argmax(values[0]))
            axes[1].plot(1e-6 * values[:, place], 1e6 * np.asarray(file.z), color=color, label=name)
        axes[0].set_xlim(-1.9, -1.4)
        frame(axes[0], "SWT on the surface, at the trailing edge", "$x$, mm", "SWT, MPa")
        axes[0].legend()
        axes[1].invert_yaxis()
        logarithmic(axes[1], "x")
        axes[1].set_xlim(1e-2, 5.0)
        frame(axes[1], "Below its maximum", "SWT, MPa", "depth, µm")
        save(figure, directory, "flank.png")


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "flank"))
