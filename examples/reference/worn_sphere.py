"""Wear of a sphere on a half-space of the same material, axisymmetric, by rings of uniform pressure.

The displacement by a ring is that of two discs (K. L. Johnson, Contact Mechanics, eq. 3.29). Time is integrated by the
L-stable diagonally implicit method of second order with two stages, in which the pressure at a stage's end is found
together with the wear until then. All lengths are in units of the contact radius a0 and the approach d0 without wear,
loads in E* a0 d0, pressures in E* d0/a0."""

import numpy as np
from scipy.special import ellipe, ellipk

STAGE = 1 - np.sqrt(0.5)


def compliance(edges):
    """Displacement at the middle of each ring by the pressure 1 on each."""
    r, a = (edges[:-1] + edges[1:])[:, None] / 2, edges[None, 1:]
    inside, outside = np.minimum(r / a, 1) ** 2, np.minimum(a / r, 1) ** 2
    disc = np.where(
        r < a, a * ellipe(inside), r * (ellipe(outside) - (1 - outside) * ellipk(np.minimum(outside, 1 - 1e-15)))
    )
    return 4 / np.pi * np.diff(disc, axis=1, prepend=0)


class Sphere:
    """A worn sphere: `edges` of the rings, `slip` path at the rings by a unit of time as a function of the wear; the
    load or the approach is given."""

    def __init__(self, edges, slip, load=None, approach=None):
        self.edges, self.slip, self.load, self.approach = edges, slip, load, approach
        self.r = (edges[:-1] + edges[1:]) / 2
        self.area = np.pi * np.diff(edges**2)
        self.matrix = compliance(edges)
        self.wear = np.zeros(len(self.r))
        self.count = int(np.searchsorted(edges, 1.0))  # rings in contact
        self.pressure = self.press(self.wear, 0 * self.wear)

    def press(self, wear, more):
        """Pressure where `wear` and more * pressure have been removed."""
        while True:
            n = self.count
            gap = self.r**2 / 2 + wear  # a0^2 = R d0
            matrix = self.matrix[:n, :n] + np.diag(more[:n])
            one, shape = np.linalg.solve(matrix, np.stack([np.ones(n), gap[:n]], axis=1)).T
            depth = self.approach
            if depth is None:
                depth = (self.load + self.area[:n] @ shape) / (self.area[:n] @ one)
            found = np.zeros(len(self.r))
            found[:n] = depth * one - shape
            if found[n - 1] < 0:
                self.count -= 1
            elif n < len(self.r) and gap[n] + self.matrix[n] @ found < depth:
                self.count += 1
            else:
                self.depth = depth
                return found

    def step(self, time):
        """Wears for a time."""

        def stage(wear):
            worn = wear
            for _ in range(50):
                slip = self.slip(self.r, worn)
                pressure = self.press(wear, time * STAGE * slip)
                rate = slip * pressure
                before, worn = worn, wear + time * STAGE * rate
                if np.max(np.abs(worn - before)) < 1e-12:
                    break
            return rate, pressure

        first, _ = stage(self.wear)
        second, self.pressure = stage(self.wear + time * (1 - STAGE) * first)
        self.wear = self.wear + time * ((1 - STAGE) * first + STAGE * second)

    def volume(self):
        return float(self.area @ self.wear)


def radius_at(times, counts, edges, time):
    """Contact radius at a time: a curve through the radii of the outermost rings, smooth in the logarithm of time."""
    times, radii = np.array(times), np.array([edges[count] + edges[count - 1] for count in counts]) / 2
    late = times > times[-1] / 300
    return float(np.polynomial.Polynomial.fit(np.log(times[late]), radii[late], 5)(np.log(time)))
