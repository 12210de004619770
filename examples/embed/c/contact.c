/*
  A sphere on a plane, in a program that knows nothing of MPI or PETSc: pressed by 1000 N and moved sideways until it
  bears 60 N, by Newton's method with the tangent stiffness; then the next steps go on from there.
*/
#include <math.h>
#include <petsam/embed.h>
#include <stdio.h>

#define OPTIONS \
  "-grid_n 128 -grid_size 2.6e-3 -body1_young 210e9 -body1_poisson 0.3 -body2_young 210e9 -body2_poisson 0.3 " \
  "-friction 0.1 -gap_type sphere -gap_radius1 0.1 -gap_radius2 inf"

enum { N, TX, COMPONENTS = 6 };

/* Tries the displacement d_x (m), all else being loads. Returns petsam's code. */
static int Try(petsam_contact *c, double time, double d_x, double load[], double rigid[])
{
  const double values[] = {1000, d_x};

  return petsam_try(c, time, "load_n,disp_x", values, load, rigid);
}

/* Finds the displacement under which the contact bears T (N), from the one before. Returns petsam's code. */
static int Find(petsam_contact *c, double time, double T, double *d_x, double load[], double rigid[])
{
  double k[COMPONENTS * COMPONENTS];
  int    code = Try(c, time, *d_x, load, rigid);

  for (int trial = 1; !code && fabs(load[TX] - T) > 1e-6 * fabs(T) && trial < 20; trial++) {
    code = petsam_stiffness(c, 0, k);
    if (code) break;
    *d_x += (T - load[TX]) / k[COMPONENTS * TX + TX];
    code = Try(c, time, *d_x, load, rigid);
  }
  return code;
}

int main(void)
{
  const double    loads[] = {20, 40, 60, 0, -60};
  double          load[COMPONENTS], rigid[COMPONENTS], d_x = 0, energy;
  petsam_contact *c;
  int             code = petsam_create(-1, OPTIONS, &c);

  for (int k = 0; !code && k < 5; k++) {
    code = Find(c, k + 1, loads[k], &d_x, load, rigid);
    if (!code) code = petsam_commit(c);
    if (!code) code = petsam_get_number(c, "dissipated_energy", &energy);
    if (!code) printf("T %6.2f N  d_x %13.6e m  approach %.6e m  dissipated %.3e J\n", load[TX], d_x, rigid[N], energy);
  }
  if (code) fprintf(stderr, "%s\n", petsam_message(c));
  petsam_destroy(&c);
  return code;
}
