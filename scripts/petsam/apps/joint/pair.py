"""The structure of a pair of bodies, or of sections in plane strain, from a file of petsam-compliance --pair."""

import os
import re
from collections.abc import Mapping
from typing import Any, Optional, Union

import numpy as np

from ...contact.inprocess import Contact
from ...core.errors import Error, Unusable, short, there_are
from ...core.files import need_regular
from ...core.hdf5 import DAMAGED, opened
from .arguments import integer, real
from .patch import DISPLACEMENTS, Patch
from .structure import Structure

PRESS = 4  # steps in which each bolt is tightened
SNUG = 0.1  # part of the tension of several bolts that all get before the first one is tightened
FIRST = 0.1  # the first guess of the loads over the tension: from loads that are too large the iteration may not end
ACROSS = ("rot_x", "rot_z")  # rotations that a section does not have
PRESSING = ("disp_z", "rot_x", "rot_y")  # displacements whose loads press the bodies together


class Pair:
    """Modes, bolts and sensors of a file, and the structure with its contacts, one for each patch of the file.

    Parameters
    ----------
    path : str or path
        File of petsam-compliance --pair with --modes.
    preload : mapping
        {bolt: initial tension in N, of a section N/m}; the bolts are tightened in this order.
    press : int
        Load steps in which each bolt is tightened; several bolts are snug first, with a tenth of the tension.
    frictionless : bool
        Whether they are tightened without friction, as if a vibration settled the surfaces.
    lower : int
        By how much the degree of the file's polynomials is lowered.
    damping : float
        Damping of the material as a part of critical.
    friction_scale : float
        Factor on the friction of the options.
    **options
        Options of each contact: grid_n=..., friction=..., options_file=...

    Attributes
    ----------
    structure : Structure
        Its bolts are tightened.
    omega : ndarray
        Angular frequencies of the modes without contact, (modes,), rad/s.
    sensors : dict
        {name: (modes, 3)}: displacement (m) of a sensor by each modal coordinate.
    tensions : dict
        {name: N}: tension left in each bolt after all are tightened; of a section N/m.
    places : dict
        {name: (x, y, diameter)}: where each bolt's axis crosses the contact's plane (m), as far as the file has it.
    unit : str
        Of tensions: "N", of a section "N/m".
    functions : int
        Number of polynomials of a patch.

    Raises
    ------
    Error
        For wrong values, a file that is no such pair, and where the structure finds no equilibrium.
    ContactError
        Where a contact rejects its options or has no solution.
    """

    def __init__(
        self,
        path: Union[str, os.PathLike],
        preload: Mapping[str, float],
        press: int = PRESS,
        frictionless: bool = False,
        lower: int = 0,
        damping: float = 0.0,
        friction_scale: float = 1.0,
        **options: Any,
    ) -> None:
        press, lower = integer("press", press), integer("lower", lower, 0)
        friction_scale = real("friction_scale", friction_scale, "a factor from 0 on", lambda one: 0.0 <= one < np.inf)
        grids = self._open(path, preload)
        # a file of options may have the pair's own, with the compliance of rigid motions: the last one counts
        # of each patch what is local: the structure has the motions as a whole
        contacts = [
            Contact(**{**grid, **self.moduli, **self.plane, **options, "body2_compliance": f"{path}:{k}:local:{lower}"})
            for k, grid in enumerate(grids, 1)
        ]
        self.structure = self._structure(contacts, self.displacements, damping)
        if frictionless:
            pressing = [name for name in PRESSING if name in self.displacements]
            pressed = self._structure(contacts, pressing, damping)
            self._tighten(pressed, preload, press, 0.0)
            self._continue(pressed, friction_scale)
        else:
            self._tighten(self.structure, preload, press, friction_scale)
        self.tensions = self.left()

    def _open(self, path, preload):
        """Reads the file and judges the preload; the options of each patch's grid."""
        need_regular(path)
        self.path = path
        try:
            with opened(path) as file:
                self._read(file)
                halves = [group["patch/half"][()][: 1 if self.plane else 2] for group in patches_of(file)]
                grids = [dict(grid_size=np.squeeze(2 * half), gap_type="flat") for half in halves]
                degrees = patches_of(file)[0]["basis/degree_xy"][()]
                self.functions, self.degree = len(degrees), int(degrees.max())
        except DAMAGED as error:
            raise Error(f"{path}: no pair of petsam-compliance with modes: {short(error)}") from error
        self._check(preload)
        return grids

    def _structure(self, contacts, by_load, damping):
        modes = [f"body2_case_mode{k + 1}" for k in range(self.omega.size)]
        patches, static, moved = [], [], []
        for k, (contact, far) in enumerate(zip(contacts, self.far), 1):
            names = [*self.displacements, *(f"body2_case_{name}" for name in far)]
            name = "contact" if len(contacts) == 1 else f"patch{k}"
            patches.append(Patch(contact, [*names, *modes], by_load=by_load, name=name, center=self.centers[k - 1]))
            static += [True] * len(names) + [False] * len(modes)
            moved += [np.zeros((len(names), len(modes))), np.eye(len(modes))]
        coupling, static = np.zeros(2 * (len(static),)), np.flatnonzero(static)
        coupling[np.ix_(static, static)] = self.coupling
        return Structure(patches, self.omega, np.concatenate(moved), coupling, damping=damping)

    def _read(self, file):
        if not ("rigid" in file or "coupling" in file) or "modes" not in file:
            raise ValueError("it has no body 1, or no modes: make it with --pair and --modes")
        self.coupling = file["coupling" if "coupling" in file else "rigid/compliance"][()]
        self.far = [_far(group) for group in patches_of(file)] if "coupling" in file else [[]]
        self.centers = [group["patch/center"][()] for group in patches_of(file)]
        if len(self.coupling) != sum(6 + len(names) for names in self.far):
            raise ValueError(f"the coupling of its patches has the shape {self.coupling.shape}")
        self._choose("datum" in file.attrs)
        self.omega = file["modes/omega"][()].astype(float)
        self.sensors = {}
        if "modes/sensors" in file:
            names = file["modes/sensors"].attrs["names"]
            self.sensors = {str(n): file["modes/sensors"][:, k] for k, n in enumerate(names)}
        self.bolts, self.stiffness, self.closing, self.places = [], np.zeros(0), np.zeros((0, 0)), {}
        if "bolts" in file:
            self.bolts = [str(name) for name in file["bolts/closing"].attrs["names"]]
            self.stiffness = np.array([float(file[f"bolts/{name}/stiffness"][()]) for name in self.bolts])
            self.closing = file["bolts/closing"][()].reshape(2 * (len(self.bolts),))
            groups = {name: file[f"bolts/{name}"] for name in self.bolts}
            self.places = {
                name: (*one["place"][()].tolist(), float(one["diameter"][()]))
                for name, one in groups.items()
                if "place" in one
            }
        self.moduli = {
            f"{body}_{name}": float(file.attrs[name + end])
            for body, end in (("body1", "1"), ("body2", ""))
            for name in ("young", "poisson")
        }

    def _choose(self, plane):
        """Takes the displacements that a contact has, of a section those in its plane and along its normal."""
        self.plane, self.unit = (dict(elasticity="plane"), "N/m") if plane else ({}, "N")
        self.displacements = [name for name in DISPLACEMENTS if not plane or name not in ACROSS]
        own = [name in self.displacements for name in DISPLACEMENTS]
        kept = np.flatnonzero(np.concatenate([[*own, *(True for _ in names)] for names in self.far]))
        self.coupling = self.coupling[np.ix_(kept, kept)]

    def _check(self, preload):
        if not isinstance(preload, Mapping):
            raise Unusable(f"preload {short(repr(preload))}: expected {{bolt: tension in N}}")
        for name, force in preload.items():
            if name not in self.bolts:
                raise Unusable(f"preload {short(name)}: is no bolt of {self.path}{there_are(name, self.bolts)}")
            real(f"preload {name}", force, "a tension from 0 on, in N", lambda one: 0.0 <= one < np.inf)
        if not self.bolts:
            raise Unusable(f"{self.path}: has no bolt, so nothing presses the bodies together: make it with --bolt")
        if not preload:
            raise Unusable(f"preload: give the tension of {', '.join(self.bolts)}, in N")

    def _tighten(self, structure, preload, press, friction_scale):
        """Tightens the bolts one after the other, in the order given, each in `press` steps; several ones after a part
        of the tension that all of them get together."""
        patches, parts, snug = structure.patches, np.linspace(0.0, 1.0, press + 1)[1:], {}
        rows = []
        if len(preload) > 1:
            snug = {name: SNUG * whole for name, whole in preload.items()}
            rows += [{name: part * force for name, force in snug.items()} for part in parts]
        for name, whole in preload.items():
            first = snug.get(name, 0.0)
            rows += [{name: first + part * (whole - first)} for part in parts]
        at, guess = 0, FIRST * sum(rows[0].values()) / len(patches)
        for patch in patches:
            structure.loads[at] = -guess
            at += len(patch.coordinates)
            patch.held["friction_scale"] = friction_scale
        structure.opens = True  # the first steps need not close the gap
        for row in rows:
            for patch in patches:
                patch.held.update({f"body2_case_bolt_{name}": force for name, force in row.items()})
            structure.step(np.zeros(self.omega.size))
        structure.opens = False
        for patch in patches:
            patch.need_closed()

    def _continue(self, pressed, friction_scale):
        """Goes on from a structure whose contact was pressed without friction."""
        for mine, its in zip(self.structure.patches, pressed.patches):
            mine.held = {**its.held, "friction_scale": friction_scale}
        self.structure.z, self.structure.loads = pressed.z, pressed.loads
        self.structure.step(np.zeros(self.omega.size))

    def left(self, structure: Optional[Structure] = None) -> dict[str, float]:
        """The tension that is left in each bolt.

        Parameters
        ----------
        structure : Structure, optional
            A copy of the pair's structure; None: that itself.

        Returns
        -------
        dict
            {bolt: tension in N} in its last step.
        """
        patches = (structure or self.structure).patches
        given = np.array([patches[0].held.get(f"body2_case_bolt_{name}", 0.0) for name in self.bolts])
        loads = [sum(patch.number(f"body2_case_bolt_{name}_load") for patch in patches) for name in self.bolts]
        return dict(zip(self.bolts, given - self.stiffness * (self.closing @ given + loads)))


def contents(path: Union[str, os.PathLike], preload: Mapping[str, float]) -> Pair:
    """Returns a Pair without its structure: bolts, sensors and modes of its file, whose preload has been judged. Raises
    an Error for a file that is no such pair, and for a preload that is not of its bolts."""
    found = Pair.__new__(Pair)
    found._open(path, preload)
    return found


def patches_of(file):
    """The groups of the patches: the file itself where there is one."""
    return [file["patches"][k] for k in sorted(file["patches"], key=int)] if "patches" in file else [file]


def _far(group):
    """Names of the load cases by which other patches move a patch, in the order of their numbers."""
    names = [name for name in group["cases"] if re.fullmatch("far[0-9]+", name)]
    return sorted(names, key=lambda name: int(name[3:]))
