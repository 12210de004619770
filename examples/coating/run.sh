#!/bin/sh
# Press a rigid sphere on coated flats: films of several moduli and thicknesses; slide two coated bodies in part.
#
#   examples/coating/run.sh
#
# Works from any directory. Environment:
#   PETSAM   the program              (build/bin/petsam of the repository)
#   NP       MPI ranks                (2)
#   GRID_N   cells in each direction  (128)
#   OUT      results and figures, relative to the repository's root  (build/coating)
#   PYTHON   a Python with scripts/requirements.txt  (build/venv/bin/python of the repository)
#   MPIRUN   the MPI launcher         (mpirun)
set -eu

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
example=coating
default_n=128
# shellcheck source=examples/common.sh
. "$here/../common.sh"

radius=3.19181e-4 # Hertz's contact radius without coating, m

# The film's modulus over the substrate's, its thickness over that radius; a soft film widens the contact.
for ratio in 0.1 0.5 2 10; do
    for thickness in 0.1 0.17 0.3 0.45 0.6 0.8 1 1.7 3; do
        solve_quietly "e${ratio}_h$thickness" -options_file "$here/coating.opts" -grid_n "$grid_n" \
            -body2_layer_young "$(evaluate "$ratio * 210e9")" -body2_layer_poisson 0.3 \
            -body2_layer_thickness "$(evaluate "$thickness * $radius")" \
            -grid_size "$(evaluate "2.7 * $radius * ($ratio < 1 ? $ratio ^ (-1 / 3) : 1)")"
    done
done

# Two alike bodies, each with the film: friction 0.1, and a tangential force of 0.6 mu N.
slide() {
    name=$1
    shift
    solve_quietly "$name" -options_file "$here/coating.opts" -body1_young 210e9 -body1_poisson 0.3 -friction 0.1 \
        -load_tx 6 -grid_n "$grid_n" -grid_size 1.5e-3 "$@"
}
film() { # film RATIO: options of a film of half the radius on both bodies; none for 1
    [ "$1" != 1 ] || return 0
    for body in 1 2; do
        printf '%s ' "-body${body}_layer_young $(evaluate "$1 * 210e9") -body${body}_layer_poisson 0.3" \
            "-body${body}_layer_thickness $(evaluate "0.5 * $radius")"
    done
}
for ratio in 0.1 1 10; do
    # shellcheck disable=SC2046 # several words
    slide "slide_e$ratio" $(film "$ratio")
done

# The sphere slides along x, almost in full: tension at the surface behind it, and through films and a graded surface.
printf 'depth,young,poisson\n0,420e9,0.3\n3e-4,210e9,0.3\n' >"$out/graded.csv"
pull() {
    film=$1
    shift
    solve_quietly "pull_$film" -options_file "$here/coating.opts" -friction 0.3 -load_tx 29.7 -steps 8 -grid_n 129 \
        -grid_size 1e-3 "$@"
    stress "pull_$film" "pull_$film-stress" -section y=0 -depths 0:3e-4:121 -quantities principal
}
coat() { # coat NAME MODULUS THICKNESS
    pull "$1" -body2_layer_young "$2" -body2_layer_poisson 0.3 -body2_layer_thickness "$3"
}
pull none
coat soft 84e9 1e-4
coat hard 840e9 1e-4
coat thin 840e9 3e-5
pull graded -body2_layer_file "$out/graded.csv"
compare
