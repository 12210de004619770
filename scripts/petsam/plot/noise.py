"""Pictures omit constants and rounding noise, unless they are named.

The rule: a scalar counts where it varies, a field where it differs from zero, by more than NOISE of the scale of its
kind, over all files of a picture. The scales: of forces the maximum load; of displacements and slip the maximum
displacement; of moments a force times the size of the contact; of rotations a displacement over it; of shear the
maximum pressure; of energies a force times a displacement; of other units the maximum itself. Moments of periodic
bodies, which do not rotate, do not count.
"""

import numpy as np

from ..results.cycles import ENERGY, PAIRS, TANGENTIAL
from .units import largest

NOISE = 1e-6  # of the scale: solvers converge to 1e-8 and less
FORCES, WAYS = ("load_n", "load_tx", "load_ty"), ("disp_z", "disp_x", "disp_y")
AREA = "contact_area"
CREEPS, SPIN = ("creep_x", "creep_y"), "creep_spin"
MOMENTS = ("load_mx", "load_my", "load_mz")


def _largest(results, names):
    return largest(one.series(name).astype(float) for one in results for name in names if name in one.history)


def scales(results):
    """Unit: scale of the scalars with this unit."""
    force, way = _largest(results, FORCES), _largest(results, WAYS)
    size = np.sqrt(_largest(results, (AREA,))) or largest(axis for one in results for axis in (one.x, one.y))
    known = {"N": force, "N m": force * size, "m": way, "rad": way / size, "J": force * way}
    if all(one.is_steady for one in results):  # creepages and spin
        creep = max(_largest(results, CREEPS), _largest(results, (SPIN,)) * size)
        known.update({"1": creep, "1/m": creep / size})
    return known


def varies(results, name, known):
    """True if a scalar of /history varies in any of the files; `known` are the scales() of them all."""
    own = _largest(results, (name,))
    for one in results:
        values = one.series(name).astype(float)
        values = values[np.isfinite(values)]
        if name in MOMENTS and str(one.parameters.get("elasticity")) == "periodic":
            continue
        if name == ENERGY:  # drawn as a sum
            if abs(float(np.sum(values))) > NOISE * known["J"]:
                return True
        elif values.size and float(np.ptp(values)) > NOISE * known.get(one.units[name], own):
            return True
    return False


def works(one):
    """True if friction does something in a history: a tangential load works, or something is dissipated."""
    known = scales([one])
    if one.is_steady:
        return False
    if varies([one], ENERGY, known):
        return True
    return any(all(varies([one], name, known) for name in PAIRS[pair]) for pair in TANGENTIAL)


def is_nothing(name, tops, results):
    """True if shear or slip is zero but for rounding; tops are the largest values of all fields of a picture."""
    if name.startswith("shear"):
        scale = tops.get("pressure")
    elif name.startswith("slip"):
        scale = scales(results)["m"]
    else:
        return False
    return scale is not None and tops[name] <= NOISE * scale
