"""petsam-compliance: bodies that are turned in space, used as body 1, halved by a plane of symmetry, or curved."""

import h5py
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from petsam import loads
from petsam.apps.compliance import mesh, solve, stiffness
from test_compliance_command import ALWAYS, bricks, compliance, written  # noqa: F401

WORDS = ["--fixed", "BOTTOM", *ALWAYS, "--degree", "3", "--no-stress"]
LOPSIDED = (np.linspace(-1.5, 2.5, 9), np.linspace(-2.0, 1.5, 8), np.linspace(0.0, 2.5, 6))
HELD = {"BOTTOM": lambda p: p[:, 2] > 2.5 - 1e-9}
SPACE = Rotation.from_rotvec([0.7, -1.1, 2.0]).as_matrix()
OVER = np.diag([1.0, -1.0, -1.0])  # half a turn about x
LOAD = dict(load_n=0.004, load_tx=9e-4, load_ty=5e-4, friction=0.4, steps=2)
SPHERE = dict(gap_type="sphere", gap_radius1=100, gap_radius2="inf", grid_n=40, grid_size=2, output_fields="all")


def frame(turn=None, origin=(0.0, 0.0, 0.0), axes=None):
    """The option --frame of a mesh whose nodes were multiplied by `turn` and moved to `origin`."""
    axes = np.eye(3) if axes is None else axes
    rows = axes @ (np.eye(3) if turn is None else turn)
    return "--frame=" + ":".join(",".join(f"{v:.17g}" for v in part) for part in (origin, rows[0], rows[2]))


def made(run, folder, name, turn=None, origin=(0.0, 0.0, 0.0), axes=None, body=None):
    """The file of a lopsided block, placed in its model by `turn` and `origin`."""
    body = body or bricks(LOPSIDED, HELD)
    body.nodes = body.nodes @ (np.eye(3) if turn is None else turn) + origin
    written(folder / f"{name}.inp", body)
    run("--mesh", f"{name}.inp", *WORDS, frame(turn, origin, axes), "-o", f"{name}.h5")
    return folder / f"{name}.h5"


def pressed(solve, number, file, **more):
    """A rigid sphere on the block."""
    other = {f"body{3 - number}_young": "inf", f"body{number}_young": 1, f"body{number}_poisson": 0.3}
    return solve(SPHERE, LOAD, other, {f"body{number}_compliance": file}, more)


@pytest.fixture
def straight(compliance, tmp_path):  # noqa: F811
    """The file of the block in the coordinates of the contact."""
    return made(compliance, tmp_path, "straight")


def test_a_body_turned_in_space_gives_the_same_file_and_the_same_contact(
    compliance,  # noqa: F811
    straight,
    solve,
    tmp_path,
):
    turned = made(compliance, tmp_path, "turned", SPACE, (3.0, -4.0, 5.0))
    with h5py.File(straight, "r") as one, h5py.File(turned, "r") as other:
        a, b = one["compliance"][:], other["compliance"][:]
        assert np.allclose(other["frame/axes"], SPACE, atol=1e-12)
        assert np.max(np.abs(a - b)) < 1e-10 * np.max(np.abs(a))
    first, second = pressed(solve, 2, straight), pressed(solve, 2, turned)
    for name in ("load_n", "disp_x", "disp_y", "disp_z"):
        assert np.allclose(first[name], second[name], rtol=1e-7)
    for name in ("pressure", "shear_x", "shear_y"):
        difference = getattr(first, name) - getattr(second, name)
        assert np.max(np.abs(difference)) < 1e-6 * np.max(first.pressure)


@pytest.mark.parametrize("turn", [None, SPACE], ids=["straight", "turned"])
def test_a_body_turned_over_is_body_1_in_the_turned_contact(compliance, straight, solve, tmp_path, turn):  # noqa: F811
    """The frame of common use: x as in the contact of body 2, z into body 1."""
    above = made(compliance, tmp_path, "above", OVER if turn is None else OVER @ turn, axes=np.eye(3))
    below = pressed(solve, 2, straight)
    over = pressed(solve, 1, above, load_tx=-LOAD["load_tx"])
    most = np.max(below.pressure)
    assert np.ptp(below.pressure - below.pressure[::-1]) > 1e-3 * most  # lopsided
    for name, sign in (("pressure", 1.0), ("shear_x", -1.0), ("shear_y", 1.0)):
        assert np.max(np.abs(getattr(over, name)[::-1] - sign * getattr(below, name))) < 1e-6 * most
    for name, sign in (("disp_x", -1.0), ("disp_y", 1.0), ("disp_z", 1.0)):
        assert np.allclose(over[name], sign * below[name], rtol=1e-6)


@pytest.mark.parametrize("directions", ["x and z", "neither"])
def test_nodal_forces_have_the_frame_of_the_compliance(compliance, tmp_path, monkeypatch, directions):  # noqa: F811
    """One patch of a turned block, one --frame in mm: its file of body 2 and its history. By hand: z into the body, and
    x, y, z right-handed; a force beside the origin has its moments about these axes."""
    monkeypatch.chdir(tmp_path)
    body, origin = bricks(LOPSIDED, HELD), np.array((3.0, -4.0, 5.0))
    body.nodes = body.nodes @ SPACE + origin
    written(tmp_path / "block.inp", body)
    given = frame(SPACE, origin) if directions == "x and z" else "--frame=3,-4,5"
    compliance("--mesh", "block.inp", *WORDS, "--units", "mm", "--patch", "1.6mm", given, "-o", "block.h5")
    with h5py.File("block.h5", "r") as file:
        axes, at = file["frame/axes"][:], file["frame/origin"][:]
    assert np.allclose(axes[2], SPACE[2], atol=1e-12) and np.linalg.det(axes) == pytest.approx(1.0)
    local = np.array([(-0.5, -0.5, 0.0), (0.5, -0.5, 0.0), (0.5, 0.5, 0.0), (-0.5, 0.5, 0.0)])
    force = np.array([(1.0, 2.0, 9.0), (0.5, 1.0, 12.0), (0.0, 0.0, 20.0), (3.0, -1.0, 14.0)])  # in the frame
    rows = [
        ",".join(map("{:.17g}".format, (k, *p, *f, 1)))
        for k, p, f in zip(range(4), local @ axes + origin, force @ axes)
    ]
    (tmp_path / "nodes.csv").write_text(
        "\n".join(["label,x [mm],y [mm],z [mm],fx [N],fy [N],fz [N],increment", *rows]) + "\n"
    )
    read = loads.read("nodes.csv")
    parts = [tuple(map(float, part.split(","))) for part in given.removeprefix("--frame=").split(":")]
    found = loads.history(read, frame=parts)
    assert np.allclose(found.frame.axes, axes, atol=1e-9) and np.allclose(found.frame.origin, at, atol=1e-12)
    x, y = 1e-3 * local[:, 0], 1e-3 * local[:, 1]
    moments = -y @ force[:, 2], x @ force[:, 2], x @ force[:, 1] - y @ force[:, 0]
    assert found.loads[0] == pytest.approx([55.0, 4.5, 2.0, *moments], abs=1e-9)


# ---------------------------------------------------------------- planes of symmetry


def test_half_of_a_body_moves_as_a_whole_one_that_is_loaded_on_both_sides():
    """Inclined, and at the edge of two planes."""
    x, z = np.linspace(0.0, 2.0, 4), np.linspace(0.0, 1.5, 3)
    wide = np.array([*-x[:0:-1], *x])
    quarter, whole = (mesh.grid_mesh((e, e, z), "C3D20", node_sets={}) for e in (x, wide))
    places = quarter.nodes.copy()
    force = np.random.default_rng(3).normal(size=places.shape)
    moved = []
    for body in (quarter, whole):
        loads = np.zeros_like(body.nodes)
        for i, place in enumerate(np.abs(body.nodes)):
            signs = np.where(body.nodes[i] < -1e-9, -1.0, 1.0)
            here = np.flatnonzero(np.all(np.abs(places - place) < 1e-9, axis=1))[0]
            on = np.abs(body.nodes[i, :2]) < 1e-9  # a node of a plane carries both halves
            loads[i] = force[here] * signs
            if body is whole:
                loads[i, :2][on] = 0.0
                loads[i] *= 2.0 ** np.sum(on)
        held = np.repeat(body.nodes[:, 2] > 1.5 - 1e-9, 3)
        planes = [(np.flatnonzero(np.abs(body.nodes[:, k]) < 1e-9), SPACE[k]) for k in (0, 1)]
        body.nodes = body.nodes @ SPACE
        solver = solve.Solver(stiffness.assembled(body), body.nodes, held, planes if body is quarter else ())
        u = solver((loads @ SPACE).reshape(-1, 1), np.zeros((int(held.sum()), 1))).reshape(-1, 3) @ SPACE.T
        moved.append((body.nodes @ SPACE.T, u))
    (one, u), (other, v) = moved
    same = [np.flatnonzero(np.all(np.abs(other - place) < 1e-9, axis=1))[0] for place in one]
    assert np.allclose(u, v[same], atol=1e-10 * np.max(np.abs(v)))


def test_a_plane_of_symmetry_may_be_inclined(compliance, tmp_path):  # noqa: F811
    sets = {**HELD, "MIDDLE": lambda p: p[:, 0] > 2.5 - 1e-9}
    body, turned = bricks(LOPSIDED, sets), bricks(LOPSIDED, sets)
    turned.nodes = turned.nodes @ SPACE
    written(tmp_path / "a.inp", body)
    written(tmp_path / "b.inp", turned)
    words = [*WORDS, "--degree", "1"]
    said = compliance("--mesh", "a.inp", *words, "--symmetry", "MIDDLE", "--method", "image", check=3)[0]
    assert "has a plane of symmetry: use --method cutoff" in said
    compliance("--mesh", "a.inp", *words, "--method", "cutoff", "-o", "free.h5", warning="elements are")
    for name, more in (("a", []), ("b", [frame(SPACE)])):
        compliance(
            "--mesh", f"{name}.inp", *words, *more, "--symmetry", "MIDDLE", "-o", f"{name}.h5", warning="elements are"
        )
    free, a, b = (h5py.File(f"{name}.h5", "r")["compliance"][:] for name in ("free", "a", "b"))
    assert np.max(np.abs(a - b)) < 1e-10 * np.max(np.abs(a))
    # along x the other half is pushed against this one
    assert a[0, 0, 0, 0] < free[0, 0, 0, 0] - 0.1
    said = compliance("--mesh", "a.inp", *words, "--symmetry", "NALL", check=3)[0]
    assert "node set NALL of --symmetry is not a plane: name the nodes of one plane" in said


# ---------------------------------------------------------------- curved surfaces


def test_a_gently_curved_surface_is_its_tangent_plane_with_a_warning(compliance, tmp_path):  # noqa: F811
    x = np.linspace(-2.0, 2.0, 9)
    files = []
    for radius in (np.inf, 25.0, 8.0):
        body = bricks((x, x, np.linspace(0.0, 2.0, 5)), {"BOTTOM": lambda p: p[:, 2] > 2.0 - 1e-9})
        fall = np.sum(body.nodes[:, :2] ** 2, axis=1) / (2.0 * radius)
        body.nodes[:, 2] += fall * (1.0 - body.nodes[:, 2] / 2.0)
        written(tmp_path / "curved.inp", body)
        words = ["--mesh", "curved.inp", *WORDS, "--degree", "2", "--method", "cutoff"]
        if radius < 10.0:
            assert "m off the plane of the frame, limit 0.1 m" in compliance(*words, check=3)[0]
            continue
        warning = "elements are" if np.isinf(radius) else "the surface is up to 0.04 of the patch's half width off"
        printed = compliance(*words, "-o", "f.h5", warning=warning)
        assert any("the surface is curved" in line for line in printed) == np.isfinite(radius)
        with h5py.File("f.h5", "r") as file:
            files.append(file["compliance"][:])
    change = files[1] - files[0]
    assert np.max(np.abs(change[:, 2, :, 2])) < 0.01 * np.max(np.abs(files[0]))
    # by shear: elements of the curved body alone give +0.04 of its 2.4; the error is of the order of patch over radius
    assert 1e-3 < np.max(np.abs(change)) < 4.0 / 25.0
