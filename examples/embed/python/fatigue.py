"""The fatigue parameter of Smith, Watson and Topper on a section, over the steps of a cycle in this process."""

import petsam

steel = dict(body1_young=210e9, body1_poisson=0.3, body2_young=210e9, body2_poisson=0.3)
sphere = dict(gap_type="sphere", gap_radius1=0.1, gap_radius2="inf", friction=0.5)
loads = [300 * k for k in (0, 0.5, 1, 0.5, 0, -0.5, -1, -0.5, 0, 0.5, 1)]
with petsam.Contact(grid_n=96, grid_size=2.6e-3, steps=3, **steel, **sphere) as contact:
    contact.run(dict(time=range(1, 4), load_n=[1000.0] * 3, load_tx=loads[:3]))
    contact.record()
    contact.run(dict(time=range(4, 12), load_n=[1000.0] * 8, load_tx=loads[3:]))
    found = contact.fatigue("swt", depths="0:4e-4:33", section="y=0")
    print(f"largest SWT {found['swt'].max():.4g} Pa, {found['swt'].shape}")
