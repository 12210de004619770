"""The compliance of a body or a pair as it is found: Compliance, with its file and its tables."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np

from ...core.errors import Error, counted, short, there_are
from ...core.hdf5 import need_own
from ...core.tables import Column, Tabled
from . import writing
from .modes import Modes


@dataclass
class Compliance(Tabled):
    """The result of of_deck() and of_mesh().

    Attributes
    ----------
    bodies : list
        The Bodies (model.py), one for each patch.
    coupling : ndarray or None
        Displacements of body 1 against body 2 as a whole, and factors on the load cases far1, far2, ..., of one patch
        after the other, by the loads that belong to them, (n, n); None: of one patch.
    missed : float
        Singular value of the compliance between patches that the load cases leave out, relative to the half-space.
    least : float
        Smallest eigenvalue of all patches together, relative to the half-space's compliance.
    """

    bodies: list
    coupling: np.ndarray | None = None
    missed: float = 0.0
    least: float = 1.0

    def __repr__(self):
        return f"Compliance({short(self.bodies[0].source)}: {counted(len(self.bodies), 'contact')})"

    @property
    def moduli(self) -> dict:
        """Young's modulus (Pa) and Poisson's ratio under the patch: of body 2, and of body 1 of a pair, as options of
        petsam: body2_young, ..."""
        body = self.bodies[0]
        found = {"body2_young": body.young, "body2_poisson": body.poisson}
        return {**found, **dict(zip(("body1_young", "body1_poisson"), body.other or ()))}

    @property
    def modes(self) -> Modes | None:
        """The modes without contact (modes.py): omega in rad/s, shapes, sensors; None without."""
        return self.bodies[0].modes

    @property
    def checks(self) -> list:
        """{name: value} of the checks of each patch, without units."""
        return [body.checks for body in self.bodies]

    @property
    def remarks(self) -> list:
        """Remarks and warnings about the mesh, as texts."""
        return self.bodies[0].remarks

    def write(self, path: str | os.PathLike) -> None:
        """Writes the HDF5 file for petsam's -body2_compliance; replaces one that petsam-compliance has written.

        Parameters
        ----------
        path : str or path
            Name of the file.

        Raises
        ------
        Error
            If the name is that of another file, or it cannot be written.
        """
        path = os.fspath(path)
        need_own(path, writing.SIGN, "petsam-compliance")
        writing.write(self, path)

    def table(self, of: str = "patches") -> list[Column]:
        """A table of what was found.

        Parameters
        ----------
        of : str
            What a row is: "patches", "cases", "bolts" or "modes".

        Returns
        -------
        list of tables.Column

        Raises
        ------
        Error
            If there is no such table.
        """
        made = {"patches": _patches, "cases": _cases, "bolts": _bolts, "modes": _modes}
        if of not in made:
            raise Error(f"table {of}{there_are(of, made)}")
        return made[of](self)


def _patches(found):
    """A row for each patch, with its checks."""
    bodies = found.bodies
    columns = [Column("patch", "1", "its number", [float(k) for k in range(1, 1 + len(bodies))])]
    for axis, name in enumerate("xy"):
        columns += [
            Column(f"center_{name}", "m", "centre in the frame", [float(one.patch.center[axis]) for one in bodies]),
            Column(f"width_{name}", "m", "full width", [2.0 * float(one.patch.half[axis]) for one in bodies]),
        ]
    columns.append(Column("functions", "1", "polynomials", [float(one.patch.count) for one in bodies]))
    names = dict.fromkeys(name for one in bodies for name in one.checks)
    columns += [
        Column(name, "1", name.replace("_", " "), [float(one.checks.get(name, np.nan)) for one in bodies])
        for name in names
    ]
    text = "estimated error of the compliance by the mesh, relative to it"
    return [*columns, Column("mesh_error", "1", text, [float(one.mesh_error) for one in bodies])]


def _cases(found):
    """A row for each load case of each patch: its largest coefficient, and what the polynomials miss."""
    rows = [(k, name, case) for k, one in enumerate(found.bodies, 1) for name, case in one.cases.items()]
    means = [case.coefficients[0] / (2.0 * np.sqrt(np.prod(found.bodies[k - 1].patch.half))) for k, _, case in rows]
    columns = [
        Column("patch", "1", "its number", [float(k) for k, _, _ in rows]),
        Column("case", "", "name of the load case", [name for _, name, _ in rows]),
        Column("unit", "", "of the displacement by the unit load case", [case.unit for _, _, case in rows]),
    ]
    for axis, name in enumerate("xyz"):
        text = "mean displacement of the patch, in the row's unit"
        columns.append(Column(f"mean_{name}", "1", text, [float(one[axis]) for one in means]))
    return [*columns, Column("missed", "1", "part that the polynomials miss", [float(case.rest) for *_, case in rows])]


def _bolts(found):
    """A row for each bolt."""
    bolts = found.bodies[0].bolts
    columns = [Column("bolt", "", "its name", [one.name for one in bolts])]
    kinds = {"stiffness": "N/m", "length": "m", "diameter": "m", "young": "Pa"}
    return columns + [Column(name, unit, name, [getattr(one, name) for one in bolts]) for name, unit in kinds.items()]


def _modes(found):
    """A row for each mode without contact, with its displacement at the sensors."""
    modes = found.modes
    if modes is None:
        return [Column("mode", "1", "its number", []), Column("frequency", "Hz", "without contact", [])]
    count = len(modes.omega)
    columns = [
        Column("mode", "1", "its number", [float(k) for k in range(1, 1 + count)]),
        Column("frequency", "Hz", "without contact", (modes.omega / (2.0 * np.pi)).tolist()),
    ]
    for k, (name, _) in enumerate(found.bodies[0].mesh.settings.sensors):
        for axis, letter in enumerate("xyz"):
            text = "mass-normalised mode, in the mesh's directions"
            columns.append(Column(f"{name}_{letter}", "kg^-0.5", text, modes.sensors[:, k, axis].tolist()))
    return columns
