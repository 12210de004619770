"""A rigid sphere on a block near its edge and on a clamped beam: loads by degree, and beside full contact in CalculiX.

Reads the files that examples/body/run.sh writes to a directory, draws body.png and prints the numbers; those of full
contact where run.sh has made them (FULL=1).
"""

import glob
import os
import re
import sys
from pathlib import Path

import numpy as np

import petsam
from petsam.plot.style import COLORS, frame, plt, points, save

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402

DEGREES = ("none", "1", "2", "4", "6", "coarse")
TITLES = {"none": "half-space", "coarse": "6, coarse mesh"}


class Full:
    """Full contact: loads, and pressure and shear (MPa) of the nodes (mm)."""

    def __init__(self, path):
        with np.load(path) as file:
            self.__dict__.update({name: file[name] for name in file.files})
        found = re.search(r"full_([\d.]+),([\d.]+)(?:,([\d.]+))?\.npz$", path)
        self.size, self.far = float(found[1]), float(found[2])
        self.last = float(found[3] or found[2])

    def error(self, grid, name, mine):
        """L2 of petsam's field against the nodes' means, relative to these."""
        weight = self.area * np.where(self.y < 1e-9, 0.5, 1.0)
        return comparison.nodal_l2(grid, name, (self.x, self.y), (self.size, self.size), mine, weight)


class Comparison:
    """All results of a directory."""

    def __init__(self, directory):
        self.grids = {body: self._grids(directory, body) for body in ("block", "beam")}
        paths = {body: glob.glob(os.path.join(directory, body + "_full_*.npz")) for body in self.grids}
        self.full = {
            body: sorted(map(Full, found), key=lambda one: (-one.size, -one.last)) for body, found in paths.items()
        }
        self.numbers = {body: [*self._rows(body), *self._full_rows(body)] for body in self.grids}

    @staticmethod
    def _grids(directory, body):
        names = [name for name in DEGREES if body == "block" or name != "none"]
        return {name: petsam.Snapshot(petsam.open(os.path.join(directory, f"{body}_{name}.h5"))) for name in names}

    def _rows(self, body):
        """Loads of petsam by degree, and the errors against the finest full contact."""
        rows = []
        for name, grid in self.grids[body].items():
            history = grid.results.history
            row = {
                "degree": TITLES.get(name, name),
                "n": float(history["load_n"][-1]),
                "t": float(history["load_tx"][-1]),
            }
            row["peak"] = float(np.max(grid["pressure"])) / 1e6
            if self.full[body]:
                best = self.full[body][-1]
                row["p_error"] = best.error(grid, "pressure", best.pressure)
                if body == "beam":
                    row["q_error"] = best.error(grid, "shear_x", best.shear_x)
            rows.append(row)
        return rows

    def _full_rows(self, body):
        return [
            {
                "degree": f"CalculiX {one.size:g}, {one.far:g}, {one.last:g}",
                "n": float(one.load_n), "t": float(one.load_tx),
                "peak": float(one.pressure.max()), "elements": int(one.elements), "cpu": float(one.cpu),
            }
            for one in self.full[body]
        ]  # fmt: skip

    def tables(self):
        """Loads of both bodies."""
        for body, title in (("block", "Block near an edge"), ("beam", "Clamped beam, after the pull")):
            rows = [row for row in self.numbers[body] if "elements" not in row]
            columns = "degree = degree:s; N, N = n:.1f; peak, MPa = peak:.1f"
            if body == "beam":
                columns = "degree = degree:s; N, N = n:.1f; T, N = t:.1f; peak, MPa = peak:.1f"
            errors = "; p, L2 = p_error:.1e" + ("; q_x, L2 = q_error:.1e" if body == "beam" else "")
            yield title, columns + (errors if self.full[body] else ""), rows
            if self.full[body]:
                columns = "mesh, mm = degree:s; elements = elements:d; N, N = n:.1f; T, N = t:.1f; CPU, s = cpu:.0f"
                yield title + ", full contact", columns, self._full_rows(body)

    def draw(self, directory):
        """Pressures, and shear of the beam, along y = 0."""
        figure, panels = plt.subplots(1, 3, figsize=(13.0, 3.8), layout="constrained")
        self._profile(panels[0], "block", "pressure", "Block near an edge: pressure", "$p$, MPa")
        self._profile(panels[1], "beam", "pressure", "Clamped beam, pulled: pressure", "$p$, MPa")
        self._profile(panels[2], "beam", "shear_x", "Clamped beam, pulled: shear", "$q_x$, MPa")
        for panel in panels[:2]:
            panel.legend(loc="lower center", fontsize="small")
        save(figure, directory, "body.png")

    def _profile(self, panel, body, name, title, label):
        for which, color, line, text in (
            ("none", COLORS[5], ":", "half-space"),
            ("1", COLORS[3], "--", "compliance of degree 1"),
            ("6", COLORS[0], "-", "compliance of degree 6"),
        ):
            grid = self.grids[body].get(which)
            if grid is not None:
                middle = grid.y.size // 2
                values = 0.5 * (grid[name][middle] + grid[name][middle - 1]) / 1e6
                panel.plot(grid.x * 1e3, values, line, color=color, linewidth=1.3, label=text)
        if self.full[body]:
            best = self.full[body][-1]
            row = best.y < 1e-9
            points(
                panel, best.x[row], getattr(best, name)[row], COLORS[1], label=f"CalculiX, elements of {best.size:g} mm"
            )
            half = 1e3 * self.grids[body]["6"].x[-1]
            panel.set_xlim(-half, half)
        panel.xaxis.set_major_locator(plt.MultipleLocator(0.5))
        frame(panel, title, "$x$, mm", label)


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "body"))
