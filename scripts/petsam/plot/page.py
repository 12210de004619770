"""A page of HTML in one file: texts, tables and pictures, which need no network and print well.

Texts of files pass through text(), which escapes them; Html is what has passed.
"""

import base64
import html
import io
import math

from PIL import Image

from ..core import words
from ..core.errors import short
from .style import STYLE, fewer, plt
from .units import scale

ENDING = ".html"
MOST = 2000000  # bytes of a page
SVG = 90000  # bytes of a picture up to which it is drawn by lines
DPI = 150  # pixels per inch of the others
SHOWN = 96  # of an inch of a picture on the page
LONG = 300  # characters of a text of a file
WORD = 12  # characters of a name that is not broken
DRAWING = {"svg.hashsalt": "petsam"}  # the same names in each SVG
NOTHING = {"Creator": None, "Date": None, "Format": None, "Type": None}  # of the description in an SVG

CSS = """
.petsam { --ink: #1a1a1a; --paper: #fff; --pale: #444; --line: #ddd; --rule: #bbb; --code: #f5f5f5;
  --bad: #b00020; --doubt: #d55e00; --good: #009e73; --tint: #0072b2;
  color: var(--ink); background: var(--paper); font: 15px/1.5 system-ui, "DejaVu Sans", Arial, sans-serif; }
.petsam h1 { font-size: 1.7em; line-height: 1.25; margin: 0.3em 0; overflow-wrap: anywhere; }
.petsam h2 { font-size: 1.25em; margin: 1.8em 0 0.5em; border-bottom: 1px solid var(--rule); }
.petsam p, .petsam li, .petsam dd, .petsam figcaption, .petsam caption { overflow-wrap: anywhere; }
.petsam .wide { overflow-x: auto; max-width: 100%; margin: 0.6em 0; }
.petsam .wide:focus-visible, .petsam input:focus-visible { outline: 3px solid var(--tint); }
.petsam table { border-collapse: collapse; font-size: 0.92em; font-variant-numeric: tabular-nums; }
.petsam caption { text-align: left; color: var(--pale); padding: 0.2em 0; }
.petsam caption > span { display: block; position: sticky; left: 0; width: max-content; max-width: min(100%, 92vw); }
.petsam data { white-space: nowrap; }
.petsam th, .petsam td { padding: 0.2em 0.9em 0.2em 0; border-bottom: 1px solid var(--line); text-align: left;
  vertical-align: top; background: none; }
.petsam th { font-weight: 600; white-space: nowrap; }
.petsam tbody th { position: sticky; left: 0; background: var(--paper); }
.petsam td.number { text-align: right; white-space: nowrap; }
.petsam th.number { text-align: right; }
.petsam thead th { vertical-align: bottom; }
.petsam td.error { white-space: nowrap; }
.petsam td.long { min-width: 12em; max-width: 34em; white-space: normal; overflow-wrap: anywhere; }
.petsam dl { display: grid; grid-template-columns: max-content 1fr; gap: 0.2em 1em; margin: 0.8em 0; }
.petsam dt { font-weight: 600; }
.petsam dd { margin: 0; }
.petsam pre { white-space: pre-wrap; overflow-wrap: anywhere; background: var(--code); padding: 0.7em;
  margin: 0.5em 0; }
.petsam figure { margin: 1em 0; }
.petsam figure img { max-width: 100%; height: auto; display: block; }
.petsam .wide img { max-width: none; width: max(100%, 40em); }
.petsam figcaption { color: var(--pale); font-size: 0.92em; }
.petsam .verdict { border-left: 4px solid var(--good); padding-left: 0.7em; margin: 0.8em 0; }
.petsam .verdict.warning { border-left-color: var(--doubt); }
.petsam .verdict.failed { border-left-color: var(--bad); }
.petsam .verdict > * { margin: 0.2em 0; }
.petsam .verdict > ul { padding-left: 1.2em; }
.petsam .choice { display: flex; flex-wrap: wrap; gap: 0.3em 1em; align-items: center; margin: 0.6em 0; }
.petsam .choice input { flex: 1 1 14em; max-width: 40em; min-height: 2em; accent-color: var(--tint); }
.petsam .frame { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 18em), 1fr)); gap: 1em; }
.petsam .frame:has(> :nth-child(4):last-child) {
  grid-template-columns: repeat(auto-fit, minmax(min(100%, 18em), 26em)); max-width: 54em; }
.petsam .frame[hidden] { display: none; }
.petsam .frame figure { margin: 0; }
"""
PAPER = """
body { margin: 0; background: #fff; }
main { max-width: 76em; margin: 0 auto; padding: 0.8em clamp(0.8em, 3vw, 2em) 3em; }
@media screen and (prefers-color-scheme: dark) {
  html { color-scheme: dark; }
  body { background: #16181b; }
  .petsam { --ink: #e4e4e4; --paper: #16181b; --pale: #b4b4b4; --line: #3a3d41; --rule: #5a5d61; --code: #22252a;
    --bad: #ff6b7d; --doubt: #f08c3a; --good: #2fc79a; --tint: #5ab4f0; }
  .petsam figure img { background: #fff; border-radius: 4px; }
}
@media print {
  @page { margin: 16mm 14mm; }
  @page many { size: landscape; }
  .petsam { font-size: 10pt; }
  main { max-width: none; padding: 0; }
  .petsam h2, .petsam caption { break-after: avoid; }
  .petsam figure, .petsam .frame, .petsam tr, .petsam dl, .petsam .verdict { break-inside: avoid; }
  .petsam thead { display: table-header-group; }
  .petsam .wide { overflow: visible; }
  .petsam .wide img { width: auto; max-width: 100%; }
  .petsam table { font-size: 8pt; }
  .petsam th, .petsam td.number, .petsam td.error { white-space: normal; padding-right: 0.6em; }
  .petsam .frame { grid-template-columns: repeat(3, 1fr); }
  .petsam .frame:has(> :nth-child(4):last-child) { grid-template-columns: repeat(2, 1fr); max-width: 120mm; }
  .petsam .page { break-before: page; }
  .petsam .many { page: many; }
  .petsam tbody th { position: static; }
  .petsam .choice input, .petsam .screen { display: none; }
  .petsam figure img { max-height: 230mm; object-fit: contain; object-position: left; }
}
"""
# shows the frame that the slider is at, and writes which it is
SCRIPT = """
(function () {
  var all = document.querySelectorAll(".petsam .slider:not([data-live])");
  Array.prototype.forEach.call(all, function (slider) {
    var range = slider.querySelector("input[type=range]");
    var label = slider.querySelector("output");
    var frames = slider.querySelectorAll(".frame");
    slider.setAttribute("data-live", "");
    if (!range) return;
    function show() {
      var chosen = Number(range.value);
      Array.prototype.forEach.call(frames, function (frame, k) { frame.hidden = k !== chosen; });
      var when = frames[chosen].getAttribute("data-when");
      label.textContent = when;
      range.setAttribute("aria-valuetext", when);
    }
    range.addEventListener("input", show);
    show();
  });
})();
"""
# nothing is loaded from elsewhere, whatever texts the file holds
POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"


class Html(str):
    """A text with elements of HTML, in which everything else is escaped."""

    __slots__ = ()


class Number(Html):
    """A number as HTML, with what stands beside it; a column of these is aligned as one of numbers."""

    __slots__ = ()


def name(path):
    """The name of a page's file; WordError unless it ends in .html."""
    if not str(path).lower().endswith(ENDING):
        raise words.WordError(str(path), f"a name that ends in {ENDING}")
    return path


def text(value):
    """A text as HTML: escaped, on one line, and cut where it is long; what is HTML stays."""
    return value if isinstance(value, Html) else Html(html.escape(short(value, LONG)))


def element(tag, *parts, **attributes):
    """An element with its contents; class_ and data_when stand for class and data-when, True for no value."""
    given = {key.rstrip("_").replace("_", "-"): value for key, value in attributes.items() if value is not None}
    words_ = [key if value is True else f'{key}="{text(value)}"' for key, value in given.items()]
    return Html(f"<{' '.join([tag, *words_])}>{''.join(map(text, parts))}</{tag}>")


def joined(parts):
    """Pieces of HTML one below the other."""
    return Html("\n".join(map(text, parts)))


def largest(values):
    """The largest magnitude of numbers, for the prefix that all of them have; 0 without any."""
    return max((abs(value) for value in map(float, values) if math.isfinite(value)), default=0.0)


def quantity(value, unit="", digits=6, beside=0.0):
    """A number with the prefix that suits it, or the largest number beside which it stands; the element has the value
    in SI units, as the file has it."""
    if not math.isfinite(value):
        return Html("&ndash;")
    factor, shown = scale(unit, beside or abs(value))
    figures = f"{float(f'{factor * value:.{digits}g}'):.10g}".replace("-", "\N{MINUS SIGN}")
    return element("data", f"{figures} {shown}".rstrip(), value=repr(value))


def broken(name):
    """A name that may be broken after its underscores where it is long."""
    return Html(text(name).replace("_", "_<wbr>")) if len(name) > WORD else text(name)


def table(caption, heads, rows, long=()):
    """A table that scrolls within the page where it is wide: cells are texts, or (value, unit); long: columns of texts
    that are broken into lines."""
    count = [all(isinstance(row[k], (tuple, Number)) for row in rows) for k in range(len(heads))]
    top = [element("th", broken(head), scope="col", class_="number" if of else None) for head, of in zip(heads, count)]
    sizes = [_size_of([row[k] for row in rows]) for k in range(len(heads))]
    body = [element("tr", *(_cell(k, cell, k in long, sizes[k]) for k, cell in enumerate(row))) for row in rows]
    inner = joined([element("thead", element("tr", *top)), element("tbody", Html("\n".join(body)))])
    whole = element("table", element("caption", element("span", caption)), inner)
    return element("div", whole, class_="wide", role="region", tabindex="0", aria_label=caption)


def _size_of(cells):
    """The largest number of a column of one unit, whose cells then have one prefix; 0 of others."""
    numbers = [cell for cell in cells if isinstance(cell, tuple)]
    return largest(value for value, _ in numbers) if len({unit for _, unit in numbers}) == 1 else 0.0


def _cell(column, cell, long, size):
    if isinstance(cell, tuple):
        return element("td", quantity(*cell, beside=size), class_="number")
    if isinstance(cell, Number):
        return element("td", cell, class_="number")
    if column == 0:
        return element("th", broken(cell), scope="row")
    return element("td", cell, class_="long" if long else "error" if isinstance(cell, Html) else None)


def terms(pairs):
    """A list of terms and what they are."""
    return element("dl", *(element(tag, one) for pair in pairs for tag, one in zip(("dt", "dd"), pair)))


def section(title, *parts, **attributes):
    """A part of the page under its title."""
    return element("section", element("h2", title), joined(parts), **attributes)


def png(figure, dpi):
    """A figure as the bytes of a PNG of 256 colours."""
    data, small = io.BytesIO(), io.BytesIO()
    figure.savefig(data, format="png", dpi=dpi)
    with Image.open(data) as image:
        fewer(image).save(small, format="PNG", optimize=True)
    return small.getvalue()


def _svg(figure):
    data = io.BytesIO()
    figure.savefig(data, format="svg", metadata=NOTHING)
    found = data.getvalue().decode()
    return found[found.index("<svg") :].encode()  # without the document type, which names an address


def image(figure, alternative, dpi=DPI, lines=True):
    """A figure as an image within the page: drawn by lines where that is small, else by pixels. Closes the figure."""
    with plt.rc_context({**STYLE, **DRAWING}):
        points = any(panel.images or panel.collections for panel in figure.axes)
        data, kind = (_svg(figure), "svg+xml") if lines and not points else (b"", "")
        if not 0 < len(data) <= SVG:
            data, kind = png(figure, dpi), "png"
    width, height = (round(SHOWN * inches) for inches in figure.get_size_inches())
    plt.close(figure)
    source = f"data:image/{kind};base64,{base64.b64encode(data).decode()}"
    # text() would cut the source
    return Html(f'<img src="{source}" alt="{text(alternative)}" width="{width}" height="{height}">')


def figure(shown, caption, wide=False):
    """An image with its caption; a wide one scrolls within the page."""
    inner = element("div", shown, class_="wide", role="region", tabindex="0", aria_label=caption) if wide else shown
    return element("figure", inner, element("figcaption", caption))


def whole(title, body):
    """The page."""
    head = joined(
        [
            Html('<meta charset="utf-8">'),
            Html(f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'),
            Html('<meta name="viewport" content="width=device-width, initial-scale=1">'),
            element("title", title),
            Html(f"<style>{CSS}{PAPER}</style>"),
        ]
    )
    main = element("body", element("main", body, class_="petsam"), Html(f"<script>{SCRIPT}</script>"))
    return f'<!DOCTYPE html>\n<html lang="en">\n<head>\n{head}\n</head>\n{main}\n</html>\n'
