"""Expressions in braces that a study's table may hold: arithmetic of numbers and names."""

import ast
import math
import operator
import re

FUNCTIONS = {name: getattr(math, name) for name in ("sqrt", "sin", "cos", "tan", "exp", "log", "pi")}
FUNCTIONS.update(abs=abs, min=min, max=max)
OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}


def _number(node, lookup):
    """Value of an arithmetic expression's syntax tree."""
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        return node.value
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
    raise ValueError("only numbers, names, + - * / **, and {} are understood".format(", ".join(sorted(FUNCTIONS))))


class Expander:
    """Replaces {expressions} by values of names, which may hold expressions themselves."""

    def __init__(self, values):
        self.values, self.open = values, []

    def text(self, name):
        """Value of a name, expanded."""
        if name not in self.values:
            raise ValueError(f"there is no parameter or option {name}")
        if name in self.open:
            raise ValueError(f"{name} refers to itself")
        self.open.append(name)
        try:
            return self.expand(self.values[name])
        finally:
            self.open.pop()

    def _lookup(self, name):
        text = self.text(name)
        try:
            return float(text)
        except (TypeError, ValueError):
            raise ValueError(f"{name} = {text} is no number") from None

    def _value(self, match):
        expression = match.group(1).strip()
        if expression in self.values:
            return self.text(expression)
        try:
            value = _number(ast.parse(expression, mode="eval").body, self._lookup)
        except (SyntaxError, ArithmeticError, TypeError) as error:
            raise ValueError(getattr(error, "msg", None) or str(error)) from error
        return f"{value:.15g}"

    def expand(self, text):
        """The text with its expressions replaced; None stays."""
        try:
            return None if text is None else re.sub(r"\{([^{}]*)\}", self._value, text)
        except ValueError as error:
            raise ValueError(
                f"{text.strip().splitlines()[0]}: {error}" if "{" not in str(error) else str(error)
            ) from error
