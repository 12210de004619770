"""Measured and random surfaces as files of petsam: petsam-surface.

    import petsam
    one = petsam.surface.read("rough.npy", units="um", size="1mm", body=2).fill().level("tilt").resample((512, 512))
    one.write("rough.h5")
    petsam.plot.surface(one)

read        a map from a file of any kind: a Map with fill, level, cut, resample, write
combined    the separation of two surfaces

maps        a map: orientation, window, description
readers     formats of files, one class each
tables      numbers in text files
headers     statements in the header of a text file
doubts      lists of points that are no map; maps with offsets of rows, outliers
reading     what a file and options state of a map together
filling     missing points
spikes      outliers against their neighbours
levels      mean, tilt and form taken off; offsets of rows
resampling  a map on another grid
generation  random surfaces of a spectrum
writing     HDF5 for petsam's -gap_file and -gap_rough_file
"""

from ...core.part import Part

PART = Part(
    __name__,
    names={"maps": ("Map", "combined"), "reading": ("read", "read_hdf5", "read_values"), "readers": ("FORMATS",)},
    quiet=True,
    libraries=("numpy", "h5py", "matplotlib", "scipy"),
    see=("petsam", "petsam-joint"),
    pictures={"pictures": ("surface",)},
)
__all__, __getattr__, __dir__ = PART.face()
