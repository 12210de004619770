/* The operator and its preconditioner as PETSc's Mat and PC, by shells. */
#include <petsam/private/elasticityimpl.h>

/* Whether a field has the two components of shear. */
static PetscBool IsShear(SamElasticity e, Vec x)
{
  PetscInt size = 0;

  return !VecGetSize(x, &size) && size > e->grid->nx * e->grid->ny;
}

static PetscErrorCode Multiply(Mat mat, Vec x, Vec y)
{
  void *e;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(mat, &e));
  PetscCall(
    (IsShear((SamElasticity)e, x) ? SamElasticityApplyTangential : SamElasticityApplyNormal)((SamElasticity)e, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckComponents(SamElasticity e, PetscInt components)
{
  PetscFunctionBegin;
  PetscCheck(components == 1 || components == 2, e->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "One component for the normal part, two for the tangential one");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreateMat(SamElasticity e, PetscInt components, Mat *mat)
{
  const PetscInt m = components * e->grid->cells, M = components * e->grid->nx * e->grid->ny;

  PetscFunctionBegin;
  PetscCall(CheckComponents(e, components));
  PetscCall(MatCreateShell(e->grid->comm, m, m, M, M, e, mat));
  PetscCall(MatShellSetOperation(*mat, MATOP_MULT, (void (*)(void))Multiply));
  PetscCall(MatShellSetOperation(*mat, MATOP_MULT_TRANSPOSE, (void (*)(void))Multiply));
  PetscCall(MatSetOption(*mat, MAT_SYMMETRIC, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Precondition(PC pc, Vec x, Vec y)
{
  void *e;

  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &e));
  PetscCall((IsShear((SamElasticity)e, x) ? SamElasticityPreconditionTangential
                                          : SamElasticityPreconditionNormal)((SamElasticity)e, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreatePC(SamElasticity e, PetscInt components, PC *pc)
{
  PetscFunctionBegin;
  PetscCall(CheckComponents(e, components));
  PetscCall(PCCreate(e->grid->comm, pc));
  PetscCall(PCSetType(*pc, PCSHELL));
  PetscCall(PCShellSetContext(*pc, e));
  PetscCall(PCShellSetApply(*pc, Precondition));
  PetscFunctionReturn(PETSC_SUCCESS);
}
