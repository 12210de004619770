"""The program's -stiffness: matrices in /history, on any number of ranks, at restarts, in lives, without a solution."""

import h5py
import numpy as np
import pytest

from support import SPHERE, read_run

CASE = dict(SPHERE, grid_n=48, load_n=None, stiffness=True, output="out.h5")
HISTORY = "time,load_n,load_tx\n1,1000,0\n2,1000,50\n3,1000,80\n4,1000,-20\n"
LIMIT = 1e-2  # of closed forms on these cells


@pytest.fixture
def history(tmp_path):
    (tmp_path / "history.csv").write_text(HISTORY)
    return dict(history="history.csv")


def matrices(path):
    with h5py.File(path) as file:
        assert file["history/stiffness"].attrs["units"] == "N/m, N/rad, N, N m/rad"
        rows, columns = (file[name].attrs["flag_meanings"] for name in ("load_component", "rigid_component"))
        assert rows.split() == ["load_n", "load_tx", "load_ty", "load_mx", "load_my", "load_mz"]
        assert columns.split() == ["disp_z", "disp_x", "disp_y", "rot_x", "rot_y", "rot_z"]
        return file["history/stiffness"][:], file["history/stiffness_reversal"][:]


def test_matrices_are_those_of_mindlin(petsam, history, tmp_path):
    """Steps that only press stick; along T the shear stiffness falls, and a turn doubles what is left to slip."""
    petsam(dict(CASE, grid_n=96, body1_poisson=0.0, body2_poisson=0.0), history)
    on, back = matrices(tmp_path / "out.h5")
    assert on.shape == back.shape == (4, 6, 6) and np.all(np.isfinite(on))
    assert np.allclose(back, back.transpose(0, 2, 1), rtol=1e-8, atol=1e-8 * back.max())
    ratio = on[:, 1, 1] / back[:, 1, 1]
    limit = 0.1 * 1000
    expected = [1.0, (1 - 50 / limit) ** (1 / 3), (1 - 80 / limit) ** (1 / 3), (1 - 100 / (2 * limit)) ** (1 / 3)]
    assert ratio == pytest.approx(expected, rel=LIMIT)
    assert np.all(on[:, 0, 1:3] == 0) and on[2, 1, 0] / on[2, 0, 0] == pytest.approx(0.1 * (1 - ratio[2]), rel=LIMIT)


@pytest.mark.parametrize("ranks", [2, 3])
def test_matrices_do_not_depend_on_the_ranks(petsam, history, tmp_path, ranks):
    petsam(CASE, history, dict(body2_young=70e9))
    petsam(CASE, history, dict(body2_young=70e9, output="ranks.h5"), ranks=ranks)
    for one, other in zip(matrices(tmp_path / "out.h5"), matrices(tmp_path / "ranks.h5")):
        assert np.array_equal(one, other)


def test_results_go_on_with_and_without_matrices(petsam, history, tmp_path):
    """Steps that were computed without them have NaN."""
    whole = tmp_path / "whole.h5"
    petsam(CASE, history, dict(output="whole.h5"))
    (tmp_path / "part.csv").write_text("\n".join(HISTORY.splitlines()[:3]))
    part = dict(checkpoint="state.h5", checkpoint_every=1)
    petsam(dict(CASE, history="part.csv", stiffness=None), part)
    petsam(CASE, part, history, dict(restart="state.h5"))
    on, expected = (read_run(path)["history/stiffness"] for path in (tmp_path / "out.h5", whole))
    assert np.all(np.isnan(on[:2])) and np.array_equal(on[2:], expected[2:])


def test_step_without_a_solution_has_none(petsam, tmp_path):
    (tmp_path / "slide.csv").write_text("time,load_n,load_tx\n1,1000,50\n2,1000,150\n")
    petsam(CASE, dict(history="slide.csv"), check=11)
    on, back = matrices(tmp_path / "out.h5")
    assert np.all(np.isfinite(on[0])) and np.all(np.isnan(on[1])) and np.all(np.isnan(back[1]))


def test_life_has_those_of_its_cycles(petsam, tmp_path):
    (tmp_path / "cycle.csv").write_text("time,load_n,load_tx\n0,1000,0\n1,1000,60\n2,1000,-60\n3,1000,0\n")
    petsam(CASE, dict(history="cycle.csv", wear_coefficient1=1e-14, wear_cycles=1000))
    on, _ = matrices(tmp_path / "out.h5")
    assert on.shape[0] % 3 == 0 and np.all(np.isfinite(on)) and not np.allclose(on[:3], on[-3:], rtol=1e-4)


def test_help_does_not_ask_for_a_file(petsam):
    assert "-stiffness" in petsam("-stiffness", "-help").stdout


def test_cells_that_bear_hardly_any_shear_are_as_if_without_friction(petsam, tmp_path):
    """They slip far for their bound, and resist a turn of that 1e8 times as much as others move."""
    found = []
    for name, least in ("hardly", 1e-10), ("none", 0.0):
        friction = np.full((32, 32), 0.3)
        friction[14:17, 18:21] = least
        with h5py.File(tmp_path / f"{name}.h5", "w") as f:
            f["friction"] = friction
        case = dict(SPHERE, grid_n=32, friction=None, friction_file=f"{name}.h5", load_tx=20.0, output=f"r{name}.h5")
        petsam(case, "-stiffness")
        with h5py.File(tmp_path / f"r{name}.h5") as f:
            found.append(f["history/stiffness"][0])
    assert np.isfinite(found[0]).all()
    assert found[0] == pytest.approx(found[1], rel=1e-4, abs=1e-6 * np.abs(found[1]).max())
