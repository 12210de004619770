"""Frictional heat: temperatures beside published ones, their partition, friction that depends on them, and refusals."""

import re

import h5py
import numpy as np
import pytest

import petsam as package
from kinds import heat
from support import history

# E. A. H. Vollebregt, CONTACT, example ertz_temperature: rail and wheel of steel, 30 m/s, 100 kN
SHEAR, POISSON = 82e9, 0.28
RAIL = dict(
    body1_young=2 * SHEAR * (1 + POISSON), body1_poisson=POISSON,
    body2_young=2 * SHEAR * (1 + POISSON), body2_poisson=POISSON,
    gap_type="ellipsoid", gap_radius_x=1 / 2.03, gap_radius_y=1 / 0.843, load_n=1e5, friction=0.3,
    grid_n=(80, 45), grid_size=(16e-3, 22.5e-3), rolling="steady", rolling_speed=30, heat="steady",
    body1_conductivity=50, body2_conductivity=50, body1_heat_capacity=3.5325e6, body2_heat_capacity=3.5325e6,
)  # fmt: skip
FULL = 29940 / (0.3e5 * 30)  # creepage of its full slip, by the power that it prints


class Last:
    """Numbers and fields of the last step."""

    def __init__(self, results):
        self.results = results

    def __getitem__(self, name):
        return self.results[name][-1]


@pytest.fixture(scope="module")
def full_slip(tmp_path_factory):
    return Last(package.run(**RAIL, creep_x=FULL, output=tmp_path_factory.mktemp("heat") / "full.h5"))


def test_full_slip_of_contact(full_slip):
    """Its own printed maximum, 166.8, counts a cell's own heat twice; without that 152.35 on these cells."""
    assert full_slip["heat_power"] == pytest.approx(29940, rel=3e-4)
    assert full_slip["temperature_max"] == pytest.approx(152.35, rel=2e-3)
    assert full_slip["heat_share_2"] == pytest.approx(0.5, abs=1e-12)


def test_chill_of_a_warm_wheel(tmp_path):
    """Without slip to speak of, equal bodies meet half way between their temperatures; heat adds to that."""
    cold = Last(package.run(**RAIL, creep_x=1e-9, body2_bulk_temperature=150, output=tmp_path / "cold.h5"))
    assert cold["temperature_max"] == pytest.approx(75, abs=0.01)
    both = Last(package.run(**RAIL, creep_x=FULL, body2_bulk_temperature=150, output=tmp_path / "both.h5"))
    assert both["temperature_max"] == pytest.approx(227.35, rel=2e-3)


def test_partial_slip_of_contact(tmp_path):
    case = dict(RAIL, creep_x=0.002, creep_y=0.001, creep_spin=-0.2, body2_bulk_temperature=150)
    last = Last(package.run(**case, output=tmp_path / "own.h5"))
    assert abs(last["load_tx"]) / 3e4 == pytest.approx(0.7274, rel=3e-3)
    assert last["heat_power"] == pytest.approx(30 * last["rolling_energy"], rel=1e-3)
    assert 30 * last["rolling_energy_cells"] == pytest.approx(1671.8, rel=5e-3)  # as CONTACT sums it
    rise = (last["temperature_max"] - 75) / last["heat_power"]
    assert rise == pytest.approx((89.10 - 75) / 1671.8, rel=0.02)


def test_friction_that_falls_with_the_temperature(tmp_path):
    """0.3 - 0.18 T/400, and the shear of each cell is that of its temperature."""
    case = dict(RAIL, creep_x=FULL, friction_temperature=(0, 400, -0.18))
    last = Last(package.run(**case, output=tmp_path / "own.h5"))
    assert abs(last["load_tx"]) == pytest.approx(26436, rel=1e-3)
    assert last["temperature_max"] == pytest.approx(128.43, rel=2e-3)
    pressure, temperature = last["pressure"], last["temperature_1"]
    shear = np.hypot(last["shear_x"], last["shear_y"])
    there = pressure > 1e-3 * pressure.max()
    assert np.allclose(shear[there], ((0.3 - 0.18 * temperature / 400) * pressure)[there], rtol=1e-4)


def test_mild_friction_of_contact_in_partial_slip(tmp_path):
    """The heat within the bound is that of the results: friction follows from the stored temperature."""
    case = dict(RAIL, creep_x=0.002, creep_y=0.001, creep_spin=-0.2, friction_temperature=(0, 20, -0.15))
    last = Last(package.run(**case, output=tmp_path / "own.h5"))
    shear, pressure = np.hypot(last["shear_x"], last["shear_y"]), last["pressure"]
    slips = (last["state"] == 2) & (pressure > 1e-2 * pressure.max())
    expected = (0.3 - 0.15 * np.clip(last["temperature_1"] / 20, 0, 1)) * pressure
    assert slips.sum() > 100
    assert np.median(abs(shear / np.where(pressure > 0, expected, 1) - 1)[slips]) < 3e-3


def test_friction_of_unequally_warm_bodies(tmp_path):
    """A warm wheel on a cold rail: the contact is half way between them, and its friction that of this temperature."""
    case = dict(RAIL, creep_x=FULL, body1_bulk_temperature=20, body2_bulk_temperature=120)
    last = Last(package.run(**case, friction_temperature=(60, 200, -0.2), output=tmp_path / "own.h5"))
    there = last["pressure"] > 1e-3 * last["pressure"].max()
    friction = 0.3 - 0.2 * np.clip((last["temperature_1"] - 60) / 200, 0, 1)
    shear = np.hypot(last["shear_x"], last["shear_y"])
    assert last["temperature_1"][there].min() > 69
    assert np.allclose(shear[there], (friction * last["pressure"])[there], rtol=1e-4)


def test_heat_stays_behind(full_slip):
    """Rolling towards +x: warm behind the contact, at -x, and cold ahead of it; the maximum is behind the centre."""
    temperature, pressure = full_slip["temperature_1"], full_slip["pressure"]
    middle, nx = temperature.shape[0] // 2, temperature.shape[1]
    assert temperature[middle, 2] > 20 and abs(temperature[middle, -3]) < 1e-3
    assert np.argmax(temperature[middle]) < nx / 2 - 5
    assert pressure[middle, 2] == pressure[middle, -3] == 0


def test_steep_friction_has_its_solution(tmp_path):
    """-0.18 in 30 K, where passes of heat and friction in turn do not converge."""
    case = dict(RAIL, creep_x=FULL, friction_temperature=(20, 30, -0.18))
    last = Last(package.run(**case, output=tmp_path / "own.h5"))
    there = last["pressure"] > 1e-3 * last["pressure"].max()
    friction = 0.3 - 0.18 * np.clip((last["temperature_1"] - 20) / 30, 0, 1)
    shear = np.hypot(last["shear_x"], last["shear_y"])
    assert np.allclose(shear[there], (friction * last["pressure"])[there], rtol=1e-4)


def test_temperatures_are_sums_of_cells(tmp_path):
    """Unlike bodies that slide: one stands, the other moves; temperatures by direct summation of the stored heat."""
    case = dict(
        body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3, gap_type="sphere",
        gap_radius1=5e-3, gap_radius2="inf", load_n=20, friction=0.4, grid_n=(17, 14), grid_size=(3e-4, 2.6e-4),
        heat="steady", body1_conductivity=50, body1_heat_capacity=3.6e6, body2_conductivity=7,
        body2_heat_capacity=2.3e6,
        body1_bulk_temperature=20, body2_bulk_temperature=35, body2_speed=-0.3, disp_x=2e-5, heat_resistance=1e-6,
    )  # fmt: skip
    last = Last(package.run(**case, output=tmp_path / "own.h5"))
    assert last["heat_power"] == pytest.approx(last["dissipated_energy"], rel=1e-2)  # in a step of 1 s
    heat_2, there = last["heat_2"], last["pressure"] > 0
    ny, nx = heat_2.shape
    total = 35 + heat.temperature((7, 2.3e6, -0.3), (3e-4 / nx, 2.6e-4 / ny), heat_2)
    assert last["temperature_2"] == pytest.approx(total, rel=1e-6)
    difference = last["temperature_1"] - last["temperature_2"]
    assert np.allclose(difference[there], 1e-6 * heat_2[there], atol=1e-6 * abs(difference).max() + 1e-9)


PIN = dict(
    body1="steel", body2="steel", gap_type="sphere", gap_radius1=0.2, gap_radius2="inf", load_n=100, friction=0.3,
    grid_n=32, grid_size=1.6e-3, heat="steady",
)  # fmt: skip


@pytest.mark.parametrize(
    "speeds, change, powers",
    [
        ((0, 5), dict(disp_x=30e-6), (150, 8.89e-4)),
        ((-2, -3), dict(load_tx=0), (30, 0)),
        ((1.5, 0.5), dict(elasticity="plane", load_n=1000, grid_size=2e-4, disp_x=None, load_tx=100), (300, None)),
        ((5, 5), dict(disp_x=30e-6), None),
        ((0, 0), dict(disp_x=30e-6), None),
        ((0, -29.5e-6), dict(disp_x=30e-6), None),
    ],
)
def test_speeds_that_contradict_the_slip_are_told(petsam, speeds, change, powers):
    """Surfaces that do not roll slip by the difference of the speeds: mu N v."""
    done = petsam(PIN, dict(body1_speed=speeds[0], body2_speed=speeds[1], **change))
    told = re.search(
        r"differ by (\S+) m/s, with which friction makes (\S+) W\S*, but the slip .* makes (\S+) W", done.stderr
    )
    assert bool(told) == bool(powers), done.stderr
    if powers:
        assert float(told[1]) == pytest.approx(abs(speeds[1] - speeds[0]))
        assert float(told[2]) == pytest.approx(powers[0], rel=1e-2)
        assert powers[1] is None or float(told[3]) == pytest.approx(powers[1], rel=1e-2, abs=1e-9)


def test_a_history_prints_its_hottest_step(petsam, tmp_path):
    """A pin slides at 5 m/s, and then at 2.5 m/s: the first row builds up shear, the second one has mu N v."""
    rows = (2e-5, -1e-4), (4e-5, -2e-4), (8e-5, -3e-4)
    case = dict(PIN, body2_speed=5, output="pin.h5", **history(tmp_path / "pin.csv", "time,disp_x", *rows))
    done = petsam(case)
    told = re.search(
        r"  heat +at most (\S+) K in contact, in step 2, by (\S+) W of friction \((\S+) % into body 1, (\S+) %",
        done.stdout,
    )
    assert float(told[2]) == pytest.approx(150, rel=1e-3)
    assert float(told[3]) + float(told[4]) == pytest.approx(100, abs=0.11) and float(told[4]) > 80
    assert "step 3: -body1_speed and -body2_speed differ by 5 m/s" in done.stderr
    assert float(told[1]) == pytest.approx(package.open(tmp_path / "pin.h5")["temperature_max"].max(), rel=1e-3)


def test_standing_bodies_share_by_their_conductivities(tmp_path):
    case = dict(
        gap_type="sphere", gap_radius1=0.02, gap_radius2="inf", load_n=50, load_tx=20, friction=0.5, grid_n=33,
        grid_size=6e-4, heat="steady", body1="aluminium", body2="steel",
    )  # fmt: skip
    last = Last(package.run(**case, output=tmp_path / "own.h5"))
    assert last["heat_share_2"] == pytest.approx(53.3 / (53.3 + 237), rel=1e-6)


@pytest.fixture
def fretting(tmp_path):
    """A loop, whose steps have half a second."""
    case = dict(
        body1="steel", body2="Ti-6Al-4V", gap_type="sphere", gap_radius1=0.02, gap_radius2="inf", friction=0.5,
        grid_n=(21, 18), grid_size=6e-4, heat="steady", friction_temperature=(0, 1e-4, -0.1), steps=2,
    )  # fmt: skip
    rows = [(1, 50, 15), (2, 50, -15), (3, 50, 15)]
    return {**case, **history(tmp_path / "loop.csv", "time,load_n,load_tx", *rows)}


def test_errors_are_those_of_states_that_last(petsam, fretting, tmp_path, monkeypatch):
    """In steady rolling; the power of a step in time is that of this step, and other steps have another one."""
    monkeypatch.chdir(tmp_path)
    petsam(dict(RAIL, creep_x=0.01, errors="companion"), "-output", "rolls.h5")
    petsam(dict(fretting, errors="companion"), "-output", "frets.h5")
    names = {"temperature_max", "heat_power", "heat_share_2"}
    for file, there in (("rolls.h5", names), ("frets.h5", set())):
        with h5py.File(file) as found:
            assert {name.decode() for name in found["errors/name"]} & names == there
            assert not there or found["history/temperature_max_error"][0] < 0.2 * found["history/temperature_max"][0]


def test_ranks_and_restarts_have_the_same_bits(petsam, fretting, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for ranks in (1, 2, 3):
        petsam(fretting, "-output", f"{ranks}.h5", ranks=ranks)
    petsam(fretting, "-checkpoint", "state.h5", "-checkpoint_every", "3", "-output", "other.h5")
    petsam(fretting, "-restart", "state.h5.1", "-output", "rest.h5")
    with h5py.File("1.h5") as one:
        for name in ("temperature_max", "heat_power", "heat_share_2", "dissipated_energy"):
            whole = one["history"][name][:]
            for other, count in (("2.h5", 6), ("3.h5", 6), ("rest.h5", 3)):
                with h5py.File(other) as file:
                    np.testing.assert_array_equal(whole[-count:], file["history"][name][:])
        assert (one["history/temperature_max"][2:] > 1e-6).all()  # so that friction has changed


def test_rejected_steps_leave_no_heat(fretting):
    case = {name: value for name, value in fretting.items() if name not in ("history", "steps")}
    contact = package.Contact(**case)
    other, time = package.Contact(**case), 0.0
    for load in (15, -10):
        time += 0.5
        contact.try_step(time, load_n=50, load_tx=0.9 * load)
        contact.reject()
        for one in (contact, other):
            one.try_step(time, load_n=50, load_tx=load)
            one.commit()
    np.testing.assert_array_equal(contact["temperature_1"], other["temperature_1"])


def test_times_must_rise(fretting):
    """The power is the work of a step over its time."""
    case = {name: value for name, value in fretting.items() if name not in ("history", "steps")}
    contact = package.Contact(**case)
    contact.try_step(1.0, load_n=50, load_tx=10)
    contact.commit()
    for time in (1.0, 0.5, 0.0):
        with pytest.raises(package.ContactError, match="give times that rise"):
            contact.try_step(time, load_n=50, load_tx=-5)
    assert contact.try_step(1.5, load_n=50, load_tx=-5).heat_power > 0


def test_doubts_about_heat(petsam, fretting, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rows = history(tmp_path / "early.csv", "time,load_n,load_tx", (0, 50, 15), (1, 50, 0))
    assert "the first step has no duration" in petsam({**fretting, **rows, "steps": 1}).stderr
    rows = history(tmp_path / "low.csv", "time,load_n,friction_scale", (1, 50, 0.1))
    warm = dict(fretting, **rows, body1_bulk_temperature=1, body2_bulk_temperature=1, steps=1)
    assert "makes the coefficient of friction negative" in petsam(warm).stderr
    assert "negative" not in petsam(dict(fretting, body1_bulk_temperature=1, body2_bulk_temperature=1)).stderr


def test_heat_from_body_to_body_is_no_part_of_friction(petsam, fretting):
    """With bodies of different temperatures more heat crosses than friction makes."""
    case = {name: value for name, value in fretting.items() if name not in ("history", "steps")}
    warm = petsam({**case, "load_n": 50, "load_tx": 15, "body1_bulk_temperature": 50}).stdout
    assert re.search(r"heat +[\d.e+-]+ W of friction; [\d.]+ W flow into body 2, at most", warm)


def test_a_step_without_slip_has_no_power(petsam, fretting, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    case = {name: value for name, value in fretting.items() if name not in ("history", "steps")}
    assert "no frictional power, at most 0 K in contact" in petsam(case, "-load_n", "50").stdout
    assert "none, as there is no contact" in petsam(case, "-load_n", "0").stdout


@pytest.mark.parametrize("law", ["coefficient", "energy"])
@pytest.mark.parametrize("slide", [False, True])
def test_wear_follows_the_temperature(petsam, fretting, tmp_path, monkeypatch, law, slide):
    """Each step wears by its factor, which is that of its temperature in each cell; volumes are sums of the depths."""
    monkeypatch.chdir(tmp_path)
    factor = 3.5
    case = {
        **{name: value for name, value in fretting.items() if name not in ("friction_temperature", "history", "steps")},
        **history(tmp_path / "once.csv", "time,load_n,disp_x", (0.5, 50, 2e-6)),
        f"wear_{law}1": 1e-15, f"wear_{law}2": 2e-15, "slide": slide or None,
    }  # fmt: skip
    petsam(case, "-output", "cold.h5")
    with h5py.File("cold.h5") as cold:
        heights = cold["temperature_1"][0]
        cells = cold["pressure"][0] > 0
        depth = cold["wear_depth1"][0]
        low, over = np.quantile(heights[cells], 0.3), np.ptp(heights[cells]) / 3
    change = {"wear_temperature": (low, over, factor)}
    petsam({**case, **change}, "-output", "hot.h5")
    with h5py.File("hot.h5") as hot:
        found = hot["wear_factor"][0]
        expected = 1 + (factor - 1) * np.clip((heights - low) / over, 0, 1)
        np.testing.assert_allclose(found, expected, rtol=1e-9)
        assert found[cells].min() == 1 and found[cells].max() == pytest.approx(factor)
        side = hot["x"][1] - hot["x"][0], hot["y"][1] - hot["y"][0]
        for body, coefficient in ((1, 1), (2, 2)):
            worn = hot[f"wear_depth{body}"][0]
            volume = hot[f"history/wear_volume{body}"][0]
            assert worn.sum() * side[0] * side[1] == pytest.approx(volume, rel=2e-3 if slide else 1e-9)
            assert volume == pytest.approx(coefficient * np.sum(expected * depth) * side[0] * side[1], rel=1e-3)
        if not slide:
            np.testing.assert_allclose(hot["wear_depth1"][0], expected * depth, rtol=1e-9, atol=1e-25)
        assert dict(hot.attrs)["wear_temperature"] == pytest.approx([low, over, factor])


def test_points_that_slide_wear_by_the_factor_of_their_cells(petsam, fretting, tmp_path, monkeypatch):
    """Cells too warm to wear take nothing from the points under them, before and after a long step."""
    monkeypatch.chdir(tmp_path)
    case = {
        **{name: value for name, value in fretting.items() if name not in ("friction_temperature", "history", "steps")},
        **history(tmp_path / "once.csv", "time,load_n,disp_x", (0.25, 50, 0), (0.5, 50, 1e-4)),
        "wear_coefficient1": 2e-15, "wear_coefficient2": 2e-15,
        "slide": True, "grid_n": (40, 18), "grid_size": (1e-3, 6e-4),
    }  # fmt: skip
    petsam(case, "-output", "cold.h5")
    with h5py.File("cold.h5") as cold:
        heights, most = cold["temperature_1"][-1], cold["wear_depth2"][-1].max()
        warm = np.quantile(heights[cold["pressure"][-1] > 0], 0.5)
    petsam({**case, "wear_temperature": (warm, 1e-9, 0)}, "-output", "hot.h5")
    with h5py.File("hot.h5") as hot:
        worn = [hot[f"wear_depth{body}"][-1] for body in (1, 2)]
        assert worn[1].sum() == pytest.approx(worn[0].sum(), rel=2e-2) and worn[1].max() > 0.3 * most


def test_wear_by_temperature_in_several_steps(petsam, fretting, tmp_path, monkeypatch):
    """The limit of a step counts the factor; ranks and restarts have the same bits."""
    monkeypatch.chdir(tmp_path)
    case = {**fretting, "wear_coefficient1": 2e-12, "wear_temperature": (0, 1e-5, 500)}
    assert "wear is" not in petsam({**case, "wear_temperature": None}, "-output", "mild.h5").stderr
    assert "times the limit of a step" in petsam(case, "-output", "1.h5").stderr
    for ranks in (2, 3):
        petsam(case, "-output", f"{ranks}.h5", ranks=ranks)
    petsam(case, "-checkpoint", "state.h5", "-checkpoint_every", "3", "-output", "other.h5")
    petsam(case, "-restart", "state.h5.1", "-output", "rest.h5")
    with h5py.File("1.h5") as one:
        for name in ("2.h5", "3.h5", "rest.h5"):
            with h5py.File(name) as other:
                np.testing.assert_array_equal(one["wear_depth1"][-3:], other["wear_depth1"][-3:])


@pytest.mark.parametrize(
    "change, words",
    [
        (dict(wear_temperature=(0, 1, 2)), "wear_coefficient1"),
        (dict(wear_temperature=(0, 1), wear_coefficient1=1e-14), "expected three numbers"),
        (dict(wear_temperature=(0, 0, 2), wear_coefficient1=1e-14), "dT > 0"),
        (dict(wear_temperature=(0, 1, -2), wear_coefficient1=1e-14), "a factor of -2"),
        (
            dict(wear_temperature=(0, 1, 2), wear_coefficient1=1e-14, heat=None, friction_temperature=None),
            "heat steady",
        ),
    ],
)
def test_mistakes_in_wear_by_temperature(petsam, fretting, change, words):
    assert words in petsam({**fretting, **change}, check=2).stderr
