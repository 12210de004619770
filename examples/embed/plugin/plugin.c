/* What petsam calls when it loads a plugin, by -plugin: registers the types by their names. */
#include "plugin.h"

PetscErrorCode SamPluginRegister(void);

PetscErrorCode SamPluginRegister(void)
{
  PetscCall(SamLawRegister("fading", CreateFading));
  PetscCall(SamLawRegister("swelling", CreateSwelling));
  PetscCall(SamElasticityRegister("coated", CreateCoated));
  PetscCall(SamGapRegister("cone", CreateCone));
  PetscCall(SamNormalRegister("spectral", CreateSpectral));
  PetscCall(RegisterShearNorm());
  return 0;
}
