"""Studies: run() runs all cases of a table side by side and returns their results.

reading (the table's text), cases (made of it), expressions (in it), runs (side by side, again where they ended), jobs
(a study as a whole), progress (printed lines), tables (results of all cases), slurm (as jobs of Slurm).
"""

from .cases import Case
from .jobs import Jobs, run
from .reading import TableError
from .tables import Figures

__all__ = ["Case", "Figures", "Jobs", "TableError", "run"]
