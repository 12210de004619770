"""From the stresses of a cycle to lives, safety factors and short cracks. SI units.

stresses    the stresses of a cycle, of a file of petsam-stress or of petsam.Contact.fatigue()
materials   constants of a material: units, ranges, files
strength    lives by Smith-Watson-Topper, Fatemi-Socie and Basquin, safety factors, damage of a spectrum
evaluation  both at all points of a cycle, and along the depth below a place
cracks      stress intensity of a short crack, thresholds, arrest
"""

from . import cracks, evaluation, materials, strength, stresses  # noqa: F401
