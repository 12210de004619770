"""The parts of a run's results: a restart writes the steps from its checkpoint on into a file beside the first one."""

import os

import numpy as np

from ..core.errors import Error

IDENTITY, FOLLOWS = "part_identity", "part_follows"  # attributes: of a file, and of the one that it follows


def name_of(path, number):
    """The name of a part, from 1: r.h5, r.part2.h5, ..."""
    stem, ending = os.path.splitext(path)
    return path if number == 1 else f"{stem}.part{number}{ending}"


def follows(part, before):
    """True if a file is the part after another one: else it is of another run, which had the same name."""
    identity = before.parameters.get(IDENTITY)
    return identity is not None and part.parameters.get(FOLLOWS) == identity


def append(results, part):
    """Appends a part to the results; what those have of its steps, which were solved again, counts no more."""
    rows, end = part.before - results.before, results.before + results._complete
    if not 0 <= rows <= results._complete:
        raise Error(f"{part.path}: begins after step {part.before}, and the steps before it end with {end}")
    cycles = part._cycles_before - results._cycles_before
    if not 0 <= cycles <= min((values.size for values in results.wear.values()), default=0):
        raise Error(f"{part.path}: begins after {part._cycles_before} computed cycles, which are not all there")
    saved = [k for k, step in enumerate(results.steps) if step <= part.before]
    last = results.steps[saved[-1]] if saved else 0
    more = [k for k, step in enumerate(part.steps) if step > last]
    count = part.history["time"].size
    results.history.update(_joined(results.history, rows, part.history, count, part._fills))
    results.matrices.update(_joined(results.matrices, rows, part.matrices, count, {}))
    computed = max((values.size for values in part.wear.values()), default=0)
    results.wear.update(_joined(results.wear, cycles, part.wear, computed, {}))
    results.errors = part.errors
    results.warnings += [one for one in part.warnings if one not in results.warnings]
    results.units.update(part.units)
    results.wear_units.update(part.wear_units)
    results.times = np.concatenate([results.times[saved], part.times[more]])
    results.steps = [results.steps[k] for k in saved] + [part.steps[k] for k in more]
    results._later.append(part)
    results._places = [results._places[k] for k in saved] + [(len(results._later), k) for k in more]


def _joined(one, first, other, count, fills):
    """Columns of two tables, of one the first rows. A column that it lacks gets what the other says, else NaN."""
    joined = {}
    for name in {**one, **other}:
        some = other[name] if name in other else one[name]
        before = one[name][:first] if name in one else np.full((first, *some.shape[1:]), fills.get(name, np.nan))
        joined[name] = np.concatenate(
            [before, other[name] if name in other else np.full((count, *some.shape[1:]), np.nan)]
        )
    return joined
