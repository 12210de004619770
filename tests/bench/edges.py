#!/usr/bin/env python3
"""Error of the pressure over time: the sphere, ellipsoid and punch of examples/edges by petsam, without and with
reconstructed edges, and by the other programs of the benchmark.

    build/venv/bin/python tests/bench/edges.py [--build build] [--cells 64,128,256,512] [--repeats 3]

Writes edges.csv and edges.png to build/bench/edges, and prints when each reaches an error of 1e-4 on the sphere: by the
order over its grids. Times are medians, of the solution without start-up and files; errors are those at the cells'
centres, in the 2-norm.
"""

import argparse
import csv
import json
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "examples" / "edges"), str(ROOT / "scripts"), str(ROOT / "tests")]
import edges  # noqa: E402
from run import environment  # noqa: E402

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

PEERS = ("tamaas", "aspher fft")
PLACE = edges.PLACES[0]
WANTED = 1e-4


def peer(python, setting, shape, n, folder):
    """Error of a peer's pressure, and its seconds; None where it does not converge."""
    x, y = edges.places(shape, n, PLACE)
    problem = dict(cells=n, width=shape.width, e_star=1.0, load_n=shape.load, kind="normal")
    (folder / "problem.json").write_text(json.dumps(problem))
    np.save(folder / "gap.npy", shape.gap(x, y))
    words = [python, ROOT / "tests" / "bench" / "peer.py", setting, folder, folder / "solution.npy"]
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, env=environment())
    if done.returncode:
        sys.exit(f"{setting}: {done.stderr[-500:]}")
    said = json.loads(done.stdout.splitlines()[-1])
    if not said["converged"]:
        return None
    exact = shape.pressure(x, y)
    return np.linalg.norm(np.load(folder / "solution.npy")[0] - exact) / np.linalg.norm(exact), said["seconds"]


def petsam(program, way, shape, n, folder):
    """The same of petsam: the time of its normal problem, set-up and edges, as its table says."""
    errors, printed = edges.measure(program, folder, shape, n, PLACE, way)
    used, results = (float(re.search(rf"^ +{word} +([\d.]+) s", printed, re.M)[1]) for word in ("used", "results"))
    return errors[0], used - results


def table(args, python):
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, make in edges.SHAPES.items():
            for n in args.cells:
                for way in (*edges.WAYS, *(PEERS if python.exists() else ())):
                    run = (petsam, args.build / "bin" / "petsam") if way in edges.WAYS else (peer, python)
                    each = [run[0](run[1], way, make(), n, Path(folder)) for _ in range(args.repeats)]
                    if None in each:
                        continue
                    row = dict(
                        shape=name,
                        cells=n,
                        program=way,
                        error=each[0][0],
                        seconds=statistics.median(e[1] for e in each),
                    )
                    rows.append(row)
                    print("{shape:9} {cells:5} {program:12} {error:.1e} {seconds:8.3f} s".format(**row), flush=True)
    return rows


def reached(rows):
    """Seconds to the wanted error, by a line through all grids in logarithms."""
    slope, start = np.polyfit(np.log([row["error"] for row in rows]), np.log([row["seconds"] for row in rows]), 1)
    return np.exp(start + slope * np.log(WANTED))


def label(program):
    return f"petsam, {edges.LABELS[program]}" if program in edges.WAYS else program


def draw(rows, filename):
    programs = list(dict.fromkeys(row["program"] for row in rows))
    figure, panels = plt.subplots(1, len(edges.SHAPES), figsize=(11, 4), sharey=True, constrained_layout=True)
    for axes, name in zip(panels, edges.SHAPES):
        for program, marker in zip(programs, "osD^v"):
            line = [row for row in rows if row["shape"] == name and row["program"] == program]
            axes.loglog(
                [row["seconds"] for row in line], [row["error"] for row in line], f"{marker}-", label=label(program)
            )
        axes.set(title=name, xlabel="time, s")
        axes.grid(alpha=0.3)
    panels[0].set_ylabel("relative error of the pressure at the centres")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=5)
    figure.savefig(filename, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument(
        "--cells", type=lambda text: [int(word) for word in text.split(",")], default=[64, 128, 256, 512]
    )
    parser.add_argument("--repeats", type=int, default=3)
    args = parser.parse_args()
    out = args.build / "bench" / "edges"
    out.mkdir(parents=True, exist_ok=True)
    rows = table(args, args.build.resolve() / "peers" / "bin" / "python")
    with open(out / "edges.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    draw(rows, out / "edges.png")
    for program in dict.fromkeys(row["program"] for row in rows):
        line = [row for row in rows if row["shape"] == "sphere" and row["program"] == program]
        if len(line) > 1:
            print(f"sphere to {WANTED:g}: {label(program):22} {reached(line):8.2g} s")


if __name__ == "__main__":
    main()
