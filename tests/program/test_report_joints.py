"""Reports of results of petsam.joint: numbers with their errors, constants apart, limits, pictures, inputs."""

import re

import numpy as np
import pytest

import petsam
from petsam.apps.joint import stiffnesses
from petsam.apps.joint.balance import RESPONSE, Response
from petsam.apps.joint.bands import Band
from petsam.apps.joint.properties import Interface, Outcome
from petsam.apps.joint.wearing import Wear
from petsam.apps.launch import code_of
from test_plot_joints import FIRST, made
from test_report_page import read, rows

pytestmark = pytest.mark.usefixtures("closing")

STEEL = dict(body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3)


def interface(errors=None):
    """An interface of three pressures, with k_n in proportion to them and a spread of a tenth."""
    pressure = np.array([1e6, 2e6, 4e6])
    numbers = {"pressure": pressure, "k_n": 1e6 * pressure, "area": 1e-9 * pressure}
    numbers.update(closure=1e-12 * pressure, separation=1.0 / pressure)
    return Interface(Outcome(numbers, {"k_n": 1e5 * pressure}, np.empty((3, 0)), errors or {}, "none"), None, STEEL)


def cells(text):
    """{first number of a row: values of its cells} of the table of numbers."""
    body = text.partition("<h2>Numbers</h2>")[2].partition("<tbody>")[2].partition("</tbody>")[0]
    found = {}
    for row in re.findall(r"<tr>(.*?)</tr>", body, re.S):
        first, *rest = [[float(one) for one in re.findall(r'value="(.*?)"', cell)] for cell in row.split("<t")[1:]]
        found[first[0]] = rest
    return found


def heads(text):
    top = text.partition("<h2>Numbers</h2>")[2].partition("<thead>")[2].partition("</thead>")[0]
    return [re.sub("<.*?>", "", one) for one in re.findall(r"<th .*?</th>", top)]


def test_errors_stand_beside_the_numbers_of_an_interface(tmp_path):
    found = interface()
    found.report(tmp_path / "i.html")
    page, text = read(tmp_path / "i.html")
    assert page.titles == ["Numbers", "Pictures", "Inputs", "Citation"]
    assert heads(text) == ["pressure", "closure", "separation", "k_n", "area"]  # the spread has no column
    for pressure, row in cells(text).items():
        assert row[2:] == [[1e6 * pressure, 1e5 * pressure], [1e-9 * pressure]]
    assert "standard deviation: normal stiffness per area" in page.said()
    given = rows(text.partition("<h2>Inputs</h2>")[2])
    assert "210 GPa" in given["body1_young"] and 'value="0.3"' in given["body2_poisson"]


def test_relative_errors_are_percent(tmp_path):
    found = interface({"loop_energy": np.array([0.01, 0.02, 0.03])})
    found.numbers["loop_energy"] = np.array([1e-3, 2e-3, 4e-3])
    petsam.plot.report(found, tmp_path / "i.html")
    text = (tmp_path / "i.html").read_text()
    assert [re.search(r"&plusmn; (\d+) %", row)[1] for row in re.findall(r"mJ.*?</td>", text)] == ["1", "2", "3"]


def test_a_backbone_has_its_numbers_and_what_all_rows_share_apart(tmp_path):
    found = made(viscous=2e-3)
    found.numbers["unresolved"] = np.array([3e-4, 0.0, 0.0])
    found.report(tmp_path / "b.html")
    page, text = read(tmp_path / "b.html")
    shown = heads(text)
    assert shown[:4] == ["alpha", "amplitude", "frequency", "damping"] and "unresolved" not in shown
    assert "viscous" not in shown and 'value="0.002"' in text  # constant
    table = cells(text)
    assert [row[1] for row in table.values()] == [[one] for one in found.frequency]
    assert [row[2] for row in table.values()] == [[3e-4], [2e-4], [4e-4]] and text.count("&lt; <data") == 1
    assert len(page.all("img")) == 2 and "Inputs" not in page.titles


def test_a_band_has_its_limits_and_deviations(tmp_path):
    sides = (made(lower=0.002), made())
    found = Band({"as given": made(), "without friction": made(lower=0.01)}, {"friction": sides})
    found.report(tmp_path / "band.html")
    _, text = read(tmp_path / "band.html")
    assert heads(text)[:4] == ["amplitude", "frequency", "frequency_lowest", "frequency_highest"]
    first, deviation = next(iter(cells(text).values())), 0.5 * 0.002e-2 * FIRST
    assert first[0] == pytest.approx([99.99, deviation]) and first[1] == pytest.approx([99.98])


def test_errors_of_wear_are_in_the_unit_of_the_number(tmp_path):
    names = ("frequency", "damping", "energy", "volume")
    numbers = {"cycles": np.array([0.0, 1e3, 1e4]), **{name: np.array([3.0, 2.0, 1.0]) for name in names}}
    numbers.update(frequency_error=np.array([0.1, 0.2, 0.3]), damping_error=np.array([0.01, 0.02, 0.03]))
    Wear(numbers, {}, []).report(tmp_path / "w.html")
    _, text = read(tmp_path / "w.html")
    assert [row[:2] for row in cells(text).values()] == [
        [[3, 0.1], [3, 0.01]],
        [[2, 0.2], [2, 0.02]],
        [[1, 0.3], [1, 0.03]],
    ]


def test_a_column_has_the_unit_of_its_largest_number(tmp_path):
    found = interface()
    found.numbers["closure"] = np.array([2e-9, 3e-6, 0.0])
    found.report(tmp_path / "i.html")
    text = (tmp_path / "i.html").read_text()
    assert ">0.002 µm<" in text and ">3 µm<" in text and ">0 µm<" in text and " nm<" not in text


def test_the_command_says_what_it_wrote(tmp_path, monkeypatch, capsys):
    words = ["petsam-joint", "stiffness", "scan.h5", "--normal-only", "--pressure", "1MPa,2MPa", "--body1", "steel",
             "--body2", "steel", "-o", "a", "--report", "c.html"]  # fmt: skip
    monkeypatch.setattr("sys.argv", words)
    monkeypatch.setattr(stiffnesses, "interface", lambda *_, **__: interface())
    monkeypatch.chdir(tmp_path)
    assert code_of("petsam-joint") == 0
    said = [line[6:] for line in capsys.readouterr().out.splitlines() if line.startswith("wrote ")]
    assert said == ["a.csv", "a.png", "c.html"] and sorted(path.name for path in tmp_path.iterdir()) == said


def test_the_command_writes_the_page_with_its_options(tmp_path, monkeypatch):
    words = ["petsam-joint", "stiffness", "scan<1>.h5", "--normal-only", "--pressure", "1MPa,2MPa", "--body1=steel",
             "--body2", "steel", "--report", "c.html"]  # fmt: skip
    monkeypatch.setattr("sys.argv", words)
    monkeypatch.setattr(stiffnesses, "interface", lambda *_, **__: interface())
    monkeypatch.chdir(tmp_path)
    assert code_of("petsam-joint") == 0 and [path.name for path in tmp_path.iterdir()] == ["c.html"]
    _, text = read(tmp_path / "c.html")
    given = rows(text.partition("<h2>Inputs</h2>")[2])
    shown = {name: re.sub("<.*?>", "", cell) for name, cell in given.items()}
    expected = dict(action="stiffness", file="scan&lt;1&gt;.h5", pressure="1MPa,2MPa", body1="steel", body2="steel")
    assert {name: shown[name] for name in expected} == expected and shown["normal-only"] == "yes"
    assert "report" not in shown


def worn():
    names = ("frequency", "damping", "energy", "volume", "frequency_error", "damping_error")
    numbers = {"cycles": np.array([0.0, 1e3, 1e4]), **{name: np.array([3.0, 2.0, 1.0]) for name in names}}
    return Wear(numbers, {"tension_B1 [N]": np.array([1e4, 9e3, 8e3])}, [])


def responded():
    numbers = {name: np.array([1.0, 2.0, 4.0]) for name in RESPONSE}
    return Response(numbers, np.zeros((3, 1, 1)), np.ones((3, 1)), ["patch1"])


SAVED = {
    "interface": lambda: interface({"loop_energy": np.array([0.01, 0.02, 0.03])}),
    "backbone": made,
    "band": lambda: Band({"as given": made(), "without friction": made(lower=0.01)}, {}),
    "response": responded,
    "wear": worn,
}


@pytest.mark.parametrize("kind", SAVED)
def test_a_saved_table_has_the_page_of_its_result(tmp_path, monkeypatch, kind):
    found = SAVED[kind]()
    found.to_csv(tmp_path / "t.csv")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", ["petsam-plot", "--report", "t.html", "t.csv"])
    assert code_of("petsam-plot") == 0
    page, text = read(tmp_path / "t.html")
    assert page.titles == ["Numbers", "Pictures", "Citation"] and len(page.all("img")) == 1
    saved = petsam.joint.read("t.csv")
    for column, written in zip(found.table(), saved.table()):
        assert (column.name, column.unit) == (written.name, written.unit)
        assert list(column.values) == pytest.approx(list(written.values)) if column.unit else column.values
        if column.name.partition("_")[0] not in ("energy", "tension"):  # of patches and bolts
            assert column.text == written.text
    if kind != "band":  # its page has limits instead of assemblies
        found.report("own.html")
        own = (tmp_path / "own.html").read_text()
        assert own.partition("<h1>")[2].partition("</h1>")[0] == text.partition("<h1>")[2].partition("</h1>")[0]
        for first, row in cells(own).items():
            assert sum(cells(text)[first], []) == pytest.approx(sum(row, []))


def test_a_band_has_a_curve_for_each_assembly(tmp_path):
    SAVED["band"]().to_csv(tmp_path / "t.csv")
    left, right = petsam.plot.saved(petsam.joint.read(tmp_path / "t.csv")).axes
    assert [one.get_label() for one in left.lines] == ["as given", "without friction"]
    assert right.lines[0].get_ydata() == pytest.approx([100.0, 200.0, 400.0])  # 1e-6


@pytest.mark.parametrize(
    "lines, says",
    [
        (["depth [m],load [N]", "1,2"], "its first column is depth: tables of petsam-joint begin with one of pressure"),
        (
            ["case,exit_code,seconds [s]", "a,0,1"],
            "its first column is case: tables of petsam-joint begin with one of ",
        ),
        (["alpha [1],frequency [Hz]", "1,2,3"], "line 2: has 3 values, and there are 2 columns"),
        (["alpha [1],frequency [Hz]", "1,x"], "column frequency [Hz]: could not convert string to float: 'x'"),
        (["alpha [1]"], "no table: expected a line of heads, as name [unit], and lines of values"),
        ([",alpha [1]", "0,1"], "line 1: column 1 has no name: give one, as pressure [Pa]"),
        (["", "alpha [1],  ", "1,2"], "line 2: column 2 has no name"),
        (["alpha [1], [Pa]", "1,2"], "line 1: column 2 has no name"),
        (["alpha [1],modal", "1," + "2" * 140000], "line 2: field larger than field limit (131072): give a table of"),
        ([], "no table"),
    ],
)
def test_another_table_is_refused(tmp_path, lines, says):
    (tmp_path / "t.csv").write_text("\n".join(lines))
    with pytest.raises(petsam.Error, match=re.escape(f"t.csv: {says}")):
        petsam.joint.read(tmp_path / "t.csv")


@pytest.mark.parametrize(
    "given, says",
    [
        ([], "a table of petsam-joint is drawn on a page: give --report NAME.html"),
        (["--report", "t.html", "--loop"], "--loop: has no effect on the page of a table"),
        (["--report", "t.html", "--at", "0,0"], "--at: has no effect on the page of a table"),
    ],
)
def test_a_table_has_a_page_and_no_other_pictures(tmp_path, monkeypatch, capsys, given, says):
    worn().to_csv(tmp_path / "t.csv")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", ["petsam-plot", *given, "t.csv"])
    assert code_of("petsam-plot") and says in capsys.readouterr().err and not (tmp_path / "t.html").exists()


def test_what_cannot_be_is_refused(tmp_path, monkeypatch, capsys):
    with pytest.raises(petsam.Error, match=r"i.txt: expected a name that ends in .html"):
        interface().report(tmp_path / "i.txt")
    with pytest.raises(petsam.Error, match="is a directory"):
        (tmp_path / "d.html").mkdir()
        interface().report(tmp_path / "d.html")
    monkeypatch.setattr(stiffnesses, "interface", lambda *_, **__: pytest.fail("computed"))
    given = ["stiffness", "scan.h5", "--normal-only", "--pressure", "1MPa", "--body1", "steel", "--body2", "steel"]
    for name, says in (("c.pdf", "--report: c.pdf: expected a name"), (str(tmp_path / "d.html"), "is a directory")):
        monkeypatch.setattr("sys.argv", ["petsam-joint", *given, "--report", name])
        try:
            assert code_of("petsam-joint") != 0
        except SystemExit as error:
            assert error.code
        assert says in capsys.readouterr().err
