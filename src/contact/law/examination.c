/* The texts of laws on the steps of a run that they examine. */
#include <petsam/private/examination.h>
#include <petsam/private/lawimpl.h>
#include <stdarg.h>

PetscErrorCode SamExaminationSay(SamExamination *x, const char setting[], const char format[], ...)
{
  char    text[SAM_MESSAGE];
  va_list values;

  PetscFunctionBegin;
  va_start(values, format);
  (void)vsnprintf(text, sizeof(text), format, values);
  va_end(values);
  PetscCall((*x->tell)(x->context, text, setting));
  PetscFunctionReturn(PETSC_SUCCESS);
}
