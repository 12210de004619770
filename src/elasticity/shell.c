/* The compliance and its preconditioner as PETSc's Mat and PC, by shells. */
#include <petsam/private/elasticityimpl.h>

static PetscErrorCode MatMult_Normal(Mat mat, Vec x, Vec y)
{
  void *C;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(mat, &C));
  PetscCall(SamElasticityApplyNormal((SamElasticity)C, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MatMult_Tangential(Mat mat, Vec x, Vec y)
{
  void *C;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(mat, &C));
  PetscCall(SamElasticityApplyTangential((SamElasticity)C, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreateMat(SamElasticity C, PetscInt components, Mat *mat)
{
  const PetscInt m = components * C->grid->cells, M = components * C->grid->nx * C->grid->ny;
  void (*product)(void) = components == 2 ? (void (*)(void))MatMult_Tangential : (void (*)(void))MatMult_Normal;

  PetscFunctionBegin;
  PetscCheck(components == 1 || components == 2, C->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "One component for the normal part, two for the tangential one");
  PetscCall(MatCreateShell(C->grid->comm, m, m, M, M, C, mat));
  PetscCall(MatShellSetOperation(*mat, MATOP_MULT, product));
  PetscCall(MatShellSetOperation(*mat, MATOP_MULT_TRANSPOSE, product));
  PetscCall(MatSetOption(*mat, MAT_SYMMETRIC, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PCApply_Normal(PC pc, Vec x, Vec y)
{
  void *C;

  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &C));
  PetscCall(SamElasticityPreconditionNormal((SamElasticity)C, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PCApply_Tangential(PC pc, Vec x, Vec y)
{
  void *C;

  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &C));
  PetscCall(SamElasticityPreconditionTangential((SamElasticity)C, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamElasticityCreatePC(SamElasticity C, PetscInt components, PC *pc)
{
  PetscFunctionBegin;
  PetscCheck(components == 1 || components == 2, C->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "One component for the normal part, two for the tangential one");
  PetscCall(PCCreate(C->grid->comm, pc));
  PetscCall(PCSetType(*pc, PCSHELL));
  PetscCall(PCShellSetContext(*pc, C));
  PetscCall(PCShellSetApply(*pc, components == 2 ? PCApply_Tangential : PCApply_Normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}
