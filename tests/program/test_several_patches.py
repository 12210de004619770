"""Several patches of a pair: against one patch that covers them, and mistakes."""

import h5py
import numpy as np
import pytest

from petsam import joint
from petsam.apps.compliance import basis, halfspace, several
from petsam.apps.compliance.remainder import Side
from test_compliance_command import compliance  # noqa: F401
from test_compliance_pair import ALWAYS, FRAME, HELD, body, both, write

pytestmark = [
    pytest.mark.filterwarnings(f"ignore::petsam.{name}") for name in ("apps.joint.BackboneWarning", "AdviceWarning")
]
WORDS = ["--mesh", "pair.inp", "--contact", "TOP2", "--pair", "TOP1", *FRAME, *ALWAYS[:2], *ALWAYS[4:], *HELD]
WORDS += ["--bolt", "B=WASHER1,WASHER2:0.5:1.0", "--modes", "6", "--sensor", "TIP=1"]
X = np.array([-1.8, -1.2, -0.6, 0.0, 1.0, 1.6, 2.2, 3.0])
Y = np.array([-2.4, -2.0, -1.5, -1.0, 0.0, 1.0, 1.5, 2.0, 2.4])
Z = np.array([0.0, 0.6, 1.4])
APART, SIDES = 1.0, (1.6, 1.2)  # distance of the patches from y = 0, their widths
SMALL = ["--patch", "1.6,1.2", "--center=0.4,-1", "--center", "0.4,1"]
CELLS, RADIUS = 1 / 15, 6.0


@pytest.fixture
def files(compliance, tmp_path):  # noqa: F811
    """Files of two patches, and of one that covers them."""
    write(tmp_path / "pair.inp", both(bodies=[body(number, edges=(X, Y, Z)) for number in (2, 1)]))
    compliance(*WORDS, *SMALL, "--degree", "3,3", "-o", "two.h5")
    compliance(*WORDS, "--patch", "1.6,3.2", "--center", "0.4,0", "--degree", "3,9", "-o", "one.h5")


def spheres():
    """Two spheres' gap on the patch that covers both."""
    nx, ny = round(SIDES[0] / CELLS), round(3.2 / CELLS)
    x, y = ((np.arange(n) + 0.5 - n / 2) * CELLS for n in (nx, ny))
    h = np.minimum(*((x**2 + (y[:, None] - sign * APART) ** 2) / (2 * RADIUS) for sign in (-1, 1)))
    with h5py.File("gap.h5", "w") as file:
        file["height"] = h
        file["height"].attrs.update(units="m", quantity="separation")
    return nx, ny


def test_two_patches_are_one_that_covers_them(files):
    """Preload, modes and damping by the polynomials of two patches and their coupling, against those of one, also where
    a patch slides and the other one holds."""
    grid = spheres()
    round_gap = dict(grid_n=(24, 18), gap_type="sphere", gap_radius1=RADIUS, gap_radius2="inf")
    two = joint.Pair("two.h5", dict(B=2e-3), friction=0.3, **round_gap)
    one = joint.Pair("one.h5", dict(B=2e-3), friction=0.3, grid_n=grid, gap_type="file", gap_file="gap.h5")
    loads = [patch.number("load_n") for patch in two.structure.patches]
    assert min(loads) > 0.2 * max(loads) and sum(loads) == pytest.approx(
        one.structure.patches[0].number("load_n"), rel=5e-4
    )
    assert two.tensions["B"] == pytest.approx(one.tensions["B"], rel=5e-4)
    assert two.structure.stuck_modes()[0] == pytest.approx(one.structure.stuck_modes()[0], rel=5e-4)
    amplitudes = [1e-2, 2.5e-2]
    found, other = (joint.backbone(pair.structure, amplitudes, steps=2) for pair in (two, one))
    assert found.frequency == pytest.approx(other.frequency, rel=5e-4)
    assert found.damping == pytest.approx(other.damping, rel=5e-3)
    assert found.frequency[1] < 0.95 * found.linear and np.all(found.patches > 0)
    assert found.names == ["patch1", "patch2"] and found.patches.sum(axis=1) == pytest.approx(found.energy)


@pytest.fixture
def small(compliance, tmp_path):  # noqa: F811
    """A function of preload, radius and cells: the pair of two patches that touch in some cells."""
    write(tmp_path / "pair.inp", both(bodies=[body(number, edges=(X, Y, Z)) for number in (2, 1)]))
    compliance(*WORDS, *SMALL, "--degree", "3,3", "-o", "two.h5")
    gap = dict(friction=0.3, gap_type="sphere", gap_radius2="inf")
    return lambda preload, radius, cells: joint.Pair("two.h5", dict(B=preload), grid_n=cells, gap_radius1=radius, **gap)


def test_bolts_are_tightened_on_contacts_of_a_few_cells(small):
    """These bear hardly any moment, and slide under loads that they bear as they grow: equilibrium of all coordinates,
    beside the static compliance."""
    for preload, radius, cells in ((2e-4, 6.0, (24, 18)), (2e-5, 20.0, (24, 18)), (2e-5, 6.0, (25, 19))):
        one = small(preload, radius, cells).structure
        touching = [np.sum(patch.contact["pressure"] > 0.0) for patch in one.patches]
        assert min(touching) >= 1 and max(touching) < 9, (preload, radius)
        assert one.coupling @ one.loads == pytest.approx(one.z, rel=1e-4, abs=1e-6 * np.abs(one.z).max())
        assert one.loads[0] == pytest.approx(-one.patches[0].number("load_n")) and one.loads[0] < 0.0


def test_bolts_that_do_not_close_the_gap_are_told(small):
    """The centre of the nearest cell is farther from the other body than the bolt moves it."""
    with pytest.raises(joint.NoSolution, match="patch1: the bodies do not touch, load_n = 0 N"):
        small(2e-5, 6.0, (24, 18))


def test_patches_that_bear_unequal_loads_are_pressed_without_friction(compliance, tmp_path):  # noqa: F811
    """The bolt is beside one of them; all is in equilibrium."""
    write(tmp_path / "pair.inp", both(bodies=[body(number, edges=(X, Y, Z)) for number in (2, 1)]))
    apart = ["--patch", "1.0,0.8", "--center=-0.3,-1.0", "--center", "1.0,0.6"]
    compliance(*WORDS, *apart, "--modes", "2", "--degree", "2,2", "-o", "apart.h5")
    given = dict(friction=0.3, grid_n=(12, 10), gap_type="sphere", gap_radius1=RADIUS, gap_radius2="inf")
    one = joint.Pair("apart.h5", dict(B=2e-3), frictionless=True, press=2, **given).structure
    loads = [patch.number("load_n") for patch in one.patches]
    assert 0 < loads[0] < 0.3 * loads[1]
    assert one.coupling @ one.loads == pytest.approx(one.z, rel=1e-4, abs=1e-6 * np.abs(one.z).max())


def test_the_half_space_between_patches_is_that_of_points():
    """Against sums over many points of both patches; it is symmetric."""
    patches = [basis.Patch((-1.0, 0.2), (0.7, 0.4), (2, 1)), basis.Patch((0.9, 0.3), (0.7, 0.4), (2, 1))]
    fields = [[kind(patch, 2.0, 0.2) for patch in patches] for kind in (halfspace.Fields, halfspace.Mirrored)]
    sides = [Side(None, halfspace.Several(one)) for one in fields]
    found = several.between(sides, patches)
    assert np.allclose(found, found.T, atol=1e-9 * np.abs(found).max())
    count = 3 * patches[0].count
    assert not np.any(found[:count, :count]) and not np.any(found[count:, count:])
    (x, wx), (y, wy) = (patch.quadrature(40, 40) for patch in patches)
    apart = np.concatenate([(x[:, None] - y).reshape(-1, 2), np.zeros((len(x) * len(y), 1))], axis=1).T
    u = halfspace.displacement(apart, 0.2).reshape(3, 3, len(x), len(y)) * 1.2 / (4 * np.pi)
    vx, vy = (patch.values(*points.T) for patch, points in zip(patches, (x, y)))
    one = np.einsum("pi,p,abpq,q,qj->iajb", vx, wx, u, wy, vy, optimize=True).reshape(count, count)
    turned = np.tile([1.0, 1.0, -1.0], patches[0].count)  # body 1 is the mirror image
    assert found[:count, count:] == pytest.approx(one + one * np.outer(turned, turned), rel=1e-7, abs=1e-9)


@pytest.mark.parametrize(
    "words, says, code",
    [
        (["--center=0.4,-0.5", "--center", "0.4,0.6"], "patches 1 and 2 are 0 m apart, limit 0.03 m", 3),
        (["--center=0.4,-0.61", "--center", "0.4,0.61"], "patches 1 and 2 are 0.02 m apart", 3),
        (["--center=0.4,-1", "--center", "0.4,2"], "the patch is not inside the contact surface: x = ", 3),
    ],
)
def test_patches_that_make_no_sense_are_rejected(words, says, code, compliance, tmp_path):  # noqa: F811
    write(tmp_path / "pair.inp", both(bodies=[body(number, edges=(X, Y, Z)) for number in (2, 1)]))
    bare = WORDS[: WORDS.index("--modes")]
    said = compliance(*bare, "--patch", "1.6,1.2", *words, "--degree", "2", check=code)
    assert says in said[0]


def test_load_cases_beyond_what_a_file_holds_are_left_out_with_warning(compliance, tmp_path, monkeypatch):  # noqa: F811
    write(tmp_path / "pair.inp", both(bodies=[body(number, edges=(X, Y, Z)) for number in (2, 1)]))
    monkeypatch.setattr(several, "MOST", 4)
    bare = WORDS[: WORDS.index("--modes")]
    said = compliance(
        *bare, *SMALL, "--degree", "3,3", "-o", "few.h5", warning="the load cases of the other patches miss"
    )
    assert "load cases of the other patches: 3, 3" in "".join(said)


def test_several_patches_need_a_pair(compliance):  # noqa: F811
    words = ["--mesh", "a.inp", "--contact", "T", "--fixed", "F", "--patch", "1", "--center", "0,0", "--center", "2,0"]
    assert "--center: several patches are for a pair" in compliance(*words, check=2)[0]
    said = compliance(*words, "--pair", "U", "--case", "far12=1", check=2)[0]
    assert "--case: far with a number is a name of the file's own" in said
