"""Studies: run() runs all cases of a table side by side and returns their results.

reading (the table's text), cases (made of it), expressions (in it), runs (side by side, again where they ended), jobs
(a study as a whole), progress (printed lines), tables (results of all cases), slurm (as jobs of Slurm).
"""

from ...core.part import Part

PART = Part(
    __name__,
    "many runs from a table",
    names={"cases": ("Case",), "jobs": ("Jobs", "run"), "reading": ("TableError",), "tables": ("Figures",)},
    command="petsam-study",
    libraries=("numpy", "h5py", "yaml"),
    see=("petsam", "petsam-stress", "petsam-plot"),
)
__all__, __getattr__, __dir__ = PART.face()
