/* The quantities of an evaluation, by the names, units and descriptions of their datasets. */
#include <petsam/private/quantities.h>

/* The normal of the plane where a parameter is maximum. */
#define NORMAL(name, quantity) \
  {{name "_normal_x", "1", "normal of the critical plane, x"}, quantity}, \
    {{name "_normal_y", "1", "normal of the critical plane, y"}, quantity}, \
  { \
    {name "_normal_z", "1", "normal of the critical plane, z"}, quantity \
  }

const SamDataset SamDatasets[SAM_DATASETS] = {
  {{"stress_xx", "Pa", "stress xx, tension positive"}, SAM_QUANTITY_STRESS},
  {{"stress_yy", "Pa", "stress yy"}, SAM_QUANTITY_STRESS},
  {{"stress_zz", "Pa", "stress zz, z points into the body"}, SAM_QUANTITY_STRESS},
  {{"stress_xy", "Pa", "stress xy"}, SAM_QUANTITY_STRESS},
  {{"stress_xz", "Pa", "stress xz"}, SAM_QUANTITY_STRESS},
  {{"stress_yz", "Pa", "stress yz"}, SAM_QUANTITY_STRESS},
  {{"mises", "Pa", "von Mises stress"}, SAM_QUANTITY_MISES},
  {{"principal_1", "Pa", "maximum principal stress"}, SAM_QUANTITY_PRINCIPAL},
  {{"principal_2", "Pa", "intermediate principal stress"}, SAM_QUANTITY_PRINCIPAL},
  {{"principal_3", "Pa", "minimum principal stress"}, SAM_QUANTITY_PRINCIPAL},
  {{"shear_max", "Pa", "maximum shear stress"}, SAM_QUANTITY_SHEAR_MAX},
  {{"strain_xx", "1", "strain xx"}, SAM_QUANTITY_STRAIN},
  {{"strain_yy", "1", "strain yy"}, SAM_QUANTITY_STRAIN},
  {{"strain_zz", "1", "strain zz"}, SAM_QUANTITY_STRAIN},
  {{"strain_xy", "1", "strain xy, tensor shear strain"}, SAM_QUANTITY_STRAIN},
  {{"strain_xz", "1", "strain xz, tensor shear strain"}, SAM_QUANTITY_STRAIN},
  {{"strain_yz", "1", "strain yz, tensor shear strain"}, SAM_QUANTITY_STRAIN},
  {{"crossland", "Pa", "Crossland's parameter of the cycle"}, SAM_QUANTITY_CROSSLAND},
  {{"dang_van", "Pa", "Dang Van's parameter of the cycle"}, SAM_QUANTITY_DANG_VAN},
  {{"findley", "Pa", "Findley's parameter of the cycle"}, SAM_QUANTITY_FINDLEY},
  NORMAL("findley", SAM_QUANTITY_FINDLEY),
  {{"swt", "Pa", "parameter of Smith, Watson and Topper of the cycle"}, SAM_QUANTITY_SWT},
  NORMAL("swt", SAM_QUANTITY_SWT),
  {{"fatemi_socie", "1", "parameter of Fatemi and Socie of the cycle"}, SAM_QUANTITY_FATEMI_SOCIE},
  NORMAL("fatemi_socie", SAM_QUANTITY_FATEMI_SOCIE),
  {{"ruiz_1", "J/m2", "Ruiz's first parameter of the cycle: frictional work"}, SAM_QUANTITY_RUIZ},
  {{"ruiz_2", "Pa J/m2", "Ruiz's second parameter of the cycle: tension times frictional work"}, SAM_QUANTITY_RUIZ},
};

PetscInt SamQuantityComponents(SamQuantity quantity)
{
  PetscInt count = 0;

  for (PetscInt d = 0; d < SAM_DATASETS; d++) count += SamDatasets[d].quantity == quantity;
  return count;
}

PetscInt SamDatasetOf(SamQuantity quantity)
{
  PetscInt k = 0;

  while (SamDatasets[k].quantity != quantity) k++;
  return k;
}

PetscBool SamQuantityIsOfCycle(SamQuantity quantity)
{
  return quantity >= SAM_QUANTITY_CROSSLAND;
}
