"""Pictures: command (petsam-plot), pictures (maps, profiles, loops, histories), units (prefixes), style (the look)."""
