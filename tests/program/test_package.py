"""The Python package: what importing it costs, reading of results and of what is none, closed solutions, examples."""

import importlib
import re
import runpy
import sys

import h5py
import numpy as np
import pytest

import petsam as package
from conftest import environment
from support import FIELDS, ROOT, ball, finished, slide_limit

SCRIPTS = ROOT / "scripts"
PAGES = [
    ROOT / "README.md",
    *(page for folder in ("examples", "include", "scripts") for page in ROOT.glob(folder + "/**/*.md")),
]
EXAMPLES = sorted(
    path.parent.name for path in (ROOT / "examples").glob("*/figures.py") if (path.parent / "run.sh").exists()
)
CASE = ball(n=32)


def python(*words, check=0):
    """Output of the interpreter with the package on its path."""
    env = dict(environment(), PYTHONPATH=str(SCRIPTS))
    done = finished([sys.executable, *map(str, words)], check, env=env)
    return done.stdout + done.stderr


@pytest.fixture(scope="module")
def path(solve):
    """Four load steps; fields of the second and the fourth."""
    return solve(dict(CASE, load_tx=0.5 * slide_limit(CASE)[0], steps=4, output_every=2)).path


# ---------------------------------------------------------------- imports


def modules_after(code):
    """Names of the libraries that a program has imported."""
    return python("-c", code + "\nimport sys\nprint(*{name.split('.')[0] for name in sys.modules})").split()


def test_importing_the_package_imports_no_library():
    assert not {"numpy", "h5py", "scipy", "matplotlib", "yaml"} & set(modules_after("import petsam"))


def test_reading_results_does_not_import_matplotlib(path):
    code = f"import petsam\nstep = petsam.Snapshot(petsam.open({str(path)!r}))\nassert step['pressure'].max() > 0.0"
    names = modules_after(code)
    assert "h5py" in names and not {"matplotlib", "scipy"} & set(names)


def test_closed_solutions_do_not_import_matplotlib():
    assert not {"matplotlib", "h5py"} & set(modules_after("import petsam.closed.plane, petsam.closed.spence"))


def test_what_the_pages_name_is_there_after_import_petsam_alone():
    names = {name for page in PAGES for name in re.findall(r"\bpetsam((?:\.[A-Za-z_]\w*)+)", page.read_text())}
    names = sorted(name for name in names if not re.match(r"\.(def|f90|h|log|opts|pc|h5)$", name))
    assert {".open", ".cycles.find", ".closed.plane", ".Contact"} <= set(names)
    for name in names:  # an import would also give it to those that follow
        python("-c", f"import petsam\npetsam{name}")
    assert {"cycles", "closed", "Contact", "open"} <= set(dir(package)) and "plane" in dir(package.closed)
    with pytest.raises(AttributeError, match="has no attribute 'circles'"):
        _ = package.circles


@pytest.mark.parametrize(
    "line",
    [
        "from petsam.wheel import Track",
        "import petsam.joint, petsam.materials, petsam.cycles",
        "import petsam.wheel.profile as one, petsam.apps.wheel.profile as other\nassert one is other",
        "from petsam.gradient import function",
        "import petsam.fit\nassert petsam.fit.__spec__.name == petsam.fit.__name__ == 'petsam.apps.fit'",
    ],
)
def test_parts_are_imported_by_their_names(line):
    python("-c", line)


@pytest.mark.parametrize("name", ["nonsense", "wheel.nonsense", "joint.profile"])
def test_import_of_a_name_that_is_none(name):
    assert f"No module named 'petsam.{name}'" in python("-c", f"import petsam.{name}", check=1)


def test_completion_of_modules_on_the_reference_shows_what_is_there():
    sys.path.insert(0, str(SCRIPTS / "maintain"))
    import modules

    for name in (*modules.BEFORE, *modules.BEHIND):
        module = importlib.import_module("petsam." + name)
        listed = set(modules.offered(name)) or set(modules.public(name))
        assert set(dir(module)) == listed and all(hasattr(module, one) for one in dir(module)), name


def test_completion_shows_only_what_is_public(path):
    modules = {"commands", "contact", "core", "errors", "running"}
    libraries = {"importlib", "os", "np", "h5py"}
    assert package.Contact and package.Results  # imports their modules
    assert set(package.__all__) <= set(dir(package)) and not (modules | libraries) & set(dir(package))
    assert all(hasattr(package, name) for name in dir(package))
    with package.open(path) as results:
        names = {name for name in dir(results) if not name.startswith("_")}
        assert {"history", "field", "times", "between"} <= names
        own = {"complete", "cycles_before", "fills", "held", "last_row", "later", "places", "sources", "whole"}
        assert not own & names


def test_the_snippets_of_the_page_of_pictures_run(path, tmp_path):
    (tmp_path / "build/run").mkdir(parents=True)
    (tmp_path / "build/run/pad.h5").symlink_to(path)
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "examples/manual/PICTURES.md").read_text(), re.DOTALL)
    assert blocks
    for block in blocks:
        python("-c", f"import os\nos.chdir({str(tmp_path)!r})\n{block}")


# ---------------------------------------------------------------- results


def test_a_snapshot_has_the_fields_and_scalars_of_its_step(path):
    with package.open(path) as results, h5py.File(path, "r") as file:
        assert results.steps == [2, 4] and list(results.history) == list(file["history"])
        for index, step in ((0, 2), (1, 4), (-1, 4)):
            snapshot = package.Snapshot(results, index)
            for name in FIELDS:
                assert np.array_equal(snapshot[name], file[name][index])
            for name, data in file["history"].items():
                assert np.array_equal(snapshot[name], data[step - 1], equal_nan=data.dtype.kind == "f")
            assert snapshot.radius("contact_area") == np.sqrt(file["history/contact_area"][step - 1] / np.pi)
        assert results.parameters["gap_radius1"] == CASE["gap_radius1"]


def read_all(results):
    """Asks results for all that they have."""
    print(results, results.products, results.depths)
    for name in results.keys():
        assert results[name].shape[0] in (results.times.size, results.time.size)
    for name in results.fields:
        results.about(name), results.flags(name)
    for name in results.edges:
        results.edge(name)
    results.contact_window(-1), results.friction(-1), results.title(-1), results.of_time(results.times[-1])
    results.between(1, 1), package.Snapshot(results)["pressure"]


def test_whatever_is_damaged_is_read_or_an_error_of_petsam(path, tmp_path):
    """500 bytes at one place after another of the descriptions of groups, columns and fields."""
    data, noise, errors, name = path.read_bytes(), np.random.default_rng(3), 0, tmp_path / "damaged.h5"
    for place in range(4000, 24000, 500):
        name.write_bytes(data[:place] + noise.bytes(500) + data[place + 500 :])
        try:
            with package.open(name) as results:
                read_all(results)
        except package.Error as error:
            assert str(error).startswith(str(name))
            errors += 1
    assert errors > 10


def test_a_file_that_keeps_hdf5_busy_for_ever_is_damaged(path, tmp_path):
    """Zeros over the names of its datasets, at several places: each is listed, or told of within seconds."""
    data, damaged = path.read_bytes(), []
    for place in range(2000, 3600, 400):
        damaged.append(tmp_path / f"{place}.h5")
        damaged[-1].write_bytes(data[:place] + bytes(500) + data[place + 500 :])
    code = """
import sys, petsam
for name in sys.argv[1:]:
    try:
        print(len(str(petsam.open(name))), "listed")
    except petsam.Error as error:
        print(error)
"""
    said = python("-c", code, *damaged).splitlines()
    assert len(said) == len(damaged) and any(line.endswith(": is damaged") for line in said), said
    with package.open(path) as results:
        assert results.steps == [2, 4]


def replace(name, value=None):
    """A change of a results file: another value instead of what has this name, or none."""

    def change(file):
        del file[name]
        if value is not None:
            file[name] = value

    return change


def forget_steps(file):
    """Leave no load step in the history."""
    for name, units in [(data.name, data.attrs["units"]) for data in file["history"].values()]:
        replace(name, np.zeros(0))(file)
        file[name].attrs["units"] = units


def shorten(name, count):
    """Leave so many values of a column of the history."""

    def change(file):
        values, units = file[name][:count], file[name].attrs["units"]
        replace(name, values)(file)
        file[name].attrs["units"] = units

    return change


CHANGES = {
    "x is a group": lambda file: (file.pop("x"), file.create_group("x")),
    "x is a number": replace("x", 1.0),
    "no friction": lambda file: file.attrs.pop("friction"),
    "history is a field": replace("history", np.zeros(3)),
    "no history/time": replace("history/time"),
    "no units": lambda file: file["history/load_n"].attrs.pop("units"),
    "no step": forget_steps,
    "pressure of another shape": replace("pressure", np.zeros((2, 5, 5))),
    "no pressure": replace("pressure"),
}


@pytest.mark.parametrize("how", ["truncated", *CHANGES])
def test_an_odd_file_is_the_packages_error_with_its_path(path, tmp_path, how):
    odd = tmp_path / "odd.h5"
    odd.write_bytes(path.read_bytes()[: path.stat().st_size // (2 if how == "truncated" else 1)])
    if how in CHANGES:
        with h5py.File(odd, "r+") as file:
            CHANGES[how](file)
    with pytest.raises(package.Error, match="odd.h5: "):
        package.Snapshot(package.open(odd))["pressure"]


@pytest.mark.parametrize("name, count", [("history/load_n", 0), ("history/time", 1)])
def test_a_table_has_the_steps_that_all_columns_have(path, tmp_path, name, count):
    """A killed run may leave columns of different lengths."""
    odd = tmp_path / "odd.h5"
    odd.write_bytes(path.read_bytes())
    with h5py.File(odd, "r+") as file:
        shorten(name, count)(file)
    with package.open(odd) as results:
        assert len(results.to_dataframe()) == count


@pytest.mark.parametrize("content, reason", [(None, "no such file"), (b"text", "is not an HDF5 file")])
def test_what_is_no_file_of_hdf5_is_told(tmp_path, content, reason):
    if content:
        (tmp_path / "odd.h5").write_bytes(content)
    with pytest.raises(package.Error, match=f"odd.h5: {reason}"):
        package.open(tmp_path / "odd.h5")


@pytest.mark.parametrize("ask", [
    lambda results: results.field("nothing"), lambda results: results.field("pressure", 2),
    lambda results: results.history["nothing"], lambda results: results.parameters["nothing"],
    lambda results: results.of_step(3), lambda results: results.of_step(5), lambda results: results.of_time(9.0),
    lambda results: package.Snapshot(results)["nothing"],
])  # fmt: skip
def test_what_the_file_has_not_is_the_packages_error(path, ask):
    with package.open(path) as results, pytest.raises(package.Error, match="results.h5: "):
        ask(results)


@pytest.mark.parametrize("ask, says", [
    (lambda results: results.field("pressure", 500), "index 500: 2 steps are saved, indices 0 to 1, or -1 to -2 from"),
    (lambda results: results.field("pressure", 4), "from the end; that of load step 4 is of_step(4)"),
    (lambda results: results.field("pressure", -3), "index -3: 2 steps are saved"),
    (lambda results: results.edge("contact_edge", 500), "index 500: 2 steps are saved"),
    (lambda results: package.Snapshot(results, 2), "index 2: 2 steps are saved"),
    (lambda results: results.field("presure"), "has no presure (petsam -output_fields): is pressure meant? It has "),
    (lambda results: results.quantity("slips"), ": is slip_x meant? It has "),
    (lambda results: results.history["area"], "has no area: is contact_area or stick_area meant? It has contact_area"),
    (lambda results: results.parameters["fricton"], "has no fricton: is friction meant? It has "),
    (lambda results: results.history["qqq"], "has no qqq; it has contact_area, "),
])  # fmt: skip
def test_what_is_asked_for_wrongly_is_told_with_the_nearest_name_and_all_names(path, ask, says):
    with package.open(path) as results, pytest.raises(package.Error) as caught:
        ask(results)
    assert str(caught.value).startswith(f"{path}: ") and says in str(caught.value)
    assert "is not a results file" not in str(caught.value)


# ---------------------------------------------------------------- closed solutions, examples


@pytest.mark.parametrize("example", EXAMPLES)
def test_figures_of_an_example_without_results_say_what_to_run(example, call, tmp_path, monkeypatch):
    figures = ROOT / "examples" / example / "figures.py"
    monkeypatch.syspath_prepend(figures.parent)
    code, said = call(figures, tmp_path, main=lambda: runpy.run_path(str(figures), run_name="__main__"))
    assert code == 1 and len(said) == 1 and said[0].endswith(f"; run examples/{example}/run.sh first")
