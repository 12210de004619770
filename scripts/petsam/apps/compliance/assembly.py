"""Decks with parts and instances, as Abaqus/CAE writes them: flat().

Each instance of a part has labels of nodes and elements of its own, moved by the instance's translation and rotation.
The flat deck has one range of labels for each instance, and one for the nodes of the assembly. Sets and surfaces of a
part are named `INSTANCE.NAME`, as in Abaqus; those of the assembly keep their names.
"""

import numpy as np

from ...core.decks import folded
from ...core.errors import Error, short, there_are
from .cards import Card, number_of, trimmed

SETS = ("NSET", "ELSET", "NAME")  # parameters that name what a part has
NAMING = ("NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "SOLID SECTION")  # cards that name or use these
DIGITS = 12  # of labels
LABELS = 10**DIGITS  # range of labels of an instance


def instance_names(cards):
    """Names of the instances, in the order of their ranges of labels."""
    return [card.parameters.get("NAME", "") for card in cards if card.name == "INSTANCE"]


def label_of(number, names):
    """A label of the flat deck as it is written: 5, or INSTANCE.5; names: of the instances."""
    if number < 0:
        return str(number)
    place, own = divmod(number, LABELS)
    return f"{short(names[place])}.{own}" if 0 <= place < len(names) else str(own)


def flat(cards):
    """The cards of the deck without parts and instances; decks without them as they are."""
    if not any(card.name in ("PART", "INSTANCE") for card in cards):
        return cards
    parts, instances, rest = _split(cards)
    ranges = {name: LABELS * k for k, name in enumerate(instances)}
    found = []
    for name, (head, own) in instances.items():
        part = folded(head.need("PART"))
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
                raise Error(f"{head.place}: *{head.name} has no *END {head.name}: add it")
            if card.name in ("PART", "INSTANCE"):
                head, inside = card, []
                _add(parts if card.name == "PART" else instances, card, inside)
            else:
                rest.append(card)
        else:
            (rest if inside is None else inside).append(card)
    if inside is not None:
        raise Error(f"{head.place}: *{head.name} has no *END {head.name}: add it")
    if not instances:
        raise Error(f"{cards[0].place.rpartition(':')[0]}: has parts, but no *INSTANCE of them: add it")
    return parts, instances, rest


def _add(known, card, inside):
    """Adds a part or an instance, whose name must be new."""
    name = folded(card.need("NAME"))
    if name in known:
        raise Error(f"{card.place}: *{card.name} {short(name)} is given twice: rename one")
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
        found.lines = [words.with_words([words[0], *move(card, words)]) for words in found.lines]
    return found


def _of_assembly(card, ranges, own):
    """A card outside of all instances, which may name one (instance=), or its labels as INSTANCE.LABEL; own: labels of
    the assembly, those of reference points."""
    if card.parameters.get("INSTANCE"):
        name = folded(card.parameters["INSTANCE"])
        if name not in ranges:
            raise Error(f"{card.place}: no instance {short(name)}{there_are(name, list(ranges))}")
        found = _relabelled(card, ranges[name], name + ".")
        if card.name == "NSET" and found.parameters.get("ELSET"):
            found.parameters["ELSET"] = name + "." + found.parameters["ELSET"]
        return found
    if card.name in NAMING:
        count = 1 if "GENERATE" in card.parameters else None
        for words in card.lines:
            wrong = [word for word in words[:count] if word.isdecimal() and word not in own]
            if wrong and card.name in ("NSET", "ELSET"):
                raise Error(
                    f"{words.place}: *{card.name} has {wrong[0]}, which is no label of the assembly: give instance="
                )
        card = _relabelled(card, LABELS * len(ranges), "")

    def label(word):
        name, _, number = word.rpartition(".")
        name = folded(name)
        return str(ranges[name] + int(number)) if name in ranges and number.isdecimal() else word

    lines = [words.with_words(map(label, words)) for words in card.lines]
    return Card(card.name, card.parameters, card.place, lines)


def _relabelled(card, first, prefix):
    """A card whose labels begin at `first`, and whose data lines name the sets of the instance."""

    def label(words, word):
        if not word.isdecimal():
            return prefix + word if word else word
        if len(word) > DIGITS:
            raise Error(f"{words.place}: label {short(word)} of an instance is too large: use up to {DIGITS} digits")
        return str(int(word) + first)

    generated = "GENERATE" in card.parameters
    counts = {"NODE": 1, "SURFACE": 1, "SOLID SECTION": 0}  # of labels in a line; all words of other cards
    lines = []
    for words in card.lines:
        count = 2 if generated else counts.get(card.name, len(words))
        lines.append(words.with_words([*(label(words, word) for word in words[:count]), *words[count:]]))
    return Card(card.name, dict(card.parameters), card.place, lines)


def _motion(card):
    """The function (card, words) that moves the coordinates of a node as the instance: its first data line is the
    translation, its second one two points of an axis and an angle in degrees, about which it is turned afterwards."""
    lines = [trimmed(words) for words in card.lines]
    numbers = [np.array([number_of(card, word, line=line) for word in line]) for line in lines]
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

    def move(node, line):
        words = trimmed(line)[1:]
        if len(words) < 2:
            return words  # the reader of the flat deck has a message
        at = np.array([number_of(node, word or "0.", line=line) for word in (words + ["0."])[:3]])
        return [repr(float(value)) for value in start + turn @ (at + shift - start)]

    return move
