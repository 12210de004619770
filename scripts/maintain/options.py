"""The options of a program, from its own `-help json`: for the reference, the man page and the completion of options.

    from options import read_options
    for group in read_options("build/bin/petsam"):
        for option in group.options:
            print(group.name, option.name, option.argument, option.text, option.default)

src/front/app/help.c describes the whole, which read_help() returns.
"""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import dataclass


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


def read_or_end(binary):
    """Reads the options for commands of `make install`: ends the program if the binary cannot run."""
    try:
        return read_help(binary)
    except (OSError, subprocess.CalledProcessError, ValueError) as error:
        said = (getattr(error, "stderr", None) or "").strip()
        sys.exit(
            f"{binary} -help json: {error}{': ' if said else ''}{said}\n"
            "Without it there is no man page and no completion; make install PAGES= installs the rest."
        )
