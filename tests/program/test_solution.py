"""The fields satisfy the contact's conditions, recomputed here from the file alone."""

import numpy as np
import pytest

from support import LOADS, PUNCH, assert_close, ball, closed, displacement, kernels, sliding_pair

BALL = ball(96, poisson=0.3)
FORCE, TORQUE = sliding_pair(BALL, 0.6)
CASES = {
    "normal": BALL,
    "force": dict(BALL, load_tx=30.0, load_ty=-12.0),
    "torque": dict(BALL, load_mz=2e-3),
    "both": dict(BALL, load_tx=0.9 * FORCE, load_mz=0.9 * TORQUE),
    "near sliding": dict(BALL, load_tx=0.99 * FORCE, load_mz=0.99 * TORQUE),
    "moments": dict(BALL, grid_n=(97, 130), load_mx=0.012, load_my=-0.02, load_tx=20.0, load_mz=1e-3),
    "punch": dict(PUNCH, grid_n=(120, 111), load_my=1.5, load_mx=0.4, load_ty=500.0, load_mz=0.3),
    "ellipsoid": dict(
        BALL,
        gap_type="ellipsoid",
        gap_radius1=None,
        gap_radius2=None,
        gap_radius_x=0.09,
        gap_radius_y=0.04,
        load_tx=25.0,
        load_ty=25.0,
    ),
    "rigid": dict(BALL, body2_young=float("inf"), body2_poisson=None, body1_poisson=0.5, grid_n=71, load_tx=33.0),
}


@pytest.fixture(params=CASES)
def case(request):
    return CASES[request.param]


@pytest.fixture
def solution(case, solve):
    return solve(case)


def test_check_residuals_are_within_tolerance(solution):
    # the program's own margin for rounding is 5 %
    assert solution["normal_residual"] <= 1.05e-8
    assert solution["tangential_residual"] <= 1.05e-6
    assert solution["status"] == 0


def test_pressure_and_gap_complement_each_other(solution):
    u = np.abs(solution.displacement_z).max()
    contact = solution.pressure > 0
    assert solution.pressure.min() >= 0
    assert np.abs(solution.gap[contact]).max() <= 1.1e-8 * u
    assert solution.gap[~contact].min() >= -1.1e-8 * u


def test_gap_is_separation_and_displacement(solution, case):
    if case["gap_type"] == "sphere":
        h = solution.r**2 / 2 * (1 / case["gap_radius1"] + 1 / case["gap_radius2"])
    elif case["gap_type"] == "ellipsoid":
        h = solution.xx**2 / 2 / case["gap_radius_x"] + solution.yy**2 / 2 / case["gap_radius_y"]
    else:
        h = np.clip(solution.r - case["gap_flat_radius"], 0, None) ** 2 / 2 / case["gap_edge_radius"]
    assert_close(solution.separation(), h, 1e-13)  # rounding


def test_slip_is_displacement_less_rigid_motion(solution):
    rx, ry, _ = solution.rigid()
    scale = max(np.abs(rx).max(), np.abs(ry).max())
    assert_close(solution.slip_x, solution.displacement_x - rx, 1e-13, scale=scale)  # rounding
    assert_close(solution.slip_y, solution.displacement_y - ry, 1e-13, scale=scale)


def test_shear_stays_within_its_cone(solution, case):
    bound = case["friction"] * solution.pressure
    assert np.max(solution.shear - bound) <= 1e-15 * bound.max()  # rounding


def test_loads_are_in_equilibrium(solution, case):
    sums = solution.loads()
    arm = max(np.abs(solution.x).max(), np.abs(solution.y).max())
    force = {"n": case["load_n"], "t": max(case["friction"] * case["load_n"], 1e-300)}
    for name in LOADS:
        scale = force["n" if name in LOADS[:3] else "t"] * (arm if name[5] == "m" else 1)
        assert abs(sums[name] - case.get(name, 0.0)) <= 1e-10 * scale, name
        assert abs(solution[name] - sums[name]) <= 1e-10 * scale, name


def test_state_follows_its_definition(solution, case):
    p, bound = solution.pressure, case["friction"] * solution.pressure
    # a cell whose shear is on the margin to rounding may be either
    sharp = np.abs(solution.shear - (1 - 1e-5) * bound) > 1e-12 * bound.max()
    expected = np.where(p > 0, np.where(solution.shear >= (1 - 1e-5) * bound, 2, 1), 0)
    assert np.array_equal(solution.state[sharp | (p == 0)], expected[sharp | (p == 0)])
    assert solution["contact_cells"] == np.sum(p > 0)
    assert solution["stick_cells"] == np.sum(solution.state == 1)


def test_stick_cells_do_not_slip(solution):
    u = np.hypot(solution.displacement_x, solution.displacement_y).max()
    stick = solution.state == 1
    assert stick.any()
    slip = np.hypot(solution.slip_x, solution.slip_y)
    # the tolerance 1e-6 is on the shear, whose displacement u is
    assert slip[stick].max() <= 1e-6 * u


def test_slip_is_opposite_to_shear(solution):
    u = np.hypot(solution.displacement_x, solution.displacement_y).max()
    k = solution.state == 2
    assert k.any() or not solution.shear.any()
    sx, sy, qx, qy = (getattr(solution, name)[k] for name in ("slip_x", "slip_y", "shear_x", "shear_y"))
    s, q = np.hypot(sx, sy), np.hypot(qx, qy)
    if not k.any():
        return
    # s.q = -|s||q| to the tolerance of the shear; the direction itself is not fixed where q or s vanishes
    allowed = 1e-6 * q.max() * u
    assert np.max(sx * qx + sy * qy + s * q) <= allowed
    assert np.max(np.abs(sx * qy - sy * qx)) <= allowed


def test_open_cells_carry_nothing(solution):
    open_cells = solution.pressure == 0
    assert np.all(solution.shear[open_cells] == 0)


# ---- displacements by direct summation

SMALL = {
    "similar": dict(ball(9), grid_n=(13, 10), load_tx=20.0, load_ty=9.0, load_mz=1e-3, load_my=0.01),
    "dissimilar": dict(
        ball(9),
        grid_n=(10, 15),
        body1_young=210e9,
        body1_poisson=0.28,
        body2_young=3e9,
        body2_poisson=0.4,
        load_n=20.0,
        load_tx=2.0,
        load_ty=-1.0,
        load_mx=0.001,
    ),
    "rigid": dict(
        ball(9), grid_n=(11, 12), body1_young=float("inf"), body1_poisson=None, body2_poisson=0.2, load_tx=20.0
    ),
}


@pytest.mark.parametrize("name", SMALL)
def test_displacements_are_the_sum_over_all_cells(solve, name):
    case = dict(SMALL[name], allow_edge_contact=True)
    s = solve(case)
    shape = s.pressure.shape
    scale = max(np.abs(getattr(s, f"displacement_{d}")).max() for d in "xyz")
    for j, i in (
        (0, 0),
        (0, shape[1] - 1),
        (shape[0] - 1, 2),
        (shape[0] // 2, shape[1] // 2),
        (3, 7),
        (shape[0] - 2, 4),
    ):
        found = [getattr(s, f"displacement_{d}")[j, i] for d in "xyz"]
        assert_close(found, displacement(s, case, i, j), 1e-12, f"cell {i}, {j}", scale)  # rounding of Love's form


def test_direct_summation_is_an_integral():
    """This test suite's closed forms against quadrature of the point-force kernels, beside the cell and off it."""
    from scipy.integrate import dblquad

    dx, dy, x, y = 1.3, 0.7, 2.1, -1.6
    k = kernels(x, y, dx, dy)
    points = dict(
        r=lambda u, v: 1 / np.hypot(u, v),
        xx=lambda u, v: u * u / np.hypot(u, v) ** 3,
        yy=lambda u, v: v * v / np.hypot(u, v) ** 3,
        xy=lambda u, v: u * v / np.hypot(u, v) ** 3,
        x=lambda u, v: u / (u * u + v * v),
        y=lambda u, v: v / (u * u + v * v),
    )
    for name, point in points.items():
        exact = dblquad(
            lambda v, u, point=point: point(x - u, y - v), -dx / 2, dx / 2, -dy / 2, dy / 2, epsabs=1e-13, epsrel=1e-13
        )[0]
        assert k[name] == pytest.approx(exact, rel=1e-11), name


# ---- dissimilar bodies


def test_dissimilar_bodies_satisfy_the_conditions_together(solve):
    case = dict(
        ball(96), body1_young=200e9, body1_poisson=0.3, body2_young=5e9, body2_poisson=0.35, load_n=30.0, load_tx=2.0
    )
    s = solve(case)
    u, contact = np.abs(s.displacement_z).max(), s.pressure > 0
    # the gap also holds the last pass's change of shear, -coupling_rtol 1e-6
    assert s["normal_residual"] <= 1.1e-6 and s["tangential_residual"] <= 1.05e-6
    assert np.abs(s.gap[contact]).max() <= 1.1e-6 * u
    assert s["coupling_iterations"] > 1
    assert np.max(s.shear - 0.27 * s.pressure) <= 1e-15 * s.pressure.max()
    assert s.loads()["load_tx"] == pytest.approx(2.0, rel=1e-9)


def test_friction_holds_back_the_softer_body(solve):
    """Under N alone pressure draws the softer body 2 inwards; friction holds it back: q on body 2 points outwards."""
    case = dict(ball(64), body1_young=200e9, body1_poisson=0.3, body2_young=5e9, body2_poisson=0.35, load_n=30.0)
    s = solve(case)
    inside = (s.pressure > 0) & (s.r > 3 * s.dx) & (s.r < 0.98 * s.r[s.pressure > 0].max())  # the edge is of cells
    radial = (s.xx * s.shear_x + s.yy * s.shear_y)[inside]
    assert np.all(radial > 0)
    assert np.all(solve(dict(case, coupling="none")).shear == 0)


def test_coupling_does_not_exist_between_similar_bodies(solve):
    full, none = solve(dict(BALL, load_tx=20.0)), solve(dict(BALL, load_tx=20.0, coupling="none"))
    assert np.array_equal(full.shear_x, none.shear_x)
    assert full["coupling_iterations"] == 1


def test_table_1_numbers():
    """The paper's p0, a and limit torque, which the cases above rest on."""
    from support import SPHERE, hertz, slide_limit

    h = hertz(SPHERE)
    assert (h.radius, h.pressure) == (pytest.approx(0.8662e-3, rel=1e-4), pytest.approx(636.3057e6, rel=1e-6))
    assert slide_limit(SPHERE)[1] == pytest.approx(51.0257e-3, rel=1e-5)
    assert closed.effective_radius(0.2, 0.2) == pytest.approx(0.1)
