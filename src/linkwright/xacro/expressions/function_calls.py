"""Functions that expressions call: calling them, and the steps that they cost.

A function costs as much as the items that it visits: Python's own run through a long list much faster than an
expression could, but not for free, and an expression may call them as often as it likes.
"""

from __future__ import annotations

from linkwright.loading.lean_typing import Any
from linkwright.xacro.expressions import sandbox
from linkwright.xacro.expressions.bounded import HASHING, check_codec, keys
from linkwright.xacro.expressions.functions import Function
from linkwright.xacro.expressions.yamldata import YamlDict, YamlList, YamlMapping
from linkwright.xacro.limits import Budget

_CALL = 2
_ITEMS_A_STEP = 2
_CHARACTERS_A_STEP = 32
_LONG_ITEMS = (list, tuple, dict, set, frozenset, range, YamlList, YamlDict, YamlMapping)
_SHARES = {**dict.fromkeys(_LONG_ITEMS, _ITEMS_A_STEP), str: _CHARACTERS_A_STEP, bytes: _CHARACTERS_A_STEP}
_QUICK = frozenset(
    {
        *("append", "bool", "get", "isinstance", "items", "keys", "len", "pop", "popitem", "setdefault", "type"),
        *("values",),
    }
)
"""Functions that take no longer for a long value than for a short one."""


def cost(value: Any) -> int:
    """The steps that one pass over a value costs; the contents of its items do not count."""
    share = _SHARES.get(value.__class__)
    return len(value) // share if share else 0


def call(budget: Budget, function: Any, arguments: list[Any], keywords: dict[str, Any]) -> Any:
    """The value that a function gives for some arguments.

    Raises:
        RefusalError: the function may not be called, or its value is too large.
        Fault: XAC603 when there were too many steps.
    """
    sandbox.check_call(function)
    steps = _CALL
    name = getattr(function, "__name__", None)
    if name in HASHING:
        arguments = [keys(argument) for argument in arguments]
    elif function is str and (len(arguments) > 1 or keywords):
        value = arguments[0] if arguments else keywords.get("object")
        check_codec(value, arguments[1] if len(arguments) > 1 else keywords.get("encoding", "utf-8"))
    if name not in _QUICK:
        for argument in arguments:
            steps += cost(argument)
        owner = getattr(function, "__self__", None)
        if owner is not None:
            steps += cost(owner)
    budget.step(steps)
    if (function is map or function is filter) and arguments:
        arguments = [_metered(budget, arguments[0]), *arguments[1:]]
    if "key" in keywords:
        keywords = {**keywords, "key": _metered(budget, keywords["key"])}
    return charged(budget, function(*arguments, **keywords))


def charged(budget: Budget, value: Any) -> Any:
    """Charge the budget for a new value with all its items, and give it back.

    Raises:
        RefusalError: it is too large.
        Fault: XAC603 when there were too many steps.
    """
    weight = sandbox.weight(value)
    if weight:
        budget.step(weight // (_CHARACTERS_A_STEP if isinstance(value, (str, bytes)) else _ITEMS_A_STEP))
    return value


def _metered(budget: Budget, function: Any) -> Any:
    """A function that charges the budget when Python's own functions call it; lambdas of expressions do so anyway."""
    if not callable(function) or isinstance(function, Function):
        return function

    def metered(*arguments: Any) -> Any:
        return call(budget, function, list(arguments), {})

    return metered
