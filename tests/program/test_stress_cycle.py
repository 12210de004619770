"""petsam-stress over a cycle: fatigue parameters and bulk stress, against closed solutions and an own search."""

import shutil
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest

import conftest
from support import SPHERE, flatten, hertz, slide_limit

PROGRAM = conftest.PROGRAM.with_name("petsam-stress")
COMPONENTS = ("xx", "yy", "zz", "xy", "xz", "yz")
ALL = dict(
    fatigue="crossland,dang_van,findley,swt,fatemi_socie,ruiz",
    fatigue_crossland_alpha=0.2,
    fatigue_dang_van_alpha=0.3,
    fatigue_findley_k=0.3,
    fatigue_fatemi_socie_k=1.0,
    fatigue_yield=4e8,
)
NAMES = ("crossland", "dang_van", "findley", "swt", "fatemi_socie", "ruiz_1", "ruiz_2")
# Cattaneo's stick radius is 0.6 of the contact's under this part of the largest shear
PART = 1 - 0.6**3
CYCLE = "41:56"  # of 56 steps


@pytest.fixture(scope="module")
def contact(launcher, tmp_path_factory):
    """
    The folder of two runs, on a fine and a coarse grid: a sphere pushed to and fro under bulk stress; the first cycle
    is not yet closed.
    """
    folder = tmp_path_factory.mktemp("cycle")
    case = dict(SPHERE, friction=0.5, grid_n=(96, 95), history="h.csv", steps=8)
    t = PART * slide_limit(case)[0]
    rows = [(k + 1, *((-t, -1e7) if k % 2 else (t, 3e7))) for k in range(7)]
    (folder / "h.csv").write_text("time,load_tx,bulk2_stress_xx\n" + "\n".join(",".join(map(repr, r)) for r in rows))
    conftest.execute(launcher, folder, [case, dict(output="c.h5")], 1, 0)
    conftest.execute(launcher, folder, [case, dict(output="coarse.h5", grid_n=(48, 47))], 1, 0)
    return folder


@pytest.fixture
def stress(launcher, contact):
    """stress(options, ranks=1, check=0): a run of petsam-stress in the contact's folder."""

    def run(*options, ranks=1, check=0):
        return conftest.execute(launcher, contact, options, ranks, check, program=PROGRAM)

    return run


def read(path):
    with h5py.File(path) as f:
        return {name: f[name][()] for name in f if isinstance(f[name], h5py.Dataset)}


def test_bulk_stress_of_the_body_is_added_in_each_step(stress, contact):
    """Far from the contact there is nothing else."""
    stress(dict(input="c.h5", output="b.h5", section="y=0", depths=0.04, steps="8:24:8"))
    b = read(contact / "b.h5")
    for k, bulk in enumerate((3e7, -1e7, 3e7)):
        # what the loads do there: T of 0.4 of N under 0.5 p0 of bulk stress falls off as (a/z)^2
        assert b["stress_xx"][k, 0, 0] == pytest.approx(bulk, abs=1e6)
    stress(dict(input="c.h5", output="b1.h5", section="y=0", depths=0.04, steps="8:24:8", body=1))
    assert abs(read(contact / "b1.h5")["stress_xx"]).max() < 1e6


def test_parameters_are_those_of_the_closed_solution(launcher, tmp_path):
    """Cattaneo and Mindlin at x = -a, z = 0.05 a, T = +-T*: two states are the whole cycle of extremes."""
    case = dict(SPHERE, friction=0.5, grid_n=(400, 200), history="h.csv", output="c.h5", steps=2)
    h = hertz(case)
    case["grid_size"] = (2.4 * h.radius, 2.4 * h.radius)
    t = PART * slide_limit(case)[0]
    (tmp_path / "h.csv").write_text(f"time,load_tx\n1,{t}\n2,{-t}\n3,{t}\n")
    conftest.execute(launcher, tmp_path, [case], 1, 0)
    z = 0.05 * h.radius
    run = dict(input="c.h5", output="s.h5", section="y=0", depths=z, steps="3:6", **ALL)
    run.update(fatigue="crossland,dang_van,findley,swt,fatemi_socie", fatigue_crossland_alpha=0.0,
               fatigue_yield=float(h.pressure))  # fmt: skip
    conftest.execute(launcher, tmp_path, [run], 1, 0, program=PROGRAM)
    s, young = read(tmp_path / "s.h5"), case["body2_young"]
    scale = dict(swt=h.pressure**2 / young, fatemi_socie=h.pressure / young)
    expected = dict(swt=0.16446694, fatemi_socie=0.77814878, findley=0.31803189, crossland=0.25428887,
                    dang_van=0.26007529)  # fmt: skip
    for name, value in expected.items():
        found = np.interp(-h.radius, s["x"], s[name][0, 0]) / scale.get(name, h.pressure)
        assert found == pytest.approx(value, rel=0.01), name


def planes(step):
    """Normals of a hemisphere, and two directions in each plane."""
    t, p = np.meshgrid(np.radians(np.arange(0, 90 + step / 2, step)), np.radians(np.arange(0, 360, step)))
    t, p = t.ravel(), p.ravel()
    zero = 0 * t
    return (
        np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], -1),
        np.stack([np.cos(t) * np.cos(p), np.cos(t) * np.sin(p), -np.sin(t)], -1),
        np.stack([-np.sin(p), np.cos(p), zero], -1),
    )


def test_swt_is_the_largest_over_all_planes(stress, contact):
    stress(dict(input="c.h5", output="w.h5", depths="0,4e-5,2e-4", section="y=1e-4", steps=CYCLE, fatigue="swt",
                quantities="stress,strain"))  # fmt: skip
    w = read(contact / "w.h5")
    n, _, _ = planes(2.0)
    for z in range(3):
        for x in range(2, 96, 13):
            tensor = {}
            for kind in ("stress", "strain"):
                xx, yy, zz, xy, xz, yz = (w[f"{kind}_{c}"][:, z, 0, x] for c in COMPONENTS)
                tensor[kind] = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
            s, e = (np.einsum("pi,ijt,pj->pt", n, tensor[k], n) for k in ("stress", "strain"))
            search = np.max(np.maximum(s.max(1), 0) * (e.max(1) - e.min(1)) / 2)
            assert search * (1 - 1e-9) <= w["swt"][z, 0, x] <= search * 1.004 + 1e-9 * w["swt"].max()
            normal = np.array([w[f"swt_normal_{c}"][z, 0, x] for c in "xyz"])
            if w["swt"][z, 0, x] == 0:
                assert np.isnan(normal).all()
                continue
            on_plane = {k: np.einsum("i,ijt,j->t", normal, t, normal) for k, t in tensor.items()}
            swt = on_plane["stress"].max() * np.ptp(on_plane["strain"]) / 2
            assert np.linalg.norm(normal) == pytest.approx(1) and normal[2] >= 0
            assert swt == pytest.approx(w["swt"][z, 0, x], rel=1e-12)


def test_first_parameter_of_ruiz_is_the_work_of_friction(stress, contact):
    """A quarter of the closed integral of |q . ds|, whose sum over the surface is the dissipated energy."""
    stress(dict(input="c.h5", output="r.h5", depths="0,1e-4", steps=CYCLE, fatigue="ruiz"))
    r = read(contact / "r.h5")
    with h5py.File(contact / "c.h5") as f:
        energy = f["history/dissipated_energy"][40:56].sum()
        q, s = (np.array([f[f"{name}_{c}"][40:56] for c in "xy"]) for name in ("shear", "slip"))
    work = abs((q * (s - np.roll(s, 1, axis=1))).sum(0)).sum(0) / 4
    area = (r["x"][1] - r["x"][0]) * (r["y"][1] - r["y"][0])
    assert np.allclose(r["ruiz_1"][0], work, rtol=0, atol=1e-9 * work.max())
    assert 4 * r["ruiz_1"][0].sum() * area == pytest.approx(energy, rel=1e-3)  # the cycle is not yet steady
    assert np.isnan(r["ruiz_1"][1]).all() and np.isnan(r["ruiz_2"][1]).all()
    row = int(np.argmin(abs(r["y"])))  # slips along x
    slipping = r["ruiz_1"][0, row] > 1e-3 * work.max()
    tension = r["stress_xx"][:, 0, row].max(0).clip(0)
    assert tension[slipping].max() > 1e7
    assert np.allclose(r["ruiz_2"][0, row, slipping], (r["ruiz_1"][0, row] * tension)[slipping], rtol=0.01)


def test_largest_values_are_told_with_their_places(stress, contact):
    stress(dict(input="c.h5", output="l.h5", depths="0,1e-4", steps="12:40:4", quantities="mises,principal", **ALL))
    with h5py.File(contact / "l.h5") as f:
        for name in ("crossland", "dang_van", "findley", "swt", "fatemi_socie", "ruiz_1"):
            values = f[name][:]
            place = np.unravel_index(np.nanargmax(values), values.shape)
            assert f[name].attrs["largest"] == values[place]
            assert f[name].attrs["largest_at"].tolist() == [f[c][k] for c, k in zip("xyz", place[::-1])]
        for name in ("mises", "principal_1"):
            assert f[f"history/{name}_max"][:].tolist() == f[name][:].max(axis=(1, 2, 3)).tolist()
        assert f["history/step"][:].tolist() == list(range(12, 41, 4))
        assert f.attrs["input"] == "c.h5" and "-grid_n 96,95" in f.attrs["input_options"]


def test_cycle_that_is_not_closed_is_warned_of(stress):
    common = dict(input="c.h5", output="w.h5", section="y=0", fatigue="swt", quantities="none")
    assert "not a closed cycle" in stress(dict(common, steps="41:48")).stderr  # half of one
    assert "shear of step 24" in stress(dict(common, steps="9:24")).stderr  # not yet steady
    assert "differs from none before step 1 by up to 100 %" in stress(dict(common, steps="1:8")).stderr  # a first load
    assert "more than one" not in stress(dict(common, steps=CYCLE)).stderr
    assert "more than one" not in stress(dict(common, steps="40:56")).stderr  # both ends


@pytest.mark.parametrize("steps", ["25:56", "33:56", "all", "8:56:8"])
def test_more_than_one_cycle_is_warned_of_with_the_steps_of_one(stress, steps):
    """The preload, or a cycle, is before the last cycle."""
    common = dict(input="c.h5", output="w.h5", section="y=0", fatigue="swt", quantities="none")
    one = "48:56:8" if steps == "8:56:8" else "41:56"
    told = stress(dict(common, steps=steps)).stderr
    said = "more than one cycle: step 40 already has the last step's tractions; for one cycle use"
    assert f"{said} -steps {one}\n" in told


def test_held_loads_are_no_further_cycle(launcher, tmp_path):
    case = dict(SPHERE, friction=0.5, history="h.csv", output="c.h5", steps=4)
    t = PART * slide_limit(case)[0]
    (tmp_path / "h.csv").write_text(f"time,load_tx\n1,{t}\n2,{-t}\n3,{t}\n4,{t}\n")
    conftest.execute(launcher, tmp_path, [case], 1, 0)
    words = dict(input="c.h5", output="w.h5", section="y=0", fatigue="swt", quantities="none", steps="5:16")
    assert "more than one" not in conftest.execute(launcher, tmp_path, [words], 1, 0, program=PROGRAM).stderr


@pytest.mark.parametrize("ranks", [2, 3])
def test_cycle_does_not_depend_on_the_ranks(stress, contact, ranks):
    for section in (None, "x=-3e-4"):
        common = dict(input="coarse.h5", depths="0,3e-4", steps=CYCLE + ":8", section=section, **ALL)
        stress(dict(common, output="one.h5"))
        stress(dict(common, output="many.h5"), ranks=ranks)
        one, many = read(contact / "one.h5"), read(contact / "many.h5")
        assert set(one) == set(many) and set(NAMES) < set(one)
        assert all(np.array_equal(one[k], many[k], equal_nan=True) for k in one)


def test_sections_are_lines_of_the_maps(stress, contact):
    common = dict(input="coarse.h5", depths="0,1e-4", steps=CYCLE + ":5", quantities="mises", **ALL)
    stress(dict(common, output="map.h5"))
    maps = read(contact / "map.h5")
    for section, axis, at in (("y=1e-4", 1, "y"), ("x=-3e-4", 2, "x")):
        stress(dict(common, output="line.h5", section=section))
        line = read(contact / "line.h5")
        k = int(np.argmin(abs(maps[at] - line[at][0])))
        for name in NAMES:
            assert maps[name].shape == (2, 47, 48)
            part, largest = np.take(maps[name], [k], axis=axis), np.nanmax(maps[name])
            # the search over planes may end beside a maximum that is as large
            assert np.allclose(line[name], part, rtol=1e-4, atol=1e-9 * largest, equal_nan=True), name


def test_cycle_in_body_1_of_equal_materials_is_that_in_body_2(launcher, tmp_path):
    """Its shear has the other sign, which is that of half a period later."""
    t = 0.7 * slide_limit(SPHERE)[0]
    (tmp_path / "h.csv").write_text(f"time,load_tx\n1,0\n2,{t}\n3,{-t}\n4,{t}\n5,{-t}\n6,{t}\n")
    case = dict(SPHERE, grid_n=48, history="h.csv", steps=2, output="c.h5")
    conftest.execute(launcher, tmp_path, [case], 1, 0)
    for body in (1, 2):
        run = dict(input="c.h5", output=f"{body}.h5", depths="0,1e-4", steps="9:12", body=body, **ALL)
        assert conftest.execute(launcher, tmp_path, [run], 1, 0, program=PROGRAM).stderr == ""  # it is steady
    one, two = read(tmp_path / "1.h5"), read(tmp_path / "2.h5")
    for name in NAMES:
        if name != "ruiz_1":
            difference = abs(one[name] - two[name])
            assert np.nanmax(difference) < 1e-3 * np.nanmax(two[name]), name
    assert np.array_equal(one["ruiz_1"], two["ruiz_1"], equal_nan=True)


def spoilt(contact, name, change):
    """A copy of the results, changed by change(file)."""
    shutil.copy(contact / "c.h5", contact / name)
    with h5py.File(contact / name, "r+") as f:
        change(f)


def test_numbers_that_are_none_are_refused(stress, contact):
    def put(name, where):
        def change(f):
            f[name][where] = np.nan

        return change

    for name, where in (("pressure", (10, 40, 40)), ("slip_x", (20, 3, 3)), ("history/bulk2_stress_xx", 20)):
        spoilt(contact, "nan.h5", put(name, where))
        done = stress(dict(input="nan.h5", output="no.h5", section="y=0", steps="9:24", fatigue="ruiz"), check=3)
        assert f"/{name} of step" in done.stderr and not (contact / "no.h5").exists()


def test_damaged_columns_are_named(stress, contact):
    for values in ([0.0, 0.0, 0.0], 1.0, np.zeros((56, 2)), ["a"] * 56):

        def change(f, values=values):
            del f["history/bulk2_stress_xx"]
            f["history/bulk2_stress_xx"] = values

        spoilt(contact, "column.h5", change)
        done = stress(dict(input="column.h5", output="no.h5"), ranks=2 if isinstance(values, float) else 1, check=3)
        assert "/history/bulk2_stress_xx" in done.stderr


@pytest.mark.parametrize(
    "name, value, says",
    [
        (
            "pressure",
            np.zeros((56, 4, 5)),
            "/pressure has a shape that does not fit the others: (56, 4, 5), expected (any",
        ),
        ("pressure", ["a"], "/pressure is not what petsam writes"),
        ("pressure", None, "has no dataset /pressure"),
        ("@grid_n", [16.5, 12], "number 0 of grid_n is 16.5: expected a whole number from 1 to 1000000000"),
        ("@grid_n", [1, 12], "grid_n is 1 along x: expected 2 or more"),
        ("@grid_size", [1e-3, np.inf], "number 1 of grid_size is inf: expected a number > 0"),
        ("@grid_center", [np.nan, 0], "number 0 of grid_center is nan: expected a finite number"),
    ],
)
def test_damaged_results_are_refused_with_what_is_expected(name, value, says, stress, contact):
    def change(f):
        of = f.attrs if name[0] == "@" else f
        del of[name.strip("@")]
        if value is not None:
            of[name.strip("@")] = value

    spoilt(contact, "damaged.h5", change)
    assert says in stress(dict(input="damaged.h5", output="no.h5"), check=3).stderr


def test_slip_is_needed_by_ruiz_only(stress, contact):
    def change(f):
        del f["slip_x"], f["slip_y"]

    spoilt(contact, "noslip.h5", change)
    stress(dict(input="noslip.h5", output="s.h5", section="y=0", steps="9:24", fatigue="swt"))
    done = stress(dict(input="noslip.h5", output="no.h5", section="y=0", steps="9:24", fatigue="ruiz"), check=3)
    assert "/slip_x" in done.stderr and not (contact / "no.h5").exists()


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGUSR1])  # others are ignored in the background
def test_signal_leaves_no_file(contact, number):
    words = flatten([dict(input="c.h5", output="long.h5", depths="0:1e-3:60", steps="all", **ALL)])
    run = subprocess.Popen([str(PROGRAM), *words], cwd=contact, env=conftest.environment(), stdout=subprocess.DEVNULL)
    try:
        for _ in range(200):
            time.sleep(0.05)
            if list(contact.glob("long.h5*")):
                break
        time.sleep(0.3)
        run.send_signal(number)
        assert run.wait(30) == -number and not list(contact.glob("long.*"))
    finally:
        run.kill()
        run.wait()
