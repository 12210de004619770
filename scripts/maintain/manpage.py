#!/usr/bin/env python3
"""Writes the man page of petsam or petsam-stress, from its -help, or of a script, from its --help.

    python3 scripts/maintain/manpage.py build/bin/petsam > petsam.1
    python3 scripts/maintain/manpage.py scripts/petsam-plot > petsam-plot.1

`make install` does it. A topic of -help with options becomes the text before these, one without a section of its own.
"""

import re
import sys
from pathlib import Path

import options

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from petsam import apps, plot  # noqa: E402

TITLES = {"history": "LOAD HISTORIES", "exit codes": "EXIT STATUS"}
SEE_ALSO = {"petsam": ("petsam-stress",), "petsam-stress": ("petsam",)}  # of the programs in C; others have records
WIDTH = 70  # columns of commands
OPTION = re.compile(r' +(?=--?[a-z])(?=(?:[^"]*"[^"]*")*[^"]*$)')  # where a command may be broken: not in a quotation


def escape(text):
    """Text that roff does not interpret."""
    for character, name in (("\\", "\\e"), ("-", "\\-"), ("^", "\\(ha"), ("~", "\\(ti"), ("`", "\\(ga")):
        text = text.replace(character, name)
    return re.sub(r"^(?=[.'])", "\\&", text)


def command(line):
    """A command in lines of a terminal's width; an option stays with its value."""
    lines = [""]
    for word in OPTION.split(line):
        if lines[-1] and len(lines[-1]) + len(word) > WIDTH:
            lines[-1] += " \\"
            lines.append("    ")
        lines[-1] += (" " if lines[-1].strip() else "") + word
    return lines


def entries(lines):
    """Returns pairs of a key and its text if all lines consist of these; deeper lines continue a text; else None."""
    pairs = []
    deeper = re.match(" *", lines[0]).group() + " "
    for line in lines:
        parts = re.split(r" {2,}", line.strip())
        if line.startswith(deeper) and len(parts) == 1:
            pairs[-1] = (pairs[-1][0], f"{pairs[-1][1]} {parts[0]}")
        elif len(parts) == 2:
            pairs.append(tuple(parts))
        else:
            return None
    return pairs


def literal(lines):
    """Formats lines that begin with two spaces: a list, or commands and tables without change."""
    pairs = entries(lines)
    if pairs:
        return [line for key, text in pairs for line in (".TP", f"\\fB{escape(key)}\\fP", escape(text))] + [".PP"]
    text = re.sub(r" *\\\n *", " ", "\n".join(line[2:] for line in lines))
    shown = [part for line in text.split("\n") for part in (command(line) if len(line) > WIDTH else [line])]
    return [".PP", ".nf", ".RS 4", *map(escape, shown), ".RE", ".fi", ".PP"]


def paragraphs(text):
    """Formats a text of -help: paragraphs separated by empty lines."""
    lines = []
    for part in re.split(r"\n\n+", text.strip("\n")):
        block = part.split("\n")
        if lines and lines[-1] != ".PP":
            lines.append(".PP")
        # prose may end in a literal block without an empty line between
        plain = next((k for k, line in enumerate(block) if line.startswith("  ")), len(block))
        lines += map(escape, block[:plain])
        if plain < len(block):
            lines += literal(block[plain:])
    while lines and lines[-1] == ".PP":
        lines.pop()
    return [line for k, line in enumerate(lines) if line != ".PP" or not k or lines[k - 1] != ".PP"]


def option_lines(option):
    default = f" ({option.default})" if option.default else ""
    argument = f" \\fI{escape(option.argument)}\\fP" if option.argument else ""
    return [".TP", f"\\fB{escape(option.name)}\\fP{argument}", escape(option.text + default)]


def without_idle_paragraphs(lines):
    """Returns the lines without .PP behind a heading or before a request that begins a paragraph itself."""
    pairs = zip(["", *lines], lines, [*lines[1:], ".SH"])
    heads, starts = (".SH", ".SS"), (".SH", ".SS", ".TP", ".PP")
    return [line for before, line, after in pairs if line != ".PP" or not (before[:3] in heads or after[:3] in starts)]


def see_also(program):
    """The programs that a page names: those that it says, and those that name it."""
    named = {**SEE_ALSO, **{one.command: one.see for one in (plot.PART, *apps.records()) if one.command}}
    others = {one for one, names in named.items() if program in names}
    own = [one for one in named[program] if one in named]
    return [*own, *sorted(others.difference(own))]


def page(described):
    """The lines of the page of a program."""
    program, usage = described["program"], described["usage"].split("\n\n", 2)
    summary = usage[0].split(": ", 1)[1].rstrip(".")
    starts = described.get("synopsis") or [part for line in usage[1].split("\n") for part in command(line.strip())]
    lines = [f'.TH {escape(program.upper())} 1 "" "{program} {described["version"]}" "User Commands"', ".nh", ".ad l"]
    lines += [".SH NAME", f"{escape(program)} \\- {escape(summary)}"]
    lines += [".SH SYNOPSIS", ".nf", *map(escape, starts), ".fi"]
    lines += [".SH DESCRIPTION", *paragraphs(usage[2]), ".SH OPTIONS"]
    texts = {topic["name"]: topic["text"] for topic in described["topics"]}
    for group in options.groups_of(described):
        lines += [f'.SS "{escape(group.name)}"', *paragraphs(texts.pop(group.topic, ""))]
        lines += [line for option in group.options for line in option_lines(option)]
    for name, text in texts.items():
        lines += [f'.SH "{escape(TITLES.get(name, name.upper()))}"', *paragraphs(text)]
    others = ", ".join(f"{name}(1)" for name in see_also(program))
    return without_idle_paragraphs([*lines, '.SH "SEE ALSO"', escape(others)])


if __name__ == "__main__":
    print("\n".join(page(options.read_or_end(sys.argv[1]))))
