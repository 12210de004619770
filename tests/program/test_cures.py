"""Cures that messages name: who follows them gets to a run without the message, or to its reason."""

import re

import pytest

from support import SPHERE, history

STEEL = {name: SPHERE[name] for name in ("body1_young", "body1_poisson", "body2_young", "body2_poisson")}
BALL = dict(STEEL, gap_type="sphere", gap_radius1=0.02, gap_radius2="inf", load_n=100.0)
CYLINDER = dict(STEEL, elasticity="plane", gap_type="curved", gap_radius1_x=0.05)
PERIODIC = dict(elasticity="periodic", grid_size=3e-4, grid_n=24)
LINES = dict(elasticity="plane_periodic", load_n=1e5, grid_size=5e-4, grid_n=64)
NUMBERS = re.compile(r"-(grid_size|grid_n|steps) (\d[\d.e+-]*(?:,\d[\d.e+-]*)?)")
MOST = 4  # runs


def kind(message):
    return message.split(": ")[2]


def follow(petsam, case, words):
    """Runs with what the message of these words advises, until it is gone or advises nothing; returns it, or None."""
    last, case = None, dict(case)
    for _ in range(MOST):
        said = [line for line in petsam(case).complaint if words in line]
        if not said:
            return None
        assert last is None or kind(said[0]) == kind(last)
        last, options = said[0], dict(NUMBERS.findall(said[0]))
        if not options:
            return last
        case.update({name: value.rstrip(",.") for name, value in options.items()})
    pytest.fail(f"after {MOST} runs: {last}")


@pytest.mark.parametrize(
    "case, words",
    [
        (dict(BALL, **PERIODIC), "of the period wide"),
        (dict(BALL, **PERIODIC, body2_young=70e9), "of the period wide"),
        (dict(CYLINDER, **LINES), "of the period wide"),
        (dict(BALL, grid_size=1e-3, grid_n=16), "cells across"),
        (dict(BALL, grid_size=6e-4, grid_n=24, friction=0.3, load_tx=3.0), "slip zones are"),
    ],
    ids=["periodic", "dissimilar", "plane", "cells", "slip"],
)
def test_cures_end(petsam, case, words):
    assert words in petsam(case).stderr
    assert follow(petsam, case, words) is None


@pytest.mark.parametrize("first, last", [((5e4, 0.0), (1e5, 1e4)), ((1.5e5, 0.0), (1e5, 3e4))])
def test_no_closed_form_is_told_where_the_load_changes_while_shear_begins(petsam, tmp_path, first, last):
    """N and T change in one step: Cattaneo's energy is that of a constant N, and no grid comes to it."""
    rows = history(tmp_path / "rows.csv", "time,load_n,load_tx", (1.0, *first), (2.0, *last), (3.0, last[0], -last[1]))
    case = dict(CYLINDER, **rows, grid_size=9e-4, grid_n=400, friction=0.5)
    done = petsam(case)
    assert "closed form" not in done.stderr + done.stdout
    kept = history(tmp_path / "kept.csv", "time,load_n,load_tx", (1.0, *first), (2.0, last[0], 0.0), (3.0, *last))
    assert "closed form" in petsam(case, kept).stdout


@pytest.mark.parametrize("hardens, shear, advised", [(None, 2e5, False), (4e9, 3e5, True), (20e9, 2e5, True)])
def test_strain_along_a_line_is_advised_no_grid(petsam, tmp_path, hardens, shear, advised):
    """The shear at the surface of a body that does not harden: its maximum grows with the number of cells. It does not
    where the body hardens, also if the plastic strain is larger than the elastic one."""
    rows = history(tmp_path / "rows.csv", "time,load_n,load_tx", (1.0, 1e6, 0.0), (2.0, 1e6, shear))
    case = dict(CYLINDER, **rows, grid_size=2.5e-3, grid_n=160, friction=0.5, body2_yield=4e8, steps=2)
    if hardens:
        case.update(body2_hardening=f"linear:{hardens}")
    (said,) = [line for line in petsam(case).complaint if "falls within the first layers" in line]
    assert ("no grid bounds" in said) != advised


def test_press_fit_is_rejected_with_its_reason(petsam):
    """No radius makes it a contact of half-spaces: nearly equal ones are rejected with the same way out."""
    case = dict(CYLINDER, gap_radius1_x=0.01, load_n=1e6, grid_size=1e-3, grid_n=32)
    for radius, code in [(-0.00999, 2), (-0.010001, 12)]:
        said = petsam(case, dict(gap_radius2_x=radius), check=code).stderr
        assert "finite elements" in said and "negative radius" not in said
