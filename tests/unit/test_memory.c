/* Memory of arrays: SamAllocate(), SamAllocateZeros(), SamFree(). */
#include "samtest.h"
#include <petsam/private/baseimpl.h>
#include <string.h>

/* around the sizes from which arrays are in large pages, and come from the system */
static const size_t sizes[] = {0,
                               1,
                               65,
                               4096,
                               ((size_t)2 << 20) - 1,
                               (size_t)2 << 20,
                               ((size_t)8 << 20) - 1,
                               (size_t)8 << 20,
                               ((size_t)8 << 20) + 1,
                               ((size_t)23 << 20) + 4097};
#define SIZES (sizeof(sizes) / sizeof(sizes[0]))

static int IsAll(const unsigned char *p, size_t bytes, unsigned char value)
{
  return bytes == 0 || (p[0] == value && !memcmp(p, p + 1, bytes - 1));
}

static void test_zeros_are_zero_where_other_arrays_have_been(void **state)
{
  (void)state;
  for (int round = 0; round < 3; round++)
    for (size_t k = 0; k < SIZES; k++) {
      unsigned char *zeros, *other;

      sam_call(SamAllocateZeros(sizes[k], &zeros));
      sam_call(SamAllocate(sizes[SIZES - 1 - k], &other));
      sam_assert(IsAll(zeros, sizes[k], 0));
      memset(zeros, 0xff, sizes[k]);
      memset(other, 0xff, sizes[SIZES - 1 - k]);
      SamFree(zeros);
      SamFree(other);
    }
}

static void test_arrays_do_not_overlap_and_may_be_freed_in_any_order(void **state)
{
  static const size_t order[SIZES] = {7, 2, 9, 0, 5, 8, 1, 6, 3, 4};
  unsigned char      *array[SIZES];

  (void)state;
  for (size_t k = 0; k < SIZES; k++) {
    if (k % 2)
      sam_call(SamAllocate(sizes[k], &array[k]));
    else
      sam_call(SamAllocateZeros(sizes[k], &array[k]));
    memset(array[k], (int)k + 1, sizes[k]);
  }
  for (size_t k = 0; k < SIZES; k++) {
    sam_assert(IsAll(array[order[k]], sizes[order[k]], (unsigned char)(order[k] + 1)));
    SamFree(array[order[k]]);
  }
  SamFree(NULL);
}

static void test_arrays_are_aligned_for_vectors(void **state)
{
  (void)state;
  for (size_t k = 0; k < SIZES; k++) {
    void *p;

    sam_call(SamAllocate(sizes[k], &p));
    sam_assert((uintptr_t)p % 64 == 0);
    SamFree(p);
  }
}

static void test_more_than_there_is_is_an_error(void **state)
{
  const size_t much = (size_t)1 << 60;
  void        *p;

  (void)state;
  sam_call(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  sam_assert(SamAllocate(much, &p) == PETSC_ERR_MEM);
  sam_assert(SamAllocateZeros(much, &p) == PETSC_ERR_MEM);
  sam_call(PetscPopErrorHandler());
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_zeros_are_zero_where_other_arrays_have_been),
    cmocka_unit_test(test_arrays_do_not_overlap_and_may_be_freed_in_any_order),
    cmocka_unit_test(test_arrays_are_aligned_for_vectors),
    cmocka_unit_test(test_more_than_there_is_is_an_error),
  };

  return SamTestMain(argc, argv, tests, sizeof(tests) / sizeof(tests[0]));
}
