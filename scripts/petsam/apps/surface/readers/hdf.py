"""Datasets of HDF5 files, whose attributes and axes state all that petsam reads."""

import numpy as np

from ....core import units
from ....core.errors import Error, short
from ....core.files import decoded
from ....core.hdf5 import opened
from ..basics import QUANTITIES, SAME
from .arrays import NONE, REAL, chosen, listed, told
from .stated import ARRAYS, HDF5, OTHERS, TEXTS, Reader, Stated

ANOTHER = "convert another one by petsam-surface FILE --dataset NAME -o NEW.h5"
EVEN = 1e-3  # maximum relative difference of the distances of cells


class Hdf5(Reader):
    """HDF5: attributes units, quantity and size of the dataset, or axes x and y beside it."""

    family = "hdf5"
    states = ("unit", "size", "center", "quantity", "first row")

    def recognizes(self, source):
        """By its name, or by its first bytes under a name of a text or of arrays; others are those of instruments."""
        if source.ending == ".mat":
            return source.start.startswith(HDF5)  # those of Matlab 7.3 are read as its others
        return source.ending in (".h5", ".hdf5") or source.ending in TEXTS + OTHERS + ARRAYS and source.is_hdf5

    def read(self, source):
        """The dataset and its attributes."""
        return of_hdf5(source.path, source.how.dataset, lengths=source.how.lengths)


def _attribute(path, data, name):
    """A text attribute, or None."""
    value = data.attrs.get(name)
    value = decoded(value) if isinstance(value, bytes) else value
    if value is not None and not isinstance(value, str):
        raise Error(f"{path}: {data.name}: its attribute {name} is not a text")
    return value


def _unit(path, data, name):
    """Metres of the unit in the attribute; None without it."""
    text = _attribute(path, data, "units")
    if text is not None and units.size(text) is None:
        raise Error(f"{path}: {name}: its attribute units is {short(text)!r}; use one of {units.names()}")
    return None if text is None else units.size(text)


def _size(path, data):
    """The attribute size along x, y in m, or None."""
    if "size" not in data.attrs:
        return None
    size = np.asarray(data.attrs["size"])
    if size.shape != (2,) or size.dtype.kind not in "iuf" or not np.all((size > 0) & np.isfinite(size)):
        raise Error(f"{path}: {data.name}: its attribute size is not two positive numbers: x, y in m")
    return tuple(map(float, size))


def _axis(path, file, name, n, bare=False):
    """Width, centre, and whether it falls, of an axis beside the dataset; None if there is none, or without units.

    bare: take an axis without units for one in m.
    """
    if name not in file or getattr(file[name], "shape", None) != (n,) or n < 2:
        return None
    unit = _unit(path, file[name], name) or (1.0 if bare else None)
    if unit is None:
        return None
    if file[name].dtype.kind not in "iuf":
        raise Error(f"{path}: {name} is no axis of numbers")
    axis = file[name][:] * unit
    steps = np.diff(axis)
    if not np.all(np.abs(steps - steps.mean()) <= EVEN * abs(steps.mean())) or not steps.mean():
        raise Error(f"{path}: {name} is not even: a map has cells of one width")
    width, middle = abs(steps.mean()) * n, (axis[0] + axis[-1]) / 2
    return width, middle if abs(middle) > SAME * width else 0.0, steps.mean() < 0.0  # 0 but for rounding


def of_hdf5(path, dataset, bare=False, lengths=True):
    import h5py  # by core/hdf5.py in any case

    with opened(path) as file:
        name = (dataset or ("separation" if bare and "separation" in file else "height")).strip("/")
        name = name if name in file or dataset else "separation"
        remarks = ()
        if name not in file and not dataset and not bare:
            shapes = contents(file)
            name = chosen(path, shapes, "--dataset")
            remarks = told(name, shapes)
        data = file.get(name)
        if data is None and not dataset:
            raise Error(f"{path}: no dataset height or separation; {ANOTHER}")
        if not isinstance(data, h5py.Dataset) or data.ndim != 2 or data.dtype.kind not in REAL:
            cure = ANOTHER if bare else listed(contents(file), "--dataset") if lengths else "give it that name"
            raise Error(f"{path}: has no dataset /{name} of shape (ny, nx); {cure}")
        if "scale_factor" in data.attrs or "add_offset" in data.attrs:
            raise Error(
                f"{path}: /{name}: its attributes scale_factor or add_offset show that it is packed; unpack it first"
            )
        values = data[:].T if "MATLAB_class" in data.attrs else data[:]  # Matlab's first index changes fastest
        quantity = _attribute(path, data, "quantity")
        if quantity is not None and quantity not in QUANTITIES:
            known = ", ".join(QUANTITIES)
            raise Error(f"{path}: /{name}: its attribute quantity is {short(quantity)!r}; use one of {known}")
        unit = _unit(path, data, "/" + name) if lengths else None
        group, size = data.parent, _size(path, data)
        axes = [_axis(path, group, letter, n, bare) for letter, n in zip("xy", values.shape[::-1])]
        if len(values) == 1:
            axes[1] = (1.0, 0.0, False)  # of a profile, per metre along y
    if None in axes:
        layout = "grid" if size else "array"
        return Stated(values, unit, size, quantity=quantity, name=name, remarks=remarks, layout=layout)
    x, y = axes
    if x[2]:
        values = values[:, ::-1]
    if size and not np.allclose(size[: min(2, len(values))], (x[0], y[0])[: min(2, len(values))], rtol=EVEN, atol=0.0):
        raise Error(f"{path}: /{name}: its attribute size and the axes x and y contradict each other: remove one")
    size, center = (x[0], y[0]), (x[1], y[1])
    return Stated(values, unit, size, center, quantity, y[2], name=name, remarks=remarks, layout="grid")


def contents(file):
    """Shapes of all datasets in an open file by their names, as of arrays.chosen()."""
    import h5py

    shapes = {}

    def note(name, item):
        if isinstance(item, h5py.Dataset):
            shapes[name] = item.shape if item.dtype.kind in REAL else NONE

    file.visititems(note)
    return shapes
