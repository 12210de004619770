"""Steady rolling against formulas in numpy: problems of kinds/rolling.py, and reciprocity without slip."""

import h5py
import numpy as np
import pytest

from kinds import rolling
from test_rolling import ellipse


# cells of hardly any bound, fast sliding under loads, films; then the first ones
@pytest.mark.parametrize(
    "seed", [27, 97, 138, 205, 234, 1, 2, *(pytest.param(k, marks=pytest.mark.slow) for k in range(3, 11))]
)
def test_random_problem(seed, tmp_path):
    outcome = rolling.trial(seed, tmp_path)
    assert not outcome.fault, outcome.text


@pytest.mark.parametrize("ratio", [0.3, 3])
def test_reciprocity_without_slip(solve, tmp_path, ratio):
    """
    Lateral force by spin, moment by lateral creepage of the contact mirrored along x, where the stream is the other
    way: rough, under a film, with a field of friction that holds everywhere. Spin is taken at x + dx/6 and adds as much
    lateral creepage, the loads are those at the centres.
    """
    random = np.random.default_rng(3)
    fields = dict(friction=1e5 * (1 + random.random((45, 50))), rough=5e-6 * random.random((45, 50)))
    with h5py.File(tmp_path / "ahead.h5", "w") as ahead, h5py.File(tmp_path / "back.h5", "w") as back:
        for name, field in fields.items():
            ahead[name], back[name] = field, field[:, ::-1]
    case = ellipse(n=(50, 45), ratio=ratio, width=2.6, friction=None, film_thickness=1e-4, film_shear=1e10)
    case.update(gap_rough_dataset="/rough", tangential_rtol=1e-11, normal_rtol=1e-12)

    def run(name, **creepages):
        return solve(case, dict(friction_file=tmp_path / name, gap_rough_file=tmp_path / name), creepages)

    spin = run("ahead.h5", creep_x=0.0, creep_y=0.0, creep_spin=1.0)
    creep = run("back.h5", creep_x=0.0, creep_y=1e-3, creep_spin=0.0)
    assert spin["contact_cells"] == creep["contact_cells"] < 0.85 * np.pi / 2.6**2 * 50 * 45
    added = spin.dx / 6 / 1e-3 * run("ahead.h5", creep_x=0.0, creep_y=1e-3, creep_spin=0.0)["load_ty"]
    assert added > 0.01 * spin["load_ty"]
    assert -creep["load_mz"] / 1e-3 == pytest.approx(float(spin["load_ty"] - added), rel=1e-9)
