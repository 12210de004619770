"""Harmonic balance: resonance of a mode under friction, and the response to a harmonic force.

In modal coordinates without contact, with force f and zeta the damping of the material, the structure moves as under
the static force

    g = f - eta'' - 2 zeta omega eta'

because its patches have no inertia. g is periodic; its harmonics G_1 .. G_H are the unknowns, and a cycle of load steps
under g gives the harmonics eta_h of the motion. In the modes s while all that touches sticks, of angular frequency w_s,

    G_hs = f_hs + (h^2 Omega^2 - 2 i h Omega zeta w_s) eta_hs(G)

Modes answer harmonics above H statically. Each cycle begins from the preload and is repeated until it settles.
Broyden's method begins with sticking contacts, for which eta_hs = G_hs/w_s^2.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from ...core.brief import brief
from ...core.errors import Unusable
from ...core.tables import Column
from .arguments import integer, modal, positive
from .failures import BEYOND, NoSolution
from .numbers import UNKNOWN_HERE, Numbers, energies, solved
from .structure import Structure
from .sweep import STEPS, Point, Sweep, of_vibrations

TOLERANCE = 1e-5  # of the balance, relative to its forces
NEAR = 0.01  # relative difference of amplitudes that are the same
BEYOND_LAST = 1.5  # largest amplitude of a guess over the largest one that was computed
LEAST_SLOPE = 0.02  # of the balance beside its force
FAR = 1e-2  # balance that is not near to a solution
MOST = 25  # cycles in which it is found
PER_HARMONIC = 4  # least load steps of a period of the highest harmonic


def need_steps(steps, harmonics):
    """Error for numbers of steps of a half cycle and of harmonics that do not go together."""
    harmonics, steps = integer("harmonics", harmonics), integer("steps", steps)
    if 2 * steps < PER_HARMONIC * harmonics:
        raise Unusable(f"steps {steps}: with {harmonics} harmonics use {PER_HARMONIC * harmonics // 2} or more")


class Balance(Sweep):
    """Motions with H harmonics about the preload of a structure."""

    def __init__(self, structure, mode=1, steps=STEPS, harmonics=3):
        need_steps(steps, harmonics)
        super().__init__(structure, mode, steps)
        self.order = np.arange(1, harmonics + 1)[:, None]
        self.mode, self.least = mode - 1, 2
        self.known = None  # amplitude and force of the last point
        self.secants = {}  # (0, mode): the stiffness that its resonance has shown
        angles = np.pi * np.arange(1, 2 * steps + 1) / steps
        self.waves = np.exp(1j * self.order * angles)  # (harmonics, steps of a cycle)

    def motion(self, force):
        """Harmonics of the modes' motion by those of the static force, both (harmonics, modes) of the stuck modes, and
        the cycle. The number of cycles only grows near a solution, where motion must be a smooth function of force."""
        lead = force[:, np.argmax(np.abs(force[0]) / self.omegas**2)]
        turn = np.exp(1j * self.order * peak(lead))  # so that the cycle reverses at the end of a step
        forces = np.real(self.waves.T @ (turn * force)) @ self.shapes.T
        rise = np.outer(np.linspace(0.0, 1.0, self.steps // 2 + 2)[1:], forces[-1])
        scale = self.scale_of(float(np.abs(force).sum()))
        cycle, self.least = self.repeat(rise, np.split(forces, 2), scale, self.least)
        return np.conj(turn) * (np.conj(self.waves) @ cycle.moved @ self.shapes) / self.steps, cycle

    def inertia(self, omega):
        """Factors of the motion in the balance at an angular frequency."""
        turned = self.order * omega
        return turned**2 - 2j * turned * self.preload.damping * self.omegas

    def slope(self, inertia):
        """Change of the balance's error by that of the force while all sticks; at a resonance of it never 0, as the
        contacts' slip moves the resonance."""
        found = 1.0 - inertia / self.omegas**2
        return np.where(np.abs(found) < LEAST_SLOPE, LEAST_SLOPE, found)

    def solve(self, error, guess, far=None):
        """The force for which error(force, motion) is zero; returns it, the motion and the cycle. error is about the
        change of the force that removes it; far(force, motion) a better guess where it is not small."""
        force, change, found = np.zeros_like(guess), guess, None
        inverse, best, beyond = np.eye(2 * guess.size), np.inf, ""
        for _ in range(MOST):
            try:
                motion, cycle = self.motion(force + change)
            except BEYOND:
                change, beyond = 0.5 * change, " (some guesses make a contact slide as a whole)"
                continue
            force = force + change
            wrong = _real(error(force, motion))
            size = np.linalg.norm(wrong) / np.linalg.norm(force)
            best = min(best, size)
            if size <= TOLERANCE:
                return force, motion, cycle
            if size > FAR:
                self.least = 2
                if far:
                    force, change, found = np.zeros_like(guess), far(force, motion), None
                    continue
            if found is not None:
                inverse = _updated(inverse, _real(change), wrong - found)
            found = wrong
            change = _complex(-inverse @ wrong, force.shape)
        raise NoSolution(
            f"the balance of {len(self.order)} harmonics was not found in {MOST} cycles{beyond}, error {best:.1e}, "
            f"limit {TOLERANCE:g}: use smaller steps of amplitude or frequency, or the quasi-static backbone"
        )

    def point(self, amplitude):
        """The Point of the mode's resonance at an amplitude of its first harmonic."""
        self.least = 2
        stiffness, at = self.omegas**2, (0, self.mode)

        def error(force, motion):
            inertia = self.inertia(np.sqrt(max(force[at].real / amplitude, 0.0)))
            wrong = (force - inertia * motion) / self.slope(inertia)
            wrong[at] = stiffness[self.mode] * (motion[at] - amplitude)
            return wrong

        if self.known is None:
            guess = np.zeros((len(self.order), len(self.omegas)), dtype=complex)
            guess[at] = stiffness[self.mode] * amplitude
        else:
            guess = self.known[1] * amplitude / self.known[0]
        force, motion, cycle = self.solve(error, guess)
        self.known = amplitude, force
        omega2 = force[at].real / amplitude
        damped = 1.0 / (2.0 * np.pi * omega2 * np.sum(np.abs(motion[0]) ** 2))
        return Point(abs(force[at]), amplitude, omega2, damped, cycle, self.least)

    def respond(self, force, omega):
        """Motion of the stuck modes (harmonics, modes) under a modal force at an angular frequency, and its cycle.

        One mode may be near its resonance. Its stiffness over its amplitude is gathered from all cycles; the others
        begin as if the contacts stuck.
        """
        self.least = 2
        inertia = self.inertia(omega)
        given = np.zeros(inertia.shape, dtype=complex)
        given[0] = self.shapes.T @ force
        if not np.any(given):
            raise Unusable("force: moves no mode: take another place or direction")
        slope = self.slope(inertia)
        still = np.abs(slope[0]) * self.omegas**2 / np.maximum(np.abs(given[0]), 1e-12 * np.abs(given[0]).max())
        at = 0, int(np.argmin(still))
        slope[at] = 1.0  # its own is that of the secant
        secant = self.secants.setdefault(at, Secant(self.omegas[at[1]] ** 2))

        def error(force, motion):
            wrong = (force - given - inertia * motion) / slope
            wrong[at] = secant.removed(wrong[at], force[at], motion[at], inertia[at])
            return wrong

        def guess(force, motion):
            """The forces of this motion of the other modes, and of the resonant one by its stiffness."""
            if force is None:
                found = given / slope
            else:
                secant.add(force[at], motion[at])
                found = (given + inertia * (motion - force / self.omegas**2)) / slope
            found[at] = secant.resonance(given[at], inertia[at])
            return found

        force, motion, cycle = self.solve(error, guess(None, None), guess)
        secant.add(force[at], motion[at])
        return motion, cycle


class Secant:
    """Force over motion of one mode's first harmonic, a complex stiffness, over its amplitude."""

    def __init__(self, stiffness):
        self.amplitudes, self.stiffness = np.zeros(1), np.array([stiffness + 0j])
        self.last = 0.0  # amplitude that was added last

    def add(self, force, motion):
        """Adds what a cycle has found."""
        self.last = abs(motion)
        kept = np.abs(self.amplitudes - self.last) > NEAR * self.last
        order = np.argsort(amplitudes := np.append(self.amplitudes[kept], self.last))
        self.amplitudes = amplitudes[order]
        self.stiffness = np.append(self.stiffness[kept], force / motion)[order]

    def at(self, amplitude):
        """Stiffness at amplitudes; beyond the largest one it goes on as a line."""
        found = np.interp(amplitude, self.amplitudes, self.stiffness)
        if self.amplitudes.size > 1:
            slope = (self.stiffness[-1] - self.stiffness[-2]) / (self.amplitudes[-1] - self.amplitudes[-2])
            found = found + slope * np.maximum(amplitude - self.amplitudes[-1], 0.0)
        return found

    def resonance(self, force, inertia):
        """Static force on the mode under a force: of the amplitudes that balance it, that nearest to the last one."""
        floor = NEAR * abs(inertia)
        most = 2.0 * abs(force) / max(abs(self.stiffness[0] - inertia), floor)
        if self.amplitudes.size > 1:
            most = BEYOND_LAST * self.amplitudes[-1]
        # amplitudes beside a resonance may be far smaller than those at it
        least = 0.5 * abs(force) / max(np.abs(self.stiffness - inertia).max(), floor)
        amplitudes = np.geomspace(least, max(most, 4.0 * least), 4001)
        excess = np.abs(self.at(amplitudes) - inertia) * amplitudes - abs(force)
        roots = np.flatnonzero(excess[1:] * excess[:-1] <= 0.0)
        if roots.size:
            at = roots[np.argmin(np.abs(amplitudes[roots] - self.last))]
            low, high = excess[at], excess[at + 1]
            part = low / (low - high) if low != high else 0.0
            amplitude = amplitudes[at] + part * (amplitudes[at + 1] - amplitudes[at])
        else:
            amplitude = amplitudes[::-1][np.argmin(np.abs(excess[::-1]))]
        stiffness = self.at(amplitude)
        turn = force / (stiffness - inertia) if stiffness != inertia else -1j * force  # lags by a quarter period
        return stiffness * turn * amplitude / abs(turn)

    def removed(self, wrong, force, motion, inertia):
        """Change of the static force that removes an error of its balance."""
        kappa, amplitude = force / motion, abs(motion)
        steps = amplitude * np.array([1.0 - NEAR, 1.0 + NEAR])
        low, high = self.at(steps)
        bend = (high - low) / (steps[1] - steps[0]) * amplitude
        turn = motion / amplitude
        stiffness = _plane(kappa) + np.outer(_pair(bend * turn), _pair(turn))
        real, imaginary = np.linalg.solve(np.eye(2) - _plane(inertia) @ np.linalg.inv(stiffness), _pair(wrong))
        return real + 1j * imaginary


def _pair(value):
    return np.array([value.real, value.imag])


def _plane(value):
    """Multiplication by a complex number, of pairs."""
    return np.array([[value.real, -value.imag], [value.imag, value.real]])


RESPONSE = {
    "frequency": ("Hz", "frequency of the force"),
    "amplitude": ("m", "first harmonic of the displacement at the sensor"),
    "phase": ("rad", "its phase after that of the force"),
    "higher": ("m", "sum of the higher harmonics at the sensor"),
    "energy": ("J", "energy that friction dissipates in a cycle"),
    "slipping": ("1", "cells that slip, all patches"),
    "cycles": ("1", "cycles until the energy had settled"),
}


@brief
@dataclass
class Response(Numbers):
    """Numbers over frequency, each an array: frequency, amplitude, phase, ... (RESPONSE).

    Attributes
    ----------
    numbers : dict
        {name: (frequencies,)}, in the units of RESPONSE.
    motion : ndarray
        Harmonics of the modal coordinates without contact, (frequencies, harmonics, modes), complex, m kg^0.5.
    patches : ndarray
        Dissipated energy of a cycle in each patch, (frequencies, patches), J.
    names : list of str
        Names of the patches.
    """

    columns = RESPONSE

    numbers: dict
    motion: np.ndarray
    patches: np.ndarray
    names: list

    def lines(self) -> list[str]:
        """The printed table.

        Returns
        -------
        list of str
            A line of heads, and one for each frequency.
        """
        lines = [
            UNKNOWN_HERE,
            f"{'f/Hz':>11} {'amplitude/m':>12} {'phase/deg':>9} {'higher/m':>10} {self._head('W', 'J'):>10} "
            f"{'slip':>6} cycles",
        ]
        for k in range(len(self.frequency)):
            lines.append(
                f"{self.frequency[k]:11.6g} {self.amplitude[k]:12.4e} {np.degrees(self.phase[k]):9.2f} "
                f"{self.higher[k]:10.2e} {self.energy[k]:10.3e} {self.slipping[k]:6.0f} {self.cycles[k]:6.0f}"
            )
        return lines

    def more_columns(self) -> list[Column]:
        """The energy of each patch.

        Returns
        -------
        list of tables.Column
            A column for each patch, J.
        """
        return energies(self.patches, self.names)


@of_vibrations
def forced(
    structure: Structure, force: ArrayLike, frequencies: ArrayLike, sensor: ArrayLike, steps: int = 2 * STEPS,
    harmonics: int = 3, report: Optional[Callable[[int, int], object]] = None,
) -> Response:  # fmt: skip
    """The Response of a structure in its preload to a harmonic force, frequency after frequency.

    Parameters
    ----------
    force : array of shape (modes,)
        Modal force, N times the displacement of its place by each modal coordinate.
    frequencies : array of shape (k,)
        Hz, in the order in which they are computed: each begins from what the one before has found.
    sensor : array of shape (modes,)
        Displacement of the sensor by each modal coordinate.
    harmonics : int
        Number of harmonics that are balanced.
    report : callable, optional
        Called with the number of frequencies that are done, and of all.

    Returns
    -------
    Response
    """
    balance = Balance(structure, 1, steps, harmonics)
    force, sensor = (modal(name, one, structure.modes) for name, one in (("force", force), ("sensor", sensor)))
    frequencies = positive("frequencies", frequencies, "numbers above 0, Hz")
    rows, motions, patches = [], [], []
    respond = lambda frequency: balance.respond(force, 2.0 * np.pi * frequency)  # noqa: E731
    place = lambda frequency: f"{frequency:.6g} Hz"  # noqa: E731
    for frequency, (motion, cycle) in solved(frequencies, respond, place, report):
        moves = motion @ balance.shapes.T
        moved = moves @ sensor
        rows.append(
            [frequency, abs(moved[0]), np.angle(moved[0]), np.abs(moved[1:]).sum(), cycle.energies.sum()]
            + [cycle.slipping, balance.least]
        )
        motions.append(moves)
        patches.append(cycle.energies)
    numbers = {name: np.array(column) for name, column in zip(RESPONSE, np.transpose(rows))}
    found = Response(numbers, np.array(motions), np.array(patches), structure.names)
    found.per_metre = structure.per_metre
    return found


def peak(harmonics):
    """Angle at which a periodic function is largest."""
    order = np.arange(1, len(harmonics) + 1)
    angles = 2.0 * np.pi * np.arange(32 * len(harmonics)) / (32 * len(harmonics))
    angle = angles[np.argmax(np.real(harmonics @ np.exp(1j * order[:, None] * angles)))]
    for _ in range(4):  # Newton's method
        slope, bend = (np.real((1j * order) ** k * harmonics @ np.exp(1j * order * angle)) for k in (1, 2))
        angle -= slope / min(bend, -0.1 * abs(harmonics[0])) if harmonics[0] else 0.0
    return angle


def _real(values):
    return np.concatenate([values.real.ravel(), values.imag.ravel()])


def _complex(values, shape):
    real, imaginary = np.split(values, 2)
    return (real + 1j * imaginary).reshape(shape)


def _updated(inverse: np.ndarray, moved: np.ndarray, changed: np.ndarray) -> np.ndarray:
    """Returns the inverse (n, n) of slopes, updated by Broyden's rule, from their inverse, the step of the unknowns and
    the change of the values, (n,)."""
    turned = inverse @ changed
    return inverse + np.outer(moved - turned, moved @ inverse) / (moved @ turned)
