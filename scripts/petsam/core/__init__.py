"""Common modules of all parts of the package.

errors       errors that are reported in one line
files        names of files, and texts
hdf5         HDF5 files: opened to read, replaced when they are written
examine      examination of HDF5 files by petsam-examine, before they are opened
options      options of the program as words of a command line
declared     what petsam declares: units of options, names of files, materials
units        the one table of units
version      the version of the package
materials    the table of materials: petsam.materials
least        least squares: the best of several starts, standard deviations, correlations
words        reading of a word: a number with its unit, several, a span, a name with its value
tables       tables as CSV: columns with name, unit and meaning
public       checks of arguments, and signatures, of what users call
brief        repr() of results in a few lines
keywords     keywords that several functions have, explained once
shown        report() of results, by petsam.plot
environment  search for the interpreter, its libraries and petsam
"""
