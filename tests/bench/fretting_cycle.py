#!/usr/bin/env python3
"""CPU time of a fretting cycle in units of one cold partial-slip solve.

    python3 tests/bench/fretting_cycle.py [--cells 512] [--steps 80] [--petsam build/bin/petsam]

The sphere of examples/sphere at constant N; T_x goes to 0.8 mu N, to its opposite and back to zero in the given number
of steps, on one core. The cold solve is T_x = 0.6 mu N from nothing, the median of five. No results are written.
"""

import argparse
import resource
import statistics
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
LIMIT = 100.0  # mu N of the example, N


def cpu(command):
    """User and system seconds of a command."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def force(k, steps):
    """T_x after step k of the cycle, N."""
    phase = 4 * k / steps
    return 0.8 * LIMIT * (phase if phase <= 1 else 2 - phase if phase <= 3 else phase - 4)


def forces(steps):
    """T_x after every step of the cycle, N."""
    return [force(k, steps) for k in range(1, steps + 1)]


def write_history(path, steps):
    """The cycle as a load program for petsam."""
    path.write_text("time, load_tx\n" + "".join(f"{k + 1}, {t:.10g}\n" for k, t in enumerate(forces(steps))))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=512)
    parser.add_argument("--steps", type=int, default=80)
    parser.add_argument("--petsam", default=str(ROOT / "build/bin/petsam"))
    parser.add_argument("options", nargs="*", help="further options of petsam, after --")
    args = parser.parse_args()
    base = [
        args.petsam,
        "-options_file",
        str(ROOT / "examples/sphere/sphere.opts"),
        "-grid_n",
        str(args.cells),
    ] + args.options
    cold = statistics.median(cpu(base + ["-load_tx", str(0.6 * LIMIT)]) for _ in range(5))
    with tempfile.TemporaryDirectory() as folder:
        history = Path(folder) / "cycle.csv"
        write_history(history, args.steps)
        cycle = cpu(base + ["-history", str(history)])
    print(f"cold solve {cold:.2f} s, {args.steps} steps {cycle:.2f} s, ratio {cycle / cold:.1f}")


if __name__ == "__main__":
    main()
