"""Runs the command of a part of the package by the name of its program: the scripts petsam-NAME.

It uses the standard library only, as it is imported before it is known that the libraries exist.
"""

import os
import sys
from typing import Optional

from .. import apps, plot
from ..core.environment import enter
from ..core.part import Part


def run(path: str) -> None:
    """Ends with the exit code of the command whose program is petsam-NAME: the name of this path, or of a file to which
    it links."""
    for name in _names_of(path):
        part = _part_of(name)
        if part:
            enter(*part.libraries)
            sys.exit(code_of(part.command))
    program = os.path.basename(path)
    sys.exit(f"{program}: error: no command of this name: call this file by the name of one, as petsam-plot")


def code_of(program: str) -> int:
    """Carries out the command whose program is petsam-NAME; returns the exit code. Errors are printed in one line."""
    from ..core.line import guarded  # it needs libraries

    part = _part_of(program)
    if part is None:
        raise ValueError(f"{program}: no command of this name")
    return guarded(program, part.module("command").main, part.quiet)


def _names_of(path):
    """The names of a file and of the links behind it, but for the file to which petsam-NAME links."""
    names = [os.path.basename(path)]
    while os.path.islink(path):
        path = os.path.join(os.path.dirname(path), os.readlink(path))
        names.append(os.path.basename(path))
    return names[:-1] if len(names) > 1 and names[-2].startswith("petsam-") else names


def _part_of(program: str) -> Optional[Part]:
    """The record of the part whose command is a program; None where there is none."""
    begin, _, name = program.partition("-")
    if begin != "petsam" or not (name == "plot" or name in apps.names()):
        return None
    part = (plot if name == "plot" else getattr(apps, name)).PART
    return part if part.command == program else None
