"""The options of a program, from its own -help: for the reference, the man page and the completion of options.

    from options import read_options
    for group in read_options("build/bin/petsam"):
        for option in group.options: print(group.name, option.name, option.default)
"""

from __future__ import annotations

import re
import subprocess
from dataclasses import dataclass, field


@dataclass
class Option:
    name: str  # with its dash
    argument: str  # <number>, <word>, [<bool>], ...
    text: str
    default: str | None  # None: required, or there is none


@dataclass
class Group:
    name: str
    options: list[Option] = field(default_factory=list)


def read_help(binary):
    return subprocess.run([str(binary), "-help"], check=True, capture_output=True, text=True).stdout


def read_options(binary):
    """Groups of options in the order of -help."""
    groups, option = [], None
    for line in read_help(binary).splitlines():
        entry = re.fullmatch(r"  (-[a-z]\w*) (\S+?)(?:\s+(\S.*))?", line)
        if entry and groups:
            option = Option(entry[1], entry[2], entry[3] or "", None)
            groups[-1].options.append(option)
        elif option and not option.text and line.startswith(" " * 40):
            option.text = line.strip()
        elif re.fullmatch(r"[A-Z][\w ]*", line):
            groups.append(Group(line))
    for group in groups:
        for option in group.options:
            option.text, option.default = split_default(option.text)
    return groups


def split_default(text):
    """A text's description and its default, the last parentheses, unless these hold only the unit."""
    found = re.fullmatch(r"(.*) \(([^()]*)\)", text)
    if not found or "required" in text or found[2] in ("Pa", "m", "N", "N m", "rad", "1/Pa", "m3/J"):
        return text, None
    return found[1], found[2]
