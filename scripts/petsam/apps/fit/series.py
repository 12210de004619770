"""Cycles of a record: cut at the least displacements, without drift, fitted one by one, and together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...core.errors import Error, Unusable, counted, library
from ...core.tables import Column, Tabled
from .loops import BENDS, LOADS, LOSS, SHAPE, Fit, Loop, fit, need_parameters, noise_of
from .push import Push
from .reading import Record

SMOOTH = 40  # parts of a period over which the displacement is smoothed, to find its turns
APART = 0.6  # of a period: least distance of two minima
SCATTER = 5.0  # scatter of the friction over what is expected, from which on it changes, where the contact slides,
SCATTER_PARTIAL = 2.0  # and where it does not, whose cycles hold less
DEGREE, HARMONICS = 5, 5  # of polynomials of strokes, and harmonics of the displacement of a cycle
NOTABLY, SMOOTHER = 0.95, 1.15  # harmonics are taken if they leave less by this; the most of the noise that is left
SPIKE = 8.0  # of the noise: points farther from the median of their neighbours are left out
TOGETHER = 3  # cycles of each file that are fitted together, where their amplitudes differ
ALIKE = 2.0  # of the noise: the standard deviation of the ranges of cycles that are alike; noise makes it about 1
MOST = 6000  # points of cycles that are fitted as one loop
TURN = 0.015  # of a cycle: points so near to a turn are left out, whose branch is not sure
LEANS = 5.0  # standard deviations of a lean in gross slip beyond which loops without one are not the model's
# pull of what is known beforehand from which on the loops alone settle it
BEYOND = {"loss": 2.0, "scale": 3.0, "bend": 3.0}
UNSETTLED = 0.3  # deviation of the loss over that known beforehand,
ALIGNED = 0.7  # and its correlation with the friction, beyond which the loops do not separate both:
UNSTATED = 2.0  # a loss that nobody stated is then so many times less sure
FEWEST = 12  # points of a cycle


@dataclass(frozen=True)
class Cycles:
    """The closed cycles of a record.

    Parameters
    ----------
    path : str
    loops : list of Loop
    numbers : ndarray
        Their numbers, those of the file if it has them.
    drift : float
        Of the displacement, m per cycle, which is removed.
    notes : list of str
    turned : bool
        Some loops were clockwise.
    """

    path: str
    loops: list
    numbers: np.ndarray
    drift: float
    notes: list = field(default_factory=list)
    turned: bool = False


def _period(values):
    """Points of a period, by the largest term of the Fourier transform, refined by neighbours."""
    centred = values - values.mean()
    power = np.abs(np.fft.rfft(centred * np.hanning(len(values)))) ** 2
    k = int(np.argmax(power[1:])) + 1
    return len(values) / k


def _smoothed(values, width):
    """Moving average over so many points."""
    width = max(1, int(width)) | 1
    padded = np.pad(values, width // 2, mode="edge")
    return np.convolve(padded, np.ones(width) / width, mode="valid")


def _minima(smooth, period):
    """Indices of the least values, one a period; the ends of the record count if they are as low."""
    signal = library("scipy.signal")
    span = np.ptp(smooth)
    found, _ = signal.find_peaks(-smooth, distance=max(1, int(APART * period)), prominence=0.5 * span)
    low = smooth[found].max() if len(found) else smooth.min()
    ends = [k for k in (0, len(smooth) - 1) if smooth[k] <= low + 0.05 * span]
    kept = sorted({*found.tolist(), *ends})
    return [k for n, k in enumerate(kept) if n == 0 or k - kept[n - 1] > APART * period or k == kept[-1]]


def cycles(record: Record, normal: float, which: slice = slice(None)) -> Cycles:
    """Cuts a record into closed cycles, in which the force moves with the displacement.

    Parameters
    ----------
    record : Record
    normal : float
        Normal load, N.
    which : slice
        Of the cycles.

    Returns
    -------
    Cycles

    Raises
    ------
    Error
        If there is no whole cycle.
    """
    notes, d, q = [], record.displacement.copy(), record.force.copy()
    known = np.isfinite(d + q)
    places = np.arange(len(d))
    filled = np.interp(places, places[known], d[known])
    period = _period(filled)
    smooth = _smoothed(filled, period / SMOOTH)
    if np.ptp(smooth) < 10.0 * noise_of(filled):
        raise Error(f"{record.path}: the displacement does not move by more than its noise")
    spikes = _spikes(filled) | _spikes(np.interp(places, places[known], q[known]))
    if spikes.any():
        notes.append(f"{counted(int(spikes.sum()), 'point')} far from both neighbours left out")
    if np.polyfit(d[known], q[known], 1)[0] < 0.0:
        q = -q
        notes.append("the force falls where the displacement rises: its sign is turned")
    cuts, shift = _cuts(record.path, smooth, period)
    d, q, known, smooth, spikes = (np.roll(one, -shift) for one in (d, q, known, smooth, spikes))
    parts = [slice(a, b) for a, b in zip(cuts[:-1], cuts[1:])]
    line, drift = _drift(filled, parts)
    d = d - line
    loops, numbers = [], []
    for k, part in enumerate(parts):
        if not np.all(known[part]) or part.stop - part.start < FEWEST:
            continue
        loops.append(_closed(d[part], q[part], int(np.argmax(smooth[part])), normal, ~spikes[part]))
        numbers.append(k + 1 if record.cycle is None else float(np.nanmedian(record.cycle[part])))
    if len(loops) < len(parts):
        notes.append(f"{counted(len(parts) - len(loops), 'cycle')} with lost or too few points left out")
    loops, turned = _turned(loops)
    if turned:
        notes.append(
            f"{counted(len(loops), 'loop')} clockwise, as if work were gained: taken as recorded backwards; a force "
            "that lags behind the displacement makes small loops so, too"
        )
    if not loops[which]:
        raise Error(f"{record.path}: no whole cycle is left of {len(parts)}")
    return Cycles(record.path, loops[which], np.array(numbers)[which], drift, notes, turned)


def _turned(loops):
    """The loops in the order of time, by the sign of the sum of their areas, since noise may turn that of a small one,
    and whether they were clockwise, as if work were gained."""
    if (
        sum(
            np.sum(one.displacement * np.roll(one.force, -1) - np.roll(one.displacement, -1) * one.force)
            for one in loops
        )
        <= 0.0
    ):
        return loops, False
    back = slice(None, None, -1)
    return [
        replace(one, displacement=one.displacement[back], force=one.force[back], rising=~one.rising[back])
        for one in loops
    ], True


def _cuts(path, smooth, period):
    """Where cycles begin and end, and by how much the points of a single cycle that begins elsewhere are turned."""
    cuts = _minima(smooth, period)
    if len(cuts) > 1:
        return cuts, 0
    if len(smooth) > 1.3 * period or abs(smooth[0] - smooth[-1]) > 0.1 * np.ptp(smooth):
        raise Error(f"{path}: no whole cycle between two least displacements")
    return [0, len(smooth)], int(np.argmin(smooth))


def _drift(filled, parts):
    """The drift of the displacement at each point, m, through the means of the cycles, and per cycle. A mean is that of
    a whole period about the middle of a cycle, which does not depend on where exactly the cycle is cut."""
    if len(parts) < 2:
        return 0.0, 0.0
    places = np.arange(len(filled))
    period = round((parts[-1].stop - parts[0].start) / len(parts))
    means = np.array([_mean_about(filled, 0.5 * (part.start + part.stop), period) for part in parts])
    middles = np.array([0.5 * (part.start + part.stop - 1) for part in parts])
    line = np.interp(places, middles, means)
    for end, (a, b) in ((places < middles[0], (0, 1)), (places > middles[-1], (-2, -1))):
        line[end] = means[a] + (places[end] - middles[a]) * (means[b] - means[a]) / (middles[b] - middles[a])
    return line, float(np.polyfit(np.arange(len(parts)), means, 1)[0])


def _mean_about(values, middle, period):
    """Mean of so many values about a place."""
    first = int(np.clip(round(middle - 0.5 * period), 0, max(0, len(values) - period)))
    return float(np.mean(values[first : first + period]))


def _spikes(values):
    """Points that are far from the median of five about them, and from both neighbours."""
    padded = np.pad(values, 2, mode="edge")
    around = np.median([padded[k : k + len(values)] for k in range(5)], axis=0)
    far = np.abs(values - around) > SPIKE * max(noise_of(values), 1e-300)
    return far if far.sum() < 0.05 * len(values) else np.zeros(len(values), dtype=bool)


def _smooth(d, top, good):
    """The displacement of a cycle by few functions, if they leave no more than its noise: (values, noise, what is left
    of it in these). Else the points themselves: noise of a displacement bends the loop where it is curved.

    Polynomials of both strokes, which meet at the turns, hold a sine as well as a triangle. Harmonics round the
    corners of a triangle, by 6 % of its amplitude, and noise hides it: the loop of the wrong stroke has less friction.
    They are taken where they leave notably less.
    """
    noise = noise_of(d[good])
    (found, count), (other, others) = _by_strokes(d, top, good), _by_harmonics(d, good)
    left, rest = (np.std(d[good] - one[good]) for one in (found, other))
    if rest < NOTABLY * left:
        found, count, left = other, others, rest
    if left > SMOOTHER * noise:
        return d, noise, noise
    return found, noise, noise * float(np.sqrt(count / good.sum()))


def _by_harmonics(d, good):
    """The best displacement of few harmonics, and how many functions they are."""
    count, phase = min(HARMONICS, len(d) // 8), 2.0 * np.pi * np.arange(len(d)) / len(d)
    waves = [np.ones(len(d)), *(f(k * phase) for k in range(1, count + 1) for f in (np.cos, np.sin))]
    waves = np.array(waves).T
    return waves @ np.linalg.lstsq(waves[good], d[good], rcond=None)[0], 2 * count + 1


def _by_strokes(d, top, good):
    """The best displacement of a polynomial of each stroke, and how many functions they are; the turns are within some
    points of the given ones."""
    degree, best = min(DEGREE, len(d) // 8), None
    wide = max(1, round(TURN * len(d)))
    for first in range(-wide, wide + 1):
        for turn in range(top - wide, top + wide + 1):
            found = _of_strokes(d, good, (first, turn), degree)
            best = found if best is None or found[1] < best[1] else best
    return best[0], 2 * degree


def _of_strokes(d, good, turns, degree):
    """The best displacement of strokes between these turns, and its sum of squares."""
    count = len(d)
    place = (np.arange(count) - turns[0]) % count
    up = turns[1] - turns[0]
    rising = place < up
    part = np.where(rising, place / up, (count - place) / (count - up))  # from 0 at the least to 1 at the largest
    bump = part * (1.0 - part)  # 0 at both turns
    waves = [np.ones(count), part]
    for side in (rising, ~rising):
        waves += [np.where(side, bump * (2.0 * part - 1.0) ** k, 0.0) for k in range(degree - 1)]
    waves = np.array(waves).T
    found = waves @ np.linalg.lstsq(waves[good], d[good], rcond=None)[0]
    return found, float(np.sum((d - found)[good] ** 2))


def _closed(d, q, top, normal, good):
    """A loop from the good points of a cycle whose largest displacement is at `top`."""
    noise_q = noise_of(q[good])
    d, noise_d, left = _smooth(d, top, good)
    rising = np.arange(len(d)) < top
    turns = np.array([0, top, len(d)])
    away = good & (np.abs(np.arange(len(d))[:, None] - turns).min(axis=1) >= max(1, round(TURN * len(d))))
    return Loop(d[away], q[away], rising[away], normal, (noise_d, noise_q, left))


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
    notes: Sequence[str] = ()

    def table(self) -> list:
        """The columns: cycle, friction, its deviation, the rig's compliance, its deviation, energy.

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
    together, free, fixed, notes = _fit_together(files, pushes, free, fixed)
    if fixed.get("loads") and len({push.normal for push in pushes}) > 1 and together.identifiable:
        together = _by_best_load(together, files, pushes, free, fixed, notes)
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
    loss = _loss(together, fixed)
    energy = np.array([_contact_energy(loop, loss) for one in files for loop in one.loops])
    rig = _rig(each, together, state)
    return Result(
        friction=found[0] if identifiable else np.nan, friction_sd=found[1] if identifiable else np.nan,
        friction_at_least=together.friction_at_least, identifiable=identifiable, state=state,
        regime="gross slip" if together.gross and identifiable else "partial slip", sliding=together.sliding,
        rig_stiffness=rig[0], rig_stiffness_sd=rig[1], contact_stiffness=pushes[0].stiffness, fit=together, files=files,
        each=each, numbers=numbers, energy=energy, notes=notes,
    )  # fmt: skip


def _fit_together(files, pushes, free, fixed):
    """The fit of all files together; what was free in it besides friction and compliance, and given; notes."""
    stated, notes = fixed["loss"] is not None, []
    fixed = fixed if stated else {**fixed, "loss": LOSS}
    together = _fit_best(files, pushes, free, fixed)
    for name in [one for one in BEYOND if isinstance(fixed.get(one), tuple)]:
        if not together.state == "rejected" and together.pull(name, *fixed[name]) > BEYOND[name]:
            rest = {other: value for other, value in fixed.items() if other != name}
            alone = _fit_best(files, pushes, (*free, name), rest)
            if not _contradict(alone, name, *fixed[name]):  # loops of much noise tell nothing of it by themselves
                continue
            loads = len({push.normal for push in pushes}) > 1
            notes.append(_contradicted(name, *fixed[name], "compliance" in fixed, loads))
            together, free, fixed = alone, (*free, name), rest
            # either may be wrong; and by one factor for all loads rig and friction take what the loads differ in
            if name in ("scale", "bend") and ("compliance" in fixed or loads):
                together = _rejected(together)
    if isinstance(fixed.get("loss"), tuple) and _entangled(together, fixed["loss"][1]):
        if not stated:
            fixed = {**fixed, "loss": (LOSS[0], UNSTATED * LOSS[1])}
            together = _fit_best(files, pushes, free, fixed)
        notes.append(_entangled_note(together, *fixed["loss"], stated))
    if together.gross and together.identifiable and "lean" not in (*free, *fixed):
        lean, deviation = _fit_best(files, pushes, (*free, "lean"), fixed).more["lean"]
        if abs(lean) > LEANS * deviation:  # which a loss may hide from the residuals
            together = _rejected(together)
    if any(one.turned for one in files) and not (together.gross and together.identifiable):
        together = _rejected(together)
    return together, free, fixed, notes


def _by_best_load(together, files, pushes, free, fixed, notes):
    """A fit of several loads whose friction is known no better than by the loops nearest to sliding alone.

    A curve that is not the shape's differs by the load, as of a rough contact given as a smooth one: loops of several
    loads then seem to hold the friction much better than each of them, and are many deviations off."""
    nearest = int(np.argmax([max(np.ptp(loop.force) for loop in one.loops) / one.loops[0].normal for one in files]))
    alone = None if _loads_differ(together, fixed) else _fit_best([files[nearest]], [pushes[nearest]], free, fixed)
    if alone is not None and alone.state == "not identifiable":
        notes.append(
            "the loops of no load hold the friction by themselves, as those of several would of an exact shape"
        )
        return alone
    if alone is None or not abs(together.friction - alone.friction) < BEYOND["scale"] * alone.friction_sd:
        notes.append(_contradicted("scale", 1.0, fixed["loads"], "compliance" in fixed, True))
        return _rejected(together)
    return replace(together, friction_sd=max(together.friction_sd, alone.friction_sd))


def _loads_differ(together, fixed):
    """True if the loops pull the shape's compliance at one of several loads from that at the others."""
    for name in [one for one in together.more if one[-1].isdigit()]:
        kind = name.rstrip("0123456789")
        deviation = fixed["loads"] * (BENDS if kind == "bend" else 1.0)
        if together.pull(name, 0.0, deviation) > BEYOND[kind]:
            return True
    return False


def _rejected(found):
    """A fit without its numbers."""
    numbers = ("friction", "friction_sd", "friction_at_least", "compliance", "compliance_sd")
    return replace(found, state="rejected", **dict.fromkeys(numbers, np.nan))


def _contradict(alone, name, value, deviation):
    """True if a parameter that was found from the loops alone is not what was known of it."""
    if alone.state == "rejected":
        return True
    found, sd = alone.more[name]
    return abs(found - value) > BEYOND[name] * np.hypot(sd, deviation)


def _contradicted(name, value, deviation, given, loads):
    """The note that the loops do not fit to what was known of a parameter."""
    if name == "loss":
        return (
            f"the loops do not fit to a loss of the rig of {100 * value:g} +- {100 * deviation:g} %: it is found from "
            "them alone"
        )
    what = "its compliance" if name == "scale" else "the compliance that slip adds to it"
    differs = f"{what} is not that of the loops within {100 * deviation:g} %"
    if given:
        return (
            f"the shape or the given rig does not fit: of the shape, {differs}; look at radii, moduli, roughness, wear "
            "and normal load, and leave out --rig"
        )
    if loads:
        return (
            f"the shape does not fit: {differs}, and with several normal loads one factor need not correct it; look at "
            "radii, moduli, roughness, wear, and normal loads, or fit the loops of each load by themselves"
        )
    return (
        f"the shape does not fit: {differs}, so that it is found from them alone; look at radii, moduli, roughness, "
        "wear and normal load"
    )


def _entangled(together, deviation):
    """True if loops that do not slide leave the loss about as it was known beforehand, and the friction goes with
    it."""
    return (
        together.state != "rejected"
        and together.more["loss"][1] > UNSETTLED * deviation
        and abs(together.correlation["loss"]) > ALIGNED
    )


def _entangled_note(together, value, deviation, stated):
    """The note that loss and friction are not separated."""
    return (
        "the loops do not separate a loss of the rig from the friction (correlation of their errors "
        f"{together.correlation['loss']:.2f}): the band holds for a loss of {100 * value:g} +- {100 * deviation:g} %"
        + ("" if stated else "; give that of the rig, --loss V,BAND, or a loop in gross slip")
    )


def _value(given):
    """The value of what is given as a value, or with its standard deviation."""
    return given[0] if isinstance(given, tuple) else given


def _loss(together, fixed):
    """The loss of the rig, to be subtracted from energies."""
    if "loss" in together.more and together.state in ("known", "weak", "changes"):
        return together.more["loss"][0]
    return _value(fixed.get("loss", LOSS))


def _fit_best(files, pushes, free, fixed):
    """The fit of cycles on each other as one loop, if they are so alike that it holds, else of some of them."""
    found = _fit_all(files, pushes, _together, free, fixed)
    return found if found.state != "rejected" else _fit_all(files, pushes, _spread, free, fixed)


def _fit_all(files, pushes, choose, free, fixed):
    """The fit of chosen loops of all files together."""
    chosen = [(loop, push) for one, push in zip(files, pushes) for loop in choose(one.loops)]
    return fit([loop for loop, _ in chosen], [push for _, push in chosen], free, **fixed)


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


def _together(loops):
    """The loops that are fitted together: all cycles on each other, as one loop, if their amplitudes are alike, else
    some."""
    spans = np.array([[np.ptp(one.displacement), np.ptp(one.force)] for one in loops])
    noise = np.median([one.given or (*one.noise(), one.noise()[0]) for one in loops], axis=0)
    if len(loops) > 1 and np.all(np.std(spans, axis=0) < ALIKE * noise[:2]):
        kept = loops[: max(2, MOST // len(loops[0].force))]
        d, q, rising = (
            np.concatenate([getattr(one, name) for one in kept]) for name in ("displacement", "force", "rising")
        )
        return [Loop(d, q, rising, loops[0].normal, tuple(noise))]
    return _spread(loops)


def _spread(loops):
    """Up to TOGETHER loops, from the first to the last."""
    return [loops[k] for k in sorted({round(k) for k in np.linspace(0, len(loops) - 1, min(TOGETHER, len(loops)))})]


def _contact_energy(loop, loss):
    """Energy of a loop without that of the rig's loss, J."""
    half_d, half_q = 0.5 * np.ptp(loop.displacement), 0.5 * np.ptp(loop.force)
    return loop.energy - np.pi * loss * half_q * half_d


@dataclass(frozen=True)
class Peaks:
    """The numbers that peaks of cycles hold alone: least friction, the largest force over the normal load; energy over
    4 D* Q*, 1, above 0.2 gross slip, roughly, NaN without energies; and where slip is gross."""

    friction_at_least: float
    energy_ratio: np.ndarray
    gross: np.ndarray


def of_peaks(record: Record, normal: float) -> Peaks:
    """Evaluates a record of peaks under a normal load, N."""
    energy = record.energy if record.energy is not None else np.full(record.force.shape, np.nan)
    ratio = energy / (4.0 * record.displacement * record.force)
    return Peaks(float(np.nanmax(record.force) / normal), ratio, ratio > 0.2)
