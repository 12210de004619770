"""Wear: direct and over the cycles of a life, its results, restarts, and what is refused."""

import re
import shutil
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest

import conftest
from support import ball, flatten, read_run

BALL = ball(40, load_n=None)
MU, RADIUS, D = BALL["friction"], BALL["gap_radius1"], 2e-6
E_STAR = 72e9 / (1 - 0.34**2) / 2


def cycle(path, amplitude=0.6 * MU * D, steps=8, header="time,disp_z,disp_x", approach=D, last=0.0):
    """Along x to and fro, from 0 to 0; the first row is where the cycle starts."""
    t = np.arange(steps + 1) / steps
    x = amplitude * np.interp(t, (0, 0.25, 0.75, 1), (0, 1, -1, last))
    path.write_text(header + "\n" + "".join(f"{a!r},{approach!r},{b!r}\n" for a, b in zip(t.tolist(), x.tolist())))
    return dict(history=path)


def assert_equal(one, two, *without):
    assert one.keys() == two.keys()
    for name in one:
        if name not in without:
            assert np.array_equal(one[name], two[name], equal_nan=one[name].dtype.kind == "f"), name


@pytest.fixture
def life(petsam, tmp_path):
    """life(name=value, ...): the results of a short life of the ball, with these options."""

    def run(output="life.h5", ranks=1, **options):
        case = dict(BALL, **cycle(tmp_path / "cycle.csv"), wear_coefficient2=1e-14, wear_cycles=1e5, output=output)
        petsam({**case, **options}, ranks=ranks)
        return read_run(tmp_path / output)

    return run


# ---- every step wears


@pytest.mark.parametrize("law", ["coefficient", "energy"])
def test_volume_of_direct_wear_is_the_energy_of_friction(petsam, tmp_path, law):
    rates = (3e-14, 1e-14) if law == "coefficient" else (3e-14 / MU, 1e-14 / MU)
    words = {f"wear_{law}{body}": rate for body, rate in zip((1, 2), rates)}
    steps = cycle(tmp_path / "h.csv", header="time,load_n,disp_x", approach=180.0, amplitude=3 * MU * 2e-6)
    petsam(BALL, steps, words, dict(output="direct.h5"))
    r = read_run(tmp_path / "direct.h5")
    energy = np.cumsum(r["history/dissipated_energy"])
    cell = (BALL["grid_size"] / BALL["grid_n"]) ** 2
    for body, rate in zip((1, 2), (3e-14, 1e-14)):
        assert r[f"history/wear_volume{body}"] == pytest.approx(rate * energy / MU, rel=1e-9)
        assert r[f"wear_depth{body}"].sum((1, 2)) * cell == pytest.approx(r[f"history/wear_volume{body}"], rel=1e-12)
        assert (np.diff(r[f"wear_depth{body}"], axis=0) >= 0).all()
    assert "history/cycle" not in r and "wear/cycle" not in r


def test_the_gap_follows_at_the_end_of_a_step(petsam, tmp_path):
    steps = cycle(tmp_path / "h.csv", amplitude=20 * MU * D)
    petsam(BALL, steps, dict(wear_coefficient1=1e-11, output="direct.h5"))
    r = read_run(tmp_path / "direct.h5")
    x = (np.arange(40) - 19.5) * BALL["grid_size"] / 40
    unworn = (x[:, None] ** 2 + x**2) / (2 * RADIUS)
    removed = np.concatenate([0 * r["wear_depth1"][:1], r["wear_depth1"][:-1]])
    gap = r["displacement_z"] + unworn + removed - D
    assert np.abs(gap - r["gap"]).max() < 1e-9 * D
    assert r["wear_depth1"].max() > 0.01 * D


def test_gap_is_that_of_the_solution(petsam, tmp_path):
    """Without what the step wears: tried, committed, after a failed step, in files, and in a life."""
    import petsam as package

    def gap_of(contact):
        contact.save(str(tmp_path / "state.h5"))
        with contact.copy() as copy, package.Contact(**options) as loaded:
            loaded.load(str(tmp_path / "state.h5"))
            assert np.array_equal(copy["gap"], contact["gap"]) and np.array_equal(loaded["gap"], contact["gap"])
        return contact["gap"]

    options = {name: value for name, value in BALL.items() if name not in ("load_n", "output_fields")}
    options["wear_coefficient1"] = 1e-12
    with package.Contact(**options) as contact:
        for load_tx in (20.0, -20.0):
            contact.try_step(load_n=180.0, load_tx=load_tx)
            tried = contact["gap"]
            contact.commit()
            assert contact["wear_depth1"].max() > 0 and np.array_equal(gap_of(contact), tried)
        with pytest.raises(package.NoEquilibrium):
            contact.try_step(load_n=180.0, load_tx=1e4)
        contact.reject()
        assert np.array_equal(gap_of(contact), tried)
        to_and_fro = dict(time=[1.0, 2, 3, 4, 5], load_n=[180.0] * 5, load_tx=[-20.0, 20, -20, 20, -20])
        contact.live(1e3, to_and_fro)
        touching, depth = contact["pressure"] > 0, contact["wear_depth1"]
        assert np.abs(contact["gap"][touching]).max() < 1e-3 * depth.max() < 1e-3 * D
    rows = [f"{k + 1},180,{load_tx}" for k, load_tx in enumerate((0, 20, -20, 1e4))]
    (tmp_path / "h.csv").write_text("\n".join(["time,load_n,load_tx", *rows]) + "\n")
    for every in (1, 10):
        petsam(BALL, dict(history="h.csv", wear_coefficient1=1e-12, output=f"{every}.h5", output_every=every), check=11)
    with h5py.File(tmp_path / "1.h5") as one, h5py.File(tmp_path / "10.h5") as ten:
        assert one["time"][-1] == ten["time"][-1] == 3 and np.array_equal(one["gap"][-1], ten["gap"][-1])


def test_steps_that_wear_too_much_are_told_once(petsam, tmp_path):
    case = dict(BALL, wear_coefficient1=1e-9, steps=4)
    told = petsam(case, cycle(tmp_path / "h.csv", amplitude=20 * MU * D)).stderr
    times = float(re.search(r"^petsam: warning: step \d+: wear is (\S+) times the limit of a step", told, re.M)[1])
    assert times > 1 and told.count("wear is") == 1
    fewer = dict(case, wear_coefficient1=1e-9 / (20 * times))
    assert "wear is" not in petsam(fewer, cycle(tmp_path / "h.csv", amplitude=20 * MU * D)).stderr


# ---- a life


def test_life_is_the_same_on_any_number_of_ranks(life):
    one = life()
    for ranks in (2, 3):
        assert_equal(life(ranks=ranks, output=f"r{ranks}.h5"), one)


def test_life_tells_its_cycles(life):
    r = life(wear_output=(0, 30000))
    cycles, jumps = r["wear/cycle"], r["wear/jump"]
    assert cycles[0] == 0 and cycles[-1] == 1e5 and 30000 in cycles and (np.diff(cycles) == jumps[1:]).all()
    assert (cycles == np.floor(cycles)).all() and (r["wear/error"][1:] <= 0.02).all()
    assert (np.diff(r["wear/computed"]) >= 2).all()
    # a row of the history for each step of these cycles, whose times go on
    assert (r["history/cycle"] == np.repeat(cycles, 8)).all()
    assert r["history/time"] == pytest.approx(r["history/cycle"] + np.tile(np.arange(1, 9) / 8, len(cycles)))
    energy = r["history/dissipated_energy"].reshape(-1, 8).sum(1)
    assert r["wear/dissipated_energy"] == pytest.approx(energy)
    assert r["history/wear_volume2"].reshape(-1, 8) == pytest.approx(np.repeat(r["wear/volume2"], 8).reshape(-1, 8))
    # fields of the cycles that were asked for
    saved = np.flatnonzero(np.isin(r["history/time"], r["time"]))
    assert (np.unique(r["history/cycle"][saved]) == (0, 30000, 1e5)).all() and len(saved) == 24
    last = r["wear_depth2"][-1]
    assert last.max() == pytest.approx(r["wear/depth_max2"][-1]) and not r["wear_depth1"].any()
    assert last.sum() * (BALL["grid_size"] / 40) ** 2 == pytest.approx(r["wear/volume2"][-1])
    assert r["wear/pressure_max"][-1] == r["pressure"][-1].max()


def test_stresses_of_a_cycle_by_its_number(life, launcher, tmp_path):
    r = life(wear_output=(0, 30000))
    steps = np.flatnonzero(r["history/cycle"] == 30000) + 1
    program = conftest.PROGRAM.with_name("petsam-stress")
    case = dict(input="life.h5", section="y=0", depths=1e-6, quantities="none", fatigue="swt")
    for name, which in (("one", dict(cycle=30000)), ("two", dict(steps=f"{steps[0]}:{steps[-1]}"))):
        conftest.execute(launcher, tmp_path, [dict(case, output=f"{name}.h5", **which)], 1, 0, program=program)
    with h5py.File(tmp_path / "one.h5") as one, h5py.File(tmp_path / "two.h5") as two:
        assert one["history/step"][:].tolist() == steps.tolist() and np.array_equal(one["swt"][:], two["swt"][:])
    for words, says in (
        (dict(cycle=500), "-cycle 500: the steps of that cycle are not in life.h5, those of 0, 30000, 100000 are"),
        (dict(cycle=0, steps=1), "-cycle does not work with -steps"),
    ):
        done = conftest.execute(launcher, tmp_path, [dict(case, output="no.h5", **words)], 1, 2, program=program)
        assert says in done.stderr


def test_wear_of_a_life_is_the_work_of_friction_over_it(life):
    r = life(wear_rtol=2e-3)
    rate = 1e-14 / MU * r["wear/dissipated_energy"]
    worn = np.concatenate([[0], np.cumsum(np.diff(r["wear/cycle"]) * (rate[1:] + rate[:-1]) / 2)])
    assert r["wear/volume2"] == pytest.approx(worn, rel=2e-3)


def test_it_does_not_matter_which_body_wears_or_by_which_law(life):
    reference = life()
    for k, words in enumerate(
        (
            dict(wear_coefficient1=1e-14, wear_coefficient2=0.0),
            dict(wear_coefficient1=0.5e-14, wear_coefficient2=0.5e-14),
            dict(wear_coefficient2=None, wear_energy2=1e-14 / MU),
        )
    ):
        r = life(**words, output=f"{k}.h5")
        total = r["wear_depth1"][-1] + r["wear_depth2"][-1]
        assert np.abs(total - reference["wear_depth2"][-1]).max() < (1e-9 if k < 2 else 1e-6) * total.max()
        assert np.abs(r["pressure"][-1] - reference["pressure"][-1]).max() < 1e-7 * r["pressure"].max()


def test_fixed_jumps_and_those_by_their_error_come_to_the_same(life):
    by_error, fixed = life(), life(wear_jump=40000.0, output="fixed.h5")
    assert fixed["wear/cycle"].tolist() == [0, 40000, 80000, 100000]
    assert fixed["wear/volume2"][-1] == pytest.approx(by_error["wear/volume2"][-1], rel=0.05)


def test_jumps_of_parts_of_cycles(petsam, tmp_path):
    """Jumps of any length lead to the same wear, and end at the outputs and at the last cycle exactly."""
    case = dict(BALL, wear_coefficient2=1e-11, wear_cycles=6, wear_output="3,6")
    found = {}
    for jump in (0.1, 0.7, 1):
        petsam(case, dict(wear_jump=jump, output=f"{jump}.h5", **cycle(tmp_path / "cycle.csv")))
        found[jump] = read_run(tmp_path / f"{jump}.h5")
    assert found[0.7]["wear/cycle"] == pytest.approx([0, 0.7, 1.4, 2.1, 2.8, 3, 3.7, 4.4, 5.1, 5.8, 6], rel=1e-12)
    for r in found.values():
        assert r["wear/cycle"][-1] == 6 and 3 in r["wear/cycle"]
        assert r["wear/volume2"][-1] == pytest.approx(found[1]["wear/volume2"][-1], rel=2e-3)
    assert len(found[0.1]["wear/cycle"]) == 61


def test_friction_changes_over_a_life(life, tmp_path):
    (tmp_path / "mu.csv").write_text(f"cycle,friction\n0,{MU / 2}\n20000,{MU}\n")
    r = life(friction=None, wear_friction=tmp_path / "mu.csv", wear_output=(0, 20000))
    p, q = r["pressure"], np.hypot(r["shear_x"], r["shear_y"])
    slips = r["state"] == 2
    for k, moment in enumerate(r["time"]):
        mu = MU * min(1, 0.5 + 0.5 * np.floor(moment - 1e-9) / 20000)
        assert q[k][slips[k]] == pytest.approx((mu * p[k])[slips[k]], rel=1e-4)
    scale = r["history/friction_scale"]
    assert scale == pytest.approx(1 + np.minimum(r["history/cycle"] / 20000, 1))


def test_depth_never_falls(petsam, tmp_path):
    """Friction that grows so fast that a jump's second half has nothing to wear: extrapolated, less than nothing."""
    (tmp_path / "mu.csv").write_text("cycle,friction\n0,0.02\n1000,50\n")
    steps = cycle(tmp_path / "h.csv", header="time,load_n,disp_x", approach=100.0, amplitude=4e-7)
    words = dict(friction=None, wear_friction=tmp_path / "mu.csv", wear_coefficient2=1e-12, wear_jump=1000)
    petsam({**BALL, **words}, steps, dict(wear_cycles=1000, wear_output=0, output="hard.h5"))
    r = read_run(tmp_path / "hard.h5")
    assert (r["wear_depth2"] >= 0).all() and r["wear/volume2"][-1] > 0
    cell = (BALL["grid_size"] / BALL["grid_n"]) ** 2
    assert r["wear_depth2"][-1].sum() * cell == pytest.approx(r["wear/volume2"][-1])


def test_joint_that_hardly_slips_takes_few_cycles(petsam, tmp_path):
    """It rocks where it sticks: what seems to slip is what the solvers leave open."""
    steps = cycle(tmp_path / "h.csv", header="time,load_n,load_my", approach=180.0, amplitude=0.01)
    petsam(BALL, steps, dict(load_tx=8, wear_coefficient2=1e-14, wear_cycles=1e6, output="few.h5"))
    assert read_run(tmp_path / "few.h5")["wear/computed"][-1] <= 30


def test_large_error_of_a_fixed_jump_is_told_once(petsam, tmp_path):
    case = dict(BALL, wear_coefficient2=1e-14, wear_cycles=4e7, wear_jump=1e7)
    done = petsam(case, cycle(tmp_path / "h.csv"))
    assert done.stderr.count("after 10000000 cycles: the error of the last jump is 0.1") == 1


# ---- stopped and continued


def test_killed_life_goes_on_to_the_same_bits(life, launcher, tmp_path):
    reference = life()
    words = flatten([BALL, cycle(tmp_path / "cycle.csv"), dict(wear_coefficient2=1e-14, wear_cycles=1e5)])
    kept = dict(output="kept.h5", checkpoint="state.h5", checkpoint_every=1)
    for k in range(3):
        restart = dict(restart="state.h5" if (tmp_path / "state.h5").exists() else None)
        run = subprocess.Popen(
            [str(conftest.PROGRAM), *words, *flatten([kept, restart])], cwd=tmp_path, env=conftest.environment(),
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        time.sleep(0.8 + 0.3 * k)
        run.send_signal(signal.SIGKILL)
        run.wait()
    assert (tmp_path / "state.h5").exists()
    assert_equal(life(**kept, restart="state.h5", ranks=2), reference)


def test_direct_wear_goes_on_to_the_same_bits(petsam, tmp_path):
    words = (BALL, cycle(tmp_path / "h.csv", amplitude=2 * MU * D), dict(wear_coefficient1=1e-12))
    petsam(*words, dict(output="whole.h5"))
    kept = dict(output="kept.h5", checkpoint="state.h5", checkpoint_every=4)
    petsam(*words, kept)
    petsam(*words, kept, dict(restart="state.h5.1"), ranks=2)
    assert_equal(read_run(tmp_path / "kept.h5"), read_run(tmp_path / "whole.h5"))


def test_life_can_be_prolonged(life, petsam, tmp_path):
    """A restart may ask for more cycles; what wears must stay the same."""
    stopped = life(checkpoint="state.h5", checkpoint_every=1, output="kept.h5")
    (tmp_path / "mu.csv").write_text(f"cycle,friction\n0,{MU}\n1000,{2 * MU}\n")
    shutil.copy(tmp_path / "kept.h5", tmp_path / "jumps.h5")
    jumps = life(wear_cycles=2e5, wear_jump=5e4, checkpoint=None, restart="state.h5", output="jumps.h5")["wear/jump"]
    assert 5e4 in jumps[len(stopped["wear/jump"]) - 1 :]
    more = life(wear_cycles=2e5, restart="state.h5", output="kept.h5")
    assert more["wear/cycle"][-1] == 2e5 and (more["wear/cycle"][: len(stopped["wear/cycle"]) - 1] < 1e5).all()
    for words, name in (
        (dict(wear_coefficient2=2e-14), "wear_coefficient2"),
        (dict(wear_coefficient2=None, wear_energy2=1e-14), "wear_"),
        (dict(wear_cycles=None), "continue from it: the bodies wear by cycles there, not by steps (-wear_cycles)"),
        (dict(friction=None, wear_friction="mu.csv"), "wear_friction"),
    ):
        before = (tmp_path / "kept.h5").read_bytes()
        case = dict(BALL, **cycle(tmp_path / "cycle.csv"), wear_coefficient2=1e-14, wear_cycles=1e5)
        done = petsam({**case, **words}, dict(output="kept.h5", restart="state.h5"), check=2)
        assert name in done.stderr and (tmp_path / "kept.h5").read_bytes() == before


# ---- the end of a life


def test_force_that_is_no_longer_carried_ends_the_life(petsam, tmp_path):
    """Under a given approach wear takes away N, until friction cannot carry T_x."""
    steps = cycle(tmp_path / "h.csv", header="time,disp_z,load_tx", approach=D, amplitude=0.75 * MU * 180)
    case = dict(wear_coefficient2=1e-13, wear_cycles=1e9, output="end.h5")
    plain = petsam(dict(BALL, disp_z=D))
    n = float(plain.stdout.split("load_n")[1].split()[0])
    cycle(tmp_path / "h.csv", header="time,disp_z,load_tx", approach=D, amplitude=0.75 * MU * n)
    done = petsam(BALL, steps, case, check=11)
    assert "cycles, step" in done.stderr and "slip" in done.stderr
    r = read_run(tmp_path / "end.h5")
    assert len(r["wear/cycle"]) > 3 and (np.diff(r["wear/volume2"]) > 0).all()
    assert (r["history/status"][:-8] == 0).all()


def test_scar_at_the_edge_ends_the_life(petsam, tmp_path):
    case = dict(BALL, grid_size=1.15 * 2 * np.sqrt(RADIUS * D), wear_coefficient2=1e-13, wear_cycles=1e7, output="e.h5")
    done = petsam(case, cycle(tmp_path / "h.csv"), check=12)
    assert "edge" in done.stderr and "cycles, step" in done.stderr
    assert 1 < len(read_run(tmp_path / "e.h5")["wear/cycle"]) < 100


def test_step_that_fails_is_marked(petsam, tmp_path):
    """A life ends at a step of the cycle or of one within a jump; either way the history's last row tells."""
    steps = cycle(tmp_path / "h.csv", header="time,disp_z,load_tx", approach=D, amplitude=1.2 * MU * 180)
    petsam(BALL, steps, dict(wear_coefficient2=1e-13, wear_cycles=1e9, output="end.h5"), check=11)
    with h5py.File(tmp_path / "end.h5") as f:
        assert f["history/status"][-1] == 11 and not f["history/status"][:-1].any()
        assert (np.diff(f["history/time"][:]) > 0).all()


# ---- seen by others


def test_stresses_of_a_computed_cycle_are_those_of_a_closed_one(life, launcher, tmp_path):
    """The step before belongs to a cycle on other surfaces, and is not the cycle's end."""
    count = len(life(wear_output=(0, 1e5))["history/time"])
    words = dict(
        input="life.h5", output="s.h5", steps=f"{count - 7}:{count}", fatigue="swt", section="y=0", depths=4e-5
    )
    program = conftest.PROGRAM.with_name("petsam-stress")
    done = conftest.execute(launcher, tmp_path, [words], 1, 0, program=program)
    assert done.stderr == ""
    words.update(steps="all")
    told = conftest.execute(launcher, tmp_path, [words], 1, 0, program=program).stderr
    assert "of several cycles of a wear simulation, from 0 to 1" in told


# ---- bad input
