"""The registry of the functions that parse tags and substitutions ``$(name ...)``.

Packages register their functions with the decorators of this module, as in ``launch.frontend``.
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
"""Maps tags to functions that parse an action.

The parameters are entity and parser. The functions return the class or factory of the action, and its arguments.
"""

substitution_parse_methods: dict[str, Any] = {}
"""Maps names to functions that parse a substitution.

They return the class or factory of the substitution, and its keyword arguments.
"""


def expose_action(name: str) -> Callable[[T], T]:
    """Return a decorator that registers a class or function for the tag `name`.

    A class must have a class method ``parse(entity, parser)``. A function must have the same parameters.
    """
    return expose_impl(name, action_parse_methods, "action")


def expose_substitution(name: str) -> Callable[[T], T]:
    """Return a decorator that registers a class or function for ``$(name ...)``.

    A class must have a class method ``parse(data)``. A function must have the same parameter.
    """
    return expose_impl(name, substitution_parse_methods, "substitution")


def expose_impl(name: str, parse_methods_map: dict[str, Any], exposed_type: str) -> Callable[[T], T]:
    """Return a decorator that registers a function, or the parse method of a class, in a table.

    Raises:
        RuntimeError: raised by the decorator if the class has no parse method, or the name is registered already.
    """

    def decorate(exposed_object: T) -> T:
        method = _parse_method(exposed_object, name, exposed_type)
        registered = parse_methods_map.get(name)
        if registered is not None and not _is_same(getattr(registered, "__wrapped__", registered), method):
            raise RuntimeError(f"Two {exposed_type} parsing methods exposed with the same name: [{name}].")
        parse_methods_map[name] = _with_completeness_check(method) if exposed_type == "action" else method
        return exposed_object

    return decorate


def _is_same(first: Any, second: Any) -> bool:
    """Return whether two functions are the same, even if their module was imported twice."""
    return bool(first == second) or (
        (first.__module__, first.__qualname__) == (second.__module__, second.__qualname__)
        and first.__code__.co_filename == second.__code__.co_filename
    )


def _parse_method(exposed_object: Any, name: str, exposed_type: str) -> Any:
    if inspect.isclass(exposed_object):
        method = getattr(exposed_object, "parse", None)
        if not inspect.ismethod(method):
            raise RuntimeError("Did not find a class method called 'parse' in the class being decorated.")
        return method
    if inspect.isfunction(exposed_object):
        return exposed_object
    raise RuntimeError(
        f"Exposed {exposed_type} parser for {name} is not a callable or a class containing a parse method"
    )


def _with_completeness_check(method: Any) -> Any:
    """Return a parse function that raises an error if parts of the tag remain unread."""

    @functools.wraps(method)
    def parse(entity: Entity, parser: Parser) -> Any:
        result = method(entity, parser)
        entity.assert_entity_completely_parsed()
        return result

    return parse
