/* What `petsam-stress -help <topic>` says before the options of the topic; the man page has it, too. */
#include "../topics.h"

static const char files[] =
  "petsam-stress takes pressure and shear from a results file of petsam, and the bodies from its attributes. It needs\n"
  "the fields pressure, shear_x and shear_y there, and elastic half-spaces; ruiz also needs the slip.\n";

static const char places[] =
  "-depths 0:1e-3:64 and -section y=0 make a section of the body, from the surface to 1 mm; without -section there is "
  "a\n"
  "whole map for each depth. -steps names load steps as petsam numbers them; their fields must have been saved\n"
  "(-output_every of petsam).\n";

static const char quantities[] =
  "Tension is positive, z points into the body. On the surface of body 2 sigma_zz = -p, sigma_xz = -q_x,\n"
  "sigma_yz = -q_y, of body 1 sigma_zz = -p, sigma_xz = q_x, sigma_yz = q_y. The bulk stress of the body is added.\n"
  "\n"
  "  stress      stress_xx, _yy, _zz, _xy, _xz, _yz, Pa\n"
  "  mises       von Mises' equivalent stress, Pa\n"
  "  principal   principal_1 >= principal_2 >= principal_3, Pa\n"
  "  shear_max   largest shear stress, Pa\n"
  "  strain      strain_xx ... strain_yz, tensor shear strains\n"
  "\n"
  "Each is a dataset (time, z, y, x); a section has one y or one x. /history/mises_max has the largest of each step.\n";

static const char fatigue[] =
  "Parameters over the chosen steps, taken as one closed cycle: the last step is followed by the first. Datasets\n"
  "(z, y, x), whose attributes `largest` and `largest_at` tell the largest value and its place. n is a plane's "
  "normal,\n"
  "s_n and e_n stress and strain along it, tau_a the radius of the smallest circle about the shear stress in it:\n"
  "\n"
  "  swt             largest over n of max(s_n) times half the range of e_n, Pa\n"
  "  fatemi_socie    largest over n of tau_a/G (1 + k max(s_n)/yield)\n"
  "  findley         largest over n of tau_a + k max(s_n), Pa\n"
  "  crossland       R/sqrt(2) + alpha max(P_H), Pa; R the radius of the smallest sphere about the deviator's path\n"
  "  dang_van        largest over time of tau + alpha P_H, Pa; tau of the deviator less that sphere's centre\n"
  "  ruiz            a quarter of the cycle's work of friction, J/m2, and this times the largest tension along the "
  "slip\n"
  "\n"
  "  petsam-stress -input cycle.h5 -output fatigue.h5 -section y=0 -depths 0:4e-4:33 -steps 21:40 -fatigue swt\n";

static const char resources[] =
  "A map needs about 223 bytes a cell, fatigue parameters of maps 48 more for each step of the cycle.\n";

static const char exit_codes[] = "  0   done\n"
                                 "  2   bad usage: the message names the option; nothing was written\n"
                                 "  3   a file that cannot be read or written, or whose content does not fit\n"
                                 "\n"
                                 "Others are PETSc's own.\n";

static const char petsc[] =
  "Options stand on the command line, in files named by -options_file, and in the variable PETSC_OPTIONS; the command\n"
  "line overrides the others. An option that nobody asks for is refused.\n"
  "-help json prints topics and options in a form for other programs.\n";

const SamTopic SamStressTopics[] = {{"files", {"Files"}, files},
                                    {"places", {"Where and when"}, places},
                                    {"quantities", {"What"}, quantities},
                                    {"fatigue", {"Fatigue"}, fatigue},
                                    {"resources", {"Resources"}, resources},
                                    {"exit codes", {NULL}, exit_codes},
                                    {"petsc", {SAM_TOPIC_EVERY_PROGRAM}, petsc},
                                    {NULL}};
