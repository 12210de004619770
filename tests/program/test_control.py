"""Force and displacement control of the six components, and moments."""

import numpy as np
import pytest

from support import LOADS, RIGID, assert_close, assert_same, ball, hertz, slide_limit

BALL = dict(ball(), grid_n=(80, 73), load_mx=0.01, load_my=0.02, load_tx=25.0, load_ty=-9.0, load_mz=1e-3)
CONJUGATE = dict(zip(LOADS, RIGID))


def controlled(solution, names):
    """BALL with those components displacement-controlled, by what force control found."""
    case = {name: value for name, value in BALL.items() if name not in names}
    return dict(case, **{CONJUGATE[name]: solution[CONJUGATE[name]] for name in names})


def assert_loads(solution, tolerance):
    arm = hertz(BALL).radius
    for name in LOADS:
        scale = (BALL["load_n"] if name in LOADS[:3] else np.hypot(BALL["load_tx"], BALL["load_ty"])) * (
            arm if name[5] == "m" else 1
        )
        assert solution[name] == pytest.approx(BALL[name], abs=tolerance * scale), name
        assert solution.loads()[name] == pytest.approx(BALL[name], abs=tolerance * scale), name


@pytest.mark.parametrize(
    "names",
    [LOADS, LOADS[:1], LOADS[1:3], LOADS[:3], LOADS[3:4], LOADS[4:], LOADS[5:], LOADS[::2]],
    ids=lambda names: "-".join(name[5:] for name in names),
)
def test_rigid_displacements_give_back_the_loads(solve, names):
    # 1e-5: ten times the tangential tolerance
    assert_loads(solve(controlled(solve(BALL), names)), 1e-5)


def test_displacement_control_gives_the_same_fields(solve):
    # near the edge of the stick zone the shear is off by some ten times the residual; 1e-7 leaves a margin of ten
    tight = dict(BALL, normal_rtol=1e-9, tangential_rtol=1e-9)
    assert_same(
        solve(dict(controlled(solve(tight), LOADS), normal_rtol=1e-9, tangential_rtol=1e-9)),
        solve(tight),
        1e-7,
        ("pressure", "shear_x", "shear_y", "displacement_z"),
    )


def test_given_displacements_stay_as_given(solve):
    s = solve(controlled(solve(BALL), LOADS))
    for name in RIGID:
        assert s[name] == solve(BALL)[name]


def test_stiffness_is_symmetric(solve):
    """d T_x/d r_z = d M_z/d d_x etc. in full stick: the work-conjugate pairs are of the right signs."""
    case = dict(ball(61), disp_x=0.0, disp_y=0.0, rot_z=0.0, load_my=0.02, load_mx=-0.01, friction=1e3)
    step = {"disp_x": 1e-9, "disp_y": 1e-9, "rot_z": 1e-6}
    stiffness = np.array(
        [[solve(dict(case, **{rigid: step[rigid]}))[load] / step[rigid] for load in LOADS[3:]] for rigid in step]
    )
    size = np.sqrt(np.outer(np.diag(stiffness), np.diag(stiffness)))
    assert_close(stiffness / size, stiffness.T / size, 1e-5)  # ten times the tangential tolerance
    assert np.abs(stiffness[0, 2]) > 0.01 * size[0, 2]  # the contact is off the origin: the test sees the coupling


@pytest.mark.parametrize(
    "motion",
    [dict(disp_x=1e-3), dict(disp_y=-1e-3), dict(rot_z=1.0), dict(disp_x=1e-3, rot_z=0.7)],
    ids=lambda motion: "-".join(motion),
)
def test_gross_sliding_under_displacement_control_is_a_solution(solve, motion):
    case = ball(72, **motion)
    s = solve(case)
    assert s["stick_area"] == 0
    assert_close(s.shear, case["friction"] * s.pressure, 1e-12)  # on the cone to rounding
    if list(motion) == ["disp_x"]:
        assert s["load_tx"] == pytest.approx(case["friction"] * case["load_n"], rel=1e-5)  # nearly parallel to x
    if list(motion) == ["rot_z"]:
        assert s["load_mz"] == pytest.approx(slide_limit(case)[1], rel=2e-3)  # grid error of a sum


def test_force_beside_given_sliding(solve):
    """Sliding along x by disp_x, with T_y and M_z under force control at zero."""
    case = ball(72, disp_x=2e-6, load_ty=5.0)
    s = solve(case)
    assert s["load_ty"] == pytest.approx(5.0, rel=1e-9)
    assert s["load_tx"] <= np.sqrt((case["friction"] * case["load_n"]) ** 2 - 25.0) * (1 + 1e-9)


def test_separated_bodies_carry_nothing(solve):
    case = dict(ball(33), load_n=None, disp_z=-1e-6)
    s = solve(case)
    assert s.pressure.max() == 0 and s.shear.max() == 0 and np.all(s.state == 0)
    assert s["load_n"] == 0 and s["contact_area"] == 0
    assert_close(s.gap, s.r**2 / 2 / case["gap_radius1"] + 1e-6, 1e-13)


def test_separated_bodies_may_move(solve):
    s = solve(dict(ball(33), load_n=None, disp_z=-1e-6, disp_x=1e-3, rot_z=0.1))
    assert s.shear.max() == 0
    assert_close(s.slip_x, -(1e-3 - 0.1 * s.yy), 1e-13)


def test_no_load_is_no_pressure(solve):
    s = solve(dict(ball(33), load_n=0.0))
    assert s.pressure.max() == 0 and s["load_n"] == 0 and s["contact_area"] == 0
    assert s.gap.min() >= 0


def test_approach_alone_is_hertz(solve):
    h = hertz(ball(128))
    s = solve(dict(ball(128), load_n=None, disp_z=h.approach))
    assert s["load_n"] == pytest.approx(180.0, rel=3e-3)  # 1.5 times the approach's error of about 1e-3 at 128


# ---- moments


def test_moments_shift_the_pressure_by_their_lever(solve):
    """A tilted paraboloid is a shifted one: p moves by (M_y, -M_x)/N, and the fields with it."""
    case = dict(ball(0), grid_n=(96, 90))
    case["grid_size"] = (2e-5 * 96, 2e-5 * 90)
    centred = solve(case)
    i, j = 7, -4
    shift = (2e-5 * i, 2e-5 * j)
    s = solve(dict(case, load_my=180.0 * shift[0], load_mx=-180.0 * shift[1]))
    h, radius = hertz(case), case["gap_radius1"]
    assert_close(
        s.pressure, np.roll(centred.pressure, (j, i), (0, 1)), 1e-5
    )  # 1e-8 on u; p is its derivative over a cell
    assert s["rot_y"] == pytest.approx(shift[0] / radius, rel=1e-5)
    assert s["rot_x"] == pytest.approx(-shift[1] / radius, rel=1e-5)
    # the approach is of the origin, now beside the contact
    assert s["disp_z"] == pytest.approx(centred["disp_z"] - np.dot(shift, shift) / 2 / radius, rel=1e-6)
    assert h.radius + max(map(abs, shift)) < 45 * 2e-5


def test_moment_signs(solve):
    s = solve(ball(80, load_mx=0.02, load_my=0.03))
    assert np.sum(s.yy * s.pressure) < 0 < np.sum(s.xx * s.pressure)
    assert s["rot_x"] > 0 and s["rot_y"] > 0


@pytest.mark.parametrize("center", [(13, -9), (0.25, 0.4), (-300, 0)], ids=str)
def test_grid_centre_does_not_change_the_physics(solve, center):
    """The sphere stays at the origin, or goes there by moments about it, wherever the grid is."""
    d = 2e-5
    case = dict(ball(0), grid_n=(90, 84), grid_size=(90 * d, 84 * d), load_tx=25.0, load_mz=1e-3, load_my=0.01)
    x, y = center[0] * d, center[1] * d
    if abs(center[0]) < 100:  # other cells over the same contact
        s, reference = solve(dict(case, grid_center=(x, y))), solve(case)
        assert s.x.mean() == pytest.approx(x, rel=1e-12) and s.y.mean() == pytest.approx(y, rel=1e-12)
        if isinstance(center[0], int):
            for name in ("pressure", "shear_x", "shear_y"):
                mine, other = getattr(s, name), getattr(reference, name)
                assert_close(mine[9:, :-13], other[:-9, 13:], 1e-5, name, np.abs(reference.pressure).max())
        for name in ("disp_z", "disp_x", "rot_y", "rot_z", "contact_area"):
            assert s[name] == pytest.approx(reference[name], rel=5e-3), name  # another grid's error
    else:  # the whole contact moves far away by a moment, with the forces' moments about the origin
        reference = solve(dict(case, load_my=0.0))
        s = solve(dict(case, grid_center=(x, y), load_my=180.0 * x, load_mz=1e-3 - y * 25.0))
        for name in ("pressure", "shear_x", "shear_y"):
            assert_close(getattr(s, name), getattr(reference, name), 1e-5, name, reference.pressure.max())
        assert s["rot_z"] == pytest.approx(reference["rot_z"], rel=1e-5)
        assert s["disp_y"] == pytest.approx(
            reference["disp_y"] - x * reference["rot_z"], rel=1e-4, abs=1e-6 * reference["disp_x"]
        )
