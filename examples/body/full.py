#!/usr/bin/env python3
"""Full contact of the example bodies in CalculiX, to compare with: half the body (y >= 0), C3D8I, penalty contact.

    full.py block out --size 0.1           a rigid sphere of 100 mm moves down by 0.01 mm, no friction
    full.py beam out --size 0.1            by 0.04 mm, friction 0.5, then one end of the beam is pulled by 0.006 mm

The sphere is a rigid surface of facets of 0.05 mm. --size is the elements' size at the contact (mm), --far the size of
the largest ones. Writes OUT.inp, runs CalculiX, and writes the loads and the nodes' pressures to OUT.npz: forces that
balance the stresses in the elements beside the surface, over the area of each node, as examples/fe-comparison does.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from petsam.apps.compliance.mesh import grid_mesh
from petsam.apps.compliance.stiffness import numbers

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "fe-comparison"))
from surface import nodal_forces, read_dat  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
from decks import run_calculix  # noqa: E402

YOUNG, POISSON, RADIUS = 210000.0, 0.3, 100.0
FACET, MARGIN = 0.05, 0.2  # of the sphere, and by how much it is larger than the contact's neighbourhood, mm
GROWTH = 1.3  # of neighbouring elements
PENALTY = 30.0  # contact stiffness by E over the size of an element
FRICTION = 0.5
PULL, PULLS = 0.006, 4
BODIES = {
    "block": {"box": ((-1.4, 2.6), (0.0, 2.0), (0.0, 4.0)), "reach": 1.3, "down": 0.01},
    "beam": {"box": ((-6.0, 6.0), (0.0, 2.0), (0.0, 3.0)), "reach": 1.75, "down": 0.04},
}
# CalculiX's own tolerance lets a frictional step end while the forces far from the contact are still off
CONTROLS = (
    "*CONTROLS, PARAMETERS=FIELD",
    "2.e-4, 1.e-3, , , 2.e-4, , , ",
    "*CONTROLS, PARAMETERS=TIME INCREMENTATION",
    "4, 8, 9, 100",
)


def growing(start, end, size, far, last=None):
    """Edges from start to end, of elements that grow from size to far, and shrink to `last` before the end."""
    length, sizes = abs(end - start), []
    last = far if last is None else last
    while sum(sizes) < length - 1e-9:
        shrunk = last + (GROWTH - 1.0) * max(0.0, length - sum(sizes) - last) / GROWTH
        sizes.append(min(far, size * GROWTH ** (len(sizes) + 1), shrunk))
    return start + np.sign(end - start) * np.cumsum(sizes)[: len(sizes)] * length / sum(sizes) if sizes else []


def along(low, high, reach, size, far, last=None):
    """Edges from low to high with elements of `size` from -reach to reach, or between the ends within it; those at the
    ends have the size `last`."""
    left, right = max(low, -reach), min(high, reach)
    near = np.linspace(left, right, max(1, round((right - left) / size)) + 1)
    return np.array([*growing(left, low, size, far, last)[::-1], *near, *growing(right, high, size, far, last)])


def body_mesh(name, size, far, last=None):
    """The mesh, and a mask of the nodes on its surface."""
    of = BODIES[name]
    (x0, x1), (y0, y1), (_, depth) = of["box"]
    deep = 0.4 * of["reach"]
    z = [0.0, *np.linspace(0.0, deep, max(2, round(deep / size)) + 1)[1:]]
    ends = None if last is None else min(2.0 * last, far)  # of the free sides: the supports' edges end there
    z = np.array([*z, *growing(deep, depth, size, far, last if name == "block" else ends)])
    x = along(x0, x1, of["reach"], size, far, last if name == "beam" else ends)
    edges = (x, along(y0, y1, of["reach"], size, far, ends), z)
    sets = {
        "BOTTOM": lambda p: p[:, 2] > depth - 1e-9,
        "LEFT": lambda p: p[:, 0] < x0 + 1e-9,
        "RIGHT": lambda p: p[:, 0] > x1 - 1e-9,
        "MIDDLE": lambda p: p[:, 1] < 1e-9,
    }
    mesh = grid_mesh(edges, "C3D8I", YOUNG, POISSON, sets)
    top = np.abs(mesh.nodes[:, 2]) < 1e-9
    return mesh, top


def sphere(of):
    """Nodes and bricks of a rigid shell whose lower side, towards the body, is the sphere."""
    reach = of["reach"] + MARGIN
    x, y = (np.linspace(low, reach, round((reach - low) / FACET) + 1) for low in (-reach, -MARGIN))
    shell = grid_mesh((x, y, [-1.0, 0.0]), "C3D8")
    shell.nodes[:, 2] -= np.sum(shell.nodes[:, :2] ** 2, axis=1) / (2.0 * RADIUS)
    return shell.nodes, shell.blocks[0].nodes


def deck(name, mesh, top, size, parts):
    """Lines of the deck; and the elements beside the surface."""
    of, count, elements = BODIES[name], len(mesh.nodes), mesh.blocks[0].nodes
    beside = np.flatnonzero(np.any(top[elements], axis=1))
    cap, facets = sphere(of)
    out = ["*HEADING", f"{name}: full contact", "*NODE, NSET=NBODY"]
    out += ["{}, {:.12g}, {:.12g}, {:.12g}".format(i, *p) for i, p in enumerate(mesh.nodes, 1)]
    out.append("*NODE, NSET=NSPHERE")
    out += ["{}, {:.12g}, {:.12g}, {:.12g}".format(count + i, *p) for i, p in enumerate(cap, 1)]
    out.append("*ELEMENT, TYPE=C3D8I, ELSET=EBODY")
    out += [", ".join(map(str, (i, *(nodes + 1)))) for i, nodes in enumerate(elements, 1)]
    out.append("*ELEMENT, TYPE=C3D8, ELSET=ESPHERE")
    first = len(elements) + 1
    out += [", ".join(map(str, (first + i, *(count + 1 + nodes)))) for i, nodes in enumerate(facets)]
    out += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{YOUNG}, {POISSON}"]
    out += [f"*SOLID SECTION, ELSET=E{part}, MATERIAL=STEEL" for part in ("BODY", "SPHERE")]
    for title, nodes in mesh.node_sets.items():
        out += [f"*NSET, NSET={title}", *numbers(nodes + 1)]
    near = np.max(np.abs(mesh.nodes[:, :2]), axis=1) < of["reach"] + 1e-6
    chosen = [(e, f) for e, f in mesh.surfaces["TOP"] if np.all(near[elements[e - 1]])]
    out += ["*SURFACE, NAME=SBODY", *(f"{element}, S{face + 1}" for element, face in chosen)]
    out += ["*SURFACE, NAME=SSPHERE", "ESPHERE, S2"]
    stiffness = PENALTY * YOUNG / size
    out += ["*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness:.12g}"]
    if name == "beam":
        out += ["*FRICTION", f"{FRICTION}, {stiffness:.12g}"]
    out += ["*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "SBODY, SSPHERE"]
    out += ["*NSET, NSET=PRINTED", *numbers(np.unique(elements[beside]) + 1)]
    out += ["*ELSET, ELSET=BESIDE", *numbers(beside + 1)]
    held = ["BOTTOM, 1, 3"] if name == "block" else ["LEFT, 1, 3", "RIGHT, 2, 3"]
    out += ["*BOUNDARY", *held, "NSPHERE, 1, 2"]
    middle = np.setdiff1d(mesh.node_sets["MIDDLE"], held_nodes(name, mesh))
    out += ["*NSET, NSET=SYMMETRY", *numbers(middle + 1), "*BOUNDARY", "SYMMETRY, 2, 2"]
    return out + steps(name, of, parts), beside


def held_nodes(name, mesh):
    """Nodes with prescribed displacements in y."""
    sets = ("BOTTOM",) if name == "block" else ("LEFT", "RIGHT")
    return np.concatenate([mesh.node_sets[title] for title in sets])


def steps(name, of, parts):
    """The load history, with so many load steps a row."""
    prints = [
        "*NODE PRINT, NSET=NSPHERE, TOTALS=ONLY",
        "RF",
        "*NODE PRINT, NSET=PRINTED",
        "U",
        "*EL PRINT, ELSET=BESIDE",
        "S",
    ]
    time = f"{1 / parts:g}, 1., , {1 / parts:g}"
    start = ["*STEP, INC=200", "*STATIC, SOLVER=ITERATIVE CHOLESKY", time, *CONTROLS, "*BOUNDARY"]
    out = [
        *start,
        f"NSPHERE, 3, 3, {of['down']}",
        *(["RIGHT, 1, 1, 0."] if name == "beam" else []),
        *prints,
        "*END STEP",
    ]
    for k in range(PULLS if name == "beam" else 0):
        out += [*start, f"RIGHT, 1, 1, {PULL * (k + 1) / PULLS:.12g}", *prints, "*END STEP"]
    return out


def areas(mesh, top, faces):
    """Area (nodes) that belongs to each surface node, mm2, seen along z."""
    found = np.zeros(len(mesh.nodes))
    elements = mesh.blocks[0].nodes
    for number, _ in faces:
        nodes = elements[number - 1][top[elements[number - 1]]]
        size = np.ptp(mesh.nodes[nodes, :2], axis=0)
        found[nodes] += 0.25 * size[0] * size[1]
    return found


def main():
    """Run one model."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("body", choices=tuple(BODIES))
    parser.add_argument("out", help="base of the files' names")
    parser.add_argument("--size", type=float, default=0.1, help="of the elements at the contact, mm (0.1)")
    parser.add_argument("--far", type=float, default=0.5, help="of the largest elements, mm (0.5)")
    parser.add_argument("--last", type=float, help="of the elements at the supports, mm (--far)")
    parser.add_argument("--steps", type=int, default=2, help="load steps of each row of the history (2)")
    options = parser.parse_args()
    mesh, top = body_mesh(options.body, options.size, options.far, options.last)
    lines, beside = deck(options.body, mesh, top, options.size, options.steps)
    base = Path(options.out)
    Path(f"{base}.inp").write_text("\n".join(lines) + "\n", encoding="ascii")
    whole, cpu = run_calculix(base)
    if not whole:
        sys.exit(f"full.py: CalculiX failed, see {base}.log")
    moved, stresses = np.zeros((len(mesh.nodes), 3)), np.zeros((len(mesh.blocks[0].nodes), 8, 6))
    reaction = read_dat(f"{base}.dat", moved, stresses)
    elements = mesh.blocks[0].nodes[beside]
    force = nodal_forces(mesh.nodes, elements, stresses[beside])
    area = areas(mesh, top, mesh.surfaces["TOP"])
    near = np.max(np.abs(mesh.nodes[:, :2]), axis=1) < BODIES[options.body]["reach"] + 1e-6
    nodes = np.flatnonzero(top & near)  # others may be held
    values = force[nodes] / area[nodes, None]
    load, shear = 2.0 * reaction[2], 2.0 * reaction[0]
    x, y = mesh.nodes[nodes, :2].T
    surface = {"x": x, "y": y, "area": area[nodes], "pressure": values[:, 2], "shear_x": values[:, 0]}
    count = len(mesh.blocks[0].nodes)
    np.savez(f"{base}.npz", load_n=load, load_tx=shear, elements=count, cpu=cpu, **surface)
    print(f"{count} elements, N = {load:.6g}, T = {shear:.6g} N, {cpu:.0f} s")


if __name__ == "__main__":
    sys.exit(main())
