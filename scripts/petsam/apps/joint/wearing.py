"""The effect of wear on a joint: frequency and damping of a mode over the cycles of a vibration.

The joint vibrates at a given modal force. Its settled cycle prescribes the steps of each patch, whose contact wears
over many of them. Then the structure finds its equilibrium anew, as worn patches unload the bolts. Within one part of
the simulation the loads of the patches and the motions of the bodies stay; the result with half the number of parts
gives an estimate of the error. The cycles until each part's vibration has settled wear too, but are not counted.
"""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from ...contact.errors import ContactError
from ...core.brief import brief
from ...core.errors import Unusable
from ...core.tables import Column
from .arguments import array
from .backbones import modal_amplitudes
from .failures import ENDS, NoSolution
from .numbers import UNKNOWN_HERE, Numbers, reason
from .patch import DISPLACEMENTS
from .structure import Structure
from .sweep import STEPS, Sweep, of_vibrations

PARTS = 2  # parts of each span of cycles
WEAR = {
    "cycles": ("1", "cycles of the vibration"),
    "frequency": ("Hz", "frequency at the amplitude of the vibration"),
    "frequency_error": ("Hz", "its error by the number of parts, estimated"),
    "damping": ("1", "damping by friction there, as a part of critical damping"),
    "damping_error": ("1", "its error by the number of parts, estimated"),
    "energy": ("J", "dissipated energy of a cycle"),
    "volume": ("m3", "worn volume of both bodies, all patches"),
}


@brief
@dataclass
class Wear(Numbers):
    """Numbers over the cycles of a vibration, each an array: cycles, frequency, damping, ... (WEAR).

    Attributes
    ----------
    numbers : dict
        {name: (1 + k,)} at 0 cycles and at the k wanted numbers of them, in the units of WEAR.
    measured : dict
        {name: (1 + k,)} of what `measure` returned there, such as the tension of the bolts.
    structures : list of Structure
        Copies of the structure at rest, at each number of cycles, for backbone().
    """

    columns = WEAR

    numbers: dict
    measured: dict
    structures: list

    def lines(self) -> list[str]:
        """The printed table.

        Returns
        -------
        list of str
            A line of heads, and one for each number of cycles.
        """
        heads = "".join(f" {_shown(one):>12}" for one in self._measured())
        lines = [
            UNKNOWN_HERE,
            f"{'cycles':>10} {'f/Hz':>13} {'+-':>8} {'zeta':>10} {'+-':>8} {self._head('W', 'J'):>10} "
            f"{self._head('volume', 'm3'):>10}{heads}",
        ]
        for k in range(len(self.cycles)):
            lines.append(
                f"{self.cycles[k]:10.4g} {self.frequency[k]:13.8g} {self.frequency_error[k]:8.1e} "
                f"{self.damping[k]:10.4e} {self.damping_error[k]:8.1e} {self.energy[k]:10.3e} {self.volume[k]:10.3e}"
                + "".join(f" {values[k]:12.6g}" for values in self.measured.values())
            )
        return lines

    def more_columns(self) -> list[Column]:
        """The values that `measure` returned.

        Returns
        -------
        list of tables.Column
            A column for each name.
        """
        return [one._replace(unit=one.unit or "1") for one in self._measured()]

    def _measured(self):
        """Their columns, with the unit "" where a name states none."""
        return [Column.headed(name, "measured after the cycles", values) for name, values in self.measured.items()]


def _shown(one):
    """The head of a printed column."""
    return f"{one.name}/({one.unit})" if "/" in one.unit else "/".join(filter(None, (one.name, one.unit)))


@of_vibrations
def wear(  # noqa: PLR0913  (as the options of petsam-joint wear)
    structure: Structure, amplitude: float, cycles: ArrayLike, mode: int = 1, sensor: Optional[ArrayLike] = None,
    steps: int = STEPS, measure: Optional[Callable[[Structure], dict]] = None,
    report: Optional[Callable[[int, int], object]] = None,
) -> Wear:  # fmt: skip
    """The Wear of a structure in its preload, whose contacts have the options of wear.

    Parameters
    ----------
    amplitude : float
        Of the vibration, as of backbone(); its modal force stays the same.
    cycles : array of shape (k,)
        Rising whole numbers of cycles at which the numbers are wanted, the first above 0.
    measure : callable, optional
        Returns, as measure(structure), {name: number} of a structure at rest, such as Pair.left; a name may have its
        unit: B1 [N].
    report : callable, optional
        Called with the number of vibrations that are computed, and of all.

    Returns
    -------
    Wear
    """
    cycles = np.atleast_1d(array("cycles", cycles, "rising whole numbers above 0"))
    if not (cycles.size and rising(cycles)):
        raise Unusable("cycles: expected rising whole numbers above 0")
    first = Sweep(structure, mode, steps)
    if not any(_wears(patch) for patch in structure.patches):
        raise Unusable(
            "no contact wears: give -wear_coefficient1, -wear_coefficient2, -wear_energy1 or -wear_energy2 among its "
            "options"
        )
    measure = measure or (lambda _: {})
    modal = float(modal_amplitudes(first, [amplitude], sensor)[0])
    alpha = first.omega**2 * modal
    spans = np.diff(cycles, prepend=0.0)
    total, done = sum(1 + sum(len(_parts(span, count)) for span in spans) for count in (PARTS, 1)), itertools.count(1)
    ended = (lambda: report(next(done), total)) if report else (lambda: None)
    given = alpha, cycles, (mode, steps), (measure, ended)
    rows, measured, structures = _run(structure.copy(), *given, PARTS)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # those of the run with all parts
        coarse = _run(structure.copy(), *given, 1)
    for name in ("frequency", "damping"):
        rows[f"{name}_error"] = np.abs(rows[name] - coarse[0][name])
    found = Wear({"cycles": np.append(0.0, cycles), **rows}, measured, structures)
    found.per_metre = structure.per_metre
    return found


def _wears(patch):
    """True if the options of a patch's contact have wear."""
    try:
        patch.number("wear_volume1")
    except ContactError:
        return False
    return True


def rising(cycles):
    """True if these are rising whole numbers above 0."""
    whole = np.isfinite(cycles) & (cycles == np.floor(cycles))
    return bool(np.all(whole) and np.all(np.diff(cycles, prepend=0.0) > 0.0))


def _parts(span, count):
    """A span of cycles in so many parts of whole numbers, less where there are fewer cycles."""
    return [one for one in np.diff(np.floor(span * np.linspace(0.0, 1.0, count + 1))) if one > 0.0]


def _run(structure, alpha, cycles, how, told, parts):
    """Numbers, what was measured and structures at 0 and all `cycles`, each span of which has so many parts. told are
    what measures a structure, and what is called after each vibration."""
    measure, ended = told
    points, volumes, measured, structures = [], [0.0], [], []

    def vibrating():
        sweep = Sweep(structure, *how)
        try:
            point = sweep.under(alpha)
        except ENDS as error:
            done = np.append(0.0, cycles)[len(points)]
            raise NoSolution(f"the vibration after {done:g} cycles or more: {reason(error)}") from error
        ended()
        return sweep, point

    for span in (*np.diff(cycles, prepend=0.0), None):
        structures.append(structure.copy())
        measured.append(measure(structure))
        sweep, point = vibrating()
        points.append(point)
        volumes.append(volumes[-1])
        for part, count in enumerate(_parts(span, parts) if span else []):
            if part:
                sweep, point = vibrating()
            volumes[-1] += _wear(sweep.work.patches, point.cycle.given, count)
            sweep.work.step(structure.force, response=sweep.reversed)  # comes to rest
            structure.take(sweep.work)
    rows = dict(
        frequency=np.sqrt([one.omega2 for one in points]) / (2.0 * np.pi),
        damping=np.array([one.damping for one in points]),
        energy=np.array([one.cycle.energies.sum() for one in points]),
        volume=np.array(volumes[:-1]),
    )
    return rows, {name: np.array([one[name] for one in measured]) for name in measured[0]}, structures


def _wear(patches, given, count):
    """Wears patches over `count` cycles of the given steps; returns the worn volume, m3."""
    volume = 0.0
    for k, patch in enumerate(patches):
        history = _history([given[-1][k], *(one[k] for one in given)])  # closed
        history["time"] = patch.contact.number("time") + np.arange(len(given) + 1)
        lived = patch.contact.live(count, history)
        for name in ("volume1", "volume2"):  # of all wear of the contact
            volume += getattr(lived[-1], name) - getattr(lived[0], name)
    return volume


def _history(steps):
    """Returns {column: values} of a patch's steps: loads, and displacements whose loads some steps lack, as steps that
    slide may."""
    names = set.intersection(*(set(one) for one in steps))
    names -= {moved for moved, load in DISPLACEMENTS.items() if load in names}
    return {name: np.array([one[name] for one in steps]) for name in sorted(names)}
