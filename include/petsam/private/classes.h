/*
  Validation of arguments. Each public function that returns a PetscErrorCode checks its handles, fields and pointers
  directly after PetscFunctionBegin. PETSc's own macros do nothing in builds without debugging; these always check.
*/
#ifndef PETSAM_CLASSES_H
#define PETSAM_CLASSES_H

#include <petscvec.h>

/*
  SamClassId - the class of an object: the first member of each struct behind a public handle, set when the object is
  created, and set to SAM_CLASSID_NONE before it is freed. The class of a solver is that of its kind.
*/
typedef int SamClassId; /* SamGrid's struct is public, and has an int */
enum {
  SAM_CLASSID_NONE = 0,
  SamBody_CLASSID  = 0x53414d01, /* numbers that other memory hardly contains */
  SamPair_CLASSID,
  SamGrid_CLASSID,
  SamGap_CLASSID,
  SamElasticity_CLASSID,
  SamConditions_CLASSID,
  SamState_CLASSID,
  SamLaw_CLASSID,
  SamProblem_CLASSID,
  SamSolver_CLASSID, /* either of the next two; no object has it */
  SamNormal_CLASSID,
  SamTangential_CLASSID,
  SamContact_CLASSID
};

/* SamIsOfClass - returns true if an object, which is not NULL, is of a class. Not collective. */
static inline PetscBool SamIsOfClass(const void *object, SamClassId id)
{
  const SamClassId own = *(const SamClassId *)object;

  if (id == SamSolver_CLASSID && (own == SamNormal_CLASSID || own == SamTangential_CLASSID)) return PETSC_TRUE;
  return own == id ? PETSC_TRUE : PETSC_FALSE;
}

/* SamValidPointer - raises PETSC_ERR_ARG_NULL if a pointer, the argument of this number, is NULL. */
#define SamValidPointer(pointer, argument) \
  PetscCheck((pointer) != NULL, PETSC_COMM_SELF, PETSC_ERR_ARG_NULL, "Null pointer: argument # %d", argument)

/*
  SamValidHandle - raises PETSC_ERR_ARG_NULL if a handle is NULL, and PETSC_ERR_ARG_WRONG unless it is an object of the
  class `type`, as SamGrid. SamValidVec does the same for a vector.
*/
#define SamValidHandle(handle, type, argument) \
  do { \
    PetscCheck((handle) != NULL, PETSC_COMM_SELF, PETSC_ERR_ARG_NULL, "Null " #type ": argument # %d", argument); \
    PetscCheck(SamIsOfClass(handle, type##_CLASSID), PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, \
               "Argument # %d is not a " #type ", or it has been destroyed", argument); \
  } while (0)
#define SamValidVec(vector, argument) \
  do { \
    PetscClassId vector_id; \
\
    PetscCheck((vector) != NULL, PETSC_COMM_SELF, PETSC_ERR_ARG_NULL, "Null Vec: argument # %d", argument); \
    PetscCall(PetscObjectGetClassId((PetscObject)(vector), &vector_id)); \
    PetscCheck(vector_id == VEC_CLASSID, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, \
               "Argument # %d is not a Vec, or it has been destroyed", argument); \
  } while (0)

/*
  SamValidSameComm - raises PETSC_ERR_ARG_NOTSAMECOMM unless two arguments, given by their communicators and numbers,
  are on the same ranks in the same order. The library duplicates communicators, so that these need not be identical.
  The comparison is local: each rank on which the communicators differ fails, and none waits for the others.
  SamValidVecOn does the same for a vector and the communicator of an object.
*/
#define SamValidSameComm(comm, argument, other, other_argument) \
  do { \
    int compared; \
\
    PetscCallMPI(MPI_Comm_compare(comm, other, &compared)); \
    PetscCheck(compared == MPI_IDENT || compared == MPI_CONGRUENT, PETSC_COMM_SELF, PETSC_ERR_ARG_NOTSAMECOMM, \
               "Different communicators: arguments # %d and # %d", argument, other_argument); \
  } while (0)
#define SamValidVecOn(comm, argument, vector, vector_argument) \
  SamValidSameComm(comm, argument, PetscObjectComm((PetscObject)(vector)), vector_argument)

#endif
