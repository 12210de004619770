"""Types from outside the tree: the plugin of examples/embed, built on the installed files and chosen by options."""

import subprocess
import sys

import h5py
import numpy as np
import pytest

from conftest import environment, execute
from support import ROOT, bodies, finished
from test_install import library_flags, pkg_config

SPHERE = dict(
    grid_n=(45, 40),
    grid_size=(2.4e-3, 2.2e-3),
    **bodies(),
    friction=0.3,
    gap_type="sphere",
    gap_radius1=0.1,
    gap_radius2="inf",
)
FADING = dict(fading_length=2e-7, fading_final=0.4)
MOVES = [1e-7, 4e-7, 1.1e-6, 2e-7, -6e-7, 8e-7]
HISTORY = "\n".join(["time,load_n,disp_x,load_ty", *(f"{k}.0,900,{d},{k}" for k, d in enumerate(MOVES, 1))])


def build(prefix, out, *sources):
    command = ["mpicc", "-std=c11", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", *map(str, sources)]
    command += ["-o", str(out), *pkg_config(prefix, "--cflags"), *library_flags(prefix, "shared")]
    finished(command)
    return out


@pytest.fixture(scope="module")
def plugin(prefix, tmp_path_factory):
    """The plugin, with nothing of the sources in reach."""
    sources = sorted((prefix / "share/petsam/examples/embed/plugin").glob("*.c"))
    assert len(sources) == 7
    return build(prefix, tmp_path_factory.mktemp("plugin") / "plugin.so", *sources)


@pytest.fixture
def petsam(prefix, launcher, tmp_path):
    """The installed program in tmp_path."""
    (tmp_path / "history.csv").write_text(HISTORY)

    def run(*options, ranks=1, check=0, program="petsam"):
        return execute(launcher, tmp_path, options, ranks, check, program=prefix / "bin" / program)

    return run


def bits(path):
    """All datasets of the results but times of the clock."""
    with h5py.File(path) as file:
        found = {name: file[name][:] for name in ("pressure", "shear_x", "fading_path")}
        found.update({name: data[:] for name, data in file["history"].items() if "seconds" not in name})
    return {name: data.tobytes() for name, data in found.items()}


# ---- the program


def test_a_number_of_the_plugin_has_a_gradient(petsam, plugin, tmp_path):
    """By the slope of the plugin's cone, friction and loads, beside differences; the same bits on 3 ranks."""
    cone = {name: value for name, value in SPHERE.items() if not name.startswith("gap_")}
    cone |= dict(gap_type="cone", grid_n=(29, 26))
    (tmp_path / "cone.csv").write_text("time,load_n,load_tx,load_ty\n0,40,0,0\n1,40,7,2\n2,40,-2,3\n")
    tight = dict(normal_rtol=1e-12, tangential_rtol=1e-12, slip_direction="end", errors="none")
    case = (cone, tight, dict(plugin=plugin, history="cone.csv", gradient="shear_norm", gradient_rtol=1e-10))

    def gradient(name="o.h5", ranks=1, slope=2e-3, friction=0.3):
        more = dict(gap_slope=slope, friction=friction, gradient_of="gap_slope,friction,load_tx", output=name)
        petsam(*case, more, "-overwrite", ranks=ranks)
        with h5py.File(tmp_path / name) as file:
            group = file["gradient/shear_norm"]
            return dict(group.attrs), group["friction"][:], group["load_tx"][:]

    found, by_friction, by_load = gradient()
    with h5py.File(tmp_path / "o.h5") as file:
        q = np.hypot(file["shear_x"][-1], file["shear_y"][-1])
    area = 2.4e-3 * 2.2e-3 / (29 * 26)
    assert found["value"] == pytest.approx(((q**8).sum() * area) ** (1 / 8), rel=1e-10)
    for one, size in (("slope", 1e-6 * 2e-3), ("friction", 1e-6 * 0.3)):
        start = dict(slope=2e-3, friction=0.3)[one]
        both = [gradient(**{one: start + sign * size})[0]["value"] for sign in (1, -1)]
        slope = found["gap_slope"] if one == "slope" else np.nansum(by_friction)
        assert slope == pytest.approx((both[0] - both[1]) / (2 * size), rel=1e-5), one
    others = gradient("three.h5", ranks=3)
    assert others[0] == found and np.array_equal(others[2], by_load) and np.abs(by_load).max() > 0


def test_help_lists_the_types_and_their_options(petsam, plugin):
    lines = petsam("-help", dict(plugin=plugin)).stdout
    for text in (
        "coated, halfspace, periodic, plane or plane_periodic",
        "cone, curved, ellipsoid,",
        "activeset or spectral",
        "Fading friction",
    ):
        assert text in lines
    for option in ("-fading_length", "-fading_final", "-coating_compliance", "-gap_slope"):
        assert option in lines
    assert "fading" not in petsam("-help").stdout


def test_law_is_in_results_checkpoint_and_restart_with_the_same_bits_on_any_number_of_ranks(petsam, plugin, tmp_path):
    case = (SPHERE, FADING, dict(plugin=plugin, history="history.csv", output_fields="pressure,shear_x,fading_path"))
    found = []
    for ranks in (1, 3):
        whole = dict(output=f"whole{ranks}.h5", checkpoint=f"state{ranks}.h5", checkpoint_every=3)
        petsam(*case, whole, ranks=ranks)
        # the checkpoint of step 3, where the last one is of the end
        petsam(*case, dict(output=f"on{ranks}.h5", restart=f"state{ranks}.h5.1"), ranks=ranks)
        found.append(bits(tmp_path / f"whole{ranks}.h5"))
        on = bits(tmp_path / f"on{ranks}.h5")
        with h5py.File(tmp_path / f"on{ranks}.h5") as rest, h5py.File(tmp_path / f"whole{ranks}.h5") as file:
            assert rest["fading_path"].shape[0] == 3 and file["fading_path"].attrs["units"] == "m"
            for name in ("pressure", "shear_x", "fading_path"):
                assert rest[name][:].tobytes() == file[name][3:].tobytes()
        assert on["load_tx"] in found[-1]["load_tx"]
    assert found[0] == found[1]
    with h5py.File(tmp_path / "whole1.h5") as file:
        p, q, path = (file[name][:] for name in ("pressure", "shear_x", "fading_path"))
        assert path[0].max() > 0 and np.all(np.diff(path, axis=0) >= 0) and np.all(path[p == 0] == 0)
        # the bound of the law, by what it has remembered after the step
        bound = 0.3 * p * (0.4 + 0.6 * np.exp(-path / 2e-7))
        assert np.all(np.abs(q) <= bound + 1e-6 * bound.max()) and np.abs(q).max() < 0.29 * p.max()


def test_law_of_another_length_refuses_the_checkpoint(petsam, plugin):
    case = (SPHERE, dict(plugin=plugin, history="history.csv"))
    petsam(*case, FADING, dict(checkpoint="state.h5", checkpoint_every=3))
    done = petsam(*case, dict(FADING, fading_length=3e-7), dict(restart="state.h5"), check=None)
    assert done.code in (2, 3) and "fading_length" in done.stderr


def test_law_has_a_tangent_stiffness(petsam, plugin, tmp_path):
    """Softer while friction fades than at the reversal."""
    petsam(SPHERE, FADING, dict(plugin=plugin, history="history.csv", output="out.h5"), "-stiffness")
    with h5py.File(tmp_path / "out.h5") as file:
        on, back = (file["history"][name][:, 1, 1] for name in ("stiffness", "stiffness_reversal"))
    assert np.all(np.isfinite(on)) and np.all(on < back)


def test_law_is_refused_by_name_where_it_is_not_known_what_to_do(petsam, plugin, tmp_path):
    case = (SPHERE, FADING, dict(plugin=plugin, history="history.csv", output="out.h5"))
    (tmp_path / "history.csv").write_text("time,load_n,disp_x\n1,900,1e-7\n2,900,-1e-7\n3,900,1e-7\n")
    life = dict(wear_cycles=100, wear_coefficient1=1e-13)
    done = petsam(*case, life, check=2)
    assert "-fading_length with -wear_cycles" in done.complaint[0]


# ---- a law that displaces the surfaces

SWELLING = dict(swelling_rate=1e-3, swelling_radius=2e-4, swelling_depth=4e-4)
GROWS = "time,load_n,disp_x\n1,900,1e-7\n2,900,4e-7\n3,900,4e-7\n4,700,-1e-7\n"


def swollen(file, step, nu=0.3):
    """u_x, u_y and u_z of body 2's surface (m) by the field that the law has remembered: closed form."""
    x, y = np.meshgrid(file["x"][:], file["y"][:])
    strain = np.array([file[f"swelling_{k}"][step] for k in range(1, 9)])
    z = (4e-4 + 2e-4 * ((2 * np.arange(8) + 1) / 8 - 1))[:, None, None]
    volume = np.diff(file["x"][:2])[0] * np.diff(file["y"][:2])[0] * 2 * 2e-4 / 8
    m = volume * strain.sum()
    at = [volume * (strain * axis).sum() / m if m else 0 for axis in (x, y, z)]
    r3 = np.sqrt((x - at[0]) ** 2 + (y - at[1]) ** 2 + at[2] ** 2) ** 3 + (m == 0)
    return [(1 + nu) / np.pi * m * d / r3 for d in (x - at[0], y - at[1], -at[2])]


def test_centre_of_dilatation_is_the_integral_of_point_forces_over_a_sphere():
    """By reciprocity: the trace of the stress that a unit force on the surface makes where the body swells."""
    nu, (s, w) = 0.3, np.polynomial.legendre.leggauss(24)
    r, cos, phi = 1e-4 * (s + 1), s, np.pi * (np.arange(48) + 0.5) / 24
    sine = np.sqrt(1 - cos**2)[:, None]
    x, y, z = (r[:, None, None] * d for d in (sine * np.cos(phi), sine * np.sin(phi), cos[:, None] + 0 * phi))
    weight = (1e-4 * w * r**2)[:, None, None] * w[:, None] * np.pi / 24 * np.ones_like(x)
    assert weight.sum() == pytest.approx(4 / 3 * np.pi * 2e-4**3)
    for at in (0, 0), (3e-4, -2e-4):
        from_force = np.array([x - at[0], y - at[1], z + 4e-4])
        trace = -(1 + nu) / np.pi * from_force / np.sqrt((from_force**2).sum(axis=0)) ** 3
        exact = -(1 + nu) / np.pi * weight.sum() * np.array([-at[0], -at[1], 4e-4]) / np.hypot(np.hypot(*at), 4e-4) ** 3
        np.testing.assert_allclose((weight * trace).sum(axis=(1, 2, 3)), exact, rtol=1e-9, atol=1e-12)


def test_swelling_opens_the_gap_and_shears_it_by_the_closed_form(petsam, plugin, tmp_path):
    (tmp_path / "history.csv").write_text(GROWS)
    case = dict(SPHERE, plugin=plugin, history="history.csv", output="out.h5", output_fields="all", friction=0)
    petsam(case, SWELLING)
    with h5py.File(tmp_path / "out.h5") as file:
        found = {
            name: file[name][:] for name in ("pressure", "displacement_x", "displacement_y", "gap", "displacement_z")
        }
        u = [np.array(axis) for axis in zip(*(swollen(file, step) for step in range(4)))]
        x, y = np.meshgrid(file["x"][:], file["y"][:])
        rigid = file["history/disp_z"][:][:, None, None]
        assert np.isfinite(file["history/stored_energy"][0]) and np.isnan(file["history/stored_energy"][1:]).all()
    height = (x**2 + y**2) / 0.2
    for axis in (0, 1):
        np.testing.assert_allclose(found[f"displacement_{'xy'[axis]}"], u[axis], rtol=1e-12, atol=1e-22)
    np.testing.assert_allclose(found["gap"], found["displacement_z"] + height - rigid, atol=1e-15)
    for step in (0, 1, 3):  # the pressure of bodies that have this shape
        with h5py.File(tmp_path / "gap.h5", "w") as file:
            file["height"] = height + u[2][step]
        shaped = dict(case, history=None, gap_type="file", gap_file="gap.h5", gap_radius1=None, gap_radius2=None)
        petsam(shaped, dict(load_n=700 if step == 3 else 900))
        with h5py.File(tmp_path / "out.h5") as file:
            p = file["pressure"][-1]
        np.testing.assert_allclose(found["pressure"][step], p, atol=3e-7 * p.max())
    assert found["pressure"][2].max() > 1.05 * found["pressure"][0].max()


def test_swelling_slips_and_sticks_and_goes_on_with_the_same_bits_on_any_number_of_ranks(petsam, plugin, tmp_path):
    (tmp_path / "history.csv").write_text(GROWS)
    case = (SPHERE, SWELLING, dict(plugin=plugin, history="history.csv", output_fields="all"))
    found = []
    for ranks in (1, 3):
        petsam(*case, dict(output=f"out{ranks}.h5", checkpoint=f"state{ranks}.h5", checkpoint_every=2), ranks=ranks)
        petsam(*case, dict(output=f"on{ranks}.h5", restart=f"state{ranks}.h5.1"), ranks=ranks)
        with h5py.File(tmp_path / f"out{ranks}.h5") as file, h5py.File(tmp_path / f"on{ranks}.h5") as on:
            names = [name for name in file if name in on and getattr(file[name], "shape", ())[1:] == (40, 45)]
            assert {"pressure", "shear_x", "slip_x", "swelling_8"} <= set(names)
            found.append({name: file[name][:] for name in names} | {"disp_x": file["history/disp_x"][:][:, None, None]})
            for name in names:
                assert on[name][:].tobytes() == file[name][2:].tobytes(), name
    assert all(one[name].tobytes() == found[0][name].tobytes() for one in found for name in found[0])
    f = found[0]
    np.testing.assert_allclose(f["slip_x"], f["displacement_x"] - f["disp_x"], atol=1e-15)
    stuck = (f["state"][1:] == 1) & (f["state"][:-1] != 0)
    assert stuck.sum() > 100 and np.abs(np.diff(f["slip_x"], axis=0)[stuck]).max() < 1e-5 * np.abs(f["slip_x"]).max()
    slides = np.diff(f["slip_x"], axis=0)[f["state"][1:] == 2]
    assert np.abs(slides).max() > 1e-9


def test_swelling_starts_no_step_of_a_cycle_from_displacements_that_it_made(petsam, plugin, tmp_path):
    rows = "".join(f"{k},900,{40 * (0, 1, 2, 1, 0, -1, -2, -1)[k % 8]}\n" for k in range(16))
    (tmp_path / "history.csv").write_text("time,load_n,load_tx\n" + rows)
    case = (SPHERE, dict(SWELLING, swelling_rate=1e-9), dict(plugin=plugin, history="history.csv", output="out.h5"))
    found = []
    for memory in (0, 1e9):
        petsam(*case, dict(cycle_memory=memory))
        with h5py.File(tmp_path / "out.h5") as file:
            found.append(file["history/disp_x"][:])
    assert found[0].tobytes() == found[1].tobytes()


def test_body_gap_and_method_are_chosen_by_options(petsam, plugin, tmp_path):
    cone = dict(SPHERE, plugin=plugin, gap_type="cone", gap_slope=4e-3, gap_radius1=None, gap_radius2=None, load_n=300)
    found = {}
    for body, method in (("halfspace", "activeset"), ("coated", "activeset"), ("coated", "spectral")):
        options = dict(elasticity=body, normal_type=method, coating_compliance=1e-15 if body == "coated" else None)
        petsam(cone, options, dict(output="out.h5", output_fields="pressure,gap,displacement_z"))
        with h5py.File(tmp_path / "out.h5") as file:
            found[body, method] = {name: file[name][-1] for name in ("pressure", "gap", "displacement_z")}
            x, y = np.meshgrid(file["x"][:], file["y"][:])
            rigid = file["history/disp_z"][-1]
    coated, other = found["coated", "activeset"], found["coated", "spectral"]
    np.testing.assert_allclose(other["pressure"], coated["pressure"], atol=1e-6 * coated["pressure"].max())
    height = other["gap"] + rigid - other["displacement_z"]
    np.testing.assert_allclose(height, 4e-3 * np.hypot(x, y), atol=1e-12)
    assert coated["pressure"].max() < 0.98 * found["halfspace", "activeset"]["pressure"].max()


def test_stresses_in_a_body_of_a_plugin(petsam, plugin):
    body = dict(SPHERE, plugin=plugin, elasticity="coated", coating_compliance=1e-15, load_n=400)
    petsam(body, dict(output="out.h5"))
    stress = dict(input="out.h5", output="stress.h5", depths="0:1e-4:3", section="y=0")
    assert "coated" in petsam(stress, program="petsam-stress", check=None).stderr
    petsam(stress, dict(plugin=plugin), program="petsam-stress")


def test_plugin_that_is_none_is_refused_by_name(petsam, prefix, tmp_path):
    (tmp_path / "empty.c").write_text("extern int nothing;\nint nothing;\n")
    build(prefix, tmp_path / "empty.so", tmp_path / "empty.c")
    for name, text in (("missing.so", "cannot be loaded"), ("empty.so", "SamPluginRegister"), ("history.csv", "load")):
        for ranks in (1, 2):
            done = petsam(SPHERE, dict(load_n=100, plugin=name), check=3, ranks=ranks)
            assert f"-plugin {name}: " in done.stderr and text in done.stderr


STATIC = """
#include <petsam.h>
int main(int argc, char **argv)
{
  PetscErrorCode code;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  code = SamOptionsPlugins(&(SamOptions){PETSC_COMM_WORLD, NULL});
  return PetscFinalize() || code != SAM_ERR_FILE;
}
"""


def test_program_with_a_copy_of_the_library_refuses_a_plugin(prefix, plugin, tmp_path):
    (tmp_path / "static.c").write_text(STATIC)
    command = ["mpicc", "-std=c11", str(tmp_path / "static.c"), "-o", str(tmp_path / "static")]
    command += [*pkg_config(prefix, "--cflags"), *library_flags(prefix, "static")]
    subprocess.run(command, check=True, timeout=120)
    command = [str(tmp_path / "static"), "-plugin", str(plugin)]
    done = subprocess.run(command, capture_output=True, text=True, env=environment(), timeout=60)
    assert done.returncode == 0 and f"-plugin {plugin}: uses another copy of libpetsam" in done.stderr


# ---- embedded

PYTHON = """
import sys
import petsam

case, moves = eval(sys.argv[1]), eval(sys.argv[2])
with petsam.Contact(**case) as contact:
    for k, d in enumerate(moves, 1):
        contact.try_step(load_n=900, disp_x=d, load_ty=k)
        contact.commit()
    contact.field("fading_path").tofile(sys.argv[3])
"""


def test_python_has_the_field_of_the_law(petsam, prefix, plugin, tmp_path):
    petsam(SPHERE, FADING, dict(plugin=plugin, history="history.csv", step_divide="no", output="out.h5",
                                output_fields="fading_path"))  # fmt: skip
    case = dict(SPHERE, **FADING, plugin=str(plugin))
    env = dict(
        environment(), PETSAM_LIBRARY=str(prefix / "lib/libpetsam.so"), PYTHONPATH=str(prefix / "share/petsam/scripts")
    )
    command = [sys.executable, "-c", PYTHON, repr(case), repr(MOVES), "path.bin"]
    finished(command, cwd=tmp_path, env=env)
    with h5py.File(tmp_path / "out.h5") as file:
        assert (tmp_path / "path.bin").read_bytes() == file["fading_path"][-1].tobytes()


def test_sources_of_the_plugin_are_short_and_named_in_the_manual():
    manual = (ROOT / "examples/embed/README.md").read_text()
    for path in (ROOT / "examples/embed/plugin").glob("*.c"):
        assert len(path.read_text().splitlines()) < 150 and path.name in manual
