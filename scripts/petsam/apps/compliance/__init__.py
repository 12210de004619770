"""Compliance of real bodies for petsam's -body1_compliance and -body2_compliance: petsam-compliance.

    found = petsam.compliance.of_deck("block.inp", 2.2e-3, "TOP", supports="BOTTOM", units="mm")
    found.write("block.h5")
    petsam.plot.compliance(found)

of_deck       the Compliance of a CalculiX deck; of_mesh: of a meshio mesh (calls.py)
Bolt, Compliance, Settings   what they take and return (settings.py, result.py)

basis         polynomials on the patch
halfspace     fields of these as tractions on a half-space; halfplane: of a section's
shapes        elements of CalculiX
mesh          boundary, Gauss points, places of points
elements      linear elements raised to quadratic ones
mesherror     error by the mesh
deck          reading of CalculiX decks
foreign       meshes of meshio
boxes         sets by coordinates
section       sections in plane strain
points        nodes of a deck alone, of any analysis
stiffness     CalculiX's stiffness matrix, or assembled here
solve         one factorization
remainder     body minus half-space, by
  images      fields taken back on the other surfaces
  cutoff      half-space fields cut off about the patch
parts         the bodies of a mesh: one, or a pair
bolts         bolts of a pair
modes         its modes without contact
cases         load cases
stresses      stresses below the surface
checks        limits
model         all of it for one deck
writing       HDF5
"""

from ...core.part import Part

PART = Part(
    __name__,
    names={
        "calls": ("of_deck", "of_mesh"),
        "settings": ("Bolt", "Settings"),
        "result": ("Compliance",),
        "points": ("nodes_of",),
    },
    quiet=True,
    libraries=("numpy", "h5py", "matplotlib", "scipy"),
    see=("petsam", "petsam-stress"),
    pictures={"pictures": ("compliance",)},
)
__all__, __getattr__, __dir__ = PART.face()
