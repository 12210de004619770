"""Files of results: what petsam.open() returns.

file      Results of petsam: numbers of all steps, fields of the saved ones
datafile  what all files share: opening, damaged files, numbers of the history
steps     the load steps of Results: history, saved steps by number, time or cycle, life
fields    the fields of Results, layers, edges
snapshot  Snapshot: fields and numbers of one saved step
errors    errors of the last numbers, of petsam -errors companion
parts     the parts of a run that was restarted
stresses  Stresses of petsam-stress
studies   Study, the table of petsam-study
shown     views in notebooks, by petsam.plot
cycles    cycles of a load history and their energies
sliding   regime, energy ratio, sliding ratio of a cycle; slip amplitudes
"""

from .errors import Errors, NumberError
from .file import OPEN, SLIP, STICK, NotSaved, Results
from .snapshot import Snapshot
from .stresses import Stresses
from .studies import Study

__all__ = ["OPEN", "SLIP", "STICK", "Errors", "NotSaved", "NumberError", "Results", "Snapshot", "Stresses", "Study"]
