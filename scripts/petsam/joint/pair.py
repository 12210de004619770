"""The structure of a pair of bodies, from a file of petsam-compliance --pair."""

import os
import tempfile

import h5py
import numpy as np

from ..contact import Contact
from ..errors import FILE, Error, short, there_are
from ..files import need_regular
from .structure import DISPLACEMENTS, Patch, Structure

PRESS = 4  # steps in which each bolt is tightened
PRESSING = ("disp_z", "rot_x", "rot_y")  # displacements whose loads press the bodies together


class Unreadable(Error):
    """A file that is not of the kind that is needed: a surface, or a pair of petsam-compliance."""

    code = FILE


class Pair:
    """Modes, bolts and sensors of a file, and the structure with its contact.

    path          the file
    preload       {bolt: initial tension in N}; the bolts are tightened in this order
    press         load steps in which each bolt is tightened
    frictionless  True: without friction while they are tightened, as if a vibration settled the surfaces
    friction_scale  factor on the friction of the options
    lower         by how much the degree of the file's polynomials is lowered
    damping       damping of the material as a part of critical
    options       of the contact: grid_n=..., friction=..., options_file=...

    Attributes:

    structure   the Structure, its bolts tightened
    omega       angular frequencies (rad/s) of the modes without contact
    sensors     {name: (modes, 3)}: displacement (m) of a sensor by each modal coordinate
    tensions    {name: N}: tension left in each bolt after all are tightened
    """

    def __init__(
        self, path, preload, press=PRESS, frictionless=False, lower=0, damping=0.0, friction_scale=1.0, **options
    ):
        need_regular(path)
        self.path = path
        self._folder = tempfile.TemporaryDirectory(prefix="petsam-")
        own = os.path.join(self._folder.name, "pair.h5")
        try:
            with h5py.File(path) as file:
                self._read(file)
            rigid = without_rigid(path, own, lower)
        except (OSError, LookupError, ValueError, TypeError) as error:
            raise Unreadable(f"{path}: no pair of petsam-compliance with modes: {short(error)}") from error
        self._check(preload)
        # a file of options may have the pair's own, with the compliance of rigid motions: the last one counts
        contact = Contact(**{**self.defaults, **options, "body2_compliance": own})
        self.structure = self._structure(contact, rigid, DISPLACEMENTS, damping)
        if frictionless:
            pressed = self._structure(contact, rigid, PRESSING, damping)
            self._tighten(pressed, preload, press, 0.0)
            self._continue(pressed, friction_scale)
        else:
            self._tighten(self.structure, preload, press, friction_scale)
        self.tensions = self.left()

    def _structure(self, contact, rigid, by_load, damping):
        modes = [f"body2_case_mode{k + 1}" for k in range(self.omega.size)]
        patch = Patch(contact, [*DISPLACEMENTS, *modes], by_load=by_load, name="contact")
        count = len(patch.coordinates)
        coupling = np.zeros((count, count))
        coupling[:6, :6] = rigid
        found = Structure([patch], self.omega, np.eye(count)[:, 6:], coupling, damping=damping)
        found.needs = self._folder  # copies of the contact read the file
        return found

    def _read(self, file):
        if "rigid" not in file or "modes" not in file:
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
            self.closing = file["bolts/closing"][()].reshape(2 * (len(self.bolts),))
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
        if not self.bolts:
            raise Error(f"{self.path}: has no bolt, so nothing presses the bodies together: make it with --bolt")
        if not preload:
            raise Error(f"preload: give the tension of {', '.join(self.bolts)}, in N")

    def _tighten(self, structure, preload, press, friction_scale):
        """Tightens the bolts one after the other, in the order given, each in `press` steps."""
        (patch,), force = structure.patches, np.zeros(self.omega.size)
        structure.loads[0] = -next(iter(preload.values()), 0.0) / press  # a first guess: all of the first tension
        patch.held["friction_scale"] = friction_scale
        for name, whole in preload.items():
            for part in np.linspace(0.0, 1.0, press + 1)[1:]:
                patch.held[f"body2_case_bolt_{name}"] = part * whole
                structure.step(force)

    def _continue(self, pressed, friction_scale):
        """Goes on from a structure whose contact was pressed without friction."""
        self.structure.patches[0].held = {**pressed.patches[0].held, "friction_scale": friction_scale}
        self.structure.z, self.structure.loads = pressed.z, pressed.loads
        self.structure.step(np.zeros(self.omega.size))

    def left(self, structure=None):
        """{bolt: tension in N} that is left in the last step of the structure, or of a copy of it."""
        patch = (structure or self.structure).patches[0]
        given = np.array([patch.held.get(f"body2_case_bolt_{name}", 0.0) for name in self.bolts])
        loads = np.array([patch.number(f"body2_case_bolt_{name}_load") for name in self.bolts])
        return dict(zip(self.bolts, given - self.stiffness * (self.closing @ given + loads)))


def without_rigid(path, name, lower=0):
    """Writes the pair without the compliance of rigid motions to a file, and returns that compliance (6, 6). The degree
    is lower by `lower` in x and in y."""
    with h5py.File(path) as old, h5py.File(name, "w") as new:
        table = old["basis/degree_xy"][()]
        kept = np.flatnonzero(np.all(table <= np.maximum(table.max(axis=0) - lower, 1), axis=1))
        if len(table) < np.prod(table.max(axis=0) + 1):  # up to a total degree
            kept = np.flatnonzero(table.sum(axis=1) <= max(table.sum(axis=1).max() - lower, 1))
        rigid, q = old["rigid/compliance"][()], old["rigid/motions"][()][:, kept]
        new.attrs.update(old.attrs)
        old.copy("patch", new)
        new["basis/degree_xy"] = table[kept]
        new["compliance"] = old["compliance"][()][kept][:, :, kept] - np.einsum("cik,cd,djl->ikjl", q, rigid, q)
        for case, data in old["cases"].items():
            new[f"cases/{case}/displacement"] = data["displacement"][()][kept]
    return rigid
