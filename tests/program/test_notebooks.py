"""The notebooks of the examples run as they are, and are stored with the outputs of a run."""

import ast
import inspect
import json
import os
import re

import pytest

from conftest import PROGRAM
from support import ROOT

NOTEBOOKS = sorted((ROOT / "examples" / "notebooks").glob("*.ipynb"))
LONG = ("blade-root", "joint", "lap", "measurements")  # of many steps, or of many fits
RUNS = [pytest.param(one, id=one.stem, marks=[pytest.mark.slow] * (one.stem in LONG)) for one in NOTEBOOKS]


def pictures(notebook):
    """Whether each cell shows a picture."""
    return ["image/png" in str(cell.get("outputs", "")) for cell in notebook["cells"]]


def complaints(notebook):
    """What its cells have written as warnings or errors."""
    outputs = [one for cell in notebook["cells"] for one in cell.get("outputs", ())]
    return [one for one in outputs if one["output_type"] == "error" or one.get("name") == "stderr"]


def written(notebook):
    """What its cells print and show as text, with # for numbers; and the numbers."""
    outputs = [one for cell in notebook["cells"] for one in cell.get("outputs", ())]
    texts = ["".join(one.get("text") or one.get("data", {}).get("text/plain", "")) for one in outputs]
    number = r"(?<![\w.])-?\d+(?:\.\d*)?(?:e[+-]?\d+)?"
    words = [re.sub(r"\s+", " ", re.sub(number, "#", text)) for text in texts]
    return words, [float(one) for text in texts for one in re.findall(number, text)]


def test_there_are_seven():
    names = ["blade-root", "coating", "joint", "lap", "life", "loop", "measurements"]
    assert [file.stem for file in NOTEBOOKS] == names


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_outputs_are_stored_small_and_of_no_machine(file):
    notebook = json.loads(file.read_text())
    assert file.stat().st_size < 200_000 and 8 <= len(notebook["cells"]) <= 17
    heading, question = "".join(notebook["cells"][0]["source"]).split("\n", 1)
    assert heading.startswith("# ") and "?" in question.split(". ")[0]
    code = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert [cell["execution_count"] for cell in code] == list(range(1, len(code) + 1))
    assert sum(pictures(notebook)) >= 2 and not complaints(notebook)
    texts = [[one.get("text"), one.get("data", {}).get("text/plain")] for cell in code for one in cell["outputs"]]
    assert not re.search(r"(^|[\s'\"])/\w", json.dumps(texts)), "a path of a machine"


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_calls_of_the_package_have_its_names_and_arguments(file):
    """Without a run: some notebooks run long."""
    cells = json.loads(file.read_text())["cells"]
    tree = ast.parse("\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"))
    imports = [
        one for one in tree.body if isinstance(one, ast.Import | ast.ImportFrom) and "petsam" in ast.unparse(one)
    ]
    exec(compile(ast.Module(imports, []), file.name, "exec"), names := {})
    calls = [one for one in ast.walk(tree) if isinstance(one, ast.Call)]
    calls = [one for one in calls if re.fullmatch(r"(petsam|joint|plot)(\.\w+)+", ast.unparse(one.func))]
    assert calls
    for call in calls:
        function = eval(ast.unparse(call.func), names)
        inspect.signature(function).bind_partial(**{one.arg: None for one in call.keywords if one.arg})


@pytest.mark.parametrize("file", RUNS)
def test_notebook_runs_and_shows_what_is_stored(file, tmp_path, monkeypatch):
    nbclient = pytest.importorskip("nbclient", reason="nbclient is not installed: tests/requirements-optional.txt")
    pytest.importorskip("ipykernel", reason="ipykernel is not installed: tests/requirements-optional.txt")
    nbformat = pytest.importorskip("nbformat")
    monkeypatch.setenv("PATH", f"{PROGRAM.parent}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("PYTHONPATH", str(ROOT / "scripts"))
    monkeypatch.delenv("MPLBACKEND", raising=False)  # which petsam sets in a process that has no notebook
    if "meshio" in file.read_text():
        pytest.importorskip("meshio", reason="meshio is not installed: tests/requirements-optional.txt")
    notebook = nbformat.read(file, as_version=4)
    nbclient.NotebookClient(notebook, timeout=60, resources={"metadata": {"path": str(tmp_path)}}).execute()
    stored = json.loads(file.read_text())
    assert pictures(notebook) == pictures(stored) and not complaints(notebook)
    (words, numbers), (expected, values) = written(notebook), written(stored)
    assert words == expected
    assert numbers == pytest.approx(values, rel=0.02)  # they are rounded
