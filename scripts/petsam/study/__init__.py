"""Studies: reading (the table's text), cases (made of it), expressions (in it), runs (side by side, again where they
ended), progress (printed lines), tables (results of all cases), slurm (as jobs)."""
