"""petsam-study: tables, runs side by side, restarts, failures, results; Slurm's jobs with stand-ins for it."""

import csv
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import textwrap
import time

import h5py
import numpy as np
import pytest

import petsam
from conftest import PROGRAM as PETSAM
from conftest import environment
from petsam.apps.launch import code_of
from petsam.apps.study import cases as study_cases
from petsam.apps.study import runs as study_runs
from petsam.apps.study.slurm import ranges
from petsam.core.declared import PATHS
from support import ROOT, ball, limit, slide_limit, table_of, words

PROGRAM = ROOT / "scripts" / "petsam-study"
CASE = ball(n=32)
LIMIT = slide_limit(CASE)[0]
AT_ONCE = 60.0  # seconds on an idle machine: what it guards against takes hours


def executable(path, text):
    """A program of that text."""
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    path.chmod(0o755)
    return path


@pytest.fixture
def study(tmp_path):
    """study(*words): the process of petsam-study in tmp_path, not waited for; PETSAM is the built program."""

    def start(*arguments, **variables):
        env = {
            **environment(),
            "PYTHON": sys.executable,
            "PETSAM": str(PETSAM),
            **{k: str(v) for k, v in variables.items()},
        }
        return subprocess.Popen(
            [sys.executable, str(PROGRAM), *map(str, arguments)],
            cwd=tmp_path,
            env=env,
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            # tests that run in the background have it ignored
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )

    return start


@pytest.fixture
def run(study):
    """run(*words, check=0): the same, waited for."""

    def finish(*arguments, check=0, **variables):
        process = study(*arguments, **variables)
        out, err = process.communicate(timeout=240)
        assert process.returncode == check, (process.returncode, out, err)
        return out + err

    return finish


@pytest.fixture
def fake(tmp_path):
    """Variables of an mpirun and a petsam that take no time: `ranks case-folder arguments` of each run go to runs.txt.

    -wait SECONDS waits, -code N ends with N; -stoppable ends with 75 and a checkpoint on USR1.
    """
    mpirun = executable(
        tmp_path / "bin" / "mpirun", '#!/bin/sh\n[ "$1" = -n ] || exit 0\nRANKS=$2; export RANKS; shift 2; exec "$@"\n'
    )
    petsam = executable(
        tmp_path / "bin" / "petsam",
        r"""#!/bin/bash
echo "$RANKS ${PWD##*/} $*" >>../../runs.txt
code=0
trap 'kill $!' EXIT
trap 'exit 143' TERM
stop() { echo state >checkpoint.h5; exit 75; }
while [ $# -gt 0 ]; do
    case $1 in
    -stoppable) trap stop USR1 ;;
    -wait) wait=$2 ;;
    -code) code=$2 ;;
    esac
    shift
done
: >started
echo "$RANKS $$" >>../../started.txt
sleep "${wait:-0}" & wait
[ "$code" = 0 ] || echo "petsam: it is $code" >&2
exit "$code"
""",
    )
    return {"MPIRUN": mpirun, "PETSAM": petsam}


def table(tmp_path, text, name="cases.csv"):
    (tmp_path / name).write_text(text)
    return tmp_path / name


def until(condition, seconds=60):
    """Wait for what another process does."""
    end = time.monotonic() + limit(seconds)
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


def runs(tmp_path):
    """Words of every run of the fake petsam."""
    path = tmp_path / "runs.txt"
    return [line.split() for line in path.read_text().splitlines()] if path.exists() else []


# ---------------------------------------------------------------- tables


def test_csv_columns_are_options(tmp_path):
    path = table(tmp_path, '# comment\nload_tx, -grid_center, ranks, case\n\n10, "0,1e-4", 2, one\n20, , , two\n')
    one, two = study_cases.read(str(path), study_cases.common_options(["-grid_n", "64", "-allow_edge_contact"]), 3)
    assert one.words() == ["-load_tx", "10", "-grid_center", "0,1e-4", "-grid_n", "64", "-allow_edge_contact"]
    assert two.words() == ["-load_tx", "20", "-grid_n", "64", "-allow_edge_contact"]
    assert (one.name, one.ranks, two.name, two.ranks) == ("one", 2, "two", 3)


def test_columns_may_be_separated_by_semicolons(tmp_path):
    path = table(tmp_path, 'load_tx; -grid_center; case\n10; 0,1e-4; one\n20; "0;1"; two\n')
    one, two = study_cases.read(str(path))
    assert one.words() == ["-load_tx", "10", "-grid_center", "0,1e-4"] and (one.name, two.name) == ("one", "two")
    assert two.options["grid_center"] == "0;1"


def test_the_table_with_files_in_the_help_is_one(run, tmp_path):
    text = run("--help")
    example = text[text.index("  options: {history") : text.index("\nOptions after")]
    cases = study_cases.read(str(table(tmp_path, textwrap.dedent(example), "t.yaml")))
    assert [case.files["cycle.csv"].split()[-1] for case in cases] == ["80", "400"]
    assert cases[0].options["history"] == "cycle.csv"


def test_yaml_combines_all_lists_and_computes_expressions(tmp_path):
    path = table(
        tmp_path,
        "parameters:\n  ratio: [0.25, 0.5]\n  load: 1000\noptions:\n  friction: [0.1, 0.2]\n"
        '  load_tx: "{ratio * friction * load}"\n  load_n: "{load}"\n  coupling: none\n  allow_edge_contact: true\n'
        'files:\n  h.csv: "time,disp_z\\n1,{-sqrt(load_tx**2)}"\nranks: "{load / 500}"\n',
        "t.yaml",
    )
    cases = study_cases.read(str(path))
    assert [(case.options["load_tx"], case.files["h.csv"].split(",")[-1]) for case in cases] == [
        ("25", "-25"),
        ("50", "-50"),
        ("50", "-50"),
        ("100", "-100"),
    ]
    assert cases[3].name == "ratio=0.5_friction=0.2" and cases[3].ranks == 2
    assert cases[0].words() == [
        "-friction",
        "0.1",
        "-load_tx",
        "25",
        "-load_n",
        "1000",
        "-coupling",
        "none",
        "-allow_edge_contact",
        "true",
    ]


def test_steady_rolling_is_tabulated(run, tmp_path):
    """Its results have no energy of a step, and so no cycles."""
    (tmp_path / "t.csv").write_text("creep_x\n1e-4\n2e-4\n")
    run("t.csv", "--", *words(dict(CASE, rolling="steady")))
    with h5py.File(tmp_path / "t" / "results.h5") as file:
        assert np.all(np.diff(file["results/load_tx"][:]) > 0) and "dissipated_energy_sum" not in file["results"]


def test_options_for_all_cases_count_in_expressions(tmp_path):
    path = table(tmp_path, 'options:\n  friction: 0.1\n  load_tx: ["{friction * 100}", 1]\n', "t.yaml")
    first = study_cases.read(str(path), study_cases.common_options(["-friction", "0.3"]))[0]
    assert (first.options["friction"], first.options["load_tx"]) == ("0.3", "30")


def test_files_are_meant_relative_to_the_table(tmp_path):
    path = table(tmp_path, "options_file,history\na.opts,/b.csv\n")
    assert study_cases.read(str(path))[0].options == {"options_file": str(tmp_path / "a.opts"), "history": "/b.csv"}


INPUTS = ("load_history", *sorted(set(PATHS) - {"output", "checkpoint", "restart"}))


@pytest.mark.parametrize("option", INPUTS)
def test_a_file_of_any_option_is_found_and_its_change_noticed(tmp_path, option):
    (tmp_path / "input").write_text("1")
    path = table(tmp_path, f"{option},load_tx\ninput,1\n")
    case = study_cases.read(str(path))[0]
    assert case.options[option] == str(tmp_path / "input")
    before = case.identity()
    assert study_cases.read(str(path))[0].identity() == before
    (tmp_path / "input").write_text("12")
    assert study_cases.read(str(path))[0].identity() != before


def test_a_file_that_an_options_file_names_is_noticed_when_it_changes(tmp_path):
    (tmp_path / "h.csv").write_text("time,load_n\n1,2\n")
    (tmp_path / "a.opts").write_text(f"# loads\n-history {tmp_path}/h.csv  # N\n")
    path = table(tmp_path, "options_file\na.opts\n")
    before = study_cases.read(str(path))[0].identity()
    (tmp_path / "h.csv").write_text("time,load_n\n1,20\n")
    assert study_cases.read(str(path))[0].identity() != before


def test_names_of_cases_keep_units_with_a_slash(tmp_path):
    path = table(tmp_path, "load_n,gap_file\n1kN/m,a/g.h5\n2e3N/m,b/f.h5\n")
    names = [case.name for case in study_cases.read(str(path))]
    assert names == ["load_n=1kN-m_gap_file=g.h5", "load_n=2e3N-m_gap_file=f.h5"]


def test_a_history_outside_of_the_table_has_no_column_that_is_an_option(tmp_path):
    (tmp_path / "h.csv").write_text("time;load_ty\n1;2\n")
    path = table(tmp_path, "load_tx,history\n1,h.csv\n2,h.csv\n")
    assert len(study_cases.read(str(path))) == 2
    with pytest.raises(study_cases.TableError, match="load_ty is an option and a column of "):
        study_cases.read(str(path), {"load_ty": "1"})


def test_an_empty_cell_is_warned_of(tmp_path, monkeypatch, capsys):
    """It leaves the option out: the case has no friction."""
    path = table(tmp_path, "load_tx,friction\n1,0.3\n2,\n3,\n")
    code, said = in_process(monkeypatch, capsys, path, "--list")
    assert code == 0 and len(said.splitlines()) == 1
    assert "friction is empty in 2 of 3 cases, the first load_tx=2: they run without -friction" in said
    assert in_process(monkeypatch, capsys, path, "--list", "--quiet") == (0, "")


@pytest.mark.parametrize(
    "text, name, common, twin",
    [
        ("rolling_speed\n0.001\n100\n", "t.csv", "-load_n 5 -rolling_speed 1", "rolling_speed"),
        ("load_tx,grid_n\n20,16\n60,16\n", "t.csv", "-grid_n 32", "grid_n"),
        ("load_tx\n20\n60\n", "t.csv", "-Load_TX 10", "load_tx"),
        ("history\na.csv\nb.csv\n", "t.csv", "-load_history c.csv", "history"),
        ("allow_edge_contact\ntrue\nfalse\n", "t.csv", "-allow_edge_contact", "allow_edge_contact"),
        ("options:\n  load_tx: [1, 2]\n", "t.yaml", "-load_tx 2.5", "load_tx"),
        ("options:\n  load_tx: [1]\n", "t.yaml", "-load_tx 2.5", "load_tx"),
        ("options:\n  Friction: 0.1\n", "t.yaml", "-friction 0.3", "Friction"),
        ("options: {load_tx: '{friction}'}\nparameters: {friction: 3}\n", "t.yaml", "-friction 0.3", "friction"),
    ],
)
def test_an_option_for_all_cases_does_not_replace_values_of_the_table(
    tmp_path, monkeypatch, capsys, text, name, common, twin
):
    """Rows with the values of the table would all be those of the option."""
    code, said = in_process(monkeypatch, capsys, table(tmp_path, text, name), "--list", "--", *common.split())
    option = next(word for word in common.split() if word.lower().endswith(twin.lower()))
    assert code == 2 and f"{name}: {twin} is in the table, and {option}" in refused(said)
    assert in_process(monkeypatch, capsys, tmp_path / name, "--list", "--", "-coupling", "none")[0] == 0


@pytest.mark.parametrize("common", ["-load_n 1 -load_n 2", "-load_n 1 -Load_N 1", "-history a -load_history a"])
def test_an_option_given_twice_for_all_cases_is_refused(tmp_path, monkeypatch, capsys, common):
    path = table(tmp_path, "load_tx\n1\n")
    code, said = in_process(monkeypatch, capsys, path, "--list", "--", *common.split())
    assert code == 2 and f"{common.split()[2]}: given twice for all cases" in refused(said)


def test_options_of_one_name_in_python_are_refused(tmp_path):
    with pytest.raises(petsam.study.TableError, match="load_tx is in the table, and -load_tx 2.5 is given for all"):
        petsam.study.run({"load_tx": [1, 2]}, tmp_path / "s", options={"load_tx": 2.5})
    assert not (tmp_path / "s" / "results.h5").exists()


WARNS = """#!/bin/sh
[ "$2" = 1 ] || echo "petsam: warning: contact too large: $2"
echo "petsam: warning: and more"
[ "$2" != 4 ] || { echo "petsam: gross slip"; exit 11; }
"""


def test_warnings_of_the_cases_are_counted_at_the_end(run, tmp_path, fake):
    fake = {**fake, "PETSAM": executable(tmp_path / "bin" / "warns", WARNS)}
    table(tmp_path, "load_tx,case\n1,a\n2,b\n3,c\n4,d\n")
    for _ in range(2):  # finished cases are not run again, but counted
        said = run("cases.csv", "--cores", 1, check=1, **fake)
        assert "warning: 3 of 4 cases finished with warnings, the first a: and more; see all in petsam.log" in said
        assert "d  exit 11: gross slip" in said
    found = [row["message"] for row in table_of(tmp_path / "cases" / "results.csv")]
    large = "warning: contact too large: "
    assert found == ["warning: and more", large + "2", large + "3", "gross slip"]
    assert "with warnings" not in run("cases.csv", "--quiet", "--skip-failed", check=1, **fake)


def test_a_warning_of_petsam_is_one_of_the_study(run, tmp_path):
    table(tmp_path, "load_tx\n1\n2\n")
    large = dict(CASE, gap_radius1=CASE["gap_radius1"] / 1e3, load_tx=None)
    said = run("cases.csv", "--", *words(large))
    (line,) = [line for line in said.splitlines() if "2 of 2 cases finished with warnings" in line]
    text = line.split("the first load_tx=1: ")[1].split("; see all in ")[0]
    assert f"petsam: warning: {text}\n" in (tmp_path / "cases" / "load_tx=1" / "petsam.log").read_text()


@pytest.mark.parametrize("text", ["parameters: {a: 1}\n", "load_tx: [30, 60]\n", "30\n", ""])
def test_a_table_without_options_is_shown_how_they_are_written(run, tmp_path, text):
    table(tmp_path, text, "t.yaml")
    first, *example = run("t.yaml", check=2).splitlines()
    assert first.startswith("petsam-study: error: ") and "t.yaml: expected a section `options`" in first
    assert len(example) == 2 and all(line.startswith("  ") for line in example)
    table(tmp_path, "\n".join(line[2:] for line in example), "t.yaml")  # what is shown is a table
    assert [case.inputs for case in study_cases.read(str(tmp_path / "t.yaml"))] == [
        {"load_tx": load} for load in ("30", "60", "90")
    ]


def refused(said):
    """The one line of an error, without a traceback; an example may stand below it."""
    lines = [line for line in said.splitlines() if not line.startswith("  ")]
    assert len(lines) == 1 and lines[0].startswith("petsam-study: error: ") and "TRACEBACK" not in lines[0], said
    return lines[0]


def in_process(monkeypatch, capsys, *words):
    """Exit code and messages of petsam-study, run here: many in little time."""
    monkeypatch.setattr(sys, "argv", ["petsam-study", *map(str, words)])
    try:
        code = code_of("petsam-study")
    except SystemExit as end:  # of argparse
        code = end.code
    return code, capsys.readouterr().err


@pytest.mark.parametrize("ranks", ["inf", "nan", "1e400", "2.5", "-1", "0", "1e30", "two", "1;2", "9" * 5000])
def test_ranks_are_whole_numbers(tmp_path, monkeypatch, capsys, ranks):
    for name, text, line in (
        ("t.csv", f"load_tx,ranks\n1,1\n2,{ranks}\n", 3),
        ("t.yaml", f"options:\n  load_tx: 1\nranks: '{ranks}'\n", 3),
    ):
        code, said = in_process(monkeypatch, capsys, table(tmp_path, text, name), "--list")
        assert code == 2 and f"{name}, line {line}: ranks " in refused(said)


@pytest.mark.parametrize("name", ["t.csv", "t.yaml"])
@pytest.mark.parametrize(
    "data, message",
    [
        (b"load_tx\n\xe9\n", "line 2: is not UTF-8"),
        ("load_tx\n1\n".encode("utf-16"), "line 1: is UTF-16"),
        ("load_tx\n1\n".encode("utf-16-le"), "line 1: contains a NUL"),
        (b"load_tx\n1\0\n", "line 2: contains a NUL"),
        (bytes(range(256)) * 9, "line "),
        (b"", "expected"),
    ],
)
def test_a_table_that_is_no_text_is_refused(tmp_path, monkeypatch, capsys, name, data, message):
    (tmp_path / name).write_bytes(data)
    code, said = in_process(monkeypatch, capsys, tmp_path / name, "--list")
    assert code == 2 and message in refused(said)


def test_a_table_of_too_many_cases_is_refused(tmp_path, monkeypatch, capsys):
    path = table(tmp_path, "load_tx\n" + "".join(f"{k}\n" for k in range(100001)))
    code, said = in_process(monkeypatch, capsys, path, "--list")
    assert code == 2 and "100001 cases; use at most 100000" in refused(said)


SECTION = "options:\n  load_tx: "


@pytest.mark.parametrize(
    "text, message",
    [
        ("options: " + "[" * 20000, "nested too deeply"),
        ("options: {load_tx: &a [1, *a]}", "expected a value or a list"),
        ("options: &o\n  <<: *o\n", "line 2: "),
        ("options:\n  1: 2\n", "line 2: options: 1: is not a name"),
        ("options:\n  ? [a]\n  : 1\n", "line 2: "),
        ("options:\n  a/b: 1\n", "options: a/b: is not an option's name"),
        ("options:\n\tload_tx: 1\n", "line 2: "),
        (SECTION + "1\n  load_tx: 2\n", "line 3: load_tx: appears twice"),
        (SECTION + "1\n  Load_TX: 2\n", "line 3: Load_TX: appears twice"),
        (SECTION + "010\n", "line 2: 010: is 8 in YAML: write a decimal number"),
        (SECTION + "[1, -0x1F]\n", "line 2: -0x1F: is -31 in YAML: write a decimal number"),
        (SECTION + "1_000\n", "line 2: 1_000: is 1000 in YAML: write a decimal number"),
        (SECTION + "1\n---\na: 1\n", "line 3: expected a single document"),
        (SECTION + "9" * 6000, "line 2: "),
        (SECTION + '"\\0"\n', "line 2: "),
        (SECTION + '"\\ud800"\n', "line 2: "),
        (SECTION + '"\\Uffffffff"\n', "is not YAML"),
        (SECTION + "!!int abc\n", "line 2: abc"),
        (SECTION + "!!binary aGk=\n", "line 2: "),
        (SECTION + "[[1], [2]]\n", "expected a value or a list"),
        (SECTION + "1\nfiles: {1: a}\n", "line 3: "),
        (SECTION + "1\nranks: [1, 2]\n", "line 3: ranks: expected a number"),
        ("options:\n" + "".join(f"  a{k}: [1, 2, 3]\n" for k in range(900)), "use at most 100000"),
    ],
)
def test_a_bad_yaml_table_is_refused(tmp_path, monkeypatch, capsys, text, message):
    start = time.monotonic()
    code, said = in_process(monkeypatch, capsys, table(tmp_path, text, "t.yaml"), "--list")
    assert code == 2 and message in refused(said) and time.monotonic() - start < limit(AT_ONCE)


@pytest.mark.parametrize(
    "expression",
    [
        "9**9**9**9", "2**10**8", "10**400", "(-8)**0.5", "0**-1", "1e308 * 10", "0 * 1e999", "exp(1000)", "log(0)",
        "+".join("1" * 600), "(" * 300 + "1" + ")" * 300, "'a' * 10**9", "1 << 10**9", "True", "1j", "pi(1)", "min()",
        "sqrt", "1;2", "lambda: 1", "", "x := 1", "1 is 1",
    ],
)  # fmt: skip
def test_an_expression_without_a_finite_value_is_refused_at_once(tmp_path, monkeypatch, capsys, expression):
    start = time.monotonic()
    path = table(tmp_path, SECTION + "'{" + expression.replace("'", "''") + "}'\n", "t.yaml")
    code, said = in_process(monkeypatch, capsys, path, "--list")
    assert code == 2 and "t.yaml: {" in refused(said) and time.monotonic() - start < limit(AT_ONCE)


@pytest.mark.parametrize("count, link", [(25, "{%s + %s}"), (200, "{%s + %s}"), (29, "{%s}{%s}"), (3000, "{%s}%.0s")])
def test_names_that_refer_to_names_take_no_time(tmp_path, monkeypatch, capsys, count, link):
    """Each is expanded once, however often others refer to it; chains and texts are bounded."""
    start = time.monotonic()
    chain = "".join("  a{}: '{}'\n".format(k, link % (f"a{k + 1}", f"a{k + 1}")) for k in range(count))
    text = "parameters:\n" + chain + f"  a{count}: 1\n" + SECTION + "'{a0}'\n"
    code, said = in_process(monkeypatch, capsys, table(tmp_path, text, "t.yaml"), "--list")
    assert time.monotonic() - start < limit(AT_ONCE)
    assert code == 0 if count == 25 else code == 2 and "a" in refused(said)


@pytest.mark.parametrize("name", ["results.csv", "results.h5", "results.csv.tmp", "results.h5.tmp", "slurm-1_2.out"])
def test_a_case_cannot_have_the_name_of_a_file_of_the_study(tmp_path, monkeypatch, capsys, name):
    code, said = in_process(monkeypatch, capsys, table(tmp_path, f"case,load_tx\na,1\n{name},2\n"), "--list")
    assert code == 2 and f"line 3: case {name}: is reserved for a file" in refused(said)
    table(tmp_path, f"case,load_tx\n{name.upper()},2\n")
    assert in_process(monkeypatch, capsys, tmp_path / "cases.csv", "--list") == (0, "")


def test_a_case_cannot_have_a_name_that_no_file_system_takes(tmp_path, monkeypatch, capsys):
    code, said = in_process(monkeypatch, capsys, table(tmp_path, "case,load_tx\n" + "a" * 256 + ",2\n"), "--list")
    assert code == 2 and "line 2: case a" in refused(said)


@pytest.mark.parametrize(
    "name", ["petsam.log", "results.h5", "record.json", "record.json.tmp", "lock", "checkpoint.h5.1", "..", ""]
)
def test_a_file_of_the_cases_cannot_have_the_name_of_another(tmp_path, monkeypatch, capsys, name):
    path = table(tmp_path, SECTION + f"1\nfiles:\n  '{name}': text\n", "t.yaml")
    code, said = in_process(monkeypatch, capsys, path, "--list")
    assert code == 2 and "files: " in refused(said)


def test_a_table_that_is_no_regular_file_is_refused_at_once(tmp_path, monkeypatch, capsys):
    os.mkfifo(tmp_path / "pipe.csv")
    (tmp_path / "folder.csv").mkdir()
    for name in (tmp_path / "pipe.csv", tmp_path / "folder.csv", "/dev/zero"):
        code, said = in_process(monkeypatch, capsys, name, "--list")
        assert code == 3 and "is " in refused(said)


@pytest.mark.parametrize("inside", ["results.csv", "results.h5.tmp", "load_tx=1"])
def test_what_stands_in_the_way_of_the_results_is_named_before_any_run(run, tmp_path, fake, inside):
    table(tmp_path, "load_tx\n1\n2\n")
    (tmp_path / "cases").mkdir()
    os.mkfifo(tmp_path / "cases" / inside)
    assert inside in refused(run("cases.csv", check=3, **fake)) and not runs(tmp_path)


def test_the_table_is_not_replaced_by_the_results(run, tmp_path, fake):
    text = "load_tx\n1\n"
    table(tmp_path, text, "results.csv")
    assert "would be replaced" in refused(run("results.csv", "-d", ".", check=3, **fake))
    assert (tmp_path / "results.csv").read_text() == text
    table(tmp_path, text, "cases")
    assert "is not a folder" in refused(run("cases", check=3, **fake))


def test_a_spoiled_table_never_ends_in_a_traceback(tmp_path, monkeypatch, capsys):
    chance = random.Random(1)
    good = {
        "t.csv": b'load_tx, ranks, case\n# c\n"10", 2, one\n20, , two\n',
        "t.yaml": b"parameters: {a: [1, 2]}\noptions:\n  load_tx: '{2**a + sqrt(3)}'\nfiles:\n  h.csv: |\n    x {a}\n",
    }
    pieces = [
        b"{",
        b"}",
        b"[",
        b"*a",
        b"&a ",
        b'"',
        b"'",
        b"\n",
        b"\t",
        b"**9",
        b"\xff",
        b"\0",
        b": ",
        b"- ",
        b"!!int ",
    ]
    for name, data in [*good.items()] * 300:
        data = bytearray(data)
        for _ in range(chance.randint(1, 6)):
            at = chance.randrange(len(data))
            data[at : at + chance.randint(0, 3)] = chance.choice(pieces)
        (tmp_path / name).write_bytes(data)
        code, said = in_process(monkeypatch, capsys, tmp_path / name, "--list", "--quiet")
        assert (code, said) == (0, "") or code == 2 and refused(said), bytes(data)


def test_a_missing_table_is_exit_code_3(run):
    assert "nothere.csv: no such file" in run("nothere.csv", check=3)


def test_a_missing_file_of_every_case_is_named_before_any_runs(run, tmp_path):
    table(tmp_path, "load_tx\n1\n2\n")
    said = run("cases.csv", "--", "-options_file", "nothere.opts", check=3)
    assert "nothere.opts: no such file, and every case reads it" in said and not (tmp_path / "cases").exists()


# ---------------------------------------------------------------- runs of petsam


def test_tables_hold_inputs_and_scalars_of_the_last_step(run, tmp_path):
    table(tmp_path, f"load_tx,load_mz\n{float(0.3 * LIMIT)!r},0\n{float(0.5 * LIMIT)!r},1e-3\n")
    run("cases.csv", "--", *words(CASE), "-steps", "2")
    heads = (tmp_path / "cases" / "results.csv").read_text().splitlines()[0]
    assert heads.startswith("case,exit_code,seconds [s],ranks,load_tx,load_mz,steps [1],contact_area [m2],")
    assert ",load_tx_end [N]," in heads and ",stick_area [m2]," in heads
    rows = table_of(tmp_path / "cases" / "results.csv")
    assert [row["exit_code"] for row in rows] == ["0", "0"] and [row["load_mz"] for row in rows] == ["0", "1e-3"]
    with h5py.File(tmp_path / "cases" / "results.h5", "r") as both:
        assert both["inputs/load_mz"][:].tolist() == [0.0, 1e-3]
        assert both["results/stick_area"].attrs["units"] == "m2"
        assert "-steps 2" in both.attrs["options"]
        for k, row in enumerate(rows):
            history = both["cases"][row["case"]]["history"]
            assert float(row["stick_area"]) == both["results/stick_area"][k] == history["stick_area"][-1]
            assert float(row["load_tx_end"]) == history["load_tx"][-1]
            assert np.isclose(float(row["dissipated_energy_sum"]), history["dissipated_energy"][:].sum(), rtol=1e-14)
            assert int(row["steps"]) == history["time"].size


def test_errors_are_columns(run, tmp_path):
    """Of the last step's numbers, and of the energy of all steps."""
    table(tmp_path, f"load_tx\n{float(0.3 * LIMIT)!r}\n{float(0.5 * LIMIT)!r}\n")
    run("cases.csv", "--", *words(CASE), "-steps", "2", "-errors", "companion")
    for row in table_of(tmp_path / "cases" / "results.csv"):
        with petsam.open(tmp_path / "cases" / row["case"] / "results.h5") as file:
            assert float(row["slip_max_error"]) == file.history["slip_max_error"][-1] > 0
            error = file.errors["dissipated_energy"]
            assert float(row["dissipated_energy_sum_error"]) == pytest.approx(error.error * error.value, rel=1e-12)


def test_a_study_runs_from_python_side_by_side(tmp_path, fake, monkeypatch):
    """As the command runs it; again nothing runs but what has failed."""
    for name, value in fake.items():
        monkeypatch.setenv(name, str(value))
    monkeypatch.chdir(tmp_path)
    table(tmp_path, "load_tx,code\n1,0\n2,0\n3,4\n")
    ended = []
    found = petsam.study.run(
        "cases.csv", cores=2, options=dict(grid_n=(32, 32), wait=0.01), report=lambda *one: ended.append(one)
    )
    assert found.codes.tolist() == [0, 0, 4] and found.inputs["load_tx"].tolist() == [1.0, 2.0, 3.0]
    assert sorted((case.inputs["load_tx"], code) for case, code in ended) == [("1", 0), ("2", 0), ("3", 4)]
    assert len(runs(tmp_path)) == 3 and all(
        {"-grid_n", "32,32", "-wait", "0.01"} <= set(line) for line in runs(tmp_path)
    )
    assert petsam.study.run("cases.csv", "cases", cores=2, options=dict(grid_n=(32, 32), wait=0.01)).codes[2] == 4
    assert len(runs(tmp_path)) == 4
    with pytest.raises(petsam.Error, match="2 ranks do not fit into 1 cores"):
        petsam.study.run("cases.csv", "other", cores=1, ranks=2)
    with pytest.raises(petsam.study.TableError, match="t.csv, line 2"):
        table(tmp_path, "load_tx,output\n1,a\n", "t.csv")
        petsam.study.run("t.csv")


def test_a_mapping_is_a_study_of_all_combinations(tmp_path, monkeypatch):
    monkeypatch.setenv("PETSAM", str(PETSAM))
    monkeypatch.chdir(tmp_path)
    case = dict(CASE, friction=None, load_tx=None)
    varied = dict(friction=[0.4, 0.2], load_tx=np.array([5.0, 10.0, 15.0]), steps=2)
    found = petsam.study.run(
        varied, "pads", {name: value for name, value in case.items() if value is not None}, cores=2
    )
    assert found.codes.tolist() == [0] * 6 and (tmp_path / "pads/results.h5").exists()
    pandas = pytest.importorskip("pandas", reason="pandas is not installed")
    table = found.to_dataframe()
    assert isinstance(table, pandas.DataFrame) and table.attrs["units"]["stick_area"] == "m2"
    xarray = pytest.importorskip("xarray", reason="xarray is not installed")
    cube = found.to_xarray()
    assert isinstance(cube, xarray.Dataset) and dict(cube.sizes) == {"friction": 2, "load_tx": 3}
    assert cube.load_tx.attrs["units"] == "N" and cube.stick_area.attrs["units"] == "m2"
    for friction in (0.2, 0.4):
        for load in (5.0, 10.0, 15.0):
            row = table[(table.friction == friction) & (table.load_tx == load)]
            assert float(cube.stick_area.sel(friction=friction, load_tx=load)) == float(row.stick_area.iloc[0])
    found.inputs["load_tx"][0] = found.inputs["load_tx"][1]  # no longer all combinations
    assert dict(found.to_xarray().sizes) == {"case": 6}


def test_other_cases_run_after_one_with_a_wrong_option(run, tmp_path, fake):
    table(tmp_path, "code,load_tx\n2,1\n0,2\n0,3\n")
    said = run("cases.csv", "--cores", 1, check=1, **fake)
    assert len(runs(tmp_path)) == 3 and "3 cases: 2 finished, 1 failed" in said and "exit 2" in said


def test_failures_are_listed_with_exit_code_and_message(run, tmp_path):
    table(tmp_path, f"load_tx,case\n{float(0.3 * LIMIT)!r},good\n{float(1.5 * LIMIT)!r},slides\n")
    said = run("cases.csv", "--", *words(CASE), check=1)
    assert "2 cases: 1 finished, 1 failed" in said and "slides  exit 11: gross slip" in said
    with h5py.File(tmp_path / "cases" / "results.h5", "r") as file:
        assert file["exit_code"][:].tolist() == [0, 11] and b"gross slip" in file["message"][1]


def test_the_table_links_all_parts_of_a_run_that_went_on(run, tmp_path):
    table(tmp_path, f"load_tx,case\n{float(0.3 * LIMIT)!r},one\n")
    run("cases.csv", "--", *words(CASE))
    with h5py.File(tmp_path / "cases" / "results.h5", "r") as file:
        assert list(file["cases"]) == ["one"]
    shutil.copy(tmp_path / "cases" / "one" / "results.h5", tmp_path / "cases" / "one" / "results.part2.h5")
    run("cases.csv", "--", *words(CASE))
    with h5py.File(tmp_path / "cases" / "results.h5", "r") as file:
        assert list(file["cases"]) == ["one", "one.part2"] and "history" in file["cases/one.part2"]


def test_the_energy_of_a_case_that_ends_in_gross_slip_is_that_of_the_steps_before(run, tmp_path):
    loads = [float(factor * LIMIT) for factor in (0.0, 0.5, -0.5, 0.5, 1.5)]
    (tmp_path / "h.csv").write_text("time,load_tx\n" + "".join(f"{k},{load!r}\n" for k, load in enumerate(loads, 1)))
    table(tmp_path, f"history,load_tx,case\nh.csv,,slides\n,{loads[-1]!r},at-once\n")
    run("cases.csv", "--", *words(CASE), check=1)
    with h5py.File(tmp_path / "cases" / "results.h5", "r") as both:
        assert both["exit_code"][:].tolist() == [11, 11] and both["results/status"][:].tolist() == [11, 11]
        energy = both["cases/slides/history/dissipated_energy"][:]
        total = both["results/dissipated_energy_sum"][:]
    assert np.isnan(energy[-1]) and energy[:-1].sum() > 0.0
    assert np.isclose(total[0], energy[:-1].sum(), rtol=1e-14) and np.isnan(total[1])


def test_a_changed_friction_file_runs_its_case_again(run, tmp_path, fake):
    (tmp_path / "f.h5").write_text("one")
    table(tmp_path, "friction_file,load_tx\nf.h5,1\n,2\n")
    run("cases.csv", **fake)
    assert f"-friction_file {tmp_path / 'f.h5'} " in " ".join([*runs(tmp_path)[0], *runs(tmp_path)[1], ""])
    run("cases.csv", **fake)
    assert len(runs(tmp_path)) == 2
    (tmp_path / "f.h5").write_text("other")
    run("cases.csv", **fake)
    assert [line[1] for line in runs(tmp_path)[2:]] == ["friction_file=f.h5_load_tx=1"]


def test_the_same_command_again_runs_only_what_has_not_finished(run, tmp_path, fake):
    table(tmp_path, "code,case\n0,one\n0,two\n3,code=3\n")
    assert "1 failed" in run("cases.csv", check=1, **fake)
    assert len(runs(tmp_path)) == 3
    assert "code=3  exit 3: it is 3" in run("cases.csv", check=1, **fake)
    assert [line[1] for line in runs(tmp_path)[3:]] == ["code=3"]
    run("cases.csv", "--skip-failed", check=1, **fake)
    assert len(runs(tmp_path)) == 4


def test_the_table_overrides_the_options_file_that_all_cases_have(run, tmp_path, fake):
    table(tmp_path, "load_tx,friction\n1,0.2\n")
    (tmp_path / "a.opts").write_text("-friction 0.1\n")
    run("cases.csv", "--", "-grid_n", "64", "-options_file", "a.opts", **fake)
    words = runs(tmp_path)[0]
    assert words.index("-options_file") < words.index("-friction") and words[words.index("-friction") + 1] == "0.2"


def test_a_changed_table_or_options_file_runs_its_cases_again(run, tmp_path, fake):
    (tmp_path / "a.opts").write_text("-grid_n 64\n")
    table(tmp_path, "options_file,load_tx\na.opts,1\n,2\n")
    run("cases.csv", **fake)
    (tmp_path / "a.opts").write_text("-grid_n 65\n")
    table(tmp_path, "options_file,load_tx\n,3\n,2\na.opts,1\n")
    run("cases.csv", **fake)
    again = [line[1] for line in runs(tmp_path)[2:]]
    assert sorted(again) == ["load_tx=3", "options_file=a.opts_load_tx=1"]


def test_ranks_at_once_fill_but_never_exceed_the_cores(run, tmp_path, fake):
    executable(
        tmp_path / "bin" / "petsam",
        '#!/bin/sh\necho "+$RANKS" >>../../load.txt\nsleep 0.4\necho "-$RANKS" >>../../load.txt\n',
    )
    table(tmp_path, "ranks,load_tx\n2,1\n1,2\n3,3\n1,4\n1,5\n2,6\n1,7\n")
    run("cases.csv", "--cores", 3, **fake)
    load = np.cumsum([int(line) for line in (tmp_path / "load.txt").read_text().split()])
    assert load.max() == 3 and load[-1] == 0 and load.size == 14


def test_more_ranks_than_cores_are_refused(run, tmp_path, fake):
    table(tmp_path, "ranks,load_tx\n2,1\n4,2\n")
    assert "case ranks=4_load_tx=2" not in run("cases.csv", "--cores", 4, **fake)
    assert "case load_tx=2: 4 ranks do not fit into 3 cores" in run(
        "cases.csv", "--cores", 3, "-d", "d", check=2, **fake
    )


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interruption_ends_the_runs_and_the_same_command_goes_on(study, run, tmp_path, fake, number):
    table(tmp_path, "wait,load_tx\n0,1\n60,2\n60,3\n0,4\n")
    process = study("cases.csv", "--cores", 2, **fake)
    until(lambda: (tmp_path / "started.txt").exists() and len((tmp_path / "started.txt").read_text().split("\n")) > 3)
    process.send_signal(number)
    out, err = process.communicate(timeout=240)
    assert process.returncode == 128 + number and "interrupted" in err
    for line in (tmp_path / "started.txt").read_text().splitlines():
        assert not os.path.exists("/proc/" + line.split()[1])
    assert "1 finished, 0 failed, 3 not run" in out and "wrote" in out
    text = (tmp_path / "cases.csv").read_text().replace("60,", "0,")
    table(tmp_path, text)
    assert "4 finished" in run("cases.csv", "--cores", 2, **fake)


def test_a_case_that_is_being_run_is_left_to_whoever_runs_it(study, run, tmp_path, fake):
    table(tmp_path, "wait,load_tx\n2,1\n0,2\n")
    process = study("cases.csv", "--cores", 1, **fake)
    until((tmp_path / "started.txt").exists)
    process.kill()  # the run goes on, and holds its case
    process.communicate()
    said = run("cases.csv", check=1, **fake)
    assert "wait=2_load_tx=1  is being run by another study" in said and "1 finished" in said
    assert [line[1] for line in runs(tmp_path)] == ["wait=2_load_tx=1", "wait=0_load_tx=2"]


def test_a_stopped_case_goes_on_from_its_checkpoint(study, run, tmp_path, fake):
    table(tmp_path, "wait,stoppable\n60,true\n")
    process = study("cases.csv", "--checkpoint", 5, **fake)
    until((tmp_path / "started.txt").exists)
    process.send_signal(signal.SIGUSR1)
    out, err = process.communicate(timeout=240)
    assert process.returncode == 75 and "1 stopped early" in out, (out, err)
    assert "-restart" not in runs(tmp_path)[0] and " ".join(runs(tmp_path)[0]).endswith(
        "-checkpoint checkpoint.h5 -checkpoint_every 5"
    )
    process = study("cases.csv", "--checkpoint", 5, **fake)
    until(lambda: len(runs(tmp_path)) == 2)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=240)
    assert " ".join(runs(tmp_path)[1]).endswith("-restart checkpoint.h5")
    table(tmp_path, "wait,stoppable\n0,true\n")  # other inputs: not from this checkpoint
    run("cases.csv", "--checkpoint", 5, **fake)
    assert "-restart" not in runs(tmp_path)[2]


def test_progress_counts_and_estimates(run, tmp_path, fake):
    table(tmp_path, "load_tx\n1\n2\n3\n")
    said = run("cases.csv", "--cores", 1, **fake)
    assert "[1/3] load_tx=1  exit 0  (0:0" in said and "[3/3] load_tx=3  exit 0  (0:00 left)" in said
    assert (
        run("cases.csv", "--list", **fake).split()
        == "1 finished load_tx=1 2 finished load_tx=2 3 finished load_tx=3".split()
    )


def test_a_missing_program_is_named(run, tmp_path):
    table(tmp_path, "load_tx\n1\n")
    assert "no program nothere" in run("cases.csv", check=3, PETSAM="nothere")
    assert "no MPI launcher nothere" in run("cases.csv", check=3, MPIRUN="nothere")


@pytest.mark.parametrize("words", ["'", "nothere", "folder", "text", "garbage", " "])
def test_a_launcher_that_cannot_be_executed_is_named(run, tmp_path, words):
    table(tmp_path, "load_tx\n1\n")
    (tmp_path / "folder").mkdir()
    (tmp_path / "text").write_text("no program")
    executable(tmp_path / "garbage", "\x01\x02 no program")
    words = str(tmp_path / words) if (tmp_path / words).exists() and words.strip() else words
    assert "launcher" in refused(run("cases.csv", "--launcher=" + words, check=3))


def test_a_launcher_that_never_stops_to_speak_is_stopped(run, tmp_path):
    executable(tmp_path / "bin" / "mpirun", '#!/bin/sh\n[ "$1" = -n ] || exec yes\nexit 3\n')
    table(tmp_path, "load_tx\n1\n")
    assert "1 failed" in run("cases.csv", check=1, MPIRUN=tmp_path / "bin" / "mpirun")


def test_a_launcher_beside_the_table_is_found(run, tmp_path, fake):
    table(tmp_path, "load_tx\n1\n")
    assert "1 finished" in run("cases.csv", "--launcher", "bin/mpirun", **fake)


def test_a_run_that_prints_no_text_is_recorded(run, tmp_path, fake):
    executable(tmp_path / "bin" / "petsam", "#!/bin/sh\nprintf 'a\\0b\\377\\033c\\n'; exit 3\n")
    table(tmp_path, "load_tx\n1\n")
    assert "exit 3: a\\x00b" in run("cases.csv", check=1, **fake)
    with h5py.File(tmp_path / "cases" / "results.h5", "r") as file:
        assert file["message"][0].startswith(b"a\\x00b")


def test_results_that_hdf5_cannot_read_leave_their_row_empty(run, tmp_path, fake):
    executable(tmp_path / "bin" / "petsam", "#!/bin/sh\nprintf '\\211HDF\\r\\n\\032\\nrubbish' >results.h5\n")
    table(tmp_path, "load_tx\n1\n2\n")
    assert "2 finished" in run("cases.csv", **fake)


def test_a_record_of_another_form_is_none(run, tmp_path, fake):
    case = study_cases.read(str(table(tmp_path, "load_tx\n1\n")))[0]
    (tmp_path / "cases" / case.name).mkdir(parents=True)
    good = {"identity": case.identity(), "exit_code": 3, "seconds": 1.0, "message": "m"}
    odd = [{"exit_code": [1]}, {"exit_code": "0"}, {"exit_code": 10**30}, {"seconds": "1"}, {"message": 5}]
    for text in [*(json.dumps({**good, **change}) for change in odd), "[" * 100000, "{", ""]:
        (tmp_path / "cases" / case.name / "record.json").write_text(text)
        assert "1  not run" in run("cases.csv", "--list", **fake)


# ---------------------------------------------------------------- Slurm, by commands that stand for it


@pytest.fixture
def slurm(tmp_path, fake):
    """Variables with an sbatch that runs its script at once for each number of the array, an srun, and an scontrol.

    What they were called with goes to sbatch.txt and scontrol.txt. USR1 is sent to the script once `started` exists
    when the file `limit` does.
    """
    executable(
        tmp_path / "bin" / "srun",
        f'#!/bin/sh\necho "$@" >>{tmp_path}/srun.txt\n[ "$1" != --cpu-bind=cores ] || shift\n'
        '[ "$1" = -n ] && { RANKS=$2; export RANKS; shift 2; }\nexec "$@"\n',
    )
    executable(tmp_path / "bin" / "scontrol", f'#!/bin/sh\necho "$@" >>{tmp_path}/scontrol.txt\n')
    executable(
        tmp_path / "bin" / "sbatch",
        r"""#!/usr/bin/env python3
import os, re, shutil, signal, subprocess, sys, tempfile, time
here = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
with open(here + "/sbatch.txt", "a") as log:
    print(*sys.argv[1:], file=log)
words, options = sys.argv[1:], {}
while words and words[0].startswith("--"):
    name, _, value = words.pop(0).partition("=")
    options[name] = value or (words.pop(0) if name == "--wrap" else "")
job = str(len(open(here + "/sbatch.txt").readlines()))
environment = dict(os.environ, SLURM_JOB_ID=job, SLURM_ARRAY_JOB_ID=job)
environment.update(pair.split("=", 1) for pair in options.get("--export", "").split(",") if "=" in pair)
if "--wrap" in options:
    command, numbers = ["sh", "-c", options["--wrap"]], [""]
else:
    script = shutil.copy(words[0], tempfile.mkdtemp(dir=here))  # Slurm keeps a copy of its own
    command = ["bash", script, *words[1:]]
    numbers = [str(n) for part in options.get("--array", "0").split("%")[0].split(",")
               for n in range(int(part.split("-")[0]), int(part.split("-")[-1]) + 1)]
for number in numbers:
    with open(here + "/job-%s.txt" % job, "ab") as out:
        process = subprocess.Popen(command, env=dict(environment, SLURM_ARRAY_TASK_ID=number), stdout=out, stderr=out)
        while os.path.exists(here + "/limit") and process.poll() is None:
            if os.path.exists(here + "/started.txt"):
                os.remove(here + "/limit")
                process.send_signal(signal.SIGUSR1)
            time.sleep(0.02)
        with open(here + "/codes.txt", "a") as codes:
            print(process.wait(), file=codes)
print(job)
""",
    )
    return dict(fake, PATH="{}:{}".format(tmp_path / "bin", os.environ["PATH"]))


def lines(path):
    return path.read_text().splitlines() if path.exists() else []


def test_array_numbers_are_written_as_ranges():
    assert ranges([1, 2, 3, 7, 9, 10]) == "1-3,7,9-10" and ranges([4]) == "4"


def test_a_study_is_submitted_as_arrays_and_collected(run, tmp_path, slurm):
    table(tmp_path, "load_tx,code,ranks\n1,0,1\n2,3,1\n3,0,2\n4,0,1\n")
    run("cases.csv", "--case", 1, **slurm)
    said = run(
        "cases.csv", "--slurm", "--cores", 4, "--sbatch", "--time=1:00 --qos=short", "--", "-grid_n", "64", **slurm
    )
    # other options for all cases: case 1 runs again
    submitted = lines(tmp_path / "sbatch.txt")
    assert "job 1: 3 cases of 1 rank" in said and "job 2: 1 case of 2 ranks" in said and len(submitted) == 3
    assert "--array=1-2,4%4 --ntasks=1 " in submitted[0] and "--array=3%2 --ntasks=2 " in submitted[1]
    assert all("--time=1:00 --qos=short" in line for line in submitted)
    assert "--dependency=afterany:1:2" in submitted[2]
    assert sorted(line[:2] + line[-4:-2] for line in runs(tmp_path)[1:]) == [
        ["1", "load_tx=1_code=0", "-grid_n", "64"],
        ["1", "load_tx=2_code=3", "-grid_n", "64"],
        ["1", "load_tx=4_code=0", "-grid_n", "64"],
        ["2", "load_tx=3_code=0", "-grid_n", "64"],
    ]
    assert lines(tmp_path / "codes.txt") == ["0", "1", "0", "0", "1"]
    with open(tmp_path / "cases" / "results.csv", encoding="utf-8") as file:
        assert [row["exit_code"] for row in csv.DictReader(file)] == ["0", "3", "0", "0"]
    # only what has not finished is submitted again
    run("cases.csv", "--slurm", "--", "-grid_n", "64", **slurm)
    assert "--array=2 " in lines(tmp_path / "sbatch.txt")[3]


@pytest.mark.parametrize("words", [("--sbatch", "--time=2:00:00"), ("--sbatch=--time=2:00:00",)])
def test_a_single_option_of_sbatch_is_taken_as_the_help_writes_it(run, tmp_path, slurm, words):
    table(tmp_path, "load_tx\n1\n")
    run("cases.csv", "--slurm", *words, **slurm)
    assert all(" --time=2:00:00 " in line for line in lines(tmp_path / "sbatch.txt"))
    assert "--sbatch requires --slurm" in run("cases.csv", *words, check=2, **slurm)


def test_each_rank_of_a_task_is_bound_to_its_cores(run, tmp_path, slurm):
    table(tmp_path, "load_tx,ranks\n1,2\n")
    run("cases.csv", "--slurm", "--cores", 2, **slurm)
    assert any(line.startswith("--cpu-bind=cores -n 2 ") for line in lines(tmp_path / "srun.txt"))


def test_the_grace_of_a_run_is_the_time_that_the_job_has_left(monkeypatch):
    monkeypatch.delenv("GRACE", raising=False)
    monkeypatch.delenv("SLURM_JOB_END_TIME", raising=False)
    assert study_runs.grace() == 90.0
    monkeypatch.setenv("SLURM_JOB_END_TIME", str(int(time.time()) + 600))
    assert 560.0 < study_runs.grace() <= 570.0
    monkeypatch.setenv("SLURM_JOB_END_TIME", "5")
    assert study_runs.grace() == 1.0
    monkeypatch.setenv("GRACE", "7")
    assert study_runs.grace() == 7.0
    monkeypatch.setenv("GRACE", "long")
    with pytest.raises(study_runs.Error, match="GRACE is long"):
        study_runs.grace()


@pytest.mark.parametrize(
    "words, passed",
    [
        (("--turns", "load_tx", "--cycle", "1,-2"), "--turns load_tx --cycle=1,-2"),
        (("--period", "0.5,-1", "--cycle", "-2"), "--period=0.5,-1.0 --cycle=-2"),
    ],
)
def test_the_job_that_collects_knows_which_cycles_are_wanted(run, tmp_path, slurm, words, passed):
    table(tmp_path, "load_tx\n1\n")
    run("cases.csv", "--slurm", *words, **slurm)
    *_, collecting = lines(tmp_path / "sbatch.txt")
    assert "--collect" in collecting and passed in collecting


def test_a_task_of_the_array_that_was_stopped_is_queued_again(run, tmp_path, slurm):
    table(tmp_path, "wait,stoppable\n60,true\n")
    (tmp_path / "limit").touch()
    run("cases.csv", "--slurm", "--checkpoint", 2, **slurm)
    assert lines(tmp_path / "scontrol.txt") == ["requeue 1_1"]
    with open(tmp_path / "cases" / "results.csv", encoding="utf-8") as file:
        assert [row["exit_code"] for row in csv.DictReader(file)] == ["75"]


def test_without_sbatch_slurm_is_refused(run, tmp_path, fake):
    table(tmp_path, "load_tx\n1\n")
    assert "sbatch not found on PATH" in run(
        "cases.csv", "--slurm", check=2, PATH=os.path.dirname(sys.executable), **fake
    )


# one large run: the program writes checkpoints to the path it is given
LARGE = r"""#!/bin/bash
echo "$*" >>{0}/runs.txt
while [ $# -gt 0 ]; do [ "$1" != -checkpoint ] || file=$2; shift; done
trap 'echo "$$ $RANDOM" >"$file"; exit 75' USR1
: >{0}/started.txt
{1}
"""


@pytest.fixture
def large(tmp_path, slurm):
    """large(script): runs examples/study/run.sbatch with a petsam that does script; exit code and requeues."""

    def submit(script, *more, limit=False, **variables):
        executable(tmp_path / "bin" / "petsam", LARGE.format(tmp_path, script))
        for name in ("started.txt", "scontrol.txt", "codes.txt"):
            (tmp_path / name).unlink(missing_ok=True)
        if limit:
            (tmp_path / "limit").touch()
        env = {
            **environment(),
            **{k: str(v) for k, v in slurm.items()},
            "CHECKPOINT": "big.checkpoint.h5",
            "GRACE": "1",
            **variables,
        }
        script, words = ROOT / "examples/study/run.sbatch", ["-grid_n", "64", "-output", "big.h5", *more]
        subprocess.run(
            ["sbatch", "--nodes=2", str(script), *words],
            cwd=tmp_path,
            env=env,
            check=True,
            timeout=120,
            stdout=subprocess.DEVNULL,
        )
        return int(lines(tmp_path / "codes.txt")[-1]), lines(tmp_path / "scontrol.txt")

    return submit


def test_a_large_run_is_stopped_before_the_limit_and_goes_on(large, tmp_path):
    assert large("sleep 60 & wait", limit=True) == (0, ["requeue 1"])
    assert large("exit 0") == (0, [])
    first, second = lines(tmp_path / "runs.txt")
    assert first == "-grid_n 64 -output big.h5 -checkpoint big.checkpoint.h5 -checkpoint_every 10"
    assert second == first + " -restart big.checkpoint.h5"


@pytest.mark.parametrize("code", [0, 2, 10, 11])
def test_a_large_run_that_ends_by_itself_is_not_queued_again(large, code):
    assert large(f"echo state >$file; exit {code}") == (code, [])


def test_a_large_run_without_a_new_checkpoint_is_not_queued_again(large, tmp_path):
    (tmp_path / "big.checkpoint.h5").write_text("old")
    assert large("exit 75") == (75, [])


def test_a_step_longer_than_the_grace_goes_on_from_the_checkpoint_before(large):
    """The program takes no notice of USR1, but has written a checkpoint in this job."""
    assert large("trap '' USR1; echo state >$file; exec sleep 60", limit=True) == (0, ["requeue 1"])


def test_a_large_run_is_bound_and_knows_how_much_time_is_left(large, tmp_path):
    end = str(int(time.time()) + 3600)
    large("exit 0", SLURM_JOB_END_TIME=end)
    large("exit 0", "-max_walltime", "5:00", SLURM_JOB_END_TIME=end)
    large("exit 0", SLURM_JOB_END_TIME="5", MARGIN="10")
    first, second, third = lines(tmp_path / "runs.txt")
    assert 3400 < int(re.search(r"-checkpoint_every 10 -max_walltime (\d+)$", first).group(1)) <= 3540
    assert second.count("-max_walltime") == 1 and "-max_walltime 5:00" in second
    assert third.endswith("-max_walltime 1")
    assert all(line.startswith("--cpu-bind=cores ") for line in lines(tmp_path / "srun.txt"))


def test_a_long_step_gets_the_time_that_is_left(large):
    """The program takes two seconds to stop; with GRACE it would be ended after one, without a new checkpoint."""
    slow = "trap 'sleep 2; echo state >$file; exit 75' USR1; sleep 60 & wait"
    assert large(slow, limit=True)[1] == []
    assert large(slow, limit=True, GRACE="", SLURM_JOB_END_TIME=str(int(time.time()) + 600)) == (0, ["requeue 2"])
