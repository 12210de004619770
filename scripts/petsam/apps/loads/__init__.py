"""Load histories from the contact forces of a structural analysis: petsam-loads.

    forces = petsam.loads.read("contact.csv", length="mm", force="N")
    found = petsam.loads.history(forces, frame=((5, 0, 0), (-1, 0, 1), (1, 0, 1)), patch="FLANK")
    found.write("flank.csv")  # for -history
    petsam.plot.loads(found)

read      forces at nodes over time, of a file of any of the formats (reading.py)
history   the loads of one patch in its frame: a History with table(), rows, notes (resultants.py)

forces      forces at nodes, and patches of them
gathering   rows of a file as arrays over times and nodes
texts       tables with a head
calculix    CalculiX's .dat and .frd
abaqus      Abaqus's reports
automatic   a frame by the forces
doubts      remarks about a history: pull, moments beyond the patch, motion
"""

from ...core.part import Part

PART = Part(
    __name__,
    names={"forces": ("Forces",), "resultants": ("History", "history"), "reading": ("read",)},
    quiet=True,
    libraries=("numpy", "h5py", "matplotlib", "scipy"),
    see=("petsam", "petsam-compliance"),
    pictures={"pictures": ("loads", "loads_beside")},
)
__all__, __getattr__, __dir__ = PART.face()
