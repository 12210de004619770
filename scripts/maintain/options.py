"""The options of a program, from its own `-help json`: for the reference, the man page and the completion of options;
and those of a script, from its `--help`, for its man page.

    from options import read_options
    for group in read_options("build/bin/petsam"):
        for option in group.options:
            print(group.name, option.name, option.argument, option.text, option.default)

src/front/app/programhelp.c describes the whole, which read_help() returns; read_tool() returns the same of a script.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import textwrap
from dataclasses import dataclass
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[1]
WIDTH = 70  # columns of a script's usage
FIRST_GROUP = re.compile(r"\n\n(?=(?:positional arguments|options|optional arguments):\n  )")
ENTRY = re.compile(r"  (?P<head>\S.*?)(?:(?: {2,}|\n {3,})(?P<meaning>.*))?")


@dataclass
class Option:
    name: str  # with its dash
    argument: str  # <number>, <word>, <file>, [<bool>], ...; empty: no value
    text: str
    default: str | None  # None: no default, or the option is required, as the text then states
    words: list[str]  # allowed words; empty: no fixed words
    unit: str | None = None  # SI unit


@dataclass
class Group:
    name: str
    topic: str  # topic of -help
    options: list[Option]


def read_help(binary):
    """Returns the list as dictionaries and lists. A program that cannot run raises OSError or CalledProcessError."""
    done = subprocess.run([str(binary), "-help", "json"], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def groups_of(described):
    """Returns the groups in the result of read_help()."""
    return [
        Group(group["name"], group["topic"], [Option(**option) for option in group["options"]])
        for group in described["groups"]
    ]


def read_options(binary):
    """Returns the groups of options in the order of -help."""
    return groups_of(read_help(binary))


def read_usage(text):
    """Returns the usage of argparse in lines of WIDTH columns, which keep an option and its value together."""
    whole = re.sub(r"(--?\w[\w-]*) (?=[^\s\[|-])| (?=\.\.\.)", "\\1\0", text)
    indent = " " * (text.index(" ") + 1)
    lines = textwrap.wrap(whole, WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)
    return [line.replace("\0", " ") for line in lines]


def read_entry(entry):
    """Returns an option of argparse as `-help json` has them: -o NAME, --output NAME is the option -o, --output."""
    found = ENTRY.fullmatch(entry)
    parts = [part.partition(" ") for part in re.split(r", (?=-)", found["head"])]
    names, argument = ", ".join(name for name, _, _ in parts), parts[-1][2]
    return {"name": names, "argument": argument, "text": found["meaning"] or "", "default": None, "words": []}


def read_group(block):
    heading, *lines = block.split("\n")
    entries = re.sub(r"\n(?=  \S)", "\0", "\n".join(lines)).split("\0")
    name = heading[:1].upper() + heading[1:].rstrip(":")
    return {"name": name, "topic": "", "options": [read_entry(entry) for entry in entries]}


def read_tool(script):
    """Returns the --help of a script of argparse as read_help() returns that of a program."""
    wide = {**os.environ, "COLUMNS": "9999", "NO_COLOR": "1"}  # so that every text is in one line
    done = subprocess.run([sys.executable, str(script), "--help"], check=True, capture_output=True, text=True, env=wide)
    said, groups = FIRST_GROUP.split(done.stdout.strip(), maxsplit=1)
    usage, summary, rest = said.split("\n\n", 2)
    version = re.search(
        r'^__version__ = "(.*)"$', (SCRIPTS / "petsam/core/version.py").read_text(encoding="utf-8"), re.M
    )
    program = Path(script).name
    first = f"{program}: {summary[:1].lower()}{summary[1:]}"
    return {
        "program": program,
        "version": version[1],
        "usage": f"{first}\n\n{usage}\n\n{rest}",
        "synopsis": read_usage(usage.partition(": ")[2]),
        "groups": [read_group(block) for block in groups.split("\n\n")],
        "topics": [],
    }


def read_or_end(binary):
    """Reads the options for commands of `make install`: ends the program if the binary or the script cannot run."""
    is_script, command = False, "-help json"
    try:
        is_script = Path(binary).read_bytes()[:2] == b"#!"
        command = "--help" if is_script else command
        return read_tool(binary) if is_script else read_help(binary)
    except (OSError, subprocess.CalledProcessError, ValueError) as error:
        said = (getattr(error, "stderr", None) or "").strip()
        lacking = "the script has no man page" if is_script else "there is no man page and no completion"
        sys.exit(
            f"{binary} {command}: {error}{': ' if said else ''}{said}\n"
            f"Without it {lacking}; make install PAGES= installs the rest."
        )
