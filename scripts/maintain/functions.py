#!/usr/bin/env python3
"""Reads the comments of the C library's functions in include/petsam/*.h, and writes them as a page of Markdown.

    python3 scripts/maintain/functions.py [--out build/functions.md] [--check] [header ...]

Each function has a comment of a fixed form directly above its prototype:

    /*
      SamGridNorm - computes a norm of a field.

      Collective.

      In:     grid  - the grid
              field - field of one or two components (any unit)
      Out:    norm  - the norm (unit of the field)

      Options: -name (only of functions that read options)
      Errors: PETSC_ERR_SUP for another type of norm.

      Further paragraphs.

      See also: SamGridCreateVec(), SamGrid. (the next ones that its reader needs, on one line; optional)
    */

--check writes nothing, and fails with a line for each function without such a comment, for each argument, unit, or
paragraph that is missing, and for each name after "See also:" that no public header declares. Functions are those of
PETSC_EXTERN, of petsam/embed.h, and inline ones but for casts.
"""

import argparse
import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COMMENT = re.compile(r"/\*.*?\*/", re.S)
PROTOTYPE = re.compile(
    r"^(?:(?P<inline>static inline )|PETSC_EXTERN )?(?P<type>(?!typedef|PETSC_|static|return)\w[^;(){}#=]*?)"
    r"\b(?P<name>(?:Sam|petsam_)\w+)\((?P<arguments>[^;{}]*)\)(?:;|\n\{(?P<body>.*?)^\})",
    re.M | re.S,
)
CAST = re.compile(r"\s*return \(\w+\)\w+;\s*")
ENTRY = re.compile(r"  (?P<way>In:    |Out:   |In,out:|       ) (?P<name>\w+) +- (?P<words>.*)")
NUMBER = re.compile(r"\b(?:PetscReal|PetscScalar|double|float|Vec)\b")
ATOM = r"(?:1|Pa|N|m|s|J|rad|bytes?|cells|cycles)\d?"
CODE = re.compile(r"(`[^`]+`|(?<![\w-])-[a-z<][\w<>]{2,}|\b(?:Sam|SAM_|PETSC_|petsam_)\w+(?:\(\))?)")
WIDTH = 100  # columns of a prototype on the page
UNIT = re.compile(rf"\((?:{ATOM}(?:[ /]{ATOM})*(?:, [^()]*)?|(?:any |SI )?units?\b[^()]*)\)")


@dataclass
class Function:
    file: Path
    line: int
    name: str
    type: str  # type of the returned value
    arguments: dict  # name to declaration
    comment: str  # comment directly above; empty: there is none


@dataclass
class Block:
    """The comment of a function in its parts."""

    summary: str = ""
    collective: str = ""
    entries: list = field(default_factory=list)  # (In, Out or In,out; name; text)
    nothing: bool = False  # true for "In: nothing."
    options: str = ""
    errors: str = ""
    further: list = field(default_factory=list)  # further paragraphs, unchanged


def split_arguments(text):
    """The arguments of a prototype: their names and declarations."""
    found, depth, start = {}, 0, 0
    for k, letter in enumerate(text + ","):
        depth += letter in "([{"
        depth -= letter in ")]}"
        if letter == "," and not depth:
            declaration, start = " ".join(text[start:k].split()), k + 1
            pointer = re.search(r"\(\*(\w+)\)", declaration)
            name = pointer[1] if pointer else (re.findall(r"\w+", re.sub(r"\[.*?\]", "", declaration)) or [""])[-1]
            if name not in ("", "void"):
                found[name] = declaration
    return found


def read_functions(path):
    """The functions of a header, and its first comment."""
    text = path.read_text(encoding="utf-8")
    bare = COMMENT.sub(lambda comment: re.sub(r"[^\n]", " ", comment.group()), text)
    ends = {text.count("\n", 0, comment.end()): comment.group() for comment in COMMENT.finditer(text)}
    functions = []
    for found in PROTOTYPE.finditer(bare):
        is_public = text.startswith("PETSC_EXTERN", found.start()) or found["name"].startswith("petsam_")
        if not is_public and (not found["inline"] or CAST.fullmatch(found["body"] or "")):
            continue
        line = text.count("\n", 0, found.start())
        above = text.split("\n")[line - 1]
        comment = ends.get(line - 1, "") if above.rstrip().endswith("*/") else ""
        returned, arguments = re.sub(r"\s+", " ", found["type"]), split_arguments(found["arguments"])
        functions.append(Function(path, line + 1, found["name"], returned, arguments, comment))
    first = COMMENT.match(text)
    return functions, " ".join(first.group()[2:-2].split("\n\n")[0].split()) if first else ""


def read_entries(paragraph):
    """Returns the arguments in the paragraph of In, Out and In,out: (way, name, text)."""
    entries, way = [], ""
    for line in paragraph.split("\n"):
        found = ENTRY.fullmatch(line)
        if found:
            way = found["way"].strip(" :") or way
            entries.append([way, found["name"], found["words"].strip()])
        elif entries and line.startswith(" " * 11):
            entries[-1][2] += " " + line.strip()
    return [tuple(entry) for entry in entries]


def read_block(comment):
    """Returns a comment in its parts; missing parts are empty."""
    block = Block()
    body = comment[2:-2].strip("\n").rstrip()
    paragraphs = [paragraph for paragraph in re.split(r"\n\s*\n", body) if paragraph.strip()]
    block.summary = " ".join(paragraphs.pop(0).split()) if paragraphs else ""
    for paragraph in paragraphs:
        words = paragraph.strip()
        if re.match(r"(?:In|Out|In,out):", words):
            block.entries, block.nothing = read_entries(paragraph), words == "In: nothing."
        elif re.match(r"(?:Options|Errors):", words):
            for kind, text in re.findall(r"(Options|Errors): (.*?)(?=\s+Errors: |\Z)", words, re.S):
                setattr(block, kind.lower(), " ".join(text.split()))
        elif re.match(r"(?:Collective|Not collective)\b", words) and not block.collective:
            block.collective = " ".join(words.split())
        else:
            block.further.append(paragraph)
    return block


def public_names(paths):
    """The names of all functions and types of headers, in the way that a comment refers to them."""
    bare = "\n".join(COMMENT.sub("", path.read_text(encoding="utf-8")) for path in paths)
    called = {f"{found['name']}()" for found in PROTOTYPE.finditer(bare)}
    types = re.findall(r"(?:^typedef [^;{}]*?[ *(]|\} ?)\*?(\w+)\)?(?:\([^;]*\))?;", bare, re.M)
    return called | {name for name in types if name.startswith(("Sam", "petsam_"))}


def wrong_references(path, known):
    """The faults of the lines "See also:" in a header: (line, sentence)."""
    text = path.read_text(encoding="utf-8")
    for comment in COMMENT.finditer(text):
        own = re.match(r"/\*\n  (\w+) - ", comment.group())
        for found in re.finditer(r"See also:.*", comment.group()):
            line = text.count("\n", 0, comment.start() + found.start()) + 1
            names = re.fullmatch(r"See also: ((?:\w+(?:\(\))?, )*\w+(?:\(\))?)\.", found.group())
            if not own or not names or comment.group()[found.end() :] != "\n*/":
                yield line, "'See also: NAME, NAME().' is no last line of the comment of a function or type"
                continue
            listed = names[1].split(", ")
            for name in listed:
                if name not in known or name.rstrip("()") == own[1] or listed.count(name) > 1:
                    yield line, f"{own[1]} refers to {name}: expected another public name, once"
            if len(listed) > 4:
                yield line, f"{own[1]} refers to {len(listed)} names: expected 4 at most"


def missing_arguments(function, block):
    listed = [name for _, name, _ in block.entries]
    for name in function.arguments:
        if listed.count(name) != 1:
            yield f"argument {name} is listed {listed.count(name)} times under In, Out and In,out: list it once"
    for name in (name for name in listed if name not in function.arguments):
        yield f"argument {name} is listed, but does not exist"
    if not function.arguments and not block.nothing:
        yield "has no paragraph 'In: nothing.'"
    for _, name, text in block.entries:
        if NUMBER.search(function.arguments.get(name, "")) and not UNIT.search(text):
            yield f"argument {name} has no unit in parentheses"


def missing(function):
    """Returns the gaps in a function's comment, as sentences for messages."""
    if not function.comment.startswith(f"/*\n  {function.name} - "):
        yield f"has no comment above it that begins with '{function.name} - '"
        return
    block = read_block(function.comment)
    yield from missing_arguments(function, block)
    if NUMBER.search(function.type) and not UNIT.search(block.summary):
        yield "has in its first sentence no unit of the returned value in parentheses"
    if not block.collective:
        yield "has no paragraph 'Collective' or 'Not collective'"
    if not block.errors:
        yield "has no line 'Errors:'"


def escape(text):
    """Returns text for Markdown: names of options and functions as code, and other signs escaped."""
    pieces = CODE.split(text)
    plain = [re.sub(r"([\\`*_<>\[\]|#])", r"\\\1", piece) if k % 2 == 0 else piece for k, piece in enumerate(pieces)]
    return "".join(piece if k % 2 == 0 else f"`{piece.strip('`')}`" for k, piece in enumerate(plain))


def paragraph_of(text):
    """Returns a further paragraph for Markdown: a table or a formula unchanged."""
    lines = [line[2:] if line.startswith("  ") else line for line in text.split("\n")]
    if any(line.startswith(" ") for line in lines):
        return "\n".join(["```text", *lines, "```"])
    return escape(" ".join(" ".join(lines).split()))


def prototype_of(function):
    """Returns the prototype in one line, or with a line for each argument."""
    arguments = list(function.arguments.values()) or ["void"]
    line = f"{function.type}{function.name}({', '.join(arguments)});"
    if len(line) <= WIDTH:
        return [line]
    last = len(arguments) - 1
    rest = [f"  {argument}{',' if k < last else ');'}" for k, argument in enumerate(arguments)]
    return [f"{function.type}{function.name}(", *rest]


def page_of_function(function):
    block = read_block(function.comment)
    name, _, summary = block.summary.partition(" - ")
    lines = [f"### {name}", "", "```c", *prototype_of(function), "```", ""]
    lines += [f"{escape(summary[:1].upper() + summary[1:])} {escape(block.collective)}", ""]
    lines += [f"- {way}: `{name}`: {escape(text)}" for way, name, text in block.entries]
    lines += [""] if block.entries else []
    lines += [f"Options: {escape(block.options)}", ""] if block.options else []
    lines += [f"Errors: {escape(block.errors)}", ""]
    for text in block.further:
        lines += [paragraph_of(text), ""]
    return lines


def headers():
    return sorted((ROOT / "include" / "petsam").glob("*.h"))


def page():
    """Returns the page of all functions, header by header."""
    lines = ["# Functions of the C library", "", "Each header is included by `petsam.h`, except `petsam/embed.h`.", ""]
    for path in headers():
        functions, first = read_functions(path)
        if functions:
            lines += [f"## petsam/{path.name}", "", escape(first), ""]
            lines += [line for function in functions for line in page_of_function(function)]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("headers", nargs="*", type=Path, help="headers to check; default: all public ones")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "functions.md", help="file of the page")
    parser.add_argument("--check", action="store_true", help="write nothing; fail when a comment lacks something")
    arguments = parser.parse_args()
    gaps, known = 0, public_names({*headers(), *arguments.headers})
    for path in arguments.headers or headers():
        for line, fault in wrong_references(path, known):
            print(f"{path}:{line}: {fault}")
            gaps += 1
        for function in read_functions(path)[0]:
            for gap in missing(function):
                print(f"{path}:{function.line}: {function.name} {gap}")
                gaps += 1
    if gaps:
        sys.exit(f"functions.py: error: {gaps} gaps in the comments of functions")
    if not arguments.check:
        arguments.out.parent.mkdir(parents=True, exist_ok=True)
        arguments.out.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
