"""Maps as HDF5, for petsam's -gap_file and -gap_rough_file and for other readers."""

import numpy as np

from ...core.hdf5 import replacing
from .basics import QUANTITIES

SIGN = "petsam_surface"  # root attribute by which a file of this command is known


def dataset(one):
    """Name of the dataset; that of heights is petsam's default."""
    return "separation" if one.quantity == "separation" else "height"


def write(one, path, command):
    """The map; command: the words that made it. A file of that name is replaced when all is written."""
    with replacing(path, SIGN) as file:
        file.attrs["command"] = command
        data = file.create_dataset(dataset(one), data=np.asarray(one.values, dtype=np.float64))
        data.attrs.update(units="m", quantity=one.quantity, long_name=QUANTITIES[one.quantity])
        for d, letter in ((1, "y"), (0, "x")):
            axis = file.create_dataset(letter, data=one.axis(d))
            axis.attrs.update(units="m", long_name=letter + " of the cells' centres")
            axis.make_scale(letter)
            data.dims[1 - d].attach_scale(axis)
