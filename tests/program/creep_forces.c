/* Creep forces of contacts, for tests: creep_forces TABLE < contacts > results, both doubles: 9 of a contact; status, 3
   forces, 12 derivatives. creep_forces TABLE N: the time of a call (us) over N random contacts. */
#include <petsam/creep.h>
#include <time.h>

static double timed(const petsam_creep_table *table, long count)
{
  petsam_creep_contact contact = {82e9, 0.28, 1e5, 0.3, 6e-3, 4e-3, 0.0, 0.0, 0.0};
  double               force[3], derivative[12], sum = 0.0;
  unsigned int         seed = 1;
  long                 k;
  clock_t              start = clock();
  for (k = 0; k < count; k++) {
    double random[4];
    int    i;
    for (i = 0; i < 4; i++) {
      seed      = seed * 1664525u + 1013904223u;
      random[i] = (seed >> 8) / 16777216.0;
    }
    contact.half_x  = (1.0 + 9.0 * random[3]) * 1e-3;
    contact.creep_x = 6e-3 * (random[0] - 0.5);
    contact.creep_y = 6e-3 * (random[1] - 0.5);
    contact.spin    = 2.0 * (random[2] - 0.5);
    (void)petsam_creep_forces(table, &contact, force, derivative);
    sum += force[0] + derivative[0];
  }
  fprintf(stderr, "%g\n", sum);
  return 1e6 * (double)(clock() - start) / CLOCKS_PER_SEC / (double)count;
}

int main(int argc, char **argv)
{
  char                message[PETSAM_CREEP_MESSAGE] = "";
  petsam_creep_table *table                         = argc > 1 ? petsam_creep_load(argv[1], message) : NULL;
  double              given[9], found[16];
  if (!table) {
    fprintf(stderr, "%s\n", message);
    return 1;
  }
  if (argc > 2) printf("%.3f\n", timed(table, atol(argv[2])));
  while (argc == 2 && fread(given, sizeof(double), 9, stdin) == 9) {
    petsam_creep_contact contact;
    contact.shear    = given[0];
    contact.poisson  = given[1];
    contact.load     = given[2];
    contact.friction = given[3];
    contact.half_x   = given[4];
    contact.half_y   = given[5];
    contact.creep_x  = given[6];
    contact.creep_y  = given[7];
    contact.spin     = given[8];
    found[0]         = petsam_creep_forces(table, &contact, found + 1, found + 4);
    fwrite(found, sizeof(double), 16, stdout);
  }
  petsam_creep_free(table);
  return 0;
}
