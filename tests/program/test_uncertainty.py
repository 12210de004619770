"""Uncertainty of a number beside dense covariances and random surfaces, and the function for optimisers."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import minimize

import petsam
from petsam.contact.uncertainty import Roughness, of

BALL = dict(
    body1_young=210e9, body1_poisson=0.3, body2_young=115e9, body2_poisson=0.32, gap_type="flat", grid_n=32,
    grid_size=2.4e-3, friction=0.4, slip_direction="end", allow_edge_contact=True, errors="none",
)  # fmt: skip
TIGHT = dict(normal_rtol=1e-12, tangential_rtol=1e-11)
TURNS = np.array([0, 0.5, 1, 0.5, 0, -0.5, -1, -0.5, 0])
HISTORY = {"time": np.arange(9.0), "load_n": np.full(9, 800.0), "load_tx": 200 * TURNS}
ROUGH = Roughness(50e-9, 0.8, 0.25e-3, 2e-3)

pytestmark = pytest.mark.filterwarnings("ignore")


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Tests run in their folder."""
    monkeypatch.chdir(tmp_path)


def sphere(x, y, radius):
    return (x**2 + y**2) / (2 * radius)


def solved(heights=0.0, history=HISTORY, **more):
    """A ball on a flat with its loop recorded, and the frictional work of its steps."""
    contact = petsam.Contact(**{**BALL, **more})
    contact.gap = sphere(*np.meshgrid(contact.x, contact.y), 0.05) + heights
    with contact.record_gradient():
        return contact, sum(step.dissipated_energy for step in contact.run(history))


# ---------------------------------------------------------------- uncertainty


def test_variance_by_roughness_beside_the_dense_covariance():
    """On 12 x 10 cells that are not square: g'C g with C of all pairs of cells, the sum of its cosines."""
    contact, _ = solved(grid_n=(12, 10), grid_size=(2.4e-3, 2.6e-3))
    rough, found = Roughness(30e-9, 0.6, 0.7e-3, 2.2e-3), contact.gradient("energy")
    x, y = (values.ravel() for values in np.meshgrid(contact.x, contact.y))
    covariance, total = np.zeros((x.size, x.size)), 0.0
    for i in range(-6, 7):
        for j in range(-6, 7):
            k = 2 * np.pi * np.array([i / 2.4e-3, j / 2.6e-3])
            if 2 * np.pi / 2.2e-3 <= np.hypot(*k) <= 2 * np.pi / 0.7e-3:
                height = np.hypot(*k) ** -3.2
                covariance += height * np.cos(k[0] * (x[:, None] - x) + k[1] * (y[:, None] - y))
                total += height
    g = found.gap.ravel()
    assert of(contact, found, rough).sd == pytest.approx(30e-9 * np.sqrt(g @ covariance @ g / total), rel=1e-10)
    assert np.sqrt(rough.waves(contact).sum()) == pytest.approx(30e-9)


def test_random_surfaces_have_the_roughness():
    """The mean square of many surfaces, and the covariance of cells one and four columns apart."""
    contact, _ = solved(history={"time": [0.0], "load_n": [800.0]})
    surfaces = np.array([ROUGH.heights(contact, seed) for seed in range(400)])
    exact = np.fft.ifft2(ROUGH.waves(contact)).real * 32**2
    for shift in (0, 1, 4):
        assert np.mean(surfaces * np.roll(surfaces, shift, axis=2)) == pytest.approx(exact[0, shift], rel=0.05)
    assert np.array_equal(ROUGH.heights(contact, 3), surfaces[3]) and not np.array_equal(surfaces[3], surfaces[4])


def test_standard_deviations_beside_random_surfaces():
    """Of 60 surfaces they are accurate to 9 %; the work of the loop, and the norm of the pressure."""
    contact, _ = solved()
    area, samples = (2.4e-3 / 32) ** 2, []
    for seed in range(60):
        rough, work = solved(ROUGH.heights(contact, seed))
        samples.append((work, np.sum(area * rough.field("pressure") ** 8) ** 0.125))
    for name, sample in zip(("energy", "pressure_norm"), np.transpose(samples)):
        found = contact.gradient(name)
        assert found.value == pytest.approx(sample.mean(), rel=0.02)
        assert of(contact, found, ROUGH).sd == pytest.approx(sample.std(ddof=1), rel=0.3)


def test_shares_beside_differences():
    """Each parameter alone by two runs; patterns of loads; the squares add up, and the largest comes first."""
    contact, _ = solved(**TIGHT)
    found = contact.gradient("energy", (*petsam.gradient.USUAL, *petsam.gradient.MODULI), rtol=1e-10)
    load = HISTORY["load_tx"]
    every = of(contact, found, ROUGH, friction=0.01, body2_young=3e9, load_n=5.0, load_tx=0.01 * load)
    for name, more in (
        ("friction", lambda e: dict(friction=0.4 + 1e-2 * e)),
        ("body2_young", lambda e: dict(body2_young=115e9 + 3e9 * e)),
        ("load_n", lambda e: dict(history={**HISTORY, "load_n": HISTORY["load_n"] + 5 * e})),
        ("load_tx", lambda e: dict(history={**HISTORY, "load_tx": load * (1 + 0.01 * e)})),
    ):
        up, down = (solved(**{**TIGHT, **more(e)})[1] for e in (1e-4, -1e-4))
        assert every.parts[name] == pytest.approx(abs(up - down) / 2e-4, rel=1e-4), name
    assert every.parts["roughness"] == of(contact, found, ROUGH).sd
    assert every.sd == pytest.approx(np.sqrt(sum(part**2 for part in every.parts.values())))
    assert sum(every.shares.values()) == pytest.approx(1)
    assert every.shares["friction"] == pytest.approx((every.parts["friction"] / every.sd) ** 2)
    parts = list(every.parts.values())
    assert parts == sorted(parts, reverse=True) and every.largest == "friction"
    assert str(every).startswith(f"energy {found.value:.5g} +- {every.sd:.3g}: friction ")
    assert of(contact, found, friction=0.0).shares == {"friction": 0.0}


def test_refusals_of_uncertainties():
    contact, _ = solved()
    found = contact.gradient("energy")
    for change, words in (
        (dict(), "no standard deviation: give"), (dict(fricton=0.1), "is friction meant"),
        (dict(body1_young=1e9), "give of="), (dict(load_n=[1, 2]), r"an array of the shape \(9,\)"),
        (dict(friction=np.nan), "give a finite number"), (dict(friction="a tenth"), "give a finite number"),
        (dict(friction=[[0.1], 2]), "give a finite number"), (dict(friction=None), "give a finite number"),
        (dict(roughness=Roughness(-1e-9, 0.8, 0.25e-3, 2e-3)), "give a height and an exponent"),
        (dict(roughness=Roughness(1e-9, 1.2, 0.25e-3, 2e-3)), "give a height and an exponent"),
        (dict(roughness=Roughness(1e-9, 0.8, 0.1e-3, 2e-3)), "has 1.33 cells of the grid; give more than 2"),
        (dict(roughness=Roughness(1e-9, 0.8, 0.25e-3, 3e-3)), "a larger grid_size"),
        (dict(roughness=Roughness(1e-9, 0.8, 0.25e-3, 0.2e-3)), "a shorter wavelength"),
        (dict(roughness=Roughness(1e-9, 0.8, 1.8e-3, 2e-3)), "no wave of the grid"),
    ):  # fmt: skip
        with pytest.raises(petsam.Error, match=words):
            of(contact, found, **change)
    for values, words in (
        (("50", 0.8, 1e-3, 1e-2), "rms = '50': give a number, as"),
        ((1e-9, "0.8", 1e-3, 1e-2), "hurst = '0.8'"),
    ):
        with pytest.raises(petsam.Error, match=words):
            Roughness(*values)
    units = Roughness("50nm", 0.8, "0.25mm", 2e-3)
    assert units.rms == pytest.approx(50e-9) and units.shortest == pytest.approx(0.25e-3)
    with pytest.raises(petsam.Error, match="5 of 10 rows are on this rank: use a contact without comm"):
        of(SimpleNamespace(rows=5, n=(10, 10)), found, ROUGH)


# ---------------------------------------------------------------- the function for optimisers


@pytest.mark.parametrize("steps", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_derivatives_of_a_function_beside_differences(steps):
    """All kinds of parameters, of three numbers at once; with several load steps per row, too."""
    history = {name: values[:7] for name, values in HISTORY.items()}
    history |= {"bulk1_stress_xx": 3e7 * TURNS[:7], "friction_scale": np.full(7, 1.2)}
    unit = 1e-9 * np.cos(np.arange(32) / 3)[:, None] * np.cos(np.arange(32) / 5 + 1)
    narrow = (lambda x, y, height: height * x**4 / 1e-12, lambda x, y, height: x**4 / 1e-12)
    options = {**BALL, **TIGHT, "wear_coefficient1": 1e-11, "steps": steps}
    parameters = ["friction", "body2_young", "wear_coefficient2", "load_tx", "load_n", "bulk1_stress_xx", unit, sphere]
    scales = np.array([0.5, 115e9, 1e-11, 0.9, 1, 1, 2, 0.05, 1e-6])
    numbers = ["energy", ("disp_x", slice(3, 4)), "wear_volume"]
    evaluate = petsam.gradient.function(
        options, history, numbers, [*parameters, narrow], gap=unit, scales=scales, rtol=1e-10
    )
    values, slopes = evaluate(np.ones(9))
    assert values.shape == (3,) and slopes.shape == (3, 9)
    for k in range(9):
        up, down = (evaluate(1 + e * np.eye(9)[k])[0] for e in (1e-6, -1e-6))
        assert slopes[:, k] / values == pytest.approx((up - down) / 2e-6 / values, rel=2e-6, abs=2e-6), k


def test_a_function_of_one_number_beside_the_contact():
    """The gap that stays and its parts are added; the value is a number, as optimisers need it."""
    wave = 1e-8 * np.cos(np.arange(32))[:, None] * np.ones(32)
    contact, work = solved(wave)
    found = contact.gradient("energy", rtol=1e-6)
    value, slope = petsam.gradient.function(BALL, HISTORY, "energy", ["friction", sphere], gap=wave)([0.4, 0.05])
    by_radius = -np.sum(found.gap * sphere(*np.meshgrid(contact.x, contact.y), 0.05)) / 0.05
    assert isinstance(value, float) and value == pytest.approx(work, rel=1e-8)
    assert slope == pytest.approx([found.friction.sum(), by_radius], rel=1e-6)


STEEL = {**BALL, "body2_young": 210e9, "body2_poisson": 0.3, "grid_size": 2.6e-3}


def test_the_mean_over_positions_of_the_grid():
    """Beside runs of their own, numbers() and differences; and nearer to closed forms of a sphere than one grid is."""
    history = {"time": HISTORY["time"], "load_n": np.full(9, 1000.0), "load_tx": 60 * TURNS}
    options = {**STEEL, **TIGHT, "grid_n": (40, 36), "grid_center": (3e-5, -2e-5)}
    numbers, parameters = [("energy", slice(3, 9)), ("disp_x", slice(2, 3))], [sphere, "friction"]
    make = petsam.gradient.function
    places = petsam.gradient.positions(options, 5)
    one = make(options, history, numbers, parameters, rtol=1e-9)
    several = petsam.gradient.mean(make(place, history, numbers, parameters, rtol=1e-9) for place in places)
    values, slopes = several([0.1, 0.1])
    alone = petsam.gradient.mean(petsam.gradient.numbers(place, history, numbers, parameters) for place in places)
    assert alone([0.1, 0.1]) == pytest.approx(values, rel=1e-9) and several.shape == (2,)
    work = petsam.gradient.mean(make(place, history, *numbers[:1], parameters) for place in places)
    assert isinstance(work([0.1, 0.1])[0], float) and work([0.1, 0.1])[0] == pytest.approx(values[0], rel=1e-9)
    cell, golden = np.array([2.6e-3 / 40, 2.6e-3 / 36]), (np.sqrt(5) - 1) / 2
    places = [(3e-5 + cell[0] * k / 5, -2e-5 + cell[1] * (golden * k % 1)) for k in range(5)]
    runs = [make(options | {"grid_center": at}, history, numbers, parameters, rtol=1e-9)([0.1, 0.1]) for at in places]
    assert values == pytest.approx(np.mean([run[0] for run in runs], axis=0), rel=1e-9)
    assert slopes == pytest.approx(np.mean([run[1] for run in runs], axis=0), rel=1e-5)
    for k in range(2):
        up, down = (several(0.1 + 1e-7 * sign * np.eye(2)[k])[0] for sign in (1, -1))
        assert slopes[:, k] == pytest.approx((up - down) / 2e-7, rel=1e-5)
    closed = np.array([-1 / 3, -1.7598])
    off = [0.1 * evaluate([0.1, 0.1])[1][0] / evaluate([0.1, 0.1])[0][0] - closed for evaluate in (one, several)]
    assert np.all(abs(off[1]) < 0.06) and np.all(abs(off[1]) < abs(off[0])), off


def test_the_secant_of_a_stiffness():
    """That of a sphere grows as the power 1/3 of its radius: what to take for the stiffness of frozen cells."""
    press = {"time": np.arange(3), "load_n": [1000, 900, 1100]}
    points = [("disp_z", slice(k, k + 1)) for k in (1, 2)]
    places = petsam.gradient.positions(STEEL | TIGHT, 8)
    way, slopes = petsam.gradient.mean(petsam.gradient.function(at, press, points, [sphere]) for at in places)([0.1])
    assert 0.1 * np.diff(slopes[:, 0]) / np.diff(way) == pytest.approx(-1 / 3, abs=0.02)


def test_an_optimiser_finds_friction_and_radius_of_a_loop():
    points = [("disp_z", slice(0, 1)), *[("disp_x", slice(k, k + 1)) for k in (1, 2, 4, 6)]]
    model = petsam.gradient.function(
        BALL | TIGHT, HISTORY, points, ["friction", sphere], scales=[0.3, 0.1], rtol=1e-8
    )  # fmt: skip
    measured = model([0.37 / 0.3, 0.06 / 0.1])[0]

    def misfit(x):
        values, slopes = model(x)
        off = (values - measured) / 1e-8
        return off @ off, 2e8 * off @ slopes

    best = minimize(misfit, [1, 1], jac=True, method="L-BFGS-B", bounds=[(0.9, 2), (0.1, 2)])
    assert best.x * [0.3, 0.1] == pytest.approx([0.37, 0.06], rel=1e-3) and best.nfev < 40


def test_refusals_of_functions():
    make = petsam.gradient.function
    ball = {**BALL, "gap_type": "sphere", "gap_radius1": 0.05, "gap_radius2": "inf"}
    for options, names, words in (
        (BALL, ["frictio"], "is friction meant"), (BALL, ["friction", "load_n", "friction"], "is listed twice"),
        (BALL, ["disp_x"], "there is no derivative by it"),
        (ball, [sphere], "gap_type = sphere: parts of the gap replace it: use gap_type = flat"),
        ({**BALL, "gap_rough_file": "rough.h5"}, [sphere], "gap_rough_file = rough.h5: parts of the gap replace it"),
    ):  # fmt: skip
        with pytest.raises(petsam.Error, match=words):
            make(options, HISTORY, "energy", names)
    for count in (0, 2.5):
        with pytest.raises(petsam.Error, match="give a number of positions"):
            petsam.gradient.positions(BALL, count)
    with pytest.raises(petsam.Error, match="there are no functions"):
        petsam.gradient.mean([])
    with pytest.raises(petsam.Error, match="numbers of several shapes"):
        petsam.gradient.mean([lambda x: (1.0, np.zeros(2)), lambda x: (np.ones(2), np.zeros((2, 2)))])([1, 1])
    for scales in ([1, 2], "one", [[0.05]]):
        with pytest.raises(petsam.Error, match="give a number, or 1 number"):
            make(BALL, HISTORY, "energy", [sphere], scales=scales)
    with pytest.raises(petsam.Error, match="use gap_type = flat"):
        make(ball, HISTORY, "energy", ["friction"], gap=np.zeros((32, 32)))
    for parameters, x, words in (
        (["friction", sphere], [0.4], r"x has the shape \(1,\): give 2 values"),
        ([np.zeros((3, 3))], [1], r"has the shape \(3, 3\): the grid has \(32, 32\)"),
        ([lambda x, y, radius: sphere(x, y, radius).real], [0.05], "give a pair, it and its derivative"),
        (["friction", sphere], [0.1, 0.05], "gross slip"),
    ):  # fmt: skip
        with pytest.raises(petsam.Error, match=words):
            make(BALL, HISTORY, "energy", parameters)(x)
