"""Frictional heat of random contacts: each temperature by direct summation in numpy, and its balance and friction."""

import subprocess

import h5py
import numpy as np
from scipy.special import erf

import conftest
from kinds import Outcome
from support import words

OPTIONS = {"trials": 50}
LIMIT = 1e-6  # of temperatures, relative to their largest rise
NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)


def table(body, side, shape):
    """Temperatures (K m2/W) by unit flux on a cell, by lag [j, i] of receiver minus source from -(n - 1) on.

    The integral over the ages of heat; s is the width of a pulse of an age, on panels of equal ratio.
    """
    lam, capacity, speed = body
    peclet = -speed * capacity / (2 * lam)  # the material moves to -x where it is positive
    ny, nx = shape
    far = np.hypot(nx * side[0], ny * side[1])
    last = 3e3 * far if peclet == 0 else max(60 * far, 30 / abs(peclet))
    ends = np.concatenate([[0], np.geomspace(1e-4 * min(side), last, 900)])
    half = np.diff(ends) / 2
    s = (ends[:-1, None] + half[:, None] * (1 + NODES)).ravel()
    weight = (half[:, None] * WEIGHTS).ravel()

    def part(lags, a, drift):
        return (erf((lags[:, None] + drift + a / 2) / s) - erf((lags[:, None] + drift - a / 2) / s)) / 2

    along = part(np.arange(1 - nx, nx) * side[0], side[0], peclet * s**2 / 2)
    across = part(np.arange(1 - ny, ny) * side[1], side[1], 0)
    rest = side[0] * side[1] / (np.pi * ends[-1]) if peclet == 0 else 0  # of older heat
    return (np.einsum("js,is,s->ji", across, along, weight) + rest) / (lam * np.sqrt(np.pi))


def temperature(body, side, flux):
    """Temperature by a flux (W/m2), cell by cell."""
    ny, nx = flux.shape
    values = table(body, side, flux.shape)
    found = np.zeros(flux.shape)
    for j, i in np.argwhere(flux):
        found += flux[j, i] * values[ny - 1 - j : 2 * ny - 1 - j, nx - 1 - i : 2 * nx - 1 - i]
    return found


def draw(random):
    """Options of a problem; half of them roll."""
    rolls, n = random.random() < 0.5, [int(random.integers(9, 22)) for _ in range(2)]
    radius, load = 10 ** random.uniform(-2.5, -1), 10 ** random.uniform(0, 2)
    a = (0.75 * load * radius / 115e9) ** (1 / 3)
    case = dict(
        body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3, gap_type="sphere",
        gap_radius1=radius, gap_radius2="inf", load_n=load, friction=0.4, heat="steady", grid_n=f"{n[0]},{n[1]}",
        grid_size=f"{2.9 * a},{2.6 * a}", errors="none", edges="none",
    )  # fmt: skip
    for b in (1, 2):
        case[f"body{b}_conductivity"] = 10 ** random.uniform(0, 2.3)
        case[f"body{b}_heat_capacity"] = 10 ** random.uniform(6, 6.7)
        case[f"body{b}_bulk_temperature"] = random.choice([0.0, 20.0, 90.0])
    case["heat_resistance"] = random.choice([0.0, 10 ** random.uniform(-8, -5)])
    if rolls:
        case.update(rolling="steady", creep_x=10 ** random.uniform(-5, -1), creep_y=10 ** random.uniform(-5, -2))
        case["rolling_speed"] = 10 ** random.uniform(-3, 0) * 50e-6 / a  # P times a cell up to some 30
        if random.random() < 0.5:
            case["friction_temperature"] = "20,50,-0.15"
    else:
        case.update(load_tx=0.39 * load * random.uniform(0.1, 0.99), sum_friction_energy=True)
        for b in (1, 2):
            speed = 10 ** random.uniform(-3, 0) * 50e-6 / a
            case[f"body{b}_speed"] = random.choice([0.0, -speed, speed])
    return case


def heat_of(file, case):
    """Frictional power per area in contact, W/m2."""
    work = file["power_density"][-1] * case["rolling_speed"] if "rolling" in case else file["friction_energy"][-1]
    return np.where(file["pressure"][-1] > 0, np.maximum(work, 0), 0)


def judge(file, case):
    """What is wrong, by name; and how far temperatures are from those by summation."""
    heat, heat_2 = heat_of(file, case), file["heat_2"][-1]
    there = file["pressure"][-1] > 0
    n = [int(part) for part in case["grid_n"].split(",")]
    side = [float(part) / k for part, k in zip(case["grid_size"].split(","), n, strict=True)]
    found, wrong, worst = [], {}, 0.0
    for b, flux in ((1, heat - heat_2), (2, heat_2)):
        speed = -case["rolling_speed"] if "rolling" in case else case[f"body{b}_speed"]
        body = case[f"body{b}_conductivity"], case[f"body{b}_heat_capacity"], speed
        rise = temperature(body, side, flux)
        bulk = case[f"body{b}_bulk_temperature"]
        found.append(file[f"temperature_{b}"][-1])
        apart = abs(found[-1] - bulk - rise).max() - 4 * np.finfo(float).eps * bulk  # rounding of what the bulk has
        worst = max(worst, apart / max(abs(rise).max(), 1e-300))
    if worst > LIMIT:
        wrong["temperature"] = worst
    scale = max(np.ptp(found[0]), np.ptp(found[1]), 1e-30)
    jump = abs(found[0] - found[1] - case["heat_resistance"] * heat_2)[there].max() / scale
    if jump > 1e-5:
        wrong["jump"] = jump
    if "friction_temperature" in case:
        friction = 0.4 - 0.15 * np.clip((found[0] - 20) / 50, 0, 1)
        shear = np.hypot(file["shear_x"][-1], file["shear_y"][-1])
        over = (shear - friction * file["pressure"][-1])[there].max() / shear.max()
        if over > 0.02:
            wrong["friction"] = over
    return wrong, worst


def trial(seed, folder, given=None):
    """What is wrong with the temperatures of a problem."""
    case = draw(np.random.default_rng(seed))
    line = [str(conftest.PROGRAM), *words(dict(case, output="own.h5", output_fields="all"))]
    done = subprocess.run(line, cwd=folder, capture_output=True, text=True, timeout=300, env=conftest.environment())
    text = f"{seed} " + " ".join(line[1:])
    if done.returncode:
        return Outcome(f"{text}\n  code {done.returncode}: {done.stderr.strip()[-300:]}", fault=True)
    with h5py.File(folder / "own.h5") as file:
        wrong, worst = judge(file, case)
    said = f"{text}\n  {wrong}" if wrong else text
    return Outcome(said, fault=bool(wrong), numbers={"temperature": float(worst)})


def summary(found):
    """The largest difference."""
    values = [one["temperature"] for one in found.values()] or [0.0]
    return [
        f"temperatures within {max(values):.1e} of those by summation, over the largest rise; {len(values)} problems"
    ]
