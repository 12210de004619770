"""Meshes of any mesher beside decks: a meshio.Mesh, or a file that the library meshio reads.

Sets are meshio's point_sets and cell_sets, and the physical groups of Gmsh, by name or number: the nodes of their
cells as a node set, their triangles and quadrilaterals, or the faces between their points, as a surface, and their
solid elements as those of a material. The mesh has no materials and no load steps: moduli and densities are numbers,
or {set of elements: number}.
"""

import contextlib
import io

import numpy as np

from ...core.decks import folded
from ...core.errors import Error, library, short, there_are
from ...core.files import need_regular
from . import section, sound
from .boxes import faces_of
from .deck import Deck
from .mesh import Block, Mesh
from .units import UNITS

ENDINGS = (
    ".bdf", ".e", ".ex2", ".exo", ".fem", ".h5m", ".med", ".mesh", ".meshb", ".msh", ".nas", ".ugrid", ".vol", ".vtk",
    ".vtu", ".xdmf", ".xml",
)  # fmt: skip
SOLIDS = {
    "hexahedron20": "C3D20", "tetra10": "C3D10", "wedge15": "C3D15", "hexahedron": "C3D8", "tetra": "C3D4",
    "wedge": "C3D6",
}  # fmt: skip
PLANE = {"quad8": "CPE8", "triangle6": "CPE6", "quad": "CPE4", "triangle": "CPE3"}  # of meshes without solids
CORNERS = {"line": 2, "line3": 2, "triangle": 3, "triangle6": 3, "quad": 4, "quad8": 4, "quad9": 4}  # of faces
FLAT = ("vertex", *CORNERS)  # cells that only name nodes and faces
TAGS = ("gmsh:physical", "medit:ref")  # numbers of groups, as data of the cells


def read(path, settings):
    """The Deck of a file that meshio reads."""
    need_regular(path)  # meshio has a message of its own for a file that is not there
    meshio = library("meshio", f"{path}: such a mesh")
    told = io.StringIO()
    try:
        with contextlib.redirect_stdout(told), contextlib.redirect_stderr(told):
            found = meshio.read(path)
    except (SystemExit, Exception) as error:  # meshio prints its reason and ends the program, or raises an error
        reason = short(" ".join(told.getvalue().split()) or str(error))
        raise Error(f"{path}: meshio cannot read it: {reason}: give a mesh of another format") from error
    return deck_of(found, path, settings)


def _groups(mesh):
    """{name: indices of the cells for each block of cells}, of cell_sets and of physical groups."""
    empty = np.zeros(0, dtype=int)
    found = {}
    for name, chosen in mesh.cell_sets.items():
        if not name.startswith("gmsh:"):
            found[name] = [empty if one is None else np.asarray(one, dtype=int) for one in chosen]
    names = {(int(tag), int(dimension)): name for name, (tag, dimension) in mesh.field_data.items()}
    for key in TAGS:
        for tag in sorted({int(one) for data in mesh.cell_data.get(key, []) for one in np.unique(data)}):
            chosen = [np.flatnonzero(np.asarray(data) == tag) for data in mesh.cell_data[key]]
            found.setdefault(str(tag), chosen)
            for dimension in range(4):
                if (tag, dimension) in names:
                    of_dimension = [one if block.dim == dimension else empty for one, block in zip(chosen, mesh.cells)]
                    found.setdefault(names[tag, dimension], of_dimension)
    return found


def _of_materials(given, count, solids, groups, name):
    """Values (count) of the elements of one block of cells: of a number, or of {set: number}; NaN without one."""
    if not hasattr(given, "items"):
        return np.full(count, float(given))
    found = np.full(count, np.nan)
    for group, value in given.items():
        if group not in groups:
            raise Error(f"{name} of {short(group)}: no such set of elements{there_are(group, sorted(groups))}")
        found[groups[group][solids]] = value
    return found


def _need_materials(materials, name):
    """The moduli and the density of the settings, which must be there."""
    if materials is None or materials[0] is None or materials[1] is None:
        raise Error(f"{name}: a mesh has no materials: give --young and --poisson, and --density for modes")
    return (*materials[:2], 0.0 if materials[2] is None else materials[2])


def _kinds(mesh):
    """Types of the elements by those of meshio's cells: those of a section if there is none of a solid."""
    solid = any(cells.type not in FLAT for cells in mesh.cells)
    return SOLIDS if solid or not any(cells.type in PLANE for cells in mesh.cells) else PLANE


def _blocks(mesh, groups, settings, name):
    """The Blocks of the solid elements, numbered from 1, with moduli in the mesh's units."""
    units, blocks, first = UNITS[settings.units], [], 1
    young, poisson, density = _need_materials(settings.materials, name)
    kinds = _kinds(mesh)
    for k, cells in enumerate(mesh.cells):
        if cells.type in FLAT and cells.type not in kinds:
            continue
        if cells.type not in kinds:
            raise Error(f"{name}: elements of type {cells.type} are not supported: use {', '.join(SOLIDS)}")
        numbers = np.arange(first, first + len(cells.data))
        first += len(numbers)
        sizes = ((young, "--young", units.stress), (poisson, "--poisson", 1.0), (density, "--density", units.density))
        constants = [_of_materials(given, len(numbers), k, groups, option) / size for given, option, size in sizes]
        if not (np.all(constants[0] > 0.0) and np.all((constants[1] > -1.0) & (constants[1] < 0.5))):
            raise Error(f"{name}: use --young above 0 and --poisson from -1 to 0.5, for the sets of all elements")
        blocks.append(Block(kinds[cells.type], numbers, np.asarray(cells.data, dtype=int), *constants))
    if not blocks:
        raise Error(f"{name}: has no solid elements: use {', '.join(SOLIDS)}, or {', '.join(PLANE)} for a section")
    return blocks


def _surface(mesh, faces, wanted):
    """(element number, local face) of the outer faces whose corners are those of cells: sets of nodes."""
    found = []
    for group in faces:
        count = mesh.blocks[group.block].shape.face_corners(group.local)
        chosen = [frozenset(nodes) in wanted for nodes in group.nodes[:, :count].tolist()]
        found += [(int(one), group.local) for one in mesh.blocks[group.block].numbers[group.elements[chosen]]]
    return found


def deck_of(given, name, settings):
    """The Deck of a meshio.Mesh; name: of its file, in messages."""
    groups = _groups(given)
    blocks = _blocks(given, groups, settings, name)
    points = np.asarray(given.points, dtype=float)
    if points.shape[1] == 2 and _kinds(given) is PLANE:
        points = np.concatenate([points, np.zeros((len(points), 1))], axis=1)
    if points.shape[1] != 3:
        raise Error(f"{name}: its points have {points.shape[1]} coordinates: give a mesh in three dimensions")
    used = np.unique(np.concatenate([block.nodes.ravel() for block in blocks]))
    place = np.full(len(points), -1)
    place[used] = np.arange(len(used))
    for block in blocks:
        block.nodes = place[block.nodes]
    mesh = section.oriented(Mesh(points[used], blocks, {}, {}, used + 1), name)
    sound.need_sound(mesh, lambda number: f"{name}: element {number}")
    faces = list(mesh.boundary())
    for group, chosen in groups.items():
        nodes = [cells.data[one].ravel() for cells, one in zip(given.cells, chosen)]
        at = place[np.unique(np.concatenate(nodes))]
        mesh.node_sets[folded(group)] = at[at >= 0]
        corners = [place[cells.data[one][:, : CORNERS[cells.type]]].tolist()
                   for cells, one in zip(given.cells, chosen) if cells.type in CORNERS]  # fmt: skip
        wanted = {frozenset(nodes) for rows in corners for nodes in rows}
        if wanted:
            mesh.surfaces[folded(group)] = _surface(mesh, faces, wanted)
    for group, chosen in given.point_sets.items():
        at = place[np.asarray(chosen, dtype=int)]
        mesh.node_sets[folded(group)] = np.unique(at[at >= 0])
        inside = np.zeros(len(used), dtype=bool)
        inside[at[at >= 0]] = True
        mesh.surfaces.setdefault(folded(group), faces_of(mesh, inside))
    light = settings.materials[2] is None or not all(np.all(block.density > 0.0) for block in blocks)
    found = Deck(mesh, {}, [], [], ["of the mesh"] if light else [])
    found.label = str
    return found
