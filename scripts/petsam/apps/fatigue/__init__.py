"""Lives, safety factors and short cracks from the stresses of a cycle: lives(files, constants). SI units.

spectrum    lives() of one cycle or of several, Lives: all that petsam-fatigue prints and draws
stresses    the stresses of a cycle, of a file of petsam-stress or of petsam.Contact.fatigue()
materials   constants of a material: units, ranges, files
strength    lives by Smith-Watson-Topper, Fatemi-Socie and Basquin, safety factors, damage of a spectrum
evaluation  both at all points of a cycle, and along the depth below a place
cracks      stress intensity of a short crack, thresholds, arrest
"""

from ...core.part import Part

PART = Part(
    __name__,
    names={"spectrum": ("Lives", "lives"), "": ("cracks", "evaluation", "materials", "strength", "stresses")},
    quiet=True,
    libraries=("numpy", "h5py", "matplotlib", "yaml"),
    see=("petsam", "petsam-stress", "petsam-plot", "petsam-study"),
    pictures={"pictures": ("lives",)},
    expressions={"strength": ("life_swt", "life_fatemi_socie", "life_basquin")},
)
__all__, __getattr__, __dir__ = PART.face()
