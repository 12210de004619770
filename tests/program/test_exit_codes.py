"""Exit codes 10, 11, 12: what did not converge, what has no equilibrium, what reached the edge."""

import re

import h5py
import numpy as np
import pytest

from support import PUNCH, Results, ball, hertz, slide_limit, sliding_pair

BALL = ball(72)
FORCE, TORQUE = slide_limit(BALL)


def limits(done):
    """The limits that the message tells, by load."""
    return {
        name: float(limit)
        for name, limit in re.findall(r"(load_\w+) = \S+ (?:N m|N) \(limit (\S+)\)", done.complaint[0])
    }


# ---- 11


@pytest.mark.parametrize("name", ["load_tx", "load_ty"])
@pytest.mark.parametrize("factor", [1.0001, -1.3, 50.0])
def test_gross_slip_by_force_names_its_limit(petsam, name, factor):
    done = petsam(BALL, {name: factor * FORCE}, check=11)
    assert list(limits(done)) == [name]
    assert limits(done)[name] == pytest.approx(np.sign(factor) * FORCE, rel=1e-6)  # sum of mu p is mu N
    assert done.complaint[0].endswith("; for gross slip give " + name.replace("load_t", "disp_"))
    assert "worst" not in done.stdout  # no step has a solution


def test_gross_slip_by_both_forces_names_both(petsam):
    done = petsam(BALL, dict(load_tx=0.8 * FORCE, load_ty=0.7 * FORCE), check=11)
    assert np.hypot(limits(done)["load_tx"], limits(done)["load_ty"]) == pytest.approx(FORCE, rel=1e-6)
    assert "; for gross slip give disp_x, disp_y" in done.complaint[0]


def test_gross_slip_by_torque_names_its_limit(petsam):
    done = petsam(BALL, dict(load_mz=1.05 * TORQUE), check=11)
    assert limits(done)["load_mz"] == pytest.approx(TORQUE, rel=2e-3)  # the grid's error of a sum over the contact


@pytest.mark.parametrize("arm", [0.3, 1.0])
def test_gross_slip_by_force_and_torque_names_both(petsam, arm):
    force, torque = sliding_pair(BALL, arm)
    assert force < FORCE and torque < TORQUE
    done = petsam(BALL, dict(load_tx=1.02 * force, load_mz=1.02 * torque), check=11)
    assert limits(done) == {"load_tx": pytest.approx(force, rel=2e-3), "load_mz": pytest.approx(torque, rel=2e-3)}


@pytest.mark.parametrize("arm", [None, 0.3, 1.0])
def test_loads_shortly_below_gross_slip_are_carried(solve, arm):
    force, torque = (FORCE, 0.0) if arm is None else sliding_pair(BALL, arm)
    s = solve(BALL, dict(load_tx=0.995 * force, load_mz=0.995 * torque))
    assert s["stick_area"] > 0


@pytest.mark.parametrize("name, sign", [("load_my", 1), ("load_my", -1), ("load_mx", 1)])
def test_moment_beyond_the_grid_names_its_limit(petsam, name, sign):
    half = BALL["grid_size"] / 2
    done = petsam(BALL, {name: sign * 1.2 * half * 180.0}, check=11)
    assert name in done.complaint[0]
    numbers = [float(number) for number in re.findall(r"-?\d\.?\d*(?:e[-+]\d+)?", done.complaint[0].split("limits")[1])]
    assert max(numbers) == pytest.approx(half * 180.0, rel=1.01 / 72)  # the outermost cells' centres
    assert min(numbers) == pytest.approx(-half * 180.0, rel=1.01 / 72)


@pytest.mark.parametrize("load, code", [(dict(load_tx=2 * FORCE), 11), (dict(load_my=1.0), 11)], ids=["slip", "moment"])
def test_no_equilibrium_on_three_ranks_is_said_once(petsam, load, code):
    assert len(petsam(BALL, load, ranks=3, check=code).complaint) == 1


def test_no_equilibrium_leaves_a_marked_file_without_fields(petsam, tmp_path):
    petsam(BALL, dict(load_tx=2 * FORCE, output="out.h5"), check=11)
    with h5py.File(tmp_path / "out.h5") as f:
        assert f["history/status"][:].tolist() == [11]
        assert f["pressure"].shape[0] == f["time"].shape[0] == 0


# ---- 12


@pytest.mark.parametrize("ranks", [1, 3])
def test_contact_at_the_edge_is_told_and_written(petsam, tmp_path, ranks):
    done = petsam(ball(40, half_width=0.9), dict(output="out.h5"), ranks=ranks, check=12)
    assert len(done.complaint) == 1 and "edge" in done.complaint[0] and "-grid_size" in done.complaint[0]
    s = Results(tmp_path / "out.h5")
    assert s["status"] == 12 and s.pressure[0].max() > 0
    assert s.loads()["load_n"] == pytest.approx(180.0, rel=1e-10)


def test_edge_contact_may_be_allowed(petsam, tmp_path):
    done = petsam(ball(40, half_width=0.9), dict(output="out.h5", allow_edge_contact=True))
    assert len(done.complaint) == 1 and "warning" in done.complaint[0] and "edge" in done.complaint[0]
    assert Results(tmp_path / "out.h5")["status"] == 0


def test_allowing_edge_contact_does_nothing_else(petsam):
    assert petsam(BALL, dict(allow_edge_contact=True)).stderr == ""


@pytest.mark.parametrize("load", [dict(load_my=3.6), dict(load_mx=-3.6)], ids=str)
def test_tipped_punch_reaches_the_edge(petsam, load):
    """A lever near the half width needs pressure at the edge."""
    assert "edge of the grid" in petsam(PUNCH, dict(grid_n=64, load_n=1200.0), load, check=12).complaint[0]


def test_contact_in_the_last_but_one_cell_is_not_at_the_edge(petsam):
    d = 2.0e-5
    n = 2 * (int(hertz(BALL).radius / d) + 3)
    petsam(BALL, dict(grid_n=n, grid_size=n * d))


# ---- 10


@pytest.mark.parametrize("option", ["normal_max_it", "tangential_max_it", "coupling_max_it"])
def test_no_convergence_is_told_and_written(petsam, tmp_path, option):
    case = dict(BALL, load_tx=30.0, output="out.h5")
    if option == "coupling_max_it":
        case.update(body2_young=5e9, body2_poisson=0.4)
    done = petsam(case, {option: 1}, check=10)
    (error,) = done.complaint
    assert option.split("_")[0] in error
    s = Results(tmp_path / "out.h5")
    assert s["status"] == 10 and s.saved == 1 and np.all(np.isfinite(s.pressure))


def test_no_convergence_by_a_tolerance_out_of_reach(petsam):
    """Rounding does not allow it: an answer in finite time, and not 0."""
    (line,) = petsam(BALL, dict(load_tx=30.0, normal_rtol=1e-20), check=10).complaint
    assert "rounding leaves no less: use a tolerance of 1e-14 (-normal_rtol)" in line


def test_loose_tolerance_converges_sooner(solve):
    case = dict(BALL, load_tx=30.0)
    loose, tight = (
        solve(case, dict(normal_rtol=1e-4, tangential_rtol=1e-3)),
        solve(case, dict(normal_rtol=1e-11, tangential_rtol=1e-9)),
    )
    assert (
        loose["normal_applies"] < tight["normal_applies"] and loose["tangential_applies"] < tight["tangential_applies"]
    )
    assert tight["normal_residual"] <= 1.05e-11 and tight["tangential_residual"] <= 1.05e-9


def test_error_if_not_converged_stops(petsam):
    for solver in ("normal", "tangential"):
        done = petsam(
            BALL, {"load_tx": 30.0, f"{solver}_max_it": 1, f"{solver}_error_if_not_converged": True}, check=10
        )
        assert f"The {solver} solve did not converge" in done.complaint[0] and len(done.complaint) == 1


def test_success_says_nothing_on_stderr(petsam):
    assert petsam(BALL, dict(load_tx=30.0)).stderr == ""
