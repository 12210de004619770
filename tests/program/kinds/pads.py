"""Random pads in plane strain: numbers that are wrong without a warning, and right with one.

Flat pads with rounded edges of all radii under N and T, with load reversals, moments, bulk stress, on 48 to 256 cells,
against grids and steps four times finer. Wrong: one of the energy of all steps, the maximum shear, slip and pressure of
the last step by more than 5 %; right: all within 2 %.
"""

from pathlib import Path

import h5py
import numpy as np

import conftest
from kinds import Outcome
from support import history

NUMBERS = ("shear_max", "slip_max", "pressure_max")
WRONG, RIGHT = 0.05, 0.02
OPTIONS = dict(trials=100, finer=4)


def random_case(seed, folder, finer=1):
    """Options of a pad and its history."""
    rng = np.random.default_rng(seed)
    flat = rng.uniform(0.5e-3, 5e-3)
    edge = flat * 10 ** rng.uniform(0.3, 2.5)
    young, poisson = rng.choice([70e9, 115e9, 210e9]), rng.choice([0.0, 0.3, 0.33])
    modulus = young / (1 - poisson**2) / 2
    pressure = modulus * 10 ** rng.uniform(-3.5, -2)
    normal, friction = 2 * flat * pressure, rng.uniform(0.2, 1.0)
    cells, steps = int(rng.integers(48, 257)), int(rng.choice([1, 2, 4, 8]))
    part = rng.uniform(0.1, 0.95)
    shape = rng.choice(["grows", "cycle", "returns", "small", "walk"])
    last = 1 - 2 * 10 ** rng.uniform(-2, 0)
    ways = dict(
        grows=[0, 1], cycle=[0, 1, -1, 1], returns=[0, 1, 0], small=[0, 1, last], walk=[0, *rng.uniform(-1, 1, 3)]
    )
    loads = [1, *rng.uniform(0.6, 1, 3)] if shape == "walk" else [1] * 4
    bulk = rng.choice([0.0, 1.0]) * 10 ** rng.uniform(-1.5, 0) * friction * pressure
    part *= rng.choice([0.0, 1.0]) if bulk else 1  # bulk stress with T or alone
    tilt = rng.choice([0.0, 0.0, 0.15]) * normal * flat
    rows = [
        (k, normal * load, part * friction * normal * load * way, tilt * load)
        for k, (way, load) in enumerate(zip(ways[shape], loads))
    ]
    names = "time,load_n,load_tx,load_my"
    if bulk:
        rows = [(*row, bulk * way) for row, way in zip(rows, ways[shape])]
        names += ",bulk1_stress_xx"
    rows = [tuple(map(float, row)) for row in rows]
    case = dict(
        elasticity="plane",
        gap_type="pad",
        gap_half_flat_x=flat,
        gap_edge_radius_x=edge,
        friction=friction,
        grid_n=cells * finer,
        grid_size=2 * flat * rng.uniform(1.3, 2.0),
        steps=steps * min(finer, 4),
    )
    case.update({f"body{b}_{name}": value for b in (1, 2) for name, value in (("young", young), ("poisson", poisson))})
    return {**case, **history(Path(folder) / "h.csv", names, *rows)}


def read(path):
    """The numbers of a results file, with the energy of all steps, whether the last step slides, and the work of T."""
    with h5py.File(path) as file:
        every = {name: file[f"history/{name}"][:] for name in (*NUMBERS, "dissipated_energy", "stored_energy")}
    numbers = {name: every[name][-1] for name in NUMBERS}
    return dict(numbers, energy=every["dissipated_energy"].sum())


def compare(found, true, least):
    """The largest relative error, and its name; `least` by name: below it a number counts as none."""
    errors = {name: abs(found[name] - true[name]) / max(abs(true[name]), least.get(name, 0), 1e-300) for name in true}
    worst = max(errors, key=errors.get)
    return errors[worst], worst


def trial(seed, folder, given):
    """The largest error, and the warnings."""
    found = []
    for finer in (1, given.finer):
        case = dict(random_case(seed, folder, finer), output=f"{finer}.h5")
        done = conftest.execute(conftest.launcher_words(), folder, [case], 1, None)
        if done.code:
            return Outcome(f"not solved: {done.stderr.splitlines()[-1:]}")
        found.append((read(folder / f"{finer}.h5"), done))
    warnings = [line for line in found[0][1].stderr.splitlines() if "warning" in line]
    error, number = compare(found[0][0], found[1][0], dict(energy=0, slip_max=0))
    told = error < RIGHT if warnings else error > WRONG
    text = "\n    ".join([f"{number} wrong by {100 * error:.3g} %", *warnings])
    return Outcome(text, None, dict(error=error, warnings=warnings), telling=told)


def summary(found):
    silent = [seed for seed, one in found.items() if one["error"] > WRONG and not one["warnings"]]
    warned = [seed for seed, one in found.items() if one["error"] > WRONG and one["warnings"]]
    loud = [seed for seed, one in found.items() if one["error"] < RIGHT and one["warnings"]]
    return [
        f"{len(found)} solved: {len(silent)} wrong without a warning {silent}, {len(warned)} wrong with one, "
        f"{len(loud)} right with one {loud}"
    ]
