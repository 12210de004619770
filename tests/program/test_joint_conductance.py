"""Conductance of interfaces beside their stiffness: petsam-joint stiffness --conductivity, columns, cards for decks."""

import csv
import functools
import os
import shutil
import subprocess

import numpy as np
import pytest

import petsam
from petsam import joint
from petsam.joint import conductance
from support import bodies
from test_joint import STEEL, waves, write

pytestmark = pytest.mark.filterwarnings("ignore::petsam.contact.AdviceWarning")
CCX = os.environ.get("CCX", "ccx")
needs_calculix = pytest.mark.skipif(not shutil.which(CCX), reason=f"no CalculiX {CCX}: Debian package calculix-ccx")
PRESSURES = [4e6, 12e6]
PAIR = bodies(210e9, 0.3)
UNLIKE = bodies(210e9, 0.3, 70e9, 0.33)
AIR = (0.026, 0.37e-6)


@pytest.fixture
def command(joint_command):
    """command(*words, check=0): what petsam-joint stiffness prints; its complaint where it fails."""
    return functools.partial(joint_command, "stiffness")


def found(pair=PAIR, lam=(50.0, 20.0), **more):
    """The interface of a random surface that repeats itself, without friction."""
    given = dict(periodic=True, spacing=1e-5, normal_only=True, conductivity=lam, **pair)
    return joint.interface(waves(48, 3), PRESSURES, **{**given, **more})


def by_barber(stiffness, pair, lam):
    """Conductance per area that goes with a normal stiffness per area without friction."""
    names = [f"body{k}_{name}" for k in "12" for name in ("young", "poisson")]
    modulus = petsam.closed.effective_modulus(*(pair[name] for name in names))
    return 2 * stiffness / (modulus * (1 / lam[0] + 1 / lam[1]))


@pytest.mark.parametrize("pair, more", [
    (PAIR, {}), (UNLIKE, {}), (PAIR, dict(pressure_limit=0.5e9)), (PAIR, dict(normal_only=False, friction=0.3, steps=1))
], ids=["similar", "dissimilar", "hardness", "friction"])  # fmt: skip
def test_conductance_is_the_stiffness_of_unloading(pair, more):
    one = found(pair, **more)
    assert one.h == pytest.approx(by_barber(one.k_n, pair, (50, 20)), rel=1e-5)
    assert one.h_contact == pytest.approx(one.h, rel=1e-12) and not one.h_gap.any()
    assert one.resistance == pytest.approx(1 / one.h, rel=1e-12)


def test_stuck_shear_of_dissimilar_bodies_is_not_conductance():
    """Their normal stiffness is that of the coupled contact, by some tenths of a per cent too large."""
    stuck = found(UNLIKE, normal_only=False, friction=0.3, steps=1)
    ratio = by_barber(stuck.k_n, UNLIKE, (50, 20)) / stuck.h
    assert np.all(ratio > 1.002) and np.all(ratio < 1.02)
    assert stuck.h == pytest.approx(found(UNLIKE).h, rel=0.01)


def test_gas_raises_the_conductance_and_a_film_lowers_it():
    bare, gas, film = found(), found(gas=AIR), found(film=1e-6)
    assert np.all(gas.h > bare.h) and np.all(film.h < bare.h)
    assert gas.h == pytest.approx(gas.h_contact + gas.h_gap, rel=1e-12) and np.all(gas.h_gap > 0)
    assert gas.h_gap == pytest.approx(AIR[0] / (gas.separation + AIR[1]), rel=0.05)  # of a flat gap as wide
    series = bare.resistance + 1e-6 / bare.area  # the least, and nearly the solution
    assert np.all(film.resistance > series * (1 - 1e-6)) and np.all(film.resistance < 1.04 * series)
    assert np.array_equal(found(film=0.0).h, bare.h)


def test_columns_have_the_scatter_of_windows_and_units():
    given = dict(spacing=1e-5, normal_only=True, gas=AIR, conductivity=(50, 50), **PAIR)
    heat, current = (joint.interface(waves(48, 3), PRESSURES, electrical=on, **given) for on in (False, True))
    units = {column.name: column.unit for column in heat.table()}
    assert [units[name] for name in conductance.COLUMNS] == ["W/(m2 K)"] * 3 + ["m2 K/W"]
    assert all(units[f"{name}_spread"] == units[name] for name in conductance.COLUMNS)
    units = {column.name: column.unit for column in current.table()}
    assert [units[name] for name in conductance.COLUMNS] == ["S/m2"] * 3 + ["Ohm m2"]
    assert np.array_equal(heat.h, current.h) and heat.resistance == pytest.approx(1 / heat.h)
    part = heat.spread["h"] / heat.h
    assert np.all(part > 0) and np.all(part < heat.spread["k_n"] / heat.k_n)  # gas does not scatter
    assert heat.spread["resistance"] == pytest.approx(part * heat.resistance)
    assert "h/(W/(m2 K))" in heat.lines()[0] and "h_gap/(S/m2)" in current.lines()[0]


@pytest.mark.parametrize("given, says", [
    (dict(film=1e-6), "film: is for the conductance"), (dict(gas=AIR), "gas: is for the conductance"),
    (dict(electrical=True), "electrical: is for"), (dict(conductivity=50.0), "conductivity 50.0: expected two numbers"),
    (dict(conductivity=(50, 0)), "expected two numbers above 0"),
    (dict(conductivity=(50, 50), film=-1), "film -1: expected a resistance"),
    (dict(conductivity=(50, 50), gas=(0, 1e-6)), "gas .* expected a conductivity above 0"),
    (dict(conductivity=(50, np.inf)), "expected two numbers"),
    (dict(conductivity=(50, 50), body1_layer_young=1e9), "body1_layer_young: the flux through layers"),
], ids=str)  # fmt: skip
def test_arguments_are_refused_before_the_computation(given, says, monkeypatch):
    monkeypatch.setattr(petsam.Contact, "try_step", None)
    with pytest.raises(petsam.Error, match=says):
        joint.interface(waves(24, 5), [1e7], spacing=1e-5, normal_only=True, **given, **PAIR)


@pytest.mark.parametrize("words, says", [
    (("--gas", "0.026,0.37um"), "--gas: is for the conductance: give --conductivity"),
    (("--film", "1e-6"), "--film: is for the conductance"), (("--electrical",), "--electrical: is for the conductance"),
    (("--conductivity", "50"), "--conductivity: 50: expected those of both bodies"),
    (("--conductivity", "50,-1"), "--conductivity: 50,-1: expected"),
    (("--conductivity", "50,50", "--film=-1"), "--film: -1: expected a number, 0 or more"),
    (("--conductivity", "50,50", "--gas", "0.026"), "--gas: 0.026: expected LAM,M"),
    (("--conductivity", "50,50", "--gas", "0.026,1Pa"), "--gas: 0.026,1Pa: expected LAM,M"),
], ids=str)  # fmt: skip
def test_options_are_refused_in_one_line(command, tmp_path, words, says):
    write(tmp_path / "a.h5", "separation", waves(24, 5))
    said = command("a.h5", "--pressure", "10MPa", *STEEL, "--normal-only", *words, check=2)
    assert says in said and said.count("\n") == 1


def rows(path, card):
    """Numbers of the lines below a card of a deck."""
    lines = path.read_text().splitlines()
    begin = lines.index(card) + 1
    below = [line.startswith("*") for line in lines[begin:]] + [True]
    return np.array([line.split(",") for line in lines[begin : begin + below.index(True)]], dtype=float)


def test_the_command_writes_columns_and_cards(command, tmp_path):
    write(tmp_path / "a.h5", "separation", waves(48, 3))
    words = ("a.h5", "--pressure", "4MPa,12MPa", "--periodic", *STEEL, "--conductivity", "50,20", "-o", "i")
    words += ("--gas", "0.026,0.37um", "--film", 1e-7)
    one = found(gas=AIR, film=1e-7)
    assert command(*words, "--normal-only") == "\n".join(one.lines()) + "\n"
    with open("i.csv", newline="") as file:
        assert [float(row["h [W/(m2 K)]"]) for row in csv.DictReader(file)] == list(one.h)
    assert sorted(path.name for path in tmp_path.glob("i*")) == ["i-calculix.inp", "i.csv", "i.inp", "i.png"]
    expected = [
        (1e-3 * one.h_gap[0], 0.0), (1e-3 * (one.h_gap[0] + 0.1**0.95 * one.h_contact[0]), 0.4),
        (1e-3 * one.h[0], 4.0), (1e-3 * one.h[1], 12.0),
    ]  # fmt: skip
    assert rows(tmp_path / "i.inp", "*GAP CONDUCTANCE, PRESSURE") == pytest.approx(np.array(expected), rel=1e-5)
    calculix = rows(tmp_path / "i-calculix.inp", "*GAP CONDUCTANCE")
    assert calculix[:, :2] == pytest.approx(np.array(expected), rel=1e-5) and np.ptp(calculix[:, 2]) == 0
    assert "*FRICTION" not in (tmp_path / "i.inp").read_text()
    assert "a film of 1e-07 m2 K/W" in (tmp_path / "i.inp").read_text()
    for path in tmp_path.glob("i*.inp"):
        path.unlink()
    command(*words, "--friction", 0.3, "--steps", 1, "--electrical")
    assert not (tmp_path / "i-calculix.inp").exists() and "*FRICTION, ELASTIC" in (tmp_path / "i.inp").read_text()
    electrical = rows(tmp_path / "i.inp", "*GAP ELECTRICAL CONDUCTANCE, PRESSURE")
    assert electrical[2:] == pytest.approx(np.array(expected[2:]) * [1e-3, 1], rel=1e-5)
    assert rows(tmp_path / "i.inp", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR").shape == (3, 2)


def test_a_card_without_gas_begins_at_0_and_needs_heat(tmp_path):
    one = found()
    one.to_abaqus(tmp_path / "a.inp")
    assert rows(tmp_path / "a.inp", "*GAP CONDUCTANCE, PRESSURE")[0].tolist() == [0.0, 0.0]
    for other in (found(electrical=True), joint.of_interface(waves(24, 5), 1e-5, [1e7], normal_only=True, **PAIR)):
        with pytest.raises(petsam.Error, match="to_calculix: needs a thermal conductance"):
            other.to_calculix(tmp_path / "b.inp")


def test_a_hardness_says_which_stiffness_is_measured_how(command, tmp_path):
    write(tmp_path / "a.h5", "separation", waves(48, 11))
    words = ("a.h5", "--pressure", "30MPa", "--normal-only", "--periodic", *STEEL, "--conductivity", "50,50")
    said = command(*words, "--hardness", "0.2GPa").splitlines()
    assert said[2].startswith("k_n of loading is the stiffness that image correlation measures; k_n of unloading")
    assert "ultrasound" in said[2] and len(command(*words).splitlines()) == 2
    unloading, loading, h = (float(said[1].split()[k]) for k in (1, 3, 4))
    assert loading < 0.9 * unloading
    assert h == pytest.approx(by_barber(1e9 * unloading, PAIR, (50, 50)), rel=1e-3)


BLOCKS = """*INCLUDE, INPUT=card.inp
*NODE, NSET=ALL
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
11, 0., 0., 1.
12, 1., 0., 1.
13, 1., 1., 1.
14, 0., 1., 1.
15, 0., 0., 2.
16, 1., 0., 2.
17, 1., 1., 2.
18, 0., 1., 2.
*NSET, NSET=LOW
1, 2, 3, 4
*NSET, NSET=HIGH
15, 16, 17, 18
*ELEMENT, TYPE=C3D8, ELSET=BLOCKS
1, 1, 2, 3, 4, 5, 6, 7, 8
2, 11, 12, 13, 14, 15, 16, 17, 18
*SURFACE, NAME=UP
1, S2
*SURFACE, NAME=DOWN
2, S1
*MATERIAL, NAME=STEEL
*ELASTIC
210000., 0.3
*CONDUCTIVITY
50.
*DENSITY
7.8E-9
*SPECIFIC HEAT
4.5E8
*SOLID SECTION, ELSET=BLOCKS, MATERIAL=STEEL
*CONTACT PAIR, INTERACTION=INTERFACE, TYPE=SURFACE TO SURFACE
UP, DOWN
*INITIAL CONDITIONS, TYPE=TEMPERATURE
ALL, 0.
*STEP
*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE
1., 1.
*BOUNDARY
ALL, 1, 2
LOW, 3, 3
HIGH, 3, 3, {push}
LOW, 11, 11, 100.
HIGH, 11, 11, 0.
*NODE PRINT, NSET=LOW, TOTALS=ONLY
RFL, RF
*END STEP
"""


@needs_calculix
@pytest.mark.parametrize("gas", [None, AIR], ids=["bare", "air"])
def test_calculix_takes_the_conductance_from_the_card(tmp_path, gas):
    """Two steel cubes of 1 mm between 100 K and 0 K, pushed together: the flux is that of three resistances in series,
    of which the contact's is the card's at the pressure that CalculiX finds."""
    one = found(lam=(50.0, 50.0), gas=gas)
    one.to_calculix(tmp_path / "card.inp")
    (tmp_path / "blocks.inp").write_text(BLOCKS.format(push=-1.9e-4))
    done = subprocess.run([CCX, "blocks"], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    totals = [line.split() for line in (tmp_path / "blocks.dat").read_text().splitlines() if line.strip()]
    assert len(totals) == 4, done.stdout
    numbers = {len(words): [float(word) for word in words] for words in (totals[1], totals[3])}
    heat, pressure = numbers[1][0], numbers[3][2]
    assert 4.0 < pressure < 12.0
    card = rows(tmp_path / "card.inp", "*GAP CONDUCTANCE")
    h = np.interp(pressure, card[:, 1], card[:, 0])
    assert heat == pytest.approx(100.0 / (2 / 50.0 + 1 / h), rel=1e-4)


def test_a_picture_has_the_conductances_of_several_interfaces():
    several = [found(), found(gas=AIR), found(gas=AIR, film=1e-7)]
    axes = petsam.plot.conductance(*several).axes[0]
    labels = ["spots alone", "gas in the gap", "film on the spots and gas in the gap"]
    assert axes.get_legend_handles_labels()[1] == labels and axes.get_ylabel().endswith("W/(m² K)")
    for several, says in (
        ((), "expected interfaces with a conductance"),
        ((found(lam=None),), "expected interfaces with a conductance"),
        ((found(), found(electrical=True)), "different units"),
    ):
        with pytest.raises(petsam.Error, match=says):
            petsam.plot.conductance(*several)
