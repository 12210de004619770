"""A contact of the library: its calls, the names of its numbers and fields, its files, and its end."""

from __future__ import annotations

import ctypes
import os
import re
import sys
import warnings
from typing import Any, Union

import numpy as np

from ..core import options as command_line
from ..core.errors import short, there_are
from .errors import EDGE, AdviceWarning, ContactError, error_of
from .shared import encoded, library, lock
from .steps import Step


class Handle:
    """Shared by all parts of Contact: the calls of the library, names, numbers, files, and the end."""

    def __init__(self, *, comm: Any = None, **options: Any) -> None:
        self._contact = ctypes.c_void_p()
        if comm is not None and not hasattr(comm, "py2f"):
            raise TypeError(f"comm: expected a communicator of mpi4py, and not {type(comm).__name__}")
        for name in ("gap", "friction"):
            if np.ndim(options.get(name, 0.0)) > 1:
                raise TypeError(f"{name}: a field is given afterwards, contact.{name} = ...")
        self._made: dict[str, Any] = dict(comm=comm, **options)
        self._given: dict[str, np.ndarray] = {}
        self._advised: set[str] = set()  # kinds of advice that have been given
        self._listed: dict[str, list[str]] = {}
        self._c = library()
        with lock:
            code = self._c.petsam_create(
                ctypes.c_int(-1 if comm is None else comm.py2f()), encoded(command_line.line(options)),
                ctypes.byref(self._contact),
            )  # fmt: skip
            self._check(code)
        self._read_grid()
        self._read_names()

    def _read_grid(self):
        n, size, center = (ctypes.c_int * 2)(), (ctypes.c_double * 2)(), (ctypes.c_double * 2)()
        first, rows = ctypes.c_int(), ctypes.c_int()
        self._call("grid", n, size, center, ctypes.byref(first), ctypes.byref(rows))
        self.n, self.size, self.center = tuple(n), tuple(size), tuple(center)
        self.first_row, self.rows = first.value, rows.value
        x, y = (self.center[k] + ((np.arange(self.n[k]) + 0.5) / self.n[k] - 0.5) * self.size[k] for k in range(2))
        self.x, self.y = x, y[self.first_row : self.first_row + self.rows]

    def _read_names(self):
        """Returns {name: unit} of all that a step may prescribe, and the names of its loads and displacements."""
        unit, known, names, self.prescribable = ctypes.c_char_p(), self._names("number"), [], {}
        while (name := self._c.petsam_step_name(self._contact, len(names), ctypes.byref(unit))) is not None:
            names.append(name.decode())
            if name:
                self.prescribable[names[-1]] = unit.value.decode()
        self.has_errors = "contact_area_error" in known
        self.relaxes = "viscous_energy" in known
        self._loads, self._displacements, creeps = names[:6], names[6:12], names[12:18]
        self._rigids = [rigid if rigid in known else creep for rigid, creep in zip(self._displacements, creeps)]

    def _message(self):
        return self._c.petsam_message(self._contact).decode(errors="replace")

    def _check(self, code):
        if code not in (0, EDGE):
            raise error_of(code, self._message())

    def _call(self, name, *arguments):
        """Calls a function of the library and returns its code; raises an exception if it fails."""
        with lock:
            if not self._contact:
                raise ContactError(2, "the contact is closed")
            code = getattr(self._c, f"petsam_{name}")(self._contact, *arguments)
            self._check(code)
        return code

    def _names(self, what):
        """Returns the names of the fields ("field") or numbers ("number") that can be requested."""
        ask, found = getattr(self._c, f"petsam_{what}_name"), self._listed.setdefault(what, [])
        with lock:
            if ask(self._contact, len(found)):  # names are only added, but to any place
                found.clear()
                while name := ask(self._contact, len(found)):
                    found.append(name.decode())
        return found

    def _advise(self):
        """Warns of each number that is not resolved once per cause, and of all else once per kind: warnings of a kind
        differ only in numbers."""
        count = ctypes.c_int()
        with lock:
            self._call("advise", ctypes.byref(count))
            lines = [self._c.petsam_warning(self._contact, k).decode(errors="replace") for k in range(count.value)]
        for line in lines:
            kinds = {re.sub(r"[-+]?\d[\d.]*(e[-+]?\d+)?", "", line)}
            if line.startswith("error by the "):
                cause, named = re.split(r"(?<=\w): | \(", line)[:2]
                kinds = {f"{cause}: {number.split()[0]}" for number in named.split(", ")}
            if not kinds <= self._advised:
                self._advised |= kinds
                warnings.warn(line, AdviceWarning, stacklevel=3)

    def _step(self, time, load, rigid, status, message):
        return Step(time, load, rigid, status, message, self._numbers(), self._loads + self._rigids)

    def _numbers(self):
        """{name: value} of the further numbers of the last step; a history may add some. A microsecond each."""
        found, value = {}, ctypes.c_double()
        names = [name for name in self._names("number") if name not in ("time", "status", *self._loads, *self._rigids)]
        with lock:
            for name in names:
                if self._c.petsam_get_number(self._contact, encoded(name), ctypes.byref(value)) == 0:
                    found[name] = value.value
        return found

    def _last_step(self, status=0, message=""):
        load, rigid = (np.array([self.number(name) for name in names]) for names in (self._loads, self._rigids))
        return self._step(self.number("time"), load, rigid, status, message)

    def number(self, name: str) -> float:
        """A number of the last step; after reject() that of the committed step.

        Parameters
        ----------
        name : str
            Its name in /history: contact_area, dissipated_energy, ... For a tried step, step.contact_area is the same
            number.

        Returns
        -------
        float
            The number, in SI units.

        Raises
        ------
        ContactError
            If there is no such number.
        TypeError
            If the name is no text.
        """
        value = ctypes.c_double()
        if not isinstance(name, str):
            raise TypeError(f"{name!r} is no name of a number")
        self._ask("get_number", name, ctypes.byref(value))
        return value.value

    def _ask(self, function, name, target):
        """Calls a function that takes a name; an unknown name is an error that lists the known ones."""
        try:
            self._call(function, encoded(name), target)
        except ContactError as error:
            what = function.split("_")[1]
            names = self._names(what) if self._contact else [name]
            if error.code != 2 or name in names:
                raise
            text = f"{short(name)}: there is no {what} of this name{there_are(name, names)}"
            raise ContactError(error.code, text) from None

    def save(self, file: Union[str, os.PathLike]) -> None:
        """Writes the committed state to a file.

        Of a contact with errors=True the states of its companions go along, unless a step is tried at that moment.

        Parameters
        ----------
        file : path
            The file, which is replaced.

        Raises
        ------
        ContactError
            If no step has been committed, or the file cannot be written.
        """
        self._call("save", os.fsencode(file))

    def load(self, file: Union[str, os.PathLike]) -> None:
        """Takes over the state in a file that a contact of the same options has saved.

        Parameters
        ----------
        file : path
            The file.

        Raises
        ------
        ContactError
            If the file cannot be read, or its state does not fit this contact.
        MissingFile
            If there is no such file.
        """
        self._call("load", os.fsencode(file))

    @property
    def options(self) -> dict[str, Any]:
        """The keywords by which it was made."""
        return {name: value for name, value in self._made.items() if name != "comm"}

    def reset(self) -> None:
        """Resets the contact to bodies that have never touched."""
        self._call("reset")

    def close(self) -> None:
        """Frees the contact.

        Raises
        ------
        ContactError
            If it is called within the function of a run.
        """
        with lock:
            if self._contact:
                self._c.petsam_destroy(ctypes.byref(self._contact))
            if self._contact:  # not within the function of a run
                raise ContactError(2, self._message())

    def __copy__(self):
        raise TypeError("a contact is copied by its copy(), and cannot be pickled; save() and load() pass its state on")

    __reduce__ = __copy__

    def __deepcopy__(self, memory):
        return self.__copy__()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        if getattr(self, "_contact", None) and sys is not None and not sys.is_finalizing():
            self.close()
