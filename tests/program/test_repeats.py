"""Loads that repeat: kept steps of the cycle before change the cost, and less than the length of the steps does."""

import numpy as np
import pytest

from kinds.repeats import BALL, first_pair
from support import few, history, read_run


@pytest.mark.parametrize("loads", [(400, 1500, 1600, 400, 1500), (400, 1500, 400, 1500, 400, 1500)])
def test_a_load_comes_back_to_surfaces_that_have_yielded_since(petsam, tmp_path, loads):
    """With hardness, and of the last load the pressure, the depth and its approach are those without kept steps."""
    rows = history(tmp_path / "h.csv", "time,load_n", *[(float(k), float(load)) for k, load in enumerate(loads)])
    case = dict(BALL, friction=None, grid_n=48, grid_size=2.6e-3, pressure_limit=7e8)
    found = []
    for name, more in (("kept", {}), ("none", dict(cycle_memory=0))):
        petsam(case, rows, more, dict(output=f"{name}.h5"))
        found.append(read_run(tmp_path / f"{name}.h5"))
    for name in ("pressure", "plastic_depth", "history/disp_z", "history/plastic_area"):
        kept, none = (r[name] for r in found)
        assert abs(kept - none).max() <= 1e-6 * abs(none).max()
    if loads[2] == 400:  # all has yielded: the pressures of the cycle before are right
        assert (found[0]["history/normal_applies"][4:] == 0).all()


@few("seed", range(1, 13))
def test_random_pair(tmp_path, seed):
    pair, codes, wrong, _ = first_pair(seed, tmp_path)
    assert not wrong, f"{pair}: exit codes {codes}, {wrong}"


def turning(path, steps, cycles, swing):
    """Tangential loads that turn, and a normal load that swings by this part."""
    turn = 2 * np.pi * np.arange(steps * cycles + 1) / steps
    tangential = 0.4 * BALL["friction"] * 900 * (1 - swing)
    columns = turn, 900 * (1 + swing * np.sin(turn)), tangential * np.sin(turn), tangential * np.cos(turn)
    columns[3][0] = 0.0
    return history(path, "time,load_n,load_tx,load_ty", *zip(*(map(float, column) for column in columns)))


@pytest.mark.parametrize("swing, part", [(0.0, 0.5), (0.3, 0.7)])
def test_where_shear_turns_a_kept_step_costs_less_and_is_as_accurate(petsam, tmp_path, swing, part):
    """Its slip's direction is that of the cycle before. Both are compared with eight times as many steps."""
    products, energy = [], []
    case = dict(BALL, grid_size=2.2e-3, output="o.h5")
    for steps, memory in ((16, 1e8), (16, 0), (128, 0)):
        petsam(case, turning(tmp_path / f"{steps}.csv", steps, 5, swing), dict(cycle_memory=memory))
        run = read_run(tmp_path / "o.h5")
        products.append(run["history/tangential_applies"][-steps:].mean())
        energy.append(run["history/dissipated_energy"][-steps:].sum())
    assert products[0] < part * products[1]
    assert abs(energy[0] / energy[2] - 1) <= abs(energy[1] / energy[2] - 1) + 1e-3


def test_a_cycle_after_another_one_is_that_without_kept_steps(petsam, tmp_path):
    """Its loads repeat, but not its slip: the direction of slip that was kept is not used."""
    small, energy = turning(tmp_path / "small.csv", 16, 3, 0.0), []
    rows = np.loadtxt(tmp_path / "small.csv", delimiter=",", skiprows=1)
    other = rows[1:17] * [1, 1, -1.9, 1.2]
    rows = np.vstack([rows, other, rows[-16:]])
    rows[:, 0] = np.arange(len(rows))
    small = history(tmp_path / "both.csv", "time,load_n,load_tx,load_ty", *map(tuple, rows.tolist()))
    for memory in (1e8, 0):
        petsam(dict(BALL, grid_size=2.2e-3, output="o.h5"), small, dict(cycle_memory=memory))
        energy.append(read_run(tmp_path / "o.h5")["history/dissipated_energy"][-16:])
    assert energy[0] == pytest.approx(energy[1], rel=0.02, abs=1e-3 * energy[1].max())
