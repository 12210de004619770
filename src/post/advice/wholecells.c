/* The area of a contact whose edge is not reconstructed: it is that of whole cells. */
#include "adviceimpl.h"
#include <petsam/private/contact.h>
#include <petsam/private/problemimpl.h>

PetscBool SamAdviceCountsCells(SamAdvice *a)
{
  PetscReal accepted = 1;

  if (a->error || !SamGridIsRow(a->setup->grid) || !SamProblemYields(a->setup->problem)) return PETSC_FALSE;
  a->error = SamContactGetNumber(a->setup->contact, "edge_accepted", &accepted);
  return !a->error && accepted < SAM_ADVICE_KNOWN ? PETSC_TRUE : PETSC_FALSE;
}

/* Advises on the area of a row of few cells after the largest load. */
void SamAdviceUnloaded(SamAdvice *a)
{
  PetscReal cells = 0;

  if (!SamAdviceCountsCells(a) || a->extent.across < SAM_ADVICE_CELLS) return;
  a->error = SamContactGetNumber(a->setup->contact, "contact_cells", &cells);
  if (a->error || !(cells > 0 && cells < SAM_ADVICE_CELLS)) return;
  SamDoubtsAdd(&a->doubts, SAM_CAUSE_CELLS, 1 / (double)cells, SAM_ADVICE_CELLS / (double)cells, "contact_area",
               "the contact of the last step is %.0f whole cells across", (double)cells);
}
