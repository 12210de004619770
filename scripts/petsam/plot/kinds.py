"""The kinds of picture of each kind of file, and those that a file is good for: of petsam-plot and of reports."""

from ..results import cycles
from ..results.stresses import Stresses
from ..results.studies import Study
from . import fields, gradients, noise, pictures, wear

STUDY = "study"  # the only kind of a study's table
# the pictures of files of petsam, of petsam-stress and of petsam-study, by their kinds
OF_RESULTS = {
    "maps": pictures.maps, "profiles": pictures.profiles, "loop": pictures.loop, "energy": pictures.energy,
    "history": pictures.history, "fretting-log": pictures.fretting_log, "scar": pictures.scar, "life": pictures.life,
    "gradient": pictures.gradient,
}  # fmt: skip
OF_STRESSES = {
    "maps": pictures.stress_maps, "sections": pictures.sections, "profiles": pictures.stress_profiles,
    "fatigue": pictures.fatigue,
}  # fmt: skip
OF_STUDIES = {STUDY: pictures.study}
TABLES = {Stresses: OF_STRESSES, Study: OF_STUDIES}
MANY = 3  # cycles from which their loops and energies are drawn without being asked for


def of_results(results):
    """Kinds of pictures for results of petsam."""
    return [*_of_steps(results), *(["gradient"] if all(gradients.drawn(one) for one in results) else [])]


def _of_steps(results):
    """The kinds but for gradients; of a file that lacks fields, a picture whose message says so."""
    lines = any(one.is_plane for one in results)
    maps = ["maps", "profiles"][lines:] if all(one.steps and fields.usual(one) for one in results) else []
    if all(one.has_life for one in results):
        scars = any(wear.worn(one, one.of_last()) for one in results)
        loops = not any(one.is_steady for one in results)
        return [*maps, *(["fretting-log"] if loops else []), *(["scar"] if scars else []), "life"]
    several = any(one.solved.size > 1 for one in results)
    if not any(one.solved.size and noise.works(one) for one in results):  # normal loads alone: no loop, no energy
        return [*maps, *(["history"] if several else [])] or ["maps", "profiles"][lines : lines + 1]
    repeated = all(one.solved.size and not one.has_life and len(cycles.find(one)) >= MANY for one in results)
    more = ["loop", *(["energy"] if repeated else []), "history", *(["fretting-log"] if repeated else [])]
    return [*maps, *(more if several else [])] or ["maps", "profiles"][lines : lines + 1]


def of_stresses(files):
    """Kinds of pictures for files of stresses; of one that lacks stresses, a picture whose message says so."""
    kinds = []
    if any(name in file for file in files for name in ("stress_xx", "mises")):
        if not any(file.along for file in files):
            kinds.append("maps")
        elif all(file.along and file.z.size > 1 for file in files):
            kinds.append("sections")
        kinds.append("profiles")
    if all(one.fatigue for one in files):
        kinds.append("fatigue")
    return kinds or ["profiles"]


def usual(files):
    """The kinds of picture that files of one kind contain data for."""
    if isinstance(files[0], Study):
        return [STUDY]
    return (of_stresses if isinstance(files[0], Stresses) else of_results)(files)


def function(kind, files):
    """The picture of a kind, of petsam.plot."""
    return TABLES.get(type(files[0]), OF_RESULTS)[kind]
