#!/usr/bin/env python3
"""Compares a program's answers with the intervals of cases.json: digits won and lost, and what is wrong.

    python3 check.py answers.json [--cases cases.json] [--tolerance 5e-3]

answers.json is a JSON object:

    {"program": "name and version",
     "answers": {"hertz-sphere": {"approach": 1.2e-6, "contact_radius": [1.1e-4, 2e-9]}},
     "seconds": {"hertz-sphere": 0.4}}

An answer is a number, or a number and the error that the program states for it. "seconds" may be left out. An answer is
wrong when it lies outside of its interval by more than its stated error or, without one, by more than the tolerance.

Exit code: 0 if no answer is wrong, 1 if one is, 2 if a file cannot be used. Needs Python 3.8 and numpy only. CC0.
"""

import argparse
import json
import os
import sys
from pathlib import Path

import numpy as np

MOST = 12.0  # digits: no answer in double precision has more
FACTORS = ((-1, "its sign is opposite"), (2, "it is twice as large"), (0.5, "it is half as large"))
FACTORS += tuple((10.0**k, f"it is 1e{k:+d} times as large: check the unit") for k in (-9, -6, -3, 3, 6, 9))
FACTORS += ((180 / np.pi, "it is in degrees"), (np.pi / 180, "it is in radians"))


class Mistake(Exception):
    """A file that cannot be used."""


def read(path):
    """The JSON object in a file; names that stand twice are a mistake."""

    def unique(pairs):
        found = {}
        for name, value in pairs:
            if name in found:
                raise Mistake(f"{path}: the name {shown(name)} stands twice in one object")
            found[name] = value
        return found

    try:
        found = json.loads(Path(path).read_text(encoding="utf-8"), object_pairs_hook=unique)
    except OSError as error:
        raise Mistake(f"{path}: {error.strerror}") from None
    except (ValueError, RecursionError) as error:  # no UTF-8, no JSON, a number of thousands of digits
        raise Mistake(f"{path}: this is no JSON: {error}") from None
    return found


def shown(text):
    """A text of a file as a message has it: short, without control characters."""
    text = ascii(str(text))
    return text if len(text) <= 60 else text[:57] + "..."


def is_number(value):
    return isinstance(value, float) or (type(value) is int and abs(value) < 1e300)


def read_answer(value, place):
    """An answer and its stated error, None without one; None if there is no answer."""
    if value is None:
        return None
    parts = value if isinstance(value, list) else [value]
    if not 1 <= len(parts) <= 2 or not all(is_number(part) for part in parts):
        raise Mistake(f"{place}: expected a number, or [number, error], not {shown(json.dumps(value))}")
    if len(parts) == 2 and not parts[1] >= 0:
        raise Mistake(f"{place}: the stated error is {parts[1]}; it is a number of at least 0")
    return float(parts[0]), float(parts[1]) if len(parts) == 2 else None


def read_cases(path):
    """Of each case the rows of its quantities, in the order of the file."""
    cases = {}
    try:
        for row in read(path):
            cases.setdefault(row["case"], {})[row["quantity"]] = row
            if not (row["unit"] + row["how"]).isprintable() or not row["low"] <= row["high"] or not size(row) > 0:
                raise ValueError
        next(iter(cases))  # there is one at least
        return cases
    except (TypeError, KeyError, ValueError, AttributeError, StopIteration):
        raise Mistake(f"{path}: expected a list of objects with case, quantity, unit, low, high, how") from None


def read_answers(path, cases):
    """Program, answers by case and quantity, seconds by case."""
    given = read(path)
    if not isinstance(given, dict) or not isinstance(given.get("answers"), dict):
        raise Mistake(f'{path}: expected an object with "answers", an object of cases')
    found = {}
    for case, quantities in given["answers"].items():
        if case not in cases:
            raise Mistake(f"{path}: there is no case {shown(case)}; the cases are {', '.join(cases)}")
        if not isinstance(quantities, dict):
            raise Mistake(f"{path}: {case}: expected an object of quantities")
        for quantity, value in quantities.items():
            if quantity not in cases[case]:
                raise Mistake(
                    f"{path}: {case} does not require {shown(quantity)}; it requires {', '.join(cases[case])}"
                )
            answer = read_answer(value, f"{path}: {case}: {quantity}")
            if answer:
                found.setdefault(case, {})[quantity] = answer
    seconds = given.get("seconds", {})
    if not isinstance(seconds, dict) or not all(is_number(value) and value >= 0 for value in seconds.values()):
        raise Mistake(f'{path}: "seconds" is an object of numbers of at least 0, one for each case')
    if not found:
        raise Mistake(f"{path}: has no answer")
    return shown(given.get("program", path)), found, seconds


def outside(row, value):
    """Distance of a value from the interval of a row."""
    return max(row["low"] - value, value - row["high"], 0.0) if np.isfinite(value) else np.inf


def size(row):
    """What errors are relative to: the larger end of the interval, or the size that the row states (values near 0)."""
    return row.get("size") or max(abs(row["low"]), abs(row["high"]))


def digits(distance, scale):
    """Digits of a number that is wrong by a distance."""
    return MOST if distance <= scale * 10**-MOST else float(np.clip(-np.log10(distance / scale), 0.0, MOST))


def reason(row, value, tolerance):
    """What may be wrong with an answer: a factor that would bring it into its interval."""
    if not np.isfinite(value):
        return "it is no finite number"
    for factor, text in FACTORS:
        if outside(row, value / factor) <= max(tolerance, 1e-3) * size(row):
            return text
    return f"it differs by {outside(row, value) / size(row):.1%}"


def judge(row, answer, tolerance):
    """Digits of the interval, digits of the answer, and why it is wrong, empty if it is not."""
    value, error = answer
    held = digits((row["high"] - row["low"]) / 2, size(row))
    distance = outside(row, value)
    won = held if distance == 0 else min(held, digits(distance, size(row)))
    if distance <= (tolerance * size(row) if error is None else error):
        return held, won, ""
    return held, won, reason(row, value, tolerance) + ("" if error is None else f"; its stated error is {error:.3g}")


def print_case(case, rows, answers, seconds, tolerance):
    """A line for a case and for each of its quantities; the number of wrong answers."""
    judged = {quantity: judge(rows[quantity], answers[quantity], tolerance) for quantity in rows if quantity in answers}
    won = [of for _, of, _ in judged.values()]
    spent = "" if seconds is None else f", {seconds:.3g} s"
    print(f"{case}: {min(won):.1f} to {max(won):.1f} digits in {len(won)} of {len(rows)} quantities{spent}")
    for quantity, row in rows.items():
        interval = f"{row['low']:.10g} .. {row['high']:.10g} {row['unit']}"
        if quantity not in answers:
            print(f"  {quantity:24s} {'no answer':>16s}              {interval}")
            continue
        held, of, why = judged[quantity]
        said = f"  WRONG: {case}: {quantity}: {why}" if why else ""
        print(f"  {quantity:24s} {answers[quantity][0]:16.9g} {of:5.1f} -{held - of:4.1f}  {interval}{said}")
    return sum(bool(why) for _, _, why in judged.values())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("answers")
    parser.add_argument("--cases", default=Path(__file__).with_name("cases.json"), help="the file of intervals")
    parser.add_argument("--tolerance", type=float, default=5e-3, help="of answers without a stated error")
    args = parser.parse_args()
    try:
        if not 0 <= args.tolerance < 1:
            raise Mistake(f"--tolerance {args.tolerance:g}: expected a number from 0 to below 1")
        cases = read_cases(args.cases)
        program, answers, seconds = read_answers(args.answers, cases)
    except Mistake as mistake:
        print(f"check.py: {mistake}", file=sys.stderr)
        return 2
    print(f"{program}\ncase and quantity, answer, digits won and lost, interval\n")
    wrong = sum(print_case(c, cases[c], answers[c], seconds.get(c), args.tolerance) for c in cases if c in answers)
    whole, given = sum(map(len, cases.values())), sum(map(len, answers.values()))
    print(f"\n{given} answers of {whole} quantities in {len(answers)} of {len(cases)} cases, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    try:
        code = main()
        sys.stdout.flush()
    except OSError as problem:  # nobody reads what is printed, or the disk is full
        print(f"check.py: {problem.strerror}", file=sys.stderr)
        os._exit(2)
    sys.exit(code)
