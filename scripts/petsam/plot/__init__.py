"""Pictures: command (petsam-plot) and its arguments; maps and profiles of fields, series (scalars over time or over one
another), loops (and energies of cycles), wear (scars, lives), bodies (stresses), tables (studies).

colours chooses the colours of maps, symbols what known quantities are called, units the prefixes; style has the look of
all.
"""

import os

os.environ["MPLBACKEND"] = "Agg"  # pictures need no screen; matplotlib refuses to start with a name it does not know
