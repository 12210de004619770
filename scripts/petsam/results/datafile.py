"""Common parts of all files of results: opening, damaged files, numbers of the history, units. SI units."""

import contextlib
import os
import re
import textwrap
from collections.abc import Mapping
from typing import Any, Optional, Union

import h5py
import numpy as np

from ..core.errors import Error, short, there_are
from ..core.files import decoded, need_regular, state_of
from ..core.hdf5 import DAMAGED, fresh
from ..core.shown import Shown

WHOLE = 1 << 27  # maximum number of values read at once; a damaged file may claim any number


class NotSaved(Error):
    """A step or a time, `wanted`, without fields in the file at `path`, and the reason why there are none."""

    def __init__(self, path: str, wanted: str, reason: str) -> None:
        super().__init__(f"{path}: {wanted}: {reason}")
        self.path, self.wanted, self.reason = path, wanted, reason


class Named(dict):
    """Values by name; a name that is not there is an Error of the file at path, which names those that are."""

    def __init__(self, path: str, values: Mapping) -> None:
        super().__init__(values)
        self.path = path

    def __missing__(self, name):
        raise Error(f"{self.path}: has no {short(name)}{there_are(name, sorted(self), 'it has')}")


class History(Named):
    """Values by name of every load step, beside which there are matrices."""

    def __init__(self, path: str, values: Mapping, matrices: Mapping) -> None:
        super().__init__(path, values)
        self.matrices = matrices

    def __missing__(self, name):
        if name in self.matrices:
            raise Error(f"{self.path}: {name} is a matrix for every step: ask for matrices[{name!r}]")
        return super().__missing__(name)


class Datafile(Shown):
    """Common base of the files of petsam and of petsam-stress: path, and label in pictures, by default the file's name.
    Raises MissingFile if there is no such file, and an Error if it cannot be read."""

    label: str
    times: np.ndarray
    history: History
    matrices: Named
    units: Named
    parameters: Named
    file: Any = None  # of HDF5
    _state: Any = None  # what state_of() has found when the file was opened
    temporary = False  # whether the file goes with this object: see petsam.run()

    def __init__(self, path: Union[str, os.PathLike], label: Optional[str] = None) -> None:
        self.path = str(path)
        self.label = label or os.path.splitext(os.path.basename(self.path))[0]
        with self._reading():
            need_regular(self.path)
            self._open()
            try:
                self._read()
            except BaseException:
                self.close()
                raise

    def _read(self):
        """Reads what the file has besides fields."""
        raise NotImplementedError

    def __copy__(self):
        """Another one of the same open file."""
        one = object.__new__(type(self))
        one.__dict__.update(self.__dict__)
        return one

    def __reduce__(self):
        """A copy in another process opens the file."""
        if self.temporary:
            raise Error(
                f"{self.path}: is a temporary file, which no copy of its results can keep: give petsam.run() an output"
            )
        return type(self), (os.path.abspath(self.path), self.label)

    @contextlib.contextmanager
    def _reading(self):
        """Context in which the file is read: exceptions of HDF5, and of a layout that is not petsam's, become Error."""
        try:
            self._renew()
            yield
        except Error:
            raise
        except DAMAGED as error:
            raise self._error(error) from error

    def _open(self):
        self._state, self.file = state_of(self.path), fresh(self.path)

    def _renew(self):
        """Opens the file once more where a run has written to it since: nodes of indices, which are read when they are
        needed, may lie beyond the end that HDF5 noted when it opened the file."""
        if not self.file or self.parameters.get("closed", 1):
            return
        now = state_of(self.path)
        if now and now != self._state and now[:2] == self._state[:2]:
            self._open()

    def _read_axes(self, names, fewest):
        """The coordinates, each of at least so many numbers that increase; then /history and the parameters."""
        axes = [self._row(_own(self.file, name), name) for name in names]
        for name, axis, least in zip(names, axes, fewest):
            if axis.size < least or not np.all(np.isfinite(axis)) or not np.all(np.diff(axis) > 0.0):
                raise ValueError(f"/{name} is not {least} or more numbers that increase")
        history, self.units = self._read_table("history")
        self.matrices = Named(self.path, {name: self._matrices(name) for name in self._names_of_matrices()})
        self.history = History(self.path, history, self.matrices)
        self.parameters = Named(self.path, self.file.attrs)
        return axes

    def _read_table(self, group):
        """Values by name of a group of rows, and their units."""
        columns = _own(self.file, group)
        columns = {name: _own(columns, name) for name in columns}
        columns = {name: data for name, data in columns.items() if not _is_matrices(data)}
        values = {name: self._row(data, f"{group}/{name}") for name, data in columns.items()}
        units = {name: self._unit(data, f"{group}/{name}") for name, data in columns.items()}
        return Named(self.path, values), Named(self.path, units)

    def _names_of_matrices(self):
        columns = _own(self.file, "history")
        return [name for name in columns if _is_matrices(_own(columns, name))]

    def _matrices(self, name):
        data = _own(self.file, f"history/{name}")
        if data.dtype.kind != "f" or data.size > WHOLE:
            raise ValueError(f"/history/{name} is no series of matrices")
        return data[:]

    @staticmethod
    def _row(data, name):
        """All values of a dataset that has one dimension."""
        if getattr(data, "ndim", None) != 1 or data.dtype.kind not in "biuf":
            raise ValueError(f"/{name} is not a row of numbers")
        if data.size > WHOLE:
            raise ValueError(f"/{name} has {data.size} values")
        return data[:]

    @staticmethod
    def _unit(data, name):
        unit = data.attrs["units"] if "units" in data.attrs else None
        unit = decoded(unit) if isinstance(unit, bytes) else unit
        if not isinstance(unit, str):
            raise ValueError(f"/{name} has no attribute units that is a text")
        return short(unit)

    def _lines(self, kind, count, names):
        """Lines of a listing: names with their units, as of arrays of one kind and shape."""
        if not names:
            return []
        tie = "\0"  # between a name and its unit
        words = ", ".join(name if unit in ("", "1") else f"{name} ({unit})".replace(" ", tie) for name, unit in names)
        indents = {"initial_indent": f"  {kind:<10}{count}: ", "subsequent_indent": " " * 12}
        return [textwrap.fill(words, 110, break_on_hyphens=False, **indents).replace(tie, " ")]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self) -> None:
        """Closes the file; what has been read stays."""
        self.file.close()

    def _error(self, error):
        changed = self._state not in (None, state_of(self.path))
        return Error(f"{self.path}: {'has changed since it was opened: open it again' if changed else _reason(error)}")

    def meaning(self, name: str) -> str:
        """The meaning of a number of the history, as the file has it.

        Parameters
        ----------
        name : str
            Its name in /history.

        Returns
        -------
        str
            The attribute long_name; "" without one.

        Raises
        ------
        Error
            If there is no such number.
        """
        with self._reading():
            text = _own(self.file, f"history/{name}").attrs.get("long_name", "")
        return short(decoded(text) if isinstance(text, bytes) else str(text))

    def nearest(self, saved: np.ndarray, wanted: float, what: str = "time") -> int:
        """The saved step that is nearest to a time, or to another number that rises from step to step.

        Parameters
        ----------
        saved : ndarray
            The times (s), or numbers, of the saved steps.
        wanted : float
            The time (s), or number.
        what : str
            The name of the number in messages.

        Returns
        -------
        int
            Index of the saved step, from 0.

        Raises
        ------
        NotSaved
            If it lies outside those of the saved steps.
        """
        low, high = float(saved[0]), float(saved[-1])
        slack = 1e-9 * max(abs(low), abs(high))
        if not low - slack <= wanted <= high + slack:
            raise NotSaved(self.path, f"{what} {wanted:g}", f"fields were saved from {low:g} to {high:g}")
        return int(np.argmin(np.abs(saved - wanted)))


def _own(group, name):
    """Returns the part of a group with this name; a link to another file, which petsam does not write, is rejected."""
    found = None if isinstance(group.get(name, getlink=True), h5py.ExternalLink) else group[name]
    if found is None or isinstance(found, h5py.Dataset) and (found.external or found.is_virtual):
        raise ValueError(f"{name} is in another file")
    return found


def _nodes(group):
    """Name: what a group has of this name itself, not by a link to another place."""
    local = [name for name in group if isinstance(group.get(name, getlink=True), h5py.HardLink)]
    return {name: group[name] for name in local}


def _is_matrices(data):
    """True if a dataset of /history has a matrix for every step."""
    return getattr(data, "ndim", None) == 3


def need_index(file, index):
    """Error where index, from 0 or from -1, is not that of a saved step of the file."""
    count = file.times.size
    if not count:
        raise Error(f"{file.path}: no fields were saved")
    if not -count <= index < count:
        saved = "1 step is saved, index 0 or -1"
        if count > 1:
            saved = f"{count} steps are saved, indices 0 to {count - 1}, or -1 to {-count} from the end"
        place = f"; that of load step {index} is of_step({index})" if index in file.steps else ""
        raise NotSaved(file.path, f"index {index}", saved + place)


def _some(numbers):
    words = [str(n) for n in numbers]
    return ", ".join(words if len(words) <= 8 else words[:4] + ["..."] + words[-2:])


def _reason(error):
    """The end of HDF5's chain of messages, in a line."""
    text = str(error.args[0] if isinstance(error, KeyError) else error).replace("\n", " ")
    if "file signature not found" in text:
        return "is not an HDF5 file: give results of petsam -output, petsam-stress or petsam-study"
    if "unable to lock file" in text.lower():
        return "is being written by a run"
    if lacks := re.search(r"object '(\w+)' doesn't exist", text):
        return f"is not a results file of petsam: has no /{lacks[1]}; petsam -output writes one"
    text = short(text or type(error).__name__, 300)
    return "cannot be read: " + text if isinstance(error, OSError) else "is not a results file of petsam: " + text
