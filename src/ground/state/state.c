/* The class SamState: declarations, and values in generations. */
#include <petsam/private/control.h>
#include <petsam/private/baseimpl.h>
#include <petsam/private/grid.h>
#include <petsam/private/state.h>

/* A declared field: its vectors, and true if the tried vector has been set in this try */
typedef struct {
  SamStateField declared;
  Vec           value[SAM_GENERATIONS];
  Vec           other; /* committed vector from before a move of the grid; NULL: not moved */
  PetscBool     set;
} Field;

typedef struct {
  SamStateNumber declared;
  char           name[48], unit[32], text[96]; /* copies, as the declarer's texts may disappear */
  PetscInt       id;                           /* place of the first value */
  double         before;                       /* value for steps before the number was a result: the usual one */
  PetscBool      optional;                     /* states may lack it if it has its usual value */
} Number;

struct _n_SamState {
  SamClassId     class_id;
  SamGrid        grid;
  PetscInt       fields, numbers, values, results;
  Field          field[SAM_STATE_MOST];
  Number         number[SAM_STATE_DECLARED];
  SamStateResult result[SAM_STATE_MOST];
  SamStateLayers layers[SAM_LAYER_GROUPS];
  char           names[SAM_STATE_MOST][48];   /* names of results that are components of fields */
  char           texts[SAM_STATE_MOST][96];   /* texts of the same */
  double        *generation[SAM_GENERATIONS]; /* the numbers */
  double        *hidden;                      /* during a try: the committed numbers, with those that are not kept */
  PetscBool      tried;
};

/* ---- creation ---- */

PetscErrorCode SamStateCreate(SamGrid grid, SamState *state)
{
  SamState s;

  PetscFunctionBegin;
  PetscCall(PetscNew(&s));
  s->class_id = SamState_CLASSID;
  PetscCall(SamGridReference(grid));
  s->grid = grid;
  for (PetscInt g = 0; g < SAM_GENERATIONS; g++) PetscCall(PetscCalloc1(SAM_STATE_NUMBERS, &s->generation[g]));
  PetscCall(PetscCalloc1(SAM_STATE_NUMBERS, &s->hidden));
  *state = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStateCreateLike(SamState state, SamState *other)
{
  SamState s;
  PetscInt id;

  PetscFunctionBegin;
  PetscCall(SamStateCreate(state->grid, &s));
  for (PetscInt k = 0; k < state->fields; k++) PetscCall(SamStateDeclareField(s, &state->field[k].declared, &id));
  for (PetscInt k = 0; k < state->numbers; k++) {
    const Number *n = &state->number[k];

    if (n->optional)
      PetscCall(SamStateDeclareOptional(s, &n->declared, n->before, &id));
    else
      PetscCall(SamStateDeclareNumber(s, &n->declared, &id));
  }
  *other = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyFields(SamState s)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < s->fields; k++) {
    PetscCall(VecDestroy(&s->field[k].other));
    for (PetscInt g = 0; g < SAM_GENERATIONS; g++) PetscCall(VecDestroy(&s->field[k].value[g]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStateDestroy(SamState *state)
{
  SamState s = *state;

  PetscFunctionBegin;
  *state = NULL;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DestroyFields(s));
  for (PetscInt g = 0; g < SAM_GENERATIONS; g++) PetscCall(PetscFree(s->generation[g]));
  PetscCall(PetscFree(s->hidden));
  PetscCall(SamGridDestroy(&s->grid));
  for (PetscInt k = 0; k < SAM_LAYER_GROUPS; k++) PetscCall(PetscFree(s->layers[k].z));
  s->class_id = SAM_CLASSID_NONE;
  PetscCall(PetscFree(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

MPI_Comm SamStateComm(SamState s)
{
  return s->grid->comm;
}

/* ---- declarations ---- */

PetscErrorCode SamStateOffer(SamState s, const SamStateResult *result)
{
  PetscFunctionBegin;
  if (SamStateFindResult(s, result->name) >= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(s->results < SAM_STATE_MOST, s->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "More than %d fields of results: %s",
             SAM_STATE_MOST, result->name);
  s->result[s->results++] = *result;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *const SamLayerStresses[] = {"residual_stress_xx", "residual_stress_yy", "residual_stress_zz",
                                        "residual_stress_xy", "residual_stress_xz", "residual_stress_yz"};

PetscErrorCode SamStateSetLayers(SamState s, const SamStateLayers *layers)
{
  const PetscInt count = layers->count[0] + layers->count[1];
  PetscInt       k     = 0;

  PetscFunctionBegin;
  while (k < SAM_LAYER_GROUPS && s->layers[k].group && strcmp(s->layers[k].group, layers->group)) k++;
  PetscCheck(k < SAM_LAYER_GROUPS, s->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "More than %d groups of layers: %s",
             SAM_LAYER_GROUPS, layers->group);
  PetscCheck(strlen(layers->group) < SAM_LAYER_NAME, s->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Group of layers %s: expected a name of less than %d characters", layers->group, SAM_LAYER_NAME);
  PetscCall(PetscFree(s->layers[k].z));
  s->layers[k] = *layers;
  PetscCall(PetscMalloc1(count, &s->layers[k].z));
  PetscCall(PetscArraycpy(s->layers[k].z, layers->z, count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const SamStateLayers *SamStateGetLayers(SamState s, PetscInt k)
{
  return k < SAM_LAYER_GROUPS && s->layers[k].group ? &s->layers[k] : NULL;
}

const SamStateLayers *SamStateLayersOf(SamState s, const char result[])
{
  const size_t          length = strcspn(result, "/");
  const SamStateLayers *layers = NULL;

  for (PetscInt k = 0; (layers = SamStateGetLayers(s, k)); k++)
    if (strlen(layers->group) == length && !strncmp(layers->group, result, length)) break;
  return layers;
}

/* Writes the name and the text of the c-th value per cell of a field. */
static void NameValue(const SamStateField *f, PetscInt c, char name[48], char text[], size_t size)
{
  const char axis[2] = {c % f->components ? 'y' : 'x', '\0'}, *const rest = strchr(f->text, ',');
  const int word      = (int)strcspn(f->text, ",");
  char      layer[24] = "", below[48] = "";

  if (f->layers) (void)snprintf(layer, sizeof(layer), "_%d", (int)(c / f->components) + 1);
  if (f->layers) (void)snprintf(below, sizeof(below), ", layer %d", (int)(c / f->components) + 1);
  (void)snprintf(name, 48, "%s%s%s%s", f->name, layer, f->components > 1 ? "_" : "", f->components > 1 ? axis : "");
  (void)snprintf(text, size, "%.*s%s%s%s%s", word, f->text, f->components > 1 ? " along " : "",
                 f->components > 1 ? axis : "", rest ? rest : "", below);
}

/* Offers the values of a stored field as results. */
static PetscErrorCode OfferField(SamState s, PetscInt id)
{
  const SamStateField *f = &s->field[id].declared;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < SamStateFieldSize(f); c++) {
    const PetscInt k = PetscMin(s->results, SAM_STATE_MOST - 1);

    NameValue(f, c, s->names[k], s->texts[k], sizeof(s->texts[k]));
    PetscCall(SamStateOffer(s, &(SamStateResult){s->names[k], f->unit, s->texts[k], SAM_FIELD_REAL, f->result, NULL,
                                                 NULL, c, id}));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStateDeclareField(SamState s, const SamStateField *field, PetscInt *id)
{
  PetscFunctionBegin;
  SamValidHandle(s, SamState, 1);
  SamValidPointer(field, 2);
  SamValidPointer(id, 3);
  *id = SamStateFindField(s, field->name);
  if (*id >= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(s->fields < SAM_STATE_MOST, s->grid->comm, PETSC_ERR_ARG_OUTOFRANGE, "More than %d remembered fields: %s",
             SAM_STATE_MOST, field->name);
  *id                    = s->fields++;
  s->field[*id].declared = *field;
  if (field->result != SAM_RESULT_NONE) PetscCall(OfferField(s, *id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets numbers to the value that means "none in this step". */
static void SetNone(SamState s, const Number *n, SamGeneration g)
{
  for (PetscInt k = 0; k < n->declared.count; k++)
    s->generation[g][n->id + k] =
      n->declared.result && (n->declared.kind == SAM_NUMBER_REAL || n->declared.kind == SAM_NUMBER_MATRIX) ? NAN : 0;
}

/* Sets numbers to their values before any step. */
static void SetInitial(SamState s, const Number *n, SamGeneration g)
{
  SetNone(s, n, g);
  for (PetscInt k = 0; k < n->declared.count && n->optional; k++) s->generation[g][n->id + k] = n->before;
}

PetscErrorCode SamStateDeclareNumber(SamState s, const SamStateNumber *number, PetscInt *id)
{
  Number *n;

  PetscFunctionBegin;
  SamValidHandle(s, SamState, 1);
  SamValidPointer(number, 2);
  SamValidPointer(id, 3);
  *id = SamStateFindNumber(s, number->name);
  if (*id >= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(s->values + number->count <= SAM_STATE_NUMBERS && s->numbers < SAM_STATE_DECLARED, s->grid->comm,
             PETSC_ERR_ARG_OUTOFRANGE, "More than %d remembered numbers: %s", SAM_STATE_DECLARED, number->name);
  n           = &s->number[s->numbers++];
  n->declared = *number;
  (void)snprintf(n->name, sizeof(n->name), "%s", number->name);
  (void)snprintf(n->unit, sizeof(n->unit), "%s", number->unit);
  (void)snprintf(n->text, sizeof(n->text), "%s", number->text);
  n->declared.name = n->name;
  n->declared.unit = n->unit;
  n->declared.text = n->text;
  n->id = *id = s->values;
  n->before   = number->kind == SAM_NUMBER_INT ? 0 : NAN;
  s->values += number->count;
  for (PetscInt g = 0; g < SAM_GENERATIONS; g++) SetInitial(s, n, (SamGeneration)g);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStateDeclareOptional(SamState s, const SamStateNumber *number, double usual, PetscInt *id)
{
  const PetscInt count = s->numbers;

  PetscFunctionBegin;
  PetscCall(SamStateDeclareNumber(s, number, id));
  if (s->numbers == count) PetscFunctionReturn(PETSC_SUCCESS);
  s->number[count].optional = PETSC_TRUE;
  s->number[count].before   = usual;
  for (PetscInt g = 0; g < SAM_GENERATIONS; g++) SetInitial(s, &s->number[count], (SamGeneration)g);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamStateIsOptional(SamState s, PetscInt k)
{
  return s->number[k].optional;
}

PetscBool SamStateIsUsual(SamState s, PetscInt k)
{
  const Number *n = &s->number[k];

  for (PetscInt g = SAM_COMMITTED; g < SAM_GENERATIONS; g++)
    for (PetscInt i = n->id; i < n->id + n->declared.count; i++)
      if (s->generation[g][i] != n->before && !isnan(s->generation[g][i])) return PETSC_FALSE;
  return n->optional;
}

PetscErrorCode SamStateOfferNumber(SamState s, const char name[], double before)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < s->numbers; k++) {
    Number *n = &s->number[k];

    if (n->declared.result || strcmp(n->declared.name, name)) continue;
    n->declared.result = PETSC_TRUE;
    n->before          = before;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- generations ---- */

/*
  Shows a try the committed numbers as a restart would have them: those that checkpoints do not contain are none. So a
  step that depends on one of them differs from the expected result at once, and not only after a restart.
*/
static PetscErrorCode HideNumbers(SamState s)
{
  PetscFunctionBegin;
  PetscCall(PetscArraycpy(s->hidden, s->generation[SAM_COMMITTED], s->values));
  for (PetscInt k = 0; k < s->numbers; k++)
    if (!s->number[k].declared.kept) SetInitial(s, &s->number[k], SAM_COMMITTED);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Exchanges the committed numbers as a try sees them and all of them. */
static void SwapHidden(SamState s)
{
  double *const committed = s->generation[SAM_COMMITTED];

  s->generation[SAM_COMMITTED] = s->hidden;
  s->hidden                    = committed;
}

PetscErrorCode SamStateBegin(SamState s)
{
  PetscFunctionBegin;
  PetscCall(SamStateReject(s));
  PetscCall(HideNumbers(s));
  s->tried = PETSC_TRUE;
  PetscCall(PetscArraycpy(s->generation[SAM_TRIED], s->generation[SAM_COMMITTED], s->values));
  for (PetscInt k = 0; k < s->numbers; k++)
    if (s->number[k].declared.result) SetNone(s, &s->number[k], SAM_TRIED);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Exchanges the fields of the committed generation before and after a move of the grid. */
static void SwapMovedFields(SamState s)
{
  for (PetscInt k = 0; k < s->fields; k++) {
    Field *f     = &s->field[k];
    Vec    other = f->other;

    if (!other) continue;
    f->other                = f->value[SAM_COMMITTED];
    f->value[SAM_COMMITTED] = other;
  }
}

void SamStateSwapTried(SamState s)
{
  SwapMovedFields(s);
  if (s->tried) SwapHidden(s);
}

PetscErrorCode SamStateForgetFields(SamState s)
{
  PetscFunctionBegin;
  SwapMovedFields(s);
  for (PetscInt k = 0; k < s->fields; k++) {
    PetscCall(VecDestroy(&s->field[k].other));
    s->field[k].set = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStateMove(SamState s, const PetscReal distance[2], PetscBool wraps)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < s->fields; k++) {
    Field *f = &s->field[k];

    if (f->declared.motion == SAM_STAYS || !f->value[SAM_COMMITTED]) continue;
    PetscCall(SamGridCreateVec(s->grid, SamStateFieldSize(&f->declared), &f->other));
    PetscCall(SamGridMove(s->grid, SamStateFieldSize(&f->declared), distance,
                          wraps                                       ? SAM_BORDER_WRAPS
                          : f->declared.motion == SAM_MOVES_CONTINUED ? SAM_BORDER_CONTINUES
                                                                      : SAM_BORDER_ZERO,
                          f->value[SAM_COMMITTED], f->other));
  }
  SwapMovedFields(s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStateReject(SamState s)
{
  PetscFunctionBegin;
  if (s->tried) SwapHidden(s);
  s->tried = PETSC_FALSE;
  PetscCall(SamStateForgetFields(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStateReset(SamState s)
{
  PetscFunctionBegin;
  PetscCall(SamStateReject(s));
  PetscCall(DestroyFields(s));
  for (PetscInt k = 0; k < s->numbers; k++)
    for (PetscInt g = 0; g < SAM_GENERATIONS; g++) SetInitial(s, &s->number[k], (SamGeneration)g);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the oldest generation of a field the tried one; its vector will be overwritten. */
static void Rotate(Field *f)
{
  const Vec      tried  = f->value[SAM_TRIED];
  const PetscInt oldest = f->declared.generations - 1;

  f->value[SAM_TRIED] = f->value[oldest];
  if (oldest == SAM_BEFORE) f->value[SAM_BEFORE] = f->value[SAM_COMMITTED];
  f->value[SAM_COMMITTED] = tried;
}

PetscErrorCode SamStateCommit(SamState s)
{
  double *const recycled = s->generation[SAM_BEFORE];

  PetscFunctionBegin;
  PetscCheck(s->tried, s->grid->comm, PETSC_ERR_ORDER, "There is no tried generation");
  SwapHidden(s);
  s->tried = PETSC_FALSE;
  for (PetscInt k = 0; k < s->fields; k++) PetscCall(VecDestroy(&s->field[k].other));
  for (PetscInt k = 0; k < s->fields; k++)
    if (s->field[k].set) Rotate(&s->field[k]);
  s->generation[SAM_BEFORE]    = s->generation[SAM_COMMITTED];
  s->generation[SAM_COMMITTED] = s->generation[SAM_TRIED];
  s->generation[SAM_TRIED]     = recycled;
  PetscCall(SamStateReject(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SamStateSeparates(SamState s)
{
  for (PetscInt k = 0; k < s->fields; k++)
    if (s->field[k].set && s->field[k].declared.separates) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool SamStateHasTried(SamState s)
{
  return s->tried;
}

/* ---- values ---- */

PetscErrorCode SamStateRestoreField(SamState s, PetscInt id, SamGeneration g, Vec *field)
{
  Field *f = &s->field[id];

  PetscFunctionBegin;
  if (!f->value[g]) PetscCall(SamGridCreateVec(s->grid, SamStateFieldSize(&f->declared), &f->value[g]));
  *field = f->value[g];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStateSetField(SamState s, PetscInt id, Vec *field)
{
  PetscFunctionBegin;
  SamValidHandle(s, SamState, 1);
  SamValidPointer(field, 3);
  PetscCheck(id >= 0 && id < s->fields, s->grid->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Field %" PetscInt_FMT ": expected one of the %" PetscInt_FMT " that have been declared", id, s->fields);
  PetscCall(SamStateRestoreField(s, id, SAM_TRIED, field));
  s->field[id].set = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

Vec SamStateGetField(SamState s, PetscInt id, SamGeneration g)
{
  return g == SAM_TRIED && !s->field[id].set ? NULL : s->field[id].value[g];
}

Vec SamStateReadField(SamState s, PetscInt id)
{
  return SamStateGetField(s, id, s->field[id].set ? SAM_TRIED : SAM_COMMITTED);
}

double *SamStateNumbers(SamState s, PetscInt id, SamGeneration g)
{
  return s->generation[g] + id;
}

double *SamStateReadNumbers(SamState s, PetscInt id)
{
  return SamStateNumbers(s, id, s->tried ? SAM_TRIED : SAM_COMMITTED);
}

void SamStateJoinNumbers(SamState s, double parts[], PetscBool to_step)
{
  for (PetscInt k = 0; k < s->numbers; k++) {
    const SamNumberJoin join = s->number[k].declared.join;
    double *const tried = s->generation[SAM_TRIED] + s->number[k].id, *const part = parts + s->number[k].id;

    for (PetscInt n = 0; n < s->number[k].declared.count && join != SAM_JOIN_LAST; n++)
      *(to_step ? &tried[n] : &part[n]) = join == SAM_JOIN_SUM ? tried[n] + part[n] : PetscMax(tried[n], part[n]);
  }
}

/* Copies one generation of a field; NULL: it has no values. */
static PetscErrorCode CopyField(SamState to, PetscInt id, SamGeneration g, Vec from)
{
  Vec field = to->field[id].value[g];

  PetscFunctionBegin;
  if (from) PetscCall(SamStateRestoreField(to, id, g, &field));
  if (from)
    PetscCall(SamVecCopyNonzero(from, field));
  else if (field)
    PetscCall(SamVecZero(field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamStateCopy(SamState from, SamState to)
{
  PetscFunctionBegin;
  PetscCheck(from->grid->nx == to->grid->nx && from->grid->ny == to->grid->ny, to->grid->comm, PETSC_ERR_ARG_SIZ,
             "The state to be copied is of a grid of %" PetscInt_FMT " x %" PetscInt_FMT
             " cells: expected %" PetscInt_FMT " x %" PetscInt_FMT,
             from->grid->nx, from->grid->ny, to->grid->nx, to->grid->ny);
  PetscCall(SamStateReject(to));
  SamStateSwapTried(from);
  for (PetscInt k = 0; k < from->fields; k++) {
    const char *name = from->field[k].declared.name;

    PetscCheck(SamStateFindField(to, name) >= 0 || !from->field[k].value[SAM_COMMITTED], to->grid->comm,
               PETSC_ERR_ARG_INCOMP, "The state to be copied has a field %s, which this contact does not have", name);
  }
  for (PetscInt k = 0; k < from->numbers; k++) {
    const Number *n = &from->number[k];

    PetscCheck(!n->optional || SamStateFindNumber(to, n->name) >= 0 || SamStateIsUsual(from, k), to->grid->comm,
               PETSC_ERR_ARG_INCOMP, "The state to be copied has %s = %.6g, which this contact does not have", n->name,
               from->generation[SAM_COMMITTED][n->id]);
  }
  for (PetscInt k = 0; k < to->fields; k++) {
    const PetscInt other = SamStateFindField(from, to->field[k].declared.name);

    for (PetscInt g = SAM_COMMITTED; g < to->field[k].declared.generations; g++)
      PetscCall(CopyField(to, k, (SamGeneration)g, other < 0 ? NULL : from->field[other].value[g]));
  }
  for (PetscInt k = 0; k < to->numbers; k++) {
    const Number  *n     = &to->number[k];
    const PetscInt other = SamStateFindNumber(from, n->declared.name);

    for (PetscInt g = SAM_COMMITTED; g < SAM_GENERATIONS; g++)
      if (other < 0)
        SetInitial(to, n, (SamGeneration)g);
      else
        PetscCall(PetscArraycpy(to->generation[g] + n->id, from->generation[g] + other, n->declared.count));
  }
  SamStateSwapTried(from);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- lists ---- */

PetscInt SamStateCountFields(SamState s)
{
  return s->fields;
}

const SamStateField *SamStateFieldOf(SamState s, PetscInt id)
{
  return &s->field[id].declared;
}

PetscInt SamStateFindField(SamState s, const char name[])
{
  for (PetscInt k = 0; k < s->fields; k++)
    if (!strcmp(s->field[k].declared.name, name)) return k;
  return -1;
}

PetscInt SamStateCountNumbers(SamState s)
{
  return s->numbers;
}

const SamStateNumber *SamStateNumberOf(SamState s, PetscInt k, PetscInt *id)
{
  if (id) *id = s->number[k].id;
  return &s->number[k].declared;
}

const char *SamStateUnitOf(SamState s, const char name[])
{
  for (PetscInt k = 0; k < s->numbers; k++)
    if (!strcmp(s->number[k].declared.name, name)) return SamUnitOn(s->grid, s->number[k].declared.unit);
  return "";
}

double SamStateMissingNumber(SamState s, PetscInt k)
{
  return s->number[k].before;
}

PetscInt SamStateCountValues(SamState s)
{
  return s->values;
}

PetscInt SamStateFindNumber(SamState s, const char name[])
{
  for (PetscInt k = 0; k < s->numbers; k++)
    if (!strcmp(s->number[k].declared.name, name)) return s->number[k].id;
  return -1;
}

PetscInt SamStateCountResults(SamState s)
{
  return s->results;
}

const SamStateResult *SamStateResultOf(SamState s, PetscInt k)
{
  return &s->result[k];
}

PetscInt SamStateFindResult(SamState s, const char name[])
{
  for (PetscInt k = 0; k < s->results; k++)
    if (!strcmp(s->result[k].name, name)) return k;
  return -1;
}

PetscErrorCode SamStateFindValues(SamState s, PetscInt k, Vec work, Vec *holder, PetscInt *component)
{
  const SamStateResult *r = &s->result[k];

  PetscFunctionBegin;
  *holder    = work;
  *component = 0;
  if (r->compute) {
    PetscCall(r->compute(r->owner, s, r->component, work));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  *holder = SamStateReadField(s, r->field);
  if (*holder) {
    *component = r->component;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  *holder = work;
  PetscCall(VecSet(work, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
