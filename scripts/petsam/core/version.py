"""The version of the package, which is that of petsam."""

__version__ = "1.0.0"
