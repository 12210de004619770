"""The energies of the cycles of a run."""

import os
from dataclasses import dataclass
from typing import Union

import numpy as np

from ...core.tables import Column, Tabled, read_csv
from ...results import cycles
from ...results.file import Results


@dataclass
class Settling(Tabled):
    """Numbers of cycles, and their energy over that of the last one, (n,)."""

    cycle: np.ndarray
    ratio: np.ndarray

    def table(self) -> list[Column]:
        """The columns.

        Returns
        -------
        list of tables.Column
        """
        return [Column("settling_cycle", "1", "number of the cycle", self.cycle), Column("ratio", "1", "", self.ratio)]


def settling(results: Results) -> Settling:
    """The settling of a run.

    Parameters
    ----------
    results : Results
        Results of petsam.

    Returns
    -------
    Settling
    """
    energies = cycles.find(results).energies
    return Settling(np.arange(1.0, energies.size + 1), energies / energies[-1])


def read(path: Union[str, os.PathLike]) -> Settling:
    """Reads a table of petsam-one.

    Parameters
    ----------
    path : path
        The CSV file.

    Returns
    -------
    Settling
    """
    return Settling(*(np.array(column.values) for column in read_csv(path)))
