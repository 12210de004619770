"""Statements of a file about its map, and the base of the readers of one format each."""

import os
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple, Optional

import numpy as np

from ....core.files import decoded
from ....core.texttable import Form, Text
from .. import headers

NUMPY, HDF5, ZIP = b"\x93NUMPY", b"\x89HDF\r\n\x1a\n", b"PK\x03\x04"
MATLAB, USER_BLOCK = b"MATLAB 7.3", 512
ARRAYS = (".npy", ".npz", ".h5", ".hdf5", ".mat")  # endings of arrays, some of which have the contents of others
START = 4096  # bytes of a file that show its format
TEXTS = (".csv", ".txt")  # endings of texts
OTHERS = (".tsv", ".dat", ".xyz", ".prn", ".asc", ".grd", "")  # endings that texts may have, and files of instruments


class Stated(NamedTuple):
    """Statements of a file about its values (all lengths in m); None where it makes none."""

    values: np.ndarray  # (rows, columns)
    unit: Optional[float] = None
    size: Optional[tuple] = None
    center: Optional[tuple] = None
    quantity: Optional[str] = None
    top: Optional[bool] = None  # whether the first row has the largest y
    remarks: tuple = ()
    doubts: tuple = ()  # texts of warnings
    sides: tuple = (None, None)  # size along x, y of a file that may state only one of them
    lines: dict = {}  # of the statements unit, x and y in a text, and of its first values
    name: str = ""  # of the dataset
    spans: Optional[tuple] = None  # size along x, y in a unit that the file does not state
    missing: Optional[float] = None  # value of missing points, which the file states
    layout: str = "array"  # what lists of points are looked for in: "array", "text", "library"; "grid": none can be


@dataclass(frozen=True)
class How:
    """How a file is read: what no file states of itself."""

    form: Form = field(default_factory=Form)  # of a text
    units: Optional[float] = None  # m, as given beside the file
    dataset: Optional[str] = None
    channel: Optional[str] = None
    table: bool = False  # whether it is a text by the caller's word
    lengths: bool = True  # whether the values are lengths, whose unit is read


class Source:
    """A file that a reader may recognize; text: its lines, read once for all readers where it is one."""

    def __init__(self, path, how):
        self.path, self.how, self.text = path, how, Text(path, how.form)
        self.ending = os.path.splitext(path)[1].lower()
        with open(path, "rb") as file:
            self.start = file.read(START)

    @cached_property
    def is_text(self):
        """True if the file is a text by its name, or by its contents where the name leaves this open."""
        if self.how.table or self.ending in TEXTS:
            return not (self.is_numpy or self.is_hdf5)
        return self.ending in OTHERS and self.is_printable

    @cached_property
    def is_numpy(self):
        """True if the first bytes are those of .npy, or of .npz, a zip of such members."""
        first = self.start[30 : 30 + int.from_bytes(self.start[26:28], "little")]  # name of a zip's first member
        return self.start.startswith(NUMPY) or self.start.startswith(ZIP) and first.endswith(b".npy")

    @cached_property
    def is_hdf5(self):
        """True if the first bytes are those of HDF5, or of .mat of Matlab 7.3, which is HDF5 behind a header."""
        matlab = self.start.startswith(MATLAB) and self.start[USER_BLOCK:].startswith(HDF5)
        return self.start.startswith(HDF5) or matlab

    @property
    def is_printable(self):
        """True if the first bytes are letters, whatever the name is."""
        return all(c.isprintable() or c in "\r\n\t\f" for c in decoded(self.start))

    @cached_property
    def is_list(self):
        """True if a text is one that this package takes without a structure of its own: .asc is an instrument's."""
        return self.is_text and (self.how.table or self.ending not in (".asc", ".grd", ""))

    def header(self, lateral=None):
        """The Header of a text; lateral: unit (m) of lengths along x and y that have none."""
        return headers.stated(self.path, self.text.header, lateral)


class Reader:
    """One format."""

    family = ""  # name for --format
    states: tuple[str, ...] = ()  # what a file of it may state

    def recognizes(self, source: Source) -> bool:
        """True if the file is one of this format."""
        raise NotImplementedError

    def read(self, source: Source) -> Stated:
        """The statements of the file; Error with the cure for one that is no map."""
        raise NotImplementedError
