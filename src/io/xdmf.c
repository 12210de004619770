/*
  A file beside the results that describes them to ParaView and VisIt (XDMF, version 2: https://xdmf.org).

  Rank 0 writes it. One system call overwrites the closing tags with the next step and new closing tags, so that the
  file is complete before and after it.
*/
#include "ioimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char SamXdmfHead[] = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n    <Grid Name=\"steps\" "
                           "GridType=\"Collection\" CollectionType=\"Temporal\">\n";
static const char tail[] = "    </Grid>\n  </Domain>\n</Xdmf>\n";

struct _n_SamXdmf {
  SamGrid           grid;
  SamOutputSettings set; /* says which fields there are */
  char             *filename;
  char             *results; /* name of the results file, without folder, escaped for XML */
  int               file;    /* on rank 0 */
  off_t             end;     /* where the closing tags are */
};

/* ---- names ---- */

PetscErrorCode SamXdmfEscape(const char text[], char **copy)
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

/* ---- text that grows ---- */

/* Appends to *text, which becomes NULL when there is no memory. */
static void Print(char **text, size_t *length, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(3, 4);
static void Print(char **text, size_t *length, const char format[], ...)
{
  va_list arguments;
  char    part[2 * PETSC_MAX_PATH_LEN], *longer;
  int     n;

  va_start(arguments, format);
  n = vsnprintf(part, sizeof(part), format, arguments);
  va_end(arguments);
  if (n < 0 || (size_t)n >= sizeof(part) || !*text) return;
  longer = (char *)realloc(*text, *length + (size_t)n + 1);
  if (!longer) free(*text);
  *text = longer;
  if (longer) memcpy(longer + *length, part, (size_t)n + 1);
  *length += (size_t)n;
}

static void PrintField(SamXdmf x, char **text, size_t *length, const char name[], const char type[], int bytes,
                       long step)
{
  const long ny = (long)x->grid->ny, nx = (long)x->grid->nx;

  Print(text, length,
        "        <Attribute Name=\"%s\" Center=\"Node\">\n          <DataItem ItemType=\"HyperSlab\" Dimensions=\"1 "
        "%ld %ld\">\n",
        name, ny, nx);
  Print(text, length, "            <DataItem Dimensions=\"3 3\" Format=\"XML\">%ld 0 0 1 1 1 1 %ld %ld</DataItem>\n",
        step, ny, nx);
  Print(text, length,
        "            <DataItem Dimensions=\"%ld %ld %ld\" NumberType=\"%s\" Precision=\"%d\" "
        "Format=\"HDF\">%s:/%s</DataItem>\n",
        step + 1, ny, nx, type, bytes, x->results, name);
  Print(text, length, "          </DataItem>\n        </Attribute>\n");
}

/*
  A step and the closing tags; NULL when there is no memory. Coordinates are in the order z, y, x. The cell centres are
  given as the points of a plane, since VTK's reader finds no cells in a single layer of cells.
*/
static char *StepText(SamXdmf x, long step, double time, size_t *length)
{
  const SamGrid g    = x->grid;
  char         *text = (char *)calloc(1, 1);

  *length = 0;
  Print(&text, length, "      <Grid Name=\"contact\" GridType=\"Uniform\">\n        <Time Value=\"%.17g\"/>\n", time);
  Print(&text, length,
        "        <Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"1 %ld %ld\"/>\n        <Geometry "
        "GeometryType=\"ORIGIN_DXDYDZ\">\n",
        (long)g->ny, (long)g->nx);
  Print(&text, length,
        "          <DataItem Dimensions=\"3\" NumberType=\"Float\" Precision=\"8\" Format=\"XML\">0 %.17g "
        "%.17g</DataItem>\n",
        (double)SamGridY(g, 0), (double)SamGridX(g, 0));
  Print(&text, length,
        "          <DataItem Dimensions=\"3\" NumberType=\"Float\" Precision=\"8\" Format=\"XML\">%.17g %.17g "
        "%.17g</DataItem>\n        </Geometry>\n",
        (double)PetscMax(g->dx, g->dy), (double)g->dy, (double)g->dx);
  for (PetscInt f = 0; f < SamOutputFieldCount; f++) {
    const PetscBool state = SamOutputFields[f].kind == SAM_FIELD_STATE;

    if (!SamOutputWantsField(&x->set, f) || SamOutputFields[f].kind == SAM_FIELD_POINTS) continue;
    PrintField(x, &text, length, SamOutputFields[f].label.name, state ? "Char" : "Float",
               state           ? 1
               : x->set.single ? 4
                               : 8,
               step);
  }
  Print(&text, length, "      </Grid>\n%s", tail);
  return text;
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

PetscErrorCode SamXdmfCreate(SamGrid grid, const char results[], const SamOutputSettings *set, SamXdmf *xdmf)
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
  x->set  = *set;
  x->file = -1;
  PetscCall(SamXdmfMakeName(results, &x->filename));
  PetscCall(SamXdmfEscape(slash ? slash + 1 : results, &x->results));
  PetscCall(SamFileCheckName(grid, "output", x->filename, SAM_FILE_XDMF));
  PetscCallMPI(MPI_Comm_rank(grid->comm, &rank));
  if (!rank) error = Begin(x);
  PetscCall(SamFileRaise(grid, "output", x->filename, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamXdmfAddStep(SamXdmf x, PetscInt step, PetscReal time)
{
  int error = 0;

  PetscFunctionBegin;
  if (x->file >= 0) error = Append(x, (long)step, (double)time);
  PetscCall(SamFileRaise(x->grid, "output", x->filename, error));
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
