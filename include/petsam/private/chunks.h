/* Where the data of an HDF5 dataset lie in their file. */
#ifndef PETSAM_CHUNKS_H
#define PETSAM_CHUNKS_H

#include <petsam/base.h>
#include <hdf5.h>

#define SAM_CHUNK_RANK 3 /* most dimensions of a dataset */

/*
  SamChunkVisitor - is told where the bytes of a chunk lie; HADDR_UNDEF: none have been written. Returns whether to go
  on.
*/
typedef PetscBool (*SamChunkVisitor)(haddr_t address, hsize_t bytes, void *context);
/*
  SamChunksVisit - visits the chunks that hold the first `extent` places in each dimension; extent NULL: all of the
  dataset, of the number of dimensions given. Returns false if the dataset is not so, or the visitor stopped. Of HDF5's
  serial driver, on one rank. Not collective.
*/
PETSC_EXTERN PetscBool SamChunksVisit(hid_t dataset, int rank, const hsize_t extent[], SamChunkVisitor visitor,
                                      void *context);
/*
  SamChunksAreWhole - whether these chunks lie within the file; in a damaged one they may be anywhere. `every`: all of
  them must have been written. Of the serial driver, on one rank. Not collective.
*/
PETSC_EXTERN PetscBool SamChunksAreWhole(hid_t file, hid_t dataset, int rank, const hsize_t extent[], PetscBool every);

#endif
