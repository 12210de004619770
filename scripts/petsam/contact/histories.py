"""Columns of a history: from a file or a mapping."""

from __future__ import annotations

import os
import re
from pathlib import Path

import numpy as np

from ..core import arrays
from ..core.files import need_regular


def table(history):
    """Returns columns and values of a history: from a file, or from {column: values}."""
    if isinstance(history, (str, os.PathLike)):
        need_regular(history)
        lines = [line.split("#")[0].strip() for line in Path(history).read_text(encoding="utf-8-sig").splitlines()]
        lines = [(n, re.split(r"\s*[,;]\s*|\s+", line)) for n, line in enumerate(lines, 1) if line]
        columns, rows = [name.strip('"') for name in lines[0][1]], [row for _, row in lines[1:]]
        for number, row in lines[1:]:
            if len(row) != len(columns):
                raise ValueError(f"{history}, line {number}: has {len(row)} fields, the head has {len(columns)}")
        return columns, np.array(rows, dtype=float)
    if not hasattr(history, "keys") or not all(isinstance(name, str) for name in history):
        raise TypeError("history: expected the name of a file, or {column: values}")
    columns = list(history)
    return columns, np.ascontiguousarray(np.column_stack([arrays.real(history[name]) for name in columns]))
