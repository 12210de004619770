"""Names of headings as the repository's own pages have them."""

import re


def github(text, separator="-"):
    """The anchor of a heading: lower case, letters, digits, - and _ kept, spaces as the separator."""
    return re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", separator)
