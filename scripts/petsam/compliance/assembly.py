"""Decks with parts and instances, as Abaqus/CAE writes them: flat().

Each instance of a part has labels of nodes and elements of its own, moved by the instance's translation and rotation.
The flat deck has one range of labels for each instance. Where there are several instances, sets and surfaces of a part
are named `INSTANCE.NAME`, as in Abaqus; those of the assembly keep their names.
"""

import numpy as np

from ..errors import Error, short, there_are

SETS = ("NSET", "ELSET", "NAME")  # parameters that name what a part has
NAMING = ("NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "SOLID SECTION")  # cards that name or use these
LABELS = 10**8  # range of labels of an instance


def flat(cards):
    """The cards of the deck without parts and instances; decks without them as they are."""
    if not any(card.name == "INSTANCE" for card in cards):
        return cards
    parts, rest = _split(cards)
    names = [card.need("NAME").upper() for card in rest if card.name == "INSTANCE"]
    ranges = {name: LABELS * k for k, name in enumerate(names)}
    found = []
    for card in rest:
        if card.name == "INSTANCE":
            part = card.need("PART").upper()
            if part not in parts:
                raise Error(f"{card.place}: no part {short(part)}{there_are(part, sorted(parts))}")
            name = card.need("NAME").upper()
            prefix = name + "." if len(names) > 1 else ""
            move = _motion(card)
            found += [_instance(one, ranges[name], prefix, move) for one in parts[part]]
        elif card.parameters.get("INSTANCE"):
            name = card.parameters["INSTANCE"].upper()
            if name not in ranges:
                raise Error(f"{card.place}: no instance {short(name)}{there_are(name, names)}")
            prefix = name + "." if len(names) > 1 else ""
            found.append(_relabelled(card, ranges[name], prefix))
        else:
            found.append(card)
    return found


def _split(cards):
    """The cards of each part, by its name, and those outside of parts."""
    parts, rest, inside = {}, [], None
    for card in cards:
        if card.name == "PART":
            inside = parts.setdefault(card.need("NAME").upper(), [])
        elif card.name == "END PART":
            inside = None
        elif inside is not None:
            inside.append(card)
        else:
            rest.append(card)
    return parts, rest


def _instance(card, first, prefix, move):
    """A card of a part as that of an instance."""
    if card.name not in NAMING:
        return card
    found = _relabelled(card, first, prefix)
    for name in SETS:
        if found.parameters.get(name):
            found.parameters[name] = prefix + found.parameters[name]
    if card.name == "NODE":
        found.lines = [[words[0], *move(card, words[1:])] for words in found.lines]
    return found


def _relabelled(card, first, prefix):
    """A card whose labels begin at `first`, and whose data lines name the sets of the instance."""

    def label(word):
        return str(int(word) + first) if word.isdecimal() else prefix + word if word else word

    generated = "GENERATE" in card.parameters
    counts = {"NODE": 1, "SURFACE": 1, "SOLID SECTION": 0}  # of labels in a line; all words of other cards
    lines = []
    for words in card.lines:
        count = 2 if generated else counts.get(card.name, len(words))
        lines.append([*map(label, words[:count]), *words[count:]])
    return type(card)(card.name, dict(card.parameters), card.place, lines)


def _motion(card):
    """The function (card, words) that moves the coordinates of a node as the instance: its first data line is the
    translation, its second one two points of an axis and an angle in degrees, about which it is turned afterwards."""
    lines = [[word for word in words if word] for words in card.lines]
    numbers = [np.array([_number(card, word) for word in words]) for words in lines]
    if len(numbers) > 2 or any(len(one) != count for one, count in zip(numbers, (3, 7))):
        raise Error(
            f"{card.place}: *INSTANCE: expected a line of 3 numbers, the translation, and one of 7, the rotation"
        )
    shift = numbers[0] if numbers else np.zeros(3)
    start, turn = np.zeros(3), np.eye(3)
    if len(numbers) > 1:
        start, axis = numbers[1][:3], numbers[1][3:6] - numbers[1][:3]
        if not np.any(axis):
            raise Error(f"{card.place}: *INSTANCE: the two points of the axis of rotation are the same")
        x, y, z = axis / np.linalg.norm(axis)
        cross, angle = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]), np.radians(numbers[1][6])
        turn = turn + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross

    def move(node, words):
        words = [word for word in words if word]
        if len(words) < 2:
            return words  # the reader of the flat deck has a message
        at = np.array([_number(node, word) for word in (words + ["0."])[:3]])
        return [repr(float(value)) for value in start + turn @ (at + shift - start)]

    return move


def _number(card, word):
    try:
        return float(word.replace("D", "E").replace("d", "e"))
    except ValueError:
        raise Error(f"{card.place}: {short(word)} in *{card.name} is no number") from None
