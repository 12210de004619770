"""Two spheres under N, then T_x, with nu = 0.3: the exact solution of Coulomb's law, not Cattaneo's and Mindlin's."""

import halfspace
import numpy as np
import steps
from common import all_covered

import petsam

N, FRICTION, FORCE, RADIUS, YOUNG, POISSON = 1000.0, 0.1, 60.0, 0.2, 210e9, 0.3
E_STAR = YOUNG / (1 - POISSON**2) / 2
CONTACT = np.cbrt(3 * N * RADIUS / 2 / (4 * E_STAR))  # Hertz's radius
OPTIONS = {
    "grid_size": 2.2 * CONTACT,
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": POISSON for body in (1, 2)},
    "friction": FRICTION,
    "gap_type": "sphere",
    "gap_radius1": RADIUS,
    "gap_radius2": RADIUS,
    "load_n": N,
    "history": {"time": [0, 1], "load_tx": [0, FORCE]},
    "output_every": 1000,
}
UNITS = {
    "displacement": "m",
    "stick_area": "m2",
    "shear_y_max": "Pa",
    "shear_y_integral": "N",
    "dissipated_energy": "J",
}


def numbers(results):
    history, shear = results.history, np.abs(results["shear_y"][-1])
    area = (results.x[1] - results.x[0]) * (results.y[1] - results.y[0])
    return {
        "displacement": history["disp_x"][-1],
        "stick_area": history["stick_area"][-1],
        "shear_y_max": shear.max(),
        "shear_y_integral": shear.sum() * area,
        "dissipated_energy": np.nansum(history["dissipated_energy"]),
    }


def own(cells, count):
    """The same by halfspace.py, with Hertz's pressure."""
    shear = halfspace.sphere(cells, CONTACT, N, FRICTION, YOUNG, POISSON)
    energy = sum(shear.step([FORCE * (k + 1) / count, 0.0]) for k in range(count))
    return {
        "displacement": shear.rigid[0],
        "stick_area": shear.smooth_stick_area((0, 2, 4), 0.5),
        "shear_y_max": np.abs(shear.q[1]).max(),
        "shear_y_integral": np.abs(shear.q[1]).sum() * shear.grid.area,
        "dissipated_energy": energy,
    }


def evidence():
    one = [steps.limits(lambda m, n=n: numbers(petsam.run(OPTIONS, grid_n=n, steps=m))) for n in (64, 128, 256)]
    two = [steps.limits(lambda m, n=n: own(n, m)) for n in (32, 64, 128)]
    return all_covered(UNITS, steps.ways(one, two))


def answers():
    return numbers(petsam.run(OPTIONS, grid_n=128, steps=256))


def draw(figure):
    results = petsam.run(OPTIONS, grid_n=96, steps=16)
    left, right = figure.subplots(1, 2, width_ratios=(1.15, 1))
    x, y = results.x * 1e3, results.y * 1e3
    shear, state = results["shear_y"][-1] * 1e-6, results["state"][-1]
    most = np.abs(shear).max()
    shown = np.where(state > 0, shear, np.nan)
    image = left.contourf(x, y, shown, np.linspace(-most, most, 12), cmap="RdBu_r")
    left.contour(x, y, state == 1, [0.5], colors="0.2", linewidths=0.8)
    figure.colorbar(image, ax=left, label="$q_y$, MPa", format="%.1f")
    left.set(xlabel="x, mm", ylabel="y, mm", aspect="equal")
    middle = len(y) // 2
    right.plot(x, results["shear_x"][-1][middle] * 1e-6, label="$q_x$")
    right.plot(x, FRICTION * results["pressure"][-1][middle] * 1e-6, "--", color="0.5", label=r"$\mu p$")
    right.set(xlabel="x, mm", ylabel="on y = 0, MPa")
    right.legend()
