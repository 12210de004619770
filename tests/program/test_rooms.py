"""The rooms of src/ use each other as src/README.md says: by the linker's symbols, a room uses those below it only.

python3 tests/program/test_rooms.py [build]     prints the arrows and the circles
"""

import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MOST = 6  # files of one folder in a circle
# one file names laws of the rooms above it: a new type is a file and a line there
LISTS = {"src/law/register.c"}


def rooms():
    """The rooms of the table, the highest first."""
    return re.findall(r"^\| `src/(\w+)/` \|", (ROOT / "src" / "README.md").read_text(), re.M)


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
    """(using file, used file) to the symbols that join them; without lists of types, which may name all."""
    defines, uses = symbols(build)
    found = defaultdict(set)
    for file, names in uses.items():
        for name in names & defines.keys():
            if defines[name] != file and file not in LISTS:
                found[file, defines[name]].add(name)
    return found


def room(file):
    return file.split("/")[1]


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


def upward(build):
    """Arrows from a room to one above it."""
    order = rooms()
    return {
        pair: names for pair, names in arrows(build).items() if order.index(room(pair[1])) < order.index(room(pair[0]))
    }


def lines(pairs):
    return [f"{one} -> {other}: {', '.join(sorted(names))}" for (one, other), names in sorted(pairs.items())]


def circles_of_rooms(build):
    return circles({(room(one), room(other)) for one, other in arrows(build)})


def circles_of_files(build):
    """In each folder, at any depth, by the arrows between its own files."""
    found = []
    pairs = arrows(build)
    for folder in sorted({Path(one).parent for one, _ in pairs}):
        found += circles({(a, b) for a, b in pairs if Path(a).parent == Path(b).parent == folder})
    return found


@pytest.fixture(scope="module")
def build():
    from conftest import PROGRAM

    return PROGRAM.parents[1]


def test_all_rooms_are_in_the_table():
    assert sorted(rooms()) == sorted(path.name for path in (ROOT / "src").iterdir() if path.is_dir())


def test_no_room_uses_one_above_it(build):
    assert not upward(build), "\n".join(lines(upward(build)))


def test_rooms_form_no_circle(build):
    assert not circles_of_rooms(build)


def test_no_folder_has_a_large_circle_of_files(build):
    large = [circle for circle in circles_of_files(build) if len(circle) > MOST]
    assert not large, "\n".join(map(" ".join, large))


if __name__ == "__main__":
    where = (ROOT / (sys.argv[1] if len(sys.argv) > 1 else "build")).resolve()
    print("upward:", *lines(upward(where)), sep="\n  ")
    print("circles of rooms:", *map(" ".join, circles_of_rooms(where)), sep="\n  ")
    print("circles of files in a folder:", *map(" ".join, circles_of_files(where)), sep="\n  ")
