"""Names of headings as the repository's own pages have them."""

import re


def github(text, separator="-"):
    """Returns the anchor of a heading: lower case; letters, digits, - and _ are kept, spaces become the separator."""
    return re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", separator)
