"""Compare plane contacts with closed forms and with a long contact, and draw them.

Reads the results that examples/plane/run.sh writes to a directory, prints the numbers of the page, and draws plane.png.
With --loads it prints the options of the plane problem of the long punch's middle section.
"""

import os
import sys
from pathlib import Path

import numpy as np

import petsam
from petsam.plot.style import CLOSED, colors, frame, plt, points, save, thinned, tint

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # what the examples share
import comparison  # noqa: E402

LINES = ("-", "--", "-.")  # beside the colours


def load(directory, name):
    return petsam.open(os.path.join(directory, name + ".h5"))


def middle(directory):
    """x, p, q_x of the long punch's row nearest to its middle."""
    one = petsam.Snapshot(load(directory, "long"))
    return one.x, one["pressure"][one.row], one["shear_x"][one.row]


def loads(directory):
    """Options: N and T_x per length of that row."""
    x, p, q = middle(directory)
    return f"-load_n {p.sum() * (x[1] - x[0]):.10g} -load_tx {q.sum() * (x[1] - x[0]):.10g}"


def relative(values, exact):
    return float(np.linalg.norm(values - exact) / np.linalg.norm(exact))


class Comparison:
    """The results, and what they are compared with."""

    def __init__(self, directory):
        self.tension, self.cycle, self.fatigue, self.life, self.plane, self.long = (
            load(directory, name) for name in ("tension", "cycle", "fatigue", "life", "middle", "long")
        )
        self._nowell_and_hills()
        self.swt = self.fatigue.field("swt")[:, 0]
        z, i = np.unravel_index(np.argmax(self.swt), self.swt.shape)
        deep = int(np.argmin(np.abs(self.fatigue.z - 50e-6)))
        wear = self.life.wear
        x, p, q = middle(directory)
        one = petsam.Snapshot(self.plane)
        self.section = x, p, q, one
        self.numbers.update(
            swt=float(self.swt[z, i]), swt_x=float(self.fatigue.x[i]), swt_deep=float(self.swt[deep].max()),
            depth=float(wear["depth_max2"][-1]), volume=float(wear["volume2"][-1]),
            computed=int(wear["computed"][-1]), energy=[float(wear["dissipated_energy"][k]) for k in (0, -1)],
            pressure=relative(p, one["pressure"][0]), shear=relative(q, one["shear_x"][0]),
        )  # fmt: skip

    def _nowell_and_hills(self):
        """Stick zone of Cattaneo's width, shifted by the bulk stress."""
        one = petsam.Snapshot(self.tension)
        par = one.parameters
        modulus = par["body1_young"] / 2 / (1 - par["body1_poisson"] ** 2)
        N, T, s, mu, R = one["load_n"], one["load_tx"], one["bulk2_stress_xx"], 0.5, par["gap_radius_x"]
        a = np.sqrt(4 * N * R / (np.pi * modulus))
        p0 = 2 * N / (np.pi * a)
        c, e = a * np.sqrt(1 - T / (mu * N)), a * s / (4 * mu * p0)
        x = one.x

        def root(x, a):
            return np.sqrt(np.maximum(1 - (x / a) ** 2, 0))

        zone = x[np.abs(one["state"][0] - 1) < 0.5]
        self.exact = mu * p0 * (root(x, a) - c / a * root(x - e, c))
        self.one, self.a = one, a
        self.numbers = {
            "half": float(one["contact_area"] / 2), "hertz": float(a), "stick": float(one["stick_area"] / 2),
            "cattaneo": float(c), "middle": float(abs(zone.min() + zone.max()) / 2), "shift": float(e),
            "q": relative(one["shear_x"][0], self.exact),
        }  # fmt: skip

    def tables(self):
        """What is printed."""
        n = self.numbers
        yield "cylinder with bulk tension, and Nowell and Hills:"
        yield f"  half width of the contact {1e6 * n['half']:.2f} um, {1e6 * n['hertz']:.2f} um"
        yield f"  half width of the stick zone {1e6 * n['stick']:.2f} um, {1e6 * n['cattaneo']:.2f} um"
        yield f"  its middle beside the contact's {1e6 * n['middle']:.1f} um, {1e6 * n['shift']:.1f} um"
        yield f"  shear, relative L2 {n['q']:.1e}"
        yield (
            f"rounded pad: maximum SWT {1e-6 * n['swt']:.3f} MPa at x = {1e3 * n['swt_x']:.3f} mm, "
            f"{1e-6 * n['swt_deep']:.3f} MPa at a depth of 50 um"
        )
        yield (
            f"its wear after 1e6 cycles: depth {1e6 * n['depth']:.3f} um, volume {1e9 * n['volume']:.4f} mm3/m, "
            f"from {n['computed']} computed cycles; energy of a cycle from {1e3 * n['energy'][0]:.2f} to "
            f"{1e3 * n['energy'][1]:.2g} mJ/m"
        )
        yield f"long punch beside its plane problem, relative L2: p {n['pressure']:.1e}, q_x {n['shear']:.1e}"

    def draw(self, directory):
        """Four panels."""
        figure, axes = plt.subplots(2, 2, figsize=(10.4, 7.2), constrained_layout=True)
        x = 1e3 * self.one.x
        tints = colors(2)
        panel = axes[0, 0]
        panel.plot(x, 1e-6 * 0.5 * self.one["pressure"][0], ":", color="0.5", linewidth=1.0, label=r"$\mu p$")
        panel.plot(x, 1e-6 * self.exact, **CLOSED, label="Nowell and Hills")
        some = thinned(np.arange(x.size), 60)
        points(panel, x[some], 1e-6 * self.one["shear_x"][0][some], tints[0], label="petsam, some cells")
        panel.legend()
        frame(panel, "Cylinder with bulk tension in the flat: shear", "$x$, mm", "$q_x$, MPa")
        panel = axes[0, 1]
        for k, depth in enumerate((0.0, 10e-6, 50e-6)):
            row = int(np.argmin(np.abs(self.fatigue.z - depth)))
            name = "on the surface" if depth == 0 else f"{1e6 * depth:.0f} µm below"
            panel.plot(
                1e3 * self.fatigue.x,
                1e-6 * self.swt[row],
                color=tint(k, 3),
                linestyle=LINES[k],
                linewidth=1.3,
                label=name,
            )
        panel.legend()
        frame(panel, "Rounded pad: fatigue parameter at its edges", "$x$, mm", "SWT, MPa")
        panel = axes[1, 0]
        for k, cycle in enumerate((1e4, 1e5, 1e6)):
            depth = self.life.field("wear_depth2", self.life.of_cycle(cycle))[0]
            look = {"color": tint(k, 3), "linestyle": LINES[k], "linewidth": 1.3}
            panel.plot(1e3 * self.life.x, 1e6 * depth, **look, label=f"{cycle:,.0f} cycles")
        panel.invert_yaxis()
        panel.legend(loc="lower center")
        frame(panel, "Scar of the pad: the middle sticks, the edges wear", "$x$, mm", "removed depth, µm")
        panel = axes[1, 1]
        x, p, q, one = self.section
        for values, line, name in ((p, one["pressure"][0], "$p$"), (10 * q, 10 * one["shear_x"][0], "$10\\,q_x$")):
            text = ("plane problem", "long punch, its middle") if name == "$p$" else ("", "")
            panel.plot(1e3 * one.x, 1e-6 * line, **CLOSED, label=text[0])
            points(panel, 1e3 * x[::16], 1e-6 * values[::16], tints[0], label=text[1])
            panel.annotate(name, (0.0, 1e-6 * line[line.size // 2]), xytext=(0, 4), textcoords="offset points")
        panel.legend(loc="lower center")
        frame(panel, "Middle of a long punch and its plane problem", "$x$, mm", "$p$, $10\\,q_x$, MPa")
        save(figure, directory, "plane.png")


def main():
    if "--loads" in sys.argv:
        print(loads(sys.argv[1]))
        return 0
    return comparison.main(Comparison, __doc__, "plane")


if __name__ == "__main__":
    sys.exit(main())
