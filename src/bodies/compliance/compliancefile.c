/*
  Reads a body's compliance; rank 0 reads all of it when it examines the file. Of several patches of a structure
  NAME:PATCH is one, NAME:PATCH:local what is local of it: about its own centre, without the motion of body 1 as a
  whole, which the structure around the contact then has. NAME:PATCH:local:LOWER lowers the degree by that number.
*/
#include <petsam/private/compliance.h>
#include <petsam/private/file.h>
#include <ctype.h>
#include <math.h>
#include <string.h>

#define RIGID   6      /* motions of a body as a whole */
#define POINTS  100000 /* maximum number of points of a load case */
#define REST    1e-2   /* largest deviation of the polynomials from a load case, relative to its range */
#define SLENDER 1000   /* largest ratio of a patch's sides: the kernel of slender cells is summed over squares */
#define LARGE   10000  /* m: largest half side of a patch, and distance of its centre from the origin */
#define SECTION 2      /* version of the files of sections in plane strain */
#define SOFT    10000  /* times the half-space's compliance: errors of pressures then exceed the tolerance */

static const SamFileKind kind = {"file", "petsam-compliance"};

/* A patch of a file: its group, and which of the file's polynomials are read. */
typedef struct {
  char      file[PETSC_MAX_PATH_LEN], group[32];
  PetscInt  patch, lower; /* 0: the file has one patch only */
  PetscBool local;
  double    center[2];
  PetscInt  modes, kept[SAM_COMPLIANCE_MODES];
} Choice;
typedef struct {
  struct _n_SamCompliance c;
  Choice                  from;
} Reading;

/*
  Chooses the polynomials whose degree is at most the largest one less `lower`, but at least 1: kept[m] is the number
  of polynomial m among them, or -1. A table that has not all products of the largest degrees goes by their sum.
*/
static void Keep(Choice *from, double power[][2])
{
  double   most[3] = {0, 0, 0};
  PetscInt count   = 0;

  for (PetscInt m = 0; m < from->modes; m++) {
    for (int d = 0; d < 2; d++) most[d] = PetscMax(most[d], power[m][d]);
    most[2] = PetscMax(most[2], power[m][0] + power[m][1]);
  }
  const PetscBool total = (double)from->modes < (most[0] + 1) * (most[1] + 1) ? PETSC_TRUE : PETSC_FALSE;

  for (int d = 0; d < 3; d++) most[d] = PetscMax(most[d] - (double)from->lower, 1);
  for (PetscInt m = 0; m < from->modes; m++) {
    const PetscBool low = total ? (power[m][0] + power[m][1] <= most[2] ? PETSC_TRUE : PETSC_FALSE)
                                : (power[m][0] <= most[0] && power[m][1] <= most[1] ? PETSC_TRUE : PETSC_FALSE);

    from->kept[m] = low || !from->lower ? count++ : -1;
  }
}

static PetscErrorCode ReadBasis(SamFile f, SamCompliance c, Choice *from)
{
  double      power[SAM_COMPLIANCE_MODES][2];
  SamExpected rows[] = {{"/patch/center", 1, {2}, .values = from->center},
                        {"/patch/half", 1, {2}, .values = c->half, .range = SAM_RANGE_POSITIVE},
                        {"/basis/degree_xy",
                         2,
                         {SAM_ANY, 2},
                         .values  = power,
                         .most    = SAM_COMPLIANCE_DEGREE,
                         .longest = SAM_COMPLIANCE_MODES}};

  PetscFunctionBegin;
  PetscCall(SamFileExpect(f, &kind, from->group, SAM_OPTION_ROWS(rows)));
  SamFileCheck(f,
               (c->datum > 0 || PetscMax(c->half[0], c->half[1]) <= SLENDER * PetscMin(c->half[0], c->half[1])) &&
                 c->half[0] <= LARGE && PetscMax(PetscAbsReal(from->center[0]), PetscAbsReal(from->center[1])) <= LARGE,
               "/patch/half is %.6g, %.6g, /patch/center %.6g, %.6g: expected at most %d m, and sides that differ "
               "at most by a factor of %d: check the unit of the file",
               c->half[0], c->half[1], from->center[0], from->center[1], LARGE, SLENDER);
  from->modes = (PetscInt)rows[2].size[0];
  for (PetscInt m = 0; m < from->modes && c->datum > 0; m++)
    SamFileCheck(f, !power[m][1] && from->center[1] == 0 && c->half[1] == 0.5,
                 "is of a section, but varies along y: make the file anew");
  Keep(from, power);
  c->modes = 0;
  for (PetscInt m = 0; m < from->modes; m++) {
    if (from->kept[m] < 0) continue;
    for (int d = 0; d < 2; d++) {
      c->power[c->modes][d] = (PetscInt)power[m][d];
      c->degree             = PetscMax(c->degree, c->power[c->modes][d]);
      c->center[d]          = from->local ? 0 : from->center[d];
    }
    c->modes++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Subtracts what body 1 as a whole moves by, Q b Q' with Q (6, modes, 3) and b (6, 6), from the compliance. */
static PetscErrorCode SubtractRigid(SamFile f, const Choice *from, double all[])
{
  const PetscInt n = 3 * from->modes;
  double         b[RIGID][RIGID], *q;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(RIGID * n, &q));
  SamExpected rows[] = {{"/rigid/compliance", 2, {RIGID, RIGID}, .values = b},
                        {"/rigid/motions", 3, {RIGID, (hsize_t)from->modes, 3}, .values = q}};

  PetscCall(SamFileExpect(f, &kind, from->group, SAM_OPTION_ROWS(rows)));
  for (PetscInt r = 0; r < n; r++)
    for (PetscInt s = 0; s < n; s++) {
      double sum = 0;

      for (int c = 0; c < RIGID; c++)
        for (int d = 0; d < RIGID; d++) sum += q[c * n + r] * b[c][d] * q[d * n + s];
      all[r * n + s] -= sum;
    }
  PetscCall(PetscFree(q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the matrix of the polynomials that are kept, and its symmetric part only. */
static PetscErrorCode ReadMatrix(SamFile f, SamCompliance c, const Choice *from, double matrix[])
{
  const hsize_t  m = (hsize_t)from->modes;
  const PetscInt n = 3 * from->modes, kept = 3 * c->modes;
  SamExpected    whole = {"/compliance", 4, {m, 3, m, 3}, .values = NULL};
  double        *all;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n * n, &all));
  whole.values = all;
  PetscCall(SamFileExpect(f, &kind, from->group, 1, &whole));
  if (from->local) PetscCall(SubtractRigid(f, from, all));
  for (PetscInt r = 0; r < n; r++)
    for (PetscInt s = 0; s < n; s++) {
      const PetscInt row = from->kept[r / 3], column = from->kept[s / 3];

      if (row < 0 || column < 0) continue;
      matrix[(r % 3 * c->modes + row) * kept + s % 3 * c->modes + column] = 0.5 * (all[r * n + s] + all[s * n + r]);
    }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads a load case given at points of the patch: x, y and field (points, 3), m. */
static PetscErrorCode ReadPoints(SamFile f, SamCompliance c, const Choice *from, const char name[], double field[][3])
{
  SamExpected table, line = {"", 1, {SAM_ANY}, .longest = POINTS};
  char        path[64];
  double     *at[2], *values, rest = NAN;
  const char *axes[2] = {"x", "y"};

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(POINTS, &at[0], POINTS, &at[1], 3 * POINTS, &values));
  for (int d = 0; d < 2; d++) {
    (void)snprintf(path, sizeof(path), "/cases/%s/%s", name, axes[d]);
    line.name   = path;
    line.values = at[d];
    PetscCall(SamFileExpect(f, &kind, from->group, 1, &line));
    for (hsize_t k = 0; k < line.size[0]; k++)
      SamFileCheck(f, fabs(at[d][k] - c->center[d]) <= c->half[d] * (1 + 1e-9),
                   "%s has %.6g m, outside of the patch from %.6g to %.6g m: give points in the patch", path, at[d][k],
                   c->center[d] - c->half[d], c->center[d] + c->half[d]);
  }
  (void)snprintf(path, sizeof(path), "/cases/%s/field", name);
  table = (SamExpected){path, 2, {line.size[0], 3}, .values = values};
  PetscCall(SamFileExpect(f, &kind, from->group, 1, &table));
  if ((PetscInt)line.size[0] >= c->modes)
    PetscCall(SamComplianceFit(c, (PetscInt)line.size[0], (const double *const[]){at[0], at[1]}, values, field, &rest));
  SamFileCheck(f, !isnan(rest),
               "load case %s is given at %d points, which do not determine %" PetscInt_FMT
               " polynomials: give more points, all over the patch",
               name, (int)line.size[0], c->modes);
  SamFileCheck(f, rest <= REST,
               "the displacement of load case %s differs from polynomials of degree %" PetscInt_FMT
               " by %.2g of its range, limit %.6g: use a higher degree or a smaller patch",
               name, c->degree, rest, REST);
  PetscCall(PetscFree3(at[0], at[1], values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the names of the load cases, in their order. */
static PetscErrorCode ReadCases(SamFile f, SamCompliance c, const Choice *from)
{
  H5G_info_t info = {.nlinks = 0};
  hid_t      group;
  char       path[64];

  PetscFunctionBegin;
  (void)snprintf(path, sizeof(path), "%s/cases", from->group);
  group = H5Lexists(f->id, path, H5P_DEFAULT) > 0 ? H5Gopen2(f->id, path, H5P_DEFAULT) : -1;
  if (group >= 0) (void)SamFileNote(f, H5Gget_info(group, &info));
  SamFileCheck(f, info.nlinks <= SAM_COMPLIANCE_CASES, "has %lld load cases: expected at most %d",
               (long long)info.nlinks, SAM_COMPLIANCE_CASES);
  for (hsize_t k = 0; k < info.nlinks; k++) {
    char         *name = c->name[c->cases];
    const ssize_t size =
      H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, k, name, sizeof(c->name[0]), H5P_DEFAULT);
    PetscBool good = size > 0 && size <= SAM_CASE_NAME;

    for (const char *letter = name; *letter && good; letter++)
      good = isalnum((unsigned char)*letter) || *letter == '_' ? PETSC_TRUE : PETSC_FALSE;
    SamFileCheck(f, good, "a load case is named %s: expected at most %d letters, digits and underscores", name,
                 SAM_CASE_NAME);
    c->cases++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the displacements of the load cases. */
static PetscErrorCode ReadFields(SamFile f, SamCompliance c, const Choice *from, double fields[])
{
  PetscFunctionBegin;
  for (PetscInt l = 0; l < c->cases; l++, fields += 3 * c->modes) {
    char        path[64], whole[SAM_EXPECT_NAME];
    double      field[SAM_COMPLIANCE_MODES][3];
    SamExpected row = {path, 2, {(hsize_t)from->modes, 3}, .values = field};

    (void)snprintf(path, sizeof(path), "/cases/%s/field", c->name[l]);
    (void)snprintf(whole, sizeof(whole), "%s%s", from->group, path);
    if (H5Lexists(f->id, whole, H5P_DEFAULT) > 0) {
      PetscCall(ReadPoints(f, c, from, c->name[l], field));
      for (PetscInt m = 0; m < 3 * c->modes; m++) fields[m % 3 * c->modes + m / 3] = field[m / 3][m % 3];
      continue;
    }
    (void)snprintf(path, sizeof(path), "/cases/%s/displacement", c->name[l]);
    PetscCall(SamFileExpect(f, &kind, from->group, 1, &row));
    for (PetscInt m = 0; m < from->modes; m++)
      for (int k = 0; k < 3 && from->kept[m] >= 0; k++) fields[k * c->modes + from->kept[m]] = field[m][k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the matrix and the fields of the load cases, one after the other. */
static PetscErrorCode LookInside(SamFile f, const void *question, void *answer)
{
  const Reading          *reading = (const Reading *)question;
  struct _n_SamCompliance c       = reading->c;
  double                 *to      = (double *)answer;

  PetscFunctionBegin;
  PetscCall(ReadMatrix(f, &c, &reading->from, to));
  PetscCall(PetscArraycpy(c.center, reading->from.center, 2)); /* of the points of load cases */
  PetscCall(ReadFields(f, &c, &reading->from, to + 9 * c.modes * c.modes));
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
    SamExpected row = {names[d], 1, {SAM_ANY}, .values = own, .longest = MOST};

    PetscCall(SamFileExpect(f, &kind, "", 1, &row));
    c->below[d] = (PetscInt)row.size[0];
    for (PetscInt k = 0; k < c->below[d]; k++) {
      SamFileCheck(f, !k || own[k] > own[k - 1], "%s does not increase: make the file anew", names[d]);
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
  SamExpected             row  = {"/stress/basis", 6, {m, 3, n[2], n[1], n[0], SAM_STRESS_COMPONENTS}, .values = NULL};

  PetscFunctionBegin;
  PetscCall(ReadAxes(f, &c, to));
  to += n[0] + n[1] + n[2];
  row.values = to;
  PetscCall(SamFileExpect(f, &kind, "", 1, &row));
  to += 3 * c.modes * size;
  for (PetscInt l = 0; l < c.cases; l++, to += size) {
    row = (SamExpected){c.name[l], 4, {n[2], n[1], n[0], SAM_STRESS_COMPONENTS}, .values = to};
    PetscCall(SamFileExpect(f, &kind, "/stress/cases/", 1, &row));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the file and the patch in the value of an option. */
static void Choose(const char text[], Choice *from)
{
  memset(from, 0, sizeof(*from));
  (void)snprintf(from->file, sizeof(from->file), "%.*s",
                 (int)SamComplianceFileName(text, &from->patch, &from->local, &from->lower), text);
  from->patch = strlen(from->file) < strlen(text) ? from->patch : -1;
}

/* Finds the group of the patch, of those that the file has. */
static PetscErrorCode FindPatch(SamFile f, Choice *from)
{
  const hid_t group = H5Lexists(f->id, "/patches", H5P_DEFAULT) > 0 ? H5Gopen2(f->id, "/patches", H5P_DEFAULT) : -1;
  H5G_info_t  info  = {.nlinks = 0};

  PetscFunctionBegin;
  if (group >= 0) (void)SamFileNote(f, H5Gget_info(group, &info));
  SamFileCheck(f, from->patch >= 0 || group < 0, "has several patches of a structure: name one of %s:1 to %s:%d",
               f->filename, f->filename, (int)info.nlinks);
  SamFileCheck(f, from->patch == -1 || (from->patch >= 1 && from->patch <= (group < 0 ? 1 : (PetscInt)info.nlinks)),
               "has no patch %" PetscInt_FMT ": it has %d: name one of %s:1 to %s:%d", from->patch,
               group < 0 ? 1 : (int)info.nlinks, f->filename, f->filename, group < 0 ? 1 : (int)info.nlinks);
  if (group >= 0) (void)snprintf(from->group, sizeof(from->group), "/patches/%" PetscInt_FMT, from->patch);
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *const SamComplianceOptions[2] = {"body1_compliance", "body2_compliance"};

PetscErrorCode SamComplianceNeedStress(MPI_Comm comm, SamCompliance c, PetscInt body)
{
  const char *const option = SamComplianceOptions[c->body];
  Choice            from;

  PetscFunctionBegin;
  Choose(c->file, &from);
  PetscCheck(from.patch <= 0, comm, SAM_ERR_FILE,
             "-%s %s: stresses of structures with several patches are not computed: use a file of one patch", option,
             c->file);
  PetscCheck(body == c->body, comm, SAM_ERR_FILE,
             "-%s %s: is of a pair, with the stresses of body 2 alone: exchange the surfaces of --contact and --pair",
             option, c->file);
  PetscCheck(c->below[0], comm, SAM_ERR_FILE, "-%s %s: has no group /stress: make the file without --no-stress", option,
             c->file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamComplianceReadStress(MPI_Comm comm, SamCompliance c, double values[])
{
  const char *const option = SamComplianceOptions[c->body];
  Choice            from;

  PetscFunctionBegin;
  Choose(c->file, &from);
  PetscCall(SamFileExamine(comm, option, from.file, NULL, LookBelow, c, values,
                           sizeof(*values) * (size_t)SamComplianceStresses(c)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the constants of body 1 if the file is that of a pair. */
static PetscErrorCode ReadOther(SamFile f, SamCompliance c)
{
  SamExpected rows[] = {{"young1", SAM_ATTRIBUTE, {1}, .values = &c->young1, .free = 1},
                        {"poisson1", SAM_ATTRIBUTE, {1}, .values = &c->poisson1, .free = 1}};

  PetscFunctionBegin;
  c->young1 = c->poisson1 = NAN;
  if (!SamFileHasAttribute(f, "young1")) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SamFileExpect(f, &kind, "", SAM_OPTION_ROWS(rows)));
  SamFileCheck(f, c->body == 1,
               "is of a pair of bodies: give it to -body2_compliance alone, which then contains body 1 too");
  SamFileCheck(f, c->young1 > 0 && isfinite(c->young1) && c->poisson1 > -1 && c->poisson1 <= 0.5,
               "young1 is %.6g, poisson1 %.6g: expected a finite modulus > 0 and a ratio from -1 to 0.5", c->young1,
               c->poisson1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Look(SamFile f, const void *question, void *answer)
{
  Reading *const reading = (Reading *)answer;
  SamCompliance  c       = &reading->c;
  double         version;
  SamExpected    error  = {"/mesh_error", 0, {0}, .values = &c->error, .range = SAM_RANGE_NONNEGATIVE, .optional = 1};
  SamExpected    rows[] = {{"petsam_compliance", SAM_ATTRIBUTE, {1}, .values = &version, .free = 1},
                           {"young", SAM_ATTRIBUTE, {1}, .values = &c->young, .free = 1},
                           {"poisson", SAM_ATTRIBUTE, {1}, .values = &c->poisson, .free = 1},
                           {"datum", SAM_ATTRIBUTE, {1}, .values = &c->datum, .free = 1}};

  PetscFunctionBegin;
  *reading = *(const Reading *)question;
  PetscCall(SamFileExpect(f, &kind, "", 1, rows));
  SamFileCheck(f, version == 1 || version == SECTION, "petsam_compliance is %.6g: expected 1 or %d: use a newer petsam",
               version, SECTION);
  PetscCall(SamFileExpect(f, &kind, "", version == SECTION ? 3 : 2, rows + 1)); /* only a section has a datum */
  SamFileCheck(f, c->young > 0 && !isnan(c->poisson) && (isinf(c->young) || (c->poisson > -1 && c->poisson <= 0.5)),
               "young is %.6g, poisson %.6g: expected a modulus > 0 and a ratio from -1 to 0.5", c->young, c->poisson);
  PetscCall(ReadOther(f, c));
  PetscCall(FindPatch(f, &reading->from));
  PetscCall(ReadBasis(f, c, &reading->from));
  PetscCall(SamFileExpect(f, &kind, reading->from.group, 1, &error)); /* files of earlier versions have none */
  SamFileCheck(f, version != SECTION || (c->datum >= c->half[0] && isfinite(c->datum)),
               "the attribute datum is %.6g: expected at least half of the patch's width, %.6g m", c->datum,
               c->half[0]);
  PetscCall(ReadCases(f, c, &reading->from));
  if (H5Lexists(f->id, "/stress", H5P_DEFAULT) > 0) PetscCall(ReadAxes(f, c, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamComplianceRead(MPI_Comm comm, PetscInt body, SamPair pair, const char option[], const char file[],
                                 SamCompliance *compliance)
{
  SamCompliance c;
  Reading       question, reading;
  PetscInt      numbers;
  double        least, most;

  PetscFunctionBegin;
  PetscCall(PetscNew(&c));
  PetscCall(PetscMemzero(&question, sizeof(question)));
  *compliance = c;
  Choose(file, &question.from);
  question.c.body = body;
  PetscCall(SamFileExamine(comm, option, question.from.file, NULL, Look, &question, &reading, sizeof(reading)));
  *c            = reading.c;
  c->checksum   = SamHashBytes(0, (const unsigned char *)c, sizeof(*c));
  c->references = 1;
  numbers       = 9 * c->modes * c->modes + 3 * c->cases * c->modes;
  PetscCall(PetscMalloc1(numbers, &c->matrix));
  c->field = c->matrix + 9 * c->modes * c->modes;
  PetscCall(SamFileExamine(comm, option, reading.from.file, NULL, LookInside, &reading, c->matrix,
                           sizeof(*c->matrix) * (size_t)numbers));
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
