"""What a run advises after a mistake, or in doubt, is enough to mend it. Wrong input is in refusals.txt."""

import re

import h5py
import numpy as np
import pytest

from conftest import PROGRAM, execute
from support import SPHERE, hertz

FLAT = dict(gap_type="flat", gap_radius1=None, gap_radius2=None)
FILE = dict(gap_type="file", gap_radius1=None, gap_radius2=None, grid_n=(7, 6))
HISTORY = dict(load_n=None, history="loads.csv")
DRIVEN = {**SPHERE, **HISTORY}
LOADS = "time,load_n\n1,500\n2,1000\n"


def test_a_coefficient_of_wear_of_another_unit_is_doubted(petsam, tmp_path):
    """1e-4 mm3/(N m) is 1e-13 1/Pa; no grid holds the scar of 1e-4 1/Pa, and none is advised."""
    (tmp_path / "c.csv").write_text("time,disp_x\n0,1e-5\n1,-1e-5\n2,1e-5\n")
    case = dict(SPHERE, grid_n=48, history="c.csv", wear_cycles=10)
    assert petsam(case, dict(wear_coefficient1=1e-13)).stderr == ""
    warning, error = petsam(case, dict(wear_coefficient1=1e-4), check=12).complaint
    assert "e+06 times the limit of a step" in warning and "1 mm3/(N m) is 1e-9 1/Pa" in warning
    assert error.endswith("check the unit of the coefficient of wear") and "-grid_size" not in error


@pytest.mark.parametrize("kind", ["periodic", "plane_periodic"])
def test_a_contact_without_an_end_has_no_cells_across(petsam, kind):
    done = petsam({**SPHERE, **FLAT, "elasticity": kind})
    assert "  contact     spans the grid\n" in done.stdout and done.stderr == ""


@pytest.mark.parametrize("slope, tilted", [(0.0, False), (3e-6, True)])
def test_a_wave_of_a_period_is_no_tilt(petsam, tmp_path, slope, tilted):
    """Its plane by least squares rises by 1.9 amplitudes, its rms is 0.7; but it goes on over the border."""
    x = (np.arange(32) + 0.5) / 32 - 0.5
    with h5py.File(tmp_path / "w.h5", "w") as f:
        f["height"] = np.tile(1e-6 * np.sin(2 * np.pi * x) + slope * x, (30, 1))
    case = {**SPHERE, **FLAT, **FILE, "grid_n": (32, 30), "elasticity": "periodic", "load_n": 30.0}
    assert ("border of the period" in petsam(case, dict(gap_file="w.h5")).stderr) == tilted


UNITS = dict(grid_size="2.6mm,2600um", body1_young="210GPa", body2_young="210e3MPa", gap_radius1="2e2mm", load_n="1kN")


def test_numbers_with_units_are_those_in_si(launcher, petsam, tmp_path):
    """To the last bit, also among the parameters, and in petsam-stress's depths."""
    petsam(SPHERE, dict(UNITS, load_tx="60N", output="units.h5"))
    petsam(SPHERE, dict(output="si.h5", load_tx=60.0, grid_size="2.6e-3,2.6e-3", gap_radius1=0.2))
    with h5py.File(tmp_path / "units.h5") as units, h5py.File(tmp_path / "si.h5") as si:
        assert all(units.attrs[name] == si.attrs[name] for name in ("body1_young", "body2_young", "gap_radius1"))
        for name in ("x", "pressure", "shear_x", "history/load_n"):
            assert np.array_equal(units[name][:], si[name][:]), name
    stress = ["-input", "si.h5", "-output", "s.h5", "-depths", "0,20um,0.1mm", "-section", "y=0.1mm"]
    execute(launcher, tmp_path, stress, 1, 0, program=PROGRAM.with_name("petsam-stress"))
    with h5py.File(tmp_path / "s.h5") as f:
        assert f["z"][:].tolist() == [0.0, 20e-6, 0.1e-3]


SMALL = dict(load_n="1uN", grid_size="0.8um", gap_radius1="1um", adhesion_work="50mJ/m2", adhesion_stress="20MPa")


def test_small_units_of_surfaces_that_attract_are_those_in_si(petsam, tmp_path):
    petsam(SPHERE, dict(SMALL, body2_young="3GPa", friction=0, output="units.h5"))
    plain = dict(load_n=1e-6, grid_size=0.8e-6, gap_radius1=1e-6, adhesion_work=50e-3, adhesion_stress=20e6)
    petsam(SPHERE, dict(plain, body2_young=3e9, friction=0, output="si.h5"))
    with h5py.File(tmp_path / "units.h5") as units, h5py.File(tmp_path / "si.h5") as si:
        assert all(units.attrs[name] == si.attrs[name] for name in ("adhesion_work", "load_n") if name in si.attrs)
        for name in ("x", "pressure", "history/load_n", "history/disp_z"):
            assert np.array_equal(units[name][:], si[name][:]), name


# ---------------------------------------------------------------- advice that is followed helps


def advised(line, *names):
    """The words of the options that a message names, for which it would be well."""
    found = {name: re.search(rf"-{name} ([-\d.e,]+\d)", line) for name in names}
    assert all(found.values()), line
    return [word for name in names for word in ("-" + name, found[name].group(1))]


@pytest.mark.parametrize(
    "change", [dict(grid_size=2.6), dict(grid_size=9e-3), dict(grid_size=0.06, grid_n=(50, 64))], ids=str
)
@pytest.mark.parametrize("name", ["grid_size", "grid_n"])
def test_advised_grid_has_enough_cells(petsam, change, name):
    done = petsam(SPHERE, change)
    if name == "grid_n" and change["grid_size"] == 2.6:  # it would have more cells than anybody has memory for
        assert "-grid_n" not in done.complaint[0]
        return
    assert petsam(SPHERE, change, *advised(done.complaint[0], name)).stderr == ""


ELLIPSOID = dict(gap_type="ellipsoid", gap_radius1=None, gap_radius2=None, gap_radius_x=0.4, gap_radius_y=0.06)
PUNCH = dict(
    gap_type="punch", gap_radius1=None, gap_radius2=None, gap_flat_radius=2e-3, gap_edge_radius=0.05, load_n=9e3
)


@pytest.mark.parametrize(
    "change",
    [
        dict(grid_size=1.1e-3),
        dict(grid_size=1e-3, grid_n=(40, 33)),
        dict(grid_size=(1e-3, 4e-3), grid_n=(20, 80), grid_center=(2e-4, 0)),
        dict(ELLIPSOID, grid_size=1.2e-3),
        dict(PUNCH, grid_size=4e-3),
        dict(load_n=None, disp_z=2e-5, grid_size=1.3e-3),
        dict(load_my=0.4, load_mx=-0.3, grid_size=1.6e-3),
        dict(body2_young=60e9, body2_poisson=0.1, load_tx=80.0, grid_size=1.2e-3),
        dict(load_n=None, disp_z=1e-5, rot_y=5e-3, grid_size=2.3e-3),
    ],
    ids=str,
)
def test_advised_grid_holds_the_contact(petsam, change):
    done = petsam({**SPHERE, **change}, check=12)
    petsam({**SPHERE, **change}, *advised(done.complaint[-1], "grid_size", "grid_n"))


def test_advised_grid_holds_the_whole_history(petsam, tmp_path):
    """The contact comes to the edge in an early step; what is advised is for the largest load, and keeps the cells."""
    (tmp_path / "loads.csv").write_text("time,load_n,load_my\n1,100,0\n2,900,0\n3,5000,0.5\n4,50,0\n")
    case = dict(DRIVEN, grid_size=1.4e-3, output="out.h5")
    done = petsam(case, check=12)
    words = advised(done.complaint[0], "grid_size", "grid_n")
    assert float(words[1]) / int(words[3]) <= 1.4e-3 / 64
    radius = hertz(dict(SPHERE, load_n=5000.0)).radius
    assert 2 * radius <= float(words[1]) <= 3 * radius
    petsam(case, *words)
    with h5py.File(tmp_path / "out.h5") as f:
        assert f["history/status"][:].tolist() == [0, 0, 0, 0]


# ---------------------------------------------------------------- once a run


def test_run_ends_at_the_edge_with_that_step(petsam, tmp_path):
    (tmp_path / "loads.csv").write_text("time,load_n\n1,100\n2,900\n3,5000\n4,50\n")
    case = dict(DRIVEN, grid_size=1.4e-3, output="out.h5", output_every=10)
    done = petsam(case, check=12)
    assert len(done.complaint) == 1 and "step 2" in done.complaint[0]
    with h5py.File(tmp_path / "out.h5") as f:
        assert f["history/status"][:].tolist() == [0, 12]
        assert f["time"][:].tolist() == [2.0] and f["pressure"][-1].max() > 0
    done = petsam(case, "-allow_edge_contact")
    assert len(done.complaint) == 1 and "warning: step 2" in done.complaint[0]
    with h5py.File(tmp_path / "out.h5") as f:
        assert f["history/status"][:].tolist() == [0, 0, 0, 0]


@pytest.mark.parametrize("ranks", [1, 3])
def test_cells_across_are_those_of_the_largest_load(petsam, tmp_path, ranks):
    """Small contacts on the way to the load are no reason to warn, and one warning is enough for a history."""
    (tmp_path / "loads.csv").write_text("time,load_n\n0,0\n1,1000\n2,20\n3,1000\n")
    done = petsam(DRIVEN, dict(steps=4), ranks=ranks)
    assert not done.complaint
    across = float(re.search(r"contact +([\d.]+) cells across \(step 5, at the largest load\)", done.stdout).group(1))
    assert abs(across - 64 / 1.5) <= 1
    done = petsam(DRIVEN, dict(steps=4, grid_n=18), ranks=ranks)
    assert len(done.complaint) == 1 and "12 cells across" in done.complaint[0]


def test_rough_surface_is_warned_of_once(petsam, tmp_path):
    """Many small spots: one line that says so, and what would help."""
    rng = np.random.default_rng(3)
    with h5py.File(tmp_path / "rough.h5", "w") as f:
        f["height"] = 1e-6 * rng.random((64, 64))
    done = petsam(SPHERE, dict(load_n=30.0), "-gap_rough_file", "rough.h5")
    assert len(done.complaint) == 1
    assert re.search(r"the contact is in \d+ spots, the narrow ones [\d.]+ cells? across", done.complaint[0])
    assert ": use a file with heights at smaller distances" in done.complaint[0]


def test_checkpoint_says_when_it_is_written(petsam, tmp_path):
    line = re.search(r"checkpoint +(.*)", petsam(SPHERE, dict(checkpoint="s.h5")).stdout).group(1)
    assert "s.h5: only on USR2, and on TERM or USR1 (to stop)" in line and "-checkpoint_every k" in line
    line = re.search(r"checkpoint +(.*)", petsam(SPHERE, dict(checkpoint="s.h5", checkpoint_every=7)).stdout).group(1)
    assert "after every 7 steps" in line and "-checkpoint_every k" not in line
    line = re.search(r"checkpoint +(.*)", petsam(SPHERE, dict(checkpoint="s.h5", max_walltime="1:40")).stdout).group(1)
    assert "before 100 s have passed" in line


@pytest.mark.parametrize("change", [dict(body1_young=200e9), dict(friction=0.2), dict(grid_n=32)], ids=str)
def test_restart_with_another_option_names_it(petsam, tmp_path, change):
    (tmp_path / "loads.csv").write_text(LOADS)
    petsam(DRIVEN, dict(checkpoint="s.h5", checkpoint_every=1))
    done = petsam(DRIVEN, dict(restart="s.h5"), change, check=2)
    assert "-restart s.h5" in done.complaint[0] and "-" + next(iter(change)) in done.complaint[0]


# ---------------------------------------------------------------- petsam-stress


def test_a_value_with_a_unit_in_a_step_is_explained():
    import petsam as package

    bodies = {name: value for name, value in SPHERE.items() if name not in ("load_n", "output_fields")}
    with package.Contact(**bodies) as contact:
        with pytest.raises(TypeError, match="load_n: .*give a number in SI units"):
            contact.try_step(load_n="1kN")


def test_numbers_of_another_unit_are_told(launcher, petsam, tmp_path):
    """A bulk stress in MPa, a grid in mm, depths in um."""
    told = petsam(SPHERE, dict(bulk2_stress_xx=50, output="r.h5")).complaint
    assert any("the largest bulk stress, 50 Pa, is" in line and "check the unit, Pa" in line for line in told)
    case = dict(SPHERE, gap_radius1=2e5, gap_radius2=2e5, grid_size=1200.0, load_n=1e13)
    told = petsam(case, check=None).complaint
    assert any("the grid is 1200 m wide: check the unit, m" in line for line in told)
    stress = ["-input", "r.h5", "-output", "deep.h5", "-depths", "0.5"]
    done = execute(launcher, tmp_path, stress, 1, 0, program=PROGRAM.with_name("petsam-stress"))
    assert "times the width of the grid: check the unit, m" in done.stderr


@pytest.mark.parametrize("cells, across", [((128, 8), None), ((16, 8), 4), ((8, 128), None), ((8, 16), 4)])
def test_a_cylinder_is_as_wide_as_it_touches(petsam, cells, across):
    """Along its axis it ends nowhere: cells there are none too few, and more of them no help."""
    axis = int(cells[0] < cells[1])
    radii = {"gap_type": "ellipsoid", "gap_radius_" + "xy"[axis]: 0.1, "gap_radius_" + "yx"[axis]: "inf"}
    size = (4e-3, 1e-4) if axis == 0 else (1e-4, 4e-3)
    case = {**SPHERE, "gap_radius1": None, "gap_radius2": None, **radii, "elasticity": "periodic"}
    done = petsam(case, dict(grid_n=cells, grid_size=size, load_n=20.0, load_tx=None))
    assert len(done.complaint) == (across is not None)
    if across:
        more = ["90" if n == 16 else str(n) for n in cells]  # at least 16*22/4, and a product of 2, 3 and 5
        assert "-grid_n " + ",".join(more) in done.complaint[0], done.complaint


def test_full_contact_of_periodic_bodies_has_no_width(petsam):
    """A few cells are all there are: nothing ends within them."""
    flat = {**SPHERE, **FLAT}
    flat.update(grid_n=16, elasticity="periodic")
    assert petsam(flat).stderr == ""


@pytest.mark.parametrize(
    "options, code, told",
    [
        (dict(friction="0.3\nabc"), 2, r"-friction 0.3\nabc: expected a number >= 0"),
        (dict(gap_type="\x1b[31msphere\x7f"), 2, r"-gap_type \x1b[31msphere\x7f: expected curved"),
        ({"load_tx\r": 1.0}, 2, r"-load_tx\r 1.0: unknown option"),
        (dict(malloc_debug="a\tb"), 2, r"PETSc cannot take the options: Unknown logical value: a\tb"),
        (dict(gap_type="file", gap_file="no\nfile"), 3, r"-gap_file no\nfile: cannot be read"),
        (dict(gap_type="a\u2028b\x9b\x85ä"), 2, r"-gap_type a\u2028b\u009b\u0085ä: expected curved"),
    ],
)
def test_a_control_character_does_not_break_the_line_of_a_message(petsam, options, code, told):
    first = petsam(SPHERE, options, check=code).stderr.splitlines()[0]
    assert first.startswith("petsam: " + told)


def test_nor_does_one_in_a_warning(petsam, tmp_path):
    """The name of a file, in a warning of the history's columns."""
    (tmp_path / "a\nb.csv").write_text(LOADS)
    (tmp_path / "n.opts").write_text("-load_n 100\n")
    done = petsam({**DRIVEN, "history": "a\nb.csv"}, dict(options_file="n.opts"))
    assert done.stderr == "petsam: warning: -load_n of the options file is not used: a\\nb.csv has the column load_n\n"


@pytest.mark.parametrize(
    "name, line", [("grid_n:", "-grid_n: 64"), ("grid_n,", "-grid_n, 64"), ("-grid_n", "--grid_n 3")]
)
def test_unknown_option_is_told_with_its_own_file_and_line(launcher, tmp_path, name, line):
    """Not with those of an option in an earlier file whose name begins like it."""
    (tmp_path / "f1").write_text("-grid_n 64\n")
    files = ["-options_file", "f1", "-options_file", "f2"]
    (tmp_path / "f2").write_text(f"# more\n{line}\n")
    done = execute(launcher, tmp_path, [{**SPHERE, "grid_n": None}, *files], 1, 2)
    assert f"f2, line 2: -{name} " in done.stderr and "f1" not in done.stderr


@pytest.mark.parametrize("variable, value, told", [
    ("SLURM_STEP_NUM_TASKS", "4", 4), ("PMI_SIZE", "2", 2), ("PMIX_RANK", "2", 3), ("OMPI_COMM_WORLD_SIZE", "1", 0)
])  # fmt: skip
def test_copies_by_another_launcher_are_told(petsam, monkeypatch, variable, value, told):
    monkeypatch.setenv(variable, value)
    said = [line for line in petsam(SPHERE, dict(load_n=60.0, grid_n=32)).complaint if "copy of the whole run" in line]
    assert len(said) == (1 if told else 0)
    assert not told or f"started {told} processes or more ({variable}), but MPI has 1 rank" in said[0]
