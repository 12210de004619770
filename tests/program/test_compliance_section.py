"""Sections in plane strain: half-plane fields, elements, large bodies, direct solutions, contacts, refusals."""

import h5py
import numpy as np
import pytest

import petsam as package
import sections
from conftest import PROGRAM, execute
from petsam.apps.compliance import basis, checks, deck, halfplane, stiffness
from support import assert_same, l2
from test_compliance_command import compliance  # noqa: F401

NU = 0.3
SHEAR = 0.5 / (1.0 + NU)  # of E = 1
KINDS = ("CPE3", "CPE4", "CPE6", "CPE8", "CPE8R")
PLANE = dict(
    elasticity="plane", gap_type="ellipsoid", gap_radius_x=100, gap_radius_y="inf", gap_radius1=None, gap_radius2=None,
    body1_young="inf", body2_young=1, body2_poisson=NU, grid_size=2, output_fields="all",
)  # fmt: skip


def block(path, n=8, half=2.0, kind="CPE8", **more):
    """A deck of 2 half by 2 half with n elements over half, held below; its nodes and elements."""
    nodes, elements = sections.grid(np.linspace(-half, half, 2 * n + 1), np.linspace(0.0, 2.0 * half, 2 * n + 1), kind)
    sets = {"BOTTOM": nodes[:, 1] == 2.0 * half, "LEFT": nodes[:, 0] == -half}
    sections.deck(path, nodes, elements, kind, sets, {"TOP": nodes[:, 1] == 0.0}, **more)
    return nodes, elements


def found(path, degree=4, patch=2.0, **more):
    """The Compliance of a deck, held at BOTTOM."""
    return package.compliance.of_deck(path, patch, "TOP", "BOTTOM", degree=degree, **more)


# ---------------------------------------------------------------- half-plane


def test_the_half_planes_stress_is_in_equilibrium_and_that_of_a_uniform_strip():
    fields = halfplane.LineFields(basis.line(0.0, 1.0, 3), 1.0, NU)
    points = np.array([[0.3, 0.0, 0.7], [2.0, 0.0, 0.4]])
    step, divergence = 1e-5, 0.0
    for axis in (0, 2):
        move = step * np.eye(3)[axis]
        divergence = divergence + (fields.stress(points + move) - fields.stress(points - move))[:, :, axis] / (2 * step)
        slope = (fields.displacement(points + move) - fields.displacement(points - move)) / (2 * step)
        assert np.allclose(fields.gradient(points)[:, :, axis], slope, atol=1e-8)
    assert np.max(np.abs(divergence)) < 1e-8
    x, z = points[:, 0], points[:, 2]
    t1, t2 = np.arctan2(z, x - 1.0), np.arctan2(z, x + 1.0)
    unit = np.sqrt(0.5)  # the function of degree 0
    stress = fields.stress(points)
    assert np.allclose(stress[:, 2, 2, 2], -unit / (2 * np.pi) * (2 * (t1 - t2) - np.sin(2 * t1) + np.sin(2 * t2)))
    assert np.allclose(stress[:, 0, 0, 2], -unit / (2 * np.pi) * (2 * (t1 - t2) + np.sin(2 * t1) - np.sin(2 * t2)))
    assert np.allclose(stress[:, 1, 2, 1], -unit / np.pi * (t1 - t2))
    assert np.allclose(stress[:, 1, 1], NU * (stress[:, 0, 0] + stress[:, 2, 2]))


def test_the_half_planes_cells_are_petsams(solve):
    """The displacement by petsam's pressure of a flat punch is uniform."""
    r = solve(
        PLANE, dict(grid_n=40, gap_radius_x="inf", disp_z=0.01, plane_datum=2, friction=0, allow_edge_contact=True)
    )
    kernel = halfplane.cell_compliance(1.0, 40, 1.0, NU)
    assert np.allclose(kernel, kernel.T, atol=1e-15)
    assert np.allclose(kernel[2::3, 2::3] @ r.pressure.ravel(), 0.01, rtol=1e-6)


# ---------------------------------------------------------------- elements


@pytest.mark.parametrize("kind", KINDS)
def test_uniform_strains_are_exact_in_distorted_elements(kind, tmp_path):
    """Of a section, of shear along y too; and forces of the boundary alone."""
    nodes, elements = sections.grid(np.linspace(0.0, 3.0, 4), np.linspace(0.0, 2.0, 3), kind)
    corners = elements[:, : 3 if kind in ("CPE3", "CPE6") else 4]
    moved = nodes.copy()
    inner = np.all((nodes > 0.0) & (nodes < [3.0, 2.0]), axis=1)
    chosen = np.intersect1d(np.flatnonzero(inner), corners)
    moved[chosen] += 0.15 * np.sin(1.0 + np.arange(2 * len(chosen)).reshape(-1, 2))
    count = corners.shape[1]
    for one in elements:
        for k in range(len(one) - count):
            moved[one[count + k]] = 0.5 * (moved[one[k]] + moved[one[(k + 1) % count]])
    path = sections.deck(tmp_path / "a.inp", moved, elements, kind, {}, {})
    mesh = deck.read(path).mesh.turned(np.zeros(3), np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]]))
    assert np.allclose(mesh.nodes[:, [0, 2]], moved) and not np.any(mesh.nodes[:, 1])
    matrix = stiffness.stiffness(mesh)
    assert np.max(np.abs(matrix - matrix.T)) < 1e-14
    strain = np.array([[1.0, 0.0, 0.3], [0.4, 0.0, -0.7], [0.5, 0.0, -0.2]])
    force = (matrix @ (mesh.nodes @ strain.T).ravel()).reshape(-1, 3)
    assert np.max(np.abs(force[inner])) < 1e-14
    right = force[mesh.nodes[:, 0] == 3.0].sum(axis=0)
    lame = 2.0 * SHEAR * NU / (1.0 - 2.0 * NU)
    stress = [2.0 * SHEAR + lame * 0.8, SHEAR * 0.4, SHEAR * 0.8]
    assert np.allclose(right, 2.0 * np.array(stress), atol=1e-13)


@pytest.mark.parametrize("kind, error", [("CPE3", 4e-2), ("CPE4", 2e-2), ("CPE6", 2e-3), ("CPE8R", 2e-3)])
def test_all_elements_converge_to_one_compliance(kind, error, tmp_path):
    block(tmp_path / "fine.inp", 24)
    block(tmp_path / "a.inp", 8, kind=kind)
    fine, own = (found(tmp_path / name).bodies[0].compliance for name in ("fine.inp", "a.inp"))
    assert np.max(np.abs(own - fine)) < error * np.max(np.abs(fine))


# ---------------------------------------------------------------- large bodies, closed forms


def half_disc(path, radius, n=8):
    """A half-disc whose arc is held."""
    nodes, elements = sections.grid(np.linspace(-1.0, 1.0, 2 * n + 1), np.linspace(0.0, 1.0, n + 1))
    rim = (np.abs(nodes[:, 0]) == 1.0) | (nodes[:, 1] == 1.0)
    disc = radius * nodes * np.sqrt(1.0 - 0.5 * nodes[:, ::-1] ** 2)
    return sections.deck(path, disc, elements, "CPE8", {"BOTTOM": rim}, {"TOP": disc[:, 1] == 0.0})


def test_a_large_half_disc_is_the_half_plane_but_for_a_constant(tmp_path):
    """It grows by the logarithm of the radius; the rest falls by its square, the rotation by a force by the radius."""
    d = [found(half_disc(tmp_path / f"{r}.inp", r), 2).bodies[0].compliance for r in (12.5, 25.0, 50.0)]
    factor = 2.0 * np.log(2.0) / np.pi / SHEAR
    grown = factor * np.array([1.0 - NU, 1.0, 1.0 - NU])
    error = [np.max(np.abs(np.diag(b - a)[:3] - grown)) for a, b in zip(d, d[1:])]
    assert error[1] < 1e-3 * grown[0] and error[0] / error[1] == pytest.approx(4.0, rel=0.05)
    turn, rest = [one[[0, 2], [5, 3]].copy() for one in d], []
    for one in d:
        one[[0, 1, 2, 0, 2, 5, 3], [0, 1, 2, 5, 3, 0, 2]] = 0.0
        rest.append(np.max(np.abs(one)))
    assert np.allclose(turn[1] / turn[2], 2.0, rtol=0.01)
    assert rest[2] < 4e-4 and rest[0] / rest[1] == pytest.approx(4.0, rel=0.05)


# ---------------------------------------------------------------- direct solutions


def polynomials(patch):
    """The tractions phi_i in z and x, as functions of x, 0 outside of the patch."""
    for k in range(patch.count):
        for axis in (1, 0):

            def traction(x, k=k, axis=axis):
                inside = np.abs(x) <= patch.half[0]
                value = patch.values(np.clip(x, -patch.half[0], patch.half[0]), np.zeros(len(x)))[:, k] * inside
                return np.stack([value if axis == d else 0.0 * value for d in range(2)], axis=1)

            yield traction


def direct(nodes, elements, held, patch):
    """The body's compliance (2 m, 2 m) for z, x of each function, less the half-plane's."""
    force = np.stack([sections.forces(nodes, elements, one) for one in polynomials(patch)], axis=1)
    u = sections.displacements(nodes, elements, held, force).reshape(len(force), -1)
    n = 800
    means = patch.cell_means((n, 1))
    area = 2.0 * patch.half[0] / n
    kernel = halfplane.cell_compliance(patch.half[0], n, 1.0, NU)
    own = np.einsum("ai,akbl,bj->ikjl", means, kernel.reshape(n, 3, n, 3), means) * area
    own = own[:, [2, 0]][:, :, :, [2, 0]]
    return force.T @ u - own.reshape(2 * patch.count, -1)


def of_both(matrix):
    """That of z, x of each function."""
    m = len(matrix) // 3
    return matrix.reshape(m, 3, m, 3)[:, [2, 0]][:, :, :, [2, 0]].reshape(2 * m, 2 * m)


def test_the_compliance_is_that_of_a_direct_solution(tmp_path):
    """By tractions on a mesh of the tests' own, whose error falls with the elements'."""
    block(tmp_path / "fine.inp", 16)
    exact = of_both(found(tmp_path / "fine.inp", 3).bodies[0].compliance)
    errors = []
    for n in (6, 12, 24):
        nodes, elements = block(tmp_path / "a.inp", n)
        other = direct(nodes, elements, nodes[:, 1] == 4.0, basis.line(0.0, 1.0, 3))
        errors.append(np.max(np.abs(other - exact)))
    print(errors)
    assert errors[2] < 3e-3 * np.max(np.abs(exact)) and errors[0] > 2.0 * errors[1] > 3.0 * errors[2]


def test_a_line_of_symmetry_is_not_left(tmp_path):
    nodes, elements = block(tmp_path / "a.inp", 16)
    given = found(tmp_path / "a.inp", 2, patch=1.0, symmetry="LEFT")
    held = np.stack([(nodes[:, 0] == -2.0) | (nodes[:, 1] == 4.0), nodes[:, 1] == 4.0], axis=1)
    other = direct(nodes, elements, held, basis.line(0.0, 0.5, 2))
    exact = of_both(given.bodies[0].compliance)
    assert given.bodies[0].method == "cutoff" and np.max(np.abs(other - exact)) < 1e-2 * np.max(np.abs(exact))


@pytest.mark.parametrize("method", ["image", "cutoff"])
def test_the_matrix_is_symmetric_and_both_methods_agree(method, tmp_path):
    block(tmp_path / "a.inp", 12, half=4.0)
    one, image = (found(tmp_path / "a.inp", method=which) for which in (method, "image"))
    d, other = one.bodies[0].compliance, image.bodies[0].compliance
    assert one.checks[0]["asymmetry"] < 1e-12 and one.checks[0]["smallest_eigenvalue"] > 0.1
    assert np.max(np.abs(d - other)) < 1e-3 * np.max(np.abs(other))
    m = d.reshape(5, 3, 5, 3)
    assert np.max(np.abs(m[:, 1][:, :, [0, 2]])) < 1e-12  # antiplane shear is by itself


def test_the_stresses_of_both_methods_approach_each_other(tmp_path):
    """Those of the cut-off are of its ramps, which finer elements resolve."""
    errors = []
    for n in (12, 24):
        block(tmp_path / "a.inp", n, half=4.0)
        one, other = (found(tmp_path / "a.inp", 0, method=which).bodies[0].stress[1] for which in ("cutoff", "image"))
        assert one.shape == (1, 3, 49, 1, 49, 6)
        errors.append(np.max(np.abs(one - other)) / np.max(np.abs(other)))
    print(errors)
    assert errors[1] < 0.06 and errors[1] < 0.4 * errors[0]


def test_decks_in_other_planes_and_units_are_the_same(tmp_path):
    block(tmp_path / "a.inp", 4)
    block(tmp_path / "b.inp", 4, plane="xz")
    nodes, elements = sections.grid(np.linspace(-2e3, 2e3, 9), np.linspace(0.0, 4e3, 9))
    sets, top = {"BOTTOM": nodes[:, 1] == 4e3}, {"TOP": nodes[:, 1] == 0.0}
    sections.deck(tmp_path / "c.inp", nodes, elements, "CPE8", sets, top, young=1e-6)
    one, two = (found(tmp_path / name).bodies[0].compliance for name in ("a.inp", "b.inp"))
    mm = found(tmp_path / "c.inp", units="mm").bodies[0].compliance
    assert np.allclose(one, two, rtol=0, atol=1e-12) and np.allclose(one, mm, rtol=0, atol=1e-9)


@pytest.mark.parametrize("kind", ["triangle", "quad", "triangle6", "quad8"])
def test_meshes_of_meshio_are_the_deck(kind, tmp_path):
    meshio = pytest.importorskip("meshio", reason="meshio is not installed")
    nodes, elements = block(
        tmp_path / "a.inp", 6, kind=dict(triangle="CPE3", quad="CPE4", triangle6="CPE6").get(kind, "CPE8")
    )
    points = nodes * [1.0, -1.0]
    sets = {name: np.flatnonzero(mask) for name, mask in (("T", nodes[:, 1] == 0.0), ("B", nodes[:, 1] == 4.0))}
    given = meshio.Mesh(points, [(kind, elements)], point_sets=sets)
    one = package.compliance.of_mesh(given, 2.0, 1.0, NU, contact="T", supports="B", degree=3)
    assert np.allclose(one.bodies[0].compliance, found(tmp_path / "a.inp", 3).bodies[0].compliance, rtol=0, atol=1e-11)


# ---------------------------------------------------------------- load cases


def test_a_load_case_is_that_of_a_direct_solution(tmp_path):
    """A pressure and a force of a deck whose section is 2 thick."""
    step = ["*STEP", "*STATIC", "*CLOAD", "LOADED, 1, 0.02", "*END STEP"]
    nodes, elements = sections.grid(np.linspace(-3.0, 3.0, 25), np.linspace(0.0, 4.0, 17))
    held, loaded = nodes[:, 0] == -3.0, np.all(nodes == [3.0, 4.0], axis=1)
    sets = {"BOTTOM": held, "LOADED": loaded}
    sections.deck(
        tmp_path / "a.inp", nodes, elements, "CPE8", sets, {"TOP": nodes[:, 1] == 0.0}, lines=step, section="2.0"
    )
    case = found(tmp_path / "a.inp", 4, 1.0, cases={"pull": 1}).bodies[0].cases["pull"]
    force = np.zeros((len(nodes), 2))
    force[loaded, 0] = 0.01
    u = sections.displacements(nodes, elements, held, force.ravel())
    patch = basis.line(0.0, 0.5, 4)
    top = nodes[:, 1] == 0.0
    mine = top & (np.abs(nodes[:, 0]) <= 0.5)
    values = patch.values(nodes[mine, 0], nodes[mine, 1]) @ case.coefficients
    assert np.allclose(values[:, [0, 2]], u[mine], atol=2e-4 * np.max(np.abs(u))) and not np.any(values[:, 1])


# ---------------------------------------------------------------- contacts of petsam


@pytest.fixture(scope="module")
def section(tmp_path_factory):
    """The file of a block, degree 12."""
    path = tmp_path_factory.mktemp("section")
    block(path / "a.inp", 12)
    found(path / "a.inp", (12, 0)).write(path / "a.h5")
    return path / "a.h5"


def cells_of(n):
    """A mesh whose elements on the patch are n cells; nodes, elements, centres of the cells."""
    x = np.concatenate([np.linspace(-2.0, -1.0, 9)[:-1], np.linspace(-1.0, 1.0, n + 1), np.linspace(1.0, 2.0, 9)[1:]])
    z = np.concatenate([4.0 * (np.linspace(0.0, 1.0, 22) ** 2)])
    return *sections.grid(x, z), (np.arange(n) + 0.5) * 2.0 / n - 1.0


@pytest.mark.parametrize("ranks", [1, 2])
def test_a_contact_is_that_of_the_body_by_a_direct_solution(ranks, solve, section):
    """Under petsam's tractions a mesh has the displacement of the cylinder, in z and, where it sticks, in x."""
    n = 40
    given = dict(grid_n=n, disp_z=0.004, disp_x=2e-4, rot_y=0, friction=0.5, body2_compliance=section)
    r = solve(PLANE, given, ranks=ranks)
    p, q = r.pressure.ravel(), r.shear_x.ravel()
    nodes, elements, x = cells_of(n)
    edges = np.linspace(-1.0, 1.0, n + 1)

    def traction(at):
        cell = np.clip(np.searchsorted(edges, at) - 1, 0, n - 1)
        return np.stack([q[cell], p[cell]], axis=1) * (np.abs(at) < 1.0)[:, None]

    force = sections.forces(nodes, elements, traction)
    u = sections.displacements(nodes, elements, nodes[:, 1] == 4.0, force)
    top = np.flatnonzero(nodes[:, 1] == 0.0)
    at = top[[np.argmin(np.abs(nodes[top, 0] - one)) for one in x]]
    inner = p > 0.3 * p.max()
    assert 8 < np.sum(p > 0.0) < n
    assert np.allclose(u[at, 1][inner] + x[inner] ** 2 / 200.0, 0.004, atol=2e-6)
    stuck = inner & (np.abs(q) < 0.45 * p)
    assert np.sum(stuck) > 5 and np.allclose(u[at, 0][stuck], 2e-4, atol=1e-6)
    assert r["load_n"] == pytest.approx(np.sum(p) * 2.0 / n)
    assert_same(r, solve(PLANE, given), 0)


@pytest.mark.parametrize("body", [1, 2])
def test_stresses_below_a_contact_are_those_of_a_direct_solution(body, solve, launcher, section, tmp_path):
    """At Gauss points of elements of the tests' own under petsam's tractions; z points into either body."""
    n, row = 40, 7
    two = dict(body2_compliance=section)
    one = dict(body1_young=1, body1_poisson=NU, body2_young="inf", body2_poisson=None, body1_compliance=section)
    r = solve(PLANE, dict(grid_n=n, disp_z=0.004, disp_x=2e-4, rot_y=0, friction=0.5), one if body == 1 else two)
    p, q = r.pressure.ravel(), r.shear_x.ravel()
    sign = -1.0 if body == 1 else 1.0  # body 1 turned over about x: the shear on it is -q
    nodes, elements, x = cells_of(n)
    edges = np.linspace(-1.0, 1.0, n + 1)

    def traction(at):
        cell = np.clip(np.searchsorted(edges, at) - 1, 0, n - 1)
        return np.stack([sign * q[cell], p[cell]], axis=1) * (np.abs(at) < 1.0)[:, None]

    u = sections.displacements(nodes, elements, nodes[:, 1] == 4.0, sections.forces(nodes, elements, traction))
    lines = np.unique(nodes[:, 1])[::2]
    middle = nodes[elements].mean(axis=1)
    chosen = elements[(np.abs(middle[:, 0]) < 1.0) & (middle[:, 1] > lines[row]) & (middle[:, 1] < lines[row + 1])]
    chosen = chosen[np.argsort(nodes[chosen].mean(axis=1)[:, 0])]
    depth, wanted = sections.stresses(nodes, chosen, u)
    given = dict(input=r.path, body=body, depths=depth, output=tmp_path / "s.h5")
    execute(launcher, tmp_path, [given], 1, 0, program=PROGRAM.with_name("petsam-stress"))
    with h5py.File(tmp_path / "s.h5") as file:
        found = np.stack([file[f"stress_{name}"][-1].ravel() for name in ("xx", "zz", "xz")])
        across = file["stress_yy"][-1].ravel()
    scale = np.abs(wanted[1]).max()
    print(np.abs(found - wanted).max(axis=1) / scale)
    assert np.abs(found - wanted).max() < 1e-3 * scale
    assert np.allclose(across, NU * (found[0] + found[1]), atol=1e-3 * scale)


def test_the_contact_has_no_datum_but_the_supports(solve, section):
    one, other = (solve(PLANE, dict(grid_n=40, disp_z=0.004, body2_compliance=section, plane_datum=d)) for d in (2, 30))
    free = solve(PLANE, dict(grid_n=40, disp_z=0.004, plane_datum=30))
    assert one["load_n"] == pytest.approx(other["load_n"], rel=1e-7) and l2(one.pressure, other.pressure) < 1e-6
    assert free["load_n"] < 0.8 * one["load_n"]


def test_two_equal_sections_share_the_approach(solve, section):
    """Neither has a datum; each approaches by half."""
    one = solve(PLANE, dict(grid_n=40, disp_z=0.004, body2_compliance=section))
    given = dict(body1_young=1, body1_poisson=NU, body1_compliance=section, body2_compliance=section)
    both = solve(PLANE, given, dict(grid_n=40, disp_z=0.008, gap_radius_x=50, plane_datum=7))
    assert l2(both.pressure, one.pressure) < 1e-6 and "plane_datum" not in both.run.stderr


def test_body_1_is_the_same_turned_over(solve, section):
    two = solve(PLANE, dict(grid_n=40, load_n=0.004, load_tx=0.001, friction=0.5, body2_compliance=section))
    swapped = dict(body1_young=1, body1_poisson=NU, body2_young="inf", body2_poisson=None, body1_compliance=section)
    one = solve(PLANE, dict(grid_n=40, load_n=0.004, load_tx=0.001, friction=0.5), swapped)
    assert l2(one.pressure[:, ::-1], two.pressure) < 1e-6
    assert one["disp_z"] == pytest.approx(two["disp_z"], rel=1e-8)


def test_a_section_is_for_plane_strain_alone(petsam, section):  # noqa: F811
    given = dict(body2_compliance=section, body2_young=1, body1_young="inf", grid_n=16, grid_size=2, load_n=1)
    said = petsam(given, dict(gap_type="sphere", gap_radius1=100, body2_poisson=NU), check=2).stderr
    assert "is of a section in plane strain: give -elasticity plane" in said
    with h5py.File(section, "r") as file:
        assert file.attrs["petsam_compliance"] == 2 and file.attrs["datum"] == 2.0


# ---------------------------------------------------------------- refusals


def test_what_a_section_cannot_be_is_named(compliance, tmp_path):  # noqa: F811
    block(tmp_path / "a.inp", 4)
    text = (tmp_path / "a.inp").read_text()
    always = ["--mesh", "a.inp", "--contact", "TOP", "--fixed", "BOTTOM", "--no-picture", "--degree", "2"]
    said = compliance(*always, "--patch", "2", "--pair", "TOP", check=3)[0]
    assert "are of one body: give both bodies nodes of their own" in said
    said = compliance(*always, "--patch", "2,1", check=2)[0]
    assert "does not vary along y: --patch X,Y has no meaning: give X alone" in said
    for kind, reason in (("CPS8", "is in plane stress"), ("CAX8", "is of a body of revolution")):
        (tmp_path / "b.inp").write_text(text.replace("CPE8", kind))
        assert f"element type {kind} {reason}" in compliance("--mesh", "b.inp", *always[2:], "--patch", "2", check=3)[0]
    assert "remove it" in compliance(*always, "--patch", "2", "--stiffness", "calculix", check=2)[0]
    two = "1.\n*SOLID SECTION, ELSET=ALL, MATERIAL=M\n2."
    for thin, says in (("0.", "has the thickness 0"), (two, "another thickness")):
        (tmp_path / "b.inp").write_text(text + thin + "\n")
        assert says in compliance("--mesh", "b.inp", *always[2:], "--patch", "2", check=3)[0]
    solid = "*ELEMENT, TYPE=C3D4, ELSET=ALL\n999, 1, 2, 3, 4\n*MATERIAL"
    (tmp_path / "b.inp").write_text(text.replace("*MATERIAL", solid))
    said = compliance("--mesh", "b.inp", *always[2:], "--patch", "2", check=3)[0]
    assert "has solid elements beside those of a section" in said
    compliance(*always, "--patch", "2", "-o", "a.h5")
    corner = ["--mesh", "a.inp", "--contact", "TOP", "--no-picture", "--patch", "2", "--fixed=2,-4,0:2,-4,0"]
    assert "is not supported" in compliance(*corner, check=3)[0]


def test_a_node_off_the_plane_and_a_corner_in_the_patch_are_named(compliance, tmp_path):  # noqa: F811
    nodes, elements = block(tmp_path / "a.inp", 4)
    text = (tmp_path / "a.inp").read_text()
    at = f"{nodes[4, 0]:.15e}, {-nodes[4, 1]:.15e}, "
    (tmp_path / "a.inp").write_text(text.replace(f"\n5, {at}{0.0:.15e}", f"\n5, {at}0.5"))
    words = ["--contact", "TOP", "--fixed", "BOTTOM", "--no-picture", "--degree", "2", "--patch", "2"]
    said = compliance("--mesh", "a.inp", *words, check=3)[0]
    assert f"that at {nodes[4, 0]:.3g}, {-nodes[4, 1]:.3g}, 0.5 is 0.5 off: give all in x and y" in said
    bent = nodes + np.stack([0.0 * nodes[:, 0], 0.3 * np.abs(nodes[:, 0]) * (1.0 - nodes[:, 1] / 4.0)], axis=1)
    sets = {"BOTTOM": nodes[:, 1] == 4.0}
    sections.deck(tmp_path / "b.inp", bent, elements, "CPE8", sets, {"TOP": nodes[:, 1] == 0.0})
    said = compliance("--mesh", "b.inp", *words, check=3)[0]
    assert "0.3 m off the plane of the frame, limit 0.1 m" in said and "beside corners by --center" in said
    compliance("--mesh", "b.inp", *words[:-1], "0.6", "--center=1,0", "--frame=0,0,0:1,-0.3,0:-0.3,-1,0", "-o", "b.h5")


def test_definiteness_of_a_line(tmp_path):
    definite = checks.Definiteness(basis.line(0.0, 1.0, 4), 1.0, NU)
    assert definite.smallest(np.zeros((15, 15))) == 1.0
    with pytest.raises(package.Error, match="the compliance is not positive"):
        definite.need_positive(-2.0 * np.eye(15))
