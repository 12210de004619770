#!/usr/bin/env python3
"""A cyclic motion of the lap joint, by petsam and by full contact in CalculiX: force and energy of a cycle.

    full.py OUT --size 2           elements of 2 mm at the contact

The strips of mesh.py are both clamped at their far ends, without a bolt; 12 kN press the washers together. Then body
1's end moves up and down by each of DOWN. CalculiX has half of the width (y <= 0) in C3D8I elements and penalty
contact; petsam has the compliance of the whole strips in C3D20R elements of --pair-size at the contact. Writes OUT.inp,
OUT.dat, OUT-pair.inp, OUT-pair.h5 and others beside them, and prints a table.
"""

import argparse
import os
import re
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
from mesh import WASHER, Strips, strip_lines

from petsam import Contact, joint
from petsam.apps.joint.patch import DISPLACEMENTS

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
from decks import run_calculix  # noqa: E402

PRESS = 12e3  # N
DOWN = (0.02, 0.035, 0.05)  # mm
FRICTION, YOUNG = 0.3, 210e3
NEAR, HALF, END, WIDTH, HEIGHT = 20.0, 30.0, 150.0, 25.0, 12.7  # mm: fine elements, overlap, end, half the width
GROWTH = 1.3  # of neighbouring elements
PENALTY = 30.0  # contact stiffness by E over the size of an element
PARTS = 8  # load steps of a half cycle
ROOT = Path(__file__).resolve().parents[2]


def growing(start, end, size, most):
    """Planes from start to end, without start, of elements that grow from `size` to `most`."""
    sizes = []
    while sum(sizes) < end - start - 1e-9:
        sizes.append(min(most, size * GROWTH ** (len(sizes) + 1)))
    return start + np.cumsum(sizes) * (end - start) / sum(sizes)


def planes(size, half):
    """Planes of elements along x and z of body 1 and y of both; `half`: of half of the width, with elements of at most
    6 mm between joint and clamp, since linear ones bend too stiffly."""
    count = round(WASHER / size)
    near = np.arange(1, round(NEAR / WASHER * count) + 1) * WASHER / count  # the washers' edges are planes
    x = [*near, *growing(near[-1], HALF, size, 2 * size)]
    y = [*near, *growing(near[-1], WIDTH, size, 2 * size)]
    z = [0.0, *growing(0.0, HEIGHT, size, 3 * size)]
    x = [*(-v for v in x[::-1]), 0.0, *x, *growing(HALF, END, 2 * size, 6.0 if half else 16.0)]
    return np.array(x), np.array([0.0, *y] if half else [*(-v for v in y[::-1]), 0.0, *y]), np.array(z)


def deck(size, kind, half):
    """The strips, clamped, and the washers' pressure."""
    strips = Strips({"": 0.0}, (), (), ())
    out = strip_lines("lap joint, both ends clamped", strips, planes(size, half), kind)
    pressure = PRESS / (2 * WASHER) ** 2
    return out, ["*DSLOAD", f"WASHER1, P, {pressure:.12g}", f"WASHER2, P, {pressure:.12g}"]


def turns():
    """Places (mm) of body 1's end: after the press, and at the ends of all half cycles."""
    return [0.0, *(sign * down for down in DOWN for sign in (1, -1, 1, -1, 1))]


# ---------------------------------------------------------------- CalculiX


def full_deck(size):
    """Half of the joint with contact: pressed in a step, then two cycles of each motion in steps of half a cycle."""
    out, press = deck(size, "C3D8I", True)
    stiffness = PENALTY * YOUNG / size
    out += ["*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness:.12g}"]
    out += ["*FRICTION", f"{FRICTION}, {stiffness:.12g}"]
    out += ["*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "CONTACT1, CONTACT2"]
    out += ["*BOUNDARY", "CLAMP, 1, 3", "END, 1, 3", "MIDDLE, 2, 2"]
    for k, place in enumerate(turns()):
        # CalculiX's own tolerance lets a step with friction end while forces are still off
        out += ["*STEP, INC=400", "*STATIC", f"{1 / PARTS:g}, 1., , {1 / PARTS:g}"]
        out += ["*CONTROLS, PARAMETERS=FIELD", "2.e-4, 1.e-3, , , 2.e-4, , , "]
        out += ["*CONTROLS, PARAMETERS=TIME INCREMENTATION", "4, 8, 9, 100"]
        out += ["*BOUNDARY", f"END, 3, 3, {-place:.12g}", *(press if k == 0 else [])]
        out += ["*NODE PRINT, NSET=END, TOTALS=ONLY", "RF", "*END STEP"]
    return out


def calculix(base, size):
    """Forces (N) of body 1's end upwards in all increments after the press, their places (mm), and CPU seconds."""
    Path(f"{base}.inp").write_text("\n".join(full_deck(size)) + "\n", encoding="ascii")
    whole, cpu = run_calculix(base)
    if not whole:
        sys.exit(f"full.py: CalculiX failed, see {base}.log")
    text = Path(f"{base}.dat").read_text(encoding="ascii")
    found = re.findall(r"set END and time +(\S+)\s+(\S+) +(\S+) +(\S+)", text)
    time, force = np.array([[float(row[0]), 2 * float(row[3])] for row in found if float(row[0]) > 1 + 1e-9]).T
    place = np.interp(time - 1, np.arange(len(turns())), turns())
    return place, -force, cpu


# ---------------------------------------------------------------- petsam


def petsam(base, size, degree, cells):
    """The same of petsam, and the energy (N mm) that each load step dissipates."""
    out, press = deck(size, "C3D20R", False)
    static = ["*STEP", "*STATIC"]
    out += [*static, *press, "*END STEP", *static, "*BOUNDARY", "END, 3, 3, -1.", "*END STEP"]
    Path(f"{base}-pair.inp").write_text("\n".join(out) + "\n", encoding="ascii")
    before = os.times()
    words = ["--mesh", f"{base}-pair.inp", "--units", "mm", "--contact", "CONTACT2", "--pair", "CONTACT1"]
    words += ["--fixed", "CLAMP", "--fixed", "END", "--patch", "44mm,38mm", "--degree", degree, "--no-picture"]
    words += ["--case", "press=1", "--case", "move=2", "-o", f"{base}-pair.h5"]
    subprocess.run([ROOT / "scripts/petsam-compliance", *words], check=True, stdout=subprocess.DEVNULL)
    with h5py.File(f"{base}-pair.h5") as f:
        coupling = f["rigid/compliance"][()]
    contact = Contact(
        body1_young=YOUNG * 1e6, body1_poisson=0.3, body2_young=YOUNG * 1e6, body2_poisson=0.3, gap_type="flat",
        body2_compliance=f"{base}-pair.h5:1:local", grid_n=cells, grid_size=(44e-3, 38e-3), friction=FRICTION,
    )  # fmt: skip
    patch = joint.Patch(contact, DISPLACEMENTS, by_load=DISPLACEMENTS)
    structure = joint.Structure([patch], coupling=coupling)
    structure.loads[0] = -0.1 * PRESS
    ends, found = np.array(turns()), []
    for time in np.arange(1, PARTS * len(ends) + 1) / PARTS - 1:
        place = np.interp(time, np.arange(len(ends)), ends)
        held = dict(body2_case_press=min(time + 1, 1.0), body2_case_move=place)
        structure.step([], [held])
        numbers = [patch.number(name) for name in ("body2_case_move_load", "dissipated_energy")]
        found.append((place, -1e3 * numbers[0], 1e3 * numbers[1]))  # J for a motion by 1 mm
    after = os.times()
    cpu = sum(after[:4]) - sum(before[:4])
    return (*np.array(found[PARTS:]).T, cpu)


# ---------------------------------------------------------------- both


def cycles(place, force, parts):
    """Of the last cycle of each motion: secant stiffness (N/mm), area of the loop (N mm)."""
    found = []
    for k, down in enumerate(DOWN):
        last = slice((5 * k + 3) * parts - 1, 5 * (k + 1) * parts)
        x, f = place[last], force[last]
        found.append(((f[0] - f[parts]) / (2 * down), float(np.sum(0.5 * (f[1:] + f[:-1]) * np.diff(x)))))
    return found


def main():
    """Run both."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", help="base of the files' names")
    parser.add_argument("--size", type=float, default=2.0, help="of the elements at the contact, mm (2)")
    parser.add_argument("--pair-size", type=float, default=3.0, help="the same of petsam-compliance, mm (3)")
    parser.add_argument("--degree", default="10,8", help="of petsam's polynomials (10,8)")
    parser.add_argument("--cells", type=int, nargs=2, default=(110, 96), help="of petsam (110 96)")
    parser.add_argument("--only", choices=("petsam", "calculix"), help="one of both")
    given = parser.parse_args()
    base = Path(given.out).resolve()
    table = {}
    if given.only != "calculix":
        place, force, energy, cpu = petsam(base, given.pair_size, given.degree, given.cells)
        table["petsam"] = (
            [
                (secant, area, float(np.sum(energy[(5 * k + 3) * PARTS : 5 * (k + 1) * PARTS])))
                for k, (secant, area) in enumerate(cycles(place, force, PARTS))
            ],
            cpu,
        )
    if given.only != "petsam":
        place, force, cpu = calculix(base, given.size)
        parts = len(place) // (5 * len(DOWN))
        table["CalculiX"] = [(*row, np.nan) for row in cycles(place, force, parts)], cpu
    print("           d, mm  secant, N/mm  loop, N mm  friction, N mm    CPU, s")
    for name, (rows, cpu) in table.items():
        for down, (secant, area, energy) in zip(DOWN, rows):
            print(f"{name:10} {down:5g} {secant:13.3f} {area:11.4g} {energy:15.4g} {cpu:9.0f}")


if __name__ == "__main__":
    main()
