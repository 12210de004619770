"""The fit of the cycles of all files together, and what of it the loops contradict."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .loop import Loop
from .loops import LOSS, fit
from .problem import BENDS

TOGETHER = 3  # cycles of each file that are fitted together, where their amplitudes differ
ALIKE = 2.0  # of the noise: the standard deviation of the ranges of cycles that are alike; noise makes it about 1
MOST = 6000  # points of cycles that are fitted as one loop
LEANS = 5.0  # standard deviations of a lean in gross slip beyond which loops without one are not the model's
# pull of what is known beforehand from which on the loops alone settle it
BEYOND = {"loss": 2.0, "scale": 3.0, "bend": 3.0}
UNSETTLED = 0.3  # deviation of the loss over that known beforehand,
ALIGNED = 0.7  # and its correlation with the friction, beyond which the loops do not separate both:
UNSTATED = 2.0  # a loss that nobody stated is then so many times less sure


def fit_together(files, pushes, free, fixed):
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


def by_best_load(together, files, pushes, free, fixed, notes):
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


def _fit_best(files, pushes, free, fixed):
    """The fit of cycles on each other as one loop, if they are so alike that it holds, else of some of them."""
    found = _fit_all(files, pushes, _together, free, fixed)
    return found if found.state != "rejected" else _fit_all(files, pushes, _spread, free, fixed)


def _fit_all(files, pushes, choose, free, fixed):
    """The fit of chosen loops of all files together."""
    chosen = [(loop, push) for one, push in zip(files, pushes) for loop in choose(one.loops)]
    return fit([loop for loop, _ in chosen], [push for _, push in chosen], free, **fixed)


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
