/* The operator and its preconditioner as PETSc's Mat and PC, by shells. */
#include <petsam/private/elasticityimpl.h>

static PetscErrorCode MatMult_Normal(Mat mat, Vec x, Vec y)
{
  void *e;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(mat, &e));
  PetscCall(SamElasticityApplyNormal((SamElasticity)e, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MatMult_Tangential(Mat mat, Vec x, Vec y)
{
  void *e;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(mat, &e));
  PetscCall(SamElasticityApplyTangential((SamElasticity)e, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreateMat(SamElasticity e, PetscInt components, Mat *mat)
{
  const PetscInt m = components * e->grid->cells, M = components * e->grid->nx * e->grid->ny;
  void (*product)(void) = components == 2 ? (void (*)(void))MatMult_Tangential : (void (*)(void))MatMult_Normal;

  PetscFunctionBegin;
  PetscCheck(components == 1 || components == 2, e->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "One component for the normal part, two for the tangential one");
  PetscCall(MatCreateShell(e->grid->comm, m, m, M, M, e, mat));
  PetscCall(MatShellSetOperation(*mat, MATOP_MULT, product));
  PetscCall(MatShellSetOperation(*mat, MATOP_MULT_TRANSPOSE, product));
  PetscCall(MatSetOption(*mat, MAT_SYMMETRIC, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PCApply_Normal(PC pc, Vec x, Vec y)
{
  void *e;

  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &e));
  PetscCall(SamElasticityPreconditionNormal((SamElasticity)e, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PCApply_Tangential(PC pc, Vec x, Vec y)
{
  void *e;

  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &e));
  PetscCall(SamElasticityPreconditionTangential((SamElasticity)e, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreatePC(SamElasticity e, PetscInt components, PC *pc)
{
  PetscFunctionBegin;
  PetscCheck(components == 1 || components == 2, e->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "One component for the normal part, two for the tangential one");
  PetscCall(PCCreate(e->grid->comm, pc));
  PetscCall(PCSetType(*pc, PCSHELL));
  PetscCall(PCShellSetContext(*pc, e));
  PetscCall(PCShellSetApply(*pc, components == 2 ? PCApply_Tangential : PCApply_Normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}
