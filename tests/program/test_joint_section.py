"""Pairs of sections in plane strain: compliance, bolt and modes of a lap joint, its frequency and damping by a full
compliance without polynomials, several patches, pairs that nothing holds, the commands."""

import csv

import h5py
import numpy as np
import pytest

import laps
import petsam
import sections
from conftest import PROGRAM, execute
from petsam import joint
from petsam.apps.compliance import bolts, halfplane
from test_compliance_command import compliance  # noqa: F401

pytestmark = [
    pytest.mark.filterwarnings(f"ignore::petsam.{name}") for name in ("apps.joint.BackboneWarning", "AdviceWarning")
]

HALF, CELLS, DEGREE = 18e-3, 96, 12
FRAME = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0))
HELD = dict(supports="CLAMP")
BOLT = {"B": ("WASHER1", "WASHER2", laps.DIAMETER)}
PRELOAD = {"B": laps.TENSION}
MODULI = (laps.YOUNG, laps.POISSON)
OPTIONS = dict(grid_n=CELLS, friction=laps.FRICTION)


def made(path, degree=DEGREE, width=2.0 * HALF, **more):
    """The Compliance of the lap's deck."""
    more = {"bolts": BOLT, "modes": 14, "sensors": {"TIP": "TIP"}, "degree": (degree, 0), **(more or HELD)}
    return petsam.compliance.of_deck(path, width, "CONTACT2", pair="CONTACT1", units="mm", frame=FRAME, **more)


@pytest.fixture(scope="module")
def lap(tmp_path_factory):
    """The lap, with its deck as `path` and its compliance in the file `file`."""
    found = laps.Lap.made()
    folder = tmp_path_factory.mktemp("lap")
    found.path, found.file = folder / "lap.inp", folder / "lap.h5"
    found.write(found.path)
    found.compliance = made(found.path)
    found.compliance.write(found.file)
    return found


@pytest.fixture(scope="module")
def reference(lap):
    """Its Reference on the cells of the patch."""
    return laps.Reference(lap, HALF, CELLS)


# ---------------------------------------------------------------- compliance, bolt, modes


def test_the_modes_are_those_of_the_elements_in_their_plane(lap, reference):
    modes = lap.compliance.modes
    assert np.allclose(modes.omega, reference.omega, rtol=1e-7)
    tip = modes.sensors[:, 0, 1]  # upwards, as y of the deck
    assert np.allclose(np.abs(tip), np.abs(reference.tip), rtol=1e-5, atol=1e-6 * np.abs(tip).max())
    assert not np.any(modes.shapes.reshape(-1, 3, len(modes.omega))[:, 1])


def test_the_field_of_a_tension_and_the_compliance_are_the_elements(lap, reference):
    """Of tractions on the cells of the patch: the compliance lacks what polynomials miss."""
    body = lap.compliance.bodies[0]
    means, m = body.patch.cell_means((CELLS, 1)), body.patch.count
    field = (means @ body.cases["bolt_B"].coefficients[:, [0, 2]]).T.ravel()
    assert np.allclose(field, reference.bolt, rtol=0, atol=1e-7 * np.abs(field).max())
    matrix = reference.compliance
    assert np.max(np.abs(matrix - matrix.T)) < 1e-5 * np.max(np.abs(matrix))
    own = body.compliance.reshape(m, 3, m, 3)[:, [0, 2]][:, :, :, [0, 2]]
    found = np.einsum("ai,ikjl,bj->kalb", means, own, means) * 2.0 * HALF / CELLS
    kernel = 2.0 * halfplane.cell_compliance(HALF, CELLS, laps.YOUNG, laps.POISSON).reshape(CELLS, 3, CELLS, 3)
    for axis, place in enumerate((0, 2)):
        found[axis, :, axis] += kernel[:, place, :, place]
    assert np.max(np.abs(found.reshape(matrix.shape) - matrix)) < 1e-5 * np.max(np.abs(matrix))


def test_the_bolts_are_those_of_a_metre(lap):
    bolt = lap.compliance.bodies[0].bolts[0]
    assert bolt.stiffness == pytest.approx(laps.YOUNG * np.pi * laps.DIAMETER**2 / 4 / (2 * laps.HEIGHT) / laps.SPACING)
    mesh = lap.compliance.bodies[0].mesh.mesh
    washer, at = bolts.washer(mesh, "WASHER2"), mesh.nodes - [0.0, 0.0, laps.HEIGHT]
    moved = [0.1, 0.2, 0.3] + np.cross([0.0, -0.5, 0.0], at)
    assert np.allclose(washer.motion @ moved.ravel(), [0.1, 0.2, 0.3, 0.0, -0.5, 0.0])
    half = laps.Lap.made()
    half.write(lap.path.with_name("half.inp"), 2.0 * laps.SPACING)
    other = made(lap.path.with_name("half.inp"), 6).bodies[0]
    assert other.bolts[0].stiffness == pytest.approx(0.5 * bolt.stiffness)


# ---------------------------------------------------------------- joints


@pytest.fixture(scope="module")
def pressed(reference):
    """The contact of full compliance, pressed without friction."""
    return laps.Quasistatic(reference)


def backbone(path, forces, steps=12, **options):
    """The Pair of a file and its Backbone at modal forces, in so many steps of a half cycle."""
    pair = joint.Pair(path, PRELOAD, frictionless=True, **OPTIONS | options)
    squared = pair.structure.stuck_modes()[0][0] ** 2
    return pair, joint.backbone(pair.structure, np.array(forces) / squared, steps=steps)


def test_frequency_and_damping_are_those_of_the_full_compliance(lap, reference, pressed):
    pair, found = backbone(lap.file, [100.0, 200.0, 300.0, 400.0, 500.0])
    assert 2 * np.pi * found.linear == pytest.approx(pressed.omega, rel=3e-6)
    for alpha, frequency, damping in zip(found.alpha, found.frequency, found.damping):
        omega, zeta = pressed.point(alpha, 12)
        print(f"{alpha:g} {omega / pressed.omega:.6f} {zeta:.4e}: {2 * np.pi * frequency / omega - 1:.1e} "
              f"{damping / zeta - 1:.1e}")  # fmt: skip
        assert 2 * np.pi * frequency == pytest.approx(omega, rel=3e-5)
        assert damping == pytest.approx(zeta, rel=1e-2)
    assert np.all(np.diff(found.damping) > 0.0) and found.damping[-1] > 2e-4
    field = pair.structure.patches[0].contact.field("pressure").ravel()
    assert np.max(np.abs(field - pressed.preload.p)) < 5e-3 * field.max()
    load = np.sum(pressed.preload.p) * 2.0 * HALF / CELLS
    assert pair.tensions["B"] == pytest.approx(load, rel=1e-5)  # by equilibrium


def test_the_degree_decides_the_damping(lap, pressed):
    omega, zeta = pressed.point(300.0, 12)
    errors = []
    for degree in (4, 6, 8):
        _, found = backbone(lap.file, [300.0], lower=DEGREE - degree)
        errors.append((2 * np.pi * found.frequency[0] / omega - 1.0, found.damping[0] / zeta - 1.0))
    frequency, damping = np.abs(errors).T
    assert frequency[0] > 1e-4 > 3e-5 > max(frequency[1:]) and damping[0] > 0.05 > 0.02 > max(damping[1:])


def test_no_datum_but_the_supports_counts(lap):
    """Of a grid that is narrower than the patch, with any -plane_datum."""
    one, other = (
        joint.Pair(lap.file, PRELOAD, **OPTIONS | dict(grid_n=64, grid_size=32e-3), plane_datum=datum)
        for datum in (0.02, 3.0)
    )
    assert one.tensions["B"] == pytest.approx(other.tensions["B"], rel=1e-8)
    a, b = (pair.structure.patches[0].contact.field("pressure") for pair in (one, other))
    assert np.max(np.abs(a - b)) < 1e-5 * a.max()
    assert one.structure.stuck_modes()[0] == pytest.approx(other.structure.stuck_modes()[0], rel=1e-6)


def test_two_patches_are_those_of_the_full_compliance(lap, reference):
    """Crowned surfaces on either side of the middle, without contact between them. A cell that enters a step's contact
    counts its slip in it in another way here: the difference falls with the number of steps."""
    path, radius, x = lap.path.with_name("two.h5"), 4.0, (np.arange(CELLS) + 0.5) * 2.0 * HALF / CELLS - HALF
    made(lap.path, 10, 12e-3, centers=((-9e-3, 0.0), (9e-3, 0.0)), **HELD).write(path)
    crowned = dict(gap_type="ellipsoid", gap_radius_x=radius, gap_radius_y=np.inf, grid_n=32)
    pair, found = backbone(path, [400.0, 700.0, 1000.0], 24, **crowned)
    cells = np.flatnonzero(np.abs(np.abs(x) - 9e-3) < 6e-3)
    alone = laps.Quasistatic(reference, cells, (np.abs(x[cells]) - 9e-3) ** 2 / (2.0 * radius))
    assert len(cells) == 64
    assert 2 * np.pi * found.linear == pytest.approx(alone.omega, rel=3e-5)
    for alpha, frequency, damping in zip(found.alpha, found.frequency, found.damping):
        omega, zeta = alone.point(alpha, 24, 4)
        assert 2 * np.pi * frequency == pytest.approx(omega, rel=3e-5)
        assert damping == pytest.approx(zeta, rel=1e-2)


def test_a_pair_that_nothing_holds_has_the_modes_of_its_elements(lap, reference):
    """Elastic ones: those of the elements above the three rigid motions in their plane."""
    whole = laps.Reference(lap, HALF, CELLS, modes=7, clamped=False)
    found = made(lap.path, 8, free=True, bolts=BOLT, modes=4)
    assert len(found.modes.rigid) == 4 and found.modes.omega == pytest.approx(whole.omega[3:], rel=1e-6)
    path = lap.path.with_name("free.h5")
    found.write(path)
    pair = joint.Pair(path, PRELOAD, **OPTIONS)
    load = pair.structure.patches[0].number("load_n")
    assert pair.tensions["B"] == pytest.approx(load, rel=1e-6)


# ---------------------------------------------------------------- stresses


def test_stresses_of_body_2_are_those_of_a_direct_solution(lap, solve, launcher, tmp_path):
    """At Gauss points of elements of the tests' own, by the bolt's tension and petsam's tractions on both bodies."""
    rigid = dict(disp_x=0, disp_z=0, rot_y=0, friction=laps.FRICTION)
    given = dict(elasticity="plane", grid_n=CELLS, grid_size=2.0 * HALF, gap_type="flat", body2_compliance=lap.file)
    moduli = {f"body{k}_{name}": value for k in (1, 2) for name, value in zip(("young", "poisson"), MODULI)}
    r = solve(given, moduli, rigid, dict(body2_case_bolt_B=laps.TENSION, body2_case_mode2=1e-3))
    p, q = r.pressure.ravel(), r.shear_x.ravel()

    def traction(at):
        cell = np.clip(((at + HALF) / (2.0 * HALF) * CELLS).astype(int), 0, CELLS - 1)
        return np.stack([q[cell], p[cell]], axis=1) * (np.abs(at) < HALF)[:, None]

    tie, closing = laps.bolt(lap)
    own = lap.second[lap.elements[:, 0]]
    force = laps.TENSION * closing
    for mine, sign in ((own, 1.0), (~own, -1.0)):
        force = force + sign * sections.forces(lap.nodes, lap.elements[mine], traction, 40)
    free = np.flatnonzero(~np.repeat(lap.sets["CLAMP"], 2))
    matrix = sections.stiffness(lap.nodes, lap.elements, *MODULI) + tie
    u = np.zeros(len(force))
    u[free] = sections.spsolve(matrix[free][:, free].tocsc(), force[free])
    u = u.reshape(-1, 2) + 1e-3 * lap.compliance.modes.shapes[:, 1].reshape(-1, 3)[:, [0, 2]]
    middle, rows = lap.nodes[lap.elements].mean(axis=1), np.unique(lap.nodes[lap.second][:, 1])[::2]
    inside = (np.abs(middle[:, 0]) < HALF) & (middle[:, 1] > rows[1]) & (middle[:, 1] < rows[2])
    chosen = lap.elements[own & inside]
    depth, wanted = sections.stresses(lap.nodes, chosen[np.argsort(middle[own & inside][:, 0])], u, *MODULI)
    below = dict(input=r.path, body=2, depths=depth, output=tmp_path / "s.h5")
    execute(launcher, tmp_path, [below], 1, 0, program=PROGRAM.with_name("petsam-stress"))
    with h5py.File(tmp_path / "s.h5") as file:
        found = [file[f"stress_{name}"][-1].ravel() for name in ("xx", "zz", "xz")]
    x = np.sort(middle[own & inside][:, 0])
    found = np.stack([np.interp(x, r.x, one) for one in found])
    print(np.abs(found - wanted).max(axis=1) / np.abs(wanted).max(axis=1))
    assert np.max(np.abs(found - wanted)) < 1e-2 * np.abs(wanted).max()


def test_stresses_that_a_pair_does_not_have_are_named(lap, solve, launcher, tmp_path):
    path = tmp_path / "two.h5"
    made(lap.path, 6, 12e-3, centers=((-9e-3, 0.0), (9e-3, 0.0)), **HELD).write(path)
    moduli = {f"body{k}_{name}": value for k in (1, 2) for name, value in zip(("young", "poisson"), MODULI)}
    crowned = dict(gap_type="ellipsoid", gap_radius_x=2.0, gap_radius_y="inf", grid_n=32, grid_size=12e-3)
    rest = dict(elasticity="plane", load_n=1e5, friction=0.3, allow_edge_contact=True)
    for file, body, says in ((lap.file, 1, "exchange the surfaces of --contact and --pair"),
                             (f"{path}:1", 1, "several patches"), (f"{path}:1", 2, "several patches")):  # fmt: skip
        r = solve(crowned, moduli, rest, dict(body2_compliance=file))
        below = dict(input=r.path, body=body, depths=1e-4, output=tmp_path / "s.h5")
        done = execute(launcher, tmp_path, [below], 1, 3, program=PROGRAM.with_name("petsam-stress"))
        assert says in done.stderr


# ---------------------------------------------------------------- commands

WORDS = ["--contact", "CONTACT2", "--pair", "CONTACT1", "--units", "mm", "--frame", "0,0,0:1,0,0:0,-1,0",
         "-o", "pair.h5", "--patch", "36mm", "--degree", "6,0", "--fixed", "CLAMP", "--no-picture"]  # fmt: skip
BOLTED = ["--modes", "4", "--sensor", "TIP=TIP", "--bolt", "B=WASHER1,WASHER2:8mm"]


def test_the_file_has_the_units_of_a_metre(lap, compliance):  # noqa: F811
    said = compliance("--mesh", lap.path, *WORDS, *BOLTED)
    assert any("bolt        B: 1.662e+10 N/m2, 8 mm x 25.4 mm" in line for line in said)
    with h5py.File("pair.h5", "r") as file:
        assert file.attrs["datum"] == pytest.approx(2 * HALF) and file.attrs["young1"] == laps.YOUNG
        assert file["bolts/B/stiffness"].attrs["units"] == "N/m2" and not np.any(file["rigid/motions"][[3, 5]])


def test_the_command_prints_and_draws_numbers_of_a_metre(lap, joint_command, tmp_path):
    (tmp_path / "c.opts").write_text(f"-grid_n {CELLS}\n-friction {laps.FRICTION}\n")
    words = (lap.file, "--contact", "c.opts", "--preload", "B=600kN", "--sensor", "TIP:y", "--amplitudes", "0.2mm")
    printed = joint_command("backbone", *words, "-o", "out", "--degree-check")
    assert "N/m left of 600000 N/m after" in printed and "W/(J/m)" in printed and "degree lower by 2" in printed
    with open("out.csv", newline="") as file:
        (row,) = csv.DictReader(file)
    pair = joint.Pair(lap.file, PRELOAD, **OPTIONS)
    expected = joint.backbone(pair.structure, [2e-4], sensor=pair.sensors["TIP"][:, 1])
    assert float(row["energy [J/m]"]) == pytest.approx(expected.energy[0], rel=1e-6) and expected.energy[0] > 0.0
    assert (tmp_path / "out-contact.png").stat().st_size > 10000
    figure = petsam.plot.slip_zones(expected)
    assert np.max(figure.axes[0].lines[0].get_ydata()) == pytest.approx(1e-6 * expected.pressure[0].max())
    assert sum(len(bars) for bars in figure.axes[1].containers) == np.sum(expected.pressure[0] > 0.0)


def test_pairs_of_sections_that_are_none_are_rejected(lap, compliance):  # noqa: F811
    always = ["--mesh", lap.path, *WORDS]
    said = compliance(*always, check=3)[0]
    assert "floats, as nothing but the contact holds it" in said
    said = compliance(*always, *BOLTED, "--center", "0,1mm", check=2)[0]
    assert "--center X,Y with Y has no meaning: give X alone" in said
    said = compliance(*always, *BOLTED, "--center=-15mm,0", "--center", "15mm,0", check=3)[0]
    assert "patches 1 and 2 are 0 m apart" in said
