"""The units of a deck, and the rule by which forgotten ones are found: no solid is as soft and as large at once.

A deck in mm and MPa that is read in m and Pa has moduli of 1e3 to 1e6 and bodies of metres; gels are as soft, rubbers
are softer than 1e9 Pa, and parts of either are not that large. A deck in m and Pa that is read in mm and MPa has moduli
above those of any solid. What options give in m and Pa (patch, bolts) is compared with the deck's own lengths and
moduli. Moduli below 50 Pa are those of decks in units of their own, such as E = 1.
"""

from dataclasses import dataclass

import numpy as np

from ...core.decks import folded
from ...core.errors import Error


@dataclass(frozen=True)
class Units:
    """Metres, pascals and newtons of a deck's units."""

    length: float
    stress: float
    density_name: str

    @property
    def force(self):
        """Newtons."""
        return self.stress * self.length**2

    @property
    def density(self):
        """kg/m3."""
        return self.stress / self.length**2


UNITS = {"m": Units(1.0, 1.0, "kg/m3"), "mm": Units(1e-3, 1e6, "t/mm3")}
DENSITIES = (1.0, 1e5)  # of solids whose modulus is that of a solid, kg/m3
OWN = 50.0  # Pa: smaller moduli are of decks in units of their own
GIGAPASCALS = 1e3  # Pa: below it a modulus may be one in GPa
SOFT = 1e6  # Pa: below it moduli may be those of metals and plastics in MPa; their densities are not judged
RUBBER = 1e9  # Pa
HARDEST = 1e13  # Pa; diamond has 1.2e12
LARGE, HUGE = 1.0, 20.0  # m: of soft bodies, of all
APART = 1e5  # ratio of moduli, such as of steel and rubber
COARSE = 150.0  # size of elements under the patch, in widths of it
BOLT = (0.02, 2.0)  # diameter of a bolt by the width of its washers


def of_modulus(young, size, units, what):
    """Warnings about a modulus (Pa) of something of a size (m), or Error if both cannot be right."""
    both = f"Young's modulus is {young:.6g} Pa, and {what} is {size:.3g} m long"
    if young > HARDEST:
        cure = {"m": "give moduli in Pa", "mm": "give the moduli of a deck in mm in MPa, or --units m if it is in m"}
        raise Error(f"{both}: no solid is harder than 1.2e12 Pa: {cure[units]}")
    if OWN <= young < SOFT and size >= LARGE:
        raise Error(f"{both}: a deck in mm and MPa has such numbers: give --units mm, or the deck in m and Pa")
    if OWN <= young < GIGAPASCALS:
        return [f"warning: {both}: give the deck in MPa if it is in GPa"]
    if OWN <= young < SOFT:
        return [f"warning: {both}: give --units mm if the deck is in mm and MPa"]
    if OWN <= young < RUBBER and size >= LARGE or size >= HUGE and young >= OWN:
        cure = {"m": "give a deck in mm its moduli in MPa, and --units mm", "mm": "give --units m if the deck is in m"}
        return [f"warning: {both}: {cure[units]}"]
    return []


def need_units(model):
    """Warnings about a Model whose moduli and lengths may be in other units, or Error if they must be."""
    found = []
    for part in model.parts:
        x = model.mesh.nodes[part.mesh.used()]
        size, moduli = float(np.max(np.ptp(x, axis=0))), np.concatenate([block.young for block in part.mesh.blocks])
        for young in sorted({float(moduli.min()), float(moduli.max())}):
            found += of_modulus(young, size, model.settings.units, "the mesh" if len(model.parts) == 1 else "a body")
        found += _patch(model, part)
    moduli = np.concatenate([block.young for block in model.mesh.blocks])
    if moduli.max() > APART * moduli.min():
        found.append(
            f"warning: the deck has moduli of {moduli.min():.6g} and {moduli.max():.6g} Pa: give all in one unit"
        )
    for bolt, option in zip(model.bolts, model.settings.bolts):
        found += _bolt(model, bolt, option.surfaces)
    return list(dict.fromkeys(found))


def _patch(model, part):
    """Warns of a patch that is small against all elements of its surface."""
    sizes = np.concatenate([model.mesh.sizes(group) for group in part.contact])
    width = 2.0 * model.patch.narrow
    if sizes.min() <= COARSE * width:
        return []
    return [
        f"warning: the patch is {width:.3g} m wide, and the elements of its surface are {sizes.min():.3g} m or more: "
        "give --units that are the deck's, or a finer mesh there"
    ]


def _bolt(model, bolt, surfaces):
    """Compares a bolt with its washers."""
    widths, moduli = [], []
    for group in (group for name in surfaces for group in model.mesh.surface_faces(folded(name))):
        moduli += model.mesh.blocks[group.block].young[group.elements].tolist()
    for name in surfaces:
        nodes = np.concatenate([group.nodes.ravel() for group in model.mesh.surface_faces(folded(name))])
        widths.append(float(np.max(np.ptp(model.mesh.nodes[nodes], axis=0))))
    if not BOLT[0] * max(widths) <= bolt.diameter <= BOLT[1] * min(widths):
        raise Error(
            f"bolt {bolt.name}: its diameter is {bolt.diameter:.3g} m, and its washers are {min(widths):.3g} and "
            f"{max(widths):.3g} m wide, limits {BOLT[0]:g} to {BOLT[1]:g} of that: give a length with its unit, as "
            "8mm, and --units that are the deck's"
        )
    if bolt.young * APART < max(moduli):
        raise Error(
            f"bolt {bolt.name}: its modulus is {bolt.young:.6g} Pa, and its washers have {max(moduli):.6g} Pa: give it "
            "in Pa, and --units that are the deck's"
        )
    if bolt.young > APART * min(moduli):
        return [
            f"warning: bolt {bolt.name} has a modulus of {bolt.young:.6g} Pa, and its washers have {min(moduli):.6g} Pa"
            ": give --units that are the deck's"
        ]
    return []
