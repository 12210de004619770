"""Meshes of sections as decks, and displacements by plane strain elements of the tests' own."""

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve

MIDDLES = [(0, 1), (1, 2), (2, 3), (3, 0)]


def grid(x, z, kind="CPE8"):
    """Nodes (n, 2) and elements (m, k) of cells between lines at x and z, z downwards, counterclockwise in x, -z."""
    quadratic, triangles = kind in ("CPE8", "CPE8R", "CPE6"), kind in ("CPE3", "CPE6")
    nx, nz = len(x) - 1, len(z) - 1
    numbers, nodes = {}, []

    def node(i, j):
        if (i, j) not in numbers:
            numbers[i, j] = len(nodes)
            at = [0.5 * (line[k // 2] + line[(k + 1) // 2]) for line, k in ((x, i), (z, j))]
            nodes.append(at)
        return numbers[i, j]

    elements = []
    for i in range(0, 2 * nx, 2):
        for j in range(0, 2 * nz, 2):
            ring = [(i, j + 2), (i + 2, j + 2), (i + 2, j), (i, j)]  # counterclockwise with z downwards
            for corners in [ring[:3], [ring[0], ring[2], ring[3]]] if triangles else [ring]:
                after = corners[1:] + corners[:1]
                middles = [((a[0] + b[0]) // 2, (a[1] + b[1]) // 2) for a, b in zip(corners, after)]
                elements.append([node(*at) for at in corners + (middles if quadratic else [])])
    return np.array(nodes), np.array(elements)


def faces_of(nodes, elements, corners, mask):
    """(element from 1, side from 1) of the sides both of whose ends a mask of the nodes has."""
    return [(e + 1, k + 1) for e, one in enumerate(elements) for k in range(corners)
            if mask[one[k]] and mask[one[(k + 1) % corners]]]  # fmt: skip


def deck(
    path, nodes, elements, kind, sets, surfaces, young=1.0, poisson=0.3, density=None, lines=(), section="", plane="xy"
):  # fmt: skip
    """Writes a deck; sets: {name: mask of the nodes}; surfaces: {name: mask}; nodes in x and z, z downwards."""
    corners = 3 if kind in ("CPE3", "CPE6") else 4
    text = ["*NODE"]
    for k, (x, z) in enumerate(nodes, 1):
        at = (x, -z, 0.0) if plane == "xy" else (x, 0.0, -z)
        text.append("{}, {:.15e}, {:.15e}, {:.15e}".format(k, *at))
    text.append(f"*ELEMENT, TYPE={kind}, ELSET=ALL")
    text += [", ".join(map(str, [e, *(one + 1)])) for e, one in enumerate(elements, 1)]
    for name, mask in sets.items():
        text.append(f"*NSET, NSET={name}")
        text += [f"{k + 1}" for k in np.flatnonzero(mask)]
    for name, mask in surfaces.items():
        text.append(f"*SURFACE, NAME={name}")
        text += [f"{e}, S{k}" for e, k in faces_of(nodes, elements, corners, mask)]
    text += [
        "*MATERIAL, NAME=M",
        "*ELASTIC",
        f"{young!r}, {poisson!r}",
        *([] if density is None else ["*DENSITY", f"{density!r}"]),
        "*SOLID SECTION, ELSET=ALL, MATERIAL=M",
        section,
    ]
    path.write_text("\n".join([line for line in text if line] + list(lines)) + "\n")
    return path


def shapes(a, b):
    """Functions (8) of the serendipity square and their derivatives (8, 2) at a point."""
    corner = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    n, d = np.zeros(8), np.zeros((8, 2))
    for k, (p, q) in enumerate(corner):
        n[k] = 0.25 * (1 + p * a) * (1 + q * b) * (p * a + q * b - 1)
        d[k] = 0.25 * p * (1 + q * b) * (2 * p * a + q * b), 0.25 * q * (1 + p * a) * (p * a + 2 * q * b)
    for k, q in ((4, -1), (6, 1)):
        n[k], d[k] = 0.5 * (1 - a * a) * (1 + q * b), (-a * (1 + q * b), 0.5 * q * (1 - a * a))
    for k, p in ((5, 1), (7, -1)):
        n[k], d[k] = 0.5 * (1 + p * a) * (1 - b * b), (0.5 * p * (1 - b * b), -b * (1 + p * a))
    return n, d


def stiffness(nodes, elements, young, poisson):
    """K (2 n, 2 n) of CPE8 in x and z, with 3 x 3 points."""
    at, weight = np.polynomial.legendre.leggauss(3)
    lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    shear = young / (2 * (1 + poisson))
    hooke = np.array([[lame + 2 * shear, lame, 0], [lame, lame + 2 * shear, 0], [0, 0, shear]])
    rows, columns, values = [], [], []
    for one in elements:
        own = np.zeros((16, 16))
        for a, wa in zip(at, weight):
            for b, wb in zip(at, weight):
                local = shapes(a, b)[1]
                jacobian = nodes[one].T @ local
                g = local @ np.linalg.inv(jacobian)
                strain = np.zeros((3, 16))
                strain[0, 0::2], strain[1, 1::2], strain[2, 0::2], strain[2, 1::2] = g[:, 0], g[:, 1], g[:, 1], g[:, 0]
                own += strain.T @ hooke @ strain * abs(np.linalg.det(jacobian)) * wa * wb
        places = np.stack([2 * one, 2 * one + 1], axis=1).ravel()
        rows.append(np.repeat(places, 16))
        columns.append(np.tile(places, 16))
        values.append(own.ravel())
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    return sparse.coo_matrix(entries, shape=(2 * len(nodes),) * 2).tocsr()


def forces(nodes, elements, traction, points=8):
    """Nodal forces (2 n) by a traction, a function of x (q) that gives (q, 2), on the sides at z = 0."""
    at, weight = np.polynomial.legendre.leggauss(points)
    found = np.zeros((len(nodes), 2))
    for one in elements:
        for k in range(4):
            a, b, middle = one[k], one[(k + 1) % 4], one[4 + k]
            if nodes[a, 1] == nodes[b, 1] == 0.0:
                x = 0.5 * (nodes[a, 0] + nodes[b, 0]) + 0.5 * (nodes[b, 0] - nodes[a, 0]) * at
                t = traction(x) * (0.5 * abs(nodes[b, 0] - nodes[a, 0]) * weight)[:, None]
                found[a] += (0.5 * at * (at - 1)) @ t
                found[b] += (0.5 * at * (at + 1)) @ t
                found[middle] += (1 - at * at) @ t
    return found.ravel()


def displacements(nodes, elements, held, force, young=1.0, poisson=0.3):
    """Displacements (n, 2), or (n, 2, columns), with nodes, or directions (n, 2), held by a mask."""
    matrix = stiffness(nodes, elements, young, poisson)
    free = np.flatnonzero(~(held.ravel() if held.ndim == 2 else np.repeat(held, 2)))
    found = np.zeros(force.shape)
    found[free] = spsolve(matrix[free][:, free].tocsc(), force[free])
    return found.reshape(len(nodes), 2, *force.shape[1:])


def stresses(nodes, elements, u, young=1.0, poisson=0.3):
    """Depth of the lower two of the 2 x 2 Gauss points of a row of elements, and the means of xx, zz, xz there."""
    lame, shear = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))
    found, place = np.zeros((3, len(elements))), 1.0 / np.sqrt(3.0)
    for k, one in enumerate(elements):
        for a in (-place, place):
            n, local = shapes(a, -place)  # elements begin at their lower corner
            g = u[one].T @ local @ np.linalg.inv(nodes[one].T @ local)
            spread = lame * np.trace(g)
            found[:, k] += [0.5 * spread + shear * g[0, 0], 0.5 * spread + shear * g[1, 1],
                            0.5 * shear * (g[0, 1] + g[1, 0])]  # fmt: skip
    return float((n @ nodes[elements[0]])[1]), found
