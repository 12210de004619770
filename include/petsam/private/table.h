/* A table of numbers with named columns, read from text. */
#ifndef PETSAM_TABLE_H
#define PETSAM_TABLE_H

#include <petsam/private/baseimpl.h>
#include <string.h>

#define SAM_TABLE_COLUMNS 32
#define SAM_TABLE_NAME    32

typedef struct {
  PetscInt  columns, rows;
  char      name[SAM_TABLE_COLUMNS][SAM_TABLE_NAME];
  double   *value; /* (rows, columns) */
  PetscInt *line;  /* line in the file of each row, from 1 */
  PetscInt  header_line;
} SamTable;

/*
  SamTableRead - reads the table of an option (its name without dash) on rank 0 and gives it to all ranks. Collective.
  `names`: those of the columns that there may be, NULL at the end; the first one is required. Commas, semicolons or
  white space separate the fields, as they do in the first line, which names the columns; # begins a comment.
  Errors: SAM_ERR_FILE for a file that cannot be read, SAM_ERR_USER with file and line for wrong contents.
*/
PETSC_INTERN PetscErrorCode SamTableRead(MPI_Comm comm, const char option[], const char file[],
                                         const char *const names[], SamTable *table);
/*
  SamTableCreate - the same of numbers in memory, (rows, columns), which all ranks have; `header` names the columns,
  `what` stands for the file in messages, whose lines are the rows. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamTableCreate(MPI_Comm comm, const char what[], const char header[], PetscInt rows,
                                           const double values[], const char *const names[], SamTable *table);
PETSC_INTERN PetscErrorCode SamTableDestroy(SamTable *table);
/* The column of that name, or -1. */
PETSC_INTERN PetscInt SamTableFind(const SamTable *table, const char name[]);

#endif
