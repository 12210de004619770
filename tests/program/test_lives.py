"""petsam-fatigue: lives against tables computed by hand, cracks against closed forms and an integral
equation, refusals."""

import sys
from types import SimpleNamespace

import numpy as np
import pytest

import conftest
import petsam
from petsam.apps.fatigue import command, cracks, evaluation, materials, strength
from petsam.apps.fatigue.stresses import Cycle
from petsam.apps.launch import code_of
from petsam.apps.study.expressions import Expander
from petsam.core.errors import Error
from petsam.plot import saving
from petsam.plot.style import plt
from support import ball, slide_limit, table_of

STRESS = conftest.PROGRAM.with_name("petsam-stress")
SWT = dict(young=115e9, sigma_f=2030e6, b=-0.104, epsilon_f=0.841, c=-0.69)
FS = dict(young=210e9, poisson=0.3, tau_f=700e6, b0=-0.09, gamma_f=0.4, c0=-0.6)
WEAK = dict(SWT, sigma_f=600e6, epsilon_f=0.05)
CONSTANTS = {**WEAK, "dk_th": 3e6, "stress_limit": 450e6, "findley_limit": 3e8}


# ---------------------------------------------------------------- lives


@pytest.mark.parametrize(
    "life, value",  # Pa: (2030e6)^2/115e9 (2N)^-0.208 + 2030e6*0.841 (2N)^-0.794, by a pocket calculator
    [(5e2, 15.597e6), (5e4, 3.45007e6), (5e6, 1.25877e6)],
)
def test_a_life_by_smith_watson_and_topper_is_that_of_a_table(life, value):
    first, second = 2030e6**2 / 115e9 * (2 * life) ** -0.208, 2030e6 * 0.841 * (2 * life) ** -0.794
    assert value == pytest.approx(first + second, rel=2e-3)
    assert strength.swt(first + second, **SWT) == pytest.approx(life, rel=1e-9)


def test_lives_by_one_term_are_powers():
    """Where the other term vanishes the curves have inverses."""
    elastic = dict(SWT, epsilon_f=1e-30)
    value = 1e6
    assert strength.swt(value, **elastic) == pytest.approx(0.5 * (value * 115e9 / 2030e6**2) ** (1 / -0.208), rel=1e-6)
    plastic = dict(FS, tau_f=1e-30)
    assert strength.fatemi_socie(5e-3, **plastic) == pytest.approx(0.5 * (5e-3 / 0.4) ** (1 / -0.6), rel=1e-9)
    shear = dict(FS, gamma_f=1e-30)
    modulus = 210e9 / 2.6
    assert strength.fatemi_socie(1e-3, **shear) == pytest.approx(
        0.5 * (1e-3 * modulus / 700e6) ** (-1 / 0.09), rel=1e-6
    )


def test_a_life_by_basquin_has_goodmans_mean_stress():
    by_hand = 0.5 * (300e6 / 1000e6) ** (-1 / 0.1)
    assert strength.basquin(300e6, -300e6, 1000e6, -0.1) == pytest.approx(by_hand, rel=1e-9)
    # amplitude 200 MPa, mean 200 MPa, of 600 MPa: 200/(1 - 1/3) = 300 MPa
    assert strength.basquin(400e6, 0.0, 1000e6, -0.1, 600e6) == pytest.approx(by_hand, rel=1e-9)
    assert strength.basquin(0.0, -600e6, 1000e6, -0.1, 600e6) == pytest.approx(by_hand, rel=1e-9)
    assert strength.basquin(650e6, 600e6, 1000e6, -0.1, 600e6) == strength.LEAST


def test_exponents_without_their_sign_are_refused():
    with pytest.raises(ValueError, match="give them with their sign"):
        strength.swt(1e6, **{**SWT, "b": 0.104, "c": 0.69})
    with pytest.raises(ValueError, match=r"\{life_basquin\(1e8, -1e8, 1e9, 0.1\)\}: the curve does not fall"):
        Expander({}).expand("{life_basquin(1e8, -1e8, 1e9, 0.1)}")


def test_lives_in_the_tables_of_studies_are_those_of_the_curves_and_finite():
    for name, values in (
        ("swt", (1e6, 115e9, 2.03e9, -0.104, 0.841, -0.69)),
        ("fatemi_socie", (5e-3, 72e9, 0.3, 3e8, -0.1, 0.2, -0.6)),
        ("basquin", (300e6, -300e6, 1000e6, -0.1)),
    ):
        told = Expander({}).expand(f"{{life_{name}({', '.join(map(repr, values))})}}")
        assert float(told) == pytest.approx(float(getattr(strength, name)(*values)), rel=1e-12)
    assert Expander({}).expand("{life_basquin(1e5, -1e5, 1e9, -0.1)}") == "1000000000000"  # endless


def test_ends_of_lives_factors_and_damage():
    values = strength.swt(np.array([0.0, 1.0, 1e12, np.nan]), **SWT)
    assert values[0] == values[1] == np.inf and values[2] == strength.LEAST and np.isnan(values[3])
    assert strength.factor([2.0, 0.0, -1.0], 3.0).tolist() == [1.5, np.inf, np.inf]
    sums = strength.damage([np.array([100.0, np.inf]), np.array([10.0, 4.0])], [50.0, 1.0])
    assert sums == pytest.approx([0.6, 0.25])


# ---------------------------------------------------------------- cracks


def edge_crack(stress, length, n=120):
    """K by the singular integral equation of an edge crack in a half-plane: the density of dislocations g/(1 - r^2)^1/2
    with r from -1 to 1, Gauss and Chebyshev's points, and no singularity at the surface (Krenk's interpolation)."""
    k = np.arange(1, n + 1)
    nodes, points = np.cos((2 * k - 1) * np.pi / (2 * n)), np.cos(np.arange(1, n) * np.pi / n)
    t, x = 0.5 * (1 + nodes), 0.5 * (1 + points)[:, None]
    kernel = 1 / (t - x) - 1 / (t + x) + 6 * x / (t + x) ** 2 - 4 * x**2 / (t + x) ** 3
    system = np.vstack([0.5 * kernel / n, (-1) ** (k + 1) * np.tan((2 * k - 1) * np.pi / (4 * n)) / n])
    right = np.append(-stress(length * x[:, 0]), 0.0)
    density = np.linalg.solve(system, right)
    tip = np.sum(density * (-1) ** (k + 1) / np.tan((2 * k - 1) * np.pi / (4 * n))) / n
    return abs(tip) * np.sqrt(np.pi * length / 2.0)


@pytest.mark.parametrize(
    "name, stress, closed",
    [
        ("uniform", lambda z: 0 * z + 1.0, 1.1215),
        ("linear", lambda z: z / 1e-4, 0.6825),
        ("gradient", lambda z: np.exp(-z / 2e-5), None),
        ("root", lambda z: 1 - np.sqrt(z / 1e-4), None),
    ],
)
def test_stress_intensity_is_that_of_closed_forms_and_of_the_integral_equation(name, stress, closed):
    depths = np.linspace(0.0, 2e-4, 4001)
    found = float(cracks.intensity(depths, stress(depths), 1e-4))
    unit = np.sqrt(np.pi * 1e-4)
    assert found == pytest.approx(edge_crack(stress, 1e-4), rel=4e-3), name
    if closed:
        assert found / unit == pytest.approx(closed, rel=1.5e-3)


def test_a_uniform_stress_at_its_limit_is_at_the_threshold_of_the_shortest_cracks():
    a0 = cracks.short_length(3e6, 450e6)
    assert a0 == pytest.approx((3e6 / (1.1215 * 450e6)) ** 2 / np.pi)
    assert cracks.threshold(a0, 3e6, 450e6) == pytest.approx(3e6 / np.sqrt(2))
    lengths = np.array([1e-4 * a0, 1e-2 * a0, a0])
    k = cracks.intensity(np.array([0.0, 1.0]), np.full(2, 450e6), lengths)
    assert k[0] / cracks.threshold(lengths[0], 3e6, 450e6) == pytest.approx(1.0, rel=1e-3)
    assert np.all(k[1:] > cracks.threshold(lengths[1:], 3e6, 450e6))
    assert cracks.stress_range(lengths, k) == pytest.approx([450e6] * 3, rel=1e-3)
    assert cracks.stress_range(1e4 * a0, 3e6) == pytest.approx(450e6 / 100)


def test_arrest_is_where_the_range_of_k_crosses_the_threshold():
    lengths, thresholds = np.array([1.0, 2.0, 3.0, 4.0]), np.ones(4)
    assert cracks.arrest(lengths, [2.0, 1.5, 0.5, 3.0], thresholds) == pytest.approx(2.5)
    assert cracks.arrest(lengths, [0.9, 1.5, 0.5, 3.0], thresholds) == 0.0
    assert cracks.start(lengths, [0.9, 1.5, 0.5, 3.0], thresholds) == 2.0
    assert cracks.arrest(lengths, [2.0] * 4, thresholds) == np.inf == cracks.start(lengths, [0.5] * 4, thresholds)


def test_a_closed_crack_has_no_stress_intensity():
    depths, lengths = np.array([0.0, 1e-3]), np.array([1e-4])
    high, low = cracks.extremes(depths, [[1e8, 1e8], [-1e8, -1e8]], lengths)
    assert low == [0.0] and high == pytest.approx(1.1215e8 * np.sqrt(np.pi * 1e-4), rel=1e-3)
    assert cracks.extremes(depths, [[-1e8, -1e8]], lengths)[0] == [0.0]


# ---------------------------------------------------------------- files and the command


@pytest.fixture(scope="module")
def folder(launcher, tmp_path_factory):
    """A folder with two cycles of a ball, low.h5 and high.h5, and constants."""
    folder = tmp_path_factory.mktemp("lives")
    case = ball(n=32)
    limit = float(slide_limit(case)[0])
    for name, part in (("low", 0.5), ("high", 0.9)):
        (folder / "h.csv").write_text(f"time,load_tx\n1,{part * limit}\n2,{-part * limit}\n3,{part * limit}\n")
        conftest.execute(launcher, folder, [case, dict(history="h.csv", steps=3, output="c.h5")], 1, 0)
        options = dict(input="c.h5", output=f"{name}.h5", section="y=0", depths="0:4e-4:9", steps="4:9", quiet=True)
        more = dict(
            fatigue="swt,findley,fatemi_socie", fatigue_findley_k=0.3, fatigue_fatemi_socie_k=1, fatigue_yield=4e8
        )
        conftest.execute(launcher, folder, [dict(options, **more)], 1, 0, program=STRESS)
    (folder / "m.yaml").write_text(
        "".join(f"{name}: {value:g}\n" for name, value in CONSTANTS.items() if name != "young")
    )
    return folder


@pytest.fixture
def fatigue(folder, monkeypatch, capfd):
    """fatigue(*words, check=0): what petsam-fatigue prints; its one line on stderr where it fails."""

    def run(*words, check=0):
        monkeypatch.chdir(folder)
        monkeypatch.setattr(sys, "argv", ["petsam-fatigue", *map(str, words)])
        try:
            code = code_of("petsam-fatigue")
        except SystemExit as end:
            code = end.code
        out, err = capfd.readouterr()
        assert code == check, out + err
        if check:
            assert len(err.splitlines()) == 1 and err.startswith("petsam-fatigue: error: "), err
        return err if check else out

    return run


def test_the_command_prints_and_writes_what_the_file_gives(fatigue, folder):
    out = fatigue("--material", "m.yaml", "--csv", "line.csv", "-o", "p.png", "high.h5")
    file = petsam.open(folder / "high.h5")
    swt, findley = file.field("swt"), file.field("findley")
    assert f"life {float(strength.swt(swt.max(), **{**WEAK, 'young': 72e9})):.4g} cycles" in out
    assert f"Findley: safety factor {3e8 / findley.max():.4g} at" in out
    assert "short crack: " in out and (folder / "p.png").stat().st_size > 20000
    rows = table_of(folder / "line.csv")
    assert (
        (folder / "line.csv")
        .read_text()
        .startswith("file,x [m],y [m],z [m],findley [Pa],swt [Pa],fatemi_socie [1],life_swt [1],")
    )
    column = int(np.argmax(swt[0, 0]))
    assert [float(row["z"]) for row in rows] == pytest.approx(file.z.tolist())
    assert float(rows[0]["x"]) == pytest.approx(file.x[column])
    assert [float(row["swt"]) for row in rows] == pytest.approx(swt[:, 0, column].tolist())
    stress = np.array([file.field("stress_xx", step)[:, 0, column] for step in range(6)])
    k = [cracks.intensity(file.z, one, file.z[4]) for one in stress]
    assert float(rows[4]["k_max"]) == pytest.approx(max(*k, 0.0))
    assert float(rows[4]["k_range"]) == pytest.approx(max(*k, 0.0) - max(min(k), 0.0))


def test_the_error_of_the_tractions_goes_on_into_lives_and_factors(fatigue, folder, launcher):
    """From companion runs to the stresses' file; SWT's parameter is quadratic in the stress."""
    case = ball(n=32)
    limit = float(slide_limit(case)[0])
    (folder / "e.csv").write_text(f"time,load_tx\n1,{0.8 * limit}\n2,{-0.8 * limit}\n3,{0.8 * limit}\n")
    run = dict(case, history="e.csv", steps=2, output="e.h5", errors="companion")
    conftest.execute(launcher, folder, [run], 2, 0)
    given = petsam.open(folder / "e.h5").errors
    error = max(given["pressure_max"].error, given["shear_max"].error)
    options = dict(input="e.h5", output="es.h5", section="y=0", depths="0:4e-4:5", steps="2:6", fatigue="swt,findley")
    conftest.execute(launcher, folder, [dict(options, fatigue_findley_k=0.3)], 2, 0, program=STRESS)
    out = fatigue("--material", "m.yaml", "--criteria", "swt,findley", "-o", "e.png", "es.h5")
    file = petsam.open(folder / "es.h5")
    constants = {**WEAK, "young": file.parameters["young"]}
    swt = [float(strength.swt(file["swt"].max() * (1 + sign * error) ** 2, **constants)) for sign in (1, -1)]
    factor = [3e8 / file["findley"].max() / (1 + sign * error) for sign in (1, -1)]
    for low, high in (swt, factor):
        assert low < high
        assert f"({low:.4g} to {high:.4g} by {100 * error:.2g} % of the tractions)" in out
    assert "of the tractions" not in fatigue("--material", "m.yaml", "-o", "p.png", "low.h5")
    assert petsam.fatigue.lives(folder / "low.h5", CONSTANTS).bounds["swt"] == [None]


def test_lives_from_python_are_those_of_the_command(fatigue, folder, tmp_path):
    """Of names of files or of Stresses, constants as numbers, words or a file."""
    fatigue("--material", "m.yaml", "--csv", "both.csv", "--counts", "1e5,20", "--no-picture", "low.h5", "high.h5")
    files = [folder / "low.h5", folder / "high.h5"]
    found = petsam.fatigue.lives(files, folder / "m.yaml", counts=[1e5, 20])
    found.to_csv(tmp_path / "both.csv")
    assert (tmp_path / "both.csv").read_text() == (folder / "both.csv").read_text()
    swt = [petsam.open(file).field("swt") for file in files]
    lives = [strength.swt(one, **{**WEAK, "young": 72e9}) for one in swt]
    assert found.least["swt"][1].value == pytest.approx(lives[1].min())
    assert found.damage["swt"].value == pytest.approx((1e5 / lives[0] + 20 / lives[1]).max())
    words = {name: value for name, value in WEAK.items() if name != "young"} | {
        "sigma_f": f"{WEAK['sigma_f'] / 1e6!r}MPa"
    }
    one = petsam.fatigue.lives(petsam.open(files[1]), words, criteria=["swt"], below=(0.0, 0.0), quantities=["swt"])
    assert [column.name for column in one.table()] == ["file", "x", "y", "z", "swt", "life_swt"]
    assert abs(one.lines[0][1].x) < 1e-4 and not one.cracks
    assert one.least["swt"][0].value == pytest.approx(found.least["swt"][1].value)
    assert len(petsam.plot.lives(one).axes) == 2
    with pytest.raises(Error, match="counts: 2 files need"):
        petsam.fatigue.lives(files, words, counts=[1.0])
    assert repr(one) == "Lives(swt of high; line below the point nearest to --at)"
    assert petsam.fatigue.lives(files[1], words, criteria="swt").values.keys() == {"swt"}
    for nothing in ([], None, 5, [5]):
        with pytest.raises(Error, match="expected a file of petsam-stress"):
            petsam.fatigue.lives(nothing, words)
    with pytest.raises(Error, match="sigma_f 900 Pa is outside"):
        petsam.fatigue.lives(files, dict(sigma_f=900))


def test_the_picture_has_the_given_resolution(fatigue, folder):
    widths = []
    for words in ([], ["--dpi", "300"]):
        fatigue(*words, "-o", "dpi.png", "high.h5")
        widths.append(plt.imread(folder / "dpi.png").shape[1])
    assert widths[1] == pytest.approx(2 * widths[0], abs=2)
    assert "--dpi: 0: expected a whole number" in fatigue("--dpi", "0", "high.h5", check=2)
    assert "--dpi" in fatigue("--no-picture", "--dpi", "300", "high.h5", check=2)


def test_files_go_by_their_labels(fatigue, folder, monkeypatch):
    figures = []
    monkeypatch.chdir(folder)
    monkeypatch.setattr(saving, "write", lambda figure, *_: figures.append(figure))
    words = "--material", "m.yaml", "--criteria", "swt,crack", "--quantity", "swt", "low.h5", "high.h5"
    assert "--labels: 2 files need as many names" in fatigue("--labels", "one", *words, check=2)
    command.carry_out(command.arguments(["--labels", "cruise,start", *words]))
    texts = [[text.get_text() for text in axes.get_legend().get_texts()] for axes in figures[0].axes]
    assert texts[:2] == [["cruise", "start"]] * 2 and texts[2] == ["cruise", "start", "threshold"]
    assert texts[3][2:] == ["threshold (El Haddad)", "long cracks", "fatigue limit"]
    assert figures[0].axes[1].get_ylabel() == "Smith, Watson and Topper: life, cycles"
    command.carry_out(command.arguments(words))
    assert figures[1].axes[0].get_legend().get_texts()[0].get_text() == "low"


def test_damage_is_summed_where_it_happens(fatigue, folder):
    out = fatigue(
        "--material", "m.yaml", "--criteria", "swt", "--counts", "1e5,20", "--no-picture", "low.h5", "high.h5"
    )
    lives = [
        strength.swt(petsam.open(folder / f"{name}.h5").field("swt"), **{**WEAK, "young": 72e9})
        for name in ("low", "high")
    ]
    damage = 1e5 / lives[0] + 20 / lives[1]
    assert f"spectrum: Smith-Watson-Topper: damage {damage.max():.4g} at" in out
    assert f"{1 / damage.max():.4g} repeats" in out


def test_the_place_is_chosen_and_planes_turn(fatigue, folder):
    file = petsam.open(folder / "high.h5")
    out = fatigue("--at", f"{file.x[5]},{file.y[0]}", "--quantity", "mises,stress_xx", "-o", "at.svg", "high.h5")
    assert f"below x = {file.x[5]:.4g} m" in out and "point nearest to --at" in out
    assert (folder / "at.svg").exists()
    assert "largest mises on the surface" in fatigue("--hot", "mises", "--no-picture", "high.h5")
    cycle = Cycle(file)
    xx, yy, xy = (file.field(f"stress_{name}", 2) for name in ("xx", "yy", "xy"))
    assert list(cycle.on_plane(90.0))[2] == pytest.approx(yy)
    assert list(cycle.on_plane(45.0))[2] == pytest.approx(0.5 * (xx + yy) + xy)


def test_arrays_of_a_contact_are_taken_too(folder):
    """As petsam.Contact.fatigue() gives them: by name, with the coordinates."""
    file = petsam.open(folder / "high.h5")
    arrays = {name: getattr(file, name) for name in "xyz"}
    arrays.update(time=file.times, swt=file.field("swt"))
    arrays["stress_xx"] = np.array([file.field("stress_xx", step) for step in range(6)])
    mine, its = Cycle(arrays, young=72e9, poisson=0.34), Cycle(file)
    for one, other in zip(evaluation.lives([mine], "swt", SWT), evaluation.lives([its], "swt", SWT)):
        assert one.tobytes() == other.tobytes()
    assert mine.hot_spot("swt") == its.hot_spot("swt")
    columns = [evaluation.crack(one, CONSTANTS, 0.0, *one.hot_spot("swt"))[0]["k_range"][1] for one in (mine, its)]
    assert columns[0].tobytes() == columns[1].tobytes()


def test_arrays_without_a_step_are_refused():
    """Of stresses, of a parameter of the cycle, and of coordinates alone."""
    points = {"x": [0.0, 1e-3], "y": [0.0], "z": [0.0, 1e-4], "time": []}
    for more in ({"stress_xx": np.empty((0, 2, 1, 2))}, {"swt": np.ones((2, 1, 2))}, {}):
        with pytest.raises(Error, match="the contact: has no load steps: give the stresses of all steps of a cycle"):
            Cycle({**points, **more})


def test_stress_on_planes_of_a_row_of_points_or_of_a_column():
    """Each index selects by itself; both select a point."""
    stress = np.random.default_rng(3).normal(size=(2, 2, 3, 4))
    points = {"x": np.arange(4.0), "y": np.arange(3.0), "z": [0.0, 1.0], "time": [0.0, 1.0]}
    cycle = Cycle({**points, "stress_xx": stress})
    for chosen, part in (
        (dict(row=1), np.s_[:, :, 1:2]), (dict(column=2), np.s_[..., 2:3]),
        (dict(row=1, column=2), np.s_[:, :, 1:2, 2:3]),
    ):  # fmt: skip
        assert np.array_equal(list(cycle.on_plane(0.0, **chosen)), stress[part])


@pytest.mark.parametrize(
    "words, says, code",
    [
        (["--criteria", "swt", "high.h5"], ["swt: sigma_f (Pa, fatigue strength coefficient)", "--constant"], 3),
        (["--criteria", "crossland", "high.h5"], ["high.h5: crossland: the data are missing", "-fatigue crossland"], 3),
        (["--constant", "sigma_f=900", "high.h5"], ["sigma_f 900 Pa is outside 100000 to 1e+12 Pa", "SI units"], 2),
        (["--constant", "b=0.1", "high.h5"], ["b 0.1 is outside -1 to 0: give -0.1, with its sign"], 2),
        (["--constant", "epsilon_f=60", "high.h5"], ["epsilon_f 60 is outside", "give a ratio, 0.6 for 60 percent"], 2),
        (["--constant", "sigma_e=1e9", "high.h5"], ["sigma_e is no constant", "is sigma_f meant"], 2),
        (["--criteria", "sswt", "high.h5"], ["sswt: is no criterion: is swt meant?"], 2),
        (["--counts", "3", "low.h5", "high.h5"], ["--counts: 2 files need as many numbers above 0"], 2),
        (["--at", "1,0", "high.h5"], ["--at: x = 1 m is not on the points", "choose one there"], 3),
        (["--hot", "ruiz_1", "high.h5"], ["has no ruiz_1"], 3),
        (["-o", "high.h5", "high.h5"], ["use a name that ends in .png, .pdf or .svg"], 2),
        (["--csv", "low.h5", "low.h5"], ["low.h5: would replace the results"], 3),
        (["--material", "bad.yaml", "high.h5"], ["bad.yaml: sigma_f 2030Mpa: expected", "units are Pa, kPa, MPa"], 3),
        (["c.h5"], ["c.h5: has no depths z: give a file of petsam-stress"], 3),
    ],
)  # fmt: skip
def test_refusals(fatigue, folder, words, says, code):
    (folder / "bad.yaml").write_text("sigma_f: 2030Mpa\n")
    err = fatigue(*words, check=code)
    assert all(word in err for word in says), err


def test_stresses_that_do_not_begin_at_the_surface_or_do_not_match_are_refused(fatigue, folder, launcher):
    common = dict(input="c.h5", section="y=0", fatigue="swt", steps="4:9", quiet=True)
    for name, depths in (("deep", "1e-5:4e-4:9"), ("other", "0:3e-4:9"), ("flat", "0")):
        run = dict(common, output=f"{name}.h5", depths=depths)
        conftest.execute(launcher, folder, [run], 1, 0, program=STRESS)
    assert "first depth is 1e-05 m; give petsam-stress depths from 0 on" in fatigue("deep.h5", check=3)
    err = fatigue("--material", "m.yaml", "--criteria", "swt", "high.h5", "other.h5", check=3)
    assert "other.h5: has other points than high.h5" in err
    assert "has 1 depths" in fatigue("--material", "m.yaml", "--criteria", "crack", "flat.h5", check=3)


def test_layers_have_their_own_moduli(fatigue, folder, launcher):
    """At both sides of an interface; a crack is of one material."""
    layers = dict(body2_layer_young="150e9,40e9", body2_layer_poisson=0.2, body2_layer_thickness="1e-4,2e-4")
    case = dict(ball(n=32), **layers, load_tx=None, history="l.csv", steps=2, output="l.h5")
    (folder / "l.csv").write_text("time,load_tx\n1,20\n2,-20\n3,20\n")
    conftest.execute(launcher, folder, [case], 1, 0)
    run = dict(input="l.h5", output="layered.h5", section="y=0", depths="0:4e-4:5", steps="3:6")
    more = dict(fatigue="swt,fatemi_socie", fatigue_fatemi_socie_k=1, fatigue_yield=4e8)
    conftest.execute(launcher, folder, [{**run, **more}], 1, 0, program=STRESS)
    file = petsam.open(folder / "layered.h5")
    young, nu = (
        np.array(values)[:, None, None] for values in ([150e9] * 2 + [40e9] * 3 + [72e9] * 2, [0.2] * 5 + [0.34] * 2)
    )
    assert file.z.size == 7
    cycle, weak = Cycle(file), {**CONSTANTS, **FS, "sigma_f": 1e8, "tau_f": 3e7}
    weak = {name: value for name, value in weak.items() if name not in ("young", "poisson")}
    constants = {name: weak[name] for name in ("sigma_f", "b", "epsilon_f", "c")}
    by_hand = [strength.swt(file.field("swt")[k], float(young[k, 0, 0]), **constants) for k in range(7)]
    assert evaluation.lives([cycle], "swt", weak)[0].tobytes() == np.array(by_hand).tobytes()
    constants = {name: weak[name] for name in ("tau_f", "b0", "gamma_f", "c0")}
    by_hand = strength.fatemi_socie(file.field("fatemi_socie"), young, nu, **constants)
    found = evaluation.lives([cycle], "fatemi_socie", weak)[0]
    assert found.tobytes() == by_hand.tobytes() and np.isfinite(found).any()
    out = fatigue("--material", "m.yaml", "--no-picture", "layered.h5")
    assert "Smith-Watson-Topper: life" in out and "crack" not in out
    says = "the body has layers, and K is that of one material; omit it from --criteria"
    assert says in fatigue("--material", "m.yaml", "--criteria", "crack", "layered.h5", check=3)


def test_lives_of_an_open_cycle_are_warned_of(folder, launcher, monkeypatch, capfd):
    monkeypatch.chdir(folder)
    words = ["--material", "m.yaml", "--criteria", "swt", "--no-picture"]
    (folder / "h.csv").write_text("time,load_tx\n" + "".join(f"{k},{20 * (-1) ** k}\n" for k in range(6)))
    conftest.execute(launcher, folder, [ball(n=32), dict(history="h.csv", output="cycles.h5")], 1, 0)
    for name, steps in (("open", "1:3"), ("closed", "5:6")):
        run = dict(input="cycles.h5", output=f"{name}.h5", section="y=0", steps=steps, fatigue="swt")
        conftest.execute(launcher, folder, [run], 1, 0, program=STRESS)
        command.carry_out(command.arguments([*words, f"{name}.h5"]))
        out = capfd.readouterr()
        said = f"petsam-fatigue: warning: {name}.h5: not a closed cycle, or not a steady one: the "
        assert (said in out.err) == (name == "open") == ("; see the warning" in out.out), out
        assert ("give petsam-stress the -steps of a later one" in out.err) == (name == "open")


@pytest.mark.parametrize(
    "limits, said",
    [
        ((2.0, 1.0, 3.0), "does not grow from the surface; a crack of 2e-05 m grows, arrests at 2.5e-05 m"),
        ((2.0, 1.0, 1.0), "does not grow from the surface; a crack of 2e-05 m grows, through all depths, to 3e-05 m"),
        ((1.0, 2.0, 2.0), "grows from 1e-05 m on, arrests at 1.667e-05 m"),
        ((2.0, 2.0, 2.0), "does not grow at any length from 1e-05 to 3e-05 m"),
    ],
)
def test_words_on_a_crack_say_where_it_grows_and_ends(monkeypatch, capsys, limits, said):
    """A range of K of 1.5 at three lengths beside these thresholds."""
    z = np.array([0.0, 1e-5, 2e-5, 3e-5])
    cycle = SimpleNamespace(path="a.h5", z=z, layered=False, averaged=0.0, stress_line=lambda *_: None)
    monkeypatch.setattr(evaluation, "has_data", lambda *_: True)
    monkeypatch.setattr(cracks, "extremes", lambda *_: (np.full(4, 1.5), np.zeros(4)))
    monkeypatch.setattr(cracks, "threshold", lambda *_: np.array([0.0, *limits]))
    _, *lengths = evaluation.crack(cycle, {"dk_th": 1.0, "stress_limit": 1.0}, 0.0, 0, 0)
    command._print_crack(cycle, *lengths)
    assert capsys.readouterr().out == f"a.h5: short crack: {said}\n"


def test_means_over_a_length_are_named(fatigue, folder, launcher):
    run = dict(input="c.h5", output="mean.h5", steps="4:9", fatigue="swt", fatigue_length=5e-5)
    conftest.execute(launcher, folder, [run], 1, 0, program=STRESS)
    value = petsam.open(folder / "mean.h5").field("swt").max()
    out = fatigue("--material", "m.yaml", "mean.h5")
    assert f"life {float(strength.swt(value, **{**WEAK, 'young': 72e9})):.4g} cycles" in out
    assert "z = 0 m, of means over 5e-05 m" in out and "wrote" not in out  # one depth is no picture
    says = "crack: has means over 5e-05 m; omit -fatigue_length of petsam-stress"
    assert says in fatigue("--material", "m.yaml", "--criteria", "crack", "mean.h5", check=3)


def test_every_constant_has_a_range_and_a_text():
    for name, one in materials.CONSTANTS.items():
        assert one.low < one.high and one.meaning
        for value in (one.low, one.high, "x", "nan"):
            with pytest.raises(Error):
                materials.checked(name, value)


def test_constants_have_si_units_or_their_own(tmp_path):
    (tmp_path / "m.yaml").write_text("sigma_f: 1.76 GPa\nyoung: 210e9\nb: -0.1\ndk_th: 3.5MPa m^1/2\n")
    expected = {"sigma_f": 1.76e9, "young": 210e9, "b": -0.1, "dk_th": 3.5e6}
    assert materials.read(tmp_path / "m.yaml") == pytest.approx(expected)
    for name, value in (("b", "-0.1Pa"), ("sigma_f", "1mm"), ("sigma_f", "1,7GPa")):
        with pytest.raises(Error, match="expected a number"):
            materials.checked(name, value)
