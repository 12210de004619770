"""Height maps for petsam: petsam-surface.

maps        a map: orientation, window, description
tables      maps in text files
headers     statements in the header of a text file
doubts      lists of points that are no map; maps with offsets of rows, outliers
reading     maps from files of any kind
filling     missing points
levels      mean, tilt and form taken off
resampling  a map on another grid
generation  random surfaces of a spectrum
writing     HDF5 for petsam's -gap_file and -gap_rough_file
"""
