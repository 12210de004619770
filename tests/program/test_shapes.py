"""Shapes of engineers: bodies at an angle, pads and rollers of finite length, a pin in a bore; against closed forms."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from petsam.closed.plane import contact_under_moment, plane_pressure
from petsam.closed.punch import Punch
from support import assert_same

YOUNG, NU = 210e9, 0.3
E_STAR = YOUNG / 2 / (1 - NU**2)
STEEL = dict(body1_young=YOUNG, body2_young=YOUNG, body1_poisson=NU, body2_poisson=NU, output_fields="all")
INF = float("inf")


def relative(r1x, r1y, r2x, r2y, angle):
    """Principal relative curvatures, the smaller one first, and the angle of its direction, by an eigenproblem."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    turn = np.array([[c, -s], [s, c]])
    curvature, axes = np.linalg.eigh(np.diag([1 / r1x, 1 / r1y]) + turn @ np.diag([1 / r2x, 1 / r2y]) @ turn.T)
    return *curvature, np.arctan2(axes[1, 0], axes[0, 0])


def elliptic_hertz(load, least, most):
    """Half axes, along the smaller curvature first, peak pressure, approach: Johnson, eqs 4.25 to 4.30."""

    def ratio(q):  # of the curvatures, for b/a = q
        m = 1 - q * q
        return (ellipk(m) - ellipe(m)) / (ellipe(m) / q**2 - ellipk(m)) - least / most

    q = brentq(ratio, 1e-4, 1 - 1e-9) if least < most * (1 - 1e-9) else 1.0
    m = 1 - q * q
    a = (3 * load * ellipe(m) / (np.pi * q * q * E_STAR * (least + most))) ** (1 / 3)
    p0 = 1.5 * load / (np.pi * a * a * q)
    return a, a * q, p0, p0 * a * q * ellipk(m) / E_STAR


@pytest.mark.parametrize(
    "radii, angle",
    [
        ((0.1, INF, 0.1, INF), 90.0),
        ((0.1, INF, 0.04, INF), 35.0),
        ((0.1, 0.3, 0.2, 0.05), -60.0),
        ((0.02, 0.02, INF, -0.021), 0.0),
        ((0.02, 0.02, INF, -0.03), 20.0),
    ],
    ids=["crossed cylinders", "inclined cylinders", "ellipsoids", "ball in a groove", "turned groove"],
)
def test_curved_bodies_are_elliptic_hertz(solve, radii, angle):
    load = 300.0
    least, most, direction = relative(*radii, angle)
    a, b, p0, approach = elliptic_hertz(load, least, most)
    names = ("gap_radius1_x", "gap_radius1_y", "gap_radius2_x", "gap_radius2_y")
    given = {name: value for name, value in zip(names, radii) if value != INF}  # inf is the default
    c, s = np.cos(direction), np.sin(direction)
    size = (2.6 * np.hypot(a * c, b * s), 2.6 * np.hypot(a * s, b * c))
    n = 160 if b > 0.3 * a else 320
    case = dict(STEEL, gap_type="curved", **given, gap_angle=angle, load_n=load, grid_n=n, grid_size=size)
    r = solve(case)
    along, across = c * r.xx + s * r.yy, c * r.yy - s * r.xx
    exact = p0 * np.sqrt(np.clip(1 - (along / a) ** 2 - (across / b) ** 2, 0, None))
    assert np.linalg.norm(r.pressure - exact) / np.linalg.norm(exact) <= 1e-2
    assert r["pressure_max"] == pytest.approx(p0, rel=2e-3)
    assert r["contact_area"] == pytest.approx(np.pi * a * b, rel=3e-3)
    assert r["disp_z"] == pytest.approx(approach, rel=2e-3)
    assert not r.run.complaint, r.run.complaint  # the contact that was estimated is that which was found


def test_equal_crossed_cylinders_are_a_ball_on_a_flat(solve):
    case = dict(STEEL, load_n=300.0, grid_n=64, grid_size=2e-3, normal_rtol=1e-11)
    crossed = solve(dict(case, gap_type="curved", gap_radius1_x=0.1, gap_radius2_x=0.1, gap_angle=90.0))
    assert_same(crossed, solve(dict(case, gap_type="sphere", gap_radius1=0.1, gap_radius2=INF)), 1e-9)


PIN = dict(STEEL, elasticity="plane", gap_type="curved", gap_radius1_x=0.01, gap_radius2_x=-0.01005, grid_n=400)


def test_pin_in_a_bore(solve):
    """Within the limit of half-spaces it is a cylinder of the relative radius; beyond, the run says so."""
    radius, load = 1 / (1 / 0.01 - 1 / 0.01005), 2e4
    a = np.sqrt(4 * load * radius / np.pi / E_STAR)
    r = solve(dict(PIN, load_n=load, grid_size=3 * a))
    assert a < 0.1 * 0.01
    assert r["contact_area"] == pytest.approx(2 * a, rel=1e-3)
    assert r["pressure_max"] == pytest.approx(2 * load / np.pi / a, rel=1e-3)
    assert not r.run.complaint
    wide = solve(dict(PIN, load_n=4 * load, grid_size=6 * a))
    assert any("contact too large" in line and "-gap_radius1_x 0.01" in line for line in wide.run.complaint)


PAD = dict(STEEL, gap_type="pad", gap_half_flat_x=5e-4, gap_edge_radius_x=0.02, friction=0.4)


def test_pad_in_plane_strain_is_the_rounded_punch(solve):
    case = dict(PAD, elasticity="plane", load_n=3e5, load_tx=5e4, grid_n=300, grid_size=2.4e-3)
    punch = dict(case, gap_type="punch", gap_half_flat_x=None, gap_edge_radius_x=None)
    assert_same(solve(case), solve(dict(punch, gap_flat_radius=5e-4, gap_edge_radius=0.02)), 0)


def test_middle_of_a_long_pad_is_in_plane_strain(solve):
    """Its pressure is Ciavarella's under the local load per length; rounded ends have a finite peak."""
    case = dict(
        PAD, gap_half_flat_y=8e-3, gap_edge_radius_y=0.3, load_n=4e3, grid_n=(64, 150), grid_size=(1.6e-3, 24e-3)
    )
    r = solve(case)
    middle = r.pressure[75]
    dx = r.x[1] - r.x[0]
    punch = Punch(5e-4, 0.02, E_STAR)
    exact = plane_pressure(r.x, punch, contact_under_moment(punch, middle.sum() * dx))
    assert r["contact_area"] > 0.016 * 1e-3
    assert abs(r.pressure - r.pressure[::-1]).max() < 1e-6 * middle.max()
    assert abs(middle - exact).max() < 0.06 * middle.max()
    assert r.pressure.max() < 1.5 * middle.max()


def test_pad_without_flats_is_an_ellipsoid(solve):
    case = dict(STEEL, load_n=300.0, grid_n=64, grid_size=2e-3, normal_rtol=1e-11)
    pad = solve(dict(case, gap_type="pad", gap_edge_radius_x=0.05, gap_edge_radius_y=0.1))
    assert_same(pad, solve(dict(case, gap_type="ellipsoid", gap_radius_x=0.05, gap_radius_y=0.1)), 1e-9)


def test_turned_pad_is_the_pad_turned(solve):
    case = dict(STEEL, gap_type="pad", load_n=500.0, grid_n=(60, 80), grid_size=(3e-3, 4e-3), normal_rtol=1e-11)
    sides = dict(gap_half_flat_x=4e-4, gap_half_flat_y=9e-4, gap_edge_radius_x=0.03, gap_edge_radius_y=0.05)
    swap = {name[:-1] + ("y" if name[-1] == "x" else "x"): value for name, value in sides.items()}
    one = solve(dict(case, **sides))
    other = solve(dict(case, **swap, grid_n=(80, 60), grid_size=(4e-3, 3e-3)))
    assert abs(one.pressure - other.pressure.T).max() < 1e-8 * one.pressure.max()


def test_lundbergs_roller_bears_evenly_along_its_length(solve):
    """With the crown of its load as a line contact, up to near the ends; with little crown there is a peak there."""
    radius, half, line = 0.01, 5e-3, 2e5
    a = np.sqrt(4 * line * radius / np.pi / E_STAR)
    case = dict(
        STEEL,
        gap_type="roller",
        gap_roller_radius=radius,
        gap_roller_half_length=half,
        gap_roller_drop=2e-5,
        load_n=line * 2 * half,
        grid_n=(48, 220),
        grid_size=(4 * a, 11e-3),
    )
    crown = line / np.pi / E_STAR
    r = solve(dict(case, gap_roller_crown=crown))
    inner = abs(r.y) < 0.85 * half
    dx = r.x[1] - r.x[0]
    per_length = r.pressure.sum(1) * dx
    assert abs(per_length[inner] / line - 1).max() < 0.01
    assert r.pressure[inner].max() == pytest.approx(2 * line / np.pi / a, rel=0.01)
    part = 1 - np.exp(-2e-5 / crown)
    separation = r.gap - (r.displacement_z - r["disp_z"])
    height = r.xx**2 / 2 / radius - crown * np.log(1 - part * np.minimum(abs(r.yy) / half, 1) ** 2)
    inside = abs(r.yy) < half
    assert abs(separation - height)[inside].max() < 1e-6 * height[inside].max()
    straight = solve(dict(case, gap_roller_crown=crown / 10))
    assert r.pressure.max() < 1.2 * r.pressure[110].max() and straight.pressure.max() > 2 * r.pressure[110].max()
