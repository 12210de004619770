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
  `names`: the allowed names of columns, with NULL at the end; the first column is required. Commas, semicolons or white
  space separate the fields, also in the first line, which names the columns; # begins a comment.
  Errors: SAM_ERR_FILE for a file that cannot be read, SAM_ERR_USER with file and line for wrong contents.
*/
PETSC_INTERN PetscErrorCode SamTableRead(MPI_Comm comm, const char option[], const char file[],
                                         const char *const names[], SamTable *table);
/*
  SamTableCreate - creates a table from numbers in memory, (rows, columns), which all ranks have; `header` names the
  columns, `what` replaces the file in messages, which count rows as lines. Collective. Errors: SAM_ERR_USER.
*/
PETSC_INTERN PetscErrorCode SamTableCreate(MPI_Comm comm, const char what[], const char header[], PetscInt rows,
                                           const double values[], const char *const names[], SamTable *table);
PETSC_INTERN PetscErrorCode SamTableDestroy(SamTable *table);
/* SamTableCopy - creates a copy of a table. Not collective. */
PETSC_INTERN PetscErrorCode SamTableCopy(const SamTable *table, SamTable *copy);
/* SamTableFind - returns the column of that name, or -1. Not collective. */
PETSC_INTERN PetscInt SamTableFind(const SamTable *table, const char name[]);

#endif
