"""petsam-plot's options: none that no picture uses is taken silently; load steps that histories and loops show."""

import shutil

import h5py
import numpy as np
import pytest

import petsam
from petsam.core.line import Parser
from petsam.plot import arguments, loops, series, uses
from petsam.results.stresses import Stresses
from petsam.results.studies import Study
from support import ball, history, slide_limit

pytestmark = pytest.mark.usefixtures("closing")

CASE = ball(n=24)
AMPLITUDE = float(0.7 * slide_limit(CASE)[0])


@pytest.fixture(scope="module")
def path(solve, tmp_path_factory):
    """A preload and three strokes in four steps each; then a load that friction cannot balance."""
    turns = [0.0, AMPLITUDE, -AMPLITUDE, AMPLITUDE, 9.0 * AMPLITUDE]
    table = history(tmp_path_factory.mktemp("history") / "h.csv", "time,load_tx", *enumerate(turns))
    return solve(CASE, dict(table, steps=4), check=11).path


# ---------------------------------------------------------------- options without effect


@pytest.mark.parametrize(
    "words, pictures",
    [
        (["--history", "--field", "gap", "--loop", "--log", "colors,x"], None),
        (["--loop", "--field", "gap", "--profiles", "--scalar", "load_tx"], None),
        (["--range", "5:12"], {"results_loop.png", "results_history.png"}),
        (["--history", "--range", "5:"], {"results_history.png"}),
    ],
)
def test_options_that_a_picture_uses_are_taken(draw, path, tmp_path, words, pictures):
    assert draw(path, *words) == (0, [])
    assert pictures in (None, {file.name for file in tmp_path.iterdir()})


def given(**options):
    """Options as they are read from an empty command line, but for some."""
    parser = Parser()
    for group in (arguments._pictures, arguments._quantities, arguments._steps, arguments._look):
        group(parser)
    parsed = parser.parse_args([])
    parsed.spelling = "--scalar"
    assert set(options) <= set(vars(parsed))
    vars(parsed).update(options)
    return parsed


def a_file(kind, along=None):
    """A file of stresses, or a table of a study, of which nothing but its kind is known."""
    file = object.__new__(kind)
    file.along = along
    return file


@pytest.mark.parametrize(
    "kind, kinds, option, value, along, used",
    [
        (Stresses, ["sections"], "at", (0.0, 0.0), None, True), (Stresses, ["sections"], "at", (0.0, 0.0), "x", False),
        (Stresses, ["maps"], "at", (0.0, 0.0), None, False), (Stresses, ["maps"], "depth", [0.0], None, True),
        (Stresses, ["sections"], "depth", [0.0], "x", False), (Stresses, ["fatigue"], "step", [1], "x", False),
        (Stresses, ["fatigue"], "component", "xy", "x", False), (Stresses, ["profiles"], "limits", [0, 1], "x", False),
        (Stresses, ["maps"], "percentile", 9.0, None, False), (Stresses, ["maps"], "whole_grid", True, None, False),
        (Stresses, ["maps"], "log", ["colors"], None, False),
        (Stresses, ["sections", "fatigue"], "step", [1], "x", True),
        (Study, ["study"], "by", "mu", None, True), (Study, ["study"], "log", ["x"], None, True),
        (Study, ["study"], "log", ["colors"], None, False), (Study, ["study"], "percentile", 9.0, None, False),
        (Study, ["study"], "depth", [0.0], None, False), (Study, ["study"], "range", (1, 2), None, False),
    ],
)  # fmt: skip
def test_options_of_stresses_and_studies_are_looked_at_too(kind, kinds, option, value, along, used):
    options = given(**{option: value})
    if used:
        uses.need_use(options, [a_file(kind, along)], kinds)
    else:
        with pytest.raises(uses.Unusable, match="has no effect on the picture"):
            uses.need_use(options, [a_file(kind, along)], kinds)


def test_every_option_that_chooses_something_is_looked_at():
    look = {"labels", "output", "report", "format", "dpi", "spelling", "log"}  # log: by its words
    look |= {"csv", "width", "xlim", "ylim"}  # of every picture
    kinds = {name for name, value in vars(given()).items() if value is False} - {"whole_grid"}
    assert set(vars(given())) - look - kinds == {name for name in uses.NAMES if not name.startswith("log ")}


# ---------------------------------------------------------------- values that are NaN


@pytest.mark.parametrize(
    "friction, words, told",
    [
        (0.0, ["--scalar", "load_n,slip_max"], "--scalar slip_max: is NaN in all steps: without friction"),
        (0.0, ["--scalar", "load_n", "--against", "slip_max"], "--against slip_max: is NaN in all steps"),
        (
            0.27,
            ["--scalar", "lost"],
            "--scalar lost: is NaN in all steps: this run does not compute it; choose load_n, ",
        ),
    ],
)
def test_a_scalar_without_a_number_is_no_empty_picture(draw, solve, tmp_path, friction, words, told):
    path = shutil.copy(solve(CASE, dict(friction=friction)).path, tmp_path / "r.h5")
    with h5py.File(path, "r+") as file:
        file["history"]["lost"] = np.full(1, np.nan)
        file["history"]["lost"].attrs["units"] = "m"
    code, (error,) = draw(path, "-o", tmp_path / "x.png", *words)
    assert code == 2 and f"r.h5: {told}" in error and "contact_area" in error
    assert not (tmp_path / "x.png").exists()


# ---------------------------------------------------------------- formats


@pytest.mark.parametrize("name", ["x.bmp", "x.JPG", "a.b/x.jpeg", "x.png.gif", "x.jp2", "x.h5"])
def test_an_ending_that_is_no_format_is_bad_usage(draw, path, tmp_path, name):
    for words in ([], ["--maps"], ["--format", "png"]):
        code, (error,) = draw(path, "-o", name, *words)
        assert code == 2 and f"--output {name}: expected a name that ends in .png, .pdf or .svg, or has no" in error
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name, written", [("x.SVG", "x.SVG"), ("x", "x.png"), ("mu=0.3", "mu=0.3.png")])
def test_formats_and_names_without_an_ending_are_taken(draw, path, tmp_path, name, written):
    assert draw(path, "-o", name, "--loop") == (0, [])
    assert [file.name for file in tmp_path.iterdir()] == [written]


# ---------------------------------------------------------------- a range of load steps


def test_a_history_and_a_loop_of_some_load_steps(path):
    results = petsam.open(path)
    assert results.solved.size == 16  # which is kept, and is not that of a part
    with h5py.File(path, "r") as file:
        load, energy, status = (file["history"][name][:] for name in ("load_tx", "dissipated_energy", "status"))
    some = slice(4, 12)  # steps 5 to 12: loading and the way back, without the steps of the preload
    for part in (results.between(5, 12), results.between(5, -6)):
        line = series.history([part], ["load_tx"], "disp_x").axes[0].lines[0]
        assert np.allclose(line.get_ydata(), load[some], rtol=1e-14)
        sum_of_energy = series.history([part], ["dissipated_energy"]).axes[0].lines[0].get_ydata()
        assert np.allclose(sum_of_energy / sum_of_energy[-1], np.cumsum(energy[some]) / energy[some].sum())
        drawn = loops.loop([part])
        assert np.allclose(drawn.axes[0].lines[0].get_ydata(), load[some], rtol=1e-14)
    assert status[-1] == 11 and results.solved.size == status.size - 1
    every = series.history([results.between(13, None)], ["status"]).axes[0].lines[0]
    assert np.array_equal(every.get_ydata(), status[12:])
    x, y = series.history([results.between(3, None)], ["status"], "load_tx").axes[0].lines[0].get_data()
    assert np.allclose(x, load[2:-1], rtol=1e-14) and not y.any()
    assert results.solved.size == status.size - 1  # the results themselves are whole
