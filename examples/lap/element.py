"""A mass of 2 kg on a contact as a force element (petsam.Element), by Newmark's method with 40 steps of a period."""

import numpy as np

import petsam

steel = dict(body1_young=210e9, body1_poisson=0.0, body2_young=210e9, body2_poisson=0.0, friction=0.1)
contact = petsam.Contact(grid_n=64, grid_size=2.4e-3, gap_type="sphere", gap_radius1=0.2, gap_radius2=0.2, **steel)
contact.try_step(load_n=1000.0)
contact.commit()
preload = petsam.Element(contact, ["disp_x"], held=dict(load_n=1000.0))

mass, u, v, stiffness = 2.0, 5e-7, 0.0, -preload.tangent(reversal=True)[0, 0]
stuck = np.sqrt(stiffness / mass)
dt, element = 2 * np.pi / 40 / stuck, preload.copy()
force = element.try_(u)
element.commit()
for _ in range(80):
    a = force / mass
    new = u + dt * v + 0.5 * dt**2 * a
    for _ in range(20):
        force = element.try_(new)
        wrong = 4 * mass / dt**2 * (new - u - dt * v - 0.25 * dt**2 * a) - force
        if abs(wrong) < 1e-6 * 100.0:  # of mu N
            break
        new = new - wrong / (4 * mass / dt**2 - element.tangent()[0, 0])
    element.commit()
    u, v = new, v + 0.5 * dt * (a + force / mass)
print(u, element.number("dissipated_energy"))
