"""Reads the docstrings of the Python package in scripts/petsam, and writes them as a page of Markdown.

    python3 scripts/maintain/modules.py > build/python.md

It reads the sources and imports nothing, so that it needs none of the package's libraries. Names of the package itself
are those of petsam.__all__, and of the modules all functions and classes without a leading underscore.
"""

import ast
import re
from pathlib import Path

import functions

PACKAGE = Path(__file__).resolve().parents[1] / "petsam"
# names of the package that users meet first, in the order of work; the others follow, errors and warnings at the end
FIRST = ("open", "run", "Contact", "Element", "Results", "Snapshot", "Stresses", "Study")
# classes of which users get objects from those, by their modules
OBTAINED = {"contact": ("Step", "Cycle"), "results.file": ("Datafile",)}
# modules in the order of the page; of a folder the modules that its __init__.py represents
MODULES = (
    "results.cycles",
    "results.sliding",
    "plot.pictures",
    "plot.of_joints",
    "joint.interface",
    "lives.stresses",
    "lives.materials",
    "lives.strength",
    "lives.evaluation",
    "lives.cracks",
    "closed.materials",
    "closed.sphere",
    "closed.ellipse",
    "closed.stress",
    "closed.loop",
    "closed.spence",
    "closed.punch",
    "closed.plane",
)
PROPERTIES = ("property", "cached_property", "functools.cached_property")
SECTION = re.compile(r"(Parameters|Returns|Raises|Notes|Attributes|References)\n-+\n")
COLUMNS = re.compile(r"\S {2,}\S")  # of a table in a docstring


def tree_of(module):
    return ast.parse((PACKAGE / (module.replace(".", "/") + ".py")).read_text(encoding="utf-8"))


def definitions(tree):
    """Returns the public functions and classes of a module or methods of a class by name."""
    kinds = (ast.FunctionDef, ast.ClassDef)
    return {node.name: node for node in tree.body if isinstance(node, kinds) and not node.name.startswith("_")}


def literal(tree, name):
    """Returns the value of a constant of a module."""
    for node in tree.body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", None) == name:
            return ast.literal_eval(node.value)
    raise ValueError(f"no constant {name}")


def package_names():
    """Returns the functions and classes of petsam.__all__: name to (module, definition), in the order of the page."""
    tree = tree_of("__init__")
    homes = {name: home.lstrip(".") for name, home in literal(tree, "_HOMES").items()}
    for node in tree.body:
        if isinstance(node, ast.ImportFrom):
            homes.update({alias.name: node.module for alias in node.names})
    names = [
        name
        for name in literal(tree, "__all__")
        if name not in (*literal(tree, "_PARTS"), *literal(tree, "_OF_RESULTS"))
    ]
    names.sort(key=lambda name: (FIRST.index(name) if name in FIRST else len(FIRST), name))
    modules = {name: homes.get(name, "__init__") for name in names}
    return {name: (module, definitions(tree_of(module))[name]) for name, module in modules.items()}


def signature(name, node):
    """Returns the lines of the call of a function or the head of a class; a property's name alone."""
    if isinstance(node, ast.ClassDef):
        made = next((part for part in node.body if getattr(part, "name", "") == "__init__"), None)
        return [f"class {name}{arguments(made.args, True) if made else ''}"]
    if {ast.unparse(decorator) for decorator in node.decorator_list} & set(PROPERTIES):
        return [name]
    is_method = bool(node.args.args) and node.args.args[0].arg in ("self", "cls")
    return [name + arguments(node.args, is_method)]


def arguments(args, is_method):
    listed = ast.unparse(args)
    return f"({re.sub(r'^(self|cls)(, )?', '', listed) if is_method else listed})"


def section(title, text):
    """Returns a section of numpydoc as Markdown: names with their types and texts as a list."""
    entries = re.split(r"\n(?=\S)", text.strip("\n"))
    lines = [f"**{title}**", ""]
    for entry in entries:
        head, _, body = entry.partition("\n")
        name, colon, kind = head.partition(" : ")
        body = functions.escape(" ".join(body.split()))
        lines.append(f"- `{name}`" + f" ({functions.escape(kind)})" * bool(colon) + (f": {body}" if body else ""))
    return "\n".join(lines)


def paragraph(text):
    """Returns a paragraph of a docstring as Markdown: one of names and their texts as a list, others with columns
    unchanged."""
    entries = re.sub(r"\n +", " ", text).split("\n")
    pairs = [re.fullmatch(r"(\S+(?: \S+)*) {2,}(\S.*)", entry) for entry in entries]
    if all(pairs):
        return "\n".join(f"- `{pair.group(1)}`: {functions.escape(pair.group(2))}" for pair in pairs)
    if COLUMNS.search(text) or re.search(r"^ ", text, re.M):
        return "\n".join(["```text", *text.split("\n"), "```"])
    return functions.escape(" ".join(text.split()))


def entry(level, name, node):
    """Returns the lines of a function, or of a class with its methods."""
    lines = [f"{'#' * level} {name}", "", "```python", *signature(name, node), "```", ""]
    for text in re.split(r"\n\s*\n", ast.get_docstring(node) or ""):
        found = SECTION.match(text)
        if found and found[1] != "Notes":
            lines += [section(found[1], text[found.end() :]), ""]
        else:
            lines += [paragraph(text[found.end() :] if found else text), ""]
    if isinstance(node, ast.ClassDef):
        for method, part in definitions(node).items():
            lines += entry(level + 1, f"{name.rpartition('.')[2]}.{method}", part)
    return lines


def listed():
    """Returns the contents of the page: headings, and of each the first docstring and {name: definition}."""
    package = {f"petsam.{name}": node for name, (_, node) in package_names().items()}
    for module, names in OBTAINED.items():
        package.update({f"petsam.{module}.{name}": definitions(tree_of(module))[name] for name in names})
    parts = {"petsam": (ast.get_docstring(tree_of("__init__")).split("\n\n")[0], package)}
    for module in MODULES:
        tree = tree_of(module)
        found = {f"petsam.{module}.{name}": node for name, node in definitions(tree).items()}
        parts[f"petsam.{module}"] = (ast.get_docstring(tree).split("\n\n")[0], found)
    return parts


def undocumented():
    """Returns the names on the page, those of methods too, that have no docstring."""
    found = []
    for _, names in listed().values():
        for name, node in names.items():
            methods = definitions(node) if isinstance(node, ast.ClassDef) else {}
            parts = {name: node, **{f"{name}.{method}": part for method, part in methods.items()}}
            found += [part for part, definition in parts.items() if not ast.get_docstring(definition)]
    return found


def page():
    """Returns the page of all names, module by module."""
    lines = [
        "# The Python package",
        "",
        "`import petsam` is enough: modules are imported when they are first used.",
        "",
    ]
    for heading, (first, names) in listed().items():
        lines += [f"## {heading}", "", functions.escape(" ".join(first.split())), ""]
        lines += [line for name, node in names.items() for line in entry(3, name, node)]
    return "\n".join(lines)


if __name__ == "__main__":
    print(page())
