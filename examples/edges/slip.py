#!/usr/bin/env python3
"""Errors of a loop of partial slip: two spheres under a cyclic tangential load, beside Cattaneo, Mindlin and
Deresiewicz's solution (without Poisson's effect, for which it is exact). Used by run.sh.

    python3 examples/edges/slip.py PETSAM FOLDER [CELLS...]
"""

import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np

from edges import LABELS, PLACES
from petsam import closed
from petsam.closed import loop

LOAD, FRICTION, AMPLITUDE, STEPS = 1000.0, 0.1, 0.6, 24  # N, of mu N, steps in each direction
YOUNG, RADIUS = 210e9, 0.2
SCALARS = ("shear at the centres", "stick area", "displacement", "energy of the loop")


class Spheres:
    """The closed solution: shear, stick area and displacement at each step, energy of the loop."""

    def __init__(self):
        e_star = closed.effective_modulus(YOUNG, 0.0, YOUNG, 0.0)
        self.radius = (3 * LOAD * RADIUS / 2 / (4 * e_star)) ** (1 / 3)
        self.pressure = 3 * LOAD / (2 * np.pi * self.radius**2)
        g = closed.shear_modulus(YOUNG, 0.0)
        compliance = closed.tangential_compliance(g, 0.0, g, 0.0)
        self.limit, self.gross = FRICTION * LOAD, 3 * FRICTION * LOAD * compliance / (4 * self.radius)
        there = AMPLITUDE - 2 * AMPLITUDE * np.arange(1, STEPS + 1) / STEPS
        self.loads = np.concatenate([[AMPLITUDE], there, -there])  # of mu N
        self.sign = np.concatenate([[1.0], np.ones(STEPS), -np.ones(STEPS)])  # of where the load has turned

    def turned(self, step):
        """The part of mu N that has come since the load turned, halved; at first all of it."""
        return AMPLITUDE if step == 0 else (AMPLITUDE - self.sign[step] * self.loads[step]) / 2

    def stick_area(self, step):
        return np.pi * self.radius**2 * (1 - self.turned(step)) ** (2 / 3)

    def displacement(self, step):
        first = loop.first_loading(AMPLITUDE * self.limit, self.limit, self.gross)
        if step == 0:
            return first
        turn = self.sign[step]
        load = self.loads[step] * self.limit
        return loop.masing_displacement(load, turn * AMPLITUDE * self.limit, turn * first, self.limit, self.gross)

    def shear(self, r, step):
        def hertz(part):
            return part * closed.hertz_pressure(r / part, self.radius, self.pressure)

        first = hertz(1.0) - hertz((1 - AMPLITUDE) ** (1 / 3))
        if step == 0:
            return FRICTION * first
        return FRICTION * self.sign[step] * (first - 2 * (hertz(1.0) - hertz((1 - self.turned(step)) ** (1 / 3))))


def run(petsam, folder, exact, n, place, way):
    width = 3 * exact.radius
    x, y = (part * width / n for part in place)
    loads = "".join(f"{k + 1}, {LOAD}, {float(t * exact.limit)!r}\n" for k, t in enumerate(exact.loads))
    (folder / "loop.csv").write_text("time, load_n, load_tx\n" + loads)
    field = "shear_x" if way == "none" else "shear_center_x"
    words = (
        f"-grid_n {n} -grid_size {width!r} -grid_center {x!r},{y!r} -body1_young {YOUNG} -body1_poisson 0 "
        f"-body2_young {YOUNG} -body2_poisson 0 -gap_type sphere -gap_radius1 {RADIUS} -gap_radius2 {RADIUS} "
        f"-friction {FRICTION} -history {folder}/loop.csv -edges {way} -output {folder}/loop.h5 -output_fields {field} "
        "-quiet"
    )
    done = subprocess.run([petsam, *words.split()], capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    return h5py.File(folder / "loop.h5"), field


def measure(petsam, folder, exact, n, place, way):
    """Relative errors: rms over the steps of shear (2-norm) and stick area, the largest displacement, the energy."""
    file, field = run(petsam, folder, exact, n, place, way)
    with file:
        r = np.hypot(file["x"][:][None, :], file["y"][:][:, None])
        history = {name: file["history"][name][:] for name in ("stick_area", "disp_x", "dissipated_energy")}
        scale = np.linalg.norm(exact.shear(r, 0))
        steps = range(len(exact.loads))
        shear = [np.linalg.norm(file[field][k] - exact.shear(r, k)) / scale for k in steps]
    area = [history["stick_area"][k] / exact.stick_area(k) - 1 for k in steps]
    moved = [history["disp_x"][k] - exact.displacement(k) for k in steps]
    energy = history["dissipated_energy"][1:].sum()
    energy /= loop.partial_loop_energy(AMPLITUDE * exact.limit, exact.limit, exact.gross)
    return np.array(
        [
            np.sqrt(np.mean(np.square(shear))),
            np.sqrt(np.mean(np.square(area))),
            np.max(np.abs(moved)) / exact.displacement(0),
            energy - 1,
        ]
    )


def main():
    petsam, folder = sys.argv[1], Path(sys.argv[2])
    cells = tuple(int(word) for word in sys.argv[3:]) or (64, 128, 256)
    exact = Spheres()
    print("cyclic partial slip", *SCALARS, sep="  ")
    for n in cells:
        for way in ("none", "reconstruct"):  # with friction there is no correction
            each = [measure(petsam, folder, exact, n, place, way) for place in PLACES[:2]]
            print(
                f"{n:4} {LABELS[way]:13}", *(f"{e:9.1e}" for e in np.sqrt(np.mean(np.square(each), axis=0))), flush=True
            )


if __name__ == "__main__":
    main()
