"""The launch description that a launch file returns."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import phrase
from linkwright.launch.errors.locations import SourceLocation, error_at
from linkwright.launch.model.action import Action
from linkwright.launch.model.declared_arguments import find_declared_arguments
from linkwright.launch.model.entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from linkwright.launch.model.actions.arguments import DeclareLaunchArgument
    from linkwright.launch.model.context import LaunchContext


class LaunchDescription(LaunchDescriptionEntity):
    """A list of entities in the order of their visits.

    Args:
        initial_entities: the entities in the order of their visits.
        deprecated_reason: the reason why the description is deprecated, logged on a visit; None if it is not
            deprecated.
    """

    def __init__(
        self,
        initial_entities: Iterable[LaunchDescriptionEntity] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        self._entities = [_check_entity(initial_entity) for initial_entity in initial_entities or ()]
        self._deprecated_reason = deprecated_reason

    @property
    def entities(self) -> list[LaunchDescriptionEntity]:
        """The entities in the order of their visits."""
        return self._entities

    @property
    def deprecated(self) -> bool:
        """Whether the description is deprecated."""
        return self._deprecated_reason is not None

    @property
    def deprecated_reason(self) -> str | None:
        """The reason for the deprecation, or None if the description is not deprecated."""
        return self._deprecated_reason

    def describe(self) -> str:
        """Return a text with the number of entities."""
        count = len(self._entities)
        return f"{type(self).__name__}({count} {'entity' if count == 1 else 'entities'})"

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities of the description."""
        return self._entities

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        """Append an entity.

        Raises:
            AttributeError: LAUNCH147, the argument is not an entity.
        """
        self._entities.append(_check_entity(entity))

    def add_action(self, action: Action) -> None:
        """Append an action.

        Raises:
            AttributeError: LAUNCH147, the argument is not an entity.
        """
        self._entities.append(_check_entity(action))

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:
        """Return the entities to visit next, and log a warning if the description is deprecated."""
        if self.deprecated:
            file = context.get_locals_as_dict().get("current_launch_file_path")
            subject = f"launch file [{file}] is" if file else "launch description is"
            text = f"The {subject} deprecated: {self._deprecated_reason}"
            if hasattr(context, "log"):
                context.log("launch", logging.WARNING, text)
        return self._entities

    def get_launch_arguments(self, conditional_inclusion: bool = False) -> list[DeclareLaunchArgument]:
        """Return the declared arguments of this description and the descriptions that it includes.

        The search omits descriptions that cannot be read before the launch. The first declaration of a name counts. A
        declaration under a condition has its attribute ``conditionally_included`` set.
        """
        return find_declared_arguments(self.entities, conditional_inclusion)


def _check_entity(entity: Any) -> Any:
    """Return an object unchanged if it can be visited.

    ROS reports such a mistake only during the launch, without the line that added the object.

    Raises:
        AttributeError: LAUNCH147, the object is not an entity.
    """
    if isinstance(entity, LaunchDescriptionEntity) or hasattr(entity, "visit"):
        return entity
    type_name = type(entity).__name__
    message = phrase("a launch description accepts actions, not a value of type {kind}", kind=type_name)
    hint = phrase("add each action separately") if isinstance(entity, (list, tuple)) else None
    text = f"'{type_name}' object has no attribute 'visit'"
    raise error_at(SourceLocation.of_caller(), "LAUNCH147", message, hint, ros_error=AttributeError(text))
