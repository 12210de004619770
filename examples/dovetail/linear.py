#!/usr/bin/env python3
"""How stiff meshes and compliance files make the bodies, without contact: mean displacements under a given traction.

    linear.py blade blade.h5 blade_coarse.h5

A smooth pressure, and the same along the flank, act on the patch. Printed are the displacement's means weighted by it,
in nm/N: normal by normal, along by along, along by normal; of the files' compliances with the half-space's, of
quadratic elements graded towards the patch, and of the meshes of full contact.
"""

import argparse
import sys

import full
import h5py
import numpy as np
from mesh import BELOW, BEYOND, THICKNESS, Body, graded, nearest, strip

from petsam.apps.compliance.basis import Patch
from petsam.apps.compliance.halfspace import cell_compliance
from petsam.apps.compliance.solve import Solver
from petsam.apps.compliance.stiffness import stiffness

HALF = (0.8, 1.4)  # mm, of the loaded rectangle
CELLS = 40  # of it, each way, for the half-space
POINTS = 6  # Gauss points along the side of a face


def pressure(x, y):
    """MPa; 1 N on the rectangle."""
    parts = [np.maximum(0.0, 1.0 - (v / half) ** 2) * 0.75 / half for v, half in zip((x, y), HALF)]
    return parts[0] * parts[1]


def of_file(path):
    """Means of a compliance file, (2, 2), normal and along."""
    with h5py.File(path) as file:
        half, degree = tuple(file["patch/half"][:]), int(file.attrs["degree"])
        kernel = cell_compliance(half, (CELLS, CELLS), file.attrs["young"], file.attrs["poisson"])
        compliance = file["compliance"][:]
    x, y = np.meshgrid(*[((np.arange(CELLS) + 0.5) / CELLS * 2.0 - 1.0) * side for side in half])
    area = 4.0 * half[0] * half[1] / CELLS**2
    traction = pressure(1e3 * x, 1e3 * y).ravel()
    traction /= area * traction.sum()
    coefficients = area * traction @ Patch((0.0, 0.0), half, degree).cell_means((CELLS, CELLS))
    local = np.einsum("i,iajb,j->ab", traction, kernel.reshape(CELLS**2, 3, CELLS**2, 3), traction) * area
    beyond = np.einsum("i,iajb,j->ab", coefficients, compliance, coefficients)
    return 1e9 * (local + beyond)[np.ix_([2, 0], [2, 0])]


def quadratic(body, unit):
    """Edges of a mesh graded towards the patch and the corners."""
    ends = body.breaks[[0, -1]]

    def along(x):
        beyond = np.maximum(0.0, np.where(x > 0.0, x - body.breaks[-2], -2.0 - x))
        return unit * np.minimum(np.where(np.abs(x) < 1.2, 0.2, 0.25) + 0.4 * beyond, 0.25 + 0.5 * nearest(x, ends[1]))

    return (
        graded(np.union1d(body.breaks, [-HALF[0], HALF[0]]), along),
        graded([0.0, HALF[1], 0.5 * THICKNESS], lambda x: unit * np.where(x < 1.6, 0.3, 0.45)),
        graded([0.0, BELOW, BELOW + BEYOND], lambda x: unit * (0.15 + 0.35 * x)),
    )


def of_mesh(body, edges, kind):
    """Means of half of the body, y >= 0, and the number of unknowns."""
    mesh, plain = strip(body, edges, kind)
    held = np.zeros(len(mesh.nodes), dtype=bool)
    held[mesh.node_sets["HELD" if body.disc else "GRIP"]] = True
    planes = [(np.flatnonzero(plain[:, 1] < 1e-9), np.array([0.0, 1.0, 0.0]))]
    if not body.disc:
        planes.append((mesh.node_sets["SYMMETRY"], np.array([1.0, 0.0, 0.0])))
    matrix = stiffness(mesh, "calculix" if kind == "C3D8I" else "own")
    solver = Solver(matrix, mesh.nodes, np.repeat(held, 3), planes)
    normal = np.array([body.normal[0], 0.0, body.normal[1]])
    along = np.array([-1.0, 0.0, 1.0]) * np.sqrt(0.5)
    force = np.zeros((len(mesh.nodes), 3, 2))
    for group in mesh.surface_faces("FLANK"):
        gauss = mesh.gauss(group, POINTS)
        place = gauss.x - np.array([5.0, 0.0, 0.0])
        nodal = np.linalg.norm(gauss.area, axis=-1) * pressure(place @ along, gauss.x[..., 1])
        nodal = np.einsum("qk,nq->nk", gauss.values, nodal)
        np.add.at(force, group.nodes, nodal[..., None, None] * np.stack([normal, along], axis=1))
    force = force.reshape(-1, 2)
    u = solver(force, np.zeros((3 * int(held.sum()), 2)))
    load = 2.0 * np.array([force[:, 0].reshape(-1, 3).sum(0) @ normal, force[:, 1].reshape(-1, 3).sum(0) @ along])
    return 1e6 * 2.0 * (force.T @ u) / np.outer(load, load), solver.moves.shape[1]


def main():
    """Print the table of a body."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("body", choices=("blade", "disc"))
    parser.add_argument("files", nargs="*", help="compliance files of it")
    options = parser.parse_args()
    body = Body(options.body)

    def show(name, means):
        print(f"{name:40} {means[0, 0]:8.4f} {means[1, 1]:8.4f} {means[1, 0]:8.4f}", flush=True)

    for path in options.files:
        show(path, of_file(path))
    for unit in (2.0, 1.4, 1.0):
        means, unknowns = of_mesh(body, quadratic(body, unit), "C3D20R")
        show(f"C3D20R, {unknowns} unknowns", means)
    for size in (0.2, 0.17, 0.14):
        means, unknowns = of_mesh(body, full.edges(body, size, 0.8), "C3D8I")
        show(f"C3D8I, full contact, {size:g} mm", means)


if __name__ == "__main__":
    sys.exit(main())
