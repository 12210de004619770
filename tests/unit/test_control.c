/*
 * Controls: the defaults, and components by the names of their loads and displacements.
 */
#include "fields.h"

#include <petsam/control.h>

static void test_defaults_prescribe_no_load(void **state)
{
  SamControl control;

  (void)state;
  memset(&control, 0x55, sizeof(control));
  sam_call(SamControlInitialize(&control));
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) sam_assert(control.force[k] && control.value[k] == 0);
  sam_assert(control.time == 0 && control.friction_scale == 1);
  for (PetscInt k = 0; k < SAM_BULK_COMPONENTS; k++)
    sam_assert(control.bulk_stress[0][k] == 0 && control.bulk_stress[1][k] == 0);
}

/* A name changes only its component; of a load, its displacement and its creepage the later one counts. */
static void test_names_give_loads_displacements_or_creepages(void **state)
{
  (void)state;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    SamControl control, read = {0};
    double     packed[SAM_CONTROL_NUMBERS];

    sam_call(SamControlInitialize(&control));
    sam_call(SamControlSet(&control, SamComponentNames[k].load, 2));
    sam_assert(control.force[k] && control.value[k] == 2);
    sam_call(SamControlSet(&control, SamComponentNames[k].rigid, 3));
    sam_assert(!control.force[k] && control.value[k] == 3);
    sam_assert(!SamComponentNames[k].creep ==
               (k != SAM_COMPONENT_TX && k != SAM_COMPONENT_TY && k != SAM_COMPONENT_MZ));
    if (SamComponentNames[k].creep) {
      sam_call(SamControlSet(&control, SamComponentNames[k].creep, 5));
      sam_assert(!control.force[k] && control.creep[k] && control.value[k] == 5);
      SamControlPack(&control, packed);
      SamControlUnpack(packed, &read);
      sam_assert(!memcmp(&read, &control, sizeof(read)));
    }
    for (PetscInt other = 0; other < SAM_COMPONENTS; other++)
      sam_assert(other == k || (control.force[other] && control.value[other] == 0));
    sam_call(SamControlSet(&control, SamComponentNames[k].load, 4));
    sam_assert(control.force[k] && !control.creep[k] && control.value[k] == 4);
  }
}

/* The order in which the six stand everywhere, and which of them belong together. */
static void test_names_are_those_of_the_interface(void **state)
{
  static const char *const        loads[]  = {"load_n", "load_tx", "load_ty", "load_mx", "load_my", "load_mz"},
                           *const rigids[] = {"disp_z", "disp_x", "disp_y", "rot_x", "rot_y", "rot_z"};

  (void)state;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++)
    sam_assert(!strcmp(SamComponentNames[k].load, loads[k]) && !strcmp(SamComponentNames[k].rigid, rigids[k]));
}

static void test_other_names_are_refused(void **state)
{
  static const char *const others[] = {"load_x", "disp_n", "-load_n", "LOAD_N", "", "time"};
  SamControl               control, before;

  (void)state;
  memset(&control, 0, sizeof(control));
  sam_call(SamControlInitialize(&control));
  before = control;
  for (int k = 0; k < 6; k++) sam_fails(SamControlSet(&control, others[k], 1), PETSC_ERR_ARG_UNKNOWN_TYPE);
  sam_assert(!memcmp(&control, &before, sizeof(control)));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_defaults_prescribe_no_load),
    cmocka_unit_test(test_names_give_loads_displacements_or_creepages),
    cmocka_unit_test(test_names_are_those_of_the_interface),
    cmocka_unit_test(test_other_names_are_refused),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}
