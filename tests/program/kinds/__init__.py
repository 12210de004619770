"""Kinds of random problems, those of ../random_problems.py; each is a module.

OPTIONS: the options of the command line of its own, and its usual number of trials, {name: usual value}; a tuple has
the choices, the usual one first.
trial(seed, folder, given): an Outcome of the problem of a seed, in an empty folder; given: the options. None: the
problem is rejected, and another seed is tried for it. A failed assertion, and a run that does not end, are faults.
summary(found): the lines that are printed at the end; found: {seed: numbers of its Outcome}, of those that have some.
begin(), where there is one, is called before the first trial.
"""

import collections
from typing import NamedTuple, Optional


class Outcome(NamedTuple):
    """What became of a problem."""

    text: str
    fault: Optional[bool] = None  # None: the kind measures, and nothing is a fault
    numbers: dict = {}  # by name, for the log and the summary
    telling: bool = False  # printed as a fault is, though it is none


def codes_of(found):
    """A line of how many runs ended with which exit code."""
    ends = collections.Counter(one["code"] for one in found.values())
    return f"exit codes {dict(sorted(ends.items(), key=str))}"
