/* The inside of shear profiles. */
#ifndef PETSAM_SHEARIMPL_H
#define PETSAM_SHEARIMPL_H

#include "edgesimpl.h"
#include <math.h>

/*
  Terms of a cell: the vector that a root is multiplied by, and its quadratic function; of the pressure, of the slack,
  and of a slack that an edge left behind.
*/
enum { SAM_TERM_VECTOR = 0, SAM_TERM_FUNCTION = 2, SAM_TERM = SAM_TERM_FUNCTION + SAM_FIT_TERMS };
enum { SAM_TERM_PRESSURE, SAM_TERM_SLACK, SAM_TERM_LEFT, SAM_TERM_KINDS };

_Static_assert(SAM_SHEAR_TERMS <= SAM_SEEN_MOST, "all terms are seen at once");

struct _n_SamShearProfile {
  SamElasticity  elasticity;
  SamGrid        grid; /* of it; borrowed */
  SamShearFields fields;
  Vec            direction; /* e, two components; zero where it is not known */
  Vec            slack;
  SamProfile     profile; /* of the slack */
  SamNear        near;
};

/* The sub-cells of a cell with that function: an edge nearer to the centre than this may cut it, or nearly. */
#define SAM_SHEAR_CUT 1.5
static inline SamNearSub SamShearSubOf(const double fit[SAM_FIT_TERMS])
{
  return fit[0] < SAM_SHEAR_CUT * hypot(fit[1], fit[2]) ? SAM_NEAR_FINE : SAM_NEAR_COARSE;
}

#endif
