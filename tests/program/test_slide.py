"""Surfaces that slide past each other, or roll: scars, tracks, waves on waves, the same bits, and what is refused."""

import h5py
import numpy as np
import pytest

from support import ball, closed, history, read_run, waves

STEEL = dict(body1_young=200e9, body1_poisson=0.3, body2_young=200e9, body2_poisson=0.3)
CYLINDER = dict(
    STEEL,
    elasticity="plane",
    gap_type="ellipsoid",
    gap_radius_x=6e-3,
    gap_radius_y=float("inf"),
    friction=0.3,
    slide=True,
    output_fields="all",
)
LINE, HALF = 18500.0, 3.5863e-5  # N/m, and half the width of Hertz's contact
SPHERE = ball(32, half_width=3.0, load_n=None, slide=True)
RADIUS = float(SPHERE["grid_size"]) / 6


@pytest.fixture
def slide(petsam, tmp_path):
    """slide(case, header, *rows, **words): the results of a run through these rows, each one step by default."""

    def run(case, header, *rows, name="slid", **words):
        loads = history(tmp_path / f"{name}.csv", header, *[tuple(map(float, row)) for row in rows])
        petsam({**case, **loads, "output": f"{name}.h5", **words})
        return read_run(tmp_path / f"{name}.h5")

    return run


def surface(path, heights):
    with h5py.File(path, "w") as f:
        f.create_dataset("height", data=heights)
    return dict(body2_surface_file=path)


# ---- scars


@pytest.mark.parametrize("step", [1.0, 0.37])
def test_a_track_is_as_deep_as_all_of_the_load_that_passed(slide, step):
    """k N for each passage over a point; of a grid that goes with the pad, body 2's points pass under all of it."""
    n, size, k2 = 96, 4.8e-4, 2.9e-16
    passes = 3e-4 / (size / n * step)
    rows = [(0, LINE, -1.5e-4, 0), (1, LINE, 1.5e-4, 0), (2, LINE, -1.5e-4, 0)]
    r = slide(
        dict(CYLINDER, grid_n=n, grid_size=size, wear_coefficient2=k2),
        "time,load_n,disp_x,rot_y",
        *rows,
        steps=round(passes),
        output_every=10000,
    )
    assert r["history/slide_x"].max() == pytest.approx(1.5e-4, rel=0.01)
    track = r["wear_depth2"][-1, 0][(r["x"] > 2e-5) & (r["x"] < 8e-5)]  # the other end is worn on the way to the start
    assert track == pytest.approx(2 * k2 * LINE, rel=2e-4, abs=0)
    volume = r["history/wear_volume2"][-1]
    assert volume == pytest.approx(k2 * np.nansum(r["history/dissipated_energy"]) / 0.3, rel=1e-9, abs=0)
    assert r["wear_depth2"][-1].sum() * size / n == pytest.approx(volume, rel=1e-3, abs=0)  # none below 0


def test_a_sphere_leaves_the_track_of_its_pressure(slide):
    """pi/2 k p0 (a^2 - y^2)/a a passage."""
    n, k2 = 64, 1e-16
    case = ball(n, half_width=4.0, load_n=None, slide=True, wear_coefficient2=k2)
    h, a = closed.hertz(180.0, 0.06, 72e9 / (1 - 0.34**2) / 2), case["grid_size"] / 8
    rows = [(0, 180.0, -2.2 * a, 0, 0), (1, 180.0, 2.2 * a, 0, 0)]
    r = slide(case, "time,load_n,disp_x,rot_x,rot_y", *rows, steps=35, output_every=100)
    column = r["wear_depth2"][-1][:, np.argmin(np.abs(r["x"] - 1.1 * a))]
    expected = np.pi / 2 * k2 * h.pressure * np.maximum(a**2 - r["y"] ** 2, 0) / a
    assert np.abs(column - expected).max() < 0.02 * expected.max()
    assert column.sum() * case["grid_size"] / n == pytest.approx(k2 * 180.0, rel=2e-3, abs=0)


def test_scars_of_both_bodies_after_a_thousand_cycles(slide):
    """McColl, Ding and Leen 2004, each cycle wearing as 20 do: depths and widths of another program (trust: 1e-2)."""
    times, k1, k2 = 20, 1.9e-14, 2.9e-14
    n, size = 128, 0.512e-3
    rows = [(0, LINE, 0, 0), (0.5, LINE, 25e-6, 0)]
    rows += [(1 + k, LINE, -25e-6 if k % 2 == 0 else 25e-6, 0) for k in range(2 * 1000 // times)]
    r = slide(
        dict(
            CYLINDER, friction=0.9, plane_datum=6e-3, grid_n=n, grid_size=size, output_fields="wear_depth1,wear_depth2"
        ),
        "time,load_n,disp_x,rot_y",
        *rows,
        steps=8,
        wear_coefficient1=k1 * times,
        wear_coefficient2=k2 * times,
        output_every=10000,
    )
    assert r["wear_depth2"][-1].max() == pytest.approx(0.38104e-6, rel=1e-2, abs=0)
    assert r["wear_depth1"][-1].max() == pytest.approx(0.29370e-6, rel=1e-2, abs=0)
    for body, width in ((1, 0.17731e-3), (2, 0.21696e-3)):
        scar = r[f"wear_depth{body}"][-1, 0]
        assert np.sum(scar > 0.01 * scar.max()) * size / n == pytest.approx(width, abs=size / n)


def test_the_mirror_image(slide):
    """The same path the other way leaves the mirror images of both scars."""
    case = dict(SPHERE, wear_coefficient1=1e-14, wear_coefficient2=2e-14)
    path = [(0, 0, 0), (1, 0.7, 0.2), (2, -0.6, 0.5), (3, 0.3, -0.4)]
    runs = [
        slide(
            case,
            "time,load_n,disp_x,disp_y",
            *[(t, 180.0, sign * x * RADIUS, sign * y * RADIUS) for t, x, y in path],
            steps=3,
            name=f"run{sign}",
        )
        for sign in (1, -1)
    ]
    for name in ("wear_depth1", "wear_depth2", "pressure"):
        one, other = runs[0][name][-1], runs[1][name][-1, ::-1, ::-1]
        assert np.abs(one - other).max() < 1e-6 * one.max(), name
    assert (
        np.abs(runs[0]["wear_depth2"][-1] - runs[1]["wear_depth2"][-1]).max() > 0.1 * runs[0]["wear_depth2"][-1].max()
    )


def test_partial_slip_stays_what_it_is(slide):
    """Nothing moves while any point of the contact sticks."""
    case = dict(SPHERE, slide=None, wear_coefficient1=1e-14, wear_coefficient2=2e-14)
    amplitude = 1.1e-6
    rows = [(0, 180.0, 0), (1, 180.0, amplitude), (2, 180.0, -amplitude), (3, 180.0, amplitude)]
    one, other = (
        slide(case, "time,load_n,disp_x", *rows, steps=5, name=f"run{k}", slide=k or None) for k in (True, False)
    )
    assert one["history/stick_cells"][-1] > 20
    assert np.all(one["history/slide_x"] == 0)
    for body in (1, 2):
        scar = other[f"wear_depth{body}"][-1]
        assert np.abs(one[f"wear_depth{body}"][-1] - scar).max() < 1e-6 * scar.max()


@pytest.mark.parametrize("friction, amplitude", [(0.3, 2e-6), (0.3, 20e-6), (0.03, 20e-6)])
def test_the_slide_is_that_of_the_point_that_slips_last(slide, friction, amplitude):
    """d minus the largest elastic displacement in contact while all of it slips; what it was while any point sticks."""
    rows = [(0, LINE, 0, 0)] + [(k + 1, LINE, place * amplitude, 0) for k, place in enumerate((1, -1, 1))]
    r = slide(dict(CYLINDER, friction=friction, grid_n=48, grid_size=1e-4), "time,load_n,disp_x,rot_y", *rows, steps=9)
    d, slid, u = r["history/disp_x"], r["history/slide_x"], r["displacement_x"][:, 0]
    contact = r["pressure"][:, 0] > 0
    sticks = r["history/stick_cells"] > 0
    assert 3 < sticks.sum() < len(sticks) - 3
    for k in range(2, len(d)):
        way = np.sign(d[k] - d[k - 1])
        bent = way * (way * u[k][contact[k]]).max()
        assert slid[k] == pytest.approx(slid[k - 1] if sticks[k] else d[k] - bent, rel=1e-4, abs=1e-12)


# ---- heights that go with body 2


def test_waves_on_waves_have_the_height_of_their_sum(slide, tmp_path):
    """Full contact of waves a1, a2: pmean +- pi E* A/lambda with the amplitude A of both where body 2 has moved to."""
    wave, e_star, a1, a2, pressure = 1e-4, 1e11, 2e-8, 1e-8, 200e6
    case = waves(tmp_path, 64, wave, e_star, (a1, a2))[0]
    places = [0, 0.25, 0.5, 2.75, -16.5]
    r = slide(case, "time,load_n,disp_x", *[(k, pressure * wave, d * wave) for k, d in enumerate(places)], steps=1)
    amplitude = np.abs(a1 + a2 * np.exp(2j * np.pi * np.array(places)))
    assert r["history/slide_x"] == pytest.approx(np.array(places) * wave, rel=1e-12, abs=1e-18)
    exact = pressure + np.pi * e_star * amplitude / wave
    assert exact[:3] == pytest.approx([294.247780e6, 270.248147e6, 231.415927e6], rel=1e-8)
    assert r["pressure"].max((1, 2)) == pytest.approx(exact, rel=2e-3)


def test_a_bump_of_body_2_passes_below(slide, tmp_path):
    """Where body 1 has moved over body 2 by D, a bump of body 2 is at -D in the grid, which goes with body 1."""
    n, size = 48, 2.4e-3
    x = (np.arange(n) + 0.5) / n * size - size / 2
    bump = -2e-6 * np.exp(-((x[None, :] ** 2 + x[:, None] ** 2) / (1.5e-4) ** 2))
    case = dict(STEEL, gap_type="flat", elasticity="periodic", grid_n=n, grid_size=size, slide=True, friction=0.2)
    case.update(surface(tmp_path / "two.h5", bump))
    r = slide(case, "time,load_n,disp_x,disp_y", (0, 20, 0, 0), (1, 20, 5e-4, 2e-4), (2, 20, 5e-4, 2e-4), steps=1)
    for step, place in ((0, (0, 0)), (2, (5e-4, 2e-4))):
        p = r["pressure"][step]
        centre = (p.sum(0) @ r["x"] / p.sum(), p.sum(1) @ r["y"] / p.sum())
        assert centre == pytest.approx((-place[0], -place[1]), abs=5e-7)
    assert r["gap"][2].min() > -1e-12 if "gap" in r else True


# ---- the same bits


CASE = dict(SPHERE, wear_coefficient1=1e-14, wear_coefficient2=2e-14)
HEADER = "time,load_n,disp_x,disp_y"
ROWS = [
    (0, 180.0, 0, 0),
    (1, 180.0, 0.9 * RADIUS, 0.2 * RADIUS),
    (2, 150.0, -0.4 * RADIUS, 0),
    (3, 180.0, 0.2 * RADIUS, 0),
]


@pytest.mark.parametrize("ranks", [2, 3])
@pytest.mark.parametrize("elasticity", ["halfspace", "periodic"])
def test_any_number_of_ranks_has_the_same_bits(petsam, slide, tmp_path, elasticity, ranks):
    one = slide(CASE, HEADER, *ROWS, steps=3, elasticity=elasticity)
    petsam(CASE, dict(elasticity=elasticity, history="slid.csv", steps=3, output="ranks.h5"), ranks=ranks)
    other = read_run(tmp_path / "ranks.h5")
    for name in one:
        assert np.array_equal(one[name], other[name], equal_nan=one[name].dtype.kind == "f"), name


def test_a_restart_slides_on(petsam, slide, tmp_path):
    words = dict(
        CASE, steps=3, **surface(tmp_path / "two.h5", 1e-7 * np.random.default_rng(1).standard_normal((32, 32)))
    )
    whole = slide(words, HEADER, *ROWS, checkpoint="state.h5", checkpoint_every=4)
    (state,) = [name for name in ("state.h5", "state.h5.1") if (tmp_path / name).exists()][-1:]
    on = dict(words, history="slid.csv", restart=state, output="rest.h5")
    petsam(on)
    rest = read_run(tmp_path / "rest.h5")
    assert len(rest["time"]) < len(whole["time"])
    for name in ("pressure", "wear_depth1", "wear_depth2", "history/slide_x", "history/wear_volume2"):
        assert np.array_equal(whole[name][-1], rest[name][-1]), name
    done = petsam(dict(on, slide=None, body2_surface_file=None), check=None)
    assert done.code and "-slide is given there, and not here" in done.stderr
    surface(tmp_path / "two.h5", np.zeros((32, 32)))
    done = petsam(on, check=None)
    assert done.code and "-body2_surface_file" in done.stderr


# ---- what is refused, and said


def test_contact_over_the_border_of_body_2s_surface(petsam, slide, tmp_path):
    """The grid that is advised holds contact and stroke."""
    rows = history(tmp_path / "far.csv", HEADER, (0.0, 180.0, 0.0, 0.0), (1.0, 180.0, -2.4 * RADIUS, 0.0))
    far = dict(CASE, **rows, steps=8, output="far.h5")
    done = petsam(far, check=12)
    (line,) = [text for text in done.complaint if "over the border of the surface that body 2 has" in text]
    assert "slide_x" in line
    size = float(line.split("-grid_size ")[1].split(",")[0])
    assert size > 6 * RADIUS
    n = int(line.split("-grid_n ")[1].split()[0])
    petsam(dict(far, grid_size=size, grid_n=n))
    petsam(dict(far, allow_edge_contact=True))
    petsam(dict(far, wear_coefficient2=None))  # nothing of body 2 is on the grid
    petsam(dict(far, elasticity="periodic"))


def test_a_surface_of_one_height_changes_the_approach_alone(petsam, tmp_path):
    """Beyond the grid it continues: no step stands where it ends."""
    cycle = history(tmp_path / "h.csv", "time,disp_x,rot_z", (0.0, 0.0, 0.0), (1.0, 1e-4, 0.0))
    found = []
    for height in (0.0, 1e-3):
        surface(tmp_path / "level.h5", np.full((32, 32), height))
        case = {**CASE, **cycle, "load_n": 20.0, "slide": True, "wear_coefficient1": None, "wear_coefficient2": None}
        petsam(case, dict(body2_surface_file=tmp_path / "level.h5", output="out.h5", overwrite=True, steps=3))
        with h5py.File(tmp_path / "out.h5") as f:
            found.append((f["history/disp_z"][:], f["history/pressure_max"][:], f["history/slide_x"][:]))
    assert np.allclose(found[1][0], found[0][0] + 1e-3, rtol=1e-6, atol=0)
    assert np.allclose(found[1][1], found[0][1], rtol=1e-6) and found[0][2][-1] > 5e-5


def test_surfaces_do_not_turn(petsam, tmp_path):
    cycle = history(tmp_path / "h.csv", "time,load_n,rot_z", (0, 180.0, 0.0), (1, 180.0, 0.1), (2, 180.0, 0.0))
    earlier = tmp_path / "earlier.h5"
    earlier.write_bytes(b"results of an earlier run")
    done = petsam({**CASE, **cycle, "output": earlier, "overwrite": True}, check=2)
    assert any("-rot_z" in line and "0.1" in line and "slide without turning" in line for line in done.complaint)
    assert earlier.read_bytes() == b"results of an earlier run"


def test_a_long_stroke_without_slide_is_warned_of(petsam, slide, tmp_path):
    """The depth would be wrong by a known part; not if body 1 alone wears, however far, nor if the surfaces slide."""
    rows = [(0, 180.0, 0, 0), (1, 180.0, 0.2 * RADIUS, 0), (2, 180.0, -0.2 * RADIUS, 0)]
    loads = history(tmp_path / "h.csv", HEADER, *[tuple(map(float, row)) for row in rows])
    said = [
        "give -slide" in petsam({**CASE, **loads, "steps": 3, "output": "h.h5", **words}).stderr
        for words in (dict(slide=None), dict(), dict(slide=None, wear_coefficient2=None))
    ]
    rows = history(tmp_path / "far.csv", HEADER, (0.0, 180.0, 0.0, 0.0), (1.0, 180.0, 3 * RADIUS, 0.0))
    alone = dict(slide=None, wear_coefficient2=None)
    for words in (alone, dict(alone, wear_coefficient1=None)):
        said.append("give -slide" in petsam({**CASE, **rows, "steps": 3, "output": "h.h5", **words}).stderr)
    assert said == [True, False, False, False, True]


# ---- surfaces that roll


LENGTH = 8 * HALF  # of the rolling grid, of 128 cells
BUMPS = 2e-8 * np.cos(2 * np.pi * np.arange(128) / 16) * (1 + 0.3 * np.sin(np.arange(128) / 9))
ROLLING = dict(CYLINDER, grid_n=128, grid_size=LENGTH, normal_rtol=1e-12, allow_edge_contact=None)


def heights(folder, body, values):
    return {f"body{body}_surface_file": surface(folder / f"of{body}.h5", values[None, :])["body2_surface_file"]}


@pytest.mark.parametrize("cells", [5, -9])
@pytest.mark.parametrize("body", [1, 2])
def test_roughness_rolls_through_the_contact(slide, tmp_path, body, cells):
    """By whole cells it is that of a body whose heights lie there; whichever body has them, and the mirror image."""
    distance = cells * LENGTH / 128
    rows = [(0, LINE, 0.0), (1, LINE, 0.4 * distance), (2, LINE, 0.6 * distance)]
    rolled = slide({**ROLLING, **heights(tmp_path, body, BUMPS)}, "time,load_n,roll", *rows, steps=1)
    there = heights(tmp_path, body, np.roll(BUMPS, -cells))
    still = slide({**ROLLING, **there}, "time,load_n", (0, LINE), steps=1, name="still")
    other = slide({**ROLLING, **heights(tmp_path, 3 - body, BUMPS)}, "time,load_n,roll", *rows, steps=1, name="other")
    mirrored = [(t, n, -roll) for t, n, roll in rows]
    mirror = {**ROLLING, **heights(tmp_path, body, BUMPS[::-1])}
    mirror = slide(mirror, "time,load_n,roll", *mirrored, steps=1, name="mirror")
    assert rolled["history/rolled_x"][-1] == pytest.approx(distance, rel=1e-14)
    pressure = rolled["pressure"][-1]
    assert np.array_equal(pressure, other["pressure"][-1])
    for found in (still["pressure"][-1], mirror["pressure"][-1][:, ::-1]):
        assert np.abs(pressure - found).max() < 1e-9 * pressure.max()
    assert np.abs(pressure - rolled["pressure"][0]).max() > 0.1 * pressure.max()
    assert pressure.sum() * LENGTH / 128 == pytest.approx(LINE, rel=1e-12)


@pytest.mark.parametrize("step", [1.0, 0.37])
def test_bodies_that_roll_with_creep_wear_evenly(slide, step):
    """Gross slip by the creep: points of body 1 wear by k creep N in passing, of body 2, which pass faster, by less."""
    creep, k, cell = 0.02, (1e-15, 3e-15), LENGTH / 128
    count = round(96 / step)
    case = dict(ROLLING, friction=1e-3, grid_n=256, grid_size=2 * LENGTH)
    case.update(wear_coefficient1=k[0], wear_coefficient2=k[1])
    rows = [(0, LINE, 0.0, 0.0), (1, LINE, -48 * cell, 0.0)]
    rows += [(n + 2, LINE, step * cell, creep) for n in range(count)]
    r = slide(case, "time,load_n,roll,creep_x", *rows, steps=1)
    path = creep * count * step * cell
    assert r["history/slide_x"][-1] == pytest.approx(path, rel=1e-3)
    volumes = [r[f"history/wear_volume{body}"][-1] / k[body - 1] for body in (1, 2)]
    assert volumes[1] == pytest.approx(volumes[0], rel=1e-12, abs=0)
    assert volumes[0] == pytest.approx(LINE * path, rel=2e-4)
    for body, faster in ((1, 1.0), (2, 1.0 + creep)):
        depth = r[f"wear_depth{body}"][-1, 0, 112:144] / (k[body - 1] * creep * LINE / faster)
        assert np.abs(depth - 1).max() < 1e-3


@pytest.mark.parametrize("wave, lost", [(6, 2.5), (9, None)])
def test_waves_of_few_cells_are_warned_of(petsam, tmp_path, wave, lost):
    """By what cubic interpolation takes of them half way between points, unless they move by whole cells."""
    t = 2 * np.pi / wave
    two = heights(tmp_path, 2, 1e-9 * np.cos(t * np.arange(144)))
    case = {**ROLLING, **two, "grid_n": 144, "load_n": LINE, "steps": 1, "overwrite": True, "output": "w.h5"}
    for cells, warns in ((2.5, lost is not None), (2.0, False)):
        rows = [(0, 0.0), (1, cells * LENGTH / 144)]
        done = petsam({**case, **history(tmp_path / "w.csv", "time,disp_x", *rows), "friction": 1e-7})
        told = [line for line in done.stderr.splitlines() if "waves of so few cells" in line]
        assert len(told) == warns, done.stderr
        if warns:
            exact = 100 * (1 - (9 * np.cos(t / 2) - np.cos(3 * t / 2)) / 8)
            assert exact == pytest.approx(lost, abs=0.1) and f"by up to {exact:.2g} %" in told[0]


def test_rolling_over_the_border_of_a_surface_is_found(petsam, slide, tmp_path):
    rows = [(0, LINE, 0.0), (1, LINE, 0.2 * LENGTH), (2, LINE, 0.25 * LENGTH)]
    loads = history(tmp_path / "far.csv", "time,load_n,roll", *rows)
    case = {**ROLLING, **heights(tmp_path, 1, BUMPS), **loads, "steps": 1, "output": "far.h5"}
    line = " ".join(petsam(case, check=12).complaint)
    assert "the contact rolled over the border of the surface that body 1 has on the grid" in line
    assert "the grid must hold contact and path" in line
    petsam(dict(case, body1_surface_file=None, overwrite=True))  # nothing of a body is on the grid
