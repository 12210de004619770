/*
  Memory for large arrays, in large pages where the system has them. With small pages much time is lost in page faults,
  and in address translation where columns touch every row.

  Large arrays of zeros are mapped from the system, which clears a page when it is first touched; untouched pages take
  no memory. All other arrays come from the C library, which keeps freed memory for the next allocation.
*/
#include <petsam/private/baseimpl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>
#if defined(__GLIBC__)
  #include <malloc.h>
#endif

/* Arrays of zeros of at least this size (bytes) are mapped; for smaller ones rounding up to pages would waste
   memory. */
#define LARGE      ((size_t)8 << 20)
#define LARGE_PAGE ((size_t)2 << 20)

/* The mapped arrays, which SamFree() looks up */
typedef struct Mapped {
  void          *base;
  size_t         bytes;
  struct Mapped *next;
} Mapped;

static Mapped *mapped = NULL;

static void UseLargePages(void *p, size_t bytes)
{
#if defined(MADV_HUGEPAGE)
  if (bytes >= LARGE_PAGE) (void)madvise(p, bytes, MADV_HUGEPAGE);
#endif
}

/* Maps zeroed memory that begins at a huge-page boundary: maps more, and unmaps the excess at both ends. NULL: out of
   memory. */
static void *MapZeros(size_t bytes)
{
  const size_t page = (size_t)sysconf(_SC_PAGESIZE), whole = (bytes + page - 1) / page * page;
  Mapped      *m = (Mapped *)malloc(sizeof(*m));
  char  *base = m ? (char *)mmap(NULL, whole + LARGE_PAGE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)
                  : (char *)MAP_FAILED;
  size_t before;

  if (base == (char *)MAP_FAILED) {
    free(m);
    return NULL;
  }
  before = (LARGE_PAGE - (uintptr_t)base % LARGE_PAGE) % LARGE_PAGE;
  if (before) (void)munmap(base, before);
  (void)munmap(base + before + whole, LARGE_PAGE - before);
  *m     = (Mapped){.base = base + before, .bytes = whole, .next = mapped};
  mapped = m;
  UseLargePages(m->base, whole);
  return m->base;
}

PetscErrorCode SamAllocate(size_t bytes, void *pointer)
{
  void *p = NULL;

  PetscFunctionBegin;
  PetscCheck(!posix_memalign(&p, bytes >= LARGE_PAGE ? LARGE_PAGE : 64, PetscMax(bytes, 64)), PETSC_COMM_SELF,
             PETSC_ERR_MEM, "No memory for %zu bytes", bytes);
  UseLargePages(p, bytes);
  *(void **)pointer = p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SamAllocateZeros(size_t bytes, void *pointer)
{
  void *p = bytes >= LARGE ? MapZeros(bytes) : calloc(PetscMax(bytes, 1), 1);

  PetscFunctionBegin;
  PetscCheck(p, PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for %zu bytes", bytes);
  *(void **)pointer = p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SamFree(void *pointer)
{
  for (Mapped **m = &mapped; *m; m = &(*m)->next)
    if ((*m)->base == pointer) {
      Mapped *found = *m;

      (void)munmap(pointer, found->bytes);
      *m = found->next;
      free(found);
      return;
    }
  free(pointer);
}

void SamMallocTrim(void)
{
#if defined(__GLIBC__)
  (void)malloc_trim(0);
#endif
}

SAM_VECTORIZED static double SumOfSizes(PetscInt n, const double *restrict x)
{
  double sum = 0;

#pragma omp simd reduction(+ : sum)
  for (PetscInt i = 0; i < n; i++) sum += fabs(x[i]);
  return sum;
}

void SamZero(PetscInt n, double x[])
{
  enum { CHUNK = 512 };

  for (PetscInt k = 0; k < n; k += CHUNK) {
    const PetscInt count = PetscMin(CHUNK, n - k);

    if (SumOfSizes(count, x + k) != 0) (void)memset(x + k, 0, sizeof(*x) * (size_t)count);
  }
}

void SamDescribeBytes(double bytes, char text[], size_t size)
{
  const int    power   = bytes < 1e6 ? 1 : bytes < 1e9 ? 2 : bytes < 1e12 ? 3 : 4;
  const double units[] = {1, 1e3, 1e6, 1e9, 1e12};

  (void)snprintf(text, size, "%.3g %cB", bytes / units[power], " kMGT"[power]);
}
