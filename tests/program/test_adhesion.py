"""Surfaces that attract each other: Maugis' curve, jumps, limits in closed form, energy, friction, ranks, restarts."""

import re

import h5py
import numpy as np
import pytest

import petsam as package

RADIUS, WORK, MODULUS = 1e-3, 0.05, 1e9  # m, J/m2, E* in Pa
STIFF = 4 / 3 * MODULUS
# Maugis' units of length, force and approach
LENGTH = (np.pi * WORK * RADIUS**2 / STIFF) ** (1 / 3)
FORCE, WAY = np.pi * WORK * RADIUS, (np.pi**2 * WORK**2 * RADIUS / STIFF**2) ** (1 / 3)
BALL = dict(
    body1_young="inf", body1_poisson=0, body2_young=MODULUS * (1 - 0.3**2), body2_poisson=0.3, friction=0,
    gap_type="sphere", gap_radius1=RADIUS, gap_radius2="inf", errors="none",
)  # fmt: skip
UPRIGHT = dict(rot_x=0, rot_y=0)


def adhesion(lam, **more):
    """The options of a tension for Maugis' lambda."""
    tension = lam / 2 * (np.pi * WORK * STIFF**2 / RADIUS) ** (1 / 3)
    return dict(adhesion_work=WORK, adhesion_stress=tension, **more)


def maugis(lam):
    """Contact radius, force and approach of all states, in Maugis' units; from apart to pressed."""
    m = 1 + np.logspace(5, -7, 60000)
    root, turn = np.sqrt(m**2 - 1), np.arccos(1 / m)
    first, second = lam / 2 * (root + (m**2 - 2) * turn), 4 / 3 * lam**2 * (root * turn - m + 1)
    a = (-second + np.sqrt(second**2 + 4 * first)) / (2 * first)
    return a, a**3 - lam * a**2 * (root + m**2 * turn), a**2 - 4 / 3 * lam * a * root


def pressed(lam, ways):
    """Force at approaches on the branch of the larger contact."""
    _, force, way = maugis(lam)
    fold = np.argmin(way)
    return np.interp(ways, way[fold:], force[fold:])


def pulled(ways, lam, cells, size=7.0, **more):
    """A run under given approaches, in Maugis' units; force and approach in these, too."""
    history = dict(time=np.arange(len(ways), dtype=float), disp_z=np.asarray(ways) * WAY)
    run = package.run(
        **{**BALL, **UPRIGHT, **adhesion(lam), **more}, grid_n=cells, grid_size=size * LENGTH, history=history
    )
    return run, run["load_n"] / FORCE


@pytest.mark.parametrize("lam, cells, size, within", [(0.3, 48, 9, 4e-3), (1, 96, 7, 8e-3), (1.5, 180, 6.5, 1e-2)])
def test_ball_is_pulled_off_along_the_curve_of_maugis(lam, cells, size, within):
    """All of the curve within 1 % of the pull-off force, and the end of contact between two steps."""
    _, force, way = maugis(lam)
    ways = np.concatenate([np.linspace(1.2, way.min() + 0.04, 9), [way.min() - 0.04]])
    run, found = pulled(ways, lam, cells, size)
    assert np.abs(found[:9] - pressed(lam, ways[:9])).max() < within * -force.min()
    assert (run["contact_cells"][:9] > 0).all() and run["contact_cells"][9] == 0
    assert run["pull_max"][-1] == pytest.approx(-found.min() * FORCE)


def test_loads_and_approaches_lead_to_the_same_states():
    lam = 1
    ways = [1.3, 0.4, -0.2]
    run, force = pulled(ways, lam, 64)
    history = dict(time=np.arange(3.0), load_n=force * FORCE)
    other = package.run(
        **BALL, **UPRIGHT, **adhesion(lam), grid_n=64, grid_size=7 * LENGTH, history=history, output_fields="usual"
    )
    assert other["disp_z"] / WAY == pytest.approx(ways, abs=1e-6)
    total = other["pressure"][1].sum() * (7 * LENGTH / 64) ** 2
    assert total == pytest.approx(history["load_n"][1], rel=1e-6)  # the field is the pressure less the tension


def test_bodies_that_touch_jump_into_contact_and_are_pulled_off_by_a_load(petsam, tmp_path):
    lam, (_, force, _) = 1, maugis(1)
    rows = np.array([0, 0.5, 0, -1, 0.98 * force.min(), 1.02 * force.min(), 0]) * FORCE
    (tmp_path / "pull.csv").write_text("time,load_n\n" + "".join(f"{k},{n:.12g}\n" for k, n in enumerate(rows)))
    said = petsam(
        dict(BALL, **UPRIGHT, **adhesion(lam), grid_n=96, grid_size=7 * LENGTH, history="pull.csv", output="out.h5"),
        check=11,
    ).stderr
    assert "step 6" in said and "pulls the surfaces apart" in said and "give disp_z" in said
    with h5py.File(tmp_path / "out.h5") as f:
        load, area, most = (f["history"][name][:] for name in ("load_n", "contact_area", "pull_max"))
    assert area[0] == pytest.approx(np.pi * (1.63602 * LENGTH) ** 2, rel=2e-2)
    assert area[2] == pytest.approx(area[0], rel=1e-6)  # alike from apart and from pressed
    assert load[-1] < load[-2] and most[4] == pytest.approx(-0.98 * force.min() * FORCE) and f"{most[4]:.6g}" in said


def test_bodies_that_may_tilt_roll_away_under_a_pull(petsam, tmp_path):
    (tmp_path / "pull.csv").write_text("time,load_n\n0,0\n1,-1e-7\n2,-2e-7\n")
    ball = dict(BALL, body2_young=3e9, body2_poisson=0.35, gap_radius1=1e-6, adhesion_work=0.05, adhesion_stress=7.14e7)
    run = petsam(dict(ball, grid_n=96, grid_size="146nm", history="pull.csv"), check=11)
    assert "give rot_x = rot_y = 0, as bodies that may tilt roll away under a pull" in run.stderr
    petsam(dict(ball, **UPRIGHT, grid_n=96, grid_size="146nm", history="pull.csv"))


@pytest.mark.parametrize("law, order", [("maugis", 2), ("exponential", 6)])
def test_stiff_bodies_attract_each_other_as_derjaguin_found(law, order):
    """N = -2 pi R (energy of flat surfaces at that gap), and the energy of the tension its integral."""
    reach, gaps = 2e-8, np.array([15e-9, 5e-9])
    energy = WORK * (1 - gaps / reach if law == "maugis" else np.exp(-gaps / reach))
    stored = -2 * np.pi * RADIUS * reach * (energy**2 / 2 / WORK if law == "maugis" else energy)
    off = []
    for cells in (32, 64):
        run = package.run(
            **{**BALL, **UPRIGHT, "body2_young": 1e15}, adhesion_work=WORK, adhesion_stress=WORK / reach,
            adhesion_law=law, grid_n=cells,
            grid_size=2 * np.sqrt(2 * RADIUS * reach * (1.3 if law == "maugis" else 12)),
            history=dict(time=np.arange(2.0), disp_z=-gaps),
        )  # fmt: skip
        off.append(np.abs(np.r_[run["load_n"] / (-2 * np.pi * RADIUS * energy), run["attraction_energy"] / stored] - 1))
    assert off[1].max() < (2e-3 if law == "maugis" else 3e-6)
    assert law == "exponential" or (off[0] / off[1] > 3).all()


@pytest.mark.parametrize("law", ["maugis", "exponential"])
def test_jumps_lead_to_the_states_of_a_slow_motion(law):
    """There and back over both jumps, in steps of which the coarse ones are three fine ones."""
    ways = np.r_[np.linspace(-1.4, 0.4, 19), np.linspace(0.3, -1.4, 18)]
    _, fine = pulled(ways, 1, 48, 8, adhesion_law=law)
    _, coarse = pulled(ways[::3], 1, 48, 8, adhesion_law=law)
    assert coarse == pytest.approx(fine[::3], abs=1e-6)
    assert coarse.min() < -1.4 and coarse[0] > -0.3 and coarse[-1] > -0.3


def energy_at_the_fold(lam, radius=3.0, points=200_001):
    """Energy of the state of the least approach over that of bodies apart: the work of all states between them."""
    _, force, way = maugis(lam)
    tension = lam / 2 * (np.pi * WORK * STIFF**2 / RADIUS) ** (1 / 3)
    c = np.linspace(0, radius, points) * LENGTH  # without contact: a disc of tension lifts the surface
    ways = c**2 / 2 / RADIUS - 4 / np.pi * tension * c / MODULUS - WORK / tension
    apart = -ways >= 2 * tension * c / MODULUS
    fold = np.argmin(way)
    pull = -np.pi * c[apart] ** 2 * tension / FORCE
    return np.trapezoid(pull, ways[apart] / WAY) + np.trapezoid(force[: fold + 1], way[: fold + 1])


@pytest.mark.parametrize("away", [-0.2, -10])
@pytest.mark.parametrize("law", ["maugis", "exponential"])
def test_a_pillar_attracts_by_its_own_gap(law, away):
    """A rigid square of 12 cells, 1 um above the rest: cells beside its edge have the tension of their own gap."""
    reach, height = 1e-9, np.full((24, 24), 1e-6)
    height[6:18, 6:18] = 0
    run = package.run(
        body1_young="inf", body1_poisson=0, body2_young=1e15, body2_poisson=0.3, friction=0, gap=height,
        grid_size=48e-8, adhesion_work=WORK, adhesion_stress=WORK / reach, adhesion_law=law, disp_z=away * reach,
        errors="none", **UPRIGHT,
    )  # fmt: skip
    part = (1 if away > -1 else 0) if law == "maugis" else np.exp(away)
    assert run["load_n"][0] == pytest.approx(-part * WORK / reach * (12 * 2e-8) ** 2, rel=1e-4, abs=1e-12)


@pytest.mark.parametrize("rows", [(0, -0.5, -0.5, -0.5), (0.3, 0, 0)])
def test_loads_that_stay_or_are_zero_are_balanced(petsam, tmp_path, rows):
    """Alike bodies whose pressure stays, and a flat period: pressure and tension cancel, and are no small numbers."""
    alike = dict(BALL, body1_young=BALL["body2_young"], body1_poisson=0.3)
    flat = dict(elasticity="periodic", gap_type="flat", gap_radius1=None, gap_radius2=None)
    case = {**alike, **UPRIGHT} if rows[1] else {**BALL, **flat}
    text = "".join(f"{k},{n * FORCE:.9g}\n" for k, n in enumerate(rows))
    (tmp_path / "rows.csv").write_text(f"time,load_n\n{text}")
    petsam({**case, **adhesion(0.8), "grid_n": 48, "grid_size": 7 * LENGTH, "history": "rows.csv"})


def test_energy_is_lost_in_jumps_alone_and_balances_over_a_loop():
    lam = 1
    _, closed, way = maugis(lam)
    fold, range_ = np.argmin(way), WORK / adhesion(lam)["adhesion_stress"] / WAY
    there = np.r_[-1.2, -range_ + np.array([-0.005, 0.005]), np.linspace(-0.5, 1, 31)]
    back = np.r_[np.linspace(0.95, -0.95, 39), np.arange(-0.96, -1.045, -0.01), -1.2]
    ways = np.r_[there, back]
    run, force = pulled(ways, lam, 96)
    lost, stored = run["adhesion_energy"] / (FORCE * WAY), run["attraction_energy"]
    assert lost.sum() == pytest.approx(np.sum((force[1:] + force[:-1]) / 2 * np.diff(ways)), abs=1e-6)
    assert stored[0] == stored[-1] == 0
    jumps = np.nonzero(np.diff(run["contact_cells"] > 0))[0] + 1
    assert len(jumps) == 2 and np.abs(np.delete(lost, jumps)).max() < 5e-3 and abs(np.delete(lost, jumps).sum()) < 5e-3
    assert way[fold] - 0.02 < ways[jumps[1]] < way[fold] + 0.01
    # out of contact the energy that its last state has over bodies apart; into it what it has below them
    freed, upper = energy_at_the_fold(lam), way[fold:] < -range_
    gained = -freed - np.trapezoid(closed[fold:][upper], way[fold:][upper])
    assert lost[jumps] == pytest.approx([gained, freed], abs=1e-2)


@pytest.mark.parametrize("ranks", [1, 2])
def test_without_work_of_adhesion_results_are_those_without_the_law(petsam, tmp_path, ranks):
    case = dict(BALL, friction=0.3, grid_n=(24, 19), grid_size=6 * LENGTH, load_n=2 * FORCE, load_tx=0.1 * FORCE)
    petsam(dict(case, output="without.h5"))
    petsam(dict(case, adhesion_work=0, adhesion_stress=1e7, output="with.h5"), ranks=ranks)
    with h5py.File(tmp_path / "without.h5") as f, h5py.File(tmp_path / "with.h5") as g:
        assert "tension" not in g
        for name in "pressure", "shear_x":
            assert (f[name][:] == g[name][:]).all()


def test_friction_is_borne_by_the_pressure_of_contact(petsam, tmp_path):
    petsam(
        dict(BALL, **UPRIGHT, **adhesion(1), friction=0.4, grid_n=48, grid_size=7 * LENGTH, output="out.h5",
             disp_z=0.5 * WAY, disp_x=20 * WAY, output_fields="usual"),
    )  # fmt: skip
    with h5py.File(tmp_path / "out.h5") as f:
        pressure, tension, shear = (f[name][-1] for name in ("pressure", "tension", "shear_x"))
        load = f["history/load_n"][-1]
    contact = pressure + tension
    with h5py.File(tmp_path / "out.h5") as f:
        assert f["history/pressure_max"][-1] == pressure.max()
    assert load < 0 and (contact > -1e-6 * tension.max()).all()
    assert np.abs(shear) == pytest.approx(0.4 * np.maximum(contact, 0), abs=1e-5 * contact.max())


SOFT = dict(
    body1_young=1e9, body1_poisson=0.3, body2_young="inf", body2_poisson=0, adhesion_law="exponential",
    elasticity="periodic", output="out.h5",
)  # fmt: skip
TIGHT = dict(
    adhesion_work=0.0138071, adhesion_stress=3.44749e+06, adhesion_law="maugis", friction=0.43, grid_n=33,
    grid_size=2.16509e-05, body1_relax_moduli=(0.3, 0.2), body1_relax_times=(0.1, 1),
)  # fmt: skip
WIDE = dict(
    adhesion_work=0.0810973, adhesion_stress=7247575, adhesion_law="maugis", friction=0.19, grid_n=(41, 30),
    grid_size=3.90641e-05, elasticity="halfspace",
)  # fmt: skip
OVAL = dict(
    adhesion_work=0.0563669, adhesion_stress=6.354e+06, friction=0.14, grid_n=37, grid_size=3.46033e-05,
    slip_direction="end", gap_type="ellipsoid", gap_radius1=None, gap_radius2=None, gap_radius_x=1e-3,
    gap_radius_y=3e-3,
)  # fmt: skip


ROWS = {  # time, N or approach, T_x
    "tight": [(0.951, 3.38181e-06, 6.08699e-07), (1.034, 2.90529e-05, -8.20143e-07)],
    "wide": [
        (0.0558, 1.934648e-04, -3.891587e-07), (3.85, 1.892235e-04, 6.798959e-07), (4.98, 1.633688e-04, -1.75367e-06),
        (5.43, -3.008732e-05, 1.410957e-06), (5.47, 2.158493e-04, 1.589708e-07),
    ],
    "oval": [
        (0.130955625, 2.76066075e-08, -7.84661565e-07), (5.48946933, 1.17866427e-08, -1.06217917e-06),
        (11.1575641, 1.57858607e-08, -1.0438554e-06), (14.4365407, 2.5649212e-08, 5.95113043e-07),
        (15.3753657, 3.62981276e-08, -1.20895369e-06),
    ],
}  # fmt: skip


@pytest.mark.parametrize("case, name", [(TIGHT, "tight"), (WIDE, "wide"), (OVAL, "oval")])
def test_attraction_of_coupled_bodies_with_friction_converges(petsam, tmp_path, case, name):
    """Passes of coupled bodies have rough tolerances and changing loads; the check of each step decides."""
    rows = "".join(f"{t},{n},{q}\n" for t, n, q in ROWS[name])
    (tmp_path / "rows.csv").write_text(f"time,{'disp_z' if name == 'oval' else 'load_n'},load_tx\n{rows}")
    petsam({**BALL, **UPRIGHT, **SOFT, "history": "rows.csv", "allow_edge_contact": True, **case})
    with h5py.File(tmp_path / "out.h5") as f:
        assert len(f["history/load_n"]) == len(ROWS[name]) and f["history/normal_residual"][:].max() < 1.1e-8


@pytest.mark.parametrize(
    "more",
    [
        dict(elasticity="plane", grid_n=97),
        dict(elasticity="periodic", grid_n=(31, 24), adhesion_law="exponential"),
        dict(friction=0.3, disp_x=WAY / 10, grid_n=(30, 3)),
        dict(body2_relax_moduli=0.5, body2_relax_times=1, grid_n=(25, 22)),
    ],
)
def test_same_bits_on_any_number_of_ranks_and_after_restarts(petsam, tmp_path, more):
    rows = [0.5, -0.2, 1.0, -1.3, 0.2]
    (tmp_path / "ways.csv").write_text("time,disp_z\n" + "".join(f"{k},{d * WAY:.9g}\n" for k, d in enumerate(rows)))
    case = dict(BALL, **UPRIGHT, **adhesion(0.6), grid_size=7 * LENGTH, history="ways.csv", allow_edge_contact=True)
    case.update(more)
    if "plane" in case.get("elasticity", ""):
        case.pop("rot_x")
    names = ["pressure", "tension", "history/load_n", "history/contact_area", "history/attraction_energy"]

    def read(name):
        with h5py.File(tmp_path / name) as f:
            return [f[n][-1].tobytes() for n in names]

    petsam(dict(case, output="one.h5", checkpoint="state.h5", checkpoint_every=2))
    for ranks in 2, 3:
        petsam(dict(case, output="more.h5", overwrite=True), ranks=ranks)
        assert read("more.h5") == read("one.h5")
    petsam(dict(case, output="again.h5", restart="state.h5"))
    assert read("again.h5") == read("one.h5")


def test_tension_at_few_cells_and_at_the_border_is_doubted(petsam):
    case = dict(BALL, **UPRIGHT, disp_z=0, output="out.h5", overwrite=True, errors="companion")
    coarse = petsam(dict(case, **adhesion(3), grid_n=48, grid_size=7 * LENGTH)).stderr
    assert re.search(r"load_n unknown.*E\* w/s\^2 = [0-9.e-]+ m, is 0\.\d+ cells wide", coarse.replace("\n", " "))
    assert "warning: the edge of the tension" in coarse.splitlines()[0] and "or -grid_n 1" in coarse.splitlines()[0]
    middle = petsam(dict(case, **adhesion(1), grid_n=32, grid_size=7 * LENGTH)).stderr
    assert re.search(r"load_n 5\.\d %", middle)
    small = petsam(dict(case, **adhesion(0.2), grid_n=48, grid_size=4 * LENGTH)).stderr
    assert "the tension at the border of the grid" in small
    fine = petsam(dict(case, **adhesion(0.6), grid_n=64, grid_size=8 * LENGTH)).stderr
    assert "E* w/s^2" not in fine and "border" not in fine


def test_a_slow_contact_of_relaxing_bodies_is_that_of_the_relaxed_ones():
    """Held without load from touching on: it grows to the contact of the relaxed modulus."""
    relaxed = dict(body2_young=MODULUS * (1 - 0.3**2) / 2)
    held = dict(time=np.r_[0, np.logspace(-2, 2, 25)], load_n=np.zeros(26))
    common = dict(BALL, **UPRIGHT, **adhesion(0.8), grid_n=64, grid_size=9 * LENGTH)
    slow = package.run(**common, history=held, body2_relax_moduli=0.5, body2_relax_times=1)
    soft = package.run(**{**common, **relaxed}, load_n=0)
    assert slow["adhesive_area"][-1] == pytest.approx(soft["adhesive_area"][-1], rel=2e-3)
    assert slow["adhesive_area"][0] < 0.9 * slow["adhesive_area"][-1]
