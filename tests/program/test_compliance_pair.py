"""petsam-compliance of a pair: two bodies in one deck, bolts between them, modes."""

import math

import h5py
import numpy as np
import pytest
from scipy import linalg

from petsam.apps.compliance import basis, bolts, checks, halfspace, mesh, modes, stiffness
from test_compliance_command import compliance  # noqa: F401
from test_compliance_tool import CCX, needs_calculix

TURN = np.diag([1.0, -1.0, -1.0])
SIDE = np.array([-1.8, -1.0, 0.0, 1.0, 2.0, 3.0])
ALONG = np.array([-2.0, -1.5, -1.0, 0.0, 1.0, 1.7, 2.5])
UPPER = (SIDE, ALONG, np.array([0.0, 1.0, 2.0, 3.0]))
LOWER = (SIDE[:-1], ALONG, np.array([0.0, 1.0, 2.0]))  # of body 1, in its own frame
OTHER = (2.0, 0.25)  # moduli of body 1
FRAME = ["--frame", "0,0,0:1,0,0:0,0,1"]
ALWAYS = ["--patch", "2", "--no-picture", "--no-stress"]
PAIR = ["--mesh", "pair.inp", "--contact", "TOP2", "--pair", "TOP1", *FRAME, *ALWAYS]
HELD = ["--fixed", "END2", "--fixed", "END1"]
BOLT = ["--bolt", "B=WASHER1,WASHER2:0.5"]


def body(number, kind="C3D20", edges=None):
    """Body 2 above z = 0, or body 1 below; held at its far end, with a washer beside the middle of the far end."""
    edges = edges or (UPPER if number == 2 else LOWER)
    height = edges[2][-1]
    moduli = (1.0, 0.3) if number == 2 else OTHER
    found = mesh.grid_mesh(edges, kind, *moduli, node_sets={f"END{number}": lambda p: p[:, 0] < -1.8 + 1e-9})
    block = found.blocks[0]
    middle = found.nodes[block.nodes].mean(axis=1)
    far = np.abs(middle[:, 2] - height) < 0.6 * (height - edges[2][-2])
    near = far & (np.abs(middle[:, 0] - 0.5) < 0.1) & (np.abs(middle[:, 1] - 0.5 * (1 if number == 2 else -1)) < 0.6)
    found.surfaces = {f"TOP{number}": found.surfaces["TOP"]}
    found.surfaces[f"WASHER{number}"] = [(int(n), 1) for n in block.numbers[near]]
    if number == 1:
        found.nodes = found.nodes @ TURN
    return found


def both(kind="C3D20", bodies=None):
    """One mesh of both bodies, 2 and 1."""
    second, first = bodies or (body(2, kind), body(1, kind))
    count, last = len(second.nodes), len(second.blocks[0].numbers)
    one, two = first.blocks[0], second.blocks[0]
    first.blocks[0] = mesh.Block(kind, one.numbers + last, one.nodes + count, one.young, one.poisson)
    surfaces = {name: [(n + last, face) for n, face in faces] for name, faces in first.surfaces.items()}
    sets = {name: nodes + count for name, nodes in first.node_sets.items()}
    nodes = np.concatenate([second.nodes, first.nodes])
    numbers = np.arange(1, len(nodes) + 1)
    return mesh.Mesh(
        nodes, [two, first.blocks[0]], {**second.node_sets, **sets}, {**second.surfaces, **surfaces}, numbers
    )


def lines(found):
    """Its deck."""
    out = stiffness.model_lines(found)
    for name, nodes in found.node_sets.items():
        out += [f"*NSET, NSET={name}", *stiffness.numbers(nodes + 1)]
    for name, faces in found.surfaces.items():
        out += [f"*SURFACE, NAME={name}", *(f"{element}, S{face + 1}" for element, face in faces)]
    return out


def write(path, found, *more):
    """Writes it."""
    path.write_text("\n".join([*lines(found), *more]) + "\n")


@pytest.fixture
def pair(compliance, tmp_path):  # noqa: F811
    """pair(*words): the arrays and attributes of the file of a pair."""
    write(tmp_path / "pair.inp", both())

    def run(*words, check=0):
        said = compliance(*PAIR, *words, "-o", "pair.h5", check=check)
        if check:
            return said[0]
        with h5py.File("pair.h5", "r") as file:
            found = {}
            file.visititems(lambda name, one: found.update({name: one[()]} if isinstance(one, h5py.Dataset) else {}))
            found.update(file.attrs, said=said)
            m = len(found["compliance"])
            found["matrix"] = found["compliance"].reshape(3 * m, 3 * m)
        return found

    return run


# ---------------------------------------------------------------- two bodies without a bolt


@pytest.mark.parametrize("degree", ["2", "2,1"])
def test_a_pair_that_nothing_joins_is_the_sum_of_its_bodies(compliance, pair, tmp_path, degree):  # noqa: F811
    found = pair(*HELD, "--degree", degree, "--center", "0.1,0.2")
    total = 0.0
    for number, frame, center in ((2, FRAME, "0.1,0.2"), (1, ["--frame", "0,0,0:1,0,0:0,0,-1"], "0.1,-0.2")):
        write(tmp_path / "one.inp", body(number))
        words = ["--mesh", "one.inp", "--contact", f"TOP{number}", "--fixed", f"END{number}", *frame, *ALWAYS]
        compliance(*words, "--degree", degree, "--center", center, "-o", "one.h5")
        with h5py.File("one.h5", "r") as file:
            powers, alone = file["/basis/degree_xy"][:], file["/compliance"][:].reshape(found["matrix"].shape)
            sign = np.ones(len(alone))
            if number == 1:
                sign = np.array([(-1.0) ** b * s for _, b in powers for s in np.diag(TURN)])
            total = total + alone * np.outer(sign, sign)
    assert np.max(np.abs(found["matrix"] - total)) < 1e-9 * np.max(np.abs(total))
    assert (found["young"], found["poisson"], found["young1"], found["poisson1"]) == (1.0, 0.3, *OTHER)
    assert np.max(np.abs(alone)) > 0.1 * np.max(np.abs(total)) and "stress/basis" not in found


def test_the_stresses_of_a_pair_are_those_of_body_2(compliance, tmp_path):  # noqa: F811
    write(tmp_path / "pair.inp", both())
    write(tmp_path / "one.inp", body(2))
    words = ["--contact", "TOP2", *FRAME, "--patch", "2", "--no-picture", "--degree", "2", "--fixed", "END2"]
    compliance("--mesh", "one.inp", *words, "-o", "one.h5")
    compliance("--mesh", "pair.inp", *words, "--fixed", "END1", "--pair", "TOP1", "-o", "pair.h5")
    with h5py.File("one.h5", "r") as one, h5py.File("pair.h5", "r") as two:
        alone, found = (file["stress/basis"][:] for file in (one, two))
        assert np.array_equal(one["stress/z"], two["stress/z"])
    assert np.max(np.abs(found - alone)) < 1e-9 * np.max(np.abs(alone))


def test_the_fields_of_body_1_bear_the_opposite_traction():
    patch = basis.Patch((0.1, 0.2), (1.0, 0.7), 2)
    below, above = (kind(patch, 2.0, 0.25) for kind in (halfspace.Mirrored, halfspace.Fields))
    deep = np.array([[0.3, 0.1, 0.03]])
    for found in (below.stress(deep * [1, 1, -1]), above.stress(deep)):  # -t on both faces of z = 0
        assert np.allclose(found[0, :, 2], -np.kron(patch.values(*deep.T[:2]), np.eye(3)), atol=0.15)
    points, step = np.array([[0.4, 0.3, -0.8]]), 1e-5
    for axis in range(3):
        difference = step * np.eye(3)[axis]
        slope = (below.displacement(points + difference) - below.displacement(points - difference)) / (2.0 * step)
        assert np.allclose(below.gradient(points)[:, :, axis], slope, atol=1e-8)


# ---------------------------------------------------------------- bolts


def textbook(length, diameter, young, poisson):
    """Timoshenko's beam along z: displacement and rotation of the first end, then of the second."""
    area, inertia, shear = math.pi * diameter**2 / 4, math.pi * diameter**4 / 64, 0.5 * young / (1 + poisson)
    factor = 6 * (1 + poisson) / (7 + 6 * poisson)
    phi = 12 * young * inertia / (factor * shear * area * length**2)
    a = young * inertia / (length**3 * (1 + phi))
    k = np.zeros((12, 12))
    for place, value in ((2, young * area / length), (5, shear * 2 * inertia / length)):
        k[np.ix_([place, place + 6], [place, place + 6])] = value * np.array([[1, -1], [-1, 1]])
    far, near = (4 + phi) * length**2, (2 - phi) * length**2
    bending = a * np.array(
        [
            [12, 6 * length, -12, 6 * length],
            [6 * length, far, -6 * length, near],
            [-12, -6 * length, 12, -6 * length],
            [6 * length, near, -6 * length, far],
        ]
    )
    for rows, sign in (([0, 4, 6, 10], 1), ([1, 3, 7, 9], -1)):
        signs = np.array([1, sign, 1, sign])
        k[np.ix_(rows, rows)] = bending * np.outer(signs, signs)
    return k


def test_the_beam_is_timoshenkos():
    found = bolts.beam(np.array([0.0, 0.0, 3.0]), 0.5, 7.0, 0.3)
    assert np.allclose(found, textbook(3.0, 0.5, 7.0, 0.3), rtol=1e-9, atol=1e-12)


def test_a_washer_moves_with_a_rigid_motion_and_the_mean_of_any_other():
    found = both()
    washer = bolts.washer(found, "WASHER2")
    assert np.allclose(washer.center, [0.5, 0.5, 3.0])
    shift, turn = np.array([0.1, 0.2, 0.3]), np.array([0.4, -0.5, 0.6])
    rigid = (shift + np.cross(turn, found.nodes - washer.center)).ravel()
    assert np.allclose(washer.motion @ rigid, [*shift, *turn], atol=1e-12)
    square = np.zeros_like(found.nodes)
    square[:, 2] = (found.nodes[:, 0] - 0.5) ** 2  # over a side of 1: mean 1/12
    assert np.allclose(washer.motion @ square.ravel(), [0.0, 0.0, 1.0 / 12.0, 0.0, 0.0, 0.0], atol=1e-12)


class Direct:
    """The same finite elements with consistent forces of the tractions on both surfaces, dense."""

    def __init__(self, patch, held, bolted, diameter=0.5, young=40.0, poisson=0.25, kind="C3D20"):
        self.mesh, self.patch = both(kind), patch
        matrix = stiffness.assembled(self.mesh).toarray()
        centers, motions = [], []
        for name in ("WASHER1", "WASHER2"):
            one = bolts.washer(self.mesh, name)
            centers.append(one.center)
            motions.append(one.motion.toarray())
        length = np.linalg.norm(centers[1] - centers[0])
        motion = np.concatenate(motions)
        if bolted:
            matrix += motion.T @ textbook(length, diameter, young, poisson) @ motion
        self.closing = motions[0][2] - motions[1][2]
        self.axial = young * math.pi * diameter**2 / 4 / length
        fixed = np.unique(np.concatenate([self.mesh.node_sets[name] for name in held]))
        self.free = np.setdiff1d(np.arange(len(matrix)), (3 * fixed[:, None] + np.arange(3)).ravel())
        self.factor = linalg.cho_factor(matrix[np.ix_(self.free, self.free)])
        self.force = self._force("TOP2") - self._force("TOP1")

    def _force(self, name):
        out = np.zeros((len(self.mesh.nodes), 3, 3 * self.patch.count))
        for group in self.mesh.surface_faces(name):
            gauss = self.mesh.gauss(group, 6)
            x = gauss.x.reshape(-1, 3)
            inside = np.all(np.abs(x[:, :2] - self.patch.center) < self.patch.half, axis=1)
            values = (self.patch.values(*x.T[:2]) * inside[:, None]).reshape(*gauss.x.shape[:2], -1)
            nodal = np.einsum("nqj,qk,nq->nkj", values, gauss.values, np.linalg.norm(gauss.area, axis=2))
            for c in range(3):
                np.add.at(out[:, c, c::3], group.nodes, nodal)
        return out.reshape(-1, 3 * self.patch.count)

    def solve(self, force):
        """Displacements by forces."""
        u = np.zeros_like(force)
        u[self.free] = linalg.cho_solve(self.factor, force[self.free])
        return u

    def compliance(self):
        """With the half-spaces' part."""
        return self.force.T @ self.solve(self.force)


SQUARE = basis.Patch((0.0, 0.0), (1.0, 1.0), 3)
STEEL = ["--bolt", "B=WASHER1,WASHER2:0.5:40"]


def close(found, exact, most):
    """Asserts their distance in the norm."""
    distance = np.linalg.norm(found - exact, 2) / np.linalg.norm(exact, 2)
    assert distance < most, distance


def test_a_bolt_changes_the_compliance_as_in_a_direct_solution(pair):
    """Local errors of the finite elements cancel in the difference."""
    loose, tight = (pair(*HELD, "--degree", "3", *more)["matrix"] for more in ([], STEEL))
    exact = [Direct(SQUARE, ["END1", "END2"], bolted).compliance() for bolted in (False, True)]
    assert np.linalg.norm(tight - loose, 2) > 0.02 * np.linalg.norm(loose, 2)
    close(tight - loose, exact[1] - exact[0], 5e-3)
    assert np.max(np.abs(tight - tight.T)) < 1e-5 * np.max(np.abs(tight))


def test_a_body_that_only_a_bolt_holds_moves_as_in_a_direct_solution(pair):
    hung = pair("--fixed", "END1", "--degree", "1", *STEEL)["matrix"]
    held = pair(*HELD, "--degree", "1")["matrix"]
    patch = basis.Patch((0.0, 0.0), (1.0, 1.0), 1)
    exact = Direct(patch, ["END1"], True).compliance() - Direct(patch, ["END1", "END2"], False).compliance()
    close(hung - held, exact, 2e-3)
    local = halfspace.projected(patch, 1.0, 0.3) + halfspace.opposite(halfspace.projected(patch, *OTHER))
    close(hung, Direct(patch, ["END1"], True).compliance() - local, 3e-2)  # the local error of the direct solution


def test_the_tension_that_is_left_follows_from_the_conjugate_load_of_the_bolts_case(pair):
    found = pair(*HELD, "--degree", "3", *STEEL)
    direct = Direct(SQUARE, ["END1", "END2"], True)
    traction = np.random.default_rng(2).normal(size=direct.force.shape[1])
    tension = 3.0
    u = direct.solve(direct.force @ traction + tension * direct.closing)
    exact = tension - direct.axial * direct.closing @ u
    k, closing = found["bolts/B/stiffness"], found["bolts/closing"]
    load = found["cases/bolt_B/displacement"].ravel() @ traction
    assert k == pytest.approx(direct.axial) and closing.shape == (1, 1)
    assert abs(k * load) > 5e-3 * tension and k * closing[0, 0] > 0.02
    assert tension - k * (closing[0, 0] * tension + load) == pytest.approx(exact, abs=5e-3 * abs(k * load))


def test_tension_without_contact_closes_the_gap(pair):
    found = pair("--fixed", "END1", "--degree", "1", *STEEL)
    assert found["cases/bolt_B/displacement"][0, 2] < 0.0 < found["bolts/closing"][0, 0]
    # nothing resists the closing: no tension is left
    assert found["bolts/B/stiffness"] * found["bolts/closing"][0, 0] == pytest.approx(1.0)


# ---------------------------------------------------------------- modes


def test_the_consistent_mass_is_that_of_the_volume():
    found = both()
    for block, density in zip(found.blocks, (3.0, 5.0)):
        block.density = np.full(len(block.numbers), density)
    shift = np.tile([0.0, 1.0, 0.0], len(found.nodes))
    volumes = [np.prod([edges[-1] - edges[0] for edges in one]) for one in (UPPER, LOWER)]
    matrix = modes.mass(found)
    assert shift @ matrix @ shift == pytest.approx(3.0 * volumes[0] + 5.0 * volumes[1])


LIGHT = 1e-6  # CalculiX finds the modes nearest to 1 rad/s


def light(found):
    """Its deck with a small density."""
    text = lines(found)
    return [f"{LIGHT:g}" if before == "*DENSITY" else line for before, line in zip(["", *text], text)]


def frequencies(path):
    """Angular frequencies that CalculiX has printed."""
    text = path.read_text().split("E I G E N V A L U E")[1].split("P A R T I C I P A T I O N")[0]
    rows = [line.split() for line in text.splitlines()]
    return np.array([row[2] for row in rows if len(row) == 5 and row[0].isdecimal()], dtype=float)


@needs_calculix
@pytest.mark.parametrize("kind, most", [("C3D20", 1e-6), ("C3D20R", 1e-6), ("C3D8I", 1e-2)])
def test_frequencies_are_calculixs(compliance, tmp_path, kind, most):  # noqa: F811
    """C3D8I differs by 7e-3, perhaps because its incompatible modes have no mass here."""
    text = [*light(both(kind)), "*NSET, NSET=CORNER", "3,"]
    (tmp_path / "pair.inp").write_text("\n".join(text) + "\n")
    compliance(*PAIR, *HELD, "--degree", "4", "--modes", "6", "--sensor", "TIP=CORNER", "-o", "pair.h5")
    held = [f"{name}, 1, 3" for name in ("END1", "END2")]
    stiffness.run([*text, "*BOUNDARY", *held, "*STEP", "*FREQUENCY", "6", "*END STEP"], tmp_path, "free", CCX)
    with h5py.File("pair.h5", "r") as file:
        assert np.allclose(file["/modes/omega"], frequencies(tmp_path / "free.dat"), rtol=most)
        assert file["/modes/mass_error"][()] < 1e-9 and file["/modes/sensors"].shape == (6, 1, 3)
        assert file["/modes/sensors"].attrs["names"].tolist() == ["TIP"]


@needs_calculix
def test_modes_have_the_signs_and_directions_of_calculixs(compliance, tmp_path):  # noqa: F811
    """In a turned frame, at one node in the deck's directions; and the patch moves as the nodes do."""
    text = light(both())
    (tmp_path / "pair.inp").write_text("\n".join(text) + "\n")
    words = [word for word in PAIR if word not in FRAME] + ["--frame", "0,0,0:0,1,0:0,0,1"]
    node = int(np.argmin(np.linalg.norm(both().nodes - [3.0, 2.5, 3.0], axis=1))) + 1
    words += ["--degree", "4", "--modes", "4", "--sensor", f"TIP={node}", "--sensor", "HELD=1"]
    printed = compliance(*words, *HELD, "-o", "pair.h5")
    held = [f"{name}, 1, 3" for name in ("END1", "END2")]
    sets = ["*NSET, NSET=TIP", f"{node},"]
    step = ["*STEP", "*FREQUENCY", "4", "*NODE PRINT, NSET=TIP", "U", "*END STEP"]
    stiffness.run([*text, *sets, "*BOUNDARY", *held, *step], tmp_path, "free", CCX)
    rows = [line.split() for line in (tmp_path / "free.dat").read_text().splitlines()]
    exact = np.array([row[1:] for row in rows if len(row) == 4 and row[0] == str(node)], dtype=float)
    with h5py.File("pair.h5", "r") as file:
        tip, omega = file["/modes/sensors"][:, 0], file["/modes/omega"][:]
        sign = np.sign(np.sum(tip * exact, axis=1))
        assert np.allclose(tip * sign[:, None], exact, atol=1e-5 * np.max(np.abs(exact)))
        assert file["/modes/sensors"].attrs["names"].tolist() == ["TIP", "HELD"]
        assert np.all(file["/modes/sensors"][:, 1] == 0.0)
        parts = [file[f"/cases/mode{k}/displacement"][:] for k in range(1, 5)]
        assert file["/cases/mode1/displacement"].attrs["units"] == "m2/(m kg^0.5)"
        # K's compliance without that of the modes is positive, and smaller
        matrix = file["/compliance"][:]
        left = matrix - sum(np.multiply.outer(d, d) / w**2 for d, w in zip(parts, omega))
        size = 3 * len(matrix)
        definite = checks.Definiteness(basis.Patch((0.0, 0.0), (1.0, 1.0), 4), 1.0, 0.3, OTHER)
        least = definite.smallest(0.5 * (left + left.transpose(2, 3, 0, 1)).reshape(size, size))
        assert 0.0 < least == pytest.approx(file["/checks/residual_eigenvalue"][()])
        assert np.trace(left.reshape(size, size)) < 0.9 * np.trace(matrix.reshape(size, size))
    assert any(line.startswith("  modes, Hz   ") for line in printed)


def test_a_coarser_deck_of_a_pair_needs_no_sensor(pair, tmp_path):
    write(tmp_path / "coarse.inp", both("C3D8"))
    words = ["--degree", "2", "--modes", "1", "--sensor", f"TIP={len(both().nodes)}", "--coarse-mesh", "coarse.inp"]
    words.append("--keep-elements")  # of the coarser deck
    assert 1e-4 < pair(*HELD, *words)["checks/mesh_change"] < 0.5


# ---------------------------------------------------------------- what is rejected


def test_pairs_that_are_none_are_rejected(pair, compliance, tmp_path):  # noqa: F811
    one = pair("--fixed", "END2", "--fixed", "END1", "--pair", "WASHER2", check=3)
    assert "are of one body: give both bodies nodes of their own" in one
    assert "WASHER1 of --pair does not face surface TOP2" in pair(*HELD, "--pair", "WASHER1", check=3)
    assert "no surface LID; there are" in pair(*HELD, "--pair", "LID", check=3)
    assert "both washers are on one body" in pair(*HELD, "--bolt", "B=WASHER1,TOP1:0.5", check=3)
    assert "floats, as nothing but the contact holds it: hold it by --fixed" in pair("--fixed", "END1", check=3)
    assert "washers are of several materials: give its modulus" in pair(*HELD, *BOLT, check=3)
    few = "node set END1 of --sensor TIP has "
    assert few in pair(*HELD, "--modes", "1", "--sensor", "TIP=END1", check=3)
    assert "no node set CORNER; there are" in pair(*HELD, "--modes", "1", "--sensor", "TIP=CORNER", check=3)
    assert "no node 99999 of --sensor TIP" in pair(*HELD, "--modes", "1", "--sensor", "TIP=99999", check=3)
    alone = both()
    alone.nodes = np.concatenate([alone.nodes, body(2).nodes + [9.0, 0.0, 0.0]])
    block = alone.blocks[0]
    third = mesh.Block("C3D20", block.numbers + 1000, block.nodes + len(both().nodes), block.young, block.poisson)
    alone.blocks.append(third)
    write(tmp_path / "pair.inp", alone)
    said = pair(*HELD, check=3)
    assert "3 separate parts" in said and "join it by --bolt, or remove it" in said


def test_two_materials_in_a_body_of_a_pair_are_rejected(pair, tmp_path):
    found = both()
    found.blocks[0].young[-1] = 5.0
    write(tmp_path / "pair.inp", found)
    assert "several materials: each body of a pair needs one material" in pair(*HELD, check=3)


def test_modes_need_the_density_of_each_material(pair, tmp_path):
    text = "\n".join(lines(both()))
    (tmp_path / "pair.inp").write_text(text.replace("*DENSITY\n1.\n", "", 1) + "\n")
    assert "material E0M0 has no *DENSITY, which --modes needs: give it in kg/m3" in pair(
        *HELD, "--modes", "1", check=3
    )
    (tmp_path / "pair.inp").write_text(text.replace("*DENSITY\n1.\n", "*DENSITY\n-1.\n", 1) + "\n")
    assert "density -1: use a value above 0" in pair(*HELD, "--modes", "1", check=3)
    stiff = both()
    for block in stiff.blocks:
        block.young = np.full(len(block.young), 2e11)
    wrong = "\n".join(lines(stiff)).replace("*DENSITY\n1.\n", "*DENSITY\n7.8e6\n")
    (tmp_path / "pair.inp").write_text(wrong + "\n")
    said = pair(*HELD, "--modes", "1", check=3)
    assert "a density is 7.8e+06 kg/m3, limits 1 and 100000: give it in kg/m3" in said


@pytest.mark.parametrize(
    "words, text",
    [
        (["--bolt", "B=WASHER1:0.5"], "expected NAME=SURFACE1,SURFACE2:DIAMETER[:YOUNG]"),
        (["--bolt", "closing=WASHER1,WASHER2:0.5"], "expected NAME=SURFACE1"),
        (["--bolt", "B=WASHER1,WASHER2:0.5:-2"], "expected a modulus above 0"),
        (["--bolt", "B123456789012345=WASHER1,WASHER2:0.5"], "at most 15 letters"),
        (["--modes", "41"], "from 1 to 40"),
        (["--modes", "40", "--case", "pull=1"], "at most 40 of them, with those of --bolt and --modes"),
        (["--modes", "1", "--case", "mode1=1"], "give each name once"),
        (["--sensor", "TIP=3"], "--sensor needs --modes"),
        (["--modes", "1", "--sensor", "TIP=3", "--sensor", "TIP=4"], "--sensor: give each name once"),
        (["--modes", "1", "--sensor", "TIP="], "expected NAME=NODE"),
        (["--method", "cutoff"], "--method cutoff is not for a pair"),
        (["--depth", "1", "--center=-1,0", "--center", "1,0"], "the file of several patches has no stresses"),
        (["--symmetry", "SIDE"], "--symmetry: a pair is given as a whole"),
    ],
)
def test_options_of_a_pair_that_make_no_sense_are_rejected(pair, words, text):
    assert text in pair(*HELD, *words, check=2)


def test_options_of_a_pair_need_a_pair(compliance):  # noqa: F811
    words = ["--mesh", "a.inp", "--contact", "TOP", "--fixed", "END", "--patch", "1"]
    assert "--modes is for a pair: give the surface of body 1 by --pair" in compliance(*words, "--modes", 1, check=2)[0]
