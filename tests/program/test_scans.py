"""petsam-surface on files as instruments write them: headers, lists of points, positions, rows at offsets."""

import h5py
import numpy as np
import pytest
import scipy.io

import test_surface
from support import assert_close
from test_surface import stored

surface = test_surface.surface  # the fixture

H = np.random.default_rng(1).normal(size=(16, 12))
UM = ["--body", 2, "--units", "um"]
KNOWS = [*UM, "--size", "1.2mm,1.6mm"]
SELF = ["--format", "surfacetopography"]


def text(path, values, header="", separator="\t", encoding="utf-8"):
    lines = [separator.join(f"{value:.6g}" for value in row) for row in values]
    path.write_bytes((header + "\n".join(lines) + "\n").encode(encoding))


# ---------------------------------------------------------------- headers

IMAGE = "# Channel: Z\n# Width: 120 \u00b5m\n# Height: 160 \u00b5m\n# Value units: m\n"
HEADERS = [
    IMAGE, IMAGE.replace("\u00b5", "u"), IMAGE.replace("# ", ""), IMAGE.replace("Width", "Breite"),
    IMAGE.replace("120 \u00b5m", "0.12 mm").replace(": ", " = "),
    "# x-length = 120 um\n# y-length = 160 um\n# z-unit = m\n", "Pixel size: 10 um\nUnits: m\n",
    "# Xscale: 1e-2 mm\n# Yscale: 1e-2 mm\n# zunit: m\n", "# scan size: 120 x 160 um\n# Value unit; m\n",
    "# lateral units: um\n# dx = 10\n# dy = 10\n# data unit = m\n",
]  # fmt: skip


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1", "utf-16"])
@pytest.mark.parametrize("header", HEADERS)
def test_a_header_is_read(surface, tmp_path, header, encoding):
    text(tmp_path / "z.txt", H * 1e-6, header, encoding=encoding)
    skip = [] if header.startswith("#") else ["--skip-rows", len(header.splitlines())]
    surface("z.txt", "--body", 2, *skip, "--no-picture")
    image = "eight: 160" in header or "eight = 160" in header
    assert_close(stored(tmp_path / "z.h5"), (H[::-1] if image else H) * 1e-6, 1e-5)
    assert_close(np.diff(stored(tmp_path / "z.h5", "x")), 1e-5, 1e-12)
    assert_close(np.diff(stored(tmp_path / "z.h5", "y")), 1e-5, 1e-12)


@pytest.mark.parametrize("header", HEADERS)
@pytest.mark.parametrize("more, says", [
    (["--units", "um"], "--units"), (["--size", "1mm"], "--size"), (["--pixel", "10um,11um"], "--size or --pixel"),
], ids=str)  # fmt: skip
def test_an_option_never_overrules_a_header(surface, tmp_path, header, more, says):
    text(tmp_path / "z.txt", H * 1e-6, header)
    skip = ["--skip-rows", 0 if header.startswith("#") else len(header.splitlines())]
    (said,) = surface("z.txt", "--body", 2, *skip, *more, check=3)
    assert "z.txt: line " in said and says in said, said


@pytest.mark.parametrize("header, more, says", [
    (IMAGE, ["--first-row", "bottom"], "--first-row"),
    ("# Width: 80 um\n", KNOWS, "line 1: is 80 um along x"),
    ("# Value units: V\n", KNOWS, "line 1: # Value units: V: its values are in V"),
    ("# Zscale = 1e-9\n", KNOWS, "line 1: # Zscale = 1e-9: is a factor"), ("z [nm]\n", KNOWS, "nm, which contradicts"),
    ("# origin: upper left\n", [*KNOWS, "--first-row", "bottom"], "--first-row"),
    ("# Width: 100 um\n# Height: 100 um\n# Pixel size: 1 um\n", UM, "do not fit its 12 points"),
    ("# Value units: m\n# z-unit: nm\n", KNOWS, "line 2"),
    ("# Width: 1.2 mm\n# Height: 1.6 mm\n", [*KNOWS, "--transpose"], "which direction is x"),
], ids=str)  # fmt: skip
def test_contradictions_of_a_header_are_refused(surface, tmp_path, header, more, says):
    text(tmp_path / "z.txt", H * 1e-6, header)
    (said,) = surface("z.txt", *([] if "--body" in more else ["--body", 2]), *more, check=3)
    assert "z.txt: " in said and says in said, said


@pytest.mark.parametrize(
    "line", ["# probe moved 80 um", "# size 80", "# image of 80 um by 60 um", "# scan rate 3 Hz, range 2"]
)
def test_lines_about_lengths_that_are_not_understood_are_told(surface, tmp_path, line):
    text(tmp_path / "z.txt", H, line + "\n")
    surface("z.txt", *KNOWS, "--no-picture", warnings=True)


def test_other_lines_are_no_matter(surface, tmp_path):
    text(
        tmp_path / "z.txt",
        H,
        "# made on 2024-05-03 at 12:30\n# operator: M. Lange\n# z [um]\n# rows 16\n# x-pixels: 12\n",
    )
    surface("z.txt", *KNOWS, "--no-picture")


def test_the_library_takes_the_first_row_from_the_header(surface, tmp_path):
    pytest.importorskip("SurfaceTopography", reason="SurfaceTopography is not installed")
    for header, top in ((IMAGE, True), ("# x-length = 120 um\n# y-length = 160 um\n# z-unit = m\n", False)):
        text(tmp_path / "z.txt", H * 1e-6, header)
        surface("z.txt", "--body", 2, *SELF, "--no-picture")
        assert_close(stored(tmp_path / "z.h5"), (H[::-1] if top else H) * 1e-6, 1e-5)


# ---------------------------------------------------------------- lists of points, profiles

X, Y = (axis.ravel() for axis in np.meshgrid(np.arange(12.0), np.arange(16.0)))
POINTS = np.c_[X, Y, H.ravel()]
LISTS = {
    "scattered": np.random.default_rng(2).normal(size=(192, 3)), "profile": np.c_[X, np.sin(X)],
    "falling": np.c_[-X, X],
    "few of many": POINTS[::5], "two points": POINTS[:2, 1:], "doubled": np.r_[POINTS, POINTS[:1]],
    "with colours": np.random.default_rng(4).normal(size=(192, 6)),
    "uneven": np.c_[X**1.1, Y, H.ravel()], "uneven profile": np.c_[np.arange(12.0) ** 2, H[0]],
}  # fmt: skip
GRIDS = {
    "xyz": POINTS, "one missing": np.delete(POINTS, 77, 0), "xyzi": np.c_[POINTS, 255 + 0 * X],
    "xyzrgb": np.c_[POINTS, X, Y, X], "five": np.c_[POINTS, X, Y],
    "shuffled": np.random.default_rng(3).permutation(POINTS),
    "rounded": np.round(np.c_[X + 0.04, Y - 0.03, H.ravel()], 4),
}  # fmt: skip


@pytest.mark.parametrize("name", LISTS)
def test_a_list_of_points_is_no_map(surface, tmp_path, name):
    text(tmp_path / "z.csv", LISTS[name], separator=",")
    (said,) = surface("z.csv", *KNOWS, check=3)
    assert "z.csv: line 1: " in said and "a map has one line per y" in said, said


def save(path, values):
    """An array in a file of the format that its name has."""
    if path.suffix == ".mat":
        pytest.importorskip("SurfaceTopography", reason="SurfaceTopography is not installed")
        scipy.io.savemat(path, {"scan": values})
    elif path.suffix == ".h5":
        with h5py.File(path, "w") as file:
            file["scan"] = values
    else:
        (np.save if path.suffix == ".npy" else np.savez)(path, values)


ARRAYS = ["z.npy", "z.npz", "z.mat", "z.h5"]


@pytest.mark.parametrize("file", ARRAYS)
@pytest.mark.parametrize("name", LISTS)
def test_an_array_of_points_is_no_map(surface, tmp_path, name, file):
    rows, columns = LISTS[name].shape
    for values in ((LISTS[name], LISTS[name].T) if columns <= 3 else (LISTS[name],)) if rows > 9 else ():
        save(tmp_path / file, values)
        assert "a map has one line" in surface(file, *KNOWS, "-o", "o.h5", check=3)[0]


@pytest.mark.parametrize("file", ARRAYS)
@pytest.mark.parametrize("name", [*GRIDS, "profile"])
def test_an_array_of_points_on_a_grid_is_a_map(surface, tmp_path, name, file):
    """As a text of them is; along the columns, too."""
    points = GRIDS.get(name, np.c_[0.5 * np.arange(192), H.ravel()])
    size = "96um" if name == "profile" else "12um,16um"
    for values in (points, points.T):
        save(tmp_path / file, values)
        surface(file, *UM, "--size", size, "--fill", "nearest", "--no-picture", "-o", "o.h5")
        found = stored(tmp_path / "o.h5").reshape(H.shape)
        if name == "one missing":
            found.flat[77] = H.flat[77] * 1e-6
        assert_close(found, H * 1e-6, 1e-4)
        assert f"--size {size}" in surface(file, *UM, "-o", "o.h5", check=3)[0]


@pytest.mark.parametrize("step, form, count", [
    (0.15625, "{:.1f}", 2000), (0.15625, "{:.1f}", 12), (1 / 3, "{:.1f}", 300), (0.0625, "{:.1f}", 300),
    (0.00125, "{:.3f}", 5000), (0.15625, "{:.4g}", 2000), (2.5, "{:.0f}", 40), (-0.15625, "{:.1f}", 500),
], ids=str)  # fmt: skip
def test_rounded_positions_are_even(surface, tmp_path, step, form, count):
    """Within half a unit of the last digit, which is up to twice the step."""
    heights = np.cos(np.arange(count) / 9)
    lines = [f"{form.format(7.0 + k * step)},{z:.6f}" for k, z in enumerate(heights)]
    (tmp_path / "z.csv").write_text("x [um],z [um]\n" + "\n".join(lines))
    out = surface("z.csv", "--body", 2, "--no-picture")
    assert any("few digits: taken for even, with a step of" in line for line in out)
    assert_close(stored(tmp_path / "z.h5")[0], heights[:: -1 if step < 0 else 1] * 1e-6, 1e-5)
    assert np.diff(stored(tmp_path / "z.h5", "x")) == pytest.approx(abs(step) * 1e-6, rel=2 / count**1.5)


def test_rounded_points_are_a_grid(surface, tmp_path):
    points = np.c_[np.round(POINTS[:, :2] * 0.15625, 1), 0.1 * POINTS[:, 2]]
    text(tmp_path / "z.csv", points, "x [um],y [um],z [um]\n", ",")
    surface("z.csv", "--body", 2, "--no-picture")
    assert_close(stored(tmp_path / "z.h5"), H * 1e-7, 1e-4)
    for d in "xy":
        assert np.diff(stored(tmp_path / "z.h5", d)) == pytest.approx(0.15625e-6, rel=0.02)


@pytest.mark.parametrize("x", [
    np.delete(np.arange(30.0), 11), np.delete(np.arange(30.0), [9, 14]), np.r_[0:20, 21:40:2],
    np.repeat(np.arange(9.0), 2), np.round(np.arange(40) ** 1.1, 1), np.r_[0:20, 21:41] * 0.1,
], ids=["one absent", "two absent", "two steps", "twice", "growing", "a jump"])  # fmt: skip
def test_uneven_positions_are_not_taken_for_rounded(surface, tmp_path, x):
    text(tmp_path / "z.csv", np.c_[x, np.sin(np.arange(x.size))], "x [um],z [um]\n", ",")
    assert "a profile is read where x rises in even steps" in surface("z.csv", "--body", 2, check=3)[0]


@pytest.mark.parametrize("name", GRIDS)
def test_points_on_a_grid_are_a_map(surface, tmp_path, name):
    """In any order, absent ones missing, further columns left out; the size needs the unit of x and y."""
    text(tmp_path / "z.csv", GRIDS[name], separator=";")
    out = surface("z.csv", *UM, "--size", "12um,16um", "--fill", "nearest", "--no-picture")
    found = stored(tmp_path / "z.h5")
    assert found.shape == H.shape
    if name == "one missing":
        assert any("1 point absent" in line for line in out)
        found.flat[77] = H.flat[77] * 1e-6
        assert "1 point is missing, of 192" in surface("z.csv", *UM, "--size", "12um,16um", check=3)[0]
    assert_close(found, H * 1e-6, 1e-4)
    assert GRIDS[name].shape[1] == 3 or any("column" in line and "left out" in line for line in out)
    assert "--size 12um,16um" in surface("z.csv", *KNOWS, check=3)[0]
    assert "--size 12um,16um" in surface("z.csv", *UM, check=3)[0]


@pytest.mark.parametrize("units, factor, says", [
    ("m", 1e-6, "1.2e-05m,1.6e-05m"), ("mm", 1e-3, "0.012mm,0.016mm"), ("nm", 1.0, "12um,16um"),
    ("m", 1.0, "12um,16um"),
])  # fmt: skip
def test_the_size_that_is_proposed_for_points_is_one_that_instruments_measure(surface, tmp_path, units, factor, says):
    """In the unit of the heights if it may be: what is proposed can be given, and agrees with the points."""
    text(tmp_path / "z.csv", POINTS * [factor, factor, 1e-6], separator=";")
    words = ["z.csv", "--body", 2, "--units", units, "--no-picture"]
    for more in ([], ["--size", "7.3mm"]):
        assert f"--size {says}" in surface(*words, *more, check=3)[0]
    surface(*words, "--size", says)


@pytest.mark.parametrize("name", ["scattered", "doubled", "profile"])
def test_the_library_makes_no_map_of_a_list_either(surface, tmp_path, name):
    pytest.importorskip("SurfaceTopography", reason="SurfaceTopography is not installed")
    text(tmp_path / "z.txt", LISTS[name])
    assert "z.txt: " in surface("z.txt", *KNOWS, *SELF, check=3)[0]


@pytest.mark.parametrize("order", ["rows", "shuffled", "falling"])
def test_points_on_a_full_grid_are_read_by_the_library(surface, tmp_path, order):
    pytest.importorskip("SurfaceTopography", reason="SurfaceTopography is not installed")
    points = {"rows": POINTS, "shuffled": np.random.default_rng(3).permutation(POINTS), "falling": POINTS[::-1]}[order]
    text(tmp_path / "z.txt", points)
    surface("z.txt", *UM, *SELF, "--size", "12um,16um", "--no-picture")
    assert_close(stored(tmp_path / "z.h5"), H * 1e-6, 1e-5)
    assert "x, y, z span 12 x 16" in surface("z.txt", *UM, *SELF, "--size", "1mm", check=3)[0]


# ---------------------------------------------------------------- positions beside the heights


def beside(rows, columns, values=H):
    """The heights with a row and a column of positions before them."""
    values = np.vstack([columns, values]) if columns is not None else values
    if rows is None:
        return values
    return np.column_stack([rows if columns is None else [np.nan, *rows], values])


@pytest.mark.parametrize("values", [
    beside(None, np.arange(12)), beside(np.arange(16), None), beside(0.25 * np.arange(16), 0.25 * np.arange(12)),
    beside(None, 3.0 - np.arange(12)), beside(None, np.round(np.arange(12) / 3, 2)), beside(None, np.arange(12))[::-1],
    beside(np.arange(16), np.arange(12), np.add.outer(np.arange(16), np.arange(12)) * 1e-3),
    beside(1.2 ** np.arange(16) * 9, None), beside(None, np.cumsum(np.random.default_rng(4).uniform(1, 3, 12)) - 40),
], ids=["row", "column", "both", "falling", "rounded", "last", "of a plane", "growing", "uneven"])  # fmt: skip
def test_positions_are_no_heights(surface, tmp_path, values):
    text(tmp_path / "z.csv", values, separator=",")
    np.save(tmp_path / "z.npy", values)
    for name in ("z.csv", "z.npy"):
        for fill in ([], ["--fill", "smooth"]):
            (said,) = surface(name, *KNOWS, *fill, check=3)
            assert "positions, not heights" in said and "--fill smooth or" not in said


@pytest.mark.parametrize("values", [
    np.add.outer(0.2 * np.arange(16), 0.1 * np.arange(12)), np.outer(np.arange(16.0), np.arange(12.0)),
    np.add.outer(np.arange(16.0) ** 2, np.arange(12.0) ** 2), np.zeros((16, 12)), H + 5 * np.arange(12),
], ids=["plane", "twist", "parabola", "flat", "tilted"])  # fmt: skip
def test_a_form_is_not_taken_for_positions(surface, tmp_path, values):
    np.save(tmp_path / "z.npy", values)
    surface("z.npy", *KNOWS, "--no-picture")


# ---------------------------------------------------------------- spoilt maps


def smooth(n=64, seed=1):
    """A periodic surface of waves."""
    i = np.arange(n) * 2 * np.pi / n
    waves = np.random.default_rng(seed).normal(size=(8, 4))
    return sum(a * np.cos(k * i[:, None] + b) * np.cos((9 - k) * i + c) for k, (a, b, c, _) in enumerate(waves, 1))


@pytest.mark.parametrize("kind", ["rows", "columns"])
def test_offsets_of_rows_are_told_and_removed(surface, tmp_path, kind):
    offsets = np.random.default_rng(5).normal(size=(64, 1))
    np.save(tmp_path / "z.npy", smooth() + (offsets if kind == "rows" else offsets.T))
    know = [*UM, "--size", "1mm", "--no-picture"]
    surface("z.npy", *know, warnings=True)
    surface("z.npy", *know, "--level", kind)
    left = stored(tmp_path / "z.h5") * 1e6 - smooth()
    assert np.std(left - left.mean()) < 0.2 * np.std(smooth()) + 1e-9 or np.std(left) < 0.5
    np.save(tmp_path / "z.npy", smooth())
    surface("z.npy", *know)


@pytest.mark.parametrize("value, count", [(-99.0, 3), (0.0, 200), (40.0, 80)])
def test_a_value_of_many_points_apart_from_all_others_is_told(surface, tmp_path, value, count):
    values = smooth() + 20.0
    values.flat[np.random.default_rng(6).choice(values.size, count, replace=False)] = value
    np.save(tmp_path / "z.npy", values)
    know = [*UM, "--size", "1mm", "--no-picture"]
    surface("z.npy", *know, warnings=True)
    assert f"{count} points of 4096 all lie at {value:g}" in surface.complaint
    surface("z.npy", *know, "--missing", value, "--fill", "nearest")


@pytest.mark.parametrize("values, cure", [(H.T, "--transpose"), (H[:-1], "add the row"), (H[:, 1:], "add the column")])
def test_cells_that_would_be_square_are_told(surface, tmp_path, values, cure):
    np.save(tmp_path / "z.npy", values)
    surface("z.npy", *KNOWS, "--no-picture", warnings=True)
    assert cure in surface.complaint
    surface("z.npy", *UM, "--pixel", "0.1mm,0.12mm", "--no-picture")


def test_an_empty_line_between_rows_is_told(surface, tmp_path):
    rows = [" ".join(f"{value:.4f}" for value in row) for row in H]
    (tmp_path / "z.txt").write_text("\n".join([*rows[:8], "", *rows[8:]]) + "\n\n")
    surface("z.txt", *KNOWS, "--no-picture", warnings=True)
    assert "line 9 is empty: if it ends a map" in surface.complaint
    (tmp_path / "z.txt").write_text("\n\n".join(rows))
    surface("z.txt", *KNOWS, "--no-picture")


def test_an_outlier_is_told(surface, tmp_path):
    values = smooth()
    values[20, 30] = 50.0
    np.save(tmp_path / "z.npy", values)
    know = [*UM, "--size", "1mm", "--no-picture"]
    surface("z.npy", *know, warnings=True)
    surface("z.npy", *know, "--missing", 50, "--fill", "nearest")
    assert np.max(stored(tmp_path / "z.h5")) < 1e-5
