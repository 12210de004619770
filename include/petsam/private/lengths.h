/* What an HDF5 dataset of lengths says about itself: their unit, whether they are heights, the size of the surface. */
#ifndef PETSAM_LENGTHS_H
#define PETSAM_LENGTHS_H

#include <petsam/base.h>
#include <hdf5.h>

#define SAM_LENGTHS_UNITS      "m, cm, mm, um, nm, pm, angstrom, in"
#define SAM_LENGTHS_QUANTITIES "separation, height1, height2"

typedef enum {
  SAM_LENGTHS_GOOD,
  SAM_LENGTHS_BAD_UNITS,
  SAM_LENGTHS_BAD_QUANTITY,
  SAM_LENGTHS_BAD_SIZE,    /* attribute size: other than two positive numbers */
  SAM_LENGTHS_PACKED,      /* attributes scale_factor, add_offset: whole numbers that stand for others */
  SAM_LENGTHS_FALLING_AXIS /* x or y falls along its dataset, so the surface would be mirrored */
} SamLengthsProblem;

/* SamLengths - the answer of SamLengthsRead(). */
typedef struct {
  SamLengthsProblem problem;
  char              name[8];  /* of the dataset or axis that the problem is with; empty: the dataset itself */
  char              text[48]; /* the attribute that is not understood */
  double            factor;   /* values times this are a separation in m */
  double            size[2];  /* full width in x and y (m); 0 where the file does not say */
} SamLengths;

/*
  SamLengthsRead - reads what a dataset of shape (ny, nx) says about itself; each part may be missing.

  Attribute units: a unit of length (m). Attribute quantity: separation, or height1, height2, heights of body 1 or 2,
  positive out of the body; so a peak of either body reduces the separation (separation). The size: attribute size of
  the dataset, two numbers in m; or else x and y beside the dataset, which hold the nx and ny cell centres and have
  units; without units they say nothing.

  Of HDF5's serial driver, on one rank. Not collective.
*/
PETSC_EXTERN void SamLengthsRead(hid_t file, hid_t dataset, const char name[], const hsize_t shape[2],
                                 SamLengths *lengths);

#endif
