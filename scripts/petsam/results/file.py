"""Reading of petsam's results files, of any size: scalars whole, fields by step, window and stride. SI units."""

import os
from functools import cached_property
from typing import Any, Optional, Union

import numpy as np

from ..core.errors import Error, library, short, there_are
from ..core.files import decoded
from . import errors, gradients, parts
from .datafile import WHOLE, Named, NotSaved, _nodes, _own, _some
from .fields import OPEN, SLIP, STICK, Fields
from .shown import Viewed

__all__ = ["OPEN", "SLIP", "STICK", "NotSaved", "Results"]

POWER, POWER_OF = "power_density", ("shear", "slip_velocity")  # of steady rolling: -q . s at the cell's centre
SLIPS = {"slip_range": 1.0, "slip_amplitude": 0.5}  # of a cycle: see sliding.py


class Results(Fields, Viewed):
    """The results of a run, one file or its parts (parts.py), open for reading.

    Parameters
    ----------
    path : str
        The file.
    label : str, optional
        Its name in pictures; the file's name.

    Attributes
    ----------
    x, y : ndarray
        Cell centres, (nx,) and (ny,), m.
    times : ndarray
        Times of the saved fields, (saved,), s.
    steps : list of int
        Numbers of the load steps, from 1, whose fields are saved.
    before : int
        Load steps before those of the file, which are in another one (petsam -restart); mostly 0.
    history : dict
        {name: array (steps,)} with a value for every load step, all of /history; NaN where a step has no solution.
    units : dict
        {name: unit}, of the same.
    matrices : dict
        stiffness and stiffness_reversal, (steps, 6, 6), with -stiffness: d(loads)/d(rigid displacements).
    wear : dict
        {name: array (cycles,)} with a value for every computed cycle of a life, all of /wear; empty without a life.
    wear_units : dict
        {name: unit}, of the same.
    warnings : list of str
        Warnings of the run, in their order; empty for a run that has not ended.
    gradients : dict
        {name of a number: Gradient}, its derivatives by all parameters, with -gradient; empty without.
    errors : Errors
        {name: NumberError} of the last numbers, with -errors companion; a table (errors.py). Empty without.
    parameters : dict
        {name of an option: value}, all root attributes.

    Raises
    ------
    MissingFile
        If there is no such file.
    Error
        If it cannot be read.
    """

    program = "petsam"  # that writes such files

    def __init__(self, path: Union[str, os.PathLike], label: Optional[str] = None) -> None:
        super().__init__(path, label)
        try:
            self._follow()
        except Error:
            self.close()
            raise

    def _follow(self):
        """Appends the parts that restarts have written."""
        while os.path.exists(name := parts.name_of(self.path, len(self._sources) + 1)):
            part = _Part(name)
            if not parts.follows(part, self._sources[-1]):
                part.close()
                break
            parts.append(self, part)
        if not self.history["time"].size:
            raise Error(f"{self.path}: has no load step yet")

    def close(self) -> None:
        """Closes all parts; what has been read stays."""
        super().close()
        for part in self._later:
            part.close()

    def _read(self):
        self.x, self.y = self._read_axes(("x", "y"), (2, 1))
        self.is_plane = self.y.size == 1  # plane strain: numbers are per metre
        self.work_unit = self.units.get("dissipated_energy", "J")
        self.times = self._row(_own(self.file, "time"), "time")
        self._held = self._count_saved()  # saved steps of this file alone
        self.times = self.times[: self._held]
        self.warnings = self._texts("warnings")
        self.gradients = gradients.read(self.file.get("gradient"), self.parameters.get("closed", 1))
        if "friction_file" not in self.parameters:
            _ = self.parameters["friction"]  # which every other file has
        self.before = int(self.parameters.get("branch_step", 0))
        self._cycles_before = int(self.parameters.get("branch_rows", 0))
        if self.before < 0:
            raise ValueError(f"it begins after step {self.before}")
        self.steps = [self.before + _row_of(self.history["time"], saved) + 1 for saved in self.times]
        attributes = {name: _own(self.file, f"history/{name}").attrs for name in self.history}
        self._fills = {name: float(of["value_before"]) for name, of in attributes.items() if "value_before" in of}
        self._later, self._places = [], [(0, k) for k in range(self.times.size)]
        self.errors = errors.read(self.file.get("errors"), self.parameters.get("closed", 1))
        self.wear, self.wear_units = Named(self.path, {}), {}
        if "wear" in self.file:
            self.wear, self.wear_units = self._read_table("wear")
            complete = min((values.size for values in self.wear.values()), default=0)  # see solved
            self.wear.update({name: values[:complete] for name, values in self.wear.items()})

    def _texts(self, name):
        """The texts of a dataset that a file may have."""
        data = _own(self.file, name) if name in self.file else None
        if data is None:
            return []
        if getattr(data, "ndim", None) != 1 or data.dtype.kind != "S" or data.size > WHOLE:
            raise ValueError(f"/{name} is not a row of texts")
        try:
            return [decoded(one) for one in data[:].tolist()]
        except (OSError, RuntimeError):
            if self.parameters.get("closed", 1):
                raise
            return []  # the run was killed while it wrote them

    def _count_saved(self):
        """Number of saved steps; those that are in all fields, where a run was killed as it wrote another one."""
        if self.parameters.get("closed", 1):
            return self.times.size
        nodes = [node for group in (self.file, *self._layer_groups().values()) for node in _nodes(group).values()]
        series = [node for node in nodes if getattr(node, "ndim", 0) >= 3 and node.maxshape[0] is None]
        return min([self.times.size, *(data.shape[0] for data in series)])

    def __repr__(self):
        return f"Results({self.path!r}: {self.history['time'].size} steps, {self.x.size} x {self.y.size} cells)"

    def __str__(self):
        """The contents of the file: steps, grid, and the names, shapes and units of fields and numbers."""
        count, version = self.history["time"].size, self.parameters.get("petsam_version", "of unknown version")
        saved = f"fields of {_some(self.steps)}" if self.steps else "no fields"
        size = [len(axis) * (axis[1] - axis[0]) if axis.size > 1 else 0.0 for axis in (self.x, self.y)]
        lines = [
            f"{self.path}: results of petsam {version}",
            f"  steps     {count}, from {self.before + 1} on; {saved}"
            + ("" if self.parameters.get("closed", 1) else "; not closed: a run writes to it, or was killed"),
            f"  grid      {self.x.size} x {self.y.size} cells, {size[0]:.6g} m x {size[1]:.6g} m: x, y",
        ]
        fields = [(name, self.about(name)[0]) for name in self.fields]
        lines += self._lines("fields", f"({self.times.size}, {self.y.size}, {self.x.size})", fields)
        if self.layered:
            shape = f"({self.times.size}, nz, {self.y.size}, {self.x.size})"
            groups = sorted({name.partition("/")[0] for name in self.layered})
            depths = ", ".join(f"nz = {self.z_of(group).size} of /{group}/z" for group in groups)
            lines += self._lines("layers", f"{shape}, {depths}", [(name, "") for name in self.layered])
        lines += [f"  edges     {', '.join(self.edges)} (m)"] if self.edges else []
        lines += self._lines("history", f"({count},)", self.units.items())
        lines += self._lines("matrices", f"({count}, 6, 6)", [(name, "") for name in self.matrices])
        cycles = self.wear["cycle"].size if self.has_life else 0
        lines += self._lines("wear", f"({cycles},)", self.wear_units.items())
        return "\n".join(lines)

    # ------------------------------------------------------------ by name

    def keys(self) -> list[str]:
        """Names of the numbers of each step and of the fields.

        Returns
        -------
        list of str
        """
        return [*self.history, *self.fields, *self.layered]

    def __iter__(self):
        return iter(self.keys())

    def __contains__(self, name):
        return name in self.keys()

    def __getitem__(self, name):
        """A number of all load steps, (steps,); or a field of all saved steps, (saved, ny, nx), read as a whole."""
        if not isinstance(name, str):
            raise Error(f"{self.path}: {short(repr(name))} is no name of a number or field")
        if name in self.history or name in self.matrices:
            return self.history[name]
        self._need_fields()
        return np.stack([self.field(name, index) for index in range(self.times.size)])

    def to_dataframe(self) -> Any:
        """The history as a table of pandas.

        Returns
        -------
        pandas.DataFrame
            A column for each number of the history, with the time (s) as its index.

        Raises
        ------
        Missing
            If pandas is not installed.
        """
        columns = {name: values[: self._complete] for name, values in self.history.items()}
        return library("pandas").DataFrame(columns).set_index("time")

    def to_xarray(self) -> Any:
        """The fields as a data set of xarray.

        Returns
        -------
        xarray.Dataset
            The fields (time, y, x) with units and texts, and the coordinates time (s), y and x (m).

        Raises
        ------
        Missing
            If xarray is not installed.
        """
        xarray = library("xarray")
        fields = {}
        for name in self.fields:
            unit, text = self.about(name)
            fields[name] = (("time", "y", "x"), self[name], {"units": unit, "long_name": text})
        axes = {"time": (self.times, "s"), "y": (self.y, "m"), "x": (self.x, "m")}
        return xarray.Dataset(
            fields, {name: ((name,), values, {"units": unit}) for name, (values, unit) in axes.items()}
        )

    # ------------------------------------------------------------ products of fields

    @cached_property
    def products(self) -> list[str]:
        """Names of the computed products of fields: in steady rolling the power density, else slip over a cycle."""
        if set(POWER_OF) <= set(self.vectors):
            return [POWER]
        return list(SLIPS) if "slip" in self.vectors and "state" in self.fields and self.times.size > 2 else []

    def about(self, name: str) -> tuple[str, str]:
        """The unit and the text of a field.

        Parameters
        ----------
        name : str
            A field, a vector (of which those of its first component are meant) or a product.

        Returns
        -------
        units, long_name : str

        Raises
        ------
        Error
            If there is no such field.
        """
        if name in self.products and name != POWER:
            return "m", f"{name.replace('_', ' ')} of the cycle"
        if name in self.products:
            return "Pa", "frictional power per area over the rolling speed"
        name = name if name in self.fields else name + "_x"
        with self._reading():
            attributes = self._saved(name).attrs
            unit = self._unit(self._saved(name), name)
            text = attributes.get("long_name", name.replace("_", " "))
            return unit, short(decoded(text) if isinstance(text, bytes) else str(text))

    def quantity(
        self, name: str, index: int = -1, rows: slice = slice(None), columns: slice = slice(None), stride: int = 1
    ) -> np.ndarray:
        """A field, the magnitude of a vector whose components the file has, or a product.

        Parameters
        ----------
        name : str
            Its name, see fields, vectors and products: "slip_amplitude" is that of the cycle that ends at the step.
        index : int
            Of the saved step, from 0, or from the end with -1; of_step(K) is that of load step K.
        rows, columns : slice
            The window: rows are y, columns x.
        stride : int
            Every stride-th cell of the window.

        Returns
        -------
        ndarray
            (ny, nx) of the window, in SI units.

        Raises
        ------
        NotSaved
            If there is no saved step of this index.
        Error
            If there is no such field, or no whole cycle of which a product is.
        """
        part: dict[str, Any] = {"index": index, "rows": rows, "columns": columns, "stride": stride}
        if name not in self.fields and name in self.products:
            if name == POWER:
                return self._power(**part)
            from .sliding import slip_range  # which reads such results

            return SLIPS[name] * slip_range(self, **part)
        if name not in self.fields and name in self.vectors:
            return np.hypot(self.field(name + "_x", **part), self.field(name + "_y", **part))
        return self.field(name, **part)

    def _power(self, index=-1, rows=slice(None), columns=slice(None), stride=1):
        """Frictional power over the rolling speed as petsam saves it (power_density): of the centred slip velocity.

        The saved slip velocity belongs to the side ahead of a cell, with the creepage a sixth of a cell ahead: at the
        centre it is the mean of the cell's and that of the cell behind, which spin has changed by spin times dx/3.
        """
        low, high, _ = columns.indices(self.x.size)
        spin = (0.0, self.history["creep_spin"][self.row(index % self.times.size)] * (self.x[1] - self.x[0]))
        power = 0.0
        for axis, turn in zip("xy", spin):
            name = f"slip_velocity_{axis}"
            slip = self.field(name, index, rows, columns, stride)
            if low:
                behind = self.field(name, index, rows, slice(low - 1, max(low, high) - 1), stride)
            else:
                rest = self.field(name, index, rows, slice(stride - 1, max(stride, high) - 1), stride)
                behind = np.hstack([slip[:, :1] + turn, rest])  # the first cell has none behind
            centred = (slip + behind - 2 / 3 * turn) / 2
            power = power - self.field(f"shear_{axis}", index, rows, columns, stride) * centred
        return power

    def need_quantity(self, name: str, option: Optional[str] = None) -> None:
        """Checks that there is a field, vector or product.

        Parameters
        ----------
        name : str
            Its name.
        option : str, optional
            The option that has requested it, in messages.

        Raises
        ------
        Error
            If there is none of this name.
        """
        names = [*self.fields, *self.vectors, *self.products]
        if name not in names:
            there = there_are(name, names, "it has") if names else "; it has no field at all"
            lack = f"{option} {short(name)}: has no such field" if option else f"has no {short(name)}"
            wanted = f" {name}, or {','.join(f'{of}_x,{of}_y' for of in POWER_OF)}" if name == POWER else ""
            raise Error(f"{self.path}: {lack} (petsam -output_fields{wanted}){there}")


class _Part(Results):
    """One of the files of a run."""

    def _follow(self):
        pass


def _row_of(times, time):
    """Row of the history of a saved step; -1 for the step before a part, whose fields are in the part."""
    return int(np.argmin(np.abs(times - time))) if times.size and time >= times[0] else -1
