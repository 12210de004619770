"""petsam-stress under surfaces that slide: body 2 at its own points, which the contact passes; body 1 at the cells."""

import shutil

import h5py
import numpy as np
import pytest

import conftest
from support import ball, history
from test_embed import run_python
from test_plane import CYLINDER, MU, P0, A, N
from test_plane_stress import COMPONENTS, mcewen

PROGRAM = conftest.PROGRAM.with_name("petsam-stress")
CELL = 20e-6
PLANE = dict(CYLINDER, load_n=None, slide=True, grid_n=100, grid_size=100 * CELL)
STROKE = 30  # cells; the contact has 24
PATH = [0, STROKE - 1, *range(STROKE, -STROKE, -1), *range(-STROKE, STROKE + 1)]
BULK = 5e7
SOLID = dict(ball(36, 3.0), load_n=None, slide=True)
WAY = [(0.0, 0.0), (9.0, 4.0), (10.3, 5.1), (-6.6, -3.2), (9.0, 4.0)]  # cells


@pytest.fixture(scope="module")
def folder(launcher, tmp_path_factory):
    """The folder of a cylinder that slides to and fro, and of a ball on a way of its own; each also as if at rest."""
    folder = tmp_path_factory.mktemp("slide")
    loads = history(folder / "p.csv", "time,load_n,disp_x", *[(k, N, CELL * d) for k, d in enumerate(PATH)])
    conftest.execute(launcher, folder, [PLANE, loads, dict(steps=1, output="p.h5")], 1, 0)
    cell = float(SOLID["grid_size"]) / SOLID["grid_n"]
    rows = [(k, 180.0, cell * dx, cell * dy, 0.0, BULK) for k, (dx, dy) in enumerate(WAY)]
    loads = history(folder / "b.csv", "time,load_n,disp_x,disp_y,rot_z,bulk2_stress_xx", *rows)
    conftest.execute(launcher, folder, [SOLID, loads, dict(steps=1, output="b.h5")], 1, 0)
    for name in "pb":
        shutil.copy(folder / f"{name}.h5", folder / f"{name}0.h5")
        with h5py.File(folder / f"{name}0.h5", "r+") as f:
            del f.attrs["slide"]
    return folder


@pytest.fixture
def stress(launcher, folder):
    """stress(name, options, ranks=1): the datasets of petsam-stress of these results, and what it printed."""

    def run(name, ranks=1, check=0, **options):
        case = dict(dict(input=f"{name}.h5", output="s.h5"), **options)
        done = conftest.execute(launcher, folder, [case], ranks, check, program=PROGRAM)
        if check:
            return done.stderr
        with h5py.File(folder / "s.h5") as f:
            values = {k: v[()] for k, v in f.items() if isinstance(v, h5py.Dataset)}
            history = {k: v[()] for k, v in f["history"].items()}
            return dict(values, history=history, labels=f["x"].attrs["long_name"], printed=done.stdout + done.stderr)

    return run


def slides(folder, name):
    with h5py.File(folder / f"{name}.h5") as f:
        return np.c_[f["history/slide_x"][:], f["history/slide_y"][:]], f["x"][1] - f["x"][0]


def seen(field, slide, cell):
    """A field (..., y, x) at x - slide, by cubic interpolation; NaN where that is not on the grid."""
    for axis in range(2):
        field = field.swapaxes(-1, -1 - axis)
        n, shift = field.shape[-1], float(slide[axis] / cell)
        whole = int(np.ceil(shift))
        at = whole - shift
        beyond = np.pad(field, [(0, 0)] * (field.ndim - 1) + [(n, n)], constant_values=np.nan)
        taps = {j: np.prod([(at - i) / (j - i) for i in range(-1, 3) if i != j]) for j in range(-1, 3)}
        field = sum(tap * beyond[..., n - whole + j : 2 * n - whole + j] for j, tap in taps.items())
        field = field.swapaxes(-1, -1 - axis)
    return field


def test_points_of_a_cylinder_s_track_have_mcewen_s_stresses(folder, stress):
    s = stress("p", steps="all", depths=f"0,{A / 10!r},{A / 2!r}", quantities="stress")
    slide, _ = slides(folder, "p")
    assert s["labels"] == "x of the body's own points, under the cells before it moves"
    for step in (20, 40, 80, 122):
        d = slide[step, 0]
        x, z = np.meshgrid((s["x"] - d) / A, s["z"] / A)
        by_p, by_q = mcewen(x, z)
        mu = MU if PATH[step] > PATH[step - 1] else -MU
        away = (z > 0) | (np.abs(np.abs(x) - 1) > 0.1)
        for k, name in enumerate(("xx", "zz", "xz")):
            error = s[f"stress_{name}"][step, :, 0] / P0 - by_p[k] - mu * by_q[k]
            largest = np.where(away, np.abs(error), 0).max(axis=1)  # less where the traction varies less within a cell
            assert largest[0] < 1e-2 and largest[1] < 1e-2 and largest[2] < 1e-3, (step, name)
        assert s["history"]["edge_stress_xx_max"][step] == pytest.approx(2 * MU * P0, rel=5e-3)
        assert s["history"]["edge_stress_xx_max_x"][step] == pytest.approx(d - np.sign(mu) * A, abs=0.1 * CELL)


@pytest.mark.parametrize("body", [1, 2])
def test_points_of_bodies_that_roll_pass_the_contact(folder, stress, launcher, body):
    """After 7 cells the stress at a point is the one that lay 7 cells behind it, in either body."""
    loads = history(folder / "r.csv", "time,load_n,roll", (0, N, 0.0), (1, N, 7 * CELL))
    conftest.execute(launcher, folder, [PLANE, loads, dict(steps=1, output="r.h5", overwrite=True)], 1, 0)
    s = stress("r", body=body, depths="0:6e-5:3", steps="all")
    first, last = s["stress_zz"]
    assert np.abs(last[..., 7:] - first[..., :-7]).max() < 1e-6 * P0
    assert s["labels"] == "x of the body's own points, under the cells before it moves"


def test_track_of_a_cylinder_is_worn_out_evenly(stress):
    """In its middle all of the contact passes each point twice: the same SWT, frictional work of 2 mu N a metre."""
    steps = dict(steps=f"4:{len(PATH)}")
    s = stress("p", depths="0,5e-5", fatigue="swt,ruiz", quantities="none", **steps)
    middle = np.abs(s["x"]) < STROKE * CELL - 1.2 * A
    assert "warning" not in s["printed"] and "SWT" in s["printed"] and ") m\n" in s["printed"]
    assert s["printed"].count("at body 2's own point (") == 5
    for z in range(2):
        assert np.ptp(s["swt"][z, 0, middle]) < 1e-9 * s["swt"][z, 0, middle].max()
    assert s["ruiz_1"][0, 0, middle] == pytest.approx(2 * MU * N / 4, rel=1e-3)
    at_rest = stress("p0", depths=0, fatigue="swt,ruiz", quantities="none", **steps)
    assert at_rest["ruiz_1"].max() > 2.5 * MU * N / 4 and "own point" not in at_rest["printed"]
    with_section = stress("p", depths="0,5e-5", fatigue="swt,ruiz", quantities="none", section="y=0", **steps)
    assert with_section["swt"] == pytest.approx(s["swt"], rel=1e-6)
    assert np.array_equal(with_section["ruiz_1"][0], s["ruiz_1"][0])


def test_points_of_a_ball_s_way_have_the_stresses_of_the_step_where_they_lie(folder, stress):
    """Moved tractions are interpolated stresses, with the bulk stress; what moved to nowhere in these is there, too."""
    options = dict(steps="all", depths="0,1e-4", quantities="stress")
    own, grid = stress("b", **options), stress("b0", **options)
    slide, cell = slides(folder, "b")
    assert np.abs(slide[3:] / cell).min() > 2 and np.any(np.abs(slide / cell % 1 - 0.5) < 0.4)
    for name in COMPONENTS:
        scale = np.abs(grid[f"stress_{name}"]).max()
        for k in range(1, len(WAY)):
            expected = seen(grid[f"stress_{name}"][k], slide[k], cell)
            known = ~np.isnan(expected)
            assert 0.3 < known.mean() < 1
            difference = own[f"stress_{name}"][k] - expected
            assert np.abs(difference[known]).max() < 1e-11 * scale, (name, k)
        assert np.array_equal(own[f"stress_{name}"][0], grid[f"stress_{name}"][0])
    assert not np.isnan(own["stress_xx"]).any()
    assert own["stress_xx"][3, 1, -1, -1] == pytest.approx(BULK, rel=0.05)


def test_work_at_a_point_is_that_of_the_cells_over_it(folder, stress):
    """Of the shear and the slip of each step, where the point lay in it; the slip counts from the step before."""
    own = stress("b", steps="2:5", depths=0, fatigue="ruiz", quantities="none")["ruiz_1"][0]
    slide, cell = slides(folder, "b")
    with h5py.File(folder / "b.h5") as f:
        shear, slip = (np.array([f[f"{name}_x"][1:], f[f"{name}_y"][1:]]) for name in ("shear", "slip"))
    since = slip - np.roll(slip, 1, axis=1)
    work = [
        np.abs((seen(shear[:, k], d, cell) * seen(since[:, k], d, cell)).sum(axis=0)) for k, d in enumerate(slide[1:])
    ]
    expected = np.sum(work, axis=0) / 4
    known = ~np.isnan(expected)
    assert 0.2 < known.mean() and expected[known].max() > 0.5 * own.max()
    assert np.abs(own - expected)[known].max() < 1e-11 * own.max()


@pytest.mark.parametrize("section", [None, "x=2e-4"])
def test_any_number_of_ranks_gives_the_same_bits_and_body_1_stays(stress, section):
    options = dict(steps="2:5", depths="0,1e-4", fatigue="swt,ruiz", section=section)
    one = stress("b", **options)
    for ranks in (2, 3):
        many = stress("b", ranks=ranks, **options)
        assert all(np.array_equal(one[k], many[k], equal_nan=True) for k in ("swt", "ruiz_1", "stress_xx", "mises"))
    rest, slid = (stress(name, body=1, **options) for name in ("b0", "b"))
    assert all(np.array_equal(rest[k], slid[k], equal_nan=True) for k in ("swt", "ruiz_1", "stress_xx", "mises"))
    assert rest["labels"] == slid["labels"] == "x of the cell centres"


def test_in_process_it_has_the_bits_of_the_program(folder, stress, tmp_path):
    case = {k: v for k, v in SOLID.items() if v is not None and k != "output_fields"}
    cell = float(SOLID["grid_size"]) / SOLID["grid_n"]
    run_python(
        f"""
import petsam, numpy as np
contact = petsam.Contact(**{case!r})
for k, (dx, dy) in enumerate({WAY!r}):
    if k == 1:
        contact.record()
    given = dict(load_n=180.0, rot_z=0.0, bulk2_stress_xx={BULK!r})
    contact.try_step(time=k, disp_x={cell!r} * dx, disp_y={cell!r} * dy, **given)
    contact.commit()
np.savez("f.npz", **contact.fatigue("swt,ruiz"), last=contact.stress()["mises"])
""".replace("inf", "float('inf')"),
        tmp_path,
    )
    found, s = np.load(tmp_path / "f.npz"), stress("b", steps="2:5", fatigue="swt,ruiz")
    assert all(np.array_equal(found[name], s[name]) for name in ("swt", "ruiz_1", "ruiz_2"))
    assert np.array_equal(found["last"][0], s["mises"][-1])


def test_passing_needs_no_grid_along_the_stroke_and_other_results_of_body_2_do(launcher, folder, stress):
    loads = history(folder / "far.csv", "time,load_n,disp_x", (0, N, 0.0), (1, N, 44 * CELL), (2, N, 45 * CELL))
    conftest.execute(launcher, folder, [PLANE, loads, dict(steps=1, output="far.h5")], 1, 0)
    refused = stress("far", check=2)
    assert "-body 2: where its points have moved by 0.000899" in refused and "beyond the border of the grid" in refused
    s = stress("far", passing=True, fatigue="swt", depths=5e-5, quantities="none")
    assert np.ptp(s["swt"]) == 0
    assert stress("far", body=1)["mises"].max() > 0
