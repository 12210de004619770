"""One extension of each kind, in a file of its own that only its registry names (tests/trials): no old file changes."""

import re

import h5py
import numpy as np
import pytest

import conftest
import petsam as package
from support import ROOT, bodies, kernels
from test_plugin import build

SPHERE = dict(
    grid_n=(37, 32), grid_size=(2.4e-3, 2.2e-3), **bodies(), friction=0.3, gap_type="sphere", gap_radius1=0.1,
    gap_radius2="inf", load_n=700, output="out.h5", overwrite=True, output_fields="usual,gap",
)  # fmt: skip
MODULUS = 210e9 / (1 - 0.3**2) / 2
# a period of a wave and its contact, whose closed form is Westergaard's
LENGTH, HEIGHT = 1e-3, 1e-7
WAVE = dict(
    SPHERE, elasticity="periodic", friction=0, gap_type="wave", gap_radius1=None, gap_radius2=None, grid_n=(243, 4),
    grid_size=(LENGTH, LENGTH / 50), gap_wave_length=LENGTH, gap_wave_height=HEIGHT,
)  # fmt: skip
FULL = np.pi * MODULUS * HEIGHT / LENGTH  # mean pressure that closes the wave
AREA = LENGTH**2 / 50


@pytest.fixture(scope="module")
def trials(prefix, tmp_path_factory):
    return build(prefix, tmp_path_factory.mktemp("trials") / "trials.so", *sorted((ROOT / "tests/trials").glob("*.c")))


@pytest.fixture
def petsam(prefix, launcher, tmp_path, trials):
    """The program with the trials: petsam(options) gives what it printed; petsam.read(names) the last results."""

    def run(*options, ranks=1, check=0, program="petsam"):
        more = dict(plugin=trials)
        return conftest.execute(launcher, tmp_path, [*options, more], ranks, check, program=prefix / "bin" / program)

    def read(*names, file="out.h5"):
        with h5py.File(tmp_path / file) as f:
            return [f[name][-1] if name in f else f[f"history/{name}"][-1] for name in names]

    run.read = read
    return run


def test_each_is_short_and_named_by_its_registry_alone():
    folder = ROOT / "tests/trials"
    registry = (folder / "trials.c").read_text()
    sources = sorted(set(folder.glob("*.c")) - {folder / "trials.c"})
    assert len(sources) + 1 == len(re.findall(r"^ .*Register\(", registry, re.M)) == 13  # one has a law and a stress
    assert all(len(path.read_text().splitlines()) < 230 for path in sources)


@pytest.mark.parametrize("ranks", [1, 2])
def test_gap_has_its_closed_contact(petsam, ranks):
    """Half the mean pressure that closes the wave: Westergaard's half width and largest pressure."""
    petsam(dict(WAVE, load_n=0.3 * FULL * AREA), ranks=ranks)
    pressure, area = petsam.read("pressure", "contact_area")
    half = LENGTH / np.pi * np.arcsin(np.sqrt(0.3))
    assert area / AREA * LENGTH == pytest.approx(2 * half, rel=2e-2)  # edges in whole cells
    assert pressure.max() == pytest.approx(2 * FULL * np.sqrt(0.3), rel=2e-3)


@pytest.mark.parametrize("part, tension, ranks", [(0.2, 0.15, 1), (0.02, 0.25, 3)])
def test_contact_bears_a_constant_tension_besides_the_load(petsam, part, tension, ranks):
    """A uniform tension does not bend periodic bodies, so that the contact is Westergaard's under the sum."""
    wave = dict(WAVE, normal_rtol=1e-10)
    petsam(dict(wave, load_n=(part + tension) * FULL * AREA))
    expected = petsam.read("pressure", "gap", "contact_area")
    petsam(dict(wave, load_n=part * FULL * AREA, constant_tension=tension * FULL), ranks=ranks)
    total, gap, area, pull, load = petsam.read("pressure", "gap", "contact_area", "tension", "load_n")
    assert (pull == tension * FULL).all() and load == part * FULL * AREA
    for found, wanted in zip((total + pull, gap, area), expected):
        assert found == pytest.approx(wanted, rel=1e-6, abs=1e-7 * np.max(wanted))


@pytest.mark.parametrize("given", [{}, {"disp_z": 6e-6}])
def test_constant_tension_is_the_contact_of_surfaces_that_it_has_lifted(petsam, tmp_path, given):
    """By Love's closed form for the whole grid, which lies aside: the check knows the displacement by the tension."""
    tension, size, center = 2e7, (2.4e-3, 2.2e-3), (2e-4, -1e-4)
    x, y = (c + s * ((np.arange(n) + 0.5) / n - 0.5) for c, s, n in zip(center, size, SPHERE["grid_n"]))
    x, y = np.meshgrid(x, y)
    gap = (x**2 + y**2) / 0.2
    lifted = gap - tension * kernels(x - center[0], y - center[1], *size)["r"] / (np.pi * MODULUS)
    for name, heights in (("gap", gap), ("lifted", lifted)):
        with h5py.File(tmp_path / f"{name}.h5", "w") as f:
            f["height"] = heights
    case = dict(SPHERE, gap_type="file", gap_radius1=None, gap_radius2=None, grid_center=center)
    case.update(given, load_n=None if given else 700)
    petsam(dict(case, gap_file="gap.h5", constant_tension=tension))
    found, load, residual, fine = petsam.read("pressure", "load_n", "normal_residual", "equilibrium_residual")
    found += tension
    load += tension * np.prod(size)
    assert residual < 1e-8 and fine < 1e-12
    area = np.prod(size)
    moments = dict(load_mx=tension * area * center[1] * -1, load_my=tension * area * center[0])
    loads = {} if given else dict(load_n=700 + tension * area)
    petsam(dict(case, gap_file="lifted.h5", **moments, **loads))
    expected, borne = petsam.read("pressure", "load_n")
    assert load == pytest.approx(borne, rel=1e-6)
    assert found == pytest.approx(expected, abs=1e-6 * expected.max())


@pytest.mark.parametrize("ranks", [1, 3])
def test_condition_of_a_step_scales_friction(petsam, tmp_path, ranks):
    (tmp_path / "wet.csv").write_text("time,load_n,load_tx,wetness\n1,700,60,0\n2,700,60,0.8\n3,700,120,0.4\n")
    (tmp_path / "scaled.csv").write_text(
        "time,load_n,load_tx,friction_scale\n1,700,60,1\n2,700,60,0.6\n3,700,120,0.8\n"
    )
    found = []
    for name in "wet", "scaled":
        petsam(dict(SPHERE, load_n=None, history=f"{name}.csv"), ranks=ranks)
        found.append(petsam.read("shear_x", "slip_x", "stick_area"))
    for wet, scaled in zip(*found):
        assert wet == pytest.approx(scaled, rel=1e-6, abs=1e-6 * np.abs(scaled).max())
    said = petsam(dict(SPHERE, wetness=1.2), check=2).stderr
    assert "-wetness" in said and "1.2: expected 0 to 1" in said


@pytest.mark.parametrize("ranks", [1, 2])
def test_number_is_that_of_the_field_and_its_error_is_estimated(petsam, ranks):
    said = petsam(dict(SPHERE, square_above=1e8, errors="companion"), ranks=ranks).stdout
    p, square = petsam.read("pressure", "pressure_square")
    assert square == pytest.approx((p[p > 1e8] ** 2).sum() * 2.4e-3 * 2.2e-3 / (37 * 32), rel=1e-12)
    assert re.search(r"pressure_square/N2/m2 +[0-9.e+]+", said)
    assert "-square_above" in petsam(dict(SPHERE, square_above=-1), check=2).stderr


@pytest.mark.parametrize("ranks, more", [(1, {}), (3, dict(load_tx=60, slip_direction="end"))])
def test_stiffness_has_the_tangent_of_a_law_whose_offset_follows_the_pressure(petsam, ranks, more):
    """A soft layer; the inverse of the stiffness is the difference of two loads."""
    soft = 4e-15
    case = dict(
        SPHERE,
        **more,
        cushion=soft,
        output_fields="usual,cushion",
        stiffness=True,
        normal_rtol=1e-11,
        tangential_rtol=1e-11,
    )
    found = []
    for load in (700, 700 * (1 - 1e-4), 700 * (1 + 1e-4)):
        petsam(dict(case, load_n=load), ranks=ranks if load == 700 else 1)
        found.append(petsam.read("disp_z", "pressure", "stiffness", "cushion"))
    assert found[0][3] == pytest.approx(soft * found[0][1], abs=1e-9 * soft * found[0][1].max())
    assert 1 / found[0][2][0, 0] == pytest.approx((found[2][0] - found[1][0]) / (700 * 2e-4), rel=1e-4)
    petsam(dict(case, cushion=0, output_fields="usual"))
    assert petsam.read("stiffness")[0][0, 0] > 1.05 * found[0][2][0, 0]


def test_an_option_alone_selects_a_law(petsam):
    """Friction that grows with the pressure: all slides under the sum of mu p (1 + p/p0)."""
    for ranks in 1, 2:
        petsam(dict(SPHERE, steep_pressure=600e6, disp_x=1e-4), ranks=ranks)
        p, load = petsam.read("pressure", "load_tx")
        cell = 2.4e-3 * 2.2e-3 / (37 * 32)
        assert load == pytest.approx(0.3 * (p * (1 + p / 600e6)).sum() * cell, rel=1e-6)


def test_gradients_of_friction_that_is_no_coefficient_are_rejected(petsam):
    said = petsam(dict(SPHERE, steep_pressure=600e6, load_tx=60, slip_direction="end", gradient="energy"), check=2)
    assert "not a coefficient of friction times the pressure" in said.stderr


# wear above a threshold of p |ds|: a sphere that slides by S under N
SLIDE, LEAST, RATE = 2e-5, 2e3, 1e-15
SCAR = dict(SPHERE, threshold_wear=RATE, threshold_least=LEAST, grid_n=(93, 80), load_n=700, history="slides.csv",
            output_fields="usual,wear_depth1")  # fmt: skip


def sliding(tmp_path, steps=((700, 0), (700, 3e-5), (700, 5e-5))):
    """A history by N and disp_x, whose last step slides by SLIDE if there is no partial slip left."""
    rows = [f"{k + 1},{n},{x}" for k, (n, x) in enumerate(steps)]
    (tmp_path / "slides.csv").write_text("\n".join(["time,load_n,disp_x", *rows]) + "\n")


@pytest.mark.parametrize("ranks", [1, 3])
def test_third_law_of_wear_removes_what_is_above_its_threshold(petsam, tmp_path, ranks):
    """The pressure is Hertz's: in the last step 2 pi a2 (p0 S (1 - t3)/3 - c (1 - t2)/2) with t = c/(p0 S)."""
    sliding(tmp_path)
    petsam(dict(SCAR, load_n=None), ranks=ranks)
    with h5py.File(tmp_path / "out.h5") as f:
        volume, depth, slip = f["history/wear_volume1"][:], f["wear_depth1"][:], f["slip_x"][:]
    a = (3 * 700 * 0.1 / (4 * MODULUS)) ** (1 / 3)
    p0 = 1.5 * 700 / (np.pi * a**2)
    t = LEAST / (p0 * SLIDE)
    expected = RATE * 2 * np.pi * a**2 * (p0 * SLIDE * (1 - t**3) / 3 - LEAST * (1 - t**2) / 2)
    assert np.abs(slip[2] - slip[1])[depth[2] > 0] == pytest.approx(SLIDE, rel=1e-5)
    assert volume[2] - volume[1] == pytest.approx(expected, rel=4e-3)
    assert volume[2] == pytest.approx(depth[2].sum() * 2.4e-3 * 2.2e-3 / (93 * 80), rel=1e-12)
    wide = RATE * (p0 * SLIDE - LEAST)
    assert (depth[2] - depth[1]).max() == pytest.approx(wide, rel=1e-3)


@pytest.mark.parametrize("ranks", [1, 2])
def test_third_law_of_wear_goes_back_doubts_and_leaves_a_stress(petsam, tmp_path, ranks):
    """Derivatives by differences of runs, a warning of few cells, and the stress added to that by tractions."""
    steps = ((700, 0), (700, 4e-5), (760, -3e-5), (690, 2e-5))
    case = dict(SCAR, load_n=None, threshold_wear=4e-12, grid_n=(37, 32), normal_rtol=1e-12, tangential_rtol=1e-12)
    case.update(threshold_stress=3e8, threshold_depth=1e-4, slip_direction="end", step_divide="false")

    def run(rate=4e-12, load=0, check=0, **more):
        sliding(tmp_path, [(n + load * (k == 2), x) for k, (n, x) in enumerate(steps)])
        return petsam(dict(case, threshold_wear=rate, **more), ranks=ranks, check=check)

    for name in "wear_volume", "energy":
        run(gradient=name)
        with h5py.File(tmp_path / "out.h5") as f:
            found = f[f"gradient/{name}"]
            by = [found["threshold_wear"][()] if "threshold_wear" in found else found.attrs["threshold_wear"],
                  found["load_n"][2]]  # fmt: skip
            value = found.attrs["value"]
        values = []
        for change in (dict(rate=4e-12 * (1 + 1e-4)), dict(rate=4e-12 * (1 - 1e-4)), dict(load=0.02), dict(load=-0.02)):
            run(**change)
            with h5py.File(tmp_path / "out.h5") as f:
                one = f["history/wear_volume1"][-1], f["history/dissipated_energy"][:].sum()
            values.append(one[name == "energy"])
        assert value == pytest.approx(np.mean(values[:2]), rel=1e-6)
        assert by[0] == pytest.approx((values[0] - values[1]) / 8e-16, rel=1e-4)
        assert by[1] == pytest.approx((values[2] - values[3]) / 0.04, rel=1e-4)
    below = []
    for left in 0, 3e8:
        run(threshold_stress=left)
        (depth,) = petsam.read("wear_depth1")
        petsam(dict(input="out.h5", body=1, depths="20um,80um", output="s.h5"), program="petsam-stress")
        below.append(petsam.read("stress_xx", "stress_yy", "stress_zz", file="s.h5"))
    for k, share in enumerate((3e8, 3e8, 0)):
        for plane, z in zip(below[1][k] - below[0][k], (2e-5, 8e-5)):
            assert plane == pytest.approx(np.where(depth > 0, -share * np.exp(-z / 1e-4), 0), abs=1)
    said = run(threshold_least=3.7e4)
    assert "cells wear" in said.stderr + said.stdout
    sliding(tmp_path, ((700, 0), (700, 3e-5), (700, 0)))
    assert "has no cycle jumps" in petsam(dict(case, wear_cycles=20), check=2).stderr


@pytest.mark.parametrize("ranks", [1, 3])
def test_law_shears_as_bulk_stress_does_and_its_stress_is_added(petsam, tmp_path, ranks):
    """The same strain of body 2 by a stress of it; below it what its law declares, in the middles of layers."""
    strain, depth, case = 2e-5, 1e-4, dict(SPHERE, load_tx=40, mid_step=None)
    stress = strain * 210e9 / (1 - 0.3)
    petsam(dict(case, bulk2_stress_xx=stress, bulk2_stress_yy=stress))
    expected = petsam.read("pressure", "shear_x", "shear_y", "stick_area")
    petsam(dict(case, misfit_strain=strain, misfit_depth=depth, output_fields="usual,gap,misfit"), ranks=ranks)
    for found, wanted in zip(petsam.read("pressure", "shear_x", "shear_y", "stick_area"), expected):
        assert found == pytest.approx(wanted, rel=1e-3, abs=1e-4 * np.max(wanted))
    z = (np.arange(6) + 0.5) / 3 * depth
    words = dict(input="out.h5", output="s.h5", depths=",".join(map(str, z)))
    petsam(words, ranks=ranks, program="petsam-stress")
    with package.open(tmp_path / "out.h5") as results:
        assert results.z_of("misfit/residual_stress_xx") == pytest.approx(z) and len(results.layered) == 6
        found = results.field("misfit/residual_stress_xx")
        assert found == pytest.approx(np.broadcast_to(-stress * np.exp(-z / depth)[:, None, None], found.shape))
    with_law = petsam.read("stress_xx", "stress_yy", "stress_xz", file="s.h5")
    petsam(dict(case, bulk2_stress_xx=stress, bulk2_stress_yy=stress))
    petsam(words, program="petsam-stress")
    by_bulk = petsam.read("stress_xx", "stress_yy", "stress_xz", file="s.h5")
    added = [-stress * np.exp(-z / depth) - stress] * 2 + [0 * z]
    for one, other, more in zip(with_law, by_bulk, added):
        assert one == pytest.approx(other + more[:, None, None], abs=1e-4 * stress + 1e-3 * np.abs(other).max())


@pytest.mark.parametrize("ranks", [1, 2])
def test_body_remembers_its_creep_over_time_and_restarts(petsam, tmp_path, ranks):
    """Flat bodies in full contact come nearer by rate, pressure and time; a restart goes on with the same bits."""
    rate, mean = 1e-17, 1e6
    (tmp_path / "h.csv").write_text("time,load_n\n" + "".join(f"{t},{mean * AREA}\n" for t in (1, 3, 4.5, 10)))
    case = dict(
        WAVE, gap_type="flat", gap_wave_length=None, gap_wave_height=None, elasticity="creeping", creep_rate=rate,
        load_n=None, history="h.csv", output_fields="all", checkpoint="c.h5", checkpoint_every=2,
    )  # fmt: skip
    petsam(case, ranks=ranks)
    with h5py.File(tmp_path / "out.h5") as f:
        assert f["history/disp_z"][:] == pytest.approx(rate * mean * np.array([0, 2, 3.5, 9]), rel=1e-9, abs=1e-22)
        whole = f["creep"][-1]
    assert whole == pytest.approx(9 * rate * mean, rel=1e-9)
    petsam(dict(case, output="on.h5", checkpoint=None, checkpoint_every=None, restart="c.h5.1"), ranks=ranks)
    with h5py.File(tmp_path / "on.h5") as f:
        assert f["creep"][-1].tobytes() == whole.tobytes()


def test_motion_has_its_name_and_refuses_what_it_does_not_know(petsam, tmp_path):
    petsam(dict(SPHERE, rolling="guided"))
    with h5py.File(tmp_path / "out.h5") as f:
        assert "creep_max" in f["history"] and "slip_max" not in f["history"]
    said = petsam(dict(SPHERE, rolling="guided", load_tx=5), check=2).stderr
    assert "load_tx = 5: expected 0: the bodies are guided" in said
    assert "none, steady or guided" in petsam(dict(SPHERE, rolling="gliding"), check=2).stderr


# a standard linear solid: displacements creep like 1 + PART (1 - exp(-t/TIME))
PART, TIME = 3.0, 2.0
VISCOUS = dict(SPHERE, load_n=None, elasticity="viscous", creep_part=PART, creep_time=TIME, friction=0, history="h.csv")


def creep(t):
    return 1 + PART * (1 - np.exp(-np.asarray(t) / TIME))


def relaxation(t):
    """The load under which the displacement is constant, relative to its first value."""
    return 1 / (1 + PART) + PART / (1 + PART) * np.exp(-(1 + PART) * np.asarray(t) / TIME)


def write_history(path, times, **columns):
    table = np.column_stack([times, *(np.broadcast_to(values, np.shape(times)) for values in columns.values())])
    np.savetxt(path / "h.csv", table, delimiter=",", header=",".join(["time", *columns]), comments="", fmt="%.17g")


def history(path, *names):
    with h5py.File(path / "out.h5") as f:
        return [f[f"history/{name}"][:] for name in names]


@pytest.mark.parametrize("ranks", [1, 3])
def test_pressure_under_a_constant_approach_relaxes(petsam, tmp_path, ranks):
    """The contact stays that of the first step, and its pressure falls like the modulus, to second order in dt."""
    errors = []
    for steps in (20, 40):
        times = np.linspace(0, 2, steps + 1)
        write_history(tmp_path, times, disp_z=6e-6)
        petsam(VISCOUS, ranks=ranks)
        load, area = history(tmp_path, "load_n", "contact_area")
        assert area == pytest.approx(area[0], rel=1e-6)
        errors.append(np.abs(load / load[0] / relaxation(times) - 1).max())
        # each step to the accuracy of the solver: the inverse of the same weights, for a load alone
        x = times[1] / TIME
        mean, memory, p = (1 - np.exp(-x)) / x, 0.0, [1.0]
        for _ in times[1:]:
            recalled = np.exp(-x) * memory + (mean - np.exp(-x)) * p[-1]
            p.append((1 - PART * recalled) / (1 + PART * (1 - mean)))
            memory = recalled + (1 - mean) * p[-1]
        assert load / load[0] == pytest.approx(p, rel=1e-6)
    assert errors[1] < 2e-3 and 3.5 < errors[0] / errors[1] < 4.5


def test_contact_of_a_sphere_grows_under_a_constant_load(petsam, tmp_path):
    """Lee and Radok: a^3 grows like the creep, and the approach is a^2/R."""
    load, times = 100, np.linspace(0, 1, 13) ** 2 * 8
    write_history(tmp_path, times, load_n=load)
    petsam(dict(VISCOUS, grid_n=64))
    approach, area = history(tmp_path, "disp_z", "contact_area")
    square = (3 * 0.1 * load / (4 * MODULUS) * creep(times)) ** (2 / 3)
    assert approach == pytest.approx(square / 0.1, rel=1e-3)
    # the edge of fresh contact is stiffer than a root behind it, by which areas are reconstructed
    assert area == pytest.approx(np.pi * square, rel=4e-2)


def test_layered_bodies_creep_to_softer_ones(petsam, tmp_path):
    """All materials of a pair creep alike: under a constant load it ends as the elastic pair of relaxed moduli."""
    layer = dict(body2_layer_young=70e9, body2_layer_poisson=0.3, body2_layer_thickness=2e-4)
    write_history(tmp_path, [0, *(2.0 ** np.arange(-3, 6)), *np.arange(50, 250, 25)], load_n=200)
    petsam(dict(VISCOUS, **layer))
    found = petsam.read("pressure", "disp_z")
    soft = dict(layer, body2_layer_young=70e9 / (1 + PART), **bodies(210e9 / (1 + PART)))
    petsam(dict(SPHERE, load_n=200, friction=0, **soft))
    for one, other in zip(found, petsam.read("pressure", "disp_z")):
        assert one == pytest.approx(other, rel=1e-6, abs=1e-6 * np.max(other))


@pytest.mark.parametrize("ranks", [1, 2])
def test_tangential_displacement_creeps_under_the_same_shear(petsam, tmp_path, ranks):
    """A load that has crept for long is sheared: the shear stays, its displacement grows like the creep."""
    start = 240
    times = np.array([*np.arange(0, start + 1, 20), *(start + np.array([1e-9, 0.5, 1, 3, 7]))])
    sheared = times > start
    write_history(tmp_path, times, load_n=200, load_tx=20 * sheared)
    petsam(dict(VISCOUS, friction=0.3, output_fields="usual"), ranks=ranks)
    moved, stick = history(tmp_path, "disp_x", "stick_area")
    moved, stick = moved[sheared], stick[sheared]
    assert moved == pytest.approx(moved[0] * creep(times[sheared] - start), rel=1e-6)
    assert stick == pytest.approx(stick[0], rel=1e-5)


def test_gradients_of_a_body_that_remembers_are_refused(petsam, tmp_path):
    """What it remembers of a step acts in later ones, which no derivative contains."""
    (tmp_path / "h.csv").write_text("time,load_n\n0,700\n1,700\n")
    assert "with -elasticity" in petsam(dict(VISCOUS, gradient="disp_z"), check=2).stderr


@pytest.mark.parametrize("ranks", [1, 2])
def test_viscous_body_restarts_with_the_same_bits(petsam, tmp_path, ranks):
    write_history(tmp_path, [0, 1, 2.5, 4], load_n=[100, 150, 130, 160], load_tx=[0, 10, 20, -10])
    case = dict(VISCOUS, friction=0.3, **bodies(210e9, 0.3, 70e9, 0.2), checkpoint="c.h5", checkpoint_every=2)
    petsam(case, ranks=ranks)
    petsam(dict(case, output="on.h5", checkpoint=None, checkpoint_every=None, restart="c.h5.1"), ranks=ranks)
    for name in ("pressure", "shear_x", "disp_z", "disp_x"):
        assert petsam.read(name)[0].tobytes() == petsam.read(name, file="on.h5")[0].tobytes()
    said = petsam(dict(case, restart="c.h5", creep_part=2 * PART), ranks=ranks, check=2).stderr
    assert "creep" in said


@pytest.mark.parametrize("ranks", [1, 3])
def test_conductance_of_a_disc_and_of_any_contact(petsam, ranks):
    """Bodies of conductivity k through a disc: 2 a k. Through any contact: its stiffness in other units (Barber)."""
    k, size = (50.0, 20.0), 2.2e-3
    both = 2 / (1 / k[0] + 1 / k[1])
    case = dict(SPHERE, elasticity="conducting", conductivities=k, grid_n=96, grid_size=size, stiffness=True,
        output_fields="usual,conducted",
    )  # fmt: skip
    petsam(dict(case, load_n=700), ranks=ranks)
    conductance, area, flux = petsam.read("conductance", "contact_area", "conducted")
    assert conductance == pytest.approx(2 * both * np.sqrt(area / np.pi), rel=2e-3)
    assert flux.sum() * (size / 96) ** 2 == pytest.approx(conductance, rel=1e-6)
    flat = dict(gap_type="ellipsoid", gap_radius_x=0.3, gap_radius_y=0.05, gap_radius1=None, gap_radius2=None)
    petsam(case | flat | dict(load_n=100), ranks=ranks)
    conductance, stiffness = petsam.read("conductance", "stiffness_reversal")
    assert conductance / both == pytest.approx(stiffness.reshape(6, 6)[0, 0] / MODULUS, rel=1e-6)
