#!/usr/bin/env python3
"""Looks for words and phrases that petsam's pages, help and messages avoid, and prints what to use instead.

    python3 scripts/maintain/check_words.py [root] [--only WORD ...] [--count]

Searched are pages (*.md), help texts (*.help), and the strings of C and Python in src, include, scripts and examples,
without comments and the docstrings of functions; tests, which quote messages, only in their pages. In pages the tables
between <!-- petsam: ... --> and <!-- end --> are left out, as their texts are strings in C, and so are comments and
addresses. No cell of a table may exceed 300 characters, nor README.md 130 lines. No docstring in scripts may begin
with What, Whether, Those, Of or Which. --only names words of the files' paths, --count prints a number for each folder.
Exit code 1 when a word is found.
"""

import argparse
import ast
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

# what is forbidden (a regular expression in which a space matches any white space), and its replacement
LISTED = r"(?:line|row|value|number|file|bytes?|steps|MB|GB|vectors?|numbers|column)"
RULES = (
    # programs and files do not act like people
    (r"trusts?", "check independently"),
    (r"(?:says|said)", "print, report, give, show; a page explains"),
    (r"(?:tells?|told)", "print, report, give, show"),
    (r"knows?(?: of| about| its)", "include, take into account; does not know of: ignores"),
    (r"(?:asks|asked)(?: for| of| that)?", "request, require"),
    (r"heeds?", "apply"),
    (r"sees", "read, receive"),
    (r"nobody", "name the subject"),
    (r"whoever", "name the subject"),
    (r"adversar(?:y|ies)", "fuzzing, fuzzer"),
    (r"spoiled", "malformed"),
    (r"second opinion", "cross-check"),
    # pronouns without a noun, and clauses with what
    (r"One that", "name the noun"),
    (r"values? that (?:is|are) none", "non-finite value"),
    (r"(?:all|everything) that (?:is|are) (?:there|at hand)", "name the noun"),
    (r"(?<=[.;:] )What (?=\w)(?![^.:;]*\?)", "name the noun; no clause with what as the subject"),
    (r"what (?:yields|slips|sticks|overlaps|varies|touches|matters)", "name the noun"),
    # rates, differences, ratios
    (LISTED + r" an? (?:load step|step|case|cycle|cell|iteration|rank|computed cycle|row|second|node)", "per"),
    (r"a (?:line|row|value|number|file) (?:a|for each|for every) (?:load )?(?:step|case|cell|cycle)", "one ... per"),
    (
        r"(?:stretch|separation|displacement|strain|tilt|force|stress|area|pressure|volume) less (?:that|the|its)",
        "minus",
    ),
    # accuracy
    (r"(?:more|less|how|most|as) exact(?:ly)?(?: as)?", "accurate; exact means without error"),
    (r"right to [\d.]+", "accurate to"),
    (r"proof that", "check; a check is no proof"),
    (r"(?:does|do|did) (?:not|hardly) grow with the (?:grid|number of cells)", "nearly independent of the grid"),
    (r"without (?:any )?limit of stability", "unconditionally stable"),
    # messages
    (r"not together with", "incompatible with"),
    (r"all the same", "anyway, also then"),
    (r"refus(?:e|es|ed|ing|als?)", "reject"),
    (r"(?:take|takes|taken|took) (?:it |them )?out", "remove"),
    (r"(?:expected|use|wants?) so many times", "that many times"),
    (r"so (?:many|often) (?:cycles|times|steps)", "that many"),
    (r"a ratio is meant", "give a ratio"),
    (r"(?:memory|cores|processors) at hand", "available"),
    (r"without end", "in a loop, unlimited"),
    (r"no farther", "no further"),
    # the terms of the field
    (r"closed solutions?", "closed-form solution"),
    (r"greatest", "maximum, peak"),
    (
        r"largest (?:pressure|shear|slip|principal|von Mises|tension|stress|depth|values? of|gap error|error|removed)",
        "maximum, peak",
    ),
    (r"rigid displacements?", "rigid-body displacement"),
    (r"(?:path|way) of slip", "accumulated slip"),
    (r"ways? slipped", "accumulated slip"),
    (r"(?:work|energy) of friction", "frictional work, dissipated energy"),
    (r"work on (?:what|the cells that) yields?", "plastic work"),
    (r"to and fro", "cyclic, reciprocating"),
    (r"turning points?", "load reversal"),
    (r"(?:motion|step|steps|steps that) (?:that )?(?:goes|go) on", "continued loading"),
    (r"unlike (?:bod(?:y|ies)|materials?)", "elastically dissimilar"),
    (r"acts? on each other", "are coupled"),
    (r"(?:zones?|spots?) of (?:cells in )?contact", "contact spots"),
    (r"cells? (?:that |which )?(?:the|an?|its) edges? cuts?", "cut cells"),
    (r"shear that sticks", "locked-in shear"),
    (r"inf: straight", "inf: cylindrical"),
    (r"straight along [xy]", "cylindrical, axis along x or y"),
    (r"mean surfaces?", "mean planes"),
    (r"(?<!fatigue )(?<!service )(?:a|the|this|whole|its|each|per|of) (?:life|lives)(?![.\w])", "wear simulation"),
    (r"jump(?:s|ed|ing)? over", "cycle jump; skipped cycles"),
    (r"limits? of stability", "stability limit"),
    (r"(?:pressure|pressures) (?:is |was )?levell?ed|levell?ed (?:pressure|by wear)", "flattened"),
    (r"factor on the (?:largest |maximum )?mean stress", "hydrostatic stress"),
    (r"smallest (?:enclosing )?(?:circle|sphere)s?", "minimum circumscribed circle or sphere"),
    (r"path of the (?:deviator|shear)", "deviatoric stress path, path of shear stress"),
    (r"instants", "time samples"),
    (r"(?<!dot )(?<!inner )(?<!scalar )products(?! of inertia)", "operator applications"),
    (r"(?:pass(?:es)? of the coupling|each pass|between passes|last pass)", "coupling or correction iteration"),
    (r"cold solves?", "solve from zero"),
    (r"plain (?:solutions?|shear|pressure|one|contact)", "uncorrected"),
    (r"(?<!square )roots? of (?:the|its) (?:distance|radius|cell)", "square root of the distance"),
    (r"like (?:a|the) root", "like the square root of"),
    (r"orders? of the cell", "order in cell size"),
    (r"<(?:whole|word|text)(?=>|\W)", "<integer>, <keyword>, <string>"),
    (r"(?:go|goes|going|gone|went) on(?! to)", "continue, resume"),
    (r"stands? (?:in|there)", "is in, is listed in"),
    (r"load programs?", "load history"),
    (r"(?:a|the|fastest|every|each) peers?(?! review)", "reference code"),
    (r"elapsed", "wall time"),
)
HEADING = re.compile(r"^#+ (?:What|Where|Why|How|When|Which)\b.*", re.M)  # headings of pages must name their subject
# docstrings must not begin so
OPENING = re.compile(r"(?:What|Whether|Those|Of|Which)\b.*")
PLAIN = "a plain sentence: Returns ..., True if ..., or a noun"


def compiled(rule):
    """The rule between words; its spaces match any white space without a blank line, in a look-behind one character."""
    space = r"(?:[^\S\n]+|[^\S\n]*\n[^\S\n]*)"
    spaced = re.sub(r"(\(\?<[!=][^)]*\))| ", lambda m: m[1].replace(" ", r"\s") if m[1] else space, rule)
    bounded = spaced if rule.startswith("<") else rf"(?<![\w-])(?:{spaced})(?!\w)"
    return re.compile(bounded, re.I if rule[:8] == rule[:8].lower() else 0)


COMPILED = [(compiled(rule), better) for rule, better in RULES]
C_TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.S)
LONGEST_CELL, LINES_OF_README = 300, 130
SEARCHED = ("src", "include", "scripts", "examples")
# quotes the words
EXCEPT = ("scripts/maintain/check_words.py",)


def files_of(root):
    """Returns the files that git lists, or all files if the folder is no repository."""
    listed = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard"], cwd=root, capture_output=True, text=True, check=False
    )
    names = listed.stdout.split("\n") if listed.returncode == 0 else [str(p.relative_to(root)) for p in root.rglob("*")]
    return sorted(name for name in names if name and (root / name).is_file() and name not in EXCEPT)


def blank(found):
    """Returns white space in place of a match, with its line ends."""
    return re.sub(r"[^\n]", " ", found.group())


def texts_of_page(text):
    text = re.sub(r"<!-- petsam[\w-]*: .*?<!-- end -->", blank, text, flags=re.S)
    text = re.sub(r"<!--.*?-->", blank, text, flags=re.S)
    yield 1, re.sub(r"\]\([^)\n]*\)|https?://\S+", blank, text)


def texts_of_c(text):
    """Returns strings with the line of their start; neighbouring strings are one."""
    joined, start, end = "", 0, 0
    for found in C_TOKEN.finditer(text):
        token = found.group()
        if not token.startswith('"') or text[text.rfind("\n", 0, found.start()) + 1 :].startswith("#include"):
            continue
        if joined and not text[end : found.start()].strip():
            joined += token[1:-1]
        else:
            if joined:
                yield start, joined
            joined, start = token[1:-1], text.count("\n", 0, found.start()) + 1
        end = found.end()
    if joined:
        yield start, joined


def texts_of_python(text):
    """Returns the strings, including the module's docstring, which is a program's help, but no other docstrings."""
    tree, inner = ast.parse(text), set()
    for node in ast.walk(tree):
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and isinstance(node.body[0], ast.Expr):
            inner.add(node.body[0].value)
        elif isinstance(node, ast.JoinedStr):
            inner.update(ast.walk(node))
            inner.discard(node)
    for node in ast.walk(tree):
        if node in inner:
            continue
        if isinstance(node, ast.JoinedStr):
            parts = [v.value if isinstance(v, ast.Constant) else "{}" for v in node.values]
            yield node.lineno, "".join(str(part) for part in parts)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, node.value


def is_python(name, text):
    return name.endswith(".py") or text.startswith("#!/usr/bin/env python")


def texts(name, text):
    """(line, text) pairs of a file."""
    if name.endswith(".md"):
        return texts_of_page(text)
    if name.endswith(".help"):
        return [(1, text)]
    if name.startswith(SEARCHED):
        if name.endswith((".c", ".h")):
            return texts_of_c(text)
        if is_python(name, text):
            return texts_of_python(text)
    return []


def openings(name, text):
    """Returns {(line, words, replacement)} of the docstrings of a module in scripts, its classes and functions."""
    if not (name.startswith("scripts/") and is_python(name, text)):
        return set()
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    nodes = [node for node in ast.walk(ast.parse(text)) if isinstance(node, kinds)]
    found = [(node, OPENING.match(ast.get_docstring(node) or "")) for node in nodes]
    return {(node.body[0].lineno, words.group(), PLAIN) for node, words in found if words}


def findings(name, text):
    """Sorted (line, words, replacement) of a file."""
    out = set()
    for line, piece in texts(name, text):
        piece = piece.replace("\\n", "\n ") if name.endswith((".c", ".h")) else piece
        for pattern, better in COMPILED:
            for found in pattern.finditer(piece):
                start = found.start() + len(found.group()) - len(found.group().lstrip())
                at = line if name.endswith((".c", ".h")) else line + piece.count("\n", 0, start)
                out.add((at, " ".join(found.group().split()), better))
        if name.endswith(".md"):
            for found in HEADING.finditer(piece):
                out.add((1 + piece.count("\n", 0, found.start()), found.group(), "a heading names the thing"))
    if name.endswith(".md"):
        for k, row in enumerate(text.split("\n"), 1):
            if row.startswith("|") and max(map(len, row.split("|"))) > LONGEST_CELL:
                out.add((k, row[:40], f"cells of at most {LONGEST_CELL} characters"))
    if name == "README.md" and text.count("\n") > LINES_OF_README:
        out.add((LINES_OF_README + 1, "README.md", f"at most {LINES_OF_README} lines"))
    return sorted(out.union(openings(name, text)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("root", nargs="?", type=Path, default=Path(__file__).resolve().parents[2])
    parser.add_argument("--only", nargs="+", default=[""], help="files with these words in their paths")
    parser.add_argument("--count", action="store_true", help="only a number for each folder")
    arguments = parser.parse_args()
    count = Counter()
    for name in files_of(arguments.root):
        if not any(word in name for word in arguments.only):
            continue
        try:
            text = (arguments.root / name).read_text()
        except UnicodeDecodeError:
            continue  # a picture
        for line, words, better in findings(name, text):
            count["/".join(name.split("/")[:-1][:2]) or name] += 1
            if not arguments.count:
                print(f"{name}:{line}: {words!r}: use {better}")
    if arguments.count:
        for folder, number in sorted(count.items()):
            print(f"{number:5} {folder}")
    if count:
        sys.exit(f"{sum(count.values())} words or phrases to replace")


if __name__ == "__main__":
    main()
