#!/usr/bin/env python3
"""Full contact of the dovetail in CalculiX, to compare with: both bodies at y >= 0, C3D8I, penalty contact, 20 steps.

    full.py out --size 0.1

The blade's flank is crowned: its nodes are moved by the gap, less and less with depth. --size is the size of the
elements along the flank at the contact (mm), half as large again along Y; --far the size of the largest ones. Writes
OUT.inp and the gap between the nodes, which the elements cut into facets, to OUT_gap.h5, runs CalculiX, and writes the
loads of all steps and pressure and shear of the nodes of the disc's flank to
OUT.npz: forces that balance the stresses in the elements beside it, over each node's area, as in
examples/fe-comparison.
"""

import argparse
import sys
from pathlib import Path

import h5py
import numpy as np
from mesh import BELOW, BEYOND, THICKNESS, TITANIUM, Body, graded, nearest, strip

from petsam.apps.compliance.stiffness import numbers

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "fe-comparison"))
from surface import nodal_forces  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
from decks import run_calculix  # noqa: E402

RADII = (40.0, 120.0)
CELLS, PATCH = (64, 112), (1.6, 2.8)  # of petsam, for the gap with facets
CAP = 0.025  # mm: the crown ends where it is so deep, far from contact
REACH = (0.75, 1.4)  # of the fine mesh, beyond the contact, along the flank and along Y
DEEP = 0.3  # of the fine mesh
SLOPE = 0.35  # growth of the elements by the distance
SUPPORT = 0.12  # mm, of the elements at the edges of supports
PENALTY = 30.0  # contact stiffness by E over the size of an element
FRICTION = 0.4
# CalculiX's own tolerance lets a frictional step end while the forces far from the contact are still off
CONTROLS = (
    "*CONTROLS, PARAMETERS=FIELD",
    "2.e-4, 1.e-3, , , 2.e-4, , , ",
    "*CONTROLS, PARAMETERS=TIME INCREMENTATION",
    "4, 8, 9, 100",
)


def edges(body, size, far):
    """Edges of the mesh, fine at the contact."""
    ends = body.breaks[[0, -1]]

    def along(x):
        found = np.minimum(far, size + SLOPE * np.maximum(0.0, np.abs(x) - REACH[0]))
        found = np.minimum(found, SUPPORT + SLOPE * nearest(x, *ends))
        return np.minimum(found, np.where(np.abs(x - 2.4) < 0.4, 0.27, far))

    def across(x):
        return np.minimum(min(far, 0.5), 1.5 * size + SLOPE * np.maximum(0.0, x - REACH[1]))

    def deep(x):
        return np.minimum(far, size + SLOPE * np.maximum(0.0, x - DEEP))

    reach = np.array([-REACH[0], REACH[0]])
    return (
        graded(np.union1d(body.breaks, reach), along),
        graded([0.0, REACH[1], 0.5 * THICKNESS], across),
        graded([0.0, DEEP, BELOW, BELOW + BEYOND], deep),
    )


def crowned(body, mesh, plain):
    """Move the nodes of the blade by the gap."""
    s, y, t = plain.T
    gap = np.minimum(s**2 / (2.0 * RADII[0]) + y**2 / (2.0 * RADII[1]), CAP)
    depth = gap * np.clip(1.0 - t / BELOW, 0.0, 1.0) * np.clip((2.0 * BELOW - np.abs(s)) / BELOW, 0.0, 1.0)
    mesh.nodes[:, [0, 2]] += depth[:, None] * body.normal


def write_facets(path, body, size, far):
    """The gap as the mesh has it, between nodes, on cells of the patch."""
    s, y, _ = edges(body, size, far)
    x, across = (side * ((np.arange(n) + 0.5) / n - 0.5) for n, side in zip(CELLS, PATCH))
    heights = [np.interp(np.abs(v), e, e**2 / (2.0 * r)) for v, e, r in zip((x, across), (s[s > -1e-9], y), RADII)]
    with h5py.File(path, "w") as file:
        file["height"] = 1e-3 * (heights[0] + heights[1][:, None])


class Part:
    """One body in the deck."""

    def __init__(self, name, size, far, first_node, first_element):
        self.name, self.body = name, Body(name)
        self.mesh, self.plain = strip(self.body, edges(self.body, size, far), "C3D8I")
        if not self.body.disc:
            crowned(self.body, self.mesh, self.plain)
        self.elements = self.mesh.blocks[0].nodes
        self.first_node, self.first_element = first_node, first_element
        near = (np.abs(self.plain[:, 0]) < REACH[0] + 1e-6) & (self.plain[:, 1] < REACH[1] + 1e-6)
        faces = [face for face in self.mesh.surfaces["FLANK"] if np.all(near[self.elements[face[0] - 1]])]
        self.faces = np.array(faces)
        touched = [np.any(near[self.elements[face[0] - 1]]) for face in self.mesh.surfaces["FLANK"]]
        self.beside = np.array(self.mesh.surfaces["FLANK"])[touched, 0] - 1
        self.near = near

    def lines(self):
        """Nodes, elements, sets, contact surface."""
        name = self.name.upper()
        out = [f"*NODE, NSET=N{name}"]
        out += ["{}, {:.12g}, {:.12g}, {:.12g}".format(self.first_node + i, *p) for i, p in enumerate(self.mesh.nodes)]
        out.append(f"*ELEMENT, TYPE=C3D8I, ELSET=E{name}")
        out += [
            ", ".join(map(str, (self.first_element + i, *(nodes + self.first_node))))
            for i, nodes in enumerate(self.elements)
        ]
        for title, nodes in self.mesh.node_sets.items():
            out += [f"*NSET, NSET={title}", *numbers(nodes + self.first_node)]
        out.append(f"*SURFACE, NAME=S{name}")
        return out + [f"{self.first_element + element - 1}, S{face + 1}" for element, face in self.faces]


def deck(blade, disc, size, rises):
    """Lines of the deck."""
    out = ["*HEADING", "dovetail: full contact", *blade.lines(), *disc.lines()]
    out += ["*MATERIAL, NAME=TITANIUM", "*ELASTIC", f"{TITANIUM[0]}, {TITANIUM[1]}"]
    out += [f"*SOLID SECTION, ELSET=E{part}, MATERIAL=TITANIUM" for part in ("BLADE", "DISC")]
    stiffness = PENALTY * TITANIUM[0] / size
    out += ["*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness:.12g}"]
    out += ["*FRICTION", f"{FRICTION}, {stiffness:.12g}"]
    out += ["*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "SBLADE, SDISC"]
    out += ["*NSET, NSET=MIDDLE"]
    for part in (blade, disc):
        held = np.unique(np.concatenate([nodes for name, nodes in part.mesh.node_sets.items() if name != "SYMMETRY"]))
        middle = np.setdiff1d(np.flatnonzero(part.plain[:, 1] < 1e-9), held)
        out += numbers(middle + part.first_node)
    grip = blade.mesh.node_sets["GRIP"]
    mirrored = np.setdiff1d(blade.mesh.node_sets["SYMMETRY"], grip) + blade.first_node
    out += ["*NSET, NSET=MIRRORED", *numbers(mirrored)]
    out += ["*BOUNDARY", "HELD, 1, 3", "GRIP, 1, 2", "MIRRORED, 1, 1", "MIDDLE, 2, 2"]
    out += ["*ELSET, ELSET=BESIDE", *numbers(disc.beside + disc.first_element)]
    prints = ["*NODE PRINT, NSET=HELD, TOTALS=ONLY, FREQUENCY=1000", "RF"]
    prints += ["*EL PRINT, ELSET=BESIDE, FREQUENCY=1000", "S"]
    for rise in rises:
        out += ["*STEP, INC=200", "*STATIC, SOLVER=ITERATIVE CHOLESKY", "1., 1.", *CONTROLS]
        out += ["*BOUNDARY", f"GRIP, 3, 3, {rise:.12g}", *prints, "*END STEP"]
    return out


def read_steps(path, first, count, steps):
    """Reactions (steps, 3), N, and stresses (steps, elements, 8, 6), MPa, of elements numbered from `first`; of those
    steps that were finished.
    """
    reaction, stresses = np.zeros((steps, 3)), np.zeros((steps, count, 8, 6))
    kind, step = None, -1
    with open(path, encoding="ascii") as file:
        for line in file:
            words = line.split()
            if not words:
                continue
            if words[0] in ("total", "stresses"):
                kind = words[0]
                step += kind == "total"
            elif kind == "total":
                reaction[step] = [float(word) for word in words]
            else:
                stresses[step, int(words[0]) - first, int(words[1]) - 1] = [float(word) for word in words[2:8]]
    return reaction[: step + 1], stresses[: step + 1]


def fields(disc, stresses):
    """Pressure and shear along x of the contact of the nodes of the disc's flank (steps, nodes), MPa; nodes, areas."""
    elements = disc.elements[disc.beside]
    nodes = np.flatnonzero(disc.near & (disc.plain[:, 2] < 1e-9))
    area = np.zeros(len(disc.mesh.nodes))
    for element in elements:
        top = element[disc.plain[element, 2] < 1e-9]
        area[top] += 0.25 * np.ptp(disc.plain[top, 0]) * np.ptp(disc.plain[top, 1])
    force = np.array([nodal_forces(disc.mesh.nodes, elements, one[disc.beside])[nodes] for one in stresses])
    traction = force / area[nodes, None]
    normal, along = (np.array([axis[0], 0.0, axis[1]]) for axis in (disc.body.normal, -disc.body.along))
    return traction @ normal, traction @ along, nodes, area[nodes]


def main():
    """Run one model."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", help="base of the files' names")
    parser.add_argument("--size", type=float, default=0.1, help="of the elements at the contact, mm (0.1)")
    parser.add_argument("--far", type=float, default=0.8, help="of the largest elements, mm (0.8)")
    parser.add_argument("--history", default=str(Path(__file__).with_name("cycles.csv")), help="(cycles.csv)")
    parser.add_argument("--dry", action="store_true", help="only write the deck")
    options = parser.parse_args()
    # the grip rises along Z: disp_x and disp_z of the contact are its parts along and normal to the flank
    rows = [row for row in Path(options.history).read_text(encoding="utf-8").splitlines() if row[0] != "#"]
    rises = np.genfromtxt(rows, delimiter=",", names=True)["disp_z"] * np.sqrt(2.0) * 1e3
    blade = Part("blade", options.size, options.far, 1, 1)
    disc = Part("disc", options.size, options.far, 1 + len(blade.mesh.nodes), 1 + len(blade.elements))
    base = Path(options.out)
    Path(f"{base}.inp").write_text("\n".join(deck(blade, disc, options.size, rises)) + "\n", encoding="ascii")
    write_facets(f"{base}_gap.h5", blade.body, options.size, options.far)
    count = len(blade.elements) + len(disc.elements)
    print(f"{count} elements", flush=True)
    if options.dry:
        return
    whole, cpu = run_calculix(base)
    if not whole:
        print(f"full.py: CalculiX stopped, see {base}.log; its finished steps are used", file=sys.stderr)
    reaction, stresses = read_steps(f"{base}.dat", disc.first_element, len(disc.elements), len(rises))
    pressure, shear, nodes, area = fields(disc, stresses)
    force = -2.0 * reaction[:, [0, 2]]  # on the disc, of both halves
    load, tangential = force @ disc.body.normal, -force @ disc.body.along
    x, y = -disc.plain[nodes, 0], disc.plain[nodes, 1]
    surface = {"x": x, "y": y, "area": area, "pressure": pressure, "shear_x": shear}
    np.savez(f"{base}.npz", load_n=load, load_tx=tangential, elements=count, cpu=cpu, **surface)
    for n, t in zip(load, tangential):
        print(f"N = {n:.6g}, T = {t:.6g} N")
    print(f"{cpu:.0f} s")


if __name__ == "__main__":
    main()
