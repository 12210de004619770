"""Common parts of all modules here: the quantities of a map, and when two lengths are the same."""

QUANTITIES = {
    "height1": "heights of body 1, peaks positive",
    "height2": "heights of body 2, peaks positive",
    "separation": "separation of the bodies",
}
SAME = 1e-6  # relative difference of lengths that are meant to be the same
