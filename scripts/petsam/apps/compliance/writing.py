"""The compliance as HDF5, for petsam's -body1_compliance and -body2_compliance."""

import os

import numpy as np

from ...core.hdf5 import replacing
from . import rigid
from .modes import UNIT as MODE

SIGN = "petsam_compliance"  # root attribute that identifies a file of this command
VERSION = 1
PLANE = 2  # version of the file of a section, with its datum
PATCHES = "patches"  # group of the groups 1, 2, ... where there are several


def _putter(group):
    """put(name, values, unit, text) writes a dataset of a group."""

    def put(name, values, unit, text):
        data = group.create_dataset(name, data=np.asarray(values, dtype=np.float64))
        data.attrs.update(units=unit, long_name=text)

    return put


def _fill(file, found):
    """Writes a Compliance: of one patch all of it at the root, where petsam reads it; else a group for each patch."""
    body, put = found.bodies[0], _putter(file)
    file.attrs.update({SIGN: VERSION, "young": body.young, "poisson": body.poisson, "method": body.method})
    degree = max(int(one.patch.powers.max()) for one in found.bodies)
    file.attrs.update(degree=degree, source=os.path.basename(body.source), source_sha256=body.checksum)
    file.attrs["command"] = body.command
    if body.datum is not None:
        file.attrs.update({SIGN: PLANE, "datum": body.datum})
    put("frame/origin", body.frame.origin, "m", "origin of the frame in the model's coordinates")
    put("frame/axes", body.frame.axes, "1", "x, y, z of the frame, z into the body, in the model's coordinates")
    several = len(found.bodies) > 1
    for k, one in enumerate(found.bodies, 1):
        _put_patch(file.create_group(f"{PATCHES}/{k}") if several else file, one)
    if body.other:
        file.attrs.update(young1=body.other[0], poisson1=body.other[1])
    if several:
        put("mesh_error", max(one.mesh_error for one in found.bodies), "1", "the largest one of the patches")
        _put_coupling(put, found)
    if body.bolts:
        _put_bolts(file, put, body)
    if body.modes:
        _put_modes(file, put, body)


def _put_patch(group, body):
    """Writes the data of a patch."""
    patch, m, put = body.patch, body.patch.count, _putter(group)
    put("patch/center", patch.center, "m", "centre of the patch, x and y of the frame")
    put("patch/half", patch.half, "m", "half widths of the patch")
    group["basis/degree_xy"] = patch.powers
    compliance = body.compliance.reshape(m, 3, m, 3)
    put("compliance", compliance, "m3/N", "displacement coefficients by traction coefficients, beyond the half-space")
    for name, case in body.cases.items():
        unit = case.unit.replace("m", "m2", 1)
        put(f"cases/{name}/displacement", case.coefficients, unit, "displacement of the patch by the unit load case")
    if body.other:
        text = "displacement of body 1 as a whole by loads on it, about the patch's centre, a part of compliance"
        put("rigid/compliance", rigid.compliance(body), "m/N, rad/N, m/(N m), rad/(N m)", text)
        put("rigid/motions", rigid.motions(patch), "m2", "displacement of body 1 by a unit of each component")
        group["rigid/compliance"].attrs["components"] = rigid.COMPONENTS
    if body.stress:
        _put_stress(put, body)
    if body.mesh_error is not None:
        put("mesh_error", body.mesh_error, "1", "estimated error of the compliance by the mesh, relative to it")
    for name, value in body.checks.items():
        put(f"checks/{name}", value, "1", name.replace("_", " "))


def _put_coupling(put, found):
    """Writes the coupling of the contacts of several patches through the structure."""
    text = "displacements of body 1 as a whole and factors on the cases far1, ..., patch by patch, by their loads"
    put("coupling", found.coupling, "", text)
    put("checks/missed", found.missed, "1", "compliance between patches that the load cases leave out")
    put("checks/smallest_eigenvalue", found.least, "1", "of all patches together, relative to the half-space")


def _put_stress(put, body):
    where, basis, cases = body.stress
    for letter in "xyz":
        put(f"stress/{letter}", getattr(where, letter), "m", f"{letter} of the points")
    put("stress/basis", basis, "1/m2", "stress xx, yy, zz, xy, xz, yz by traction coefficients, beyond the half-space")
    for name, stress in cases.items():
        put(f"stress/cases/{name}", stress, "Pa", "stress xx, yy, zz, xy, xz, yz by the unit load case")


def _per_metre(body, unit):
    """A unit, of sections that of 1 m."""
    units = {"N/m": "N/m2", "m/N": "m2/N", MODE: "m/(m (kg/m)^0.5)"}
    return unit if body.datum is None else units[unit]


def _put_modes(file, put, body):
    put("modes/omega", body.modes.omega, "rad/s", "angular frequencies without contact")
    put("modes/mass_error", body.modes.mass_error, "1", "maximum error of the modes' orthonormality")
    if body.modes.rigid is not None:
        put("modes/rigid", body.modes.rigid, "rad/s", "angular frequencies of the rigid motions, which are left out")
    if body.mesh.sensors:
        text = "mass-normalised modes at the sensors, in the deck's directions"
        put("modes/sensors", body.modes.sensors, _per_metre(body, MODE), text)
        file["modes/sensors"].attrs["names"] = [name for name, _ in body.mesh.settings.sensors]


def _put_bolts(file, put, body):
    names = [one.name for one in body.bolts]
    for one in body.bolts:
        text = "axial stiffness between the washers"
        put(f"bolts/{one.name}/stiffness", one.stiffness, _per_metre(body, "N/m"), text)
        put(f"bolts/{one.name}/length", one.length, "m", "distance of the washers' centres")
        put(f"bolts/{one.name}/diameter", one.diameter, "m", "diameter")
        put(f"bolts/{one.name}/young", one.young, "Pa", "Young's modulus")
        text = "x and y of the frame where its axis crosses the contact's plane"
        put(f"bolts/{one.name}/place", one.place, "m", text)
    closing = np.stack([body.closing(f"bolt_{name}") for name in names], axis=1)
    text = "approach of a bolt's washers (row) by unit initial tension of one (column)"
    put("bolts/closing", closing, _per_metre(body, "m/N"), text)
    file["bolts/closing"].attrs["names"] = names
    for name, case in body.cases.items():
        if not name.startswith("bolt_") and case.displacement is not None:
            text = "approach of the bolts' washers by the unit load case"
            put(f"bolts/closing_by/{name}", body.closing(name), case.unit, text)


def write(found, path):
    """Writes the Compliance; a file of that name is replaced once all is written."""
    with replacing(path) as file:
        _fill(file, found)
