"""Which function makes an action from a tag, and a substitution from ``$(name ...)``.

Packages add their own with the decorators, as in ``launch.frontend``.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from linkwright.diagnostics import LinkwrightError, did_you_mean
from linkwright.launch.places import error_at, located, reading

if TYPE_CHECKING:
    from linkwright.launch.entity import Action
    from linkwright.launch.frontend.entity import Entity
    from linkwright.launch.frontend.parser import Parser
    from linkwright.launch.places import Place
    from linkwright.launch.substitution import Substitution

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


def _method(methods: dict[str, Any], name: str) -> Any:
    """What reads a tag or substitution; when nobody knows it, those of packages that were not built are loaded."""
    if name not in methods:
        from linkwright.launch.frontend.workspace_extensions import load_workspace_extensions

        load_workspace_extensions()
    return methods.get(name)


def instantiate_action(entity: Entity, parser: Parser) -> Action:
    """The action of a tag.

    Raises:
        RuntimeError: LAUNCH115, the tag is not known.
    """
    method = _method(action_parse_methods, entity.type_name)
    place = entity.place
    if method is None:
        raise error_at(
            place,
            "LAUNCH115",
            f"there is no action '{entity.type_name}'",
            did_you_mean(entity.type_name, action_parse_methods),
            promises=RuntimeError(f"Unrecognized entity of the type: {entity.type_name}"),
        )
    with reading(place):
        try:
            action_type, kwargs = method(entity, parser)
            return action_type(**kwargs)  # type: ignore[no-any-return]
        except LinkwrightError as error:
            raise located(error, place) from error
        except (TypeError, ValueError) as error:
            raise error_at(place, "LAUNCH118", f"action '{entity.type_name}': {error}", promises=error) from error


def instantiate_substitution(
    type_name: str, args: Sequence[Any] | None = None, place: Place | None = None
) -> Substitution:
    """The substitution of a name, with a list of substitutions for each argument.

    Raises:
        RuntimeError: LAUNCH119, the name is not known, or its arguments are wrong.
    """
    method = _method(substitution_parse_methods, type_name)
    if method is None:
        raise error_at(
            place,
            "LAUNCH119",
            f"there is no substitution '{type_name}'",
            did_you_mean(type_name, substitution_parse_methods),
            promises=RuntimeError(f"Unknown substitution: {type_name}"),
        )
    with reading(place):
        try:
            substitution_type, kwargs = method([] if args is None else args)
            return substitution_type(**kwargs)  # type: ignore[no-any-return]
        except LinkwrightError as error:
            raise located(error, place) from error
        except (AttributeError, TypeError, ValueError, AssertionError) as error:
            message = f"substitution '{type_name}': {error}" if str(error) else f"substitution '{type_name}' is wrong"
            raise error_at(place, "LAUNCH119", message, promises=error) from error
