"""A sphere that rubs in gross slip and wears by Archard's law: a closed form, petsam, and rings of uniform pressure."""

import functools

import mpmath as mp
import numpy as np
from common import all_covered, closed, over_places
from worn_sphere import Sphere, radius_at

import petsam

YOUNG, POISSON, RADIUS, N = "210e9", "0.3", "0.2", "1000"  # decimal, so that mpmath reads them exactly
WEAR, STROKE = "1e-14", "20e-6"
EARLY, LATE = 10000, 100000  # cycles
CONTACT, WIDTH = 1.14e-3, 4e-3  # radius of the contact after the early ones, about; of the grid
OPTIONS = {
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": POISSON for body in (1, 2)},
    "friction": 1e-6,  # so little that elastic tangential displacements are below 4e-7 of the stroke
    "gap_type": "sphere",
    "gap_radius1": RADIUS,
    "gap_radius2": RADIUS,
    "load_n": N,
    "wear_coefficient1": WEAR,
}
TURNS = [0, 1, 0, -1, 0]  # of the stroke


@functools.lru_cache
def solve(cells, rtol, factor=1.0):
    history = {"disp_x": [turn * float(STROKE) for turn in TURNS]}
    more = {"wear_cycles": LATE, "wear_output": f"0,{EARLY}", "output_every": len(TURNS) - 1, "wear_rtol": rtol}
    return petsam.run(OPTIONS, history=history, grid_n=cells, grid_size=factor * WIDTH, **more)


def measured(cells, rtol=1e-2, factor=1.0):
    """petsam's numbers."""
    wear = solve(cells, rtol, factor).wear
    early = int(np.flatnonzero(wear["cycle"] == EARLY)[0])
    return {
        "wear_volume": wear["volume1"][early],
        "wear_depth": wear["depth_max1"][early],
        "pressure_max": wear["pressure_max"][early],
        "contact_radius": np.sqrt(wear["contact_area"][early] / np.pi),
        "wear_depth_late": wear["depth_max1"][-1],
        "contact_radius_late": np.sqrt(wear["contact_area"][-1] / np.pi),
    }


def hertz():
    """E*, contact radius and approach without wear."""
    e_star = float(YOUNG) / (1 - float(POISSON) ** 2) / 2
    a = (0.75 * float(N) * float(RADIUS) / 2 / e_star) ** (1 / 3)
    return e_star, a, 2 * a**2 / float(RADIUS)


def rings(count, factor=1.0):
    """The same by rings, `count` of them in the radius without wear, and as many steps in time."""
    e_star, a, d = hertz()
    cycle = 4 * float(WEAR) * e_star * float(STROKE) / a  # dw/d0 of a cycle under the pressure E* d0/a0
    sphere = Sphere(factor * np.arange(int(2.6 * count)) / count, lambda r, wear: np.ones_like(r), load=4 / 3)
    times = np.append(EARLY * np.linspace(0, 1, count + 1) ** 2, np.geomspace(EARLY, LATE, count + 1)[1:])
    times = np.append(times, LATE * np.geomspace(1, 1.5, count // 5 + 1)[1:])
    depths, counts, pressures = [0.0], [sphere.count], [0.0]
    for time in np.diff(times):
        sphere.step(cycle * time)
        depths.append(d * np.max(sphere.wear))
        counts.append(sphere.count)
        pressures.append(e_star * d / a * np.max(sphere.pressure))
    found = {"pressure_max": pressures[count]}
    for name, at in ("", count), ("_late", 2 * count):
        found["wear_depth" + name] = depths[at]
        found["contact_radius" + name] = a * radius_at(times, counts, sphere.edges, times[at])
    return found


def evidence():
    finer = [
        over_places(lambda f, n=24 * 2**level: measured(n, 0.24 / n, f), CONTACT * 24 * 2**level / WIDTH)
        for level in range(3)
    ]
    own = [over_places(lambda f, n=n: rings(n, f), n) for n in (25, 50, 100, 200)]
    with mp.workdps(30):
        volume = mp.mpf(WEAR) * mp.mpf(N) * 4 * mp.mpf(STROKE) * EARLY
    units = {"wear_depth": "m", "pressure_max": "Pa", "contact_radius": "m"}
    units |= {"wear_depth_late": "m", "contact_radius_late": "m"}
    ways = {
        "rings, 25 to 200 in the radius without wear, means of four widths": own,
        "petsam, 24 to 96 cells, error of jumps 1e-2 to 2.5e-3, means of four widths": finer,
    }
    how = "closed form: k N times the path, 4 u in a cycle"
    return [closed("wear_volume", "m3", volume, how), *all_covered(units, ways)]


def answers():
    return measured(128)


def draw(figure):
    axes = figure.subplots()
    results = solve(128, 1e-2)
    row = len(results.y) // 2
    for cycle in (0, EARLY, LATE):
        pressure = results.field("pressure", results.of_cycle(cycle))[row, row:]
        axes.plot(results.x[row:] * 1e3, pressure * 1e-6, label=f"{cycle} cycles")
    axes.set_xlabel("x, mm")
    axes.set_ylabel("p, MPa")
    axes.legend(frameon=False)
