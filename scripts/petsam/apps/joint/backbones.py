"""Frequency and damping of a mode over its amplitude: quasi-static modal analysis of a Structure, or harmonic balance.

The structure is loaded by alpha M phi_0, phi_0 being a mode while all that touches sticks. With q = phi_0'M u of a
closed cycle between +alpha and -alpha, and W, what all patches dissipate in it,

    w^2 = 2 alpha/(q_max - q_min)      zeta = W/(pi alpha (q_max - q_min))      A = (q_max - q_min)/2

(R. M. Lacayo, M. S. Allen, Mech. Syst. Signal Process. 118 (2019) 133). Each amplitude begins from the same preload.
Its cycle is repeated until energy and loop do not change, as contacts shake down first. Harmonic balance is in
balance.py.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from ...core.brief import brief
from ...core.errors import Unusable
from ...core.tables import Column
from .arguments import integer, positive
from .arguments import modal as as_modal
from .balance import Balance
from .numbers import UNKNOWN_HERE, Numbers, energies, solved
from .structure import Structure
from .sweep import CYCLES, STEPS, BackboneWarning, Sweep, of_vibrations

UNMOVED = 1e-6  # displacement of a sensor that is rounding, relative to those by the modes
LISTED = 6  # modes in the table
FEW = 0.1  # relative error of the energy above which its cells are too few
ERROR = 10.0  # its error times the number of slipping cells, about: Mindlin's sphere, a synthetic pair
ERROR_ROW = 0.5  # the same in plane strain, at most: cylinders whose T turns between 0.02 and 0.4 of the limit
MODAL = "m kg^0.5"
COLUMNS = {
    "alpha": ("m/s2 kg^0.5", "modal force"),
    "modal_amplitude": ("m kg^0.5", "modal amplitude"),
    "amplitude": ("m", "displacement at the sensor"),
    "acceleration": ("m/s2", "acceleration at the sensor"),
    "frequency": ("Hz", "frequency"),
    "damping": ("1", "damping by friction, as a part of critical damping"),
    "viscous": ("1", "damping of the material, as a part of critical damping"),
    "energy": ("J", "dissipated energy of a cycle"),
    "loop": ("J", "energy of the loop of force and displacement"),
    "slipping": ("1", "cells that slip, all patches"),
    "cycles": ("1", "cycles until the energy had settled"),
    "unresolved": ("1", "damping by friction below which it is not resolved; 0 where it is"),
    "damping_error": ("1", "estimated error of damping by cells and steps of the contacts, with -errors companion"),
}


@brief
@dataclass
class Backbone(Numbers):
    """Numbers over amplitude, each an array: alpha, amplitude, frequency, damping ... (COLUMNS).

    Attributes
    ----------
    linear : float
        Frequency (Hz) of the mode while all that touches sticks.
    shape : ndarray
        The mode in modal coordinates, (modes,).
    numbers : dict
        {name: (amplitudes,)}, in the units of COLUMNS.
    patches : ndarray
        Dissipated energy of a cycle in each patch, (amplitudes, patches), J.
    names : list of str
        Names of the patches.
    modes_change : float
        Relative change of `linear` without the inertia of the highest quarter of the structure's modes; NaN where there
        are fewer than four.
    stuck : ndarray
        Frequencies of all modes while all that touches sticks, (modes,), Hz.
    unit : str
        Of the amplitude: m at a sensor, m kg^0.5 of the modal one.
    pressure : list of ndarray
        Field of each patch in the preload, (ny, nx), Pa.
    states : list of ndarray
        Field of each patch at the largest amplitude, before the reversal, (ny, nx): 0 open, 1 stick, 2 slip.
    axes : list of tuple
        x and y (m) of each patch's cells, in the structure's frame.
    """

    columns = COLUMNS

    linear: float
    shape: np.ndarray
    numbers: dict
    patches: np.ndarray
    names: list
    modes_change: float
    stuck: np.ndarray
    unit: str
    pressure: list
    states: list
    axes: list

    def lines(self) -> list[str]:
        """The printed table.

        Returns
        -------
        list of str
            Frequencies of the modes, heads, and a line for each amplitude.
        """
        stuck = ", ".join(f"{one:.6g}" for one in self.stuck[:LISTED])
        lines = [UNKNOWN_HERE, f"modes while all that touches sticks, Hz: {stuck}", f"mode of {self.linear:.6g} Hz"]
        if np.isfinite(self.modes_change):
            lines.append(f"without a quarter of the structure's modes its frequency changes by {self.modes_change:.1e}")
        known = "damping_error" in self.numbers
        lines.append("")
        lines.append(
            f"{'amplitude/m':>12} {'accel./(m/s2)':>14} {'f/Hz':>11} {'zeta':>10} {self._head('W', 'J'):>10} "
            f"{'slip':>6} cycles"
            + known * f"{'zeta error':>11}"
            + (f", amplitudes are modal, in {self._unit(MODAL)}" if self.unit == MODAL else "")
        )
        for k in range(len(self.alpha)):
            below = f"{f'<{self.unresolved[k]:.1e}':>10}"
            damping = f"{self.damping[k]:10.4e}" if self.damping[k] >= self.unresolved[k] else below
            lines.append(
                f"{self.amplitude[k]:12.4e} {self.acceleration[k]:14.4e} {self.frequency[k]:11.6g} "
                f"{damping} {self.energy[k]:10.3e} {self.slipping[k]:6.0f} {self.cycles[k]:6.0f}"
                + (f"{self.damping_error[k]:11.1e}" if known else "")
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


def modal_amplitudes(sweep, amplitudes, sensor):
    """Modal amplitudes (m kg^0.5) by those at a sensor, m, or modal ones where it is None."""
    return positive("amplitudes", amplitudes, "lengths above 0") / _moved(sensor, sweep.shape)


def _moved(sensor, shape):
    """Displacement of the sensor by a unit of the mode; 1 without sensor."""
    if sensor is None:
        return 1.0
    sensor = as_modal("sensor", sensor, len(shape))
    moved = abs(float(sensor @ shape))
    if moved <= UNMOVED * np.linalg.norm(sensor) * np.linalg.norm(shape):
        raise Unusable("sensor: the mode does not move it in this direction: take another direction, sensor or mode")
    return moved


@of_vibrations
def backbone(
    structure: Structure, amplitudes: ArrayLike, mode: int = 1, sensor: Optional[ArrayLike] = None,
    steps: int = STEPS, harmonics: int = 0, report: Optional[Callable[[int, int], object]] = None,
) -> Backbone:  # fmt: skip
    """The Backbone of a structure in its preload.

    Parameters
    ----------
    amplitudes : array of shape (k,)
        Displacements (m) at the sensor of a linear mode: the forces follow from them, and the amplitudes of the
        results are larger where the joint is softer.
    harmonics : int
        0: quasi-static modal analysis; else the number of harmonics that are balanced: the resonance under a force
        along the mode, with the inertia of all modes and harmonics. The amplitudes are then those found.
    report : callable, optional
        Called with the number of amplitudes that are done, and of all.

    Returns
    -------
    Backbone
    """
    harmonics = integer("harmonics", harmonics, 0)
    sweep = Balance(structure, mode, steps, harmonics) if harmonics else Sweep(structure, mode, steps)
    modal, factor = modal_amplitudes(sweep, amplitudes, sensor), _moved(sensor, sweep.shape)
    rows, patches = [], []
    place = lambda wanted: f"an amplitude of {factor * wanted:.3g} m"  # noqa: E731
    for _, one in solved(modal, sweep.point, place, report):
        reach, energy = factor * one.modal, float(one.cycle.energies.sum())
        rows.append(
            [one.alpha, one.modal, reach, reach * one.omega2, np.sqrt(one.omega2) / (2.0 * np.pi), one.damping]
            + [structure.damping, energy, one.cycle.loop, one.cycle.slipping, one.cycles]
            + [one.unresolved, one.damping_error]
        )
        patches.append(one.cycle.energies)
        states = one.cycle.states
    numbers = {name: np.array(column) for name, column in zip(COLUMNS, np.transpose(rows))}
    if not any(patch.contact.has_errors for patch in structure.patches):
        del numbers["damping_error"]
    unit = MODAL if sensor is None else "m"
    found = Backbone(
        sweep.omega / (2.0 * np.pi),
        sweep.shape,
        numbers,
        np.array(patches),
        structure.names,
        sweep.modes_change,
        sweep.omegas / (2.0 * np.pi),
        unit,
        [patch.contact.field("pressure") for patch in structure.patches],
        states,
        [(patch.contact.x + patch.center[0], patch.contact.y + patch.center[1]) for patch in structure.patches],
    )
    found.per_metre = structure.per_metre
    _warn(found)
    return found


@of_vibrations
def shake(
    structure: Structure, amplitude: float, mode: int = 1, sensor: Optional[ArrayLike] = None, steps: int = STEPS
) -> None:
    """Vibrates a structure at an amplitude, as of backbone(), until its cycles settle, and lets it come to rest in four
    cycles; its state is then that after the vibration.

    Parameters
    ----------
    amplitude : float
        Of the vibration, as of backbone(), m.
    """
    sweep = Sweep(structure, mode, steps)
    point = sweep.point(float(modal_amplitudes(sweep, [amplitude], sensor)[0]))
    ends = 0.125 * np.arange(8.0, -1.0, -1.0) * (-1.0) ** np.arange(9)
    parts = np.concatenate([np.linspace(*two, steps + 1)[1:] for two in zip(ends, ends[1:])])
    sweep.follow(point.alpha * np.outer(parts, sweep.shape), sweep.scale_of(point.alpha))
    structure.take(sweep.work)


def _warn(found):
    """Warns of damping by few cells, unless its error is known, and of cycles that do not settle."""
    error = ERROR_ROW if found.per_metre else ERROR
    few = found.slipping < error / FEW
    if np.any(few) and "damping_error" not in found.numbers:
        least, last = found.slipping[few].min(), found.amplitude[few].max()
        most = f"{100.0 * error / least:.0f} %" if least > error else "all of it"
        warnings.warn(
            f"up to an amplitude of {last:.3g} m fewer than {error / FEW:.0f} cells slip, at least {least:.0f}: "
            f"damping there has an error of up to about {most}; use a finer grid",
            BackboneWarning,
            stacklevel=3,
        )
    moving = found.cycles >= CYCLES
    if np.any(moving):
        warnings.warn(
            f"at an amplitude of {found.amplitude[moving][0]:.3g} m the energy of a cycle still changes after {CYCLES} "
            "cycles: the joint shakes down slowly, or the amplitude is within the tolerance of the contact",
            BackboneWarning,
            stacklevel=3,
        )
