"""Reports: a file of results as one page of HTML, which opens without a network and prints well."""

import datetime
import os
from collections.abc import Mapping
from typing import Any, Optional, Union

from ..core.errors import Error
from ..core.files import need_replaceable, same
from ..core.shown import application_of
from ..core.version import __version__
from ..results.file import Results
from ..results.stresses import Stresses
from ..results.studies import Study
from . import checks, founds, frames, heads, kinds, page, sheets
from .style import need_kind

CITED = "petsam: partial-slip contact of elastic bodies by the semi-analytical method"
CAPTIONS = {
    "maps": "Fields over the surface",
    "profiles": "Fields along x and y",
    "loop": "Load over displacement",
    "energy": "Dissipated energy of every cycle",
    "history": "Numbers over the history",
    "fretting-log": "Loops of the cycles",
    "scar": "Depth removed through the deepest point",
    "life": "Numbers over the cycles of wear",
    "gradient": "Where a micrometre counts: change of numbers by gap and friction",
    "study": "Results over the inputs",
    "sections": "Stresses over depth",
    "fatigue": "Fatigue parameters",
}
SLIDER = 2  # saved steps from which a slider shows their fields
WIDE = 7.5  # inches of a picture from which it scrolls on small screens
OF_STRESSES = {"maps": "Stresses over planes", "profiles": "Stress on the surface"}


def report(results: Any, path: Union[str, os.PathLike], inputs: Optional[Mapping[str, Any]] = None) -> None:
    """Writes a page of HTML with the inputs, numbers, errors, check and pictures of results.

    Parameters
    ----------
    results : Results, Stresses, Study, or what an application has found
        What petsam.open() returns; or a result of an application with a table(), as a joint.Backbone or a fit.Result.
    path : str
        Name of the page, which ends in .html; an older one is replaced.
    inputs : mapping, optional
        {name: value} of inputs that a result of an application does not have itself.

    Raises
    ------
    Error
        If the page cannot be written, or no step has a solution.
    """
    application = application_of(results)
    if application and isinstance(results, founds.RESULTS):
        _of_application(application, results, path, inputs or {})
        return
    if inputs:
        raise Error("report: inputs are for results of an application; files have their own: remove them")
    need(results, path)
    names = once(results, kinds.usual([results]))
    write(results, path, {name: kinds.function(name, [results])(results) for name in names})


def once(results, names):
    """The kinds of picture without those whose fields the slider shows at every saved step."""
    if not isinstance(results, Results) or results.times.size < SLIDER:
        return names
    return [name for name in names if name != ("profiles" if results.is_plane else "maps")]


def view(results: Results) -> frames.View:
    """Maps of the saved steps with a slider, for notebooks.

    Parameters
    ----------
    results : Results
        Results of petsam.

    Returns
    -------
    View
        What a notebook shows; `_repr_html_()` is its HTML.

    Raises
    ------
    Error
        If the file is none of petsam, or has no fields.
    """
    need_kind("view", [results], "results of petsam", lambda one: isinstance(one, Results))
    results.need_solution()
    if not results.times.size:
        raise Error(f"{results.path}: view: no fields were saved")
    return frames.View(results)


def need(results, path):
    """Raises Error if there cannot be a report, before anything is drawn."""
    path = page.name(os.fspath(path))
    need_kind("report", [results], "results of petsam.open()", lambda one: hasattr(one, "program"))
    need_replaceable(path)
    if same(results.path, path):
        raise Error(f"{path}: would replace the results; give another name")
    if isinstance(results, Results):
        results.need_solution()
    elif isinstance(results, Study) and not (results.codes == 0).any():
        raise Error(f"{results.path}: no case has finished")


def write(results, path, figures, dpi=page.DPI):
    """Writes the page of results with these figures, by their kinds; those of many lines or of maps have dpi pixels per
    inch."""
    captions = {**CAPTIONS, **(OF_STRESSES if isinstance(results, Stresses) else {})}
    shown = []
    for kind, figure in figures.items():
        caption = captions.get(kind, kind)
        alternative = f"{caption} of {results.label}, by petsam-plot --{kind}"
        wide = figure.get_size_inches()[0] > WIDE
        shown.append(page.figure(page.image(figure, alternative, dpi), caption, wide))
    pictures = page.section("Pictures", *shown, class_="page")
    save(path, results.label, _parts(results, pictures))


def _of_application(application, found, path, inputs):
    """Writes the page of what an application has found."""
    path = page.name(os.fspath(path))
    need_replaceable(path)
    written = datetime.datetime.now().astimezone()
    rows = [("Program", f"{application.command} {__version__}"), ("Date", _date(written))]
    shown = founds.contents(found, application)
    title = shown["title"]
    head = page.element("header", page.element("h1", title), page.terms(rows))
    numbers, *others = founds.parts(found, shown, inputs)
    first = page.element("div", head, numbers, class_="many")  # on paper on one page
    save(path, title, [first, *others, _cited(__version__)])


def save(path, title, parts):
    """Writes the page that has these parts; raises Error if it would be too large."""
    data = page.whole(f"{title}: report of petsam", page.joined(parts)).encode()
    if len(data) > page.MOST:
        size = f"{len(data) / 1e6:.1f} MB, more than {page.MOST / 1e6:g}"
        raise Error(f"{path}: would have {size}; draw fewer kinds, or at a smaller --dpi")
    with open(path, "wb") as file:
        file.write(data)


def _parts(results, pictures):
    """All sections in their order."""
    if isinstance(results, Study):
        return [_head(results), sheets.cases(results), pictures, sheets.shared(results), _citation(results)]
    last = sheets.of_last(results, int(results.solved[-1]) if isinstance(results, Results) else results.of_last())
    if isinstance(results, Stresses):
        return [_head(results), last, pictures, sheets.history(results), sheets.inputs(results), _citation(results)]
    several = results.times.size >= SLIDER
    maps = [page.section("Saved steps", frames.slider(results, _room(pictures)))] if several else []
    tables = [sheets.history(results), *([sheets.life(results)] if results.has_life else [])]
    return [
        _head(results),
        checks.check(results),
        last,
        *maps,
        pictures,
        *tables,
        sheets.inputs(results),
        _citation(results),
    ]


def _room(pictures):
    """Bytes that the slider may have beside the pictures and tables."""
    return min(frames.BYTES, page.MOST - len(pictures) - 400000)


def _head(results):
    """Title, program, date and size of the file."""
    written = datetime.datetime.fromtimestamp(os.path.getmtime(results.path)).astimezone()
    parameters = getattr(results, "parameters", {})
    about = str(parameters.get("title", ""))
    rows = [
        ("Program", f"{results.program} {_version(results)}".rstrip()),
        ("Date", _date(written)),
        ("File", os.path.basename(results.path)),
    ]
    if isinstance(results, Results):
        rows.append(("Grid", page.Html(f"{results.x.size} x {results.y.size} cells, {_size(results)}")))
        rows.append(("Steps", f"{results.history['time'].size}, fields of {results.times.size}"))
        rows += heads.rows(results)
    title = page.element("h1", results.label)
    return page.element("header", title, *([page.element("p", about)] if about else []), page.terms(rows))


def _date(written):
    return page.element("time", f"{written:%Y-%m-%d %H:%M %Z}", datetime=written.isoformat(timespec="seconds"))


def _version(results):
    return str(getattr(results, "parameters", {}).get("petsam_version", ""))


def _size(results):
    size = [len(axis) * float(axis[1] - axis[0]) for axis in (results.x, results.y) if axis.size > 1]
    return page.Html(" x ".join(page.quantity(one, "m", beside=max(size)) for one in size))


def _citation(results):
    return _cited(_version(results) or __version__)


def _cited(version):
    text = f"The petsam authors. {CITED}. Version {version}. Licence BSD-2-Clause."
    return page.element("footer", page.element("h2", "Citation"), page.element("p", page.element("cite", text)))
