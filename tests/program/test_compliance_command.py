"""petsam-compliance as a command: its file, load cases, stresses, and everything that it rejects."""

import re
import sys

import h5py
import numpy as np
import pytest

import petsam
from petsam.apps.compliance import cases, deck, mesh, model, stiffness
from test_compliance_tool import EVEN, clamped, needs_calculix
from test_plot import pixels

GRID = np.linspace(-2.0, 2.0, 5)
SUPPORT = {"LEFT": lambda p: p[:, 0] < -2.0 + 1e-9, "RIGHT": lambda p: p[:, 0] > 2.0 - 1e-9}
BOTTOM = {"BOTTOM": lambda p: p[:, 2] > 4.0 - 1e-9}
ALWAYS = ["--contact", "TOP", "--patch", "2", "--degree", "2", "--no-picture"]


def written(path, body, *more):
    """A deck of a mesh, with further lines."""
    lines = stiffness.model_lines(body)
    for name, nodes in body.node_sets.items():
        lines += [f"*NSET, NSET={name}", *stiffness.numbers(nodes + 1)]
    lines += ["*SURFACE, NAME=TOP", *(f"{element}, S{face + 1}" for element, face in body.surfaces["TOP"])]
    path.write_text("\n".join([*lines, *more]) + "\n")


def bricks(edges=(GRID, GRID, GRID + 2.0), sets=BOTTOM, moduli=(1.0, 0.3)):
    """A block of quadratic bricks."""
    return mesh.grid_mesh(edges, "C3D20", *moduli, node_sets=sets)


@pytest.fixture
def compliance(tmp_path, monkeypatch, capfd):
    """compliance(*words, check=0): lines on stdout of petsam-compliance, or those on stderr where it fails."""
    from petsam.apps.launch import code_of

    monkeypatch.chdir(tmp_path)

    def run(*words, check=0, warning=None):
        monkeypatch.setattr(sys, "argv", ["petsam-compliance", *map(str, words)])
        try:
            code = code_of("petsam-compliance")
        except SystemExit as end:  # of argparse
            code = end.code
        out, err = capfd.readouterr()
        err = re.sub(r"(?m)^  \d+ s: .*\n", "", err)  # progress
        assert code == check, out + err
        if check:
            assert len(err.splitlines()) == 1 and err.startswith("petsam-compliance: error: "), err
        elif warning:
            assert f"petsam-compliance: warning: {warning}" in err
        else:
            assert not err
        return (err if check else out).splitlines()

    return run


@pytest.fixture
def block(tmp_path):
    """Name of the deck of a block, clamped below."""
    written(tmp_path / "block.inp", bricks())
    return ["--mesh", "block.inp", "--fixed", "BOTTOM", *ALWAYS]


# ---------------------------------------------------------------- the file


def test_the_file_has_all_that_its_format_names(compliance, block):
    printed = compliance(*block, "-o", "f.h5")
    with h5py.File("f.h5", "r") as file:
        attributes = dict(file.attrs)
        assert attributes["petsam_compliance"] == 1 and attributes["young"] == 1.0 and attributes["poisson"] == 0.3
        assert attributes["method"] == "image" and attributes["degree"] == 2 and attributes["source"] == "block.inp"
        assert re.fullmatch("[0-9a-f]{64}", attributes["source_sha256"])
        assert np.allclose(file["/frame/origin"], 0.0) and np.allclose(file["/frame/axes"], np.eye(3))
        assert np.allclose(file["/patch/center"], 0.0) and np.allclose(file["/patch/half"], 1.0)
        assert file["/basis/degree_xy"][:].tolist() == [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2]]
        assert file["/compliance"].shape == (6, 3, 6, 3)
        assert file["/compliance"][0, 0, 0, 0] == pytest.approx(5.367, abs=1e-3)
        assert file["/stress/basis"].shape == (6, 3, 13, 13, 13, 6) and file["/stress/z"][-1] == pytest.approx(2.0)
        assert file["/checks/asymmetry"][()] < 1e-6 and 0.9 < file["/checks/smallest_eigenvalue"][()] <= 1.0
        assert 0.0 < file["/checks/degree_change"][()] < 1.0 and "cases" not in file
    assert any("-body2_compliance f.h5 -body2_young 1 -body2_poisson 0.3" in line for line in printed)


def test_degrees_in_x_and_y_give_the_same_compliance_of_the_same_functions(compliance, block):
    compliance(*block, "--degree", "4", "--no-stress", "-o", "total.h5")
    printed = compliance(*block, "--degree", "3,1", "--no-stress", "-o", "each.h5")
    assert any("8 of degree 3,1" in line for line in printed) and any("degree 1,0 changes" in line for line in printed)
    with h5py.File("total.h5", "r") as total, h5py.File("each.h5", "r") as each:
        powers = each["/basis/degree_xy"][:].tolist()
        assert sorted(powers) == [[a, b] for a in range(4) for b in range(2)] and each.attrs["degree"] == 3
        place = [total["/basis/degree_xy"][:].tolist().index(pair) for pair in powers]
        assert np.allclose(total["/compliance"][:][place][:, :, place], each["/compliance"], atol=1e-10)
        assert 0.0 < each["/checks/degree_change"][()] < 1.0


def test_too_many_polynomials_are_rejected(compliance, block):
    for degree, text in (("12,25", "0 to 24 for x and y"), ("24,24", "625 polynomials, limit 325"), ("11", "0 to 10")):
        said = compliance(*block, "--degree", degree, check=2)[0]
        assert text in said, said


@needs_calculix
def test_calculixs_stiffness_gives_the_same_compliance(compliance, block):
    compliance(*block, "-o", "own.h5", "--no-stress")
    compliance(*block, "--stiffness", "calculix", "-o", "calculix.h5", "--no-stress")
    with h5py.File("own.h5", "r") as own, h5py.File("calculix.h5", "r") as other:
        assert np.allclose(own["compliance"], other["compliance"], atol=1e-9) and "stress" not in other


def test_calculix_is_needed_only_for_what_petsam_does_not_assemble(compliance, tmp_path, monkeypatch):
    monkeypatch.setenv("CCX", "no-such-ccx")
    words = [*ALWAYS, "--fixed", "BOTTOM", "--no-stress"]
    for kind, code in (("C3D20R", 0), ("C3D8I", 3)):
        written(tmp_path / "a.inp", mesh.grid_mesh((GRID, GRID, GRID + 2.0), kind, 1.0, 0.3, node_sets=BOTTOM))
        said = compliance("--mesh", "a.inp", *words, "-o", "f.h5", check=code)
    assert (
        "install the Debian package calculix-ccx, or omit --stiffness with elements C3D20, C3D20R, C3D10, C3D15, C3D8"
        in said[0]
    )
    assert (
        "need CalculiX's stiffness: omit --stiffness own"
        in (compliance("--mesh", "a.inp", *words, "--stiffness", "own", check=3)[0])
    )


def test_a_coarser_mesh_estimates_the_error(compliance, block, tmp_path):
    half = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    written(tmp_path / "coarse.inp", bricks((half, half, [0.0, 1.0, 2.2, 4.0])))
    compliance(*block, "--coarse-mesh", "coarse.inp", "-o", "f.h5")
    with h5py.File("f.h5", "r") as file:
        assert 1e-5 < file["/checks/mesh_change"][()] < 2e-2


def test_coarser_mesh_is_read_before_the_work_on_the_fine_one(compliance, block, tmp_path, monkeypatch):
    from petsam.apps.compliance import model

    monkeypatch.setattr(model, "remainder", None)  # a call of it would be another error
    (tmp_path / "coarse.inp").write_text("*NODE\n1, 0, 0, 0\n")
    assert "coarse.inp" in compliance(*block, "--coarse-mesh", "coarse.inp", check=3)[0]


def test_millimetres_and_a_frame_in_the_model(compliance, tmp_path):
    body = bricks(moduli=(210000.0, 0.3))
    body.nodes = body.nodes @ np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]) + [5.0, 6.0, 7.0]
    written(tmp_path / "block.inp", body)
    words = [*ALWAYS, "--patch", "2mm", "--mesh", "block.inp", "--fixed", "BOTTOM", "--units", "mm"]
    compliance(*words, "--frame", "5,6,7:0,1,0", "-o", "f.h5")
    with h5py.File("f.h5", "r") as file:
        assert np.allclose(file["/frame/origin"], [5e-3, 6e-3, 7e-3])
        assert np.allclose(file["/frame/axes"], [[0, 1, 0], [0, 0, 1], [1, 0, 0]])
        # D scales with length over modulus
        assert file["/compliance"][0, 0, 0, 0] == pytest.approx(5.367 * 1e-3 / 2.1e11, rel=2e-4)
        assert file.attrs["young"] == 2.1e11


def test_an_inclined_frame_gives_the_same_file(compliance, block, tmp_path):
    compliance(*block, "-o", "straight.h5")
    body, c, s = bricks(), np.cos(0.4), np.sin(0.4)
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    body.nodes = body.nodes @ turn
    written(tmp_path / "block.inp", body)
    compliance(*block, "--frame", "0,0,0:" + ",".join(map(str, turn[0])), "-o", "inclined.h5")
    with h5py.File("straight.h5", "r") as one, h5py.File("inclined.h5", "r") as other:
        for name in ("compliance", "stress/basis"):
            assert np.allclose(one[name], other[name], atol=1e-6)


def test_the_picture_is_drawn(compliance, block):
    words = [word for word in block if word != "--no-picture"]
    assert "wrote block.png" in compliance(*words)
    usual = pixels("block.png")
    assert min(usual) > 500
    compliance(*words, "--dpi", "300")
    assert pixels("block.png") == pytest.approx([2 * side for side in usual], abs=2)


# ---------------------------------------------------------------- load cases and stresses


def bar(path, *steps):
    """A bar without Poisson's ratio between its ends, so that it is stretched evenly."""
    written(path, bricks(sets=SUPPORT, moduli=(2.0, 0.0)), *steps)
    return ["--mesh", path.name, *ALWAYS]


PULL = ["*STEP", "*STATIC", "*BOUNDARY", "RIGHT, 1, 1, 0.1", "*END STEP"]
PRESS = ["*STEP", "*STATIC", "*DSLOAD", "END, P, -0.05", "*END STEP"]


def test_a_bar_is_stretched_evenly_by_a_case_of_displacement(compliance, tmp_path):
    words = bar(tmp_path / "bar.inp", *PULL)
    compliance(*words, "--fixed", "LEFT", "--fixed", "RIGHT", "--case", "pull=1", "-o", "f.h5")
    with h5py.File("f.h5", "r") as file:
        v, stress = file["/cases/pull/displacement"][:], file["/stress/cases/pull"][:]
    exact = np.zeros((6, 3))
    exact[0, 0], exact[1, 0] = 0.05 * 2.0, 0.025 * 2.0 / np.sqrt(3.0)  # u_x = 0.025 (x + 2)
    assert np.allclose(v, exact, atol=1e-4)  # measured 2e-5: fields of the patch at the ends
    assert np.allclose(stress[..., 0], 2.0 * 0.025, atol=1e-9) and np.allclose(stress[..., 1:], 0.0, atol=1e-9)


@pytest.mark.parametrize("step", [PRESS, ["*STEP", "*DLOAD", "LAST, P4, -0.05", "*END STEP"]])
def test_a_bar_is_stretched_evenly_by_a_case_of_pressure(compliance, tmp_path, step):
    body = bricks(sets=SUPPORT)
    last = [
        number
        for number, nodes in zip(body.blocks[0].numbers, body.blocks[0].nodes)
        if 1.9 < body.nodes[nodes, 0].max()
    ]
    surface = ["*ELSET, ELSET=LAST", *stiffness.numbers(last), "*SURFACE, NAME=END", "LAST, S4"]
    words = bar(tmp_path / "bar.inp", *surface, *step)
    compliance(*words, "--fixed", "LEFT", "--case", "pull=1", "-o", "f.h5")
    with h5py.File("f.h5", "r") as file:
        v = file["/cases/pull/displacement"][:]
    assert v[0, 0] == pytest.approx(0.1, rel=2e-3) and v[1, 0] == pytest.approx(0.05 / np.sqrt(3.0), rel=2e-3)


def test_forces_on_nodes_are_given_to_each_node_of_a_set(tmp_path):
    path = tmp_path / "bar.inp"
    bar(path, "*STEP", "*CLOAD", "RIGHT, 1, 0.01", "7, 2, 3.", "*END STEP")
    found, axes = deck.read(str(path)), np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
    frame = model.Frame(np.zeros(3), axes)
    force = cases.loads(found, found.mesh, frame, model.UNITS["mm"], 1).force.reshape(-1, 3)
    right = SUPPORT["RIGHT"](found.mesh.nodes)
    # x of the deck is z of the frame, y is x; newtons
    assert np.allclose(force[right, 2], 0.01) and np.allclose(force[~right, 2], 0.0)
    assert force[6, 0] == pytest.approx(3.0) and np.count_nonzero(force) == np.count_nonzero(right) + 1


def test_stresses_below_a_pressure_are_the_reference_numbers():
    """p = 1/2 on the patch of the block 4 x 4 x 4 with 8^3 bricks, at (0, 0, 0.5)."""
    from petsam.apps.compliance import basis, halfspace, stresses

    patch = basis.Patch((0.0, 0.0), (1.0, 1.0), 0)
    body = clamped(EVEN, EVEN, EVEN + 2.0)
    rest = body.by_images(patch)
    where = stresses.grid(body.mesh, patch, 2.0)
    found = stresses.remaining(where, rest)[0, 2, 3, 6, 6]  # z = 0.5
    local = halfspace.Fields(patch, 1.0, 0.3).stress(np.array([[0.0, 0.0, 0.5]]))[0, :, :, 2]
    assert local[0, 0] == pytest.approx(-0.151, abs=5e-4) and local[2, 2] == pytest.approx(-0.465, abs=5e-4)
    assert local[0, 0] + found[0] == pytest.approx(-0.1066, abs=2e-3)
    assert local[2, 2] + found[2] == pytest.approx(-0.4734, abs=2e-3)


def test_both_methods_give_the_same_stresses(compliance, tmp_path):
    fine = np.linspace(-2.0, 2.0, 9)
    written(tmp_path / "block.inp", bricks((fine, fine, fine + 2.0)))
    words = ["--mesh", "block.inp", "--fixed", "BOTTOM", *ALWAYS, "--degree", "0"]
    compliance(*words, "-o", "image.h5")
    compliance(*words, "--method", "cutoff", "-o", "cutoff.h5", warning="elements are up to 0.6")
    with h5py.File("image.h5", "r") as one, h5py.File("cutoff.h5", "r") as other:
        first, second = (file["/stress/basis"][0, 2] for file in (one, other))
        assert other.attrs["method"] == "cutoff"
    assert np.max(np.abs(first - second)) < 0.06  # measured 0.053


# ---------------------------------------------------------------- rejected


def test_a_patch_beyond_the_surface_is_rejected(compliance, block):
    assert "is not on it: use a smaller --patch" in compliance(*block, "--patch", "4.2", check=3)[0]
    assert "the patch is not inside the contact surface" in compliance(*block, "--center", "1.5,0", check=3)[0]


def test_a_frame_off_the_surface_is_rejected(compliance, block):
    assert "off the plane of the frame" in compliance(*block, "--frame", "0,0,0.5", check=3)[0]
    assert "points out of the body: reverse" in compliance(*block, "--frame", "0,0,0:1,0,0:0,0,-1", check=3)[0]
    assert "parallel or zero" in compliance(*block, "--frame", "0,0,0:0,0,1:0,0,1", check=3)[0]


def test_a_small_clearance_is_rejected(compliance, block):
    said = compliance(*block, "--patch", "3.4", check=3)[0]
    assert "another surface of the body is 0.3 m from the patch, limit 0.425 m" in said


def test_coarse_elements_beside_the_patch_are_rejected(compliance, block):
    assert (
        "an element of 1 m is 0.4 m from the patch, limit 1.3 times" in compliance(*block, "--patch", "3.2", check=3)[0]
    )


def test_an_asymmetric_compliance_is_rejected():
    from petsam.apps.compliance import checks

    with pytest.raises(checks.Error, match="asymmetric by 0.0.*limit 0.0001: use a finer mesh"):
        checks.symmetric(np.array([[1.0, 1e-3], [0.0, 1.0]]))


def test_a_body_above_the_plane_of_the_patch_needs_the_cut_off(compliance, tmp_path):
    """A shoulder: the patch lies in a step of the block."""
    x = np.linspace(-2.0, 4.0, 13)
    body = bricks((x, EVEN, np.linspace(-1.0, 3.0, 9)), {"BOTTOM": lambda p: p[:, 2] > 3.0 - 1e-9})
    centers = body.nodes[body.blocks[0].nodes].mean(axis=1)
    kept = (centers[:, 2] > 0.0) | (centers[:, 0] > 2.0)
    one = body.blocks[0]
    for name in ("numbers", "nodes", "young", "poisson"):
        setattr(one, name, getattr(one, name)[kept])
    top = [g for g in body.boundary() if np.any(np.all(np.abs(body.nodes[g.nodes][..., 2]) < 1e-9, axis=1))]
    flat = [
        (int(one.numbers[e]), g.local)
        for g in top
        for e, n in zip(g.elements, g.nodes)
        if np.all(np.abs(body.nodes[n][:, 2]) < 1e-9)
    ]
    body.surfaces["TOP"] = flat
    used, nodes = np.unique(one.nodes, return_inverse=True)
    body.node_sets = {"BOTTOM": np.flatnonzero(np.isin(used, body.node_sets["BOTTOM"]))}
    body.nodes, one.nodes = body.nodes[used], nodes.reshape(one.nodes.shape)
    written(tmp_path / "step.inp", body)
    words = ["--mesh", "step.inp", "--fixed", "BOTTOM", *ALWAYS, "--degree", "1"]
    assert (
        "rises above the plane of the patch: use --method cutoff" in compliance(*words, "--method", "image", check=3)[0]
    )
    printed = compliance(*words, "-o", "f.h5", warning="elements are up to")
    assert any("method cutoff: the body rises above" in line for line in printed)
    said = compliance(*words, "--patch", "3.2", check=3)[0]
    assert "belong to a half-space of one material, limit 0.8 m" in said


def test_two_materials_need_the_cut_off(compliance, tmp_path):
    body = bricks((EVEN, EVEN, EVEN + 2.0))
    body.blocks[0].young[body.nodes[body.blocks[0].nodes].mean(axis=1)[:, 2] > 2.0] = 3.0
    written(tmp_path / "two.inp", body)
    words = ["--mesh", "two.inp", "--fixed", "BOTTOM", *ALWAYS]
    assert "several materials: use --method cutoff" in compliance(*words, "--method", "image", check=3)[0]


def test_a_field_that_the_polynomials_miss_is_rejected(compliance, tmp_path):
    """A force close to the patch."""
    body = bricks(sets=BOTTOM)
    near = int(np.argmin(np.linalg.norm(body.nodes - [1.5, 0.0, 0.0], axis=1))) + 1
    written(tmp_path / "block.inp", body, "*STEP", "*CLOAD", f"{near}, 3, 1.", "*END STEP")
    words = ["--mesh", "block.inp", "--fixed", "BOTTOM", *ALWAYS, "--case", "push=1"]
    assert "load case push: the polynomials miss" in compliance(*words, check=3)[0]


BAD_CASES = [
    ([], "the deck has 0 steps, not step 1"),
    (["*STEP", "*STATIC", "*END STEP"], "step 1 has no load"),
    (["*STEP", "*BOUNDARY", "RIGHT, 1, 1, 0.1", "*END STEP"], "is prescribed but not in --fixed"),
    (["*STEP", "*DLOAD", "1, GRAV, 9.81, 0, 0, -1", "*END STEP"], "only pressure P1 to P6"),
    (["*STEP", "*CLOAD", "RIGHT, 4, 1.", "*END STEP"], "direction 4: use 1 to 3"),
    (["*STEP", "*CLOAD", "RIGHT, 1", "*END STEP"], "too few values"),
    (["*STEP", "*CLOAD", "99999, 1, 1.", "*END STEP"], "no node 99999"),
    (["*STEP", "*TEMPERATURE", "RIGHT, 1.", "*END STEP"], "*TEMPERATURE in a load case is not supported"),
    (["*STEP", "*DSLOAD", "NOWHERE, P, 1.", "*END STEP"], "expected `surface, P, value`"),
    (["*STEP", "*CLOAD, AMPLITUDE=A", "RIGHT, 1, 1.", "*END STEP"], "AMPLITUDE of *CLOAD is not supported"),
    (
        ["*BOUNDARY", "RIGHT, 2, 2", "*STEP", "*END STEP"],
        "which is not in --fixed or --symmetry: add its set to --fixed",
    ),
]


@pytest.mark.parametrize("step, text", BAD_CASES)
def test_steps_that_are_no_load_case_are_rejected(compliance, tmp_path, step, text):
    words = bar(tmp_path / "bar.inp", *step)
    assert text in compliance(*words, "--fixed", "LEFT", "--degree", "0", "--case", "pull=1", check=3)[0]


BAD_DECKS = [
    ("*ELASTIC\n", "*ELASTIC, TYPE=ORTHO\n", "only isotropic elasticity"),
    ("1.000000000000e+00, 3.000000000000e-01", "-1., 0.3", "E = -1, nu = 0.3: use E > 0"),
    ("*ELASTIC\n", "*ELASTIC\n1., 0.3, 0.\n", "*ELASTIC depends on the temperature"),
    ("*SOLID SECTION", "*SHELL SECTION", "*SHELL SECTION is not supported"),
    ("TYPE=C3D20", "TYPE=S8R", "elements of type S8R are not supported"),
    ("*SOLID SECTION, ELSET=E0M0", "*SOLID SECTION, ELSET=OTHER", "no element set OTHER"),
    ("*ELASTIC\n", "*PLASTIC\n", "has no *ELASTIC"),
    ("*NODE, NSET=NALL", "*EQUATION\n*NODE, NSET=NALL", "*EQUATION is not supported"),
    ("*NODE, NSET=NALL", "*INCLUDE, INPUT=block.inp", "decks include each other"),
    ("*NODE, NSET=NALL\n1, ", "*NODE, NSET=NALL\n1000000, ", "node 1 of an element is not defined"),
    ("*NODE, NSET=NALL\n1, ", "*NODE, NSET=NALL\n1, nan, nan, nan\n1, x", "is not finite"),
    ("*SURFACE, NAME=TOP", "*SURFACE, NAME=TOP, TYPE=NODE", "surface TOP is empty"),
]


@pytest.mark.parametrize("old, new, text", BAD_DECKS)
def test_decks_that_are_not_supported_are_rejected(compliance, block, tmp_path, old, new, text):
    path = tmp_path / "block.inp"
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new, 1))
    assert text in compliance(*block, check=3)[0]


def test_sets_that_do_not_exist_are_rejected_with_the_names_that_do(compliance, block):
    said = compliance(*block, "--fixed", "BOTOM", check=3)[0]
    assert "no node set BOTOM: is BOTTOM meant?" in said
    assert "no surface LID; there are TOP" in compliance(*block, "--contact", "LID", check=3)[0]


def test_a_body_with_too_little_support_is_rejected(compliance, tmp_path):
    one = {"ONE": lambda p: np.max(np.abs(p - [-2.0, -2.0, 4.0]), axis=1) < 1e-9}
    written(tmp_path / "block.inp", bricks(sets=one))
    said = compliance("--mesh", "block.inp", "--fixed", "ONE", *ALWAYS, check=3)[0]
    assert "the body, about x = 0, y = 0, z = 2 m of the frame, is not supported" in said


def test_files_that_are_not_its_own_are_kept(compliance, block, tmp_path):
    (tmp_path / "f.h5").write_text("mine")
    assert "was not written by petsam-compliance" in compliance(*block, "-o", "f.h5", check=3)[0]
    assert (tmp_path / "f.h5").read_text() == "mine"
    assert "is an input file" in compliance(*block, "-o", "block.inp", check=3)[0]


# ---------------------------------------------------------------- reading


def test_a_deck_is_read_with_generated_sets_continued_lines_and_included_files(tmp_path):
    (tmp_path / "nodes.inp").write_text("*NODE, NSET=ALL\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n** a comment\n9,5,5,5\n")
    (tmp_path / "a.inp").write_text(
        "*Include, input=nodes.inp\n*element, type=c3d4, elset=e\n7,1,2,\n3,4\n*nset,nset=N,generate\n1,3,2\n"
        "*NSET,NSET=M\nN, 4\n*material,name=m\n*elastic\n1.D0,.3\n*solid section,elset=E,material=M\n"
        "*surface, name=s\ne, S1\n*STEP\n*CLOAD\nN,1,2.\n*END STEP\n"
    )
    found = deck.read(str(tmp_path / "a.inp"))
    assert found.mesh.node_numbers.tolist() == [1, 2, 3, 4] and found.mesh.node_sets["M"].tolist() == [0, 2, 3]
    assert found.mesh.surfaces["S"] == [(7, 0)] and found.mesh.blocks[0].young.tolist() == [1.0]
    assert len(found.steps) == 1 and found.steps[0][0].lines == [["N", "1", "2."]]


PARTS = """*Heading
*Part, name=Bar
*Node
1, 0., 0., 0.
2, 1., 0., 0.
3, 0., 1., 0.
4, 0., 0., 1.
*Element, type=C3D4
1, 1, 2, 3, 4
*Elset, elset=ALL, generate
1, 1, 1
*Nset, nset=FOOT
1, 2
*Surface, type=ELEMENT, name=BASE
ALL, S1
*Solid Section, elset=ALL, material=Steel
,
*End Part
*Assembly, name=Assembly
*Instance, name=Low, part=Bar
*End Instance
*Instance, name=High, part=Bar
10., 0., 2.
10., 0., 0., 10., 0., 1., 90.
*End Instance
*Node
1, 5., 5., 5.
*Nset, nset=POINT
1
*Nset, nset=BOTH, instance=Low
3, FOOT
*Nset, nset=BOTH, instance=High
3
*Elset, elset=_TOP_S1, internal, instance=High, generate
1, 1, 1
*Surface, type=ELEMENT, name=TOP
_TOP_S1, S2
*End Assembly
*Material, name=Steel
*Elastic
210e3, 0.3
*Step
*Cload
BOTH, 1, 2.
High.1, 1, 2.
*End Step
"""


def read_text(path, text):
    path.write_text(text)
    return deck.read(str(path))


def test_a_deck_of_parts_is_that_of_its_instances(tmp_path):
    """Labels of two instances are the same; each is turned about its axis after it has been moved."""
    found = read_text(tmp_path / "parts.inp", PARTS)
    one = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    other = np.stack([10 - one[:, 1], one[:, 0], one[:, 2] + 2], axis=1)
    assert found.mesh.nodes == pytest.approx(np.concatenate([one, other]), abs=1e-12)
    assert found.mesh.blocks[0].nodes.tolist() == [[0, 1, 2, 3], [4, 5, 6, 7]]
    sets = {name: numbers.tolist() for name, numbers in found.mesh.node_sets.items()}
    assert sets == {"LOW.FOOT": [0, 1], "HIGH.FOOT": [4, 5], "BOTH": [0, 1, 2, 6], "POINT": []}
    high = found.mesh.blocks[0].numbers[1]
    assert found.mesh.surfaces["TOP"] == [(high, 1)] and found.mesh.surfaces["HIGH.BASE"] == [(high, 0)]
    assert found.steps[0][0].lines == [["BOTH", "1", "2."], [str(found.mesh.node_numbers[4]), "1", "2."]]


def test_a_deck_of_one_instance_keeps_the_names_of_its_part(tmp_path):
    first = PARTS.index("*Instance, name=High")
    single = PARTS[:first] + PARTS[PARTS.index("*Node\n1, 5.") :].replace("=High", "=Low").replace("High.", "Low.")
    found = read_text(tmp_path / "one.inp", single)
    assert set(found.mesh.node_sets) == {"LOW.FOOT", "FOOT", "BOTH", "POINT"}
    assert set(found.mesh.surfaces) == {"LOW.BASE", "BASE", "TOP"}
    twice = single.replace("nset=BOTH", 'nset="FOOT"')  # a set of the assembly with the name of one of the part
    found = read_text(tmp_path / "twice.inp", twice)
    assert found.mesh.node_sets["FOOT"].tolist() == [0, 1, 2] and found.mesh.node_sets["LOW.FOOT"].tolist() == [0, 1]


def test_a_mesh_inside_an_instance_is_moved_with_it(tmp_path):
    """An independent instance, whose part is empty."""
    end = PARTS.index("*End Part")
    mesh_lines, head = PARTS[PARTS.index("*Node") : end], "*Heading\n*Part, name=Bar\n"
    rest = PARTS[end:].replace("part=Bar\n*End", f"part=Bar\n{mesh_lines}*End")
    rest = rest.replace("1., 90.\n*End", f"1., 90.\n{mesh_lines}*End")
    one, other = (read_text(tmp_path / "a.inp", text).mesh for text in (PARTS, head + rest))
    assert np.array_equal(one.nodes, other.nodes) and np.array_equal(one.node_numbers, other.node_numbers)
    assert one.surfaces == other.surfaces


@pytest.mark.parametrize(
    "old, new, text",
    [
        ("part=Bar\n10.", "part=Bra\n10.", "parts.inp:22: no part BRA: is BAR meant?"),
        ("instance=High\n3", "instance=Hihg\n3", "no instance HIHG: is HIGH meant?"),
        ("10., 0., 2.", "10., 0.", "expected a line of 3 numbers, the translation"),
        ("10., 0., 1., 90.", "10., 0., 0., 90.", "the two points of the axis of rotation are the same"),
        ("10., 0., 2.", "10., O., 2.", "O. in *INSTANCE is no number"),
        ("2, 1., 0., 0.", "2, 1., x, 0.", "x in *NODE is no number"),
        ("name=High", "name=Low", "parts.inp:22: *INSTANCE LOW is given twice"),
        ("*End Part", "", "parts.inp:2: *PART has no *END PART"),
        ("*End Part", "*End Part\n*Part, name=Bar\n*End Part", "*PART BAR is given twice"),
        (
            PARTS[PARTS.index("*Instance, name=Low") : PARTS.index("*Material")],
            "",
            "has parts, but no *INSTANCE of them",
        ),
        ("nset=POINT\n1", "nset=POINT\n2", "*NSET has 2, which is no label of the assembly: give instance="),
    ],
)
def test_instances_that_make_no_sense_are_named(tmp_path, old, new, text):
    assert old in PARTS
    with pytest.raises(petsam.Error) as caught:
        read_text(tmp_path / "parts.inp", PARTS.replace(old, new, 1))
    assert text in str(caught.value)


def test_a_plane_of_symmetry_that_is_held_is_rejected(compliance, tmp_path):
    written(tmp_path / "bar.inp", bricks(sets=SUPPORT))
    words = ["--mesh", "bar.inp", *ALWAYS, "--fixed", "LEFT", "--symmetry", "LEFT", "-o", "f.h5"]
    assert "node set LEFT of --symmetry is held by --fixed: name another" in compliance(*words, check=3)[0]
