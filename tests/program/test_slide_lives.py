"""Lives of surfaces that slide past each other: scars of both bodies over many cycles, by magnified cycles."""

import re

import numpy as np
import pytest

import compliances
from support import history, read_run, waves

STEEL = dict(body1_young=200e9, body1_poisson=0.3, body2_young=200e9, body2_poisson=0.3)
LINE = 18500.0  # N/m
CYLINDER = dict(
    STEEL,
    elasticity="plane",
    plane_datum=6e-3,
    gap_type="ellipsoid",
    gap_radius_x=6e-3,
    gap_radius_y=float("inf"),
    load_n=LINE,
    rot_y=0,
    friction=0.9,
    slide=True,
)
K = (1.9e-14, 2.9e-14)  # 1/Pa
SPHERE = dict(
    STEEL,
    body1_young=210e9,
    body2_young=210e9,
    gap_type="sphere",
    gap_radius1=10e-3,
    gap_radius2=float("inf"),
    load_n=20.0,
    disp_y=0,
    rot_x=0,
    rot_y=0,
    rot_z=0,
    friction=1e-13,
    slide=True,
    wear_coefficient1=1e-14,
    wear_coefficient2=2e-14,
    grid_n="96,48",
    grid_size="1.2e-3,0.6e-3",
)


@pytest.fixture
def life(petsam, tmp_path):
    """life(case, stroke, places=(1, -1, 1), ...): results of a life to and fro through these parts of the stroke."""

    def run(case, stroke, places=(1, -1, 1), name="life", ranks=1, **words):
        rows = [(float(time), place * stroke) for time, place in enumerate(places)]
        loads = history(tmp_path / f"{name}.csv", "time,disp_x", *rows)
        petsam({**case, "output_every": 1000, "output": f"{name}.h5", **loads, **words}, ranks=ranks)
        return read_run(tmp_path / f"{name}.h5")

    return run


def worn(r, body):
    return r[f"wear_depth{body}"][-1]


def width(r, body):
    """Of a scar where it is a hundredth of its depth, interpolated."""
    x, depth = r["x"], worn(r, body)[0]
    least = 0.01 * depth.max()
    first, last = np.flatnonzero(depth >= least)[[0, -1]]
    left = np.interp(least, depth[first - 1 : first + 1], x[first - 1 : first + 1])
    return np.interp(-least, -depth[last : last + 2], x[last : last + 2]) - left


# ---- scars that are known


def test_the_scars_of_mccoll(life):
    """McColl, Ding and Leen 2004 after 18,000 cycles, as another program has them; area = k N times the path."""
    r = life(
        CYLINDER,
        25e-6,
        steps=8,
        grid_n=256,
        grid_size=0.8e-3,
        wear_coefficient1=K[0],
        wear_coefficient2=K[1],
        wear_cycles=18000,
    )
    assert worn(r, 2).max() == pytest.approx(2.731e-6, rel=3e-3, abs=0)
    assert width(r, 2) == pytest.approx(0.509e-3, rel=3e-3, abs=0)
    assert r["wear/volume2"][-1] == pytest.approx(0.9483e-9, rel=3e-3, abs=0)
    assert worn(r, 1).max() == pytest.approx(2.0413e-6, rel=3e-3, abs=0)
    assert len(r["wear/cycle"]) < 40


def test_a_sphere_and_its_flat(life):
    """Depths of both bodies by another program; volumes are k N times the path."""
    r = life(SPHERE, 0.15e-3, steps=6, wear_cycles=400, wear_jump=50)
    assert worn(r, 1).max() == pytest.approx(0.8866e-6, rel=6e-4, abs=0)
    assert worn(r, 2).max() == pytest.approx(0.9383e-6, rel=6e-4, abs=0)
    for body in (1, 2):
        exact = body * 1e-14 * 20.0 * 4 * 0.15e-3 * 400
        assert r[f"wear/volume{body}"][-1] == pytest.approx(exact, rel=1e-12, abs=0)
        assert worn(r, body).sum() * (1.2e-3 / 96) ** 2 == pytest.approx(exact, rel=1e-11, abs=0)


@pytest.mark.parametrize(
    "law, steps, shares, words",
    [
        ("coefficient", 7, (1, 2), dict(wear_jump=120)),
        ("coefficient", 5, (0, 1), dict(wear_rtol=0.3)),
        ("energy", 6, (1, 0.5), dict(wear_rtol=0.3)),
    ],
)
def test_volumes_are_those_of_the_path(life, law, steps, shares, words):
    """k N 4 S a cycle, whatever the stroke, the steps and the jumps are in cells."""
    friction = 1e-13
    rates = [1e-14 * share / (friction if law == "energy" else 1) for share in shares]
    words.update({f"wear_{law}{body}": rate for body, rate in zip((1, 2), rates) if rate > 0})
    r = life(CYLINDER, 23.7e-6, friction=friction, steps=steps, grid_n=96, grid_size=4e-4, wear_cycles=1000, **words)
    for body, share in zip((1, 2), shares):
        exact = share * 1e-14 * LINE * 4 * 23.7e-6 * 1000
        assert r[f"wear/volume{body}"][-1] == pytest.approx(exact, rel=1e-12, abs=0)
        assert worn(r, body).min() >= 0


def test_waves_wear_each_other_off(life, tmp_path):
    """Full contact, waves a: da/ds = -(pi E*/wave) [[k1, k1 c], [k2 c, k2]] a, c the mean cosine of the positions."""
    wave, n, cells, e_star, path, a = 1e-4, 64, 8, 1e11, 0.04, (2e-8, 1e-8)
    case, cosine = waves(tmp_path, n, wave, e_star, a)
    case.update(load_n=200e6 * wave, friction=1e-9, wear_coefficient1=2e-14, wear_coefficient2=3e-14)
    places = np.concatenate([np.arange(cells, -cells, -1), np.arange(-cells, cells)])
    c, k = np.mean(np.cos(2 * np.pi * places / n)), np.array([[2e-14], [3e-14]])
    values, vectors = np.linalg.eig(-np.pi * e_star / wave * path * k * np.array([[1, c], [c, 1]]))
    exact = vectors @ (np.exp(values) * np.linalg.solve(vectors, a))
    cycles, errors = round(path / (4 * cells * wave / n)), []
    for jumps in (10, 20, 40):
        r = life(case, cells * wave / n, steps=2 * cells, wear_cycles=cycles, wear_jump=cycles // jumps)
        heights = [a[b - 1] * cosine + worn(r, b)[0] for b in (1, 2)]
        errors.append(np.abs([2 * np.mean(h * cosine) for h in heights] - exact) / np.abs(exact))
    assert np.all(errors[-1] < 4e-3)
    for coarse, fine in zip(errors, errors[1:]):
        assert np.all(coarse > 3 * fine)


@pytest.mark.parametrize(
    "cycles, jump", [(40000, 700), (40000, 1000), (40000, 2500), (120000, 500), (120000, 1000), (120000, 1700)]
)
def test_full_contact_without_waves_is_solved(life, tmp_path, cycles, jump):
    """What is left of the waves is rounding of the depth worn: the limit of the check is not less than its error."""
    wave, n, cells = 1e-4, 64, 8
    case, _ = waves(tmp_path, n, wave, 1e11, (2e-8, 1e-8))
    case.update(load_n=200e6 * wave, friction=1e-9, wear_coefficient1=2e-14, wear_coefficient2=3e-14)
    r = life(case, cells * wave / n, steps=2 * cells, wear_cycles=cycles, wear_jump=jump)
    assert (r["pressure"][-1] > 0).all()


# ---- steps that slide far


PIN = dict(SPHERE, load_n=1.0, friction=0.3, grid_n="128,32", grid_size="0.8e-3,0.2e-3", wear_coefficient1=1e-15)


@pytest.mark.parametrize(
    "case, stroke, cycles, counts",
    [(CYLINDER, 25e-6, 18000, (1,)), (dict(PIN, wear_coefficient2=1e-14), 0.2e-3, 400, (1, 2, 4))],
)
def test_steps_that_slide_far_are_told_with_their_error(petsam, tmp_path, case, stroke, cycles, counts):
    """The estimate is within a factor of 3 of the error of the depth of body 2 against 32 steps per stroke."""
    if case is CYLINDER:
        case = dict(case, wear_coefficient1=K[0], wear_coefficient2=K[1], grid_n=256, grid_size=0.8e-3)
    places = [(float(k), place * stroke) for k, place in enumerate((1, -1, 1))]
    rows = history(tmp_path / "h.csv", "time,disp_x", *places)
    depth = {}
    for steps in (32, *counts):
        words = dict(wear_cycles=cycles, steps=steps, output="life.h5", output_every=1000)
        told = petsam(case, rows, words).stderr
        r = read_run(tmp_path / "life.h5")
        depth[steps] = r["wear/depth_max2"][-1]
        assert ("of the contact's length (limit 0.25)" in told) == (steps < 32)
        if steps < 32:
            true = abs(depth[steps] / depth[32] - 1)
            assert true / 3 < r["wear/error"][-1] < 3 * true


def test_a_block_on_a_ring_needs_not_move(life):
    """Only body 1 wears, by much more than it is displaced: a chord of the ring, of the volume k N times the path."""
    radius, load, k, path = 20e-3, 10833.3, 2e-15, 800.0
    words = dict(
        gap_radius_x=radius, load_n=load, body1_young=210e9, body2_young=210e9, wear_coefficient1=k, grid_n=180
    )
    r = life(CYLINDER, 1e-3, friction=0.1, steps=2, grid_size=3.6e-3, wear_cycles=path / 4e-3, **words)
    half = np.cbrt(1.5 * radius * k * load * path)
    assert worn(r, 1).max() == pytest.approx(16.1535e-6, rel=1.5e-3, abs=0)
    assert worn(r, 1).max() == pytest.approx(half**2 / (2 * radius), rel=3e-3, abs=0)
    assert worn(r, 2).max() == 0


PIN = dict(CYLINDER, elasticity="plane_periodic", plane_datum=None, friction=0.5, grid_size=4e-4)


@pytest.mark.parametrize("turns, k1", [(1, 1.9e-14), (-2, 0)])
def test_a_pin_wears_the_whole_track_of_a_disc_alike(life, turns, k1):
    """Body 2 repeats itself: after whole turns the cycle is closed. Each of its points loses k2 N a turn."""
    size, cycles = PIN["grid_size"], 60
    words = dict(wear_coefficient1=k1 or None, wear_coefficient2=K[1], wear_cycles=cycles, wear_jump=20)
    places = (0.3, 0.3 + turns / 2, 0.3 + turns)
    r = life(PIN, size, places=places, grid_n=64, steps=16 * abs(turns), **words)
    for body, k in ((1, k1), (2, K[1])):
        exact = k * LINE * abs(turns) * cycles
        assert r[f"wear/volume{body}"][-1] == pytest.approx(exact * size, rel=1e-8, abs=0)  # the tangential tolerance
        assert body == 1 or np.abs(worn(r, body) / exact - 1).max() < 0.02
    assert np.ptp(r["history/slide_x"]) < (abs(turns) + 0.01) * size  # no more in later cycles
    assert np.all(np.sign(turns) * (r["history/disp_x"] - r["history/slide_x"]) > 0)  # behind, by what bends the bodies


def test_a_ball_on_a_disc_wears_a_track_of_its_shape(life):
    """The cross-section is k N a turn, a segment of the ball but for what the bodies are bent."""
    turns, k2 = 2500, 1e-13
    case = dict(SPHERE, elasticity="periodic", grid_n="32,36", grid_size="0.8e-3,0.6e-3", load_n=2.0)
    words = dict(wear_coefficient1=None, wear_coefficient2=k2, wear_cycles=turns, wear_rtol=0.3)
    r = life(case, 0.8e-3, places=(0, 0.5, 1), steps=8, **words)
    area = k2 * 2.0 * turns
    assert r["wear/volume2"][-1] == pytest.approx(area * 0.8e-3, rel=1e-12, abs=0)
    depth = (3 * area / (4 * np.sqrt(2 * 10e-3))) ** (2 / 3)
    assert worn(r, 2).max(axis=0).mean() == pytest.approx(depth, rel=0.01, abs=0)


def test_a_cycle_that_ends_elsewhere_is_not_closed(petsam, tmp_path):
    """Neither by a part of a turn, nor where bodies do not repeat themselves or do not slide."""
    for end, words in ((4.1e-4, {}), (4e-4, dict(elasticity="plane")), (4e-4, dict(slide=None))):
        rows = history(tmp_path / "h.csv", "time,disp_x", (0.0, 0.0), (1.0, 2e-4), (2.0, end))
        case = dict(PIN, **rows, grid_n=32, wear_coefficient2=1e-14, wear_cycles=10)
        assert "not a closed cycle: disp_x" in petsam({**case, **words}, check=2).stderr


# ---- jumps


@pytest.mark.parametrize("stroke, cycles", [(0.6e-6, 20000), (25e-6, 1600)], ids=["partial slip", "gross slip"])
def test_jumps_are_of_second_order(life, stroke, cycles):
    """From partial slip to gross slip by one method."""
    case = dict(CYLINDER, grid_n=80, grid_size=4e-4, wear_coefficient1=K[0], wear_coefficient2=K[1], steps=6)
    runs = [life(case, stroke, wear_cycles=cycles, wear_jump=cycles // jumps) for jumps in (8, 16, 32)]
    for name in ("wear_depth1", "wear_depth2"):
        coarse, fine, finer = (r[name][-1] for r in runs)
        assert np.linalg.norm(fine - coarse) > 2.5 * np.linalg.norm(finer - fine), name
        assert np.linalg.norm(finer - fine) < 2e-3 * np.linalg.norm(finer), name


def test_a_very_long_life_in_partial_slip_ends_where_nothing_slides(life):
    """Two million cycles, to the end of all wear: magnified cycles and jumps by means lead to the same scar."""
    case = dict(CYLINDER, grid_n=64, grid_size=2e-4, wear_coefficient1=K[0], wear_coefficient2=K[1], steps=8)
    one, other = (
        life(case, 0.35e-6, places=(0, 1, -1, 0), wear_cycles=2e6, wear_rtol=0.01, slide=slide, name=f"slide{slide}")
        for slide in (True, None)
    )
    assert np.all(one["history/slide_x"] == 0)
    for body in (1, 2):
        assert np.abs(worn(one, body) - worn(other, body)).max() < 1e-4 * worn(other, body).max()


def test_the_error_is_that_of_the_tolerance(life):
    """0.1 unless it is given; a smaller one computes more cycles and errs less."""
    case = dict(CYLINDER, grid_n=96, grid_size=3e-4, wear_coefficient1=K[0], wear_coefficient2=K[1], wear_cycles=1000)
    runs = [
        life(case, 25e-6, steps=6, name=f"{n}", **w)
        for n, w in enumerate([{}, dict(wear_rtol=0.1), dict(wear_rtol=0.01)])
    ]
    for name in ("wear_depth1", "wear_depth2", "wear/error"):
        assert np.array_equal(runs[0][name], runs[1][name]), name
        coarse, fine = runs[0][name][-1], runs[2][name][-1]
        assert name == "wear/error" or np.linalg.norm(coarse - fine) < 0.01 * np.linalg.norm(fine), name
    assert runs[0]["wear/error"].max() <= 0.2 and runs[2]["wear/error"].max() <= 0.02
    assert len(runs[0]["wear/cycle"]) < 0.5 * len(runs[2]["wear/cycle"])


# ---- the same bits, and what is refused


@pytest.mark.parametrize("ranks", [2, 3])
def test_any_number_of_ranks_has_the_same_bits(life, ranks):
    case = dict(SPHERE, friction=0.3, grid_n="48,24", disp_y=None, load_ty=0, steps=3, wear_cycles=90, wear_jump=30)
    one, other = (life(case, 0.15e-3, ranks=count, name=f"on{count}") for count in (1, ranks))
    for name in one:
        assert np.array_equal(one[name], other[name], equal_nan=one[name].dtype.kind == "f"), name


def test_a_life_goes_on_where_it_was_left(life, petsam, tmp_path):
    case = dict(CYLINDER, grid_n=64, grid_size=3e-4, wear_coefficient1=K[0], wear_coefficient2=K[1], steps=4)
    whole = life(case, 25e-6, wear_cycles=600, wear_output="200", name="whole")
    life(case, 25e-6, wear_cycles=200, name="part", checkpoint="state.h5", checkpoint_every=1)
    rest = life(case, 25e-6, wear_cycles=600, name="part", restart="state.h5")
    for name in ("pressure", "wear_depth1", "wear_depth2", "wear/cycle", "wear/volume2", "wear/error"):
        assert np.array_equal(whole[name][-1], rest[name][-1]), name


@pytest.mark.parametrize("cycles", [None, 100])
def test_a_run_that_its_own_rotation_ends_has_the_fields_of_its_last_step(petsam, tmp_path, cycles):
    """A moment that is given turns the ball further in each stroke: in a life, before the first cycle is written."""
    rows = [(0.0, 1e-4, 3e-6), (1.0, -1e-4, 3e-6), (2.0, 1e-4, 3e-6)]
    case = dict(SPHERE, **history(tmp_path / "h.csv", "time,disp_x,load_mz", *rows), rot_z=None, friction=0.3)
    case.update(grid_n="24", grid_size=8e-4, steps=4, output="out.h5", output_every=1000, wear_cycles=cycles)
    done = petsam(case, check=2)
    assert "found for load_mz in the step before" in done.stderr and "give rot_z = 0" in done.stderr
    r = read_run(tmp_path / "out.h5")
    assert len(r["time"]) == 1 and r["time"][-1] == r["history/time"][-1]
    assert r["history/rot_z"][-1] > 2 / 24
    assert r["pressure"][-1].sum() * (8e-4 / 24) ** 2 == pytest.approx(20.0, rel=1e-9, abs=0)


# ---- other bodies


BODIES = {
    "layer": dict(CYLINDER, body1_layer_young=800e9, body1_layer_poisson=0.2, body1_layer_thickness=2e-5),
    "dissimilar": dict(CYLINDER, body1_young=20e9, body1_poisson=0.1, body2_young=400e9, friction=0.5),
    "finite": dict(SPHERE, friction=0.3, body1_compliance="body.h5", grid_size=0.8e-3, grid_n=24),
}


@pytest.mark.parametrize("bodies", BODIES)
def test_a_jump_leads_where_its_cycles_do(life, petsam, tmp_path, bodies):
    """Two jumps for all cycles of a history, each step of which wears; volumes are k/friction times the work."""
    compliances.write(tmp_path / "body.h5", 0.2 * np.eye(3).reshape(1, 3, 1, 3), half=4e-4, young=210e9)
    plane = bodies != "finite"
    k1, k2, stroke, cycles = (1e-14, 2e-14, 20e-6, 24) if plane else (2e-14, 4e-14, 6e-5, 12)
    case = dict(BODIES[bodies], wear_coefficient1=k1, wear_coefficient2=k2, wear_jump=cycles // 2)
    case.update(dict(grid_n=64, grid_size=2.5e-4) if plane else {})
    one = life(case, stroke, steps=6, wear_cycles=cycles)
    case["wear_jump"] = None
    first, every = (
        life(case, stroke, places=(1,) + (-1, 1) * count, steps=6, name=f"every{count}") for count in (0, cycles)
    )
    for body in (1, 2):
        exact = (k1, k2)[body - 1] * np.nansum(every["history/dissipated_energy"][6:]) / case["friction"]
        assert one[f"wear/volume{body}"][-1] == pytest.approx(exact, rel=2e-6, abs=0)
        depth = worn(every, body) - worn(first, body)
        assert np.abs(worn(one, body) - depth).max() < 4e-3 * depth.max()


def test_few_steps_a_stroke_leave_a_tip_of_pressure(petsam, tmp_path):
    """At the end of the stroke the scar is uneven: warned of, with its size, unless the steps are short."""
    case = dict(CYLINDER, gap_radius_x=1.7e-3, plane_datum=1e-3, load_n=2400.0, friction=0.8, wear_coefficient2=7e-15,
                body1_young=70e9, body2_young=70e9, grid_n=199, grid_size=6.4e-5, wear_cycles=4600)  # fmt: skip
    rows = history(tmp_path / "h.csv", "time,disp_x", (0, 4e-6), (1, -4e-6), (2, 4e-6))
    peak, told = {}, {}
    for steps in 2, 8:
        told[steps] = petsam(case, rows, dict(steps=steps, output="o.h5", overwrite=True)).stderr
        peak[steps] = read_run(tmp_path / "o.h5")["wear/pressure_max"][-1]
    found = re.search(r"tip (\d+) % above .* may be wrong by (\d+) %: use 2 times more steps", told[2])
    assert float(found[2]) == pytest.approx(100 * (peak[2] / peak[8] - 1), rel=0.5)
    assert "tip" not in told[8]
