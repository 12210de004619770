"""What print(results) says, the pictures as calls, and the readers that the page on results shows."""

import importlib.util
import re
import shutil
import subprocess

import h5py
import numpy as np
import pytest

import petsam
from petsam.apps.launch import code_of
from petsam.plot import command
from support import ball

CASE = dict(ball(32), grid_n=(32, 30), load_tx=20.0, steps=3, output_every=2)


@pytest.fixture
def results(solve):
    with petsam.open(solve(CASE, dict(stiffness="true")).path) as opened:
        yield opened


def test_listing_names_all_with_shapes_and_units(results):
    text = str(results)
    words = re.sub(r"\s+", " ", text)
    assert f"{results.path}: results of petsam {results.parameters['petsam_version']}" in text
    assert "steps 3, from 1 on; fields of 2, 3" in words and "32 x 30 cells" in words
    assert "fields (2, 30, 32): " in words and "history (3,): " in words
    assert "matrices (3, 6, 6): stiffness, stiffness_reversal" in words
    for name in (*results.fields, *results.history):
        assert re.search(rf"\b{name}\b", words), name
    assert "pressure (Pa)" in words and "load_mx (N m)" in words and "not closed" not in words
    assert max(map(len, text.splitlines()[1:])) <= 110


def test_listing_says_that_a_run_was_killed(results):
    results.parameters["closed"] = 0
    assert "not closed: a run writes to it, or was killed" in str(results)


@pytest.mark.parametrize("lacking", ["time", "pressure", "all but displacement_y", "plastic/residual_stress_xx"])
def test_step_that_a_killed_run_was_writing_does_not_count(lacking, solve, tmp_path):
    """HDF5 writes the new sizes of the datasets one after the other."""
    part = "plastic" if "/" in lacking else "displacement_y"
    more = dict(body2_yield=3e8) if part == "plastic" else {}
    whole = solve(CASE, more, dict(output_fields=f"usual,{part}")).path
    with petsam.open(whole) as run:
        last = len(run.steps) - 1
        expected = {name: run.field(name, last - 1) for name in (*run.fields, *run.layered)}
    cut = shutil.copy(whole, tmp_path / "cut.h5")
    with h5py.File(cut, "r+") as f:
        f.attrs["closed"] = 0
        names = [n for n in (*expected, "time") if n != "displacement_y"] if lacking.startswith("all") else [lacking]
        for name in names:
            f[name].resize(last, axis=0)
    with petsam.open(cut) as run:
        assert len(run.steps) == last and set(run.fields) | set(run.layered) == set(expected)
        for name, values in expected.items():
            assert np.array_equal(run.field(name, -1), values), name


@pytest.mark.parametrize(
    "kind, options, words",
    [
        ("maps", dict(step=[2, -1], field="shear_x"), ["--maps", "--step", "2,-1", "--field", "shear_x"]),
        ("loop", dict(load="tx"), ["--loop", "--load", "tx"]),
        ("profiles", dict(at=[0, 1e-4], whole_grid=True), ["--profiles", "--at", "0,1e-4", "--whole-grid"]),
        ("history", dict(scalar="load_tx", log="y"), ["--scalar", "load_tx", "--log", "y"]),
    ],
)
def test_a_call_draws_what_the_program_does(results, tmp_path, monkeypatch, kind, options, words):
    getattr(petsam.plot, kind)(results, **options).savefig(tmp_path / "call.png", dpi=50)
    monkeypatch.setattr("sys.argv", ["petsam-plot", *words, "--dpi", "50", "-o", str(tmp_path / "p.png"), results.path])
    assert code_of("petsam-plot") == 0
    image = [command.plt.imread(tmp_path / name) for name in ("call.png", "p.png")]
    assert image[0].shape == image[1].shape and np.array_equal(*image)


@pytest.mark.parametrize(
    "picture, options, error, says",
    [
        ("maps", dict(fiel="pressure"), TypeError, "fiel"),
        ("maps", dict(field="presure"), petsam.Error, "is pressure meant?"),
        ("maps", dict(step=9), petsam.Error, "step 9: there are 3 steps"),
        ("maps", dict(at=[0, 0]), TypeError, "at"),
        ("sections", {}, petsam.Error, "is no file of petsam-stress"),
    ],
)
def test_a_mistake_in_a_call_is_an_error(results, picture, options, error, says):
    with pytest.raises(error, match=re.escape(says)):
        getattr(petsam.plot, picture)(results, **options)


def test_an_unknown_picture_names_those_that_there_are():
    with pytest.raises(AttributeError, match="no picture mops: there are backbone, band, compliance, "):
        _ = petsam.plot.mops


def test_the_table_of_pandas_is_the_history(results):
    pandas = pytest.importorskip("pandas", reason="pandas is not installed")
    table = pandas.DataFrame(results.history).set_index("time")
    assert list(table["load_tx"]) == list(results.history["load_tx"]) and len(table.columns) == len(results.history) - 1


def test_names_give_numbers_and_fields_of_all_steps(results):
    assert np.array_equal(results["load_tx"], results.history["load_tx"]) and np.array_equal(
        results.time, results["time"]
    )
    pressure = results["pressure"]
    assert pressure.shape == (2, 30, 32) and np.array_equal(pressure[1], results.field("pressure"))
    assert "pressure" in results and "stick_area" in list(results) and "presure" not in results
    with pytest.raises(petsam.Error, match="is pressure meant"):
        _ = results["presure"]


def test_a_step_says_what_it_is(results):
    assert repr(petsam.Snapshot(results, 0)).endswith(
        f"load step {results.steps[0]} at {results.times[0]:g} s, 32 x 30 cells)"
    )


def test_tables_and_labelled_arrays(results):
    for name, call in (("pandas", results.to_dataframe), ("xarray", results.to_xarray)):
        if importlib.util.find_spec(name) is None:
            with pytest.raises(petsam.Missing, match=f"pip install {name}"):
                call()
    pytest.importorskip("xarray")
    data = results.to_xarray()
    assert np.array_equal(data["pressure"].sel(time=results.times[1]), results.field("pressure"))
    assert data["pressure"].attrs["units"] == "Pa" and data["x"].attrs["units"] == "m"
    pytest.importorskip("pandas")
    assert list(results.to_dataframe()["load_tx"]) == list(results.history["load_tx"])


def test_octave_reads_the_file(results, tmp_path):
    octave = shutil.which("octave")
    if not octave:
        pytest.skip("no octave")
    lines = f'r = load("{results.path}"); printf("%.17g ", r.pressure(12, 7, end), r.history.load_tx, size(r.pressure))'
    done = subprocess.run([octave, "--no-gui", "-q", "--eval", lines], capture_output=True, text=True, timeout=60)
    found = [float(word) for word in done.stdout.split()]
    assert found == [results.field("pressure")[6, 11], *results.history["load_tx"], 32, 30, 2]
