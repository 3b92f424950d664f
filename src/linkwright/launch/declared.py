"""Which arguments a launch description declares."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from linkwright.launch.actions.arguments import DeclareLaunchArgument
    from linkwright.launch.description import LaunchDescription


def declared_arguments(
    description: LaunchDescription, conditional_inclusion: bool = False
) -> list[DeclareLaunchArgument]:
    """The arguments declared in a description and in what it holds and includes, as far as can be known now.

    The first declaration of a name counts. Those behind a condition are marked by ``conditionally_included``.
    Declarations after a `ResetLaunchConfigurations` cannot be given from outside, and do not count.
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
    from linkwright.launch.actions.configurations import ResetLaunchConfigurations
    from linkwright.launch.actions.include import IncludeLaunchDescription

    for entity in entities:
        if isinstance(entity, ResetLaunchConfigurations):
            return
        if isinstance(entity, DeclareLaunchArgument):
            entity.conditionally_included = conditional or entity.condition is not None
            if entity.name not in set_outside:
                found.setdefault(entity.name, entity)
            continue
        inside = set_outside
        if isinstance(entity, IncludeLaunchDescription):
            inside += _plain_names(entity)
        try:
            below = entity.describe_sub_entities()
            maybe = entity.describe_conditional_sub_entities()
        except LinkwrightError:
            continue  # an included file that cannot be read is reported when it is visited
        _collect(below, conditional, inside, found)
        for _, some in maybe:
            _collect(some, True, inside, found)


def _plain_names(include: LaunchDescriptionEntity) -> tuple[str, ...]:
    """The names of the arguments that an include gives, those that are plain text."""
    from linkwright.launch.actions.include import IncludeLaunchDescription
    from linkwright.launch.substitution import TextSubstitution

    assert isinstance(include, IncludeLaunchDescription)
    return tuple(
        name[0].text for name, _ in include.launch_arguments if len(name) == 1 and isinstance(name[0], TextSubstitution)
    )
