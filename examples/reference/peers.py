#!/usr/bin/env python3
"""Answers of other programs to the cases that they can do, as check.py reads them, with CPU seconds.

    peers.py tamaas|aspher|contact|calculix [CASE ...] [-o answers.json]

tamaas, aspher: the Python that runs this has the package (`make peers` makes build/peers/bin/python, which has both).
contact: --contact, or CONTACT, is the folder of a built CONTACT (see tests/bench/README.md).
calculix: ccx is on the path.

The settings are those that a user of the program would choose: 64 to 512 cells and the program's defaults. Without a
case all of the program's are run. One thread each.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from importlib import metadata
from pathlib import Path

import numpy as np

os.environ.update(OMP_NUM_THREADS="1", MKL_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")


def cpu():
    """CPU seconds of this process and of all that it has started and awaited."""
    return sum(os.times()[:4])


# ---------------------------------------------------------------- what the cases give

E, NU = 210e9, 0.3
STEEL = E / (1 - NU**2) / 2  # E* of two bodies
CROSSED = 1 / ((1 - NU**2) / E + (1 - 0.33**2) / 70e9)  # of hertz-ellipse
# rough-periodic: wave vector over 2 pi/1 mm, amplitude (um), phase
WAVES = ((1, 1, 0.50, 0.3), (2, -1, 0.40, 1.9), (1, -3, 0.30, 4.1), (3, 2, 0.30, 2.6), (4, -3, 0.25, 5.2))
WAVES += ((2, 5, 0.20, 0.9), (6, 1, 0.20, 3.4), (5, -5, 0.15, 6.0), (7, 3, 0.15, 1.2), (3, -8, 0.10, 4.7))
WAVES += ((8, -4, 0.10, 2.2), (9, 6, 0.08, 5.5))
# mindlin-deresiewicz: N and T_x
ROWS = ((1000, 0), (1000, 300), (1400, 400), (800, 150), (1200, -250), (1000, 0))


def centres(n, size):
    """x and y of the centres of n x n cells about the origin; the second index belongs to x."""
    x = ((np.arange(n) + 0.5) / n - 0.5) * size
    return np.meshgrid(x, x)


def sphere(n, size, radius):
    x, y = centres(n, size)
    return (x**2 + y**2) / (2 * radius)


def crossed(n, size):
    """The gap of hertz-ellipse."""
    x, y = centres(n, size)
    angle = np.radians(60)
    return y**2 / (2 * 0.02) + (y * np.cos(angle) - x * np.sin(angle)) ** 2 / (2 * 0.05)


def rough(n):
    x, y = centres(n, 2 * np.pi)
    return sum(1e-6 * a * np.cos(kx * x + ky * y + phase) for kx, ky, a, phase in WAVES)


def wave(n):
    """The gap of westergaard, along x."""
    return 1e-6 * (1 - np.cos(centres(n, 2 * np.pi)[0][0]))


def turning(steps):
    """T_x and T_y of turning-force: so many increments of turning, half as many of loading."""
    angles = np.pi / 2 * np.arange(1, steps + 1) / steps
    loading = [(60 * k / (steps // 2), 0.0) for k in range(1, steps // 2 + 1)]
    return loading + [(60 * np.cos(a), 60 * np.sin(a)) for a in angles]


def rows(steps):
    """N and T_x of mindlin-deresiewicz, with so many steps to each row."""
    path = np.array(((0, 0), *ROWS), float)
    return [tuple(a + (b - a) * k / steps) for a, b in zip(path, path[1:]) for k in range(1, steps + 1)]


# ---------------------------------------------------------------- from fields to numbers


def radius(area):
    return float(np.sqrt(area / np.pi))


def half_space_numbers(p, u, gap, cell):
    """Of two half-spaces, by pressure and displacement."""
    return {
        "pressure_max": p.max(),
        "approach": np.mean((u + gap)[p > 0]),
        "elastic_energy": 0.5 * np.sum(p * u) * cell,
    }


def half_axes(p, area, size):
    """Of an elliptic contact of this area: half axes, and the angle from x to the longer one."""
    x, y = centres(len(p), size)
    second = np.array([[np.sum(p * a * b) for b in (x, y)] for a in (x, y)]) / np.sum(p)
    squares, axes = np.linalg.eigh(second)  # the pressure's second moments have the ratio of the axes
    k = np.sqrt(squares[0] / squares[1])
    return {
        "semi_axis_major": np.sqrt(area / (np.pi * k)),
        "semi_axis_minor": np.sqrt(area * k / np.pi),
        "axis_angle": np.degrees(np.arctan(axes[1, 1] / axes[0, 1])),
    }


def periodic_numbers(solve, gap, load, cell, part=0.02):
    """Of solve(load), which returns pressure, displacement and area: the stiffness is that of loads this part apart."""

    def one(load):
        p, u, area = solve(load)
        return p, u - u.mean(), area, np.mean(gap - np.mean((u + gap)[p > 0])) + u.mean()

    p, u, area, mean = one(load)
    stiffness = 2 * part * load / (one(load * (1 - part))[3] - one(load * (1 + part))[3])
    return {"pressure_max": p.max(), "elastic_energy": 0.5 * np.sum(p * u) * cell}, area, mean, stiffness


def wave_numbers(solve, gap):
    """westergaard: all per unit length along y; cells in rows that are alike are a mean."""
    found, area, mean, stiffness = periodic_numbers(solve, gap, 120e6, 1e-3 / gap.size)
    return {**found, "contact_width": area, "gap_mean": mean, "stiffness": stiffness}


def rough_numbers(solve, gap):
    found, area, mean, stiffness = periodic_numbers(solve, gap, 160.0, 1e-6 / gap.size)
    return {**found, "contact_area": area, "mean_gap": mean, "stiffness_n": stiffness}


# ---------------------------------------------------------------- Tamaas


def tamaas(gap, size, modulus, mean_pressure, periodic=True):
    """Pressure, displacement and the part of the area in contact, by Polonsky's and Keer's conjugate gradients."""
    import tamaas as tm

    tm.set_log_level(tm.LogLevel.error)
    kind = tm.model_type.basic_1d if gap.ndim == 1 else tm.model_type.basic_2d
    model = tm.Model(kind, [size] * gap.ndim, list(gap.shape))
    model.E, model.nu = modulus, 0.0  # E* of the bodies
    solver = tm.PolonskyKeerRey(model, -gap, 1e-10)
    if not periodic:
        tm.ModelFactory.registerNonPeriodic(model, "dcfft")
        solver.setIntegralOperator("dcfft")
    solver.max_iter = 10000
    if not solver.solve(mean_pressure) <= 1e-10:
        raise NotConverged
    if not periodic:  # the solver moves the displacement to the surface; that of periodic ones has the mean 0
        model.operators["dcfft"](model.traction, model.displacement)
    p, u = model.traction.reshape(gap.shape), model.displacement.reshape(gap.shape)
    if gap.ndim == 1:
        return p, u, np.mean(p > 0)
    # Tamaas subtracts a part of the perimeter, along which cells are only partly in contact
    perimeter = sum(cluster.perimeter for cluster in tm.FloodFill.getClusters(p > 0, False))
    return p, u, tm.Statistics2D.contact(p, perimeter)


def tamaas_hertz_sphere(n=512, size=2.6e-3):
    gap = sphere(n, size, 0.1)
    p, u, part = tamaas(gap, size, STEEL, 1000 / size**2, periodic=False)
    return {**half_space_numbers(p, u, gap, (size / n) ** 2), "contact_radius": radius(part * size**2)}


def tamaas_hertz_ellipse(n=256, size=2.2e-3):
    gap = crossed(n, size)
    p, u, part = tamaas(gap, size, CROSSED, 500 / size**2, periodic=False)
    return {**half_space_numbers(p, u, gap, (size / n) ** 2), **half_axes(p, part * size**2, size)}


def tamaas_westergaard(n=512):
    def solve(load):
        p, u, part = tamaas(wave(n), 1e-3, STEEL, load)
        return p, u, part * 1e-3

    return wave_numbers(solve, wave(n))


def tamaas_rough_periodic(n=512):
    import tamaas as tm
    from scipy.sparse.linalg import LinearOperator, cg

    gap = rough(n)

    def solve(load):
        p, u, part = tamaas(gap, 1e-3, STEEL, load / 1e-6)
        return p, u, part * 1e-6

    # a unit displacement along x of the contact, by conjugate gradients with Tamaas' operator
    model = tm.Model(tm.model_type.surface_2d, [1e-3, 1e-3], [n, n])
    model.E, model.nu = E / 2, NU  # of both bodies
    model.be_engine.registerNeumann()
    inside = np.zeros((n, n, 3), bool)
    inside[..., :2] = (solve(160.0)[0] > 0)[..., None]

    def displace(q):
        model.traction[:] = 0
        model.traction[inside] = q
        model.operators["Westergaard::neumann"](model.traction, model.displacement)
        return model.displacement[inside]

    # Tamaas' first axis is the second one of the gap: x is its last component in the plane
    one = np.zeros((n, n, 3))
    one[..., 1] = 1
    count = inside.sum()
    q, failed = cg(LinearOperator((count, count), displace), one[inside], rtol=1e-8)
    if failed:
        raise NotConverged
    return {**rough_numbers(solve, gap), "stiffness_tx": np.sum(q * one[inside]) * 1e-6 / n**2}


# ---------------------------------------------------------------- ASPHER


def aspher(gap, size, modulus, mean_pressure, backend="fft"):
    """Pressure, displacement and the part of the area in contact, on nested grids."""
    from aspher import solve_nested

    r = solve_nested(
        grid_size=len(gap), gap=gap.ravel(), p_nominal=mean_pressure, domain_size=size, E_star=modulus, backend=backend
    )
    if not r.converged:
        raise NotConverged(r.status_reason)
    return r.pressure, r.displacement, r.contact_area


def aspher_hertz_sphere(n=512, size=2.6e-3):
    gap = sphere(n, size, 0.1)
    p, u, part = aspher(gap, size, STEEL, 1000 / size**2)
    return {**half_space_numbers(p, u, gap, (size / n) ** 2), "contact_radius": radius(part * size**2)}


def aspher_hertz_ellipse(n=256, size=2.2e-3):
    gap = crossed(n, size)
    p, u, part = aspher(gap, size, CROSSED, 500 / size**2)
    return {**half_space_numbers(p, u, gap, (size / n) ** 2), **half_axes(p, part * size**2, size)}


def aspher_westergaard(n=512):
    gap = np.tile(wave(n), (n, 1))

    def solve(load):
        p, u, part = aspher(gap, 1e-3, STEEL, load, "periodic")
        return p, u, part * 1e-3

    return wave_numbers(solve, gap)


def aspher_rough_periodic(n=512):
    gap = rough(n)

    def solve(load):
        p, u, part = aspher(gap, 1e-3, STEEL, load / 1e-6, "periodic")
        return p, u, part * 1e-6

    return rough_numbers(solve, gap)


class Friction:
    """ASPHER's solver of a history of loads on a sphere.

    With Poisson's ratio 0.3 its steps take thousands of iterations, more with every step and on finer grids: the
    histories of tangential-sphere and turning-force are left out.
    """

    def __init__(self, n, size, radius, young, poisson, friction):
        from aspher import CoulombFriction, FrictionSolver

        self.size, self.cell = size, (size / n) ** 2
        modulus = young / (1 - poisson**2) / 2
        model = CoulombFriction(friction)
        self.solver = FrictionSolver(grid_size=n, domain_size=size, E_star=modulus, nu=poisson, model=model)
        self.solver.set_gap(sphere(n, size, radius))

    def step(self, n=None, tx=None, ty=0.0):
        given = {} if n is None else {"p_bar": n / self.size**2}
        if tx is not None:
            given["q_bar"] = (tx / self.size**2, ty / self.size**2)
        r = self.solver.step(**given)
        if not r.converged:
            raise NotConverged(r.status_reason)
        return r


def aspher_cattaneo_mindlin():
    solver = Friction(256, 1.8e-3, 0.1, 200e9, 0.0, 0.5)
    solver.step(n=500.0)
    first, second, *loop = (solver.step(tx=t) for t in (150.0, 0.0, -150.0, 150.0))
    return {
        "displacement": first.delta_t[0],
        "displacement_unloaded": second.delta_t[0],
        "stick_radius": radius(first.n_stick * solver.cell),
        "shear_max": np.hypot(first.qx, first.qy).max(),
        "slip_max": np.abs(first.slip_x)[first.state > 0].max(),
        "loop_energy": sum(r.dissipation for r in (second, *loop)),
    }


def aspher_mindlin_deresiewicz(steps=5):
    solver = Friction(64, 2.5e-3, 0.1, 200e9, 0.0, 0.5)
    found = [solver.step(n=n, tx=t) for n, t in rows(steps)]
    at = [found[steps * (k + 1) - 1] for k in range(len(ROWS))]
    return {
        "displacement_growing": at[2].delta_t[0],
        "displacement_falling": at[3].delta_t[0],
        "displacement_end": at[5].delta_t[0],
        "stick_radius": radius(at[4].n_stick * solver.cell),
        "dissipated_energy": sum(r.dissipation for r in found),
    }


# ---------------------------------------------------------------- CONTACT

MM = 1e-3  # CONTACT's lengths are in mm, its stresses in MPa
LONG = 1000.0  # mm: the length along y of a row of cells that stands for plane strain


def shear_modulus(young, poisson):
    """In MPa."""
    return young / (2 * (1 + poisson)) / 1e6


class Contact:
    """Two bodies on mx x my cells in CONTACT, and its results as fields (y, x) in SI units.

    In a shift (T = 1) CONTACT's tractions act on body 1: those of the collection are opposite, and so are the forces.
    In rolling (T = 3) its creepages are opposite, and its tractions are then those of the collection.
    """

    program = None

    def __init__(self, cells, size, curvature, friction, young=(E, E), poisson=(NU, NU)):
        self.cells, self.step = cells, [length / n for n, length in zip(cells, size)]
        self.x, self.y = ((np.arange(n) + 0.5 - n / 2) * h for n, h in zip(cells, self.step))
        self.area = self.step[0] * self.step[1]
        self.friction = friction
        self.materials = (*poisson, *(shear_modulus(e, nu) for e, nu in zip(young, poisson)))
        self.curvature = curvature  # of x^2, x y and y^2 in the gap, 1/m
        self.coupled = young[0] != young[1] or poisson[0] != poisson[1]

    def part(self, tang, force, motion, first, extra):
        """A case of CONTACT's input; each one but the first goes on from the one before."""
        lines = ["3 MODULE", f"{2 if first else 0}0{tang}1{force}0", f"02202{9 * extra}" if first else "000000"]
        lines += [f"00{0 if first else 1}1101", f"999 100 30 {20 if self.coupled else 1} 1e-6"]
        lines += [" ".join(repr(float(value)) for value in motion), f"{self.friction} {self.friction}"]
        if first:
            dx, dy = (h / MM for h in self.step)
            mx, my = self.cells
            lines += [f"0d {dx!r} 1000.0"] if tang == 3 else []
            lines += [
                " ".join(map(repr, self.materials)),
                "1",
                f"{mx} {my} {-mx * dx / 2!r} {-my * dy / 2!r} {dx!r} {dy!r}",
            ]
            lines += [
                "1 1",
                " ".join(repr(float(b * MM)) for b in (self.curvature[0], *self.curvature[1:], 0.0, 0.0, 0.0)),
            ]
        return lines

    def run(self, tang, force, motions, extra=None):
        """Of each case its fields: state (1 stick, 2 slip), gap, mu, p, q_x, q_y, u_z, u_x, u_y and slip."""
        lines = []
        for k, motion in enumerate(motions):
            lines += self.part(tang, force, motion, k == 0, extra is not None)
            lines += [] if extra is None else [f"{float(value / MM)!r} 0.0" for value in extra]
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "case.inp").write_text("\n".join([*lines, "0 MODULE"]) + "\n")
            done = subprocess.run([self.program, "2", "case"], cwd=folder, capture_output=True, text=True)
            if "ended succesfully" not in done.stdout:
                sys.exit(f"peers.py: {self.program}: {done.stdout[-500:]}")
            return [self.fields(path) for path in sorted(Path(folder).glob("case.*.mat"))]

    def fields(self, path):
        table = np.loadtxt([line for line in path.read_text().splitlines()[14:] if line[0] != "%"], ndmin=2)
        fields = np.zeros((10, self.cells[0] * self.cells[1]))
        fields[:, table[:, 0].astype(int) - 1] = table[:, 1:11].T
        names = ("state", "gap", "mu", "p", "qx", "qy", "uz", "ux", "uy", "slip")
        units = (1, MM, 1, 1e6, 1e6, 1e6, MM, MM, MM, MM)
        found = {name: f.reshape(self.cells[::-1]) * unit for name, f, unit in zip(names, fields, units)}
        found["q"] = np.hypot(found["qx"], found["qy"])
        return found

    def dissipated(self, fields):
        return np.sum(fields["q"] * fields["slip"]) * self.area

    def contact_area(self, fields):
        return np.sum(fields["state"] > 0) * self.area

    def stick_area(self, fields):
        return np.sum(fields["state"] == 1) * self.area

    def shift(self, fields, name="ux"):
        """The displacement of body 1, as the middle has never slipped."""
        return -fields[name][self.cells[1] // 2, self.cells[0] // 2]


def on_sphere(n, size, radius, friction, **bodies):
    return Contact((n, n), (size, size), (0.5 / radius, 0.0, 0.5 / radius), friction, **bodies)


def approach(fields):
    return np.mean((fields["gap"] + fields["uz"])[fields["state"] > 0])


def normal_contact(bodies, load):
    (f,) = bodies.run(0, 0, [(load, 0.0, 0.0, 0.0)])
    found = half_space_numbers(f["p"], f["uz"], f["gap"], bodies.area)
    return f["p"], found, bodies.contact_area(f)


def contact_hertz_sphere():
    _, found, area = normal_contact(on_sphere(256, 2.2e-3, 0.1, 0.3), 1000.0)
    return {**found, "contact_radius": radius(area)}


def contact_hertz_ellipse(n=256, size=2.2e-3):
    c, s = np.cos(np.pi / 3), np.sin(np.pi / 3)
    curvature = (10 * s * s, -20 * s * c, 25 + 10 * c * c)
    bodies = Contact((n, n), (size, size), curvature, 0.3, young=(E, 70e9), poisson=(NU, 0.33))
    p, found, area = normal_contact(bodies, 500.0)
    return {**found, **half_axes(p, area, size)}


def contact_cattaneo_mindlin():
    bodies = on_sphere(256, 1.8e-3, 0.1, 0.5, young=(200e9, 200e9), poisson=(0.0, 0.0))
    steps = bodies.run(1, 1, [(500.0, -t / 250.0, 0.0, 0.0) for t in (150.0, 0.0, -150.0, 150.0)])
    return {
        "displacement": bodies.shift(steps[0]),
        "displacement_unloaded": bodies.shift(steps[1]),
        "stick_radius": radius(bodies.stick_area(steps[0])),
        "shear_max": steps[0]["q"].max(),
        "slip_max": steps[0]["slip"].max(),
        "loop_energy": sum(map(bodies.dissipated, steps[1:])),
    }


def contact_tangential_sphere(steps=64):
    bodies = on_sphere(128, 1.9e-3, 0.1, 0.1)
    found = bodies.run(1, 2, [(1000.0, -0.6 * k / steps, 0.0, 0.0) for k in range(1, steps + 1)])
    last = found[-1]
    return {
        "displacement": bodies.shift(last),
        "stick_area": bodies.stick_area(last),
        "shear_y_max": np.abs(last["qy"]).max(),
        "shear_y_integral": np.abs(last["qy"]).sum() * bodies.area,
        "dissipated_energy": sum(map(bodies.dissipated, found)),
    }


def contact_turning_force(steps=64):
    bodies = on_sphere(128, 1.9e-3, 0.1, 0.1)
    found = bodies.run(1, 2, [(1000.0, -tx / 100, -ty / 100, 0.0) for tx, ty in turning(steps)])
    return {
        "displacement_x": bodies.shift(found[-1]),
        "displacement_y": bodies.shift(found[-1], "uy"),
        "energy_loading": sum(map(bodies.dissipated, found[:-steps])),
        "energy_turning": sum(map(bodies.dissipated, found[-steps:])),
    }


def contact_mindlin_deresiewicz(steps=20):
    bodies = on_sphere(128, 2.5e-3, 0.1, 0.5, young=(200e9, 200e9), poisson=(0.0, 0.0))
    found = bodies.run(1, 1, [(n, -t / (0.5 * n), 0.0, 0.0) for n, t in rows(steps)])
    at = [found[steps * (k + 1) - 1] for k in range(len(ROWS))]
    return {
        "displacement_growing": bodies.shift(at[2]),
        "displacement_falling": bodies.shift(at[3]),
        "displacement_end": bodies.shift(at[5]),
        "stick_radius": radius(bodies.stick_area(at[4])),
        "dissipated_energy": sum(map(bodies.dissipated, found)),
    }


def contact_spence(steps=80):
    bodies = on_sphere(96, 1.8e-3, 0.1, 0.15, young=(E, 1e6 * E), poisson=(NU, 0.0))
    found = bodies.run(1, 0, [(1000.0 * (k / steps) ** 3, 0.0, 0.0, 0.0) for k in range(1, steps + 1)])
    last = found[-1]
    return {
        "contact_radius": radius(bodies.contact_area(last)),
        "stick_radius": radius(bodies.stick_area(last)),
        "approach": approach(last),
        "shear_max": last["q"].max(),
        "dissipated_energy": sum(map(bodies.dissipated, found)),
    }


def contact_dissimilar_unloading(steps=40):
    bodies = on_sphere(128, 7.4e-4, 0.01, 0.15, young=(E, 3e9), poisson=(NU, 0.35))
    up = 20 * (np.arange(1, steps + 1) / steps) ** 3
    down = np.linspace(20, 10, steps // 2 + 1)[1:]
    found = bodies.run(1, 0, [(n, 0.0, 0.0, 0.0) for n in (*up, *down)])
    last, r = found[-1], np.hypot(bodies.x, bodies.y[:, None])
    q = -(last["qx"] * bodies.x + last["qy"] * bodies.y[:, None]) / r  # radial
    edge = radius(bodies.contact_area(last))
    near = (last["q"] < 0.075 * last["p"]) & (r > 0.8 * edge)
    return {
        "approach": approach(last),
        "contact_radius": edge,
        "shear_max": last["q"].max(),
        "reversal_radius": np.polyfit(q[near] * 1e-6, r[near], 2)[-1],  # where the radial shear is 0
        "half_force": -np.sum(last["qx"][:, bodies.x > 0]) * bodies.area,
        "dissipated_unloading": sum(map(bodies.dissipated, found[steps:])),
    }


def plane(n, size, radius, friction, **bodies):
    return Contact((n, 1), (size, LONG * MM), (0.5 / radius, 0.0, 0.0), friction, **bodies)


def contact_carter():
    bodies = plane(512, 2.4e-3, 0.2, 0.3)
    (f,) = bodies.run(3, 0, [(4e5 * LONG * MM, -5e-4, 0.0, 0.0)])
    return {
        "tangential_force": np.sum(f["qx"]) * bodies.step[0],
        "stick_width": np.sum(f["state"] == 1) * bodies.step[0],
        "shear_max": f["q"].max(),
        "slip_velocity_max": f["slip"].max() / MM,
        "friction_work": np.sum(f["q"] * f["slip"]) / MM * bodies.step[0],
    }


def contact_rolling_spin():
    bodies = on_sphere(128, 3.4e-4, 0.01, 0.3, poisson=(0.28, 0.28))
    xi, eta, spin = 2e-3, 1e-3, 15.0
    (f,) = bodies.run(3, 0, [(50.0, -xi, -eta, -spin * MM)])
    tx, ty = (np.sum(f[name]) * bodies.area for name in ("qx", "qy"))
    mz = np.sum(bodies.x * f["qy"] - bodies.y[:, None] * f["qx"]) * bodies.area
    return {
        "load_tx": tx,
        "load_ty": ty,
        "load_mz": mz,
        "stick_area": bodies.stick_area(f),
        "power_per_speed": xi * tx + eta * ty + spin * mz,
    }


def contact_pad_bulk_stress():
    bodies = plane(512, 1.2e-3, 0.05, 0.5, young=(115e9, 115e9), poisson=(0.32, 0.32))
    stretch = (1 - 0.32**2) * 200e6 / 115e9 * bodies.x  # of body 2
    (f,) = bodies.run(1, 1, [(2e5 * LONG * MM, -0.4, 0.0, 0.0)], extra=-stretch)
    q, stuck = -f["qx"][0], np.flatnonzero(f["state"][0] == 1)
    slip = f["slip"][0, f["state"][0] > 0]
    half = bodies.step[0] / 2
    return {
        "stick_left": bodies.x[stuck[0]] - half,
        "stick_right": bodies.x[stuck[-1]] + half,
        "shear_max": q.max(),
        "shear_centre": np.interp(0, bodies.x, q),
        "slip_left": 1.5 * slip[0] - 0.5 * slip[1],  # at the end of the contact, half a cell further
        "dissipated_energy": np.sum(f["q"] * f["slip"]) * bodies.step[0],
    }


# ---------------------------------------------------------------- CalculiX


def calculix_hertz_sphere(n=8):
    """The model of examples/fe-comparison: a sphere on its plane of symmetry.

    Its flat top moves down by Hertz's approach, which needs a force that is a little different from N: radius and
    pressure are those at N by similarity. The approach of a half-space is not that of the top.
    """
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "fe-comparison"))
    import calculix_dent

    import model
    from surface import read_surface

    study = model.Study()
    with tempfile.TemporaryDirectory() as folder:
        base = str(Path(folder, "case"))
        mesh = model.normal_deck(base + ".inp", n, study, study.contact_radius**2 / study.radius)
        calculix_dent.run(folder)
        surface = read_surface(base, mesh, model.rim(mesh)[0], 4)
    scale = (1000 / surface.load_n) ** (1 / 3)
    return {"contact_radius": scale * surface.contact_radius(1 / 4), "pressure_max": scale * surface.pressure.max()}


def calculix_indentation():
    """Axisymmetric elements of 3 um in the contact."""
    import calculix_dent

    return calculix_dent.answers()


# ---------------------------------------------------------------- the command


class NotConverged(Exception):
    """The program says that it has no solution."""


def names(program):
    """The cases that a program can do: its functions."""
    return [name[len(program) + 1 :].replace("_", "-") for name in globals() if name.startswith(program + "_")]


def version(program, folder):
    """The program's name and version; ends with a message where it is not installed."""
    if program == "calculix":
        if not shutil.which("ccx"):
            sys.exit("peers.py: no CalculiX: there is no ccx on the path")
        said = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout
        return f"CalculiX {said.split()[-1]}"
    if program == "contact":
        Contact.program = Path(folder, "bin", "contact_linux64").resolve()
        if not folder or not Contact.program.is_file():
            sys.exit("peers.py: no CONTACT: give --contact, the folder that has bin/contact_linux64")
        revision = re.search(rb"Revision: (\d+) ", Contact.program.read_bytes())
        return f"CONTACT r{revision.group(1).decode()}"
    try:
        return f"{program} {metadata.version(program)}"
    except metadata.PackageNotFoundError:
        sys.exit(f"peers.py: {sys.executable} has no {program}: see `make peers`")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", choices=("tamaas", "aspher", "contact", "calculix"))
    parser.add_argument("case", nargs="*", help="all that the program can do without one")
    parser.add_argument("-o", "--output", type=Path, help="build/run/PROGRAM.json without it")
    parser.add_argument("--contact", default=os.environ.get("CONTACT", ""), help="folder of a built CONTACT")
    args = parser.parse_intermixed_args()
    able = names(args.program)
    unknown = [name for name in args.case if name not in able]
    if unknown:
        parser.error(f"{args.program} does not do {unknown[0]}; it does {', '.join(able)}")
    program = version(args.program, args.contact)
    output = args.output or Path(f"build/run/{args.program}.json")
    answers, seconds = {}, {}
    for name in args.case or able:
        start = cpu()
        try:
            given = globals()[f"{args.program}_{name.replace('-', '_')}"]()
        except NotConverged as why:
            print(f"{name}: no answer: it did not converge {why}", flush=True)
            continue
        seconds[name] = round(cpu() - start, 2)
        answers[name] = {quantity: float(value) for quantity, value in given.items()}
        print(f"{name}: {seconds[name]:.2f} s of CPU", flush=True)
        output.parent.mkdir(parents=True, exist_ok=True)
        text = json.dumps({"program": program, "answers": answers, "seconds": seconds}, indent=1)
        output.write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
