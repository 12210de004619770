"""Plastic strain goes with the material: where the bodies roll, slide past each other, or wear."""

import math

import numpy as np
import pytest

import petsam
import support
from test_yield import LOAD, RADIUS, YIELD, all_steps, sphere, steps

CELLS = 24
CELL = 2.9 * 1.3 * 6 ** (1 / 3) * RADIUS / CELLS  # as in sphere()
STRAIN = "plastic/plastic_strain"


def field(results, name, step=-1):
    with petsam.open(results.path) as run:
        return run.field(name, len(run.steps) + step)


def moving(path, n=CELLS, **more):
    """A sphere on a body that hardens, with the columns of a history."""
    columns = {key: more.pop(key) for key in list(more) if isinstance(more[key], list)}
    return sphere(n, 8, body2_hardening="linear:0.01", output_fields="usual,plastic", **steps(path, **columns), **more)


def test_a_rolling_ball_leaves_the_groove_of_a_sliding_one_without_friction(solve, tmp_path):
    places = [k * CELL for k in range(7)]
    loads = [4 * LOAD] * len(places)
    rolled = solve(moving(tmp_path / "roll.csv", load_n=loads, roll=[0.0] + [CELL] * 6))
    slid = solve(moving(tmp_path / "slide.csv", load_n=loads, disp_x=places, friction=1e-9, slide=True))
    assert all_steps(slid)["slide_x"] == pytest.approx(places, rel=1e-10)
    for name in "disp_z", "pressure_max", "plastic_max", "plastic_work", "residual_z_max":
        assert all_steps(slid)[name] == pytest.approx(all_steps(rolled)[name], rel=1e-5)
    for name in STRAIN, "plastic/plastic_strain_xz", "residual_z":
        assert support.l2(field(slid, name), field(rolled, name)) < 1e-5
    assert all_steps(rolled)["plastic_max"][-1] > 1.2 * all_steps(rolled)["plastic_max"][0]


@pytest.mark.parametrize("way", ["roll", "roll_y"])
def test_material_that_has_come_back_is_as_before(solve, tmp_path, way):
    loads = [LOAD * n for n in (5, 0, 0, 3)]
    there = solve(moving(tmp_path / f"{way}.csv", load_n=loads, **{way: [0.0, 3 * CELL, -3 * CELL, 0.0]}))
    here = solve(moving(tmp_path / "rest.csv", load_n=loads))
    for name in "pressure", STRAIN, "plastic/residual_stress_xx":
        assert support.l2(field(there, name), field(here, name)) < 1e-9


def test_the_next_dent_beside_the_first_is_that_of_virgin_material(solve, tmp_path):
    """Two dents two radii apart: residual stress of the first reaches the second, whose strain is little changed."""
    away = 8 * CELL
    two = solve(moving(tmp_path / "two.csv", load_n=[2 * LOAD, 0, 2 * LOAD], roll=[0.0, away, 0.0]))
    strain = field(two, STRAIN).max(axis=0)
    row = strain[CELLS // 2]
    assert row[CELLS // 2] == pytest.approx(row[CELLS // 2 - 8], rel=0.05)
    # rolled to +x, the material of the first dent lies behind
    assert row[: CELLS // 2 - 4].max() > 0.9 * row.max() and row[CELLS // 2 + 4 :].max() < 0.1 * row.max()


WIDTH = 16e-3  # of a period of the line, m


def line(path, peak, roll, loads):
    """A rigid cylinder on one period of a half-plane, of half width 1 mm at a peak pressure over the yield stress in
    shear; `roll` in cells and `loads` in that of the peak."""
    shear, n = 1e8, 64
    young = 2 * 1000 * shear * 1.3
    load = math.pi / 2 * 1e-3 * peak * shear
    rows = [(float(k), load * part, WIDTH / n * cells) for k, (part, cells) in enumerate(zip(loads, roll))]
    return dict(
        elasticity="plane_periodic",
        grid_n=n,
        grid_size=WIDTH,
        body1_young="inf",
        body2_young=young,
        body2_poisson=0.3,
        gap_type="sphere",
        gap_radius1=young / (1 - 0.3**2) * 1e-3 / 2 / (peak * shear),
        gap_radius2="inf",
        body2_yield=shear * math.sqrt(3),
        yield_layers=20,
        yield_depth=2.5e-3,
        yield_first=0.125e-3,
        output_fields="usual,plastic",
        **support.history(path, "time,load_n,roll", *rows),
    )


@pytest.mark.slow
@pytest.mark.parametrize("peak, goes_on", [(3.9, False), (4.4, True)])
def test_rolling_shakes_down_below_four_times_the_yield_stress_in_shear(petsam, tmp_path, peak, goes_on):
    """Johnson, Contact Mechanics (1985), section 9.2: of a line that rolls without friction the limit is p0 = 4 k."""
    passes, n = 5, 64
    case = line(tmp_path / "roll.csv", peak, [0] + [-1] * (passes * n), [1] * (1 + passes * n))
    petsam(case, dict(output=tmp_path / "roll.h5", output_every=n))
    work = all_steps(support.Results(tmp_path / "roll.h5"))["plastic_work"]
    passed = [work[1 + k * n : 1 + (k + 1) * n].sum() for k in range(passes)]
    if goes_on:
        assert passed[-1] > 0.15 * passed[1] and passed[-1] == pytest.approx(passed[-2], rel=0.1)
    else:
        assert passed[-1] < 0.02 * passed[0] and passed[-1] < 0.7 * passed[-2]


def test_a_period_rolled_is_the_place_of_the_start(solve, tmp_path):
    """What leaves a period enters it at the other side, so that a whole period in whole cells changes nothing."""
    loads = [1, 0, 0, 0, 0, 0.7]
    around = solve(line(tmp_path / "round.csv", 5.0, [0, 16, 16, 16, 16, 0], loads))
    still = solve(line(tmp_path / "still.csv", 5.0, [0] * 6, loads))
    assert all_steps(around)["plastic_max"][0] > 1e-4
    for name in "pressure", STRAIN:
        assert support.l2(field(around, name), field(still, name)) < 1e-9


# ---------------------------------------------------------------- wear


def rubbed(path, coefficient, yields=YIELD, **more):
    """Pressed above yield, then rubbed to and fro in gross slip under a small load, which does not yield."""
    n = [5 * LOAD] + [0.3 * LOAD] * 13
    x = [0.0, 0.0] + [2e-2 * RADIUS, -2e-2 * RADIUS] * 6
    return moving(
        path, load_n=n, disp_x=x, friction=0.2, wear_coefficient2=coefficient, body2_yield=yields, load_tx=None, **more
    )


def moments(results, first, slid=0):
    """By columns of body 2's own points: the fall of the strain's first moment over the depth since a step, the sum of
    the strain over the depth then, and the wear up to the last step but one; the body has slid by some cells since."""
    old, found = field(results, STRAIN, first), np.roll(field(results, STRAIN), slid, axis=2)
    with petsam.open(results.path) as run:
        z = run.layer_z
    edges = [0.0]
    for middle in z:
        edges.append(2 * middle - edges[-1])
    thickness = np.diff(edges)[:, None, None]
    fall = (thickness * z[:, None, None] * (old - found)).sum(axis=0)
    return fall, (thickness * old).sum(axis=0), field(results, "wear_depth2", -2)


def test_strain_comes_up_by_what_is_worn_off(solve, tmp_path):
    """The first moment of the strain over the depth falls by its sum times the wear up to the last step."""
    worn = solve(rubbed(tmp_path / "rub.csv", 20.0, yield_layers=16, yield_first=None))
    fall, strain, depth = moments(worn, -13)
    old = field(worn, STRAIN, -13)
    yielded = (old.sum(axis=0) > 0.5 * old.sum(axis=0).max()) & (old[0] < 1e-3 * old.max())
    assert yielded.sum() > 10 and depth[yielded].min() > 1e-7
    assert (fall / strain)[yielded] == pytest.approx(depth[yielded], rel=0.02)
    assert np.all((field(worn, STRAIN) == old) | (depth > 0))


def test_strain_comes_up_at_the_place_where_a_sliding_body_wears_its_dent(solve, tmp_path):
    """Body 2 slides by whole cells, but for 7e-4 of one at the first, so that its dent goes through the contact, which
    wears it. Interpolation moves the moment between columns, and keeps its sum."""
    n, x = [2 * LOAD, 0, *[0.3 * LOAD] * 5], [0.0, 0.0, *[k * CELL for k in range(5)]]
    case = moving(tmp_path / "x.csv", load_n=n, disp_x=x, friction=0.2, wear_coefficient2=1.0, slide=True)
    case.update(yield_layers=16, yield_first=case["yield_depth"] / 16)  # three yield: the moment is known to a sixth
    fall, strain, depth = moments(solve(case), -7, 4)
    assert fall.sum() == pytest.approx((strain * depth).sum(), rel=0.17, abs=0)


def test_strain_comes_up_at_the_place_where_a_sliding_body_wears(solve, tmp_path):
    """Body 2 is dented, slid by four cells without load, and worn beside the dent: the dent's strain stays."""
    n, x = (
        [5 * LOAD, 0, *[0.3 * LOAD] * 5],
        [0.0, 8 * CELL, 8 * CELL, *[8 * CELL + 0.1 * CELL * k for k in range(1, 5)]],
    )
    wear = dict(friction=0.2, wear_coefficient2=20.0, slide=True, allow_edge_contact=True)
    worn = solve(moving(tmp_path / "x.csv", load_n=n, disp_x=x, **wear))
    depth, dent, slid = field(worn, "wear_depth2", -2), field(worn, STRAIN, -8), field(worn, STRAIN)
    assert 0 < depth[dent.max(axis=0) > 0.5 * dent.max()].max() < 0.01 * depth.max()
    moved = np.roll(dent, -8, axis=2)  # the whole cells of the slide; the rest, 0.3 of a cell, is interpolated
    assert support.l2(slid.sum(axis=(1, 2)), moved.sum(axis=(1, 2))) < 1e-3
    assert slid.max() == pytest.approx(moved.max(), rel=0.05)


def test_wear_of_a_body_that_does_not_yield_is_that_of_an_elastic_one(solve, tmp_path):
    case = rubbed(tmp_path / "rub.csv", 1.0, yields=1.0, yield_depth=None, yield_first=None, coupling="none")
    elastic = {key: value for key, value in case.items() if "yield" not in key and "hardening" not in key}
    one, other = solve(case), solve({**elastic, "output_fields": "usual"})
    for name in "pressure", "wear_depth2", "shear_x":
        assert support.l2(field(one, name), field(other, name)) < 1e-6


@pytest.mark.parametrize("body2_wears", [True, False])
def test_ranks_and_restart_give_the_same_bits_with_wear_and_slide(petsam, tmp_path, body2_wears):
    n, x = [2 * LOAD, 4 * LOAD, 3 * LOAD, 4 * LOAD], [0.0, 0.4 * CELL, 1.3 * CELL, 0.7 * CELL]
    case = moving(
        tmp_path / "x.csv",
        n=13,
        load_n=n,
        disp_x=x,
        friction=0.2,
        slide=True,
        body1_young=2,
        body1_yield=2 * YIELD,
        wear_coefficient1=0.5,
        wear_coefficient2=1.0 if body2_wears else 0.0,
    )
    kept = dict(output=tmp_path / "on.h5", checkpoint=tmp_path / "state.h5", checkpoint_every=2)
    petsam(case, dict(output=tmp_path / "one.h5"))
    petsam(case, dict(output=tmp_path / "three.h5"), ranks=3)
    petsam(case, kept)
    petsam(case, dict(output=tmp_path / "on.h5", restart=tmp_path / "state.h5.1"), ranks=2)
    one, three, on = (support.read_run(tmp_path / f"{name}.h5") for name in ("one", "three", "on"))
    for name in "pressure", "shear_x", "plastic_strain", "wear_depth1", "history/plastic_work", "history/disp_z":
        assert np.array_equal(one[name], three[name]) and np.array_equal(one[name], on[name])


# ---------------------------------------------------------------- lives


def flank(path, force, rows, **more):
    """A cylinder in plane strain, of 1 mm at a peak 2.2 times the yield stress, under T_x to and fro."""
    young, stress, half = 210e9, 600e6, 1e-4
    normal = math.pi / 2 * half * 2.2 * stress
    loads = [(float(k), normal, part * force * normal) for k, part in enumerate(rows)]
    return dict(
        elasticity="plane",
        body1_young=young,
        body1_poisson=0.3,
        body2_young=young,
        body2_poisson=0.3,
        gap_type="sphere",
        gap_radius1=young / (1 - 0.3**2) / 2 * half / (2 * 2.2 * stress),
        gap_radius2="inf",
        grid_n=48,
        grid_size=3.2e-4,
        body2_yield=stress,
        body2_hardening="linear:2e10",
        yield_layers=12,
        friction=0.4,
        **support.history(path, "time,load_n,load_tx", *loads),
        **more,
    )


TURNS = [1, 0, -1, 0]


def test_a_life_of_a_body_that_yields_is_that_of_all_its_cycles(solve, tmp_path):
    """Every one of 40 cycles in steps that wear, and by jumps, which are short until the body has shaken down."""
    wear = dict(wear_coefficient2=1e-12)
    every = all_steps(solve(flank(tmp_path / "all.csv", 0.2, [0] + 40 * TURNS, **wear)))
    jumps = solve(flank(tmp_path / "one.csv", 0.2, [0, *TURNS], wear_cycles=40, wear_rtol=1e-2, **wear))
    short = all_steps(jumps)
    assert len(short["disp_z"]) < 0.4 * len(every["disp_z"])
    for name, most in ("wear_volume2", 0.01), ("plastic_max", 3e-3), ("residual_z_max", 3e-3), ("pressure_max", 1e-3):
        assert short[name][-1] == pytest.approx(every[name][-1], rel=most), name
    assert every["plastic_max"][-1] > 1e-3


@pytest.mark.parametrize("hardening, flows", [("none", True), ("linear:20GPa", False)])
def test_jumps_are_short_while_a_body_goes_on_yielding(petsam, tmp_path, hardening, flows):
    """Without hardening the surface layer flows in each cycle, which then is computed; else the body shakes down."""
    wear = dict(wear_coefficient2=1e-13, wear_cycles=12, wear_rtol=1e-2, output=tmp_path / "life.h5")
    case = flank(tmp_path / "one.csv", 0.35, [0, *TURNS], **wear)
    said = petsam(dict(case, body2_hardening=hardening)).complaint
    assert any("it has not shaken down" in line for line in said) == flows
    jump = support.read_run(tmp_path / "life.h5")["wear/jump"][1:]
    assert np.all(jump == 1) == flows and jump.sum() == 12


def test_a_life_above_yield_has_the_same_bits_on_any_number_of_ranks(petsam, tmp_path):
    case = moving(
        tmp_path / "x.csv",
        n=13,
        load_n=[4 * LOAD] * 5,
        load_tx=[0.0, 0.3 * LOAD, 0.0, -0.3 * LOAD, 0.0],
        friction=0.2,
        wear_coefficient2=1e-4,
        wear_cycles=30,
        wear_rtol=1e-2,
    )
    runs = []
    for ranks in 1, 3:
        petsam(case, dict(output=tmp_path / f"{ranks}.h5"), ranks=ranks)
        runs.append(support.read_run(tmp_path / f"{ranks}.h5"))
    for name in "pressure", "plastic_strain", "wear_depth2", "history/plastic_work", "wear/jump":
        assert np.array_equal(runs[0][name], runs[1][name])
