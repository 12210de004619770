"""Parameters of a contact from numbers of its history: twins with noise, what they do not hold, both Jacobians."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import least_squares

import petsam
from petsam.apps.fit import fit_contact, least, runs

OPTIONS = dict(
    body1_young=210e9, body1_poisson=0.3, body2_young=115e9, body2_poisson=0.32, gap_type="sphere", gap_radius1=0.05,
    gap_radius2="inf", grid_n=24, grid_size=2.4e-3, friction=0.4, errors="none",
)  # fmt: skip
FLAT = {**{name: value for name, value in OPTIONS.items() if not name.startswith("gap_")}, "gap_type": "flat"}
PHASE = np.linspace(0.0, 2.0 * np.pi, 13)
LOOP = {
    "time": np.arange(14.0), "load_n": np.full(14, 800.0), "disp_x": np.append(0, 3e-6 * np.sin(PHASE)),
    "disp_y": np.append(0, 2e-6 * np.sin(PHASE + 1.2)),
}  # fmt: skip
PULL = {"time": np.arange(9.0), "load_n": np.full(9, 800.0), "load_tx": 200 * np.sin(np.pi * np.arange(9) / 4)}
NOISE = {"load_tx": 2.0, "load_ty": 2.0, "disp_z": 2e-8, "disp_x": 5e-9, "wear_volume": 1e-18, "energy": 1e-6}
FIRST = np.append(True, np.zeros(13, dtype=bool))  # the approach is measured before the loop
TRUE = {"friction": 0.4, "gap_radius1": 0.05, "body1_young": 210e9}
STARTS = {"friction": 0.6, "gap_radius1": 0.04, "body1_young": 180e9}

pytestmark = pytest.mark.filterwarnings("ignore")


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Tests run in their folder."""
    monkeypatch.chdir(tmp_path)


def exact(names, options=OPTIONS, history=LOOP):
    """Numbers by name without noise."""
    with petsam.Contact(**{"tangential_rtol": 1e-8, **options}) as contact:  # as fits have it
        steps = contact.run(history)
    single = {
        "energy": sum(step.dissipated_energy for step in steps),
        "wear_volume": sum(steps[-1].numbers.get(f"wear_volume{body}", 0.0) for body in (1, 2)),
    }
    return {name: single.get(name, np.array([getattr(step, name, 0.0) for step in steps])) for name in names}


@pytest.fixture(scope="module")
def loop():
    """Of dissimilar bodies, both directions out of phase."""
    return exact(("load_tx", "load_ty", "disp_z"))


def noisy(numbers, seed):
    chance = np.random.default_rng(seed)
    return {
        name: (values + NOISE[name] * chance.standard_normal(np.shape(values)), NOISE[name])
        for name, values in numbers.items()
    }


def twin(loop, seed):
    """A noisy loop with the approach in its first row only."""
    measured = noisy(loop, seed)
    measured["disp_z"] = (np.where(FIRST, measured["disp_z"][0], np.nan), NOISE["disp_z"])
    return measured


def test_friction_radius_and_modulus_of_dissimilar_bodies_out_of_phase(loop):
    """The radius is known by 2 % beforehand: within 3 standard deviations, which are the scatter; runs are few."""
    found = []
    for seed in range(10):
        known = {"gap_radius1": (0.05 * (1 + 0.02 * np.random.default_rng(900 + seed).standard_normal()), 0.001)}
        found.append(fit_contact(OPTIONS, LOOP, twin(loop, seed), STARTS, known))
    for name, truth in TRUE.items():
        values, sd = (np.array([getattr(one, what)[name] for one in found]) for what in ("values", "sd"))
        assert np.all(np.abs(values - truth) < 3 * sd), name
        assert 0.5 < np.std(values, ddof=1) / np.mean(sd) < 2, name
    assert all(all(one.identifiable.values()) and one.state == "known" for one in found)
    assert all(one.freedom == 27 and 10 < one.chi2 < 60 and one.misfit < 1.5 for one in found)
    assert np.median([one.runs for one in found]) <= 40 and {one.way for one in found} == {"differences"}
    assert found[0].numbers["load_tx"] == pytest.approx(loop["load_tx"], abs=5.0)
    assert np.isfinite(found[0].numbers["disp_z"]).tolist() == FIRST.tolist()


def test_the_fit_is_that_of_central_differences_and_counts_its_runs(loop, monkeypatch):
    """Beside least squares by small central differences, with residuals of the test's own."""
    measured, starts = twin(loop, 3), {"friction": 0.5, "body1_young": 190e9}
    scales = np.array(list(starts.values()))

    def off(x):
        values = exact(("load_tx", "load_ty", "disp_z"), {**OPTIONS, **dict(zip(starts, x * scales))})
        return np.concatenate([
            (values[name] - there)[np.isfinite(there)] / sd for name, (there, sd) in measured.items()
        ])  # fmt: skip

    best = least_squares(off, [1.0, 1.0], jac="3-point", diff_step=1e-4, xtol=1e-8, ftol=1e-8)
    counted, run = [], petsam.Contact.run
    monkeypatch.setattr(petsam.Contact, "run", lambda *given: counted.append(1) or run(*given))
    found = fit_contact(OPTIONS, LOOP, measured, starts)
    covariance = np.linalg.inv(best.jac.T @ best.jac)
    assert found.runs == len(counted) and found.passes == 0
    assert found.chi2 == pytest.approx(2 * best.cost, rel=1e-3)
    sd = np.array(list(found.sd.values()))
    assert np.all(np.abs(np.array(list(found.values.values())) - best.x * scales) < 0.1 * sd)
    assert sd == pytest.approx(np.sqrt(np.diag(covariance)) * scales, rel=0.1)
    part = covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1])
    assert found.correlation == pytest.approx(np.array([[1, part], [part, 1]]), abs=0.05)


def test_what_the_numbers_do_not_hold_is_said(loop):
    """Radius and modulus have nearly one effect, both radii exactly one, and the coefficient of wear none."""
    forces = {name: one for name, one in twin(loop, 1).items() if name != "disp_z"}
    found = fit_contact(OPTIONS, LOOP, forces, STARTS)
    assert found.identifiable == {"friction": True, "gap_radius1": False, "body1_young": False}
    assert found.nearest("body1_young")[0] == "gap_radius1" and found.nearest("body1_young")[1] < -0.99
    assert "gap_radius1: not identifiable" in str(found) and "with body1_young" in str(found)
    two = {**OPTIONS, "gap_radius1": 0.1, "gap_radius2": 0.1}
    starts = {"friction": 0.4, "gap_radius1": 0.09, "gap_radius2": 0.11}
    one = fit_contact(two, LOOP, twin(loop, 1), starts)
    assert one.sd["gap_radius1"] == one.sd["gap_radius2"] == np.inf and np.isnan(one.correlation[0, 1])
    assert one.identifiable == {"friction": True, "gap_radius1": False, "gap_radius2": False}
    none = fit_contact(OPTIONS, LOOP, twin(loop, 1), {"friction": 0.5, "wear_coefficient1": 1e-16})
    assert none.identifiable == {"friction": True, "wear_coefficient1": False}


def test_what_goes_with_an_unknown_is_unknown():
    """Of three parameters two have nearly one effect, of which one alone has a deviation below a tenth."""
    slopes = np.array([[100.0, 101.0, 0.0], [9.0, 0.0, 0.0], [0.0, 0.0, 20.0]])
    problem = SimpleNamespace(
        names=["a", "b", "c"], scales=np.array([1.0, 1.0, 1.0]), step=1e-6, known={}, slopes=None, runs=1, passes=0,
        measured=SimpleNamespace(named=lambda numbers: {}),
    )  # fmt: skip
    best = SimpleNamespace(x=np.array([1.0, 2.0, 3.0]), fun=np.zeros(3), jac=slopes, cost=0.0)
    found = runs._result(problem, best, np.zeros(3))
    assert found.sd["a"] > 0.1 and found.sd["b"] < 0.2 and found.correlation[0, 1] < -0.95
    assert found.identifiable == {"a": False, "b": False, "c": True}
    assert found.nearest("c") == ("", 0.0)


@pytest.mark.parametrize(
    "least, most, ends",
    [(0.45, 0.7, ("friction",)), pytest.param(0.1, 0.38, ("friction",), marks=pytest.mark.slow), (0.3, 0.5, ())],
)
def test_a_value_at_its_bound_is_none(loop, least, most, ends):
    """Bounds that leave out the truth, above and below it; within them there is a number."""
    start = {"friction": 0.5 * (least + most)}
    found = fit_contact(OPTIONS, LOOP, twin(loop, 1), start, bounds={"friction": (least, most)})
    assert found.ends == ends and found.identifiable["friction"] is not bool(ends)
    assert ("friction: no number: ends at its bound" in str(found)) is (bool(ends) and found.state == "known")


def test_a_fit_that_has_not_converged_has_no_numbers(loop, monkeypatch):
    monkeypatch.setattr(runs, "TRIALS", 2)
    found = fit_contact(OPTIONS, LOOP, twin(loop, 1), {"friction": 0.43, "gap_radius1": 0.045})
    assert found.state in ("not converged", "rejected") and not any(found.identifiable.values())
    assert found.state == "rejected" or "not converged in 2 trials" in str(found)


def test_a_wrong_contact_is_rejected(loop):
    found = fit_contact({**OPTIONS, "gap_radius1": 0.1}, LOOP, twin(loop, 2), {"friction": 0.4})
    assert found.state == "rejected" and not found.identifiable["friction"] and found.misfit > runs.LARGE
    assert "the model does not hold" in str(found) and "friction" not in str(found)


def test_a_misfit_widens_the_bands(loop):
    """By deviations half as large as the noise: the bands are those of the noise, not half of them."""
    measured = twin(loop, 4)
    half = {name: (values, 0.5 * sd) for name, (values, sd) in measured.items()}
    right, wide = (fit_contact(OPTIONS, LOOP, one, {"friction": 0.4}) for one in (measured, half))
    assert wide.chi2 == pytest.approx(4 * right.chi2, rel=1e-3) and wide.misfit > least.MISFIT
    assert wide.sd["friction"] == pytest.approx(right.misfit * right.sd["friction"], rel=0.01)


@pytest.mark.parametrize("steps", [1, 2])
def test_a_rig_and_a_zero_that_are_measured_with_the_displacement(steps):
    """Under loads, with several load steps per row; and a factor of the load cell that is known."""
    options = {**OPTIONS, "steps": steps}
    of_rows = exact(("disp_x",), options, PULL)["disp_x"][steps - 1 :: steps]
    numbers = {"disp_x": of_rows + 2e-8 * PULL["load_tx"] + 1e-6}
    starts = {"friction": 0.5, "rig_compliance": 1e-8, "disp_x_offset": 0.0, "load_tx": 1.0}
    known = {"disp_x_offset": (0.0, 1e-5), "load_tx": (1.0, 0.001)}
    found = fit_contact(options, PULL, noisy(numbers, 5), starts, known)
    for name, truth in (("friction", 0.4), ("rig_compliance", 2e-8), ("disp_x_offset", 1e-6), ("load_tx", 1.0)):
        assert abs(found.values[name] - truth) < 3 * found.sd[name], name
    assert found.sd["rig_compliance"] < 1e-9 and found.sd["disp_x_offset"] < 1e-8
    assert found.way == "differences"


def sphere(x, y, radius):
    return (x**2 + y**2) / (2 * radius)


def test_passes_back_where_numbers_are_few(monkeypatch):
    """Wear in the loop, its work, its last force and the approach, for six parameters that are known to some per cent:
    four passes for each run, to the fit of differences."""
    worn = {**OPTIONS, "wear_coefficient1": 1e-13, "wear_coefficient2": 2e-13, "slip_direction": "end"}
    numbers = exact(("wear_volume", "energy", "load_tx"), worn)
    numbers["load_tx"] = np.where(np.roll(FIRST, 10), numbers["load_tx"], np.nan)
    options = {**FLAT, "wear_coefficient1": 1e-13, "normal_rtol": 1e-10, "slip_direction": "end"}
    parameters = {
        "friction": 0.45, "body1_young": 200e9, "body2_young": 120e9, "wear_coefficient2": 2.5e-13,
        "ball": (sphere, 0.047), "wave": (lambda x, y, height: height * np.cos(4e3 * x) * np.cos(3e3 * y), 0.0),
    }  # fmt: skip
    known = {
        "friction": (0.45, 0.05), "body1_young": (200e9, 10e9), "body2_young": (120e9, 5e9), "ball": (0.047, 0.003),
        "wear_coefficient2": (2.5e-13, 1e-13), "wave": (0.0, 2e-8),
    }  # fmt: skip
    measured = noisy(numbers, 6)
    found = fit_contact(options, LOOP, measured, parameters, known)
    assert found.way == "passes back" and found.passes == 3 * found.runs and found.freedom == 3
    monkeypatch.setattr(petsam.gradient, "OPTIONS", ())
    other = fit_contact(options, LOOP, measured, parameters, known)
    assert other.way == "differences" and other.passes == 0 and other.runs > 3 * found.runs
    assert found.chi2 == pytest.approx(other.chi2, rel=0.01)
    for name, sd in found.sd.items():
        assert found.values[name] == pytest.approx(other.values[name], abs=0.05 * sd), name
        assert sd == pytest.approx(other.sd[name], rel=0.05), name
    truth = {"friction": 0.4, "wear_coefficient2": 2e-13, "ball": 0.05}
    assert all(abs(found.values[name] - value) < 3 * found.sd[name] for name, value in truth.items())
    assert found.identifiable["friction"] and not found.identifiable["wave"]


@pytest.mark.parametrize(("young", "way"), [(210e9, "passes back"), (115e9, "differences")])
def test_passes_back_are_of_the_same_steps(young, way):
    """At mid step, if the growing contact is of similar bodies; else differences. The work of 12 steps goes with it."""
    options = {**OPTIONS, "body2_young": young, "body2_poisson": 0.3}
    measured = {"energy": (exact(["energy"], options)["energy"], 1e-6)}
    found = fit_contact(options, LOOP, measured, {"friction": 0.45})
    assert found.way == way and found.passes == (found.runs if way == "passes back" else 0)
    assert found.values["friction"] == pytest.approx(0.4, rel=0.01)


def test_trial_steps_into_gross_slip_are_shortened():
    """From a friction far above, by loads that leave little: the first step goes below what bears them."""
    history = {**PULL, "load_tx": 300 * np.sin(np.pi * np.arange(9) / 4)}
    numbers = exact(("disp_x",), OPTIONS, history)
    found = fit_contact(OPTIONS, history, noisy(numbers, 7), {"friction": 1.5})
    assert abs(found.values["friction"] - 0.4) < 3 * found.sd["friction"]
    with pytest.raises(petsam.Error, match="gross slip"):
        fit_contact(OPTIONS, history, noisy(numbers, 7), {"friction": 0.3})


def test_numbers_of_a_run_are_those_of_its_passes_back():
    """The same numbers of both functions, by shapes and a stated part of the gap, too."""
    wave = 1e-8 * np.cos(np.arange(24))[:, None] * np.ones(24)
    wanted = ["energy", ("energy", slice(2, 5)), "wear_volume", ("load_tx", slice(2, 5)), ("disp_z", None)]
    given = (
        {**FLAT, "wear_coefficient1": 1e-13, "slip_direction": "end"},
        LOOP,
        wanted,
        ["friction", sphere, "load_n"],
    )
    plain, both = (
        make(*given, gap=wave, scales=[0.5, 1, 1]) for make in (petsam.gradient.numbers, petsam.gradient.function)
    )
    assert plain([0.8, 0.05, 1.1]) == pytest.approx(both([0.8, 0.05, 1.1])[0], rel=1e-9)
    single = petsam.gradient.numbers(OPTIONS, LOOP, "energy", ["friction"])
    assert single([0.4]) == pytest.approx(exact(["energy"])["energy"], rel=1e-12)
    assert isinstance(single([0.4]), float)


def test_numbers_have_their_derivative_where_there_is_one():
    unlike = {**OPTIONS, "slip_direction": "end"}
    plain = petsam.gradient.numbers(unlike, LOOP, ["energy"], ["friction"])
    values, slopes = plain.derivative([0.4])
    step = 1e-4
    difference = (plain([0.4 + step]) - plain([0.4 - step])) / (2.0 * step)
    assert plain.shape == (1,) and values == pytest.approx(plain([0.4]), rel=1e-9)
    assert slopes[:, 0] == pytest.approx(difference, rel=1e-2)
    assert petsam.gradient.numbers(unlike, LOOP, "energy", ["friction", "gap_radius1"]).derivative is None


@pytest.mark.parametrize(("change", "words"), [
    (dict(measured={"load_x": (np.zeros(14), 1.0)}), "is load_tx meant"),
    (dict(measured={"disp_x": (np.zeros(14), 1.0)}), "measured disp_x: the history prescribes it"),
    (dict(measured={"load_tx": (np.zeros(13), 1.0)}), r"has the shape \(13,\): give 14"),
    (dict(measured={"energy": (np.zeros(14), 1.0)}), r"has the shape \(14,\): give one"),
    (dict(measured={"load_tx": (np.zeros(14), 0.0)}), "a standard deviation above 0"),
    (dict(measured={"load_tx": (np.full(14, np.nan), 1.0)}), "measured: give values"),
    (dict(known={"gap_radius1": (0.05, 0.001)}), "known gap_radius1: it is no parameter"),
    (dict(bounds={"frictio": (0, 1)}), "is friction meant"),
    (dict(parameters={"rig_compliance": 1e-8}), "needs a measured disp_x or disp_y, and its load"),
    (dict(parameters={"disp_z_offset": 1e-8}), "disp_z is not measured"),
    (dict(parameters={"load_tx_offset": 0.0}), "starts from 0: give known="),
    (dict(parameters={}), "there are no parameters"),
    (dict(parameters={"friction": "0.5"}), "a number that it may have"),
    (dict(parameters={"friction": -1.0}), "a number that it may have"),
    (dict(measured={"energy": (1e-6, 1e-7)}, parameters=TRUE), "1 number for 3 parameters"),
    (dict(parameters={"frictio": 0.3}), "friction"),
])  # fmt: skip
def test_refusals(change, words):
    given = dict(measured={"load_tx": (np.zeros(14), 1.0)}, parameters={"friction": 0.4}) | change
    with pytest.raises(petsam.Error, match=words):
        fit_contact(OPTIONS, LOOP, **given)
    with pytest.raises(petsam.Error, match="number pressure_max: it is none of a run alone"):
        petsam.gradient.numbers(OPTIONS, LOOP, "pressure_max", ["friction"])
