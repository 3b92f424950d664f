"""Which arguments a launch description declares."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.entity import Action, LaunchDescriptionEntity

if TYPE_CHECKING:
    from linkwright.launch.actions.arguments import DeclareLaunchArgument
    from linkwright.launch.description import LaunchDescription


def declared_arguments(
    description: LaunchDescription, conditional_inclusion: bool = False
) -> list[DeclareLaunchArgument]:
    """The arguments declared in a description and in what it holds and includes, as far as can be known now.

    The first declaration of a name counts. Those behind a condition are marked by ``conditionally_included``.
    """
    found: dict[str, DeclareLaunchArgument] = {}
    _collect(description.entities, conditional_inclusion, (), found)
    return list(found.values())


def _collect(
    entities: Iterable[LaunchDescriptionEntity],
    conditional: bool,
    set_outside: tuple[str, ...],
    found: dict[str, DeclareLaunchArgument],
) -> None:
    from linkwright.launch.actions.arguments import DeclareLaunchArgument
    from linkwright.launch.actions.events import RegisterEventHandler
    from linkwright.launch.actions.include import IncludeLaunchDescription
    from linkwright.launch.description import LaunchDescription
    from linkwright.launch.substitution import TextSubstitution

    for entity in entities:
        if isinstance(entity, LaunchDescription):
            _collect(entity.entities, conditional, set_outside, found)
        elif isinstance(entity, DeclareLaunchArgument):
            entity.conditionally_included = conditional or entity.condition is not None
            if entity.name not in set_outside:
                found.setdefault(entity.name, entity)
        elif isinstance(entity, Action):
            behind = conditional or entity.condition is not None or isinstance(entity, RegisterEventHandler)
            inside = set_outside
            if isinstance(entity, IncludeLaunchDescription):
                inside += tuple(
                    name[0].text
                    for name, _ in entity.launch_arguments
                    if len(name) == 1 and isinstance(name[0], TextSubstitution)
                )
            try:
                below = entity.get_sub_entities()
            except LinkwrightError:
                continue  # an included file that cannot be read is reported when it is visited
            _collect(below, behind, inside, found)
