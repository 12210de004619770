"""Reads the docstrings of the Python package in scripts/petsam, and writes them as a page of Markdown.

    python3 scripts/maintain/modules.py > build/python.md

It reads the sources, and imports of the package only what needs no library: the records of its parts. Names of the
package itself are those of petsam.__all__, of a part those of its record, and of other modules those of their __all__,
or all functions and classes without a leading underscore. A class has the methods of its bases in the package, too. A
class of values that a function returns is explained with that function.
"""

import ast
import copy
import re
import sys
from functools import cache
from pathlib import Path

import functions

PACKAGE = Path(__file__).resolve().parents[1] / "petsam"
sys.path.insert(0, str(PACKAGE.parent))
import petsam  # noqa: E402
from petsam import apps, plot  # noqa: E402
from petsam.core.keywords import completed  # noqa: E402

# names of the package that users meet first, in the order of work; the others follow, errors and warnings at the end
FIRST = ("open", "run", "Contact", "Results", "Snapshot", "Stresses", "Study")
# classes of which users get objects from those, by their modules
OBTAINED = {"contact.steps": ("Step", "Cycle")}
# modules before and behind the parts, in the order of the page
BEFORE = ("results.errors", "results.cycles", "results.sliding", "contact.gradient", "contact.uncertainty")
BEHIND = (
    "core.materials", "closed.materials", "closed.sphere", "closed.ellipse", "closed.stress", "closed.loop",
    "closed.spence", "closed.punch", "closed.plane", "closed.adhesion",
)  # fmt: skip
PICTURES = ("picture", "of_stress", "of_study")  # decorators of plot/pictures.py
# decorators by core/keywords.py, with the module of the docstring COMMON to what they decorate
UNFOLDED = {
    **dict.fromkeys(PICTURES, "plot.keywords"),
    "of_surfaces": "apps.joint.interfaces",
    "of_vibrations": "apps.joint.sweep",
}
PROPERTIES = ("property", "cached_property", "functools.cached_property")
SECTION = re.compile(r"(Parameters|Returns|Raises|Notes|Attributes|References)\n-+\n")
COLUMNS = re.compile(r"\S {2,}\S")  # of a table in a docstring


@cache
def tree_of(module):
    path = PACKAGE / module.replace(".", "/")
    path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    return ast.parse(path.read_text(encoding="utf-8"))


def definitions(tree):
    """Returns the public functions and classes of a module or methods of a class by name."""
    kinds = (ast.FunctionDef, ast.ClassDef)
    return {node.name: node for node in tree.body if isinstance(node, kinds) and not node.name.startswith("_")}


@cache
def public(module):
    """Returns the public functions and classes of a module by name, as users meet them, with those of its __all__ that
    are of modules beside it."""
    homes = {name: origin(module, name) for name in offered(module)}
    others = {name: public(home)[name] for name, home in homes.items() if home and name in definitions(tree_of(home))}
    own = {name: whole(module, unfolded(module, node)) for name, node in definitions(tree_of(module)).items()}
    return {**others, **own}


def offered(module):
    """Returns the names of the __all__ of a module; none of one without, or whose __all__ is no constant."""
    [*_, value] = [ast.List([]), *assigned(module, "__all__")]
    return ast.literal_eval(value) if isinstance(value, ast.List) else []


def assigned(module, name):
    """Returns what a module assigns to a name."""
    parts = [part for part in tree_of(module).body if isinstance(part, ast.Assign)]
    return [part.value for part in parts if getattr(part.targets[0], "id", None) == name]


def unfolded(module, node):
    """Returns a function with the keywords that its decorator makes of dataclasses; anything else unchanged."""
    decorators = {ast.unparse(decorator) for decorator in node.decorator_list} & UNFOLDED.keys()
    if not decorators:
        return node
    node, common = copy.deepcopy(node), [constant(UNFOLDED[decorator], "COMMON") for decorator in decorators]
    shown = list(zip(node.args.kwonlyargs, node.args.kw_defaults))
    if decorators & set(PICTURES):
        shown.append((ast.arg("look", ast.Name("Look")), None))
    pairs = []
    for arg, default in shown:
        kinds = lineage(module, ast.unparse(arg.annotation)) if default is None else []
        common[:0] = [ast.get_docstring(kind) for kind in kinds]
        fields = [part for kind in reversed(kinds) for part in kind.body if isinstance(part, ast.AnnAssign)]
        pairs += [(ast.arg(part.target.id, part.annotation), part.value) for part in fields] or [(arg, default)]
    node.args.kwonlyargs, node.args.kw_defaults = [arg for arg, _ in pairs], [default for _, default in pairs]
    text = completed(ast.get_docstring(node), [arg.arg for arg in parameters(node.args)], common)
    node.body[0] = ast.Expr(ast.Constant(text))
    return node


def constant(module, name):
    """Returns the value of a constant of a module; None if it has none of this name."""
    found = assigned(module, name)
    return ast.literal_eval(found[0]) if found else None


def lineage(module, name):
    """Returns a class of a module, or one that it imports from beside it, with its bases; nothing of other names."""
    home = module if name in definitions(tree_of(module)) else origin(module, name)
    node = home and definitions(tree_of(home)).get(name)
    if not isinstance(node, ast.ClassDef) or not any("dataclass" in ast.unparse(one) for one in node.decorator_list):
        return []
    return [node, *(kind for base in node.bases for kind in lineage(home, ast.unparse(base)))]


def whole(module, node):
    """Returns a class with the methods that it has of its bases in the package, and a table() without a docstring with
    that of Tabled; anything else unchanged."""
    for part in definitions(node).values() if isinstance(node, ast.ClassDef) else ():
        if part.name == "table" and not ast.get_docstring(part):
            part.body.insert(0, definitions(definitions(tree_of("core.tables"))["Tabled"])["table"].body[0])
    for base in (getattr(base, "id", None) for base in getattr(node, "bases", [])):
        home = module if base in definitions(tree_of(module)) else origin(module, base)
        if home:
            own = {getattr(part, "name", None) for part in node.body}
            parts = whole(home, definitions(tree_of(home))[base]).body
            node.body += [part for part in parts if isinstance(part, ast.FunctionDef) and part.name not in own]
    return node


def origin(module, name):
    """Returns the module beside this one from which it imports a name; None if there is none."""
    for node in tree_of(module).body:
        if isinstance(node, ast.ImportFrom) and node.level == 1 and name in {alias.name for alias in node.names}:
            return ".".join([*module.split(".")[:-1], node.module])
    return None


def package_names():
    """Returns the functions and classes of petsam.__all__: name to (module, definition), in the order of the page."""
    homes = {name: home.lstrip(".") for name, home in petsam._HOMES.items()}
    for node in tree_of("__init__").body:
        if isinstance(node, ast.ImportFrom):
            homes.update({alias.name: node.module for alias in node.names})
    names = [name for name in petsam.__all__ if name not in petsam._PARTS]
    names.sort(key=lambda name: (FIRST.index(name) if name in FIRST else len(FIRST), name))
    modules = {name: homes.get(name, "__init__") for name in names}
    return {name: (module, public(module)[name]) for name, module in modules.items()}


def face(module):
    """Returns the name by which users call a module."""
    known = {home.lstrip("."): name for name, home in petsam._PARTS.items()}
    return "petsam." + known.get(module, module.removeprefix("apps."))


def chosen(part, homes):
    """Returns those names of a part, {module: names}, that are functions and classes: {name: definition}."""
    within = part.package.partition(".")[2]
    pairs = [(f"{within}.{module}", name) for module, names in homes.items() if module for name in names]
    return {name: public(module)[name] for module, name in pairs if name in public(module)}


def of_part(part):
    """Returns the headings of a part, and of each the first docstring and {name: definition}: its own list, and modules
    that it lists as a whole."""
    within = part.package.partition(".")[2]
    found = {f"petsam.{part.name}.{name}": node for name, node in chosen(part, part.names).items()}
    if part is plot.PART:
        for one in apps.records():
            found.update({f"petsam.plot.{name}": node for name, node in chosen(one, one.pictures).items()})
    whole = {f"petsam.{part.name}": (about(f"{within}/__init__"), found)}
    return {**whole, **dict(of_module(f"{within}.{name}") for name in part.names.get("", ()))}


def of_module(module):
    """Returns the heading of a module, and its first docstring with {name: definition} of its __all__, or of all that
    it defines."""
    defined = public(module)
    names = constant(module, "__all__") or defined
    return face(module), (about(module), {f"{face(module)}.{name}": defined[name] for name in defined if name in names})


def about(module):
    return ast.get_docstring(tree_of(module)).split("\n\n")[0]


def signature(name, node):
    """Returns the lines of the call of a function or the head of a class; a property's name alone."""
    if isinstance(node, ast.ClassDef):
        made = next((part for part in node.body if getattr(part, "name", "") == "__init__"), None)
        return [f"class {name}{arguments(made.args, True) if made else ''}"]
    if is_property(node):
        return [name]
    result = "" if node.returns is None or ast.unparse(node.returns) == "None" else f" -> {text_of(node.returns)}"
    return [name + arguments(node.args, bool(callers(node.args))) + result]


def callers(args):
    """Returns self or cls of a method, in a list."""
    return [arg for arg in args.args[:1] if arg.arg in ("self", "cls")]


def text_of(hint):
    """Returns a hint as it reads: one that is a text, of what is not imported, without its quotes."""
    return hint.value if isinstance(hint, ast.Constant) and isinstance(hint.value, str) else ast.unparse(hint)


def arguments(args, is_method):
    shown = ast.parse(f"def f({ast.unparse(args)}): pass").body[0].args
    for arg in parameters(shown):
        if arg.annotation is not None:
            arg.annotation = ast.Name(text_of(arg.annotation))
    listed = ast.unparse(shown)
    listed = re.sub(r"^(self|cls)(: \w+)?(, )?", "", listed) if is_method else listed
    return f"({listed})"


def parameters(args):
    """Returns the parameters of a function or method without self and cls."""
    listed = [*args.posonlyargs, *args.args, args.vararg, *args.kwonlyargs, args.kwarg]
    return [arg for arg in listed if arg and arg not in callers(args)]


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


def is_property(node):
    return bool({ast.unparse(decorator) for decorator in node.decorator_list} & set(PROPERTIES))


def has_values_only(node):
    """Returns whether a definition is a class without methods, but for table()."""
    parts = definitions(node).items() if isinstance(node, ast.ClassDef) else [("", node)]
    return all(name == "table" or is_property(part) for name, part in parts)


def callables(names):
    """Returns the functions and methods of {name: definition}, properties too, by name."""
    found = {}
    for name, node in names.items():
        is_class = isinstance(node, ast.ClassDef)
        found.update({f"{name}.{one}": part for one, part in definitions(node).items()} if is_class else {name: node})
    return found


def returned(names):
    """Returns the classes of values among {name: definition} that a function or method among them returns: for each the
    first one that does."""
    found = {}
    for name, node in names.items():
        word = re.compile(rf"\b{name.rpartition('.')[2]}\b")
        if isinstance(node, ast.ClassDef) and has_values_only(node):
            makers = (
                maker
                for maker, part in callables(names).items()
                if part.returns is not None and word.search(text_of(part.returns)) and not maker.startswith(f"{name}.")
            )
            found[name] = next(makers, None)
    return {name: maker for name, maker in found.items() if maker}


def values(name, node):
    """Returns the lines about a class of values below the function that returns it."""
    lines = [f"**{name.rpartition('.')[2]}**", "", *body(ast.get_docstring(node))]
    parts = [(part, text) for part, text in definitions(node).items() if is_property(text)]
    lines += [f"- `{part}`: {functions.escape(' '.join(ast.get_docstring(text).split()))}" for part, text in parts]
    return lines + [""] * bool(parts)


def entry(level, name, node, below=None):
    """Returns the lines of a function, or of a class with its methods; below: {function: lines} behind those."""
    short = name.rpartition(".")[2] if isinstance(node, ast.ClassDef) else name
    lines = [f"{'#' * level} {name}", "", "```python", *signature(name, node), "```", ""]
    lines += [*body(ast.get_docstring(node)), *(below or {}).get(name, ())]
    if isinstance(node, ast.ClassDef):
        for method, part in definitions(node).items():
            lines += [*entry(level + 1, f"{short}.{method}", part), *(below or {}).get(f"{name}.{method}", ())]
    return lines


def body(text):
    """Returns the lines of a docstring."""
    lines = []
    for part in re.split(r"\n\s*\n", text or ""):
        found = SECTION.match(part)
        if found and found[1] != "Notes":
            lines += [section(found[1], part[found.end() :]), ""]
        else:
            lines += [paragraph(part[found.end() :] if found else part), ""]
    return lines


def listed():
    """Returns the contents of the page: headings, and of each the first docstring and {name: definition}."""
    package = {f"petsam.{name}": node for name, (_, node) in package_names().items()}
    for module, names in OBTAINED.items():
        package.update({f"petsam.contact.{name}": definitions(tree_of(module))[name] for name in names})
    parts = {"petsam": (about("__init__"), package), **dict(map(of_module, BEFORE))}
    for part in (plot.PART, *apps.records()):
        parts.update(of_part(part))
    return {**parts, **dict(map(of_module, BEHIND))}


def undocumented():
    """Returns the names on the page, those of methods too, that have no docstring."""
    found = []
    for _, names in listed().values():
        for name, node in names.items():
            methods = definitions(node) if isinstance(node, ast.ClassDef) else {}
            parts = {name: node, **{f"{name}.{method}": part for method, part in methods.items()}}
            found += [part for part, definition in parts.items() if not ast.get_docstring(definition)]
    return found


def sections(text):
    """Returns the names in each section of a docstring: {title: names}."""
    found = {}
    for part in re.split(r"\n\s*\n", text or ""):
        head = SECTION.match(part)
        if head:
            heads = re.findall(r"^(\S.*?)(?: : .*)?$", part[head.end() :], re.M)
            found[head[1]] = {name.lstrip("*") for one in heads for name in one.split(", ")}
    return found


def unhinted(name, node, text=None):
    """Returns what hints and sections lack of a function, or of a class with its methods."""
    if isinstance(node, ast.ClassDef):
        made = [part for part in node.body if getattr(part, "name", None) == "__init__"]
        lacks = [lack for part in made for lack in unhinted(name, part, ast.get_docstring(node))]
        return lacks + [lack for one, part in definitions(node).items() for lack in unhinted(f"{name}.{one}", part)]
    told = sections(ast.get_docstring(node) if text is None else text)
    lacks = [f"{name}: {arg.arg} has no hint" for arg in parameters(node.args) if arg.annotation is None]
    lacks += [
        f"{name}: {arg.arg} is not in Parameters"
        for arg in parameters(node.args)
        if arg.arg not in told.get("Parameters", ())
    ]
    if node.returns is None:
        lacks.append(f"{name}: no hint of what it returns")
    elif ast.unparse(node.returns) != "None" and not is_property(node) and "Returns" not in told:
        lacks.append(f"{name}: no section Returns")
    return lacks


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
        made, below = returned(names), {}
        for name, maker in made.items():
            below.setdefault(maker, []).extend(values(name, names[name]))
        lines += [line for name in names if name not in made for line in entry(3, name, names[name], below)]
    return "\n".join(lines)


if __name__ == "__main__":
    print(page())
