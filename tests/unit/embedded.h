/* Steps of a contact in another program, of which all six components are given. */
#ifndef PETSAM_TESTS_EMBEDDED_H
#define PETSAM_TESTS_EMBEDDED_H

#include <petsam/embed.h>
#include <stddef.h>

/* petsam_try() with a load where `force` is 1, or else a displacement. */
static inline int TryComponents(petsam_contact *c, double time, const int force[6], const double value[6],
                                double load[6], double rigid[6])
{
  static const char *const loads[]   = {"load_n", "load_tx", "load_ty", "load_mx", "load_my", "load_mz"};
  static const char *const rigids[]  = {"disp_z", "disp_x", "disp_y", "rot_x", "rot_y", "rot_z"};
  char                     names[64] = "";

  for (int k = 0; k < 6; k++)
    (void)snprintf(names + strlen(names), sizeof(names) - strlen(names), "%s%s", k ? "," : "",
                   force[k] ? loads[k] : rigids[k]);
  return petsam_try(c, time, names, value, load, rigid);
}

#endif
