"""petsam-plot of petsam-study's tables: columns over one another, curves by other columns, and what is not there."""

import itertools

import h5py
import numpy as np
import pytest

import petsam
from petsam.apps.study.cases import Case
from petsam.apps.study.tables import write_hdf5
from petsam.plot import tables
from petsam.results.studies import Study

pytestmark = pytest.mark.usefixtures("closing")

RATIOS, FRICTIONS, SHAPES = (0.5, 0.1, 0.9), (0.1, 0.4), ("ball", "punch")


def energy(ratio, mu, shape):
    """What the cases would have dissipated, J."""
    return mu * ratio**3 * (1e-6 if shape == "ball" else 2e-6)


def row(number, ratio, mu, shape, code=0):
    """A case as the tables have it; of one that has failed nothing is known."""
    inputs = {"ratio": str(ratio), "load_tx": str(100 * mu * ratio), "mu": str(mu), "shape": shape, "nu": "0.3"}
    case = Case(number, f"case{number}", inputs, {"grid_n": "64"}, {}, 1)
    values = {
        "load_tx": (99.9 * mu * ratio, "N"),
        "load_ty": (1e-13 * number, "N"),
        "dissipated_energy_sum": (energy(ratio, mu, shape), "J"),
        "stick_area": (1e-6 * (1 - ratio), "m2"),
        "contact_area": (1e-6, "m2"),
        "normal_iterations": (number, "1"),
    }
    return case, {"exit_code": code, "seconds": 1.0, "message": ""}, values if code == 0 else {}


@pytest.fixture
def path(tmp_path):
    """A study of every combination, and a case that has failed."""
    (tmp_path / "mine").mkdir()
    combinations = itertools.product(RATIOS, FRICTIONS, SHAPES)
    found = [row(number, *values) for number, values in enumerate(combinations, 1)]
    write_hdf5(str(tmp_path / "mine" / "results.h5"), [*found, row(99, 1.0, 0.1, "ball", 11)], "mine.yaml")
    return tmp_path / "mine" / "results.h5"


@pytest.fixture
def study(path):
    return Study(path)


def curves(axes):
    """Label: (x, y, colour, mark) of the curves."""
    return {line.get_label(): (*line.get_data(), line.get_color(), line.get_marker()) for line in axes.lines}


# ---------------------------------------------------------------- reading


def test_a_table_is_read_whole(study, path):
    assert isinstance(petsam.open(path), petsam.Study)
    assert study.label == "mine" and study.cases.size == study.codes.size == 13
    assert study.inputs["ratio"].dtype.kind == "f" and study.inputs["shape"].tolist()[:2] == ["ball", "punch"]
    assert study.column("stick_area")[1] == "m2" and study.column("mu")[1] == ""
    assert study.column("load_tx_end")[0][0] == pytest.approx(99.9 * 0.05) and study.column("load_tx")[0][0] == 5.0
    assert "load_tx_end" in study.names and "load_tx" in study.names
    with pytest.raises(
        petsam.Error,
        match="area: there is no such column: is contact_area or stick_area meant. There are load_tx, mu, nu, ",
    ):
        study.column("area")


# ---------------------------------------------------------------- what is drawn


def test_an_ending_is_left_out_only_of_a_known_name():
    assert tables.titled("load_tx_end") == tables.titled("load_tx") and tables.titled("odd_end") == "odd end"


def test_a_result_is_drawn_over_a_parameter_with_a_curve_for_each_of_the_others(study):
    axes = tables.study([study], ["dissipated_energy_sum"], "ratio", "mu").axes[0]
    drawn = curves(axes)
    assert set(drawn) == {f"mu = {mu:g}, shape = {shape}" for mu in FRICTIONS for shape in SHAPES}
    assert axes.get_ylabel() == "dissipated energy, sum, nJ" and axes.get_xlabel() == "ratio"
    for mu, shape in itertools.product(FRICTIONS, SHAPES):
        x, y, _, _ = drawn[f"mu = {mu:g}, shape = {shape}"]
        assert x.tolist() == sorted(RATIOS)
        assert np.allclose(y, [1e9 * energy(ratio, mu, shape) for ratio in sorted(RATIOS)], rtol=1e-12)
    colours = {name: color for name, (_, _, color, _) in drawn.items()}
    marks = {name: mark for name, (_, _, _, mark) in drawn.items()}
    assert colours["mu = 0.1, shape = ball"] == colours["mu = 0.1, shape = punch"] != colours["mu = 0.4, shape = ball"]
    assert marks["mu = 0.1, shape = ball"] == marks["mu = 0.4, shape = ball"] != marks["mu = 0.1, shape = punch"]


def test_marks_tell_curves_of_one_parameter_apart_without_colours(study):
    drawn = curves(tables.study([study], ["dissipated_energy_sum"], "ratio", "mu", [("shape", "ball")]).axes[0])
    assert len(drawn) == len(FRICTIONS) == len({mark for _, _, _, mark in drawn.values()})


def test_errors_are_bars_and_no_panels(tmp_path):
    found = [row(k, ratio, 0.1, "ball") for k, ratio in enumerate(RATIOS, 1)]
    for k, (_, _, values) in enumerate(found, 1):
        values["stick_area_error"] = (1e-8 * k, "m2")
    write_hdf5(str(tmp_path / "results.h5"), found, "mine.yaml")
    study = Study(tmp_path / "results.h5")
    figure = tables.study([study])
    assert not any("error" in axes.get_ylabel() for axes in figure.axes)
    axes = tables.study([study], ["stick_area"], "ratio").axes[0]
    heights = [np.ptp(bar[:, 1]) for bars in axes.collections for bar in bars.get_segments()]
    assert sorted(heights) == pytest.approx([2e-8 * k * 1e6 for k in (1, 2, 3)])  # mm2
    assert not tables.study([study], ["dissipated_energy_sum"], "ratio").axes[0].collections


def test_by_names_what_the_colours_stand_for(study):
    drawn = curves(tables.study([study], ["stick_area"], "ratio", "shape").axes[0])
    colours = {name: color for name, (_, _, color, _) in drawn.items()}
    assert colours["shape = ball, mu = 0.1"] == colours["shape = ball, mu = 0.4"] != colours["shape = punch, mu = 0.1"]


def test_cases_are_chosen_by_their_values(study):
    where = [("mu", "0.4"), ("shape", "punch")]
    axes = tables.study([study], ["stick_area"], "load_tx", None, where, ["x", "y"]).axes[0]
    ((x, y, _, _),) = curves(axes).values()
    assert np.allclose(x, [4.0, 20.0, 36.0]) and np.allclose(y, [0.9, 0.5, 0.1])
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log") and axes.get_ylabel() == "stick area, mm²"


def test_by_itself_what_varies_is_drawn_over_the_input_with_the_most_values(study):
    figure = tables.study([study])
    drawn = [axes.get_ylabel().split(",")[0] for axes in figure.axes if axes.lines]
    # neither what is constant, nor numbers without a unit, nor rounding
    assert drawn == ["dissipated energy", "$T_x$", "stick area"]
    assert {axes.get_xlabel() for axes in figure.axes if axes.lines} == {"$T_x$, N"}
    assert figure.get_suptitle() == "omitted: 1 unfinished case"


def test_inputs_tell_curves_apart_also_where_no_cases_share_an_abscissa(tmp_path):
    found = []
    for number, (load, mu) in enumerate([(80, 0.65), (120, 0.65), (100, 0.5), (140, 0.5)]):
        case = Case(number, f"case{number}", {"load_tx": str(load), "friction": str(mu)}, {}, {}, 1)
        values = {"slip_max": (1e-9 * load / mu, "m")}
        found.append((case, {"exit_code": 0, "seconds": 1.0, "message": ""}, values))
    write_hdf5(str(tmp_path / "results.h5"), found, "pairs.csv")
    drawn = curves(tables.study([Study(tmp_path / "results.h5")], ["slip_max"], "load_tx").axes[0])
    expected = {"friction = 0.65": [80.0, 120.0], "friction = 0.5": [100.0, 140.0]}
    assert {name: x.tolist() for name, (x, _, _, _) in drawn.items()} == expected


@pytest.fixture
def single(tmp_path):
    """Cases of one step each, of loads that are inputs: what is known twice stands in the table twice."""
    found = []
    for number, (normal, tangential) in enumerate(itertools.product((100.0, 200.0), (5.0, 10.0, 15.0))):
        inputs = {"load_n": str(normal), "load_tx": str(tangential)}
        energy = 1e-9 * tangential**3 / normal
        values = {
            "dissipated_energy": (energy, "J"), "dissipated_energy_sum": (energy, "J"),
            "load_n": (normal * (1 + 1e-9), "N"), "load_tx": (tangential, "N"),
            "stored_energy": (2 * energy, "J"), "pressure_max": (1e6 * tangential, "Pa"),
        }  # fmt: skip
        case = Case(number, f"case{number}", inputs, {}, {}, 1)
        found.append((case, {"exit_code": 0, "seconds": 1.0, "message": ""}, values))
    write_hdf5(str(tmp_path / "results.h5"), found, "single.csv")
    return Study(tmp_path / "results.h5")


def test_what_is_known_twice_is_drawn_once_and_inputs_have_their_units(single):
    figure = tables.study([single])
    drawn = [axes.get_ylabel() for axes in figure.axes if axes.lines]
    assert [name.split(",")[0] for name in drawn] == ["dissipated energy", "pressure max", "stored energy"]
    assert drawn[0].startswith("dissipated energy, sum")
    assert set(curves(figure.axes[0])) == {"$N$ = 100 N", "$N$ = 200 N"}
    assert {axes.get_xlabel() for axes in figure.axes if axes.lines} == {"$T_x$, N"}
    x = figure.axes[0].lines[0].get_xdata()
    assert x.tolist() == [5.0, 10.0, 15.0]
    named = tables.study([single], ["dissipated_energy", "load_n_end"])
    assert [axes.get_ylabel().split(",")[0] for axes in named.axes if axes.lines] == ["dissipated energy", "$N$"]


def test_an_input_has_the_unit_of_the_result_of_its_name(single):
    single.units["load_n"] = "N/m"  # in plane strain
    assert set(curves(tables.study([single]).axes[0])) == {"$N$ = 100 N/m", "$N$ = 200 N/m"}


def test_loads_in_plane_strain_are_per_metre(single):
    one = Study(single.path)
    assert one.unit_of_input("load_n") == "N"
    one.units["load_n"] = "N/m"
    assert one.unit_of_input("load_n") == "N/m" and one.unit_of_input("grid_size") == "m"
    assert one.unit_of_input("contact_area") == one.unit_of_input("way") == one.unit_of_input("creep_x") == ""


def test_several_studies_are_told_apart(study, path):
    drawn = curves(
        tables.study([study, Study(path, "other")], ["stick_area"], "ratio", "mu", [("shape", "ball")]).axes[0]
    )
    assert set(drawn) == {f"{who}, mu = {mu:g}" for who in ("mine", "other") for mu in FRICTIONS}
    assert len({color for _, _, color, _ in drawn.values()}) == 4


def test_a_result_is_drawn_over_another_one(study):
    axes = tables.study([study], ["stick_area"], "dissipated_energy_sum", "mu", [("shape", "ball")]).axes[0]
    assert axes.get_xlabel() == "dissipated energy, sum, nJ"
    x, y, _, _ = curves(axes)["mu = 0.1"]
    assert np.allclose(x, [1e9 * energy(ratio, 0.1, "ball") for ratio in (0.1, 0.5, 0.9)])
    assert np.allclose(y, (0.9, 0.5, 0.1))


# ---------------------------------------------------------------- the program


@pytest.mark.parametrize(
    "words", [(), ("--scalar", "stick_area,load_tx_end", "--by", "mu"), ("--against", "ratio", "--where", "shape=ball")]
)
def test_one_picture_is_drawn(draw, path, tmp_path, words):
    assert draw(path, *words, "-o", "a.svg") == (0, [])
    assert (tmp_path / "a.svg").read_bytes().startswith(b"<?xml")
    assert draw(path, *words) == (0, []) and (tmp_path / "mine_study.png").exists()


@pytest.mark.parametrize(
    "words, says",
    [
        (
            ["--scalar", "area"],
            "--scalar area: there is no such column: is contact_area or stick_area meant? There are load_tx, mu, nu, ",
        ),
        (["--against", "shape"], "--against shape: holds texts, no numbers"),
        (["--against", "x"], "--against x: there is no such column; there are load_tx"),
        (["--by", "x"], "--by x: there is no such column; there are load_tx"),
        (["--where", "mu=0.2"], "--where mu=0.2: no case has it; there are 0.1, 0.4"),
        (["--where", "load_tx=7"], "--where load_tx=7: no case has it; there are 1, 4, 5, 9, 10, "),
        (["--where", "mu=high"], "--where mu=high: expected a number"),
        (["--where", "load_tx=7mm"], "--where load_tx=7mm: expected a number; units are N, kN"),
        (["--where", "load_tx=7mN"], "--where load_tx=7mN: no case has it; there are 1, 4, 5, 9, 10, "),
        (["--where", "shape=cube"], "--where shape=cube: no case has it; there are ball, punch"),
        (["--where", "size=1"], "--where size: there is no such column"),
        (["--where", "ratio=1"], "none of the chosen cases has finished"),
        (
            ["--against", "load_tx,mu", "--border", "stick_area=1mm"],
            "--border stick_area: expected a unit of these: m2, cm2",
        ),
        (["--maps"], "--maps: a table of petsam-study, drawn by --scalar, --against and --by"),
        (["--step", "1"], "--step: a table of petsam-study, which has no steps"),
    ],
)
def test_what_a_study_lacks_is_named(draw, path, words, says):
    code, (error,) = draw(path, *words)
    assert code == 3 and error.startswith(f"petsam-plot: error: {path}: ") and says in error, error


@pytest.mark.parametrize(
    "words", ["--scalar lost", "--scalar load_ty --against lost", "--scalar lost --against ratio,mu"]
)
def test_a_column_without_a_number_is_no_empty_picture(draw, path, tmp_path, words):
    with h5py.File(path, "r+") as file:
        like = file["results/load_ty"]
        lost = file.create_dataset("results/lost", data=np.full(like.shape, np.nan))
        lost.attrs.update(like.attrs)
    code, (error,) = draw(path, "-o", tmp_path / "x.png", *words.split(), "--where", "shape=ball")
    assert code == 2 and error.endswith(" lost: no chosen case has a number; use another column")
    assert not (tmp_path / "x.png").exists()


def test_tables_and_results_do_not_go_into_one_picture(draw, path, solve):
    from support import ball

    code, (error,) = draw(path, solve(ball(n=24)).path)
    assert code == 3 and "results of petsam-study and of petsam do not go into one picture" in error


@pytest.mark.parametrize(
    "change",
    [
        lambda file: file.__delitem__("exit_code"),
        lambda file: file["inputs"].__setitem__("more", np.zeros(3)),
        lambda file: file["results"].__setitem__("more", np.zeros((13, 2))),
        lambda file: (file.__delitem__("results"), file.__setitem__("results", np.zeros(3))),
    ],
)
def test_tables_of_another_form_are_named(draw, path, change):
    with h5py.File(path, "r+") as file:
        change(file)
    code, (error,) = draw(path)
    assert code == 3 and error.startswith(f"petsam-plot: error: {path}: ") and "TRACEBACK" not in error


def test_inputs_with_units_are_numbers(tmp_path):
    """As petsam reads them, to the last bit, of any input; texts, and numbers of two kinds, remain texts."""
    texts = {
        "gap_radius1": ["2.6mm", "2.5e-3", "1e3um"],
        "depth": ["1mm", "20um", "3e-1nm"],
        "mu": ["0.1", "0.2", "0.3"],
    }
    texts |= {"mixed": ["1mm", "2kN", "3"], "shape": ["ball", "1mm", "2mm"]}
    found = []
    for k in range(3):
        inputs = {name: values[k] for name, values in texts.items()}
        done = {"exit_code": 0, "seconds": 1.0, "message": ""}
        found.append((Case(k + 1, f"case{k}", inputs, {}, {}, 1), done, {"contact_area": (1e-6 * (k + 1), "m2")}))
    write_hdf5(str(tmp_path / "results.h5"), found, "mine.yaml")
    study = Study(tmp_path / "results.h5")
    assert study.inputs["gap_radius1"].tolist() == [2.6e-3, 2.5e-3, 1e-3]
    assert study.inputs["depth"].tolist() == [1e-3, 20e-6, 3e-10] and study.unit_of_input("depth") == "m"
    assert study.inputs["mixed"].tolist() == texts["mixed"] and study.inputs["shape"].tolist() == texts["shape"]
    assert tables.abscissa(study) in texts
    assert len(tables.study([study], ["contact_area"], "gap_radius1").axes[0].lines) > 0
