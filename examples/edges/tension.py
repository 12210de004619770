#!/usr/bin/env python3
"""Error of the maximum tension under a sphere that slides: in the map of the surface, and at the edge of contact. Used
by run.sh.

    python3 examples/edges/tension.py PETSAM FOLDER [CELLS...]
"""

import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np

from edges import PLACES
from petsam import closed

LOAD, FRICTION, YOUNG, POISSON, RADIUS = 1000.0, 0.3, 210e9, 0.3, 0.2


def measure(petsam, folder, n, place):
    """Relative errors of both; at the trailing edge the stress is (1 - 2 nu)/3 + mu pi (4 + nu)/8 of p0."""
    e_star = closed.effective_modulus(YOUNG, POISSON, YOUNG, POISSON)
    hertz = closed.hertz(LOAD, RADIUS / 2, e_star)
    width = float(2.6 * hertz.radius)
    x, y = (part * width / n for part in place)
    bodies = " ".join(f"-body{k}_young {YOUNG} -body{k}_poisson {POISSON} -gap_radius{k} {RADIUS}" for k in (1, 2))
    words = (
        f"-grid_n {n} -grid_size {width!r} -grid_center {x!r},{y!r} {bodies} -gap_type sphere -friction {FRICTION} "
        f"-load_n {LOAD} -disp_x 1e-4 -output {folder}/tension.h5 -output_fields pressure,shear_x,shear_y -quiet"
    )
    subprocess.run([petsam, *words.split()], check=True)
    words = f"-input {folder}/tension.h5 -output {folder}/stress.h5 -depths 0 -quantities stress -quiet"
    subprocess.run([Path(petsam).with_name("petsam-stress"), *words.split()], check=True)
    exact = ((1 - 2 * POISSON) / 3 + FRICTION * np.pi * (4 + POISSON) / 8) * hertz.pressure
    with h5py.File(folder / "stress.h5") as file:
        return file["stress_xx"][0].max() / exact - 1, file["history/edge_stress_xx_max"][0] / exact - 1


def main():
    petsam, folder = sys.argv[1], Path(sys.argv[2])
    print("maximum tension under sliding    map     edge")
    for n in tuple(int(word) for word in sys.argv[3:]) or (64, 128, 256, 512):
        errors = np.array([measure(petsam, folder, n, place) for place in PLACES])
        print(f"{n:4} cells{'':18}", *(f"{e:8.1e}" for e in np.sqrt(np.mean(errors**2, axis=0))), flush=True)


if __name__ == "__main__":
    main()
