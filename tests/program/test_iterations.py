"""Products with the influence operator: few, whatever the grid (the counts of method.md)."""

import os
import re
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

sys.path.append(str(Path(__file__).resolve().parents[1] / "bench"))
from conftest import PROGRAM, environment
from petsam.results import Results
from problem import rough_plane  # noqa: E402
from support import PUNCH, ball, bodies, few, finished, flatten, slide_limit, sliding_pair


@pytest.mark.parametrize("n", [256, 512, pytest.param(1024, marks=pytest.mark.slow), (509, 330)])
def test_normal_products_at_most_15(solve, n):
    case = ball(n, friction=0)
    if not isinstance(n, int):
        case["grid_size"] = (case["grid_size"], 0.8 * case["grid_size"])
    assert solve(case)["normal_applies"] <= 15


@pytest.mark.parametrize("n", [256, 512])
def test_normal_products_of_a_punch_with_moment_at_most_20(solve, n):
    assert solve(PUNCH, dict(grid_n=n, load_my=1.0))["normal_applies"] <= 20


@pytest.mark.parametrize(
    "n, flat, edge, young, poisson, normal, moment",
    [
        (65536, 3.7801162049243887e-3, 0.19669777298390828, 70e9, 0.0, 1490310, 845),
        (150000, 1.5275130194e-3, 0.02000024482, 70e9, 0.3, 1883673.7268, -254.0435444),
    ],
)
def test_normal_products_of_long_rows_at_most_30(solve, n, flat, edge, young, poisson, normal, moment):
    """A cell that the set of pressed cells loses within the contact, and one at its end, which hardly parts."""
    pad = dict(gap_type="pad", gap_half_flat_x=flat, gap_edge_radius_x=edge, grid_n=n, grid_size=0.0157)
    case = dict(pad, elasticity="plane", friction=0.0, load_n=normal, load_my=moment, errors="closed")
    assert solve(case, bodies(young, poisson))["normal_applies"] <= 30


@pytest.mark.parametrize("n", [512, pytest.param(1024, marks=pytest.mark.slow)])
def test_normal_products_of_a_rough_plane_at_most_30(solve, tmp_path, n):
    """About 8 % of it in contact."""
    case = {k: v for k, v in ball(n, friction=0).items() if not k.startswith("gap_")}
    case.update(
        gap_type="file",
        gap_file=tmp_path / "gap.h5",
        grid_size=1e-3,
        load_n=146.0,
        rot_x=0.0,
        rot_y=0.0,
        allow_edge_contact=True,
    )
    with h5py.File(case["gap_file"], "w") as f:
        f["height"] = rough_plane(n, 1e-3)
    assert solve(case)["normal_applies"] <= 30


@few("tx, mz", [(0.01, 0), (0.3, 0), (0.6, 0), (0.9, 0), (0.99, 0), (0, 0.1), (0, 0.7), (0, 0.95), (0, 0.99)], 4)
def test_tangential_products_at_512_at_most_25(solve, tx, mz):
    case = ball(512, poisson=0.3)
    force, torque = slide_limit(case)
    assert solve(case, dict(load_tx=tx * force, load_mz=mz * torque))["tangential_applies"] <= 25


@few("part", [0.5, 0.95, 0.99], 2)
@pytest.mark.parametrize("arm", [0.3, 1.0])
def test_tangential_products_of_force_with_torque_at_512_at_most_25(solve, arm, part):
    case = ball(512, poisson=0.3)
    force, torque = sliding_pair(case, arm)
    assert solve(case, dict(load_tx=part * force, load_mz=part * torque))["tangential_applies"] <= 25


@pytest.mark.parametrize(
    "load",
    [dict(load_tx=800.0), dict(load_tx=800.0, load_my=1.0), dict(load_mz=1.2), dict(load_ty=-900.0, load_mz=0.6)],
    ids=["tx", "tx-my", "mz", "ty-mz"],
)
def test_tangential_products_of_a_punch_at_most_25(solve, load):
    assert solve(PUNCH, dict(grid_n=256), load)["tangential_applies"] <= 25


def test_tangential_products_of_dissimilar_bodies_at_512_at_most_40(solve):
    """54 if cells at the edge that coarse grids leave without shear count as sticking."""
    case = ball(512, young=210e9, poisson=0.3, friction=0.1, load_n=1000.0, grid_size=2.2e-3, errors="none")
    case.update(body2_young=70e9, body2_poisson=0.33, gap_radius1=0.2, gap_radius2=0.2, load_tx=90.0)
    assert solve(case)["tangential_applies"] <= 40


@pytest.mark.slow
@pytest.mark.skipif(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") < 16e9, reason="needs 13 GB of memory")
def test_the_largest_grid_needs_few_products_and_the_memory_of_its_head(launcher, tmp_path):
    """Cells that its coarse grids left without shear held up 4096 x 4096 cells there for ever."""
    case = ball(8192, young=210e9, poisson=0.3, friction=0.1, load_n=1000.0, grid_size=2e-3, output="out.h5")
    case.update(gap_radius1=0.2, gap_radius2=0.2, load_tx=60.0, errors="none", output_fields="none")
    command = [*launcher, "-n", "2", str(PROGRAM), *flatten([case])]
    limits = dict(environment(), MPIEXEC_TIMEOUT="1200")  # s
    text = finished(command, cwd=tmp_path, env=limits, timeout=1200).stdout
    with Results(tmp_path / "out.h5") as results:
        assert results["tangential_applies"][-1] <= 35 and results["normal_applies"][-1] <= 15
        assert results["disp_x"][-1] == pytest.approx(4.163119e-07, rel=1e-6)  # as on 512 x 512 cells
    expected, used = re.search(r"about ([0-9.]+) GB per rank", text), re.search(r"memory ([0-9.]+) GB of", text)
    assert float(used[1]) == pytest.approx(float(expected[1]), rel=0.15)


@pytest.mark.slow
def test_tangential_products_at_1024_at_most_25(solve):
    case = ball(1024, poisson=0.3)
    assert solve(case, dict(load_tx=0.8 * slide_limit(case)[0]))["tangential_applies"] <= 25


@pytest.mark.parametrize("n", [128, 512])
def test_products_of_a_dissimilar_contact_that_nearly_slides_at_most_25_a_pass(solve, n):
    """Friction is used up by the coupling: but for a few cells everything slips, in all directions."""
    s = solve(
        ball(n, poisson=0.3, body2_young=1e15, friction=0.1), dict(load_tx=0.6 * slide_limit(ball(n, friction=0.1))[0])
    )
    assert s["tangential_applies"] <= 25 * s["coupling_iterations"]


@pytest.mark.parametrize(
    "n, friction, size, most",
    [(256, 1.0, None, 9), (512, 0.6, 4e-3, 5.5), pytest.param(512, 1.6, None, 9.3, marks=pytest.mark.slow)],
)
def test_tangential_products_of_strong_coupling_at_most_10_a_pass(solve, n, friction, size, most):
    """Of a pressure that is not smooth yet the shear is not sought to the end."""
    case = ball(n, body1_young=30e9, body1_poisson=0.0, body2_young=float("inf"), friction=friction)
    case.update(dict(grid_size=size, gap_radius1=0.1, load_n=1000) if size else {})
    s = solve(case, dict(load_tx=0.3 * friction * case["load_n"]))
    assert s["tangential_applies"] <= most * s["coupling_iterations"]


@pytest.mark.parametrize(
    "n, size, steps, tx, ty",
    [
        (48, 2.6e-3, 3, 98, 0),
        (33, 3.1e-3, 5, 98, 0.1),
        (96, 2.4e-3, 2, 99.9, 0),
        (256, 2.6e-3, 3, 99, 0),
        (43, 3.97e-3, 5, -20.5, -97.8),
        (84, 3.76e-3, 2, -99.567, 9.28),
    ],  # fmt: skip
)
def test_products_where_force_and_load_grow_together_near_sliding(petsam, tmp_path, n, size, steps, tx, ty):
    """At nu = 0 all shear is along one line: a cell that slips does not tell how far."""
    petsam(ball(n, friction=0.1, load_n=1000.0, grid_size=size, gap_radius1=0.2, gap_radius2=0.2, body1_young=210e9,
                body2_young=210e9, body1_poisson=0.0, body2_poisson=0.0),
           dict(load_tx=float(tx), load_ty=ty, steps=steps, output="out.h5"))  # fmt: skip
    with h5py.File(tmp_path / "out.h5") as f:
        assert max(f["history/tangential_applies"]) <= 28


def test_products_without_tangential_load_are_none(solve):
    assert solve(ball(64))["tangential_applies"] == 0


def test_iterations_do_not_count_coarse_grids_only(solve):
    """A converged solve has worked on the finest grid."""
    s = solve(ball(128, load_tx=20.0))
    assert s["normal_iterations"] >= 1 and s["tangential_iterations"] >= 1
    assert s["normal_applies"] >= s["normal_iterations"] and s["tangential_applies"] >= s["tangential_iterations"]


def test_products_of_nearly_flat_periodic_bodies_do_not_grow_by_rounding(solve, tmp_path):
    """Where the displacement is rounding in single precision, products in single precision only cost iterations."""
    rough = np.random.default_rng(3).normal(size=(64, 64))
    for size, most in (1e-15, 10), (1e-13, 16):
        with h5py.File(tmp_path / "gap.h5", "w") as f:
            f["height"] = size * rough
        case = dict(
            bodies(210e9, 0.3, 70e9, 0.3), elasticity="periodic", gap_type="file", gap_file=tmp_path / "gap.h5",
            grid_n=64, grid_size=1e-3, load_n=800, load_tx=80, friction=0.3,
        )  # fmt: skip
        assert solve(case)["normal_applies"] <= most


@pytest.mark.parametrize("ranks", [1, 3])
@pytest.mark.parametrize("n, tx", [(64, 0.6), (64, 0.997), (128, 0.997)])
def test_products_of_the_strongest_coupling_at_most_120(petsam, tmp_path, n, tx, ranks):
    """Near the solution both problems are solved as one system: passes alone took 130 to 153 products."""
    case = dict(
        bodies(210e9, 0.0, float("inf"), 0.0), gap_type="sphere", gap_radius1=0.2, gap_radius2=0.2, grid_n=n,
        grid_size=2.6e-3, friction=2.0, load_n=500.0, load_tx=tx * 1000, output="out.h5",
    )  # fmt: skip
    petsam(case, ranks=ranks)
    with h5py.File(tmp_path / "out.h5") as f:
        assert f["history/normal_applies"][0] + f["history/tangential_applies"][0] <= 120
        assert f["history/coupling_iterations"][0] <= 15


@pytest.mark.parametrize("ranks", [1, 3])
@pytest.mark.parametrize("poisson, friction, most", [(0.0, 2.0, 120), (0.0, 3.0, 165), (0.3, 3.0, 97)])
def test_products_of_strong_coupling_near_sliding_after_the_normal_load(
    petsam, tmp_path, poisson, friction, most, ranks
):
    """Where all slips, the system's inverse knows the shear that pressure takes with it: 150, 221 and 120 without."""
    (tmp_path / "h.csv").write_text(f"time,load_tx\n1,0\n2,{0.997 * friction * 500}\n")
    case = dict(
        bodies(210e9, poisson, float("inf"), 0.0), gap_type="sphere", gap_radius1=0.2, gap_radius2=0.2, grid_n=96,
        grid_size=2.6e-3, friction=friction, load_n=500.0, history="h.csv", output="out.h5",
    )  # fmt: skip
    petsam(case, ranks=ranks)
    with h5py.File(tmp_path / "out.h5") as f:
        assert f["history/normal_applies"][1] + f["history/tangential_applies"][1] <= most
