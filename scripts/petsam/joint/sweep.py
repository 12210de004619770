"""The cycles of a structure that is loaded along one of its modes: Sweep."""

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.linalg import norm

from ..errors import Error
from ..results import SLIP
from .arguments import integer
from .structure import Structure

STEPS = 8  # load steps of a half cycle
SETTLED = 1e-3  # change of the energy from one cycle to the next at which it counts as settled
CYCLES = 12  # largest number of cycles of an amplitude
FEW_MODES = 1e-3  # change of the frequency without a quarter of the modes


class BackboneWarning(UserWarning):
    """Numbers of a backbone that the grid, the patch or the method does not give."""


@dataclass
class Cycle:
    """One cycle.

    moved     modal coordinates of each step
    reach     change of the modal coordinates from one reversal to the other
    energies  dissipated energy in each patch, J
    loop      that of the loop of forces and displacements, J
    states    the field state of each patch before the reversal: 0 open, 1 stick, 2 slip
    given     what each step prescribed and the coordinates that it found, for each patch {name: value}
    """

    moved: np.ndarray
    reach: np.ndarray
    energies: np.ndarray
    loop: float
    states: list
    given: list

    @property
    def slipping(self):
        """Number of cells that slip, in all patches."""
        return int(sum(np.sum(state == SLIP) for state in self.states))


@dataclass
class Point:
    """A mode at one amplitude: modal force, amplitude and squared angular frequency, damping, its cycle, and how many
    cycles it took to settle."""

    alpha: float
    modal: float
    omega2: float
    damping: float
    cycle: Cycle
    cycles: int


def settled(one, before):
    """True if a cycle repeats the one before."""
    now, then = one.energies.sum(), before.energies.sum()
    return abs(now - then) <= SETTLED * now and norm(one.reach - before.reach) <= SETTLED * norm(one.reach)


class Sweep:
    """The cycles of a structure along one of its stuck modes, from the preload in which the structure is."""

    def __init__(self, structure, mode=1, steps=STEPS):
        if not isinstance(structure, Structure):
            raise Error(f"structure: expected a Structure, such as a Pair's structure, not {type(structure).__name__}")
        mode, self.steps = integer("mode", mode), integer("steps", steps)
        self.preload, self.work = structure, structure.copy()
        self.tangent = structure.tangent()
        self.omegas, self.shapes = structure.stuck_modes(self.tangent)  # rad/s; in modal coordinates, as columns
        if mode > len(self.omegas):
            raise Error(f"mode {mode}: the structure has modes 1 to {len(self.omegas)}")
        self.omega, self.shape = self.omegas[mode - 1], self.shapes[:, mode - 1]
        self.unit = structure.respond(self.tangent, self.shape)
        self.reversed = structure.respond_to(self.tangent)
        self._warn_of_mode(mode)
        self.modes_change = self._compare(mode)

    def _compare(self, mode):
        """Relative change of the frequency without the inertia of a quarter of the elastic modes; NaN: too few."""
        fewer = self.preload.omega.size // 4
        if not fewer or mode > self.preload.modes - fewer:
            return float("nan")
        change = float(self.preload.stuck_modes(self.tangent, fewer)[0][mode - 1] / self.omega - 1.0)
        if abs(change) > FEW_MODES:
            warnings.warn(
                f"without the highest {fewer} modes mode {mode} changes its frequency by {change:.1e}: use more "
                "--modes of petsam-compliance",
                BackboneWarning,
                stacklevel=4,
            )
        return change

    def _warn_of_mode(self, mode):
        alone = (
            self.preload.omega[np.argmin(np.abs(self.preload.omega - self.omega))] if self.preload.omega.size else 0.0
        )
        if abs(alone - self.omega) <= 1e-6 * self.omega:
            warnings.warn(
                f"mode {mode} of {self.omega / (2 * np.pi):.6g} Hz is one without contact: it does not move the "
                "patches, and friction does not damp it; take another mode",
                BackboneWarning,
                stacklevel=4,
            )

    def follow(self, forces, scale):
        """Steps under these modal forces, beside those of the preload; returns modal coordinates and energies of each
        step, and what it prescribed and found."""
        found, energies, given, response = [], [], [], self.reversed
        for force in forces:
            response = self.work.step(self.preload.force + force, response=response, scale=scale)
            found.append(self.work.modal(self.work.force, self.work.loads, self.work.a))
            energies.append([patch.number("dissipated_energy") for patch in self.work.patches])
            given.append([patch.given for patch in self.work.patches])
        return np.array(found), np.array(energies), given

    def scale_of(self, alpha):
        """Changes of coordinates, loads and motions by a modal force, to which the tolerance of steps is relative."""
        return tuple(alpha * np.abs(one) for one in self.unit)

    def repeat(self, rise, halves, scale, least=2):
        """Goes from the preload along the forces `rise`, then through cycles of two halves until they repeat, at least
        so many; returns the last one, and their number."""
        self.work.take(self.preload)
        last, before = self.follow(rise, scale)[0][-1], None
        forces = np.concatenate([rise[-1:], *halves])
        for count in range(1, CYCLES + 1):
            down, lost, given = self.follow(halves[0], scale)
            states = [patch.contact.field("state") for patch in self.work.patches]
            back, more, rest = self.follow(halves[1], scale)
            path = np.concatenate([[last], down, back])
            loop = -0.5 * float(np.sum((path[1:] + path[:-1]) * np.diff(forces, axis=0)))
            one = Cycle(path[1:], back[-1] - down[-1], (lost + more).sum(axis=0), loop, states, given + rest)
            last = back[-1]
            if count >= least and settled(one, before):
                break
            before = one
        return one, count

    def point(self, amplitude):
        """The Point whose modal force gives this modal amplitude while all that touches sticks."""
        return self.under(self.omega**2 * amplitude)

    def under(self, alpha):
        """The Point under a modal force."""
        rise, *halves = (
            alpha * np.outer(np.linspace(*ends, self.steps + 1)[1:], self.shape) for ends in ((0, 1), (1, -1), (-1, 1))
        )
        one, count = self.repeat(rise, halves, self.scale_of(alpha))
        reach = float(one.reach @ self.shape)
        damping = float(one.energies.sum()) / (np.pi * alpha * reach)
        return Point(alpha, 0.5 * reach, 2.0 * alpha / reach, damping, one, count)
