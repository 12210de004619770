"""The notebooks of the examples run as they are, and are stored without outputs."""

import json
import os

import pytest

from conftest import PROGRAM
from support import ROOT

NOTEBOOKS = sorted((ROOT / "examples" / "notebooks").glob("*.ipynb"))


def test_there_are_three():
    assert [file.stem for file in NOTEBOOKS] == ["coating", "life", "loop"]


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_no_outputs_are_stored(file):
    cells = json.loads(file.read_text())["cells"]
    assert all(not cell.get("outputs") and cell.get("execution_count") is None for cell in cells)


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_notebook_runs_and_shows_its_pictures(file, tmp_path, monkeypatch):
    nbclient = pytest.importorskip("nbclient", reason="nbclient is not installed: tests/requirements-optional.txt")
    pytest.importorskip("ipykernel", reason="ipykernel is not installed: tests/requirements-optional.txt")
    nbformat = pytest.importorskip("nbformat")
    monkeypatch.setenv("PATH", f"{PROGRAM.parent}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("PYTHONPATH", str(ROOT / "scripts"))
    monkeypatch.delenv("MPLBACKEND", raising=False)  # which petsam sets in a process that has no notebook
    notebook = nbformat.read(file, as_version=4)
    nbclient.NotebookClient(notebook, timeout=60, resources={"metadata": {"path": str(tmp_path)}}).execute()
    for cell in notebook.cells:
        shown = [out.get("data", {}) for out in cell.get("outputs", ())]
        assert any("image/png" in data for data in shown) == (".plot." in cell.source), cell.source
