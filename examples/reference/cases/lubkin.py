"""A sphere twisted by a moment below the limit: Lubkin."""

import mpmath as mp
import numpy as np
from common import closed

import petsam

# decimal, so that mpmath reads them exactly
N, MOMENT, RADIUS, YOUNG, POISSON, FRICTION = "800", "0.09", "0.05", "210e9", "0.3", "0.4"
OPTIONS = {
    "grid_n": 256,
    "grid_size": 1.6e-3,
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": POISSON for body in (1, 2)},
    "gap_type": "sphere",
    "gap_radius1": RADIUS,
    "gap_radius2": "inf",
    "friction": FRICTION,
    "load_n": N,
}


def solve():
    return petsam.run(OPTIONS, history={"load_mz": [0, float(MOMENT)]})


def evidence():
    """The shear as a sum of that of rigid discs of radius s (Reissner and Sagoci), c <= s <= a, in 30 digits.

    A disc that turns by f(s) ds has the shear 4 G f r/(pi sqrt(s^2 - r^2)) and the moment 16/3 G s^3 f. Where it slips
    Abel's inversion gives f = -F'(s)/(2 G), F = mu p0 (K - E) of the modulus sqrt(1 - s^2/a^2). Both bodies turn.
    """
    with mp.workdps(30):
        n, moment, radius, mu = mp.mpf(N), mp.mpf(MOMENT), mp.mpf(RADIUS), mp.mpf(FRICTION)
        e_star = mp.mpf(YOUNG) / (1 - mp.mpf(POISSON) ** 2) / 2
        shear_modulus = mp.mpf(YOUNG) / (1 + mp.mpf(POISSON)) / 2
        a = mp.cbrt(3 * n * radius / (4 * e_star))
        limit = mu * 3 * n / (2 * mp.pi * a**2)  # mu p0

        def bound(s):
            m = 1 - (s / a) ** 2
            return limit * (mp.ellipk(m) - mp.ellipe(m)) if m < 1 else mp.mpf(0)  # 0: it is multiplied by s^2

        def moment_of(c):
            return 8 * (c**3 * bound(c) / 3 + mp.quad(lambda s: s**2 * bound(s), [c, (a + c) / 2, a]))

        def twist_of(c):  # of both bodies
            return bound(c) / shear_modulus

        gross = mp.mpf(8) * mp.quad(lambda s: s**2 * bound(s), [0, a / 8, a])
        assert abs(gross / (3 * mp.pi * mu * n * a / 16) - 1) < 1e-12
        c = mp.findroot(lambda c: moment_of(c) - moment, (a * mp.mpf("0.4"), a * mp.mpf("0.8")), solver="anderson")
        # 2 int M d(twist) - M twist, a quarter of Masing's loop: slip in first loading is half that of a reversal
        energy = 8 / shear_modulus * mp.quad(lambda s: s**2 * bound(s) * (bound(c) - bound(s)), [c, (a + c) / 2, a])
        how = "closed form (Lubkin 1951; sum of Reissner and Sagoci's discs), mpmath, 30 digits"
        return [
            closed("twist", "rad", twist_of(c), how),
            closed("stick_radius", "m", c, how),
            closed("shear_max", "Pa", limit * mp.sqrt(1 - c**2 / a**2), how),
            closed("dissipated_energy", "J", energy, how),
        ]


def answers():
    h = solve().history
    return {
        "twist": h["rot_z"][-1],
        "stick_radius": np.sqrt(h["stick_area"][-1] / np.pi),
        "shear_max": h["shear_max"][-1],
        "dissipated_energy": h["dissipated_energy"][-1],
    }


def draw(figure):
    results = solve()
    left, right = figure.subplots(1, 2)
    middle = len(results.y) // 2
    x = results.x[middle:] * 1e3
    left.plot(x, results["shear_y"][-1][middle, middle:] * 1e-6, label="q")
    left.plot(x, float(FRICTION) * results["pressure"][-1][middle, middle:] * 1e-6, "--", label=r"$\mu p$")
    left.set_xlabel("r, mm")
    left.set_ylabel("q around the axis, MPa")
    left.legend()
    curve = petsam.run(
        OPTIONS, grid_n=64, history={"load_mz": np.linspace(0, float(MOMENT), 31)}, output_fields="none"
    ).history
    right.plot(curve["rot_z"] * 1e3, curve["load_mz"])
    right.set_xlabel("$r_z$, mrad")
    right.set_ylabel("$M_z$, N m")
