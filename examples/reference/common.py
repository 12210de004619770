"""What the cases share: intervals from evidence, and the program that computes compliances."""

import math
from pathlib import Path
from typing import NamedTuple

TOOL = Path(__file__).resolve().parents[2] / "scripts" / "petsam-compliance"
# orders of convergence that are believed: others say that the sequence is not regular yet, as all ways are of first or
# second order, but for those that are exact to their last digit
MEASURED = (0.5, 2.5)


class Interval(NamedTuple):
    """A quantity and the interval that contains it; size: of what errors are a part, if not of the number itself."""

    quantity: str
    unit: str
    low: float
    high: float
    how: str
    size: float = None


class Way(NamedTuple):
    """One way to a number: its name, and what it gives at three or more resolutions, each twice as fine as the last."""

    name: str
    values: tuple

    def limits(self):
        """Limits extrapolated from each three neighbors, with the order that they show; None if they show none."""
        found = []
        for one, two, three in zip(self.values, self.values[1:], self.values[2:]):
            ratio = (one - two) / (two - three) if two != three else math.inf
            if math.isinf(ratio):
                found.append((three, math.inf))
            elif ratio > 0 and MEASURED[0] <= math.log2(ratio) <= MEASURED[1]:
                found.append((three + (three - two) / (ratio - 1), math.log2(ratio)))
            else:
                found.append(None)
        return found

    def interval(self):
        """Limit -+ half its distance from the finest value and from the limit before. Without an order, the range of
        the last two values on either side of the finest; of the last one, where the sequence closes in too fast."""
        limits, (one, two, last) = self.limits(), self.values[-3:]
        if limits[-1] is None:
            fast = (one - two) / (two - last) > 2 ** MEASURED[1]
            spread = max(abs(last - two), 0 if fast else abs(last - one))
            return last - spread, last + spread
        limit = limits[-1][0]
        before = [other[0] for other in limits[:-1] if other is not None][-1:]
        half = max([abs(limit - last) / 2] + [abs(limit - other) for other in before])
        return limit - half, limit + half

    def __str__(self):
        values = ", ".join(f"{value:.10g}" for value in self.values)
        limit = self.limits()[-1]
        return f"{self.name}: {values}; " + (f"order {limit[1]:.2g}" if limit else "no clear order")


def over_places(found, cells, count=4):
    """Means of the numbers found(factor) over `count` factors on the widths of cells.

    An edge, `cells` of them from the middle, so takes all places within a cell: means converge regularly where the
    numbers of one grid do not.
    """
    runs = [found(1 + k / (count * cells)) for k in range(count)]
    return {name: sum(float(run[name]) for run in runs) / count for name in runs[0]}


def closed(quantity, unit, value, how, digits=10):
    """The interval of a closed form: all numbers that round to the same digits."""
    value = float(value)
    half = 10.0 ** (math.floor(math.log10(abs(value))) - digits + 1)
    return Interval(quantity, unit, value - half, value + half, how)


def covered(quantity, unit, ways, how="", size=None):
    """The interval that covers those of all ways; `how` goes before what each way has found."""
    ends = [way.interval() for way in ways]
    text = ". ".join(([how] if how else []) + [str(way) for way in ways])
    return Interval(quantity, unit, min(low for low, _ in ends), max(high for _, high in ends), text, size)


def all_covered(units, ways):
    """The intervals of quantities, {name: unit}, each covered by all ways, {name of a way: its numbers at each of its
    resolutions, as {quantity: value}}."""
    return [
        covered(name, unit, [Way(way, tuple(float(found[name]) for found in runs)) for way, runs in ways.items()])
        for name, unit in units.items()
    ]


def rounded(interval):
    """The interval with its ends rounded outwards, to two digits of its width."""
    width = interval.high - interval.low
    step = 10.0 ** (math.floor(math.log10(width)) - 1) if width > 0 else abs(interval.high) * 1e-12
    low, high = math.floor(interval.low / step) * step, math.ceil(interval.high / step) * step
    places = max(2, 2 + math.ceil(math.log10(max(abs(low), abs(high)) / step)))
    return interval._replace(low=float(f"{low:.{places}g}"), high=float(f"{high:.{places}g}"))
