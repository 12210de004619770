"""Two turbine blades and the friction damper under their platforms: damping over amplitude, and the best mass.

    build/venv/bin/python examples/damper/damper.py build/run/damper

prints the tables of README.md and draws damper.png to a folder. `--quick` computes two masses at three amplitudes, too
few for the amplitudes at resonance.
"""

import argparse
import os
import sys

import numpy as np
import underplatform

import petsam
from petsam import joint
from petsam.plot.style import CLOSED, COLORS, STYLE, frame, joined, logarithmic, plt, save, tint

FRICTION = 0.3
RADIUS, CROWN = 5e-3, 1.5  # of the damper's section and of its generatrix, m
ANGLE = "35deg"  # of the platforms to the circumference
SPEED, ORBIT = "3000rpm", 0.5  # distance of the damper from the axis of rotation, m
BLADE, TIP_MASS, PLATFORM = 250.0, 0.15, 0.03  # Hz alone; modal mass for the tip, kg; motion of platform over tip
MATERIAL = 5e-4  # damping of the blades' material and of the flow, part of critical
MOTIONS = {"circumferential": (1.0, 0.0), "radial": (0.0, 1.0)}  # of the platforms
MASSES = np.array([2.5, 5.0, 10.0, 20.0, 40.0]) * 1e-3  # kg, of the tables
BETWEEN = np.array([3.5, 7.0, 14.0, 28.0]) * 1e-3  # kg, more of them in the picture
AMPLITUDES = np.geomspace(1e-5, 2e-3, 12)  # of a tip, m
FORCES = (1.0, 2.0, 4.0)  # at each tip, N
# half axes of the contact and load (m, N): Hertz's ellipse of these radii, which grows as the cube root of the load
HALF, LOAD = (7.1e-5, 2.3e-3), 300.0
ROOM = 1.5  # half width of the grid over half axis
TIP = 1.0 / np.sqrt(TIP_MASS)
MARKS = ("o", "s", "^", "D", "v")  # of curves
BEYOND = {"marker": "$\\uparrow$", "markersize": 11, "linestyle": "none"}  # an amplitude above those computed


def damper(mass):
    """Damper of this mass."""
    return underplatform.damper(
        mass, RADIUS, ANGLE, SPEED, ORBIT, FRICTION, crown=CROWN, body1="steel", body2="steel",
    )  # fmt: skip


def structure(mass, direction, n):
    """Blades, and the damper of this mass that its centrifugal force presses against their platforms."""
    platforms = np.zeros((4, 2))  # x and z of the left and of the right one, by the modes of the two blades
    for k in range(2):
        platforms[2 * k : 2 * k + 2, k] = PLATFORM * TIP * np.array(MOTIONS[direction])
    one, omega = damper(mass), 2 * np.pi * BLADE
    size = [2.0 * ROOM * half * np.cbrt(one.loads[0] / LOAD) for half in HALF]
    return one.structure(platforms, [omega, omega], n, size, MATERIAL)


def backbone(mass, direction, amplitudes, n, **more):
    """Frequency and damping of the mode in which the blades move against each other, over the amplitude of a tip."""
    tip = [TIP, 0.0, 0.0, 0.0, 0.0]
    return joint.backbone(structure(mass, direction, n), amplitudes, mode=2, sensor=tip, **more)


def excitations(found):
    """Forces (N) at both tips, opposite to each other, whose resonances have the amplitudes of a backbone."""
    gain = 2.0 * TIP * abs(found.shape[0])  # modal force by a unit of both
    return 2.0 * (found.damping + found.viscous) * (2 * np.pi * found.frequency) ** 2 * found.modal_amplitude / gain


def resonance(found, force):
    """Amplitude (m) of a tip at the resonance under a force; NaN outside of the computed amplitudes."""
    given = excitations(found)
    return np.exp(np.interp(np.log(force), np.log(given), np.log(found.amplitude), np.nan, np.nan))


def alone(force):
    """The same without a damper: the material damps alone."""
    return force / (2.0 * MATERIAL * TIP_MASS * (2 * np.pi * BLADE) ** 2)


def sketch(ax):
    """The damper below its platforms, and the force on it."""
    angle = damper(MASSES[0]).angles[0]
    c, s = np.cos(angle), np.sin(angle)
    turn = np.linspace(0.0, 2.0 * np.pi, 100)
    ax.fill(np.cos(turn), np.sin(turn), color=COLORS[1], alpha=0.6)
    for side in (-1.0, 1.0):
        at, along, out = np.array([side * s, c]), np.array([side * c, -s]), np.array([side * s, c])
        corners = [at - 0.5 * along, at + 1.2 * along, at + 1.2 * along + 0.5 * out, at - 0.5 * along + 0.5 * out]
        ax.fill(*np.transpose(corners), color="0.75")
        ax.annotate("", (side * 2.3, 1.0), (side * 1.6, 1.0), arrowprops=dict(arrowstyle="<->", color="k", lw=1.2))
    ax.annotate("", (0.0, 0.8), (0.0, 0.0), arrowprops=dict(arrowstyle="-|>", color="k", lw=1.2))
    ax.text(0.0, -0.3, "centrifugal\nforce", ha="center", va="center")
    ax.text(0.0, 1.75, "platforms move against each other", ha="center", va="center")
    ax.set(xlim=(-2.4, 2.4), ylim=(-1.1, 1.9), aspect="equal")
    ax.axis("off")


def draw(found, folder):
    """The damper, damping over amplitude for the masses of the tables, and the amplitude at resonance over all."""
    with plt.rc_context(STYLE):
        figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12.5, 4.2), layout="constrained")
        sketch(left)
        draw_damping(middle, {mass: one for mass, one in found.items() if mass in MASSES})
        draw_resonances(right, found)
        save(figure, folder, "damper.png")


def draw_damping(ax, found):
    """Damping by friction over the amplitude, and that of the material, which is left where friction damps nothing."""
    for k, (mass, one) in enumerate(found.items()):
        label = f"{1e3 * mass:g} g, {damper(mass).force:.0f} N"
        joined(ax, 1e6 * one.amplitude, 100.0 * one.damping, tint(k, len(found)), MARKS[k] + "-", label=label)
    ax.axhline(100.0 * MATERIAL, **CLOSED, linestyle="--")
    text, at = f"by the material: {100.0 * MATERIAL:g} %", (0.02, 100.0 * MATERIAL)
    ax.annotate(text, at, (0, 3), ax.get_yaxis_transform(), "offset points", fontsize=8.5)
    frame(ax, "Damping by friction", "amplitude of a tip, µm", "damping, % of critical")
    logarithmic(ax, "xy")
    ax.legend(loc="lower left", title="damper: mass, centrifugal force", ncols=2)
    ax.set_ylim(0.16 * 100.0 * MATERIAL, None)  # with room for the legend


def draw_resonances(ax, found):
    """Amplitude at resonance over the mass; arrows where it is above those computed, dashed lines without a damper."""
    masses, last = 1e3 * np.array(list(found)), 1e6 * max(np.max(one.amplitude) for one in found.values())
    for k, force in enumerate(FORCES):
        reach = np.array([1e6 * resonance(one, force) for one in found.values()])
        joined(ax, masses, reach, COLORS[k], MARKS[k] + "-", label=f"{force:g} N")
        ax.axhline(1e6 * alone(force), color=COLORS[k], linewidth=1.2, linestyle="--")
        at = masses[-1], 1e6 * alone(force)
        ax.annotate(f"{force:g} N, no damper", at, (0, 2), textcoords="offset points", ha="right", fontsize=8.5)
        beyond = masses[np.array([force > np.max(excitations(one)) for one in found.values()])]
        ax.plot(beyond, np.full(beyond.size, last), color=COLORS[k], **BEYOND)
    frame(ax, "Amplitude at resonance", "mass of the damper, g", "amplitude of a tip, µm")
    logarithmic(ax, "xy")
    ax.plot([], [], color="0.35", **BEYOND, label="more than computed")
    ax.legend(title="force at each tip", loc="upper right", bbox_to_anchor=(1.0, 0.74))
    some = [mass for mass in MASSES if mass in found]
    ax.set_xticks(1e3 * np.array(some), labels=[f"{1e3 * mass:g}" for mass in some])
    ax.minorticks_off()


def main():
    """Computes all masses, prints the tables and draws the picture."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="where damper.png is written")
    parser.add_argument("--grid-n", type=int, default=48, help="cells of a contact in each direction (48)")
    parser.add_argument("--quick", action="store_true", help="two masses, three amplitudes")
    args = parser.parse_args()
    masses, amplitudes = (MASSES[1::2], AMPLITUDES[2::4]) if args.quick else (MASSES, AMPLITUDES)
    os.makedirs(args.folder, exist_ok=True)
    circumferential = {mass: backbone(mass, "circumferential", amplitudes, args.grid_n) for mass in masses}
    for mass, one in circumferential.items():
        print(f"\ndamper of {1e3 * mass:g} g, {damper(mass).force:.0f} N, platforms move along the circumference")
        print("\n".join(one.lines()[1:]))
    omega, _ = structure(masses[0], "radial", args.grid_n).stuck_modes()
    told = " and ".join(f"{one / (2 * np.pi):.4g}" for one in omega[:2])
    print(f"\nplatforms that move radially: {told} Hz while all that touches sticks: the damper rolls")
    print("\namplitude of a tip at resonance, um, by the force at each tip")
    print(f"{'mass/g':>8}" + "".join(f"{force:>9g} N" for force in FORCES))
    for mass, one in circumferential.items():
        print(f"{1e3 * mass:8g}" + "".join(f"{1e6 * resonance(one, force):11.3g}" for force in FORCES))
    print("nan: not within the computed amplitudes" + (", and --quick has too few of them" if args.quick else ""))
    between = () if args.quick else BETWEEN
    more = {mass: backbone(mass, "circumferential", amplitudes, args.grid_n) for mass in between}
    draw(dict(sorted({**circumferential, **more}.items())), args.folder)


if __name__ == "__main__":
    try:
        main()
    except petsam.Error as error:
        sys.exit(f"damper: {error}")
