"""Which function makes an action from a tag, and a substitution from ``$(name ...)``.

Packages add their own with the decorators, as in ``launch.frontend``.
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
"""Tag -> function of entity and parser that returns what makes the action, and its keyword arguments."""

substitution_parse_methods: dict[str, Any] = {}
"""Name -> function of a list of arguments that returns what makes the substitution, and its keyword arguments."""


def expose_action(name: str) -> Callable[[T], T]:
    """Decorates a class with a class method ``parse(entity, parser)``, or such a function: it reads the tag `name`."""
    return expose_impl(name, action_parse_methods, "action")


def expose_substitution(name: str) -> Callable[[T], T]:
    """Decorates a class with a class method ``parse(data)``, or such a function: it reads ``$(name ...)``."""
    return expose_impl(name, substitution_parse_methods, "substitution")


def expose_impl(name: str, parse_methods_map: dict[str, Any], exposed_type: str) -> Callable[[T], T]:
    """The decorator that enters a class or function into a table.

    Raises:
        RuntimeError: by the decorator: what is decorated cannot read, or the name is taken.
    """

    def decorate(exposed: T) -> T:
        method = _parse_method(exposed, name, exposed_type)
        taken = parse_methods_map.get(name)
        if taken is not None and not _is_same(getattr(taken, "__wrapped__", taken), method):
            raise RuntimeError(f"Two {exposed_type} parsing methods exposed with the same name: [{name}].")
        parse_methods_map[name] = _reading_all(method) if exposed_type == "action" else method
        return exposed

    return decorate


def _is_same(one: Any, other: Any) -> bool:
    """Whether two functions are one and the same, or one is the other after its module was imported anew."""
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


def _reading_all(method: Any) -> Any:
    """The function, followed by a check that it has read all that is written in the tag."""

    @functools.wraps(method)
    def parse(entity: Entity, parser: Parser) -> Any:
        made = method(entity, parser)
        entity.assert_entity_completely_parsed()
        return made

    return parse
