"""Draw the fretting pad: stick and slip, the loop of a cycle, the scar, and fatigue under the pad.

Reads cycle.h5, fatigue.h5 and scar.h5, which examples/pad/run.sh writes to a directory, prints what the pictures show,
and draws pad.png.
"""

import os
import sys
from pathlib import Path

import numpy as np
from matplotlib.colors import ListedColormap

import petsam
from petsam import cycles
from petsam.plot.fields import STATES
from petsam.plot.loops import cycle_energy
from petsam.plot.style import DAMAGE, bar, cross, extent, field, frame, plt, reach, save, tint

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402

WINDOW = (-0.9, 0.9, -1.5, 1.5)  # of the maps, mm


class Comparison:
    """The three results files."""

    def __init__(self, directory):
        self.cycle, self.fatigue, self.scar = (
            petsam.open(os.path.join(directory, name + ".h5")) for name in ("cycle", "fatigue", "scar")
        )
        self.step, self.worn = petsam.Snapshot(self.cycle), petsam.Snapshot(self.scar)
        history, wear = self.cycle.history, self.scar.wear
        self.swt = self.fatigue.field("swt")[:, 0]
        z, x = np.unravel_index(np.argmax(self.swt), self.swt.shape)
        self.place = self.fatigue.x[x], self.fatigue.z[z]
        self.numbers = {
            "stick": float(history["stick_area"][-1] / history["contact_area"][-1]),
            "energy": float(cycles.find(self.cycle).energies[-1]),
            "loop": cycle_energy(self.cycle, cycles.PAIRS["tx"], cycles.find(self.cycle).numbered(-1)),
            "swt": float(self.swt[z, x]), "x": float(self.place[0]), "z": float(self.place[1]),
            "volume": float(wear["volume1"][-1]), "depth": float(wear["depth_max1"][-1]),
            "computed": int(wear["computed"][-1]), "cycles": float(wear["cycle"][-1]),
        }  # fmt: skip

    def tables(self):
        """What is printed."""
        n = self.numbers
        yield f"stick area over contact area at the peak: {n['stick']:.3f}"
        yield f"energy of the cycle: {1e6 * n['energy']:.1f} uJ, of which T_x spends {1e6 * n['loop']:.1f} uJ on d_x"
        yield f"maximum SWT: {1e-6 * n['swt']:.3f} MPa at x = {1e3 * n['x']:.3f} mm, z = {1e6 * n['z']:.0f} um"
        yield (
            f"wear of each body after {n['cycles']:g} cycles: depth {1e6 * n['depth']:.3f} um, volume "
            f"{1e9 * n['volume']:.5f} mm3, from {n['computed']} computed cycles"
        )

    def draw(self, directory):
        """Four panels."""
        figure, axes = plt.subplots(2, 2, figsize=(10.4, 8.0), constrained_layout=True)
        self._state(axes[0, 0])
        self._loop(axes[0, 1])
        self._scar(axes[1, 0])
        self._fatigue(axes[1, 1])
        save(figure, directory, "pad.png")

    def _map(self, panel, one, values, **look):
        edges = [1e3 * value for value in extent(one.x, one.y)]
        image = field(panel, values, edges, **look)
        panel.set(xlim=WINDOW[:2], ylim=WINDOW[2:])
        return image

    def _state(self, panel):
        colors = ListedColormap([color for _, color in STATES.values()])
        image = self._map(panel, self.step, self.step["state"], low=-0.5, high=2.5, color_map=colors)
        bar(panel, image, "", ticks=range(3)).set_ticks(range(3), labels=[text for text, _ in STATES.values()])
        frame(panel, "stick and slip at $T_x/(\\mu N) = 0.6$", "$x$, mm", "$y$, mm", WINDOW[:2], WINDOW[2:])

    def _loop(self, panel):
        load, way = self.cycle.history["load_tx"], 1e6 * self.cycle.history["disp_x"]
        panel.plot(way, load, color="0.7", linewidth=1.0)
        rows = cycles.find(self.cycle).numbered(-1).rows
        panel.plot(way[rows], load[rows], color=tint(0, 3), linewidth=1.5)
        panel.fill(way[rows], load[rows], color=tint(0, 3), alpha=0.12)
        part, whole = 1e6 * self.numbers["loop"], 1e6 * self.numbers["energy"]
        frame(panel, f"fretting loop: $T_x$'s part, {part:.0f} of {whole:.0f} µJ per cycle", "$d_x$, µm", "$T_x$, N")

    def _scar(self, panel):
        depth = 1e6 * (self.worn["wear_depth1"] + self.worn["wear_depth2"])
        image = self._map(panel, self.worn, depth, color_map=DAMAGE)
        bar(panel, image, "$w_1 + w_2$, µm")
        title = f"depth worn in {self.numbers['cycles']:,.0f} cycles"
        frame(panel, title, "$x$, mm", "$y$, mm", WINDOW[:2], WINDOW[2:])

    def _fatigue(self, panel):
        panel.grid(False)
        values, x, z = 1e-6 * self.swt, 1e3 * self.fatigue.x, 1e3 * self.fatigue.z
        image = panel.contourf(x, z, values, levels=30, cmap=DAMAGE)
        cross(panel, 1e3 * self.place[0], 1e3 * self.place[1])
        bar(panel, image, "SWT, MPa", ticks=np.arange(0.0, values.max(), 0.2).round(1))
        frame(
            panel,
            f"fatigue under the pad, $y = 0$: maximum {values.max():.2f} MPa",
            "$x$, mm",
            "depth $z$, mm",
            reach(values, x),
        )
        panel.set_ylim(z[-1], z[0])


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "pad"))
