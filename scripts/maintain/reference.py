#!/usr/bin/env python3
"""Writes from the programs' -help the tables of options in examples/manual/OPTIONS.md and, with units of options, the
options that name files and the table of materials, scripts/petsam/core/declared.py.

    python3 scripts/maintain/reference.py [--build build] [--check]

A table stands between <!-- petsam: GROUP --> and <!-- end -->, GROUP being a heading of -help, that of materials
between <!-- materials --> and <!-- end -->; all else in the file is written by hand. Fails when a group has no
table in the file, or a table no group; --check writes nothing, and fails when the file is not what would be written.
"""

import argparse
import re
import sys
import textwrap
from pathlib import Path

from options import groups_of, read_help

ROOT = Path(__file__).resolve().parents[2]
REFERENCE = ROOT / "examples" / "manual" / "OPTIONS.md"
DECLARED = ROOT / "scripts" / "petsam" / "core" / "declared.py"
PROGRAMS = ["petsam", "petsam-stress"]
MATERIALS = re.compile(r"<!-- materials -->\n.*?<!-- end -->", re.S)
# columns of the manual: constant, heading, size of its unit
COLUMNS = (
    ("young", "E/GPa", 1e9), ("poisson", "nu", 1.0), ("density", "density/(kg/m3)", 1.0),
    ("conductivity", "conductivity/(W/(m K))", 1.0), ("specific_heat", "specific heat/(J/(kg K))", 1.0),
    ("expansion", "expansion/(1e-6/K)", 1e-6), ("yield", "yield/MPa", 1e6),
)  # fmt: skip
ONE_LINE = 109  # characters of a text that stands in one line of the module
FATIGUE = (("sigma_f", "MPa", 1e6), ("b", "", 1.0), ("epsilon_f", "", 1.0), ("c", "", 1.0))
TABLE = re.compile(r"<!-- (petsam[\w-]*): (.+?) -->\n.*?<!-- end -->", re.S)


def split_text(option):
    """Returns the option's meaning, and the text of the last column: its default, or the options that require it."""
    if found := re.fullmatch(r"(.*): (required.*)", option.text):
        return found.groups()
    return option.text, option.default or ""


def table(options):
    """Returns the table of options; one of body 2 that is as that of body 1 is in its row."""
    lines = ["| option | meaning | default |", "| --- | --- | --- |"]
    known = {option.name: option for option in options}
    for option in options:
        if alike(known.get(of_body(option.name, 2, 1)), option):
            continue
        meaning, default = (words.replace("|", "\\|") for words in split_text(option))
        name = f"`{f'{option.name} {option.argument}'.strip()}`"
        other = known.get(of_body(option.name, 1, 2))
        if alike(other, option):
            name = f"`{option.name}`, `{other.name}`: `{option.argument}`"
            meaning = re.sub(r" of body 1\b(?!')", "", meaning).replace("body 1", "the body")
        lines.append(f"| {name} | {meaning} | {default} |")
    return "\n".join(lines)


def of_body(name, one, other):
    """Returns the name of the option of the other body."""
    return re.sub(rf"(?<=body){one}(?!\d)|{one}$", str(other), name)


def alike(one, other):
    """True if two options of different bodies have the same argument, meaning and default."""
    if one is None or one.name == other.name or one.argument != other.argument:
        return False
    texts = [[re.sub(r"body [12]", "body", words) for words in split_text(option)] for option in (one, other)]
    return texts[0] == texts[1]


def fill(text, groups):
    """Returns the file's text with new tables; groups: (program, heading) to options."""
    left = dict(groups)

    def make(found):
        program, heading = found.groups()
        if (program, heading) not in left:
            raise ValueError(f"{program} -help has no group {heading!r}, or it has two tables")
        return f"<!-- {program}: {heading} -->\n{table(left.pop((program, heading)))}\n<!-- end -->"

    text = TABLE.sub(make, text)
    if left:
        raise ValueError("no table for " + ", ".join(f"{program}: {heading}" for program, heading in left))
    return text


def constants_of(described):
    """Yields each material of read_help() with its constants: {name: value or None}."""
    names = [one["name"] for one in described["constants"]]
    for material in described["materials"]:
        yield material, dict(zip(names, material["values"]))


def shown(value, size):
    return "" if value is None else f"{value / size:.6g}"


def materials(described):
    """Returns the table of materials for the manual, without the sources."""
    heads = ["material", "other names", *(head for _, head, _ in COLUMNS), "fatigue"]
    lines = ["| " + " | ".join(heads) + " |", "|" + " --- |" * len(heads)]
    for material, found in constants_of(described):
        fatigue = ", ".join(
            f"{name} {shown(found[name], size)} {unit}".rstrip()
            for name, unit, size in FATIGUE
            if found[name] is not None
        )
        cells = [f"`{material['name']}`", material["aliases"], *(shown(found[name], size) for name, _, size in COLUMNS)]
        lines.append("| " + " | ".join([*cells, fatigue]) + " |")
    return "<!-- materials -->\n" + "\n".join(lines) + "\n<!-- end -->"


def declared_materials(described):
    """Returns the lines of the module for the table of materials."""
    lines = ["# constants of materials: unit and meaning", "CONSTANTS = {"]
    lines += [f'    "{one["name"]}": ("{one["unit"]}", "{one["text"]}"),' for one in described["constants"]]
    lines += ["}", "# materials: other names, the constants in this order, None where the source has none, the source"]
    lines += ["MATERIALS = {"]
    for one in described["materials"]:
        values = ", ".join("None" if value is None else repr(float(value)) for value in one["values"])
        parts = [one["source"]]
        if len(parts[0]) > ONE_LINE:
            parts = textwrap.wrap(one["source"], 100, drop_whitespace=False)
        lines += [f'    "{one["name"]}": (', f'        "{one["aliases"]}",', f"        ({values}),"]
        lines += [f'        "{part}"' for part in parts[:-1]] + [f'        "{parts[-1]}",', "    ),"]
    return [*lines, "}"]


def declared(described, groups):
    """Returns the text of the module: the SI unit of every option, units that may follow a number, options of files,
    the table of materials."""
    units = described["units"]
    of_options = {
        option.name[1:]: option.unit
        for options in groups.values()
        for option in options
        if option.unit not in (None, "1")
    }
    following = {}
    for unit, names in units.items():
        for name, power in names.items():
            following.setdefault(name, (unit, power))  # N is a force, and not a moment per metre
    files = {
        option.name[1:]
        for (program, _), options in groups.items()
        for option in options
        if program == "petsam" and option.argument == "<file>"
    }
    lines = ['"""Units and files of the options, written by scripts/maintain/reference.py."""', ""]
    lines += ["# units of SI of options", "OPTIONS = {"]
    lines += [f'    "{name}": "{unit}",' for name, unit in sorted(of_options.items())]
    lines += ["}", "# units that may follow a number: the unit of SI, and a power of ten", "FOLLOWING = {"]
    lines += [f'    "{name}": ("{unit}", {power}),' for name, (unit, power) in following.items()]
    lines += ["}", "# options of petsam that name files, which are read or written", "PATHS = ("]
    lines += [f'    "{name}",' for name in sorted(files)]
    return "\n".join([*lines, ")", *declared_materials(described), ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument("--check", action="store_true", help="write nothing; fail when the file is out of date")
    arguments = parser.parse_args()
    groups = {}
    for program in PROGRAMS:
        described = read_help(arguments.build / "bin" / program)
        groups.update({(program, group.name): group.options for group in groups_of(described)})
    reference = MATERIALS.sub(lambda _: materials(described), fill(REFERENCE.read_text(), groups))
    module = declared(described, groups)
    for file, new in (REFERENCE, reference), (DECLARED, module):
        if new == file.read_text():
            continue  # else make would take all pages of the scripts for older than it
        if arguments.check:
            sys.exit(f"{file.relative_to(ROOT)} differs from -help: run python3 scripts/maintain/reference.py")
        file.write_text(new)


if __name__ == "__main__":
    main()
