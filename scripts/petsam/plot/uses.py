"""The options that each picture uses: an option that no picture uses is rejected, not ignored."""

import inspect

from ..core.errors import Unusable
from ..results.stresses import Stresses
from . import pictures
from .keywords import LOOK
from .kinds import OF_RESULTS, OF_STRESSES, STUDY, TABLES

OF_CYCLES = ("energy", "fretting-log")
SCALES = ("log colors", "log x", "log y")  # of which each picture knows some
# what to take instead
INSTEAD = {"step": "--range FIRST:LAST", "time": "--range FIRST:LAST", "cycle": "--range FIRST:LAST"}


def parameters(function):
    """The names of the options that a picture takes, without those of its look."""
    names = [name for name, one in inspect.signature(function).parameters.items() if one.kind is one.KEYWORD_ONLY]
    return [name for name in names if name not in (*LOOK, "option")]


def _names():
    """Names of all options that some picture uses; of log by its words."""
    functions = [*OF_RESULTS.values(), *OF_STRESSES.values(), pictures.study, pictures.regimes]
    names = dict.fromkeys(name for function in functions for name in parameters(function))
    return (*[name for name in names if name != "log"], *SCALES)


NAMES = _names()


def _given(options, name):
    if name.startswith("log "):
        return name[4:] in options.log
    value = getattr(options, name)
    return value is not None and value is not False and value != []


def given(options):
    """The names of the given options that pictures use."""
    return [name for name in NAMES if _given(options, name)]


def is_plane(options):
    """True if a study is drawn over two inputs: --against X,Y."""
    return "," in (options.against or "")


def function(kind, options, results):
    """The picture of a kind, of petsam.plot."""
    if kind == STUDY and is_plane(options):
        return pictures.regimes
    return TABLES.get(type(results[0]), OF_RESULTS)[kind]


def _takes(kind, name, options, results):
    """True if a kind of picture uses an option, or a word of log, of these files and with the other options."""
    if name.startswith("log "):
        picture = function(kind, options, results)
        coloured = kind == "maps" or picture is pictures.regimes
        fits = coloured if name == "log colors" else kind != "maps"
        return fits and "log" in parameters(picture)
    if name not in parameters(function(kind, options, results)):
        return False
    if name == "at" and isinstance(results[0], Stresses):  # a section is where it is
        return any(file.along is None for file in results)
    if name in ("turns", "period"):  # of the cycles of a life the file says what they are
        if all(one.has_life for one in results):
            return False
        return kind in OF_CYCLES or bool(options.cycle)
    return not (name == "range" and kind == "loop" and options.cycle)


def _users(name, options, results):
    """Kinds of picture that use an option."""
    kinds = TABLES.get(type(results[0]), OF_RESULTS)
    return [kind for kind in kinds if _takes(kind, name, options, results)]


def need_use(options, results, kinds):
    """Unusable where an option is given that none of the kinds of picture uses; the message says which would."""
    for name in NAMES:
        if not _given(options, name):
            continue
        users = _users(name, options, results)
        if set(users) & set(kinds):
            continue
        spelled = options.spelling if name == "scalar" else "--" + name.replace("_", "-")
        there = [kind for kind in users if kind != STUDY]
        text = f"{spelled}: has no effect on the picture{'s' if len(kinds) > 1 else ''} {_listed(kinds)}"
        text += f"; it is for {_listed('--' + kind for kind in there)}" if there else " of such a file"
        if name in INSTEAD and {"history", "loop"} & set(kinds):
            text += f" ({INSTEAD[name]} chooses load steps of --history and --loop)"
        raise Unusable(text)


def _listed(words):
    *most, last = words
    return f"{', '.join(most)} and {last}" if most else last
