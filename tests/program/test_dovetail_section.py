"""The dovetail in plane strain: a coarse mesh in CalculiX beside petsam by the compliances of both sections."""

import sys

import numpy as np
import pytest

import support
from test_fe_comparison import needs_calculix

sys.path[:0] = [str(support.ROOT / "examples" / name) for name in ("dovetail", ".")]
import section  # noqa: E402

SIZE, COARSE = 0.2, (0.1, 0.6)  # mm


@pytest.fixture(scope="module")
def short():
    """A history of six rows."""
    with pytest.MonkeyPatch.context() as patched:
        for name, value in (("RISES", 1e-3 * np.array([10, 20, 13, 6, 13, 20])), ("TOP", 1), ("BOTTOM", 3)):
            patched.setattr(section, name, value)
        patched.setattr(section, "CYCLE", slice(1, 6))
        yield


@needs_calculix
def test_full_contact_is_petsams(short, tmp_path):
    """Within what four elements across the half contact resolve: measured 0.3, 0.6 and 10 %."""
    mine = section.contact(*(section.compliance(tmp_path / name, name, COARSE) for name in ("blade", "disc")))
    other = section.Full(tmp_path, SIZE, 30.0, 0.1)
    found = section.differences(mine, other)
    print(found)
    for name, nodal in (("load_n", other.forces["pressure"]), ("load_tx", other.forces["shear_x"])):
        assert 1e3 * nodal.sum(axis=1) == pytest.approx(other.loads[name], abs=20.0)  # N/m, of the supports
    assert found["n"] < 0.01 and found["t"] < 0.01 and abs(found["work"]) < 0.15
    assert found["pressure1"] < 0.1 and found["shear_x1"] < 0.1


def test_forces_of_quadratic_sides_are_of_their_field():
    x = np.array([-1.0, -0.7, -0.4, 0.1, 0.6])
    line = section.Line(x)
    forces = line.forces(line.at**2 - line.at)
    assert line.field(forces) == pytest.approx(x**2 - x) and forces.sum() == pytest.approx(
        np.diff(x**3 / 3 - x**2 / 2).sum()
    )
    assert line.error(1.1 * forces, forces) == pytest.approx(0.1)
