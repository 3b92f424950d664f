"""Listings of launch descriptions, as ``ros2 launch --print-description`` prints them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from linkwright.launch.errors.user_code import DEEPEST, endless_nesting_error
from linkwright.launch.model.actions import EmitEvent, Log, RegisterEventHandler
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.model.entity import LaunchDescriptionEntity

_INDENT = "    "


class LaunchIntrospector:
    """Formats the contents of a launch description without running it."""

    def format_launch_description(self, launch_description: LaunchDescription) -> str:
        """Return the entities of a description as an indented tree, one per line."""
        return format_launch_description(launch_description)


def format_launch_description(description: LaunchDescription) -> str:
    """Return the entities of a description as an indented tree, one per line."""
    return "\n".join([description.describe(), *_tree(description.entities)])


def _tree(entities: Iterable[Any], depth: int = 1) -> list[str]:
    listed = list(entities)
    if depth > DEEPEST and listed:
        raise endless_nesting_error(getattr(listed[0], "place", None))
    lines: list[str] = []
    for number, entity in enumerate(listed):
        last = number == len(listed) - 1
        text, inside = _described(entity)
        lines.append(("└── " if last else "├── ") + text)
        lines += [(_INDENT if last else "│   ") + line for line in _tree(inside, depth + 1)]
    return lines


def _described(entity: Any) -> tuple[str, list[LaunchDescriptionEntity]]:
    """Return a text that describes an entity, and the entity's children."""
    if isinstance(entity, RegisterEventHandler):
        text, inside = entity.event_handler.describe()
        return f"RegisterEventHandler('{text}'):", inside
    if isinstance(entity, (Log, EmitEvent)) or not isinstance(entity, LaunchDescriptionEntity):
        return entity.describe() if isinstance(entity, LaunchDescriptionEntity) else str(entity), []
    inside = list(entity.describe_sub_entities())
    for _, some in entity.describe_conditional_sub_entities():
        inside += some
    condition = getattr(entity, "condition", None)
    suffix = f" if {condition.describe()}" if condition is not None else ""
    return entity.describe() + suffix, inside
