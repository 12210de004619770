"""Temperatures of a fretting contact over the frequency: means and flashes by one run, beside a closed-form solution.

build/venv/bin/python examples/heat/pad.py [picture]
"""

import sys

import matplotlib.pyplot as plt
import numpy as np

import petsam

STROKE = 20e-6  # m, from the middle
LOAD, FRICTION, BODIES = 500.0, 0.6, ("steel", "Ti-6Al-4V")
BALL = dict(
    body1=BODIES[0], body2=BODIES[1], gap_type="sphere", gap_radius1=50e-3, gap_radius2="inf", grid_n=64,
    grid_size=1.5e-3, friction=FRICTION, errors="none",
)  # fmt: skip
WAYS = np.array([0, 1, 0, -1, 0, 1, 0, -1, 0, 1])  # of the stroke; with 16 steps from each to the next
FREQUENCIES = (1, 10, 30, 100, 300, 1000)


def strokes():
    """The work of the second cycle, and the half width of the contact."""
    history = {"time": np.arange(len(WAYS)), "load_n": np.full(len(WAYS), LOAD), "disp_x": STROKE * WAYS}
    with petsam.run(**BALL, history=history, steps=16) as results:
        area = results.series("contact_area")[-1]
        return petsam.heat.work(results), np.sqrt(area / np.pi)


def main():
    work, half = strokes()
    conductivity = sum(petsam.materials.find(name).conductivity for name in BODIES)
    print(f"work of a cycle {1e3 * work.energy:.2f} mJ, half width {1e3 * half:.3f} mm")
    print("frequency, Hz  power, W  mean, K  closed form  flash, K  share of Ti-6Al-4V")
    found = []
    for frequency in FREQUENCIES:
        hot = work.temperatures(BODIES, frequency)
        closed = 3 * hot.power / (8 * half * conductivity)
        found.append(hot)
        print(f"{frequency:13d} {hot.power:9.4g} {hot.mean_maximum:8.3g} {closed:12.3g} {hot.flash_maximum:9.2g} "
              f"{hot.share_2:19.4f}")  # fmt: skip
    if len(sys.argv) > 1:
        draw(work, found, sys.argv[1])


def draw(work, found, name):
    """Draws mean and flash over the frequency, and the temperature of the centre over a cycle."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.4, 3.2), layout="constrained")
    left.loglog(
        FREQUENCIES, [hot.mean_maximum for hot in found], marker="o", color="#0072b2", label="mean over the cycle"
    )
    left.loglog(FREQUENCIES, [hot.flash_maximum for hot in found], marker="s", color="#d55e00", label="flash above it")
    left.set_xlabel("frequency, Hz")
    left.set_ylabel("temperature in the contact, K")
    left.legend(frameon=False)
    row, column = (int(np.argmin(np.abs(axis))) for axis in (work.y, work.x))
    for frequency, hot, color in zip(FREQUENCIES[1::2], found[1::2], ("#009e73", "#0072b2", "#d55e00")):
        centre = hot.surface[0, :, row, column]
        part = np.concatenate((hot.times, hot.times + hot.times[-1] + hot.times[0])) * frequency
        right.plot(part, np.tile(centre, 2) / centre.mean(), color=color, label=f"{frequency} Hz")
    right.set_xlabel("cycles, from a load reversal")
    right.set_ylabel("centre's temperature over its mean")
    right.legend(frameon=False)
    figure.savefig(name, dpi=110)


if __name__ == "__main__":
    main()
