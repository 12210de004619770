"""Frequency and damping of joints over amplitude: Mindlin's oscillators, and pairs of bodies."""

import csv
import functools
import gc
import importlib
import re
import subprocess
import sys
import types
import warnings

import h5py
import numpy as np
import pytest
from scipy import sparse
from scipy.interpolate import RegularGridInterpolator
from scipy.linalg import eigh
from scipy.optimize import brentq, fsolve
from scipy.sparse.linalg import eigsh
from scipy.spatial import cKDTree

import compliances
import petsam
from petsam import joint
from petsam.apps.compliance import basis, model, modes, rigid, stiffness
from petsam.apps.compliance.command import arguments, carry_out
from petsam.apps.joint import backbones
from support import ROOT

pytestmark = [
    pytest.mark.filterwarnings(f"ignore::petsam.{name}") for name in ("apps.joint.BackboneWarning", "AdviceWarning")
]

FRICTION, LOAD, RADIUS, YOUNG = 0.15, 700.0, 0.12, 200e9


def sphere(load, n=64, **more):
    """A contact of two equal spheres of Poisson's ratio 0, pressed, and its tangential stiffness by Mindlin (1949)."""
    radius = (3 * load * (RADIUS / 2) / (4 * (YOUNG / 2))) ** (1 / 3)
    bodies = {f"body{k}_{name}": value for k in (1, 2) for name, value in (("young", YOUNG), ("poisson", 0.0))}
    given = dict(bodies, grid_n=n, grid_size=2.2 * radius, friction=FRICTION, gap_type="sphere", gap_radius1=RADIUS)
    contact = petsam.Contact(**given, gap_radius2=RADIUS, **more)
    contact.try_step(load_n=load)
    contact.commit()
    return contact, 4 * radius * (YOUNG / 2) / 2


def shear(q, load, stiffness):
    """Mindlin's force at a displacement."""
    limit = FRICTION * load
    return limit * (1 - np.maximum(1 - q / (1.5 * limit / stiffness), 0) ** 1.5)


def lost(q, load, stiffness):
    """Energy of a cycle between +q and -q (Mindlin and Deresiewicz, 1953), also where all slips."""
    limit = FRICTION * load
    full = 1.5 * limit / stiffness
    e = np.minimum(q / full, 1)
    inside = full * limit * (e - 0.4 * (1 - (1 - e) ** 2.5))
    within = 8 * (inside - shear(e * full, load, stiffness) * e * full / 2)
    return within + 4 * limit * np.maximum(q - full, 0)


def closed(contacts, spring=0.0):
    """Force and energy of contacts (load, stiffness) and a spring in parallel, over the displacement, and the limit of
    the displacement at which the last one slides."""
    limit = max(1.5 * FRICTION * load / stiffness for load, stiffness in contacts)
    return (
        lambda q: sum(shear(q, *one) for one in contacts) + spring * q,
        lambda q: sum(lost(q, *one) for one in contacts),
        (1 - 1e-9) * limit,
    )


def differences(found, force, energy, most, mass):
    """Relative differences of frequency and damping from a force and an energy of the displacement q of the mass."""
    rows = []
    for k, alpha in enumerate(found.alpha * np.sqrt(mass)):
        q = brentq(lambda q, alpha=alpha: force(q) - alpha, 0.0, most, xtol=1e-20)
        omega2 = alpha / (q * mass)
        zeta = energy(q) / (2 * np.pi * mass * omega2 * q**2)
        rows.append((2 * np.pi * found.frequency[k] / np.sqrt(omega2) - 1, found.damping[k] / zeta - 1))
    return np.abs(rows).T


@pytest.mark.parametrize("by_load", [True, False])
@pytest.mark.parametrize("soft", [0.0, 1.0, 30.0])
def test_a_mass_on_one_contact_and_a_spring_in_series(soft, by_load):
    """The spring is `soft` times as compliant as the sticking contact; the contact is given loads or displacements."""
    contact, stiffness = sphere(LOAD)
    mass, spring = 3.0, soft / stiffness
    patch = joint.Patch(contact, ["disp_x"], dict(load_n=LOAD), by_load=["disp_x"] if by_load else ())
    one = joint.Structure([patch], coupling=[[spring]], rigid=[[1 / np.sqrt(mass)]])
    amplitudes = np.array([0.3, 0.6, 0.9]) * FRICTION * LOAD * (1 / stiffness + spring) * np.sqrt(mass)
    found = joint.backbone(one, amplitudes, steps=3)
    assert 2 * np.pi * found.linear == pytest.approx(np.sqrt(1 / (1 / stiffness + spring) / mass), rel=1e-3)

    def reach(force):  # of the contact
        return 1.5 * FRICTION * LOAD / stiffness * (1 - (1 - force / (FRICTION * LOAD)) ** (2 / 3))

    for k, alpha in enumerate(found.alpha * np.sqrt(mass)):
        q = reach(alpha) + alpha * spring
        omega2 = alpha / (q * mass)
        assert found.frequency[k] * 2 * np.pi == pytest.approx(np.sqrt(omega2), rel=5e-5)
        zeta = lost(reach(alpha), LOAD, stiffness) / (2 * np.pi * mass * omega2 * q**2)
        assert found.damping[k] == pytest.approx(zeta, rel=6e-3)
    assert found.energy == pytest.approx(found.patches[:, 0]) and np.all(found.cycles == 2)


def test_a_small_shear_beside_a_large_normal_load_is_in_equilibrium():
    """It does little of the work to which the tolerance was relative: the shear was wrong by 2e-4."""
    contact, stiffness = sphere(LOAD)
    spring, share = 0.1 / stiffness, 0.3
    patch = joint.Patch(contact, ["disp_z", "disp_x"], by_load=["disp_x"])
    one = joint.Structure([patch], [1.0, 1.0], np.eye(2), coupling=spring * np.eye(2))
    one.z, one.loads = patch.state()
    whole = 1.5 * FRICTION * LOAD / stiffness
    pull = whole * (1 - (1 - share) ** (2 / 3)) + spring * share * FRICTION * LOAD
    push = one.z[0] - spring * one.loads[0]
    for force in ([1.05 * push, 0.2 * pull], [push, pull]):
        one.step(force)
        assert one.z - force == pytest.approx(spring * one.loads, rel=5e-6, abs=0)
    assert one.loads == pytest.approx([-LOAD, -share * FRICTION * LOAD], rel=1e-4)


def test_a_normal_load_that_changes_by_rounding_is_constant():
    """As the loads of a structure do: the ratio of the changes of shear and normal load was infinite."""
    bodies = dict(body1_young=210e9, body1_poisson=0.1, body2_young=70e9, body2_poisson=0.4)
    grid = dict(grid_n=64, grid_size=2.0655848524420454e-3, gap_type="sphere", gap_radius1=0.1, gap_radius2=0.1)
    held = dict(disp_y=0.0, rot_x=0.0, rot_z=0.0)
    cycle = [0.5, 0.0, -0.5, -1.0, -0.5, 0.0, 0.5, 1.0]
    found = []
    for rounding in (0.0, 3e-13):
        with petsam.Contact(**bodies, **grid, friction=0.2) as contact:
            contact.try_step(load_n=800.0, disp_x=0.0, rot_y=0.0, **held)
            contact.commit()
            for part in [0.0, 0.25, 0.5, 0.75, 1.0, *cycle, *cycle]:
                loads = dict(load_n=800.0 - rounding * part, load_tx=48 * part, load_my=-0.0005585375507115025 * part)
                found.append(contact.try_step(**loads, **held).disp_x)
                contact.commit()
    assert found[:21] == pytest.approx(found[21:], rel=1e-5, abs=1e-12)


def test_damping_converges_with_the_grid():
    """Mindlin's oscillator: frequency within 1e-6 and damping within 1e-3 of the closed values on 128 cells."""
    errors = []
    for n in 64, 128:
        contact, stiffness = sphere(LOAD, n)
        patch = joint.Patch(contact, ["disp_x"], dict(load_n=LOAD), by_load=["disp_x"])
        one = joint.Structure([patch], rigid=[[1.0]])
        found = joint.backbone(one, np.array([0.3, 0.7]) * FRICTION * LOAD / stiffness, steps=2)
        errors.append(differences(found, *closed([(LOAD, stiffness)]), 1.0))
    assert errors[1][0].max() < 1e-5 and errors[1][1].max() < 1e-3 and errors[0][1].max() < 6e-3


@pytest.mark.parametrize("n", [40, 64])
def test_damping_has_the_error_of_its_cells(n):
    """Mindlin's oscillator, with companion runs: the error covers the true one, and falls with the cells."""
    contact, stiffness = sphere(LOAD, n, errors=True)
    patch = joint.Patch(contact, ["disp_x"], dict(load_n=LOAD), by_load=["disp_x"])
    one = joint.Structure([patch], rigid=[[1.0]])
    found = joint.backbone(one, np.array([0.5, 0.8]) * FRICTION * LOAD / stiffness)
    _, error = differences(found, *closed([(LOAD, stiffness)]), 1.0)
    told = found.damping_error / found.damping
    assert np.all(error < told) and np.all(told < 0.06 * (40 / n) ** 1.5)
    assert "zeta error" in "\n".join(found.lines()) and "damping_error" in [one.name for one in found.table()]


@pytest.mark.parametrize("n", [16, 24])
def test_a_contact_slides_as_a_whole_beside_one_that_sticks(n):
    """On a free body, with a soft joint between both: what slides has no stiffness of its own.
    Friction and equilibrium give the loads."""
    load, friction, rest, patches = 1000.0, 0.3, 70.0, []
    bodies = dict(body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3)
    shape = dict(gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", grid_size=2.6e-3)
    for _ in range(2):
        contact = petsam.Contact(grid_n=n, friction=friction, **bodies, **shape)
        contact.try_step(load_n=load)
        contact.commit()
        patches.append(joint.Patch(contact, ["disp_x"], dict(load_n=load, disp_y=0.0, rot_x=0.0, rot_y=0.0, rot_z=0.0)))
    moved = np.array([[0.9], [-0.1]])
    one = joint.Structure(patches, coupling=1e-7 * np.array([[2.3, -1.6], [-1.6, 1.3]]), rigid=moved)
    loads = np.array([-friction * load, rest])
    one.step(-moved.T @ loads)
    assert one.loads == pytest.approx(loads, rel=1e-6)


def test_a_force_that_presses_the_bodies_stays():
    """The mass is pressed by a modal force of its own, and not by its contact."""
    contact, stiffness = sphere(LOAD)
    patch = joint.Patch(contact, ["disp_x", "disp_z"], by_load=["disp_x", "disp_z"])
    one = joint.Structure([patch], rigid=np.eye(2))
    one.step([0.0, LOAD])
    found = joint.backbone(one, [0.6 * FRICTION * LOAD / stiffness], steps=2)
    error = differences(found, *closed([(LOAD, stiffness)]), 1.0)
    assert error[0].max() < 5e-5 and error[1].max() < 6e-3
    assert one.copy().force == pytest.approx([0.0, LOAD])


def test_two_contacts_in_parallel_until_one_slides():
    (first, k1), (second, k2) = sphere(LOAD), sphere(LOAD / 2)
    pairs = ((first, LOAD, "a"), (second, LOAD / 2, "b"))
    patches = [joint.Patch(c, ["disp_x"], dict(load_n=n), name=name) for c, n, name in pairs]
    mass = 0.7
    one = joint.Structure(patches, rigid=2 * [[1 / np.sqrt(mass)]])
    alphas = (
        np.array([0.6, 1.38, 1.45]) * FRICTION * LOAD
    )  # in the second the weaker contact nearly slides, then slides
    found = joint.backbone(one, alphas / (k1 + k2) * np.sqrt(mass), steps=3)
    assert found.names == ["a", "b"]
    error = differences(found, *closed([(LOAD, k1), (LOAD / 2, k2)]), mass)
    assert error[0].max() < 5e-5 and error[1].max() < 6e-3
    assert found.patches.sum(axis=1) == pytest.approx(found.energy) and np.all(found.patches > 0)


@pytest.mark.parametrize("ratio", [0.5, 8.0])
def test_an_elastic_mode_beside_the_contact(ratio):
    """A mass that a spring and the contact hold: the mode without contact is that of the spring."""
    contact, stiffness = sphere(LOAD)
    mass, spring = 2.0, ratio * stiffness
    patch = joint.Patch(contact, ["disp_x"], dict(load_n=LOAD), by_load=["disp_x"] if ratio < 1 else ())
    one = joint.Structure([patch], [np.sqrt(spring / mass)], [[1 / np.sqrt(mass)]], coupling=[[1 / spring]])
    amplitudes = np.array([0.4, 0.9]) * FRICTION * LOAD / stiffness * np.sqrt(mass)
    found = joint.backbone(one, amplitudes, steps=3)
    error = differences(found, *closed([(LOAD, stiffness)], spring), mass)
    assert error[0].max() < 5e-5 and error[1].max() < 6e-3


def test_the_response_of_loads_is_that_of_coordinates():
    """With a random tangent: coordinates and loads that belong together, whichever of them is prescribed."""
    rng = np.random.default_rng(3)
    contact = sphere(LOAD, 16)[0]
    names = ["disp_x", "disp_y", "rot_z"]
    patch = joint.Patch(contact, names, dict(load_n=LOAD), by_load=names[:2])
    tangent = -np.eye(3) + 0.2 * rng.normal(size=(3, 3))
    response = joint.Structure([patch]).response_of(tangent)
    z = rng.normal(size=3)
    loads = tangent @ z
    given, found = np.array([*loads[:2], z[2]]), np.array([*z[:2], loads[2]])
    assert response @ given == pytest.approx(found)


# ---------------------------------------------------------------- pairs of bodies


def test_motions_of_a_pair_are_those_of_the_contact(tmp_path):
    """A load case that is a rigid motion moves the contact as the displacement does."""
    motions = rigid.motions(basis.Patch((0.0, 0.0), (1.0, 1.0), 1))
    cases = {f"c{k}": motions[k] for k in range(6)}
    file = compliances.write(tmp_path / "c.h5", np.zeros((3, 3, 3, 3)), cases=cases)
    bodies = dict(body1_young=1, body2_young=1, body1_poisson=0.3, body2_poisson=0.3)
    given = dict(OPTIONS, **bodies, grid_size=2.0, body2_compliance=file)
    amounts = dict(zip(joint.patch.DISPLACEMENTS, (0.01, 1e-3, -5e-4, 2e-3, 1e-3, 1e-3)))
    with petsam.Contact(**given) as contact:
        plain = contact.try_step(**amounts).load
        cased = contact.try_step(
            **dict.fromkeys(amounts, 0.0), **{f"body2_case_c{k}": -amount for k, amount in enumerate(amounts.values())}
        ).load
        assert cased == pytest.approx(plain, rel=1e-6, abs=1e-9 * plain[0])
        works = [contact.number(f"body2_case_c{k}_load") for k in range(6)]
        assert works == pytest.approx(cased, rel=1e-6, abs=1e-9 * plain[0])


def pair_file(path, soft):
    """A pair of layers' compliance with a rigid part `soft` times a half-space's, two modes and a bolt; E = 1."""
    matrix = 0.3 * compliances.layer(0.5, 3)
    m = len(matrix)
    patch = basis.Patch((0.0, 0.0), (1.0, 1.0), 3)
    motions = rigid.motions(patch)
    part = np.diag([0.5, 0.4, 0.6, 1.0, 2.0, 1.5]) * soft
    part[0, 4] = part[4, 0] = 0.3 * soft
    matrix = matrix + np.einsum("cik,cd,djl->ikjl", motions, part, motions)
    shape = np.random.default_rng(5).normal(size=(2, m, 3)) * 0.05
    shape[:, 0, 0] += 1.0  # the modes shear the contact
    bolt = np.zeros((m, 3))
    bolt[0, 2] = -2.0 * (1 + soft)  # closes
    bolt[3, 2] = 1.0
    cases = dict(mode1=shape[0], mode2=shape[1], bolt_B=bolt)
    compliances.write(path, matrix, cases=cases)
    with h5py.File(path, "a") as file:
        file.attrs.update(young1=1.0, poisson1=0.3)
        file["rigid/compliance"], file["rigid/motions"] = part, motions
        file["modes/omega"] = np.array([0.5, 2.0])
        file["modes/sensors"] = np.array([[[0.0, 0.0, 1.0]], [[0.0, 0.0, -0.5]]])
        file["modes/sensors"].attrs["names"] = ["TIP"]
        file["bolts/B/stiffness"] = 0.2
        file["bolts/closing"] = np.array([[0.4]])
        file["bolts/closing"].attrs["names"] = ["B"]
    return path


@pytest.mark.slow
@pytest.mark.parametrize(
    "support, patch, left_out, count",
    [("--fixed CLAMP", "--patch 36mm --degree 6,6", 0, 3), ("--free", "--patch 44mm,38mm --degree 10,8", 6, 2)],
)
def test_stuck_modes_of_the_lap_are_those_of_tied_elements(tmp_path, monkeypatch, support, patch, left_out, count):
    """The same finite elements, with nodes of both bodies made one where the surfaces touch: no polynomials, no
    half-space, no modes without contact. Of free ones six are rigid, and the third elastic one needs a finer mesh."""
    monkeypatch.chdir(tmp_path)
    subprocess.run([sys.executable, ROOT / "examples/lap/mesh.py", "lap", "lap.inp", "--coarse"], check=True)
    words = f"--mesh lap.inp --units mm --contact CONTACT2 --pair CONTACT1 {support} {patch} "
    words += "--no-picture --bolt B=WASHER1,WASHER2:8mm --modes 12"
    options = arguments(words.split())
    carry_out(options, [])
    pair = joint.Pair("lap.h5", dict(B=15e3), grid_n=64, friction=0.3)
    contact = pair.structure.patches[0].contact
    body = model.Model(options.mesh, options.settings)
    body.prepare_modes()
    nodes = body.mesh.nodes
    one, two = (
        np.unique(np.concatenate([g.nodes.ravel() for g in body.mesh.surface_faces(f"CONTACT{k}")])) for k in (1, 2)
    )
    touch = RegularGridInterpolator(
        (contact.y, contact.x), (contact["pressure"] > 0) * 1.0, bounds_error=False, fill_value=0
    )
    distance, nearest = cKDTree(nodes[two]).query(nodes[one])
    same = np.arange(3 * len(nodes))
    for a, b in zip(one[distance < 1e-7], two[nearest[distance < 1e-7]]):
        if touch(nodes[b, [1, 0]])[0] > 0.5:
            same[3 * a : 3 * a + 3] = 3 * b + np.arange(3)
    fixed = (3 * body.supported[:, None] + np.arange(3)).ravel()
    kept = np.setdiff1d(np.unique(same), fixed)
    column = np.full(len(same), -1)
    column[kept] = np.arange(len(kept))
    rows = np.flatnonzero(column[same] >= 0)
    tie = sparse.csr_matrix((np.ones(len(rows)), (rows, column[same[rows]])), shape=(len(same), len(kept)))
    whole = stiffness.stiffness(body.mesh, "own") + sum(bolt.matrix for bolt in body.bolts)
    k, m = ((tie.T @ matrix @ tie).tocsc() for matrix in (whole, modes.mass(body.mesh)))
    squares = np.sort(eigsh(k, count + left_out, m, sigma=-1e4, return_eigenvectors=False))
    found = pair.structure.stuck_modes()[0][:count]
    assert np.all(np.abs(squares[:left_out]) < 1e-4 * squares[left_out])
    assert found == pytest.approx(np.sqrt(squares[left_out:]), rel=1e-2)
    assert found[0] > 1.5 * pair.omega[0]


OPTIONS = dict(grid_n=24, friction=0.3, gap_type="sphere", gap_radius1=8.0, gap_radius2="inf")
PRELOAD = dict(B=0.02)


def test_a_rigid_part_outside_of_the_contact_changes_nothing(tmp_path):
    """Against the contact that has all compliance itself, whose steps need no iteration."""
    file = pair_file(tmp_path / "pair.h5", 1.0)
    pair = joint.Pair(file, PRELOAD, damping=1e-3, **OPTIONS)
    shapes = ["body2_case_mode1", "body2_case_mode2"]
    whole = petsam.Contact(body2_compliance=file, grid_size=2.0, **pair.moduli | OPTIONS)
    held = dict.fromkeys(joint.patch.DISPLACEMENTS, 0.0)
    patch = joint.Patch(whole, shapes, held)
    plain = joint.Structure([patch], pair.omega, np.eye(2), damping=1e-3)
    assert plain.direct and not pair.structure.direct
    for part in np.linspace(0, PRELOAD["B"], 5)[1:]:
        patch.held["body2_case_bolt_B"] = part
        plain.step(np.zeros(2))
    mine = pair.structure.patches[0].contact
    assert mine["pressure"] == pytest.approx(whole["pressure"], abs=1e-5 * whole["pressure"].max())
    left = 0.02 - 0.2 * (0.4 * 0.02 + whole.number("body2_case_bolt_B_load"))
    assert pair.tensions["B"] == pytest.approx(left, rel=1e-6)
    sensor = pair.sensors["TIP"][:, 2]
    one, other = (joint.backbone(s, [3e-3, 1e-2], sensor=sensor, steps=3) for s in (pair.structure, plain))
    assert one.linear == pytest.approx(other.linear, rel=1e-6) and np.all(one.energy > 0)
    assert one.slipping[-1] == np.sum(one.states[0] == 2) and np.array_equal(one.pressure[0], mine["pressure"])
    assert np.ptp(one.frequency) > 1e-3 * one.linear
    for name, error in (("frequency", 1e-5), ("amplitude", 1e-5), ("energy", 2e-4)):  # kept steps of one, not the other
        assert one.numbers[name] == pytest.approx(other.numbers[name], rel=error), name
    assert max(plain.iterations) == 1 and one.viscous.tolist() == [1e-3, 1e-3]


def test_bolts_are_tightened_though_displacements_are_tried_first(tmp_path, monkeypatch):
    """Where loads need more iterations than those after which displacements along the surface are tried."""
    file = pair_file(tmp_path / "pair.h5", 1.0)
    plain = joint.Pair(file, PRELOAD, **OPTIONS | dict(grid_n=16))
    assert max(plain.structure.iterations) > 4
    monkeypatch.setattr(joint.structure, "FEWER", 2)
    monkeypatch.setattr(joint.structure.Structure, "_slides", lambda *_: False)
    found = joint.Pair(file, PRELOAD, **OPTIONS | dict(grid_n=16))
    assert found.tensions["B"] == pytest.approx(plain.tensions["B"], rel=1e-6)


def test_cells_of_a_patch_have_their_place_in_the_frame_of_the_mesh(tmp_path):
    file = pair_file(tmp_path / "pair.h5", 1.0)
    with h5py.File(file, "a") as data:
        data["patch/center"][...] = (-3.0, 0.25)
    found = joint.backbone(joint.Pair(file, PRELOAD, **OPTIONS | dict(grid_n=8)).structure.copy(), [1e-9], steps=2)
    x, y = found.axes[0]
    assert (x.mean(), y.mean()) == pytest.approx((-3.0, 0.25))
    assert x[-1] - x[0] == pytest.approx(7 / 4)


def test_a_copy_of_a_structure_outlives_its_pair(tmp_path):
    pair = joint.Pair(pair_file(tmp_path / "pair.h5", 1.0), PRELOAD, **OPTIONS | dict(grid_n=8))
    copy = pair.structure.copy()
    del pair
    gc.collect()
    assert copy.copy().tangent() == pytest.approx(copy.tangent(), rel=1e-6)


def test_a_body_that_only_a_soft_bolt_holds(tmp_path):
    """A rigid part of 200 times the contact's: equilibrium of loads and of the bolt's energy."""
    file = pair_file(tmp_path / "pair.h5", 200.0)
    pair = joint.Pair(file, PRELOAD, **OPTIONS)
    found = joint.backbone(pair.structure, [1e-3, 3e-3], steps=4)
    assert np.all(found.energy > 0) and found.loop == pytest.approx(found.energy, rel=0.3)
    structure = pair.structure
    moved = structure.z - structure.coupling @ structure.loads
    assert np.abs(moved[:6] * structure.loads[:6]).max() < 1e-6 * np.abs(structure.z @ structure.loads)


def test_a_band_has_its_assemblies_and_their_scatter(tmp_path):
    """Against backbones one by one; without friction nothing is left of the shear."""
    file = pair_file(tmp_path / "pair.h5", 1.0)
    pairs, small = [], OPTIONS | dict(grid_n=16)

    def make(preload, **changes):
        pairs.append(joint.Pair(file, preload, **small, **changes))
        return pairs[-1]

    tip = lambda pair: pair.sensors["TIP"][:, 2]  # noqa: E731
    given = dict(steps=3)
    found = joint.band(make, PRELOAD, [1e-2], tip, dict(friction=0.2, preload=0.1), **given)
    assert list(found.backbones) == ["as given", "without friction", "after the largest"] and len(pairs) == 7
    plain, bare = pairs[0].structure.patches[0].contact, pairs[1].structure.patches[0].contact
    assert np.abs(bare["shear_x"]).max() < 1e-9 * np.abs(plain["shear_x"]).max()
    rows = [joint.backbone(pairs[k].structure, [1e-2], sensor=tip(pairs[k]), **given) for k in (0, 1)]
    for one, other in zip(rows, found.backbones.values()):
        assert one.damping == pytest.approx(other.damping, rel=1e-5)
    assert np.all(np.ptp([one.damping for one in found.backbones.values()], axis=0) > 0)
    for name in ("frequency", "damping"):
        low, high = found.limits(name)
        assert np.all((low <= found.given.numbers[name]) & (found.given.numbers[name] <= high))
    slippery = joint.Pair(file, PRELOAD, **{**small, "friction": 0.8 * small["friction"]})
    other = joint.backbone(slippery.structure, [1e-2], sensor=tip(slippery), **given)
    assert found.scatter["friction"][0].damping == pytest.approx(other.damping, rel=1e-4)
    half = 0.5 * np.subtract(*(one.damping for one in found.scatter["friction"]))
    assert found.deviation("damping", "friction") == pytest.approx(np.abs(half))
    both = np.hypot(*(found.deviation("damping", name) for name in found.scatter))
    assert found.deviation("damping") == pytest.approx(both)
    with pytest.raises(petsam.Error, match="scatter young: expected friction or preload"):
        joint.band(make, PRELOAD, [3e-3], tip, dict(young=0.1), **given)


def test_a_band_ends_where_its_assemblies_do(monkeypatch):
    """Of three amplitudes two have a solution as given, one without friction; vibrated is at the larger of the two."""
    module, shaken, ends = importlib.import_module("petsam.apps.joint.bands"), [], iter((2, 1, 2))
    numbers = {name: np.ones(3) for name in ("amplitude", "frequency", "damping")}

    def backbone(structure, amplitudes, sensor):
        count = next(ends, None)
        if count is None:
            raise joint.NoSolution("gross slip: load_tx; for gross slip give disp_x")
        return types.SimpleNamespace(alpha=amplitudes[:count], numbers=numbers, amplitude=numbers["amplitude"])

    monkeypatch.setattr(module, "backbone", backbone)
    monkeypatch.setattr(module, "shake", lambda structure, amplitude, *_: shaken.append(amplitude))
    given = lambda *_, **changes: types.SimpleNamespace(structure=None)  # noqa: E731
    with pytest.warns(joint.BackboneWarning, match="only 1 of 2 amplitudes: .* the assembly without friction"):
        found = joint.band(given, PRELOAD, [1.0, 2.0, 3.0], lambda _: None)
    assert found.count == 1 and shaken == [2.0]
    with pytest.raises(joint.NoSolution, match="^assembly as given: gross slip: load_tx$"):
        joint.band(given, PRELOAD, [1.0], lambda _: None)


def test_a_shaken_contact_comes_to_rest_with_other_tractions():
    contact, stiffness = sphere(LOAD, 48)
    patch = joint.Patch(contact, ["disp_x"], dict(load_n=LOAD), by_load=["disp_x"])
    one = joint.Structure([patch], rigid=[[1.0]])
    joint.shake(one, 0.7 * FRICTION * LOAD / stiffness)
    shear = one.patches[0].contact["shear_x"]
    assert abs(one.loads[0]) < 1e-9 * LOAD and np.abs(shear).max() > 0.01 * contact["pressure"].max()
    # the cycles that ended smaller ones leave a shear whose changes of sign are those of the amplitudes
    middle = shear[24, 24:]
    assert np.sum(np.diff(np.sign(middle[np.abs(middle) > 1e-6 * np.abs(shear).max()])) != 0) >= 3


def test_wear_of_one_contact_is_that_of_the_contact_alone():
    """Its loads do not change, so that the structure adds nothing."""
    contact, stiffness = sphere(LOAD, 32, wear_coefficient1=1e-15)
    patch = joint.Patch(contact, ["disp_x"], dict(load_n=LOAD), by_load=["disp_x"])
    one = joint.Structure([patch], rigid=[[1.0]])
    amplitude = 0.6 * FRICTION * LOAD / stiffness
    found = joint.wear(one, amplitude, [1e3, 1e4], steps=4)
    other = contact.copy()
    parts = np.concatenate([[1.0], np.arange(0.5, -1.1, -0.5), np.arange(-0.5, 1.1, 0.5)])
    shear = -(joint.sweep.Sweep(one).omega ** 2) * amplitude * parts
    rise = np.linspace(0.0, shear[0], 5)[1:]
    steps = np.concatenate([rise, shear[1:], shear[1:]])
    other.run(dict(time=np.arange(1.0, steps.size + 1), load_n=np.full(steps.size, LOAD), load_tx=steps))
    cycle = dict(time=20.0 + np.arange(shear.size), load_n=np.full(shear.size, LOAD), load_tx=shear)
    worn = other.live(1e4, cycle)[-1]
    assert found.volume[2] == pytest.approx(worn.volume1, rel=0.03, abs=0) and found.volume[1] < 0.2 * found.volume[2]
    again = joint.backbone(found.structures[2], [amplitude], steps=4)
    assert found.frequency[0] > found.frequency[2] == pytest.approx(again.frequency[0], rel=2e-3)
    assert np.all(found.frequency_error <= 0.2 * np.ptp(found.frequency))


def test_contacts_that_do_not_wear_are_named():
    contact, _ = sphere(LOAD, 16)
    patch = joint.Patch(contact, ["disp_x"], dict(load_n=LOAD), by_load=["disp_x"])
    with pytest.raises(petsam.Error, match="no contact wears: give -wear_coefficient1"):
        joint.wear(joint.Structure([patch], rigid=[[1.0]]), 1e-7, [10])


def test_wear_unloads_the_bolt(tmp_path):
    """Wear of the contact lets the washers move, so that tension falls; the number of parts changes little of that."""
    pair = joint.Pair(
        pair_file(tmp_path / "pair.h5", 1.0), PRELOAD, **OPTIONS | dict(grid_n=16), wear_coefficient1=1e-3
    )
    sensor = pair.sensors["TIP"][:, 2]
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        found = joint.wear(pair.structure, 1e-2, [1e4, 4e4], sensor=sensor, measure=pair.left, steps=3)
    assert all(str(one.message).strip() for one in said)  # a step without advice is no warning
    assert np.all(np.diff(found.measured["B"]) < 0) and found.measured["B"][0] == pair.tensions["B"]
    assert np.all(np.diff(found.frequency) < 0)
    assert np.all(found.frequency_error < 0.1 * (found.frequency[0] - found.frequency[2]))
    structure = found.structures[2]
    moved = structure.z - structure.coupling @ structure.loads
    assert np.abs(moved[:6] * structure.loads[:6]).max() < 1e-5 * np.abs(structure.z @ structure.loads)
    for cycles in ([1e4, 1e3], [0.5, 1e3]):
        with pytest.raises(petsam.Error, match="cycles: expected rising whole numbers above 0"):
            joint.wear(pair.structure, 1e-2, cycles, sensor=sensor)


@pytest.mark.parametrize("part", [0.5, 1.5])
def test_worn_volume_is_that_of_archard_also_where_the_contact_slides(part):
    """A contact and a spring; both bodies wear, over numbers of cycles that two parts do not divide."""
    contact, k = sphere(LOAD, 24, wear_coefficient1=1e-15, wear_coefficient2=3e-15)
    patch = joint.Patch(contact, ["disp_x"], dict(load_n=LOAD), by_load=["disp_x"])
    one = joint.Structure([patch], [np.sqrt(k)], [[1.0]], coupling=[[1.0 / k]])
    found = joint.wear(one, part * 1.5 * FRICTION * LOAD / k, [1, 6], steps=2)
    volume = 4e-15 * found.energy[0] / FRICTION * found.cycles
    assert found.volume == pytest.approx(volume, rel=2e-3, abs=0)


def test_small_amplitudes_at_which_all_sticks_have_no_damping(tmp_path):
    """Cells that tightening the bolt left at their limit come to it in each cycle: the rounding of their slip was a
    damping."""
    pair = joint.Pair(pair_file(tmp_path / "pair.h5", 1.0), PRELOAD, **OPTIONS | dict(grid_n=16))
    amplitudes = np.array([1e-3, 1e-4, 1e-5]) * 3e-3
    found = joint.backbone(pair.structure, amplitudes, steps=3)
    assert found.frequency == pytest.approx(found.linear, rel=1e-6)
    assert np.all(found.damping < 1e-6) and np.all(found.cycles[:2] < 4)  # then cycles differ by rounding
    for row, line in enumerate(found.lines()[-3:]):
        assert found.unresolved[row] == found.damping[row] == 0.0 or f"<{found.unresolved[row]:.1e}" in line


@pytest.mark.parametrize("by_load", [True, False])
def test_small_amplitudes_of_two_contacts_find_equilibrium(by_load):
    """Two masses, each on a contact: errors of the contacts, relative to their preload, were above the limit."""
    (first, k), (second, _) = sphere(LOAD, 32), sphere(LOAD / 2, 32)
    patches = [
        joint.Patch(contact, ["disp_x"], dict(load_n=load), by_load=["disp_x"] if by_load else ())
        for contact, load in ((first, LOAD), (second, LOAD / 2))
    ]
    squares, shapes = eigh(SPRINGS * k, MASSES)
    one = joint.Structure(patches, np.sqrt(squares), shapes, np.linalg.inv(SPRINGS * k))
    found = joint.backbone(one, np.array([1e-3, 1e-5, 1e-6]) * FRICTION * LOAD / k, steps=2)
    assert found.frequency == pytest.approx(found.linear, rel=1e-6) and np.all(found.damping < 1e-6)
    force = 1e-6 * FRICTION * LOAD * shapes[1]  # beside and near the resonance of sticking contacts
    frequencies, (omegas, modes) = np.array([0.9, 0.999, 1.1]) * found.linear, one.stuck_modes()
    moved = joint.forced(one, force, frequencies, shapes[1], steps=6).amplitude
    parts = (shapes[1] @ modes) * (force @ modes)
    motion = np.sum(parts / (omegas**2 - (2 * np.pi * frequencies[:, None]) ** 2), axis=1)
    assert moved == pytest.approx(np.abs(motion), rel=1e-4)


def masing(x):
    """Mindlin's force over a period of displacements with one maximum and one minimum, both over a full slide."""
    first = np.argmax(x)
    x = np.roll(x, -first)
    last = np.argmin(x)
    force = lambda q: 1 - np.maximum(1 - q / 1.5, 0) ** 1.5  # noqa: E731
    found = np.empty_like(x)
    found[: last + 1] = force(x[0]) - 2 * force((x[0] - x[: last + 1]) / 2)
    found[last:] = found[last] + 2 * force((x[last:] - x[last]) / 2)
    return np.roll(found, first)


ORDERS = np.arange(1, 16, 2)
WAVES = np.exp(1j * ORDERS[:, None] * 2 * np.pi * np.arange(2048) / 2048)


def balanced(error, start):
    """Values for which harmonic balance has no error."""
    values, _, done, said = fsolve(error, start, xtol=1e-11, full_output=True)
    assert done == 1, said
    return values


def resisting(x):
    """Harmonics of Masing's force by those of the displacement."""
    return 2 * np.conj(WAVES) @ masing(np.real(x @ WAVES)) / WAVES.shape[1]


def harmonic(stiffness, mass, damp, force, omega, guess):
    """First and higher odd harmonics (orders, masses) of masses, the first of which is on a contact of stiffness and
    limit 1, by harmonic balance of the displacements."""
    matrices = [stiffness - (h * omega) ** 2 * mass + 1j * h * omega * damp for h in ORDERS]

    def paired(x):
        return np.column_stack([x.real.ravel(), x.imag.ravel()]).ravel()

    def error(values):
        x = (values[::2] + 1j * values[1::2]).reshape(len(ORDERS), -1)
        wrong = np.array([matrix @ one for matrix, one in zip(matrices, x)])
        wrong[:, 0] += resisting(x[:, 0])
        wrong[0] -= force
        return paired(wrong)

    start = np.zeros((len(ORDERS), len(mass)), dtype=complex)
    start[0] = guess
    values = balanced(error, paired(start))
    return (values[::2] + 1j * values[1::2]).reshape(len(ORDERS), -1)


def resonance(amplitude):
    """Squared frequency and damping of a unit mass on a contact of stiffness and limit 1 at an amplitude."""

    def error(values):
        x = np.concatenate([[amplitude], values[2::2] + 1j * values[3::2]])
        wrong = resisting(x) - ORDERS**2 * values[0] * x
        wrong[0] -= 1j * values[1]
        return np.concatenate([wrong.real, wrong.imag])

    values = balanced(error, [0.9, 0.01] + 14 * [0.0])
    return values[0], values[1] / (2 * values[0] * amplitude)


# two masses with springs to the ground and between them; of contacts with stiffness and limit 1
MASSES, SPRINGS, DAMPING = np.diag([1.0, 0.6]), np.array([[3.5, -3.0], [-3.0, 3.9]]), 4e-3


def test_resonance_of_a_mass_by_harmonic_balance():
    """Beside the balance of the displacements, whose frequency is up to 1e-3 above the quasi-static one."""
    contact, k = sphere(LOAD, 64)
    patch = joint.Patch(contact, ["disp_x"], dict(load_n=LOAD), by_load=["disp_x"])
    mass, unit = 2.5, FRICTION * LOAD / k
    one = joint.Structure([patch], rigid=[[1 / np.sqrt(mass)]])
    amplitudes = 1.5 * np.array([0.2, 0.5, 0.8])
    found = joint.backbone(one, amplitudes * unit * np.sqrt(mass), harmonics=7, steps=14)
    static = joint.backbone(one, found.alpha / found.linear**2 / (2 * np.pi) ** 2)
    assert np.all(found.frequency[1:] > (1 + 1e-4) * static.frequency[1:])
    for row, amplitude in enumerate(amplitudes):
        square, zeta = resonance(amplitude)
        assert 2 * np.pi * found.frequency[row] == pytest.approx(np.sqrt(square * k / mass), rel=1e-4)
        assert found.damping[row] == pytest.approx(zeta, rel=8e-3)


def two_masses():
    """The structure, its coordinates as lengths of Mindlin's and frequencies of the contact's, and its viscous matrix;
    and Mindlin's stiffness and full slide."""
    contact, k = sphere(LOAD, 48)
    unit = FRICTION * LOAD / k
    squares, shapes = eigh(SPRINGS * k, MASSES)
    patch = joint.Patch(contact, ["disp_x"], dict(load_n=LOAD))
    coupling = np.linalg.inv(SPRINGS * k)[:1, :1]
    one = joint.Structure([patch], np.sqrt(squares), shapes[:1], coupling, damping=DAMPING)
    stuck, psi = eigh(SPRINGS + np.diag([1.0, 0.0]), MASSES)
    damp = MASSES @ psi @ np.diag(2 * DAMPING * np.sqrt(stuck)) @ psi.T @ MASSES
    return one, shapes, damp, k, unit


def test_response_of_two_masses_to_a_force():
    """Through the resonance; three times the first frequency is near the second mode."""
    one, shapes, damp, k, unit = two_masses()
    place = shapes[1]  # of the second mass
    omegas, level = np.array([1.02, 1.14, 1.18, 1.2]), 0.06
    force = level * FRICTION * LOAD * place
    found = joint.forced(one, force, omegas * np.sqrt(k) / (2 * np.pi), place, steps=12, harmonics=3)
    guess = np.zeros(2)
    for row, omega in enumerate(omegas):
        guess = harmonic(SPRINGS, MASSES, damp, np.array([0, level]), omega, guess if row else [0.1, 0.1])[0]
        assert found.amplitude[row] == pytest.approx(abs(guess[1]) * unit, rel=2e-3), omega
        assert found.phase[row] == pytest.approx(np.angle(guess[1]), abs=3e-3), omega


@pytest.fixture
def command(joint_command):
    """command(*words, check=0): what petsam-joint backbone prints; its complaint where it fails."""
    return functools.partial(joint_command, "backbone")


def test_command_prints_and_writes_the_numbers(command, tmp_path):
    pair_file(tmp_path / "pair.h5", 1.0)
    lines = [f"-{name} {value}" for name, value in OPTIONS.items()]
    (tmp_path / "c.opts").write_text("\n".join(lines) + "\n")
    words = ("pair.h5", "--contact", "c.opts", "--preload", "B=0.02", "--sensor", "TIP:z", "--steps", 3)
    printed = command(*words, "--amplitudes", "3mm:10mm:2", "-o", "out", "--damping", "0.001", "--degree-check")
    pair = joint.Pair(tmp_path / "pair.h5", PRELOAD, **OPTIONS)
    expected = joint.backbone(pair.structure, [3e-3, 1e-2], sensor=pair.sensors["TIP"][:, 2], steps=3)
    assert "\n".join(expected.lines()) in printed
    assert expected.lines()[0].startswith("no error of the grid is known for these numbers")
    assert set(expected.table()[-1].values) == {expected.lines()[0]}
    assert f"bolt B: {pair.tensions['B']:.6g} N left of 0.02 N" in printed
    assert "degree lower by 2: frequency" in printed
    with open("out.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["frequency [Hz]"]) for row in rows] == pytest.approx(expected.frequency)
    assert (tmp_path / "out.png").stat().st_size > 10000 < (tmp_path / "out-contact.png").stat().st_size


def test_command_prints_the_response_to_a_force(command, joint_command, tmp_path):
    """The power of the force is that of friction and of the material's damping."""
    pair_file(tmp_path / "pair.h5", 1.0)
    small = OPTIONS | dict(grid_n=16)
    (tmp_path / "c.opts").write_text("".join(f"-{name} {value}\n" for name, value in small.items()))
    pair = joint.Pair(tmp_path / "pair.h5", PRELOAD, damping=0.01, **small)
    sensor = pair.sensors["TIP"][:, 2]
    point = joint.backbone(pair.structure, [5e-3], sensor=sensor, steps=3)
    level = 1e-4
    words = ("pair.h5", "--contact", "c.opts", "--preload", "B=0.02", "--force", f"TIP:z={level}", "--damping", 0.01)
    around = np.array([0.9, 1.0]) * point.frequency[0]
    given = ",".join(f"{one:.12g}" for one in around)
    highest = pair.structure.stuck_modes()[0].max() / (2 * np.pi)
    printed = joint_command("response", *words, "--frequencies", given, "--steps", 8, "-o", "out")
    told = joint_command("response", *words, "--frequencies", f"{10 * highest:g}", check=2)
    assert "give Hz, not rad/s or rpm" in told and f"{highest:.4g} Hz" in told
    found = joint.forced(pair.structure, level * sensor, around, sensor, steps=8)
    assert found.lines()[0] in printed and len(re.findall(r"^ +0\.[01]\d+ ", printed, re.M)) == 2
    stuck, psi = pair.structure.stuck_modes()
    viscous = np.zeros(2)
    for order in range(1, 4):
        moved = np.abs(found.motion[:, order - 1] @ psi) ** 2
        viscous += np.pi * 2 * np.pi * around * order**2 * (moved @ (2 * 0.01 * stuck))
    power = -np.pi * level * found.amplitude * np.sin(found.phase)
    assert power == pytest.approx(found.energy + viscous, rel=2e-3)
    with open("out.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["amplitude [m]"]) for row in rows] == pytest.approx(found.amplitude, rel=1e-4)
    assert (tmp_path / "out.png").stat().st_size > 10000


@pytest.mark.parametrize(
    "words, says, code",
    [
        (("--preload", "C=1"), "preload C: is no bolt of pair.h5; there are B", 2),
        ((), "preload: give the tension of B, in N", 2),
        (("--preload", "B=-1"), "B=-1: expected BOLT=FORCE, such as B1=12kN", 2),
        (("--preload", "B=0.02", "--mode", "9"), "mode 9: the structure has modes 1 to 2", 2),
        (("--preload", "B=0.02", "--sensor", "TOP:z"), "--sensor TOP:z: expected NAME:x, :y or :z with a sensor", 2),
        (("--preload", "B=0.02", "--pressure", "1MPa"), "--pressure is for petsam-joint stiffness: remove it", 2),
        (("--preload", "B=0.02", "--steps", "0"), "--steps: 0: expected a whole number, 1 or more", 2),
        (("--preload", "B=0.02", "--contact", "none.opts"), "none.opts", 3),
        (("--preload", "B=0.02", "--preload", "B=0.01"), "--preload: a bolt is given twice", 2),
        (("--preload", "B=0.02", "--amplitudes", "1mm:2mm,3mm:3"), "1mm:2mm,3mm:3: expected FIRST:LAST:COUNT", 2),
        (("--preload", "B=0"), "the bodies do not touch, load_n = 0 N, limit above 0: use a higher preload", 2),
        (("--preload", "B=0.02", "--damping", "nan"), "damping: nan: expected a part of critical damping", 2),
    ],
)
def test_a_mistake_is_named(words, says, code, command, tmp_path):
    pair_file(tmp_path / "pair.h5", 1.0)
    (tmp_path / "c.opts").write_text("".join(f"-{name} {value}\n" for name, value in OPTIONS.items()))
    words = words if "--sensor" in words else ("--sensor", "TIP:z", *words)
    said = command("pair.h5", "--contact", "c.opts", "--amplitudes", "1mm", *words, check=code)
    assert says in said and len(said.splitlines()) == 1


def test_the_pair_in_the_options_file_is_not_counted_twice(command, tmp_path):
    """As the options that petsam-compliance prints have it."""
    pair_file(tmp_path / "pair.h5", 1.0)
    lines = "".join(f"-{name} {value}\n" for name, value in OPTIONS.items())
    printed = []
    for name, more in (("c", ""), ("d", "-body2_compliance pair.h5\n")):
        (tmp_path / f"{name}.opts").write_text(lines + more)
        words = ("pair.h5", "--contact", f"{name}.opts", "--preload", "B=0.02", "--steps", 1)
        printed.append(command(*words, "--amplitudes", "3mm", "--sensor", "TIP:z"))
    assert printed[0] == printed[1]


def test_a_file_of_degree_1_has_no_lower_one(command, tmp_path):
    """Its numbers would not change, as if the degree were enough."""
    with h5py.File(pair_file(tmp_path / "pair.h5", 1.0), "a") as file:
        kept = file["basis/degree_xy"][()].sum(axis=1) <= 1
        for name in ("basis/degree_xy", *(f"cases/{one}/displacement" for one in file["cases"])):
            values = file[name][()][kept]
            del file[name]
            file[name] = values
        for name, chosen in (("compliance", np.ix_(kept, range(3), kept, range(3))), ("rigid/motions", np.s_[:, kept])):
            values = file[name][()][chosen]
            del file[name]
            file[name] = values
    (tmp_path / "c.opts").write_text(
        "".join(f"-{name} {value}\n" for name, value in (OPTIONS | dict(grid_n=16)).items())
    )
    words = ("pair.h5", "--contact", "c.opts", "--preload", "B=0.02", "--sensor", "TIP:z", "--steps", 1)
    printed = command(*words, "--amplitudes", "3mm", "--degree-check")
    assert "--degree-check: the file has 3 polynomials and no lower degree" in printed


def test_bodies_that_are_pulled_apart_end_the_backbone(tmp_path):
    pair = joint.Pair(pair_file(tmp_path / "pair.h5", 1.0), PRELOAD, **OPTIONS)
    with pytest.warns(joint.BackboneWarning, match="ended before .* pulls the bodies apart with"):
        found = joint.backbone(pair.structure, [3e-3, 10.0], steps=2)
    assert len(found.alpha) == 1


def test_displacements_whose_loads_are_held_follow(tmp_path):
    """Of a mode that moves the surfaces also along z: its frequency while all sticks is that of tiny amplitudes."""
    file = compliances.write(
        tmp_path / "one.h5", 0.3 * compliances.layer(0.5, 1), cases=dict(mode1=[[1.0, 0, 0.4], [0, 0, 0], [0, 0, 0]])
    )
    bodies = {f"body{k}_{name}": value for k in (1, 2) for name, value in (("young", 1.0), ("poisson", 0.3))}
    contact = petsam.Contact(**bodies, **OPTIONS, grid_size=2.0, body2_compliance=file)
    contact.try_step(load_n=0.05)
    contact.commit()
    patch = joint.Patch(contact, ["body2_case_mode1"], dict(load_n=0.05))
    found = joint.backbone(joint.Structure([patch], [3.0], [[1.0]]), [2e-5], steps=1)
    assert found.frequency == pytest.approx(found.linear, rel=1e-5)


def test_numbers_that_make_no_sense_are_refused():
    contact, stiffness = sphere(LOAD, 16)
    one = joint.Structure([joint.Patch(contact, ["disp_x"], dict(load_n=LOAD), by_load=["disp_x"])], rigid=[[1.0]])
    for given, says in (
        (dict(amplitudes=[1e-7, 0.0]), "amplitudes: expected lengths above 0"),
        (dict(amplitudes=[1e-7], sensor=[1.0, 2.0]), r"sensor: has the shape \(2,\): expected a number for each of 1"),
        (dict(amplitudes=[1e-7], harmonics=5), "steps 8: with 5 harmonics use 10 or more"),
        (dict(amplitudes=[1e-7], harmonics=-1), "harmonics -1: expected an integer >= 0"),
        (dict(amplitudes=[1e-7], harmonics=1.5), "harmonics 1.5: expected an integer >= 0"),
        (dict(amplitudes=[1e-7], steps=0), "steps 0: expected an integer >= 1"),
        (dict(amplitudes=[1e-7], steps=2.5), "steps 2.5: expected an integer >= 1"),
        (dict(amplitudes=[1e-7], mode=1.5), "mode 1.5: expected an integer >= 1"),
        (dict(amplitudes=[1e-7], mode="1"), "mode '1': expected an integer >= 1"),
        (dict(amplitudes="1um"), "amplitudes: expected lengths above 0, not '1um'"),
        (dict(amplitudes=[1e-7], sensor=["TIP"]), "sensor: expected a number for each of 1 modes"),
        (dict(amplitudes=[1e-7], sensor=[np.nan]), "sensor: expected finite numbers"),
    ):
        with pytest.raises(petsam.Error, match=says):
            joint.backbone(one, **given)
    with pytest.raises(petsam.Error, match="structure: expected a Structure, .* not Patch"):
        joint.backbone(one.patches[0], [1e-7])
    for given, says in (
        (dict(amplitude=[1e-7, 2e-7]), "amplitudes: expected lengths above 0"),
        (dict(amplitude=1e-7, steps=0), "steps 0"),
        (dict(amplitude=1e-7, mode=0), "mode 0"),
    ):
        with pytest.raises(petsam.Error, match=says):
            joint.shake(one, **given)
    with pytest.raises(petsam.Error, match="cycles: expected rising whole numbers above 0, not 'many'"):
        joint.wear(one, 1e-7, "many")
    with pytest.raises(petsam.Error, match="by_load 'disp_y': is none of the coordinates disp_x"):
        joint.Patch(contact, ["disp_x"], by_load=["disp_y"])
    with pytest.raises(petsam.Error, match="coordinates 'disp_x': expected a list of names"):
        joint.Patch(contact, "disp_x")
    with (
        petsam.Contact(**contact.options, body1_relax_moduli=0.5, body1_relax_times=1.0) as relaxing,
        pytest.raises(petsam.Error, match="relax_moduli: joints are of bodies that do not relax"),
    ):
        joint.Patch(relaxing, ["disp_x"])
    with pytest.raises(petsam.Error, match="omega: expected frequencies above 0"):
        joint.Structure(one.patches, [np.nan], [[1.0]])
    with pytest.raises(petsam.Error, match="damping -0.1: expected a part"):
        joint.Structure(one.patches, rigid=[[1.0]], damping=-0.1)
    for given, says in (
        (dict(force=[1.0, 2.0], frequencies=[1.0]), r"force: has the shape \(2,\): expected a number for each of 1"),
        (dict(force=[1.0], frequencies=[0.0]), "frequencies: expected numbers above 0, Hz"),
        (dict(force=[0.0], frequencies=[1.0]), "force: moves no mode"),
        (dict(force=["up"], frequencies=[1.0]), "force: expected a number for each of 1 modes"),
        (dict(force=[1.0], frequencies=[1.0], harmonics=2.0), "harmonics 2.0: expected an integer >= 1"),
    ):
        with pytest.raises(petsam.Error, match=says):
            joint.forced(one, **given, sensor=[1.0])


@pytest.mark.parametrize(
    "given, says",
    [
        (dict(press=0), "press 0: expected an integer >= 1"),
        (dict(press=2.0), "press 2.0: expected an integer >= 1"),
        (dict(lower=-1), "lower -1: expected an integer >= 0"),
        (dict(damping="high"), "damping 'high': expected a part of critical damping"),
        (dict(friction_scale=-1.0), "friction_scale -1.0: expected a factor from 0 on"),
        (dict(preload=0.02), "preload 0.02: expected {bolt: tension in N}"),
        (dict(preload=dict(B="much")), "preload B 'much': expected a tension from 0 on, in N"),
    ],
)
def test_arguments_of_a_pair_are_named(given, says, tmp_path):
    with pytest.raises(petsam.Error, match=re.escape(says)):
        joint.Pair(pair_file(tmp_path / "pair.h5", 1.0), **{"preload": PRELOAD, **OPTIONS, "grid_n": 8, **given})


def test_files_that_are_no_pair_are_named(command, tmp_path):
    compliances.write(tmp_path / "one.h5", compliances.layer(0.5, 1))
    (tmp_path / "c.opts").write_text("-grid_n 8\n")
    said = command("one.h5", "--contact", "c.opts", "--amplitudes", "1mm", "--sensor", "TIP:z", check=3)
    assert "one.h5: no pair of petsam-compliance with modes: it has no body 1, or no modes" in said
    damages = (
        ("basis/degree_xy", None, 3, "bad.h5: no pair of petsam-compliance with modes: "),
        ("rigid/compliance", np.eye(3), 3, "bad.h5: no pair of petsam-compliance with modes: "),
        ("bolts/closing", np.eye(2), 3, "bad.h5: no pair of petsam-compliance with modes: "),
        ("bolts", None, 2, "bad.h5: has no bolt, so nothing presses the bodies together: make it with --bolt"),
    )
    for name, values, code, says in damages:
        with h5py.File(pair_file(tmp_path / "bad.h5", 1.0), "a") as file:
            names = dict(file[name].attrs)
            del file[name]
            if values is not None:
                file[name] = values
                file[name].attrs.update(names)
        assert says in command("bad.h5", "--contact", "c.opts", "--amplitudes", "1mm", "--sensor", "TIP:z", check=code)


@pytest.mark.parametrize("per_metre, slipping, says", [
    (True, [6, 48], ""), (True, [3, 48], "fewer than 5 cells slip, at least 3: .* about 17 %"),
    (True, [0, 48], "all of it"), (False, [6, 48], "fewer than 100 cells slip, at least 6: .* all of it"),
    (False, [40, 400], "about 25 %"), (False, [100, 400], ""),
])  # fmt: skip
def test_how_many_cells_must_slip(per_metre, slipping, says):
    """In plane strain the slip zone is a part of a row, and a cylinder's energy has an error of at most 0.5/cells."""
    slipping, amplitude = np.array(slipping, float), np.array([1e-6, 1e-5])
    found = types.SimpleNamespace(
        per_metre=per_metre, slipping=slipping, amplitude=amplitude, numbers={}, cycles=np.ones(2)
    )
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        backbones._warn(found)
    assert len(told) == bool(says) and re.search(says, "".join(str(one.message) for one in told))


def test_few_slipping_cells_and_modes_beside_the_patch_are_warned_of():
    contact, stiffness = sphere(LOAD, 32)
    patch = joint.Patch(contact, ["disp_x"], dict(load_n=LOAD), by_load=["disp_x"])
    one = joint.Structure([patch], rigid=[[1.0]])
    with pytest.warns(joint.BackboneWarning, match="fewer than 100 cells slip"):
        joint.backbone(one, [0.004 * FRICTION * LOAD / stiffness], steps=2)
    patch = joint.Patch(contact, ["disp_x"], dict(load_n=LOAD))
    two = joint.Structure([patch], [50.0, 100.0], [[1e-3, 0.0]], coupling=[[1e-6 / 2500.0]])
    with pytest.warns(joint.BackboneWarning, match="is one without contact: it does not move the patches"):
        joint.backbone(two, [1e-9], mode=2 if two.stuck_modes()[0][1] > 99.9 else 1, steps=1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(petsam.Error, match="shapes: has the shape"):
            joint.Structure([patch], [1.0], np.eye(2))


def test_a_sensor_that_the_mode_does_not_move_is_named():
    contact, stiffness = sphere(LOAD, 16)
    patch = joint.Patch(contact, ["disp_x"], dict(load_n=LOAD))
    one = joint.Structure([patch], [50.0, 90.0], [[1e-3, 0.0]], coupling=[[1e-6 / 2500.0]])
    with pytest.raises(petsam.Error, match="the mode does not move it in this direction"):
        joint.backbone(one, [1e-9], mode=1, sensor=[1e-12, 1.0], steps=1)
    table = joint.backbone(one, [1e-9], mode=1, steps=1).lines()
    assert "amplitudes are modal, in m kg^0.5" in table[-2] and "touches sticks, Hz: " in table[1]


def test_an_amplitude_that_slides_is_named():
    contact, stiffness = sphere(LOAD, 16, wear_coefficient1=1e-13)
    patch = joint.Patch(contact, ["disp_x"], dict(load_n=LOAD), by_load=["disp_x"])
    one = joint.Structure([patch], rigid=[[1.0]])
    with pytest.raises(petsam.Error, match="at an amplitude of .* m: gross slip: load_tx"):
        joint.backbone(one, [2 * FRICTION * LOAD / stiffness], steps=2)
    with pytest.raises(petsam.Error, match="the vibration after 0 cycles or more: gross slip: load_tx.* mu p$"):
        joint.wear(one, 2 * FRICTION * LOAD / stiffness, [10.0], steps=2)


@pytest.mark.parametrize("by_load", [(), ("disp_x",)])
def test_the_first_step_of_a_structure_at_rest_is_in_equilibrium(by_load):
    """Without loads before it there is no work to which an error would be relative: zeros were taken for a solution."""
    (first, k1), (second, k2) = sphere(LOAD), sphere(LOAD / 2)
    patches = [joint.Patch(c, ["disp_x"], dict(load_n=n), by_load) for c, n in ((first, LOAD), (second, LOAD / 2))]
    one = joint.Structure(patches, rigid=2 * [[0.5]])
    one.step([0.5 * 0.9 * FRICTION * LOAD])
    pairs = [(LOAD, k1), (LOAD / 2, k2)]
    q = brentq(lambda q: sum(shear(q, *pair) for pair in pairs) - 0.9 * FRICTION * LOAD, 0.0, 1e-5, xtol=1e-20)
    assert -one.loads == pytest.approx([shear(q, *pair) for pair in pairs], rel=1e-3)
    assert one.z == pytest.approx([q, q], rel=1e-3)
    with pytest.raises(joint.failures.ENDS):
        one.step([0.5 * 1.6 * FRICTION * LOAD])
