"""Wear by passages of a running band in steady rolling: closed forms, conservation, jumps, and what is refused."""

import numpy as np
import pytest

import petsam
from support import doubts, history
from test_rolling import YOUNG, U, ellipse

SLOW = 1e-22  # 1/Pa: a passage changes no pressure
FAST = 1e-13


def one_passage(**more):
    """The jump solves for the pressure anew, which is that of the passage within the tolerance."""
    return dict(dict(wear_cycles=1, wear_jump=1, output_fields="all", normal_rtol=1e-13), **more)


def band(**more):
    """Lines of 26 cells, and passages that wear a third of the approach."""
    case = ellipse(n="32,40", width=2.6, creep_x=0.4 * U, creep_y=0.0, creep_spin=0.0)
    return dict(dict(case, wear_coefficient1=FAST, wear_coefficient2=2 * FAST, wear_cycles=6.4e3), **more)


def test_a_sliding_band_wears_by_the_creepage_and_the_pressure_of_its_lines(solve):
    """nu = 0, q = mu p everywhere: the elastic part of the slip does no work on a line, by symmetry."""
    creep = 10 * U
    case = ellipse(poisson=0.0, n="48,50", creep_x=creep, creep_y=0.0, creep_spin=0.0, wear_coefficient2=SLOW)
    s = solve(case, one_passage())
    assert s["wear_volume2"] == pytest.approx(SLOW * creep * case["load_n"], rel=1e-9)
    lines = s.pressure.sum(axis=1) * s.dx
    assert np.abs(s.wear_depth2 / (SLOW * creep) - lines[:, None]).max() <= 1e-9 * lines.max()
    hertz = 800e6 * 1e-3 * np.pi / 2 * np.clip(1 - (s.y / 1e-3) ** 2, 0, None)
    assert np.abs(lines - hertz).max() <= 0.02 * hertz.max()
    assert not s.wear_depth1.any()


def test_energy_wears_its_volume(solve):
    case = ellipse(n=40, ratio=2, creep_x=0.4 * U, creep_y=-0.3 * U, creep_spin=U / 1e-3, wear_energy1=SLOW)
    s = solve(case, one_passage())
    with petsam.open(s.path) as run:
        assert run.wear["dissipated_energy"][-1] == pytest.approx(s["rolling_energy"], rel=1e-12)
    assert s["wear_volume1"] == pytest.approx(SLOW * s["rolling_energy"], rel=1e-12)
    lines = s.power_density.sum(axis=1) * s.dx
    assert np.abs(s.wear_depth1 / SLOW - lines[:, None]).max() <= 1e-12 * lines.max()


def test_rows_of_a_history_are_passages_that_add_up(solve, tmp_path):
    case = ellipse(n=36, creep_y=0.0, creep_spin=0.0, wear_coefficient1=SLOW)
    creeps = np.array([0.2, 0.7, 0.5]) * U
    singly = [solve(dict(case, creep_x=c), one_passage()) for c in creeps]
    rows = [(k + 1.0, float(creep)) for k, creep in enumerate(creeps)]
    s = solve(case, one_passage(), history(tmp_path / "rows.csv", "time,creep_x", *rows))
    depth = sum(one.wear_passage for one in singly) * SLOW
    assert np.abs(s.wear_depth1 - depth).max() <= 1e-7 * depth.max()


def worn_without_a_life(case, parts):
    """The depth of body 2 by the midpoint rule, each of its passages solved on a gap that is given as worn so far."""
    given = {name: value for name, value in case.items() if name.startswith(("load_", "creep_")) and value is not None}
    options = {name: value for name, value in case.items() if not name.startswith(("load_", "creep_", "wear_"))}
    rate, part = case["wear_coefficient1"] + case["wear_coefficient2"], case["wear_cycles"] / parts
    with petsam.Contact(**options) as contact:
        radii = [float(case[f"gap_radius_{axis}"]) for axis in "xy"]
        unworn = contact.x**2 / (2 * radii[0]) + contact.y[:, None] ** 2 / (2 * radii[1])
        depth = np.zeros_like(unworn)

        def passage(worn):
            contact.gap = unworn + worn
            contact.try_step(**given)
            contact.commit()
            return rate * contact["wear_passage"]

        for _ in range(parts):
            depth += part * passage(depth + 0.5 * part * passage(depth))
    return depth * case["wear_coefficient2"] / rate


def test_depth_is_that_of_passages_without_jumps_and_of_second_order(solve):
    """The band of a long jump is as even as the contact is symmetric; nothing oscillates from line to line."""
    tight = dict(normal_rtol=1e-10, tangential_rtol=1e-8)
    exact = worn_without_a_life(band(**tight), 128)
    found = [solve(band(wear_jump=jump, **tight)) for jump in (6400, 800, 400, 200)]
    depths = [one.wear_depth2 for one in found]
    assert np.array_equal(depths[0], np.repeat(depths[0][:, :1], 32, axis=1))
    assert np.abs(depths[0] - depths[0][::-1]).max() <= 1e-7 * depths[0].max()
    errors = [np.linalg.norm(depth - exact) / np.linalg.norm(exact) for depth in depths]
    assert errors[0] < 0.03 and errors[3] < 5e-4
    assert errors[1] > 2.5 * errors[2] > 6 * errors[3]
    middle = depths[0][12:28, 0]
    assert np.abs(np.diff(middle, 2)).max() <= 0.02 * middle.max()
    assert np.allclose(found[0].wear_depth1 * 2, found[0].wear_depth2)


FALLING = dict(friction_law="falling", friction_falling_kinetic=0.15, friction_falling_half_speed=0.01)


@pytest.mark.parametrize(
    "more",
    [
        dict(body2_young=YOUNG / 3, body2_poisson=0.1, load_n=0.25 * ellipse()["load_n"], creep_x=U),
        dict(creep_x=None, load_tx=0.3 * 0.5 * ellipse()["load_n"]),
        dict(FALLING, rolling_speed=10.0),
        dict(elasticity="plane", load_n=9e5, gap_radius_y="inf", grid_n=64, grid_size=2.6e-3),
    ],
)
def test_jumps_agree_with_passages_without_jumps(solve, more):
    """Of dissimilar bodies, under a given force, with friction that falls with slip, and of cylinders."""
    case = dict(band(wear_jump=200, wear_cycles=1600), **more)
    exact, depth = worn_without_a_life(case, 8), solve(case).wear_depth2
    assert exact.max() > 1e-7
    assert np.abs(depth - exact).max() <= 5e-3 * exact.max()


def test_errors_steer_the_jumps_and_ranks_do_not(solve):
    one, three = (solve(band(wear_rtol=1e-3), ranks=ranks) for ranks in (1, 3))
    assert np.array_equal(one.wear_depth1, three.wear_depth1)
    with petsam.open(one.path) as run:
        wear, units = run.wear, run.wear_units
    assert wear["jump"].max() > 1.5 * wear["jump"][1] > 0
    assert wear["volume1"][-1] == pytest.approx(one.wear_depth1[:, 0].sum() * one.dy, rel=1e-12)
    assert (units["volume1"], units["dissipated_energy"]) == ("m2", "J/m")
    depth = solve(band(wear_jump=100)).wear_depth1
    assert np.abs(one.wear_depth1 - depth).max() <= 3e-3 * depth.max()


def test_single_steps_and_steps_between_rows_do_not_wear(petsam):
    case = band()
    del case["wear_cycles"]
    done = petsam(case, check=2)
    assert "-wear_coefficient1 with -rolling steady is that of passages" in done.stderr
    assert "each row of -history is a passage" in petsam(band(steps=2), check=2).stderr


@pytest.mark.parametrize("n, warned", [(17, True), (64, False)])
def test_a_worn_volume_that_is_too_large_is_warned_of(petsam, n, warned):
    """By the error that it has relative to a fine grid; wear by energy has that of the loads."""
    case = ellipse(n=n, ratio=1, creep_x=0.15 * U, creep_y=0.0, creep_spin=0.0)
    line, told = doubts(petsam(case, dict(wear_coefficient2=SLOW), one_passage()))
    assert ("volume2" in told) == warned and ("-grid_n" in line) == warned
    assert "volume2" not in doubts(petsam(case, dict(wear_energy2=SLOW), one_passage()))[1]
