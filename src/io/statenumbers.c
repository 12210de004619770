/* The numbers of a contact's state, as attributes of a file's root group. */
#include "ioimpl.h"

#define NUMBERS 37 /* numbers of a solution: control, loads, rigid displacements, passes of the corrections */

static void PackSolution(const SamSolution *s, double numbers[NUMBERS])
{
  double *n = numbers;

  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    *n++ = s->control.force[k] ? 1 : 0;
    *n++ = s->control.value[k];
    *n++ = s->load[k];
    *n++ = s->rigid[k];
  }
  *n++ = s->control.time;
  *n++ = s->control.friction_scale;
  for (PetscInt body = 0; body < 2; body++)
    for (PetscInt k = 0; k < SAM_BULK_COMPONENTS; k++) *n++ = s->control.bulk_stress[body][k];
  *n++ = (double)s->passes;
  *n++ = (double)s->sheared.passes;
  *n++ = s->sheared.has ? 1 : 0;
  *n++ = s->sheared.within.refers ? 1 : 0;
  *n++ = (double)s->sheared.slack;
}

static void UnpackSolution(const double numbers[NUMBERS], SamSolution *s)
{
  const double *n = numbers;

  for (PetscInt k = 0; k < SAM_COMPONENTS; k++) {
    s->control.force[k] = *n++ != 0;
    s->control.value[k] = *n++;
    s->load[k]          = *n++;
    s->rigid[k]         = *n++;
  }
  s->control.time           = *n++;
  s->control.friction_scale = *n++;
  for (PetscInt body = 0; body < 2; body++)
    for (PetscInt k = 0; k < SAM_BULK_COMPONENTS; k++) s->control.bulk_stress[body][k] = *n++;
  s->passes                = (PetscInt)*n++;
  s->sheared.passes        = (PetscInt)*n++;
  s->sheared.has           = *n++ != 0;
  s->sheared.within.refers = *n++ != 0;
  s->sheared.slack         = (SamSlack)*n++;
}

void SamFileWriteState(SamFile f, const SamContactState *s)
{
  const int64_t window[4] = {s->window_first[0], s->window_first[1], s->window_n[0], s->window_n[1]}, steps = s->steps;
  const int8_t  current = s->gap_is_current ? 1 : 0;
  double        numbers[NUMBERS];

  SamFileWriteAttribute(f, f->id, "contact_steps", H5T_STD_I64LE, H5T_NATIVE_INT64, 1, &steps);
  SamFileWriteAttribute(f, f->id, "contact_window", H5T_STD_I64LE, H5T_NATIVE_INT64, 4, window);
  SamFileWriteAttribute(f, f->id, "contact_gap_is_current", H5T_STD_I8LE, H5T_NATIVE_INT8, 1, &current);
  PackSolution(&s->now, numbers);
  SamFileWriteAttribute(f, f->id, "contact_now", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, NUMBERS, numbers);
  PackSolution(&s->plain, numbers);
  SamFileWriteAttribute(f, f->id, "contact_plain", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, NUMBERS, numbers);
  PackSolution(&s->before, numbers);
  SamFileWriteAttribute(f, f->id, "contact_before", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, NUMBERS, numbers);
}

void SamFileReadState(SamFile f, SamContactState *s)
{
  int64_t window[4] = {0}, steps = 0;
  int8_t  current          = 0;
  double  numbers[NUMBERS] = {0};

  SamFileReadAttribute(f, f->id, "contact_steps", H5T_NATIVE_INT64, 1, &steps);
  SamFileReadAttribute(f, f->id, "contact_window", H5T_NATIVE_INT64, 4, window);
  SamFileReadAttribute(f, f->id, "contact_gap_is_current", H5T_NATIVE_INT8, 1, &current);
  SamFileReadAttribute(f, f->id, "contact_now", H5T_NATIVE_DOUBLE, NUMBERS, numbers);
  UnpackSolution(numbers, &s->now);
  SamFileReadAttribute(f, f->id, "contact_plain", H5T_NATIVE_DOUBLE, NUMBERS, numbers);
  UnpackSolution(numbers, &s->plain);
  SamFileReadAttribute(f, f->id, "contact_before", H5T_NATIVE_DOUBLE, NUMBERS, numbers);
  UnpackSolution(numbers, &s->before);
  s->steps          = (PetscInt)steps;
  s->gap_is_current = current ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt k = 0; k < 2; k++) {
    s->window_first[k] = (PetscInt)window[k];
    s->window_n[k]     = (PetscInt)window[k + 2];
  }
}
