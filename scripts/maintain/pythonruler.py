"""Counts of ruler.py over the Python package: what applications know, and what a reader has to hold in mind."""

import ast
import re
import sys
from functools import cache
from pathlib import Path

import modules

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "program"))
import test_rooms as rooms  # noqa: E402

SECTIONS = re.compile(r"^(Parameters|Returns|Raises|Attributes)\n-{3,}$", re.M)
FIRST = re.compile(r"(What|Whether|Those|Of|Which)\b")  # words with which no sentence begins that is read once
READER = re.compile(r"^def \w+\(text\b", re.M)
OF_COMMANDS = ("command.py", "line.py", "arguments.py", "uses.py", "options.py", "inputs.py")


def imported(name, path, known):
    """The names of other modules that a module imports or takes from one that it imports, as home.name."""
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    nodes, used, local = list(ast.walk(rooms.tree(path))), set(), {}
    for node in nodes:
        if not isinstance(node, ast.ImportFrom) or not node.level:
            continue
        above = package.split(".")[: len(package.split(".")) - node.level + 1]
        home = ".".join([*above, *([node.module] if node.module else [])])
        for alias in node.names:
            if f"{home}.{alias.name}" in known:
                local[alias.asname or alias.name] = f"{home}.{alias.name}"
            else:
                used.add(f"{home}.{alias.name}")
    for node in nodes:
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in local:
            used.add(f"{local[node.value.id]}.{node.attr}")
    return used


def crossings(known):
    """Names that applications use of the library, that they use of each other, and that the library uses of them."""
    below, between, upward = set(), set(), set()
    for name, path in known.items():
        for other in imported(name, path, known):
            own, theirs = rooms.application(name), rooms.application(other)
            if own and not theirs:
                below.add(other)
            elif own and theirs != own:
                between.add(other)
            elif theirs and not own:
                upward.add(other)
    return below, between, upward


@cache
def definitions(tree):
    return [node for node in ast.walk(tree) if isinstance(node, (ast.FunctionDef, ast.ClassDef))]


def documented():
    """The names that have a heading in the reference, and the docstrings that it shows."""
    nodes, shown = {}, set()
    for _, names in modules.listed().values():
        nodes.update({name: node for name, node in names.items() if name not in modules.returned(names)})
        shown |= {ast.get_docstring(part) for node in names.values() for part in definitions(node)}
    return nodes, shown


def hidden(known, nodes, shown):
    """Definitions with sections that the reference does not show, by their docstrings, nor by their names: it shows
    functions with the keywords of their dataclasses (core/keywords.py)."""
    names = {name.rpartition(".")[2] for name in nodes}
    return [
        node.name
        for path in known.values()
        for node in definitions(rooms.tree(path))
        if SECTIONS.search(ast.get_docstring(node) or "")
        and ast.get_docstring(node) not in shown
        and node.name not in names
    ]


def measure():
    """The counts, in the order of their rows in ruler.py."""
    known = rooms.modules()
    docstrings = [ast.get_docstring(node) or "" for path in known.values()
                  for node in definitions(rooms.tree(path))]  # fmt: skip
    nodes, shown = documented()
    commands = [path for path in known.values() if path.name in OF_COMMANDS]
    below, between, upward = crossings(known)
    return (
        len(below),
        len(between),
        len(upward),
        len(nodes),
        len(hidden(known, nodes, shown)),
        sum(len(READER.findall(Path(path).read_text("utf-8"))) for path in commands),
        sum(1 for text in docstrings if FIRST.match(text)),
    )
