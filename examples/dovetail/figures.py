"""A flank of a dovetail under cycles: loads, pressure and shear beside full contact in CalculiX, loop, wear, fatigue.

Reads the files that examples/dovetail/run.sh writes to a directory, draws dovetail.png and prints the numbers; those of
full contact where run.sh has made them (FULL=1).
"""

import glob
import os
import re
import sys
from pathlib import Path

import numpy as np

import petsam
from petsam.plot.style import COLORS, DAMAGE, bar, cross, frame, plt, points, reach, save

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402

STEPS = (1, 2, 4, 6, 8, 12, 16, 20)  # of the table
FIELDS = (4, 8)  # whose pressure and shear are compared
CYCLES = (slice(3, 12), slice(11, 20))  # rows of the closed cycles


class Full:
    """Full contact: loads of the steps, and pressure and shear (MPa) of the nodes (mm)."""

    def __init__(self, path):
        with np.load(path) as file:
            self.__dict__.update({name: file[name] for name in file.files})
        self.size = float(re.search(r"full_([\d.]+)\.npz$", path)[1])
        self.mine = petsam.open(re.sub(r"full_([\d.]+)\.npz$", r"facets_\1.h5", path))  # with the same facets
        self.spacing = [float(np.median(np.diff(np.unique(np.round(v, 9))))) for v in (self.x, self.y)]

    def error(self, name, step):
        """L2 of petsam's field against the nodes' means, relative to these."""
        grid, mine = petsam.Snapshot(self.mine, step - 1), getattr(self, name)[step - 1]
        return comparison.nodal_l2(grid, name, (self.x, self.y), self.spacing, mine, self.area)


def pull(load_n, load_tx):
    """Radial force on the flank."""
    return (np.asarray(load_n) + np.asarray(load_tx)) * np.sqrt(0.5)


def loop(rise, force):
    """Work of a closed cycle."""
    return float(np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(rise)))


class Comparison:
    """All results of a directory."""

    def __init__(self, directory):
        self.cycles, self.worn, self.fatigue = (
            petsam.open(os.path.join(directory, name + ".h5")) for name in ("cycles", "worn", "fatigue")
        )
        self.coarse = petsam.open(os.path.join(directory, "coarse.h5"))
        found = glob.glob(os.path.join(directory, "full_*.npz"))
        self.full = sorted(map(Full, found), key=lambda one: -one.size)
        history = self.cycles.history
        self.rise = np.sqrt(2.0) * history["disp_z"]
        self.swt = self.fatigue.field("swt")[:, 0]
        z, x = np.unravel_index(np.argmax(self.swt), self.swt.shape)
        self.place = float(self.fatigue.x[x]), float(self.fatigue.z[z])
        force = pull(history["load_n"], history["load_tx"])
        energy, wear = history["dissipated_energy"], self.worn.wear
        self.numbers = {
            "steps": [self._row(step) for step in STEPS], "fields": [self._fields(step) for step in FIELDS],
            "loop": loop(self.rise[CYCLES[-1]], force[CYCLES[-1]]), "energy": float(np.sum(energy[12:20])),
            "swt": float(self.swt[z, x]), "x": self.place[0], "z": self.place[1],
            "depth": float(wear["depth_max1"][-1]), "volume": float(wear["volume1"][-1]),
            "computed": int(wear["computed"][-1]), "cycles": float(wear["cycle"][-1]),
        }  # fmt: skip

    def _row(self, step):
        """Loads of a step, and the differences from full contact, by its mesh."""
        mine, coarse = self.cycles.history, self.coarse.history
        row = {
            "step": step,
            "rise": 1e6 * float(self.rise[step - 1]),
            "n": float(mine["load_n"][step - 1]),
            "t": float(mine["load_tx"][step - 1]),
        }
        row["coarse"] = float(coarse["load_n"][step - 1]) / row["n"] - 1.0
        for i, one in enumerate(self.full):
            row[f"n{i}"] = row[f"t{i}"] = np.nan
            if step <= len(one.load_n):
                for key, name in (("n", "load_n"), ("t", "load_tx")):
                    row[f"{key}{i}"] = float(one.mine.history[name][step - 1] / getattr(one, name)[step - 1]) - 1.0
        return row

    def _fields(self, step):
        """L2 of pressure and shear of a step."""
        grid, row = petsam.Snapshot(self.cycles, step - 1), {"step": step}
        row["peak"] = float(np.max(grid["pressure"])) / 1e6
        for i, one in enumerate(self.full):
            row[f"p{i}"] = row[f"q{i}"] = np.nan
            if step <= len(one.load_n):
                row[f"p{i}"], row[f"q{i}"] = (one.error(name, step) for name in ("pressure", "shear_x"))
        return row

    def tables(self):
        """Loads, errors, loop, wear and fatigue."""
        columns = "step = step:d; rise, um = rise:.0f; N, N = n:.2f; T, N = t:.2f; coarse: N = coarse:.1%"
        columns += "".join(f"; {one.size:g}: N = n{i}:.2%; T = t{i}:.2%" for i, one in enumerate(self.full))
        yield "Loads of the flank, and relative to full contact", columns, self.numbers["steps"]
        columns = "step = step:d; peak, MPa = peak:.1f"
        columns += "".join(f"; {one.size:g}: p, L2 = p{i}:.1e; q_x, L2 = q{i}:.1e" for i, one in enumerate(self.full))
        yield "Pressure and shear", columns, self.numbers["fields"]
        n = self.numbers
        yield f"energy of the cycle: {1e6 * n['energy']:.2f} uJ dissipated, {1e6 * n['loop']:.2f} uJ in the loop"
        for one in self.full:
            for rows in (rows for rows in CYCLES if rows.stop <= len(one.load_n)):
                pairs = (one.load_n, one.load_tx), (one.mine.history["load_n"], one.mine.history["load_tx"])
                work, mine = (1e6 * loop(self.rise[rows], pull(*pair)[rows]) for pair in pairs)
                yield f"  CalculiX {one.size:g} mm: {work:.2f} uJ in the loop, petsam with its facets {mine:.2f} uJ"
            yield f"  CalculiX {one.size:g} mm: {one.elements} elements, {len(one.load_n)} steps, CPU {one.cpu:.0f} s"
        yield (
            f"maximum SWT of the blade: {1e-6 * n['swt']:.3f} MPa at x = {1e3 * n['x']:.3f} mm, "
            f"z = {1e6 * n['z']:.0f} um"
        )
        yield (
            f"wear of each body after {n['cycles']:g} cycles: depth {1e6 * n['depth']:.3f} um, volume "
            f"{1e9 * n['volume']:.5f} mm3, from {n['computed']} computed cycles"
        )

    def draw(self, directory):
        """Loop, pressure and shear along the flank, fatigue."""
        figure, panels = plt.subplots(1, 3, figsize=(13.0, 3.8), layout="constrained")
        history, panel = self.cycles.history, panels[0]
        panel.plot(1e6 * self.rise, pull(history["load_n"], history["load_tx"]), color=COLORS[0], label="petsam")
        if self.full:
            best = self.full[-1]
            count = len(best.load_n)
            force = pull(best.load_n, best.load_tx)
            points(panel, 1e6 * self.rise[:count], force, COLORS[1], label=f"CalculiX, elements of {best.size:g} mm")
        panel.legend()
        frame(panel, "Loading and cycles of the flank", "rise of the grip, µm", "radial force, N")
        self._profiles(panels[1])
        panel = panels[2]
        panel.grid(False)
        x, z = 1e3 * self.fatigue.x, 1e3 * self.fatigue.z
        image = panel.contourf(x, z, 1e-6 * self.swt, levels=30, cmap=DAMAGE)
        cross(panel, 1e3 * self.place[0], 1e3 * self.place[1])
        bar(panel, image, "SWT, MPa", ticks=np.arange(0.0, 1e-6 * self.swt.max(), 0.1).round(1))
        text = f"Fatigue of the blade: maximum {1e-6 * self.swt.max():.2f} MPa"
        frame(panel, text, "$x$, mm  at $y$ = 0", "depth $z$, mm", reach(self.swt, x))
        panel.set_ylim(z[-1], z[0])
        save(figure, directory, "dovetail.png")

    def _profiles(self, panel):
        for step, color, when in ((4, COLORS[0], "rise 20 µm"), (8, COLORS[1], "back to 12 µm")):
            grid = petsam.Snapshot(self.cycles, step - 1)
            middle = grid.y.size // 2
            for name, style in (("pressure", "-"), ("shear_x", "--")):
                values = 0.5 * (grid[name][middle] + grid[name][middle - 1]) / 1e6
                text = f"${'p' if name == 'pressure' else 'q_x'}$, {when}"
                panel.plot(grid.x * 1e3, values, style, color=color, linewidth=1.3, label=text)
                if self.full and step <= len(self.full[-1].load_n):
                    best = self.full[-1]
                    row = best.y < 1e-9
                    points(panel, best.x[row], getattr(best, name)[step - 1][row], color)
        if self.full:
            panel.plot([], [], "o", color=COLORS[5], markerfacecolor="white", markersize=3.6, label="CalculiX")
        frame(panel, "Pressure and shear along the flank", "$x$, mm  at $y$ = 0", "$p$, $q_x$, MPa", (-0.75, 0.75))
        panel.set_ylim(top=1.4 * panel.get_ylim()[1])  # room for the legend
        panel.legend(loc="upper center", ncols=2)


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "dovetail"))
