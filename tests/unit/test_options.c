/*
 * Reading options: good values are read, all else is refused by name.
 */
#include "fields.h"

#include <petsam/private/baseimpl.h>
#include <petsam/private/help.h>

typedef enum { REAL, REAL_PAIR, INT, INT_PAIR, BOOL, STRING, FILE_NAME, WORD, WORDS, ENUM, CHOICE, VIEWER } Getter;

typedef struct {
  PetscReal real[2];
  PetscInt  whole[2];
  PetscBool truth;
  int       place;
  char      text[8];
} Value;

#define MEMBER(name) offsetof(Value, name)

/* Reads -pre_opt; range or least as it applies. */
static PetscErrorCode Get(Getter getter, int range, Value *v, PetscBool *set)
{
  const SamOptions   from   = {PETSC_COMM_WORLD, "pre_"};
  const SamOptionRow rows[] = {
    [REAL]      = {"opt", "", SAM_OPTION_REAL, MEMBER(real), .range = (SamRange)range},
    [REAL_PAIR] = {"opt", "", SAM_OPTION_REAL, MEMBER(real), .range = (SamRange)range, .size = 2},
    [INT]       = {"opt", "", SAM_OPTION_INT, MEMBER(whole), .least = range},
    [INT_PAIR]  = {"opt", "", SAM_OPTION_INT, MEMBER(whole), .least = range, .size = 2},
    [BOOL]      = {"opt", "", SAM_OPTION_BOOL, .member = MEMBER(truth)},
    [STRING]    = {"opt", "", SAM_OPTION_STRING, MEMBER(text), .size = sizeof(v->text)},
    [FILE_NAME] = {"opt", "", SAM_OPTION_FILE, MEMBER(text), .size = sizeof(v->text)},
    [WORD]      = {"opt", "", SAM_OPTION_WORD, MEMBER(text), .size = sizeof(v->text), .words = "one,two"},
    [WORDS]     = {"opt", "", SAM_OPTION_WORDS, MEMBER(text), .size = sizeof(v->text), .words = "one,two"},
    [ENUM]      = {"opt", "", SAM_OPTION_ENUM, MEMBER(place), .words = "none,some,all"},
    [CHOICE]    = {"opt", "", SAM_OPTION_BOOL, MEMBER(truth), .words = "none,some,all"},
    [VIEWER]    = {"opt", "", SAM_OPTION_VIEWER, .member = 0}};

  return SamOptionsRead(&from, NULL, 1, &rows[getter], v, set);
}

static void SetText(const char *text)
{
  sam_call(PetscOptionsClear(NULL));
  if (text) sam_call(PetscOptionsSetValue(NULL, "-pre_opt", text));
}

static void AssertRefused(Getter getter, int range, const char *text)
{
  Value          v = {.text = ""};
  PetscErrorCode ierr;
  PetscBool      set;
  int            good;

  SetText(text);
  BeginCatching();
  ierr = Get(getter, range, &v, &set);
  EndCatching();
  SetText(NULL);
  good = ierr == SAM_ERR_USER && strstr(CaughtMessage(), "-pre_opt") && strstr(CaughtMessage(), "expected");
  if (!good)
    print_error("getter %d, range %d, '%s': error %d, '%s'\n", (int)getter, range, text, (int)ierr, CaughtMessage());
  sam_assert(good);
}

static Value Read(Getter getter, int range, const char *text)
{
  Value     v = {.real = {7, 8}, .whole = {1, 2}, .place = 1, .text = "old"};
  PetscBool set;

  SetText(text);
  sam_call(Get(getter, range, &v, &set));
  SetText(NULL);
  sam_assert(set == (text ? PETSC_TRUE : PETSC_FALSE));
  return v;
}

/* ---- numbers ---- */

static const char *const not_reals[] = {"",   " ",     "x",      "1x",  "1 2", "1,,2", ",1", "1,",    "nan", "-nan",
                                        "1e", "1e999", "-1e999", "--1", "1;2", "1,x",  "0x", "1.2.3", "1mm", "inf ity"};
enum { NOT_REALS = sizeof(not_reals) / sizeof(not_reals[0]) };

static void test_malformed_reals_are_refused(void **state)
{
  (void)state;
  for (int range = SAM_RANGE_ANY; range <= SAM_RANGE_POSITIVE_INF; range++)
    for (int k = 0; k < NOT_REALS; k++) {
      AssertRefused(REAL, range, not_reals[k]);
      AssertRefused(REAL_PAIR, range, not_reals[k]);
    }
}

static void test_reals_outside_their_range_are_refused(void **state)
{
  const struct {
    SamRange    range;
    const char *text;
  } cases[] = {{SAM_RANGE_ANY, "inf"},           {SAM_RANGE_ANY, "-inf"},       {SAM_RANGE_NONNEGATIVE, "inf"},
               {SAM_RANGE_NONNEGATIVE, "-1e-9"}, {SAM_RANGE_POSITIVE, "inf"},   {SAM_RANGE_POSITIVE, "0"},
               {SAM_RANGE_POSITIVE, "-0"},       {SAM_RANGE_POSITIVE, "-1"},    {SAM_RANGE_POSITIVE_INF, "-inf"},
               {SAM_RANGE_POSITIVE_INF, "0"},    {SAM_RANGE_POSITIVE_INF, "-1"}};

  (void)state;
  for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
    char pair[32];

    AssertRefused(REAL, cases[k].range, cases[k].text);
    AssertRefused(REAL_PAIR, cases[k].range, cases[k].text);
    (void)snprintf(pair, sizeof(pair), "1,%s", cases[k].text);
    AssertRefused(REAL_PAIR, cases[k].range, pair);
  }
}

static void test_too_many_numbers_are_refused(void **state)
{
  (void)state;
  AssertRefused(REAL, SAM_RANGE_ANY, "1,2");
  AssertRefused(REAL_PAIR, SAM_RANGE_ANY, "1,2,3");
  AssertRefused(REAL_PAIR, SAM_RANGE_ANY, "1,2,");
  AssertRefused(INT, 0, "1,2");
  AssertRefused(INT_PAIR, 0, "1,2,3");
  AssertRefused(INT_PAIR, 0, "1,2,");
}

static void test_malformed_and_huge_ints_are_refused(void **state)
{
  const char *const cases[] = {"",
                               " ",
                               "x",
                               "1x",
                               "1.5",
                               "1e3",
                               "1,",
                               ",1",
                               "1,,2",
                               "nan",
                               "inf",
                               "99999999999999999999",
                               "-99999999999999999999",
                               "9223372036854775808",
                               "1 2",
                               "-1",
                               "1"};

  (void)state;
  for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
    AssertRefused(INT, 2, cases[k]);
    AssertRefused(INT_PAIR, 2, cases[k]);
  }
  AssertRefused(INT_PAIR, 2, "2,1");
  if (sizeof(PetscInt) == 4) {
    AssertRefused(INT, 0, "2147483648");
    AssertRefused(INT, -5, "-4294967295"); /* 1 in 32 bits */
    AssertRefused(INT_PAIR, 0, "1,4294967296");
  }
}

static void test_good_reals_are_read(void **state)
{
  Value v;

  (void)state;
  sam_assert(Read(REAL, SAM_RANGE_ANY, "-1.5e-3").real[0] == -1.5e-3);
  sam_assert(Read(REAL, SAM_RANGE_ANY, "0").real[0] == 0);
  sam_assert(Read(REAL, SAM_RANGE_NONNEGATIVE, "0").real[0] == 0);
  sam_assert(Read(REAL, SAM_RANGE_POSITIVE, ".5").real[0] == 0.5);
  sam_assert(Read(REAL, SAM_RANGE_POSITIVE, "+2").real[0] == 2);
  sam_assert(Read(REAL, SAM_RANGE_POSITIVE_INF, "inf").real[0] == INFINITY);
  sam_assert(Read(REAL, SAM_RANGE_POSITIVE, "4.9e-324").real[0] > 0); /* a small number is a number */
  sam_assert(Read(REAL, SAM_RANGE_ANY, NULL).real[0] == 7);
  v = Read(REAL_PAIR, SAM_RANGE_ANY, "1,-2.5");
  sam_assert(v.real[0] == 1 && v.real[1] == -2.5);
  v = Read(REAL_PAIR, SAM_RANGE_POSITIVE, "3"); /* one stands for both */
  sam_assert(v.real[0] == 3 && v.real[1] == 3);
  v = Read(REAL_PAIR, SAM_RANGE_POSITIVE_INF, "1,inf");
  sam_assert(v.real[0] == 1 && v.real[1] == INFINITY);
  v = Read(REAL_PAIR, SAM_RANGE_ANY, NULL);
  sam_assert(v.real[0] == 7 && v.real[1] == 8);
}

static void test_good_ints_are_read(void **state)
{
  Value v;

  (void)state;
  sam_assert(Read(INT, 0, "0").whole[0] == 0);
  sam_assert(Read(INT, -3, "-3").whole[0] == -3);
  sam_assert(Read(INT, 0, "2147483647").whole[0] == 2147483647);
  sam_assert(Read(INT, 5, NULL).whole[0] == 1); /* the default is not looked at */
  v = Read(INT_PAIR, 2, "128,64");
  sam_assert(v.whole[0] == 128 && v.whole[1] == 64);
  v = Read(INT_PAIR, 2, "128");
  sam_assert(v.whole[0] == 128 && v.whole[1] == 128);
  v = Read(INT_PAIR, 2, NULL);
  sam_assert(v.whole[0] == 1 && v.whole[1] == 2);
}

/* ---- words ---- */

static void test_booleans(void **state)
{
  const char *const yes[] = {"1", "true", "yes", "on", ""}, *const no[] = {"0", "false", "no", "off"},
                    *const wrong[] = {"2", "maybe", "truee", "-1", "1.0", "y es"};

  (void)state;
  for (int k = 0; k < 5; k++) sam_assert(Read(BOOL, 0, yes[k]).truth == PETSC_TRUE);
  for (int k = 0; k < 4; k++) {
    Value     v = {.truth = PETSC_TRUE};
    PetscBool set;

    SetText(no[k]);
    sam_call(Get(BOOL, 0, &v, &set));
    sam_assert(set && !v.truth);
  }
  for (int k = 0; k < 6; k++) AssertRefused(BOOL, 0, wrong[k]);
  sam_assert(Read(BOOL, 0, NULL).truth == PETSC_FALSE);
}

static void test_enums(void **state)
{
  const char *const words[] = {"none", "some", "all"}, *const wrong[] = {"",  "nothing",   "All",   "al",
                                                                         "0", "none,some", "allall"};

  (void)state;
  for (int k = 0; k < 3; k++) sam_assert(Read(ENUM, 0, words[k]).place == k);
  for (int k = 0; k < 3; k++) sam_assert(Read(CHOICE, 0, words[k]).truth == (k > 0 ? PETSC_TRUE : PETSC_FALSE));
  sam_assert(Read(ENUM, 0, NULL).place == 1);
  for (int k = 0; k < 7; k++) {
    AssertRefused(CHOICE, 0, wrong[k]);
    AssertRefused(ENUM, 0, wrong[k]);
    sam_assert(strstr(CaughtMessage(), "none, some or all")); /* what would be right is told */
  }
}

static void test_strings(void **state)
{
  static const char *const expected[] = {"a string", "the name of a file", "one or two", "some of one,two"};

  (void)state;
  for (int getter = STRING; getter <= WORDS; getter++) {
    const char *good = getter == WORD ? "two" : "seven77";

    sam_assert(!strcmp(Read((Getter)getter, 0, good).text, good));
    sam_assert(!strcmp(Read((Getter)getter, 0, NULL).text, "old"));
    AssertRefused((Getter)getter, 0, "eight888"); /* longer than there is room for */
    AssertRefused((Getter)getter, 0, "");
    sam_assert(strstr(CaughtMessage(), expected[getter - STRING]));
  }
}

/* ---- what an option needs, excludes, and requires ---- */

static const SamOptionRow joined[] = {
  {"size", "", SAM_OPTION_REAL, MEMBER(real), .range = SAM_RANGE_POSITIVE, .missing = "how large"},
  {"kind", "", SAM_OPTION_ENUM, MEMBER(place), .words = "none,some"},
  {"part", "", SAM_OPTION_INT, MEMBER(whole), .least = 1, .needs = "kind some: in parts", .missing = "how many"},
  {"all", "", SAM_OPTION_BOOL, MEMBER(truth), .needs = "size", .excludes = "other,part"}};

static void test_options_that_belong_together(void **state)
{
  static const char without_some[] = "-pre_part is given without -pre_kind some: in parts",
                    not_both[]     = "-pre_all does not work with -pre_other: give one of them";
  static const struct {
    const char *given, *says; /* NULL: good */
  } cases[]             = {{"-pre_size 2", NULL},
                           {"-pre_kind none", "-pre_size is missing: how large"},
                           {"-pre_size 2 -pre_kind some", "-pre_part is missing: how many"},
                           {"-pre_size 2 -pre_kind some -pre_part 3", NULL},
                           {"-pre_size 2 -pre_kind none -pre_part 3", without_some},
                           {"-pre_size 2 -pre_part 3", without_some},
                           {"-pre_size 2 -pre_all", NULL},
                           {"-pre_size 2 -pre_all -pre_other 1", not_both},
                           {"-pre_size 2 -pre_all false -pre_other 1", NULL}};
  const SamOptions from = {PETSC_COMM_WORLD, "pre_"};

  (void)state;
  for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
    Value          v = {.real = {NAN}};
    PetscBool      given[4];
    PetscErrorCode ierr;

    SetOptions(cases[k].given);
    BeginCatching();
    ierr = SamOptionsRead(&from, NULL, SAM_OPTION_ROWS(joined), &v, given);
    EndCatching();
    sam_assert(cases[k].says ? ierr == SAM_ERR_USER && !strcmp(CaughtMessage(), cases[k].says) : !ierr && given[0]);
  }
  sam_call(PetscOptionsClear(NULL));
}

/* ---- what the help is told ---- */

/* Writes a line for each title and option. */
static PetscErrorCode Note(void *context, MPI_Comm comm, const char title[], const SamOptionHelp *o)
{
  char *notes = (char *)context, line[256];

  (void)comm;
  if (title) (void)snprintf(line, sizeof(line), "[%s]", title);
  if (o)
    (void)snprintf(line, sizeof(line), "%s %s: %s (%s) %s%s", o->name, o->argument, o->text, o->value, o->words,
                   o->unit ? o->unit : "");
  strcat(strcat(notes, line), "\n");
  return 0;
}

static void test_help_is_told_all_of_an_option(void **state)
{
  const SamOptions    from        = {PETSC_COMM_WORLD, "pre_"};
  const SamOptionHelp other       = {"other", "<list>", "read elsewhere", "1", "1,2", NULL};
  const SamOptionRow  rows[]      = {{"pair", "two", SAM_OPTION_REAL, MEMBER(real), .size = 2,
                                      .missing = "not asked for while there is help"},
                                     {"real", "size (): required", SAM_OPTION_REAL, MEMBER(real), .unit = "N m"},
                                     {"open", "f(x) (, 0: none)", SAM_OPTION_REAL, MEMBER(real), .unit = "1/m"},
                                     {"end", "far (or near)", SAM_OPTION_REAL, MEMBER(real), .unit = "m"},
                                     {"enum", "how much", SAM_OPTION_ENUM, MEMBER(place), .words = "none,some,all"},
                                     {"bool", "whether", SAM_OPTION_BOOL, .member = MEMBER(truth)},
                                     {"file", "where", SAM_OPTION_FILE, MEMBER(text), .size = 8},
                                     {"words", "which", SAM_OPTION_WORDS, MEMBER(text), .size = 8, .words = "one,two"}};
  char                notes[2048] = "";
  Value               v           = {.real = {0.5, 2}, .place = 1, .truth = PETSC_TRUE, .text = "one"};

  (void)state;
  SamHelpSetFunction(Note, notes);
  sam_call(SamOptionsHeading(&from, "Not while there is no help"));
  sam_call(PetscOptionsSetValue(NULL, "-help", NULL));
  sam_call(SamOptionsRead(&from, "Group", SAM_OPTION_ROWS(rows), &v, NULL));
  sam_call(SamOptionsDescribe(&from, &other));
  sam_call(PetscOptionsClear(NULL));
  SamHelpSetFunction(NULL, NULL);
  sam_assert(!strcmp(notes, "[Group]\n"
                            "pre_pair <number>[,<number>]: two (0.5,2) \n"
                            "pre_real <number>: size (N m): required () N m\n"
                            "pre_open <number>: f(x) (1/m, 0: none) (0.5) 1/m\n"
                            "pre_end <number>: far (or near) (m) (0.5) m\n"
                            "pre_enum <keyword>: how much (some) none,some,all\n"
                            "pre_bool [<bool>]: whether (true) true,false\n"
                            "pre_file <file>: where (one) \n"
                            "pre_words <keyword>[,...]: which (one) one,two\n"
                            "pre_other <list>: read elsewhere (1) 1,2\n"));
  sam_assert(SamOptionsIsKnown("pre_other", NULL)); /* for suggestions */
}

static void test_viewers_other_than_ascii_are_refused(void **state)
{
  const char *const good[] = {"", "ascii", "ascii:file", ":file"}, *const wrong[] = {"draw", "hdf5:x", "binary:x"};

  (void)state;
  for (int k = 0; k < 4; k++) (void)Read(VIEWER, 0, good[k]);
  for (int k = 0; k < 3; k++) AssertRefused(VIEWER, 0, wrong[k]);
}

/* A mistyped option is found by what is left over; a read one is not left over, whatever its value. */
static void test_read_options_are_used(void **state)
{
  PetscInt left;

  (void)state;
  for (int getter = REAL; getter <= VIEWER; getter++) {
    const char *const text[] = {"1", "1", "1", "1", "1", "a", "a", "one", "one,two", "all", "all", "ascii"};
    Value             v      = {.text = ""};
    PetscBool         set;

    SetText(text[getter]);
    sam_call(PetscOptionsLeftGet(NULL, &left, NULL, NULL));
    sam_assert(left == 1);
    sam_call(Get((Getter)getter, 0, &v, &set));
    sam_call(PetscOptionsLeftGet(NULL, &left, NULL, NULL));
    sam_assert(left == 0);
  }
  SetText(NULL);
}

static void test_prefix_that_does_not_fit_is_refused(void **state)
{
  char          prefix[65];
  SamGrid       grid = NewGrid(4, 4, 1, 1);
  SamPair       pair = NewPair(1e9, 0.3, 1e9, 0.3);
  SamElasticity e;

  (void)state;
  sam_call(SamElasticityCreate(grid, pair, &e));
  memset(prefix, 'a', sizeof(prefix));
  prefix[64] = '\0';
  sam_fails(SamElasticitySetOptionsPrefix(e, prefix), PETSC_ERR_ARG_SIZ);
  prefix[63] = '\0';
  sam_call(SamElasticitySetOptionsPrefix(e, prefix));
  sam_call(SamElasticityDestroy(&e));
  sam_call(SamGridDestroy(&grid));
}

/* ---- what a mistake may have meant ---- */

/* Two lengths of which one is likely to be the decimals of the other. */
static void test_decimal_commas_are_refused(void **state)
{
  static const char *const wrong[] = {"2,6e-3", "2,6E-1", "1,3e0"}, *const right[] = {"2,6",           "2.0,6e-1",
                                                                                      "1,100",         "1,100.5",
                                                                                      "2.6e-3,2.6e-3", "1e-3,9e-2"};

  (void)state;
  for (size_t k = 0; k < sizeof(wrong) / sizeof(wrong[0]); k++) AssertRefused(REAL_PAIR, SAM_RANGE_POSITIVE, wrong[k]);
  for (size_t k = 0; k < sizeof(right) / sizeof(right[0]); k++) {
    const Value v = Read(REAL_PAIR, SAM_RANGE_POSITIVE, right[k]);

    sam_assert(v.real[0] == strtod(right[k], NULL) && v.real[1] == strtod(strchr(right[k], ',') + 1, NULL));
  }
  AssertRefused(REAL_PAIR, SAM_RANGE_POSITIVE, "2,6e-3");
  sam_assert(strstr(CaughtMessage(), "2 m by 0.006 m: expected 2.6e-3, with a decimal point"));
  AssertRefused(REAL, SAM_RANGE_ANY, "1000,5");
  sam_assert(strstr(CaughtMessage(), "a decimal point, not a comma"));
  sam_assert(Read(REAL_PAIR, SAM_RANGE_ANY, "0,1e-4").real[1] == 1e-4); /* a place is no length */
}

/* A number with a unit is read like that in SI units. */
static void test_units_change_the_exponent_alone(void **state)
{
  static const struct {
    const char *unit, *text;
    double      value;
  } good[] = {{"m", "2.6mm", 2.6e-3},
              {"m", "-.7e1um", -.7e-5},
              {"m", "7E+3nm", 7e-6},
              {"1/Pa", "1e-4mm3/Nm", 1e-13},
              {"N m", "3Nmm", 3e-3},
              {"N/m", "3.3kN/m", 3.3e3},
              {"Pa", "210GPa", 210e9},
              {"N", "2.5uN", 2.5e-6},
              {"N", "7nN", 7e-9},
              {"N", "2e2kgf", 1961.33},
              {"N", "100lbf", 444.82216152605},
              {"J/m2", "50mJ/m2", 50e-3},
              {"s", "3us", 3e-6},
              {"N m", "4uNm", 4e-6},
              {"N/m", "30mN/m", 30e-3},
              {NULL, "17", 17},
              {"m2", "17", 17}};
  static const struct {
    const char *unit, *text;
  } bad[] = {{"m", "2kN"},     {"m", "2 mm"}, {NULL, "2mm"}, {"m", "infmm"}, {"m2", "2mm"},  {"m", "0x1e3mm"},
             {"N", "1e308kN"}, {"m", "2m3"},  {"m", "mm"},   {"Pa", "2kgf"}, {"N m", "2lbf"}};
  const char *end;
  double      value;
  PetscBool   unit;

  (void)state;
  for (size_t k = 0; k < sizeof(good) / sizeof(good[0]); k++) {
    sam_assert(SamReadReal(good[k].unit, good[k].text, &end, &value, &unit) && !*end);
    sam_assert(fabs(value - good[k].value) <= (strchr(good[k].text, 'f') ? 1e-13 : 0) &&
               unit == (PetscBool)(value != 17));
  }
  for (size_t k = 0; k < sizeof(bad) / sizeof(bad[0]); k++)
    sam_assert(!SamReadReal(bad[k].unit, bad[k].text, &end, &value, &unit));
}

/* Reads -pre_opt of a row with this unit, whose text is about another one. */
static PetscErrorCode GetWithUnit(const char unit[], const char text[], PetscReal *value)
{
  const SamOptions   from = {PETSC_COMM_WORLD, "pre_"};
  const SamOptionRow row  = {"opt", "time (s)", SAM_OPTION_REAL, .unit = unit};
  PetscErrorCode     code;

  SetText(text);
  BeginCatching();
  code = SamOptionsRead(&from, NULL, 1, &row, value, NULL);
  EndCatching();
  return code;
}

static void test_units_are_those_of_the_row(void **state)
{
  PetscReal value = 0;

  (void)state;
  sam_assert(!GetWithUnit("m", "20mm", &value) && value == 20e-3);
  sam_assert(!GetWithUnit("Pa", "210GPa", &value) && value == 210e9);
  sam_assert(GetWithUnit("m", "20N", &value) == SAM_ERR_USER);
  sam_assert(!strcmp(CaughtMessage(), "-pre_opt 20N: expected a finite number; the units allowed, behind each number: "
                                      "m, mm, um or nm"));
  sam_assert(GetWithUnit(NULL, "2ms", &value) == SAM_ERR_USER);
  sam_assert(strstr(CaughtMessage(), "-pre_opt 2ms: expected a finite number; without a unit: "));
  sam_assert(!GetWithUnit(NULL, "2", &value) && value == 2);
  SetText(NULL);
}

static void test_units_of_numbers_are_explained(void **state)
{
  (void)state;
  AssertRefused(REAL, SAM_RANGE_POSITIVE, "210GPa"); /* the option has no unit */
  sam_assert(strstr(CaughtMessage(), "SI units"));
  AssertRefused(REAL, SAM_RANGE_POSITIVE, "2.6 mm");
  sam_assert(strstr(CaughtMessage(), "SI units"));
  AssertRefused(REAL, SAM_RANGE_NONNEGATIVE, "abc");
  sam_assert(!strstr(CaughtMessage(), "SI units"));
}

static void test_nearest_name_is_found(void **state)
{
  static const char *const names[] = {"load_n", "load_tx", "disp_z", "friction_scale", "x"};
  static const struct {
    const char *tried, *name;
  } cases[] = {{"laod_n", "load_n"},
               {"load_t", "load_n"}, /* of two as near the first */
               {"loadtx", "load_tx"},
               {"LOAD-TX", "load_tx"},
               {"dispz", "disp_z"},
               {"friction_skale", "friction_scale"},
               {"frictoin_scael", "friction_scale"},
               {"pressure", NULL},
               {"y", NULL},
               {"", NULL}};

  (void)state;
  for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
    const char *found = SamNearestName(cases[k].tried, sizeof(names) / sizeof(names[0]), names);

    if (!found != !cases[k].name || (found && strcmp(found, cases[k].name)))
      print_error("%s: %s, expected %s\n", cases[k].tried, found, cases[k].name);
    sam_assert(!found == !cases[k].name && (!found || !strcmp(found, cases[k].name)));
  }
}

/* One that is given and near, but not one that has a meaning of its own. */
static void test_missing_option_is_looked_for_among_those_given(void **state)
{
  const SamOptions from = {PETSC_COMM_WORLD, "pre_"};

  (void)state;
  SamOptionsKnow(&from, "body1", NULL);
  SamOptionsKnow(&from, "body2", NULL);
  for (int k = 0; k < 2; k++) {

    sam_call(PetscOptionsClear(NULL));
    sam_call(PetscOptionsSetValue(NULL, k ? "-pre_bdoy1" : "-pre_body2", "3"));
    sam_says(SamOptionsRequire(&from, PETSC_FALSE, "body1", "a body"), SAM_ERR_USER, "-pre_body1 is missing: a body");
    sam_assert(!strstr(CaughtMessage(), "-pre_bdoy1: unknown option: is -pre_body1 meant?") == !k);
  }
  SetText(NULL);
  sam_call(SamOptionsRequire(&from, PETSC_TRUE, "body1", "a body"));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_malformed_reals_are_refused),
    cmocka_unit_test(test_prefix_that_does_not_fit_is_refused),
    cmocka_unit_test(test_reals_outside_their_range_are_refused),
    cmocka_unit_test(test_too_many_numbers_are_refused),
    cmocka_unit_test(test_malformed_and_huge_ints_are_refused),
    cmocka_unit_test(test_good_reals_are_read),
    cmocka_unit_test(test_good_ints_are_read),
    cmocka_unit_test(test_booleans),
    cmocka_unit_test(test_enums),
    cmocka_unit_test(test_strings),
    cmocka_unit_test(test_options_that_belong_together),
    cmocka_unit_test(test_help_is_told_all_of_an_option),
    cmocka_unit_test(test_viewers_other_than_ascii_are_refused),
    cmocka_unit_test(test_read_options_are_used),
    cmocka_unit_test(test_decimal_commas_are_refused),
    cmocka_unit_test(test_units_change_the_exponent_alone),
    cmocka_unit_test(test_units_are_those_of_the_row),
    cmocka_unit_test(test_units_of_numbers_are_explained),
    cmocka_unit_test(test_nearest_name_is_found),
    cmocka_unit_test(test_missing_option_is_looked_for_among_those_given),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}
