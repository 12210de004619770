"""The reader of words and the table of units that all commands share."""

import math

import numpy as np
import pytest

from petsam.core import tables, units, words


@pytest.mark.parametrize(
    "text, unit, value",
    [
        ("210GPa", "Pa", 210e9), ("5 MPa", "Pa", 5e6), ("1e-3", "m", 1e-3), ("0.1mm", "m", 1e-4),
        ("-2.5um", "m", -2.5e-6), ("3 microns", "m", 3e-6), ("1in", "m", 0.0254), ("2kN", "N", 2e3),
        ("120 Hz", "Hz", 120.0), (".5", "1", 0.5),
    ],
)  # fmt: skip
def test_number_with_its_unit(text, unit, value):
    assert words.number(text, unit=unit) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    "text, unit",
    [
        ("5MPa", "m"), ("1,5", "1"), ("nan", "1"), ("", "1"), ("1_000", "1"), ("inf", "Pa"), ("0x10", "1"),
        ("5 mm mm", "m"),
    ],
)  # fmt: skip
def test_what_is_no_such_number_is_told(text, unit):
    with pytest.raises(words.WordError, match="expected a length"):
        words.number(text, "a length", unit)


def test_factor_before_a_unit_is_a_unit():
    assert units.size("0.1mm") == pytest.approx(1e-4) and units.size("1.6e-7m") == 1.6e-7
    assert units.size("0 mm") is None and units.size("mMm") is None and units.size("Pa") is None


def test_numbers_have_all_a_unit_or_none():
    assert words.numbers("1mm,20um", unit="m") == pytest.approx([1e-3, 2e-5])
    with pytest.raises(words.WordError, match="give each number its unit"):
        words.numbers("500,10um", unit="m")
    with pytest.raises(words.WordError):
        words.numbers("1,2,3", count=(1, 2))


def test_span_is_a_list_or_steps():
    assert np.allclose(words.span("1um:100um:3", "lengths", "m", geometric=True), [1e-6, 1e-5, 1e-4])
    assert list(words.span("110:118:3", "frequencies")) == [110.0, 114.0, 118.0]
    assert list(words.span("5,7", "numbers")) == [5.0, 7.0]
    for text in ("1:2", "1:2:1", "1,2:3:4", "1:2:3:4", "a:2:3"):
        with pytest.raises(words.WordError):
            words.span(text, "numbers")


def test_named_number_and_names():
    assert words.named("B1=12kN", "BOLT=FORCE", "N") == ("B1", 12e3)
    for text in ("=1", "B1", "B1=", "B1=x"):
        with pytest.raises(words.WordError, match="expected BOLT=FORCE"):
            words.named(text, "BOLT=FORCE", "N")
    assert words.names("a,b", known="abc") == ["a", "b"]
    with pytest.raises(words.WordError):
        words.names("a,,b")
    assert words.integer("-3") == -3
    with pytest.raises(words.WordError):
        words.integer("1e3")


def test_table_says_names_and_units(tmp_path):
    columns = [
        tables.Column("case", "", "its name", ["a", "b, c"]),
        tables.Column("pressure", "Pa", "its peak", np.array([1e9, math.nan])),
        tables.Column("friction", "1", "coefficient", [0.1, 0.2]),
    ]
    tables.write_csv(tmp_path / "t.csv", columns)
    text = (tmp_path / "t.csv").read_text()
    assert text == 'case,pressure [Pa],friction [1]\na,1000000000.0,0.1\n"b, c",nan,0.2\n'
    assert tables.split("pressure [Pa]") == ("pressure", "Pa") and tables.split("case") == ("case", "")
