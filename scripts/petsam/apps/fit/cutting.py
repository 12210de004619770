"""Cycles of a record: cut at the least displacements, without drift, spikes and turns."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from ...core.brief import brief
from ...core.errors import Error, counted, library
from .loop import Loop, noise_of
from .reading import Record

SMOOTH = 40  # parts of a period over which the displacement is smoothed, to find its turns
APART = 0.6  # of a period: least distance of two minima
DEGREE, HARMONICS = 5, 5  # of polynomials of strokes, and harmonics of the displacement of a cycle
NOTABLY, SMOOTHER = 0.95, 1.15  # harmonics are taken if they leave less by this; the most of the noise that is left
SPIKE = 8.0  # of the noise: points farther from the median of their neighbours are left out
TURN = 0.015  # of a cycle: points so near to a turn are left out, whose branch is not sure
FEWEST = 12  # points of a cycle


@brief
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
