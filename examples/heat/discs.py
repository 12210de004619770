"""Temperatures of a twin disc test beside published ones; the creep curve of a wheel whose friction falls with heat.

build/venv/bin/python examples/heat/discs.py [picture]
"""

import sys

import matplotlib.pyplot as plt
import numpy as np

import petsam

# discs of 47 mm, 400 rpm, 10 mm wide, of steel; heat (W), published mean and maximum rise of temperature (K)
SPEED = np.pi * 0.047 * 400 / 60
LOAD = 742.2e3  # N/m, for 1.5 GPa
PUBLISHED = ((25.7, 2.5, 3.7), (102.6, 10.1, 15.1), (246.0, 24.4, 36.7), (728.4, 75.0, 112.5))
DISCS = dict(
    body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3, elasticity="plane",
    gap_type="ellipsoid", gap_radius_x=11.75e-3, gap_radius_y="inf", grid_n=256, grid_size=0.8e-3, load_n=LOAD,
    friction=0.05, rolling="steady", rolling_speed=SPEED, heat="steady", errors="none",
    body1_conductivity=59.6, body2_conductivity=59.6, body1_heat_capacity=4e6, body2_heat_capacity=4e6,
)  # fmt: skip
# rail and wheel at 30 m/s; friction 0.3 when cold, 0.12 from 400 K on
WHEEL = dict(
    body1_young=209.92e9, body1_poisson=0.28, body2_young=209.92e9, body2_poisson=0.28, gap_type="ellipsoid",
    gap_radius_x=0.4926, gap_radius_y=1.1862, grid_n=(80, 45), grid_size=(16e-3, 22.5e-3), load_n=1e5, friction=0.3,
    rolling="steady", rolling_speed=30, heat="steady", errors="none",
    body1_conductivity=50, body2_conductivity=50, body1_heat_capacity=3.5325e6, body2_heat_capacity=3.5325e6,
)  # fmt: skip


def discs():
    """Prints a row for each heat: full slip, whose creepage gives the heat."""
    print("heat, W   mean, K  published   maximum, K  published")
    for heat, mean, most in PUBLISHED:
        run = petsam.run(**DISCS, creep_x=heat / 0.01 / (DISCS["friction"] * LOAD * SPEED))
        there = run["pressure"][-1] > 0
        print(f"{heat:7.1f} {run['temperature_1'][-1][there].mean():9.1f} {mean:10.1f} "
              f"{run['temperature_max'][-1]:12.1f} {most:10.1f}")  # fmt: skip


def curve(**more):
    """Creepages, forces over N and temperatures of the wheel."""
    found = []
    for creepage in (2e-4, 5e-4, 1e-3, 2e-3, 4e-3, 0.01, 0.02, 0.04, 0.08):
        run = petsam.run(**WHEEL, creep_x=creepage, **more)
        found.append((creepage, run["load_tx"][-1] / 1e5, run["temperature_max"][-1]))
    return np.array(found).T


def main():
    discs()
    cold, hot = curve(), curve(friction_temperature=(0, 400, -0.18))
    print("\ncreepage   T/N   with heat   temperature, K")
    for creepage, force, with_heat, temperature in zip(cold[0], cold[1], hot[1], hot[2], strict=True):
        print(f"{creepage:8.4f} {force:7.4f} {with_heat:9.4f} {temperature:12.1f}")
    if len(sys.argv) > 1:
        draw(cold, hot, sys.argv[1])


def draw(cold, hot, name):
    """Draws the creep curves."""
    figure, axes = plt.subplots(figsize=(5.2, 3.2), layout="constrained")
    axes.semilogx(100 * cold[0], cold[1], marker="o", color="#0072b2", label="constant friction")
    axes.semilogx(100 * hot[0], hot[1], marker="s", color="#d55e00", label="friction that falls with temperature")
    axes.set_xlabel("creepage, %")
    axes.set_ylabel("tangential over normal force")
    axes.set_ylim(bottom=0)
    axes.legend(frameon=False, loc="lower right")
    figure.savefig(name, dpi=110)


if __name__ == "__main__":
    main()
