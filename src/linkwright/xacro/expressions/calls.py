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
from linkwright.xacro.expressions.yaml_data import YamlDict, YamlList, YamlMapping
from linkwright.xacro.limits import Budget

_Closure = Callable[[Any], Any]


class Parameters(NamedTuple):
    """The parameters of a lambda, with the values of their defaults.

    Attributes:
        positional: the names of the positional parameters.
        positional_only: the number of names in `positional` that are positional-only.
        keyword_only: the names of the keyword-only parameters.
        extra_name: the name of the parameter for all further positional arguments, or None.
        keywords: the name of the parameter for all further keyword arguments, or None.
        defaults: the default values of optional parameters, by name.
    """

    positional: tuple[str, ...]
    positional_only: int
    keyword_only: tuple[str, ...]
    extra_name: str | None
    keywords: str | None
    defaults: dict[str, Any]

    def bind_arguments(self, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> dict[str, Any]:
        """Return the values of the parameters in a call, by name.

        Raises:
            TypeError: if the arguments do not match the parameters.
        """
        values: dict[str, Any] = dict(zip(self.positional, arguments, strict=False))
        extra_arguments = arguments[len(self.positional) :]
        if extra_arguments and self.extra_name is None:
            raise TypeError(
                phrase(
                    "the lambda takes {count} arguments, but {other_count} are given",
                    count=len(self.positional),
                    other_count=len(arguments),
                )
            )
        if self.extra_name is not None:
            values[self.extra_name] = extra_arguments
        extra_keywords: dict[str, Any] = {}
        for name, value in keywords.items():
            is_parameter = name in self.positional[self.positional_only :] or name in self.keyword_only
            if is_parameter and name in values:
                raise TypeError(phrase("the lambda receives two values for its parameter '{name}'", name=name))
            if is_parameter:
                values[name] = value
            elif self.keywords is not None:
                extra_keywords[name] = value
            else:
                raise TypeError(phrase("the lambda has no parameter '{name}'", name=name))
        if self.keywords is not None:
            values[self.keywords] = extra_keywords
        for name in (*self.positional, *self.keyword_only):
            if name not in values:
                if name not in self.defaults:
                    raise TypeError(phrase("the call of the lambda lacks its parameter '{name}'", name=name))
                values[name] = self.defaults[name]
        return values


class Function:
    """A lambda of an expression."""

    __slots__ = ("_body", "_enclosing", "_parameters")

    def __init__(self, parameters: Parameters, body: _Closure, environment: Environment) -> None:
        self._parameters = parameters
        self._body = body
        self._enclosing = environment

    def __repr__(self) -> str:
        return "<lambda>"

    def __call__(self, *arguments: Any, **keywords: Any) -> Any:
        """Return the value of the body for the given arguments."""
        budget = self._enclosing.session.budget
        budget.enter_lambda()
        try:
            return self._body(Local(self._enclosing, self._parameters.bind_arguments(arguments, keywords)))
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
            extra_name=arguments.vararg.arg if arguments.vararg else None,
            keywords=arguments.kwarg.arg if arguments.kwarg else None,
            defaults={name: default(env) for name, default in defaults.items()},
        )

    return bind


_CALL_STEPS = 2
_ITEMS_PER_STEP = 2
_CHARACTERS_PER_STEP = 32
_COLLECTION_TYPES = (list, tuple, dict, set, frozenset, range, YamlList, YamlDict, YamlMapping)
_UNITS_PER_STEP = {
    **dict.fromkeys(_COLLECTION_TYPES, _ITEMS_PER_STEP),
    str: _CHARACTERS_PER_STEP,
    bytes: _CHARACTERS_PER_STEP,
}
_CONSTANT_TIME_FUNCTIONS = frozenset(
    {
        *("append", "bool", "get", "isinstance", "items", "keys", "len", "pop", "popitem", "setdefault", "type"),
        *("values",),
    }
)
"""Functions whose running time does not depend on the length of the value."""


def cost(value: Any) -> int:
    """Return the number of steps that one pass over a value costs.

    The contents of the items are not included.
    """
    units_per_step = _UNITS_PER_STEP.get(value.__class__)
    return len(value) // units_per_step if units_per_step else 0


def call(budget: Budget, function: Any, arguments: list[Any], keywords: dict[str, Any]) -> Any:
    """Call a function, charge the budget for the call, and return the result.

    Raises:
        RefusalError: if expressions must not call the function, or if the result is too large.
        Fault: XAC603 if there were too many steps.
    """
    sandbox.check_call(function)
    steps = _CALL_STEPS
    name = getattr(function, "__name__", None)
    if name in HASHING:
        arguments = [checked_keys(argument) for argument in arguments]
    elif function is str and (len(arguments) > 1 or keywords):
        value = arguments[0] if arguments else keywords.get("object")
        check_codec(value, arguments[1] if len(arguments) > 1 else keywords.get("encoding", "utf-8"))
    if name not in _CONSTANT_TIME_FUNCTIONS:
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
        budget.charge_steps(weight // (_CHARACTERS_PER_STEP if isinstance(value, (str, bytes)) else _ITEMS_PER_STEP))
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
