#!/usr/bin/env python3
"""The benchmark's problems, and one measure of accuracy for all programs that solve them.

    python3 tests/bench/problem.py make CASE CELLS FOLDER      write problem.json, gap.npy, petsam.opts and its inputs
    python3 tests/bench/problem.py check FOLDER SOLUTION       print the accuracy of results.h5 or pressure.npy as JSON

All are contacts of the steel spheres of examples/sphere, or of a rough plane of the same size and material, on an
elastic half-space that is not periodic, but for the periodic case, in which the plane is one period. The rough plane is
self-affine (Hurst exponent 0.8, wavelengths from a quarter to a 64th of the width), the same function of place on every
grid, and does not tilt.
"""

import json
import sys
from pathlib import Path

import h5py
import numpy as np
from scipy import fft

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "program"), str(ROOT / "tests" / "bench")]
import fretting_cycle  # noqa: E402
from support import SPHERE, Results, closed, hertz, kernels, l2, slide_limit, words  # noqa: E402

HURST, SHORTEST, LONGEST, SLOPE = 0.8, 64, 4, 0.1
# N over (E* slope area of the grid) that brings about this share of the plane into contact, at 512 cells
ROUGH_LOADS = {"rough_1": 0.00425, "rough_8": 0.0359, "rough_40": 0.241, "periodic_8": 0.0359}


def rough_plane(n, width):
    """Heights of the rough plane (n, n), m, of root mean square slope SLOPE: a sum of waves, each by its number."""
    modes = np.arange(-SHORTEST, SHORTEST + 1)
    kx, ky = np.meshgrid(modes, modes)
    k = np.hypot(kx, ky)
    rng = np.random.default_rng(2024)
    size = np.exp(2j * np.pi * rng.random(k.shape)) * ((k >= LONGEST) & (k <= SHORTEST))
    size *= np.maximum(k, 1.0) ** -(1 + HURST)
    size *= SLOPE / np.sqrt(0.5 * np.sum(np.abs(2 * np.pi * k / width * size) ** 2))
    seen = 2 * np.abs(modes) < n
    waves = np.exp(2j * np.pi * np.outer((np.arange(n) + 0.5) / n, modes[seen]))  # at the cells' centres
    columns = size[np.ix_(seen, seen)] @ waves.T
    heights = np.empty((n, n))
    for rows in np.array_split(np.arange(n), max(1, n // 512)):  # large grids in parts
        heights[rows] = waves[rows].real @ columns.real - waves[rows].imag @ columns.imag
    return heights


def base(n):
    """petsam's options of the sphere and its separation (n, n)."""
    case = dict(SPHERE, grid_n=n)
    x = ((np.arange(n) + 0.5) / n - 0.5) * case["grid_size"]
    radius = closed.effective_radius(case["gap_radius1"], case["gap_radius2"])
    return case, (x[None, :] ** 2 + x[:, None] ** 2) / (2 * radius)


def make(name, n, folder):
    """Write the problem of that name and number of cells; return its petsam options."""
    folder.mkdir(parents=True, exist_ok=True)
    case, gap = base(n)
    e_star = modulus(case)
    force, torque = slide_limit(case)
    kind = "normal"
    if name in ROUGH_LOADS:
        kind = "periodic" if name.startswith("periodic") else "rough"
        gap = rough_plane(n, case["grid_size"])
        gap -= gap.min()
        with h5py.File(folder / "gap.h5", "w") as f:
            f["height"] = gap
        load = ROUGH_LOADS[name] * e_star * SLOPE * case["grid_size"] ** 2
        case = {k: v for k, v in case.items() if not k.startswith("gap_")}
        case.update(gap_type="file", gap_file=folder / "gap.h5", load_n=load)
        case.update(
            dict(elasticity="periodic") if kind == "periodic" else dict(rot_x=0.0, rot_y=0.0, allow_edge_contact=True)
        )
    elif name == "slip_tx":
        kind = "tangential"
        case.update(load_tx=0.6 * force)
    elif name == "slip_tx_mz":
        kind = "torque"
        case.update(load_tx=0.5 * force, load_mz=0.5 * torque)
    elif name.startswith("cycle_"):
        kind = "cycle"
        fretting_cycle.write_history(folder / "cycle.csv", int(name[len("cycle_") :]))
        case.update(history=folder / "cycle.csv")
    np.save(folder / "gap.npy", gap)
    (folder / "petsam.opts").write_text(" ".join(words(case)).replace(" -", "\n-") + "\n")  # no value is negative
    (folder / "problem.json").write_text(
        json.dumps(
            dict(
                case=name,
                kind=kind,
                cells=n,
                width=case["grid_size"],
                e_star=e_star,
                poisson=case["body1_poisson"],
                friction=case["friction"],
                load_n=case["load_n"],
                load_tx=case.get("load_tx", 0.0),
                steps=fretting_cycle.forces(int(name[len("cycle_") :])) if kind == "cycle" else [],
                options=words(case),
            ),
            indent=1,
        )
    )


def modulus(case):
    return closed.effective_modulus(
        *[case[k] for k in ("body1_young", "body1_poisson", "body2_young", "body2_poisson")]
    )


# ---------------------------------------------------------------- accuracy


def periodic_displacement(pressure, width, e_star):
    """u_z (n, n), m, from the mean surface, of a half-space whose period is the grid: 2/(E* |k|) times each wave."""
    n = pressure.shape[0]
    k = 2 * np.pi / width * np.hypot(np.arange(n // 2 + 1.0)[None, :], n * fft.fftfreq(n)[:, None])
    k[0, 0] = np.inf
    return fft.irfft2(2 / (e_star * k) * fft.rfft2(pressure, workers=2), s=(n, n), workers=2)


def displacement(pressure, width, e_star):
    """u_z (n, n), m, by a padded transform of coefficients that are written down apart from the program's."""
    n = pressure.shape[0]
    i = np.arange(n + 1.0)
    quadrant = kernels(*np.meshgrid(i, i), 1.0, 1.0)["r"] * width / n / (np.pi * e_star)
    fold = np.minimum(np.arange(2 * n), 2 * n - np.arange(2 * n))
    spectrum = fft.rfft2(quadrant[np.ix_(fold, fold)], workers=2)
    spectrum *= fft.rfft2(pressure, s=(2 * n, 2 * n), workers=2)
    return fft.irfft2(spectrum, workers=2)[:n, :n]


def normal_accuracy(pressure, gap, problem):
    """How far a pressure is from the contact problem's solution; all relative.

    complementarity: sum p |g| / (N u), u the largest displacement; penetration: of the deepest cell, in u;
    load: |sum p dA / N - 1|. g is the gap with the approach that fits it best where the bodies touch.
    """
    area = (problem["width"] / problem["cells"]) ** 2
    law = periodic_displacement if problem["kind"] == "periodic" else displacement
    u = law(pressure, problem["width"], problem["e_star"])
    g = u + gap
    g -= np.sum(pressure * g) / np.sum(pressure)
    scale = np.max(u)
    return dict(
        complementarity=float(np.sum(pressure * np.abs(g)) * area / (problem["load_n"] * scale)),
        penetration=float(max(0.0, -np.min(g)) / scale),
        load=float(abs(np.sum(pressure) * area / problem["load_n"] - 1)),
        contact=float(np.mean(pressure > 0)),
    )


def against_hertz(pressure, problem):
    """Relative L2 error of the pressure."""
    h, n = hertz(SPHERE), problem["cells"]
    x = ((np.arange(n) + 0.5) / n - 0.5) * problem["width"]
    return float(l2(pressure, closed.hertz_pressure(np.hypot(x[None, :], x[:, None]), h.radius, h.pressure)))


def check(folder, solution):
    """Accuracy of a solution: petsam's results file, or an array of the pressure or of pressure and shear."""
    problem = json.loads((folder / "problem.json").read_text())
    gap = np.load(folder / "gap.npy")
    numbers = {}
    if solution.suffix == ".h5":
        r = Results(solution)
        pressure = r.pressure
        numbers.update(
            {
                k: float(r[k])
                for k in r.history
                if k.endswith(("_iterations", "_applies", "_preconditions", "_residual"))
            }
        )
        with h5py.File(solution, "r") as f:
            for k in ("normal_applies", "tangential_applies", "normal_preconditions", "tangential_preconditions"):
                numbers["total_" + k] = int(np.sum(f["history"][k]))
    else:
        fields = np.load(solution)
        pressure = fields[0]
        if len(fields) == 3:  # the shear against petsam's, which its check has certified
            r = Results(folder / "results.h5")
            numbers["shear_difference"] = float(l2(fields[1:], np.stack([r.shear_x, r.shear_y])))
    numbers.update(normal_accuracy(pressure, gap, problem))
    if problem["kind"] not in ("rough", "periodic"):
        numbers["hertz_l2"] = against_hertz(pressure, problem)
    return numbers


def main():
    if len(sys.argv) == 5 and sys.argv[1] == "make":
        make(sys.argv[2], int(sys.argv[3]), Path(sys.argv[4]))
    elif len(sys.argv) == 4 and sys.argv[1] == "check":
        print(json.dumps(check(Path(sys.argv[2]), Path(sys.argv[3]))))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
