"""The output of a fit: lines, JSON, petsam's options and history, wear."""

from dataclasses import dataclass
from typing import Optional

import numpy as np

from ...core.errors import Error, counted
from . import least
from .problem import HIGHEST, LOWEST
from .push import Push, options_of
from .series import Result

HEAD = "# The contact of a measured loop, by petsam-fit: the rig is not part of it."
DROPPED = ("load_", "disp_", "history", "steps", "friction", "wear_", "output", "checkpoint")  # options of a run
WEARS = ("wear_coefficient", "wear_energy")  # but for these


class Unsettled(Error):
    """Loops that hold no numbers."""

    code = 10  # as petsam ends where nothing has converged


def _micro(value):
    """A stiffness in N/um."""
    return f"{value / 1e6:.4g}"


def lines(found: Result, push: Push) -> list[str]:
    """The lines that the command prints."""
    fit, count = found.fit, len(found.numbers)
    points = int(np.median([len(loop.force) for one in found.files for loop in one.loops]))
    drift = max((one.drift for one in found.files), key=abs)
    out = [
        f"{counted(count, 'cycle')} of about {points} points; noise {1e6 * fit.noise[0]:.3g} um, {fit.noise[1]:.3g} N"
        + (f"; drift {1e6 * drift:+.2g} um a cycle (removed)" if count > 1 else ""),
        f"push: {push.text}" + (f"; {push.datum}" if push.datum else ""),
        *found.notes,
    ]
    if found.state == "rejected" and fit.ends:
        out.append(
            f"no numbers: {' and '.join(fit.ends)} at the end of what is looked for, {_range(fit.ends[0])}: look at "
            "--normal, units, and the shape's radii and moduli"
        )
        return out
    if found.state == "rejected":
        out += [
            "no numbers: the loops are clockwise: in partial slip either a record backwards or a force that lags"
            if any(one.turned for one in found.files) and not fit.gross
            else "no numbers: the loops are not those of this contact and a rig in series: "
            + "".join(f"{text}, " for text in [least.correlated(fit.neighbours)] if text)
            + f"their mean is {fit.misfit:.3g} N",
            "next: a loop in gross slip at the end of the test; --lean if the force grows while it slides; --rig left "
            "out; a --shape of the worn surface",
        ]
        return out
    fits = found.each if found.state == "changes" else [fit]
    misfit, neighbours = (float(np.median([getattr(one, name) for one in fits])) for name in ("misfit", "neighbours"))
    out.append(
        f"regime: {found.regime}; shear amplitude/(mu N) {found.sliding:.3f}; misfit {misfit:.3g} N, neighbours' "
        f"correlation {neighbours:.2f}"
    )
    out.append(_friction_line(found))
    rig = found.rig_stiffness
    if np.isinf(rig) or fit.compliance < 2.0 * fit.compliance_sd:
        low = 1.0 / (fit.compliance + 2.0 * fit.compliance_sd)
        out.append(f"rig stiffness above {_micro(low)} N/um (95 %); contact's {_micro(found.contact_stiffness)} N/um")
    else:
        share = (1.0 / rig) / (1.0 / rig + 1.0 / found.contact_stiffness)
        given = f"+- {found.rig_stiffness_sd / 1e6:.2g} N/um" if found.rig_stiffness_sd > 0.0 else "N/um (given)"
        out.append(
            f"rig stiffness {_micro(rig)} {given}; contact's {_micro(found.contact_stiffness)} N/um; part of the rig "
            f"{share:.2f}" + (f"; {push.datum}" if push.datum else "")
        )
    for name, (value, deviation) in fit.more.items():
        if name[-1].isdigit():  # of one of several loads
            continue
        part = f"{100 * value:.3g} +- {100 * deviation:.2g} %"
        text = part if name in ("loss", "bend") else f"{value:.4g} +- {deviation:.2g}"
        out.append({"lean": f"lean {text} N/m", "loss": f"loss {text}", "scale": f"shape's compliance times {text}",
                    "bend": f"compliance by slip larger by {text}"}[name])  # fmt: skip
    first, last = (f"{found.energy[k]:.4g} +- {found.energy_sd[k]:.2g} J" for k in (0, -1))
    out.append(f"energy {first} in the first cycle, {last} in the last")
    return out


def _range(name):
    """The range in which a parameter is looked for."""
    low, high = LOWEST[name], HIGHEST.get(name)
    return f"{low:g} to {high:g}" if high else f"{low:g} or more"


def _friction_line(found):
    low, high = found.fit.friction_range
    if found.state == "changes":
        first, last = found.each[0].friction, found.each[-1].friction
        return f"friction changes with the cycles, {first:.4f} in the first, {last:.4f} in the last"
    if not found.identifiable:
        return (
            f"friction: not identifiable from these loops; at least {found.friction_at_least:.3g} (95 %): take larger "
            "strokes, best one loop in gross slip at the end of the test"
        )
    given = "" if found.fit.gross else ", if the rig has no lean and the contact is that of the shape within its band"
    text = f"friction {found.friction:.4f} +- {found.friction_sd:.2g}{given}"
    if found.state == "weak":
        text = f"friction {found.friction:.3g}, weakly known: {low:.3g} to {high:.3g} (95 %)"
    return text


def plain(value: Optional[float]) -> Optional[float]:
    """A number for JSON, None where it is none."""
    return float(value) if value is not None and np.isfinite(value) else None


@dataclass(frozen=True)
class Wear:
    """A coefficient of wear from a volume.

    Attributes
    ----------
    alpha, alpha_sd : float
        Volume over dissipated energy, 1/Pa.
    coefficient, coefficient_sd : float
        Archard's, 1/Pa: alpha times the friction; NaN where that is not identifiable.
    energy : float
        Of the whole test, J.
    cycles : float
        Of the whole test.
    """

    alpha: float
    alpha_sd: float
    coefficient: float
    coefficient_sd: float
    energy: float
    cycles: float


def wear(found: Result, volume: float, band: float = 0.0, life: Optional[float] = None) -> Wear:
    """Coefficient of wear of the body that has lost this volume: volume over energy, times the friction.

    Parameters
    ----------
    found : Result
    volume, band : float
        m3, and its relative standard deviation.
    life : float, optional
        Cycles of the whole test; None: those of the files. The energy of cycles between the recorded ones is
        interpolated, and that of those after the last one is that of the last.

    Returns
    -------
    Wear

    Raises
    ------
    Unsettled
        If the model does not hold, and the energy is not that of the contact.
    """
    if found.state == "rejected":
        raise Unsettled("--volume: the loops hold no numbers, and their energy is not that of the contact alone")
    numbers, energy = found.numbers, found.energy
    life = float(life if life else numbers[-1] - numbers[0] + 1.0)
    whole = np.arange(1.0, min(life, 1e6) + 1.0) * (life / min(life, 1e6))
    total = float(np.mean(np.interp(whole, numbers, energy)) * life)
    smooth = np.polyval(np.polyfit(numbers, energy, 1), numbers) if len(numbers) > 2 else energy
    scatter = float(np.std(energy - smooth)) / np.sqrt(len(energy)) / float(np.mean(energy))
    alpha = volume / total
    mean, own = float(np.mean(energy)), float(np.sqrt(np.sum(found.energy_noise**2))) / len(energy)
    by_energy = np.hypot(max(scatter, own / mean), float(np.mean(found.energy_loss)) / mean)
    alpha_sd = alpha * np.hypot(band, by_energy)
    mu = (
        np.average(np.array([f.friction for f in found.each]), weights=energy)
        if found.state == "changes"
        else found.friction
    )
    deviation = found.friction_sd / found.friction if found.state != "changes" else 0.0
    return Wear(alpha, alpha_sd, alpha * mu, alpha * mu * np.hypot(alpha_sd / alpha, deviation), total, life)


def worn_line(worn: Wear, body: str) -> str:
    """The line that is printed of the wear of a body, "1" or "2"."""
    text = f"body {body}: volume over energy {worn.alpha:.4g} +- {worn.alpha_sd:.2g} 1/Pa, {worn.energy:.4g} J in all"
    if np.isnan(worn.coefficient):
        return text + "; Archard's coefficient needs the friction, which is not identifiable"
    return text + f"; Archard's coefficient {worn.coefficient:.4g} +- {worn.coefficient_sd:.2g} 1/Pa"


def as_json(found: Result, worn: Optional[Wear] = None, body: str = "2") -> dict:
    """The numbers of NAME.json; None: not known. `body` is the one that has worn."""
    fit = found.fit
    numbers = {
        "friction": plain(found.friction),
        "friction_sd": plain(found.friction_sd),
        "friction_at_least": plain(found.friction_at_least),
        "friction_range": [plain(one) for one in fit.friction_range] if found.state != "rejected" else None,
        "identifiable": bool(found.identifiable),
        "state": found.state,
        "regime": found.regime if found.state != "rejected" else None,
        "sliding": plain(found.sliding) if found.identifiable else None,
        "rig_stiffness": plain(found.rig_stiffness) if found.state != "rejected" else None,
        "rig_stiffness_sd": plain(found.rig_stiffness_sd) if found.state != "rejected" else None,
        "contact_stiffness": found.contact_stiffness,
        "misfit": fit.misfit,
        "neighbours": fit.neighbours,
        "noise_displacement": fit.noise[0],
        "noise_force": fit.noise[1],
        **{name: value for name, (value, _) in fit.more.items() if found.state != "rejected"},
        "units": "N, m, J, 1/Pa",
        "cycles": [
            {
                "cycle": float(n),
                "friction": plain(f.friction),
                "friction_sd": plain(f.friction_sd),
                "energy": float(e),
                "energy_sd": float(sd),
            }
            for n, f, e, sd in zip(
                found.numbers, found.each or [fit] * len(found.numbers), found.energy, found.energy_sd
            )
        ],
    }
    if worn:
        numbers[f"wear_coefficient{body}"] = plain(worn.coefficient)
        numbers[f"wear_coefficient{body}_sd"] = plain(worn.coefficient_sd)
        numbers[f"volume_over_energy{body}"] = worn.alpha
        numbers[f"volume_over_energy{body}_sd"] = worn.alpha_sd
    return numbers


def write_friction(found: Result, path: str) -> None:
    """Writes the friction over the cycles as -wear_friction reads it: from cycle 0 on, each known cycle."""
    rows = [(n, f.friction) for n, f in zip(found.numbers, found.each)]
    rows = [(0.0, rows[0][1]), *rows] if rows[0][0] > 0.0 else rows
    with open(path, "w", encoding="utf-8") as file:
        file.write("cycle,friction\n" + "".join(f"{n:.12g},{mu:.6g}\n" for n, mu in rows))


def write_options(
    found: Result,
    push: Push,
    shape: str,
    width: Optional[float],
    name: str,
    worn: Optional[Wear] = None,
    body: str = "2",
) -> list[str]:
    """Writes NAME.opts and NAME-loop.csv, with which petsam computes the loop of the contact alone: its displacement is
    that of the record less the compliance times the force. Where the friction changes, or a coefficient of wear is
    known, NAME-life.opts repeats the closed cycle of NAME-life.csv for the cycles of the test. The options of bodies
    and gap in the file `shape` are copied; `width` is the length of a contact in plane strain, m, or None; `body` is
    the one that has worn. Returns the names of the files."""
    options = {k: v for k, v in options_of(shape).items() if not k.startswith(DROPPED) or k.startswith(WEARS)}
    if worn and np.isfinite(worn.coefficient):
        options[f"wear_coefficient{body}"] = f"{worn.coefficient:.6g} # +- {worn.coefficient_sd:.2g} 1/Pa"
    kept = [f"-{option} {value}".rstrip() for option, value in options.items()]
    band = f"+- {found.friction_sd:.2g}" if found.state != "changes" else "the mean of a friction that changes"
    friction = f"-friction {found.friction:.6g} # {band}"
    normal = push.normal / (width or 1.0)
    _write_lines(f"{name}.opts", [HEAD, *kept, friction, f"-history {name}-loop.csv", "-steps 16"])
    _write_loop(found, normal, (0, 1, -1, 1), f"{name}-loop.csv")
    wrote, wears = [f"{name}.opts", f"{name}-loop.csv"], any(option.startswith(WEARS) for option in options)
    if found.state == "changes" or wears:
        changes = f"-wear_friction {name}-friction.csv" if found.state == "changes" else friction
        more = [] if wears else ["# no wear is known: give -wear_coefficient1, -wear_coefficient2, or both"]
        cycles = worn.cycles if worn else found.numbers[-1]
        life = [f"-history {name}-life.csv", "-steps 16", f"-wear_cycles {cycles:.12g}"]
        _write_lines(f"{name}-life.opts", [HEAD, *kept, changes, *life, *more])
        _write_loop(found, normal, (0, 1, -1, 0), f"{name}-life.csv")
        wrote += [f"{name}-life.opts", f"{name}-life.csv"]
    return wrote


def _write_lines(path, lines):
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


def _write_loop(found, normal, way, path):
    """The history of the contact's displacement, over its amplitude from row to row."""
    d, q = max(found.fit.curves, key=lambda one: np.ptp(one[0]))
    half = 0.5 * np.ptp(d - q / found.rig_stiffness)
    rows = [f"{k},{normal:.9g},{part * half:.9g}" for k, part in enumerate(way, 1)]
    _write_lines(path, ["time,load_n,disp_x", *rows])
