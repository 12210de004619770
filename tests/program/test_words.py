"""The reader of words and the table of units that all commands share."""

import argparse
import math
import re
from functools import partial

import numpy as np
import pytest

import support
from petsam.apps.joint import command as joint
from petsam.apps.joint import words as of_joint
from petsam.apps.wheel import words as of_wheel
from petsam.core import errors, line, tables, texttable, units, words
from petsam.core.frames import Frame


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
        ("5 mm mm", "m"), ("\u0661\u0662", "1"), ("1e\u0663", "1"), ("\u0967mm", "m"), ("\uff11", "1"),
    ],
)  # fmt: skip
def test_what_is_no_such_number_is_told(text, unit):
    with pytest.raises(words.WordError, match="expected a length"):
        words.number(text, "a length", unit)


def test_only_the_usual_digits_are_numbers():
    for text in ("\u0661\u0662", "\u0967", "\uff11"):
        with pytest.raises(words.WordError, match="a whole number"):
            words.integer(text)
        assert texttable.number_of(text) is None
    with pytest.raises(words.WordError):
        words.span("\u0660:1:3", "numbers")


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
    parser = line.Parser(prog="petsam-plot")
    parser.add_cycles(parser.add_argument_group(), "a", "b")
    for text, value in (("20ms,1s", (0.02, 1.0)), ("0.02", (0.02, None)), ("20ms,0", (0.02, 0.0))):
        assert parser.parse_args(["--period", text]).period == value


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


@pytest.mark.parametrize(
    "text, unit, value",
    [
        ("72km/h", "m/s", 20.0), ("1e5km", "m", 1e8), ("2 mrad", "rad", 2e-3), ("90deg", "rad", math.pi / 2.0),
        ("180 deg/s", "rad/s", math.pi), ("60rpm", "rad/s", 2.0 * math.pi), ("10mrad/s", "rad/s", 0.01),
        ("5%", "1", 0.05),
        ("50 mJ/m2", "J/m2", 0.05), ("3\u00b5N", "N", 3e-6), ("2us", "s", 2e-6), ("4 uNm", "N m", 4e-6),
    ],
)  # fmt: skip
def test_units_of_quantities(text, unit, value):
    assert words.number(text, unit=unit) == pytest.approx(value, rel=1e-15)
    assert units.quantity("km/h") == "m/s" and units.quantity("km") == "m"


def test_number_without_a_unit_may_be_in_another_one():
    assert words.number("180", unit="m", bare="mm") == words.number("18cm", unit="m", bare="mm") == 0.18
    with pytest.raises(words.WordError):
        words.number("3Pa", unit="m", bare="mm")


def test_slope_is_an_angle():
    assert of_wheel.slope("1:40", "") == pytest.approx(math.atan(0.025)) == -of_wheel.slope("-1:40", "")
    assert of_wheel.slope("0.025", "") == 0.025 and of_wheel.slope("1deg", "") == pytest.approx(math.pi / 180.0)
    for text in ("1:0", "1:-40", "1:2:3", ":", "1:", "x"):
        with pytest.raises(words.WordError):
            of_wheel.slope(text, "a slope")


def test_points_are_numbers_between_colons():
    assert Frame.read("0,0,0:1,0,0.5") == ((0.0, 0.0, 0.0), (1.0, 0.0, 0.5))
    for text in ("0,0", "0,0,0:", "0,0,0:1,0,0:0,0,1:1,1,1", ""):
        with pytest.raises(words.WordError, match="expected ORIGIN"):
            Frame.read(text)


def test_bounds_may_be_left_out():
    for text, found in (("3:10", (3, 10)), ("2:", (2, None)), (":-1", (None, -1)), (":", (None, None))):
        assert words.bounds(text, "") == found
    for text in ("3", "1:2:3", "a:2", "1.5:2", "10:3"):
        with pytest.raises(words.WordError, match=f"^{text}: expected FIRST:LAST$"):
            words.bounds(text, "FIRST:LAST", together=lambda found: found[0] < found[1])
    with pytest.raises(words.WordError):
        words.bounds(":", "FIRST:LAST", together=any)


def test_numbers_may_be_judged_together():
    assert words.numbers("1,2", together=lambda found: found[0] < found[1]) == [1.0, 2.0]
    with pytest.raises(words.WordError, match="^2,1: expected rising"):
        words.numbers("2,1", "rising numbers", together=lambda found: found[0] < found[1])
    assert list(words.span("3mm", "", "m", count=1)) == [3e-3]
    with pytest.raises(words.WordError):
        words.span("3mm,4mm", "one, or FIRST:LAST:COUNT", "m", count=1)


@pytest.mark.parametrize(
    "ends, good, bad",
    [
        (dict(above=0.0), ("1e-300", "1e300"), ("0", "-1", "inf")),
        (dict(least=0.0), ("0", "7"), ("-1e-300", "inf")),
        (dict(below=1.0), ("0.999", "-5"), ("1", "-inf")),
        (dict(least=-180.0, most=180.0), ("-180", "180"), ("180.1", "-181")),
        (dict(above=-1.0, below=0.5), ("-0.9", "0.4"), ("-1", "0.5")),
    ],
)
def test_numbers_have_ends(ends, good, bad):
    for text in good:
        assert (
            words.number(text, **ends) == float(text) == words.numbers(text, **ends)[0] == words.span(text, "", **ends)
        )
        assert words.named(f"a={text}", "", **ends) == ("a", float(text))
    for text in bad:
        for reader in (words.number, words.numbers, words.span):
            with pytest.raises(words.WordError, match="expected a number in its range"):
                reader(text, "a number in its range", **ends)


@pytest.mark.parametrize("reader, text", [(words.integer, "1"), (words.integers, "2,1"), (words.bounds, "1:3")])
def test_whole_numbers_have_ends(reader, text):
    assert reader(text, "", least=1, below=4)
    for ends in (dict(above=1), dict(least=2), dict(below=1), dict(most=0)):
        with pytest.raises(words.WordError):
            reader(text, "", **ends)


def test_names_have_values_of_any_reader():
    step = partial(words.integer, least=0)
    assert words.named("a_1=3", "NAME=STEP", reader=step, known=r"\w{1,5}") == ("a_1", 3)
    assert words.named("a=b=c", "NAME=VALUE", reader=str) == ("a", "b=c")
    assert words.named("210GPa", "[SET=]E", "Pa", bare="") == ("", 210e9)
    assert words.named("A=210GPa", "[SET=]E", "Pa", bare="") == ("A", 210e9)
    for text in ("a_1=-3", "a_1=", "=3", "a_1", "toolong=3", "a-b=3", "a_1=x"):
        with pytest.raises(words.WordError, match=f"^{text}: expected NAME=STEP$"):
            words.named(text, "NAME=STEP", reader=step, known=r"\w{1,5}")
    with pytest.raises(words.WordError, match="^A=3kg: expected a modulus; units are Pa, kPa"):
        words.named("A=3kg", "a modulus", "Pa", bare="")


def test_unknown_names_are_told_with_the_nearest():
    with pytest.raises(words.Error, match="^basqin: is no criterion: is basquin meant"):
        words.names("swt,basqin", known=("swt", "basquin"), what="criterion")
    with pytest.raises(words.WordError, match="^12: expected 1 or 2"):
        words.names("12", "1 or 2", "12")
    assert of_wheel.choice("up", "up or down", ("up", "down")) == "up"
    for text in ("u", "", "up,down"):
        with pytest.raises(words.WordError):
            of_wheel.choice(text, "up or down", ("up", "down"))


def test_each_word_has_its_reader():
    length, share = partial(words.number, unit="m"), partial(words.number, least=0.0, below=1.0)
    assert words.each("2um,5%", "", length, share) == pytest.approx((2e-6, 0.05))
    assert words.each("2um", "", length, share, rest=(0.0,)) == (pytest.approx(2e-6), 0.0)
    assert words.each("2um,5%", "", length, share, rest=(0.0,)) == pytest.approx((2e-6, 0.05))
    for text in ("2um", "2um,5%,1", "2um,2", "2um,"):
        with pytest.raises(words.WordError, match=f"^{text}: expected L,S$"):
            words.each(text, "L,S", length, share)
    with pytest.raises(words.WordError, match="^2Pa,5%: expected L,S; units are m, cm"):
        words.each("2Pa,5%", "L,S", length, share)


def test_pair_is_twice_one_or_two():
    assert of_wheel.pair("a", "") == ("a", "a") and of_wheel.pair("a, b", "") == ("a", "b")
    assert of_wheel.pair("a,b", "", whole=lambda text: True) == ("a,b", "a,b")
    assert of_wheel.pair("1mm,2mm", "", partial(words.number, unit="m")) == (1e-3, 2e-3)
    for text in ("", "a,", ",a", "a,b,c"):
        with pytest.raises(words.WordError, match="expected LEFT,RIGHT"):
            of_wheel.pair(text, "LEFT,RIGHT")


def test_either_is_what_the_first_reader_takes(tmp_path):
    form, there = "a number, or a file", tmp_path / "there.any"
    there.write_text("")
    readers = words.number, partial(of_joint.file_name, form=form, endings=(".h5",))
    assert of_joint.either("1e-6", form, *readers) == 1e-6
    assert [of_joint.either(text, form, *readers) for text in ("new.H5", str(there))] == ["new.H5", str(there)]
    with pytest.raises(words.WordError, match="^new.txt: expected a number, or a file$"):
        of_joint.either("new.txt", form, *readers)


def test_option_has_what_is_made_of_its_word():
    read = line.word(words.numbers, "numbers", count=2, to=sum, besides=("auto",))
    assert read("1,2") == 3.0 and read("auto") == "auto"
    for text in ("aut", "1"):
        with pytest.raises(argparse.ArgumentTypeError, match=f"^{text}: expected numbers"):
            read(text)


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
    assert tables.Column.headed("pressure [Pa]", "of p", [1.0]) == ("pressure", "Pa", "of p", [1.0])
    assert tables.Column.headed("case", "", [])[:2] == ("case", "")


def parsers():
    """The command lines: without arguments for each of the programs."""
    from petsam.apps import records

    return [one.command for one in records() if one.command] + ["petsam-plot"]


@pytest.mark.parametrize("program", parsers())
def test_an_unknown_option_is_named_before_missing_ones(call, program):
    def said(*given):
        code, lines = call(program, *given)
        assert code == 2
        return "\n".join(lines)

    begin = f"{program}: error: unrecognized arguments: "
    assert said("--nonsense") == f"{begin}--nonsense; see {program} --help"
    assert said("-7x", "--nonsense=3", "--qqq").startswith(f"{begin}--nonsense=3 --qqq; see")
    assert said("--hel").startswith(f"{begin}--hel: is --help meant?")  # not taken for an abbreviation


def test_only_similar_names_are_suggested():
    names = ["output", "report", "no-picture", "sensor", "E"]
    for tried, near in (("outptu", "output"), ("OUTPUT", "output"), ("no_picutre", "no-picture"), ("senor", "sensor")):
        assert errors.nearest(tried, names) == [near]
    for tried in ("nonsense", "rapid", "e2", "", "x"):
        assert errors.nearest(tried, names) == []
    assert [errors.slips(*pair) for pair in (("abcd", "abdc"), ("abc", "bc"), ("", "ab"), ("abc", "axd"))] == [
        1,
        1,
        2,
        2,
    ]


def test_every_command_says_what_it_wrote(capsys):
    line.wrote("a.csv", "b.png")
    line.wrote()
    assert capsys.readouterr().out == "wrote a.csv\nwrote b.png\n"
    for path in (support.ROOT / "scripts" / "petsam").rglob("*.py"):
        assert path.name == "line.py" or not re.search(r"print\(f?\"wrote", path.read_text()), path
