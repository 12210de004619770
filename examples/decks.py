"""What the scripts that make an example's meshes share: the lines of a deck, the command line, CalculiX's run."""

import argparse
import os
import subprocess

from petsam.apps.compliance.stiffness import model_lines, numbers


def deck_lines(title, mesh, surface):
    """A CalculiX deck of a mesh, its sets of nodes and one of its surfaces."""
    out = ["*HEADING", f"{title}, mm, N, MPa", *model_lines(mesh)]
    for name, nodes in mesh.node_sets.items():
        out += [f"*NSET, NSET={name}", *numbers(nodes + 1)]
    return [*out, f"*SURFACE, NAME={surface}", *(f"{element}, S{face + 1}" for element, face in mesh.surfaces[surface])]


def write_deck(description, bodies, lines):
    """The program that writes the deck of one of the bodies: lines(body, coarse, type of elements)."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("body", choices=bodies)
    parser.add_argument("file", help="deck to write (.inp)")
    parser.add_argument("--coarse", action="store_true", help="a third of the unknowns")
    parser.add_argument("--type", default="C3D20R", help="element type (C3D20R)")
    options = parser.parse_args()
    with open(options.file, "w", encoding="ascii") as file:
        file.write("\n".join(lines(options.body, options.coarse, options.type)) + "\n")


def run_calculix(base):
    """Runs CalculiX (the program in CCX, or ccx) on one core on BASE.inp, base being a Path; its output is in BASE.log.

    Returns True if it ended well, and its CPU seconds.
    """
    before = os.times()
    with open(f"{base}.log", "w", encoding="utf-8") as log:
        threads = {"OMP_NUM_THREADS": "1", "CCX_NPROC_STIFFNESS": "1"}
        command = [os.environ.get("CCX", "ccx"), base.name]
        done = subprocess.run(command, cwd=base.parent, stdout=log, stderr=log, env={**os.environ, **threads})
    after = os.times()
    cpu = after.children_user + after.children_system - before.children_user - before.children_system
    return done.returncode == 0, cpu
