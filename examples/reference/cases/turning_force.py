"""Two spheres under N, then T_x, and then the force turns in its plane by 90 degrees at constant size."""

import halfspace
import numpy as np
import steps
from common import all_covered
from tangential_sphere import CONTACT, FORCE, FRICTION, OPTIONS, POISSON, YOUNG, N

import petsam

UNITS = {"displacement_x": "m", "displacement_y": "m", "energy_loading": "J", "energy_turning": "J"}


def path(count):
    """T_x and T_y after each of count/2 steps of loading and count steps of turning."""
    grown = [(FORCE * (k + 1) / (count // 2), 0.0) for k in range(count // 2)]
    angles = np.pi / 2 * (np.arange(count) + 1) / count
    return np.array(grown + [(FORCE * np.cos(angle), FORCE * np.sin(angle)) for angle in angles])


def solve(cells, count):
    loads = np.vstack([[0, 0], path(count)])
    history = {"time": np.arange(len(loads)), "load_tx": loads[:, 0], "load_ty": loads[:, 1]}
    return petsam.run({**OPTIONS, "grid_n": cells, "history": history})


def numbers(results):
    history, loading = results.history, len(results.history["time"]) // 3
    energy = np.nan_to_num(history["dissipated_energy"])
    return {
        "displacement_x": history["disp_x"][-1],
        "displacement_y": history["disp_y"][-1],
        "energy_loading": energy[: 1 + loading].sum(),
        "energy_turning": energy[1 + loading :].sum(),
    }


def own(cells, count):
    """The same by halfspace.py, with Hertz's pressure."""
    shear = halfspace.sphere(cells, CONTACT, N, FRICTION, YOUNG, POISSON)
    energy = [shear.step(load) for load in path(count)]
    return {
        "displacement_x": shear.rigid[0],
        "displacement_y": shear.rigid[1],
        "energy_loading": sum(energy[: count // 2]),
        "energy_turning": sum(energy[count // 2 :]),
    }


def evidence():
    one = [steps.limits(lambda m, n=n: numbers(solve(n, m))) for n in (64, 128, 256)]
    two = [steps.limits(lambda m, n=n: own(n, m)) for n in (24, 48, 96)]
    return all_covered(UNITS, steps.ways(one, two, "24, 48, 96"))


def answers():
    return numbers(solve(128, 32))


def draw(figure):
    results = solve(96, 16)
    history = results.history
    left, right = figure.subplots(1, 2, width_ratios=(1, 1.1))
    left.plot(history["disp_x"] * 1e6, history["disp_y"] * 1e6, ".-")
    left.set(xlabel="$d_x$, µm", ylabel="$d_y$, µm", aspect="equal")
    x, y = results.x * 1e3, results.y * 1e3
    shear = np.hypot(results["shear_x"][-1], results["shear_y"][-1]) * 1e-6
    state = results["state"][-1]
    image = right.contourf(x, y, np.where(state > 0, shear, np.nan), 8)
    every = slice(4, None, 10)
    right.quiver(
        x[every], y[every], results["shear_x"][-1][every, every], results["shear_y"][-1][every, every], color="white"
    )
    right.contour(x, y, state == 1, [0.5], colors="k", linewidths=0.8)
    figure.colorbar(image, ax=right, label="|q|, MPa")
    right.set(xlabel="x, mm", ylabel="y, mm", aspect="equal")
