#!/usr/bin/env python3
"""Compares a program's answers with the intervals of cases.json: digits won and lost, and what is wrong.

    python3 check.py answers.json [--cases cases.json] [--tolerance 5e-3] [--case NAME ...]

answers.json is a JSON object:

    {"program": "name and version",
     "answers": {"hertz-sphere": {"approach": 1.2e-6, "contact_radius": [1.1e-4, 2e-9]}},
     "seconds": {"hertz-sphere": 0.4}}

An answer is a number, or a number and the error that the program states for it; null, or none at all, where the program
has no answer. "seconds" may be left out. An answer is wrong when it lies outside of its interval by more than its own
stated error or, if it states none, by more than the tolerance, a part of the quantity's size.

Exit code: 0 if no answer is wrong, 1 if one is, 2 if a file cannot be used. Needs Python 3.8 and numpy only. CC0.
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np

MOST = 12.0  # digits: no answer in double precision has more
FACTORS = ((-1, "its sign is opposite"), (2, "it is twice as large"), (0.5, "it is half as large"))
FACTORS += ((1e3, "it is 1000 times as large"), (1e-3, "it is a thousandth"), (1e6, "it is 1e6 times as large"))
FACTORS += ((np.pi, "it is pi times as large"), (1 / np.pi, "it is a pi-th"), (180 / np.pi, "it is in degrees"))


class Mistake(Exception):
    """A file that cannot be used."""


def read(path):
    """The JSON object in a file; names that stand twice are a mistake."""

    def unique(pairs):
        names = [name for name, _ in pairs]
        twice = {name for name in names if names.count(name) > 1}
        if twice:
            raise Mistake(f"{path}: the name {min(twice)!r} stands twice in one object")
        return dict(pairs)

    try:
        found = json.loads(Path(path).read_text(encoding="utf-8"), object_pairs_hook=unique)
    except OSError as error:
        raise Mistake(f"{path}: {error.strerror}") from None
    except (UnicodeDecodeError, json.JSONDecodeError) as error:
        raise Mistake(f"{path}: this is no JSON: {error}") from None
    except RecursionError:
        raise Mistake(f"{path}: its objects are nested too deeply") from None
    return found


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def read_answer(value, place):
    """An answer and its stated error, None without one; None if there is no answer."""
    if value is None:
        return None
    parts = value if isinstance(value, list) else [value]
    if not 1 <= len(parts) <= 2 or not all(is_number(part) for part in parts):
        raise Mistake(f"{place}: expected a number, or [number, error], not {json.dumps(value)[:60]}")
    if len(parts) == 2 and not parts[1] >= 0:
        raise Mistake(f"{place}: the stated error is {parts[1]}; it is a number of at least 0")
    return float(parts[0]), float(parts[1]) if len(parts) == 2 else None


def read_cases(path):
    """Of each case the rows of its quantities, in the order of the file."""
    cases = {}
    for row in read(path):
        cases.setdefault(row["case"], {})[row["quantity"]] = row
    return cases


def read_answers(path, cases):
    """Program, answers by case and quantity, seconds by case."""
    given = read(path)
    if not isinstance(given, dict) or not isinstance(given.get("answers"), dict):
        raise Mistake(f'{path}: expected an object with "answers", an object of cases')
    found = {}
    for case, quantities in given["answers"].items():
        if case not in cases:
            raise Mistake(f"{path}: there is no case {case!r}; the cases are {', '.join(cases)}")
        if not isinstance(quantities, dict):
            raise Mistake(f"{path}: {case}: expected an object of quantities")
        for quantity, value in quantities.items():
            if quantity not in cases[case]:
                raise Mistake(f"{path}: {case} does not require {quantity!r}; it requires {', '.join(cases[case])}")
            answer = read_answer(value, f"{path}: {case}: {quantity}")
            if answer:
                found.setdefault(case, {})[quantity] = answer
    seconds = given.get("seconds", {})
    if not isinstance(seconds, dict) or not all(is_number(value) for value in seconds.values()):
        raise Mistake(f'{path}: "seconds" is an object of numbers, one for each case')
    return str(given.get("program", path)), found, seconds


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
        if outside(row, value / factor) <= tolerance * size(row) / 10:
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
    stated = "" if error is None else f"; its stated error is {error:.3g}"
    return held, won, reason(row, value, tolerance) + stated


def print_case(case, rows, answers, seconds, tolerance):
    """A line for a case and for each of its quantities; the number of wrong answers."""
    judged = {quantity: judge(rows[quantity], answers[quantity], tolerance) for quantity in rows if quantity in answers}
    won = [of for _, of, _ in judged.values()]
    spent = f", {seconds:.3g} s" if seconds is not None else ""
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
    parser.add_argument("--case", action="append", help="only this case; may be given more than once")
    args = parser.parse_args()
    try:
        if not 0 <= args.tolerance < 1:
            raise Mistake(f"--tolerance {args.tolerance:g}: expected a number from 0 to below 1")
        cases = read_cases(args.cases)
        program, answers, seconds = read_answers(args.answers, cases)
        unknown = [name for name in args.case or () if name not in cases]
        if unknown:
            raise Mistake(f"--case {unknown[0]}: there is no such case; the cases are {', '.join(cases)}")
    except Mistake as mistake:
        print(f"check.py: {mistake}", file=sys.stderr)
        return 2
    chosen = [case for case in cases if case in answers and (not args.case or case in args.case)]
    print(f"{program}\ncase and quantity, answer, digits won and lost, interval\n")
    wrong = sum(print_case(c, cases[c], answers[c], seconds.get(c), args.tolerance) for c in chosen)
    asked, given = sum(len(rows) for rows in cases.values()), sum(len(answers[case]) for case in chosen)
    print(f"\n{given} answers of {asked} quantities in {len(chosen)} of {len(cases)} cases, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
