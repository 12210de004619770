"""The compliance of a body or of a pair, called from a notebook: of_deck(), of_mesh()."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping

from ...core.errors import Unusable
from . import model
from .result import Compliance
from .settings import settings


def of_deck(
    deck: str | os.PathLike, patch: float | tuple, contact: str, supports: object = (),
    progress: Callable | None = None, **more: object,
) -> Compliance:  # fmt: skip
    """The compliance of a body, or of a pair joined by bolts, from a deck of CalculiX or Abaqus (.inp).

    A deck of CPE elements is the section of a body or of a pair in plane strain, for -elasticity plane.

    Parameters
    ----------
    deck : str or path
        File with mesh, sets, materials and steps.
    patch : float or tuple
        Full widths (m) of the patch in x and y, or one of a square or of a section.
    contact : str or tuple
        Element surface on which the patch lies: its name, or a box of two corners, ((x, y, z), (x, y, z)), in the
        mesh's coordinates and units, None leaving a coordinate free.
    supports : str, tuple or list of them
        Node set that is held in x, y and z, or several: names or boxes.
    progress : callable
        Called with a text on what is being computed, and how far: print, for example.
    **more
        The other fields of settings.Settings: units="mm", frame=((0, 0, 0), (1, 0, 0)), centers=[(0, 0)], degree=6,
        symmetry=set, cases={name: step}, coarse=deck, method="auto", stiffness="own", keep_elements=False, depth=m,
        stress=True; of a pair
        pair=surface, bolts={name: (surface 1, surface 2, diameter in m, modulus in Pa)}, modes=12,
        sensors={name: node}, free=True.

    Returns
    -------
    Compliance
        Bodies, moduli, modes, checks; .write(path), .table(), .to_dataframe(), .to_csv(path); petsam.plot.compliance()
        draws it.

    Raises
    ------
    Error
        For a deck that cannot be read, or values that do not fit it; the message names the options of
        petsam-compliance.

    Examples
    --------
    A cube of 27 linear bricks that is held at its base, with a patch on the middle of its top.

    >>> import itertools, petsam
    >>> nodes = {x: k for k, x in enumerate(itertools.product(range(4), repeat=3), 1)}
    >>> corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    >>> lines = ["*NODE", *(f"{k}, {x}, {y}, {z}" for (x, y, z), k in nodes.items()), "*ELEMENT, TYPE=C3D8, ELSET=ALL"]
    >>> for k, (x, y, z) in enumerate(itertools.product(range(3), repeat=3), 1):
    ...     brick = [nodes[x + a, y + b, z + c] for c in (0, 1) for a, b in corners]
    ...     lines.append(", ".join(map(str, [k, *brick])))
    >>> lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "210000, 0.3", "*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL"]
    >>> with open("cube.inp", "w") as deck:
    ...     print(*lines, sep="\\n", file=deck)
    >>> top, base = ((0, 0, 3), (3, 3, 3)), ((0, 0, 0), (3, 3, 0))
    >>> found = petsam.compliance.of_deck("cube.inp", 1e-3, top, base, units="mm", frame=((1.5, 1.5, 3),), degree=2)
    >>> round(1e-9 * found.bodies[0].young), found.bodies[0].compliance.shape  # GPa; six functions by three components
    (210, (18, 18))
    """
    if more.get("materials") is not None:
        raise Unusable("a deck has its own materials: use of_mesh(), or omit the materials")
    return model.computed(deck, settings(contact, patch, supports, **more), "petsam.compliance.of_deck()", progress)


def of_mesh(
    mesh: object, patch: float | tuple, young: float | Mapping, poisson: float | Mapping,
    density: float | Mapping | None = None, supports: object = (), **more: object,
) -> Compliance:  # fmt: skip
    """The compliance of a mesh of any mesher.

    Parameters
    ----------
    mesh : meshio.Mesh, str or path
        A mesh, or the name of a file that meshio reads.
    patch, supports
        As of of_deck(); sets are point_sets, cell_sets, physical groups of Gmsh, or boxes.
    young, poisson : float or mapping
        Young's modulus (Pa) and Poisson's ratio of all elements, or {set of elements: value}.
    density : float or mapping, optional
        Density (kg/m3), needed for modes, likewise.
    **more
        The other arguments of of_deck(), `contact` among them. A mesh has no steps for load cases.

    Returns
    -------
    Compliance
        As of of_deck().

    Raises
    ------
    Missing
        If meshio is not installed.
    Error
        As of of_deck().
    """
    contact, progress = more.pop("contact", None), more.pop("progress", None)
    given = settings(contact, patch, supports, materials=(young, poisson, density), **more)
    return model.computed(mesh, given, "petsam.compliance.of_mesh()", progress)
