"""Results of a contact: Step, Cycle of a wear simulation, and Stiffness."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ..core.errors import short, there_are
from .errors import ContactError

ROUNDING = 1e-10  # parts of their scale below which numbers are shown as 0
SHORT = 1e-5  # m: the levers of forces whose moments are rounding are this times ROUNDING


def _shown(values, scales):
    """An array of the values, 0 where they are rounding beside their scale."""
    values = np.asarray(values, dtype=float)
    return np.where(np.abs(values) <= ROUNDING * scales, 0.0, values)


class Step:
    """A tried step: a number of each name, step.load_n, step.disp_x, step.dissipated_energy, step.contact_area, ...

    Its parameters are its attributes, too, but the names.

    Parameters
    ----------
    time : float
        Time, s.
    load : ndarray
        N, Tx, Ty (N), Mx, My, Mz (N m), (6,).
    rigid : ndarray
        Displacements z, x, y (m) and rotations x, y, z (rad), (6,); in steady rolling creepages, by their own names.
    status : int
        0, or the code of a step without a solution or at the edge of the grid.
    message : str
        The message of such a step.
    numbers : dict
        {name: value} of the further numbers of /history, NaN where a step has none; the attribute has loads and
        displacements, too.
    names : list of str
        Names of loads and displacements, (12,).

    Attributes
    ----------
    errors : dict
        {name: estimated error}, each in the unit of its number, of a contact with errors=True; NaN: unknown.
    """

    if TYPE_CHECKING:  # numbers are attributes by their names

        def __getattr__(self, name: str) -> float: ...

    def __init__(
        self,
        time: float,
        load: np.ndarray,
        rigid: np.ndarray,
        status: int,
        message: str,
        numbers: Mapping[str, float],
        names: Sequence[str],
    ) -> None:
        self.time, self.load, self.rigid, self.status, self.message = time, load, rigid, status, message
        self.numbers, self._names = dict(zip(names, map(float, [*load, *rigid]))), names
        self.numbers.update(numbers)
        self.__dict__.update(self.numbers)
        pairs = ((name.removesuffix("_error"), value) for name, value in numbers.items() if name.endswith("_error"))
        self.errors = {name: value for name, value in pairs if name in self.numbers}

    def __repr__(self):
        sizes = [
            np.nanmax(np.abs([*some, 0.0])) for some in (self.load[:3], self.load[3:], self.rigid[:3], self.rigid[3:])
        ]
        sizes[1], sizes[3] = max(sizes[1], SHORT * sizes[0]), max(sizes[3], SHORT * sizes[2])
        values = _shown([*self.load, *self.rigid], np.repeat(sizes, 3))
        pairs = [f"{name}={value:.6g}" for name, value in zip(self._names, values)]
        return f"Step(time={self.time:g}, status={self.status}, {', '.join(pairs)})"


class Cycle:
    """A computed cycle of a life: its numbers by their names in /wear, cycle.depth_max1, cycle.jump, ...

    Parameters
    ----------
    numbers : dict
        {name: value}.
    """

    if TYPE_CHECKING:  # numbers are attributes by their names

        def __getattr__(self, name: str) -> float: ...

    def __init__(self, numbers: dict[str, float]) -> None:
        self.numbers = numbers
        self.__dict__.update(numbers)

    def __repr__(self):
        return f"Cycle({', '.join(f'{name}={value:.6g}' for name, value in self.numbers.items())})"


class Stiffness(np.ndarray):
    """A matrix d(loads)/d(displacements), (n, n): an array of numpy whose repr has labels, a row for each load and a
    column for each displacement, {name: unit} each. The unit of a number is that of its row over that of its column.

    Arrays that are computed or cut from it have no labels, since those would not hold for them.
    """

    loads: Mapping[str, str] = {}
    displacements: Mapping[str, str] = {}

    def __new__(cls, values: ArrayLike, loads: Mapping[str, str], displacements: Mapping[str, str]) -> Stiffness:
        matrix = np.array(values, dtype=float).view(cls)
        matrix.loads, matrix.displacements = dict(loads), dict(displacements)
        return matrix

    def __reduce__(self):
        return type(self), (np.asarray(self), self.loads, self.displacements)

    def __array_wrap__(self, values, context=None, return_scalar=False):
        """Returns the result of numpy's operations on the matrix as a plain array or number."""
        return np.asarray(values)[()]  # of no dimension: a number

    def __getitem__(self, key):
        return np.asarray(self)[key]

    @property
    def T(self) -> np.ndarray:
        """The transpose, a plain array."""
        return np.asarray(self).T

    def __repr__(self):
        if not self.loads:  # a view
            return repr(np.asarray(self))
        columns = [_over(name, unit) for name, unit in self.displacements.items()]
        rows = [_over(name.removeprefix("load_").capitalize(), unit) for name, unit in self.loads.items()]
        own = np.sqrt(np.abs(np.diag(np.asarray(self))))  # of the stiffness by which a load moves its own displacement
        lines = [[f"{value:.5g}" for value in row] for row in _shown(self, np.outer(own, own))]
        widths = [max(map(len, column)) for column in zip(columns, *lines)]
        first = max(map(len, rows))
        table = zip(["", *rows], [columns, *lines])
        return "\n".join("  ".join([head.ljust(first), *map(str.rjust, cells, widths)]) for head, cells in table)

    __str__ = __repr__


def _over(name, unit):
    """A quantity over its unit."""
    return f"{name} / ({unit})" if " " in unit else f"{name} / {unit}"


def condensed(k, names):
    """The stiffness k of the displacements of these names, or that name, while the loads of the others stay."""
    rigid, loads = list(k.displacements), list(k.loads)
    several = [names] if isinstance(names, str) else list(names)
    for name in several:
        if name not in rigid:
            raise ContactError(2, f"stiffness: condense {short(name)}: is no displacement{there_are(name, rigid)}")
    kept = [rigid.index(name) for name in several]
    # without those that the bodies do not have, and, where nothing rubs, those without stiffness
    free = [c for c in range(len(rigid)) if c not in kept and k[c, c] != 0.0 and not np.isnan(k[c, c])]
    scale = np.sqrt(np.abs(np.diag(k)[free]))
    try:
        follow = np.linalg.solve(k[np.ix_(free, free)] / np.outer(scale, scale), k[np.ix_(free, kept)] / scale[:, None])
    except np.linalg.LinAlgError:
        raise ContactError(2, "stiffness: condense: the other components have no stiffness together") from None
    found = k[np.ix_(kept, kept)] - k[np.ix_(kept, free)] @ (follow / scale[:, None])
    if isinstance(names, str):
        return float(found[0, 0])
    of = [{all_of[c]: units[all_of[c]] for c in kept} for all_of, units in ((loads, k.loads), (rigid, k.displacements))]
    return Stiffness(found, *of)
