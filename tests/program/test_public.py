"""What users of the package meet first: examples of docstrings, signatures, checks of arguments, repr() of results."""

import ast
import builtins
import doctest
import inspect
import re
import warnings
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

import petsam
from petsam import plot
from petsam.apps import records
from petsam.core import keywords
from petsam.core.brief import brief, shown
from support import SPHERE

PARTS = [*records(), plot.PART, petsam.contact.PART]
NAMES = [(part.find(name), f"{part.name}.{name}") for part in PARTS for name in part.listed]
NAMES += [
    (part.picture(name), f"plot.{name}") for part in records() for names in part.pictures.values() for name in names
]
NAMES += [(getattr(petsam.closed, name), f"closed.{name}") for name in dir(petsam.closed) if not name.startswith("_")]
NAMES += [(petsam.open, "open"), (petsam.run, "run")]
CALLED = [(one, name) for one, name in NAMES if callable(one)]
EXAMPLES = [pytest.param(one, name, id=name) for one, name in CALLED if ">>>" in (inspect.getdoc(one) or "")]


@pytest.mark.parametrize("one, name", EXAMPLES)
def test_examples_of_docstrings_run(one, name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    [test] = doctest.DocTestFinder(recurse=False).find(one, name, globs={})
    said = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(test, out=said.append)
    assert found.attempted and not found.failed, "".join(said)
    assert keywords.sections(inspect.getdoc(one))[1]["Examples"]


def test_main_entries_have_examples():
    assert {name for _, name in (one.values[:2] for one in EXAMPLES)} >= {
        "compliance.of_deck", "conduction.conduct", "fatigue.lives", "fit.analyse", "heat.work", "heat.divided",
        "joint.interface", "loads.history", "open", "plot.loop", "plot.maps", "study.run", "surface.read", "wheel.Axle",
    }  # fmt: skip


@pytest.mark.parametrize("one, name", CALLED)
def test_signatures_are_read_at_a_glance(one, name):
    if not (inspect.isclass(one) and issubclass(one, Exception)):
        assert len(str(inspect.signature(one))) <= 300, name


MISTAKES = (
    (lambda: petsam.wheel.Axle(1, 2), "Axle: rail 1: expected a Track of petsam (The right rail"),
    (lambda: petsam.wheel.Load("100kN"), "vertical '100kN': expected a number (Axle load.*: write vertical=100000$"),
    (lambda: petsam.wheel.Load(1e5, lateral="2 kN"), "lateral '2 kN': expected a number .*: write lateral=2000$"),
    (lambda: petsam.wheel.Load(None), "vertical None: expected a number"),
    (lambda: petsam.wheel.Position(y=[1e-3, "2"]), r"y \[0.001, '2'\]: expected a number"),
    (lambda: petsam.plot.maps(width="180mm"), "maps: width '180mm': .*: write width=180$"),
    (lambda: petsam.plot.maps(width="18cm"), "maps: width '18cm': .*: write width=180$"),
    (lambda: petsam.plot.maps(limits=("0", "5")), r"limits \('0', '5'\): expected 2 numbers .*: write limits=\(0, 5\)"),
    (lambda: petsam.plot.profiles(xlim=(0.0, "1mm")), "profiles: xlim .*: expected 2 numbers"),
    (lambda: petsam.fit.of_shape("a.opts", normal="100N"), "normal '100N': expected a number .*: write normal=100$"),
    (
        lambda: petsam.joint.interface("x.h5", "1MPa"),
        "pressures '1MPa': expected .* array of .*: write pressures=1000000$",
    ),
    (lambda: petsam.run(3), "run: options 3: expected a mapping of names and values"),
    (lambda: petsam.study.run(3), "run: table 3: expected a text or a path or a mapping"),
    (lambda: petsam.open(3), "open: path 3: expected a text or a path"),
    (lambda: petsam.fit.ball(10.0, "5 kg", {}), r"ball: radius '5 kg': expected a number \(Normal load \(N\) .*\)$"),
)


@pytest.mark.parametrize("call, says", MISTAKES)
def test_arguments_of_a_wrong_kind_are_named_with_their_cure(call, says):
    with pytest.raises(petsam.Error, match=says.replace("(The", r"\(The").replace("(Axle", r"\(Axle")) as caught:
        call()
    assert isinstance(caught.value, TypeError) and isinstance(caught.value, ValueError) and caught.value.code == 2


CALLS = (
    (lambda axle: axle.solve(1, 2), r"^Axle.solve: position 1: expected a Position of petsam \(Yaw, speeds"),
    (lambda axle: axle.solve(petsam.wheel.Position()), r"^Axle.solve: missing .* 'load': give load \(The forces\)$"),
    (lambda axle: axle.solve(petsam.wheel.Position(), laod=1), "^Axle.solve: .* 'laod': is load meant.* position"),
    (lambda axle: axle.rigid(petsam.wheel.Position(), overlaps="1"), "^Axle.rigid: overlaps '1': expected 2 numbers"),
    (lambda axle: type(axle).solve(1, 2, 3), "^Axle.solve: self 1: expected an Axle of petsam$"),
    (lambda axle: axle.close(3), "^Axle.close: takes 1 positional argument but 2 were given; its arguments are none$"),
    (lambda axle: petsam.conduction.Body(2.0).resistivity(), r"^Body.resistivity: missing .* 'k': give k \(Wave"),
    (lambda axle: petsam.loads.Forces.nodes(3), "^Forces.nodes: self 3: expected a Forces of petsam$"),
    (lambda axle: petsam.surface.Map.write("a.h5"), r"^Map.write: missing .* 'path': give path \(Name of the file\)$"),
    (lambda axle: petsam.surface.Map.write(), "^Map.write: missing .*: call it as a method of an object$"),
    (lambda axle: petsam.compliance.of_deck("a.inp"), r"^of_deck: missing 2 .*: give patch \(Full .*, contact \("),
    (lambda axle: petsam.cycles.find(), r"^find: missing .* 'results': give results \(The results of a run\)$"),
    (lambda axle: petsam.materials.find(nmae="steel"), "^find: got an unexpected keyword .* 'nmae': is name meant"),
    (lambda axle: petsam.fit.ball(1, 2, {}, raduis=3), "^ball: got an unexpected keyword .* 'raduis': is radius meant"),
)  # fmt: skip


@pytest.mark.parametrize("call, says", CALLS)
def test_calls_that_cannot_be_are_named_with_their_arguments(call, says):
    axle = object.__new__(petsam.wheel.Axle)
    with pytest.raises(petsam.Error, match=says) as caught:
        call(axle)
    assert isinstance(caught.value, TypeError) and caught.value.code == 2


def test_methods_of_what_functions_return_check_their_arguments(tmp_path):
    """Of results that are opened, and of a class that is reached by a function alone; named by the object's class."""
    with (
        petsam.run(**{**SPHERE, "grid_n": 32}, output=tmp_path / "run.h5") as results,
        petsam.open(tmp_path / "run.h5") as opened,
    ):
        for one in (results, opened):
            with pytest.raises(
                petsam.Error, match=r"^Results.series: missing .* 'name': give name \(Its name in /history"
            ):
                one.series()
            with pytest.raises(petsam.Error, match="^Results.about: name 3: expected a text"):
                one.about(3)
    with pytest.raises(petsam.Error, match="^Profile.turned: .*its arguments are"):
        petsam.wheel.s1002().turned(1, 2, 3, 4, 5, 6, 7)


def test_what_is_a_number_is_taken():
    for value in (1e5, 100000, np.float32(1e5), np.array(1e5), True):
        assert petsam.wheel.Load(value).vertical == value
    with pytest.raises(TypeError, match="missing 1 required positional argument: 'vertical'"):
        petsam.wheel.Load()


def test_warnings_name_the_line_of_the_call():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        petsam.wheel.Position(yaw=0.5)
    assert [one.filename for one in caught] == [__file__]


def test_creep_forces_name_what_is_no_number():
    table = object.__new__(petsam.wheel.CreepTable)
    with pytest.raises(petsam.Error, match="creep forces: 'a': expected a number or an array"):
        table._forces(82e9, 0.28, "a", 0.3, 1e-3)
    with pytest.raises(petsam.Error, match=r"shapes \(2,\), \(3,\): give numbers, or arrays of one shape"):
        table._forces(82e9, 0.28, np.ones(2), 0.3, np.ones(3))


def test_no_two_errors_have_the_same_name():
    paths = Path(petsam.__file__).parent.rglob("*.py")
    classes = [node for path in paths for node in ast.walk(ast.parse(path.read_text("utf-8")))
               if isinstance(node, ast.ClassDef)]  # fmt: skip
    errors, found = (
        {name for name, one in vars(builtins).items() if inspect.isclass(one) and issubclass(one, Exception)},
        [],
    )
    while len(found) < len(
        found := [one for one in classes if {getattr(base, "id", "") for base in one.bases} & errors]
    ):
        errors |= {one.name for one in found}
    assert len(found) > 30 and not [name for name, n in Counter(one.name for one in found).items() if n > 1]


def test_repr_of_results_is_short():
    record = petsam.fit.Record("a.csv", np.linspace(0.0, 1e-5, 300), np.arange(300.0), notes=["a"] * 9)
    assert repr(record).replace("\n    ", " ") == (
        "Record(path='a.csv', displacement=<300: 0 to 1e-05>, force=<300: 0 to 299>, time=None, cycle=None, "
        "energy=None, peaks=False, notes=<9 values>)"
    )
    for one in (petsam.wheel.s1002(), petsam.wheel.Wheelset(petsam.wheel.s1002(), 0.46), record):
        assert len(repr(one)) < 300 and max(map(len, repr(one).splitlines())) <= 110
    assert shown(np.array([1.0, np.nan])) == "[1, nan]" and shown(np.full((2, 3), np.nan)) == "<2 x 3 float64>"
    assert shown({"a": np.zeros(9), "b": 2}) == "{a, b}" and shown((1.5,)) == "(1.5,)" and shown([]) == "[]"


def test_every_result_with_arrays_has_a_short_repr():
    """A dataclass with arrays has the repr() of brief(), or one of its own."""
    for one, name in CALLED:
        fields = getattr(one, "__dataclass_fields__", {}) if inspect.isclass(one) else {}
        if any(re.search("ndarray|ArrayLike", str(field.type)) for field in fields.values()):
            assert not hasattr(one.__repr__, "__wrapped__"), f"{name} prints whole arrays: put @brief above @dataclass"
    assert brief(type("One", (), {})).__repr__
