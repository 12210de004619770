/*
  Deferred correction of the pressure for the edge of contact.

  The solvers take the pressure as constant in each cell. Where the pressure vanishes like the square root of the
  distance from the edge, the error of the displacements is of first order in cell size, in a layer of two cells. So,
  once the uncorrected problem S p + h = d is solved:
    1. From p follow the pressure within the cells along the edge, and the cells that the edge cuts (edges/profile.c).
    2. The displacement c by this pressure, minus that by the means, is added to the gap. Cut cells whose centre lies
       outside, the rim, bear the given means r; their gaps are open, or they bear more.
    3. S (p + r) + h + c = d is solved for p, starting from the last p, under the loads minus those of r.
  Two correction iterations leave a twentieth to a fiftieth of the error. The rest comes from the size of the sub-cells.

  The correction supports edges that are smooth and resolved. Others lack the layer, and the uncorrected solution stays.
  With friction the correction is rejected: an uncorrected shear, bounded by the corrected pressure, is less accurate
  than with the uncorrected pressure, as the errors of p and q of the same operator cancel.
*/
#include "edgesimpl.h"
#include <petsam/private/lawimpl.h>

/* The least share of an edge that must be smooth and resolved for its correction. */
#define SMOOTH 0.95

#define CORRECTION "edge_correction" /* m: part of u_z by what the pressure does within cells */
#define RIM        "edge_rim"        /* Pa: pressure of cells that the edge cuts and whose centre is not in contact */
#define PASSES     "edge_passes"

typedef struct {
  PetscInt   passes;  /* that are to be made */
  SamProfile profile; /* NULL until needed */
} Deferred;

/* The passes of a step. */
typedef struct {
  SamLaw         law;
  SamCorrection *c;
  SamProfile     profile;
  Vec            correction, rim; /* of the tried state */
  Vec            h;               /* the corrected separation */
  Vec            plain;           /* uncorrected pressure */
  SamBalance     balance;         /* of it */
} Work;

/* ---- the law ---- */

PetscErrorCode SamLawSetEdgePasses(SamLaw law, PetscInt passes)
{
  PetscFunctionBegin;
  PetscCheck(!strcmp(law->type, SAM_LAW_DEFERRED), law->grid->comm, PETSC_ERR_ARG_WRONG,
             "The law %s has no correction of edges", law->type);
  PetscCheck(passes > 0, law->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "passes for the edge = %" PetscInt_FMT ": expected at least 1", passes);
  ((Deferred *)law->data)->passes = passes;
  law->revision++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetFromOptions(SamLaw law, const SamOptions *from, PetscBool *asked)
{
  Deferred *const d        = (Deferred *)law->data;
  char            word[16] = "";

  PetscFunctionBegin;
  PetscCall(
    PetscOptionsGetString(NULL, from->prefix, "-edges", word, sizeof(word), NULL)); /* the contact's, checked there */
  PetscCall(SamOptionsHeading(from, "Correction for the edge of contact"));
  PetscCall(SamOptionsInt(from, "edges_passes", "correction passes of -edges deferred", 1, &d->passes, NULL));
  *asked = !strcmp(word, "deferred");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Declare(SamLaw law, SamState state)
{
  static const SamStateField  field[] = {{.name = CORRECTION, .components = 1, .generations = 2, .kept = PETSC_TRUE},
                                         {.name = RIM, .components = 1, .generations = 2, .kept = PETSC_TRUE}};
  static const SamStateNumber passes  = {
     PASSES, "1", "correction passes for the edge of contact, 0 for none", SAM_NUMBER_INT, 1, PETSC_TRUE, PETSC_TRUE};
  PetscInt id;

  PetscFunctionBegin;
  (void)law;
  for (int k = 0; k < 2; k++) PetscCall(SamStateDeclareField(state, &field[k], &id));
  PetscCall(SamStateDeclareNumber(state, &passes, &id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A field of a state whose last solution is corrected; else NULL. */
static Vec Read(SamState state, const char name[])
{
  const PetscInt passes = SamStateFindNumber(state, PASSES);

  return passes >= 0 && *SamStateReadNumbers(state, passes) > 0
           ? SamStateReadField(state, SamStateFindField(state, name))
           : NULL;
}

static PetscErrorCode Displace(SamLaw law, SamState state, Vec u_z)
{
  const Vec correction = Read(state, CORRECTION);

  PetscFunctionBegin;
  (void)law;
  if (correction) PetscCall(VecAXPY(u_z, 1, correction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Least(SamLaw law, SamState state, Vec *least)
{
  PetscFunctionBegin;
  (void)law;
  *least = Read(state, RIM);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetProfile(SamLaw law, SamProfile *profile)
{
  Deferred *const d = (Deferred *)law->data;

  PetscFunctionBegin;
  if (!d->profile) PetscCall(SamProfileCreate(law->elasticity, &d->profile));
  *profile = d->profile;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Edge(SamLaw law, SamState state, Vec pressure, Vec point, SamEdge *edge, PetscBool *found)
{
  const Vec  rim     = Read(state, RIM);
  SamProfile profile = NULL;
  PetscBool  matched;

  PetscFunctionBegin;
  if (!rim) PetscFunctionReturn(PETSC_SUCCESS);
  *found = PETSC_TRUE;
  PetscCall(GetProfile(law, &profile));
  PetscCall(SamProfileMatch(profile, pressure, rim, &matched));
  PetscCall(SamProfileGetEdge(profile, point, edge));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the passes ---- */

static PetscErrorCode Begin(SamLaw law, SamCorrection *c, Work *w)
{
  PetscFunctionBegin;
  *w = (Work){.law = law, .c = c, .balance = c->found};
  PetscCall(GetProfile(law, &w->profile));
  PetscCall(SamGridCreateVec(law->grid, 1, &w->h));
  PetscCall(SamGridCreateVec(law->grid, 1, &w->plain));
  PetscCall(SamStateSetField(c->state, SamStateFindField(c->state, CORRECTION), &w->correction));
  PetscCall(SamStateSetField(c->state, SamStateFindField(c->state, RIM), &w->rim));
  PetscCall(SamVecCopyNonzero(c->pressure, w->plain));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode End(Work *w)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&w->h));
  PetscCall(VecDestroy(&w->plain));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The uncorrected solution stays, with a message that gives the reason. */
static PetscErrorCode GiveUp(Work *w, const char why[])
{
  PetscFunctionBegin;
  PetscCall(SamVecCopyNonzero(w->plain, w->c->pressure));
  w->c->found = w->balance;
  PetscCall(PetscSNPrintf(w->c->message, w->c->size, "the edge of contact is not corrected: %s", why));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The separation of step 2, and where the pressure starts: that of the last pass in the zone. */
static PetscErrorCode Prepare(Work *w)
{
  const double *in;
  double       *p;
  Vec           zone, rim;

  PetscFunctionBegin;
  PetscCall(SamProfileGetZone(w->profile, &zone, &rim));
  PetscCall(VecCopy(rim, w->rim));
  PetscCall(SamProfileComputeDisplacement(w->profile, w->correction));
  PetscCall(SamElasticityApplyNormal(w->law->elasticity, rim, w->h));
  PetscCall(VecAXPY(w->h, 1, w->correction));
  PetscCall(VecAXPY(w->h, 1, w->c->separation));
  PetscCall(VecGetArrayRead(zone, &in));
  PetscCall(VecGetArray(w->c->pressure, &p));
  for (PetscInt k = 0; k < w->law->grid->cells; k++) p[k] = in[k] > 0 ? p[k] : 0;
  PetscCall(VecRestoreArray(w->c->pressure, &p));
  PetscCall(VecRestoreArrayRead(zone, &in));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Step 3. */
static PetscErrorCode SolveAgain(Work *w)
{
  SamCorrection *c       = w->c;
  SamBalance     balance = c->given;
  PetscReal      borne[3];
  PetscInt       counts[3];

  PetscFunctionBegin;
  PetscCall(SamBalanceGetLoads(w->law->grid, SAM_BALANCE_NORMAL, w->rim, borne));
  for (PetscInt k = 0; k < 3; k++) {
    balance.load[k] -= balance.force[k] ? borne[k] : 0;
    if (balance.force[k]) balance.rigid[k] = c->found.rigid[k];
  }
  PetscCall(SamNormalSolve(c->normal, w->h, &balance, PETSC_TRUE, c->pressure));
  PetscCall(VecAXPY(c->pressure, 1, w->rim));
  for (PetscInt k = 0; k < 3; k++) balance.load[k] = balance.force[k] ? c->given.load[k] : balance.load[k] + borne[k];
  c->found = balance;
  PetscCall(SamSolverGetStatistics(SamNormalAsSolver(c->normal), NULL, &counts[0], &counts[1], &counts[2]));
  for (PetscInt k = 0; k < 3; k++) c->counts[k] += counts[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One pass; `why` is empty while all is well. */
static PetscErrorCode Pass(Work *w, PetscInt pass, char why[], size_t size)
{
  PetscBool       found = PETSC_TRUE;
  SamSolverReason reason;

  PetscFunctionBegin;
  PetscCall(PetscLogEventBegin(SamEvents[SAM_EVENT_EDGES], 0, 0, 0, 0));
  if (pass > 1) PetscCall(SamProfileMatch(w->profile, w->c->pressure, w->rim, &found));
  if (found) PetscCall(SamProfileMove(w->profile, &found));
  if (found) PetscCall(Prepare(w));
  PetscCall(PetscLogEventEnd(SamEvents[SAM_EVENT_EDGES], 0, 0, 0, 0));
  if (!found) {
    PetscCall(PetscStrncpy(why, "there are too few cells along it", size));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SolveAgain(w));
  PetscCall(SamSolverGetReason(SamNormalAsSolver(w->c->normal), &reason));
  if (reason < 0)
    PetscCall(PetscSNPrintf(why, size, "the corrected problem did not converge (%s)", SamSolverReasonName(reason)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All passes, of which `made` are made; 0: the solution is not corrected. */
static PetscErrorCode MakePasses(Work *w, PetscInt *made)
{
  const Deferred     *d       = (const Deferred *)w->law->data;
  char                why[96] = "";
  SamElasticityTraits traits;
  PetscBool           found;
  SamEdge             edge = {.faces = 0};

  PetscFunctionBegin;
  *made = 0;
  PetscCall(SamElasticityGetTraits(w->law->elasticity, &traits));
  if (!traits.within)
    PetscCall(
      PetscStrncpy(why, "it is supported for -elasticity halfspace, on layers of 8 cells at least", sizeof(why)));
  else
    PetscCall(SamProfileStart(w->profile, w->c->pressure, &edge, &found));
  if (edge.smooth < SMOOTH * edge.faces)
    PetscCall(PetscSNPrintf(why, sizeof(why), "%.3g %% of it is smooth and resolved, %.0f %% needed: use a finer grid",
                            100 * (double)(edge.smooth / edge.faces), 100 * SMOOTH));
  for (PetscInt pass = 1; pass <= d->passes && !why[0] && edge.faces > 0; pass++) {
    PetscCall(Pass(w, pass, why, sizeof(why)));
    *made = pass;
  }
  if (why[0]) PetscCall(GiveUp(w, why));
  if (why[0]) *made = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Correct(SamLaw law, SamCorrection *c)
{
  const PetscInt id     = SamStateFindNumber(c->state, PASSES);
  double *const  passes = SamStateNumbers(c->state, id, SAM_TRIED);
  PetscInt       made   = 0;
  Work           w;

  PetscFunctionBegin;
  if (c->same_pressure) {
    *passes = *SamStateNumbers(c->state, id, SAM_COMMITTED);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(Begin(law, c, &w));
  PetscCall(MakePasses(&w, &made));
  PetscCall(End(&w));
  *passes = (double)made;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the elastic energy ---- */

/*
  The contribution of the pressure's variation within cells to the elastic energy of a corrected solution.

  The energy is a sum over cells of half the mean pressure times the displacement at the centre. The integral over a
  cell of p u, p having the mean p0 and the slopes m, u the gradient g and second differences d over a cell, is
    p0 u + (m_x g_x + m_y g_y)/12 + p0 (d_xx + d_yy)/24
  to fourth order in cell size. In the uncorrected solution the error of the pressure makes up for these terms; a
  corrected solution lacks them.
*/
/* These terms of a cell, over its area, but for p0 u; none at the border of the grid. */
static double TermsOf(const SamRows *rows, const double u[], PetscInt i, PetscInt j, double mean, const double slope[2])
{
  const PetscInt nx = rows->grid->nx;
  const double  *v  = u + (ptrdiff_t)j * nx + i;

  if (i < 1 || i + 1 >= nx || j < 1 || j + 1 >= rows->count) return 0;
  return (slope[0] * (v[1] - v[-1]) + slope[1] * (v[nx] - v[-nx])) / 24 +
         mean * (v[1] + v[-1] + v[nx] + v[-nx] - 4 * v[0]) / 24;
}

/* The sum of the terms of all cells, for a pressure with these slopes and a displacement. */
static PetscErrorCode SumTerms(SamGrid grid, Vec pressure, Vec slopes, Vec u_z, double *sum)
{
  SamTotal      total = {0};
  SamSeen       u;
  const double *p, *m;

  PetscFunctionBegin;
  PetscCall(SamSee(grid, u_z, 1, 1, &u));
  PetscCall(VecGetArrayRead(pressure, &p));
  PetscCall(VecGetArrayRead(slopes, &m));
  for (PetscInt j = 0; j < grid->rows; j++) {
    double row = 0;

    for (PetscInt i = 0; i < grid->nx; i++) {
      const PetscInt k = j * grid->nx + i;

      if (p[k] > 0)
        row +=
          TermsOf(&u.rows, u.at[0], i, grid->row_start + j - u.rows.first, p[k], (double[]){m[k], m[k + grid->cells]});
    }
    SamAdd(&total, row);
  }
  PetscCall(VecRestoreArrayRead(slopes, &m));
  PetscCall(VecRestoreArrayRead(pressure, &p));
  PetscCall(SamForget(&u));
  PetscCall(SamSumTotals(grid->comm, 1, &total, sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Energy(SamLaw law, SamState state, Vec pressure, Vec u_z, PetscReal *energy)
{
  const Vec  rim     = Read(state, RIM);
  SamProfile profile = NULL;
  PetscBool  found;
  double     sum;
  Vec        slopes;

  PetscFunctionBegin;
  if (!rim) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamGridCreateVec(law->grid, 2, &slopes));
  PetscCall(GetProfile(law, &profile));
  PetscCall(SamProfileMatch(profile, pressure, rim, &found));
  PetscCall(SamProfileComputeSlopes(profile, slopes));
  PetscCall(SumTerms(law->grid, pressure, slopes, u_z, &sum));
  *energy += 0.5 * sum * law->grid->dx * law->grid->dy;
  PetscCall(VecDestroy(&slopes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(SamLaw law)
{
  PetscFunctionBegin;
  PetscCall(SamProfileDestroy(&((Deferred *)law->data)->profile));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLawCreate_Deferred(SamLaw law)
{
  Deferred *d;

  PetscFunctionBegin;
  PetscCall(PetscNew(&d));
  d->passes               = 2;
  law->data               = d;
  law->option             = "edges deferred";
  law->forbids_others     = PETSC_TRUE;
  law->bytes              = 135;
  law->ops.setfromoptions = SetFromOptions;
  law->ops.declare        = Declare;
  law->ops.correct        = Correct;
  law->ops.displace       = Displace;
  law->ops.least          = Least;
  law->ops.edge           = Edge;
  law->ops.energy         = Energy;
  law->ops.destroy        = Destroy;
  PetscFunctionReturn(PETSC_SUCCESS);
}
