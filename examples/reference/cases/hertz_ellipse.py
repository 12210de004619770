"""Two cylinders that cross at an angle: Hertz's ellipse."""

import mpmath as mp
import numpy as np
from common import closed

import petsam

N, RADIUS1, RADIUS2, ANGLE = "500", "0.02", "0.05", "60"  # N, m, m, degrees; decimal, so that mpmath reads them exactly
YOUNG1, POISSON1, YOUNG2, POISSON2 = "210e9", "0.3", "70e9", "0.33"
OPTIONS = {
    "grid_n": 256,
    "grid_size": 2.2e-3,
    "body1_young": YOUNG1,
    "body1_poisson": POISSON1,
    "body2_young": YOUNG2,
    "body2_poisson": POISSON2,
    "gap_type": "curved",  # both cylinders are straight along their own x
    "gap_radius1_y": RADIUS1,
    "gap_radius2_y": RADIUS2,
    "gap_angle": ANGLE,
    "load_n": N,
}


def evidence():
    """Johnson, Contact Mechanics (1985), eqs 4.3 to 4.5 and 4.24 to 4.29 with elliptic integrals, in 30 digits."""
    with mp.workdps(30):
        n, one, two, angle = mp.mpf(N), 1 / mp.mpf(RADIUS1), 1 / mp.mpf(RADIUS2), mp.radians(mp.mpf(ANGLE))
        half = mp.sqrt(one**2 + two**2 + 2 * one * two * mp.cos(2 * angle)) / 4  # gap: (mean -+ half) (x, y)^2
        mean = (one + two) / 4
        flat, steep = mean - half, mean + half
        softness = [(1 - mp.mpf(nu) ** 2) / mp.mpf(e) for e, nu in ((YOUNG1, POISSON1), (YOUNG2, POISSON2))]
        e_star = 1 / sum(softness)

        def ratio_of(k):  # steep/flat of an ellipse with b/a = k
            m = 1 - k**2
            return (mp.ellipe(m) / k**2 - mp.ellipk(m)) / (mp.ellipk(m) - mp.ellipe(m)) - steep / flat

        k = mp.findroot(ratio_of, (mp.mpf("0.2"), mp.mpf("0.95")), solver="anderson", tol=1e-50)
        m = 1 - k**2
        # flat = p0/E* b/(e^2 a^2) (K - E), N = 2/3 pi a b p0
        a = mp.cbrt(3 * n * (mp.ellipk(m) - mp.ellipe(m)) / (2 * mp.pi * e_star * m * flat))
        pressure = 3 * n / (2 * mp.pi * a**2 * k)
        approach = pressure / e_star * a * k * mp.ellipk(m)
        # the gap is least curved where one sin(t)^2 + two sin(t - angle)^2 is least
        turn = mp.atan2(two * mp.sin(2 * angle), one + two * mp.cos(2 * angle)) / 2
        how = "closed form (Johnson, Contact Mechanics, eqs 4.3 to 4.5, 4.24 to 4.29), mpmath, 30 digits"
        return [
            closed("semi_axis_major", "m", a, how),
            closed("semi_axis_minor", "m", a * k, how),
            closed("axis_angle", "degrees", mp.degrees(turn), how),
            closed("pressure_max", "Pa", pressure, how),
            closed("approach", "m", approach, how),
            closed("elastic_energy", "J", n * approach * 2 / 5, how),
        ]


def solve():
    return petsam.run(OPTIONS)


def answers():
    results = solve()
    last = {name: values[-1] for name, values in results.history.items()}
    x, y = np.meshgrid(results.x, results.y)
    p = results["pressure"][-1]
    second = np.array([[np.sum(p * x * x), np.sum(p * x * y)], [np.sum(p * x * y), np.sum(p * y * y)]]) / np.sum(p)
    squares, axes = np.linalg.eigh(second)  # the pressure's second moments have the ratio of the axes
    k = np.sqrt(squares[0] / squares[1])
    return {
        "semi_axis_major": np.sqrt(last["contact_area"] / (np.pi * k)),
        "semi_axis_minor": np.sqrt(last["contact_area"] * k / np.pi),
        "axis_angle": np.degrees(np.arctan(axes[1, 1] / axes[0, 1])),
        "pressure_max": last["pressure_max"],
        "approach": last["disp_z"],
        "elastic_energy": last["stored_energy"],
    }


def draw(figure):
    axes = figure.subplots()
    results = solve()
    p = results["pressure"][-1] * 1e-6
    image = axes.contourf(results.x * 1e3, results.y * 1e3, p, levels=np.arange(0, 701, 100), cmap="Blues")
    axes.set_aspect("equal")
    axes.set_xlim(-1.05, 1.05)
    axes.set_ylim(-0.6, 0.6)
    axes.set_xlabel("x, mm")
    axes.set_ylabel("y, mm")
    figure.colorbar(image, label="p, MPa", format="%.0f")
