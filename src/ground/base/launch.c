/* Sets the environment of a process before MPI starts, and restores it. */
#include <petsam/private/baseimpl.h>
#include <stdlib.h>

#if defined(OPEN_MPI)
/* Settings for running without a network; concurrent programs would share a session's folder. */
static struct {
  const char *name, *value;
  PetscBool   set; /* set by this program, not by the user */
} alone[] = {{"OMPI_MCA_ess_singleton_isolated", "1", PETSC_FALSE},
             {"OMPI_MCA_orte_create_session_dirs", "0", PETSC_FALSE},
             {"OMPI_MCA_pml", "ob1", PETSC_FALSE},
             {"OMPI_MCA_btl", "self", PETSC_FALSE}};
enum { ALONE = sizeof(alone) / sizeof(alone[0]) };

static PetscBool IsLaunched(void)
{
  static const char *const signs[] = {
    "OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMIX_NAMESPACE", "PMI_RANK", "PMI_ID", "PMI_FD", "PMI_SIZE", "SLURM_STEP_ID",
    "ALPS_APP_PE",          NULL};

  for (int k = 0; signs[k]; k++)
    if (getenv(signs[k])) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool SamPrepareMPI(void)
{
  (void)setenv("OMPI_MCA_sharedfp", "^sm", 0); /* its semaphores fail if /dev/shm is full */
  if (IsLaunched()) return PETSC_TRUE;
  for (int k = 0; k < ALONE; k++) {
    alone[k].set = !getenv(alone[k].name);
    (void)setenv(alone[k].name, alone[k].value, 0);
  }
  return PETSC_FALSE;
}

void SamForgetPreparation(void)
{
  for (int k = 0; k < ALONE; k++) {
    if (alone[k].set) (void)unsetenv(alone[k].name);
    alone[k].set = PETSC_FALSE;
  }
}
#else
PetscBool SamPrepareMPI(void)
{
  return PETSC_TRUE;
}

void SamForgetPreparation(void) {}
#endif
