"""Meshes of sections as decks, and displacements by a plane strain solution of the tests' own, dense and without petsam's
code."""

import numpy as np

MIDDLES = [(0, 1), (1, 2), (2, 3), (3, 0)]


def grid(x, z, kind="CPE8"):
    """Nodes (n, 2) and elements (m, k) of the cells between lines at x and z, z downwards, counterclockwise in x, -z.

    x, z: lines; or functions of both, by `mapped`."""
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


def deck(path, nodes, elements, kind, sets, surfaces, young=1.0, poisson=0.3, lines=(), section="", plane="xy"):
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
        "*SOLID SECTION, ELSET=ALL, MATERIAL=M",
        section,
    ]
    path.write_text("\n".join([line for line in text if line] + list(lines)) + "\n")
    return path
