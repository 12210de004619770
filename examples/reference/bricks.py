"""Finite elements of a strip, bricks of 8 nodes, and two such strips whose nodes touch with friction; mm, N, MPa.

A strip fills x from its free end to its clamp, |y| <= its half width, and z from the contact's plane on. Loads are
symmetric about y = 0, so half of it is meshed. The other strip is the same one after half a turn about y.
"""

import numpy as np
from scipy import sparse
from scipy.linalg import cholesky, solve_triangular

CORNERS = np.array([(a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)], dtype=float)
SWEEPS = 20  # of relaxation between attempts of Newton's method
TRIES = 30
TOLERANCE = 1e-9  # of the forces


def halved(lines, times):
    """Planes of elements, each element halved so many times."""
    lines = np.array(lines, dtype=float)
    for _ in range(times):
        lines = np.sort(np.concatenate([lines, (lines[1:] + lines[:-1]) / 2]))
    return lines


def shares(lines):
    """Length that belongs to each node of a line."""
    steps = np.diff(lines) / 2
    return np.append(steps, 0) + np.append(0, steps)


def brick(sides, young, poisson):
    """Stiffness (24, 24) of a box with incompatible modes 1 - xi^2 of each direction, which are eliminated."""
    half = np.array(sides) / 2
    shear = young / (2 * (1 + poisson))
    elastic = np.diag([2 * shear] * 3 + [shear] * 3)
    elastic[:3, :3] += 2 * shear * poisson / (1 - 2 * poisson)
    whole = np.zeros((33, 33))
    for point in CORNERS / np.sqrt(3):
        one, gradient = 1 + CORNERS * point, np.zeros((11, 3))
        for d in range(3):
            gradient[:8, d] = CORNERS[:, d] * one[:, d - 1] * one[:, d - 2] / (8 * half[d])
            gradient[8 + d, d] = -2 * point[d] / half[d]
        strain = np.zeros((6, 11, 3))
        strain[range(3), :, range(3)] = gradient.T
        for row, (a, b) in enumerate(((0, 1), (1, 2), (2, 0)), 3):
            strain[row, :, a], strain[row, :, b] = gradient[:, b], gradient[:, a]
        strain = strain.reshape(6, 33)
        whole += strain.T @ elastic @ strain * half.prod()
    return whole[:24, :24] - whole[:24, 24:] @ np.linalg.solve(whole[24:, 24:], whole[24:, :24])


class Strip:
    """Compliance of the nodes of the contact's plane whose distance from the origin is below `reach`.

    x, y       coordinates of these nodes, and `area`, what belongs to each in the half
    compliance (3 n, 3 n) displacements by forces on the half
    pressed    (3 n,) displacements by unit pressure on the washer |x|, |y| <= `washer` of the other side
    """

    def __init__(self, x, y, z, young, poisson, reach, washer):
        self.lines, self.material, self.washer, self._between = (x, y, z), (young, poisson), washer, {}
        per = 3 * len(y) * len(z)
        self.free = np.setdiff1d(np.arange(per), 3 * np.arange(len(z)) + 1)  # not u_y at y = 0
        planes = range(len(x) - 2, -1, -1)  # from the clamp on, whose nodes do not move
        near = [np.flatnonzero(np.hypot(x[i], y) < reach) for i in planes]
        self.x, self.y = np.repeat(x[planes], [len(one) for one in near]), y[np.concatenate(near)]
        self.area = np.concatenate([shares(x)[i] * shares(y)[one] for i, one in zip(planes, near)])
        self.compliance, self.pressed = np.zeros(2 * (3 * len(self.x),)), np.zeros(3 * len(self.x))
        ends, last = np.cumsum([0] + [3 * len(one) for one in near]), None
        for i, one, first, end in zip(planes, near, ends, ends[1:]):
            last = self._eliminate(i, one, first, end, last)

    def _elements(self, i):
        """Stiffness of the elements between the planes i and i + 1 of x."""
        x, y, z = self.lines
        length = round(x[i + 1] - x[i], 9)
        if length not in self._between:
            entries = []
            for j in range(len(y) - 1):
                for k in range(len(z) - 1):
                    one = brick((length, y[j + 1] - y[j], z[k + 1] - z[k]), *self.material)
                    nodes = [(a * len(y) + j + b) * len(z) + k + c for a in (0, 1) for b in (0, 1) for c in (0, 1)]
                    dof = (3 * np.array(nodes)[:, None] + np.arange(3)).ravel()
                    entries.append((np.repeat(dof, 24), np.tile(dof, 24), one.ravel()))
            rows, columns, values = (np.concatenate(part) for part in zip(*entries))
            size = 6 * len(y) * len(z)
            self._between[length] = sparse.csr_matrix((values, (rows, columns)), shape=(size, size))
        return self._between[length]

    def _eliminate(self, i, near, first, end, last):
        """Eliminates a plane by Cholesky; with K = L L', loads E give the compliance, the sum of (L^-1 E)'L^-1 E."""
        x, y, z = self.lines
        per, place = 3 * len(y) * len(z), np.full(3 * len(y) * len(z), -1)
        place[self.free] = np.arange(len(self.free))
        matrix = self._elements(i)[:per, :per]
        if i:
            matrix = matrix + self._elements(i - 1)[per:, per:]
        matrix = matrix[self.free][:, self.free].toarray()
        loads, pressure = np.zeros((len(self.free), end)), np.zeros(per)
        for d in range(3):
            at = place[3 * len(z) * near + d]
            held = at >= 0
            loads[at[held], (first + 3 * np.arange(len(near)) + d)[held]] = 1
        if abs(x[i]) <= self.washer:
            row, column = (line[np.abs(line) <= self.washer] for line in (x, y))
            share = shares(row)[row == x[i]] * shares(column)
            pressure[3 * (len(z) * np.arange(len(column)) + len(z) - 1) + 2] = -share
        pressure = pressure[self.free]
        if last:
            lower, link, before, pressed = last
            back = solve_triangular(lower, link.T.toarray(), lower=True, check_finite=False)
            matrix -= back.T @ back
            loads[:, : before.shape[1]] -= back.T @ before
            pressure = pressure - back.T @ pressed
        lower = cholesky(matrix, lower=True, check_finite=False)
        loads = solve_triangular(lower, loads, lower=True, check_finite=False)
        pressure = solve_triangular(lower, pressure, lower=True, check_finite=False)
        self.compliance[:end, :end] += loads.T @ loads
        self.pressed[:end] += loads.T @ pressure
        link = self._elements(i - 1)[:per, per:][self.free][:, self.free] if i else None
        return lower, link, loads, pressure


class Joint:
    """A strip, body 1, upon another one, body 2: forces on the nodes of body 1 and its motion relative to body 2."""

    def __init__(self, strip, friction):
        n = len(strip.x)
        number = {(round(a, 6), round(b, 6)): k for k, (a, b) in enumerate(zip(strip.x, strip.y))}
        turned = np.array([number[round(-a, 6) + 0.0, round(b, 6)] for a, b in zip(strip.x, strip.y)])
        sign, at = np.tile([-1.0, 1.0, -1.0], n), (3 * turned[:, None] + np.arange(3)).ravel()
        self.compliance = strip.compliance + sign[:, None] * strip.compliance[np.ix_(at, at)] * sign
        self.pressed = (strip.pressed - sign * strip.pressed[at]).reshape(-1, 3)
        middle = 3 * np.flatnonzero(strip.y < 1e-9)
        self.compliance[middle + 1, middle + 1] = self.compliance[middle, middle]  # no motion, so no force follows
        self.stiff = 1 / np.diag(self.compliance).reshape(-1, 3)
        self.strip, self.friction, self.force, self.moved = strip, friction, np.zeros((n, 3)), np.zeros((n, 3))

    def motion(self, given, force):
        """Motion of body 1 relative to body 2 by what is given and by the forces."""
        return given + (self.compliance @ force.ravel()).reshape(-1, 3)

    def newton(self, given, force, most):
        """Forces, motion, and where nodes slip, from a guess of the forces; None: not found."""
        for _ in range(most):
            moved = self.motion(given, force)
            closed = force[:, 2] - self.stiff[:, 2] * moved[:, 2] > 0
            bound = self.friction * np.maximum(force[:, 2], 0)
            trial = force[:, :2] - self.stiff[:, :1] * (moved - self.moved)[:, :2]
            size = np.hypot(*trial.T)
            slips = closed & (size > bound)
            wanted = np.where(slips[:, None], (bound / np.maximum(size, 1e-300))[:, None] * trial, trial)
            wrong = np.where(closed, self.stiff[:, 2] * moved[:, 2], force[:, 2])
            wrong = max(np.abs(wrong).max(), np.abs(force[:, :2] - np.where(closed[:, None], wanted, 0)).max())
            if wrong < TOLERANCE * np.abs(force).max():
                return force, moved, slips
            k = np.flatnonzero(closed)
            dof = (3 * k[:, None] + np.arange(3)).ravel()
            matrix, right = self.compliance[np.ix_(dof, dof)].reshape(len(k), 3, -1), -given[k]
            right[:, :2] += self.moved[k, :2]
            s = np.flatnonzero(slips[k])  # along the trial |q| = mu p, across it q turns with the trial
            ks = k[s]
            along, ratio = trial[ks] / size[ks, None], np.maximum(bound[ks] / size[ks], 1e-9)
            across, soft = along[:, ::-1] * [-1, 1], 1 / self.stiff[ks, 0]
            turning = np.einsum("si,sij->sj", across, matrix[s, :2])
            right[s, 1], right[s, 0] = np.sum(across * right[s, :2], axis=1), 0
            matrix[s, 0], matrix[s, 1] = 0, turning
            for d in range(2):
                matrix[s, 0, 3 * s + d] = along[:, d] * soft
                matrix[s, 1, 3 * s + d] += (1 - ratio) / ratio * across[:, d] * soft
            matrix[s, 0, 3 * s + 2] = -self.friction * soft
            force = np.zeros(force.shape)
            force[k] = np.linalg.solve(matrix.reshape(3 * len(k), -1), right.ravel()).reshape(-1, 3)
        return None

    def relaxed(self, given, force):
        """Forces after sweeps of Gauss and Seidel's iteration, node by node."""
        force = force.copy()
        flat, rows = force.ravel(), self.compliance.reshape(len(force), 3, -1)
        for _ in range(SWEEPS):
            for k in np.flatnonzero((force[:, 2] > 0) | (self.motion(given, force)[:, 2] < 0)):
                moved = given[k] + rows[k] @ flat
                force[k, 2] = max(0.0, force[k, 2] - self.stiff[k, 2] * moved[2])
                shear = force[k, :2] - self.stiff[k, :2].min() * (moved - self.moved[k])[:2]
                force[k, :2] = shear * min(1.0, self.friction * force[k, 2] / max(np.hypot(*shear), 1e-300))
        return force

    def step(self, pressure, distance):
        """A step to a pressure on both washers, and a displacement of the end of body 1 along x; returns the energy (N
        mm) that friction dissipates in both halves."""
        given, force = self.pressed * pressure + [distance, 0, 0], self.force
        found = self.newton(given, force, 6) if np.any(force) else None
        for _ in range(TRIES):
            if found:
                break
            force = self.relaxed(given, force)
            found = self.newton(given, force, 10)
        force, moved, slips = found
        lost = -2 * np.sum((force * (moved - self.moved))[slips, :2])
        self.force, self.moved = force, moved
        return lost
