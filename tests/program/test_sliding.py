"""Numbers of a fretting cycle against Mindlin and Deresiewicz's loops, slip amplitudes against Cattaneo's slip."""

from types import SimpleNamespace

import numpy as np
import pytest

import petsam
from petsam import closed, cycles, sliding
from petsam.closed import loop
from petsam.plot import fields
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
