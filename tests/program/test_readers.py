"""The results open where users look: h5py, xarray, VTK through VTKHDF, with the same values in all."""

import h5py
import numpy as np
import pytest

from conftest import PROGRAM, execute
from support import FIELDS, ball

# steps of which some have no fields; a grid that is not square, does not lie about the origin and has several chunks
CASE = dict(
    ball(48),
    grid_n=(50, 41),
    grid_size=(2.4e-3, 2.2e-3),
    grid_center=(1e-4, -5e-5),
    load_tx=20.0,
    steps=5,
    output_every=2,
)
CHUNKED = dict(CASE, output_chunk=(16, 9), output_compress=4)
SINGLE = dict(CASE, output_single=True)
SAVED = [0.4, 0.8, 1.0]


@pytest.fixture(params=[CASE, CHUNKED, SINGLE], ids=["plain", "chunked and compressed", "single"])
def path(solve, request):
    return solve(request.param, ranks=2).path


@pytest.fixture
def values(path):
    with h5py.File(path) as f:
        return {name: f[name][:] for name in (*FIELDS, "x", "y", "time")}


# ---- HDF5


@pytest.mark.parametrize(
    "options, chunks",
    [
        ({}, (1, 41, 50)),
        (dict(output_chunk=16), (1, 14, 13)),
        (dict(output_chunk=(16, 9)), (1, 9, 13)),
        (dict(output_chunk=1000), (1, 41, 50)),
    ],
    ids=str,
)
def test_chunks_are_the_fewest_of_at_most_that_size(solve, options, chunks):
    with h5py.File(solve(CASE, options).path) as f:
        assert f["pressure"].chunks == f["state"].chunks == chunks


@pytest.mark.parametrize("level", [1, 9])
def test_compression_is_of_the_level_asked_for(solve, level):
    plain, small = solve(CASE).path, solve(CASE, dict(output_compress=level)).path
    with h5py.File(small) as f:
        assert f["shear_x"].compression == "gzip" and f["shear_x"].compression_opts == level and f["shear_x"].shuffle
        stored = f["shear_x"].id.get_storage_size()
    with h5py.File(plain) as f:
        assert f["shear_x"].compression is None
        assert stored < f["shear_x"].id.get_storage_size()


@pytest.mark.parametrize("text", ["0", "-1", "16,0", "1,2,3", "x"])
def test_impossible_chunk_is_refused(petsam, text):
    assert "-output_chunk" in petsam(CASE, "-output_chunk", text, "-output", "out.h5", check=2).complaint[0]


@pytest.mark.parametrize(
    "name, axis, standard",
    [
        ("x", "X", "projection_x_coordinate"),
        ("y", "Y", "projection_y_coordinate"),
        ("time", "T", "time"),
        ("history/time", "T", "time"),
    ],
)
def test_coordinates_are_those_of_CF(path, name, axis, standard):
    with h5py.File(path) as f:
        assert f[name].attrs["axis"] == axis and f[name].attrs["standard_name"] == standard
        assert f.attrs["Conventions"] == "CF-1.8" and f.attrs["title"] and "petsam" in f.attrs["source"]


# ---- xarray


def test_xarray_opens_fields_with_coordinates(path, values):
    xarray = pytest.importorskip("xarray", reason="xarray is not installed")
    pytest.importorskip("netCDF4", reason="netCDF4 is not installed")
    with xarray.open_dataset(path, engine="netcdf4") as data:
        assert set(data.data_vars) > {*FIELDS, "pressure_center", "stick_edge"}
        assert set(data.coords) == {"time", "y", "x"}
        assert data["time"].values == pytest.approx(SAVED)
        for name in FIELDS:
            assert data[name].dims == ("time", "y", "x") and np.array_equal(data[name], values[name]), name
        assert data["pressure"].attrs["units"] == "Pa" and data["pressure"].attrs["long_name"]
        x, y = values["x"][30], values["y"][7]
        assert float(data["gap"].sel(x=x, y=y, method="nearest")[-1]) == values["gap"][-1, 7, 30]


def test_xarray_opens_the_history(path):
    xarray = pytest.importorskip("xarray", reason="xarray is not installed")
    pytest.importorskip("netCDF4", reason="netCDF4 is not installed")
    with xarray.open_dataset(path, engine="netcdf4", group="history") as data, h5py.File(path) as f:
        assert set(data.variables) == set(f["history"])
        assert data["load_tx"].dims == ("time",) and data["load_tx"].sizes["time"] == 5
        assert np.array_equal(data["load_tx"], f["history/load_tx"])


# ---- VTK


def vtk_arrays(data):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    return {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}


def vtk_times(reader):
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

    reader.UpdateInformation()
    return reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())


def assert_vtk_reads(reader, path, of_cells, bounds, values):
    """Fields of every saved step, at their place."""
    reader.SetFileName(str(path))
    times = vtk_times(reader)
    assert times == pytest.approx(SAVED)
    for step, time in enumerate(times):
        reader.UpdateTimeStep(time)
        image = reader.GetOutputDataObject(0)
        assert np.allclose(image.GetBounds()[:4], bounds, rtol=0, atol=1e-15)
        arrays = vtk_arrays(image.GetCellData() if of_cells else image.GetPointData())
        assert set(FIELDS) <= set(arrays)
        for name in FIELDS:
            assert np.array_equal(arrays[name].reshape(41, 50), values[name][step]), (name, step)


def test_vtk_reads_the_file_itself(path, values):
    pytest.importorskip("vtkmodules", reason="vtk is not installed")
    from vtkmodules.vtkIOHDF import vtkHDFReader

    c, w = CASE["grid_center"], CASE["grid_size"]
    assert_vtk_reads(
        vtkHDFReader(), path, True, (c[0] - w[0] / 2, c[0] + w[0] / 2, c[1] - w[1] / 2, c[1] + w[1] / 2), values
    )


@pytest.mark.parametrize("steps", ["last", "all"])
@pytest.mark.parametrize("of", ["-depths 0:1e-4:3", "-depths 1e-5", "-depths 0:1e-4:3 -section y=0"])
def test_vtk_reads_stresses(solve, launcher, tmp_path, steps, of):
    """Also of one step, one depth and one row, which VTK counts as no dimension."""
    pytest.importorskip("vtkmodules", reason="vtk is not installed")
    from vtkmodules.vtkIOHDF import vtkHDFReader

    options = ["-input", solve(CASE).path, "-output", "s.h5", "-steps", steps, *of.split()]
    execute(launcher, tmp_path, options, 1, 0, program=PROGRAM.with_name("petsam-stress"))
    reader = vtkHDFReader()
    reader.SetFileName(str(tmp_path / "s.h5"))
    with h5py.File(tmp_path / "s.h5") as f:
        for step, time in enumerate(f["time"]):
            vtk_times(reader)
            reader.UpdateTimeStep(time)
            image = reader.GetOutputDataObject(0)
            arrays = vtk_arrays(image.GetPointData()) or vtk_arrays(image.GetCellData())
            assert np.array_equal(arrays["mises"], f["mises"][step].ravel())


def test_vtk_reads_a_single_step(solve):
    pytest.importorskip("vtkmodules", reason="vtk is not installed")
    from vtkmodules.vtkIOHDF import vtkHDFReader

    path = solve(CASE, dict(output_every=5)).path
    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.Update()
    with h5py.File(path) as f:
        assert np.array_equal(vtk_arrays(reader.GetOutputDataObject(0).GetCellData())["gap"], f["gap"][0].ravel())
