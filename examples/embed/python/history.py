"""A fretting history of 80 steps in this process: the hysteresis loops' dissipated energy."""

import numpy as np

import petsam

steel = dict(body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3)
sphere = dict(gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", friction=0.5)
t = np.arange(1, 82)
history = dict(time=t, load_n=np.full(81, 1000.0), load_tx=300 * np.sin(2 * np.pi * (t - 1) / 20))
with petsam.Contact(grid_n=96, grid_size=2.6e-3, **steel, **sphere) as contact:
    steps = contact.run(history)
    print(f"{len(steps)} steps, {sum(step.dissipated_energy for step in steps[21:]):.4e} J in three loops")
