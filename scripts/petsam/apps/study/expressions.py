"""Expressions in braces that a study's table may hold: arithmetic of numbers and names; those of results have none.

All numbers are doubles, so that no expression takes long, and lengths and depths are bounded.
"""

import ast
import functools
import math
import operator
import re
import warnings

from ...core.errors import short
from ...core.shown import applications

FUNCTIONS = {name: getattr(math, name) for name in ("sqrt", "sin", "cos", "tan", "exp", "log", "pi")}
FUNCTIONS.update(abs=abs, min=min, max=max)


def _later(record, module, name):
    """A function of an application, whose module is imported when it is called."""
    return lambda *values: getattr(record.module(module), name)(*values)


for _one in applications():
    FUNCTIONS.update({name: _later(_one, module, name) for module, names in _one.expressions.items() for name in names})
OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: math.pow,  # of doubles; Python's own gives complex numbers, and integers of any length
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}
LENGTH = 1000  # characters of an expression at most
DEPTH = 30  # names that refer to names that refer to ...
TEXT = 4 << 20  # characters of an expanded text at most


class ExpressionError(ValueError):
    """An expression without a value; the message begins with it."""


def _number(node, lookup):
    """Value of an arithmetic expression's syntax tree."""
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return float(node.value)
    if isinstance(node, ast.Name):
        return FUNCTIONS[node.id] if node.id == "pi" else lookup(node.id)
    if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
        return OPERATORS[type(node.op)](_number(node.left, lookup), _number(node.right, lookup))
    if isinstance(node, ast.UnaryOp) and type(node.op) in OPERATORS:
        return OPERATORS[type(node.op)](_number(node.operand, lookup))
    if (
        isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id in FUNCTIONS
        and not node.keywords
    ):
        return FUNCTIONS[node.func.id](*[_number(argument, lookup) for argument in node.args])
    raise ValueError("use only numbers, names, + - * / **, and {}".format(", ".join(sorted(FUNCTIONS))))


@functools.lru_cache(maxsize=10000)
def _tree(expression):
    """Syntax tree of an expression; the same ones come again in every case."""
    if len(expression) > LENGTH:
        raise ValueError(f"use at most {LENGTH} characters")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ast.parse(expression, mode="eval").body


def check(expression):
    """ValueError where an expression is none, whatever its names stand for."""
    try:
        _number(_tree(expression), lambda name: 1.0)
    except SyntaxError as error:
        raise ValueError(error.msg) from error
    except (RecursionError, MemoryError) as error:
        raise ValueError("is nested too deeply") from error
    except (ArithmeticError, TypeError) as error:
        if isinstance(error, TypeError):
            raise ValueError(str(error)) from error
    except ValueError as error:
        if "use " in str(error):  # not a function's domain, which depends on the values
            raise


def names_in(texts):
    """Set of the names in the {expressions} of some texts; None has none."""
    expressions = [expression for text in texts for expression in re.findall(r"\{([^{}]*)\}", text or "")]
    return {name for expression in expressions for name in re.findall(r"[A-Za-z_]\w*", expression)}


class Expander:
    """Replaces {expressions} by values of names, which may hold expressions themselves."""

    def __init__(self, values):
        self.values, self.open, self.known = values, [], {}

    def text(self, name):
        """Value of a name, expanded (once: names that refer to others twice would take for ever)."""
        if name not in self.values:
            raise ValueError(f"unknown parameter or option {short(name)}")
        if name in self.open:
            raise ValueError(f"{name} refers to itself")
        if name not in self.known:
            if len(self.open) >= DEPTH:
                raise ValueError(f"{name}: more than {DEPTH} names refer to one another")
            self.open.append(name)
            try:
                self.known[name] = self.expand(self.values[name])
            finally:
                self.open.pop()
        return self.known[name]

    def _lookup(self, name):
        text = self.text(name)
        try:
            return float(text)
        except (TypeError, ValueError):
            raise ValueError(f"{name} = {short(text)} is not a number") from None

    def _value(self, expression):
        """Text of an expression's value; None for an option without a value."""
        if expression in self.values:
            return self.text(expression)
        try:
            value = _number(_tree(expression), self._lookup)
        except (RecursionError, MemoryError) as error:
            raise ValueError("is nested too deeply") from error
        except (SyntaxError, ArithmeticError, TypeError) as error:
            raise ValueError(getattr(error, "msg", None) or str(error)) from error
        if not isinstance(value, float) or not math.isfinite(value):
            raise ValueError(f"is {value:g}, which is not finite" if isinstance(value, float) else "is not a number")
        return f"{value:.15g}"

    def expand(self, text):
        """The text with its expressions replaced; None stays."""
        if text is None:
            return None
        parts, length = re.split(r"\{([^{}]*)\}", text), 0
        for k, part in enumerate(parts):
            if k % 2:
                try:
                    parts[k] = self._value(part.strip()) or ""
                except ExpressionError:
                    raise
                except ValueError as error:
                    raise ExpressionError(f"{{{short(part.strip())}}}: {error}") from error
            length += len(parts[k])
            if length > TEXT:
                raise ExpressionError(f"{short(text)}: use at most {TEXT} characters after expansion")
        return "".join(parts)
