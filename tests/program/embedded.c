/* Steps of a contact in a C program, all numbers to the last bit; `world`: on all ranks of its MPI. */
#include <mpi.h>
#include <petsam/embed.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv)
{
  const char     *options = argv[1], *names = "load_n,disp_x,load_ty,load_mx,load_my,load_mz";
  const int       world = argc > 2 && !strcmp(argv[2], "world");
  int             code, rank = 0;
  petsam_contact *c, *other;
  double          load[6], rigid[6], k[36], number;

  if (world) MPI_Init(&argc, &argv);
  if (world) MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  code = petsam_create(world ? (int)MPI_Comm_c2f(MPI_COMM_WORLD) : -1, options, &c);
  if (!code) code = petsam_create(-1, options, &other);
  for (int step = 1; step <= 5 && !code; step++) {
    const double x        = 1e-7 * (step <= 3 ? 1.3 * step : 1.3 * (6 - step) - 1.9);
    const double value[6] = {900 + 30 * step, x, 5, 0, 0.01, 0};
    const double mine[6]  = {500, 1e-7, 0, 0, 0, 0};

    code = petsam_try(c, step, names, value, load, rigid);
    if (!code) code = petsam_stiffness(c, 0, k);
    if (!code) code = petsam_commit(c);
    if (!code) code = petsam_get_number(c, "stored_energy", &number);
    if (!code) code = petsam_try(other, step, names, mine, NULL, NULL); /* another one, in between */
    for (int i = 0; i < 6 && !rank; i++) printf("%a %a ", load[i], rigid[i]);
    for (int i = 0; i < 36 && !rank; i++) printf("%a ", k[i]);
    if (!rank) printf("%a\n", number);
  }
  if (code) fprintf(stderr, "%d %s\n", code, petsam_message(c));
  petsam_destroy(&c);
  petsam_destroy(&other);
  if (world) MPI_Finalize();
  return code;
}
