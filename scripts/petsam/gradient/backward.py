"""Gradients of a number of a recorded history by all of its parameters, in one pass back over the steps."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional, Union

import numpy as np

from ..core.errors import Error, there_are
from .adjoint import Sets, System, borders, sets_of
from .halfspace import MODULI, by_moduli
from .tape import LOADS, WAYS, Tape

NORM = 8.0  # power of the norm of the pressure
BORDER = 1e-7  # of the pressure, or the bound, within which a cell is on the border of its set


class OneSidedWarning(UserWarning):
    """A gradient where cells are on the border of their set: it holds to one side."""


@dataclass
class Gradient:
    """The derivatives of a number; see of().

    Attributes
    ----------
    name : str
        Of the number.
    value : float
        The number itself: J, N, N m, m, rad or Pa.
    gap : ndarray
        By the separation of the undeformed bodies in each cell, (ny, nx), per m.
    friction : ndarray
        By the coefficient of friction in each cell, (ny, nx); their sum is that by the coefficient.
    loads, displacements : dict
        {name: derivatives by this load, or displacement, of each step, (steps,)} of the given ones.
    moduli : dict
        {name: derivative} by body1_young (per Pa), body1_poisson, body2_young, body2_poisson.
    borders : int
        Cells on the border of their set in some step; the gradient is one-sided if there are any.
    residual : float
        Largest relative residual of the adjoint systems.
    """

    name: str
    value: float
    gap: np.ndarray
    friction: np.ndarray
    loads: dict
    displacements: dict
    moduli: dict
    borders: int
    residual: float

    def __getitem__(self, name: str) -> Union[float, np.ndarray]:
        """A derivative by the name of its parameter: gap, friction, load_tx, disp_x, body1_young, ..."""
        every = {"gap": self.gap, "friction": self.friction, **self.loads, **self.displacements, **self.moduli}
        if name not in every:
            raise Error(f"gradient: {name}: there is no derivative by it{there_are(name, list(every))}")
        return every[name]


class _Objective:
    """What an objective adds in each step: its value, and its derivatives."""

    def __init__(self, tape: Tape, steps: range, sets: Sequence[Sets]) -> None:
        self.tape, self.steps, self.sets = tape, steps, sets
        shape = tape.friction.shape
        count = len(tape.records)
        self.by_pressure = np.zeros((count, *shape))
        self.by_shear = np.zeros((count, 2, *shape))
        self.by_ds = np.zeros((count, 2, *shape))
        self.by_way = np.zeros((count, 6))
        self.by_friction = np.zeros(shape)
        self.value = 0.0


def _energy(o, _):
    """Frictional work: the mean of the bounds before and after the step times the slip, where cells slip."""
    tape = o.tape
    for k in o.steps:
        sets, now, mu = o.sets[k], tape.records[k].pressure, tape.friction
        before, share = (tape.records[k - 1].pressure, 0.5) if k else (now, 0.0)
        mean = share * before + (1 - share) * now
        o.value += float(np.sum(mu * mean * sets.length)) * tape.area
        unit = np.divide(sets.ds, sets.length, out=np.zeros_like(sets.ds), where=sets.length > 0)
        o.by_ds[k] += tape.area * mu * mean * unit
        o.by_pressure[k] += tape.area * mu * (1 - share) * sets.length
        if k:
            o.by_pressure[k - 1] += tape.area * mu * share * sets.length
        o.by_friction += tape.area * mean * sets.length


def _load(o, name):
    i, tape = LOADS.index(name), o.tape
    for k in o.steps:
        record = tape.records[k]
        if i < 3:
            o.by_pressure[k] += tape.motions[0][i] * tape.area
            o.value += float(np.sum(tape.motions[0][i] * record.pressure)) * tape.area
        else:
            o.by_shear[k] += tape.motions[1][i - 3] * tape.area
            o.value += float(np.sum(tape.motions[1][i - 3] * record.shear)) * tape.area


def _way(o, name):
    i, tape = WAYS.index(name), o.tape
    for k in o.steps:
        o.by_way[k, i] += 1.0
        o.value += float(tape.ways[k, i])


def _norm(o, _):
    """(sum p^r dA)^(1/r) of the last of the steps."""
    k, tape = o.steps[-1], o.tape
    p = tape.records[k].pressure
    o.value = float(p.max() * (np.sum((p / p.max()) ** NORM) * tape.area) ** (1 / NORM))
    o.by_pressure[k] += (p / o.value) ** (NORM - 1) * tape.area


OBJECTIVES = {
    "energy": _energy, "pressure_norm": _norm, **dict.fromkeys(LOADS, _load), **dict.fromkeys(WAYS, _way),
}  # fmt: skip


def of(tape: Tape, name: str, steps: Optional[slice] = None, rtol: float = 1e-6) -> Gradient:
    """The derivatives of a number by all parameters, in one pass back over the steps.

    Parameters
    ----------
    tape : Tape
        The recorded history, see record().
    name : str
        "energy", the frictional work of the steps (J); a load that is given by its displacement, or a displacement that
        is given by its load, summed over the steps; "pressure_norm", (sum p^8 dA)^(1/8) of the last of the steps, a
        smooth maximum.
    steps : slice, optional
        The steps, from 0; None: all for the energy, else the last.
    rtol : float
        Relative residual of the adjoint systems.

    Returns
    -------
    Gradient

    Raises
    ------
    Error
        If there is no such number, it has no derivative, or a system does not converge.

    Warns
    -----
    OneSidedWarning
        If cells are on the border of their set.

    Notes
    -----
    The derivative is that of the number on this grid, whose sets of cells are frozen: where a cell changes from stick
    to slip, or comes into contact, it jumps by that cell's share. Areas, counts of cells and maxima over cells have no
    derivative.
    """
    if name not in OBJECTIVES:
        why = ": it is a count of cells, piecewise constant" if name.endswith("area") else ""
        why = ": a maximum over cells has kinks; take pressure_norm" if name.endswith("_max") else why
        raise Error(f"gradient: {name}{why}: expected {', '.join(OBJECTIVES)}")
    _check_given(tape, name)
    return _Backward(tape, _objective(tape, name, steps), rtol).run(name)


def value_of(tape: Tape, name: str, steps: Optional[slice] = None) -> float:
    """The number itself, without its derivatives: see of().

    Parameters
    ----------
    tape : Tape
    name : str
    steps : slice, optional

    Returns
    -------
    float
        J, N, N m, m, rad or Pa.
    """
    return _objective(tape, name, steps).value


def _objective(tape, name, steps):
    """What the number adds in each step."""
    count = len(tape.records)
    chosen = range(count)[steps if steps is not None else slice(None) if name == "energy" else slice(-1, None)]
    if not len(chosen):
        raise Error(f"gradient: {name}: there is no such step among {count}")
    objective = _Objective(tape, chosen, [sets_of(tape, k) for k in range(count)])
    OBJECTIVES[name](objective, name)
    return objective


def _check_given(tape, name):
    given = tape.records[0].loads
    if name in LOADS and given[LOADS.index(name)]:
        raise Error(f"gradient: {name} is given: take {WAYS[LOADS.index(name)]}")
    if name in WAYS and not given[WAYS.index(name)]:
        raise Error(f"gradient: {name} is given: take {LOADS[WAYS.index(name)]}")


class _Backward:
    """The pass back."""

    def __init__(self, tape: Tape, objective: _Objective, rtol: float) -> None:
        self.tape, self.objective, self.rtol = tape, objective, rtol
        shape, count = tape.friction.shape, len(tape.records)
        self.gap, self.friction = np.zeros(shape), objective.by_friction.copy()
        self.by_load, self.by_way = np.zeros((count, 6)), np.zeros((count, 6))
        self.constants, self.borders, self.residual = np.zeros(3), 0, 0.0

    def run(self, name: str) -> Gradient:
        """The gradient."""
        left = np.zeros((2, *self.gap.shape))
        for k in range(len(self.tape.records) - 1, -1, -1):
            left = self._step(k, left)
        tape, loads = self.tape, self.tape.records[0].loads
        if self.borders:
            warnings.warn(
                f"gradient of {name}: {self.borders} cells are on the border of their set: it holds to one side",
                OneSidedWarning,
                stacklevel=3,
            )
        moduli = dict(zip(MODULI, (self.constants @ by_moduli(tape.bodies)).tolist()))
        return Gradient(
            name, self.objective.value, tape.whole(self.gap), tape.whole(self.friction),
            {LOADS[i]: self.by_load[:, i] for i in range(6) if loads[i]},
            {WAYS[i]: self.by_way[:, i] for i in range(6) if not loads[i]}, moduli, self.borders, self.residual,
        )  # fmt: skip

    def _step(self, k, left):
        """Adds what step k gives to the derivatives; returns what it leaves for the slip of the step before."""
        tape, o = self.tape, self.objective
        record, sets = tape.records[k], o.sets[k]
        later = left + o.by_ds[k]  # V
        system = System(tape, record, sets, self.rtol)
        u_z, u_t = tape.influence(np.zeros_like(later[0]), later)
        shear = o.by_shear[k] + u_t
        right = system.rows_of(o.by_pressure[k] + u_z, shear)
        given = system.given
        motion = [np.sum(system.motion(i)[1] * later) for i in given]
        loads = np.array([moved - o.by_way[k, i] if i >= 3 else -o.by_way[k, i] for moved, i in zip(motion, given)])
        x, multipliers, residual = system.solve(right, loads)
        gamma, tau = -x[0], later - x[1:]
        forces = np.zeros(6)
        forces[given] = multipliers / tape.area
        r_z, r_t = tape.influence(gamma, tau)
        rest = o.by_shear[k] + r_t - np.tensordot(forces[3:] * tape.area, tape.motions[1], axes=1)
        beta = np.where(sets.slip, np.sum(sets.along * rest, axis=0), 0.0)
        self._read(k, gamma, tau, beta, forces)
        self.residual = max(self.residual, residual)
        self.borders += borders(tape, k, sets, BORDER)
        return x[1:] - o.by_ds[k]

    def _read(self, k, gamma, tau, beta, forces):
        tape, record = self.tape, self.tape.records[k]
        self.gap += gamma
        self.friction += record.pressure * beta
        self.by_load[k] = forces
        for i in range(3):
            self.by_way[k, i] = -np.sum(tape.motions[0][i] * gamma)
            self.by_way[k, i + 3] = -np.sum(tape.motions[1][i] * tau)
        u_z, u_t = tape.influence.parts(record.pressure, record.shear)
        self.constants += np.tensordot(u_z, gamma, axes=2) + np.tensordot(u_t, tau, axes=3)
