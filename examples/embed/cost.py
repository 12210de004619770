"""What a try, a stiffness and a reject of a contact in process cost: the table of README.md."""

import os
import statistics
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")

import petsam  # noqa: E402

STEEL = dict(body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3)
SPHERE = dict(gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", friction=0.1)
REPEATS = 40


def seconds(calls):
    """The median CPU time of some calls, ms."""
    times = []
    for call in calls:
        begin = time.process_time()
        call()
        times.append(1e3 * (time.process_time() - begin))
    return statistics.median(times)


def main():
    print("cells      try, ms  stiffness, ms  reject, ms")
    for n in (64, 128, 256):
        with petsam.Contact(grid_n=n, grid_size=2.6e-3, **STEEL, **SPHERE) as contact:
            for k in range(1, 7):
                at = contact.try_step(load_n=1000, load_tx=10.0 * k).disp_x
                contact.commit()
            moves = [at * (1.0 + 1e-3 * (k % 20 + 1)) for k in range(REPEATS)]
            tries = seconds([lambda x=x: contact.try_step(load_n=1000, disp_x=x) for x in moves])
            stiffness = seconds([contact.stiffness] * REPEATS)
            rejects = seconds([contact.reject] * REPEATS)
            print(f"{n:4d}^2 {tries:12.1f} {stiffness:14.1f} {rejects:11.3f}")


if __name__ == "__main__":
    main()
