"""The reference collection: its files agree, the checker finds what is wrong, and petsam has the numbers."""

import importlib
import json
import re
import subprocess
import sys

import numpy as np
import pytest

import support
from support import few

FOLDER = support.ROOT / "examples" / "reference"
ROWS = json.loads((FOLDER / "cases.json").read_text())
CASES = list(dict.fromkeys(row["case"] for row in ROWS))
sys.path[:0] = [str(FOLDER), str(FOLDER / "cases")]
# cases whose evidence takes seconds; some of the others need minutes
CLOSED = ["hertz-sphere", "hertz-ellipse", "cattaneo-mindlin", "lubkin", "carter", "inclined-punch", "westergaard"]
# cases that petsam solves in less than a second
QUICK = [*CLOSED, "turning-force", "pad-bulk-stress", "rolling-spin", "coated-sphere", "sliding-stress", "mccoll"]


def middle(row):
    return (row["low"] + row["high"]) / 2


def size(row):
    return row.get("size") or max(abs(row["low"]), abs(row["high"]))


def check(path, answers, *words, code=0):
    """Runs the checker on answers, or on a text; its output."""
    path.write_text(answers if isinstance(answers, str) else json.dumps({"answers": answers}))
    run = subprocess.run(
        [sys.executable, FOLDER / "check.py", path, *words], capture_output=True, text=True, timeout=60, check=False
    )
    assert run.returncode == code, run.stdout + run.stderr
    assert "Traceback" not in run.stderr
    return run.stdout + run.stderr


def right():
    answers = {}
    for row in ROWS:
        answers.setdefault(row["case"], {})[row["quantity"]] = middle(row)
    return answers


def test_there_are_24_cases_with_their_files():
    names = re.search(r"NAMES = \((.*?)\)", (FOLDER / "reference.py").read_text(), re.S)[1]
    assert re.findall(r'"(.*?)"', names) == CASES and len(CASES) == 24
    for name in CASES:
        text = (FOLDER / "cases" / f"{name}.md").read_text()
        title = re.match(r"# (.*)\n", text)[1]
        assert f"![{title}]({name}.png)" in text and (FOLDER / "cases" / f"{name}.png").stat().st_size < 30e3
        for head in "## Given", "## Required", "## Known by":
            assert head in text
    links = (FOLDER / "README.md").read_text()
    assert all(f"cases/{name}.md" in links for name in CASES)


@pytest.mark.parametrize("name", CASES)
def test_page_has_the_intervals(name):
    table = dict(re.findall(r"^\| `(\w+)` \| ([^|]*) \|", (FOLDER / "cases" / f"{name}.md").read_text(), re.M))
    rows = [row for row in ROWS if row["case"] == name]
    assert list(table) == [row["quantity"] for row in rows]
    for row in rows:
        low, _, high, *unit = table[row["quantity"]].split()
        assert " ".join(unit) == row["unit"]
        assert float(low) == pytest.approx(row["low"], rel=1e-11, abs=0)
        assert float(high) == pytest.approx(row["high"], rel=1e-11, abs=0)
        assert row["low"] < row["high"] and row["how"]


@pytest.mark.parametrize("name", CLOSED)
def test_evidence_gives_the_intervals(name):
    from common import rounded

    found = [rounded(one) for one in importlib.import_module(name.replace("-", "_")).evidence()]
    rows = [row for row in ROWS if row["case"] == name]
    assert [one.quantity for one in found] == [row["quantity"] for row in rows]
    for one, row in zip(found, rows):
        assert one.low == pytest.approx(row["low"], rel=1e-9, abs=0)
        assert one.high == pytest.approx(row["high"], rel=1e-9, abs=0)


def test_right_answers_are_right(tmp_path):
    said = check(tmp_path / "answers.json", right())
    assert f"{len(ROWS)} answers of {len(ROWS)} quantities in 24 of 24 cases, 0 wrong" in said
    assert "WRONG" not in said


@pytest.mark.parametrize(
    "change, why",
    [
        (lambda value, _: value * -1, "its sign is opposite"),
        (lambda value, _: value * 2, "it is twice as large"),
        (lambda value, _: value / 2, "it is half as large"),
        (lambda value, scale: value + 0.01 * scale, "it differs by"),
        (lambda value, _: [value * 1.004, 1e-3 * abs(value)], "its stated error is"),
        (lambda value, _: float("nan"), "it is no finite number"),
    ],
)
@few("index", range(0, len(ROWS), 11), 4)
def test_a_wrong_answer_is_named(tmp_path, index, change, why):
    row, answers = ROWS[index], right()
    narrow = (row["high"] - row["low"]) / size(row) < 2e-3
    changed = change(middle(row), size(row))
    if not narrow and why in ("it differs by", "its stated error is"):
        pytest.skip("the interval is wider than the error")
    answers[row["case"]][row["quantity"]] = changed
    said = check(tmp_path / "answers.json", answers, code=1)
    assert re.search(rf"WRONG: {row['case']}: {row['quantity']}: .*{why}", said)
    assert said.count("WRONG") == 1 and said.rstrip().endswith("1 wrong")


@pytest.mark.parametrize(
    "text, words",
    [
        ("", "no JSON"),
        ("[]", '"answers"'),
        ('{"answers": 3}', '"answers"'),
        ('{"answers": {"hertz": {}}}', "there is no case 'hertz'"),
        ('{"answers": {"carter": {"force": 1}}}', "carter does not require 'force'"),
        ('{"answers": {"carter": 1}}', "carter: expected an object of quantities"),
        ('{"answers": {"carter": {"stick_width": "1"}}}', "stick_width: expected a number"),
        ('{"answers": {"carter": {"stick_width": [1, -1]}}}', "stated error is -1"),
        ('{"answers": {"carter": {"stick_width": true}}}', "expected a number"),
        ('{"answers": {"carter": {}}, "seconds": {"carter": "1"}}', '"seconds" is an object of numbers'),
        ('{"answers": {"carter": {}, "carter": {}}}', "stands twice"),
        ("[" * 100000, "no JSON"),
        ('{"answers": {"carter": {"stick_width": ' + "9" * 4000 + "}}}", "expected a number"),
        ('{"answers": {"carter": {"stick_width": ' + "9" * 9000 + "}}}", "no JSON"),
        ('{"answers": {}}', "has no answer"),
        ('{"answers": {"\\u001b[31m' + "x" * 100000 + '": {}}}', "there is no case '\\x1b"),
        ('{"answers": {"carter": {"stick_width": 1e-3}}, "seconds": {"carter": -1}}', "at least 0"),
        ('{"answers": {' + ", ".join(f'"a{k}": {{}}' for k in range(50000)) + "}}", "there is no case"),
    ],
)
def test_files_that_cannot_be_used_are_named(tmp_path, text, words):
    assert words in check(tmp_path / "answers.json", text, code=2)


@pytest.mark.parametrize("text", ["{}", "[1]", '[{"case": "a"}]', "3"])
def test_intervals_that_cannot_be_used_are_named(tmp_path, text):
    (tmp_path / "cases.json").write_text(text)
    assert "cases.json: " in check(tmp_path / "answers.json", right(), "--cases", tmp_path / "cases.json", code=2)


def test_output_that_nobody_reads_is_no_answer(tmp_path):
    (tmp_path / "answers.json").write_text(json.dumps({"answers": right(), "program": "\ud800"}))
    with open("/dev/full", "w") as full:
        run = subprocess.run(
            [sys.executable, FOLDER / "check.py", tmp_path / "answers.json"], stdout=full, stderr=-1, text=True
        )
    assert run.returncode == 2 and run.stderr == "check.py: No space left on device\n"


def test_units_are_told(tmp_path):
    answers = right()
    answers["sliding-stress"]["mises_deep"] *= 1e-6
    answers["hertz-ellipse"]["axis_angle"] *= 3.14159265 / 180
    said = check(tmp_path / "answers.json", answers, code=1)
    assert "it is 1e-6 times as large: check the unit" in said and "it is in radians" in said


def test_a_file_that_is_missing_is_named(tmp_path):
    run = subprocess.run([sys.executable, FOLDER / "check.py", tmp_path / "no.json"], capture_output=True, text=True)
    assert run.returncode == 2 and "no.json: No such file" in run.stderr


def has_the_numbers(tmp_path, names):
    """Answers by usual settings; digits are those of the README."""
    words = ["answers", *names, "-o", tmp_path / "answers.json"]
    subprocess.run([sys.executable, "-W", "ignore", FOLDER / "reference.py", *words], check=True, timeout=600)
    said = check(tmp_path / "answers.json", (tmp_path / "answers.json").read_text())
    count = sum(row["case"] in names for row in ROWS)
    assert f"{count} answers of {len(ROWS)} quantities in {len(names)} of 24 cases, 0 wrong" in said


def test_petsam_has_the_numbers_of_the_quick_cases(tmp_path):
    has_the_numbers(tmp_path, QUICK)


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in CASES if name not in QUICK])
def test_petsam_has_the_numbers(tmp_path, name):
    has_the_numbers(tmp_path, [name])


# ---------------------------------------------------------------- the table of creep forces


@pytest.fixture(scope="module")
def creep():
    return importlib.import_module("creep")


def test_creep_table_has_all_cases_and_narrow_intervals(creep):
    table = creep.read()
    ratios, count = np.unique(table["ratio"], return_counts=True)
    assert len(ratios) == 10 and set(count) == {204}
    for name in creep.FORCES:
        width = table[name + "_high"] - table[name + "_low"]
        assert 0 < width.min() and width.max() < 0.015 and np.median(width) < 1e-3
        assert name == "mz" or np.all(np.abs(table[name + "_low"]) < 1.001)
    assert (FOLDER / "creep.csv").stat().st_size < 200e3 and len((FOLDER / "creep.py").read_text().splitlines()) <= 40


def forces_of(solve, ratio, xi, eta, phi, cells=96):
    """The extrapolated fx, fy, mz of petsam, with another friction than that of the table."""
    table = importlib.import_module("creep_table")
    half, options = table.contact(ratio)
    limit = 0.5 * options["load_n"]
    creepages = dict(zip(("creep_x", "creep_y", "creep_spin"), table.motion(limit, xi, eta, phi)))
    case = dict(support.bodies(table.YOUNG, 0.25), **options, **creepages, friction=0.5, gap_type="ellipsoid",
                rolling="steady", grid_n=cells, grid_size=(2.4 * half[0], 2.4 * half[1]))  # fmt: skip
    found = solve(case)
    return table.relative(limit, [found[f"load_{name}_extrapolated"] for name in ("tx", "ty", "mz")])


@pytest.mark.parametrize(
    "case", [(1, -0.25, 0.1, 0.5), (0.35, 0.1, -0.6, -1.2), (3.5, 0.6, -0.25, 0.0), (0.1, 0.0, 0.25, 3.0)]
)
def test_creep_table_contains_what_petsam_finds_for_any_signs(solve, creep, case):
    low, high = creep.find(creep.read(), *case)
    found = forces_of(solve, *case)
    assert np.all(found > low - 2e-3) and np.all(found < high + 2e-3)


def test_creep_table_names_wrong_forces(creep, tmp_path):
    table = creep.read()[::7]
    middles = [(table[n + "_low"] + table[n + "_high"]) / 2 for n in creep.FORCES]
    middles[1] = middles[1] * 1.01  # one force is 1 % off
    rows = np.transpose([*(table[name] for name in creep.INPUTS), *middles])
    head = "ratio,xi,eta,phi,fx,fy,mz"
    np.savetxt(tmp_path / "f.csv", rows, delimiter=",", header=head, comments="")
    run = subprocess.run(
        [sys.executable, FOLDER / "creep.py", tmp_path / "f.csv"],
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    cases, wrong, worst = re.match(r"(\d+) of \1 cases in the table, (\d+) .* by (\S+) at most", run.stdout).groups()
    assert int(cases) == len(table) and int(wrong) > len(table) / 3 and 0.002 < float(worst) < 0.01


def test_a_second_way_to_creep_forces_overlaps_the_table(creep, capsys):
    table = importlib.import_module("creep_table")
    assert table.second(3, 5, FOLDER / "creep.csv", (16, 32, 64)) == 0
    assert "9 of 9 intervals overlap" in capsys.readouterr().out
