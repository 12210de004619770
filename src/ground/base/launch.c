/* Sets the environment of a process before MPI starts, and restores it. */
#include <petsam/private/baseimpl.h>
#include <limits.h>
#include <stdlib.h>

/* Processes that the launcher has started, and the variable that states it; MPI_Init() may change it. */
static int         processes = 0;
static const char *stated_by = NULL;

static void NoteProcesses(void)
{
  static const struct {
    const char *name;
    int         more; /* processes besides its number: ranks are from 0 */
  } numbers[] = {{"OMPI_COMM_WORLD_SIZE", 0}, {"PMI_SIZE", 0},    {"PMIX_SIZE", 0}, {"SLURM_STEP_NUM_TASKS", 0},
                 {"MV2_COMM_WORLD_SIZE", 0},  {"PALS_NRANKS", 0}, {"PMIX_RANK", 1}, {"PMI_RANK", 1}};

  for (size_t k = 0; k < sizeof(numbers) / sizeof(numbers[0]) && !stated_by; k++) {
    const char *text  = getenv(numbers[k].name);
    const long  count = text ? strtol(text, NULL, 10) + numbers[k].more : 0;

    if (count <= 1 || count > INT_MAX) continue;
    processes = (int)count;
    stated_by = numbers[k].name;
  }
}

int SamFindCopies(const char **name)
{
  int ranks = 1;

  *name = stated_by;
  (void)MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return ranks == 1 ? processes : 0;
}

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
  NoteProcesses();
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
  NoteProcesses();
  return PETSC_TRUE;
}

void SamForgetPreparation(void) {}
#endif
