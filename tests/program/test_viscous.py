"""Bodies that relax: closed solutions, limits, balance of energy, order in the step, ranks and restarts."""

import re
import warnings

import h5py
import numpy as np
import pytest
from scipy.optimize import fsolve
from scipy.special import iv, kve

import petsam as package
from support import bodies, few

# three terms, of which the times and parts of the creep are known
PARTS, TIMES = (0.5, 0.3, 0.15), (0.01, 0.1, 1.0)
CREEP = (
    (0.760686034166275, 0.018740461355115), (2.112506661468029, 0.234187564244963),
    (16.12680730436569, 4.557071974399922),
)  # fmt: skip
# the same material with the bulk modulus 2 for G(0) = 1: the creep of 3/(3 K + G), 3/7 under a sudden load
CREEP_BULK = (
    (0.032585222852021, 0.010764780637964), (0.02256860139057, 0.104866285057829),
    (0.012142515781021, 1.024947446700901),
)  # fmt: skip
BALL = dict(friction=0, gap_type="sphere", gap_radius1=1, gap_radius2="inf", errors="none")
RIGID = dict(body1_young="inf", body1_poisson=0)


def creep(t):
    """J(t)/J(0)."""
    return 1 + sum(a * (1 - np.exp(-t / theta)) for a, theta in CREEP)


def creep_bulk(t):
    """3/(3 K + G) as a creep function."""
    return 3 / 7 + sum(b * (1 - np.exp(-t / theta)) for b, theta in CREEP_BULK)


def relaxing(body, parts=PARTS, times=TIMES, bulk=False):
    kind = {f"body{body}_relax": "constant_bulk"} if bulk else {}
    return {f"body{body}_relax_moduli": parts, f"body{body}_relax_times": times, **kind}


def constants(body, shear, bulk):
    """Young's modulus and Poisson's ratio of a shear and a bulk modulus."""
    young, poisson = 9 * bulk * shear / (3 * bulk + shear), (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear)
    return {f"body{body}_young": young, f"body{body}_poisson": poisson}


def table(**columns):
    names = list(columns)
    return dict(time=np.asarray(columns["time"], float), **{n: np.asarray(columns[n], float) for n in names[1:]})


@pytest.mark.parametrize("which, poisson", [(1, 0.3), (2, 0.3), (2, 0.5)])
def test_bodies_that_creep_differently_sink_in_as_lee_and_radok(which, poisson):
    """z^1.5 = 3 N/4 (c1 + c2 J(t)) for R = 1, c = (1 - nu2)/E; the other body is elastic, with another nu."""
    other, load = 3 - which, 1e-3
    c1, c2 = (1 - 0.25) / 4, (1 - poisson) / 2  # (1 - nu)/(2 G), G = 2 and 1
    times = np.concatenate([[0], np.logspace(-4, 1, 21)])
    size = 2.5 * (0.75 * load * (c1 + c2 * creep(10))) ** (1 / 3)
    run = package.run(
        **BALL, **relaxing(which), grid_n=48, grid_size=size, history=table(time=times, load_n=load + 0 * times),
        output_fields="none",
        **{f"body{other}_young": 5, f"body{other}_poisson": 0.25, f"body{which}_young": 2 * (1 + poisson),
           f"body{which}_poisson": poisson},
    )  # fmt: skip
    closed = (0.75 * load * (c1 + c2 * creep(times))) ** (2 / 3)
    assert run["disp_z"][:] == pytest.approx(closed, rel=2e-3)
    assert run["disp_z"][-1] == pytest.approx(closed[-1], rel=3e-4)


@pytest.mark.parametrize("which, relaxes", [(2, False), (1, True)])
def test_bodies_of_constant_bulk_modulus_sink_in_as_lee_and_radok(which, relaxes):
    """z^1.5 = 3 N/8 times the sum of (1 - nu)/G as creep functions, (a + b)/2; the other body has nu = 0.25, G = 2."""
    other, load = 3 - which, 1e-3
    times = np.concatenate([[0], np.logspace(-4, 1, 21)])
    creeps = (creep(times) + creep_bulk(times)) / 2 + 0.75 / 2 * (creep(times) if relaxes else 1)
    closed = (0.375 * load * creeps) ** (2 / 3)
    run = package.run(
        **BALL, **constants(which, 1, 2), **relaxing(which, bulk=True), **(relaxing(other) if relaxes else {}),
        **{f"body{other}_young": 5, f"body{other}_poisson": 0.25}, grid_n=64, grid_size=2.5 * closed[-1] ** 0.5,
        history=table(time=times, load_n=load + 0 * times), output_fields="none",
    )  # fmt: skip
    if not relaxes:
        assert closed[[0, 13, 21]] == pytest.approx([0.00550531344401, 0.0083472785839, 0.0236917848524], rel=1e-11)
    assert run["disp_z"][:] == pytest.approx(closed, rel=1e-3)
    assert run["disp_z"][-1] == pytest.approx(closed[-1], rel=1e-4)


def test_forces_of_a_growing_contact_are_elastic_ones_without_what_creeps():
    """J of the pressure is the elastic pressure of the same approach, so the forces follow from J's terms alone."""
    times = np.cumsum([0.02, 0.03, 0.05, 0.1, 0.1, 0.2, 0.5])
    case = dict(BALL, **RIGID, **constants(2, 1, 2), grid_n=48, grid_size=0.25, output_fields="none", normal_rtol=1e-12,
                history=table(time=times, disp_z=0.009 * times**0.5))  # fmt: skip
    found, elastic = (package.run(**case, **more)["load_n"][:] for more in (relaxing(2, bulk=True), {}))
    parts, thetas = np.array(CREEP + CREEP_BULK).T
    x = np.diff(times)[:, None] / thetas
    kept, mean = np.exp(-x), -np.expm1(-x) / x
    forces, memory = [elastic[0]], np.zeros(6)
    for k, force in enumerate(elastic[1:]):  # (1 - nu)/G is (1 + 3/7)/2 under a sudden load
        known = kept[k] * memory + (mean[k] - kept[k]) * forces[-1]
        forces.append((force - 0.7 * parts @ known) / (1 + 0.7 * parts @ (1 - mean[k])))
        memory = known + (1 - mean[k]) * forces[-1]
    assert found == pytest.approx(forces, rel=1e-9)


def test_a_stuck_contact_of_constant_bulk_modulus_creeps_as_its_poisson_ratio_rises():
    """(2 - nu)/G of Mindlin's compliance is (3 a + b)/2; alike, the bodies stay uncoupled, and T leaves N alone."""
    held = 200 + np.array([0, 0.01, 0.1, 0.3, 1, 10])
    times = np.concatenate([[0, 100, 200 - 1e-6], held])
    run = package.run(
        **{**BALL, "friction": 50}, **constants(1, 1, 2), **constants(2, 1, 2), **relaxing(1, bulk=True),
        **relaxing(2, bulk=True), grid_n=32, grid_size=0.9, slip_direction="end", normal_rtol=1e-11,
        tangential_rtol=1e-11, history=table(time=times, load_n=1e-3 + 0 * times, load_tx=1e-4 * (times >= 200)),
    )  # fmt: skip
    moved, since = (run["disp_x"][:] - run["disp_x"][2])[3:], held - 200
    assert moved / moved[0] == pytest.approx((3 * creep(since) + creep_bulk(since)) / (3 + 3 / 7), rel=1e-3)
    assert np.abs(run["shear_x"][2]).max() == 0 and np.abs(run["shear_x"][3:]).max() > 0
    assert run["disp_z"][3:] == pytest.approx(np.full(6, run["disp_z"][2]), rel=1e-6)


def test_bodies_alike_but_for_what_stays_constant_are_coupled():
    case = dict(BALL, friction=0.2, **constants(1, 1, 2), **constants(2, 1, 2), grid_n=32, grid_size=0.3,
                slip_direction="end", history=table(time=[0, 100], load_n=[1e-3] * 2))  # fmt: skip
    moduli = (0.6,), (1.0,)
    shear = {
        bulk: package.run(**case, **relaxing(1, *moduli, True), **relaxing(2, *moduli, bulk))["shear_x"]
        for bulk in (True, False)
    }
    assert np.abs(shear[True]).max() == 0
    assert np.abs(shear[False][0]).max() == 0 and np.abs(shear[False][1]).max() > 0


def test_an_incompressible_body_has_no_other_constant():
    case = dict(BALL, friction=0.3, body1_young=5, body1_poisson=0.2, body2_young=3, body2_poisson=0.5, grid_n=24,
                grid_size=0.4, history=table(time=[0, 0.1, 1], load_n=[1e-3] * 3))  # fmt: skip
    one, two = (package.run(**case, **relaxing(2, bulk=bulk)) for bulk in (True, False))
    assert np.array_equal(one["shear_x"], two["shear_x"]) and np.array_equal(one["disp_z"], two["disp_z"])


def test_a_contact_that_shrinks_is_that_of_ting_in_second_order():
    """G = (1 + exp(-t))/2, approach 0.01 t to t = 1 and back; forces of Ting's (1966) integral."""
    known = {1: 0.00322453474215, 1.25: 0.00168380510256, 1.5: 0.000583836270247}
    found = {}
    for duration in (1 / 4, 1 / 8, 1 / 16):
        t = np.arange(0, 1.5 + 1e-9, duration)
        depth = 0.01 * np.where(t > 1, 2 - t, t) - 1e-12
        run = package.run(
            **BALL, **RIGID, body2_young=2.6, body2_poisson=0.3, **relaxing(2, (0.5,), (1.0,)), grid_n=96,
            grid_size=0.25, history=table(time=t, disp_z=depth), output_fields="none",
        )  # fmt: skip
        found[duration] = {at: run["load_n"][np.argmin(abs(t - at))] for at in known}
    for at, force in known.items():
        assert found[1 / 16][at] == pytest.approx(force, rel=1e-3)
        changes = [found[1 / 4][at] - found[1 / 8][at], found[1 / 8][at] - found[1 / 16][at]]
        assert 3 < changes[0] / changes[1] < 5


@pytest.mark.parametrize("poisson, both", [(0.5, False), (0.3, True)])
def test_a_stuck_contact_creeps_along_the_surface_and_keeps_its_shear(poisson, both):
    """N relaxed, then T_x stepped and held: the displacement follows the creep of the bodies, the shear stays."""
    held = 200 + np.array([0, 0.01, 0.1, 1, 10])
    times = np.concatenate([[0, 100, 200 - 1e-6], held])
    run = package.run(
        **{**BALL, "friction": 50}, body1_young=6 if not both else 2.6, body1_poisson=poisson,
        body2_young=2 * (1 + poisson), body2_poisson=poisson, **relaxing(2), **(relaxing(1) if both else {}),
        grid_n=32, grid_size=0.9 if both else 0.4, slip_direction="end", normal_rtol=1e-11, tangential_rtol=1e-11,
        history=table(time=times, load_n=1e-3 + 0 * times, load_tx=1e-4 * (times >= 200)),
    )  # fmt: skip
    c1, c2 = (1, 1) if both else (0.5, 1)
    moved = (run["disp_x"][:] - run["disp_x"][2])[3:]
    grows = (c1 * (creep(held - 200) if both else 1) + c2 * creep(held - 200)) / (c1 + c2)
    assert moved / moved[0] == pytest.approx(grows, rel=1e-4)
    assert run["shear_x"][-1] == pytest.approx(run["shear_x"][3], abs=1e-9 * run["shear_x"][3].max())


@pytest.mark.parametrize("dissimilar, bulk", [(False, False), (True, False), (True, True)])
def test_work_is_dissipated_by_friction_and_by_the_bodies(dissimilar, bulk):
    """Pushed in, sheared and pulled off, with time to recover: the rest of the balance falls in second order."""
    rest = []
    for steps in (24, 48):
        t = np.linspace(0, 2, steps + 1)
        late = 2 + np.array([0.05, 0.1, 0.3, 1, 3, 10, 50])
        down, along = 0.009 * np.sin(np.pi * t / 2), 0.002 * np.sin(np.pi * t)
        history = table(
            time=np.concatenate([t, late]), disp_z=np.concatenate([[-1e-5], down[1:], -1e-5 + 0 * late]),
            disp_x=np.concatenate([along, 0 * late]),
        )  # fmt: skip
        first = dict(body1_young=5, body1_poisson=0.2) if dissimilar else RIGID
        run = package.run(
            **{**BALL, "friction": 0.3 * dissimilar}, **first, body2_young=2.6, body2_poisson=0.3,
            **relaxing(2, (0.5, 0.2), (0.3, 1), bulk), grid_n=40, grid_size=0.25, history=history, output_fields="none",
            normal_rtol=1e-10, tangential_rtol=1e-10,
        )  # fmt: skip
        work = sum(
            np.sum((force[1:] + force[:-1]) / 2 * np.diff(way))
            for force, way in (
                (np.nan_to_num(run["load_n"][:]), history["disp_z"]),
                (np.nan_to_num(run["load_tx"][:]), history["disp_x"]),
            )
        )
        lost = np.nansum(run["viscous_energy"][:]) + np.nansum(run["dissipated_energy"][:])
        rest.append(abs(work - lost) / work)
    assert rest[1] < 5e-4 and rest[1] < 0.5 * rest[0]


@pytest.mark.parametrize("kind", ["halfspace", "plane", "periodic"])
def test_limits_are_elastic_bodies(kind):
    """Times far below and above those of the history: the relaxed and the sudden modulus."""
    case = dict(
        bodies(), friction=0.3, gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", elasticity=kind,
        grid_n=64 if kind == "plane" else 24, grid_size=2e-3, slip_direction="end", normal_rtol=1e-12,
        tangential_rtol=1e-11, errors="none", step_divide="no",
    )  # fmt: skip
    load = 1e5 if kind == "plane" else 100
    history = table(time=[1, 2, 3, 4], load_n=[load, load, load, 0.8 * load], load_tx=[0, 0, 0.12 * load, -0.1 * load])

    def run(young, **more):
        return package.run(**{**case, "body1_young": young, "body2_young": young}, **more, history=history)

    for times, young in (((1e-9, 3e-9), 105e9), ((1e9, 3e9), 210e9)):
        found = run(210e9, **relaxing(1, (0.3, 0.2), times), **relaxing(2, (0.3, 0.2), times))
        elastic = run(young)
        for name in ("pressure", "shear_x"):
            for k in (1, 2, 3):
                assert found[name][k] == pytest.approx(elastic[name][k], abs=1e-6 * np.abs(elastic[name][k]).max())


@few("kind, both", [(kind, both) for kind in ("halfspace", "plane", "periodic") for both in (True, False)])
def test_limits_of_constant_bulk_modulus_are_elastic_bodies(kind, both):
    """Of a body that keeps its bulk modulus, and one that keeps it or Poisson's ratio: of G(inf) and what is kept."""
    case = dict(
        friction=0.3, gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", elasticity=kind,
        grid_n=64 if kind == "plane" else 24, grid_size=2e-3, slip_direction="end", normal_rtol=1e-12,
        tangential_rtol=1e-11, errors="none", coupling_rtol=1e-9,
    )  # fmt: skip
    load = 1e5 if kind == "plane" else 100
    # the first row, a sudden one, leaves hardly any shear to later ones
    loads = dict(load_n=[1e-9 * load, load, load, 0.8 * load], load_tx=[0, 0, 0.12 * load, -0.1 * load])
    history = table(time=[1, 2, 3, 4], **loads)

    def run(shear, more):
        second = constants(2, 0.5e11 * shear, 1e11 if both else 1e11 * shear)
        return package.run(**case, **constants(1, 1e11 * shear, 1.5e11), **second, **more, history=history)

    for times, shear in (((1e-9, 3e-9), 0.5), ((1e9, 3e9), 1)):
        found = run(1, {**relaxing(1, (0.3, 0.2), times, True), **relaxing(2, (0.3, 0.2), times, both)})
        elastic = run(shear, {})
        for name in ("pressure", "shear_x"):
            for k in (1, 2, 3):
                assert found[name][k] == pytest.approx(elastic[name][k], abs=1e-6 * np.abs(elastic[name][k]).max())


SECOND = [{}, relaxing(2, (0.4,), (0.7,)), relaxing(2, (0.4,), (0.7,), True)]


@pytest.mark.parametrize("second", SECOND, ids=["elastic", "constant_poisson", "constant_bulk"])
def test_same_bits_on_ranks_and_after_a_restart(petsam, tmp_path, second):
    (tmp_path / "h.csv").write_text("time,load_n,load_tx\n0,500,0\n0.1,700,60\n0.3,700,-40\n1,600,30\n")
    case = dict(
        bodies(), body2_young=70e9, **relaxing(1, (0.5, 0.2), (0.1, 1)), **second, friction=0.4, gap_type="sphere",
        gap_radius1=0.1, gap_radius2="inf", grid_n=(37, 30), grid_size=2.4e-3, history="h.csv", overwrite=True,
        slip_direction="end",
    )  # fmt: skip
    case = {k: ",".join(map(str, v)) if isinstance(v, tuple) and "relax" in k else v for k, v in case.items()}
    petsam(dict(case, output="one.h5", checkpoint="c.h5", checkpoint_every=2))
    petsam(dict(case, output="three.h5"), ranks=3)
    petsam(dict(case, output="on.h5", restart="c.h5.1"), ranks=2)
    names = "pressure", "shear_x", "shear_y", "history/viscous_energy", "history/disp_x"
    with h5py.File(tmp_path / "one.h5") as one:
        for file in "three.h5", "on.h5":
            with h5py.File(tmp_path / file) as other:
                for name in names:
                    assert one[name][-1].tobytes() == other[name][-1].tobytes(), (file, name)
        assert one["history/viscous_energy"][1:].min() > 0
    said = petsam(dict(case, output="on.h5", restart="c.h5", body1_relax_times="0.1,2"), check=2).stderr
    assert "body1_relax_times" in said
    said = petsam(dict(case, output="on.h5", restart="c.h5", body1_relax="constant_bulk"), check=2).stderr
    assert "-body1_relax is constant_poisson there" in said


@pytest.mark.parametrize("body", [1, 2])
def test_stresses_of_a_body_of_constant_bulk_modulus_are_rejected(petsam, stress, tmp_path, body):
    (tmp_path / "h.csv").write_text("time,load_n\n0,500\n1,500\n")
    relax = {f"body{body}_relax_moduli": "0.6", f"body{body}_relax_times": "0.2", f"body{body}_relax": "constant_bulk"}
    case = dict(bodies(), **relax, friction=0, gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", grid_n=32,
                grid_size=2.4e-3, history="h.csv", output="v.h5")  # fmt: skip
    petsam(case)
    said = stress(dict(input="v.h5", output="s.h5", depths="50um", body=body), check=2).stderr
    assert f"-body{body}_relax constant_bulk: the stresses in body {body}" in said and f"give -body {3 - body}" in said
    stress(dict(input="v.h5", output="s.h5", depths="50um", body=3 - body))


def test_stresses_are_those_by_the_tractions(petsam, stress, tmp_path):
    (tmp_path / "h.csv").write_text("time,load_n\n0,500\n1,500\n")
    case = dict(bodies(), friction=0, gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", grid_n=32,
                grid_size=2.4e-3, history="h.csv", output="v.h5", body2_relax_moduli="0.6",
                body2_relax_times="0.2")  # fmt: skip
    petsam(case)
    stress(dict(input="v.h5", output="s.h5", depths="50um,200um"))
    for words in dict(quantities="strain"), dict(fatigue="swt", steps="all"):
        said = stress(dict(input="v.h5", output="n.h5", depths="50um"), words, check=2).stderr
        assert "not those of elastic bodies" in said
    with h5py.File(tmp_path / "v.h5", "r+") as f:
        for name in ("body2_relax_moduli", "body2_relax_times"):
            del f.attrs[name]
    stress(dict(input="v.h5", output="e.h5", depths="50um,200um"))
    with h5py.File(tmp_path / "s.h5") as s, h5py.File(tmp_path / "e.h5") as e:
        assert np.array_equal(s["mises"][:], e["mises"][:]) and s["mises"][:].max() > 0


def test_stiffness_is_that_of_the_step(tmp_path, petsam):
    """Of two histories that differ in the last load."""
    case = dict(
        bodies(), body1_relax_moduli="0.6", body1_relax_times="0.4", friction=0, gap_type="sphere", gap_radius1=0.1,
        gap_radius2="inf", grid_n=32, grid_size=2.4e-3, history="h.csv", stiffness=True, normal_rtol=1e-12,
        output="k.h5", overwrite=True,
    )  # fmt: skip
    found = []
    for load in (700, 699.93, 700.07):
        (tmp_path / "h.csv").write_text(f"time,load_n\n0,500\n0.3,{load}\n")
        petsam(case)
        with h5py.File(tmp_path / "k.h5") as f:
            found.append((f["history/disp_z"][-1], f["history/stiffness"][-1].reshape(6, 6)[0, 0]))
    assert 1 / found[0][1] == pytest.approx((found[2][0] - found[1][0]) / 0.14, rel=1e-4)


def test_equal_times_are_one_part():
    """0.2 and 0.3 of one time are 0.5, in any order of times."""
    case = dict(BALL, **RIGID, body2_young=2.6, body2_poisson=0.3, grid_n=24, grid_size=0.3, output_fields="none",
                history=table(time=[0, 0.1, 1], load_n=[1e-3] * 3))  # fmt: skip
    one = package.run(**case, **relaxing(2, (0.5, 0.1), (0.2, 3)))
    two = package.run(**case, **relaxing(2, (0.2, 0.1, 0.3), (0.2, 3, 0.2)))
    assert two["disp_z"][:] == pytest.approx(one["disp_z"][:], rel=1e-9)


def test_bodies_of_equal_moduli_that_creep_differently_are_coupled():
    """Alike under a sudden load, they slip over each other as one of them creeps: as elastic ones of its modulus."""
    case = dict(BALL, friction=0.2, body1_young=2.6, body1_poisson=0.2, body2_young=2.6, body2_poisson=0.2,
                grid_n=32, grid_size=0.3, slip_direction="end")  # fmt: skip
    run = package.run(**case, **relaxing(2, (0.6,), (1.0,)), history=table(time=[0, 100], load_n=[1e-3] * 2))
    assert np.abs(run["shear_x"][0]).max() == 0 and np.abs(run["shear_x"][1]).max() > 1e-3 * run["pressure"][1].max()


def test_short_steps_lose_no_digits():
    """A million times shorter than the time: what creeps is that of the two rows, not rounding."""
    case = dict(BALL, **RIGID, body2_young=2.6, body2_poisson=0.3, grid_n=24, grid_size=0.3, output_fields="none",
                normal_rtol=1e-13, **relaxing(2, (0.5,), (1.0,)))  # fmt: skip
    times = np.array([0, 1e-9, 2e-9])
    run = package.run(**case, history=table(time=times, load_n=[1e-3] * 3))
    grown = run["disp_z"][1:] / run["disp_z"][0] - 1
    assert grown == pytest.approx(2 / 3 * 0.5 * times[1:], rel=2e-2)  # J' = a/theta = 1/2 at 0, z^1.5 as J


def test_no_closed_form_of_elastic_bodies_is_compared(petsam, tmp_path):
    (tmp_path / "h.csv").write_text("time,load_n,load_tx\n0,500,0\n1,500,40\n2,500,-40\n")
    case = dict(bodies(), friction=0.3, gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", grid_n=32,
                grid_size=4.4e-3, history="h.csv", output="o.h5")  # fmt: skip
    relaxes = {f"body{b}_relax_{k}": v for b in (1, 2) for k, v in (("moduli", "0.9"), ("times", "0.2"))}
    assert (
        "closed form" not in petsam(case, relaxes).stdout and "closed form" in petsam(case, dict(overwrite=True)).stdout
    )
    small = petsam(case, relaxes, dict(grid_size=2.2e-3, overwrite=True), check=None).stderr
    size = [float(word) for word in re.findall(r"-grid_size ([0-9.e-]+)", small)]
    assert size and min(size) > 2.9e-3  # of the relaxed contact, 10^(1/3) times as wide as that of a sudden load


def test_times_far_above_the_steps_dissipate_nothing():
    """A term of 1e12 s beside steps of 1e-6 s and of seconds: the energy is that without it."""
    lost = []
    for parts, times in (((0.3, 0.2), (0.1, 1)), ((0.3, 0.2, 0.2), (0.1, 1, 1e12))):
        run = package.run(
            **BALL, **RIGID, body2_young=2.6, body2_poisson=0.3, **relaxing(2, parts, times), grid_n=24, grid_size=0.4,
            history=table(time=[0, 0.5, 1, 1 + 1e-6, 2, 30], load_n=[1e-3, 1e-3, 1e-3, 1e-4, 1e-4, 1e-4]),
            output_fields="none",
        )  # fmt: skip
        lost.append(run["viscous_energy"][:])
    assert lost[1] == pytest.approx(lost[0], rel=1e-6, abs=1e-9 * lost[0].max()) and lost[0].min() >= 0


def test_a_sudden_change_dissipates_as_much_as_its_duration_allows():
    """In 1e-6 s a term of 1e4 s adds 1e-5 of what one of 0.1 s dissipates, not what rounding leaves."""
    found = []
    for parts, times in (((0.3,), (0.1,)), ((0.3, 0.2), (0.1, 1e4))):
        run = package.run(
            **BALL, **RIGID, body2_young=2.6, body2_poisson=0.3, **relaxing(2, parts, times), grid_n=24, grid_size=0.4,
            history=table(time=[0, 1e-6, 2e-6], load_n=[1e-4, 1e-3, 1e-4]), output_fields="none",
        )  # fmt: skip
        found.append(run["viscous_energy"][1:])
    assert found[1] == pytest.approx(found[0], rel=1e-2)


def test_errors_by_the_steps_are_estimated_without_friction(petsam, tmp_path):
    (tmp_path / "h.csv").write_text("time,load_n\n0,100\n1,500\n2,700\n")
    case = dict(bodies(), friction=0, gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", grid_n=32,
                grid_size=2.8e-3, history="h.csv", output="o.h5", errors="companion", body2_relax_moduli="0.6",
                body2_relax_times="0.5")  # fmt: skip
    said = petsam(case).stdout
    assert "16 x 16 cells with 2 steps per row" in said


@pytest.mark.parametrize("steps", [dict(steps=4), dict(step_rtol=1e-3)])
def test_the_way_to_the_first_row_is_sudden_in_any_number_of_steps(steps):
    case = dict(
        {**BALL, "friction": 0.3}, body1_young=5, body1_poisson=0.2, body2_young=2.6, body2_poisson=0.2,
        **relaxing(2, (0.6,), (1.0,)), grid_n=24, grid_size=0.3, history=table(time=[5, 6], load_n=[1e-3] * 2),
        output_fields="none",
    )  # fmt: skip
    one, several = package.run(**case), package.run(**case, **steps)
    first = np.nonzero(several["time"][:] == 5)[0][0]
    assert several["disp_z"][first] == pytest.approx(one["disp_z"][0], rel=1e-4)
    assert np.nanmax(np.abs(several["viscous_energy"][: first + 1])) == 0


def test_time_does_not_go_back_in_process():
    contact = package.Contact(
        **BALL, **RIGID, body2_young=2.6, body2_poisson=0.3, **relaxing(2), grid_n=16, grid_size=0.4
    )
    contact.try_step(time=0, load_n=1e-3)
    contact.commit()
    with pytest.raises(package.Error, match="goes back by 1 s"):
        contact.try_step(time=-1, load_n=1e-3)
    contact.try_step(time=1, load_n=1e-3)


def hunter(growth, length):
    """Edges, and moment of the pressure per load, of Hunter's (1961) rolling cylinder: E* = R = 1, N = pi/4.

    J(t) = 1 + growth (1 - exp(-t/theta)), length = V theta. Contact from m - h to m + h.
    """
    load = np.pi / 4

    def coefficients(m, h):
        return (1 + growth) * load / (np.pi * h), -(m - length) / 2, -h / 4

    def residual(unknowns):
        m, h = unknowns
        a, b, c = coefficients(m, h)
        y, z = h / length, (1 + growth) * h / length
        ahead = a * kve(0, y) + b * (kve(1, y) - 1 / y) + c * (kve(2, y) - 2 * (1 / y + 1 / y**2))
        return (a * iv(0, z) - b * iv(1, z) + c * iv(2, z)) / iv(0, z), np.pi * y * ahead - np.pi / 2 * (m + h)

    m, h = fsolve(residual, (0.2, (1 + growth) ** 0.25), xtol=1e-13)
    a, b, _ = coefficients(m, h)
    moment = (h * np.pi * (m * a + h * b / 2) - length * load) / (1 + growth)
    return m - h, m + h, moment / load


@pytest.mark.parametrize("growth, length, ends, cells", [(1, 1, (-6, 2.25), 360), (10, 0.1, (-4.4, 3.8), 200)])
def test_a_cylinder_rolls_as_that_of_hunter(growth, length, ends, cells):
    """In steps of a cell until it is steady; the moment resists the rolling."""
    closed = hunter(growth, length)
    if length == 1:
        assert closed == pytest.approx((-1.01489455271, 1.36980365535, 0.262159497125), rel=1e-10)
    width, nu = ends[1] - ends[0], 0.3
    step, k = width / cells, np.arange(cells)
    run = package.run(
        **{**BALL, "elasticity": "plane"}, **RIGID, body2_young=1 - nu**2, body2_poisson=nu,
        **relaxing(2, (growth / (1 + growth),), (1 / (1 + growth),)), grid_n=cells, grid_size=width,
        grid_center=(ends[0] + ends[1]) / 2, output_fields="pressure",
        history=table(time=k * step / length, load_n=np.pi / 4 + 0 * k, rot_y=0 * k, roll=step * (k > 0)),
    )  # fmt: skip
    places = ends[0] + step * (np.nonzero(run["pressure"][-1].ravel())[0] + 0.5)
    assert run["load_my"][-1] / (np.pi / 4) == pytest.approx(closed[2], rel=1e-3)
    assert run["load_my"][-1] == pytest.approx(run["load_my"][-20], rel=1e-4)
    assert (places[0] - step / 2, places[-1] + step / 2) == pytest.approx(
        closed[:2], abs=0.01 * (closed[1] - closed[0])
    )


@pytest.mark.parametrize(
    "column, rows, steps, least, most",
    [
        ("disp_z", (2e-5, 2e-5), 1, 0.5, 0.9),
        ("disp_z", (1e-7, 2e-5), 2, 0.03, 0.12),
        ("load_n", (0.02, 0.02), 8, 0, 0.02),
    ],
)
def test_energy_of_long_steps_is_told_as_wrong(column, rows, steps, least, most):
    """Beside many steps: an approach held for 10 s in one, one that grows in two, a load held for 0.5 s in eight."""
    ball = dict(
        BALL, gap_radius1=1e-3, body2_young=6e6, body2_poisson=0.5, grid_n=48, grid_size=1e-3, errors="companion"
    )
    last = {1: 10.0, 2: 1.0, 8: 0.5}[steps]
    case = dict(ball, **RIGID, **relaxing(2, (0.5, 0.2), (0.1, 1)), history={"time": [0, last], column: list(rows)})
    found, fine = (package.run(**case, steps=n, output_fields="none") for n in (steps, 300))
    energy, true = (np.nansum(run["viscous_energy"]) for run in (found, fine))
    told = found.errors["viscous_energy"].by_steps
    assert abs(energy - true) / energy <= told + 1e-3 and least <= told <= most


@pytest.mark.parametrize("elasticity, behind, told", [
    ("plane", 2.2, 8), ("plane", 4, None), ("halfspace", 1.4, 8), ("halfspace", 3, None),
])  # fmt: skip
def test_a_grid_that_ends_before_the_memory_does_is_told(elasticity, behind, told):
    """Rolling in steps until the state is steady, with a creep of 1 m behind the contact."""
    dx, ahead, wide = 0.1, 1.8, 3.2
    n, k = round((behind + ahead) / dx), np.arange(80)
    place = dict(grid_n=n, grid_size=n * dx, grid_center=(ahead - behind) / 2)
    if elasticity == "halfspace":
        place = dict(grid_n=(n, 32), grid_size=(n * dx, wide), grid_center=((ahead - behind) / 2, 0))
    load = np.pi / 4 if elasticity == "plane" else 1
    case = dict(
        BALL, **RIGID, **place, elasticity=elasticity, body2_young=0.91, body2_poisson=0.3,
        **relaxing(2, (0.5,), (0.5,)), output_fields="none",
        history=table(time=k * dx, load_n=load + 0 * k, rot_y=0 * k, roll=dx * (k > 0)),
    )  # fmt: skip
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        package.run(**case)
    found = [str(one.message) for one in said if "leaves the grid" in str(one.message)]
    if told is None:
        assert not found
    else:
        assert len(found) == 1 and abs(float(re.search(r"about (\d+) %", found[0])[1]) - told) <= 4
