/* The inside of a contact in another program. */
#ifndef PETSAM_EMBEDIMPL_H
#define PETSAM_EMBEDIMPL_H

#include <petsam/embed.h>
#include <petsam/checkpoint.h>
#include <petsam/setup.h>
#include <petsam/stiffness.h>

enum { SAM_EMBED_USAGE = 2, SAM_EMBED_FILE = 3 };
#define SAM_EMBED_MESSAGE 1024

struct petsam_contact {
  MPI_Comm     comm;
  PetscOptions options; /* its own database */
  SamSetup     setup;
  SamWearLaws  laws;
  SamWear      wear;    /* NULL: none */
  SamControl   control; /* bulk stresses */
  SamStep      committed, last;
  PetscBool    has_committed, has_last; /* whether these hold numbers */
  PetscBool    has_tried;               /* a tried step */
  Vec          work;
  char         message[SAM_EMBED_MESSAGE];
};

/*
  SamEmbedStart - starts MPI and PETSc if nobody has. Returns 0, or 2 with a message. Not collective.
*/
PETSC_INTERN int SamEmbedStart(char message[], size_t size);

#endif
