/*
  Results in an HDF5 file, written by all ranks together.

  Datasets stay open and grow along time (steps.c); each rank writes its rows of the cells.
*/
#include "ioimpl.h"
#include <string.h>

/* ---- options ---- */

/* -output_fields: names between commas, and blanks. */
static PetscErrorCode ReadFieldNames(SamOutputSettings *set, const SamOptions *from)
{
  char        text[512] = "", names[512], words[512] = "all,none", **list;
  const char *unknown;
  PetscBool   given;
  int         count;

  PetscFunctionBegin;
  for (PetscInt f = 0; f < SamOutputFieldCount; f++) {
    PetscCall(PetscStrlcat(words, ",", sizeof(words)));
    PetscCall(PetscStrlcat(words, SamOutputFields[f].label.name, sizeof(words)));
  }
  PetscCall(SamOptionsWords(from, "output_fields", "fields to be saved by their names, all, or none", words, text,
                            sizeof(text), &given));
  for (char *c = text; *c; c++) *c = *c == ' ' ? ',' : *c;
  PetscCall(PetscStrToArray(text, ',', &count, &list));
  PetscCall(SamOutputSettingsSetFields(set, given ? count : -1, (const char *const *)list, &unknown));
  (void)snprintf(text, sizeof(text), "%s", unknown ? unknown : "");
  PetscCall(PetscStrToArrayDestroy(count, list));
  PetscCall(SamOutputGetFieldNames(names, sizeof(names)));
  PetscCheck(!text[0], from->comm, SAM_ERR_USER,
             "-%soutput_fields: %s is no field%s: expected all, none, or some of %s, with commas between them",
             SamOptionsPrefix(from), text, strcmp(text, "none") ? "" : ", and excludes them", names);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputSettingsSetFromOptions(SamOutputSettings *set, const SamOptions *from)
{
  const char *prefix = SamOptionsPrefix(from);

  PetscFunctionBegin;
  *set = (SamOutputSettings){.compress = 0, .chunk = {1024, 256}, .xdmf = PETSC_TRUE};
  PetscCall(ReadFieldNames(set, from));
  PetscCall(SamOptionsInt(from, "output_compress", "level of compression of the fields, 0 (none) to 9", 0,
                          &set->compress, NULL));
  PetscCheck(set->compress <= 9, from->comm, SAM_ERR_USER,
             "-%soutput_compress %" PetscInt_FMT ": expected a whole number from 0 to 9", prefix, set->compress);
  PetscCheck(set->compress == 0 || H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0, from->comm, SAM_ERR_USER,
             "-%soutput_compress %" PetscInt_FMT ": this HDF5 was built without zlib", prefix, set->compress);
  PetscCall(SamOptionsIntPair(from, "output_chunk", "most cells of a chunk of the file in x[,y]", 1, set->chunk, NULL));
  PetscCall(
    SamOptionsBool(from, "output_single", "fields in single precision: files of half the size", &set->single, NULL));
  PetscCall(
    SamOptionsBool(from, "output_xdmf", "an XDMF file beside the results, for ParaView and VisIt", &set->xdmf, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the file ---- */

PetscErrorCode SamOutputAllocate(SamFile file, const SamOutputSettings *set, SamOutput *output)
{
  SamOutput o;

  PetscFunctionBegin;
  PetscCall(PetscNew(&o));
  o->f    = file;
  o->set  = *set;
  o->time = o->point = o->vtk_steps = o->closed = -1;
  o->hold.file                                  = -1;
  o->saved_time                                 = PETSC_NINFINITY;
  o->flushed                                    = MPI_Wtime();
  for (PetscInt f = 0; f < SAM_OUTPUT_MOST; f++) o->fields[f] = -1;
  for (PetscInt k = 0; k < SAM_SERIES; k++)
    for (PetscInt c = 0; c < SAM_OUTPUT_MOST; c++) o->columns[k][c] = -1;
  PetscCall(PetscMalloc1(file->grid->cells, &o->states));
  *output = o;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateDatasets(SamOutput o)
{
  PetscFunctionBegin;
  PetscCall(SamFileBegin(o->f));
  PetscCall(SamOutputCreateLayout(o));
  (void)SamFileNote(o->f, H5Fflush(o->f->id, H5F_SCOPE_GLOBAL));
  SamOutputMark(o);
  PetscCall(SamFileEnd(o->f));
  SamHoldNoteSize(&o->hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates the files; what was opened before an error is closed by the caller. */
static PetscErrorCode CreateFiles(SamGrid grid, const char filename[], SamFileUse use, const SamOutputSettings *set,
                                  SamHold *hold, SamXdmf *xdmf, SamFile *file)
{
  PetscFunctionBegin;
  PetscCall(SamHoldTake(grid, "output", filename, use, hold));
  if (set->xdmf) PetscCall(SamXdmfCreate(grid, filename, set, xdmf)); /* first: if it fails, old results are kept */
  PetscCall(SamFileOpen(grid, SAM_EVENT_OUTPUT, "output", filename, SAM_FILE_CREATE, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputCreateAs(SamGrid grid, const char filename[], SamFileUse use, const SamOutputSettings *set,
                                 SamOutput *output)
{
  SamFile        file = NULL;
  SamXdmf        xdmf = NULL;
  SamHold        hold = {.file = -1};
  PetscErrorCode ierr;

  PetscFunctionBegin;
  *output = NULL;
  PetscCall(SamInitialize());
  ierr = CreateFiles(grid, filename, use, set, &hold, &xdmf, &file);
  if (ierr) {
    PetscCall(SamXdmfDestroy(&xdmf));
    SamHoldRelease(filename, &hold);
    PetscCall(ierr);
  }
  PetscCall(SamOutputAllocate(file, set, output));
  (*output)->xdmf = xdmf;
  (*output)->hold = hold;
  PetscCall(SamHoldHadContent(grid, &hold, &(*output)->replaced));
  ierr = CreateDatasets(*output);
  if (ierr) (void)SamOutputDestroy(output);
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputCreate(SamGrid grid, const char filename[], const SamOutputSettings *set, SamOutput *output)
{
  PetscFunctionBegin;
  PetscCall(SamOutputCreateAs(grid, filename, SAM_FILE_RESULTS, set, output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Written last: a file that is not marked as closed was left by a run that did not get to its end. */
static void MarkClosed(SamOutput o)
{
  const int8_t closed = 1;

  if (o->closed >= 0 && o->f->writing && !o->unchanged)
    (void)SamFileNote(o->f, H5Awrite(o->closed, H5T_NATIVE_INT8, &closed));
}

PetscErrorCode SamOutputDestroy(SamOutput *output)
{
  SamOutput      o       = *output;
  PetscErrorCode changed = 0, ierr;

  PetscFunctionBegin;
  *output = NULL;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  if (!o->broken && o->waits) changed = SamOutputFlush(o);
  if (!changed && o->f->writing && !o->broken && !o->unchanged && !o->copying)
    changed = SamHoldCheck(o->f->grid, "output", o->f->filename, &o->hold);
  o->f->failed = PETSC_FALSE; /* earlier failures have been raised */
  PetscCall(SamFileBegin(o->f));
  if (!o->broken) {
    MarkClosed(o);
    SamOutputCloseLayout(o);
    SamFileClose(o->f);
    PetscCall(SamFileAgree(o->f)); /* all ranks have closed it */
    if (o->hold.file >= 0 && !o->f->failed && !o->unchanged && !o->copying && !changed)
      SamStructureSeal(o->f->filename);
  }
  ierr = SamFileEnd(o->f);
  SamHoldRelease(o->f->filename, &o->hold);
  PetscCall(SamXdmfDestroy(&o->xdmf));
  PetscCall(SamFileDestroy(&o->f, PETSC_FALSE));
  PetscCall(VecDestroy(&o->work));
  PetscCall(PetscFree(o->points.xy));
  PetscCall(PetscFree(o->states));
  PetscCall(PetscFree(o->singles));
  PetscCall(PetscFree(o->waiting));
  PetscCall(PetscFree(o));
  PetscCall(changed);
  PetscCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputHasReplaced(SamOutput o, PetscBool *replaced)
{
  PetscFunctionBegin;
  *replaced = o->replaced;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputNames(const char filename[], char **xdmf, char **temporary)
{
  PetscFunctionBegin;
  PetscCall(SamXdmfMakeName(filename, xdmf));
  PetscCall(SamFileNameBeside(filename, ".tmp", temporary));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputGetXdmf(SamOutput o, const char **filename)
{
  PetscFunctionBegin;
  *filename = o->xdmf ? SamXdmfGetName(o->xdmf) : NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- attributes ---- */

PetscErrorCode SamOutputSetReals(SamOutput o, const char name[], PetscInt count, const PetscReal values[])
{
  PetscFunctionBegin;
  PetscCall(SamFileBegin(o->f));
  SamFileWriteAttribute(o->f, o->f->id, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, count, values);
  PetscCall(SamFileEnd(o->f));
  SamHoldNoteSize(&o->hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputSetParameters(SamOutput o, const SamParameters *parameters)
{
  PetscFunctionBegin;
  PetscCall(SamFileBegin(o->f));
  SamParametersWrite(o->f, parameters);
  PetscCall(SamFileEnd(o->f));
  SamHoldNoteSize(&o->hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamOutputSetText(SamOutput o, const char name[], const char text[])
{
  PetscFunctionBegin;
  PetscCall(SamFileBegin(o->f));
  SamFileWriteTextAttribute(o->f, o->f->id, name, text);
  PetscCall(SamFileEnd(o->f));
  SamHoldNoteSize(&o->hold);
  PetscFunctionReturn(PETSC_SUCCESS);
}
