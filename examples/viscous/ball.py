"""A ball on a body that relaxes: its creep under a load, and a push there and back, beside closed-form solutions.

build/venv/bin/python examples/viscous/ball.py
"""

import numpy as np

import petsam

# a rigid ball of 1 mm on rubber: modulus of a sudden load, parts of it that relax, their times (s)
RADIUS, YOUNG, POISSON = 1e-3, 6e6, 0.5
PARTS, TIMES = (0.5, 0.2), (0.1, 1.0)
BALL = dict(
    body1_young="inf", body1_poisson=0, body2_young=YOUNG, body2_poisson=POISSON, body2_relax_moduli=PARTS,
    body2_relax_times=TIMES, friction=0, gap_type="sphere", gap_radius1=RADIUS, gap_radius2="inf",
    grid_n=96, grid_size=1e-3, errors="none",
)  # fmt: skip
STEEP = 4 / 3 * YOUNG / (1 - POISSON**2) * np.sqrt(RADIUS)  # Hertz: N = STEEP z^1.5
LOAD, RATE = 0.02, 5e-5  # N; m/s


def creep(t):
    """J(t)/J(0) from the parts of the modulus: its transform is the inverse of that of the modulus (two terms)."""
    (g1, g2), (t1, t2) = PARTS, TIMES
    rest = 1 - g1 - g2
    # rest (t1 - x)(t2 - x) + g1 t1 (t2 - x) + g2 t2 (t1 - x) = 0 are the times of the creep
    times = np.roots([rest, -(rest * (t1 + t2) + g1 * t1 + g2 * t2), t1 * t2]).real
    parts = [1 / (x * (g1 * t1 / (x - t1) ** 2 + g2 * t2 / (x - t2) ** 2)) for x in times]
    return 1 + sum(a * (1 - np.exp(-t / x)) for a, x in zip(parts, times))


def under_a_load():
    """The approach under a constant load, beside Lee and Radok (1960): z = (N J(t)/(J(0) STEEP))^(2/3)."""
    times = np.concatenate([[0], np.logspace(-3, 1, 25)])
    run = petsam.run(**BALL, history=dict(time=times, load_n=np.full(times.size, LOAD)), output_fields="none")
    print("time, s   approach, um   closed   error, %")
    for k in (0, 6, 12, 18, 25):
        closed = (LOAD * creep(times[k]) / STEEP) ** (2 / 3)
        found = run["disp_z"][k]
        print(f"{times[k]:7.3g} {found * 1e6:14.2f} {closed * 1e6:8.2f} {100 * (found / closed - 1):10.3f}")


def there_and_back():
    """Pushed in at a rate for 1 s and back: the force falls to 0 before the ball is back; energy stays in the body."""
    times = np.linspace(0, 2, 81)
    depth = RATE * np.where(times > 1, 2 - times, times) - 1e-12
    run = petsam.run(**BALL, history=dict(time=times, disp_z=depth), output_fields="none", allow_edge_contact=True)
    force, loss = np.nan_to_num(run["load_n"]), np.nansum(run["viscous_energy"])
    work = np.sum((force[1:] + force[:-1]) / 2 * np.diff(depth))
    last = times[np.nonzero(force > 0)[0][-1]]
    print(f"\nforce at 1 s {force[40] * 1e3:.2f} mN, of a body that does not relax {STEEP * RATE**1.5 * 1e3:.2f} mN")
    print(f"contact until {last:.3g} s; work {work * 1e9:.1f} nJ, dissipated until 2 s {loss * 1e9:.1f} nJ")


if __name__ == "__main__":
    under_a_load()
    there_and_back()
