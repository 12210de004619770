#!/usr/bin/env python3
"""Runs the code blocks of the Markdown files, and compares what they print with the figures in the text.

    build/venv/bin/python scripts/maintain/check_readmes.py [--build build] [--all] [--keep] [file ...]

Everything runs in a copy of the files, in /tmp, with links to what is built. In the order of a file, a block in sh runs
in the copy's root, one in python after the earlier ones of its file; figures in the comment behind a print() are
compared. Other blocks are text. A comment above a block or a table adds conditions:

    <!-- not run: why -->         the block does not run
    <!-- slow: how long -->       it runs with --all only
    <!-- exit code 12 -->         its last command ends so, instead of with 0
    <!-- in this folder -->       it runs in the folder of its file, after make install prefix=$HOME/petsam
    <!-- file: NAME -->           the text below is saved under this name, in build/run
    <!-- printed -->              what ran in this file has printed the figures of the table below, or the lines of the
                                  text, in which ... stands for anything. Figures agree when they differ by at most one
                                  in the last digit that is written; those below 1e-11 are left by rounding.
    <!-- printed but: WORD, ... --> the same without lines, rows and columns that contain one of the words
    <!-- printed row by row -->   the figures of each row of a table are in one printed line; also with but: WORD, ...
    <!-- slow printed -->         the same, with --all only; also with the words above

and one that stands for itself:

    <!-- run: COMMAND -->         runs a command whose text is in a paragraph; <!-- slow run: COMMAND --> with --all
    <!-- after: FILE, ... -->     those files are checked first; what they make and print is there

Exit code 1 when a command ends otherwise or writes to the root of the repository, or a figure differs.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
TIMEOUT = 3600  # seconds for a block, as the machine may be busy
NOISE = 1e-11  # smaller figures are rounding
FIGURE = re.compile(r"(?<![\w.])[-+]?\d+(?:,\d{3})*(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.]*\d)", re.I)
COMMENT = re.compile(
    r"<!-- (not run|slow run|run|slow printed|printed|slow|exit code|in this folder|file|after)\b:? ?(.*?) ?-->$"
)


class Piece(NamedTuple):
    """A block of code (kind: its language), a table, or a comment that is a command; marks: comment to text."""

    kind: str
    text: str
    marks: dict
    line: int


def read_pieces(text):
    """Blocks, tables and commands of a Markdown file in their order."""
    pieces, marks, lines, at = [], {}, text.split("\n"), 0
    while at < len(lines):
        line, start = lines[at], at
        if found := COMMENT.match(line):
            name, words = found.groups()
            if name in ("run", "slow run", "after"):
                pieces.append(Piece(name, words, {}, start + 1))
            else:
                marks[name] = words
        elif line.startswith("```"):
            while lines[at + 1] != "```":
                at += 1
            pieces.append(Piece(line[3:], "\n".join(lines[start + 1 : at + 1]) + "\n", marks, start + 1))
            marks, at = {}, at + 1
        elif line.startswith("|"):
            while at + 1 < len(lines) and lines[at + 1].startswith("|"):
                at += 1
            pieces.append(Piece("table", "\n".join(lines[start : at + 1]), marks, start + 1))
            marks = {}
        elif line:
            if marks:
                raise ValueError(f"line {at}: no block or table below the comment")
        at += 1
    return pieces


# ---------------------------------------------------------------- figures


def figures(text):
    """Returns the figures in a text as written, without commas between thousands."""
    return [word.replace(",", "") for word in FIGURE.findall(text.replace("−", "-"))]


def last_digit(word):
    """Returns the value of one unit in the last digit of a figure."""
    mantissa, _, exponent = word.lower().partition("e")
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def agree(word, value):
    """Returns true if a figure as written agrees with a printed one."""
    written = float(word)
    if 0 < abs(written) < NOISE:
        return abs(value) < NOISE
    return abs(written - value) <= 1.001 * last_digit(word) + 1e-12 * abs(written)


def missing(words, values):
    """Returns the figures that agree with none of the values; a figure without a sign may be an absolute value."""
    sizes = [*values, *map(abs, values)]
    return [word for word in words if not any(agree(word, value) for value in (values if word[0] in "+-" else sizes))]


def differences_of_text(text, output, but=()):
    """Returns the lines of text that match no line of the output: same words and figures; `...` matches anything."""
    lines = [(line.split(), [float(word) for word in figures(line)]) for line in output.splitlines()]

    def stands(words, wanted, printed, values):
        known = [word for word in words if word.strip(",") != "..."]
        if len(known) < len(words):
            return all(word in printed for word in known if not figures(word)) and not missing(wanted, values)
        shape = [word for word in words if not figures(word)]
        return (
            shape == [word for word in printed if not figures(word)]
            and len(wanted) == len(values)
            and all(map(agree, wanted, values))
        )

    left = [line for line in text.splitlines() if line.strip() and not any(word in line for word in but)]
    return [line for line in left if not any(stands(line.split(), figures(line), *printed) for printed in lines)]


def differences_of_table(text, output, but=(), by_row=False):
    """Returns rows, except the head, with figures missing in the output or in each of its lines; and these figures."""
    rows = [[cell.strip() for cell in re.split(r"(?<!\\)\|", row)[1:-1]] for row in text.splitlines()]
    columns = [i for i, head in enumerate(rows[0]) if not any(word in head for word in but)]
    lines = [[float(word) for word in figures(line)] for line in (output.splitlines() if by_row else [output])]
    out = []
    for row in rows[2:]:
        if any(word in cell for word in but for cell in row):
            continue
        words = figures(" | ".join(row[i] for i in columns))
        if left := min((missing(words, values) for values in lines), key=len, default=words):
            out.append(f"{' | '.join(row)}: not printed: {', '.join(left)}")
    return out


def nearest(line, output):
    """Returns the line of the output that has most of a line's words and figures."""
    words, wanted = set(line.split()), figures(line)

    def alike(printed):
        values = [float(word) for word in figures(printed)]
        return (len(wanted) == len(values)) + len(words & set(printed.split())) - len(missing(wanted, values))

    return max(output.splitlines(), key=alike, default="")


# ---------------------------------------------------------------- running


# variables of the environment that commands of pages do not get: those of make are of the make that checks the pages
NOT_OF_PAGES = {"PYTHON", "PETSAM", "ARGS", "MAKEFLAGS", "MAKEOVERRIDES", "MFLAGS", "MAKELEVEL"}


class Checker:
    def __init__(self, build, every, folder):
        self.every, self.failures, self.folder = every, 0, folder
        self.tree, self.home = self.folder / "petsam", self.folder / "home"
        self.home.mkdir(parents=True)
        self.copy(build.resolve())
        self.environment = {key: value for key, value in os.environ.items() if key not in NOT_OF_PAGES}
        self.environment.update(
            HOME=str(self.home), OMP_NUM_THREADS="1", OMPI_MCA_rmaps_base_oversubscribe="1",
            OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
        )  # fmt: skip
        self.installed = False
        self.printed = {}  # by the files checked so far

    def copy(self, build):
        """Copies the sources that git lists, and links to the build, so that results go to the copy."""
        listed = subprocess.run(
            ["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True
        )
        for name in listed.stdout.split("\n"):
            if name and (ROOT / name).is_file():
                (self.tree / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(ROOT / name, self.tree / name)
        (self.tree / "build/run").mkdir(parents=True)
        for name in ("bin", "lib", "obj", "venv", "bench", "peers"):
            if (build / name).exists():
                (self.tree / "build" / name).symlink_to(build / name)

    def fail(self, file, piece, *said):
        self.failures += 1
        print(f"{file}:{piece.line}: " + "\n    ".join(said), flush=True)

    def run(self, file, piece, command, code=0, folder=None):
        """Returns a command's output; all commands run in one shell that stops at the first error."""
        start = time.time()
        try:
            done = subprocess.run(
                ["bash", "-ec", command], cwd=folder or self.tree, env=self.environment, stdin=subprocess.DEVNULL,
                capture_output=True, text=True, errors="replace", timeout=TIMEOUT,
            )  # fmt: skip
            ended, said = done.returncode, done.stdout + done.stderr
        except subprocess.TimeoutExpired:
            ended, said = None, f"no end after {TIMEOUT} s"
        if ended != code:
            self.fail(
                file, piece, f"exit code {ended}, expected {code}", *command.splitlines()[:3], *said.splitlines()[-5:]
            )
        print(f"  {time.time() - start:6.1f} s  {file}:{piece.line}", flush=True)
        return said

    def install(self, file, piece):
        if not self.installed:
            self.run(file, piece, f"make install prefix={self.home}/petsam", folder=self.tree)
            self.installed = True

    def run_sh(self, file, piece):
        folder = self.tree
        if "in this folder" in piece.marks:
            self.install(file, piece)
            folder = (self.tree / file).parent
        return self.run(file, piece, piece.text, int(piece.marks.get("exit code", 0)), folder)

    def run_python(self, file, piece, earlier):
        script = self.folder / "block.py"
        mark = "---- this block ----"
        script.write_text(earlier + f"\nprint({mark!r})\n" + piece.text)
        said = self.run(file, piece, f"build/venv/bin/python {script}").partition(mark)[2]
        for line in piece.text.splitlines():
            if "print(" in line and "#" in line:
                if left := missing(figures(line.partition("#")[2]), [float(word) for word in figures(said)]):
                    self.fail(file, piece, f"not printed: {', '.join(left)}", said.strip())
        return said

    def compare(self, file, piece, output):
        words = piece.marks.get("printed", piece.marks.get("slow printed", ""))
        but = [word.strip() for word in words.partition("but:")[2].split(",") if word.strip()]
        if piece.kind == "table":
            left = differences_of_table(piece.text, output, but, "row by row" in words)
        else:
            left = differences_of_text(piece.text, output, but)
        if left:
            pairs = [(line, f"  printed: {nearest(line, output).strip()}") for line in left]
            self.fail(file, piece, "not as printed:", *(text for pair in pairs for text in pair))

    def check(self, file):
        """Runs and compares all blocks of one file, once; returns its output."""
        if file in self.printed:
            return self.printed[file]
        output, earlier = "", ""
        for piece in read_pieces((ROOT / file).read_text()):
            slow = piece.kind == "slow run" or {"slow", "slow printed"} & set(piece.marks)
            if "not run" in piece.marks or (slow and not self.every):
                continue
            if piece.kind == "after":
                for other in piece.text.split(","):
                    output += self.check(other.strip())
            elif "file" in piece.marks:
                (self.tree / piece.marks["file"]).write_text(piece.text)
            elif {"printed", "slow printed"} & set(piece.marks):
                self.compare(file, piece, output)
            else:
                output += self.run_piece(file, piece, earlier)
                earlier += piece.text if piece.kind == "python" else ""
        self.printed[file] = output
        return output

    def run_piece(self, file, piece, earlier):
        """Returns the output of a block; it fails if the block leaves anything new in the tree's root."""
        before = {path.name for path in self.tree.iterdir()}
        said = self.run_kind(file, piece, earlier)
        if new := sorted({path.name for path in self.tree.iterdir()} - before):
            self.fail(file, piece, f"writes to the root of the repository, not to build/run: {', '.join(new)}")
        return said

    def run_kind(self, file, piece, earlier):
        """Returns the output of a block; nothing for a table or a text."""
        if piece.kind in ("run", "slow run"):
            return self.run(file, piece, piece.text)
        if piece.kind == "sh":
            return self.run_sh(file, piece)
        return self.run_python(file, piece, earlier) if piece.kind == "python" else ""


def markdown_files():
    """Returns the Markdown files of the sources, README.md first."""
    listed = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard", "*.md"], cwd=ROOT, capture_output=True, text=True
    )
    names = [name for name in listed.stdout.split("\n") if name and (ROOT / name).is_file()]
    return sorted(names, key=lambda name: (name.count("/"), name))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="*", help="some of the Markdown files, by their paths")
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument("--all", action="store_true", help="what takes more than about a minute too")
    parser.add_argument("--keep", action="store_true", help="keep the copy with all that was made in it")
    arguments = parser.parse_args()
    folder = Path(tempfile.mkdtemp(prefix="petsam-readmes-"))
    checker = Checker(arguments.build, arguments.all, folder)
    try:
        for file in markdown_files():
            if not arguments.files or file in arguments.files:
                checker.check(file)
    finally:
        if arguments.keep:
            print(f"kept: {checker.tree}")
        else:
            shutil.rmtree(folder)
    print(f"{checker.failures} differences")
    sys.exit(checker.failures > 0)


if __name__ == "__main__":
    main()
