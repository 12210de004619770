/* The transform in single precision. */
#define Real      float
#define FFT(x)    fftwf_##x
#define LINE      SamLineSingle
#define TRANSFORM SamTransformSingle
#define PART      in_single
#define DATA      single
#define DESTROY   SamTransformDestroySingle
#define APPLY     SamFourierApplySingle
#include "transform.h"
