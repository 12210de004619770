"""Steady rolling: published numbers of CONTACT, Kalker's coefficients, limits of fine grids, and what is refused."""

import h5py
import numpy as np
import pytest

from support import history

G, NU = 82e9, 0.28
YOUNG = 2 * G * (1 + NU)


def integrals(k2):
    """Complete elliptic integrals K and E of the squared modulus, by the arithmetic-geometric mean."""
    a, b, c, total, power = 1.0, np.sqrt(1 - k2), np.sqrt(k2), 1 - k2 / 2, 0.5
    while abs(c) > 1e-16:
        a, b, c = (a + b) / 2, np.sqrt(a * b), (a - b) / 2
        power *= 2
        total -= power * c * c
    return np.pi / (2 * a), np.pi / (2 * a) * total


def ellipse(a=1e-3, ratio=1.0, p0=800e6, poisson=NU, n=64, width=2.3, **more):
    """Similar bodies, a contact of half axes a along x and a/ratio along y, of greatest pressure p0."""
    young, b = 2 * G * (1 + poisson), a / ratio
    short, long = min(a, b), max(a, b)
    e_star = young / 2 / (1 - poisson**2)
    K, E = integrals(1 - (short / long) ** 2)
    if short == long:
        radii = [2 * a * e_star / (np.pi * p0)] * 2
    else:
        e2 = 1 - (short / long) ** 2
        across = 2 * p0 / (e_star * short * e2) * (E - (short / long) ** 2 * K)
        along = 2 * p0 * short / (e_star * long**2 * e2) * (K - E)
        radii = [1 / across, 1 / along] if a < b else [1 / along, 1 / across]
    return dict(
        dict(
            rolling="steady",
            body1_young=young,
            body2_young=young,
            body1_poisson=poisson,
            body2_poisson=poisson,
            friction=0.3,
            gap_type="ellipsoid",
            gap_radius_x=float(radii[0]),
            gap_radius_y=float(radii[1]),
            load_n=2 / 3 * np.pi * p0 * a * b,
            grid_n=n,
            grid_size=(width * a, width * b),
        ),
        **more,
    )


U = 0.3 * 800e6 / G  # creepage at which case S begins to slide, about


def relative(s, case, name, arm=None):
    """A load over mu N, or mu N times an arm."""
    return float(s[name]) / (case["friction"] * case["load_n"] * (arm or 1))


def fine(s, case, name, arm=None):
    return relative(s, case, f"{name}_extrapolated", arm)


# ---- numbers of CONTACT

A = dict(
    ellipse(),
    friction=0.33,
    load_n=106.7e3,
    gap_radius_x=0.625,
    gap_radius_y=0.625 * 2.842757,
    grid_n=(48, 44),
    grid_size=(2.2 * 6.3036e-3, 2.2 * 12.6072e-3),
    creep_y=0.0,
    creep_spin=0.0,
)


@pytest.mark.parametrize(
    "creep, load, power, stick",
    [
        (1e-5, 0.007015, None, None),
        (4e-4, 0.2588, None, None),
        (8e-4, 0.4742, None, None),
        (1.2e-3, 0.6482, 256.1, 782),
        (1.6e-3, 0.7831, 419.6, 596),
        (2e-3, 0.8816, 596.4, 422),
    ],
)
def test_traction_curve(solve, creep, load, power, stick):
    s = solve(A, dict(creep_x=creep))
    assert s["contact_cells"] == 1384
    assert relative(s, A, "load_tx") == pytest.approx(load, abs=6e-5 if load > 0.1 else 6e-7)
    if power:
        assert 10 * s["rolling_energy_cells"] == pytest.approx(power, rel=3e-4)
        assert abs(s["stick_cells"] - stick) <= 2


B = dict(
    ellipse(),
    body1_young=2.56,
    body2_young=2.56,
    friction=0.4013,
    load_n=0.4705,
    gap_radius_x=1 / 0.005926,
    gap_radius_y=1 / 0.005926,
    grid_n=41,
    grid_size=8.2,
    creep_x=0.00304,
    creep_y=0.0,
    creep_spin=0.0,
)


def test_cattaneo_to_carter_bodies(solve):
    s = solve(B)
    assert s["load_tx"] == pytest.approx(0.12208, abs=1e-5)
    assert abs(s["stick_cells"] - 555) <= 1
    assert s["rolling_energy_cells"] == pytest.approx(3.405e-4, rel=3e-4)
    assert s["rolling_energy"] == pytest.approx(0.00304 * s["load_tx"], rel=1e-12)


def test_friction_field(solve, tmp_path):
    with h5py.File(tmp_path / "mu.h5", "w") as f:
        f["friction"] = np.repeat(0.2 + 0.01 * np.arange(41)[:, None], 51, axis=1)
    case = dict(B, friction=None, friction_file=tmp_path / "mu.h5", grid_n=(51, 41), grid_size=(10.2, 8.2))
    s = solve(case)
    assert s["load_tx"] == pytest.approx(0.1206, abs=1e-4)
    assert s["load_ty"] == pytest.approx(3.864e-4, abs=4e-6)
    assert s["load_mz"] == pytest.approx(-0.01946, abs=2e-4)
    assert abs(s["stick_cells"] - 534) <= 2


def test_spin_and_creepages(solve):
    case = ellipse()
    spin = U / 1e-3
    s = solve(case, dict(creep_x=0.5 * U, creep_y=0.5 * U, creep_spin=spin))
    for name, expected in (("load_tx", 0.4257), ("load_ty", 0.7946)):
        assert relative(s, case, name) == pytest.approx(expected, abs=1e-4)
    assert relative(s, case, "load_mz", 1e-3) == pytest.approx(0.1962, abs=1e-4)


@pytest.mark.parametrize("n, load", [(64, 0.505392), (128, 0.502350), (256, 0.501033)])
def test_sphere(solve, n, load):
    case = ellipse(n=n)
    s = solve(case, dict(creep_x=0.3 * U, creep_y=0.0, creep_spin=0.0))
    assert relative(s, case, "load_tx") == pytest.approx(load, abs=1e-5)
    assert s["tangential_applies"] <= 30


# ---- limits of fine grids


@pytest.mark.parametrize(
    "ratio, creep, expected",
    [
        (1, (0.3, 0, 0), dict(load_tx=(0.4997, 2e-4))),
        (1, (1, 0, 0), dict(load_tx=(0.9828, 2e-4))),
        (1, (0, 0, 2), dict(load_ty=(0.5240, 1.2e-3), load_mz=(0.4482, 1e-3))),
        (0.3, (0.3, 0, 0), dict(load_tx=(0.4392, 4e-4))),
        (0.3, (0, 0.3, 0), dict(load_ty=(0.3510, 8e-4), load_mz=(-0.0728, 6e-4))),
    ],
)
def test_extrapolated_loads(solve, ratio, creep, expected):
    case = ellipse(n=256, ratio=ratio)
    s = solve(case, dict(creep_x=creep[0] * U, creep_y=creep[1] * U, creep_spin=creep[2] * U / 1e-3))
    for name, (value, tolerance) in expected.items():
        arm = 1e-3 / np.sqrt(ratio) if name == "load_mz" else None
        assert fine(s, case, name, arm) == pytest.approx(value, abs=tolerance), name


def test_without_extrapolation_the_loads_are_the_same(solve):
    """The solution on half the cells is left out, and nothing is said about it."""
    case = dict(ellipse(n=27), creep_x=0.5 * U, creep_y=0.4 * U)
    both, alone = solve(case), solve(case, dict(extrapolate="false"))
    assert np.isnan(alone["load_tx_extrapolated"]) and np.isfinite(both["load_tx_extrapolated"])
    assert alone["load_tx"] == both["load_tx"]
    assert "_extrapolated = " in both.run.stderr and "_extrapolated = " not in alone.run.stderr


def test_small_grids_are_extrapolated(solve):
    """A spin that is found for M_z = 0, on a contact of twenty cells: 10 % off, and told so."""
    creep = dict(creep_x=0.5 * U, creep_y=0.4 * U)
    coarse, right = solve(ellipse(n=27), creep), float(solve(ellipse(n=216), creep)["creep_spin_extrapolated"])
    assert abs(coarse["creep_spin"] / right - 1) > 0.06
    assert abs(coarse["creep_spin_extrapolated"] / right - 1) < 0.04
    assert "error by the cells: creep_spin 14 %" in coarse.run.stderr


@pytest.mark.parametrize(
    "ratio, poisson, table",
    [
        (1, 0.0, (3.40, 3.40, 1.33, 1.21)),
        (1, 0.25, (4.12, 3.67, 1.47, 1.19)),
        (1, 0.5, (5.20, 3.98, 1.63, 1.16)),
        (0.3, 0.25, (3.44, 2.75, 0.715, 2.96)),
    ],
)
def test_kalkers_coefficients(solve, ratio, poisson, table):
    case = ellipse(n=96, ratio=ratio, poisson=poisson, friction=1e4)
    area = 1e-6 / ratio
    unit = case["friction"] * case["load_n"]
    found = []
    for creep in np.eye(3) * 1e-5:
        s = solve(case, dict(creep_x=float(creep[0]), creep_y=float(creep[1]), creep_spin=float(creep[2] * 1e3)))
        found.append([fine(s, case, name) * unit for name in ("load_tx", "load_ty", "load_mz")])
    found = np.array(found) / (G * area * 1e-5)
    arm = np.sqrt(area)
    coefficients = found[0, 0], found[1, 1], found[2, 1] / (1e3 * arm), found[2, 2] / (1e3 * area)
    assert coefficients == pytest.approx(table, rel=0.015)
    assert -found[1, 2] / arm == pytest.approx(coefficients[2], rel=1e-3)  # C32 = C23


@pytest.mark.parametrize(
    "given",
    [
        dict(creep_x=0.3, creep_y=-0.3, creep_spin=0.5),
        dict(load_tx=0.3, creep_y=-0.3, creep_spin=0.5),
        dict(creep_x=0.3, load_ty=-0.1, creep_spin=0.5),
        dict(creep_x=0.3, creep_y=-0.3, load_mz=0.2),
        dict(load_tx=0.3, load_ty=0.2, load_mz=0.2),
    ],
    ids=str,
)
def test_loads_and_creepages_belong_together_however_they_are_given(solve, given):
    """A moment with a creepage along y is the one pair of which neither is known where spin is taken."""
    case = ellipse(n=40, tangential_rtol=1e-7)
    force = case["friction"] * case["load_n"]
    unit = dict(creep_x=U, creep_y=U, creep_spin=U / 1e-3, load_tx=force, load_ty=force, load_mz=force * 1e-3)
    one = solve(case, {name: value * unit[name] for name, value in given.items()})
    again = solve(case, {name: float(one[name]) for name in ("creep_x", "creep_y", "creep_spin")})
    for name in ("load_tx", "load_ty", "load_mz"):
        assert again[name] == pytest.approx(one[name], abs=1e-5 * unit[name]), name
    for name, value in given.items():
        assert one[name] == pytest.approx(value * unit[name], rel=1e-9)


@pytest.mark.parametrize(
    "spin, load, moment",
    [(0.5, 0.974280, 0.101910), (1, 0.883574, 0.220894), (2, 0.552233, 0.455593), (4, 0.289923, 0.553097)],
)
def test_full_sliding(solve, spin, load, moment):
    case = ellipse(n=96)
    s = solve(case, dict(creep_x=300 * U, creep_y=0.0, creep_spin=spin * 300 * U / 1e-3))
    assert relative(s, case, "load_tx") == pytest.approx(load, abs=2e-3)
    assert relative(s, case, "load_mz", 1e-3) == pytest.approx(moment, abs=2e-3)


def test_cylinders(solve):
    """Two rows of long cells: Carter."""
    case = dict(
        ellipse(),
        load_n=35.78e3,
        gap_radius_x=0.5,
        gap_radius_y=float("inf"),
        grid_n=(55, 2),
        grid_size=(2.2e-3, 0.2),
        grid_center=(3e-5, 0.0),
        allow_edge_contact=True,
    )
    s = solve(case, dict(creep_x=2.4e-4, creep_y=0.0, creep_spin=0.0))
    assert relative(s, case, "load_tx") == pytest.approx(0.6480, abs=1e-3)
    assert s["stick_cells"] == 60
    assert s["contact_cells"] == 100


@pytest.mark.parametrize("n", [40, 57])
@pytest.mark.parametrize(
    "given",
    [
        dict(creep_x=1e3),
        dict(creep_spin=1e4),
        dict(creep_spin=1e6),
        dict(creep_x=1e3, creep_y=1e6, creep_spin=1e9),
        dict(creep_x=1e3, load_ty=200.0),
        dict(load_tx=150.0, creep_y=1.0, creep_spin=1e4),
        dict(load_n=1e-12, creep_x=1e-3),
        dict(load_n=1e-12, creep_x=1e-9, creep_spin=1.0),
    ],
)
def test_fast_sliding(solve, n, given):
    """Shear hardly changes the slip: each cell's is its bound against the creepage there."""
    case = dict(ellipse(n=n, output_fields="all"), **given)
    s = solve(case)
    assert s["tangential_applies"] <= 8
    assert "rotation" not in s.run.stderr  # a spin is none
    x, y = np.meshgrid(s.x, s.y)
    creeps = [float(s[f"creep_{name}"]) for name in ("x", "y", "spin")]
    slip = np.stack([creeps[0] - creeps[2] * y, creeps[1] + creeps[2] * (x + s.dx / 6)])
    size = np.hypot(*slip)
    bound, shear = 0.3 * s.pressure, np.stack([s.shear_x, s.shear_y])
    assert np.all(np.hypot(*shear) <= (1 + 1e-12) * bound)
    most = bound.max()
    far = (bound > 0) & (size > 100 * most / G)
    assert far.sum() >= 0.9 * (bound > 0).sum()
    error = np.hypot(*(shear - bound * slip / np.maximum(size, 1e-300)))
    assert np.all(error[far] <= (1e-5 + 10 * most / G / size[far]) * most)


@pytest.mark.parametrize("given", [dict(creep_x=1e160), dict(creep_spin=1e300), dict(tangential_max_it=3)])
def test_no_shear_beyond_its_bound_is_left(solve, given):
    s = solve(dict(ellipse(n=40, creep_x=0.3 * U, output_fields="all"), **given), check=10)
    assert np.all(np.hypot(s.shear_x, s.shear_y) <= (1 + 1e-12) * 0.3 * s.pressure)


# ---- loads, histories, ranks


@pytest.mark.parametrize("ratio", [1, 3])
@pytest.mark.parametrize("n", [64, 256])
def test_given_loads(solve, n, ratio):
    case = ellipse(n=n, ratio=ratio)
    force = case["friction"] * case["load_n"]
    s = solve(case, dict(load_tx=0.95 * force))
    assert s["load_tx"] == pytest.approx(0.95 * force, rel=1e-10)
    assert s["tangential_applies"] <= 40
    again = solve(case, dict(creep_x=float(s["creep_x"]), creep_y=0.0, creep_spin=0.0))
    assert relative(again, case, "load_tx") == pytest.approx(0.95, abs=5e-6)
    extrapolated = float(s["creep_x_extrapolated"])
    assert 1 < extrapolated / s["creep_x"] < 1.05
    assert np.isnan(s["load_tx_extrapolated"])


def test_history_of_creepages(solve, tmp_path):
    """Each row is a steady state of its own."""
    case = ellipse()
    rows = [(float(k), k * U / 4, 0.2 * k * U) for k in range(1, 5)]
    curve = solve(case, history(tmp_path / "curve.csv", "time,creep_x,creep_y", *rows), dict(load_mz=0.0))
    alone = solve(case, dict(creep_x=rows[2][1], creep_y=rows[2][2]))
    with h5py.File(curve.path) as f:
        found = {name: values[:] for name, values in f["history"].items()}
    for name in ("load_tx", "load_ty", "creep_spin", "load_tx_extrapolated", "rolling_energy"):
        assert found[name][2] == pytest.approx(alone[name], rel=2e-5, abs=1e-5)
    assert np.all(np.diff(found["load_tx"]) > 0)
    assert np.all(found["rolling_energy_cells"] < found["rolling_energy"])
    assert np.all(np.isfinite(found["load_ty_extrapolated"]))
    assert not {"disp_x", "disp_y", "rot_z", "dissipated_energy", "slip_max"} & set(found)


def test_states_near_the_last_one_start_from_it(solve, tmp_path):
    """Along the last change, across it, and under loads; what is found does not depend on it, nor on the ranks."""
    rows = [
        (0.3, 0.1, 0.5),
        (0.303, 0.1, 0.5),
        (0.306, 0.1, 0.5),
        (0.306, 0.102, 0.49),
        (0.306, 0.102, 0.49),
        (0.5, 0, 0),
    ]
    table = history(
        tmp_path / "near.csv",
        "time,creep_x,creep_y,creep_spin",
        *[(k, x * U, y * U, s) for k, (x, y, s) in enumerate(rows)],
    )
    case = ellipse()

    def found(*options, **words):
        with h5py.File(solve(case, table, *options, **words).path, "r") as f:
            return {name: data[:] for name, data in f["history"].items()}

    near, alone = found(), found(dict(warm_start="false"))
    assert near["tangential_iterations"][4] == 0  # nothing has changed
    assert np.all(near["tangential_preconditions"][1:4] < alone["tangential_preconditions"][1:4])
    assert near["tangential_preconditions"][5] == alone["tangential_preconditions"][5]  # farther away
    for name, size in ("load_tx", 1), ("load_ty", 1), ("load_mz", 1e-3), ("load_tx_extrapolated", 1):
        most = 2e-6 * case["friction"] * case["load_n"] * size
        assert near[name] == pytest.approx(alone[name], rel=0, abs=most), name
    assert np.array_equal(found(ranks=2)["load_tx"], near["load_tx"])


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("more", [{}, dict(body2_young=YOUNG / 4)], ids=["similar", "dissimilar"])
def test_restart_amid_steady_states(petsam, tmp_path, more, ranks):
    """The start of a state is made of those before, which a checkpoint has: the same bits."""
    case = dict(ellipse(n=40, width=3.2, output_fields="all"), **more)
    rows = [(k, 0.1 * U * (1 + 0.02 * k), 0.05 * case["load_n"], U * 10 * k) for k in range(1, 7)]
    case.update(history(tmp_path / "h.csv", "time,creep_x,load_ty,creep_spin", *rows))
    case.update(checkpoint="c.h5", checkpoint_every=4)
    petsam(case, dict(output="whole.h5"), ranks=ranks)
    petsam(case, dict(output="rest.h5", restart="c.h5"), ranks=ranks)
    with h5py.File(tmp_path / "whole.h5") as whole, h5py.File(tmp_path / "rest.h5") as rest:
        assert rest["history/time"].size < 6
        for name in ("shear_x", "slip_velocity_y", "pressure"):
            assert np.array_equal(whole[name][-1], rest[name][-1]), name


def test_same_bits_on_any_number_of_ranks(solve):
    case = ellipse(n=70, output_fields="all")
    runs = [solve(case, dict(load_tx=0.5 * 0.3 * case["load_n"], creep_spin=U / 1e-3), ranks=k) for k in (1, 2, 3)]
    for other in runs[1:]:
        for name in ("creep_x", "load_mz", "creep_x_extrapolated"):
            assert runs[0][name] == other[name], name
        for name in ("shear_x", "slip_velocity_y"):
            assert np.array_equal(getattr(runs[0], name), getattr(other, name)), name


def test_slip_is_against_the_shear(solve):
    case = ellipse()
    s = solve(case, dict(creep_x=0.5 * U, creep_y=0.0, creep_spin=0.0, output_fields="all"))
    q, v = np.stack([s.shear_x, s.shear_y]), np.stack([s.slip_velocity_x, s.slip_velocity_y])
    assert np.all((q * v).sum(0)[s.state == 2] <= 1e-9 * 800e6)
    assert np.abs(v[:, s.state == 1]).max() <= 1e-4 * U


@pytest.mark.parametrize("more", [{}, dict(film_thickness=1e-4, film_shear=8e9), dict(friction=1e4)])
def test_power_of_the_centred_slip_is_that_of_the_loads(solve, more):
    case = dict(ellipse(n=50, ratio=2, creep_x=0.4 * U, creep_y=-0.3 * U, creep_spin=U / 1e-3), **more)
    s = solve(case, dict(output_fields="all"))
    power = s.power_density * s.dx * s.dy
    assert power.sum() == pytest.approx(s["rolling_energy"], rel=1e-10)
    assert s["rolling_energy_cells"] < (1 - 1e-3) * power.sum()
    if more.get("friction") != 1e4:
        assert power.min() >= -1e-2 * power.max()  # where spin turns the slip


def test_wear_of_the_running_band(solve):
    """Pressure times slip along the way of a point; the slip at a cell is the mean of both its sides."""
    case = ellipse(n=50, creep_x=0.4 * U, creep_y=0.0, creep_spin=U / 1e-3, output_fields="all")
    one, two = solve(case), solve(case, ranks=2)
    ahead = [one.slip_velocity_x, one.slip_velocity_y]
    behind = [np.roll(v, 1, axis=1) for v in ahead]
    # creepage of y at the cell, and not where that slip is
    slip = (ahead[0] + behind[0]) / 2, (ahead[1] + behind[1]) / 2 - U / 1e-3 * one.dx / 3
    band = (one.pressure * np.hypot(*slip)).sum(axis=1) * one.dx
    assert np.abs(one.wear_passage - band[:, None]).max() <= 1e-12 * band.max()
    assert band.max() > 0 and np.array_equal(one.wear_passage, two.wear_passage)


@pytest.mark.parametrize("n", [64, 96])
def test_dissimilar_bodies(petsam, n):
    case = ellipse(n=n, width=3.2, friction=1.0)
    done = petsam(case, dict(body2_young=YOUNG / 10, creep_x=U, load_n=case["load_n"] / 4, output="d.h5"), "-profile")
    assert "coupling" in done.stdout


# ---- what is refused


def test_contact_at_the_trailing_edge(petsam):
    case = ellipse(n=40)
    done = petsam(case, dict(creep_x=1e-3, grid_center=(0.3e-3, 0.0)), check=12)
    assert "edge of the grid" in " ".join(done.complaint)


def test_film_far_softer_than_the_bodies_makes_a_brush(solve):
    """Shear grows along the stream by the creepage over the compliance of the film, as that of bristles does."""
    film = 1e-9
    case = ellipse(n=40, creep_x=2e-4, creep_y=-1e-4, creep_spin=0.0, friction=0.5)
    s = solve(case, dict(film_thickness=1e-3, film_shear=1e-3 / film))
    dx = s.x[1] - s.x[0]
    inside = (s.state[:, :-1] == 1) & (s.state[:, 1:] == 1)
    assert inside.sum() > 200
    for shear, creep in ((s.shear_x, 2e-4), (s.shear_y, -1e-4)):
        growth = -np.diff(shear, axis=1)[inside] / dx
        assert np.abs(growth / (creep / film) - 1).max() < 1e-2  # the bodies give way by up to this


def test_friction_by_pressure_bounds_rolling(solve):
    """Full sliding under mu (p/reference)^n: the sum of the bound by quadrature."""
    case = ellipse(n=64, creep_x=0.05, friction_law="pressure", friction_pressure_exponent=-0.5)
    s = solve(case, dict(friction_pressure_reference=4e8))
    r2 = np.linspace(0, 1, 200001)
    p = 800e6 * np.sqrt(1 - r2)
    exact = np.pi * 1e-6 * np.trapezoid(0.3 * p * np.sqrt(4e8 / np.maximum(p, 1e-3)), r2)
    assert float(s["load_tx"]) == pytest.approx(exact, rel=2e-3)


FALLING = dict(
    friction_law="falling",
    friction_falling_kinetic=0.14,
    friction_falling_half_speed=1.25,
    rolling_speed=10.0,
    friction_falling_memory=3e-6,
    friction_falling_memory_speed=1e-3,
    output_fields="all",
)


def test_falling_friction_under_a_film(solve, tmp_path):
    rows = history(tmp_path / "falling.csv", "time,creep_x", (1, 0.002), (2, 0.008), (3, 0.02), (4, 0.1))
    done = solve(A, FALLING, rows, dict(film_thickness=1.25e-3, film_shear=8.2e9))
    with h5py.File(done.path) as f:
        found = f["history/load_tx"][:] / (A["friction"] * A["load_n"])
        mean, words = f["history/friction_mean"][:], f["history/friction_mean"].attrs["long_name"]
    assert found == pytest.approx([0.3495, 0.8652, 0.9393, 0.7559], abs=6e-5)
    assert "displacement" not in done.run.stderr  # a creepage is none
    assert 0.33 > mean[0] > mean[1] > mean[2] > mean[3] > 0.14
    assert mean[3] == pytest.approx(0.33 * found[3], rel=1e-3)  # all slides
    assert "continued from rest" in words and "others may exist" in words


def test_memory_marches_from_the_leading_edge(solve):
    """mu of a cell from that of the cell ahead, t = memory/(memory + slip of a cell); at the edge from mu at rest."""
    s = solve(A, FALLING, dict(creep_x=0.1, friction_falling_memory=1e-5))
    mu, before = s.friction_coefficient, np.full(s.y.size, 0.33)
    slip = np.hypot(s.slip_velocity_x, s.slip_velocity_y)
    dx = s.x[1] - s.x[0]
    for i in reversed(range(s.x.size)):
        inside = s.pressure[:, i] > 0
        now = 0.14 + 0.19 * 2 ** (-slip[:, i] * 10 / 1.25)
        t = 1e-5 / (1e-5 + np.maximum(slip[:, i] * dx, 1e-3 * dx / 10))
        before = np.where(inside, t * before + (1 - t) * now, 0.33)
        assert mu[inside, i] == pytest.approx(before[inside], rel=1e-5)
    assert 0.14 < mu[s.pressure > 0].min() < 0.29


def test_falling_friction_on_any_number_of_ranks(solve):
    runs = [solve(A, FALLING, dict(creep_x=0.01, creep_spin=0.5), ranks=k) for k in (1, 2, 3)]
    for other in runs[1:]:
        assert runs[0]["load_tx"] == other["load_tx"] and runs[0]["friction_mean"] == other["friction_mean"]
        assert np.array_equal(runs[0].friction_coefficient, other.friction_coefficient)


def test_loads_above_falling_friction_name_creepages(petsam):
    complaint = petsam(
        A,
        FALLING,
        dict(load_tx=0.99 * 0.33 * 106.7e3, friction_falling_memory=0, friction_falling_half_speed=0.02),
        check=11,
    ).stderr
    assert "gross slip: load_tx" in complaint and "give creep_x" in complaint
