"""petsam-compliance --free: a pair that nothing holds, joined by bolts."""

import h5py
import numpy as np
import pytest
from scipy import linalg

from petsam import joint
from petsam.apps.compliance import bolts, cases, command, images, model, modes, solve, stiffness
from petsam.apps.compliance.halfspace import opposite, projected
from petsam.apps.joint import sweep
from test_compliance_command import compliance  # noqa: F401
from test_compliance_pair import (
    FRAME,
    OTHER,
    PAIR,
    SQUARE,
    STEEL,
    Direct,
    both,
    close,
    frequencies,
    light,
    lines,
    pair,  # noqa: F401
    write,
)
from test_compliance_tool import CCX, needs_calculix

FREE = ["--free", *STEEL]
SMALL = ["--patch", "1.2", "--degree", "3"]


class Pseudo:
    """Inertia relief by the pseudo-inverse, dense: A' K+ A, in the place of the sparse solver."""

    def __init__(self, matrix, nodes, mass):
        values, vectors = linalg.eigh(matrix)
        assert abs(values[5]) < 1e-9 * values[6]
        null = vectors[:, :6]
        self.project = np.eye(len(matrix)) - mass @ null @ np.linalg.solve(null.T @ mass @ null, null.T)
        elastic = vectors[:, 6:] @ ((1.0 / values[6:, None]) * vectors[:, 6:].T)
        self.inverse = self.project.T @ elastic @ self.project
        self.held = np.zeros(0, dtype=int)

    def __call__(self, force, prescribed):
        return self.inverse @ force

    def reaction(self, u, force):
        return np.zeros((0, force.shape[1]))


def read(words):
    """The Model of a command line, and its stiffness with bolts."""
    options = command.arguments([*words, "-o", "x.h5"])
    found = model.Model(options.mesh, options.settings)
    tie = sum(one.matrix for one in found.bolts)
    return found, stiffness.assembled(found.mesh) + tie, tie


def test_the_compliance_is_that_of_the_pseudo_inverse_whatever_the_hold(pair, tmp_path, monkeypatch):  # noqa: F811
    write(tmp_path / "pair.inp", both("C3D8"))
    words = [*FREE, *SMALL, "--keep-elements"]
    found = pair(*words)
    body, whole, tie = read([*PAIR, *words])
    mass = modes.mass(body.mesh)
    pseudo = Pseudo(whole.toarray(), body.mesh.nodes, mass.toarray())
    exact = images.solved(body.sides(), pseudo, body.supported, tie=tie).compliance
    close(found["matrix"], exact, 1e-8)
    middle = np.argsort(np.linalg.norm(body.mesh.nodes - [0.5, 0.5, 2.0], axis=1))[:3]
    others = [3 * middle[0], 3 * middle[0] + 1, 3 * middle[0] + 2]
    motions = stiffness.rigid_motions(body.mesh.nodes)
    every = (3 * middle[1:, None] + np.arange(3)).ravel()
    for one in every:
        if np.linalg.matrix_rank(motions[[*others, one]], tol=1e-3) == len(others) + 1 <= 6:
            others.append(one)
    assert len(others) == 6 and not set(others) & set(solve.isostatic(motions))
    monkeypatch.setattr(solve, "isostatic", lambda motions: others)
    close(pair(*words)["matrix"], found["matrix"], 1e-8)


def test_loads_in_equilibrium_move_the_patch_as_with_any_pseudo_inverse(tmp_path, monkeypatch):
    """And tractions on the pair are nearly in equilibrium, so inertia does next to nothing."""
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "pair.inp", both("C3D8"))
    body, whole, tie = read([*PAIR, *FREE, "--degree", "3", "--keep-elements"])
    force = Direct(SQUARE, ["END1", "END2"], True, kind="C3D8").force
    floating = solve.Floating(whole, body.mesh.nodes, modes.mass(body.mesh))
    nothing = np.zeros((0, force.shape[1]))
    exact = force.T @ linalg.pinvh(whole.toarray(), rtol=1e-10) @ force
    close(force.T @ floating(force, nothing), exact, 1e-8)
    found = images.solved(body.sides(), floating, body.supported, tie=tie).compliance
    local = projected(SQUARE, 1.0, 0.3) + opposite(projected(SQUARE, *OTHER))
    close(found, exact - local, 1e-2)  # the local error of the direct solution
    monkeypatch.setattr(floating, "inertia", 0.0 * floating.inertia)
    close(images.solved(body.sides(), floating, body.supported, tie=tie).compliance, found, 1e-5)


def test_a_load_case_is_balanced_by_inertia(compliance, pair, tmp_path):  # noqa: F811
    """A force on one node accelerates the pair; the field of the file is that of the pseudo-inverse. Without the
    inertia it differs by 2e-3."""
    node = int(np.argmin(np.linalg.norm(both("C3D8").nodes - [3.0, 2.5, 3.0], axis=1)))
    write(tmp_path / "pair.inp", both("C3D8"), "*STEP", "*STATIC", "*CLOAD", f"{node + 1}, 1, 2.0", "*END STEP")
    found = pair(*FREE, "--degree", "6", "--keep-elements", "--case", "pull=1")
    body, whole, _ = read([*PAIR, *FREE, "--degree", "6", "--keep-elements"])
    pseudo = Pseudo(whole.toarray(), body.mesh.nodes, modes.mass(body.mesh).toarray())
    force = np.zeros((len(pseudo.project), 1))
    force[3 * node] = 2.0
    jump = cases.Jump(body.parts, body.patch, [9, 9])
    exact = jump(pseudo(force, None))
    mine = body.patch.values(*jump.points.T) @ found["cases/pull/displacement"]
    assert np.max(np.abs(mine - exact)) < 6e-4 * np.max(np.abs(exact))


def bolted(found):
    """Lines for CalculiX that make the bolt: springs on six dependent unknowns, of the bolt's own matrix."""
    one = bolts.bolt(found, "B", ("WASHER1", "WASHER2"), 0.5, 40.0).matrix
    rows = np.unique(one.indices)
    values, vectors = linalg.eigh(one[rows][:, rows].toarray())
    assert values[-6] > 1e-6 * values[-1] > 1e3 * abs(values[-7])
    out, last = [], len(found.nodes)
    for k, (value, vector) in enumerate(zip(values[-6:], vectors.T[-6:])):
        node, element = last + 1 + k, 10_000 + k
        used = np.flatnonzero(np.abs(vector) > 1e-12 * np.abs(vector).max())
        terms = [f"{u // 3 + 1}, {u % 3 + 1}, {size:.12e}" for u, size in zip(rows[used], vector[used])]
        out += ["*NODE", f"{node}, {k}, 9., 9.", "*EQUATION", f"{len(used) + 1}", f"{node}, 1, -1."]
        out += terms
        out += [f"*ELEMENT, TYPE=SPRING1, ELSET=SPRING{k}", f"{element}, {node}"]
        out += [f"*SPRING, ELSET=SPRING{k}", "1", f"{value:.12e}"]
        out += ["*BOUNDARY", f"{node}, 2, 3"]
    return out


@needs_calculix
@pytest.mark.parametrize("kind", ["C3D20", "C3D20R"])
def test_elastic_frequencies_and_shapes_are_calculixs(compliance, tmp_path, kind):  # noqa: F811
    """In a turned frame; a sensor is written in the deck's directions."""
    text = light(both(kind))
    (tmp_path / "pair.inp").write_text("\n".join(text) + "\n")
    words = [word for word in PAIR if word not in FRAME] + ["--frame", "0,0,0:0,1,0:0,0,1"]
    node = int(np.argmin(np.linalg.norm(both(kind).nodes - [3.0, 2.5, 3.0], axis=1))) + 1
    words += [*FREE, *SMALL, "--modes", "4", "--sensor", f"TIP={node}"]
    printed = compliance(*words, "-o", "pair.h5")
    step = ["*STEP", "*FREQUENCY", "10", "*NODE PRINT, NSET=TIP", "U", "*END STEP"]
    sets = ["*NSET, NSET=TIP", f"{node},"]
    stiffness.run([*text, *bolted(both(kind)), *sets, *step], tmp_path, "free", CCX)
    rows = [line.split() for line in (tmp_path / "free.dat").read_text().splitlines()]
    exact = np.array([row[1:] for row in rows if len(row) == 4 and row[0] == str(node)], dtype=float)[6:]
    every = frequencies(tmp_path / "free.dat")
    with h5py.File("pair.h5", "r") as file:
        omega, rigid, tip = file["/modes/omega"][:], file["/modes/rigid"][:], file["/modes/sensors"][:, 0]
        assert file["/modes/mass_error"][()] < 1e-9
    assert omega == pytest.approx(every[6:], rel=1e-5)
    assert rigid.shape == (6,) and np.all(rigid < 1e-3 * omega[0])
    sign = np.sign(np.sum(tip * exact, axis=1))
    assert np.allclose(tip * sign[:, None], exact, atol=1e-4 * np.max(np.abs(exact)))
    assert any("six rigid motions are left out, at most " in line for line in printed)


def test_backbone_takes_the_file(pair, tmp_path):  # noqa: F811
    """A crowned contact under the bolt. Rayleigh: what sticks raises each frequency."""
    (tmp_path / "pair.inp").write_text("\n".join(light(both())) + "\n")
    pair(*FREE, "--center", "0.5,0.5", "--patch", "1.4", "--degree", "6", "--modes", "12", "--sensor", "TIP=1")
    given = dict(grid_n=24, friction=0.3, gap_type="sphere", gap_radius1=20.0, gap_radius2="inf")
    found = joint.Pair("pair.h5", dict(B=0.02), **given)
    assert 0.0 < found.tensions["B"] < 0.02 and found.structure.rigid.size == 0
    with pytest.warns(sweep.BackboneWarning, match="fewer than 100 cells slip"):
        one = joint.backbone(found.structure, [1e-6], sensor=found.sensors["TIP"][:, 2], steps=3)
    free = found.omega / (2.0 * np.pi)
    print(free, one.stuck)
    assert one.linear == one.stuck[0] > 1.1 * free[0] and np.all(one.stuck[:6] > free[:6])


# ---------------------------------------------------------------- what is rejected


def test_bodies_that_float_against_each_other_are_rejected(pair):  # noqa: F811
    said = pair("--free", "--degree", "2", check=3)
    assert "float against each other, as no bolt joins them: join them by --bolt, or hold both by --fixed" in said


def test_what_is_free_needs_densities_and_no_supports(pair, tmp_path):  # noqa: F811
    assert "--free holds nothing: remove it, or --fixed" in pair(*FREE, "--fixed", "END1", check=2)
    text = "\n".join(lines(both()))
    (tmp_path / "pair.inp").write_text(text.replace("*DENSITY\n1.\n", "", 1) + "\n")
    assert "material E0M0 has no *DENSITY, which --free needs" in pair(*FREE, check=3)
    (tmp_path / "pair.inp").write_text(text + "\n*BOUNDARY\n3, 1, 3\n")
    assert "*BOUNDARY holds node 3" in pair(*FREE, check=3)


def test_one_body_that_nothing_holds_is_rejected(compliance):  # noqa: F811
    words = ["--mesh", "a.inp", "--contact", "TOP", "--patch", "1", "--free"]
    said = compliance(*words, check=2)[0]
    assert "--free is for a pair: a body alone moves away under the loads of its contact: hold it by --fixed" in said
