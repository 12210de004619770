"""The manual: links, options, and the script that runs its commands (scripts/maintain/check_readmes.py)."""

import os
import re
import subprocess
import sys

import pytest

from conftest import PROGRAM
from support import ROOT, dead_links, finished

sys.path.insert(0, str(ROOT / "scripts" / "maintain"))
import check_readmes  # noqa: E402
from options import Option  # noqa: E402

import reference  # noqa: E402

FILES = [
    *ROOT.glob("*.md"),
    *(file for folder in ("examples", "include", "scripts", "src", "tests") for file in ROOT.glob(f"{folder}/**/*.md")),
]


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(ROOT)))
def test_links_lead_to_files_and_headings_that_exist(file):
    assert dead_links(file) == []


def test_a_dead_link_is_found(tmp_path):
    (tmp_path / "other.md").write_text("# One, two\n")
    file = tmp_path / "some.md"
    file.write_text("[a](other.md#one-two) [b](other.md#three) [c](gone.md) [d](https://example.com)\n")
    assert dead_links(file) == ["other.md#three", "gone.md"]


def test_every_part_of_the_manual_is_reached_from_README():
    seen, left = set(), [ROOT / "README.md"]
    while left:
        file = left.pop()
        if file in seen or file.suffix != ".md":
            continue
        seen.add(file)
        links = re.findall(r"\]\(([^)#]+)[^)]*\)", file.read_text())
        left += [(file.parent / link).resolve() for link in links if not link.startswith("http")]
    assert set(FILES) <= seen


def test_README_is_short():
    lines = (ROOT / "README.md").read_text().splitlines()
    assert len(lines) <= 120 and not [line for line in lines if len(line) > 150 and not line.startswith("|")]


# ---------------------------------------------------------------- the reference of options


def test_the_reference_of_options_is_what_help_says():
    script = ROOT / "scripts/maintain/reference.py"
    words = [sys.executable, str(script), "--check", "--build", str(PROGRAM.parents[1])]
    finished(words)


def test_the_reference_is_written_where_it_has_changed(tmp_path, monkeypatch):
    """So that make takes nothing for older than a file that is the same."""
    copies = {name: tmp_path / getattr(reference, name).name for name in ("REFERENCE", "DECLARED")}
    for name, copy in copies.items():
        copy.write_text(getattr(reference, name).read_text())
        os.utime(copy, (1e9, 1e9))
        monkeypatch.setattr(reference, name, copy)
    monkeypatch.setattr(sys, "argv", ["reference.py", "--build", str(PROGRAM.parents[1])])
    reference.main()
    assert all(copy.stat().st_mtime == 1e9 for copy in copies.values())
    text = copies["DECLARED"].read_text()
    copies["DECLARED"].write_text(text + "# old\n")
    reference.main()
    assert copies["DECLARED"].read_text() == text and copies["REFERENCE"].stat().st_mtime == 1e9


def test_options_of_a_group_become_a_table():
    group = [
        Option("-a", "<number>", "length (m): required", None, []),
        Option("-b", "[<bool>]", "said (off) if asked, or on|off", "false", ["true", "false"]),
    ]
    assert reference.fill("x\n<!-- petsam: Some group -->\nold\n<!-- end -->\n", {("petsam", "Some group"): group}) == (
        "x\n<!-- petsam: Some group -->\n| option | meaning | default |\n| --- | --- | --- |\n"
        "| `-a <number>` | length (m) | required |\n"
        "| `-b [<bool>]` | said (off) if asked, or on\\|off | false |\n<!-- end -->\n"
    )


def test_options_of_both_bodies_that_are_alike_have_one_row():
    texts = {"-body1_e": "E (Pa) of body 1", "-body2_e": "E (Pa) of body 2", "-gap_r1": "one", "-gap_r2": "other"}
    lines = reference.table([Option(name, "<number>", text, "0", []) for name, text in texts.items()]).splitlines()
    assert lines[2:] == [
        "| `-body1_e`, `-body2_e`: `<number>` | E (Pa) | 0 |",
        "| `-gap_r1 <number>` | one | 0 |",
        "| `-gap_r2 <number>` | other | 0 |",
    ]


def test_units_are_declared_once_for_scripts():
    options = {
        "A": [Option("-a", "", "", None, [], "m"), Option("-slope", "", "", None, [], "1")],
        "B": [Option("-b", "", "", None, []), Option("-line", "", "", None, [], "N m/m")],
    }
    units, module = {"N": {"N": 0, "kN": 3}, "N m/m": {"N": 0, "Nm/m": 0}}, {}
    described = {"units": units, "constants": [], "materials": []}
    exec(reference.declared(described, {("petsam", group): one for group, one in options.items()}), module)
    assert module["OPTIONS"] == {"a": "m", "line": "N m/m"}
    assert module["FOLLOWING"] == {"N": ("N", 0), "kN": ("N", 3), "Nm/m": ("N m/m", 0)}


@pytest.mark.parametrize("text", ["", "<!-- petsam: A -->\n<!-- end -->\n<!-- petsam: B -->\n<!-- end -->\n"])
def test_a_group_without_a_table_and_a_table_without_a_group_are_errors(text):
    with pytest.raises(ValueError):
        reference.fill(text, {("petsam", "A"): []})


# ---------------------------------------------------------------- commands and figures


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(ROOT)))
def test_blocks_say_what_they_are(file):
    """So that none is left out by check_readmes; blocks by indentation would be."""
    pieces = check_readmes.read_pieces(file.read_text())
    assert {piece.kind for piece in pieces} <= {"sh", "python", "text", "table", "run", "slow run", "after"}
    plain = re.sub(r"^```.*?^```$", "", file.read_text(), flags=re.M | re.S)
    assert not re.search(r"\n\n    \S", plain)


def test_figures_agree_to_the_last_digit_that_is_written():
    assert check_readmes.figures("a -0.5 % of 2,700 (1.4e-6), x512 and 3e8") == ["-0.5", "2700", "1.4e-6", "3e8"]
    for word, value in ("2.36", 2.357), ("1.4e-6", 1.449e-6), ("100", 100.9), ("4.3e-19", -2e-17), ("0.25", 0.26):
        assert check_readmes.agree(word, value), word
    for word, value in ("2.36", 2.3749), ("1.4e-6", 1.51e-6), ("100", 102), ("4.3e-9", -2e-9), ("0.25", -0.25):
        assert not check_readmes.agree(word, value), word


def test_commands_of_pages_do_not_get_the_arguments_of_the_check(monkeypatch, tmp_path):
    """`make check-readmes ARGS=--all` runs pages that call make."""
    monkeypatch.setenv("ARGS", "--all")
    monkeypatch.setenv("MAKEFLAGS", " -- ARGS=--all")
    environment = check_readmes.Checker(PROGRAM.parents[1], False, tmp_path).environment
    assert "ARGS" not in environment and "MAKEFLAGS" not in environment and "PATH" in environment


def test_a_line_of_text_is_one_printed_line():
    output = "stick 1.23456 m2, N 10\nstick 2.5 m2, N 20\n"
    assert check_readmes.differences_of_text("stick 1.2346 m2, N 10\nstick ... 20\nstick ..., N 20\n", output) == []
    for line in "stick 1.2346 m2, N 20", "slip 2.5 m2, N 20", "stick 2.5 m2, N", "stick ... 30":
        assert check_readmes.differences_of_text(line, output) == [line]
    assert check_readmes.differences_of_text("time 1 s", output, ["time"]) == []


def test_the_rows_of_a_table_have_been_printed():
    text = "| a | b | time |\n| --- | --- | --- |\n| 1 | 2.5 | 7 |\n| x | 3.1, 40 % | 8 |"
    assert check_readmes.differences_of_table(text, "1 2.51\n3.1 and 40", ["time"]) == []
    said = check_readmes.differences_of_table(text, "1 2.7\n3.1 and 40", ["time"])
    assert len(said) == 1 and said[0].endswith("not printed: 2.5")
    assert check_readmes.differences_of_table(text, "1 2.51\n3.1\n40", ["time"], True)[0].endswith(": 40")
    assert check_readmes.missing(["40", "-50", "+40", "50"], [-40.0, 50.0]) == ["-50", "+40"]


# ---------------------------------------------------------------- the root of the repository

AT_ROOT = {
    ".clang-format",
    ".gitignore",
    ".ruff.toml",
    "CHANGES.md",
    "CITATION.cff",
    "LICENSE",
    "Makefile",
    "README.md",
}
WRITING = r"(?:-output|--output|--report|-o|-d|--directory|-checkpoint|--csv|>>?) +([^\s'\"]+)"


def test_no_results_and_nothing_else_unexpected_are_in_git():
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True)
    if listed.returncode:
        pytest.skip("no repository of git")
    names = listed.stdout.splitlines()
    assert [name for name in names if name.endswith(".h5") and not name.startswith("tests/")] == []
    assert {name for name in names if "/" not in name} == AT_ROOT


def commands(file):
    """The commands of a page that run in the repository's root, continued lines joined."""
    for piece in check_readmes.read_pieces(file.read_text()):
        if piece.kind in ("sh", "run", "slow run") and not {"in this folder", "not run"} & set(piece.marks):
            yield from piece.text.replace("\\\n", " ").splitlines()


def writes_to_root(command):
    """Whether a command writes to the current folder, by name or by the default of its tool."""
    named = re.findall(WRITING, command)
    by_default = re.search(r"\bpetsam-(?:plot|study|fatigue|surface|compliance) ", command) and not named
    return bool(by_default) or not all("/" in name for name in named)


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(ROOT)))
def test_no_command_of_the_pages_writes_to_the_root(file):
    assert [command for command in commands(file) if writes_to_root(command)] == []


def test_a_command_that_writes_to_the_root_is_found():
    for command in (
        "petsam -output a.h5",
        "scripts/petsam-plot build/run/a.h5",
        "seq 5 > a.csv",
        "petsam -checkpoint a.h5",
    ):
        assert writes_to_root(command), command
    assert not writes_to_root("scripts/petsam-plot -o build/run/a.png build/run/a.h5")


@pytest.fixture
def checked(tmp_path, monkeypatch):
    """checked(text, every=False): differences of a file, and what its commands left in the copy."""

    def run(text, every=False):
        monkeypatch.setattr(check_readmes, "ROOT", tmp_path)
        (tmp_path / "README.md").write_text(text)
        checker = check_readmes.Checker(PROGRAM.parents[1], every, tmp_path / f"copy{every}")
        checker.check("README.md")
        return checker.failures, checker.tree

    return run


def test_commands_run_where_and_when_they_should(checked):
    failures, tree = checked(
        "<!-- file: build/run/a.txt -->\n```text\n12.5\n```\n\n```sh\ncd build/run\ncat a.txt > b.txt\ncat b.txt\n```\n"
        "<!-- printed -->\n```text\n12.5\n```\n<!-- not run: why -->\n```sh\ntouch build/run/c\n```\n"
        "<!-- slow: years -->\n```sh\ntouch build/run/d\n```\n<!-- exit code 3 -->\n```sh\nexit 3\n```\n"
        "text\n<!-- run: touch build/run/e -->\n"
    )
    assert failures == 0 and sorted(path.name for path in tree.glob("build/run/*")) == ["a.txt", "b.txt", "e"]


@pytest.mark.parametrize(
    "text",
    [
        "```sh\nfalse\ntrue\n```\n",
        "```sh\ntouch loop.h5\n```\n",
        "<!-- exit code 3 -->\n```sh\ntrue\n```\n",
        "```sh\necho 2\n```\n<!-- printed -->\n```text\n4\n```\n",
        "```sh\necho 2\n```\n<!-- printed -->\n| a |\n| - |\n| 4 |\n",
    ],
)
def test_untruths_are_differences(checked, text):
    assert checked(text)[0] == 1


def test_slow_ones_run_on_demand(checked):
    text = "<!-- slow: years -->\n```sh\necho 2\n```\n<!-- slow printed -->\n```text\n4\n```\n"
    assert checked(text)[0] == 0 and checked(text, every=True)[0] == 1
