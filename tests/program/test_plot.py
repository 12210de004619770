"""petsam-plot: each picture from true results, its steps, files and messages."""

import os
import random
import sys
from types import SimpleNamespace

import h5py
import numpy as np
import pytest

import petsam as package
from petsam import cycles, sliding
from petsam.core.errors import Error
from petsam.plot import command, crossings, fields, loops, series
from petsam.plot.units import scale
from petsam.results import Results
from support import ROOT, SPHERE, ball, finished, history, slide_limit

PROGRAM = ROOT / "scripts" / "petsam-plot"
CASE = ball(n=48)
AMPLITUDE = 0.7 * slide_limit(CASE)[0]


@pytest.fixture(scope="module")
def strokes(solve, tmp_path_factory):
    """To the amplitude, back and forth, in four increments each; fields of every second step."""
    table = tmp_path_factory.mktemp("history") / "strokes.csv"
    table.write_text("time,load_tx\n0,0\n1,{0!r}\n2,-{0!r}\n3,{0!r}\n".format(float(AMPLITUDE)))
    return solve(CASE, dict(history=table, steps=4, output_every=2)).path


@pytest.fixture(scope="module")
def single(solve):
    """One load step, on another grid than the strokes'."""
    return solve(dict(CASE, grid_n=(40, 56), load_tx=0.5 * AMPLITUDE)).path


@pytest.fixture(scope="module")
def refused(solve, tmp_path_factory):
    """Back and forth, then a load that friction cannot balance: the row of the last step has no solution."""
    table = tmp_path_factory.mktemp("history") / "refused.csv"
    loads = [0.0, *(float(sign * AMPLITUDE) for sign in (1, -1, 1)), float(2 * slide_limit(CASE)[0])]
    table.write_text("time,load_tx\n" + "".join(f"{k},{load!r}\n" for k, load in enumerate(loads, 1)))
    return solve(CASE, dict(history=table), check=11).path


@pytest.fixture(scope="module")
def unsolved(solve):
    """The only step is refused."""
    return solve(dict(CASE, load_tx=2 * slide_limit(CASE)[0]), check=11).path


@pytest.fixture
def plot(draw):
    """plot(*words, check=0): petsam-plot in tmp_path; its messages."""

    def run(*words, check=0):
        code, errors = draw(*words)
        assert code == check, errors
        return errors

    return run


@pytest.fixture
def program(tmp_path):
    """petsam-plot in tmp_path, as a user starts it: the completed process."""

    def run(*words, check=0):
        env = dict(os.environ, PYTHON=sys.executable)
        return finished([sys.executable, str(PROGRAM), *map(str, words)], check, cwd=tmp_path, env=env)

    return run


def pixels(path):
    """Width and height of a PNG whose every quarter has been drawn on."""
    import matplotlib.image

    image = matplotlib.image.imread(path)[:, :, :3]
    height, width = image.shape[:2]
    for rows in (slice(0, height // 2), slice(height // 2, height)):
        for columns in (slice(0, width // 2), slice(width // 2, width)):
            assert np.ptp(image[rows, columns]) > 0.5
    return width, height


def lines(axes):
    """(x, y) of the curves with more than a point."""
    return [line.get_data() for line in axes.lines if len(np.atleast_1d(line.get_xdata())) > 1]


# ---------------------------------------------------------------- the program


def test_a_history_gives_all_four_pictures(program, strokes, tmp_path):
    program(strokes)
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == [f"results_{kind}.png" for kind in ("history", "loop", "maps", "profiles")]
    for name in names:
        assert min(pixels(tmp_path / name)) > 300


def test_a_single_step_gives_no_loop(plot, single, tmp_path):
    plot(single, "-o", "one")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["one_maps.png", "one_profiles.png"]


def test_a_history_with_a_refused_step_gives_all_four_pictures(plot, refused, tmp_path):
    plot(refused)
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == [f"results_{kind}.png" for kind in ("history", "loop", "maps", "profiles")]


def test_one_solved_step_before_a_refused_one_gives_no_loop(plot, solve, tmp_path):
    table = tmp_path / "two.csv"
    table.write_text(f"time,load_tx\n1,0\n2,{float(2 * slide_limit(CASE)[0])!r}\n")
    plot(solve(CASE, dict(history=table), check=11).path, "-o", "one")
    table.unlink()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["one_maps.png", "one_profiles.png"]


@pytest.mark.parametrize("kind", ["maps", "profiles", "loop", "history"])
def test_pdf_by_the_end_of_the_name(plot, strokes, tmp_path, kind):
    plot("--" + kind, strokes, "-o", "picture.pdf")
    assert (tmp_path / "picture.pdf").read_bytes().startswith(b"%PDF")
    assert len(list(tmp_path.iterdir())) == 1


def test_several_files_of_different_grids_are_compared(plot, strokes, single, tmp_path):
    plot("--maps", strokes, single, "--labels", "strokes,single", "-o", "two.png")
    plot("--maps", strokes, "-o", "one.png")
    assert pixels(tmp_path / "two.png")[1] > 1.5 * pixels(tmp_path / "one.png")[1]


@pytest.mark.parametrize("kind", ["loop", "history"])
def test_a_file_without_any_solution_is_named(plot, refused, unsolved, kind):
    for files in ([unsolved], [refused, unsolved]):
        errors = plot("--" + kind, *files, check=3)
        assert errors == [f"petsam-plot: error: {unsolved}: no step has a solution"]


def replaced(file, name, values):
    """Another dataset of this name, with the units of the first."""
    units = file[name].attrs["units"]
    del file[name]
    file[name] = values
    file[name].attrs["units"] = units


@pytest.mark.parametrize(
    "name, values",
    [
        ("x", []),
        ("x", [1.0]),
        ("x", np.arange(48.0)[::-1]),
        ("x", np.full(48, np.nan)),
        ("x", np.ones((2, 2))),
        ("x", 1.0),
        ("y", np.array([b"a", b"b"])),
        ("time", np.zeros(0)),
        ("time", np.zeros(99)),
        ("history/time", np.zeros(0)),
        ("history/load_tx", np.ones((16, 2))),
        ("history/load_tx", np.full(16, b"a")),
        ("history/load_tx", np.full(16, 1j)),
        ("pressure", np.ones((2, 3, 4))),
        ("pressure", np.full((8, 48, 48), b"a")),
    ],
)
def test_results_of_another_form_are_named(draw, strokes, tmp_path, name, values):
    path = tmp_path / "odd.h5"
    path.write_bytes(strokes.read_bytes())
    with h5py.File(path, "r+") as file:
        replaced(file, name, values)
    code, (error,) = draw(path, "--maps")
    assert code == 3 and error.startswith(f"petsam-plot: error: {path}: ") and "TRACEBACK" not in error


@pytest.mark.parametrize(
    "change",
    [
        lambda file: file["history/load_tx"].attrs.__delitem__("units"),
        lambda file: file["history/load_tx"].attrs.__setitem__("units", 5),
        lambda file: file.attrs.__setitem__("friction", "much"),
        lambda file: file.attrs.__delitem__("friction"),
        lambda file: file.__delitem__("time"),
        lambda file: file.__delitem__("history"),
        lambda file: file["history"].__setitem__("loop", file["history"]),
        lambda file: (file.__delitem__("x"), file.__setitem__("x", h5py.ExternalLink("pipe", "/x"))),
        lambda file: (file.__delitem__("x"), file.create_dataset("x", (10**13,), "f8", chunks=(1000,))),
    ],
)
def test_results_that_lack_something_are_named(draw, strokes, tmp_path, change):
    os.mkfifo(tmp_path / "pipe")
    path = tmp_path / "odd.h5"
    path.write_bytes(strokes.read_bytes())
    with h5py.File(path, "r+") as file:
        change(file)
    code, (error,) = draw(path)
    assert code == 3 and error.startswith(f"petsam-plot: error: {path}: ") and "TRACEBACK" not in error


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e200, 4e-324, 0.0])
def test_any_numbers_in_the_fields_and_the_history_are_drawn(draw, strokes, tmp_path, value):
    path = tmp_path / "odd.h5"
    path.write_bytes(strokes.read_bytes())
    with h5py.File(path, "r+") as file:
        for name in ("pressure", "shear_x", "history/disp_y", "history/load_ty"):
            file[name][...] = value
        # neither a text that HDF5 pads nor one that matplotlib would take as a formula is in the way
        file["history/load_tx"].attrs["units"] = np.bytes_(b"N")
        file["history/load_ty"].attrs["units"] = "$\\frac{$_^" * 1000
    code, errors = draw(path, "--maps", "--profiles", "--history", "--names", "disp_y,load_ty", "--labels", "_$x_{^")
    if np.isnan(value):  # nothing to draw
        assert code == 2 and len(errors) == 1 and "--names disp_y: is NaN in all steps" in errors[0]
    else:
        assert (code, errors) == (0, [])


def test_datasets_of_different_lengths_are_drawn(draw, strokes, tmp_path):
    path = tmp_path / "odd.h5"
    path.write_bytes(strokes.read_bytes())
    with h5py.File(path, "r+") as file:
        replaced(file, "history/load_tx", file["history/load_tx"][:9])
        replaced(file, "history/status", np.zeros(99, dtype=int))
    assert draw(path, "--history", "--names", "status,load_tx") == (0, [])


@pytest.mark.parametrize(
    "exit_code, words",
    [
        (2, ["--step", "9" * 30]), (3, ["--step", "0"]), (3, ["--step", ",".join(["1"] * 100)]),
        (2, ["--time", "nan"]), (2, ["--time", "1e400"]), (2, ["--profiles", "--at", "nan,0"]),
        (2, ["--profiles", "--at", "0,inf"]), (2, ["--names", "a,,b"]), (3, ["--names", ",".join(["load_n"] * 100)]),
        (3, ["--maps", "-o", "folder.png"]), (3, ["--maps", "-o", "pipe.png"]),
        (3, ["--maps", "-o", "a" * 300 + ".png"]), (3, ["--maps", "-o", "self.png"]),
        (3, ["--maps", "--dpi", "1200", "--step", ",".join(["1"] * 30)]),
    ],
)  # fmt: skip
def test_what_cannot_be_drawn_or_written_is_one_line(draw, single, tmp_path, exit_code, words):
    (tmp_path / "folder.png").mkdir()
    os.mkfifo(tmp_path / "pipe.png")
    (tmp_path / "self.png").write_bytes(single.read_bytes())
    code, (error,) = draw(tmp_path / "self.png", *words)
    assert code == exit_code and error.startswith("petsam-plot: error: ") and "TRACEBACK" not in error
    assert (tmp_path / "self.png").read_bytes() == single.read_bytes()


def test_what_is_no_regular_file_is_named_at_once(draw, tmp_path):
    os.mkfifo(tmp_path / "pipe.h5")
    (tmp_path / "empty.h5").touch()
    for name in ("pipe.h5", "empty.h5", ".", "/dev/zero", ""):
        code, (error,) = draw(name)
        assert code == 3 and error.startswith(f"petsam-plot: error: {name}: ")


def test_any_backend_that_the_environment_names_is_ignored(program, single, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "nothere")
    assert not program("--maps", single).stderr


@pytest.mark.parametrize("script", ["printf -", "kill -SEGV $$", "exec sleep 60"])
def test_a_file_that_ends_hdf5_is_damaged(draw, strokes, tmp_path, monkeypatch, script):
    """The program that examines it writes a character when it begins, and one when it ends."""
    program = tmp_path / "examine"
    program.write_text(f"#!/bin/sh\nprintf -\n{script}\n" if script != "printf -" else "#!/bin/sh\nprintf --\n")
    program.chmod(0o755)
    monkeypatch.setattr("petsam.core.examine._seen", {})
    monkeypatch.setattr("petsam.core.examine._beside", lambda petsam: str(program))
    monkeypatch.setattr("petsam.core.examine.SECONDS", 1.0)
    told = (0, []) if script == "printf -" else (3, [f"petsam-plot: error: {strokes}: is damaged"])
    assert draw(strokes, "--loop") == told


def test_what_nobody_foresaw_is_a_line_too(draw, strokes, monkeypatch):
    def fails(*_):
        raise ZeroDivisionError("odd")

    monkeypatch.setattr(command, "chosen", fails)
    code, (error,) = draw(strokes)
    assert code == 1 and "unexpected ZeroDivisionError: odd" in error and "PETSAM_TRACEBACK" in error


def test_a_damaged_file_is_drawn_or_named(draw, solve, tmp_path, monkeypatch):
    """As petsam wrote it, but for some bytes: whatever HDF5 does with them, which takes for ever with some."""
    data, chance = solve(dict(CASE, grid_n=8)).path.read_bytes(), random.Random(1)
    path = tmp_path / "damaged.h5"
    for _ in range(25):
        spoiled = bytearray(data)
        for _ in range(chance.choice((1, 2, 8, 50))):
            spoiled[chance.randrange(min(len(data), 30000))] = chance.randrange(256)
        path.write_bytes(spoiled[: chance.choice((len(data), chance.randrange(len(data))))])
        code, errors = draw(path, "--loop", "--load", "tx", "--dpi", "20")
        assert (code, errors) == (0, []) or code == 3 and len(errors) == 1, (code, errors)
        assert code == 0 or errors[0].startswith(f"petsam-plot: error: {path}: "), errors


# ---------------------------------------------------------------- what is drawn


def test_maps_show_the_fields_of_the_step_in_the_units_of_the_labels(strokes):
    results = Results(str(strokes))
    figure = fields.maps([(results, results.of_step(8))], whole=True)
    with h5py.File(strokes, "r") as file:
        k = list(file["time"]).index(file["history/time"][7])
        q = np.hypot(file["shear_x"][k], file["shear_y"][k])
    image = figure.axes[1].images[0]
    bar = image.colorbar.ax
    assert bar.get_ylabel() == "$|q|$, MPa"
    assert np.array_equal(image.get_array(), 1e-6 * q)
    # the contact is about 0.3 mm wide
    assert figure.axes[1].get_xlabel() in ("$x$, mm", "$x$, µm")
    width = CASE["grid_size"] * (1e3 if "mm" in figure.axes[1].get_xlabel() else 1e6)
    assert np.isclose(image.get_extent()[1] - image.get_extent()[0], width, rtol=1e-9)


def test_maps_are_of_the_contact_unless_the_whole_grid_is_asked_for(strokes):
    results = Results(str(strokes))
    rows, columns = results.contact_window(0, margin=0.0)
    state = results.field("state", 0)
    inside = np.zeros_like(state)
    inside[rows, columns] = 1
    assert np.all(inside[state > 0]) and inside.sum() < 0.6 * inside.size


def test_windows_and_strides_are_those_of_the_field(strokes, monkeypatch):
    monkeypatch.setattr("petsam.results.fields.BLOCK", 8)
    results = Results(str(strokes))
    with h5py.File(strokes, "r") as file:
        expected = file["pressure"][1][5:41:2, 3:30:2]
    assert np.array_equal(results.field("pressure", 1, slice(5, 41), slice(3, 30), 2), expected)


def test_profiles_go_through_the_point(single):
    results = Results(str(single))
    at = (2.2 * (results.x[1] - results.x[0]), -3.4 * (results.y[1] - results.y[0]))
    panels = crossings.profiles([(results, 0)], at, whole=True).axes
    with h5py.File(single, "r") as file:
        p, row = 1e-6 * file["pressure"][0], np.argmin(np.abs(results.y - at[1]))
        column = np.argmin(np.abs(results.x - at[0]))
    assert panels[0].get_ylabel() == "$p$, MPa"
    assert np.allclose(lines(panels[0])[0][1], p[row], rtol=1e-14)
    assert np.allclose(lines(panels[1])[0][1], p[:, column], rtol=1e-14)


def test_shear_profile_is_drawn_between_its_bounds(single):
    results = Results(str(single))
    curves = lines(crossings.profiles([(results, 0)], whole=True).axes[2])
    upper, lower, qx = (y for _, y in curves[:3])
    assert np.all(qx <= upper * (1 + 1e-9)) and np.all(qx >= lower * (1 + 1e-9)) and qx.max() > 0.3 * upper.max()


def test_loop_is_force_over_displacement_of_every_step(strokes):
    results = Results(str(strokes))
    axes = loops.loop([results]).axes[0]
    (x, y), history = lines(axes)[0], results.history
    assert axes.get_ylabel() == "$T_x$, N" and axes.get_xlabel().startswith("$d_x$, ")
    factor = {"µm": 1e6, "nm": 1e9}[axes.get_xlabel().split()[-1]]
    assert np.allclose(x, factor * history["disp_x"]) and np.allclose(y, history["load_tx"])
    text = axes.get_legend().get_texts()[0].get_text()
    energy = cycles.find(results).energies[-1]  # of the last cycle, not of all steps
    assert energy < 0.9 * history["dissipated_energy"].sum() and " dissipated in the last cycle" in text
    assert any(text.startswith(f"{factor * energy:.4g} ") for factor in (1e9, 1e6))
    results.label = "own"
    assert loops.loop([results]).axes[0].get_legend().get_texts()[0].get_text() == f"own: {text}"


@pytest.mark.parametrize(
    "drawn, text",
    [
        (2.0, "2 mJ in the last cycle"),
        (1.99, "2 mJ dissipated in the last cycle"),
        (1.9, "2 mJ dissipated in the last cycle\n(lines between steps: area 1.9 mJ)"),
        (2.1, "2 mJ dissipated in the last cycle\n(lines between steps: area 2.1 mJ)"),
    ],
)
def test_a_legend_tells_the_energy_from_the_area_between_the_lines(drawn, text):
    assert loops._energy_text(SimpleNamespace(work_unit="J"), (2e-3, 1e-3 * drawn)) == text


def test_a_loop_of_few_steps_has_the_area_as_it_is_drawn(strokes):
    results = Results(str(strokes))
    figure = loops.loop([results])
    text, rows = figure.axes[0].get_legend().get_texts()[0].get_text(), list(cycles.find(results))[-1].rows
    x, y = (results.history[name][rows] for name in ("disp_x", "load_tx"))
    area = 0.5 * abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    apart = abs(area / cycles.find(results).energies[-1] - 1.0) > loops.SEEN
    assert ("area" in text) == apart and (not apart or any(f"area {f * area:.4g} " in text for f in (1e6, 1e9)))


def test_a_load_that_does_not_vary_has_no_loop(strokes):
    results = Results(str(strokes))
    found = cycles.find(results)
    for draw in (lambda: loops.loop([results], "ty"), lambda: loops.cycle_loops([found], "ty", [-1])):
        with pytest.raises(Error, match="--load ty: load_ty or disp_y does not vary"):
            draw()


def test_energy_of_a_loop_is_that_of_its_load():
    """A circle in T_x over d_x, and half of it in T_y over d_y: the friction's energy is that of both."""
    t = 2.0 * np.pi * np.arange(200) / 200
    series = dict.fromkeys([name for pair in cycles.PAIRS.values() for name in pair], np.zeros(t.size))
    series.update(load_tx=np.sin(t), disp_x=np.cos(t), load_ty=0.5 * np.sin(t), disp_y=np.cos(t))
    results = SimpleNamespace(history=series)
    both = {pair: loops.loop_energy(results, pair, series.get, 1.5 * np.pi) for pair in cycles.PAIRS.values()}
    assert np.isclose(abs(both["load_tx", "disp_x"]), np.pi, rtol=1e-3)
    assert np.isclose(abs(both["load_ty", "disp_y"]), 0.5 * np.pi, rtol=1e-3)
    assert both["load_tx", "disp_x"] * both["load_ty", "disp_y"] > 0.0
    series["disp_y"] = np.zeros(t.size)
    assert loops.loop_energy(results, ("load_tx", "disp_x"), series.get, 3.2) == 3.2  # of the steps, not of the sides
    series["bulk2_stress_xx"] = np.sin(t)
    assert np.isclose(abs(loops.loop_energy(results, ("load_tx", "disp_x"), series.get, 3.2)), np.pi, rtol=1e-3)


def test_energy_of_a_loop_is_positive_where_friction_dissipates():
    x = np.array([1.0, -1.0, -1.0, 1.0])  # back at -1, forth at 1
    y = np.array([-1.0, -1.0, 1.0, 1.0])
    assert sliding.area(x, y) == 4.0


def test_loop_is_that_of_the_load_which_works(solve, tmp_path):
    table = tmp_path / "turns.csv"
    table.write_text("time,load_mz\n0,0\n1,{0!r}\n2,-{0!r}\n".format(float(0.5 * slide_limit(CASE)[1])))
    results = Results(str(solve(dict(CASE, grid_n=32), dict(history=table)).path))
    assert loops.busiest(results) == "mz"


def test_history_leaves_out_what_is_zero_but_for_rounding(strokes):
    labels = [axes.get_ylabel().split(",")[0] for axes in series.history([Results(str(strokes))]).axes]
    assert "$T_x$" in labels and "$d_x$" in labels and "stick area" in labels
    assert not {"$M_x$", "$M_z$", "$r_z$", "$T_y$"} & set(labels)


def test_history_sums_the_energy(strokes):
    results = Results(str(strokes))
    axes = series.history([results], ["dissipated_energy"]).axes[0]
    assert np.isclose(
        lines(axes)[0][1][-1] * (1e-9 if "nJ" in axes.get_ylabel() else 1e-6),
        results.history["dissipated_energy"].sum(),
        rtol=1e-12,
    )


def test_loop_leaves_out_a_refused_step(refused):
    results = Results(str(refused))
    assert results.history["status"].tolist() == [0, 0, 0, 0, 11] and np.isnan(results.history["disp_x"][-1])
    assert loops.busiest(results) == "tx"
    axes = loops.loop([results]).axes[0]
    assert np.allclose(lines(axes)[0][1], results.history["load_tx"][:4])
    last = axes.lines[1].get_data()
    assert [one[0] for one in last] == [one[3] for one in lines(axes)[0]]
    (energy,) = cycles.find(results).energies
    text = axes.get_legend().get_texts()[0].get_text()
    assert any(f"{factor * energy:.4g} " in text for factor in (1e9, 1e6))


def test_history_of_a_refused_step_has_the_panels_and_sums_of_the_others(refused):
    results = Results(str(refused))
    labels = [axes.get_ylabel().split(",")[0] for axes in series.history([results]).axes if axes.get_ylabel()]
    expected = ["$T_x$", "$d_x$", "stick area", "dissipated energy"]
    assert labels == expected
    axes = series.history([results], ["dissipated_energy", "status"]).axes
    (time, energy), (every, status) = lines(axes[0])[0], lines(axes[1])[0]
    assert time.tolist() == [1, 2, 3, 4] and every.tolist() == [1, 2, 3, 4, 5] and status[-1] == 11
    assert np.isclose(
        energy[-1] * (1e-9 if "nJ" in axes[0].get_ylabel() else 1e-6),
        results.history["dissipated_energy"][:4].sum(),
        rtol=1e-12,
    )


def test_a_step_that_is_in_some_datasets_only_does_not_count(strokes, tmp_path):
    """As a killed run may leave it."""
    path = tmp_path / "killed.h5"
    path.write_bytes(strokes.read_bytes())
    with h5py.File(path, "r+") as file:
        cut = file["history/dissipated_energy"][:-1]
        units = file["history/dissipated_energy"].attrs["units"]
        del file["history/dissipated_energy"]
        file["history/dissipated_energy"] = cut
        file["history/dissipated_energy"].attrs["units"] = units
    results = Results(str(path))
    assert results.solved.tolist() == list(range(cut.size))
    assert np.isclose(results.series("dissipated_energy").sum(), cut.sum(), rtol=1e-14)
    loops.loop([results])
    series.history([results])


@pytest.mark.parametrize(
    "unit, value, factor, text",
    [
        ("Pa", 636e6, 1e-6, "MPa"),
        ("Pa", 2e9, 1e-9, "GPa"),
        ("m", 0.9e-3, 1e6, "µm"),
        ("m", 3.0, 1.0, "m"),
        ("m", 5e3, 1.0, "m"),
        ("m2", 2.3e-6, 1e6, "mm²"),
        ("N m", 0.05, 1e3, "mN·m"),
        ("rad", 2e-9, 1e9, "nrad"),
        ("J", 1e-12, 1e12, "pJ"),
        ("m2", 150000e-12, 1e6, "mm²"),
        ("m2", 5e-3, 1e6, "mm²"),
        ("m2", 0.3, 1.0, "m²"),
        ("m2", 4e-12, 1e12, "µm²"),
        ("J/m2", 2.5e3, 1e-3, "kJ/m²"),
        ("1/Pa", 1e-9, 1.0, "1/Pa"),
        ("N m/rad", 2e3, 1e-3, "kN·m/rad"),
        ("Pa J/m2", 3.9e10, 1e-9, "GPa·J/m²"),
        ("N", 999.0, 1.0, "N"),
        ("N", 1000.0, 1e-3, "kN"),
        ("Pam", 1e9, 1.0, "Pam"),
        ("N/m", 3e8, 1e-6, "MN/m"),
        ("1", 1e-9, 1.0, ""),
        ("s", 1e-3, 1.0, "s"),
        ("N", 0.0, 1.0, "N"),
    ],
)
def test_prefix_suits_the_largest_value(unit, value, factor, text):
    got = scale(unit, value)
    assert np.isclose(got[0], factor, rtol=1e-12) and got[1] == text


def test_errors_are_bars(petsam, tmp_path):
    """Of each number those of its steps, of the energy their sum; none without them."""
    loads = history(tmp_path / "h.csv", "time,load_n,load_tx", (1, 1000, 0), (2, 1000, 50), (3, 1000, -60))
    case = {**SPHERE, "load_n": None, "friction": 0.1, "grid_n": 32, "output": "e.h5"}
    petsam(case, loads, "-errors", "companion")
    with package.open(tmp_path / "e.h5") as file:
        figure = series.history([file], ["slip_max", "dissipated_energy"])
        found = []
        for axes in figure.axes[:2]:
            (bars,) = axes.collections
            found.append([np.ptp(one[:, 1]) / 2 for one in bars.get_segments()])
            assert np.allclose([one[:, 1].mean() for one in bars.get_segments()], axes.lines[-1].get_ydata())
        errors = file.history["slip_max_error"], np.cumsum(file.history["dissipated_energy_error"])
        for heights, expected in zip(found, errors):
            scale = heights[-1] / expected[-1]
            assert np.allclose(heights, scale * expected) and np.isclose((np.log10(scale) + 1) % 3, 1, atol=1e-9)
    petsam(case, loads, "-overwrite")
    with package.open(tmp_path / "e.h5") as file:
        assert not series.history([file], ["slip_max"]).axes[0].collections
