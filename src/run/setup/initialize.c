/* The start of the library. */
#include <petsam/private/elasticityimpl.h>
#include <petsam/private/lawimpl.h>

PetscErrorCode SamInitialize(void)
{
  PetscFunctionBegin;
  PetscCall(SamBaseInitialize());
  PetscCall(SamElasticityRegisterAll());
  PetscCall(SamLawRegisterAll());
  PetscFunctionReturn(PETSC_SUCCESS);
}
