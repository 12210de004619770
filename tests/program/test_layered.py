"""Layered bodies: spheres against integral equations, torsion and sliding of coated bodies, waves, wrong input."""

import h5py
import numpy as np
import pytest

from support import assert_close, assert_same

# Lengths in units of the contact radius A on a sphere of radius 1 m; the substrate's modulus is E, its ratio 0.3.
A, E = 1e-3, 1e9
HARD = [(4, 0.25, 0.5)]
SOFT = [(0.1, 0.45, 0.5)]
MU = 0.1


def body(number, layers=(), young=E):
    """Options of a body whose layers (modulus over E, Poisson's ratio, thickness over A) are given."""
    name = f"body{number}_"
    options = {name + "young": young, name + "poisson": 0.3}
    for k, word in enumerate(("young", "poisson", "thickness")):
        if layers:
            options[name + "layer_" + word] = [layer[k] * (E, 1, A)[k] for layer in layers]
    return options


def sphere(layers, width, n=256, base=E, other=None, **more):
    """A sphere on a coated body, rigid unless its layers are given; the grid's width in units of A."""
    first = body(1, other) if other else dict(body1_young=float("inf"))
    return dict(
        **first,
        **body(2, layers, base),
        gap_type="sphere",
        gap_radius1=1.0,
        gap_radius2=float("inf"),
        grid_n=n,
        grid_size=width * A,
        output_fields="all",
        **more,
    )


def peak(r):
    """The pressure at the origin, which is a corner of four cells."""
    n = r.pressure.shape[0] // 2
    p = r.pressure[n - 2 : n + 2, n - 2 : n + 2]
    x = np.arange(4) - 1.5
    return np.polyfit((x[:, None] ** 2 + x**2).ravel(), p.ravel(), 1)[1]


# Modulus and thickness of one layer with Poisson's ratio 0.3, and contact radius, peak and approach, all over those of
# the substrate alone, by integral equations (11 digits).
RIGID_SPHERES = [
    (0.01, 1, 3.319842098, 0.110383191, 6.114887373),
    (0.1, 0.1, 1.270815613, 0.735112125, 1.202485789),
    (0.5, 1, 1.206607645, 0.704682272, 1.227128046),
    (4, 0.3, 0.826240554, 1.163449429, 0.907981488),
    (10, 0.3, 0.710121732, 1.273788556, 0.859776394),
    (100, 0.3, 0.300585305, 9.697377324, 0.614463129),
]


@pytest.mark.parametrize("young, thickness, radius, pressure, approach", RIGID_SPHERES)
def test_rigid_sphere_on_one_layer(young, thickness, radius, pressure, approach, solve):
    load = 4 / 3 * E / 0.91 * A**3
    r = solve(sphere([(young, 0.3, thickness)], 2.6 * radius), dict(load_n=load))
    assert peak(r) == pytest.approx(1.5 * load / (np.pi * A**2) * pressure, rel=3e-5)
    assert r["disp_z"] == pytest.approx(A**2 * approach, rel=1e-5)
    assert r["contact_area"] == pytest.approx(np.pi * (radius * A) ** 2, rel=1e-3)


@pytest.mark.parametrize(
    "layers, base, load, approach, tolerance",
    [
        (HARD, E, 2.9554498519, 1.4078716098, 1e-5),
        (SOFT, E, 0.33284904952, 0.61181692726, 1e-5),
        ([(1, 0.3, 0.1)], float("inf"), 11.10263482, 0.51293659007, 1e-4),
        ([(1, 0.5, 0.5)], float("inf"), 4.6188816431, 0.45490282156, 1e-4),
    ],
)
def test_approach_at_a_radius(layers, base, load, approach, tolerance, solve):
    """Also on a rigid base, there of nearly and of fully incompressible layers."""
    r = solve(sphere(layers, 2.6, base=base), dict(load_n=load * E * A**3))
    assert r["disp_z"] == pytest.approx(approach * A**2, rel=tolerance)
    assert r["contact_area"] == pytest.approx(np.pi * A**2, rel=2e-3)


@pytest.mark.parametrize(
    "layers, load, pressure, normal, torsional",
    [
        (HARD, 2.9554498519, 1.1558854318, 2.920029573, 7.1857743038),
        (SOFT, 0.33284904952, 0.18502222302, 1.0104898017, 0.22334887107),
    ],
)
def test_peak_and_stiffness_at_a_radius(layers, load, pressure, normal, torsional, solve):
    """The stiffness in approach, and in torsion when all sticks."""
    r = solve(sphere(layers, 2.6, friction=MU, coupling="none", stiffness=True), dict(load_n=load * E * A**3))
    assert peak(r) == pytest.approx(pressure * E * A, rel=3e-5)
    assert r["stiffness"][0, 0] == pytest.approx(normal * E * A, rel=2e-3)
    assert r["stiffness_reversal"][5, 5] == pytest.approx(torsional * E * A**3, rel=5e-3)


@pytest.mark.parametrize(
    "layers, load, moment, rotation",
    [(HARD, 1.477724926, 0.591408579, 0.571777852), (SOFT, 0.1664245248, 0.531573613, 2.577468433)],
)
def test_torsion_of_alike_coated_bodies(layers, load, moment, rotation, solve):
    """Partial slip that is known: alike bodies are not coupled, and torsion moves no surface radially."""
    error = []
    for n in (64, 128):
        case = sphere(layers, 2.6, n=n, other=layers, friction=MU, load_n=load * E * A**3)
        r = solve(case, dict(load_mz=moment * MU * load * E * A**4))
        error.append(abs(r["rot_z"] / (rotation * MU * A) - 1))
        assert r["coupling_iterations"] <= 1
    assert error[1] < 1e-3 and error[1] < 0.5 * error[0]


@pytest.mark.parametrize("layers, load, displacement", [(HARD, 1.477724926, 0.047787), (SOFT, 0.1664245248, 0.07486)])
def test_tangential_force_on_alike_coated_bodies(layers, load, displacement, solve):
    case = sphere(layers, 2.5, other=layers, friction=MU, load_n=load * E * A**3)
    r = solve(case, dict(load_tx=0.6 * MU * load * E * A**3))
    assert r["disp_x"] == pytest.approx(displacement * A**2, rel=1e-4)


@pytest.mark.parametrize(
    "young, thickness, load, most",
    [(0.01, 0.01, 0.597, 12), (0.1, 0.3, 0.341, 12), (10, 0.1, 2.05, 22), (100, 0.01, 1.65, 45), (100, 0.1, 3.08, 40)],
)
def test_iterations_on_films(young, thickness, load, most, solve):
    """Also of a hard film on a soft body, where the inverse of the symbols alone needs 130 iterations."""
    r = solve(sphere([(young, 0.3, thickness)], 2.6, n=128), dict(load_n=load * E * A**3))
    assert r["contact_area"] == pytest.approx(np.pi * A**2, rel=0.05)
    assert r["normal_iterations"] <= most


@pytest.mark.parametrize("young, poisson, thickness, n", [(180, 0.2, 0.0165, 192), (200, 0.3, 0.0091, 256)])
def test_thin_stiff_films_converge(young, poisson, thickness, n, solve):
    """The preconditioner is too strong for them: steps stay short, also over gradient steps."""
    r = solve(sphere([(young, poisson, thickness)], 2.6, n=n), dict(load_n=4 / 3 * E / 0.91 * A**3))
    assert r["normal_iterations"] <= 80


def test_coupled_bodies_slip_at_much_friction(solve):
    """A hard film on one body: coupled, with friction 1; solved and checked, and the same on any number of ranks."""
    case = sphere(HARD, 2.6, n=48, other=SOFT, friction=1.0, load_n=0.2 * E * A**3)
    more = dict(load_tx=0.05 * E * A**3, steps=2)
    one, two = (solve(case, more, ranks=ranks) for ranks in (1, 3))
    assert one["coupling_iterations"] > 1
    assert_same(one, two, 0)


def test_wave_in_full_contact(tmp_path, solve):
    """Periodic bodies: a wave takes the pressure of its symbol, c = 1.04309842376544 at k h = 1 (E = 1, h = 1)."""
    width, height, n = 2 * np.pi * A, 1e-8, 40
    x = (np.arange(n) + 0.5) / n
    with h5py.File(tmp_path / "wave.h5", "w") as f:
        f["height"] = np.tile(height * (1 - np.cos(2 * np.pi * x)), (6, 1))
    amplitude = height / A * E / 1.04309842376544
    r = solve(
        dict(body1_young=float("inf"), **body(2, [(4, 0.25, 1)]), elasticity="periodic"),
        dict(gap_type="file", gap_file=tmp_path / "wave.h5", grid_n=(n, 6), grid_size=(width, width / 5)),
        dict(load_n=1.5 * amplitude * width**2 / 5),
    )
    assert_close(r.pressure, np.tile(amplitude * (1.5 + np.cos(2 * np.pi * x)), (6, 1)), 1e-7)


# ---------------------------------------------------------------- what is refused, and what is advised

SMALL = sphere([(2, 0.3, 1), (3, 0.2, 0.5)], 2.6, n=32, load_n=0.5 * E * A**3, friction=0.2)


def test_one_poisson_s_ratio_is_for_all_layers(solve):
    one = solve({**SMALL, "body2_layer_poisson": 0.3})
    two = solve({**SMALL, "body2_layer_poisson": (0.3, 0.3)})
    assert_same(one, two, 0)


@pytest.mark.parametrize(
    "change, says",
    [
        (
            dict(body2_layer_young=[E, E], body2_layer_poisson=0.3),
            "all layers of body 2 are of the substrate's material",
        ),
        (dict(body2_layer_thickness=[A / 100, A]), "the layer at the surface of body 2 is 0.12 cells thick"),
        (dict(body2_layer_thickness=[1.0, A]), "-body2_layer_thickness 1 is"),
    ],
)
def test_layers_that_are_hardly_meant_are_told(change, says, petsam):
    assert says in petsam({**SMALL, **change}).stderr


def test_restart_with_other_layers_is_refused(petsam):
    petsam(SMALL, dict(steps=3, checkpoint="state.h5", checkpoint_every=2))
    again = dict(steps=3, restart="state.h5")
    for change in (dict(body2_layer_thickness=[A, A]), dict(body2_layer_young=[2 * E, 4 * E])):
        assert f"-{list(change)[0]} is" in petsam({**SMALL, **change}, again, check=2).complaint[0]
    none = {f"body2_layer_{name}": None for name in ("young", "poisson", "thickness")}
    assert "is given there, and not here" in petsam({**SMALL, **none}, again, check=2).complaint[0]


def test_layers_are_recorded(solve):
    r = solve(SMALL)
    with h5py.File(r.path) as f:
        assert list(f.attrs["body2_layer_thickness"]) == [A, 0.5 * A]
        assert list(f.attrs["body2_layer_young"]) == [2 * E, 3 * E]
        assert "body1_layer_young" not in f.attrs


# ---------------------------------------------------------------- stresses

SLIDING = sphere([(4, 0.25, 0.5), (0.5, 0.4, 0.3)], 2.6, n=48, load_n=0.5 * E * A**3, friction=0.3)
SLIDING |= dict(load_tx=0.1 * E * A**3)
TRACTIONS, OTHERS = ("zz", "xz", "yz"), ("xx", "yy", "xy")


def stresses(f, names, depth):
    return np.array([f["stress_" + name][0, depth] for name in names])


def strain(f, depth, young, poisson):
    """Strains along x and y, and shear, by Hooke's law."""
    s = dict(zip(OTHERS + TRACTIONS, stresses(f, OTHERS + TRACTIONS, depth)))
    of = [s["xx"] - poisson * (s["yy"] + s["zz"]), s["yy"] - poisson * (s["xx"] + s["zz"]), (1 + poisson) * s["xy"]]
    return np.array(of) / young


def test_stresses_through_layers(solve, stress, tmp_path):
    """Both sides of each interface: tractions and strains are continuous; the same on three ranks and on a section."""
    r = solve(SLIDING)
    case = dict(input=r.path, depths=f"0,{0.2 * A},{0.5 * A},{0.8 * A},{A}")
    printed = stress(dict(case, output="maps.h5")).stdout
    on_line = stress(dict(case, output="line.h5", section="y=1e-5"), ranks=3).stdout
    with h5py.File(tmp_path / "maps.h5") as f, h5py.File(tmp_path / "line.h5") as line:
        for k, text, file in ((k, *of) for k in (1, 2) for of in ((printed, f), (on_line, line))):
            none = f"layer {k}: tension across the interface below: none\n" in text
            assert none == (file[f"history/layer{k}_tension_max"][0] <= 0)
        assert f["z"][:] == pytest.approx(np.array([0, 0.2, 0.5, 0.5, 0.8, 0.8, 1]) * A, rel=1e-12)
        assert np.all(np.diff(f["z"][:]) > 0)
        for above, below, upper, lower in ((2, 3, (4, 0.25), (0.5, 0.4)), (4, 5, (0.5, 0.4), (1, 0.3))):
            tractions = stresses(f, TRACTIONS, above)
            assert_close(stresses(f, TRACTIONS, below), tractions, 1e-10)
            one, other = strain(f, above, upper[0] * E, upper[1]), strain(f, below, lower[0] * E, lower[1])
            assert_close(other, one, 1e-10)
            assert np.abs(stresses(f, ("xx",), above) - stresses(f, ("xx",), below)).max() > 0.1 * np.abs(one).max() * E
        row = np.argmin(np.abs(f["y"][:] - line["y"][0]))
        for name in TRACTIONS + OTHERS:
            wide = f["stress_" + name][0][:, row]
            assert_close(line["stress_" + name][0, :, 0], wide, 1e-10)
        mises, history = f["mises"][0], f["history"]
        for name, depths in (("layer1", (0, 1, 2)), ("layer2", (3, 4)), ("substrate", (5, 6))):
            assert history[name + "_mises_max"][0] == max(mises[k].max() for k in depths), name
            xx, yy, zz, xy, xz, yz = (f["stress_" + n][0][list(depths)] for n in ("xx", "yy", "zz", "xy", "xz", "yz"))
            matrices = np.moveaxis(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]), (0, 1), (-2, -1))
            largest = np.linalg.eigvalsh(matrices).max()
            assert history[name + "_principal_1_max"][0] == pytest.approx(largest, rel=1e-9), name
        for layer, depth in (("layer1", 2), ("layer2", 4)):
            assert history[layer + "_tension_max"][0] == f["stress_zz"][0, depth].max()
            shear = np.hypot(f["stress_xz"][0, depth], f["stress_yz"][0, depth]).max()
            assert history[layer + "_shear_max"][0] == pytest.approx(shear, rel=1e-14)


def test_layers_take_the_strains_of_the_bulk_stress_and_their_residual_stress(petsam, stress, tmp_path):
    case = {**SLIDING, "friction": None, "load_tx": None}
    rows = [(0, -3e6, -2e6), (0.5 * A, -3e6, -2e6), (0.5 * A, 1e5, 4e5), (0.8 * A, 1e5, 4e5)]
    text = "depth,stress_xx,stress_yy\n" + "".join(f"{z!r},{xx},{yy}\n" for z, xx, yy in rows)
    (tmp_path / "i.csv").write_text(text)
    more = dict(bulk2_stress_xx=1e6, bulk2_stress_yy=-2e5, bulk2_stress_xy=3e5, body2_initial_stress="i.csv")
    for name, options in (("none", {}), ("all", more)):
        petsam(case, options, dict(output=f"{name}.h5"))
        stress(dict(input=f"{name}.h5", output=f"{name}-s.h5", depths=f"{0.1 * A},{0.6 * A},{2 * A}"))
    with h5py.File(tmp_path / "all-s.h5") as f, h5py.File(tmp_path / "none-s.h5") as none:
        for depth, young, poisson, residual in (
            (0, 4, 0.25, (-3e6, -2e6)),
            (1, 0.5, 0.4, (1e5, 4e5)),
            (2, 1, 0.3, (0, 0)),
        ):
            added = [f["stress_" + name][0, depth] - none["stress_" + name][0, depth] for name in OTHERS]
            xx, yy = 1e6 + 0.3 * 2e5, -2e5 - 0.3 * 1e6
            own = young / (1 - poisson**2)
            expected = own * (xx + poisson * yy), own * (yy + poisson * xx), young * 1.3 / (1 + poisson) * 3e5
            for value, bulk, rest in zip(added, expected, (*residual, 0)):
                assert_close(value, np.full_like(value, bulk + rest), 1e-3)


def test_stress_before_any_load_is_added_to_an_elastic_body(petsam, stress, tmp_path):
    """By petsam-stress, linear between the rows and 0 below the last; it changes nothing else."""
    (tmp_path / "i.csv").write_text(f"depth,stress_xx,stress_yy\n0,-3e6,-2e6\n{0.2 * A},-4e6,-1e6\n{0.6 * A},0,5e5\n")
    case = sphere([], 2.6, n=48, load_n=0.5 * E * A**3, friction=0.3, load_tx=0.1 * E * A**3)
    for name, more in (("none", {}), ("all", dict(body2_initial_stress="i.csv"))):
        petsam(case, more, dict(output=f"{name}.h5"), ranks=2)
        stress(dict(input=f"{name}.h5", output=f"{name}-s.h5", depths=f"0,{0.1 * A},{0.4 * A},{0.7 * A}"))
    with h5py.File(tmp_path / "all-s.h5") as f, h5py.File(tmp_path / "none-s.h5") as none:
        for part, values in dict(xx=(-3e6, -3.5e6, -2e6, 0), yy=(-2e6, -1.5e6, -2.5e5, 0), zz=(0, 0, 0, 0)).items():
            added = f["stress_" + part][0] - none["stress_" + part][0]
            assert_close(added, np.broadcast_to(np.array(values)[:, None, None], added.shape), 1e-3)
    with h5py.File(tmp_path / "all.h5", "r+") as f:
        f.attrs["body2_initial_stress"] = f.attrs["body2_initial_stress"][:-1]
    told = stress(dict(input="all.h5", output="s.h5", depths="0"), check=3).stderr
    assert "the attribute body2_initial_stress is not rows of depth, stress_xx, stress_yy" in told
    refused = petsam(dict(SLIDING, body1_initial_stress="i.csv"), check=2).complaint[0]
    assert "-body1_initial_stress has no effect: -body1_young inf is a rigid body" in refused


@pytest.mark.parametrize(
    "depths, says",
    [
        (f"{0.4 * A}+", f"-depths: {0.4 * A:g}+ names a side of an interface, and there is none"),
        (f"{0.5 * A}+,{0.5 * A}-", "expected depths that increase"),
        (f"{0.5 * A},{0.9 * A}", f"{0.9 * A:g} m is in the rigid base, which begins at {0.8 * A:g} m"),
        (f"{0.8 * A}+", "is in the rigid base"),
    ],
)
def test_depths_that_layers_do_not_have_are_refused(depths, says, solve, stress):
    r = solve({**SLIDING, "body2_young": float("inf"), "body2_poisson": None})
    assert says in stress(dict(input=r.path, output="s.h5", depths=depths), check=2).stderr


def test_one_side_of_an_interface(solve, stress, tmp_path):
    r = solve(SLIDING)
    stress(dict(input=r.path, output="both.h5", depths=f"{0.5 * A}"))
    for k, sign in enumerate("-+"):
        stress(dict(input=r.path, output=f"one{k}.h5", depths=f"{0.5 * A}{sign}"))
        with h5py.File(tmp_path / "both.h5") as both, h5py.File(tmp_path / f"one{k}.h5") as one:
            assert np.array_equal(one["stress_xx"][0, 0], both["stress_xx"][0, k])


def test_fatigue_constants_of_layers_and_substrate(petsam, stress, tmp_path):
    (tmp_path / "h.csv").write_text("time,load_n,load_tx\n0,0.2,0\n1,0.2,0.01\n2,0.2,-0.01\n")
    petsam({k: v for k, v in SLIDING.items() if k not in ("load_n", "load_tx")}, dict(history="h.csv", output="r.h5"))
    depths = (0.1, 0.6, 2)

    def findley(k, name):
        case = dict(input="r.h5", output=name, quantities="none", fatigue="findley", section="y=0", steps="all")
        stress({**case, "depths": [d * A for d in depths], "fatigue_findley_k": k})
        with h5py.File(tmp_path / name) as f:
            return f["findley"][:]

    constants = (0.4, 0.1, 0.25)
    each = findley(constants, "each.h5")
    for depth, k in enumerate(constants):
        assert np.array_equal(each[depth], findley(k, f"one{depth}.h5")[depth])
    refused = dict(input="r.h5", output="no.h5", fatigue="findley,crossland", steps="all", fatigue_crossland_alpha=0.1)
    for k, says in (
        ("0.4,0.1", "-fatigue: lists of 2 constants for 3 materials in depth: give one number, or one for each layer"),
        ("0.4,0.1,0.2", "-fatigue_findley_k: 3 numbers, but 2 in another list: give one number, or one for each layer"),
    ):
        more = dict(fatigue_crossland_alpha="0.1,0.2") if "another" in says else {}
        assert says in stress({**refused, "fatigue_findley_k": k, **more}, check=2).stderr


# ---------------------------------------------------------------- constants that vary with the depth

NO_LISTS = {f"body2_layer_{name}": None for name in ("young", "poisson", "thickness")}


def test_profile_is_cut_into_layers_of_the_constants_at_their_middle(petsam, tmp_path):
    """A layer of constant E, a jump, and E that falls along two lines: 1, 32 and 31 layers, as if they were listed."""
    rows = (0, 4 * E, 0.2), (0.3 * A, 4 * E, 0.2), (0.3 * A, 2 * E, 0.3), (A, E, 0.25), (2 * A, E / 2, 0.25)
    lines = ["depth, young, poisson  # m, Pa", *(", ".join(map(str, row)) for row in rows)]
    (tmp_path / "p.csv").write_text("\n".join(lines) + "\n")
    case = {**SMALL, **NO_LISTS}
    petsam(case, dict(body2_layer_file="p.csv", output="file.h5"))
    at, below = (np.arange(32) + 0.5) / 32, (np.arange(31) + 0.5) / 31
    lists = dict(
        body2_layer_young=[4 * E, *(2 * E - at * E), *(E - below * E / 2)],
        body2_layer_poisson=[0.2, *(0.3 - 0.05 * at), *[0.25] * 31],
        body2_layer_thickness=[0.3 * A, *[0.7 * A / 32] * 32, *[A / 31] * 31],
    )
    petsam(case, lists, dict(output="lists.h5"))
    with h5py.File(tmp_path / "file.h5") as f, h5py.File(tmp_path / "lists.h5") as listed:
        for name, values in lists.items():
            assert f.attrs[name] == pytest.approx(values, rel=1e-13)
        assert_close(f["pressure"][0], listed["pressure"][0], 1e-7 * listed["pressure"][0].max())


def test_profile_of_too_many_rows_is_refused(petsam, tmp_path):
    (tmp_path / "p.csv").write_text("depth,young,poisson\n" + "".join(f"{k},1e9,0.3\n" for k in range(66)))
    said = petsam({**SMALL, **NO_LISTS, "body2_layer_file": "p.csv"}, check=2).complaint[0]
    assert "p.csv: has 66 rows: expected at most 64" in said


# ---------------------------------------------------------------- wear


def test_life_tells_the_cycle_by_which_a_layer_is_worn_through(petsam, tmp_path):
    """Once, with the thickness; on request the life ends there, with all cycles before as without it."""
    rows = "time,load_tx\n" + "".join(f"{k},{f * 0.06 * E * A**3}\n" for k, f in enumerate((1, -1, 1)))
    (tmp_path / "cycle.csv").write_text(rows)
    case = {**SMALL, "history": "cycle.csv", "steps": 3, "wear_coefficient2": 1e-9, "wear_cycles": 600, "grid_n": 20}
    case["body2_layer_thickness"] = [2e-6 * A, A]
    told = petsam(case, dict(output="all.h5")).stderr
    petsam(case, dict(output="some.h5", wear_stop_layer=True))
    with h5py.File(tmp_path / "all.h5") as f, h5py.File(tmp_path / "some.h5") as some:
        cycle, depth = f["wear/cycle"][:], f["wear/depth_max2"][:]
        first = np.argmax(depth >= 2e-6 * A)
        assert 0 < first < len(depth) - 1
        says = f"after {cycle[first]:.10g} cycles: the first layer of body 2, 2e-09 m thick, is worn through"
        assert told.count("worn through") == 1 and says in told
        assert np.array_equal(some["wear/depth_max2"][:], depth[: first + 1])
    says = "-wear_stop_layer is given without -wear_cycles"
    assert says in petsam({**SMALL, "wear_coefficient2": 1e-13, "wear_stop_layer": True}, check=2).complaint[0]


@pytest.mark.parametrize(
    "attributes, names",
    [
        (dict(body2_layer_young=[E] * 40), "body2_layer_young"),
        (
            dict.fromkeys((f"body2_layer_{name}" for name in ("young", "poisson", "thickness")), [1e-3] * 200),
            "body2_layer",
        ),
        (dict(body2_layer_young="soft"), "body2_layer_young"),
        (dict(body2_layer_poisson=None), "body2_layer_poisson"),
        (dict(body2_layer_thickness=3), "body2_layer_thickness"),
    ],
)
def test_damaged_layers_in_a_file_are_refused(attributes, names, petsam, stress, tmp_path):
    petsam(SLIDING, dict(output="r.h5"))
    with h5py.File(tmp_path / "r.h5", "r+") as f:
        for name, value in attributes.items():
            f.attrs.pop(name, None)
            if value is not None:
                f.attrs[name] = value
    told = stress(dict(input="r.h5", output="s.h5", depths=f"{0.2 * A}"), check=3).stderr
    assert f"the attribute {names}" in told and "does not fit the layers" in told


def test_layers_that_couple_are_advised_to_take_steps(petsam):
    """Alike at the surface, so that only the layer couples the bodies."""
    case = sphere([(10, 0.3, 0.3)], 2.6, n=32, load_n=0.5 * E * A**3, friction=0.2, load_tx=0.05 * E * A**3)
    told = petsam({**case, "body1_young": 10 * E, "body1_poisson": 0.3}).stderr
    assert "dissimilar bodies slip while N grows" in told
