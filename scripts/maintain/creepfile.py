"""The file of a table of creep forces, which include/petsam/creep.h reads: its numbers, and how it is written.

The forces over v are those of linear theory times (1 - v)^2, and a rest. Between its nodes are cubic splines, whose
value takes four coefficients along each axis, and whose first two derivatives are continuous. Across the ends of turn
and rise they are continued by the symmetries; at the ends of a/b and v by the third derivative.

File, little-endian: the bytes PETSAMCF; version, byte order mark, four numbers of nodes, cells, 0 (8 uint32); first and
last log(a/b), Poisson's ratio, own error (median, 90 %, worst, over mu N) and the number of its cases (7 float64);
splines of log C11, C22, C23 (nodes of a/b, 3 values of Poisson's ratio, 3; float64); those of the linear theory, forces
by X, Y, Z (nodes of a/b, 3, 3; float64); steps of the rests (nodes of a/b, v, 3; float32), and the rests at the nodes
over the steps (nodes of a/b, v, turn, rise, 3; int16, and zeros up to a multiple of 4 bytes); a checksum of all before
(FNV-1a over words of 4 bytes, uint64).
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Union

import numpy as np

MAGIC, VERSION, MARK = b"PETSAMCF", 2, 0x01020304
HEADER, NUMBERS = np.dtype("<u4"), np.dtype("<f8")
STEPS = 32767  # whole number of the greatest force


@dataclass(frozen=True, eq=False)
class Contents:
    """The numbers of a file.

    Parameters
    ----------
    range : tuple of float
        First and last a/b.
    poisson : float
        Poisson's ratio of the bodies.
    scales : ndarray
        Splines of log C11, C22, C23 at Poisson's ratios 0, `poisson` and 0.5, (nodes of a/b, 3, 3).
    linear : ndarray
        Splines of the linear theory, forces by X, Y, Z, (nodes of a/b, 3, 3).
    nodes : ndarray
        Rests of the forces over v, over their steps, (nodes of a/b, v, turn, rise, 3), int16.
    steps : ndarray
        (nodes of a/b, v, 3), float32.
    cells : int
        Cells along an axis of the grids that it is made with.
    error : tuple of float
        Error of the forces of its nodes, over mu N (Mz: mu N c): median, 90 %, worst, and the number of cases.
    """

    range: tuple[float, float]
    poisson: float
    scales: np.ndarray
    linear: np.ndarray
    nodes: np.ndarray
    steps: np.ndarray
    cells: int = 0
    error: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)

    def write(self, path: Union[str, Path]) -> None:
        """Writes the table to a file.

        Parameters
        ----------
        path : path
            The file.
        """
        n = self.nodes.shape[:4]
        head = np.array([VERSION, MARK, *n, self.cells, 0], HEADER)
        numbers = np.array([*np.log(self.range), self.poisson, *self.error], NUMBERS)
        data = MAGIC + head.tobytes() + numbers.tobytes() + self.scales.astype(NUMBERS).tobytes()
        data += self.linear.astype(NUMBERS).tobytes()
        data += self.steps.astype("<f4").tobytes() + self.nodes.astype("<i2").tobytes()
        data += bytes(-len(data) % 4)
        Path(path).write_bytes(data + checksum(data).to_bytes(8, "little"))


def rounded(nodes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Forces at nodes as whole numbers of steps, so that the greatest of each a/b, v and force is STEPS.

    Parameters
    ----------
    nodes : ndarray
        (nodes of a/b, v, turn, rise, 3).

    Returns
    -------
    whole : ndarray
        Of the same form, int16.
    steps : ndarray
        (nodes of a/b, v, 3), float32.
    """
    steps = (np.abs(nodes).max(axis=(2, 3)) / (STEPS - 1)).astype(np.float32)
    by = np.where(steps > 0.0, steps, 1.0).astype(float)
    return np.rint(nodes / by[:, :, None, None]).astype(np.int16), steps


def solved(values: np.ndarray) -> np.ndarray:
    """The coefficients of splines along a/b, whose third derivative is continued beyond its ends.

    Parameters
    ----------
    values : ndarray
        Values at the nodes of a/b, (n, ...).

    Returns
    -------
    ndarray
        Of the form of values.
    """
    n = len(values)
    matrix = 4.0 * np.eye(n) + np.eye(n, k=1) + np.eye(n, k=-1)
    matrix[0, :4] += (4, -6, 4, -1)
    matrix[-1, -4:] += (-1, 4, -6, 4)
    return np.tensordot(np.linalg.inv(matrix / 6.0), values, 1)


def checksum(data: bytes) -> int:
    """The checksum of a file: FNV-1a with 64 bits, over words of 4 bytes.

    Parameters
    ----------
    data : bytes
        A multiple of 4 bytes.

    Returns
    -------
    int
    """
    found = 0xCBF29CE484222325
    for word in np.frombuffer(data, HEADER).tolist():
        found = ((found ^ word) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return found
