"""How well the parts of petsam know only what they need: counts that should fall, each with what it is now at most.

    python3 scripts/maintain/ruler.py [build]     prints the counts, the limits and the goals

tests/program/test_ruler.py holds the limits. Who brings a count down lowers its limit; who must raise one gives the
reason in the commit.
"""

import json
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SRC = ROOT / "src"
sys.path[:0] = [str(ROOT / "tests" / "program"), str(ROOT / "tests" / "mutants")]

import check  # noqa: E402
import pythonruler  # noqa: E402

# count: what it is at most now, and what it should be
LIMITS = {
    "laws that are looked up by name outside of contact/problem": (3, 8),
    "flags of the motion in contact": (19, 12),
    "calls of a body's materials outside of bodies": (0, 0),
    "files outside of bodies that call them": (0, 0),
    "files outside of its home that name heat": (5, 6),
    "files outside of its home that name plastic": (10, 14),
    "files outside of its home that name wear": (22, 22),
    "files outside of its home that name gradient": (12, 12),
    "files outside of its home that name layers of materials": (15, 25),
    "files outside of its home that name adhesion": (1, 1),  # its registry
    "files outside of its home that name viscous": (1, 1),
    "files in the largest circle of C files": (2, 2),
    "modules in the largest circle of Python modules": (3, 3),
    "fitted numbers in advice that no mutant guards": (3, 0),
    "options of a command line outside of commands": (0, 0),
    "options in no example or page": (0, 0),
    "names that applications use of the library": (110, 110),
    "names that applications use of each other": (6, 6),
    "names of applications that the library uses": (0, 0),
    "documented names of the package": (220, 220),
    "blocks of docstrings that no list reaches": (4, 4),  # of dataclasses whose fields are keywords
    "readers of words in commands": (6, 8),
    "docstrings that begin with What, Whether, Those, Of, Which": (0, 0),
}
NUMBER = r"^#define ([A-Z_0-9]+) +(\(?-?[0-9.].*)"  # fitted or chosen
DOUBTED = ("src/post/advice/*.[ch]", "src/laws/*/*doubt.c", "include/petsam/private/examination.h")  # their files
MATERIALS = r"\bSamBody(?:MaterialAt|Substrate|SubstrateTop|Count|Top|NumberAt)\("

# layers of a body's materials; those of plastic strain, and of results at depths, are others
MATERIAL_LAYERS = (
    r"layered|layer_(?:young|poisson|thickness|file|strength)|IsUniform|substrate|with layers|the layers are|"
    r"each layer|stop_layer|traits\.layers|AdviseWorn"
)

# a capability: its rooms, its headers, and how code names it; a gradient by the class and the option, as solvers have
# conjugate ones
HOMES = {
    "heat": ("laws/heat", r"(private/)?heat", "heat"),
    "plastic": ("laws/plastic", r"(private/)?plastic", "plastic"),
    "wear": ("laws/wear", r"(private/)?(wear|life)", "wear"),
    "gradient": ("post/gradient", r"(private/)?(gradient|objective|backstep)", 'SamGradient|"-?gradient'),
    "layers of materials": ("bodies", r"(private/)?(layer|body)", MATERIAL_LAYERS),
    "adhesion": ("laws/adhesion", r"(private/)?adhesion", "adhesion"),
    "viscous": ("bodies/viscous", r"(private/)?viscous", "viscous"),
}


@cache
def code(path):
    """A source without its comments."""
    return re.sub(r"/\*.*?\*/", "", path.read_text(encoding="utf-8"), flags=re.S)


def found(pattern, folder, but=()):
    """Path to number of matches in the C files below a folder, but for some folders."""
    counts = {}
    for path in sorted(folder.rglob("*.[ch]")):
        if any(SRC / name in path.parents for name in but):
            continue
        count = len(re.findall(pattern, code(path), re.M))
        if count:
            counts[path] = count
    return counts


def named_outside(capability):
    """C files besides those of a capability whose code, strings included, names it."""
    room, headers, words = HOMES[capability]
    include = ROOT / "include" / "petsam"
    files = [path for path in sorted(SRC.rglob("*.[ch]")) if SRC / room not in path.parents]
    files += [
        path
        for path in [*sorted(include.rglob("*.h")), ROOT / "include" / "petsam.h"]
        if not re.match(headers, str(path.relative_to(include)) if include in path.parents else path.name)
    ]
    return [path for path in files if re.search(words, code(path), re.I)]


def fitted():
    """Files and names of the fitted or chosen numbers in the advice, and in the doubts of laws."""
    files = sorted(path for pattern in DOUBTED for path in ROOT.glob(pattern))
    return [(path, match[1]) for path in files for match in re.finditer(NUMBER, code(path), re.M)]


def uses(name, text):
    """How many times a text has a name, other than where it is defined."""
    return len(re.findall(rf"(?<!#define )\b{name}\b", text)) if name in text else 0


def guards(mutant, name, total):
    """True if a mutant changes the value of a number, or takes it out of all `total` places that use it."""
    old, new = (re.search(rf"#define {name} +(.*)", re.sub(r"/\*.*", "", text)) for text in (mutant.old, mutant.new))
    if old:
        return bool(new) and old[1].strip() != new[1].strip()
    return uses(name, mutant.old) == total > 0 == uses(name, mutant.new)


def unguarded(mutants):
    """Files and names of the fitted or chosen numbers that none of these mutants guards."""
    found = []
    sources = {path: code(path) for folder in (SRC, ROOT / "include") for path in folder.rglob("*.[ch]")}
    for path, name in fitted():
        places = sources if path.suffix == ".h" else [path]  # where the name means this number
        total = sum(uses(name, sources[place]) for place in places)
        if not any(ROOT / m.file in places and guards(m, name, total) for m in mutants):
            found.append((path, name))
    return found


PAGES = (".md", ".sh", ".py", ".opts", ".csv", ".yaml", ".ipynb")


def names_shown(text):
    """The names that a text gives as options: -option, option=, "option", or option: of a study."""
    found = re.finditer(r"""(?<!\w)-(\w+)|(?<!\w)(\w+)=|["'`](\w+)(?=["'`])|^\s*(\w+):""", text, re.M)
    return {name for match in found for name in match.groups() if name}


def options_in_no_page(build):
    """petsam's options that no example and no page shows, but for the tables made from the program."""
    help_text = subprocess.run([build / "bin" / "petsam", "-help", "json"], capture_output=True, text=True, check=True)
    options = [row["name"].lstrip("-") for group in json.loads(help_text.stdout)["groups"] for row in group["options"]]
    pages = [path for path in sorted((ROOT / "examples").rglob("*")) if path.suffix in PAGES]
    pages = [path for path in pages if path.name != "OPTIONS.md"] + [ROOT / "README.md", ROOT / "scripts" / "README.md"]
    shown = set().union(*(names_shown(path.read_text(encoding="utf-8")) for path in pages))
    return [name for name in options if name not in shown]


def measure(build):
    """All counts, by name; build: the folder of the built program, whose symbols join the files."""
    import test_rooms as rooms

    materials = found(MATERIALS, SRC, but=("bodies",))
    values = (
        sum(found(r"\bSamProblemGetLaw\(", SRC, but=("contact/problem",)).values()),
        sum(found(r"(?:->|\.)(?:rolls|streams|continues)\b", SRC / "contact").values()),
        sum(materials.values()),
        len(materials),
        *(len(named_outside(name)) for name in HOMES),
        max(map(len, rooms.circles(rooms.arrows(build).keys())), default=1),
        max(map(len, rooms.circles(rooms.imports())), default=1),
        len(unguarded(check.all_mutants())),
        len(rooms.command_line_outside_commands()),
        len(options_in_no_page(build)),
        *pythonruler.measure(),
    )
    return dict(zip(LIMITS, values, strict=True))


def main():
    where = (ROOT / (sys.argv[1] if len(sys.argv) > 1 else "build")).resolve()
    print(f"{'now':>5} {'limit':>5} {'goal':>5}")
    for name, value in measure(where).items():
        print(f"{value:5d} {LIMITS[name][0]:5d} {LIMITS[name][1]:5d}  {name}")


if __name__ == "__main__":
    main()
