/* The largest values of a run of petsam-stress, in its file and printed. */
#include "stressrun.h"
#include <petsam/private/baseimpl.h>

#define SHOWN 8 /* layers of which all maxima are printed */

/* ---- in the file ---- */

/* Writes largest values of each step and their places: name_max, name_max_x, name_max_y, and name_max_z below. */
static PetscErrorCode WriteLargest(SamStressRun *run, const char name[], const char words[], const char where[],
                                   const SamLargest largest[])
{
  static const char *const endings[] = {"max", "max_x", "max_y", "max_z"};
  double                  *values;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(run->steps, &values));
  for (int k = 0; k < (where[0] ? 3 : 4); k++) {
    char dataset[64], text[128], of[16] = "";

    for (PetscInt s = 0; s < run->steps; s++) values[s] = k ? largest[s].place[k - 1] : largest[s].value;
    if (k) PetscCall(PetscSNPrintf(of, sizeof(of), "%c of the ", "xyz"[k - 1]));
    PetscCall(PetscSNPrintf(dataset, sizeof(dataset), "%s_%s", name, endings[k]));
    PetscCall(PetscSNPrintf(text, sizeof(text), "%s%s%s", of, words, where));
    PetscCall(SamStressFileSetHistory(run->file, dataset, k ? "m" : "Pa", text, values));
  }
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Those at the edge of contact, where there are maps of the surface, with a warning of steps without. */
static PetscErrorCode WriteEdge(SamStressRun *run, SamLargest *largest[2], const SamStressLayout *layout)
{
  const char *const where   = " at the contact edge, on the surface";
  PetscInt          missing = 0;
  PetscMPIInt       rank;

  PetscFunctionBegin;
  if (layout->section || layout->depth[0] > 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt s = 0; s < run->steps; s++) {
    SamLargest of[2];
    PetscBool  lost;

    PetscCall(SamEvaluationGetEdgeLargest(run->evaluation, s, of, &lost));
    for (int k = 0; k < 2; k++) largest[k][s] = of[k];
    missing += lost ? 1 : 0;
  }
  PetscCall(WriteLargest(run, "edge_stress_xx", "maximum stress xx", where, largest[0]));
  PetscCall(WriteLargest(run, "edge_principal_1", "maximum principal stress", where, largest[1]));
  PetscCallMPI(MPI_Comm_rank(run->grid->comm, &rank));
  if (!missing || rank) PetscFunctionReturn(PETSC_SUCCESS);
  fprintf(stderr,
          "petsam-stress: warning: the contact edge is not found in %ld of %ld steps, and "
          "/history/edge_stress_xx_max is NaN there: less than 95 %% of it is smooth and resolved: use a finer "
          "grid, which does not help dissimilar bodies\n",
          (long)missing, (long)run->steps);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is largest in each layer. */
static const struct {
  const char *name, *words, *printed;
} layer_kinds[] = {{"mises", "von Mises stress", "von Mises stress"},
                   {"tension", "tension at the bottom", "tension at its bottom"},
                   {"shear", "shear stress at the bottom", "shear at its bottom"}};

/* How many there are of all layers, the last of them the substrate's von Mises stress. */
static PetscErrorCode CountLayers(SamStressRun *run, PetscInt *layers, PetscInt *all)
{
  PetscFunctionBegin;
  PetscCall(SamEvaluationGetMaterials(run->evaluation, layers));
  *all = *layers > 1 ? 3 * *layers - 2 : 0;
  --*layers;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Number k of them in each step, and the largest of all steps; -INFINITY without any. */
static PetscErrorCode GetLayer(SamStressRun *run, PetscInt k, SamLargest values[], SamLargest *most)
{
  PetscFunctionBegin;
  *most = (SamLargest){.value = -INFINITY};
  for (PetscInt s = 0; s < run->steps; s++) {
    SamLargest three[3];

    PetscCall(SamEvaluationGetMaterialLargest(run->evaluation, k / 3, s, three));
    if (values) values[s] = three[k % 3];
    if (three[k % 3].value > most->value) *most = three[k % 3];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Those of layers in which depths are. */
static PetscErrorCode WriteLayers(SamStressRun *run, SamLargest *values)
{
  PetscInt   layers = 0, all = 0;
  SamLargest most;

  PetscFunctionBegin;
  PetscCall(CountLayers(run, &layers, &all));
  for (PetscInt k = 0; k < all; k++) {
    char name[64], words[96];

    PetscCall(GetLayer(run, k, values, &most));
    if (most.value == -INFINITY) continue;
    if (k / 3 == layers)
      PetscCall(PetscSNPrintf(name, sizeof(name), "substrate_%s", layer_kinds[k % 3].name));
    else
      PetscCall(PetscSNPrintf(name, sizeof(name), "layer%" PetscInt_FMT "_%s", k / 3 + 1, layer_kinds[k % 3].name));
    PetscCall(PetscSNPrintf(words, sizeof(words), "maximum %s of the %s", layer_kinds[k % 3].words,
                            k / 3 < layers ? "layer" : "substrate"));
    PetscCall(WriteLargest(run, name, words, "", values));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the largest values of all steps, and of the fatigue parameters. */
PetscErrorCode SamLargestWrite(SamStressRun *run)
{
  SamStressLayout layout;
  SamLargest     *largest[2];

  PetscFunctionBegin;
  PetscCall(SamEvaluationGetLayout(run->evaluation, &layout));
  for (int k = 0; k < 2; k++) {
    PetscCall(PetscMalloc1(run->steps, &largest[k]));
    for (PetscInt s = 0; s < run->steps; s++)
      PetscCall(
        SamEvaluationGetLargest(run->evaluation, k ? SAM_QUANTITY_PRINCIPAL : SAM_QUANTITY_MISES, s, &largest[k][s]));
  }
  PetscCall(WriteLargest(run, "mises", "maximum von Mises stress", "", largest[0]));
  PetscCall(WriteLargest(run, "principal_1", "maximum principal stress", "", largest[1]));
  PetscCall(WriteEdge(run, largest, &layout));
  PetscCall(WriteLayers(run, largest[0]));
  for (PetscInt q = SAM_QUANTITY_CROSSLAND; q <= SAM_QUANTITY_RUIZ; q++) {
    SamLargest of;

    if (!layout.wants[q]) continue;
    PetscCall(SamEvaluationGetLargest(run->evaluation, (SamQuantity)q, 0, &of));
    PetscCall(SamStressFileSetLargest(run->file, (SamQuantity)q, of.value, of.place));
  }
  for (int k = 0; k < 2; k++) PetscCall(PetscFree(largest[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- printed ---- */

/* The largest values of each layer over all steps; of many layers only those that are largest of all. */
static PetscErrorCode PrintLayers(SamStressRun *run)
{
  double     best[3] = {-INFINITY, -INFINITY, -INFINITY};
  PetscInt   layers = 0, all = 0;
  SamLargest most;

  PetscFunctionBegin;
  PetscCall(CountLayers(run, &layers, &all));
  for (PetscInt k = 0; k < all && layers > SHOWN; k++) {
    PetscCall(GetLayer(run, k, NULL, &most));
    best[k % 3] = PetscMax(best[k % 3], most.value);
  }
  for (PetscInt k = 0; k < all; k++) {
    char name[32] = "substrate";

    PetscCall(GetLayer(run, k, NULL, &most));
    if (most.value == -INFINITY || most.value < best[k % 3]) continue;
    if (k / 3 < layers) PetscCall(PetscSNPrintf(name, sizeof(name), "layer %" PetscInt_FMT, k / 3 + 1));
    PetscCall(PetscPrintf(run->grid->comm, "              %s: %s %.6g Pa at (%.4g, %.4g, %.4g) m\n", name,
                          layer_kinds[k % 3].printed, most.value, most.place[0], most.place[1], most.place[2]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamLargestPrint(SamStressRun *run)
{
  static const char *const        names[] = {"Crossland", "Dang Van", "Findley", "SWT", "Fatemi-Socie", "Ruiz 1"},
                           *const units[] = {" Pa", " Pa", " Pa", " Pa", "", " J/m2"};
  SamLargest                      most    = {.value = -INFINITY}, of;
  SamStressLayout                 layout;
  PetscInt                        load = 0;

  PetscFunctionBegin;
  for (PetscInt s = 0; s < run->steps; s++) {
    PetscCall(SamEvaluationGetLargest(run->evaluation, SAM_QUANTITY_MISES, s, &of));
    if (s && of.value <= most.value) continue;
    most = of;
    PetscCall(SamResultsGetSaved(run->results, run->saved[s], &load, NULL));
  }
  PetscCall(PetscPrintf(run->grid->comm,
                        "  maximum     von Mises stress %.6g Pa at (%.4g, %.4g, %.4g) m in step %" PetscInt_FMT "\n",
                        most.value, most.place[0], most.place[1], most.place[2], load));
  PetscCall(PrintLayers(run));
  PetscCall(SamEvaluationGetLayout(run->evaluation, &layout));
  for (PetscInt q = SAM_QUANTITY_CROSSLAND; q <= SAM_QUANTITY_RUIZ; q++) {
    if (!layout.wants[q]) continue;
    PetscCall(SamEvaluationGetLargest(run->evaluation, (SamQuantity)q, 0, &of));
    PetscCall(PetscPrintf(run->grid->comm, "              %s %.6g%s at (%.4g, %.4g, %.4g) m\n",
                          names[q - SAM_QUANTITY_CROSSLAND], of.value, units[q - SAM_QUANTITY_CROSSLAND], of.place[0],
                          of.place[1], of.place[2]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
