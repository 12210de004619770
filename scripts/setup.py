"""Adds to pyproject.toml the scripts, petsam-plot and its links, one for each application, and the parts that
`make wheel` adds, the files in data/ (scripts/packaging/wheel.py) and the platform.

Without the variable PETSAM_WHEEL, as by `pip install ./scripts`, the package is pure Python.
"""

import os
from pathlib import Path

from setuptools import setup

platform = os.environ.get("PETSAM_WHEEL")
places = {}
for path in sorted(Path("data").rglob("*")) if platform else ():
    if path.is_file():
        places.setdefault(str(path.parent.relative_to("data")), []).append(str(path))

setup(
    scripts=sorted(str(path) for path in Path().glob("petsam-*") if path.is_file()),
    data_files=list(places.items()),
    options={"bdist_wheel": {"plat_name": platform}} if platform else {},
)
