"""Rolling cylinders with creepage: Carter."""

import mpmath as mp
from common import closed

import petsam

N, RADIUS, YOUNG, POISSON, FRICTION, CREEPAGE = "4e5", "0.2", "210e9", "0.3", "0.3", "5e-4"
OPTIONS = {
    "elasticity": "plane",
    "rolling": "steady",
    "grid_n": 512,
    "grid_size": 2.4e-3,
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": POISSON for body in (1, 2)},
    "gap_type": "ellipsoid",
    "gap_radius_x": RADIUS,
    "gap_radius_y": "inf",
    "friction": FRICTION,
    "load_n": N,
    "creep_x": CREEPAGE,
}


def zones():
    """Half widths of the contact and of the stick zone, maximum pressure."""
    n, radius, mu = mp.mpf(N), mp.mpf(RADIUS), mp.mpf(FRICTION)
    e_star = mp.mpf(YOUNG) / (1 - mp.mpf(POISSON) ** 2) / 2
    a = mp.sqrt(4 * n * radius / (mp.pi * e_star))
    return a, a - radius * mp.mpf(CREEPAGE) / mu, 2 * n / (mp.pi * a)


def evidence():
    """Carter (1926), Johnson (1985) section 8.3, in 30 digits."""
    with mp.workdps(30):
        a, c, p0 = zones()
        mu = mp.mpf(FRICTION)
        force = mu * mp.mpf(N) * (1 - (c / a) ** 2)
        how = "closed form (Carter 1926; Johnson, Contact Mechanics, section 8.3), mpmath, 30 digits"
        return [
            closed("tangential_force", "N/m", force, how),
            closed("stick_width", "m", 2 * c, how),
            closed("shear_max", "Pa", 2 * mu * p0 * mp.sqrt(c / a * (1 - c / a)), how),
            closed("slip_velocity_max", "", 2 * mu / mp.mpf(RADIUS) * mp.sqrt(a * (a - c)), how),
            closed("friction_work", "J/m2", mp.mpf(CREEPAGE) * force, how),
        ]


def answers():
    last = {name: values[-1] for name, values in petsam.run(OPTIONS).history.items()}
    return {
        "tangential_force": last["load_tx"],
        "stick_width": last["stick_area"],
        "shear_max": last["shear_max"],
        "slip_velocity_max": last["slip_velocity_max"],
        "friction_work": last["rolling_energy"],
    }


def draw(figure):
    axes = figure.subplots()
    results = petsam.run(OPTIONS)
    x, mu = results.x * 1e3, float(FRICTION)
    axes.plot(x, mu * results["pressure"][-1][0] * 1e-6, "--", label=r"$\mu p$")
    axes.plot(x, results["shear_x"][-1][0] * 1e-6, label="q")
    axes.annotate("rolls towards +x", (0.6, 90), ha="center")
    axes.set_ylim(0, 100)
    axes.set_xlabel("x, mm")
    axes.set_ylabel("shear, MPa")
    axes.legend(loc="upper left")
