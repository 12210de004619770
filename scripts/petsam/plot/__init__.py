"""Pictures: command (petsam-plot), pictures (maps, profiles, loops, histories), units (prefixes), style (the look)."""

import os

os.environ["MPLBACKEND"] = "Agg"  # pictures need no screen; matplotlib refuses to start with a name it does not know
