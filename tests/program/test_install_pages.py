"""Man pages and bash's completion of options as `make install` puts them: made from what the programs say by -help."""

import json
import re
import shutil
import subprocess
import sys

import pytest

from conftest import PROGRAM, environment, make_install
from support import ROOT

PROGRAMS = ("petsam", "petsam-stress")
TOOLS = tuple(
    f"petsam-{name}" for name in ("compliance", "fatigue", "fit", "joint", "loads", "plot", "study", "surface")
)
COMPLETE = """
. "$1"
function=$2
shift 2
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
$function "$1" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
printf '%s\\n' "${COMPREPLY[@]}"
"""


@pytest.fixture(scope="module")
def share(tmp_path_factory):
    folder = tmp_path_factory.mktemp("stage")
    make_install("prefix=/opt/p", f"DESTDIR={folder}")
    return folder / "opt" / "p" / "share"


def options_of(program):
    done = subprocess.run([str(PROGRAM.parent / program), "-help", "json"], capture_output=True, env=environment())
    groups = json.loads(done.stdout)["groups"]
    return {option["name"]: option for group in groups for option in group["options"]}


# ---- man pages


def page(share, program):
    return share / "man/man1" / f"{program}.1"


@pytest.mark.parametrize("program", PROGRAMS + TOOLS)
@pytest.mark.parametrize("command", ["groff -man -Tutf8 -ww -K utf8", "mandoc -T lint -W warning"])
def test_page_has_no_mistakes(share, program, command):
    if not shutil.which(command.split()[0]):
        pytest.skip(f"no {command.split()[0]}")
    done = subprocess.run([*command.split(), str(page(share, program))], capture_output=True, text=True)
    # a page made anew is the same page, so it has no date
    mistakes = [
        line for line in (done.stdout if "lint" in command else done.stderr).splitlines() if "missing date" not in line
    ]
    assert mistakes == [] and ("lint" in command or done.returncode == 0)


def shown(share, program):
    """The page as it is read, without groff if there is none: the requests taken out."""
    text = page(share, program).read_text()
    text = re.sub(r"^\.(TP|PP|nf|fi|RS.*|RE)\n", "", re.sub(r"\\f[BIP]", "", text), flags=re.M)
    for name, character in (("\\-", "-"), ("\\(ha", "^"), ("\\(ga", "`"), ("\\&", ""), ("\\e", "\\")):
        text = text.replace(name, character)
    return text


@pytest.mark.parametrize("program", PROGRAMS)
def test_page_has_every_option_with_its_default(share, program):
    lines = shown(share, program).splitlines()
    for name, option in options_of(program).items():
        k = lines.index(f"{name} {option['argument']}".strip())
        assert lines[k + 1] == option["text"] + (f" ({option['default']})" if option["default"] else "")


@pytest.mark.parametrize("program", PROGRAMS)
def test_page_has_the_sections_of_a_man_page(share, program):
    heads = [line.strip('"') for line in re.findall(r"^\.SH (.*)", page(share, program).read_text(), re.M)]
    assert heads[:4] == ["NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS"] and heads[-2:] == ["EXIT STATUS", "SEE ALSO"]
    assert re.search(
        r"^\.SH NAME\n" + re.escape(program.replace("-", "\\-")) + r" \\- \w", page(share, program).read_text(), re.M
    )
    synopsis = shown(share, program).split(".SH SYNOPSIS\n")[1].split(".SH")[0]
    assert max(map(len, synopsis.splitlines())) <= 80 and f"mpirun -n 4 {program} -" in synopsis
    assert ("LOAD HISTORIES" in heads) == (program == "petsam")


@pytest.mark.parametrize("program", TOOLS)
def test_page_of_a_script_has_what_its_help_says(share, program, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    done = subprocess.run([sys.executable, str(ROOT / "scripts" / program), "--help"], capture_output=True, text=True)
    text = shown(share, program)
    names = re.findall(r"^  (?:-[a-z](?: [^ ]+)?, )?(--[a-z][a-z0-9-]*)", done.stdout, re.M)
    tags = [line for line in text.split(".SH OPTIONS\n")[1].splitlines() if line.startswith("-")]
    assert (
        len(names) > 4
        and [name for name in names if not any(re.search(rf"(^|, ){name}( |,|$)", t) for t in tags)] == []
    )
    heads = [line.strip('"') for line in re.findall(r"^\.SH (.*)", text, re.M)]
    assert heads == ["NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "SEE ALSO"]
    words = " ".join(text.replace("\\\n", " ").split())
    last = done.stdout.strip().splitlines()[-1].split("  ")[-1].strip()
    assert last in words and f"NAME {program} - " in words and f"SYNOPSIS {program} " in words


def test_page_of_a_script_keeps_options_together_and_quotations_whole(share):
    assert re.search(r'\\\n +--sbatch "--time=2:00:00 --partition=short"\n', shown(share, "petsam-study"))
    synopsis = shown(share, "petsam-joint").split(".SH SYNOPSIS\n")[1].split(".SH")[0]
    assert re.search(r"\[--body1 MATERIAL\] ", synopsis, re.M)


def test_help_of_argparse_is_read(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "scripts/maintain"))
    import options

    for entry, name, argument in (
        ("  -o NAME.h5, --output NAME.h5  text", "-o, --output", "NAME.h5"),
        ("  -o, --output NAME.h5\n                    text", "-o, --output", "NAME.h5"),
        ("  --first-row {bottom,top}  text", "--first-row", "{bottom,top}"),
        ("  FILE.h5   text", "FILE.h5", ""),
    ):
        read = options.read_entry(entry)
        assert (read["name"], read["argument"], read["text"]) == (name, argument, "text")
    assert options.read_usage("p [-o NAME] [FILE ...] " + "[--k N] " * 12)[1].startswith("  [--k N] [")


def test_a_script_without_its_libraries_has_no_page_and_the_rest_is_installed(tmp_path):
    """The libraries are searched for in the Python that PYTHON names."""
    bare = tmp_path / "python"
    bare.write_text(f'#!/bin/sh\nexec "{sys.executable}" -S -E "$@"\n')
    bare.chmod(0o755)
    words = ["python3", str(ROOT / "scripts/maintain/manpage.py"), str(ROOT / "scripts/petsam-joint")]
    done = subprocess.run(words, capture_output=True, text=True, env={**environment(), "PYTHON": str(bare)})
    assert done.returncode == 1 and done.stdout == "" and "Traceback" not in done.stderr
    assert "has no numpy" in done.stderr and "Without it the script has no man page" in done.stderr


def test_page_keeps_commands_and_formulas(share):
    text = shown(share, "petsam")
    assert "\nTx = sum q_x dA    Ty =  sum q_y dA      Mz = sum (x q_y - y q_x) dA\n" in text
    assert "\n75\nstopped before the end" in text
    command = re.search(r"^petsam -grid_n.*?[^\\]$", text, re.M | re.S).group()
    assert max(map(len, command.splitlines())) <= 80
    assert f"{command.split('-output')[0][-1]}-output sphere.h5" in command and "\\\n" in command


def test_text_that_roff_would_obey_is_kept(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "scripts/maintain"))
    import manpage

    assert manpage.escape(".opts or 'x' -a \\n") == "\\&.opts or 'x' \\-a \\en"
    assert manpage.escape("'x'") == "\\&'x'"
    assert manpage.command("petsam " + "-a 1 " * 30)[1].startswith("    -a 1")
    assert manpage.entries(["  a  one", "     more", "  b  two"]) == [("a", "one more"), ("b", "two")]
    assert manpage.entries(["  a  one", "  b  two  three"]) is None
    assert manpage.entries(["    a  one", "    b", "    c  three"]) is None


# ---- completion


def complete(share, program, *line, function=None):
    """What bash offers for the last word of a line."""
    place = share / "bash-completion/completions" / program
    function = function or "_" + program.replace("-", "_")
    words = ["bash", "--norc", "-c", COMPLETE, "bash", str(place), function, *line]
    done = subprocess.run(words, capture_output=True, text=True, env=environment(), timeout=60)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    return done.stdout.split("\n")[:-1] if done.stdout.strip() else []


@pytest.mark.parametrize("program", PROGRAMS)
def test_options_are_completed(share, program):
    known = options_of(program)
    assert sorted(complete(share, program, program, "-")) == sorted(known)
    assert complete(share, program, program, "-quiet", "-out") == [name for name in known if name.startswith("-out")]


@pytest.mark.parametrize("program", PROGRAMS)
def test_values_of_every_option_are_completed(share, program, tmp_path, monkeypatch):
    """By what it takes: its words, files, or nothing, as for numbers; where it may be left out, the next option."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a file.h5").touch()
    (tmp_path / "folder").mkdir()
    known = options_of(program)
    for name, option in known.items():
        offered = complete(share, program, program, name, "")
        if name == "-help":
            assert "exit_codes" in offered and "-quiet" not in offered
        elif option["argument"] == "<file>":
            assert sorted(offered) == ["a file.h5", "folder"], name
        elif option["argument"] in ("", "[<viewer>]"):
            assert offered == list(known), name
        else:
            assert offered == option["words"], name
        following = complete(share, program, program, name, "-quie")
        assert following == (["-quiet"] if option["argument"][:1] in ("", "[") else []), name


def test_words_between_commas_are_completed_once(share):
    offered = complete(share, "petsam-stress", "petsam-stress", "-fatigue", "swt,dang_van,")
    assert offered == [f"swt,dang_van,{name}" for name in ("crossland", "findley", "fatemi_socie", "ruiz")]
    assert complete(share, "petsam", "petsam", "-output_fields", "pressure,shear_x,sta") == ["pressure,shear_x,state"]
    assert complete(share, "petsam", "petsam", "-output_fields", "state,sta") == []


def test_topics_of_the_help_are_completed(share):
    assert complete(share, "petsam", "petsam", "-help", "ta") == ["tangential"]
    (topic,) = complete(share, "petsam", "petsam", "-help", "exi")
    done = subprocess.run([str(PROGRAM), "-help", topic], capture_output=True, text=True, env=environment())
    assert done.returncode == 0 and "gross slip" in done.stdout


def test_bash_uses_the_function_for_the_program(share):
    for program in PROGRAMS + TOOLS:
        place = share / "bash-completion/completions" / program
        done = subprocess.run(
            ["bash", "--norc", "-c", f'. "{place}"; complete -p {program}'], capture_output=True, text=True
        )
        assert done.returncode == 0 and program in done.stdout, done.stderr


def tool(share, name, *line):
    """With the Python of this test, as the installed script's own may lack the libraries."""
    return complete(share, name, str(ROOT / "scripts" / name), *line, function="_petsam_tool")


@pytest.mark.parametrize(
    "name, some",
    [
        ("petsam-compliance", {"--mesh", "--contact", "--fixed", "--no-stress"}),
        ("petsam-plot", {"--maps", "--fretting-log", "--whole-grid", "--output", "--dpi"}),
        ("petsam-study", {"--directory", "--skip-failed", "--slurm", "--cycle"}),
        ("petsam-surface", {"--body", "--first-row", "--grid-n", "--no-picture"}),
    ],
)
def test_long_options_of_the_tools_are_completed(share, name, some, monkeypatch):
    monkeypatch.setenv("PYTHON", sys.executable)
    offered = tool(share, name, "--")
    said = subprocess.run([str(ROOT / "scripts" / name), "--help"], capture_output=True, text=True).stdout
    assert some <= set(offered) and tool(share, name, "--he") == ["--help"]
    # not what is only mentioned, as options of sbatch are
    assert all(re.search(rf"^  (-\w( \S+)?, )?{option}\b", said, re.M) for option in offered)


def test_words_of_the_tools_options_are_completed(share, monkeypatch):
    monkeypatch.setenv("PYTHON", sys.executable)
    assert tool(share, "petsam-plot", "--component", "p") == ["principal_1", "principal_2", "principal_3"]
    assert (
        tool(share, "petsam-surface", "--level", "")
        == "none mean tilt second-order sphere cylinder rows columns".split()
    )
    assert tool(share, "petsam-plot", "--step", "") == []  # then bash completes files


def test_behind_two_dashes_petsam_study_takes_petsams_options(share):
    assert tool(share, "petsam-study", "cases.csv", "--", "-grid_n", "64", "-gap_type", "pu") == ["punch"]


# ---- without the programs


@pytest.mark.parametrize("script", ["manpage.py", "completion.py"])
@pytest.mark.parametrize("program, says", [("/bin/false", "exit status 1"), ("/nowhere", "No such file")])
def test_program_that_does_not_run_is_told_with_the_remedy(script, program, says):
    done = subprocess.run(
        [sys.executable, str(ROOT / "scripts/maintain" / script), program], capture_output=True, text=True
    )
    assert done.returncode == 1 and done.stdout == ""
    assert says in done.stderr and "make install PAGES=" in done.stderr and "Traceback" not in done.stderr


def test_pages_may_be_left_out(tmp_path):
    make_install("prefix=/p", f"DESTDIR={tmp_path}", "PAGES=")
    assert (tmp_path / "p/bin/petsam").exists() and not list((tmp_path / "p/share").glob("man/**/*.1"))


def test_the_reference_can_be_made_of_read_options():
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]); from options import read_options\n"
        "for group in read_options(sys.argv[2]):\n"
        "    for option in group.options: print(group.name, option.name, option.default, sep=': ')"
    )
    words = [sys.executable, "-B", "-c", code, str(ROOT / "scripts/maintain"), str(PROGRAM)]
    lines = subprocess.run(words, capture_output=True, text=True, env=environment()).stdout.splitlines()
    assert {"Grid: -grid_center: 0,0", "Grid: -grid_n: None", "Contact: -edges: reconstruct"} <= set(lines)
