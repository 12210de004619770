#!/usr/bin/env python3
"""Finds decisions by a rank's own data before collective calls: a rank without cells decides otherwise, and all hang.

    scripts/maintain/check_ranks.py [folder or file ...]

Two kinds of conditions are looked for, where what they govern contains PetscCall():

- on an array of numbers, as in `if (!x->stress)` or `strain ? ... : ...`: a rank without cells has no array, as
  PetscMalloc1() of no values gives NULL. Use a flag that all ranks set alike;
- on the cells or rows of this rank, as in `if (grid->cells)`.

An array that does not belong to cells is the same on all ranks. It is listed below by file and name.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NUMBERS = r"(?:const )?(?:double|float|PetscReal|PetscScalar)(?: complex)?"
COUNTS = {"cells", "rows"}  # of this rank
ALONE = re.compile(
    r"PetscCall\((?:Petsc(?:Malloc|Calloc|Free|Array|New|Realloc)|VecGetArray|VecRestoreArray|SamAllocate)"
)
# the same on all ranks: tables, sums over cells, outputs that a caller wants, memory by SamAllocate(), never NULL
SAME = {
    "src/bodies/body/initialstress.c": {"rows"},
    "src/contact/step/fixedpoint.c": {"largest"},
    "src/contact/step/stepcache.c": {"table"},
    "src/laws/plastic/plasticnewton.c": {"energy"},
    "src/laws/wear/magnified.c": {"lift"},
    "src/post/stress/section.c": {"sums"},
    "src/run/io/kept.c": {"rows"},
    "src/run/steps/history.c": {"rows"},
}


def functions(text):
    """(first line, source) of each function."""
    for found in re.finditer(r"^[A-Za-z][^;{}#/]*\)\n\{\n.*?^\}", text, re.M | re.S):
        yield text.count("\n", 0, found.start()) + 1, found.group(0)


def members(texts):
    """Names of members of structures that are arrays of numbers, and of no other type anywhere."""
    found, others = set(), set()
    for text in texts:
        for body in re.findall(r"(?:struct \w* ?|typedef struct )\{\n(.*?)^\}", text, re.M | re.S):
            for line in re.findall(r"^ +([\w][^;(]*);", body, re.M):
                names = set(re.findall(r"(\w+)(?:\[[^\]]*\])*(?=,|$)", line))
                (found if re.match(rf"{NUMBERS} +\*", line) else others).update(names)
            others.update(re.findall(r"\(\*(\w+)\)\(", body))
    return found - others


def arrays(source):
    """Names of parameters and variables of a function that are arrays of numbers."""
    head, body = source.split("\n{\n", 1)
    found = set(re.findall(rf"{NUMBERS} +\*(?:const )?(\w+)\b(?!\[)", head))
    found.update(re.findall(rf"{NUMBERS} +(\w+)\[\]", head))
    for line in re.findall(rf"^ +{NUMBERS} +([^;(]*);", body, re.M):
        found.update(re.findall(r"\*(?:const )?(\w+)", line))
    return found


def closed(line, start):
    """The text in the parentheses that open at a place of a line, and where they end."""
    depth = 0
    for k in range(start, len(line)):
        depth += (line[k] == "(") - (line[k] == ")")
        if not depth:
            return line[start + 1 : k], k + 1
    return line[start + 1 :], len(line)


def decisions(lines, k):
    """(condition, governed text) of a line: of `if` and `while` what follows or the block, of `? NULL :` the line.

    A return governs the rest of the function.
    """
    line = lines[k]
    for found in re.finditer(r"\b(?:if|while) (?=\()", line):
        words, end = closed(line, found.end())
        rest = line[end:].strip()
        if rest == "{":
            depth = len(line) - len(line.lstrip())
            block = []
            for more in lines[k + 1 :]:
                if more.strip() and len(more) - len(more.lstrip()) <= depth:
                    break
                block.append(more)
            rest = "\n".join(block)
        rest = rest or "\n".join(lines[k + 1 : k + 2])
        yield words, "\n".join(lines[k + 1 :]) if "PetscFunctionReturn(" in rest else rest
    for found in re.finditer(r"(?:\w+(?:->|\.))*\w+(?= \? (?:NULL|PETSC_|[^:]* : (?:NULL|PETSC_)))", line):
        yield found.group(0), line if "PetscCall(" in line[: found.start()] else ""


def faults(path, known):
    """(line, name, text) of each decision in a file; its own structures say what their members are."""
    text = path.read_text()
    known = known | members([text])
    for first, source in functions(text):
        own, lines = arrays(source), source.split("\n")
        for k, line in enumerate(lines):
            for words, rest in decisions(lines, k):
                if "PetscCall(" not in ALONE.sub("", rest):
                    continue
                for name in re.findall(r"(?:^|\(|&& |\|\| )!?((?:\w+(?:->|\.))*\w+)(?= *(?:$|\)|&&|\|\|))", words):
                    last = re.split(r"->|\.", name)[-1]
                    if last in COUNTS or (name in own if last == name else last in known):
                        yield first + k, last, line.strip()


def main():
    places = [Path(word).resolve() for word in sys.argv[1:]] or [ROOT / "src"]
    files = sorted({file for place in places for file in ([place] if place.is_file() else place.rglob("*.c"))})
    known = members(file.read_text() for file in [*(ROOT / "src").rglob("*.[ch]"), *(ROOT / "include").rglob("*.h")])
    count = 0
    for file in files:
        name = str(file.relative_to(ROOT)) if file.is_relative_to(ROOT) else str(file)
        for line, array, text in faults(file, known):
            if array in SAME.get(name, ()):
                continue
            count += 1
            print(f"{name}:{line}: a decision by this rank's `{array}` before a collective call: {text}")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
