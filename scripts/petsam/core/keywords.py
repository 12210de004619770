"""Keywords that several functions have: fields of a dataclass, whose docstring explains them once.

    @dataclass(frozen=True)
    class Ends:
        \"\"\"...

        Parameters
        ----------
        first : int
            The first step.
        \"\"\"

        first: int = 1

    @unfolded
    def steps(file, *, ends: Ends): ...

Users call steps(file, first=2), and the function gets Ends(first=2). Its signature and its docstring, as help()
shows them, have the fields instead of `ends`. scripts/maintain/modules.py does the same with the sources.
"""

import dataclasses
import functools
import inspect
import re
import sys
from collections.abc import Callable, Iterable
from typing import Any, Optional, TypeVar

Result = TypeVar("Result")
Function = TypeVar("Function", bound=Callable[..., object])
ORDER = ("Parameters", "Returns", "Raises")  # of the sections of a docstring; others follow


def sections(text: Optional[str]) -> tuple[str, dict[str, str]]:
    """Returns the part of a docstring above its sections, and {title: text} of these."""
    head, *parts = re.split(r"^(\w+)\n-{3,}\n", inspect.cleandoc(text or ""), flags=re.M)
    return head.strip(), {title: part.strip("\n") for title, part in zip(parts[::2], parts[1::2])}


def entries(text: str) -> dict[str, str]:
    """Returns {name: entry} of the text of Parameters; names that have one entry together have it each."""
    found = {}
    for entry in re.split(r"\n(?=\S)", text):
        names = entry.partition("\n")[0].partition(" : ")[0]
        found.update({name.lstrip("*"): entry for name in names.split(", ")})
    return found


def completed(text: Optional[str], names: Iterable[str], others: Iterable[Optional[str]]) -> str:
    """Returns a docstring with what it lacks from others: the parameters of these names, and sections."""
    found: dict[str, str] = {}
    known: dict[str, str] = {}
    for other in (text, *others):
        parts = sections(other)[1]
        known = {**entries(parts.get("Parameters", "")), **known}
        found = {**parts, **found}
    found["Parameters"] = "\n".join(dict.fromkeys(known[name] for name in names if name in known))
    titles = [*(title for title in ORDER if found.get(title)), *(title for title in found if title not in ORDER)]
    return "\n\n".join([sections(text)[0], *(f"{title}\n{'-' * len(title)}\n{found[title]}" for title in titles)])


def unfolded(function: Callable[..., Result], common: str = "") -> Callable[..., Result]:
    """Makes a function with the fields of dataclasses as keywords of one that takes the dataclasses: users do not see
    keywords without a default whose hint is a dataclass. `common`: docstring of several functions, which supplies what
    the function's own lacks: parameters and errors. A function without such keywords gets its docstring only."""
    own, home = inspect.signature(function), vars(sys.modules[function.__module__])
    shown: list[inspect.Parameter] = []
    kinds: dict[str, Any] = {}
    for one in own.parameters.values():
        kind = home.get(one.annotation) if isinstance(one.annotation, str) else one.annotation
        if one.kind is one.KEYWORD_ONLY and one.default is one.empty and dataclasses.is_dataclass(kind):
            kinds[one.name] = kind
            shown += [one.replace(name=n.name, default=n.default, annotation=n.type) for n in dataclasses.fields(kind)]
        else:
            shown.append(one)

    if not kinds:
        function.__doc__ = completed(function.__doc__, own.parameters, [common])
        return function
    hidden = kinds.keys() - {one.name for one in shown}

    @functools.wraps(function)
    def public(*args: Any, **given: Any) -> Result:
        for name in given.keys() & hidden:
            raise TypeError(f"{function.__name__}() got an unexpected keyword argument {name!r}")
        made = {
            name: kind(**{n.name: given.pop(n.name) for n in dataclasses.fields(kind) if n.name in given})
            for name, kind in kinds.items()
        }
        return function(*args, **given, **made)

    shown.sort(key=lambda one: one.kind)  # **more is last
    docs = [base.__doc__ for kind in kinds.values() for base in kind.__mro__[:-1]]
    public.__dict__["__signature__"] = own.replace(parameters=shown)  # read by inspect.signature()
    public.__doc__ = completed(function.__doc__, [one.name for one in shown], [*docs, common])
    return public
