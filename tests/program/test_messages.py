"""Each message stands once in the sources: what two places refuse, one function refuses for both."""

import re
from collections import defaultdict

from support import ROOT

LEAST = 25  # characters, below which two messages may be the same by chance
COMMENT = re.compile(r'/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.S)  # or a literal, which may hold what looks like a comment
TEXT = re.compile(r'"(?:\\.|[^"\\\n])*"(?:\s*(?:[A-Z]\w*\s*)?"(?:\\.|[^"\\\n])*")*')  # macros may stand between
WORDS = re.compile(r"[a-z]{3,}.* .*[a-z]{3}")  # formats without words of their own say nothing


def messages(text):
    """The literals of a source with their line, adjacent ones joined."""
    text = COMMENT.sub(
        lambda found: found.group() if found.group()[0] == '"' else re.sub(r"[^\n]", " ", found.group()), text
    )
    for found in TEXT.finditer(text):
        line = text.count("\n", 0, found.start()) + 1
        parts = re.findall(r'"(?:\\.|[^"\\\n])*"|\w+', found.group())
        yield re.sub(r"\s+", " ", "".join(part[1:-1] if part[0] == '"' else "#" for part in parts)), line


def test_literals_are_joined_and_comments_left_out():
    source = 'a("one " /* no "two" */\n  "more", "/* kept */");\n/* "lost" */ b("x" PRI "y");'
    assert list(messages(source)) == [("one more", 1), ("/* kept */", 2), ("x#y", 3)]


def test_each_message_stands_once():
    places = defaultdict(list)
    for path in sorted((ROOT / "src").rglob("*.[ch]")):
        for text, line in messages(path.read_text()):
            if len(text) >= LEAST and WORDS.search(text) and "</" not in text:  # no markup
                places[text].append(f"{path.relative_to(ROOT)}:{line}")
    twice = {text: where for text, where in places.items() if len(where) > 1}
    assert twice == {}, "\n".join(f"{text}: {', '.join(where)}" for text, where in twice.items())


def test_whole_numbers_have_no_point():
    """PETSc's functions write 40. for 40 by %g alone, and 40 by %.6g."""
    calls = re.compile(r"\b(PetscCheck|PetscSNPrintf|SETERRQ|PetscPrintf|PetscViewerASCIIPrintf)\(")
    for path in sorted((ROOT / "src").rglob("*.[ch]")):
        for statement in path.read_text().split(";"):
            assert "%g" not in statement or not calls.search(statement), f"{path}: {statement}"
