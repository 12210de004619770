"""Studies: command (petsam-study), cases (the table, with expressions), runs (side by side, again where they ended),
progress (what is said), tables (results of all cases), slurm (as jobs)."""
