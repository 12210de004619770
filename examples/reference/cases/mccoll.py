"""The public benchmark of fretting wear as a mathematical model: petsam, and strips of uniform pressure."""

import functools

import mpmath as mp
import numpy as np
from common import all_covered, closed, over_places

import petsam

YOUNG, POISSON, RADIUS, N = 200e9, 0.3, 6e-3, "18500"  # N per metre
STROKE, CYCLES = "25e-6", 18000
WEAR1, WEAR2 = "1.9e-14", "2.9e-14"
OPTIONS = {
    "elasticity": "plane",
    "plane_datum": RADIUS,
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": POISSON for body in (1, 2)},
    "friction": 1e-4,  # so little that elastic tangential displacements are below 1e-5 of the stroke
    "gap_type": "ellipsoid",
    "gap_radius_x": RADIUS,
    "gap_radius_y": "inf",
    "load_n": N,
    "rot_y": 0,
    "wear_coefficient1": WEAR1,
    "wear_coefficient2": WEAR2,
    "wear_cycles": CYCLES,
    "slide": True,
}
TURNS = np.interp(np.arange(17), [0, 8, 16], [1, -1, 1])
HALF, WIDTH = 2.6e-4, 6.4e-4  # half width of the scar, about; of the grid
SHOWN = 0.01  # part of the depth at which a scar begins


def scars(x, depth1, depth2):
    """The depths of both scars, and the width of the flat's."""
    level = SHOWN * depth2.max()
    inside = np.flatnonzero(depth2 > level)
    first, last = inside[0], inside[-1]
    left = np.interp(level, depth2[first - 1 : first + 1], x[first - 1 : first + 1])
    right = np.interp(-level, -depth2[last : last + 2], x[last : last + 2])
    return {"flat_depth": depth2.max(), "flat_width": right - left, "cylinder_depth": depth1.max()}


@functools.lru_cache
def solve(cells, rtol, factor=1.0):
    more = {"output_every": len(TURNS) - 1, "wear_rtol": rtol, "grid_n": (cells, 1), "grid_size": factor * WIDTH}
    return petsam.run(OPTIONS, history={"disp_x": TURNS * float(STROKE)}, **more)


def measured(cells=320, rtol=0.1, factor=1.0):
    """petsam's numbers."""
    results = solve(cells, rtol, factor)
    found = scars(results.x, *(results.field(f"wear_depth{body}").ravel() for body in (1, 2)))
    return {"flat_area": results.wear["volume2"][-1], **found}


def strips(count, cycles, aside=0.0):
    """The same by strips, `count` of them in the stroke u, and so many cycles, each magnified to a longer time.
    `aside`: how far the middle of the problem is from that of a strip, in strips.

    A step moves by a strip and wears by the pressure at its end, which is found together with the wear."""
    h, e_star = float(STROKE) / count, YOUNG / (1 - POISSON**2) / 2
    half = int(3.3e-4 / h)
    x = (np.arange(-half, half + 1) + aside) * h
    edge = (np.arange(2 * half + 2) - 0.5) * h
    flamant = -2 / (np.pi * e_star) * np.diff(edge * np.log(np.abs(edge)) - edge)  # by a strip at each distance
    matrix = flamant[np.abs(np.subtract.outer(np.arange(len(x)), np.arange(len(x))))]
    worn1, worn2 = np.zeros(len(x)), np.zeros(len(x) + 2 * count)
    touching = np.abs(x) < 1e-4
    way = np.arange(count, -count, -1)
    way = np.append(way[1:], np.append(-count, -way))  # from a turn to the other one and back
    for length in np.diff(CYCLES * np.linspace(0, 1, cycles + 1) ** 2):
        rate1, rate2 = (length * h * float(wear) for wear in (WEAR1, WEAR2))
        for slide in way:
            under = slice(count + slide, count + slide + len(x))
            gap = x**2 / (2 * RADIUS) + worn1 + worn2[under]
            while True:
                part = np.flatnonzero(touching)
                local = matrix[np.ix_(part, part)] + (rate1 + rate2) * np.eye(len(part))
                one, shape = np.linalg.solve(local, np.stack([np.ones(len(part)), gap[part]], axis=1)).T
                depth = (float(N) / h + shape.sum()) / one.sum()
                pressure = np.zeros(len(x))
                pressure[part] = depth * one - shape
                wrong = pressure < 0
                if not wrong.any():
                    wrong = ~touching & (gap + matrix[:, part] @ pressure[part] < depth)
                if not wrong.any():
                    break
                touching = touching ^ wrong
            worn1 += rate1 * pressure
            worn2[under] += rate2 * pressure
    places = (np.arange(-half - count, half + count + 1) + aside) * h
    return scars(places, worn1, worn2)


def evidence():
    finer = [
        over_places(lambda f, n=80 * 2**level: measured(n, 8 / n, f), HALF * 80 * 2**level / WIDTH)
        for level in range(3)
    ]
    # widths of strips divide the stroke: a factor of over_places() moves them by parts of a strip instead
    own = [over_places(lambda f, k=level: strips(3 * 2**k, 20 * 2**k, f - 1), 1) for level in range(3)]
    with mp.workdps(30):
        area = mp.mpf(WEAR2) * mp.mpf(N) * 4 * mp.mpf(STROKE) * CYCLES
    ways = {
        "strips, 3 to 12 in the stroke, means of four places": own,
        "petsam, 80 to 320 cells, error of jumps 0.1 to 0.025, means of four widths": finer,
    }
    units = dict.fromkeys(("flat_depth", "flat_width", "cylinder_depth"), "m")
    how = "closed form: k N times the path, 4 u in a cycle"
    return [closed("flat_area", "m2", area, how), *all_covered(units, ways)]


def answers():
    return measured()


def draw(figure):
    axes = figure.subplots()
    results = solve(320, 0.1)
    for body, name in (2, "flat"), (1, "cylinder"):
        axes.plot(results.x * 1e3, results.field(f"wear_depth{body}").ravel() * 1e6, label=name)
    axes.set_xlim(0, 0.31)
    axes.set_yticks([0, 1, 2])
    axes.set_xlabel("x of the body's own surface, mm")
    axes.set_ylabel("removed depth, µm")
    axes.legend(frameon=False)
