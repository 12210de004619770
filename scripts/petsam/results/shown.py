"""The view of Results in a notebook, whose pictures are those of the package plot, which stands above this one."""

from typing import Any

from ..core.shown import provided


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
        return provided("view")(self)
