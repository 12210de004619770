"""What files of results show of themselves: a report as a page, and a view in a notebook.

The pictures are those of the package plot, which stands above this one and is loaded at the first request.
"""

import importlib
import os
from typing import Any, Union

REPORTS = "petsam.plot.reports"


class Shown:
    """The reports of Results, Stresses and Study."""

    def report(self, path: Union[str, os.PathLike]) -> None:
        """Writes a page of HTML with the inputs, numbers, errors, check and pictures of the file.

        Parameters
        ----------
        path : str
            Name of the page, which ends in .html; an older one is replaced.

        Raises
        ------
        Error
            If the page cannot be written, or no step has a solution.
        """
        importlib.import_module(REPORTS).report(self, path)


class Viewed:
    """The view of Results."""

    def view(self) -> Any:
        """Maps of the saved steps with a slider, for notebooks.

        Returns
        -------
        View
            What a notebook shows; `_repr_html_()` is its HTML.

        Raises
        ------
        Error
            If no step has a solution, or no fields were saved.
        """
        return importlib.import_module(REPORTS).view(self)
