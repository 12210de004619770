"""The program of random problems: its kinds, and what it prints, logs and ends with."""

import json
from types import SimpleNamespace

import pytest

import random_problems
from kinds import Outcome
from random_problems import KINDS, MODULES, main, module_of
from support import ROOT

SHARED = {"__init__", "contacts", "costs", "users"}


def test_kinds_are_the_modules():
    modules = {path.stem for path in (ROOT / "tests/program/kinds").glob("*.py")}
    assert modules - SHARED == set(KINDS) - set(MODULES)


def test_help_has_a_line_for_each_kind(capsys):
    with pytest.raises(SystemExit):
        main(["--help"])
    lines = [line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines()]
    assert all([kind, about] in lines for kind, about in KINDS.items())


@pytest.mark.parametrize("kind", KINDS)
def test_kind_has_a_trial_a_summary_and_options(kind, capsys):
    module = module_of(kind)
    assert module.trial and module.summary({}) is not None and module.OPTIONS["trials"] > 0
    with pytest.raises(SystemExit):
        main([kind, "--help"])
    shown = capsys.readouterr().out
    assert module.__doc__.strip() in shown and all(f"--{name} " in shown for name in module.OPTIONS)


def kind_of(outcomes):
    """A kind with these outcomes, by seed; an exception is raised."""

    def trial(seed, folder, given):
        assert folder.is_dir() and not list(folder.iterdir())
        outcome = outcomes[seed]
        if isinstance(outcome, Exception):
            raise outcome
        return outcome

    return SimpleNamespace(__doc__="", OPTIONS=dict(trials=2), trial=trial, summary=lambda found: [f"found {found}"])


@pytest.fixture
def run(monkeypatch, capsys):
    """run(outcomes, *words): the exit code and the lines."""

    def run(outcomes, *words):
        monkeypatch.setattr(random_problems, "module_of", lambda kind: kind_of(outcomes))
        return main(["decks", *words]), capsys.readouterr().out.splitlines()

    return run


RIGHT, WRONG = Outcome("right", False, dict(n=1)), Outcome("wrong", True, dict(n=2))


def test_faults_are_printed_and_the_end_is_1(run):
    lines = ["FAULT seed 4: wrong", "found {3: {'n': 1}, 4: {'n': 2}}", "decks: 2 trials, 1 with a fault [4]"]
    assert run({3: RIGHT, 4: WRONG}, "--seed", "3") == (1, lines)
    assert run({3: RIGHT, 4: WRONG}, "--seed", "3", "--show") == (1, ["seed 3: right", *lines])
    assert run({3: RIGHT}, "--seed", "3", "--trials", "1")[0] == 0


def test_kind_that_measures_has_no_faults(run):
    outcomes = {1: Outcome("far", None, {}, telling=True), 2: Outcome("near")}
    assert run(outcomes) == (0, ["seed 1: far", "found {}", "decks: 2 trials"])


def test_rejected_problem_is_tried_with_another_seed(run):
    assert run({1: None, 2: RIGHT, 3: None, 4: RIGHT})[1][-1] == "decks: 2 trials, 0 with a fault []"
    assert run({1: RIGHT, **dict.fromkeys(range(2, 41))})[1][-1] == "decks: 1 trials, 0 with a fault []"


def test_trial_that_breaks_off_is_a_fault(run):
    code, lines = run({1: AssertionError("exit code 5"), 2: RIGHT})
    assert code == 1 and "AssertionError: exit code 5" in lines
    assert lines[-1] == "decks: 2 trials, 1 with a fault [1]"


def test_log_has_a_line_of_json_for_each_trial(run, tmp_path):
    run({1: RIGHT, 2: WRONG}, "--log", str(tmp_path / "log"))
    logged = [json.loads(line) for line in (tmp_path / "log").read_text().splitlines()]
    assert logged == [
        dict(kind="decks", seed=1, fault=False, text="right", n=1),
        dict(kind="decks", seed=2, fault=True, text="wrong", n=2),
    ]
