"""The names that the language provides to expressions.

The names are the same as in ros/xacro: a few of Python's functions, all of ``math``, and the groups ``math``,
``python`` and ``xacro``. Functions that could create very large values, or access objects that expressions must not
access, are guarded.
"""

from __future__ import annotations

import builtins
import math
import re
from collections.abc import Callable

from linkwright.diagnostics import Severity, foreign, phrase
from linkwright.loading.lean_typing import Any, Protocol
from linkwright.xacro.expressions import bounded, sandbox
from linkwright.xacro.expressions.bounded import RefusalError
from linkwright.xacro.expressions.sandbox import CALLABLE_TYPES, MAX_BITS, MAX_LENGTH, Module
from linkwright.xacro.faults import Fault

BARE_NAMES = ("list", "dict", "map", "len", "str", "float", "int", "bool", "min", "max", "round")
"""The functions of Python that expressions may call by their bare names."""
_PYTHON_GROUP_NAMES = (
    *BARE_NAMES,
    *("abs", "all", "any", "complex", "divmod", "enumerate", "filter", "frozenset", "hash", "isinstance"),
    *("issubclass", "ord", "range", "repr", "reversed", "set", "slice", "sorted", "sum", "tuple", "type"),
    *("vars", "zip"),
)
_MAX_FACTORIAL = 2_000
_MAX_LISTS = 1_000


def _range(*arguments: Any) -> range:
    result = range(*arguments)
    try:
        too_long = len(result) > MAX_LENGTH
    except OverflowError:
        too_long = True
    if too_long:
        raise RefusalError(phrase("the range has more than {max_length:,} items", max_length=MAX_LENGTH))
    return result


def _round(number: Any, digits: int | None = None) -> Any:
    if isinstance(number, int) and digits is not None and abs(digits) > MAX_BITS:
        raise RefusalError(phrase("it rounds to too many digits"))
    return round(number, digits)


def _sum(items: Any, start: Any = 0) -> Any:
    summands = list(items)
    if isinstance(start, (int, float, complex)):
        return sum(summands, start)
    if len(summands) > _MAX_LISTS:
        raise RefusalError(phrase("it adds more than {most_lists:,} lists", most_lists=_MAX_LISTS))
    total = start
    for summand in summands:
        total = sandbox.add(total, summand)
    return total


def _type(value: Any) -> type:
    kind = type(value)
    if kind not in CALLABLE_TYPES:
        raise RefusalError(phrase("the type '{name}' is not available in expressions", name=kind.__name__))
    return kind


def _vars(value: Any) -> dict[str, Any]:
    if value.__class__ is not Module:
        raise RefusalError(phrase("only the names of 'math', 'python' and 'xacro' can be listed"))
    return dict(value.values)


_GUARDED: dict[str, Any] = {"range": _range, "round": _round, "sum": _sum, "type": _type, "vars": _vars}


def _factorial(n: Any) -> int:
    if isinstance(n, int) and n > _MAX_FACTORIAL:
        raise RefusalError(
            phrase(
                "the factorial of a number above {largest_factorial:,} is too large",
                largest_factorial=_MAX_FACTORIAL,
            )
        )
    return math.factorial(n)


def _bounded_combinatorial(name: str) -> Callable[..., int]:
    function = getattr(math, name)

    def guarded(n: Any, *k: Any) -> int:
        if isinstance(n, int) and n > _MAX_FACTORIAL:
            raise RefusalError(
                phrase(
                    "'{name}' receives a number above {largest_factorial:,}",
                    name=name,
                    largest_factorial=_MAX_FACTORIAL,
                )
            )
        result: int = function(n, *k)
        return result

    return guarded


def _prod(items: Any, *, start: Any = 1) -> Any:
    total = start
    for item in items:
        total = sandbox.multiply(total, item)
    return total


def _lcm(*numbers: Any) -> int:
    total = 1
    for number in numbers:
        total = sandbox.check_size(math.lcm(total, number))
    return total


MATHEMATICS: dict[str, Any] = {
    **{name: value for name, value in vars(math).items() if not name.startswith("_")},
    "factorial": _factorial,
    "comb": _bounded_combinatorial("comb"),
    "lcm": _lcm,
    "perm": _bounded_combinatorial("perm"),
    "prod": _prod,
    **bounded.MATHEMATICS,
}
"""Everything public in Python's ``math``."""

_PYTHON_NAMES: dict[str, Any] = {name: _GUARDED.get(name, getattr(builtins, name)) for name in _PYTHON_GROUP_NAMES}


def tokenize(text: str, sep: str = ",; ", skip_empty: bool = True) -> list[str]:
    """Split a text at each of the separator characters, and return the parts."""
    character_class = re.sub(r"(?<!\\)([\[\]])", r"\\\1", sep)
    try:
        parts = bounded.split(f"[{character_class}]", text)
    except re.error as error:
        raise ValueError(phrase("cannot split at '{sep}': {error}", sep=sep, error=error)) from None
    return [part for part in parts if part] if skip_empty else parts


def _fatal(*words: Any) -> None:
    raise Fault(
        "XAC701", foreign(" ".join(map(sandbox.as_text, words))) or phrase("the description stops the expansion here")
    )


class Provider(Protocol):
    """The part of a `Session` that the functions of the group ``xacro`` need."""

    def load_yaml(self, name: str) -> Any:
        """Return the value of a YAML file."""
        ...

    def relative_to_current_file(self, name: str) -> str:
        """Return the path of a file whose name is relative to the file being processed."""
        ...

    def dotify(self, mapping: Any = (), **items: Any) -> Any:
        """Return a mapping whose items are also accessible with a dot."""
        ...

    def argument(self, name: str) -> str:
        """Return the value of an argument."""
        ...

    def reporter(self, name: str, code: str, severity: Severity) -> Callable[..., str]:
        """Return the function that shows messages, such as ``xacro.message`` or ``xacro.error``."""
        ...

    def with_deprecation_warning(self, qualified_name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return a function that warns when it is called by its deprecated bare name."""
        ...


def global_names(session: Provider) -> dict[str, Any]:
    """Return the names in the outermost scope of one expansion, with their values."""
    functions: dict[str, Any] = {
        "load_yaml": session.load_yaml,
        "abs_filename": session.relative_to_current_file,
        "dotify": session.dotify,
    }
    xacro = Module(
        "xacro",
        {
            **functions,
            "arg": session.argument,
            "message": session.reporter("message", "XAC704", Severity.INFO),
            "warning": session.reporter("warning", "XAC703", Severity.WARNING),
            "error": session.reporter("error", "XAC702", Severity.ERROR),
            "print_location": session.reporter("print_location", "XAC705", Severity.INFO),
            "fatal": _fatal,
            "tokenize": tokenize,
        },
    )
    deprecated = {
        name: session.with_deprecation_warning(f"xacro.{name}", function) for name, function in functions.items()
    }
    for name in ("sorted", "range"):
        deprecated[name] = session.with_deprecation_warning(f"python.{name}", _PYTHON_NAMES[name])
    return {
        **{name: _PYTHON_NAMES[name] for name in BARE_NAMES},
        "True": True,
        "False": False,
        **MATHEMATICS,
        **deprecated,
        "math": Module("math", MATHEMATICS),
        "python": Module("python", _PYTHON_NAMES),
        "xacro": xacro,
    }
