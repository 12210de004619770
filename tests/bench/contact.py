#!/usr/bin/env python3
"""petsam beside CONTACT, Vollebregt and Kalker's program, on the same cells; one thread each.

    build/venv/bin/python tests/bench/contact.py --contact folder [--cells 64,128,256] [--repeats 5] [--only hertz,spin]

The folder is a checkout of CONTACT's repository with its program already built. The Manchester cases are read there.
Prints a table and writes it to build/bench/contact/contact.csv: medians of the CPU seconds of whole programs that write
no fields, run in turns, without petsam's start (petsam -version); relative L2 differences of pressure and shear; the
force over mu N, by petsam and the difference; errors of both where there is a closed form. Of the Manchester cases,
the largest differences. A run of CONTACT of more than --long seconds is not repeated.
"""

import argparse
import csv
import math
import os
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests")]
from run import environment  # noqa: E402

PROGRAM = "bin/contact_linux64"
MM = 1e-3  # CONTACT's lengths are in mm, its stresses in MPa, its forces in N
G, NU, MU, P0, A = 82e9, 0.28, 0.3, 800e6, 1e-3  # Pa; 1; 1; peak pressure, Pa, and radius of the contact, m
LOAD = 2 / 3 * math.pi * P0 * A**2
WIDTH = 2.3 * A
CREEP = 0.3 * MU * P0 / G
ONE_THREAD = {"OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
TOLERANCE = 1e-6  # CONTACT's EPS
# of GDsteady, its solver with FFT: the settings of the performance tests in its repository
GDSTEADY = "1.0 0.05 1 2.0 -1.0 1.0 2.6 1.0"


def cpu(command, folder):
    """User and system seconds of a command; it must succeed."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    env = {**environment(), **ONE_THREAD}
    done = subprocess.run(list(map(str, command)), cwd=folder, env=env, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    # CONTACT's exit code is 0 after errors too
    if done.returncode or (Path(command[0]).name == Path(PROGRAM).name and "ended succesfully" not in done.stdout):
        sys.exit(f"contact.py: {command[0]}: exit code {done.returncode}: {(done.stderr or done.stdout)[-500:]}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


# ---------------------------------------------------------------- CONTACT


class Problem(NamedTuple):
    """A case of CONTACT: its digit T, the load, and what it says of motion, with its signs."""

    tang: int
    motion: list  # N; T_x over mu N, or creepage along x; creepage along y; spin
    grid: tuple  # (columns, rows), (widths)
    gap: object  # 1/(2 R) along x and y as a tuple, or the gap of each cell
    force: int = 0  # 1: motion has T_x
    mu: float = MU
    material: tuple = (NU, NU, G, G)
    gdsteady: bool = False


def part(problem, files, first=True):
    """A case in CONTACT's input; one that is not the first starts from the one before, for the same bodies."""
    (nx, ny), (lx, ly) = problem.grid
    dx, dy = lx / nx / MM, ly / ny / MM
    nu1, nu2, g1, g2 = problem.material
    # passes of the normal and the tangential problem, which dissimilar materials couple
    passes = 1 if nu1 == nu2 and g1 == g2 else 20
    lines = ["3 MODULE", f"20{problem.tang}1{problem.force}0", "022020" if first else "000000"]
    lines += [f"0{5 if problem.gdsteady else 0}{0 if first else 3}{2 if files else 0}101"]
    lines += [f"9999 100 30 {passes} {TOLERANCE}"] + ([GDSTEADY] if problem.gdsteady else [])
    lines += [" ".join(map(repr, problem.motion)), f"{problem.mu} {problem.mu}"]
    if first:
        lines += [f"0d {dx!r} 1000.0"] if problem.tang == 3 else []
        lines += [f"{nu1!r} {nu2!r} {g1 / 1e6!r} {g2 / 1e6!r}"]
        lines += ["1", f"{nx} {ny} {-nx * dx / 2!r} {-ny * dy / 2!r} {dx!r} {dy!r}"]
        if isinstance(problem.gap, tuple):
            lines += ["1 1", f"{problem.gap[0] * MM!r} 0.0 {problem.gap[1] * MM!r} 0.0 0.0 0.0"]
        else:
            lines += ["9 1", *(repr(float(height)) for height in np.ravel(problem.gap) / MM)]
    return "\n".join(lines) + "\n"


def write_deck(path, parts):
    path.write_text("\n".join(parts) + "\n0 MODULE\n")


def fields(path):
    """Of a file of results of CONTACT: (nx, ny), (dx, dy) m, gap m, pressure, shear_x, shear_y in Pa."""
    lines = path.read_text().splitlines()
    grid = lines[next(k for k, line in enumerate(lines) if re.match(r"%\s+MX", line)) + 1].split()
    start = max(k for k, line in enumerate(lines) if line.startswith("%")) + 1
    nx, ny = int(grid[0]), int(grid[1])
    data = np.array([[float(word) for word in line.split()[:7]] for line in lines[start:]]).reshape(ny, nx, 7)
    gap, pressure, shear_x, shear_y = (data[..., k] for k in (2, 4, 5, 6))
    return (nx, ny), (float(grid[4]) * MM, float(grid[5]) * MM), gap * MM, 1e6 * pressure, 1e6 * shear_x, 1e6 * shear_y


# ---------------------------------------------------------------- petsam


def words(**options):
    return [word for name, value in options.items() for word in (f"-{name}", str(value))]


def petsam_fields(path, step=-1):
    with h5py.File(path) as file:
        zero = np.zeros_like(file["pressure"][step])
        return [file[name][step] if name in file else zero for name in ("pressure", "shear_x", "shear_y")]


# ---------------------------------------------------------------- cases


def ball(cells, nu, **more):
    """petsam's options of the ball, and the curvature of its gap for CONTACT."""
    radius = 2 * A * G / (1 - nu) / (math.pi * P0)
    young = 2 * G * (1 + nu)
    options = words(
        grid_n=cells, grid_size=WIDTH, friction=MU, load_n=LOAD, gap_type="sphere", gap_radius1=radius,
        gap_radius2="inf", body1_young=young, body2_young=young, body1_poisson=nu, body2_poisson=nu, **more,
    )  # fmt: skip
    return options, (0.5 / radius, 0.5 / radius)


def square(cells):
    return (cells, cells), (WIDTH, WIDTH)


def centres(cells):
    x = (np.arange(cells) + 0.5 - cells / 2) * WIDTH / cells
    return np.hypot(*np.meshgrid(x, x))


def cap(r, a):
    return np.sqrt(np.maximum(1 - (r / a) ** 2, 0))


def hertz(cells):
    options, gap = ball(cells, NU)
    options = [word if options[k - 1] != "-friction" else "0" for k, word in enumerate(options)]
    exact = P0 * cap(centres(cells), A)
    return options, Problem(0, [LOAD, 0.0, 0.0, 0.0], square(cells), gap), lambda p, q: norm(p - exact) / norm(exact)


def shift(cells):
    options, gap = ball(cells, 0.0, load_tx=0.6 * MU * LOAD)
    c = A * 0.4 ** (1 / 3)
    exact = MU * P0 * (cap(centres(cells), A) - c / A * cap(centres(cells), c))
    problem = Problem(1, [LOAD, -0.6, 0.0, 0.0], square(cells), gap, force=1, material=(0.0, 0.0, G, G))
    # Cattaneo and Mindlin's shear, exact for nu = 0; its sign is opposite in CONTACT's shift
    return options, problem, lambda p, q: norm(abs(q[0]) - exact) / norm(exact)


def rolling(cells):
    options, gap = ball(cells, NU, rolling="steady", creep_x=CREEP, creep_y=0, creep_spin=0)
    return options, Problem(3, [LOAD, -CREEP, 0.0, 0.0], square(cells), gap), None


def spin(cells):
    options, gap = ball(cells, NU, rolling="steady", creep_x=0, creep_y=0, creep_spin=CREEP / A)
    return options, Problem(3, [LOAD, 0.0, 0.0, -CREEP / A * MM], square(cells), gap), None


CASES = {"hertz": hertz, "shift": shift, "rolling": rolling, "spin": spin}
LABELS = {
    "hertz": "Hertz, frictionless", "shift": "T_x = 0.6 mu N", "rolling": "rolling, creepage", "spin": "rolling, spin",
}  # fmt: skip


def norm(field):
    return float(np.linalg.norm(np.asarray(field)))


def compare(mine, theirs, opposite=1.0):
    """Relative L2 differences of pressure and shear."""
    (p, *q), (p2, *q2) = mine, theirs
    shear = norm(np.array(q) - opposite * np.array(q2)) / norm(q2) if norm(q2) else None
    return norm(p - p2) / norm(p2), shear


class Bench:
    def __init__(self, args, work):
        self.args, self.work = args, Path(work)
        self.petsam = (args.build / "bin" / "petsam").resolve()
        self.contact = (args.contact / PROGRAM).resolve()
        self.start = statistics.median(cpu([self.petsam, "-version"], work) for _ in range(5))
        self.rows = []

    def say(self, *words):
        if self.args.verbose:
            print(*words, file=sys.stderr)

    def times(self, mine, theirs):
        """Medians of the CPU seconds of commands of petsam and of decks of CONTACT, in turns."""
        ours, others = [], []
        for _ in range(self.args.repeats):
            ours.append(sum(cpu([self.petsam, *options], self.work) - self.start for options in mine))
            if not others or others[0] < self.args.long:
                others.append(sum(cpu([self.contact, 2, deck], self.work) for deck in theirs))
        return statistics.median(ours), statistics.median(others)

    def add(self, case, cells, **row):
        self.rows.append(dict(case=case, cells=cells, **row))
        ratio = row["contact"] / row["petsam"] if "petsam" in row else None
        words = [case, cells, number(row.get("petsam")), number(row["contact"]), number(ratio)]
        words += [number(row.get(name)) for name in ("pressure", "shear")]
        words += [f"{row['load']:.5f}" if "load" in row else "", number(row.get("force"))]
        words += [", ".join(map(number, row["error"])) if "error" in row else ""]
        print("| " + " | ".join(map(str, words)) + " |", flush=True)

    def run_pair(self, label, name, cells, gdsteady):
        """One case on one grid: fields of one run each, then the times without files."""
        options, problem, error = CASES[name](cells)
        problem, tang = problem._replace(gdsteady=gdsteady), problem.tang
        write_deck(self.work / "fields.inp", [part(problem, True)])
        write_deck(self.work / "timed.inp", [part(problem, False)])
        cpu([self.petsam, *options, "-output", "petsam.h5"], self.work)
        cpu([self.contact, 2, "fields"], self.work)
        mine, theirs = petsam_fields(self.work / "petsam.h5"), fields(self.work / "fields.0001.mat")[3:]
        pressure, shear = compare(mine, theirs, -1.0 if tang == 1 else 1.0)
        found = dict(pressure=pressure, shear=shear)
        if error:
            found["error"] = [error(one[0], one[1:]) for one in (mine, theirs)]
        if tang == 3:
            axis = 2 if name == "spin" else 1
            force, other = (float(np.sum(one[axis])) * (WIDTH / cells) ** 2 / (MU * LOAD) for one in (mine, theirs))
            found |= dict(load=force, force=abs(force - other))
        petsam, contact = self.times([options], ["timed"])
        self.add(label, f"{cells}²", petsam=petsam, contact=contact, **found)

    def ball(self, name):
        rolls = name in ("rolling", "spin")
        for cells in self.args.cells:
            # the default solver takes minutes on 256 cells in rolling
            if not rolls or cells <= self.args.default_cells:
                self.run_pair(LABELS[name], name, cells, False)
            if rolls:
                self.run_pair(LABELS[name] + "; its FFT solver", name, cells, True)

    def carter(self):
        """Carter's cylinders of steel of 200 mm, R = 0.5 m: petsam has two rows of 100 mm, CONTACT one of 200 mm."""
        radius, length, width, load = 0.5, 0.2, 2.2e-3, 35.78e3
        half = math.sqrt(4 * load / length * radius * (1 - NU) / (math.pi * G))
        creep = 0.4 * MU * half / radius
        young = 2 * G * (1 + NU)
        for columns in (55, 440):
            options = words(
                rolling="steady", body1_young=young, body2_young=young, body1_poisson=NU, body2_poisson=NU, friction=MU,
                gap_type="ellipsoid", gap_radius_x=radius, gap_radius_y="inf", load_n=load, grid_n=f"{columns},2",
                grid_size=f"{width},{length}", creep_x=creep, creep_y=0, creep_spin=0, rot_x=0, rot_y=0,
            ) + ["-allow_edge_contact"]  # fmt: skip
            problem = Problem(3, [load, -creep, 0.0, 0.0], ((columns, 1), (width, length)), (0.5 / radius, 0.0))
            write_deck(self.work / "fields.inp", [part(problem, True)])
            write_deck(self.work / "timed.inp", [part(problem, False)])
            cpu([self.petsam, *options, "-output", "petsam.h5"], self.work)
            cpu([self.contact, 2, "fields"], self.work)
            mine = [one.mean(axis=0)[None] for one in petsam_fields(self.work / "petsam.h5")]
            theirs = fields(self.work / "fields.0001.mat")[3:]
            pressure, shear = compare(mine, theirs)
            area = width / columns * length
            found = [float(np.sum(one[1])) * area / (MU * load) for one in (mine, theirs)]
            petsam, contact = self.times([options], ["timed"])
            self.add(
                "Carter", f"{columns} columns", petsam=petsam, contact=contact, pressure=pressure, shear=shear,
                load=found[0], force=abs(found[0] - found[1]), error=[abs(one / 0.64 - 1) for one in found],
            )  # fmt: skip

    def bentall(self):
        """Bentall and Johnson's rollers of aluminium and steel under T_x = 0, 0.75 and -0.75 mu N."""
        load, mu, columns, length, width = 324.04, 0.05, 216, 0.02, 0.216e-3
        materials = (0.31, 0.28, 23e9, 82e9)
        grid, forces = ((columns, 1), (width, length)), (0.0, 0.75, -0.75)
        # its Newton iteration for the creepage needs a start that is near
        near = Problem(3, [load, -5.2e-4, 0.0, 0.0], grid, (20.0, 0.0), mu=mu, material=materials)

        def parts(files):
            yield part(near, False)
            for force in forces:
                yield part(near._replace(force=1, motion=[load, force, 0.0, 0.0]), files, first=False)

        write_deck(self.work / "fields.inp", parts(True))
        write_deck(self.work / "timed.inp", parts(False))
        cpu([self.contact, 2, "fields"], self.work)
        young = [2 * g * (1 + nu) for nu, g in zip(materials[:2], materials[2:])]
        base = words(
            rolling="steady", body1_young=young[1], body2_young=young[0], body1_poisson=materials[1],
            body2_poisson=materials[0], friction=mu, gap_type="ellipsoid", gap_radius_x=0.025, gap_radius_y="inf",
            load_n=load, grid_n=f"{columns},2", grid_size=f"{width},{length}", creep_y=0, creep_spin=0,
            rot_x=0, rot_y=0,
        ) + ["-allow_edge_contact"]  # fmt: skip
        history = self.work / "bentall.csv"
        history.write_text("time,load_tx\n" + "".join(f"{k},{f * mu * load!r}\n" for k, f in enumerate(forces, 1)))
        options = [*base, "-history", history]
        cpu([self.petsam, *options, "-output", "petsam.h5"], self.work)
        petsam, contact = self.times([options], ["timed"])
        for k, force in enumerate(forces):
            mine = [one.mean(axis=0)[None] for one in petsam_fields(self.work / "petsam.h5", k - len(forces))]
            theirs = fields(self.work / f"fields.{k + 2:04d}.mat")[3:]
            pressure, shear = compare(mine, theirs)
            with h5py.File(self.work / "petsam.h5") as file:
                creep = float(file["history/creep_x"][k - len(forces)])
            self.say(f"bentall {force}: creep_x {creep:.6e}")
            self.add(
                f"Bentall, T_x = {force:g} mu N", f"{columns} columns", petsam=petsam / len(forces),
                contact=contact / len(forces), pressure=pressure, shear=shear,
            )  # fmt: skip

    def manchester(self):
        """The Manchester benchmark's left wheel at 21 lateral positions, from CONTACT's own input and profiles.

        CONTACT alone finds the patch, its gap and its creepages from the profiles. With these, and N, as it prints
        them, both solve the patch in steady rolling on CONTACT's cells. The differences from the whole cases are those
        of one creepage a direction and patch: from the profiles, CONTACT has a rigid slip for each cell.
        """
        source = self.args.contact / "examples"
        for path in [*source.glob("MBench_*"), source / "mbench_a22_left.inp"]:
            shutil.copy(path, self.work)
        text = (self.work / "mbench_a22_left.inp").read_text()
        (self.work / "wheel.inp").write_text(re.sub(r"(?m)^( *\d{3})\d(\d{3} +H-G-I-A)", r"\g<1>2\2", text))
        cpu([self.contact, 2, "wheel"], self.work)
        found = re.findall(r"CHI +DQ +VELOC +CKSI +CETA +CPHI *\n *(.*)\n", (self.work / "wheel.out").read_text())
        patches = [fields(path) for path in sorted(self.work.glob("wheel.????*.mat"))]
        if not len(found) == len(patches) == 21:
            sys.exit(f"contact.py: {len(patches)} patches and {len(found)} creepages, not 21, in the Manchester cases")
        runs, parts, timed, young = [], [], [], 2 * G * (1 + NU)
        for k, (line, ((nx, ny), (dx, dy), gap, pressure, *_)) in enumerate(zip(found, patches)):
            creepages, load = [float(word) for word in line.split()[3:]], float(pressure.sum()) * dx * dy
            with h5py.File(self.work / f"gap{k}.h5", "w") as file:
                file["height"] = gap
            runs.append(words(
                rolling="steady", body1_young=young, body2_young=young, body1_poisson=NU, body2_poisson=NU, friction=MU,
                gap_type="file", gap_file=f"gap{k}.h5", load_n=load, grid_n=f"{nx},{ny}",
                grid_size=f"{nx * dx:.10g},{ny * dy:.10g}", creep_x=-creepages[0], creep_y=-creepages[1],
                creep_spin=-creepages[2] / MM, rot_x=0, rot_y=0,
            ))  # fmt: skip
            problem = Problem(3, [load, *creepages], ((nx, ny), (nx * dx, ny * dy)), gap)
            parts.append(part(problem, True))
            timed.append(part(problem, False))
        write_deck(self.work / "patches.inp", parts)
        write_deck(self.work / "timed.inp", timed)
        cpu([self.contact, 2, "patches"], self.work)
        differences = {"whole": [], "patches": []}
        for k, (options, patch) in enumerate(zip(runs, patches)):
            cpu([self.petsam, *options, "-output", "petsam.h5"], self.work)
            mine = petsam_fields(self.work / "petsam.h5")
            theirs = fields(self.work / f"patches.{k + 1:04d}.mat")[3:]
            for name, other in (("whole", patch[3:]), ("patches", theirs)):
                force = math.hypot(*(float(np.sum(mine[j] - other[j])) for j in (1, 2))) / (MU * float(np.sum(mine[0])))
                differences[name].append((*compare(mine, other), force))
            self.say(k + 1, patch[0], differences["whole"][-1], differences["patches"][-1])
        petsam, contact = self.times(runs, ["timed"])
        _, whole = self.times([], ["mbench_a22_left"])
        for label, name, seconds in (
            ("21 patches of the Manchester benchmark", "patches", dict(petsam=petsam, contact=contact)),
            ("the 21 cases from the profiles", "whole", dict(contact=whole)),
        ):
            worst = [max(one[j] for one in differences[name]) for j in range(3)]
            self.add(label, "", **seconds, pressure=worst[0], shear=worst[1], force=worst[2])


def number(value):
    return "" if value is None else f"{value:.2g}" if value < 100 else f"{value:.0f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument("--contact", type=Path, default=os.environ.get("CONTACT"), help="folder with " + PROGRAM)
    parser.add_argument("--cells", type=lambda text: [int(word) for word in text.split(",")], default=[64, 128, 256])
    parser.add_argument("--default-cells", type=int, default=128, help="of its default solver in rolling, at most")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--long", type=float, default=5, help="seconds")
    parser.add_argument("--verbose", action="store_true", help="print each of the Manchester cases")
    parser.add_argument("--only", type=lambda text: text.split(","))
    args = parser.parse_args()
    if not args.contact or not (Path(args.contact) / PROGRAM).is_file():
        sys.exit(
            "contact.py: no CONTACT: give --contact folder, or CONTACT=folder with make bench, with the folder of a "
            f"checkout of its repository that has its built program {PROGRAM}"
        )
    args.contact = Path(args.contact)
    with tempfile.TemporaryDirectory() as work:
        bench = Bench(args, work)
        runs = {**{name: lambda name=name: bench.ball(name) for name in CASES}, "carter": bench.carter}
        runs |= {"bentall": bench.bentall, "manchester": bench.manchester}
        print("| case | cells | petsam | CONTACT | ratio | pressure | shear | T/(mu N) | T/(mu N) | errors |")
        print("|" + " --- |" * 10)
        for name in args.only or runs:
            runs[name]()
        print(f"petsam's start, taken off: {bench.start:.3f} s")
    out = args.build / "bench" / "contact"
    out.mkdir(parents=True, exist_ok=True)
    with open(out / "contact.csv", "w", newline="") as file:
        names = dict.fromkeys(name for row in bench.rows for name in row)
        writer = csv.DictWriter(file, names)
        writer.writeheader()
        writer.writerows(bench.rows)


if __name__ == "__main__":
    main()
