/*
  Stresses in a finite body: those of the half-space under the tractions, plus smooth parts from the file: the stresses
  by each c_j (compliance.c), and those of the load cases. The smooth parts are given at a coarse grid of points and
  interpolated linearly between these; beyond the grid in x and y they are constant.
*/
#include <petsam/private/compliance.h>
#include <petsam/private/elasticity.h>

typedef struct {
  SamElasticity bodies;
  SamCompliance c;
  double       *values; /* of SamComplianceReadStress() */
  SamStressOps  inner;  /* methods of the half-space */
} Below;

/* Computes the stresses at the points. In body 1's own frame, the tractions have the opposite sign. */
static PetscErrorCode Reduce(SamStress s, const double *const tractions[], double sums[])
{
  const Below *const  w    = (const Below *)s->smooth;
  const SamCompliance c    = w->c;
  const PetscInt      size = SamComplianceField(c);
  const double       *from = w->values + c->below[0] + c->below[1] + c->below[2];
  double              of[3][SAM_COMPLIANCE_MODES];

  PetscFunctionBegin;
  PetscCall(SamComplianceCollect(w->bodies, c, tractions, of));
  PetscCall(PetscArrayzero(sums, size));
  for (PetscInt n = 0; n < 3 * c->modes + c->cases; n++, from += size) {
    const PetscInt l      = n - 3 * c->modes;
    const double   factor = l < 0           ? (c->body ? 1 : -1) * of[n % 3][n / 3]
                            : s->conditions ? SamComplianceFactor(c, s->conditions, s->control, l)
                                            : 0;

    for (PetscInt k = 0; k < size && factor != 0; k++) sums[k] += factor * from[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the point before a place along an axis of n points, and the fraction of the way to the next point. */
static PetscInt Before(PetscInt n, const double axis[], double x, double *part)
{
  PetscInt k = 0;

  while (k + 2 < n && x >= axis[k + 1]) k++;
  *part = n > 1 ? PetscMin(PetscMax((x - axis[k]) / (axis[k + 1] - axis[k]), 0), 1) : 0;
  return k;
}

static void Add(SamStress s, const double sums[], const double first[3], const double step[2], PetscInt n,
                double *const stress[SAM_STRESS_COMPONENTS])
{
  const Below *const w       = (const Below *)s->smooth;
  const PetscInt    *points  = w->c->below;
  const double       turn    = w->c->body ? 1 : -1; /* sign of y in the body's own frame */
  const double      *axis[3] = {w->values, w->values + points[0], w->values + points[0] + points[1]};

  for (PetscInt i = 0; i < n; i++) {
    const double at[3] = {first[0] + (double)i * step[0], turn * (first[1] + (double)i * step[1]), first[2]};
    PetscInt     k[3];
    double       part[3];

    for (int d = 0; d < 3; d++) k[d] = Before(points[d], axis[d], at[d], &part[d]);
    for (int corner = 0; corner < 8; corner++) {
      PetscInt place  = 0;
      double   weight = 1;

      for (int d = 2; d >= 0; d--) {
        const int next = corner >> d & 1;

        place = place * points[d] + PetscMin(k[d] + next, points[d] - 1);
        weight *= next ? part[d] : 1 - part[d];
      }
      for (int a = 0; a < SAM_STRESS_COMPONENTS; a++)
        stress[a][i] +=
          weight * (a == SAM_STRESS_XY || a == SAM_STRESS_YZ ? turn : 1) * sums[place * SAM_STRESS_COMPONENTS + a];
    }
  }
}

static PetscErrorCode UseDepth(SamStress s, PetscReal depth)
{
  const Below *const w    = (const Below *)s->smooth;
  const PetscInt    *n    = w->c->below;
  const double       most = w->values[n[0] + n[1] + n[2] - 1];

  PetscFunctionBegin;
  PetscCheck(
    depth <= most * (1 + 1e-9), s->grid->comm, SAM_ERR_USER,
    "-depths %.6g: %s has stresses to a depth of %.6g m: expected at most that, or a file that petsam-compliance "
    "made with --depth %.3g",
    (double)depth, w->c->file, most, (double)depth);
  if (w->inner.usedepth) PetscCall((*w->inner.usedepth)(s, depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(SamStress s)
{
  Below *w = (Below *)s->smooth;

  PetscFunctionBegin;
  if (w->inner.destroy) PetscCall((*w->inner.destroy)(s));
  PetscCall(SamElasticityDestroy(&w->bodies));
  PetscCall(PetscFree(w->values));
  PetscCall(PetscFree(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamComplianceAddStress(SamElasticity e, SamCompliance c, SamStress s)
{
  Below *w;

  PetscFunctionBegin;
  PetscCall(PetscNew(&w));
  *w = (Below){.c = c, .inner = s->ops};
  PetscCall(SamElasticityReference(e));
  w->bodies       = e;
  s->smooth       = w;
  s->sums         = SamComplianceField(c);
  s->ops.reduce   = Reduce;
  s->ops.add      = Add;
  s->ops.usedepth = UseDepth;
  s->ops.destroy  = Destroy;
  PetscCall(PetscMalloc1(SamComplianceStresses(c), &w->values));
  PetscCall(SamComplianceReadStress(e->grid->comm, c, w->values));
  PetscFunctionReturn(PETSC_SUCCESS);
}
