"""The structure of a pair of bodies, from a file of petsam-compliance --pair: of_pair(), truncated()."""

import os
import tempfile

import h5py
import numpy as np

from ..contact import Contact
from ..errors import FILE, Error, short, there_are
from ..files import need_regular
from .structure import DISPLACEMENTS, Patch, Structure

PRESS = 4  # steps in which each bolt is tightened


class Unreadable(Error):
    """A file that is no pair of petsam-compliance."""

    code = FILE


class Pair:
    """Modes, bolts and sensors of a file, and the structure with its contact.

    structure   the Structure, its bolts tightened
    omega       angular frequencies (rad/s) of the modes without contact
    sensors     {name: (modes, 3)}: displacement (m) of a sensor by each modal coordinate
    tensions    {name: N}: tension left in each bolt after all are tightened
    """

    def __init__(self, path, preload, press=PRESS, **options):
        need_regular(path)
        self.path = path
        try:
            with h5py.File(path) as file:
                self._read(file)
        except (OSError, LookupError, ValueError, TypeError) as error:
            raise Unreadable(f"{path}: no pair of petsam-compliance with modes: {short(error)}") from error
        self._check(preload)
        contact = Contact(**{**self.defaults, "body2_compliance": path, **options})
        modes = [f"body2_case_mode{k + 1}" for k in range(self.omega.size)]
        patch = Patch(contact, modes, dict.fromkeys(DISPLACEMENTS, 0.0))
        self.structure = Structure([patch], self.omega, np.eye(self.omega.size))
        self._tighten(patch, preload, press)

    def _read(self, file):
        if "young1" not in file.attrs or "modes" not in file:
            raise ValueError("it has no body 1, or no modes: make it with --pair and --modes")
        self.omega = file["modes/omega"][()].astype(float)
        self.sensors = {}
        if "modes/sensors" in file:
            names = file["modes/sensors"].attrs["names"]
            self.sensors = {str(n): file["modes/sensors"][:, k] for k, n in enumerate(names)}
        self.bolts, self.stiffness, self.closing = [], np.zeros(0), np.zeros((0, 0))
        if "bolts" in file:
            self.bolts = [str(name) for name in file["bolts/closing"].attrs["names"]]
            self.stiffness = np.array([float(file[f"bolts/{name}/stiffness"][()]) for name in self.bolts])
            self.closing = file["bolts/closing"][()]
        half, center = file["patch/half"][()], file["patch/center"][()]
        self.defaults = dict(grid_size=2 * half, grid_center=center, gap_type="flat")
        for body, end in (("body1", "1"), ("body2", "")):
            self.defaults.update({f"{body}_{name}": float(file.attrs[name + end]) for name in ("young", "poisson")})

    def _check(self, preload):
        for name, force in preload.items():
            if name not in self.bolts:
                raise Error(f"preload {short(name)}: is no bolt of {self.path}{there_are(name, self.bolts)}")
            if not 0.0 <= force < np.inf:
                raise Error(f"preload {name}={force:g}: expected a tension from 0 on, in N")
        if self.bolts and not preload:
            raise Error(f"preload: give the tension of {', '.join(self.bolts)}, in N")

    def _tighten(self, patch, preload, press):
        """Tightens the bolts one after the other, in the order given, each in `press` steps."""
        force = np.zeros(self.omega.size)
        for name, whole in preload.items():
            for part in np.linspace(0.0, 1.0, press + 1)[1:]:
                patch.held[f"body2_case_bolt_{name}"] = part * whole
                self.structure.step(force)
        given = np.array([preload.get(name, 0.0) for name in self.bolts])
        loads = np.array([patch.number(f"body2_case_bolt_{name}_load") for name in self.bolts])
        left = given - self.stiffness * (self.closing @ given + loads)
        self.tensions = dict(zip(self.bolts, left))


def truncated(path, by=2):
    """Name of a temporary file of the same pair with polynomials of a degree lower by `by` in x and in y; the caller
    removes it."""
    handle, name = tempfile.mkstemp(suffix=".h5")
    os.close(handle)
    with h5py.File(path) as old, h5py.File(name, "w") as new:
        table = old["basis/degree_xy"][()]
        kept = np.flatnonzero(np.all(table <= np.maximum(table.max(axis=0) - by, 0), axis=1))
        total = table.sum(axis=1)
        if len(table) < np.prod(table.max(axis=0) + 1):  # up to a total degree
            kept = np.flatnonzero(total <= max(total.max() - by, 0))
        new.attrs.update(old.attrs)
        for group in ("patch", "modes", "bolts"):
            if group in old:
                old.copy(group, new)
        new["basis/degree_xy"] = table[kept]
        new["compliance"] = old["compliance"][()][kept][:, :, kept]
        for case, data in old["cases"].items():
            new[f"cases/{case}/displacement"] = data["displacement"][()][kept]
    return name
