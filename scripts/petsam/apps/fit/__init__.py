"""Friction, rig stiffness, coefficients of wear and other parameters from measured loops; what loops a test needs.

    shape = petsam.fit.of_shape("sphere.opts", normal=100)
    loops = petsam.fit.cycles(petsam.fit.read("loops.csv"), normal=100)
    found = petsam.fit.analyse([loops], [shape])
    print(found.friction, found.friction_sd, found.rig_stiffness)
    petsam.plot.fit(found).savefig("fit.png")

reading     read(): a laboratory's file
push        of_shape(), ball(): the displacement of one push, which serves all coefficients of friction
loop        a Loop, and the Fit of loops; problem: the model of a loop, its parameters and residuals
loops       fit(): parameters of loops, their ranges, and what the loops do not hold
cutting     cycles(): cycles of a record, without drift
series      analyse(): cycles one by one and together (together.py); peaks: of records without loops
planning    plan(): how well which strokes would give the friction
runs        fit_contact(): parameters of any contact from numbers of its history, by full runs
families    family(): the scars of a contact over its cycles
scars       fit_profile(), fit_scar(), split(): the coefficients of wear from the profile of a scar
results     what the command prints and writes; wear() from a volume
"""

from ...core.part import Part

PART = Part(
    __name__,
    names={
        "reading": ("Record", "read"),
        "push": ("Push", "ball", "of_shape"),
        "loop": ("Fit", "Loop"),
        "loops": ("fit",),
        "cutting": ("Cycles", "cycles"),
        "series": ("Result", "analyse"),
        "planning": ("Plan", "plan"),
        "runs": ("ContactFit", "fit_contact"),
        "families": ("Family", "family"),
        "scars": ("Scar", "Split", "fit_profile", "fit_scar", "split"),
        "results": ("Wear", "wear"),
    },
    quiet=True,
    libraries=("numpy", "h5py", "matplotlib", "scipy"),
    pictures={"pictures": ("fit", "scar_fit")},
)
__all__, __getattr__, __dir__ = PART.face()
