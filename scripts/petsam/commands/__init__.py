"""The command lines of petsam-plot, petsam-study and others: options, what they print, exit codes.
What they compute and draw is in the packages beside this one.
"""
