"""-body2_yield with -body2_layer_young: the substrate below layers yields."""

import h5py
import numpy as np
import pytest

import support
from test_yield import FIELDS, LOAD, RADIUS, YIELD, all_steps, numbers, sphere, steps


def film(thickness, young=1, poisson=0.3, body=2):
    return {
        f"body{body}_layer_young": young,
        f"body{body}_layer_poisson": poisson,
        f"body{body}_layer_thickness": thickness,
    }


def test_a_thin_layer_of_the_same_material_is_hardly_there(solve):
    bare = all_steps(solve(sphere(16, 10)))
    coated = all_steps(solve(sphere(16, 10, **film(1e-3 * RADIUS))))
    assert numbers(coated) == pytest.approx(numbers(bare), rel=2e-3)
    assert coated["residual_z_max"] == pytest.approx(bare["residual_z_max"], rel=2e-3)


def test_layers_begin_below_the_film(solve):
    """The depths in the results are those below the surface."""
    case = dict(output_fields="usual,plastic")
    z = [h5py.File(solve(sphere(12, 6, **more, **case)).path)["plastic/z"][:] for more in ({}, film(0.3 * RADIUS, 2))]
    assert z[1] == pytest.approx(z[0] + 0.3 * RADIUS, rel=1e-9)


def test_work_is_plastic_work_and_what_the_residual_stress_stores(solve, tmp_path):
    """Below a hard film on a soft one; it fails if the stress by strain and the displacement do not fit."""
    force = np.concatenate([np.linspace(0, 5, 25)[1:], np.linspace(5, 0, 13)[1:-1], [1e-3]])
    layers = {
        "body2_layer_young": "3,0.5",
        "body2_layer_poisson": "0.2,0.4",
        "body2_layer_thickness": f"{0.2 * RADIUS},{0.1 * RADIUS}",
    }
    case = sphere(14, 8, **layers, **steps(tmp_path / "h.csv", load_n=(force * LOAD).tolist()))
    run = all_steps(solve(case))
    f, d = (np.concatenate([[0], run[name]]) for name in ("load_n", "disp_z"))
    work = np.sum((f[1:] + f[:-1]) / 2 * np.diff(d))
    assert min(run["plastic_work"].sum(), run["residual_energy"][-1]) > 0.02 * work
    assert run["plastic_work"].sum() + run["residual_energy"][-1] == pytest.approx(work, rel=2e-2, abs=0)


def test_two_equal_coated_bodies_are_one_in_half_the_gap(solve):
    coated = film(0.2 * RADIUS, 2, 0.2)
    one = all_steps(solve(sphere(12, 6, 12, gap_radius1=2, **coated)))
    both = dict(body1_young=1, body1_yield=YIELD, **coated, **film(0.2 * RADIUS, 2, 0.2, 1))
    two = all_steps(solve(sphere(12, 6, 12, **both)))
    assert numbers(two)[0] == pytest.approx(2 * numbers(one)[0], rel=1e-6)
    assert numbers(two)[1:] == pytest.approx(numbers(one)[1:], rel=1e-6)


def test_a_coated_body_on_one_that_yields(solve):
    """The film of body 1, which does not yield, only makes it stiffer."""
    soft = all_steps(solve(sphere(12, 6, body1_young=1)))
    hard = all_steps(solve(sphere(12, 6, body1_young=1, **film(0.5 * RADIUS, 4, 0.3, 1))))
    assert hard["pressure_max"][-1] > 1.02 * soft["pressure_max"][-1]
    assert hard["plastic_max"][-1] > 1.02 * soft["plastic_max"][-1]


# Of a steel half-space that yields at 600 MPa below a film of 400 GPa, nu = 0.2, 10 um thick, under a rigid sphere of
# 5 mm that has pressed it with 100 N: depth (um) and residual stress xx on the axis (MPa), by 9,000 axisymmetric
# elements of CalculiX 2.20 (CAX8R, 4 um about the contact) under petsam's pressures of 12 steps
BELOW_FILM = [(24.8, 67.8), (40.4, -80.0), (58.7, -232.5), (80.2, -359.6), (105.5, -431.1), (135.2, -423.3),
              (170.1, -329.8), (211.1, -166.6), (259.3, 39.7), (315.9, 57.8)]  # fmt: skip


def test_residual_stress_is_that_of_finite_elements(solve, tmp_path):
    case = dict(
        body1_young="inf",
        body1_poisson=0.3,
        body2_young=210e9,
        body2_poisson=0.3,
        body2_yield=600e6,
        gap_type="sphere",
        gap_radius1=5e-3,
        gap_radius2="inf",
        grid_n=40,
        grid_size=0.44e-3,
        output_fields="usual,plastic",
        **film(10e-6, 400e9, 0.2),
        **support.history(tmp_path / "h.csv", "time,load_n", *[(k, 100 * k / 12) for k in range(1, 13)], (13, 0)),
    )
    run = h5py.File(solve(case).path)
    s = run["plastic/residual_stress_xx"][-1, :, 19:21, 19:21].mean((1, 2)) / 1e6
    depth, expected = np.array(BELOW_FILM).T
    assert np.interp(depth * 1e-6, run["plastic/z"][:], s) == pytest.approx(expected, abs=0.02 * np.abs(expected).max())


def test_ranks_give_the_same_bits(petsam, tmp_path):
    columns = dict(load_n=[x * LOAD for x in (2, 5, 1)], load_tx=[0, 0.3 * LOAD, -0.1 * LOAD])
    case = sphere(13, 5, **steps(tmp_path / "loads.csv", **columns), friction=0.2, **film(0.1 * RADIUS, 3, 0.2))
    runs = []
    for ranks in 1, 2:
        petsam(case, dict(output=tmp_path / f"{ranks}.h5"), ranks=ranks)
        run = support.read_run(tmp_path / f"{ranks}.h5")
        runs.append([run[c] for c in FIELDS])
    for one, other in zip(*runs):
        assert np.array_equal(one, other)


@pytest.mark.parametrize(
    "more, words",
    [
        (dict(elasticity="periodic"), "-body2_yield: not supported below layers of bodies of type periodic"),
        (dict(body2_young="inf"), "-body2_yield: the body below its layers is rigid"),
        (
            dict(friction=0.2, wear_type="archard", wear_coefficient2=1e-9),
            "-body2_yield: the body has layers and wears",
        ),
    ],
)
def test_what_is_not_possible_is_refused(petsam, more, words):
    case = sphere(12, 6, **film(0.1 * RADIUS, 3, 0.2))
    case.update(more)
    assert words in petsam(case, check=2).stderr


def test_stresses_are_those_of_the_substrate(petsam, stress, tmp_path):
    """Under the film von Mises' stress is the yield stress; in the film the strain's part is not known."""
    top = 0.1 * RADIUS
    out = tmp_path / "c.h5"
    petsam(sphere(20, 12, steps=4, output_fields="usual,plastic", **film(top, 3, 0.2)), dict(output=out))
    said = stress(dict(input=out, output=tmp_path / "s.h5"), check=2).stderr
    assert "-depths" in said and "above the substrate of body 2" in said
    depths = f"{top}+,{top + 0.3 * RADIUS},{top + 0.6 * RADIUS}"
    stress(dict(input=out, output=tmp_path / "s.h5", depths=depths, quantities="mises"))
    deep = stress(dict(input=out, output=tmp_path / "d.h5", depths=f"{top}+,{20 * RADIUS}"), check=2).stderr
    assert f"which end at {top + sphere(20, 12)['yield_depth']:.6g} m" in deep
    mises = h5py.File(tmp_path / "s.h5")["mises"][:]
    assert 0.9 * YIELD < mises.max() < 1.1 * YIELD
