"""The cases of a study, from its table: a CSV file with a row a case, or a small YAML file of combinations.

CSV: the first line names options of petsam (with or without their dash), each further row is a case; an empty cell
leaves the option out, `#` starts a comment. A column `ranks` gives a case's MPI ranks, a column `case` its name.

YAML: `options` maps options of petsam to a value or to a list; every combination of the lists is a case. `parameters`
is the same for names that are no options, `files` maps names of files that every case gets in its own folder to their
text, `ranks` is the number of MPI ranks. Anywhere a text may hold {expressions} of parameters and options.

Options that name files are meant relative to the table.
"""

import csv
import hashlib
import itertools
import os
import re
from typing import NamedTuple

import yaml

from ..errors import Error
from .expressions import Expander

# options that name files which are read; -load_history is another spelling of -history
PATHS = ("options_file", "history", "load_history", "gap_file", "gap_rough_file", "friction_file")
# of these, small texts; of the others size and time tell whether they have changed
HASHED = ("options_file", "history", "load_history")
TAKEN = {
    "output": "petsam-study names the results",
    "checkpoint": "see --checkpoint",
    "restart": "see --checkpoint",
    "checkpoint_every": "see --checkpoint",
}


class TableError(Error):
    """A table that cannot be understood; the message names the file, and the line or the key."""


class Case(NamedTuple):
    """One run: number (from 1), name, inputs (name: text; the lists' values, or the columns), options (name: text or
    None), files (name: text), MPI ranks."""

    number: int
    name: str
    inputs: dict
    options: dict
    files: dict
    ranks: int

    def words(self):
        """The command line of petsam but for the results' name."""
        return [
            word
            for name, value in self.options.items()
            for word in (["-" + name] if value is None else ["-" + name, value])
        ]

    def identity(self):
        """Digest of all that determines the results: options, and the contents of the files they name."""
        parts = []
        for name, value in self.options.items():
            if name in PATHS and value in self.files:
                value = self.files[value]
            elif name in PATHS and value:
                value = _content(value) if name in HASHED else _stamp(value)
            parts.append((name, value))
        return hashlib.sha256(repr(parts).encode()).hexdigest()


def _content(path):
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            return file.read()
    except OSError:
        return ""  # petsam will say so


def _stamp(path):
    try:
        status = os.stat(path)
        return f"{path} {status.st_size} {status.st_mtime_ns}"
    except OSError:
        return ""


# ---------------------------------------------------------------- reading


def _plain(name):
    return name.strip().lstrip("-")


def _text(value):
    """A scalar of YAML as petsam takes it; None for an option without a value."""
    if value is None:
        return None
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value) if isinstance(value, float) else str(value)


def _read_csv(path):
    """Names of the columns, and rows as (line's number, values by name without the empty ones)."""
    with open(path, encoding="utf-8-sig", newline="") as file:
        # blank lines and comments go, but lines are counted
        lines = [
            (number, line) for number, line in enumerate(file, 1) if line.strip() and not line.lstrip().startswith("#")
        ]
    rows = [
        (number, [cell.strip() for cell in row])
        for (number, _), row in zip(lines, csv.reader((line for _, line in lines), skipinitialspace=True))
    ]
    if len(rows) < 2:
        raise TableError(f"{path}: expected a line of option names and at least one case")
    names = [_plain(name) for name in rows[0][1]]
    for name in names:
        if not re.fullmatch(r"[A-Za-z]\w*", name) or names.count(name) > 1:
            raise TableError(
                "{}, line {}: column {}: {}".format(
                    path, rows[0][0], name or "''", "is no option's name" if names.count(name) == 1 else "appears twice"
                )
            )
    for number, row in rows[1:]:
        if len(row) != len(names):
            raise TableError(f"{path}, line {number}: {len(row)} values for {len(names)} columns")
    return names, [(number, {name: value for name, value in zip(names, row) if value}) for number, row in rows[1:]]


def _choices(path, key, mapping):
    """Name: list of texts, of a section of the YAML file."""
    if not isinstance(mapping, dict):
        raise TableError(f"{path}: {key}: expected names and values")
    choices = {}
    for name, value in mapping.items():
        values = value if isinstance(value, list) else [value]
        if not values or any(isinstance(one, (list, dict)) for one in values):
            raise TableError(f"{path}: {key}: {name}: expected a value or a list of values")
        choices[_plain(str(name))] = [_text(one) for one in values]
    return choices


def _read_yaml(path):
    """The YAML file: parameters and options as choices, files as texts, ranks as text; names of those with lists."""
    with open(path, encoding="utf-8") as file:
        try:
            table = yaml.safe_load(file)
        except yaml.YAMLError as error:
            mark = getattr(error, "problem_mark", None)
            raise TableError(
                "{}{}: {}".format(
                    path, f", line {mark.line + 1}" if mark else "", getattr(error, "problem", None) or error
                )
            ) from error
    if not isinstance(table, dict) or "options" not in table:
        raise TableError(f"{path}: expected a section `options`")
    for key in table:
        if key not in ("options", "parameters", "files", "ranks"):
            raise TableError(f"{path}: {key}: unknown; known are options, parameters, files and ranks")
    files = table.get("files") or {}
    if not isinstance(files, dict) or not all(
        isinstance(text, str) and os.path.basename(name) == name for name, text in files.items()
    ):
        raise TableError(f"{path}: files: expected names without folders, and texts")
    sections = [table.get("parameters") or {}, table["options"]]
    parameters, options = (_choices(path, key, one) for key, one in zip(("parameters", "options"), sections))
    lists = [_plain(str(name)) for one in sections for name, value in one.items() if isinstance(value, list)]
    return parameters, options, files, _text(table.get("ranks")), lists


# ---------------------------------------------------------------- cases


def _name(inputs):
    """A folder's name for what differs, which does not change when cases are added."""
    text = "_".join("{}={}".format(name, os.path.basename(value or "")) for name, value in inputs.items()) or "case"
    text = re.sub(r"[^A-Za-z0-9.,=+_-]", "-", text)
    if len(text) > 100:
        text = text[:90] + "-" + hashlib.sha256(repr(sorted(inputs.items())).encode()).hexdigest()[:8]
    return text


def _ranks(text, where):
    try:
        ranks = int(float(text))
    except ValueError:
        ranks = 0
    if ranks < 1:
        raise TableError(f"{where}: ranks {text}: expected a number from 1")
    return ranks


def _located(options, files, folder):
    """Options with their files' absolute paths; those that the case gets in its own folder stay."""
    return {
        name: os.path.normpath(os.path.join(folder, value)) if name in PATHS and value and value not in files else value
        for name, value in options.items()
    }


def common_options(words):
    """Options given on the command line for all cases; their files are meant relative to the present folder."""
    options, name = {}, None
    for word in words:
        if re.match(r"-[A-Za-z]", word):
            name = word[1:]
            options[name] = None
        elif name is None or options[name] is not None:
            raise TableError(f"{word}: expected an option, that is a word that begins with a dash")
        else:
            options[name] = word
    return _located(options, {}, os.getcwd())


def _csv_cases(path, _common):
    """(where, inputs, options, files, ranks, name) of each row; what differs makes the name."""
    names, rows = _read_csv(path)
    varied = [
        name for name in names if name not in ("ranks", "case") and len({values.get(name) for _, values in rows}) > 1
    ]
    for number, values in rows:
        ranks, name = values.pop("ranks", None), values.pop("case", None)
        yield (
            f"line {number}",
            values,
            values,
            {},
            ranks,
            name or _name({key: values[key] for key in varied if key in values}),
        )


def _yaml_cases(path, common):
    """The same of each combination; what is common to all counts in expressions, too."""
    parameters, options, files, ranks, lists = _read_yaml(path)
    options.update({name: [value] for name, value in common.items() if name in options})
    double = set(parameters) & set(options)
    if double:
        raise TableError(f"{path}: {sorted(double)[0]}: is both a parameter and an option")
    choices = {**parameters, **options}
    for combination in itertools.product(*choices.values()):
        values = dict(zip(choices, combination))
        expander, where = Expander(values), ", ".join(f"{name} = {values[name]}" for name in lists)
        try:
            expanded = {name: expander.text(name) for name in values}
            texts = {name: expander.expand(text) for name, text in files.items()}
            count = expanded.get("ranks") or expander.expand(ranks)
        except ValueError as error:
            raise TableError(f"{path}: {error}") from error
        inputs = {name: expanded[name] for name in lists}
        yield where, inputs, {name: expanded[name] for name in options}, texts, count, _name(inputs)


def read(path, common=None, ranks=1):
    """The cases of a table, with options common to all (which override the table's) and the ranks of those without."""
    kind = _yaml_cases if path.endswith((".yaml", ".yml")) else _csv_cases
    folder, common, cases, seen = os.path.dirname(os.path.abspath(path)), common or {}, [], {}
    for where, inputs, options, files, count, name in kind(path, common):
        where = f"{path}, {where}" if where else path
        for option in {**options, **common}:
            if option in TAKEN:
                raise TableError(f"{where}: -{option}: {TAKEN[option]}")
        if not re.fullmatch(r"[A-Za-z0-9.,=+_-]+", name) or not name.strip("."):
            raise TableError(f"{where}: case {name}: expected letters, digits and .,=+_-")
        if name in seen:
            raise TableError(f"{where}: the same name, {name}, as {seen[name]}; a column `case` tells them apart")
        seen[name] = where
        cases.append(
            Case(
                len(cases) + 1,
                name,
                inputs,
                {**_located(options, files, folder), **common},
                files,
                _ranks(count, where) if count else ranks,
            )
        )
    return cases
