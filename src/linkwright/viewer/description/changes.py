"""What an edit changed about a robot."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

from linkwright.urdf import Robot

Part = TypeVar("Part")


def changed_links(before: Robot, after: Robot) -> list[str]:
    """The links of a robot that the one before lacks or had otherwise; where they are written does not count."""
    return _changed(before.links, after.links)


def changed_joints(before: Robot, after: Robot) -> list[str]:
    """The joints of a robot that the one before lacks or had otherwise; where they are written does not count."""
    return _changed(before.joints, after.joints)


def _changed(before: Mapping[str, Part], after: Mapping[str, Part]) -> list[str]:
    # Elements, which know the places, take no part in comparisons of the model.
    return [name for name, part in after.items() if before.get(name) != part]
