#!/usr/bin/env python3
"""Steady rolling beside CONTACT: a steel sphere under longitudinal creepage, on one core.

    python3 tests/bench/rolling.py [--build build] [--cells 64,128,256,512,1024] [--repeats 5]

Prints, and writes to build/bench/rolling/rolling.csv: operator applications of the tangential problem, seconds
(median, without start-up), memory (MB), T_x over mu N, its extrapolation to fine grids, and CONTACT's T_x on the same
grids. Fails where T_x differs from CONTACT's. contact.py measures CONTACT's times.
"""

import argparse
import csv
import math
import re
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests")]
from run import environment  # noqa: E402

G, NU, MU, P0, A = 82e9, 0.28, 0.3, 800e6, 1e-3  # Pa; 1; 1; peak pressure, Pa, and half width of the contact, m
LOAD = 2 / 3 * math.pi * P0 * A**2
CONTACT = {64: 0.5054, 128: 0.5024, 256: 0.5010}  # its T_x/(mu N) by cells
DIGIT = 6e-5  # of CONTACT's T_x
PATTERNS = {
    "T_x": r"load_tx +([-+.\de]+) N",
    "extrapolated": r"fine grid: load_tx ([-+.\de]+)\)",
    "applications": r"tangential \d+ \((\d+) applications",
    "seconds": r"^ +used +([\d.]+) s",
    "memory": r"memory ([\d.]+) MB",
}


def options(cells):
    words = dict(
        rolling="steady", grid_n=cells, grid_size=2.3 * A, friction=MU, load_n=LOAD, gap_type="sphere",
        gap_radius1=2 * A * G / (1 - NU) / (math.pi * P0), gap_radius2="inf", creep_x=0.3 * MU * P0 / G, creep_y=0,
        creep_spin=0, body1_young=2 * G * (1 + NU), body2_young=2 * G * (1 + NU), body1_poisson=NU, body2_poisson=NU,
    )  # fmt: skip
    return [word for name, value in words.items() for word in (f"-{name}", str(value))]


def run(program, cells):
    """What a run prints of itself."""
    done = subprocess.run([program, *options(cells), "-profile"], capture_output=True, text=True, env=environment())
    if done.returncode:
        sys.exit(f"rolling.py: {cells} cells: exit code {done.returncode}: {done.stderr[-500:]}")
    found = {name: re.search(pattern, done.stdout, re.M) for name, pattern in PATTERNS.items()}
    if lost := [name for name, match in found.items() if not match]:
        sys.exit(f"rolling.py: {cells} cells: petsam has not printed {', '.join(lost)}")
    return {name: float(match[1]) for name, match in found.items()}


def row(program, cells, repeats):
    runs = [run(program, cells) for _ in range(repeats)]
    out = dict(runs[0], cells=cells, seconds=statistics.median(one["seconds"] for one in runs))
    out["memory"] = max(one["memory"] for one in runs)
    for name in ("T_x", "extrapolated"):
        out[name] /= MU * LOAD
    return {**out, "CONTACT T_x": CONTACT.get(cells)}


def line(one):
    words = [one["cells"], f"{one['applications']:.0f}", f"{one['seconds']:.2g}", f"{one['memory']:.0f}"]
    words += [f"{one['T_x']:.4f}", f"{one['extrapolated']:.4f}"]
    words.append(f"{one['CONTACT T_x']:.4f}" if one["CONTACT T_x"] else "")
    return "| " + " | ".join(map(str, words)) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument(
        "--cells", type=lambda text: [int(word) for word in text.split(",")], default=[64, 128, 256, 512, 1024]
    )
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--out", type=Path, help="folder of rolling.csv (bench/rolling of the build)")
    args = parser.parse_args()
    out = args.out or args.build / "bench" / "rolling"
    out.mkdir(parents=True, exist_ok=True)
    print("| cells | applications | seconds | MB | T_x | extrapolated | CONTACT T_x |")
    print("|" + " --- |" * 7)
    rows = []
    for cells in args.cells:
        rows.append(row(args.build / "bin" / "petsam", cells, args.repeats))
        print(line(rows[-1]), flush=True)
    with open(out / "rolling.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    wrong = [one["cells"] for one in rows if one["CONTACT T_x"] and abs(one["T_x"] - one["CONTACT T_x"]) > DIGIT]
    if wrong:
        sys.exit(f"rolling.py: T_x differs from CONTACT's on {wrong} cells")


if __name__ == "__main__":
    main()
