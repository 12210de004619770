"""Follow the worn punch over its cycles, and draw it.

Reads life.h5 and stress_CYCLE.h5, which examples/wear-punch/run.sh writes to a directory, prints two tables, draws
wear.png, and fails when a check does not hold:
  volume   what both faces lose is k/mu times the dissipated energy: its sum over all cycles by the trapezoidal rule
  scar     the volume is the sum of the depths over the cells
  faces    both lose the same
"""

import glob
import os
import sys
from pathlib import Path

import numpy as np

import petsam
from petsam.core.errors import Missing
from petsam.plot.style import frame, joined, over_cycles, plt, save, tint

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402

VOLUME_TOLERANCE, SUM_TOLERANCE = 1e-2, 1e-9


class Life:
    """Scalars of the computed cycles, and the fields of the saved ones."""

    def __init__(self, path):
        self.results = petsam.open(path)
        p, wear = self.results.parameters, self.results.file["wear"]
        self.wear = {name: wear[name][:] for name in wear}
        self.cycle, self.c, self.mu = self.wear["cycle"], p["gap_flat_radius"], p["friction"]
        self.coefficient = p["wear_coefficient1"]
        history = self.results.history
        # the stick zone is what sticks at the largest force; elsewhere in the cycle more does
        peak = np.isclose(history["load_tx"], -np.max(history["load_tx"]))
        cycles, self.stick = history["cycle"][peak], history["stick_area"][peak]
        if not np.array_equal(cycles, self.cycle):
            raise petsam.Error(f"{path}: the computed cycles are not those of the steps")

    @property
    def base(self):
        """Area of the flat base, m2."""
        return np.pi * self.c**2

    def energy(self):
        """Energy of all cycles, J, by the trapezoidal rule."""
        energy, cycle = self.wear["dissipated_energy"], self.cycle
        return float(np.sum(0.5 * (energy[1:] + energy[:-1]) * np.diff(cycle)))


class Comparison:
    """The life and the stresses."""

    def __init__(self, directory):
        self.life = life = Life(os.path.join(directory, "life.h5"))
        paths = glob.glob(os.path.join(directory, "stress_*.h5"))
        self.stresses = {}
        for number in sorted(int(os.path.basename(path)[len("stress_") : -3]) for path in paths):
            file = petsam.open(os.path.join(directory, f"stress_{number}.h5"))
            mises = max(float(np.max(file.field("mises", k)[0])) for k in range(file.times.size))
            swt = file.field("swt")[0, 0]
            self.stresses[number] = {
                "mises": mises, "swt": float(np.max(swt)), "x": float(file.x[np.argmax(swt)]), "z": float(file.z[0])
            }  # fmt: skip
        if not self.stresses:
            raise Missing(f"{directory}: no stress_CYCLE.h5")
        rows = []
        for cycle, stress in self.stresses.items():
            k = int(np.flatnonzero(life.cycle == cycle)[0])
            rows.append({
                "cycle": cycle, "volume": life.wear["volume1"][k] * 1e9, "depth": life.wear["depth_max1"][k] * 1e6,
                "stick": life.stick[k] / life.base, "contact": life.wear["contact_area"][k] / life.base,
                "energy": life.wear["dissipated_energy"][k], "pressure": life.wear["pressure_max"][k] * 1e-6,
                "mises": stress["mises"] * 1e-6, "swt": stress["swt"] * 1e-6, "where": stress["x"] / life.c,
            })  # fmt: skip
        results, cell = life.results, np.diff(life.results.x[:2])[0] * np.diff(life.results.y[:2])[0]
        volumes = [float(life.wear[name][-1]) for name in ("volume1", "volume2")]
        self.numbers = {
            "saved": rows,
            "volume": volumes[0] * life.mu / (life.coefficient * life.energy()) - 1.0,
            "scar": float(np.sum(results.field("wear_depth1")) * cell / volumes[0] - 1.0),
            "faces": volumes[1] / volumes[0] - 1.0,
            "computed": int(life.wear["computed"][-1]),
        }

    def tables(self):
        """What is printed; fails when a check does not hold."""
        n, z = self.numbers, next(iter(self.stresses.values()))["z"]
        columns = "cycles = cycle; V, mm3 = volume:.4f; depth, um = depth:.3f; stick/pi c2 = stick:.4f"
        columns += "; area/pi c2 = contact:.4f; energy, J = energy:.4f; p, MPa = pressure:.0f; Mises, MPa = mises:.1f"
        columns += "; SWT, MPa = swt:.5f; at x/c = where:+.3f"
        title = f"volume and depth of each face; maximum Mises and SWT at z = {1e3 * z:g} mm, y = 0"
        yield title, columns, n["saved"]
        yield f"\n{n['computed']} cycles were computed of {n['saved'][-1]['cycle']}"
        yield (
            f"check: volume/(k E/mu) - 1 = {n['volume']:+.1e} (allowed {VOLUME_TOLERANCE:g}), sum of the scar "
            f"{n['scar']:+.1e}, faces {n['faces']:+.1e} ({SUM_TOLERANCE:g})"
        )
        if not (abs(n["volume"]) < VOLUME_TOLERANCE and max(abs(n["scar"]), abs(n["faces"])) < SUM_TOLERANCE):
            raise petsam.Error(f"{self.life.results.path}: the wear is wrong")

    def draw(self, directory):
        """Four panels against the cycles."""
        life, rows = self.life, self.numbers["saved"]
        z = next(iter(self.stresses.values()))["z"] / life.c
        every, saved = life.cycle, np.array([row["cycle"] for row in rows], dtype=float)
        figure, axes = plt.subplots(2, 2, figsize=(9.0, 5.8), constrained_layout=True)
        panels = (
            ("areas", "relative to the flat base", every, {
                "contact": life.wear["contact_area"] / life.base, "stick zone": life.stick / life.base}),
            ("maximum pressure", "$p$, MPa", every, {None: life.wear["pressure_max"] * 1e-6}),
            (f"maximum von Mises stress at $z$ = {z:g} $c$", "$\\sigma_M$, MPa", saved, {
                None: [row["mises"] for row in rows]}),
            (f"maximum SWT parameter at $z$ = {z:g} $c$", "SWT, MPa", saved, {None: [row["swt"] for row in rows]}),
        )  # fmt: skip
        for panel, (title, unit, cycles, curves) in zip(axes.flat, panels):
            for k, (label, values) in enumerate(curves.items()):
                joined(panel, cycles, values, tint(k, 2), "o-", label=label, markersize=3.6)
            top = 1.08 * max(np.max(values) for values in curves.values())
            frame(panel, title, "", unit, None, (0.0, top))
            over_cycles(panel, [every])
        axes[0, 0].legend(loc="lower left")
        save(figure, directory, "wear.png")


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "wear-punch"))
