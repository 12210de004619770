"""Compliance from the stiffness matrix of a substructure of another program, by the direct method.

The retained nodes are the patch. Each phi_j gives consistent forces F_j on them, by triangles between the nodes;

    D_ij = F_i . K^-1 F_j - <phi_i, K_half-space phi_j>

which subtracts two large numbers: the finite elements' error of the local displacements stays in D. It is too stiff by
a few per cent of D at degree 1, and from degree 2 on its local part replaces that of the half-space. The method by
meshes has no such error.

Formats: Abaqus .mtx (*USER ELEMENT, *MATRIX) and CalculiX's, Nastran's DMIG KAAX (bulk data), and a list of the lower
triangle by rows (ANSYS .sub as text) in the order of the table of nodes, three directions per node.
"""

import re

import numpy as np
from scipy.spatial import Delaunay

from ..core.errors import Error, short
from ..core.files import lines_of, text_of
from . import checks
from .basis import Patch
from .halfspace import projected
from .model import Body, examine, frame_of
from .several import Joined
from .shapes import simplex_rule
from .units import HARDEST, OWN, SOFT, UNITS

SYMMETRY = 1e-6  # relative to the largest term of the matrix
UNCONDENSED = 0.5  # force by a unit translation over the sum of the diagonal, above which nodes were fixed
NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?")
WARNING = (
    "warning: a matrix gives the compliance by the direct method, whose local error stays: use degree 1; "
    "use --mesh where a mesh exists"
)


def _numbers(text):
    return np.array([float(word.replace("D", "E").replace("d", "e")) for word in NUMBER.findall(text)])


def triangle(values, path):
    """The symmetric matrix of its lower triangle by rows, or of all its rows."""
    size = int(round(np.sqrt(2.0 * len(values) + 0.25) - 0.5))
    if size * (size + 1) // 2 == len(values):
        matrix = np.zeros((size, size))
        matrix[np.tril_indices(size)] = values
        return matrix + np.tril(matrix, -1).T
    side = int(round(np.sqrt(len(values))))
    if side * side == len(values):
        return values.reshape(side, side)
    raise Error(f"{path}: has {len(values)} numbers, which are no triangle of a matrix: write the stiffness alone")


def _abaqus(text, path):
    """Matrix, and nodes and directions of its rows, of *USER ELEMENT and *MATRIX, TYPE=STIFFNESS."""
    head, found, tail = re.split(r"(?i)(\*MATRIX\s*,\s*TYPE\s*=\s*STIFFNESS[^\n]*\n)", text, maxsplit=1)[:3]
    matrix = triangle(_numbers(re.split(r"\n\*", tail)[0]), path)
    after = re.split(r"(?i)\*\*\s*ELEMENT NODES[^\n]*\n", head)
    lines = re.match(r"(?:\*\*[ \t]*[\d, \t]+\n)*", after[1])[0] if len(after) > 1 else ""
    nodes = _numbers(lines.replace("*", " ")).astype(int)
    if len(nodes) * 3 == len(matrix):
        nodes = np.repeat(nodes, 3)
    if len(nodes) != len(matrix):
        raise Error(
            f"{path}: lists {len(nodes)} nodes for {len(matrix)} rows: use three directions per node, rotations none"
        )
    seen, direction = {}, []
    for node in nodes.tolist():
        direction.append(seen.get(node, 0))
        seen[node] = direction[-1] + 1
    return matrix, nodes, np.array(direction)


def _nastran(text, path):
    """The same of DMIG KAAX, fields of 8 or 16 characters or separated by commas."""
    entries, column = {}, None
    for line in lines_of(text):
        long = "*" in line[:8]
        fields = (
            line.split(",")
            if "," in line
            else [line[:8], *(line[i : i + (16 if long else 8)] for i in range(8, 72, 16 if long else 8))]
        )
        fields = [word.strip() for word in fields]
        if fields[0].upper().rstrip("*").strip() == "DMIG":
            if len(fields) > 2 and fields[1].upper() == "KAAX" and fields[2] != "0":
                column = (int(fields[2]), int(fields[3]))
                fields = fields[:1] + (fields[5:8] if not long else [])
            else:
                column = None
                continue
        if column is None or len(fields) < 4 or not fields[1]:
            continue
        value = float(re.sub(r"(?<=[\d.])([+-]\d+)$", r"E\1", fields[3].upper().replace("D", "E")))
        row = (int(fields[1]), int(fields[2]))
        entries[row, column] = entries[column, row] = value
    keys = sorted({key for pair in entries for key in pair})
    if any(not 1 <= direction <= 3 for _, direction in keys):
        raise Error(f"{path}: KAAX has rotations: retain displacements only")
    place = {key: i for i, key in enumerate(keys)}
    matrix = np.zeros((len(keys), len(keys)))
    for (row, column), value in entries.items():
        matrix[place[row], place[column]] = value
    return matrix, np.array([node for node, _ in keys]), np.array([direction - 1 for _, direction in keys])


def read_nodes(path):
    """{number: x} of a table."""
    nodes = {}
    for number, line in enumerate(lines_of(text_of(path)), 1):
        line = re.split(r"[#!]|\*\*", line)[0]
        words = line.replace(",", " ").split()
        if not words:
            continue
        try:
            node, place = int(words[0]), [float(word) for word in words[1:4]]
        except ValueError:
            raise Error(f"{path}:{number}: {short(line.strip())}: expected `node x y z`") from None
        if len(place) != 3 or not np.all(np.isfinite(place)):
            raise Error(f"{path}:{number}: expected `node x y z`")
        if node in nodes:
            raise Error(f"{path}:{number}: node {node} is given twice: remove one of its lines")
        nodes[node] = place
    return nodes


def read(path, table):
    """Stiffness (3 n, 3 n) and coordinates (n, 3), in the files' units."""
    text = text_of(path)
    nodes = read_nodes(table)
    if re.search(r"(?i)\*MATRIX\s*,\s*TYPE\s*=\s*STIFFNESS", text):
        matrix, number, direction = _abaqus(text, path)
    elif re.search(r"(?im)^DMIG\*?[\s,]+KAAX", text):
        matrix, number, direction = _nastran(text, path)
    else:
        matrix = triangle(_numbers(re.sub(r"(?m)^\s*[!#*].*$", "", text)), path)
        number, direction = np.repeat(list(nodes), 3), np.tile([0, 1, 2], len(nodes))
    if len(number) != len(matrix):
        raise Error(f"{path}: has {len(matrix)} rows, {table} has {len(nodes)} nodes: use three rows per node")
    order = np.lexsort((direction, number))
    number, direction, matrix = number[order], direction[order], matrix[np.ix_(order, order)]
    unique = number[::3]
    if (
        len(number) % 3
        or np.any(number.reshape(-1, 3) != unique[:, None])
        or np.any(direction.reshape(-1, 3) != [0, 1, 2])
    ):
        raise Error(f"{path}: a node lacks a direction: retain x, y and z of each node")
    lacking = [int(node) for node in unique if int(node) not in nodes]
    if lacking:
        raise Error(f"{table}: node {lacking[0]} of the matrix is missing: add its coordinates")
    return matrix, np.array([nodes[int(node)] for node in unique])


def examined(matrix, path):
    """Returns the symmetric part of a matrix after checking that it is a condensed stiffness."""
    size = np.max(np.abs(matrix))
    asymmetry = np.max(np.abs(matrix - matrix.T)) / size if size > 0.0 else np.inf
    if not asymmetry <= SYMMETRY:
        raise Error(
            f"{path}: the matrix is asymmetric by {asymmetry:.2g} of its largest term: write the stiffness matrix"
        )
    matrix = 0.5 * (matrix + matrix.T)
    least = np.linalg.eigvalsh(matrix)[0]
    if not least > 1e-12 * size:
        raise Error(
            f"{path}: the matrix has the eigenvalue {least:.3g}, limit > 0: support the substructure before it is made"
        )
    ratio = max(matrix[d::3, d::3].sum() / np.trace(matrix[d::3, d::3]) for d in range(3))
    if ratio > UNCONDENSED:
        raise Error(
            f"{path}: a unit translation takes {ratio:.2g} of the sum of the diagonal, limit {UNCONDENSED:g}: "
            "the matrix is not condensed (CalculiX 2.20 writes such ones): use --mesh"
        )
    return matrix


def weights(points, patch):
    """int N phi_j (nodes, m) of linear shape functions on triangles between the points (n, 2)."""
    local, weight = simplex_rule(max(patch.largest) // 2 + 2)
    corners = points[Delaunay(points).simplices]
    sides = corners[:, 1:] - corners[:, :1]
    area = np.abs(np.linalg.det(sides))
    shape = np.stack([1.0 - local.sum(axis=1), *local.T], axis=1)
    x = np.einsum("qk,nkx->nqx", shape, corners)
    values = patch.values(*x.reshape(-1, 2).T).reshape(*x.shape[:2], -1)
    nodal = np.einsum("qk,nqj,q,n->nkj", shape, values, weight, area)
    out = np.zeros((len(points), patch.count))
    np.add.at(out, Delaunay(points).simplices, nodal)
    return out


def computed(path, options, command, progress):
    """The Joined of a substructure, which is one body with one patch."""
    units = UNITS[options.units]
    if not (options.young > 0.0 and -1.0 < options.poisson < 0.5):
        raise Error(f"--young {options.young:g}, --poisson {options.poisson:g}: use E > 0 and -1 < nu < 0.5")
    progress("matrix")
    matrix, x = read(path, options.nodes)
    matrix = examined(matrix, path) * (units.force / units.length)
    origin, direction, z = (list(options.frame) + [None, None])[:3]
    if z is None:
        raise Error("a matrix does not show where the body is: give z, into the body, as the third part of --frame")
    frame = frame_of(np.array(origin) * units.length, direction, z, -np.array(z))
    place = (x * units.length - frame.origin) @ frame.axes.T
    patch = Patch(options.center[0], tuple(0.5 * side for side in options.patch), options.degree)
    need_patch(place, patch)
    turn = np.kron(np.eye(len(place)), frame.axes)
    force = np.kron(weights(place[:, :2], patch), np.eye(3))
    compliance = force.T @ np.linalg.solve(turn @ matrix @ turn.T, force)
    compliance -= projected(patch, options.young, options.poisson)
    body = Body(options.young, options.poisson, "direct", path, command, frame, patch, compliance)
    body.remarks += [WARNING, *_doubts(options.young)]
    examine(body)
    return Joined([body])


def _doubts(young):
    """Warnings about --young, which is in Pa whatever the units of the matrix."""
    if OWN <= young < SOFT or young > HARDEST:
        return [f"warning: --young is {young:.6g} Pa: give it in Pa, as 2.1e11"]
    return []


def need_patch(place, patch):
    """Raises Error unless the nodes fill the patch, in its plane."""
    off = np.max(np.abs(place[:, 2])) / min(patch.half)
    if off > checks.FLATNESS:
        raise Error(
            f"a retained node is {off * min(patch.half):.3g} m off the plane of the frame, limit "
            f"{checks.FLATNESS * min(patch.half):.3g} m: correct --frame"
        )
    low, high = place[:, :2].min(axis=0), place[:, :2].max(axis=0)
    center, half = np.array(patch.center), np.array(patch.half)
    if np.max(np.abs(np.concatenate([low - center + half, high - center - half]))) > 1e-3 * min(patch.half):
        raise Error(
            f"the retained nodes span x = {low[0]:.6g} to {high[0]:.6g} m, y = {low[1]:.6g} to {high[1]:.6g} m: "
            "give this rectangle by --patch and --center"
        )
