"""The dent of a ball and fretting above yield: numbers of the results that run.sh writes, and plastic.png."""

import argparse
import json
from pathlib import Path

import numpy as np

import petsam
from petsam.plot.style import COLORS, STYLE, plt, save

STEPS_OF_HALF = 4  # load steps of half a cycle


def halves(results, name):
    """Sums over half cycles of a number of the steps, after the first step."""
    return np.asarray(results.history[name])[1:].reshape(-1, STEPS_OF_HALF).sum(axis=1)


def row(results, name, step):
    """A field along the row of cells beside y = 0."""
    field = results.quantity(name, step)
    return field[field.shape[0] // 2]


def draw(folder, press, elastic, fret, hard):
    x = 1e3 * np.asarray(press.x)
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(1, 3, figsize=(12, 3.8), layout="constrained")
        axes[0].plot(x, 1e-6 * row(elastic, "pressure", 4), color=COLORS[1], ls="--", label="elastic")
        axes[0].plot(x, 1e-6 * row(press, "pressure", 4), color=COLORS[0], label="yields at 600 MPa")
        axes[0].set(xlabel="x, mm", ylabel="pressure, MPa", title="Under 100 N")
        axes[0].legend()
        axes[1].plot(x, 1e6 * row(press, "residual_z", 9), color=COLORS[0])
        axes[1].invert_yaxis()
        axes[1].set(xlabel="x, mm", ylabel="residual displacement, µm", title="The dent, unloaded")
        k = np.arange(1, len(halves(fret, "plastic_work")) + 1)
        axes[2].semilogy(k, 1e6 * halves(fret, "plastic_work"), "o-", color=COLORS[0], label="plastic work")
        axes[2].semilogy(k, 1e6 * halves(fret, "dissipated_energy"), "s-", color=COLORS[2], label="friction")
        axes[2].semilogy(k, 1e6 * halves(hard, "dissipated_energy"), "s--", color=COLORS[1], label="friction, elastic")
        axes[2].set(xlabel="half cycle", ylabel="energy of a half cycle, µJ", title="Fretting above yield shakes down")
        axes[2].legend()
        save(figure, str(folder), "plastic.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--json", type=Path)
    args = parser.parse_args()
    press, elastic, fret, hard = (
        petsam.open(args.folder / f"{name}.h5") for name in ("press", "press-elastic", "fret", "fret-elastic")
    )
    numbers = {
        "peak_elastic_mpa": 1e-6 * elastic.history["pressure_max"][4],
        "peak_mpa": 1e-6 * press.history["pressure_max"][4],
        "strain": 100 * press.history["plastic_max"][4],
        "dent_um": 1e6 * float(np.max(press.quantity("residual_z", 9))),
        "plastic_work_uj": [1e6 * w for w in halves(fret, "plastic_work")],
        "friction_uj": [1e6 * w for w in halves(fret, "dissipated_energy")],
        "friction_elastic_uj": [1e6 * w for w in halves(hard, "dissipated_energy")],
        "shaken_down": int(fret.history["shaken_down"][-1]),
    }
    lines = (
        "100 N: peak pressure {peak_mpa:.0f} MPa, elastic {peak_elastic_mpa:.0f} MPa; strain up to {strain:.2f} %",
        "unloaded: a dent of {dent_um:.3f} um",
        "plastic work of the half cycles: {work} uJ",
        "friction of the last half cycle {friction_uj[7]:.3f} uJ, elastic {friction_elastic_uj[7]:.3f} uJ",
        "shaken down: the last {shaken_down} steps add no plastic strain",
    )
    work = " ".join(f"{w:.2g}" for w in numbers["plastic_work_uj"])
    print("\n".join(lines).format(work=work, **numbers))
    draw(args.folder, press, elastic, fret, hard)
    if args.json:
        args.json.write_text(json.dumps(numbers, indent=1) + "\n")


if __name__ == "__main__":
    main()
