"""A rigid sphere pressed into steel that yields, and let go: petsam, axisymmetric finite elements."""

import numpy as np
from axisymmetric import Body, boussinesq, edge, growing, halved
from common import all_covered, over_places

import petsam

N, RADIUS, YOUNG, POISSON, YIELD, HARDENING = 20.0, 5e-3, 210e9, 0.3, 600e6, 10e9
DEPTH = 50e-6  # of the residual stress
CONTACT = 75e-6  # its radius, about
WIDTH, ELEMENT = 0.3e-3, 12e-6  # of the grid and of the largest elements at the contact
OPTIONS = {
    "body1_young": "inf",
    "body1_poisson": POISSON,
    "body2_young": YOUNG,
    "body2_poisson": POISSON,
    "body2_yield": YIELD,
    "body2_hardening": f"linear:{HARDENING}",
    "gap_type": "sphere",
    "gap_radius1": RADIUS,
    "gap_radius2": "inf",
    "output_fields": "usual,plastic",
}
UNITS = {
    "approach": "m",
    "contact_radius": "m",
    "pressure_max": "Pa",
    "plastic_strain_max": "",
    "dent": "m",
    "residual_stress": "Pa",
}


def solve(grid_n, steps, layers, factor=1.0):
    loads = [*(N * np.arange(1, steps + 1) / steps), 0.0]
    more = {"grid_n": grid_n, "grid_size": factor * WIDTH, "yield_layers": layers}
    return petsam.run({**OPTIONS, **more}, history={"load_n": loads})


def at_axis(field):
    """Value at r = 0 of a field on an even grid, from the first two cells of its middle row: a parabola in r."""
    c = field.shape[-1] // 2
    return field[..., c, c] - 0.25 * (field[..., c, c + 1] - field[..., c, c])


def numbers(results):
    loaded = {name: values[-2] for name, values in results.history.items()}
    stress = np.array([at_axis(plane) for plane in results.field("plastic/residual_stress_xx", -1)])
    return {
        "approach": loaded["disp_z"],
        "contact_radius": np.sqrt(loaded["contact_area"] / np.pi),
        "pressure_max": loaded["pressure_max"],
        "plastic_strain_max": loaded["plastic_max"],
        "dent": at_axis(results.field("residual_z", -1)),
        "residual_stress": np.interp(DEPTH, results.layer_z, stress),
    }


def elements(times, steps, factor=1.0):
    """The same by axisymmetric elements, whose outer nodes move as those of a half-space under a point force."""
    lines = halved(growing(8 * factor * ELEMENT, factor * ELEMENT, 4e-3, 1.25), times)
    body = Body(lines, lines, YOUNG, POISSON, YIELD, HARDENING)
    body.fixed |= np.repeat(np.any(body.nodes == lines[-1], axis=1), 2)
    outer, gap, closed = boussinesq(body.nodes, YOUNG, POISSON), lines**2 / (2.0 * RADIUS), lines < 40e-6
    for load in N * np.arange(1, steps + 1) / steps:
        approach, force, closed = body.press(load, gap, load * outer, closed)
    pressure = body.pressures(force)
    found = {
        "approach": approach,
        "contact_radius": edge(lines, gap + body.u[1::2][body.top] - approach, force),
        "pressure_max": pressure.max(),
    }
    body.press(0.0, gap, 0.0 * outer, closed)
    axis = np.arange(len(lines) - 1) * (
        len(lines) - 1
    )  # elements beside the axis, whose mean stresses are those at their middles
    middles = 0.5 * (lines[1:] + lines[:-1])
    stress = body.stresses[axis, :, 0].mean(axis=1)
    found |= {
        "plastic_strain_max": body.accumulated.mean(axis=1).max(),
        "dent": body.u[1],
        "residual_stress": np.interp(DEPTH, middles, stress),
    }
    return found, {"r": lines, "pressure": pressure, "dent": body.u[1::2][body.top], "z": middles, "stress": stress}


def evidence():
    """petsam and axisymmetric elements, each with cells, layers, elements and load steps twice as fine every time."""

    def ours(k):
        n = 32 * 2**k
        return over_places(lambda f: numbers(solve(n, 8 * 2**k, n // 2, f)), CONTACT * n / WIDTH)

    def others(k):
        return over_places(lambda f: elements(k, 4 * 2**k, f)[0], CONTACT * 2**k / ELEMENT)

    ways = {
        "petsam, 32, 64, 128 cells, 16, 32, 64 layers, 8, 16, 32 load steps, means of four widths": [
            *map(ours, range(3))
        ],
        "axisymmetric elements of 12 to 1.5 um, 4 to 32 load steps, means of four widths": [*map(others, range(4))],
    }
    return all_covered(UNITS, ways)


def answers():
    """The numbers on 64 cells, each with its difference from half as many cells, layers and load steps as its error."""
    coarse, fine = (numbers(solve(n, n // 4, n // 2)) for n in (32, 64))
    return {name: (value, abs(value - coarse[name])) for name, value in fine.items()}


def draw(figure):
    left, right = figure.subplots(1, 2)
    _, fields = elements(1, 8)
    near, deep = fields["r"] < 0.1e-3, fields["z"] < 0.2e-3
    left.plot(1e3 * fields["r"][near], 1e-6 * fields["pressure"][near])
    left.set(
        xlabel="r, mm",
        ylabel="p under 20 N, MPa",
        ylim=(0, None),
        xlim=(0, 0.1),
        xticks=[0, 0.05, 0.1],
        yticks=[0, 500, 1000],
    )
    right.plot(1e-6 * fields["stress"][deep], 1e3 * fields["z"][deep])
    right.set(xlabel=r"$\sigma_{rr}$ after it, r = 0, MPa", ylabel="depth z, mm", ylim=(0.2, 0))
    right.set(xticks=[-200, 0], yticks=[0, 0.1, 0.2])
