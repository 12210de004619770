"""Bodies that relax and slide steadily without friction: closed solutions of waves, steps, symmetries, ranks."""

import h5py
import numpy as np
import pytest

import petsam as package
from support import bodies
from test_viscous import BALL, CREEP, CREEP_BULK, RIGID, constants, relaxing, table
from test_viscous_rolling import LIKE_BODY_2, creeping

WAVES = ((1, 0, 1.0, 0.3), (2, 1, -0.4, 1.1), (3, -2, 0.2, 0.0), (0, 2, 0.3, 0.5))  # numbers along x, y; height; phase
WIDTH = (3.0, 2.0)
NU, BULK = 0.3, 2.0


def waves(n, some=WAVES):
    """Heights (n_y, n_x) at the centres of the cells."""
    x, y = ((np.arange(n[c]) + 0.5) * WIDTH[c] / n[c] for c in (0, 1))
    k = [2 * np.pi / WIDTH[c] for c in (0, 1)]
    return sum(h * np.cos(i * k[0] * x[None, :] + j * k[1] * y[:, None] + phase) for i, j, h, phase in some)


def compliance(k_x, speed, bulk):
    """(1 - nu)/G of the waves of a material, under a sudden load G = 1, that moves at this speed along x."""
    a = 1 + sum(part / (1 + 1j * k_x * speed * time) for part, time in CREEP)
    b = 3 / 7 + sum(part / (1 + 1j * k_x * speed * time) for part, time in CREEP_BULK)
    return (a + b) / 2 if bulk else (1 - NU) * a


def expected(n, moves, load, some=WAVES):
    """Pressure and force along x in full contact; moves: by body its speed, and if its bulk modulus is constant."""
    pressure, force = load / (WIDTH[0] * WIDTH[1]) + np.zeros(n[::-1]), 0
    for i, j, height, phase in some:
        k = 2 * np.pi * np.array([i / WIDTH[0], j / WIDTH[1]])
        over = np.hypot(*k) / sum(compliance(k[0], *move) for move in moves)
        arms = [(np.arange(n[c]) + 0.5) * WIDTH[c] / n[c] * k[c] for c in (0, 1)]
        pressure -= height * np.real(over * np.exp(1j * (arms[0][None, :] + arms[1][:, None] + phase)))
        force -= WIDTH[0] * WIDTH[1] / 2 * k[0] * height**2 * np.imag(over)
    return pressure, force


ONE = {**constants(2, 1, BULK), **relaxing(2, bulk=True)}
OTHER = {"body1_young": 2 * (1 + NU), "body1_poisson": NU, **relaxing(1)}
CASES = {
    "bulk": ((17, 12), {**RIGID, **ONE, "body2_speed": -0.7}, [(-0.7, True)]),
    "forth": ((20, 11), {**RIGID, **ONE, "body2_speed": 3}, [(3, True)]),
    "both": (
        (24, 15),
        {**OTHER, **ONE, "body1_speed": 0.2, "body2_speed": -1.5},
        [(0.2, False), (-1.5, True)],
    ),
    "one stands": (
        (16, 16),
        {**OTHER, **ONE, "body1_speed": 0.4},
        [(0.4, False), (0, True)],
    ),
}  # fmt: skip


@pytest.mark.parametrize("ranks", [1, 3])
@pytest.mark.parametrize("case", CASES)
def test_waves_in_full_contact_drag_as_in_closed_form(case, ranks, petsam, tmp_path):
    """Each wave is displaced by its complex compliance, so that pressure and resistance have no error by the cells."""
    n, given, moves = CASES[case]
    load, area = 60.0, WIDTH[0] * WIDTH[1]
    with h5py.File(tmp_path / "gap.h5", "w") as file:
        file["height"] = waves(n)
    pressure, force = expected(n, moves, load)
    assert pressure.min() > 0 and area > 0
    given = dict(given, elasticity="periodic", grid_n=n, grid_size=WIDTH, load_n=load, gap_type="file",
                 gap_file="gap.h5", normal_rtol=1e-11, output="o.h5")  # fmt: skip
    petsam(given, ranks=ranks)
    with h5py.File(tmp_path / "o.h5") as run:
        assert run["pressure"][-1] == pytest.approx(pressure, abs=1e-8 * pressure.max())
        assert run["history/rolling_resistance"][-1] == pytest.approx(force, rel=1e-8)
        assert np.isnan(run["history/rolling_resistance_extrapolated"][-1])


def test_waves_in_plane_strain_drag_as_in_closed_form():
    n, some, load = 33, ((1, 0, 1.0, 0.3), (4, 0, 0.2, 1.0)), 20.0
    pressure, force = expected((n, 1), [(-0.7, True)], load * WIDTH[1], some)
    run = package.run(**RIGID, **ONE, body2_speed=-0.7, elasticity="plane_periodic", grid_n=n, grid_size=WIDTH[0],
                      load_n=load, gap=waves((n, 1), some), normal_rtol=1e-11)  # fmt: skip
    assert run["pressure"][-1] == pytest.approx(pressure, abs=1e-8 * pressure.max())
    assert run["rolling_resistance"][-1] == pytest.approx(force / WIDTH[1], rel=1e-8)


def test_the_wave_of_two_cells_has_no_slope():
    """It is its own mirror image, and is displaced as by the part of the compliance that is in phase."""
    n, height, load = (16, 6), 0.05, 30.0
    k, heights = np.pi * n[0] / WIDTH[0], height * np.cos(np.pi * np.arange(n[0])) + np.zeros((n[1], 1))
    run = package.run(**RIGID, **ONE, body2_speed=-0.02, elasticity="periodic", grid_n=n, grid_size=WIDTH, load_n=load,
                      gap=heights, normal_rtol=1e-11)  # fmt: skip
    pressure = load / 6 - heights * k / np.real(compliance(k, -0.02, True))
    assert run["pressure"][-1] == pytest.approx(pressure, abs=1e-8 * pressure.max())
    assert run["rolling_resistance"][-1] == pytest.approx(0, abs=1e-9)


def test_waves_in_partial_contact_are_the_end_of_steps_of_time():
    """Steps of a cell, in which tractions are linear in time: their errors against exact waves are of second order."""
    speed, load, apart = 0.8, 4.0, []
    for n in ((24, 16), (48, 32)):
        case = dict(
            **RIGID, body2_young=2 * (1 + NU), body2_poisson=NU, **relaxing(2, (0.6,), (0.5,)), elasticity="periodic",
            grid_n=n, grid_size=WIDTH, gap=waves(n),
        )  # fmt: skip
        steady = package.run(**case, load_n=load, body2_speed=-speed, errors="none")
        assert 0.2 < np.mean(steady["pressure"][-1] > 0) < 0.8
        step, k = WIDTH[0] / n[0], np.arange(4 * n[0])
        history = table(time=k * step / speed, load_n=load + 0 * k, roll=step * (k > 0))
        steps = package.run(**case, history=history, errors="none", output_every=k.size)
        apart.append(np.abs(steps["pressure"][-1] - steady["pressure"][-1]).mean() / steady["pressure"][-1].mean())
    assert apart[1] < 1e-2 and apart[0] / apart[1] > 3


LINE = dict(BALL, elasticity="plane", grid_n=96, grid_size=6, load_n=0.4, rot_y=0)
ROUND = dict(BALL, grid_n=(24, 16), grid_size=(4, 8 / 3), load_n=0.15, rot_y=0)


@pytest.mark.parametrize("place", [LINE, ROUND], ids=["plane", "half-space"])
def test_material_that_moves_back_has_the_mirror_image(place):
    case = dict(place, **{f"body{b}_{k}": v for b in (1, 2) for k, v in (("young", 2), ("poisson", 0.2))})
    case.update(creeping(2, 1), **relaxing(2, (0.4,), (0.7,), True))
    back = package.run(**case, body1_speed=-0.3, body2_speed=-0.2)
    forth = package.run(**case, body1_speed=0.3, body2_speed=0.2)
    assert forth["pressure"][-1][:, ::-1] == pytest.approx(back["pressure"][-1], abs=1e-6 * back["pressure"][-1].max())
    assert forth["rolling_resistance"][-1] == pytest.approx(-back["rolling_resistance"][-1], rel=1e-6)
    assert back["rolling_resistance"][-1] > 0.01 * back["load_n"][-1]


@pytest.mark.parametrize("place", [LINE, ROUND], ids=["plane", "half-space"])
def test_a_body_that_stands_has_crept_to_its_end(place):
    """Beside one that moves; and a lone one slides over a rigid body as it rolls."""
    case = dict(place, **RIGID, **LIKE_BODY_2, **creeping(1, 2))
    slides = package.run(**case, body2_speed=-0.3)
    rolls = package.run(**case, rolling="steady", rolling_speed=0.3)
    for name in ("pressure", "rolling_resistance", "rolling_resistance_extrapolated"):
        assert np.array_equal(slides[name][-1], rolls[name][-1])
    both = dict(place, body1_young=3, body1_poisson=NU, **LIKE_BODY_2, **creeping(1, 2), body2_speed=-0.3)
    stands = package.run(**both, **relaxing(1, (0.5,), (0.5,)))  # the term of body 2, which moves
    elastic = package.run(**dict(both, body1_young=1.5))
    assert stands["pressure"][-1] == pytest.approx(elastic["pressure"][-1], abs=1e-6 * elastic["pressure"][-1].max())


def test_same_bits_on_ranks_and_after_a_restart(petsam, tmp_path):
    (tmp_path / "h.csv").write_text("time,load_n\n0,500\n1,700\n2,400\n3,600\n")
    case = dict(
        bodies(), body1_relax_moduli="0.5,0.2", body1_relax_times="0.1,1", gap_type="sphere", gap_radius1=0.1,
        gap_radius2="inf", grid_n=(38, 30), grid_size=3.4e-3, history="h.csv", elasticity="periodic",
        body1_speed="-2e-3", overwrite=True,
    )  # fmt: skip
    petsam(dict(case, output="one.h5", checkpoint="c.h5", checkpoint_every=2))
    petsam(dict(case, output="three.h5"), ranks=3)
    petsam(dict(case, output="on.h5", restart="c.h5.1"), ranks=2)
    with h5py.File(tmp_path / "one.h5") as one:
        for file in "three.h5", "on.h5":
            with h5py.File(tmp_path / file) as other:
                for name in "pressure", "history/rolling_resistance":
                    assert one[name][-1].tobytes() == other[name][-1].tobytes(), (file, name)
    said = petsam(dict(case, output="on.h5", restart="c.h5.1", body1_speed="-3e-3"), check=2).stderr
    assert "body1_speed" in said


@pytest.mark.parametrize("elasticity", ["halfspace", "periodic"])
@pytest.mark.parametrize("aside", [0, 0.6])
def test_the_resistance_is_that_of_pressure_and_tension_together(elasticity, aside):
    """It is the moment over the radius; also of periods over whose border the heights jump."""
    case = dict(
        BALL, **RIGID, elasticity=elasticity, grid_n=64, grid_size=4, grid_center=(aside, 0), load_n=0.1,
        body2_young=1, body2_poisson=0.3, **creeping(0.5, 2), body2_speed=-0.5,
        adhesion_work=2e-3, adhesion_stress=0.05,
    )  # fmt: skip
    if elasticity == "halfspace":
        case["rot_y"] = 0
    run = package.run(**case)
    x = aside + (np.arange(64) + 0.5) / 16 - 2
    moment = np.sum(run["pressure"][-1] * x[None, :]) / 16**2
    assert run["tension"][-1].max() > 0 and np.isnan(run["rolling_resistance_extrapolated"][-1])
    assert run["rolling_resistance"][-1] == pytest.approx(moment, rel=1e-6 if elasticity == "halfspace" else 3e-2)


def test_energy_of_a_steady_state_is_not_known():
    run = package.run(**ROUND, **RIGID, **LIKE_BODY_2, **creeping(1, 2), body2_speed=-0.3)
    assert np.isnan(run["stored_energy"][-1])


def test_speeds_of_zero_are_those_of_bodies_that_have_crept_to_their_end():
    stands = package.run(**ROUND, **RIGID, **LIKE_BODY_2, **creeping(1, 2), body2_speed=0)
    slow = package.run(**ROUND, **RIGID, **LIKE_BODY_2, **creeping(1, 2), body2_speed=1e-9)
    assert stands["contact_area"][-1] == slow["contact_area"][-1] and abs(stands["rolling_resistance"][-1]) < 1e-9
