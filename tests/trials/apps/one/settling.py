"""The energies of the cycles of a run."""

from dataclasses import dataclass

import numpy as np

from ...core.tables import Tabled, column
from ...results import Results, cycles


@dataclass
class Settling(Tabled):
    """Settling: the energies of cycles over that of the last one, (n,)."""

    settling_cycle: np.ndarray = column("1", "number of the cycle")
    ratio: np.ndarray = column("1", "energy over that of the last cycle")


def settling(results: Results) -> Settling:
    """The settling of a run."""
    energies = cycles.find(results).energies
    return Settling(np.arange(1.0, energies.size + 1), energies / energies[-1])
