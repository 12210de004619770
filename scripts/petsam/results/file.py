"""Reading of petsam's results files, of any size: scalars whole, fields by step, window and stride. SI units."""

import contextlib
import os
import re
import textwrap
from copy import copy
from functools import cached_property

import h5py
import numpy as np

from ..core.errors import Error, library, one_line, short, there_are
from ..core.files import decoded, need_regular
from ..core.hdf5 import DAMAGED, fresh
from . import parts

OPEN, STICK, SLIP = 0, 1, 2  # /state
DEPTHS = ("wear_depth1", "wear_depth2")  # removed of body 1 and 2
POWER, POWER_OF = "power_density", ("shear", "slip_velocity")  # of steady rolling: -q . s at the cell's centre
SLIPS = {"slip_range": 1.0, "slip_amplitude": 0.5}  # of a cycle: see sliding.py
EDGES = ("contact_edge", "stick_edge")
NO_EQUILIBRIUM = 11  # /history/status of a rejected step, which has no solution
BLOCK = 256  # rows read at a time, which bounds the memory; strides in HDF5 itself are slow
WHOLE = 1 << 27  # maximum number of values read at once; a damaged file may claim any number


class NotSaved(Error):
    """A step or a time (wanted) without fields in the file, and the reason."""

    def __init__(self, path, wanted, reason):
        super().__init__(f"{path}: {wanted}: {reason}")
        self.path, self.wanted, self.reason = path, wanted, reason


class Named(dict):
    """Values by name; a name that is not there is an Error of the file at path, which names those that are."""

    def __init__(self, path, values):
        super().__init__(values)
        self.path = path

    def __missing__(self, name):
        raise Error(f"{self.path}: has no {short(name)}{there_are(name, sorted(self), 'it has')}")


class History(Named):
    """Values by name of every load step, beside which there are matrices."""

    def __init__(self, path, values, matrices):
        super().__init__(path, values)
        self.matrices = matrices

    def __missing__(self, name):
        if name in self.matrices:
            raise Error(f"{self.path}: {name} is a matrix for every step: ask for matrices[{name!r}]")
        return super().__missing__(name)


class Datafile:
    """What files of petsam and of petsam-stress share; open for reading, Error where it cannot be read."""

    file = _state = None  # of HDF5, and what _state() has found when it was opened
    temporary = False  # whether the file goes with this object: see petsam.run()

    def __init__(self, path, label=None):
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
        self._state, self.file = _state(self.path), fresh(self.path)

    def _renew(self):
        """Opens the file once more where a run has written to it since: nodes of indices, which are read when they are
        needed, may lie beyond the end that HDF5 noted when it opened the file."""
        if not self.file or self.parameters.get("closed", 1):
            return
        now = _state(self.path)
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

    def close(self):
        """Close the file; what has been read stays."""
        self.file.close()

    def _error(self, error):
        changed = self._state not in (None, _state(self.path))
        return Error(f"{self.path}: {'has changed since it was opened: open it again' if changed else _reason(error)}")

    def nearest(self, saved, wanted, what="time"):
        """Index of the saved time (s), or of what else rises from step to step, that is nearest to the one wanted."""
        low, high = float(saved[0]), float(saved[-1])
        slack = 1e-9 * max(abs(low), abs(high))
        if not low - slack <= wanted <= high + slack:
            raise NotSaved(self.path, f"{what} {wanted:g}", f"fields were saved from {low:g} to {high:g}")
        return int(np.argmin(np.abs(saved - wanted)))


class Results(Datafile):
    """The results of a run, one file or its parts (parts.py), open for reading; Error where they cannot be read.

    x, y        cell centres, m
    times       of the saved fields, s
    steps       numbers of the load steps, from 1, whose fields are saved
    before      load steps before those of the file, which are in another one (petsam -restart); mostly 0
    history     name: array with a value for every load step, all of /history; NaN where a step has no solution
    units       name: unit, of the same
    matrices    stiffness and stiffness_reversal, (steps, 6, 6), with -stiffness: d(loads)/d(rigid displacements)
    wear        name: array with a value for every computed cycle of a life, all of /wear; empty without a life
    wear_units  name: unit, of the same
    parameters  name of an option: value, all root attributes
    """

    program = "petsam"  # that writes such files

    _later = ()  # parts of the same run
    _whole = None  # keeps the results that between() has taken a part of, whose file may be a temporary one
    first_row, _last_row = 0, None  # rows of the history that count: see between()

    def __init__(self, path, label=None):
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

    def close(self):
        """Close all parts; what has been read stays."""
        super().close()
        for part in self._later:
            part.close()

    @property
    def _sources(self):
        """This file and the later parts; not kept as a list, for results that hold themselves live on until gc."""
        return [self, *self._later]

    def _place(self, index):
        """The part that has a saved step, and its index there."""
        number, index = self._places[index]
        return self._sources[number], index

    def _read(self):
        self.x, self.y = self._read_axes(("x", "y"), (2, 1))
        self.is_plane = self.y.size == 1  # plane strain: numbers are per metre
        self.work_unit = self.units.get("dissipated_energy", "J")
        self.times = self._row(_own(self.file, "time"), "time")
        self._held = self._count_saved()  # saved steps of this file alone
        self.times = self.times[: self._held]
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
        self.wear, self.wear_units = Named(self.path, {}), {}
        if "wear" in self.file:
            self.wear, self.wear_units = self._read_table("wear")
            complete = min((values.size for values in self.wear.values()), default=0)  # see solved
            self.wear.update({name: values[:complete] for name, values in self.wear.items()})

    def _count_saved(self):
        """Number of saved steps; those that are in all fields, where a run was killed as it wrote another one."""
        if self.parameters.get("closed", 1):
            return self.times.size
        nodes = [node for group in (self.file, *self._layer_groups().values()) for node in _nodes(group).values()]
        series = [node for node in nodes if getattr(node, "ndim", 0) >= 3 and node.maxshape[0] is None]
        return min([self.times.size, *(data.shape[0] for data in series)])

    def _layer_groups(self):
        """Name: group with fields in layers."""
        groups = {name: node for name, node in _nodes(self.file).items() if isinstance(node, h5py.Group)}
        return {name: group for name, group in groups.items() if "z" in group}

    def __repr__(self):
        return f"Results({self.path!r}: {self.history['time'].size} steps, {self.x.size} x {self.y.size} cells)"

    def __str__(self):
        """What the file holds: steps, grid, and the names, shapes and units of fields and numbers."""
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

    @property
    def time(self):
        """Times of all load steps, s: history["time"]; those of the saved fields are times."""
        return self.history["time"]

    def keys(self):
        """Names of the numbers of each step and of the fields."""
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

    def to_dataframe(self):
        """The history as a table of pandas with the time (s) as its index."""
        columns = {name: values[: self._complete] for name, values in self.history.items()}
        return library("pandas").DataFrame(columns).set_index("time")

    def to_xarray(self):
        """The fields as a Dataset of xarray, with the coordinates time (s), y and x (m), units and texts."""
        xarray = library("xarray")
        fields = {}
        for name in self.fields:
            unit, text = self.about(name)
            fields[name] = (("time", "y", "x"), self[name], {"units": unit, "long_name": text})
        axes = {"time": (self.times, "s"), "y": (self.y, "m"), "x": (self.x, "m")}
        return xarray.Dataset(
            fields, {name: ((name,), values, {"units": unit}) for name, (values, unit) in axes.items()}
        )

    # ------------------------------------------------------------ steps

    @property
    def _complete(self):
        """Number of steps that are in all columns of the history: see solved."""
        return min((values.size for values in self.history.values()), default=0)

    @cached_property
    def solved(self):
        """Rows of the history, from 0, whose steps have a solution.

        The row of a refused step holds the loads and displacements that were asked for, and NaN for what is unknown.
        The step that a killed run was writing may be there in some datasets only, and does not count either.
        """
        rows = np.flatnonzero(self.history["status"][: self._complete] != NO_EQUILIBRIUM)
        return rows[self.counts(rows)]

    def __reduce__(self):
        """The load steps of between(), too."""
        make, given = super().__reduce__()
        return (make, given) if self._whole is None else (_part_of, (make, given, self.first_row, self._last_row))

    def counts(self, rows):
        """Which of the rows are among the load steps of between(); all unless it has been asked for."""
        return (rows >= self.first_row) & (rows <= (np.inf if self._last_row is None else self._last_row))

    def between(self, first=None, last=None):
        """The same results as if their history had the load steps first to last only; numbers as of_step() has them."""
        count = self.history["time"].size
        there = "there is 1 step" if count == 1 else f"there are {count} steps"
        if self.before:
            there = f"the file has the steps {self.before + 1} to {self.before + count}"
        rows = []
        for step, unless in ((first, 0), (last, count - 1)):
            row = unless if step is None else count + step if step < 0 else step - 1 - self.before
            if not 0 <= row < count:
                raise NotSaved(self.path, f"range {_ends(first, last)}", there)
            rows.append(row)
        if rows[0] > rows[1]:
            raise NotSaved(self.path, f"range {_ends(first, last)}", "the first step comes after the last one")
        part = copy(self)
        part.__dict__.pop("solved", None)
        part._whole = self
        part.first_row, part._last_row = rows
        if not part.solved.size:
            raise NotSaved(self.path, f"range {_ends(first, last)}", "no step of these has a solution")
        return part

    def series(self, name):
        """Values of /history/name of the steps that have a solution: what sums and extremes are taken of."""
        return self.history[name][self.solved]

    def need_solution(self):
        """Raises Error if no step has a solution."""
        if not self.solved.size:
            raise Error(f"{self.path}: no step has a solution")

    def of_step(self, number):
        """Index into the fields of the load step number: from 1, or from the end, -1 being the last."""
        count = self.history["time"].size
        last = self.before + count
        step = last + 1 + number if number < 0 else number
        self._need_fields()
        if self.before and not self.before < step <= last:
            raise NotSaved(self.path, f"step {number}", f"the file has the steps {self.before + 1} to {last}")
        if not 1 <= step <= count + self.before:
            raise NotSaved(self.path, f"step {number}", "there is 1 step" if count == 1 else f"there are {count} steps")
        if step in self.steps:
            return self.steps.index(step)
        reason = f"its fields were not saved, those of steps {_some(self.steps)} were"
        raise NotSaved(self.path, f"step {number}", reason)

    def row(self, index):
        """Row of the history, from 0, of a saved step."""
        return self.steps[index] - 1 - self.before

    def of_time(self, time):
        """Index into the fields of the saved step nearest to time (s), between the first and the last."""
        self._need_fields()
        return self.nearest(self.times, time)

    def of_cycle(self, cycle):
        """Index into the fields of the end of the saved cycle of a life that is nearest, between first and last."""
        self._need_fields()
        return self.cycle_ends[self.nearest(self.cycles[self.cycle_ends], cycle, "cycle")]

    def of_last(self):
        """Index into the fields of the last saved step."""
        self._need_fields()
        return len(self.steps) - 1

    def is_last(self, index):
        """True for the last saved step, but not of a life, where its name says how many cycles have passed."""
        return index == len(self.steps) - 1 and not self.has_life

    def _need_fields(self):
        if not self.steps:
            raise Error(f"{self.path}: no fields were saved")

    def title(self, index):
        """What names a saved step: the label, and where there are several the step and its time, or cycle."""
        return ", ".join(filter(None, (self.label, self.when(index))))

    def when(self, index):
        """The same without the label: nothing for a single step."""
        if self.history["time"].size == 1:
            return ""
        if self.has_life:
            return f"step {self.steps[index]}, after {self.cycles[index]:.7g} cycles"
        return f"step {self.steps[index]}, t = {self.times[index]:.4g} s"

    def friction(self, index):
        """Coefficient of friction of a saved step; NaN where it is a field (-friction_file)."""
        try:
            number = float(self.parameters["friction"]) if "friction" in self.parameters else np.nan
            scale = self.history["friction_scale"][self.row(index)] if "friction_scale" in self.history else 1.0
            return number * float(scale)
        except DAMAGED as error:
            raise self._error(error) from error

    # ------------------------------------------------------------ the life of a joint that wears

    @property
    def has_life(self):
        """Whether the history is a cycle that was repeated (-wear_cycles), and one has been computed."""
        return "cycle" in self.history and "cycle" in self.wear and self.wear["cycle"].size > 0

    def need_life(self):
        """Raises Error if there is no life."""
        if not self.has_life:
            raise Error(f"{self.path}: has no life of many cycles (petsam -wear_cycles)")

    @cached_property
    def cycles(self):
        """Cycles of the life before each saved step's."""
        self.need_life()
        return self.history["cycle"][np.array(self.steps, dtype=int) - 1 - self.before]

    @cached_property
    def cycle_ends(self):
        """Indices into the fields of the last saved step of each saved cycle of the life."""
        return [int(index) for index in np.flatnonzero(np.append(np.diff(self.cycles) != 0.0, True))]

    def of_computed_cycle(self, cycle):
        """Rows of the history, from 0, of the steps of a computed cycle of the life."""
        return self.solved[self.series("cycle") == cycle]

    @cached_property
    def depths(self):
        """Names of the fields of removed depth that the file has."""
        with self._reading():
            return [name for name in DEPTHS if self._all_have(name)]

    # ------------------------------------------------------------ fields

    @cached_property
    def fields(self):
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
    def layered(self):
        """Names GROUP/NAME of the fields in layers below the cells (bodies that yield): field() has (nz, ny, nx)."""
        with self._reading():
            names = [f"{place}/{name}" for place, group in self._layer_groups().items() for name in group]
            return [name for name in names if getattr(self.file[name], "ndim", 0) == 4 and self._all_have(name)]

    @cached_property
    def layer_z(self):
        """Middles of the layers, m, into body 2: those of body 1 are negative; raises Error if there are no layers."""
        return self.z_of(self.layered[0] if self.layered else "plastic")

    def z_of(self, name):
        """The same of the layers of a field GROUP/NAME, whose group may have layers of its own."""
        if not self.layered:
            raise Error(f"{self.path}: has no layers (petsam -body2_yield, -output_fields usual,plastic)")
        place = name.partition("/")[0] + "/z"
        with self._reading():
            return self._row(_own(self.file, place), place)

    def _all_have(self, name):
        """True if all parts have a dataset."""
        return all(name in source.file for source in self._sources)

    @cached_property
    def vectors(self):
        """Names without the endings _x and _y of the fields that are components."""
        return [name[:-2] for name in self.fields if name.endswith("_x") and name[:-2] + "_y" in self.fields]

    @property
    def is_steady(self):
        """True for steady rolling, in which each step is independent, without slip or energy of a step."""
        return str(self.parameters.get("rolling")) == "steady"

    @cached_property
    def products(self):
        """Names of the computed products of fields: in steady rolling the power density, else slip over a cycle."""
        if set(POWER_OF) <= set(self.vectors):
            return [POWER]
        return list(SLIPS) if "slip" in self.vectors and "state" in self.fields and self.times.size > 2 else []

    def about(self, name):
        """Attributes of a field as texts: units, and long_name; for a vector those of its first component."""
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

    def flags(self, name):
        """Words for the values of a field of flags (flag_values, flag_meanings); none of a field of numbers."""
        if name not in self.fields:
            return {}
        with self._reading():
            attributes = self._saved(name).attrs
            if "flag_values" not in attributes or "flag_meanings" not in attributes:
                return {}
            words = attributes["flag_meanings"]
            words = (decoded(words) if isinstance(words, bytes) else str(words)).split()
            return {int(value): short(word) for value, word in zip(np.ravel(attributes["flag_values"]), words)}

    def quantity(self, name, *part, **window):
        """A field, the magnitude of a vector whose components the file has, or a product; arguments of field()."""
        if name not in self.fields and name in self.products:
            if name == POWER:
                return self._power(*part, **window)
            from .sliding import slip_range  # which reads such results

            return SLIPS[name] * slip_range(self, *part, **window)
        if name not in self.fields and name in self.vectors:
            return np.hypot(self.field(name + "_x", *part, **window), self.field(name + "_y", *part, **window))
        return self.field(name, *part, **window)

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

    def need_quantity(self, name, option=None):
        """Raises Error if the file has no field, vector or product of this name, which an option may have requested."""
        names = [*self.fields, *self.vectors, *self.products]
        if name not in names:
            there = there_are(name, names, "it has") if names else "; it has no field at all"
            lack = f"{option} {short(name)}: has no such field" if option else f"has no {short(name)}"
            wanted = f" {name}, or {','.join(f'{of}_x,{of}_y' for of in POWER_OF)}" if name == POWER else ""
            raise Error(f"{self.path}: {lack} (petsam -output_fields{wanted}){there}")

    def _saved(self, name, source=None):
        """The dataset of a field, or of an edge, in a part: the first unless told."""
        source = source or self
        if name not in source.file:
            names = [*self.fields, *self.layered, *self.edges]
            there = there_are(name, names, "it has") if names else "; it has no field at all"
            raise Error(f"{source.path}: has no {short(name)} (petsam -output_fields){there}")
        return _own(source.file, name)

    def field(self, name, index=-1, rows=slice(None), columns=slice(None), stride=1):
        """Field name (ny, nx) of a saved step, the last unless told, on a window, every stride-th cell.

        Of layered fields (nz, ny, nx).

        index counts the saved steps from 0, or from the end with -1; of_step(K) is that of load step K.
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

    def edge(self, name, index=-1):
        """Points x, y (m) of contact_edge or stick_edge of a saved step, an array (points, 2)."""
        need_index(self, index)
        source, index = self._place(index)
        with source._reading():
            data = self._saved(name, source)
            if data.dtype.kind != "f" or data.ndim != 3 or not source._has_saved(data) or data.shape[2] != 2:
                raise ValueError(f"/{name} is no edge: its shape is {data.shape}")
            points = data[index]
        return points[np.isfinite(points).all(axis=1)]

    def has(self, names):
        """True if the file has all datasets of these names."""
        with self._reading():
            return all(self._all_have(name) for name in names)

    @cached_property
    def edges(self):
        """Which of contact_edge and stick_edge the file has."""
        with self._reading():
            return [name for name in EDGES if self._all_have(name)]

    def contact_window(self, index, margin=0.15):
        """Rows and columns (slices) of the smallest rectangle about the contact, and a margin; all without contact.

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


class _Part(Results):
    """One of the files of a run."""

    def _follow(self):
        pass


class Snapshot:
    """The fields and scalars of one saved step by the names of the results file: snapshot["pressure"], ["load_n"].

    A field has the shape (ny, nx) and is read when it is first asked for. results is the file, x and y are its own.
    """

    def __init__(self, results, index=-1):
        if not isinstance(results, Results):
            raise Error(f"{results.path}: holds no results of petsam")
        self.results, self._fields = results, {}
        need_index(results, index)
        self.index = index
        self.x, self.y, self.parameters = results.x, results.y, results.parameters
        self.dx, self.dy = (float(axis[1] - axis[0]) if axis.size > 1 else 1.0 for axis in (self.x, self.y))

    def __repr__(self):
        step, time = self.results.steps[self.index], self.results.times[self.index]
        return f"Snapshot({self.results.path!r}, load step {step} at {time:.6g} s, {self.x.size} x {self.y.size} cells)"

    def __getitem__(self, name):
        if name in self.results.history:
            value = self.results.history[name][self.results.row(self.index)]
            return value if value.ndim else value.item()
        if name not in self._fields:
            self._fields[name] = self.results.field(name, self.index)
        return self._fields[name]

    @cached_property
    def r(self):
        """Distance of the cells' centres from x = y = 0, m."""
        return np.hypot(self.x[None, :], self.y[:, None])

    @cached_property
    def shear(self):
        """|q|, Pa."""
        return np.hypot(self["shear_x"], self["shear_y"])

    @cached_property
    def slip(self):
        """|s|, m."""
        return np.hypot(self["slip_x"], self["slip_y"])

    @property
    def row(self):
        """Number of the row nearest to y = 0."""
        return int(np.argmin(np.abs(self.y)))

    def radius(self, area):
        """Radius, m, of the disc with the area of this name, contact_area or stick_area."""
        return np.sqrt(self[area] / np.pi)


def _part_of(make, given, first_row, last_row):
    """The results of a file with these rows of its history only."""
    whole = make(*given)
    return whole.between(whole.before + first_row + 1, whole.before + last_row + 1)


def _state(path):
    """What changes when a file is written to; None if there is none."""
    with contextlib.suppress(OSError):
        status = os.stat(path)
        return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns


def _own(group, name):
    """What a group has of this name; a file that petsam has written refers to no other, which might be anything."""
    found = None if isinstance(group.get(name, getlink=True), h5py.ExternalLink) else group[name]
    if found is None or isinstance(found, h5py.Dataset) and (found.external or found.is_virtual):
        raise ValueError(f"{name} is in another file")
    return found


def _nodes(group):
    """Name: what a group has of this name itself, not by a link to another place."""
    local = [name for name in group if isinstance(group.get(name, getlink=True), h5py.HardLink)]
    return {name: group[name] for name in local}


def _row_of(times, time):
    """Row of the history of a saved step; -1 for the step before a part, whose fields are in the part."""
    return int(np.argmin(np.abs(times - time))) if times.size and time >= times[0] else -1


def _is_matrices(data):
    """True if a dataset of /history has a matrix for every step."""
    return getattr(data, "ndim", None) == 3


def _window(cells, stride, size, margin):
    if not cells.size:
        return slice(0, size)
    more = int(np.ceil(margin * (cells[-1] - cells[0] + stride))) + stride
    return slice(max(0, int(cells[0]) - more), min(size, int(cells[-1]) + stride + more))


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


def _ends(first, last):
    return ":".join("" if step is None else f"{step}" for step in (first, last))


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
    text = one_line(text or type(error).__name__, 300)
    return "cannot be read: " + text if isinstance(error, OSError) else "is not a results file of petsam: " + text
