"""Friction that changes with slip, pressure or velocity, and a film between the surfaces, against closed forms."""

import h5py
import numpy as np
import pytest

from support import assert_close, ball, hertz, history, kernels

REFERENCE = 2e8


def film_displacement(results, thickness, shear):
    return thickness / shear * results.shear_x


@pytest.mark.parametrize("elasticity", ["halfspace", "periodic"])
def test_film_alone_where_bodies_are_stiff(solve, elasticity):
    """A film far softer than the bodies: u_t = f q, so that all that sticks has q = d/f."""
    case = ball(48, friction=1e4, disp_x=1e-6, disp_y=-2e-6, film_thickness=1e-3, film_shear=1e6, elasticity=elasticity)
    s = solve(case)
    inside = s.state == 1
    assert_close(s.shear_x[inside], 1e-6 / 1e-9, 1e-2)  # the bodies give way by up to this
    assert_close(s.shear_y[inside], -2e-6 / 1e-9, 1e-2)


@pytest.mark.parametrize("film", [1e-14, 1e-13, 1e-12])
def test_stick_with_film_against_a_dense_solve(solve, film):
    case = ball(24, friction=1e4, load_tx=20.0, film_thickness=film * 1e9, film_shear=1e9, tangential_rtol=1e-9)
    s = solve(case)
    j, i = np.nonzero(s.pressure > 0)
    x, y, n = s.x[i], s.y[j], len(i)
    k = kernels(x[:, None] - x, y[:, None] - y, s.dx, s.dy)
    g, nu = case["body1_young"] / 2 / (1 + case["body1_poisson"]), case["body1_poisson"]
    c = 1 / (np.pi * g)  # of two equal bodies
    xx, yy, xy = ((1 - nu) * k["r"] + nu * k["xx"], (1 - nu) * k["r"] + nu * k["yy"], nu * k["xy"])
    zero, one = np.zeros(n), np.ones(n)
    operator = np.block([[c * xx, c * xy], [c * xy, c * yy]]) + film * np.eye(2 * n)
    # unknown besides: d_x, d_y and r_z; loads 20 N, 0 and 0
    rigid = np.array([np.r_[one, zero], np.r_[zero, one], np.r_[-y, x]])
    matrix = np.block([[operator, -rigid.T], [rigid * s.area, np.zeros((3, 3))]])
    found = np.linalg.solve(matrix, np.r_[np.zeros(2 * n), 20.0, 0.0, 0.0])
    assert_close(s.shear_x[j, i], found[:n], 1e-6)
    assert_close(s.shear_y[j, i], found[n : 2 * n], 1e-6, scale=np.abs(found[:n]).max())
    assert s["disp_x"] == pytest.approx(found[2 * n], rel=1e-6)


def test_film_makes_no_more_iterations(solve):
    plain = solve(ball(128, load_tx=30.0))["tangential_applies"]
    for film in (1e-15, 1e-13, 1e-11):
        assert solve(ball(128, load_tx=30.0, film_thickness=film * 1e9, film_shear=1e9))["tangential_applies"] <= plain


def sliding(case):
    """Tx of gross sliding along x, and Hertz's contact."""
    return dict(case, disp_x=1e-3), hertz(case)


@pytest.mark.parametrize(("exponent", "limit"), [(-1 / 3, None), (0.5, None), (0.0, 4e7), (-0.5, 5e7)])
def test_pressure_gives_the_force_of_quadrature(solve, exponent, limit):
    case = ball(
        128, friction_law="pressure", friction_pressure_exponent=exponent, friction_pressure_reference=REFERENCE
    )
    if limit:
        case["friction_shear_limit"] = limit
    case, h = sliding(case)
    s = solve(case)
    r = (np.arange(200000) + 0.5) / 200000
    p0 = 1.5 * case["load_n"] / np.pi / h.radius**2
    p = p0 * np.sqrt(1 - r**2)
    q = np.minimum(case["friction"] * p * (p / REFERENCE) ** exponent, limit or np.inf)
    assert s["load_tx"] == pytest.approx(2 * np.pi * h.radius**2 * np.mean(q * r), rel=2e-3)
    own = np.minimum(
        case["friction"] * s.pressure * (np.maximum(s.pressure, 1) / REFERENCE) ** exponent, limit or np.inf
    )
    assert_close(s.shear[s.pressure > 0], own[s.pressure > 0], 1e-9)


PATH = dict(friction_law="slip_path", friction_path_final=0.5, friction_path_length=2e-6, output_fields="all")


def test_path_gives_the_coefficient_at_the_path(petsam, tmp_path):
    case = ball(40, **PATH)
    loads = history(tmp_path / "path.csv", "time,disp_x", (0, 0.0), (1, 2e-6), (2, -2e-6), (3, 2e-6))
    petsam(case, loads, dict(steps=3, output="path.h5"))
    with h5py.File(tmp_path / "path.h5") as f:
        path, mu, p, slip = (f[name][:] for name in ("friction_path", "friction_coefficient", "pressure", "slip_x"))
    inside = p[-1] > 0
    assert path[-1][inside].max() > 1e-6
    assert_close(mu[-1][inside], 0.5 + (0.27 - 0.5) * np.exp(-path[-2][inside] / 2e-6), 1e-9)
    assert np.all(path[-1][~inside] == 0)
    assert np.all(np.abs(np.diff(path, axis=0) - np.abs(np.diff(slip, axis=0)))[:, inside] <= 3e-2 * path.max())


def test_path_of_no_change_is_coulomb(solve):
    case = ball(32, load_tx=30.0, steps=3, slip_direction="end")  # of both the same solves
    same = dict(case, friction_law="slip_path", friction_path_final=0.27, friction_path_length=1e-7)
    assert_close(solve(same).shear_x, solve(case).shear_x, 1e-9)


def test_falling_follows_the_velocity(petsam, tmp_path):
    """In full sliding of a fast creepage, each cell has the coefficient of its slip over the rolled distance."""
    kinetic, half, speed, creep = 0.1, 0.05, 10.0, 0.01
    case = ball(40, friction_law="falling", friction_falling_kinetic=kinetic, friction_falling_half_speed=half)
    case.update(rolling_speed=speed, sum_slip_path=True)
    d = float(case["grid_size"] / 40)
    loads = history(tmp_path / "fall.csv", "time,creep_x,roll", (0, 0.0, 0.0), *[(k, creep, d) for k in range(1, 5)])
    petsam(case, loads, dict(output="fall.h5"))
    with h5py.File(tmp_path / "fall.h5") as f:
        path, mu, p, state = (f[name][:] for name in ("slip_path", "friction_coefficient", "pressure", "state"))
        assert f["history/load_tx"][-1] > 0
    step = path[-1][:, :-1] - path[-2][:, 1:]
    inside = (p[-1] > 0)[:, :-1]
    assert np.all(state[-1][:, :-1][inside] == 2)
    assert_close(mu[-1][:, :-1][inside], (kinetic + (0.27 - kinetic) * 2 ** (-step * speed / d / half))[inside], 1e-4)


def test_memory_delays_the_fall(petsam, tmp_path):
    case = ball(40, friction_law="falling", friction_falling_kinetic=0.1, friction_falling_half_speed=0.05)
    case.update(rolling_speed=10.0)
    d = float(case["grid_size"] / 40)
    loads = history(tmp_path / "fall.csv", "time,creep_x,roll", (0, 0.0, 0.0), *[(k, 0.004, d) for k in range(1, 30)])
    mean = []
    for memory in (0.0, 3e-7, 3e-6, 1.0):
        petsam(case, loads, dict(friction_falling_memory=memory, output="fall.h5"))
        with h5py.File(tmp_path / "fall.h5") as f:
            mean.append(f["history/load_tx"][-1] / case["load_n"])
            mu = f["friction_coefficient"][-1]
    assert 0.1 < mean[0] < mean[1] < mean[2] < mean[3] <= 0.27
    assert_close(mu[mu > 0], 0.27, 1e-3)


@pytest.mark.parametrize("ranks", [2, 3])
@pytest.mark.parametrize("law", ["slip_path", "falling"])
def test_bits_do_not_depend_on_ranks(petsam, tmp_path, law, ranks):
    case = ball(33, friction_law=law)
    case.update(
        PATH
        if law == "slip_path"
        else dict(friction_falling_kinetic=0.1, friction_falling_half_speed=0.05, rolling_speed=10.0)
    )
    d = float(case["grid_size"] / 33)
    loads = history(
        tmp_path / "h.csv", "time,load_tx,roll,roll_y", (0, 30.0, 0.0, 0.0), (1, 30.0, d, -d), (2, 31.0, d, 0.0)
    )
    for n in (1, ranks):
        petsam(case, loads, dict(output=f"{n}.h5"), ranks=n)
    with h5py.File(tmp_path / "1.h5") as one, h5py.File(tmp_path / f"{ranks}.h5") as many:
        for name in ("shear_x", "friction_coefficient"):
            assert np.array_equal(one[name][:], many[name][:]), name
