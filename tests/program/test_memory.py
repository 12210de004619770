"""The memory that the head of a run prints is the peak of the run's largest rank, where fields dominate."""

import re

import pytest

from support import bodies

LEAST = 100  # MB, beyond which fields dominate
BALL = dict(**bodies(), gap_type="sphere", gap_radius1=0.2, gap_radius2=0.2, load_n=1000.0, allow_edge_contact=True)
LINE = dict(
    **bodies(), gap_type="curved", gap_radius1_x=0.2, gap_radius2_x=0.2, elasticity="plane", load_n=3e5, grid_n=200000
)
SOFT = dict(body2_young=70e9, body2_poisson=0.34)
SLIPS = dict(friction=0.3, load_tx=150.0)
ROWS = dict(friction=0.3, load_n=None, history="history.csv")
HISTORY = "time,load_n,load_tx\n1,1000,0\n2,1000,150\n3,1000,-150\n4,1000,150\n"
CYCLE = "time,load_n,load_tx\n0,1000,0\n1,1000,150\n2,1000,-150\n3,1000,0\n"
LIVES = dict(ROWS, history="cycle.csv", wear_coefficient1=1e-13, wear_cycles=60, wear_jump=20)
SLIDES = dict(ROWS, history="slides.csv", slide=True)
PATH = dict(friction_law="slip_path", friction_path_final=0.5, friction_path_length=1e-3)
WEARS = dict(wear_coefficient1=1e-14, wear_coefficient2=1e-14)
SLID = "time,load_n,disp_x\n1,{0},0\n2,{0},1e-4\n3,{0},-1e-4\n4,{0},1e-4\n"
BACK = dict(gradient="energy", slip_direction="end", errors="none", output="g.h5")
WIDE, HALF, FULL = dict(grid_size=9e-3), dict(grid_size=2.6e-3), dict(grid_size=1.75e-3)  # a contact of 1.74 mm
CASES = {
    "pressed": {**BALL, **HALF, "grid_n": 1000},
    "pressed, wide grid": {**BALL, **WIDE, "grid_n": 900},
    "friction": {**BALL, **HALF, **SLIPS, "grid_n": (560, 600)},
    "friction, wide grid": {**BALL, **WIDE, **SLIPS, "grid_n": 700},
    "friction, full grid": {**BALL, **FULL, **SLIPS, "grid_n": 540},
    "edges none": {**BALL, **HALF, **SLIPS, "edges": "none", "grid_n": 600},
    "hardness": {**BALL, **HALF, **SLIPS, "pressure_limit": 4e8, "grid_n": 600},
    "periodic": {**BALL, **HALF, **SLIPS, "elasticity": "periodic", "grid_n": 600},
    "fields": {**BALL, **HALF, **SLIPS, "output": "o.h5", "output_fields": "all", "grid_n": 512},
    "steps": {**BALL, **HALF, **ROWS, "grid_n": 500},
    "steps, wide grid": {**BALL, **WIDE, **ROWS, "grid_n": 560},
    "checkpoint": {**BALL, **WIDE, **ROWS, "checkpoint": "c.h5", "checkpoint_every": 1, "grid_n": 512},
    "stiffness": {**BALL, **HALF, **SLIPS, "stiffness": True, "output": "o.h5", "grid_n": 450},
    "steady rolling": {**BALL, **HALF, "friction": 0.3, "rolling": "steady", "creep_x": 1e-4, "grid_n": 512},
    "slide": {**BALL, **HALF, **SLIDES, "grid_n": 700},
    "slide, friction law": {**BALL, **HALF, **SLIDES, **PATH, "grid_n": 1000},
    "slide, worn": {**BALL, **HALF, **SLIDES, **PATH, **WEARS, "grid_n": 1000},
    "slide, worn, wide grid": {**BALL, **WIDE, **SLIDES, **WEARS, "grid_n": 560},
    "slide, plane": {**LINE, **HALF, **SLIDES, "history": "line.csv"},
    "slide, dissimilar": {**BALL, **WIDE, **SLIDES, **SOFT, "grid_n": 400},
    "dissimilar": {**BALL, **WIDE, **SLIPS, **SOFT, "grid_n": 560},
    "dissimilar, no shear": {**BALL, **WIDE, **SOFT, "friction": 0.3, "grid_n": 400},
    "gradient": {**BALL, **HALF, **ROWS, **BACK, "grid_n": 512},
    "gradient, no friction": {**BALL, **FULL, **BACK, "friction": 0, "gradient": "pressure_norm", "grid_n": 400},
    "gradient, dissimilar": {**BALL, **FULL, **ROWS, **SOFT, **BACK, "grid_n": 300},
    "gradient of a stress": {**BALL, **WIDE, **ROWS, **BACK, "gradient": "mises@50um", "grid_n": 400},
    "gradient of a cycle": {**BALL, **HALF, **ROWS, **BACK, "gradient": "energy,swt@50um", "grid_n": 350},
    "gradient, wide grid": {**BALL, **WIDE, **ROWS, **BACK, "grid_n": 560},
    "gradient, life": {**BALL, **HALF, **LIVES, **BACK, "gradient": "wear_volume", "grid_n": 320},
    "gradient, life, wide grid": {**BALL, **WIDE, **LIVES, **BACK, "grid_n": 500},
    "plane": {**LINE, **HALF, "friction": 0.3, "load_tx": 4e4},
    "plane, wide grid": {**LINE, **WIDE},
}


def megabytes(text, words):
    number, unit = re.search(rf"{words} (\S+) ([kMG])B", text).groups()
    return float(number) * {"k": 1e-3, "M": 1, "G": 1e3}[unit]


@pytest.mark.parametrize("name", CASES)
def test_memory_is_estimated_within_15_percent(petsam, tmp_path, name):
    """For a small contact in a wide grid and for one that fills it; -dry_run prints the same."""
    (tmp_path / "history.csv").write_text(HISTORY)
    (tmp_path / "cycle.csv").write_text(CYCLE)
    (tmp_path / "slides.csv").write_text(SLID.format(1000))
    (tmp_path / "line.csv").write_text(SLID.format(3e5))
    text = petsam(CASES[name]).stdout
    estimate, peak = megabytes(text, "memory +about"), megabytes(text, "and memory")
    assert peak > LEAST / 1.1 and abs(estimate / peak - 1) < 0.15
    if "checkpoint" not in CASES[name]:
        assert megabytes(petsam(CASES[name], dict(dry_run=True)).stdout, "memory +about") == estimate
