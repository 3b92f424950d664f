"""Functions in expressions: lambdas, calls, and the number of steps that a call costs.

A function costs steps in proportion to the number of items that it visits. Python's own functions process a long list
much faster than an expression could, but not for free, and an expression may call them any number of times.
"""

from __future__ import annotations

import _ast as ast  # _ast only has the node classes, whereas the import of ast is slow
from collections.abc import Callable

from linkwright.diagnostics import phrase
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_typing import Any
from linkwright.xacro.expressions import sandbox
from linkwright.xacro.expressions.bounded import HASHING, check_codec, checked_keys
from linkwright.xacro.expressions.scope import Environment, Local
from linkwright.xacro.expressions.yamldata import YamlDict, YamlList, YamlMapping
from linkwright.xacro.limits import Budget

_Closure = Callable[[Any], Any]


class Parameters(NamedTuple):
    """The parameters of a lambda, with the values of their defaults.

    Attributes:
        positional: the names of the positional parameters.
        positional_only: the number of names in `positional` that are positional-only.
        keyword_only: the names of the keyword-only parameters.
        rest: the name of the parameter for all further positional arguments, or None.
        keywords: the name of the parameter for all further keyword arguments, or None.
        defaults: the default values of optional parameters, by name.
    """

    positional: tuple[str, ...]
    positional_only: int
    keyword_only: tuple[str, ...]
    rest: str | None
    keywords: str | None
    defaults: dict[str, Any]

    def bound(self, arguments: tuple[Any, ...], named: dict[str, Any]) -> dict[str, Any]:
        """Return the values of the parameters in a call, by name.

        Raises:
            TypeError: if the arguments do not match the parameters.
        """
        values: dict[str, Any] = dict(zip(self.positional, arguments, strict=False))
        further = arguments[len(self.positional) :]
        if further and self.rest is None:
            raise TypeError(
                phrase(
                    "the lambda takes {count} arguments, but {other_count} are given",
                    count=len(self.positional),
                    other_count=len(arguments),
                )
            )
        if self.rest is not None:
            values[self.rest] = further
        others: dict[str, Any] = {}
        for name, value in named.items():
            known = name in self.positional[self.positional_only :] or name in self.keyword_only
            if known and name in values:
                raise TypeError(phrase("the lambda is given '{name}' twice", name=name))
            if known:
                values[name] = value
            elif self.keywords is not None:
                others[name] = value
            else:
                raise TypeError(phrase("the lambda has no parameter '{name}'", name=name))
        if self.keywords is not None:
            values[self.keywords] = others
        for name in (*self.positional, *self.keyword_only):
            if name not in values:
                if name not in self.defaults:
                    raise TypeError(phrase("the lambda is not given its parameter '{name}'", name=name))
                values[name] = self.defaults[name]
        return values


class Function:
    """A lambda of an expression."""

    __slots__ = ("_around", "_body", "_parameters")

    def __init__(self, parameters: Parameters, body: _Closure, around: Environment) -> None:
        self._parameters = parameters
        self._body = body
        self._around = around

    def __repr__(self) -> str:
        return "<lambda>"

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        """Return the value of the body for the given arguments."""
        budget = self._around.session.budget
        budget.enter_lambda()
        try:
            return self._body(Local(self._around, self._parameters.bound(arguments, named)))
        finally:
            budget.leave_lambda()


def bind_parameters(
    arguments: ast.arguments, compile_node: Callable[[ast.AST], _Closure]
) -> Callable[[Environment], Parameters]:
    """Return a function that evaluates the parameters of a lambda, including their defaults.

    As in Python, the defaults are evaluated when the lambda is created.
    """
    positional = tuple(argument.arg for argument in (*arguments.posonlyargs, *arguments.args))
    keyword_only = tuple(argument.arg for argument in arguments.kwonlyargs)
    defaults = {
        name: compile_node(default)
        for name, default in zip(reversed(positional), reversed(arguments.defaults), strict=False)
    }
    for name, default in zip(keyword_only, arguments.kw_defaults, strict=True):
        if default is not None:
            defaults[name] = compile_node(default)

    def bind(env: Environment) -> Parameters:
        return Parameters(
            positional=positional,
            positional_only=len(arguments.posonlyargs),
            keyword_only=keyword_only,
            rest=arguments.vararg.arg if arguments.vararg else None,
            keywords=arguments.kwarg.arg if arguments.kwarg else None,
            defaults={name: default(env) for name, default in defaults.items()},
        )

    return bind


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
    """Return the number of steps that one pass over a value costs.

    The contents of the items do not count.
    """
    share = _SHARES.get(value.__class__)
    return len(value) // share if share else 0


def call(budget: Budget, function: Any, arguments: list[Any], keywords: dict[str, Any]) -> Any:
    """Call a function with some arguments, charge the budget, and return the value.

    Raises:
        RefusalError: if the function must not be called, or if its value is too large.
        Fault: XAC603 if there were too many steps.
    """
    sandbox.check_call(function)
    steps = _CALL
    name = getattr(function, "__name__", None)
    if name in HASHING:
        arguments = [checked_keys(argument) for argument in arguments]
    elif function is str and (len(arguments) > 1 or keywords):
        value = arguments[0] if arguments else keywords.get("object")
        check_codec(value, arguments[1] if len(arguments) > 1 else keywords.get("encoding", "utf-8"))
    if name not in _QUICK:
        for argument in arguments:
            steps += cost(argument)
        owner = getattr(function, "__self__", None)
        if owner is not None:
            steps += cost(owner)
    budget.charge_steps(steps)
    if (function is map or function is filter) and arguments:
        arguments = [_meter_calls(budget, arguments[0]), *arguments[1:]]
    if "key" in keywords:
        keywords = {**keywords, "key": _meter_calls(budget, keywords["key"])}
    return charge_value(budget, function(*arguments, **keywords))


def charge_value(budget: Budget, value: Any) -> Any:
    """Charge the budget for a new value with all its items, and return the value.

    Raises:
        RefusalError: if the value is too large.
        Fault: XAC603 if there were too many steps.
    """
    weight = sandbox.weight(value)
    if weight:
        budget.charge_steps(weight // (_CHARACTERS_A_STEP if isinstance(value, (str, bytes)) else _ITEMS_A_STEP))
    return value


def _meter_calls(budget: Budget, function: Any) -> Any:
    """Return a function that charges the budget each time one of Python's functions calls it.

    Lambdas are returned unchanged, because they charge the budget themselves.
    """
    if not callable(function) or isinstance(function, Function):
        return function

    def metered(*arguments: Any) -> Any:
        return call(budget, function, list(arguments), {})

    return metered
