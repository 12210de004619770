"""Contact stiffness of an interface per area, from the separation of its surfaces: of_interface(), of_windows().

The surfaces are taken as one period, so that the displacement of the bodies' mean planes is that of the interface
alone: a uniform pressure displaces nothing. So the stiffnesses are those of springs between two finite element models
whose surfaces are flat, and nothing of the bodies is counted twice. A window of a half-space would add the compliance
of the bodies below it, which depends on the window's size.
"""

import csv

import numpy as np

from ..contact import Contact
from ..errors import Error

HALVES = 4  # half cycles of the loop; the last two count
COLUMNS = {
    "pressure": ("Pa", "nominal pressure"),
    "closure": ("m", "approach of the mean planes since the first touch"),
    "k_n": ("Pa/m", "normal stiffness per area, d(pressure)/d(closure)"),
    "k_n_secant": ("Pa/m", "pressure over closure"),
    "k_t_x": ("Pa/m", "tangential stiffness per area along x, of sticking contacts"),
    "k_t_y": ("Pa/m", "the same along y"),
    "area": ("1", "real contact area over the nominal one"),
    "loop_amplitude": ("m", "amplitude of the displacement in a loop of the shear"),
    "loop_energy": ("J/m2", "dissipated energy of that loop per area"),
    "loop_stiffness": ("Pa/m", "secant stiffness of that loop along x"),
}


class Interface:
    """Numbers of an interface at nominal pressures, each an array: pressure, k_n, k_t_x, area ... (COLUMNS).

    spread      standard deviation of the same among the windows, by name; empty for one window
    friction    coefficient of friction
    shear       amplitude of the mean shear in the loop over friction times pressure
    """

    def __init__(self, numbers, spread, friction, shear):
        self.numbers, self.spread, self.friction, self.shear = numbers, spread, friction, shear
        self.__dict__.update(numbers)

    def __repr__(self):
        p = self.numbers["pressure"]
        return f"Interface({len(p)} pressures from {p[0]:.4g} to {p[-1]:.4g} Pa: {', '.join(self.numbers)})"

    def to_csv(self, path):
        """Writes a table with a line for each pressure; columns NAME_spread are standard deviations of windows."""
        names = [*self.numbers, *(f"{name}_spread" for name in self.spread)]
        units = [COLUMNS[name.removesuffix("_spread")][0] for name in names]
        with open(path, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow([f"{name} [{unit}]" for name, unit in zip(names, units)])
            writer.writerows(zip(*self.numbers.values(), *self.spread.values()))

    def to_abaqus(self, path, name="INTERFACE"):
        """Writes the interaction for a deck of Abaqus in N, mm: pressure over overclosure, friction.

        The allowable elastic slip of the penalty method is friction times pressure over the tangential stiffness: its
        median, since it hardly depends on the pressure.
        """
        slip = np.median(self.friction * self.numbers["pressure"] * 2 / (self.numbers["k_t_x"] + self.numbers["k_t_y"]))
        lines = [
            "** contact stiffness of a rough interface; pressure in MPa, overclosure from the first touch in mm",
            f"*SURFACE INTERACTION, NAME={name}",
            "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR",
            "0., 0.",
            *(f"{p / 1e6:.6g}, {d * 1e3:.6g}" for p, d in zip(self.numbers["pressure"], self.numbers["closure"])),
            f"*FRICTION, ELASTIC SLIP={slip * 1e3:.4g}",
            f"{self.friction:.6g}",
        ]
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")

    def table(self):
        """The table that petsam-joint prints, as lines: in MPa, N/mm3, %, mJ/m2, with the windows' deviations in %."""
        part = {name: 100 * spread / self.numbers[name] for name, spread in self.spread.items()}
        none = np.full_like(self.numbers["pressure"], np.nan)
        k_t = (self.numbers["k_t_x"] + self.numbers["k_t_y"]) / 2
        lines = ["   p/MPa  k_n/(N/mm3)  +- %  k_t/(N/mm3)  k_t/k_n  area/%  loop/(mJ/m2)  +- %"]
        for k, pressure in enumerate(self.numbers["pressure"]):
            deviations = [f"{part.get(name, none)[k]:5.0f}".replace("nan", "  -") for name in ("k_n", "loop_energy")]
            k_n, energy = self.numbers["k_n"][k], self.numbers["loop_energy"][k]
            lines.append(
                f"{pressure / 1e6:8.4g} {k_n / 1e9:12.4g} {deviations[0]} {k_t[k] / 1e9:12.4g} {k_t[k] / k_n:8.4f} "
                f"{100 * self.numbers['area'][k]:7.2f} {1e3 * energy:13.3g} {deviations[1]}"
            )
        return lines

    def plot(self):
        """The stiffnesses and the real contact area over the pressure: a figure of matplotlib."""
        from matplotlib import ticker

        from ..plot.style import plt

        figure, (left, right) = plt.subplots(1, 2, figsize=(8.0, 3.4), layout="constrained")
        pressure = self.numbers["pressure"] / 1e6
        for axes, name, label, unit in (
            (left, "k_n", "normal", 1e-12),
            (left, "k_t_x", "tangential, x", 1e-12),
            (left, "k_t_y", "tangential, y", 1e-12),
            (right, "area", "real contact area", 100.0),
        ):
            spread = self.spread.get(name)
            axes.errorbar(
                pressure, unit * self.numbers[name], None if spread is None else unit * spread, marker="o", ms=4,
                capsize=3, label=label,
            )  # fmt: skip
        for axes, label in ((left, "contact stiffness / (N/µm per mm²)"), (right, "real contact area / %")):
            axes.set(xscale="log", yscale="log", xlabel="nominal pressure / MPa", ylabel=label)
            for axis in axes.xaxis, axes.yaxis:
                axis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
                axis.set_major_formatter("{x:g}")
                axis.set_minor_formatter(ticker.NullFormatter())
        left.legend()
        return figure


def mirrored(separation):
    """The separation and its mirror images beside it: repeated, it has no steps at its borders; (2 ny, 2 nx)."""
    return np.pad(separation, [(0, size) for size in separation.shape], mode="symmetric")


def of_interface(separation, spacing, pressures, *, friction, shear=0.5, steps=8, **bodies):
    """Interface of a separation that repeats itself: an array (ny, nx), m, larger where the surfaces are farther apart.

    spacing     distance of its points along x and y, m, or one for both
    pressures   nominal pressures, Pa, rising
    friction    coefficient of friction
    shear       amplitude of the mean shear of the loop over friction times pressure, below 1
    steps       load steps of a quarter of the loop
    bodies      options of the two bodies: body1_young, body1_poisson, body2_young ... and of the solution

    Raises Error for wrong values, and for a pressure that closes the interface; and the errors of Contact.
    """
    separation = np.asarray(separation, float)
    pressures = np.atleast_1d(np.asarray(pressures, float))
    if separation.ndim != 2 or not np.isfinite(separation).all():
        raise Error("separation: expected a field (ny, nx) of finite numbers")
    if pressures.ndim != 1 or not (np.diff(pressures, prepend=0.0) > 0).all():
        raise Error("pressures: expected positive pressures that rise")
    if not friction > 0:
        raise Error(f"friction {friction!r}: expected a coefficient > 0, without which nothing resists a shear")
    if not 0 < shear < 1:
        raise Error(f"shear {shear!r}: expected a part of friction times pressure, above 0 and below 1")
    step = np.broadcast_to(np.asarray(spacing, float), 2)
    n = separation.shape[::-1]
    size = tuple(float(n[k] * step[k]) for k in range(2))
    rows = []
    with Contact(
        elasticity="periodic", gap_type="flat", grid_n=n, grid_size=size, friction=friction, **bodies
    ) as contact:
        contact.gap = separation - separation.min()
        for pressure in pressures:
            rows.append(_at(contact, float(pressure), size[0] * size[1], friction, shear, steps))
    numbers = {name: np.array([row[k] for row in rows]) for k, name in enumerate(COLUMNS)}
    return Interface(numbers, {}, friction, shear)


def _at(contact, pressure, area, friction, shear, steps):
    """The numbers of COLUMNS at a pressure, to which the contact is loaded."""
    contact.try_step(time=pressure, load_n=pressure * area)
    if contact.number("contact_cells") == contact.n[0] * contact.n[1]:
        raise Error(
            f"pressures: {pressure:.6g} Pa: all of the surface touches, and its stiffness is infinite: give less"
        )
    k = contact.stiffness(reversal=True) / area
    closure, fraction = contact.number("disp_z"), contact.number("contact_fraction")
    contact.commit()
    energy, swing = _loop(contact, pressure * area, friction * shear, steps)
    secant = friction * shear * pressure / swing
    return pressure, closure, k[0, 0], pressure / closure, k[1, 1], k[2, 2], fraction, swing, energy / area, secant


def _loop(contact, normal, part, steps):
    """Dissipated energy (J) and amplitude of the displacement (m) of the last of two cycles of the load along x."""
    turns = [0.0, *(1.0 if k % 2 == 0 else -1.0 for k in range(HALVES + 1))]
    ends, energy = [], 0.0
    with contact.copy() as trial:
        for k, (start, end) in enumerate(zip(turns, turns[1:])):
            energy = 0.0 if k == HALVES - 1 else energy
            for part_of_way in np.linspace(start, end, (1 if k == 0 else 2) * steps + 1)[1:]:
                trial.try_step(time=0.0, load_n=normal, load_tx=part * normal * float(part_of_way))
                energy += trial.number("dissipated_energy")
                trial.commit()
            ends.append(trial.number("disp_x"))
    return energy, abs(ends[-1] - ends[-2]) / 2


def of_windows(separation, spacing, pressures, report=None, **options):
    """Interface of a measured separation: means and standard deviations of five windows of it, half as wide as it is.

    Four windows have the corners, one the middle. Each is mirrored, so that it repeats itself. report(k, count) is
    called when k of the windows are done. Other arguments are those of of_interface().
    """
    separation = np.asarray(separation, float)
    if separation.ndim != 2 or min(separation.shape) < 4:
        raise Error("separation: expected a field of 4 x 4 points or more")
    ny, nx = (size // 2 for size in separation.shape)
    y, x = separation.shape[0] - ny, separation.shape[1] - nx
    places = [(0, 0), (0, x), (y, 0), (y, x), (y // 2, x // 2)]
    found = []
    for j, i in places:
        found.append(of_interface(mirrored(separation[j : j + ny, i : i + nx]), spacing, pressures, **options))
        if report:
            report(len(found), len(places))
    numbers = {name: np.mean([one.numbers[name] for one in found], axis=0) for name in COLUMNS}
    spread = {
        name: np.std([one.numbers[name] for one in found], axis=0, ddof=1) for name in COLUMNS if name != "pressure"
    }
    return Interface(numbers, spread, found[0].friction, found[0].shear)
