"""Random scans as petsam-surface meets them: arrays, tables, headers, units, orders, holes, lists of points, positions.

Each is a known surface in a file that states some of what it is, with options that give the rest, or contradict it.
What ends with 0 must be that surface, at its place, or have a warning; what is rejected must name the file and a cure,
in one line. The surfaces of another --seed are all others.
"""

import collections
import os
import re
import subprocess
import sys

import h5py
import numpy as np

from kinds import Outcome
from support import ROOT

OPTIONS = dict(trials=100)
UNITS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "nm": 1e-9}
CURE = re.compile(
    r"--|give|use|remove|write|correct|leave|keep|interpolate|reads|write|export|multiply|are read|unpack"
)


class Scan:
    """A surface in m, rows from the smallest y, and a file of it with the options that are right for it."""

    def __init__(self, random, folder):
        self.random = random
        self.n = tuple(int(k) for k in random.integers(7, 40, 2))
        self.cell = float(f"{10 ** random.uniform(-7, -4):.2g}")
        x, y = np.meshgrid(np.arange(self.n[0]), np.arange(self.n[1]))
        rough = np.cos(0.4 * x + random.uniform(0, 6)) * np.sin(0.3 * y + random.uniform(0, 6))
        self.height = 0.03 * self.cell * (rough + 0.3 * random.normal(size=x.shape) + 0.05 * random.normal() * x)
        self.unit = str(random.choice(list(UNITS)))
        self.options, self.wrong, self.kind = ["--units", self.unit], False, ""
        self.size = ["--size", "{!r},{!r}".format(*(self.cell * n for n in self.n))]
        self.folder = folder

    def chance(self, part):
        """True in so many of all cases."""
        return self.random.random() < part

    def values(self):
        """The heights in the file's unit."""
        return self.height / UNITS[self.unit]

    def write_table(self, values, header=(), name="z.txt"):
        """A text with a random separator, decimal sign and encoding."""
        separator = str(self.random.choice(["\t", ",", ";", " "]))
        comma = separator != "," and self.chance(0.2)
        texts = ["nan" if v != v else f"{v:.9g}" for v in values.ravel()]
        texts = [text.replace(".", ",") for text in texts] if comma else texts
        rows = np.array(texts, object).reshape(values.shape)
        lines = [*header, *(separator.join(row) for row in rows)]
        encoding = str(self.random.choice(["utf-8", "utf-8-sig", "latin-1", "utf-16"]))
        (self.folder / name).write_bytes("\n".join(lines).encode(encoding, errors="replace"))
        self.options += ["--decimal", "comma"] if comma else []
        return name

    def mangle(self, text):
        """A unit as programs spell it."""
        return str(self.random.choice(["\u00b5m", "um", "micron"])) if text == "um" else text


def plain(scan):
    """An array or table without a word about itself."""
    values = scan.values()
    if scan.chance(0.3):
        scan.options += ["--first-row", "top"]
        values = values[::-1]
    scan.options += scan.size
    if scan.chance(0.5):
        np.save(scan.folder / "z.npy", values)
        return "z.npy"
    return scan.write_table(values)


def header(scan):
    """A table whose header states unit and size; sometimes an option contradicts it, or lines of it are skipped."""
    width, height = (scan.cell * n for n in scan.n)
    side = str(scan.random.choice(["mm", "um", "nm"]))
    spelt = scan.mangle(side)
    a, b = (f"{v / UNITS[side]:.10g}" for v in (width, height))
    forms = [
        [f"Width: {a} {spelt}", f"Height: {b} {spelt}", f"Value units: {scan.mangle(scan.unit)}"],
        [f"x-length = {a} {spelt}", f"y-length = {b} {spelt}", f"z-unit = {scan.unit}"],
        [f"pixel size = {scan.cell / UNITS[side]:.10g} {spelt}", f"units: {scan.unit}"],
        [f"scan size: {a} x {b} {spelt}", f"data unit: {scan.unit}"],
        [f"Unit X = {side}", f"Scale X = {scan.cell / UNITS[side]:.10g}", f"Scale Y = {scan.cell / UNITS[side]:.10g}",
         f"Unit Data = {scan.unit}"],
    ]  # fmt: skip
    which = int(scan.random.integers(len(forms)))
    lines = forms[which]
    values = scan.values()[::-1] if which == 0 else scan.values()
    marked = scan.chance(0.6)
    lines = ["# " + line for line in lines] if marked else lines
    scan.options = [] if marked else ["--skip-rows", str(len(lines))]
    if scan.chance(0.6):
        scan.wrong = True
        other = next(unit for unit in UNITS if unit != scan.unit)
        scan.options += [["--units", other], ["--size", "1.2345mm"], ["--pixel", f"{scan.cell * 80!r}"]][
            int(scan.random.integers(3))
        ]
    return scan.write_table(values, lines)


def points(scan):
    """A list of points, with or without more columns, in some order, or a profile: no map unless --format reads it."""
    x, y = np.meshgrid(np.arange(scan.n[0]), np.arange(scan.n[1]))
    rows = np.c_[x.ravel(), y.ravel(), scan.values().ravel()]
    scan.wrong = True
    scan.options += scan.size
    kind = int(scan.random.integers(7))
    if kind == 0:
        rows = scan.random.permutation(rows)
    elif kind == 1:
        rows = np.delete(rows, scan.random.integers(len(rows)), 0)
    elif kind == 2:
        rows = np.column_stack([rows, *scan.random.normal(size=(int(scan.random.integers(1, 4)), len(rows)))])
    elif kind == 3:
        rows = scan.random.normal(size=(len(rows), int(scan.random.integers(3, 7))))
    elif kind == 4:
        rows = np.c_[-rows[:, 0], rows[:, 2]][: scan.n[0]]
    elif kind == 5:
        rows = rows[: int(scan.random.integers(4, 9))]
    if scan.chance(0.25) and len(rows) >= 9:
        np.save(scan.folder / "z.npy", rows if scan.chance(0.7) or kind in (2, 3) else rows.T)
        return "z.npy"
    if scan.chance(0.4):
        scan.options += ["--format", "surfacetopography"]
        scan.options[scan.options.index("--size") + 1] = "{}um,{}um".format(*scan.n)
        scan.cell = 1e-6
        scan.wrong = kind not in (0, 6)
    return scan.write_table(rows)


def positions(scan):
    """Heights with a row or a column of positions or numbers, before or behind them."""
    values = scan.values()
    step, start = scan.random.choice([1.0, -1.0, 0.5, scan.cell / UNITS["um"]]), scan.random.choice([0.0, 1.0, 3.5])
    which = int(scan.random.integers(3))
    if which != 1:
        values = np.vstack([start + step * np.arange(scan.n[0]), values])
    if which:
        column = start + step * np.arange(scan.n[1])
        values = np.column_stack([np.r_[np.nan, column] if which == 2 else column, values])
    scan.wrong = True
    scan.options += [*scan.size, *(["--fill", "smooth"] if scan.chance(0.5) else [])]
    return scan.write_table(values, name="z.csv")


def holes(scan):
    """A map with missing points, which are filled, named, or left to the command."""
    values = scan.values()
    places = scan.random.integers(0, values.size, 3)
    mark = float(scan.random.choice([np.nan, -9999.0, 32767.0]))
    values.flat[places] = mark
    scan.options += scan.size
    if mark == mark and scan.chance(0.6):
        scan.options += ["--missing", repr(mark)]
        mark = np.nan
    scan.options += ["--fill", "nearest"] if mark != mark and scan.chance(0.5) else []
    scan.wrong = "--fill" not in scan.options
    scan.skip = np.unique(places)
    return scan.write_table(values)


def hdf5(scan):
    """HDF5 with units, quantity and axes or size, which options may contradict."""
    side = str(scan.random.choice(list(UNITS)))
    with h5py.File(scan.folder / "z.hdf5", "w") as file:
        fall = scan.chance(0.3)
        data = file.create_dataset("height", data=scan.values()[::-1] if fall else scan.values())
        data.attrs.update(units=scan.unit, quantity="height2")
        if scan.chance(0.5) and not fall:
            data.attrs["size"] = [scan.cell * n for n in scan.n]
        else:
            for letter, n in zip("xy", scan.n):
                axis = (np.arange(n) - (n - 1) / 2) * scan.cell / UNITS[side]
                file[letter] = axis[::-1] if fall and letter == "y" else axis
                file[letter].attrs["units"] = side
    scan.options = []
    if scan.chance(0.5):
        scan.wrong = True
        other = next(unit for unit in UNITS if unit != scan.unit)
        scan.options = [["--units", other], ["--size", "1.2345mm"], ["--depths"]][int(scan.random.integers(3))]
    return "z.hdf5"


KINDS = (plain, header, points, positions, holes, hdf5)


def is_right(scan, path):
    """Whether the written map is the surface."""
    with h5py.File(path) as file:
        height, x, y = (file[name][()] for name in ("height", "x", "y"))
    if height.shape != scan.height.shape:
        return False
    apart = np.abs(height - scan.height).ravel()
    apart[getattr(scan, "skip", [])] = 0.0
    cells = [np.ptp(axis) / (axis.size - 1) for axis in (x, y)]
    return apart.max() < 1e-6 * np.ptp(scan.height) and np.allclose(cells, scan.cell, rtol=1e-6, atol=0.0)


def fault(scan, done, name):
    """What is wrong with the end of the command, or ""."""
    lines = done.stderr.splitlines()
    if "Traceback" in done.stderr or done.returncode not in (0, 2, 3):
        return "crashed"
    if done.returncode:
        if len(lines) != 1 or name not in lines[0] or not CURE.search(lines[0]):
            return "rejected without a file or a cure"
        return "" if scan.wrong else "rejected, but right"
    if is_right(scan, scan.folder / "out.h5"):
        return ""
    return "" if any("warning" in line for line in lines) else "wrong without a word"


def trial(seed, folder, given):
    """How the command ends; the problem is that of the first seed and the number of the trial."""
    number = seed - given.seed
    scan = Scan(np.random.default_rng([given.seed, number]), folder)
    make = KINDS[number % len(KINDS)]
    name = make(scan)
    words = [name, *scan.options, *([] if make is hdf5 else ["--body", "2"]), "--no-picture", "-o", "out.h5"]
    done = subprocess.run(
        [sys.executable, str(ROOT / "scripts/petsam-surface"), *words],
        cwd=folder, capture_output=True, text=True, timeout=100, env={**os.environ, "OMP_NUM_THREADS": "1"},
    )  # fmt: skip
    found = fault(scan, done, name)
    end = "rejected" if done.returncode else "warned" if "warning" in done.stderr else "right"
    text = f"{make.__name__}: {found or end}: {' '.join(words)}\n    {done.stderr.strip()}".rstrip()
    return Outcome(text, bool(found), dict(end=end))


def summary(found):
    ends = collections.Counter(one["end"] for one in found.values())
    return [", ".join(f"{ends[end]} {end}" for end in ("right", "rejected", "warned"))]
