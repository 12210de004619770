"""Numbers of a fretting cycle: regime, energy ratio, sliding ratio, loss factor; slip amplitude and range of each cell.

    import petsam
    with petsam.open("strokes.h5") as results:
        found = petsam.cycles.find(results)
        print(petsam.sliding.numbers(results, found.numbered(-1)))
        amplitude = results.quantity("slip_amplitude")      # (ny, nx), m: of the cycle that ends at the last saved step

The energy ratio is the energy that a load spends on its displacement over a cycle, relative to the product of their
ranges; the sliding ratio is the width of the loop at mean load relative to the range of the displacement. From partial
slip to gross slip a sphere passes an energy ratio of 0.2 and a sliding ratio of 0.26 (S. Fouvry, P. Kapsa, L. Vincent,
Wear 185 (1995) 35-46).

The loss factor is the energy relative to 2 pi U, where U = k x^2/2 is the energy that a spring of the loop's own
stiffness k stores at the amplitude x of the displacement: k is the secant between the points of largest and smallest
displacement (B. J. Lazan, Damping of Materials and Members in Structural Mechanics, 1968, chapter 2; A. D. Nashif,
D. I. G. Jones, J. P. Henderson, Vibration Damping, 1985). The loop of a linear viscoelastic body under a harmonic load
is an ellipse, whose secant is the storage modulus and whose loss factor is the loss modulus over that, tan(delta). The
loss factor is twice the damping as a part of critical damping of a mass on that spring.
"""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple, Optional

import numpy as np

from ..core.errors import Error
from .cycles import PAIRS, VISCOUS, Cycle, busiest, dissipated, find
from .fields import BLOCK, OPEN

if TYPE_CHECKING:
    from .file import Results

REGIMES = ("stick", "partial slip", "gross slip", "mixed")  # by their codes in tables
ALONE = 1e-3  # of a loop's area: smaller areas of the other loads' loops are rounding
MOVES = 1e-6  # of the range of a load: a smaller change in a step is rounding
STEPS = 3  # saved steps of a cycle at least for the path of its slip


class Numbers(NamedTuple):
    """Numbers of a cycle.

    Attributes
    ----------
    force : float
        Amplitude of the load, N or N m.
    displacement : float
        Amplitude of its displacement, m or rad.
    energy : float
        Energy that the load spends on it, J.
    energy_ratio : float
        That energy relative to the product of the ranges.
    sliding_ratio : float
        Width of the loop at mean load relative to the range of the displacement; NaN of a cycle of fewer than 3 steps,
        which is a line.
    regime : str
        One of REGIMES.
    friction : float
        Energy that friction dissipates in the cycle, of all loads, J.
    viscous : float
        Energy that the bodies dissipate in it, of all loads, J; 0 if none relaxes.
    loss_factor : float
        `energy` relative to 2 pi times the energy that a spring of the loop's secant stiffness stores; NaN as above.
    """

    force: float
    displacement: float
    energy: float
    energy_ratio: float
    sliding_ratio: float
    regime: str
    friction: float
    viscous: float
    loss_factor: float


def area(x: np.ndarray, y: np.ndarray) -> float:
    """The area of a closed polygon of points (n,), positive when it is passed clockwise, as a load passes its
    displacement."""
    return 0.5 * float(np.sum((x + np.roll(x, -1)) * (np.roll(y, -1) - y))) * -1.0


def _work(way, force):
    """The work of a force along an open path of points (n,)."""
    return 0.5 * float(np.sum((force[1:] + force[:-1]) * np.diff(way)))


def loop_energy(
    results: "Results", names: tuple[str, str], values: Callable[[str], np.ndarray], energy: float
) -> float:
    """The energy, J, that a load spends on its displacement over a closed loop; names: both, as in cycles.PAIRS.

    values(name) are those of the loop's steps, (n,); energy is what friction and the bodies dissipate in the cycle, J.
    Where no other load and no bulk stress does work, that is the energy of the loop, which needs no fine steps; else
    the area of the loop as it is drawn, whose sides are straight. In bodies that relax a load of constant size works,
    too, while they creep under it.
    """
    force, way = names
    mine = area(values(way), values(force))
    spent = _work if VISCOUS in results.history else area
    others = [abs(spent(values(other), values(load))) for load, other in PAIRS.values() if load != force]
    bulk = any(np.ptp(values(name)) > 0.0 for name in results.history if name.startswith("bulk"))
    if force == "load_n" or bulk or max(others) > ALONE * abs(mine):
        return mine
    return energy


def cycle_energy(results: "Results", names: tuple[str, str], cycle: Cycle) -> float:
    """The energy, J, that a load spends on its displacement over a cycle: see loop_energy()."""
    energy = sum(dissipated(results, cycle))
    return loop_energy(results, names, lambda name: results.series(name)[cycle.rows], energy)


def _width(way, force):
    """Width of a closed loop at the mean of its extreme loads; 0 where fewer than two sides cross it."""
    level = force - 0.5 * (np.max(force) + np.min(force))
    following, after = np.roll(level, -1), np.roll(way, -1)
    crossing = (level < 0.0) != (following < 0.0)
    if not crossing.any():
        return 0.0
    part = level[crossing] / (level[crossing] - following[crossing])
    return float(np.ptp(way[crossing] + part * (after - way)[crossing]))


def _tip(way, force, durations, k):
    """Displacement and load of a closed loop where its displacement is extreme, in its step k or between steps.

    A load that turns in the same step has its extreme there, too. One that goes on, as the bodies follow it late, has
    another value where the displacement turns: that of the parabola through three steps.
    """
    count = way.size
    before, after = durations[k], durations[(k + 1) % count]
    near = np.array([k - 1, k, k + 1]) % count
    change = np.diff(force[near]) * np.sign(force[near[2]] - force[near[0]])
    if min(before, after) <= 0.0 or min(change) <= MOVES * np.ptp(force):
        return way[k], force[k]
    slopes = np.array([np.diff(values[near]) / (before, after) for values in (way, force)])
    bends = (slopes[:, 1] - slopes[:, 0]) / (before + after)
    slopes = (slopes[:, 0] * after + slopes[:, 1] * before) / (before + after)
    time = -0.5 * slopes[0] / bends[0] if bends[0] else 0.0
    return np.array((way[k], force[k])) + slopes * time + bends * time**2


def _stored(way, force, times):
    """The energy, J, that a spring of a loop's secant stiffness stores at the amplitude of its displacement.

    The first point is the beginning of the loop, which its last one closes. NaN of a line, of fewer than STEPS steps.
    """
    durations, way, force = np.diff(times), way[1:], force[1:]
    if way.size < STEPS:
        return math.nan
    high, low = (_tip(way, force, durations, int(find(way))) for find in (np.argmax, np.argmin))
    return float((high[0] - low[0]) * (high[1] - low[1])) / 8.0


def regime(results: "Results", *parts: slice) -> str:
    """The regime of cycles, one at least: mixed where some slip grossly and some do not, else that which slips most;
    parts: of the steps that have a solution, as Cycle.rows."""
    found = {_regime(results, rows) for rows in parts}
    if "gross slip" in found and len(found) > 1:
        return "mixed"
    return max(found, key=REGIMES.index)


def _regime(results, rows):
    """The regime of the step of a part that slips most."""
    stick, contact = (results.series(name)[rows] for name in ("stick_area", "contact_area"))
    touching = contact > 0.0
    if np.any(touching & (stick <= 0.0)):
        return "gross slip"
    return "partial slip" if np.any(stick < contact * (1.0 - 1e-9)) else "stick"


def numbers(results: "Results", cycle: Cycle, pair: Optional[str] = None) -> Numbers:
    """The numbers of a cycle: amplitudes, energy, ratios, regime, loss factor.

    Parameters
    ----------
    results : Results
        The results of a run.
    cycle : Cycle
        The cycle, see petsam.cycles.find().
    pair : str, optional
        The load and its displacement: "tx", "ty", "mz", "n", "mx" or "my"; None: the pair that does most work.

    Returns
    -------
    Numbers

    Raises
    ------
    Error
        If no load varies.
    """
    pair = pair or busiest(results)
    if pair is None:
        raise Error(f"{results.path}: no load varies, a cycle needs several steps")
    names, rows = PAIRS[pair], cycle.rows
    force: np.ndarray = results.series(names[0])[rows].astype(float)
    way: np.ndarray = results.series(names[1])[rows].astype(float)
    energy = cycle_energy(results, names, cycle)
    box = float(np.ptp(force) * np.ptp(way))
    ratio, width = (energy / box, _width(way, force) / float(np.ptp(way))) if box > 0.0 else (0.0, 0.0)
    points = [way, force, results.series("time")[rows]]
    if cycle.first < 0:  # the state before the first step, where it begins, has no row
        points = [np.insert(one, 0, one[0]) for one in points]
    stored = _stored(*points)
    lost = 0.0 if stored <= 0.0 else energy / (2.0 * np.pi * stored)
    width = math.nan if math.isnan(stored) else width
    amplitudes = 0.5 * float(np.ptp(force)), 0.5 * float(np.ptp(way))
    return Numbers(*amplitudes, energy, ratio, width, regime(results, rows), *dissipated(results, cycle), lost)


def _path_cycle(results, index):
    """The cycle that ends at a saved step, or the last before it."""
    row = results.row(index % results.times.size)
    if results.has_life:
        steps = results.of_computed_cycle(results.history["cycle"][row])
        rows = np.searchsorted(results.solved, steps)
        return Cycle(1, int(rows[0]), int(rows[-1]))
    ended = [cycle for cycle in find(results) if results.solved[cycle.last] <= row]
    if not ended:
        raise Error(
            f"{results.path}: no cycle ends before step {results.steps[index]}; give a step after a whole cycle"
        )
    return ended[-1]


def slip_range(
    results: "Results", index: int = -1, rows: slice = slice(None), columns: slice = slice(None), stride: int = 1
) -> np.ndarray:
    """The longest chord of the path of each cell's slip over a cycle, between steps in which the cell is in contact.

    Parameters
    ----------
    results : Results
        The results of a run.
    index : int
        Of a saved step: the cycle is that which ends there, or the last before it; its saved steps are the path.
    rows, columns : slice
        The window: rows are y, columns x.
    stride : int
        Every stride-th cell of the window.

    Returns
    -------
    ndarray
        Slip range, (ny, nx) of the window, m; NaN in cells that are never in contact.

    Raises
    ------
    Error
        If no cycle ends before the step, or fewer than 3 of its steps are saved.
    """
    cycle = _path_cycle(results, index)
    first, last = (int(results.solved[row]) for row in (max(0, cycle.first), cycle.last))
    saved = [k for k in range(results.times.size) if first <= results.row(k) <= last]
    if len(saved) < STEPS:
        text = f"of the cycle from step {first + 1} to {last + 1} {len(saved)} steps are saved"
        raise Error(f"{results.path}: {text}; save at least {STEPS} (petsam -output_every)")
    low, high, _ = rows.indices(results.y.size)
    block, parts = stride * max(1, BLOCK // stride), []
    for k in range(low, high, block):
        part: dict[str, Any] = {"rows": slice(k, min(k + block, high)), "columns": columns, "stride": stride}
        parts.append(_chords([[results.field(n, j, **part) for n in ("slip_x", "slip_y", "state")] for j in saved]))
    return np.concatenate(parts)


def _chords(steps):
    """The longest distance between any two points of each cell's path (x, y, state) in contact."""
    points = [np.where(state != OPEN, x + 1j * y, np.nan) for x, y, state in steps]
    longest = np.where(np.isfinite(points).any(axis=0), 0.0, np.nan)
    for k, one in enumerate(points):
        for other in points[:k]:
            longest = np.fmax(longest, np.abs(one - other))
    return longest


__all__ = ["Numbers", "numbers", "slip_range"]


def __dir__():
    return __all__
