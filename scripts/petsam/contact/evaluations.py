"""Computed from the steps of a contact: stresses, fatigue, and the gradient of a number."""

from __future__ import annotations

import ctypes
import warnings
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from numbers import Integral, Real
from typing import Any, Optional, Union

import numpy as np

from ..core import options as command_line
from ..results.gradients import Gradient
from . import derivatives
from .errors import ContactError, CycleWarning
from .fields import Fields
from .shared import encoded, lock, pointer


class Evaluations(Fields):
    """Stresses, fatigue and gradients of the steps of a contact."""

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
        decides on the digits of derivatives: 1e-4 leaves up to 1 % of them, 1e-6 1e-4. The tolerances of the run leave
        less than 1e-6, but for closed loops, in which many cells hardly slip: these need normal_rtol=1e-10 and
        tangential_rtol=1e-10. The grid's share is larger, 2 to 30 %: runs of the program with errors="companion"
        find it; here mean() of positions() of petsam.gradient lowers it.
        """
        self._call("gradient_record", ctypes.c_int(bool(on)))
        return nullcontext(self)

    def gradient(
        self, name: str, of: Optional[Sequence[str]] = None, steps: Optional[slice] = None, rtol: float = 1e-4
    ) -> Gradient:
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
        return derivatives.compute(self, name, of, (first, last), rtol)

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
        with lock:
            self._call(function, encoded(words), shape)
            message = self._message()
            sizes = dict(zip(("time", "z", "y", "x"), shape))
            while name := self._c.petsam_stress_name(self._contact, len(found), ctypes.byref(dimensions)):
                one = sizes[name.decode()] if dimensions.value == 1 else tuple(shape)[-dimensions.value :]
                found[name.decode()] = np.empty(one)
                self._call("get_stress", name, pointer(found[name.decode()]))
        if message:
            warnings.warn(message, CycleWarning, stacklevel=3)
        return found
