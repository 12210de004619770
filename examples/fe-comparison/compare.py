"""Solve the sphere in CalculiX and in petsam under equal forces, and measure what each costs.

In CalculiX the displacement of the hemispheres' flat tops is prescribed: Hertz's approach for a wanted contact radius.
That is not the half-space's approach of distant points, so petsam gets the forces that came out, not the displacements.

Writes to a directory, one HDF5 file a run with its costs as attributes:
  mesh_N.h5                the sequence of meshes at Table 1's contact, N elements along the cube's edge
  mesh_N_direct.h5         the same by the direct solver
  small_R.h5               contact radius R times the sphere's
  large_R.h5, neo_R.h5     the same with large displacements, after St. Venant and Kirchhoff, and neo-Hooke
  stiffness_F.h5           the first of these with contact stiffness times F
  tangential.h5            both hemispheres with friction
  petsam_...h5             petsam at the same loads; the grids at Table 1's contact are petsam_grid_N.h5
figures.py reads these. Every run has one process and one thread.
"""

import argparse
import glob
import os
import shutil
import subprocess
import sys
import time

import h5py
import numpy as np

import model
import surface as results_of_calculix
from petsam.closed import Bodies, Spheres
from petsam.core.line import fail

PACKAGE = "calculix-ccx"
HALF_WIDTH = 1.5  # of petsam's grids in contact radii, as in Table 1
LOAD_RATIO = 0.6  # tangential force over mu N that the tangential displacement is of
TABLE1 = model.Study()
# small strains and displacements; large ones with two laws of material
LAWS = {
    "small": model.Controls(),
    "large": model.Controls(nlgeom=True),
    "neo": model.Controls(nlgeom=True, neo_hooke=True),
}


class RunError(Exception):
    """A program that is missing or fails."""


# ---------------------------------------------------------------- running and measuring

# A process inherits the peak memory of the one that forks it, so a small interpreter starts the program, not this one.
STARTER = """
import os, sys
with open(sys.argv[1], "w") as log:
    pid = os.fork()
    if pid == 0:
        os.dup2(log.fileno(), 1)
        os.dup2(log.fileno(), 2)
        os.execvp(sys.argv[2], sys.argv[2:])
_, status, used = os.wait4(pid, 0)
print(os.WEXITSTATUS(status) if os.WIFEXITED(status) else 128 + os.WTERMSIG(status))
print(used.ru_utime + used.ru_stime, used.ru_maxrss)
"""


def measured(command, directory, log):
    """Run a program to its end; its CPU time (s), wall time (s) and peak memory (bytes)."""
    start = time.monotonic()
    done = subprocess.run(
        [sys.executable, "-I", "-S", "-c", STARTER, log, *command],
        cwd=directory,
        check=True,
        text=True,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        env=dict(os.environ, OMP_NUM_THREADS="1"),
    )
    code, cpu, memory = done.stdout.split()
    if code != "0":
        raise RunError(f"{command[0]} failed with exit code {code}, see {log}")
    unit = 1 if sys.platform == "darwin" else 1024
    return {"cpu": float(cpu), "wall": time.monotonic() - start, "memory": unit * int(memory)}


def calculix(ccx, base):
    """Solve base.inp; CalculiX says of failures in words, not in its exit code."""
    directory, name = os.path.split(base)
    used = measured([ccx, name], directory, base + ".log")
    with open(base + ".log", encoding="utf-8", errors="replace") as log:
        text = log.read()
    if "Job finished" not in text or "*ERROR" in text:
        raise RunError("{} did not finish, see {}".format(ccx, base + ".log"))
    with open(base + ".cvg", encoding="utf-8") as log:
        used["iterations"] = sum(line.split()[0].isdigit() for line in log if line.strip())
    return used


def solve_mesh(options, name, n, study=TABLE1, controls=LAWS["small"], tangential=0.0):
    """One CalculiX model and its results in name.h5; the Surface. tangential: displacement along x, mm."""
    base = os.path.join(options.directory, name)
    down = study.contact_radius**2 / study.radius  # of one sphere
    if tangential:
        mesh = model.tangential_deck(base + ".inp", n, study, 2.0 * down, tangential, controls)
    else:
        mesh = model.normal_deck(base + ".inp", n, study, down, controls)
    used = calculix(options.ccx, base)
    parts, bodies = (2, 2) if tangential else (4, 1)
    surface = results_of_calculix.read_surface(base, mesh, model.rim(mesh)[0], parts, controls.nlgeom, bool(tangential))
    for ending in (".inp", ".frd", ".12d", ".sta"):
        if os.path.exists(base + ending) and not options.keep:
            os.remove(base + ending)
    write_surface(
        base + ".h5",
        surface,
        study,
        {
            **used,
            "parts": parts,
            "n": n,
            "elements": bodies * len(mesh.elements),
            "nodes": bodies * len(mesh.nodes),
            "element_size": 1e-3 * model.element_size(study, n),
            "solver": controls.solver,
            "stiffness": 1e9 * (controls.stiffness or model.default_stiffness(study, n)),
        },
    )
    report(name, used, f"{bodies * len(mesh.elements)} elements, N = {surface.load_n:.6g} N")
    return surface


def write_surface(path, surface, study, attributes):
    """A Surface, with the closed solutions for its loads and what was known before, in SI units."""
    load_tx = tangential_force(surface, attributes["parts"])
    spheres = spheres_of(surface.load_n, study)
    stick = spheres.stick_radius(load_tx)
    with h5py.File(path, "w") as file:
        for name in ("x", "y", "area", "pressure", "shear_x", "shear_y", "cpress"):
            file[name] = getattr(surface, name)
        file["hertz_pressure"] = surface.nodal_mean(spheres.pressure)
        file["cattaneo"] = surface.nodal_mean(lambda r: spheres.shear(r, stick))
        file.attrs.update(attributes)
        file.attrs.update(
            {
                "load_n": surface.load_n,
                "load_tx": load_tx,
                "contact_radius": surface.contact_radius(1.0 / attributes["parts"]),
                "hertz_radius": spheres.hertz.radius,
                "hertz_peak": spheres.hertz.pressure,
                "hertz_approach": spheres.hertz.approach,
                "approach": 2e-3 * study.contact_radius**2 / study.radius,
                "sphere_radius": 1e-3 * study.radius,
                "young": 1e6 * study.young,
                "poisson": study.poisson,
                "friction": study.friction,
            }
        )


def tangential_force(surface, parts):
    """T_x, N, of both spheres: the sum of the shear (the top's reaction converges later); 0 for a quarter of one."""
    return parts * float(np.sum(surface.area * surface.shear_x)) if parts == 2 else 0.0


def spheres_of(load_n, study):
    """Two such spheres under load_n (N), SI units."""
    body = (1e6 * study.young, study.poisson)
    return Spheres(Bodies(*body, *body), 0.5e-3 * study.radius, study.friction, load_n)


def solve_petsam(options, name, grid, surface, study=TABLE1, parts=4, true_sphere=False):
    """petsam under the Surface's forces, results in name.h5; true_sphere: not the paraboloid."""
    path = os.path.join(options.directory, name + ".h5")
    size = 2.0 * HALF_WIDTH * 1e-3 * study.contact_radius
    words = {"grid_n": grid, "grid_size": size, "load_n": surface.load_n, "friction": study.friction, "output": path}
    for body in (1, 2):
        words[f"body{body}_young"], words[f"body{body}_poisson"] = 1e6 * study.young, study.poisson
        words[f"gap_radius{body}"] = 1e-3 * study.radius
    words["gap_type"] = "sphere"
    if true_sphere:
        del words["gap_radius1"], words["gap_radius2"]
        gap = os.path.join(options.directory, name + "_gap.h5")
        write_sphere(gap, grid, size, 1e-3 * study.radius)
        words.update({"gap_type": "file", "gap_file": gap, "gap_dataset": "/height"})
    if parts == 2:
        words["load_tx"] = tangential_force(surface, parts)
    command = [options.petsam] + [word for key, value in words.items() for word in ("-" + key, str(value))]
    used = measured(command, options.directory, path[:-3] + ".log")
    with h5py.File(path, "a") as file:
        file.attrs.update(used)
    report(name, used, f"{grid} x {grid} cells")


def write_sphere(path, grid, size, radius):
    """Separation of two spheres of that radius (m) that touch at a point."""
    x = ((np.arange(grid) + 0.5) / grid - 0.5) * size
    with h5py.File(path, "w") as file:
        file["height"] = 2.0 * (radius - np.sqrt(radius**2 - x[:, None] ** 2 - x**2))


def forget(options, pattern):
    """Remove earlier results, which the figures would take for this run's."""
    for path in glob.glob(os.path.join(options.directory, pattern)):
        os.remove(path)


def report(name, used, what):
    """A line a run."""
    print("== {}: {}, CPU {:.1f} s, {:.0f} MB".format(name, what, used["cpu"], used["memory"] / 1e6), flush=True)


# ---------------------------------------------------------------- the studies


def table_of_meshes(options):
    """Meshes and grids at Table 1's contact. The finest mesh's load is petsam's."""
    forget(options, "mesh_*.h5")
    forget(options, "petsam_grid_*.h5")
    for n in options.meshes:
        surface = solve_mesh(options, f"mesh_{n}", n)
    for grid in options.grids:
        solve_petsam(options, f"petsam_grid_{grid}", grid, surface)
    solve_mesh(options, f"mesh_{options.direct}_direct", options.direct, controls=model.Controls(solver="SPOOLES"))


def growing_contact(options):
    """Contact radii up to a fifth of the sphere's; and what the contact stiffness does to the smallest."""
    for kind in LAWS:
        forget(options, f"*{kind}_*.h5")
    for ratio in (TABLE1.contact_radius / TABLE1.radius, 0.05, 0.1, 0.2):
        study = TABLE1._replace(contact_radius=ratio * TABLE1.radius)
        for kind, controls in LAWS.items():
            name = f"{kind}_{ratio:.4g}"
            surface = solve_mesh(options, name, options.sweep, study, controls)
            if kind == "small":
                solve_petsam(options, "petsam_" + name, options.grids[-1], surface, study)
                solve_petsam(options, "petsam_true_" + name, options.grids[-1], surface, study, true_sphere=True)
    for factor in (0.1, 10.0):
        stiffness = factor * model.default_stiffness(TABLE1, options.sweep)
        solve_mesh(options, f"stiffness_{factor:g}", options.sweep, controls=model.Controls(stiffness=stiffness))


def friction(options):
    """Both spheres with friction: normal load, then a tangential displacement."""
    spheres = spheres_of(1000.0, TABLE1)
    along = 1e3 * spheres.displacement(spheres.stick_radius(LOAD_RATIO * spheres.limit))
    surface = solve_mesh(options, "tangential", options.tangential, tangential=along)
    solve_petsam(options, "petsam_tangential", options.grids[-1], surface, parts=2)


def main():
    """Run all, or what is chosen."""
    studies = {"meshes": table_of_meshes, "ratios": growing_contact, "friction": friction}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("directory", help="where results go")
    parser.add_argument("--petsam", default="petsam", help="the program")
    parser.add_argument("--ccx", default="ccx", help="CalculiX")
    parser.add_argument(
        "--meshes", type=int, nargs="+", default=[6, 8, 12, 16, 20], help="elements along the cube's edge"
    )
    parser.add_argument("--grids", type=int, nargs="+", default=[32, 64, 128, 256, 512], help="petsam's cells")
    parser.add_argument("--direct", type=int, default=12, help="mesh for the direct solver")
    parser.add_argument("--sweep", type=int, default=12, help="mesh for growing contact and for the contact stiffness")
    parser.add_argument("--tangential", type=int, default=10, help="mesh with friction")
    parser.add_argument("--only", choices=sorted(studies), help="one study")
    parser.add_argument("--keep", action="store_true", help="keep decks and CalculiX's result files")
    options = parser.parse_args()
    try:
        for program, hint in ((options.ccx, "install the Debian package " + PACKAGE), (options.petsam, "run make")):
            if not shutil.which(program):
                raise RunError(f"no program {program}: {hint}")
        options.directory = os.path.abspath(options.directory)
        options.petsam = os.path.abspath(shutil.which(options.petsam))
        os.makedirs(options.directory, exist_ok=True)
        for name, study in studies.items():
            if options.only in (None, name):
                study(options)
    except (RunError, OSError, ValueError, subprocess.SubprocessError) as error:
        return fail("compare.py", error, 1)
    return 0


if __name__ == "__main__":
    sys.exit(main())
