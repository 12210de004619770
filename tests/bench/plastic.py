#!/usr/bin/env python3
"""petsam and Tamaas on a sphere that presses a periodic plane beyond yield, on one core each.

    python3 tests/bench/plastic.py [--cells 32] [--layers 16] [--rounds 3] [--build build]

A rigid sphere of radius 1 and a body of E = 1, nu = 0.3, yield stress 1e-3 and hardening modulus E/20, N = 3 times the
load of first yield N_Y at once; the period is 8 a_Y and the layers reach 4 a_Y deep, a_Y being the contact radius at
first yield. Tamaas has nodes between the layers. A round is petsam, Tamaas. Prints, and writes to build/bench/plastic/,
for both the medians of the CPU seconds (of Tamaas without the start of Python) and of the process's peak memory, the
maximum pressure over the yield stress, and the relative difference of the two pressures in the 2-norm.
"""

import argparse
import json
import math
import statistics
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BENCH = ROOT / "tests" / "bench"
sys.path[:0] = [str(BENCH), str(ROOT / "tests")]

POISSON, YIELD, HARDENING, LOAD = 0.3, 1e-3, 0.05, 3
FIRST = 1.6127965  # p0/Y of first yield of a sphere, nu = 0.3
P0 = FIRST * YIELD
RADIUS = math.pi * P0 * (1 - POISSON**2) / 2  # a_Y
N_Y = 2 / 3 * math.pi * RADIUS**2 * P0
WIDTH, DEPTH, TOLERANCE = 8 * RADIUS, 4 * RADIUS, 1e-6


def solve_with_tamaas(cells, layers, solution):
    """Runs in Tamaas' Python; prints its seconds as JSON and saves the pressure."""
    import numpy as np
    import tamaas as tm
    from tamaas.nonlinear_solvers import DFSANECXXSolver

    tm.set_log_level(tm.LogLevel.error)
    x = (np.arange(cells) + 0.5) * WIDTH / cells - WIDTH / 2
    surface = -(x[:, None] ** 2 + x[None, :] ** 2) / 2
    start, cpu = time.perf_counter(), time.process_time()
    model = tm.Model(tm.model_type.volume_2d, [DEPTH, WIDTH, WIDTH], [layers + 1, cells, cells])
    model.E, model.nu = 1, POISSON
    # the hardening modulus of Tamaas is that of the uniaxial stress-plastic strain curve
    residual = tm.Residual(model, tm.materials.IsotropicHardening(model, YIELD, HARDENING))
    strain = DFSANECXXSolver(residual)
    strain.tolerance = 1e-3 * TOLERANCE
    contact = tm.PolonskyKeerRey(model, surface, 1e-3 * TOLERANCE)
    both = tm.EPICSolver(contact, strain, TOLERANCE, 0.3)
    both.solve(LOAD * N_Y / WIDTH**2)
    seconds, cpu = time.perf_counter() - start, time.process_time() - cpu
    np.save(solution, np.asarray(model.traction)[..., 2])
    print(json.dumps(dict(seconds=seconds, cpu=cpu)))


class Both:
    def __init__(self, args):
        import benchmark
        from run import environment

        self.benchmark, self.args = benchmark, args
        self.env = dict(environment(), OMP_NUM_THREADS="1")
        args.out.mkdir(parents=True, exist_ok=True)

    def petsam(self):
        options = (
            f"-body1_young inf -body1_poisson 0.3 -body2_young 1 -body2_poisson {POISSON} -gap_type sphere "
            f"-gap_radius1 1 -gap_radius2 inf -body2_yield {YIELD} "
            f"-body2_hardening linear:{HARDENING} -yield_depth {DEPTH} -yield_layers {self.args.layers} "
            f"-elasticity periodic -grid_n {self.args.cells} -grid_size {WIDTH} -load_n {LOAD * N_Y} -overwrite"
        )
        first = ["-yield_first", str(DEPTH / self.args.layers)]
        command = [self.args.build / "bin/petsam", *options.split(), *first, "-output", self.args.out / "petsam.h5"]
        ran = self.benchmark.Ran(command, self.benchmark.PATIENCE, self.env)
        ran.must("petsam")
        return dict(cpu=ran.cpu, memory=ran.memory)

    def tamaas(self):
        command = [self.args.build / "peers/bin/python", __file__, "--cells", str(self.args.cells)]
        command += ["--layers", str(self.args.layers), "--tamaas", self.args.out / "tamaas.npy"]
        ran = self.benchmark.Ran(command, self.benchmark.PATIENCE, self.env)
        return dict(cpu=json.loads(ran.must("Tamaas").splitlines()[-1])["cpu"], memory=ran.memory)

    def compare(self):
        """The maximum pressures over the yield stress, and the difference of the pressures; in petsam's Python."""
        code = (
            "import sys, h5py, numpy as np; a = h5py.File(sys.argv[1])['pressure'][-1]; b = np.load(sys.argv[2]); "
            "print(a.max(), b.max(), np.linalg.norm(a - b) / np.linalg.norm(a))"
        )
        command = [self.args.build / "venv/bin/python", "-c", code]
        command += [self.args.out / "petsam.h5", self.args.out / "tamaas.npy"]
        ran = self.benchmark.Ran(command, self.benchmark.PATIENCE)
        one, other, difference = map(float, ran.must("python").split())
        return one / YIELD, other / YIELD, difference


def report(args, runs, pressures):
    rows = [["program", "CPU seconds", "memory, MB", "p max/Y"], ["---"] * 4]
    for name, pressure in zip(("petsam", "tamaas"), pressures):
        median = {key: statistics.median(run[name][key] for run in runs) for key in ("cpu", "memory")}
        rows.append([name, f"{median['cpu']:.3g}", f"{median['memory']:.0f}", f"{pressure:.5f}"])
    ratio = statistics.median(run["tamaas"]["cpu"] / run["petsam"]["cpu"] for run in runs)
    return (
        f"{args.cells} x {args.cells} cells, {args.layers} layers, {len(runs)} rounds; the pressures differ by "
        f"{pressures[2]:.2g}, the ratio of the CPU seconds is {ratio:.3g}\n\n"
        + "".join("| " + " | ".join(row) + " |\n" for row in rows)
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=32)
    parser.add_argument("--layers", type=int, default=16)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument("--out", type=Path, default=ROOT / "build/bench/plastic")
    parser.add_argument("--tamaas", type=Path, help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.tamaas:
        return solve_with_tamaas(args.cells, args.layers, args.tamaas)
    args.build, args.out = args.build.resolve(), args.out.resolve()
    if not (args.build / "peers/bin/python").exists():
        sys.exit(f"plastic.py: no {args.build}/peers: make peers")
    both = Both(args)
    try:
        runs = [dict(petsam=both.petsam(), tamaas=both.tamaas()) for _ in range(args.rounds)]
        pressures = both.compare()
    except both.benchmark.Failure as failure:
        sys.exit(f"plastic.py: {failure}")
    text = report(args, runs, pressures)
    (args.out / "plastic.md").write_text(text)
    print(text, end="")


if __name__ == "__main__":
    main()
