#!/usr/bin/env python3
"""The dovetail in plane strain: petsam by compliances of both sections beside full contact in CalculiX.

    section.py build/dovetail-section --sizes 0.1 0.05

Both bodies are sections of mesh.py's, of elements CPE8, whose sides have the crown's parabola exactly. The grip rises
20 um, falls to 6 um and rises again. For each size of the elements along the contact (mm) CalculiX solves it with
surface-to-surface contact; the compliances have a mesh of their own. --parts: of rise and crown; a part of both leaves
contact and stick as they are, but the flank turns by that part only, which CalculiX follows and petsam does not.

Printed are petsam's differences: maxima of those of N and T by the maxima of these; energy of the cycle; L2 of the slip
from the top of the cycle to its bottom, and of pressure and shear there. Forces of nodes are those that balance the
stresses in the elements of the disc, and petsam's tractions are averaged with the functions of the same nodes.
"""

import argparse
import itertools
import sys
import warnings
from pathlib import Path

import full
import numpy as np
from mesh import BELOW, FLANK, TITANIUM, Body

import petsam
from petsam.apps.compliance.mesh import Block, Mesh
from petsam.apps.compliance.section import oriented
from petsam.apps.compliance.stiffness import assembled, numbers
from petsam.core.line import fail

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402
from decks import run_calculix  # noqa: E402

RADIUS = full.RADII[0]
WIDTH = 1.7  # mm, of the patch
CELLS = 400
DEGREE = 12
FRAMES = {"blade": ((5.0, 0.0, 0.0), (-1.0, 1.0, 0.0), (-1.0, -1.0, 0.0)),
          "disc": ((5.0, 0.0, 0.0), (-1.0, 1.0, 0.0), (1.0, 1.0, 0.0))}  # fmt: skip
HELD = {"blade": dict(supports="GRIP", symmetry="SYMMETRY"), "disc": dict(supports="HELD")}
RISES = 1e-3 * np.concatenate([np.arange(4, 21, 4), np.arange(18, 5, -2), np.arange(8, 21, 2)])  # mm
TOP, BOTTOM, CYCLE = 4, 11, slice(4, 19)  # ends and rows of the cycle
FAR = 0.6  # mm, of the largest elements of full contact
FINE = (0.05, 0.3)  # mm, of those at the contact and of the largest, of the compliances


class Section:
    """A body's section: nodes (n, 2) in X and Z of mesh.py, elements CPE8, sets of nodes, sides of the flank."""

    def __init__(self, name, size, far):
        self.name, self.body = name, Body(name)
        lines = [self._halved(line) for line in full.edges(self.body, size, far)[::2]]
        self._number(*lines)
        self.nodes = self.body.place(np.stack([self.s, 0.0 * self.s, self.t], axis=1))[:, [0, 2]]
        high, deepest = (line[-1] - 1e-9 for line in lines)
        if self.body.disc:
            self.sets = {"HELD": (self.t > deepest) | (self.s > high)}
        else:
            self.sets = {"SYMMETRY": self.t > deepest, "GRIP": self.s > high}
        middle = self.s[self.elements[:, 4]]
        self.sides = np.flatnonzero((self.t[self.elements[:, 4]] == 0.0) & (np.abs(middle) < FLANK))

    @staticmethod
    def _halved(line):
        return np.sort(np.concatenate([line, 0.5 * (line[1:] + line[:-1])]))

    def _number(self, s, t):
        """Nodes of the lines, and elements whose side 1 is the one towards the flank."""
        place = -np.ones((len(s), len(t)), dtype=int)
        used = (np.arange(len(s))[:, None] % 2 == 0) | (np.arange(len(t)) % 2 == 0)
        place[used] = np.arange(np.count_nonzero(used))
        self.s, self.t = (v[used] for v in np.meshgrid(s, t, indexing="ij"))
        ring = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
        ring = [place[a : a + len(s) - 2 : 2, b : b + len(t) - 2 : 2] for a, b in ring]
        self.elements = np.stack(ring, axis=-1).reshape(-1, 8)

    def crown(self, part):
        """Move the nodes by a part of the gap, less and less with depth."""
        gap = part * np.minimum(self.s**2 / (2.0 * RADIUS), full.CAP)
        fade = np.clip(1.0 - self.t / BELOW, 0.0, 1.0) * np.clip((2.0 * BELOW - np.abs(self.s)) / BELOW, 0.0, 1.0)
        self.nodes = self.nodes + (gap * fade)[:, None] * self.body.normal

    def flank(self):
        """Nodes of the flank where the mesh is fine, up the flank."""
        found = np.flatnonzero((self.t == 0.0) & (np.abs(self.s) < full.REACH[0] + 1e-6))
        return found[np.argsort(self.up(found))]

    def beside(self):
        """Elements with a node of flank()."""
        return np.flatnonzero(np.any(np.isin(self.elements, self.flank()), axis=1))

    def up(self, nodes):
        """Places up the flank."""
        return self.s[nodes] * (-1.0 if self.body.disc else 1.0)

    def lines(self, first_node=1, first_element=1, reach=FLANK):
        """Nodes, elements, sets and the surface S<NAME> of a deck."""
        name = self.name.upper()
        out = [f"*NODE, NSET=N{name}"]
        out += ["{}, {:.14g}, {:.14g}, 0.".format(first_node + k, *at) for k, at in enumerate(self.nodes)]
        out.append(f"*ELEMENT, TYPE=CPE8, ELSET=E{name}")
        out += [", ".join(map(str, [first_element + k, *(one + first_node)])) for k, one in enumerate(self.elements)]
        for title, mask in self.sets.items():
            out += [f"*NSET, NSET={title}", *numbers(np.flatnonzero(mask) + first_node)]
        near = np.abs(self.s[self.elements[self.sides, 4]]) < reach
        out.append(f"*SURFACE, NAME=S{name}")
        return [*out, *(f"{first_element + k}, S1" for k in self.sides[near])]


def material(*names):
    """Titanium, of the elements of bodies."""
    out = ["*MATERIAL, NAME=TITANIUM", "*ELASTIC", f"{TITANIUM[0]}, {TITANIUM[1]}"]
    for name in names:
        out += [f"*SOLID SECTION, ELSET=E{name.upper()}, MATERIAL=TITANIUM", "1."]
    return out


def write(path, lines):
    """Writes a deck."""
    Path(path).write_text("\n".join(lines) + "\n", encoding="ascii")


def contact_deck(blade, disc, rises, stiffness):
    """Lines of the deck of full contact; stiffness: of contact and stick, MPa/mm."""
    after = 1 + len(blade.nodes), 1 + len(blade.elements)
    out = ["*HEADING", "dovetail in plane strain: full contact", *blade.lines(reach=full.REACH[0])]
    out += [*disc.lines(*after, reach=full.REACH[0]), *material("blade", "disc")]
    out += ["*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness:.12g}"]
    out += ["*FRICTION", f"{full.FRICTION}, {stiffness:.12g}"]
    out += ["*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "SBLADE, SDISC"]
    out += [
        "*NSET, NSET=FLANKS",
        *numbers(blade.flank() + 1),
        *numbers(np.unique(disc.elements[disc.beside()]) + after[0]),
    ]
    mirrored = np.flatnonzero(blade.sets["SYMMETRY"] & ~blade.sets["GRIP"]) + 1
    out += ["*NSET, NSET=MIRRORED", *numbers(mirrored)]
    out += ["*BOUNDARY", "HELD, 1, 2", "GRIP, 1, 1", "MIRRORED, 1, 1"]
    prints = [
        "*NODE PRINT, NSET=FLANKS, FREQUENCY=1000",
        "U",
        "*NODE PRINT, NSET=HELD, TOTALS=ONLY, FREQUENCY=1000",
        "RF",
    ]
    for rise in rises:
        out += ["*STEP, INC=200", "*STATIC", "1., 1.", *full.CONTROLS]
        out += ["*BOUNDARY", f"GRIP, 2, 2, {rise:.12g}", *prints, "*END STEP"]
    return out


def read(path, count):
    """Displacements [step][node number] (n, 2), mm, and forces (steps, 2), N/mm, on HELD of a .dat file."""
    moved, force = [], []
    with open(path, encoding="ascii") as file:
        for line in file:
            words = line.split()
            if len(words) > 1 and words[0] in ("displacements", "total", "contact"):
                kind = words[0]
                if kind == "displacements":
                    moved.append(np.zeros((count + 1, 2)))
            elif words and kind == "displacements":
                moved[-1][int(words[0])] = [float(word) for word in words[1:3]]
            elif words and kind == "total":
                force.append([float(word) for word in words[:2]])
    return np.array(moved), np.array(force)


class Line:
    """Functions of the nodes along the flank on sides of three nodes: integrals with them, and the norm by these."""

    POINTS = np.polynomial.legendre.leggauss(6)

    def __init__(self, x):
        at = self.POINTS[0]
        self.values = np.stack([0.5 * at * (at - 1.0), 1.0 - at * at, 0.5 * at * (at + 1.0)], axis=-1)
        self.nodes = np.arange(3) + np.arange(0, len(x) - 2, 2)[:, None]
        self.half = 0.5 * (x[self.nodes[:, 2]] - x[self.nodes[:, 0]])
        self.at = x[self.nodes[:, 1], None] + self.half[:, None] * at
        self.mass = np.zeros((len(x), len(x)))
        own = np.einsum("q,qi,qj->ij", self.POINTS[1], self.values, self.values)
        for nodes, half in zip(self.nodes, self.half):
            self.mass[np.ix_(nodes, nodes)] += half * own

    def forces(self, values):
        """Integrals of values at the points `at` with the nodes' functions."""
        found = np.zeros(len(self.mass))
        np.add.at(found, self.nodes, self.half[:, None] * np.einsum("q,nq,qi->ni", self.POINTS[1], values, self.values))
        return found

    def field(self, forces):
        """Values at the nodes by their forces."""
        return np.linalg.solve(self.mass, forces)

    def error(self, mine, other):
        """L2 of the difference of two fields by their forces, relative to the second."""
        rest = mine - other
        return float(np.sqrt(rest @ self.field(rest) / (other @ self.field(other))))


class Full:
    """Full contact by a part of rise and crown, whose loads, tractions and slip are divided by that part: `loads` of
    all steps (N/m), `forces` of the disc's nodes by pressure and shear (N/mm), `slip` (mm) at the places `x` (mm)."""

    def __init__(self, folder, size, stiffness, part):
        blade, disc = Section("blade", size, FAR), Section("disc", size, FAR)
        blade.crown(part)
        base = folder / f"full_{size:g}_{stiffness:g}_{part:g}"
        write(f"{base}.inp", contact_deck(blade, disc, part * RISES, stiffness * TITANIUM[0] / size))
        whole, self.cpu = run_calculix(base)
        if not whole:
            raise petsam.Error(f"CalculiX stopped, see {base}.log")
        self.size, self.stiffness, self.part = size, stiffness, part
        moved, force = (found / part for found in read(f"{base}.dat", len(blade.nodes) + len(disc.nodes)))
        along, normal = -disc.body.along, disc.body.normal
        self.loads = {"load_n": -1e3 * force @ normal, "load_tx": -1e3 * force @ along}
        nodes = disc.flank()
        self.x = disc.up(nodes)
        self.line = Line(self.x)
        on_disc = moved[:, 1 + len(blade.nodes) :]
        forces = self._forces(disc, on_disc)[:, nodes]
        self.forces = {"pressure": forces @ normal, "shear_x": forces @ along}
        elastic = np.array([self.line.field(one) for one in self.forces["shear_x"]]) * size / (stiffness * TITANIUM[0])
        self.slip = (on_disc[:, nodes] - moved[:, 1 + blade.flank()]) @ along + elastic  # the shear opposes its motion

    @staticmethod
    def _forces(disc, moved):
        """Forces on the nodes of the disc that balance the stresses in the elements beside its flank."""
        near = disc.beside()
        nodes = np.insert(disc.nodes, 1, 0.0, axis=1)
        block = Block("CPE8", np.arange(len(near)), disc.elements[near], *(np.full(len(near), v) for v in TITANIUM))
        matrix = assembled(oriented(Mesh(nodes, [block]), "disc"))
        return np.array([(matrix @ np.insert(u, 1, 0.0, axis=1).ravel()).reshape(-1, 3)[:, ::2] for u in moved])


def compliance(base, name, size=FINE):
    """The file of a section's compliance; size: of the elements at the contact, and of the largest."""
    body = Section(name, *size)
    write(f"{base}.inp", ["*HEADING", name, *body.lines(), *material(name)])
    found = petsam.compliance.of_deck(
        f"{base}.inp", 1e-3 * WIDTH, f"S{name.upper()}", units="mm", frame=FRAMES[name], degree=(DEGREE, 0),
        stress=False, **HELD[name],
    )  # fmt: skip
    found.write(f"{base}.h5")
    return f"{base}.h5"


def contact(blade, disc):
    """petsam's Results of the history by two files."""
    part = 1e-3 * RISES / np.sqrt(2.0)
    moduli = {"young": 1e6 * TITANIUM[0], "poisson": TITANIUM[1]}
    given = {f"body{k}_{name}": value for k in (1, 2) for name, value in moduli.items()}
    given |= dict(body1_compliance=blade, body2_compliance=disc, friction=full.FRICTION, rot_y=0, disp_y=0)
    given |= dict(gap_type="ellipsoid", gap_radius_x=1e-3 * RADIUS, gap_radius_y="inf")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", petsam.AdviceWarning)  # more load steps leave the loop of the rows as it is
        history = {"disp_x": part, "disp_z": part}
        return petsam.run(given, elasticity="plane", grid_n=CELLS, grid_size=1e-3 * WIDTH, history=history)


def loop(loads):
    """Work of the cycle, J/m, as a polygon over its rows, by load_n and load_tx in N/m."""
    rise, force = 1e-3 * RISES[CYCLE], (loads["load_n"] + loads["load_tx"])[CYCLE] * np.sqrt(0.5)
    return float(np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(rise)))


def slipped(x, at, slip, touches):
    """Slip from TOP to BOTTOM at places x, of values (steps, cells) at cells `at` that touch at BOTTOM; else NaN."""
    whole = np.interp(x, at, touches, 0.0, 0.0) == 1.0
    return np.where(whole, np.interp(x, at, slip[0] - slip[1]), np.nan)


def differences(mine, other):
    """Differences of petsam's Results from Full contact."""
    found = {"size": other.size, "stiffness": f"{other.stiffness:g} E/size", "part": other.part, "cpu": other.cpu}
    for key, name in (("n", "load_n"), ("t", "load_tx")):
        theirs = other.loads[name]
        found[key] = float(np.max(np.abs(mine.history[name] - theirs)) / np.max(np.abs(theirs)))
    found["work"] = loop(mine.history) / loop(other.loads) - 1.0
    at = 1e3 * mine.x
    ends = {step: petsam.Snapshot(mine, step) for step in (TOP, BOTTOM)}
    for step, grid in ends.items():
        for name, forces in other.forces.items():
            values = np.interp(other.line.at, at, 1e-6 * np.ravel(grid[name]), 0.0, 0.0)
            found[f"{name}{step}"] = other.line.error(other.line.forces(values), forces[step])
    slip = [1e3 * np.ravel(grid["slip_x"]) for grid in ends.values()]
    own = slipped(other.x, at, slip, np.ravel(ends[BOTTOM]["pressure"]) > 0.0)
    theirs = other.slip[TOP] - other.slip[BOTTOM]
    whole = np.isfinite(own)
    found["slip"] = comparison.relative_l2(own[whole], theirs[whole])
    return found


COLUMNS = (
    "size, mm = size:g; stiffness = stiffness; part = part:g; N = n:.2%; T = t:.2%; energy = work:.2%; slip = slip:.2%"
    f"; top: p = pressure{TOP}:.1%; top: q_x = shear_x{TOP}:.1%; bottom: p = pressure{BOTTOM}:.1%; "
    f"bottom: q_x = shear_x{BOTTOM}:.1%; CPU, s = cpu:.0f"
)


def main(arguments=None):
    """Solve and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", help="of all files")
    parser.add_argument("--sizes", type=float, nargs="+", default=[0.1, 0.05], help="mm (0.1 0.05)")
    parser.add_argument("--stiffness", type=float, nargs="+", default=[30.0], help="of contact and stick, E/size (30)")
    parser.add_argument("--parts", type=float, nargs="+", default=[1.0, 0.1], help="of rise and crown (1 0.1)")
    options = parser.parse_args(arguments)
    folder = Path(options.directory)
    folder.mkdir(parents=True, exist_ok=True)
    mine = contact(*(compliance(folder / name, name) for name in ("blade", "disc")))
    print(f"energy of the cycle: {1e3 * loop(mine.history):.2f} mJ/m, as a polygon over its rows")
    for step in (TOP, BOTTOM):
        row = {name: values[step] for name, values in mine.history.items()}
        print("rise {:.0f} um: N = {:.2f}, T = {:.2f} N/mm, contact {:.3f} mm, stick {:.3f} mm".format(
            1e3 * RISES[step], *(1e-3 * row[name] for name in ("load_n", "load_tx")),
            *(1e3 * row[name] for name in ("contact_area", "stick_area"))))  # fmt: skip
    cases = itertools.product(options.sizes, options.stiffness, options.parts)
    rows = [differences(mine, Full(folder, *case)) for case in cases]
    comparison.print_table("petsam relative to CalculiX", COLUMNS, rows)
    return rows


if __name__ == "__main__":
    try:
        main()
    except (petsam.Error, OSError) as error:
        sys.exit(fail("section.py", error, 1))
