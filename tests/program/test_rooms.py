"""The floors of src/ use each other as src/README.md says: by the linker's symbols, a floor uses those below it only,
and so does a room those that stand below it on its floor. The storeys of scripts/petsam use each other as
scripts/README.md says, by all imports, those within functions and those by a name in a text too.

python3 tests/program/test_rooms.py [build]     prints the arrows and the circles
"""

import ast
import re
import subprocess
import sys
from collections import defaultdict
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
from petsam import apps  # noqa: E402

MOST = {"files": 2, "modules": 3}  # in a circle


def floors():
    """The floors of the first table, the highest first, each with its rooms, the highest first."""
    text = (ROOT / "src" / "README.md").read_text().partition("## The problem")[0]
    rows = re.findall(r"^\| `(\w+)` \| ([^|]*) \|", text, re.M)
    return {floor: re.findall(r"`([\w.]+)`", names) for floor, names in rows}


def symbols(build):
    """Of each source file the symbols that it defines, and those that it uses of others."""
    objects = sorted(p for p in (build / "obj" / "src").rglob("*.o") if source(build, p).exists())
    listed = subprocess.run(["nm", "-g", "-A", *map(str, objects)], capture_output=True, text=True, check=True).stdout
    defines, uses = {}, defaultdict(set)
    for line in listed.splitlines():
        path, _, rest = line.partition(":")
        *_, kind, name = rest.split()
        file = str(source(build, Path(path)).relative_to(ROOT))
        if kind == "U":
            uses[file].add(name)
        elif name != "main":
            defines[name] = file
    return defines, uses


def source(build, path):
    return ROOT / path.relative_to(build / "obj").with_suffix(".c")


def arrows(build):
    """(using file, used file) to the symbols that join them."""
    defines, uses = symbols(build)
    found = defaultdict(set)
    for file, names in uses.items():
        for name in names & defines.keys():
            if defines[name] != file:
                found[file, defines[name]].add(name)
    return found


def floor(file):
    return file.split("/")[1]


def room(file):
    """Floor and room: a folder; `.` for the files beside the folders of a floor."""
    parts = file.split("/")
    return f"{parts[1]}/{parts[2] if len(parts) > 3 else '.'}"


def circles(pairs):
    """Sets of more than one node in which each reaches each other (Tarjan)."""
    graph = defaultdict(set)
    for one, other in pairs:
        graph[one].add(other)
    index, low, stack, found = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for other in graph.get(node, ()):
            if other not in index:
                visit(other)
                low[node] = min(low[node], low[other])
            elif other in stack:
                low[node] = min(low[node], index[other])
        if low[node] == index[node]:
            at = stack.index(node)
            if len(stack) - at > 1:
                found.append(sorted(stack[at:]))
            del stack[at:]

    for node in list(graph):
        if node not in index:
            visit(node)
    return found


def order():
    """All rooms, the highest first."""
    return [f"{floor}/{name}" for floor, names in floors().items() for name in names]


def upward(build):
    """Arrows from a floor or room to one above it."""
    places = order()
    return {
        pair: names
        for pair, names in arrows(build).items()
        if places.index(room(pair[1])) < places.index(room(pair[0]))
    }


def lines(pairs):
    return [f"{one} -> {other}: {', '.join(sorted(names))}" for (one, other), names in sorted(pairs.items())]


def circles_of_rooms(build):
    return circles({(room(one), room(other)) for one, other in arrows(build)})


def circles_of_files(build):
    """Of all C files, whatever their folders."""
    return circles(arrows(build).keys())


# ---------------------------------------------------------------- the Python package

PACKAGE = ROOT / "scripts" / "petsam"


def modules():
    """Name to path of all modules of the package; that of a package's __init__.py is the package's."""
    found = {}
    for path in PACKAGE.rglob("*.py"):
        parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


@cache
def tree(path):
    """The syntax of a module, to read only."""
    return ast.parse(path.read_text(encoding="utf-8"))


def imported(name, path, known):
    """The modules of the package that a module imports, at any place, or names in a text, as importlib needs it."""
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.ImportFrom) and node.level:
            above = package.split(".")[: len(package.split(".")) - node.level + 1]
            home = ".".join([*above, *([node.module] if node.module else [])])
            for alias in node.names:
                yield f"{home}.{alias.name}" if f"{home}.{alias.name}" in known else home
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in known)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            relative = node.value.startswith(".") and path.name != "__init__.py"  # which lists its package's modules
            whole = package + node.value if relative else node.value
            yield from [whole] if whole in known else []


def composed(path):
    """The arguments of importlib.import_module() that are composed, so that imported() cannot read them; those of a
    module's own package, as "." + home, are none."""
    for node in ast.walk(tree(path)):
        called = node.func if isinstance(node, ast.Call) else None
        if getattr(called, "attr", getattr(called, "id", "")) in ("import_module", "__import__"):
            what = node.args[0]
            own = isinstance(what, ast.BinOp) and isinstance(what.left, ast.Constant) and what.left.value == "."
            if not own and not isinstance(what, (ast.Constant, ast.Name, ast.Subscript)):
                yield ast.unparse(what)


def imports():
    """(importing module, imported module) of the package, but those of and to its __init__.py, which names all."""
    known = modules()
    return {(name, other) for name, path in known.items() if name != "petsam"
            for other in imported(name, path, known) if other not in ("petsam", name)}  # fmt: skip


def part(name):
    """The storey of a module, or of a name in it; of the package itself none."""
    return name.partition(".")[2].partition(".")[0]


def application(name):
    """The application of a module; None of the storeys below."""
    names = name.split(".")
    return names[2] if part(name) == "apps" and len(names) > 2 and (PACKAGE / "apps" / names[2]).is_dir() else None


def past_the_list():
    """(module, other): imports of another application's modules, but of those that it lists."""
    records = {one.name: one for one in apps.records()}
    return [
        (name, other)
        for name, other in sorted(imports())
        if application(other) not in (None, application(name))
        and other.count(".") > 2
        and other.split(".")[3] not in records[application(other)].names.get("", ())
    ]


def parts():
    """The storeys of the table, the highest first."""
    text = (ROOT / "scripts" / "README.md").read_text().partition("| package | what it does |")[2]
    return re.findall(r"^\| `([\w.]+)` \|", text.partition("\n\n")[0], re.M)


@pytest.fixture(scope="module")
def build():
    from conftest import PROGRAM

    return PROGRAM.parents[1]


def test_all_floors_and_rooms_are_in_the_table():
    found = defaultdict(set)
    for path in (ROOT / "src").rglob("*.[ch]"):
        name = room(str(path.relative_to(ROOT)))
        found[name.split("/")[0]].add(name.split("/")[1])
    assert {name: set(names) for name, names in floors().items()} == found


def test_no_floor_or_room_uses_one_above_it(build):
    assert not upward(build), "\n".join(lines(upward(build)))


def test_rooms_form_no_circle(build):
    assert not circles_of_rooms(build)


def test_files_form_no_large_circle(build):
    large = [circle for circle in circles_of_files(build) if len(circle) > MOST["files"]]
    assert not large, "\n".join(map(" ".join, large))


def test_no_two_sources_have_the_same_name():
    places = defaultdict(list)
    for path in (ROOT / "src").rglob("*.c"):
        places[path.name].append(str(path.relative_to(ROOT)))
    assert not [found for found in places.values() if len(found) > 1]


def test_all_packages_are_in_the_table():
    assert sorted(parts()) == sorted({part(name) for name in modules() if name != "petsam"})


def test_no_package_uses_one_above_it():
    places = parts()
    upward = [(a, b) for a, b in imports() if places.index(part(b)) < places.index(part(a))]
    assert not upward, upward


def test_applications_use_each_other_by_their_public_lists():
    assert not past_the_list()


def test_no_name_of_an_import_is_composed():
    found = {name: list(composed(path)) for name, path in modules().items() if name != "petsam"}
    assert not {name: texts for name, texts in found.items() if texts}


@pytest.mark.parametrize(
    "text, other",
    [
        ("from ..plot import reports", "petsam.plot.reports"),
        ("import importlib\nREPORTS = 'petsam.plot.reports'\nimportlib.import_module(REPORTS)", "petsam.plot.reports"),
        ("import importlib\nimportlib.import_module('.cycles', __package__)", "petsam.results.cycles"),
    ],
)
def test_imports_are_seen(tmp_path, text, other):
    (tmp_path / "one.py").write_text(text)
    assert other in imported("petsam.results.one", tmp_path / "one.py", modules())


@pytest.mark.parametrize("name, seen", [("f'petsam.{part}.reports'", True), ("'petsam.' + part", True),
                                        ("'.' + part", False), ("part", False)])  # fmt: skip
def test_composed_names_are_seen(tmp_path, name, seen):
    (tmp_path / "one.py").write_text(f"import importlib\nimportlib.import_module({name}, __name__)")
    assert list(composed(tmp_path / "one.py")) == ([name] if seen else [])


def test_modules_form_no_large_circle():
    large = [circle for circle in circles(imports()) if len(circle) > MOST["modules"]]
    assert not large, large


OF_COMMANDS = (
    ".command",
    ".core.line",
    ".plot.arguments",
    ".plot.uses",
    ".joint.options",
    ".joint.telling",
    ".joint.stiffnesses",
    ".joint.vibrations",
    ".wheel.options",
    ".wheel.inputs",
    ".wheel.printing",
)  # ends of the names of modules that read options


def command_line_outside_commands():
    """Options of a command line that modules read which belong to no command."""
    return [
        f"{name}: {word}"
        for name, path in modules().items()
        if name != "petsam" and not name.endswith(OF_COMMANDS)
        for word in re.findall(
            r"\b(?:options|args)\.(?!items|get|update|values|keys)\w+|\bargparse\b", path.read_text(encoding="utf-8")
        )
    ]


def test_numerics_know_no_command_line():
    """Options of a command line are read by commands only: what computes takes values."""
    found = command_line_outside_commands()
    assert not found, found


if __name__ == "__main__":
    where = (ROOT / (sys.argv[1] if len(sys.argv) > 1 else "build")).resolve()
    print("upward:", *lines(upward(where)), sep="\n  ")
    print("circles of rooms:", *map(" ".join, circles_of_rooms(where)), sep="\n  ")
    print("circles of modules of the Python package:", *map(" ".join, circles(imports())), sep="\n  ")
    print("circles of files:", *map(" ".join, circles_of_files(where)), sep="\n  ")
