"""Friction, rig stiffness, coefficients of wear and other parameters from measured loops; what loops a test needs.

    shape = petsam.calibration.of_shape("sphere.opts", normal=100)
    loops = petsam.calibration.cycles(petsam.calibration.read("loops.csv"), normal=100)
    found = petsam.calibration.analyse([loops], [shape])
    print(found.friction, found.friction_sd, found.rig_stiffness)
    petsam.plot.fit(found).savefig("fit.png")

reading     read(): a laboratory's file
push        of_shape(), ball(): the displacement of one push, which serves all coefficients of friction
loops       fit(): the model of a loop, its parameters, and what the loops do not hold
series      cycles(), analyse(): cycles of a record, without drift, one by one and together
planning    plan(): how well which strokes would give the friction
runs        fit_contact(): parameters of any contact from numbers of its history, by full runs
scars       fit_profile(), family(), fit_scar(), split(): the coefficients of wear from the profile of a scar
results     what the command prints and writes; wear() from a volume
"""

from .loops import Fit, Loop, fit
from .planning import Plan, plan
from .push import Push, ball, of_shape
from .reading import Record, read
from .results import Wear, wear
from .runs import ContactFit, fit_contact
from .scars import Family, Scar, Split, family, fit_profile, fit_scar, split
from .series import Cycles, Result, analyse, cycles

__all__ = [
    "ContactFit", "Cycles", "Family", "Fit", "Loop", "Plan", "Push", "Record", "Result", "Scar", "Split", "Wear",
    "analyse", "ball", "cycles", "family", "fit", "fit_contact", "fit_profile", "fit_scar", "of_shape", "plan", "read",
    "split", "wear",
]  # fmt: skip
