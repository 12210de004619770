"""The number of ranks does not change the results."""

import concurrent.futures
import subprocess

import h5py
import numpy as np
import pytest

from conftest import PROGRAM
from support import Results, assert_same, ball, bodies, flatten

BALL = dict(ball(), grid_n=(75, 62), load_my=0.02, load_tx=30.0, load_ty=9.0, load_mz=1e-3)
# 4 rows for 5 ranks; flat bodies touch everywhere, so the contact is at the edge
STRIP = dict(
    **bodies(70e9, 0.3),
    friction=0.2,
    gap_type="flat",
    grid_n=(40, 4),
    grid_size=(4e-3, 4e-4),
    load_n=50.0,
    load_tx=6.0,
    load_ty=1.0,
    load_mz=1e-3,
    allow_edge_contact=True,
    # flat bodies are ill-conditioned: rounding shows up to the tolerance, which must be below what is asked here
    normal_rtol=1e-11,
    tangential_rtol=1e-10,
)
DISSIMILAR = dict(
    BALL, body2_young=9e9, body2_poisson=0.4, load_n=60.0, load_my=0.004, load_tx=3.0, load_ty=1.0, load_mz=1e-4
)
SLIDING = dict(BALL, load_tx=1e4)  # refused, with its limit


@pytest.mark.parametrize("ranks", [2, 3, 5])
@pytest.mark.parametrize("case", [BALL, STRIP, DISSIMILAR, SLIDING], ids=["ball", "strip", "dissimilar", "sliding"])
def test_results_do_not_depend_on_ranks(petsam, tmp_path, case, ranks):
    """To the last bit, numbers of the steps and fields: sums over rows do not depend on where the rows are."""
    codes = {petsam(case, dict(output=f"{n}.h5"), ranks=n, check=None).code for n in (1, ranks)}
    assert len(codes) == 1
    with h5py.File(tmp_path / "1.h5") as one, h5py.File(tmp_path / f"{ranks}.h5") as many:
        names = []
        one.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
        assert len(names) > 30
        for name in names:
            a, b = one[name][()], many[name][()]
            assert np.array_equal(a, b, equal_nan=one[name].dtype.kind == "f"), name


@pytest.mark.parametrize("case", [BALL, DISSIMILAR], ids=["ball", "dissimilar"])
def test_fields_do_not_depend_on_how_rows_become_columns(solve, case):
    """By messages, as between nodes, or in shared memory: the same numbers are transformed."""
    assert_same(solve(dict(case, fft_exchange="transpose"), ranks=3), solve(case, ranks=3), 0)


@pytest.mark.parametrize("n", [(2, 2), (3, 2), (2, 7), (5, 1000), (1000, 3)])
def test_tiny_and_thin_grids_on_three_ranks(solve, n):
    case = dict(STRIP, grid_n=n, grid_size=(1e-4 * n[0], 1e-4 * n[1]), load_tx=3.0, load_ty=1.0, load_mz=0.0)
    case["output_fields"] = "all"
    assert_same(solve(case, ranks=3), solve(case), 0)


@pytest.mark.parametrize("ranks", [2, 5])
def test_run_repeats(solve, petsam, tmp_path, ranks):
    petsam(BALL, dict(output="again.h5"), ranks=ranks)
    assert_same(Results(tmp_path / "again.h5"), solve(BALL, ranks=ranks), 0)


def test_rank_that_nobody_launched_needs_no_environment(tmp_path):
    """Neither Open MPI's daemon nor its ssh, nor the leave to run as root."""
    done = subprocess.run([str(PROGRAM), *flatten([ball(32)])], env={}, cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_runs_at_the_same_time_do_not_meet(petsam, tmp_path):
    """As the cases of a study do: no file or folder of the launcher's is shared; one in 100 failed when it was."""
    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        runs = list(pool.map(lambda k: petsam(ball(32), dict(output=f"{k}.h5")), range(48)))
    assert {run.stderr for run in runs} == {""}
