"""Reading of petsam-stress's files: stresses in a body by step and depth, and fatigue parameters. SI units."""

import os
from typing import Any, Optional, Union

import numpy as np

from ..core.errors import Error, WrongArgument, short, there_are
from .datafile import WHOLE, Datafile, NotSaved, _own, _some, need_index
from .file import Results
from .studies import Study, is_study

# parameters of a cycle; the critical plane's normal is in NAME_normal_x, _y, _z
# fatigue parameters, and what they are called
FATIGUE = {
    "crossland": "Crossland", "dang_van": "Dang Van", "findley": "Findley", "swt": "Smith, Watson and Topper",
    "fatemi_socie": "Fatemi and Socie", "ruiz_1": "Ruiz 1", "ruiz_2": "Ruiz 2",
}  # fmt: skip
AXES = ("time", "z", "y", "x")


class Stresses(Datafile):
    """One file of petsam-stress, open for reading.

    Parameters
    ----------
    path : str
        The file.
    label : str, optional
        Its name in pictures; the file's name.

    Attributes
    ----------
    x, y, z : ndarray
        Points, m; z from the surface into the body; a section has one y or one x.
    times : ndarray
        Times of the load steps, (steps,), s.
    along : str or None
        "x" or "y", the direction of a section; None of maps.
    steps : list of int
        Numbers of the load steps, as petsam counts them.
    history : dict
        {name: array (steps,)} with a value for every step, all of /history.
    units : dict
        {name: unit}, of the same.
    parameters : dict
        body, young (Pa), poisson, and the constants of the fatigue parameters.

    Raises
    ------
    MissingFile
        If there is no such file.
    Error
        If it cannot be read.
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
        """The contents of the file: steps, points, and the names, shapes and units of stresses and numbers."""
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

    def __getitem__(self, name):
        """A number of all load steps, (steps,), a stress, (steps, z, y, x), or a fatigue parameter, (z, y, x)."""
        if not isinstance(name, str):
            raise Error(f"{self.path}: {short(repr(name))} is no name of a stress or number")
        if name in self.history:
            return self.history[name]
        if self._is_timeless(name):
            return self.field(name)
        return np.stack([self.field(name, index) for index in range(self.times.size)])

    @staticmethod
    def _is_timeless(name):
        """True if a dataset is of the cycle, not of its steps."""
        return name in FATIGUE or "_normal_" in name

    @property
    def fatigue(self) -> list[str]:
        """Names of the fatigue parameters that the file has."""
        return [name for name in FATIGUE if name in self]

    def unit(self, name: str) -> str:
        """The unit of a dataset.

        Parameters
        ----------
        name : str
            Its name.

        Returns
        -------
        str

        Raises
        ------
        Error
            If there is none of this name.
        """
        with self._reading():
            return self._unit(_own(self.file, name), name)

    def of_last(self) -> int:
        """The last step.

        Returns
        -------
        int
            Its index, from 0.
        """
        return self.times.size - 1

    def is_last(self, index: int) -> bool:
        """True if a step is the last one.

        Parameters
        ----------
        index : int
            Of the step, from 0.

        Returns
        -------
        bool
        """
        return index == self.of_last()

    def of_step(self, number: int) -> int:
        """The index of a load step.

        Parameters
        ----------
        number : int
            As petsam counts them; or from the end, -1 being the last.

        Returns
        -------
        int
            Index, from 0.

        Raises
        ------
        NotSaved
            If the file has no such step.
        """
        if -len(self.steps) <= number < 0:
            return len(self.steps) + number
        if number not in self.steps:
            raise NotSaved(self.path, f"step {number}", f"this file has the steps {_some(self.steps)}")
        return self.steps.index(number)

    def of_time(self, time: float) -> int:
        """The step nearest to a time.

        Parameters
        ----------
        time : float
            Time, s, between the first and the last step.

        Returns
        -------
        int
            Index, from 0.

        Raises
        ------
        NotSaved
            If the time lies outside.
        """
        return self.nearest(self.times, time)

    def title(self, index: int) -> str:
        """The name of a step: the label and the time.

        Parameters
        ----------
        index : int
            Of the step.

        Returns
        -------
        str
        """
        return f"{self.label}, {self.when(index)}"

    def when(self, index: int) -> str:
        """The title without the label.

        Parameters
        ----------
        index : int
            Of the step.

        Returns
        -------
        str
        """
        return f"step {self.steps[index]}, t = {self.times[index]:.4g} s"

    def nearest_row(self, y: float) -> int:
        """The row of cells nearest to a line along x; of two that are as near the upper one, as in petsam-stress.

        Parameters
        ----------
        y : float
            The line, m.

        Returns
        -------
        int
            Number of the row, from 0.

        Raises
        ------
        Error
            If it is not on the grid.
        """
        if self.y.size == 1:
            return 0
        step = self.y[1] - self.y[0]
        if not self.y[0] - step / 2 <= y <= self.y[-1] + step / 2:
            raise Error(f"{self.path}: y = {y:g} m is not on the grid")
        return int(np.clip(np.floor((y - self.y[0]) / step + 0.5), 0, self.y.size - 1))

    def nearest_plane(self, z: float) -> int:
        """The depth nearest to another one.

        Parameters
        ----------
        z : float
            Depth, m.

        Returns
        -------
        int
            Number of the depth, from 0.
        """
        return int(np.argmin(np.abs(self.z - z)))

    def need(self, *names: str) -> None:
        """Checks that the file has datasets.

        Parameters
        ----------
        *names : str
            Their names.

        Raises
        ------
        Error
            If it lacks one of them.
        """
        for name in names:
            if name not in self:
                raise Error(f"{self.path}: has no {name} (petsam-stress -quantities){self._there_are(name)}")

    def _there_are(self, name):
        with self._reading():
            names = [name for name in self.file if name not in (*AXES, "history")]
        return there_are(name, names, "it has")

    def field(
        self,
        name: str,
        index: int = -1,
        depths: slice = slice(None),
        rows: slice = slice(None),
        columns: slice = slice(None),
    ) -> np.ndarray:
        """A quantity of a step, or a fatigue parameter, which has no steps.

        Parameters
        ----------
        name : str
            Its name: "stress_xx", "mises", "crossland", ...
        index : int
            Of the step, from 0, or from the end with -1.
        depths, rows, columns : slice
            The window in z, y and x.

        Returns
        -------
        ndarray
            (z, y, x) of the window, in SI units: unit(name).

        Raises
        ------
        NotSaved
            If there is no step of this index.
        Error
            If there is no such quantity, or the window is too large to be read at once.
        """
        need_index(self, index)
        with self._reading():
            if name not in self:
                raise Error(f"{self.path}: has no {short(name)}{self._there_are(name)}")
            data = _own(self.file, name)
            timeless = self._is_timeless(name)
            shape = self.shape[1:] if timeless else self.shape
            if data.shape != shape or data.dtype.kind != "f":
                raise ValueError(f"/{name} has the shape {data.shape}")
            sizes = (len(range(*part.indices(n))) for part, n in zip((depths, rows, columns), shape[-3:]))
            if np.prod(list(sizes)) > WHOLE:
                raise ValueError(f"/{name} is too large to be read whole: take a part of it")
            part = (depths, rows, columns)
            return data[part if timeless else (index % self.shape[0], *part)]


def open_any(path: Union[str, os.PathLike], label: Optional[str] = None) -> Any:
    """Opens a file as Results, Stresses or Study by its contents. `label`: its name in pictures, by default the file's
    name. Raises MissingFile if there is no such file, and an Error if it cannot be read."""
    if not isinstance(path, (str, bytes, os.PathLike)):
        raise WrongArgument(f"open: path {short(repr(path))}: expected a text or a path")
    path = os.fsdecode(path)
    if is_study(path):
        return Study(path, label)
    try:
        return Stresses(path, label)
    except Error:
        return Results(path, label)  # which says what is wrong
