/* The functions of petsam/creep.h with external linkage, for programs in Fortran and other languages */
#define PETSAM_CREEP_EXTERNAL
#include <petsam/creep.h>
