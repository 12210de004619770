"""Materials by name: the table of petsam, its use in options and in the commands, and the copy of it in Python."""

import json
import re
import subprocess

import h5py
import numpy as np
import pytest

import conftest
import petsam
import petsam as package
import support
from petsam import joint, materials
from petsam.apps.compliance import command as compliance_command
from petsam.apps.fatigue import materials as constants
from petsam.core import declared, options, units, words
from support import SPHERE, assert_same, bodies
from test_joint import waves

TITANIUM = bodies(210e9, 0.3, 113.8e9, 0.342)
NAMED = {**SPHERE, **dict.fromkeys(TITANIUM), "load_tx": 60.0, "grid_n": 32}


def named(*names, **more):
    return {**NAMED, **dict(zip(("body1", "body2"), names)), **more}


@pytest.fixture(scope="module")
def described():
    done = subprocess.run([conftest.PROGRAM, "-help", "json"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def head(done):
    """The lines of the bodies in the head of a run."""
    return re.findall(r"^  body (\d) +(.*)$", done.stdout, re.M)


@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_a_named_body_is_that_of_its_moduli(solve, ranks):
    found = solve(named("steel", "Ti-6Al-4V"), ranks=ranks)
    assert_same(found, solve({**NAMED, **TITANIUM}, ranks=ranks), 0)
    assert head(found.run) == [("1", "steel: E 210 GPa, nu 0.3"), ("2", "Ti-6Al-4V: E 113.8 GPa, nu 0.342")]


def test_results_hold_the_numbers_alone(petsam, tmp_path):
    petsam(named("steel", "titanium", output="a.h5"))
    petsam({**NAMED, **TITANIUM}, dict(output="b.h5"))
    with h5py.File(tmp_path / "a.h5") as one, h5py.File(tmp_path / "b.h5") as other:
        assert set(one.attrs) == set(other.attrs)
        assert {name: one.attrs[name] for name in TITANIUM} == TITANIUM
        assert "body1" not in one.attrs


def test_a_run_by_name_goes_on_from_one_by_moduli(petsam):
    more = dict(output="c.h5", checkpoint="state.h5", checkpoint_every=1, steps=3, overwrite=True)
    petsam({**NAMED, **TITANIUM}, more)
    petsam(named("steel", "titanium"), dict(more, restart="state.h5.1"))
    err = petsam(named("steel", "brass"), dict(more, restart="state.h5.1"), check=2).stderr
    assert "body2_young" in err


@pytest.mark.parametrize("name", ["ti6al4v", "TI-6AL-4V", "Ti 6Al 4V", "ti_6al_4v", "Titanium", "titanium alloy"])
def test_spellings_are_one_name(petsam, name):
    assert head(petsam(named("STEEL", name, dry_run=True))) == [
        ("1", "steel: E 210 GPa, nu 0.3"),
        ("2", "Ti-6Al-4V: E 113.8 GPa, nu 0.342"),
    ]
    assert materials.find(name).name == "Ti-6Al-4V"


def test_an_option_goes_before_the_name_and_the_head_says_so(solve):
    found = solve(named("steel", "titanium", body1_young=200e9, body2_poisson=0.35))
    assert head(found.run) == [
        ("1", "steel: E 200 GPa by -body1_young, not 210 GPa, nu 0.3"),
        ("2", "Ti-6Al-4V: E 113.8 GPa, nu 0.35 by -body2_poisson, not 0.342"),
    ]
    assert_same(found, solve({**NAMED, **bodies(200e9, 0.3, 113.8e9, 0.35)}), 0)
    assert not head(solve({**NAMED, **TITANIUM}).run)


def test_layers_by_name(solve):
    coat = dict(body2_layer_thickness=(20e-6, 30e-6))
    found = solve(named("steel", "steel", body2_layers="Gold,copper", **coat))
    gold, copper = materials.find("gold"), materials.find("copper")
    lists = dict(
        body2_layer_young=(gold.young, copper.young), body2_layer_poisson=(gold.poisson, copper.poisson), **coat
    )
    assert_same(found, solve({**NAMED, **bodies()}, lists), 0)
    layers = "gold: E 78 GPa, nu 0.44, copper: E 130 GPa, nu 0.343"
    assert head(found.run)[1] == ("2", f"steel: E 210 GPa, nu 0.3; layers {layers}")
    own = dict(lists, body2_layer_young=(50e9, 60e9))
    given = named("steel", None, **bodies(), body2_layers="gold,copper", **coat)
    found = solve({**given, "body2_layer_young": (50e9, 60e9)})
    assert_same(found, solve({**NAMED, **bodies()}, own), 0)
    assert head(found.run)[1][1].startswith("layers gold: E 50 GPa by -body2_layer_young, not 78 GPa, nu 0.44, copper")


# ---------------------------------------------------------------- the table


def test_python_has_the_table_of_petsam(described):
    names = [one["name"] for one in described["constants"]]
    assert names == list(materials.CONSTANTS) and names[:2] == ["young", "poisson"]
    fields = list(materials.Material._fields)
    assert [name.replace("yield_stress", "yield") for name in fields[2:-1]] == names
    assert list(materials.TABLE) == [one["name"] for one in described["materials"]]
    for one in described["materials"]:
        row = materials.TABLE[one["name"]]
        assert list(row[2:-1]) == one["values"] and row.source == one["source"]
        assert ", ".join(row.aliases) == one["aliases"]
    assert {name: unit for name, (unit, _) in declared.CONSTANTS.items()} == {
        one["name"]: one["unit"] for one in described["constants"]
    }


def test_the_table_is_one_of_solids():
    names = [materials.plain(name) for row in materials.TABLE.values() for name in (row.name, *row.aliases)]
    assert len(names) == len(set(names)) and not any("," in name for name in names)
    for row in materials.TABLE.values():
        assert 50e9 < row.young < 700e9 and 0.2 < row.poisson < 0.45 and len(row.source) > 20, row.name
        ranges = dict(
            density=(2e3, 2e4), conductivity=(1, 500), specific_heat=(100, 1100), expansion=(1e-6, 3e-5),
            yield_stress=(1e8, 2e9), sigma_f=(5e8, 3e9), b=(-0.2, -0.05), epsilon_f=(0.1, 2), c=(-1, -0.4),
        )  # fmt: skip
        for name, (low, high) in ranges.items():
            value = getattr(row, name)
            assert value is None or low < value < high, (row.name, name)


def test_the_help_lists_the_materials(petsam):
    out = petsam("-help", "materials").stdout
    assert "\nTi-6Al-4V (titanium, " in out and "density 7850 kg/m3" in out and "nan" not in out
    assert all(f"\n{name} (" in out and row.source in out for name, row in materials.TABLE.items())


def test_the_manual_has_the_table():
    text = (support.ROOT / "examples" / "manual" / "OPTIONS.md").read_text()
    table = text.partition("<!-- materials -->\n")[2].partition("<!-- end -->")[0].splitlines()[2:]
    assert len(table) == len(materials.TABLE)
    for line, row in zip(table, materials.TABLE.values()):
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        assert cells[0] == f"`{row.name}`" and float(cells[2]) * 1e9 == pytest.approx(row.young)
        assert float(cells[3]) == row.poisson


@pytest.mark.parametrize("name, nearest", [("stel", "steel"), ("inconel", "Inconel-718"), ("aluminum7075", "7075-T6")])
def test_an_unknown_name_is_told_with_the_nearest(name, nearest):
    with pytest.raises(package.Error, match=f"{name} is no material: is {nearest} meant.*, gold"):
        materials.find(name)
    assert not materials.has(name)


@pytest.mark.parametrize("name, row", [
    ("cast iron", "grey-cast-iron"), ("Grey cast iron", "grey-cast-iron"), ("Ni", "nickel"), ("nickel", "nickel"),
    ("alloy 718", "Inconel-718"), ("hardmetal", "WC-Co"), ("aluminum", "aluminium"), ("Ti64", "Ti-6Al-4V"),
])  # fmt: skip
def test_other_names_mean_one_material(name, row):
    assert materials.find(name).name == row


@pytest.mark.parametrize("name", ["nickel alloy", "iron", "WC", "ductile iron"])
def test_a_name_of_several_materials_is_none(name):
    assert not materials.has(name)


# ---------------------------------------------------------------- Python and the commands


def test_runs_and_contacts_take_names():
    given = {name: value for name, value in NAMED.items() if value is not None and name != "load_tx"}
    found = package.run(**given, body1="steel", body2="Ti-6Al-4V")
    other = package.run(**given, **TITANIUM)
    assert found.history["contact_area"].tolist() == other.history["contact_area"].tolist()
    del given["load_n"], given["output_fields"]
    pressures = []
    for both in dict(body1="steel", body2="titanium"), TITANIUM:
        with package.Contact(**given, **both) as contact:
            contact.try_step(load_n=1000)
            pressures.append(contact.field("pressure"))
    assert np.array_equal(*pressures)
    with pytest.raises(package.ContactError, match="-body1 stel: no such material: is steel meant"):
        package.Contact(**given, body1="stel", body2="steel")


@pytest.mark.parametrize("text", ["113.8GPa,0.342", "113800e6,.342", "113800MPa,0.342"])
def test_a_body_by_its_two_numbers_is_that_of_its_moduli(text):
    given = {name: value for name, value in NAMED.items() if value is not None and name != "load_tx"}
    found = package.run(**given, body1="210GPa,0.3", body2=text)
    other = package.run(**given, **TITANIUM)
    assert found.history["contact_area"].tolist() == other.history["contact_area"].tolist()
    assert materials.resolved(dict(body2=text)) == dict(body2_young=pytest.approx(113.8e9), body2_poisson=0.342)
    for poisson in (0.5, -0.2):
        bodies = dict(body1=f"90GPa,{poisson}"), dict(body1_young=90e9, body1_poisson=poisson)
        areas = [package.run(**given, **one, body2="steel").history["contact_area"][-1] for one in bodies]
        assert areas[0] == areas[1] > 0 and materials.elastic(bodies[0]["body1"]) == (90e9, poisson)
    del given["load_n"], given["output_fields"]
    for wrong in ("210GPa", "210GPa,0.3,1"):
        with pytest.raises(package.ContactError, match=f"-body1 {wrong}: .*or Young's modulus and Poisson's ratio"):
            package.Contact(**{**given, "body1": wrong, "body2": "steel"})
    ranges = dict(poisson="a number above -1 and at most 0.5", young="a number > 0 or inf")
    for wrong, name, value in (("1GPa,0.6", "poisson", "0.6"), ("1GPa,-1", "poisson", "-1"), ("-1,0.3", "young", "-1")):
        with pytest.raises(package.ContactError, match=f"-body1_{name} {value}: expected {ranges[name]}"):
            package.Contact(**{**given, "body1": wrong, "body2": "steel"})


def test_forces_in_units_with_a_factor_are_those_in_newtons():
    given = {name: value for name, value in NAMED.items() if value is not None and name not in ("load_tx", "load_n")}
    for text, force in (("10kgf", 98.0665), ("20lbf", 88.96443230521), ("5e7uN", 50.0), ("6e10nN", 60.0)):
        found = package.run(**given, body1="steel", body2="steel", load_n=text)
        assert found.history["load_n"][-1] == pytest.approx(force, rel=1e-12)
        assert units.size(text.lstrip("0123456789e"), "N") * float(re.match("[0-9e]+", text)[0]) == pytest.approx(force)


def test_options_by_name_become_moduli_unless_they_are_given():
    found = materials.resolved(dict(body1="steel", body2="brass", body2_young=1e11, friction=0.3))
    assert found == dict(body1_young=210e9, body1_poisson=0.3, body2_young=1e11, body2_poisson=0.35, friction=0.3)
    assert options.words(found) and materials.resolved({"body1": None}) == {}


@pytest.mark.filterwarnings("ignore::petsam.contact.AdviceWarning")
def test_interfaces_take_names(joint_command):
    field = waves(24, 5)
    one = joint.interface(field, [10e6], body1="steel", body2="Inconel 718", normal_only=True, spacing=1e-5)
    other = joint.interface(field, [10e6], **bodies(210e9, 0.3, 200e9, 0.29), normal_only=True, spacing=1e-5)
    assert one.k_n == pytest.approx(other.k_n, rel=0)
    said = joint_command("stiffness", "a.h5", "--body1", "stel", check=2)
    assert "--body1: stel is no material: is steel meant?" in said


@pytest.mark.parametrize("text, both", [
    ("steel", (210e9, 0.3)), ("nickel", (207e9, 0.31)), ("210GPa,0.3", (210e9, 0.3)), ("inf,0", (np.inf, 0.0)),
])  # fmt: skip
def test_a_material_of_a_joint_is_a_name_or_its_moduli(text, both):
    assert materials.elastic(text) == both


def test_what_is_neither_a_name_nor_moduli_is_refused():
    with pytest.raises(
        words.WordError, match="5,9: expected steel, 100Cr6, .*, or Young's modulus.*above -1, up to 0.5"
    ):
        materials.elastic("5,9")
    with pytest.raises(words.WordError, match="210GPa: expected steel"):
        materials.elastic("210GPa")


def test_the_shape_of_a_fit_takes_names(tmp_path):
    shape = "-gap_type sphere -gap_radius1 0.02 -gap_radius2 inf "
    (tmp_path / "named.opts").write_text(shape + "-body1 steel -body2 Ti-6Al-4V -body2_young 110GPa\n")
    (tmp_path / "moduli.opts").write_text(
        shape + "-body1_young 210e9 -body1_poisson 0.3 -body2_young 110e9 -body2_poisson 0.342\n"
    )
    one, other = (petsam.fit.of_shape(tmp_path / f"{name}.opts", 1000.0) for name in ("named", "moduli"))
    assert np.array_equal(one.displacement, other.displacement) and "closed form" in one.text


def test_fatigue_constants_by_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found = constants.named("7075-t6")
    assert found == dict(sigma_f=1466e6, b=-0.143, epsilon_f=0.262, c=-0.619)
    for name, value in found.items():
        assert constants.checked(name, value) == value
    assert constants.named("titanium") == dict(sigma_f=2030e6, b=-0.104)  # none of its ductility
    with pytest.raises(package.Error, match="100Cr6: the table has no fatigue constants of it: .* of Ti-6Al-4V"):
        constants.named("bearing steel")
    with pytest.raises(package.Error, match="is Ti-6Al-4V meant"):
        constants.named("Ti6Al4")
    with pytest.raises(package.MissingFile):
        constants.named("steel.yaml")
    (tmp_path / "7075").write_text("sigma_f: 1GPa\n")  # a file of that name goes before the table
    assert constants.named("7075") == dict(sigma_f=1e9)


def test_a_mesh_takes_names(capsys):
    given = "--mesh a.msh --contact TOP --fixed BASE --patch 1mm".split()

    def of_body(*more):
        return compliance_command.arguments([*given, *more]).settings.materials

    assert of_body("--material", "steel") == (210e9, 0.3, 7850.0)
    assert of_body("--material", "steel", "--young", "200GPa") == (200e9, 0.3, 7850.0)
    assert of_body("--material", "A=steel", "--material", "B=titanium", "--young", "B=110GPa") == (
        {"A": 210e9, "B": 110e9},
        {"A": 0.3, "B": 0.342},
        {"A": 7850.0, "B": 4430.0},
    )
    assert of_body() is None
    with pytest.raises(SystemExit):
        of_body("--material", "stel")
    assert "--material: stel is no material: is steel meant?" in capsys.readouterr().err
