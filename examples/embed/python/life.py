"""A wear simulation of 1e5 cycles in this process, with its log."""

import petsam

steel = dict(body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3)
sphere = dict(gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", friction=0.5, wear_coefficient2=1e-14)
cycle = dict(time=range(9), load_n=[1000.0] * 9, disp_x=[6e-7 * k for k in (0, 0.5, 1, 0.5, 0, -0.5, -1, -0.5, 0)])
with petsam.Contact(grid_n=64, grid_size=2.6e-3, **steel, **sphere) as contact:
    log = contact.live(1e5, cycle)
    for one in log:
        print(f"{one.cycle:8.0f} cycles  depth {one.depth_max2:.3e} m  peak pressure {one.pressure_max:.3e} Pa")
