"""The stiffness matrix of a mesh: assembled here, or CalculiX's own, as of elements that are not assembled here.

CalculiX writes it in a step *FREQUENCY, SOLVER=MATRIXSTORAGE: the upper triangle as `row column value` (.sti) and node
and direction of each row (.dof). Nothing is supported in that deck; supports are applied afterwards.
"""

import shutil
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy import sparse

from ...core import environment
from ...core.errors import Error, Missing, short

OWN = (  # element types that are assembled here
    "C3D20", "C3D20R", "C3D10", "C3D15", "C3D8", "C3D4", "C3D6", "CPE8", "CPE8R", "CPE6", "CPE4", "CPE3",
)  # fmt: skip
CCX = "ccx"
MODES = 9  # incompatible modes of an element C3D8I
RIGID = 1e-9  # relative to the largest diagonal term; largest force on a node by a rigid motion


def elasticity(young, poisson):
    """Hooke's matrices (n, 6, 6) for xx, yy, zz, xy, xz, yz with engineering shear strains."""
    shear = 0.5 * young / (1.0 + poisson)
    lame = 2.0 * shear * poisson / (1.0 - 2.0 * poisson)
    c = np.zeros((len(young), 6, 6))
    c[:, :3, :3] = lame[:, None, None]
    for i in range(6):
        c[:, i, i] += (2.0 if i < 3 else 1.0) * shear
    return c


def strain_matrix(gradients):
    """B (..., 6, 3 k) of shape function gradients (..., k, 3)."""
    b = np.zeros((*gradients.shape[:-2], 6, gradients.shape[-2], 3))
    for i in range(3):
        b[..., i, :, i] = gradients[..., i]
    for row, (i, j) in enumerate(((0, 1), (0, 2), (1, 2)), 3):
        b[..., row, :, i] = gradients[..., j]
        b[..., row, :, j] = gradients[..., i]
    return b.reshape(*b.shape[:-2], -1)


def dofs(nodes):
    """Rows of the global matrix (n, 3 k) of elements' nodes (n, k)."""
    return (3 * nodes[..., None] + np.arange(3)).reshape(len(nodes), -1)


def rule(block):
    """Gauss points of CalculiX in the elements of a block, for stiffness and mass."""
    return block.shape.rule(2 if block.kind in ("C3D20R", "CPE8R") else block.shape.full)


def assembles(mesh):
    """True if all elements of the mesh are of types that are assembled here."""
    return all(block.kind in OWN for block in mesh.blocks)


def assembled(mesh):
    """K in compressed rows, by this program's own shape functions."""
    size = 3 * len(mesh.nodes)
    parts = []
    for index, block in enumerate(mesh.blocks):
        if block.kind not in OWN:
            raise Error(f"elements of type {block.kind} need CalculiX's stiffness: omit --stiffness own")
        local, weight = rule(block)
        stride = max(1, (1 << 22) // block.nodes.shape[1] ** 2)
        for first in range(0, len(block.nodes), stride):
            chosen = slice(first, first + stride)
            _, volume, _, gradients = mesh.volume(index, local, weight, chosen)
            hooke = elasticity(block.young[chosen], block.poisson[chosen])
            b = strain_matrix(gradients)
            wide = 3 * block.nodes.shape[1]
            cb = np.einsum("nij,nqjk->nqik", hooke, b) * volume[..., None, None]
            element = np.matmul(b.reshape(len(b), -1, wide).transpose(0, 2, 1), cb.reshape(len(b), -1, wide))
            rows = dofs(block.nodes[chosen])
            row = np.repeat(rows, rows.shape[1], axis=1).ravel()
            column = np.tile(rows, (1, rows.shape[1])).ravel()
            parts.append(sparse.coo_matrix((element.ravel(), (row, column)), shape=(size, size)).tocsr())
    return sum(parts[1:], parts[0])


# ---------------------------------------------------------------- CalculiX


def numbers(values, per_line=8):
    """Returns lines of integers, each followed by a comma."""
    values = [str(int(v)) for v in values]
    return [", ".join(values[i : i + per_line]) + "," for i in range(0, len(values), per_line)]


def model_lines(mesh):
    """Nodes, elements, sections and materials as lines of a deck; nodes are numbered from 1."""
    lines = ["*NODE, NSET=NALL"]
    lines += ["{}, {:.12e}, {:.12e}, {:.12e}".format(i, *p) for i, p in enumerate(mesh.nodes, 1)]
    sections = []
    for index, block in enumerate(mesh.blocks):
        pairs, which = np.unique(np.stack([block.young, block.poisson], axis=1), axis=0, return_inverse=True)
        for m, (young, poisson) in enumerate(pairs):
            name = f"E{index}M{m}"
            lines.append(f"*ELEMENT, TYPE={block.kind}, ELSET={name}")
            mine = which.ravel() == m
            for number, nodes in zip(block.numbers[mine], block.nodes[mine] + 1):
                lines += numbers([number, *nodes])
                lines[-1] = lines[-1].rstrip(",")
            sections += [f"*MATERIAL, NAME={name}", "*ELASTIC", f"{young:.12e}, {poisson:.12e}", "*DENSITY", "1."]
            sections.append(f"*SOLID SECTION, ELSET={name}, MATERIAL={name}")
    return lines + sections


def run(lines, folder, name, ccx=CCX):
    """Runs CalculiX on a deck; raises Error with its last output if it fails."""
    program = shutil.which(ccx)
    if not program:
        raise Missing(
            f"no CalculiX {ccx}: install the Debian package calculix-ccx, or omit --stiffness with elements "
            f"{', '.join(OWN)}"
        )
    folder = Path(folder)
    (folder / f"{name}.inp").write_text("\n".join(lines) + "\n", encoding="ascii")
    threads = {"OMP_NUM_THREADS": "1", "CCX_NPROC_STIFFNESS": "1"}
    with open(folder / f"{name}.log", "w+", encoding="utf-8", errors="replace") as log:
        with environment.start([program, name], True, threads, cwd=folder, stdout=log, stderr=log) as done:
            done.wait()
        log.seek(0)
        text = log.read()
    if done.returncode or "*ERROR" in text:
        at = text.find("*ERROR")
        raise Error(f"CalculiX failed on this mesh: {short(text[at:] if at >= 0 else text[-400:], 300)}")
    return text


def read_stored(folder, name, size):
    """The matrix that CalculiX has stored."""
    folder = Path(folder)
    try:
        places = np.array([line.split(".") for line in (folder / f"{name}.dof").read_text().split()], dtype=int)
        table = np.loadtxt(folder / f"{name}.sti", ndmin=2)
    except (OSError, ValueError) as error:
        raise Error(f"CalculiX stored no matrix that can be read: {short(error, 300)}") from error
    place = 3 * (places[:, 0] - 1) + places[:, 1] - 1
    row, column = (place[table[:, i].astype(int) - 1] for i in range(2))
    whole = max(size, 1 + int(place.max()))
    upper = sparse.coo_matrix((table[:, 2], (row, column)), shape=(whole, whole)).tocsr()
    matrix = (upper + upper.T - sparse.diags(upper.diagonal())).tocsr()
    return matrix if whole == size else condensed(matrix, size)


def condensed(matrix, size):
    """Eliminates the incompatible modes, nine unknowns in each element, which follow the nodes."""
    inner = matrix[size:, size:].tobsr((MODES, MODES))
    inner.sum_duplicates()
    if inner.data.shape[0] != (matrix.shape[0] - size) // MODES:
        raise Error("CalculiX stored incompatible modes that are coupled between elements: use elements C3D20R")
    inverse = sparse.bsr_matrix((np.linalg.inv(inner.data), inner.indices, inner.indptr), shape=inner.shape)
    outer = matrix[:size, size:]
    result = matrix[:size, :size] - outer @ inverse.tocsr() @ outer.T
    return (0.5 * (result + result.T)).tocsr()


def renumbered(mesh):
    """The mesh with elements numbered from 1: CalculiX has arrays of the highest number, in which those of instances
    overflow."""
    ends = np.cumsum([0, *(len(block.numbers) for block in mesh.blocks)])
    numbered = [
        replace(block, numbers=1 + end + np.arange(len(block.numbers))) for block, end in zip(mesh.blocks, ends)
    ]
    return replace(mesh, blocks=numbered)


def of_calculix(mesh, ccx=CCX):
    """K in compressed rows, as CalculiX assembles it."""
    lines = model_lines(renumbered(mesh)) + ["*STEP", "*FREQUENCY, SOLVER=MATRIXSTORAGE", "1", "*END STEP"]
    with tempfile.TemporaryDirectory(prefix="petsam-compliance-") as folder:
        try:
            run(lines, folder, "stored", ccx)
            return read_stored(folder, "stored", 3 * len(mesh.nodes))
        except Missing:
            raise
        except Error as error:
            cure = "use --stiffness own" if assembles(mesh) else "use elements C3D20R, which petsam assembles by itself"
            raise Error(f"{error}: {cure}") from error


def rigid_motions(nodes):
    """Displacements (3 n, 6) of three translations and three rotations about the middle, by the extent; of a section,
    in y = 0, (3 n, 4): it rotates about y only, as displacements do not vary along y."""
    x = nodes - nodes.mean(axis=0)
    x = x / np.abs(x).max()
    motions = np.zeros((len(nodes), 3, 6))
    for i in range(3):
        motions[:, i, i] = 1.0
        motions[:, :, 3 + i] = np.cross(np.eye(3)[i], x)
    motions = motions.reshape(-1, 6)
    return motions if np.any(x[:, 1]) else motions[:, [0, 1, 2, 4]]


def rigid_force(matrix, nodes):
    """Largest force by a rigid motion relative to the largest diagonal term: 0 to rounding."""
    return float(np.max(np.abs(matrix @ rigid_motions(nodes))) / np.max(matrix.diagonal()))


def stiffness(mesh, method=None, ccx=CCX):
    """K, checked: rigid motions give no forces; method own or calculix (own, for elements that are assembled here)."""
    method = method or ("own" if assembles(mesh) else "calculix")
    matrix = of_calculix(mesh, ccx) if method == "calculix" else assembled(mesh)
    force = rigid_force(matrix, mesh.nodes)
    if not force <= RIGID:
        raise Error(
            f"the stiffness resists rigid motions, {force:.1e} of its largest term, limit {RIGID:g}: "
            "remove springs, constraints and supports from the mesh"
        )
    return matrix
