"""What is told of a contact before it is solved, and advice that ends: what no grid does has its reason."""

import re

import numpy as np
import pytest

import petsam as module
from support import SPHERE, doubts

STEEL = {name: SPHERE[name] for name in ("body1_young", "body1_poisson", "body2_young", "body2_poisson")}
BALL = dict(STEEL, gap_type="sphere", gap_radius1=5e-3, gap_radius2="inf", grid_n=32, grid_size=8e-3)
ROLL = dict(STEEL, elasticity="plane", gap_type="curved", gap_radius1_x=5e-3, grid_n=64, grid_size=8e-3)
HARDENS = dict(body2_hardening="linear:2GPa")
YIELD = dict(body2_yield=4e8, yield_layers=8)
COATING = dict(body2_layer_young=300e9, body2_layer_poisson=0.2, body2_layer_thickness=1e-5)


@pytest.mark.parametrize(
    "case",
    [
        dict(BALL, load_n=34e3, **YIELD),
        dict(BALL, load_n=40e3, **YIELD, **HARDENS),
        dict(ROLL, load_n=7e6, **YIELD),
        dict(BALL, disp_z=1e-3, **YIELD),
        dict(BALL, load_n=34e3, **YIELD, **COATING),
    ],
    ids=["ball", "hardens", "plane", "approach", "coated"],
)
def test_yielding_bodies_far_outside_of_the_theory_are_rejected_before_the_first_step(petsam, case):
    said = petsam(case, dict(output="r.h5"), check=2).complaint[0]
    found = re.search(r"half width is ([\d.]+) times -gap_radius1\w* 0.005 \(in m\), the limit is about ([\d.]+)", said)
    ratio, limit = found.groups()
    assert 0.3 < float(ratio) < 1.5 and float(limit) == 0.1 and "give less load" in said


def test_contact_in_process_rejects_such_a_step_and_goes_on():
    with module.Contact(**BALL, **YIELD) as contact:
        with pytest.raises(module.ContactError, match="far too large for half-space theory"):
            contact.try_step(load_n=34e3)
        assert contact.try_step(load_n=10.0).load_n == 10.0


@pytest.mark.parametrize("load, code", [(900.0, 0), (1e5, 2)])
def test_punch_with_sharp_edges_is_rejected_only_where_its_base_sinks_in(petsam, load, code):
    """Half the radius of an edge of 0.1 um is nothing beside a base of 1 mm."""
    punch = dict(STEEL, gap_type="punch", gap_flat_radius=1e-3, gap_edge_radius=1e-7, grid_n=32, grid_size=3e-3)
    said = petsam(punch, dict(load_n=load, dry_run=True), YIELD, check=code).stderr
    assert ("far too large" in said) == bool(code) and "times -gap_edge_radius" in said


@pytest.mark.parametrize("load, told", [(4e3, True), (300.0, False)])
def test_yielding_ball_outside_of_the_theory_is_told_once(petsam, load, told):
    done = petsam(dict(BALL, load_n=load, **YIELD, grid_size=3e-3, grid_n=24))
    assert done.stderr.count("too large for half-space theory") == told
    assert done.stderr.count("takes several times as long") == told


@pytest.mark.parametrize("more", [dict(load_n=1e5), dict(disp_z=1e-6, plane_datum=0.1)])
def test_flat_on_flat_needs_no_larger_grid(petsam, more):
    """In plane strain: a grid of any size is in contact up to its edge."""
    case = dict(STEEL, elasticity="plane", gap_type="flat", grid_n=32, grid_size=0.1, **more)
    said = petsam(case, check=12).complaint[0]
    assert "touch up to the edge of any grid: use -elasticity plane_periodic" in said and "-grid_size" not in said


@pytest.mark.parametrize("clearance", [1e-4, 1e-3])
@pytest.mark.parametrize("plane", [True, False])
def test_conforming_bodies_that_no_half_space_bears_are_advised_no_grid(petsam, plane, clearance):
    case = dict(ROLL, gap_radius1_x=0.01, gap_radius2_x=-0.01 * (1 + clearance), load_n=1e6)
    if not plane:
        case.update(elasticity=None, gap_radius1_y=0.01, gap_radius2_y=-0.01 * (1 + clearance), load_n=1e4)
    said = petsam(case, check=12).complaint[0]
    assert "no grid does" in said and "finite elements" in said and "-grid_size" not in said


@pytest.mark.parametrize("body", [1, 2])
def test_bulk_stress_without_effect_is_told(petsam, body):
    case = dict(SPHERE, friction=None, load_tx=None, **{f"bulk{body}_stress_xx": 1e6})
    told = f"bulk{body}_stress, up to 1e+06 Pa, has no effect on the contact"
    assert told in petsam(case).stderr
    layers = dict(yield_layers=4)
    assert told in petsam(case, {f"body{3 - body}_yield": 9e9}, layers).stderr
    assert told not in petsam(case, {f"body{body}_yield": 9e9}, layers).stderr
    assert told not in petsam(case, dict(friction=0.3)).stderr


@pytest.mark.parametrize(
    "name, value, more",
    [
        ("film_thickness", 5.0, dict(film_shear=1e9)),
        ("friction_path_length", 2.0, dict(friction_law="slip_path", friction_path_final=0.5)),
        ("gap_radius1", 2000.0, dict(gap_radius2="inf")),
    ],
)
def test_lengths_in_another_unit_than_the_grid_are_told(petsam, name, value, more):
    case = {**SPHERE, "friction": 0.3, "load_tx": 10.0, "grid_size": 2.6e-3, **more}
    told = f"-{name} {value:g} is "
    assert told in petsam({**case, name: value}, "-allow_edge_contact", check=None).stderr
    assert f"-{name}" not in petsam({**case, name: value * 1e-4}, "-allow_edge_contact", check=None).stderr


@pytest.mark.parametrize("part, cells", [(0.005, 64), (0.02, 70), (0.02, 73)])
def test_maximum_shear_of_a_missed_slip_zone_is_told(petsam, part, cells):
    """A cylinder under N and T: Cattaneo's maximum shear is mu p0 sqrt(T/mu N)."""
    modulus, load, radius, mu = 210e9 / 0.91 / 2, 1e5, 0.05, 0.1
    half = np.sqrt(4 * load * radius / (np.pi * modulus))
    case = dict(STEEL, elasticity="plane", gap_type="ellipsoid", gap_radius_x=radius, gap_radius_y="inf", grid_n=cells)
    done = petsam(case, dict(grid_size=2.4 * half, friction=mu, load_n=load, load_tx=mu * load * part))
    shear = float(re.search(r"shear ([\d.e+]+) Pa", done.stdout)[1])
    low = 1 - shear / (mu * 2 * load / (np.pi * half) * np.sqrt(part))
    told = doubts(done)[1]["shear_max"]
    assert low > 0.4 and told == pytest.approx(low, abs=0.05)


@pytest.mark.parametrize("cells, advised", [(40, True), (400, False)])
def test_stick_zone_far_smaller_than_the_contact_is_advised_no_grid(petsam, cells, advised):
    """A cylinder of which a hundredth sticks: each finer grid would find a zone of few cells again."""
    case = dict(STEEL, elasticity="plane", gap_type="ellipsoid", gap_radius_x=0.05, gap_radius_y="inf", grid_n=cells)
    done = petsam(case, dict(grid_size=5e-4, friction=0.5, load_n=1e5, load_tx=0.4999985 * 1e5))
    line, told = doubts(done)
    assert "stick_area" in told and ("-grid_n" in line) == advised
    assert advised or "of the contact's width, for which no usual grid does" in line


def test_width_of_a_ring_that_long_steps_pass_is_advised_no_grid(petsam):
    """Steel on aluminium, pressed in few steps: the width of the ring of slip follows from more of them."""
    case = dict(STEEL, body2_young=70e9, body2_poisson=0.1, gap_type="sphere", gap_radius2="inf")
    more = dict(gap_radius1=0.02283885631132319, grid_n=22, grid_size=0.0007250575713378503, friction=0.8)
    done = petsam(case, more, dict(load_n=65.26546766897161, load_tx=0.0, steps=3))
    line, told = doubts(done, "steps")
    assert (
        "before cells touch" in line
        and told["dissipated_energy"] == 1
        and int(re.search(r"-steps (\d+)$", line)[1]) > 3
    )
    assert "in a ring" not in doubts(done)[0]
