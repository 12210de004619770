"""Friction, radius and modulus of a ball from loads and approach of a motion out of phase (petsam.fit.fit_contact)."""

import numpy as np

import petsam

pair = dict(gap_type="sphere", gap_radius2="inf", body1_poisson=0.3, body2="Ti-6Al-4V", grid_n=32, grid_size="2.4mm")
phase = np.linspace(0, 2 * np.pi, 13)
moves = {"disp_x": np.append(0, 3e-6 * np.sin(phase)), "disp_y": np.append(0, 2e-6 * np.sin(phase + 1.2))}
turning = {"time": np.arange(14), "load_n": np.full(14, 800), **moves}

steps = petsam.Contact(**pair, friction=0.4, gap_radius1=0.05, body1_young=210e9, tangential_rtol=1e-8).run(turning)
chance, readings = np.random.default_rng(1), {}
for name, noise in (("load_tx", 2.0), ("load_ty", 2.0), ("disp_z", 1e-7)):  # N, m
    readings[name] = ([getattr(step, name) for step in steps] + noise * chance.standard_normal(14), noise)

start = dict(friction=0.6, gap_radius1=0.04, body1_young=180e9)
print(petsam.fit.fit_contact(pair, turning, readings, start))
print(petsam.fit.fit_contact(pair, turning, readings, start, known={"gap_radius1": (0.0505, 0.001)}))
