"""Sections in plane strain: meshes of plane elements, of which 1 m along the normal is meant."""

import numpy as np

from ...core.errors import Error, Unusable, short
from . import basis
from .shapes import SECTIONS

LEVEL = 1e-6  # of the extent, by which nodes may be off the plane
REFUSED = {  # beginnings of element types that lie in a plane, and why they are not read
    "CPS": "is in plane stress, and -elasticity plane in plane strain: use CPE elements, or a mesh in three dimensions",
    "CAX": "is of a body of revolution, and the contact of a section is endless: use a mesh in three dimensions",
    "CGAX": "is of a body of revolution, and the contact of a section is endless: use a mesh in three dimensions",
}


def need_kind(kind, place):
    """Raises Error if a type of elements is a plane one that is not of plane strain."""
    for start, reason in REFUSED.items():
        if kind.startswith(start):
            raise Error(f"{place}: element type {short(kind)} {reason}")


def oriented(mesh, name):
    """The mesh itself, or that of a section with its normal, on the side from which its elements go counterclockwise;
    name: of the file, in messages."""
    flat = [block.shape.flat for block in mesh.blocks]
    if not any(flat):
        return mesh
    if not all(flat):
        raise Error(f"{name}: has solid elements beside those of a section, {', '.join(SECTIONS)}: give one kind alone")
    extent = np.ptp(mesh.nodes, axis=0)
    axis = int(np.argmin(extent))
    if extent[axis] > LEVEL * extent.max():
        off = np.abs(mesh.nodes[:, axis] - np.median(mesh.nodes[:, axis]))
        x, y, z = mesh.nodes[np.argmax(off)]
        raise Error(
            f"{name}: the nodes of a section are in no plane of two axes: that at {x:.3g}, {y:.3g}, {z:.3g} is "
            f"{off.max():.3g} off: give all in x and y, or in x and z"
        )
    first = mesh.nodes[mesh.blocks[0].nodes[:, : mesh.blocks[0].shape.corners]]
    turn = np.sum(np.cross(first[:, 1] - first[:, 0], first[:, -1] - first[:, 0])[:, axis])
    mesh.normal = np.eye(3)[axis] * (-1.0 if turn < 0.0 else 1.0)
    if axis == 2 and turn < 0.0:
        mesh.normal = np.eye(3)[2]  # decks have them counterclockwise: need_sound() says so
    return mesh


def thickness(sections):
    """The thickness that the loads are for, of cards *SOLID SECTION with their numbers: 1 where they have none."""
    found = {values[0] if values else 1.0: card for card, values in sections}
    if len(found) > 1:
        card = list(found.values())[1]
        raise Error(f"{card.place}: *SOLID SECTION has another thickness than the one before: give the same to all")
    ((value, card),) = found.items()
    if not value > 0.0:
        raise Error(f"{card.place}: *SOLID SECTION has the thickness {value:g}: give one above 0")
    return value


def need_settings(settings, path):
    """Raises Unusable for settings that a section has no place for."""
    across = [
        settings.patch[1] != settings.patch[0] and "--patch X,Y",
        any(y for _, y in settings.centers) and "--center X,Y with Y",
        np.ndim(settings.degree) == 1 and settings.degree[1] and "--degree NX,NY with NY",
    ]
    across = next((one for one in across if one), None)
    if across:
        raise Unusable(f"{path}: is a section, which does not vary along y: {across} has no meaning: give X alone")
    if settings.stiffness == "calculix":
        raise Unusable(f"{path}: --stiffness calculix is not for sections, which petsam assembles by itself: remove it")


def patch(settings, center):
    """The LinePatch of the settings."""
    return basis.line(center[0], 0.5 * settings.patch[0], int(np.atleast_1d(settings.degree)[0]))
