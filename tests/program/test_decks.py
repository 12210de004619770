"""Decks as programs and hands write them: encodings, cards that change a body, damage, units."""

import os
import re

import numpy as np
import pytest

import petsam
from kinds import decks
from petsam.apps.compliance import command, deck, keywords, mesh, model, stiffness
from test_compliance_command import ALWAYS, BOTTOM, PARTS, bricks, compliance, read_text, written  # noqa: F401
from test_compliance_pair import HELD, both, pair, write  # noqa: F401
from test_compliance_tool import needs_calculix

BRICK = """*NODE, NSET=ALL
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
*ELEMENT, TYPE=C3D8, ELSET=BODY
1, 1, 2, 3, 4, 5, 6, 7, 8
*MATERIAL, NAME=STEEL
*ELASTIC
210e3, 0.3
*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL
*NSET, NSET=LOW
1, 2, 3, 4
*SURFACE, NAME=TOP
BODY, S2
"""
TURNED = "1, 5, 6, 7, 8, 1, 2, 3, 4"


def refused(path, text, says):
    """Asserts that a deck is rejected with a place in it."""
    with pytest.raises(petsam.Error) as caught:
        read_text(path, text)
    assert says in str(caught.value), caught.value
    return str(caught.value)


# ---------------------------------------------------------------- encodings


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1", "cp1252", "utf-16", "utf-8-sig"])
@pytest.mark.parametrize("one, other", [("K\u00f6rper", "K\u00e4rper"), ("FU\u00df", "FUSS"), ("a\u00b5", "a\u00b6")])
def test_names_that_differ_in_one_letter_are_two(tmp_path, encoding, one, other):
    text = BRICK.replace("*ELEMENT", f"*NSET, NSET={one}\n1\n*NSET, NSET={other}\n2\n*ELEMENT")
    (tmp_path / "a.inp").write_bytes(text.encode(encoding))
    sets = deck.read(str(tmp_path / "a.inp")).mesh.node_sets
    assert [deck.need_set(sets, name, "node set", "a.inp").tolist() for name in (one, other)] == [[0], [1]]


def test_letters_beyond_ascii_end_no_line(tmp_path):
    """The dots of cp1252, where they end a line in Latin-1, and the line separator of Unicode, in comments."""
    text = BRICK.replace("1, 2, 3, 4\n", "1, 2\n** once 1, 2\x85 4, 5\n3, 4\n")
    for encoding, letter in (("latin-1", "\x85"), ("utf-8", "\u2028"), ("utf-8", "\x0c")):
        (tmp_path / "a.inp").write_bytes(text.replace("\x85", letter).encode(encoding))
        assert deck.read(str(tmp_path / "a.inp")).mesh.node_sets["LOW"].tolist() == [0, 1, 2, 3]
    (tmp_path / "a.inp").write_text(BRICK, newline="\r")
    assert len(deck.read(str(tmp_path / "a.inp")).mesh.nodes) == 8


def test_bytes_of_zero_are_no_deck(tmp_path):
    (tmp_path / "a.inp").write_bytes(BRICK.encode("utf-16-le"))
    with pytest.raises(petsam.Error, match="is no text, as it has bytes of 0: save it as a text in UTF-8"):
        deck.read(str(tmp_path / "a.inp"))


def test_names_in_quotation_marks_that_differ_in_case_are_rejected(tmp_path):
    text = BRICK.replace("*ELEMENT", '*NSET, NSET="Low one"\n1\n*NSET, NSET="low One"\n2\n*ELEMENT')
    refused(tmp_path / "a.inp", text, 'a.inp:12: "low One" and "Low one" differ in case only')


def test_options_files_of_a_study_that_differ_in_one_letter_are_two(tmp_path):
    from petsam.apps.study import cases

    (tmp_path / "a").write_bytes("-gap_file h\u00f6he\n".encode("latin-1"))
    (tmp_path / "b").write_bytes("-gap_file h\u00e4he\n".encode("latin-1"))
    assert cases._content(str(tmp_path / "a")) != cases._content(str(tmp_path / "b"))


# ---------------------------------------------------------------- cards


CHANGING = (
    "SYSTEM|NGEN|NFILL|NCOPY|ELGEN|ELCOPY|FOUNDATION|EMBEDDED ELEMENT|CONNECTOR SECTION|FASTENER|SUBSTRUCTURE|"
    "MODEL CHANGE|RELEASE|ORIENTATION|TIE|EQUATION|MPC|TRANSFORM|PARAMETER|IMPERFECTION|INERTIA RELIEF|MATRIX INPUT"
).split("|")


@pytest.mark.parametrize("name", CHANGING)
def test_cards_that_change_a_body_are_rejected_with_a_cure(tmp_path, name):
    said = refused(tmp_path / "a.inp", BRICK + f"*{name.title()}, A=B\n1, 2\n", f"a.inp:20: *{name} is not supported: ")
    assert said.endswith(keywords.CURES[name])


@pytest.mark.parametrize(
    "name, meant",
    [("NSTE", "STEP or *NSET"), ("Boundry", "BOUNDARY"), ("SOLIDSECTON", "SOLID SECTION or *FLUID SECTION")],
)
def test_misspelt_keywords_are_rejected_with_the_nearest(tmp_path, name, meant):
    refused(tmp_path / "a.inp", BRICK + f"*{name}\n1\n", f"*{name.upper()} is not supported: is *{meant} meant?")


@pytest.mark.parametrize(
    "old, new, says",
    [
        ("*NODE, NSET=ALL", "*NODE, NSET=ALL, SYSTEM=C", "a.inp:1: SYSTEM=C of *NODE is not supported: use R"),
        ("*NODE, NSET=ALL", "*NODE, NSET=ALL, INPUT=x", "INPUT of *NODE is not supported: name the file by *INCLUDE"),
        ("ELSET=BODY\n1", "ELSET=BODY, OFFSET=5\n1", "a.inp:10: OFFSET of *ELEMENT is not supported"),
        ("ELSET=BODY\n1", "ELSE=BODY\n1", "ELSE of *ELEMENT is not supported: is ELSET meant?"),
        ("MATERIAL=STEEL\n*N", "MATERIAL=STEEL, COMPOSITE\n*N", "COMPOSITE of *SOLID SECTION is not supported"),
        ("*ELASTIC", "*ELASTIC, MODULI=LONG TERM", "MODULI of *ELASTIC is not supported"),
        ("NAME=TOP", "NAME=TOP, CROP", "CROP of *SURFACE is not supported"),
        ("*ELASTIC\n210e3, 0.3", "*ELASTIC\n210e3, , 0.3", "a.inp:14: an empty word in *ELASTIC is no number"),
        ("BODY, S2", "BODY, S2\n*CONTACT PAIR, INTERACTION=A, TIED\nA, B", "TIED of *CONTACT PAIR is not supported"),
        ("BODY, S2", "BODY, S2\n*STEP\n*STATIC\n*NODE\n9, 0, 0, 9", "*NODE is inside the step of"),
        ("BODY, S2", "BODY, S2\n*CLOAD\n1, 1, 1.", "*CLOAD is outside of all steps: begin one by *STEP"),
    ],
)
def test_parameters_that_change_a_body_are_rejected(tmp_path, old, new, says):
    assert old in BRICK
    refused(tmp_path / "a.inp", BRICK.replace(old, new, 1), says)


@pytest.mark.parametrize(
    "old, new, says",
    [
        ("NAME=Low, PART=Bar", "NAME=Low, PART=Bar, LIBRARY=job", "LIBRARY of *INSTANCE is not supported: remove"),
        ("NAME=Low, PART=Bar", "NAME=Low, PRAT=Bar", "PRAT of *INSTANCE is not supported: is PART meant?"),
        ("*PART, NAME=Bar", "*PART, NAME=Bar, INPUT=x", "INPUT of *PART is not supported: name the file by"),
    ],
)
def test_parameters_of_parts_and_instances_are_rejected(tmp_path, old, new, says):
    text = re.sub(re.escape(old), new, PARTS, count=1, flags=re.IGNORECASE)
    assert text != PARTS
    refused(tmp_path / "a.inp", text, says)


def test_cards_without_effect_are_passed_over(tmp_path):
    more = "".join(f"*{name}\n" for name in sorted(keywords.IGNORED)) + "*STEP\n*STATIC\n*OUTPUT, FIELD\n*END STEP\n"
    assert len(read_text(tmp_path / "a.inp", BRICK + more).mesh.nodes) == 8
    assert not set(keywords.IGNORED) & set(keywords.CURES) and not set(keywords.READ) & set(keywords.CURES)


def test_a_step_that_takes_elements_away_is_no_load_case_nor_is_a_later_one(compliance, tmp_path):  # noqa: F811
    load = ["*STEP", "*STATIC", "*CLOAD", "BOTTOM, 1, 1.", "*END STEP"]
    written(tmp_path / "b.inp", bricks(), *load, "*STEP", "*MODEL CHANGE, REMOVE", "1", "*END STEP", *load)
    words = ["--mesh", "b.inp", "--fixed", "BOTTOM", *ALWAYS, "--degree", "0"]
    compliance(*words, "-o", "f.h5")
    said = compliance(*words, "--case", "pull=3", check=3)[0]
    assert "b.inp:" in said and "*MODEL CHANGE before a load case is not supported: remove it" in said


@pytest.mark.parametrize(
    "held, says",
    [
        *((held, None) for held in ("ENCASTRE", "PINNED", "1, 3", "1, 6", "XSYMM\nBOTTOM, XASYMM")),
        *(("XSYMM", "in x only"), ("ZASYMM", "in x and y only"), ("1, 1", "in x only"), ("2, 6", "in y and z only")),
    ],
)
def test_supports_are_named_as_abaqus_names_them(tmp_path, held, says):
    written(tmp_path / "b.inp", bricks(), "*BOUNDARY", f"BOTTOM, {held}")
    words = ["--mesh", str(tmp_path / "b.inp"), "--fixed", "BOTTOM", *ALWAYS]
    doubts = model.Model(words[1], command.arguments(words).settings).doubts
    assert len(doubts) == bool(says) and (not says or f"{says}, and --fixed in x, y and z" in doubts[0]), doubts


@pytest.mark.parametrize(
    "line, says",
    [
        ("BOTTOM, ENCASTER", "ENCASTER is no type of support: is ENCASTRE meant?"),
        ("BOTOM, PINNED", "no node set BOTOM: is BOTTOM meant?"),
        ("BOTTOM, 1, 6, 0.5", "directions 1 to 6: use 1 to 3"),
        ("BOTTOM, 11", "directions 11 to 11: use 1 to 3"),
    ],
)
def test_supports_that_make_no_sense_are_rejected_by_file_and_line(compliance, tmp_path, line, says):  # noqa: F811
    written(tmp_path / "b.inp", bricks(), "*BOUNDARY", line)
    said = compliance("--mesh", "b.inp", "--fixed", "BOTTOM", *ALWAYS, check=3)[0]
    last = len((tmp_path / "b.inp").read_text().splitlines())
    assert f"b.inp:{last}: " in said and says in said


# ---------------------------------------------------------------- damage


@pytest.mark.parametrize(
    "old, new, says",
    [
        ("3, 1., 1., 0.", "3, 1., 1.e, 0.", "a.inp:4: 1.e in *NODE is no number"),
        ("3, 1., 1., 0.", "3, 1.", "a.inp:4: a node has 1 coordinate: give three"),
        ("3, 1., 1., 0.", "3, 1., 1., 0.\n3, 1., 1., 5.", "a.inp:5: node 3 is given twice"),
        ("1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 1, 2, 3, 4, 5, 6, 7", "a.inp:11: elements of type C3D8 need 8 nodes each"),
        ("1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 1, 2, 3, , 5, 6, 7, 8", "a.inp:11: an empty word in *ELEMENT is no integer"),
        ("1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 1, 2, 3, 4, 5, 6, 7, 9", "a.inp:11: node 9 of an element is not defined"),
        ("1, 1, 2, 3, 4, 5, 6, 7, 8", TURNED, "a.inp:11: element 1 is turned inside out or distorted: order"),
        ("BODY, S2", "BODY, S7", "a.inp:19: S7: element 1 of type C3D8 has the faces 1 to 6"),
        ("BODY, S2", "2, S2", "a.inp:19: *SURFACE: no element 2 in the deck"),
        ("1, 2, 3, 4\n", "1, 2, 3, 44\n", "a.inp:17: *NSET: no node 44 in the deck"),
        ("1, 2, 3, 4\n", "1, 2, 3, -4\n", "a.inp:17: *NSET: no node -4 in the deck"),
        ("1, 2, 3, 4\n", "1, 2, 3, BOTH\n", "a.inp:17: *NSET: no node set BOTH above this line"),
        ("210e3, 0.3", "210e3, 0.6", "a.inp:14: E = 210000, nu = 0.6"),
        ("*NODE, NSET=ALL\n", "1, 0., 0., 0.\n*NODE, NSET=ALL\n", "a.inp:1: 1, 0., 0., 0. stands before the first"),
        (
            "*NODE, NSET=ALL\n",
            "*NODE, NSET=ALL,\n",
            "a.inp:1: the keyword ends with a comma, but no parameter follows: remove it",
        ),
        ("*NSET, NSET=LOW\n1, 2, 3, 4\n", "*NSET, NSET=LOW, GENERATE\n4, 1\n", "a.inp:17: *NSET, GENERATE: expected"),
        ("*MATERIAL", "*ELEMENT, TYPE=C3D8, ELSET=B\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*MATERIAL", "first in"),
        ("*MATERIAL", "*ELEMENT, TYPE=C3D8, ELSET=BODY\n2, 1, 2, 3, 4, 5, 6, 7, 8\n*MATERIAL", "fills the same place"),
        (
            "*SURFACE",
            "*MATERIAL, NAME=A\n*ELASTIC\n1., 0.\n*SOLID SECTION, ELSET=BODY, MATERIAL=A\n*SURFACE",
            "another",
        ),
    ],
)
def test_damaged_lines_are_named(tmp_path, old, new, says):
    assert old in BRICK
    assert "a.inp:" in refused(tmp_path / "a.inp", BRICK.replace(old, new, 1), says)


@pytest.mark.parametrize(
    "order",
    [[3, 2, 1, 0, *range(4, 20)], [*range(8), 9, 8, *range(10, 20)], [*range(8), *range(16, 20), *range(8, 16)]],
)
def test_elements_with_nodes_in_a_wrong_order_are_named(tmp_path, order):
    """A twisted brick, whose Jacobian is positive at all Gauss points, and two orders of middle nodes."""
    body = bricks()
    body.blocks[0].nodes[0] = body.blocks[0].nodes[0, order]
    written(tmp_path / "a.inp", body)
    refused(tmp_path / "a.inp", (tmp_path / "a.inp").read_text(), "element 1 is turned inside out or distorted")


def test_middle_nodes_off_their_edges_are_named(tmp_path):
    body = bricks()
    body.nodes[body.blocks[0].nodes[0, 8], 1] -= 0.4
    written(tmp_path / "a.inp", body)
    refused(tmp_path / "a.inp", (tmp_path / "a.inp").read_text(), "element 1 has middle nodes far off its edges")


def test_bricks_with_two_corners_in_one_are_wedges(tmp_path):
    text = BRICK.replace("1, 1, 2, 3, 4, 5, 6, 7, 8", "1, 1, 2, 3, 3, 5, 6, 7, 7")
    assert len(read_text(tmp_path / "a.inp", text).mesh.nodes) == 6


def test_empty_coordinates_are_zero(tmp_path):
    text = BRICK.replace("7, 1., 1., 1.", "7, 1., 1., 1., ,").replace("5, 0., 0., 1.", "5, , , 1.")
    assert read_text(tmp_path / "a.inp", text).mesh.nodes[4].tolist() == [0.0, 0.0, 1.0]


def test_a_keyword_may_go_on_in_the_next_line(tmp_path):
    text = BRICK.replace("*ELEMENT, TYPE=C3D8, ELSET=BODY", "*ELEMENT, TYPE=C3D8,\n** a comment\n   ELSET=BODY")
    found = read_text(tmp_path / "a.inp", text)
    assert found.mesh.surfaces["TOP"] == [(1, 1)]


def test_a_mesh_that_is_in_the_deck_twice_is_rejected(tmp_path):
    """With numbers of its own, as a second instance in the same place, and by larger elements."""
    twice = PARTS.replace("10., 0., 2.\n10., 0., 0., 10., 0., 1., 90.\n", "")
    said = refused(tmp_path / "a.inp", twice, "fills the same place as")
    assert "a.inp:9: element Low.1 fills" in said and "a.inp:9: element High.1: remove" in said
    nodes = "*NODE\n" + "".join(f"{n}, {x}, 0.5, 0.5\n" for n, x in ((9, 0.5), (10, 5)))
    tets = "*ELEMENT, TYPE=C3D4, ELSET=BODY\n2, 1, 2, 4, 5\n"
    refused(
        tmp_path / "b.inp", BRICK.replace("*MATERIAL", nodes + tets + "*MATERIAL"), "element 2 fills the same place as"
    )


def test_long_ranges_and_sets_of_sets_take_no_memory(tmp_path):
    more = "*NSET, NSET=A, GENERATE\n1, 100000000000\n*NSET, NSET=B\n" + "A, A, A\n" * 9
    more += "".join(f"*NSET, NSET={one}\n{other}, {other}\n" for _ in range(60) for one, other in ("AB", "BA"))
    sets = read_text(tmp_path / "a.inp", BRICK + more).mesh.node_sets
    assert len(sets["A"]) == len(sets["B"]) == 8


@pytest.mark.parametrize("name, says", [("/dev/zero", "is not a regular file"), ("fifo", "is not a regular file")])
def test_files_that_are_none_are_not_included(tmp_path, name, says):
    os.mkfifo(tmp_path / "fifo")
    said = refused(tmp_path / "a.inp", BRICK + f"*INCLUDE, INPUT={name}\n", says)
    assert "a.inp:20: *INCLUDE: " in said


def test_decks_that_include_each_other_are_rejected(tmp_path):
    (tmp_path / "b.inp").write_text("*INCLUDE, INPUT=a.inp\n")
    refused(tmp_path / "a.inp", BRICK + "*INCLUDE, INPUT=b.inp\n", "b.inp:1: *INCLUDE: ")
    for k in range(8):
        (tmp_path / f"c{k}.inp").write_text(f"*INCLUDE, INPUT=c{k + 1}.inp\n" * 10)
    (tmp_path / "c8.inp").write_text("*HEADING\n")
    refused(tmp_path / "d.inp", "*INCLUDE, INPUT=c0.inp\n", "limits 10 files deep, 1000 in all")
    refused(tmp_path / "e.inp", "*INCLUDE, INPUT=none.inp\n", "e.inp:1: *INCLUDE: ")


def test_included_files_are_beside_the_first_file_or_the_including_one(tmp_path):
    """Those of one name in both places may be two decks."""
    for folder in ("one", "two"):
        (tmp_path / folder / "parts").mkdir(parents=True)
        (tmp_path / folder / "parts/a.inp").write_text("*INCLUDE, INPUT=parts/b.inp\n" * (folder == "one"))
    (tmp_path / "one/parts/b.inp").write_text(BRICK)
    assert len(read_text(tmp_path / "one/a.inp", "*INCLUDE, INPUT=parts/a.inp\n").mesh.nodes) == 8
    (tmp_path / "two/parts/a.inp").write_text("*INCLUDE, INPUT=b.inp\n")
    (tmp_path / "two/parts/b.inp").write_text(BRICK)
    assert len(read_text(tmp_path / "two/a.inp", "*INCLUDE, INPUT=parts/a.inp\n").mesh.nodes) == 8
    (tmp_path / "two/b.inp").write_text(BRICK.replace("210e3", "70e3"))
    said = refused(tmp_path / "two/a.inp", "*INCLUDE, INPUT=parts/a.inp\n", "both exist: rename one, or give")
    assert "parts/a.inp:1: *INCLUDE: " in said


def test_an_included_file_may_hold_data_lines(tmp_path):
    head, _, tail = BRICK.partition("5, 0.")
    (tmp_path / "nodes").write_text("5, 0." + tail[: tail.index("*ELEMENT")])
    text = head + "*INCLUDE, INPUT=nodes\n" + tail[tail.index("*ELEMENT") :]
    assert len(read_text(tmp_path / "a.inp", text).mesh.nodes) == 8


@needs_calculix
def test_instances_are_numbered_from_1_for_calculix(tmp_path):
    """CalculiX has arrays of the highest number."""
    body = mesh.grid_mesh([np.array([0.0, 1.0])] * 3, "C3D20")
    body.blocks[0].numbers = body.blocks[0].numbers + 1_000_000_000_000
    other = stiffness.assembled(body)
    assert abs(stiffness.of_calculix(body) - other).max() < 1e-9 * other.max()


@needs_calculix
def test_a_failure_of_calculix_names_the_other_stiffness(tmp_path, monkeypatch):
    body = mesh.grid_mesh([np.array([0.0, 1.0])] * 3, "C3D20")
    monkeypatch.setattr(stiffness, "model_lines", lambda _: ["*NODE", "x"])
    with pytest.raises(petsam.Error, match="use --stiffness own$"):
        stiffness.of_calculix(body)


# ---------------------------------------------------------------- units


def scaled(path, body, length, stress):
    """A deck of a body in other units."""
    body.nodes = body.nodes * length
    for block in body.blocks:
        block.young = block.young * stress
    written(path, body)


@pytest.mark.parametrize(
    "length, stress, units, patch, says",
    [
        (1.0, 70e3, "m", "2", "Young's modulus is 70000 Pa, and the mesh is 4 m long: a deck in mm and MPa has such"),
        (1.0, 2.1e11, "mm", "2mm", "Young's modulus is 2.1e+17 Pa, and the mesh is 0.004 m long: no solid is harder "
         "than 1.2e12 Pa: give the moduli of a deck in mm in MPa, or --units m if it is in m"),
        (1.0, 2.1e14, "m", "2", "no solid is harder than 1.2e12 Pa: give moduli in Pa"),
        (180.0, 2e3, "m", "360", "Young's modulus is 2000 Pa, and the mesh is 720 m long"),
    ],
)  # fmt: skip
def test_forgotten_units_are_found(compliance, tmp_path, length, stress, units, patch, says):  # noqa: F811
    scaled(tmp_path / "b.inp", bricks(), length, stress)
    words = ["--mesh", "b.inp", "--fixed", "BOTTOM", *ALWAYS, "--degree", "0", "--units", units, "--patch", patch]
    assert says in compliance(*words, check=3)[0]


@pytest.mark.parametrize(
    "length, stress, patch, says",
    [
        (1e-2, 2e4, "2e-2", "Young's modulus is 20000 Pa, and the mesh is 0.04 m long: give --units mm"),
        (1e-2, 210.0, "2e-2", "Young's modulus is 210 Pa, and the mesh is 0.04 m long: give the deck in MPa"),
        (1.0, 30e6, "2", "Young's modulus is 3e+07 Pa, and the mesh is 4 m long"),
        (10.0, 2e11, "20", "Young's modulus is 2e+11 Pa, and the mesh is 40 m long: give a deck in mm "
         "its moduli in MPa, and --units mm"),
        (1.0, 2e11, "2mm", "the patch is 0.002 m wide, and the elements of its surface are 1 m or more"),
    ],
)  # fmt: skip
def test_doubtful_units_are_told(compliance, tmp_path, length, stress, patch, says):  # noqa: F811
    scaled(tmp_path / "b.inp", bricks(), length, stress)
    words = ["--mesh", "b.inp", "--fixed", "BOTTOM", *ALWAYS, "--degree", "0", "--patch", patch, "-o", "f.h5"]
    compliance(*words, warning=says)


@pytest.mark.parametrize(
    "bolt, says",
    [
        ("8:1", "bolt B: its diameter is 8 m, and its washers are"),
        ("0.5mm:1", "bolt B: its diameter is 0.0005 m, and its washers are"),
        ("0.5:1e-6", "bolt B: its modulus is 1e-06 Pa, and its washers have"),
    ],
)
def test_bolts_in_other_units_are_rejected(pair, bolt, says):  # noqa: F811
    assert says in pair(*HELD, "--bolt", f"B=WASHER1,WASHER2:{bolt}", check=3)


def test_a_pair_in_other_units_is_rejected(pair, tmp_path):  # noqa: F811
    found = both()
    for block in found.blocks:
        block.young = block.young * 70e3
    write(tmp_path / "pair.inp", found)
    assert "m long: a deck in mm and MPa has such numbers: give --units mm" in pair(*HELD, check=3)


# ---------------------------------------------------------------- random decks


def test_random_decks_are_computed_or_rejected(tmp_path):
    """More of them: random_problems.py decks"""
    outcomes = []
    for seed in range(1, 31):
        folder = tmp_path / str(seed)
        folder.mkdir()
        outcomes.append(decks.trial(seed, folder))
    assert not [outcome.text for outcome in outcomes if outcome.fault]
