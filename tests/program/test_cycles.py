"""Cycles of a history: reversals, periods, their energies and loops, in petsam-plot and in petsam-study."""

import h5py
import numpy as np
import pytest

import petsam
from conftest import PROGRAM as PETSAM
from petsam import cycles
from petsam.plot import keywords, loops, wear
from petsam.plot.style import MARKED
from support import ball, history, slide_limit, table_of, words

pytestmark = pytest.mark.usefixtures("closing")

CASE = ball(n=24)
LIMIT = slide_limit(CASE)[0]
STEPS = 5  # of a stroke
TURNS = (0.6, -0.5, 0.7, -0.6, 0.7, -0.6, 0.7)  # of T_x over mu N


def program(folder, turns, name="h.csv"):
    """A history of T_x that turns there, a second a stroke, from zero."""
    rows = [(0, 0.0), *((k, float(turn * LIMIT)) for k, turn in enumerate(turns, 1))]
    return history(folder / name, "time,load_tx", *rows)["history"]


@pytest.fixture(scope="module")
def path(solve, tmp_path_factory):
    """Three cycles after the first loading; fields of every step."""
    return solve(CASE, dict(history=program(tmp_path_factory.mktemp("history"), TURNS), steps=STEPS)).path


def strokes(path):
    """Rows in which the strokes of T_x end."""
    with h5py.File(path, "r") as file:
        time = file["history/time"][:]
    return [int(np.argmin(abs(time - k))) for k in range(1, len(TURNS) + 1)]


# ---------------------------------------------------------------- where they are


@pytest.mark.parametrize(
    "values, turns",
    [
        ([0, 1, 2, 1, 0, -1, 0, 3], [2, 5]),
        ([1, 0, 1], [0, 1]),  # from zero up to the first value, which is a turn
        ([-1, -2, -3], []),
        ([0, 2, 2, 2, 1, 1, 2], [3, 5]),  # a plateau turns where it ends
        ([0, 1, 1 - 1e-6, 2, 0], [3]),  # rounding
        ([0, 0, 0], []),
        ([], []),
        ([5], []),
    ],
)
def test_values_turn_at_their_extremes(values, turns):
    assert cycles.turning_points(values) == turns
    assert cycles.turning_points(-1e-9 * np.array(values)) == turns


@pytest.mark.parametrize(
    "values, found",
    [
        ([0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0], [(1, 5), (5, 9)]),
        ([0, 1, 0, -1, 0, 1], [(1, 5)]),  # the end closes it
        ([0, 1, 0, -1, 0, 0.995], [(1, 5)]),
        ([0, 1, 0, -1, 0, 0.9], []),
        ([0, 1, 0, -1, 0, 2], [(1, 5)]),  # and goes on
        ([0, -1, 0, 1, 0, -1.5], [(1, 5)]),
        ([0, 1, 2], []),
        ([0, 1, -1, 0.2, -1, 0.2], [(1, 3), (3, 5)]),  # of any size
    ],
)
def test_cycles_go_from_a_turn_to_the_second_next_one(values, found):
    got = cycles.by_turns(np.array(values, dtype=float))
    assert [(one.first, one.last) for one in got] == found
    assert [one.number for one in got] == list(range(1, len(found) + 1))


@pytest.mark.parametrize(
    "times, period, start, found",
    [
        (np.arange(9) * 0.1, 0.4, None, [(0, 4), (4, 8)]),
        (np.arange(1, 9) * 0.1, 0.4, None, [(-1, 3), (3, 7)]),  # the row of zeros is no step
        (np.arange(9) * 0.1, 0.3, None, [(0, 3), (3, 6)]),
        (np.arange(9) * 0.1, 0.3, 0.1, [(1, 4), (4, 7)]),
        (np.arange(9) * 0.1, 0.25, None, [(0, 2), (2, 5), (5, 7)]),
        (np.arange(-3, 9) * 0.1, 0.4, None, [(3, 7), (7, 11)]),
        (np.arange(5) + 2.0, 2.0, None, [(0, 2), (2, 4)]),
        (np.arange(3.0), 5.0, None, []),
    ],
)
def test_cycles_of_a_period_follow_one_another(times, period, start, found):
    assert [(one.first, one.last) for one in cycles.by_period(times, period, start)] == found


# ---------------------------------------------------------------- energies


def test_energies_are_sums_over_the_steps_of_each_cycle(results, path):
    ends = strokes(path)
    energy = results.history["dissipated_energy"]
    expected = [energy[a + 1 : b + 1].sum() for a, b in zip(ends[0:-2:2], ends[2::2])]
    for found in (cycles.find(results), cycles.find(results, turns="load_tx"), cycles.find(results, None, (2.0, 1.0))):
        assert [(one.first, one.last) for one in found] == list(zip(ends[0:-2:2], ends[2::2]))
        assert np.allclose(found.energies, expected, rtol=1e-12)
    assert expected[1] == pytest.approx(expected[2], rel=1e-3)  # a cycle between the same loads


def test_cycles_without_the_name_or_the_period_are_refused(results):
    with pytest.raises(petsam.Error, match="--turns load_q: has no such scalar: is load_n meant. It has contact_area"):
        cycles.find(results, turns="load_q")
    with pytest.raises(petsam.Error, match="--period: a period of 0.0001 s is shorter than the steps, 0.2 s"):
        cycles.find(results, period=(1e-4, None))
    for number in (0, 4, -4, 1.5):
        with pytest.raises(petsam.Error, match=f"cycle {number:g}: there are cycles 1 to 3, by reversals"):
            cycles.find(results).numbered(number)
    assert repr(cycles.find(results)).startswith(f"Cycles({len(cycles.find(results))} of {results.path}, by ")
    assert cycles.find(results).numbered(-1).number == 3


def test_energy_is_drawn_over_the_number_of_the_cycle(results):
    found = cycles.find(results)
    axes = loops.energy([found]).axes[0]
    x, y = axes.lines[0].get_data()
    factor = {"nJ": 1e9, "µJ": 1e6}[axes.get_ylabel().split()[-1]]
    assert x.tolist() == [1, 2, 3] and np.allclose(y, factor * found.energies, rtol=1e-14)
    assert axes.get_ylim()[0] == 0.0 and axes.get_title().endswith("reversals of disp_x")


def test_loops_of_chosen_cycles_are_closed_curves_of_their_steps(results, path):
    ends = strokes(path)
    figure = loops.cycle_loops([cycles.find(results)], "tx", [1, -1])
    first, last = figure.axes[0].lines
    for line, (a, b) in ((first, (ends[0], ends[2])), (last, (ends[4], ends[6]))):
        assert np.allclose(line.get_ydata(), results.history["load_tx"][a : b + 1], rtol=1e-14)
    assert last.get_ydata()[0] == pytest.approx(last.get_ydata()[-1], rel=1e-12)
    texts = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert [text.split(":")[0] for text in texts] == ["1", "3"]
    energies = cycles.find(results).energies
    assert any(texts[1].split()[1] == f"{factor * energies[2]:.4g}" for factor in (1e6, 1e9))


def test_every_pair_that_varies_can_be_drawn(results):
    for pair, (load, way) in cycles.PAIRS.items():
        if pair not in ("n", "tx"):  # what else changes is rounding
            with pytest.raises(petsam.Error, match=f"{load} or {way} does not vary"):
                loops.cycle_loops([cycles.find(results)], pair, [2])
            continue
        line = loops.cycle_loops([cycles.find(results)], pair, [2]).axes[0].lines[0]
        cycle = cycles.find(results).numbered(2)
        for got, name in zip(line.get_data(), (way, load)):
            expected = results.history[name][cycle.rows]
            assert np.allclose(got * np.abs(expected).max(), expected * np.abs(got).max())


def test_the_fretting_log_needs_no_life(results):
    axes = wear.fretting_log([results], None, cycles.find).axes[0]
    assert len(axes.lines) == 3
    texts = [text.get_text().split(":")[0] for text in axes.get_legend().get_texts()]
    assert texts == ["1", "2", "3"]


@pytest.mark.parametrize("count, shown", [(1, [1]), (3, [1, 2, 3]), (8, list(range(1, 9))), (100, [1, 15, 29])])
def test_of_many_cycles_some_are_drawn(count, shown):
    found = loops.spread(count)
    assert found[: len(shown)] == shown and found[-1] == count and len(found) == min(count, loops.LOOPS)


def test_long_loops_are_lines_without_marks(results):
    assert loops.loop([results]).axes[0].lines[0].get_marker() == "."
    x = 5.0 * np.sin(np.arange(loops.DENSE + 5.0))
    results.history.update({name: np.zeros(x.size) for name in results.history})
    del results.__dict__["solved"]
    results.history.update(load_tx=x, disp_x=2.0 * x)
    axes = loops.loop([results], "tx").axes[0]
    assert all(line.get_marker() in ("", "None", None) for line in axes.lines if len(line.get_xdata()) > MARKED)
    (cloud,) = axes.collections
    points = np.concatenate([piece.vertices[1:] for piece in cloud.get_paths()])
    assert np.allclose(points, np.column_stack([2.0 * x, x])[1:]) and cloud.get_alpha() < 0.5
    results.history.update({name: values[: MARKED + 1] for name, values in results.history.items()})
    del results.__dict__["solved"]
    line = loops.loop([results], "tx").axes[0].lines[0]
    assert len(line.get_xdata()) == MARKED + 1 and line.get_marker() in ("", "None", None)


# ---------------------------------------------------------------- the programs


def names(folder):
    return sorted(file.name for file in folder.iterdir())


def test_three_cycles_give_their_loops_and_energies_too(draw, path, tmp_path):
    assert draw(path) == (0, [])
    kinds = ("energy", "fretting-log", "history", "loop", "maps", "profiles")
    assert names(tmp_path) == [f"results_{kind}.png" for kind in kinds]


@pytest.mark.parametrize(
    "words",
    [
        ("--energy", "--turns", "load_tx"), ("--period", "2,1"), ("--turns", "disp_x"), ("--energy", "--log", "y"),
        ("--loop", "--cycle", "-1,2", "--load", "n"), ("--cycle", "3", "--period", "1"), ("--maps", "--cycle", "-1"),
        ("--fretting-log", "--cycle", "1,3"),
    ],
)  # fmt: skip
def test_cycles_are_chosen(draw, path, tmp_path, words):
    assert draw(*words, path, "-o", "one.png") == (0, [])
    assert names(tmp_path) == ["one.png"]


def test_a_map_of_a_cycle_is_that_of_its_end(results, path):
    ((_, index),) = keywords.Frames(cycle=1).snapshots([results])
    assert results.steps[index] == strokes(path)[2] + 1


@pytest.mark.parametrize(
    "words, code, says",
    [
        (
            ("--energy", "--turns", "load_q"),
            3,
            "--turns load_q: has no such scalar: is load_n meant? It has contact_area",
        ),
        (("--loop", "--cycle", "9"), 3, "--cycle 9: there are cycles 1 to 3, by reversals of disp_x"),
        (("--energy", "--period", "99"), 3, "--energy: has no whole cycle, by a period of 99 s; see"),
        (("--energy", "--period", "1e-9"), 3, "is shorter than the steps"),
        (("--energy", "--period", "0"), 2, "--period: 0: expected a time above 0, or T,START"),
        (("--energy", "--period", "1,2,3"), 2, "--period: 1,2,3: expected a time above 0"),
        (("--energy", "--period", "-1"), 2, "--period: -1: expected a time above 0"),
        (("--energy", "--period", "1", "--turns", "disp_x"), 2, "not allowed with"),
        (("--loop", "--cycle", "one"), 2, "--cycle: one: expected numbers"),
    ],
)
def test_what_is_no_cycle_is_named(draw, path, words, code, says):
    got, (error,) = draw(*words, path)
    assert got == code and says in error and "TRACEBACK" not in error


@pytest.fixture
def study(call, launcher, monkeypatch):
    """study(*words): exit code and messages of petsam-study in tmp_path."""

    monkeypatch.setenv("PETSAM", str(PETSAM))
    monkeypatch.setenv("MPIRUN", " ".join(launcher))
    return lambda *words: call("petsam-study", *words)


def table(folder):
    return table_of(folder / "cases" / "results.csv")


def test_the_table_of_a_study_has_energies_of_cycles(study, tmp_path):
    program(tmp_path, TURNS, "long.csv")
    program(tmp_path, TURNS[:2], "short.csv")
    (tmp_path / "cases.csv").write_text("history,case\nlong.csv,long\nshort.csv,short\n")
    common = ("--quiet", "--cores", 1, "--", *words(CASE), "-steps", STEPS)
    assert study("cases.csv", *common) == (0, [])
    long, short = table(tmp_path)
    with h5py.File(tmp_path / "cases" / "results.h5", "r") as both:
        time, energy = (both["cases/long/history"][name][:] for name in ("time", "dissipated_energy"))
        last = both["results/dissipated_energy_cycle_last"]
        assert last.attrs["units"] == "J" and last[0] == float(long["dissipated_energy_cycle_last"])
        assert np.isnan(last[1])
    expected = [energy[(time > k + 1e-9) & (time <= k + 2 + 1e-9)].sum() for k in (1, 3, 5)]
    assert long["cycles"] == "3" and short["cycles"] == ""
    assert float(long["dissipated_energy_cycle_last"]) == pytest.approx(expected[2], rel=1e-12, abs=0)
    change = expected[2] / expected[1] - 1.0
    assert float(long["dissipated_energy_cycle_change"]) == pytest.approx(change, rel=1e-9, abs=1e-13)
    # other cycles, without running again
    assert study("cases.csv", "--turns", "load_tx", "--cycle", "1,-2", *common) == (0, [])
    long, short = table(tmp_path)
    for name, value in (("1", expected[0]), ("-2", expected[1])):
        assert float(long["dissipated_energy_cycle_" + name]) == pytest.approx(value, rel=1e-12, abs=0)
    assert short["cycles"] == "0" and short["dissipated_energy_cycle_last"] == "nan"
    assert study("cases.csv", "--period", "7", *common) == (0, [])
    assert float(table(tmp_path)[0]["dissipated_energy_cycle_last"]) == pytest.approx(energy[1:].sum(), rel=1e-9, abs=0)
    code, (error,) = study("cases.csv", "--turns", "load_q", *common)
    assert code == 3 and "--turns load_q: has no such scalar: is load_n meant? It has contact_area" in error
