"""Numbers in rows, as all results of a structure have them: Numbers; and the way from row to row: solved()."""

import csv
import warnings

from .structure import ENDS, NoSolution
from .sweep import BackboneWarning


class Numbers:
    """Arrays by their names, in the attribute `numbers`; self.frequency is numbers["frequency"].

    columns  {name: (unit, text)} of the kind of result
    """

    columns = {}

    def __getattr__(self, name):
        if name != "numbers" and name in self.numbers:
            return self.numbers[name]
        raise AttributeError(name)

    def more_columns(self):
        """{head: array} of what stands beside the numbers in to_csv()."""
        return {}

    def to_csv(self, path):
        """Writes all numbers, with names and units in the first line, and what stands beside them."""
        more = self.more_columns()
        with open(path, "w", newline="", encoding="utf-8") as file:
            rows = csv.writer(file)
            rows.writerow([*heads(self.columns), *more])
            for row in zip(*(self.numbers[name] for name in self.columns), *more.values()):
                rows.writerow([f"{value:.10g}" for value in row])


def heads(columns):
    """Names and units of columns, for the first line of a table."""
    return [f"{name} ({unit})" for name, (unit, _) in columns.items()]


def energies(patches, names):
    """{head: array} of the energy of each patch, from (rows, patches)."""
    return {f"energy_{name} (J)": column for name, column in zip(names, patches.T)}


def reason(error):
    """Words of an error of ENDS, without those that are for contacts alone."""
    return str(error).partition("; for gross slip give")[0]


def solved(values, solve, place, report):
    """Yields (value, solve(value)) until a value has no solution: the first one raises NoSolution, a later one is
    warned of. place(value) says in words where that is; report is called with the number of each value and of all."""
    for k, value in enumerate(values):
        if report:
            report(k + 1, len(values))
        try:
            found = solve(value)
        except ENDS as error:
            if not k:
                raise NoSolution(f"at {place(value)}: {reason(error)}") from error
            warnings.warn(f"ended before {place(value)}: {reason(error)}", BackboneWarning, stacklevel=3)
            return
        yield value, found
