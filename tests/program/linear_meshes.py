"""Bodies of linear elements: their compliances as they are raised, beside those of refined meshes.

Run by build/venv/bin/python it prints a table of ten blocks, ten sections, a dovetail and a lap joint: the errors of
linear elements that are kept and of raised ones, and what the file has as /mesh_error.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

import petsam.apps.compliance
from petsam.apps.compliance import mesherror, stiffness
from petsam.apps.compliance.mesh import Block, Mesh

TETS = ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6))
PARTS = {"C3D8": (tuple(range(8)),), "C3D6": ((0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)), "C3D4": TETS,
         "CPE4": (tuple(range(4)),), "CPE3": ((0, 1, 2), (0, 2, 3))}  # fmt: skip
RATE = 2**1.45  # by which the error of a mesh falls as it is halved, by singular stresses at the ends of supports
FREE = (None, None, None)
GRADED = [-2.0, -1.4, -1.0, -0.65, -0.35, 0.0, 0.35, 0.65, 1.0, 1.4, 2.0]


def even(low, high, count):
    """Planes of `count` elements."""
    return np.linspace(low, high, count + 1)


CUBE, LOW = (even(-1, 1, 4), even(-1, 1, 4), even(0, 2, 4)), (None, None, 2)
BODIES = {  # kind; planes in x, (y,) z; a point with the coordinates of the held side; width of the patch; nu
    "cube": ("C3D8", CUBE, LOW, 1.0, 0.3),
    "cube, tetrahedra": ("C3D4", CUBE, LOW, 0.8, 0.3),
    "cube, wedges": ("C3D6", CUBE, LOW, 1.0, 0.3),
    "column": ("C3D8", (even(-0.5, 0.5, 2), even(-1, 1, 4), even(0, 3, 6)), (None, None, 3), 0.2, 0.3),
    "column, tetrahedra": ("C3D4", (even(-0.5, 0.5, 4), even(-1, 1, 8), even(0, 2, 8)), LOW, 0.4, 0.3),
    "plate": ("C3D8", (even(-3, 3, 8), even(-2, 2, 6), even(0, 1, 2)), (-3, None, None), 1.0, 0.3),
    "plate, tetrahedra": ("C3D4", (even(-3, 3, 8), even(-2, 2, 6), even(0, 1, 2)), (-3, None, None), 1.0, 0.3),
    "layer": ("C3D8", (even(-2, 2, 8), even(-2, 2, 8), even(0, 1, 2)), (None, None, 1), 1.0, 0.3),
    "rubber": ("C3D8", CUBE, LOW, 1.0, 0.48),
    "held beside": ("C3D8", CUBE, (-1, None, None), 1.0, 0.3),
    "square": ("CPE4", (even(-1, 1, 4), even(0, 2, 4)), (None, 2), 1.0, 0.3),
    "square, triangles": ("CPE3", (even(-1, 1, 4), even(0, 2, 4)), (None, 2), 1.0, 0.3),
    "high": ("CPE4", (even(-1, 1, 4), even(0, 5, 10)), (None, 5), 1.0, 0.3),
    "high, triangles": ("CPE3", (even(-1, 1, 4), even(0, 5, 10)), (None, 5), 1.0, 0.3),
    "bar": ("CPE4", (even(-4, 4, 12), even(0, 1, 2)), (-4, None), 1.0, 0.3),
    "bar, triangles": ("CPE3", (even(-4, 4, 12), even(0, 1, 2)), (-4, None), 1.0, 0.3),
    "wide": ("CPE4", (even(-3, 3, 12), even(0, 1, 2)), (None, 1), 1.0, 0.3),
    "graded": ("CPE4", (np.array(GRADED), np.array([0, 0.3, 0.6, 1, 1.5, 2.2])), (None, 2.2), 1.0, 0.3),
    "rubber in section": ("CPE4", (even(-1, 1, 4), even(0, 2, 4)), (None, 2), 1.0, 0.48),
    "section held beside": ("CPE3", (even(-1, 1, 4), even(0, 2, 4)), (-1, None), 1.0, 0.3),
}


def halved(planes, times):
    """Planes with others between them."""
    for _ in range(times):
        planes = np.sort(np.concatenate([planes, 0.5 * (planes[1:] + planes[:-1])]))
    return planes


def written(path, kind, planes, poisson):
    """The deck of a block or a section, z downwards in the deck of a section as -y."""
    counts, flat = [len(one) for one in planes], len(planes) == 2
    nodes = np.stack(np.meshgrid(*planes, indexing="ij"), axis=-1).reshape(-1, len(planes))
    ring = [(0, 1), (1, 1), (1, 0), (0, 0)] if flat else [(0, 0), (1, 0), (1, 1), (0, 1)]
    corners = ring if flat else [(*at, k) for k in (0, 1) for at in ring]
    first = np.stack(np.meshgrid(*[np.arange(n - 1) for n in counts], indexing="ij"), axis=-1).reshape(
        -1, 1, len(counts)
    )
    cells = np.ravel_multi_index(tuple(np.moveaxis(first + np.array(corners), -1, 0)), counts)
    elements = np.concatenate([cells[:, list(part)] for part in PARTS[kind]])
    if flat:
        nodes = np.stack([nodes[:, 0], -nodes[:, 1], np.zeros(len(nodes))], axis=1)
    many = np.ones(len(elements))
    block = Block(kind, np.arange(1, 1 + len(elements)), elements, 210e9 * many, poisson * many)
    path.write_text("\n".join(stiffness.model_lines(Mesh(nodes, [block]))) + "\n")
    return path


def body(folder, name, times=0, **more):
    """The Body of one of BODIES, its planes halved so many times."""
    kind, planes, held, width, poisson = BODIES[name]
    path = written(Path(folder) / "body.inp", kind, [halved(one, times) for one in planes], poisson)
    top = (None, None, 0) if len(planes) == 3 else (None, 0, None)
    if len(planes) == 2:
        held = (held[0], None if held[1] is None else -held[1], None)
    given = dict(frame=((0, 0, 0), (1, 0, 0)), degree=4, stress=False, **more)
    return petsam.compliance.of_deck(path, width, (top, top), supports=(held, held), **given).bodies[0]


def dovetail(folder, name, times=0, **more):
    """The blade or the disc of examples/dovetail in section."""
    import support

    sys.path[:0] = [str(support.ROOT / "examples" / one) for one in ("dovetail", ".")]
    import section

    mesh = section.Section(name, 0.16 / 2**times, 1.2 / 2**times)
    path = Path(folder) / "flank.inp"
    path.write_text("\n".join(linear(["*HEADING", name, *mesh.lines(), *section.material(name)])) + "\n")
    given = dict(units="mm", frame=section.FRAMES[name], degree=(8, 0), stress=False, **section.HELD[name], **more)
    return petsam.compliance.of_deck(path, 1e-3 * section.WIDTH, f"S{name.upper()}", **given).bodies[0]


def lap(folder, name, times=0, **more):
    """Two strips that a bolt joins."""
    import laps

    path = Path(folder) / "lap.inp"
    laps.Lap.made(2e-3 / 2**times, 3 * 2**times).write(path)
    path.write_text("\n".join(linear(path.read_text().splitlines())) + "\n")
    frame = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0))
    given = dict(pair="CONTACT1", units="mm", frame=frame, supports="CLAMP", degree=(8, 0), **more)
    bolt = {"B": ("WASHER1", "WASHER2", laps.DIAMETER)}
    return petsam.compliance.of_deck(path, 36e-3, "CONTACT2", bolts=bolt, stress=False, **given).bodies[0]


def linear(lines):
    """A deck of CPE8 elements with their corners alone."""
    out, inside = [], False
    for line in lines:
        if line.startswith("*"):
            inside = "TYPE=CPE8" in line
        elif inside:
            line = ",".join(line.split(",")[:5])
        out.append(line.replace("TYPE=CPE8", "TYPE=CPE4"))
    return out


def errors(made, folder, name, times):
    """Errors of linear elements that are kept, of raised ones, and the one that is estimated: relative."""
    kept, found = made(folder, name, keep_elements=True), made(folder, name)
    one, two = (made(folder, name, k).compliance for k in (times - 1, times))
    exact = two + (two - one) / (RATE - 1.0)
    true = [mesherror.relative(found.patch, exact - d.compliance, d.compliance) for d in (kept, found)]
    return (*true, found.mesh_error)


def main():
    """Prints the table."""
    made = {**{name: (body, 1 if len(one[1]) == 3 else 3) for name, one in BODIES.items()},
            "blade": (dovetail, 2), "disc": (dovetail, 2), "lap joint": (lap, 2)}  # fmt: skip
    print("body                  kept     raised   estimated")
    with tempfile.TemporaryDirectory() as folder:
        for name in sys.argv[1:] or made:
            kept, raised, told = (100 * one for one in errors(made[name][0], folder, name, made[name][1]))
            fine = "" if raised < max(2, told) else "  NOT COVERED"
            print(f"{name:20s} {kept:6.1f} % {raised:6.2f} % {told:8.2f} %{fine}", flush=True)


if __name__ == "__main__":
    main()
