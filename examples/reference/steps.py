"""Limits of many small load steps, of petsam and of halfspace.py."""

from common import Way

STEPS = 16, 32, 64


def limit(values):
    """The limit of values with three numbers of steps, each twice the one before; the last if they show no order."""
    found = Way("", tuple(values)).limits()[-1]
    return found[0] if found else values[-1]


def limits(solve, steps=STEPS):
    """The limits of all numbers of a dictionary that solve(count) returns."""
    runs = [solve(count) for count in steps]
    return {name: limit([run[name] for run in runs]) for name in runs[0]}


def ways(petsam, own, cells="32, 64, 128", counts=STEPS):
    """Both ways, from lists of dictionaries, as all_covered() takes them; counts: petsam's steps."""

    def of_steps(counts):
        return f"limit of {', '.join(map(str, counts))} steps"

    return {
        f"petsam, 64, 128, 256 cells, {of_steps(counts)}": petsam,
        f"halfspace.py, {cells} cells, {of_steps(STEPS)}": own,
    }
