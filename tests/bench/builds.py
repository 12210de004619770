#!/usr/bin/env python3
"""Two builds of petsam on the same cases, by turns, on one core each: what a change costs or saves.

    build/venv/bin/python tests/bench/builds.py BEFORE AFTER [--cases cold,virgin] [--rounds 6]

BEFORE and AFTER are checkouts of petsam with their programs built (make). A round is before, after, after, before.
For each case the table has the CPU seconds of whole processes, their medians; the ratio of after to before, its median
with the interval that holds the true median with at least 95 %; and the largest difference of the last step's fields
and of the history, relative to the largest value of each. Exit code 1 where one build fails.
"""

import argparse
import math
import os
import statistics
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
BENCH = ROOT / "tests" / "bench"
sys.path[:0] = [str(BENCH), str(ROOT / "tests"), str(ROOT / "tests" / "program")]
import fretting_cycle  # noqa: E402
from benchmark import PATIENCE, Failure, Ran  # noqa: E402
from paired import FEWEST, interval  # noqa: E402
from problem import make  # noqa: E402
from run import environment  # noqa: E402
from support import words  # noqa: E402

STEEL = dict(body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3, friction=0.3)
SPHERE = dict(STEEL, gap_type="sphere", gap_radius1=0.02, gap_radius2="inf")
SLIDE = 67.5  # mu N of most cases, N
NOT_COMPARED = ("applies", "precondition", "iterations", "residual", "seconds")  # numbers of the way to a solution

STEPS_IN_PROCESS = """
import petsam
with petsam.Contact(**{options}) as contact:
    for k in range(1, 161):
        contact.try_step(load_n=225, load_tx={slide} * (k % 80) / 80)
        contact.stiffness()
        contact.commit()
"""


def written(path, columns, rows):
    """A history in that file."""
    path.write_text(",".join(columns) + "\n" + "".join(",".join(f"{v:.17g}" for v in row) + "\n" for row in rows))
    return path


def turning(folder, cycles, steps, normal):
    """Cycles of two forces a quarter of a cycle apart beside a normal load that varies by that share."""
    phase = 2 * math.pi * np.arange(1, cycles * steps + 1) / steps
    rows = [(2 + k, 225 * (1 + normal * math.sin(p)), 0.4 * SLIDE * math.cos(p), 0.4 * SLIDE * math.sin(p))
            for k, p in enumerate(phase)]  # fmt: skip
    return written(folder / "turning.csv", ["time", "load_n", "load_tx", "load_ty"], [(1, 225, 0, 0), *rows])


def reversing(folder, steps, cycles=1, amplitude=0.8 * SLIDE):
    """T_x to and fro, from zero and back."""
    rows = [(k + 1, amplitude * math.sin(2 * math.pi * (k % steps) / steps)) for k in range(cycles * steps + 1)]
    return written(folder / "reversing.csv", ["time", "load_tx"], rows)


def problem(name, cells):
    def options(folder):
        make(name, cells, folder)
        return dict(options_file=folder / "petsam.opts")

    return options


def virgin(folder):
    fretting_cycle.write_history(folder / "cycle.csv", 40)
    return dict(options_file=ROOT / "examples/sphere/sphere.opts", grid_n=320, history=folder / "cycle.csv")


def rough(folder):
    make("rough_8", 256, folder)
    load = float((folder / "petsam.opts").read_text().split("-load_n ")[1].split()[0])
    rows = [(k, load * (1 + 0.2 * math.sin(k)), 0.5 * 0.3 * load * math.sin(2 * math.pi * k / 24)) for k in range(25)]
    history = written(folder / "rough.csv", ["time", "load_n", "load_tx"], rows)
    return dict(options_file=folder / "petsam.opts", load_n=None, friction=0.3, history=history)


def sphere(**more):
    return lambda folder: dict(SPHERE, grid_n=160, grid_size=1.3e-3, load_n=225, **more)


def plane(folder):
    return dict(STEEL, elasticity="plane", gap_type="ellipsoid", gap_radius_x=0.01, gap_radius_y="inf", grid_n=512,
                grid_size=2e-3, load_n=2e5, history=reversing(folder, 100, 10, 0.8 * 0.3 * 2e5))  # fmt: skip


def plastic(folder):
    return dict(STEEL, body2_yield=600e6, body2_hardening="linear:2e9", gap_type="sphere", gap_radius1=5e-3,
                gap_radius2="inf", grid_n=32, grid_size=0.5e-3, load_n=100, load_tx=12, steps=3)  # fmt: skip


def life(folder):
    return dict(SPHERE, grid_n=64, grid_size=1.6e-3, load_n=225, wear_coefficient1=1e-14, wear_cycles=20000,
                history=reversing(folder, 16))  # fmt: skip


def sliding(folder):
    rows = [(k, 2e-4 * math.sin(2 * math.pi * (k % 24) / 24)) for k in range(25)]
    grid = dict(SPHERE, grid_n=64, grid_size=1.9e-3, load_n=225, wear_coefficient1=1e-14, wear_cycles=2000)
    return dict(grid, slide=True, history=written(folder / "slide.csv", ["time", "disp_x"], rows))


CASES = {
    "hertz": problem("hertz", 1024),
    "cold": problem("slip_tx", 512),
    "cold-1024": problem("slip_tx", 1024),
    "virgin": virgin,
    "repeated": lambda folder: dict(sphere()(folder), load_n=None, history=turning(folder, 5, 32, 0.25)),
    "life": life,
    "sliding": sliding,
    "rough": rough,
    "rough-cold": problem("rough_8", 1024),
    "periodic": problem("periodic_8", 1024),
    "rolling": sphere(rolling="steady", creep_x=2e-3),
    "layered": sphere(body1_layer_young=400e9, body1_layer_poisson=0.25, body1_layer_thickness=50e-6, load_tx=40),
    "dissimilar": lambda folder: dict(sphere()(folder), body1_young="inf", steps=10, load_tx=40),
    "plane": plane,
    "plastic": plastic,
}


class Builds:
    def __init__(self, before, after, folder):
        self.roots = dict(before=before.resolve(), after=after.resolve())
        self.folder = folder
        self.env = dict(environment(), OMP_NUM_THREADS="1")

    def run(self, side, options, output):
        named = {k: v for k, v in options.items() if v is not None}
        command = [self.roots[side] / "build/bin/petsam", *words(named), "-output", output, "-overwrite", "-quiet"]
        ran = Ran(command, PATIENCE, self.env)
        ran.must(f"{side}: petsam")
        return ran

    def in_process(self, side):
        """Steps with their stiffness in Python."""
        root = self.roots[side]
        options = dict(SPHERE, grid_n=48, grid_size=1.3e-3)
        script = STEPS_IN_PROCESS.format(options=options, slide=0.8 * SLIDE)
        env = dict(self.env, PYTHONPATH=str(root / "scripts"), PETSAM_LIBRARY=str(root / "build/lib/libpetsam.so"))
        ran = Ran([ROOT / "build/venv/bin/python", "-c", script], PATIENCE, env)
        ran.must(f"{side}: in process")
        return ran

    def rounds(self, name, count):
        """The runs of each round, and how far the results differ."""
        folder = self.folder / name
        folder.mkdir(parents=True, exist_ok=True)
        outputs = {side: folder / f"{side}.h5" for side in self.roots}
        if name == "in-process":
            runs = {side: (lambda side=side: self.in_process(side)) for side in self.roots}
        else:
            options = CASES[name](folder)
            runs = {side: (lambda side=side: self.run(side, options, outputs[side])) for side in self.roots}
        for side in self.roots:  # not counted: the first run finds the disk's caches cold
            runs[side]()
        turns = [[(side, runs[side]()) for side in ("before", "after", "after", "before")] for _ in range(count)]
        return turns, None if name == "in-process" else difference(*outputs.values())


def difference(before, after):
    """The largest difference of any dataset of numbers, and its name, relative to its largest value."""
    worst = (0.0, "")
    with h5py.File(before) as first, h5py.File(after) as second:

        def compare(path, item):
            nonlocal worst
            if not isinstance(item, h5py.Dataset) or item.dtype.kind != "f" or path not in second:
                return
            if any(word in path for word in NOT_COMPARED) or item.shape != second[path].shape:
                return
            a, b = np.nan_to_num(item[()]), np.nan_to_num(second[path][()])
            largest = np.max(np.abs(a), initial=0.0)
            if largest > 0:
                worst = max(worst, (float(np.max(np.abs(a - b)) / largest), path))

        first.visititems(compare)
    return worst


def ratio(turns):
    """The median of the rounds' ratios of after to before, and its interval."""
    sums = [{s: sum(ran.cpu for side, ran in turn if side == s) for s in ("before", "after")} for turn in turns]
    ratios = [s["after"] / s["before"] for s in sums]
    return statistics.median(ratios), *interval(ratios)


def row(name, turns, differs):
    medians = [statistics.median(ran.cpu for turn in turns for side, ran in turn if side == s)
               for s in ("before", "after")]  # fmt: skip
    middle, low, high = ratio(turns)
    differs = "" if differs is None else "none" if differs[0] == 0 else f"{differs[0]:.1e} {differs[1]}"
    cells = [name, *(f"{m:.3g}" for m in medians), f"{middle:.3f} ({low:.3f} to {high:.3f})", differs]
    return "| " + " | ".join(cells) + " |"


def main():
    names = [*CASES, "in-process"]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    parser.add_argument("--cases", default=",".join(names))
    parser.add_argument("--rounds", type=int, default=FEWEST, help=f"at least {FEWEST}")
    args = parser.parse_args()
    cases = args.cases.split(",")
    if args.rounds < FEWEST:
        parser.error(f"--rounds {args.rounds}: use at least {FEWEST}; of fewer no interval has 95 %")
    if set(cases) - set(names):
        parser.error(f"--cases {args.cases}: use some of {','.join(names)}")
    for root in args.before, args.after:
        if not (root / "build/bin/petsam").exists():
            parser.error(f"{root}: no build/bin/petsam there: run make in it")
    print("| case | before, s | after, s | ratio | differs |\n| --- | --- | --- | --- | --- |", flush=True)
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        builds = Builds(args.before, args.after, Path(folder))
        for name in cases:
            try:
                print(row(name, *builds.rounds(name, args.rounds)), flush=True)
            except Failure as failure:
                failed = True
                print(f"builds.py: {name}: {failure}", file=sys.stderr)
    print(f"\n{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
