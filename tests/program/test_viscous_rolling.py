"""Bodies that relax in steady rolling: closed solutions, steps of time, limits, ranks and restarts."""

import h5py
import numpy as np
import pytest

import petsam as package
from support import bodies, few
from test_viscous import BALL, RIGID, hunter, relaxing, table

NU = 0.3
PLANE = dict(BALL, elasticity="plane", load_n=np.pi / 4, rot_y=0)
LIKE_BODY_2 = dict(body2_young=1 - NU**2, body2_poisson=NU)  # beside a rigid body E* is 1


def creeping(growth, *which):
    """Bodies, of those given, of J(t)/J(0) = 1 + growth (1 - exp(-t)): a length of 1 m at 1 m/s."""
    one = (growth / (1 + growth),), (1 / (1 + growth),)
    return {name: value for body in which for name, value in relaxing(body, *one).items()}


def rolling(speed, **more):
    return package.run(**dict(PLANE, rolling="steady", rolling_speed=speed, **more))


@pytest.mark.parametrize(
    "growth, length, error", [(1, 0.1, 3e-4), (1, 1, 3e-5), (10, 0.1, 6e-4), (10, 10, 1e-5), (100, 10, 1e-5)]
)
def test_a_cylinder_rolls_steadily_as_that_of_hunter(growth, length, error):
    """M/N and the edges of the closed form; the error falls in second order, and when it is extrapolated."""
    low, high, moment = hunter(growth, length)
    errors, left = [], []
    for cells in (96, 192):
        width = 1.25 * (high - low)
        run = rolling(
            length, **RIGID, **LIKE_BODY_2, **creeping(growth, 2), grid_n=cells, grid_size=width,
            grid_center=(low + high) / 2, output_fields="pressure",
        )  # fmt: skip
        errors.append(run["load_my"][-1] / (np.pi / 4) / moment - 1)
        places = np.nonzero(run["pressure"][-1].ravel())[0] + 0.5
        edges = (low + high - width) / 2 + (places[[0, -1]] + (-0.5, 0.5)) * width / cells
        assert edges == pytest.approx((low, high), abs=1.5 * width / cells)
        assert run["rolling_resistance"][-1] == pytest.approx(run["load_my"][-1], rel=1e-9)  # R = 1
        left.append(run["rolling_resistance_extrapolated"][-1] / (np.pi / 4) / moment - 1)
    assert abs(errors[1]) < error and 3.5 < errors[0] / errors[1] < 4.5
    assert np.all(np.abs(left) < 0.1 * np.abs(errors))


@pytest.mark.parametrize(
    "growth, length, moment, approach",
    [(1, 0.3, 0.11674, 1.57307), (1, 10, 0.064035, 1.14149), (10, 1, 0.64175, 4.75513)],
)
def test_a_ball_rolls_as_an_independent_program_found(growth, length, moment, approach):
    """M/N extrapolated, and approach: of a solver of its own with steps of a cell, 256 cells."""
    width, found = 2.4 * ((1 + growth) ** (1 / 3) if length < 10 else 1), []
    for cells in (32, 64):
        run = package.run(
            **BALL, **RIGID, **LIKE_BODY_2, **creeping(growth, 2), grid_n=cells, grid_size=width, load_n=4 / 3, rot_y=0,
            rolling="steady", rolling_speed=length, output_fields="none",
        )  # fmt: skip
        found.append(run["rolling_resistance"][-1] / (4 / 3))
    extrapolated = (4 * found[1] - found[0]) / 3
    assert extrapolated == pytest.approx(moment, rel=5e-4)
    assert run["rolling_resistance_extrapolated"][-1] / (4 / 3) == pytest.approx(extrapolated, rel=1e-5)
    assert run["disp_z"][-1] == pytest.approx(approach, rel=2e-4)


def test_contacts_contact_of_cylinders_that_relax():
    """CONTACT's example visc_cylindr: cells in contact, cells that slip, maximum pressure, creepage and power."""
    shear, nu, load = 1143e6, 0.4, 600e3
    for time, contact, slips, most, creepage, power in (
        (0.009, 62, 25, 78.74, 1.365e-2, 913.7), (0.045, 57, 21, 84.72, 1.152e-2, 952.0),
        (2, 56, 21, 85.31, 9.932e-3, 1010),
    ):  # fmt: skip
        same = {f"body{b}_{name}": v for b in (1, 2) for name, v in (("young", 2 * shear * (1 + nu)), ("poisson", nu))}
        run = package.run(
            elasticity="plane", grid_n=99, grid_size=99 * 0.16e-3, grid_center=-0.08e-3, gap_type="sphere",
            gap_radius1=0.05, gap_radius2="inf", friction=0.3, **same, **relaxing(1, (0.5,), (time / 2,)),
            **relaxing(2, (0.5,), (time / 2,)), rolling="steady", rolling_speed=1, load_n=load, rot_y=0,
            load_tx=0.6 * 0.3 * load, errors="none",
        )  # fmt: skip
        p, q = run["pressure"][-1].ravel() / 1e6, run["shear_x"][-1].ravel() / 1e6
        assert np.sum(p > 0) == contact and np.sum((p > 0) & (q > 0.3 * p * (1 - 1e-6))) == slips
        assert p.max() == pytest.approx(most, rel=2e-4)
        assert run["creep_x"][-1] == pytest.approx(creepage, rel=2e-3)
        assert run["rolling_energy_cells"][-1] == pytest.approx(power, rel=1e-3)


@pytest.mark.parametrize(
    "creepages, growth, loads",
    [
        ((0.5, 0, 0), 1, (0.62417, 0, 0)),
        ((0.5, 0, 0), 10, (0.39294, 0, 0)),
        ((0.3, 0.3, 0.5), 1, (0.32888, 0.63085, 0.27087)),
    ],
)  # fmt: skip
def test_a_ball_with_traction_rolls_as_an_independent_program_found(creepages, growth, loads):
    """T_x, T_y and M_z in units of mu N and mu N a, of 128 cells, the creepage by spin at the cells' centres."""
    load, young = 0.05, 2 * (1 + NU)
    a = (0.75 * load * (1 - NU)) ** (1 / 3)
    unit = 0.3 * 1.5 * load / (np.pi * a**2)
    run = package.run(
        **{**BALL, "friction": 0.3}, body1_young=young, body2_young=young, body1_poisson=NU, body2_poisson=NU,
        **creeping(growth, 1, 2), grid_n=128, grid_size=2.5 * a * (1 + growth) ** (1 / 3), rolling="steady",
        rolling_speed=a, load_n=load, rot_y=0, creep_x=creepages[0] * unit, creep_y=creepages[1] * unit,
        creep_spin=creepages[2] * unit / a, output_fields="none",
    )  # fmt: skip
    found = [run[name][-1] / (0.3 * load) for name in ("load_tx", "load_ty", "load_mz")]
    tolerance = 3e-5 if creepages[2] == 0 else 3e-3
    assert (found[0], found[1], found[2] / a) == pytest.approx(loads, abs=tolerance)


FORMS = {
    "alike": creeping(1, 1, 2),
    "one": creeping(2, 2),  # coupled by the creep alone
    "bulk": {**relaxing(1, (0.5, 0.2), (0.3, 0.1), True), **relaxing(2, (0.4,), (0.5,))},
}
PAIR = dict({**BALL, "friction": 0.4}, body1_young=2, body1_poisson=0.2, body2_young=2, body2_poisson=0.2, rot_y=0,
            creep_x=0.05, normal_rtol=1e-10, tangential_rtol=1e-8, coupling_rtol=1e-8)  # fmt: skip
ROW = dict(elasticity="plane", grid_n=96, grid_size=6, grid_center=-1, load_n=0.4)
GRID = dict(grid_n=(24, 16), grid_size=(4, 8 / 3), grid_center=(-0.8, 0), load_n=0.15)


@pytest.mark.parametrize("place, length, ahead", [(ROW, 0.25, 300), (GRID, 0.2, 60)], ids=["plane", "half-space"])
@few("which", FORMS, 2)
def test_steady_rolling_is_the_end_of_steps_of_a_cell(which, place, length, ahead):
    """In steps in which the bodies roll by a cell; all kernels are in use."""
    step, k = 0.0625 if place is ROW else 1 / 6, np.arange(ahead)
    steady = package.run(**PAIR, **place, **FORMS[which], rolling="steady", rolling_speed=length)
    history = {name: value + 0 * k for name, value in (("load_n", place["load_n"]), ("rot_y", 0.0))}
    history = table(time=k * step / length, **history, roll=step * (k > 0), creep_x=0.05 * (k > 0))
    case = {name: v for name, v in {**PAIR, **place}.items() if name not in ("load_n", "rot_y", "creep_x")}
    steps = package.run(**case, **FORMS[which], history=history, slip_direction="end")
    for name in ("pressure", "shear_x") + (() if place is ROW else ("shear_y",)):
        largest = np.abs(steady["shear_x" if "shear" in name else name][-1]).max()
        assert steps[name][-1] == pytest.approx(steady[name][-1], abs=3e-4 * largest)


@pytest.mark.parametrize("speed, young", [(1e-7, 2 / 3), (1e9, 2)], ids=["relaxed", "sudden"])
@pytest.mark.parametrize("place", [ROW, GRID], ids=["plane", "half-space"])
def test_slow_and_fast_rolling_is_that_of_elastic_bodies(place, speed, young):
    slow = package.run(**PAIR, **place, **FORMS["one"], rolling="steady", rolling_speed=speed)
    elastic = package.run(**{**PAIR, "body2_young": young}, **place, rolling="steady")
    for name in ("pressure", "shear_x"):
        largest = np.abs(elastic[name][-1]).max()
        assert slow[name][-1] == pytest.approx(elastic[name][-1], abs=1e-5 * largest)


def test_the_resistance_is_what_the_terms_dissipate():
    """sum a_j/l_j (p - c_j).K (p - c_j) is equal to it in second order: per length, of a cylinder, with J = 2 - exp."""
    rest = []
    for cells in (128, 256):
        low, high, moment = hunter(1, 1)
        width = 1.6 * (high - low)
        run = rolling(1, **RIGID, **LIKE_BODY_2, **creeping(1, 2), grid_n=cells, grid_size=width,
                      grid_center=(low + high) / 2, output_fields="pressure")  # fmt: skip
        dx, p = width / cells, np.concatenate([np.zeros(20 * cells), run["pressure"][-1].ravel()])
        c, e = np.zeros(p.size), np.exp(-dx)
        mean = (1 - e) / dx
        for i in range(p.size - 2, -1, -1):
            c[i] = e * c[i + 1] + (mean - e) * p[i + 1] + (1 - mean) * p[i]
        lags = np.arange(p.size) * dx
        kernel = np.log(np.abs((lags + dx / 2) / (lags - dx / 2))) * lags + dx / 2 * np.log(np.abs(lags**2 - dx**2 / 4))
        kernel = -2 / np.pi * (kernel - dx)
        twice = np.fft.irfft(np.fft.rfft(np.concatenate([kernel, [0], kernel[:0:-1]])) * np.fft.rfft(p - c, 2 * p.size))
        loss = dx * (p - c) @ twice[: p.size]
        rest.append(loss / run["rolling_resistance"][-1] - 1)
    assert abs(rest[1]) < 1e-3 and 3 < rest[0] / rest[1] < 5


@few("which", FORMS, 2)
@pytest.mark.parametrize("given", [{}, dict(load_n=None, disp_z=0.35), dict(rot_y=0.02)], ids=["n", "z", "tilted"])
def test_the_extrapolated_resistance_is_that_of_grids_of_half_as_many_cells(which, given):
    """Also of dissimilar bodies, with the lift by the fine shear; a given approach counts as the load that it finds."""
    case = {name: value for name, value in {**PAIR, **GRID, **FORMS[which], **given}.items() if value is not None}
    case.update(rolling="steady", rolling_speed=0.3, output_fields="none")
    fine = package.run(**case)
    coarse = package.run(**{name: v for name, v in case.items() if name != "disp_z"} | dict(
        grid_n=(12, 8), load_n=fine["load_n"][-1]))  # fmt: skip
    f, c = (run["rolling_resistance"][-1] for run in (fine, coarse))
    assert fine["rolling_resistance_extrapolated"][-1] == pytest.approx(
        f + (f - c) / 3, rel=1e-4 if which == "alike" else 4e-3
    )
    assert np.isnan(fine["load_tx_extrapolated"][-1])


def test_odd_grids_and_bodies_apart_have_no_extrapolated_resistance():
    case = {name: value for name, value in {**PAIR, **FORMS["one"], "rolling": "steady"}.items() if name != "rot_y"}
    for n, apart in (((23, 16), False), ((24, 15), False), ((24, 16), True)):
        size = {**GRID, "grid_n": n, "load_n": 0 if apart else GRID["load_n"]}
        run = package.run(**{**case, **size, "creep_x": 0}, rolling_speed=1, output_fields="none")
        assert np.isnan(run["rolling_resistance"][-1]) == apart and np.isnan(run["rolling_resistance_extrapolated"][-1])
    run = package.run(**case, **GRID, rolling_speed=1, extrapolate=False, output_fields="none")
    assert np.isnan(run["rolling_resistance_extrapolated"][-1])
    elastic = {name: value for name, value in case.items() if "relax" not in name}
    assert "rolling_resistance_extrapolated" not in package.run(**elastic, **GRID, output_fields="none").history


def test_a_moment_that_is_given_tilts_the_cylinder_as_the_moment_of_a_held_one():
    """Free to tilt, it turns until the pressure is centred; given the moment of the held one, it does not turn."""
    low, high, moment = hunter(1, 1)
    case = dict(RIGID, **LIKE_BODY_2, **creeping(1, 2), grid_n=64, grid_size=1.6 * (high - low), grid_center=0.2)
    held = rolling(1, **case)
    free = {name: value for name, value in PLANE.items() if name != "rot_y"}
    given = package.run(**free, **case, rolling="steady", rolling_speed=1, load_my=held["load_my"][-1])
    assert given["rot_y"][-1] == pytest.approx(0, abs=1e-6)
    assert given["pressure"][-1] == pytest.approx(held["pressure"][-1], abs=1e-5)
    loose = package.run(**free, **case, rolling="steady", rolling_speed=1)
    assert loose["rot_y"][-1] != 0 and loose["load_my"][-1] == pytest.approx(0, abs=1e-8)
    assert loose["rolling_resistance"][-1] == pytest.approx(held["rolling_resistance"][-1], rel=2e-3)


def test_same_bits_on_ranks_and_after_a_restart(petsam, tmp_path):
    (tmp_path / "h.csv").write_text("time,load_n,load_tx\n0,500,0\n1,700,60\n2,700,-40\n3,600,30\n")
    case = dict(
        bodies(), body1_relax_moduli="0.5,0.2", body1_relax_times="0.1,1", friction=0.4, gap_type="sphere",
        gap_radius1=0.1, gap_radius2="inf", grid_n=(38, 30), grid_size=3.4e-3, history="h.csv", rot_y=0,
        rolling="steady", rolling_speed="2e-3", overwrite=True,
    )  # fmt: skip
    petsam(dict(case, output="one.h5", checkpoint="c.h5", checkpoint_every=2))
    petsam(dict(case, output="three.h5"), ranks=3)
    petsam(dict(case, output="on.h5", restart="c.h5.1"), ranks=2)
    names = "pressure", "shear_x", "history/rolling_resistance", "history/rolling_resistance_extrapolated"
    names += "shear_y", "history/creep_x"
    with h5py.File(tmp_path / "one.h5") as one:
        for file in "three.h5", "on.h5":
            with h5py.File(tmp_path / file) as other:
                for name in names:
                    assert one[name][-1].tobytes() == other[name][-1].tobytes(), (file, name)
    said = petsam(dict(case, output="on.h5", restart="c.h5.1", rolling_speed="3e-3"), check=2).stderr
    assert "rolling_speed" in said
