"""The registry of functions that parse tags and substitutions ``$(name ...)``.

As in ``launch.frontend``, packages register their own functions with the decorators of this module.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from linkwright.launch.model.markup.entity import Entity, Parser

T = TypeVar("T")

action_parse_methods: dict[str, Any] = {}
"""Tag -> function of entity and parser that returns the action's class or factory, and its keyword arguments."""

substitution_parse_methods: dict[str, Any] = {}
"""Name -> function of a list of arguments that returns the substitution's class or factory, and its keyword
arguments."""


def expose_action(name: str) -> Callable[[T], T]:
    """Register a class or function for the tag `name`.

    A class must have a class method ``parse(entity, parser)``. A function must have the same parameters.
    """
    return expose_impl(name, action_parse_methods, "action")


def expose_substitution(name: str) -> Callable[[T], T]:
    """Register a class or function for ``$(name ...)``.

    A class must have a class method ``parse(data)``. A function must have the same parameter.
    """
    return expose_impl(name, substitution_parse_methods, "substitution")


def expose_impl(name: str, parse_methods_map: dict[str, Any], exposed_type: str) -> Callable[[T], T]:
    """Return a decorator that registers a function, or the parse method of a class, in a table.

    Raises:
        RuntimeError: raised by the decorator if the object has no parse method, or the name is taken.
    """

    def decorate(exposed: T) -> T:
        method = _parse_method(exposed, name, exposed_type)
        taken = parse_methods_map.get(name)
        if taken is not None and not _is_same(getattr(taken, "__wrapped__", taken), method):
            raise RuntimeError(f"Two {exposed_type} parsing methods exposed with the same name: [{name}].")
        parse_methods_map[name] = _with_completeness_check(method) if exposed_type == "action" else method
        return exposed

    return decorate


def _is_same(one: Any, other: Any) -> bool:
    """Return whether two functions are the same, even if their module was imported twice."""
    return bool(one == other) or (
        (one.__module__, one.__qualname__) == (other.__module__, other.__qualname__)
        and one.__code__.co_filename == other.__code__.co_filename
    )


def _parse_method(exposed: Any, name: str, exposed_type: str) -> Any:
    if inspect.isclass(exposed):
        method = getattr(exposed, "parse", None)
        if not inspect.ismethod(method):
            raise RuntimeError("Did not find a class method called 'parse' in the class being decorated.")
        return method
    if inspect.isfunction(exposed):
        return exposed
    raise RuntimeError(
        f"Exposed {exposed_type} parser for {name} is not a callable or a class containing a parse method"
    )


def _with_completeness_check(method: Any) -> Any:
    """Wrap a parse function so that unread parts of the tag raise an error."""

    @functools.wraps(method)
    def parse(entity: Entity, parser: Parser) -> Any:
        made = method(entity, parser)
        entity.assert_entity_completely_parsed()
        return made

    return parse
