"""The cycles of a structure that is loaded along one of its modes: Sweep."""

import functools
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.linalg import norm

from ...core.brief import brief
from ...core.errors import Unusable
from ...core.keywords import unfolded
from ...results.fields import SLIP
from .arguments import integer
from .structure import Structure

STEPS = 8  # load steps of a half cycle
SETTLED = 1e-3  # change of the energy from one cycle to the next at which it counts as settled
CYCLES = 12  # largest number of cycles of an amplitude
SMALL = 0.5  # changes of the loads over those of the preload below which the contacts' tolerances are smaller
RTOL = 1e-6, 1e-12  # -tangential_rtol at these, and the least that rounding allows
UNLIKE = 0.75  # difference of a cycle's energy and its loop, a polygon inside of it, above which they are rounding
FEW_MODES = 1e-3  # change of the frequency without a quarter of the modes
COMMON = """Parameters and errors of the functions of a structure that vibrates.

Parameters
----------
structure : Structure
    A structure, or that of a Pair, in its preload.
mode : int
    Number of the mode, from 1, by rising frequency while all that touches sticks.
sensor : array of shape (modes,), optional
    Displacement of the sensor by each modal coordinate; None: amplitudes are modal (m kg^0.5).
steps : int
    Load steps of a half cycle.

Raises
------
Error
    For wrong values, and where the structure finds no equilibrium.
"""
of_vibrations = functools.partial(unfolded, common=COMMON)


class BackboneWarning(UserWarning):
    """Numbers of a backbone that the grid, the patch or the method does not give."""


@brief
@dataclass
class Cycle:
    """One cycle.

    moved     modal coordinates of each step
    reach     change of the modal coordinates from one reversal to the other
    energies  dissipated energy in each patch, J; 0 where it is not resolved
    noise     energy below which it is not resolved, J; 0 where it is
    error     estimated error of the energies' sum, J; NaN: unknown
    loop      that of the loop of forces and displacements, J
    states    the field state of each patch before the reversal: 0 open, 1 stick, 2 slip
    given     what each step prescribed and the coordinates that it found, for each patch {name: value}
    """

    moved: np.ndarray
    reach: np.ndarray
    energies: np.ndarray
    noise: float
    error: float
    loop: float
    states: list
    given: list

    @property
    def slipping(self):
        """Number of cells that slip, in all patches."""
        return int(sum(np.sum(state == SLIP) for state in self.states))


@dataclass
class Point:
    """A mode at one amplitude: modal force, amplitude and squared angular frequency, damping by a unit of energy, its
    cycle, and how many cycles it took to settle."""

    alpha: float
    modal: float
    omega2: float
    damped: float
    cycle: Cycle
    cycles: int

    @property
    def damping(self):
        """By friction, as a part of critical."""
        return float(self.cycle.energies.sum()) * self.damped

    @property
    def damping_error(self):
        """Estimated error of the damping by the contacts' cells and steps; NaN: unknown."""
        return self.cycle.error * self.damped

    @property
    def unresolved(self):
        """Damping below which it is not resolved; 0 where it is."""
        return self.cycle.noise * self.damped


def settled(one, before):
    """True if a cycle repeats the one before."""
    now, then = one.energies.sum(), before.energies.sum()
    return abs(now - then) <= SETTLED * now and norm(one.reach - before.reach) <= SETTLED * norm(one.reach)


def _pressed(contact):
    """Work of a contact's normal load by its stiffness, J."""
    stiffness = contact.stiffness(reversal=True)[0, 0]
    return contact.number("load_n") ** 2 / stiffness if stiffness > 0.0 else 0.0


def _resolved(energies, slides, loop, steps):
    """Energies of the patches, 0 where it is rounding, and the size of that.

    No energy is lost where no cell slips. Cells that just come to their limit lose one that the contact's tolerance
    gives, unlike the loop of forces and displacements.
    """
    noise = float(np.abs(energies[~slides]).sum())
    lost = np.where(slides, energies, 0.0)
    if steps > 1 and abs(lost.sum() - loop) > UNLIKE * abs(lost.sum()):
        return np.zeros_like(lost), noise + max(float(np.abs(lost).sum()), abs(loop))
    return lost, noise


class Sweep:
    """The cycles of a structure along one of its stuck modes, from the preload in which the structure is."""

    def __init__(self, structure, mode=1, steps=STEPS):
        if not isinstance(structure, Structure):
            raise Unusable(
                f"structure: expected a Structure, such as a Pair's structure, not {type(structure).__name__}"
            )
        mode, self.steps = integer("mode", mode), integer("steps", steps)
        self.preload, self.work = structure, structure.copy()
        self.tangent = structure.tangent()
        self.sharpness = 1.0  # of the contacts' tolerances
        self.pressed = sum(_pressed(patch.contact) for patch in structure.patches)
        self.omegas, self.shapes = structure.stuck_modes(self.tangent)  # rad/s; in modal coordinates, as columns
        if mode > len(self.omegas):
            raise Unusable(f"mode {mode}: the structure has modes 1 to {len(self.omegas)}")
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
        step, the error of all energies, whether cells of a patch slip in it, and what it prescribed and found."""
        found, energies, error, slips, given, response = [], [], 0.0, [], [], self.reversed
        for force in forces:
            response = self.work.step(self.preload.force + force, response=response, scale=scale)
            found.append(self.work.modal(self.work.force, self.work.loads, self.work.a))
            energies.append([patch.number("dissipated_energy") for patch in self.work.patches])
            error += sum(patch.energy_error() for patch in self.work.patches)
            slips.append([np.any(patch.contact.field("state") == SLIP) for patch in self.work.patches])
            given.append([patch.given for patch in self.work.patches])
        return np.array(found), np.array(energies), error, np.array(slips), given

    def scale_of(self, alpha):
        """Changes of coordinates, loads and motions by a modal force, to which the tolerance of steps is relative."""
        return tuple(alpha * np.abs(one) for one in self.unit)

    def _sharpen(self, scale):
        """Contacts whose tolerances, relative to the shear that the preload allows, fit changes of this scale: the work
        of the changes over that of the preload is the square of their part of it."""
        part = min(np.sqrt(scale[0] @ scale[1] / self.pressed) / SMALL, 1.0) if self.pressed > 0.0 else 1.0
        if not 0.5 * self.sharpness < part < 5.0 * self.sharpness:
            self.sharpness = part
            self.work = self.preload.copy(tangential_rtol=max(part * RTOL[0], RTOL[1]))

    def repeat(self, rise, halves, scale, least=2):
        """Goes from the preload along the forces `rise`, then through cycles of two halves until they repeat, at least
        so many; returns the last one, and their number."""
        self._sharpen(scale)
        self.work.take(self.preload)
        last, before = self.follow(rise, scale)[0][-1], None
        forces = np.concatenate([rise[-1:], *halves])
        for count in range(1, CYCLES + 1):
            down, lost, error, slips, given = self.follow(halves[0], scale)
            states = [patch.contact.field("state") for patch in self.work.patches]
            back, more, other, slip, rest = self.follow(halves[1], scale)
            path = np.concatenate([[last], down, back])
            loop = -0.5 * float(np.sum((path[1:] + path[:-1]) * np.diff(forces, axis=0)))
            energies, slides = (lost + more).sum(axis=0), np.any(np.concatenate([slips, slip]), axis=0)
            lost, noise = _resolved(energies, slides, loop, self.steps)
            one = Cycle(path[1:], back[-1] - down[-1], lost, noise, error + other, loop, states, given + rest)
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
        return Point(alpha, 0.5 * reach, 2.0 * alpha / reach, 1.0 / (np.pi * alpha * reach), one, count)
