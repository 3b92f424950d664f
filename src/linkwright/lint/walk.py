"""Iteration over descriptions for rules: joints and their elements."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.urdf import Joint
from linkwright.urdf.values import number, numbers
from linkwright.xmltree import Element

if TYPE_CHECKING:
    from linkwright.lint.subject import Subject


def iterate_joints(subject: Subject) -> Iterator[tuple[Joint, Element]]:
    """Yield the joints with their elements, in source order."""
    for joint in subject.joints:
        if joint.element is not None:
            yield joint, joint.element


def iterate_joint_children(subject: Subject, tag: str) -> Iterator[tuple[Joint, Element, Element]]:
    """Yield each joint with a child element of a tag, the joint's element, and the child.

    Only the first such child is yielded, because readers use only this one.
    """
    for joint, element in iterate_joints(subject):
        child = element.first(tag)
        if child is not None:
            yield joint, element, child


_SIMULATORS = lazy_pattern(r"gz|gazebo|ign|mujoco|webots|isaac|unity|drake|bullet", re.IGNORECASE)


def is_for_simulation(subject: Subject) -> bool:
    """Return whether a description has elements for Gazebo, or the plugin of a simulator.

    Mock hardware, such as ``mock_components/GenericSystem``, is not a simulator, because it needs no physics.
    """
    plugins = (
        plugin.text()
        for system in subject.elements("ros2_control")
        for hardware in system.elements("hardware")
        for plugin in hardware.elements("plugin")
    )
    return next(subject.elements("gazebo"), None) is not None or any(map(_SIMULATORS.search, plugins))


SURROUNDING_FRAMES = frozenset(("world", "map", "odom"))
"""Links that represent the surroundings: a link that is fixed to one does not move, and may be anywhere."""
BOUNDED_TYPES = ("revolute", "prismatic")
"""The types of joints that have bounds."""
UNBOUNDED_RAD = 1000.0
"""The magnitude, in rad or m, above which bounds mean that there are no limits."""


def iterate_limits(subject: Subject, *types: str) -> Iterator[tuple[Joint, Element]]:
    """Yield the joints of some types that have a ``<limit>``, each with this element."""
    for joint, _, limit in iterate_joint_children(subject, "limit"):
        if joint.type in types:
            yield joint, limit


def parse_bounds(limit: Element) -> tuple[float, float] | None:
    """Return the lower and upper bounds as urdfdom reads them, or None if one is not a number.

    A missing bound is 0.
    """
    lower_and_upper = [parse_number(limit, name) if name in limit.attributes else 0.0 for name in ("lower", "upper")]
    return (
        None if lower_and_upper[0] is None or lower_and_upper[1] is None else (lower_and_upper[0], lower_and_upper[1])
    )


def parse_number(element: Element, attribute: str) -> float | None:
    """Return the value of an attribute as a number, or None if it is absent or not a number."""
    text = element.attributes.get(attribute)
    if text is None:
        return None
    try:
        return number(text)
    except ValueError:
        return None


def parse_numbers(element: Element, attribute: str) -> tuple[float, ...]:
    """Return the numbers in an attribute, or an empty tuple if it is absent or malformed."""
    text = element.attributes.get(attribute)
    if text is None:
        return ()
    try:
        return numbers(text)
    except ValueError:
        return ()


def format_number(number: float) -> str:
    """Return a number as text for messages and hints."""
    return f"{number:.6g}"
