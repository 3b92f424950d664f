"""The launch description: what a launch file returns."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from linkwright.launch.entity import Action, LaunchDescriptionEntity

if TYPE_CHECKING:
    from linkwright.launch.actions.arguments import DeclareLaunchArgument
    from linkwright.launch.context import LaunchContext


class LaunchDescription(LaunchDescriptionEntity):
    """Entities in the order in which they are visited."""

    def __init__(self, initial_entities: Iterable[LaunchDescriptionEntity] | None = None) -> None:
        self._entities = list(initial_entities or ())

    @property
    def entities(self) -> list[LaunchDescriptionEntity]:
        """The entities."""
        return self._entities

    @property
    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """The entities, as tools that look at a description ask for them."""
        return self._entities

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        """Append an entity."""
        self._entities.append(entity)

    def add_action(self, action: Action) -> None:
        """Append an action."""
        self._entities.append(action)

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:  # noqa: ARG002
        """The entities, to be visited next."""
        return self._entities

    def get_launch_arguments(self, conditional_inclusion: bool = False) -> list[DeclareLaunchArgument]:
        """The arguments declared here and, as far as can be known before it runs, in what is included.

        Of several declarations with one name the first is given. A declaration behind a condition is marked
        by its ``conditionally_included``.
        """
        from linkwright.launch.declared import declared_arguments

        return declared_arguments(self, conditional_inclusion)
