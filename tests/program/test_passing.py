"""petsam-stress -passing: fatigue of a point that passes along x, against numpy over the row of its stresses."""

import h5py
import numpy as np
import pytest

import conftest
from support import SPHERE, ball
from test_embed import run_python

PROGRAM = conftest.PROGRAM.with_name("petsam-stress")
COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")
DEPTHS = "0,5e-5,1e-4,1e-3"
CASE = dict(fatigue="crossland,dang_van", fatigue_crossland_alpha=0.2, fatigue_dang_van_alpha=0.3, passing=True)


@pytest.fixture(scope="module")
def rolled(launcher, tmp_path_factory):
    """The folder of a ball that rolls in steady state, with two creepages."""
    folder = tmp_path_factory.mktemp("passing")
    case = ball(40, rolling="steady", creep_spin=10.0, creep_y=2e-4, output="r.h5", history="h.csv")
    (folder / "h.csv").write_text("time,creep_x\n1,1e-4\n2,3e-3\n")
    conftest.execute(launcher, folder, [case], 1, 0)
    return folder


@pytest.fixture
def stress(launcher, rolled):
    """stress(options, ranks=1, check=0): a run of petsam-stress in the folder; its file's datasets."""

    def run(*options, ranks=1, check=0):
        case = dict(input="r.h5", output="s.h5", overwrite=None)
        done = conftest.execute(launcher, rolled, [case, *options], ranks, check, program=PROGRAM)
        if check:
            return done
        with h5py.File(rolled / "s.h5") as f:
            values = {name: f[name][()] for name in f if isinstance(f[name], h5py.Dataset)}
            return dict(values, warnings=done.stderr, attributes=dict(f.attrs))

    return run


def deviators(row):
    """Of stresses (6, states): hydrostatic part, and tensors of the deviator."""
    xx, yy, zz, xy, xz, yz = row
    tensors = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1)
    mean = np.trace(tensors, axis1=1, axis2=2) / 3
    return mean, tensors - mean[:, None, None] * np.eye(3)


def middle(points):
    """Centre of the minimum sphere about points: ever shorter steps to the farthest one."""
    center = points.mean(axis=0)
    for k in range(1, 30000):
        far = points[np.argmax(((points - center) ** 2).sum(1))]
        center = center + (far - center) / (k + 1)
    return center


def test_parameters_are_those_of_the_row_of_stresses(stress):
    s = stress(dict(CASE, section="y=0", depths=DEPTHS, quantities="stress"))
    assert s["warnings"] == "" and s["attributes"]["passing"] == "true"
    for z in range(4):
        row = np.array([s[f"stress_{c}"][0, z, 0] for c in COMPONENTS])
        mean, tensors = deviators(np.c_[row, np.zeros(6)])  # nothing far away
        center = middle(tensors.reshape(-1, 9)).reshape(3, 3)
        radius = np.sqrt(((tensors - center) ** 2).sum((1, 2)).max())
        principal = np.linalg.eigvalsh(tensors - center)
        expected = dict(
            crossland=radius / np.sqrt(2) + 0.2 * mean.max(),
            dang_van=((principal[:, 2] - principal[:, 0]) / 2 + 0.3 * mean).max(),
        )
        for name, value in expected.items():
            assert np.ptp(s[name][z, 0]) == 0
            assert s[name][z, 0, 0] == pytest.approx(value, rel=1e-3), (name, z)


def test_what_is_far_away_counts(stress):
    """Below the middle of the grid all of a row is under pressure: the smallest sphere is about it and zero."""
    s = stress(dict(CASE, section="y=0", depths=1e-3, quantities="stress", fatigue_crossland_alpha=0.0))
    row = np.array([s[f"stress_{c}"][0, 0, 0] for c in COMPONENTS])
    _, tensors = deviators(row)
    size = np.sqrt((tensors**2).sum((1, 2)))
    assert size.min() > 0.3 * size.max()
    assert np.sqrt(2) * s["crossland"].max() >= 0.5 * size.max()


def test_planes_and_sections_are_those_of_maps(stress):
    case = dict(CASE, fatigue="crossland,swt,findley", fatigue_findley_k=0.3, fatigue_dang_van_alpha=None)
    maps = stress(dict(case, depths="0,1e-4"))
    y = float(maps["y"][17])
    line = stress(dict(case, depths="0,1e-4", section=f"y={y!r}"))
    for name in ("crossland", "swt", "findley"):
        assert maps[name].shape == (2, 40, 40) and np.all(np.ptp(maps[name], axis=2) == 0)
        assert line[name][:, 0] == pytest.approx(maps[name][:, 17], rel=1e-4)
        assert np.argmax(maps[name][1, :, 0]) not in (0, 39)
    normals = np.array([maps[f"swt_normal_{c}"] for c in "xyz"])
    assert np.array_equal(normals[..., :1] + 0 * normals, normals, equal_nan=True)


@pytest.mark.parametrize("section", [None, "y=1e-4"])
def test_any_number_of_ranks_gives_the_same_bits(stress, section):
    one = stress(dict(CASE, depths="0,1e-4", section=section))
    for ranks in (2, 3):
        many = stress(dict(CASE, depths="0,1e-4", section=section), ranks=ranks)
        assert all(np.array_equal(one[name], many[name]) for name in ("crossland", "dang_van"))


def test_bulk_stress_is_there_far_away(launcher, tmp_path):
    """Far below a contact at rest nothing changes on the way."""
    conftest.execute(launcher, tmp_path, [dict(SPHERE, bulk2_stress_xx=5e7, output="r.h5")], 1, 0)
    case = dict(CASE, input="r.h5", output="s.h5", depths=0.5, section="y=0", fatigue_crossland_alpha=0.0)
    conftest.execute(launcher, tmp_path, [case], 1, 0, program=PROGRAM)
    with h5py.File(tmp_path / "s.h5") as f:
        assert f["stress_xx"][:].min() == pytest.approx(5e7, rel=1e-3)
        assert f["crossland"][:].max() < 1e-3 * 5e7


def test_in_process_it_has_the_bits_of_the_program(stress, tmp_path):
    case = dict(CASE, section="y=0", depths=DEPTHS)
    given = dict(ball(40, rolling="steady"), output_fields=None)
    loads = dict(load_n=given.pop("load_n"), creep_x=3e-3, creep_y=2e-4, creep_spin=10.0)
    run_python(
        f"""
import numpy as np, petsam, warnings
warnings.simplefilter("error")
warnings.simplefilter("ignore", petsam.AdviceWarning)  # the cells are few
contact = petsam.Contact(**{ ({k: v for k, v in given.items() if v is not None})!r})
contact.try_step(**{dict(loads, creep_x=1e-4)!r})
contact.commit()
contact.record()
contact.try_step(**{loads!r})
contact.commit()
np.savez("f.npz", **contact.fatigue({case.pop("fatigue")!r}, **{case!r}))
""".replace("inf", "float('inf')"),
        tmp_path,
    )
    found, expected = np.load(tmp_path / "f.npz"), stress(dict(CASE, section="y=0", depths=DEPTHS, quantities="none"))
    for name in ("crossland", "dang_van"):
        assert found[name].shape == (4, 1, 40) and np.array_equal(found[name], expected[name])
