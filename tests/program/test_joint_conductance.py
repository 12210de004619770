"""Conductance of interfaces beside their stiffness: petsam-joint stiffness --conductivity, columns, cards for decks."""

import csv
import functools
import os
import shutil
import subprocess

import h5py
import numpy as np
import pytest

import petsam
from petsam import joint
from petsam.apps.joint import conductance
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


def test_a_film_that_varies_is_cut_into_the_windows():
    """As of five fields that repeat themselves; where it is the same everywhere, as of a number."""
    separation, film = waves(48, 3), 1e-6 * np.random.default_rng(1).random((48, 48))
    given = dict(spacing=1e-5, normal_only=True, conductivity=(50, 50), **PAIR)
    one = joint.interface(separation, PRESSURES, film=film, **given)
    parts = []
    for j, i in ((0, 0), (0, 24), (24, 0), (24, 24), (12, 12)):
        field, own = (np.pad(all[j : j + 24, i : i + 24], [(0, 24)] * 2, "symmetric") for all in (separation, film))
        parts.append(joint.interface(field, PRESSURES, film=own, periodic=True, **given).h)
    assert one.h == pytest.approx(np.mean(parts, axis=0), rel=1e-12)
    assert np.array_equal(found(film=np.full((48, 48), 1e-6)).h, found(film=1e-6).h)
    assert np.all(found().h > found(film=film).h) and np.all(found(film=film).h > found(film=1e-6).h)


@pytest.mark.parametrize("kind", ["h5", "txt", "npy"])
def test_a_film_from_a_file_has_its_first_row_at_the_smallest_y(tmp_path, command, kind):
    film = 1e-6 * np.random.default_rng(1).random((48, 48)).round(6)
    name = f"film.{kind}"
    if kind == "h5":
        with h5py.File(tmp_path / name, "w") as file:
            file["film"] = film[::-1]
            file["film"].attrs["units"] = "m2 K/W"
            for letter, axis in (("x", np.arange(48.0)), ("y", -np.arange(48.0))):
                file[letter] = axis
                file[letter].attrs["units"] = "um"
    else:
        np.save(tmp_path / name, film) if kind == "npy" else np.savetxt(tmp_path / name, film)
    write(tmp_path / "a.h5", "separation", waves(48, 3))
    said = command("a.h5", "--pressure", "4MPa,12MPa", "--periodic", *STEEL, "--normal-only", "--conductivity", "50,20",
                   "--film", name)  # fmt: skip
    assert said == "\n".join(found(film=film).lines()) + "\n"
    assert found(film=film).lines() != found(film=film[::-1]).lines()
    np.savetxt(tmp_path / "film.txt", -film)
    with pytest.raises(petsam.Error, match="film.txt: .* of 2304 values are no resistance >= 0"):
        found(film=tmp_path / "film.txt")


def test_materials_have_their_conductivities(command, tmp_path):
    assert found(lam=("steel", "Ti 6Al 4V")).lines() == found(lam=(53.3, 6.7)).lines()
    write(tmp_path / "a.h5", "separation", waves(48, 3))
    words = ("a.h5", "--pressure", "4MPa,12MPa", "--periodic", *STEEL, "--normal-only", "--conductivity")
    assert command(*words, "steel,20") == "\n".join(found(lam=(53.3, 20.0)).lines()) + "\n"


def test_layers_change_the_constriction_alone(command, tmp_path):
    """One of the body's own conductivity nothing; a thick one is the body; gold raises h, and the card says so."""
    bare, gold = found(), found(layers1=[(5e-6, 317.0)])
    assert found(layers1=[(5e-6, 50.0)], layers2=[(1e-6, 20.0)]).h == pytest.approx(bare.h, rel=1e-9)
    assert found(layers2=[(1.0, 50.0)]).h == pytest.approx(found(lam=(50.0, 50.0)).h, rel=1e-6)
    assert np.all(gold.h > 1.05 * bare.h) and np.all(gold.h < found(lam=(317.0, 20.0)).h)
    write(tmp_path / "a.h5", "separation", waves(48, 3))
    words = ("a.h5", "--pressure", "4MPa,12MPa", "--periodic", *STEEL, "--normal-only", "--conductivity", "50,20")
    two = found(layers1=[(5e-6, 317.0)], layers2=[(1e-6, 90.0), (2e-6, 0.2)])
    said = command(*words, "--layer1", "5um,gold", "--layer2", "1um,90", "--layer2", "2um,0.2", "-o", "i")
    assert said.splitlines()[: len(two.lines())] == two.lines()
    text = (tmp_path / "i.inp").read_text()
    assert "5e-06 m of 317 W/(m K) on body 1, 1e-06 m of 90 W/(m K) on body 2, 2e-06 m of 0.2" in text
    assert "thickness (1/lam of the layer" in text
    elastic = dict(body1_layer_young=80e9, body1_layer_poisson=0.42, body1_layer_thickness=5e-6)
    soft = found(layers1=[(5e-6, 317.0)], **elastic)
    assert np.all(soft.h > 1.01 * gold.h) and np.all(found(layers1=(), **elastic).h < soft.h)


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
    assert "h/(W/(m2 K))" in heat.lines()[1] and "h_gap/(S/m2)" in current.lines()[1]


@pytest.mark.parametrize("given, says", [
    (dict(film=1e-6), "film: is for the conductance"), (dict(gas=AIR), "gas: is for the conductance"),
    (dict(electrical=True), "electrical: is for"), (dict(conductivity=50.0), "conductivity 50.0: expected two numbers"),
    (dict(conductivity=(50, 0)), "expected two numbers above 0"),
    (dict(conductivity=(50, 50), film=-1), "film -1: expected a resistance"),
    (dict(conductivity=(50, 50), gas=(0, 1e-6)), "gas .* expected a conductivity above 0"),
    (dict(conductivity=(50, np.inf)), "expected two numbers"),
    (dict(conductivity=(None, 50)), "conductivity .None, 50.: expected two numbers"),
    (dict(conductivity=(50, 50), layers1=[(1e-6,)]), "expected pairs"), (dict(conductivity="steel"), "expected two"),
    (dict(conductivity=("steel", "steal")), "steal is no material: is steel meant"),
    (dict(conductivity=(50, "alumnia")), "alumnia is no material"),
    (dict(conductivity=(50, "Si3N4")), "Si3N4: its conductivity is not known: .* it is of steel, 304"),
    (dict(conductivity=(1e7, "steel"), electrical=True), "conductivity steel: give the conductivity for a current"),
    (dict(conductivity=(1e7, 1e7), layers1=[(1e-6, "gold")], electrical=True), "layers1 gold: give the conductivity"),
    (dict(conductivity=(50, 50), body1_layer_young=1e9), "body1_layer_young: give also how the layers conduct"),
    (dict(layers2=[(1e-6, 300)]), "layers2: is for the conductance"),
    (dict(conductivity=(50, 50), layers2=[(1e-6, 0)]), "expected finite numbers > 0"),
    (dict(conductivity=(50, 50), film=np.ones((24, 23))), "film: has 23 x 24 points .* the surface 24 x 24"),
    (dict(conductivity=(50, 50), film=np.full((24, 24), np.nan)), "film: 576 of 576 values are no resistance"),
    (dict(conductivity=(50, 50), film="no.h5"), "no.h5"),
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
    (("--conductivity", "steel,steal"), "--conductivity: steel,steal: expected those of both bodies, two numbers"),
    (("--conductivity", "steel,100Cr6"), "--conductivity: 100Cr6: its conductivity is not known: give it"),
    (("--conductivity", "steel,steel", "--electrical"), "conductivity steel: give the conductivity for a current"),
    (("--conductivity", "50,50", "--layer2", "1um,god"), "--layer2: 1um,god: expected THICKNESS,CONDUCTIVITY"),
    (("--conductivity", "50,50", "--film=-1"), "--film: -1: expected a number, 0 or more, or a file"),
    (("--layer1", "1um,300"), "--layer1: is for the conductance"),
    (("--conductivity", "50,50", "--layer2", "1um"), "--layer2: 1um: expected THICKNESS,CONDUCTIVITY"),
    (("--conductivity", "50,50", "--layer2", "1um,-3"), "--layer2: 1um,-3: expected THICKNESS,CONDUCTIVITY"),
    (("--conductivity", "50,50", "--gas", "0.026"), "--gas: 0.026: expected LAM,M"),
    (("--conductivity", "50,50", "--gas", "0.026,1Pa"), "--gas: 0.026,1Pa: expected LAM,M"),
], ids=str)  # fmt: skip
def test_options_are_refused_in_one_line(command, tmp_path, words, says):
    write(tmp_path / "a.h5", "separation", waves(24, 5))
    said = command("a.h5", "--pressure", "10MPa", *STEEL, "--normal-only", *words, check=2)
    assert says in said and said.count("\n") == 1


@pytest.mark.parametrize("name, says", [
    ("b.txt", "b.txt: has 4 x 3 points along x and y, the surface 24 x 24: give the film at each point"),
    ("a.h5", "a.h5: has no dataset /film"), ("none.h5", "none.h5: no such file"),
])  # fmt: skip
def test_a_file_of_a_film_that_does_not_fit_is_named(command, tmp_path, monkeypatch, name, says):
    write(tmp_path / "a.h5", "separation", waves(24, 5))
    (tmp_path / "b.txt").write_text("1 2 3 4\n" * 3)
    monkeypatch.setattr(petsam.Contact, "try_step", None)
    words = ("a.h5", "--pressure", "10MPa", *STEEL, "--normal-only", "--conductivity", "50,50", "--film", name)
    for more in ((), ("--periodic",)):
        said = command(*words, *more, check=3)
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
    files = ["i.csv", "i.png", "i.inp", "i-calculix.inp"]
    assert command(*words, "--normal-only").splitlines() == [*one.lines(), *(f"wrote {name}" for name in files)]
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
    assert "*FRICTION, ELASTIC" in (tmp_path / "i.inp").read_text()
    calculix = rows(tmp_path / "i-calculix.inp", "*GAP CONDUCTANCE")
    assert calculix[2:, :2] == pytest.approx(np.array(expected[2:]) * [1e-3, 1], rel=1e-5)
    assert "** CalculiX has no electrical contact" in (tmp_path / "i-calculix.inp").read_text()
    electrical = rows(tmp_path / "i.inp", "*GAP ELECTRICAL CONDUCTANCE, PRESSURE")
    assert electrical[2:] == pytest.approx(np.array(expected[2:]) * [1e-3, 1], rel=1e-5)
    assert rows(tmp_path / "i.inp", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR").shape == (3, 2)


def test_a_card_without_gas_begins_at_0_and_needs_a_conductance(tmp_path):
    one = found()
    one.to_abaqus(tmp_path / "a.inp")
    assert rows(tmp_path / "a.inp", "*GAP CONDUCTANCE, PRESSURE")[0].tolist() == [0.0, 0.0]
    other = joint.of_interface(waves(24, 5), 1e-5, [1e7], normal_only=True, **PAIR)
    with pytest.raises(petsam.Error, match="to_calculix: needs a conductance"):
        other.to_calculix(tmp_path / "b.inp")


def test_a_hardness_says_which_stiffness_is_measured_how(command, tmp_path):
    write(tmp_path / "a.h5", "separation", waves(48, 11))
    words = ("a.h5", "--pressure", "30MPa", "--normal-only", "--periodic", *STEEL, "--conductivity", "50,50")
    said = command(*words, "--hardness", "0.2GPa").splitlines()
    assert said[3].startswith("k_n of loading is the stiffness that image correlation measures; k_n of unloading")
    assert "ultrasound" in said[3] and len(command(*words).splitlines()) == 3
    unloading, loading, h = (float(said[2].split()[k]) for k in (1, 3, 4))
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
*NSET, NSET=FACES
5, 6, 7, 8, 11, 12, 13, 14
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
{lam}
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
LOW, 11, 11, {high}
HIGH, 11, 11, 0.
*NODE PRINT, NSET=LOW, TOTALS=ONLY
RFL, RF
*NODE PRINT, NSET=FACES
NT
*END STEP
"""


@needs_calculix
@pytest.mark.parametrize("given, lam, high", [
    ({}, 50.0, 100.0), (dict(gas=AIR), 50.0, 100.0), (dict(electrical=True), 5.8e7, 1e-3)
], ids=["bare", "air", "current"])  # fmt: skip
def test_calculix_takes_the_conductance_from_the_card(tmp_path, given, lam, high):
    """Two cubes of 1 mm between 100 K and 0 K, or 1 mV and 0 V, pushed together: the flux is that of three resistances
    in series, of which the contact's is the card's at the pressure that CalculiX finds, and the step between the faces
    that of this one."""
    one = found(lam=(lam, lam), **given)
    one.to_calculix(tmp_path / "card.inp")
    lam = lam * 1e-3 if "electrical" in given else lam  # S/mm; mW/(mm K)
    (tmp_path / "blocks.inp").write_text(BLOCKS.format(push=-1.9e-4, lam=lam, high=high))
    done = subprocess.run([CCX, "blocks"], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    lines = [line.split() for line in (tmp_path / "blocks.dat").read_text().splitlines() if line.strip()]
    assert len(lines) == 13, done.stdout
    heat, pressure = float(lines[1][0]), float(lines[3][2])
    faces = {int(node): float(value) for node, value in lines[5:]}
    assert 4.0 < pressure < 12.0
    card = rows(tmp_path / "card.inp", "*GAP CONDUCTANCE")
    h = np.interp(pressure, card[:, 1], card[:, 0])
    assert heat == pytest.approx(high / (2 / lam + 1 / h), rel=1e-4)
    step = np.mean([faces[node] for node in (5, 6, 7, 8)]) - np.mean([faces[node] for node in (11, 12, 13, 14)])
    assert step == pytest.approx(heat / h, rel=1e-4)


def test_the_picture_of_an_interface_has_its_conductance():
    one = found()
    *_, axes = petsam.plot.interface(one).axes
    assert axes.get_ylabel() == "contact conductance, W/(m² K)" and axes.get_xlabel() == "nominal pressure, MPa"
    assert np.allclose(axes.containers[0].lines[0].get_ydata(), one.h)
    assert len(petsam.plot.interface(found(lam=None)).axes) == 2


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
