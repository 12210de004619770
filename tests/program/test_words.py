"""The reader of words and the table of units that all commands share."""

import math

import numpy as np
import pytest

from petsam.apps.joint import command as joint
from petsam.core import line, tables, units, words


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


def test_zero_needs_no_unit_unless_it_may_be_a_decimal_comma():
    assert words.numbers("0.1mm,0", unit="m", count=2) == pytest.approx([1e-4, 0.0])
    assert words.numbers("0,5mm", unit="m", count=2) == pytest.approx([0.0, 5e-3])
    assert words.numbers("0,0.1mm,0.2mm", unit="m") == pytest.approx([0.0, 1e-4, 2e-4])
    for text in ("0,5mm", "1mm,0,25mm"):
        with pytest.raises(words.WordError, match="decimals have a point"):
            words.numbers(text, unit="m")


def test_limits_may_be_of_any_quantity():
    found = words.limits("-50MPa,0.1GPa")
    assert found == pytest.approx([-50e6, 1e8]) and found.unit == "Pa" and words.limits("1,2").unit == ""
    found.need("Pa", "pressure")
    with pytest.raises(words.Error, match="shift: expected a unit of these: m, cm, mm"):
        found.need("m", "shift")
    for text in ("1mm,1MPa", "1,2,3", "2,1", "1MMa,2", "1Pa", ""):
        with pytest.raises(words.WordError, match="expected LOW,HIGH"):
            words.limits(text)


@pytest.mark.parametrize(
    "option, text, value",
    [
        ("--pressure", "1MPa:4MPa:3", [1e6, 2e6, 4e6]), ("--pressure", "5e6,0.01GPa", None),
        ("--hardness", "2GPa", 2e9),
        ("--body1", "210GPa,0.3", (210e9, 0.3)), ("--body2", "inf,0", (math.inf, 0.0)), ("--area", "2mm2", 2e-6),
        ("--preload", "B1=12kN", [("B1", 12e3)]), ("--amplitudes", "1um:100um:3", [1e-6, 1e-5, 1e-4]),
        ("--force", "TIP:z=500mN", ("TIP:z", 0.5)), ("--frequencies", "0.1kHz,110Hz", [100.0, 110.0]),
        ("--frequencies", "110:118:3", [110.0, 114.0, 118.0]), ("--damping", "0.01", 0.01), ("--damping", "1%", 0.01),
        ("--area", "2mm", None), ("--preload", "B1=12kg", None), ("--force", "TIP:z=0", None),
        ("--amplitudes", "1um:100um", None), ("--frequencies", "110rpm", None), ("--body1", "210GPa", None),
        ("--body1", "0.3,210GPa", None), ("--steps", "2.5", None), ("--cycles", "1e5,1e4", None),
    ],
)  # fmt: skip
def test_words_of_a_joint_have_their_units(option, text, value, capsys):
    given = ["stiffness", "scan.h5", option, text]
    if value is None:
        with pytest.raises(SystemExit) as ended:
            joint._parser().parse_args(given)
        assert ended.value.code == 2 and f"argument {option}: {text}: expected" in capsys.readouterr().err
        return
    found = getattr(joint._parser().parse_args(given), option[2:])
    if isinstance(value, (list, float)) and not isinstance(np.ravel(value)[0], str):
        assert np.allclose(found, value, rtol=1e-12)
    else:
        assert found == value


def test_words_of_a_cycle_have_their_units():
    period = line.word(line.period)
    assert period("20ms,1s") == pytest.approx((0.02, 1.0)) and period("0.02") == (0.02, None)
    assert period("20ms,0") == pytest.approx((0.02, 0.0))


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


class _Table(tables.Tabled):
    def table(self):
        return [tables.Column("steps", "1", "how many", [3, None]), tables.Column("pressure", "Pa", "peak", [1.5, 2.0])]


def test_what_has_a_table_is_written_by_its_columns(tmp_path):
    _Table().to_csv(tmp_path / "t.csv")
    assert (tmp_path / "t.csv").read_text() == "steps [1],pressure [Pa]\n3,1.5\n,2.0\n"
    pytest.importorskip("pandas")
    found = _Table().to_dataframe()
    assert list(found) == ["steps", "pressure"] and found.attrs["units"]["pressure"] == "Pa"


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
