"""Studies that decide: stresses of each case, expressions of results, regimes, and their maps over two inputs."""

import subprocess
import sys

import h5py
import numpy as np
import pytest
from matplotlib.colors import LogNorm

import petsam
from conftest import PROGRAM as PETSAM
from conftest import environment
from petsam import sliding
from petsam.apps.fatigue import strength
from petsam.apps.study import cases as study_cases
from petsam.apps.study.cases import Case
from petsam.apps.study.tables import write_hdf5
from petsam.plot import planes, tables
from support import ROOT, ball, hertz, table_of, words

pytestmark = pytest.mark.usefixtures("closing")

CASE = ball(n=24)
GROSS = 1.5 * CASE["friction"] * float(hertz(CASE).approach)  # m: about the displacement of incipient sliding
TABLE = """parameters:
  part: [0.3, 2.5]
options:
  load_n: [90, 180]
  history: h.csv
  steps: 4
files:
  h.csv: |
    time, disp_x
    1, {part * GROSS}
    2, {-part * GROSS}
    3, {part * GROSS}
stress:
  steps: 5:12
  depths: 0,1e-5
  fatigue: swt
results:
  life: life_swt(swt_max, 72e9, 300e6, -0.1, 0.1, -0.6)
  twice: 2 * life_log + 0 * load_n
  life_log: log(life)
  stronger: sqrt(energy_ratio_cycle_last - 0.5)
""".replace("GROSS", repr(GROSS))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A study with stresses and expressions, and what it printed."""
    folder = tmp_path_factory.mktemp("study")
    (folder / "t.yaml").write_text(TABLE)
    done = study(folder, "t.yaml", "--", *words({name: value for name, value in CASE.items() if name != "load_n"}))
    assert done.returncode == 0, done.stderr + done.stdout
    return folder


def study(folder, *arguments):
    command = [sys.executable, str(ROOT / "scripts" / "petsam-study"), *arguments]
    env = {**environment(), "PYTHON": sys.executable, "PETSAM": str(PETSAM)}
    return subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, timeout=240)


def rows(folder):
    return table_of(folder / "t" / "results.csv")


def test_the_stresses_of_each_case_are_columns(folder):
    for row in rows(folder):
        with petsam.open(folder / "t" / row["case"] / "stress.h5") as file:
            assert file.steps == list(range(5, 13))  # 5:12 is no number to the base 60
            assert float(row["swt_max"]) == file.field("swt").max()
            assert float(row["mises_max"]) == file.history["mises_max"].max()
    with h5py.File(folder / "t" / "results.h5") as file:
        assert file["results/swt_max"].attrs["units"] == "Pa" and file["results/life"].attrs["units"] == "1"


def test_expressions_take_results_inputs_and_one_another(folder):
    for row in rows(folder):
        life = strength.swt(float(row["swt_max"]), 72e9, 300e6, -0.1, 0.1, -0.6)
        assert float(row["life"]) == pytest.approx(float(life), rel=1e-9)
        assert float(row["twice"]) == pytest.approx(2 * np.log(life), rel=1e-9)
        ratio = float(row["energy_ratio_cycle_last"])
        assert float(row["stronger"]) == pytest.approx(np.sqrt(ratio - 0.5) if ratio > 0.5 else np.nan, nan_ok=True)


def test_the_regime_and_the_ratios_are_those_of_the_cycle(folder):
    for row in rows(folder):
        slides = float(row["part"]) > 1.0
        assert sliding.REGIMES[int(row["regime"])] == ("gross slip" if slides else "partial slip")
        assert (
            (float(row["energy_ratio_cycle_last"]) > 0.2) == slides == (float(row["sliding_ratio_cycle_last"]) > 0.26)
        )
        # load and displacement turn together: U is an eighth of the product of their ranges
        factor = 4.0 / np.pi * float(row["energy_ratio_cycle_last"])
        assert float(row["loss_factor_cycle_last"]) == pytest.approx(factor, rel=1e-3)


def test_an_expression_without_a_value_in_any_case_is_an_error_after_the_tables(folder):
    (folder / "t.yaml").write_text(TABLE.replace("load_n\n", "load_m\n"))
    done = study(folder, "t.yaml", "--", *words({name: value for name, value in CASE.items() if name != "load_n"}))
    assert done.returncode == 3 and "results: twice: " in done.stderr and "load_m" in done.stderr
    assert "life_log" in rows(folder)[0] and "4 others skipped" not in done.stdout  # the cases did not run again
    (folder / "t.yaml").write_text(TABLE)


def test_a_load_that_slides_is_gross_slip(tmp_path):
    (tmp_path / "t.csv").write_text("load_tx\n20\n60\n")
    done = study(tmp_path, "t.csv", "--", *words(CASE))
    assert done.returncode == 1
    assert [row["regime"] for row in rows(tmp_path)] == ["1", "2"]


def test_another_stress_is_another_case(tmp_path):
    identities = set()
    for text in ("", "stress:\n  depths: 0\n", "stress:\n  depths: 1e-5\n", "results:\n  a: 1\n"):
        (tmp_path / "t.yaml").write_text("options:\n  load_n: 1\n" + text)
        identities.add(study_cases.read(str(tmp_path / "t.yaml"))[0].identity())
    assert len(identities) == 3  # expressions need no new run


# ---------------------------------------------------------------- maps


@pytest.fixture
def table(tmp_path):
    """A study of 4 x 3 cases; the last has failed by gross slip."""
    found = []
    for number, (x, y) in enumerate(((x, y) for y in (1.0, 2.0, 4.0) for x in (1.0, 2.0, 3.0, 5.0)), 1):
        case = Case(number, f"c{number}", {"way": str(x), "load": str(y)}, {}, {}, 1)
        values = {"regime": (2 if x > y else 1, "1"), "life": (10.0 ** (x + y), "1"), "depth": (1e-6 * x, "m")}
        code = 11 if number == 12 else 0
        found.append((case, {"exit_code": code, "seconds": 1.0, "message": ""}, values))
    write_hdf5(str(tmp_path / "results.h5"), found, "t.yaml")
    return tmp_path / "results.h5"


def test_a_map_of_regimes_has_their_borders(table):
    panel = planes.planes(petsam.open(table), ["way", "load"]).axes[0]
    texts = [text.get_text() for text in panel.get_legend().get_texts()]
    assert texts == ["partial slip", "gross slip"]
    assert panel.get_title() == "fretting regime"
    borders = [one for one in panel.collections[1:] if not one.filled]
    x, y = np.concatenate([path.vertices for one in borders for path in one.get_paths()]).T
    for row, at in ((1.0, 1.5), (2.0, 2.5), (4.0, 4.0)):  # halfway between cases of different regimes
        assert np.ptp(x) > 2.0 and x[np.abs(y - row) < 0.02] == pytest.approx(at, abs=0.03)


def test_borders_are_where_a_column_has_a_value(table):
    figure = planes.planes(
        petsam.open(table), ["way", "load"], ["depth"], borders=[("life", 10.0**4.5), ("depth", 1.0)]
    )
    panel = figure.axes[0]
    texts = [text.get_text() for text in panel.get_legend().get_texts()]
    assert texts == ["life = 31622.8", "depth = 1 m: all below"]
    points = np.concatenate([path.vertices for one in panel.collections[1:] for path in one.get_paths()])
    assert points.sum(axis=1) == pytest.approx(4.5)  # x + y, linear in the logarithm


def test_sliding_as_a_whole_is_hatched_in_the_map_and_in_its_legend(table):
    panel = planes.planes(petsam.open(table), ["way", "load"]).axes[0]
    (hatched,) = [one for one in panel.collections[1:] if one.filled]
    x, y = np.concatenate([path.vertices for path in hatched.get_paths()]).T
    assert hatched.hatches == ["//"] and x[np.abs(y - 2.0) < 0.02].min() == pytest.approx(2.5, abs=0.03)
    assert [patch.get_hatch() or "" for patch in panel.get_legend().get_patches()] == ["", "//"]


def test_colours_of_a_map_are_logarithmic_if_asked(table):
    study = petsam.open(table)
    where = dict(over=["way", "load"], names=["regime", "life", "depth"])
    regime, life, depth = planes.planes(study, **where, logs=["x", "colors"]).axes[:3]
    for panel, low, high in ((life, 1e2, 1e9), (depth, 1.0, 5.0)):
        norm = panel.collections[0].norm
        assert isinstance(norm, LogNorm) and (norm.vmin, norm.vmax) == pytest.approx((low, high))
        assert np.diff(np.log(panel.collections[0].levels)) == pytest.approx(np.log(high / low) / planes.LEVELS)
        assert (panel.get_xscale(), panel.get_yscale()) == ("log", "linear")
    assert not isinstance(regime.collections[0].norm, LogNorm)
    linear = planes.planes(study, **where).axes[1].collections[0]
    assert not isinstance(linear.norm, LogNorm)
    some = petsam.open(table)
    some.results["life"][some.inputs["way"] != some.inputs["load"]] = np.nan  # 2 of 12 cases: points
    some.inputs["way"] = some.inputs["way"].astype(float)
    panel = planes.planes(some, ["way", "load"], ["life"], logs=["colors"]).axes[0]
    assert isinstance(panel.collections[0].norm, LogNorm)


def test_bars_of_less_than_a_decade_have_numbers(table):
    study = petsam.open(table)
    study.results["life"][:] = 5.2 + 0.01 * study.results["life"] / study.results["life"].max()
    figure = planes.planes(study, ["way", "load"], ["life"], logs=["colors"])
    assert [text.get_text() for text in figure.axes[0].child_axes[0].get_yticklabels()] == ["5.2", "5.25"]
    study.results["life"][:] = 3.0
    planes.planes(study, ["way", "load"], ["life"], logs=["colors"])


@pytest.mark.parametrize("least", [0.0, -2.5])
def test_logarithmic_colours_refuse_what_is_not_positive(draw, table, least):
    with h5py.File(table, "r+") as file:
        file["results/life"][3] = least
    words = ["--against", "way,load", "--scalar", "life", "--log", "colors", "-o", "m.png", table]
    assert draw(*words) == (3, [f"petsam-plot: error: {table}: --log colors: life has the value {least:g}; omit it"])
    assert not (table.parent / "m.png").exists()
    assert draw(*words[:5], "y", *words[6:]) == (0, [])


def test_a_map_without_a_border_names_its_regime_and_where_the_border_lies(table):
    def words(study):
        return [text.get_text() for text in planes.planes(study, ["way", "load"]).axes[0].texts]

    study = petsam.open(table)
    assert words(study) == []
    for regime, says in ((1, "larger displacements"), (2, "smaller displacements")):
        study.results["regime"][:] = regime
        (text,) = words(study)
        assert text.startswith(f"all 12 cases: {sliding.REGIMES[regime]}\n") and says in text


STATED = """
parameters:
  way: [1e-6, 2e-6]
options:
  load_n: [10, 20]
  disp_x: "{way}"
units:
  way: m
  worn: m
results:
  worn: 2*way
"""


def test_the_axes_of_a_study_have_the_units_that_its_table_states(tmp_path):
    (tmp_path / "t.yaml").write_text(STATED)
    cases = study_cases.read(str(tmp_path / "t.yaml"))
    record = {"exit_code": 0, "seconds": 1.0, "message": ""}
    values = [{"worn": (2 * float(case.inputs["way"]), case.units["worn"])} for case in cases]
    found = [(case, record, mine) for case, mine in zip(cases, values)]
    write_hdf5(str(tmp_path / "results.h5"), found, "t.yaml")
    study = petsam.open(tmp_path / "results.h5")
    panel = tables.study([study], ["worn"], "way").axes[0]
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("way, µm", "worn, µm")
    assert panel.lines[0].get_xdata() == pytest.approx([1.0, 2.0])
    panel = planes.planes(study, ["way", "load_n"], ["worn"], borders=[("worn", 3e-6)]).axes[0]
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("way, µm", "$N$, N")
    assert panel.get_legend().get_texts()[0].get_text() == "worn = 3 µm"


@pytest.mark.parametrize("line", ["load_n: N", "gap: m", "way: [m]", "way: a unit that is far too long"])
def test_a_unit_of_what_is_no_name_of_the_table_or_none_is_refused(tmp_path, line):
    (tmp_path / "t.yaml").write_text(STATED.replace("way: m\n", line + "\n"))
    with pytest.raises(petsam.Error, match="t.yaml, line 8: units: "):
        study_cases.read(str(tmp_path / "t.yaml"))


def test_the_command_draws_maps_and_refuses_what_is_none(draw, table):
    assert draw("--against", "way,load", "--border", "life=1e4", "--log", "y", "-o", "m.png", table)[0] == 0
    assert (table.parent / "m.png").stat().st_size > 10000
    assert draw("--against", "way,load", "--scalar", "life,depth", "-o", "two.svg", table) == (0, [])
    log = ("--log", "x,colors")
    assert draw("--against", "way,load", "--scalar", "life,depth", *log, "-o", "log.png", table) == (0, [])
    for given, says, code in (
        (["--against", "way,load", "--border", "life"], "expected NAME=VALUE", 2),
        (["--against", "way,load", "--border", "wear=1"], "--border wear: there is no such column", 3),
        (["--against", "way", "--border", "life=1"], "--border: has no effect", 2),
        (["--against", "way,load", "--by", "load"], "--by: has no effect", 2),
        (["--against", "way,load", "--where", "load=1"], "a map needs two values of each", 3),
        (["--against", "way,way"], "12 cases at 4 places", 3),
        (["--against", "way,load,life"], "expected X,Y", 3),
        (["--against", "way,load", "--log", "colors"], "the regime has no numbers; name a column by --scalar", 2),
        (["--against", "way", "--log", "colors"], "--log colors: has no effect", 2),
    ):
        found, err = draw(*given, table)
        assert found == code and len(err) == 1 and says in err[0], err


def test_cases_at_one_place_are_refused(table):
    study = petsam.open(table)
    study.inputs["way"] = np.where(study.inputs["way"] == 2.0, 3.0, study.inputs["way"])
    with pytest.raises(petsam.Error, match="12 cases at 9 places; choose cases of the other inputs by --where"):
        planes.planes(study, ["way", "load"])
