/*
  A file beside the results that describes them to ParaView and VisIt (XDMF, version 2: https://xdmf.org).

  Rank 0 writes it. One system call overwrites the closing tags with the next step and new closing tags, so that the
  file is complete before and after it.
*/
#include "fileimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define OPTION "output"

const char SamXdmfHead[] = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n    <Grid Name=\"steps\" "
                           "GridType=\"Collection\" CollectionType=\"Temporal\">\n";
static const char tail[] = "    </Grid>\n  </Domain>\n</Xdmf>\n";

struct _n_SamXdmf {
  SamGrid     grid;
  SamXdmfMesh mesh;
  char       *filename;
  char       *results; /* name of the results file, without folder, escaped for XML */
  char        n[64];   /* numbers of points along z, y, x */
  int         file;    /* on rank 0 */
  off_t       end;     /* where the closing tags are */
};

/* ---- names ---- */

/* A copy of a text in which XML's own characters are escaped; the caller frees it. */
static PetscErrorCode Escape(const char text[], char **copy)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(6 * strlen(text) + 1, copy));
  (*copy)[0] = '\0';
  for (size_t k = 0; text[k]; k++) {
    const char  one[2] = {text[k], '\0'};
    const char *part   = text[k] == '&' ? "&amp;" : text[k] == '<' ? "&lt;" : text[k] == '>' ? "&gt;" : one;

    (void)strcat(*copy, part);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamXdmfMakeName(const char results[], char **name)
{
  static const char *const endings[] = {".h5", ".hdf5", ".hdf", ".vtkhdf", NULL};
  size_t                   length    = strlen(results);

  PetscFunctionBegin;
  for (PetscInt k = 0; endings[k]; k++) {
    const size_t n = strlen(endings[k]);

    if (strlen(results) > n && !strcmp(results + strlen(results) - n, endings[k])) length = strlen(results) - n;
  }
  PetscCall(PetscMalloc1(length + sizeof(".xdmf"), name));
  (void)snprintf(*name, length + sizeof(".xdmf"), "%.*s.xdmf", (int)length, results);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- text ---- */

static void PrintNumbers(FILE *out, hsize_t n, const double values[])
{
  fprintf(out, "          <DataItem Dimensions=\"%llu\" NumberType=\"Float\" Precision=\"8\" Format=\"XML\">",
          (unsigned long long)n);
  for (hsize_t k = 0; k < n; k++) fprintf(out, "%s%.17g", k % 8 ? " " : k ? "\n            " : "", values[k]);
  fprintf(out, "</DataItem>\n");
}

/*
  The points. Cell centres are given as points, since VTK's reader finds no cells in a single layer of cells. The axes
  are x, y, z; origin and spacing are z, y, x.
*/
static void PrintMesh(FILE *out, SamXdmf x)
{
  const SamXdmfMesh *m    = &x->mesh;
  const PetscBool    axes = m->axis[0] != NULL;

  fprintf(out, "        <Topology TopologyType=\"%s\" Dimensions=\"%s\"/>\n        <Geometry GeometryType=\"%s\">\n",
          axes ? "3DRectMesh" : "3DCoRectMesh", x->n, axes ? "VXVYVZ" : "ORIGIN_DXDYDZ");
  for (int d = 2; d >= 0 && axes; d--) PrintNumbers(out, m->n[d], m->axis[d]);
  if (!axes) PrintNumbers(out, 3, m->origin);
  if (!axes) PrintNumbers(out, 3, m->spacing);
  fprintf(out, "        </Geometry>\n");
}

/* A field in the HDF5 file, and of those with a layer for each step that of this one. */
static void PrintField(FILE *out, SamXdmf x, const SamXdmfField *field, long step)
{
  const char *const n         = x->mesh.rank == 3 ? x->n : strchr(x->n, ' ') + 1; /* in the dataset */
  char              steps[32] = "";

  fprintf(out, "        <Attribute Name=\"%s\" Center=\"Node\">\n", field->name);
  if (!field->constant) {
    fprintf(out,
            "          <DataItem ItemType=\"HyperSlab\" Dimensions=\"%s\">\n"
            "            <DataItem Dimensions=\"3 %d\" Format=\"XML\">%ld%s 1%s 1 %s</DataItem>\n",
            x->n, x->mesh.rank + 1, step, x->mesh.rank == 3 ? " 0 0 0" : " 0 0", x->mesh.rank == 3 ? " 1 1 1" : " 1 1",
            n);
    (void)snprintf(steps, sizeof(steps), "%ld ", step + 1);
  }
  fprintf(out,
          "            <DataItem Dimensions=\"%s%s\" NumberType=\"%s\" Precision=\"%d\" Format=\"HDF\">%s:/%s"
          "</DataItem>\n%s        </Attribute>\n",
          steps, n, field->type, field->bytes, x->results, field->name,
          field->constant ? "" : "          </DataItem>\n");
}

/* A step and the closing tags, to be freed; NULL when there is no memory. */
static char *StepText(SamXdmf x, long step, double time, size_t *length)
{
  char *text = NULL;
  FILE *out  = open_memstream(&text, length);
  int   bad;

  if (!out) return NULL;
  fprintf(out, "      <Grid Name=\"contact\" GridType=\"Uniform\">\n        <Time Value=\"%.17g\"/>\n", time);
  PrintMesh(out, x);
  for (PetscInt k = 0; k < x->mesh.count; k++) PrintField(out, x, &x->mesh.fields[k], step);
  fprintf(out, "      </Grid>\n%s", tail);
  bad = ferror(out);
  if (!fclose(out) && !bad) return text;
  free(text);
  return NULL;
}

/* ---- the file, on rank 0; these return an errno or 0 ---- */

static int WriteAt(int file, const char text[], size_t length, off_t where)
{
  while (length) {
    const ssize_t n = pwrite(file, text, length, where);

    if (n <= 0) return n ? errno : ENOSPC;
    text += n;
    where += n;
    length -= (size_t)n;
  }
  return 0;
}

static int Begin(SamXdmf x)
{
  int error;

  x->file = open(x->filename, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (x->file < 0) return errno;
  x->end = (off_t)strlen(SamXdmfHead);
  error  = WriteAt(x->file, SamXdmfHead, strlen(SamXdmfHead), 0);
  return error ? error : WriteAt(x->file, tail, strlen(tail), x->end);
}

static int Append(SamXdmf x, long step, double time)
{
  size_t length;
  char  *text = StepText(x, step, time, &length);
  int    error;

  if (!text) return ENOMEM;
  error = WriteAt(x->file, text, length, x->end);
  free(text);
  if (!error)
    x->end += (off_t)(length - strlen(tail));
  else if (!WriteAt(x->file, tail, strlen(tail), x->end))
    error = ftruncate(x->file, x->end + (off_t)strlen(tail)) ? errno : error; /* restores the earlier steps */
  return error;
}

/* ---- the object ---- */

PetscErrorCode SamXdmfCreate(SamGrid grid, const char results[], const SamXdmfMesh *mesh, SamXdmf *xdmf)
{
  SamXdmf     x;
  PetscMPIInt rank;
  const char *slash = strrchr(results, '/');
  int         error = 0;

  PetscFunctionBegin;
  PetscCall(PetscNew(&x));
  *xdmf = x;
  PetscCall(SamGridReference(grid));
  x->grid = grid;
  x->mesh = *mesh;
  x->file = -1;
  (void)snprintf(x->n, sizeof(x->n), "%llu %llu %llu", (unsigned long long)mesh->n[0], (unsigned long long)mesh->n[1],
                 (unsigned long long)mesh->n[2]);
  PetscCall(SamXdmfMakeName(results, &x->filename));
  PetscCall(Escape(slash ? slash + 1 : results, &x->results));
  PetscCall(SamFileCheckName(grid, OPTION, x->filename, SAM_FILE_XDMF));
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  if (!rank) error = Begin(x);
  PetscCall(SamFileRaise(grid, OPTION, x->filename, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamXdmfAddStep(SamXdmf x, PetscInt step, PetscReal time)
{
  int error = 0;

  PetscFunctionBegin;
  if (x->file >= 0) error = Append(x, (long)step, (double)time);
  PetscCall(SamFileRaise(x->grid, OPTION, x->filename, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *SamXdmfGetName(SamXdmf x)
{
  return x->filename;
}

PetscErrorCode SamXdmfDestroy(SamXdmf *xdmf)
{
  SamXdmf x = *xdmf;

  PetscFunctionBegin;
  *xdmf = NULL;
  if (!x) PetscFunctionReturn(PETSC_SUCCESS);
  if (x->file >= 0) (void)close(x->file);
  PetscCall(SamGridDestroy(&x->grid));
  PetscCall(PetscFree(x->filename));
  PetscCall(PetscFree(x->results));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
