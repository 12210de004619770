#!/usr/bin/env python3
"""A sphere rolls over a rough plane in time steps, at constant load and creepage: tangential force and approach.

    build/venv/bin/python examples/rolling/rough.py [--cells 64] [--out build/rolling]

petsam's gap stays with the grid, which moves with the contact. The roughness belongs to the plane, so the gap is given
anew in each step, one column further; petsam moves the slip. Three planes: smooth and with two amplitudes of the same
noise. As a check grooves along x, whose gap does not change: the time steps must end in the state of -rolling steady,
as those of the smooth plane must. Prints the forces and writes rough.png.
"""

import argparse
import os
import sys
from pathlib import Path

import numpy as np

import petsam
from petsam.plot.style import CLOSED, COLORS, DAMAGE, STYLE, bar, extent, field, frame, plt, save

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
from comparison import print_table  # noqa: E402

G, NU, MU, P0, A = 82e9, 0.28, 0.3, 800e6, 1e-3  # Pa; 1; 1; Hertz's peak pressure, Pa, and half width, m
LOAD = 2 / 3 * np.pi * P0 * A**2
RADIUS = 2 * A * G / (1 - NU) / (np.pi * P0)
CREEPAGES = dict(creep_x=0.3 * MU * P0 / G, creep_y=0.0, creep_spin=0.0)
WIDTH, TRAVEL, STEADY = 3 * A, 12 * A, 6 * A  # of the grid; rolled; after which the start is forgotten, m
RMS = (0.3e-6, 1e-6)  # m
WAVES = (8, 32)  # shortest and longest, cells
SEED = 1


def noise(shape):
    """Heights (ny, nx) of isotropic noise within WAVES, of root mean square 1; the longest waves are the highest."""
    k = np.hypot(*np.meshgrid(np.fft.fftfreq(shape[1]), np.fft.fftfreq(shape[0])))
    inside = (k >= 1 / WAVES[1]) & (k <= 1 / WAVES[0])
    waves = np.fft.fft2(np.random.default_rng(SEED).standard_normal(shape))
    heights = np.fft.ifft2(np.where(inside, waves / np.maximum(k, 1 / WAVES[1]) ** 1.8, 0.0)).real
    return heights / heights.std()


def contact(cells, **options):
    """A contact of similar bodies without a shape, and the gap of the sphere."""
    body = dict(body1_young=2 * G * (1 + NU), body2_young=2 * G * (1 + NU), body1_poisson=NU, body2_poisson=NU)
    made = petsam.Contact(grid_n=cells, grid_size=WIDTH, friction=MU, gap_type="flat", **body, **options)
    return made, (made.x**2 + made.y[:, None] ** 2) / (2 * RADIUS)


class Rolled:
    """Time steps of one cell over a plane: distance (m), force over mu N, approach (m) and area (m2) of each."""

    def __init__(self, cells, heights):
        made, sphere = contact(cells)
        dx, rows = WIDTH / cells, []
        with made:
            for k in range(round(TRAVEL / dx) + 1):
                made.gap = sphere - heights[:, k : k + cells]
                step = made.try_step(roll=dx, load_n=LOAD, **CREEPAGES) if k else made.try_step(load_n=LOAD)
                made.commit()
                rows.append((k * dx, step.load_tx / (MU * LOAD), step.disp_z, step.contact_area))
            self.shear, self.x, self.y = made.field("shear_x"), made.x, made.y
        self.distance, self.force, self.approach, self.area = np.array(rows).T
        self.late = self.distance > STEADY


def steady(cells, heights):
    """The force over mu N of steady rolling on a gap that moves with the contact."""
    made, sphere = contact(cells, rolling="steady")
    with made:
        made.gap = sphere - heights[:, :cells]
        return made.try_step(load_n=LOAD, **CREEPAGES).load_tx / (MU * LOAD)


def name(rms):
    return f"rms {1e6 * rms:g} um" if rms else "smooth"


def row(rms, rolled):
    force, approach = rolled.force[rolled.late], rolled.approach[rolled.late]
    return dict(
        plane=name(rms), mean=force.mean(), deviation=force.std(), least=force.min(), most=force.max(),
        approach=1e6 * approach.mean(), moves=1e6 * approach.std(),
        area=rolled.area[rolled.late].mean() / (np.pi * A**2),
    )  # fmt: skip


def draw(planes, limit, directory):
    figure, axes = plt.subplots(1, 3, figsize=(10.0, 3.1), constrained_layout=True)
    for (rms, rolled), color in zip(planes.items(), COLORS):
        text = name(rms).replace("um", "µm")
        axes[0].plot(rolled.distance / A, rolled.force, color=color, linewidth=1.2, label=text)
        axes[1].plot(rolled.distance / A, 1e6 * rolled.approach, color=color, linewidth=1.2)
    axes[0].axhline(limit, linestyle="--", label="smooth, steady", **CLOSED)
    axes[0].legend(loc="lower right")
    frame(axes[0], "Tangential force", "rolled distance / $a$", r"$T_x/(\mu N)$", (0.0, TRAVEL / A), (0.0, 0.55))
    frame(axes[1], "Approach", "rolled distance / $a$", "$d_z$, µm", (0.0, TRAVEL / A))
    last = planes[RMS[-1]]
    image = field(axes[2], 1e-6 * last.shear, extent(last.x, last.y, A), color_map=DAMAGE)
    axes[2].set(title=f"Shear at the end, {name(RMS[-1])}".replace("um", "µm"), xlabel="$x/a$", ylabel="$y/a$")
    bar(axes[2], image, "$q_x$, MPa")
    save(figure, directory, "rough.png")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, default=64)
    parser.add_argument("--out", default="build/rolling")
    args = parser.parse_args()
    long = args.cells + round(TRAVEL / WIDTH * args.cells)
    rough = noise((args.cells, long))
    planes = {rms: Rolled(args.cells, rms * rough) for rms in (0.0, *RMS)}
    print_table(
        f"From {STEADY / A:g} to {TRAVEL / A:g} a: T_x/(mu N), approach (um), area/(pi a^2)",
        "plane = plane; mean = mean:.3f; deviation = deviation:.4f; least = least:.3f; most = most:.3f; "
        "d_z = approach:.2f; deviation = moves:.3f; area = area:.3f",
        [row(*pair) for pair in planes.items()],
    )
    grooves = RMS[-1] * np.broadcast_to(rough[:, :1], rough.shape)
    limits = [steady(args.cells, heights) for heights in (0.0 * rough, grooves)]
    for what, rolled, limit in zip(("smooth", "grooves along x"), (planes[0.0], Rolled(args.cells, grooves)), limits):
        print(f"{what}: last time step {rolled.force[-1]:.4f}, steady {limit:.4f}")
    os.makedirs(args.out, exist_ok=True)
    with plt.rc_context(STYLE):
        draw(planes, limits[0], args.out)


if __name__ == "__main__":
    main()
