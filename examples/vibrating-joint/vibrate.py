"""Compute the response curves of the vibrating joint: vibrate.py fresh|worn DIRECTORY CELLS PROCESSES.

fresh  curves at five amplitudes of the drive, loops and slip at their peaks, a part of a curve with the Jacobian by
       differences, and life.csv, the cycle that wears the joint: the motion at a peak
worn   curves at one amplitude of the drive after the cycles of life.h5

Writes fresh.npz or worn.npz. run.sh calls both, and petsam between them.
"""

import concurrent.futures
import multiprocessing
import os
import sys

import numpy as np

import joint
import petsam

FORCES = (1e3, 2e3, 5e3, 8e3, 12e3)  # N
WEARING = 8e3  # the drive whose peak wears the joint, N
CYCLES = (0, 100000, 1000000)
# frequencies of a curve over the stuck joint's resonance, and of the comparison of Jacobians
SWEEP = np.concatenate([np.linspace(0.92, 0.965, 4), np.linspace(0.97, 1.0, 16), [1.005, 1.01, 1.02]])
FEW = np.linspace(0.97, 0.995, 6)


def curve(cells, force, part=SWEEP, by_differences=False, worn=0.0):
    """A response curve, as a dict: frequency, Hz, amplitude, m, coefficients, and numbers of calls."""
    one = joint.Joint(cells, worn)
    stiffness, stuck, _ = joint.stuck(joint.Joint(cells))  # of the unworn joint: all curves have the same frequencies
    omegas = part * stuck
    x = joint.response(one, omegas, force, by_differences)
    amplitudes = np.array([joint.amplitude(a) for a in x])
    peak = int(np.argmax(amplitudes))
    counts = {"trials": one.trials, "stiffnesses": one.stiffnesses}
    motion = joint.WAVES @ x[peak].reshape(joint.COUNT, 2)
    loads, _ = one.forces(motion, False)
    slip, energy = one.slip(motion)
    return dict(
        counts,
        force=force,
        stiffness=stiffness[0, 0],
        stuck=stuck,
        frequency=omegas / (2.0 * np.pi),
        amplitude=amplitudes,
        coefficients=x,
        motion=motion,
        loads=loads,
        slip=slip,
        energy=energy,
    )


def run(tasks, processes):
    """Results of curve() for each of its arguments, several at a time; processes start anew, as MPI wants it."""
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(processes, mp_context=context) as pool:
        waiting = [pool.submit(curve, *task) for task in tasks]
        found = []
        for task, future in zip(tasks, waiting):
            found.append(future.result())
            print(
                f"drive {task[1]:g} N: {found[-1]['trials']} steps, {found[-1]['stiffnesses']} stiffnesses", flush=True
            )
    return found


def write(path, curves):
    np.savez(path, **{f"{name}_{k}": value for k, one in enumerate(curves) for name, value in one.items()})


def write_cycle(path, motion):
    """The cycle that wears: from its last instant on, so that it ends where it starts."""
    rows = np.vstack([motion[-1], motion])
    with open(path, "w", encoding="utf-8") as file:
        file.write("time,load_n,disp_x,rot_y,disp_y,rot_x,rot_z\n")
        for k, (x, turn) in enumerate(rows):
            file.write(f"{k / len(motion)!r},{joint.NORMAL!r},{float(x)!r},{float(turn)!r},0,0,0\n")


def main():
    stage, directory, cells, processes = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    if stage == "fresh":
        tasks = [(cells, force) for force in reversed(FORCES)]  # the longest first
        tasks += [(cells, WEARING, FEW, True), (cells, WEARING, FEW)]
        found = run(tasks, processes)
        curves = found[len(FORCES) - 1 :: -1] + found[len(FORCES) :]
        write(os.path.join(directory, "fresh.npz"), curves)
        write_cycle(os.path.join(directory, "life.csv"), curves[FORCES.index(WEARING)]["motion"])
    else:
        life = petsam.open(os.path.join(directory, "life.h5"))
        tasks = []
        for cycle in CYCLES[1:]:
            k = life.of_cycle(cycle)
            worn = life.field("wear_depth1", k) + life.field("wear_depth2", k)
            tasks.append((cells, WEARING, SWEEP, False, worn))
        write(os.path.join(directory, "worn.npz"), run(tasks, processes))


if __name__ == "__main__":
    main()
