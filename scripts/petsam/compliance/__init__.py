"""Compliance of real bodies for petsam's -body1_compliance and -body2_compliance: petsam-compliance.

basis         polynomials on the patch
halfspace     fields of these as tractions on a half-space
shapes        elements of CalculiX
mesh          boundary, Gauss points, places of points
deck          reading of CalculiX decks
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
