#!/usr/bin/env python3
"""One run of a peer on a problem of problem.py; prints seconds and what the peer says of itself as JSON.

    build/peers/bin/python tests/bench/peer.py SETTING FOLDER SOLUTION

Timed is what petsam's own time holds: from building the operator to the solution, without Python's start and reading
the problem. The settings are the fastest that were found for each peer, with those that win on some grids and lose on
others.
"""

import importlib
import json
import sys
import time
from pathlib import Path

PEERS = ("tamaas", "aspher")
TOLERANCE = 1e-8
TANGENTIAL_TOLERANCE = 1e-5  # ASPHER's default: with 1e-6 its friction converges on fewer problems still
SINGLE_TOLERANCE = 2e-6  # what ASPHER's single precision can certify
FFT = dict(backend="fft", precond_engine="fft")
ACTIVE = dict(backend="h2", active_set=True)

# setting: (what it is, arguments of ASPHER's nested solver)
SETTINGS = {
    "tamaas": ("Polonsky, Keer and Rey's conjugate gradients; DCFFT operator, or the periodic one", None),
    "aspher fft": ("padded FFT, full preconditioner, nested grids", FFT),
    "aspher fft mixed": ("the same, first in single precision", dict(FFT, precision="float_then_double")),
    "aspher periodic": ("periodic transforms", dict(backend="periodic")),
    "aspher h2": ("fast multipoles of order 6, active set", ACTIVE),
    "aspher fft single": ("padded FFT in single precision", dict(FFT, precision="float")),
    "aspher h2 single": ("fast multipoles in single precision, active set", dict(ACTIVE, precision="float")),
}
# setting: (what it is, (with the preconditioner, increments of a single load))
TANGENTIAL_SETTINGS = {
    "aspher friction": ("FrictionSolver under force control, padded FFT", (True, 1)),
    "aspher friction bare": ("the same without preconditioner", (False, 1)),
    "aspher friction 6 steps": ("in six increments of the load, which helps it to converge", (True, 6)),
    "aspher friction bare 6 steps": ("in six increments without preconditioner", (False, 6)),
}


def settings(name, kind):
    """A peer's settings to try on a kind of problem; a cycle has increments of its own."""
    return [
        k
        for k in (SETTINGS if kind in ("normal", "rough", "periodic") else TANGENTIAL_SETTINGS)
        if k.split()[0] == name
        and not (kind == "cycle" and k.endswith("steps"))
        and (k == "tamaas" or k.endswith("periodic") == (kind == "periodic"))
    ]


def describe():
    """Setting: what it is."""
    return {k: v[0] for k, v in {**SETTINGS, **TANGENTIAL_SETTINGS}.items()}


def cannot(name, kind):
    """Why a peer has no answer to a kind of problem; None when it can be asked."""
    if kind in ("normal", "rough", "periodic"):
        return None
    if name == "tamaas":
        return "its operator that is not periodic knows normal loads only, its friction is periodic"
    return "its tangential loads are two forces, no torque" if kind == "torque" else None


# ---------------------------------------------------------------- runs


def run_tamaas(problem, gap):
    import tamaas as tm

    tm.set_log_level(tm.LogLevel.error)
    n, width = problem["cells"], problem["width"]
    start = time.perf_counter()
    model = tm.Model(tm.model_type.basic_2d, [width, width], [n, n])
    model.E, model.nu = problem["e_star"], 0.0
    if problem["kind"] != "periodic":
        tm.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = tm.PolonskyKeerRey(model, -gap, TOLERANCE, tm.PolonskyKeerRey.pressure, tm.PolonskyKeerRey.pressure)
    if problem["kind"] != "periodic":
        solver.setIntegralOperator("dcfft")
    solver.max_iter = 20000
    error = solver.solve(problem["load_n"] / width**2)
    seconds = time.perf_counter() - start
    return seconds, dict(converged=error <= TOLERANCE, residual=error), [model.traction.reshape(n, n)]


def run_aspher_normal(problem, gap, arguments):
    import aspher

    n, width = problem["cells"], problem["width"]
    single = arguments.get("precision") == "float"
    start = time.perf_counter()
    r = aspher.solve_nested(
        grid_size=n,
        gap=gap.ravel(),
        p_nominal=problem["load_n"] / width**2,
        domain_size=width,
        E_star=problem["e_star"],
        tol=SINGLE_TOLERANCE if single else TOLERANCE,
        light_result=True,
        **arguments,
    )
    seconds = time.perf_counter() - start
    return (
        seconds,
        dict(converged=r.converged, residual=max(r.fw_error, r.penetration_error), iterations=r.iterations),
        [r.pressure.reshape(n, n)],
    )


def run_aspher_friction(problem, gap, preconditioner, increments):
    import aspher

    n, width = problem["cells"], problem["width"]
    unit = width**-2
    start = time.perf_counter()
    solver = aspher.FrictionSolver(
        grid_size=n,
        domain_size=width,
        E_star=problem["e_star"],
        nu=problem["poisson"],
        model=aspher.CoulombFriction(problem["friction"]),
        precond=preconditioner,
    )
    solver.set_gap(gap.T.ravel())  # its first index is x
    step = solver.step(p_bar=problem["load_n"] * unit, tol_normal=TOLERANCE)
    done = 0
    for force in problem["steps"] or [problem["load_tx"] * (k + 1) / increments for k in range(increments)]:
        if not step.converged:
            break
        step = solver.step(q_bar=(force * unit, 0.0), tol_tangential=TANGENTIAL_TOLERANCE)
        done += 1
    seconds = time.perf_counter() - start
    if not step.converged:
        return (
            seconds,
            dict(
                converged=False,
                residual=step.proj_residual,
                iterations=step.tangential_iters,
                reason=f"step {done}: {step.status_reason}",
            ),
            None,
        )
    return (
        seconds,
        dict(converged=True, residual=step.proj_residual, iterations=step.tangential_iters),
        [solver.pressure.reshape(n, n).T, step.qx.T, step.qy.T],
    )


def run(setting, problem, gap):
    if setting == "tamaas":
        return run_tamaas(problem, gap)
    if setting in TANGENTIAL_SETTINGS:
        return run_aspher_friction(problem, gap, *TANGENTIAL_SETTINGS[setting][1])
    return run_aspher_normal(problem, gap, SETTINGS[setting][1])


def main():
    import numpy as np

    setting, folder, solution = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    problem = json.loads((folder / "problem.json").read_text())
    gap = np.load(folder / "gap.npy")
    importlib.import_module(setting.split()[0])  # its start is not timed
    before = time.process_time()
    seconds, said, fields = run(setting, problem, gap)
    cpu = time.process_time() - before
    if fields:
        np.save(solution, np.stack(fields))
    print(json.dumps(dict(said, seconds=seconds, cpu=cpu, converged=bool(said["converged"]))))


if __name__ == "__main__":
    main()
