"""How far a work is, in the lines of all commands, and inputs that are judged before the work begins."""

import re
import sys
import time

import numpy as np
import pytest

import petsam
from petsam import joint
from petsam.apps.joint.pair import contents
from petsam.apps.launch import code_of
from petsam.core import progress
from petsam.core.progress import Progress, clock
from test_backbone import OPTIONS, PRELOAD, pair_file
from test_compliance_command import block, compliance  # noqa: F401  (fixtures)

LEFT = r", about \d:\d\d left"
AT_ONCE = 10.0  # seconds, also on a busy machine
PAIR = ("pair.h5", "--contact", "c.opts", "--preload", "B=0.02", "--sensor", "TIP:z")
STRUCTURE = {
    "backbone": ("--amplitudes", "3mm"),
    "band": ("--amplitudes", "3mm"),
    "wear": ("--amplitudes", "3mm", "--cycles", "10"),
    "response": ("--force", "TIP:z=1e-4", "--frequencies", "0.1"),
}


@pytest.mark.parametrize("seconds, text", [(0.4, "0:00"), (93.2, "1:33"), (3599.6, "1:00:00"), (7325.0, "2:02:05")])
def test_times_are_those_of_a_clock(seconds, text):
    assert clock(seconds) == text


def test_units_estimate_the_time_left(monkeypatch):
    """The others take as long as those that are done; a part begins anew."""
    now, lines = [100.0], []
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    told = Progress("window", lines.append)
    for k in range(1, 4):
        now[0] += 31.0
        told(k, 3)
    assert lines == ["window 1 of 3, about 1:02 left", "window 2 of 3, about 0:31 left", "window 3 of 3"]
    told.estimate(93.0)
    told.begin("fields", "fields on {} of {} faces")
    now[0] += 2.0
    told(20, 50, "top")
    assert lines[3:] == ["about 1:33 left", "fields", "fields on 20 of 50 faces: top, about 0:03 left"]


def test_short_works_have_no_lines(monkeypatch):
    now, lines = [0.0], []
    monkeypatch.setattr(progress.time, "monotonic", lambda: now[0])
    told = Progress("part", lines.append, every=5.0)
    for k in range(1, 13):
        now[0] += 1.0
        told(k, 12)
    assert lines == ["part 5 of 12, about 0:07 left", "part 10 of 12, about 0:02 left"]


# ---------------------------------------------------------------- lines of the commands


def lines_of(command, monkeypatch, *words):
    """Lines of progress of petsam-joint."""
    lines = []
    from petsam.apps.joint import vibrations

    monkeypatch.setattr(vibrations, "Progress", lambda what: Progress(what, lines.append))
    command(*words)
    return lines


@pytest.fixture
def pair(tmp_path):
    """A pair and its contact's options, in files."""
    pair_file(tmp_path / "pair.h5", 1.0)
    small = OPTIONS | dict(grid_n=16)
    (tmp_path / "c.opts").write_text("".join(f"-{name} {value}\n" for name, value in small.items()))
    return tmp_path


@pytest.mark.filterwarnings("ignore::petsam.apps.joint.BackboneWarning", "ignore::petsam.AdviceWarning")
def test_amplitudes_and_assemblies_are_counted(pair, joint_command, monkeypatch):
    words = (*PAIR, "--steps", 1, "--amplitudes")
    lines = lines_of(joint_command, monkeypatch, "backbone", *words, "1mm,2mm")
    assert re.fullmatch(f"amplitude 1 of 2{LEFT}\namplitude 2 of 2", "\n".join(lines))
    lines = lines_of(joint_command, monkeypatch, "band", *words, "1mm", "--scatter", "friction=0.1")
    assert re.fullmatch(f"assembly 1 of 5: as given{LEFT}", lines[0]) and lines[4] == "assembly 5 of 5: friction higher"
    assert len(lines) == 5


@pytest.mark.filterwarnings("ignore::petsam.apps.joint.BackboneWarning", "ignore::petsam.AdviceWarning")
def test_vibrations_of_wear_are_counted():
    """Two spans of cycles, in two parts each and in one, and the vibrations at the end."""
    steel = {f"body{k}_{name}": value for k in "12" for name, value in (("young", 2e11), ("poisson", 0.3))}
    more = dict(grid_n=16, grid_size=2e-3, gap_type="sphere", gap_radius1=0.1, gap_radius2=0.1, friction=0.3)
    contact = petsam.Contact(**steel, **more, wear_coefficient1=1e-15)
    contact.try_step(load_n=100.0)
    contact.commit()
    patch = joint.Patch(contact, ["disp_x"], dict(load_n=100.0), by_load=["disp_x"])
    told = []
    structure = joint.Structure([patch], rigid=[[1.0]])
    joint.wear(structure, 1e-7, [2, 4], steps=2, report=lambda k, count: told.append((k, count)))
    assert told == [(k, 8) for k in range(1, 9)]


def test_a_compliance_has_lines_of_its_parts(block, compliance):  # noqa: F811
    lines = []
    petsam.compliance.of_deck(block[1], 2.0, "TOP", "BOTTOM", progress=lines.append, degree=1)
    assert lines[:3] == ["stiffness", "factorization", "half-space fields"] and lines[-1] == "stresses"
    faces = [re.fullmatch(rf"half-space fields on (\d+) of (\d+) faces({LEFT})?", one) for one in lines]
    last = [one for one in faces if one][-1]
    assert last[1] == last[2] and not last[3] and re.fullmatch(r"\d+ solutions", lines[-3])
    assert lines[-2] == "the error by the mesh"


# ---------------------------------------------------------------- before the work


class Begun(Exception):
    """A work that was not to begin."""


@pytest.fixture
def unbegun(monkeypatch):
    """unbegun(module, name, ...): calls of these begin the work."""

    def fails(*_, **__):
        raise Begun("the work has begun")

    def watch(*places):
        for module, name in places:
            monkeypatch.setattr(module, name, fails)

    return watch


@pytest.fixture
def ends(tmp_path, monkeypatch, capsys):
    """ends(command, *words, code=3): the one line with which a command ends at once."""
    monkeypatch.chdir(tmp_path)

    def run(command, *words, code=3):
        program = "petsam-" + command.__name__.split(".")[2]
        monkeypatch.setattr(sys, "argv", [program, *map(str, words)])
        start = time.monotonic()
        try:
            found = code_of(program)
        except SystemExit as end:  # of the parser
            found = end.code
        said = capsys.readouterr().err
        assert found == code and len(said.splitlines()) == 1 and time.monotonic() - start < AT_ONCE, said
        return said

    return run


@pytest.mark.parametrize("action", STRUCTURE)
def test_joint_judges_its_output_first(action, pair, ends, unbegun):
    from petsam.apps.joint import command, vibrations

    unbegun((vibrations, "Pair"), (vibrations, "contents"))
    said = ends(command, action, *PAIR, *STRUCTURE[action], "-o", "none/out")
    assert "none/out.csv: cannot be written: its folder" in said and "does not exist" in said


def test_stiffness_judges_its_output_first(tmp_path, ends, unbegun):
    from petsam.apps.joint import command, stiffnesses

    unbegun((stiffnesses, "interface"))
    words = ("stiffness", "scan.h5", "--pressure", "1MPa", "--friction", 0.3, "--body1", "steel", "--body2", "steel")
    assert "none/out.csv: cannot be written" in ends(command, *words, "-o", "none/out")


def test_compliance_judges_its_output_first(ends, unbegun):
    from petsam.apps.compliance import command

    unbegun((command.model, "computed"))
    words = ("--mesh", "block.inp", "--contact", "TOP", "--fixed", "BOTTOM", "--patch", "2mm")
    assert "none/out.h5: cannot be written" in ends(command, *words, "-o", "none/out.h5")
    assert "none/p.png: cannot be written" in ends(command, *words, "--picture", "none/p.png")


def test_fatigue_judges_its_output_first(ends, unbegun):
    from petsam.apps.fatigue import command

    unbegun((command, "Stresses"), (command.spectrum, "lives"))
    for words in (("-o", "none/out.png"), ("--csv", "none/out.csv")):
        assert f"{words[1]}: cannot be written" in ends(command, "fatigue.h5", *words)


def test_study_judges_its_folder_first(tmp_path, ends, unbegun):
    from petsam.apps.study import command

    unbegun((command, "Study"))
    (tmp_path / "cases.csv").write_text("friction\n0.1\n")
    (tmp_path / "file").write_text("")
    assert "file: is not a folder" in ends(command, "cases.csv", "-d", "file")
    assert "file" in ends(command, "cases.csv", "-d", "file/none")


@pytest.mark.parametrize("action", STRUCTURE)
def test_joint_judges_sensors_and_bolts_before_any_is_tightened(action, pair, ends, unbegun):
    from petsam.apps.joint import command, vibrations

    unbegun((vibrations, "Pair"))
    given = STRUCTURE[action]
    assert "--sensor TOP:z: expected NAME:x" in ends(command, action, *PAIR[:-1], "TOP:z", *given, code=2)
    assert "preload C: is no bolt" in ends(command, action, *PAIR[:4], "C=1", *PAIR[5:], *given, code=2)
    if action == "response":
        wrong = ("--force", "TOP:z=1", *given[2:])
        assert "--force TOP:z: expected NAME:x" in ends(command, action, *PAIR[:-2], *wrong, code=2)
    else:
        assert "mode 9: the structure has modes 1 to 2" in ends(command, action, *PAIR, *given, "--mode", 9, code=2)
    if action in ("backbone", "band", "response"):
        more = ("--harmonics", 9, "--steps", 4)
        assert "steps 4: with 9 harmonics use 18" in ends(command, action, *PAIR, *given, *more, code=2)


def test_the_contents_of_a_pair_need_no_contact(pair):
    found = contents(pair / "pair.h5", PRELOAD)
    assert found.bolts == ["B"] and found.omega.tolist() == [0.5, 2.0] and list(found.sensors) == ["TIP"]
    assert not hasattr(found, "structure")


def test_steps_of_load_cases_are_judged_before_the_work(block, compliance, monkeypatch):  # noqa: F811
    monkeypatch.setattr(petsam.compliance.model, "remainder", None)  # a call of it would be another error
    assert "step 7" in compliance(*block, "--case", "pull=7", check=3)[0].lower()


def test_lives_are_judged_before_the_work(monkeypatch):
    """A quantity of the line and a constant that are missing."""

    monkeypatch.setattr(petsam.fatigue.evaluation, "lives", None)
    grid = dict(x=np.zeros(1), y=np.zeros(1), z=np.arange(3.0))
    cycle = petsam.fatigue.stresses.Cycle({**grid, "time": np.zeros(1), "swt": np.ones((1, 3, 1, 1))})
    with pytest.raises(petsam.Error, match="has no mises"):
        petsam.fatigue.lives(cycle, {}, quantities="mises")
    with pytest.raises(petsam.Error, match="swt: .*sigma_f"):
        petsam.fatigue.lives(cycle, dict(young=2e11), criteria="swt")


def test_options_that_contradict_each_other_are_refused(ends):
    from petsam.apps.compliance import command as bodies
    from petsam.apps.fatigue import command as fatigue
    from petsam.apps.joint import command as joints

    words = ("stiffness", "scan.h5", "--pressure", "1MPa", "--friction", 0.3, "--body1", "steel", "--body2", "steel")
    assert "--area: is for NAME.json" in ends(joints, *words, "--area", "2mm2", code=2)
    given = ("--mesh", "a.inp", "--contact", "TOP", "--fixed", "B", "--patch", "2mm", "--no-picture")
    assert "--no-picture draws none" in ends(bodies, *given, "--picture", "p.png", code=2)
    assert "--no-picture draws none" in ends(fatigue, "f.h5", "-o", "p.png", "--no-picture", code=2)
