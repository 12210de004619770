"""The results file, and what the program prints."""

import re

import h5py
import numpy as np
import pytest

from conftest import PROGRAM, execute
from petsam.results import Results
from petsam.results.stresses import Stresses
from support import FIELDS, LOADS, RIGID, SPHERE, assert_same, ball

CASE = dict(
    ball(),
    grid_n=(34, 41),
    grid_size=(1.9e-3, 2.1e-3),
    grid_center=(1e-4, -5e-5),
    load_tx=20.0,
    load_my=0.01,
    rot_z=1e-5,
)
UNITS = dict(
    pressure="Pa",
    shear_x="Pa",
    shear_y="Pa",
    slip_x="m",
    slip_y="m",
    gap="m",
    displacement_x="m",
    displacement_y="m",
    displacement_z="m",
    state="1",
    x="m",
    y="m",
    time="s",
)
HISTORY = dict(
    time="s",
    load_n="N",
    load_tx="N",
    load_ty="N",
    load_mx="N m",
    load_my="N m",
    load_mz="N m",
    disp_z="m",
    disp_x="m",
    disp_y="m",
    rot_x="rad",
    rot_y="rad",
    rot_z="rad",
    contact_area="m2",
    stick_area="m2",
    normal_residual="1",
    tangential_residual="1",
    dissipated_energy="J",
    stored_energy="J",
    energy_error="J",
    dissipated_energy_closed="J",
    edge_accepted="1",
    slip_width="m",
    contact_half_x="m",
    contact_half_y="m",
    stick_half_x="m",
    stick_half_y="m",
    pressure_max="Pa",
    shear_max="Pa",
)
COUNTS = (
    "contact_cells",
    "stick_cells",
    "normal_iterations",
    "tangential_iterations",
    "normal_applies",
    "tangential_applies",
    "normal_preconditions",
    "tangential_preconditions",
    "coupling_iterations",
    "status",
)


@pytest.fixture
def file(solve):
    with h5py.File(solve(CASE).path, "r") as f:
        yield f


@pytest.mark.parametrize("name", FIELDS)
def test_field_is_time_y_x(file, name):
    data = file[name]
    assert data.shape == (1, 41, 34)
    assert data.dtype == (np.int8 if name == "state" else np.float64)
    assert [data.dims[k][0].name for k in range(3)] == ["/time", "/y", "/x"]
    assert data.maxshape[0] is None


@pytest.mark.parametrize("name", UNITS)
def test_units(file, name):
    assert file[name].attrs["units"] == UNITS[name]


@pytest.mark.parametrize("name", list(HISTORY) + list(COUNTS))
def test_history_has_a_value_a_step(file, name):
    data = file["history"][name]
    assert data.shape == (1,) and np.all(np.isfinite(data[:])) == (name != "dissipated_energy_closed")  # none here
    assert data.dtype.kind == ("i" if name in COUNTS else "f")
    assert data.attrs["units"] == HISTORY.get(name, "1")


def test_every_dataset_has_units_and_a_name(file):
    lacking = []
    file.visititems(
        lambda name, item: (
            lacking.append(name)
            if isinstance(item, h5py.Dataset) and not (item.attrs.get("units") and item.attrs.get("long_name"))
            else None
        )
    )
    assert not lacking


def test_coordinates_are_cell_centres(file):
    d = 1.9e-3 / 34, 2.1e-3 / 41
    assert np.allclose(file["x"], 1e-4 - 1.9e-3 / 2 + (np.arange(34) + 0.5) * d[0], rtol=0, atol=1e-18)
    assert np.allclose(file["y"], -5e-5 - 2.1e-3 / 2 + (np.arange(41) + 0.5) * d[1], rtol=0, atol=1e-18)


def test_time_of_a_single_step_is_1(file):
    assert file["time"][:].tolist() == file["history/time"][:].tolist() == [1.0]


def test_root_names_version_and_options(file, petsam):
    assert file.attrs["petsam_version"] in petsam("--version").stdout
    for name in CASE:
        assert f"-{name} " in file.attrs["options"]


def test_physical_parameters_are_attributes(file):
    for name, value in CASE.items():
        if not isinstance(value, tuple) and name != "output_fields":
            assert file.attrs[name] == value, name


def test_grid_parameters_have_their_options_names(file):
    """The contract: every physical parameter by its option's name; of a pair the attribute holds both."""
    for name, value in CASE.items():
        if isinstance(value, tuple):
            assert np.array_equal(file.attrs[name], value), name


def test_gap_and_roughness_files_are_known(petsam, tmp_path):
    with h5py.File(tmp_path / "g.h5", "w") as f:
        f["h"] = np.add.outer((np.arange(9) - 4.0) ** 2, (np.arange(8) - 3.5) ** 2) * 1e-7
    petsam(
        dict(
            SPHERE,
            grid_n=(8, 9),
            gap_type="file",
            gap_radius1=None,
            gap_radius2=None,
            gap_file="g.h5",
            gap_dataset="/h",
            load_n=1.0,
            gap_rough_file="g.h5",
            gap_rough_dataset="/h",
            output="out.h5",
        )
    )
    with h5py.File(tmp_path / "out.h5") as f:
        assert f.attrs["gap_type"] == "file"
        assert "-gap_file g.h5" in f.attrs["options"] and "-gap_rough_dataset /h" in f.attrs["options"]


def test_infinite_parameters_are_stored(solve):
    s = solve(dict(CASE, body2_young=float("inf"), body2_poisson=None, body1_poisson=0.5))
    assert s.attributes["body2_young"] == np.inf and s.attributes["gap_radius2"] == np.inf


def test_results_replace_an_older_file(petsam, tmp_path):
    done = petsam(CASE, dict(output="out.h5", grid_n=20))
    assert "replacing" not in done.stdout
    done = petsam(CASE, dict(output="out.h5"))
    assert "results in out.h5, replacing those there" in done.stdout
    with h5py.File(tmp_path / "out.h5") as f:
        assert f["pressure"].shape == (1, 41, 34)


def test_an_open_reader_keeps_the_run_that_it_has_opened(petsam, launcher, tmp_path):
    """Loads that were read before another run of the name, and fields after it, are of one run."""
    stress = dict(input="out.h5", output="s.h5", depths="0")
    readers, largest = [], []
    for load in (100.0, 200.0):
        petsam(dict(CASE, load_n=load, output="out.h5"))
        execute(launcher, tmp_path, [stress], 1, 0, program=PROGRAM.with_name("petsam-stress"))
        readers += [Results(tmp_path / "out.h5"), Stresses(tmp_path / "s.h5")]
        largest += [readers[-2].field("pressure").max(), readers[-1].field("mises").max()]
    assert largest == [readers[k].field(("pressure", "mises")[k % 2]).max() for k in range(4)]
    assert len({*largest}) == 4


def write_hdf5(path):
    with h5py.File(path, "w") as f:
        f["pressure"] = np.zeros(9)


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize(
    "name, write",
    [("out.h5", lambda path: path.write_text("the only copy of a long text")), ("out.h5", write_hdf5)],
    ids=["text", "other HDF5"],
)
def test_files_of_others_are_not_replaced(petsam, tmp_path, ranks, name, write):
    path = tmp_path / name
    write(path)
    before = path.read_bytes()
    done = petsam(CASE, dict(output="out.h5"), ranks=ranks, check=3)
    assert f"-output {name}: cannot be written: there is a file of that name" in done.complaint[0]
    assert path.read_bytes() == before and [entry.name for entry in tmp_path.iterdir()] == [name]


def test_temporary_file_of_a_killed_run_is_replaced_and_a_readable_one_is_not(petsam, tmp_path):
    """A run that is killed in its first flush leaves HDF5 without a word of petsam in it, which nobody can open."""
    path = tmp_path / "state.h5.tmp"
    write_hdf5(path)
    whole = path.read_bytes()
    done = petsam(CASE, dict(checkpoint="state.h5", checkpoint_every=1), check=3)
    assert "state.h5.tmp: cannot be written" in done.complaint[0] and path.read_bytes() == whole
    path.write_bytes(whole[:600])
    petsam(CASE, dict(checkpoint="state.h5", checkpoint_every=1))
    assert not path.exists()


def test_checkpoint_is_not_replaced_by_results(petsam, tmp_path):
    petsam(CASE, dict(checkpoint="state.h5", checkpoint_every=1))
    before = (tmp_path / "state.h5").read_bytes()
    assert "-output state.h5" in petsam(CASE, dict(output="state.h5"), check=3).complaint[0]
    assert (tmp_path / "state.h5").read_bytes() == before
    petsam(CASE, dict(output="out.h5"))
    assert "-checkpoint out.h5" in petsam(CASE, dict(checkpoint="out.h5", checkpoint_every=1), check=3).complaint[0]
    with h5py.File(tmp_path / "out.h5") as f:
        assert len(f["time"]) == 1


def test_without_output_no_file_is_written(petsam, tmp_path):
    petsam(CASE)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("ranks", [1, 3])
def test_compressed_fields_are_the_same(solve, ranks):
    one, two = solve(CASE), solve(CASE, dict(output_compress=6), ranks=ranks)
    assert_same(two, one, 1e-9)
    with h5py.File(two.path) as f:
        assert f["pressure"].compression == "gzip"


# ---- what is printed


@pytest.mark.parametrize("word, ranks", [("-help", 1), ("--help", 2), ("-h", 1)])
def test_help_names_every_option_once(petsam, tmp_path, word, ranks):
    done = petsam(word, ranks=ranks)
    for name in (
        list(SPHERE)
        + [
            "grid_center",
            *LOADS,
            *RIGID,
            "gap_file",
            "gap_dataset",
            "gap_rough_file",
            "gap_rough_dataset",
            "gap_radius_x",
            "gap_radius_y",
            "gap_flat_radius",
            "gap_edge_radius",
            "coupling",
            "coupling_rtol",
            "coupling_max_it",
            "output",
            "allow_edge_contact",
        ]
        + [
            f"{solver}_{option}"
            for solver in ("normal", "tangential")
            for option in ("type", "rtol", "max_it", "monitor", "converged_reason", "view")
        ]
    ):
        assert len(re.findall(rf"^  -{name} ", done.stdout, re.M)) == 1, name
    assert done.stderr == "" and not list(tmp_path.iterdir())


def test_help_beside_a_study_does_not_run_it(petsam, tmp_path):
    petsam(CASE, "-help", "-output", "out.h5")
    assert not list(tmp_path.iterdir())


def test_version_is_one_number(petsam):
    assert re.match(r"petsam \d+\.\d+\.\d+\n", petsam("--version").stdout)


def test_summary_tells_loads_and_counts(petsam, solve):
    s, done = solve(CASE), petsam(CASE, "-profile")
    for name in LOADS + RIGID:
        shown = float(re.search(rf"\b{name} +(\S+)", done.stdout).group(1))
        assert shown == pytest.approx(s[name], rel=1e-6, abs=1e-12), name
    assert f"normal {s['normal_iterations']} ({s['normal_applies']} applications)" in done.stdout
    grids = re.findall(r"^ +(\d+) x (\d+) +normal +(\d+) .* s, tangential +(\d+) ", done.stdout, re.M)
    assert grids[0][2:] == (f"{s['normal_applies']}", f"{s['tangential_applies']}")
    assert all(int(fine[0]) == 2 * int(coarse[0]) for fine, coarse in zip(grids, grids[1:])) and len(grids) > 1


@pytest.mark.parametrize("solver", ["normal", "tangential"])
@pytest.mark.parametrize("ranks", [1, 2])
def test_monitor_prints_falling_errors(petsam, solve, solver, ranks):
    done = petsam(CASE, f"-{solver}_monitor", ranks=ranks)
    lines = re.findall(rf"^ *(\d+) {solver} \w+ error (\S+)", done.stdout, re.M)
    # as KSP's monitor does, the last line tells the error at which the solver stopped
    assert len(lines) >= 2 and float(lines[-1][1]) <= 1.05 * (1e-8 if solver == "normal" else 1e-6)
    assert int(lines[-1][0]) == solve(CASE)[f"{solver}_iterations"]
    other = "tangential" if solver == "normal" else "normal"
    assert not re.findall(rf"^ *\d+ {other} \w+ error", done.stdout, re.M)


@pytest.mark.parametrize("solver", ["normal", "tangential"])
def test_converged_reason_is_printed_once(petsam, solver):
    done = petsam(CASE, f"-{solver}_converged_reason", ranks=2)
    assert len(re.findall(rf"^The {solver} solve converged due to \w+ iterations \d+$", done.stdout, re.M)) == 1


@pytest.mark.parametrize("solver", ["normal", "tangential"])
def test_reason_of_failure_is_printed(petsam, solver):
    done = petsam(CASE, f"-{solver}_converged_reason", f"-{solver}_max_it", "1", check=10)
    assert re.search(rf"^The {solver} solve did not converge due to \w+", done.stdout, re.M)


@pytest.mark.parametrize("solver, kind", [("normal", "activeset"), ("tangential", "newton")])
def test_view_prints_the_settings(petsam, solver, kind):
    done = petsam(ball(40), f"-{solver}_view", f"-{solver}_type", kind, f"-{solver}_rtol", "3e-7")
    assert re.search(rf"{solver} problem: type {kind}\n.*rtol 3e-07", done.stdout)


def test_view_may_go_to_a_file(petsam, tmp_path):
    petsam(CASE, "-normal_view", ":view.txt")
    assert "activeset" in (tmp_path / "view.txt").read_text()


def test_contact_check_prints_the_check(petsam):
    assert re.search(
        r"check: normal \S+ tangential \S+ equilibrium \S+ cone \S+", petsam(CASE, "-contact_check").stdout
    )


@pytest.mark.parametrize("ranks", [1, 2])
def test_log_view_shows_own_events(petsam, ranks):
    done = petsam(CASE, "-log_view", ranks=ranks)
    assert "Performance Summary" in done.stdout
    assert re.search(r"^Sam\w+ ", done.stdout, re.M), "no event of petsam"


def test_log_view_goes_to_xml(petsam, tmp_path):
    petsam(CASE, "-log_view", ":log.xml:ascii_xml")
    assert "<petscroot>" in (tmp_path / "log.xml").read_text()


@pytest.mark.parametrize(
    "change, code",
    [
        ({}, 0),
        (dict(stiffness=True), 0),
        (dict(body2_young=9e9, load_n=20.0, load_my=0.0, load_tx=2.0), 0),
        (dict(load_tx=900.0), 11),
        (dict(load_my=9.0), 11),
        (dict(grid_size=5e-4), 12),
        (dict(tangential_max_it=1), 10),
        (dict(load_n=-1.0), 2),
        (dict(gap_rough_file="nowhere.h5"), 3),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, dict) else str(value),
)
def test_nothing_leaks(petsam, change, code):
    done = petsam({**CASE, "output": "out.h5", **change}, "-malloc_debug", "-malloc_dump", check=code)
    text = done.stdout + done.stderr
    assert not re.search(
        r"^\[ *\d+\] ?\d+ bytes|Memory was not freed|\[\d+\]Total space allocated (?!0)", text, re.M
    ), text[-3000:]


def test_objects_dump_lists_nothing(petsam):
    assert "not been freed" not in petsam(CASE, "-objects_dump").stdout


def test_known_petsc_options_are_taken(petsam):
    petsam(CASE, "-options_left", "-log_view_memory", "-memory_view", "-options_view", "-malloc_view")


# ---- settings that leave the solution as it is


def test_levels_do_not_change_the_answer(solve):
    case = ball(90, load_tx=30.0)
    assert_same(solve(dict(case, normal_levels=1, tangential_levels=1)), solve(case), 1e-4)


@pytest.mark.parametrize("effort", ["measure", "patient"])
def test_effort_of_planning_does_not_change_the_answer(solve, effort):
    # other plans round otherwise: that shows up to the solvers' tolerances, here below what is asked
    case = ball(45, load_tx=30.0, normal_rtol=1e-11, tangential_rtol=1e-9)
    assert_same(solve(dict(case, fft_effort=effort)), solve(case), 1e-8)


@pytest.mark.parametrize("there", [True, False], ids=["to a file", "to nothing yet"])
def test_a_link_stays_one_and_the_file_behind_it_is_written(petsam, launcher, tmp_path, there):
    """Results, checkpoints with the one before, and stresses; their temporary files are in the folder of the target."""
    (tmp_path / "far").mkdir()
    names = ("r.h5", "c.h5", "s.h5")
    for name in names:
        (tmp_path / name).symlink_to(f"far/{name}")
    case = dict(CASE, steps=2, output="r.h5", checkpoint="c.h5", checkpoint_every=1)
    for _ in range(1 + there):
        petsam(case, "-overwrite")
        stress = PROGRAM.with_name("petsam-stress")
        execute(launcher, tmp_path, [dict(input="r.h5", output="s.h5", depths="1e-5")], 1, 0, program=stress)
    assert all((tmp_path / name).is_symlink() and (tmp_path / "far" / name).stat().st_size > 1000 for name in names)
    assert sorted(path.name for path in (tmp_path / "far").iterdir()) == ["c.h5", "c.h5.1", "r.h5", "s.h5"]
    assert len(Results(tmp_path / "r.h5").history["time"]) == 2
    petsam(case, dict(restart="c.h5", output="n.h5"))
