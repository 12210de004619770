"""Fields that are sums over all steps: the path of the slip and the work of friction, saved or not."""

from math import cos, sin

import h5py
import numpy as np
import pytest

from kinds.kills import differences
from support import SPHERE, ball
from test_wear import BALL, cycle

CASE = dict(SPHERE, load_n=None, grid_n=40, history="history.csv", output="out.h5", slip_direction="end")
SUMS = dict(output_fields="slip_path,friction_energy")
STEPS = 14


@pytest.fixture
def folder(tmp_path):
    """Along a curve, with a normal load that changes, to where much slips and back."""
    t = [k / 2 for k in range(STEPS)]
    rows = [f"{k + 1}, {1000 + 150 * sin(s)!r}, {70 * sin(s)!r}, {50 * cos(s)!r}" for k, s in enumerate(t)]
    (tmp_path / "history.csv").write_text("time, load_n, load_tx, load_ty\n" + "\n".join(rows) + "\n")
    return tmp_path


def share_before(state, earlier, q, ds, bound):
    """The part of the bound before a step in the bound that slip works against: less where cells begin to slide."""
    size = np.maximum(np.hypot(*ds), 1e-300)
    back = np.clip(np.sum(q * ds, axis=0) / np.maximum(bound * size, 1e-300), 0, 1)
    begun = np.where(earlier == 1, 1, back)
    lengths = np.where((state > 0) & (earlier > 0), np.hypot(*ds), np.nan).reshape(len(state), -1)
    alike = np.concatenate(([0], np.nanmin(lengths[1:], axis=1) / np.nanmax(lengths[1:], axis=1)))
    alike = np.minimum(alike / 0.8, 1)[:, None, None]
    late = np.maximum(np.where(state == 0, 0.125, 0.25), 0.5 * alike)
    return np.where(earlier == 0, 0.5, 0.5 + begun * (late - 0.5))


def summed(path, friction):
    """Both sums after each step, by the fields of every step."""
    with h5py.File(path) as f:
        bound, state = friction * f["pressure"][:], f["state"][:]  # 0 open, 1 stick, 2 slip
        slip, q = (np.stack((f[f"{k}_x"], f[f"{k}_y"])) for k in ("slip", "shear"))
    ds = np.diff(slip, axis=1, prepend=0)
    before = [np.concatenate((np.zeros_like(a[:1]), a[:-1])) for a in (state, bound, *q)]
    earlier = before[0]
    slides = (state == 2) | ((state == 0) & (earlier == 2))
    share = share_before(state, earlier, np.stack(before[2:]), ds, before[1])
    share[0] = 0
    work = np.where(slides, (share * before[1] + (1 - share) * bound) * np.hypot(*ds), 0)
    return np.cumsum(np.hypot(*ds), axis=0), np.cumsum(work, axis=0)


def sums(path):
    with h5py.File(path) as f:
        return f["slip_path"][:], f["friction_energy"][:]


@pytest.mark.parametrize("ranks", [1, 2, 3])
def test_sums_are_over_all_steps_saved_or_not(folder, petsam, ranks):
    petsam(CASE, dict(output="all.h5", output_fields="all"))
    petsam(CASE, SUMS, dict(output_every=5), ranks=ranks)
    expected = summed(folder / "all.h5", CASE["friction"])
    saved = [4, 9, 13]
    for found, known in zip(sums(folder / "out.h5"), expected):
        assert np.allclose(found, known[saved], rtol=0, atol=1e-12 * known.max()) and known.max() > 0
    with h5py.File(folder / "out.h5") as f:
        assert f["slip_path"].attrs["units"] == "m" and f["friction_energy"].attrs["units"] == "J/m2"
        area = np.diff(f["x"])[0] * np.diff(f["y"])[0]
        work = np.cumsum(f["history/dissipated_energy"])[saved]
        assert f["friction_energy"][:].sum(axis=(1, 2)) * area == pytest.approx(work, rel=1e-12)


@pytest.mark.parametrize("other", [None, 70e9])
@pytest.mark.parametrize("steps", [1, 4])
def test_cells_add_up_to_the_energy(tmp_path, petsam, other, steps):
    """From the first step on, in which N and a small T grow together: most cells stick, and hardly any work is done."""
    case = dict(CASE, history=None, load_n=1000, load_tx=20, load_mz=1e-3, steps=steps, slip_direction=None)
    petsam(case, SUMS, dict(body2_young=other) if other else {})
    with h5py.File(tmp_path / "out.h5") as f:
        area = np.diff(f["x"])[0] * np.diff(f["y"])[0]
        cells, work = f["friction_energy"][-1] * area, np.sum(f["history/dissipated_energy"])
        assert cells.sum() == pytest.approx(work, rel=1e-12, abs=0) and work > 0
        assert not np.any(cells < 0)


@pytest.mark.parametrize("before, after", [(1, 1), (2, 3)])
def test_sums_go_on_after_a_restart(folder, petsam, before, after):
    """To the last bit; also under another name of the results."""
    kept = dict(checkpoint="state.h5", checkpoint_every=6)
    petsam(CASE, SUMS, dict(output="whole.h5"))
    petsam(CASE, SUMS, kept, ranks=before)
    petsam(CASE, SUMS, dict(restart="state.h5"), ranks=after)
    assert not differences(folder / "out.h5", folder / "whole.h5")
    petsam(CASE, SUMS, dict(restart="state.h5.1", output="rest.h5"), ranks=after)
    for found, known in zip(sums(folder / "rest.h5"), sums(folder / "whole.h5")):
        assert np.array_equal(found, known[6:])


def test_sums_cannot_begin_in_the_middle(folder, petsam):
    petsam(CASE, dict(output_fields="pressure", checkpoint="state.h5", checkpoint_every=6))
    done = petsam(CASE, SUMS, dict(restart="state.h5", output="rest.h5"), check=2)
    assert "-restart state.h5" in done.complaint[0] and "it lacks friction_energy" in done.complaint[0]
    assert not (folder / "rest.h5").exists()


def test_sums_are_kept_only_where_they_are_asked_for(folder, petsam):
    for fields, there in (("pressure", False), ("slip_path", True)):
        petsam(CASE, dict(output_fields=fields, checkpoint="state.h5", checkpoint_every=6, overwrite=True))
        with h5py.File(folder / "state.h5") as f:
            assert ("slip_path" in f) == there and "friction_energy" not in f


@pytest.mark.parametrize("ranks", [1, 2])
def test_sums_of_a_life_are_those_of_its_cycles(tmp_path, petsam, ranks):
    """With no wear to speak of all cycles are the same: after n of them the sums are n times those of one."""
    life = dict(cycle(tmp_path / "cycle.csv"), wear_coefficient2=1e-30, wear_cycles=1e4, wear_output=0)
    petsam(BALL, life, SUMS, dict(output="life.h5"), ranks=ranks)
    for found in sums(tmp_path / "life.h5"):
        assert len(found) == 16
        one, after = found[7], found[15]  # the end of the first cycle, of the one after 1e4
        assert np.allclose(one, (after - one) / 1e4, rtol=0, atol=1e-3 * one.max()) and one.max() > 0
    # the same cycle twice, step by step
    rows = (tmp_path / "cycle.csv").read_text().splitlines()
    t, z, x = np.array([[float(v) for v in row.split(",")] for row in rows[1:]]).T
    columns = (np.append(t, t[1:] + 1), np.append(z, z[1:]), np.append(x, x[1:]))
    twice = [",".join(map(repr, row)) for row in np.transpose(columns).tolist()]
    (tmp_path / "twice.csv").write_text("\n".join([rows[0], *twice]) + "\n")
    petsam(BALL, dict(history="twice.csv", output="direct.h5"), SUMS)
    for found, direct in zip(sums(tmp_path / "life.h5"), sums(tmp_path / "direct.h5")):
        second = direct[-1] - direct[len(t) - 1]
        assert np.allclose((found[15] - found[7]) / 1e4, second, rtol=0, atol=1e-3 * second.max())


def test_sums_of_a_life_go_on_after_a_restart(tmp_path, petsam):
    life = dict(cycle(tmp_path / "cycle.csv"), wear_coefficient2=1e-14, wear_cycles=1e5, **SUMS)
    petsam(BALL, life, dict(output="whole.h5", checkpoint="state.h5", checkpoint_every=1))
    petsam(BALL, life, dict(output="rest.h5", restart="state.h5.1"))
    with h5py.File(tmp_path / "rest.h5") as one, h5py.File(tmp_path / "whole.h5") as two:
        rows = len(one["wear/cycle"])
        assert 0 < rows < len(two["wear/cycle"])
        for name in ("cycle", "volume2", "error"):
            assert np.array_equal(one[f"wear/{name}"][:], two[f"wear/{name}"][-rows:])
        assert one.attrs["branch_rows"] > 0
        for name in ("slip_path", "friction_energy"):
            assert np.array_equal(one[name][-1], two[name][-1])


def test_embedded_contact_keeps_sums_by_an_option():
    import petsam

    options = {name: value for name, value in ball(24).items() if name not in ("load_n", "output_fields")}
    with petsam.Contact(**options, sum_slip_path=True) as contact:
        path, before = 0.0, 0.0
        for tx in (5.0, 20.0, -10.0):
            contact.try_step(load_n=180.0, load_tx=40.0 if tx == 20.0 else tx)
            contact.reject()
            contact.try_step(load_n=180.0, load_tx=tx)
            slip = np.stack((contact["slip_x"], contact["slip_y"]))
            path = path + np.hypot(*(slip - before))
            assert np.allclose(contact["slip_path"], path, rtol=1e-12, atol=0)
            contact.commit()
            assert np.allclose(contact["slip_path"], path, rtol=1e-12, atol=0)
            before = slip
        with pytest.raises(petsam.ContactError, match="friction_energy"):
            contact.field("friction_energy")


def test_load_takes_what_the_contact_accumulates(tmp_path):
    """A sum that only the file has is left out: files and copies after that are those of the contact's options."""
    import petsam

    options = {name: value for name, value in ball(24).items() if name not in ("load_n", "output_fields")}
    with petsam.Contact(**options, sum_slip_path=True) as summing, petsam.Contact(**options) as plain:
        for contact, file in ((summing, tmp_path / "sums.h5"), (plain, tmp_path / "plain.h5")):
            contact.try_step(load_n=180.0, load_tx=20.0)
            contact.commit()
            contact.save(str(file))
        plain.load(str(tmp_path / "sums.h5"))
        with pytest.raises(petsam.ContactError, match="slip_path"):
            plain.field("slip_path")
        with plain.copy() as other:
            assert np.array_equal(other["shear_x"], summing["shear_x"])
        plain.load(str(tmp_path / "plain.h5"))
        with pytest.raises(petsam.ContactError, match="it lacks slip_path"):
            summing.load(str(tmp_path / "plain.h5"))
