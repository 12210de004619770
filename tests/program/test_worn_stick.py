"""Scars that end at a stick zone: what their cells do not resolve is told, with the numbers that it concerns."""

import re

import h5py
import pytest

from support import bodies, doubts, history

STEEL = bodies(210e9, 0.3)
# a cylinder on a flat in partial slip
LIFE = dict(
    STEEL, elasticity="plane", gap_type="ellipsoid", gap_radius_x=0.05, gap_radius_y=float("inf"), friction=0.53,
    grid_size=3.36e-3, wear_coefficient1=1e-13, wear_coefficient2=1e-13, steps=8, output_every=10000,
)  # fmt: skip
BALL = dict(
    STEEL, gap_type="sphere", gap_radius1=0.05, gap_radius2=float("inf"), friction=0.5, grid_size=1e-3, steps=4,
    wear_coefficient2=2e-12, wear_rtol=0.1, output_every=10000,
)  # fmt: skip
PUSH = 90630.0
TOLD = re.compile("the scar is (.*) cells wide and ends at the edge of a stick zone")


def cycle(folder, normal, push):
    """Options of a cycle of T under constant N."""
    return history(folder / "loads.csv", "time,load_n,load_tx", *((k, normal, push * x) for k, x in enumerate(
        (0, 1, -1, 0))))  # fmt: skip


@pytest.fixture
def life(petsam, tmp_path):
    """life(n, cycles, push): numbers of the last cycle, errors that are told by name, and the advised cells or None."""

    def run(n, cycles, push=PUSH, case=LIFE):
        loads = cycle(tmp_path, 100.0 if case is BALL else 5.7e5, push)
        said, errors = doubts(petsam(case, loads, dict(grid_n=n, wear_cycles=cycles, output="life.h5")))
        advised = re.search(r"-grid_n (\d+)$", said)
        with h5py.File(tmp_path / "life.h5") as file:
            numbers = {name: column[-1] for name, column in file["wear"].items()}
            numbers["shear_max"] = file["history/shear_max"][-1]
        return numbers, errors, int(advised[1]) if advised else None

    return run


def wrong(numbers, true):
    return {name: abs(numbers[name] / true[name] - 1) for name in ("dissipated_energy", "volume1")}


@pytest.mark.parametrize("cycles, n", [(1e4, 160), (3e4, 200)])
def test_energy_and_volume_of_a_scar_of_few_cells_are_told_with_cells_that_do(life, cycles, n):
    numbers, errors, advised = life(n, cycles)
    true, _, _ = life(1280, cycles)
    for name, error in wrong(numbers, true).items():
        assert error < 0.05 or error / 2 < errors[name] < 1, name
    assert advised > 2 * n
    better, left, _ = life(advised, cycles)
    assert all(error < max(0.05, 2 * left.get(name, 0)) for name, error in wrong(better, true).items())


def test_all_numbers_of_a_late_cycle_are_told(life):
    numbers, errors, _ = life(140, 4e4)
    true, _, _ = life(560, 4e4)
    assert all(0.15 < error < 2 * errors[name] for name, error in wrong(numbers, true).items())


def test_a_life_without_a_step_is_not_questioned(life):
    numbers, errors, advised = life(320, 100)
    true, _, _ = life(1280, 100)
    assert max(wrong(numbers, true).values()) < 0.01
    assert not errors and advised is None


def test_the_pressure_at_the_edge_of_stick_is_told_though_it_is_not_the_maximum(life):
    """On these cells the maximum lies in the middle of the contact, on finer ones at the edge of the stick zone."""
    numbers, errors, _ = life(160, 1.5e4)
    true, _, _ = life(640, 1.5e4)
    assert true["pressure_max"] > 1.1 * numbers["pressure_max"]
    assert errors["pressure_max"] > 0.05


@pytest.mark.parametrize("push", [60000.0, 75000.0])
def test_the_pressure_at_a_narrow_scar_is_told_though_it_falls_towards_the_edge_of_contact(life, push):
    numbers, errors, _ = life(100, 1e5, push)
    true, _, _ = life(400, 1e5, push)
    error = true["pressure_max"] / numbers["pressure_max"] - 1
    assert error > 0.2 and error / 2 < errors["pressure_max"] < 1
    assert true["shear_max"] > 1.5 * numbers["shear_max"]


@pytest.mark.parametrize("cycles", [4000, 4500])
def test_the_shear_at_a_young_step_is_told(life, cycles):
    """It grows by as much as its bound, and is half of it: the pressure changes by half as much in proportion."""
    numbers, errors, _ = life(160, cycles, 240000.0)
    true, _, _ = life(640, cycles, 240000.0)
    error = true["shear_max"] / numbers["shear_max"] - 1
    assert error > 0.08 and error / 2 < errors["shear_max"] < 2 * error


def test_peaks_at_a_narrow_scar_of_a_ball_are_told(life):
    numbers, errors, _ = life(32, 20000, 15.0, BALL)
    true, _, _ = life(64, 20000, 15.0, BALL)
    assert true["pressure_max"] > 1.1 * numbers["pressure_max"] and errors["pressure_max"] > 0.05


@pytest.mark.parametrize("push", [33.0, 36.0])
def test_the_volume_of_a_late_scar_of_a_ball_is_told(life, push):
    numbers, errors, _ = life(32, 50000, push, BALL)
    true, _, _ = life(64, 50000, push, BALL)
    error = abs(numbers["volume2"] / true["volume2"] - 1)
    assert error > 0.05 and error / 2 < errors["volume1"] < 2 * error


def test_the_depth_along_a_round_edge_is_not_questioned(life):
    """Of its many places on the cells one is near the largest depth."""
    numbers, errors, _ = life(32, 200, 32.0, BALL)
    true, _, _ = life(64, 200, 32.0, BALL)
    assert abs(numbers["depth_max2"] / true["depth_max2"] - 1) < 0.02 and not errors


def test_any_number_of_ranks_says_the_same(petsam, tmp_path):
    """In three dimensions, where rows of the edge lie on different ranks."""
    loads = cycle(tmp_path, 100.0, 15.0)
    case = dict(BALL, **loads, grid_n=32, wear_cycles=20000, output="life.h5")
    told = [petsam(case, ranks=ranks).complaint for ranks in (1, 3)]
    assert told[0] == told[1] and TOLD.search(told[0][0])


@pytest.mark.parametrize("cycles, n", [(1e5, 160), (1e6, 160), (1e4, 160)])
def test_energy_of_a_life_without_slip_left_is_unknown(life, petsam, tmp_path, cycles, n):
    """What is left of it differs by a multiple from grid to grid, and no cells are advised for it."""
    numbers, errors, _ = life(n, cycles)
    with h5py.File(tmp_path / "life.h5") as file:
        spent = numbers["dissipated_energy"] < 1e-3 * file["wear"]["dissipated_energy"][0]
    done = petsam({**LIFE, "output_every": None}, dict(history="loads.csv", grid_n=n, wear_cycles=cycles))
    assert spent == (cycles > 1e4) and ("for which no grid does" in doubts(done)[0]) == spent
    assert spent <= (errors["dissipated_energy"] == 1)
