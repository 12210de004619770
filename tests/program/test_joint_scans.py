"""Interfaces of scans: loops by a formula against computed ones, processes, normal numbers alone, a hardness."""

import csv
import functools
import re

import numpy as np
import pytest

import petsam
from petsam import joint
from petsam.apps.joint import elements, stiffnesses, ways, windows
from petsam.core.progress import Progress
from support import bodies
from test_joint import PAIR, STEEL, waves, write

pytestmark = pytest.mark.filterwarnings("ignore::petsam.contact.AdviceWarning")
PRESSURES = [4e6, 12e6]
LOOP = ("loop_energy", "loop_stiffness", "loop_amplitude")


@pytest.fixture
def command(joint_command):
    """command(*words, check=0): what petsam-joint stiffness prints; its complaint where it fails."""
    return functools.partial(joint_command, "stiffness")


@functools.cache
def both(shear=0.5):
    """A surface with many spots, by the formula and by computed loops."""
    field = waves(96, 3)
    given = dict(PAIR, shear=shear, steps=4)
    return [joint.of_interface(field, 1e-5, PRESSURES, full=full, **given) for full in (False, True)]


@pytest.mark.parametrize("shear", [0.5, 0.8])
def test_the_formula_gives_the_numbers_of_computed_loops(shear):
    found, full = both(shear)
    for name in ("closure", "separation", "k_n", "k_t_x", "k_t_y", "area"):
        assert found.numbers[name] == pytest.approx(full.numbers[name], rel=1e-6), name
    assert found.loop_energy == pytest.approx(full.loop_energy, rel=0.03)
    assert found.loop_amplitude == pytest.approx(full.loop_amplitude, rel=0.01)
    part = found.parts <= 0.8
    assert found.loading[:, part] == pytest.approx(full.loading[:, part], rel=0.01)
    assert found.loading == pytest.approx(full.loading, rel=0.03)  # near gross slip few cells stick
    assert not np.array_equal(found.loop_energy, full.loop_energy)


def test_the_error_is_the_difference_from_the_computed_loops():
    found, full = both()
    for name in ("loop_energy", "loop_stiffness"):
        difference = np.abs(found.numbers[name] / full.numbers[name] - 1)
        assert found.errors[name] == pytest.approx(difference, rel=0.05, abs=1e-4)
    largest = max(found.errors["loop_energy"])
    assert f"at 4, 12 MPa: energy {100 * largest:.1f} %" in found.lines()[-1]
    names = [column.name for column in found.table()]
    assert "loop_energy_error" in names and "loop_stiffness_error" in names
    assert not full.errors and not [column.name for column in full.table() if "_error" in column.name][2:]
    assert full.lines()[-1] == "all loops are computed: as requested"


def test_pressures_between_those_checked_have_the_larger_error():
    assert windows.checked(1) == [0] and windows.checked(2) == [0, 1] and windows.checked(5) == [0, 2, 4]
    found = windows.spread_over(np.array([0.3, 0.1, 0.2]), [0, 2, 4], 5)
    assert found.tolist() == [0.3, 0.3, 0.1, 0.2, 0.2]


def test_masings_rule_is_that_of_a_computed_loop():
    """The energy from the computed first loading alone, and that which the steps of the second cycle dissipate."""
    _, full = both()
    for k, pressure in enumerate(full.pressure):
        limit, stiffness = PAIR["friction"] * pressure, full.k_t_x[k]
        push = full.parts <= 0.5
        parts, reach = np.append(0.0, full.parts[push]), np.append(0.0, full.loading[k][push])
        energy = elements.masing(parts, reach * stiffness / limit - parts)[-1] * limit**2 / stiffness
        assert energy == pytest.approx(full.loop_energy[k], rel=0.01)


def test_loads_of_the_normal_curve_are_near_each_other():
    given = (1e6, 2e6, 50e6)
    points = np.array(sorted({*given, *windows.loads(given, 0.5, 0.95)}))
    assert points[0] == pytest.approx(0.05e6) and points[-1] == 50e6
    ratio = points[1:] / points[:-1]
    assert ratio.max() <= 2 ** (1 / windows.COARSE) + 1e-9
    assert ratio[points[:-1] >= 0.5e6].max() <= 2 ** (1 / windows.FINE) + 1e-9


def test_k_t_of_a_surface_with_a_direction_is_printed_along_both():
    """Ridges along y: slip along them meets the stiffness of the antiplane mode."""
    x = np.arange(64) / 64
    field = 2e-7 * (1 - np.cos(4 * np.pi * x)) + 2e-9 * np.cos(2 * np.pi * x)[:, None]
    found = joint.of_interface(field, 1e-5, [1e6], steps=2, **PAIR)
    assert found.k_t_x / found.k_t_y == pytest.approx(1 / (1 - PAIR["body1_poisson"]), rel=0.05)
    heads, row = (line.split() for line in found.lines()[1:3])
    assert heads[4:6] == ["k_t_x/(N/mm3)", "k_t_y/(N/mm3)"]  # after the two words +- %
    assert [float(value) for value in row[3:5]] == pytest.approx([found.k_t_x[0] / 1e9, found.k_t_y[0] / 1e9], rel=1e-3)
    assert "k_t_x/(N/mm3)" not in both()[0].lines()[1]


def test_the_number_of_processes_changes_no_bit():
    given = dict(PAIR, steps=2)
    told = {1: [], 2: []}
    one, two = (
        joint.of_windows(
            waves(48, 9), 1e-5, PRESSURES, cores=cores, estimate=told[cores].append,
            report=lambda k, count, cores=cores: told[cores].append((k, count)), **given,
        )
        for cores in (1, 2)
    )  # fmt: skip
    for name, values in one.numbers.items():
        assert np.array_equal(values, two.numbers[name], equal_nan=True), name
    assert np.array_equal(one.loading, two.loading) and one.lines() == two.lines()
    for cores in told:
        left = [value for value in told[cores] if isinstance(value, float)]
        assert len(left) == 1 and 0.0 <= left[0] < 60.0
        assert [value for value in told[cores] if isinstance(value, tuple)] == [(k, 5) for k in range(1, 6)]
    assert isinstance(told[1][0], float)  # before the first window has ended


def test_an_error_of_a_process_is_that_of_the_command():
    with pytest.raises(petsam.Error, match="all of the surface touches"):
        joint.of_windows(waves(24, 9), 1e-5, [1e6, 5e9], cores=2, **PAIR)


@pytest.mark.parametrize("change, says", [
    (bodies(210e9, 0.3, 70e9, 0.33), "elastically dissimilar"), (dict(pressure_limit=1e9), "with a hardness"),
    (dict(friction_law="x"), "without the option friction_law"), (dict(body2_young=None), "needs both bodies' moduli"),
    (bodies(210e9, 0.3, np.inf, 0.3), "elastically dissimilar"), ({}, ""), (dict(normal_rtol=1e-9), ""),
    (bodies(70e9, 0.25, 70e9 * (1 - 2 * 0.3) * 1.3 / (0.5 * 1.25), 0.3), ""),
], ids=str)  # fmt: skip
def test_reasons_for_computing_all_loops(change, says):
    options = {name: value for name, value in {**PAIR, **change}.items() if name != "friction"}
    reason = windows.need_computing(options)
    assert says in reason and bool(says) == bool(reason)


def test_dissimilar_bodies_have_computed_loops(command, tmp_path):
    write(tmp_path / "a.h5", "separation", waves(24, 5))
    words = ("a.h5", "--pressure", "10MPa", "--friction", 0.25, "--steps", 1, "--body1", "steel", "--periodic")
    assert command(*words, "--body2", "aluminium").splitlines()[-1] == (
        "all loops are computed: the bodies are elastically dissimilar, so that pressure and shear are coupled"
    )
    assert "loops by a formula" in command(*words, "--body2", "steel").splitlines()[-1]
    assert "all loops are computed" in command(*words, "--body2", "steel", "--full").splitlines()[-1]


def test_a_hardness_has_the_stiffness_of_loading_and_of_unloading(command, tmp_path):
    """Against differences of the closure in a contact of its own: yielded summits carry no further load."""
    field, pressure, hardness = waves(48, 11), 30e6, 0.2e9
    pair = bodies(210e9, 0.3)
    found = joint.of_interface(field, 1e-5, [pressure], friction=0.3, steps=1, pressure_limit=hardness, **pair)
    area = (48e-5) ** 2
    with petsam.Contact(elasticity="periodic", gap_type="flat", grid_n=48, grid_size=48e-5, pressure_limit=hardness,
                        **pair) as contact:  # fmt: skip
        contact.gap = field - field.min()
        at = contact.try_step(load_n=pressure * area).disp_z
        contact.commit()
        more, less = (contact.try_step(load_n=factor * pressure * area).disp_z for factor in (1.001, 0.999))
    assert found.k_n_loading[0] == pytest.approx(0.001 * pressure / (more - at), rel=1e-3)
    assert found.k_n[0] == pytest.approx(0.001 * pressure / (at - less), rel=0.01)
    assert found.k_n_loading[0] < 0.9 * found.k_n[0]
    assert "k_n_loading" in [column.name for column in found.table()] and "with a hardness" in found.lines()[-1]
    assert petsam.plot.interface(found).axes[0].get_legend_handles_labels()[1][1] == "normal, loading"
    write(tmp_path / "a.h5", "separation", field)
    said = command(
        "a.h5", "--pressure", "30MPa", "--normal-only", "--hardness", "0.2GPa", "--periodic", *STEEL
    ).splitlines()
    assert "unloading: k_n/(N/mm3)" in said[1] and "loading: k_n/(N/mm3)" in said[1]
    assert float(said[2].split()[3]) == pytest.approx(found.k_n_loading[0] / 1e9, rel=1e-3)


def test_normal_numbers_alone_are_those_of_the_whole(command, tmp_path):
    field = waves(48, 3)
    whole = joint.of_windows(field, 1e-5, PRESSURES, steps=1, **PAIR)
    alone = joint.of_windows(field, 1e-5, PRESSURES, normal_only=True, **bodies(70e9, 0.25))
    assert set(alone.numbers) == {"pressure", "closure", "separation", "k_n", "k_n_secant", "area"}
    for name, values in alone.numbers.items():
        assert values == pytest.approx(whole.numbers[name], rel=1e-6), name
    assert np.all(np.diff(alone.separation) < 0.0)
    fields = joint.mirrored(field[:24, :24])
    one = joint.of_interface(fields, 1e-5, PRESSURES, normal_only=True, **bodies(70e9, 0.25))
    # the elastic displacement has no mean, so the mean distance is that of the undeformed surfaces
    assert one.separation == pytest.approx(np.mean(fields) - fields.min() - one.closure, rel=1e-9)
    for call in (alone.elements, lambda: alone.to_json(tmp_path / "a.json"), lambda: alone.to_abaqus(tmp_path / "a")):
        with pytest.raises(petsam.Error, match="need k_t and loops"):
            call()
    write(tmp_path / "a.h5", "separation", field)
    words = ("a.h5", "--pressure", "4MPa,12MPa", "--normal-only", "--body1", "70GPa,0.25", "--body2", "70GPa,0.25")
    assert command(*words, "-o", "n").splitlines() == [*alone.lines(), "wrote n.csv", "wrote n.png"]
    assert sorted(path.name for path in tmp_path.glob("n.*")) == ["n.csv", "n.png"]
    with open("n.csv", newline="") as file:
        assert [float(row["k_n [Pa/m]"]) for row in csv.DictReader(file)] == list(alone.k_n)


@pytest.mark.parametrize("words, says", [
    (("--normal-only", "--friction", 0.3), "--friction: is for loops"), (("--normal-only", "--full"), "--full: is for"),
    (("--normal-only", "--steps", 2), "--steps: is for loops"), (("--normal-only", "--area", 1), "--area: is for"),
    (("--normal-only", "--shear", 0.5), "--shear: is for"), ((), "needs --friction, or --normal-only"),
    (("--friction", 0.3, "--cores", 0), "--cores: 0: expected a whole number"),
], ids=str)  # fmt: skip
def test_options_that_do_not_go_together_are_named(command, tmp_path, words, says):
    write(tmp_path / "a.h5", "separation", waves(24, 5))
    assert says in command("a.h5", "--pressure", "10MPa", *STEEL, *words, check=2)


@pytest.mark.parametrize("given, says", [
    (dict(), "friction: give a coefficient, or normal_only"),
    (dict(friction=0.3, normal_only=True), "friction: is for loops"),
    (dict(full=True, normal_only=True), "full: is for loops"), (dict(friction=0.3, cores=0), "cores 0: expected"),
], ids=str)  # fmt: skip
def test_arguments_that_do_not_go_together_are_named(given, says):
    with pytest.raises(petsam.Error, match=says):
        joint.of_interface(waves(24, 5), 1e-5, [1e7], **given, **bodies(70e9, 0.25))


def test_the_time_of_a_command_is_told(command, tmp_path, capsys, monkeypatch):
    write(tmp_path / "a.h5", "separation", waves(24, 5))
    lines = []
    monkeypatch.setattr(stiffnesses, "Progress", lambda what: Progress(what, lines.append))
    monkeypatch.setattr(ways, "SMALL", 10**9)
    command("a.h5", "--pressure", "10MPa", "--friction", 0.25, "--steps", 1, *STEEL)
    assert lines[0].startswith("about 0:0") and lines[0].endswith(" left")
    told = [re.sub(r", about 0:\d\d left$", "", line) for line in lines[1:]]
    assert told == [f"window {k} of 5" for k in range(1, 6)] and lines[5] == told[4] and lines[4] != told[3]
