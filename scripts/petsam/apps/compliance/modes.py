"""Modes of a pair without contact: K phi = omega^2 M phi with the consistent mass, phi'M phi = 1, supports held; of a
pair that nothing holds the elastic ones."""

from dataclasses import dataclass
from typing import Optional

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh

from ...core.brief import brief
from ...core.errors import Error
from .cases import Case, Jump, rest
from .solve import Floating
from .stiffness import rule

UNIT = "m/(m kg^0.5)"  # of a mode at factor 1, the factor being in m kg^0.5
EQUAL = 1e-6  # relative difference of components that count as equally large
POINTS = 2  # Gauss points on the patch by degree, and as many more
MORE = 8
ZERO = 1e-2  # highest frequency of a rigid motion, relative to the first elastic one


@brief
@dataclass
class Modes:
    """omega (n), rad/s; the modes (3 nodes, n), kg^-1/2, those at the sensors (n, sensors, 3) in the deck's directions,
    the maximum error of phi'M phi, and omega of the rigid motions, which are left out, where nothing is held."""

    omega: np.ndarray
    shapes: np.ndarray
    sensors: np.ndarray
    mass_error: float
    rigid: Optional[np.ndarray] = None


def mass(mesh):
    """M in compressed rows."""
    size = len(mesh.nodes)
    parts = []
    for index, block in enumerate(mesh.blocks):
        local, weight = rule(block)
        _, volume, values, _ = mesh.volume(index, local, weight)
        element = np.einsum("qk,ql,nq,n->nkl", values, values, volume, block.density, optimize=True)
        row = np.repeat(block.nodes, block.nodes.shape[1], axis=1).ravel()
        column = np.tile(block.nodes, (1, block.nodes.shape[1])).ravel()
        parts.append(sparse.coo_matrix((element.ravel(), (row, column)), shape=(size, size)).tocsr())
    return sparse.kron(sum(parts[1:], parts[0]), sparse.eye(3)).tocsr()


def found(model, solver, count, sensors):
    """The Modes with the lowest frequencies; sensors: indices of nodes."""
    matrix, pick = mass(model.mesh), _in_plane(model.mesh, solver)
    moves = solver.moves @ pick
    free = (moves.T @ matrix @ moves).tocsr()
    stiffness = (moves.T @ solver.matrix @ moves).tocsr()
    size = free.shape[0]
    if count >= size - 1:
        raise Error(f"--modes {count}: the mesh has {size} free unknowns: use a finer mesh, or fewer modes")
    inverse = LinearOperator(free.shape, matvec=lambda force: pick.T @ solver.inverse(pick @ force), dtype=float)
    start = np.cos(np.arange(size))  # the same in each run
    try:
        squares, shapes = eigsh(stiffness, count, free, sigma=0.0, OPinv=inverse, v0=start)
    except ArpackError as error:
        raise Error(f"the modes were not found ({error}): use fewer --modes") from error
    order = np.argsort(squares)
    shapes = moves @ shapes[:, order]
    shapes *= _signs(shapes)
    deviation = shapes.T @ matrix @ shapes - np.eye(count)
    at = shapes.reshape(-1, 3, count)[sensors]
    turned = np.einsum("sik,ij->ksj", at, model.frame.axes)
    rigid = _without_rigid(solver, np.sqrt(squares[order][0])) if isinstance(solver, Floating) else None
    return Modes(np.sqrt(squares[order]), shapes, turned, float(np.max(np.abs(deviation))), rigid)


def _in_plane(mesh, solver):
    """The columns of the free unknowns that take part: all, of a section those that move it in its plane, from which
    shear along its normal is separate."""
    every = sparse.identity(solver.moves.shape[1], format="csc")
    if mesh.normal is None:
        return every
    return every[:, abs(solver.moves[1::3]).sum(axis=0).A1 == 0.0]


def _without_rigid(solver, first):
    """Angular frequencies of the rigid motions, after a check that they are far below the first elastic one."""
    rigid = solver.rigid_frequencies()
    if not rigid.max() <= ZERO * first:
        raise Error(
            f"a rigid motion of the pair has {rigid.max() / (2.0 * np.pi):.3g} Hz, limit {ZERO:g} of the first elastic "
            f"mode, {first / (2.0 * np.pi):.6g} Hz: remove what holds it from the deck, or use --fixed"
        )
    return rigid


def _signs(shapes):
    """Signs that make the largest component of each mode positive: the first of those that are equally large."""
    size = np.abs(shapes)
    first = np.argmax(size >= (1.0 - EQUAL) * size.max(axis=0), axis=0)
    return np.sign(shapes[first, np.arange(shapes.shape[1])])


def cases(model, modes, patch):
    """The Cases of the modes on a patch, by name: the projection on the polynomials of body 2's displacement minus body
    1's."""
    jump = Jump(model.parts, patch, [POINTS * (degree + MORE) for degree in patch.largest])
    weighted = patch.values(*jump.points.T).T * jump.weights
    named = {}
    for k, shape in enumerate(modes.shapes.T, 1):
        sampled = jump(shape)
        coefficients = weighted @ sampled
        named[f"mode{k}"] = Case(coefficients, rest(f"mode {k}", jump, sampled, coefficients), shape[:, None], UNIT)
    return named
