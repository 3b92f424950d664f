"""Entities, the elements of a launch description."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.errors.locations import Located

if TYPE_CHECKING:
    from linkwright.launch.model.context import LaunchContext


class LaunchDescriptionEntity(Located):
    """An element of a launch description."""

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Visit the entity, and return the entities to visit next, or None."""
        return None

    def describe(self) -> str:
        """Return a short text that describes the entity in listings."""
        return f"{type(self).__name__}()"

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities that are visited after this one without a condition.

        Only entities that are known before the launch are returned.
        """
        return []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return pairs of a text about a condition, and the entities visited under that condition."""
        return []

    def arguments_given_inside(self) -> tuple[str, ...]:
        """Return the names of the launch arguments that the entity sets for its children.

        Only names that are known before the launch are returned.
        """
        return ()

    def hides_entities(self) -> bool:
        """Return whether some child entities are unknown before the launch.

        For example, the path of an included file may contain substitutions.
        """
        return False

    def explain_inside(self, error: LinkwrightError) -> LinkwrightError:
        """Add notes about the path to a child entity to an error that the child caused.

        Returns:
            The same error.
        """
        return error

    def get_asyncio_future(self) -> asyncio.Future[Any] | None:
        """Return a future that is done when the entity has ended.

        The result is None if the entity ends with its visit.
        """
        return None


SomeEntitiesType = LaunchDescriptionEntity | Iterable[LaunchDescriptionEntity]
"""An entity, or an iterable of entities."""

SomeEntitiesType_types_tuple = (LaunchDescriptionEntity, Iterable)


def as_entities(value: Any) -> list[LaunchDescriptionEntity]:
    """Return an entity, an iterable of entities or None as a list of entities.

    Raises:
        TypeError: the argument is or contains an object that is not an entity.
    """
    if value is None:
        return []
    if isinstance(value, LaunchDescriptionEntity):
        return [value]
    entities = list(value) if isinstance(value, Iterable) and not isinstance(value, str) else [value]
    for entity in entities:
        if not isinstance(entity, LaunchDescriptionEntity):
            raise TypeError(f"expected launch actions, got {entity!r} of type {type(entity).__name__}")
    return entities
