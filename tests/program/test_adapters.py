"""A contact in other programs of harmonic balance (examples/lap/adapters): Mindlin's oscillator in tmdsimpy, pyHarm."""

import sys

import numpy as np
import pytest

import petsam
from support import ROOT
from test_element import LIMIT, LOAD, MASS, element, sphere

sys.path.insert(0, str(ROOT / "examples" / "lap"))
from adapters.tmdsimpy import Force  # noqa: E402

pytestmark = pytest.mark.filterwarnings("ignore::petsam.AdviceWarning")

# one-harmonic balance of Mindlin's oscillator: T/(mu N): frequency over that of the sticking contact, damping
CLOSED = {0.3: (0.9722138552, 0.0125744512), 0.5: (0.9493664503, 0.0242219295), 0.7: (0.9203094015, 0.0410867396)}


def amplitude(tau):
    """Over the displacement at which the contact slides."""
    return 1 - (1 - tau) ** (2 / 3)


@pytest.mark.parametrize("tau", CLOSED)
def test_the_first_harmonic_of_the_force_is_the_closed_one(tau):
    one, stiffness, full = element()
    found = Force(one, [[1.0]]).aft(np.array([0.6, -0.8]) * amplitude(tau) * full, 1.0, np.array([1]), Nt=32)[0]
    inphase, behind = found @ [0.6, -0.8], found @ [-0.8, -0.6]
    ratio, damping = CLOSED[tau]
    reach = stiffness * amplitude(tau) * full
    assert inphase / reach == pytest.approx(ratio**2, rel=2e-4)
    assert behind / (2 * reach * ratio**2) == pytest.approx(damping, rel=8e-3)


def differences(function, x, step):
    """Derivative of a function by central differences."""
    columns = [(function(x + step * unit) - function(x - step * unit)) / (2 * step) for unit in np.eye(x.size)]
    return np.array(columns).T


def test_the_derivative_is_that_of_differences():
    """With a mean displacement and higher harmonics; of the harmonics 0, 1, 3 and of two degrees of freedom."""
    one, stiffness, full = element(32)
    force = Force(one, [[1.0, -0.5]])
    order, rng = np.array([0, 1, 3]), np.random.default_rng(5)
    x = full * np.array([[0.1, 0.0], [0.5, 0.2], [0.3, -0.4], [0.02, 0.03], [0.04, -0.02]]).ravel()
    found, slope, by_frequency = force.aft(x, 1.0, order, 32)
    assert not np.any(by_frequency)
    assert np.reshape(found, (5, 2))[:, 1] == pytest.approx(-0.5 * np.reshape(found, (5, 2))[:, 0])
    assert force.aft(x, 1.0, order, 32, calc_grad=False)[0] == pytest.approx(found, rel=1e-9, abs=1e-9 * LIMIT)
    for direction in rng.normal(size=(3, x.size)):
        step = 1e-3 * full * direction
        moved = (force.aft(x + step, 1.0, order, 32)[0] - force.aft(x - step, 1.0, order, 32)[0]) / 2
        assert slope @ step == pytest.approx(moved, abs=0.01 * np.abs(moved).max())


def test_a_contact_at_rest_and_a_static_displacement():
    """Without a motion the derivative is that of sticking contacts; a normal preload is not part of the force."""
    contact, stiffness = sphere(LOAD, 32)
    pressed = petsam.Element(contact, ["disp_z", "disp_x"])
    force = Force(pressed, np.eye(2))
    found, slope, _ = force.aft(np.zeros(6), 1.0, np.array([0, 1]), 16)
    assert found == pytest.approx(0.0, abs=1e-6 * LIMIT)
    assert np.diag(slope) == pytest.approx(np.tile(np.diag(slope)[:2], 3))
    assert slope[1, 1] == pytest.approx(stiffness, rel=1e-2)
    u = np.array([2e-8, 1e-8])
    static, tangent = force.force(u)
    assert static[0] > 0.0 and static[1] > 0.0  # on the left side
    assert tangent == pytest.approx(differences(lambda u: force.force(u)[0], u, 1e-11), rel=1e-3, abs=1e-3 * stiffness)


def test_input_that_makes_no_sense_is_refused():
    one = element(16)[0]
    with pytest.raises(petsam.Error, match=r"Q: has the shape \(2, 1\): expected \(1, N\)"):
        Force(one, [[1.0], [0.0]])
    force = Force(one, [[1.0]])
    with pytest.raises(petsam.Error, match="8 time samples: 3 harmonics need 12 or more"):
        force.aft(np.ones(6), 1.0, np.array([1, 2, 3]), 8)
    with pytest.raises(petsam.Error, match="update_hist: the preload"):
        force.force([0.0], update_hist=True)


def test_the_oscillator_in_tmdsimpy():
    """Its non-linear mode (EPMC) with one harmonic: frequency, and damping as the self excitation."""
    tmdsimpy = pytest.importorskip("tmdsimpy")
    one, stiffness, full = element()
    system = tmdsimpy.VibrationSystem(np.array([[MASS]]), np.zeros((1, 1)), ab=[0, 0])
    system.add_nl_force(Force(one, [[1.0]]))
    ratio, damping = CLOSED[0.5]
    stuck, level = np.sqrt(stiffness / MASS), np.log10(amplitude(0.5) * full * np.sqrt(MASS))

    def residual(x):
        return system.epmc_res(np.append(x, level), np.array([0.0, 0.0, 1.0]), np.array([0, 1]), Nt=32)[:2]

    start = np.array([0.0, 1 / np.sqrt(MASS), 0.0, stuck, 0.0])
    found = tmdsimpy.NonlinearSolver().nsolve(residual, start, verbose=False, xtol=1e-8)[0]
    assert found[3] / stuck == pytest.approx(ratio, rel=1e-4)
    assert found[4] / (2 * found[3]) == pytest.approx(damping, rel=5e-3)


def test_the_oscillator_in_pyharm(tmp_path, monkeypatch):
    """The backbone of its non-linear mode under a force in quadrature, with a damper beside the contact."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYHARM_CONTEXT_FILE", str(tmp_path / "context.json"))
    harm = pytest.importorskip("pyHarm")
    from adapters import pyharm

    one, stiffness, full = element()
    stuck, viscous = np.sqrt(stiffness / MASS), 0.02
    damper = 2 * viscous * MASS * stuck

    def force(tau):
        ratio, damping = CLOSED[tau]
        reach, omega = amplitude(tau) * full, ratio * stuck
        return (2 * damping * MASS * omega**2 + damper * omega) * reach

    mode = dict(amp_min=force(0.3), df0=force(0.5) - force(0.3), df_min=0.01, df_max=10.0, max_steps=2)
    root = dict(method="hybr", options=dict(xtol=1e-7))
    matrix = dict(M=np.array([[MASS]]), K=np.zeros((1, 1)), C=np.array([[damper]]))
    given = dict(
        system=dict(type="Base", nh=[1], nti=32, adim=dict(status=True, lc=full, wc=stuck)),
        substructures=dict(mass=dict(matrix=matrix, ndofs=1)),
        connectors=dict(joint=dict(type="petsam", connect="mass", element=one, Q=[[1.0]])),
        plugin=[pyharm.Contact],
        analysis=dict(mode=dict(study="nlm_backbone", **mode, solver_options=dict(root=root))),
    )
    with pytest.raises(petsam.Error, match="connector joint: Q has 2 columns, and mass 1 of these"):
        harm.Maestro({**given, "connectors": dict(joint={**given["connectors"]["joint"], "Q": [[1.0, 0.0]]})})
    study = harm.Maestro(given)
    study.operate()
    points = study.nls["mode"].SolList
    for tau, point in zip((0.3, 0.5), points, strict=True):
        assert point.x[-1] == pytest.approx(CLOSED[tau][0], rel=1e-4)
        assert point.backbone_amp == pytest.approx(amplitude(tau), rel=5e-3)
