"""Random problems of all capabilities on several ranks: the same bits as on one, and an end.

A problem joins two cases of capabilities.py on a random grid under random loads. It runs on one rank and on 2, 3 or 5,
or on as many as --ranks says, which exchange rows as --exchange says; half of the problems have so few rows of cells
that some ranks are without. What differs or does not end is a fault; a pair that petsam rejects is drawn again.
"""

import subprocess

import numpy as np

import capabilities
import conftest
from kinds import Outcome, codes_of
from support import flatten
from test_every_capability import read

OPTIONS = dict(trials=60, ranks=0, cells=40, exchange=("auto", "transpose"))  # ranks 0: 2, 3 or 5


def draw(rng, folder, given):
    """Name, options and ranks of a random problem, whose history is written into the folder."""
    plane, ranks = bool(rng.random() < 0.4), int(rng.choice([2, 3, 5]))
    ranks = given.ranks or ranks
    cases = capabilities.cases(plane)
    names = rng.choice(list(cases), 2, replace=False)
    options, columns = {}, {}
    for name in names:
        own, more = cases[name]
        options.update(own)
        columns = None if columns is None or more is None else {**columns, **more}
    if "disp_x" in (columns or {}):
        columns.pop("load_tx", None)
    few = bool(rng.random() < 0.5)
    nx = int(rng.integers(14, given.cells))
    ny = int(rng.integers(2, ranks) if few and ranks > 2 else rng.integers(5, given.cells * 3 // 5))
    options["grid_n"] = nx if plane else (nx, ny)
    options["friction"] = float(rng.uniform(0.1, 0.8))
    options["steps"] = int(rng.integers(1, 4))
    case = capabilities.write(plane, options, columns, folder)
    if "steady" in options.values():
        case["steps"] = None
    case["allow_edge_contact"] = True
    return f"{names[0]} and {names[1]}, {'row of ' if plane else ''}{options['grid_n']} on {ranks}", case, ranks


def run(launcher, folder, case, ranks, name):
    """Exit code of a run; None: it did not end."""
    try:
        return conftest.execute(launcher, folder, [case, dict(output=name)], ranks, None).code
    except subprocess.TimeoutExpired:
        return None


def differences(one, many):
    """Names of datasets that are not the same to the last bit."""
    one, many = read(one), read(many)
    return sorted(set(one) ^ set(many)) + [
        name
        for name in one
        if name in many and not np.array_equal(one[name], many[name], equal_nan=one[name].dtype.kind == "f")
    ]


def trial(seed, folder, given):
    """What differs; None: the problem is rejected."""
    launcher = conftest.launcher_words()
    name, case, ranks = draw(np.random.default_rng(seed), folder, given)
    code = run(launcher, folder, case, 1, "one.h5")
    if code in (2, 3):
        return None
    other = run(launcher, folder, dict(case, fft_exchange=given.exchange), ranks, "many.h5")
    if other != code:
        fault = f"exit {other}, on one rank {code}: {' '.join(flatten([case]))}"
    else:
        fault = ", ".join(differences(folder / "one.h5", folder / "many.h5"))
    return Outcome(f"{name}: {fault or 'the same'}", bool(fault), dict(code=code))


def summary(found):
    return [codes_of(found)]
