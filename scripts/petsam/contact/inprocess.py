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
import warnings
from collections.abc import Callable, Sequence
from typing import Any, Optional, Union

import numpy as np

from ..core.errors import Error
from .errors import (
    EDGE,
    ContactError,
    EdgeContact,
    EdgeContactWarning,
    NoEquilibrium,
    NotConverged,
    PrescribedError,
    WearWarning,
)
from .evaluations import Evaluations
from .histories import table
from .shared import joined, lock, pointer, real
from .steps import Cycle, Step, Stiffness, condensed

# numbers of a computed cycle, by their names in /wear
CYCLE = (
    "cycle", "jump", "error", "volume1", "volume2", "depth_max1", "depth_max2", "dissipated_energy", "contact_area",
    "pressure_max", "computed",
)  # fmt: skip
_MONITOR = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int)


class Contact(Evaluations):
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
    relaxes : bool
        True if a body relaxes, so that steps depend on their times.

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

    def __repr__(self):
        cells = (
            f"{self.n[0]} x {self.n[1]} cells of {self.size[0] / self.n[0]:.4g} m x {self.size[1] / self.n[1]:.4g} m"
        )
        try:
            step = f"{self._last_step()!r}"
        except Error:
            step = "no step" if self._contact else "closed"
        return f"Contact({cells}; {step})"

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
        values = np.array([real(number, f"try_step: {name}").value for name, number in given.items()])
        seconds, load, rigid = real(time, "try_step: time"), np.full(6, np.nan), np.full(6, np.nan)
        words = joined("try_step", given), pointer(values), pointer(load), pointer(rigid)
        with lock:  # another thread's step must not come before the numbers and warnings of this one
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
        with lock:
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
            self._call("stiffness_with", ctypes.c_int(bool(reversal)), joined("stiffness", names), pointer(k))
        else:
            self._call("stiffness", ctypes.c_int(bool(reversal)), pointer(k))
        units = self.prescribable
        loads = {name: units[name] for name in self._loads} | {f"{name}_load": "J" for name in names}
        k = Stiffness(k, loads, {name: units[name] for name in [*self._displacements, *names]})
        return k if condense is None else condensed(k, condense)

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
        return self._run("live", (real(cycles, "live: cycles"),), history, each)

    def _run(self, name, first, history, each):
        columns, values = table(history)
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

        with lock:  # as in try_step()
            try:
                code = self._call(
                    name,
                    *first,
                    joined("run" if name == "history" else name, columns),
                    ctypes.c_int(len(values)),
                    pointer(values),
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
