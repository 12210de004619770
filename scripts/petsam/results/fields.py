"""The fields of saved steps in results: by name, step, window and stride; layers; edges. SI units."""

from collections.abc import Iterable
from functools import cached_property
from typing import Any

import h5py
import numpy as np

from ..core.errors import Error, short, there_are
from ..core.files import decoded
from .datafile import _nodes, _own, need_index
from .steps import Steps

OPEN, STICK, SLIP = 0, 1, 2  # /state
DEPTHS = ("wear_depth1", "wear_depth2")  # removed of body 1 and 2
EDGES = ("contact_edge", "stick_edge")
BLOCK = 256  # rows read at a time, which bounds the memory; strides in HDF5 itself are slow


class Fields(Steps):
    """The fields of Results."""

    x: np.ndarray
    y: np.ndarray
    _held: int  # saved steps of this file alone
    _places: list[tuple[int, int]]  # of each saved step the part that has it, and its index there
    _later: Any = ()  # parts of the same run

    @property
    def _sources(self):
        """This file and the later parts; not kept as a list, for results that hold themselves live on until gc."""
        return [self, *self._later]

    def _place(self, index):
        """The part that has a saved step, and its index there."""
        number, index = self._places[index]
        return self._sources[number], index

    def _layer_groups(self):
        """Name: group with fields in layers."""
        groups = {name: node for name, node in _nodes(self.file).items() if isinstance(node, h5py.Group)}
        return {name: group for name, group in groups.items() if "z" in group}

    @cached_property
    def depths(self) -> list[str]:
        """Names of the fields of removed depth that the file has."""
        with self._reading():
            return [name for name in DEPTHS if self._all_have(name)]

    @cached_property
    def fields(self) -> list[str]:
        """Names of all fields that the file has."""
        with self._reading():
            return [name for name, node in _nodes(self.file).items() if self._is_field(node) and self._all_have(name)]

    def _is_field(self, node):
        """True if a node of this file is a field of its saved steps."""
        return getattr(node, "ndim", 0) == 3 and self._has_saved(node) and node.shape[1:] == (self.y.size, self.x.size)

    def _has_saved(self, data):
        """True if a dataset has the saved steps of this file; it may have one more where a run was killed."""
        return data.shape[:1] == (self._held,) or not self.parameters.get("closed", 1) and data.shape[0] > self._held

    @cached_property
    def layered(self) -> list[str]:
        """Names GROUP/NAME of the fields in layers below the cells (bodies that yield): field() has (nz, ny, nx)."""
        with self._reading():
            names = [f"{place}/{name}" for place, group in self._layer_groups().items() for name in group]
            return [name for name in names if getattr(self.file[name], "ndim", 0) == 4 and self._all_have(name)]

    @cached_property
    def layer_z(self) -> np.ndarray:
        """Middles of the layers, (nz,), m, into body 2: those of body 1 are negative; Error if there are no layers."""
        return self.z_of(self.layered[0] if self.layered else "plastic")

    def z_of(self, name: str) -> np.ndarray:
        """The middles of the layers of a field, whose group may have layers of its own.

        Parameters
        ----------
        name : str
            The field, GROUP/NAME, or its group.

        Returns
        -------
        ndarray
            Depths, (nz,), m, into body 2: those of body 1 are negative.

        Raises
        ------
        Error
            If there are no layers.
        """
        if not self.layered:
            raise Error(f"{self.path}: has no layers (petsam -body2_yield, -output_fields usual,plastic)")
        place = name.partition("/")[0] + "/z"
        with self._reading():
            return self._row(_own(self.file, place), place)

    def _all_have(self, name):
        """True if all parts have a dataset."""
        return all(name in source.file for source in self._sources)

    @cached_property
    def vectors(self) -> list[str]:
        """Names without the endings _x and _y of the fields that are components."""
        return [name[:-2] for name in self.fields if name.endswith("_x") and name[:-2] + "_y" in self.fields]

    @property
    def is_steady(self) -> bool:
        """True for steady rolling, in which each step is independent, without slip or energy of a step."""
        return str(self.parameters.get("rolling")) == "steady"

    def flags(self, name: str) -> dict[int, str]:
        """Words for the values of a field of flags (flag_values, flag_meanings).

        Parameters
        ----------
        name : str
            The field.

        Returns
        -------
        dict
            {value: word}, empty of a field of numbers.
        """
        if name not in self.fields:
            return {}
        with self._reading():
            attributes = self._saved(name).attrs
            if "flag_values" not in attributes or "flag_meanings" not in attributes:
                return {}
            words = attributes["flag_meanings"]
            words = (decoded(words) if isinstance(words, bytes) else str(words)).split()
            return {int(value): short(word) for value, word in zip(np.ravel(attributes["flag_values"]), words)}

    def _saved(self, name, source=None):
        """The dataset of a field, or of an edge, in a part: the first unless told."""
        source = source or self
        if name not in source.file:
            names = [*self.fields, *self.layered, *self.edges]
            there = there_are(name, names, "it has") if names else "; it has no field at all"
            raise Error(f"{source.path}: has no {short(name)} (petsam -output_fields){there}")
        return _own(source.file, name)

    def field(
        self, name: str, index: int = -1, rows: slice = slice(None), columns: slice = slice(None), stride: int = 1
    ) -> np.ndarray:
        """A field of a saved step, the last unless told, on a window.

        Parameters
        ----------
        name : str
            Its name, see fields and layered.
        index : int
            Of the saved step, from 0, or from the end with -1; of_step(K) is that of load step K.
        rows, columns : slice
            The window: rows are y, columns x.
        stride : int
            Every stride-th cell of the window.

        Returns
        -------
        ndarray
            (ny, nx) of the window, of layered fields (nz, ny, nx), in SI units: about(name) has the unit.

        Raises
        ------
        NotSaved
            If there is no saved step of this index.
        Error
            If there is no such field, or it cannot be read.
        """
        if name in EDGES:
            raise Error(f"{self.path}: {name} is no field: ask for edge({name!r})")
        low, high, _ = rows.indices(self.y.size)
        need_index(self, index)
        source, index = self._place(index)
        layers = (self.z_of(name).size,) if name in self.layered else ()
        with source._reading():
            data = self._saved(name, source)
            if data.dtype.kind not in "biuf":
                raise ValueError(f"/{name} has no numbers")
            if not source._has_saved(data) or data.shape[1:] != (*layers, self.y.size, self.x.size):
                raise ValueError(f"/{name} has the shape {data.shape}")
        block = stride * max(1, BLOCK // stride)
        blocks = []
        for k in range(low, high, block):
            with source._reading():
                part = data[index, ..., k : min(k + block, high), columns][..., ::stride, ::stride]
                blocks.append(part.astype(float) if part.dtype == np.float32 else part)  # of -output_single
        return np.concatenate(blocks, axis=-2)

    def edge(self, name: str, index: int = -1) -> np.ndarray:
        """The points of an edge of a saved step.

        Parameters
        ----------
        name : str
            "contact_edge" or "stick_edge".
        index : int
            Of the saved step, from 0, or from the end with -1; of_step(K) is that of load step K.

        Returns
        -------
        ndarray
            Points x, y, (points, 2), m.

        Raises
        ------
        NotSaved
            If there is no saved step of this index.
        Error
            If the file has no such edge.
        """
        need_index(self, index)
        source, index = self._place(index)
        with source._reading():
            data = self._saved(name, source)
            if data.dtype.kind != "f" or data.ndim != 3 or not source._has_saved(data) or data.shape[2] != 2:
                raise ValueError(f"/{name} is no edge: its shape is {data.shape}")
            points = data[index]
        return points[np.isfinite(points).all(axis=1)]

    def has(self, names: Iterable[str]) -> bool:
        """True if the file has all of these datasets.

        Parameters
        ----------
        names : iterable of str
            Their names.

        Returns
        -------
        bool
        """
        with self._reading():
            return all(self._all_have(name) for name in names)

    @cached_property
    def edges(self) -> list[str]:
        """The names of contact_edge and stick_edge that the file has."""
        with self._reading():
            return [name for name in EDGES if self._all_have(name)]

    def contact_window(self, index: int, margin: float = 0.15) -> tuple[slice, slice]:
        """The smallest rectangle about the contact, and a margin; all cells without contact.

        Parameters
        ----------
        index : int
            Of the saved step.
        margin : float
            Margin on each side, relative to the width of the contact.

        Returns
        -------
        rows, columns : slice
            The window, as field() takes it.

        Notes
        -----
        The contact is where the state says so, or else where there is pressure; of a file without both it is unknown.
        """
        stride = max(1, max(self.x.size, self.y.size) // 1024)
        known = next((name for name in ("state", "pressure") if name in self.fields), None)
        if known is None:
            return slice(0, self.y.size), slice(0, self.x.size)
        contact = self.field(known, index, stride=stride) != OPEN
        return tuple(
            _window(np.flatnonzero(contact.any(axis=axis)) * stride, stride, size, margin)
            for axis, size in ((1, self.y.size), (0, self.x.size))
        )


def _window(cells, stride, size, margin):
    if not cells.size:
        return slice(0, size)
    more = int(np.ceil(margin * (cells[-1] - cells[0] + stride))) + stride
    return slice(max(0, int(cells[0]) - more), min(size, int(cells[-1]) + stride + more))
