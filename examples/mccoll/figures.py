"""Compare the worn scars of the benchmark with Abaqus and the measurement, and draw them.

Reads moved.h5, fixed.h5, ring.h5, rough.h5 and the roughness of both bodies, which examples/mccoll/run.sh writes to a
directory, and the published profiles beside this file, prints tables, draws mccoll.png and scars.png, and fails when a
check does not hold:
  area     the worn area of the flat is k N times the accumulated slip, which follows from the energy of the cycles
  depth    of the flat at 18,000 cycles within 3e-3 of 2.7313 um, another program's of the same method
"""

import os
import re
import sys
from pathlib import Path

import h5py
import numpy as np

import petsam
from petsam.plot.measured import read_profiles
from petsam.plot.style import COLORS, frame, plt, save, tint

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
CYCLES = (1000, 10000, 18000)
DEPTH, DEPTH_TOLERANCE, AREA_TOLERANCE = 2.7313, 3e-3, 3e-3
SHOWN = 0.01  # part of the depth at which a scar begins
LOAD, COEFFICIENT = 18500.0, 2.9e-14  # N/m; 1/Pa, of the flat
ABAQUS = 16993  # s, as published with the profiles
METRES = (800, 1600, 3600)
RUNNING_IN = (0, 10, 100, 1000)  # cycles of the rough surfaces
RADIUS, BLOCK_LOAD, BLOCK_COEFFICIENT = 20e-3, 10833.3, 2e-15


def read_table(name):
    """A published table, x in mm, heights in um."""
    path = os.path.join(HERE, name)
    with open(path, encoding="utf-8") as file:
        return np.loadtxt([line for line in file if line[0] not in "#csx"], delimiter=",")


def scar(x, depth):
    """Depth (um), width (mm) and area (1e-3 mm2) of a scar; x in mm, depth in um."""
    level = SHOWN * depth.max()
    inside = np.flatnonzero(depth > level)
    first, last = inside[0], inside[-1]
    left = np.interp(level, depth[first - 1 : first + 1], x[first - 1 : first + 1])
    right = np.interp(-level, -depth[last : last + 2], x[last : last + 2])
    return {"depth": depth.max(), "width": right - left, "area": float(np.trapezoid(depth, x))}


def seconds(directory, case):
    """CPU seconds of a run, from what it printed."""
    with open(os.path.join(directory, case + ".log"), encoding="utf-8") as file:
        return float(re.search(r"CPU ([\d.]+) s", file.read()).group(1))


def processor():
    """What the machine calls its processor."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            return re.search(r"model name\s*: (.*)", file.read()).group(1)
    except (OSError, AttributeError):
        return "unknown"


def chord(metres):
    """Depth (um) of a block worn by a rigid ring: a chord of its circle."""
    half = (1.5 * RADIUS * BLOCK_COEFFICIENT * BLOCK_LOAD * metres) ** (1 / 3)
    return 1e6 * half**2 / (2 * RADIUS)


class Comparison:
    """The cylinder's runs, the block's, and what is published."""

    def __init__(self, directory):
        self.runs = {
            name: petsam.open(os.path.join(directory, name + ".h5")) for name in ("moved", "fixed", "ring", "rough")
        }
        self.heights = {}
        for body in "12":
            with h5py.File(os.path.join(directory, f"rough{body}.h5")) as file:
                self.heights[body] = 1e6 * file["height"][0]
        self.x = 1e3 * self.runs["moved"].x
        self.abaqus = read_table("abaqus.csv")
        x, heights = read_profiles(os.path.join(HERE, "measured.csv"))
        self.measured = 1e3 * x, -1e6 * heights["y"]
        rows = []
        for cycle in CYCLES:
            theirs = self.abaqus[self.abaqus[:, 0] == cycle]
            rows.append({"case": "Abaqus", "cycles": cycle, **scar(theirs[:, 1], -theirs[:, 2]), "rms": 0.0})
            for name, case in (("moved", "petsam"), ("fixed", "not moved")):
                depth = self.depth(name, cycle)
                rms = np.sqrt(np.mean((np.interp(theirs[:, 1], self.x, depth) + theirs[:, 2]) ** 2))
                rows.append({"case": case, "cycles": cycle, **scar(self.x, depth), "rms": float(rms)})
        x, depth = self.measured
        rows.append({"case": "measured", "cycles": CYCLES[-1], **scar(x, depth), "width": np.nan, "rms": np.nan})
        moved = self.runs["moved"]
        energy, cycle = moved.wear["dissipated_energy"], moved.wear["cycle"]
        path = np.sum(0.5 * (energy[1:] + energy[:-1]) * np.diff(cycle)) / (moved.parameters["friction"] * LOAD)
        blocks = [self.block(metres, cycle) for metres, cycle in zip(METRES, (200000, 400000, 900000))]
        self.numbers = {
            "scars": rows,
            "ring": blocks,
            "rough": [self.running_in(cycle) for cycle in RUNNING_IN],
            "area": float(1e9 * moved.wear["volume2"][-1] / (1e9 * COEFFICIENT * LOAD * path) - 1.0),
            "computed": int(moved.wear["computed"][-1]),
            "seconds": seconds(directory, "moved"),
            "ring_seconds": seconds(directory, "ring"),
        }

    def depth(self, name, cycle, body="2"):
        """Depth, um, of a run's body at a saved cycle."""
        run = self.runs[name]
        return 1e6 * run.field("wear_depth" + body, run.of_cycle(cycle)).ravel()

    def block(self, metres, cycle):
        """The block's depths, um, after a distance."""
        theirs = read_table("ring_abaqus.csv")
        ours = self.depth("ring", cycle, "1").max()
        abaqus = -np.min(theirs[theirs[:, 0] == metres][:, 2])
        return {"metres": metres, "petsam": float(ours), "chord": float(chord(metres)), "abaqus": float(abaqus)}

    def surface(self, body, cycle):
        """A rough body's surface, um into it: its roughness and what it has lost."""
        return self.heights[body] + self.depth("rough", cycle, body)

    def running_in(self, cycle):
        """Contact, pressure, and the roughness of both bodies within 25 um of the middle; their form is taken off."""
        run = self.runs["rough"]
        row = {"cycles": cycle}
        at = int(np.flatnonzero(run.wear["cycle"] == cycle)[0])
        row["width"], row["pressure"] = 1e3 * run.wear["contact_area"][at], 1e-6 * run.wear["pressure_max"][at]
        inside = np.abs(self.x) < 0.025
        for body in "12":
            part = self.surface(body, cycle)[inside]
            form = np.polynomial.Polynomial.fit(self.x[inside], part, 2)
            row["rms" + body] = float(np.std(part - form(self.x[inside])))
        return row

    def tables(self):
        """What is printed; fails when a check does not hold."""
        n = self.numbers
        columns = "cycles = cycles; by = case; depth, um = depth:.4f; width, mm = width:.4f"
        columns += "; area, 1e-3 mm2 = area:.5f; rms, um = rms:.3f"
        yield "scar of the flat; rms: to Abaqus", columns, n["scars"]
        yield (
            f"\nCPU: petsam {n['seconds']:.2f} s ({processor()}), {n['computed']} computed cycles; "
            f"Abaqus {ABAQUS} s (published)"
        )
        columns = "metres = metres; petsam, um = petsam:.3f; rigid chord = chord:.3f; Abaqus = abaqus:.3f"
        yield "depth of the block on the ring", columns, n["ring"]
        columns = "cycles = cycles; contact, mm = width:.4f; p, MPa = pressure:.0f"
        columns += "; body 1, um = rms1:.4f; body 2, um = rms2:.4f"
        yield "running-in of two rough surfaces; their roughness", columns, n["rough"]
        last = next(row for row in reversed(n["scars"]) if row["case"] == "petsam")
        error = last["depth"] / DEPTH - 1.0
        yield (
            f"\ncheck: area/(k N path) - 1 = {n['area']:+.1e} ({AREA_TOLERANCE:g}), depth {error:+.1e} "
            f"({DEPTH_TOLERANCE:g})"
        )
        if not (abs(n["area"]) < AREA_TOLERANCE and abs(error) < DEPTH_TOLERANCE):
            raise petsam.Error(f"{self.runs['moved'].path}: the scar is wrong")

    def draw(self, directory):
        """The flat's scar by all, and the scars of both bodies and of the block."""
        figure, panel = plt.subplots(figsize=(7.2, 4.2), constrained_layout=True)
        theirs = self.abaqus[self.abaqus[:, 0] == CYCLES[-1]]
        panel.plot(*self.measured, ".", color="0.6", label="measured (McColl et al. 2004)")
        panel.plot(theirs[:, 1], -theirs[:, 2], "s", color=COLORS[1], markersize=4, markerfacecolor="white",
                   label=f"Abaqus, {ABAQUS / 3600:.1f} h")  # fmt: skip
        panel.plot(self.x, self.depth("fixed", CYCLES[-1]), "--", color=COLORS[0], linewidth=1.0,
                   label="petsam, surfaces not moved")  # fmt: skip
        panel.plot(self.x, self.depth("moved", CYCLES[-1]), color=COLORS[0],
                   label=f"petsam, {self.numbers['seconds']:.1f} s")  # fmt: skip
        title = "Scar of the flat after 18,000 cycles of $\\pm$25 µm"
        frame(panel, title, "$x$, mm", "worn depth, µm", (-0.38, 0.38), (3.3, -0.9))
        panel.legend(loc="lower left")
        save(figure, directory, "mccoll.png")
        self.draw_bodies(directory)

    def draw_bodies(self, directory):
        """Both bodies' scars over the cycles, each in its own frame; the block's."""
        figure, axes = plt.subplots(2, 2, figsize=(9.6, 6.6), constrained_layout=True)
        panels = axes.flat
        for panel, body, what in zip(panels, "21", ("flat (body 2)", "cylinder (body 1)")):
            for k, cycle in enumerate(CYCLES):
                panel.plot(self.x, self.depth("moved", cycle, body), color=tint(k, 3), label=f"{cycle:,}")
            frame(
                panel, f"Scar of the {what}", "$x$ of the body's own surface, mm", "worn depth, µm", None, (3.3, -0.1)
            )
            panel.legend(title="after cycles", loc="lower left")
        panel, x = panels[2], 1e3 * self.runs["ring"].x
        measured, heights = read_profiles(os.path.join(HERE, "ring_measured.csv"))
        for k, values in enumerate(heights.values()):
            panel.plot(1e3 * measured, -1e6 * values, ".", color="0.7", label=None if k else "measured, three tests")
        theirs = read_table("ring_abaqus.csv")
        theirs = theirs[theirs[:, 0] == METRES[-1]]
        panel.plot(theirs[:, 1], -theirs[:, 2], "s", color=COLORS[1], markersize=4, markerfacecolor="white",
                   label="Abaqus")  # fmt: skip
        panel.plot(x, self.depth("ring", 900000, "1"), color=COLORS[0], label="petsam")
        frame(panel, "Block on ring after 3600 m", "$x$, mm", "worn depth, µm", (-1.75, 1.75), (66, -6))
        panel.legend(loc="lower left")
        panel, inside = panels[3], np.abs(self.x) < 0.1
        for k, cycle in enumerate(RUNNING_IN):
            for body, shift in (("1", 0.0), ("2", 1.0)):
                line = -self.surface(body, cycle)[inside] - shift
                panel.plot(self.x[inside], line, color=tint(k, 4), linewidth=1.0,
                           label=f"{cycle}" if body == "1" else None)  # fmt: skip
        for text, height in ("body 1", 0.33), ("body 2, drawn 1 µm lower", -0.7):
            panel.text(-0.1, height, text, fontsize=9)
        frame(panel, "Running-in of two rough surfaces", "$x$ of the body's own surface, mm",
              "height outwards, µm", None, (-1.45, 0.45))  # fmt: skip
        panel.set_xticks([-0.1, -0.05, 0.0, 0.05, 0.1])
        panel.legend(title="after cycles", loc="center", ncol=4, columnspacing=1.0, bbox_to_anchor=(0.5, 0.5))
        save(figure, directory, "scars.png")


if __name__ == "__main__":
    sys.exit(comparison.main(Comparison, __doc__, "mccoll"))
