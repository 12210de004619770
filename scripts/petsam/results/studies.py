"""Reading of petsam-study's results.h5: inputs and scalars of all cases. SI units."""

import os
import re
from typing import Any, Optional, Union

import numpy as np

from ..core import units
from ..core.declared import FOLLOWING, OPTIONS
from ..core.errors import Error, counted, library, short, there_are
from ..core.files import decoded, need_regular
from ..core.hdf5 import DAMAGED, opened
from ..core.shown import Shown
from .datafile import WHOLE, _own, _reason

NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[eE]([+-]?\d+))?([a-zA-Z].*)?")


def _measured(text):
    """A text as a number in SI units, and its unit ("": none); None where it is no such text."""
    match = NUMBER.fullmatch(text.strip())
    if not text.strip():
        return float("nan"), ""
    if not match:
        return None
    if match[3] and match[3] not in FOLLOWING:  # one with a factor, as kgf
        unit = units.quantity(match[3])
        return (float(text.strip()[: match.start(3)]) * units.size(match[3], unit), unit) if unit else None
    unit, power = FOLLOWING[match[3]] if match[3] else ("", 0)
    return float(f"{match[1]}e{int(match[2] or 0) + power}"), unit


def _in_si(values):
    """An input whose texts are numbers with units as numbers in SI units, and the unit; else as it is, and ""."""
    read = [_measured(text) for text in values.tolist()] if values.dtype.kind == "U" else [None]
    units = {unit for _, unit in filter(None, read)} - {""}
    if None in read or len(units) != 1:
        return values, ""
    return np.array([number for number, _ in read]), units.pop()


class Study(Shown):
    """The table of a study, petsam-study's results.h5, which is read whole.

    Parameters
    ----------
    path : str
        The file.
    label : str, optional
        Its name in pictures; the folder's name.

    Attributes
    ----------
    cases : ndarray of str
        Names of the cases, (cases,).
    codes : ndarray of int
        Their exit codes, (cases,); -1 where a case has not run.
    inputs : dict
        {name: array (cases,)} of numbers or of texts; numbers with units (2.6mm) are in SI units.
    results : dict
        {name: array (cases,)} of numbers, NaN where there is none.
    units : dict
        {name: unit}, of the results.
    parameters : dict
        Names of the table of cases (`study`) and the options that all cases have (`options`).

    Raises
    ------
    MissingFile
        If there is no such file.
    Error
        If it cannot be read.
    """

    program = "petsam-study"  # that writes such files

    def __init__(self, path: Union[str, os.PathLike], label: Optional[str] = None) -> None:
        self.path = str(path)
        name = os.path.basename(os.path.dirname(os.path.abspath(self.path)))
        self.label = label or name
        try:
            need_regular(self.path)
            with opened(self.path) as file:
                self._read(file)
        except Error:
            raise
        except DAMAGED as error:
            raise Error(f"{self.path}: {_reason(error)}") from error

    def __reduce__(self):
        return type(self), (os.path.abspath(self.path), self.label)

    def __repr__(self):
        inputs = f" of {', '.join(self.inputs)}" if self.inputs else ""
        return f"Study({self.path!r}: {counted(self.cases.size, 'case')}{inputs})"

    def _read(self, file):
        self.parameters = {name: str(file.attrs[name]) for name in ("study", "options") if name in file.attrs}
        self.cases = self._column(file, "case")
        self.codes = self._column(file, "exit_code")
        groups = {name: _own(file, name) for name in ("inputs", "results") if name in file}
        columns = {group: {name: self._column(data, name) for name in data} for group, data in groups.items()}
        measured = {name: _in_si(values) for name, values in columns.get("inputs", {}).items()}
        self.inputs = {name: values for name, (values, _) in measured.items()}
        stated = {name: data.attrs.get("units") for name, data in groups.get("inputs", {}).items()}
        self._input_units = {name: short(str(stated[name] or unit)) for name, (_, unit) in measured.items()}
        self.results = columns.get("results", {})
        self.units = {name: short(str(groups["results"][name].attrs.get("units", "1"))) for name in self.results}
        for values in (*self.inputs.values(), *self.results.values(), self.codes):
            if values.size != self.cases.size:
                raise ValueError("its columns have different lengths")

    @staticmethod
    def _column(group, name):
        data = _own(group, name)
        if getattr(data, "ndim", None) != 1 or data.size > WHOLE:
            raise ValueError(f"/{name} is not a row")
        if data.dtype.kind in "biuf":
            return data[:]
        return np.array([decoded(one) if isinstance(one, bytes) else one for one in data[:].tolist()], dtype=str)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        """Nothing is open: the table is read whole."""

    def to_dataframe(self) -> Any:
        """The table with a row per case.

        Returns
        -------
        pandas.DataFrame
            Columns exit_code, the inputs and the results by name, the case as the index; the units in `attrs["units"]`.
        """
        results = {self._shown(name): values for name, values in self.results.items()}
        columns = {"exit_code": self.codes, **self.inputs, **results}
        table = library("pandas").DataFrame(columns, index=library("pandas").Index(self.cases, name="case"))
        units = {name: self.unit_of_input(name) for name in self.inputs}
        table.attrs["units"] = {**units, **{self._shown(name): unit for name, unit in self.units.items()}}
        return table

    def to_xarray(self) -> Any:
        """The results over the inputs.

        Returns
        -------
        xarray.Dataset
            The results by name, with their units; its dimensions are the inputs that vary, where the cases are all
            their combinations, else `case`, along which the inputs are coordinates.
        """
        results = {self._shown(name): (values, self.units[name]) for name, values in self.results.items()}
        results["exit_code"] = self.codes, "1"
        levels, places = self._levels()
        if places is None:
            inputs = {name: ("case", values) for name, values in self.inputs.items()}
            fields: dict = {name: ("case", values, {"units": unit}) for name, (values, unit) in results.items()}
            return library("xarray").Dataset(fields, {"case": self.cases, **inputs})
        shape = [values.size for values in levels.values()]
        fields = {
            name: (list(levels), values[places].reshape(shape), {"units": unit})
            for name, (values, unit) in results.items()
        }
        axes = {name: ((name,), values, {"units": self.unit_of_input(name)}) for name, values in levels.items()}
        return library("xarray").Dataset(fields, axes)

    def _levels(self):
        """The values of the inputs that vary, and the cases in the order of their combinations; None if these are not
        all of them, each once."""
        found = {name: np.unique(values, return_inverse=True) for name, values in self.inputs.items()}
        found = {name: pair for name, pair in found.items() if pair[0].size > 1}
        levels = {name: values for name, (values, _) in found.items()}
        shape = [values.size for values in levels.values()]
        if not levels or np.prod(shape) != self.cases.size:
            return levels, None
        places = np.ravel_multi_index([np.ravel(place) for _, place in found.values()], shape)
        return levels, np.argsort(places) if np.unique(places).size == places.size else None

    def _shown(self, name):
        """A result's name in a table beside the inputs."""
        return name + "_end" if name in self.inputs else name

    def column(self, name: str, option: str = "") -> tuple[np.ndarray, str]:
        """The values of an input or of a result, and the unit.

        Parameters
        ----------
        name : str
            Its name; a result that has an input's name ends with _end.
        option : str
            What the message names where there is no such column.

        Returns
        -------
        values : ndarray
            Numbers or texts, (cases,).
        unit : str
            Unit of a result; "" of an input: see unit_of_input().

        Raises
        ------
        Error
            If there is no such column.
        """
        if name in self.inputs:
            return self.inputs[name], ""
        bare = name[:-4] if name.endswith("_end") and name[:-4] in self.inputs else name
        if bare not in self.results:
            what = f"{option} {short(name)}".strip()
            raise Error(f"{self.path}: {what}: there is no such column{there_are(name, self.names)}")
        return self.results[bare], self.units[bare]

    def unit_of_input(self, name: str) -> str:
        """The unit of an input: that of the result of its name, in plane strain per metre; else of option or values.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        str
            The unit, "" if there is none.
        """
        unit = OPTIONS.get(name)
        return self.units.get(name, unit) if unit else self._input_units.get(name, "")

    @property
    def names(self) -> list[str]:
        """Names of all columns."""
        return [*self.inputs, *(name + "_end" if name in self.inputs else name for name in self.results)]


def is_study(path: Union[str, os.PathLike]) -> bool:
    """True if a file looks like the table of a study; False if it cannot be read, too."""
    try:
        need_regular(str(path))
        with opened(str(path)) as file:
            return all(name in file for name in ("case", "exit_code", "cases"))
    except (Error, *DAMAGED):
        return False
