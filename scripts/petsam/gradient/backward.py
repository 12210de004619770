"""Gradients of a number of a recorded history by all of its parameters, in one pass back over the steps."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional, Union

import numpy as np

from ..core.errors import Error, there_are
from .adjoint import Sets, System, borders, sets_of
from .halfspace import MODULI, by_moduli
from .tape import ABSENT, BULK, LOADS, WAYS, WEAR, Tape

NORM = 8.0  # power of the norm of the pressure
# shares of the pressure before a step where slip begins in it, and where it ends with the contact; from which ratio of
# the shortest slip to the longest on a contact slides as a whole (src/contact/solution/gapandslip.c)
BEGUN, LEAVES, ALIKE = 0.25, 0.125, 0.8
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
    bulk : dict
        {name: derivatives by this bulk stress of each step, (steps,)}.
    wear : dict
        {name: derivative} by the coefficients of wear, of both bodies alike; empty without wear.
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
    bulk: dict
    wear: dict

    def __getitem__(self, name: str) -> Union[float, np.ndarray]:
        """A derivative by the name of its parameter: gap, friction, load_tx, disp_x, body1_young, ..."""
        every = {
            "gap": self.gap, "friction": self.friction, **self.loads, **self.displacements, **self.moduli,
            **self.bulk, **self.wear,
        }  # fmt: skip
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
        self.by_worn = np.zeros((count, *shape))  # by the depth worn off both bodies after a step
        self.value = 0.0
        self._rubbings: dict = {}

    def rubbing(self, k: int) -> "Rubbing":
        """How cells slide in step k."""
        if k not in self._rubbings:
            self._rubbings[k] = rubbing_of(self.tape, k, self.sets[k])
        return self._rubbings[k]

    def rubbed(self, k: int) -> np.ndarray:
        """The pressure against which cells slip in step k times the slip, Pa m."""
        rubbing, now = self.rubbing(k), self.tape.records[k].pressure
        before = self.tape.records[max(k - 1, 0)].pressure
        return (rubbing.before * before + (1 - rubbing.before) * now) * rubbing.length

    def add_rubbed(self, k: int, factor: np.ndarray) -> None:
        """Adds the derivatives of the sum over cells of a factor times rubbed()."""
        r, now, last = self.rubbing(k), self.tape.records[k].pressure, max(k - 1, 0)
        before = self.tape.records[last].pressure
        unit = np.divide(r.ds, r.length, out=np.zeros_like(r.ds), where=r.length > 0)
        self.by_ds[k] += factor * (r.before * before + (1 - r.before) * now) * unit
        self.by_pressure[k] += factor * (1 - r.before) * r.length
        self.by_pressure[last] += factor * r.before * r.length
        shift = factor * (before - now) * r.length  # by the weight
        for cell, part in r.alike:
            self.by_ds[k][(slice(None), *cell)] += np.sum(shift * r.by_alike) * part * unit[(slice(None), *cell)]
        turning = shift * r.turns  # by the part by which the slip turns round
        if not turning.any():
            return
        towards = np.divide(self.tape.records[last].shear, self.tape.friction * before, where=turning != 0,
                            out=np.zeros_like(r.ds))  # fmt: skip
        size = np.where(r.length > 0, r.length, 1.0)
        self.by_ds[k] += turning * (towards - r.back * unit) / size
        self.by_shear[last] += np.divide(turning * unit, self.tape.friction * before, where=turning != 0,
                                         out=np.zeros_like(r.ds))  # fmt: skip
        self.by_pressure[last] -= np.divide(turning * r.back, before, where=turning != 0, out=np.zeros_like(before))
        self.by_friction -= np.divide(turning * r.back, self.tape.friction, where=turning != 0,
                                      out=np.zeros_like(before))  # fmt: skip


@dataclass
class Rubbing:
    """How cells slide in a step: see rubbing_of(); (ny, nx), vectors (2, ny, nx).

    Attributes
    ----------
    ds, length : ndarray
        Slip of the step, m; 0 where no friction works.
    before : ndarray
        Weight of the pressure before the step; that after it has the rest.
    back : ndarray
        The part of its slip by which a cell turns round, from 0 to 1.
    turns, by_alike : ndarray
        Derivatives of that weight by `back`, and by the ratio of the shortest slip to the longest.
    alike : tuple
        ((row, column), derivative of that ratio by the length of the cell's slip, 1/m).
    """

    ds: np.ndarray
    length: np.ndarray
    before: np.ndarray
    back: np.ndarray
    turns: np.ndarray
    by_alike: np.ndarray
    alike: tuple = ()


def rubbing_of(tape: Tape, k: int, sets: Sets) -> Rubbing:
    """The slip of a step and its weights, as the contact has them for its work and its wear.

    Parameters
    ----------
    tape : Tape
    k : int
        The step.
    sets : Sets
        Its frozen cells.

    Returns
    -------
    Rubbing
    """
    none, now = np.zeros_like(tape.friction), tape.records[k]
    smooth = (now.state == 2) & (tape.friction == 0)  # there pressure wears without work
    if not k:
        rubs = sets.slip | smooth
        return Rubbing(np.where(rubs, now.slip, 0.0), np.where(rubs, np.hypot(*now.slip), 0.0), none, none, none, none)
    last = tape.records[k - 1]
    ds, bound = now.slip - last.slip, tape.friction * last.pressure
    length = np.hypot(*ds)
    leaves = (now.state == 0) & (last.state == 2) & (now.pressure.max() > 0)
    rubs = sets.slip | leaves | smooth
    size = bound * length
    back = np.clip(np.divide(np.sum(last.shear * ds, axis=0), size, out=none.copy(), where=size > 0), 0, 1)
    both = (now.pressure > 0) & (last.pressure > 0)
    slips = np.where(both, np.where(now.state == 1, 0.0, length), np.nan)
    ratio, cells = 0.0, ()
    if both.any() and np.nanmax(slips) > 0:
        ends = [tuple(np.unravel_index(find(slips), slips.shape)) for find in (np.nanargmin, np.nanargmax)]
        ratio = float(slips[ends[0]] / (ALIKE * slips[ends[1]]))
        if 0 < ratio < 1:
            cells = (ends[0], ratio / slips[ends[0]]), (ends[1], -ratio / slips[ends[1]])
    least = np.where(leaves, LEAVES, BEGUN)
    late = np.maximum(least, 0.5 * min(ratio, 1.0)) - 0.5
    begun = np.where(last.state == 1, 1.0, back)
    before = np.where(rubs, 0.5 + np.where(last.state == 0, 0.0, begun * late), 0.0)
    turns = np.where(rubs & (last.state == 2) & (back > 0) & (back < 1), late, 0.0)
    by_alike = np.where(rubs & (last.state != 0) & (0.5 * ratio > least), 0.5 * begun, 0.0)
    return Rubbing(np.where(rubs, ds, 0.0), np.where(rubs, length, 0.0), before, back, turns, by_alike, cells)


def _energy(o, _):
    """Frictional work: a mean of the bounds before and after the step times the slip, where cells slip."""
    tape = o.tape
    for k in o.steps:
        rubbed = o.rubbed(k)
        o.value += float(np.sum(tape.friction * rubbed)) * tape.area
        o.add_rubbed(k, tape.area * tape.friction)
        o.by_friction += tape.area * rubbed


def _volume(o, _):
    """Worn volume of both bodies after the last of the steps."""
    tape, last = o.tape, o.steps[-1]
    if not tape.wear.any():
        raise Error("gradient: wear_volume: the contact has no coefficient of wear: give wear_coefficient1 or another")
    rate = tape.wear[0] + tape.wear[1] * tape.friction
    o.value = float(sum(np.sum(rate * o.rubbed(k)) for k in range(last + 1))) * tape.area
    o.by_worn[last] += tape.area


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
    "energy": _energy, "wear_volume": _volume, "pressure_norm": _norm,
    **dict.fromkeys(LOADS, _load), **dict.fromkeys(WAYS, _way),
}  # fmt: skip


def of(tape: Tape, name: str, steps: Optional[slice] = None, rtol: float = 1e-6) -> Gradient:
    """The derivatives of a number by all parameters, in one pass back over the steps.

    Parameters
    ----------
    tape : Tape
        The recorded history, see record().
    name : str
        "energy", the frictional work of the steps (J); "wear_volume", that of both bodies after the last of the steps
        (m3); a load that is given by its displacement, or a displacement that
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
        self.gap, self.friction = np.zeros(shape), np.zeros(shape)
        self.by_load, self.by_way = np.zeros((count, 6)), np.zeros((count, 6))
        self.by_bulk, self.by_wear, self.worn = np.zeros((count, 6)), np.zeros(2), np.zeros(shape)
        self.constants, self.by_stretch = np.zeros(3), np.zeros(4)
        self.borders, self.residual = 0, 0.0

    def run(self, name: str) -> Gradient:
        """The gradient."""
        left = np.zeros((2, *self.gap.shape))
        for k in range(len(self.tape.records) - 1, -1, -1):
            left = self._step(k, left)
        self.friction += self.objective.by_friction
        tape, loads = self.tape, self.tape.records[0].loads
        if self.borders:
            warnings.warn(
                f"gradient of {name}: {self.borders} cells are on the border of their set: it holds to one side",
                OneSidedWarning,
                stacklevel=3,
            )
        moduli = dict(zip(MODULI, (self.constants @ by_moduli(tape.bodies) + self.by_stretch).tolist()))
        wears = tape.wear.any()
        return Gradient(
            name, self.objective.value, tape.whole(self.gap), tape.whole(self.friction),
            {LOADS[i]: self.by_load[:, i] for i in range(6) if loads[i]},
            {WAYS[i]: self.by_way[:, i] for i in range(6) if not loads[i] and i not in ABSENT[tape.kind]}, moduli,
            self.borders, self.residual, {name: self.by_bulk[:, i] for i, name in enumerate(BULK)},
            {name: float(self.by_wear[i // 2]) for i, name in enumerate(WEAR) if wears},
        )  # fmt: skip

    def _step(self, k, left):
        """Adds what step k gives to the derivatives; returns what it leaves for the slip of the step before."""
        tape, o = self.tape, self.objective
        record, sets = tape.records[k], o.sets[k]
        self._wear(k)
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

    def _wear(self, k):
        """Adds to the derivatives of step k what it wears, whose depth is in the gap of all later steps."""
        tape, o = self.tape, self.objective
        self.worn += o.by_worn[k]
        if not tape.wear.any():
            return
        rubbed = o.rubbed(k)
        o.add_rubbed(k, self.worn * (tape.wear[0] + tape.wear[1] * tape.friction))
        self.by_wear += np.sum(self.worn * rubbed), np.sum(self.worn * tape.friction * rubbed)
        self.friction += self.worn * tape.wear[1] * rubbed

    def _read(self, k, gamma, tau, beta, forces):
        tape, record = self.tape, self.tape.records[k]
        self.gap += gamma
        self.worn += gamma
        self._stretch(k, tau)
        self.friction += record.pressure * beta
        self.by_load[k] = forces
        for i in range(3):
            self.by_way[k, i] = -np.sum(tape.motions[0][i] * gamma)
            self.by_way[k, i + 3] = -np.sum(tape.motions[1][i] * tau)
        u_z, u_t = tape.influence.parts(record.pressure, record.shear)
        self.constants += np.tensordot(u_z, gamma, axes=2) + np.tensordot(u_t, tau, axes=3)

    def _stretch(self, k, tau):
        """Adds the derivatives by the bulk stresses of step k, which stretch the surfaces about the origin."""
        tape, stress = self.tape, self.tape.records[k].bulk.reshape(2, 3)
        x, y = tape.motions[0][2], -tape.motions[0][1]
        by_strain = np.array([np.sum(tau[0] * x), np.sum(tau[1] * y), np.sum(tau[0] * y + tau[1] * x)])
        for body, sign in ((0, -1.0), (1, 1.0)):
            young, nu = tape.bodies[2 * body : 2 * body + 2]
            if tape.kind == "plane":
                strain, by_nu = np.diag([1 - nu**2, 0, 0]), np.diag([-2 * nu, 0, 0])
            else:
                strain = np.array([[1, -nu, 0], [-nu, 1, 0], [0, 0, 1 + nu]])  # by the stress, times E
                by_nu = np.array([[0, -1, 0], [-1, 0, 0], [0, 0, 1]])
            of_body = sign * by_strain / young
            self.by_bulk[k, 3 * body : 3 * body + 3] = of_body @ strain
            self.by_stretch[2 * body] -= of_body @ strain @ stress[body] / young
            self.by_stretch[2 * body + 1] += of_body @ by_nu @ stress[body]
