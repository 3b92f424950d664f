"""Create actions from tags, and substitutions from ``$(name ...)``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import LinkwrightError, did_you_mean, foreign, phrase
from linkwright.launch.errors.locations import SourceLocation, error_at, reading_markup_at, with_location
from linkwright.launch.model.action import Action
from linkwright.launch.model.markup.entity import Entity
from linkwright.launch.model.markup.expose import action_parse_methods, substitution_parse_methods
from linkwright.launch.model.substitution import Substitution

if TYPE_CHECKING:
    from linkwright.launch.model.markup.entity import Parser


def _find_parse_method(parse_methods: dict[str, Any], name: str) -> Any:
    """Return the parse function of a tag or substitution, or None for an unregistered name.

    If the name is not registered, this function first loads the launch extensions in the workspace.
    """
    if name not in parse_methods:
        from linkwright.launch.frontend.extensions import load_workspace_extensions

        load_workspace_extensions()
    return parse_methods.get(name)


def instantiate_action(entity: Entity, parser: Parser) -> Action:
    """Return the action that a tag describes.

    Raises:
        RuntimeError: LAUNCH115, no action has this tag.
    """
    parse = _find_parse_method(action_parse_methods, entity.type_name)
    location = entity.source_location
    if parse is None:
        raise error_at(
            location,
            "LAUNCH115",
            phrase("no action has the tag '{type_name}'", type_name=entity.type_name),
            did_you_mean(entity.type_name, action_parse_methods),
            ros_error=RuntimeError(f"Unrecognized entity of the type: {entity.type_name}"),
        )
    with reading_markup_at(location):
        try:
            action_type: type[Action]
            action_type, kwargs = parse(entity, parser)
            return action_type(**kwargs)
        except LinkwrightError as error:
            raise with_location(error, location) from error
        except (TypeError, ValueError) as error:
            raise error_at(
                location,
                "LAUNCH118",
                phrase("action '{type_name}' is not valid: {error}", type_name=entity.type_name, error=foreign(error)),
                ros_error=error,
            ) from error


def instantiate_substitution(
    type_name: str, args: Sequence[Any] | None = None, location: SourceLocation | None = None
) -> Substitution:
    """Create the substitution with a name. Each argument is a list of substitutions.

    Raises:
        RuntimeError: LAUNCH119, there is no substitution with this name, or its arguments are wrong.
    """
    parse = _find_parse_method(substitution_parse_methods, type_name)
    if parse is None:
        raise error_at(
            location,
            "LAUNCH119",
            phrase("there is no substitution '{type_name}'", type_name=type_name),
            did_you_mean(type_name, substitution_parse_methods),
            ros_error=RuntimeError(f"Unknown substitution: {type_name}"),
        )
    with reading_markup_at(location):
        try:
            substitution_type: type[Substitution]
            substitution_type, kwargs = parse([] if args is None else args)
            return substitution_type(**kwargs)
        except LinkwrightError as error:
            raise with_location(error, location) from error
        except (AttributeError, TypeError, ValueError, AssertionError) as error:
            message = (
                phrase("substitution '{type_name}' is not valid: {error}", type_name=type_name, error=foreign(error))
                if str(error)
                else phrase("substitution '{type_name}' is not valid", type_name=type_name)
            )
            raise error_at(location, "LAUNCH119", message, ros_error=error) from error
