"""Gradients of wear simulations with fixed jumps beside central differences of the whole simulation."""

import numpy as np
import pytest

import petsam
import petsam as library  # beside the fixture petsam, which runs the program
from support import few
from test_gradient import BODIES, SIZE, TIGHT, UNLIKE, gap_of

ROW = np.arange(9)
TURN = 2 * np.pi * ROW / 8
CASES = {
    "archard": {},
    "dissimilar": dict(UNLIKE, grid_n=18),
    "mid step": dict(slip_direction="mid", grid_n=20),
    "energy": dict(wear_coefficient1=None, wear_energy2=3e-11),
    "few cycles": dict(wear_jump=5.0, grid_n=20),
    "displacements": dict(approach=7e-6, grid_n=20),
    "new cells": dict(swing=20.0, wear_coefficient1=2e-10, grid_n=30),
    "one pressure": dict(swing=0.0, wear_rtol=1e-8, grid_n=20),
    "plane": dict(elasticity="plane", grid_n=(40, 1), wear_coefficient1=2e-13),
}


@pytest.fixture(autouse=True)
def quiet(tmp_path, monkeypatch):
    """Tests run in their folder; advice is another test's."""
    monkeypatch.chdir(tmp_path)


def history_of(case, change=None):
    """Loads out of phase; the normal one opens and closes cells at the edge, with little swing wear brings new ones."""
    plane = "elasticity" in case
    unit = 300.0 if plane else 1.0
    history = {"time": ROW.astype(float), "load_n": unit * (1000 + case.get("swing", 200) * np.sin(TURN)),
               "load_tx": unit * 160 * np.sin(TURN + 0.7)}  # fmt: skip
    history["load_my" if plane else "load_ty"] = (0.5 if plane else 40) * np.cos(TURN)
    if plane:
        del history["load_my"]
    if "approach" in case:
        history["disp_z"] = case["approach"] * history.pop("load_n") / 1000
    for name, (row, part) in (change or {}).items():
        size = part * np.abs(history[name]).max()
        history[name] = history[name] + size * ((row == ROW) | ((row == 0) & (ROW == 8)))
    history = {name: np.array(values) for name, values in history.items()}
    for name in history:
        history[name][8] = 8.0 if name == "time" else history[name][0]
    return history


def live(case, part=0.0, friction=0.3, wear=1.0, loads=None, cycles=20):
    """A recorded simulation; the gap, friction, the coefficients of wear and loads are changed by parts."""
    every = {"gap_type": "flat", "grid_n": 24, "grid_size": SIZE, "wear_coefficient1": 1e-11, "wear_jump": 10.0, **case}
    for name in ("wear_coefficient1", "wear_energy2"):
        if every.get(name):
            every[name] = every[name] * wear
    every = {name: value for name, value in every.items() if name not in ("approach", "swing")}
    contact = petsam.Contact(**{**BODIES, **TIGHT, "allow_edge_contact": True, **every, "friction": friction})
    x, y = np.meshgrid(contact.x, contact.y)
    contact.gap = gap_of(x, y) + part * wave(x, y)
    contact.record_gradient()
    contact.live(cycles, history_of(case, loads))
    return contact, x, y


def wave(x, y):
    return 1e-9 * np.cos(7e3 * x + 1) * np.cos(5e3 * y + 0.5)


@pytest.mark.filterwarnings("ignore")
@few("name", CASES, 4)
def test_wear_simulations_beside_differences(name):
    """The worn volume and the work of the last cycle: jumps, their halves, and cells open in a part of the cycle."""
    case = CASES[name]
    contact, x, y = live(case)
    normal = "disp_z" if "approach" in case else "load_n"
    changes = dict(
        gap=(lambda size: dict(part=size), 1e-3), friction=(lambda size: dict(friction=0.3 + size), 1e-6),
        wear=(lambda size: dict(wear=1 + size), 1e-6), normal=(lambda size: dict(loads={normal: (2, size)}), 1e-6),
        load_tx=(lambda size: dict(loads=dict(load_tx=(0, size))), 1e-6),
    )  # fmt: skip
    history = history_of(case)
    found = {number: contact.gradient(number, rtol=1e-11) for number in ("wear_volume", "energy")}
    body = 2 if "wear_energy2" in case else 1
    coefficient = case.get("wear_energy2", case.get("wear_coefficient1", 1e-11))
    assert name == "plane" or not found["energy"].borders
    assert found["wear_volume"].value == pytest.approx(contact.number(f"wear_volume{body}"), rel=1e-9)
    derivatives = {
        number: dict(
            gap=np.sum(one.gap * wave(x, y)), friction=one.friction.sum(),
            wear=one["wear_energy" if body == 2 else "wear_coefficient"] * coefficient,
            normal=one[normal][2] * np.abs(history[normal]).max(),
            load_tx=(one["load_tx"][0] + one["load_tx"][8]) * np.abs(history["load_tx"]).max(),
        )
        for number, one in found.items()
    }  # fmt: skip
    for parameter, (change, size) in changes.items():
        both = [live(case, **change(sign * size))[0] for sign in (1, -1)]
        for number, one in found.items():
            values = [contact.gradient(number, rtol=0.01).value for contact in both]
            difference = (values[0] - values[1]) / (2 * size)
            scale = max(abs(difference), 1e-2 * abs(one.value) if parameter != "gap" else 0)
            assert abs(derivatives[number][parameter] - difference) < 1e-4 * scale or one.borders, (number, parameter)


def test_a_run_writes_what_a_contact_in_process_finds(petsam, tmp_path):
    """The same bits on 1, 2 and 3 ranks; columns have a value of each row of the history."""
    case = dict(
        BODIES, gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", grid_n=(36, 31), grid_size=SIZE, friction=0.3,
        slip_direction="end", normal_rtol=1e-11, tangential_rtol=1e-11, errors="none", wear_coefficient1=1e-12,
        wear_jump=20.0,
    )  # fmt: skip
    loads = {"time": np.arange(5.0), "load_n": np.full(5, 900.0), "load_tx": np.array([0, 120.0, 0, -120, 0])}
    rows = "\n".join(",".join(f"{values[k]:.17g}" for values in loads.values()) for k in range(5))
    (tmp_path / "cycle.csv").write_text(",".join(loads) + "\n" + rows + "\n")
    run = dict(case, history="cycle.csv", wear_cycles=40, gradient="wear_volume,energy")
    files = []
    for ranks in (1, 2, 3):
        done = petsam(run, dict(output=f"{ranks}.h5"), ranks=ranks)
        files.append(library.open(tmp_path / f"{ranks}.h5"))
    contact = library.Contact(**case)
    contact.record_gradient()
    contact.live(40, loads)
    for name in ("wear_volume", "energy"):
        found, one = contact.gradient(name), files[0].gradients[name]
        assert one.value == found.value and np.array_equal(one.gap, found.gap)
        assert one["load_tx"].size == 5 and np.array_equal(one["load_tx"], found["load_tx"])
        for other in (file.gradients[name] for file in files[1:]):
            assert np.array_equal(one.gap, other.gap) and np.array_equal(one.friction, other.friction)
            assert (
                np.array_equal(one["load_n"], other["load_n"]) and one["wear_coefficient"] == other["wear_coefficient"]
            )
    assert "wear_coefficient +1 %" in done.stdout  # little wear is in proportion to its coefficient
    volume = files[0].gradients["wear_volume"]
    assert volume.value == pytest.approx(files[0].wear["volume1"][-1], rel=1e-12)


@pytest.mark.parametrize(
    "change, words",
    [
        (dict(wear_jump=None), "give -wear_jump"),
        (dict(friction=None, wear_friction="mu.csv"), "friction that changes"),
        (dict(gradient_of="body1_young"), "leave the moduli out"),
        (dict(gradient_steps="1,5"), "the history has 4 steps"),
    ],
)
def test_refused_simulations(petsam, tmp_path, change, words):
    (tmp_path / "mu.csv").write_text("cycle,friction\n0,0.3\n20,0.4\n")
    (tmp_path / "cycle.csv").write_text("time,load_n,load_tx\n0,900,0\n1,900,90\n2,900,0\n3,900,-90\n4,900,0\n")
    case = dict(
        BODIES, gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", grid_n=24, grid_size=SIZE, friction=0.3,
        wear_coefficient1=1e-12, wear_jump=20.0, wear_cycles=40, history="cycle.csv", gradient="energy", output="o.h5",
        errors="none",
    )  # fmt: skip
    done = petsam({**case, **change}, check=2)
    assert words in done.stderr and "used  " not in done.stdout


@pytest.mark.filterwarnings("ignore")
def test_a_record_has_one_simulation():
    """Neither steps before it nor after it, but another one after a reset."""
    contact = live(CASES["archard"], cycles=10)[0]
    first = contact.gradient("wear_volume", ["gap"])
    with pytest.raises(petsam.Error, match="further steps begin after a reset"):
        contact.run({name: values[:2] for name, values in history_of({}).items()})
    contact.reset()
    contact.live(10, history_of({}))
    assert np.array_equal(contact.gradient("wear_volume", ["gap"]).gap, first.gap)
    with pytest.raises(petsam.Error, match="steps have been recorded before them"):
        contact.live(10, history_of({}))


@pytest.mark.filterwarnings("ignore")
def test_jumps_that_are_too_little_to_change_the_pressure():
    """By the coefficient of wear under a normal force that stays, with tolerances by which the pressure stays, too."""
    cycle = {"time": ROW.astype(float), "load_n": np.full(9, 1000.0), "load_tx": 160 * np.sin(TURN)}
    found = []
    for normal_rtol, coefficient in ((1e-12, 1e-14), (1e-6, 1e-17)):
        tolerances = dict(normal_rtol=normal_rtol, tangential_rtol=1e-7)
        contact = petsam.Contact(
            **{**BODIES, **TIGHT, **tolerances, "grid_n": 20, "grid_size": SIZE, "gap_type": "flat", "friction": 0.3},
            wear_coefficient1=coefficient, wear_jump=10.0, allow_edge_contact=True,
        )  # fmt: skip
        contact.gap = gap_of(*np.meshgrid(contact.x, contact.y))
        contact.record_gradient()
        contact.live(40, cycle)
        found.append([contact.gradient(name, rtol=1e-8)["wear_coefficient"] for name in ("energy", "pressure_norm")])
    assert found[1] == pytest.approx(found[0], rel=1e-3)
