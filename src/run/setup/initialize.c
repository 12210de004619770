/* The start of the library. */
#include <petsam/private/lawimpl.h>

PetscErrorCode SamInitialize(void)
{
  PetscFunctionBegin;
  PetscCall(SamBaseInitialize());
  PetscCall(SamLawRegisterAll());
  PetscFunctionReturn(PETSC_SUCCESS);
}
