"""Two blades and the damper under their platforms: beside one contact alone, by symmetry, and by statics."""

import importlib.util
import sys

import numpy as np
import pytest
from scipy.optimize import fsolve

import petsam
from petsam import joint
from support import ROOT

sys.path.insert(0, str(ROOT / "examples" / "damper"))
import underplatform  # noqa: E402

pytestmark = [
    pytest.mark.filterwarnings(f"ignore::{name}")
    for name in ("petsam.apps.joint.BackboneWarning", "petsam.AdviceWarning", "RuntimeWarning")
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
    one = damper.damper(MASS)
    lift = one.motions[:2, 1]  # n and t of the left contact by the damper's z
    blade = -one.axes[0] @ [damper.PLATFORM * damper.TIP, 0.0]  # and by the left blade
    omega, force, load = 2 * np.pi * damper.BLADE, one.force, one.loads[0]
    held = dict(disp_y=0.0, rot_x=0.0, rot_y=0.0, rot_z=0.0)
    contact = one.contact(0, CELLS, [3.0 * half * np.cbrt(load / damper.LOAD) for half in damper.HALF])
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
    sine, cosine = np.sin(np.radians(35.0)), np.cos(np.radians(35.0))
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


@pytest.mark.parametrize("mass, amplitude", [(2.5e-3, 1.41e-4), pytest.param(20e-3, 9.3e-5, marks=pytest.mark.slow)])
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


# ---------------------------------------------------------------- any damper

GIVEN = dict(mass="10g", radius="5mm", angle="35deg", speed="3000rpm", orbit="0.5m", friction=0.3)
GIVEN.update(body1="steel", body2="steel")
KINDS = dict(ellipse=dict(GIVEN, crown="1.5m"), line=dict(GIVEN, length="20mm"))
PLATES = np.array([[0.1, 0.0], [0.02, 0.0], [0.0, 0.1], [0.0, -0.03]])  # of two blades
OMEGA = 2 * np.pi * np.array([250.0, 260.0])


def sum_of_forces(one, loads, friction=0.0):
    """Of all on the damper, x and z: centrifugal force, normal loads, and friction against a motion outwards."""
    alpha = one.angles
    outwards = [[-1, 1] * np.sin(alpha), np.cos(alpha)]  # normals from the damper, columns
    along = [[1, -1] * np.cos(alpha), np.sin(alpha)]  # of motion outwards
    return np.array([0.0, one.force]) - (np.array(outwards) + friction * np.array(along)) @ loads


def test_units_are_those_of_their_texts():
    one = underplatform.damper(**KINDS["ellipse"])
    plain = underplatform.damper(
        10e-3, 5e-3, np.radians(35), 100 * np.pi, 0.5, 0.3, crown=1.5, body1="steel", body2="steel"
    )
    for name in ("mass", "radius", "speed", "orbit", "friction", "crown", "force"):
        assert getattr(one, name) == pytest.approx(getattr(plain, name), rel=1e-14)
    assert one.angles == pytest.approx(plain.angles) and one.bodies == plain.bodies


def test_alike_platforms_bear_half_the_force_each():
    """F/2 over cos alpha; while both contacts slide over cos alpha +- mu sin alpha."""
    one, alpha = underplatform.damper(**KINDS["ellipse"]), np.radians(35)
    assert one.force == pytest.approx(10e-3 * 0.5 * (100 * np.pi) ** 2)
    assert one.loads == pytest.approx(np.full(2, one.force / (2 * np.cos(alpha))), rel=1e-12)
    for row, sign in zip(one.sliding, (1, -1)):
        assert row == pytest.approx(np.full(2, one.force / 2 / (np.cos(alpha) + sign * 0.3 * np.sin(alpha))), rel=1e-12)
    assert one.sliding[:, 0] / one.loads[0] == pytest.approx([0.83, 1.27], abs=0.005)  # of the README


@pytest.mark.parametrize("angle", [("20deg", "50deg"), (0.9, 0.3), "35deg"])
def test_forces_on_a_damper_add_up_to_zero(angle):
    one = underplatform.damper(**dict(KINDS["ellipse"], angle=angle, friction=0.2))
    first, second = one.angles
    assert one.loads == pytest.approx(one.force * np.sin([second, first]) / np.sin(first + second), rel=1e-12)
    for loads, friction in ((one.loads, 0.0), (one.sliding[0], 0.2), (one.sliding[1], -0.2)):
        assert np.all(loads > 0) and sum_of_forces(one, loads, friction) == pytest.approx([0, 0], abs=1e-12 * one.force)


def test_friction_at_unlike_platforms_may_leave_no_sliding_outwards():
    """The flat one would have to pull."""
    one = underplatform.damper(**dict(KINDS["ellipse"], angle=("5deg", "50deg")))
    assert np.all(np.isnan(one.sliding[0])) and np.all(one.sliding[1] > 0)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("angle", ["35deg", ("25deg", "45deg")])
def test_the_structure_is_in_equilibrium_and_has_the_modes_of_its_contacts(kind, angle):
    """Its preload has no shear and the computed loads; modes by the stiffness of both contacts."""
    one = underplatform.damper(**dict(KINDS[kind], angle=angle))
    found = one.structure(PLATES, OMEGA, 24)
    length = one.scale**2
    pressed = -found.loads.reshape(2, 2) * length
    assert pressed[:, 0] == pytest.approx(one.loads, rel=1e-6) and np.abs(pressed[:, 1]).max() < 1e-6 * one.force
    held = found.force[2:] * np.sqrt(one.mass) * one.scale  # on the damper: along x and z, a moment over some length
    assert held == pytest.approx([0, one.force, 0], abs=1e-5 * one.force)
    blades = np.concatenate([-axes @ two for axes, two in zip(one.axes, np.split(PLATES, 2))])
    moved = np.hstack([blades, one.motions / np.sqrt(one.mass * np.array([1.0, 1.0, 0.5 * one.radius**2]))])
    stiffness = np.zeros((4, 4))
    for k, patch in enumerate(found.patches):
        stiffness[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = length * np.array(patch.contact.stiffness(True))[:2, :2]
    values = np.linalg.eigvalsh(np.diag([*OMEGA**2, 0, 0, 0]) + moved.T @ stiffness @ moved)
    assert found.stuck_modes()[0] ** 2 == pytest.approx(values, rel=1e-4)


def test_contacts_are_those_of_hertz():
    """Half axes and pressure of an ellipse, closed and computed; of a line sqrt(4 P R/(pi E*)), 2 P/(pi a)."""
    modulus = 210e9 / 0.91 / 2
    one = underplatform.damper(**KINDS["ellipse"])
    closed = one.hertz[0]
    assert (closed.half_x, closed.half_y, closed.pressure) == pytest.approx(
        petsam.closed.ellipse.hertz_ellipse(one.loads[0], 5e-3, 1.5, modulus)[:3]
    )
    with one.contact(0, 64) as contact:
        assert contact.try_step(load_n=one.loads[0]).disp_z == pytest.approx(closed.approach, rel=2e-3)
        assert contact.field("pressure").max() == pytest.approx(closed.pressure, rel=5e-3)
    one = underplatform.damper(**KINDS["line"])
    load = one.loads[1] / 0.02
    line = one.hertz[1]
    assert line.half_x == pytest.approx(np.sqrt(4 * load * 5e-3 / (np.pi * modulus))) and line.half_y == 0.01
    assert line.pressure == pytest.approx(2 * load / (np.pi * line.half_x))
    with one.contact(1, 128) as contact:
        contact.try_step(load_n=load)
        assert contact.field("pressure").max() == pytest.approx(line.pressure, rel=5e-3)


def test_a_long_line_is_the_same_damper_twice():
    """Twice the mass, the length and the blades: the same motion, and twice the energy."""
    found = []
    for factor in (1.0, 2.0):
        one = underplatform.damper(**dict(KINDS["line"], mass=factor * 10e-3, length=factor * 0.02))
        tip = one.scale * np.array([2.5, 0.0, 0.0, 0.0, 0.0]) / np.sqrt(factor)
        found.append(joint.backbone(one.structure(PLATES / np.sqrt(factor), OMEGA, 32), [2e-6], mode=2, sensor=tip))
        found[-1].numbers["energy"] *= one.length / factor
    assert found[0].frequency == pytest.approx(found[1].frequency, rel=1e-6)
    assert found[0].damping == pytest.approx(found[1].damping, rel=1e-4)
    assert found[0].energy == pytest.approx(found[1].energy, rel=1e-4)


@pytest.mark.parametrize(
    "change, says",
    [
        (dict(angle=35.0), "angle: 35 rad is no angle below a right one"),
        (dict(angle="95deg"), "is no angle below a right one"),
        (dict(angle=("10deg",) * 3), "angle: has 3 values"),
        (dict(angle="35mm"), "angle: 35mm: expected a number above 0, in rad"),
        (dict(speed="3000rpn"), "speed: 3000rpn: expected .* of rad/s, .*rpm"),
        (dict(speed=3000.0), r"give rad/s \(3000 rpm are 314.2 rad/s\), or a text as '3000rpm'"),
        (dict(mass=0.0), "mass 0.0: expected a number above 0, in kg"),
        (dict(mass="10lb"), "mass: 10lb: expected"),
        (dict(friction=-0.1), "friction -0.1"),
        (dict(friction=1.5), "friction 1.5: the damper locks between platforms at 35 degrees"),
        (dict(friction=1.2, angle=("30deg", "50deg")), "locks between platforms at 30 and 50 degrees"),
        (dict(crown=np.inf), "crown, length: give one of both"),
        (dict(length=0.02), "crown, length: give one of both"),
        (dict(body2=None), "body2_young: give the bodies' materials"),
        (dict(body2="stel"), "is steel meant"),
    ],
)
def test_a_mistake_is_named(change, says):
    with pytest.raises(petsam.Error, match=says):
        underplatform.damper(**(KINDS["ellipse"] | change))


def test_platforms_need_two_displacements_each():
    with pytest.raises(petsam.Error, match=r"platforms: has the shape \(2, 2\): expected \(4, 2\)"):
        underplatform.damper(**KINDS["ellipse"]).structure(PLATES[:2], OMEGA)
