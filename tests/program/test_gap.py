"""Gaps and roughness from files."""

import shutil
import signal
import struct
import sys

import h5py
import numpy as np
import pytest

from conftest import PROGRAM, environment
from support import assert_close, assert_same, ball, finished, hertz, words

D = 2.1e-5
# rounding of h sends the solvers another way, so that what their tolerances leave differs: with these it is below 1e-9
BASE = dict(ball(0), grid_n=(84, 71), grid_size=(84 * D, 71 * D), load_tx=25.0, normal_rtol=1e-11, tangential_rtol=1e-9)
FILE = dict(BASE, gap_type="file", gap_radius1=None, gap_radius2=None, gap_file="gap.h5")


def cells(center=(0.0, 0.0)):
    return np.meshgrid(center[0] + (np.arange(84) - 41.5) * D, center[1] + (np.arange(71) - 35) * D)


def write(path, height, name="height", **more):
    with h5py.File(path, "w") as f:
        f.create_dataset(name, data=height, **more)
    return path


def test_file_of_a_paraboloid_is_the_sphere(solve, tmp_path):
    x, y = cells()
    gap = write(tmp_path / "gap.h5", (x**2 + y**2) / 2 / BASE["gap_radius1"])
    assert_same(solve(dict(FILE, gap_file=gap)), solve(BASE), 1e-9)


@pytest.mark.parametrize("ranks", [3, 5])
def test_file_is_read_in_parallel(solve, tmp_path, ranks):
    x, y = cells()
    gap = write(tmp_path / "gap.h5", (x**2 + y**2) / 2 / BASE["gap_radius1"])
    assert_same(solve(dict(FILE, gap_file=gap), ranks=ranks), solve(BASE), 1e-9)


@pytest.mark.parametrize(
    "more",
    [dict(dtype="f4"), dict(dtype=">f8"), dict(chunks=(16, 16), compression="gzip"), dict(name="surface/h")],
    ids=["float32", "big-endian", "compressed", "group"],
)
def test_file_may_store_in_other_ways(solve, tmp_path, more):
    x, y = cells()
    gap = write(tmp_path / "gap.h5", (x**2 + y**2) / 2 / BASE["gap_radius1"], **more)
    case = dict(FILE, gap_file=gap, gap_dataset="/surface/h" if "name" in more else None)
    assert_same(solve(case), solve(BASE), 1e-4 if more.get("dtype") == "f4" else 1e-9)  # float32 has 6e-8 of h


@pytest.mark.parametrize("tells", ["size", "axes", "cells"])
def test_file_alone_is_enough(solve, tmp_path, tells):
    """What the file says of its grid is as if it stood on the command line, to the last bit."""
    x, y = cells()
    gap = write(tmp_path / "gap.h5", (x**2 + y**2) / 2 / BASE["gap_radius1"])
    with h5py.File(gap, "a") as f:
        if tells == "size":
            f["height"].attrs["size"] = BASE["grid_size"]
        if tells == "axes":
            f["x"], f["y"] = x[0] * 1e3, y[:, 0] * 1e3
            f["x"].attrs["units"] = f["y"].attrs["units"] = "mm"
    case = dict(FILE, gap_file=gap)
    alone = dict(case, gap_type=None, grid_n=None, grid_size=case["grid_size"] if tells == "cells" else None)
    assert_same(solve(alone), solve(case), 0)


def test_file_alone_tells_where_it_lies(solve, tmp_path):
    """By x and y: the loads are about x = y = 0, not about the centre of the file."""
    center = (1e-4, -6e-5)
    x, y = cells(center)
    gap = write(tmp_path / "gap.h5", (x**2 + y**2) / 2 / BASE["gap_radius1"])
    with h5py.File(gap, "a") as f:
        f["x"], f["y"] = x[0], y[:, 0]
        f["x"].attrs["units"] = f["y"].attrs["units"] = "m"
    case = dict(FILE, gap_file=gap, load_tx=5.0)
    alone, given = solve(dict(case, gap_type=None, grid_n=None, grid_size=None)), solve(dict(case, grid_center=center))
    assert_same(alone, given, 0)
    assert abs(alone["rot_y"]) < 1e-3 * abs(solve(dict(case, grid_center=(0.0, 0.0)))["rot_y"])


@pytest.mark.parametrize("shape", [(0, 0), (1, 5), (5, 1), (6, 0)])
def test_file_of_less_than_two_rows_or_columns_is_refused(petsam, tmp_path, shape):
    with h5py.File(tmp_path / "gap.h5", "w") as f:
        for name, data in (("height", np.zeros(shape)), ("x", np.zeros(shape[1])), ("y", np.zeros(shape[0]))):
            f.create_dataset(name, data=data).attrs["units"] = "m"
    line = petsam(dict(FILE, gap_type=None, grid_n=None, grid_size=None), check=3).complaint[0]
    assert f"/height has shape ({shape[0]}, {shape[1]}), expected 2 or more of each" in line


@pytest.mark.parametrize("ranks", [1, 2])
def test_file_that_does_not_tell_its_size_is_named(petsam, tmp_path, ranks):
    write(tmp_path / "gap.h5", np.zeros((71, 84)))
    case = dict(FILE, gap_type=None, grid_n=None, grid_size=None)
    (line,) = [line for line in petsam(case, check=2, ranks=ranks).complaint if "-grid_size" in line]
    assert "-grid_size is missing: -gap_file gap.h5 records no size of /height" in line


def test_constant_in_file_is_approach(solve, tmp_path):
    x, y = cells()
    gap = write(tmp_path / "gap.h5", (x**2 + y**2) / 2 / BASE["gap_radius1"] + 1e-6)
    assert solve(dict(FILE, gap_file=gap))["disp_z"] == pytest.approx(solve(BASE)["disp_z"] + 1e-6, rel=1e-9)


def test_rows_of_the_file_are_y(solve, tmp_path):
    """An asymmetrical gap on a grid that is not square: contact where the file has it."""
    x, y = cells()
    x0, y0 = 9 * D, -6 * D
    gap = write(tmp_path / "gap.h5", (x - x0) ** 2 / 2 / 0.09 + (y - y0) ** 2 / 2 / 0.04)
    s = solve(dict(FILE, gap_file=gap, rot_x=0.0, rot_y=0.0, load_n=40.0, load_tx=5.0))
    p = s.pressure / s.pressure.sum()
    # the centre lies on a cell boundary in x, so half a cell of error could not be overlooked
    assert np.sum(p * s.xx) == pytest.approx(x0, abs=0.05 * D)
    assert np.sum(p * s.yy) == pytest.approx(y0, abs=0.05 * D)
    assert np.sum(p * (s.xx - x0) ** 2) > 1.3 * np.sum(p * (s.yy - y0) ** 2)  # longer along the larger radius
    assert_close(s.separation(), (x - x0) ** 2 / 2 / 0.09 + (y - y0) ** 2 / 2 / 0.04, 1e-13)


@pytest.mark.parametrize("kind", ["sphere", "file", "flat"])
def test_roughness_is_added(solve, tmp_path, kind):
    """Curvatures add: a second paraboloid as roughness is a sphere of smaller radius."""
    x, y = cells()
    h = (x**2 + y**2) / 2
    base = {
        "sphere": dict(BASE, gap_radius1=0.1),
        "file": dict(FILE, gap_file=write(tmp_path / "gap.h5", h / 0.1)),
        "flat": dict(BASE, gap_type="flat", gap_radius1=None, gap_radius2=None),
    }[kind]
    rough = write(tmp_path / "rough.h5", h / BASE["gap_radius1"] - (0 if kind == "flat" else h / 0.1), "z")
    assert_same(solve(dict(base, gap_rough_file=rough, gap_rough_dataset="z")), solve(BASE), 1e-9)


def test_rough_surfaces_touch_in_places(solve, tmp_path):
    x, y = cells()
    waves = 2e-7 * (np.cos(x * 2.9e4 + 0.3) * np.cos(y * 3.3e4) + 0.5 * np.sin(5.1e4 * x - 4.3e4 * y))
    s = solve(dict(BASE, gap_rough_file=write(tmp_path / "rough.h5", waves)))
    assert s["contact_area"] < np.pi * hertz(BASE).radius ** 2
    assert (
        s["normal_residual"] <= 1.05 * BASE["normal_rtol"]
        and s["tangential_residual"] <= 1.05 * BASE["tangential_rtol"]
    )
    assert s.loads()["load_n"] == pytest.approx(180.0, rel=1e-10)


def test_sphere_may_be_two_radii_or_one(solve):
    one = solve(BASE)
    assert_same(solve(dict(BASE, gap_radius1=float("inf"), gap_radius2=0.06)), one, 1e-9)
    assert_same(solve(dict(BASE, gap_radius1=0.09, gap_radius2=0.18)), one, 1e-9)


def test_ellipsoid_of_equal_radii_is_a_sphere(solve):
    case = dict(BASE, gap_type="ellipsoid", gap_radius1=None, gap_radius2=None, gap_radius_x=0.06, gap_radius_y=0.06)
    assert_same(solve(case), solve(BASE), 1e-9)


def test_punch_without_flat_is_a_sphere(solve):
    case = dict(BASE, gap_type="punch", gap_radius1=None, gap_radius2=None, gap_flat_radius=0.0, gap_edge_radius=0.06)
    assert_same(solve(case), solve(BASE), 1e-9)


def test_flat_bodies_share_the_load_over_all_of_the_grid(solve):
    case = dict(BASE, gap_type="flat", gap_radius1=None, gap_radius2=None, allow_edge_contact=True, load_tx=None)
    s = solve(case)
    assert s["contact_area"] == pytest.approx(84 * 71 * D * D, rel=1e-12)
    assert_close(s.displacement_z, s["disp_z"], 1.1e-8)


def make_circle(path):
    """Lets the index of the dataset's chunks, a tree of one node, have itself as its children."""
    data = bytearray(path.read_bytes())
    node = data.index(b"TREE\1")  # level, children (2 bytes), two siblings, and keys and children by turns
    key = 8 + 8 * 3
    (children,) = struct.unpack_from("<H", data, node + 6)
    data[node + 5] = 1
    for k in range(children):
        struct.pack_into("<Q", data, node + 24 + key + k * (key + 8), node)
    path.write_bytes(data)


@pytest.mark.parametrize("ranks", [1, 2])
def test_file_whose_addresses_form_a_circle_is_damaged(petsam, tmp_path, ranks):
    """HDF5 follows them until its stack is full."""
    make_circle(write(tmp_path / "gap.h5", np.zeros((71, 84)), chunks=(16, 16)))
    done = petsam(dict(FILE, gap_file=tmp_path / "gap.h5"), ranks=ranks, check=3)
    assert done.complaint == [f"petsam: -gap_file {tmp_path / 'gap.h5'}: cannot be read: it is damaged"]


def test_damage_is_found_where_the_ends_of_processes_are_ignored(tmp_path):
    """As by a program that starts petsam with SIGCHLD ignored: the system then keeps no exit status."""
    make_circle(write(tmp_path / "gap.h5", np.zeros((71, 84)), chunks=(16, 16)))
    command = [PROGRAM, *words(dict(FILE, gap_file=tmp_path / "gap.h5"))]

    def ignore():
        signal.signal(signal.SIGCHLD, signal.SIG_IGN)

    done = finished(command, check=3, preexec_fn=ignore, env=environment(), cwd=tmp_path)
    assert f"-gap_file {tmp_path / 'gap.h5'}: cannot be read: it is damaged" in done.stderr


@pytest.mark.slow
def test_a_program_that_examines_for_ever_is_ended(tmp_path):
    """As where a disk does not answer; it is found beside a copy of the library."""
    write(tmp_path / "gap.h5", np.zeros((71, 84)), chunks=(16, 16))
    library = shutil.copy(PROGRAM.parents[1] / "lib" / "libpetsam.so", tmp_path)
    (tmp_path / "petsam").mkdir()
    sleeper = tmp_path / "petsam" / "petsam-examine"
    sleeper.write_text("#!/bin/sh\necho -n -\nexec sleep 300\n")
    sleeper.chmod(0o755)
    case = dict(FILE, gap_file=tmp_path / "gap.h5", load_n=None, load_tx=None, output_fields=None)
    lines = f"""
import ctypes
library = ctypes.CDLL({library!r}, mode=ctypes.RTLD_GLOBAL)
contact = ctypes.c_void_p()
code = library.petsam_create(-1, {" ".join(words(case))!r}.encode(), ctypes.byref(contact))
library.petsam_message.restype = ctypes.c_char_p
assert code == 3 and b"has read it for 60 s without an end" in library.petsam_message(contact)
"""
    finished([sys.executable, "-c", lines], check=0, env=environment(), cwd=tmp_path)


def test_damage_is_found_by_a_library_that_was_loaded_by_a_relative_name(tmp_path):
    """The folder of the process may be another one when the library looks for petsam-examine."""
    make_circle(write(tmp_path / "gap.h5", np.zeros((71, 84)), chunks=(16, 16)))
    case = dict(FILE, gap_file=tmp_path / "gap.h5", load_n=None, load_tx=None, output_fields=None)
    options = " ".join(words(case))
    lines = f"""
import ctypes, os
os.chdir({str(PROGRAM.parents[1] / "lib")!r})
library = ctypes.CDLL("./libpetsam.so", mode=ctypes.RTLD_GLOBAL)
os.chdir("/")
os.environ["PATH"] = "/usr/bin:/bin"
contact = ctypes.c_void_p()
code = library.petsam_create(-1, {options!r}.encode(), ctypes.byref(contact))
library.petsam_message.restype = ctypes.c_char_p
assert code == 3 and b"it is damaged" in library.petsam_message(contact), (code, library.petsam_message(contact))
"""
    finished([sys.executable, "-c", lines], check=0, env=environment(), cwd=tmp_path)
