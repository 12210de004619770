"""What `make wheel` adds to pyproject.toml: the files in data/ (scripts/packaging/wheel.py) and the platform.

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

setup(data_files=list(places.items()), options={"bdist_wheel": {"plat_name": platform}} if platform else {})
