"""Loads that repeat: kept steps of the cycle before change nothing but the cost."""

import pytest

from random_repeats import BALL, trial
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
    pair, codes, wrong, _ = trial(seed, tmp_path)
    assert not wrong, f"{pair}: exit codes {codes}, {wrong}"
