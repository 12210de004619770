"""Fields against closed solutions: Hertz, Cattaneo and Mindlin, Lubkin, elliptic contact; symmetries, similarity.

Numbers, such as radii and displacements, are those of test_reference.py.
"""

import numpy as np
import pytest

from support import assert_close, assert_same, ball, bodies, closed, elliptic_hertz, hertz, l2, slide_limit

EXACT = dict(young=110e9, poisson=0.0)  # Cattaneo and Mindlin are exact for nu = 0 only


def cattaneo(n, ratio, **more):
    case = ball(n, **EXACT)
    return dict(case, load_tx=ratio * slide_limit(case)[0], **more)


def cattaneo_numbers(case, ratio):
    h, nu = hertz(case), case["body1_poisson"]
    g = closed.shear_modulus(case["body1_young"], nu)
    return (
        h.radius,
        closed.cattaneo_stick_radius(ratio, h.radius),
        case["friction"] * h.pressure,
        closed.tangential_compliance(g, nu, g, nu),
    )


# ---- normal


def pressure_error(solve, case):
    h, s = hertz(case), solve(case)
    return l2(s.pressure, closed.hertz_pressure(s.r, h.radius, h.pressure))


def test_pressure_error_falls_with_the_grid(solve):
    errors = [pressure_error(solve, ball(n)) for n in (64, 128, 256, 512)]
    # order 1 to 1.5 (the edge's square root), with a scatter from where the cells lie
    assert all(fine <= 0.75 * coarse for coarse, fine in zip(errors, errors[1:])), errors


def test_pressure_is_hertz_at_512(solve):
    assert pressure_error(solve, ball(512)) <= 1e-3  # method.md measured 9.0e-4


@pytest.mark.parametrize(
    "pair",
    [
        dict(**bodies(3e6, 0.5, 9e6, 0.5), gap_radius1=0.02, gap_radius2=0.03, load_n=2.0),
        dict(body1_young=float("inf"), body1_poisson=None, body2_young=2e9, body2_poisson=0.5, load_n=40.0),
        dict(body1_young=210e9, body1_poisson=0.28, body2_young=70e9, body2_poisson=0.36, load_n=500.0, friction=0),
        dict(gap_radius1=float("inf"), gap_radius2=0.011, body1_poisson=-0.4, body2_poisson=-0.4),
    ],
    ids=["rubber", "rigid", "dissimilar", "auxetic"],
)
def test_other_pairs_are_hertz(solve, pair):
    case = dict(ball(255), **pair)
    h = hertz(dict(case, body1_poisson=case["body1_poisson"] or 0.0))
    s = solve(dict(case, grid_size=3 * h.radius))
    # 512 cells have 1e-3; half of them twice that with a margin for where the cells lie
    assert l2(s.pressure, closed.hertz_pressure(s.r, h.radius, h.pressure)) <= 3e-3
    assert s["disp_z"] == pytest.approx(h.approach, rel=2e-3)


def test_ellipsoid_is_elliptic_hertz(solve):
    case = dict(ball(), gap_type="ellipsoid", gap_radius1=None, gap_radius2=None, gap_radius_x=0.09, gap_radius_y=0.02)
    e_star = closed.effective_modulus(72e9, 0.34, 72e9, 0.34)
    a, b, p0, approach = elliptic_hertz(case["load_n"], 0.09, 0.02, e_star)
    s = solve(dict(case, grid_n=(300, 230), grid_size=(3 * a, 2.8 * b)))
    exact = p0 * np.sqrt(np.clip(1 - (s.xx / a) ** 2 - (s.yy / b) ** 2, 0, None))
    assert l2(s.pressure, exact) <= 4e-3  # a fifth of a cell at the edge
    assert s.pressure.max() == pytest.approx(p0, rel=1e-3)
    assert s["contact_area"] == pytest.approx(np.pi * a * b, rel=5e-3)
    assert s["disp_z"] == pytest.approx(approach, rel=1e-3)


def test_result_does_not_depend_on_half_width(solve):
    """The half-space has no boundary: the same cells on a wider grid give the same pressure."""
    narrow, wide = solve(ball(90, 1.5)), solve(ball(150, 2.5))
    assert_close(wide.pressure[30:-30, 30:-30], narrow.pressure, 1e-6)  # solver's 1e-8 times the condition of p in u


def test_similar_contacts_scale(solve):
    """Lengths by s and forces by s^2 leave tractions as they are: nothing in the program has a size of its own.

    Powers of two do not round.
    """
    case = dict(ball(61), load_my=0.01e-3, load_tx=30.0, load_mz=1e-3)
    reference = solve(case)
    for s in (2.0**-20, 2.0**13):
        small = dict(
            case,
            **{name: case[name] * s for name in ("gap_radius1", "grid_size")},
            **{name: case[name] * s**2 for name in ("load_n", "load_tx")},
            **{name: case[name] * s**3 for name in ("load_my", "load_mz")},
        )
        other = solve(small)
        assert_same(other, reference, 0, ("pressure", "shear_x", "shear_y"))
        assert_close(other.slip_x / s, reference.slip_x, 0)


def test_softer_bodies_scale(solve):
    """Moduli and forces by s leave displacements as they are.

    s is no power of two, so rounding differs, and with it what the tolerances leave.
    """
    case = dict(ball(61), load_tx=30.0, normal_rtol=1e-11, tangential_rtol=1e-9)
    reference = solve(case)
    for s in (1e-9, 1e9):
        other = solve(dict(case, **{k: case[k] * s for k in ("body1_young", "body2_young", "load_n", "load_tx")}))
        assert_same(other, reference, 1e-9, ("gap", "slip_x", "slip_y", "displacement_z"))


# ---- tangential force


@pytest.mark.parametrize(
    "ratio, limit", [(0.3, 5e-3), (0.6, 2.5e-3), (0.9, 1.5e-3)]
)  # method.md: 3.8e-3, 1.9e-3, 1.1e-3
def test_shear_is_cattaneo_at_512(solve, ratio, limit):
    case = cattaneo(512, ratio)
    a, c, mu_p0, _ = cattaneo_numbers(case, ratio)
    s = solve(case)
    assert l2(s.shear_x, closed.cattaneo_shear(s.r, a, c, mu_p0)) <= limit


@pytest.mark.parametrize("ratio", [0.6, 0.9])
def test_slip_is_mindlin(solve, ratio):
    case = cattaneo(512, ratio)
    a, c, mu_p0, compliance = cattaneo_numbers(case, ratio)
    s = solve(case)
    inside = s.r < a - s.dx
    exact = closed.cattaneo_slip(s.r, a, c, mu_p0, compliance)
    # of the rigid displacement, of which slip is a difference
    assert_close(s.slip_x[inside], exact[inside], 1e-3, scale=s["disp_x"])
    assert np.all(s.slip_x[inside & (s.r > c + s.dx)] < 0)


def test_dissipated_energy_is_work_of_slip(solve):
    """Of the bound where cells slip; the solver leaves others a little slip, against their shear."""
    case = cattaneo(256, 0.6)
    s = solve(case)
    bound, size = case["friction"] * s.pressure, np.hypot(s.shear_x, s.shear_y)
    slides = (s.pressure > 0) & (size > bound * (1 - 1e-9))
    work = np.sum((bound * np.hypot(s.slip_x, s.slip_y))[slides]) * s.area
    assert s["dissipated_energy"] == pytest.approx(work, rel=1e-12, abs=0)
    against = -np.sum((s.shear_x * s.slip_x + s.shear_y * s.slip_y)[s.pressure > 0]) * s.area
    assert against == pytest.approx(work, rel=1e-6, abs=0) and work > 0


@pytest.mark.parametrize(
    "more", [dict(load_tx=30.0), dict(load_tx=30.0, load_mz=1.5e-3, load_my=0.02)], ids=["tx", "all"]
)
def test_other_direction_gives_transposed_fields(solve, more):
    """The mirror x <-> y: T_x becomes T_y, M_y becomes -M_x, M_z changes sign."""
    case = ball(**more)
    size = case["grid_size"]
    one = solve(dict(case, grid_n=(83, 96), grid_size=(size, 1.1 * size)))
    two = solve(
        dict(
            case,
            grid_n=(96, 83),
            grid_size=(1.1 * size, size),
            load_tx=None,
            load_ty=more["load_tx"],
            load_my=None,
            load_mx=-more.get("load_my", 0.0),
            load_mz=-more.get("load_mz", 0.0),
        )
    )
    pairs = [("pressure", "pressure"), ("gap", "gap"), ("displacement_z", "displacement_z")]
    pairs += [(f"{k}_{d}", f"{k}_{e}") for k in ("shear", "slip", "displacement") for d, e in ("xy", "yx")]
    for x, y in pairs:
        scale = max(
            np.abs(getattr(one, x)).max(),
            np.abs(getattr(one, x[:-2] + "_x")).max() if x[-2] == "_" and x[-1] != "z" else 0,
        )
        assert_close(getattr(two, y).T, getattr(one, x), 1e-6, x, scale)  # the solvers' paths differ: their tolerance
    assert two["disp_y"] == pytest.approx(one["disp_x"], rel=1e-6, abs=0)


def test_opposite_force_gives_opposite_shear(solve):
    one, two = solve(ball(70, load_tx=30.0, load_ty=8.0)), solve(ball(70, load_tx=-30.0, load_ty=-8.0))
    for name in ("shear_x", "shear_y", "slip_x", "displacement_x"):
        assert_close(getattr(two, name), -getattr(one, name), 1e-9, name, np.abs(getattr(one, name[:-1] + "x")).max())


def test_positive_force_gives_positive_displacement(solve):
    s = solve(ball(70, load_tx=30.0, load_ty=8.0, load_mz=1e-3))
    assert s["disp_x"] > 0 and s["disp_y"] > 0 and s["rot_z"] > 0 and s["disp_z"] > 0


def test_shear_has_a_small_cross_component(solve):
    """With nu > 0 the directions couple: |q_y| reaches about 5 % of |q_x| at nu = 0.3 (method.md)."""
    s = solve(ball(128, poisson=0.3, load_tx=0.6 * 0.27 * 180))
    assert 0.01 <= np.abs(s.shear_y).max() / np.abs(s.shear_x).max() <= 0.1


# ---- torque


def torsion(n, ratio):
    case = ball(n)
    return dict(case, load_mz=ratio * slide_limit(case)[1])


@pytest.mark.parametrize("ratio", [0.4, 0.7, 0.92])
def test_torsion_shear_is_lubkin(solve, ratio):
    case = torsion(512, ratio)
    h, s = hertz(case), solve(case)
    around = (s.xx * s.shear_y - s.yy * s.shear_x) / s.r
    c = closed.lubkin_stick_radius(ratio, h.radius)
    assert l2(around, closed.lubkin_shear(s.r, h.radius, c, case["friction"] * h.pressure)) <= 5e-3  # as Cattaneo's
