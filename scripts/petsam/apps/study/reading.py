"""The text of a study's table, CSV or YAML, as names and values; errors with their place."""

import collections
import os
import re
from typing import NamedTuple

import yaml

from ...core.errors import Error, Unusable, short
from ...core.files import need_regular
from ...core.texttable import Form, Text
from .expressions import check

CSV, YAML = 64 << 20, 1 << 20  # maximum bytes of a table; reading YAML takes long
VALUE = 16384  # maximum characters of a value: the system limits the words of a command
NAME = re.compile(r"[A-Za-z]\w*")  # of an option or a parameter
UNIT = re.compile(r"[A-Za-z1%][\w%/^. -]{0,19}")
KEYS = ("options", "parameters", "files", "ranks", "units", "stress", "results")
EXAMPLE = ("options:", "  load_tx: [30, 60, 90]")
# files in the folder of every case (runs.py), and of petsam
FOLDER = re.compile(r"(petsam\.log|record\.json|lock|(results(\.part\d+)?|stress)\.h5|checkpoint.*)(\..*)?")
FILE_NAME = 251  # bytes: it is written as NAME.tmp first
# numbers that YAML 1.1 and petsam read alike: not 010, which is 8 to YAML, 0x10, 0b1 or 1_000
ALIKE = re.compile(r"[-+]?(0|[1-9]\d*|\d*\.\d*(e[-+]?\d+)?|\.(inf|nan))", re.IGNORECASE)
SCALARS = {"tag:yaml.org,2002:" + kind for kind in ("null", "bool", "int", "float", "str", "timestamp")}


class TableError(Unusable):
    """A table that cannot be understood; the message names the file, and the line or the key."""


def _plain(name):
    return name.strip().lstrip("-")


def _text_of(path, limit):
    """All text of a file, without the mark of its encoding."""
    size = need_regular(path).st_size
    if size > limit:
        raise TableError(f"{path}: has {size} bytes; use at most {limit}")
    with open(path, "rb") as file:
        data = file.read(limit + 1)
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise TableError(f"{path}, line 1: is UTF-16; save it as UTF-8")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise TableError(f"{path}, line {line}: is not UTF-8; save it as UTF-8") from error
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        raise TableError(f"{path}, line {line}: contains a NUL character; remove it")
    return text


def _check_value(value, where):
    """Raises Error if the value cannot be a word of a command."""
    if value is None:
        return
    if len(value) > VALUE:
        raise TableError(f"{where}: a value of {len(value)} characters; use at most {VALUE}")
    if "\0" in value or not _encodes(value):
        raise TableError(f"{where}: {short(value)}: contains an invalid character; remove it")


def _encodes(text):
    try:
        text.encode()
    except UnicodeEncodeError:  # half of a surrogate pair
        return False
    return True


# ---------------------------------------------------------------- CSV


def _check_columns(path, number, names):
    counts = collections.Counter(name.lower() for name in names)  # petsam takes load_n and Load_N for one
    for name in names:
        if not NAME.fullmatch(name) or counts[name.lower()] > 1:
            reason = "is not an option's name" if counts[name.lower()] == 1 else "appears twice"
            raise TableError(f"{path}, line {number}: column {short(name) or repr('')}: {reason}")


def read_csv(path):
    """Names of the columns, and rows as (line's number, values by name without the empty ones)."""
    text = Text(path, Form(comments=("#",)), _text_of(path, CSV))
    if len(text.kept) < 2:
        raise TableError(f"{path}: expected a line of option names and at least one case")
    try:
        # as in histories: spreadsheets write semicolons where the decimal sign is a comma
        table = text.headed("case", "cases", separators=(";", ","))
        names = [_plain(name) for name in table.words]
        _check_columns(path, table.head, names)
        rows = table.body
    except Error as error:
        raise TableError(str(error)) from error
    for number, words in rows:
        for word in words:
            _check_value(word, f"{path}, line {number}")
    return names, [(number, {name: word for name, word in zip(names, words) if word}) for number, words in rows]


# ---------------------------------------------------------------- YAML


class Table(NamedTuple):
    """A YAML table: parameters and options as {name: list of texts}, files as {name: text}, ranks as text or None,
    names of the parameters and options with lists, {name: line} of all, options of petsam-stress as {name: text},
    expressions of results as {name: text}, and units of parameters and of these results as {name: text}."""

    parameters: dict
    options: dict
    files: dict
    ranks: str
    lists: list
    lines: dict
    stress: dict
    results: dict
    units: dict


class _Reader:
    """Values of YAML's nodes. Of these a table has few kinds, and each is looked at once: no alias makes it large."""

    def __init__(self, path, loader):
        self.path, self.loader, self.lines = path, loader, {}

    def error(self, text, node=None):
        """The exception to raise, with the line of a node."""
        return TableError("{}{}: {}".format(self.path, f", line {node.start_mark.line + 1}" if node else "", text))

    def pairs(self, node, key):
        """{name: node} of a mapping below a key."""
        if not isinstance(node, yaml.MappingNode):
            raise self.error(f"{key}: expected names and values")
        found = {}
        for name, value in node.value:
            if not isinstance(name, yaml.ScalarNode) or not name.tag.endswith(":str"):
                shown = short(name.value) if isinstance(name, yaml.ScalarNode) else "a list"
                raise self.error(f"{key}: {shown}: is not a name; quote a name that looks like another value", name)
            if name.value in found:
                raise self.error(f"{short(name.value)}: appears twice", name)
            found[name.value] = value
            self.lines[name.value] = name.start_mark.line + 1
        return found

    def empty(self, node):
        """True if there is no value."""
        return node is None or isinstance(node, yaml.ScalarNode) and node.tag.endswith(":null")

    def scalar(self, node, most=VALUE):
        """A scalar as petsam takes it; None for an option without a value."""
        if node.tag not in SCALARS:
            raise self.error(f"{short(node.value)}: expected a number, a string, true or false", node)
        if len(node.value) > most:
            raise self.error(f"a value of {len(node.value)} characters; use at most {most}", node)
        if node.tag.endswith((":str", ":timestamp")) or ":" in node.value:  # 7:18 are steps, not base 60
            value = node.value
        else:
            try:
                value = self.loader.construct_object(node)
                value = None if value is None else repr(value).lower() if isinstance(value, bool) else repr(value)
            except (ValueError, ArithmeticError, yaml.YAMLError) as error:
                raise self.error(f"{short(node.value)}: is not a number", node) from error
            if node.tag.endswith((":int", ":float")) and not ALIKE.fullmatch(node.value):
                what = f"is {short(value)} in YAML: write a decimal number, or quote it"
                raise self.error(f"{short(node.value)}: {what}", node)
        if value is not None and most == VALUE:
            _check_value(value, f"{self.path}, line {node.start_mark.line + 1}")
        return value

    def choices(self, node, key):
        """Returns {name: list of texts} of a section, and the names of the entries with lists."""
        choices, lists = {}, []
        for name, value in self.pairs(node, key).items():
            values = value.value if isinstance(value, yaml.SequenceNode) else [value]
            if not values or not all(isinstance(one, yaml.ScalarNode) for one in values):
                raise self.error(f"{key}: {short(name)}: expected a value or a list of values")
            plain = _plain(name)
            if not NAME.fullmatch(plain):
                raise self.error(f"{key}: {short(name)}: is not an option's name", value)
            if plain.lower() in map(str.lower, choices):
                raise self.error(f"{plain}: appears twice", value)
            choices[plain] = [self.scalar(one) for one in values]
            self.lines[plain] = value.start_mark.line + 1
            lists += [plain] if isinstance(value, yaml.SequenceNode) else []
        return choices, lists

    def files(self, node):
        """Returns {name: text}."""
        found = {} if self.empty(node) else self.pairs(node, "files")
        for name, value in found.items():
            text = isinstance(value, yaml.ScalarNode) and value.tag.endswith(":str")
            if not text or os.path.basename(name) != name or name in ("", ".", "..") or not _encodes(name):
                raise self.error("files: expected names without folders, each with a string")
            if "\0" in name or len(name.encode()) > FILE_NAME:
                raise self.error(f"files: {short(name)}: use at most {FILE_NAME} characters, without NUL", value)
            if FOLDER.fullmatch(name) or name.endswith(".tmp") and name[:-4] in found:
                raise self.error(f"files: {name}: is reserved in the folder of a case; use another name", value)
            if not _encodes(value.value):
                raise self.error(f"files: {name}: contains an invalid character; remove it", value)
        return {name: self.scalar(value, YAML) for name, value in found.items()}

    def table(self, root):
        """Returns the whole table."""
        sections = self.pairs(root, "the table") if isinstance(root, yaml.MappingNode) else {}
        if "options" not in sections:
            error = self.error("expected a section `options` with one line per option of petsam, such as")
            error.example = EXAMPLE
            raise error
        for key in sections:
            if key not in KEYS:
                raise self.error(f"{short(key)}: unknown; use {', '.join(KEYS[:-1])} or {KEYS[-1]}")
        ranks, place = sections.get("ranks"), self.lines.get("ranks")
        parameters, lists = {}, []
        if not self.empty(sections.get("parameters")):
            parameters, lists = self.choices(sections["parameters"], "parameters")
        options, more = self.choices(sections["options"], "options")
        double = set(parameters) & set(options)
        if double:
            raise self.error(f"{sorted(double)[0]}: is both a parameter and an option")
        if ranks is not None and not isinstance(ranks, yaml.ScalarNode):
            raise self.error("ranks: expected a number", ranks)
        files = self.files(sections.get("files"))
        if place and "ranks" not in {**parameters, **options}:
            self.lines["ranks"] = place
        stress, results = (self.single(sections.get(key), key, {**parameters, **options}) for key in KEYS[-2:])
        ranks = ranks and self.scalar(ranks)
        units = self.units(sections.get("units"), {**parameters, **results})
        return Table(parameters, options, files, ranks, lists + more, self.lines, stress, results, units)

    def units(self, node, names):
        """Returns {name: unit} of parameters and results of the table's own; petsam's options have theirs."""
        found = {} if self.empty(node) else self.pairs(node, "units")
        for name, value in found.items():
            if name not in names:
                raise self.error(f"units: {short(name)}: is not one of `parameters` or `results`; remove it", value)
            if not isinstance(value, yaml.ScalarNode) or not UNIT.fullmatch(value.value):
                raise self.error(f"units: {short(name)}: expected a unit such as m, N/m or Pa", value)
        return {name: value.value for name, value in found.items()}

    def single(self, node, key, others):
        """Returns {name: text} of a section without lists; the names of results must not be those of inputs."""
        if self.empty(node):
            return {}
        found, lists = self.choices(node, key)
        if lists:
            raise self.error(f"{key}: {lists[0]}: is a list; give one value, which may hold expressions", node)
        for name, (text,) in found.items() if key == "results" else ():
            if name in others:
                raise self.error(f"results: {name}: is an input; use another name", node)
            try:
                check(text or "")
            except ValueError as error:
                raise self.error(f"results: {name}: {short(text)}: {error}", node) from error
        return {name: text for name, (text,) in found.items()}


def _problem(error, text):
    """Line, if known, and words of YAML's message."""
    mark, words = getattr(error, "problem_mark", None), getattr(error, "problem", None) or ""
    if isinstance(error, yaml.reader.ReaderError):
        return text.count("\n", 0, error.position) + 1, "contains a character that YAML does not allow"
    if words.startswith("but "):
        words = (getattr(error, "context", None) or "") + " " + words
    return mark.line + 1 if mark else None, words or str(error)


def read_yaml(path):
    """The Table of a YAML file."""
    text = _text_of(path, YAML)
    try:
        loader = yaml.SafeLoader(text)
        return _Reader(path, loader).table(loader.get_single_node())
    except yaml.YAMLError as error:
        line, words = _problem(error, text)
        raise TableError("{}{}: {}".format(path, f", line {line}" if line else "", words)) from error
    except (RecursionError, ValueError, TypeError, AttributeError, LookupError, ArithmeticError, MemoryError) as error:
        # other exceptions of PyYAML, for deep nesting and for invalid escapes
        reason = "is nested too deeply" if isinstance(error, RecursionError) else f"is not YAML: {error}"
        raise TableError(f"{path}: {reason}") from error
