"""Settling of a load history: the energy of each cycle over that of the last one.

petsam-one loop.h5 -o settled       settled.csv, for petsam-plot --report

Cycles begin at reversals of the displacement that does the most work.
"""

from ...core.line import Parser
from ...results import Results
from .settling import settling


def main():
    parser = Parser(prog="petsam-one", description=__doc__)
    parser.add_argument("results", help="results of petsam")
    parser.add_argument("-o", "--output", required=True, metavar="NAME", help="NAME.csv")
    options = parser.parse_args()
    settling(Results(options.results)).to_csv(options.output + ".csv")
