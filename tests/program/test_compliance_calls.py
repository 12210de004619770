"""petsam.compliance.of_deck() and of_mesh() from a notebook: what they return, and meshes of meshio beside decks."""

import sys

import h5py
import numpy as np
import pytest

import petsam
from petsam.apps.compliance import mesh
from petsam.apps.compliance.settings import place
from test_compliance_command import ALWAYS, BOTTOM, GRID, bricks, compliance, written  # noqa: F401
from test_compliance_pair import HELD, PAIR, both, light

STEEL = (2.1e11, 0.3, 7850.0)
EDGES = (GRID, GRID, GRID + 2.0)
VTK = {"C3D20": "hexahedron20", "C3D8": "hexahedron", "C3D10": "tetra10"}


def test_a_deck_gives_in_a_notebook_what_the_command_writes(compliance, tmp_path):  # noqa: F811
    written(tmp_path / "block.inp", bricks())
    compliance("--mesh", "block.inp", "--fixed", "BOTTOM", *ALWAYS, "-o", "command.h5")
    found = petsam.compliance.of_deck("block.inp", 2.0, "TOP", supports="BOTTOM", degree=2)
    found.write("notebook.h5")
    with h5py.File("command.h5", "r") as one, h5py.File("notebook.h5", "r") as other:
        for name in ("compliance", "stress/basis", "patch/half"):
            assert np.array_equal(one[name], other[name])
        assert {**one.attrs, "command": ""} == {**other.attrs, "command": ""}
    assert found.moduli == {"body2_young": 1.0, "body2_poisson": 0.3} and found.modes is None
    assert found.checks[0]["smallest_eigenvalue"] > 0.0
    found.to_csv("patches.csv")
    head = (tmp_path / "patches.csv").read_text().splitlines()[0]
    assert head.startswith("patch [1],center_x [m],width_x [m],center_y [m],width_y [m],functions [1],asymmetry [1]")
    with pytest.raises(petsam.Error, match="table moods: is modes meant"):
        found.table("moods")
    (tmp_path / "notes.h5").write_text("mine")
    with pytest.raises(petsam.Error, match="was not written by petsam-compliance"):
        found.write("notes.h5")
    assert petsam.plot.compliance(found).axes
    assert repr(found) == "Compliance(block.inp: 1 contact)"
    with pytest.raises(petsam.Error, match="cannot be written: its folder .* does not exist"):
        found.to_csv("nowhere/patches.csv")
    with pytest.raises(petsam.Error, match="write it to a file by its write"):
        petsam.run(body2_compliance=found)
    with pytest.raises(petsam.Error, match="--mesh needs --contact: the surface"):
        petsam.compliance.of_deck("block.inp", 2.0, None, supports="BOTTOM")


@pytest.mark.parametrize("mesh, says", [("absent.msh", "absent.msh: no such file"), (5, "mesh 5: expected a file")])
def test_what_is_no_mesh_is_an_error_in_a_notebook(mesh, says):
    with pytest.raises(petsam.Error, match=says):
        petsam.compliance.of_mesh(mesh, 2.0, 1.0, 0.3, contact="TOP", supports="BOTTOM")


def test_a_pair_in_a_notebook_has_bolts_modes_and_sensors(compliance, tmp_path):  # noqa: F811
    (tmp_path / "pair.inp").write_text("\n".join(light(both())) + "\n")
    words = [*PAIR, "--bolt", "B=WASHER1,WASHER2:0.5:3", *HELD, "--degree", "4", "--modes", "2", "--sensor", "TIP=1"]
    compliance(*words, "-o", "command.h5")
    found = petsam.compliance.of_deck(
        "pair.inp", 2.0, "TOP2", ["END2", "END1"], pair="TOP1", frame=((0, 0, 0), (1, 0, 0), (0, 0, 1)), degree=4,
        bolts={"B": ("WASHER1", "WASHER2", 0.5, 3.0)}, modes=2, sensors={"TIP": 1}, stress=False,
    )  # fmt: skip
    own = found.bodies[0].compliance
    with h5py.File("command.h5", "r") as file:
        assert np.array_equal(file["compliance"][:].reshape(own.shape), own)
        assert np.array_equal(file["modes/omega"], found.modes.omega)
    modes = {column.name: column for column in found.table("modes")}
    assert modes["frequency"].unit == "Hz" and np.shape(modes["TIP_z"].values) == (2,)
    assert [column.name for column in found.table("bolts")] == ["bolt", "stiffness", "length", "diameter", "young"]
    assert found.table("cases")[1].values == ["bolt_B", "mode1", "mode2"]
    assert found.moduli["body1_young"] == 2.0


@pytest.mark.parametrize(
    "given, says",
    [
        (dict(), "--mesh needs --fixed"),
        (dict(supports="BOTTOM", modes=2), "--modes is for a pair"),
        (dict(supports="BOTTOM", degree=11), "an integer from 0 to 10"),
        (dict(supports="BOTTOM", centers=[(0, 0), (1, 0)]), "--center: several patches are for a pair"),
        (dict(supports="BOTTOM", method="mirror"), "--method mirror: use auto, image, cutoff"),
        (dict(supports="BOTTOM", free=True), "--free holds nothing"),
        (dict(supports="BOTTOM", patch=(1.0, -1.0)), "--patch 1,-1: expected lengths above 0"),
        (dict(supports="BOTTOM", patch=(1.0, 1.0, 1.0)), "patch .1.0, 1.0, 1.0.: expected its full widths in m"),
        (dict(supports="BOTTOM", patch="2mm"), "patch '2mm': expected its full widths in m"),
        (dict(supports="BOTTOM", degree="two"), "two: expected an integer from 0 to 10"),
        (dict(supports="BOTTOM", units="furlong"), "--units furlong: use m, mm"),
        (dict(supports="BOTTOM", unitz="mm"), "unitz: no such argument: is units meant"),
        (dict(supports="BOTTOM", cases="pull"), "'pull': expected {name: value}"),
    ],
)
def test_what_makes_no_sense_is_an_error_in_a_notebook_too(given, says):
    with pytest.raises(petsam.Error, match=says):
        petsam.compliance.of_deck("absent.inp", given.pop("patch", 1.0), "TOP", **given)


# ---------------------------------------------------------------- words with units


def test_words_may_have_units(compliance, tmp_path):  # noqa: F811
    """Millimetres and gigapascals are metres and pascals."""
    (tmp_path / "pair.inp").write_text("\n".join(light(both())) + "\n")
    for which, bolt in (("a", "0.5:3"), ("b", "500mm:3e-9GPa")):
        compliance(*PAIR, "--bolt", f"B=WASHER1,WASHER2:{bolt}", *HELD, "--degree", "4", "-o", f"{which}.h5")
    with h5py.File("a.h5", "r") as one, h5py.File("b.h5", "r") as other:
        assert np.allclose(one["compliance"], other["compliance"], rtol=1e-12)
        assert other["bolts/B/young"][()] == pytest.approx(3.0) and other["bolts/B/diameter"][()] == 0.5
        assert other["bolts/B/place"].shape == (2,) and other["bolts/B/place"].attrs["units"] == "m"
    said = compliance(*PAIR, "--bolt", "B=WASHER1,WASHER2:8mn", *HELD, check=2)[0]
    assert "8mn: expected a length above 0, such as 1e-3 (m) or 1mm; units are m, cm, mm" in said
    said = compliance(*PAIR, "--bolt", "B=WASHER1,WASHER2:8mm:2Gpa", *HELD, check=2)[0]
    assert "2Gpa: expected a modulus above 0, such as 210GPa; units are Pa, " in said


# ---------------------------------------------------------------- meshes of meshio


def given_mesh(kind="C3D20", scale=1.0):
    """A meshio.Mesh of a block, with sets of points and of faces."""
    meshio = pytest.importorskip("meshio", reason="meshio is not installed")
    body = mesh.grid_mesh(EDGES, kind, node_sets=BOTTOM)
    faces = {number: local for number, local in body.surfaces["TOP"]}
    shape = body.blocks[0].shape
    quads = np.array([body.blocks[0].nodes[number - 1][list(shape.faces[local])] for number, local in faces.items()])
    quads = quads[:, :4]
    cells = [(VTK[kind], body.blocks[0].nodes), ("quad", quads)]
    sets = {"Top": [np.zeros(0, dtype=int), np.arange(len(quads))], "All": [np.arange(64), np.zeros(0, dtype=int)]}
    return meshio.Mesh(scale * body.nodes, cells, point_sets={"BOTTOM": body.node_sets["BOTTOM"]}, cell_sets=sets)


def test_a_mesh_is_the_deck_with_its_moduli(tmp_path):
    written(tmp_path / "block.inp", bricks(moduli=STEEL[:2]))
    deck = petsam.compliance.of_deck(tmp_path / "block.inp", 2.0, "TOP", supports="BOTTOM", degree=2)
    one = petsam.compliance.of_mesh(given_mesh(), 2.0, *STEEL, contact="Top", supports="BOTTOM", degree=2)
    largest = np.abs(deck.bodies[0].compliance).max()
    assert np.allclose(one.bodies[0].compliance, deck.bodies[0].compliance, rtol=0, atol=1e-9 * largest)
    mm = petsam.compliance.of_mesh(
        given_mesh(scale=1e3), 2.0, {"All": STEEL[0]}, STEEL[1], supports=((None, None, 4e3), (None, None, 4e3)),
        contact=((-2e3, -2e3, 0.0), (2e3, 2e3, 0.0)), units="mm", degree=2,
    )  # fmt: skip
    assert np.allclose(mm.bodies[0].compliance, deck.bodies[0].compliance, rtol=0, atol=1e-9 * largest)
    one.write(tmp_path / "mesh.h5")
    with h5py.File(tmp_path / "mesh.h5", "r") as file:
        assert file.attrs["source"] == "mesh" and len(file.attrs["source_sha256"]) == 64


def test_materials_are_those_of_their_sets(tmp_path):
    """The lower half stiffer, as in a deck; the cut-off in a body of two materials."""
    body = bricks()
    low = np.flatnonzero(body.nodes[body.blocks[0].nodes].mean(axis=1)[:, 2] > 2.0)
    body.blocks[0].young[low] = 5.0
    written(tmp_path / "block.inp", body)
    given = dict(supports="BOTTOM", degree=1, method="cutoff", stress=False)
    deck = petsam.compliance.of_deck(tmp_path / "block.inp", 2.0, "TOP", **given)
    other = given_mesh()
    none = np.zeros(0, dtype=int)
    other.cell_sets |= {"Low": [low, none], "High": [np.setdiff1d(np.arange(64), low), none]}
    found = petsam.compliance.of_mesh(other, 2.0, {"Low": 5.0, "High": 1.0}, 0.3, contact="Top", **given)
    largest = np.abs(deck.bodies[0].compliance).max()
    assert np.allclose(found.bodies[0].compliance, deck.bodies[0].compliance, rtol=0, atol=1e-9 * largest)
    with pytest.raises(petsam.Error, match="use --young above 0 .* for the sets of all elements"):
        petsam.compliance.of_mesh(other, 2.0, {"Low": 5.0}, 0.3, contact="Top", **given)


def test_a_box_names_nodes_and_faces_of_a_deck(compliance, tmp_path):  # noqa: F811
    written(tmp_path / "block.inp", bricks())
    always = ALWAYS[2:]
    compliance("--mesh", "block.inp", "--contact", "TOP", "--fixed", "BOTTOM", *always, "-o", "sets.h5")
    top = ["--contact=-2,-2,0:2,2,0", "--fixed=-inf,-inf,4:inf,inf,4"]
    compliance("--mesh", "block.inp", *top, *always, "-o", "boxes.h5")
    with h5py.File("sets.h5", "r") as one, h5py.File("boxes.h5", "r") as other:
        assert np.array_equal(one["compliance"], other["compliance"])
    said = compliance("--mesh", "block.inp", top[0], "--fixed", "9,9,9:9,9,9", *always, check=3)[0]
    assert "node set 9,9,9:9,9,9 is empty" in said
    assert place(((0, 1, None), (2, 3, 4))) == "0.0,1.0,-inf:2.0,3.0,4.0"


def test_the_command_reads_physical_groups_of_gmsh(compliance, tmp_path):  # noqa: F811
    given = given_mesh("C3D8")
    tags = [np.full(64, 1), np.full(len(given.cells[1].data), 2)]
    given.cell_data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
    given.field_data = {"Body": np.array([1, 3]), "Upper": np.array([2, 2])}
    given.cell_sets, given.point_sets = {}, {}
    given.write("block.msh", file_format="gmsh22")
    words = ["--patch", "2", "--degree", "1", "--no-picture", "--fixed=-2,-2,4:2,2,4", "-o", "f.h5"]
    moduli = ["--young", "Body=210GPa", "--poisson", "0.3", "--density", "7.85g/cm3"]
    found = []
    for contact in ("Upper", "2"):
        compliance("--mesh", "block.msh", "--contact", contact, *moduli, *words)
        with h5py.File("f.h5", "r") as file:
            found.append(file["compliance"][:])
            assert file.attrs["young"] == 2.1e11
    assert np.array_equal(*found)
    assert "give --young and --poisson" in compliance("--mesh", "block.msh", "--contact", "2", *words, check=3)[0]
    said = compliance("--mesh", "block.msh", "--contact", "Uper", *moduli, *words, check=3)[0]
    assert "no surface Uper: is UPPER meant?" in said
    said = compliance("--mesh", "block.msh", "--contact", "2", "--young", "Bode=1GPa", *moduli[2:], *words, check=3)[0]
    assert "--young of Bode: no such set of elements: is Body meant?" in said
    (tmp_path / "bad.vtu").write_text("no mesh\n")
    assert "bad.vtu: meshio cannot read it" in compliance("--mesh", "bad.vtu", "--contact", "2", *words, check=3)[0]
    written(tmp_path / "a.inp", bricks())
    said = compliance("--mesh", "a.inp", "--contact", "TOP", *moduli, *words, check=3)[0]
    assert "a deck has its own materials: remove --young" in said


def test_elements_that_no_deck_has_are_named():
    meshio = pytest.importorskip("meshio", reason="meshio is not installed")
    given = meshio.Mesh(np.zeros((5, 3)), [("pyramid", np.arange(5)[None])])
    with pytest.raises(petsam.Error, match="elements of type pyramid are not supported: use hexahedron20, tetra10"):
        petsam.compliance.of_mesh(given, 1.0, *STEEL, contact="a", supports="b")
    flat = meshio.Mesh(np.zeros((3, 3)), [("line", np.arange(2)[None])])
    with pytest.raises(petsam.Error, match="has no solid elements: use hexahedron20, .*, or quad8, .* for a section"):
        petsam.compliance.of_mesh(flat, 1.0, *STEEL, contact="a", supports="b")
    skin = meshio.Mesh(np.vstack([np.zeros(3), np.eye(3)]), [("triangle", np.array([[0, 1, 2], [0, 1, 3]]))])
    with pytest.raises(petsam.Error, match="the nodes of a section are in no plane of two axes"):
        petsam.compliance.of_mesh(skin, 1.0, *STEEL, contact="a", supports="b")


def test_without_meshio_its_name_is_printed(compliance, tmp_path, monkeypatch):  # noqa: F811
    monkeypatch.setitem(sys.modules, "meshio", None)
    (tmp_path / "a.vtu").write_text("x")
    words = ["--mesh", "a.vtu", "--fixed", "B", "--young", "1", "--poisson", "0.3", *ALWAYS]
    assert f"{sys.executable} -m pip install meshio" in compliance(*words, check=3)[0]
