"""Pictures: command (petsam-plot) and its arguments; maps and profiles of fields, series (scalars over time or over one
another), loops (and energies of cycles), wear (scars, lives), bodies (stresses), tables (studies).

colours chooses the colours of maps, symbols what known quantities are called, units the prefixes; style has the look of
all.
"""

import os
import sys

if "ipykernel" not in sys.modules or "MPLBACKEND" not in os.environ:  # a notebook shows pictures by its own backend
    os.environ["MPLBACKEND"] = "Agg"  # no screen is needed; matplotlib refuses to start with a name it does not know


class Pictures:
    """The pictures of an open file as matplotlib figures: those of petsam-plot, by the names of its options.

    results.plot.maps(step=[20, -1], field="shear_x"), .loop(), .section(), and so on for all that petsam-plot --help
    lists; other files are compared: results.plot.loop(other, load="tx"). Options are keywords, with _ for -: values,
    lists of them, or True for those without one.
    """

    def __init__(self, file):
        self._file = file

    def __getattr__(self, kind):
        from . import command

        name = kind.replace("_", "-")
        if name == "section":  # in the body where there are stresses, else across the surface
            name = "sections" if hasattr(self._file, "z") else "profiles"
        if name not in command.KINDS:
            raise AttributeError(f"no picture {kind}: there are section, {', '.join(self.__dir__())}")
        return lambda *others, **options: command.picture(name, [self._file, *others], **options)

    def __dir__(self):
        from . import command

        return [kind.replace("-", "_") for kind in command.KINDS]
