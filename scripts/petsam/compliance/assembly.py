"""Decks with parts and instances, as Abaqus/CAE writes them: flat().

Each instance of a part has labels of nodes and elements of its own, moved by the instance's translation and rotation.
The flat deck has one range of labels for each instance, and one for the nodes of the assembly. Sets and surfaces of a
part are named `INSTANCE.NAME`, as in Abaqus; those of the assembly keep their names.
"""

import numpy as np

from ..errors import Error, short, there_are
from .cards import Card, number_of

SETS = ("NSET", "ELSET", "NAME")  # parameters that name what a part has
NAMING = ("NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "SOLID SECTION")  # cards that name or use these
LABELS = 10**12  # range of labels of an instance


def flat(cards):
    """The cards of the deck without parts and instances; decks without them as they are."""
    if not any(card.name in ("PART", "INSTANCE") for card in cards):
        return cards
    parts, instances, rest = _split(cards)
    ranges = {name: LABELS * k for k, name in enumerate(instances)}
    found = []
    for name, (head, own) in instances.items():
        part = head.need("PART").upper()
        if part not in parts:
            raise Error(f"{head.place}: no part {short(part)}{there_are(part, sorted(parts))}")
        move = _motion(head)
        found += [_instance(card, ranges[name], name + ".", move) for card in parts[part] + own]
    own = {words[0] for card in rest if card.name in ("NODE", "ELEMENT") for words in card.lines if words}
    return found + [_of_assembly(card, ranges, own) for card in rest]


def _split(cards):
    """The cards of each part by its name, each instance with the cards inside it, and the cards outside of both."""
    parts, instances, rest, inside, head = {}, {}, [], None, None
    for card in cards:
        if card.name in ("END PART", "END INSTANCE"):
            inside = None
        elif card.name in ("PART", "INSTANCE", "ASSEMBLY", "STEP"):
            if inside is not None:
                raise Error(f"{head.place}: *{head.name} has no *END {head.name}")
            if card.name in ("PART", "INSTANCE"):
                head, inside = card, []
                _add(parts if card.name == "PART" else instances, card, inside)
            else:
                rest.append(card)
        else:
            (rest if inside is None else inside).append(card)
    if inside is not None:
        raise Error(f"{head.place}: *{head.name} has no *END {head.name}")
    if not instances:
        raise Error(f"{cards[0].place.rpartition(':')[0]}: has parts, but no *INSTANCE of them")
    return parts, instances, rest


def _add(known, card, inside):
    """Adds a part or an instance, whose name must be new."""
    name = card.need("NAME").upper()
    if name in known:
        raise Error(f"{card.place}: *{card.name} {short(name)} is given twice")
    known[name] = inside if card.name == "PART" else (card, inside)


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


def _of_assembly(card, ranges, own):
    """A card outside of all instances, which may name one (instance=), or its labels as INSTANCE.LABEL; own: labels of
    the assembly, those of reference points."""
    if card.parameters.get("INSTANCE"):
        name = card.parameters["INSTANCE"].upper()
        if name not in ranges:
            raise Error(f"{card.place}: no instance {short(name)}{there_are(name, list(ranges))}")
        return _relabelled(card, ranges[name], name + ".")
    if card.name in NAMING:
        for word in (word for words in card.lines for word in words[: 1 if "GENERATE" in card.parameters else None]):
            if card.name in ("NSET", "ELSET") and word.isdecimal() and word not in own:
                raise Error(f"{card.place}: *{card.name} has {word}, which is no label of the assembly: give instance=")
        card = _relabelled(card, LABELS * len(ranges), "")

    def label(word):
        name, _, number = word.rpartition(".")
        return str(ranges[name.upper()] + int(number)) if name.upper() in ranges and number.isdecimal() else word

    return Card(card.name, card.parameters, card.place, [[*map(label, words)] for words in card.lines])


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
    return Card(card.name, dict(card.parameters), card.place, lines)


def _motion(card):
    """The function (card, words) that moves the coordinates of a node as the instance: its first data line is the
    translation, its second one two points of an axis and an angle in degrees, about which it is turned afterwards."""
    lines = [[word for word in words if word] for words in card.lines]
    numbers = [np.array([number_of(card, word) for word in words]) for words in lines]
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
        at = np.array([number_of(node, word) for word in (words + ["0."])[:3]])
        return [repr(float(value)) for value in start + turn @ (at + shift - start)]

    return move
