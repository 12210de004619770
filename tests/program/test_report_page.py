"""petsam-plot --report: one page of HTML of each kind of file, without a network; numbers, errors, check, slider."""

import base64
import io
import math
import re
import shutil
from html.parser import HTMLParser

import h5py
import numpy as np
import pytest
import yaml

import conftest
import petsam
from petsam.apps.study.cases import Case
from petsam.apps.study.tables import write_hdf5
from petsam.plot import frames, reports, sheets
from petsam.plot import page as page_module
from support import ROOT, ball, history, slide_limit
from test_plane import CYLINDER, N

pytestmark = pytest.mark.usefixtures("closing", "there")

STRESS = conftest.PROGRAM.with_name("petsam-stress")
SHOWN = 6  # steps of a slider
CASE = ball(n=32)
AMPLITUDE = float(0.7 * slide_limit(CASE)[0])
VOID = ("meta", "img", "input", "br", "wbr")
ELSEWHERE = re.compile(r"https?:|//\w|url\(|@import|<link|<iframe|srcset", re.I)
HOSTILE = '<script>alert("x")</script> & "quoted" \' </title>\n\x1b[31m'


class Page(HTMLParser):
    """Elements of a page, (tag, attributes) each, and its texts by the element that they are in."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.open, self.texts = [], [], []
        self.feed(text)
        assert not self.open, self.open  # all are closed

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append((tuple(self.open), data))

    def all(self, tag, **attributes):
        return [of for name, of in self.elements if name == tag and attributes.items() <= of.items()]

    def said(self, *skipped):
        return " ".join(data for places, data in self.texts if not {"style", "script", *skipped} & set(places))

    @property
    def titles(self):
        return [data for places, data in self.texts if places[-1:] == ("h2",)]


def rows(text):
    """{head of a row: its HTML}, the first of each name."""
    found = re.findall(r'<tr><th scope="row">(.*?)</th>(.*?)</tr>', text, re.S)
    return {re.sub("<.*?>", "", head): rest for head, rest in reversed(found)}


def read(path):
    """The page of a file and its text, once it has been checked for what all pages share."""
    text = path.read_text(encoding="utf-8")
    page = Page(text)
    bare = re.sub(r'src="data:image/(png|svg\+xml);base64,[A-Za-z0-9+/=]+"', "", text)
    assert len(text.encode()) < 2e6 and not ELSEWHERE.search(bare)
    images = page.all("img")
    assert images and all(one["alt"].strip() and one["src"].startswith("data:image/") for one in images)
    for one in images:
        kind, _, data = one["src"].partition(";base64,")
        start = b"\x89PNG" if kind.endswith("png") else b"<svg"
        assert base64.b64decode(data).startswith(start)
    names = [of["id"] for _, of in page.elements if "id" in of]
    assert len(names) == len(set(names)) and {of["for"] for of in page.all("label")} <= set(names)
    assert len(page.all("h1")) == len(page.all("title")) == len(page.all("main")) == 1
    assert page.all("html") == [{"lang": "en"}] and page.titles[-1] == "Citation"
    assert "@media print" in text and 'name="viewport"' in text
    return page, text


@pytest.fixture
def there(tmp_path, monkeypatch):
    """Tests run in their folder."""
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def few(monkeypatch):
    """Sliders of two steps, which are drawn quickly."""
    monkeypatch.setattr(frames, "STEPS", 2)


@pytest.fixture
def undrawn(few, monkeypatch):
    """Texts alone: pictures are made, and not drawn."""
    monkeypatch.setattr(page_module, "_svg", lambda figure: b"")
    monkeypatch.setattr(page_module, "png", lambda figure, dpi: b"\x89PNG")


@pytest.fixture(scope="module")
def strokes(solve, tmp_path_factory):
    """A load that turns, 12 steps of each row, all with fields, and the errors of the last numbers."""
    table = tmp_path_factory.mktemp("strokes") / "strokes.csv"
    table.write_text(f"time,load_tx\n0,0\n1,{AMPLITUDE!r}\n2,{-AMPLITUDE!r}\n3,{AMPLITUDE!r}\n")
    return solve(CASE, dict(history=table, steps=12, errors="companion")).path


@pytest.fixture
def copy(strokes, tmp_path):
    shutil.copy(strokes, tmp_path / "copy.h5")
    return tmp_path / "copy.h5"


@pytest.fixture(scope="module")
def page(strokes, tmp_path_factory):
    """With a slider of six steps."""
    path = tmp_path_factory.mktemp("page") / "run.html"
    with petsam.open(strokes) as results, pytest.MonkeyPatch.context() as patch:
        patch.setattr(frames, "STEPS", SHOWN)
        results.report(path)
    return read(path)


# ---------------------------------------------------------------- what the page holds


@pytest.mark.usefixtures("few")
def test_command_and_call_write_the_same(draw, strokes, tmp_path):
    assert draw("--report", "run.html", strokes) == (0, [])
    assert [path.name for path in tmp_path.iterdir()] == ["run.html"]
    petsam.open(strokes).report("call.html")
    # each slider of a process has a name of its own
    texts = [(tmp_path / name).read_text() for name in ("run.html", "call.html")]
    alone = [re.sub(r"petsam-step-\d+", "", text) for text in texts]
    assert alone[0] == alone[1]


def test_parts_stand_in_the_order_of_a_report(page):
    order = ["Check", "Numbers of the last step", "Saved steps", "Pictures", "History", "Inputs", "Citation"]
    assert page[0].titles == order


def test_numbers_are_those_of_the_file(page, strokes):
    found = rows(page[1])
    with h5py.File(strokes) as file:
        for name in ("load_n", "load_tx", "contact_area", "stick_area", "pressure_max", "slip_max"):
            [value] = re.findall(r'<data value="(.*?)">', found[name])[:1]
            assert float(value) == file[f"history/{name}"][-1], name
        found = rows(page[1].partition("<h2>Inputs</h2>")[2])
        assert float(re.search(r'value="(.*?)"', found["body1_young"])[1]) == file.attrs["body1_young"]
    assert "72 GPa" in found["body1_young"]


def test_errors_stand_beside_their_numbers(page, strokes):
    found, errors = rows(page[1]), petsam.open(strokes).errors
    for name, one in errors.items():
        row = found[name if name in found and f"&plusmn; {100 * one.error:.2g} %" in found[name] else f"{name}, sum"]
        assert f"&plusmn; {100 * one.error:.2g} %" in row and f"by the {one.cause}" in row
        assert float(re.search(r'value="(.*?)"', row)[1]) == pytest.approx(one.value, rel=1e-6)
    assert not any(name.endswith("_max_error") for name in found)  # they are beside the numbers


def test_the_error_by_the_load_step_stands_beside_the_energy(copy):
    with h5py.File(copy, "r+") as file:
        del file["history/dissipated_energy_error"]
        energy = file["history/dissipated_energy"][-1]
        file["history/energy_error"][-1] = 0.1 * energy
    found = {row[0]: row for row in sheets.numbers(petsam.open(copy), 47)[0]}
    error = found["dissipated_energy"][2]
    assert error.endswith(", by the load step") and "energy_error" not in found
    assert float(re.search(r'value="(.*?)"', error)[1]) == pytest.approx(0.1 * energy)
    names = list(found)
    if "dissipated_energy_closed" in found:
        assert names.index("dissipated_energy_closed") == names.index("dissipated_energy") + 1


@pytest.mark.usefixtures("undrawn")
def test_large_errors_are_warned_of(copy, tmp_path):
    with h5py.File(copy, "r+") as file:
        file["errors/error"][:2] = (0.31, np.nan)
        names = [name.decode() for name in file["errors/name"][:2]]
    petsam.open(copy).report("w.html")
    said = read(tmp_path / "w.html")[0].said()
    assert f"{names[0]} has an error of 31 % by the" in said and f"the error of {names[1]} is unknown" in said
    assert "Passed" not in said and "Not accurate: " in said


def verdict_of(path, options="", errors=(), warnings=()):
    """The class and the words of the verdict of a file whose errors, first numbers first, are changed."""
    with h5py.File(path, "r+") as file:
        file.attrs["options"] = f"{file.attrs['options']} {options}"
        file["errors/error"][:] = 0.001
        for k, error in enumerate(errors):
            file["errors/error"][k] = error
        names = [name.decode() for name in file["errors/name"][: len(errors)]]
    results = petsam.open(path)
    results.warnings += warnings
    results.report("v.html")
    found, _ = read(path.parent / "v.html")
    [kind] = [of["class"].split()[1] for of in found.all("div") if of.get("class", "").startswith("verdict ")]
    return kind, found.said(), names


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize(
    "options, errors, kind, says",
    [
        (
            "-accuracy 1%",
            [0.054],
            "warning",
            "Accuracy not reached: {0} has an error of 5.4 % by the {1}, above the required 1 %",
        ),
        ("-accuracy 1e-2", [0.02, 0.03], "warning", "above it, too: {0} 2 %"),
        ("-grid auto", [0.02], "warning", "Accuracy not reached: {0} has an error of 2 %"),
        ("-accuracy 1%", [math.nan], "warning", "Accuracy not reached: the error of {0} is unknown; 1 % is required"),
        ("-accuracy 1%", [1.2], "warning", "Accuracy not reached: the error of {0} is unknown"),
        ("-accuracy 1% -accuracy_of stick_area", [0.02], "fine", "The accuracy of 1 % is reached"),
        ("-accuracy 3%", [0.02], "fine", "The accuracy of 3 % is reached: the maximum error is 2 %, of {0}."),
        ("", [0.054], "warning", "Not accurate: {0} has an error of 5.4 % by the {1}."),
        ("", [0.02], "fine", "The maximum error is 2 %, of {0}."),
    ],
)
def test_the_verdict_follows_the_check_and_the_accuracy(copy, options, errors, kind, says):
    cause = next(iter(petsam.open(copy).errors.values())).cause
    found, said, names = verdict_of(copy, options, errors)
    assert found == kind and says.format(names[0], cause) in said
    assert ("Passed: " in said) == (kind == "fine") and "the check agrees. Exit code 0." in said.replace("All", "all")


@pytest.mark.usefixtures("undrawn")
def test_numbers_that_the_run_warns_of_are_named_once(copy):
    names = list(petsam.open(copy).errors)[:2]
    _, said, _ = verdict_of(copy, errors=[0.5, 0.3], warnings=[f"error by the cells: {names[1]} 30 %: use -grid_n 99"])
    assert f"{names[1]} has an error" not in said and f"{names[1]} 30 %" in said


@pytest.mark.usefixtures("undrawn")
def test_warnings_stand_in_the_verdict(copy):
    found, said, _ = verdict_of(copy, warnings=["the contact is small <b>"])
    assert found == "warning" and "Passed with 1 warning: " in said and "the contact is small <b>" in said


def test_the_head_has_bodies_loads_friction_and_units(page):
    places = [data for places, data in page[0].texts if places[-1:] == ("dt",)]
    head = page[1].partition("<dl>")[2].partition("</dl>")[0]
    shown = re.sub("<.*?>", "", re.sub("</dd>", "\n", head))
    assert {"Bodies", "Gap", "Friction", "Loads", "Units"} <= set(places)
    assert "E 72 GPa" in shown and "SI with prefixes" in shown and "Gapsphere" in shown
    [ends] = re.findall(r'load_tx <data value="(.*?)">.*? to <data value="(.*?)">', head)
    low, high = map(float, ends)
    assert (low, high) == pytest.approx((-AMPLITUDE, AMPLITUDE), rel=1e-12)


def test_dark_screens_and_paper_have_their_own_colours(page):
    dark = page[1].partition("@media screen and (prefers-color-scheme: dark)")[2].partition("@media print")[0]
    light = page[1].partition(".petsam {")[2].partition("}")[0]
    assert set(re.findall(r"--\w+(?=:)", light)) == set(re.findall(r"--\w+(?=:)", dark)) > {"--ink", "--paper"}


def test_no_picture_is_twice_in_a_page(page):
    sources = [one["src"] for one in page[0].all("img")]
    assert len(sources) == len(set(sources))
    captions = [data for places, data in page[0].texts if places[-1:] == ("figcaption",)]
    assert "Fields over the surface" not in captions  # the slider shows them


def test_the_check_has_the_largest_residuals_and_the_verdict(page, strokes):
    found = rows(page[1])
    with h5py.File(strokes) as file:
        for name in ("normal_residual", "tangential_residual", "equilibrium_residual"):
            assert float(re.search(r'value="(.*?)"', found[name])[1]) == np.max(file[f"history/{name}"])
            assert ">below<" in found[name]
    assert "Passed: all 48 steps converged, and the check agrees. Exit code 0." in page[0].said()


def test_the_history_is_short_and_tells_the_rest(page, strokes):
    table = page[1].partition("<h2>History</h2>")[2].partition("</table>")[0]
    steps = [int(step) for step in re.findall(r'<th scope="row">(\d+)</th>', table)]
    assert len(steps) == 20 and steps[0] == 1 and steps[-1] == 48 and "20 of 48 load steps" in table
    values = re.findall(r'<th scope="row">48</th>.*?</tr>', table, re.S)[0]
    with h5py.File(strokes) as file:
        assert repr(float(file["history/disp_x"][-1])) in values
    heads = re.sub("<wbr>", "", table.partition("</thead>")[0])
    assert "load_tx" in heads and "load_my" not in heads  # which does not vary


def test_the_command_is_the_one_of_the_run(page, strokes):
    with h5py.File(strokes) as file:
        options = file.attrs["options"]
    command = re.search(r"<pre><code>(.*?)</code>", page[1], re.S)[1].replace("\\\n", "")
    assert command.split() == ["petsam", *options.split()]


def test_the_citation_is_that_of_the_repository():
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert cited["title"] == reports.CITED and cited["authors"] == [{"name": "The petsam authors"}]
    assert cited["license"] == "BSD-2-Clause"


# ---------------------------------------------------------------- the slider


def test_the_slider_has_a_picture_for_each_step_that_it_shows(page):
    [slider], shown = page[0].all("input", type="range"), page[0].all("div", **{"class": "frame"})
    assert len(shown) == int(slider["max"]) - int(slider["min"]) + 1 == SHOWN
    assert [("hidden" in one) for one in shown] == [True] * (SHOWN - 1) + [False] and slider["value"] == slider["max"]
    assert [one["for"] for one in page[0].all("label")] == [slider["id"]]
    whens = [one["data-when"] for one in shown]
    assert len(set(whens)) == SHOWN and whens[0].startswith("step 1,") and whens[-1] == "step 48, t = 3 s"
    maps = [one["alt"] for one in page[0].all("img") if "of step" in one["alt"]]
    assert len(maps) == 4 * SHOWN and [alt.split()[0] for alt in maps[:4]] == ["pressure", "shear", "slip", "state"]


def test_a_slider_that_would_be_too_large_has_fewer_steps(strokes):
    with petsam.open(strokes) as results:
        found = Page(frames.slider(results, 100000))
    shown = found.all("div", **{"class": "frame"})
    assert 2 <= len(shown) < 12 and shown[-1]["data-when"] == "step 48, t = 3 s"
    assert int(found.all("input")[0]["max"]) == len(shown) - 1


@pytest.mark.usefixtures("few")
def test_all_steps_of_a_slider_have_one_scale_and_one_window(strokes, monkeypatch):
    seen = []
    monkeypatch.setattr(frames.page, "image", lambda figure, *_, **__: seen.append(figure) or frames.page.Html(""))
    with petsam.open(strokes) as results:
        frames.slider(results)
        largest = max(results.field("pressure", index).max() for index in frames.chosen(results))
    panels = [figure.axes[0] for figure in seen if figure.axes[0].get_title().startswith("pressure")]
    assert len({(panel.get_xlim(), panel.get_ylim(), panel.images[0].get_clim()) for panel in panels}) == 1
    assert panels[0].images[0].get_clim()[1] == pytest.approx(largest * 1e-6)


@pytest.mark.usefixtures("few")
def test_a_notebook_has_the_slider_alone(strokes, copy):
    with petsam.open(strokes) as results:
        shown = [results.view() for _ in range(2)]
    found = [Page(one._repr_html_()) for one in shown]
    assert all(len(one.all("div", **{"class": "frame"})) == 2 and not one.all("table") for one in found)
    assert found[0].all("input")[0]["id"] != found[1].all("input")[0]["id"]  # both may stand in one notebook
    assert repr(shown[0]).startswith("View(") and "<script>" in shown[0]._repr_html_()


@pytest.mark.usefixtures("undrawn")
def test_a_single_step_has_no_slider(solve, tmp_path):
    one = solve(dict(CASE, load_tx=AMPLITUDE)).path
    petsam.open(one).report(tmp_path / "one.html")
    found, _ = read(tmp_path / "one.html")
    assert not found.all("input") and not found.all("div", **{"class": "frame"})
    captions = [data for places, data in found.texts if places[-1:] == ("figcaption",)]
    assert captions == ["Fields over the surface", "Fields along x and y"]  # each once
    assert "-errors companion" in found.said()  # which would have given errors


# ---------------------------------------------------------------- other files


@pytest.mark.usefixtures("undrawn")
def test_a_life(solve, tmp_path):
    rest = dict(steps=3, wear_coefficient2=1e-12, wear_cycles=2000, wear_output=(0, 500))
    table = history(tmp_path / "c.csv", "time,load_tx", (0, 0), (1, AMPLITUDE), (2, -AMPLITUDE), (3, 0))
    life = petsam.open(solve(CASE, table, rest).path)
    life.report(tmp_path / "life.html")
    found, text = read(tmp_path / "life.html")
    assert "Life" in found.titles and "computed cycle" in text
    assert any("cycles" in one["data-when"] for one in found.all("div", **{"class": "frame"}))
    assert {"Numbers over the cycles of wear", "Loops of the cycles"} <= {
        data for places, data in found.texts if places[-1:] == ("figcaption",)
    }
    assert f'value="{float(life.wear["volume2"][-1])!r}"' in text


@pytest.mark.usefixtures("few")
def test_plane_strain(launcher, tmp_path):
    table = history(tmp_path / "h.csv", "time,load_n,load_tx", (0.0, N, 0.0), (1.0, N, 2e4), (2.0, N, -2e4))
    case = dict(CYLINDER, load_n=None, grid_n=60, steps=3, output="plane.h5")
    conftest.execute(launcher, tmp_path, [case, table], 1, 0)
    petsam.open(tmp_path / "plane.h5").report(tmp_path / "plane.html")
    found, _ = read(tmp_path / "plane.html")
    assert len(found.all("div", **{"class": "frame"})) == int(found.all("input")[0]["max"]) + 1


@pytest.mark.usefixtures("few")
def test_steady_rolling(solve, tmp_path):
    rows_ = [(k, 1e-3 * k) for k in range(1, 4)]
    table = history(tmp_path / "r.csv", "time,creep_x", *rows_)
    petsam.open(solve(dict(CASE, rolling="steady"), table).path).report(tmp_path / "r.html")
    found, _ = read(tmp_path / "r.html")
    assert any(one["alt"].startswith("power density") for one in found.all("img"))


@pytest.mark.usefixtures("few")
@pytest.mark.parametrize("more", [dict(section="y=0", depths="0:4e-4:9"), dict(depths="0,1e-4")])
def test_stresses(launcher, strokes, tmp_path, more):
    words = dict(input=strokes, steps="13:36", fatigue="swt", quiet=True, output="s.h5", **more)
    conftest.execute(launcher, tmp_path, [words], 1, 0, program=STRESS)
    with petsam.open(tmp_path / "s.h5") as stresses:
        stresses.report(tmp_path / "s.html")
        found, text = read(tmp_path / "s.html")
        shown, error = rows(text), float(stresses.parameters["traction_error"])
        assert f'value="{float(stresses.history["mises_max"][-1])!r}"' in shown["mises_max"]
        assert f"&plusmn; {100 * error:.2g} %" in shown["mises_max"] and ", by the tractions" in shown["mises_max"]
        assert f'value="{float(stresses.history["mises_max_z"][-1])!r}"' in shown["mises_max"]  # its place
        assert not {"traction_error", "mises_max_z"} & set(shown)
    assert found.titles == ["Numbers of the last step", "Pictures", "History", "Inputs", "Citation"]


@pytest.fixture
def study(tmp_path):
    """Thirty cases, one of which has failed; results with errors."""
    (tmp_path / "mine").mkdir()
    found = []
    for k in range(1, 31):
        case = Case(k, f"case<{k}>", {"ratio": str(0.01 * k), "shape": "<b>ball</b>"}, {"grid_n": "64"}, {}, 1)
        values = {"stick_area": (1e-6 * (1 - 0.01 * k), "m2"), "stick_area_error": (1e-9, "m2")}
        found.append((case, {"exit_code": 11 * (k == 30), "seconds": 1.0, "message": ""}, values if k < 30 else {}))
    write_hdf5(str(tmp_path / "mine" / "results.h5"), found, "mine.yaml")
    return tmp_path / "mine" / "results.h5"


def test_a_study(draw, study, tmp_path):
    assert draw("--report", "study.html", study) == (0, [])
    found, text = read(tmp_path / "study.html")
    assert found.titles == ["Cases", "Pictures", "Inputs", "Citation"] and "20 of 30 cases" in text
    assert "petsam \\ -grid_n 64" in " ".join(found.said().split())
    assert "1 option of all cases; besides, each has its own ratio, shape" in found.said()
    assert "30 cases, 1 of them failed or not run." in found.said() and "&lt;b&gt;ball&lt;/b&gt;" in text
    row = rows(text)["case&lt;1&gt;"]
    assert 'value="9.9e-07"' in row and "\N{PLUS-MINUS SIGN} <data value" in row


# ---------------------------------------------------------------- what is odd


@pytest.mark.usefixtures("few")
def test_texts_of_a_file_do_not_become_elements(copy, tmp_path):
    with h5py.File(copy, "r+") as file:
        file.attrs["title"] = HOSTILE
        file.attrs["petsam_version"] = "1<b>"
        file.attrs["gap_file"] = HOSTILE
        file.attrs["options"] = f"-gap_file '{HOSTILE.replace(chr(39), '')}' -output x.h5 \"unclosed"
        file["history/pressure_max"].attrs["long_name"] = "<img src=x onerror=alert(1)>"
    petsam.open(copy, label="<i>$label$</i>").report("hostile.html")
    found, text = read(tmp_path / "hostile.html")
    assert len(found.all("script")) == 1 and not found.all("b") and not found.all("i")
    assert all(set(of) <= {"src", "alt", "width", "height"} for of in found.all("img"))
    assert HOSTILE.partition("\n")[0] in found.said() and "\x1b" not in text
    assert "<i>$label$</i>" in found.said()


@pytest.mark.usefixtures("undrawn")
def test_a_run_that_has_failed_says_so(solve, tmp_path):
    table = history(tmp_path / "f.csv", "time,load_tx", (1, AMPLITUDE), (2, 5 * AMPLITUDE))
    petsam.open(solve(CASE, table, check=11).path).report(tmp_path / "failed.html")
    said = read(tmp_path / "failed.html")[0].said()
    assert "Failed: 1 of 2 steps marked. Exit code 11." in said
    assert "1 step has no equilibrium" in said


@pytest.mark.usefixtures("undrawn")
def test_a_run_that_was_killed_says_so(copy, tmp_path):
    with h5py.File(copy, "r+") as file:
        file.attrs["closed"] = np.int8(0)
    petsam.open(copy).report("killed.html")
    assert "No exit code: the run has not ended, or was killed." in read(tmp_path / "killed.html")[0].said()


@pytest.mark.usefixtures("undrawn")
def test_chosen_kinds_alone_are_in_the_page(draw, strokes, tmp_path):
    assert draw("--report", "loop.html", "--loop", "--cycle", "1", strokes) == (0, [])
    captions = [data for places, data in read(tmp_path / "loop.html")[0].texts if places[-1:] == ("figcaption",)]
    assert [one for one in captions if "step" not in one] == ["Load over displacement"]


@pytest.mark.parametrize(
    "words, code, says",
    [
        (["--report", "run.pdf"], 2, "--report: run.pdf: expected a name that ends in .html"),
        (["--report", "none/run.html"], 3, "none/run.html: cannot be written: its folder"),
        (["--report", "folder.html"], 3, "folder.html: is a directory"),
        (["--report", "run.html", "-o", "a.png"], 2, "--output: not allowed with --report"),
        (["--report", "run.html", "--csv", "a.csv"], 2, "--csv: not allowed with --report"),
        (["--report", "run.html", "--format", "svg"], 2, "--format: not allowed with --report"),
        (["--report", "run.html", "copy.h5"], 2, "--report run.html: is of one file; 2 are given"),
        (["--report", "run.html", "--loop", "--step", "3"], 2, "--step: has no effect on the picture loop"),
        (["--report", "run.html", "--maps", "--step", "99"], 3, "--step 99: "),
    ],
)
def test_what_cannot_be_is_refused(draw, copy, tmp_path, words, code, says):
    (tmp_path / "folder.html").mkdir()
    given, [said] = draw(*words, copy)
    assert given == code and says in said
    assert sorted(path.name for path in tmp_path.iterdir()) == ["copy.h5", "folder.html"]


def test_a_file_without_a_solution_is_refused_before_anything_is_drawn(draw, solve, tmp_path, monkeypatch):
    path = solve(dict(CASE, load_tx=5 * AMPLITUDE), check=11).path
    monkeypatch.setattr("petsam.plot.command.draw", lambda *_: pytest.fail("drawn"))
    code, [said] = draw("--report", "run.html", path)
    assert code == 3 and said.endswith("no step has a solution") and not list(tmp_path.glob("*.html"))


def test_calls_that_cannot_be_are_errors(strokes, copy, study, tmp_path):
    results = petsam.open(copy)
    with pytest.raises(petsam.Error, match=r"run.txt: expected a name that ends in .html"):
        results.report("run.txt")
    copy.rename(tmp_path / "copy.html")
    with pytest.raises(petsam.Error, match="would replace the results"):
        petsam.open(tmp_path / "copy.html").report(tmp_path / "copy.html")
    with pytest.raises(petsam.Error, match="view: expected results of petsam, not Study"):
        petsam.plot.view(petsam.open(study))
    with pytest.raises(petsam.Error, match="expected results of petsam.open.., not a file's name"):
        petsam.plot.report(str(strokes), "run.html")


def test_pictures_are_sharp_and_small(page):
    from PIL import Image

    for one in page[0].all("img"):
        kind, _, data = one["src"].partition(";base64,")
        if kind.endswith("png"):
            with Image.open(io.BytesIO(base64.b64decode(data))) as image:
                assert image.size[0] >= float(one["width"]) and len(data) < 200000


def test_a_column_of_one_quantity_has_one_unit():
    rows = [("a", (2e-6, "m"), (5e6, "Pa")), ("b", (3e-3, "m"), (2.0, "N")), ("c", (math.nan, "m"), (0.0, "Pa"))]
    text = page_module.table("t", ("name", "length", "value"), rows)
    assert re.findall(r"<data.*?>(.*?)</data>", text) == ["0.002 mm", "5 MPa", "3 mm", "2 N", "0 Pa"]
    assert "3 mm" in sheets.beside(3e-3, "m", 2e-6, 3e-3) and "0.002 mm" in sheets.beside(3e-3, "m", 2e-6, 3e-3)
    assert ">0.01 MPa<" in sheets.absolute(1e4, "Pa", 2e6)
    assert "0.02 MPa" in sheets.relative(2e6, "Pa", 0.01)
