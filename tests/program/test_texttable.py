"""The one reader of text tables: rows, heads with units, decimal commas; errors name the file and the line."""

import csv
import itertools

import numpy as np
import pytest

from petsam.apps.wheel.words import split_numbers
from petsam.core.errors import Error
from petsam.core.texttable import Form, Head, Table, Text, are_units, head_of, number_of


@pytest.fixture
def write(tmp_path):
    def write(text, name="t.csv"):
        (tmp_path / name).write_text(text, encoding="utf-8", newline="")
        return str(tmp_path / name)

    return write


@pytest.mark.parametrize(
    "mark, comma", [*itertools.product([",", ";", "\t", " ", "; "], [False]), (";", True), (" ", True)]
)
def test_numbers_are_those_that_were_written(write, mark, comma):
    """Whatever separates them, and whichever sign their decimals have."""
    values = np.random.default_rng(1).uniform(-9.0, 9.0, (7, 3)).round(4)
    rows = [mark.join(repr(float(value)) for value in row) for row in values]
    text = "\n".join([mark.join(["a [um]", "b [um]", "c [N]"]), *rows])
    numbers, columns = Table(write(text.replace(".", ",") if comma else text), None, "point", "points").rows()
    assert numbers == list(range(2, 9)) and list(columns) == ["a", "b", "c"]
    assert np.array_equal(np.array(list(columns.values())).T, values)


def test_lines_are_counted_with_those_that_are_no_rows(write):
    text = "# a comment\r\n\r\nx [m],y [m]\r\n % another\r\n1,2\r\n\r\n3,4\r\n"
    table = Table(write(text), None, "point", "points")
    assert (table.head, table.rows()[0]) == (3, [5, 7])
    assert [line for _, line in Text(write(text)).header] == ["# a comment", "x [m],y [m]", " % another"]


@pytest.mark.parametrize(
    "word, name, unit",
    [
        ("x [mm]", "x", "mm"), ("fx (kN)", "fx", "kN"), ("depth{um}", "depth", "um"), ("t <ms>", "t", "ms"),
        ("F / N", "F", "N"), ("F/N", "F", "N"), ("v mm/s", "v", "mm/s"), ("Q N/mm", "Q", "N/mm"), ("d_um", "d", "um"),
        ("Weg in mm", "Weg", "mm"), ("Weg, mm", "Weg", "mm"), ("speed_rpm", "speed", "rpm"), ("p.MPa", "p", "MPa"),
        ("time", "time", None), ("what is in", "what is in", None), ("node_label", "node_label", None),
        ('"x [mm]"', "x", "mm"), ("x []", "x", ""),
    ],
)  # fmt: skip
def test_a_head_states_its_unit_in_any_usual_way(word, name, unit):
    assert head_of(word)[:2] == (name, unit)


def test_units_may_stand_in_the_row_below(write):
    for below in ("mm;N;-", "[mm];(N);[-]", "mm;N;"):
        table = Table(write(f"x;F;n\n{below}\n1;2,5;3\n"), {"x": "x", "f": "fx"}, "point", "points")
        assert table.units == {"x": "mm", "fx": "N"} and table.others == ["n"]
        numbers, columns = table.rows()
        assert numbers == [3] and columns["fx"] == [2.5]
    assert Table(write("x [mm];F [N]\n1;1\n"), None, "point", "points").rows()[0] == [2]  # 1 is a number, too
    with pytest.raises(Error, match="column x .mm.: the line below states um: remove one"):
        Table(write("x [mm],F\num,N\n1,2\n"), None, "point", "points")
    assert are_units(["um", "", "1"]) and not are_units(["um", "F"]) and not are_units(["1", "-"])


def test_a_name_that_ends_as_a_unit_is_known_as_a_whole(write):
    table = Table(write("flow_s,flow [mm]\n1,2\n"), {"flow_s": "u", "flow": "w"}, "point", "points")
    assert table.columns == {"u": 0, "w": 1} and table.units == {"u": None, "w": "mm"}


def test_names_with_blanks_between_blanks_end_at_brackets_or_two_blanks(write):
    for head in ("Total time [s] Friction force [N]", "Total time  Friction force"):
        assert Text(write(f"{head}\n1 2\n")).headed("point", "points").words == [
            word.strip() for word in (["Total time [s]", "Friction force [N]"] if "[" in head else head.split("  "))
        ]


def test_words_in_quotation_marks_are_those_of_the_csv_library(write):
    words = ["a", "b,c", 'say ""', "", " d", "0,1e-4"]
    with open(write(""), "w", newline="") as file:
        csv.writer(file).writerows([["h"] * len(words), words])
    table = Text(file.name).headed("case", "cases")
    assert table.body == [(2, [word.strip() for word in words])]


def test_the_head_decides_what_separates(write):
    table = Text(write("a;b\n0,1;1,2,3\n")).headed("case", "cases", separators=(";", ","))
    assert table.body == [(2, ["0,1", "1,2,3"])]
    assert Text(write("a\nb c\n")).headed("case", "cases", separators=(";", ",")).body == [(2, ["b c"])]


@pytest.mark.parametrize(
    "text, complaint",
    [
        ("", "is empty: give a head and a line per point"),
        ("# x\n\n", "is empty"),
        ("x,y\n", "has a head, but no lines of points below it"),
        ("x,y\n1,2\n\n1,2,3\n", "line 4 has 3 words, line 1 has 2 heads"),
        ("x\ty\n1\n", "line 2 has 1 word, line 1 has 2 heads"),
        ("x,y\n1,a\n", "line 2: a in column y is no finite number"),
        ("x,y\n1,\n", "line 2: an empty word in column y is no finite number"),
        ("x,y\n1,1e999\n", "line 2: 1e999 in column y"),
        ("x,y\n1,1_000\n", "line 2: 1_000 in column y"),
        ("x;y\n1;1,000\n", "line 2: 1,000 in column y is no finite number: write it with a decimal point"),
        ("x;y\n1,5;1.5\n", "line 2: 1,5 in column x is no finite number: write it with a decimal point"),
        ("x [m],x [mm]\n1,2\n", "line 1: two columns are x: remove one"),
        ('x,y\n1,"2\n3,4\n', "line 2: a quote is not closed on its line"),
        ("x,y\n1,\0\n", "bytes of 0"),
    ],
)
def test_faults_of_a_table_have_their_line(write, text, complaint):
    path = write(text)
    with pytest.raises(Error, match=r"t\.csv: ") as error:
        Table(path, None, "point", "points").rows()
    assert complaint in str(error.value)


def test_a_map_has_rows_of_one_length(write):
    path = write("Width: 80 um wide\n1;2,5;\n3;bad;\n")
    values, before, first = Text(path).table
    assert before == 1 and first == 2 and np.array_equal(values, [[1.0, 2.5], [3.0, np.nan]], equal_nan=True)
    for text, complaint in (
        ("1 2\n3\n", "line 2 has 1 numbers, line 1 has 2"),
        ("1 2\n3 1_0\n", "'1_0' is not a number"),
    ):
        with pytest.raises(Error, match=complaint):
            print(Text(write(text)).table)


def test_signs_of_comments_are_those_of_the_form(write):
    form = Form(comments=("!", "//"), behind=True)
    text = Text(write("! a\n1 2 // b\n# 3\n//\n"), form)
    assert text.kept == [(2, "1 2 "), (3, "# 3")]
    assert Text(write('! "a"\n1\n!\n'), form).every == [(1, "a", True), (2, "1", False)]


def test_words_that_are_no_numbers():
    assert number_of("1e3") == 1000.0 and number_of("x") is None and number_of("1_0") is None
    assert all(np.isnan(number_of(word)) for word in ("", "NaN", "N/A", "-1.#IND", "#VALUE!"))
    assert number_of("gone") is None and np.isnan(number_of("Gone", ("gone",)))
    assert Head("x", None, "x") == head_of(" x ")


@pytest.mark.parametrize("line", ["1 2 3", "1;2;3", "1,2,3", " 1, 2, 3 ", "1\t2 3", "1; 2 3;"])
def test_numbers_alone_may_have_several_separators(line):
    assert split_numbers(line) == ["1", "2", "3"]
