"""Numbers in rows, as all results of a structure have them: Numbers; and the way from row to row: solved()."""

import warnings

from ...core.tables import Column, Tabled
from .failures import ENDS, NoSolution
from .sweep import BackboneWarning

UNKNOWN_HERE = f"{Tabled.unknown} for these numbers: those of finer contact grids (-grid_n) show it"
PER_METRE = {"J": "J/m", "N": "N/m", "m3": "m3/m", "m kg^0.5": "m (kg/m)^0.5", "m/s2 kg^0.5": "m/s2 (kg/m)^0.5"}


class Numbers(Tabled):
    """Arrays by their names, in the attribute `numbers`; self.frequency is numbers["frequency"]."""

    columns: dict[str, tuple[str, str]] = {}  # {name: (unit, text)} of the kind of result
    per_metre = False  # True: loads, energies and masses are those of sections in plane strain, per metre
    form = staticmethod("{:.10g}".format)

    def __getattr__(self, name):
        if name != "numbers" and name in self.numbers:
            return self.numbers[name]
        raise AttributeError(name)

    def _unit(self, unit):
        """A unit, of sections that of 1 m."""
        return PER_METRE.get(unit, unit) if self.per_metre else unit

    def _head(self, name, unit):
        """The head of a printed column."""
        own = self._unit(unit)
        return f"{name}/{own}" if own == unit else f"{name}/({own})"

    def more_columns(self) -> list[Column]:
        """Returns the columns beside the numbers, a list of tables.Column; empty unless a kind of result has some."""
        return []

    def table(self) -> list[Column]:
        """All numbers, and what stands beside them.

        Returns
        -------
        list of tables.Column
        """
        found = [*columns_of(self.columns, self.numbers), *self.more_columns()]
        return Column.noted([one._replace(unit=self._unit(one.unit)) for one in found], UNKNOWN_HERE)


def columns_of(columns, numbers):
    """The tables.Column of those of {name: (unit, text)} that are among the numbers {name: array}."""
    return [Column(name, unit, text, numbers[name]) for name, (unit, text) in columns.items() if name in numbers]


def energies(patches, names):
    """Columns of the energy of each patch, from (rows, patches)."""
    text = "dissipated energy of a cycle in this patch"
    return [Column(f"energy_{name}", "J", text, column) for name, column in zip(names, patches.T)]


def reason(error):
    """Words of an error of ENDS, without those that are for contacts alone."""
    return str(error).partition("; for gross slip give")[0]


def solved(values, solve, place, report):
    """Yields (value, solve(value)) until a value has no solution: the first one raises NoSolution, a later one is
    warned of. place(value) says in words where that is; report is called with the number of values done, and of
    all."""
    for k, value in enumerate(values):
        try:
            found = solve(value)
        except ENDS as error:
            if not k:
                raise NoSolution(f"at {place(value)}: {reason(error)}") from error
            warnings.warn(f"ended before {place(value)}: {reason(error)}", BackboneWarning, stacklevel=3)
            return
        if report:
            report(k + 1, len(values))
        yield value, found
