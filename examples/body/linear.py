#!/usr/bin/env python3
"""How stiff a mesh makes the clamped beam, without contact: the mean displacement under a given pressure.

A smooth pressure on the patch presses half of the beam (y >= 0). Printed is the displacement's mean weighted by the
pressure, in nm per N on the whole beam, for the meshes of full contact (full.py) and of the compliance (mesh.py).
"""

import sys
import time

import numpy as np
from full import body_mesh
from mesh import STEEL, beam

from petsam.apps.compliance.mesh import grid_mesh
from petsam.apps.compliance.solve import Solver
from petsam.apps.compliance.stiffness import stiffness

HALF = 1.5  # mm, of the loaded square
POINTS = 6  # Gauss points along the side of a face


def pressure(x, y):
    """MPa; 1 N on the square."""
    shape = np.maximum(0.0, 1.0 - (x / HALF) ** 2) * np.maximum(0.0, 1.0 - (y / HALF) ** 2)
    return shape * (0.75 / HALF) ** 2


def sets(p):
    """Masks of the nodes that are clamped, and that lie in the plane of symmetry."""
    return np.abs(np.abs(p[:, 0]) - 6.0) < 1e-9, p[:, 1] < 1e-9


def displacement(mesh, kind):
    """Mean displacement, nm/N, and the number of unknowns."""
    held, middle = sets(mesh.nodes)
    matrix = stiffness(mesh, "calculix" if kind == "C3D8I" else "own")
    fixed = np.repeat(held, 3)
    solver = Solver(matrix, mesh.nodes, fixed, [(np.flatnonzero(middle), np.array([0.0, 1.0, 0.0]))])
    force = np.zeros((3 * len(mesh.nodes), 1))
    for group in mesh.surface_faces("TOP"):
        gauss = mesh.gauss(group, POINTS)
        nodal = np.einsum("qk,nq->nk", gauss.values, -gauss.area[..., 2] * pressure(gauss.x[..., 0], gauss.x[..., 1]))
        np.add.at(force[:, 0], 3 * group.nodes + 2, nodal)
    u = solver(force, np.zeros((int(fixed.sum()), 1)))
    return 2.0 * float(force[:, 0] @ u[:, 0]) / (2.0 * force.sum()) ** 2 * 1e6, solver.moves.shape[1]


def quadratic(divisions, coarse=False):
    """Half of the mesh of the compliance, each element divided."""
    edges, _ = beam(coarse)
    edges = [np.array(e) for e in edges]
    edges[1] = edges[1][edges[1] > -1e-12]
    cut = [np.interp(np.arange(divisions * (len(e) - 1) + 1) / divisions, np.arange(len(e)), e) for e in edges]
    return grid_mesh(cut, "C3D20R", *STEEL)


def main():
    """Print the table."""
    full = [(0.2, 0.5, None), (0.2, 0.5, 0.05), (0.1, 0.5, None), (0.1, 0.4, 0.04)]
    cases = [(f"C3D20R, compliance, 1/{n}", quadratic(n), "C3D20R") for n in (1, 2)]
    cases.insert(0, ("C3D20R, compliance, coarse", quadratic(1, True), "C3D20R"))
    cases += [("C3D8I, {}, {}, {}".format(*sizes), body_mesh("beam", *sizes)[0], "C3D8I") for sizes in full]
    for name, mesh, kind in cases:
        start = time.process_time()
        found, unknowns = displacement(mesh, kind)
        print(f"{name:32} {unknowns:8d} unknowns {found:9.4f} nm/N  {time.process_time() - start:.0f} s", flush=True)


if __name__ == "__main__":
    sys.exit(main())
