"""The counts of scripts/maintain/ruler.py do not rise, and their limits follow them down."""

import sys
from pathlib import Path

import pytest

from conftest import PROGRAM

ROOT = Path(__file__).resolve().parents[2]

sys.path.insert(0, str(ROOT / "scripts" / "maintain"))
import ruler  # noqa: E402


@pytest.fixture(scope="module")
def counts():
    return ruler.measure(PROGRAM.parents[1])


@pytest.mark.parametrize("name", ruler.LIMITS)
def test_no_count_rises(counts, name):
    assert counts[name] <= ruler.LIMITS[name][0], f"{name}: {counts[name]}"


@pytest.mark.parametrize("name", ruler.LIMITS)
def test_limits_are_what_there_is(counts, name):
    assert counts[name] >= ruler.LIMITS[name][0], f"{name} has come down to {counts[name]}: lower its limit"


def test_comments_do_not_count(tmp_path):
    path = tmp_path / "one.c"
    path.write_text("/* SamBodyTop(b, 1) */ x = SamBodyTop(b, 2); /* more */\n")
    assert ruler.found(ruler.MATERIALS, tmp_path) == {path: 1}


def test_a_file_names_a_capability_in_code_and_strings_outside_of_its_home():
    found = [str(path.relative_to(ROOT)) for path in ruler.named_outside("heat")]
    assert "src/laws/register.c" in found and "src/ground/base/materials.c" in found  # SamLawCreate_Heat; a string
    assert not any("laws/heat" in name or name == "src/contact/try.c" for name in found)


@pytest.mark.parametrize(
    "text, shows",
    [
        ("-heat steady", True),
        ("dict(heat=1)", True),
        ('{"heat": 1}', True),
        ("study:\n  heat: [steady]", True),
        ("the heat of a contact", False),
        ("-heat_resistance 1", False),
        ("preheat=1", False),
    ],
)
def test_a_page_shows_an_option_not_a_word(text, shows):
    assert ("heat" in ruler.names_shown(text)) == shows


@pytest.mark.parametrize(
    "old, new, file, guards",
    [
        ("#define RATIO 0.5", "#define RATIO 1", "one.c", True),
        ("#define RATIO 0.5 /* of widths */", "#define RATIO 0.5 /* of the widths */", "one.c", False),
        ("#define RATIO 0.5", "", "one.c", False),
        ("#define RATIO 0.5", "#define RATIO 1", "two.c", False),
        ("x = RATIO * y + RATIO;", "x = y;", "one.c", True),
        ("x = RATIO * y", "x = y", "one.c", False),  # another place still uses it
        ("x = RATIO * y + RATIO;", "x = y + RATIO;", "one.c", False),
    ],
)
def test_a_number_is_guarded_by_a_change_of_its_value_or_of_all_its_uses(  # noqa: PLR0913
    old, new, file, guards, tmp_path, monkeypatch
):
    path = tmp_path / "src" / "post" / "advice" / "one.c"
    path.parent.mkdir(parents=True)
    path.write_text("#define RATIO 0.5 /* of widths */\nx = RATIO * y + RATIO;\n")
    mutant = ruler.check.Mutant("", f"src/post/advice/{file}", old, new, ())
    monkeypatch.setattr(ruler, "ROOT", tmp_path)
    monkeypatch.setattr(ruler, "SRC", tmp_path / "src")
    monkeypatch.setattr(ruler, "DOUBTED", ("src/post/advice/*.[ch]",))
    assert ruler.unguarded([]) == [(path, "RATIO")]
    assert ruler.unguarded([mutant]) == ([] if guards else [(path, "RATIO")])
