"""Files of results: what petsam.open() returns.

file      Results of petsam: numbers of all steps, fields of the saved ones
parts     the parts of a run that was restarted
stresses  Stresses of petsam-stress
studies   Study, the table of petsam-study
cycles    cycles of a load history and their energies
sliding   regime, energy ratio, sliding ratio of a cycle; slip amplitudes
"""

from .file import OPEN, SLIP, STICK, NotSaved, Results, Snapshot
from .stresses import Stresses
from .studies import Study

__all__ = ["OPEN", "SLIP", "STICK", "NotSaved", "Results", "Snapshot", "Stresses", "Study"]
