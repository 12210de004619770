/*
  Finite bodies. The shape and the supports of a body add a smooth compliance to that of the half-space, or of a layered
  one: a matrix D of low rank for polynomials phi_i over a patch (private/compliance.h). The displacement by the
  tractions t is increased by the mean over each cell of u,

    c_j = sum over cells of t times the integral of phi_j,    u = sum phi_i (D c)_i, its mean over each cell

  Polynomials are known on every grid, including coarse ones and parts, so that nothing is transferred. They are
  products; only the means of their factors over columns and rows of cells are stored. Outside of the patch they keep
  their values at its border, and contact there is rejected. Each row of cells is summed in an order that only its
  traction determines, and the rows' sums are added without rounding: the bits do not depend on the number of ranks.

  A cell's influence on itself is that of the half-space: the part of D in it is of the order of the cell's area
  relative to the patch's.

  Body 1 is rotated about x by half a turn into its place, so that only y and z change their signs. It bears -t, and u
  is the displacement of body 2 minus that of body 1, so that the contributions of both bodies add.
*/
#include <petsam/private/halfspace.h>
#include <petsam/private/compliance.h>
#include <petsam/private/elasticity.h>
#include <petsam/private/base.h>
#include <petsam/private/body.h>
#include <petsam/private/control.h>
#include <petsam/private/parameters.h>
#include <petsam/private/state.h>
#include <math.h>
#include <petscdt.h>
#include <string.h>

#define SLIGHT 1e-3 /* load relative to the largest one, below which it is next to nothing */

enum { TOGETHER = 4, FACTORS = SAM_COMPLIANCE_DEGREE + TOGETHER };

static const double turned[2][3] = {{1, -1, -1}, {1, 1, 1}};

typedef struct {
  SamCompliance of[2]; /* NULL: that body is a half-space */
  double *along[2][2]; /* in x and y: the mean of polynomial a over cell i, at a cells + i; zeros after the last */
} Bodies;

/* The input or output components of a product: z, or x and y */
typedef enum { NORMAL, TANGENTIAL } Kind;
static const PetscInt first_of[] = {2, 0}, count_of[] = {1, 2};

typedef double Coefficients[3][SAM_COMPLIANCE_MODES];

/* ---- the polynomials ---- */

static PetscErrorCode SetUp(SamElasticity e)
{
  Bodies *const  data    = (Bodies *)e->data;
  const PetscInt n[2]    = {e->grid->nx, e->grid->ny};
  const double   side[2] = {e->grid->dx, e->grid->dy};
  double         means[FACTORS];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 4; k++) {
    const PetscInt      b = k / 2, axis = k % 2;
    const SamCompliance c = data->of[b];

    if (!c) continue;
    PetscCall(PetscCalloc1((c->degree + TOGETHER) * n[axis], &data->along[b][axis]));
    for (PetscInt i = 0; i < n[axis]; i++) {
      const double x = turned[b][axis] * (axis ? SamGridY(e->grid, i) : SamGridX(e->grid, i));

      SamComplianceMeans(c, axis, x - 0.5 * side[axis], x + 0.5 * side[axis], means);
      for (PetscInt a = 0; a <= c->degree; a++) data->along[b][axis][a * n[axis] + i] = means[a];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- sums and displacements of rows ---- */

/*
  Sum over n cells of a row times each of the polynomials in x; and add the polynomials, times coefficients, to a row.
  Four polynomials are processed at once, with zeros after the last; fields are in double or in single precision.
*/
#define ROWS(Sum, Add, Real) \
  SAM_VECTORIZED static void Sum(PetscInt n, PetscInt factors, const Real *restrict t, const double *table, \
                                 double sums[]) \
  { \
    PetscInt first = 0, last = n; \
\
    while (first < n && t[first] == 0) first++; \
    while (last > first && t[last - 1] == 0) last--; \
    for (PetscInt a = 0; a < factors; a += TOGETHER) { \
      const double *restrict p0 = table + (ptrdiff_t)a * n, *restrict p1 = p0 + n, *restrict p2 = p1 + n, \
                             *restrict p3 = p2 + n; \
      double s0 = 0, s1 = 0, s2 = 0, s3 = 0; \
\
      _Pragma("omp simd reduction(+ : s0, s1, s2, s3)") for (PetscInt i = first; i < last; i++) \
      { \
        const double x = (double)t[i]; \
\
        s0 += x * p0[i]; \
        s1 += x * p1[i]; \
        s2 += x * p2[i]; \
        s3 += x * p3[i]; \
      } \
      sums[a] = s0, sums[a + 1] = s1, sums[a + 2] = s2, sums[a + 3] = s3; \
    } \
  } \
  SAM_VECTORIZED static void Add(PetscInt n, PetscInt factors, const double *table, const double of[], \
                                 Real *restrict u) \
  { \
    for (PetscInt a = 0; a < factors; a += TOGETHER) { \
      const double *restrict p0 = table + (ptrdiff_t)a * n, *restrict p1 = p0 + n, *restrict p2 = p1 + n, \
                             *restrict p3 = p2 + n; \
      const double c0 = of[a], c1 = of[a + 1], c2 = of[a + 2], c3 = of[a + 3]; \
\
      _Pragma("omp simd") for (PetscInt i = 0; i < n; i++) u[i] = \
        (Real)((double)u[i] + (c0 * p0[i] + c1 * p1[i] + c2 * p2[i] + c3 * p3[i])); \
    } \
  }
ROWS(SumRow, AddRow, double)
ROWS(SumRowSingle, AddRowSingle, float)

/* The factor in y of polynomial m of body b in row j of this rank */
#define ALONG_Y(e, b, m, j) \
  ((const Bodies *)(e)->data)->along[b][1][(ptrdiff_t)of->power[m][1] * (e)->grid->ny + (e)->grid->row_start + (j)]

/* Computes c of body b, in the body's frame, from this rank's part of it in the contact's frame. */
static PetscErrorCode Total(SamElasticity e, SamCompliance of, Kind in, const SamTotal part[], Coefficients c)
{
  PetscFunctionBegin;
  for (PetscInt l = first_of[in]; l < first_of[in] + count_of[in]; l++, part += of->modes) {
    PetscCall(SamSumTotals(e->grid->comm, of->modes, part, c[l]));
    for (PetscInt m = 0; m < of->modes; m++) c[l][m] *= turned[of->body][l] * e->grid->dx * e->grid->dy;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes c of a body by tractions. */
#define COLLECT(Name, Real, Sum) \
  static PetscErrorCode Name(SamElasticity e, SamCompliance of, Kind in, const Real *const t[], Coefficients c) \
  { \
    const PetscInt nx = e->grid->nx, b = of->body; \
    SamTotal       part[2 * SAM_COMPLIANCE_MODES] = {{0}}; \
    double         sums[FACTORS]; \
\
    PetscFunctionBegin; \
    for (PetscInt n = 0; n < e->grid->rows * count_of[in]; n++) { \
      const PetscInt j = n / count_of[in], k = n % count_of[in]; \
\
      Sum(nx, of->degree + 1, t[k] + (ptrdiff_t)j * nx, ((const Bodies *)e->data)->along[b][0], sums); \
      for (PetscInt m = 0; m < of->modes; m++) \
        SamAdd(&part[k * of->modes + m], sums[of->power[m][0]] * ALONG_Y(e, b, m, j)); \
    } \
    PetscCall(Total(e, of, in, part, c)); \
    PetscFunctionReturn(PETSC_SUCCESS); \
  }
COLLECT(Collect, double, SumRow)
COLLECT(CollectSingle, float, SumRowSingle)

PetscErrorCode SamComplianceCollect(SamElasticity e, SamCompliance c, const double *const tractions[],
                                    double sums[3][SAM_COMPLIANCE_MODES])
{
  PetscFunctionBegin;
  PetscCall(SamElasticitySetUp(e));
  PetscCall(Collect(e, c, NORMAL, tractions, sums));
  PetscCall(Collect(e, c, TANGENTIAL, tractions + 1, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes d = D c, turned into the contact's frame, times `factor`. */
static void Multiply(SamCompliance of, Kind in, Kind out, double factor, const Coefficients c, Coefficients d)
{
  for (PetscInt k = first_of[out]; k < first_of[out] + count_of[out]; k++)
    for (PetscInt m = 0; m < of->modes; m++) {
      const double *row   = SamComplianceRow(of, k, m);
      double        total = 0;

      for (PetscInt l = first_of[in]; l < first_of[in] + count_of[in]; l++)
        for (PetscInt n = 0; n < of->modes; n++) total += row[l * of->modes + n] * c[l][n];
      d[k][m] = factor * turned[of->body][k] * total;
    }
}

/* Computes the coefficients of the displacements of both bodies by tractions. */
#define DISPLACE(e, collect, in, out, factor, t, d) \
  for (PetscInt b = 0; b < 2; b++) { \
    const SamCompliance of = ((const Bodies *)(e)->data)->of[b]; \
    Coefficients        c; \
\
    if (!of) continue; \
    PetscCall(collect(e, of, in, t, c)); \
    Multiply(of, in, out, factor, (const double(*)[SAM_COMPLIANCE_MODES])c, (d)[b]); \
  }

/* Adds polynomials with the coefficients of both bodies to displacements. */
#define SPREAD(Name, Real, Add) \
  static void Name(SamElasticity e, Kind out, Coefficients d[2], Real *const u[]) \
  { \
    const Bodies  *data = (const Bodies *)e->data; \
    const PetscInt nx   = e->grid->nx; \
\
    for (PetscInt b = 0; b < 2; b++) { \
      const SamCompliance of = data->of[b]; \
\
      for (PetscInt n = 0; of && n < e->grid->rows * count_of[out]; n++) { \
        const PetscInt j = n / count_of[out], k = n % count_of[out]; \
        double         sums[FACTORS] = {0}; \
\
        for (PetscInt m = 0; m < of->modes; m++) \
          sums[of->power[m][0]] += d[b][first_of[out] + k][m] * ALONG_Y(e, b, m, j); \
        Add(nx, of->degree + 1, data->along[b][0], sums, u[k] + (ptrdiff_t)j * nx); \
      } \
    } \
  }
SPREAD(Spread, double, AddRow)
SPREAD(SpreadSingle, float, AddRowSingle)

/* ---- products ---- */

typedef PetscErrorCode (*Method)(SamElasticity, const double *const[], double *const[]);

/* Adds the compliance's displacements to those by `method` of the half-spaces; NULL: these have no such coupling. */
static PetscErrorCode Apply(SamElasticity e, SamElasticity inner, Method method, Kind in, Kind out,
                            const double *const t[], double *const u[])
{
  Coefficients d[2];

  PetscFunctionBegin;
  DISPLACE(e, Collect, in, out, 1, t, d);
  if (method)
    PetscCall((*method)(inner, t, u));
  else
    for (PetscInt k = 0; k < count_of[out]; k++) PetscCall(PetscArrayzero(u[k], e->grid->cells));
  Spread(e, out, d, u);
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define PRODUCT(Name, method, in, out, has) \
  static PetscErrorCode Name(SamElasticity e, const double *const t[], double *const u[]) \
  { \
    SamElasticity inner = e->inner; \
\
    PetscFunctionBegin; \
    SamElasticityWith(inner, method); \
    PetscCall(Apply(e, inner, (has) ? inner->ops.method : NULL, in, out, t, u)); \
    PetscFunctionReturn(PETSC_SUCCESS); \
  }
PRODUCT(ApplyNormal, applynormal, NORMAL, NORMAL, PETSC_TRUE)
PRODUCT(ApplyTangential, applytangential, TANGENTIAL, TANGENTIAL, PETSC_TRUE)
PRODUCT(ApplyNormalToTangential, applynormaltotangential, NORMAL, TANGENTIAL, e->inner->traits.coupled)
PRODUCT(ApplyTangentialToNormal, applytangentialtonormal, TANGENTIAL, NORMAL, e->inner->traits.coupled)

#define PRODUCT_SINGLE(Name, method, kind) \
  static PetscErrorCode Name(SamElasticity e, double factor, const float *const t[], float *const u[]) \
  { \
    SamElasticity inner = e->inner; \
    Coefficients  d[2]; \
\
    PetscFunctionBegin; \
    SamElasticityWith(inner, method); \
    DISPLACE(e, CollectSingle, kind, kind, factor, t, d); \
    PetscCall((*inner->ops.method)(inner, factor, t, u)); \
    SpreadSingle(e, kind, d, u); \
    PetscFunctionReturn(PETSC_SUCCESS); \
  }
PRODUCT_SINGLE(ApplyNormalSingle, applynormalsingle, NORMAL)
PRODUCT_SINGLE(ApplyTangentialSingle, applytangentialsingle, TANGENTIAL)

/* ---- load cases ---- */

/* Writes the name of the condition that is the factor on load case l, or of its load with the ending LOAD. */
#define LOAD "_load"
static void NameCase(SamCompliance c, PetscInt l, const char ending[], char name[64])
{
  (void)snprintf(name, 64, "body%d_case_%s%s", (int)c->body + 1, c->name[l], ending);
}

static PetscErrorCode AddConditions(SamElasticity e, SamConditions conditions)
{
  char name[64];

  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++) {
    const SamCompliance c = ((const Bodies *)e->data)->of[b];

    for (PetscInt l = 0; c && l < c->cases; l++) {
      const SamCondition factor = {.name      = name,
                                   .unit      = "1",
                                   .text      = "factor on a load case of a body",
                                   .range     = SAM_RANGE_ANY,
                                   .option    = PETSC_TRUE,
                                   .couples   = PETSC_TRUE,
                                   .conjugate = PETSC_TRUE};

      NameCase(c, l, "", name);
      PetscCall(SamConditionsAdd(conditions, &factor, NULL));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

double SamComplianceFactor(SamCompliance c, SamConditions conditions, const SamControl *control, PetscInt l)
{
  char name[64];

  NameCase(c, l, "", name);
  return SamControlGet(control, SamConditionsFind(conditions, name));
}

static PetscErrorCode AddOffset(SamElasticity e, SamConditions conditions, SamState state, const SamControl *control,
                                Vec u_z, Vec u_t, PetscBool *adds)
{
  const Vec    fields[] = {[NORMAL] = u_z, [TANGENTIAL] = u_t};
  Coefficients d[2];
  double      *u;

  PetscFunctionBegin;
  (void)state;
  PetscCall(SamElasticitySetUp(e));
  PetscCall(PetscMemzero(d, sizeof(d)));
  for (PetscInt b = 0; b < 2; b++) {
    const SamCompliance c = ((const Bodies *)e->data)->of[b];

    for (PetscInt l = 0; c && l < c->cases; l++) {
      const double factor = SamComplianceFactor(c, conditions, control, l);

      if (adds && factor != 0) *adds = PETSC_TRUE;
      for (PetscInt k = 0; k < 3; k++)
        for (PetscInt m = 0; m < c->modes; m++)
          d[b][k][m] += (b ? 1 : -1) * turned[b][k] * factor * SamComplianceCase(c, l, k)[m];
    }
  }
  for (Kind kind = NORMAL; kind <= TANGENTIAL; kind++) {
    if (!fields[kind]) continue;
    PetscCall(VecGetArray(fields[kind], &u));
    Spread(e, kind, d, (double *const[]){u, u + e->grid->cells});
    PetscCall(VecRestoreArray(fields[kind], &u));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *const SamComplianceMesh[3] = {"disp_x_mesh", "disp_y_mesh", "disp_z_mesh"};

/* True if the error of a body by its mesh is known. */
static PetscBool HasError(SamElasticity e)
{
  const Bodies *data = (const Bodies *)e->data;

  return (data->of[0] && data->of[0]->error > 0) || (data->of[1] && data->of[1]->error > 0) ? PETSC_TRUE : PETSC_FALSE;
}

/* Declares the errors by meshes, and the conjugate load of each case: the work of the tractions for a unit of its
   factor. */
static PetscErrorCode DeclareLoads(SamElasticity e, SamState state)
{
  char     name[64];
  PetscInt id;

  PetscFunctionBegin;
  for (int k = 0; k < 3 && HasError(e); k++) {
    const SamStateNumber error = {.name  = SamComplianceMesh[k],
                                  .unit  = "m",
                                  .text  = "error of a displacement by the meshes of the bodies",
                                  .kind  = SAM_NUMBER_REAL,
                                  .count = 1};

    PetscCall(SamStateDeclareNumber(state, &error, &id));
  }
  for (PetscInt b = 0; b < 2; b++) {
    const SamCompliance c = ((const Bodies *)e->data)->of[b];

    for (PetscInt l = 0; c && l < c->cases; l++) {
      const SamStateNumber load = {.name   = name,
                                   .unit   = "J",
                                   .text   = "load that is conjugate to the factor on a load case",
                                   .kind   = SAM_NUMBER_REAL,
                                   .count  = 1,
                                   .result = PETSC_TRUE,
                                   .join   = SAM_JOIN_LAST,
                                   .order  = 1};

      NameCase(c, l, LOAD, name);
      PetscCall(SamStateDeclareNumber(state, &load, &id));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns c_k'D c_l, the work of a body's tractions in direction k by the displacements of those in direction l. */
static double WorkOf(SamCompliance of, const Coefficients c, PetscInt k, PetscInt l)
{
  double work = 0;

  for (PetscInt m = 0; m < of->modes; m++) {
    const double *row = SamComplianceRow(of, k, m) + l * of->modes;

    for (PetscInt n = 0; n < of->modes; n++) work += c[k][m] * row[n] * c[l][n];
  }
  return work;
}

/*
  Adds the errors of the displacements by the mesh of a body, with the sums c of its tractions: the part error of what
  they displace it by beyond the half-space, c_k'D c/F_k for direction k with the load F_k, unless that is next to
  nothing.
*/
static void AddErrors(SamCompliance of, const Coefficients c, SamState state)
{
  double load[3] = {0}, most = 0;

  for (PetscInt m = 0; m < of->modes; m++)
    for (int k = 0; k < 3 && !of->power[m][0] && !of->power[m][1]; k++)
      load[k] = fabs(c[k][m]) * sqrt(4 * of->half[0] * of->half[1]);
  for (int k = 0; k < 3; k++) most = PetscMax(most, load[k]);
  for (PetscInt k = 0; k < 3; k++) {
    double work = 0;

    if (!(load[k] > SLIGHT * most)) continue;
    for (PetscInt l = 0; l < 3; l++) work += fabs(WorkOf(of, c, k, l));
    *SamStateNumbers(state, SamStateFindNumber(state, SamComplianceMesh[k]), SAM_TRIED) += of->error * work / load[k];
  }
}

/*
  Computes these loads, sum t.v dA over the contact: t acts on body 2, and v is the displacement of body 2 minus that of
  body 1 by the case. Both the sums of a body's tractions and its case are in the body's frame.
*/
static PetscErrorCode SumLoads(SamElasticity e, SamState state, Vec pressure, Vec shear)
{
  const double *t[3];
  char          name[64];

  PetscFunctionBegin;
  PetscCall(SamElasticitySetUp(e));
  PetscCall(VecGetArrayRead(pressure, &t[0]));
  PetscCall(VecGetArrayRead(shear, &t[1]));
  t[2] = t[1] + e->grid->cells;
  for (int k = 0; k < 3 && HasError(e); k++)
    *SamStateNumbers(state, SamStateFindNumber(state, SamComplianceMesh[k]), SAM_TRIED) = 0;
  for (PetscInt b = 0; b < 2; b++) {
    const SamCompliance c = ((const Bodies *)e->data)->of[b];
    Coefficients        sums;

    if (!c || !(c->cases || c->error > 0)) continue;
    PetscCall(Collect(e, c, NORMAL, t, sums));
    PetscCall(Collect(e, c, TANGENTIAL, t + 1, sums));
    if (c->error > 0) AddErrors(c, (const double(*)[SAM_COMPLIANCE_MODES])sums, state);
    for (PetscInt l = 0; l < c->cases; l++) {
      double load = 0;

      for (PetscInt k = 0; k < 3; k++)
        for (PetscInt m = 0; m < c->modes; m++) load += (b ? 1 : -1) * SamComplianceCase(c, l, k)[m] * sums[k][m];
      NameCase(c, l, LOAD, name);
      *SamStateNumbers(state, SamStateFindNumber(state, name), SAM_TRIED) = load;
    }
  }
  PetscCall(VecRestoreArrayRead(shear, &t[1]));
  PetscCall(VecRestoreArrayRead(pressure, &t[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the type ---- */

static const char *const files[] = {"body1_compliance_file", "body2_compliance_file"};

static PetscErrorCode Inherit(SamElasticity parent, SamElasticity child)
{
  for (PetscInt b = 0; b < 2; b++) {
    const SamCompliance c = ((const Bodies *)parent->data)->of[b];

    ((Bodies *)child->data)->of[b] = c;
    if (c) c->references++;
  }
  return PETSC_SUCCESS;
}

/* Adds the parameters, with the full name of the file, by which other programs find it. */
static PetscErrorCode AddParameters(SamElasticity e, SamParameters *p)
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++) {
    const SamCompliance c = ((const Bodies *)e->data)->of[b];

    if (!c) continue;
    PetscCall(SamParametersAddChecksum(p, SamComplianceOptions[b], c->checksum));
    PetscCall(PetscGetFullPath(c->file, path, sizeof(path)));
    PetscCall(SamParametersAddText(p, files[b], PETSC_FALSE, path));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateStress(SamElasticity e, PetscInt body, const SamFourierSettings *settings,
                                   SamStress *stress)
{
  const SamCompliance *of    = ((const Bodies *)e->data)->of;
  const SamCompliance  c     = of[1] && SamComplianceIsPair(of[1]) ? of[1] : of[body - 1];
  SamElasticity        inner = e->inner;

  PetscFunctionBegin;
  if (c) PetscCall(SamComplianceNeedStress(e->grid->comm, c, body - 1));
  SamElasticityWith(inner, createstress);
  PetscCall((*inner->ops.createstress)(inner, body, settings, stress));
  if (c) PetscCall(SamComplianceAddStress(e, c, *stress));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(SamElasticity e)
{
  Bodies *data = (Bodies *)e->data;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++) {
    PetscCall(SamComplianceDestroy(&data->of[b]));
    PetscCall(PetscFree(data->along[b][0]));
    PetscCall(PetscFree(data->along[b][1]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(SamElasticity e)
{
  Bodies *data;

  PetscFunctionBegin;
  PetscCall(PetscNew(&data));
  e->data = data;
  e->ops  = (SamElasticityOps){.inherit                 = Inherit,
                               .setup                   = SetUp,
                               .addparameters           = AddParameters,
                               .destroy                 = Destroy,
                               .applynormal             = ApplyNormal,
                               .applytangential         = ApplyTangential,
                               .applynormalsingle       = ApplyNormalSingle,
                               .applytangentialsingle   = ApplyTangentialSingle,
                               .createstress            = CreateStress,
                               .applynormaltotangential = ApplyNormalToTangential,
                               .applytangentialtonormal = ApplyTangentialToNormal};
  PetscCall(SamElasticitySetInner(e, SAM_ELASTICITY_HALFSPACE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* True if the body couples normal and tangential directions, or its load cases displace the surfaces. */
static PetscBool Couples(SamCompliance c)
{
  double most = 0;

  for (PetscInt k = 0; k < 2 * c->modes; k++)
    for (PetscInt m = 0; m < c->modes; m++)
      most = PetscMax(most, fabs(SamComplianceRow(c, k % 2, k / 2)[2 * c->modes + m]));
  return most > 0 || c->cases ? PETSC_TRUE : PETSC_FALSE;
}

/* Notes the cells that extend beyond the body's patch. */
static PetscErrorCode NotePatch(SamElasticity e, const SamOptions *from, SamCompliance c)
{
  const PetscInt n[2]    = {e->grid->nx, e->grid->ny};
  const double   side[2] = {e->grid->dx, e->grid->dy};

  PetscFunctionBegin;
  for (PetscInt axis = 0; axis < 2; axis++) {
    PetscInt *const outside = e->traits.outside[axis];
    const double    middle = turned[c->body][axis] * c->center[axis], half = c->half[axis] + 1e-6 * side[axis],
                 begin = e->grid->center[axis] - 0.5 * e->grid->width[axis];
    const double low = ceil((middle - half - begin) / side[axis]), high = floor((middle + half - begin) / side[axis]);

    PetscCheck(low < high && high > 0 && low < (double)n[axis], from->comm, SAM_ERR_USER,
               "-%sbody%" PetscInt_FMT "_compliance %s: its patch, %.6g m to %.6g m in %s, holds no cell of the grid: "
               "give another -grid_center or -grid_size",
               SamOptionsPrefix(from), c->body + 1, c->file, middle - c->half[axis], middle + c->half[axis],
               axis ? "y" : "x");
    outside[0] = PetscMax(outside[0], (PetscInt)PetscMax(low, 0));
    outside[1] = PetscMax(outside[1], n[axis] - (PetscInt)PetscMin(high, (double)n[axis]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that the constants of body b are those in the file of compliance c. */
static PetscErrorCode CheckBody(SamElasticity e, const SamOptions *from, SamCompliance c, PetscInt b, double young,
                                double poisson)
{
  const SamMaterial *last = SamBodySubstrate(e->pair->body[b]);
  const double       own = (double)last->young, ratio = (double)last->poisson;

  PetscFunctionBegin;
  PetscCheck(own == young || fabs(own - young) <= 1e-6 * young, from->comm, SAM_ERR_USER,
             "-%sbody%" PetscInt_FMT "_compliance %s: was made for body %" PetscInt_FMT
             " with young %.10g, not %.10g: make them equal",
             SamOptionsPrefix(from), c->body + 1, c->file, b + 1, young, own);
  PetscCheck(isinf(own) || fabs(ratio - poisson) <= 1e-6, from->comm, SAM_ERR_USER,
             "-%sbody%" PetscInt_FMT "_compliance %s: was made for body %" PetscInt_FMT
             " with poisson %.10g, not %.10g: make them equal",
             SamOptionsPrefix(from), c->body + 1, c->file, b + 1, poisson, ratio);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that the compliance was computed for the kernel to which it is added. */
static PetscErrorCode CheckConstants(SamElasticity e, const SamOptions *from, SamCompliance c)
{
  const SamCompliance other = ((const Bodies *)e->data)->of[1 - c->body];

  PetscFunctionBegin;
  PetscCall(CheckBody(e, from, c, c->body, c->young, c->poisson));
  if (!SamComplianceIsPair(c)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckBody(e, from, c, 0, c->young1, c->poisson1));
  PetscCheck(!other, from->comm, SAM_ERR_USER, "-%s%s %s: -%s%s %s is of a pair and has body 1 already: omit the first",
             SamOptionsPrefix(from), SamComplianceOptions[0], other->file, SamOptionsPrefix(from),
             SamComplianceOptions[1], c->file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that both or none are in plane strain, and gives the compliance the datum of the half-planes. */
static PetscErrorCode MatchPlane(SamElasticity e, const SamOptions *from, SamCompliance c)
{
  const PetscBool section = c->datum > 0 ? PETSC_TRUE : PETSC_FALSE;
  SamElasticity   inner   = e;

  PetscFunctionBegin;
  while (inner->inner) inner = inner->inner;
  PetscCheck(section || !e->traits.plane, from->comm, SAM_ERR_USER,
             "-%s%s %s: is of a body of finite length, and -%selasticity %s of an endless one: give the file of a "
             "section, or omit one of them",
             SamOptionsPrefix(from), SamComplianceOptions[c->body], c->file, SamOptionsPrefix(from), inner->type);
  PetscCheck(e->traits.plane || !section, from->comm, SAM_ERR_USER,
             "-%s%s %s: is of a section in plane strain: give -%selasticity " SAM_ELASTICITY_PLANE,
             SamOptionsPrefix(from), SamComplianceOptions[c->body], c->file, SamOptionsPrefix(from));
  if (!section) PetscFunctionReturn(PETSC_SUCCESS);
  SamComplianceMoveDatum(c, (double)*SamHalfSpaceDatum(inner));
  if (SamComplianceIsPair(c) || ((const Bodies *)e->data)->of[1 - c->body] ||
      isinf((double)SamBodySubstrate(e->pair->body[1 - c->body])->young))
    e->traits.datum = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the compliance of body b from the file that `option` names. */
static PetscErrorCode Add(SamElasticity *elasticity, const SamOptions *from, PetscInt b, const char option[],
                          const char file[])
{
  SamElasticity e = *elasticity;
  SamCompliance c;

  PetscFunctionBegin;
  PetscCheck(!e->traits.periodic, from->comm, SAM_ERR_USER,
             "-%s%s: has no meaning with -%selasticity %s, whose bodies have no borders", SamOptionsPrefix(from),
             option, SamOptionsPrefix(from), e->type);
  if (!e->traits.patch) {
    PetscCall(SamElasticityWrap(*elasticity, SAM_ELASTICITY_COMPLIANCE, Create, &e));
    PetscCall(SamElasticityDestroy(elasticity));
    *elasticity     = e;
    e->traits.patch = PETSC_TRUE;
  }
  PetscCall(SamComplianceRead(from->comm, b, e->pair, option, file, &c));
  ((Bodies *)e->data)->of[b] = c;
  PetscCall(CheckConstants(e, from, c));
  PetscCall(MatchPlane(e, from, c));
  PetscCall(NotePatch(e, from, c));
  if (Couples(c)) e->traits.coupled = PETSC_TRUE;
  if (c->cases) {
    e->ops.conditions = AddConditions;
    e->ops.displace   = AddOffset;
  }
  if (c->cases || c->error > 0) {
    e->ops.declare = DeclareLoads;
    e->ops.advance = SumLoads;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the compliances whose files -body1_compliance and -body2_compliance name; without these options nothing. */
static PetscErrorCode AddFromOptions(SamElasticity *elasticity, const SamOptions *from)
{
  PetscBool given;
  char      file[PETSC_MAX_PATH_LEN] = "";

  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++) SamOptionsKnow(from, SamComplianceOptions[b], NULL);
  for (PetscInt b = 0; b < 2; b++) {
    const SamOptionRow row = {SamComplianceOptions[b],
                              "the body's own compliance, by petsam-compliance; FILE:2: of the second patch",
                              SAM_OPTION_FILE, .size = sizeof(file)};

    PetscCall(SamOptionsRead(from, NULL, 1, &row, file, &given));
    if (given && !SamPrintHelp()) PetscCall(Add(elasticity, from, b, SamComplianceOptions[b], file));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same from recorded parameters. */
static PetscErrorCode AddFromParameters(SamElasticity *elasticity, const SamParameters *p, const char source[])
{
  const SamOptions from = {(*elasticity)->grid->comm, NULL};

  PetscFunctionBegin;
  for (PetscInt b = 0; b < 2; b++) {
    const SamParameter *sum = SamParametersFind(p, SamComplianceOptions[b]), *file = SamParametersFind(p, files[b]);
    SamParameters       own = {.count = 0};

    if (!sum || !file) continue;
    PetscCall(Add(elasticity, &from, b, SamComplianceOptions[b], file->text));
    PetscCall(SamParametersAddChecksum(&own, "", ((const Bodies *)(*elasticity)->data)->of[b]->checksum));
    PetscCheck(!strcmp(own.list[0].text, sum->text), from.comm, SAM_ERR_FILE,
               "%s: -%s %s has changed since: bring back that file", source, SamComplianceOptions[b], file->text);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamElasticityAddition SamElasticityCompliances = {AddFromOptions, AddFromParameters};
