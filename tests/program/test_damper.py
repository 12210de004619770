"""Two blades and the damper under their platforms (examples/damper): beside one contact alone, and by symmetry."""

import importlib.util
import sys

import numpy as np
import pytest
from scipy.optimize import fsolve

import petsam
from petsam import joint
from support import ROOT

pytestmark = [
    pytest.mark.filterwarnings(f"ignore::{name}")
    for name in ("petsam.joint.BackboneWarning", "petsam.AdviceWarning", "RuntimeWarning")
]
MASS, CELLS = 8e-3, 24


@pytest.fixture(scope="module")
def damper():
    spec = importlib.util.spec_from_file_location("damper", ROOT / "examples" / "damper" / "damper.py")
    module = sys.modules["damper"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_platforms_that_move_against_each_other_are_one_contact(damper):
    """By symmetry both contacts are alike: equilibrium of blade and damper with one contact, from its own steps."""
    amplitude, steps = 1.2e-4, 6
    both = damper.backbone(MASS, "circumferential", [amplitude], CELLS, steps=steps)
    alpha, shape = both.alpha[0], both.shape
    blades, motions = damper.motions("circumferential")
    blade, lift = blades[:2, 0], motions[:2, 1]  # n and t of the left contact by the left blade, and by the damper's z
    omega, force = 2 * np.pi * damper.BLADE, damper.centrifugal(MASS)
    load = 0.5 * force / np.cos(damper.ANGLE)
    held = dict(disp_y=0.0, rot_x=0.0, rot_y=0.0, rot_z=0.0)
    contact = damper.contact(load, CELLS)
    contact.try_step(load_n=load)
    contact.commit()

    def loads(x, scale=1.0):
        normal, along = blade * x[0] + lift * x[1]
        step = contact.try_step(disp_z=normal, disp_x=along, friction_scale=scale, **held)
        return np.array([step.load_n, step.load_tx])

    def errors(x, factor, scale=1.0):
        """Of the left blade, and of the damper, whose inertia under the mode acts on it, too."""
        carried = loads(x, scale)
        inertia = np.sqrt(MASS) * alpha * factor * shape[3]
        return [
            (omega**2 * x[0] - factor * alpha * shape[0] + blade @ carried) / load,
            (2 * lift @ carried - force - inertia) / load,
        ]

    start = contact.number("disp_z") / lift[0]
    x = fsolve(errors, [0.0, start], (0.0, 0.0), xtol=1e-10)
    contact.commit()
    assert shape[1] == pytest.approx(-shape[0]) and abs(shape[2]) + abs(shape[4]) < 1e-6 * abs(shape[0])
    cycle = np.linspace(1, -1, steps + 1)[1:]
    found = []
    for factor in [*np.linspace(0, 1, steps + 1)[1:], *np.tile(np.append(cycle, -cycle), 4)]:
        x = fsolve(errors, x, (factor,), xtol=1e-10)
        errors(x, factor)
        contact.commit()
        found.append((shape[0] * 2 * x[0] + shape[3] * np.sqrt(MASS) * x[1], contact.number("dissipated_energy")))
    reach, energy = np.array(found[-2 * steps :]).T
    frequency = np.sqrt(2 * alpha / (reach.max() - reach.min())) / (2 * np.pi)
    assert both.frequency[0] == pytest.approx(frequency, rel=1e-4)
    assert both.energy[0] == pytest.approx(2 * energy.sum(), rel=5e-3)
    assert both.patches[0, 0] == pytest.approx(both.patches[0, 1], rel=1e-4)
    assert both.frequency[0] < 0.99 * both.linear < both.linear


def test_a_damper_rolls_between_platforms_that_move_radially(damper):
    """Turning and shifting it follows both platforms without deforming a contact: nothing holds the blades."""
    frequencies, shapes = damper.structure(MASS, "radial", CELLS).stuck_modes()
    blade, moves = shapes[:2, 0], shapes[2:, 0] / np.sqrt([MASS, MASS, 0.5 * MASS * damper.RADIUS**2])
    assert frequencies[:2] / (2 * np.pi) == pytest.approx(2 * [damper.BLADE], rel=1e-4)
    lift = damper.PLATFORM * damper.TIP * blade[0]  # of the left platform; the right one moves down
    sine, cosine = np.sin(damper.ANGLE), np.cos(damper.ANGLE)
    assert blade[1] == pytest.approx(-blade[0]) and moves[1] == pytest.approx(0.0, abs=1e-6 * abs(lift))
    assert moves[0] == pytest.approx(-lift * cosine / sine, rel=1e-3)
    assert moves[2] == pytest.approx(lift / sine / damper.RADIUS, rel=1e-3)


def test_the_best_mass_lies_between(damper):
    """A light damper slides and a heavy one sticks: both leave larger amplitudes than one between them."""
    amplitudes = np.geomspace(5e-6, 3e-3, 6)
    found = [damper.backbone(mass, "circumferential", amplitudes, CELLS) for mass in (3e-3, 15e-3, 80e-3)]
    light, middle, heavy = (damper.resonance(one, 2.0) for one in found)
    assert middle < 0.8 * light and middle < 0.8 * heavy
    assert np.isnan(damper.resonance(found[0], 1e6))


@pytest.mark.parametrize("mass, amplitude", [(2.5e-3, 1.41e-4), (20e-3, 9.3e-5)])
def test_contacts_that_begin_to_slide_together_are_found_anyhow(damper, mass, amplitude):
    """By displacements or by loads along them. Some steps went to and fro: one contact slides and the other one sticks,
    and the reverse; or both slide, and nothing but a little stiffness keeps the damper from turning without end."""
    found = []
    for along in (False, True):
        structure = damper.structure(mass, "circumferential", 48)
        for patch in structure.patches:
            patch.by_load[:] = [True, along]
        found.append(joint.backbone(structure, [amplitude * np.sqrt(2.0) / damper.TIP], mode=2))
    assert found[1].frequency == pytest.approx(found[0].frequency, rel=1e-6)
    assert found[1].energy == pytest.approx(found[0].energy, rel=1e-3)


@pytest.mark.parametrize("speed", [3000.0, 2 * np.pi * 3000.0])
def test_a_speed_in_another_unit_is_told(damper, monkeypatch, speed):
    monkeypatch.setattr(damper, "SPEED", speed)
    with pytest.raises(petsam.Error, match=r"expected at most 700 m/s: give rad/s \("):
        damper.structure(MASS, "circumferential", CELLS)
