"""Summarize robots that only one version has or can read."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.descriptions.argument_sets import ArgumentSet
from linkwright.descriptions.comparison import ROS2_CONTROL
from linkwright.descriptions.pairs import Model
from linkwright.diagnostics import LinkwrightError, Phrase, counted, joined, joined_first, phrase
from linkwright.review.breaking import MOVING_TYPES
from linkwright.review.plugins import find_plugin_name, find_plugins
from linkwright.review.versions import Version
from linkwright.urdf import Robot

_MAX_NAMES = 40
"""The maximum number of links, joints or plugins in the line about a robot."""


def read_unpaired_robot(version: Version, path: str) -> tuple[Model, Robot] | None:
    """Return the model and robot of a description, or None if it is unreadable.

    The arguments have the values of the first caller.
    """
    sets: Sequence[ArgumentSet] = version.checker().argument_sets(version.file(path), ())
    for arguments in (*sets[:1], ArgumentSet({})):
        model = version.model(path, arguments.values)
        try:
            robot = model.read().robot
        except LinkwrightError:
            continue
        if robot is not None:
            return model, robot
    return None


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
