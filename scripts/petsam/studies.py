"""Reading of petsam-study's results.h5: inputs and scalars of all cases. SI units."""

import os
import re

import h5py
import numpy as np

from .errors import Error, Missing, short, there_are
from .files import need_regular
from .isolation import reading
from .results import DAMAGED, WHOLE, _own, _reason

# units of petsam's options, by their names
UNITS = (
    (r"load_(n|tx|ty)", "N"), (r"load_m[xyz]", "N m"), (r"disp_[xyz]|grid_(size|center)|gap_(\w+_)?radius\w*", "m"),
    (r"gap_half_flat_[xy]|gap_roller_\w+", "m"),
    (r"body[12]_layer_thickness|film_thickness", "m"), (r"body[12]_layer_(young|stress)|film_shear", "Pa"),
    (r"rot_[xyz]", "rad"), (r"body[12]_(young|yield|hardening_modulus|voce_stress)", "Pa"),
    (r"pressure_limit|bulk[12]_stress_\w+", "Pa"),
    (r"wear_coefficient[12]", "1/Pa"), (r"wear_energy[12]", "m3/J"),
)  # fmt: skip


def unit_of_option(name):
    """Unit of what an option takes; empty of a number, of a text, and of another parameter."""
    return next((unit for pattern, unit in UNITS if re.fullmatch(pattern, name)), "")


class Study:
    """The table of a study, open for reading; Error where it cannot be read.

    cases     names of the cases
    codes     their exit codes, -1 where a case has not run
    inputs    name: an array of numbers, or of texts, a value a case
    results   name: an array of numbers, a value a case, NaN where there is none
    units     name: unit, of the results
    """

    def __init__(self, path, label=None):
        self.path = str(path)
        name = os.path.basename(os.path.dirname(os.path.abspath(self.path)))
        self.label = label or name
        with reading(self.path):
            try:
                need_regular(self.path)
                with h5py.File(self.path, "r") as file:
                    self._read(file)
            except FileNotFoundError as error:
                raise Missing(f"{self.path}: no such file") from error
            except DAMAGED as error:
                raise Error(f"{self.path}: {_reason(error)}") from error

    def _read(self, file):
        self.cases = self._column(file, "case")
        self.codes = self._column(file, "exit_code")
        groups = {name: _own(file, name) for name in ("inputs", "results") if name in file}
        columns = {group: {name: self._column(data, name) for name in data} for group, data in groups.items()}
        self.inputs, self.results = columns.get("inputs", {}), columns.get("results", {})
        self.units = {name: short(str(groups["results"][name].attrs.get("units", "1"))) for name in self.results}
        for values in (*self.inputs.values(), *self.results.values(), self.codes):
            if values.size != self.cases.size:
                raise ValueError("its columns have different lengths")

    @staticmethod
    def _column(group, name):
        data = _own(group, name)
        if getattr(data, "ndim", None) != 1 or data.size > WHOLE:
            raise ValueError(f"/{name} is not a row")
        return data[:] if data.dtype.kind in "biuf" else np.array(data.asstr(errors="replace")[:], dtype=str)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        """Nothing is open: the table is read whole."""

    def column(self, name, option=""):
        """Values of an input or of a result, and the unit; a result that has an input's name ends with _end.

        option is what the message names where there is no such column.
        """
        if name in self.inputs:
            return self.inputs[name], ""
        bare = name[:-4] if name.endswith("_end") and name[:-4] in self.inputs else name
        if bare not in self.results:
            what = f"{option} {short(name)}".strip()
            raise Error(f"{self.path}: {what}: there is no such column{there_are(name, self.names)}")
        return self.results[bare], self.units[bare]

    def unit_of_input(self, name):
        """Unit of an input: that of the result of its name, in plane strain per metre; else of the option."""
        unit = unit_of_option(name)
        return self.units.get(name, unit) if unit else ""

    @property
    def names(self):
        """Names of all columns."""
        return [*self.inputs, *(name + "_end" if name in self.inputs else name for name in self.results)]


def is_study(path):
    """Whether a file looks like the table of a study."""
    try:
        with reading(str(path)):
            need_regular(str(path))
            with h5py.File(str(path), "r") as file:
                return all(name in file for name in ("case", "exit_code", "cases"))
    except (Error, *DAMAGED):
        return False
