"""Contact stiffness of an interface: compliance of cracks, ratio of tangential and normal stiffness, scaling."""

import csv
import functools
import json
import re
import warnings

import h5py
import numpy as np
import pytest

import petsam
from petsam import joint
from petsam.apps.joint import elements, windows
from petsam.plot.style import COLORS, plt
from support import bodies

warnings.simplefilter("ignore", petsam.AdviceWarning)
pytestmark = pytest.mark.filterwarnings("ignore::petsam.contact.AdviceWarning")

YOUNG, POISSON = 70e9, 0.25
MODULUS = YOUNG / (1 - POISSON**2) / 2
PAIR = dict(bodies(YOUNG, POISSON), friction=0.3)
LENGTH, HEIGHT = 2e-3, 2e-7
FULL = np.pi * MODULUS * HEIGHT / LENGTH  # mean pressure that closes the wave


def wave(n):
    x = (np.arange(n) + 0.5) / n
    return np.broadcast_to(HEIGHT * (1 - np.cos(2 * np.pi * x)), (4, n))


def waves(n, seed, size=1e-7):
    """A random surface of n x n points, its shortest wave 12 points long."""
    k = np.hypot(*np.meshgrid(*2 * [np.fft.fftfreq(n) * n]))
    part = np.where((k >= 2) & (k <= n / 12), np.maximum(k, 1.0) ** -1.8, 0.0)
    field = np.fft.ifft2(np.fft.fft2(np.random.default_rng(seed).normal(size=(n, n))) * part).real
    return size * field / field.std()


@pytest.mark.parametrize("across", [True, False])
def test_a_wave_has_the_stiffness_of_a_row_of_cracks(across):
    """Across the waves as in the opening mode, along them as in the antiplane mode; the waves along x or along y."""
    parts, errors = np.array([0.07, 0.3, 0.75]), []
    exact = -np.pi * MODULUS / (2 * LENGTH * np.log(np.sqrt(parts)))
    for n in 128, 512:
        field = wave(n) if across else wave(n).T
        found = joint.of_interface(field, LENGTH / n, parts * FULL, steps=1, **PAIR)
        k_t = (found.k_t_x, found.k_t_y) if across else (found.k_t_y, found.k_t_x)
        errors.append(np.abs(found.k_n / exact - 1).max())
        assert k_t[0] == pytest.approx(found.k_n, rel=1e-4)
        assert k_t[1] == pytest.approx((1 - POISSON) * found.k_n, rel=1e-4)
        assert found.area == pytest.approx(2 / np.pi * np.arcsin(np.sqrt(parts)), abs=1.5 / n)
    assert errors[1] < 0.012 and errors[1] < 0.5 * errors[0]  # first order: the edges lie between cells


def test_stiffness_is_the_slope_of_the_pressure_over_the_closure():
    pressures = 0.4 * FULL * np.array([0.99, 1.0, 1.01])
    found = joint.of_interface(wave(256), LENGTH / 256, pressures, steps=1, **PAIR)
    slope = (pressures[2] - pressures[0]) / (found.closure[2] - found.closure[0])
    assert found.k_n[1] == pytest.approx(slope, rel=0.01)
    assert found.k_n_secant == pytest.approx(pressures / found.closure)


def test_tangential_stiffness_of_random_roughness_has_the_ratio_of_theory():
    found = joint.of_interface(joint.mirrored(waves(48, 3)), 1e-5, [4e6, 12e6], steps=1, **PAIR)
    ratio = (found.k_t_x + found.k_t_y) / 2 / found.k_n
    assert ratio == pytest.approx(2 * (1 - POISSON) / (2 - POISSON), rel=0.02)


def test_heights_and_pressures_of_one_factor_leave_the_stiffness():
    one, three = (
        joint.of_interface(f * waves(48, 5), 1e-5, f * np.array([3e6, 9e6]), steps=2, **PAIR) for f in (1.0, 3.0)
    )
    for name, power in (
        ("k_n", 0),
        ("k_t_x", 0),
        ("area", 0),
        ("closure", 1),
        ("loop_amplitude", 1),
        ("loop_energy", 2),
    ):
        assert three.numbers[name] == pytest.approx(3.0**power * one.numbers[name], rel=1e-5), name


def test_energy_of_the_loop_is_its_area():
    """By a history of the program of the same loads: the work of the load over the second cycle."""
    case = dict(PAIR, elasticity="periodic", gap_type="flat", grid_n=48, grid_size=48e-5, steps=12)
    field, pressure = waves(48, 7), 6e6
    found = joint.of_interface(field, 1e-5, [pressure], shear=0.6, steps=6, full=True, **PAIR)
    load = pressure * 48e-5**2
    turns = 0.6 * PAIR["friction"] * load * np.array([0, 1, -1, 1, -1, 1])
    with petsam.Contact(**case) as contact:
        contact.gap = field - field.min()
        steps = contact.run(dict(time=np.arange(1.0, 7.0), load_n=[load] * 6, load_tx=turns))
    x, t = (np.array([step.numbers[name] for step in steps[-25:]]) for name in ("disp_x", "load_tx"))
    work = np.sum(np.diff(x) * (t[1:] + t[:-1]) / 2) / 48e-5**2
    assert found.loop_energy[0] == pytest.approx(work, rel=0.02)
    assert found.loop_amplitude[0] == pytest.approx((x.max() - x.min()) / 2, rel=1e-3)
    assert found.loop_stiffness[0] < found.k_t_x[0]


def test_first_loading_is_a_difference_of_two_closures():
    """Jaeger's rule for alike bodies: the shear of a push is mu times the difference to a smaller pressure."""
    field, pressure = waves(96, 3), 8e6
    mu = PAIR["friction"]
    found = joint.of_interface(field, 1e-5, [pressure], steps=3, full=True, **PAIR)
    less = joint.of_interface(field, 1e-5, pressure * (1 - found.parts[::-1]), steps=1, **PAIR).closure[::-1]
    ratio = found.k_n[0] / found.k_t_x[0]
    assert found.loading[0] == pytest.approx(mu * ratio * (found.closure[0] - less), rel=0.03)


def test_loops_follow_from_the_first_loading():
    """By Masing's rule; the energies are of two different computations."""
    found = joint.of_interface(waves(64, 13), 1e-5, [5e6, 15e6], shear=0.6, steps=6, full=True, **PAIR)
    for k, pressure in enumerate(found.pressure):
        limit = PAIR["friction"] * pressure
        slip = found.loading[k] * found.k_t_x[k] / limit - found.parts
        energy = elements.masing(np.append(0.0, found.parts), np.append(0.0, slip))[6] * limit**2 / found.k_t_x[k]
        assert energy == pytest.approx(found.loop_energy[k], rel=2e-3)


def test_the_error_of_an_element_is_that_of_dissimilar_bodies_too():
    """Their loops are narrower than the first loading: the element's at the same amplitude loses less energy."""
    pair = dict(bodies(210e9, 0.3, 20e9, 0.1), friction=1.0)
    found = joint.of_interface(waves(48, 13), 1e-5, [4e6], steps=6, **pair)
    limit = 4e6 * pair["friction"]
    amplitude = found.loop_amplitude * found.k_t_x / limit
    energy = elements.iwan(found.iwan_chi, found.iwan_beta, amplitude)[1] * limit**2 / found.k_t_x
    first = elements.fit_iwan(found.parts, found.loading[0] * found.k_t_x[0] / limit)[2]
    assert found.iwan_error == pytest.approx(np.abs(energy / found.loop_energy - 1)) and found.iwan_error > first


@pytest.mark.parametrize("chi, beta", [(-0.3, 0.5), (0.4, 2.0), (0.0, 0.05)])
def test_iwan_element_is_the_sum_of_its_sliders(chi, beta):
    """Its shear and its loops are those of many sliders, and a fit to its first loading finds it again."""
    amplitudes = np.linspace(0.05, 1.4, 109)
    shear, energy = elements.iwan(chi, beta, amplitudes)
    n, scale = 20000, beta + (chi + 1) / (chi + 2)
    reach = (1 + beta) / scale
    limits = reach * (np.arange(n) + 0.5) / n  # kt is 1: displacements at which the sliders slip
    weights = (
        (chi + 1)
        / scale
        / reach
        * ((np.arange(1, n + 1) / n) ** (chi + 1) - (np.arange(n) / n) ** (chi + 1))
        / (chi + 1)
    )
    limits, weights = np.append(limits, reach), np.append(weights, beta / scale / reach)
    for k in 12, 44, 80:
        u = amplitudes[k]
        assert np.sum(weights * np.minimum(u, limits)) == pytest.approx(shear[k], rel=1e-3)
        assert np.sum(4 * weights * limits * np.maximum(u - limits, 0)) == pytest.approx(energy[k], rel=1e-3)
    use = shear < 0.97
    found = elements.fit_iwan(shear[use], amplitudes[use])
    assert found[:2] == pytest.approx((chi, beta), abs=0.02) and max(found[2:]) < 0.01


def test_elements_are_those_of_their_area(tmp_path):
    found = joint.of_interface(waves(48, 3), 1e-5, [4e6, 12e6], steps=3, **PAIR)
    found.to_json(tmp_path / "e.json", area=2e-6)
    written = json.loads((tmp_path / "e.json").read_text())
    assert written["area"] == 2e-6 and written["friction"] == 0.3 and written["elements"] == found.elements(2e-6)
    for k, one in enumerate(written["elements"]):
        force = 2e-6 * found.pressure[k]
        iwan = dict(kt=2e-6 * found.k_t_x[k], Fs=0.3 * force, chi=found.iwan_chi[k], beta=found.iwan_beta[k])
        assert one["tmdsimpy"]["Iwan4Force"] == pytest.approx(iwan)
        assert one["tmdsimpy"]["ElasticDryFriction3D"]["kn"] == pytest.approx(2e-6 * found.k_n[k])
        assert one["pyHarm"]["Penalty3D"]["N0"] == pytest.approx(force)
        assert 0.02 < one["iwan_error"] < 0.5
        fit = elements.fit_iwan(found.parts, found.loading[k] * found.k_t_x[k] / (0.3 * found.pressure[k]))
        assert fit[:3] == pytest.approx((found.iwan_chi[k], found.iwan_beta[k], one["iwan_error"]), rel=1e-6)
    few = joint.of_interface(waves(48, 3), 1e-5, [4e6], steps=1, **PAIR)
    few.to_json(tmp_path / "e.json")
    assert json.loads((tmp_path / "e.json").read_text())["elements"][0]["iwan_error"] is None


def test_stiffness_of_a_row_of_distant_spheres():
    """A round contact of radius a per period L: 1/(2 E* a) - 3.9002649/(pi E* L), as the mean of all does not move."""
    n, size, radius = 192, 1e-3, 2e-3
    x = (np.arange(n) + 0.5) / n * size - size / 2
    field = (x**2 + x[:, None] ** 2) / (2 * radius)
    a = 0.12 * size
    found = joint.of_interface(field, size / n, [4 / 3 * MODULUS * a**3 / radius / size**2], steps=1, **PAIR)
    a = np.sqrt(found.area[0] / np.pi) * size
    exact = 1 / (size**2 * (1 / (2 * MODULUS * a) - 3.9002649 / (np.pi * MODULUS * size)))
    assert found.k_n[0] == pytest.approx(exact, rel=0.02)


def test_windows_give_means_and_deviations(tmp_path):
    field = waves(64, 9)
    found = joint.of_windows(field, 1e-5, [8e6, 16e6], steps=1, **PAIR)
    corners = [field[j : j + 32, i : i + 32] for j in (0, 32) for i in (0, 32)] + [field[16:48, 16:48]]
    each = [joint.of_interface(joint.mirrored(part), 1e-5, [8e6, 16e6], steps=1, **PAIR).k_n for part in corners]
    assert found.k_n == pytest.approx(np.mean(each, axis=0)) and found.spread["k_n"] == pytest.approx(
        np.std(each, axis=0, ddof=1)
    )
    found.to_csv(tmp_path / "i.csv")
    with open(tmp_path / "i.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["k_n [Pa/m]"]) for row in rows] == list(found.k_n)
    assert [float(row["area_spread [1]"]) for row in rows] == list(found.spread["area"])
    assert [row["friction [1]"] for row in rows] == ["0.3"] * 2 and [row["shear [1]"] for row in rows] == ["0.5"] * 2
    found.to_abaqus(tmp_path / "i.inp", name="JOINT")
    text = (tmp_path / "i.inp").read_text()
    lines = [line for line in text.splitlines() if not line.startswith("**")]
    assert lines[0] == "*SURFACE INTERACTION, NAME=JOINT" and lines[2] == "0., 0." and lines[-1] == "0.3"
    assert [float(word) for word in lines[4].split(",")] == pytest.approx([16, found.closure[1] * 1e3], rel=1e-5)
    slips = 0.3 * found.pressure * 2 / (found.k_t_x + found.k_t_y)
    assert f"median of {1e3 * min(slips):.4g} to {1e3 * max(slips):.4g}" in text
    figure = petsam.plot.interface(found)
    assert [axes.get_xlabel() for axes in figure.axes] == ["nominal pressure, MPa"] * 2
    curves = [bars.lines[0] for bars in figure.axes[0].containers]
    assert [curve.get_color() for curve in curves] == list(COLORS[:3])
    assert np.allclose(curves[0].get_ydata(), found.k_n * 1e-12)  # N/m per m2 to N/um per mm2
    along, across = curves[1:]  # both are seen where they lie on one another
    assert along.get_markerfacecolor() == "none" and along.get_markersize() > across.get_markersize() + 2
    assert across.get_linestyle() == "--" != along.get_linestyle()


def test_warnings_of_all_solutions_are_one():
    with pytest.warns(petsam.AdviceWarning) as found:
        joint.of_windows(waves(64, 9), 1e-5, [8e6, 16e6], steps=1, **PAIR)
    assert len(found) == 1 and found[0].filename == __file__
    text = str(found[0].message)
    assert re.match(
        r"\d+ solutions have a warning, the first at 8e\+06 Pa in window 1 with its mirror images: (error by )?the ",
        text,
    )
    assert "-grid" not in text


def test_the_first_warning_has_its_place():
    with windows._noted() as (noted, begins):
        for place in "abc":
            begins(place)
            for one in {"b": ["x: use y", "z"], "c": ["z"]}.get(place, []):
                warnings.warn(one, petsam.AdviceWarning, stacklevel=1)
    with pytest.warns(petsam.AdviceWarning) as found:
        joint.interfaces._tell_warnings(noted)
    assert [str(one.message).partition(";")[0] for one in found] == ["3 solutions have a warning, the first at b: x"]
    with windows._noted() as (noted, _):
        warnings.warn("z", petsam.AdviceWarning, stacklevel=1)
    assert [place for place, *_ in noted] == ["the start"]


def test_windows_of_unlike_stiffness_do_not_seem_to_slip():
    """The first loading of all windows begins with their mean stiffness, as each of them begins with its own."""
    field = waves(64, 9) * np.linspace(0.5, 3.0, 64)[:, None]
    found = joint.of_windows(field, 1e-5, [8e6], steps=5, **PAIR)
    assert found.spread["k_t_x"] > 0.25 * found.k_t_x
    assert found.loading[0, 0] * found.k_t_x[0] / (PAIR["friction"] * 8e6) < 1.1 * found.parts[0]


def test_nothing_that_slips_is_printed_without_a_deviation(command, tmp_path):
    """A surface that touches in one cell of a window: no energy, no Iwan element, and no complaint of numpy."""
    field = np.full((16, 16), 1e-6)
    field[2::8, 2::8] = 0.0
    write(tmp_path / "scan.h5", "separation", field)
    words = ("scan.h5", "--pressure", "1MPa", "--friction", 0.25, "--steps", 1, *STEEL)
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        assert command(*words).splitlines()[2].split()[-4:] == ["-", "-", "-", "-"]


def test_mirror_images_join_without_a_step():
    field = joint.mirrored(waves(24, 1))
    for axis in 0, 1:
        assert np.array_equal(field, np.roll(np.flip(field, axis), 0, axis))
        assert np.array_equal(np.take(field, 0, axis), np.take(field, -1, axis))


@pytest.mark.parametrize(
    "change, says",
    [
        (dict(pressures=[2e6, 1e6]), "pressures that rise"),
        (dict(pressures=[0.0, 1e6]), "positive pressures"),
        (dict(pressures=[]), "positive pressures"),
        (dict(separation=np.ma.masked_array(np.ones((8, 8)), np.eye(8))), "finite numbers"),
        (dict(separation=np.full((8, 8), np.nan)), "finite numbers"),
        (dict(separation=np.zeros(8)), "a field"),
        (dict(friction=0.0), "a coefficient > 0"),
        (dict(pressures=[1e6, 1e12]), "1e.12 Pa: all of the surface touches"),
        (dict(shear=1.0), "below 1"),
        (dict(shear="half"), "shear 'half': expected a part"),
        (dict(steps=0), "steps 0: expected an integer >= 1"),
        (dict(spacing=[1e-5] * 3), "spacing .*: expected the distance of points"),
        (dict(spacing=0.0), "spacing: expected lengths above 0"),
        (dict(pressures="1MPa"), "pressures: expected numbers, not '1MPa'"),
        (dict(body1_yung=1.0), "body1_young"),
    ],
)
def test_a_mistake_is_named(change, says):
    given = dict(PAIR, separation=waves(32, 1), spacing=1e-5, pressures=[1e6]) | change
    with pytest.raises(petsam.Error, match=says):
        joint.of_interface(**given)


# ---------------------------------------------------------------- the command


@pytest.fixture
def command(joint_command):
    """command(*words, check=0): what petsam-joint stiffness prints; its complaint where it fails."""
    return functools.partial(joint_command, "stiffness")


STEEL = ("--body1", "steel", "--body2", "210GPa,0.3")


def write(path, name, values, spacing=1e-5):
    with h5py.File(path, "w") as file:
        file[name] = values
        for letter, n in zip("yx", values.shape):
            file[letter] = (np.arange(n) + 0.5) * spacing


def test_command_gives_the_numbers_of_the_function(command, tmp_path):
    """A file may have heights, peaks positive, or a separation; the numbers are printed, and in files."""
    field = waves(64, 11)
    write(tmp_path / "scan.h5", "height", -field)
    write(tmp_path / "pair.h5", "separation", field)
    pair = dict(bodies(210e9, 0.3), friction=0.25)
    expected = joint.of_windows(field, 1e-5, np.geomspace(1e7, 4e7, 3), steps=1, shear=0.4, **pair)
    words = ("--pressure", "10MPa:40MPa:3", "--friction", 0.25, "--shear", 0.4, "--steps", 1, *STEEL)
    printed = command("scan.h5", *words, "-o", "i")
    lines = "\n".join(expected.lines()) + "\n"
    assert printed == lines + "".join(f"wrote i.{end}\n" for end in ("csv", "png", "json", "inp"))
    assert command("pair.h5", *words) == lines
    with open("i.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["k_t_x [Pa/m]"]) for row in rows] == pytest.approx(expected.k_t_x, rel=1e-9)
    assert len(json.loads((tmp_path / "i.json").read_text())["elements"]) == 3
    said = printed.splitlines()[0]
    assert said.startswith("no error of the grid is known for these numbers") and {row["note"] for row in rows} == {
        said
    }
    assert json.loads((tmp_path / "i.json").read_text())["errors"] == said
    assert (tmp_path / "i.inp").read_text().startswith("** contact") and (tmp_path / "i.png").stat().st_size > 10000
    whole = joint.of_interface(field, 1e-5, [2e7], steps=1, **pair)
    assert command("pair.h5", "--pressure", "2e7", "--friction", 0.25, "--steps", 1, "--periodic", *STEEL) == (
        "\n".join(whole.lines()) + "\n"
    )


def test_a_rigid_body_is_twice_as_stiff(command, tmp_path):
    """But for the coupling of pressure and shear, which alike bodies do not have."""
    write(tmp_path / "pair.h5", "separation", waves(32, 1))
    words = ("pair.h5", "--friction", 0.25, "--steps", 1, "--periodic", "--body1", "steel", "--body2")
    one, two = (
        float(command(*words, body, "--pressure", p).splitlines()[2].split()[1])
        for body, p in (("steel", "1e7"), ("inf,0.3", "2e7"))
    )
    assert two == pytest.approx(2 * one, rel=0.03)


def test_the_picture_has_the_given_resolution(command, tmp_path):
    write(tmp_path / "pair.h5", "separation", waves(32, 1))
    words = ("pair.h5", "--pressure", "2e7", "--friction", 0.25, "--steps", 1, "--periodic", *STEEL)
    widths = []
    for more in ((), ("--dpi", 300)):
        command(*words, *more, "-o", "p")
        widths.append(plt.imread(tmp_path / "p.png").shape[1])
    assert widths[1] == pytest.approx(2 * widths[0], abs=2)
    assert "--dpi: is for the picture" in command(*words, "--dpi", 300, check=2)


def test_hardness_limits_the_pressure_of_summits(command, tmp_path):
    write(tmp_path / "scan.h5", "height", waves(64, 11))
    words = ("scan.h5", "--pressure", "20MPa", "--friction", 0.25, "--steps", 1, *STEEL)
    cases = ((5, ()), (6, ("--hardness", "0.17GPa")))  # the table has a column more
    areas = [float(command(*words, *more).splitlines()[2].split()[column]) for column, more in cases]
    assert areas[1] > 1.1 * areas[0] and areas[1] >= 100 * 20e6 / 0.17e9


@pytest.mark.parametrize(
    "words, says",
    [
        (("none.h5", "--pressure", "1MPa"), "none.h5: "),
        (("text.h5", "--pressure", "1MPa"), "text.h5: "),
        (
            ("flat.h5", "--pressure", "1MPa"),
            "no dataset height or separation; convert another one by petsam-surface FILE --dataset NAME",
        ),
        (
            ("gaps.h5", "--pressure", "1MPa"),
            "gaps.h5: no surface of petsam-surface: /height has no number at 4 of 1024 ",
        ),
        (("scan.h5", "--pressure", "1MPa:2MPa"), "expected FIRST:LAST:COUNT"),
        (("scan.h5", "--pressure", "-1"), "-1: expected FIRST:LAST:COUNT, or pressures above 0"),
        (("scan.h5", "--pressure", "2MPa,1MPa"), "pressures that rise"),
        (("scan.h5", "--pressure", "1MPa", "--body1", "stel"), "stel is no material: is steel meant?"),
        (("scan.h5", "--pressure", "1MPa", "--shear", "1.5"), "shear 1.5"),
        (("scan.h5", "--pressure", "1MPa", "--area", "0"), "--area: 0: expected an area above 0"),
        (("scan.h5", "--pressure", "1MPa", "--steps", "0"), "--steps: 0: expected a whole number, 1 or more"),
    ],
)
def test_a_mistake_of_the_command_is_named(command, tmp_path, words, says):
    write(tmp_path / "scan.h5", "height", waves(32, 1))
    write(tmp_path / "flat.h5", "depth", waves(32, 1))
    write(tmp_path / "gaps.h5", "height", np.where(np.arange(32) > 27, [[np.nan]] + 31 * [[0.0]], waves(32, 1)))
    (tmp_path / "text.h5").write_text("no HDF5")
    said = command("--friction", "0.3", *STEEL, *words, check=3 if words[0] != "scan.h5" else 2)
    assert said.startswith("petsam-joint: error: ") and says in said and len(said.splitlines()) == 1


# ---------------------------------------------------------------- what the file states


def write_stated(path, field, unit="m", quantity="separation", axes="m", more=None):
    """A separation as petsam-surface writes it, in these units and as this quantity."""
    scale = {"m": 1.0, "mm": 1e-3, "um": 1e-6}
    with h5py.File(path, "w") as file:
        data = file.create_dataset("height", data=(field if quantity == "separation" else -field) / scale[unit])
        data.attrs.update(dict(units=unit, quantity=quantity), **(more or {}))
        for letter, n in zip("yx", field.shape) if axes else ():
            file[letter] = (np.arange(n) + 0.5) * 1e-5 / scale[axes]
            file[letter].attrs["units"] = axes


@pytest.mark.parametrize("given", [
    dict(unit="um"), dict(quantity="height1"), dict(quantity="height2", unit="mm"), dict(axes="um"), dict(axes="mm"),
    dict(axes="", more=dict(size=(3.2e-4, 3.2e-4))), dict(unit="um", quantity="height1", axes="um"),
], ids=str)  # fmt: skip
def test_units_and_quantity_of_a_file_hold(command, tmp_path, given):
    words = ("--pressure", "10MPa", "--friction", 0.25, "--steps", 1, "--periodic", *STEEL)
    write_stated(tmp_path / "a.h5", waves(32, 5))
    write_stated(tmp_path / "b.h5", waves(32, 5), **given)
    assert command("b.h5", *words) == command("a.h5", *words)


@pytest.mark.parametrize("change, says", [
    (dict(units="furlong"), "its attribute units is 'furlong'"), (dict(quantity="depth"), "its attribute quantity"),
    (dict(scale_factor=2.0), "packed"), (dict(size=(1.0, -1.0)), "its attribute size"),
    (dict(size=(1e-3, 1e-3)), "contradict each other"),
], ids=str)  # fmt: skip
def test_a_statement_that_cannot_hold_is_refused(command, tmp_path, change, says):
    write_stated(tmp_path / "a.h5", waves(32, 5), more=change)
    said = command("a.h5", "--pressure", "10MPa", "--friction", 0.25, *STEEL, check=3)
    assert says in said and len(said.splitlines()) == 1


def test_an_uneven_axis_is_refused(command, tmp_path):
    write_stated(tmp_path / "a.h5", waves(32, 5))
    with h5py.File(tmp_path / "a.h5", "r+") as file:
        file["x"][20:] += 1e-5
    assert "x is not even" in command("a.h5", "--pressure", "10MPa", "--friction", 0.25, *STEEL, check=3)


@pytest.mark.parametrize("words, says", [
    (("--pressure", "20", "--friction", 0.25, *STEEL), "20 Pa is"),
    (("--pressure", "20:40:3", "--friction", 0.25, *STEEL), "20 Pa is"),
    (("--pressure", "20MPa", "--friction", 40, *STEEL), "friction 40: use a coefficient"),
    (("--pressure", "20MPa", "--friction", 1e-9, *STEEL), "friction 1e-09: use a coefficient"),
    (("--pressure", "20MPa", "--friction", 0.4, "--body1", "210e3,0.3", "--body2", "210e3,0.3"), "above E*"),
], ids=str)  # fmt: skip
@pytest.mark.parametrize("periodic", [(), ("--periodic",)], ids=str)
def test_numbers_in_other_units_are_refused(command, tmp_path, words, says, periodic):
    write_stated(tmp_path / "a.h5", waves(32, 5))
    assert says in command("a.h5", *words, *periodic, check=2)


def test_interface_takes_a_file_a_map_or_an_array(tmp_path):
    heights = waves(32, 5)
    one = petsam.surface.read(saved(tmp_path / "heights.npy", heights), units="m", size=(3.2e-4, 3.2e-4), body=1)
    one.write(str(tmp_path / "heights.h5"))
    given = dict(PAIR, friction=0.3, steps=1, periodic=True)
    found = [
        joint.interface(tmp_path / "heights.h5", [8e6], **given),
        joint.interface(one, [8e6], **given),
        joint.interface(-heights, [8e6], spacing=1e-5, **given),
        joint.of_interface(-heights, 1e-5, [8e6], **dict(PAIR, friction=0.3, steps=1)),
    ]
    assert all(other.k_n == pytest.approx(found[0].k_n, rel=1e-12) for other in found[1:])
    assert joint.interface(one, [8e6], **dict(PAIR, friction=0.3, steps=1)).spread["k_n"] > 0.0
    with pytest.raises(petsam.MissingFile, match="absent.h5: no such file"):
        joint.interface("absent.h5", [8e6], **given)
    with pytest.raises(petsam.Error, match="spacing: give the distance"):
        joint.interface(heights, [8e6], **given)
    with pytest.raises(petsam.Error, match="spacing: the surface has its own"):
        joint.interface(one, [8e6], spacing=1e-5, **given)


def saved(path, values):
    """The path of an array that has been written there."""
    np.save(path, values)
    return str(path)


@pytest.mark.parametrize("more", [dict(normal_only=True), dict(friction=0.4), dict(friction=0.4, full=True)])
def test_interfaces_of_bodies_that_relax_are_rejected(more):
    """Their steps have no time, so that loops would be those of a sudden load."""
    x = np.arange(16) / 16
    waves = 1e-7 * (2 - np.cos(2 * np.pi * x) - np.cos(2 * np.pi * x[:, None]))
    bodies = dict(body1="steel", body2="steel", body2_relax_moduli=0.5, body2_relax_times=1.0)
    with pytest.raises(petsam.Error, match="relax_moduli: joints are of bodies that do not relax.*omit the option"):
        petsam.joint.interface(waves, [20e6], spacing=1e-6, periodic=True, **more, **bodies)
