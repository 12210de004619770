"""Contacts: in this process, as runs of the program, and what is computed of them.

inprocess    Contact: steps, stiffness, histories (histories.py)
evaluations  its stresses, fatigue, and gradient of a number (derivatives.py)
fields       its fields; steps: what it returns
handle       its calls of the library (shared.py), numbers and files
errors       errors and warnings of all contacts
running      run(): a run of the program, whose results it returns
gradient     derivatives of a number of a history by all parameters
uncertainty  standard deviation of such a number by roughness and parameters
"""

from ..core.part import Part

PART = Part(
    __name__,
    names={
        "inprocess": ("Contact",),
        "steps": ("Cycle", "Step", "Stiffness"),
        "errors": (
            "AdviceWarning", "ContactError", "CycleWarning", "EdgeContact", "EdgeContactWarning", "NoEquilibrium",
            "NotConverged", "PrescribedError", "WearWarning",
        ),
        "running": ("run",),
        "": ("gradient", "uncertainty"),
    },
)  # fmt: skip
__all__, __getattr__, __dir__ = PART.face()
