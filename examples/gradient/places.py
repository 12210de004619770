"""Derivatives by the mean over several positions of the grid within a cell, and that of a stiffness."""

import numpy as np

import petsam


def sphere(x, y, radius):
    """Returns the gap of a sphere on a flat."""
    return (x**2 + y**2) / (2 * radius)


steel = dict(
    body1="steel", body2="steel", gap_type="flat", grid_n=64, grid_size="2.6mm", normal_rtol=1e-9, errors="none"
)
tangential = 60 * np.array([0, 0.25, 0.5, 0.75, 1, 0.5, 0, -0.5, -1, -0.5, 0, 0.5, 1])
pull = {"time": np.arange(13), "load_n": np.full(13, 1000), "load_tx": tangential}
for count in (1, 8):
    places = petsam.gradient.positions(steel, count)
    loops = [petsam.gradient.function(place, pull, ("energy", slice(5, 13)), [sphere, "friction"]) for place in places]
    work, slopes = petsam.gradient.mean(loops)([0.1, 0.1])
    print(f"{count}: by the radius {0.1 * slopes[0] / work:.2f}, by friction {0.1 * slopes[1] / work:.2f}")

press = {"time": np.arange(3), "load_n": [1000, 900, 1100]}
points = [("disp_z", slice(1, 2)), ("disp_z", slice(2, 3))]
presses = [petsam.gradient.function(place, press, points, [sphere]) for place in places]
way, slopes = petsam.gradient.mean(presses)([0.1])
change, by_radius = way[1] - way[0], slopes[1, 0] - slopes[0, 0]
print(f"{200 / change:.3e} N/m, by the radius {-0.1 * by_radius / change:.3f}")
