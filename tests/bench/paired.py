#!/usr/bin/env python3
"""petsam and another program on one problem, by turns, on one core each.

    python3 tests/bench/paired.py [--case periodic_8] [--cells 1024,2048] [--rounds 6] [--setting "aspher periodic"]

A round is petsam, the other, the other, petsam: what slows the machine down for a while slows both. Both solve a case
of problem.py, one period of a rough plane unless another is given, to 1e-8. Prints a table, and writes it with all runs
to build/bench/paired/: for each program the medians of the seconds from building the operators to the solution, of its
CPU seconds and of the process's peak memory, with their ranges, and the error by problem.py's measure; and the ratio of
the CPU seconds of each round, its median with the interval that holds the true median with at least 95 % (of order
statistics; six rounds are the fewest). CPU seconds are those of the same stretch of the other program, without the
start of Python, but the whole process's of petsam.
"""

import argparse
import json
import math
import os
import re
import statistics
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BENCH = ROOT / "tests" / "bench"
sys.path[:0] = [str(BENCH), str(ROOT / "tests")]
import peer  # noqa: E402
from benchmark import APPROXIMATE, EXACT, PATIENCE, Bench, Failure, Ran, numbers  # noqa: E402
from run import environment  # noqa: E402

CONFIDENCE = 0.95
FEWEST = 6  # rounds whose extremes hold the median with 95 %: 1 - 2 / 2^6


def interval(values):
    """The order statistics between which the true median is with at least CONFIDENCE."""
    values, n = sorted(values), len(values)
    below = 0.0
    for k in range(n // 2):
        below += math.comb(n, k) / 2**n
        if 1 - 2 * (below + math.comb(n, k + 1) / 2**n) < CONFIDENCE:
            break
    return values[k], values[n - 1 - k]


class Pair:
    def __init__(self, build, case, setting, folder):
        self.build, self.case, self.setting, self.folder = build, case, setting, folder
        self.env = dict(environment(), OMP_NUM_THREADS="1")

    def problem(self, *words):
        command = [self.build / "venv/bin/python", BENCH / "problem.py", *words]
        return Ran(command, PATIENCE).must("problem.py")

    def error(self, solution):
        found = json.loads(self.problem("check", self.folder, solution))
        return max(found["complementarity"], found["penetration"], found["load"])

    def petsam(self, *words):
        options = json.loads((self.folder / "problem.json").read_text())["options"]
        ran = Ran([self.build / "bin/petsam", *options, *words], PATIENCE, self.env)
        seconds = float(re.search(r"used\s+([\d.]+) s", ran.must("petsam"))[1])
        return dict(seconds=seconds, cpu=ran.cpu, memory=ran.memory)

    def other(self):
        python = self.build / "peers/bin/python"
        command = [python, BENCH / "peer.py", self.setting, self.folder, self.folder / "peer.npy"]
        ran = Ran(command, PATIENCE, self.env)
        said = json.loads(ran.must("peer.py").splitlines()[-1])
        if not said["converged"]:
            raise Failure(f"{self.setting}: does not converge, its residual {said['residual']:.1e}")
        return dict(seconds=said["seconds"], cpu=said["cpu"], memory=ran.memory)

    def measure(self, cells, rounds):
        """The errors of both, and the runs of each round."""
        self.folder.mkdir(parents=True, exist_ok=True)
        self.problem("make", self.case, cells, self.folder)
        self.petsam("-output", self.folder / "results.h5", "-overwrite")
        self.other()
        errors = dict(petsam=self.error(self.folder / "results.h5"), other=self.error(self.folder / "peer.npy"))
        runs = []
        for _ in range(rounds):
            first, second, third, fourth = self.petsam(), self.other(), self.other(), self.petsam()
            runs.append(dict(petsam=[first, fourth], other=[second, third], load=os.getloadavg()[0]))
        return dict(cells=cells, errors=errors, runs=runs)


def spread(values):
    """A median with the range."""
    return f"{statistics.median(values):.3g} ({min(values):.3g} to {max(values):.3g})"


def lines(found, setting):
    """Rows of the table: both programs on one grid, and the ratio."""
    for name, title in ("petsam", "petsam"), ("other", setting):
        runs = [run for turn in found["runs"] for run in turn[name]]
        cells = [spread([run[key] for run in runs]) for key in ("seconds", "cpu", "memory")]
        yield [f"{found['cells']}²", title, *cells, f"{found['errors'][name]:.1e}"]
    ratios = [
        sum(run["cpu"] for run in turn["other"]) / sum(run["cpu"] for run in turn["petsam"]) for turn in found["runs"]
    ]
    low, high = interval(ratios)
    ratio = f"{statistics.median(ratios):.3g} ({low:.3g} to {high:.3g})"
    yield [f"{found['cells']}²", "ratio, with its interval", "", ratio, "", ""]


def report(results, setting):
    """The table with the machine."""
    machine = Bench.machine()
    loads = [turn["load"] for found in results for turn in found["runs"]]
    rows = [["cells", "program", "seconds", "CPU seconds", "memory, MB", "error"], ["---"] * 6]
    rows += [row for found in results for row in lines(found, setting)]
    return (
        f"{machine['processor']}, {machine['cores']} cores, {time.strftime('%Y-%m-%d')}, load {spread(loads)}; "
        f"{len(results[0]['runs'])} rounds; medians (range)\n\n" + "".join("| " + " | ".join(r) + " |\n" for r in rows)
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", default="periodic_8", help="of problem.py")
    parser.add_argument("--cells", type=numbers, default=[1024, 2048])
    parser.add_argument("--rounds", type=int, default=FEWEST, help=f"at least {FEWEST}")
    parser.add_argument("--setting", default="aspher periodic", help="of peer.py")
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument("--out", type=Path, default=ROOT / "build/bench/paired")
    args = parser.parse_args()
    if args.rounds < FEWEST:
        parser.error(f"--rounds {args.rounds}: use at least {FEWEST}; of fewer no interval has 95 %")
    if args.setting not in peer.SETTINGS:
        parser.error(f"--setting {args.setting}: use one of {', '.join(peer.SETTINGS)}")
    if not (args.build / "peers/bin/python").exists():
        sys.exit(f"paired.py: no {args.build}/peers: make peers")
    pair = Pair(args.build.resolve(), args.case, args.setting, args.out.resolve() / "problem")
    try:
        results = [pair.measure(cells, args.rounds) for cells in args.cells]
    except Failure as failure:
        sys.exit(f"paired.py: {failure}")
    text = report(results, args.setting)
    (args.out / "paired.json").write_text(json.dumps(dict(results=results), indent=1) + "\n")
    (args.out / "paired.md").write_text(text)
    print(text, end="")
    poor = [f for f in results if max(f["errors"].values()) > (APPROXIMATE if "single" in args.setting else EXACT)]
    if poor:
        sys.exit(f"paired.py: an error is larger than {EXACT:g} on {', '.join(str(f['cells']) for f in poor)} cells")


if __name__ == "__main__":
    main()
