/* Reads a body's compliance; rank 0 reads all of it when it examines the file. */
#include <petsam/private/compliance.h>
#include <petsam/private/file.h>
#include <ctype.h>
#include <math.h>
#include <petscdt.h>
#include <petscmat.h>
#include <string.h>

#define RANK        6      /* maximum number of dimensions */
#define POINTS      100000 /* maximum number of points of a load case */
#define INDEPENDENT 1e-6   /* least ratio of diagonal elements of R for which points determine the polynomials */
#define REST        1e-2   /* largest deviation of the polynomials from a load case, relative to its range */
#define SLENDER     1000   /* largest ratio of a patch's sides: the kernel of slender cells is summed over squares */
#define LARGE       10000  /* m: largest half side of a patch, and distance of its centre from the origin */
#define SOFT        10000  /* times the half-space's compliance: errors of pressures then exceed the tolerance */

/* `size` 0 in a dimension: any number up to `most`; it is replaced by that number. */
typedef struct {
  int     rank;
  hsize_t size[RANK], most;
} Shape;

/* Reads a dataset of finite numbers. */
static PetscErrorCode ReadNumbers(SamFile f, const char name[], Shape *shape, double values[])
{
  const hid_t dataset = H5Dopen2(f->id, name, H5P_DEFAULT), space = dataset >= 0 ? H5Dget_space(dataset) : -1;
  const int   rank        = space >= 0 ? H5Sget_simple_extent_ndims(space) : -1;
  hsize_t     found[RANK] = {0}, count = 1;
  PetscBool   fits;

  PetscFunctionBegin;
  PetscCheck(dataset >= 0, f->comm, SAM_ERR_FILE, "-%s %s: has no dataset %s: make the file by petsam-compliance",
             f->option, f->filename, name);
  fits = rank == shape->rank && H5Sget_simple_extent_dims(space, found, NULL) == rank;
  for (int d = 0; d < shape->rank && fits; d++) {
    fits                    = shape->size[d] ? found[d] == shape->size[d] : found[d] > 0 && found[d] <= shape->most;
    count *= shape->size[d] = found[d];
  }
  PetscCheck(fits, f->comm, SAM_ERR_FILE, "-%s %s: %s has a shape that does not fit the others: make the file anew",
             f->option, f->filename, name);
  PetscCheck(SamFileIsWhole(f, dataset, NULL, PETSC_TRUE) &&
               H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0,
             f->comm, SAM_ERR_FILE, "-%s %s: the numbers of %s cannot be read: the file is damaged", f->option,
             f->filename, name);
  for (hsize_t k = 0; k < count; k++)
    PetscCheck(isfinite(values[k]), f->comm, SAM_ERR_FILE,
               "-%s %s: number %lld of %s is not finite: make the file anew", f->option, f->filename, (long long)k,
               name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadAttribute(SamFile f, const char name[], double *value)
{
  const PetscBool found = SamFileHasAttribute(f, name);

  PetscFunctionBegin;
  if (found) SamFileReadAttribute(f, f->id, name, H5T_NATIVE_DOUBLE, 1, value);
  PetscCheck(found && !f->failed && !isnan(*value), f->comm, SAM_ERR_FILE,
             "-%s %s: the attribute %s is missing or no number: expected a file of petsam-compliance", f->option,
             f->filename, name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadBasis(SamFile f, SamCompliance c)
{
  double power[SAM_COMPLIANCE_MODES][2];
  Shape  pair = {1, {2}, 0}, table = {2, {0, 2}, SAM_COMPLIANCE_MODES};

  PetscFunctionBegin;
  PetscCheck(H5Lexists(f->id, "/patches", H5P_DEFAULT) <= 0, f->comm, SAM_ERR_FILE,
             "-%s %s: has several patches of a structure, which petsam-joint reads: give a file of one patch",
             f->option, f->filename);
  PetscCall(ReadNumbers(f, "/patch/center", &pair, c->center));
  PetscCall(ReadNumbers(f, "/patch/half", &pair, c->half));
  PetscCheck(c->half[0] > 0 && c->half[1] > 0, f->comm, SAM_ERR_FILE,
             "-%s %s: /patch/half is %.6g, %.6g: expected lengths > 0", f->option, f->filename, c->half[0], c->half[1]);
  PetscCheck(
    PetscMax(c->half[0], c->half[1]) <= SLENDER * PetscMin(c->half[0], c->half[1]) && c->half[0] <= LARGE &&
      PetscMax(PetscAbsReal(c->center[0]), PetscAbsReal(c->center[1])) <= LARGE,
    f->comm, SAM_ERR_FILE,
    "-%s %s: /patch/half is %.6g, %.6g, /patch/center %.6g, %.6g: expected at most %d m, and sides that differ "
    "at most by a factor of %d: check the unit of the file",
    f->option, f->filename, c->half[0], c->half[1], c->center[0], c->center[1], LARGE, SLENDER);
  PetscCall(ReadNumbers(f, "/basis/degree_xy", &table, power[0]));
  c->modes = (PetscInt)table.size[0];
  for (PetscInt m = 0; m < c->modes; m++)
    for (int d = 0; d < 2; d++) {
      PetscCheck(power[m][d] >= 0 && power[m][d] <= SAM_COMPLIANCE_DEGREE && power[m][d] == floor(power[m][d]), f->comm,
                 SAM_ERR_FILE, "-%s %s: /basis/degree_xy has %.6g: expected whole numbers from 0 to %d", f->option,
                 f->filename, power[m][d], SAM_COMPLIANCE_DEGREE);
      c->power[m][d] = (PetscInt)power[m][d];
      c->degree      = PetscMax(c->degree, c->power[m][d]);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the matrix and keeps its symmetric part. */
static PetscErrorCode ReadMatrix(SamFile f, SamCompliance c, double matrix[])
{
  const hsize_t  m     = (hsize_t)c->modes;
  const PetscInt n     = 3 * c->modes;
  Shape          shape = {4, {m, 3, m, 3}, 0};
  double        *all;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n * n, &all));
  PetscCall(ReadNumbers(f, "/compliance", &shape, all));
  for (PetscInt r = 0; r < n; r++)
    for (PetscInt s = 0; s < n; s++)
      matrix[(r % 3 * c->modes + r / 3) * n + s % 3 * c->modes + s / 3] = 0.5 * (all[r * n + s] + all[s * n + r]);
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Evaluates the polynomials at places along an axis. */
static PetscErrorCode ValuesAt(SamCompliance c, int axis, PetscInt n, const double at[], PetscReal values[])
{
  PetscInt   degrees[SAM_COMPLIANCE_DEGREE + 1];
  PetscReal *t;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n, &t));
  for (PetscInt k = 0; k <= c->degree; k++) degrees[k] = k;
  for (PetscInt k = 0; k < n; k++) t[k] = (at[k] - c->center[axis]) / c->half[axis];
  PetscCall(PetscDTLegendreEval(n, t, c->degree + 1, degrees, values, NULL, NULL));
  PetscCall(PetscFree(t));
  for (PetscInt k = 0; k < n * (c->degree + 1); k++)
    values[k] *= sqrt((2 * (double)(k % (c->degree + 1)) + 1) / (2 * c->half[axis]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  Computes the coefficients of the polynomials nearest to values (n, 3) at n >= c->modes points; `rest`: the largest
  deviation relative to their range, NaN if the points do not determine the polynomials.
*/
static PetscErrorCode Fit(SamCompliance c, PetscInt n, const double *const at[2], const double values[],
                          double field[][3], double *rest)
{
  const PetscInt degrees = c->degree + 1;
  PetscReal     *along[2], *a, least = PETSC_INFINITY, most = 0;
  Mat            matrix, factor;
  Vec            b, solution;

  PetscFunctionBegin;
  *rest = 0;
  PetscCall(PetscMalloc2(n * degrees, &along[0], n * degrees, &along[1]));
  for (int d = 0; d < 2; d++) PetscCall(ValuesAt(c, d, n, at[d], along[d]));
  PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, n, c->modes, NULL, &matrix));
  PetscCall(MatDenseGetArray(matrix, &a));
  for (PetscInt m = 0; m < c->modes; m++)
    for (PetscInt k = 0; k < n; k++)
      a[m * n + k] = along[0][k * degrees + c->power[m][0]] * along[1][k * degrees + c->power[m][1]];
  PetscCall(MatDenseRestoreArray(matrix, &a));
  PetscCall(MatDuplicate(matrix, MAT_COPY_VALUES, &factor));
  PetscCall(MatQRFactor(factor, NULL, NULL));
  PetscCall(MatDenseGetArray(factor, &a));
  for (PetscInt m = 0; m < c->modes; m++) {
    least = PetscMin(least, fabs(a[m * n + m]));
    most  = PetscMax(most, fabs(a[m * n + m]));
  }
  PetscCall(MatDenseRestoreArray(factor, &a));
  if (!(least > INDEPENDENT * most)) *rest = NAN;
  PetscCall(MatCreateVecs(matrix, &solution, &b));
  for (PetscInt d = 0; d < 3 && !isnan(*rest); d++) {
    double range[2] = {values[d], values[d]};

    PetscCall(VecGetArray(b, &a));
    for (PetscInt k = 0; k < n; k++) {
      a[k]     = values[3 * k + d];
      range[0] = PetscMin(range[0], a[k]);
      range[1] = PetscMax(range[1], a[k]);
    }
    PetscCall(VecRestoreArray(b, &a));
    PetscCall(MatSolve(factor, b, solution));
    PetscCall(VecGetArray(solution, &a));
    for (PetscInt m = 0; m < c->modes; m++) field[m][d] = a[m];
    PetscCall(VecRestoreArray(solution, &a));
    PetscCall(VecScale(b, -1));
    PetscCall(MatMultAdd(matrix, solution, b, b));
    PetscCall(VecGetArray(b, &a));
    for (PetscInt k = 0; k < n && range[1] > range[0]; k++) *rest = PetscMax(*rest, fabs(a[k]) / (range[1] - range[0]));
    PetscCall(VecRestoreArray(b, &a));
  }
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&solution));
  PetscCall(MatDestroy(&factor));
  PetscCall(MatDestroy(&matrix));
  PetscCall(PetscFree2(along[0], along[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a load case given at points of the patch: x, y and field (points, 3), m. */
static PetscErrorCode ReadPoints(SamFile f, SamCompliance c, const char name[], double field[][3])
{
  Shape       line = {1, {0}, POINTS}, table;
  char        path[64];
  double     *at[2], *values, rest = NAN;
  const char *axes[2] = {"x", "y"};

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(POINTS, &at[0], POINTS, &at[1], 3 * POINTS, &values));
  for (int d = 0; d < 2; d++) {
    (void)snprintf(path, sizeof(path), "/cases/%s/%s", name, axes[d]);
    PetscCall(ReadNumbers(f, path, &line, at[d]));
    for (hsize_t k = 0; k < line.size[0]; k++)
      PetscCheck(fabs(at[d][k] - c->center[d]) <= c->half[d] * (1 + 1e-9), f->comm, SAM_ERR_FILE,
                 "-%s %s: %s has %.6g m, outside of the patch from %.6g to %.6g m: give points in the patch", f->option,
                 f->filename, path, at[d][k], c->center[d] - c->half[d], c->center[d] + c->half[d]);
  }
  table = (Shape){2, {line.size[0], 3}, 0};
  (void)snprintf(path, sizeof(path), "/cases/%s/field", name);
  PetscCall(ReadNumbers(f, path, &table, values));
  if ((PetscInt)line.size[0] >= c->modes)
    PetscCall(Fit(c, (PetscInt)line.size[0], (const double *const[]){at[0], at[1]}, values, field, &rest));
  PetscCheck(!isnan(rest), f->comm, SAM_ERR_FILE,
             "-%s %s: load case %s is given at %d points, which do not determine %" PetscInt_FMT
             " polynomials: give more points, all over the patch",
             f->option, f->filename, name, (int)line.size[0], c->modes);
  PetscCheck(rest <= REST, f->comm, SAM_ERR_FILE,
             "-%s %s: the displacement of load case %s differs from polynomials of degree %" PetscInt_FMT
             " by %.2g of its range, limit %.6g: use a higher degree or a smaller patch",
             f->option, f->filename, name, c->degree, rest, REST);
  PetscCall(PetscFree3(at[0], at[1], values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the names of the load cases, in their order. */
static PetscErrorCode ReadCases(SamFile f, SamCompliance c)
{
  const hid_t group = H5Lexists(f->id, "/cases", H5P_DEFAULT) > 0 ? H5Gopen2(f->id, "/cases", H5P_DEFAULT) : -1;
  H5G_info_t  info  = {.nlinks = 0};

  PetscFunctionBegin;
  if (group >= 0) (void)SamFileNote(f, H5Gget_info(group, &info));
  PetscCheck(info.nlinks <= SAM_COMPLIANCE_CASES, f->comm, SAM_ERR_FILE,
             "-%s %s: has %lld load cases: expected at most %d", f->option, f->filename, (long long)info.nlinks,
             SAM_COMPLIANCE_CASES);
  for (hsize_t k = 0; k < info.nlinks; k++) {
    char         *name = c->name[c->cases];
    const ssize_t size =
      H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, k, name, sizeof(c->name[0]), H5P_DEFAULT);
    PetscBool good = size > 0 && size <= SAM_CASE_NAME;

    for (const char *letter = name; *letter && good; letter++)
      good = isalnum((unsigned char)*letter) || *letter == '_' ? PETSC_TRUE : PETSC_FALSE;
    PetscCheck(good, f->comm, SAM_ERR_FILE,
               "-%s %s: a load case is named %s: expected at most %d letters, digits and underscores", f->option,
               f->filename, name, SAM_CASE_NAME);
    c->cases++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the displacements of the load cases. */
static PetscErrorCode ReadFields(SamFile f, SamCompliance c, double fields[])
{
  PetscFunctionBegin;
  for (PetscInt l = 0; l < c->cases; l++, fields += 3 * c->modes) {
    Shape  shape = {2, {(hsize_t)c->modes, 3}, 0};
    char   path[64];
    double field[SAM_COMPLIANCE_MODES][3];

    (void)snprintf(path, sizeof(path), "/cases/%s/field", c->name[l]);
    if (H5Lexists(f->id, path, H5P_DEFAULT) > 0) {
      PetscCall(ReadPoints(f, c, c->name[l], field));
    } else {
      (void)snprintf(path, sizeof(path), "/cases/%s/displacement", c->name[l]);
      PetscCall(ReadNumbers(f, path, &shape, field[0]));
    }
    for (PetscInt m = 0; m < 3 * c->modes; m++) fields[m % 3 * c->modes + m / 3] = field[m / 3][m % 3];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the matrix and the fields of the load cases, one after the other. */
static PetscErrorCode LookInside(SamFile f, const void *question, void *answer)
{
  struct _n_SamCompliance c  = *(const struct _n_SamCompliance *)question;
  double                 *to = (double *)answer;

  PetscFunctionBegin;
  PetscCall(ReadMatrix(f, &c, to));
  PetscCall(ReadFields(f, &c, to + 9 * c.modes * c.modes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the points below the patch, if there are any; they must increase along each axis. */
static PetscErrorCode ReadAxes(SamFile f, SamCompliance c, double values[])
{
  enum { MOST = 1024 };
  static const char *const names[] = {"/stress/x", "/stress/y", "/stress/z"};
  double                   own[MOST];

  PetscFunctionBegin;
  for (int d = 0; d < 3; d++) {
    Shape shape = {1, {0}, MOST};

    PetscCall(ReadNumbers(f, names[d], &shape, own));
    c->below[d] = (PetscInt)shape.size[0];
    for (PetscInt k = 0; k < c->below[d]; k++) {
      PetscCheck(!k || own[k] > own[k - 1], f->comm, SAM_ERR_FILE, "-%s %s: %s does not increase: make the file anew",
                 f->option, f->filename, names[d]);
      if (values) *values++ = own[k];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Examines the stresses below the patch, as SamComplianceReadStress() describes. */
static PetscErrorCode LookBelow(SamFile f, const void *question, void *answer)
{
  struct _n_SamCompliance c    = *(const struct _n_SamCompliance *)question;
  const hsize_t           n[3] = {(hsize_t)c.below[0], (hsize_t)c.below[1], (hsize_t)c.below[2]}, m = (hsize_t)c.modes;
  const PetscInt          size = SamComplianceField(&c);
  double                 *to   = (double *)answer;
  Shape                   all  = {6, {m, 3, n[2], n[1], n[0], SAM_STRESS_COMPONENTS}, 0};

  PetscFunctionBegin;
  PetscCall(ReadAxes(f, &c, to));
  to += n[0] + n[1] + n[2];
  PetscCall(ReadNumbers(f, "/stress/basis", &all, to));
  to += 3 * c.modes * size;
  for (PetscInt l = 0; l < c.cases; l++, to += size) {
    Shape one = {4, {n[2], n[1], n[0], SAM_STRESS_COMPONENTS}, 0};
    char  path[64];

    (void)snprintf(path, sizeof(path), "/stress/cases/%s", c.name[l]);
    PetscCall(ReadNumbers(f, path, &one, to));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamComplianceReadStress(MPI_Comm comm, SamCompliance c, double values[])
{
  const char *const option = c->body ? "body2_compliance" : "body1_compliance";

  PetscFunctionBegin;
  PetscCheck(c->below[0], comm, SAM_ERR_FILE, "-%s %s: has no group /stress: make the file without --no-stress", option,
             c->file);
  PetscCall(SamFileExamine(comm, option, c->file, NULL, LookBelow, c, values,
                           sizeof(*values) * (size_t)SamComplianceStresses(c)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the constants of body 1 if the file is that of a pair. */
static PetscErrorCode ReadOther(SamFile f, SamCompliance c)
{
  PetscFunctionBegin;
  c->young1 = c->poisson1 = NAN;
  if (!SamFileHasAttribute(f, "young1")) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ReadAttribute(f, "young1", &c->young1));
  PetscCall(ReadAttribute(f, "poisson1", &c->poisson1));
  PetscCheck(c->body == 1, f->comm, SAM_ERR_FILE,
             "-%s %s: is of a pair of bodies: give it to -body2_compliance alone, which then contains body 1 too",
             f->option, f->filename);
  PetscCheck(c->young1 > 0 && isfinite(c->young1) && c->poisson1 > -1 && c->poisson1 <= 0.5, f->comm, SAM_ERR_FILE,
             "-%s %s: young1 is %.6g, poisson1 %.6g: expected a finite modulus > 0 and a ratio from -1 to 0.5",
             f->option, f->filename, c->young1, c->poisson1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Look(SamFile f, const void *question, void *answer)
{
  SamCompliance c = (SamCompliance)answer;
  double        version;

  PetscFunctionBegin;
  c->body = *(const PetscInt *)question;
  PetscCall(ReadAttribute(f, "petsam_compliance", &version));
  PetscCheck(version == 1, f->comm, SAM_ERR_FILE, "-%s %s: petsam_compliance is %.6g: expected 1: use a newer petsam",
             f->option, f->filename, version);
  PetscCall(ReadAttribute(f, "young", &c->young));
  PetscCall(ReadAttribute(f, "poisson", &c->poisson));
  PetscCheck(c->young > 0 && (isinf(c->young) || (c->poisson > -1 && c->poisson <= 0.5)), f->comm, SAM_ERR_FILE,
             "-%s %s: young is %.6g, poisson %.6g: expected a modulus > 0 and a ratio from -1 to 0.5", f->option,
             f->filename, c->young, c->poisson);
  PetscCall(ReadOther(f, c));
  PetscCall(ReadBasis(f, c));
  PetscCall(ReadCases(f, c));
  if (H5Lexists(f->id, "/stress", H5P_DEFAULT) > 0) PetscCall(ReadAxes(f, c, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamComplianceRead(MPI_Comm comm, PetscInt body, SamPair pair, const char option[], const char file[],
                                 SamCompliance *compliance)
{
  SamCompliance c;
  PetscInt      numbers;
  double        least, most;

  PetscFunctionBegin;
  PetscCall(PetscNew(&c));
  *compliance = c;
  PetscCall(SamFileExamine(comm, option, file, NULL, Look, &body, c, sizeof(*c)));
  c->checksum   = SamHashBytes(0, (const unsigned char *)c, sizeof(*c));
  c->references = 1;
  numbers       = 9 * c->modes * c->modes + 3 * c->cases * c->modes;
  PetscCall(PetscMalloc1(numbers, &c->matrix));
  c->field = c->matrix + 9 * c->modes * c->modes;
  PetscCall(SamFileExamine(comm, option, file, NULL, LookInside, c, c->matrix, sizeof(*c->matrix) * (size_t)numbers));
  c->checksum = SamHashBytes(c->checksum, (const unsigned char *)c->matrix, sizeof(*c->matrix) * (size_t)numbers);
  PetscCall(PetscStrncpy(c->file, file, sizeof(c->file)));
  PetscCall(SamComplianceEnds(c, pair, &least, &most));
  PetscCheck(least > 0 || (isinf(c->young) && least == 0), comm, SAM_ERR_FILE,
             "-%s %s: under some traction the body would gain energy: the smallest eigenvalue of its compliance is "
             "%.3g of the half-space's, degree %" PetscInt_FMT ", patch %.6g m x %.6g m: use a higher degree or a "
             "smaller patch",
             option, file, least, c->degree, 2 * c->half[0], 2 * c->half[1]);
  PetscCheck(most <= SOFT, comm, SAM_ERR_FILE,
             "-%s %s: under some traction the body is %.3g times as compliant as the half-space, limit %d: its "
             "pressures would be inaccurate: support the body more stiffly",
             option, file, most, SOFT);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamComplianceDestroy(SamCompliance *c)
{
  PetscFunctionBegin;
  if (*c && --(*c)->references == 0) {
    PetscCall(PetscFree((*c)->matrix));
    PetscCall(PetscFree(*c));
  }
  *c = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}
