"""Reading of petsam-stress's files: stresses in a body by step and depth, and fatigue parameters. SI units."""

import numpy as np

from ..core.errors import Error, short, there_are
from .file import WHOLE, Datafile, NotSaved, Results, _own, _some, need_index
from .studies import Study, is_study

# parameters of a cycle; the critical plane's normal is in NAME_normal_x, _y, _z
FATIGUE = ("crossland", "dang_van", "findley", "swt", "fatemi_socie", "ruiz_1", "ruiz_2")
AXES = ("time", "z", "y", "x")


class Stresses(Datafile):
    """One file of petsam-stress, open for reading; Error where it cannot be read.

    x, y, z     points, m; z from the surface into the body; a section has one y or one x
    times       of the load steps, s
    along       "x" or "y", the direction of a section; None of maps
    steps       numbers of the load steps, as petsam counts them
    history     name: array with a value for every step, all of /history
    units       name: unit, of the same
    parameters  body, young (Pa), poisson, and the constants of the fatigue parameters
    """

    program = "petsam-stress"  # that writes such files

    def _read(self):
        if "z" not in self.file:
            raise Error(f"{self.path}: has no depths z: give a file of petsam-stress -input RESULTS.h5")
        self.times, self.z, self.y, self.x = self._read_axes(AXES, (1, 1, 1, 1))
        self.along = "x" if self.y.size == 1 else "y" if self.x.size == 1 else None
        self.steps = [int(number) for number in self.history["step"]]
        self.shape = (self.times.size, self.z.size, self.y.size, self.x.size)

    def __str__(self):
        """What the file holds: steps, points, and the names, shapes and units of stresses and numbers."""
        what = f"a section along {self.along}" if self.along else "maps"
        with self._reading():
            body = int(self.parameters["body"])
            shapes = {name: self.file[name].shape for name in self.file if getattr(self.file[name], "ndim", 0) > 2}
        lines = [
            f"{self.path}: stresses of petsam-stress in body {body}",
            f"  steps     {_some(self.steps)}",
            f"  points    {what}: x, y, z of {self.x.size}, {self.y.size}, {self.z.size}",
        ]
        for kind, shape in (("stresses", self.shape), ("cycle", self.shape[1:])):
            names = [(name, self.unit(name)) for name in shapes if shapes[name] == shape]
            lines += self._lines(kind, str(shape), names)
        return "\n".join(lines + self._lines("history", f"({self.times.size},)", self.units.items()))

    def __contains__(self, name):
        with self._reading():
            return name in self.file and name not in AXES

    @property
    def fatigue(self):
        """Names of the fatigue parameters that the file has."""
        return [name for name in FATIGUE if name in self]

    def unit(self, name):
        """Unit of a dataset."""
        with self._reading():
            return self._unit(_own(self.file, name), name)

    def of_last(self):
        """Index of the last step."""
        return self.times.size - 1

    def is_last(self, index):
        """True for the last step."""
        return index == self.of_last()

    def of_step(self, number):
        """Index of the load step number, as petsam counts them; or from the end, -1 being the last."""
        if -len(self.steps) <= number < 0:
            return len(self.steps) + number
        if number not in self.steps:
            raise NotSaved(self.path, f"step {number}", f"this file has the steps {_some(self.steps)}")
        return self.steps.index(number)

    def of_time(self, time):
        """Index of the step nearest to time (s), between the first and the last."""
        return self.nearest(self.times, time)

    def title(self, index):
        """What names a step: the label and the time."""
        return f"{self.label}, {self.when(index)}"

    def when(self, index):
        """The same without the label."""
        return f"step {self.steps[index]}, t = {self.times[index]:.4g} s"

    def nearest_row(self, y):
        """Number of the row of cells nearest to y (m); of two that are as near the upper one, as in petsam-stress."""
        if self.y.size == 1:
            return 0
        step = self.y[1] - self.y[0]
        if not self.y[0] - step / 2 <= y <= self.y[-1] + step / 2:
            raise Error(f"{self.path}: y = {y:g} m is not on the grid")
        return int(np.clip(np.floor((y - self.y[0]) / step + 0.5), 0, self.y.size - 1))

    def nearest_plane(self, z):
        """Number of the depth nearest to z (m)."""
        return int(np.argmin(np.abs(self.z - z)))

    def need(self, *names):
        """Error where the file lacks one of the datasets."""
        for name in names:
            if name not in self:
                raise Error(f"{self.path}: has no {name} (petsam-stress -quantities){self._there_are(name)}")

    def _there_are(self, name):
        with self._reading():
            names = [name for name in self.file if name not in (*AXES, "history")]
        return there_are(name, names, "it has")

    def field(self, name, index=-1, depths=slice(None), rows=slice(None), columns=slice(None)):
        """A quantity (z, y, x) of a step, or a fatigue parameter, which has no steps; on a window of slices."""
        need_index(self, index)
        with self._reading():
            if name not in self:
                raise Error(f"{self.path}: has no {short(name)}{self._there_are(name)}")
            data = _own(self.file, name)
            timeless = name in FATIGUE or "_normal_" in name
            shape = self.shape[1:] if timeless else self.shape
            if data.shape != shape or data.dtype.kind != "f":
                raise ValueError(f"/{name} has the shape {data.shape}")
            sizes = (len(range(*part.indices(n))) for part, n in zip((depths, rows, columns), shape[-3:]))
            if np.prod(list(sizes)) > WHOLE:
                raise ValueError(f"/{name} is too large to be read whole: take a part of it")
            part = (depths, rows, columns)
            return data[part if timeless else (index % self.shape[0], *part)]


def open_any(path, label=None):
    """The Stresses, the Results or the Study of a file, by what is in it."""
    if is_study(path):
        return Study(path, label)
    try:
        return Stresses(path, label)
    except Error:
        return Results(path, label)  # which says what is wrong
