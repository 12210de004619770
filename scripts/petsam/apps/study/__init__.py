"""Many runs from a table: run() runs all cases side by side and returns their results.

reading (the table's text), cases (made of it), expressions (in it), runs (side by side, again where they ended), jobs
(a study as a whole), progress (printed lines), tables (results of all cases), slurm (as jobs of Slurm).
"""

from ...core.part import Part

PART = Part(
    __name__,
    names={"cases": ("Case",), "jobs": ("Jobs", "run"), "reading": ("TableError",), "tables": ("Figures",)},
    libraries=("numpy", "h5py", "yaml"),
    see=("petsam", "petsam-stress", "petsam-plot"),
)
__all__, __getattr__, __dir__ = PART.face()
