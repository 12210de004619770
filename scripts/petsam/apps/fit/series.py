"""Friction and rig from the cycles of one or several files: fitted one by one, and together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...core.brief import brief
from ...core.errors import Unusable
from ...core.tables import Column, Tabled
from .cutting import Cycles
from .loop import Fit
from .loops import LOADS, LOSS, SHAPE, fit, need_parameters
from .problem import BENDS
from .push import Push
from .together import by_best_load, fit_together

SCATTER = 5.0  # scatter of the friction over what is expected, from which on it changes, where the contact slides,
SCATTER_PARTIAL = 2.0  # and where it does not, whose cycles hold less


@brief
@dataclass(frozen=True)
class Result(Tabled):
    """Friction and rig as found from the loops of one or several files.

    Attributes
    ----------
    friction, friction_sd, friction_at_least : float
        Of all cycles together; NaN where they do not hold it.
    identifiable : bool
    state : str
        "known", "weak", "not identifiable", "rejected", or "changes".
    regime : str
        "gross slip" or "partial slip".
    sliding : float
        Largest shear amplitude over mu N.
    rig_stiffness, rig_stiffness_sd : float
        N/m.
    contact_stiffness : float
        Of the contact without slip, N/m.
    fit : Fit
        Of loops of all files together; of a friction that changes that of the cycle in the middle.
    files : list of Cycles
    each : list of Fit
        Of each cycle; empty of one cycle.
    numbers, energy : ndarray
        Of each cycle, its number and its dissipated energy, J, without the rig's loss.
    energy_noise, energy_loss : ndarray
        Standard deviations of the energy, J: by the noise of the points, and by that of the rig's loss, whose error all
        cycles share.
    notes : list of str
        Of the fit; the files have theirs.
    """

    friction: float
    friction_sd: float
    friction_at_least: float
    identifiable: bool
    state: str
    regime: str
    sliding: float
    rig_stiffness: float
    rig_stiffness_sd: float
    contact_stiffness: float
    fit: Fit
    files: Sequence[Cycles]
    each: Sequence[Fit]
    numbers: np.ndarray
    energy: np.ndarray
    energy_noise: np.ndarray
    energy_loss: np.ndarray
    notes: Sequence[str] = ()

    @property
    def energy_sd(self) -> np.ndarray:
        """Standard deviation of the energy of each cycle, J.

        Returns
        -------
        ndarray
        """
        return np.hypot(self.energy_noise, self.energy_loss)

    def table(self) -> list:
        """The columns: cycle, friction, its deviation, the rig's compliance, its deviation, energy, its deviation.

        Returns
        -------
        list of Column
        """
        each = self.each or [self.fit] * len(self.numbers)
        return [
            Column("cycle", "1", "number of the cycle", self.numbers.tolist()),
            Column("friction", "1", "coefficient of friction; NaN: not identifiable", [f.friction for f in each]),
            Column("friction_sd", "1", "its standard deviation", [f.friction_sd for f in each]),
            Column("compliance", "m/N", "of the rig", [f.compliance for f in each]),
            Column("compliance_sd", "m/N", "its standard deviation", [f.compliance_sd for f in each]),
            Column("energy", "J", "dissipated energy, of the contact alone", self.energy.tolist()),
            Column("energy_sd", "J", "its standard deviation", self.energy_sd.tolist()),
        ]


def _mean(each, shape):
    """Mean of the cycles' friction, its deviation (the larger one of theirs and of the scatter), and scatter over what
    is expected. The shape is one of all cycles: its part of their deviations neither scatters nor averages out. That of
    scale or bend is left out, {name: value}, whichever is larger."""
    name = max(shape, key=lambda one: sum(abs(fit.correlation.get(one, 0.0)) for fit in each))
    values, deviations = np.array([one.alone(name, shape[name]) for one in each]).T
    weights = 1.0 / deviations**2
    mean = float(np.sum(weights * values) / np.sum(weights))
    expected = 1.0 / np.sqrt(np.sum(weights))
    scatter = float(np.std(values, ddof=1)) if len(values) > 1 else 0.0
    relative = float(np.sqrt(np.mean(((values - mean) / deviations) ** 2)))
    common = float(np.sqrt(np.mean([max(one.friction_sd**2 - sd**2, 0.0) for one, sd in zip(each, deviations)])))
    own = max(expected, scatter / np.sqrt(len(values)) if relative > 1.5 else 0.0)
    return mean, float(np.hypot(own, common)), relative


def analyse(files: Sequence[Cycles], pushes: Sequence[Push], free: Sequence[str] = (), **fixed: Any) -> Result:
    """Friction and rig stiffness of the cycles of one or several files.

    Parameters
    ----------
    files : sequence of Cycles
        The cycles of each file, of petsam.fit.cycles().
    pushes : sequence of Push
        The push of each file, of petsam.fit.of_shape() or ball(): analyse([cycles], [push]).
    free : sequence of str
        Parameters that are found, too: "lean".
    **fixed
        What is given: compliance (m/N), lean, loss, scale (of the contact's compliance, 1); a value, or (value,
        standard deviation). Without a loss that is LOSS: one of half a percent makes more of a difference than noise
        does, and in partial slip no residual shows it; its deviation is doubled where the loops do not separate it from
        the friction. Without a scale that is 1 with the deviation SHAPE: in partial slip no residual shows a wrong
        shape, either. Where the loops pull the loss by more than two deviations from what is given, or the scale by
        more than three, they alone settle it; with several normal loads such a scale leaves no numbers, since the
        shape's compliance may depend otherwise on the load. The part of the compliance that slip adds, and the
        compliance at each of several loads, have deviations of their own in proportion to that of the scale (BENDS,
        LOADS).

    Returns
    -------
    Result

    Examples
    --------
    >>> import numpy as np, petsam
    >>> steel = dict(body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3)
    >>> push = petsam.fit.ball(10.0, 5e-3, steel)

    Three cycles of a ball with a friction of 0.5 on a stiff rig, in partial slip:

    >>> angle = np.linspace(0.0, 6.0 * np.pi, 601)
    >>> d = 0.45 * push.displacement[-1] * np.cos(angle)
    >>> half = lambda way: 2.0 * np.interp(0.5 * way, 0.5 * push.displacement, 0.5 * push.force)
    >>> top = 0.5 * half(2.0 * d.max())
    >>> force = np.where(np.sin(angle) > 0.0, top - half(d.max() - d), half(d - d.min()) - top)
    >>> loops = petsam.fit.cycles(petsam.fit.Record("loops", d, force), normal=10.0)
    >>> found = petsam.fit.analyse([loops], [push])
    >>> round(float(found.friction), 2)
    0.5
    """
    need_parameters(free, fixed)
    for name, given, kind, made in (("files", files, Cycles, "cycles()"), ("pushes", pushes, Push, "of_shape()")):
        if isinstance(given, (str, kind)) or not all(isinstance(one, kind) for one in given):
            raise Unusable(f"{name}: expected a list of what petsam.fit.{made} returns")
    if len(files) != len(pushes):
        raise Unusable(f"pushes: {len(pushes)} of {len(files)} files: give one for each file")
    fixed = {"loss": None, "scale": (1.0, SHAPE), **fixed}
    if isinstance(fixed["scale"], tuple):
        fixed = {"bend": (0.0, BENDS * fixed["scale"][1]), "loads": LOADS * fixed["scale"][1], **fixed}
    together, free, fixed, notes = fit_together(files, pushes, free, fixed)
    if fixed.get("loads") and len({push.normal for push in pushes}) > 1 and together.identifiable:
        together = by_best_load(together, files, pushes, free, fixed, notes)
    each = []
    if sum(len(one.loops) for one in files) > 1:
        each = [
            fit([loop], push, free, profile=False, **fixed) for one, push in zip(files, pushes) for loop in one.loops
        ]
    numbers = np.concatenate([one.numbers for one in files]).astype(float)
    state, found = together.state, (together.friction, together.friction_sd)
    known = [one for one in each if one.identifiable]
    if len(known) == len(each) > 1 and len(files) == 1:
        shape = {name: _value(fixed.get(name, plain)) for name, plain in (("scale", 1.0), ("bend", 0.0))}
        mean, deviation, scatter = _mean(each, shape)
        if scatter > (SCATTER if together.gross else SCATTER_PARTIAL):
            state, found = "changes", (mean, deviation)
            each = _within(each)
            together = replace(each[len(each) // 2], state=state)  # one loop is none of all of them
        elif state != "rejected":
            found = (found[0], max(found[1], deviation))
    identifiable = state in ("known", "weak", "changes")
    loss, loss_sd = _loss(together, fixed)
    loops = [loop for one in files for loop in one.loops]
    lost = np.array([_rig_energy(loop) for loop in loops])
    energy = np.array([loop.energy for loop in loops]) - loss * lost
    noise = np.array([loop.energy_sd for loop in loops])
    rig = _rig(each, together, state)
    return Result(
        friction=found[0] if identifiable else np.nan, friction_sd=found[1] if identifiable else np.nan,
        friction_at_least=together.friction_at_least, identifiable=identifiable, state=state,
        regime="gross slip" if together.gross and identifiable else "partial slip", sliding=together.sliding,
        rig_stiffness=rig[0], rig_stiffness_sd=rig[1], contact_stiffness=pushes[0].stiffness, fit=together, files=files,
        each=each, numbers=numbers, energy=energy, energy_noise=noise, energy_loss=loss_sd * lost, notes=notes,
    )  # fmt: skip


def _value(given):
    """The value of what is given as a value, or with its standard deviation."""
    return given[0] if isinstance(given, tuple) else given


def _loss(together, fixed):
    """The loss of the rig, to be subtracted from energies, and its standard deviation."""
    if "loss" in together.more and together.state in ("known", "weak", "changes"):
        return together.more["loss"]
    given = fixed.get("loss")
    return given if isinstance(given, tuple) else LOSS if given is None else (given, 0.0)


def _within(each):
    """The fits of cycles with a friction that changes, whose deviations include its change within a cycle: at which
    instant of it the friction is the one found is not known."""
    changes = np.gradient([one.friction for one in each]) / np.sqrt(12.0)
    return [replace(one, friction_sd=float(np.hypot(one.friction_sd, change))) for one, change in zip(each, changes)]


def _rig(each, together, state):
    """Stiffness of the rig and its deviation: of a friction that changes by the mean of the cycles' compliances, whose
    errors are alike, since each loss and each change within a cycle is: their mean is hardly better than one."""
    if state != "changes":
        return together.stiffness, together.stiffness_sd
    values, deviations = (np.array([getattr(f, name) for f in each]) for name in ("compliance", "compliance_sd"))
    weights = 1.0 / np.maximum(deviations, 1e-30) ** 2
    mean = float(np.sum(weights * values) / np.sum(weights))
    deviation = float(max(np.median(deviations), np.std(values, ddof=1)))
    return (1.0 / mean, deviation / mean**2) if mean > 0.0 else (np.inf, np.nan)


def _rig_energy(loop):
    """Energy that a loss of 1 of the rig takes of a loop, J."""
    return np.pi * 0.5 * np.ptp(loop.displacement) * 0.5 * np.ptp(loop.force)
