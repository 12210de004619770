"""Bad input: each row of refusals.txt is a run, its exit code, and what its message must contain.

Input that is rejected (exit codes 2 and 3) leaves all files as they are, results of an earlier run too; the message is
the first line on stderr, short, and nothing else stands there but where help is. Loads that cannot be carried (11), a
contact at the edge (12) and doubts (0) are told in one line as well, and the results are written.
"""

import os
import re
import shlex
import shutil
import stat
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np
import pytest

import compliances
from conftest import PROGRAM, execute
from support import SPHERE, words

TABLE = Path(__file__).with_name("refusals.txt")
BEGINNING = {"sphere": words({**SPHERE, "output": "results.h5"})}  # words that a section may begin with


class Row(NamedTuple):
    program: str
    words: list
    files: dict  # texts by name
    code: int
    parallel: bool
    says: list  # parts of the message


def split(text):
    """Words with the quotes of a shell, in which a backslash has no meaning."""
    lexer = shlex.shlex(text, posix=True, punctuation_chars=False)
    lexer.whitespace_split, lexer.commenters, lexer.escape = True, "", ""
    return list(lexer)


def joined(base, line):
    """The words of a section but those options that a row gives itself, or leaves out by !option; then the row's."""
    given = {word.lstrip("!-").partition("=")[0] for word in line if re.match(r"!|--?[A-Za-z]", word)}
    kept, keeps = [], True
    for word in base:
        if re.match(r"--?[A-Za-z]", word):
            keeps = word.lstrip("-") not in given
        kept += [word] * keeps
    return [*kept, *(word for word in line if word[:1] != "!" or word == "!")]


def with_files(line):
    """Words in which names stand for @name:text, and these texts by name."""
    found = [re.fullmatch(r"@([^:]*):(.*)", word, re.S) for word in line]
    files = {f[1]: f[2].encode("latin-1").decode("unicode_escape").encode("latin-1") for f in found if f}
    return [f[1] if f else word for f, word in zip(found, line)], files


def expanded(text):
    """The words, exit code and parts of each row of a line: one, or as many as there are words between braces."""
    line, code, *says = re.split(r" \| ", re.sub(r"<(.+?)\*(\d+)>", lambda many: many[1] * int(many[2]), text))
    choice = re.search(r"(?:^|(?<= ))\{(.*?)\}(?= |$)", line)
    for word in split(choice[1]) if choice else [None]:
        typed = split(line)
        if choice:
            typed = [*split(line[: choice.start()]), word, *split(line[choice.end() :])]
        names = dict.fromkeys(re.sub("^!", "-", name) for name in (typed[0], word) if name)
        yield typed, code, [part if word is None else part.replace("{}", word) for part in says] or list(names)


def rows_of_line(program, base, given, text):
    """The parameters of a test for each row of a line."""
    for typed, code, says in expanded(text):
        line, files = with_files(typed)
        row = Row(program, joined(base, line), {**given, **files}, int(code.strip("*")), "*" in code, says)
        yield pytest.param(row, id=" ".join(typed if program == "petsam" else [program, *typed])[:100])


def read(path):
    """All rows of the table."""
    rows, base, files, program = [], [], {}, ""
    for line in path.read_text().splitlines():
        if line.startswith("["):
            program, *base = split(line[1:-1])
            base, files = with_files(base)
            base = joined(BEGINNING.get(base[0], base[:1]), base[1:]) if base else []
        elif line and not line.startswith("#"):
            rows += rows_of_line(program, base, files, line)
    return rows


# tests/mutants needs only the rows that may notice a changed line
ROWS = [row for row in read(TABLE) if os.environ.get("PETSAM_ROWS", "") in row.id]
TOOLS = {row.values[0].program for row in ROWS} - {"petsam", "petsam-stress"}


def rows_of(*programs):
    return [row for row in ROWS if row.values[0].program in programs]


def write_heights(folder):
    """Maps of heights, good ones and those that are none."""
    bowl = np.add.outer((np.arange(8) - 3.5) ** 2, (np.arange(8) - 3.5) ** 2) * 1e-8
    with h5py.File(folder / "good.h5", "w") as f:
        f["height"] = bowl
        f["line"], f["cube"], f["scalar"], f["words"] = bowl[0], np.stack([bowl, bowl]), 1.0, [[b"a"] * 8] * 8
        f["nan"], f["inf"] = bowl, bowl
        f["nan"][7, 3] = np.nan
        f["inf"][0, 0] = -np.inf
        f.create_group("group")
    with h5py.File(folder / "wide.h5", "w") as f:
        f["height"], f["notes"] = np.zeros((6, 7)), np.arange(3.0)
        f.create_group("measured")
    rough = np.cos(np.arange(42.0).reshape(6, 7))
    wave = np.cos(4 * np.pi * (np.arange(64) + 0.5) / 64)
    heights = dict(um=0.9 * rough, tilt=1e-6 * (rough + np.arange(6.0)[:, None]))
    x = (np.arange(64) - 31.5) / 64
    radius = np.hypot(x, x[:, None])
    tip = 4e-5 * radius**2
    tip[32, 32] -= 3e-8
    heights.update(
        steep=9e-5 * (wave + wave[:, None]), round=4e-5 * radius**2, tip=tip, disk=2e-4 * np.maximum(radius - 0.2, 0)
    )
    for name, values in heights.items():
        with h5py.File(folder / f"{name}.h5", "w") as f:
            f["height"] = values
    (folder / "cut.h5").write_bytes((folder / "good.h5").read_bytes()[:600])
    (folder / "empty.h5").write_bytes(b"")
    (folder / "link.h5").symlink_to("good.h5")
    (folder / "copy.h5.1").write_bytes((folder / "good.h5").read_bytes())


def run_contacts(launcher, folder):
    """Results of the sphere: one step, a cycle, rolling, a loop that ends in gross slip; and what is no results."""
    small = dict(SPHERE, grid_n=16)
    (folder / "c.csv").write_text("time,load_tx\n1,30\n2,60\n3,30\n4,-60\n5,-30\n6,60\n")
    (folder / "rolled.csv").write_text("time,creep_x\n1,1e-4\n2,3e-3\n")
    (folder / "plotted.csv").write_text("time,load_tx\n0,0\n1,70\n2,-70\n3,70\n4,630\n")
    for name, code, more in (
        ("r", 0, {}),
        ("c", 0, dict(history="c.csv", output_every=2)),
        ("rolled", 0, dict(history="rolled.csv", rolling="steady", creep_y=2e-4, output_fields="usual")),
        ("plotted", 11, dict(history="plotted.csv", steps=4)),
    ):
        execute(launcher, folder, [small, dict(output=f"{name}.h5"), more], 1, code)
    whole = (folder / "c.h5").read_bytes()
    (folder / "half.h5").write_bytes(whole[: len(whole) // 2])
    for name, attribute, value in (
        ("periodic", "elasticity", "periodic"),
        ("plate", "elasticity", "plate"),
        ("soft", "body2_poisson", 0.6),
    ):
        (folder / f"{name}.h5").write_bytes(whole)
        with h5py.File(folder / f"{name}.h5", "r+") as f:
            f.attrs[attribute] = value


@pytest.fixture(scope="session")
def given(launcher, tmp_path_factory):
    """The files that rows name."""
    folder = tmp_path_factory.mktemp("given")
    (folder / "nan.csv").write_text("time,load_tx\n1,2\n2,nan\n")
    (folder / "good.csv").write_text("time,load_n\n1,500\n2,1000\n")
    (folder / "python.opts").write_text("-python\n")
    write_heights(folder)
    cases = dict(pull=np.zeros((6, 3)))
    compliances.write(folder / "body.h5", np.zeros((6, 3, 6, 3)), young=210e9, cases=cases)
    run_contacts(launcher, folder)
    (folder / "text.h5").write_text("height 1 2 3\n")
    (folder / "folder").mkdir()
    os.mkfifo(folder / "pipe")
    (folder / "zeros").write_bytes(bytes(2 << 20))
    return folder


def stamps(folder):
    """What changes with a file that is written, replaced or removed."""
    found = {path.name: path.lstat() for path in folder.iterdir()}
    return {name: (file.st_mode, file.st_ino, file.st_size, file.st_mtime_ns) for name, file in found.items()}


def copy(source, target):
    """A copy, or of what is no file a link."""
    shutil.copy(source, target) if stat.S_ISREG(os.stat(source).st_mode) else os.link(source, target)


def copy_all(source, target):
    shutil.copytree(source, target, symlinks=True, copy_function=copy, dirs_exist_ok=True)


def fill(folder, given):
    """All files that rows name, and results of an earlier run."""
    copy_all(given, folder)
    shutil.copy(given / "r.h5", folder / "results.h5")


@pytest.fixture(scope="session")
def kept(given, tmp_path_factory):
    """The folder of all rows that must leave its files as they are."""
    folder = tmp_path_factory.mktemp("kept")
    fill(folder, given)
    return folder


@pytest.fixture
def prepared(tmp_path, given, kept):
    """prepared(row): the folder in which that row runs: one for all rows that are rejected, which change no file."""
    before = stamps(kept)

    def prepare(row):
        folder = kept if row.code in (2, 3) else tmp_path
        if folder == tmp_path:
            copy_all(given, folder)
        for name, text in row.files.items():
            (folder / name).write_bytes(text)
        return folder

    yield prepare
    for name in stamps(kept).keys() - before.keys():
        (kept / name).unlink()
    if stamps(kept) != before:  # a row has a file of such a name, or has failed
        shutil.rmtree(kept)
        fill(kept, given)


def assert_answered(row, done, folder, before):
    """The message of petsam or petsam-stress."""
    told = [line for line in done.stderr.splitlines() if line.startswith(row.program + ": ")]
    others = [line for line in told if "_extrapolated = " not in line]  # an estimate of the grid's error
    says = row.says if row.code or row.says[0] == "note: " else ["warning: ", *row.says]
    assert told and all(text in told[0] for text in says), (says, told)
    assert len(told[0]) <= (400 if row.code else 480), told
    assert "PETSC ERROR" not in done.stderr and "HDF5-DIAG" not in done.stderr
    assert len(others or told) == (2 if row.code == 2 else 1), done.stderr
    if row.code in (2, 3):
        assert stamps(folder) == before, "files changed"
        assert row.code == 3 or not done.stdout, done.stdout
    else:
        assert (folder / "results.h5").exists()
    return told


def run(launcher, row, folder, ranks):
    """All lines of a run of petsam or petsam-stress on stderr that are its own."""
    before = stamps(folder)
    environment = dict(word.split("=", 1) for word in row.words if word.startswith("PETSC_OPTIONS="))
    line = [word for word in row.words if not word.startswith("PETSC_OPTIONS=")]
    done = execute(launcher, folder, line, ranks, row.code, environment, PROGRAM.with_name(row.program))
    told = assert_answered(row, done, folder, before)
    assert ranks > 1 or told == done.stderr.splitlines(), done.stderr
    return told


@pytest.mark.parametrize("row", rows_of("petsam"))
def test_message_names_what_is_wrong(launcher, prepared, row):
    run(launcher, row, prepared(row), 1)


@pytest.mark.parametrize("row", rows_of("petsam-stress"))
def test_message_of_petsam_stress_names_what_is_wrong(launcher, prepared, row):
    run(launcher, row, prepared(row), 1)


@pytest.mark.parametrize("row", [row for row in ROWS if row.values[0].parallel])
def test_message_of_three_ranks_is_told_once(launcher, prepared, row):
    assert len([line for line in run(launcher, row, prepared(row), 3) if row.says[0] in line]) == 1


@pytest.mark.parametrize("row", rows_of(*TOOLS))
def test_message_of_a_tool_is_one_line(call, prepared, monkeypatch, row):
    folder = prepared(row)
    monkeypatch.chdir(folder)
    before = stamps(folder)
    code, told = call(row.program, *row.words)
    assert code == row.code and len(told) == 1 and told[0].startswith(f"{row.program}: error: "), told
    assert all(text in told[0] for text in row.says) and "TRACEBACK" not in told[0], (row.says, told)
    assert stamps(folder) == before, "files changed"
