/*
  The functions of petsam/creep.h with external linkage, for programs that load the library, such as petsam.wheel.
*/
#pragma GCC diagnostic ignored "-Wmissing-prototypes" /* the header defines them without */
#define PETSAM_CREEP_EXTERNAL
#include <petsam/creep.h>
