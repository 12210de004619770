"""Fields below the surface of bodies that yield, and petsam-stress with the stresses by their plastic strain."""

import shutil

import h5py
import numpy as np
import pytest

import conftest
import petsam

CASE = dict(
    gap_type="sphere", gap_radius1="10mm", gap_radius2="inf", grid_n=(24, 19), grid_size="0.4mm,0.34mm",
    body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3, friction=0.4,
    yield_depth="0.3mm", yield_layers=12, yield_first="0.025mm", load_n=60, load_tx=10,
    output_fields="usual,plastic",
)  # fmt: skip
YIELD, DEPTH, LAYERS = 600e6, 0.3e-3, 12
PARTS = ("xx", "yy", "zz", "xy", "xz", "yz")
PROGRAM = conftest.PROGRAM.with_name("petsam-stress")


@pytest.fixture(scope="module")
def folder(tmp_path_factory, launcher):
    """A folder with both.h5, one.h5, two.h5: which bodies yield; and none.h5, which lacks what is below."""
    folder = tmp_path_factory.mktemp("yield")
    for name, bodies, more in (
        ("both", (1, 2), {}),
        ("one", (1,), {}),
        ("two", (2,), {}),
        ("none", (2,), {"output_fields": "usual"}),
    ):
        case = dict(CASE, output=f"{name}.h5", **{f"body{b}_yield": YIELD for b in bodies})
        conftest.execute(launcher, folder, [{**case, **more}], 2 if name == "both" else 1, 0)
    return folder


@pytest.fixture
def stress(folder, launcher):
    """stress(options, ranks=1, check=0): the datasets of a run of petsam-stress, or what it says."""

    def run(ranks=1, check=0, **options):
        options = {"output": "s.h5", **options}
        done = conftest.execute(launcher, folder, [options], ranks, check, program=PROGRAM)
        if check:
            return done.stderr
        with h5py.File(folder / options["output"]) as f:
            return {name: data[()] for name, data in f.items() if isinstance(data, h5py.Dataset)}

    return run


def middles():
    return ",".join(repr((k + 0.5) * DEPTH / LAYERS) for k in range(LAYERS))


def layers(path, name, body=2):
    """A field of the only step, from the surface of a body down."""
    with h5py.File(path) as f:
        z, values = f["plastic/z"][()], f[f"plastic/{name}"][0]
    return values[z > 0] if body == 2 else values[z < 0][::-1]


def test_fields_have_their_layers_and_scales(folder):
    with h5py.File(folder / "both.h5") as f:
        group = f["plastic"]
        strain = group["plastic_strain"]
        assert strain.shape == (1, 2 * LAYERS, 19, 24) and strain.attrs["units"] == "1"
        assert [dimension[0].name for dimension in strain.dims] == ["/time", "/plastic/z", "/plastic/y", "/plastic/x"]
        assert group["z"][()] == pytest.approx((np.arange(-LAYERS, LAYERS) + 0.5) * DEPTH / LAYERS)
        assert np.array_equal(group["x"][()], f["x"][()]) and np.array_equal(group["y"][()], f["y"][()])
        assert np.array_equal(strain[0].max(axis=0), f["plastic_strain"][0])
        assert set(group) == {"x", "y", "z", "plastic_strain"} | {
            f"{name}_{part}" for name in ("plastic_strain", "residual_stress") for part in PARTS
        }
        tensor = {part: group[f"plastic_strain_{part}"][0] for part in PARTS}
    assert np.abs(tensor["xx"] + tensor["yy"] + tensor["zz"]).max() < 1e-12 * strain_of(tensor).max()
    # one step of a virgin body along one direction: the strain's own length is what has accumulated, or a little less
    with h5py.File(folder / "both.h5") as f:
        assert strain_of(tensor) == pytest.approx(f["plastic/plastic_strain"][0], abs=1e-9)
    with h5py.File(folder / "none.h5") as f:
        assert "plastic" not in f


def test_numbers_say_which_layers_have_yielded(folder):
    """They have more than 1 % of the maximum; the margin are the layers below, or the cells to the border if fewer."""
    with h5py.File(folder / "two.h5") as f:
        most = f["plastic/plastic_strain"][0].max(axis=(1, 2))
        strain, history = f["plastic/plastic_strain"][0].max(axis=0), {n: f["history"][n][0] for n in f["history"]}
    spans = np.flatnonzero(most > 0.01 * most.max())
    rows, columns = np.nonzero(strain > 0.01 * most.max())
    border = min(rows.min(), columns.min(), 18 - rows.max(), 23 - columns.max())
    assert 2 < history["yielded_layers"] == len(spans) < LAYERS
    assert history["yield_margin"] == min(LAYERS - 1 - spans[-1], border)


def strain_of(e):
    """Equivalent strain of a tensor."""
    square = sum(e[part] ** 2 for part in PARTS[:3]) + 2 * sum(e[part] ** 2 for part in PARTS[3:])
    return np.sqrt(2 / 3 * square)


def test_residual_stress_balances_itself(petsam, tmp_path):
    """No force acts across any depth of a periodic body; along the surface one does, as its mean strain is held."""
    petsam(dict(CASE, body2_yield=YIELD, elasticity="periodic", output="p.h5"))
    for part in PARTS:
        stress = layers(tmp_path / "p.h5", f"residual_stress_{part}")
        means = np.abs(stress.mean(axis=(1, 2))).max() / np.abs(stress).max()
        assert means < 1e-12 if "z" in part else part == "xy" or means > 1e-4, part


def test_where_a_body_yields_its_stress_is_the_yield_stress(folder, stress):
    """Tractions and plastic strain together, at the middles of layers; elsewhere it is less."""
    for body in 1, 2:
        mises = stress(input="both.h5", body=body, depths=middles(), quantities="mises")["mises"][0]
        strain = layers(folder / "both.h5", "plastic_strain", body)
        assert (strain > 1e-5).sum() > 100
        assert mises[strain > 1e-5] == pytest.approx(YIELD, rel=1e-6)
        assert mises.max() < YIELD * (1 + 1e-6)


def test_bulk_stress_takes_part_in_yielding(petsam, folder, stress):
    """The von Mises stress of tractions, plastic strain and bulk stress is the yield stress."""
    bulk = dict(bulk2_stress_xx=150e6, bulk2_stress_yy=-120e6, bulk2_stress_xy=80e6)
    petsam(dict(CASE, body2_yield=YIELD, load_n=40, output=str(folder / "bulk.h5"), **bulk))
    mises = stress(input="bulk.h5", body=2, depths=middles(), quantities="mises")["mises"][0]
    strain = layers(folder / "bulk.h5", "plastic_strain")
    assert (strain > 1e-5).sum() > 100
    assert mises[strain > 1e-5] == pytest.approx(YIELD, rel=1e-6) and mises.max() < YIELD * (1 + 1e-6)


def test_surface_bears_the_tractions(folder, stress):
    with h5py.File(folder / "two.h5") as f:
        p, q = f["pressure"][0], f["shear_x"][0]
    found = stress(input="two.h5", depths=0)
    assert found["stress_zz"][0, 0] == pytest.approx(-p, abs=1e-6 * p.max())
    assert found["stress_xz"][0, 0] == pytest.approx(-q, abs=1e-6 * p.max())
    one = layers(folder / "two.h5", "residual_stress_xx")
    elastic = stress(input="one.h5", body=2, depths=0)
    assert np.abs(one[0]).max() > 5e6 and elastic["stress_xx"].shape == found["stress_xx"].shape


def test_two_equal_bodies_have_mirrored_stresses(folder, stress):
    """The shear on one is against that on the other: their stresses are those of each other seen from behind."""
    one, two = (stress(input="both.h5", body=body, depths=middles()) for body in (1, 2))
    for part in PARTS:
        mirrored = -1 if part in ("xz", "yz") else 1
        seen = one[f"stress_{part}"][0, :, ::-1, ::-1] * mirrored
        assert seen == pytest.approx(two[f"stress_{part}"][0], abs=1e-3 * YIELD), part


def test_body_that_does_not_yield_has_the_stress_of_its_tractions(stress):
    """That of the other body is the same, whether it has yielded or not."""
    saved = stress(input="two.h5", body=1, depths="0:0.3mm:3")
    bare = stress(input="none.h5", body=1, depths="0:0.3mm:3")
    for part in PARTS:
        assert np.array_equal(saved[f"stress_{part}"], bare[f"stress_{part}"])


@pytest.mark.parametrize("ranks", [1, 3])
def test_sections_are_lines_of_the_maps(stress, ranks):
    depths = "0,0.04mm,0.11mm,0.3mm"
    maps = stress(input="both.h5", depths=depths, ranks=ranks)
    along = stress(input="both.h5", depths=depths, section="y=0", ranks=ranks)
    across = stress(input="both.h5", depths=depths, section="x=1e-5", ranks=ranks)
    for part in PARTS:
        name = f"stress_{part}"
        assert along[name][0, :, 0] == pytest.approx(maps[name][0, :, 9], abs=1e-6 * YIELD)
        assert across[name][0, :, :, 0] == pytest.approx(maps[name][0, :, :, 12], abs=1e-6 * YIELD)


def test_ranks_give_the_same_bits(stress):
    for words in dict(section="y=0"), {}:
        one, three = (stress(input="both.h5", depths="0:0.3mm:5", ranks=ranks, **words) for ranks in (1, 3))
        assert all(np.array_equal(one[name], three[name]) for name in one)


def test_what_is_not_known_is_refused(stress):
    assert "-output_fields usual,plastic" in stress(input="none.h5", depths=0, check=2)
    said = stress(input="two.h5", depths="0:0.4mm:3", check=2)
    assert "-depths: 0.0004 m" in said and "at 0.0003 m" in said and "petsam -help plastic" in said
    assert "-passing" in stress(input="two.h5", depths="0:0.2mm:3", fatigue="swt", section="y=0", passing=True, check=2)


@pytest.mark.parametrize(
    "name, value, says",
    [
        ("stresses_of", None, "body 2 yields"),
        ("stresses_of", "", "body 2 yields"),
        ("stresses_of", "p" * 300, "body 2 yields"),
        ("stresses_of", "plastic,plastic", "names plastic twice"),
        ("plastic_layers", None, "lacks the attribute plastic_layers"),
        ("plastic_layers", [12.0, 0.0, 1.0], "body 2 yields"),
        (
            "plastic_layers",
            [0.0, 12.5, 1.0],
            "number 1 of plastic_layers is 12.5: expected a whole number from 0 to 1000000",
        ),
        ("plastic_layers", [0.0, 12.0, np.nan], "number 2 of plastic_layers is nan"),
        ("plastic_layers", [0.0, 12.0, 2.0], "plastic_layers is damaged: its last number is 2, expected 0 or 1"),
        ("plastic_layers", [0.0, 12.0], "plastic_layers is not what petsam writes"),
    ],
)
def test_stresses_that_are_not_named_are_missed(folder, stress, name, value, says):
    """Otherwise they would be left out in silence: also in files of a petsam that did not name them."""
    for source in "two.h5", "none.h5":
        shutil.copy(folder / source, folder / "damaged.h5")
        with h5py.File(folder / "damaged.h5", "r+") as f:
            del f.attrs[name]
            if value is not None:
                f.attrs[name] = value
        assert says in stress(input="damaged.h5", depths=0, check=3)


def test_parts_of_a_run_have_the_same_layers(petsam, launcher, tmp_path):
    """Otherwise those of another group, or other depths, would be read in silence."""
    case = dict(CASE, body2_yield=YIELD, load_n=None, load_tx=None, history="h.csv", output="r.h5")
    rows = ["time,load_n", "1,40", "2,60"]
    (tmp_path / "h.csv").write_text("\n".join(rows[:2]))
    petsam(dict(case, checkpoint="c.h5", checkpoint_every=1))
    (tmp_path / "h.csv").write_text("\n".join(rows))
    petsam(dict(case, restart=next(tmp_path.glob("c.h5*")).name))
    words = dict(input="r.h5", output="s.h5", depths="0.05mm", steps="1:2")
    conftest.execute(launcher, tmp_path, [words], 1, 0, program=PROGRAM)
    with h5py.File(tmp_path / "r.part2.h5", "r+") as f:
        f.attrs.update(stresses_of="other,plastic", other_layers=f.attrs["plastic_layers"])
        f.copy("plastic", "other")
    said = conftest.execute(launcher, tmp_path, [words], 1, 3, program=PROGRAM).stderr
    assert "its stresses in layers are not those of the part before it" in said


def test_python_reads_the_layers(folder):
    with petsam.open(folder / "two.h5") as results:
        assert (
            results.layer_z.size == LAYERS and len(results.layered) == 13 and "plastic/plastic_strain" in str(results)
        )
        field = results.field("plastic/residual_stress_zz", rows=slice(3, 9), columns=slice(2, 20), stride=2)
        assert np.array_equal(field, layers(folder / "two.h5", "residual_stress_zz")[:, 3:9:2, 2:20:2])
    with petsam.open(folder / "none.h5") as results, pytest.raises(petsam.Error, match="usual,plastic"):
        _ = results.layer_z


# ---------------------------------------------------------------- stress before any load


def mean_of(profile, column):
    """Means over the layers of a profile that is linear between its rows, and 0 below the last."""
    depth, values = np.array(profile).T[[0, column]]
    places = (np.arange(LAYERS * 100) + 0.5) * DEPTH / LAYERS / 100
    return np.interp(places, depth, values, right=0.0).reshape(LAYERS, 100).mean(axis=1)


def write_profile(path, rows):
    path.write_text("depth,stress_xx,stress_yy\n" + "\n".join(",".join(map(repr, row)) for row in rows))


PEENED = [(0.0, -2e8, -1e8), (0.05e-3, -3.5e8, -3e8), (0.12e-3, 8e7, 5e7), (0.25e-3, 0.0, 0.0)]


def test_initial_stress_is_there_before_any_yielding(petsam, tmp_path):
    write_profile(tmp_path / "i.csv", PEENED)
    for elasticity in "halfspace", "periodic":
        case = dict(CASE, body1_yield=YIELD, body1_initial_stress="i.csv", load_n=0.5, load_tx=0, output="r.h5")
        petsam(dict(case, elasticity=elasticity))
        for column, part in (1, "xx"), (2, "yy"):
            found = layers(tmp_path / "r.h5", f"residual_stress_{part}", 1)
            assert found == pytest.approx(np.broadcast_to(mean_of(PEENED, column)[:, None, None], found.shape), abs=1e5)
        assert not layers(tmp_path / "r.h5", "plastic_strain", 1).any()


def test_yielding_begins_where_the_sum_of_both_stresses_comes_to_the_yield_stress(petsam, launcher, tmp_path):
    """The stress of an elastic contact, which petsam-stress knows, and the profile."""
    write_profile(tmp_path / "i.csv", PEENED)
    petsam(dict(CASE, body2_yield=1e10, load_n=12, load_tx=3, output="e.h5"))
    words = dict(input="e.h5", output="s.h5", depths=middles())
    conftest.execute(launcher, tmp_path, [words], 1, 0, program=PROGRAM)
    with h5py.File(tmp_path / "s.h5") as f:
        s = {part: f[f"stress_{part}"][0] for part in PARTS}
    bare = mises_of(s).max()
    for column, part in (1, "xx"), (2, "yy"):
        s[part] = s[part] + mean_of(PEENED, column)[:, None, None]
    most = mises_of(s).max()
    assert abs(most / bare - 1) > 0.02
    for part, yields in (1.01, False), (0.99, True):
        case = dict(CASE, body2_yield=part * most, body2_initial_stress="i.csv", load_n=12, load_tx=3, output="y.h5")
        petsam(case)
        assert layers(tmp_path / "y.h5", "plastic_strain").any() == yields


def mises_of(s):
    xx, yy, zz, xy, xz, yz = (s[part] for part in PARTS)
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.sqrt(normal / 2 + 3 * (xy**2 + xz**2 + yz**2))


def test_peened_body_that_yields_has_the_yield_stress(petsam, launcher, tmp_path):
    """From the sum of all stresses; a restart without the file, or with another one, is refused."""
    write_profile(tmp_path / "i.csv", PEENED)
    case = dict(CASE, body2_yield=YIELD, body2_initial_stress="i.csv", output="r.h5", steps=2)
    petsam(dict(case, checkpoint="c.h5", checkpoint_every=1))
    words = dict(input="r.h5", output="s.h5", depths=middles(), quantities="mises")
    conftest.execute(launcher, tmp_path, [words], 2, 0, program=PROGRAM)
    with h5py.File(tmp_path / "s.h5") as f, h5py.File(tmp_path / "r.h5") as results:
        mises, strain = f["mises"][-1], results["plastic/plastic_strain"][-1]
    assert (strain > 1e-5).sum() > 50 and mises[strain > 1e-5] == pytest.approx(YIELD, rel=1e-6)
    assert mises.max() < YIELD * (1 + 1e-6)
    write_profile(tmp_path / "i.csv", [(0.0, -1e8, -1e8), (0.1e-3, 0.0, 0.0)])
    kept = next(tmp_path.glob("c.h5*")).name
    assert "body2_initial_stress" in petsam(dict(case, restart=kept, output="n.h5"), check=2).stderr
