"""The cases of a study, from its table: a CSV file with one row per case, or a small YAML file of combinations.

CSV: the first line names options of petsam (with or without their dash), each further row is a case; an empty cell
leaves the option out, `#` starts a comment. Semicolons separate the columns if the first line has one. A column
`ranks` gives a case's MPI ranks, a column `case` its name.

YAML: `options` maps options of petsam to a value or to a list; every combination of the lists is a case. `parameters`
is the same for names that are no options, `files` maps names of files that every case gets in its own folder to their
text, `ranks` is the number of MPI ranks. Anywhere a text may hold {expressions} of parameters and options. `stress`
maps options of petsam-stress, which then runs after each case; `results` maps names of columns to expressions of
inputs, of other columns and of results.

Options that name files are meant relative to the table. A study has at most CASES cases.
"""

import hashlib
import itertools
import math
import os
import re
from typing import NamedTuple, Optional

from ...core import declared
from ...core.errors import Error, short
from ...core.files import decoded, need_regular
from .expressions import Expander, names_in
from .reading import TableError, read_csv, read_yaml

# options that name files; -load_history is another spelling of -history
PATHS = ("load_history", *declared.PATHS)
# of these, small texts; of the others size and time tell whether they have changed
HASHED = (
    "options_file", "history", "load_history", "wear_friction", "body1_layer_file", "body2_layer_file",
    "body1_initial_stress", "body2_initial_stress",
)  # fmt: skip
SMALL = 16 << 20  # bytes; a larger text is compared as the others are
TAKEN = {
    "output": "petsam-study chooses the file; remove the option",
    "checkpoint": "use --checkpoint instead",
    "restart": "use --checkpoint instead",
    "checkpoint_every": "use --checkpoint instead",
}


CASES = 100000  # of a study at most
FILES = 100 << 20  # characters of all files that the cases of a YAML table get
RANKS = 1000000  # of a case at most
# files of petsam-study beside the cases' folders
OWN = re.compile(r"results\.(csv|h5)(\.tmp)?|slurm-\d+(_\d+)?\.out")
NAME = 255  # bytes of a file's name


class Case(NamedTuple):
    """One run.

    Attributes
    ----------
    number : int
        Its number, from 1.
    name : str
        Its name, which is that of its folder.
    inputs : dict
        {name: text} of the lists' values, or of the columns.
    options : dict
        {name: text or None} of petsam.
    files : dict
        {name: text} of the files that it gets in its folder.
    ranks : int
        MPI ranks.
    stress : dict
        {name: text or None} of petsam-stress.
    results : dict
        {name: text}: expressions of results.
    values : dict
        {name: text} of all parameters and options that these may use.
    units : dict
        {name: unit} of parameters and of such results.
    """

    number: int
    name: str
    inputs: dict
    options: dict
    files: dict
    ranks: int
    stress: dict = {}
    results: dict = {}
    values: dict = {}
    units: dict = {}

    def words(self, options: Optional[dict[str, Optional[str]]] = None) -> list[str]:
        """The command line of petsam, or of petsam-stress, but for the results' name.

        An options file comes first: of an option that is in it, too, the last value counts, which is the table's.

        Parameters
        ----------
        options : dict, optional
            {name: text or None}; None: those of petsam.

        Returns
        -------
        list of str
            Words of the command line.
        """
        given = self.options if options is None else options
        ordered = sorted(given.items(), key=lambda item: item[0] != "options_file")
        return [word for name, value in ordered for word in (["-" + name] if value is None else ["-" + name, value])]

    def paths(self) -> dict[str, str]:
        """The files that petsam reads and this class does not write.

        Returns
        -------
        dict
            {option: path}.
        """
        return {
            name: value for name, value in self.options.items() if name in PATHS and value not in (None, *self.files)
        }

    def identity(self) -> str:
        """A digest of all that determines the results: options, and the contents of the files they name.

        Returns
        -------
        str
            SHA-256 in hexadecimal digits.
        """
        parts = [("files", sorted(self.files.items()))] if self.files else []
        for name, value in self.options.items():
            if name == "options_file" and value:
                parts += _stamps_in(self.files.get(value) or _content(value))
            if name in PATHS and value and value not in self.files:
                value = [_content(path) if name in HASHED else _stamp(path) for path in _each(name, value)]
            parts.append((name, value))
        if self.stress:
            parts.append(("stress", sorted(self.stress.items())))
        return hashlib.sha256(repr(parts).encode()).hexdigest()


def _content(path):
    try:
        if need_regular(path).st_size > SMALL:
            return _stamp(path)
        with open(path, "rb") as file:
            return decoded(file.read())
    except (OSError, Error):
        return path  # petsam reports it


def _stamps_in(text):
    """Returns the stamps of the files that an options file names by their whole paths."""
    named = re.findall(r'^\s*--?(\w+)\s+("[^"]*"|\S+)', text, re.MULTILINE)
    paths = [value.strip('"') for name, value in named if name in PATHS]
    return [_stamp(path) for path in paths if os.path.isabs(path)]


def _stamp(path):
    try:
        status = os.stat(path)
        return f"{path} {status.st_size} {status.st_mtime_ns}"
    except (OSError, ValueError):
        return ""


# ---------------------------------------------------------------- cases


def _shown(value):
    """Returns a value as it stands in a folder's name: a file without its folder, a unit with its slash."""
    return value if value.lstrip("+-.0123456789eE") in declared.FOLLOWING else os.path.basename(value)


def _name(inputs):
    """Returns a folder's name from the inputs that vary; it does not change when cases are added."""
    text = "_".join("{}={}".format(name, _shown(value or "")) for name, value in inputs.items()) or "case"
    text = re.sub(r"[^A-Za-z0-9.,=+_-]", "-", text)
    if len(text) > 100:
        text = text[:90] + "-" + hashlib.sha256(repr(sorted(inputs.items())).encode()).hexdigest()[:8]
    return text


def _ranks(text, where):
    try:
        ranks = float(text)
    except ValueError:
        ranks = math.nan
    if not (1 <= ranks <= RANKS and ranks == int(ranks)):
        raise TableError(f"{where}: ranks {short(text)}: use an integer from 1 to {RANKS}")
    return int(ranks)


def _each(name, value):
    """The files that an option names."""
    return value.split(",") if name == "plugin" else [value]


def _located(options, files, folder):
    """Options with their files' absolute paths; names of files in the case's own folder stay."""

    def locate(path):
        return os.path.normpath(os.path.join(folder, path))

    return {
        name: ",".join(map(locate, _each(name, value))) if name in PATHS and value and value not in files else value
        for name, value in options.items()
    }


def _one_spelling(name):
    """One spelling of all names that petsam takes for the same option."""
    return "history" if name.lower() == "load_history" else name.lower()


def common_options(words):
    """Options given on the command line for all cases; their files are meant relative to the present folder."""
    options, name, seen = {}, None, set()
    for word in words:
        if re.match(r"-[A-Za-z]", word):
            name = word[1:]
            if _one_spelling(name) in seen:
                raise TableError(f"{word}: given twice for all cases: remove one of them")
            seen.add(_one_spelling(name))
            options[name] = None
        elif name is None or options[name] is not None:
            raise TableError(f"{word}: expected an option: it begins with a dash")
        else:
            options[name] = word
    return _located(options, {}, os.getcwd())


def _csv_cases(path, _common):
    """(where, inputs, options, files, ranks, name, rest) of each row; the inputs that vary make the name."""
    names, rows = read_csv(path)
    _need_few(path, len(rows))
    varied = [
        name for name in names if name not in ("ranks", "case") and len({values.get(name) for _, values in rows}) > 1
    ]
    for number, values in rows:
        ranks, name = values.pop("ranks", None), values.pop("case", None)
        where = f"{path}, line {number}"
        yield (
            where,
            values,
            values,
            {},
            (ranks, where),
            name or _name({key: values[key] for key in varied if key in values}),
            (),
        )


def _need_few(path, count):
    if count > CASES:
        raise TableError(f"{path}: {count:.6g} cases; use at most {CASES}")


def _check_used(path, table):
    """Raises Error if nothing uses a parameter: its values would make no difference between cases."""
    texts = [text for values in table.options.values() for text in values]
    texts += [*table.files.values(), *table.stress.values(), table.ranks]
    texts += [f"{{{expression}}}" for expression in table.results.values()]
    used, waiting = {"ranks"}, names_in(texts)
    while waiting:
        name = waiting.pop()
        used.add(name)
        waiting |= names_in(table.parameters.get(name, ())) - used
    for name in table.parameters:
        if name not in used:
            raise TableError(
                f"{path}, line {table.lines[name]}: parameters: {name}: nothing uses it; write {{{name}}} where its "
                "value belongs, or remove it"
            )


def _yaml_cases(path, common):
    """The same of each combination; expressions may use the common options, too."""
    table = read_yaml(path)
    _check_used(path, table)
    choices = {**table.parameters, **table.options}
    choices.update({name: [value] for name, value in common.items() if name in table.options})
    count = math.prod(len(values) for values in choices.values())
    _need_few(path, min(count, 10**300))  # which can be printed
    if count * sum(map(len, table.files.values())) > FILES:
        raise TableError(f"{path}: files: the texts of all {count} cases have more than {FILES} characters")
    for combination in itertools.product(*choices.values()):
        values = dict(zip(choices, combination))
        expander = Expander(values)
        try:
            expanded = {name: expander.text(name) for name in values}
            texts = {name: expander.expand(text) for name, text in table.files.items()}
            ranks = expanded.get("ranks") or expander.expand(table.ranks)
            stress = {name: expander.expand(text) for name, text in table.stress.items()}
        except ValueError as error:
            raise TableError(f"{path}: {error}") from error
        where = ", ".join([path, *(f"{name} = {short(values[name])}" for name in table.lists)])
        inputs = {name: expanded[name] for name in table.lists}
        yield (
            where,
            inputs,
            {name: expanded[name] for name in table.options},
            texts,
            (ranks, "{}, line {}".format(path, table.lines.get("ranks", 1))),
            _name(inputs),
            (stress, table.results, expanded, table.units),
        )


def _check_name(name, where, seen):
    """Raises Error unless the name can be that of a case's folder."""
    if not re.fullmatch(r"[A-Za-z0-9.,=+_-]+", name) or not name.strip("."):
        raise TableError(f"{where}: case {short(name)}: use letters, digits and .,=+_-")
    if len(name) > NAME:
        raise TableError(f"{where}: case {short(name)}: use at most {NAME} characters")
    if OWN.fullmatch(name):
        raise TableError(f"{where}: case {name}: is reserved for a file of petsam-study; use another name")
    if name in seen:
        raise TableError(f"{where}: the same name, {name}, as {seen[name]}; add a column `case` with names")


def _columns(text):
    """Returns the names of a history's columns; none if it has no line of names."""
    lines = (line.split("#")[0].strip() for line in re.split(r"[\r\n]+", text))
    return re.split(r"[,;\s]+", next(filter(None, lines), ""))


def _check_history(path, options, files):
    """Error where a column of the history is an option of the case, too, as it would be in every case."""
    name = options.get("history") or options.get("load_history")
    text = files.get(name) if name in files else _content(name) if name else ""
    for column in _columns(text):
        if column in options:
            raise TableError(
                f"{path}: {column} is an option and a column of {short(name)}: make it one of `parameters`, which the "
                f"file has as {{{column}}}, or leave one out"
            )


def _check_common(path, names, options, common):
    """Raises Error if an option for all cases has the name of a column, a list or a parameter, whose values it would
    replace; in the same spelling it may replace a single value of a YAML table's options."""
    given = {_one_spelling(option): option for option in common}
    for name in names:
        twin = given.get(_one_spelling(name))
        if twin is not None and not (twin == name and name in options):
            what = " ".join(filter(None, [f"-{twin}", common[twin]]))
            raise TableError(f"{path}: {name} is in the table, and {short(what)} is given for all cases: remove one")


def read(path, common=None, ranks=1):
    """The cases of a table, with options common to all (which override single values) and the default of ranks."""
    kind = _yaml_cases if path.lower().endswith((".yaml", ".yml")) else _csv_cases
    folder, common, cases, seen = os.path.dirname(os.path.abspath(path)), common or {}, [], {}
    for where, inputs, options, files, (count, place), name, rest in kind(path, common):
        single = set(options) - set(inputs)
        _check_common(path, {**inputs, **options, **(rest[2] if rest else {})}, single, common)
        for option in {**options, **common}:
            if option in TAKEN:
                raise TableError(f"{where}: -{option}: {TAKEN[option]}")
        for option in {"input", "output"} & set(rest[0] if rest else ()):
            raise TableError(f"{where}: stress: -{option}: petsam-study chooses the file; remove the option")
        _check_name(name, where, seen)
        seen[name] = where
        located = {**_located(options, files, folder), **common}
        _check_history(path, located, files)
        cases.append(
            Case(len(cases) + 1, name, inputs, located, files, _ranks(count, place) if count else ranks, *rest)
        )
    return cases
