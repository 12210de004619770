"""Errors of steps that are given one by one, by companion runs in process: those of the program; tries; states."""

import ast
import subprocess
import sys
import warnings

import h5py
import numpy as np
import pytest

import petsam as package
from conftest import PROGRAM, environment
from support import ROOT, SPHERE, history

COLUMNS = ("load_n", "load_tx", "load_ty")
ROWS = [(700, 0, 0), (900, 60, 0), (900, -40, 30), (650, -45, -20)]
ALIKE = {**{name: value for name, value in SPHERE.items() if not name.startswith("load")}, "friction": 0.1,
         "step_divide": "no"}  # fmt: skip  # single steps are not divided
UNLIKE = {"body2_young": 70e9, "friction": 0.3}
PLANE = {"elasticity": "plane", "gap_radius1": None, "gap_radius2": None, "gap_type": "ellipsoid",
         "gap_radius_x": 0.1, "gap_radius_y": "inf", "grid_n": 100}  # fmt: skip
CASES = {
    "alike": (dict(grid_n="65,41", grid_size="2.6e-3,2.5e-3"), 1),
    "unlike": (dict(grid_n=32, **UNLIKE), 1),
    "plane": (PLANE, 100),
    "wears": (dict(grid_n=64, wear_coefficient1=1e-12), 1),
}


def contact_of(changes, **more):
    """A contact with companion runs."""
    options = {**ALIKE, **changes, **more}
    return package.Contact(**{k: v for k, v in options.items() if v is not None}, errors=True)


@pytest.fixture(autouse=True)
def quiet(tmp_path, monkeypatch):
    """Tests run in their folder; advice is another test's."""
    monkeypatch.chdir(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def steps_of(factor):
    """What try_step() takes, of the rows."""
    return [dict(zip(COLUMNS, np.multiply(factor, row).tolist())) for row in ROWS]


@pytest.mark.parametrize("name", CASES)
def test_errors_are_those_of_the_program_also_after_tries(petsam, tmp_path, name):
    changes, factor = CASES[name]
    rows = [(k + 1, *np.multiply(factor, row).tolist()) for k, row in enumerate(ROWS)]
    loads = history(tmp_path / "h.csv", ",".join(("time", *COLUMNS)), *rows)
    case = {k: v for k, v in ALIKE.items() if changes.get(k, v) is not None}
    given = {k: v for k, v in changes.items() if v is not None}
    petsam(case, given, loads, "-errors", "companion", "-output", "h.h5")
    with h5py.File("h.h5") as f:
        expected = {k.removesuffix("_error"): v[:] for k, v in f["history"].items() if k.endswith("_error")}
        numbers = {k: f[f"history/{k}"][:] for k in expected if k in f["history"]}
    with contact_of(changes) as contact:
        for k, step in enumerate(steps_of(factor)):
            contact.try_step(load_n=factor * 300, load_tx=factor * 10)
            contact.try_step(load_n=factor * 800)
            if k % 2:
                contact.reject()
            found = contact.try_step(time=k + 1, **step)
            contact.commit()
            assert set(found.errors) == set(numbers)
            for number, values in numbers.items():
                scale = 1e-7 * np.abs(values).max()  # some are 0 by symmetry, but for rounding
                assert found.errors[number] == pytest.approx(expected[number][k], rel=1e-3, abs=scale, nan_ok=True), (
                    k,
                    number,
                )
    assert expected["slip_max"][1:].all() and expected["dissipated_energy"][1:].all()


def test_a_history_and_single_steps_continue_each_other():
    first, second, third, fourth = steps_of(1)
    with contact_of(dict(grid_n=48)) as one, contact_of(dict(grid_n=48)) as other:
        for contact in (one, other):
            contact.try_step(**first)
            contact.commit()
        for time, steps in enumerate(((second, third), (first, second))):  # two histories, one after the other
            together = {name: [step[name] for step in steps] for name in COLUMNS}
            by_history = other.run(dict(together, time=[1 + 2 * time, 2 + 2 * time]))
            for step, found in zip(steps, by_history, strict=True):
                by_one = one.try_step(**step)
                one.commit()
                assert found.errors == pytest.approx(by_one.errors, rel=2e-2, abs=1e-15, nan_ok=True)
        ends = [contact.try_step(**fourth).errors for contact in (one, other)]
        assert ends[0] == pytest.approx(ends[1], rel=1e-9, abs=1e-15) and ends[0]["slip_max"] > 0


def test_states_go_along_with_copies_and_files(tmp_path):
    """They replace those of a contact that is lost, or has a tried step, and are those of the committed step."""
    first, second, third, fourth = steps_of(1)
    with contact_of(dict(grid_n=48)) as one, contact_of(dict(grid_n=48)) as other:
        for step in (first, second):
            one.try_step(**step)
            one.commit()
        one.save("state.h5")
        with one.copy() as copied:
            found = copied.try_step(**third).errors
        expected = one.try_step(**third).errors
        assert found == expected and expected["slip_max"] > 0 and expected["dissipated_energy"] > 0
        one.save("tried.h5")
        one.commit()
        last = one.try_step(**fourth).errors
        other.try_step(load_n=2000, load_tx=100)
        other.load("tried.h5")
        assert np.isnan(other.try_step(**third).errors["slip_max"])
        other.load("state.h5")
        assert other.try_step(**third).errors == expected
        other.commit()
        assert other.try_step(**fourth).errors == last


def test_a_companion_that_has_ended_is_kept_with_the_others(tmp_path):
    """On a quarter of the cells the contact is at the edge of this grid: the errors are those by the others."""
    narrow = dict(grid_n=32, grid_size=2.5e-3, **UNLIKE)
    loads = [dict(load_n=1000), dict(load_n=1000, load_tx=150), dict(load_n=900, load_tx=-120)]
    with contact_of(narrow) as one, contact_of(narrow) as other:
        for step in loads[:2]:
            one.try_step(**step)
            one.commit()
        one.save("state.h5")
        expected = one.try_step(**loads[2]).errors
        other.load("state.h5")
        other.save("again.h5")
        other.reset()
        other.load("again.h5")
        assert other.try_step(**loads[2]).errors == expected
        assert expected["shear_max"] > 0 and expected["dissipated_energy"] > 0


def test_states_from_elsewhere(tmp_path):
    """A file and another contact without companions have none; a reset needs none."""
    first, second, third, _ = steps_of(1)
    plain = {**ALIKE, "grid_n": 48}
    with package.Contact(**plain) as one, contact_of(dict(grid_n=48)) as other:
        other.try_step(**first)
        other.reject()
        found = other.try_step(**first).errors
        for step in (first, second):
            one.try_step(**step)
            one.commit()
        one.save("state.h5")
        other.load("state.h5")
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            unknown = other.try_step(**third).errors
        assert any("errors are unknown: the state is that of a file" in str(one.message) for one in said)
        assert np.isnan(unknown["slip_max"]) and np.isnan(unknown["contact_area"]) and unknown["load_n"] == 0
        other.commit()
        assert np.isnan(other.try_step(**first).errors["slip_max"])
        other.reset()
        assert other.try_step(**first).errors == pytest.approx(found, rel=1e-12, abs=0)
        with package.Contact(**plain) as without:
            without.try_step(**first)
            without.commit()
            other.take(without)
            assert np.isnan(other.try_step(**second).errors["slip_max"]) and not without.try_step(**second).errors


def test_errors_do_not_depend_on_rejected_tries():
    """Nor on larger loads, or others, in them."""
    case = dict(grid_n=32, friction=0.6, bulk2_stress_xx=5e7)
    with contact_of(case) as one, contact_of(case) as other:
        for load in (1000, 600):
            expected = one.try_step(load_n=load, load_tx=20).errors
            other.try_step(load_n=3 * load, load_tx=200, load_mz=0.01)
            other.reject()
            other.try_step(load_n=2 * load)
            found = other.try_step(load_n=load, load_tx=20).errors
            for name in ("dissipated_energy", "slip_max", "contact_area", "shear_max", "disp_z", "disp_x"):
                assert found[name] == pytest.approx(expected[name], rel=1e-6, abs=0, nan_ok=True), name
            one.commit()
            other.commit()


def test_given_fields_become_means_on_the_companions():
    """Heights of a paraboloid as a field: its means over cells differ from its values by a constant."""
    first, second, *_ = steps_of(1)
    flat = dict(grid_n=48, gap_type="flat", gap_radius1=None, gap_radius2=None, friction=0.35)
    with contact_of(dict(grid_n=48)) as one, contact_of(flat) as other:
        x, y = np.meshgrid(other.x, other.y)
        radius = 1 / (1 / float(ALIKE["gap_radius1"]) + 1 / float(ALIKE["gap_radius2"]))
        other.gap = (x**2 + y**2) / (2 * radius)
        other.friction = np.full((48, 48), 0.1)
        for step in (first, second):
            pair = [contact.try_step(**step) for contact in (one, other)]
            for contact in (one, other):
                contact.commit()
        for name in ("slip_max", "shear_max", "contact_area", "dissipated_energy"):
            assert pair[1].errors[name] == pytest.approx(pair[0].errors[name], rel=1e-3), name
            assert 0 < pair[1].errors[name] < 0.1 * pair[1].numbers[name]
        other.friction = np.full((48, 48), 0.2)
        assert other.try_step(**second).errors["slip_max"] != pair[1].errors["slip_max"]


def test_advice_by_companions_and_none():
    """A dissimilar pair in one step: the energy is told by the companions, or nothing is; a step that they cannot solve
    has no errors."""
    told = {}
    for errors in (True, False, "none"):
        with package.Contact(**{**ALIKE, **UNLIKE, "grid_n": 32}, errors=errors) as contact:
            contact.try_step(load_n=500)
            contact.commit()
            with warnings.catch_warnings(record=True) as said:
                warnings.simplefilter("always")
                step = contact.try_step(load_n=1000, load_tx=100)
            told[errors] = [str(one.message) for one in said]
            assert bool(step.errors) == (errors is True)
    assert not told["none"] and told[True] and told[False]
    assert any(line.startswith("error by the steps: dissipated_energy") for line in told[True])
    with contact_of(dict(grid_n=6, friction=None)) as contact, warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        step = contact.try_step(load_n=1000, load_my=0.15)
    assert any("errors by the cells are unknown: on half the cells" in str(one.message) for one in said), [
        str(one.message) for one in said
    ]
    assert np.isnan(step.errors["contact_area"])


RANKS = """
import petsam, warnings

class World:
    def py2f(self):
        return 0

warnings.simplefilter("ignore")
with petsam.Contact(comm=World(), errors=True, **{case!r}) as contact:
    for step in {steps!r}:
        found = contact.try_step(**step)
        contact.commit()
    if contact.first_row == 0:
        open("errors.txt", "w").write(repr(found.errors))
"""


@pytest.mark.parametrize("ranks", [2, 3])
def test_errors_do_not_depend_on_the_ranks(launcher, tmp_path, ranks):
    case = {k: v for k, v in ALIKE.items() if v is not None} | dict(grid_n=(21, 17))
    (tmp_path / "program.py").write_text(RANKS.format(case=case, steps=steps_of(1)))
    library = str(PROGRAM.parents[1] / "lib/libpetsam.so")
    env = dict(environment(), PYTHONPATH=str(ROOT / "scripts"), PETSAM_LIBRARY=library)
    found = []
    for words in (launcher + ["-n", str(ranks)], []):
        subprocess.run([*words, sys.executable, "program.py"], env=env, check=True, timeout=100)
        found.append(ast.literal_eval((tmp_path / "errors.txt").read_text()))
    assert found[0] == pytest.approx(found[1], rel=1e-9, abs=1e-18) and found[0]["slip_max"] > 0
