"""Numbers of a fretting cycle against Mindlin and Deresiewicz's loops, slip amplitudes against Cattaneo's slip, loss
factors against complex moduli."""

from types import SimpleNamespace

import numpy as np
import pytest

import petsam
from petsam import closed, cycles, sliding
from petsam.apps.study import tables
from petsam.closed import loop
from petsam.plot import fields, loops
from support import ball, hertz, history, slide_limit

pytestmark = pytest.mark.usefixtures("closing")

CASE = ball(n=64, half_width=1.2, poisson=0.0)
LIMIT = slide_limit(CASE)[0]
AMPLITUDE = 0.8


@pytest.fixture(scope="module")
def path(solve, tmp_path_factory):
    """A closed cycle of T_x after the first loading, ten steps a stroke."""
    rows = [(0, 0.0), *((k, float(turn * AMPLITUDE * LIMIT)) for k, turn in enumerate((1, -1, 1), 1))]
    return solve(
        CASE, history(tmp_path_factory.mktemp("history") / "h.csv", "time,load_tx", *rows), dict(steps=10)
    ).path


def branch(t):
    """Half the width of a loop between the loads -t and t, of mu N = 1, and its amplitude."""
    top = loop.first_loading(t, 1.0, 1.0)
    return abs(loop.masing_displacement(0.0, t, top, 1.0, 1.0)), top


def test_ratios_of_a_cycle_are_those_of_the_closed_form(results):
    found = sliding.numbers(results, cycles.find(results).numbered(-1))
    half, top = branch(AMPLITUDE)
    energy = loop.partial_loop_energy(AMPLITUDE, 1.0, 1.0)
    assert found.energy_ratio == pytest.approx(energy / (4.0 * AMPLITUDE * top), rel=2e-2)
    assert found.sliding_ratio == pytest.approx(half / top, rel=2e-2)
    assert found.force == pytest.approx(AMPLITUDE * LIMIT) and found.regime == "partial slip"
    assert found.displacement == pytest.approx(0.5 * np.ptp(results.history["disp_x"][10:]), rel=1e-6)
    assert found.friction == found.energy and found.viscous == 0.0
    assert found.loss_factor == pytest.approx(found.energy / (np.pi * found.force * found.displacement), rel=1e-8)


def test_a_cycle_of_two_steps_has_no_width(solve, path, tmp_path):
    """It is a line, whose energy is known: by friction, as that of a cycle of more steps."""
    rows = [(0, 0.0), *((k, float(turn * AMPLITUDE * LIMIT)) for k, turn in enumerate((1, -1, 1), 1))]
    line = solve(CASE, history(tmp_path / "h.csv", "time,load_tx", *rows), dict(steps=1)).path
    found = []
    for name in (line, path):
        with petsam.open(name) as results:
            found.append(sliding.numbers(results, cycles.find(results).numbered(-1)))
    assert np.isnan(found[0].sliding_ratio) and np.isnan(found[0].loss_factor)
    assert found[0].energy == pytest.approx(found[1].energy, rel=1e-2) and found[1].sliding_ratio > 0.1


def test_a_sphere_passes_the_published_ratios_on_its_way_to_gross_slip():
    half, top = branch(1.0)
    assert loop.partial_loop_energy(1.0, 1.0, 1.0) / (4.0 * top) == pytest.approx(0.2)
    assert half / top == pytest.approx(0.26, abs=1e-3)
    force = np.linspace(1.0, -1.0, 401)
    way = loop.masing_displacement(force, 1.0, 1.0, 1.0, 1.0)
    assert sliding._width(np.r_[way, -way], np.r_[force, -force]) / 2.0 == pytest.approx(half / top, rel=1e-4)
    assert sliding._width(np.ones(3), np.ones(3)) == 0.0


def test_slip_amplitude_is_cattaneos_slip_within_contact(results):
    h = hertz(CASE)
    compliance = 2.0 * closed.tangential_compliance(CASE["body1_young"] / 2.0, 0.0, np.inf, 0.0)
    stick = h.radius * np.cbrt(1.0 - AMPLITUDE)
    r = petsam.Snapshot(results).r
    exact = -closed.cattaneo_slip(r, h.radius, stick, CASE["friction"] * h.pressure, compliance)
    amplitude = results.quantity("slip_amplitude")
    inside = r < 0.93 * h.radius
    assert np.max(np.abs(amplitude - exact)[inside]) < 2e-2 * exact.max()
    assert np.isnan(amplitude[r > 1.05 * h.radius]).all() and np.all(amplitude[r < 0.9 * stick] < 1e-3 * exact.max())
    assert results.quantity("slip_range") == pytest.approx(2.0 * amplitude, nan_ok=True)
    window = dict(rows=slice(20, 40), columns=slice(10, 50), stride=3)
    assert results.quantity("slip_amplitude", **window) == pytest.approx(amplitude[20:40:3, 10:50:3], nan_ok=True)


def test_the_amplitude_is_drawn_of_the_cycle_before_a_step(results):
    with pytest.raises(petsam.Error, match="no cycle ends before step 25; give a step after a whole cycle"):
        results.quantity("slip_amplitude", results.of_step(25))
    figure = fields.maps([(results, results.of_last())], names=["slip_amplitude"])
    assert figure.axes[0].get_title() == "slip amplitude of the cycle"


def test_slip_while_a_cell_is_open_does_not_count():
    """A path of four steps: the cell slips by 1 in contact, by 5 while it is open; another is never in contact."""
    zero, state = np.zeros(2), np.array([1, 0])
    steps = [(zero, zero, state), (zero + 1, zero, state), (zero + 5, zero, 0 * state), (zero, zero + 0.5, state)]
    assert sliding._chords(steps) == pytest.approx([np.hypot(1.0, 0.5), np.nan], nan_ok=True)


@pytest.mark.parametrize("way, regime", [(0.3, "partial slip"), (3.0, "gross slip")])
def test_the_regime_is_that_of_the_step_that_slips_most(solve, tmp_path, way, regime):
    case = ball(n=32)
    gross = 1.5 * case["friction"] * float(hertz(case).approach)
    rows = [(0, 0.0), *((k, turn * way * gross) for k, turn in enumerate((1, -1, 1), 1))]
    with petsam.open(solve(case, history(tmp_path / "h.csv", "time,disp_x", *rows), dict(steps=6)).path) as results:
        found = sliding.numbers(results, cycles.find(results).numbered(1))
        assert found.regime == regime
        assert (found.energy_ratio > 0.2) == (regime == "gross slip") == (found.sliding_ratio > 0.26)


def test_regimes_of_several_cycles():
    areas = dict(stick_area=np.array([2.0, 2.0, 1.0, 0.0, 0.0]), contact_area=np.array([2.0, 2.0, 2.0, 2.0, 2.0]))
    results = SimpleNamespace(series=areas.get)
    stick, partial, gross = slice(0, 2), slice(1, 3), slice(3, 5)
    assert sliding.regime(results, stick, partial) == "partial slip"
    assert sliding.regime(results, stick) == "stick" and sliding.regime(results, gross, gross) == "gross slip"
    assert sliding.regime(results, partial, gross) == sliding.regime(results, gross, stick) == "mixed"


STEPS = 48  # of a period


def shaken(bodies, period, count, load, friction=1.0, across="load_tx", steps=STEPS):
    """A ball of radius 1 under N, shaken for so many periods after a rest of 40 s."""
    t = 40.0 + period * np.arange(1, count * steps + 1) / steps
    wave = np.sin(2.0 * np.pi * (t - 40.0) / period)
    base = {"load_n": 1e-3, "load_tx": 0.0}
    columns = {
        name: np.append(value, value + (load * wave if name == across else 0 * t)) for name, value in base.items()
    }
    return petsam.run(
        **bodies, friction=friction, gap_type="sphere", gap_radius1=1, gap_radius2="inf", grid_n=16, grid_size=0.45,
        history={"time": np.append(0.0, t), **columns}, output_fields="none", errors="none", tangential_rtol=1e-9,
        normal_rtol=1e-10,
    )  # fmt: skip


def modulus(w, parts, times):
    """The complex shear modulus over that of a sudden load at an angular frequency."""
    turned = 1j * w * np.array(times)
    return 1.0 - sum(parts) + np.sum(np.array(parts) * turned / (1.0 + turned))


def body(which, parts, times, young=2.6, poisson=0.3, **more):
    names = dict(young=young, poisson=poisson, relax_moduli=parts, relax_times=times, **more)
    return {f"body{which}_{name}": value for name, value in names.items()}


PARTS, TIMES = (0.5, 0.3), (0.1, 1.0)
ALIKE = {**body(1, PARTS, TIMES), **body(2, PARTS, TIMES)}
ONE = {"body1_young": 6.0, "body1_poisson": 0.5, **body(2, (0.4,), (0.3,), 3.0, 0.5)}
BULK = {**body(1, PARTS, TIMES, relax="constant_bulk"), **body(2, PARTS, TIMES, relax="constant_bulk")}


def creep_of_alike(w):
    return 1.0 / modulus(w, PARTS, TIMES)


def creep_of_one(w):
    return 0.5 + 1.0 / modulus(w, (0.4,), (0.3,))


def creep_of_bulk(w):
    """(2 - nu)/G of Mindlin is (3/G + 3/(3 K + G))/2; G = 1 and K = 2.6/(3 (1 - 0.6)) under a sudden load."""
    g = modulus(w, PARTS, TIMES)
    return 3.0 / g + 3.0 / (6.5 + g)


@pytest.mark.parametrize(
    "bodies, creep, period, count",
    [(ALIKE, creep_of_alike, 1.0, 20), (ALIKE, creep_of_alike, 10.0, 3), (ONE, creep_of_one, 0.5, 10),
     (BULK, creep_of_bulk, 2.0, 10)],
    ids=["alike", "slow", "one", "bulk"],
)  # fmt: skip
def test_the_loss_factor_of_sticking_bodies_is_that_of_their_complex_modulus(bodies, creep, period, count):
    """Loss over storage modulus at the frequency of T, once the start has decayed; friction dissipates nothing."""
    run = shaken(bodies, period, count, 2e-6)
    found = sliding.numbers(run, cycles.find(run).numbered(-1), "tx")
    turned = creep(2.0 * np.pi / period)
    assert found.loss_factor == pytest.approx(-turned.imag / turned.real, rel=5e-3)
    assert abs(found.friction) < 1e-6 * found.viscous and found.energy == pytest.approx(found.viscous, rel=1e-6)


def test_the_loss_factor_converges_in_second_order():
    """Also where the reversal of the displacement is between two steps."""
    turned, errors = creep_of_alike(2.0 * np.pi), []
    for steps in (20, 40):
        run = shaken(ALIKE, 1.0, 12, 2e-6, steps=steps)
        found = sliding.numbers(run, cycles.find(run).numbered(-1), "tx")
        errors.append(abs(found.loss_factor * turned.real / turned.imag + 1.0))
    assert errors[0] < 0.02 and 3.0 < errors[0] / errors[1] < 5.5


def test_the_energy_of_slipping_bodies_that_relax_has_both_parts():
    """It is the area of the loop; tables and pictures have the parts."""
    run = shaken(ALIKE, 1.0, 12, 1.6e-4, friction=0.3)
    whole = cycles.find(run)
    found = sliding.numbers(run, whole.numbered(-1), "tx")
    rows = whole.numbered(-1).rows
    drawn = sliding.area(run.series("disp_x")[rows], run.series("load_tx")[rows])
    assert min(found.friction, found.viscous) > 0.02 * drawn
    assert found.energy == found.friction + found.viscous == pytest.approx(drawn, rel=1e-2)
    assert whole.energies[-1] == found.friction and whole.viscous_energies[-1] == found.viscous
    listed = tables.of_cycles(run, tables.LAST)
    assert listed["viscous_energy_cycle_last"] == (found.viscous, "J")
    assert listed["dissipated_energy_cycle_last"] == (found.friction, "J")
    assert listed["loss_factor_cycle_last"] == (found.loss_factor, "1")
    for figure in loops.loop([run], "tx"), loops.cycle_loops([whole], "tx", [-1]):
        assert f"loss factor {found.loss_factor:.3g}" in figure.axes[0].get_legend().get_texts()[0].get_text()
    drawn = loops.energy([whole]).axes[0].lines[0].get_ydata()
    assert drawn[-1] / drawn[0] == pytest.approx(found.energy / (whole.energies + whole.viscous_energies)[0])


def test_the_work_of_a_constant_load_on_bodies_that_creep_is_none_of_the_loop():
    """Shaken at once under N, the bodies dissipate the work of N, too: the loop of T has its area."""
    t = 0.25 * np.arange(1, 97) / STEPS
    wave = 5e-5 * np.sin(8.0 * np.pi * t)
    run = petsam.run(
        **ALIKE, friction=1, gap_type="sphere", gap_radius1=1, gap_radius2="inf", grid_n=16, grid_size=0.45,
        history=dict(time=np.append(0, t), load_n=np.full(97, 1e-3), load_tx=np.append(0, wave)), output_fields="none",
        errors="none",
    )  # fmt: skip
    cycle = cycles.find(run, "load_tx").numbered(1)
    found = sliding.numbers(run, cycle, "tx")
    assert found.viscous > 1.5 * found.energy
    assert found.energy == sliding.area(run.series("disp_x")[cycle.rows], run.series("load_tx")[cycle.rows])
