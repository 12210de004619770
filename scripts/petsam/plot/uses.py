"""Which pictures use which options: an option that no picture uses is rejected, not ignored."""

from ..errors import Error
from ..stresses import Stresses
from ..studies import Study

STUDY = "study"  # the only kind of a study's table
FIELDS = ("maps", "profiles")
# options and the kinds of picture that use them, of files of petsam, of petsam-stress and of petsam-study
OF_RESULTS = {
    "step": (*FIELDS, "scar"), "time": (*FIELDS, "scar"), "cycle": (*FIELDS, "scar", "loop", "fretting-log"),
    "range": ("loop", "history"), "load": ("loop", "fretting-log"), "turns": ("energy", "fretting-log"),
    "period": ("energy", "fretting-log"), "field": FIELDS, "scalar": ("history",), "against": ("history",),
    "at": ("profiles", "scar"), "whole_grid": (*FIELDS, "scar"), "limits": FIELDS, "percentile": ("maps",),
    "measured": ("scar",),
    "log colors": ("maps",), "log x": ("profiles", "history", "energy"), "log y": ("profiles", "history", "energy"),
}  # fmt: skip
OF_STRESSES = {
    "step": ("maps", "sections", "profiles"), "time": ("maps", "sections", "profiles"),
    "component": ("maps", "sections", "profiles"), "at": ("sections", "profiles"), "depth": ("maps",),
    "limits": ("maps", "sections"),
}  # fmt: skip
OF_STUDIES = dict.fromkeys(("scalar", "against", "by", "where", "border", "log x", "log y"), (STUDY,))
TABLES = {Stresses: OF_STRESSES, Study: OF_STUDIES}
NAMES = tuple(dict.fromkeys([*OF_RESULTS, *OF_STRESSES, *OF_STUDIES]))
# what to take instead
INSTEAD = {"step": "--range FIRST:LAST", "time": "--range FIRST:LAST", "cycle": "--range FIRST:LAST"}


class Useless(Error):
    """An option that none of the pictures uses, or that leaves nothing to draw: bad usage."""


def _given(options, name):
    if name.startswith("log "):
        return name[4:] in options.log
    value = getattr(options, name)
    return value is not None and value is not False and value != []


def is_plane(options):
    """Whether a study is drawn over two inputs: --against X,Y."""
    return "," in (options.against or "")


def _users(name, options, results):
    """Kinds of picture that use an option, of these files and with the other options."""
    if isinstance(results[0], Study) and name == ("by" if is_plane(options) else "border"):
        return ()
    users = TABLES.get(type(results[0]), OF_RESULTS).get(name, ())
    if type(results[0]) in TABLES:
        planes = name != "at" or any(file.along is None for file in results)  # a section is where it is
        return users if planes else ()
    if name in ("turns", "period"):  # of the cycles of a life the file says what they are
        of_chosen = OF_RESULTS["cycle"] if options.cycle else ()
        return () if all(one.has_life for one in results) else (*users, *of_chosen)
    if name == "range" and options.cycle:
        return ("history",)
    return users


def need_use(options, results, kinds):
    """Useless where an option is given that none of the kinds of picture uses; the message says which would."""
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
        raise Useless(text)


def _listed(words):
    *most, last = words
    return f"{', '.join(most)} and {last}" if most else last
