"""A contact as a force element of other programs: time integration, springs in series."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import compliances
import petsam
from petsam.apps.compliance import basis, rigid
from test_backbone import FRICTION, LOAD, shear, sphere

pytestmark = pytest.mark.filterwarnings("ignore::petsam.AdviceWarning")

MASS = 3.0
LIMIT = FRICTION * LOAD


def element(n=64):
    """A sphere that is held along x by its contact, its tangential stiffness, and the displacement at which it
    slides."""
    contact, stiffness = sphere(LOAD, n)
    return petsam.Element(contact, ["disp_x"], dict(load_n=LOAD)), stiffness, 1.5 * LIMIT / stiffness


def newmark(one, u, dt, steps):
    """Free motion from rest at u: displacement and velocity of each step, the energies of the contact's friction."""
    force, found, lost = one.try_(u)[0], [(u, 0.0)], 0.0
    one.commit()
    v, a = 0.0, force / MASS
    for _ in range(steps):
        new = u + dt * v + 0.5 * dt**2 * a
        for _ in range(20):
            force = one.try_(new)[0]
            wrong = MASS * 4 / dt**2 * (new - u - dt * v - 0.25 * dt**2 * a) - force
            if abs(wrong) < 1e-9 * LIMIT:
                break
            new -= wrong / (4 * MASS / dt**2 - one.tangent()[0, 0])
        one.commit()
        lost += one.number("dissipated_energy")
        after = force / MASS
        u, v, a = new, v + 0.5 * dt * (a + after), after
        found.append((u, v))
    return np.array(found).T, lost


def decay(u, stiffness, times):
    """Free motion from rest at u by Masing's rule: branches from each reversal are the first loading, twice as large.
    The amplitude falls, so no branch passes the reversal before."""
    force, found, at = -shear(u, LOAD, stiffness), np.zeros(0), 0.0

    def resisting(x, u, force):
        turned = u - x
        return force + 2 * np.sign(turned) * shear(abs(turned) / 2, LOAD, stiffness)

    while at < times[-1]:

        def rate(_, y, u=u, force=force):
            return y[1], resisting(y[0], u, force) / MASS

        def rest(_, y):
            return y[1]

        rest.terminal, rest.direction = True, np.sign(u)
        path = solve_ivp(rate, (at, 2 * times[-1]), (u, 0.0), events=rest, rtol=1e-10, atol=1e-16, dense_output=True)
        at = path.t[-1]
        found = np.concatenate([found, path.sol(times[found.size :][times[found.size :] <= at])[0]])
        force, u = resisting(path.y[0, -1], u, force), path.y[0, -1]
    return found


def test_free_motion_on_a_contact_is_that_of_masings_rule():
    one, stiffness, full = element()
    dt = 2 * np.pi * np.sqrt(MASS / stiffness) / 60
    start = one.copy()
    start.try_(0.8 * full)
    before = start.number("stored_energy")
    (u, v), lost = newmark(one, 0.8 * full, dt, 150)
    assert np.abs(u - decay(0.8 * full, stiffness, dt * np.arange(151))).max() < 0.01 * full
    left = one.number("stored_energy") + 0.5 * MASS * v[-1] ** 2
    assert before - left == pytest.approx(lost, rel=0.01)
    assert lost > 0.2 * LIMIT * full  # of 0.22 mu N times the displacement of sliding


def reach(force, stiffness):
    """Displacement of the contact at first loading by this force."""
    return 1.5 * LIMIT / stiffness * (1 - (1 - force / LIMIT) ** (2 / 3))


@pytest.mark.parametrize("soft", [0.5, 20.0])
def test_a_spring_in_series_is_condensed(soft):
    """Loading to 0.9 mu N, and back to -0.6 mu N: twice as large a branch; the spring is `soft` times as compliant."""
    one, stiffness, _ = element()
    spring = stiffness / soft
    one.condense(2 * spring)
    one.condense([[2 * spring]])  # two of them in series
    for part in (0.3, 0.6, 0.9):
        force = one.try_(reach(part * LIMIT, stiffness) + part * LIMIT / spring)
        assert force == pytest.approx(-part * LIMIT, rel=1e-4)
        one.commit()
    top = one.u[0]
    for part in (0.5, 0.0, -0.6):
        drop = (0.9 - part) * LIMIT
        force = one.try_(top - 2 * reach(drop / 2, stiffness) - drop / spring)
        assert force == pytest.approx(-part * LIMIT, rel=3e-4, abs=3e-4 * LIMIT)
        one.commit()


def test_a_spring_behind_a_contact_with_shear_is_stretched():
    one, stiffness, _ = element(32)
    force, u = one.try_(reach(0.5 * LIMIT, stiffness)), one.u
    one.commit()
    one.condense(stiffness)
    assert one.u == pytest.approx(u - force / stiffness, rel=1e-12, abs=0) and np.array_equal(one.force, force)
    assert one.try_(one.u) == pytest.approx(force, rel=1e-5)


def test_the_tangent_is_that_of_differences():
    """Of translation and rotation about x and y, with springs that couple them; z follows."""
    contact, stiffness = sphere(LOAD, 32)
    names, size = ["disp_x", "rot_y", "disp_y"], 1e-3
    one = petsam.Element(contact, names, dict(load_n=LOAD, rot_x=0.0))
    scale = np.diag([1.0, size, 1.0])
    mixed = np.array([[3.0, 1.0, 0.5], [1.0, 2.0, 0.3], [0.5, 0.3, 1.0]])
    full = 1.5 * LIMIT / stiffness
    u, step = full * np.array([0.5, 0.2 / size, 0.3]), 1e-4 * full * np.array([1.0, 1.0 / size, 1.0])
    for condensed in False, True:
        if condensed:
            one.condense(stiffness * scale @ mixed @ scale)
        one.try_(u)
        tangent = one.tangent()
        assert one.tangent(True)[0, 0] < tangent[0, 0] < 0.0  # slip makes it softer
        for k in range(3):
            moved = step * np.eye(3)[k]
            slope = (one.try_(u + moved) - one.try_(u - moved)) / (2 * step[k])
            errors = (slope - tangent[:, k]) / np.sqrt(np.abs(np.diag(tangent) * tangent[k, k]))
            assert np.abs(errors).max() < 5e-3


def test_copies_and_the_preload_state():
    one, stiffness, full = element(24)
    preload = one.copy()
    first = one.try_(0.7 * full)
    one.commit()
    assert one.try_(0.0)[0] > 0.05 * LIMIT  # shear that is locked in
    one.take(preload)
    assert one.u == 0.0
    assert one.try_(0.7 * full) == pytest.approx(first, rel=1e-9)
    assert preload.try_(-0.7 * full) == pytest.approx(-first, rel=1e-5)


def test_load_cases_and_a_normal_load_in_the_preload(tmp_path):
    """Coordinates of the preload are those of the contact; a case that is a motion answers as the motion does."""
    case = dict(mode1=-rigid.motions(basis.Patch((0.0, 0.0), (1.0, 1.0), 1))[1])
    file = compliances.write(tmp_path / "one.h5", np.zeros((3, 3, 3, 3)), cases=case)
    bodies = {f"body{k}_{name}": value for k in (1, 2) for name, value in (("young", 1.0), ("poisson", 0.3))}
    grid = dict(grid_n=24, grid_size=2.0, gap_type="sphere", gap_radius1=8.0, gap_radius2="inf", friction=0.3)
    found = []
    for names in (["disp_x", "disp_z"], ["body2_case_mode1", "disp_z"]):
        contact = petsam.Contact(**bodies, **grid, body2_compliance=file)
        contact.try_step(disp_z=0.03, disp_x=0.0)
        contact.commit()
        one = petsam.Element(contact, names, {} if "disp_x" in names else dict(disp_x=0.0))
        pressed = one.force[1]
        assert one.u == pytest.approx([0.0, 0.03])
        found.append(one.try_([2e-3, 0.035]))
    assert found[1] == pytest.approx(found[0], rel=1e-5)
    assert found[0][1] < pressed < 0.0  # the more it is pressed, the more it pushes


def test_input_that_makes_no_sense_is_refused():
    one = element(16)[0]
    for stiffness in (0.0, -1.0, [[np.nan]], np.eye(2), np.inf):
        with pytest.raises(petsam.Error, match=r"condense: expected a positive stiffness: .* \(1, 1\) matrix"):
            one.condense(stiffness)
    for u in ([1.0, 2.0], [np.nan]):
        with pytest.raises(petsam.Error, match="try_: expected 1 finite coordinates"):
            one.try_(u)
