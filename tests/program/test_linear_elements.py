"""Decks of linear elements: raised to quadratic ones, with what refers to their nodes, and the error by the mesh."""

import h5py
import numpy as np
import pytest

import linear_meshes
import sections
from petsam.apps.compliance import elements, mesh, mesherror, model
from petsam.apps.compliance.settings import settings
from test_compliance_command import ALWAYS, BOTTOM, GRID, SUPPORT, compliance, written  # noqa: F401

FAR = GRID + 2.0


def both(compliance, folder, decks, *words, warning=None):  # noqa: F811
    """Compliances (and load cases) of two decks by petsam-compliance, and what it says of the first."""
    found = []
    for number, make in enumerate(decks):
        make(folder / f"{number}.inp")
        said = compliance("--mesh", f"{number}.inp", *words, "--no-stress", "-o", f"{number}.h5", warning=warning)
        with h5py.File(f"{number}.h5") as file:
            parts = {"compliance": file["compliance"][:], "error": file["mesh_error"][()]}
            parts.update({name: one["displacement"][:] for name, one in file.get("cases", {}).items()})
        found.append((parts, said))
    return found[0][0], found[1][0], found[0][1]


def bricks(kind, sets, *more, moduli=(1.0, 0.3)):
    """make(path) of a deck of bricks."""
    return lambda path: written(path, mesh.grid_mesh((GRID, GRID, FAR), kind, *moduli, node_sets=sets), *more)


def same(one, other, most=1e-9):
    """Requires equal numbers of the same names."""
    assert one.keys() == other.keys()
    for name in one:
        assert np.allclose(one[name], other[name], rtol=0, atol=most * np.max(np.abs(other[name]))), name


def test_bricks_are_raised_and_the_output_says_so(compliance, tmp_path):  # noqa: F811
    words = ["--fixed", "BOTTOM", *ALWAYS]
    one, two, said = both(compliance, tmp_path, [bricks(kind, BOTTOM) for kind in ("C3D8", "C3D20")], *words)
    same(one, two)
    assert said[1] == "  elements    C3D8 as C3D20, of 425 nodes instead of 125: --keep-elements keeps them linear"
    kept, _, said = both(compliance, tmp_path, [bricks("C3D8", BOTTOM)] * 2, *words, "--keep-elements")
    assert "C3D8, linear ones, which make a body too stiff" in said[1]
    missing = np.linalg.norm((two["compliance"] - kept["compliance"]).reshape(18, 18), 2)
    whole = np.linalg.norm(kept["compliance"].reshape(18, 18), 2)
    assert kept["error"] > missing / whole + 0.5 * two["error"]


@pytest.mark.parametrize("linear, quadratic", [("CPE4", "CPE8"), ("CPE3", "CPE6")])
def test_elements_of_sections_are_raised(compliance, tmp_path, linear, quadratic):  # noqa: F811
    def deck(kind):
        def make(path):
            nodes, cells = sections.grid(np.linspace(-2, 2, 9), np.linspace(0, 3, 7), kind)
            x, z = nodes.T
            sections.deck(path, nodes, cells, kind, {"BOTTOM": z == 3.0}, {"TOP": z == 0.0})

        return make

    one, two, _ = both(compliance, tmp_path, [deck(linear), deck(quadratic)], "--fixed", "BOTTOM", *ALWAYS)
    same(one, two)


def test_faces_are_held_whose_nodes_are_in_several_sets(compliance, tmp_path):  # noqa: F811
    """Each --fixed has a part of a face, and a plane of symmetry ends where the face begins."""

    def sets(whole):
        low, side = lambda p: p[:, 2] > 4.0 - 1e-9, lambda p: p[:, 1] < -2.0 + 1e-9
        if whole:
            return {"A": low, "B": low, "MIRROR": side}
        corner = lambda p: np.all(np.abs(p - np.round(p)) < 1e-9, axis=1)  # noqa: E731
        return {
            "A": lambda p: low(p) & corner(p) & (np.round(p[:, 0]) % 2 == 0),
            "B": lambda p: low(p) & corner(p) & (np.round(p[:, 0]) % 2 == 1),
            "MIRROR": lambda p: side(p) & corner(p) & ~low(p),
        }

    words = ["--fixed", "A", "--fixed", "B", "--symmetry", "MIRROR", *ALWAYS, "--method", "cutoff", "--degree", "1"]
    decks = [bricks("C3D8", sets(False)), bricks("C3D20", sets(True))]
    one, two, _ = both(compliance, tmp_path, decks, *words, warning="elements are up to 1.2 times as wide")
    same(one, two)


def test_loads_on_nodes_stay_those_of_the_deck(compliance, tmp_path):  # noqa: F811
    """Forces on a set are not given to new nodes, and displacements of single nodes are linear between them."""
    found = mesh.grid_mesh((GRID, GRID, FAR), "C3D8", node_sets=SUPPORT)
    right = np.flatnonzero(SUPPORT["RIGHT"](found.nodes))
    turned = [f"{1 + n}, 3, 3, {0.1 * found.nodes[n, 1]:.12g}" for n in right]
    steps = ["*STEP", "*CLOAD", "RIGHT, 1, 0.04", "*END STEP", "*STEP", "*BOUNDARY", *turned, "*END STEP"]
    path = tmp_path / "bar.inp"
    written(path, found, *steps)
    given = settings("TOP", 2.0, ("LEFT", "RIGHT"), degree=2)
    body = model.Model(path, given)
    force = model.load_cases.loads(body.deck, body.mesh, body.frame, body.units, 1).force.reshape(-1, 3)
    assert np.allclose(force[right, 0], 0.04) and force.sum() == pytest.approx(0.04 * len(right))
    moved = model.load_cases.loads(body.deck, body.mesh, body.frame, body.units, 2).moved.reshape(-1, 3)
    end = SUPPORT["RIGHT"](body.mesh.nodes)
    assert np.count_nonzero(end) > len(right) and np.allclose(moved[end, 2], 0.1 * body.mesh.nodes[end, 1])
    assert not np.any(moved[~end])


def test_raised_elements_fit_to_quadratic_ones_beside_them():
    """Half of the bricks are quadratic: nodes between both kinds are one, and C3D8I are raised with C3D8 alone."""
    whole = mesh.grid_mesh((GRID, GRID, FAR), "C3D20")
    (block,) = whole.blocks
    half = whole.nodes[block.nodes].mean(axis=1)[:, 0] < 0.0
    parts = [mesh.Block(kind, block.numbers[mask], block.nodes[mask][:, :count], block.young[mask], block.poisson[mask])
             for kind, count, mask in (("C3D20", 20, half), ("C3D8", 8, ~half))]  # fmt: skip
    used, place = np.unique(np.concatenate([one.nodes.ravel() for one in parts]), return_inverse=True)
    for one, chosen in zip(parts, np.split(place.ravel(), [parts[0].nodes.size])):
        one.nodes = chosen.reshape(one.nodes.shape)
    mixed = mesh.Mesh(whole.nodes[used], parts, node_numbers=used + 1)
    found = elements.raised(mixed)
    assert len(found.nodes) == len(whole.nodes) and elements.quadratic(found)
    assert len(np.unique(found.nodes.round(9), axis=0)) == len(found.nodes)
    parts[1].kind = "C3D8I"
    assert elements.raised(mixed) is mixed and elements.quadratic(elements.raised(mixed, every=True))
    parts[0].kind, parts[0].nodes = "C3D8", parts[0].nodes[:, :8]
    assert {one.kind for one in elements.raised(mixed).blocks} == {"C3D20"}


@pytest.mark.parametrize("name", ["cube", "cube, wedges", "square", "square, triangles", "graded"])
def test_the_error_by_the_mesh_covers_that_of_raised_elements(tmp_path, name):
    times = 1 if name.startswith("cube") else 3
    kept, raised, told = linear_meshes.errors(linear_meshes.body, tmp_path, name, times)
    assert raised < told < kept < 0.3 and told < 4.0 * raised + 0.01


def test_what_linear_elements_lack_is_found_without_them(tmp_path):
    """Where the ends of a bar bend it, the subspace's compliance is that of the linear elements."""
    raised, kept = (linear_meshes.body(tmp_path, "bar", keep_elements=k).compliance for k in (False, True))
    found = linear_meshes.body(tmp_path, "bar")
    lacking = found.mesh_error / mesherror.PART
    assert lacking == pytest.approx(mesherror.relative(found.patch, raised - kept, raised), rel=0.03)
