"""Pictures: command (petsam-plot), pictures (maps, profiles, loops, histories), bodies (stresses), wear (scars, lives).

units has the prefixes, style the look of all.
"""

import os

os.environ["MPLBACKEND"] = "Agg"  # pictures need no screen; matplotlib refuses to start with a name it does not know
