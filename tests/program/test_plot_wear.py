"""petsam-plot of wear: pictures of true lives, what they show, and files that have none."""

import h5py
import numpy as np
import pytest

import petsam
from petsam.plot import crossings, fields, loops, series, wear
from petsam.plot.style import over_cycles, plt
from petsam.plot.units import counted, scale
from support import ball, slide_limit

pytestmark = pytest.mark.usefixtures("closing")

CASE = ball(n=24)
AMPLITUDE = 0.8 * slide_limit(CASE)[0]
TURNS = "reversals of disp_x"
SAVED = [0.0, 500.0, 2000.0]


@pytest.fixture(scope="module")
def cycle(tmp_path_factory):
    """A closed cycle of T_x, its table."""
    table = tmp_path_factory.mktemp("cycle") / "cycle.csv"
    loads = (float(sign * AMPLITUDE) for sign in (0, 1, -1, 0))
    table.write_text("time,load_tx\n" + "".join(f"{k},{load!r}\n" for k, load in enumerate(loads)))
    return table


@pytest.fixture(scope="module")
def path(solve, cycle):
    """A life in which both bodies wear, body 2 three times as much as body 1."""
    wears = dict(wear_coefficient1=1e-12, wear_coefficient2=3e-12, wear_cycles=2000, wear_output=(0, 500))
    return solve(CASE, dict(history=cycle, steps=3), wears).path


@pytest.fixture
def life(path):
    return petsam.open(path)


@pytest.fixture(scope="module")
def one_body(solve, cycle):
    """A life in which body 2 alone wears."""
    return solve(CASE, dict(history=cycle, steps=2, wear_energy2=1e-12, wear_cycles=2000, wear_output=0)).path


@pytest.fixture(scope="module")
def direct(solve, cycle):
    """Every step wears."""
    return solve(CASE, dict(history=cycle, wear_coefficient1=1e-9)).path


@pytest.fixture(scope="module")
def plain(solve, cycle):
    """Nothing wears."""
    return solve(CASE, dict(history=cycle)).path


def curves(axes):
    """(x, y) of the lines with a point or more."""
    return [line.get_data() for line in axes.lines if len(line.get_xdata())]


def texts(axes):
    """The legend's title and its lines."""
    legend = axes.get_legend()
    return legend.get_title().get_text(), [text.get_text() for text in legend.get_texts()]


# ---------------------------------------------------------------- results


def test_wear_is_a_table_of_the_computed_cycles(life, path):
    with h5py.File(path, "r") as file:
        for name, data in file["wear"].items():
            assert np.array_equal(life.wear[name], data) and life.wear_units[name] == data.attrs["units"]
    assert life.has_life and life.wear["cycle"][0] == 0 and life.wear["cycle"][-1] == 2000
    with pytest.raises(petsam.Error, match="has no volume3"):
        life.wear["volume3"]


def test_saved_cycles_are_found_by_their_number(life):
    assert [life.cycles[index] for index in life.cycle_ends] == SAVED
    for cycle, expected in ((0, 0), (600, 500), (1900, 2000)):
        index = life.of_cycle(cycle)
        assert life.cycles[index] == expected and abs(life.history["load_tx"][life.steps[index] - 1]) < 1e-9 * AMPLITUDE
    with pytest.raises(petsam.Error, match="cycle 3000: fields were saved from 0 to 2000"):
        life.of_cycle(3000)


def test_steps_of_a_life_are_named_by_its_cycles(life):
    assert life.title(life.of_cycle(500)).endswith("after 500 cycles")


def test_files_without_a_life_have_an_empty_table(direct, plain):
    for path in (direct, plain):
        results = petsam.open(path)
        assert not results.has_life and not results.wear
        with pytest.raises(petsam.Error, match="-wear_cycles"):
            results.of_cycle(0)


def test_a_cycle_that_is_in_some_datasets_only_does_not_count(path, tmp_path):
    """As a killed run may leave it."""
    killed = tmp_path / "killed.h5"
    killed.write_bytes(path.read_bytes())
    with h5py.File(killed, "r+") as file:
        cut, units = file["wear/volume2"][:-1], file["wear/volume2"].attrs["units"]
        del file["wear/volume2"]
        file["wear/volume2"] = cut
        file["wear/volume2"].attrs["units"] = units
    results = petsam.open(killed)
    assert {values.size for values in results.wear.values()} == {cut.size}
    wear.life([results])
    wear.fretting_log([results])


# ---------------------------------------------------------------- the program


def drawn(folder):
    """Names of the files in a folder."""
    return sorted(file.name for file in folder.iterdir())


def test_a_life_gives_its_own_pictures(draw, path, tmp_path):
    assert draw(path) == (0, [])
    assert drawn(tmp_path) == [f"results_{kind}.png" for kind in ("fretting-log", "life", "maps", "profiles", "scar")]


def test_wear_of_every_step_gives_the_pictures_of_a_history(draw, direct, tmp_path):
    assert draw(direct) == (0, [])
    assert drawn(tmp_path) == [f"results_{kind}.png" for kind in ("history", "loop", "maps", "profiles")]


@pytest.mark.parametrize(
    "words",
    [
        ("--fretting-log", "--load", "tx"), ("--scar", "--cycle", "0,2000"), ("--scar", "--at", "0,0"),
        ("--scar", "--step", "1,-1", "--whole-grid"), ("--life",), ("--maps", "--cycle", "0,2000"),
        ("--profiles", "--cycle", "500"),
    ],
)  # fmt: skip
def test_each_picture_alone_has_the_name_that_is_given(draw, path, one_body, tmp_path, words):
    assert draw(*words, path, one_body, "-o", "one.pdf") == (0, [])
    assert drawn(tmp_path) == ["one.pdf"]


@pytest.mark.parametrize(
    "words, lack",
    [
        (("--life",), "has no life of many cycles (petsam -wear_cycles)"),
        (("--fretting-log",), "--fretting-log: has no whole cycle, by reversals of disp_x; see --turns and --period"),
        (("--maps", "--cycle", "0"), "--cycle 0: there is no whole cycle, by " + TURNS),
    ],
)
def test_a_file_without_a_life_or_a_cycle_is_named(draw, path, direct, plain, words, lack):
    for file in (direct, plain):
        for files in ([file], [path, file]):
            assert draw(*words, *files) == (3, [f"petsam-plot: error: {file}: {lack}"])


@pytest.mark.parametrize(
    "words, message",
    [
        (("--scar", "--cycle", "0"), "nothing has worn"),
        (("--scar", "--cycle", "9000"), "--cycle 9000: fields were saved"),
        (("--scar", "--at", "1,0"), "--at 1,0: is not on the grid"),
    ],
)
def test_what_cannot_be_drawn_of_wear_is_named(draw, path, words, message):
    code, (error,) = draw(*words, path)
    assert code == 3 and error.startswith("petsam-plot: error: ") and message in error


@pytest.mark.parametrize(
    "words", [("--fretting-log", "--turns", "load_tx"), ("--maps", "--cycle", "0", "--period", "1")]
)
def test_the_cycles_of_a_life_are_not_chosen_anew(draw, path, plain, words):
    """The file of a life says what its cycles are. Beside one that does not, an option is of use."""
    kind, option = words[0], words[-2]
    code, (error,) = draw(*words, path)
    assert code == 2 and f"{option}: has no effect on the picture {kind[2:]}" in error
    code, (error,) = draw(*words, path, plain)
    assert code == 3 and str(plain) in error and "has no effect" not in error


def test_a_scar_of_a_file_without_wear_is_refused(draw, plain):
    code, (error,) = draw("--scar", plain)
    assert code == 3 and "has no removed depth (petsam -wear_coefficient1" in error


def test_steps_and_cycles_exclude_each_other(draw, path):
    code, (error,) = draw("--cycle", "0", "--step", "1", path)
    assert code == 2 and "not allowed with" in error


@pytest.mark.parametrize(
    "change",
    [
        lambda file: file.__delitem__("wear/pressure_max"),
        lambda file: file["wear/cycle"].attrs.__delitem__("units"),
        lambda file: file["wear"].__setitem__("loop", file["wear"]),
        lambda file: (file.__delitem__("wear"), file.__setitem__("wear", [1.0])),
        lambda file: (file.__delitem__("wear"), file.__setitem__("wear", h5py.ExternalLink("pipe", "/x"))),
    ],
)
def test_a_damaged_life_is_named(draw, path, tmp_path, change):
    odd = tmp_path / "odd.h5"
    odd.write_bytes(path.read_bytes())
    with h5py.File(odd, "r+") as file:
        change(file)
    code, (error,) = draw("--life", odd)
    assert code == 3 and error.startswith(f"petsam-plot: error: {odd}: ") and "TRACEBACK" not in error


# ---------------------------------------------------------------- the fretting log


def test_loops_are_closed_and_enclose_the_energy_of_their_cycle(life):
    """But for the energy between steps: the sides of the loop are straight."""
    axes = wear.fretting_log([life]).axes[0]
    assert axes.get_ylabel() == "$T_x$, N" and axes.get_xlabel() in ("$d_x$, nm", "$d_x$, µm")
    unit = 1e-9 if "nm" in axes.get_xlabel() else 1e-6
    for (x, y), row in zip(curves(axes), wear.logged(life)):
        steps = life.of_computed_cycle(life.wear["cycle"][row])
        assert steps.size == 9 and (x[0], y[0]) == (x[-1], y[-1])
        assert np.allclose(y[1:], life.history["load_tx"][steps]) and np.allclose(
            unit * x[1:], life.history["disp_x"][steps]
        )
        area = unit * abs(np.sum(0.5 * (y[1:] + y[:-1]) * np.diff(x)))
        assert np.isclose(area, life.wear["dissipated_energy"][row], rtol=0.3)


def test_loops_are_few_and_from_the_first_cycle_to_the_last(life):
    title, names = texts(wear.fretting_log([life]).axes[0])
    assert 3 <= len(names) <= wear.LOOPS and title == "thousand cycles: energy of the loop"
    assert names[0].startswith("0: ") and names[-1].startswith("2: ") and names[0].endswith("J")


def test_loops_divide_the_wear_evenly(life):
    life.wear.update(volume1=np.arange(100.0) ** 2, volume2=np.zeros(100), cycle=np.arange(100.0))
    assert np.allclose(np.diff(life.wear["volume1"][wear.logged(life)]), 99.0**2 / 7, rtol=0.2)


def test_several_lives_have_a_panel_each(life, one_body):
    axes = wear.fretting_log([life, petsam.open(one_body)]).axes
    assert len(axes) == 2 and axes[0].get_ylim() == axes[1].get_ylim()


# ---------------------------------------------------------------- scars


def test_scars_go_through_the_deepest_point_of_each_body(life, path):
    steps = [(life, index) for index in wear.scar_steps(life)]
    figure = wear.scar(steps)
    assert len(figure.axes) == 4
    unit = {"nm": 1e-9, "µm": 1e-6}[figure.axes[0].get_ylabel().split()[-1]]
    for row, name in enumerate(("wear_depth1", "wear_depth2")):
        with h5py.File(path, "r") as file:
            depths = file[name][:]
        for axes in figure.axes[2 * row : 2 * row + 2]:
            lines = curves(axes)
            assert len(lines) == len(SAVED) and np.all(lines[0][1] == 0)
            for (_, depth), index in zip(lines[1:], life.cycle_ends[1:]):
                assert 0 < unit * depth.max() <= depths[index].max() * (1 + 1e-12)
            assert np.isclose(unit * lines[-1][1].max(), depths[-1].max(), rtol=1e-12)
            assert axes.yaxis_inverted()
    assert texts(figure.axes[1]) == ("thousand cycles", ["0", "0.5", "2"])


def test_scars_go_through_the_point_that_is_given(life, path):
    at = (3.2 * (life.x[1] - life.x[0]), -2.4 * (life.y[1] - life.y[0]))
    figure = wear.scar([(life, -1 % life.times.size)], at, whole=True)
    row, column = (int(np.argmin(np.abs(axis - place))) for axis, place in ((life.y, at[1]), (life.x, at[0])))
    with h5py.File(path, "r") as file:
        depth = file["wear_depth1"][-1]
    unit = {"nm": 1e9, "µm": 1e6}[figure.axes[0].get_ylabel().split()[-1]]
    assert np.allclose(curves(figure.axes[0])[0][1], unit * depth[row], rtol=1e-12)
    assert np.allclose(curves(figure.axes[1])[0][1], unit * depth[:, column], rtol=1e-12)


def test_the_deepest_point_is_found_block_by_block(life, path, monkeypatch):
    monkeypatch.setattr(wear, "BLOCK", 5)
    with h5py.File(path, "r") as file:
        depth = file["wear_depth2"][-1]
    row, column = np.unravel_index(np.argmax(depth), depth.shape)
    index = life.of_last()
    assert wear.deepest(life, "wear_depth2", index) == (depth.max(), (life.x[column], life.y[row]))


def test_a_body_that_does_not_wear_has_no_scar(one_body, direct):
    for path, body in ((one_body, "2"), (direct, "1")):
        results = petsam.open(path)
        axes = wear.scar([(results, index) for index in wear.scar_steps(results)]).axes
        assert len(axes) == 2 and axes[0].get_title().startswith(f"body {body} along $x$")
    assert texts(axes[1]) == ("step", ["4"])


PROFILE = "# from a stylus\nx [um],one [nm],two [nm]\n-50,0,1\n0,-20,-10\n50,0,0\n"


def test_measured_profiles_stand_beside_the_scar_of_their_body(life, tmp_path):
    table = tmp_path / "profile.csv"
    table.write_text(PROFILE)
    for body, row in (("", 1), ("1", 0), ("2", 1)):
        figure = wear.scar([(life, life.of_last())], measured=(body, str(table)))
        lines = [axes.lines for axes in figure.axes]
        assert [len(drawn) for drawn in lines] == [3 if k == 2 * row else 1 for k in range(4)]
        unit = {"nm": 1e9, "µm": 1e6}[figure.axes[0].get_ylabel().split()[-1]]
        across = {"mm": 1e3, "µm": 1e6}[figure.axes[0].get_xlabel().split()[-1]]
        x, depth = lines[2 * row][1].get_data()
        assert np.allclose(x, across * np.array([-5e-5, 0, 5e-5])) and np.allclose(depth, unit * np.array([0, 2e-8, 0]))
        assert [line.get_label() for line in lines[2 * row][1:]] == ["measured: one", "measured: two"]


@pytest.mark.parametrize(
    "text, complaint",
    [
        ("x [mm],y [um]\n", "has a head, but no lines of numbers below it"),
        ("x [mm],y [um]\n0,1\n", "expected a line of column names"),
        ("x [mm],[um]\n0,1\n1,2\n", "line 1: column [um]: expected a name and a unit of length"),
        ("x,y [um]\n0,1\n1,2\n", "line 1: column x: expected a name and a unit of length"),
        ("z [mm],x [um]\n0,1\n1,2\n", "line 1: column z [mm]: expected x (or y) first"),
        ("x [mm],y [um],y [mm]\n0,1,1\n1,2,2\n", "line 1: two columns are y: remove one"),
        ("x [m],y [um]\n5,1\n6,2\n", "beside the scar: check its unit"),
        ("#\nx [mm],y [um]\n0,1\n1,a\n", "line 4: a in column y is no finite number"),
        ("x [mm],y [um]\n0,1\n1,nan\n", "line 3: nan in column y is no finite number"),
        ("x [mm],y [um]\n0,1\n1,2,3\n", "line 3 has 3 words, line 1 has 2 heads"),
        ("x [mm],y [um]\n0,1\n1_000,2\n", "line 3: 1_000 in column x is no finite number"),
    ],
)
def test_a_measured_profile_that_is_none_is_named_with_its_line(draw, path, tmp_path, text, complaint):
    table = tmp_path / "profile.csv"
    table.write_text(text)
    code, (error,) = draw("--scar", "--measured", f"2:{table}", path)
    assert code == 3 and complaint in error


def test_a_measured_profile_of_a_body_that_does_not_wear_is_refused(draw, one_body, tmp_path):
    (tmp_path / "profile.csv").write_text(PROFILE)
    code, (error,) = draw("--scar", "--measured", f"1:{tmp_path}/profile.csv", one_body)
    assert code == 3 and "body 1 does not wear" in error


# ---------------------------------------------------------------- the life


def test_life_is_the_table_over_the_cycles(life):
    axes = wear.life([life]).axes
    assert [panel.get_ylabel().split(",")[0] for panel in axes[:5]] == [title for _, title in wear.LIFE]
    assert all(panel.get_xlabel() == "cycles" for panel in axes[:5])
    for panel, (names, _) in zip(axes, wear.LIFE):
        factor, unit = scale(life.wear_units[names[0]], max(life.wear[name].max() for name in names))
        assert panel.get_ylabel().endswith(", " + unit)
        for (x, y), name in zip(curves(panel), names):
            assert np.allclose(x, life.wear["cycle"]) and np.allclose(y, factor * life.wear[name])


@pytest.mark.parametrize("last, kind", [(40.0, "linear"), (5e3, "symlog")])
def test_cycles_over_two_decades_are_on_a_logarithmic_axis_with_zero(last, kind):
    panel = plt.figure().add_subplot()
    over_cycles(panel, [np.array([0.0, last]), np.array([0.0, 20.0])])
    assert panel.get_xscale() == kind and panel.get_xlabel() == "cycles"
    assert kind == "linear" or panel.transData.transform((20.0, 0.0))[0] > panel.transData.transform((0.0, 0.0))[0] + 50
    plt.close(panel.figure)


def test_life_shows_the_bodies_that_wear(life, one_body):
    both, alone = wear.life([life]).axes, wear.life([petsam.open(one_body)]).axes
    assert len(curves(both[0])) == 2 and texts(both[5])[1] == ["results", "body 1", "body 2"]
    assert len(curves(alone[0])) == 1 and "of body 2" in alone[0].get_ylabel()
    assert alone[5].get_legend() is None and alone[5].figure.get_suptitle() == ""
    assert wear.life([petsam.open(one_body, "mine")]).get_suptitle() == "mine"
    assert len(curves(wear.life([life, petsam.open(one_body)]).axes[0])) == 4


# ---------------------------------------------------------------- the ordinary pictures


def test_maps_and_profiles_have_the_depths_of_what_has_worn(life, one_body, path):
    def columns(*steps):
        return [axes.get_title() for axes in fields.maps(list(steps)).axes if axes.get_title()]

    end, alone = (life, life.of_last()), petsam.open(one_body)
    assert columns(end)[4:] == ["depth removed of body 1, $w_1$", "depth removed of body 2, $w_2$"]
    assert columns((alone, alone.of_last()))[4:] == ["depth removed of body 2, $w_2$"]
    assert len(columns((life, life.of_cycle(0)))) == 4
    with h5py.File(path, "r") as file:
        depth = file["wear_depth2"][-1]
    figure = fields.maps([end], whole=True)
    panel = figure.axes[5]
    bar = panel.images[0].colorbar.ax
    unit = {"nm": 1e9, "µm": 1e6}[bar.get_ylabel().split()[-1]]
    assert np.allclose(panel.images[0].get_array(), unit * depth)
    axes = crossings.profiles([end], whole=True).axes
    assert np.isclose(max(y.max() for _, y in curves(axes[-2])), unit * depth[11:13].max(), rtol=1e-6)


def test_a_file_without_wear_beside_one_with_it_has_an_empty_place(life, plain):
    results = petsam.open(plain)
    axes = fields.maps([(life, life.of_last()), (results, results.of_last())]).axes
    assert [panel.axison for panel in axes[:12]] == [True] * 10 + [False] * 2
    crossings.profiles([(life, life.of_last()), (results, results.of_last())])


def test_history_of_a_life_sums_no_energy_of_some_of_its_cycles(life, direct):
    def names(results):
        return [axes.get_ylabel().split(",")[0] for axes in series.history([results]).axes]

    assert "dissipated energy" not in names(life) and "volume removed of body 2" in names(life)
    assert {"dissipated energy", "volume removed of body 1"} <= set(names(petsam.open(direct)))
    energy, text = life.wear["dissipated_energy"][-1], texts(loops.loop([life]).axes[0])[1][0]
    assert " in the last cycle" in text and any(f"{factor * energy:.4g} " in text for factor in (1e9, 1e6))


@pytest.mark.parametrize(
    "cycles, factor, words",
    [(0, 1, "cycles"), (999, 1, "cycles"), (5e4, 1e-3, "thousand cycles"), (3e6, 1e-6, "million cycles")],
)
def test_cycles_are_counted_in_words(cycles, factor, words):
    assert counted(cycles) == (pytest.approx(factor), words)


@pytest.mark.parametrize(
    "value, factor, text", [(4e-12, 1e9, "mm³"), (2e-7, 1e9, "mm³"), (5e-13, 1e18, "µm³"), (3e-19, 1e18, "µm³")]
)
def test_volumes_are_in_cubes(value, factor, text):
    got = scale("m3", value)
    assert np.isclose(got[0], factor, rtol=1e-12) and got[1] == text
