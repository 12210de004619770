"""petsam-surface: formulas, files of every kind, signs, and the whole chain from a map to a contact."""

import re
import sys

import h5py
import numpy as np
import pytest

from petsam.apps.surface import basics, filling, levels, maps, resampling
from petsam.core import units, words
from petsam.core.errors import Error
from petsam.core.texttable import Form, Text
from support import ROOT, assert_close, assert_same, ball, hertz
from test_plot import pixels

SIZE = (1.2e-3, 1.0e-3)
KNOWS = ["--units", "um", "--size", "1.2mm,1mm"]


def make(function, n=(120, 90), size=SIZE, center=(1e-4, -2e-4), quantity="height2"):
    """A map of a function of x and y."""
    one = maps.new_map(np.zeros(n[::-1]), size, quantity, "map", center)
    one.values[:] = function(*np.meshgrid(one.axis(0), one.axis(1)))
    return one


@pytest.fixture
def surface(tmp_path, monkeypatch, capfd):
    """surface(*words, check=0): lines on stdout of petsam-surface, or those on stderr where it fails.

    warnings: whether there are some; None: that does not matter.
    """
    from petsam.apps.launch import code_of

    monkeypatch.chdir(tmp_path)

    def run(*words, check=0, warnings=False):
        monkeypatch.setattr(sys, "argv", ["petsam-surface", *map(str, words)])
        try:
            code = code_of("petsam-surface")
        except SystemExit as end:  # of argparse
            code = end.code
        out, err = capfd.readouterr()
        run.complaint = err
        assert code == check, out + err
        assert check or warnings is None or bool(err) == warnings, err
        if check:
            assert len(err.splitlines()) == 1 and err.startswith("petsam-surface: error: "), err
        return (err if check else out).splitlines()

    return run


def stored(path, name="height"):
    with h5py.File(path, "r") as file:
        return file[name][:]


# ---------------------------------------------------------------- formulas


def test_slope_and_height_of_a_wave():
    waves, amplitude = 5, 2e-6
    k = 2 * np.pi * waves / SIZE[0]
    one = make(lambda x, y: amplitude * np.sin(k * x), n=(600, 8))
    assert maps.rms_height(one) == pytest.approx(amplitude / np.sqrt(2), rel=1e-9)
    assert maps.peak_to_valley(one) == pytest.approx(2 * amplitude, rel=1e-3)
    assert maps.rms_slope(one) == pytest.approx(amplitude * k / np.sqrt(2), rel=2e-3)


def test_slope_counts_both_directions():
    assert maps.rms_slope(make(lambda x, y: 0.3 * x - 0.4 * y)) == pytest.approx(0.5, rel=1e-9)


PLANE = lambda x, y: 3e-6 + 0.01 * x - 0.02 * y  # noqa: E731
FORMS = {
    "mean": lambda x, y: 3e-6 + 0 * x,
    "tilt": PLANE,
    "second-order": lambda x, y: PLANE(x, y) - 5 * x * x + 3 * x * y - 9 * y * y,
    "sphere": lambda x, y: np.sqrt(4e-6 - (x - 2e-4) ** 2 - (y + 3e-4) ** 2) - 1e-3,
    "cylinder": lambda x, y: -np.sqrt(4e-6 - (0.6 * x - 0.8 * y + 1e-4) ** 2),
}


@pytest.mark.parametrize("kind", FORMS)
def test_levelling_leaves_nothing_of_its_form(kind):
    one = make(FORMS[kind])
    flat, said = levels.levelled(one, kind)
    assert np.max(np.abs(flat.values)) < 1e-12 * max(np.ptp(one.values), 3e-6)
    assert kind in said and (kind not in ("sphere", "cylinder") or "radius 0.002 m" in said)


@pytest.mark.parametrize("kind", FORMS)
def test_levelling_keeps_what_is_no_form(kind):
    """A fine wave is hardly touched, and what is left has neither mean nor, after mean, tilt."""
    wave = make(lambda x, y: 1e-7 * np.sin(2e5 * x) * np.sin(1.7e5 * y)).values
    one = make(lambda x, y: FORMS[kind](x, y) + wave)
    left = levels.levelled(one, kind)[0]
    assert np.max(np.abs(left.values - wave)) < 0.02 * np.max(np.abs(wave))
    assert abs(left.values.mean()) < 1e-3 * np.std(wave)
    assert kind == "mean" or max(np.abs(levels.tilt(left))) < 1e-6


def test_nothing_is_levelled_unless_asked_for():
    one = make(PLANE)
    assert levels.levelled(one, "none") == (one, "")
    assert np.allclose(levels.tilt(one), (0.01, -0.02), rtol=1e-10)


@pytest.mark.parametrize("n", [(60, 45), (37, 20), (120, 31), (201, 100)], ids=str)
def test_resampling_keeps_the_mean(n):
    noise = np.random.default_rng(1).standard_normal((90, 120))
    one = make(lambda x, y: 1e-6 * noise + 5e-3)
    other = resampling.resampled(one, n)
    assert other.n == n and other.size == one.size and other.center == one.center
    assert abs(other.values.mean() - one.values.mean()) < 1e-12 * 1e-6


def test_coarser_cells_are_means_of_finer_ones():
    noise = np.random.default_rng(2).standard_normal((90, 120))
    one = make(lambda x, y: noise)
    blocks = noise.reshape(30, 3, 60, 2).mean(axis=(1, 3))
    assert_close(resampling.resampled(one, (60, 30)).values, blocks, 1e-13)


def test_a_form_survives_resampling():
    """Any parabola does, on finer and coarser cells about the same middle, up to a constant."""
    form = FORMS["second-order"]
    one = make(form)
    for n, size in (((35, 44), (1e-3, 0.8e-3)), ((250, 190), None)):
        other = resampling.resampled(one, n, size)
        x, y = np.meshgrid(other.axis(0), other.axis(1))
        assert np.ptp(other.values - form(x, y)) < 1e-12 * np.ptp(other.values)


def test_waves_that_coarse_cells_cannot_show_do_not_alias():
    one = make(lambda x, y: np.sin(2 * np.pi * x / (2.2e-5) + 0.3))  # 2.2 cells of 10 um; coarse ones are 60 um
    picked = np.std(one.values[:, ::6])
    assert picked > 0.6 and np.std(resampling.resampled(one, (20, 15)).values) < 0.15 * picked


def test_a_grid_larger_than_the_map_is_refused():
    with pytest.raises(Error, match="--grid-size: 1.3 mm in x, but the map has only 1.2 mm"):
        resampling.resampled(make(PLANE), None, (1.3e-3, 1e-3))


# ---------------------------------------------------------------- missing points


def with_hole(function=PLANE, rows=slice(20, 40), columns=slice(30, 50)):
    one = make(function)
    whole = one.values.copy()
    one.values[rows, columns] = np.nan
    return one, whole


def test_a_hole_in_a_plane_is_filled_with_the_plane():
    one, whole = with_hole()
    filled, count = filling.filled(one, "smooth")
    assert count == 400 and np.max(np.abs(filled.values - whole)) < 1e-12 * np.ptp(whole)


@pytest.mark.parametrize("how", ["smooth", "nearest"])
def test_fillings_stay_within_their_rim(how):
    noise = np.random.default_rng(3).standard_normal((90, 120))
    one, _ = with_hole(lambda x, y: noise)
    values = filling.filled(one, how)[0].values
    rim = np.concatenate([noise[19, 30:50], noise[40, 30:50], noise[20:40, 29], noise[20:40, 50]])
    hole = values[20:40, 30:50]
    assert rim.min() <= hole.min() and hole.max() <= rim.max()
    keep = ~np.isnan(one.values)
    assert np.array_equal(values[keep], one.values[keep])


def test_missing_points_are_refused_with_number_and_place(surface, tmp_path):
    values = np.arange(48.0).reshape(6, 8)
    values[4, 5] = np.nan
    values[5, 1] = np.inf
    np.save(tmp_path / "z.npy", values)
    for more, x in (([], 1.5e-3), (["--first-row", "top", "--mirror", "x"], -1.5e-3)):
        (said,) = surface("z.npy", "--body", 2, "--units", "um", "--pixel", "1mm", *more, check=3)
        assert "2 points are missing, of 48" in said and "--fill smooth" in said
        first = "row 4, column 5" if not more else "row 5, column 1"
        assert first in said and (more or f"x = {x:g} m, y = 0.0015 m" in said)
    assert not (tmp_path / "z.h5").exists()
    window = ["--window", "-4mm,4mm,-3mm,1mm"]  # without the holes
    surface("z.npy", "--body", 2, "--units", "um", "--pixel", "1mm", *window)
    assert np.array_equal(stored(tmp_path / "z.h5"), values[:4] * 1e-6)


def test_a_value_may_stand_for_missing_points(surface, tmp_path):
    values = np.ones((5, 5))
    values[2, 2] = -9999
    np.save(tmp_path / "z.npy", values)
    surface("z.npy", "--body", 2, *KNOWS, "--missing", -9999, "--fill", "smooth")
    assert np.allclose(stored(tmp_path / "z.h5"), 1e-6, rtol=1e-12, atol=0)


def test_values_that_are_no_heights_are_told(surface, tmp_path):
    values = np.zeros((5, 5))
    for value, code in ((3.4e38, 3), (2e3, 0), (1e3, 0)):
        values[1, 1] = value
        np.save(tmp_path / "z.npy", values)
        said = surface("z.npy", "--body", 2, *KNOWS, "--no-picture", check=code, warnings=value == 2e3)
        assert not code or "up to 3.4e+32 m" in said[0] and "--missing" in said[0]


@pytest.mark.parametrize(
    "size, warned", [(["--pixel", "1"], True), (["--pixel", "1um"], False), (["--size", "1"], True)]
)
def test_a_surface_as_wide_as_a_room_is_doubted(surface, tmp_path, size, warned):
    np.save(tmp_path / "z.npy", np.arange(12.0).reshape(3, 4))
    surface("z.npy", "--body", 2, "--units", "nm", *size, "--no-picture", warnings=warned)


def test_nothing_but_missing_points(surface, tmp_path):
    np.save(tmp_path / "z.npy", np.full((4, 4), np.nan))
    assert "all points are missing" in surface("z.npy", "--body", 2, *KNOWS, "--fill", "smooth", check=3)[0]


# ---------------------------------------------------------------- lengths


def test_python_and_c_know_the_same_units():
    text = (ROOT / "src/ground/file/lengths.c").read_text()
    pairs = re.findall(r'\{"([^"]+)", ([\d.e-]+)\}', text.split("} units[]")[1].split(";")[0])
    names = {name: float(value) for words, value in pairs for name in words.encode().decode("unicode_escape").split()}
    assert names == units.of("m")
    assert f'UNITS "{units.names()}"' in text and all(units.size(name) for name in units.names().split(", "))
    quantities = re.findall(r'\{"(\w+)", -?1\}', text.split("quantities[]")[1].split(";")[0])
    assert set(quantities) == set(basics.QUANTITIES)


@pytest.mark.parametrize(
    "text, value",
    [
        ("1e-3", [1e-3]),
        ("1mm,0.5 mm", [1e-3, 5e-4]),
        ("250um", [2.5e-4]),
        ("-3\u00b5m", [-3e-6]),
        ("2 microns", [2e-6]),
    ],
)
def test_lengths_have_units_or_are_metres(text, value):
    assert np.allclose(words.numbers(text, unit="m"), value, rtol=1e-15)


# ---------------------------------------------------------------- text files

TABLE = np.array([[1.5, -2.0, 3.25, 4.0], [5.0, 6.5, 7.0, -8.0], [9.0, 0.5, 1.0, 2.0]])


def lines(separator, point="."):
    return [separator.join(f"{value:g}".replace(".", point) for value in row) for row in TABLE]


@pytest.mark.parametrize("text, more, header", [
    ("\n".join(lines(",")), {}, 0),
    ("\n".join(lines(", ")) + "\n", {}, 0),
    ("\r\n".join(lines(";")), {}, 0),
    ("\n".join(lines("\t")), {}, 0),
    ("\n".join("  " + line for line in lines("  ")), {}, 0),
    ("\ufeffHeight;in \u00b5m\n\n" + "\n".join(lines(";")), {}, 1),
    ("# 1, 2\n% 3\n" + "\n".join(lines(",")), {}, 0),
    ("\n".join(line + "," for line in lines(",")), {}, 0),
    ("\n".join(lines(";", ",")), dict(decimal="comma"), 0),
    ("\n".join(lines(" ", ",")), dict(decimal="comma"), 0),
    ("\n".join(lines("\t", ",")), dict(decimal="comma"), 0),
    ("width 1.2\nx,0,1,2,3\n" + "\n".join("7," + line for line in lines(",")), dict(skip_rows=2, skip_columns=1), 0),
], ids=[
    "commas", "commas and spaces", "semicolons", "tabs", "spaces", "header, mark of byte order", "comments",
    "separator at the end", "decimal commas", "decimal commas, spaces", "decimal commas, tabs", "skipped",
])  # fmt: skip
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "cp1252"])
def test_tables_of_every_form(tmp_path, text, more, header, encoding):
    path = tmp_path / "t.csv"
    path.write_bytes(text.replace("\ufeff", "" if encoding != "utf-8" else "\ufeff").encode(encoding))
    values, left_out, first = Text(path, Form(**more)).table
    assert np.array_equal(values, TABLE) and left_out == header


def test_words_for_missing_points(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("1,NaN,BAD,4\n,2,***,3\n1,2,3,\n")
    values, *_ = Text(path).table
    nan = np.nan
    assert np.array_equal(values, [[1, nan, nan, 4], [nan, 2, nan, 3], [1, 2, 3, nan]], equal_nan=True)


# ---------------------------------------------------------------- other files


@pytest.mark.parametrize("value, says", [
    (np.zeros((3, 4, 5)), "has shape (3, 4, 5)"), (np.zeros(9), "has shape (9,)"), (np.array(1.0), "has shape ()"),
    (np.zeros((3, 3), complex), "no array of real numbers"), (np.array([["a", "b"]]), "no array of real numbers"),
    (np.array([[None, 1], [2, 3]]), "is not an array of NumPy"), (np.zeros((1, 7)), "1 x 7 points"),
], ids=str)  # fmt: skip
def test_arrays_that_are_no_map(surface, tmp_path, value, says):
    np.save(tmp_path / "z.npy", value)
    (said,) = surface("z.npy", "--body", 2, *KNOWS, check=3)
    assert says in said


def test_a_damaged_array_is_refused(surface, tmp_path):
    np.save(tmp_path / "z.npy", np.zeros((20, 30)))
    data = (tmp_path / "z.npy").read_bytes()
    for part in (data[:400], data[:20], b"text"):
        (tmp_path / "z.npy").write_bytes(part)
        assert "z.npy: is not an array of NumPy" in surface("z.npy", "--body", 2, *KNOWS, check=3)[0]


@pytest.mark.parametrize("kind", [np.float32, np.int16, np.uint8, ">f8"])
def test_arrays_of_every_kind_of_number(surface, tmp_path, kind):
    values = np.arange(20).reshape(4, 5)
    np.save(tmp_path / "z.npy", np.asfortranarray(values.astype(kind)))
    surface("z.npy", "--body", 2, *KNOWS, "--no-picture")
    assert np.array_equal(stored(tmp_path / "z.h5"), values * 1e-6) and not (tmp_path / "z.png").exists()


def write_hdf5(path, values, attributes, x=None, y=None, units="mm"):
    with h5py.File(path, "w") as file:
        file["height"] = values
        file["height"].attrs.update(attributes)
        for name, axis in (("x", x), ("y", y)):
            if axis is not None:
                file[name] = axis
                file[name].attrs["units"] = units


def test_a_file_that_says_all_needs_no_option(surface, tmp_path):
    """Its axes fall, as y does in an image: they are turned."""
    values = np.arange(12.0).reshape(3, 4)
    x, y = [0.3, 0.2, 0.1, 0.0], [3, 2, 1]
    write_hdf5(tmp_path / "in.h5", values, dict(units="nm", quantity="height1"), x, y)
    surface("in.h5", "-o", "out.h5")
    assert_close(stored(tmp_path / "out.h5"), values[::-1, ::-1] * 1e-9, 1e-15)
    assert_close(stored(tmp_path / "out.h5", "x"), np.arange(4) * 1e-4, 1e-13)
    assert_close(stored(tmp_path / "out.h5", "y"), [1e-3, 2e-3, 3e-3], 1e-13)
    with h5py.File(tmp_path / "out.h5") as file:
        assert file["height"].attrs["units"] == "m" and file["height"].attrs["quantity"] == "height1"


@pytest.mark.parametrize("attributes, axes, more, says", [
    (dict(units="nm", quantity="height1"), True, ["--body", 2], "--body or --separation"),
    (dict(units="nm", quantity="height1"), True, ["--separation"], "--body or --separation"),
    (dict(units="nm", quantity="height1"), True, ["--units", "um"], "--units"),
    (dict(units="nm", quantity="height1"), True, ["--size", "1"], "--size or --pixel"),
    (dict(units="nm", quantity="height1"), True, ["--first-row", "top"], "--first-row"),
    (dict(units="nm", quantity="height1"), True, ["--transpose"], "--transpose"),
    (dict(units="nm", quantity="height1"), True, ["--depths"], "--depths"),
    (dict(units="nm"), True, [], "whether it holds heights"),
    (dict(quantity="height1"), True, [], "in which unit"),
    (dict(units="nm", quantity="height1"), False, [], "how large the surface is"),
    (dict(units="ell", quantity="height1"), True, [], "'ell'; use one of m, cm"),
    (dict(units="nm", quantity="depth"), True, [], "'depth'; use one of height1"),
    (dict(units=3, quantity="height1"), True, [], "units is not a text"),
    (dict(units="nm", quantity="height1", scale_factor=0.1), True, [], "packed"),
    (dict(units="nm", quantity="height1", add_offset=5.0), True, [], "packed"),
    (dict(units="nm", quantity="height1"), True, ["--dataset", "z"], "has no dataset /z"),
], ids=str)  # fmt: skip
def test_files_and_options_together_say_everything_once(surface, tmp_path, attributes, axes, more, says):
    x, y = ([0, 1, 2, 3], [0, 1, 2]) if axes else (None, None)
    write_hdf5(tmp_path / "in.h5", np.zeros((3, 4)), attributes, x, y)
    (said,) = surface("in.h5", "-o", "out.h5", *more, check=3)
    assert "in.h5: " in said and says in said, said


def test_an_axis_that_is_not_even_is_refused(surface, tmp_path):
    write_hdf5(tmp_path / "in.h5", np.zeros((3, 4)), dict(units="nm", quantity="height1"), [0, 1, 2, 4], [0, 1, 2])
    assert "x is not even" in surface("in.h5", "-o", "out.h5", check=3)[0]


def test_what_is_lacking_is_said_at_once(surface, tmp_path):
    np.save(tmp_path / "z.npy", TABLE)
    (said,) = surface("z.npy", check=3)
    assert all(word in said for word in ("--body 1", "--body 2", "--separation", "--units", "--size", "--pixel"))


def test_damaged_hdf5_and_none_at_all(surface, tmp_path):
    (tmp_path / "in.h5").write_text("text")
    assert "in.h5: cannot be read" in surface("in.h5", "-o", "out.h5", check=3)[0]
    assert "no.npy: no such file" in surface("no.npy", check=3)[0]
    (tmp_path / "d.csv").mkdir()
    assert "d.csv: is a directory" in surface("d.csv", check=3)[0]


SDF = """aISO-1.0
ManufacID   = petsam
CreateDate  = 010120200000
ModDate     = 010120200000
NumPoints   = 6
NumProfiles = 4
Xscale      = 1e-6
Yscale      = 2e-6
Zscale      = 1e-9
Zresolution = -1
Compression = 0
DataType    = 7
CheckType   = 0
*
{}
*
"""


def write_sdf(path, last="305"):
    values = np.add.outer(100 * np.arange(4), np.arange(6))
    text = "\n".join(" ".join(map(str, row)) for row in values)
    path.write_text(SDF.format(text[:-3] + last))
    return values


def test_files_of_instruments_know_units_and_size(surface, tmp_path):
    pytest.importorskip("SurfaceTopography", reason="SurfaceTopography is not installed")
    values = write_sdf(tmp_path / "z.sdf")
    surface("z.sdf", "--body", 2)
    assert_close(stored(tmp_path / "z.h5"), values * 1e-9, 1e-12)
    assert_close(stored(tmp_path / "z.h5", "x"), (np.arange(6) - 2.5) * 1e-6, 1e-12)
    assert_close(stored(tmp_path / "z.h5", "y"), (np.arange(4) - 1.5) * 2e-6, 1e-12)
    for more in (["--units", "nm"], ["--size", "1um"], ["--first-row", "top"], ["--channel", "5"]):
        assert more[0] in surface("z.sdf", "--body", 2, *more, check=3)[0]


def test_instruments_leave_points_out(surface, tmp_path):
    pytest.importorskip("SurfaceTopography", reason="SurfaceTopography is not installed")
    write_sdf(tmp_path / "z.sdf", "BAD")
    assert "1 point is missing, of 24, the first at row 3, column 5" in surface("z.sdf", "--body", 2, check=3)[0]


def test_the_library_of_another_program_agrees(surface, tmp_path):
    """netCDF as SurfaceTopography writes it, x being its first index; and its own rms slope."""
    library = pytest.importorskip("SurfaceTopography", reason="SurfaceTopography is not installed")
    x, y = np.meshgrid(np.arange(60), np.arange(40), indexing="ij")
    heights = 0.05 * np.sin(0.3 * x) + 0.02 * np.sin(0.21 * y)
    topography = library.Topography(heights, (60.0, 40.0), unit="um")
    topography.to_netcdf(str(tmp_path / "z.nc"))
    out = "\n".join(surface("z.nc", "--body", 1, "--mirror", "x"))
    assert_close(stored(tmp_path / "z.h5"), heights.T[:, ::-1] * 1e-6, 1e-12)
    assert float(re.search(r"Sdq (\S+);", out).group(1)) == pytest.approx(topography.rms_gradient(), rel=0.02)


@pytest.mark.parametrize("content", [b"\x07nothing of any instrument", b"\x89PNG\r\n\x1a\n" + bytes(99)])
def test_files_of_no_instrument(surface, tmp_path, content):
    pytest.importorskip("SurfaceTopography", reason="SurfaceTopography is not installed")
    (tmp_path / "z.sur").write_bytes(content)
    assert "z.sur: " in surface("z.sur", "--body", 2, *KNOWS, check=3)[0]


def test_without_the_library_its_name_is_said(surface, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "SurfaceTopography", None)
    monkeypatch.setitem(sys.modules, "SurfaceTopography.IO", None)
    write_sdf(tmp_path / "z.sdf")
    (said,) = surface("z.sdf", "--body", 2, check=3)
    assert "SurfaceTopography" in said and f"{sys.executable} -m pip install SurfaceTopography" in said


# ---------------------------------------------------------------- what is written and said


@pytest.mark.parametrize("words, change", [
    ([], lambda z: z), (["--first-row", "bottom"], lambda z: z), (["--first-row", "top"], lambda z: z[::-1]),
    (["--mirror", "x"], lambda z: z[:, ::-1]), (["--mirror", "y"], lambda z: z[::-1]),
    (["--first-row", "top", "--mirror", "y"], lambda z: z), (["--transpose"], lambda z: z.T),
    (["--transpose", "--first-row", "top", "--mirror", "x"], lambda z: z.T[::-1, ::-1]),
    (["--depths"], lambda z: -z),
], ids=lambda value: "" if callable(value) else str(value))  # fmt: skip
def test_rows_and_columns_lie_where_the_options_say(surface, tmp_path, words, change):
    np.save(tmp_path / "z.npy", TABLE)
    out = surface("z.npy", "--body", 2, "--units", "nm", "--pixel", "2um,1um", *words)
    assert_close(stored(tmp_path / "z.h5"), change(TABLE) * 1e-9, 1e-15)
    assert np.allclose(np.diff(stored(tmp_path / "z.h5", "x")), 2e-6)
    assert any("first row at the " + ("largest" if "top" in words else "smallest") + " y" in line for line in out)


def test_a_window_keeps_its_place_and_a_center_moves_it(surface, tmp_path):
    np.save(tmp_path / "z.npy", np.arange(80.0).reshape(8, 10))
    words = ["z.npy", "--body", 2, "--units", "nm", "--pixel", "1um", "--window", "-3.1um,2um,0um,9um"]
    out = surface(*words)
    assert np.array_equal(stored(tmp_path / "z.h5"), np.arange(80.0).reshape(8, 10)[4:, 2:7] * 1e-9)
    assert np.allclose(stored(tmp_path / "z.h5", "x"), np.arange(-2.5e-6, 2e-6, 1e-6), rtol=0, atol=1e-18)
    assert "-grid_n 5,4 -grid_size 5e-06,4e-06 -grid_center -5e-07,2e-06" in out[-1]
    out = surface(*words, "--center", "-1e-6,0")
    assert np.allclose(stored(tmp_path / "z.h5", "x"), np.arange(-3e-6, 1.5e-6, 1e-6), rtol=0, atol=1e-18)
    assert "-grid_center -1e-06,0" in out[-1]
    assert "--window" in surface(*words[:-1], "1mm,2mm,0mm,1mm", check=3)[0]


def test_numbers_of_the_surface_are_printed(surface, tmp_path):
    x = np.arange(400) / 400
    np.save(tmp_path / "z.npy", np.tile(2.0 * np.sin(8 * np.pi * x), (10, 1)))
    out = "\n".join(surface("z.npy", "--body", 2, "--units", "um", "--size", "1mm,25um"))
    assert "  no error of the grid is known for these numbers, which are of the map's own points\n" in out
    assert "Sq 1.414 um, peak to valley 4 um, from -2 um to 2 um" in out
    assert float(re.search(r"Sdq (\S+);", out).group(1)) == pytest.approx(2e-6 * 8e3 * np.pi / np.sqrt(2), rel=5e-3)
    assert "400 x 10 of 2.5 um x 2.5 um" in out and "1 mm x 25 um" in out


@pytest.mark.parametrize("shape", [(40, 50), (12, 300), (300, 12)], ids=str)
def test_a_picture_is_drawn(surface, tmp_path, shape):
    np.save(tmp_path / "z.npy", np.random.default_rng(4).standard_normal(shape))
    surface("z.npy", "--body", 2, "--units", "um", "--pixel", "1um", "--picture", "p.png")
    width, height = pixels(tmp_path / "p.png")
    assert 700 < width < 2500 and 500 < height < 2500


def test_a_constant_map_is_a_flat_surface(surface, tmp_path):
    np.save(tmp_path / "z.npy", np.full((5, 6), 3.0))
    for level in levels.KINDS:
        surface("z.npy", "--body", 2, *KNOWS, "--level", level, "--no-picture")
        assert np.ptp(stored(tmp_path / "z.h5")) < 1e-18


def test_files_of_others_and_inputs_are_not_replaced(surface, tmp_path):
    np.save(tmp_path / "z.npy", TABLE)
    for content in (b"the only copy of a long text", None):
        if content:
            (tmp_path / "z.h5").write_bytes(content)
        else:
            write_hdf5(tmp_path / "z.h5", TABLE, {})
        before = (tmp_path / "z.h5").read_bytes()
        assert "z.h5: exists and was not written" in surface("z.npy", "--body", 2, *KNOWS, check=3)[0]
        assert (tmp_path / "z.h5").read_bytes() == before
    surface("z.npy", "--body", 2, *KNOWS, "-o", "a.h5")
    surface("z.npy", "--body", 1, *KNOWS, "-o", "a.h5")  # its own
    assert "a.h5: is an input file" in surface("a.h5", check=3)[0]
    assert "cannot be written" in surface("z.npy", "--body", 2, *KNOWS, "-o", "nowhere/a.h5", check=3)[0]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.h5", "a.png", "z.h5", "z.npy"]


@pytest.mark.parametrize("words, says", [
    ([], "FILE"), (["a.npy", "b.npy", "c.npy"], "3 files"), (["a.npy", "--body", "3"], "--body"),
    (["a.npy", "--body", "1,2"], "--body"), (["a.npy", "b.npy", "--body", "2"], "1,2 for two files"),
    (["a.npy", "--units", "inches of rain"], "--units"),
    (["a.npy", "--size", "2,6mm"], "2,6mm"), (["a.npy", "--size", "2,6e-3"], "decimals have a point"),
    (["a.npy", "--size", "0"], "--size"), (["a.npy", "--size", "1e-3", "--pixel", "1e-6"], "--pixel"),
    (["a.npy", "--window", "1,2,3"], "X0,X1,Y0,Y1"), (["a.npy", "--window", "2,1,3,4"], "X0 < X1"),
    (["a.npy", "--grid-n", "1"], "--grid-n"), (["a.npy", "--grid-n", "4.5"], "--grid-n"),
    (["a.npy", "--level", "flat"], "--level"), (["a.npy", "--body", "1", "--separation"], "--separation"),
    (["a.npy", "--separation", "--depths"], "--depths"), (["a.npy", "--picture", "a.jpg"], "a.jpg"),
    (["a.npy", "--skip-rows", "-1"], "--skip-rows"),
], ids=str)  # fmt: skip
def test_bad_usage_is_one_line_and_code_2(surface, words, says):
    (said,) = surface(*words, check=2)
    assert says in said


# ---------------------------------------------------------------- signs, and the whole chain

N = 64
CASE = dict(ball(N), gap_type="file", gap_radius1=None, gap_radius2=None)
WIDTH = CASE["grid_size"]


def sag(n=N, width=WIDTH):
    """A ball's distance from its tangent plane."""
    x = ((np.arange(n) + 0.5) / n - 0.5) * width
    return np.add.outer(x * x, x * x) / 2 / ball(N)["gap_radius1"]


def test_a_ball_as_heights_of_either_body_and_as_separation_is_one_contact(surface, solve, tmp_path):
    """To the last digits: a peak of either body reduces the separation."""
    runs = []
    for k, (sign, quantity) in enumerate([(1, ["--separation"]), (-1, ["--body", 1]), (-1, ["--body", 2])]):
        np.save(tmp_path / f"{k}.npy", sign * sag())
        surface(f"{k}.npy", *quantity, "--units", "m", "--size", repr(float(WIDTH)))
        gap = dict(gap_file=tmp_path / f"{k}.h5", gap_dataset=None if k else "/separation")
        runs.append(solve(dict(CASE, **gap), ranks=1 + k % 2))
    contact = hertz(ball(N))
    for run in runs:
        assert np.array_equal(run.pressure, runs[0].pressure) and run["disp_z"] == runs[0]["disp_z"]
        assert run["disp_z"] == pytest.approx(contact.approach, rel=2e-4)
        assert run.pressure.max() == pytest.approx(contact.pressure, rel=5e-3)
    assert_same(runs[0], solve(ball(N)), 1e-7)


def test_depths_are_heights_turned(surface, solve, tmp_path):
    np.save(tmp_path / "d.npy", sag() * 1e9)
    surface("d.npy", "--body", 2, "--depths", "--units", "nm", "--size", repr(float(WIDTH)))
    assert_same(solve(dict(CASE, gap_file=tmp_path / "d.h5")), solve(ball(N)), 1e-6)


@pytest.mark.parametrize("suffix", ["csv", "npy"])
def test_the_printed_options_run(surface, petsam, tmp_path, suffix):
    """From a file in um with a tilt, on finer cells than petsam's, to Hertz's contact."""
    x = ((np.arange(3 * N) + 0.5) / (3 * N) - 0.5) * WIDTH
    heights = 1e6 * (-sag(3 * N) + 0.01 * x)
    if suffix == "csv":
        np.savetxt(tmp_path / "h.csv", heights, delimiter=",")
    else:
        np.save(tmp_path / "h.npy", heights)
    out = surface(
        f"h.{suffix}", "--body", 2, "--units", "um", "--size", repr(float(WIDTH)), "--level", "tilt", "--grid-n", N
    )
    at = out.index("options for petsam:")
    gap, rough = out[at + 1].split(), out[at + 3].split()
    material = dict(CASE, gap_type=None, grid_n=None, grid_size=None)
    approach = [
        float(re.search(r"disp_z +(\S+)", petsam(material, *words).stdout).group(1))
        for words in (gap, ["-gap_type", "flat", *rough])
    ]
    # the mean of the heights is 0 now: the ball's mean distance is part of the approach
    lift = sag(3 * N).mean()
    assert approach[0] == approach[1] == pytest.approx(hertz(ball(N)).approach - lift, rel=2e-3)


def test_another_grid_size_is_refused_by_petsam(surface, petsam, tmp_path):
    np.save(tmp_path / "h.npy", -sag())
    surface("h.npy", "--body", 2, "--units", "m", "--size", repr(float(WIDTH)))
    for ranks in (1, 2):
        done = petsam(dict(CASE, gap_file="h.h5", grid_size=2 * WIDTH), ranks=ranks, check=3)
        assert (
            "-gap_file h.h5: /height" in done.complaint[0]
            and f"-grid_size {WIDTH:.10g},{WIDTH:.10g}" in done.complaint[0]
        )


def test_two_surfaces_make_the_separation_that_petsam_adds(surface, solve, tmp_path):
    """The ball is body 1, a wave body 2; once combined here, once by petsam of two files."""
    x = ((np.arange(2 * N) + 0.5) / (2 * N) - 0.5) * WIDTH
    np.save(tmp_path / "ball.npy", -sag() * 1e3)
    np.save(tmp_path / "wave.npy", np.tile(3e-8 * np.cos(2e4 * x), (2 * N, 1)) * 1e3)
    size = ["--units", "mm", "--size", repr(float(WIDTH))]
    surface("ball.npy", "--body", 1, *size)
    surface("wave.npy", "--body", 2, *size, "--grid-n", N)
    assert "--grid-n" in surface("ball.npy", "wave.npy", "--body", "1,2", *size, "-o", "pair.h5", check=3)[0]
    surface("ball.npy", "wave.npy", "--body", "1,2", *size, "-o", "pair.h5", "--grid-n", N)
    surface("ball.h5", "wave.h5", "-o", "again.h5")
    (said,) = surface("ball.npy", "ball.npy", "--body", "1,1", *size, "-o", "no.h5", check=3)
    assert "both are heights of body 1: give --body 1,2, or convert one of them again, by --body 2" in said
    assert "both are heights of body 2" in surface("wave.h5", "wave.h5", "-o", "no.h5", check=3)[0]
    pair = stored(tmp_path / "pair.h5", "separation")
    assert np.array_equal(pair, stored(tmp_path / "again.h5", "separation"))
    assert np.array_equal(pair, -stored(tmp_path / "ball.h5") - stored(tmp_path / "wave.h5"))
    one = solve(dict(CASE, gap_file=tmp_path / "pair.h5", gap_dataset="/separation"))
    two = solve(dict(CASE, gap_file=tmp_path / "ball.h5", gap_rough_file=tmp_path / "wave.h5"))
    assert_same(one, two, 1e-6)
    # the crest in the middle carries more than the ball alone
    assert one.pressure[N // 2, N // 2] > 1.02 * solve(ball(N)).pressure[N // 2, N // 2]
