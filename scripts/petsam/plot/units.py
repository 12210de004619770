"""Units of axes, with the prefix that suits the values."""

import re

import numpy as np

from ..core.errors import short

POWERS = {"m2": 2, "m3": 3}
LEAST = {"m2": 1e-3, "m3": 1e-3}  # from 1 mm² on there are no µm², and so on: 0.15 mm², not 150000 µm²
PREFIXES = (
    (1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p"),
)  # fmt: skip
BASE = re.compile(r"(Pa|N|m[23]?|J|rad|W)(?![A-Za-z0-9])")  # beginning of a unit that takes a prefix
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
LOWERED = {raised: digit for digit, raised in RAISED.items()}
UNPREFIXED = ("cycles", "billion", "million", "thousand", "%", "degrees")  # beginnings of units without a size
NUMBERS = ((1e9, "billion "), (1e6, "million "), (1e3, "thousand "))


def written(unit):
    """A unit as it is printed: powers raised, and a dot between factors."""
    unit = re.sub(r"(?<=m)[23](?!\d)", lambda power: "²³"[int(power[0]) - 2], plain(unit))
    return re.sub(r"(?<=[\w²³]) (?=[A-Za-z])", "·", unit)


def scale(unit, *values, powers=False):
    """Factor and unit with the prefix in which the largest of some values, numbers or arrays, has up to three digits
    before the point.

    Areas and volumes have more: six from µm² to mm², nine from µm³ to mm³. There 0.001 stands for its own unit.
    `powers`: small numbers without a unit are those times a power of ten, as on an axis: 0.5 to 2, not 0.0005 to
    0.0020, which runs into its neighbours.
    """
    first, top = BASE.match(unit), largest(values)
    if powers and unit == "1" and 0.0 < top < 0.01:
        power = 3 * int(np.floor(np.log10(top) / 3.0 + 1e-9))
        return 10.0**-power, "10" + str(power).translate(RAISED)
    if not first or top == 0.0:
        return 1.0, "" if unit == "1" else written(unit)
    power, least = POWERS.get(first[0], 1), LEAST.get(first[0], 1.0)
    # no kilometres, and no kilo-radians
    small_only = first[0] in ("m", *POWERS, "rad")
    prefixes = [(size**power, prefix) for size, prefix in PREFIXES if size <= 1.0 or not small_only]
    if unit == "m2":  # 5000 mm² are no 0.005 m²
        prefixes = [(size, prefix) for size, prefix in prefixes if size < 1.0 or top >= 0.1]
    size, prefix = next((pair for pair in prefixes if top >= least * pair[0] * (1.0 - 1e-9)), prefixes[-1])
    return 1.0 / size, prefix + written(unit)


def of_label(text):
    """Unit of SI, "1" without one, and size in it of the unit in an axis' label, as label() writes it."""
    for word in reversed(re.findall(r", (\S+)", text)):
        if word.startswith("10⁻"):
            return "1", 10.0 ** int(word[2:].translate(LOWERED))
        for size, prefix in PREFIXES:
            unit = word[len(prefix) :].replace("²", "2").replace("³", "3")
            first = BASE.match(unit)
            if word.startswith(prefix) and first and not (prefix == "" and word[0] in "Gkµnp"):
                return unit.replace("·", " "), size ** POWERS.get(first[0], 1)
        if word in ("s", "Hz"):
            return word, 1.0
    return "1", 1.0


def bracketed(text):
    """An axis' label as tables have it: its unit in brackets, "depth $z$ [µm]"."""
    for found in re.finditer(r", (\S+)", text):
        if of_label(found[0]) != ("1", 1.0) or found[1] in UNPREFIXED:
            return f"{text[: found.start()]} [{text[found.start() + 2 :]}]"
    return text


def size_of(text):
    """Size in SI units of the unit in an axis' label; 1 without one."""
    return of_label(text)[1]


def counted(largest):
    """Factor and words for numbers of cycles up to the largest."""
    size, word = next((pair for pair in NUMBERS if largest >= pair[0]), (1.0, ""))
    return 1.0 / size, word + "cycles"


def label(text, unit):
    """Text with its unit, as an axis' label."""
    return ", ".join(part for part in (text, unit) if part)


def largest(arrays):
    """Largest magnitude of the finite numbers in arrays, 0 without any."""
    finite = (np.abs(a[np.isfinite(a)]) for a in map(np.asarray, arrays))
    return max((float(np.max(a)) for a in finite if a.size), default=0.0)


def number(value, digits=4):
    """A number in a text of a picture, with the minus sign that the axes have, which is no hyphen."""
    return f"{value:.{digits}g}".replace("-", "\N{MINUS SIGN}")


def plain(text):
    """A text that is no part of the program, for a picture: matplotlib would take $ and a leading _ as its own."""
    text = short(text).replace("$", r"\$")
    return " " + text if text.startswith("_") else text
