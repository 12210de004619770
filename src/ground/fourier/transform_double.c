/* The transform in double precision. */
#define Real      double
#define FFT(x)    fftw_##x
#define LINE      SamLineDouble
#define TRANSFORM SamTransformDouble
#define PART      in_double
#define DATA      data
#define DESTROY   SamTransformDestroyDouble
#define APPLY     SamFourierApply
#include "transform.h"
