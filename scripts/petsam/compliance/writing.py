"""The compliance as HDF5, for petsam's -body1_compliance and -body2_compliance."""

import hashlib
import os

import h5py
import numpy as np

from ..errors import Error
from ..files import need_replaceable
from ..isolation import reading
from .basis import powers

SIGN = "petsam_compliance"  # root attribute by which a file of this command is known
VERSION = 1
BLOCK = 1 << 20


def need_own(path):
    """Error where the name is that of a file that this command has not written."""
    need_replaceable(path)
    if not os.path.exists(path):
        return
    try:
        with reading(path), h5py.File(path, "r") as file:
            own = SIGN in file.attrs
    except OSError:
        own = False
    if not own:
        raise Error(f"{path}: exists and was not written by petsam-compliance; choose another name by --output")


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
    file.attrs.update(degree=patch.degree, source=os.path.basename(body.source), source_sha256=checksum(body.source))
    file.attrs["command"] = body.command

    def put(name, values, unit, text):
        data = file.create_dataset(name, data=np.asarray(values, dtype=np.float64))
        data.attrs.update(units=unit, long_name=text)

    put("/frame/origin", body.frame.origin, "m", "origin of the frame in the model's coordinates")
    put("/frame/axes", body.frame.axes, "1", "x, y, z of the frame, z into the body, in the model's coordinates")
    put("/patch/center", patch.center, "m", "centre of the patch, x and y of the frame")
    put("/patch/half", patch.half, "m", "half widths of the patch")
    file["/basis/degree_xy"] = powers(patch.degree)
    compliance = body.compliance.reshape(m, 3, m, 3)
    put("/compliance", compliance, "m3/N", "displacement coefficients by traction coefficients, beyond the half-space")
    for name, case in body.cases.items():
        put(f"/cases/{name}/displacement", case.coefficients, "m2", "displacement of the patch by the unit load case")
    if body.stress:
        where, basis, cases = body.stress
        for letter in "xyz":
            put(f"/stress/{letter}", getattr(where, letter), "m", f"{letter} of the points")
        put(
            "/stress/basis",
            basis,
            "1/m2",
            "stress xx, yy, zz, xy, xz, yz by traction coefficients, beyond the half-space",
        )
        for name, stress in cases.items():
            put(f"/stress/cases/{name}", stress, "Pa", "stress xx, yy, zz, xy, xz, yz by the unit load case")
    for name, value in body.checks.items():
        put(f"/checks/{name}", value, "1", name.replace("_", " "))


def write(body, path):
    """The Body; a file of that name is replaced when all is written."""
    part = f"{path}.{os.getpid()}.tmp"
    try:
        with h5py.File(part, "w") as file:
            _fill(file, body)
        os.replace(part, path)
    except OSError as error:
        raise Error(f"{path}: cannot be written: {error.strerror or error}") from error
    finally:
        if os.path.exists(part):
            os.remove(part)
