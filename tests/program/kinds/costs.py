"""Outcomes of problems that are checked in numpy, and what their solutions cost, by the properties of the problems."""

import collections

import numpy as np

from kinds import Outcome


def outcome(properties, cost, wrong, line):
    """The outcome of a problem with these properties.

    cost: what its solution cost, by name, empty where there is none; wrong: its faults by name; line: its options.
    """
    text = f"{', '.join(properties or ['plain'])}: " + ", ".join(f"{name} {value:.3g}" for name, value in cost.items())
    if wrong:
        text += f" {wrong}\n    {line}"
    return Outcome(text, bool(wrong), dict(properties=properties, cost=cost, wrong=wrong))


def summary(found):
    """Medians and the most of each cost, by property."""
    costs = collections.defaultdict(list)
    for one in found.values():
        for name in ["all", *(one["properties"] or ["plain"])]:
            costs[name].append(one["cost"])
    return [line_of(name, these) for name, these in costs.items()]


def line_of(name, costs):
    """The line of a property."""
    solved = [cost for cost in costs if cost]
    sums = "".join(
        f"  {key}: median {np.median([cost[key] for cost in solved]):.3g}, most {max(cost[key] for cost in solved):.3g}"
        for key in (solved[0] if solved else [])
    )
    return f"{name:13} {len(costs):4}{sums}"
