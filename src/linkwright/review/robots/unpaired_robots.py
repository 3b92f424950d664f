"""Summarize robots that only one version has or can read."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from linkwright.descriptions.argument_sets import ArgumentSet
from linkwright.descriptions.comparison import ROS2_CONTROL
from linkwright.descriptions.pairs import Model
from linkwright.diagnostics import LinkwrightError, Phrase, counted, joined, joined_first, phrase
from linkwright.review.breaking import MOVING_TYPES
from linkwright.review.parts.outline import read_outline, try_read_outline
from linkwright.review.parts.written_contents import format_arguments, format_written_contents
from linkwright.review.plugins import find_plugin_name, find_plugins
from linkwright.review.versions import Version
from linkwright.urdf import Robot

_MAX_NAMES = 40
"""The maximum number of links, joints or plugins in the line about a robot."""


def description_contents(version: Version, path: str) -> Phrase | None:
    """Return the arguments of a description, and its elements if it cannot be expanded; None if there are none."""
    outline = read_outline(version.file(path), version.overlay)
    if read_unpaired_robot(version, path) is None:
        return format_written_contents(outline)
    arguments = list(format_arguments(outline))
    return joined(arguments) if arguments else None


def read_unpaired_robot(version: Version, path: str) -> tuple[Model, Robot] | None:
    """Return the model and robot of a description, or None if it is unreadable.

    The arguments have the values of the first caller.
    """
    sets: Sequence[ArgumentSet] = version.checker().argument_sets(version.file(path), ())
    for arguments in (*sets[:1], ArgumentSet({})):
        result = _try_read(version, path, arguments.values)
        if result is not None:
            return result
    return None


def _try_read(version: Version, path: str, values: Mapping[str, str]) -> tuple[Model, Robot] | None:
    model = version.model(path, values)
    try:
        robot = model.read().robot
    except LinkwrightError:
        return None
    return None if robot is None else (model, robot)


def read_with_argument_names(model: Model, robot: Robot) -> Robot:
    """Return a robot in whose names each empty argument is shown as ``<NAME>``, or else the robot itself.

    Args:
        model: the description.
        robot: the robot that the description makes.
    """
    outline = try_read_outline(model.path, model.overlay)
    arguments = {} if outline is None else outline.arguments
    empty = {
        name: f"<{name}>"
        for name, element in arguments.items()
        if not model.values.get(name, element.attributes.get("default"))
    }
    try:
        named = replace(model, values={**model.values, **empty}).read().robot if empty else None
    except LinkwrightError:
        return robot
    is_same = named is not None and [_count_kinds(named), len(named.links)] == [_count_kinds(robot), len(robot.links)]
    return named if named is not None and is_same else robot


def _count_kinds(robot: Robot) -> Counter[str]:
    """Return how many joints of each type, and extensions of each tag, a robot has."""
    return Counter([*(joint.type for joint in robot.joints.values()), *(element.tag for element in robot.extensions)])


def format_robot(robot: Robot) -> Phrase:
    """Return the parts of a robot in one line."""
    return phrase("robot '{name}': {parts}", name=robot.name, parts=joined(_count_parts(robot)))


def _count_parts(robot: Robot) -> Iterator[Phrase]:
    moving = [joint.name for joint in robot.joints.values() if joint.type in MOVING_TYPES]
    hardware = [element for element in robot.extensions if element.tag == ROS2_CONTROL]
    plugins = [find_plugin_name(plugin) for element in robot.extensions for plugin in find_plugins(element)]
    yield counted(
        "{count} link ({names})",
        "{count} links ({names})",
        len(robot.links),
        names=joined_first(list(robot.links), _MAX_NAMES),
    )
    if moving:
        yield counted(
            "{count} moving joint ({names})",
            "{count} moving joints ({names})",
            len(moving),
            names=joined_first(moving, _MAX_NAMES),
        )
    if hardware:
        names = [element.attributes.get("name", "") for element in hardware]
        yield phrase("ros2_control {names}", names=joined_first(names, _MAX_NAMES))
    if plugins:
        yield phrase("plugins {names}", names=joined_first(list(dict.fromkeys(plugins)), _MAX_NAMES))
