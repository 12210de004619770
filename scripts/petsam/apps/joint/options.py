"""The options of petsam-joint."""

from functools import partial

import numpy as np

from ...core import materials, words
from ...core.errors import Error
from ...core.line import word
from .wearing import rising
from .words import either, file_name

BESIDE = (".h5", ".hdf5", ".txt", ".csv", ".npy")  # endings of --film


def _conductivity(text):
    """A conductivity, or the name of a material that has one."""
    try:
        materials.find(text)
    except Error:
        return words.number(text, above=0.0)
    materials.conductivity(text)
    return text


def _spans(form, example, unit, geometric=True):
    """Reader of FIRST:LAST:COUNT, or of values above 0 separated by commas."""
    form = f"FIRST:LAST:COUNT, or {form} above 0 separated by commas: {example}"
    return word(words.span, form, unit, above=0.0, geometric=geometric)


def whole(least):
    """Reader of a whole number from this one on."""
    return word(words.integer, f"a whole number, {least} or more", least=least)


def _both(form, first, second):
    """Reader of FIRST,SECOND, each by its reader."""
    return word(words.each, form, first, second)


def add_stiffness(one):
    """Adds the options of stiffness."""
    group = one.add_argument_group("stiffness")
    group.add_argument(
        "--pressure",
        type=_spans("pressures", "1MPa:50MPa:12", "Pa"),
        help="nominal pressures: FIRST:LAST:COUNT or P,P,...",
    )
    group.add_argument("--friction", type=word(words.number), help="coefficient of friction; not with --normal-only")
    for body in "12":
        group.add_argument(
            f"--body{body}", type=word(materials.elastic), metavar="MATERIAL",
            help=f"material of body {body}: {', '.join(materials.TABLE)}, or Young's modulus and Poisson's ratio, "
            "210GPa,0.3",
        )  # fmt: skip
    group.add_argument(
        "--hardness",
        type=word(words.number, "a pressure above 0, such as 5GPa", "Pa", above=0.0),
        help="maximum pressure, where the surfaces yield: 5GPa",
    )
    group.add_argument("--shear", type=word(words.number), help="shear of the loop over friction times pressure (0.5)")
    group.add_argument("--periodic", action="store_true", default=None, help="the surface repeats itself: no windows")
    group.add_argument(
        "--full", action="store_true", default=None, help="compute the loops of all windows instead of one"
    )
    group.add_argument(
        "--normal-only", action="store_true", default=None,
        help="normal stiffness, real contact area and separation alone, without friction",
    )  # fmt: skip
    form = "those of both bodies, two numbers above 0, or materials: 50,50 or steel,copper"
    group.add_argument(
        "--conductivity", metavar="LAM1,LAM2", type=_both(form, _conductivity, _conductivity),
        help="conductivities of both bodies, W/(m K), or materials, for the conductance; with --electrical S/m",
    )  # fmt: skip
    group.add_argument(
        "--electrical", action="store_true", default=None, help="a current instead of heat: units S/m, S/m2, Ohm m2"
    )
    form = "a number, 0 or more, or a file with one at each point: 1e-6, film.h5"
    resistance = partial(words.number, least=0.0)
    group.add_argument(
        "--film", metavar="R",
        type=word(either, form, resistance, partial(file_name, form=form, endings=BESIDE)),
        help="resistance of a film on the spots per area, m2 K/W, or Ohm m2, or a file with one at each point of the "
        "surface: a text, or HDF5 with a dataset film",
    )  # fmt: skip
    form = "THICKNESS,CONDUCTIVITY, a length and a number above 0, or a material: 2um,317 or 2um,gold"
    layer = _both(form, partial(words.number, unit="m", above=0.0), _conductivity)
    for body in "12":
        group.add_argument(
            f"--layer{body}", type=layer, metavar="T,LAM", action="append",
            help=f"thickness and conductivity, or material, of a conducting layer on body {body}: 2um,gold; may "
            "be repeated from the surface inwards",
        )  # fmt: skip
    form = "LAM,M, a conductivity above 0 and a length, 0 or more: 0.026,0.37um"
    jump = partial(words.number, unit="m", least=0.0)
    group.add_argument(
        "--gas", type=_both(form, partial(words.number, above=0.0), jump), metavar="LAM,M",
        help="conductivity of what fills the gap, W/(m K), and length of the temperature jump: air 0.026,0.37um",
    )  # fmt: skip
    group.add_argument("--cores", type=whole(1), help="processes for the windows (all available cores)")
    group.add_argument(
        "--area",
        type=word(words.number, "an area above 0, such as 2mm2", "m2", above=0.0),
        help="area of the elements in NAME.json, such as 2mm2 (1 m2: they are per area)",
    )


def add_structure(one):
    """Adds the options of the other actions."""
    group = one.add_argument_group("backbone, band, wear and response")
    group.add_argument("--contact", metavar="NAME", help="file of petsam's options: -grid_n, -friction, -gap_type, ...")
    group.add_argument(
        "--preload", type=word(words.named, "BOLT=FORCE, such as B1=12kN", "N", least=0.0),
        action="append", metavar="BOLT=N",
        help="initial tension of a bolt, such as B1=12kN; may be repeated: bolts are tightened in this order",
    )  # fmt: skip
    group.add_argument("--sensor", metavar="NAME:D", help="where the amplitude is, and its direction x, y or z")
    group.add_argument(
        "--damping",
        type=word(words.number, "a part of critical damping"),
        help="damping of the material, as a part of critical damping (0)",
    )
    group.add_argument(
        "--harmonics", type=whole(0), help="how many are balanced (backbone 0: quasi-static; response 3)"
    )
    group = one.add_argument_group("backbone, band and wear")
    group.add_argument("--mode", type=whole(1), help="number of the mode while all that touches sticks (1)")
    group.add_argument(
        "--amplitudes",
        type=_spans("lengths", "1um:0.1mm:12", "m"),
        help="at the sensor: FIRST:LAST:COUNT, such as 1um:0.1mm:12",
    )
    group.add_argument(
        "--degree-check", action="store_true", default=None,
        help="also the largest amplitude with polynomials of a degree lower by 2",
    )  # fmt: skip
    form = "friction=S or preload=S, a standard deviation as a part of it: friction=0.1"
    scatter = word(words.named, form, least=0.0, below=1.0, known="friction|preload")
    group.add_argument(
        "--scatter", type=scatter, action="append", metavar="NAME=S",
        help="standard deviation of friction or preload as a part of it, may be repeated: friction=0.1",
    )  # fmt: skip
    cycles = word(words.numbers, "rising whole numbers above 0: 1e4,1e5,1e6", together=rising, to=np.array)
    group.add_argument("--cycles", type=cycles, help="of the vibration that wears, for the numbers: 1e4,1e5,1e6")
    group = one.add_argument_group("response")
    group.add_argument(
        "--force",
        type=word(words.named, "SENSOR:D=FORCE, such as TIP:z=0.5N", "N", above=0.0),
        metavar="SENSOR:D=N",
        help="amplitude of the force, and where it acts; also the sensor",
    )
    group.add_argument(
        "--frequencies", type=_spans("frequencies", "110Hz:118Hz:17", "Hz", geometric=False),
        help="of the force, Hz, in the order of computation: FIRST:LAST:COUNT, such as 110:118:17",
    )  # fmt: skip
