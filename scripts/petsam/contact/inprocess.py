"""A contact in this process: takes loads or displacements and returns the rest. Calls libpetsam by ctypes. SI units.

    import petsam
    steel = dict(body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3)
    sphere = dict(gap_type="sphere", gap_radius1=0.1, gap_radius2="inf")
    with petsam.Contact(grid_n=256, grid_size=2.6e-3, friction=0.1, **steel, **sphere) as contact:
        step = contact.try_step(load_n=1000, disp_x=1e-6)
        print(step.load_tx, step.contact_area, step.dissipated_energy, contact.stiffness()[1, 1])
        contact.commit()

The order of calls, and the meaning of each number: include/petsam/embed.h and examples/embed/README.md.
"""

from __future__ import annotations

import ctypes
import errno
import os
import re
import shutil
import sys
import threading
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from numbers import Integral, Real
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from ..core import arrays
from ..core import options as command_line
from ..core.environment import PREFIX, TREE
from ..core.errors import Error, Missing, MissingFile, short, there_are
from ..core.files import need_regular
from ..core.version import __version__
from . import gradient as gradients

# numbers of a computed cycle, by their names in /wear
CYCLE = (
    "cycle", "jump", "error", "volume1", "volume2", "depth_max1", "depth_max2", "dissipated_energy", "contact_area",
    "pressure_max", "computed",
)  # fmt: skip
UNREADABLE, NOT_CONVERGED, NO_EQUILIBRIUM, EDGE = 3, 10, 11, 12
ROUNDING = 1e-10  # parts of their scale below which numbers are shown as 0
SHORT = 1e-5  # m: the levers of forces whose moments are rounding are this times ROUNDING
_MISSING = f": cannot be read: {os.strerror(errno.ENOENT)}"  # end of the library's message about a missing file
_MONITOR = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int)


class ContactError(Error):
    """A call that was rejected.

    Parameters
    ----------
    code : int
        Exit code: 2 a wrong argument, 3 a file, 10 to 12 those of steps, others of PETSc.
    message : str
        What is wrong.

    Attributes
    ----------
    results : Results or None
        Of petsam.run(): the steps so far.
    """

    results: Any = None

    def __init__(self, code: int, message: str) -> None:
        super().__init__(code, message)  # makes it picklable
        self.code, self.message = code, message

    def __str__(self):
        return self.message

    def __reduce__(self):
        """Another process gets it without the results, which are an open file."""
        return type(self), self.args, {name: value for name, value in vars(self).items() if name != "results"}


class PrescribedError(ContactError, TypeError):
    """A prescribed value of a step was rejected: an unknown name, two names for one component, a value out of range.

    Parameters
    ----------
    code, message : int, str
        See ContactError.
    """


class MissingInput(ContactError, MissingFile):
    """A file that an option names is missing."""

    def __init__(self, code, message):
        MissingFile.__init__(self, re.sub(r"^-\w+ ", "", message.removesuffix(_MISSING)))
        self.args, self.code, self.message = (code, message), code, message


class NotConverged(ContactError):
    """A step or a stiffness did not converge.

    Parameters
    ----------
    code, message : int, str
        See ContactError.

    Attributes
    ----------
    step : Step or None
        The step.
    steps : list of Step or Cycle
        Of Contact.run() and Contact.live(): those before it.
    """

    step: Any = None
    steps: Sequence = ()


class NoEquilibrium(ContactError):
    """No equilibrium exists for a step: gross slip, or a moment that no pressure balances.

    Parameters
    ----------
    code, message : int, str
        See ContactError.

    Attributes
    ----------
    step : Step or None
        The step.
    steps : list of Step or Cycle
        Of Contact.run() and Contact.live(): those before it.
    """

    step: Any = None
    steps: Sequence = ()


class EdgeContact(ContactError):
    """The contact has reached the edge of the grid, which ends a run; `allow_edge_contact` lets it go on.

    Parameters
    ----------
    code, message : int, str
        See ContactError.

    Attributes
    ----------
    step : Step or None
        The step.
    steps : list of Step or Cycle
        Of Contact.run() and Contact.live(): those up to it.
    """

    step: Any = None
    steps: Sequence = ()


class EdgeContactWarning(UserWarning):
    """The contact has reached the edge of the grid: the answer depends on the grid."""


class WearWarning(UserWarning):
    """A step wears so much that the pressure of the next ones is uneven from cell to cell, and wrong."""


class AdviceWarning(UserWarning):
    """A solution is right for its grid, but may not be intended: for example unresolved cells, units, or sizes."""


class CycleWarning(UserWarning):
    """The recorded steps are not a closed cycle, or not a steady one."""


def _shown(values, scales):
    """An array of the values, 0 where they are rounding beside their scale."""
    values = np.asarray(values, dtype=float)
    return np.where(np.abs(values) <= ROUNDING * scales, 0.0, values)


class Step:
    """A tried step: a number of each name, step.load_n, step.disp_x, step.dissipated_energy, step.contact_area, ...

    Its parameters are its attributes, too, but the names.

    Parameters
    ----------
    time : float
        Time, s.
    load : ndarray
        N, Tx, Ty (N), Mx, My, Mz (N m), (6,).
    rigid : ndarray
        Displacements z, x, y (m) and rotations x, y, z (rad), (6,); in steady rolling creepages, by their own names.
    status : int
        0, or the code of a step without a solution or at the edge of the grid.
    message : str
        The message of such a step.
    numbers : dict
        {name: value} of the further numbers of /history, NaN where a step has none; the attribute has loads and
        displacements, too.
    names : list of str
        Names of loads and displacements, (12,).

    Attributes
    ----------
    errors : dict
        {name: estimated error}, each in the unit of its number, of a contact with errors=True; NaN: unknown.
    """

    if TYPE_CHECKING:  # numbers are attributes by their names

        def __getattr__(self, name: str) -> float: ...

    def __init__(
        self,
        time: float,
        load: np.ndarray,
        rigid: np.ndarray,
        status: int,
        message: str,
        numbers: Mapping[str, float],
        names: Sequence[str],
    ) -> None:
        self.time, self.load, self.rigid, self.status, self.message = time, load, rigid, status, message
        self.numbers, self._names = dict(zip(names, map(float, [*load, *rigid]))), names
        self.numbers.update(numbers)
        self.__dict__.update(self.numbers)
        pairs = ((name.removesuffix("_error"), value) for name, value in numbers.items() if name.endswith("_error"))
        self.errors = {name: value for name, value in pairs if name in self.numbers}

    def __repr__(self):
        sizes = [
            np.nanmax(np.abs([*some, 0.0])) for some in (self.load[:3], self.load[3:], self.rigid[:3], self.rigid[3:])
        ]
        sizes[1], sizes[3] = max(sizes[1], SHORT * sizes[0]), max(sizes[3], SHORT * sizes[2])
        values = _shown([*self.load, *self.rigid], np.repeat(sizes, 3))
        pairs = [f"{name}={value:.6g}" for name, value in zip(self._names, values)]
        return f"Step(time={self.time:g}, status={self.status}, {', '.join(pairs)})"


class Cycle:
    """A computed cycle of a life: its numbers by their names in /wear, cycle.depth_max1, cycle.jump, ...

    Parameters
    ----------
    numbers : dict
        {name: value}.
    """

    if TYPE_CHECKING:  # numbers are attributes by their names

        def __getattr__(self, name: str) -> float: ...

    def __init__(self, numbers: dict[str, float]) -> None:
        self.numbers = numbers
        self.__dict__.update(numbers)

    def __repr__(self):
        return f"Cycle({', '.join(f'{name}={value:.6g}' for name, value in self.numbers.items())})"


def error_of(code: int, message: str) -> ContactError:
    """Returns the exception for an exit code of the library or of the program, with its message."""
    if code == UNREADABLE and message.endswith(_MISSING):
        return MissingInput(code, message)
    kinds = {NOT_CONVERGED: NotConverged, NO_EQUILIBRIUM: NoEquilibrium, EDGE: EdgeContact}
    return kinds.get(code, ContactError)(code, message)


# ---------------------------------------------------------------- the library

_lock = threading.RLock()  # one thread at a time may be in the library
_library = None


def _candidates():
    """Possible places of libpetsam: $PETSAM_LIBRARY, the build tree, the prefix of these scripts or of petsam."""
    if os.environ.get("PETSAM_LIBRARY"):
        return [os.environ["PETSAM_LIBRARY"]]
    folders = [TREE / "build" / "lib", PREFIX / "lib"]
    program = os.environ.get("PETSAM") or shutil.which("petsam")
    if program:
        folders.append(Path(program).resolve().parents[1] / "lib")
    # a wheel has the library only under the version of its interface
    names = ("libpetsam.so", "libpetsam.so." + ".".join(__version__.split(".")[:2]))
    return [*[str(folder / name) for folder in folders for name in names if (folder / name).exists()], "libpetsam.so"]


def _share_mpi():
    """Make MPI's symbols visible to the modules that it loads itself; HDF5's would disturb h5py's own."""
    try:
        with open("/proc/self/maps") as maps:
            names = {line.split()[-1] for line in maps if "/libmpi.so" in line}
    except OSError:
        return
    for name in names:
        ctypes.CDLL(name, mode=ctypes.RTLD_GLOBAL)


def _find():
    reason = ""
    for name in _candidates():
        try:
            found = ctypes.CDLL(name)
            for text in ("message", "warning", "field_name", "number_name", "step_name", "stress_name"):
                getattr(found, f"petsam_{text}").restype = ctypes.c_char_p
            found.petsam_destroy.restype = None
            found.petsam_creep_load.restype, found.petsam_creep_slip.restype = ctypes.c_void_p, ctypes.c_double
            return found
        except OSError as error:
            reason = reason or str(error)
        except AttributeError:
            reason = reason or f"{name} is another library, or an older one"
    raise Missing(
        f"no libpetsam ({reason}): it is sought as PETSAM_LIBRARY, in build/lib, beside these scripts, and in lib "
        "beside the bin of a petsam on the PATH"
    )


def library() -> ctypes.CDLL:
    """libpetsam, loaded once; Missing if there is none."""
    global _library
    with _lock:
        if _library is None:
            found = _find()
            _share_mpi()
            _library = found
    return _library


def _text(words):
    """Encodes text for the library, which would end it at a NUL."""
    if "\0" in words:
        raise ValueError(f"{short(repr(words))}: expected words without a NUL character")
    return words.encode()


def _joined(function, names):
    """Encodes names for the library, which counts them by the commas between them: one name for each value."""
    for name in names:
        if not re.fullmatch(r"[^\s,;#\"]+", name):
            what = f"{short(repr(name))} is no name: give one name for each value, without commas or blanks"
            raise PrescribedError(2, f"{function}: {what}")
    try:
        command_line.one_case(names)
    except command_line.OptionError as error:
        raise PrescribedError(2, f"{function}: {error}") from None
    return _text(",".join(names))


def _real(value, name):
    """Returns a C double; TypeError names the argument."""
    try:
        return ctypes.c_double(value)
    except TypeError as error:
        raise TypeError(f"{name}: {error}: give a number in SI units") from None


# ---------------------------------------------------------------- contacts


class Stiffness(np.ndarray):
    """A matrix d(loads)/d(displacements), (n, n): an array of numpy whose repr has labels, a row for each load and a
    column for each displacement, {name: unit} each. The unit of a number is that of its row over that of its column.

    Arrays that are computed or cut from it have no labels, since those would not hold for them.
    """

    loads: Mapping[str, str] = {}
    displacements: Mapping[str, str] = {}

    def __new__(cls, values: ArrayLike, loads: Mapping[str, str], displacements: Mapping[str, str]) -> Stiffness:
        matrix = np.array(values, dtype=float).view(cls)
        matrix.loads, matrix.displacements = dict(loads), dict(displacements)
        return matrix

    def __reduce__(self):
        return type(self), (np.asarray(self), self.loads, self.displacements)

    def __array_wrap__(self, values, context=None, return_scalar=False):
        """Returns the result of numpy's operations on the matrix as a plain array or number."""
        return np.asarray(values)[()]  # of no dimension: a number

    def __getitem__(self, key):
        return np.asarray(self)[key]

    @property
    def T(self) -> np.ndarray:
        """The transpose, a plain array."""
        return np.asarray(self).T

    def __repr__(self):
        if not self.loads:  # a view
            return repr(np.asarray(self))
        columns = [_over(name, unit) for name, unit in self.displacements.items()]
        rows = [_over(name.removeprefix("load_").capitalize(), unit) for name, unit in self.loads.items()]
        own = np.sqrt(np.abs(np.diag(np.asarray(self))))  # of the stiffness by which a load moves its own displacement
        lines = [[f"{value:.5g}" for value in row] for row in _shown(self, np.outer(own, own))]
        widths = [max(map(len, column)) for column in zip(columns, *lines)]
        first = max(map(len, rows))
        table = zip(["", *rows], [columns, *lines])
        return "\n".join("  ".join([head.ljust(first), *map(str.rjust, cells, widths)]) for head, cells in table)

    __str__ = __repr__


def _over(name, unit):
    """A quantity over its unit."""
    return f"{name} / ({unit})" if " " in unit else f"{name} / {unit}"


def _condensed(k, names):
    """The stiffness k of the displacements of these names, or that name, while the loads of the others stay."""
    rigid, loads = list(k.displacements), list(k.loads)
    several = [names] if isinstance(names, str) else list(names)
    for name in several:
        if name not in rigid:
            raise ContactError(2, f"stiffness: condense {short(name)}: is no displacement{there_are(name, rigid)}")
    kept = [rigid.index(name) for name in several]
    # without those that the bodies do not have, and, where nothing rubs, those without stiffness
    free = [c for c in range(len(rigid)) if c not in kept and k[c, c] != 0.0 and not np.isnan(k[c, c])]
    scale = np.sqrt(np.abs(np.diag(k)[free]))
    try:
        follow = np.linalg.solve(k[np.ix_(free, free)] / np.outer(scale, scale), k[np.ix_(free, kept)] / scale[:, None])
    except np.linalg.LinAlgError:
        raise ContactError(2, "stiffness: condense: the other components have no stiffness together") from None
    found = k[np.ix_(kept, kept)] - k[np.ix_(kept, free)] @ (follow / scale[:, None])
    if isinstance(names, str):
        return float(found[0, 0])
    of = [{all_of[c]: units[all_of[c]] for c in kept} for all_of, units in ((loads, k.loads), (rigid, k.displacements))]
    return Stiffness(found, *of)


class Contact:
    """A contact of two bodies that have never touched.

    Parameters
    ----------
    comm : communicator of mpi4py, optional
        Spreads the contact over its ranks, which then call all functions together; None: this process alone.
    **options
        Options of the program petsam (examples/manual/OPTIONS.md) without the dash: grid_n=256, grid_size=(2e-3, 1e-3),
        friction=0.1, gap_type="sphere", wear_coefficient1=1e-14, ... Loads are given to try_step(). With errors=True
        (the option's word "companion") each step has step.errors.

    Attributes
    ----------
    n : tuple of int
        Numbers of cells (nx, ny).
    size, center : tuple of float
        Widths and centre of the grid in x and y, m.
    x, y : ndarray
        Cell centres, m: (nx,), and (rows,) of this rank's rows.
    first_row, rows : int
        This rank's rows: fields are arrays of (rows, nx).
    prescribable : dict
        {name: unit} of all that try_step() takes.
    has_errors : bool
        True if steps have errors, by companion runs.

    Raises
    ------
    ContactError
        If an option is wrong, or the memory does not suffice.
    MissingFile
        If a file that an option names is missing.
    TypeError
        If comm is no communicator, or an option is a field, which is given afterwards.
    Missing
        If there is no libpetsam.
    """

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
        with _lock:
            code = self._c.petsam_create(
                ctypes.c_int(-1 if comm is None else comm.py2f()), _text(command_line.line(options)),
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
        self._loads, self._displacements, creeps = names[:6], names[6:12], names[12:18]
        self._rigids = [rigid if rigid in known else creep for rigid, creep in zip(self._displacements, creeps)]

    def __repr__(self):
        cells = (
            f"{self.n[0]} x {self.n[1]} cells of {self.size[0] / self.n[0]:.4g} m x {self.size[1] / self.n[1]:.4g} m"
        )
        try:
            step = f"{self._last_step()!r}"
        except Error:
            step = "no step" if self._contact else "closed"
        return f"Contact({cells}; {step})"

    # ------------------------------------------------------------ calls

    def _message(self):
        return self._c.petsam_message(self._contact).decode(errors="replace")

    def _check(self, code):
        if code not in (0, EDGE):
            raise error_of(code, self._message())

    def _call(self, name, *arguments):
        """Calls a function of the library and returns its code; raises an exception if it fails."""
        with _lock:
            if not self._contact:
                raise ContactError(2, "the contact is closed")
            code = getattr(self._c, f"petsam_{name}")(self._contact, *arguments)
            self._check(code)
        return code

    def _names(self, what):
        """Returns the names of the fields ("field") or numbers ("number") that can be requested."""
        ask, found = getattr(self._c, f"petsam_{what}_name"), self._listed.setdefault(what, [])
        with _lock:
            if ask(self._contact, len(found)):  # names are only added, but to any place
                found.clear()
                while name := ask(self._contact, len(found)):
                    found.append(name.decode())
        return found

    # ------------------------------------------------------------ steps

    def try_step(self, time: float = 0.0, **given: float) -> Step:
        """Solves a step from the committed state; replaces an earlier try.

        Parameters
        ----------
        time : float
            Time, s.
        **given : float
            Each component by its load (load_n, N ... load_mz, N m), its displacement (disp_z, m ... rot_z, rad) or its
            creepage (creep_x, creep_y, creep_spin, 1/m); components that are not given are loads of 0. Besides them the
            conditions that are columns of a history: friction_scale, bulk2_stress_xx (Pa), body2_case_NAME, ...
            (contact.prescribable), which hold for this step; what is not given has the value of the contact's option.

        Returns
        -------
        Step

        Raises
        ------
        NoEquilibrium, NotConverged
            If there is no solution; the attribute `step` is the step.
        PrescribedError
            If a name is unknown, two names are of one component, or a value is out of range.
        TypeError
            If a value is no number.

        Notes
        -----
        With roll, roll_y (m) the contact rolls towards +x, +y: the grid moves over the bodies, and a creepage times the
        distance is the motion of body 1. With rolling="steady" each try is a steady state of rolling.

        An EdgeContactWarning is issued where the contact has reached the edge of the grid, an AdviceWarning, once of
        each kind, where the grid does not resolve the step.
        """
        values = np.array([_real(number, f"try_step: {name}").value for name, number in given.items()])
        seconds, load, rigid = _real(time, "try_step: time"), np.full(6, np.nan), np.full(6, np.nan)
        words = _joined("try_step", given), _pointer(values), _pointer(load), _pointer(rigid)
        with _lock:  # another thread's step must not come before the numbers and warnings of this one
            try:
                code = self._call("try", seconds, *words)
            except (NotConverged, NoEquilibrium) as error:
                error.step = self._step(time, load, rigid, error.code, str(error))
                raise
            except ContactError as error:
                if error.code != 2 or not self._contact:
                    raise
                raise PrescribedError(error.code, f"try_step: {error.message}") from None
            step = self._step(time, load, rigid, code, self._message())
            if code == EDGE:
                warnings.warn(step.message, EdgeContactWarning, stacklevel=2)
            self._advise()
        return step

    def _advise(self):
        """Warns of each number that is not resolved once per cause, and of all else once per kind: warnings of a kind
        differ only in numbers."""
        count = ctypes.c_int()
        with _lock:
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
        with _lock:
            for name in names:
                if self._c.petsam_get_number(self._contact, _text(name), ctypes.byref(value)) == 0:
                    found[name] = value.value
        return found

    def commit(self) -> None:
        """Makes the tried step the state from which the next one continues; the wear of the step is removed.

        Raises
        ------
        ContactError
            If no step with a solution has been tried.

        Notes
        -----
        A WearWarning is issued if the step wears more than the limit of a step.
        """
        with _lock:
            self._call("commit")
            message = self._message()
        if message:
            warnings.warn(message, WearWarning, stacklevel=2)

    def reject(self) -> None:
        """Discards the tried step: later steps are, to the last bit, as if it had not been tried."""
        self._call("reject")

    def stiffness(
        self,
        reversal: bool = False,
        condense: Union[str, Sequence[str], None] = None,
        cases: Union[str, Sequence[str]] = (),
    ) -> Any:
        """The stiffness d(loads)/d(displacements) of the tried step.

        Parameters
        ----------
        reversal : bool
            False: cells that slip go on slipping, the derivative of try_step(); True: all cells in contact stick,
            without a tried step those of the committed one.
        condense : str or sequence of str, optional
            "disp_x" or another displacement: the stiffness (a number) of its load while the other five loads stay, and
            their displacements follow; or several of them, for a matrix. For components that are held, use the whole
            matrix.
        cases : str or sequence of str
            Names of factors on load cases, "body2_case_pull": they are further columns, and their loads, the numbers
            "body2_case_pull_load", further rows.

        Returns
        -------
        Stiffness or float
            (6, 6) and more with cases: rows N, Tx, Ty, Mx, My, Mz, columns disp_z, disp_x, disp_y, rot_x, rot_y, rot_z,
            of N/m, N/rad, N, N m/rad. An array of numpy, for np.linalg.solve() and so on, that is printed with labels.

        Raises
        ------
        NotConverged
            If the stiffness does not converge.
        ContactError
            If there is no step, or condense names no displacement or components without stiffness.
        """
        names = [cases] if isinstance(cases, str) else list(cases)
        k = np.empty((6 + len(names), 6 + len(names)))
        if names:
            self._call("stiffness_with", ctypes.c_int(bool(reversal)), _joined("stiffness", names), _pointer(k))
        else:
            self._call("stiffness", ctypes.c_int(bool(reversal)), _pointer(k))
        units = self.prescribable
        loads = {name: units[name] for name in self._loads} | {f"{name}_load": "J" for name in names}
        k = Stiffness(k, loads, {name: units[name] for name in [*self._displacements, *names]})
        return k if condense is None else _condensed(k, condense)

    # ------------------------------------------------------------ histories and lives

    def run(self, history: Any, each: Optional[Callable[[Contact, Step], Any]] = None) -> list[Step]:
        """Solves a history from the committed state on and commits each step.

        Parameters
        ----------
        history : path or mapping
            A file as the option -history has it, or {column: values}: time, load_n, load_tx, disp_x, ..., each (rows,).
            The option steps of the contact divides the change to each row.
        each : callable, optional
            each(contact, step) is called after each step, may ask for fields, and ends the run by returning True.

        Returns
        -------
        list of Step

        Raises
        ------
        NoEquilibrium, NotConverged
            If a step has no solution; the attributes are `step`, and `steps`, those before it.
        ContactError
            If a column or a value is rejected.
        MissingFile
            If there is no such file.
        ValueError
            If rows of the file have different numbers of fields, or a field is no number.
        TypeError
            If the history is neither a file nor a mapping, or each cannot be called.

        """
        return self._run("history", (), history, each)

    def live(self, cycles: float, history: Any, each: Optional[Callable[[Contact, Cycle], Any]] = None) -> list[Cycle]:
        """Wear over many cycles of a closed history, most of them jumped over.

        Parameters
        ----------
        cycles : float
            Number of cycles.
        history : path or mapping
            One cycle: see run().
        each : callable, optional
            each(contact, cycle) as in run(), after each computed cycle.

        Returns
        -------
        list of Cycle

        Raises
        ------
        ContactError
            If the history or a value is rejected; other errors are those of run().

        Notes
        -----
        The options wear_rtol and wear_jump of the contact count.
        """
        return self._run("live", (_real(cycles, "live: cycles"),), history, each)

    def _run(self, name, first, history, each):
        columns, values = _table(history)
        found, failed = [], []
        if each is not None and not callable(each):
            raise TypeError(f"each: expected a function, and not {type(each).__name__}")

        def tell(_context, _contact, cycle):
            try:
                if bool(cycle) != (name == "live"):
                    return 0
                found.append(Cycle({n: self.number(f"wear/{n}") for n in CYCLE}) if cycle else self._last_step())
                return int(bool(each and each(self, found[-1])))
            except BaseException as error:  # it cannot pass through the library
                failed.append(error)
                return 1

        with _lock:  # as in try_step()
            try:
                code = self._call(
                    name,
                    *first,
                    _joined("run" if name == "history" else name, columns),
                    ctypes.c_int(len(values)),
                    _pointer(values),
                    _MONITOR(tell),
                    None,
                )
            except (NotConverged, NoEquilibrium) as error:
                error.steps = found[:-1] if name == "history" else found  # the monitor is called for a failed step, too
                error.step = self._last_step(error.code, str(error))
                raise
            if failed:
                raise failed[0]
            message = self._message()
            self._advise()
            if code == EDGE:
                ended = EdgeContact(code, message)
                ended.steps, ended.step = found, self._last_step(code, message)
                raise ended
        return found

    def _last_step(self, status=0, message=""):
        load, rigid = (np.array([self.number(name) for name in names]) for names in (self._loads, self._rigids))
        return self._step(self.number("time"), load, rigid, status, message)

    # ------------------------------------------------------------ fields and numbers

    def field(self, name: str, out: Optional[np.ndarray] = None) -> np.ndarray:
        """A field of the tried step, else of the committed one; also contact["pressure"].

        Parameters
        ----------
        name : str
            Its name in results files.
        out : ndarray, optional
            An array to write to: of (rows, nx) doubles, contiguous.

        Returns
        -------
        ndarray
            This rank's rows, (rows, nx), in SI units.

        Raises
        ------
        ContactError
            If there is no such field, or no step.
        ValueError
            If out has another shape or type.
        TypeError
            If the name is no text, or out no array.
        """
        shape = (self.rows, self.n[0])
        if out is None:
            out = np.empty(shape)
        elif not isinstance(out, np.ndarray):
            raise TypeError(f"out: expected an array, and not {type(out).__name__}")
        elif out.shape != shape or out.dtype != np.float64 or not out.flags.carray:
            raise ValueError(f"out is not a contiguous array of doubles of shape {shape} that can be written to")
        if not isinstance(name, str):
            raise TypeError(f"{name!r} is no name of a field")
        self._ask("get_field", name, _pointer(out))
        return out

    __getitem__ = field

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
            self._call(function, _text(name), target)
        except ContactError as error:
            what = function.split("_")[1]
            names = self._names(what) if self._contact else [name]
            if error.code != 2 or name in names:
                raise
            text = f"{short(name)}: there is no {what} of this name{there_are(name, names)}"
            raise ContactError(error.code, text) from None

    def set_field(self, name: str, values: ArrayLike) -> None:
        """Gives the gap or the friction; also contact["gap"] = values, and contact.gap = values.

        Parameters
        ----------
        name : str
            "gap", the separation of the undeformed, unworn bodies, m, or "friction".
        values : array_like
            This rank's rows, (rows, nx), or a number.

        Raises
        ------
        ContactError
            If there is no such field, or a value is out of range.
        ValueError
            If the shape is another one.
        TypeError
            If the name is no text, or the values are no real numbers.
        """
        values = arrays.real(values) if np.ma.isMA(values) else np.asarray(values)
        if not isinstance(name, str):
            raise TypeError(f"{name!r} is no name of a field: expected gap or friction")
        if values.dtype.kind not in "biufO":
            raise TypeError(f"{name}: expected real numbers, and not {values.dtype}")
        values = np.array(np.broadcast_to(values, (self.rows, self.n[0])), dtype=float, order="C")
        self._call("set_field", _text(name), _pointer(values))
        self._given[name] = values

    __setitem__ = set_field

    def _set_gap(self, values):
        self.set_field("gap", values)

    # given fields cannot be read back: field("gap") is the gap of the deformed bodies
    gap = property(None, _set_gap, doc="The separation of the undeformed, unworn bodies, m; to be set.")

    def _set_friction(self, values):
        self.set_field("friction", values)

    friction = property(None, _set_friction, doc="The coefficient of friction, a number or a field; to be set.")

    # ------------------------------------------------------------ stresses

    def stress(
        self,
        depths: Union[float, Sequence[float], str] = 0.0,
        section: Optional[str] = None,
        body: int = 2,
        quantities: Union[str, Sequence[str]] = ("stress", "mises"),
    ) -> dict[str, np.ndarray]:
        """Stresses in a body under the tried step, else the committed one.

        Parameters
        ----------
        depths : float, sequence or str
            m below the surface: a number, several, or "first:last:number".
        section : str, optional
            "y=0" or "x=1e-4" (m): only the line of cells nearest to it, not whole maps.
        body : int
            1 or 2.
        quantities : sequence of str
            Of stress, mises, principal, shear_max, strain.

        Returns
        -------
        dict
            {name: array} as in petsam-stress's file: stress_xx, mises, ... have the shape (1, z, y, x), Pa, strains 1;
            "time" (s), "z", "y" and "x" (m) are the coordinates. Of maps each rank has its rows, of sections all.

        Raises
        ------
        ContactError
            If an argument is rejected, or there is no step.

        Notes
        -----
        To the last bit what petsam-stress finds of this step.
        """
        return self._evaluate("stress", depths=depths, section=section, body=body, quantities=quantities)

    def record(self, on: bool = True) -> None:
        """Records each step that is committed from now on, for fatigue(). Forgets earlier ones.

        Parameters
        ----------
        on : bool
            False ends recording.

        Raises
        ------
        ContactError
            If the memory does not suffice.

        Notes
        -----
        A step takes 40 bytes a cell, and 48 more for each layer of bodies that yield. Steps of a history are recorded
        too; of a life those of the last computed cycle.
        """
        self._call("record", ctypes.c_int(bool(on)))

    def record_gradient(self, on: bool = True) -> AbstractContextManager:
        """Records each step that is committed from now on, for gradient(). Forgets earlier ones.

        Parameters
        ----------
        on : bool
            False ends recording.

        Returns
        -------
        context manager
            For `with contact.record_gradient(): contact.run(history)`: it does nothing, recording goes on.

        Raises
        ------
        ContactError
            If the contact has steps already, or an option whose derivative is not computed.

        Notes
        -----
        A step takes 60 bytes for each cell in contact; gradient_memory limits that, and further steps wait in a file in
        $TMPDIR. Cycles of live() are recorded, too, with a fixed wear_jump; the derivatives by loads and displacements
        are by the rows of its history then. Where the contact of dissimilar bodies grows it needs slip_direction="end".
        Slip at mid step is found to the tolerance of the shear while steps are recorded, so that the results of a run
        may differ from one that is not recorded, by what a step of second order leaves. The `rtol` of gradient()
        decides on the digits of derivatives: 1e-4 leaves up to 1e-3 of them, 1e-6 1e-5. The tolerances of the run leave
        less than 1e-6, but for closed loops, in which many cells hardly slip: these need normal_rtol=1e-10 and
        tangential_rtol=1e-10.
        """
        self._call("gradient_record", ctypes.c_int(bool(on)))
        return nullcontext(self)

    def gradient(
        self, name: str, of: Optional[Sequence[str]] = None, steps: Optional[slice] = None, rtol: float = 1e-4
    ) -> gradients.Gradient:
        """The derivatives of a number of the recorded steps by its parameters, in one pass back over the steps.

        Parameters
        ----------
        name : str
            "energy", the frictional work of the steps (J); "wear_volume", that of both bodies after the last of the
            steps (m3); a load that is given by its displacement, or a displacement that is given by its load, summed
            over the steps; "pressure_norm", (sum p^8 dA)^(1/8) of the last of the steps, a smooth maximum. Others,
            (sum s^40)^(1/40) over the cells at a depth: "stress_xx@50um" and the other components, "mises@50um" (Pa),
            of the last of the steps; "swt@50um", Smith, Watson and Topper's parameter of the cycle of the steps (Pa);
            "findley@50um@k=0.3" (Pa), "fatemi_socie@50um@k=1@yield=900MPa", with the constants of fatigue(); in body 2,
            or in body 1 as "swt@50um@1".
        of : sequence of str, optional
            Parameters: "gap" and "friction", of each cell; "load_n", "disp_x", "bulk2_stress_xx" ..., of each step;
            "wear_coefficient" and "wear_energy", of both bodies alike; "body1_young" and other moduli, "gap_radius1"
            and other parameters of the shape. None: all but moduli, which cost some more products a step, and shape;
            those by wear if the bodies wear.
        steps : slice, optional
            The steps, from 0; None: all for the energy and parameters of a cycle, else the last.
        rtol : float
            Relative residual of the systems that are solved, at most 0.01.

        Returns
        -------
        gradient.Gradient

        Raises
        ------
        ContactError
            If there is no such number, parameter or step, or the number has no derivative.
        NotConverged
            If a system does not converge.

        Warns
        -----
        gradient.OneSidedWarning
            If cells are on the border of their set.

        Notes
        -----
        The derivative is that of the number on this grid, whose sets of cells are frozen: where a cell changes from
        stick to slip, or comes into contact, it jumps by that cell's share. Areas, counts of cells and maxima over
        cells have no derivative.
        """
        first = last = -1
        if not isinstance(name, str):
            raise ContactError(2, f"gradient: {name!r}: expected the name of a number, as energy")
        if of is not None and (isinstance(of, str) or not len(of) or not all(isinstance(one, str) for one in of)):
            raise ContactError(2, f"gradient: of = {of!r}: expected a list of names of parameters")
        if not isinstance(rtol, Real):
            raise ContactError(2, f"gradient: rtol = {rtol!r}: expected a number, as 1e-4")
        if steps is not None:
            ends = (
                (steps.start or 0, steps.stop) if isinstance(steps, slice) and steps.step in (None, 1) else (-1, None)
            )
            if not all(end is None or isinstance(end, Integral) for end in ends):
                ends = -1, None
            if not 0 <= ends[0] < 2**31 or not (ends[1] is None or ends[0] < ends[1] < 2**31):
                raise ContactError(2, f"gradient: steps {steps}: expected a slice of neighbouring steps, from 0")
            first, last = int(ends[0]), -1 if ends[1] is None else int(ends[1]) - 1
        return gradients.compute(self, name, of, (first, last), rtol)

    def fatigue(
        self,
        parameters: Union[str, Sequence[str]],
        depths: Union[float, Sequence[float], str, None] = None,
        section: Optional[str] = None,
        body: int = 2,
        quantities: Union[str, Sequence[str]] = (),
        **constants: Any,
    ) -> dict[str, np.ndarray]:
        """Fatigue parameters over the recorded steps, taken as one closed cycle.

        Parameters
        ----------
        parameters : str or sequence of str
            Of crossland, dang_van, findley, swt, fatemi_socie, ruiz.
        depths : float, sequence or str, optional
            See stress(); the default is the surface.
        section : str, optional
            See stress().
        body : int
            1 or 2.
        quantities : sequence of str
            Those of stress() that are wanted too, of all steps: (time, z, y, x).
        **constants
            The options of petsam-stress: fatigue_crossland_alpha, fatigue_dang_van_alpha, fatigue_findley_k,
            fatigue_fatemi_socie_k, fatigue_yield (Pa), passing (True: of a point that passes along x under the one
            recorded step); fatigue_length (m) and fatigue_average (point, line, area) instead of depths.

        Returns
        -------
        dict
            {name: array} as stress(); the parameters have the shape (z, y, x).

        Raises
        ------
        ContactError
            If an argument is rejected, or no step was recorded.

        Notes
        -----
        A CycleWarning is issued if the tractions of the last step differ from those of the state in which recording
        began.
        """
        given = dict(depths=depths, section=section, body=body, quantities=quantities)
        return self._evaluate("fatigue", fatigue=parameters, **given, **constants)

    def _evaluate(self, function, **options):
        """Calls petsam_stress() or petsam_fatigue(); returns all results."""
        if np.size(options["quantities"]) == 0:
            options["quantities"] = "none"
        words = command_line.line(options)
        shape, dimensions, found = (ctypes.c_int * 4)(), ctypes.c_int(), {}
        with _lock:
            self._call(function, _text(words), shape)
            message = self._message()
            sizes = dict(zip(("time", "z", "y", "x"), shape))
            while name := self._c.petsam_stress_name(self._contact, len(found), ctypes.byref(dimensions)):
                one = sizes[name.decode()] if dimensions.value == 1 else tuple(shape)[-dimensions.value :]
                found[name.decode()] = np.empty(one)
                self._call("get_stress", name, _pointer(found[name.decode()]))
        if message:
            warnings.warn(message, CycleWarning, stacklevel=3)
        return found

    # ------------------------------------------------------------ files, end

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

    def copy(self, **options: Any) -> Contact:
        """Another contact of the same options, gap and friction, in the committed state of this one.

        Parameters
        ----------
        **options
            Options of the solvers, such as tangential_rtol, that change.

        Returns
        -------
        Contact

        Raises
        ------
        ContactError
            If an option is wrong, or the state does not fit the options.
        """
        other = Contact(**{**self._made, **options})
        for name, values in self._given.items():
            other.set_field(name, values)
        other._call("copy", self._contact)
        return other

    def take(self, other: Contact) -> None:
        """Takes over the committed state of another contact of the same options, gap and friction.

        Parameters
        ----------
        other : Contact
            The contact, which stays as it is.

        Raises
        ------
        TypeError
            If other is no open contact.
        ContactError
            If the state does not fit this contact.
        """
        if not isinstance(other, Contact) or not other._contact:
            raise TypeError("take: expected an open Contact")
        self._call("copy", other._contact)

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
        with _lock:
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


def _table(history):
    """Returns columns and values of a history: from a file, or from {column: values}."""
    if isinstance(history, (str, os.PathLike)):
        need_regular(history)
        lines = [line.split("#")[0].strip() for line in Path(history).read_text(encoding="utf-8-sig").splitlines()]
        lines = [(n, re.split(r"\s*[,;]\s*|\s+", line)) for n, line in enumerate(lines, 1) if line]
        columns, rows = [name.strip('"') for name in lines[0][1]], [row for _, row in lines[1:]]
        for number, row in lines[1:]:
            if len(row) != len(columns):
                raise ValueError(f"{history}, line {number}: has {len(row)} fields, the head has {len(columns)}")
        return columns, np.array(rows, dtype=float)
    if not hasattr(history, "keys") or not all(isinstance(name, str) for name in history):
        raise TypeError("history: expected the name of a file, or {column: values}")
    columns = list(history)
    return columns, np.ascontiguousarray(np.column_stack([arrays.real(history[name]) for name in columns]))


def _pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)
