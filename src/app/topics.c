/* What `petsam -help <topic>` says before the options of the topic; the man page has it, too. */
#include "topics.h"

static const char grid[] =
  "The grid covers the contact with equal rectangular cells; pressure and shear are constant in each.\n"
  "Any number of cells from 2 in x and in y will do; powers of two are not needed.\n"
  "\n"
  "It must be wider than the contact: contact at its edge ends the run with exit code 12, and the message says which\n"
  "-grid_size is enough. It should be fine enough for 20 cells across the smallest contact; fewer are warned of.\n"
  "Time and memory grow with the number of cells, the number of iterations hardly does.\n";

static const char bodies[] =
  "Two isotropic elastic bodies, of which one may be rigid (-body1_young inf). Body 1 is the upper one.\n"
  "\n"
  "-elasticity halfspace takes both as half-spaces: the contact must be small against the radii of curvature.\n"
  "-elasticity periodic takes the grid as one period of both bodies in x and y. There is then no edge of the grid, "
  "and\n"
  "moments, rotations and bulk stress have no meaning; a displacement -disp_z counts from the mean surface.\n"
  "Bodies of unlike material are coupled, see -help contact.\n";

static const char friction[] =
  "Coulomb's law in every cell: |q| <= mu p, and |q| = mu p against the slip where the surfaces slip.\n"
  "mu is one number, or a dataset of an HDF5 file with a value for each cell. A history may scale it by its column\n"
  "friction_scale. Without friction no tangential force has an equilibrium (exit code 11).\n";

static const char plastic[] =
  "With a limit no cell bears more pressure than the hardness, which is about three times the yield stress. Where the\n"
  "pressure reaches it the surfaces yield by their overlap, which stays for later steps: unloading is elastic.\n"
  "Not together with -normal_type polonskykeer, -edges deferred or -wear_cycles.\n";

static const char gap[] =
  "The separation of the undeformed surfaces, h(x, y) in m, by its type:\n"
  "\n"
  "  sphere      (x^2 + y^2)/2R with 1/R = 1/radius1 + 1/radius2; a radius of inf: flat\n"
  "  ellipsoid   x^2/2Rx + y^2/2Ry\n"
  "  punch       0 for r <= c, (r - c)^2/2R beyond: flat base of radius c with a rounded edge of radius R\n"
  "  flat        0\n"
  "  file        a dataset (ny, nx) of an HDF5 file\n"
  "\n"
  "A roughness is added to any of them by -gap_rough_file. A dataset holds a separation in m, unless its attributes\n"
  "`units` (m, mm, um, nm, ...) and `quantity` (separation, height1, height2: heights of a body) say otherwise.\n"
  "petsam-surface makes such files from measured surfaces.\n";

static const char loads[] =
  "Six pairs, in each of which the load or the displacement is given, not both; what is not given is a load of 0:\n"
  "\n"
  "  load_n   disp_z      normal force, N; approach, m: one of them is required\n"
  "  load_tx  disp_x      tangential forces, N; displacements, m\n"
  "  load_ty  disp_y\n"
  "  load_mx  rot_x       moments about the origin, N m; rotations, rad\n"
  "  load_my  rot_y\n"
  "  load_mz  rot_z\n"
  "\n"
  "Slip depends on the path: -steps 10 brings the loads up in ten steps, -history tells a path (see -help history; "
  "for\n"
  "the directions see -help signs). Bulk stress, tension positive, stretches the surface of its body about the "
  "origin.\n";

static const char history[] =
  "A history is a text file with a row for each load step. Its first line names the columns: time, and any of the "
  "loads\n"
  "and displacements under their options' names, without units. Commas, semicolons or white space separate the "
  "columns;\n"
  "numbers have a decimal point; # begins a comment:\n"
  "\n"
  "  # strokes.csv: one and a half fretting strokes at constant N, which is an option\n"
  "  time, load_tx\n"
  "  0,    0\n"
  "  1,    60\n"
  "  2,   -60\n"
  "  3,    60\n"
  "\n"
  "  petsam -options_file sphere.opts -history strokes.csv -steps 20 -output strokes.h5\n"
  "\n"
  "Each row is reached in -steps equal increments. Times increase. The start, before the first row, is unloaded; a "
  "first\n"
  "row in which nothing is loaded or displaced is the start itself, and one step. Loads that are options grow during "
  "the\n"
  "increments up to the first row and then stay. A load that has a column must not be given as an option as well; in "
  "an\n"
  "options file, its value is not used. Further columns: friction_scale, a factor on the friction (1), and the bulk\n"
  "stresses, bulk1_stress_xx and so on. A step takes its new N first, and then what acts tangentially: more -steps\n"
  "where both change much at once.\n";

static const char signs[] =
  "Body 1 is the upper one and carries the loads, body 2 is fixed; z points into body 2. With pressure p and shear q "
  "on\n"
  "body 2, and all moments about x = y = 0:\n"
  "\n"
  "  N  = sum p dA      Mx = -sum y p dA      My = sum x p dA\n"
  "  Tx = sum q_x dA    Ty =  sum q_y dA      Mz = sum (x q_y - y q_x) dA\n"
  "\n"
  "disp_x, disp_y, disp_z, rot_x, rot_y, rot_z are rigid displacements of body 1. Moments and rotations are "
  "right-handed\n"
  "about x, y and the normal that points up. Slip is opposite to the shear: negative under a positive Tx.\n";

static const char wear[] =
  "Surfaces lose material where they slip, by Archard's law, depth = k p |ds|, or by the energy of friction, depth =\n"
  "alpha |q.ds|; each body has its coefficient. Without -wear_cycles every step of the history wears.\n"
  "\n"
  "With -wear_cycles n the history is one closed cycle, repeated n times: its first row is where the cycle starts, "
  "its\n"
  "last row names the same loads. Cycles are computed one by one with jumps over many between them, whose error stays\n"
  "near -wear_rtol:\n"
  "\n"
  "  petsam -options_file sphere.opts -history cycle.csv -steps 5 -wear_coefficient1 1e-14 -wear_cycles 1e5 \\\n"
  "    -wear_output 0,1e4 -output life.h5\n";

static const char report[] =
  "A run prints a line a load step once its results are on disk: time, loads, areas of contact and stick, largest\n"
  "pressure, shear and slip, iterations and checked residuals of the normal (n) and tangential (t) problem, seconds "
  "so\n"
  "far and to come. Warnings and errors go to stderr.\n";

static const char checkpoints[] =
  "With -checkpoint a run that was stopped goes on from where it was, by the same command with -restart:\n"
  "\n"
  "  petsam -options_file study.opts -output loop.h5 -checkpoint state.h5 -checkpoint_every 10 -max_walltime 11:50:00\n"
  "  petsam -options_file study.opts -output loop.h5 -checkpoint state.h5 -checkpoint_every 10 -max_walltime 11:50:00 "
  "\\\n"
  "    -restart state.h5\n"
  "\n"
  "It ends with exit code 75 before the time is up or on the signal USR1; on USR2 it writes a checkpoint and goes on.\n"
  "The one before is kept as state.h5.1. With a new name of -output the restart begins a branch: a file of the steps\n"
  "after the checkpoint, whose history may differ from there on.\n";

static const char results[] =
  "-output names an HDF5 file. Fields (time, ny, nx) of the steps that -output_every chooses and of the last one:\n"
  "pressure, shear_x, shear_y (Pa), slip_x, slip_y (m), state (0 open, 1 stick, 2 slip), and others by "
  "-output_fields;\n"
  "/history has numbers of every step: loads, displacements, areas, largest values, energies, residuals, iterations.\n"
  "\n"
  "  petsam-plot sphere.h5                          draws all that the file is good for\n"
  "  import petsam; petsam.open(\"sphere.h5\")        reads it in Python; so do h5py and xarray\n"
  "\n"
  "ParaView and VisIt open the .xdmf file beside it. The file can be read while the run goes on.\n";

static const char contact[] =
  "How the normal and the tangential problem are brought together, and what is made of the solution.\n"
  "\n"
  "Unlike bodies are coupled: the pressure displaces their surfaces tangentially, the shear normally. -coupling none\n"
  "neglects that. -edges reconstruct takes areas from edges that run through the cells; deferred solves again for the\n"
  "pressure and shear within the cells along them (not for unlike bodies with friction); none counts cells.\n";

static const char normal[] =
  "Pressure where the surfaces touch, none where they are apart. activeset takes a number of iterations that does not\n"
  "grow with the grid; polonskykeer is the classical method, for comparison. After exit code 10 more iterations\n"
  "(-normal_max_it) help if the error was still falling (-normal_monitor).\n";

static const char tangential[] = "Where the surfaces stick, where they slip, and the shear. newton takes few "
                                 "iterations on any grid; gradient is slow\n"
                                 "and simple, a second opinion. -tangential_rtol is the residual of q = D(q - ds/c) "
                                 "relative to the largest shear, D the\n"
                                 "projection on |q| <= mu p, ds the slip of the step. After exit code 10 more "
                                 "iterations (-tangential_max_it) help if\n"
                                 "the error was still falling (-tangential_monitor).\n";

static const char exit_codes[] =
  "  0   every step converged, and the independent check agrees\n"
  "  2   bad usage: the message names the option, or the file and line; nothing was written\n"
  "  3   a file that cannot be read or written, or whose content does not fit\n"
  "  10  a step did not converge: the results up to there are written, and marked\n"
  "  11  no equilibrium: gross slip under force control, or moments that no pressure on this grid balances\n"
  "  12  the contact reached the edge of the grid: results up to that step are written, and marked;\n"
  "      -allow_edge_contact makes it a warning\n"
  "  75  stopped before the end, with a checkpoint: go on with -restart\n"
  "\n"
  "Others are PETSc's own.\n";

static const char petsc[] =
  "Options stand on the command line, in files named by -options_file, and in the variable PETSC_OPTIONS; the command\n"
  "line overrides the others. An option that nobody asks for is refused. Options of PETSc work too, but for those "
  "that\n"
  "load code, start other programs, trap infinite numbers, or write a file for each rank.\n"
  "-help json prints topics and options in a form for other programs.\n";

const SamTopic SamPetsamTopics[] = {{"grid", {"Grid"}, grid},
                                    {"bodies", {"Bodies", "Elasticity"}, bodies},
                                    {"friction", {"Friction"}, friction},
                                    {"plastic", {"Plastic deformation"}, plastic},
                                    {"gap", {"Gap"}, gap},
                                    {"loads", {"Loads and displacements"}, loads},
                                    {"history", {NULL}, history},
                                    {"signs", {NULL}, signs},
                                    {"wear", {"Wear"}, wear},
                                    {"report", {"What the run prints"}, report},
                                    {"checkpoints", {"Checkpoints"}, checkpoints},
                                    {"results", {"Results and resources"}, results},
                                    {"contact", {"Contact"}, contact},
                                    {"normal", {"Solver of the normal problem"}, normal},
                                    {"tangential", {"Solver of the tangential problem"}, tangential},
                                    {"exit codes", {NULL}, exit_codes},
                                    {"petsc", {SAM_TOPIC_EVERY_PROGRAM}, petsc},
                                    {NULL}};
