"""petsam.surface.read on files of many instruments and programs: read right, or refused with the cure; options against
statements of the file; offsets of rows, outliers; profiles for plane strain."""

import re

import h5py
import numpy as np
import pytest
import scipy.io

import petsam
from petsam.apps.surface import levels, spikes
from support import ROOT, assert_close
from test_scans import smooth
from test_surface import stored, surface  # noqa: F401 - a fixture

NY, NX = 9, 12
H = np.round(np.random.default_rng(11).normal(size=(NY, NX)), 4)
UM = dict(units="um", body=2)
SIZED = dict(UM, size="120um,90um")


def rows(values, separator="\t", form="{:.10g}", point="."):
    return "\n".join(separator.join(form.format(v).replace(".", point) for v in row) for row in values) + "\n"


def xyz(values=H, step=10.0, order=None, more=(), separator=" "):
    x, y = np.meshgrid(np.arange(values.shape[1]) * step, np.arange(values.shape[0]) * step)
    points = np.column_stack([x.ravel(), y.ravel(), values.ravel(), *more])
    return rows(points if order is None else points[order], separator)


GWYDDION = {
    "english": "# Channel: Z\n# Width: 120 \u00b5m\n# Height: 90 \u00b5m\n# Value units: um\n",
    "german": "# Kanal: Z\n# Breite: 120 \u00b5m\n# H\u00f6he: 90 \u00b5m\n# Werteinheiten: um\n",
    "french": "# Canal : Z\n# Largeur : 120 \u00b5m\n# Hauteur : 90 \u00b5m\n# Unit\u00e9s de valeur : um\n",
    "czech": "# Kan\u00e1l: Z\n# \u0160\u00ed\u0159ka: 0,12 mm\n# V\u00fd\u0161ka: 90 \u00b5m\n# Jednotky hodnot: um\n",
    "russian": "# \u041a\u0430\u043d\u0430\u043b: Z\n# \u0428\u0438\u0440\u0438\u043d\u0430: 120 um\n"
    "# \u0412\u044b\u0441\u043e\u0442\u0430: 90 um\n# \u0415\u0434\u0438\u043d\u0438\u0446\u044b: \u00b5m\n",
    "japanese": "# \u5e45: 120 \u00b5m\n# \u9ad8\u3055: 90 \u00b5m\n# \u5024\u306e\u5358\u4f4d: um\n",
}
SPIP = (
    "# File Format = ASCII\n# x-pixels = 12\n# y-pixels = 9\n# x-length = 120000\n# y-length = 90000\n# z-unit = um\n"
)
ESRI = "ncols 12\nnrows 9\nxllcorner 0\nyllcorner 0\ncellsize 10\nNODATA_value -9999\n"
SURFER = "DSAA\n12 9\n0 110\n0 80\n-3 3\n"
QUOTED = "\n".join(",".join(f'"{v}"' for v in row) for row in H)
QUOTED_COMMA = "\n".join(",".join(f'"{v}"'.replace(".", ",") for v in row) for row in H)
SHUFFLED = np.random.default_rng(5).permutation(H.size)
HOLE = np.where(np.arange(H.size).reshape(H.shape) == 40, np.nan, H)


def hole(word, separator=","):
    return rows(HOLE, separator).replace("nan", word)


# name of the file, content, encoding, what is given, rows of the map as in H ("top": turned)
READ = {
    **{
        f"gwyddion {name}": ("z.txt", head + rows(H), "utf-8", dict(body=2), "top") for name, head in GWYDDION.items()
    },
    "gwyddion utf-16": ("z.txt", GWYDDION["german"] + rows(H), "utf-16", dict(body=2), "top"),
    "gwyddion latin-1": ("z.txt", GWYDDION["german"] + rows(H), "latin-1", dict(body=2), "top"),
    "gwyddion comma": ("z.txt", GWYDDION["german"] + rows(H, point=","), "utf-8", dict(body=2), "top"),
    "gwyddion .asc": ("z.asc", GWYDDION["french"] + rows(H), "utf-8", dict(body=2), "top"),
    "commas": ("z.csv", rows(H, ","), "utf-8", SIZED, ""),
    "semicolons": ("z.csv", rows(H, ";"), "utf-8", SIZED, ""),
    "semicolons and commas": ("z.csv", rows(H, ";", point=","), "utf-8", SIZED, ""),
    "semicolons, utf-16": ("z.csv", rows(H, ";", point=","), "utf-16", SIZED, ""),
    "tabs": ("z.txt", rows(H), "utf-8", SIZED, ""),
    "blanks": ("z.txt", rows(H, "  "), "utf-8", SIZED, ""),
    "windows": ("z.txt", rows(H).replace("\n", "\r\n"), "utf-8-sig", SIZED, ""),
    "tsv": ("z.tsv", rows(H), "utf-8", SIZED, ""),
    "dat": ("z.dat", rows(H, " "), "utf-8", SIZED, ""),
    "exponents": ("z.txt", rows(H * 1e-6, form="{:.8E}"), "utf-8", dict(units="m", body=2, size="120um,90um"), ""),
    "quoted": ("z.csv", QUOTED, "utf-8", SIZED, ""),
    "quoted commas": ("z.csv", QUOTED_COMMA, "utf-8", SIZED, ""),
    "spip": ("z.asc", SPIP + "# Start of Data:\n" + rows(H), "latin-1", dict(body=2), ""),
    "spip txt": ("z.txt", SPIP + rows(H), "utf-8", dict(body=2), ""),
    "esri": ("z.asc", ESRI + rows(H, " "), "utf-8", SIZED, "top"),
    "surfer": ("z.grd", SURFER + rows(H, " "), "utf-8", SIZED, ""),
    "xyz": ("z.xyz", xyz(), "utf-8", SIZED, ""),
    "xyz shuffled": ("z.txt", xyz(order=SHUFFLED), "utf-8", SIZED, ""),
    "xyz falling": ("z.txt", xyz(order=np.arange(H.size)[::-1]), "utf-8", SIZED, ""),
    "xyz intensity": ("z.txt", xyz(more=[np.full(H.size, 255)]), "utf-8", SIZED, ""),
    "xyz heads": ("z.csv", "x [um],y [um],z [um]\n" + xyz(separator=","), "utf-8", dict(body=2), ""),
    "xyz blanks": ("z.xyz", "x [um] y [um] z [um] I\n" + xyz(more=[H.ravel()]), "utf-8", dict(body=2), ""),
    "xyz other heads": (
        "z.csv", "X(mm);Y(mm);Z / \u00b5m;I\n" + xyz(step=0.01, separator=";", more=[H.ravel()]), "utf-8",
        dict(body=2), "",
    ),
    "xyz utf-16": (
        "z.csv", "x [um];y [um];z [um]\n" + xyz(separator=";").replace(".", ","), "utf-16", dict(body=2), "",
    ),
    "xyz lateral": ("z.txt", "# lateral unit: um\n# z unit: um\n" + xyz(), "utf-8", dict(body=2), ""),
    "xyz rough step": ("z.txt", xyz(step=10 / 3), "utf-8", dict(UM, pixel=10 / 3 * 1e-6), ""),
    "hole nan": ("z.csv", hole("NaN"), "utf-8", SIZED, "hole"),
    "hole qnan": ("z.csv", hole("1.#QNAN"), "utf-8", SIZED, "hole"),
    "hole -1.#IND00": ("z.csv", hole("-1.#IND00"), "utf-8", SIZED, "hole"),
    "hole bad": ("z.csv", hole("BAD"), "utf-8", SIZED, "hole"),
    "hole stars": ("z.csv", hole("***"), "utf-8", SIZED, "hole"),
    "hole dashes": ("z.csv", hole("---"), "utf-8", SIZED, "hole"),
    "hole empty": ("z.csv", hole(""), "utf-8", SIZED, "hole"),
    "hole word": ("z.csv", hole("out"), "utf-8", dict(SIZED, missing="OUT"), "hole"),
    "hole number": ("z.csv", hole("-32768"), "utf-8", dict(SIZED, missing=-32768), "hole"),
    "hole esri": ("z.asc", ESRI + hole("-9999", " "), "utf-8", SIZED, "hole top"),
    "hole surfer": ("z.grd", SURFER + hole("1.70141e+38", " "), "utf-8", SIZED, "hole"),
    "hole xyz": ("z.txt", xyz(HOLE), "utf-8", SIZED, "hole"),
    "hole absent": ("z.txt", xyz(order=np.delete(np.arange(H.size), 40)), "utf-8", SIZED, "hole"),
    "tenths": ("z.txt", rows(H / 100), "utf-8", dict(SIZED, units="0.1mm"), ""),
    "counts": ("z.txt", rows(H / 0.16), "utf-8", dict(SIZED, units="1.6e-7m"), ""),
}  # fmt: skip


@pytest.mark.parametrize("name", READ)
def test_a_file_is_read_right(tmp_path, name):
    file, content, encoding, given, turn = READ[name]
    (tmp_path / file).write_bytes(content.encode(encoding))
    one = petsam.surface.read(tmp_path / file, **given)
    right = HOLE if "hole" in turn else H
    right = right[::-1] if "top" in turn else right
    assert one.values.shape == right.shape and np.array_equal(np.isnan(one.values), np.isnan(right))
    assert np.nanmax(np.abs(one.values * 1e6 - right)) < 1e-6
    cell = 10 / 3 * 1e-6 if name == "xyz rough step" else 1e-5
    assert_close(one.cell, [cell, cell], 1e-6)
    assert one.quantity == "height2" and one.axis(0).shape == (NX,)


def test_arrays_and_hdf5_are_read(tmp_path):
    np.save(tmp_path / "z.npy", H)
    np.save(tmp_path / "other.txt.npy", H)
    (tmp_path / "other.txt.npy").rename(tmp_path / "other.txt")
    with h5py.File(tmp_path / "z.hdf5", "w") as file:
        file["height"] = H
        file["height"].attrs.update(units="um", quantity="height2", size=[1.2e-4, 9e-5])
    for name, given in (("z.npy", SIZED), ("other.txt", SIZED), ("z.hdf5", {})):
        one = petsam.surface.read(tmp_path / name, **given)
        assert_close(one.values, H * 1e-6, 1e-12)
        assert_close(one.size, [1.2e-4, 9e-5], 1e-12)


THOUSANDS = "\n".join(";".join(f"{1 + k},{j}00" for j in range(1, 9)) for k in range(6))
REFUSED = {
    "units": ("gwyddion german", dict(units="nm"), r"line 4: states 1e-06 m.*--units, 1e-09 m"),
    "size": ("gwyddion german", dict(size="1mm"), "line 2: is 120 um along x.*--size or --pixel, 1 mm"),
    "pixel": ("gwyddion french", dict(pixel="10um,11um"), "line 3: is 90 um along y.*--size or --pixel, 99 um"),
    "first row": ("gwyddion czech", dict(first_row="bottom"), "first row top: leave out --first-row"),
    "transpose": ("gwyddion english", dict(transpose=True), "--transpose"),
    "spip size": ("spip", dict(size="120nm,90nm"), "120 um along x.*120 nm"),
    "esri size": ("esri", dict(size="1.5mm"), "span 120 x 90.*--size 120um,90um"),
    "esri missing": ("hole esri", dict(missing=-1), "-9999.*--missing -1"),
    "esri first row": ("esri", dict(first_row="bottom"), "--first-row"),
    "surfer first row": ("surfer", dict(first_row="top"), "--first-row"),
    "xyz heads": ("xyz heads", dict(units="nm"), "--units"),
    "xyz heads, size": ("xyz heads", dict(size="1mm"), "0.00012 m x 9e-05 m.*--size or --pixel, 0.001 m"),
    "xyz size": ("xyz", dict(size="1mm"), "span 120 x 90"),
    "xyz transpose": ("xyz", dict(transpose=True), "--transpose"),
    "hdf5": (None, dict(units="nm"), "--units"),
    "quantity": (None, dict(separation=True), "height2.*--body or --separation, separation"),
    "depths": (None, dict(depths=True), "--depths"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_an_option_against_a_statement_is_refused_with_both(tmp_path, name):
    of, more, says = REFUSED[name]
    if of:
        file, content, encoding, given, _ = READ[of]
        (tmp_path / file).write_bytes(content.encode(encoding))
    else:
        file, given = "z.h5", {}
        with h5py.File(tmp_path / file, "w") as out:
            out["height"] = H
            out["height"].attrs.update(units="um", quantity="height2", size=[1.2e-4, 9e-5])
    with pytest.raises(petsam.Error, match=says):
        petsam.surface.read(tmp_path / file, **{**given, **more})


@pytest.mark.parametrize("content, given, says", [
    (THOUSANDS, SIZED, "--decimal comma"), (rows(H).replace("\t", ";", 5), SIZED, "z.csv: line "),
    ("x [um];y [mm];z [um]\n" + xyz(separator=";"), UM, "line 1: its columns x and y have different units"),
    ("x [um];y [um];z [V]\n" + xyz(separator=";"), dict(body=2), "line 1: .*not in a length"),
    ("# z unit: nm\nx [um];y [um];z [um]\n" + xyz(separator=";"), dict(body=2), "different units: correct one"),
    ("# Width: 1 mm\nx [um];y [um];z [um]\n" + xyz(separator=";"), dict(body=2), "contradict each other"),
    (xyz(order=[*range(H.size), 3]), SIZED, "interpolate"), (xyz() + "5 5 0\n", SIZED, "interpolate"),
    (hole("XYZ"), SIZED, "'XYZ' is not a number.*--missing"),
    (GWYDDION["german"].replace("um\n", "V\n") + rows(H), UM, "in V"),
    (xyz(), dict(SIZED, units="ell"), "'?ell'?: expected a unit"), (rows(H, ","), dict(SIZED, missing="x"), None),
], ids=range(12))  # fmt: skip
def test_a_file_is_refused_with_the_cure(tmp_path, content, given, says):
    (tmp_path / "z.csv").write_text(content, encoding="utf-8")
    if says is None:
        petsam.surface.read(tmp_path / "z.csv", **given)
        return
    with pytest.raises(petsam.Error, match=says):
        petsam.surface.read(tmp_path / "z.csv", **given)


def test_a_word_of_missing_points_is_for_texts(tmp_path):
    np.save(tmp_path / "z.npy", H)
    with pytest.raises(petsam.Error, match="--missing BAD: is a word, which only texts have"):
        petsam.surface.read(tmp_path / "z.npy", **SIZED, missing="BAD")


# ---------------------------------------------------------------- profiles

LINE = 1e-3 * np.round(np.linspace(-20, 20, 64) ** 2, 3)
PLACES = np.arange(64) * 0.5
PROFILES = {
    "heads": ("x [um],z [um]\n" + rows(np.c_[PLACES, LINE], ","), dict(body=2)),
    "falling": (rows(np.c_[PLACES, LINE][::-1]), dict(UM, size="32um")),
    "line export": ("  Profile 1\n  x   z\n [m]  [um]\n" + rows(np.c_[PLACES * 1e-6, LINE], "  "), dict(body=2)),
    "position, height": (
        "Position (mm);Height (\u00b5m)\n" + rows(np.c_[PLACES * 1e-3, LINE], ";", point=","), dict(body=2),
    ),
    "one line": (rows(LINE[None], ","), dict(UM, size="32um")),
    "one column": (rows(LINE[:, None]), dict(UM, pixel=5e-7)),
}  # fmt: skip


@pytest.mark.parametrize("name", PROFILES)
def test_a_profile_is_one_row(tmp_path, name):
    content, given = PROFILES[name]
    (tmp_path / "p.csv").write_text(content, encoding="utf-8")
    one = petsam.surface.read(tmp_path / "p.csv", **given)
    assert one.is_profile and one.values.shape == (1, 64)
    assert_close(one.values[0], LINE * 1e-6, 1e-6)
    assert_close(one.cell[0], 5e-7, 1e-6)
    with pytest.raises(petsam.Error, match="x only|contradicts --size"):
        petsam.surface.read(tmp_path / "p.csv", **{**given, "size": "32um,16um", "pixel": None})
    with pytest.raises(petsam.Error, match="has no y: leave out --first-row"):
        petsam.surface.read(tmp_path / "p.csv", **given, first_row="top")


def test_a_profile_runs_in_plane_strain(surface, petsam, tmp_path):  # noqa: F811
    x = (np.arange(256) + 0.5) / 256 * 1e-3 - 5e-4
    (tmp_path / "p.csv").write_text("x [mm],z [um]\n" + rows(np.c_[x * 1e3, -(x**2) / 0.1 * 1e6], ",", "{:.12g}"))
    out = surface("p.csv", "--body", 2, "--grid-n", 128)
    options = out[out.index("options for petsam:") + 1].split()
    assert "-elasticity plane -grid_n 128 -grid_size 0.001" in " ".join(options) and (tmp_path / "p.png").exists()
    material = "-body1_young 115e9 -body1_poisson 0.32 -body2_young 115e9 -body2_poisson 0.32 -load_n 40e3".split()
    line = "-elasticity plane -grid_n 128 -grid_size 1e-3 -gap_type ellipsoid -gap_radius_x 50e-3 -gap_radius_y inf"
    runs = [petsam({}, *words, *material).stdout for words in (options, line.split())]
    area = [float(re.search(r"areas +contact (\S+)", run)[1]) for run in runs]
    assert area[0] == pytest.approx(area[1], rel=0.01)
    surface("p.h5", "-o", "again.h5", "--no-picture")
    assert np.array_equal(stored(tmp_path / "again.h5"), stored(tmp_path / "p.h5"))
    for level in levels.KINDS:
        surface("p.csv", "--body", 2, "--level", level, "--no-picture", warnings=None)
        assert stored(tmp_path / "p.h5").shape == (1, 256)
    assert "cells along x only" in surface("p.csv", "--body", 2, "--grid-n", "64,2", check=3)[0]


# ---------------------------------------------------------------- containers


def savemat(path, arrays):
    pytest.importorskip("SurfaceTopography", reason="SurfaceTopography is not installed")
    scipy.io.savemat(path, {name: "text" if value is None else value for name, value in arrays.items()})


def save73(path, arrays):
    """As Matlab writes version 7.3: HDF5 with its first index changing fastest."""
    pytest.importorskip("SurfaceTopography", reason="SurfaceTopography is not installed")
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, value in arrays.items():
            file[name] = np.zeros((1, 4), np.uint16) if value is None else np.atleast_2d(value).T
            file[name].attrs["MATLAB_class"] = np.bytes_("char" if value is None else "double")
    with open(path, "r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")


def saveh5(path, arrays):
    with h5py.File(path, "w") as file:
        for name, value in arrays.items():
            file["group/" + name] = "text" if value is None else value


CONTAINERS = {
    "z.npz": lambda path, arrays: np.savez(path, **arrays),
    "z.mat": savemat,
    "7.3.mat": save73,
    "z.h5": saveh5,
}
BESIDE = dict(x=np.arange(12.0), y=np.arange(9.0), fs=1e3)


@pytest.mark.parametrize("file", CONTAINERS)
def test_the_only_map_of_a_file_is_taken(tmp_path, file):
    """Its rows are y, whatever the format is."""
    CONTAINERS[file](tmp_path / file, dict(BESIDE, Z=H))
    one = petsam.surface.read(tmp_path / file, **SIZED)
    assert_close(one.values, H * 1e-6, 1e-12)
    assert any("Z of " in text for text in one.remarks), one.remarks
    CONTAINERS[file](tmp_path / file, dict(Z=H[:1], fs=np.float64(3.0)))
    one = petsam.surface.read(tmp_path / file, **UM, size="120um")
    assert one.is_profile and np.allclose(one.values, H[:1] * 1e-6, rtol=1e-12)


@pytest.mark.parametrize("file", CONTAINERS)
@pytest.mark.parametrize("arrays, says", [
    (dict(Z=H, W=H[:5]), r"contains 2 maps: it has .*(Z|W) \((9|5) x 12\), .*: choose one by"),
    (dict(x=H[:1], y=H[1:2]), "contains 2 profiles: it has .*x .1 x 12"),
    (dict(Z=np.stack([H, H])), r"no map \(ny, nx\): it has .*Z \((2 x 9 x 12|12 x 9 x 2)\): write"),
    (dict(Z=H * (1 + 1j)), "no map|complex|imaginary"), (dict(note=None), "no map.*note|not an array of NumPy"),
], ids=["two", "lines", "3-D", "complex", "text"])  # fmt: skip
def test_what_a_file_contains_is_told(tmp_path, file, arrays, says):
    if file == "z.npz":
        arrays = {name: np.array("text") if value is None else value for name, value in arrays.items()}
    CONTAINERS[file](tmp_path / file, arrays)
    with pytest.raises(petsam.Error, match=says):
        petsam.surface.read(tmp_path / file, **SIZED)
    if "W" in arrays:
        option = "channel" if file.endswith("mat") else "dataset"
        one = petsam.surface.read(tmp_path / file, **SIZED, **{option: "group/W" if file == "z.h5" else "W"})
        assert_close(one.values, H[:5] * 1e-6, 1e-12)
        with pytest.raises(petsam.Error, match="it has .*choose one by"):
            petsam.surface.read(tmp_path / file, **SIZED, **{option: "V"})


@pytest.mark.parametrize("file, name", [
    ("z.npz", "z.dat"), ("z.npz", "z.txt"), ("z.npz", "w.h5"), ("z.npz", "w.mat"), ("z.h5", "z.dat"), ("z.h5", "z.npy"),
    ("z.h5", "w.mat"), ("7.3.mat", "z.txt"), ("7.3.mat", "z.prn"),
])  # fmt: skip
def test_what_a_file_of_another_name_contains_is_told(tmp_path, file, name):
    """By its first bytes, so that none of its arrays is taken for the only one."""
    CONTAINERS[file](tmp_path / file, dict(Z=H, W=H[:5]))
    (tmp_path / file).rename(tmp_path / name)
    with pytest.raises(petsam.Error, match=r"contains 2 maps: it has .*(Z|W) \(.*\), .*: choose one by --dataset"):
        petsam.surface.read(tmp_path / name, **SIZED)
    one = petsam.surface.read(tmp_path / name, **SIZED, dataset="group/W" if file == "z.h5" else "W")
    assert_close(one.values, H[:5] * 1e-6, 1e-12)


def test_a_matrix_of_another_name_is_offered_the_format_table(tmp_path):
    pytest.importorskip("SurfaceTopography", reason="SurfaceTopography is not installed")
    for name in ("z.asc", "z.sur", "z"):
        (tmp_path / name).write_text(rows(H, ";"))
        with pytest.raises(petsam.Error, match="give --format table"):
            petsam.surface.read(tmp_path / name, **SIZED)
        assert_close(petsam.surface.read(tmp_path / name, **SIZED, format="table").values, H * 1e-6, 1e-12)


# ---------------------------------------------------------------- a size that cannot be


def wide(path, scale):
    """A map of H, um, whose file states a size of 120 x 90 um times a scale; what else is to be given."""
    if path.suffix == ".h5":
        with h5py.File(path, "w") as file:
            file["height"] = H
            file["height"].attrs.update(units="um", size=[1.2e-4 * scale, 9e-5 * scale])
    elif path.suffix == ".nc":
        library = pytest.importorskip("SurfaceTopography", reason="SurfaceTopography is not installed")
        library.Topography(H.T, (120.0 * scale, 90.0 * scale), unit="um").to_netcdf(str(path))
    elif path.suffix == ".xyz":
        path.write_text("x [um] y [um] z [um]\n" + xyz(step=10 * scale))
    else:
        path.write_text(f"# Width: {120 * scale} um\n# Height: {90 * scale} um\n# Value units: um\n" + rows(H))


@pytest.mark.parametrize("file", ["z.txt", "z.xyz", "z.h5", "z.nc"])
@pytest.mark.parametrize("given", [dict(size="120um,90um"), dict(pixel="10um")], ids=str)
@pytest.mark.parametrize("scale, overruled", [(1e6, True), (0.01, True), (2.0, False)])
def test_a_size_that_is_warned_of_is_overruled(tmp_path, file, given, scale, overruled):
    """As one of metres, or below the heights; any other holds."""
    wide(tmp_path / file, scale)
    if not overruled:
        with pytest.raises(petsam.Error, match="contradicts --size or --pixel"):
            petsam.surface.read(tmp_path / file, body=2, **given)
        return
    one = petsam.surface.read(tmp_path / file, body=2, **given)
    assert_close(one.size, [1.2e-4, 9e-5], 1e-9)
    assert any("size of the file" in text and "overruled by --size or --pixel" in text for text in one.remarks)


# ---------------------------------------------------------------- lines of instruments


def hfm(path, x, z, valid=1):
    lines = [f"{a:.6g};{b:.6g};{valid if k == 5 else 1}" for k, (a, b) in enumerate(zip(x, z))]
    path.write_text("X;Y;valid\n[mm];[um];[1/0]\n" + "\n".join(lines) + "\n")


def mitutoyo(path, x, z):
    book = pytest.importorskip("openpyxl").Workbook()
    data, certificate = book.active, book.create_sheet("Certificate")
    data.title, data["A1"] = "DATA", "Ra 0.5 \u00b5m"
    for k, (a, b) in enumerate(zip(x, z), 1):
        data.cell(k, 5, float(a)), data.cell(k, 6, float(b))
    certificate["E2"], certificate["E48"] = "01-Mar-2020", "0.8mm"
    book.save(path)


@pytest.mark.parametrize("x, step", [(PLACES + 0.5, 0.5), (np.round(PLACES * 0.3125, 1), 0.15625)], ids=["", "few"])
@pytest.mark.parametrize("write, file", [(hfm, "z.hfm"), (mitutoyo, "z.xlsx")], ids=["hfm", "xlsx"])
def test_a_line_of_an_instrument_is_a_profile(tmp_path, write, file, x, step):
    pytest.importorskip("SurfaceTopography", reason="SurfaceTopography is not installed")
    z = LINE + 1e-3 * PLACES  # not symmetric
    write(tmp_path / file, x, z)
    one = petsam.surface.read(tmp_path / file, body=2)
    assert_close(one.values, z[None] * 1e-6, 1e-5)
    assert one.cell[0] == pytest.approx(step * 1e-3, rel=1e-3)
    if write == hfm:
        hfm(tmp_path / file, x[::-1], z[::-1])
        assert_close(petsam.surface.read(tmp_path / file, body=2).values, one.values, 1e-12)


def test_a_line_of_an_instrument_may_be_uneven_or_lack_points(tmp_path):
    pytest.importorskip("SurfaceTopography", reason="SurfaceTopography is not installed")
    hfm(tmp_path / "z.hfm", PLACES**1.5, LINE)
    with pytest.raises(petsam.Error, match="is a profile x, z, which is read where x rises in even steps"):
        petsam.surface.read(tmp_path / "z.hfm", body=2)
    hfm(tmp_path / "z.hfm", PLACES, LINE, valid=0)
    assert np.flatnonzero(np.isnan(petsam.surface.read(tmp_path / "z.hfm", body=2).values[0])).tolist() == [5]


@pytest.mark.parametrize("empty", [1, 2, 4])
def test_empty_last_columns_are_left_out(tmp_path, empty):
    table = "x [um],z [um]\n" + rows(np.c_[PLACES, LINE], ",")
    (tmp_path / "p.csv").write_text(table.replace("\n", "," * empty + "\n"))
    one = petsam.surface.read(tmp_path / "p.csv", body=2)
    assert one.values.shape == (1, 64)
    assert any(f"{empty} empty last columns left out" in text for text in one.remarks) == (empty > 1)
    (tmp_path / "z.csv").write_text(rows(H, ",").replace("\n", ",NaN\n"))  # a missing column is none that is empty
    assert petsam.surface.read(tmp_path / "z.csv", **UM, pixel="1um").n == (NX + 1, NY)


# ---------------------------------------------------------------- offsets of rows, outliers


def test_offsets_of_rows_go_and_the_tilt_stays():
    from petsam.apps.surface.maps import new_map

    values = smooth(128) * 1e-7 + 3e-7 * np.arange(128)[:, None] / 128
    offsets = 2e-7 * np.random.default_rng(1).normal(size=(128, 1))
    one = new_map(values + offsets, (1e-4, 1e-4), "height2", "map").level("rows")
    left = one.values - values
    assert np.std(left) < 0.25 * np.std(offsets)
    assert levels.tilt(one)[1] == pytest.approx(
        levels.tilt(new_map(values, (1e-4, 1e-4), "height2", "map"))[1], rel=0.3
    )
    assert "offsets of rows removed" in one.remarks[-1]


def test_offsets_of_rows_are_warned_of(surface, tmp_path):  # noqa: F811
    random = np.random.default_rng(2)
    np.save(tmp_path / "z.npy", random.normal(size=(64, 64)) + 0.4 * random.normal(size=(64, 1)))
    know = ["--body", 2, "--units", "nm", "--size", "1um", "--no-picture"]
    surface("z.npy", *know, warnings=True)
    assert "the variance between its rows is" in surface.complaint and "--level rows" in surface.complaint
    surface("z.npy", *know, "--level", "rows")


@pytest.mark.parametrize("count", [0, 1, 7])
def test_outliers_are_counted_and_replaced(surface, tmp_path, count):  # noqa: F811
    values = smooth(64)
    places = np.random.default_rng(3).choice(values.size, count, replace=False)
    spoilt = values.copy()
    spoilt.flat[places] += np.where(places % 2, 40.0, -40.0)
    np.save(tmp_path / "z.npy", spoilt)
    out = surface("z.npy", "--body", 2, "--units", "um", "--size", "1mm", "--outliers", "--no-picture")
    said = f"{count} outlier{'s' if count > 1 else ''} replaced (smooth)" if count else "no outliers found"
    assert any(said in line for line in out), out
    found = stored(tmp_path / "z.h5") * 1e6
    keep = np.ones(values.size, dtype=bool)
    keep[places] = False
    assert_close(found.ravel()[keep], values.ravel()[keep], 1e-12)
    assert np.max(np.abs(found - values)) < 0.3 * np.ptp(values)


@pytest.mark.parametrize("values", [
    np.random.default_rng(4).normal(size=(200, 200)), np.add.outer(np.arange(50.0), np.arange(50.0) ** 2),
    np.where(np.arange(64) < 30, 0.0, 5.0) + 1e-3 * np.random.default_rng(4).normal(size=(64, 64)), np.zeros((9, 9)),
    np.where(np.arange(64) == 30, -5.0, 0.0) + 1e-3 * np.random.default_rng(4).normal(size=(64, 64)),
], ids=["noise", "form", "step", "flat", "scratch"])  # fmt: skip
def test_what_belongs_to_a_surface_is_no_outlier(values):
    assert not np.any(spikes.found(values))


def test_missing_points_stay_missing_beside_outliers(surface, tmp_path):  # noqa: F811
    values = smooth(64)
    values[3, 4], values[40, 30] = np.nan, 90.0
    np.save(tmp_path / "z.npy", values)
    know = ["--body", 2, "--units", "um", "--size", "1mm", "--no-picture", "--outliers"]
    assert "1 point is missing, of 4096" in surface("z.npy", *know, check=3)[0]
    out = surface("z.npy", *know, "--fill", "nearest")
    assert any("1 outlier replaced (nearest)" in line for line in out)


# ---------------------------------------------------------------- from Python


def test_a_map_is_processed_and_drawn_without_a_command(tmp_path):
    np.save(tmp_path / "z.npy", H)
    one = petsam.surface.read(tmp_path / "z.npy", units=1e-6, pixel=1e-5, body=1, mirror="x")
    two = one.cut(-5e-5, 5e-5, -4e-5, 4e-5).fill().level("tilt").resample((20, 16))
    assert two.n == (20, 16) and len(two.remarks) == len(one.remarks) + 3
    two.write(tmp_path / "out.h5")
    two.to_csv(tmp_path / "out.csv")
    assert (tmp_path / "out.csv").read_text().startswith("x [m],y [m],height [m]\n")
    again = petsam.surface.read(tmp_path / "out.h5")
    assert again.quantity == "height1" and np.array_equal(again.values, two.values)
    petsam.plot.surface(two).savefig(tmp_path / "p.png")
    both = petsam.surface.combined(
        two, petsam.surface.read(tmp_path / "z.npy", **SIZED).cut(-5e-5, 5e-5, -4e-5, 4e-5).resample((20, 16))
    )
    assert both.quantity == "separation"


def test_no_reader_knows_a_command_line():
    folder = ROOT / "scripts/petsam/apps/surface"
    for path in {*folder.rglob("*.py")} - {folder / "command.py"}:
        assert "options." not in path.read_text() and "argparse" not in path.read_text(), path


@pytest.mark.parametrize("value, told", [(-999.0, True), (32767.0, True), (-997.0, False)])
def test_a_number_that_stands_for_a_missing_point_is_told(tmp_path, value, told):
    values = np.random.default_rng(1).standard_normal((16, 12))
    values[2, 3] = value
    np.savetxt(tmp_path / "one.txt", values)
    one = petsam.surface.read(tmp_path / "one.txt", units="um", size=(1.2e-4, 1.6e-4), body=2)
    assert any(f"give --missing {value:g}" in text for text in one.doubts) == told
    one = petsam.surface.read(tmp_path / "one.txt", units="um", size=(1.2e-4, 1.6e-4), body=2, missing=value)
    assert not one.doubts and np.isnan(one.values).sum() == 1
