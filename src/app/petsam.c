/*
  The program petsam: a run (run.c) in the frame of program.c.

  Exit codes: 0 converged and checked; 2 bad usage; 3 a file cannot be used; 10 not converged; 11 no equilibrium; 12
  contact at the grid's edge; 75 stopped with a checkpoint; others are PETSc's. Nothing is written before all input has
  been read and checked.
*/
#include "program.h"
#include "runimpl.h"

enum { EXIT_STOPPED = 75 };

static const char usage[] =
  "petsam " PETSAM_VERSION ": partial-slip contact of elastic bodies by the semi-analytical method.\n"
  "\n"
  "  petsam [-option value ...]\n"
  "  mpirun -n 4 petsam -options_file study.opts [-option value ...]\n"
  "\n"
  "All quantities in SI units; defaults in parentheses. Required: -grid_n, -grid_size, -body1_young, -body1_poisson,\n"
  "-body2_young, -body2_poisson, -gap_type with its radii, and one of -load_n, -disp_z. For example, two steel "
  "spheres\n"
  "pressed together and pushed sideways:\n"
  "\n"
  "  petsam -grid_n 256 -grid_size 2.6e-3 -body1_young 210e9 -body1_poisson 0.3 -body2_young 210e9 \\\n"
  "    -body2_poisson 0.3 -gap_type sphere -gap_radius1 0.2 -gap_radius2 0.2 -friction 0.1 -load_n 1000 -load_tx 60 "
  "\\\n"
  "    -output sphere.h5\n"
  "\n"
  "Exit codes: 0 converged, 2 bad usage, 3 a file cannot be used, 10 not converged, 11 no equilibrium,\n"
  "12 contact at the grid's edge, 75 stopped with a checkpoint.\n";

static PetscErrorCode SetUp(void *context, const SamArguments *arguments)
{
  PetscFunctionBegin;
  PetscCall(SamRunSetUp((SamRun *)context, arguments));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Solve(void *context)
{
  PetscFunctionBegin;
  PetscCall(SamRunSolve((SamRun *)context));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TearDown(void *context)
{
  PetscFunctionBegin;
  PetscCall(SamRunTearDown((SamRun *)context));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int GetStatus(const void *context)
{
  const SamRun *run = (const SamRun *)context;

  return run->stopped ? EXIT_STOPPED : (int)run->point.worst;
}

static PetscBool IsWriting(const void *context)
{
  return ((const SamRun *)context)->writing;
}

/* Leaves no temporary file. */
static void Abandon(void *context)
{
  (void)SamCheckpointsDestroy(&((SamRun *)context)->checkpoints);
}

int main(int argc, char **argv)
{
  static SamRun    run;
  const SamProgram petsam = {.name     = "petsam",
                             .usage    = usage,
                             .topics   = SamPetsamTopics,
                             .prepare  = SamHistoryClaimOption,
                             .setup    = SetUp,
                             .run      = Solve,
                             .teardown = TearDown,
                             .status   = GetStatus,
                             .writing  = IsWriting,
                             .abandon  = Abandon,
                             .context  = &run};

  return SamProgramMain(&petsam, argc, argv);
}
