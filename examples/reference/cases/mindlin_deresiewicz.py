"""A sphere under normal and tangential force that vary together: Mindlin and Deresiewicz."""

import numpy as np
from common import Way, closed, covered

import petsam

RADIUS, YOUNG, FRICTION = 0.1, 200e9, 0.5
ROWS = ((1000, 0), (1000, 300), (1400, 400), (800, 150), (1200, -250), (1000, 0))  # N, T_x
OPTIONS = {
    "grid_n": 256,
    "grid_size": 2.5e-3,
    **{f"body{body}_young": YOUNG for body in (1, 2)},
    **{f"body{body}_poisson": 0 for body in (1, 2)},
    "gap_type": "sphere",
    "gap_radius1": RADIUS,
    "gap_radius2": "inf",
    "friction": FRICTION,
}


def solve(steps=10, **more):
    n, t = zip(*ROWS)
    return petsam.run(OPTIONS, history={"load_n": n, "load_tx": t}, steps=steps, **more)


def slopes(knots, values):
    """Of a function in straight pieces; 0 for pieces without length."""
    lengths = np.diff(knots)
    return np.diff(values) / np.where(lengths > 0, lengths, np.inf)


class Springs:
    """The same contact as independent springs along x, exact for axisymmetric contacts with nu = 0 (Jaeger, Popov and
    Hess): their stretch w is a function of s = x^2 in straight pieces, which the step keeps exactly."""

    def __init__(self):
        self.stiffness = YOUNG / 2  # of springs per length, normal and tangential: E* = G
        self.edge, self.shift = 0.0, 0.0  # a^2, d_x
        self.knots, self.values = np.array([0.0]), np.array([0.0])  # w at these s

    def force(self, knots, values):
        """Integral of stiffness w dx over both sides, exact for straight pieces in s."""
        x = np.sqrt(knots)
        slope = slopes(knots, values)
        part = (values[:-1] - slope * knots[:-1]) * np.diff(x) + slope * np.diff(x**3) / 3
        return 2 * self.stiffness * part.sum()

    def energy(self):
        """Half of the integral of stiffness w^2 dx."""
        x, k = np.sqrt(self.knots), self.knots
        slope = slopes(k, self.values)
        base = self.values[:-1] - slope * k[:-1]
        powers = base**2 * np.diff(x) + 2 * base * slope * np.diff(x**3) / 3 + slope**2 * np.diff(x**5) / 5
        return self.stiffness * powers.sum()

    def moved(self, edge, change):
        """Stretch after d_x has changed, within -+ mu (a^2 - s)/R; new springs were touched as a^2 grew."""
        knots, values = self.knots, self.values
        if edge > self.edge:
            knots, values = np.append(knots, edge), np.append(values, -change)
        elif edge < self.edge:
            values = np.append(values[knots < edge], np.interp(edge, knots, values))
            knots = np.append(knots[knots < edge], edge)
        values = values + change
        for sign in (1, -1):  # knots where w crosses a bound, then the bound
            over = sign * values - FRICTION * (edge - knots) / RADIUS
            over[np.abs(over) < 1e-22] = 0
            at = np.flatnonzero(over[:-1] * over[1:] < 0)
            new = knots[at] + np.diff(knots)[at] * over[at] / (over[at] - over[at + 1])
            values = np.insert(values, at + 1, np.interp(new, knots, values))
            knots = np.insert(knots, at + 1, new)
            values = sign * np.minimum(sign * values, FRICTION * (edge - knots) / RADIUS)
        return knots, values

    def step(self, n, t):
        """To the loads N and T_x, by bisection and secants for d_x."""
        edge = np.cbrt(3 * n * RADIUS / (4 * self.stiffness)) ** 2
        if edge == self.edge and t == self.force(self.knots, self.values):
            return
        low, high = -2 * FRICTION * edge / RADIUS, 2 * FRICTION * edge / RADIUS
        for _ in range(70):
            middle = (low + high) / 2
            if self.force(*self.moved(edge, middle)) < t:
                low = middle
            else:
                high = middle
        self.knots, self.values = self.moved(edge, (low + high) / 2)
        keep = np.append(True, np.diff(self.knots) > 1e-13 * edge)
        self.knots, self.values = self.knots[keep], self.values[keep]
        self.edge, self.shift = edge, self.shift + (low + high) / 2

    def stick(self):
        """Radius of the zone in which |w| is below its bound."""
        inside = np.abs(self.values) < FRICTION * (self.edge - self.knots) / RADIUS * (1 - 1e-9)
        return np.sqrt(self.knots[np.flatnonzero(inside)[-1] + 1])


def springs(steps):
    """Quantities by springs, with so many steps per row."""
    model, before = Springs(), (0, 0)
    work, shifts, sticks = 0.0, [], []
    for row in ROWS:
        for k in range(1, steps + 1):
            n, t = (np.array(before) * (steps - k) + np.array(row) * k) / steps
            last = model.shift, before[1] + (row[1] - before[1]) * (k - 1) / steps
            model.step(n, t)
            work += (t + last[1]) / 2 * (model.shift - last[0])
        before = row
        shifts.append(model.shift)
        sticks.append(model.stick())
    return {
        "displacement_growing": shifts[2],
        "displacement_falling": shifts[3],
        "displacement_end": shifts[5],
        "stick_radius": sticks[4],
        "dissipated_energy": work - model.energy(),
    }


def evidence():
    steps = 16, 32, 64, 128
    found = [springs(number) for number in steps]
    how = "springs of the method of dimensionality reduction, exact for nu = 0"
    names = ("displacement_growing", "displacement_falling", "displacement_end", "stick_radius")
    assert all(abs(one[name] / found[-1][name] - 1) < 1e-10 for one in found for name in names)
    energies = [one["dissipated_energy"] for one in found]
    limits = [(4 * two - one) / 3 for one, two in zip(energies, energies[1:])]
    name = f"{how}, with 16 to 128 steps per row, extrapolated in squares of the step"
    return [
        *(closed(name, "m", found[-1][name], how) for name in names),
        covered("dissipated_energy", "J", [Way(name, tuple(limits))]),
    ]


def answers(**more):
    h = solve(**more).history
    every = len(h["disp_x"]) // len(ROWS)
    at = every * np.arange(1, len(ROWS) + 1) - 1
    return {
        "displacement_growing": h["disp_x"][at[2]],
        "displacement_falling": h["disp_x"][at[3]],
        "displacement_end": h["disp_x"][at[5]],
        "stick_radius": np.sqrt(h["stick_area"][at[4]] / np.pi),
        "dissipated_energy": np.sum(h["dissipated_energy"]),
    }


def draw(figure):
    left, right = figure.subplots(1, 2)
    path = solve(steps=20, grid_n=64, output_fields="none").history
    left.plot(path["disp_x"] * 1e6, path["load_tx"])
    for row, (n, t) in enumerate(ROWS):
        at = path["disp_x"][20 * row + 19] * 1e6
        left.plot(at, t, "k.")
        if row != 0:  # its place is that of the last row, which has the same loads
            left.annotate(f"{n} N", (at, t), xytext=(5, -10), textcoords="offset points", fontsize="x-small")
    left.set_xlim(-2.6, 4.6)
    left.set_ylim(-310, 450)
    left.set_xlabel("$d_x$, µm")
    left.set_ylabel("$T_x$, N")
    results = solve(grid_n=128, output_at="history")
    for row in (2, 3, 4, 5):
        shear = results["shear_x"][row][len(results.y) // 2] * 1e-6
        right.plot(results.x * 1e3, shear, label=f"N = {ROWS[row][0]} N, $T_x$ = {ROWS[row][1]} N")
    right.set_ylim(-280, 430)
    right.set_xlabel("x, mm")
    right.set_ylabel("$q_x$, MPa")
    right.legend(loc="upper center", fontsize="x-small")
