"""Applications: one more is found by its folder (tests/trials/apps), and one that is deleted leaves no gap."""

import ast
import dataclasses
import re
import shutil
import sys

import numpy as np
import pytest

import petsam
from conftest import PROGRAM, environment
from petsam import apps
from petsam.core.tables import Tabled, column
from petsam.plot import founds
from support import ROOT, ball, finished, slide_limit

CASE = ball(n=24)
EVERY_MODULE = """
import importlib, pkgutil, petsam
for module in pkgutil.walk_packages(petsam.__path__, "petsam."):
    importlib.import_module(module.name)
for name in dir(petsam):
    getattr(petsam, name)
for name in dir(petsam.plot):
    getattr(petsam.plot, name)
"""


@pytest.fixture(scope="module")
def loop(tmp_path_factory):
    """A file of two turns of a load."""
    folder = tmp_path_factory.mktemp("loop")
    load = 0.5 * slide_limit(CASE)[0]
    rows = [f"{k},{CASE['load_n']},{load * turn}\n" for k, turn in enumerate((0, 1, -1, 1, -1, 1))]
    (folder / "turns.csv").write_text("time,load_n,load_tx\n" + "".join(rows))
    given = {name: value for name, value in CASE.items() if name != "load_n"}
    petsam.run(**given, history=folder / "turns.csv", output=folder / "loop.h5").close()
    return folder / "loop.h5"


@pytest.fixture
def tree(tmp_path):
    """A copy of the scripts and the Makefile, in which applications come and go."""
    shutil.copytree(ROOT / "scripts", tmp_path / "scripts", symlinks=True)
    shutil.copytree(ROOT / "include", tmp_path / "include")
    shutil.copy(ROOT / "Makefile", tmp_path)
    return tmp_path


@pytest.fixture
def trial(tree):
    """A tree with the application petsam.one, whose script `make` has made."""
    shutil.copytree(ROOT / "tests/trials/apps/one", tree / "scripts/petsam/apps/one")
    ask(tree, "make", "-s", "scripts/petsam-one")
    return tree


def ask(tree, *words, check=0):
    """What a command prints whose package is that of a tree."""
    env = dict(environment(), PYTHONPATH=str(tree / "scripts"), PETSAM=str(PROGRAM), PYTHON=sys.executable)
    done = finished(list(map(str, words)), check, env=env, cwd=tree)
    return done.stdout + done.stderr


def script(tree, *words, check=0):
    return ask(tree, sys.executable, "-c", *words, check=check)


def test_one_more_application_is_a_part_of_the_package(trial):
    script(trial, "import petsam\nassert 'one' in dir(petsam) and 'settled' in dir(petsam.plot)\n"
                  "assert petsam.one.settling and petsam.plot.settled and dir(petsam.one)")  # fmt: skip


def test_one_more_application_has_a_command_a_table_and_a_page(trial, loop):
    assert (
        ask(trial, "scripts/petsam-one", "none.h5", "-o", "x", check=3) == "petsam-one: error: none.h5: no such file\n"
    )
    ask(trial, "scripts/petsam-one", loop, "-o", "settled")
    head, *rows = (trial / "settled.csv").read_text().splitlines()
    assert head == "settling_cycle [1],ratio [1]" and len(rows) == 2 and rows[-1].endswith(",1.0")
    ask(trial, "scripts/petsam-plot", "--report", "settled.html", "settled.csv")
    page = (trial / "settled.html").read_text()
    assert "<h1>Settling</h1>" in page and "petsam-one" in page and page.count("<figure>") == 1
    assert "energy over that of the last cycle" in page and "Energies over the cycles" in page
    (trial / "short.csv").write_text("settling_cycle [1]\n1\n")
    told = ask(trial, "scripts/petsam-plot", "--report", "x.html", "short.csv", check=3)
    assert (
        "short.csv: its columns are settling_cycle [1]: give a table with the columns settling_cycle [1], ratio [1]"
        in told
    )
    assert "petsam-one begin" in ask(trial, "scripts/petsam-plot", "--report", "x.html", wrong(trial), check=3)


def test_any_table_of_an_application_has_a_page_with_the_pictures_that_take_it_alone(tmp_path):
    values = petsam.surface.Map(np.ones((3, 4)) * 1e-6, (8e-6, 6e-6), (0, 0), "height1", "flat", None)
    values.report(tmp_path / "map.html", {"friction": 0.3})
    page = (tmp_path / "map.html").read_text()
    assert page.count("<figure>") == 1 and "by petsam.plot.surface" in page and "12 rows" in page and "friction" in page
    steel = {f"body{k}_{name}": value for k in (1, 2) for name, value in (("young", 210e9), ("poisson", 0.3))}
    petsam.plot.report(petsam.fit.plan(petsam.fit.ball(100.0, 0.01, steel), 0.5, 2e7, cycles=1), tmp_path / "plan.html")
    page = (tmp_path / "plan.html").read_text()  # texts beside numbers, and no picture
    assert "0.9 of sliding" in page and "<figure>" not in page and "<h1>Relative standard deviations" in page
    forces = petsam.loads.History
    assert [*founds.drawing(forces.__new__(forces), petsam.apps.loads.PART)] == ["loads"]  # not that beside results
    fit = petsam.fit.Result
    assert [*founds.drawing(fit.__new__(fit), petsam.apps.fit.PART)] == ["fit"]
    with pytest.raises(petsam.Error, match="report: expected results of petsam.open"):
        petsam.plot.report(petsam.fit.Record.__new__(petsam.fit.Record), tmp_path / "x.html")


@pytest.mark.parametrize("error, text, shown", [("1", "relative error", "5 %"), ("m", "its error", "0.05")])
def test_errors_stand_beside_the_numbers_of_any_table_and_constants_apart(tmp_path, error, text, shown):
    @dataclasses.dataclass
    class Found(Tabled):
        """Depths of a test; and more."""

        at: list = column("m", "where it is")
        depth: list = column("m", "how deep it is")
        depth_error: list = column(error, text)
        load: list = column("N", "load")

    Found.__module__ = "petsam.apps.wheel.found"
    Found([0.0, 1.0], [1.0, 2.0], [0.05, 0.05], [7.0, 7.0]).report(tmp_path / "f.html")
    page = (tmp_path / "f.html").read_text()
    assert "<h1>Depths of a test</h1>" in page and "Load, of all rows" in page and 'value="7.0"' in page
    heads = re.findall(r'<th scope="col"[^>]*>(.*?)</th>', page)
    assert heads == ["at", "depth"] and len(re.findall(rf"&plusmn; [^/]*{shown}", page)) == 2


def wrong(tree):
    path = tree / "wrong.csv"
    path.write_text("a [1]\n1\n")
    return path


def test_one_more_application_is_in_the_manual(trial):
    ask(trial, "make", "-s", "build/share/man/man1/petsam-one.1")
    manual = (trial / "build/share/man/man1/petsam-one.1").read_text()
    assert "settled.csv" in manual and "petsam\\-plot(1)" in manual.replace("petsam-plot(1)", "petsam\\-plot(1)")
    assert "petsam-one" in ask(trial, sys.executable, "-c", "import sys; sys.path.insert(0, 'scripts/maintain')\n"
                               "import manpage; print(manpage.see_also('petsam'))")  # fmt: skip
    reference = ask(trial, sys.executable, "scripts/maintain/modules.py")
    assert "\n### petsam.one.settling\n" in reference and "\n### petsam.plot.settled\n" in reference
    assert "petsam-one" in installed(trial)


def installed(tree):
    """The scripts that `make install` puts into bin, with their completions."""
    return ask(tree, "make", "-s", "--eval", "show: ; @echo $(TOOLS)", "show")


@pytest.mark.parametrize("name", [*(pytest.param(one, marks=pytest.mark.slow) for one in ("wheel", "fit")), "joint"])
def test_an_application_that_is_deleted_leaves_no_gap(tree, loop, name):
    shutil.rmtree(tree / "scripts/petsam/apps" / name)
    script(tree, EVERY_MODULE)
    ask(tree, "scripts/petsam-plot", "--loop", "-o", "loop.png", loop)
    ask(tree, "scripts/petsam-plot", "--report", "loop.html", loop)
    ask(tree, sys.executable, "scripts/maintain/modules.py")
    assert "no command of this name" in ask(tree, sys.executable, f"scripts/petsam-{name}", check=1)
    assert f"petsam-{name}" not in installed(tree)


RECORD = """from ...core.part import Part
PART = Part(__name__, {0})
__all__, __getattr__, __dir__ = PART.face()
"""


BROKEN = [
    ("def (", "SyntaxError"),
    ("import nosuchlib", "No module named 'nosuchlib'"),
    ("", "has no attribute 'PART'"),
    (RECORD.format('pictures={"x": ("saving",)}'), "pictures of its record: saving"),
    (RECORD.format('pictures={"x": ("backbone",)}'), "pictures of its record: backbone"),
    (RECORD.format('expressions={"x": ("life_swt",)}'), "expressions of its record: life_swt"),
    (RECORD.format('tables={"a": ("b",)}'), "tables of its record: a: "),
    (RECORD.format('names={"m": ("a",)}, tables={"a": ("pressure",)}'), "tables of its record: pressure"),
    (RECORD.format('top=("nothere",)'), "top of its record: nothere"),
]


def test_broken_applications_are_left_out_and_named(tree, loop):
    for k, (text, _) in enumerate(BROKEN):
        (tree / f"scripts/petsam/apps/zz{k}").mkdir()
        (tree / f"scripts/petsam/apps/zz{k}/__init__.py").write_text(text)
    told = script(tree, "import petsam\npetsam.plot.surface, petsam.joint.Structure, dir(petsam)\n"
                        "try:\n    petsam.nonsense\nexcept AttributeError as error:\n    print(error)")  # fmt: skip
    for k, (_, says) in enumerate(BROKEN):
        assert re.search(rf"petsam\.apps\.zz{k} is left out: .*{re.escape(says)}", told), says
    assert "has no attribute 'nonsense'" in told
    ask(tree, "scripts/petsam-plot", "--loop", "-o", "loop.png", loop)


@pytest.mark.parametrize("name", ["names", "new-one", "results", "open"])
def test_an_application_cannot_have_a_name_that_is_taken(tree, name):
    (tree / "scripts/petsam/apps" / name).mkdir()
    (tree / "scripts/petsam/apps" / name / "__init__.py").write_text(RECORD.format(""))
    script(tree, "import petsam\nfrom petsam import apps\nassert callable(apps.names) and petsam.results.Results\n"
                 "assert petsam.open.__module__ == 'petsam' and 'new-one' not in dir(petsam)")  # fmt: skip
    assert "usage: petsam-plot" in ask(tree, "scripts/petsam-plot", "--help")


@pytest.mark.parametrize(
    "link, target, runs",
    [
        ("j", "petsam-joint", "joint"),
        ("petsam-joint-3", "petsam-joint", "joint"),
        ("p", "petsam-plot", "plot"),
        ("petsam-none", "petsam-plot", ""),
    ],
)
def test_a_script_is_found_through_links(tmp_path, link, target, runs):
    (tmp_path / link).symlink_to(ROOT / "scripts" / target)
    done = finished([tmp_path / link, "--help"], 0 if runs else 1, env=dict(environment(), PYTHON=sys.executable))
    assert f"usage: petsam-{runs}" in done.stdout if runs else "no command of this name" in done.stderr


def test_hints_are_for_Python_3_9():
    """Without the future import a union of types by | is evaluated, which Python 3.9 cannot."""
    for path in (ROOT / "scripts" / "petsam").rglob("*.py"):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        late = any(isinstance(node, ast.ImportFrom) and node.module == "__future__" for node in tree.body)
        hints = [getattr(node, name, None) for node in ast.walk(tree) for name in ("annotation", "returns")]
        unions = [part for hint in hints if isinstance(hint, ast.AST) for part in ast.walk(hint)
                  if isinstance(part, ast.BinOp)]  # fmt: skip
        assert late or not unions, path


def words_of(path):
    """The texts and names of a source, without its docstrings."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and ast.get_docstring(node):
            node.body = node.body[1:] or [ast.Pass()]
    return ast.unparse(tree)


def test_nothing_below_names_an_application():
    """But for files of petsam-study, which petsam.open() reads."""
    names = [f"petsam{mark}{name}" for name in apps.names() for mark in ".-" if mark + name != "-study"]
    package = ROOT / "scripts" / "petsam"
    below = [path for path in package.rglob("*.py") if "apps" not in path.parts]
    assert len(below) > 50
    words = {path: words_of(path) for path in below}
    found = [(path.name, name) for path in below for name in names if name in words[path]]
    assert not found
