"""petsam-compliance: half-space fields, both methods against layers, blocks and edges, load cases, stresses, files,
and everything that it rejects."""

import os
import shutil

import numpy as np
import pytest
from scipy.spatial import Delaunay

from petsam.apps.compliance import basis, checks, cutoff, halfspace, images, mesh, remainder, solve, stiffness
from petsam.apps.compliance.shapes import simplex_rule
from petsam.core.errors import Error

CCX = os.environ.get("CCX", "ccx")
needs_calculix = pytest.mark.skipif(not shutil.which(CCX), reason=f"no CalculiX {CCX}: Debian package calculix-ccx")
EYE = np.eye(3)
EVEN = np.linspace(-2.0, 2.0, 9)


def bottom(height):
    """A node set at that height."""
    return {"BOTTOM": lambda p: np.abs(p[:, 2] - height) < 1e-9 * height}


class Example:
    """A body that is held at its node sets, with its stiffness and Solver."""

    def __init__(self, body):
        self.mesh = body
        self.supported = np.unique(np.concatenate(list(body.node_sets.values())))
        fixed = np.zeros((len(body.nodes), 3), dtype=bool)
        fixed[self.supported] = True
        self.matrix = stiffness.assembled(body)
        self.solver = solve.Solver(self.matrix, body.nodes, fixed.ravel())

    def by_images(self, patch, young=1.0):
        """The Remainder by images."""
        fields = halfspace.Fields(patch, young, 0.3)
        return images.solved([remainder.Side(self.mesh, fields)], self.solver, self.supported)

    def by_cutoff(self, patch):
        """The Remainder by a cut-off."""
        chi = cutoff.widest(self.mesh, patch, self.supported, self.mesh.surface_faces("TOP"), 1e-6, (1.0, 0.3))
        return cutoff.solved(self.mesh, halfspace.Fields(patch, 1.0, 0.3), self.solver, chi)


def entry(matrix, degree, row, column):
    """D of two functions named as in `10z`."""
    table = basis.powers(degree).tolist()
    places = [3 * table.index([int(name[0]), int(name[1])]) + "xyz".index(name[2]) for name in (row, column)]
    return 0.5 * (matrix[places[0], places[1]] + matrix[places[1], places[0]])


def clamped(*edges, young=1.0):
    """A block of quadratic bricks, clamped below."""
    return Example(mesh.grid_mesh(edges, "C3D20", young, node_sets=bottom(edges[2][-1])))


SQUARE = basis.Patch((0.0, 0.0), (1.0, 1.0), 2)


@pytest.fixture(scope="module")
def block():
    """4 x 4 x 4, clamped below."""
    return clamped(EVEN, EVEN, EVEN + 2.0)


@pytest.fixture(scope="module")
def of_block(block):
    """Its Remainder by images, degree 2."""
    return block.by_images(SQUARE)


# ---------------------------------------------------------------- basis and half-space


def test_functions_are_orthonormal_and_ordered_by_total_degree():
    patch = basis.Patch((0.3, -0.2), (2.0, 0.5), 5)
    points, weights = patch.quadrature(8, 8)
    values = patch.values(*points.T)
    assert np.allclose(values.T @ (values * weights[:, None]), np.eye(patch.count), atol=1e-13)
    assert np.all(np.diff(basis.powers(5).sum(axis=1)) >= 0) and basis.powers(2)[1].tolist() == [1, 0]


def test_means_over_cells_are_those_of_the_functions():
    patch = basis.Patch((0.3, -0.2), (2.0, 0.5), 4)
    means = patch.cell_means((3, 3))
    cell = basis.Patch((0.3 + 4.0 / 3.0, -0.2), (2.0 / 3.0, 0.5 / 3.0), 0)  # third in x, second in y
    points, weights = cell.quadrature(5, 5)
    assert np.allclose(means[5], patch.values(*points.T).T @ weights / weights.sum(), atol=1e-13)


def test_products_of_degrees_in_x_and_y_have_their_own_means_and_compliance():
    patch = basis.Patch((0.3, -0.2), (2.0, 0.5), (5, 2))
    points, weights = patch.quadrature(8, 8)
    values = patch.values(*points.T)
    assert patch.count == 18 and patch.powers.max(axis=0).tolist() == [5, 2]
    assert np.allclose(values.T @ (values * weights[:, None]), np.eye(18), atol=1e-13)
    assert np.allclose(patch.cell_means((4, 3)).T @ np.ones(12) / 12, [0.5] + [0.0] * 17, atol=1e-13)
    whole = basis.Patch((0.3, -0.2), (2.0, 0.5), 7)
    place = 3 * np.array([whole.powers.tolist().index(pair) for pair in patch.powers.tolist()])
    place = (place[:, None] + np.arange(3)).ravel()
    found = halfspace.projected(whole, 1.0, 0.3)[np.ix_(place, place)]
    assert np.allclose(halfspace.projected(patch, 1.0, 0.3), found, atol=1e-12)


def test_the_definiteness_tells_polynomials_of_a_high_degree_apart():
    patch = basis.Patch((0.0, 0.0), (3.0, 0.5), (24, 2))
    definite = checks.Definiteness(patch, 1.0, 0.3)
    assert np.linalg.cond(definite.root) < 1e4
    assert definite.smallest(0.5 * halfspace.projected(patch, 1.0, 0.3)) == 1.0


def test_half_space_fields_are_the_reference_numbers():
    fields = halfspace.Fields(basis.Patch((0.0, 0.0), (1.0, 1.0), 0), 1.0, 0.3)
    point = np.array([[2.0, 0.5, 1.0]])
    u, traction = fields.displacement(point)[0], fields.stress(point)[0, 0]
    assert np.allclose(u[:, 2], [0.02668022, 0.00599618, 0.29643054], atol=5e-9)
    assert np.allclose(u[:, 0], [0.3315046, 0.02187705, 0.10875516], atol=5e-8)
    assert np.allclose(traction[:, 2], [-0.04528066, -0.00806581, -0.03756022], atol=5e-9)
    assert np.allclose(traction[:, 0], [-0.09695185, -0.01964929, -0.05985685], atol=5e-9)


def test_gradients_are_those_of_the_displacements():
    fields = halfspace.Fields(basis.Patch((0.1, 0.0), (1.0, 0.7), 3), 2.0, 0.2)
    point, step = np.array([[0.4, 0.3, 0.8], [-1.5, 0.2, 0.1]]), 1e-5
    for axis in range(3):
        difference = step * np.eye(3)[axis]
        slope = (fields.displacement(point + difference) - fields.displacement(point - difference)) / (2.0 * step)
        assert np.allclose(fields.gradient(point)[:, :, axis], slope, atol=1e-8)


def test_tractions_on_the_surface_vanish_beside_the_patch():
    fields = halfspace.Fields(SQUARE, 1.0, 0.3)
    assert np.max(np.abs(fields.stress(np.array([[1.4, 0.3, 0.0], [0.2, -3.0, 0.0]]))[:, 2])) < 1e-9


def test_compliance_of_cells_converges_to_the_projected_one():
    projected = halfspace.projected(SQUARE, 1.0, 0.3)
    assert np.allclose(projected, projected.T, atol=1e-13)
    for n, most in ((10, 8e-3), (20, 2.5e-3)):
        means = np.kron(SQUARE.cell_means((n, n)), np.eye(3))
        cells = 4.0 / n**2 * means.T @ halfspace.cell_compliance((1.0, 1.0), (n, n), 1.0, 0.3) @ means
        assert np.max(np.abs(cells - projected)) < most * 2.1


# ---------------------------------------------------------------- stiffness


def one_element(kind):
    """A mesh of one distorted element."""
    family = mesh.SHAPES[mesh.KINDS[kind]].family
    points = family.nodes + 0.03 * np.sin(np.arange(3 * len(family.nodes))).reshape(-1, 3)
    found = mesh.Block(kind, np.array([1]), np.arange(len(points))[None, :], np.array([3.0]), np.array([0.25]))
    return mesh.Mesh(points, [found])


@needs_calculix
@pytest.mark.parametrize("kind", ["C3D20", "C3D20R", "C3D8", "C3D4"])
def test_calculix_and_this_program_assemble_the_same_stiffness(kind):
    body = one_element(kind)
    own, other = stiffness.assembled(body), stiffness.of_calculix(body, CCX)
    assert np.max(np.abs((own - other).toarray())) < 1e-10 * np.max(own.diagonal())


@needs_calculix
@pytest.mark.parametrize("kind", ["C3D8I", "C3D10", "C3D6", "C3D15"])
def test_calculixs_stiffness_does_not_resist_rigid_motions(kind):
    body = one_element(kind)
    matrix = stiffness.stiffness(body, "calculix", CCX)
    assert matrix.shape[0] == 3 * len(body.nodes) and stiffness.rigid_force(matrix, body.nodes) < 1e-12


@needs_calculix
def test_incompatible_modes_bend_a_beam_as_quadratic_bricks_do():
    """A cantilever of one layer of bricks, 8 long and 1 high, by a force at its end; 4 F l^3/(E b h^3)."""
    body = mesh.grid_mesh((np.linspace(0.0, 8.0, 9), [0.0, 1.0], [0.0, 1.0]), "C3D8I")
    fixed = np.repeat(body.nodes[:, 0] < 1e-9, 3)
    solver = solve.Solver(stiffness.of_calculix(body, CCX), body.nodes, fixed)
    force = np.zeros((len(fixed), 1))
    end = np.flatnonzero(body.nodes[:, 0] > 8.0 - 1e-9)
    force[3 * end + 2] = 0.25
    deflection = solver(force, np.zeros((fixed.sum(), 1)))[3 * end + 2].mean()
    assert deflection == pytest.approx(4.0 * 8.0**3, rel=0.03)


def test_a_missing_calculix_is_named_with_its_package():
    with pytest.raises(Error, match="no-such-ccx: install the Debian package calculix-ccx"):
        stiffness.of_calculix(one_element("C3D8"), "no-such-ccx")


# ---------------------------------------------------------------- images

LAYER = {
    ("00z", "00z"): (-1.374154570, -1.082455029, -0.699391676),
    ("00x", "00x"): (-1.196352841, -0.797564327, -0.463065920),
    ("10z", "00x"): (-0.144348727, -0.110503367, -0.051192014),
    ("10x", "00z"): (0.144348727, 0.110503367, 0.051192014),
    ("10z", "10z"): (-0.362599552, -0.170421589, -0.042916786),
    ("20z", "00z"): (0.119799525, 0.066660369, 0.018386176),
    ("20z", "20z"): (-0.141201495, -0.034818822, -0.003084913),
}
NEAR = [0.0, 0.5, 1.0, 1.5, 2.2, 3.3, 5.0]
WIDE = np.array([-x for x in NEAR[:0:-1]] + NEAR)


@pytest.fixture(scope="module", params=[0, 1, 2], ids=["H=0.5", "H=1", "H=2"])
def layer(request):
    """(H, its column in LAYER, D of degree 4) of a layer on a rigid base, as a wide block."""
    height = (0.5, 1.0, 2.0)[request.param]
    scale = max(1.0, height)
    body = clamped(scale * WIDE, scale * WIDE, np.linspace(0.0, height, 3))
    return height, request.param, body.by_images(basis.Patch((0.0, 0.0), (1.0, 1.0), 4)).compliance


def test_a_layer_on_a_rigid_base_has_the_reference_numbers(layer):
    # of the norm: the block is finite, and the mesh coarse, for H = 2 with 2 x 2 elements under the patch
    height, column, compliance = layer
    norm = np.linalg.norm(compliance, 2)
    for names, values in LAYER.items():
        assert entry(compliance, 4, *names) == pytest.approx(
            values[column], abs=(1.2e-3 if height > 1.0 else 6e-4) * norm
        ), names


def test_eigenvalues_of_layers_are_the_reference_numbers(layer):
    table = {0.5: (0.121, 0.197, 0.199), 1.0: (0.308, 0.364, 0.363), 2.0: (0.553, 0.578, 0.578)}
    height, _, compliance = layer
    for degree, value in zip((0, 2, 4), table[height]):
        patch = basis.Patch((0.0, 0.0), (1.0, 1.0), degree)
        found = checks.Definiteness(patch, 1.0, 0.3).smallest(
            checks.symmetric(compliance[: 3 * patch.count, : 3 * patch.count])
        )
        assert found == pytest.approx(value, abs=2e-3)


def test_a_thin_layer_is_indefinite_with_one_function_and_rejected():
    side = [-2.0, -1.4, -1.0, -0.5, 0.0, 0.5, 1.0, 1.4, 2.0]
    body = clamped(side, side, [0.0, 0.06, 0.125])
    compliance = body.by_images(basis.Patch((0.0, 0.0), (1.0, 1.0), 0)).compliance
    definite = checks.Definiteness(basis.Patch((0.0, 0.0), (1.0, 1.0), 0), 1.0, 0.3)
    assert definite.smallest(compliance) == pytest.approx(-0.048, abs=6e-3)  # a coarse mesh
    with pytest.raises(Error, match="not positive: smallest eigenvalue -0.0.*degree 0, patch 2 x 2 m: use a higher"):
        definite.need_positive(compliance)


def test_a_clamped_block_has_the_reference_numbers(of_block):
    values = {("00x", "00x"): 5.4346, ("00z", "00z"): -0.0530, ("00x", "10z"): 0.7052}
    values.update({("10z", "10z"): 0.1180, ("20z", "20z"): 0.0046})
    for names, value in values.items():
        assert entry(of_block.compliance, 2, *names) == pytest.approx(value, abs=3e-3 * 5.4346), names


def test_a_patch_near_an_edge_has_the_reference_numbers():
    x, z = [-3.0, -2.0, -1.0, 0.0, 1.0, 2.5, 5.0, 8.0], [0.0, 1.0, 2.0, 3.5, 5.5, 8.0]
    y = [-8.0, -5.0, -3.0, -1.5, -0.5, 0.5, 1.5, 3.0, 5.0, 8.0]
    compliance = clamped(x, y, z).by_images(basis.Patch((0.0, 0.0), (1.0, 1.0), 0)).compliance
    for names, value in {
        ("00x", "00x"): 0.8273,
        ("00y", "00y"): 0.3370,
        ("00z", "00z"): -0.0890,
        ("00x", "00z"): -0.2195,
    }.items():
        assert entry(compliance, 0, *names) == pytest.approx(value, abs=5e-3), names


def test_the_compliance_is_symmetric_and_that_of_a_symmetric_block(of_block):
    compliance = of_block.compliance
    assert checks.asymmetry(compliance) < 1e-8
    for one, other in (("00x", "00y"), ("10z", "01z"), ("10x", "01y")):
        assert entry(compliance, 2, one, one) == pytest.approx(entry(compliance, 2, other, other), rel=1e-9)
    assert abs(entry(compliance, 2, "00x", "00z")) < 1e-9


LOPSIDED = (
    np.array([-1.7, -1.0, 0.0, 1.0, 2.0, 3.0]),
    np.array([-2.0, -1.0, 0.0, 1.0, 2.5]),
    np.array([0.0, 1.0, 2.0, 3.0]),
)


def lopsided(scale=1.0, young=1.0, turn=EYE, shift=0.0, view=EYE):
    """D of degree 1 of a small block near an edge: its model scaled and moved by a rotation and a shift, its frame
    moved alike and then turned."""
    body = mesh.grid_mesh([scale * e for e in LOPSIDED], "C3D20", young, node_sets=bottom(3.0 * scale))
    body.nodes = body.nodes @ turn + shift
    example = Example(body.turned(np.full(3, shift), view @ turn))
    return example.by_images(basis.Patch((0.0, 0.0), (scale, scale), 1), young).compliance


def test_the_compliance_scales_with_length_over_modulus():
    # D is per length and modulus; phi is in 1/m
    assert np.allclose(lopsided(1e-3, 2e11), lopsided() * 1e-3 / 2e11, rtol=1e-7, atol=1e-22)


def test_a_rigid_motion_of_the_model_changes_nothing():
    axis = np.array([1.0, 2.0, -0.5]) / np.linalg.norm([1.0, 2.0, -0.5])
    cross = np.cross(np.eye(3), axis)
    turn = np.eye(3) + np.sin(0.7) * cross + (1.0 - np.cos(0.7)) * cross @ cross
    assert np.allclose(lopsided(turn=turn, shift=3.0), lopsided(), atol=1e-8)


def test_half_a_turn_about_z_changes_the_sign_of_odd_couplings():
    turned = lopsided(view=np.diag([-1.0, -1.0, 1.0]))
    sign = np.array([(-1.0) ** (sum(power) + (d < 2)) for power in basis.powers(1) for d in range(3)])
    assert np.allclose(turned, lopsided() * np.outer(sign, sign), atol=1e-8)


# ---------------------------------------------------------------- cut-off


def test_the_cut_off_falls_from_1_to_0_within_its_box_and_its_gradient_is_its_own(block):
    chi = cutoff.widest(block.mesh, SQUARE, block.supported, block.mesh.surface_faces("TOP"), 1e-6, (1.0, 0.3))
    assert np.allclose(chi.outer[1], [2.0, 2.0, 3.0]) and np.allclose(chi.outer[0, :2], -2.0)
    x = np.array([[0.9, -0.9, 0.1], [1.7, 0.0, 0.3], [0.3, -1.5, 2.2], [1.9, 1.9, 2.9], [2.1, 0.0, 0.0]])
    assert chi.values(x)[0] == 1.0 and chi.values(x)[4] == 0.0 and 0.0 < chi.values(x)[2] < 1.0
    for axis in range(3):
        step = 1e-6 * np.eye(3)[axis]
        slope = (chi.values(x + step) - chi.values(x - step)) / 2e-6
        assert np.allclose(chi.gradients(x)[:, axis], slope, atol=1e-8)


def test_cut_off_and_images_agree(block, of_block):
    found = block.by_cutoff(SQUARE).compliance
    # measured 1.0e-2 with 8 bricks a side, 4.5e-3 with 10
    assert np.linalg.norm(found - of_block.compliance, 2) < 1.3e-2 * np.linalg.norm(of_block.compliance, 2)
    assert checks.asymmetry(found) < 1e-12


def weights(points, patch):
    """int N phi_j (nodes, m) of linear shape functions on triangles between the points (n, 2)."""
    local, weight = simplex_rule(max(patch.largest) // 2 + 2)
    corners = points[Delaunay(points).simplices]
    sides = corners[:, 1:] - corners[:, :1]
    area = np.abs(np.linalg.det(sides))
    shape = np.stack([1.0 - local.sum(axis=1), *local.T], axis=1)
    x = np.einsum("qk,nkx->nqx", shape, corners)
    values = patch.values(*x.reshape(-1, 2).T).reshape(*x.shape[:2], -1)
    nodal = np.einsum("qk,nqj,q,n->nkj", shape, values, weight, area)
    out = np.zeros((len(points), patch.count))
    np.add.at(out, Delaunay(points).simplices, nodal)
    return out


def retained(body):
    """Nodes of the patch."""
    x = body.mesh.nodes
    return np.flatnonzero((np.abs(x[:, 2]) < 1e-9) & (np.max(np.abs(x[:, :2]), axis=1) < 1.0 + 1e-9))


def condensed(body):
    """Stiffness of the retained nodes with all others free."""
    rows = (3 * retained(body)[:, None] + np.arange(3)).ravel()
    force = np.zeros((body.matrix.shape[0], len(rows)))
    force[rows, np.arange(len(rows))] = 1.0
    return np.linalg.inv(body.solver(force, np.zeros((len(body.solver.held), len(rows))))[rows])


def directly(body, patch):
    """D by the direct method: of the displacements of the retained nodes, less accurate."""
    matrix = condensed(body)
    force = np.kron(weights(body.mesh.nodes[retained(body), :2], patch), np.eye(3))
    return force.T @ np.linalg.solve(matrix, force) - halfspace.projected(patch, 1.0, 0.3)


def test_the_cut_off_serves_a_body_of_two_materials(block):
    """The lower half stiffer: the direct method, 4 per cent off, is the reference."""
    body = clamped(EVEN, EVEN, EVEN + 2.0)
    soft = body.mesh.nodes[body.mesh.blocks[0].nodes].mean(axis=1)[:, 2] < 2.0
    body.mesh.blocks[0].young[~soft] = 5.0
    body.matrix = stiffness.assembled(body.mesh)
    body.solver = solve.Solver(body.matrix, body.mesh.nodes, body.solver.fixed)
    patch = basis.Patch((0.0, 0.0), (1.0, 1.0), 1)
    found, reference = body.by_cutoff(patch).compliance, directly(body, patch)
    stiffer = np.linalg.norm(found - block.by_images(patch).compliance, 2)
    assert np.linalg.norm(found - reference, 2) < 0.06 * np.linalg.norm(found, 2) < 0.1 * stiffer
