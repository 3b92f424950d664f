"""Entities: what a launch description is made of."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.errors.places import Placed

if TYPE_CHECKING:
    from linkwright.launch.model.context import LaunchContext


class LaunchDescriptionEntity(Placed):
    """Something a launch description holds."""

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Do the work and return the entities to be visited next."""
        return None

    def describe(self) -> str:
        """A short description."""
        return f"{type(self).__name__}()"

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """The entities that are always visited after it, as far as is known before the launch."""
        return []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """The entities that are visited under a condition, each lot behind words about the condition."""
        return []

    def arguments_given_inside(self) -> tuple[str, ...]:
        """The names of the launch arguments that it gives to the entities inside it, those known before the launch."""
        return ()

    def hides_entities(self) -> bool:
        """Whether it leads to entities that nobody can know before the launch, such as those of a file."""
        return False

    def explain_inside(self, error: LinkwrightError) -> LinkwrightError:
        """An error of the entities that this one led to, with notes on how they were reached."""
        return error

    def get_asyncio_future(self) -> asyncio.Future[Any] | None:
        """A future that is done when the entity has ended; None when it ends with its visit."""
        return None


SomeEntitiesType = LaunchDescriptionEntity | Iterable[LaunchDescriptionEntity]
"""One entity, or several."""

SomeEntitiesType_types_tuple = (LaunchDescriptionEntity, Iterable)


def as_entities(value: Any) -> list[LaunchDescriptionEntity]:
    """One entity, several, or None, as a list.

    Raises:
        TypeError: for anything that is not an entity.
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
