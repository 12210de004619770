/* Writes speed, creepage and force of a wheel on a rail as CSV: curve TABLE */
#include <petsam/creep.h>

int main(int argc, char **argv)
{
  char                 message[PETSAM_CREEP_MESSAGE];
  petsam_creep_table  *table   = petsam_creep_load(argc > 1 ? argv[1] : "creep-forces.bin", message);
  petsam_creep_contact contact = {82e9, 0.28, 106.7e3, 0.0, 6.3036e-3, 12.607e-3, 0.0, 0.0, 0.0};
  double               force[3], derivative[12], speed;
  int                  k;

  if (!table) return fprintf(stderr, "%s\n", message), 1;
  puts("speed,creep_x,force_x,slope_x");
  for (speed = 5.0; speed < 50.0; speed *= 3.0) { /* m/s */
    for (k = 1; k <= 8; k++) {
      contact.creep_x  = 1e-3 * k * k / 2;
      contact.friction = 0.14 + 0.19 * pow(2.0, -speed * petsam_creep_slip(&contact) / 1.25); /* falls with the slip */
      if (petsam_creep_forces(table, &contact, force, derivative) == PETSAM_CREEP_INVALID) return 1;
      printf("%g,%g,%.0f,%.3g\n", speed, contact.creep_x, force[0], derivative[0]);
    }
  }
  petsam_creep_free(table);
  return 0;
}
