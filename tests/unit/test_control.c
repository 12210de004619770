/*
 * Controls: the defaults, components by the names of their loads and displacements, and conditions by theirs.
 */
#include "contacts.h"

static void test_defaults_prescribe_no_load(void **state)
{
  SamControl control;

  (void)state;
  memset(&control, 0x55, sizeof(control));
  sam_call(SamControlInitialize(&control));
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) sam_assert(control.force[k] && control.value[k] == 0);
  sam_assert(control.time == 0);
  sam_assert(SamControlGet(&control, &(SamCondition){.usual = 7}) == 7);
}

/* A name changes only its component; of a load, its displacement and its creepage the later one counts. */
static void test_names_give_loads_displacements_or_creepages(void **state)
{
  (void)state;
  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    SamControl control;

    sam_call(SamControlInitialize(&control));
    sam_call(SamControlSet(&control, NULL, SamComponentNames[k].load, 2));
    sam_assert(control.force[k] && control.value[k] == 2);
    sam_call(SamControlSet(&control, NULL, SamComponentNames[k].rigid, 3));
    sam_assert(!control.force[k] && control.value[k] == 3);
    sam_assert(!SamComponentNames[k].creep ==
               (k != SAM_COMPONENT_TX && k != SAM_COMPONENT_TY && k != SAM_COMPONENT_MZ));
    if (SamComponentNames[k].creep) {
      sam_call(SamControlSet(&control, NULL, SamComponentNames[k].creep, 5));
      sam_assert(!control.force[k] && control.creep[k] && control.value[k] == 5);
    }
    for (PetscInt other = 0; other < SAM_COMPONENTS; other++)
      sam_assert(other == k || (control.force[other] && control.value[other] == 0));
    sam_call(SamControlSet(&control, NULL, SamComponentNames[k].load, 4));
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
  for (int k = 0; k < 6; k++) sam_fails(SamControlSet(&control, NULL, others[k], 1), PETSC_ERR_ARG_UNKNOWN_TYPE);
  sam_assert(!memcmp(&control, &before, sizeof(control)));
}

/* As many as load cases of several contacts may have, and more than there is room for. */
static void test_conditions_are_found_by_name_in_their_list_alone(void **state)
{
  SamConditions       one, other;
  const SamCondition *first, *same;
  SamControl          control;
  char                name[32];

  (void)state;
  sam_call(SamConditionsCreate(&one));
  sam_call(SamConditionsCreate(&other));
  sam_call(SamControlInitialize(&control));
  for (int k = 0; k < SAM_CONDITIONS; k++) {
    const SamCondition condition = {.name = name, .unit = "1", .text = "one of many", .usual = k};

    (void)snprintf(name, sizeof(name), "body1_case_%d", k);
    sam_call(SamConditionsAdd(one, &condition, NULL));
    if (k % 2) sam_call(SamControlSet(&control, one, name, -k));
  }
  for (int k = 0; k < SAM_CONDITIONS; k++) {
    (void)snprintf(name, sizeof(name), "body1_case_%d", k);
    sam_assert(SamControlGet(&control, SamConditionsFind(one, name)) == (k % 2 ? -k : k));
    sam_assert(!SamConditionsFind(other, name));
  }
  first = SamConditionsGet(one, 0);
  sam_call(SamConditionsAdd(one, first, &same));
  sam_assert(same == first && SamConditionsCount(one) == SAM_CONDITIONS);
  BeginCatching();
  sam_assert(SamConditionsAdd(one, &(SamCondition){.name = "last", .unit = "1", .text = ""}, NULL) ==
               PETSC_ERR_ARG_OUTOFRANGE &&
             strstr(CaughtMessage(), "last"));
  EndCatching();
  BeginCatching();
  sam_assert(SamControlSet(&control, one, "body1_csae_7", 1) == PETSC_ERR_ARG_UNKNOWN_TYPE &&
             strstr(CaughtMessage(), "is body1_case_7 meant?"));
  EndCatching();
  sam_call(SamConditionsDestroy(&one));
  sam_call(SamConditionsDestroy(&other));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_defaults_prescribe_no_load),
    cmocka_unit_test(test_names_give_loads_displacements_or_creepages),
    cmocka_unit_test(test_names_are_those_of_the_interface),
    cmocka_unit_test(test_other_names_are_refused),
    cmocka_unit_test(test_conditions_are_found_by_name_in_their_list_alone),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}
