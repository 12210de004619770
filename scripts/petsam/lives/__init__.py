"""From the stresses of a cycle to lives, safety factors and short cracks: lives(files, constants). SI units.

spectrum    lives() of one cycle or of several, Lives: all that petsam-fatigue prints and draws
stresses    the stresses of a cycle, of a file of petsam-stress or of petsam.Contact.fatigue()
materials   constants of a material: units, ranges, files
strength    lives by Smith-Watson-Topper, Fatemi-Socie and Basquin, safety factors, damage of a spectrum
evaluation  both at all points of a cycle, and along the depth below a place
cracks      stress intensity of a short crack, thresholds, arrest
"""

from . import cracks, evaluation, materials, strength, stresses  # noqa: F401
from .spectrum import Lives, lives  # noqa: F401
