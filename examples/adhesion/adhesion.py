"""Surfaces that attract each other: a ball pushed in and pulled off, a wave that jumps to full contact, roughness.

    build/venv/bin/python examples/adhesion/adhesion.py build/run/adhesion

prints the numbers of README.md and draws adhesion.png to a folder.
"""

import argparse
import os

import numpy as np

import petsam
from petsam.closed.adhesion import adhesion
from petsam.closed.materials import effective_modulus
from petsam.plot.style import CLOSED, COLORS, STYLE, frame, joined, plt, save

UPRIGHT = dict(rot_x=0, rot_y=0)  # under a pull bodies that may tilt roll away
FEW = dict(output_fields="none", errors="none", friction=0)

# a rigid ball of 1 um on polystyrene; lambda is 0.963
RADIUS, YOUNG, POISSON, WORK, RANGE = 1e-6, 3e9, 0.35, 0.05, 0.7e-9
BALL = dict(
    body1_young="inf", body1_poisson=0, body2_young=YOUNG, body2_poisson=POISSON, gap_type="sphere", gap_radius1=RADIUS,
    gap_radius2="inf", grid_n=96, grid_size="146nm", adhesion_work=WORK, adhesion_stress=WORK / RANGE, **UPRIGHT, **FEW,
)  # fmt: skip
# approaches, m, with small steps about the jumps; rows of the table
IN = np.concatenate([[-0.71, -0.705, -0.695], np.arange(-0.65, 1.25, 0.05)])
OUT = np.concatenate([np.arange(1.15, -1.02, -0.05), np.arange(-1.04, -1.07, -0.005)])
STEPS = 1e-9 * (np.round(np.concatenate([IN, OUT]), 9) + 0.0)
SHOWN = ((24, "in"), (38, "in"), (54, "out"), (64, "out"), (74, "out"))

# a wavy surface on rubber, in plane strain: h = A (1 - cos(2 pi x/L)), with alpha = 0.3
LENGTH, AMPLITUDE, MODULUS, ALPHA = 100e-6, 1e-6, 1e6, 0.3
WAVE_WORK = ALPHA**2 * np.pi**2 * AMPLITUDE**2 * MODULUS / (2 * LENGTH)
WAVE_RANGE = 0.05 * AMPLITUDE
FULL = np.pi * MODULUS * AMPLITUDE / LENGTH  # mean pressure of full contact without adhesion
PRESSURES = np.concatenate([[0, 0.1, 0.2, 0.3, 0.35], np.arange(0.38, 0.4201, 0.0025)])  # relative to FULL

# a rough period: rms 0.2 um, waves of 32 um to 4 um; pressed and unloaded, Pa
SIDE, RMS, SOFT, ROUGH_WORK, ROUGH_RANGE = 64e-6, 0.2e-6, 40e6, 0.05, 50e-9
MEAN = np.array([0.1, 0.2, 0.3, 0.4, 0.3, 0.2, 0.1, 0.0]) * 1e6


def rubber(modulus):
    """A rigid body on an incompressible one, with E* of both."""
    return dict(body1_young="inf", body1_poisson=0, body2_young=0.75 * modulus, body2_poisson=0.5)


# ---- ball ----


def maugis(radii):
    """Closed form of the ball."""
    e_star = effective_modulus(np.inf, 0, YOUNG, POISSON)
    return adhesion(radii, WORK, RANGE, RADIUS, e_star)


def branch():
    """Contact radii (m) and closed form of the stable states under a displacement, down to the least approach."""
    radii = np.linspace(0, 80e-9, 20001)
    curve = maugis(radii)
    stable = radii >= radii[np.argmin(curve.approach)]
    return radii[stable], curve.load[stable], curve.approach[stable], curve.border[stable]


def push_and_pull():
    """The ball under given displacements, beside Maugis (1992); returns the results and the closed curve."""
    run = petsam.run(**BALL, history=dict(disp_z=STEPS), allow_edge_contact=True)
    radii, load, approach, border = branch()
    print("approach, nm       force, nN   Maugis    contact, nm   Maugis    tension to, nm   Maugis")
    for k, way in SHOWN:
        closed = [np.interp(STEPS[k], approach, column) for column in (load, radii, border)]
        force, width, edge = run["load_n"][k], *(np.sqrt(run[f"{n}_area"][k] / np.pi) for n in ("contact", "adhesive"))
        told = [f"{1e9 * a:{w}.2f} {1e9 * b:8.2f}" for a, b, w in zip((force, width, edge), closed, (12, 14, 16))]
        print(f"{1e9 * STEPS[k]:9.2f} {way:4s}" + " ".join(told))
    touching = np.nan_to_num(run["contact_area"]) > 0
    first, last = np.nonzero(touching)[0][[0, -1]]
    print(f"jumps in between {1e9 * STEPS[first - 1]:.3f} and {1e9 * STEPS[first]:.3f} nm, closed {-1e9 * RANGE:.3f}")
    print(
        f"jumps out between {1e9 * STEPS[last]:.3f} and {1e9 * STEPS[last + 1]:.3f} nm, closed {1e9 * approach[0]:.3f}"
    )
    pull = -np.nanmin(run["load_n"])
    print(f"largest pull {1e9 * pull:.1f} nN, closed {1e9 * maugis(radii[:1]).pull_off:.1f}")
    inside = approach <= -RANGE  # states that only separating bodies pass
    lost = -np.sum(0.5 * (load[1:] + load[:-1])[inside[1:]] * np.diff(approach)[inside[1:]])
    print(f"energy lost in the loop {1e18 * np.nansum(run['adhesion_energy']):.1f} aJ, closed {1e18 * lost:.1f}")
    return run, approach, load


def pull_by_a_load():
    """The ball under given loads: beyond the pull-off force there is no equilibrium."""
    try:
        petsam.run(**BALL, history=dict(load_n=np.concatenate([[0], np.arange(-240, -260, -1)]) * 1e-9))
    except petsam.NoEquilibrium as error:
        print(error)


# ---- wave ----


def johnson(psi):
    """Mean pressure of a wave relative to FULL; psi = pi a/L with the half width a of contact."""
    return np.sin(psi) ** 2 - ALPHA * np.sqrt(np.tan(psi))


def wave(cells, pressures):
    """Widths of contact and of tension relative to the length, under mean pressures relative to FULL."""
    x = (np.arange(cells) + 0.5) / cells
    run = petsam.run(
        **rubber(MODULUS), **FEW, elasticity="plane_periodic", gap=AMPLITUDE * (1 + np.cos(2 * np.pi * x)),
        grid_size=LENGTH, adhesion_work=WAVE_WORK, adhesion_stress=WAVE_WORK / WAVE_RANGE,
        history=dict(load_n=pressures * FULL * LENGTH),
    )  # fmt: skip
    return run["contact_area"] / LENGTH, run["adhesive_area"] / LENGTH


def waves():
    """A wave under growing loads, beside Johnson (1995); returns the widths on the finest grid."""
    psi = np.linspace(0.2, 1.5, 100001)
    closed, peak = johnson(psi), int(np.argmax(johnson(psi)))
    print("\ncells   pressure/p*   contact/L   tension/L   Johnson")
    for cells in (512, 1024, 2048, 4096):
        contact, tension = wave(cells, PRESSURES)
        for k in (0, 2, 4):
            width = 2 / np.pi * np.interp(PRESSURES[k], closed[:peak], psi[:peak])
            print(f"{cells:5d} {PRESSURES[k]:13.2f} {contact[k]:11.4f} {tension[k]:11.4f} {width:9.4f}")
        jump = int(np.argmax(contact > 0.999))
        print(f"{cells:5d}   full contact beyond {PRESSURES[jump - 1]:.4f}, by Johnson beyond {closed[peak]:.4f}")
    opening = 1 - WAVE_WORK / WAVE_RANGE / FULL
    (_, pulled), _ = wave(512, np.array([1, 0.99 * opening]))
    print(f"at {0.99 * opening:.3f}, under a pull, contact/L {pulled:.4f}; full contact ends at {opening:.3f}")
    return contact, tension


# ---- rough period ----


def roughness(cells):
    """Heights of a self-affine period (Hurst exponent 0.8), the same on every grid of more than 32 cells."""
    k = np.arange(-16, 17)
    length = np.hypot(*np.meshgrid(k, k))
    factors = np.where((length >= 2) & (length <= 16), np.maximum(length, 1) ** -1.8, 0)
    phases = np.exp(2j * np.pi * np.random.default_rng(1).random(length.shape))
    along = np.exp(2j * np.pi * np.outer((np.arange(cells) + 0.5) / cells, k))
    heights = (along @ (factors * phases) @ along.T).real
    return RMS * heights / heights.std()


def rough_area(cells, **attraction):
    """Parts of the period in contact under the mean pressures."""
    run = petsam.run(
        **rubber(SOFT), **UPRIGHT, **FEW, **attraction, elasticity="periodic", gap=-roughness(cells), grid_size=SIDE,
        history=dict(load_n=MEAN * SIDE**2),
    )  # fmt: skip
    return run["contact_area"] / SIDE**2


def rough():
    """Contact area of a rough period on two grids, with and without adhesion; returns those of the finer one."""
    found = []
    for cells in (128, 256):
        found += [
            rough_area(cells),
            rough_area(cells, adhesion_work=ROUGH_WORK, adhesion_stress=ROUGH_WORK / ROUGH_RANGE),
        ]
    print("\npressure, MPa   contact, %, 128 cells   with adhesion   256 cells   with adhesion")
    for pressure, *areas in zip(MEAN, *found):
        print(f"{1e-6 * pressure:9.2f}" + "".join(f"{100 * a:{w}.2f}" for a, w in zip(areas, (20, 19, 14, 14))))
    return found[2:]


# ---- picture ----


def draw(ball, widths, areas, folder):
    """Force over approach, the width of contact of the wave, and the area of the rough period."""
    run, approach, load = ball
    psi = np.linspace(0.3, 1.5, 400)
    with plt.rc_context(STYLE):
        figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12.5, 4.0), layout="constrained")
        top = int(np.argmax(STEPS))
        for part, color, mark, label in ((slice(top + 1), 0, "o", "in"), (slice(top, None), 1, ".", "out")):
            joined(left, 1e9 * STEPS[part], 1e9 * run["load_n"][part], COLORS[color], mark + "-", label=label)
        shown = approach <= STEPS.max()
        left.plot(1e9 * approach[shown], 1e9 * load[shown], **CLOSED, label="Maugis", zorder=4)
        left.legend()
        frame(left, "A ball", "approach, nm", "force, nN")
        for values, color, mark, label in zip(widths, COLORS, "o.", ("contact", "tension")):
            joined(middle, PRESSURES, values, color, mark + "-", label=label)
        middle.plot(johnson(psi), 2 / np.pi * psi, **CLOSED, label="Johnson")
        middle.legend()
        frame(middle, "A wave", "mean pressure / p*", "width / L", (0, 0.45), (0, 1.03))
        for values, color, mark, label in zip(areas, COLORS, "so", ("without adhesion", "with adhesion")):
            joined(right, 1e-6 * MEAN, 100 * values, color, mark + "-", label=label)
        right.legend()
        frame(right, "A rough period", "mean pressure, MPa", "contact, %")
        save(figure, folder, "adhesion.png")


def main():
    """Computes the three contacts, prints their numbers and draws the picture."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="where adhesion.png is written")
    folder = parser.parse_args().folder
    os.makedirs(folder, exist_ok=True)
    ball = push_and_pull()
    pull_by_a_load()
    draw(ball, waves(), rough(), folder)


if __name__ == "__main__":
    main()
