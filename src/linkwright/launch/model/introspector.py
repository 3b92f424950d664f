"""Listings of launch descriptions, as ``ros2 launch --print-description`` prints them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from linkwright.launch.errors.user_code import MAX_NESTING_DEPTH, endless_nesting_error
from linkwright.launch.model.actions import EmitEvent, Log, RegisterEventHandler
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.model.entity import LaunchDescriptionEntity

_INDENT = "    "


class LaunchIntrospector:
    """A formatter of the contents of a launch description, which does not run the description."""

    def format_launch_description(self, launch_description: LaunchDescription) -> str:
        """Return the entities of a description as an indented tree with one entity per line."""
        return format_launch_description(launch_description)


def format_launch_description(description: LaunchDescription) -> str:
    """Return the entities of a description as an indented tree with one entity per line."""
    return "\n".join([description.describe(), *_format_tree(description.entities)])


def _format_tree(entities: Iterable[Any], depth: int = 1) -> list[str]:
    entity_list = list(entities)
    if depth > MAX_NESTING_DEPTH and entity_list:
        raise endless_nesting_error(getattr(entity_list[0], "source_location", None))
    lines: list[str] = []
    for index, entity in enumerate(entity_list):
        is_last = index == len(entity_list) - 1
        text, children = _describe(entity)
        lines.append(("└── " if is_last else "├── ") + text)
        lines += [(_INDENT if is_last else "│   ") + line for line in _format_tree(children, depth + 1)]
    return lines


def _describe(entity: Any) -> tuple[str, list[LaunchDescriptionEntity]]:
    """Return a text that describes an entity, and the entity's children."""
    if isinstance(entity, RegisterEventHandler):
        text, children = entity.event_handler.describe()
        return f"RegisterEventHandler('{text}'):", children
    if isinstance(entity, (Log, EmitEvent)) or not isinstance(entity, LaunchDescriptionEntity):
        return entity.describe() if isinstance(entity, LaunchDescriptionEntity) else str(entity), []
    children = list(entity.describe_sub_entities())
    for _, entities in entity.describe_conditional_sub_entities():
        children += entities
    condition = getattr(entity, "condition", None)
    suffix = f" if {condition.describe()}" if condition is not None else ""
    return entity.describe() + suffix, children
