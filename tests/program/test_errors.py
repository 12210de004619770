"""-errors companion: numbers of companion runs, the errors that follow from them, their restart, and their warnings."""

import contextlib
import re

import h5py
import numpy as np
import pytest

import capabilities
import petsam as package
from support import SPHERE, few, history

LOOP = ("time,load_n,load_tx", (1, 1000, 60), (2, 1000, -60), (3, 1000, 20))
NAMES = {
    "contact_area", "stick_area", "pressure_max", "shear_max", "slip_max", "stored_energy", "dissipated_energy",
    "disp_z", "disp_x",
}  # fmt: skip


@pytest.fixture(autouse=True)
def there(tmp_path, monkeypatch):
    """Tests run in their folder."""
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def loop(tmp_path):
    """A sphere under N and a T that turns, 65 cells, 4 steps per row."""
    case = {**SPHERE, "load_n": None, "steps": 4, "friction": 0.1, "grid_n": 65}
    return {**case, **history(tmp_path / "loop.csv", *LOOP)}


def table(path):
    """{name: {column: value}} of /errors."""
    with h5py.File(path) as f:
        names = [name.decode() for name in f["errors/name"][:]]
        columns = {column: data[:] for column, data in f["errors"].items() if column != "name"}
        return {name: {column: data[k] for column, data in columns.items()} for k, name in enumerate(names)}


def test_python_reads_errors_as_a_table(petsam, tmp_path, loop):
    petsam(loop, "-errors", "companion", "-output", "own.h5")
    petsam(loop, "-output", "none.h5")
    found = package.open("own.h5").errors
    expected = table("own.h5")
    assert list(found) == list(expected) and not package.open("none.h5").errors
    for name, row in found.items():
        assert row.unit == expected[name]["unit"].decode() and row.cause == expected[name]["cause"].decode()
        causes = ("by_cells", "by_steps", "by_layers", "by_mesh")
        for column in ("value", "error", *causes, "factor", "half", "quarter", "other"):
            np.testing.assert_equal(getattr(row, column), expected[name][column])
    assert re.fullmatch(r"\S+ J \+-\S+ %", str(found["dissipated_energy"]))
    found.to_csv("errors.csv")
    lines = (tmp_path / "errors.csv").read_text().splitlines()
    assert lines[0].startswith("name,unit,value,error [1],by_cells [1],") and len(lines) == 1 + len(found)
    part = package.open("own.h5").between(1, 3)
    assert part.errors == found


def last(path, series="history"):
    """Numbers of the last step of a run, and frictional work of all steps; or those of its last cycle."""
    with h5py.File(path) as f:
        values = {name: data[-1] for name, data in f[series].items()}
        return values if series == "wear" else dict(values, dissipated_energy=f["history/dissipated_energy"][:].sum())


def by_cells(name, own, half, quarter):
    """The error of a number by its cells: the larger difference, by the order of energies, or by the first one."""
    near, far = (2, 8) if name.endswith("_energy") else (1, 2)
    return np.maximum(abs(own - half) / near, abs(half - quarter) / far)


def test_companions_are_runs_on_other_cells_and_with_other_steps(petsam, tmp_path, loop):
    """An odd number of cells: the coarser ones are 2 - 1/33 times as wide."""
    petsam(loop, "-errors", "companion", "-output", "own.h5")
    found, own = table("own.h5"), last("own.h5")
    others = dict(half=dict(grid_n=33), quarter=dict(grid_n=17), other=dict(grid_n=17, steps=2))
    for name, change in others.items():
        petsam(loop, change, "-output", f"{name}.h5")
    runs = {name: last(f"{name}.h5") for name in others}
    assert set(found) == NAMES
    for name, row in found.items():
        assert np.isclose(row["value"], own[name], rtol=1e-12), name
        for run, numbers in runs.items():
            assert np.isclose(row[run], numbers[name], rtol=1e-9), (name, run)
        cells = by_cells(name, row["value"], row["half"], row["quarter"]) / abs(row["value"])
        steps = abs(row["quarter"] - row["other"]) / abs(row["value"])
        if name != "dissipated_energy":
            assert np.allclose([row["by_cells"], row["by_steps"]], [cells, steps]), name
        assert row["by_cells"] >= cells * (1 - 1e-12) and row["by_steps"] >= steps * (1 - 1e-12)
        assert np.isclose(row["error"], row["by_cells"] + row["by_steps"])
        assert row["cause"] == (b"steps" if row["by_steps"] > row["by_cells"] else b"cells")


def test_energies_of_bodies_that_yield_are_of_first_order(petsam, loop):
    petsam(loop, "-errors", "companion", dict(body2_yield=5e8, grid_n=32, steps=1), "-output", "own.h5")
    row = table("own.h5")["dissipated_energy"]
    cells = by_cells("of first order", row["value"], row["half"], row["quarter"]) / abs(row["value"])
    assert row["by_cells"] >= cells * (1 - 1e-9) and cells > 1e-3


@pytest.mark.parametrize("cells, other", [(61, 16), (60, 30)])
def test_other_steps_are_taken_on_a_quarter_of_the_cells_unless_these_are_few(petsam, tmp_path, loop, cells, other):
    said = petsam(loop, "-errors", "companion", dict(grid_n=cells)).stdout
    assert f"on {other} x {other} cells with 2 steps per row" in said


def test_errors_are_those_of_a_finer_run(petsam, tmp_path, loop):
    """Each error is at least half the true one, and none is more than 30 times it and 6 %."""
    petsam(loop, "-errors", "companion", "-output", "own.h5")
    petsam(loop, dict(grid_n=260, steps=16), "-output", "fine.h5")
    true = last("fine.h5")
    for name, row in table("own.h5").items():
        error = abs(row["value"] - true[name]) / abs(true[name])
        assert row["error"] >= 0.5 * error, (name, row["error"], error)
        assert row["error"] < max(30 * error, 0.06), (name, row["error"], error)


def test_each_step_has_its_errors(petsam, tmp_path, loop):
    petsam(loop, "-errors", "companion", "-output", "own.h5")
    petsam(loop, dict(grid_n=33), "-output", "half.h5")
    petsam(loop, dict(grid_n=17), "-output", "quarter.h5")
    with h5py.File("own.h5") as own, h5py.File("half.h5") as half, h5py.File("quarter.h5") as quarter:
        b, h, q = (file["history"] for file in (own, half, quarter))
        assert b["shear_max_error"].attrs["units"] == b["shear_max"].attrs["units"]
        assert np.all(b["load_n_error"][:] == 0)  # it is prescribed
        for name in ("shear_max", "contact_area", "dissipated_energy", "disp_z"):
            error = b[f"{name}_error"][:]
            cells = by_cells(name, b[name][:], h[name][:], q[name][:])
            assert np.isnan(error[0]) and np.all(np.isfinite(error[1:])), name  # half as many steps: from the second on
            assert np.all(error[1:] >= cells[1:] * (1 - 1e-9)), name
    petsam(loop, dict(grid_n=17, steps=2), "-output", "other.h5")
    with contextlib.ExitStack() as stack:
        files = [stack.enter_context(h5py.File(f"{name}.h5")) for name in ("own", "half", "quarter", "other")]
        own = files[0]
        b, h, q, o = (file["history/dissipated_energy"][:] for file in files)
        pairs = q.reshape(-1, 2).sum(1)  # in the time of a step of the companion with other steps
        part = abs(pairs - o) / pairs
        cells = by_cells("dissipated_energy", b, h, q)
        expected = (cells + np.repeat(part, 2) * b)[1::2]
        found = own["history/dissipated_energy_error"][1::2]
        assert np.allclose(found[2:], expected[2:], rtol=1e-6, atol=0)  # the first row's energy is next to nothing


def test_a_run_without_contact_has_no_errors(petsam, tmp_path):
    petsam(dict(SPHERE, load_n=0), "-errors", "companion", "-output", "own.h5")
    assert not package.open("own.h5").errors


def test_a_single_step_of_both_loads_has_no_error_by_the_steps(petsam, tmp_path):
    """N first, then T: with more steps of both the path is the same, and all follows."""
    done = petsam(dict(SPHERE, load_tx=60.0, grid_n=128), "-errors", "companion", "-output", "own.h5")
    assert "error by the" not in done.stderr
    assert all(row["by_steps"] < 1e-3 for row in table("own.h5").values())


@pytest.mark.parametrize("every", [5, pytest.param(6, marks=pytest.mark.slow)])
def test_errors_are_the_same_on_any_ranks_and_after_a_restart(petsam, tmp_path, loop, every):
    """The restart is between two moments that the companion with other steps shares with the run, or at one."""
    on = dict(errors="companion")
    petsam(loop, on, "-output", "own.h5")
    for ranks in (2, 3):
        petsam(loop, on, "-output", f"{ranks}.h5", ranks=ranks)
        np.testing.assert_equal(table(f"{ranks}.h5"), table("own.h5"))
    solved = {}
    for name, more in dict(without={}, state=on).items():
        head = {**loop, **history(tmp_path / "loop.csv", *LOOP[:3]), **more}
        petsam(head, "-checkpoint", f"{name}.h5", "-checkpoint_every", every, "-output", f"head_{name}.h5")
        history(tmp_path / "loop.csv", *LOOP)
        done = petsam(loop, on, "-restart", f"{name}.h5", "-output", f"rest_{name}.h5", "-log_view")
        solved[name] = int(re.search(r"^SamApplyT\s+(\d+)", done.stdout, re.M)[1])
        with h5py.File("own.h5") as own, h5py.File(f"rest_{name}.h5") as rest:
            count = rest["history/time"].size
            assert 0 < count < own["history/time"].size
            for column in own["history"]:
                if column.endswith("_error"):
                    found = rest["history"][column][:]
                    assert np.array_equal(own["history"][column][-count:], found, equal_nan=True), (name, column)
    np.testing.assert_equal(table("rest_state.h5"), table("rest_without.h5"))
    assert solved["state"] < 0.8 * solved["without"]  # the companions do not solve the earlier steps once more


def test_a_run_that_stops_has_the_errors_as_far_as_it_has_come(petsam, tmp_path, loop):
    """Those of a run to its end whose history ends there."""
    case = dict(loop, steps=1, errors="companion")
    done = petsam(case, "-checkpoint", "state.h5", "-max_walltime", "1e-3", "-output", "stopped.h5", check=75)
    assert "errors of the last numbers" in done.stdout
    petsam(case, history(tmp_path / "head.csv", *LOOP[:2]), "-output", "head.h5")
    np.testing.assert_equal(table("stopped.h5"), table("head.h5"))


@few("plane, name", [(plane, name) for plane in (False, True) for name in capabilities.cases(plane)], 9)
def test_every_capability_has_companions(petsam, tmp_path, plane, name):
    """Also friction fields of a file, steady rolling, sliding surfaces, divided steps: all have errors."""
    case = capabilities.write(plane, *capabilities.cases(plane)[name], tmp_path)
    case = dict(case, output_fields="pressure", grid_n=24 if plane else (16, 8))
    if not plane:
        case["grid_size"] = (2.4e-3, 1.2e-3)
    done = petsam(case, dict(errors="companion"), "-output", "one.h5")
    found = table("one.h5")
    assert "errors of the last numbers, by runs on" in done.stdout
    assert np.isfinite(found["contact_area"]["by_cells"]) or "are unknown" in done.stderr


def test_a_life_is_lived_again(petsam, tmp_path):
    """Numbers of the last cycle, then those of its last step that the cycle does not have."""
    (tmp_path / "cycle.csv").write_text("time,load_tx\n0,0\n1,60\n2,-60\n3,0\n")
    case = dict(SPHERE, friction=0.1, grid_n=40, history="cycle.csv", steps=4, wear_coefficient1=1e-14, wear_cycles=1e5,
                wear_output=2e4, wear_jump=1e5)  # fmt: skip
    petsam(case, "-errors", "companion", "-output", "own.h5")
    found = table("own.h5")
    changes = dict(half=dict(grid_n=20), quarter=dict(grid_n=10), other=dict(grid_n=20, steps=2))
    for run, change in changes.items():
        petsam(case, change, "-output", f"{run}.h5")
    assert {"volume1", "depth_max1", "dissipated_energy", "pressure_max", "stick_area", "disp_z"} <= set(found)
    assert "volume2" not in found
    for name, row in found.items():
        for run in changes:
            cycle = last(f"{run}.h5", "wear")
            expected = cycle[name] if name in cycle else last(f"{run}.h5")[name]
            assert np.isclose(row[run], expected, rtol=1e-9), (name, run)


def means(field):
    """Means over 2 x 2 cells."""
    return field.reshape(field.shape[0] // 2, 2, -1, 2).mean((1, 3))


@pytest.mark.parametrize("given", ["gap", "friction", "surface"])
def test_fields_of_files_are_averaged(petsam, tmp_path, given):
    rng = np.random.default_rng(5)
    heights = 1e-7 * rng.normal(size=(64, 64)).cumsum(0).cumsum(1) / 8
    friction = 0.1 + 0.2 * rng.random((64, 64))
    fine = friction if given == "friction" else heights
    for name, field in (("fine", fine), ("half", means(fine)), ("quarter", means(means(fine)))):
        with h5py.File(tmp_path / f"{name}.h5", "w") as f:
            f["friction" if given == "friction" else "height"] = field
    case = {**SPHERE, "grid_n": 64, "load_n": 300.0}
    if given == "gap":
        case.update(gap_type="file", gap_radius1=None, gap_radius2=None, elasticity="periodic")
    elif given == "friction":
        case.update(friction=None, load_tx=20.0)
    else:
        case.update(slide=True, disp_x=1e-7)
    option = dict(gap="-gap_file", friction="-friction_file", surface="-body1_surface_file")[given]
    petsam(case, option, "fine.h5", "-errors", "companion", "-output", "own.h5")
    for name, cells in (("half", 32), ("quarter", 16)):
        petsam(case, option, f"{name}.h5", "-grid_n", str(cells), "-output", f"{name}-run.h5")
        expected = last(f"{name}-run.h5")
        for number, row in table("own.h5").items():
            assert np.isclose(row[name], expected[number], rtol=1e-6), (number, name)


def test_proposals_make_the_warnings_disappear(petsam, tmp_path):
    """A coarse grid and long steps: one line for each cause; with what they propose there is none."""
    rows = ((1, 1000, 90), (2, 1000, -90), (3, 1000, 90))
    case = {**SPHERE, "load_n": None, "steps": 1, "friction": 0.1, "grid_n": 20}
    case.update(history(tmp_path / "loop.csv", LOOP[0], *rows))
    for _ in range(3):
        done = petsam(case, "-errors", "companion")
        lines = re.findall(r"error by the (\w+):.*: use -(\w+) (\d+)", done.stderr)
        assert len({cause for cause, _, _ in lines}) == len(lines)
        if not lines:
            break
        case.update({option: int(number) for _, option, number in lines})
    assert not lines and case["grid_n"] > 20 and case["grid_n"] < 400, case


def test_a_companion_that_fails_leaves_errors_unknown(petsam, tmp_path):
    """On half the cells the contact reaches the edge of the grid."""
    case = dict(SPHERE, load_tx=50.0, grid_n=16, grid_size=1.9e-3)
    petsam(case)
    done = petsam(case, "-errors", "companion", "-output", "own.h5")
    row = table("own.h5")["contact_area"]
    assert "errors by the cells are unknown: on half the cells" in done.stderr and "edge of the grid" in done.stderr
    assert np.isnan(row["error"]) and np.isfinite(row["value"])


def test_grid_check_is_another_name(petsam, tmp_path, loop):
    one = petsam(loop, "-grid_check").stdout
    assert "errors of the last numbers, by runs on 33 x 33 cells, on 17 x 17 cells" in one
    done = petsam(loop, "-grid_check", "-errors", "closed", check=2)
    assert "-grid_check does not work with -errors" in done.complaint[0]
    assert (
        "-errors companion needs at least 4 cells"
        in petsam(loop, "-grid_n", "3", "-errors", "companion", check=2).complaint[0]
    )


def test_the_path_to_the_first_row_is_the_same_with_other_steps(petsam, tmp_path):
    """Loads that grow in proportion do so in one step, too; a step with N first has more steps with N first."""
    case = {**SPHERE, "load_n": None, "grid_n": 32, "friction": 0.1, "errors": "companion"}
    half = dict(grid_n=16, errors=None)
    petsam({**case, **history(tmp_path / "a.csv", LOOP[0], (1, 1000, 60))}, "-steps", "2", "-output", "two.h5")
    rows = ((1, 1000, 60), (2, 2000, 120))  # the second row goes on in proportion, so the first does not have N first
    petsam({**case, **half, **history(tmp_path / "b.csv", LOOP[0], *rows)}, "-output", "one.h5")
    petsam({**case, **history(tmp_path / "c.csv", LOOP[0], (1, 1000, 60))}, "-output", "apart.h5")
    rows = ((0.5, 1000, 0), (1, 1000, 60))
    petsam({**case, **half, **history(tmp_path / "d.csv", LOOP[0], *rows)}, "-steps", "2", "-output", "four.h5")
    with h5py.File("one.h5") as one, h5py.File("four.h5") as four:
        for name in ("shear_max", "disp_x", "stick_area"):
            assert np.isclose(table("two.h5")[name]["other"], one["history"][name][0], rtol=1e-9), name
        for name in ("shear_max", "slip_max", "dissipated_energy"):
            expected = four["history"][name][:]
            expected = expected.sum() if name == "dissipated_energy" else expected[-1]
            assert np.isclose(table("apart.h5")[name]["other"], expected, rtol=1e-9), name
    assert not np.isclose(table("apart.h5")["stick_area"]["half"], table("two.h5")["stick_area"]["half"], rtol=1e-3)


def test_what_is_narrower_than_a_cell_is_told_in_closed_form(petsam, tmp_path):
    """A slip zone that none of the grids has: only closed forms know that its numbers are wrong."""
    case = {**SPHERE, "load_n": None, "steps": 2, "friction": 0.5, "grid_n": 32}
    case.update(history(tmp_path / "loop.csv", LOOP[0], (1, 1000, 0), (2, 1000, 2)))
    done = petsam(case, "-errors", "companion", "-output", "own.h5")
    found = table("own.h5")
    assert "slip zones are" in done.stderr or "no cell slips" in done.stderr
    assert found["dissipated_energy"]["value"] == found["dissipated_energy"]["half"] == 0
    assert found["dissipated_energy"]["by_cells"] == 1 and found["slip_max"]["error"] >= 1
    assert found["shear_max"]["by_cells"] > 0.3


def test_an_energy_in_closed_form_has_the_error_of_its_value(petsam, tmp_path):
    """On half the cells it is wrong by much more."""
    case = {**SPHERE, "load_n": None, "steps": 1, "friction": 0.1, "grid_n": 64}
    case.update(history(tmp_path / "loop.csv", LOOP[0], (1, 1000, 0), (2, 1000, 20)))
    petsam(case, "-errors", "companion", "-output", "own.h5")
    row = table("own.h5")["dissipated_energy"]
    with h5py.File("own.h5") as file:
        closed = file["history/dissipated_energy_closed"][:].sum()
    assert np.isclose(row["by_cells"], abs(closed - row["value"]) / closed, rtol=1e-6)
    assert row["by_cells"] < 0.3 * abs(row["value"] - row["half"]) / row["value"]


SHARE = re.compile(r"add(?:s)? about (\d+) % of the time")


def test_time_that_companions_add_is_told_before(petsam, loop):
    """By cells and steps; without them at the end, unless errors are not wanted, or the run has failed."""
    for case, expected in ((loop, 1 / 4 + 1 / 16 + 1 / 32), (dict(loop, steps=1), 1 / 4 + 1 / 16 + 1 / 8)):
        head = petsam(case, "-errors", "companion", "-dry_run").stdout
        tail = petsam(case).stdout
        for printed in (head, tail):
            assert [int(found) for found in SHARE.findall(printed)] == [round(100 * expected)]
        assert "errors      by runs on" in head and "errors      of all numbers by -errors companion" in tail
    assert not SHARE.search(petsam(loop, "-errors", "none").stdout)
    assert not SHARE.search(petsam(dict(loop, grid_size=1e-3), check=12).stdout)
    assert not SHARE.search(petsam(dict(loop, grid_n="3,30", allow_edge_contact=True)).stdout)


def test_billions_of_steps_are_judged_at_the_ends_of_rows(petsam, loop):
    """Twice their number is beyond an integer."""
    many = dict(loop, steps=700000000)
    assert re.search(r"steps +2100000000,", petsam(many, "-errors", "companion", "-dry_run").stdout)


@pytest.mark.parametrize("steps, torque", [(4, 0.02), (8, -0.01)])
def test_a_rotation_that_begins_with_the_contact_has_no_limit(petsam, tmp_path, steps, torque):
    """It grows by the same for each halving of the steps; after a row of N alone, or by a flat punch, it does not."""
    rows = ((1, 1000, torque, 50),)
    case = {
        **SPHERE,
        "load_n": None,
        "grid_n": 32,
        "grid_size": 2.4e-3,
        "friction": 0.5,
        "steps": steps,
        "errors": "companion",
    }
    columns = "time,load_n,load_mz,load_tx"
    done = petsam(case, history(tmp_path / "a.csv", columns, *rows), "-output", "together.h5")
    found = table("together.h5")["rot_z"]
    assert found["by_steps"] == 1 and found["cause"] == b"steps" and found["by_cells"] < 0.2
    assert "rot_z unknown" in done.stderr and "give a first row of N alone" in done.stderr
    assert np.isnan(package.open("together.h5").history["rot_z_error"][-1])
    petsam(case, history(tmp_path / "b.csv", columns, (0, 1000, 0, 0), *rows), "-output", "apart.h5")
    assert table("apart.h5")["rot_z"]["by_steps"] < 0.05
    punch = dict(gap_radius1=None, gap_radius2=None, gap_type="punch", gap_flat_radius=8e-4, gap_edge_radius=1e-2)
    petsam({**case, **punch}, history(tmp_path / "c.csv", columns, *rows), "-output", "flat.h5")
    assert table("flat.h5")["rot_z"]["by_steps"] < 0.05


def test_a_shear_at_a_sharp_edge_has_no_limit(petsam):
    punch = dict(gap_radius1=None, gap_radius2=None, gap_type="punch", gap_flat_radius=5e-4, gap_edge_radius=1e-6)
    case = {**SPHERE, **punch, "load_n": 1.0, "load_tx": 0.2, "friction": 0.5, "grid_size": 2e-3, "grid_n": 64}
    done = petsam(case, "-errors", "companion", "-output", "own.h5")
    found = table("own.h5")
    assert found["shear_max"]["by_cells"] == 1 and "shear_max unknown" in done.stderr
    assert found["disp_z"]["error"] < 0.02


PLANE = dict(
    elasticity="plane", gap_type="ellipsoid", gap_radius1=None, gap_radius2=None, gap_radius_x=0.05, gap_radius_y="inf"
)
FEW = {
    "sphere": dict(grid_size=2.4e-3, grid_n=48),
    "one cell": dict(grid_size=2.4e-3, grid_n=49),
    "row": dict(PLANE, grid_size=2.4e-3, grid_n=48),
}


@pytest.mark.parametrize("name", FEW)
def test_of_few_cells_across_nothing_is_known(petsam, tmp_path, name):
    """In the first step and the last one, but not between them."""
    most = 1e5 if name == "row" else 1000
    case = {**SPHERE, "load_n": None, "steps": 1, **FEW[name]}
    case.update(
        history(
            tmp_path / "a.csv", LOOP[0], (1, most * 1e-3, 0), (2, most, 0), (3, most, most / 20), (4, most * 1e-3, 0)
        )
    )
    done = petsam(case, "-errors", "companion", "-output", "own.h5")
    found = table("own.h5")
    for number in ("pressure_max", "contact_area"):
        assert found[number]["by_cells"] >= 1, number
        errors = package.open("own.h5").history[f"{number}_error"]
        assert np.array_equal(np.isnan(errors), [True, False, False, True]), number
    assert re.search(r"across in the last step.*: use -grid_n \d+", done.stderr)
    petsam(
        case,
        history(tmp_path / "a.csv", LOOP[0], (1, most * 1e-3, 0), (2, most, 0)),
        "-errors",
        "companion",
        "-output",
        "end.h5",
    )
    assert all(row["by_cells"] < 1 for row in table("end.h5").values())
