"""-grid_check: the numbers of the last step on half the cells too, their errors and extrapolation."""

import re

import h5py
import numpy as np

from support import SPHERE

LOOP = "time,load_n,load_tx\n1,1000,60\n2,1000,-60\n3,1000,20\n"


def check(done):
    """Rows by name: this grid, coarser grid, error (relative), extrapolated, order."""
    rows = re.findall(r"^ +(\w+)/\w+ +(\S+) +(\S+) +(\S+) % +(\S+) +(\d)$", done.stdout, re.M)
    return {name: [float(word) for word in words] for name, *words in rows}


def numbers(petsam, folder, *options, series=("history",)):
    """Numbers of the last step of a run, frictional work of all steps, as printed; or those of its last cycle."""
    petsam(*options, "-output", "one.h5", "-overwrite")
    with h5py.File(folder / "one.h5") as f:
        values = {name: data[-1] for group in series for name, data in f[group].items()}
        return values if "wear" in series else dict(values, dissipated_energy=f["history/dissipated_energy"][:].sum())


def test_both_grids_and_their_order(petsam, tmp_path):
    """An odd number of cells: the coarser ones are 2 - 1/33 times as wide."""
    (tmp_path / "loop.csv").write_text(LOOP)
    case = {**SPHERE, "load_n": None, "history": "loop.csv", "steps": 2, "friction": 0.1, "grid_n": 65}
    done = petsam(case, "-grid_check")
    fine, coarse = numbers(petsam, tmp_path, case), numbers(petsam, tmp_path, case, "-grid_n", "33")
    rows = check(done)
    assert set(rows) == {
        "contact_area", "stick_area", "pressure_max", "shear_max", "slip_max", "stored_energy", "dissipated_energy",
        "disp_z", "disp_x",
    }  # fmt: skip
    for name, (value, other, error, extrapolated, order) in rows.items():
        assert np.allclose([value, other], [fine[name], coarse[name]], rtol=2e-5), name
        change = (fine[name] - coarse[name]) / ((65 / 33) ** order - 1)
        assert abs(extrapolated - fine[name] - change) <= 2e-5 * abs(fine[name]), name
        assert abs(error - 100 * abs(change / fine[name])) <= 0.06 * error, name
        assert order == (2 if "disp" in name or "energy" in name else 1)
    two = check(petsam(case, "-grid_check", ranks=2))
    assert two == rows


def test_a_life_is_lived_again_on_half_the_cells(petsam, tmp_path):
    """Numbers of the last cycle, then those of its last step that the cycle does not have."""
    (tmp_path / "cycle.csv").write_text("time,load_tx\n0,0\n1,60\n2,-60\n3,0\n")
    case = dict(SPHERE, friction=0.1, grid_n=40, history="cycle.csv", steps=2, wear_coefficient1=1e-14, wear_cycles=1e5,
                wear_output=2e4, wear_jump=1e5)  # fmt: skip
    rows = check(petsam(case, "-grid_check"))
    expected = {}
    for k, n in enumerate((40, 20)):
        expected[k] = numbers(petsam, tmp_path, case, dict(grid_n=n), series=("history", "wear"))
    assert {"volume1", "depth_max1", "dissipated_energy", "pressure_max", "stick_area", "disp_z"} <= set(rows)
    assert "volume2" not in rows
    for name, row in rows.items():
        assert np.allclose(row[:2], [expected[0][name], expected[1][name]], rtol=2e-5), name
        assert row[4] == (2 if any(word in name for word in ("volume", "energy", "disp")) else 1), name


def test_heights_of_a_file_are_averaged(petsam, tmp_path):
    heights = 1e-7 * np.random.default_rng(5).normal(size=(64, 64)).cumsum(0).cumsum(1) / 8
    with h5py.File(tmp_path / "fine.h5", "w") as f, h5py.File(tmp_path / "coarse.h5", "w") as g:
        f["height"], g["height"] = heights, heights.reshape(32, 2, 32, 2).mean((1, 3))
    case = {**SPHERE, "gap_type": "file", "gap_radius1": None, "gap_radius2": None, "elasticity": "periodic"}
    case = dict(case, grid_n=64, load_n=300.0)
    rows = check(petsam(case, "-gap_file", "fine.h5", "-grid_check"))
    coarse = numbers(petsam, tmp_path, case, "-gap_file", "coarse.h5", "-grid_n", "32")
    assert all(np.isclose(row[1], coarse[name], rtol=2e-5) for name, row in rows.items())


def test_fields_and_states_of_another_grid_are_refused(petsam, tmp_path):
    with h5py.File(tmp_path / "friction.h5", "w") as f:
        f["friction"] = np.full((64, 64), 0.1)
    for words in (("-restart", "a.h5"), ("-friction_file", "friction.h5")):
        case = dict(SPHERE, grid_n=64, friction=None)
        done = petsam(case, "-grid_check", *words, check=2)
        assert f"-grid_check does not work with {words[0]}" in done.complaint[0]
