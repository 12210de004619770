"""The cards of a deck (.inp): keywords with their parameters and data lines, and the numbers in these."""

import os
from dataclasses import dataclass, field

import numpy as np

from ..errors import Error, short
from ..files import need_regular

DEPTH = 10  # depth of files that include files


@dataclass
class Card:
    """A keyword with its parameters and data lines."""

    name: str
    parameters: dict
    place: str
    lines: list = field(default_factory=list)

    def need(self, name):
        """Returns a parameter that must exist."""
        if not self.parameters.get(name):
            raise Error(f"{self.place}: *{self.name} has no {name}=")
        return self.parameters[name]


def read_cards(path, depth=0):
    """Returns the deck's cards, with included files in their places."""
    if depth > DEPTH:
        raise Error(f"{path}: decks include each other more than {DEPTH} deep")
    need_regular(path)
    found = []
    with open(path, encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, 1):
            line = line.strip()
            if not line or line.startswith("**"):
                continue
            if not line.startswith("*"):
                if found:
                    found[-1].lines.append([word.strip().strip('"') for word in line.split(",")])
                continue
            name, *words = [word.strip() for word in line[1:].split(",")]
            pairs = [word.partition("=") for word in words if word]
            parameters = {key.strip().upper(): value.strip().strip('"') for key, _, value in pairs}
            card = Card(" ".join(name.upper().split()), parameters, f"{path}:{number}")
            if card.name == "INCLUDE":
                inner = os.path.join(os.path.dirname(path), card.need("INPUT").strip('"'))
                found += read_cards(inner, depth + 1)
            else:
                found.append(card)
    return found


def number_of(card, word, kind=float):
    """The number of a word of a card, which must be one."""
    try:
        number = kind(word.replace("D", "E").replace("d", "e") if kind is float else word)
    except ValueError:
        raise Error(f"{card.place}: {short(word)} in *{card.name} is no number") from None
    if kind is float and not np.isfinite(number):
        raise Error(f"{card.place}: {short(word)} in *{card.name} is not finite")
    return number
