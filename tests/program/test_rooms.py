"""The floors of src/ use each other as src/README.md says: by the linker's symbols, a floor uses those below it only,
and so does a room those that stand below it on its floor.

python3 tests/program/test_rooms.py [build]     prints the arrows and the circles
"""

import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MOST = 3  # files of one folder in a circle


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


def test_no_folder_has_a_large_circle_of_files(build):
    large = [circle for circle in circles_of_files(build) if len(circle) > MOST]
    assert not large, "\n".join(map(" ".join, large))


if __name__ == "__main__":
    where = (ROOT / (sys.argv[1] if len(sys.argv) > 1 else "build")).resolve()
    print("upward:", *lines(upward(where)), sep="\n  ")
    print("circles of rooms:", *map(" ".join, circles_of_rooms(where)), sep="\n  ")
    print("circles of files in a folder:", *map(" ".join, circles_of_files(where)), sep="\n  ")
