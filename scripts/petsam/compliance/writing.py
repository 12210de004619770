"""The compliance as HDF5, for petsam's -body1_compliance and -body2_compliance."""

import hashlib
import os

import numpy as np

from ..replacing import replacing
from . import rigid
from .modes import UNIT as MODE

SIGN = "petsam_compliance"  # root attribute that identifies a file of this command
VERSION = 1
BLOCK = 1 << 20


def checksum(path):
    """SHA-256 of a file."""
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(BLOCK):
            digest.update(block)
    return digest.hexdigest()


def _fill(file, body):
    patch, m = body.patch, body.patch.count
    file.attrs.update({SIGN: VERSION, "young": body.young, "poisson": body.poisson, "method": body.method})
    file.attrs.update(
        degree=int(patch.powers.max()), source=os.path.basename(body.source), source_sha256=checksum(body.source)
    )
    file.attrs["command"] = body.command

    def put(name, values, unit, text):
        data = file.create_dataset(name, data=np.asarray(values, dtype=np.float64))
        data.attrs.update(units=unit, long_name=text)

    put("/frame/origin", body.frame.origin, "m", "origin of the frame in the model's coordinates")
    put("/frame/axes", body.frame.axes, "1", "x, y, z of the frame, z into the body, in the model's coordinates")
    put("/patch/center", patch.center, "m", "centre of the patch, x and y of the frame")
    put("/patch/half", patch.half, "m", "half widths of the patch")
    file["/basis/degree_xy"] = patch.powers
    compliance = body.compliance.reshape(m, 3, m, 3)
    put("/compliance", compliance, "m3/N", "displacement coefficients by traction coefficients, beyond the half-space")
    for name, case in body.cases.items():
        unit = case.unit.replace("m", "m2", 1)
        put(f"/cases/{name}/displacement", case.coefficients, unit, "displacement of the patch by the unit load case")
    if body.stress:
        _put_stress(put, body)
    if body.other:
        file.attrs.update(young1=body.other[0], poisson1=body.other[1])
        text = "displacement of body 1 against body 2 as a whole by loads on it, a part of /compliance"
        put("/rigid/compliance", rigid.compliance(body), "m/N, rad/N, m/(N m), rad/(N m)", text)
        put("/rigid/motions", rigid.motions(body.patch), "m2", "displacement of body 1 by a unit of each component")
        file["/rigid/compliance"].attrs["components"] = rigid.COMPONENTS
    if body.bolts:
        _put_bolts(file, put, body)
    if body.modes:
        _put_modes(file, put, body)
    for name, value in body.checks.items():
        put(f"/checks/{name}", value, "1", name.replace("_", " "))


def _put_stress(put, body):
    where, basis, cases = body.stress
    for letter in "xyz":
        put(f"/stress/{letter}", getattr(where, letter), "m", f"{letter} of the points")
    put("/stress/basis", basis, "1/m2", "stress xx, yy, zz, xy, xz, yz by traction coefficients, beyond the half-space")
    for name, stress in cases.items():
        put(f"/stress/cases/{name}", stress, "Pa", "stress xx, yy, zz, xy, xz, yz by the unit load case")


def _put_modes(file, put, body):
    put("/modes/omega", body.modes.omega, "rad/s", "angular frequencies without contact")
    put("/modes/mass_error", body.modes.mass_error, "1", "maximum error of the modes' orthonormality")
    if body.mesh.sensors:
        text = "mass-normalised modes at the sensors, in the deck's directions"
        put("/modes/sensors", body.modes.sensors, MODE, text)
        file["/modes/sensors"].attrs["names"] = [name for name, _ in body.mesh.options.sensor]


def _put_bolts(file, put, body):
    names = [one.name for one in body.bolts]
    for one in body.bolts:
        text = "axial stiffness between the washers"
        put(f"/bolts/{one.name}/stiffness", one.stiffness, "N/m", text)
        put(f"/bolts/{one.name}/length", one.length, "m", "distance of the washers' centres")
        put(f"/bolts/{one.name}/diameter", one.diameter, "m", "diameter")
        put(f"/bolts/{one.name}/young", one.young, "Pa", "Young's modulus")
    closing = np.stack([body.closing(f"bolt_{name}") for name in names], axis=1)
    put("/bolts/closing", closing, "m/N", "approach of a bolt's washers (row) by unit initial tension of one (column)")
    file["/bolts/closing"].attrs["names"] = names
    for name, case in body.cases.items():
        if not name.startswith("bolt_"):
            text = "approach of the bolts' washers by the unit load case"
            put(f"/bolts/closing_by/{name}", body.closing(name), case.unit, text)


def write(body, path):
    """Writes the Body; a file of that name is replaced once all is written."""
    with replacing(path) as file:
        _fill(file, body)
