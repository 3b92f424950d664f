"""Entities of a launch description, and actions, the entities that do something."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from linkwright.launch.places import Place

if TYPE_CHECKING:
    from linkwright.launch.conditions import Condition
    from linkwright.launch.context import LaunchContext

E = TypeVar("E", bound="LaunchDescriptionEntity")


class LaunchDescriptionEntity:
    """Something a launch description holds.

    Attributes:
        place: where in the user's program it was made.
    """

    place: Place | None

    def __new__(cls: type[E], *_: Any, **__: Any) -> E:  # noqa: PYI019 - Self needs Python 3.11
        """Remember the place; done here because entities of users need not call our constructor."""
        made = super().__new__(cls)
        made.place = Place.of_caller()
        return made

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:  # noqa: ARG002
        """Do the work and return the entities to be visited next."""
        return None

    def describe(self) -> str:
        """A short description."""
        return repr(self)


SomeEntitiesType = LaunchDescriptionEntity | Iterable[LaunchDescriptionEntity]
"""What may stand where entities are expected: one, or several."""


class Action(LaunchDescriptionEntity):
    """An entity that does something when it is visited and its condition holds.

    Args:
        condition: decides at the visit whether `execute` runs.
    """

    def __init__(self, *, condition: Condition | None = None) -> None:
        self._condition = condition

    @property
    def condition(self) -> Condition | None:
        """The condition, or None for an action that always runs."""
        return getattr(self, "_condition", None)

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Execute, if the condition holds."""
        if self.condition is None or self.condition.evaluate(context):
            return as_entities(self.execute(context))
        return None

    def execute(self, context: LaunchContext) -> Any:  # noqa: ARG002 - the interface of actions
        """Do the work; may return entities to be visited next."""
        return None

    def get_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        """The entities inside, for a reader who asks which arguments are declared."""
        return ()


def as_entities(value: Any) -> list[LaunchDescriptionEntity]:
    """One entity, several, or None, as a list.

    Raises:
        TypeError: for anything that is not an entity.
    """
    if value is None:
        return []
    if isinstance(value, LaunchDescriptionEntity):
        return [value]
    entities = list(value) if isinstance(value, Iterable) else [value]
    for entity in entities:
        if not isinstance(entity, LaunchDescriptionEntity):
            raise TypeError(f"expected launch actions, got {entity!r} of type {type(entity).__name__}")
    return entities
