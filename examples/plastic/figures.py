"""The dent of a ball and fretting above yield: numbers of the results that run.sh writes, and plastic.png."""

import os
import sys
from pathlib import Path

import numpy as np

import petsam
from petsam.plot.style import COLORS, bar, frame, logarithmic, plt, points, save

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402

STEPS_OF_HALF = 4  # load steps of half a cycle


def halves(results, name):
    """Sums over half cycles of a number of the steps, after the first step."""
    return np.asarray(results.history[name])[1:].reshape(-1, STEPS_OF_HALF).sum(axis=1)


def row(results, name, step):
    """A field along the row of cells beside y = 0."""
    field = results.quantity(name, step)
    return field[field.shape[0] // 2]


class Comparison:
    """The ball and the fretting contact, each with bodies that yield and with elastic ones."""

    def __init__(self, directory):
        self.press, self.elastic, self.fret, self.hard = (
            petsam.open(os.path.join(directory, f"{name}.h5"))
            for name in ("press", "press-elastic", "fret", "fret-elastic")
        )
        self.numbers = {
            "peak_elastic_mpa": 1e-6 * self.elastic.history["pressure_max"][4],
            "peak_mpa": 1e-6 * self.press.history["pressure_max"][4],
            "strain": 100 * self.press.history["plastic_max"][4],
            "dent_um": 1e6 * float(np.max(self.press.quantity("residual_z", 9))),
            "residual_mpa": [1e-6 * float(edge(self.stress())) for edge in (np.min, np.max)],
            "plastic_work_uj": [1e6 * w for w in halves(self.fret, "plastic_work")],
            "friction_uj": [1e6 * w for w in halves(self.fret, "dissipated_energy")],
            "friction_elastic_uj": [1e6 * w for w in halves(self.hard, "dissipated_energy")],
            "dents_um": [1e6 * float(z) for z in self.fret.history["residual_z_max"][::STEPS_OF_HALF]],
            "reversed": 100 * float(np.subtract(*self.fret.history["plastic_max"][[-1, -1 - STEPS_OF_HALF]])),
        }

    def stress(self):
        """Residual stress xx below the row beside y = 0 when the load is gone, Pa."""
        values = self.press.field("plastic/residual_stress_xx", 9)
        return values[:, values.shape[1] // 2]

    def tables(self):
        """What the page prints, as sentences."""
        n = self.numbers
        elastic, strain = n["peak_elastic_mpa"], n["strain"]
        yield f"100 N: peak pressure {n['peak_mpa']:.0f} MPa, elastic {elastic:.0f} MPa; strain up to {strain:.2f} %"
        yield f"unloaded: a dent of {n['dent_um']:.3f} um"
        yield "residual stress along x: {:.0f} to {:.0f} MPa".format(*n["residual_mpa"])
        yield "plastic work of the half cycles: " + " ".join(f"{w:.2g}" for w in n["plastic_work_uj"]) + " uJ"
        last, hard = n["friction_uj"][7], n["friction_elastic_uj"][7]
        yield f"friction of the last half cycle {last:.3f} uJ, elastic {hard:.3f} uJ"
        yield "dent before and after each half cycle: " + " ".join(f"{z:.2f}" for z in n["dents_um"]) + " um"
        yield f"accumulated plastic strain grows by {n['reversed']:.2f} % in the last half cycle"

    def draw(self, directory):
        """Pressure and dent of the ball; energies of the half cycles of fretting."""
        x = 1e3 * np.asarray(self.press.x)
        figure, axes = plt.subplots(2, 2, figsize=(10.0, 7.0), layout="constrained")
        axes = axes.flat
        for results, color, mark, name in (
            (self.elastic, COLORS[1], "s-", "elastic"),
            (self.press, COLORS[0], "o-", "yields at 600 MPa"),
        ):
            points(axes[0], x, 1e-6 * row(results, "pressure", 4), color, mark, linewidth=0.8, label=name)
        frame(axes[0], "Pressure under 100 N", "$x$, mm", "$p$, MPa")
        axes[0].legend()
        points(axes[1], x, 1e6 * row(self.press, "residual_z", 9), COLORS[0], "o-", linewidth=0.8)
        axes[1].invert_yaxis()
        frame(axes[1], "The dent, unloaded", "$x$, mm", "residual displacement, µm")
        # the layers' values are those of their middles: the outer ones reach to the surface and to the bottom
        middles, stress = 1e3 * self.press.layer_z, 1e-6 * self.stress()
        z = np.array([0.0, *middles, middles[-1] + 0.5 * (middles[-1] - middles[-2])])
        stress = stress[[0, *range(middles.size), -1]]
        most = float(np.abs(stress).max())
        image = axes[2].contourf(x, z, stress, levels=np.linspace(-most, most, 25), cmap="RdBu_r")
        axes[2].grid(False)
        axes[2].set_xticks([-0.2, -0.1, 0.0, 0.1, 0.2])
        axes[2].set_ylim(z[-1], z[0])
        bar(axes[2], image, "residual $\\sigma_{xx}$, MPa", ticks=np.round(np.linspace(-most, most, 5), -1))
        frame(axes[2], "Residual stress, unloaded", "$x$, mm  at $y$ = 0", "depth $z$, mm")
        for results, name, style, color, label in (
            (self.fret, "plastic_work", "o-", COLORS[0], "plastic work"),
            (self.fret, "dissipated_energy", "s-", COLORS[2], "friction"),
            (self.hard, "dissipated_energy", "s--", COLORS[1], "friction, elastic"),
        ):
            energy = 1e6 * halves(results, name)
            axes[3].plot(np.arange(1, len(energy) + 1), energy, style, color=color, label=label)
        logarithmic(axes[3], "y")
        frame(axes[3], "Fretting above yield", "half cycle", "energy of a half cycle, µJ")
        axes[3].legend()
        save(figure, directory, "plastic.png")


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "plastic"))
