"""A wavy surface pressed onto a flat: Westergaard."""

import tempfile
from pathlib import Path

import h5py
import mpmath as mp
import numpy as np
from common import closed

import petsam

# decimal, so that mpmath reads them exactly
N, LENGTH, HEIGHT, YOUNG, POISSON = "120e3", "1e-3", "1e-6", "210e9", "0.3"
OPTIONS = {
    "elasticity": "plane_periodic",
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": POISSON for body in (1, 2)},
    "gap_type": "file",
    "load_n": N,
    "stiffness": True,
    "contact_spots": True,
    "output_fields": "pressure,gap",
}


def solve(cells=512):
    """petsam reads the wave from a file: its values at the cells' centres."""
    size = float(LENGTH)
    x = ((np.arange(cells) + 0.5) / cells - 0.5) * size
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "wave.h5"
        with h5py.File(path, "w") as file:
            file["height"] = float(HEIGHT) * (1 - np.cos(2 * np.pi * x / size))[None, :]
        return petsam.run(OPTIONS, gap_file=path, grid_n=(cells, 1), grid_size=(size, size / cells))


def evidence():
    """Johnson, Contact Mechanics (1985), section 13.2, in 30 digits; the mean gap by quadrature too."""
    with mp.workdps(30):
        n, length, height = mp.mpf(N), mp.mpf(LENGTH), mp.mpf(HEIGHT)
        e_star = mp.mpf(YOUNG) / (1 - mp.mpf(POISSON) ** 2) / 2
        full = mp.pi * e_star * height / length  # mean pressure of full contact
        share = n / length / full
        sine = mp.sqrt(share)
        edge = mp.asin(sine)  # of pi x/length
        gap = height * (1 - share + share * mp.log(share))

        def slope(angle):  # d gap/d angle; Westergaard's function beyond the edge
            return 4 * height * mp.cos(angle) * mp.sqrt(mp.sin(angle) ** 2 - share)

        # by parts: each bit of slope raises the gap from there to the middle of the valley
        raised = mp.quad(lambda angle: slope(angle) * (mp.pi / 2 - angle), [edge, mp.pi / 2]) * 2 / mp.pi
        assert abs(raised / gap - 1) < 1e-12
        how = "closed form (Westergaard 1939; Johnson, Contact Mechanics, section 13.2), mpmath, 30 digits"
        return [
            closed("contact_width", "m", 2 * length / mp.pi * edge, how),
            closed("pressure_max", "Pa", 2 * n / length / sine, how),
            closed("gap_mean", "m", gap, how),
            closed("stiffness", "Pa/m", -full / (height * mp.log(share)), how),
            closed("elastic_energy", "J/m", n * height * share * (0.5 - mp.log(share)) / 2, how),
        ]


def answers():
    results = solve()
    h = results.history
    return {
        "contact_width": h["contact_area"][-1],
        "pressure_max": h["pressure_max"][-1],
        "gap_mean": h["gap_mean"][-1],
        "stiffness": results.matrices["stiffness"][-1][0, 0] / float(LENGTH),
        "elastic_energy": h["stored_energy"][-1],
    }


def draw(figure):
    results = solve()
    left, right = figure.subplots(1, 2)
    x = results.x * 1e3
    left.plot(x, results["pressure"][-1][0] * 1e-6)
    left.set_xlabel("x, mm")
    left.set_ylabel("p, MPa")
    wave = float(HEIGHT) * (1 - np.cos(2 * np.pi * results.x / float(LENGTH)))
    right.plot(x, wave * 1e6, "--", label="unloaded")
    right.plot(x, results["gap"][-1][0] * 1e6, label="loaded")
    right.set_xlabel("x, mm")
    right.set_ylabel("gap, µm")
    right.legend(loc="upper center")
