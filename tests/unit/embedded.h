/* Steps of a contact in another program, of which all six components are given. */
#ifndef PETSAM_TESTS_EMBEDDED_H
#define PETSAM_TESTS_EMBEDDED_H

#include "samtest.h"

#include <petsam/embed.h>

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

/* N and T_x are given, and no motion of the others. */
static inline int TryLoads(petsam_contact *c, double N, double T, double load[6], double rigid[6])
{
  const int    force[6] = {1, 1, 1, 1, 1, 1};
  const double value[6] = {N, T, 0, 0, 0, 0};

  return TryComponents(c, 1, force, value, load, rigid);
}

static inline int World(void)
{
  return (int)MPI_Comm_c2f(PETSC_COMM_WORLD);
}

static inline petsam_contact *NewContact(int comm, const char options[])
{
  petsam_contact *c    = NULL;
  const int       code = petsam_create(comm, options, &c);

  if (code) print_error("%d: %s\n", code, petsam_message(NULL));
  sam_assert(code == 0 && c && petsam_message(NULL)[0] == '\0');
  return c;
}

static inline int Says(const petsam_contact *c, const char words[])
{
  if (!strstr(petsam_message(c), words)) print_error("\"%s\" lacks \"%s\"\n", petsam_message(c), words);
  return strstr(petsam_message(c), words) != NULL;
}

#endif
