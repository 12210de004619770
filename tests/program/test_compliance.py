"""Finite bodies: a layer on a rigid base by correction against petsam's own layers, load cases, wrong input."""

import h5py
import numpy as np
import pytest

import compliances
import conftest
from support import assert_same, few, history, l2, read_run
from test_embed import run_python

# E = 1, nu = 0.3, the patch is the grid: [-1, 1]^2
PLANE = dict(
    elasticity="plane",
    grid_n=48,
    gap_type="ellipsoid",
    gap_radius_x=100,
    gap_radius_y="inf",
    gap_radius1=None,
    gap_radius2=None,
)
SPHERE = dict(gap_type="sphere", gap_radius1=100, gap_radius2="inf", grid_n=48, grid_size=2, output_fields="all")
SHEAR = dict(
    grid_n=[48, 40], grid_size=[2, 1.8], friction=0.3, load_n=0.004, load_tx=6e-4, load_ty=3e-4, steps=2,
    step_divide="no",
)  # fmt: skip


def bodies(number, **more):
    """Body `number` elastic, the other rigid."""
    return {f"body{3 - number}_young": "inf", f"body{number}_young": 1, f"body{number}_poisson": 0.3, **more}


def coated(number, thickness):
    """The same with petsam's own layer on a rigid base."""
    layer = {f"body{number}_layer_{k}": v for k, v in dict(young=1, poisson=0.3, thickness=thickness).items()}
    return {**bodies(number), f"body{number}_young": "inf", **layer}


@pytest.fixture(scope="session")
def layer(tmp_path_factory):
    """layer(thickness, degree, factor=1, ...): the name of a file."""
    folder = tmp_path_factory.mktemp("compliance")

    def make(thickness, degree, factor=1.0, **more):
        name = folder / f"{len(list(folder.iterdir()))}.h5"
        return compliances.write(name, factor * compliances.layer(thickness, degree), **more)

    return make


# ---------------------------------------------------------------- the layer on a rigid base


@pytest.mark.parametrize(
    "thickness, numbers",
    [
        (0.5, (-1.374154570, -1.196352841, -0.144348727, 0.144348727, -0.362599552, 0.119799525, -0.141201495)),
        (1, (-1.082455029, -0.797564327, -0.110503367, 0.110503367, -0.170421589, 0.066660369, -0.034818822)),
        (2, (-0.699391676, -0.463065920, -0.051192014, 0.051192014, -0.042916786, 0.018386176, -0.003084913)),
    ],
)
def test_matrix_of_the_tests_is_that_of_the_layer(thickness, numbers):
    d = compliances.layer(thickness, 2)
    found = (d[0, 2, 0, 2], d[0, 0, 0, 0], d[1, 2, 0, 0], d[1, 0, 0, 2], d[1, 2, 1, 2], d[3, 2, 0, 2], d[3, 2, 3, 2])
    assert found == pytest.approx(numbers, abs=1e-9)


@pytest.mark.parametrize(
    "thickness, approach, load, degree, tolerance",
    [(1, 0.00384, 0.00688554, 4, 3e-3), (1, 0.00384, 0.00688554, 6, 3e-4), (2, 0.0064, 0.0114462, 4, 1e-4)],
)
def test_pressure_of_a_layer(thickness, approach, load, degree, tolerance, solve, layer):
    own = solve(SPHERE, coated(2, thickness), dict(disp_z=approach))
    r = solve(SPHERE, bodies(2), dict(disp_z=approach, body2_compliance=layer(thickness, degree)))
    assert l2(r.pressure, own.pressure) < tolerance
    assert r["load_n"] == pytest.approx(load, rel=max(tolerance, 1e-4))
    assert abs(r["normal_iterations"] - own["normal_iterations"]) <= 3


@pytest.mark.parametrize("number", [1, 2])
def test_shear_of_a_layer(number, solve, layer):
    """Coupled, on either body: that of body 1 is turned over."""
    own = solve(SPHERE, coated(number, 1), SHEAR)
    r = solve(SPHERE, bodies(number), SHEAR, {f"body{number}_compliance": layer(1, 6)})
    assert l2(r.pressure, own.pressure) < 5e-4
    for name in ("shear_x", "shear_y", "displacement_x", "displacement_y"):
        assert l2(getattr(r, name), getattr(own, name)) < 4e-3, name
    assert r["coupling_iterations"] <= 14


def test_shear_of_two_layers(solve, layer):
    """Alike: what couples the directions of one body cancels that of the other."""
    both = {**coated(1, 1), **coated(2, 1)}
    own = solve(SPHERE, {**both, "body1_young": "inf", "body2_young": "inf"}, SHEAR)
    file = layer(1, 6)
    case = dict(body1_young=1, body2_young=1, body1_poisson=0.3, body2_poisson=0.3)
    r = solve(SPHERE, case, SHEAR, dict(body1_compliance=file, body2_compliance=file))
    for name in ("pressure", "shear_x", "shear_y", "slip_x"):
        assert l2(getattr(r, name), getattr(own, name)) < 1e-3, name


def test_lengths_and_moduli_scale(solve, layer):
    """A thousand times smaller, of steel."""
    one = solve(SPHERE, bodies(2), SHEAR, dict(body2_compliance=layer(1, 4)))
    small = dict(grid_size=[2e-3, 1.8e-3], gap_radius1=0.1, body2_young=2e11, load_n=800, load_tx=120, load_ty=60)
    file = layer(1, 4, half=1e-3, young=2e11)
    two = solve({**SPHERE, **bodies(2), **SHEAR, **small}, dict(body2_compliance=file))
    assert l2(two.pressure, 2e11 * one.pressure) < 1e-7
    assert l2(two.shear_x, 2e11 * one.shear_x) < 1e-5


@pytest.mark.parametrize("number", [1, 2])
def test_compliance_of_zero_changes_no_bit(number, solve, layer):
    plain = solve(SPHERE, bodies(number), SHEAR)
    assert_same(solve(SPHERE, bodies(number), SHEAR, {f"body{number}_compliance": layer(1, 2, 0)}), plain, 0)


def test_same_bits_on_any_number_of_ranks(solve, layer):
    case = [SPHERE, bodies(2), SHEAR, dict(grid_n=[70, 61], body2_compliance=layer(1, 5))]
    assert_same(solve(*case, ranks=3), solve(*case), 0)


def test_skew_matrix_turns_over_with_its_body(solve, tmp_path):
    """A body that a turn by 180 degrees about x maps to another one: as body 1 the first acts as body 2 the second."""
    rng = np.random.default_rng(1)
    table = compliances.powers(2)
    d = rng.normal(size=(6, 3, 6, 3))
    d = 0.02 * (d + d.transpose(2, 3, 0, 1))
    turn = np.array([1, -1, -1]) * (-1.0) ** table[:, 1:]  # of direction and polynomial
    other = d * turn[:, :, None, None] * turn
    one, two = compliances.write(tmp_path / "1.h5", d), compliances.write(tmp_path / "2.h5", other)
    load = dict(friction=0.3, load_n=0.002, load_tx=3e-4, load_ty=1e-4, gap_radius1=100)
    case = dict(body1_young=1, body2_young=1, body1_poisson=0.3, body2_poisson=0.3)
    first = solve(SPHERE, case, load, dict(body1_compliance=one))
    second = solve(SPHERE, case, load, dict(body2_compliance=two))
    assert first["coupling_iterations"] > 1
    assert_same(first, second, 1e-9)


def test_symmetric_part_is_used(solve, layer, tmp_path):
    d = compliances.layer(1, 2)
    skew = np.random.default_rng(2).normal(size=d.shape)
    file = compliances.write(tmp_path / "c.h5", d + 0.1 * (skew - skew.transpose(2, 3, 0, 1)))
    plain = solve(SPHERE, bodies(2), SHEAR, dict(body2_compliance=layer(1, 2)))
    # the slip until cells touch is that of a first solution, which is less accurate
    assert_same(solve(SPHERE, bodies(2), SHEAR, dict(body2_compliance=file)), plain, 1e-8)


def test_stiffness_is_that_of_the_next_step(solve, layer):
    case = [SPHERE, bodies(2), dict(body2_compliance=layer(1, 4), stiffness=True)]
    one, two = (solve(*case, dict(disp_z=0.00384 + change)) for change in (0, 1e-7))
    assert one["stiffness"][0, 0] == pytest.approx((two["load_n"] - one["load_n"]) / 1e-7, rel=5e-3)
    plain = solve(SPHERE, coated(2, 1), dict(disp_z=0.00384, stiffness=True))
    assert one["stiffness"] == pytest.approx(plain["stiffness"], abs=5e-3 * plain["stiffness"][0, 0])


def beam(path, softer):
    """Its middle alone: the rigid motions of a clamped beam's top, 12 x 4 x 3 of steel in N and mm."""
    half, turn, height = 1.5, 3.97e-7, 1.5
    c = softer * np.diag([1.2e-6 + height**2 * turn, 2.7e-6, 8e-6, 3e-7, turn, 2e-7])
    c[0, 4] = c[4, 0] = -softer * height * turn  # shear bends it
    c[1, 3] = c[3, 1] = softer * height * 1.5e-7
    r = np.zeros((3, 3, 6))  # coefficients of displacements along x, y, z and rotations about them
    r[0, [0, 1, 2], [0, 1, 2]] = 2 * half
    slope = 2 * half**2 / np.sqrt(3)
    r[2, 2, 3] = r[1, 1, 5] = slope
    r[1, 2, 4] = r[2, 0, 5] = -slope
    return compliances.write(path, np.einsum("iak,kl,jbl->iajb", r, c, r) * 210e3 / half, half=half, young=210e3)


@few("softer, friction, most", [(1, 0.5, 16), (10, 0.5, 20), (10, 1, 26), (30, 1, 45)], 2)
def test_soft_bodies_converge_with_rotations_held(softer, friction, most, petsam, tmp_path):
    """What the bending by shear couples: pressed, sheared and reversed. Passes of the softest one vary from 17 to 26
    with the solvers' tolerances, and with their last digits."""
    z, x = 0.0057 + 0.0363 * softer, 0.004 * softer + 0.001
    rows = [(k + 1.0, a * z, b * x, 0, 0, 0) for k, (a, b) in enumerate([(1, 0), (1, -1), (1, 0), (1, 1), (0.8, 0.5)])]
    case = {**SPHERE, "grid_n": 80, "grid_size": 3, "body1_young": "inf", "body2_young": 210e3, "body2_poisson": 0.3}
    case |= history(tmp_path / "h.csv", "time,disp_z,disp_x,rot_x,rot_y,rot_z", *rows)
    file = beam(tmp_path / "beam.h5", softer)
    petsam(case, dict(friction=friction, body2_compliance=file, output="r.h5", allow_edge_contact=True))
    with h5py.File(tmp_path / "r.h5") as f:
        assert max(f["history/coupling_iterations"]) <= most
        assert abs(f["history/load_tx"][1] / f["history/load_tx"][3]) == pytest.approx(1, abs=0.2)


def test_contact_in_process(solve, layer, tmp_path):
    """As the program, and two contacts whose bodies have other cases."""
    one = layer(1, 2, cases=dict(pull=np.full((6, 3), 1e-5)))
    two = layer(1, 2, cases=dict(bend=np.full((6, 3), 2e-5), pull=np.full((6, 3), 3e-5)))
    case = {**SPHERE, **bodies(2), "friction": 0.3}
    given = dict(load_n=0.002, load_tx=1e-4)
    del case["output_fields"]
    cases = [{"body2_compliance": str(f), f"body2_case_{name}": 1} for f, name in ((one, "pull"), (two, "bend"))]
    run_python(
        f"""
import petsam, numpy as np
with petsam.Contact(**{case!r}, **{cases[0]!r}) as a, petsam.Contact(**{case!r}, **{cases[1]!r}) as b:
    for k, contact in enumerate((a, b)):
        step = contact.try_step(**{given!r})
        np.savez(f"{{k}}.npz", pressure=contact["pressure"], disp_z=step.rigid[0])
""",
        tmp_path,
    )
    for k, more in enumerate(cases):
        here, r = np.load(tmp_path / f"{k}.npz"), solve({**case, **given, **more}, dict(steps=1))
        assert np.array_equal(here["pressure"], r.pressure) and here["disp_z"] == r["disp_z"]


@pytest.mark.parametrize("center", [(0.15, 0), (-0.15, 0), (0, 0.15), (0, -0.15)])
def test_patch_is_smaller_than_the_grid(center, solve, layer, petsam):
    """The same answer where contact stays within it, code 12 where it does not."""
    case = [{**SPHERE, "gap_radius1": 20}, bodies(2), dict(body2_compliance=layer(1, 4, half=0.5, center=center))]
    wide = solve(*case, dict(load_n=0.0005))
    one = solve(*case, dict(load_n=0.0005, grid_n=[16, 16], grid_size=[2 / 3, 2 / 3]))
    assert l2(wide.pressure[16:32, 16:32], one.pressure) < 1e-6
    done = petsam({**SPHERE, **bodies(2)}, case[2], dict(load_n=0.001), check=12)
    assert "the contact reached the border of the patch of a body's compliance" in done.stderr


# ---------------------------------------------------------------- load cases

STEEL = dict(body1_young=1, body2_young=1, body1_poisson=0.3, body2_poisson=0.3)


@pytest.mark.parametrize("number, sign", [(1, -1), (2, 1)])
def test_case_that_stretches_is_a_bulk_stress(number, sign, solve, layer, tmp_path):
    stress = 3e-4
    field = np.zeros((3, 3))
    field[1, 0], field[2, 1] = 2 / np.sqrt(3) * np.array([stress, -0.3 * stress])
    file = compliances.write(tmp_path / "c.h5", np.zeros((3, 3, 3, 3)), cases=dict(pull=field))
    rows = [(1, 0.004, 0.0003, 0), (2, 0.004, 0.0003, 1), (3, 0.004, -0.0003, 0.5)]
    columns = "time,load_n,load_tx,"
    one = history(tmp_path / "a.csv", columns + f"body{number}_case_pull", *rows)
    two = history(
        tmp_path / "b.csv", columns + "bulk2_stress_xx", *[(*row[:3], sign * stress * row[3]) for row in rows]
    )
    case = [SPHERE, STEEL, dict(friction=0.3, steps=2, tangential_rtol=1e-8)]
    r = solve(*case, one, {f"body{number}_compliance": file})
    plain = solve(*case, two)
    for name in ("shear_x", "shear_y", "slip_x", "slip_y"):
        assert l2(getattr(r, name), getattr(plain, name)) < 1e-5, name
    with h5py.File(r.path) as f:
        assert list(f[f"history/body{number}_case_pull"]) == [0, 0, 0.5, 1, 0.75, 0.5]
        assert list(np.isnan(f["history/stored_energy"])) == [False] * 2 + [True] * 4


def test_polynomials_keep_their_values_outside_of_the_patch(solve, tmp_path):
    """Those of a load case that turns the body, which its rotation follows."""
    slope = 1e-4
    field = np.zeros((3, 3))
    field[1, 2] = 2 * 0.5**2 / np.sqrt(3) * slope
    file = compliances.write(tmp_path / "c.h5", np.zeros((3, 3, 3, 3)), half=0.5, cases=dict(turn=field))
    case = [{**SPHERE, "gap_radius1": 20}, STEEL, dict(load_n=2e-4, body2_compliance=file)]
    r, plain = solve(*case, dict(body2_case_turn=1)), solve(*case)
    assert l2(r.pressure, plain.pressure) < 1e-6
    turned = np.ones((48, 1)) * slope * np.clip(r.x, -0.5, 0.5)
    assert r.displacement_z - plain.displacement_z == pytest.approx(turned, abs=1e-4 * slope)


def test_case_without_coupling_is_refused_before_the_first_step(petsam, tmp_path):
    file = compliances.write(tmp_path / "c.h5", np.zeros((3, 3, 3, 3)), half=0.5, cases=dict(pull=np.ones((3, 3))))
    case = [{**SPHERE, "grid_n": 8}, STEEL, dict(body2_compliance=file, coupling="none", output="kept.h5")]
    (tmp_path / "kept.h5").write_text("results of an earlier run")
    rows = history(tmp_path / "h.csv", "time,load_n,body2_case_pull", (0, 1e-4, 0), (1, 1e-4, 1e-3))
    done = petsam(*case, rows, check=2)
    assert "h.csv, line 3: body2_case_pull = 0.001: expected 0, or -coupling full" in done.complaint[0]
    assert (tmp_path / "kept.h5").read_text() == "results of an earlier run"


@pytest.mark.parametrize("number, signs", [(1, (-1, 1, 1)), (2, (1, 1, 1))])
def test_case_that_moves_the_surface_moves_the_body(number, signs, solve, layer, tmp_path):
    field = np.zeros((1, 3))
    field[0] = 2 * np.array([1e-4, 2e-4, 3e-4])
    file = compliances.write(tmp_path / "c.h5", np.zeros((1, 3, 1, 3)), cases=dict(move=field, other=0 * field))
    given = dict(friction=0.3, disp_z=0.003, disp_x=2e-4, disp_y=-1e-4)
    r = solve(SPHERE, STEEL, given, {f"body{number}_compliance": file, f"body{number}_case_move": 0.5})
    moved = {name: given[name] - 0.5 * v for name, v in zip(("disp_x", "disp_y", "disp_z"), signs * field[0] / 2)}
    plain = solve(SPHERE, STEEL, {**given, **moved})
    for name in ("pressure", "shear_x", "shear_y"):
        assert l2(getattr(r, name), getattr(plain, name)) < 1e-6, name
    with h5py.File(r.path) as f:
        loads = [f[f"history/load_{name}"][-1] for name in ("tx", "ty", "n")]
        move, other = (f[f"history/body{number}_case_{name}_load"][-1] for name in ("move", "other"))
    assert move == pytest.approx(np.dot(loads, signs * field[0] / 2), rel=1e-6) and other == 0


def points(file, x, y, field):
    """Another file, whose only load case, bend, is given at points."""
    with h5py.File(file, "a") as f:
        f.pop("cases", None)
        f.update({"cases/bend/x": x, "cases/bend/y": y, "cases/bend/field": field})
    return file


def test_case_at_points_is_fitted_by_the_polynomials(solve, tmp_path):
    """Scattered ones; u_z = 2e-4 x^2 - 1e-4 x y and u_x = 1e-4 y against the same case by its coefficients."""
    x, y = np.random.default_rng(3).uniform(-1, 1, (2, 40))
    table = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]
    field = np.zeros((6, 3))  # of orthonormal ones: 1/2, sqrt(5)/4 (3 x^2 - 1), 3/2 x y; sqrt(3)/2 y
    field[0, 2], field[3, 2], field[4, 2] = 2e-4 * 2 / 3, 2e-4 * 4 / 3 / np.sqrt(5), -1e-4 * 2 / 3
    field[2, 0] = 1e-4 * 2 / np.sqrt(3)
    known = compliances.write(tmp_path / "a.h5", np.zeros((6, 3, 6, 3)), table=table, cases=dict(bend=field))
    file = compliances.write(tmp_path / "b.h5", np.zeros((6, 3, 6, 3)), table=table)
    points(file, x, y, np.stack([1e-4 * y, 0 * x, 2e-4 * x**2 - 1e-4 * x * y], axis=1))
    given = dict(friction=0.3, disp_z=0.003, disp_x=2e-4, body2_case_bend=1)
    r, plain = (solve(SPHERE, STEEL, given, dict(body2_compliance=one)) for one in (file, known))
    (x, y), cell = np.meshgrid(r.x, r.y), (r.x[1] - r.x[0]) * (r.y[1] - r.y[0])
    work = np.sum(r.pressure * (2e-4 * (x**2 + (r.x[1] - r.x[0]) ** 2 / 12) - 1e-4 * x * y) + r.shear_x * 1e-4 * y)
    with h5py.File(plain.path) as f:
        assert f["history/body2_case_bend_load"][-1] == pytest.approx(work * cell, rel=1e-4)
    for name in ("pressure", "shear_x", "displacement_z"):
        assert l2(getattr(r, name), getattr(plain, name)) < 1e-9, name


@pytest.mark.parametrize(
    "x, y, field, says",
    [
        (np.zeros(8), np.linspace(-1, 1, 8), np.ones((8, 3)), "at 8 points, which do not determine 6 polynomials"),
        (np.zeros(5), np.zeros(5), np.ones((5, 3)), "at 5 points, which do not determine 6 polynomials"),
        (np.full(6, 1.5), np.zeros(6), np.ones((6, 3)), "/cases/bend/x has 1.5 m, outside of the patch from -1 to 1 m"),
        (*np.meshgrid(*2 * [np.linspace(-1, 1, 5)]), None, "differs from polynomials of degree 2 by"),
        (np.zeros(6), np.zeros(7), np.ones((7, 3)), "/cases/bend/y has a shape that does not fit the others"),
    ],
)
def test_wrong_points_are_refused(x, y, field, says, petsam, tmp_path):
    x, y = np.ravel(x), np.ravel(y)
    field = np.abs(x)[:, None] * np.ones(3) if field is None else field
    file = points(compliances.write(tmp_path / "c.h5", np.zeros((6, 3, 6, 3))), x, y, field)
    assert says in petsam(SPHERE, STEEL, dict(disp_z=0.003, body2_compliance=file), check=3).stderr


@pytest.mark.parametrize("share", [0.5, 0.95, -100])
def test_check_is_relative_to_the_displacement_by_tractions(share, solve, layer):
    """Of a case that cancels a share of it: the errors were relative to what is left, and the step did not converge."""
    field = np.zeros((6, 3))
    field[0, 2] = 2.0  # 1 m everywhere
    problem = {**SHEAR, "steps": 1, "body2_compliance": layer(1, 2, cases=dict(lift=field))}
    plain = solve(SPHERE, bodies(2), problem)
    found = solve(SPHERE, bodies(2), problem, dict(body2_case_lift=-share * plain.displacement_z.max()))
    assert found["normal_residual"] == pytest.approx(plain["normal_residual"], rel=0.02)
    assert l2(found.pressure, plain.pressure) < 1e-7


def test_run_with_cases_goes_on_from_its_checkpoint(petsam, layer, tmp_path):
    file = layer(1, 2, cases=dict(bend=np.full((6, 3), 1e-5)))
    rows = [(k, 0.004, 2e-4 * k, 0.25 * k) for k in range(5)]
    case = {**SPHERE, **bodies(2), "friction": 0.3, "body2_compliance": file}
    case |= history(tmp_path / "h.csv", "time,load_n,load_tx,body2_case_bend", *rows)
    petsam(case, dict(output="whole.h5"))
    first = history(tmp_path / "first.csv", "time,load_n,load_tx,body2_case_bend", *rows[:3])
    petsam({**case, **first}, dict(output="part.h5", checkpoint="c.h5", checkpoint_every=1))
    petsam(case, dict(output="part.h5", restart="c.h5"))
    whole, parts = read_run(tmp_path / "whole.h5"), read_run(tmp_path / "part.h5")
    for name in ("pressure", "shear_x", "slip_x", "history/body2_case_bend"):
        assert np.array_equal(whole[name], parts[name]), name
    other = layer(1, 3, cases=dict(bend=np.full((10, 3), 1e-5)))
    message = petsam({**case, "body2_compliance": other}, dict(restart="c.h5"), check=2).complaint[0]
    assert "-body2_compliance is" in message


def test_state_of_a_contact_with_cases_goes_on_in_another_process(layer, tmp_path):
    """To the last bit, whatever cases contacts have had before in either; and more cases than any contact may have."""
    ramp = np.zeros((6, 3))
    ramp[1, 0] = 1e-4
    other = layer(1, 2, cases=dict(alpha=np.full((6, 3), 1e-5)))
    file = layer(1, 2, cases=dict(bend=np.full((6, 3), 2e-5), pull=ramp))
    many = [layer(1, 2, cases={f"case_{8 * k + n}": np.full((6, 3), 1e-5) for n in range(8)}) for k in range(5)]
    case = {**SPHERE, **bodies(2), "friction": 0.3}
    del case["output_fields"]
    begin = f"""
import petsam
case = {case!r}
def go(contact, n):
    for k in n:
        history = dict(time=[k], load_n=[0.002], load_tx=[5e-5 * k], body2_case_bend=[0.2 * k], body2_case_pull=[1 - k])
        step = contact.run(history)[-1]
    return step
"""
    run_python(
        begin
        + f"""
for name in {[str(other), *map(str, many)]!r}:
    petsam.Contact(**case, body2_compliance=name).close()
with petsam.Contact(**case, body2_compliance={str(file)!r}) as contact:
    go(contact, (1, 2))
    contact.save("c.h5")
    open("whole.txt", "w").write(repr(go(contact, (3,)).disp_x))
""",
        tmp_path,
    )
    run_python(
        begin
        + f"""
with petsam.Contact(**case, body2_compliance={str(file)!r}) as contact:
    contact.load("c.h5")
    open("parts.txt", "w").write(repr(go(contact, (3,)).disp_x))
""",
        tmp_path,
    )
    assert (tmp_path / "parts.txt").read_text() == (tmp_path / "whole.txt").read_text()


# ---------------------------------------------------------------- stresses


@pytest.fixture
def stresses(launcher, tmp_path):
    """stresses(results, body, ..., check=0): components (6, z, y, x), or the message."""
    program = conftest.PROGRAM.with_name("petsam-stress")

    def run(results, body, check=0, **options):
        out = tmp_path / f"{len(list(tmp_path.iterdir()))}-stress.h5"
        options = dict(input=results.path, output=out, body=body, depths=[0, 0.1, 0.4, 1], **options)
        done = conftest.execute(launcher, tmp_path, [options], 1, check, program=program)
        if check:
            return done.stderr
        with h5py.File(out) as f:
            return np.array([f[f"stress_{name}"][-1] for name in ("xx", "yy", "zz", "xy", "xz", "yz")])

    return run


def known(thickness, degree, points=7, deepest=1.0):
    """The contents of /stress."""
    x, y, z, basis = compliances.layer_stress(thickness, degree, points, deepest)
    return dict(x=x, y=y, z=z, basis=basis)


@pytest.mark.parametrize("number", [1, 2])
def test_stresses_in_a_layer(number, solve, layer, stresses):
    """Against petsam's own layer: maps, and a section."""
    file = layer(2, 4, stress=known(2, 4))
    own = solve(SPHERE, coated(number, 2), SHEAR)
    r = solve(SPHERE, bodies(number), SHEAR, {f"body{number}_compliance": file})
    plain = stresses(solve(SPHERE, bodies(number), SHEAR), number)
    scale = np.abs(plain[2]).max()
    for section in ({}, dict(section="y=0.2"), dict(section="x=-0.1")):
        wanted, found = stresses(own, number, **section), stresses(r, number, **section)
        assert np.abs(found - wanted).max() < 1.5e-3 * scale
    assert np.abs(plain - stresses(own, number)).max() > 0.03 * scale


@pytest.mark.parametrize("number", [1, 2])
def test_stresses_of_a_load_case(number, solve, layer, stresses, tmp_path):
    """Those of two steps, which a body has besides those of its tractions; its y is turned on body 1."""
    given = np.array([4e-3, 1e-3, 2e-3, 3e-3, 5e-3, 6e-3])
    axes = dict(x=[-1.0, 1.0], y=[-1.0, 1.0], z=[0.0, 1.0])
    field = np.einsum("y,s->ys", [1, 2], given)[None, :, None, :] * np.ones((2, 1, 2, 1))
    stress = {**axes, "basis": np.zeros((6, 3, 2, 2, 2, 6)), "cases/pull": field, "cases/bend": 0 * field}
    file = compliances.write(
        tmp_path / "c.h5",
        np.zeros((6, 3, 6, 3)),
        stress=stress,
        cases=dict(pull=np.zeros((6, 3)), bend=np.zeros((6, 3))),
    )
    rows = history(tmp_path / "h.csv", f"time,load_n,body{number}_case_pull", (1, 0.004, 1), (2, 0.004, 0.5))
    case = [SPHERE, STEEL, dict(friction=0.3)]
    r = solve(*case, rows, {f"body{number}_compliance": file})
    more = stresses(r, number) - stresses(solve(*case, dict(load_n=0.004, steps=1)), number)
    turn = np.array([1, 1, 1, -1, 1, -1]) if number == 1 else np.ones(6)
    along = 1.5 + (0.5 if number == 2 else -0.5) * r.y
    wanted = 0.5 * (turn * given)[:, None, None, None] * along[:, None] * np.ones((4, 1, 48))
    assert more == pytest.approx(wanted, abs=1e-7)


def test_what_stresses_need_is_told(solve, layer, stresses):
    case = [SPHERE, bodies(2), dict(disp_z=0.00384)]
    r = solve(*case, dict(body2_compliance=layer(1, 4)))
    assert "has no group /stress: make the file without --no-stress" in stresses(r, 2, 3)
    deep = known(2, 4)
    file = layer(2, 4, stress={**deep, "z": 0.5 * deep["z"]})
    r = solve(*case, dict(body2_compliance=file))
    said = stresses(r, 2, 2)
    assert "-depths 1: " in said and "or a file that petsam-compliance made with --depth 1" in said
    assert stresses(r, 1, 2)  # it is rigid
    with h5py.File(file, "r+") as f:
        f["stress/x"][1] = 5
    assert "/stress/x does not increase" in stresses(r, 2, 3)
    with h5py.File(file, "r+") as f:
        f["stress/x"][...] = deep["x"]
        f["compliance"][...] *= 0.99
    assert "has changed since: bring back that file" in stresses(r, 2, 3)


def test_stresses_in_process(layer, tmp_path):
    file = layer(2, 4, stress=known(2, 4), cases=dict(pull=np.zeros((15, 3))))
    with h5py.File(file, "r+") as f:
        f["stress/cases/pull"] = np.full((7, 7, 7, 6), 1e-3)
    case = {**SPHERE, **bodies(2), "body2_compliance": str(file), "friction": 0.3}
    del case["output_fields"]
    run_python(
        f"""
import petsam, numpy as np
found = []
for more in ({{}}, dict(body2_case_pull=1)):
    with petsam.Contact(**{case!r}, **more) as contact:
        contact.try_step(load_n=0.002)
        contact.commit()
        found.append(contact.stress(depths=[0.4])["stress_xx"])
np.save("found.npy", found)
""",
        tmp_path,
    )
    found = np.load(tmp_path / "found.npy")
    assert found[1] - found[0] == pytest.approx(1e-3, abs=1e-8)


# ---------------------------------------------------------------- wrong input


@pytest.mark.parametrize(
    "thickness, degree, least",
    [(0.25, 0, 0.014), (0.25, 2, 0.099), (1, 0, 0.308), (1, 2, 0.364), (1, 8, 0.363), (2, 0, 0.553), (2, 2, 0.578)],
)
def test_body_that_would_gain_energy_is_refused(thickness, degree, least, petsam, layer):
    """A matrix eight times too large, of which the message tells the smallest eigenvalue."""
    case = {**SPHERE, **bodies(2), "load_n": 0.001, "body2_compliance": layer(thickness, degree, 8)}
    message = petsam(case, check=3).complaint[0]
    found = float(message.split("its compliance is ")[1].split()[0])
    assert 1 + (found - 1) / 8 == pytest.approx(least, abs=1.5e-3)
    assert f"degree {degree}, patch 2 m x 2 m: use a higher degree" in message


@pytest.mark.parametrize("young, thickness, code", [(1.0000001, 1, 0), (100, 1e-3, 0), (100, 0.5, 3)])
def test_layer_that_makes_the_half_space_stiffer_than_the_correction_is_refused(young, thickness, code, petsam, layer):
    """A body whose own compliance is positive; below a stiff layer the correction outweighs the half-space's."""
    coat = dict(body2_layer_young=young, body2_layer_poisson=0.3, body2_layer_thickness=thickness)
    case = {**SPHERE, **bodies(2), **coat, "load_n": 0.001, "grid_n": 24, "body2_compliance": layer(1, 2)}
    complaint = " ".join(petsam(case, check=code).complaint)
    assert ("would gain energy" in complaint) == bool(code)


@pytest.mark.parametrize("given, code", [("rot_z", 10), ("load_mz", 0)])
def test_soft_twist_is_solved_by_its_load_and_named_where_it_is_not(given, code, petsam, tmp_path):
    """Cells that begin to slip turn the body by far more than they deform it."""
    twist, power = np.zeros((15, 3)), compliances.powers(4).tolist()
    twist[power.index([0, 1]), 0], twist[power.index([1, 0]), 1] = -1, 1
    pull = np.zeros((15, 3))
    pull[:, :2] = 1e-4 * np.random.default_rng(1).normal(size=(15, 2))
    softness = 3e3 * np.einsum("ia,jb->iajb", twist, twist)
    file = compliances.write(tmp_path / "soft.h5", softness, cases={"pull": pull})
    case = {**bodies(2), "body1_young": 1, "body1_poisson": 0.3, "body2_compliance": file, "body2_case_pull": 1}
    case |= dict(gap_type="flat", grid_n=[48, 40], grid_size=2, friction=0.3, disp_z=0.002, allow_edge_contact=True)
    complaint = " ".join(petsam(case, dict(disp_x=0, disp_y=0, rot_x=0, rot_y=0, **{given: 0}), check=code).complaint)
    assert ("by load_tx, load_ty and load_mz, or by petsam-joint" in complaint) == bool(code)


@pytest.mark.parametrize("times, code", [(1e3, 0), (1e5, 3)])
def test_body_whose_pressures_would_be_lost_in_its_displacement_is_refused(times, code, petsam, tmp_path):
    """On a soft mount along z, which changes no pressure: 1e5 gave pressures wrong by 1e-4, 1e7 by a third."""
    mount = np.zeros((6, 3, 6, 3))
    mount[0, 2, 0, 2] = times
    file = compliances.write(tmp_path / "mount.h5", mount)
    case = {**SPHERE, **bodies(2), "load_n": 0.001, "grid_n": 24, "body2_compliance": file}
    complaint = " ".join(petsam(case, check=code).complaint)
    assert ("times as compliant as the half-space, limit 10000" in complaint) == bool(code)


def test_matrix_beyond_double_precision_is_refused(petsam, layer):
    """LAPACK ended the process with exit code 0."""
    case = {**SPHERE, **bodies(2), "load_n": 0.001, "body2_compliance": layer(1, 2, 1e307)}
    assert "the smallest eigenvalue of its compliance is nan" in petsam(case, check=3).complaint[0]


def test_thin_layer_without_slopes_is_refused(petsam, layer):
    case = {**SPHERE, **bodies(2), "load_n": 0.001}
    assert "-body2_compliance" in petsam(case, dict(body2_compliance=layer(0.125, 0)), check=3).complaint[0]
    petsam(case, dict(body2_compliance=layer(0.125, 2)))


def change(name, value):
    """A change of a file: a dataset, or an attribute after @, is replaced, or removed by None."""

    def make(f):
        where, key = (f.attrs, name[1:]) if name[0] == "@" else (f, name)
        if key in where:
            del where[key]
        if value is not None:
            where[key] = value

    return make


@pytest.mark.parametrize(
    "name, value, says",
    [
        ("@petsam_compliance", None, "it lacks the attribute petsam_compliance of a file of petsam-compliance"),
        ("@petsam_compliance", 3, "petsam_compliance is 3: expected 1 or 2"),
        ("@petsam_compliance", 2, "it lacks the attribute datum of a file of petsam-compliance"),
        ("@young", "steel", "its attribute young is not what petsam-compliance writes"),
        ("@young", -1.0, "young is -1, poisson 0.3: expected a modulus > 0"),
        ("@poisson", 0.6, "poisson 0.6: expected a modulus > 0"),
        ("patch/half", None, "has no dataset /patch/half: make the file by petsam-compliance"),
        ("patches/1/x", np.zeros(1), "has several patches of a structure: name one of"),
        ("patch/half", [1.0, 0.0], "number 1 of /patch/half is 0: expected a number > 0"),
        ("patch/half", [1e100, 1e100], "/patch/half is 1e+100, 1e+100, /patch/center 0, 0: expected at most 10000 m"),
        ("patch/half", [1e3, 1e-3], "sides that differ at most by a factor of 1000: check the unit of the file"),
        ("patch/center", [0.0, np.nan], "number 1 of /patch/center is nan: expected a finite number"),
        (
            "basis/degree_xy",
            np.zeros((6, 3)),
            "degree_xy has a shape that does not fit the others: (6, 3), expected (any, 2)",
        ),
        (
            "basis/degree_xy",
            np.full((6, 2), 25),
            "number 0 of /basis/degree_xy is 25: expected a whole number from 0 to 24",
        ),
        ("basis/degree_xy", np.zeros((5, 2)), "/compliance has a shape that does not fit"),
        ("compliance", np.full((6, 3, 6, 3), np.inf), "number 0 of /compliance is inf: expected a finite number"),
        ("cases/a b/displacement", np.zeros((6, 3)), "a load case is named a b: expected at most 20 letters"),
        ("cases/pull/displacement", np.zeros((5, 3)), "/cases/pull/displacement has a shape that does not fit"),
        ("cases/pull/x", np.zeros(5), "has no dataset /cases/pull/displacement"),
    ],
)
def test_wrong_files_are_refused(name, value, says, petsam, layer):
    file = layer(1, 2)
    with h5py.File(file, "r+") as f:
        change(name, value)(f)
    message = petsam({**SPHERE, **bodies(2), "load_n": 0.001, "body2_compliance": file}, check=3).complaint[0]
    assert f"-body2_compliance {file}: " in message
    assert says in message


# ---------------------------------------------------------------- one patch of several


@pytest.fixture
def patches(layer, tmp_path):
    """Names of a file of two patches, of degree 2 and 4, the second about (0.1, 0.2), and of a file of each."""
    rng = np.random.default_rng(1)
    case = dict(pull=1e-3 * rng.normal(size=(15, 3)))
    alone = [layer(1, 2), layer(1, 4, center=(0.1, 0.2), cases=case)]
    with h5py.File(tmp_path / "several.h5", "w") as f:
        for number, one in enumerate(alone, 1):
            with h5py.File(one, "r") as source:
                f.attrs.update(source.attrs)
                for name in source:
                    source.copy(name, f.require_group(f"patches/{number}"))
        b = rng.normal(size=(6, 6))
        f["patches/2/rigid/compliance"] = 0.01 * b @ b.T
        f["patches/2/rigid/motions"] = 0.1 * rng.normal(size=(6, 15, 3))
        f["patches/2/compliance"][...] += np.einsum("cik,cd,djl->ikjl", *rigid(f["patches/2"]))
    with h5py.File(alone[1], "r+") as f, h5py.File(tmp_path / "several.h5", "r") as source:
        f["compliance"][...] = source["patches/2/compliance"][()]
    return tmp_path / "several.h5", *alone


def rigid(group):
    """Q, b and Q of a patch."""
    q = group["rigid/motions"][()]
    return q, group["rigid/compliance"][()], q


ON_PATCH = dict(grid_n=[48, 40], grid_size=[1.6, 1.4], friction=0.3, load_n=0.004, load_tx=6e-4, steps=2)


@pytest.mark.parametrize("ranks", (1, 2, 3))
def test_one_patch_of_several_is_that_of_its_own_file(ranks, solve, patches):
    file, first, second = patches
    for number, alone, more in ((1, first, {}), (2, second, dict(body2_case_pull=0.1))):
        case = {**SPHERE, **bodies(2), **ON_PATCH, **more}
        found = solve(case, dict(body2_compliance=f"{file}:{number}"), ranks=ranks)
        assert_same(found, solve(case, dict(body2_compliance=alone)), 0)


@pytest.mark.parametrize("ranks, lower", ((1, 0), (1, 2), (2, 1), (3, 2)))
def test_what_is_local_of_a_patch_is_without_the_motion_of_body_1(ranks, lower, solve, patches, tmp_path):
    """Bit for bit that of a file from which it is subtracted; about the patch's centre, at a lower degree."""
    with h5py.File(patches[0], "r") as f, h5py.File(patches[2], "r+") as alone:
        table = alone["basis/degree_xy"][()]
        kept = np.flatnonzero(table.sum(axis=1) <= 4 - lower)
        local = f["patches/2/compliance"][()] - np.einsum("cik,cd,djl->ikjl", *rigid(f["patches/2"]))
        new = {"basis/degree_xy": table[kept], "compliance": local[kept][:, :, kept], "patch/center": np.zeros(2)}
        new["cases/pull/displacement"] = alone["cases/pull/displacement"][()][kept]
        for name, value in new.items():
            del alone[name]
            alone[name] = value
    case = {**SPHERE, **bodies(2), **ON_PATCH, "body2_case_pull": 0.1}
    words = f"{patches[0]}:2:local" + f":{lower}" * (lower > 0)
    found = solve(case, dict(body2_compliance=words), ranks=ranks)
    assert_same(found, solve(case, dict(body2_compliance=patches[2])), 0)


@pytest.mark.parametrize(
    "words, says",
    [
        ("", "several.h5: has several patches of a structure: name one of {0}:1 to {0}:2"),
        (":3", "several.h5: has no patch 3: it has 2: name one of {0}:1 to {0}:2"),
        (":0", "several.h5: has no patch 0: it has 2"),
        (":1:local", "several.h5: has no dataset /patches/1/rigid/compliance"),
        (":x", "several.h5:x: "),
        (":1:local:", "several.h5:1:local:: "),
    ],
)
def test_patches_that_a_file_does_not_have_are_named(words, says, petsam, patches):
    case = {**SPHERE, **bodies(2), **ON_PATCH, "body2_compliance": f"{patches[0]}{words}"}
    assert says.format(patches[0]) in petsam(case, check=3).complaint[0]


def test_a_file_of_one_patch_has_the_number_1(petsam, solve, layer):
    case = {**SPHERE, **bodies(2), "load_n": 0.004}
    file = layer(1, 4)
    found = solve(case, dict(body2_compliance=f"{file}:1"))
    assert_same(found, solve(case, dict(body2_compliance=file)), 0)
    assert "has no patch 2: it has 1" in petsam(case, dict(body2_compliance=f"{file}:2"), check=3).complaint[0]


def test_the_file_of_a_patch_is_not_replaced(petsam, patches):
    case = {**SPHERE, **bodies(2), **ON_PATCH, "body2_compliance": f"{patches[0]}:1", "output": patches[0]}
    assert "would overwrite the file of -body2_compliance" in petsam(case, check=2).complaint[0]


def test_numbers_that_were_never_written_are_refused(petsam, layer):
    file = layer(1, 2)
    with h5py.File(file, "r+") as f:
        del f["compliance"]
        f.create_dataset("compliance", (6, 3, 6, 3), dtype=float)
    message = petsam({**SPHERE, **bodies(2), "load_n": 0.001, "body2_compliance": file}, check=3).complaint[0]
    assert "the numbers of /compliance cannot be read: the file is damaged" in message


@few("part", [0.3, 0.6, 0.9, 0.999], 2)
def test_damaged_files_are_refused(part, petsam, layer):
    file = layer(1, 2)
    content = file.read_bytes()
    file.write_bytes(content[: int(part * len(content))])
    message = petsam({**SPHERE, **bodies(2), "load_n": 0.001, "body2_compliance": file}, check=3).complaint[0]
    assert "-body2_compliance" in message


# ---------------------------------------------------------------- the stiffness over load cases, and pairs


@pytest.mark.parametrize("number", (1, 2))
def test_stiffness_over_load_cases_is_the_derivative_of_steps(number, layer, tmp_path):
    """Forward against central differences of tries; at reversal symmetric between components and between cases."""
    rng = np.random.default_rng(number)
    cases = dict(bend=1e-3 * rng.normal(size=(10, 3)), turn=1e-3 * rng.normal(size=(10, 3)))
    file = layer(0.5, 3, 0.3, cases=cases)
    given = dict(bodies(number), **{**SPHERE, "output_fields": None}, friction=0.3, normal_rtol=1e-11)
    given = {name: value for name, value in given.items() if value is not None}
    run_python(
        f"""
import numpy as np, petsam
names = [f"body{number}_case_{{name}}" for name in ("bend", "turn")]
with petsam.Contact(body{number}_compliance={str(file)!r}, tangential_rtol=1e-11, slip_direction="end",
                    **{given!r}) as contact:
    contact.try_step(disp_z=3e-3)
    contact.commit()
    at = dict(disp_z=3.1e-3, disp_x=4e-4, disp_y=1e-4, rot_x=1e-5, rot_y=-2e-5, rot_z=1e-4)
    at.update({{names[0]: 0.1, names[1]: -0.05}})
    loads = ["load_n", "load_tx", "load_ty", "load_mx", "load_my", "load_mz", *(name + "_load" for name in names)]
    order = ["disp_z", "disp_x", "disp_y", "rot_x", "rot_y", "rot_z", *names]
    def tried(**change):
        contact.try_step(**{{name: value + change.get(name, 0) for name, value in at.items()}})
        return np.array([contact.number(name) for name in loads])
    tried()
    assert 0 < np.mean(contact.field("state") == 2) and np.any(contact.field("state") == 1)
    forward, reversal, plain = (contact.stiffness(reverse, cases=given)
                                for reverse, given in ((False, names), (True, names), (False, ())))
    assert list(forward.loads) == loads and list(forward.displacements) == order
    assert np.allclose(np.asarray(plain), forward[:6, :6], rtol=1e-5, atol=1e-8 * abs(plain.max()))
    steps = [2e-6] * 3 + [2e-6] * 3 + [2e-3] * 2
    for column, (name, step) in enumerate(zip(order, steps)):
        difference = (tried(**{{name: step}}) - tried(**{{name: -step}})) / (2 * step)
        error = np.linalg.norm(difference - forward[:, column]) / np.linalg.norm(difference)
        assert error < 1e-2, (name, error, difference, forward[:, column])
    sign = np.diag([1.0] * 6 + [-1.0] * 2)
    symmetric = sign @ np.asarray(reversal)
    assert np.allclose(symmetric, symmetric.T, rtol=1e-7, atol=1e-9 * abs(symmetric).max())
    assert np.all(np.linalg.eigvalsh(symmetric) > 0)
    held = contact.stiffness(True, condense=names[0], cases=names)
    free = np.linalg.inv(np.asarray(reversal))[6, 6]
    assert abs(held * free - 1) < 1e-6
    for bad, text in (("body{number}_case_pull", "is no load case"), ("friction_scale", "no load that belongs")):
        try:
            contact.stiffness(cases=bad)
        except petsam.ContactError as error:
            assert bad in str(error) and text in str(error), error
        else:
            raise SystemExit("not refused")
""",
        tmp_path,
    )


def paired(file, **bodies):
    """The file as that of a pair whose body 1 has these constants."""
    with h5py.File(file, "a") as f:
        f.attrs.update({f"{name}1": value for name, value in bodies.items()})
    return file


def test_compliance_of_a_pair_is_that_of_both_bodies(solve, layer, tmp_path):
    """One file for both, whose matrix is the sum, in the frame of body 2."""
    matrix = 0.4 * compliances.layer(0.5, 4)
    turned = np.einsum("aibj,i,j->aibj", matrix, *2 * [np.array([1, -1, -1])])
    table = compliances.powers(4)
    odd = (-1.0) ** table[:, 1]  # y of body 1 is -y of the contact
    turned *= odd[:, None, None, None] * odd[None, None, :, None]
    lone = compliances.write(tmp_path / "one.h5", matrix)
    both = paired(compliances.write(tmp_path / "pair.h5", matrix + turned), young=1.0, poisson=0.3)
    given = {**SPHERE, "gap_type": "ellipsoid", "gap_radius_x": 20, "gap_radius_y": 30}
    given = {name: value for name, value in given.items() if name not in ("gap_radius1", "gap_radius2")}
    given.update({f"body{b}_{name}": value for b in (1, 2) for name, value in (("young", 1), ("poisson", 0.3))})
    r = solve(given, SHEAR, dict(body2_compliance=both))
    plain = solve(given, SHEAR, dict(body1_compliance=lone, body2_compliance=lone))
    for name in ("pressure", "shear_x", "shear_y", "displacement_z"):
        assert l2(getattr(r, name), getattr(plain, name)) < 1e-7, name


@pytest.mark.parametrize("pair", (True, False))
def test_pair_is_measured_against_both_half_spaces(pair, petsam, layer):
    """A correction that takes 1.5 times the half-space of body 2, or 0.74 of the two together."""
    file = layer(0.25, 0, 1.5)
    if pair:
        paired(file, young=1.0, poisson=0.3)
    both = {f"body{b}_{name}": value for b in (1, 2) for name, value in (("young", 1), ("poisson", 0.3))}
    done = petsam({**SPHERE, "grid_n": 8}, both, dict(load_n=1e-4, body2_compliance=file), check=0 if pair else 3)
    assert pair or "would gain energy" in done.complaint[0]


@pytest.mark.parametrize(
    "given, text",
    [
        (dict(body1_compliance="pair.h5"), "is of a pair of bodies: give it to -body2_compliance alone"),
        (dict(body1_compliance="one.h5", body2_compliance="pair.h5"), "is of a pair and has body 1 already"),
        (dict(body2_compliance="pair.h5", body1_young=1.5), "was made for body 1 with young 1, not 1.5"),
        (dict(body2_compliance="pair.h5", body1_poisson=0.2), "was made for body 1 with poisson 0.3, not 0.2"),
        (dict(body2_compliance="bad.h5"), "young1 is inf, poisson1 0.3: expected a finite modulus > 0"),
    ],
)
def test_pair_that_does_not_fit_is_refused(given, text, petsam, tmp_path):
    matrix = compliances.layer(0.5, 2)
    for name, young in (("one", None), ("pair", 1.0), ("bad", np.inf)):
        file = compliances.write(tmp_path / f"{name}.h5", matrix)
        if young:
            paired(file, young=young, poisson=0.3)
    both = {f"body{b}_{name}": value for b in (1, 2) for name, value in (("young", 1), ("poisson", 0.3))}
    done = petsam({**SPHERE, "grid_n": 8}, both, dict(load_n=1e-4), given, check=None)
    assert text in done.complaint[0]


def test_degrees_may_differ_along_the_axes(solve, tmp_path):
    """Degree 14 in x and 2 in y: the load of a case whose displacement is a wave in x."""
    table = np.array([(a, b) for a in range(15) for b in range(3)])
    x, weight = np.polynomial.legendre.leggauss(40)
    field = np.zeros((45, 3))
    for k, (a, b) in enumerate(table):
        if b == 0:
            along = np.polynomial.legendre.legval(x, np.eye(15)[a]) * np.sqrt(a + 0.5)
            field[k, 2] = 1e-4 * np.sum(weight * along * np.cos(6 * x)) * np.sqrt(2)
    file = compliances.write(tmp_path / "c.h5", np.zeros((45, 3, 45, 3)), table=table, cases=dict(wave=field))
    r = solve({**SPHERE, "gap_radius1": 20}, STEEL, dict(load_n=2e-4, body2_compliance=file, body2_case_wave=1))
    side = r.x[1] - r.x[0]
    wave = 1e-4 * np.cos(6 * r.x) * np.sin(3 * side) / (3 * side)
    with h5py.File(r.path) as f:
        load = f["history/body2_case_wave_load"][-1]
    assert load == pytest.approx(np.sum(r.pressure * wave) * side**2, rel=1e-5)


@pytest.mark.parametrize("given", ["load_n", "disp_z"])
def test_the_error_of_the_mesh_is_that_of_another_compliance(given, petsam, layer, tmp_path):
    """As a run with the compliance that has this error; a cause of its own, with a warning above 5 %."""
    part, found = 0.1, []
    value = {"load_n": 0.004, "disp_z": 0.003}[given]
    for factor in (1.0, 1.0 + part):
        file = layer(1, 6, factor)
        with h5py.File(file, "a") as f:
            f["mesh_error"] = part
        words = {**SPHERE, **bodies(2), "load_n": None, given: value, "body2_compliance": file}
        run = petsam(words, "-errors", "companion", "-output", tmp_path / "f.h5")
        with h5py.File(tmp_path / "f.h5") as f:
            rows = {name.decode(): k for k, name in enumerate(f["errors/name"][:])}
            found.append({name: (f["errors/value"][k], f["errors/by_mesh"][k]) for name, k in rows.items()})
    assert "by mesh" in run.stdout and "warning: error by the mesh: " in run.stderr
    sought = ["disp_z"] if given == "load_n" else ["load_n", "contact_area", "pressure_max"]
    for name in [*sought, "stored_energy"]:
        (one, told), (other, _) = found[0][name], found[1][name]
        true = abs(other / one - 1.0)
        assert 0.9 * true < told < 4.0 * true, name


def test_a_displacement_that_is_0_by_symmetry_has_no_error_of_the_mesh(petsam, layer, tmp_path):
    file = layer(1, 6)
    with h5py.File(file, "a") as f:
        f["mesh_error"] = 0.5
    shear = dict(friction=0.3, load_n=0.004, load_tx=6e-4, steps=2)
    words = {**SPHERE, **bodies(2), **shear, "body2_compliance": file}
    said = petsam(words, "-errors", "companion", "-output", tmp_path / "f.h5").stderr
    (line,) = [one for one in said.splitlines() if "error by the mesh: " in one]
    assert "disp_z " in line and "disp_x " in line and "disp_y" not in line
