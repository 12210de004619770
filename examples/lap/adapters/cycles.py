"""Harmonics of a contact's force over those of its coordinates, as programs of harmonic balance need them: Cycles.

The coordinates u(t) = sum of X_c w_c(t) move with the waves w = 1, cos t, sin t, cos 2t, ... From its preload the
contact goes through this cycle until the energy of a cycle has settled. F_c are the coefficients of its force in the
last cycle.

The derivative dF/dX keeps the zones of stick and slip of each step, and takes the force after a reversal r as a
function of the motion since then, as Masing's rule does:

    df = df_r + k (du - du_r)       at the end of the first loading  df = k du

k is the tangent of the step. It is accurate for loops with two reversals under a constant normal load, and approximate
elsewhere: a solver then needs more iterations and finds the same solution.
"""

import numpy as np

import petsam

SETTLED = 1e-3  # change of the energy from one cycle to the next at which it counts as settled
CYCLES = 12  # largest number of cycles
PER_WAVE = 4  # least samples of a period of the highest harmonic
GRID = 256  # points among which a reversal is sought
RISE = 8  # part of the samples of a cycle in which the contact goes from its preload to the cycle


class Cycles:
    """The element in its preload, and a copy of it that moves.

    u, force  coordinates and loads on the structure in the preload, to which those of the cycles are relative
    steps     number of contact steps so far
    """

    def __init__(self, element):
        self._preload, self._moved = element, element.copy()
        self.u, self.force, self.steps = element.u, element.force, 0
        self._stuck = element.tangent(True)

    def harmonics(self, coefficients, order, samples, tangent=True):
        """Coefficients (waves, n) of the force on the structure and their derivative (waves, n, waves, n), or None.

        coefficients  (waves, n): of the coordinates
        order         of the harmonics, rising: 0 has one wave, the others two, cosine and sine
        samples       steps of a cycle, at least PER_WAVE for each period of the highest harmonic
        """
        order = np.asarray(order)
        if samples < PER_WAVE * order.max():
            raise petsam.Error(f"{samples} time samples: {order.max()} harmonics need {PER_WAVE * order.max()} or more")
        times = self._peak(coefficients, order) + 2.0 * np.pi * np.arange(samples + 1) / samples
        wave = waves(order, times)
        moved = wave @ coefficients
        if not np.any(np.ptp(moved, axis=0) > 0.0):
            force, slopes = self._still(moved[0], samples)
        else:
            force, slopes = self._settled(moved, tangent)  # of the samples after the first one
        analysis = np.where(order_of_waves(order) > 0, 2.0, 1.0)[:, None] / samples * wave[1:].T
        if not tangent:
            return analysis @ force, None
        found = np.zeros((len(wave[0]), force.shape[1], len(wave[0]), force.shape[1]))
        for k, slope in enumerate(self._slopes(wave, moved, slopes)):
            found += analysis[:, k, None, None, None] * slope
        return analysis @ force, found

    def _peak(self, coefficients, order):
        """Time of the reversal that is farthest from the preload, of the coordinate that works most: later reversals
        keep what the first loading up to there has left. Between points of a grid it is that of a parabola."""
        oscillating = coefficients * (order_of_waves(order) > 0)[:, None]
        lead = np.argmax(np.abs(np.diag(self._stuck)) * np.sum(oscillating**2, axis=0))
        times = 2.0 * np.pi * np.arange(GRID) / GRID
        reach = np.abs(waves(order, times) @ coefficients[:, lead])
        top = int(np.argmax(reach))
        before, here, after = reach[[top - 1, top, (top + 1) % GRID]]
        bend = before - 2.0 * here + after
        return times[top] + (np.pi / GRID * (before - after) / bend if bend < 0.0 else 0.0)

    def _still(self, u, samples):
        """Forces and tangents of the contact that a constant displacement moves."""
        self._moved.take(self._preload)
        force = self._go(self.u + u)
        return np.tile(force, (samples, 1)), np.tile(self._stuck, (samples + 1, 1, 1))

    def _go(self, u, slopes=None):
        """A step to u: the force; its tangent is appended to slopes."""
        force = self._moved.try_(u) - self.force
        if slopes is not None:
            slopes.append(self._moved.tangent())
        self._moved.commit()
        self.steps += 1
        return force

    def _settled(self, moved, tangent):
        """Forces of each step of a cycle, which is repeated until its energy settles, and tangents of the first
        loading's end and of these steps."""
        self._moved.take(self._preload)
        first, before = [] if tangent else None, None
        rise = np.linspace(0.0, 1.0, len(moved) // RISE + 2)[1:]
        for part in rise:
            self._go(self.u + part * moved[0], first if part == 1.0 else None)
        for count in range(CYCLES):
            forces, energy = [], 0.0
            slopes = [*first] if tangent and count else None
            for u in self.u + moved[1:]:
                forces.append(self._go(u, slopes))
                energy += self._moved.number("dissipated_energy")
            if count and abs(energy - before) <= SETTLED * abs(energy):
                break
            before = energy
        return np.array(forces), np.array(slopes) if tangent else None

    def _slopes(self, wave, moved, slopes):
        """Derivatives of the force of each step, (n, waves, n)."""
        changes = -np.einsum("kn,nm,km->k", np.diff(moved, axis=0), self._stuck, np.roll(np.diff(moved, axis=0), -1, 0))

        def motion(k):
            return np.einsum("ij,w->iwj", np.eye(moved.shape[1]), wave[k])

        def turned(slope, by):
            return np.einsum("ij,jwk->iwk", slope, by)

        last, reversal = turned(slopes[0], motion(0)), motion(0)
        for k, slope in enumerate(slopes[1:]):
            now = last + turned(slope, motion(k + 1) - reversal)
            yield now
            if changes[k] <= 0.0:
                last, reversal = now, motion(k + 1)


def order_of_waves(order):
    """Order of the harmonic of each wave."""
    return np.concatenate([[h] * (2 if h else 1) for h in order])


def waves(order, times):
    """(times, waves): 1 for order 0, cosine and sine for each other one."""
    parts = [[np.ones_like(times)] if h == 0 else [np.cos(h * times), np.sin(h * times)] for h in order]
    return np.column_stack([wave for part in parts for wave in part])
