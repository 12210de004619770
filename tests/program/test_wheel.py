"""petsam-wheel, wheelsets on both rails: equilibrium, symmetry, continuity, conicity, wear, mistakes of first users."""

import pickle
import re
import sys
import warnings
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import petsam
from petsam import plot
from petsam.apps.launch import code_of
from petsam.apps.wheel import (
    Load,
    Pair,
    Position,
    Profile,
    Settings,
    State,
    Vehicle,
    batch,
    contacts,
    derailing,
    printing,
    wearing,
)
from petsam.apps.wheel import batch as batches
from petsam.apps.wheel import command as wheel
from petsam.apps.wheel.conicity import equivalent_conicity
from petsam.apps.wheel.positions import Case
from petsam.apps.wheel.section import visible
from petsam.apps.wheel.wearing import Law, depth_rates, rows_of
from petsam.core.errors import Error

pytestmark = pytest.mark.filterwarnings("ignore:patch at:UserWarning")

COARSE = Settings(cell=4e-4)
LOAD = Load(100e3)
BASE = ["--wheel", "s1002", "--rail", "uic60", "--cant", "1:40", "--cell", "0.4mm"]
ONE = ["--load", "100kN", "--speed", "20"]


@pytest.fixture(scope="module")
def vehicle():
    """S1002 on UIC60 with cant 1:40."""
    track, one = petsam.wheel.Track(petsam.wheel.uic60(), cant=0.025), petsam.wheel.Wheelset(petsam.wheel.s1002(), 0.46)
    return Vehicle(track, one, 0.3, COARSE)


@pytest.fixture(scope="module")
def axle(vehicle):
    with vehicle.axle() as one:
        yield one


@pytest.fixture
def run(monkeypatch, capsys):
    """run(*words, check=0): what petsam-wheel prints on both streams."""

    def call(*given, check=0):
        monkeypatch.setattr(sys, "argv", ["petsam-wheel", *map(str, given)])
        try:
            code = code_of("petsam-wheel")
        except SystemExit as end:
            code = end.code
        out, err = capsys.readouterr()
        assert code == check, err
        return out + err

    return call


# ---------------------------------------------------------------- equilibrium


def moment(found):
    """Moment of the pressure and the shear on the wheels about x through the axle's middle, cell by cell."""
    total, radius = 0.0, 0.46
    middle = np.array([0.0, found.position.y, found.position.z - radius])
    for result in found.wheels:
        for patch in result.patches:
            normal = np.array([0.0, -np.sin(patch.angle), np.cos(patch.angle)])
            across = np.array([0.0, np.cos(patch.angle), np.sin(patch.angle)])
            cell = abs(patch.grid_x[1] - patch.grid_x[0]) * abs(patch.grid_s[1] - patch.grid_s[0])
            origin = np.array([patch.x, patch.y, patch.z])
            for s, row in zip(patch.grid_s, patch.pressure):
                force = row.sum() * cell * (normal + patch.fs / patch.n * across)
                total += np.cross(origin + s * across - middle, force)[0]
    return total


@pytest.mark.parametrize(
    ("y", "yaw", "offset", "height"),
    [(0.0, 0.0, 0.0, 0.0), (3e-3, 2e-3, 0.0, 0.0), (-5.2e-3, 0.01, 0.1, 0.0), (5.8e-3, 4e-3, 0.0, 0.46)],
)
def test_vertical_forces_and_moments_balance(axle, y, yaw, offset, height):
    load = Load(100e3, offset, height=height)
    found = axle.solve(Position(y=y, yaw=yaw, speed=20.0), load)
    vertical = sum(one.force[2] for one in found.wheels)
    assert vertical == pytest.approx(100e3, rel=2e-5)
    # the shear acts at the centre of pressure here: its own distribution moves it by less than 0.1 mm
    assert moment(found) == pytest.approx(offset * 100e3 - height * found.lateral, abs=2e-5 * 100e3 * 0.75 + 5.0)
    assert found.lateral == pytest.approx(sum(one.force[1] for one in found.wheels))
    assert max(abs(found.force_error), abs(found.moment_error)) < 1e-5


def test_without_friction_the_loads_of_the_wheels_follow_the_lever(vehicle):
    with replace(vehicle, friction=0.0).axle() as axle:
        found = axle.solve(Position(speed=20.0), Load(100e3, 0.2))
    arms = [sum(p.centre[1] * p.force[2] for p in one.patches) / one.force[2] for one in found.wheels]
    height = [sum((p.centre[2] - found.position.z + 0.46) * p.force[1] for p in one.patches) for one in found.wheels]
    right = (100e3 * (0.2 - arms[1]) + sum(height)) / (arms[0] - arms[1])
    assert found.right.force[2] == pytest.approx(right, rel=1e-4)
    assert found.right.force[2] > found.left.force[2]


def test_left_and_right_are_mirror_images(axle):
    one = axle.solve(Position(y=4e-3, yaw=3e-3, vy=0.01, speed=20.0), Load(100e3, 0.05))
    other = axle.solve(Position(y=-4e-3, yaw=-3e-3, vy=-0.01, speed=20.0), Load(100e3, -0.05))
    assert other.position.roll == pytest.approx(-one.position.roll, abs=1e-9)
    assert other.lateral == pytest.approx(-one.lateral, rel=1e-4)
    assert other.radius_difference == pytest.approx(-one.radius_difference, abs=1e-9)
    assert [p.n for p in other.left.patches] == pytest.approx([p.n for p in one.right.patches][::-1], rel=1e-4)
    assert [p.fx for p in other.right.patches] == pytest.approx([p.fx for p in one.left.patches][::-1], rel=1e-4)


def test_numbers_are_continuous_over_y(vehicle):
    """Steps of 0.05 mm: changes vary little from step to step while the contact moves on without a jump."""
    y = np.arange(2.0e-3, 3.0e-3 + 1e-9, 5e-5)
    batch = petsam.wheel.solve_all(vehicle, [State(Position(y=float(one), speed=20.0), LOAD) for one in y])
    assert not batch.failures
    for name, most in (("ws_roll", 0.05), ("ws_z", 0.05), ("radius_difference", 0.05), ("ws_lateral", 0.15)):
        values = batch.of(name)
        steps = np.diff(values)
        assert np.abs(steps).max() < most * np.ptp(values) + 2.0 * np.ptp(values) / len(steps), name


def test_a_lateral_force_is_that_of_its_displacement(axle):
    at = axle.solve(Position(y=5.2e-3, speed=20.0), LOAD)
    found = axle.solve(Position(speed=20.0), Load(100e3, lateral=at.lateral))
    assert found.position.y == pytest.approx(5.2e-3, abs=2e-6)
    assert found.lateral == pytest.approx(at.lateral, rel=1e-3)


def test_given_loads_of_the_wheels_are_met(axle):
    found = axle.solve(Position(y=2e-3, speed=20.0), Load(100e3, right=60e3))
    assert [one.force[2] for one in found.wheels] == pytest.approx([60e3, 40e3], rel=1e-4)


def test_too_much_of_an_offset_is_an_error_that_names_it(axle):
    with pytest.raises(Error, match="a wheel lifts or climbs: check offset"):
        axle.solve(Position(speed=20.0), Load(100e3, 0.9))


def test_too_much_of_a_lateral_force_is_an_error_that_names_it(axle):
    with pytest.raises(Error, match="the wheelset climbs: reduce it"):
        axle.solve(Position(speed=20.0), Load(100e3, lateral=1e6))


def test_on_a_steep_flange_an_equilibrium_needs_few_solutions(axle):
    """At 6.3 mm the right contact is between root and flange, where the roll moves the flange aside, too."""
    found = axle.solve(Position(y=6.3e-3, speed=20.0), LOAD)
    assert max(abs(found.force_error), abs(found.moment_error)) < 1e-5
    assert min(one.force[2] for one in found.wheels) > 1e4
    assert found.right.patches[0].angle < -0.8 and found.passes <= 12


@pytest.mark.parametrize("y", [6.0e-3, 6.3e-3])
def test_the_height_of_rigid_wheels_falls_with_the_roll_by_their_arms(axle, y):
    """Of each wheel by itself, as differences have it."""
    position = axle.rigid(Position(y=y, speed=20.0)).position
    beside = [replace(position, roll=position.roll + step) for step in (-2e-6, 2e-6)]
    arms = axle._arms(axle._cases(position), position)
    touch = np.array([[case.search.touch for case in axle._cases(one)] for one in beside])
    assert -np.diff(touch, axis=0)[0] / 4e-6 == pytest.approx(arms, rel=0.02)
    assert arms[0] < 0.6  # and not 0.72, the lateral arm


@pytest.mark.filterwarnings("ignore:right wheel")
def test_forces_go_on_over_the_flange_until_the_wheelset_tips(axle):
    """With a force at the height of the axle no flange steeper than its lever holds the wheelset."""
    lever = np.arctan(0.75 / 0.46)
    before, lateral = None, []
    for y in np.linspace(6.25e-3, 6.37e-3, 7):
        before = axle.solve(Position(y=float(y), speed=20.0), LOAD, before)
        lateral.append(before.lateral)
        assert not before.derailed
    steps = np.diff(lateral)
    assert steps.min() > 5e3 and steps.max() < 2.5 * steps.min()
    with pytest.raises(Error, match=f"tips it, and the left wheel lifts: above about {lever:.1f}"):
        axle.solve(Position(y=6.6e-3, speed=20.0), LOAD, before)
    at_rails = axle.solve(Position(y=6.6e-3, speed=20.0), Load(100e3, height=0.46))
    assert abs(at_rails.right.patches[0].angle) > lever


def test_a_lateral_force_up_the_flange_is_found_before_the_derailed_one(axle):
    """60 kN hold at 6.293 mm; beyond 7.5 mm the tip of the flange gives more, and is no equilibrium that lasts."""
    found = axle.solve(Position(y=6.2e-3, speed=20.0), Load(100e3, lateral=60e3))
    assert found.lateral == pytest.approx(60e3, rel=1e-3)
    assert found.position.y == pytest.approx(6.2927e-3, abs=5e-6) and not found.derailed


def torque(found):
    """Torque of the forces and moments of all patches on the wheels about the axle, N m."""
    total, axle = 0.0, found.position.rotation[:, 1]
    middle = np.array([0.0, found.position.y, found.position.z - 0.46])
    for patch in (patch for result in found.wheels for patch in result.patches):
        across, normal = np.array([[0.0, f, g] for f, g in _turned(patch.angle)])
        at = np.array([patch.x, patch.y, patch.z]) + patch.approach * normal
        force = -np.array([patch.fx, 0.0, 0.0]) - patch.fs * across
        total += axle @ np.cross(at - middle, force) - patch.mn * axle @ normal
    return total


def _turned(angle):
    return (np.cos(angle), np.sin(angle)), (-np.sin(angle), np.cos(angle))


def work(found):
    """Frictional power of all patches, and what the driving forces and the torque put in, W."""
    patches = [patch for result in found.wheels for patch in result.patches]
    pulled = sum(patch.fx for patch in patches) * found.position.speed
    return sum(p.t_gamma * p.speed for p in patches), pulled - found.torque * found.position.pitch_rate


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("curvature", [0.0, 1.0 / 500.0])
def test_a_wheelset_without_a_pitch_rate_rolls_without_torque(vehicle, curvature):
    """Neither driven nor braked: no torque about the axle, and all work of friction is that of the pulling force."""
    rng, rail = np.random.default_rng(8), petsam.wheel.Track(petsam.wheel.uic60(), cant=0.025, curvature=curvature)
    with replace(vehicle, rail=rail).axle() as axle:
        for _ in range(6):
            (y, yaw), load, speed = rng.uniform(-6e-3, 6e-3, 2), rng.uniform(2e4, 2e5), rng.uniform(1.0, 60.0)
            found = axle.solve(Position(y=y, yaw=yaw, speed=speed), Load(load))
            assert found.torque == pytest.approx(torque(found), abs=1e-9 * load)
            assert abs(found.torque) < 1e-6 * load * 0.46
            if curvature == 0.0:
                slipped, given = work(found)
                assert given == pytest.approx(slipped, rel=1e-9)


@pytest.mark.parametrize("rolling", ["free", "radii", "given"])
def test_work_of_friction_is_that_of_force_and_torque(vehicle, rolling):
    """Of a wheelset that is driven or braked, too: by the radii in the middle of the track it brakes itself."""
    rate = dict(pitch_rate=-43.6) if rolling == "given" else {}
    with replace(vehicle, rolling=rolling if not rate else "free").axle() as axle:
        found = axle.solve(Position(speed=20.0, **rate), LOAD)
    slipped, given = work(found)
    assert given == pytest.approx(slipped, rel=1e-9)
    assert found.torque == pytest.approx(torque(found), rel=1e-9, abs=1e-6)
    assert (abs(found.torque) < 0.05) == (rolling == "free")
    pulled = [abs(one.patches[0].fx) for one in found.wheels]
    assert pulled[0] == pytest.approx(pulled[1], rel=1e-3)
    assert max(pulled) < 3.0 if rolling == "free" else min(pulled) > 500.0


@pytest.mark.parametrize("friction", [0.0, 1e-3])
def test_without_friction_a_wheelset_has_an_equilibrium(vehicle, friction):
    with replace(vehicle, friction=friction).axle() as axle:
        found = axle.solve(Position(y=3e-3, speed=20.0), LOAD)
    assert abs(found.torque) < 1e-6 * 46e3
    assert sum(one.force[2] for one in found.wheels) == pytest.approx(100e3, rel=2e-5)


def test_the_command_rolls_freely_or_by_the_mean_of_the_radii(run):
    """By the radii the creepage in the middle is the approach over the radius, 8e-5."""
    creepages = [
        float(re.search(r"creepages (\S+)", run(*BASE, *ONE, "--y", "0", *rolling))[1])
        for rolling in ([], ["--rolling", "free"], ["--rolling", "radii"])
    ]
    assert creepages[0] == creepages[1]
    assert creepages[2] == pytest.approx(8.1e-5, abs=2e-6) and creepages[0] < 0.0


def test_rolling_of_another_name_is_named(vehicle):
    with pytest.raises(Error, match="rolling 'coasting': expected free or radii"):
        replace(vehicle, rolling="coasting").axle()


def test_nadals_limit_is_that_of_a_wheel_that_slips_down():
    """By the balance of normal force and friction on the inclined face."""
    angle, mu, n = 1.2, 0.35, 1.0
    lateral, vertical = n * np.sin(angle) - mu * n * np.cos(angle), n * np.cos(angle) + mu * n * np.sin(angle)
    assert derailing.nadal(angle, mu) == pytest.approx(lateral / vertical)


def test_the_steepest_place_is_that_of_the_standard(vehicle):
    """Zone E of S1002 is a line of 70 degrees between y = -39.76 and -38.43 mm."""
    face = derailing.flange(vehicle.wheel)
    assert face.angle == pytest.approx(np.radians(70.0), abs=2e-3)
    assert face.y == pytest.approx(-39.76e-3, abs=2e-4)


def with_face(profile, depth, slope):
    """A wheel with the rim's outer face beyond its tread."""
    k = np.arange(1, int(depth / 2.5e-4) + 1) * 2.5e-4
    return replace(profile, y=np.r_[profile.y, profile.y[-1] + k / slope], z=np.r_[profile.z, profile.z[-1] - k],
                   weights=None)  # fmt: skip


def scratched(profile, y, depth=2e-4, half=1.5e-4):
    return replace(profile, z=profile.z - depth * np.maximum(0.0, 1.0 - abs(profile.y - y) / half), weights=None)


@pytest.mark.parametrize("wheel", [
    with_face(petsam.wheel.s1002(), 2e-3, 3.1), with_face(petsam.wheel.s1002(), 40e-3, 8.0),
    with_face(petsam.wheel.s1002(), 5e-3, 1.5),
    scratched(petsam.wheel.s1002(), 0.02), scratched(petsam.wheel.s1002(), -0.045),
    scratched(petsam.wheel.s1002(), -0.036, 1e-4),
], ids=["face", "deep face", "chamfer", "on the tread", "on the flange", "in the root"])  # fmt: skip
def test_the_steepest_place_is_between_tip_and_tread(vehicle, wheel):
    plain, found = (derailing.flange(petsam.wheel.Wheelset(one, 0.46)) for one in (petsam.wheel.s1002(), wheel))
    assert found.angle == pytest.approx(plain.angle, abs=2e-3) and found.y == pytest.approx(plain.y, abs=1e-4)


def test_a_face_alone_is_no_flange():
    wheel = petsam.wheel.s1002()
    keep = wheel.y > -0.02
    tread = replace(wheel, y=wheel.y[keep], z=wheel.z[keep], weights=None)
    assert derailing.flange(petsam.wheel.Wheelset(with_face(tread, 20e-3, 5.0), 0.46)) is None


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_wheel_on_its_tip_is_derailed(axle, sign):
    with pytest.warns(petsam.wheel.DerailWarning, match="derailed: its contact is beyond the flange's steepest place"):
        found = axle.solve(Position(y=sign * 7.8e-3, speed=20.0), LOAD)
    climb = found.climbs[0 if sign > 0.0 else 1]
    assert found.derailed and climb.state == "derailed" and climb.side == ("right" if sign > 0.0 else "left")
    patch = found.wheels[0 if sign > 0.0 else 1].patches[0]
    assert climb.angle == pytest.approx(abs(patch.angle)) and climb.angle < np.radians(69.0)
    force = (found.right if sign > 0.0 else found.left).force
    assert climb.ratio == pytest.approx(sign * force[1] / force[2])
    states = {column.name: column.values for column in found.table()}["state"]
    assert sorted(states) == ["derailed", "on rail"]


def test_on_the_tread_nothing_climbs(axle):
    found = axle.solve(Position(y=3e-3, yaw=2e-3, speed=20.0), LOAD)
    assert not found.derailed and [one.text for one in found.climbs] == ["", ""]


def test_derailment_and_its_neighbours_are_printed(run):
    text = run(*BASE, *ONE, "--y", "6.2mm:7.4mm:3", "--cores", "1")
    assert "DERAILED: Y/Q 1." in text and "at this angle" in text
    assert "nearest with an equilibrium: position 1, y 0.0062 m" in text and "and position 3, y 0.0074 m" in text
    assert "..." not in text


def test_warnings_of_positions_are_whole_sentences(capsys):
    notes = [("Y/Q is 1.25, above 0.8",), (), ("Y/Q is 1.5e0, above 0.8", "N is 3 kN"), ("Y/Q is 2, above 0.8",)]
    printing._warn_of_notes([batch.Found(None, "", one) for one in notes])
    lines = [line.partition("warning: ")[2] for line in capsys.readouterr().err.splitlines()]
    assert lines == [
        "position 1: Y/Q is 1.25, above 0.8; 2 other positions with such a warning: see the column note",
        "position 3: N is 3 kN",
    ]


def test_unlike_profiles_mirrored_give_mirrored_forces(vehicle):
    """Left and right exchanged, and the position mirrored."""
    y, z = petsam.wheel.s1002().y, petsam.wheel.s1002().z
    worn = petsam.wheel.Wheelset(Profile(y, z - 2e-4 * np.exp(-((y / 0.01) ** 2)), "wheel"), 0.46)
    rail = petsam.wheel.Track(petsam.wheel.uic60(), cant=0.05)
    new = vehicle.rail, vehicle.wheel
    with replace(vehicle, left=(rail, worn)).axle() as axle:
        one = axle.solve(Position(y=2e-3, yaw=1e-3, speed=20.0), LOAD)
    with replace(vehicle, rail=rail, wheel=worn, left=new).axle() as axle:
        other = axle.solve(Position(y=-2e-3, yaw=-1e-3, speed=20.0), LOAD)
    assert other.lateral == pytest.approx(-one.lateral, rel=1e-3)
    assert other.right.force * [1, -1, 1] == pytest.approx(one.left.force, rel=1e-3)
    with vehicle.axle() as axle:
        alike = axle.solve(Position(y=2e-3, yaw=1e-3, speed=20.0), LOAD)
    assert abs(alike.lateral - one.lateral) > 0.05 * abs(alike.lateral)


def test_left_and_right_profiles_in_the_command(run, tmp_path):
    """LEFT,RIGHT with a mirrored position gives the forces of RIGHT,LEFT."""
    y, z = petsam.wheel.s1002().y, petsam.wheel.s1002().z
    path = columns(tmp_path / "worn.txt", Profile(y, z - 2e-4 * np.exp(-((y / 0.01) ** 2)), "wheel"))
    lateral = []
    for names, place in ((f"s1002,{path}", "2mm"), (f"{path},s1002", "-2mm")):
        text = run("--wheel", names, *BASE[2:], "--unit", "mm", "--z", "down", *ONE, f"--y={place}")
        lateral.append(float(re.search(r"lateral force (\S+) N", text)[1]))
    assert lateral[0] == pytest.approx(-lateral[1], rel=1e-3)
    plain = run(*BASE, *ONE, "--y", "2mm")
    assert abs(float(re.search(r"lateral force (\S+) N", plain)[1]) - lateral[0]) > 10.0


def test_softer_materials_have_hertz_pressure(run):
    """Pressure grows as E*^(2/3): the modulus of both by a factor of 8 divides it by 4."""
    found = []
    for modulus in ("200GPa,0.3", "25GPa,0.3"):
        given = ["--wheel-material", modulus, "--rail-material", modulus, "--friction", "0", "--load", "10kN"]
        text = run(*BASE, *given, "--speed", "20", "--y", "-4mm")
        found.append(float(re.search(r"right.*p_max (\S+) MPa", text)[1]))
    assert found[0] / found[1] == pytest.approx(4.0, rel=0.05)
    one = run(*BASE, *ONE, "--y", "0", "--wheel-material", "steel")
    assert one == run(*BASE, *ONE, "--y", "0")


@pytest.mark.parametrize("weights, more, message, code", [
    ("0", [], "vehicle.csv: column weight: all are 0, and nothing wears", 2),
    ("-1", [], "line 2: weight -1: expected 0 or more", 3),
    ("1", ["--distance", "1e9km"], "--distance 1e+12: expected m above 0", 2),
    ("1", ["--distance", "100000km", "--wear", "1e-9"], "--jumps 10: each takes off some", 2),
])  # fmt: skip
def test_wear_that_cannot_be_followed_is_refused_before_anything_is_solved(
    run, tmp_path, monkeypatch, weights, more, message, code
):
    def never(*_):
        raise AssertionError("solved")

    monkeypatch.setattr(Case, "at", never)
    monkeypatch.setattr(Case, "draft", never)
    table = tmp_path / "vehicle.csv"
    table.write_text(f"y [mm],speed [m/s],load [kN],weight\n1,20,100,{weights}\n")
    text = run(*BASE, "--table", table, "--cores", 1, "--wear", "1e-14", *more, check=code)
    assert message in text and ("vehicle.csv" in text or more)


def test_weights_of_states_are_shares(vehicle):
    one = State(Position(speed=20.0), LOAD)
    assert wearing.shares([one, replace(one, weight=3.0)]) == pytest.approx([0.25, 0.75])
    with pytest.raises(Error, match="position 2: weight -1: expected a share of the distance"):
        petsam.wheel.wear(vehicle, [one, replace(one, weight=-1.0)], 1e6, Law("energy", 1e-14), 2)


def worn(rail, slope, play, inner):
    """A wheel with two hollows and a flange that lies on the rail at three places in a lateral displacement; `inner`:
    its width beyond the one at this slope."""
    section, bumps, depth = rail.section, (0.0, 13e-3, 28e-3), 1e-4
    flange = float(section.y[np.flatnonzero(section.slope(section.y) > -slope)[0]])
    y = np.arange(max(section.first, flange - inner), flange + 33e-3, 1e-4)
    gap = depth - depth * sum(np.exp(-(((y - flange - one) / 3e-3) ** 2)) for one in bumps)
    z = section.height(y) - gap - 20.0 * np.maximum(flange - 3e-3 - y, 0.0) ** 2
    t = np.arange(1e-4, 0.03, 1e-4)
    tail = z[-1] - 0.025 * t + ((z[-1] - z[-2]) / 1e-4 + 0.025) * 4e-3 * (1.0 - np.exp(-t / 4e-3))
    points = np.concatenate([y, y[-1] + t]) - play - 0.75, np.concatenate([z, tail])
    return petsam.wheel.Wheelset(Profile(*points, "wheel"), 0.46)


@pytest.mark.filterwarnings("ignore")
def test_three_patches_of_a_wheel_carry_its_load(vehicle):
    """Two hollows and a flange: balance, mirror images, small steps over 0.05 mm."""
    wheelset, counts, before = worn(vehicle.rail, 0.5, 0.0, 5e-3), set(), None
    with Vehicle(vehicle.rail, wheelset, 0.3, COARSE).axle() as axle:
        for y in (0.0, 5e-5, 1e-4):
            here = Position(y=y, yaw=1e-3, speed=20.0)
            found = axle.solve(here, LOAD, before)
            other = axle.solve(replace(here, y=-y, yaw=-1e-3), LOAD)
            counts |= {len(one.patches) for one in found.wheels}
            assert max(abs(found.force_error), abs(found.moment_error)) < 1e-5
            assert sum(one.force[2] for one in found.wheels) == pytest.approx(LOAD.vertical, rel=2e-5)
            assert other.right.force * [1, -1, 1] == pytest.approx(found.left.force, abs=1e-4 * LOAD.vertical)
            if before is not None:
                assert abs(found.position.z - before.position.z) < 2e-5
                assert abs(found.lateral - before.lateral) < 0.3 * LOAD.vertical
            before = found
    assert 3 in counts


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(
    ("slope", "inner", "y", "message"),
    [(0.9, 5e-3, 5.2e-3, "no equilibrium up to an overlap .*: a flange climbs"), (0.6, 5e-3, 5.3e-3, "is cut by")],
)
def test_a_flange_without_equilibrium_is_named(vehicle, slope, inner, y, message):
    with Vehicle(vehicle.rail, worn(vehicle.rail, slope, 5e-3, inner), 0.3, COARSE).axle() as axle:
        with pytest.raises(Error, match=message):
            axle.solve(Position(y=y, speed=20.0), LOAD)


def test_a_wheel_that_lifts_without_a_flange_does_not_tip_by_it(axle):
    """The load's line outside the right rail lifts the left wheel; the contact is on the tread."""
    with pytest.raises(Error) as caught:
        axle.solve(Position(speed=20.0), Load(100e3, 0.9))
    assert "tips" not in str(caught.value)


@pytest.mark.parametrize("y, yaw", [(0.0, 0.0), (3e-3, 1e-3), (-4.8e-3, 1e-2)])
def test_the_estimated_wear_is_below_the_solved_one_and_near_it(vehicle, y, yaw):
    states, law = [State(Position(y=y, yaw=yaw, speed=20.0), LOAD)], Law("energy", 1e-14)
    solved = wearing.rates(vehicle, states, law).depth_per_distance.max()
    assert 0.1 * solved < wearing.estimate(vehicle, states, law) < 1.2 * solved


@pytest.mark.parametrize("y, yaw", [(3e-3, 2e-3), (5.4e-3, -4e-3)])
def test_drafts_are_near_the_solution_and_those_of_equal_cells_are_it(axle, monkeypatch, y, yaw):
    found = axle.solve(Position(y=y, yaw=yaw, speed=20.0), LOAD)
    draft = Case(axle.pairs[0], found.position).draft(found.position.z)
    assert draft.force == pytest.approx(found.right.force, abs=0.03 * np.linalg.norm(found.right.force))
    assert draft.patches[0].centre == pytest.approx(found.right.patches[0].centre, abs=1e-4)
    monkeypatch.setattr(contacts, "COARSER", 1)
    right = axle.pairs[0]
    with Pair(right.rail, right.wheel, right.friction, settings=axle.settings) as pair:
        draft = Case(pair, found.position).draft(found.position.z)
    assert draft.force == pytest.approx(found.right.force, rel=1e-4)
    assert draft.patches[0].centre == pytest.approx(found.right.patches[0].centre, abs=1e-7)


@pytest.mark.parametrize("side", ["x", "s"])
def test_a_grid_for_the_contact_of_a_draft_gives_the_same_solution(axle, side):
    """On fewer cells; where the contact of the draft is too small, on those for the whole overlap."""
    found = axle.solve(Position(y=3e-3, yaw=2e-3, speed=20.0), LOAD)
    right, z = axle.pairs[0], found.position.z
    with Pair(right.rail, right.wheel, right.friction, settings=Settings()) as pair:
        case = Case(pair, found.position)
        draft = case.draft(z)
        patch = draft.patches[0]
        shift = 0.4 * (patch.high - patch.low) * (np.array(["x", "s"]) == side)
        wrong = replace(draft, patches=(replace(patch, low=patch.low + shift, high=patch.high + shift),))
        small, other, whole = (case.at(z, near).patches[0] for near in (draft, wrong, None))
    assert np.prod(small.grid) < 0.85 * np.prod(whole.grid)
    for one in small, other:
        assert one.force == pytest.approx(whole.force, abs=1e-5 * LOAD.vertical)
        assert one.cells == whole.cells and one.p_max == pytest.approx(whole.p_max, rel=1e-6)


def test_a_part_of_the_contact_that_a_draft_does_not_have_is_found(vehicle):
    """A wheel with waves touches at two crests; the draft has one of them, and the edge of its grid is free."""
    y = np.linspace(-0.06, 0.06, 1201)
    waves = Profile(y, 6e-5 * np.cos(2.0 * np.pi * y / 6e-3), "wheel")
    with Pair(vehicle.rail, petsam.wheel.Wheelset(waves, 0.46), 0.3, settings=Settings()) as pair:
        case = Case(pair, Position(speed=20.0))
        z = case.search.touch + 7e-5
        whole, draft = case.at(z), case.draft(z)
        in_contact = whole.patches[0].pressure.any(axis=1)
        first, last = np.flatnonzero(in_contact)[[0, -1]]
        empty = first + np.flatnonzero(~in_contact[first:last])
        patch = draft.patches[0]
        middle = whole.patches[0].grid_s[empty[len(empty) // 2]]
        cut = replace(patch, high=np.array([patch.high[0], middle]))
        found = case.at(z, replace(draft, patches=(cut,)))
    assert len(whole.patches) == 1 and found.patches[0].cells == whole.patches[0].cells
    assert found.force == pytest.approx(whole.force, rel=1e-6, abs=1e-2)


def test_an_equilibrium_needs_few_full_solutions(vehicle):
    """From its neighbour, with the pitch rate without torque; by the mean of the radii 3 suffice."""
    y = np.linspace(1e-3, 4e-3, 9)
    for rolling, most in ("free", 4.0), ("radii", 3.0):
        with replace(vehicle, rolling=rolling).axle() as axle:
            found = [axle.solve(Position(y=float(y[0]), speed=20.0), LOAD)]
            for one in y[1:]:
                found.append(axle.solve(Position(y=float(one), speed=20.0), LOAD, found[-1]))
        assert np.mean([one.passes for one in found[1:]]) <= most
        for one in found:
            assert max(abs(one.force_error), abs(one.moment_error)) < 1e-5
            if rolling == "radii":
                rate = -2.0 * one.position.speed / sum(one.radii)
                assert one.position.pitch_rate == pytest.approx(rate, rel=1e-8)


def test_loads_of_a_wheelset_are_not_extrapolated_to_fine_grids(axle, monkeypatch):
    """Warnings need it: a wheel alone has it, whose warnings are those of all its solutions."""
    steps = []
    solved = contacts.solved
    monkeypatch.setattr(contacts, "solved", lambda *given: steps.append(solved(*given)) or steps[-1])
    found = axle.solve(Position(y=2e-3, speed=20.0), LOAD)
    assert all(np.isnan(one.numbers["load_tx_extrapolated"]) for one in steps)
    with Pair(axle.pairs[0].rail, axle.wheel, settings=COARSE) as pair:
        pair.solve(found.position)
    assert np.isfinite(steps[-1].numbers["load_tx_extrapolated"])


def test_a_full_solution_takes_the_search_of_the_draft_there(axle, monkeypatch):
    """The gap along the locus belongs to the position: it is searched once for the draft and the solution."""
    places = []
    search = Case._near
    monkeypatch.setattr(Case, "_near", lambda case: places.append(case.position) or search(case))
    axle.solve(Position(y=2.1e-3, yaw=1e-3, speed=20.0, pitch_rate=-43.4), LOAD)
    solved = [one for one in places if one.z is not None and one.z != places[0].z]
    assert len(solved) > 4 and len(set(solved)) == len(solved)


def test_a_start_under_another_load_is_near(axle, monkeypatch):
    """By Hertz: 10 drafts of a wheel; from the neighbour's own overlaps 16."""
    at, count = Position(y=2e-3, speed=20.0), []
    found = axle.solve(at, Load(60e3))
    draft = Case.draft
    monkeypatch.setattr(Case, "draft", lambda case, z: count.append(z) or draft(case, z))
    other = axle.solve(at, Load(150e3, offset=0.1), found)
    assert len(count) <= 12 and max(abs(other.force_error), abs(other.moment_error)) < 1e-5


def test_a_batch_goes_from_neighbour_to_neighbour():
    rng = np.random.default_rng(3)
    states = [
        State(Position(y=float(y), yaw=float(a), speed=20.0), LOAD) for y, a in rng.uniform(-5e-3, 5e-3, (400, 2))
    ]
    path = batches._path(states)
    assert sorted(path) == list(range(400))
    y, yaw = np.array([(states[k].position.y, states[k].position.yaw) for k in path]).T
    assert np.mean(abs(np.diff(y))) < 3e-4 and np.mean(abs(np.diff(yaw))) < 8e-4  # without order 3.3e-3 each
    sweep = [State(Position(y=float(y), yaw=1e-3, speed=20.0), LOAD) for y in np.linspace(-5e-3, 5e-3, 31)]
    assert batches._path(sweep) == list(range(31))


def test_numbers_of_a_batch_are_in_the_order_of_its_positions(vehicle):
    states = [State(Position(y=y, speed=20.0), LOAD) for y in (2e-3, -1e-3, 1e-3)]
    assert [one.value.position.y for one in batches.run(vehicle, states, keep=_itself)] == [2e-3, -1e-3, 1e-3]


def _itself(found):
    return found


def test_the_start_does_not_change_the_equilibrium(axle):
    """From a far neighbour, whose correction and slopes do not fit."""
    far = axle.solve(Position(y=-4.8e-3, yaw=-8e-3, speed=20.0), Load(60e3))
    at = Position(y=3.5e-3, yaw=2e-3, speed=20.0)
    one, other = axle.solve(at, LOAD), axle.solve(at, LOAD, far)
    assert other.position.z == pytest.approx(one.position.z, abs=2e-9)
    assert other.position.roll == pytest.approx(one.position.roll, abs=2e-9)
    assert other.lateral == pytest.approx(one.lateral, rel=2e-4)


def test_work_of_friction_is_that_of_forces_and_creepages(axle):
    found = axle.solve(Position(y=4e-3, yaw=5e-3, speed=20.0), LOAD)
    for patch in [patch for one in found.wheels for patch in one.patches]:
        work = -(patch.fx * patch.creep_x + patch.fs * patch.creep_s + patch.mn * patch.creep_spin)
        assert patch.t_gamma == pytest.approx(work, rel=0.03)


def test_random_wheelsets_are_in_equilibrium_or_named(vehicle):
    rng = np.random.default_rng(7)
    states = [
        State(Position(y=float(y), yaw=float(yaw), speed=20.0), Load(float(load)))
        for y, yaw, load in zip(
            rng.uniform(-5.5e-3, 5.5e-3, 16), rng.uniform(-0.05, 0.05, 16), rng.uniform(5e4, 2e5, 16)
        )
    ]
    found = petsam.wheel.solve_all(vehicle, states)
    table = {column.name: column.values for column in found.table()}
    for number, state in enumerate(states, 1):
        rows = [k for k, one in enumerate(table["position"]) if one == number]
        if found.found[number - 1].failure:
            assert "no equilibrium" in table["note"][rows[0]]
        else:
            assert sum(table["track_fz"][k] for k in rows) == pytest.approx(state.load.vertical, rel=2e-5)
    assert len(found.failures) <= 1


def wavy(profile, rng, height):
    """The profile with seven smooth bumps and hollows, some of which make contacts of several patches."""
    low, high = (-0.045, 0.05) if profile.kind == "wheel" else (-0.035, 0.035)
    z = profile.z.copy()
    for _ in range(7):
        middle, width = rng.uniform(low, high), rng.uniform(2.5e-3, 6e-3)
        z += rng.uniform(-height, height) * np.exp(-(((profile.y - middle) / width) ** 2))
    return Profile(profile.y, z, profile.kind)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_random_worn_wheelsets_are_in_equilibrium_and_mirror_images():
    """Twelve pairs of wavy profiles, yaw to 0.05: balance, mirror images, small steps over 0.05 mm."""
    rng, counts = np.random.default_rng(6), set()
    for _ in range(12):
        height = rng.uniform(3e-5, 2e-4)
        wheelset = petsam.wheel.Wheelset(wavy(petsam.wheel.s1002(), rng, height), 0.46)
        track = petsam.wheel.Track(wavy(petsam.wheel.uic60(), rng, height), cant=0.025)
        y, yaw, load = rng.uniform(-5e-3, 5e-3), rng.uniform(-0.05, 0.05), Load(rng.uniform(5e4, 2e5))
        with Vehicle(track, wheelset, 0.3, COARSE).axle() as axle:
            here = Position(y=float(y), yaw=float(yaw), speed=20.0)
            one = axle.solve(here, load)
            other = axle.solve(replace(here, y=-here.y, yaw=-here.yaw), load)
            beside = axle.solve(replace(here, y=here.y + 5e-5), load, one)
        counts |= {len(result.patches) for result in one.wheels}
        assert sum(result.force[2] for result in one.wheels) == pytest.approx(load.vertical, rel=2e-5)
        assert max(abs(one.force_error), abs(one.moment_error)) < 1e-5
        assert other.position.roll == pytest.approx(-one.position.roll, abs=5e-8)
        assert other.lateral == pytest.approx(-one.lateral, abs=1e-3 * load.vertical)
        assert abs(beside.position.z - one.position.z) < 3e-5 and abs(beside.position.roll - one.position.roll) < 5e-5
    assert counts >= {1, 2}


def test_a_batch_does_not_depend_on_its_processes(vehicle):
    states = [State(Position(y=1e-4 * k, speed=20.0), LOAD) for k in range(12)]
    one, two = (petsam.wheel.solve_all(vehicle, states, cores) for cores in (1, 2))
    assert [column.values for column in one.table()] == [column.values for column in two.table()]


# ---------------------------------------------------------------- equivalent conicity


def test_conicity_of_cones_is_their_slope():
    y = np.linspace(-0.01, 0.01, 201)
    assert equivalent_conicity(y, 2 * 0.05 * y, [1e-3, 8e-3], 0.46) == pytest.approx(0.05, rel=1e-6)


def test_conicity_is_that_of_the_integrated_motion():
    """By the wavelength of y'' = -difference/(e r0), integrated in time."""
    y = np.linspace(-0.01, 0.01, 2001)
    law = lambda y: 0.1 * y + 3e3 * y**3 + 0.02 * np.maximum(y, 0.0)  # noqa: E731
    radius, start = 0.46, -5e-3
    turn = lambda x, state: state[1]  # noqa: E731
    turn.terminal, turn.direction = True, -1
    slope = lambda x, state: [state[1], -law(state[0]) / (1.5 * radius)]  # noqa: E731
    motion = solve_ivp(slope, (0, 200), [start, 0.0], events=turn, rtol=1e-10, atol=1e-13)
    half, end = motion.t_events[0][0], motion.y_events[0][0][0]
    expected = (np.pi / (2.0 * half)) ** 2 * 2.0 * 1.5 * radius
    assert equivalent_conicity(y, law(y), [0.5 * (end - start)], radius)[0] == pytest.approx(expected, rel=1e-4)


def test_rigid_wheels_touch_at_both_sides(axle):
    shape = petsam.wheel.geometry(axle, [-4e-3, 0.0, 4e-3])
    assert shape.radius_difference == pytest.approx(
        [-shape.radius_difference[2], 0.0, shape.radius_difference[2]], abs=1e-8
    )
    assert shape.points[0] == pytest.approx(-shape.points[1][::-1], abs=7e-5)
    for y, roll, z in zip(shape.y, shape.roll, shape.z):
        for pair, sign in zip(axle.pairs, (1.0, -1.0)):
            near = pair.solve(Position(y=float(y), roll=float(roll), z=float(z) + 1e-5, speed=20.0))
            assert near.overlap == pytest.approx(1e-5, abs=1e-8), sign


# ---------------------------------------------------------------- wear


def test_worn_volume_is_coefficient_times_work(vehicle, axle):
    """The integral of the depths of a revolution is the work of friction in it."""
    found = axle.solve(Position(y=3e-3, yaw=2e-3, speed=20.0), LOAD)
    y = np.linspace(-0.06, 0.06, 12001)
    rows = rows_of(found, "energy")
    rates = depth_rates(y, rows, 1e-14)
    slopes = [abs(np.cos(patch.angle)) for one in found.wheels for patch in one.patches]
    area = np.trapezoid(rates, y) / np.mean(slopes)
    assert 2.0 * area == pytest.approx(1e-14 * found.t_gamma / (2 * np.pi * 0.46), rel=0.02)


def test_worn_places_are_those_in_contact(axle):
    found = axle.solve(Position(y=3e-3, speed=20.0), LOAD)
    for result, sign in zip(found.wheels, (1.0, -1.0)):
        for patch in result.patches:
            place = np.average(patch.wheel_y, weights=patch.pressure.sum(axis=1))
            assert place == pytest.approx(sign * (patch.centre[1] - 3e-3) - 0.75, abs=2e-4)


def test_wear_takes_off_what_the_rates_say_and_has_an_error(vehicle):
    states = [State(Position(y=y, yaw=1e-3, speed=20.0), LOAD, weight) for y, weight in ((-2e-3, 1.0), (3e-3, 2.0))]
    law = Law("energy", 1e-14)
    few = petsam.wheel.wear(vehicle, states, 5e6, law, 2)
    rates = wearing.rates(vehicle, states, law)
    assert not rates.failures and not few.failures
    lengths = np.append(0.0, np.cumsum(np.hypot(np.diff(rates.y), np.diff(rates.z))))
    area = float(np.sum(rates.depth_per_distance * np.gradient(lengths))) * 5e6
    assert few.area[-1] == pytest.approx(area, rel=0.1)
    deepest, error = few.deepest
    assert 0.0 < error < 0.5 * deepest
    removed = np.hypot(few.new.y - few.worn.y, few.new.z - few.worn.z)
    assert removed == pytest.approx(few.depth, abs=1e-12)
    assert (few.worn.z <= few.new.z + 1e-15).all()
    with pytest.raises(Error, match="takes off .* use at least"):
        petsam.wheel.wear(vehicle, states, 5e9, law, 2)


def test_archard_with_full_sliding_is_energy_over_friction(axle):
    found = axle.solve(Position(y=3e-3, yaw=0.05, speed=20.0), LOAD)
    for (_, work, _), (_, way, _) in zip(rows_of(found, "energy"), rows_of(found, "archard")):
        assert work.sum() == pytest.approx(0.3 * way.sum(), rel=0.02)


def solved_again(vehicle, found, cell):
    """The table of an equilibrium at the same displacement on other cells, {name: values}."""
    with replace(vehicle, settings=Settings(cell=cell)).axle() as axle:
        again = axle.solve(replace(found.position, z=None, pitch_rate=None), found.load)
    return {column.name: np.array(column.values) for column in again.table()}


def test_errors_by_the_cells_cover_the_differences_from_much_finer_ones():
    of = petsam.wheel
    chance, covered, larger = np.random.default_rng(11), {}, {}
    for k in range(10):
        rail = of.Track(of.uic60(), cant=(0.025, 0.05)[k % 2])
        vehicle = Vehicle(
            rail, of.Wheelset(of.s1002(), chance.uniform(0.3, 0.6)), chance.uniform(0.1, 0.5), Settings(cell=3e-4)
        )
        position = Position(y=chance.uniform(-6e-3, 6e-3), yaw=chance.uniform(-6e-3, 6e-3), speed=20.0)
        load = Load(chance.uniform(60e3, 220e3))
        found = petsam.wheel.solve_all(vehicle, [State(position, load)], errors=True).table()
        table = {column.name: np.array(column.values) for column in found}
        with vehicle.axle() as axle:
            finer = solved_again(vehicle, axle.solve(position, load), 1e-4)
        for name in ("n", "fx", "fs", "p_max", "area", "t_gamma", "ws_z", "ws_roll", "creep_x"):
            error, true = table[f"{name}_error"], np.abs(table[name] - finer[name])
            covered.setdefault(name, []).extend(true <= error)
            larger.setdefault(name, []).extend(error / true)
    assert np.mean([one for values in covered.values() for one in values]) >= 0.85
    for name in covered:
        assert np.mean(covered[name]) >= 0.75, name
        assert np.median(larger[name]) <= 8.0, name


# ---------------------------------------------------------------- the command


def test_one_position_and_its_files(run, tmp_path):
    name = tmp_path / "one"
    text = run(*BASE, *ONE, "--y", "3mm", "--yaw", "2mrad", "-o", name)
    assert "position 1: y 3.0000 mm" in text and "right" in text and "T-gamma" in text
    head, *rows = (tmp_path / "one.csv").read_text().splitlines()
    for column in (
        "y [m]",
        "angle [rad]",
        "creep_spin [1/m]",
        "track_fy [N]",
        "p_max [Pa]",
        "stick_area [m2]",
        "t_gamma [N]",
    ):
        assert column in head.split(",")
    assert len(rows) == 2 and (tmp_path / "one.png").stat().st_size > 10000
    values = dict(zip(head.split(","), rows[0].split(",")))
    left = max(abs(float(values[f"{name}_error [1]"])) for name in ("force", "moment"))
    assert 0.0 < left <= 1e-5 and f"residual {left:.1g}\n" in text
    assert text.startswith("+-: estimated error by the cells, from a solution on cells twice as wide\n")
    for number, column, unit in (("N", "n", "N"), ("T-gamma", "t_gamma", "N")):
        error = float(values[f"{column}_error [N]"])
        told = re.search(rf"{number} (\S+) {unit} \+- ([\d.]+)[,\n]", text)
        assert 0.0 < error < 0.05 * float(values[f"{column} [N]"]) and float(told[2]) == pytest.approx(error, rel=0.05)
        assert float(told[1]) == pytest.approx(float(values[f"{column} [N]"]), abs=error / 10)


def test_a_position_without_known_errors_says_so(run, tmp_path):
    text = run(*BASE, *ONE, "--lateral", "5kN", "-o", tmp_path / "one", "--no-picture")
    said = "no error of the grid is known, as a lateral force is given"
    assert text.startswith(f"{said}\nposition 1") and "+-" not in text
    head, row, *_ = (tmp_path / "one.csv").read_text().splitlines()
    assert said in row and row.split(",")[head.split(",").index("n_error [N]")] == "nan"


def test_a_table_of_a_simulation(run, tmp_path):
    table = tmp_path / "vehicle.csv"
    table.write_text(
        "x [m],y [mm],yaw [deg],speed [km/h],load_right [kN],load_left [kN],weight\n"
        "1,2,0.1,72,45,55,2\n2,-1,0,36,50,50,1\n"
    )
    name = tmp_path / "many"
    text = run(*BASE, "--table", table, "--cores", 1, "--wear", "1e-14", "--no-picture", "-o", name)
    assert "columns that are not used: x" in text and "wear: at most" in text
    rows = (tmp_path / "many.csv").read_text().splitlines()
    head = rows[0].split(",")
    first = dict(zip(head, rows[1].split(",")))
    assert float(first["ws_yaw [rad]"]) == pytest.approx(np.radians(0.1))
    assert float(first["ws_y [m]"]) == 2e-3 and float(first["track_fz [N]"]) == pytest.approx(45e3, rel=1e-4)
    assert (tmp_path / "many-wear.csv").read_text().startswith("y [m],z [m],depth_per_distance [1]\n")


def test_a_roll_of_another_sign_is_a_warning(run, tmp_path):
    table = tmp_path / "vehicle.csv"
    table.write_text("y [mm],roll [mrad],speed [m/s],load [kN]\n5,5,20,100\n")
    assert "line 2: roll differs by" in run(*BASE, "--table", table, "--cores", 1)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("y,speed [m/s],load [N]\n1,2,3\n", "line 1: column y: has no unit: write y [m]"),
        ("y [mm],yaw [furlong],speed [m/s],load [N]\n1,2,3,4\n", "furlong: is no unit of it"),
        ("y [mm],yaw [rad],speed [m/s],load [kN]\n0,0,20,100\n0,2,20,100\n", "line 3: yaw 2: expected rad"),
        ("y [m],speed [m/s],load [kN]\n3,20,100\n", "line 2: y 3: expected a displacement in m"),
        ("y [mm],load [kN]\n3,100\n", "has no column speed: give it, speed [km/h], or --speed"),
        ("y [mm],speed [m/s]\n3,20\n", "has no column load: give the axle load"),
        ("y [mm],speed [m/s],load [kN]\n3,20,-1\n", "line 2: load -1000: expected an axle load above 0"),
        ("y [mm],speed [m/s],load [kN]\n3,20\n", "line 2 has 2 words, line 1 has 3 heads"),
    ],
)
def test_faults_of_a_table_have_their_line(run, tmp_path, text, message):
    table = tmp_path / "vehicle.csv"
    table.write_text(text)
    assert message in run(*BASE, "--table", table, check=3)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "--load is missing: give it, or --table"),
        ([*ONE], "give --y, --lateral or --table, and only one"),
        ([*ONE, "--y", "1mm", "--lateral", "1kN"], "only one of them"),
        (["--table", "t.csv", "--y", "1mm"], "--y: --table has it as a column: remove it"),
        ([*ONE, "--y", "1mm", "--distance", "1km"], "--distance: needs --wear"),
        ([*ONE, "--y", "1mm", "--rail", "uic60,x.prr", "--wear", "1e-14"], "both sides wear alike: give one profile"),
        ([*ONE, "--y", "1mm", "--wear", "1e-14", "--jumps", "4"], "--jumps: needs --distance"),
        ([*ONE, "--y", "1mm", "--wear", "1e-14", "--distance", "1km", "--jumps", "3"], "an even number"),
    ],
)
def test_options_that_do_not_fit(run, words, message):
    assert message in run(*BASE, *words, check=2)


# ---------------------------------------------------------------- mistakes of a first user


def columns(path, profile, scale=1e3, turn=1.0, order=slice(None), mirror=1.0):
    """Writes a profile as columns."""
    points = np.column_stack([mirror * scale * profile.y, turn * scale * profile.z])[order]
    np.savetxt(path, points, fmt="%.6f")
    return path


def shuffled(profile):
    order = np.arange(len(profile.y))
    np.random.default_rng(3).shuffle(order)
    return order


MISTAKES = {
    "mirrored wheel": ("wheel", dict(mirror=-1.0), [], "the profile is mirrored; give --mirror wheel"),
    "mirrored rail": ("rail", dict(order="gauge side", mirror=-1.0), [], "is mirrored; give --mirror rail"),
    "z up, wheel": ("wheel", dict(turn=-1.0), [], "give --z up"),
    "z up, rail": ("rail", dict(turn=-1.0), [], "is its z up? give --z up"),
    "m taken for mm": ("wheel", dict(scale=1.0), [], "check its unit of length"),
    "mm taken for m": ("wheel", {}, ["--unit", "m"], "check its unit of length"),
    "unsorted": ("wheel", dict(order=shuffled), [], "sort them along the profile"),
    "folded": ("rail", dict(order="folded"), [], "sort them along the profile, and remove folds"),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_mistakes_of_profiles_are_errors_with_their_cure(run, tmp_path, name):
    kind, given, more, message = MISTAKES[name]
    profile = petsam.wheel.s1002() if kind == "wheel" else petsam.wheel.uic60()
    order = given.get("order")
    if order == "folded":
        k = len(profile.y) // 2
        given = dict(order=np.r_[0:k, k - 30 : len(profile.y)])
    elif order == "gauge side":
        given = dict(given, order=(profile.y < 0.0) | (profile.z < 4e-3))
    elif order:
        given = dict(order=order(profile))
    path = columns(tmp_path / "profile.txt", profile, **given)
    words = list(BASE)
    words[words.index(f"--{kind}") + 1] = path
    more = more if "--unit" in more else ["--unit", "mm", *more]
    text = run(*words, "--z", "down", *more, *ONE, "--y", "0", check=3)
    assert message in text and len(text.splitlines()) == 1


def canted(path, cant=0.025, **given):
    return columns(path, petsam.wheel.uic60().turned(-cant), **given)


@pytest.mark.parametrize(("given", "words", "message"), [
    (dict(mirror=-1.0), [], "away from the middle by 1:40: is it mirrored? give --mirror rail"),
    (dict(mirror=-1.0), ["--cant", "1:40"], "away from the middle by 1:40: is it mirrored? give --mirror rail"),
    (dict(), ["--mirror", "rail"], "away from the middle by 1:40: is it mirrored? omit --mirror rail"),
    (dict(cant=0.05), ["--cant", "1:20"], "is it canted twice? Measured in its place, it is read without --cant"),
    (dict(), ["--cant", "1:40"], "by 1:20 with the cant: is it canted twice?"),
    (dict(cant=0.11), [], "more than 1:10: check whether it is turned, and take it without --cant"),
    (dict(), [], ""), (dict(cant=0.0), ["--cant", "1:40"], ""), (dict(cant=0.05), [], ""), (dict(cant=0.0), [], ""),
])  # fmt: skip
def test_a_rail_that_leans_the_wrong_way_is_named(run, tmp_path, given, words, message):
    path = canted(tmp_path / "rail.txt", **given)
    text = run("--wheel", "s1002", "--rail", path, "--unit", "mm", "--z", "down", *words, *ONE, "--y", "0", "--cell",
               "0.5mm", "--cores", 1)  # fmt: skip
    assert message in text and ("leans" in text) == bool(message)


def test_noise_does_not_make_a_rail_lean():
    rail = petsam.wheel.uic60()
    noisy = replace(rail, z=rail.z + 1e-5 * np.random.default_rng(5).normal(size=len(rail.z)))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        petsam.wheel.Track(noisy, cant=0.025)


@pytest.mark.parametrize(("shift", "words", "message"), [
    (70.0, [], "--flange-position -0.07: .*85.01 mm beside this back.*: give --flange-position 0mm"),
    (130.0, [], "give --flange-position, y of the flange's back in the profile"),
    (0.0, ["--flange-position", "0mm"], "give --flange-position -70mm, as of S1002"),
])  # fmt: skip
def test_y_from_another_back_is_an_error_with_its_cure(run, tmp_path, shift, words, message):
    wheel = petsam.wheel.s1002()
    path = columns(tmp_path / "wheel.txt", replace(wheel, y=wheel.y + 1e-3 * shift))
    text = run("--wheel", path, *BASE[2:], "--unit", "mm", "--z", "down", *words, *ONE, "--y", "0", check=2)
    assert re.search(message, text)


@pytest.mark.parametrize("shift", [5.0, -4.0, 0.0])
def test_a_back_a_little_beside_the_stated_one_is_named(run, tmp_path, shift):
    wheel = petsam.wheel.s1002()
    path = columns(tmp_path / "wheel.txt", replace(wheel, y=wheel.y + 1e-3 * shift))
    given = ["--wheel", path, *BASE[2:], "--unit", "mm", "--z", "down", *ONE, "--y", "0"]
    cure = f"{shift - 70:.4g}mm"
    assert (f"give --flange-position {cure}" in run(*given)) == bool(shift)
    text = run(*given, f"--flange-position={cure}")
    assert "flange" not in text and re.search(r"right y +750\.6", text)


@pytest.mark.parametrize(("kind", "words", "message"), [
    ("wheel", ["--z", "up"], "is its z down? give --z down"),
    ("rail", ["--z", "up"], "is its z down? give --z down"),
    ("wheel", ["--z", "down", "--mirror", "wheel"], "is mirrored; omit --mirror wheel"),
])  # fmt: skip
def test_a_cure_that_was_given_is_not_named(run, tmp_path, kind, words, message):
    path = columns(tmp_path / "profile.txt", petsam.wheel.s1002() if kind == "wheel" else petsam.wheel.uic60())
    given = list(BASE)
    given[given.index(f"--{kind}") + 1] = path
    assert message in run(*given, "--unit", "mm", *words, *ONE, "--y", "0", check=3)


def test_a_rail_without_a_gauge_face_in_the_command(run, tmp_path):
    rail = petsam.wheel.uic60()
    keep = rail.z < 9e-3
    path = columns(tmp_path / "rail.txt", replace(rail, y=rail.y[keep], z=rail.z[keep], weights=None))
    given = ["--wheel", "s1002", "--rail", path, *BASE[4:], *ONE, "--y", "0", "--unit", "mm", "--z", "down"]
    told = "give a --gauge-height within it, or --gauge-position, y of the gauge face in the profile"
    assert told in run(*given)
    shift = 1e3 * (petsam.wheel.Track(rail, cant=0.025).section.first - visible(rail.turned(-0.025)).first)
    for place in (
        f"{717.5 - shift:.6f}mm",
        f"{717.5 - shift:.6f}mm,{1e3 * visible(rail.turned(-0.025)).z.min():.6f}mm",
    ):
        text = run(*given, f"--gauge-position={place}")
        assert "gauge" not in text
        assert float(re.search(r"right y +(\S+) mm", text)[1]) == pytest.approx(750.608, abs=0.01)
    assert "argument --gauge-position: 1,2,3: expected y, or y and z" in run(
        *given, "--gauge-position", "1,2,3", check=2
    )
    assert "--gauge-position: expected y, or y and z" in run(*given, "--gauge-position=-36", check=2)


def test_unit_and_direction_of_each_file(run, tmp_path):
    wheel = columns(tmp_path / "wheel.txt", petsam.wheel.s1002(), scale=1e3 / 25.4)
    rail = columns(tmp_path / "rail.txt", petsam.wheel.uic60(), turn=-1.0)
    given = ["--wheel", wheel, "--rail", rail, *BASE[4:], *ONE, "--y", "2mm"]
    mixed, plain = run(*given, "--unit", "in,mm", "--z", "down,up"), run(*BASE, *ONE, "--y", "2mm")
    lateral = [float(re.search(r"lateral force (\S+) N", text)[1]) for text in (mixed, plain)]
    assert lateral[0] == pytest.approx(lateral[1], rel=2e-3)
    assert "argument --z: sideways: expected down or up" in run(*given, "--unit", "mm", "--z", "down,sideways", check=2)


@pytest.mark.parametrize("words, message", [
    (["--rail", "r.txt", "--unit", "mm,in"], "--unit mm,in: s1002 has its own: give that of the rail alone, --unit in"),
    (["--rail", "r.txt", "--z", "up,down"], "--z up,down: s1002 has its own: give that of the rail alone, --z down"),
    (["--wheel", "w.txt", "--unit", "mm,in"], "uic60 has its own: give that of the wheel alone, --unit mm"),
    (["--wheel", "w.PRW", "--rail", "r.txt", "--unit", "mm,in"], "w.PRW has its own: give that of the rail alone"),
    (["--rail", "r.prr", "--unit", "mm"], "--unit: is of files of columns, and none is given: remove it"),
    (["--z", "up"], "--z: is of files of columns, and none is given: remove it"),
])  # fmt: skip
def test_units_of_profiles_that_have_their_own_are_errors(run, words, message):
    assert message in run(*BASE, *ONE, "--y", "0", *words, check=2)


def test_units_of_files_beside_profiles_that_have_their_own():
    for words in (["--rail", "r.txt", "--unit", "mm"], ["--wheel", "s1002,w.txt", "--unit", "mm"],
                  ["--wheel", "w.prw", "--z", "up"], ["--wheel", "w.txt", "--rail", "r.txt", "--unit", "mm,in"],
                  ["--wheel", "s1002,w.txt", "--rail", "r.ban", "--z", "up,down"]):  # fmt: skip
        assert wheel.arguments([*BASE, *ONE, "--y", "0", *words])


def test_a_tread_far_from_the_nominal_radius_is_told(run, tmp_path):
    one = petsam.wheel.s1002()
    path = columns(tmp_path / "wheel.txt", replace(one, z=one.z + 0.012, weights=None))
    text = run("--wheel", path, *BASE[2:], "--unit", "mm", "--z", "down", *ONE, "--y", "0")
    told = "wheel.txt: its z is 12 mm at the tape circle, y = 0 mm, and the radius counts at z = 0: shift the profile's"
    assert told in text and "tape_line" not in text


def test_warnings_of_a_vehicle_are_told_once_with_its_wear(run, tmp_path):
    one = petsam.wheel.s1002()
    path = columns(tmp_path / "wheel.txt", replace(one, z=one.z + 0.012, weights=None))
    given = ["--wheel", path, *BASE[2:-2], "--cell", "0.6mm", "--unit", "mm", "--z", "down", *ONE, "--y", "0"]
    with warnings.catch_warnings():
        warnings.simplefilter("error", petsam.wheel.ProfileWarning)
        text = run(*given, "--gauge", "1.42m", "--wear", "1e-14", "--distance", "10km", "--jumps", "2")
    assert text.count("at the tape circle") == text.count("check --gauge") == 1


def test_two_radii_of_cones_roll_evenly_beside_the_middle():
    """Cones of the slope e: upright and with equal rolling radii where the wheelset is aside by their half difference
    over 2 e; a cone of a larger radius is one that is moved along its axle."""
    y = np.linspace(-0.07, 0.06, 400)
    arc = np.linspace(-0.2, 0.2, 400)
    rail = petsam.wheel.Track(Profile(0.15 * np.sin(arc), 0.15 * (1.0 - np.cos(arc)), "rail"), gauge=1.435)
    cone = petsam.wheel.Wheelset(Profile(y, -0.05 * y, "wheel"), 0.46)
    moved = petsam.wheel.Wheelset(Profile(y + 0.04, -0.05 * y, "wheel"), 0.46)
    found = []
    for left in (replace(cone, radius=0.462), moved):
        with petsam.wheel.Axle(rail, cone, 0.3, COARSE, left=(rail, left)) as axle:
            found.append(petsam.wheel.geometry(axle, [0.0, 0.01, 0.02]))
    one, other = found
    assert one.radius_difference[-1] == pytest.approx(0.0, abs=1e-8) and one.roll[-1] == pytest.approx(0.0, abs=1e-8)
    assert one.radius_difference[0] < -1.9e-3
    assert one.radii == pytest.approx(other.radii, abs=3e-6) and one.z == pytest.approx(other.z, abs=1e-7)


def test_radii_of_both_sides_in_the_command(run, tmp_path):
    """LEFT,RIGHT mirrored, and equal radii as one; worn wheels have one radius."""
    lateral = []
    for radii in ("460mm,461mm", "461mm,460mm"):
        text = run(*BASE, *ONE, "--y", "0", "--radius", radii)
        lateral.append(float(re.search(r"lateral force (\S+) N", text)[1]))
    assert lateral[0] == pytest.approx(-lateral[1], rel=1e-3) and lateral[0] > 100.0
    assert run(*BASE, *ONE, "--y", "0", "--radius", "460mm,460mm") == run(*BASE, *ONE, "--y", "0")
    text = run(*BASE, *ONE, "--y", "0", "--radius", "460mm,461mm", "--wear", "1e-14", check=2)
    assert "one length to --radius" in text
    assert "expected a length, or two of LEFT,RIGHT" in run(*BASE, *ONE, "--y", "0", "--radius", "1,2,3", check=2)


@pytest.mark.parametrize("kind", ["wheel", "rail"])
def test_a_cured_profile_is_that_of_the_standard(run, tmp_path, kind):
    profile = petsam.wheel.s1002() if kind == "wheel" else petsam.wheel.uic60()
    path = columns(tmp_path / "profile.txt", profile, mirror=-1.0, turn=-1.0)
    words = list(BASE)
    words[words.index(f"--{kind}") + 1] = path
    cured = run(*words, "--unit", "mm", "--z", "up", "--mirror", kind, *ONE, "--y", "2mm")
    plain = run(*BASE, *ONE, "--y", "2mm")
    texts = [re.sub(r" \+- [-+.e\d]+", "", text) for text in (cured, plain)]  # without the errors
    numbers = [[*map(float, re.findall(r"-?\d+\.\d+(?:e[-+]\d+)?", text))] for text in texts]
    assert len(numbers[1]) > 15
    assert numbers[0] == pytest.approx(numbers[1], rel=0.02, abs=1e-2)


@pytest.mark.parametrize(
    ("words", "message", "code"),
    [
        (["--cant", "-1:40"], "leans away from the middle: is 0.0249948 meant?", 0),
        (["--gauge", "1435"], "expected the distance of the rails' inner faces, m, such as 1.435", 2),
        (["--gauge", "1.0m"], "wheel is beside the rail: check --gauge", 2),
        (["--gauge", "1.5m"], "check --gauge, --flange-back", 0),
        (["--gauge", "1.42m"], "check --gauge, --flange-back", 0),
        (["--yaw", "2"], "expected rad", 2),
        (["--yaw", "0.3"], "yaw 0.3 rad is 17.2 degrees", None),
        (["--radius", "460"], "expected the wheel's nominal radius, m, such as 0.46", 2),
        (["--flange-position", "70mm"], "125 mm beside this back, usually 8 to 25 mm: give --flange-position -70mm", 2),
        (["--y", "3"], "--y 3: expected a displacement in m", 2),
        (["--smooth", "1m"], "--smooth 1: UIC60: wavelength 1: expected a length (m) above 0", 2),
        (["--smooth=-1mm"], "argument --smooth: -1mm: expected a length above 0", 2),
        (["--wheel", __file__], "columns have no unit of their own: give --unit mm", 2),
        (["--wheel", __file__, "--unit", "mm"], "columns do not state the direction of z: give --z down or --z up", 2),
        (["--wheel", "none.txt"], "--wheel: none.txt: no such file", 3),
        (["--wheel", "/"], "--wheel: /: is a directory", 3),
        (["--gauge-height", "1m"], "--gauge-height 1: expected a depth below the rail's top", 2),
        (["--curve", "5m"], "--curve 5: expected the radius in m", 2),
        (["--friction", "-1"], "argument --friction: -1: expected a coefficient", 2),
        (["--cell", "1m"], "--cell 1: expected the width of a cell", 2),
        (["--offset", "3m"], "--offset 3: expected a distance", 2),
        (["--height", "9m"], "--height 9: expected a distance", 2),
        (["--wheel-material", "inf,0.3"], "argument --wheel-material: inf,0.3: expected an elastic material", 2),
        (["--rail-material", "stell"], "argument --rail-material: stell is no material: is steel meant?", 2),
        (["--wheel", "s1002,"], "argument --wheel: s1002,: expected one profile, or two of LEFT,RIGHT", 2),
        (["--wheel", "none.prw"], "--wheel: none.prw: no such file", 3),
        (["--rail", "uic60,/"], "--rail: /: ", 3),
        (["--wheel", "s1002,uic60"], "is the profile of a rail: give --rail uic60", 2),
        (["--load", "1MN", "--offset", "0.9m"], "no position has an equilibrium", 11),
        (["--rail", "s1002"], "is the profile of a wheel: give --wheel s1002", 2),
    ],
)  # fmt: skip
def test_mistakes_of_places_are_named_with_their_cure(run, monkeypatch, capsys, words, message, code):
    given = [*BASE, *ONE, *([] if "--y" in words else ["--y", "0"]), *words]
    if code is not None:
        assert message in run(*given, check=code)
        return
    monkeypatch.setattr(sys, "argv", ["petsam-wheel", *given])
    code_of("petsam-wheel")
    assert message in "".join(capsys.readouterr())


def test_pictures_show_what_was_found(vehicle, axle):
    found = axle.solve(Position(y=3e-3, yaw=2e-3, speed=20.0), LOAD)
    figure = plot.wheels(vehicle, found)
    assert len([axes for axes in figure.axes if "wheel" in axes.get_title()]) == 2
    shape = petsam.wheel.geometry(axle, np.linspace(-5e-3, 5e-3, 21))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        panels = plot.over_y(shape, None, [2e-3, 4e-3]).axes
    drawn = panels[1].lines[0].get_ydata()
    assert drawn == pytest.approx(1e3 * shape.radius_difference)
    assert panels[2].lines[0].get_ydata() == pytest.approx(
        equivalent_conicity(shape.y, shape.radius_difference, [2e-3, 4e-3], 0.46)
    )
    assert isinstance(vehicle.wheel.profile, Profile)


@pytest.mark.parametrize("fault, text", [
    ("hole", "no points from y"), ("noise", "--smooth 4mm removes it"), ("inches", "check its unit of length"),
    ("spike", "lies 30 um beside a smooth curve through its neighbours"), ("dent", "lies 19.6 um beside"),
    ("two", "lies 60 um beside"),
])  # fmt: skip
def test_doubtful_points_are_named(tmp_path, capsys, fault, text):
    rail = petsam.wheel.uic60()
    y, z = rail.y.copy(), rail.z.copy()
    if fault == "hole":
        keep = np.r_[0:300, 500 : len(y)]
        y, z = y[keep], z[keep]
    if fault == "noise":
        z = z + 5e-6 * np.random.default_rng(3).normal(size=len(z))
    for name, places, height in (("spike", [600], -3e-5), ("dent", [450], 2e-5), ("two", [650, 730], -6e-5)):
        if fault == name:
            z[places] += height
    if fault == "inches":
        y, z = y / 25.4, z / 25.4
    path = tmp_path / "rail.txt"
    np.savetxt(path, np.column_stack([1e3 * y, 1e3 * z]), fmt="%.9f")
    given = [
        "--wheel",
        "s1002",
        "--rail",
        str(path),
        "--unit",
        "mm",
        "--z",
        "down",
        *ONE,
        "--y",
        "1mm",
        "--cell",
        "0.5mm",
    ]
    try:
        wheel.carry_out(wheel.arguments([*given, "--cores", "1"]))
    except Error as error:
        assert text in str(error)
    else:
        assert text in capsys.readouterr().err


def test_sound_points_raise_no_doubt():
    """Nor do they with few points, and rounded to 0.01 mm there is noise, but no false point."""
    for one in (petsam.wheel.s1002(), petsam.wheel.uic60()):
        assert not any(Profile(one.y[::k], one.z[::k], one.kind).doubts() for k in (1, 5, 10, 20))
        rough = Profile(one.y, np.round(one.z, 5), one.kind)
        noisy = Profile(one.y, one.z + 5e-6 * np.random.default_rng(1).normal(size=len(one.z)), one.kind)
        assert not any("beside a smooth curve" in text for found in (rough, noisy) for text in found.doubts())


@pytest.mark.parametrize("y, length, doubtful", [("0mm", "8mm", True), ("5mm", "4mm", True), ("3mm", "2mm", False)])
def test_smoothing_that_changes_the_pressure_is_named(capsys, y, length, doubtful):
    """Profiles without noise, whose pressure without smoothing is 683, 2143 and 1261 MPa."""
    given = [
        "--wheel",
        "s1002",
        "--rail",
        "uic60",
        "--cant",
        "1:40",
        *ONE,
        "--y",
        y,
        "--cell",
        "1mm",
        "--smooth",
        length,
    ]
    wheel.carry_out(wheel.arguments(given))
    assert (f"--smooth {length}: position 1: p_max is" in capsys.readouterr().err) == doubtful


@pytest.mark.parametrize("head, words, text", [
    ("y [mm],load [kN]", ["--speed", "20", "--load", "90kN"], "has the column load: omit --load"),
    ("y [mm],lateral [kN],load [kN],speed [m/s]", [], "columns y and lateral"),
])  # fmt: skip
def test_positions_are_given_once(tmp_path, head, words, text):
    (tmp_path / "positions.csv").write_text(head + "\n" + ",".join("1" * len(head.split(","))) + "\n")
    given = dict(zip(words[::2], words[1::2], strict=True))
    with pytest.raises(Error, match=text):
        petsam.wheel.read_positions(
            tmp_path / "positions.csv", 90e3 if "--load" in given else None, 20.0 if "--speed" in given else None
        )


def test_positions_without_an_equilibrium_end_with_the_error_of_a_contact():
    """petsam.NoEquilibrium, with the code of the commands, also from another process."""
    with pytest.raises(
        petsam.NoEquilibrium, match="no position has an equilibrium; of the first one: it falls"
    ) as caught:
        batches.Batch([None], [batches.Found(None, "it falls")]).table()
    sent = pickle.loads(pickle.dumps(caught.value))
    assert caught.value.code == sent.code == 11 and str(sent) == str(caught.value)
