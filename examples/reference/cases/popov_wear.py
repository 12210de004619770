"""Fretting wear with a stick zone: Popov's limit in closed form, and a state before it by petsam and by rings."""

import functools

import mpmath as mp
import numpy as np
from common import all_covered, closed
from worn_sphere import Sphere

import petsam

YOUNG, RADIUS, FRICTION, APPROACH, STROKE, WEAR = "210e9", "0.2", "0.1", "7.5e-6", "5.625e-7", "1e-14"
CYCLES, END = 1000000, 12000000  # of the state before the limit, of the limit
GAMMA = 0.5  # stick radius over the contact radius without wear: sqrt(1 - u0/(mu d)) for nu = 0, where G* = E*
OPTIONS = {
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": 0 for body in (1, 2)},
    "friction": FRICTION,
    "gap_type": "sphere",
    "gap_radius1": RADIUS,
    "gap_radius2": RADIUS,
    "grid_size": 2.25166605e-3,
    "disp_z": APPROACH,
    "wear_coefficient1": WEAR,
}
TURNS = np.interp(np.arange(17), [0, 4, 8, 12, 16], [0, 1, 0, -1, 0])


@functools.lru_cache
def solve(cells, rtol, cycles):
    history = {"disp_x": TURNS * float(STROKE)}
    more = {"wear_cycles": cycles, "wear_output": f"0,{CYCLES}", "output_every": len(TURNS) - 1, "wear_rtol": rtol}
    return petsam.run(OPTIONS, history=history, grid_n=cells, **more)


def measured(cells, rtol=1e-2, cycles=CYCLES):
    """petsam's numbers of the state before the limit, and of the limit if that is reached."""
    results = solve(cells, rtol, cycles)
    wear, last = results.wear, results.history["cycle"]
    at = int(np.flatnonzero(wear["cycle"] == CYCLES)[0])
    force = results.history["load_n"][np.flatnonzero(last == CYCLES)[-1]]
    found = {"normal_force": force, "wear_volume": wear["volume1"][at], "wear_depth": wear["depth_max1"][at]}
    if cycles == END:
        names = {"wear_volume_limit": "volume1", "wear_depth_limit": "depth_max1"}
        found |= {name: wear[key][-1] for name, key in names.items()}
        found["normal_force_limit"] = results.history["load_n"][-1]
    return found


def rings(count):
    """The state before the limit by rings, `count` of them in the radius without wear."""
    e_star, d = float(YOUNG) / 2, float(APPROACH)
    a = np.sqrt(float(RADIUS) / 2 * d)

    def slip(r, wear):
        """Slip over mu d. By Jaeger's superposition the shear is mu times the pressure less that of a contact whose
        radius is the stick radius, so that the slip is mu times the gap which that contact has there."""
        rho = np.maximum(r / GAMMA, 1)
        lift = np.arccos(1 / rho) * (rho**2 - 2) / np.pi + np.sqrt(rho**2 - 1) / np.pi
        return np.where(r > GAMMA, GAMMA**2 * lift + wear, 0)

    sphere = Sphere(np.arange(int(1.4 * count)) / count, slip, approach=1.0)
    times = CYCLES * np.linspace(0, 1, count // 2 + 1)
    for time in np.diff(times):
        sphere.step(4 * float(WEAR) * e_star * float(FRICTION) * d / a * time)
    force = e_star * a * d * (sphere.area @ sphere.pressure)
    return {"normal_force": force, "wear_volume": a**2 * d * sphere.volume(), "wear_depth": d * np.max(sphere.wear)}


def limit():
    """Popov's limit: V. L. Popov, Sci. Rep. 4 (2014) 3749, in 30 digits."""
    gamma, d = mp.mpf(GAMMA), mp.mpf(APPROACH)
    a = mp.sqrt(mp.mpf(RADIUS) / 2 * d)

    def depth(rho):
        ratio = gamma / rho
        root = mp.sqrt(rho**2 - gamma**2)
        return (2 / mp.pi) * (rho**2 / 2 * mp.asin(ratio) - gamma / 2 * root + mp.acos(ratio)) - rho**2 / 2

    end = mp.findroot(depth, 1.23)
    top = mp.findroot(lambda rho: mp.diff(depth, rho), 0.7)
    volume = 2 * mp.pi * mp.quad(lambda rho: rho * depth(rho), [gamma, gamma + mp.mpf("0.01"), top, end])
    force = 4 * mp.mpf(YOUNG) / 2 / 3 * a * d * (gamma - gamma**3 / 3) * 3 / 2
    return {"normal_force_limit": force, "wear_volume_limit": a**2 * d * volume, "wear_depth_limit": d * depth(top)}


def evidence():
    units = {"normal_force": "N", "wear_volume": "m3", "wear_depth": "m"}
    finer = [measured(24 * 2**level, 1e-2 / 2**level) for level in range(3)]
    own = [rings(count) for count in (32, 64, 128)]
    with mp.workdps(30):
        how = "closed form (Popov, Sci. Rep. 4 (2014) 3749), mpmath, 30 digits"
        last = [closed(name, units[name[:-6]], value, how) for name, value in limit().items()]
    ways = {
        "rings, 32 to 128 in the radius without wear": own,
        "petsam, 24 to 96 cells, error of jumps 1e-2 to 2.5e-3": finer,
    }
    return all_covered(units, ways) + last


def answers():
    return measured(112, 1e-2, END)


def draw(figure):
    axes = figure.subplots()
    results = solve(64, 1e-2, END)
    row = len(results.y) // 2
    for cycle in (CYCLES, END):
        depth = results.field("wear_depth1", results.of_cycle(cycle))[row, row:]
        axes.plot(results.x[row:] * 1e3, depth * 1e6, label=f"{cycle} cycles")
    axes.set_xlabel("x, mm")
    axes.set_ylabel("removed depth, µm")
    axes.legend(frameon=False)
